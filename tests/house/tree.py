# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Fails if a file breaks a rule of its folder: layers, includes and length of headers and sources, first lines of pages,
lists of tests.

usage: python3 tests/house/tree.py
"""

import functools
import posixpath
import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
MOST_LINES = 900
read = functools.partial(Path.read_text, encoding="utf-8")

# Permitted includes of each layer, in addition to those of the layers it lists. `Eigen` and `boost` are whole libraries,
# `boost/math` is a folder of one.
LAYERS = {
    "core": "", "dual": "core", "derivative": "dual Eigen", "quaternion": "derivative",
    "dual_quaternion": "quaternion boost/math", "comparison": "dual_quaternion", "expression": "dual_quaternion boost/mp11 boost/multiprecision",
    "spline": "dual_quaternion", "kinematics": "dual_quaternion", "motion": "kinematics", "io": "kinematics spline expat.h assimp",
    "robotics": "io motion", "interop": "comparison expression spline robotics boost ceres"}
ALLOWED = {}
for layer, used in LAYERS.items():
    ALLOWED[layer] = {layer}.union(*(ALLOWED.get(name, {name}) for name in used.split()))

# Names of std for which a header includes the standard header itself. (house/headers compiles each header alone.)
STD_NAMES = {
    "algorithm": "clamp copy fill lower_bound max min nth_element sort upper_bound", "array": "array to_array",
    "bit": "bit_cast bit_ceil countr_zero", "charconv": "from_chars to_chars", "cmath": "abs cos exp hypot log pow sin sqrt",
    "complex": "complex", "concepts": "constructible_from convertible_to derived_from floating_point integral invocable same_as",
    "cstddef": "ptrdiff_t size_t", "cstdint": "int64_t uint32_t uint64_t", "fstream": "ifstream ofstream", "functional": "function",
    "limits": "numeric_limits", "memory": "make_unique shared_ptr unique_ptr", "numeric": "accumulate iota",
    "optional": "nullopt optional", "span": "span", "sstream": "istringstream ostringstream",
    "stdexcept": "invalid_argument logic_error runtime_error", "string": "string to_string", "string_view": "string_view",
    "tuple": "tuple tuple_size_v", "type_traits": "conditional_t decay_t is_same_v remove_cvref_t",
    "utility": "exchange forward index_sequence move pair swap", "variant": "variant", "vector": "vector"}
STD_INCLUDE = re.compile(r"<([a-z_]+|[ei]mmintrin\.h|arm_neon\.h|math\.h|unistd\.h)>|\"duet: [^\"]*needs? [^\"]*: compile with[^\"]*\"")

# Words of compilers and processors, which only core/compiler/ has, and the few with two underscores that all headers may have.
COMPILER = re.compile(r"__[A-Za-z]\w*|_mm[0-9]*_[a-z]|_Pragma|gnu::|#pragma [^o][^\n]*|[a-z0-9_]+intrin\.h|arm_neon", re.A)
STANDARD = set("__cplusplus __cpp_exceptions __cpp_rtti __has_include __FAST_MATH__ __FINITE_MATH_ONLY__ __VA_ARGS__".split())

CONFIG = "duet/core/config.hpp"
FIRST_LINE = re.compile(r"# [^\n]*\n\nHeaders: (`duet/[a-z_/]+\.hpp`(?:, `duet/[a-z_/]+\.hpp`)*)\n")
SECOND_LINE = re.compile(r"# [^\n]*\n\n[^\n]*\n\nThis (?:page|tutorial) [^\n]*(?:\n[^\n]+)*[.:]\n")

problems = []


def problem_if(wrong, text):
    if wrong:
        problems.append(text)


texts = {path.relative_to(TOP / "include").as_posix(): read(path) for path in sorted((TOP / "include/duet").rglob("*.hpp"))}
# Sources of compiled libraries in src/<layer>/, and their private headers there and in folders below.
sources = {path.relative_to(TOP).as_posix(): read(path) for path in sorted((TOP / "src").rglob("*.[ch]pp"))}
includes = {header: re.findall(r"^[ \t]*#[ \t]*include[ \t]*(.*)", text, re.M) for header, text in (texts | sources).items()}


def private_headers(source):
    """What a source or private header includes of its library, by paths relative to its own folder."""
    names = [re.fullmatch(r'"([a-z_]+/)?([a-z_]+\.hpp)"', include) for include in includes[source]]
    return [f"{Path(source).parent.as_posix()}/{name[1] or ''}{name[2]}" for name in names if name]


def check_text(header, text):
    lines = text.count("\n")
    problem_if(lines > MOST_LINES, f"{header} has {lines} lines, more than {MOST_LINES}")
    same = re.search(r"/// The same.*", text)
    problem_if(same, f"{header}: a docstring must stand alone: {same and same[0]}")
    problem_if("\n#pragma once\n" not in text and header.endswith(".hpp"), f"{header} has no #pragma once")
    code = re.sub(r"//.*", "", text)
    problem_if(re.search(r"[ ;{](throw[ ;]|try [{]|catch [(])", code) and header != "duet/core/errors.hpp",
               f"{header} has a throw, try or catch: raise, catching of core/errors.hpp, which do without exceptions too")
    named = set(re.findall(r"std::([a-z0-9_]+)", code))
    included = set(includes[header]) # a source also has what the private header of its name includes
    for private in private_headers(header) if header.endswith(".cpp") else ():
        included.update(includes.get(private, ()) if Path(private).stem == Path(header).stem else ())
    for std_header, names in STD_NAMES.items():
        for name in sorted(named.intersection(names.split())) if f"<{std_header}>" not in included else ():
            problems.append(f"{header} says std::{name} and does not include <{std_header}>")
    words = [word for word in dict.fromkeys(COMPILER.findall(code)) if word not in STANDARD]
    problem_if(words and not header.startswith("duet/core/compiler/"), f"{header} has {';'.join(words)}, which is for core/compiler/")


def check_layer(header, layer):
    problem_if(layer not in LAYERS, f"{header} is in no layer")
    for include in includes[header] if layer in LAYERS else ():
        duet = re.match(r"<duet/([^/]*)/", include)
        library = re.match(r"<((Eigen|boost|assimp|ceres)[/a-z0-9_]*|expat\.h(?=>$))", include)
        if duet and duet[1] == "interop" != layer:
            problems.append(f"{header} includes {include}, but interop/ is for users alone")
        elif duet:
            formula = duet[1] == "expression" and header in ("duet/kinematics/chain_formula.hpp", "duet/spline/curve_formula.hpp")
            problem_if(duet[1] not in ALLOWED[layer] and not formula, f"{header} includes {include}, which is no layer below {layer}/")
        elif library:
            problem_if(library[1].startswith(("expat", "assimp")) and header in texts, f"{header} includes {include}, which is for src/ alone")
            bridge = library[2] and re.fullmatch(r"duet/dual/eigen[/_][a-z]*\.hpp", header)
            problem_if(not bridge and ALLOWED[layer].isdisjoint({"/".join(library[1].split("/")[:2]), library[2]}),
                       f"{header} includes {include}, but {layer}/ does without that library")
        elif header in sources and include.startswith('"'):
            problem_if(posixpath.normpath(f"{posixpath.dirname(header)}/{include[1:-1]}") not in sources,
                       f"{header} includes {include}, which there is not in src/")
        else:
            problem_if(not STD_INCLUDE.fullmatch(include),
                       f"{header} includes {include}, which is neither <duet/…>, nor Eigen, Boost, Ceres, expat, Assimp or std")


def reached_from(headers):
    reached, waiting = set(), list(headers)
    while waiting:
        header = waiting.pop().strip("<>")
        if header.startswith("duet/") and header not in reached:
            reached.add(header)
            waiting += includes.get(header, [])
    return reached


for source, text in sources.items():
    check_text(source, text)
    check_layer(source, source.split("/")[1])
for header, text in texts.items():
    check_text(header, text)
    if header.count("/") > 1:
        check_layer(header, header.split("/")[1])
    elif header != "duet/duet.hpp": # duet/<layer>.hpp
        of_layer = {f"<{other}>" for other in texts if re.fullmatch(rf"{header[:-4]}/[a-z_]+\.hpp", other)}
        problem_if(set(includes[header]) != of_layer, f"{header} does not include exactly the headers of {header[:-4]}/")
    # Before C++20 a header says so within five lines: config.hpp is its first include, or that of one or two in between.
    first = header
    for _ in range(3):
        if first in texts and first != CONFIG:
            first = (includes[first] or ["nothing"])[0].strip("<>")
    problem_if(CONFIG not in (first, header) and f"<{header}>" not in includes.get(CONFIG, []),
               f"{header} comes to {first} before core/config.hpp, which says that C++20 is needed")

problem_if(not texts, f"no headers in {TOP}/include/duet")
by_name = [f"duet/{name}" for name in re.findall(r"([a-z_/]+\.hpp)[,)]", texts.get("duet/duet.hpp", ""))]
for header in sorted(texts.keys() - reached_from(["duet/duet.hpp", "duet/io.hpp", "duet/robotics.hpp", *by_name])):
    problem_if(header.count("/") > 1 and not header.startswith("duet/interop/"), f"no header of all of duet includes or names {header}")
problem_if(any(header.startswith(("duet/io/", "duet/robotics/")) for header in reached_from(["duet/duet.hpp"])),
           "<duet/duet.hpp> includes a header of a compiled library")

for picture in sorted((TOP / "docs/figures").iterdir()):
    size = picture.stat().st_size
    problem_if(size > 204800, f"docs/figures/{picture.name} has {size} bytes, more than 200 kB: scripts/shrink_svg")

for path in sorted({*(TOP / "docs").rglob("*.md")} - {TOP / "docs/index.md"}):
    page, text = path.relative_to(TOP).as_posix(), read(path)
    headers = FIRST_LINE.match(text)
    problem_if(not headers, f"{page} has no line of headers below its title")
    problem_if(headers and not SECOND_LINE.match(text), f"{page} does not begin with a sentence about the page, as in: This page shows how to …")
    for header in re.findall(r"[a-z_/]+\.hpp", headers[1]) if headers else ():
        problem_if(not (TOP / "include" / header).exists(), f"{page} names {header}, which there is not")

# A test in no list never runs. Files that are compiled together have namespaces of their own, and only run their own cases.
for layer in [*LAYERS, "fuzz"]:
    folder = TOP / "tests" / layer
    listed = read(folder / "CMakeLists.txt") if (folder / "CMakeLists.txt").exists() else ""
    for path in sorted(set(folder.glob("*.cpp")) - {TOP / "tests/fuzz/libfuzzer.cpp"}):
        test = f"{layer}/{path.stem}"
        namespace = "test_" + test.replace("/", "_")
        if not re.search(rf"duet_add_test\({test}[ )\n]", listed):
            problems.append(f"tests/{test}.cpp is not in tests/{layer}/CMakeLists.txt")
        elif f"duet_add_test({test} ALONE" not in listed:
            problem_if(f"\nnamespace {namespace} {{\n" not in read(path), f"tests/{test}.cpp is not in namespace {namespace}")
    for path in sorted(folder.glob("*.hpp")):
        problem_if(re.search(r"\n *TEST_CASE", read(path)), f"tests/{layer}/{path.name} holds test cases, which no test would run")

if problems:
    sys.exit("\n".join(f"  {problem}" for problem in problems))
