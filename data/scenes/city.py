"""A city at dusk, as large as asked for: blocks of houses on a ground plane with streets. z is up, metres.

    python3 city.py --polygons N --stem PATH      about N polygons, PATH.obj and PATH.mtl; without: checks itself only

Facades have windows flush with the wall; one in five is lit and emits, so that large cities have thousands of emitters,
and over each block hangs a panel of sky. 10^6 polygons are 420,000 surfaces in a file of 75 MB.
"""

import argparse
import math
import random

from scene_file import SceneFile, write_view

BLOCK, STREET, KERB, SKY = 50.0, 14.0, 0.15, 120.0
FLOOR, SILL, HEAD = 3.2, 0.9, 2.4  # heights of a floor, and of its windows above it
BAY, PANE = 3.6, 1.8  # widths
WALLS = ("brick", "render", "sandstone")
HOUSES = ((3, 23, 3, 23), (27, 47, 3, 21), (3, 21, 27, 47), (25, 47, 25, 47))  # x0, x1, y0, y1 in a block


def materials(scene):
    scene.material("asphalt", (0.12, 0.12, 0.13))
    scene.material("paving", (0.35, 0.34, 0.32))
    scene.material("roof", (0.25, 0.2, 0.18))
    scene.material("brick", (0.45, 0.22, 0.15))
    scene.material("render", (0.7, 0.66, 0.55))
    scene.material("sandstone", (0.6, 0.5, 0.38))
    scene.material("glass", (0.08, 0.09, 0.1))
    scene.material("window", (0.08, 0.09, 0.1), (8, 6, 3.5))
    scene.material("sky", (0, 0, 0), (0.5, 0.6, 0.9))


def facade(scene, name, wall, chance, corner, along, width, z0, floors):
    """The wall from `corner` in direction `along`; its front is on the right."""

    def rectangle(material, s0, s1, h0, h1):
        x, y = corner
        dx, dy = along
        scene.face(name, material, [(round(x + s * dx, 9), round(y + s * dy, 9), round(z0 + h, 9))
                                    for s, h in ((s0, h0), (s1, h0), (s1, h1), (s0, h1))])

    bays = int(width / BAY)
    starts = [(width - bays * BAY) / 2 + BAY * k + (BAY - PANE) / 2 for k in range(bays)]
    top = 0.0
    for floor in range(floors):
        low, high = floor * FLOOR + SILL, floor * FLOOR + HEAD
        rectangle(wall, 0, width, top, low)
        left = 0.0
        for s in starts:
            rectangle(wall, left, s, low, high)
            rectangle("window" if chance.random() < 0.2 else "glass", s, s + PANE, low, high)
            left = s + PANE
        rectangle(wall, left, width, low, high)
        top = high
    rectangle(wall, 0, width, top, floors * FLOOR + 0.5)


def house(scene, name, chance, x0, x1, y0, y1):
    floors, wall = chance.randint(2, 9), chance.choice(WALLS)
    height = KERB + floors * FLOOR + 0.5
    for k, (corner, along, width) in enumerate((((x0, y0), (1, 0), x1 - x0), ((x1, y0), (0, 1), y1 - y0),
                                                ((x1, y1), (-1, 0), x1 - x0), ((x0, y1), (0, -1), y1 - y0))):
        facade(scene, f"{name}_{k + 1}", wall, chance, corner, along, width, KERB, floors)
    roof = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    scene.face(f"{name}_roof", "roof", [(x, y, round(height, 9)) for x, y in roof])


def build(polygons):
    chance = random.Random(1)
    scene = SceneFile("City at dusk")
    materials(scene)
    pitch = BLOCK + STREET
    rows = max(1, round(math.sqrt(polygons / 720)))  # of blocks; one has about 720 polygons
    columns = max(1, round(polygons / 1220 / rows))
    for i in range(columns):
        for j in range(rows):
            x, y = i * pitch + STREET / 2, j * pitch + STREET / 2
            scene.box(f"kerb_{i}_{j}", "paving", (x, y, 0.0), (x + BLOCK, y + BLOCK, KERB), skip=("-z",))
            for k, (x0, x1, y0, y1) in enumerate(HOUSES):
                house(scene, f"house_{i}_{j}_{k + 1}", chance, x + x0, x + x1, y + y0, y + y1)
            # The street around the block, in four pieces that its neighbours' meet.
            x0, x1, y0, y1 = i * pitch, (i + 1) * pitch, j * pitch, (j + 1) * pitch
            outer = [(x0, y0, 0.0), (x1, y0, 0.0), (x1, y1, 0.0), (x0, y1, 0.0)]
            inner = [(x, y, 0.0), (x + BLOCK, y, 0.0), (x + BLOCK, y + BLOCK, 0.0), (x, y + BLOCK, 0.0)]
            scene.ring(f"street_{i}_{j}", "asphalt", outer, inner)
            z = SKY + (i + j) % 2  # at two heights, or all of it were one surface of two triangles
            scene.face(f"sky_{i}_{j}", "sky", [(x0, y0, z), (x0, y1, z), (x1, y1, z), (x1, y0, z)])
    return scene, (columns * pitch, rows * pitch)


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--polygons", type=int, default=0)
    options.add_argument("--stem")
    options = options.parse_args()
    city, (width, depth) = build(options.polygons or 1220)
    if len(city.faces) < 20000:
        city.check_planar()
    if options.stem:
        city.write_obj(options.stem)
        write_view(options.stem, "street", (width / 2, -0.1 * depth, 60), (width / 2, depth / 2, 0), (0, 0, 1), 60)
    print(f"{len(city.faces)} polygons, {width:g} x {depth:g} m")
