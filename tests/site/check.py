#!/usr/bin/env python3
# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""What the folder of pages promises: every link and anchor leads somewhere, nothing is asked of the net, and in a browser no page
has a mathematics error, complains, or is wider than the screen; the search finds. Writes pictures of five pages.

usage: python3 tests/site/check.py <folder of pages> <folder for pictures>
"""

import base64
import json
import shutil
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

sys.dont_write_bytecode = True  # into the folder of sources
from browser import Browser, Tab

WIDTHS = (390, 1280)
SHOWN = ("index", "explanation/quaternions", "case-studies/wheel_carrier", "reference/formulas", "reference/dual_quaternion/screw")

# What of a page is wrong: mathematics that is an error or was not converted, what is wider than the screen, a picture that has to be
# scrolled, and on a wide screen a program.
FAULTS = r"""
((screen) => {
  const faults = [];
  const wide = document.documentElement.scrollWidth;
  if (wide > screen) {
    const widest = [...document.body.querySelectorAll("*")].filter((e) => e.getBoundingClientRect().right > screen + 1 &&
      !e.parentElement.closest(".table, .picture, pre, .formula, #found")).pop();
    faults.push(`is ${wide} wide on a screen of ${screen}: ${widest ? widest.outerHTML.slice(0, 120) : ""}`);
  }
  for (const box of document.querySelectorAll(screen < 1280 ? ".picture" : ".picture, pre.cpp")) {
    if (box.scrollWidth > box.clientWidth + 1) {
      faults.push(`has what is ${box.scrollWidth} wide in ${box.clientWidth} on a screen of ${screen}: ${box.textContent.trim().slice(0, 60)}`);
    }
  }
  for (const error of document.querySelectorAll("merror, .math.inline, .math.display")) {
    faults.push(`has mathematics that is none: ${error.textContent.slice(0, 60)}`);
  }
  const said = document.body.cloneNode(true);
  said.querySelectorAll("code, pre, script, svg").forEach((e) => e.remove());
  for (const left of said.textContent.match(/\\[a-zA-Z]+|\$[^$\n]+\$|\\[\[\]()]/g) ?? []) {
    faults.push(`shows ${left}`);
  }
  for (const image of document.images) {
    if (image.complete && image.naturalWidth === 0) {
      faults.push(`has no ${image.src}`);
    }
  }
  return faults;
})"""

# Terms of the field, each of which the search must find.
TERMS = [
    "forward kinematics", "inverse kinematics", "null space", "nullspace", "Karcher mean", "geodesic", "Lie group", "exponential map",
    "adjoint", "Denavit-Hartenberg", "gimbal lock", "slerp", "sclerp", "twist", "wrench", "manipulability", "redundancy resolution",
    "Gauss-Newton", "Levenberg-Marquardt", "automatic differentiation", "forward mode", "reverse mode", "Jacobian", "Hessian",
    "hand-eye calibration", "spline", "SE(3)", "SO(3)"]
SEARCH = r"""
((term) => new Promise((done) => {
  const query = document.getElementById("query");
  query.focus();
  const list = document.getElementById("found");
  list.replaceChildren();
  query.value = term;
  query.dispatchEvent(new Event("input"));
  const look = () => list.querySelector("li") ? done([...list.querySelectorAll("a")].map((a) => a.href)) : setTimeout(look, 20);
  look();
}))
"""


class Page(HTMLParser):
    """Anchors and addresses of a page."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loaded, self.twice = set(), [], [], []
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.twice += [value] if value in self.anchors else []
                self.anchors.add(value)
            elif name in ("href", "src", "xlink:href", "srcset", "data", "poster"):
                (self.links if tag == "a" else self.loaded).append(value)
            elif name == "style" and "url(" in (value or ""):
                self.loaded.append(value)


def faults_of_links(folder):
    """Of all pages, without a browser."""
    pages = {path: Page(path) for path in sorted(folder.rglob("*.html"))}
    faults = []
    for path, page in pages.items():
        name = path.relative_to(folder)
        faults += [f"{name} has two anchors {anchor}" for anchor in page.twice]
        for address in page.links + page.loaded:
            parts = urlsplit(address)
            if parts.scheme or parts.netloc:
                if address in page.loaded or parts.scheme not in ("http", "https", "mailto"):
                    faults.append(f"{name} loads {address}")
                continue
            if parts.path.startswith("/"):
                faults.append(f"{name} has the absolute address {address}")
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file() or not target.is_relative_to(folder):
                faults.append(f"{name} links to {address}, which there is not")
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
                faults.append(f"{name} links to {address}, whose anchor there is not")
    for path in list(folder.glob("*.css")) + list(folder.glob("*.js")):
        if "://" in path.read_text() and path.name != "search_index.js":
            faults.append(f"{path.name} names a host")
    return faults, list(pages)


def faults_of_page(tab, folder, path):
    faults = []
    for width in WIDTHS:
        tab.is_as_wide_as(width)
        if width == WIDTHS[0]:
            tab.open(path.as_uri())
        faults += [f"{path.relative_to(folder)} {fault}" for fault in tab.value_of(f"{FAULTS}({width})")]
    return faults + [f"{path.relative_to(folder)} complains: {each}" for each in tab.complained()]


def faults_of_search(tab, folder):
    tab.open((folder / "explanation/quaternions.html").as_uri())
    faults = [f"the search does not find {term}" for term in TERMS if not tab.value_of(f"{SEARCH}({json.dumps(term)})")]
    found = tab.value_of(f"{SEARCH}('sclerp')")
    wanted = (folder / "reference/dual_quaternion/screw.html").as_uri() + "#sclerp"
    return faults + [f"the search for sclerp finds {found}, and not {wanted}"] * (wanted not in found)


def write_pictures(tab, folder, pictures):
    pictures.mkdir(parents=True, exist_ok=True)
    for name in SHOWN:
        for width in WIDTHS:
            for is_dark in (False, True):
                tab.is_as_wide_as(width, 844 if width < 600 else 900, is_dark)
                tab.open((folder / f"{name}.html").as_uri())
                tab.value_of("document.fonts.ready.then(() => true)")
                file = f"{Path(name).name}_{width}{'_dark' if is_dark else ''}.png"
                (pictures / file).write_bytes(base64.b64decode(tab.screenshot()))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as elsewhere:
        folder = Path(elsewhere).resolve() / "moved here"
        shutil.copytree(sys.argv[1], folder)
        faults, pages = faults_of_links(folder)
        with Browser() as browser, ThreadPoolExecutor(2) as pool:
            tabs = [Tab(browser), Tab(browser)]

            def run(i):
                return [fault for path in pages[i::2] for fault in faults_of_page(tabs[i], folder, path)]
            for found in pool.map(run, range(2)):
                faults += found
        with Browser() as browser:
            tab = Tab(browser)
            faults += faults_of_search(tab, folder)
            write_pictures(tab, folder, Path(sys.argv[2]))
    for fault in faults:
        print(f"duet: {fault}", file=sys.stderr)
    print(f"{len(pages)} pages, {len(faults)} faults")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
