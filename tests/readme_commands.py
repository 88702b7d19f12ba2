"""Runs every command of the README's fenced ```sh blocks, so that what it says stays true.

    python3 tests/readme_commands.py SOURCE BUILD

The commands run in a copy of the sources, where build/ leads to the build folder under test: ./dev build and
./dev demo find it configured. A block is one shell, from the copy's root, and stops at its first failure. Left out are
./dev test (it is what runs this) and git clone with the cd that follows it (the copy stands for the clone).
"""

import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

NOT_HERE = ("./dev test", "git clone")


def shell_blocks(text):
    for match in re.finditer(r"^```sh\n(.*?)^```\s*$", text, re.MULTILINE | re.DOTALL):
        yield match.group(1)


def runnable(block):
    """The block's commands, one a line with its continuations, without those that can't run here."""
    kept, after_clone = [], False
    for command in re.sub(r"\\\n\s*", " ", block).splitlines():
        command = command.strip()
        skipped = command.startswith(NOT_HERE) or (after_clone and command.startswith("cd "))
        after_clone = command.startswith("git clone")
        if command and not command.startswith("#") and not skipped:
            kept.append(command)
    return kept


def unknown_studies(text, source):
    """Studies that the README shows and data/studies doesn't hold."""
    held = {p.read_text() for p in (source / "data/studies").glob("*.toml")}
    return [m.group(1) for m in re.finditer(r"^```toml\n(.*?)^```\s*$", text, re.MULTILINE | re.DOTALL)
            if m.group(1) not in held]


def copy_of(source, build, folder):
    copy = Path(folder) / "patchlight"
    ours = shutil.ignore_patterns(".git", "build*", "patchlight-demo", "__pycache__")
    shutil.copytree(source, copy, ignore=ours, symlinks=True)
    (copy / "build").symlink_to(build, target_is_directory=True)
    return copy


def run(command_lines, folder):
    script = "set -euo pipefail\n" + "".join(f"printf '$ %s\\n' {quote(c)}\n{c}\n" for c in command_lines)
    begin = time.monotonic()
    done = subprocess.run(["bash", "-c", script], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace", check=False)
    print(done.stdout, end="")
    print(f"-- exit {done.returncode} after {time.monotonic() - begin:.1f} s", flush=True)
    return done.returncode


def quote(text):
    return "'" + text.replace("'", "'\\''") + "'"


def main():
    source, build = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    text = (source / "README.md").read_text(encoding="utf-8")
    for study in unknown_studies(text, source):
        sys.exit(f"README.md shows a study that isn't in data/studies:\n{study}")
    blocks = [runnable(b) for b in shell_blocks(text)]
    blocks = [b for b in blocks if b]
    if not blocks:
        sys.exit("README.md has no ```sh block with a command to run")
    with tempfile.TemporaryDirectory(prefix="patchlight-readme-") as folder:
        copy = copy_of(source, build, folder)
        failed = sum(run(block, copy) != 0 for block in blocks)
    if failed:
        sys.exit(f"{failed} of {len(blocks)} blocks failed")
    print(f"{sum(map(len, blocks))} commands in {len(blocks)} blocks: all run")


if __name__ == "__main__":
    main()
