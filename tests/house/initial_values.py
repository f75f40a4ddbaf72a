# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Fails where a public struct with fields is not among those of tests/robotics/initial_values.cpp.

usage: python3 tests/house/initial_values.py
"""

import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
HIDDEN = re.compile(r"detail|rule|op$|expression|doctest|std|Eigen|boost")
FIELD = re.compile(r"^  (?! |using|static|return|template|friend|constexpr|requires)[\w:<>, ]+ \w+( =.*|\{.*\})?;", re.M)

tried = (TOP / "tests/robotics/initial_values.cpp").read_text()
missing = []
for header in sorted((TOP / "include/duet").rglob("*.hpp")):
    spaces = []
    text = header.read_text()
    for line in re.finditer(r"^(?:(?:inline )?namespace (\S+) \{|\} // namespace|struct (\w+)(?: final)?(?: : [^\n]*)? \{\n(.*?)^\};)", text, re.M | re.S):
        if line[1]:
            spaces.append(line[1])
        elif not line[2]:
            spaces.pop()
        elif not HIDDEN.search("::".join(spaces)) and FIELD.search(line[3]) and not re.search(rf"\b{line[2]}\b", tried):
            missing.append(f"{header.relative_to(TOP)}: {line[2]}")
if missing:
    sys.exit("\n  ".join(["duet: not in tests/robotics/initial_values.cpp:", *missing]))
