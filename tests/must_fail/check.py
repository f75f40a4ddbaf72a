# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Checks code that must not compile. A snippet says in its first lines

    // expect: <regex that a line of the compiler's errors or notes must match>
    // flags: <flags for both compilations, optional>
    // wrong flags: <flags for the mistake alone, optional>
    // within: <by which line of the compiler's output it must be said, optional>
    // forms: <how many forms the mistake has: DUET_MUST_FAIL is 1, 2 ... for them, optional>

A blank line and statements follow. One that ends with `// wrong` is a form of the mistake, compiled with those without a
mark; `// wrong, too` adds to the form before. Those that end with `// right` are the control, which must compile: else the
mistake may fail for the wrong reason. Statements alone, without functions and types, are put into a main function. Code
can also ask for DUET_MUST_FAIL, the number of the form. Of several mistakes in one form each ends with `// mistake`: the
compiler must name every one of them.

A table <layer>.cpp has many of them, each below a line `//// <name>`; what stands above the first is for all. They are
compiled together, each in a namespace of its own, and errors are told apart by the lines that they name. A snippet whose
errors are not as they must be is compiled once more, alone, as compilers report an error of one type only once. Snippets
with flags of their own are files.

usage: check.py [--control] [--precompiled <header>] [--name <snippet>] <file> <folder> <compiler and flags>
"""

import argparse
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

KEYS = ("expect", "flags", "wrong flags", "within", "forms")
# What compilers write before an error, not after it: where it is.
CONTEXT = re.compile(r"In file included from |\s+from .*[,:]$|.*: (In|At) .*:$|.*:\d+:\d+:\s+(recursively )?required |"
                     r".*:\d+:\d+:\s+in .constexpr. expansion of |\s*(required|recursively) ")
ERROR = re.compile(r"[^ ].*?: (fatal )?error: ")
MARK = re.compile(r".*// (wrong|wrong, too|right|mistake)$")
# Begins a definition, which no function may hold.
DEFINITION = re.compile(r"(namespace|template|struct)\b|[\w:<>]+ \w+\([^;]*\) \{")


def forms_of(code):
    """The form of the mistake that each line is for: 0 for the control, None for all."""
    result, start, depth, form = [], 0, 0, 0
    for i, line in enumerate(code):
        text = re.sub(r'"(?:\\.|[^"\\])*"|//.*', "", line).rstrip()
        depth += len(re.findall(r"[(\[{]", text)) - len(re.findall(r"[)\]}]", text))
        in_main = code[:i].count("int main() {")
        if text != "int main() {" and (depth > in_main or text and text[-1] not in ";}" and text[0] != "#"):
            continue
        marks = {mark[1] for mark in map(MARK.match, code[start:i + 1]) if mark}
        form += marks == {"wrong"} or form == 0 and bool(marks - {"right"})
        result += [(0 if marks == {"right"} else form) if marks else None] * (i + 1 - start)
        start = i + 1
    return result + [None] * (len(code) - start)


class Snippet:
    def __init__(self, name, lines, first_line, faults):
        """Of its lines, the first of which has that number in the file."""
        self.name, self.first_line = name, first_line
        end = lines.index("") if "" in lines else len(lines)
        self.keys = {}
        for line in lines[:end]:
            key = re.match(rf"// ({'|'.join(KEYS)}): (.*)", line)
            if key:
                self.keys[key[1]] = key[2]
            else: # a formatter has wrapped a line
                faults.append(f"{name}: not a line of a key: {line}")
        if "expect" not in self.keys:
            faults.append(f'{name} has no line "// expect: <regex>"')
        self.flags, self.wrong_flags = (shlex.split(self.keys.get(key, "")) for key in ("flags", "wrong flags"))
        self.code = [""] * end + lines[end:]
        if any(map(MARK.match, self.code)) and not any(map(DEFINITION.match, self.code)):
            self.code[end] = "int main() {"
            self.code[-1] += "}"
        self.forms_of = forms_of(self.code)
        self.forms = int(self.keys.get("forms", max(form or 1 for form in self.forms_of)))
        self.mistakes = [i + first_line for i, line in enumerate(self.code) if line.endswith("// mistake")]

    def parts(self, form):
        """Includes and code of a form."""
        lines = [line if of in (None, form) else "" for line, of in zip(self.code, self.forms_of)]
        return ([line for line in lines if line.startswith("#include ")],
                ["" if line.startswith("#include ") else line for line in lines])

    def alone(self, table, form):
        includes, code = self.parts(form)
        if any(line.startswith("#if") for line in self.code): # which an include may depend on
            includes, code = [], self.code
        return "\n".join([f'#line 1 "{table.label(1)}"', *table.for_all, *includes,
                          f'#line {self.first_line} "{table.label(1)}"', *code, ""])

    def in_namespace(self, table, form):
        """Beside others, its includes before it. Form 0 is the control."""
        includes, code = self.parts(form)
        mistake = [f"#define DUET_MUST_FAIL {form}"] if form else []
        return "\n".join([*includes, "#undef DUET_MUST_FAIL", *mistake, f"namespace {self.name}_{form} {{",
                          f'#line {self.first_line} "{table.label(form)}"', *code, "}", ""])


class Table:
    def __init__(self, path, faults):
        self.path = path
        lines = path.read_text().split("\n")
        starts = [i for i, line in enumerate(lines) if line.startswith("//// ")]
        self.for_all = lines[:starts[0]] if starts else []
        ends = [*starts[1:], len(lines)]
        self.snippets = [Snippet(lines[i][5:], lines[i + 1:end], i + 2, faults) for i, end in zip(starts, ends)]
        if not starts: # the first line is the licence
            self.snippets = [Snippet(path.stem, lines[1:], 2, faults)]

    def label(self, form):
        """Its name in the compiler's messages."""
        return f"{self.path.stem}.cpp" if form <= 1 else f"{self.path.stem}.form_{form}.cpp"


class Compiler:
    def __init__(self, arguments):
        self.command, self.folder = arguments.compiler, arguments.folder
        self.command += ["-fsyntax-only", "-fdiagnostics-color=never"]
        self.is_clang = "clang" in self.command[0]
        self.no_limit = ["-ferror-limit=0"] if self.is_clang else []
        self.precompiled = ["-include", arguments.precompiled] if arguments.precompiled else []

    def __call__(self, name, text, *flags, is_precompiled):
        """Whether it compiles, and what the compiler says, in English."""
        file = self.folder / f"{name}.cpp"
        file.write_text(text)
        run = subprocess.run([*self.command, *self.no_limit, *flags, *(self.precompiled if is_precompiled else []), file],
                             env={**os.environ, "LC_ALL": "C"}, capture_output=True, text=True, check=False)
        return run.returncode == 0, run.stderr


def errors_in(log):
    """Each error, with where it is before it and its notes behind it, as a list of lines."""
    errors, context = [[]], []
    for line in log.split("\n"):
        if ERROR.match(line):
            errors.append([*context, line])
            context = []
        elif CONTEXT.match(line):
            context.append(line)
        else:
            errors[-1] += [*context, line]
            context = []
    return errors[1:]


def fault_of(snippet, form, label, lines):
    """What is wrong with the errors of a mistake, which are these lines; nothing if they are as they must be."""
    expected = snippet.keys["expect"]
    matches = [i for i, line in enumerate(lines) if re.search(rf"(error|note): .*({expected})", line)]
    if not matches:
        return f"form {form}: it fails for another reason than: {expected}"
    if matches[0] >= int(snippet.keys.get("within", len(lines))):
        return f"form {form}: {matches[0]} lines come before: {expected}"
    unnamed = [number for number in snippet.mistakes if not any(f"{label}:{number}:" in line for line in lines)]
    return f"the mistake in line {unnamed[0]} is not complained of" if unnamed else ""


def fault_alone(compiler, table, snippet, form):
    # What fails for one mistake need not be compiled further.
    flags = [] if snippet.mistakes or "within" in snippet.keys else ["-Wfatal-errors"]
    compiles, log = compiler(f"{table.path.stem}_{snippet.name}", snippet.alone(table, form), *snippet.flags, *snippet.wrong_flags,
                             f"-DDUET_MUST_FAIL={form}", *flags, is_precompiled=not snippet.flags + snippet.wrong_flags)
    if compiles:
        return f"form {form}: it compiles, but should have failed with: {snippet.keys['expect']}"
    fault = fault_of(snippet, form, table.label(1), log.split("\n"))
    return f"{log}\n{fault}" if fault else ""


def faults_together(compiler, table, snippets):
    text = "\n".join([f'#line 1 "{table.label(1)}"', *table.for_all, ""])
    cases = [(snippet, form) for snippet in snippets for form in range(1, snippet.forms + 1)]
    text += "\n".join(snippet.in_namespace(table, form) for snippet, form in cases)
    errors = errors_in(compiler(table.path.stem, text, is_precompiled=True)[1])
    for snippet, form in cases:
        lines_of_code = range(snippet.first_line, snippet.first_line + len(snippet.code))
        label = table.label(form)
        own = []
        for error in errors:
            numbers = re.findall(rf"(?:^|[^\w.]){re.escape(label)}:(\d+):", "\n".join(error))
            own += error if any(int(number) in lines_of_code for number in numbers) else []
        if fault_of(snippet, form, label, own):
            print(f"alone: {snippet.name}, form {form}")
            fault = fault_alone(compiler, table, snippet, form)
            if fault:
                yield f"{snippet.name}: {fault}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--control", action="store_true")
    parser.add_argument("--precompiled")
    parser.add_argument("--name")
    parser.add_argument("file", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("compiler", nargs=argparse.REMAINDER)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    compiler = Compiler(arguments)
    faults = []
    table = Table(arguments.file, faults)
    snippets = [s for s in table.snippets if "expect" in s.keys and arguments.name in (None, s.name)]
    is_file = not table.for_all
    if arguments.control:
        text = "\n".join([*table.for_all, *(snippet.in_namespace(table, 0) for snippet in snippets)])
        if is_file:
            text = "\n".join(snippets[0].code)
        compiles, log = compiler(f"{table.path.stem}_control", text, *(snippets[0].flags if is_file else []),
                                 is_precompiled=not is_file)
        if not compiles:
            faults.append(f"{log}\nthe correct forms do not compile")
    if is_file:
        faults += [f"{snippet.name}: {fault}" for snippet in snippets for form in range(1, snippet.forms + 1)
                   if (fault := fault_alone(compiler, table, snippet, form))]
    else:
        faults += faults_together(compiler, table, snippets)
    sys.exit("\n".join(faults) or 0)


main()
