"""Reads what `cargo xtask report --fps ... --out DIR` writes, with no code of fluoropose.

    python3 tests/golden/joint_files.py DIR [--field-axes]

Python's own library is enough; `spm1d`, where it is installed, must take the matrix. --field-axes: the models' files are in the field's axes, so
that the angle between the poses of joint.tra is the flexion of joint.csv. The test of the verb `report` runs it where there is a `python3`. With
spm1d 0.4 from the registry it was run on the reports of two real studies.
"""

import csv
import math
import sys

folder = sys.argv[1]


def text(name):
    return open(f"{folder}/{name}", encoding="utf-8").read()


def same(a, b, within=0.0):
    return abs(a - b) <= within or (math.isnan(a) and math.isnan(b))


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(len(b))) for j in range(len(b[0]))] for i in range(len(a))]


def turn(axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = [[float(row == column) for column in range(3)] for row in range(3)]
    matrix[i][i] = matrix[j][j] = c
    matrix[i][j], matrix[j][i] = -s, s
    return matrix


# joint.csv: the heading in comments, NaN where there is no number.
table = list(csv.DictReader(line for line in text("joint.csv").splitlines() if not line.startswith("#")))
flexion = [float(row["flexion_deg"]) for row in table]
there = [not math.isnan(value) for value in flexion]
assert any(there)

# joint.mot: OpenSim's heading, time first.
heading, body = text("joint.mot").split("endheader\n")
stated = dict(line.split("=") for line in heading.splitlines() if "=" in line and not line.startswith("#"))
names, *rows = [line.split("\t") for line in body.strip().splitlines()]
assert (len(rows), len(names)) == (int(stated["nRows"]), int(stated["nColumns"])) and stated["inDegrees"] == "yes"
assert names[0] == "time" and len(rows) == len(table)
for row, known in zip(rows, table):
    assert same(float(row[0]), float(known["time_s"]))
    assert all(same(float(value), float(known[name])) for name, value in zip(names[1:], row[1:])), row

# joint.tra: 16 numbers for each body, a row a frame, NaN in all of a missing one.
bodies = []
for line in text("joint.tra").splitlines():
    numbers = [float(field) for field in line.split(",")]
    assert len(numbers) == 32
    matrices = [[numbers[16 * body + 4 * row : 16 * body + 4 * row + 4] for row in range(4)] for body in range(2)]
    bodies.append([None if math.isnan(matrix[0][0]) else matrix for matrix in matrices])
assert [all(both) for both in bodies] == there

# The .jtak files: Z, X and Y rotation one after the other make the same matrices.
for at, name in enumerate(["femur", "tibia"]):
    first, _, *lines = text(f"{name}.jtak").splitlines()
    assert first == "JTA_EULER_KINEMATICS" and len(lines) == len(bodies)
    for line, both in zip(lines, bodies):
        assert line.startswith("NOT_OPTIMIZED") == (both[at] is None)
        if both[at] is None:
            continue
        x, y, z, z_rot, x_rot, y_rot = [float(field) for field in line.replace("\t", "").rstrip(",").split(",")]
        rotation = product(product(turn("z", z_rot), turn("x", x_rot)), turn("y", y_rot))
        for row, place in enumerate([x, y, z]):
            assert same(both[at][row][3], place, 1e-9)
            assert all(same(both[at][row][column], rotation[row][column], 1e-9) for column in range(3))
        assert both[at][3] == [0, 0, 0, 1]

if "--field-axes" in sys.argv:
    for (femur, tibia), value in zip(bodies, flexion):
        if femur and tibia:
            turned = [[sum(femur[k][i] * tibia[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
            assert same(abs(math.degrees(math.atan2(-turned[0][1], turned[1][1]))), abs(value), 1e-6)

# 101 points from the first frame with a number to the last, linear between.
matrix = [[float(field) for field in line.split(",")] for line in text("cycle/flexion_deg.csv").splitlines() if not line.startswith("#")]
assert len(matrix) == 1 and len(matrix[0]) == 101
first, last = there.index(True), len(there) - 1 - there[::-1].index(True)
for point, value in enumerate(matrix[0]):
    place = first + (last - first) * point / 100
    below = min(int(place + 1e-9), last - 1)
    part = place - below
    wanted = flexion[below] if part < 1e-9 else flexion[below] + part * (flexion[below + 1] - flexion[below])
    assert same(value, wanted, 1e-9), (point, value, wanted)

try:
    import numpy
    import spm1d
except ImportError:
    print("read; spm1d is not installed")
else:
    known = numpy.nan_to_num(numpy.array(matrix), nan=0.0)
    noise = numpy.random.default_rng(0).normal(size=(6, 101))
    inference = spm1d.stats.ttest(known + numpy.cumsum(noise, axis=1), known.mean()).inference(0.05)
    assert inference.z.shape == (101,)
    print("read; spm1d takes the matrix")
