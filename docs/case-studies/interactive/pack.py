# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""Writes a script that holds its WebAssembly, compressed, so that a page computes from disk as well: browsers load scripts
from there, nothing else.

usage: pack.py <module.js> <module.wasm> <script.js>
"""

import base64
import gzip
import sys
from pathlib import Path

module, wasm, script = map(Path, sys.argv[1:])
packed = base64.b64encode(gzip.compress(wasm.read_bytes(), mtime=0)).decode()
script.write_text(f'{module.read_text()}duet_{module.stem}.packed = "{packed}";\n')
