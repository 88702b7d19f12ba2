"""The three direct-light cases whose error curves are known: a light, something black, a unit square below."""

from scene_file import SceneFile, write_view


def rectangle(x0, x1, y0, y1, z):
    """Counter-clockwise seen from above."""
    return [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]


def scene_with(title, light, blocker):
    scene = SceneFile(title)
    scene.material("receiver", (0.5, 0.5, 0.5))
    scene.material("light", (0, 0, 0), (10, 10, 10))
    scene.material("blocker", (0, 0, 0))
    scene.face("receiver", "receiver", rectangle(0, 1, 0, 1, 0))
    scene.face("light", "light", rectangle(*light, 1)[::-1])
    scene.sheet("blocker", "blocker", blocker)
    scene.check_planar()
    return scene


def write(stem, title, light, blocker):
    scene_with(title, light, blocker).write_obj(stem)
    write_view(stem, "above", (0.5, -1.2, 1.1), (0.5, 0.5, 0.1), (0, 0, 1), 45)


if __name__ == "__main__":
    write("narrow-penumbra", "Narrow penumbra: a small light, a blocker close to the receiver",
          (0.45, 0.55, 0.45, 0.55), rectangle(0.31, 0.67, 0.36, 0.71, 0.15))
    write("wide-penumbra", "Wide penumbra: a large light, a blocker half-way",
          (0.2, 0.6, 0.3, 0.7), rectangle(0.35, 0.65, 0.4, 0.7, 0.5))
    write("wall-on-floor", "A plate that stands on the receiver: a contact line",
          (0.1, 0.4, 0.3, 0.6),
          [(0.52, 0.25, 0), (0.52, 0.75, 0), (0.52, 0.75, 0.3), (0.52, 0.25, 0.3)])
