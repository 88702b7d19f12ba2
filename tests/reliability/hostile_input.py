"""Scenes that lie, are broken or too large, as the command meets them: exit code, message, peak memory, time, and no
file left behind. Scenes that are only ugly are solved: energy in balance, no NaN, and any order of faces gives the same
light. One line a row is printed.

    python3 tests/reliability/hostile_input.py [-k WORD]    of PATCHLIGHT_COMMAND and PATCHLIGHT_SOURCE
"""

import argparse
import csv
import json
import math
import random
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import disturbed

REFUSED_MIB, REFUSED_SECONDS = 50, 0.1  # what a lying file may take
# A refusal is timed three times and the shortest counts: processor time, too, is longer beside other jobs.
TRIES = 3

SCENES = disturbed.SOURCE / "data/scenes"

MATERIALS = """newmtl white
Kd .7 .7 .7
newmtl red
Kd .6 .1 .1
newmtl lamp
Kd 0 0 0
Ke 10 9 8
"""


# Runs a command and tells how it ended. A process of its own: what a child is said to take at its largest begins with
# what its parent had, and the parent shall be small. Processor seconds, because other jobs share the machine.
MEASURE = """
import os, sys, time
out, err, *command = sys.argv[1:]
began = time.monotonic()
flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC
pid = os.posix_spawn(command[0], command, dict(os.environ), file_actions=[
    (os.POSIX_SPAWN_OPEN, 0, "/dev/null", os.O_RDONLY, 0), (os.POSIX_SPAWN_OPEN, 1, out, flags, 0o644),
    (os.POSIX_SPAWN_OPEN, 2, err, flags, 0o644)])
_, status, used = os.wait4(pid, 0)
print(os.waitstatus_to_exitcode(status), used.ru_maxrss / 1024, used.ru_utime + used.ru_stime, time.monotonic() - began)
"""


class Ended:
    """How a command ended."""

    def __init__(self, command, folder):
        out, err = folder / "out.txt", folder / "err.txt"
        said = subprocess.run([sys.executable, "-I", "-S", "-c", MEASURE, out, err, *map(str, command)],
                              capture_output=True, text=True, check=True).stdout.split()
        self.code = int(said[0])  # minus the signal that killed it
        self.mib, self.cpu_seconds, self.seconds = map(float, said[1:])
        self.out, self.err = out.read_text(errors="replace"), err.read_text(errors="replace")


def obj(faces, unit=1.0, offset=(0, 0, 0)):
    """Faces (material, corners), each with vertices of its own."""
    lines, count = ["mtllib room.mtl"], 0
    for number, (material, corners) in enumerate(faces):
        for corner in corners:
            lines.append("v " + " ".join(repr(unit * c + o) for c, o in zip(corner, offset)))
        count += len(corners)
        lines += [f"usemtl {material}", "f " + " ".join(str(count - len(corners) + k + 1) for k in range(len(corners)))]
    return "\n".join(lines) + "\n"


def box(low, high, material="white", inward=False):
    """Six faces; outward unless told."""
    (a, b, c), (d, e, f) = low, high
    quads = [[(a, b, c), (a, b, f), (d, b, f), (d, b, c)][::-1], [(a, e, c), (a, e, f), (d, e, f), (d, e, c)],
             [(a, b, c), (a, e, c), (d, e, c), (d, b, c)], [(a, b, f), (d, b, f), (d, e, f), (a, e, f)],
             [(a, b, c), (a, b, f), (a, e, f), (a, e, c)], [(d, b, c), (d, e, c), (d, e, f), (d, b, f)]]
    return [(material, quad[::-1] if inward else quad) for quad in quads]


LAMP = ("lamp", [(.7, 1.8, .7), (1.3, 1.8, .7), (1.3, 1.8, 1.3), (.7, 1.8, 1.3)])
ROOM = box((0, 0, 0), (2, 2, 2), inward=True) + [LAMP]


def without_floor():
    return [face for face in ROOM if any(y > 0 for _, y, _ in face[1])]


def floor_pieces(xs):
    return [("white", [(x, 0, 0), (x, 0, 2), (y, 0, 2), (y, 0, 0)]) for x, y in zip(xs, xs[1:])]


def ugly_scenes():
    """Name → faces, and what inspect counts."""
    fin = [(1, .5, 1), (1, .5, 1.4), (1, .9, 1.4), (1, .9, 1)]
    other = [(1, .5, 1), (1, .9, 1), (1.4, .9, 1), (1.4, .5, 1)]
    third = [(1, .5, 1), (1, .9, 1), (.7, .9, .7), (.7, .5, .7)]
    both = [("red", side) for plate in (fin, other, third) for side in (plate, plate[::-1])]
    needle = [("red", [(.2, .4, .5), (1.8, .4, .5), (1.8, .4 + 1.6e-6, .5), (.2, .4 + 1.6e-6, .5)])]
    return {
        "zero-area faces": (ROOM + [("red", [(0, 0, 0), (1, 0, 0), (2, 0, 0)]), ("red", [(1, 1, 1)] * 3),
                                    ("white", [(0, 0, 0), (0, 0, 1), (0, 0, 1)])], "zero_area_faces"),
        "duplicate faces": (ROOM + [ROOM[0], ROOM[0], LAMP], "duplicate_faces"),
        "non-manifold edges": (ROOM + both, "nonmanifold_edges"),
        "T-junctions": (without_floor() + floor_pieces([0, .3, 1.1, 2]) + box((.4, 0, .4), (.9, .6, .8)),
                        "t_junctions"),
        "coplanar overlaps": (ROOM + [("red", [(.3, 0, .3), (.3, 0, 1), (1, 0, 1), (1, 0, .3)]),
                                      ("white", [(.6, 0, .6), (.6, 0, 1.5), (1.2, 0, 1.5), (1.2, 0, .6)])],
                              "coplanar_overlaps"),
        "self-intersections": (ROOM + box((.4, .3, .4), (1.1, .8, 1.1), "red") + box((.8, .5, .7), (1.5, 1.2, 1.4)) +
                               [("white", [(.3, 1, .3), (.6, 1, .6), (.6, 1, .3), (.3, 1, .6)])], "crossing_faces"),
        "needles 1:1e6": (without_floor() + floor_pieces([0, 1, 1 + 2e-6, 2]) + needle, "needles"),
    }


class Rows:
    def __init__(self, scratch, only):
        self.command, self.scratch, self.only, self.bad = disturbed.COMMAND, scratch, only, 0
        self.folder = None
        self.rows = 0

    def fresh(self):
        self.folder = Path(tempfile.mkdtemp(dir=self.scratch))
        (self.folder / "scene").mkdir()
        (self.folder / "scene/room.mtl").write_text(MATERIALS)

    def write(self, name, content):
        file = self.folder / "scene" / name
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return file

    def run(self, *words):
        return Ended([self.command, *words], self.folder)

    def say(self, row, ended, problems):
        self.rows += 1
        print(f"{'ok ' if not problems else 'BAD'} {row:<48} code {ended.code:>3} {ended.mib:7.0f} MiB "
              f"{ended.cpu_seconds:7.2f} s", flush=True)
        for problem in problems:
            self.bad += 1
            print(f"    {problem}", flush=True)

    def wants(self, row):
        return self.only in row

    def refused(self, row, name, content, code, parts, mib=REFUSED_MIB, seconds=REFUSED_SECONDS, options=()):
        """`content`: bytes, text, or what writes the file. Refused by solve, in so much memory and time."""
        if not self.wants(row):
            return
        self.fresh()
        if callable(content):
            content(self.folder / "scene" / name)
        else:
            self.write(name, content)
        run = self.folder / "run"
        tries = [self.run("solve", self.folder / "scene" / name, "-o", run, *options) for _ in range(TRIES)]
        ended = min(tries, key=lambda e: e.cpu_seconds)
        problems = [f"exit code {e.code}, not {code}: {e.err[-300:]}" for e in tries if e.code != code][:1]
        problems += [f"does not say {part!r}: {ended.err[-300:]}" for part in parts if part not in ended.err]
        if ended.mib > mib:
            problems.append(f"more than {mib} MiB")
        if ended.cpu_seconds > seconds:
            problems.append(f"more than {seconds} s of a processor")
        if run.exists():
            problems.append("a run folder is left")
        self.say(row, ended, problems)

    def light(self, file, run, points, *options):
        ended = self.run("solve", file, "-o", run, "--pictures", "none", "--quiet", "--max-elements", "1500",
                         "--vertex-rays", "64", *options)
        problems = [] if ended.code == 0 else [f"exit code {ended.code}: {ended.err[-300:]}"]
        if ended.code != 0:
            return ended, [], problems
        record = json.loads((run / "run.json").read_text())
        for cycle in record["cycles"]:
            # Of coarse meshes: their exact direct light is known at three points of a patch only.
            if not abs(cycle["energy"]["relative_residual"]) < 0.15:
                problems.append(f"cycle {cycle['cycle']}: energy {cycle['energy']['relative_residual']:.3g} out")
        probed = self.run("probe", run, "--points", points)
        rows = list(csv.DictReader(probed.out.splitlines()))
        values = [[float(row[band]) for band in ("Br", "Bg", "Bb")] if row["Br"] else None for row in rows]
        if any(v is not None and not all(math.isfinite(x) and x >= 0 for x in v) for v in values):
            problems.append("not a number, or negative, at some point")
        if sum(v is not None for v in values) < 50:
            problems.append("hardly a point is on a surface")
        return ended, values, problems

    def ugly(self, row, faces, counter):
        if not self.wants(row):
            return
        self.fresh()
        numbers = random.Random(5)
        points = self.folder / "points.csv"
        with points.open("w") as file:
            file.write("x,y,z,nx,ny,nz\n")
            for _ in range(60):
                u, v = numbers.uniform(.05, 1.95), numbers.uniform(.05, 1.95)
                for place in ((u, 0, v, 0, 1, 0), (0, u, v, 1, 0, 0), (u, v, 2, 0, 0, -1)):
                    file.write(",".join(map(str, place)) + "\n")
        in_order = self.write("in-order.obj", obj(faces))
        counted = json.loads(self.run("inspect", in_order, "--json").out)["counts"]
        ended, expected, problems = self.light(in_order, self.folder / "run", points)
        if not counted[counter] > 0:
            problems.append(f"inspect counts no {counter}")
        for seed in (1, 2):
            shuffled = list(faces)
            random.Random(seed).shuffle(shuffled)
            file = self.write(f"shuffled-{seed}.obj", obj(shuffled))
            _, found, more = self.light(file, self.folder / f"run-{seed}", points)
            problems += more
            if found != expected and not more:
                problems.append(f"faces shuffled by {seed}: other light")
        left = [p.name for p in self.folder.rglob("*") if "patchlight-tmp" in p.name]
        problems += [f"left: {name}" for name in left]
        self.say(row, ended, problems)

    def scales(self, row):
        """Sizes and places: the same radiosity within the noise of sampling (2 %, of 64 rays a node)."""
        if not self.wants(row):
            return
        self.fresh()
        results = []
        for unit, offset in (*((unit, (0, 0, 0)) for unit in (1, 1e-14, 1e-6, 1e6, 1e14)), (1, (2e7, -1e7, 3e7))):
            name = f"room-{len(results)}"
            points = self.write(name + ".csv", "x,y,z\n" + "".join(
                ",".join(repr(unit * c + o) for c, o in zip((x, 0, z), offset)) + "\n"
                for x in (.3, .8, 1.3, 1.7) for z in (.25, .5, .75, 1, 1.25, 1.5, 1.7, 1.9, .1, .35, .6, .9, 1.1)))
            results.append(self.light(self.write(name + ".obj", obj(ROOM, unit, offset)), self.folder / name, points))
        problems = [problem for _, _, more in results for problem in more]
        for _, found, _ in results[1:]:
            worst = max((abs(a[0] / b[0] - 1) for a, b in zip(found, results[0][1]) if a and b), default=9)
            if worst > 0.02:
                problems.append(f"other light by {100 * worst:.3g} %")
        self.say(row, results[0][0], problems)


def glb(document, binary=b"", lie=0):
    text = json.dumps(document).encode() if not isinstance(document, bytes) else document
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text) + lie, 0x4E4F534A) + text
    if binary:
        body += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body) + lie) + body


def gltf(**changes):
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
                "materials": [{"emissiveFactor": [1, 1, 1]}], "buffers": [{"byteLength": 36}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                               "min": [0, 0, 0], "max": [1, 1, 1]}]}
    return document | changes


TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)


def lying_files(rows):
    whole, many = obj(ROOM), 4_000_000_000
    rows.refused("lying: 4e9 elements in 200 bytes", "big.glb",
                 glb(gltf(accessors=[{"bufferView": 0, "componentType": 5126, "count": many, "type": "VEC3"}]),
                     TRIANGLE), 3, ["big.glb", "accessor"])
    rows.refused("lying: a buffer of 4e9 bytes", "big.glb",
                 glb(gltf(buffers=[{"byteLength": many}], bufferViews=[{"buffer": 0, "byteLength": many}]), TRIANGLE),
                 3, ["error[", "big.glb"])
    rows.refused("lying: a chunk longer than the file", "long.glb", glb(gltf(), TRIANGLE, lie=1 << 30), 3,
                 ["error[", "long.glb"])
    rows.refused("truncated: GLB", "cut.glb", glb(gltf(), TRIANGLE)[:150], 3, ["error[", "cut.glb"])
    rows.refused("truncated: GLB without a body", "cut.glb", b"glTF\2\0\0\0", 3, ["error[", "cut.glb"])
    rows.refused("truncated: OBJ in a face", "cut.obj", whole[:whole.rindex("f ") + 4], 3, ["error[", "cut.obj"])
    rows.refused("empty file", "empty.obj", "", 3, ["error[empty]", "empty.obj"])
    rows.refused("rubbish", "rubbish.obj", bytes(range(256)) * 40, 3, ["error[", "rubbish.obj"])
    rows.refused("index past the end", "index.obj", whole + "f 1 2 4000000000\n", 3, ["error[index]", "index.obj:"])
    rows.refused("index 0", "index.obj", whole + "f 0 1 2\n", 3, ["error[index]", "index.obj:"])
    for text in ("nan", "inf", "-inf", "1e999"):
        rows.refused(f"coordinate {text}", "number.obj", whole.replace("v 0.0", f"v {text}", 1), 3,
                     ["error[nonfinite]", "number.obj:2"])
    for size in (1e-30, 1e30, 1e300):
        rows.refused(f"a room of {size:g} m", "size.obj", obj(ROOM, size), 3, ["error[size]", "1e-15 … 1e+15 m"])
    rows.refused("no emitter", "dark.obj", whole.replace("usemtl lamp", "usemtl red"), 3,
                 ["error[dark]", "no emitter; set Ke or use --emitter MATERIAL=W"])
    for rho in ("1.5", "-0.1", "nan"):
        def with_reflectance(file, rho=rho):
            file.with_name("room.mtl").write_text(MATERIALS.replace("Kd .7 .7 .7", f"Kd {rho} .7 .7"))
            file.write_text(whole)
        rows.refused(f"reflectance {rho}", "rho.obj", with_reflectance, 3, ["error[", "white"])


def deep_files(rows):
    limits = {"mib": 200, "seconds": 1}
    deep = b'{"asset": {"version": "2.0"}, "extras": ' + b"[" * 1_000_000 + b"]" * 1_000_000 + b"}"
    rows.refused("JSON nested 1e6 deep: GLB", "deep.glb", glb(deep), 3, ["error[", "deep.glb"], **limits)
    rows.refused("JSON nested 1e6 deep: glTF", "deep.gltf", deep, 3, ["error[", "deep.gltf"], **limits)
    rows.refused("JSON nested 1e6 deep, unclosed", "deep.gltf", b"[" * 1_000_000, 3, ["error[", "deep.gltf"], **limits)
    rows.refused("nodes in a circle", "circle.glb",
                 glb(gltf(nodes=[{"mesh": 0, "children": [1]}, {"children": [0]}]), TRIANGLE), 3, ["circle.glb"], **limits)
    rows.refused("a node that is its own child", "circle.glb",
                 glb(gltf(nodes=[{"mesh": 0, "children": [0]}]), TRIANGLE), 3, ["circle.glb"], **limits)
    doubling = [{"children": [k + 1, k + 1]} for k in range(60)] + [{"mesh": 0}]
    rows.refused("nodes that double 60 times", "double.glb", glb(gltf(nodes=doubling), TRIANGLE), 3, ["double.glb"],
                 **limits)
    chain = [{"children": [k + 1]} for k in range(100_000)] + [{"mesh": 0}]
    rows.refused("a chain of 100,000 nodes, dark at its end", "chain.glb",
                 glb(gltf(nodes=chain, materials=[{}]), TRIANGLE), 3, ["chain.glb"], **limits)
    rows.refused("a strided accessor past the end", "stride.glb",
                 glb(gltf(bufferViews=[{"buffer": 0, "byteLength": 36, "byteStride": 252}]), TRIANGLE), 3,
                 ["stride.glb"], **limits)
    rows.refused("offsets that wrap around", "wrap.glb",
                 glb(gltf(bufferViews=[{"buffer": 0, "byteOffset": 2**64 - 36, "byteLength": 36}]), TRIANGLE), 3,
                 ["wrap.glb"], **limits)


def sparse(gibibytes):
    def write(file):
        with file.open("wb") as out:
            out.truncate(gibibytes << 30)
    return write


def too_much(rows):
    rows.refused("an OBJ of 3 GiB", "large.obj", sparse(3), 3, ["large.obj", "bytes, the limit is"])
    rows.refused("a GLB of 5 GiB", "large.glb", sparse(5), 3, ["large.glb", "bytes, the limit is"])
    for side in ("100000x100000", "8193x1", "99999999999x2"):
        rows.refused(f"a picture of {side}", "room.obj", obj(ROOM), 2, ["--size", "from 1 to 8192"],
                     options=("--size", side))
    rows.refused("100,000 patches, dense", "room.obj", obj(ROOM), 5,
                 ["error[memory]: needs ", " GiB, limit 16.0 GiB (--memory)", "--solver hierarchical"],
                 options=("--refine", "none", "--form-factors", "exact", "--max-elements", "100000", "--memory",
                          "16GiB"), seconds=1)
    rows.refused("1e9 elements", "room.obj", obj(ROOM), 5, ["error[memory]: needs ", "--max-elements"], seconds=1,
                 options=("--max-elements", "1000000000"))
    rows.refused("edges of a nanometre", "room.obj", obj(ROOM), 5, ["error[memory]: needs "], seconds=1,
                 options=("--refine", "none", "--max-edge", "1e-9"))
    rows.refused("edges of 1e-300", "room.obj", obj(ROOM), 5, ["error[memory]: needs "], seconds=1,
                 options=("--refine", "none", "--max-edge", "1e-300"))


def little_memory(rows):
    """Under `ulimit -v` a solve is made, or refused with a message; it never crashes and leaves no temporary. From
    500,000 on a picture's libraries are met half loaded."""
    ladder = (60_000, 100_000, 150_000, 200_000, 250_000, 300_000, 400_000, 500_000, 700_000, 720_000, 740_000, 800_000,
              850_000, 900_000, 1_000_000, 2_000_000)
    for kib, pictures in [(kib, pictures) for pictures in ("none", "all") for kib in ladder]:
        row = f"ulimit -v {kib}, pictures: {pictures}"
        if not rows.wants(row):
            continue
        rows.fresh()
        scene, run = rows.write("room.obj", obj(ROOM)), rows.folder / "run"
        shell = f'ulimit -v {kib}; exec "$0" "$@"'
        ended = Ended(["/bin/sh", "-c", shell, rows.command, "solve", scene, "-o", run, "--quiet", "--max-elements",
                       "2000", *(("--pictures", "none") if pictures == "none" else ("--size", "256x256"))], rows.folder)
        problems = []
        # 127: the program's libraries didn't fit, which their loader says.
        if ended.code not in (0, 5, 127):
            problems.append(f"exit code {ended.code}: {ended.err[-300:]}")
        if ended.code != 0 and not ended.err:
            problems.append("no message")
        if ended.code == 5 and "error[memory]" not in ended.err:
            problems.append(f"not about memory: {ended.err[-300:]}")
        if ended.code != 0 and (run / "run.json").exists():
            if json.loads((run / "run.json").read_text())["status"] == "finished":
                problems.append("marked finished")
        problems += [f"left: {p.name}" for p in rows.folder.rglob("*patchlight-tmp*")]
        rows.say(row, ended, problems)


def estimates(rows):
    """What a solve is said to need, before it begins, is what it takes at its largest, within 20 %."""
    box = ("cornell-box.obj", "--unit", "mm")
    cases = {
        "2,000 elements": (*box, "--max-elements", "2000"),
        "8,000 elements": (*box, "--max-elements", "8000"),
        "8,000, 64 rays a node": (*box, "--max-elements", "8000", "--vertex-rays", "64"),
        "8,000 uniform": (*box, "--refine", "none", "--max-elements", "8000"),
        "2,000 exact": (*box, "--refine", "none", "--max-elements", "2000", "--form-factors", "exact"),
        "4,000 exact": (*box, "--refine", "none", "--max-elements", "4000", "--form-factors", "exact"),
        "1,000 quadrature": (*box, "--refine", "none", "--max-elements", "1000", "--form-factors", "quadrature"),
        "2,000 exact, in blocks": ("blocks-room-many.obj", "--refine", "none", "--max-elements", "2000",
                                   "--form-factors", "exact"),
        "8,000 by links": (*box, "--refine", "none", "--max-elements", "8000", "--solver", "hierarchical"),
    }
    for name, (scene, *options) in cases.items():
        row = f"memory: {name}"
        if not rows.wants(row):
            continue
        rows.fresh()
        words = ("solve", SCENES / scene, "-o", rows.folder / "run", "--pictures", "none", "--quiet", *options)
        refused = rows.run(*words, "--memory", "1B")
        said = re.search(r"needs ([0-9.]+) GiB", refused.err)
        ended = rows.run(*words)
        problems = [] if ended.code == 0 and said else [f"exit codes {refused.code}, {ended.code}: {refused.err}"]
        if said:
            ratio = float(said[1]) * 1024 / ended.mib
            row += f", {ratio:.2f} of it said"
            if not 1 / 1.2 < ratio < 1.2:
                problems.append(f"said were {float(said[1]) * 1024:.0f} MiB")
        rows.say(row, ended, problems)


def limited_time(rows):
    """--time stops like an interrupt, and the same command without it ends as if nothing had been."""
    row = "--time over"
    if not rows.wants(row):
        return
    rows.fresh()
    scene = rows.write("room.obj", obj(ROOM + box((.4, .3, .4), (1.1, .8, 1.1), "red")))
    options = ("--pictures", "none", "--quiet", "--max-elements", "3000", "--threads", "1")
    run, whole = rows.folder / "run", rows.folder / "whole"
    reference = rows.run("solve", scene, "-o", whole, *options)
    limit = reference.seconds / 2
    ended = rows.run("solve", scene, "-o", run, *options, "--time", f"{limit:.3f}s")
    problems = []
    if ended.code != 5 or "error[time]" not in ended.err or "goes on from" not in ended.err:
        problems.append(f"exit code {ended.code}: {ended.err}")
    if ended.seconds > limit + 1:
        problems.append(f"{ended.seconds:.1f} s, of {limit:.1f} allowed")
    if json.loads((run / "run.json").read_text())["status"] != "interrupted":
        problems.append("not marked interrupted")
    again = rows.run("solve", scene, "-o", run, *options)
    if again.code != 0 or (run / "solution.glb").read_bytes() != (whole / "solution.glb").read_bytes():
        problems.append("resumed, it ends otherwise")
    rows.say(row, ended, problems)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("-k", default="", help="only rows whose name has this in it")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="patchlight-hostile-") as scratch:
        rows = Rows(Path(scratch), options.k)
        lying_files(rows)
        deep_files(rows)
        too_much(rows)
        for name, (faces, counter) in ugly_scenes().items():
            rows.ugly(name, faces, counter)
        rows.scales("scale 1e-14, 1e-6, 1e6 and 1e14, offset 1e7")
        estimates(rows)
        limited_time(rows)
        little_memory(rows)
        print(f"{rows.rows} rows, {rows.bad} problems")
    sys.exit(rows.bad > 0)


if __name__ == "__main__":
    main()
