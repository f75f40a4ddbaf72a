# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Fails if a page of docs/ outside docs/reference has a sentence of more than 35 words or a line of more than 110 characters
outside tables, code and mathematics, more than 250 lines, or C++ that is wider than the pages.

usage: python3 tests/house/pages.py          fails with the faults of all pages outside docs/reference
       python3 tests/house/pages.py PAGE...  lists the faults of these pages
"""

import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
MAX_WORDS, MAX_COLUMNS, MAX_LINES, MAX_COLUMNS_OF_CODE = 35, 110, 250, 102


def prose(text):
    """The page with blank lines instead of code, displayed mathematics, tables, images, headings and the line of headers."""
    blank = lambda match: "\n" * match[0].count("\n")
    text = re.sub(r"^ *```.*?^ *```$|^\$\$.*?\$\$", blank, text, flags=re.M | re.S)
    return re.sub(r"^(?:\||!\[|#|Headers:|<).*", "", text, flags=re.M)


def faults(text):
    found = [f"has {text.count(chr(10))} lines, more than {MAX_LINES}"] if text.count("\n") > MAX_LINES else []
    for program in re.findall(r"^```cpp$(.*?)^```$", text, re.M | re.S):
        found += [f"has a line of C++ of {len(line)} characters: {line.strip()[:60]} …"
                  for line in program.split("\n") if len(line) > MAX_COLUMNS_OF_CODE]
    lines = prose(text).split("\n")
    found += [f"line {i} has {len(line)} characters, more than {MAX_COLUMNS}" for i, line in enumerate(lines, 1) if len(line) > MAX_COLUMNS]
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", "\n".join(lines)):
        block = re.sub(r"\]\([^)]*\)", "]", re.sub(r"`[^`]*`|\$[^$]*\$", "code", block))
        for sentence in re.split(r"(?<=[.!?:;])[*_\"”)]*\s+(?=[*_\"“(\[]*[A-Z0-9]|code)", block):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if len(words) > MAX_WORDS:
                found.append(f"has a sentence of {len(words)} words: {' '.join(words[:8])} …")
    return found


def main():
    pages = {path.relative_to(TOP / "docs").as_posix()[:-3]: path for path in sorted((TOP / "docs").rglob("*.md"))}
    chosen = sys.argv[1:] or [page for page in pages if not page.startswith("reference/")]
    problems = []
    for page in chosen:
        problems += [f"docs/{page}.md {fault}" for fault in faults(pages[page].read_text(encoding="utf-8"))]
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    main()
