"""Poses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _native
from ._alike import Alike

NUMBERS: Final = ("x_mm", "y_mm", "z_mm", "z_rot_deg", "x_rot_deg", "y_rot_deg")
"""The numbers of a pose in the order of all arrays and of `.jts` files."""


@dataclass(frozen=True, eq=False)
class Pose(Alike):
    """Where an implant is: `X_camera = Rz Rx Ry X_model + t`, in the frame of the X-ray source, x right, y up, looking along -z.

    All numbers are NaN where nothing was found. The same numbers with `sd_` meaning: one standard deviation of each.
    """

    x_mm: float
    y_mm: float
    z_mm: float
    z_rot_deg: float
    x_rot_deg: float
    y_rot_deg: float

    @property
    def numbers(self) -> tuple[float, float, float, float, float, float]:
        """The six numbers in the order of `NUMBERS`."""
        return (self.x_mm, self.y_mm, self.z_mm, self.z_rot_deg, self.x_rot_deg, self.y_rot_deg)

    @property
    def matrix(self) -> NDArray[np.float64]:
        """`camera_from_model` (4, 4)."""
        return _native.matrices(np.array([self.numbers])).reshape(4, 4)

    def __bool__(self) -> bool:
        """Whether there is a pose."""
        return bool(np.isfinite(self.numbers).all())


@dataclass(frozen=True, eq=False)
class Poses(Alike):
    """A component in every frame of a film."""

    name: str
    pose: NDArray[np.float64]
    """(frames, 6), in the order of `NUMBERS`; NaN where nothing was found."""
    sd: NDArray[np.float64] = field(repr=False)
    """One standard deviation of each; NaN where it is not known."""
    covariance: NDArray[np.float64] = field(repr=False)
    """(frames, 6, 6): of a rotation about the middle of the model (radians) and a shift (mm), both in camera axes."""
    film_steps: NDArray[np.float64] = field(repr=False)
    """(frames, 2, 6): what one standard deviation of each of the film's constants does to the pose, part of the covariance; in
    all frames of a film it is the same way at once."""
    state: tuple[str, ...] = field(repr=False)
    """fixed, followed, interpolated, doubtful, untrackable or unsolved."""
    verdict: tuple[str, ...] = field(repr=False)
    """good, doubtful or none."""
    because: tuple[str, ...] = field(repr=False)
    """Why, in a sentence."""
    misfit_px: NDArray[np.float64] = field(repr=False)
    """What remains between outline and edges, pixels."""
    badness: NDArray[np.float64] = field(repr=False)
    """How bad it is: above 1 it is doubtful."""

    def __repr__(self) -> str:
        """Short: how many frames are of each state."""
        states = ", ".join(f"{self.state.count(state)} {state}" for state in dict.fromkeys(self.state))
        return f"Poses({self.name!r}, {len(self)} frames: {states})"

    def __len__(self) -> int:
        return len(self.pose)

    def __getitem__(self, frame: int) -> Pose:
        return Pose(*map(float, self.pose[frame]))

    def __iter__(self) -> Iterator[Pose]:
        return (self[frame] for frame in range(len(self)))

    @property
    def matrices(self) -> NDArray[np.float64]:
        """`camera_from_model` of each frame (frames, 4, 4)."""
        return _native.matrices(self.pose)

    def to_jts(self, path: _checks.PathLike) -> None:
        """Writes `JT_EULER_312`, a row a frame."""
        _native.write_poses(_checks.path(path, "path"), self.pose)


def read_poses(path: _checks.PathLike) -> NDArray[np.float64]:
    """Reads `.jts`, `.jtak` or `.jtap`: (frames, 6), NaN for a frame without a pose."""
    return _native.read_poses(_checks.path(path, "path"))


def rows(value: ArrayLike | Poses | Pose | _checks.PathLike, name: str) -> NDArray[np.float64]:
    """Rows of six numbers from all that may stand for poses."""
    if isinstance(value, Poses):
        return value.pose
    if isinstance(value, Pose):
        return np.array([value.numbers])
    if isinstance(value, str) or hasattr(value, "__fspath__"):
        with _checks.argument(name):
            return _native.read_poses(_checks.path(value, name))
    return _checks.numbers(value, (None, 6), name)
