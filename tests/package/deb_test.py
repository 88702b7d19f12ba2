"""Makes the Debian packages twice, and looks at what is in them.

    python3 tests/package/deb_test.py BUILD FOLDER
"""

import shutil
import sys
from pathlib import Path

from example_run import run

PROGRAM_FILES = {"./usr/bin/patchlight", "./usr/lib/patchlight/patchlight_image_file.so",
                 "./usr/share/man/man1/patchlight.1.gz", "./usr/share/bash-completion/completions/patchlight",
                 "./usr/share/zsh/vendor-completions/_patchlight",
                 "./usr/share/fish/vendor_completions.d/patchlight.fish", "./usr/share/doc/patchlight/copyright",
                 "./usr/share/doc/patchlight/changelog.gz"}
DEV_FILES = {"./usr/include/patchlight/solver/adaptive.h", "./usr/lib/libpatchlight_solver.a",
             "./usr/lib/cmake/patchlight/patchlight-config.cmake", "./usr/share/doc/patchlight-dev/copyright",
             "./usr/share/doc/patchlight-dev/example/main.cpp"}


def made_packages(build, folder):
    """The packages of a build: patchlight, patchlight-dev."""
    shutil.rmtree(folder, ignore_errors=True)
    run("cpack", "--config", build / "CPackConfig.cmake", "-B", folder)
    made = sorted(folder.glob("*.deb"), key=lambda p: p.name.split("_")[0])
    if [p.name.split("_")[0] for p in made] != ["patchlight", "patchlight-dev"]:
        raise SystemExit(f"packages made: {[p.name for p in made]}")
    return made


def field(package, name):
    return run("dpkg-deb", "--field", package, name).strip()


def content(package):
    """Paths in a package; all must be root's, and writable by nobody else."""
    paths = []
    for line in run("dpkg-deb", "--contents", package).splitlines():
        mode, owner, *_, path = line.split()
        if owner != "root/root" or mode[5] == "w" or mode[8] == "w":
            raise SystemExit(f"{package.name}: {line}")
        paths.append(path)
    return set(paths)


def check(condition, message):
    if not condition:
        raise SystemExit(message)


def main():
    build, folder = (Path(p).resolve() for p in sys.argv[1:3])
    program, dev = made_packages(build, folder / "first")
    check(PROGRAM_FILES <= content(program), f"missing: {PROGRAM_FILES - content(program)}")
    check(DEV_FILES <= content(dev), f"missing: {DEV_FILES - content(dev)}")
    check(not content(program) & content(dev) - {p for p in content(dev) if p.endswith("/")}, "a file in both packages")
    for needed in ("libopenimageio", "libembree3", "libtbb", "libopenmesh", "libc6", "fonts-dejavu-core"):
        check(needed in field(program, "Depends"), f"{needed} is not in: {field(program, 'Depends')}")
    check(f"patchlight (= {field(program, 'Version')})" in field(dev, "Depends"), "patchlight-dev takes any patchlight")

    for first, second in zip((program, dev), made_packages(build, folder / "second")):
        check(first.read_bytes() == second.read_bytes(), f"{first.name}: other bytes at the second time")
        installed = int(field(first, "Installed-Size")) / 1e3
        print(f"{first.name}: {first.stat().st_size / 1e6:.1f} MB, installed {installed:.1f} MB")


if __name__ == "__main__":
    main()
