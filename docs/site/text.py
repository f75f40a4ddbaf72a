# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Markdown to parts of pages, by pandoc."""

import html
import re
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

PANDOC = "pandoc"
TOP = Path(__file__).resolve().parent.parent.parent
LABEL = r"N(?:1\d|2[0-5]|[1-9])|P[1-7]"
OPENING, CLOSING = set("([{⟨"), set(")]}⟩")
RELATIONS = set("=≤≥<>≈≡∈→↦←∼≠,;")
ACCENTS = {"\u0307": "˙", "\u0308": "¨", "\u20d7": "→", "\u0302": "ˆ", "\u0303": "˜", "\u0304": "¯", "\u0305": "¯"}
HIGH = {"mfrac", "mtable", "munder", "munderover", "msqrt", "mroot"}


def pandoc(markdown, name):
    """HTML; mathematics is MathML, and a formula that pandoc does not know an error."""
    done = subprocess.run(
        [PANDOC, "--from=gfm+tex_math_dollars", "--to=html5", "--mathml", "--fail-if-warnings", "--wrap=preserve"],
        input=markdown, capture_output=True, text=True)
    if done.returncode or done.stderr:
        sys.exit(f"duet: {name}: {done.stderr}")
    body = re.sub(r"<math.*?</math>", lambda formula: math(formula[0]), done.stdout, flags=re.S)
    body = re.sub(r"<table>.*?</table>", lambda table: boxed_table(table[0]), body, flags=re.S)
    body = re.sub(r"<code>([^<]{1,60})</code>", lambda code: code[0] if len(html.unescape(code[1])) > 20
                  else code[0].replace("<code>", '<code class="short">'), body)
    return re.sub(r"<col(group)?\b.*?>|</colgroup>", "", body)


def math(formula):
    """A formula as TeX would set it. One on a line of its own has a box; one in text may be broken behind its relations."""
    root = xml.fromstring(re.sub(r' xmlns="[^"]*"', "", formula))
    row = root.find("semantics/*")
    if row.tag != "mrow":
        row, inner = xml.Element("mrow"), row
        row.append(inner)
    set_row(row)
    is_display = root.get("display") == "block"
    parts, depth = [[]], 0
    for element in row:
        parts[-1].append(xml.tostring(element, encoding="unicode"))
        symbol = element.text if element.tag == "mo" else ""
        depth += (symbol in OPENING) - (symbol in CLOSING)
        if symbol in RELATIONS and depth == 0 and not is_display:
            parts.append([])
    written = "<wbr>".join(f"<math{' display=' + repr('block') if is_display else ''}><mrow>{''.join(part)}</mrow></math>"
                           for part in parts if part)
    return f'<span class="formula" tabindex="0">{written}</span>' if is_display else written


def set_row(element):
    """Accents are put above letters as such, signs are no operators, names of functions are set off from what they are of, and parentheses are no
    higher than a line where nothing between them is: pandoc leaves these to browsers, which do otherwise."""
    for child in element:
        set_row(child)
    if element.tag == "mover" and element[1].text in ACCENTS:
        element.set("accent", "true")
        element[1].text = ACCENTS[element[1].text]
        element[1].attrib = {"stretchy": "false"} | ({"mathsize": "60%"} if element[1].text == "→" else {"style": "padding-bottom:.09em"})
    if element.tag == "mo" and element.text == "\u2225":
        element.text, element.attrib = "\u2016", {"lspace": "0", "rspace": "0", "stretchy": "false", "form": element.get("form", "prefix")}
    if element.tag == "mstyle" and element.get("mathvariant") == "normal" and all(child.tag == "mi" for child in element):
        element.tag, element.text = "mi", "".join(element.itertext())
        del element[:]
    if element.tag in ("msup", "msubsup") and element[-1].text == "*":
        element[-1].text = "\u2217"
    if element.tag == "msup" and element[0].text == "f" and (element[1].text or "").startswith("′"):
        element[1].set("style", "padding:0 .05em 0 .1em")
    fences = [child for child in element if child.tag == "mo" and child.get("stretchy") == "true"]
    if fences and not any(child.tag in HIGH for child in element.iter()):
        for fence in fences:
            fence.set("stretchy", "false")
    for before, child in zip([None, *element], element): # signs
        is_after_operator = before is None or before.tag == "mo" and before.get("form") != "postfix" and before.text not in CLOSING | {"!", "…", "⋯"}
        if child.tag == "mo" and child.text in ("−", "+") and is_after_operator:
            child.set("form", "prefix")
    for i in reversed(range(len(element))):
        child = element[i]
        if child.tag == "mo" and (child.text or "").isalpha() and len(child.text) > 1:
            child.tag, child.attrib = "mi", {}
            if element.tag == "mrow":
                if i + 1 < len(element) and not is_fence(element[i + 1]):
                    element.insert(i + 1, xml.Element("mspace", width="0.167em"))
                if i > 0 and element[i - 1].tag != "mo":
                    element.insert(i, xml.Element("mspace", width="0.167em"))


def is_fence(element):
    first = element[0] if element.tag == "mrow" and len(element) else element
    return first.tag == "mo"


def boxed_table(table):
    """A table scrolls in its own box; one whose heads are empty has none."""
    head = re.search(r"<thead>.*?</thead>", table, flags=re.S)
    if head and not plain(head[0]).strip():
        table = table.replace(head[0], "")
    columns = (table.count("<td") + table.count("<th")) / max(table.count("<tr"), 1)
    return f'<div class="table{" broad" if columns > 6 else ""}" tabindex="0">{table}</div>'


def with_breaks(body):
    """Names in tables may be broken behind their words; style.css lets them on phones."""
    def broken(code):
        return code[1] + re.sub(r"(/|_|::)(?=\w)", r'\1<wbr class="narrow">', code[2]) + "</code>"
    return re.sub(r"<table.*?</table>", lambda table: re.sub(r"(<code[^>]*>)(.*?)</code>", broken, table[0], flags=re.S),
                  body, flags=re.S)


def plain(part):
    """What is read of HTML."""
    part = re.sub(r"<[^>]*>", "", re.sub(r"</(?:p|li|t[dh]|d[dt]|pre)>", " ", part.replace("<sup>", "^")))
    return re.sub(r"\s+", " ", html.unescape(part)).strip()


def with_links(body, found):
    return re.sub(r'(<a href=")([^"]*)(")', lambda link: link[1] + found(html.unescape(link[2])) + link[3], body)


def with_names(body, found):
    """Code in lines of text, outside links and headings, leads to the reference."""
    def linked(match):
        if not match[1]:
            return match[0]
        address = found(html.unescape(match[1]))
        return f'<a class="name" href="{address}">{match[0]}</a>' if address else match[0]
    return re.sub(r"<a .*?</a>|<h\d.*?</h\d>|<pre.*?</pre>|<code[^>]*>(.*?)</code>", linked, body, flags=re.S)


def with_label_links(body, found):
    """Labels of formulas in text lead to the table of all."""
    def linked(match):
        return f'<a href="{found(match[2])}">{match[2]}</a>' if match[2] else match[0]
    return re.sub(rf"<(a|h\d|pre|code|math|svg)\b.*?</\1>|<[^>]*>|\b({LABEL})\b", linked, body, flags=re.S)


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
    """The body with addresses at its headings, these as (level, anchor, title), and its parts, as are
    rows of tables with an anchor (terms of the glossary), as (title, anchor, words)."""
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
    term = r'<tr[^>]*>\s*<td[^>]*><a id="([^"]*)"></a>(.*?)</td>(.*?)</tr>'
    found_as = [(plain(title), anchor, plain(rest)) for anchor, title, rest in re.findall(term, body, flags=re.S)]
    for part in re.split(r"(?=<h[1-3])", re.sub(term, "", body, flags=re.S)):
        title = re.match(r'<h[123](?: id="([^"]*)")?>(.*?)(?:<a class="here".*?)?</h\d>', part, flags=re.S)
        if title:
            found_as.append((plain(title[2]), title[1] or "", plain(re.sub(r"<svg.*?</svg>", "", part[title.end():], flags=re.S))))
    return body, contents, found_as
