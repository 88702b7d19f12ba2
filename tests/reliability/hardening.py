"""The hardening that CMakeLists.txt asks for is in the program and in its module of pictures: position-independent,
relocations read-only, stack not executable and with canaries, checked calls of the C library, checked containers.

    python3 tests/reliability/hardening.py FILE...

Nothing to look for in a build of another kind than Release: exit code 77.
"""

import re
import subprocess
import sys
from pathlib import Path


def read(file, *what):
    return subprocess.run(["readelf", "-W", *what, file], capture_output=True, text=True, check=True).stdout


def missing(file):
    header, segments, dynamic, symbols = read(file, "-h"), read(file, "-l"), read(file, "-d"), read(file, "--dyn-syms")
    stack = re.search(r"GNU_STACK.*?\s(R\S*)\s+0x", segments)
    found = {
        "position-independent": re.search(r"Type:\s+DYN", header),
        "relocations read-only after loading": "GNU_RELRO" in segments and "NOW" in dynamic,
        "no executable stack": stack and "E" not in stack[1],
        "stack protector": "__stack_chk_fail" in symbols,
        "library assertions": "__glibcxx_assert_fail" in symbols,
    }
    if file.suffix != ".so":
        found["checked calls of the C library"] = re.search(r"__\w+_chk@", symbols)
    return [name for name, there in found.items() if not there]


def main():
    files = list(map(Path, sys.argv[1:]))
    cache = (files[0].parent / "CMakeCache.txt").read_text()
    if "CMAKE_BUILD_TYPE:STRING=Release" not in cache or not re.search(r"PATCHLIGHT_SANITIZE:STRING=\s*$", cache, re.M):
        sys.exit(77)
    bad = 0
    for file in files:
        lacks = missing(file)
        bad += bool(lacks)
        print(f"{file.name}: {'lacks ' + ', '.join(lacks) if lacks else 'hardened'}")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
