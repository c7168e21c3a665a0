"""Write vase.obj and asteroid.stl, the two meshes that scenes here import.

    python3 models/meshes.py

Needs the standard library only, and gives the same bytes on every run.
"""

import math
import struct
from pathlib import Path

HERE = Path(__file__).parent


def vase():
    """A five-lobed tube that twists as it rises; both ends are one concave polygon."""
    around, rings, height = 60, 36, 60.0
    points = []
    for k in range(rings + 1):
        h = k / rings
        radius = 13 + 4 * math.sin(math.pi * (0.15 + 1.35 * h)) + 8 * h**3
        twist = 1.3 * h
        for i in range(around):
            angle = 2 * math.pi * i / around
            r = radius * (1 + 0.11 * math.cos(5 * angle))
            points.append(
                (
                    r * math.cos(angle + twist),
                    r * math.sin(angle + twist),
                    height * h,
                )
            )
    faces = [list(range(around - 1, -1, -1))]
    for k in range(rings):
        for i in range(around):
            j = (i + 1) % around
            a, b = k * around + i, k * around + j
            c, d = b + around, a + around
            faces += [[a, b, c], [a, c, d]]
    faces.append([rings * around + i for i in range(around)])
    with open(HERE / "vase.obj", "w") as out:
        out.write("# A twisted vase, written by meshes.py\no vase\n")
        for x, y, z in points:
            out.write(f"v {x:.5f} {y:.5f} {z:.5f}\n")
        for face in faces:
            out.write("f " + " ".join(str(i + 1) for i in face) + "\n")


def icosphere(rounds):
    """An icosahedron on the unit ball, each triangle split into four, `rounds` times."""
    g = (1 + math.sqrt(5)) / 2
    points = []
    for a, b in ((1, g), (-1, g), (1, -g), (-1, -g)):
        points += [(0, a, b), (a, b, 0), (b, 0, a)]
    points = [unit(p) for p in points]
    side = min(math.dist(points[0], p) for p in points[1:]) * 1.01
    n = range(len(points))
    faces = [
        (a, b, c) if volume6(points[a], points[b], points[c]) > 0 else (a, c, b)
        for a in n
        for b in n
        for c in n
        if a < b < c
        and math.dist(points[a], points[b]) < side
        and math.dist(points[b], points[c]) < side
        and math.dist(points[c], points[a]) < side
    ]
    for _ in range(rounds):
        middles = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(unit([s + t for s, t in zip(points[a], points[b])]))
            return middles[key]

        split = []
        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            split += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = split
    return points, faces


def unit(p):
    length = math.hypot(*p)
    return tuple(s / length for s in p)


def volume6(a, b, c):
    """Six times the volume of the tetrahedron from the origin to a, b, c."""
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def asteroid():
    """A lumpy icosphere; binary STL, so its coordinates are 32-bit floats."""
    points, faces = icosphere(4)
    lumps = [
        ((0.9, 0.3, -0.2), 3.0, 2.2),
        ((-0.5, 0.8, 0.4), 4.0, 2.6),
        ((-0.7, -0.6, -0.3), 3.5, 2.4),
        ((0.1, -0.8, 0.6), 5.0, -2.6),
        ((0.5, 0.2, 0.9), 6.0, 1.8),
        ((0.6, -0.7, -0.4), 7.0, -1.6),
    ]
    moved = []
    for p in points:
        r = 23.0
        for direction, sharp, height in lumps:
            towards = sum(s * t for s, t in zip(p, unit(direction)))
            r += height * math.exp(sharp * (towards - 1))
        x, y, z = p
        r += 0.35 * math.sin(9 * x + 2) * math.sin(8 * y + 1) * math.sin(10 * z)
        r += 0.25 * math.sin(17 * x - 5 * z) * math.sin(19 * y + 3 * x)
        moved.append((1.25 * r * x, r * y, 0.95 * r * z))
    with open(HERE / "asteroid.stl", "wb") as out:
        out.write(b"asteroid, written by meshes.py".ljust(80))
        out.write(struct.pack("<I", len(faces)))
        for face in faces:
            out.write(struct.pack("<3f", 0, 0, 0))
            for i in face:
                out.write(struct.pack("<3f", *moved[i]))
            out.write(struct.pack("<H", 0))


if __name__ == "__main__":
    vase()
    asteroid()
