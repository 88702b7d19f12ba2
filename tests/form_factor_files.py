"""Reads what `patchlight formfactors` writes, with nothing but what its --help says of the files.

    python3 tests/form_factor_files.py build/patchlight
"""

import array
import csv
import json
import math
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

# A closed box of 2 × 3 × 4 cm, fronts inside, with names that a CSV has to quote.
OBJ = """v 0 0 0
v 2 0 0
v 2 3 0
v 0 3 0
v 0 0 4
v 2 0 4
v 2 3 4
v 0 3 4
o floor, "grey"
f 1 2 3 4
o ceiling
f 5 8 7 6
o walls
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
"""


def read_binary(path):
    with open(path, "rb") as file:
        magic, n, entries = struct.unpack("<8sQQ", file.read(24))
        assert magic == b"PLFFCSR1", magic
        row_start, columns, factors, area = array.array("Q"), array.array("I"), array.array("d"), array.array("d")
        for values, count in ((row_start, n + 1), (columns, entries), (factors, entries), (area, n)):
            values.fromfile(file, count)
        assert file.read() == b"", "nothing follows"
    return row_start, columns, factors, area


def main():
    command = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="patchlight-factors-") as folder:
        folder = Path(folder)
        (folder / "box.obj").write_text(OBJ, encoding="utf-8")
        out = {}
        for name in ("f.bin", "f.csv"):
            words = [command, "formfactors", "box.obj", "--unit", "cm", "--max-elements", "300", "--quiet", "--json",
                     "--method", "hemisphere", "-o", name, "--patches", "p.csv"]
            out = json.loads(subprocess.run(words, cwd=folder, check=True, stdout=subprocess.PIPE).stdout)
        row_start, columns, factors, area = read_binary(folder / "f.bin")
        with open(folder / "f.csv", encoding="utf-8", newline="") as file:
            table = [(int(r["row"]), int(r["column"]), float(r["factor"])) for r in csv.DictReader(file)]
        with open(folder / "p.csv", encoding="utf-8", newline="") as file:
            patches = list(csv.DictReader(file))

    n = len(area)
    rows = [(i, columns[k], factors[k]) for i in range(n) for k in range(row_start[i], row_start[i + 1])]
    assert out["elements"] == n and out["entries"] == len(factors) and out["closed"]
    assert rows == table, "both files hold the same to the bit"
    assert all(a[:2] < b[:2] for a, b in zip(rows, rows[1:])), "in ascending order"
    assert [float(p["area"]) for p in patches] == list(area)
    assert math.isclose(sum(area), 52e-4, rel_tol=1e-12), "square metres"
    assert {p["object"] for p in patches} == {'floor, "grey"', "ceiling", "walls"}
    for p in patches:
        if p["object"] == "ceiling":
            assert math.isclose(float(p["z"]), 4, rel_tol=1e-12) and 0 < float(p["x"]) < 2, "the file's coordinates"
            assert (float(p["nx"]), float(p["ny"]), float(p["nz"])) == (0, 0, -1)
    sums = [sum(factors[row_start[i]:row_start[i + 1]]) for i in range(n)]
    assert all(math.isclose(s, 1, abs_tol=1e-3) for s in sums), "the box is closed"
    print(f"{n} patches, {len(factors)} factors: as --help says")


if __name__ == "__main__":
    main()
