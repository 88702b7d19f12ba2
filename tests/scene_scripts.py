"""Holds data/scenes to its scripts: run in a copy, they must write the committed files to the byte.

    python3 tests/scene_scripts.py SOURCE
"""

import filecmp
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

WRITTEN = (".obj", ".mtl", ".glb", ".json")


def main():
    scenes = Path(sys.argv[1]) / "data" / "scenes"
    committed = sorted(p.name for p in scenes.iterdir() if p.suffix in WRITTEN)
    with tempfile.TemporaryDirectory(prefix="patchlight-scenes-") as folder:
        copy = Path(folder)
        scripts = [Path(shutil.copy(p, copy)) for p in sorted(scenes.glob("*.py"))]
        for script in scripts:
            subprocess.run([sys.executable, script], cwd=copy, stdin=subprocess.DEVNULL, check=True)
        written = sorted(p.name for p in copy.iterdir() if p.suffix in WRITTEN)
        if written != committed or not written:
            sys.exit(f"committed but not written, or the reverse: {sorted(set(written) ^ set(committed))}")
        _, different, unread = filecmp.cmpfiles(scenes, copy, committed, shallow=False)
    if different or unread:
        sys.exit(f"not what the scripts write: {different + unread}")
    print(f"{len(committed)} files as their scripts write them")


if __name__ == "__main__":
    main()
