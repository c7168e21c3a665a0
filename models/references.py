"""Write references.csv: for every scene here its volume by closed form, by OpenSCAD
and by Manifold.

    pip install manifold3d numpy
    python3 models/references.py            # all scenes, into models/references.csv;
                                            # ten minutes on two cores
    python3 models/references.py NAME ...   # these only, to standard output

OpenSCAD (`openscad` on PATH) evaluates the .csg and exports a binary STL; its volume is
summed by the divergence theorem. OpenSCAD 2021.01 cannot import OBJ, so it is given the
same mesh as OFF. Manifold gets the polyhedra that OpenSCAD would make, in double
precision, from the tessellator below; it shares no code with OpenSCAD or solidray. A
linear_extrude of a 2-D Boolean is evaluated as the Boolean of the extrusions.

The closed forms hold for true curves, with every cylinder that has `$fn = 6` left a
hexagonal prism (`--curves auto`).
"""

import math
import re
import struct
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path

import manifold3d
import numpy as np

HERE = Path(__file__).parent

# name, closed form (an expression for `evaluate`, or nothing), why the scene is here
SCENES = [
    ("ball", "4/3*pi*10**3", "one quadric; the smallest scene"),
    (
        "classic",
        # ball less six caps; less three cylinders by inclusion and exclusion: all
        # their overlaps lie inside cube and ball
        "4/3*pi*13.5**3 - 6*cap(13.5; 3.5)"
        " - (3*pi*7**2*20 - 3*16/3*7**3 + 8*(2-sqrt(2))*7**3)",
        "cube and ball less three crossing cylinders; colours per leaf",
    ),
    (
        "die",
        "4/3*pi*13.8**3 - 6*cap(13.8; 3.8) - 21*2/3*pi*1.8**3",
        "balls whose centres lie on the faces of the cube; rotations by right angles",
    ),
    (
        "flange",
        "pi*(2*32**2 + 10*50**2 + frustum(18; 28; 20) + 12*20**2 - 42*16**2"
        " - 8*10*5**2)",
        "cylinders and a frustum stacked face on face; a ring of bolt holes",
    ),
    (
        "bolt",
        "",
        "hexagons by $fn = 6 that must stay hexagons; cones against hexagons; a thread"
        " of rings that share circles",
    ),
    ("pipes", "", "mirror; cylinders that meet at right angles; cavities taken at once"),
    (
        "enclosure",
        "",
        "nested differences; bosses; slots; upright edges where planes touch cylinders",
    ),
    (
        "plate",
        "160*100*3 + 2*160*2*7 - 337*pi*2**2*3"
        " - 4*pi*(2.2**2 + frustum(2; 2.2; 4.2))",
        "341 holes; countersinks flush with the surface",
    ),
    (
        "bracket",
        # foot, wall, two webs: the area of a web by the shoelace formula
        "6*(80*56 - slot(22; 3.5) - 2*pi*3**2)"
        " + 6*(80*50 - 14*14 - slot(22; 3.5) - 2*pi*3**2)"
        " + 2*5*(38*5 + (38+15)/2*10 + (15+5)/2*23)",
        "linear_extrude of 2-D Booleans; a polyhedron with concave faces and its mirror"
        " image; render; the source uses the root modifier",
    ),
    (
        "pawn",
        "",
        "flattened balls; stacked frusta; squares that touch along faces and edges",
    ),
    (
        "gear",
        "",
        "polygons with paths for holes; a round hole cut in the plane before extruding",
    ),
    (
        "pencils",
        "sharp(80) + sharp(72) + sharp(64)",
        "cones with an apex; a hexagonal prism cut by a cone; two parts of different"
        " colour that share cone and core",
    ),
    ("vase", "", "import of OBJ with two concave faces of 60 corners; a mesh hollowed"),
    ("asteroid", "", "import of binary STL; balls and a slanted shaft through a mesh"),
    (
        "menger",
        # the cut passes through the centre of symmetry: half of the sponge
        "(20/27)**3*54**3/2",
        "273 crossing bars with coincident faces; a plane at right angles to a diagonal",
    ),
    (
        "dovetail",
        "60*80*12 + 12*80*60",
        "boxes and prisms that share faces in part; two coloured parts",
    ),
    (
        "globe",
        "7/8*4/3*pi*(30**3 - 7**3) + 4/3*pi*7**3",
        "nested differences of balls that share spheres; the modifiers # and % and"
        " (in the source) *",
    ),
    (
        "tower",
        "1.5*pi*20**2 + pi*(12**2 + 8*9**2 + 15*8*0.6**2 + 0.8*11.5**2"
        " + 6*(4.2*8**2 + 24*4.2*0.4**2 + 0.8*10.8**2)"
        " + 5*5.5**2 + 12*5*0.5**2 + 0.8*8**2 - (45.6-4)*4**2)",
        "a shear; 190 leaves; columns that stand flush between floors",
    ),
]


# ---- closed forms -----------------------------------------------------------------


def cap(radius, height):
    """Cut off a ball by a plane."""
    return math.pi * height**2 * (3 * radius - height) / 3


def frustum(height, r1, r2):
    """Of a cone, in units of pi."""
    return height / 3 * (r1**2 + r1 * r2 + r2**2)


def slot(length, r):
    """Area of a rectangle with round ends."""
    return 2 * r * length + math.pi * r**2


def sharp(length):
    """A hexagonal prism, corners at 4, within the cone whose radius is a fifth of the
    distance from its apex: sections are discs up to the inner radius a of the hexagon,
    then discs less six segments r^2 acos(a/r) - a sqrt(r^2 - a^2), then hexagons."""
    corner, a = 4, 2 * math.sqrt(3)
    root = math.sqrt(corner**2 - a**2)
    log = math.log((corner + root) / a)
    squares = (corner * root + a**2 * log) / 2  # of r^2 / sqrt(r^2 - a^2), a to corner
    roots = (corner * root - a**2 * log) / 2  # of sqrt(r^2 - a^2)
    segments = corner**3 / 3 * math.acos(a / corner) - a / 3 * squares - a * roots
    tip = math.pi * corner**3 / 3 - 6 * segments
    hexagon = 3 * a * corner
    return 5 * tip + hexagon * (length - 5 * corner)


def evaluate(formula):
    """A closed form; arguments are parted by semicolons, for commas part the fields."""
    names = {f.__name__: f for f in (cap, frustum, slot, sharp)}
    names |= {"pi": math.pi, "sqrt": math.sqrt}
    return eval(formula.replace(";", ","), {"__builtins__": {}}, names)


# ---- meshes -----------------------------------------------------------------------


def signed_volume(points, triangles):
    """By the divergence theorem, from the middle of the points."""
    points = np.asarray(points, float)
    points = points - (points.min(axis=0) + points.max(axis=0)) / 2
    a, b, c = (points[np.asarray(triangles)[:, i]] for i in range(3))
    return math.fsum(np.einsum("ij,ij->i", a, np.cross(b, c)) / 6)


def read_stl(path):
    data = path.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0]
    assert len(data) == 84 + 50 * count, "binary STL expected"
    index, triangles = {}, []
    for t in range(count):
        v = struct.unpack_from("<9f", data, 84 + 50 * t + 12)
        corners = [index.setdefault(v[i : i + 3], len(index)) for i in (0, 3, 6)]
        if len(set(corners)) == 3:
            triangles.append(corners)
    return list(index), triangles


def read_obj(path):
    points, faces = [], []
    for line in path.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            points.append(tuple(map(float, rest[:3])))
        elif word == "f":
            faces.append([int(s.split("/")[0]) - 1 for s in rest])
    return points, triangulate_faces(points, faces)


def triangulate_faces(points, faces):
    """Cut polygons in space into triangles, in the plane they lie closest to."""
    triangles = []
    for face in faces:
        if len(face) == 3:
            triangles.append(face)
            continue
        p = np.array([points[i] for i in face], float)
        normal = np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)
        k = int(np.argmax(abs(normal)))
        flat = p[:, [(k + 1) % 3, (k + 2) % 3]]
        if normal[k] < 0:
            flat = flat[:, ::-1]
        cut = manifold3d.triangulate([np.ascontiguousarray(flat)])
        triangles += [[face[i] for i in t] for t in cut]
    return triangles


def solid(points, triangles):
    mesh = manifold3d.Mesh64(
        vert_properties=np.array(points, np.float64),
        tri_verts=np.array(triangles, np.uint64),
    )
    made = manifold3d.Manifold(mesh)
    assert made.status() == manifold3d.Error.NoError, made.status()
    return made


# ---- OpenSCAD's tessellation ------------------------------------------------------


def turn(degrees):
    """Cosine and sine, exact at multiples of 30 and 45 degrees, as in OpenSCAD."""
    degrees %= 360
    quarter, rest = divmod(degrees, 90)
    known = {0: (1, 0), 30: (math.sqrt(0.75), 0.5), 45: (math.sqrt(0.5),) * 2}
    known[60] = known[30][::-1]
    c, s = known.get(rest) or (
        math.cos(math.radians(rest)),
        math.sin(math.radians(rest)),
    )
    return [(c, s), (-s, c), (-c, -s), (s, -c)][int(quarter)]


def segments(r, a):
    if r < 2**-20:
        return 3
    if a["$fn"] > 0:
        return int(max(a["$fn"], 3))
    return math.ceil(max(min(360 / a["$fa"], 2 * math.pi * r / a["$fs"]), 5))


def ring(r, n):
    return [(r * c, r * s) for c, s in (turn(360 * i / n) for i in range(n))]


def stack(rings):
    """Rings of equal count or a single apex (radius 0), from below to above."""
    points, triangles, starts = [], [], []
    for outline, z in rings:
        starts.append(len(points))
        points += [(x, y, z) for x, y in outline]
    for k in range(len(rings) - 1):
        m, n = len(rings[k][0]), len(rings[k + 1][0])
        a, b = starts[k], starts[k + 1]
        for i in range(max(m, n)):
            j = (i + 1) % max(m, n)
            if m > 1:
                triangles.append([a + i, a + j, b + j % n])
            if n > 1:
                triangles.append([a + i % m, b + j, b + i])
    first, last = len(rings[0][0]), len(rings[-1][0])
    triangles += [[0, i + 1, i] for i in range(1, first - 1)]
    top = starts[-1]
    triangles += [[top, top + i, top + i + 1] for i in range(1, last - 1)]
    return solid(points, triangles)


def cylinder(a):
    n = segments(max(a["r1"], a["r2"]), a)
    z = -a["h"] / 2 if a["center"] else 0.0
    ends = [(a["r1"], z), (a["r2"], z + a["h"])]
    return stack([(ring(r, n) if r > 0 else [(0.0, 0.0)], z) for r, z in ends])


def sphere(a):
    r, n = a["r"], segments(a["r"], a)
    count = (n + 1) // 2
    polar = [turn(180 * (i + 0.5) / count) for i in reversed(range(count))]
    return stack([(ring(r * s, n), r * c) for c, s in polar])


def cube(size, center):
    x, y, z = size
    base = [(0, 0), (x, 0), (x, y), (0, y)]
    made = stack([(base, 0), (base, z)])
    return made.translate([-x / 2, -y / 2, -z / 2]) if center else made


def polyhedron(a):
    # clockwise seen from outside
    faces = [face[::-1] for face in a["faces"]]
    return solid(a["points"], triangulate_faces(a["points"], faces))


def inside(p, outline):
    odd = False
    for (x1, y1), (x2, y2) in zip(outline, outline[1:] + outline[:1]):
        if (y1 > p[1]) != (y2 > p[1]):
            odd ^= p[0] < x1 + (p[1] - y1) * (x2 - x1) / (y2 - y1)
    return odd


def prism(outlines, height):
    """Outlines that do not cross; every second one inward is a hole."""
    turned = []
    for k, outline in enumerate(outlines):
        others = (o for i, o in enumerate(outlines) if i != k)
        hole = sum(inside(outline[0], o) for o in others) % 2 == 1
        area = sum(
            x1 * y2 - x2 * y1
            for (x1, y1), (x2, y2) in zip(outline, outline[1:] + outline[:1])
        )
        turned.append(outline if (area < 0) == hole else outline[::-1])
    flat = manifold3d.triangulate([np.array(o, float) for o in turned])
    plane = [p for outline in turned for p in outline]
    n = len(plane)
    points = [(x, y, 0.0) for x, y in plane] + [(x, y, height) for x, y in plane]
    triangles = [[a, c, b] for a, b, c in flat]
    triangles += [[a + n, b + n, c + n] for a, b, c in flat]
    start = 0
    for outline in turned:
        for i in range(len(outline)):
            a, b = start + i, start + (i + 1) % len(outline)
            triangles += [[a, b, b + n], [a, b + n, a + n]]
        start += len(outline)
    return solid(points, triangles)


# ---- the .csg tree ----------------------------------------------------------------

TOKEN = re.compile(
    r"\s*(?:(\"(?:[^\"\\]|\\.)*\")|(-?(?:\d[\d.]*(?:e[-+]?\d+)?|inf|nan))"
    r"|([$A-Za-z_]\w*)|(.))"
)
WORDS = {"true": True, "false": False, "undef": None}


def parse(text):
    """Lists of (modifier, name, arguments, children)."""
    tokens = [m.groups() for m in TOKEN.finditer(text.rstrip())]
    at = 0

    def take():
        nonlocal at
        at += 1
        return next(t for t in tokens[at - 1] if t is not None)

    def peek():
        return next(t for t in tokens[at] if t is not None) if at < len(tokens) else ""

    def expect(what):
        got = take()
        assert got == what, f"{what} expected, not {got}"

    def value():
        string, number, name, other = tokens[at]
        take()
        if string:
            return string[1:-1]
        if number:
            return float(number)
        if name:
            return WORDS[name]
        assert other == "["
        items = []
        while peek() != "]":
            items.append(value())
            if peek() == ",":
                take()
        take()
        return items

    def nodes(end):
        found = []
        while peek() != end:
            modifier = take() if peek() in "#%*!" else ""
            name, arguments, children = take(), {}, []
            expect("(")
            while peek() != ")":
                if tokens[at][2] and tokens[at + 1][3] == "=":
                    key = take()
                    take()
                else:
                    key = len(arguments)
                arguments[key] = value()
                if peek() == ",":
                    take()
            take()
            if take() == "{":
                children = nodes("}")
                expect("}")
            found.append((modifier, name, arguments, children))
        return found

    return nodes("")


def boolean(name, parts):
    op = {
        "difference": manifold3d.OpType.Subtract,
        "intersection": manifold3d.OpType.Intersect,
    }.get(name, manifold3d.OpType.Add)
    return manifold3d.Manifold.batch_boolean(parts, op)


def evaluate_node(node, height):
    """The solid of one node; plane figures as prisms of that height."""
    _, name, a, children = node
    if name == "cube":
        return cube(a["size"], a["center"])
    if name == "sphere":
        return sphere(a)
    if name == "cylinder":
        return cylinder(a)
    if name == "polyhedron":
        faces = [[int(i) for i in face] for face in a["faces"]]
        return polyhedron({"points": a["points"], "faces": faces})
    if name == "import":
        path = HERE / a["file"]
        return solid(*(read_obj if path.suffix == ".obj" else read_stl)(path))
    if name == "square":
        x, y = a["size"]
        dx, dy = (x / 2, y / 2) if a["center"] else (0, 0)
        corners = [(-dx, -dy), (x - dx, -dy), (x - dx, y - dy), (-dx, y - dy)]
        return prism([corners], height)
    if name == "circle":
        return prism([ring(a["r"], segments(a["r"], a))], height)
    if name == "polygon":
        points = [tuple(p) for p in a["points"]]
        paths = a["paths"] or [range(len(points))]
        return prism([[points[int(i)] for i in path] for path in paths], height)
    if name == "linear_extrude":
        assert "twist" not in a and a["scale"] == [1, 1]
        made = union(children, a["height"])
        return made.translate([0, 0, -a["height"] / 2]) if a["center"] else made
    if name in ("difference", "intersection"):
        parts = [evaluate_node(c, height) for c in children if c[0] != "%"]
        return boolean(name, parts)
    if name == "multmatrix":
        return union(children, height).transform(np.array(a[0])[:3])
    assert name in ("group", "union", "color", "render"), name
    return union(children, height)


def union(nodes, height=None):
    return boolean("union", [evaluate_node(n, height) for n in nodes if n[0] != "%"])


# ---- the programs -----------------------------------------------------------------


def by_openscad(name):
    text = (HERE / f"{name}.csg").read_text()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for file in re.findall(r'import\(file = "([^"]+)"', text):
            source = HERE / file
            if source.suffix == ".obj":
                points, triangles = read_obj(source)
                lines = ["OFF", f"{len(points)} {len(triangles)} 0"]
                lines += ["%r %r %r" % p for p in points]
                lines += ["3 %d %d %d" % tuple(t) for t in triangles]
                text = text.replace(file, source.stem + ".off")
                (folder / (source.stem + ".off")).write_text("\n".join(lines) + "\n")
            else:
                (folder / file).write_bytes(source.read_bytes())
        (folder / "scene.csg").write_text(text)
        run = subprocess.run(
            ["openscad", "--export-format=binstl", "-o", "out.stl", "scene.csg"],
            cwd=folder,
            capture_output=True,
            text=True,
        )
        assert run.returncode == 0, run.stderr
        for line in run.stderr.splitlines():
            # 2021.01 warns of the time stamp that it writes itself
            if line.startswith(("WARNING", "ERROR")) and "timestamp" not in line:
                print(f"{name}: {line}", file=sys.stderr)
        return signed_volume(*read_stl(folder / "out.stl"))


def by_manifold(name):
    return union(parse((HERE / f"{name}.csg").read_text())).volume()


def row(name, formula, why):
    closed = f"{evaluate(formula):.12g}" if formula else ""
    openscad, manifold = by_openscad(name), by_manifold(name)
    apart = abs(openscad / manifold - 1)
    print(f"{name}: OpenSCAD and Manifold apart by {apart:.1e}", file=sys.stderr)
    line = [name, closed, f"{openscad:.9g}", f"{manifold:.12g}", formula, why]
    assert not any("," in field for field in line), line
    return ",".join(line)


def main():
    names = sys.argv[1:]
    scenes = [scene for scene in SCENES if not names or scene[0] in names]
    with ThreadPoolExecutor(2) as pool:
        rows = list(pool.map(lambda scene: row(*scene), scenes))
    run = subprocess.run(["openscad", "--version"], capture_output=True, text=True)
    openscad = (run.stderr + run.stdout).strip()
    head = f"""\
# Reference volumes of the scenes in this folder; written by references.py, which says
# how, with
#     python3 models/references.py
# {openscad} (CGAL); Manifold {version("manifold3d")} (manifold3d from PyPI).
#
# closed: of the true curves (--curves auto). openscad, manifold: of the polyhedra that
# OpenSCAD makes of the .csg (--curves faceted). OpenSCAD rounds the points of plane
# figures to 1/65536 and writes its result in 32-bit floats; Manifold's column is in
# double precision throughout. No field contains a comma.
name,closed,openscad,manifold,formula,why
"""
    text = head + "\n".join(rows) + "\n"
    if names:
        print(text, end="")
    else:
        (HERE / "references.csv").write_text(text)


if __name__ == "__main__":
    main()
