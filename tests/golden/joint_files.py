"""Reads what `cargo xtask report --fps ... --out DIR` writes, with no code of fluoropose: the csv module, numpy, scipy and spm1d.

    python tests/golden/joint_files.py DIR

Not part of the suite, whose machines need no Python packages. Run with numpy 2.4.6, scipy 1.17.1 and spm1d from the registry on the
reports of two real studies: joint.mot has the numbers of joint.csv, the .jtak files those of joint.tra to 1e-15, and spm1d takes the matrix.
Of the study whose files are in the field's axes, the angle of the poses in joint.tra is the flexion of joint.csv to 1e-13.
"""

import csv
import sys

import numpy as np
import spm1d
from scipy.spatial.transform import Rotation

folder = sys.argv[1]
lines = [line for line in open(f"{folder}/joint.csv") if not line.startswith("#")]
flexion = np.array([float(row["flexion_deg"]) for row in csv.DictReader(lines)])

heading, body = open(f"{folder}/joint.mot").read().split("endheader\n")
stated = dict(line.split("=") for line in heading.splitlines() if "=" in line and not line.startswith("#"))
names, *rows = [line.split("\t") for line in body.strip().splitlines()]
motion = np.array(rows, float)
assert motion.shape == (int(stated["nRows"]), int(stated["nColumns"])) and names[0] == "time"
assert np.array_equal(motion[:, names.index("flexion_deg")], flexion, equal_nan=True)

bodies = np.loadtxt(f"{folder}/joint.tra", delimiter=",")
bodies = bodies.reshape(len(bodies), -1, 4, 4)
there = np.isfinite(bodies).all((1, 2, 3))
relative = np.linalg.inv(bodies[there, 0]) @ bodies[there, 1]
angle = Rotation.from_matrix(relative[:, :3, :3]).as_euler("ZXY", degrees=True)[:, 0]
print("flexion of joint.tra against joint.csv (alike where files are in the field's axes):", np.abs(np.abs(angle) - np.abs(flexion[there])).max())

kept = open(f"{folder}/femur.jtak").read().splitlines()
assert kept[0] == "JTA_EULER_KINEMATICS"
found = [line.replace("\t", "").rstrip(",") for line in kept[2:] if not line.startswith("NOT_OPTIMIZED")]
six = np.array([[float(number) for number in line.split(",")] for line in found])
rotation = Rotation.from_euler("ZXY", six[:, 3:], degrees=True).as_matrix()
posed = np.isfinite(bodies[:, 0]).all((1, 2))
print("femur.jtak against joint.tra:", np.abs(rotation - bodies[posed, 0, :3, :3]).max())

matrix = np.loadtxt(f"{folder}/cycle/flexion_deg.csv", delimiter=",", ndmin=2)
assert matrix.shape == (1, 101)
trials = np.vstack([matrix + k + 0.3 * np.random.default_rng(k).normal(size=101) for k in range(6)])
inference = spm1d.stats.ttest(trials, matrix.mean()).inference(0.05)
print("spm1d takes the matrix:", inference.z.shape)
