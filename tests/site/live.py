#!/usr/bin/env python3
# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""The pages that compute, in a browser, from disk: whatever their reader moves, the numbers that come out are those of the
same functions compiled for this machine; no page complains, is too large or wider than the screen; where there is no
WebAssembly it says so, and shows its picture. Claims are judged as by duet-check-formula, within a time limit, and what is
typed is text. Writes pictures of them.

usage: python3 tests/site/live.py <folder of pages and libraries> <folder for pictures>
"""

import ctypes
import gzip
import json
import re
import sys
from pathlib import Path

from browser import Browser
from reader import Reader

SOURCES = Path(__file__).resolve().parent.parent.parent / "docs/case-studies"
LARGEST = 500_000  # compressed
# Of what numbers are relative to; see `scales`.
TOLERANCE = 1e-12
NO_WEBASSEMBLY = "delete window.WebAssembly"


class Native:
    """The functions of a page, compiled for this machine."""

    def __init__(self, folder, name):
        library = ctypes.CDLL(str(folder / f"{name}.so"))
        kinds = {"int": ctypes.c_int, "double": ctypes.c_double}
        self.functions = {}
        source = (SOURCES / f"interactive/{name}.cpp").read_text()
        for result, function, parameters in re.findall(r"DUET_LIVE (void|int) (\w+)\((.*?)\)", source, re.DOTALL):
            self.functions[function] = called = getattr(library, function)
            called.restype = kinds.get(result)
            called.argtypes = [ctypes.POINTER(ctypes.c_double) if "*" in each else kinds[each.split()[0]]
                               for each in parameters.split(",")]

    def __call__(self, function, inputs, size):
        """Its numbers, and what it returned."""
        given = [(ctypes.c_double * len(x))(*x) if isinstance(x, list) else x for x in inputs]
        out = (ctypes.c_double * size)()
        returned = self.functions[function](*given, out)
        return list(out), returned


def scales(function, inputs, numbers):
    """What errors of numbers are relative to: the largest of them, but of errors in percent the rates, 100 %, or themselves
    where they are more."""
    if function != "errors_of_spline":
        return [max(map(abs, numbers))] * len(numbers)
    rows = inputs[0]
    heights = {2, 5, 8, 11, *range(12, 12 + rows)}
    return [.2 if i in heights else max(100, abs(x)) for i, x in enumerate(numbers)]


class Page:
    def __init__(self, reader, folder, name):
        self.reader, self.folder, self.name = reader, folder, name
        self.address = (folder / f"{name}.html").as_uri()
        self.native = Native(folder, name)
        self.compared = set()
        self.worst = 0

    def open(self, width, is_dark=False):
        self.reader.is_as_wide_as(width, 844 if width < 600 else 900, is_dark)
        self.reader.open(self.address)
        self.reader.wait_for(f"duetLive.pages.{self.name}?.first_figure > 0")

    def value_of(self, expression):
        return self.reader.value_of(expression)

    def calls(self):
        """What the page asked duet last, function by function."""
        self.reader.wait_for_frames()
        return self.value_of(f"duetLive.pages.{self.name}.calls")

    def compare(self, when):
        """The page's numbers with this machine's."""
        for function, call in self.calls().items():
            numbers, returned = self.native(function, call["inputs"], len(call["numbers"]))
            expect(call.get("returned") == returned, f"{self.name}, {when}: {function} returns {call.get('returned')}, not {returned}")
            for i, (x, y, scale) in enumerate(zip(numbers, call["numbers"], scales(function, call["inputs"], numbers))):
                off = abs(x - y) / scale if scale else abs(x - y)
                expect(off <= TOLERANCE, f"{self.name}, {when}: {function}{call['inputs']}[{i}] is {y}, not {x}")
                self.worst = max(self.worst, off)
            self.compared.add(function)

    def move(self, number, *keys):
        """Presses keys on one of the sliders and choices."""
        before = self.calls()
        self.value_of(f"document.querySelectorAll('.live-control input, .live-control select')[{number}].focus()")
        for key in keys:
            self.reader.press(key)
        expect(self.calls() != before, f"{self.name}: {keys} on control {number} change nothing")

    def set(self, number, value, kind="input"):
        """Puts one of the sliders and choices to a value."""
        self.value_of(f"""(control => {{
          control.value = {value};
          control.dispatchEvent(new Event("{kind}"));
        }})(document.querySelectorAll(".live-control input, .live-control select")[{number}])""")

    def cell(self, table, row, column):
        """The text of a cell."""
        return self.value_of(f"document.querySelectorAll('.live-table table')[{table}].rows[{row}].cells[{column}].textContent")

    def picture(self, pictures, name):
        self.reader.wait_for_frames()
        self.reader.picture(pictures / f"{self.name}_{name}.png")

    def check_width(self, width):
        wide = self.value_of("document.documentElement.scrollWidth")
        expect(wide <= width, f"{self.name} is {wide} wide on a screen of {width}")

    def check_complaints(self, when):
        complaints = self.reader.complained()
        expect(not complaints, f"{self.name}, {when}, complains: {complaints}")


failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)


def number_of(text):
    """3.2 × 10⁻⁵ and −0.5 mm as numbers."""
    digits = text.replace("−", "-").translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    return float(re.match(r"[-0-9.e]+", digits.replace(" × 10", "e"))[0])


def check_shown(page, text, value, digits=2):
    """A text is a value in so many significant digits."""
    shown = number_of(text)
    expect(abs(shown - value) <= .51 * 10 ** (1 - digits) * abs(value), f"{page.name} shows {text}, which is {value}")


def check_size(page):
    text = (page.folder / f"{page.name}.html").read_text()
    files = [page.folder / f"{page.name}.html"]
    files += [(page.folder / address).resolve() for address in re.findall(r"(?:src|href)=\"(.*?)\"", text)]
    size = sum(len(gzip.compress(file.read_bytes())) for file in files)
    expect(size <= LARGEST, f"{page.name} has {size} bytes, compressed")
    return size


def check_drag(page, selector, by, touch=False):
    """A handle follows the mouse, or a finger, and the page stays where it is."""
    start = page.reader.middle(selector)
    before, scrolled = page.calls(), page.value_of("scrollY")
    end = [start[0] + by[0], start[1] + by[1]]
    page.reader.swipe(start, end) if touch else page.reader.drag(start, end)
    expect(page.calls() != before, f"{page.name}: {selector} is not dragged")
    expect(page.value_of("scrollY") == scrolled, f"{page.name}: dragging {selector} scrolls the page")


def check_keys(page, selector, *keys):
    before = page.calls()
    page.value_of(f"document.querySelector('{selector}').focus()")
    for key in keys:
        page.reader.press(key)
    expect(page.calls() != before, f"{page.name}: {keys} on {selector} change nothing")


def try_wheel_carrier(page):
    def largest_errors(row):
        return page.calls()["errors_of_spline"]["numbers"][3 * row + 1]

    # What stands in the document, of 105 rows.
    document = (SOURCES / "wheel_carrier.md").read_text()
    line = re.search(r"^\| clamped ends: closed form \|(.*)\|$", document, re.MULTILINE)[1].split("|")
    for row, column in ((1, 0), (3, 4)):
        for k in (0, 1):
            value = float(line[column + k])
            expect(number_of(page.cell(0, row, k + 1)) == value, f"the document has {value}, the page {page.cell(0, row, k + 1)}")

    for rows, kinds in ((2, range(4)), (9, range(4)), (13, [0])):
        page.set(0, rows)
        for kind in kinds:
            page.set(1, kind, "change")
            for ends in range(5 if kind == 2 else 1 if kind == 3 else 4):
                page.set(2, ends, "change")
                page.compare(f"spline {kind}, ends {ends}")
    page.set(0, 2)
    page.set(1, 0, "change")
    page.set(2, 2, "change")
    before = largest_errors(0)
    page.move(0, "ArrowLeft")
    expect(largest_errors(0) > 1.5 * before, "fewer rows are as good")
    page.move(3, "ArrowRight", "ArrowRight")
    page.compare("moved by keys")
    call = page.calls()["errors_of_spline"]
    native, _ = page.native("errors_of_spline", call["inputs"], len(call["numbers"]))
    for row, i in ((1, 0), (2, 6), (3, 3), (4, 9)):
        check_shown(page, page.cell(0, row, 1), native[i])
        check_shown(page, page.cell(0, row, 2), native[i + 1])
    check_drag(page, ".live-chosen", (40, 0))
    page.compare("height dragged")


def check_motion(page):
    """The true rates are those of the curve that is drawn, by differences, and what the page says of the printed ones is what
    the document does."""
    numbers = page.calls()["motion_of_curve"]["numbers"]
    rows = [numbers[i:i + 20] for i in range(0, len(numbers), 20)]
    step = rows[1][0] - rows[0][0]
    for before, row, after in zip(rows, rows[1:], rows[2:]):
        slope = [(b - a) / (2 * step) for a, b in zip(before, after)]
        mark, omega = row[5:8], row[8:11]
        velocity = [omega[i - 2] * mark[i - 1] - omega[i - 1] * mark[i - 2] for i in range(3)]
        near = (row[0] + 2 * step) % 1 < 4 * step  # a row, where the acceleration has a kink
        for k in range(3):
            expect(abs(slope[5 + k] - velocity[k]) < 1e-3, f"at u = {row[0]} the mark moves by {slope[5 + k]}, not {velocity[k]}")
            expect(near or abs(slope[8 + k] - row[11 + k]) < 1e-3, f"at u = {row[0]} α is {row[11 + k]}, not {slope[8 + k]}")
    document = re.search(r"off by up to\s+(\d+)\s+degrees", (SOURCES / "two_sources.md").read_text())[1]
    said = page.value_of("document.querySelector('.live-says').textContent")
    expect(f"at most by {document}." in said, f"the document says {document} degrees, the page {said}")


def try_rotations(page):
    check_motion(page)
    for reading in range(3):
        for ends in range(2):
            page.set(2, reading, "change")
            page.set(3, ends, "change")
            page.compare(f"printed {reading}, ends {ends}")
    page.move(0, "ArrowRight", "ArrowRight")
    page.move(1, "ArrowLeft")
    check_drag(page, ".live-handle:nth-child(2)", (25, -30))
    page.compare("dot dragged")
    check_keys(page, ".live-handle:nth-child(4)", "ArrowUp", "ArrowRight")
    page.compare("dot moved by keys")


def try_arm(page):
    for arm in range(3):
        page.set(0, arm, "change")
        page.compare(f"arm {arm}")
        expect(page.calls()["solutions_of_arm"]["returned"] > 0, f"arm {arm}: no joints for the goal at first")
        expect(page.calls()["plan_of_arm"]["numbers"][0] == 0, f"arm {arm}: the goal at first is not reached")
        # At the end the tip is at the goal.
        page.set(1, 1)
        calls = page.calls()
        off = [a - b for a, b in zip(calls["links_of_arm"]["numbers"][-3:], calls["moved_pose"]["numbers"][-3:])]
        expect(max(map(abs, off)) < 2e-6, f"arm {arm}: at the end the tip is off its goal by {off}")
        page.set(1, .5)
        if arm == 1:
            expect(page.calls()["solutions_of_arm"]["returned"] == 8, "the UR5e has not eight ways to the goal at first")
    page.set(0, 0, "change")
    page.move(1, "ArrowRight", "ArrowRight")
    page.move(4, "ArrowRight")
    page.compare("moved by keys")
    theta = page.calls()["singular_values_of_arm"]["inputs"][1]
    shown = page.value_of("[...document.querySelectorAll('.live-bar output')].map(e => e.textContent)")
    for text, x in zip(shown, theta, strict=True):
        expect(abs(number_of(text) - x * 57.29577951308232) < .0501, f"arm shows {text}, which is {x} rad")
    check_drag(page, ".live-handle:nth-child(1)", (-20, 15))
    page.compare("goal dragged")
    check_keys(page, ".live-handle:nth-child(2)", "ArrowRight", "ArrowRight")
    check_drag(page, ".live-handle:nth-child(2)", (-10, 15))
    page.compare("tip dragged")
    # Out of reach, and out of the picture, at whose edge it stays.
    check_drag(page, ".live-handle:nth-child(1)", (500, 0))
    expect(page.calls()["plan_of_arm"]["numbers"][0] != 0, "the goal far away is reached")
    expect("out of reach" in page.value_of("document.querySelector('.live-says').textContent"), "the page does not say that the goal is out of reach")


class Claims:
    """The page of claims: what it says of them, and what this machine does."""

    FIELDS = ("formula", "claimed", "variable", "vectors", "rotations")

    def __init__(self, page):
        self.page = page
        self.native = ctypes.CDLL(str(page.folder / f"{page.name}.so")).judgement_of
        self.native.restype = ctypes.c_char_p

    def on_this_machine(self, *claim):
        return json.loads(self.native(*(text.encode() for text in (*claim, "", "", "", "")[:5])))

    def answer(self):
        """The page's, once there is one, and the text that says it."""
        self.page.reader.wait_for(f"duetLive.pages.{self.page.name}.answer")
        return self.page.value_of(f"[duetLive.pages.{self.page.name}.answer, document.querySelector('.live-verdict').innerText]")

    def type(self, *claim):
        for name, text in zip(self.FIELDS, (*claim, "", "", "", "")):
            self.page.value_of(f"document.getElementById('check-{name}').value = {json.dumps(text)}")

    def judged(self, *claim):
        """By the page, as by this machine."""
        self.type(*claim)
        self.page.value_of("document.querySelector('.live-form').requestSubmit()")
        answer, said = self.answer()
        expected = self.on_this_machine(*claim)
        for each in (answer, expected):
            each.pop("loses_digits_at", 0)  # in which double precision of machines differs
        expect(answer == expected, f"{claim}: the page answers {answer}, not {expected}")
        return said

    def chosen(self, number):
        """The text that says the verdict on an example."""
        self.page.value_of(f"document.querySelectorAll('.live-buttons button')[{number}].click()")
        return self.answer()[1]

    def expect_said(self, said, *parts):
        for part in parts:
            expect(part in said, f"{self.page.name} says {said!r} without {part!r}")


FUNCTIONS = """sqrt(x) cbrt(x) exp(2x) exp2(x) expm1(x) log(x) log2(x) log10(x) log1p(x) sin(x) cos(x) tan(x) asin(x) acos(x)
    atan(x) sinh(x) cosh(x) tanh(x) asinh(x) acosh(x) atanh(x) erf(x) erfc(x) abs(x) x^-2 x^x 2^(3x) atan2(x,y) hypot(x,y) floor(x) fmod(x,3)
    remainder(y,x) fma(x,x,x) x*y/(x+y) max(x,y) stumpff0(x) stumpff2(x) arc_ratio(x,y) x*tgamma(y) x*lgamma(y) x*floor(y) x*ceil(y) x*abs(y)
    x*select(y<1&&y!=0||!(y<=3),y,2) x^2*theta_1 x/1e-9 sqrt(x)*sin(x)^2 quaternion(x,1,2,3) [x,x^2,sin(x)] pi*x x*inf""".split()


def try_claims(page):
    claims = Claims(page)
    for number, parts in enumerate((
            ["Right, and proved", "with respect to x"], ["Wrong", "x = 1", "1.38177329067604", "−0.301168678939757", "cos(x) - x * sin(x)", "\\cos(x) - x \\sin(x)"],
            ["Wrong", "t = 0", "[1, 0, 0]", "[2, 0, 0]"], ["Right, wherever", "x = 0, only your derivative has a value", "x = 1e-08"],
            ["Right, and proved", "with respect to w"])):
        claims.expect_said(claims.chosen(number), *parts)
    claims.expect_said(claims.judged("x^3", "3x^2"), "Right, and proved", "122 agree.")
    claims.expect_said(claims.judged("theta^3 + y", "theta^2", "theta"), "Wrong", "theta = ")
    expect(page.value_of("document.querySelector('.live-math math').textContent") == "3θ2", "the derivative is not typeset")
    claims.expect_said(claims.judged("sqrt(-1 - x^2)", "1"), "No verdict")
    claims.expect_said(claims.judged("rotate(q*p, w)", "rotate(q, rotate(p, w))", "w", "w", "q p"), "numbers")
    claims.expect_said(claims.judged("tgamma(x)", "1"), "gamma function")
    claims.expect_said(claims.judged("x*y", "y"), "With respect to: ", "name one of x, y")
    claims.expect_said(claims.judged("x*y", "y", "z"), "no variable 'z'")
    # Errors, and the caret at their columns.
    claims.expect_said(claims.judged("sin(x))", "1"), "Formula: column 7", "\n      ^")
    expect(page.value_of("[document.activeElement.id, document.activeElement.selectionStart]") == ["check-formula", 6], "the cursor is not at the error")
    claims.expect_said(claims.judged("𝑥*𝑥", "2𝑥 +"), "Your derivative: column 5")
    # What is typed is text.
    hostile = "<img src=none onerror=\"document.title='run'\">"
    title = page.value_of("document.title")
    for i in range(len(Claims.FIELDS)):
        claims.expect_said(claims.judged(*["x^2", "2x", "", "", ""][:i], hostile, *["2x", "", "", ""][i:]), "img" if i > 1 else hostile)
    claims.expect_said(claims.judged("x", "x", "", "θ1, <b>bold</b>"), "<b>bold</b>")
    page.reader.wait_for_frames()
    expect(page.value_of("document.querySelectorAll('.live-host img, .live-host b').length") == 0 and page.value_of("document.title") == title, "what is typed is read as HTML")
    # All functions, typeset.
    for function in FUNCTIONS:
        latex = claims.on_this_machine(function, "[1, 2, 3]" if function[0] == "[" else "quaternion(1,1,1,1)" if function[0] == "q" else "1", "x").get("latex")
        expect(latex and page.value_of(f"Boolean(duetLive.pages.{page.name}.typeset({json.dumps(latex)}))"), f"the derivative of {function} is not typeset: {latex}")
    # A claim that takes long, and the next one.
    page.value_of(f"duetLive.pages.{page.name}.time_limit = .2")
    claims.type("*".join(f"sin(x+{i})^x" for i in range(3000)), "1")
    page.value_of("document.querySelector('.live-form').requestSubmit()")
    claims.expect_said(claims.answer()[1], "Stopped", "after 0.2 s")
    page.value_of(f"duetLive.pages.{page.name}.time_limit = 60")
    claims.type("sin(2x)", "2cos(2x)")
    page.value_of("document.getElementById('check-claimed').focus()")
    page.reader.press("Enter")
    claims.expect_said(claims.answer()[1], "Right, and proved")


def check_without_webassembly(page):
    script = page.reader.call("Page.addScriptToEvaluateOnNewDocument", source=NO_WEBASSEMBLY)["identifier"]
    for width in (390, 1280):
        page.reader.is_as_wide_as(width)
        page.reader.open(page.address)
        page.reader.wait_for("[...document.images].every(image => image.complete)")
        said = page.value_of("document.querySelector('.live-missing').textContent")
        expect("WebAssembly, which is missing" in said, f"{page.name} without WebAssembly says {said}")
        shown = page.value_of("(shown => shown.length > 0 && shown.every(i => i.naturalWidth !== 0 && i.offsetWidth > 0))([...document.querySelectorAll('.live img, .live pre')])")
        expect(shown, f"{page.name} without WebAssembly shows no picture")
        expect(not page.value_of("document.querySelectorAll('.live-host').length"), f"{page.name} without WebAssembly is live")
        page.check_width(width)
        page.check_complaints("without WebAssembly")
    page.reader.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


def check_on_a_phone(page, handle):
    page.reader.call("Emulation.setTouchEmulationEnabled", enabled=True)
    page.open(390)
    page.check_width(390)
    check_drag(page, handle, (12, 30), touch=True)
    page.compare("touched")
    page.check_width(390)
    page.check_complaints("touched")
    page.reader.call("Emulation.setTouchEmulationEnabled", enabled=False)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folder, pictures = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    pictures.mkdir(parents=True, exist_ok=True)
    tries = {"wheel_carrier": (try_wheel_carrier, None), "rotations": (try_rotations, ".live-handle:nth-child(3)"),
             "arm": (try_arm, ".live-handle:nth-child(1)"), "check_derivative": (try_claims, None)}
    with Browser() as browser:
        reader = Reader(browser)
        for name, (attempt, handle) in tries.items():
            page = Page(reader, folder, name)
            size = check_size(page)
            page.open(1280)
            first_figure = page.value_of(f"duetLive.pages.{name}.first_figure")
            attempt(page)
            page.check_complaints("moved")
            expect(page.compared == set(page.native.functions), f"{name}: {set(page.native.functions) - page.compared} were not compared")
            if handle:
                check_on_a_phone(page, handle)
            check_without_webassembly(page)
            for width in (390, 1280):
                for is_dark in (False, True):
                    suffix = f"{width}{'_dark' if is_dark else ''}"
                    page.open(width, is_dark)
                    page.check_width(width)
                    page.picture(pictures, suffix)
                    if name == "check_derivative":
                        Claims(page).chosen(2)
                    else:
                        page.move(0, *(["ArrowDown"] if name == "arm" else ["ArrowLeft"] * 3))
                    page.check_width(width)
                    page.picture(pictures, f"{suffix}_moved")
                    page.check_complaints(suffix)
            print(f"{name}: {size} bytes compressed, first figure after {first_figure:.0f} ms, numbers within {page.worst:.1e} of this machine's")
    for failure in failures:
        print(f"duet: {failure}", file=sys.stderr)
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
