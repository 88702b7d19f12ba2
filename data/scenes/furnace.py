"""An L-shaped closed room, turned out of the axes, that emits and reflects the same everywhere: B = E/(1 - rho)."""

import math

from scene_file import SceneFile, write_view

OUTLINE = [(0, 0), (4, 0), (4, 2), (1.5, 2), (1.5, 3.5), (0, 3.5)]
HEIGHT = 2.5
ANGLES = (0.4, -0.7, 1.1)  # radians about x, y, z


def turn(p):
    x, y, z = p
    a, b, c = ANGLES
    y, z = y * math.cos(a) - z * math.sin(a), y * math.sin(a) + z * math.cos(a)
    x, z = x * math.cos(b) + z * math.sin(b), -x * math.sin(b) + z * math.cos(b)
    x, y = x * math.cos(c) - y * math.sin(c), x * math.sin(c) + y * math.cos(c)
    return tuple(round(t, 12) for t in (x, y, z))


def build():
    scene = SceneFile("Furnace: an L-shaped closed room, uniform emission and reflectance .7")
    scene.material("furnace", (0.7, 0.7, 0.7), (1, 1, 1))
    n = len(OUTLINE)
    for k in range(n):
        (ax, ay), (bx, by) = OUTLINE[k], OUTLINE[(k + 1) % n]
        wall = [(bx, by, 0), (ax, ay, 0), (ax, ay, HEIGHT), (bx, by, HEIGHT)]
        scene.face(f"wall_{k + 1}", "furnace", [turn(p) for p in wall])
    scene.face("floor", "furnace", [turn((x, y, 0)) for x, y in OUTLINE])
    scene.face("ceiling", "furnace", [turn((x, y, HEIGHT)) for x, y in reversed(OUTLINE)])
    return scene


if __name__ == "__main__":
    room = build()
    room.check_planar()
    assert not room.open_edges()
    assert abs(room.volume() + 10.25 * HEIGHT) < 1e-9, "fronts look inside"
    room.write_obj("furnace")
    write_view("furnace", "inside", turn((3.7, 0.3, 1.4)), turn((0.7, 1.5, 1.0)), turn((0, 0, 1)), 70)
