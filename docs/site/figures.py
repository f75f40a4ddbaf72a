# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Pictures as parts of pages, in colours for light and dark."""

import re
import sys


def linear(byte):
    c = byte / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def companded(c):
    c = min(max(c, 0), 1)
    return round(255 * (12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055))


def dark(red, green, blue):
    """The colour for a dark page: its lightness (Ottosson's Oklab) turned over, white to the page's 0.21; its hue stays."""
    r, g, b = map(linear, (red, green, blue))
    l = (0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b) ** (1 / 3)
    m = (0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b) ** (1 / 3)
    s = (0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b) ** (1 / 3)
    lightness = 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s
    a = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s
    b = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s
    lightness = 0.21 + 0.79 * max(1 - lightness, 0) ** 0.75
    l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3
    m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3
    s = (lightness - 0.0894841775 * a - 1.2914855480 * b) ** 3
    return (companded(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            companded(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            companded(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s))


def both(red, green, blue):
    text = "#%02x%02x%02x"
    return f"light-dark({text % (red, green, blue)},{text % dark(red, green, blue)})"


def inlined(path, number, alternative):
    """The picture as an element of the page; its names are made the page's own by a number."""
    svg = path.read_text()
    svg = re.sub(r"<\?xml.*?\?>|<!DOCTYPE.*?>|<!--.*?-->|<title>.*?</title>|<desc>.*?</desc>", "", svg, flags=re.S)
    svg = re.sub(r"rgb\(\s*(\d+),\s*(\d+),\s*(\d+)\)", lambda c: both(*map(int, c.groups())), svg)
    svg = re.sub(r"(?<=['\":])#([0-9a-fA-F]{6})\b(?!,)",
                 lambda c: both(*(int(c[1][i:i + 2], 16) for i in (0, 2, 4))), svg)
    svg = re.sub(r"(?<=['\"])black(?=['\"])", both(0x24, 0x29, 0x2f), svg)
    svg = re.sub(r"(?<=['\"])white(?=['\"])", both(255, 255, 255), svg)
    svg = re.sub(r"\bid=(['\"])", rf"id=\1f{number}_", svg)
    svg = re.sub(r"href=(['\"])#", rf"href=\1#f{number}_", svg)
    svg = re.sub(r"url\(#", f"url(#f{number}_", svg)
    svg = re.sub(r"[ \t]*\n\s*", "\n", svg)
    opening = re.search(r"<svg[^>]*>", svg, flags=re.S)[0]
    box = re.search(r"viewBox=(['\"])(.*?)\1", opening)[2]
    width = box.split()[2]
    return svg.replace(opening, f'<svg viewBox="{box}" style="--width:{width}" role="img" aria-label="{alternative}" '
                                'xmlns:xlink="http://www.w3.org/1999/xlink">').strip()


def with_figures(body, source):
    """Figures with their captions, the emphasised paragraph below them, and the command of the block below that, unless a
    command before them, as `sh scripts/demo`, draws all figures of the page. Pictures are SVG; where a forge is shown another kind, as by README.md, there is an SVG of
    the same name."""
    number = 0

    def picture(address, alternative):
        nonlocal number
        number += 1
        path = (source.parent / address).with_suffix(".svg")
        if not path.is_file():
            sys.exit(f"duet: {source} shows {address}, and there is no {path}")
        return f'<div class="picture" tabindex="0">{inlined(path, number, alternative)}</div>'

    def figure(match):
        has_common_command = "scripts/demo" in body[:match.start()]
        if not match[4] and not has_common_command and source.name != "README.md":
            sys.exit(f"duet: {source}: no command below the caption of {match[1]}")
        return f"<figure>{picture(match[1], match[2])}\n<figcaption>{match[3]}{match[4] or ''}</figcaption></figure>"
    body = re.sub(r'<p><img\s+src="([^"]*)"\s+alt="([^"]*)"\s*/></p>\s*<p><em>(.*?)</em></p>'
                  r'(?:\s*(<div class="sourceCode"[^>]*><pre\s+class="sourceCode sh">.*?</pre></div>))?',
                  figure, body, flags=re.S)
    return re.sub(r'<img\s+src="([^"]*)"\s+alt="([^"]*)"\s*/?>', lambda image: picture(image[1], image[2]), body)
