"""Installs a build into a prefix, moves the prefix, and builds on it outside the sources, as a user would.

    python3 tests/package/install_test.py SOURCE BUILD FOLDER

FOLDER is emptied first; it holds the prefix, FOLDER/moved, and the projects built against it.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from example_run import ELEMENTS, check_numbers, png_size, run

# What our build has in its command lines and nobody else's may get.
OUR_FLAGS = ("-ffp-contract", "-frounding-math", "-Wconversion", "-Werror")


def clean_environment():
    kept = {k: v for k, v in os.environ.items() if not k.startswith("CMAKE_") and k.lower() != "patchlight_root"}
    return kept | {"CCACHE_NOHASHDIR": "1"}


def installed_and_moved(build, folder):
    run("cmake", "--install", build, "--prefix", folder / "first")
    return (folder / "first").rename(folder / "moved")


def check_no_path_of_ours(prefix, source, build, folder):
    """Nothing that was installed knows where it was built, or first installed. Asserts do: not in other builds."""
    if "CMAKE_BUILD_TYPE:STRING=Release\n" not in (build / "CMakeCache.txt").read_text():
        return
    ours = [os.fsencode(p) for p in (source, build, folder / "first")]
    for file in (p for p in prefix.rglob("*") if p.is_file() and not p.is_symlink()):
        data = file.read_bytes()
        for path in ours:
            if path in data:
                raise SystemExit(f"{file} holds {path.decode()}")


def check_shared_files(prefix):
    for name in ("bin/patchlight", "lib/patchlight/patchlight_image_file.so", "share/man/man1/patchlight.1",
                 "share/bash-completion/completions/patchlight", "share/zsh/site-functions/_patchlight",
                 "share/fish/vendor_completions.d/patchlight.fish", "share/doc/patchlight/copyright",
                 "share/doc/patchlight/LICENSE", "lib/cmake/patchlight/patchlight-config-version.cmake"):
        if not (prefix / name).is_file() or (prefix / name).stat().st_size == 0:
            raise SystemExit(f"not installed: {name}")


def configure(project, build, prefix, *more, check=True):
    command = ["cmake", "-S", project, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
               "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", f"-DCMAKE_PREFIX_PATH={prefix}", *more]
    if shutil.which("ccache"):
        command.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    if check:
        return run(*command, env=clean_environment())
    return subprocess.run(command, env=clean_environment(), capture_output=True, text=True, check=False)


def check_flags(build):
    for entry in json.loads((build / "compile_commands.json").read_text()):
        flags = [flag for flag in OUR_FLAGS if flag in entry["command"].split()]
        if flags:
            raise SystemExit(f"users are compiled with {flags}")


def check_example(source, prefix, folder):
    project = shutil.copytree(prefix / "share/doc/patchlight-dev/example", folder / "example")
    build = folder / "example-build"
    configure(project, build, prefix)
    check_flags(build)
    run("cmake", "--build", build, "-j2", env=clean_environment())
    scene = source / "data/scenes/furniture-room.obj"
    printed = run(build / "example", scene, ELEMENTS, folder / "example.png", cwd="/")
    if png_size(folder / "example.png") != (320, 240):
        raise SystemExit("the example's picture has another size")
    run(prefix / "bin/patchlight", "solve", scene, "-o", folder / "run", "--max-elements", ELEMENTS,
        "--pictures", "none", "--quiet", cwd="/")
    check_numbers(printed, folder / "run")


def check_refusals(prefix, folder):
    """Another version, and a component that isn't there, are refused by name."""
    for request, cause in (("9.0", "version"), ("0.1 COMPONENTS raytracer", "raytracer")):
        project = folder / "refused"
        project.mkdir(exist_ok=True)
        (project / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(refused CXX)\n"
                                                f"find_package(patchlight {request} REQUIRED)\n")
        done = configure(project, folder / "refused-build", prefix, check=False)
        if done.returncode == 0 or cause not in done.stderr:
            raise SystemExit(f"find_package(patchlight {request}): exit {done.returncode}\n{done.stderr}")


def main():
    source, build, folder = (Path(p).resolve() for p in sys.argv[1:4])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    prefix = installed_and_moved(build, folder)
    check_shared_files(prefix)
    check_no_path_of_ours(prefix, source, build, folder)
    check_example(source, prefix, folder)
    check_refusals(prefix, folder)


if __name__ == "__main__":
    main()
