"""The package: what it holds, its types, its options, how soon it is there."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from typing import Any

import patchlight
from cornell import SOURCE, solve_by_command

STUB = Path(patchlight.__file__).with_name("__init__.pyi")


def public(names: Any) -> set[str]:
    return {name for name in names if not name.startswith("_")}


def names_in(body: list[ast.stmt]) -> set[str]:
    """What is defined there: classes, functions, properties and plain attributes."""
    names = {node.name for node in body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    return names | {n.target.id for n in body if isinstance(n, ast.AnnAssign) and isinstance(n.target, ast.Name)}


class Package(unittest.TestCase):
    def test_stub_and_module_name_the_same(self) -> None:
        tree = ast.parse(STUB.read_text())
        self.assertEqual(public(names_in(tree.body)), public(dir(patchlight)))
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and not issubclass(getattr(patchlight, node.name), Exception):
                real = getattr(patchlight, node.name)
                self.assertEqual(public(names_in(node.body)), public(vars(real)), node.name)
                self.assertEqual(real.__module__, "patchlight", node.name)

    def test_everything_is_documented(self) -> None:
        for name in public(dir(patchlight)):
            self.assertTrue(getattr(patchlight, name).__doc__, name)

    def test_types(self) -> None:
        files = [*sorted(Path(__file__).parent.glob("*.py")), SOURCE / "apps" / "python" / "examples" / "convergence.py"]
        with tempfile.TemporaryDirectory() as cache:
            environment = {**os.environ, "MYPYPATH": str(STUB.parents[1])}
            found = subprocess.run(
                [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir", cache, *map(str, files)],
                capture_output=True,
                text=True,
                env=environment,
                cwd=Path(__file__).parent,
                check=False,
            )
        self.assertEqual(found.returncode, 0, found.stdout + found.stderr)

    def test_options_are_the_commands(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            solve_by_command(Path(folder) / "run", "--max-elements", "200", "--refine", "intensity")
            solve = json.loads((Path(folder) / "run" / "run.json").read_text())["options"]["solve"]

        def same(json_options: dict[str, Any], options: Any) -> None:
            for key, value in json_options.items():
                mine = getattr(options, key)
                if isinstance(value, dict):
                    same(value, mine)
                else:
                    self.assertEqual(mine, value, key)

        same(solve, patchlight.AdaptiveOptions(max_elements=200, refine="intensity"))

    def test_options_are_shown_and_read_back(self) -> None:
        options = patchlight.AdaptiveOptions(target_error=0.05, final=patchlight.SolveOptions(solver="jacobi"))
        names = {name: getattr(patchlight, name) for name in public(dir(patchlight))}
        self.assertEqual(repr(eval(repr(options), names)), repr(options))
        self.assertIn("solver='jacobi'", repr(options))
        # Options within options are theirs, not copies.
        options.mark.share = 0.25
        self.assertEqual(options.mark.share, 0.25)

    def test_importing_takes_less_than_a_third_of_a_second(self) -> None:
        def seconds() -> float:
            begin = time.perf_counter()
            subprocess.run([sys.executable, "-c", "import patchlight"], check=True)
            return time.perf_counter() - begin

        def cpu_seconds() -> float:
            code = "import time; t = time.process_time(); import patchlight; print(time.process_time() - t)"
            return float(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True).stdout)

        seconds()  # reads the files once
        # Of the processor: whatever else this machine does at the time doesn't count.
        self.assertLess(min(cpu_seconds() for _ in range(5)), 0.3)

    def test_what_it_does_not_need_is_not_loaded(self) -> None:
        code = "import patchlight; print(open('/proc/self/maps').read())"
        maps = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout
        for library in ("OpenImageIO", "libQt", "libcrypto++", "libOpenEXR"):
            self.assertNotIn(library, maps)

    def test_example(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "convergence.png"
            script = SOURCE / "apps" / "python" / "examples" / "convergence.py"
            environment = {**os.environ, "MPLCONFIGDIR": folder}
            told = subprocess.run(
                [sys.executable, str(script), "-o", str(picture), "--max-elements", "1200"],
                check=True,
                capture_output=True,
                text=True,
                env=environment,
            ).stdout
            self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        errors = [float(line.rsplit(" ", 2)[1]) for line in told.splitlines()]
        self.assertEqual(len(errors), 3, told)
        # Uniform is worst, and lines are worth having: that is what the picture is for.
        self.assertGreater(errors[0], errors[1])
        self.assertGreater(errors[1], errors[2])


if __name__ == "__main__":
    unittest.main()
