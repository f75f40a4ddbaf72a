# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Markdown to parts of pages, by pandoc."""

import html
import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent.parent
RELATIONS = "=≤≥<>≈≡∈→↦←∼≠,;"


def pandoc(markdown, name):
    """HTML; mathematics is MathML, and a formula that pandoc does not know an error."""
    done = subprocess.run(
        ["pandoc", "--from=gfm+tex_math_dollars", "--to=html5", "--mathml", "--fail-if-warnings", "--wrap=preserve"],
        input=markdown, capture_output=True, text=True)
    if done.returncode or done.stderr:
        sys.exit(f"duet: {name}: {done.stderr}")
    body = re.sub(r"<math.*?</math>", lambda formula: math(formula[0]), done.stdout, flags=re.S)
    body = re.sub(r"<table>.*?</table>", lambda table: boxed_table(table[0]), body, flags=re.S)
    return re.sub(r"<col(group)?\b.*?>|</colgroup>", "", body)


def math(formula):
    """A display formula in a box of its own; one in a line may be broken behind its relations, as TeX does."""
    formula = re.sub(r"<semantics>(.*)<annotation.*?</annotation></semantics>", r"\1", formula, flags=re.S)
    if 'display="block"' in formula:
        return f'<span class="formula">{formula}</span>'
    row = re.fullmatch(r"(<math[^>]*>)<mrow>(.*)</mrow></math>", formula, flags=re.S)
    if not row:
        return formula
    parts, part = [], ""
    for element in elements(row[2]):
        part += element
        symbol = re.fullmatch(r"<mo[^>]*>(.*)</mo>", element)
        if symbol and html.unescape(symbol[1]) in RELATIONS:
            parts.append(part)
            part = ""
    parts += [part] if part else []
    return "<wbr>".join(f"{row[1]}<mrow>{part}</mrow></math>" for part in parts)


def elements(row):
    """The elements of a row of MathML."""
    depth, start, result = 0, 0, []
    for tag in re.finditer(r"<(/?)\w+[^>]*?(/?)>", row):
        depth += 0 if tag[2] else -1 if tag[1] else 1
        if depth == 0:
            result.append(row[start:tag.end()])
            start = tag.end()
    return result


def boxed_table(table):
    """A table scrolls in its own box; one whose heads are empty has none."""
    head = re.search(r"<thead>.*?</thead>", table, flags=re.S)
    if head and not plain(head[0]).strip():
        table = table.replace(head[0], "")
    return f'<div class="table" tabindex="0">{table}</div>'


def plain(part):
    """What is read of HTML."""
    return re.sub(r"\s+", " ", html.unescape(re.sub(r"<[^>]*>", "", part))).strip()


def with_links(body, found):
    return re.sub(r'(<a href=")([^"]*)(")', lambda link: link[1] + found(html.unescape(link[2])) + link[3], body)


def with_names(body, found):
    """Code in lines of text, outside links and headings, leads to the reference."""
    def linked(match):
        if not match[1]:
            return match[0]
        address = found(html.unescape(match[1]))
        return f'<a class="name" href="{address}">{match[0]}</a>' if address else match[0]
    return re.sub(r"<a .*?</a>|<h\d.*?</h\d>|<pre.*?</pre>|<code>(.*?)</code>", linked, body, flags=re.S)


def with_labels(body):
    """The first line of a table for each formula has its label as anchor."""
    seen = set()

    def labelled(row):
        if row[2] in seen:
            return row[0]
        seen.add(row[2])
        return f'<tr{row[1]} id="{row[2]}">\n<td{row[3]}>{row[2]}</td>'
    return re.sub(r"<tr([^>]*)>\s*<td(?=[^>]*>([NP]\d+)</td>)([^>]*)>[NP]\d+</td>", labelled, body)


def fragment(body):
    """The body with addresses at its headings, these as (level, anchor, title), and its parts as (title, anchor, words)."""
    contents = []

    def heading(match):
        level, anchor, title = int(match[1]), match[2], match[3]
        if level == 1:
            return f"<h1>{title}</h1>"
        if level < 4:
            contents.append((level, anchor, re.sub(r"</?a[^>]*>", "", title)))
        return f'<h{level} id="{anchor}">{title}<a class="here" href="#{anchor}" aria-label="Link to this part">#</a></h{level}>'
    body = re.sub(r'<h(\d) id="([^"]*)">(.*?)</h\1>', heading, body, flags=re.S)
    body = re.sub(r"(?<=</h1>)\s*<p>Headers: (.*?)</p>", r'<p class="headers">\1</p>', body, count=1, flags=re.S)
    found_as = []
    for part in re.split(r"(?=<h[1-3])", body):
        title = re.match(r'<h[123](?: id="([^"]*)")?>(.*?)(?:<a class="here".*?)?</h\d>', part, flags=re.S)
        if title:
            found_as.append((plain(title[2]), title[1] or "", plain(re.sub(r"<svg.*?</svg>", "", part[title.end():], flags=re.S))))
    return body, contents, found_as
