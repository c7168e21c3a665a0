"""Builds a tree by Manifold (`pip install manifold3d`) and prints its version, or for one
number of segments of a circle the processor time in seconds and the volume.

    manifold.py version
    manifold.py TREE.json SEGMENTS
"""

import json
import sys
import time
from importlib.metadata import version

import manifold3d
from manifold3d import Manifold, OpType

OPS = {
    "union": OpType.Add,
    "intersection": OpType.Intersect,
    "difference": OpType.Subtract,
}


def build(part, segments):
    if "op" in part:
        parts = [build(p, segments) for p in part["parts"]]
        return Manifold.batch_boolean(parts, OPS[part["op"]])
    if part["leaf"] == "ball":
        leaf = Manifold.sphere(part["radius"], segments)
    elif part["leaf"] == "frustum":
        low, high = part["heights"]
        leaf = Manifold.cylinder(high - low, *part["radii"], segments)
        leaf = leaf.translate([0, 0, low])
    else:
        size = [b - a for a, b in zip(part["min"], part["max"])]
        leaf = Manifold.cube(size).translate(part["min"])
    return leaf.transform(part["map"])


if sys.argv[1] == "version":
    print(version("manifold3d"))
else:
    with open(sys.argv[1]) as file:
        tree = json.load(file)
    start = time.process_time()
    volume = build(tree, int(sys.argv[2])).volume()
    print(time.process_time() - start, volume)
