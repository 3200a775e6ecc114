"""Cases of joint numbers by another program: numpy and scipy, no code of fluoropose. Made with numpy 2.4.6 and scipy 1.17.1 by

    cargo xtask models --side left --out LEFT && cargo xtask models --side right --out RIGHT
    python tests/golden/joint.py LEFT RIGHT > tests/golden/joint.csv

`tests/tests/all/joint.rs` reads the table. Rows: a kind, then numbers.
"""

import sys

import numpy as np
from scipy.optimize import least_squares
from scipy.signal import butter, filtfilt
from scipy.spatial.transform import Rotation

RANDOM = np.random.default_rng(17)
CAP = 0.1  # mm
FEMUR_SD = np.array([0.004, 0.005, 0.003, 0.1, 0.1, 2.0])  # turns in radians, shifts in mm, camera axes
TIBIA_SD = np.array([0.006, 0.003, 0.004, 0.1, 0.2, 3.0])
COMMON = (np.array([0.001, 0, 0, 0, 0, 3.0]), np.array([0, 0.001, 0, 0, 0, 4.0]))


def row(kind, *numbers):
    flat = np.concatenate([np.atleast_1d(np.asarray(n, float)).ravel() for n in numbers])
    print(kind, *("%.9g" % n for n in flat), sep=",")


def read_stl(path):
    data = open(path, "rb").read()
    count = int.from_bytes(data[80:84], "little")
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    return np.frombuffer(data[84:], kind, count)["corners"].astype(float)


def matrix(six):
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_euler("ZXY", six[3:], degrees=True).as_matrix()
    pose[:3, 3] = six[:3]
    return pose


class Knee:
    """In the file's axes: x anterior in a left knee and posterior in a right one, y superior, z medial."""

    def __init__(self, folder, left):
        self.left, self.forward = left, 1.0 if left else -1.0
        self.femur, tibia = (read_stl(f"{folder}/{name}.stl") for name in ("femur", "tibia"))
        middle = lambda faces: (faces.reshape(-1, 3).min(0) + faces.reshape(-1, 3).max(0)) / 2
        self.femur_middle, self.tibia_middle = middle(self.femur), middle(tibia)
        # The plate's upper side: of faces that look straight up, the level with the largest area.
        doubled = np.cross(tibia[:, 1] - tibia[:, 0], tibia[:, 2] - tibia[:, 0])
        up = doubled[:, 1] > 0.999 * np.linalg.norm(doubled, axis=1)
        heights = tibia[up, :, 1].mean(1)
        levels = np.round(heights, 2)
        areas = {level: doubled[up][levels == level, 1].sum() for level in set(levels)}
        self.level = heights[levels == max(areas, key=areas.get)].mean()
        corners = tibia.reshape(-1, 3)
        reach = corners[:, 1].max() - corners[:, 1].min()
        plate = corners[corners[:, 1] >= self.level - 0.12 * reach]
        low, high = plate.min(0), plate.max(0)
        self.origin = np.array([(low[0] + high[0]) / 2, self.level, (low[2] + high[2]) / 2])
        self.depth = high[0] - low[0]
        z = self.femur.reshape(-1, 3)[:, 2]
        self.split = (z.min() + z.max()) / 2

    def lowest(self, tibia_from_femur, medial):
        half = (self.femur[:, :, 2].mean(1) >= self.split) == medial
        faces = self.femur[half] @ tibia_from_femur[:3, :3].T + tibia_from_femur[:3, 3] - self.origin
        height = faces[:, :, 1].min()
        area, moment = 0.0, np.zeros(3)
        for face in faces[faces[:, :, 1].min(1) < height + CAP]:
            inside = []
            for a, b in zip(face, np.roll(face, -1, axis=0)):
                if a[1] < height + CAP:
                    inside.append(a)
                if (a[1] < height + CAP) != (b[1] < height + CAP):
                    inside.append(a + (b - a) * (height + CAP - a[1]) / (b[1] - a[1]))
            for b, c in zip(inside[1:], inside[2:]):
                part = np.linalg.norm(np.cross(b - inside[0], c - inside[0]))
                area, moment = area + part, moment + part * (inside[0] + b + c) / 3
        return self.forward * moment[0] / area, moment[2] / area, height

    def numbers(self, femur, tibia):
        relative = np.linalg.inv(femur) @ tibia
        r, t = relative[:3, :3], relative[:3, 3]
        z, x, y = Rotation.from_matrix(r).as_euler("ZXY", degrees=True)
        moved = -r.T @ t
        medial_axis, long_axis = np.array([0, 0, 1.0]), r[:, 1]
        floating = np.cross(long_axis, medial_axis)
        floating *= self.forward / np.linalg.norm(floating)
        back = np.linalg.inv(relative)
        m, l = self.lowest(back, True), self.lowest(back, False)
        percent = lambda ap: 50 + 100 * ap / self.depth
        return np.array(
            [self.forward * moved[0], moved[1], moved[2], -self.forward * z, x, -self.forward * y]
            + [-t @ medial_axis, t @ floating, -t @ long_axis]
            + [m[0], l[0], percent(m[0]), percent(l[0]), m[1], l[1], m[2], l[2], l[2] - m[2]]
        )

    def deviations(self, femur, tibia):
        slopes = []
        for which, middle in ((0, self.femur_middle), (1, self.tibia_middle)):
            for k in range(6):
                size = 2e-3 if k < 3 else 0.02
                ends = []
                for sign in (1, -1):
                    poses = [femur, tibia]
                    poses[which] = moved(poses[which], middle, k, sign * size)
                    ends.append(self.numbers(*poses))
                slopes.append((ends[0] - ends[1]) / (2 * size))
        joined = np.concatenate(COMMON)
        covariance = np.diag(np.concatenate([FEMUR_SD, TIBIA_SD]) ** 2) + np.outer(joined, joined)
        slopes = np.array(slopes)
        return np.sqrt(np.diag(slopes.T @ covariance @ slopes))


def moved(pose, middle, k, size):
    step = np.zeros(6)
    step[k] = size
    result = pose.copy()
    result[:3, :3] = Rotation.from_rotvec(step[:3]).as_matrix() @ pose[:3, :3]
    place = pose[:3, :3] @ middle + pose[:3, 3] + step[3:]
    result[:3, 3] = place - result[:3, :3] @ middle
    return result


def frames(folder, left):
    knee = Knee(folder, left)
    for flexion in np.linspace(-5, 118, 14):
        camera = matrix([*RANDOM.uniform(-20, 20, 2), -RANDOM.uniform(800, 1100), *RANDOM.uniform(-40, 40, 3)])
        turn = 1.0 if left else -1.0
        bent = [RANDOM.uniform(-5, 5), 32, RANDOM.uniform(-3, 3)]
        turns = [turn * flexion, RANDOM.uniform(-4, 4), turn * RANDOM.uniform(-12, 12)]
        poses = [camera @ matrix([*bent, *turns]), camera]
        euler = [[*p[:3, 3], *Rotation.from_matrix(p[:3, :3]).as_euler("ZXY", degrees=True)] for p in poses]
        poses = [matrix(np.round(e, 6)) for e in euler]
        row("frame", left, np.round(euler[0], 6), np.round(euler[1], 6), knee.numbers(*poses), knee.deviations(*poses))


def filters():
    for n, cutoff, rate in ((60, 3.0, 30.0), (25, 6.0, 15.0), (8, 1.0, 30.0), (200, 0.7, 7.5)):
        raw = np.round(np.cumsum(RANDOM.normal(size=n)), 6)
        wanted = np.tan(np.pi * cutoff / rate) / (np.sqrt(2) - 1) ** 0.25
        b, a = butter(2, 2 / np.pi * np.arctan(wanted))
        beyond = int(3 * rate / cutoff)
        # Of a run that is shorter than that the line through both ends passes as it is.
        line = np.linspace(raw[0], raw[-1], n) if n - 1 < beyond else np.zeros(n)
        row("filter", cutoff, rate, raw, line + filtfilt(b, a, raw - line, padlen=min(n - 1, beyond)))


def pivots():
    for n, degrees, place in ((20, 15.0, (-5.0, 18.0)), (40, 8.0, (3.0, -30.0)), (12, 25.0, (0.0, 0.0))):
        turns = np.radians(np.linspace(-degrees / 2, degrees / 2, n))
        across = np.array([24.0, -24.0])[:, None] - place[1]
        ends = np.stack([place[0] + across * np.sin(turns), place[1] + across * np.cos(turns)], axis=-1)
        ends = np.round(ends + RANDOM.normal(scale=0.4, size=ends.shape), 6)

        def misses(c):
            along, off = ends[1] - ends[0], c - ends[0]
            squared = (along**2).sum(1)
            t = (along * off).sum(1) / squared
            return (along[:, 0] * off[:, 1] - along[:, 1] * off[:, 0]) / np.sqrt(squared * ((1 - t) ** 2 + t**2))

        fit = least_squares(misses, ends.reshape(-1, 2).mean(0), xtol=1e-14, ftol=1e-14, gtol=1e-14)
        covariance = np.linalg.inv(fit.jac.T @ fit.jac) * (fit.fun**2).sum() / (n - 2)
        row("pivot", ends.transpose(1, 0, 2), fit.x, np.sqrt(np.diag(covariance)))


def bins():
    flexion = np.round(np.concatenate([np.sort(RANDOM.uniform(0, 95, 30)), np.sort(RANDOM.uniform(4, 95, 25))[::-1]]), 6)
    values = np.round(flexion / 10 + RANDOM.normal(size=55), 6)
    top = int(np.argmax(flexion))
    for level in range(0, 100, 10):
        parts = ((flexion[: top + 1], values[: top + 1]), (flexion[top:][::-1], values[top:][::-1]))
        met = [np.interp(level, f, v) for f, v in parts if f[0] <= level <= f[-1]]
        if met:
            row("bin", level, len(met), np.mean(met), flexion, values)


frames(sys.argv[1], True)
frames(sys.argv[2], False)
filters()
pivots()
bins()
