"""A program as a type checker sees it: what is read has the type that is written here."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

import fluoropose as fp


def poses(masks: NDArray[np.bool_], model: fp.Model, camera: fp.Camera) -> list[tuple[str, float]]:
    found: tuple[fp.Estimate, ...] = fp.estimate_all(masks, model, camera)
    return [(one.status, one.pose.z_mm) for one in found]


def film(frames: Iterator[NDArray[np.uint16]], femur: fp.Model, tibia: fp.Model) -> NDArray[np.float64]:
    camera = fp.Camera([[3000.0, 0.0, 511.5], [0.0, 3000.0, 511.5], [0.0, 0.0, 1.0]], (1024, 1024))
    tracked = fp.track(frames, femur, tibia, camera, "left", 15.0, fixed={"femur": "femur.jts"}, progress=print)
    told: tuple[str, ...] = camera.remarks + tracked.remarks
    if told:
        raise SystemExit(told[0])
    poses: fp.Poses | None = tracked.femur
    if poses is None:
        raise SystemExit
    matrix: NDArray[np.float64] = poses[0].matrix
    joint: fp.Kinematics = tracked.kinematics(cutoff_hz=3.0)
    steps: NDArray[np.float64] = joint.by_flexion["internal_rotation_deg"]
    return np.concatenate([matrix[0], steps])
