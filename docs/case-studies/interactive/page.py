# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Writes a live page that stands alone: what its document has in HTML, without the text around it.

usage: page.py <document.md> <page.html>
"""

import html
import re
import sys

document, page = sys.argv[1:]
with open(document, encoding="utf-8") as file:
    text = file.read()
title = re.search(r"^# (.*)$", text, re.MULTILINE).group(1)
live = re.search(r"^<div class=\"live\".*?^</div>$", text, re.MULTILINE | re.DOTALL).group(0)
scripts = text[text.index("<noscript>"):]
live = re.sub(r"!\[(.*?)\]\((.*?)\)\n\n\*(.*?)\*\n\n```sh.*?```\n",
              r'<figure><img src="\2" alt="\1" loading="lazy">\n<figcaption>\3</figcaption></figure>', live, flags=re.DOTALL)
live = re.sub(r"```\w+\n(.*?)```\n", lambda code: f"<pre>{html.escape(code[1])}</pre>\n", live, flags=re.DOTALL)
with open(page, "w", encoding="utf-8") as file:
    file.write(f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>body {{ font-family: sans-serif; line-height: 1.45; max-width: 72rem; margin: 0 auto; padding: 0 16px; }}</style>
</head>
<body>
<h1>{title}</h1>
{live}
{scripts}</body>
</html>
""")
