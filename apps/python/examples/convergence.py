#!/usr/bin/env python3
"""Estimated error against elements on the Cornell box: uniform meshes, adaptive ones, adaptive ones with shadow lines.

    PYTHONPATH=build/python python3 apps/python/examples/convergence.py -o convergence.png
"""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import patchlight
from matplotlib.ticker import FormatStrFormatter, NullFormatter

BOX = Path(__file__).resolve().parents[3] / "data" / "scenes" / "cornell-box.obj"
Curve = list[tuple[int, float]]  # elements, relative error


def uniform_curve(scene: patchlight.Scene, most: int) -> Curve:
    """One solve for each of six sizes of the uniform mesh."""
    curve: Curve = []
    for budget in (most >> k for k in range(5, -1, -1)):
        # What `solve --refine none --max-elements` does.
        options = patchlight.AdaptiveOptions(
            refine="none", max_elements=budget, meshing=patchlight.MeshingOptions(max_elements=budget)
        )
        solution = patchlight.solve_adaptively(scene, options)
        curve.append((len(solution.mesh), solution.error.relative))
    return curve


def adaptive_curve(scene: patchlight.Scene, most: int, options: patchlight.AdaptiveOptions) -> Curve:
    """All cycles of one solve but the first, whose mesh is uniform."""
    curve: Curve = []
    options.max_elements = most

    def observe(step: patchlight.AdaptiveStep) -> None:
        if step.stage != "rough":
            curve.append((len(step.mesh), step.error.relative))

    patchlight.solve_adaptively(scene, options, observe)
    return curve


def plot(curves: dict[str, Curve], file: Path) -> None:
    figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
    for (name, curve), marker in zip(curves.items(), "os^", strict=True):
        axes.loglog([n for n, _ in curve], [100 * e for _, e in curve], marker=marker, markersize=4, label=name)
    steps = [digit * 10.0**power for power in range(-3, 6) for digit in (1, 2, 5)]
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        axis.set_ticks([step for step in steps if low <= step <= high])
        axis.set_major_formatter(FormatStrFormatter("%g"))
        axis.set_minor_formatter(NullFormatter())
    axes.set(xlabel="elements", ylabel="estimated relative error, %", title="Cornell box")
    axes.grid(visible=True, which="both", alpha=0.3)
    axes.legend()
    figure.savefig(file, dpi=100, metadata={"Software": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path("convergence.png"))
    parser.add_argument("--max-elements", type=int, default=8000)
    arguments = parser.parse_args()
    most = arguments.max_elements
    scene = patchlight.read_scene(BOX, patchlight.SceneOptions(unit=0.001))
    curves = {
        "uniform": uniform_curve(scene, most),
        "intensity": adaptive_curve(scene, most, patchlight.AdaptiveOptions(refine="intensity")),
        "both: with shadow lines": adaptive_curve(scene, most, patchlight.AdaptiveOptions(refine="both")),
    }
    plot(curves, arguments.output)
    for name, curve in curves.items():
        print(f"{name}: {curve[-1][0]} elements, estimated error {100 * curve[-1][1]:.2f} %")


if __name__ == "__main__":
    main()
