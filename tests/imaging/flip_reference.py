"""Prints what flip_test.cpp holds FLIP to: the paper's formulas [Andersson20] written down once more, plainly.

Full two-dimensional kernels, double precision, standard library only; shares nothing with apps/imaging/flip.cpp.
"""
from math import ceil, exp, hypot, pi, sqrt

PPD = 0.7 * (3840 / 0.7) * pi / 180
PRIMARIES = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
WHITE = (0.3127 / 0.3290, 1.0, (1 - 0.3127 - 0.3290) / 0.3290)


def solve(m, r):
    """3 × 3 by Cramer's rule."""
    def det(a):
        return sum(a[0][i] * (a[1][(i + 1) % 3] * a[2][(i + 2) % 3] - a[1][(i + 2) % 3] * a[2][(i + 1) % 3])
                   for i in range(3))
    return [det([[r[i] if k == j else m[i][k] for k in range(3)] for i in range(3)]) / det(m) for j in range(3)]


UNSCALED = [[x / y for x, y in PRIMARIES], [1.0] * 3, [(1 - x - y) / y for x, y in PRIMARIES]]
SCALE = solve(UNSCALED, WHITE)
TO_XYZ = [[UNSCALED[i][j] * SCALE[j] for j in range(3)] for i in range(3)]


def relative_xyz(rgb):
    return [sum(TO_XYZ[i][j] * rgb[j] for j in range(3)) / WHITE[i] for i in range(3)]


def opponent(rgb):
    x, y, z = relative_xyz(rgb)
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def hunt_lab(rgb):
    x, y, z = (t ** (1 / 3) if t > (6 / 29) ** 3 else t / (3 * (6 / 29) ** 2) + 4 / 29 for t in relative_xyz(rgb))
    lightness = 116 * y - 16
    return lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)


def hyab(a, b):
    return abs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2])


def color_error(a, b):
    largest = hyab(hunt_lab((0, 1, 0)), hunt_lab((0, 0, 1))) ** 0.7
    d, knee = hyab(hunt_lab(a), hunt_lab(b)) ** 0.7, 0.4 * largest
    return 0.95 / knee * d if d < knee else 0.95 + 0.05 * (d - knee) / (largest - knee)


def convolved(image, radius, weight):
    h, w = len(image), len(image[0])
    return [[sum(weight(i, j) * image[min(max(y + j, 0), h - 1)][min(max(x + i, 0), w - 1)]
                 for j in range(-radius, radius + 1) for i in range(-radius, radius + 1))
             for x in range(w)] for y in range(h)]


def csf(image, terms):
    radius = ceil(3 * sqrt(0.04 / (2 * pi * pi)) * PPD)
    def raw(i, j):
        square = (i * i + j * j) / PPD ** 2
        return sum(a * sqrt(pi / b) * exp(-pi * pi * square / b) for a, b in terms)
    total = sum(raw(i, j) for i in range(-radius, radius + 1) for j in range(-radius, radius + 1))
    return convolved(image, radius, lambda i, j: raw(i, j) / total)


def feature(image, point):
    sd = 0.5 * 0.082 * PPD
    radius = ceil(3 * sd)
    def raw(i, j):
        return (i * i / sd ** 2 - 1 if point else -i) * exp(-(i * i + j * j) / (2 * sd * sd))
    cells = [raw(i, j) for i in range(-radius, radius + 1) for j in range(-radius, radius + 1)]
    plus, minus = sum(c for c in cells if c > 0), -sum(c for c in cells if c < 0)
    def weight(i, j):
        return raw(i, j) / (plus if raw(i, j) > 0 else minus)
    gx, gy = convolved(image, radius, weight), convolved(image, radius, lambda i, j: weight(j, i))
    return [[hypot(a, b) for a, b in zip(p, q)] for p, q in zip(gx, gy)]


def seen(image):
    planes = [[[opponent(p)[k] for p in row] for row in image] for k in range(3)]
    filtered = [csf(planes[0], ((1, 0.0047),)), csf(planes[1], ((1, 0.0053),)),
                csf(planes[2], ((34.1, 0.04), (13.5, 0.025)))]
    def back(c):
        y = (c[0] + 16) / 116
        xyz = [(y + c[1] / 500) * WHITE[0], y * WHITE[1], (y - c[2] / 200) * WHITE[2]]
        return [min(max(v, 0.0), 1.0) for v in solve(TO_XYZ, xyz)]
    return [[back([filtered[k][y][x] for k in range(3)]) for x in range(len(image[0]))] for y in range(len(image))]


def flip(a, b):
    sa, sb = seen(a), seen(b)
    fa, fb = ([feature([[relative_xyz(p)[1] for p in row] for row in image], point) for point in (False, True)]
              for image in (a, b))
    def at(x, y):
        f = max(abs(fa[k][y][x] - fb[k][y][x]) for k in (0, 1)) / sqrt(2)
        return color_error(sa[y][x], sb[y][x]) ** (1 - sqrt(f))
    return [[at(x, y) for x in range(len(a[0]))] for y in range(len(a))]


def pattern(w, h, turn):
    """Whole-number arithmetic, so that C++ makes the same."""
    return [[tuple(((x * 7 + y * 13 + turn * (k + 1) * 5) * (k + 3) % 17) / 16 for k in range(3)) for x in range(w)]
            for y in range(h)]


if __name__ == "__main__":
    for name, a, b in (("black white", (0, 0, 0), (1, 1, 1)), ("green blue", (0, 1, 0), (0, 0, 1)),
                       ("red green", (1, 0, 0), (0, 1, 0)), ("grey .2 .25", (0.2,) * 3, (0.25,) * 3),
                       ("red bit", (0.5, 0.1, 0.1), (0.4, 0.1, 0.1))):
        print(name, repr(color_error(a, b)))
    result = flip(pattern(14, 10, 0), pattern(14, 10, 1))
    print("pattern corner", repr(result[0][0]), "middle", repr(result[5][7]), "mean",
          repr(sum(map(sum, result)) / 140))
    edge = [[(1.0 if x >= 8 else 0.0,) * 3 for x in range(16)] for y in range(4)]
    shifted = [[(1.0 if x >= 9 else 0.0,) * 3 for x in range(16)] for y in range(4)]
    print("edge", [repr(flip(edge, shifted)[2][x]) for x in (0, 8)])
