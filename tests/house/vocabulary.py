# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Fails if a word that duet has replaced by the term of its field occurs more often than vocabulary.txt permits.

usage: python3 tests/house/vocabulary.py             compares the number of occurrences with the limits
       python3 tests/house/vocabulary.py ROW...      lists all occurrences of these rows of vocabulary.txt
       python3 tests/house/vocabulary.py --counts    prints count, limit and goal of every row
       python3 tests/house/vocabulary.py --update    lowers the limits to the counts, never raises one
       python3 tests/house/vocabulary.py --self-test checks that every row finds its planted example

A count below its limit is a remark, not a failure: branches that lower counts are merged in any order.
"""

import configparser
import re
import sys
import tempfile
from collections import namedtuple
from fnmatch import fnmatch
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
WORDS = Path(__file__).with_name("vocabulary.txt")
FOLDERS = ["include", "src", "tests", "bench", "examples", "docs", "packaging", "cmake", "scripts", ".ci"]
MOST_LINES = 20
COMMANDS = r"\\(?:file|brief|details|t?param|returns?|retval|throws?|exception|pre|post|see|sa|note|warning|since)\b"
TOKEN = re.compile(
    r'(?P<name>(?!(?:u8?|[UL])?R"|namespace test_)[A-Za-z_]\w*)'
    r"|(?P<comment>//[^\n]*|/\*.*?\*/)"
    r"|(?P<file>^[ \t]*#[ \t]*include[^\n]*|namespace test_\w+)" # names of files, which this test leaves alone
    r'|(?P<text>(?:u8?|[UL])?R"([^\s()\\]{0,16})\(.*?\)\5"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\')'
    r"|(?P<number>\.?\d(?:[eEpP][+-]|'?[\w.])*)", re.M | re.S)
NAME = re.compile(r"[A-Za-z_]\w*")
MARKS = re.compile(r"^[ \t]*(?:///?<?|/\*+)", re.M)
PART = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")
CODE_SPAN = re.compile(r"`[^`\n]*`")
MENTION = re.compile(r"`[^`\n]*`|\*\w[\w'’ ]{1,24}\*") # code, or few words in italics: those are the subject of a sentence
BLOCK = re.compile(r"^(?P<begin> *```+(?P<language>[^\n`]*)\n)(?P<code>.*?)(?P<rest>^ *```+ *$)", re.M | re.S)
SCRIPTS = re.compile(r".*\.(py|cmake|sh)|(.*/)?CMakeLists\.txt|scripts/\w+|\.ci/run")

Found = namedtuple("Found", "file line text")


def blank(text):
    """The text with a space for every character except line breaks, so that lines keep their numbers."""
    return re.sub(r"[^\n]", " ", text)


class Source:
    """A C++ file: its code without comments and strings, and its comments without their marks, at their lines."""

    def __init__(self, text):
        code, comments, last = [], [], 0
        for token in TOKEN.finditer(text):
            kind = token.lastgroup
            if kind == "name" or kind == "number":
                continue
            between, whole = text[last:token.start()], token[0]
            last = token.end()
            code += between, blank(whole)
            is_comment = kind == "comment"
            comments += blank(between), MARKS.sub(lambda m: " " * len(m[0]), whole) if is_comment else blank(whole)
        self.code = "".join(code) + text[last:]
        self.comments = "".join(comments) + blank(text[last:])
        self.names = set(NAME.findall(self.code))


def docstrings(text):
    """The docstrings of a header, each a list of (line, text)."""
    found, open_block = [], None
    for number, line in enumerate(text.split("\n"), 1):
        match = "///" in line and re.match(r"(?P<code>(?:[^/\"]|/(?!/)|\"(?:\\.|[^\"\\])*\")*)///(?P<after><?)(?!/)(?P<text>.*)", line)
        if not match:
            open_block = None
            continue
        is_alone = not match["code"].strip()
        if open_block and is_alone and open_block == (match["after"] or "begin"):
            found[-1].append((number, match["text"].strip()))
        else:
            found.append([(number, match["text"].strip())])
        open_block = match["after"] or "begin"
    return found


def opening(docstring, is_file):
    """First line of text of a docstring with `\\file`, or of one without; (line, "") for the other kind."""
    first = re.match(r"\\file\b\s*(.*)", docstring[0][1])
    if bool(first) != is_file:
        return docstring[0][0], ""
    lines = ([(docstring[0][0], first[1])] if first else [docstring[0]]) + docstring[1:]
    return next(((n, re.sub(r"^\\(brief|details)\s+", "", t)) for n, t in lines if t), lines[0])


def prose_of_page(text):
    """A Markdown page at its lines, with the comments of its programs in C++ and nothing else of its blocks of code."""
    def block(match):
        code = Source(match["code"]).comments if match["language"] == "cpp" else blank(match["code"])
        return blank(match["begin"]) + code + blank(match["rest"])
    text = BLOCK.sub(block, text)
    return MENTION.sub(lambda m: blank(m[0]), text)


class Tree:
    """The files of a source tree that the checks read, without the parts that `skipped` names."""

    def __init__(self, top, skipped):
        self.top = top
        self.headers, self.sources, self.prose, self.lines = {}, {}, {}, {}
        files = [f for f in top.glob("*") if f.is_file()]
        for folder in FOLDERS:
            files += (f for f in sorted((top / folder).rglob("*")) if f.is_file())
        for path in files:
            name = path.relative_to(top).as_posix()
            parts = next((skipped[pattern] for pattern in skipped if fnmatch(name, pattern)), None)
            is_script = SCRIPTS.fullmatch(name)
            if parts == [] or path.suffix not in (".hpp", ".cpp", ".h", ".md") and not is_script:
                continue
            text = path.read_text(encoding="utf-8")
            self.lines[name] = text.split("\n")
            for part in parts or []:
                end = f" // {part}" if part.startswith("namespace") else ";"
                whole = re.compile(rf"(?:^///[^\n]*\n)*^{part}\b[^\n]*\{{\n.*?^\}}{end}$", re.M | re.S)
                text = whole.sub(lambda m: blank(m[0]), text)
            if path.suffix == ".md":
                self.prose[name] = prose_of_page(text)
            elif is_script:
                lines = (re.match(r"(?:[^#]*\s)?#+\s(.*)", line) for line in text.split("\n"))
                self.prose[name] = MENTION.sub("", "\n".join(line[1] if line else "" for line in lines))
            else:
                self.sources[name] = source = Source(text)
                self.prose[name] = MENTION.sub(lambda m: blank(m[0]), source.comments)
                if name.startswith(("include/", "src/")):
                    self.headers[name] = docstrings(text)
            self.prose[name] = self.prose[name].lower()

    def find(self, row):
        """Occurrences of a row of the word list, in order of files and lines."""
        return sorted(getattr(self, "in_" + row["scope"])(row))

    def in_openings(self, row, is_file=False):
        return [Found(name, line, text) for name, blocks in self.headers.items() for block in blocks
                for line, text in [opening(block, is_file)] if re.match(row["pattern"], text)]

    def in_file_lines(self, row):
        return self.in_openings(row, True)

    def in_docstrings(self, row):
        """At most one occurrence for each docstring."""
        found = []
        for name, blocks in self.headers.items():
            for block in blocks:
                lines = [(line, text) for line, text in block if re.search(row["pattern"], CODE_SPAN.sub("", text))]
                found += (Found(name, *line) for line in lines[:1])
        return found

    def in_docstring_lines(self, row):
        pattern = row["pattern"].replace("COMMAND", COMMANDS)
        return [Found(name, *line) for name, blocks in self.headers.items() for block in blocks
                for line in block if re.search(pattern, line[1])]

    def in_identifiers(self, row):
        """One occurrence for each part: in `way_on` and `WayOn` the parts are way and on."""
        pattern = re.compile(row["pattern"])
        exception = re.compile(rf"(?<![A-Za-z])(?:{row.get('except', '(?!)')})(?![A-Za-z])")
        counts = {name: sum(bool(pattern.fullmatch(part.lower())) for part in PART.findall(exception.sub("_", name)))
                  for name in set().union(*(source.names for source in self.sources.values()))}
        counts = {name: count for name, count in counts.items() if count}
        found = []
        for file, source in self.sources.items():
            if names := source.names & counts.keys():
                for match in re.finditer(rf"\b(?:{'|'.join(names)})\b", source.code):
                    found += [Found(file, source.code.count("\n", 0, match.start()) + 1, match[0])] * counts[match[0]]
        return found

    def in_prose(self, row):
        """Documents and comments; a phrase may be broken between two lines."""
        # A pattern that begins with a letter of known case is found several times faster.
        pattern = re.compile(row["pattern"].replace(" ", r"(?:[ \t]+|[ \t]*\n[ \t>*#]*)") + r"\b")
        lines = ((name, text.count("\n", 0, match.start())) for name, text in self.prose.items()
                 for match in pattern.finditer(text) if not text[match.start() - 1:match.start()].isalnum())
        return [Found(name, line + 1, self.lines[name][line].strip()) for name, line in lines]


def read_words(path):
    """Rows of the word list by name, and the skipped files: pattern and names of parts, all of the file without."""
    words = configparser.RawConfigParser(delimiters="=", comment_prefixes="#")
    words.optionxform = str
    words.read(path, encoding="utf-8")
    skipped = {pattern: [part.strip() for part in value.partition(": ")[0].split(",") if part.strip() != "all"]
               for pattern, value in words["skipped"].items()}
    rows = {name: dict(words[name]) for name in words.sections() if name != "skipped"}
    for name, row in rows.items():
        if missing := {"scope", "pattern", "limit", "goal", "instead", "reason", "bad", "good"} - set(row):
            sys.exit(f"duet: {path.name}: [{name}] has no {', '.join(sorted(missing))}")
    return rows, skipped


def check(tree, rows):
    """Failures and remarks, a line each."""
    excesses, remarks = {}, []
    for name, row in rows.items():
        found, limit = tree.find(row), int(row["limit"])
        if len(found) > limit:
            # Files that changed last first: there are the occurrences that are new.
            excesses[name] = sorted(found, key=lambda f: -(tree.top / f.file).stat().st_mtime)
        elif len(found) < limit:
            remarks.append(f"[{name}] occurs {len(found)} times: lower its limit from {limit} to {len(found)} (--update)")
    failures = []
    for name, found in excesses.items():
        row, shown = rows[name], max(MOST_LINES // len(excesses) - 1, 1)
        failures.append(f"[{name}] occurs {len(found)} times, limit {row['limit']} (vocabulary.py {name} lists all). "
                        f"Instead: {row['instead']}. {row['reason']}.")
        failures += (f"  {f.file}:{f.line}: {f.text} [{name}]" for f in found[:shown])
    return failures, remarks


def update(path, tree, rows):
    """Lowers limits in the word list; yields a line for each."""
    text = path.read_text(encoding="utf-8")
    for name, row in rows.items():
        count = len(tree.find(row))
        if count < int(row["limit"]):
            text, changes = re.subn(rf"(^\[{name}\]$(?:\n(?!\[).*)*?\nlimit = )\d+$", rf"\g<1>{count}", text, flags=re.M)
            assert changes == 1, name
            yield f"[{name}] {row['limit']} -> {count}"
    path.write_text(text, encoding="utf-8")


def self_test(rows, skipped):
    """Plants the examples of the word list in a tree of its own."""
    files = {"openings": ["include/duet/a.hpp"], "file_lines": ["include/duet/a.hpp"], "docstrings": ["include/duet/a.hpp"],
             "docstring_lines": ["include/duet/a.hpp"], "identifiers": ["include/duet/a.hpp", "tests/a.cpp", "bench/a.cpp"],
             "prose": ["docs/a.md", "include/duet/a.hpp", "tests/a.cpp", "tests/CMakeLists.txt", "scripts/a"]}
    problems = []

    def planted(row, file, example, before=""):
        """Lines at which the row is found in a tree of one file that holds the example."""
        if row["scope"] == "prose" and not file.endswith(".md"):
            mark = "// " if file.endswith("pp") else "# "
            example = "\n".join(mark + line for line in example.split("\n"))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, file)
            path.parent.mkdir(parents=True)
            path.write_text(f"{before}\n{example}\n", encoding="utf-8")
            return [f.line for f in Tree(Path(folder), skipped).find(row)]

    for name, row in rows.items():
        for file in files[row["scope"]]:
            for example in row["bad"].strip().split("\n"):
                found = planted(row, file, example.replace("\\n", "\n"))
                if len(found) != 1 or not 2 <= found[0] <= 3:
                    problems.append(f"[{name}] is found {len(found)} times in {file}: {example}")
            for example in row["good"].strip().split("\n"):
                if planted(row, file, example.replace("\\n", "\n")):
                    problems.append(f"[{name}] is found in {file}: {example}")
        if files[row["scope"]] == ["include/duet/a.hpp"] and planted(row, "tests/a.cpp", row["bad"].replace("\\n", "\n")):
            problems.append(f"[{name}] is found outside headers")

    row = rows["told"]
    programs = planted(row, "docs/a.md", "```cpp\nint told; // told\nint told;\n```\n```text\ntold\n```")
    if programs != [3]:
        problems.append(f"in blocks of code of a page, lines {programs} are found, not [3]")
    row = rows["docstring_opening"]
    bad = row["bad"].strip().split("\n")[0]
    for pattern, parts in skipped.items():
        file = pattern.replace("*", "a")
        for part in parts:
            end = f"}} // {part}" if part.startswith("namespace") else "};"
            inner = "struct a {\n};\n" if part.startswith("namespace") else "  struct a {\n  };\n"
            if planted(row, file, f"{bad}\n{part} {{\n{inner}{bad}\n{end}"):
                problems.append(f"{part} of {file} is not skipped")
            if len(planted(row, file, bad, f"{part} {{\n{end}")) != 1:
                problems.append(f"what stands behind {part} of {file} is skipped")
        if not parts and planted(row, file, bad):
            problems.append(f"{file} is not skipped")

    with tempfile.TemporaryDirectory() as folder: # limits: one above, at and below the count of 2
        path, words = Path(folder, "include/a.hpp"), Path(folder, "words.txt")
        path.parent.mkdir()
        path.write_text(f"{bad}\nint a;\n{bad}\nint b;\n", encoding="utf-8")
        tree = Tree(Path(folder), skipped)
        for limit, numbers in [(1, (3, 0)), (2, (0, 0)), (3, (0, 1))]:
            result = check(tree, {"docstring_opening": row | {"limit": limit}})
            if tuple(map(len, result)) != numbers:
                problems.append(f"limit {limit} for 2 occurrences: {result}")
            words.write_text(f"[docstring_opening]\nreason = a\nlimit = {limit}\n[other]\nlimit = 9\n", encoding="utf-8")
            list(update(words, tree, {"docstring_opening": row | {"limit": limit}}))
            if f"limit = {min(limit, 2)}\n[other]\nlimit = 9\n" not in words.read_text(encoding="utf-8"):
                problems.append(f"--update of limit {limit} writes {words.read_text(encoding='utf-8')}")
    return problems


def main(arguments):
    rows, skipped = read_words(WORDS)
    if arguments == ["--self-test"]:
        if problems := self_test(rows, skipped):
            sys.exit("\n  ".join(["duet: tests/house/vocabulary.py:", *problems]))
        return
    unknown = [argument for argument in arguments if argument not in rows]
    if unknown and arguments not in (["--counts"], ["--update"]):
        sys.exit(f"{__doc__}\nduet: no row {unknown[0]} (rows: {' '.join(rows)})")
    tree = Tree(TOP, skipped)
    for pattern in skipped:
        if not any(TOP.glob(pattern)):
            print(f"remark: no file {pattern}: remove it from the skipped files of vocabulary.txt")
    if arguments == ["--counts"]:
        for name, row in rows.items():
            print(f"{name:24}{len(tree.find(row)):5}  limit {row['limit']:>4}  goal {row['goal']:>3}")
    elif arguments == ["--update"]:
        print("\n".join(update(WORDS, tree, rows)))
    elif arguments:
        for name in arguments:
            print("\n".join(f"{f.file}:{f.line}: {f.text}" for f in tree.find(rows[name])))
    else:
        failures, remarks = check(tree, rows)
        for remark in remarks:
            print(f"remark: {remark}")
        if failures:
            sys.exit("\n".join(["duet: tests/house/vocabulary.txt:", *failures]))


main(sys.argv[1:])
