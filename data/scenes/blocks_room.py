"""A closed room with a lamp and standing blocks, in three parameters, for comparing solvers in the manner of Willmott and
Heckbert (1997): complexity (blocks along a side), occlusion (their height) and reflectance."""

from scene_file import SceneFile, write_view

SIDE, HEIGHT, LAMP = 4.0, 3.0, 0.5  # metres


def rectangle(x0, x1, y0, y1, z):
    """Counter-clockwise seen from above."""
    return [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]


def room(title, blocks, height, reflectance):
    scene = SceneFile(title)
    scene.material("walls", (reflectance,) * 3)
    # Red on one side: what arrives elsewhere has been reflected there.
    scene.material("red", (reflectance, reflectance / 4, reflectance / 4))
    scene.material("blocks", (reflectance,) * 3)
    scene.material("lamp", (0, 0, 0), (10, 10, 10))
    middle = (SIDE / 2, SIDE / 2, HEIGHT / 2)
    low, high = (0, 0, 0), (SIDE, SIDE, HEIGHT)
    x0, y0, z0 = low
    x1, y1, z1 = high
    scene.quad_towards("left", "red", [(x0, y0, z0), (x0, y1, z0), (x0, y1, z1), (x0, y0, z1)], middle)
    scene.quad_towards("right", "walls", [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)], middle)
    scene.quad_towards("front", "walls", [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)], middle)
    scene.quad_towards("back", "walls", [(x0, y1, z0), (x1, y1, z0), (x1, y1, z1), (x0, y1, z1)], middle)
    scene.quad_towards("floor", "walls", rectangle(x0, x1, y0, y1, z0), middle)
    outer = rectangle(x0, x1, y0, y1, z1)[::-1]
    a, b = (SIDE - LAMP) / 2, (SIDE + LAMP) / 2
    inner = rectangle(a, b, a, b, z1)[::-1]
    scene.ring("ceiling", "walls", outer, inner)
    scene.face("lamp", "lamp", inner)
    shell = {"left", "right", "front", "back", "floor", "ceiling", "lamp"}
    assert not scene.open_edges(shell) and scene.volume(shell) < 0
    pitch = SIDE / blocks
    for i in range(blocks):
        for j in range(blocks):
            cx, cy = (i + 0.5) * pitch, (j + 0.5) * pitch
            w = pitch / 5
            scene.box(f"block-{i}-{j}", "blocks", (cx - w, cy - w, 0), (cx + w, cy + w, height), skip=("-z",))
    scene.check_planar()
    return scene


def write(stem, title, blocks=3, height=1.0, reflectance=0.5):
    room(f"{title}: {blocks} x {blocks} blocks {height:g} m high, reflectance {reflectance:g}", blocks, height,
         reflectance).write_obj(stem)
    write_view(stem, "corner", (0.2, 0.2, 2.6), (2.4, 2.4, 0.6), (0, 0, 1), 75)


if __name__ == "__main__":
    write("blocks-room", "A room with blocks")
    write("blocks-room-few", "A room with blocks, less complex", blocks=1)
    write("blocks-room-many", "A room with blocks, more complex", blocks=6)
    write("blocks-room-low", "A room with blocks, less occlusion", height=0.25)
    write("blocks-room-tall", "A room with blocks, more occlusion", height=2.5)
    write("blocks-room-dark", "A room with blocks, less reflectance", reflectance=0.2)
    write("blocks-room-bright", "A room with blocks, more reflectance", reflectance=0.8)
