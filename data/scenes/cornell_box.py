"""The Cornell box, after the measured data of Cornell's Program of Computer Graphics, with a rectangular room."""

from scene_file import SceneFile, write_view

X, Y, Z = 552.8, 548.8, 559.2
LIGHT = [(213, 227), (343, 227), (343, 332), (213, 332)]  # x, z
SHORT = ([(130, 65), (82, 225), (240, 272), (290, 114)], 165)
TALL = ([(423, 247), (265, 296), (314, 456), (472, 406)], 330)


def ceiling_around_light():
    """Four trapezoids from the light's corners to the room's: they share whole edges, with the light too."""
    room = [(0, 0), (X, 0), (X, Z), (0, Z)]
    for k in range(4):
        a, b = room[k], room[(k + 1) % 4]
        c, d = LIGHT[(k + 1) % 4], LIGHT[k]
        yield [(x, Y, z) for x, z in (a, b, c, d)]


def build(closed=False):
    title = "Cornell box (measured data of Cornell's Program of Computer Graphics)"
    scene = SceneFile(f"{title}, front wall added" if closed else title, "mm")
    scene.material("white", (0.75, 0.75, 0.75))
    scene.material("red", (0.63, 0.065, 0.05))
    scene.material("green", (0.14, 0.45, 0.09))
    scene.material("light", (0, 0, 0), (17, 12, 4))
    inside = (X / 2, Y / 2, Z / 2)
    scene.quad_towards("floor", "white", [(0, 0, 0), (X, 0, 0), (X, 0, Z), (0, 0, Z)], inside)
    for polygon in ceiling_around_light():
        scene.quad_towards("ceiling", "white", polygon, inside)
    scene.quad_towards("light", "light", [(x, Y, z) for x, z in LIGHT], inside)
    scene.quad_towards("back_wall", "white", [(0, 0, Z), (X, 0, Z), (X, Y, Z), (0, Y, Z)], inside)
    scene.quad_towards("left_wall", "red", [(X, 0, 0), (X, Y, 0), (X, Y, Z), (X, 0, Z)], inside)
    scene.quad_towards("right_wall", "green", [(0, 0, 0), (0, Y, 0), (0, Y, Z), (0, 0, Z)], inside)
    if closed:
        scene.quad_towards("front_wall", "white", [(0, 0, 0), (X, 0, 0), (X, Y, 0), (0, Y, 0)], inside)
    for name, (outline, height) in (("short_block", SHORT), ("tall_block", TALL)):
        block(scene, name, outline, height)
    return scene


def block(scene, name, outline, height):
    """Top and four sides, outward; no bottom."""
    cx = sum(x for x, _ in outline) / 4
    cz = sum(z for _, z in outline) / 4
    scene.quad_towards(name, "white", [(x, height, z) for x, z in outline], (cx, 2 * height, cz))
    for k in range(4):
        (ax, az), (bx, bz) = outline[k], outline[(k + 1) % 4]
        outside = (ax + bx - cx, height / 2, az + bz - cz)
        scene.quad_towards(name, "white", [(ax, 0, az), (bx, 0, bz), (bx, height, bz), (ax, height, az)], outside)


def check(scene):
    scene.check_planar()
    room = {"floor", "ceiling", "light", "back_wall", "left_wall", "right_wall"}
    if any(obj == "front_wall" for obj, _, _ in scene.faces):
        assert not list(scene.open_edges(room | {"front_wall"})), "nothing is open"
    assert all(p[2] == 0 and q[2] == 0 for p, q in scene.open_edges(room)), "only the front is open"
    for name in ("short_block", "tall_block"):
        assert all(p[1] == 0 and q[1] == 0 for p, q in scene.open_edges({name})), "only the bottom is open"
        assert scene.volume({name}) > 0


if __name__ == "__main__":
    box = build()
    check(box)
    box.write_obj("cornell-box")
    view = write_view("cornell-box", "front", (278, 273, -800), (278, 273, 0), (0, 1, 0), 39.3)
    box.write_glb("cornell-box", 0.001, view)
    closed_box = build(closed=True)
    check(closed_box)
    closed_box.write_obj("cornell-box-closed")
