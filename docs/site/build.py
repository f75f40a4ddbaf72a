#!/usr/bin/env python3
# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Writes the documents and the reference as a folder of pages that can be moved anywhere and read from disk.

usage: python3 docs/site/build.py --xml <Doxygen's> --out <folder> [--live <what was built for docs/case-studies/interactive>] [--pandoc <program>]

docs/index.md is the front page, and its lists are the order of all pages: a page that they leave out is an error, and so
is a link that leads nowhere or a formula that pandoc does not know.
"""

import argparse
import html
import json
import os
import re
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from string import Template

sys.dont_write_bytecode = True  # into the folder of sources
import figures
import reference
import text

HERE = Path(__file__).resolve().parent
TOP = HERE.parent.parent
FONTS = Path("/usr/share/texmf/fonts/opentype/public")  # Debian's fonts-texgyre, fonts-texgyre-math
FONT_FILES = [f"tex-gyre/texgyrepagella-{face}.otf" for face in ("regular", "italic", "bold", "bolditalic")] + [
    "tex-gyre-math/texgyrepagella-math.otf"]

ROOT_FILES = ["LICENSE", "CITATION.cff"]
NAMES = "reference/api/" # one page per layer
LIVE = "case-studies/interactive" # pages that compute in the browser


def fail(message):
    sys.exit(f"duet: {message}")


class Page:
    """A page: where it comes from and goes to, both relative to their tops. `group` heads it in the navigation."""

    def __init__(self, title, address, source=None, body="", contents=(), found_as=(), group=""):
        self.title, self.address, self.source = title, address, source
        self.body, self.contents, self.found_as, self.group = body, contents, found_as, group

    def link_to(self, address):
        """An address of the folder as seen from this page."""
        target, hash_mark, anchor = address.partition("#")
        if target == self.address:
            return hash_mark + anchor if anchor else os.path.basename(target)
        return os.path.relpath(target, os.path.dirname(self.address) or ".") + hash_mark + anchor


def address_of(source):
    """docs/how-to/a.md is how-to/a.html, README.md readme.html."""
    path = source[len("docs/"):] if source.startswith("docs/") else source.lower()
    return re.sub(r"\.md$", ".html", path)


def reading_order():
    """Sections of pages, as the front page lists them."""
    sections, listed, group = [], set(), ""
    for line in (TOP / "docs/index.md").read_text().splitlines():
        if named := re.match(r"## (.*)", line):
            sections.append((named[1], []))
        elif line.startswith(("- ", "  ")):
            if line.startswith("- "):
                group = (re.match(r"- ([^\[\]:]+): ", line) or [0, ""])[1]
            for title, link in re.findall(r"\[([^\]]*)\]\(([^)#]*\.md)\)", line):
                source = os.path.normpath("docs/" + link)
                listed.add(source)
                sections[-1][1].append(Page(title[0].upper() + title[1:], address_of(source), source, group=group))
    for path in TOP.glob("docs/**/*.md"):
        source = str(path.relative_to(TOP))
        if source not in listed and source != "docs/index.md":
            fail(f"docs/index.md does not list {source}")
    return sections


def examples():
    """Pages with the source of every example, by its path without .cpp."""
    result = {}
    for path in sorted((TOP / "examples").rglob("*.cpp")):
        name = str(path.relative_to(TOP).with_suffix(""))
        folder = path.parent
        if (folder / "main.cpp").exists():
            name = str(folder.relative_to(TOP))
        files = sorted(folder.glob("*.?pp")) if (folder / "main.cpp").exists() else [path]
        files.sort(key=lambda file: file.name != "main.cpp")
        result[name] = files
    return result


def example_page(name, files):
    source = "\n\n".join(f"## {file.name}\n\n```cpp\n{file.read_text()}```" for file in files)
    body, contents, _ = text.fragment(text.pandoc(f"# {name}\n\n{source}\n", name))
    return Page(name, f"source/{name.removeprefix('examples/')}.html", None, body, contents if len(files) > 1 else ())


class Links:
    """What links in the sources, names and labels lead to."""

    def __init__(self, pages, headers, example_files):
        self.pages = {page.source: page.address for page in pages}
        self.headers = {"include/" + header.path: header.address for header in headers}
        self.examples = {name: f"source/{name.removeprefix('examples/')}.html" for name in example_files}
        for name, files in example_files.items():
            self.examples.update({str(file.relative_to(TOP)): self.examples[name] for file in files})
        self.names = {}
        for header in headers:
            for name in header.anchors:
                self.names.setdefault(name, []).append(header)

    def to_file(self, page, address):
        """Of a link in a document."""
        if re.match(r"https?:|#|mailto:", address):
            return address
        target, hash_mark, anchor = address.partition("#")
        path = os.path.normpath(os.path.join(os.path.dirname(page.source), target))
        for known in (self.pages, self.headers, self.examples):
            if path in known:
                return page.link_to(known[path] + hash_mark + anchor)
        if path in ROOT_FILES:
            return page.link_to(path)
        fail(f"{page.source} links to {address}, which is not in the folder")

    def to_name(self, page, code, preferred=()):
        """Of words in code: a name of the library, a header or an example, or nothing."""
        for folder in ("include/", "include/duet/"):
            if "/" in code and folder + code in self.headers:
                return page.link_to(self.headers[folder + code])
        if example := re.match(r"examples/[\w/]+", code):
            known = self.examples.get(example[0])
            return known and page.link_to(known)
        named = re.match(r"(?:duet::)?((?:\w+::)+\w+|[a-zA-Z]\w{2,}|[a-zA-Z]\w(?=[(<]))(?=$|[(<{])", code)
        headers = self.names.get(named[1], []) if named else []
        if not headers:
            return None
        best = next((h for h in headers if h.path in preferred), headers[0])
        return page.link_to(best.address + "#" + best.anchors[named[1]])

    def to_label(self, page, label):
        """Of a formula's label, N7, to its line in the table of all."""
        return page.link_to(f"reference/formulas.html#{label}")


def write_document(page, links, live):
    source = (TOP / page.source).read_text()
    preferred = re.findall(r"`(duet/[\w/]+\.hpp)`", source.split("\n\n", 2)[1])
    body = text.pandoc(source, page.source)
    body = text.with_links(body, lambda address: links.to_file(page, address))
    body = text.with_names(body, lambda code: links.to_name(page, code, preferred))
    if page.source == "docs/reference/formulas.md":
        body = text.with_labels(body)
    else:
        body = text.with_label_links(body, lambda label: links.to_label(page, label))
    if page.source.startswith(f"docs/{LIVE}/"): # what was not built is not asked for
        body = re.sub(r'<script src="([\w.]+)"></script>\s*',
                      lambda script: script[0] * any((folder / script[1]).is_file() for folder in live), body)
    body = text.with_breaks(body)
    body = figures.with_figures(body, TOP / page.source)
    page.body, page.contents, page.found_as = text.fragment(body)


def navigation(sections, page):
    result = []
    for title, pages in sections:
        items, group = [], ""
        for each in pages:
            if each.address.startswith(NAMES) and not page.address.startswith(NAMES.rstrip("/")):
                continue # listed on their index
            if each.group != group and (group := each.group):
                items.append(f'<li class="group">{html.escape(group)}</li>')
            here = ' aria-current="page"' if each is page else ""
            items.append(f'<li><a href="{page.link_to(each.address)}"{here}>{html.escape(each.title)}</a></li>')
        result.append(f"<h2>{title}</h2>\n<ul>{''.join(items)}</ul>")
    return "\n".join(result)


def contents_of(page):
    if len(page.contents) < 2:
        return ""
    items = "".join(f'<li class="level{level}"><a href="#{anchor}">{title}</a></li>' for level, anchor, title in page.contents)
    return f'<details class="contents" open><summary>On this page</summary><ul>{items}</ul></details>'


def neighbours(page, order):
    if page not in order:
        return ""
    i = order.index(page)
    parts = []
    for j, word, kind in ((i - 1, "before", "prev"), (i + 1, "next", "next")):
        if 0 <= j < len(order):
            parts.append(f'<a rel="{kind}" href="{page.link_to(order[j].address)}"><span>{word}</span>{html.escape(order[j].title)}</a>')
    return f'<nav class="neighbours" aria-label="Pages before and after">{"".join(parts)}</nav>'


def write_pages(out, pages, sections, order):
    template = Template((HERE / "page.html").read_text())
    for page in pages:
        path = out / page.address
        path.parent.mkdir(parents=True, exist_ok=True)
        name = "duet" if page.title == "duet" else f"{page.title} · duet"
        path.write_text(template.substitute(
            title=html.escape(name), top=page.link_to("index.html")[:-len("index.html")],
            kind=page.address.split("/")[0].removesuffix(".html"), navigation=navigation(sections, page),
            contents=contents_of(page), body=page.body, neighbours=neighbours(page, order)))


def search_index(pages):
    """[title, page's title, address, text] of every part of a page; names are found on the pages of headers."""
    entries = []
    for page in pages:
        if page.address.startswith(NAMES):
            continue
        for title, anchor, words in page.found_as:
            entries.append([title, page.title, page.address + ("#" + anchor if anchor else ""), words])
    return "search_index = " + json.dumps(entries, ensure_ascii=False, separators=(",", ":")) + ";\n"


def copy_assets(out, live):
    for name in ("style.css", "site.js"):
        shutil.copy(HERE / name, out)
    for name in ROOT_FILES:
        shutil.copy(TOP / name, out)
    if all((FONTS / name).exists() for name in FONT_FILES):
        (out / "fonts").mkdir(exist_ok=True)
        for name in FONT_FILES:
            shutil.copy(FONTS / name, out / "fonts")
        shutil.copy("/usr/share/doc/fonts-texgyre/copyright", out / "fonts/LICENSE")
    else:
        print("duet: no TeX Gyre fonts on this system, the pages will use the reader's")
    for file in (file for folder in live for file in folder.iterdir()):
        if file.suffix in (".js", ".wasm", ".css"):
            (out / LIVE).mkdir(parents=True, exist_ok=True)
            shutil.copy(file, out / LIVE)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--xml", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--live", type=Path)
    parser.add_argument("--pandoc", default="pandoc")
    arguments = parser.parse_args()
    text.PANDOC = arguments.pandoc
    out = arguments.out
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)

    sections = reading_order()
    front = Page("duet", "index.html", "docs/index.md")
    order = [front] + [page for _, pages in sections for page in pages]
    headers = reference.read(arguments.xml)
    example_files = examples()
    links = Links(order, headers, example_files)
    live = [folder for folder in (TOP / "docs" / LIVE, arguments.live) if folder and folder.is_dir()]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        written = [pool.submit(write_document, page, links, live) for page in order]
        source_pages = list(pool.map(example_page, example_files, example_files.values()))
        for each in written:
            each.result()
    index = Page("Headers", "reference/index.html")
    header_pages = reference.pages(headers, Page, index, links)
    for _, pages in sections: # behind the lists of names
        if names := [i for i, page in enumerate(pages) if page.address.startswith(NAMES.rstrip("/"))]:
            index.group = pages[names[-1]].group
            pages.insert(names[-1] + 1, index)
    pages = order + [index] + header_pages + source_pages
    write_pages(out, pages, sections, order)
    (out / "search_index.js").write_text(search_index(order + header_pages))
    copy_assets(out, live)
    print(f"duet: {len(pages)} pages in {out}")


if __name__ == "__main__":
    main()
