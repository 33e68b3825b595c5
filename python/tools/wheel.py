"""Builds the wheel, with the shared library that FMUs take along:

    python tools/wheel.py [OUT]         by default the folder `dist` of the workspace; further words go to maturin
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

PYTHON = Path(__file__).parents[1]
ROOT = PYTHON.parent
NAMES = ("libropewalk_fmu.so", "libropewalk_fmu.dylib", "ropewalk_fmu.dll")


def main() -> int:
    out, *words = sys.argv[1:] or [str(ROOT / "dist")]
    build = [os.environ.get("CARGO", "cargo"), "build", "--release", "-p", "ropewalk-fmu", "--message-format=json"]
    made = subprocess.run([*build, "--manifest-path", str(ROOT / "Cargo.toml")], check=True, stdout=subprocess.PIPE, text=True)
    messages = [json.loads(line) for line in made.stdout.splitlines() if line.startswith("{")]
    files = [Path(name) for message in messages for name in message.get("filenames", [])]
    library = next(file for file in files if file.name in NAMES)
    target = PYTHON / "ropewalk" / library.name
    shutil.copy2(library, target)
    strip = shutil.which("strip")
    if strip and target.suffix == ".so":
        # symbols are a quarter of it, and nobody looks at them
        subprocess.run([strip, "--strip-unneeded", str(target)], check=True)
    try:
        wheel = ["maturin", "build", "--release", "--strip", "--manifest-path", str(PYTHON / "Cargo.toml"), "--out", out, *words]
        return subprocess.run(wheel).returncode
    finally:
        # an install by `maturin develop` isn't to find one that is older than itself
        target.unlink()


if __name__ == "__main__":
    sys.exit(main())
