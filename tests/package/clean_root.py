"""The packages on a clean Debian: a root of debootstrap, the .deb by apt, the demo as a user, the example project.

    python3 tests/package/clean_root.py BUILD FOLDER

Needs root, debootstrap and the mirror that apt is configured for. FOLDER is emptied before and after. All mounts are in
a namespace of their own: none is left, however this ends.
"""

import filecmp
import json
import os
import shutil
import sys
import time
from pathlib import Path

from deb_test import made_packages
from example_run import ELEMENTS, check_numbers, png_size, run

MIRROR = "http://deb.debian.org/debian"
# The namespace ends with its first process; what is mounted in it ends with the namespace.
NAMESPACE = ("unshare", "--mount", "--pid", "--fork", "--kill-child")
APT = "apt-get -q -y --no-install-recommends -o Acquire::Retries=3"
PICTURES = ("before.png", "after.png", "compare.png", "mesh-before.png", "mesh-after.png")


class Steps:
    """Says what each step took."""

    def __init__(self, root):
        self.root, self.start = root, time.monotonic()

    def done(self, what):
        size = int(run("du", "-sm", "--one-file-system", self.root).split()[0])
        print(f"{what:<40} {time.monotonic() - self.start:6.1f} s {size:6} MB in the root", flush=True)
        self.start = time.monotonic()


def need_root_and_tools():
    if os.geteuid() != 0:
        sys.exit("clean_root: needs root")
    for tool in ("debootstrap", "unshare", "cpack"):
        if shutil.which(tool) is None:
            sys.exit(f"clean_root: {tool} is not installed")


def make_root(root):
    run(*NAMESPACE, "debootstrap", "--variant=minbase", "bookworm", root, MIRROR)
    # This machine's mirrors and proxies; nothing is started.
    sources = sorted({line for line in run("apt-get", "indextargets", "--format", "$(REPO_URI) $(RELEASE) $(COMPONENT)",
                                           "Created-By: Packages", "Origin: Debian").splitlines() if line})
    (root / "etc/apt/sources.list").write_text("".join(f"deb {s}\n" for s in sources or [f"{MIRROR} bookworm main"]))
    settings = [line for line in run("apt-config", "dump").splitlines()
                if line.startswith(("Acquire::http", "Acquire::Check"))]
    (root / "etc/apt/apt.conf.d/99clean-root").write_text("\n".join(settings) + "\n")
    policy = root / "usr/sbin/policy-rc.d"
    policy.write_text("#!/bin/sh\nexit 101\n")
    policy.chmod(0o755)


def in_root(root, command, user=None):
    """A shell command in the root, as its root or as a user of its own, with nothing of our environment."""
    as_user = ("setpriv", f"--reuid={user}", f"--regid={user}", "--clear-groups") if user else ()
    home = "/home/user" if user else "/root"
    return run(*NAMESPACE, f"--mount-proc={root}/proc", "chroot", root, *as_user, "env", "-i", f"HOME={home}",
               "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND=noninteractive", "LC_ALL=C.UTF-8",
               *(f"{k}={v}" for k, v in os.environ.items() if k.lower().endswith("_proxy")),
               "sh", "-ec", f"cd {home}\n{command}")


def install(root, package):
    shutil.copy(package, root / "root")
    in_root(root, f"{APT} install /root/{package.name}")


def check_demo(root, build, folder):
    """The demo in the clean root makes what the build's own makes here, to the byte."""
    in_root(root, "patchlight demo --quiet", user=1000)
    there, here = root / "home/user/patchlight-demo", folder / "demo"
    if json.loads((there / "run.json").read_text())["status"] != "finished":
        sys.exit("the demo's run did not finish")
    for name in PICTURES:
        print(f"  {name:<16} {png_size(there / name)}")
    run(build / "patchlight", "demo", "--quiet", "-o", here)
    files = sorted(str(p.relative_to(here)) for p in here.rglob("*") if p.is_file() and p.name != "timing.json")
    _, different, missing = filecmp.cmpfiles(here, there, files, shallow=False)
    different = [name for name in different if name != "report.html"]  # it shows the seconds
    if different or missing:
        sys.exit(f"the demo in the clean root: other bytes {different}, missing {missing}")
    print(f"  {len(files)} files as outside")


def check_python(root):
    """The module, where it was built."""
    if (root / "usr/lib/python3/dist-packages/patchlight").is_dir():
        in_root(root, f"{APT} install python3-numpy")
        in_root(root, "python3 -c 'import patchlight; print(patchlight.__doc__)'", user=1000)


def check_example(root):
    printed = in_root(root, f"""cp -r /usr/share/doc/patchlight-dev/example .
cmake -S example -B example/build >&2
cmake --build example/build >&2
scene=patchlight-demo/scene/cornell-box.obj
patchlight solve $scene -o run --max-elements {ELEMENTS} --pictures none --quiet
example/build/example $scene {ELEMENTS} example.png""", user=1000)
    png_size(root / "home/user/example.png")
    check_numbers(printed, root / "home/user/run")


def check_removal(root):
    in_root(root, f"{APT} purge patchlight patchlight-dev")
    ours = ("bin/patchlight", "lib/patchlight", "include/patchlight", "lib/cmake/patchlight", "share/doc/patchlight")
    left = [p for p in ours if (root / "usr" / p).exists()]
    if left:
        sys.exit(f"left after purging: {left}")


def main():
    need_root_and_tools()
    build, folder = (Path(p).resolve() for p in sys.argv[1:3])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    root = folder / "root"
    steps = Steps(root)
    try:
        program, dev = made_packages(build, folder / "packages")
        make_root(root)
        in_root(root, f"{APT} update && useradd --create-home --uid 1000 user")
        steps.done("packages, debootstrap")
        install(root, program)
        steps.done("apt install patchlight")
        check_demo(root, build, folder)
        steps.done("demo, there and here")
        install(root, dev)
        in_root(root, f"{APT} install cmake make g++")
        steps.done("apt install patchlight-dev, compiler")
        check_python(root)
        check_example(root)
        check_removal(root)
        steps.done("example, removal")
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
