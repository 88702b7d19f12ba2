"""A living room, 5 m x 4 m x 2.7 m: a white wall beside a strongly lit red one, table, chairs, shelf, sofa. z is up."""

import math

from scene_file import SceneFile, write_view

X, Y, Z = 5.0, 4.0, 2.7
PANEL = (2.2, 3.4, 1.7, 2.4)  # x0, x1, y0, y1 of the light in the ceiling
BOOKS = ("book_red", "book_blue", "book_green", "book_ochre")


def rectangle(x0, x1, y0, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def lift(outline, z):
    return [(x, y, z) for x, y in outline]


class Place:
    """Where a piece of furniture stands: its own x, y turned and moved."""

    def __init__(self, x, y, degrees=0):
        self.x, self.y = x, y
        self.c, self.s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def outline(self, x0, x1, y0, y1):
        return [(round(self.x + self.c * x - self.s * y, 9), round(self.y + self.s * x + self.c * y, 9))
                for x, y in rectangle(x0, x1, y0, y1)]


def materials(scene):
    scene.material("white", (0.75, 0.75, 0.75))
    scene.material("red", (0.65, 0.06, 0.05))
    scene.material("parquet", (0.45, 0.31, 0.19))
    scene.material("wood", (0.5, 0.34, 0.2))
    scene.material("dark_wood", (0.22, 0.14, 0.09))
    scene.material("cloth", (0.2, 0.32, 0.42))
    scene.material("metal", (0.5, 0.5, 0.52))
    scene.material("picture", (0.55, 0.5, 0.3))
    scene.material("book_red", (0.5, 0.1, 0.08))
    scene.material("book_blue", (0.1, 0.16, 0.4))
    scene.material("book_green", (0.12, 0.32, 0.14))
    scene.material("book_ochre", (0.6, 0.42, 0.12))
    scene.material("panel_light", (0, 0, 0), (9, 8.6, 7.8))
    scene.material("wall_light", (0, 0, 0), (32, 30, 26))


def shell(scene):
    inside = (X / 2, Y / 2, Z / 2)
    scene.face("floor", "parquet", lift(rectangle(0, X, 0, Y), 0))
    panel = lift(rectangle(*PANEL), Z)[::-1]
    scene.ring("ceiling", "white", lift(rectangle(0, X, 0, Y), Z)[::-1], panel)
    scene.face("panel_light", "panel_light", panel)
    scene.quad_towards("red_wall", "red", [(0, 0, 0), (0, Y, 0), (0, Y, Z), (0, 0, Z)], inside)
    scene.quad_towards("door_wall", "white", [(X, 0, 0), (X, Y, 0), (X, Y, Z), (X, 0, Z)], inside)
    scene.quad_towards("sofa_wall", "white", [(0, 0, 0), (X, 0, 0), (X, 0, Z), (0, 0, Z)], inside)
    scene.quad_towards("white_wall", "white", [(0, Y, 0), (X, Y, 0), (X, Y, Z), (0, Y, Z)], inside)


def wall_light(scene):
    """A box under the ceiling that shines at the red wall from 35 cm."""
    low, high = (0.35, 1.6, 2.3), (0.43, 3.6, Z)
    scene.box("wall_light", "metal", low, high, skip=("-x", "+z"))
    (x0, y0, z0), (_, y1, z1) = low, high
    scene.face("wall_light", "wall_light", [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)])


def table(scene, place):
    scene.prism("table", "wood", place.outline(-0.8, 0.8, -0.45, 0.45), 0.71, 0.75, bottom=True)
    for x in (-0.74, 0.68):
        for y in (-0.39, 0.33):
            scene.prism("table", "wood", place.outline(x, x + 0.06, y, y + 0.06), 0, 0.71, top=False)


def chair(scene, name, place):
    """Its back is at -y. Legs stand on the floor and end under the seat; the back stands on the seat."""
    scene.prism(name, "dark_wood", place.outline(-0.21, 0.21, -0.21, 0.21), 0.43, 0.46, bottom=True)
    for x in (-0.2, 0.16):
        for y in (-0.2, 0.16):
            scene.prism(name, "dark_wood", place.outline(x, x + 0.04, y, y + 0.04), 0, 0.43, top=False)
        scene.prism(name, "dark_wood", place.outline(x, x + 0.04, -0.2, -0.17), 0.46, 0.6, top=False)
    scene.prism(name, "dark_wood", place.outline(-0.2, 0.2, -0.2, -0.17), 0.6, 0.9, bottom=True)


def shelf(scene):
    """Two uprights and boards without thickness along the white wall, with books."""
    x0, x1, y0, top = 3.3, 4.7, 3.7, 2.0
    for left in (x0 - 0.03, x1):
        scene.box("shelf", "wood", (left, y0, 0), (left + 0.03, Y, top), skip=("-z", "+y"))
    for level in range(5):
        z = 0.2 + 0.4 * level
        scene.sheet("shelf", "wood", lift(rectangle(x0, x1, y0, Y), z))
        if level < 4:
            books(scene, level, x0 + 0.05 + 0.11 * level, z)


def books(scene, level, x, z):
    for k in range(7):
        width = 0.03 + 0.012 * ((3 * k + level) % 4)
        height = 0.21 + 0.03 * ((5 * k + 2 * level) % 5)
        depth = 0.14 + 0.02 * ((k + level) % 3)
        low, high = (round(x, 9), 3.97 - depth, z), (round(x + width, 9), 3.97, z + height)
        scene.box("books", BOOKS[(k + level) % 4], low, high, skip=("-z",))
        x += width + 0.004


def sofa(scene):
    """On a plinth against the wall y = 0: parts stand a little apart, so that no faces lie on each other."""
    scene.box("sofa", "cloth", (1.3, 0.06, 0), (3.3, 0.9, 0.4), skip=("-z",))
    scene.box("sofa", "cloth", (1.3, 0.06, 0.4), (3.3, 0.26, 0.85), skip=("-z",))
    for x in (1.12, 3.32):
        scene.box("sofa", "cloth", (x, 0.06, 0), (x + 0.16, 0.9, 0.6), skip=("-z",))


def pictures(scene):
    for x in (0.7, 1.7):
        scene.box("pictures", "picture", (x, Y - 0.03, 1.3), (x + 0.7, Y, 1.9), skip=("+y",))
    scene.box("pictures", "picture", (X - 0.03, 1.2, 1.2), (X, 2.2, 1.9), skip=("+x",))


def build():
    scene = SceneFile("Furniture room: colour bleeding from a strongly lit red wall")
    materials(scene)
    shell(scene)
    wall_light(scene)
    table(scene, Place(1.9, 2.3))
    chair(scene, "chair_1", Place(1.5, 1.65))
    chair(scene, "chair_2", Place(2.3, 1.62, 4))
    chair(scene, "chair_3", Place(1.5, 2.95, 180))
    chair(scene, "chair_4", Place(2.45, 3.2, 155))
    chair(scene, "chair_5", Place(3.2, 2.2, 72))
    shelf(scene)
    sofa(scene)
    pictures(scene)
    return scene


if __name__ == "__main__":
    room = build()
    room.check_planar()
    walls = {"floor", "ceiling", "panel_light", "red_wall", "door_wall", "sofa_wall", "white_wall"}
    assert not room.open_edges(walls) and abs(room.volume(walls) + X * Y * Z) < 1e-9, "closed, fronts inside"
    for piece in ("table", "chair_1", "chair_4"):
        # The closed parts alone would do; open ends only stand on the floor, the seat or under it.
        assert all(p[2] == q[2] for p, q in room.open_edges({piece})), piece
    room.write_obj("furniture-room")
    write_view("furniture-room", "inside", (4.75, 0.45, 1.65), (1.2, 3.1, 0.95), (0, 0, 1), 62)
