"""A gallery: pillars, partitions, pedestals with vases, framed pictures, rows of lights. z is up.

    python3 gallery.py [--bays N] [--stem NAME]      N bays of 4 m; the committed file has 6
"""

import argparse
import math

from scene_file import SceneFile, newell, write_view

BAY, WIDTH, HEIGHT = 4.0, 14.0, 5.0
PILLAR_ROWS = (3.5, 10.5)
COLOURS = {"blue": (0.12, 0.2, 0.5), "ochre": (0.6, 0.42, 0.15), "rust": (0.5, 0.17, 0.08), "moss": (0.2, 0.35, 0.15)}
VASE = ((0.10, 0.0), (0.16, 0.08), (0.19, 0.2), (0.17, 0.32), (0.1, 0.42), (0.07, 0.5), (0.11, 0.58))


def rectangle(x0, x1, y0, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def circle(x, y, radius, sides):
    angles = [2 * math.pi * (k + 0.5) / sides for k in range(sides)]
    return [(round(x + radius * math.cos(a), 6), round(y + radius * math.sin(a), 6)) for a in angles]


def lift(outline, z):
    return [(x, y, z) for x, y in outline]


def materials(scene):
    scene.material("plaster", (0.78, 0.77, 0.74))
    scene.material("stone", (0.42, 0.4, 0.38))
    scene.material("marble", (0.7, 0.69, 0.66))
    scene.material("frame", (0.25, 0.17, 0.1))
    for name, kd in COLOURS.items():
        scene.material(name, kd)
    scene.material("lamp", (0, 0, 0), (26, 24, 21))


def shell(scene, length):
    inside = (length / 2, WIDTH / 2, HEIGHT / 2)
    scene.face("floor", "stone", lift(rectangle(0, length, 0, WIDTH), 0))
    scene.face("ceiling", "plaster", lift(rectangle(0, length, 0, WIDTH), HEIGHT)[::-1])
    for k, x in enumerate((0, length)):
        wall = [(x, 0, 0), (x, WIDTH, 0), (x, WIDTH, HEIGHT), (x, 0, HEIGHT)]
        scene.quad_towards(f"end_wall_{k + 1}", "plaster", wall, inside)
    for k, y in enumerate((0, WIDTH)):
        wall = [(0, y, 0), (length, y, 0), (length, y, HEIGHT), (0, y, HEIGHT)]
        scene.quad_towards(f"long_wall_{k + 1}", "plaster", wall, inside)


def pillar(scene, name, x, y):
    """Base, shaft, capital; each stands on the one below, the capital reaches the ceiling."""
    sides = 16
    scene.prism(name, "marble", circle(x, y, 0.42, sides), 0, 0.25)
    scene.prism(name, "marble", circle(x, y, 0.3, sides), 0.25, HEIGHT - 0.3, top=False)
    scene.prism(name, "marble", circle(x, y, 0.42, sides), HEIGHT - 0.3, HEIGHT, bottom=True, top=False)


def vase(scene, name, material, x, y, z):
    sides = 14
    rings = [lift(circle(x, y, r, sides), round(z + h, 6)) for r, h in VASE]
    for low, high in zip(rings, rings[1:]):
        for k in range(sides):
            n = (k + 1) % sides
            scene.face(name, material, [low[k], low[n], high[n], high[k]])
    scene.face(name, material, rings[-1])


def pedestal(scene, number, x, y):
    height = 0.9 + 0.1 * (number % 3)
    scene.box(f"pedestal_{number}", "plaster", (x - 0.25, y - 0.25, 0), (x + 0.25, y + 0.25, height), skip=("-z",))
    vase(scene, f"vase_{number}", list(COLOURS)[(number + number // 4) % 4], x, y, height)


def picture(scene, name, corner, along, normal, width, height):
    """A framed picture on a wall: `corner` is its lower left one seen from the front, `along` runs to the right."""
    def at(s, t, depth):
        return tuple(round(corner[k] + s * along[k] + depth * normal[k] + (t if k == 2 else 0), 9) for k in range(3))

    def loop(inset, depth):
        return [at(s, t, depth) for s, t in ((inset, inset), (width - inset, inset), (width - inset, height - inset),
                                             (inset, height - inset))]

    back, front, canvas = loop(0, 0), loop(0, 0.05), loop(0.08, 0.05)
    assert sum(a * b for a, b in zip(newell(front), normal)) > 0
    scene.ring(name, "frame", back, front)
    scene.ring(name, "frame", front, canvas)
    scene.face(name, list(COLOURS)[(number(name) + number(name) // 4) % 4], canvas)


def lamp(scene, number, x, y):
    """A shallow box under the ceiling; its lower side shines."""
    low, high = (x - 0.6, y - 0.15, HEIGHT - 0.12), (x + 0.6, y + 0.15, HEIGHT)
    scene.box(f"lamp_{number}", "frame", low, high, skip=("-z", "+z"))
    scene.face(f"lamp_{number}", "lamp", lift(rectangle(low[0], high[0], low[1], high[1]), low[2])[::-1])


def partition(scene, number, x):
    """A wall that stands free in the middle aisle, with a picture on each side."""
    y0, y1 = 5.2, 8.8
    scene.box(f"partition_{number}", "plaster", (x - 0.1, y0, 0), (x + 0.1, y1, 3.2), skip=("-z",))
    picture(scene, f"picture_p{number}a", (x + 0.1, y0 + 0.9, 1.1), (0, 1, 0), (1, 0, 0), 1.8, 1.2)
    picture(scene, f"picture_p{number}b", (x - 0.1, y1 - 0.9, 1.1), (0, -1, 0), (-1, 0, 0), 1.8, 1.2)


def build(bays):
    scene = SceneFile(f"Gallery of {bays} bays")
    materials(scene)
    shell(scene, bays * BAY)
    for bay in range(bays):
        x = BAY * (bay + 0.5)
        for row, y in enumerate(PILLAR_ROWS):
            pillar(scene, f"pillar_{2 * bay + row + 1}", x, y)
        for k, y in enumerate((1.6, 12.4, 7.0)):
            lamp(scene, 3 * bay + k + 1, x, y)
        for k, (dx, y) in enumerate(((-1.4, 2.2), (1.4, 2.2), (-1.4, 11.8), (1.4, 11.8))):
            pedestal(scene, 4 * bay + k + 1, x + dx, y)
        for k, dx in enumerate((-1.6, 0.4)):
            picture(scene, f"picture_{4 * bay + k + 1}", (x + dx + 1.2, 0, 1.2), (-1, 0, 0), (0, 1, 0), 1.2, 0.9 + 0.2 * k)
            picture(scene, f"picture_{4 * bay + k + 3}", (x + dx, WIDTH, 1.2), (1, 0, 0), (0, -1, 0), 1.2, 1.1 - 0.2 * k)
        if bay % 2 == 1:
            partition(scene, bay, x)
    return scene


def number(text):
    return int("".join(c for c in text if c.isdigit()))


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--bays", type=int, default=6)
    options.add_argument("--stem", default="gallery")
    options = options.parse_args()
    hall = build(options.bays)
    hall.check_planar(1e-6)
    walls = {o for o, _, _ in hall.faces if o in ("floor", "ceiling") or "_wall_" in o}
    room = options.bays * BAY * WIDTH * HEIGHT
    assert not hall.open_edges(walls) and abs(hall.volume(walls) + room) < 1e-9 * room, "closed, fronts inside"
    hall.write_obj(options.stem)
    length = options.bays * BAY
    write_view(options.stem, "inside", (0.6, 13.2, 2.3), (length * 0.5, 5.2, 1.5), (0, 0, 1), 60)
    print(f"{len(hall.faces)} polygons")
