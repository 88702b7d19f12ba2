"""What the tests of the Python module work on."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import patchlight

SOURCE = Path(__file__).resolve().parents[2]
BOX = SOURCE / "data" / "scenes" / "cornell-box.obj"


def box() -> patchlight.Scene:
    return patchlight.read_scene(BOX, patchlight.SceneOptions(unit=0.001))


def solve_by_command(run: Path, *options: str) -> None:
    command = [os.environ["PATCHLIGHT_COMMAND"], "solve", str(BOX), "--unit", "mm", "-o", str(run)]
    subprocess.run([*command, "--pictures", "none", "--quiet", *options], check=True, stdout=subprocess.DEVNULL)


class Room:
    """All that lights a mesh: everything before the loop."""

    def __init__(self, scene: patchlight.Scene, options: patchlight.AdaptiveOptions) -> None:
        self.scene = scene
        self.options = options
        self.caster = patchlight.RayCaster(scene)
        self.emitted = patchlight.emitted_light(scene, options)
        self.mesh = patchlight.first_mesh(scene, options)
        coarse = self.exchange(self.mesh)
        system = patchlight.assemble(coarse, options)
        self.patches = patchlight.solve(coarse, system, options)
        self.lighting = patchlight.Lighting(coarse, self.emitted, system, self.patches, options)

    def exchange(self, mesh: patchlight.PatchMesh) -> patchlight.Exchange:
        return patchlight.Exchange(self.scene, self.caster, mesh, self.emitted)
