"""Makes the README's pictures from the scenes beside this folder.

usage: python3 data/pictures/pictures.py [COMMAND [NAME ...]]

COMMAND is the built program (default build/patchlight), NAME the pictures wanted (default: all that are listed
below). The same program writes the same bytes. No picture may be larger than 250 kB.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

PICTURES = Path(__file__).resolve().parent
SCENES = PICTURES.parent / "scenes"
LARGEST = 250_000
SHOTS = (1, 2, 3, 16)


class Runs:
    """Solves a scene when a picture first needs it."""

    def __init__(self, command, folder):
        self.command, self.folder = command, folder

    def call(self, *words):
        subprocess.run([self.command, *map(str, words)], check=True, stdout=subprocess.DEVNULL)

    def solved(self, name, scene, *options):
        run = self.folder / name
        if not run.exists():
            self.call("solve", SCENES / scene, "-o", run, "--quiet", *options)
        return run

    def box(self):
        # What `patchlight demo` solves.
        return self.solved("box", "cornell-box.obj", "--unit", "mm", "--max-elements", 8000, "--size", "400x400")

    def shots(self):
        return self.solved("shots", "cornell-box.obj", "--unit", "mm", "--max-elements", 4000, "--size", "300x300",
                           "--snapshots", ",".join(map(str, SHOTS)))

    def room(self):
        return self.solved("room", "furniture-room.obj", "--max-elements", 12000, "--pictures", "none")


def before_and_after(runs, file):
    # From `demo`, but so large that it stays below LARGEST.
    file.write_bytes((runs.box() / "compare.png").read_bytes())


def mesh(which):
    def make(runs, file):
        file.write_bytes((runs.box() / f"mesh-{which}.png").read_bytes())
    return make


def lines(runs, file):
    run = runs.solved("wall", "wall-on-floor.obj", "--max-elements", 600, "--pictures", "none")
    runs.call("render", run, "-o", file, "--wireframe", "--from", "0.75,0.1,0.6", "--to", "0.6,0.5,0", "--up", "0,0,1",
              "--size", "640x480")


def false_color(runs, file):
    runs.call("render", runs.room(), "-o", file, "--false-color", "lux", "--scale", "log", "--isolines", 9, "--size", "560x420")


def error_map(runs, file):
    runs.call("render", runs.box(), "-o", file, "--show", "error", "--cycle", 6, "--size", "400x400")


def size_map(runs, file):
    runs.call("render", runs.box(), "-o", file, "--show", "size", "--size", "400x400")


def compared(name):
    def make(runs, file):
        folder = runs.folder / "compared"
        if not folder.exists():
            runs.call("compare", f"{runs.box()}@first", runs.box(), "-o", folder, "--size", "400x400")
        file.write_bytes((folder / name).read_bytes())
    return make


def shot(count):
    def make(runs, file):
        file.write_bytes((runs.shots() / f"shots-{count:02}.png").read_bytes())
    return make


ALL = {
    "cornell-box-compare.png": before_and_after,
    "cornell-box-mesh-before.png": mesh("before"),
    "cornell-box-mesh.png": mesh("after"),
    "discontinuity-lines.png": lines,
    "furniture-room-lux.png": false_color,
    "cornell-box-error.png": error_map,
    "cornell-box-size.png": size_map,
    "cornell-box-flip.png": compared("flip.png"),
    "cornell-box-difference.png": compared("difference-signed.png"),
    "cornell-box-wipe.png": compared("wipe.png"),
    **{f"cornell-box-shots-{count:02}.png": shot(count) for count in SHOTS},
}


def main():
    command = Path(sys.argv[1] if len(sys.argv) > 1 else "build/patchlight").resolve()
    wanted = sys.argv[2:] or list(ALL)
    for name in wanted:
        if name not in ALL:
            sys.exit(f"{name} is not made here; there are {', '.join(ALL)}")
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(command, Path(folder))
        for name in wanted:
            ALL[name](runs, PICTURES / name)
            size = (PICTURES / name).stat().st_size
            print(f"{name}: {size} bytes")
            if size > LARGEST:
                sys.exit(f"{name} is larger than {LARGEST} bytes")


if __name__ == "__main__":
    main()
