# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Fails if a page of docs/ outside docs/reference has a sentence of more than 35 words or a line of more than 110 characters
outside tables, code and mathematics, or more than 250 lines; pages that remain to be shortened are listed in UNFINISHED.

usage: python3 tests/house/pages.py          fails with the faults of all other pages
       python3 tests/house/pages.py PAGE...  lists the faults of these pages
"""

import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
MAX_WORDS, MAX_COLUMNS, MAX_LINES = 35, 110, 250
# Remove a page when it has no fault; no page is to be added.
UNFINISHED = """
""".split()


def prose(text):
    """The page with blank lines instead of code, displayed mathematics, tables, images, headings and the line of headers."""
    blank = lambda match: "\n" * match[0].count("\n")
    text = re.sub(r"^ *```.*?^ *```$|^\$\$.*?\$\$", blank, text, flags=re.M | re.S)
    return re.sub(r"^(?:\||!\[|#|Headers:|<).*", "", text, flags=re.M)


def faults(text):
    found = [f"has {text.count(chr(10))} lines, more than {MAX_LINES}"] if text.count("\n") > MAX_LINES else []
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
        found = faults(pages[page].read_text(encoding="utf-8"))
        if page not in UNFINISHED or sys.argv[1:]:
            problems += [f"docs/{page}.md {fault}" for fault in found]
        elif not found:
            problems.append(f"docs/{page}.md has no fault: remove it from the list of pages.py")
    problems += [f"pages.py lists {page}, which there is not" for page in UNFINISHED if page not in pages]
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    main()
