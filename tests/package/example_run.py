"""Builds and runs the example project, and holds it to the installed program."""

import json
import re
import subprocess
from pathlib import Path

ELEMENTS = 1500


def run(*command, **options):
    """What a command prints; an error with all of it when it fails."""
    done = subprocess.run([str(part) for part in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace", check=False, **options)
    if done.returncode != 0:
        raise SystemExit(f"exit {done.returncode}: {' '.join(map(str, command))}\n{done.stdout}")
    return done.stdout


def png_size(file):
    """Width and height of a whole PNG."""
    data = Path(file).read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n" or b"IEND" not in data[-12:]:
        raise SystemExit(f"{file}: not a whole PNG")
    return int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")


def check_numbers(printed, run_folder):
    """The example's last lines are what the program's run.json says: one library, the same numbers to the last bit."""
    numbers = dict(re.findall(r"^(elements|estimated_error) (\S+)$", printed, re.MULTILINE))
    result = json.loads((Path(run_folder) / "run.json").read_text())["result"]
    found = int(numbers["elements"]), float(numbers["estimated_error"])
    wanted = result["elements"], result["estimated_error"]
    if found != wanted:
        raise SystemExit(f"the example finds {found}, the program {wanted}")
    print(f"example and program: {found[0]} elements, estimated error {100 * found[1]:.3g} %")
