# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Compiles and runs every ```cpp block of documents that has a main(). Where a ```text block follows, with nothing but
blank lines between, it must be what the program prints. Other blocks are excerpts for the eye and are not compiled.

A program that begins with duet/duet.hpp, as all do that can, is given this header precompiled and the instantiations that
tests share, but no other header: it must include what else it needs. One that includes a header of duet/io or duet/robotics
is linked to the libraries, one that includes duet/interop/ceres to Ceres, without which it is left out; others must do
without.

With --part a part of the programs, such as the first of four by 1/4, is compiled together, each in a namespace, which
takes less time. That overlooks a program that lacks a header which another one before it includes, or a library, and
one whose names would be ambiguous beside those of duet.

usage: check.py [--part <i>/<n>] [--precompiled <header> --instantiated <header> --optimised <object file>]
         [--libraries <files and flags>] [--ceres <flags>] --folder <for programs> --documents <file>...
         --compiler <and flags>
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

BLOCK = re.compile(r"\n```cpp\n(.*?\n)```(?:\n+```text\n(.*?\n)```)?", re.DOTALL)
MAIN = "\nint main() {\n"


class Program:
    def __init__(self, document, number, text, block):
        self.document, self.number = document, number
        self.code, self.printed = block[1], block[2]
        self.line = text[:block.start(1)].count("\n") + 1
        self.needs_libraries = bool(re.search("#include <duet/(io|robotics)[/.]", self.code))
        self.needs_ceres = "#include <duet/interop/ceres" in self.code
        # Else it would run for longer than that takes.
        self.flags = ["-O1"] if "judge_cost_function" in self.code else []
        # What is at the top of a file, not in a namespace.
        self.is_alone = bool(self.flags or re.search(r"^(#(?!include )|namespace|template <>|extern)", self.code, re.MULTILINE)
                             or MAIN not in self.code or not self.code.endswith("\n}\n"))

    def __str__(self):
        return f"program {self.number} of {self.document}"

    def includes(self):
        return re.findall(r"^#include .*\n", self.code, re.MULTILINE)

    def in_namespace(self, name):
        """Its headers before it. A main() may end without a result."""
        code = re.sub(r"^#include .*", "", self.code, flags=re.MULTILINE)
        code = code.replace(MAIN, "\nint run() {\n")
        return (f"{''.join(self.includes())}namespace {name} {{\n"
                f'#line {self.line} "{self.document}"\n{code[:-2]}return 0; }}\n}}\n')


def programs_of(document):
    text = document.read_text()
    blocks = [block for block in BLOCK.finditer(text) if "int main(" in block[1]]
    return [Program(document, i + 1, text, block) for i, block in enumerate(blocks)]


def part_of(programs, part):
    """A part of the programs, of about as much code as the others, those with the same headers together."""
    i, n = map(int, part.split("/"))
    programs = sorted(programs, key=lambda p: (p.needs_ceres, p.needs_libraries, "<duet/expression/" in p.code,
                                               sorted(p.includes())))
    size, before, result = sum(len(p.code) for p in programs), 0, []
    for program in programs:
        if before * n // size == i - 1:
            result.append(program)
        before += len(program.code)
    return result


def compile_together(arguments, programs):
    """The command that runs each."""
    cases = "".join(f"case {i}: return program_{i}::run();\n" for i in range(len(programs)))
    text = "".join(program.in_namespace(f"program_{i}") for i, program in enumerate(programs))
    text += f"int main(int, char** arguments) {{\nswitch (std::stoi(arguments[1])) {{\n{cases}default: return 1;\n}}\n}}\n"
    precompiled = ["-include", arguments.precompiled, "-include", arguments.instantiated]
    link = [arguments.optimised, *arguments.libraries]
    if any(program.needs_ceres for program in programs):
        link += arguments.ceres
    executable = arguments.folder / "together"
    compile_text(arguments, executable, text, [*precompiled, "-include", "string"], link, "programs do not compile together")
    return [[executable, str(i)] for i in range(len(programs))]


def compile_alone(arguments, program):
    precompiled, link = [], list(program.flags)
    if arguments.precompiled and re.match(r"\n*#include <duet/duet.hpp>\n", program.code):
        precompiled = ["-include", arguments.precompiled, "-include", arguments.instantiated]
        link.append(arguments.optimised)
    link += arguments.libraries if program.needs_libraries else []
    link += arguments.ceres if program.needs_ceres else []
    executable = arguments.folder / f"{program.document.stem}_{program.number}"
    text = f'#line {program.line} "{program.document}"\n{program.code}'
    compile_text(arguments, executable, text, precompiled, link, f"{program} does not compile")
    return [executable]


def compile_text(arguments, executable, text, precompiled, link, complaint):
    file = executable.with_suffix(".cpp")
    file.write_text(text)
    command = [*arguments.compiler, "-Wall", "-Wextra", "-Werror", *precompiled, file, "-o", executable, *link]
    if subprocess.run(command, check=False).returncode != 0:
        sys.exit(complaint)


def check(arguments, program, command):
    folder = arguments.folder / program.document.stem
    folder.mkdir(exist_ok=True)
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"{run.stdout}\n{run.stderr}\n{program} ends with {run.returncode}")
    if program.printed not in (None, run.stdout):
        sys.exit(f"It prints\n{run.stdout}\nbut the document says\n{program.printed}\n"
                 f"{program} does not print what follows it")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--part")
    for name in ("precompiled", "instantiated", "optimised"):
        parser.add_argument(f"--{name}")
    for name in ("libraries", "ceres"):
        parser.add_argument(f"--{name}", type=lambda flags: flags.split(";") if flags else [], default=[])
    parser.add_argument("--folder", type=lambda folder: Path(folder).resolve())
    parser.add_argument("--documents", type=Path, nargs="*")
    parser.add_argument("--compiler", nargs=argparse.REMAINDER)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    programs = [program for document in arguments.documents for program in programs_of(document)]
    if not arguments.ceres:
        for program in filter(lambda program: program.needs_ceres, programs):
            print(f"{program} is left out: there is no Ceres")
        programs = [program for program in programs if not program.needs_ceres]
    together = []
    if arguments.part:
        programs = part_of(programs, arguments.part)
        together = [program for program in programs if not program.is_alone]
        for program, command in zip(together, compile_together(arguments, together)):
            check(arguments, program, command)
    for program in programs:
        if program not in together:
            check(arguments, program, compile_alone(arguments, program))
    print(f"{len(programs)} programs compiled and run")


main()
