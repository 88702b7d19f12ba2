"""Runs the studies beside this and writes what they came to into RESULTS.md; their folders are kept under OUT.

    python3 data/studies/results.py [BUILD [OUT]]
"""

import subprocess
import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
STUDIES = ("cornell-meshes", "indicators", "shadows", "solvers")


def comment_of(study):
    """The lines that its file begins with."""
    lines = []
    for line in study.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# "))
    return "\n".join(lines)


def main():
    build = Path(sys.argv[1] if len(sys.argv) > 1 else HERE.parents[1] / "build").resolve()
    out = Path(sys.argv[2] if len(sys.argv) > 2 else "study-results").resolve()
    command = build / "patchlight"
    text = ["# What the studies came to", "",
            "Printed by `python3 data/studies/results.py` on two cores; seconds and MiB are that machine's, all else is the "
            "same on any.", ""]
    for name in STUDIES:
        study = HERE / f"{name}.toml"
        subprocess.run([command, "study", "run", study, "-o", out / name], check=True, stdout=subprocess.DEVNULL)
        table = subprocess.run([command, "study", "table", study, "-o", out / name, "--seconds"], check=True, text=True,
                               stdout=subprocess.PIPE).stdout
        title = tomllib.loads(study.read_text(encoding="utf-8"))["title"]
        body = table.split("\n", 1)[1].strip().replace("\n## ", "\n### ")
        text += [f"## {title}", "", f"`data/studies/{name}.toml`. {comment_of(study)}", "", body, ""]
    (HERE / "RESULTS.md").write_text("\n".join(text), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
