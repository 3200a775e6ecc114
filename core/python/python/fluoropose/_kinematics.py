"""How a knee moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _native
from ._alike import Alike
from ._model import Model
from ._native import VERSION
from ._poses import Poses, rows


@dataclass(frozen=True, eq=False)
class ByFlexion(Alike):
    """Numbers at steps of 10 degrees of flexion, each the mean over the phases that pass it; doubtful frames are in none.

    Steps that no phase passes have no row: a film whose flexion jumps over some, by more than 45 degrees or in doubtful frames, has none there.
    """

    flexion_deg: NDArray[np.float64]
    names: tuple[str, ...]
    mean: NDArray[np.float64]
    """(steps, numbers)."""
    sd: NDArray[np.float64]
    """One standard deviation as carried from the poses."""
    n: NDArray[np.uint64]
    """Phases that pass the step."""

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        """The means of one number."""
        return self.mean[:, _place(self.names, name)]


@dataclass(frozen=True, eq=False)
class Kinematics(Alike):
    """A joint's numbers in every frame of a film; NaN where a component has no pose."""

    name: str
    side: str
    fps: float | None
    cutoff_hz: float | None
    names: tuple[str, ...] = field(repr=False)
    units: tuple[str, ...] = field(repr=False)
    values: NDArray[np.float64] = field(repr=False)
    """(frames, numbers)."""
    sd: NDArray[np.float64] = field(repr=False)
    """One standard deviation of each; NaN where the covariance of a pose is not known."""
    filtered: NDArray[np.float64] | None = field(repr=False)
    """The same numbers of the filtered poses, where a cutoff was given."""
    doubt: tuple[str | None, ...] = field(repr=False)
    """Why each frame is doubtful; None where it is not."""
    axes: tuple[str, str] = field(repr=False)
    """Which of the femoral and of the tibial file's axes point anteriorly, superiorly and to the right, and who says so."""
    remarks: tuple[str, ...]
    """What has to be known of it: numbers that no knee has, models that look swapped, axes that a shape does not tell. Told as warnings too."""
    version: str
    by_flexion: ByFlexion = field(repr=False)
    """The numbers at steps of flexion."""
    _cycles: NDArray[np.float64] = field(repr=False)
    _files: Mapping[str, str | bytes | None] = field(repr=False)
    _figure: _native.Figure = field(repr=False, compare=False)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        """One number in every frame."""
        return self.values[:, _place(self.names, name)]

    def cycle(self, name: str) -> NDArray[np.float64]:
        """A number from the first to the last frame that has it, at 0 to 100 percent (101,): a row for spm1d."""
        return np.array(self._cycles[_place(self.names, name)])

    def to_csv(self, path: _checks.PathLike) -> None:
        """Writes joint.csv; lines that begin with # are its heading."""
        self._write(path, "csv")

    def to_mot(self, path: _checks.PathLike) -> None:
        """Writes OpenSim's `.mot`; it needs `fps`."""
        self._write(path, "mot")

    def to_svg(self, path: _checks.PathLike) -> None:
        """Writes the published figure."""
        self._write(path, "svg")

    def to_pdf(self, path: _checks.PathLike) -> None:
        """Writes the published figure as PDF, 180 mm wide."""
        self._write(path, "pdf")

    def to_png(self, path: _checks.PathLike) -> None:
        """Writes the published figure as PNG, 180 mm wide at 600 dots an inch; it is drawn now."""
        Path(_checks.path(path, "path")).write_bytes(self._figure.png())

    def _write(self, path: _checks.PathLike, kind: str) -> None:
        made = self._files[kind]
        if made is None:
            raise ValueError("fps must be known for a .mot: time is its first column")
        Path(_checks.path(path, "path")).write_bytes(made.encode() if isinstance(made, str) else made)


def kinematics(
    femur: Poses | ArrayLike | _checks.PathLike,
    tibia: Poses | ArrayLike | _checks.PathLike,
    *,
    femur_model: Model,
    tibia_model: Model,
    side: str,
    fps: float | None = None,
    cutoff_hz: float | None = None,
    femur_axes: str | None = None,
    tibia_axes: str | None = None,
    name: str = "film",
) -> Kinematics:
    """How a joint moves, from the poses of both components: arrays (frames, 6), files, or what `track` found, with standard deviations.

    The anatomical axes of each model are told by its shape, or stated as in "x y z": its anterior, superior and right.
    """
    _checks.instance(femur_model, Model, "femur_model")
    _checks.instance(tibia_model, Model, "tibia_model")
    _checks.choice(side, ("left", "right"), "side")
    fps = _checks.positive(fps, "fps")
    cutoff_hz = _checks.positive(cutoff_hz, "cutoff_hz")
    if cutoff_hz is not None and fps is None:
        raise ValueError("fps must be given with cutoff_hz")
    both = rows(femur, "femur"), rows(tibia, "tibia")
    if len(both[0]) != len(both[1]):
        raise ValueError(f"femur has {len(both[0])} frames and tibia {len(both[1])}: both must be of the same film")
    joint = _native.joint(
        (femur_model._handle, both[0], _covariances(femur), femur_axes),
        (tibia_model._handle, both[1], _covariances(tibia), tibia_axes),
        side=side,
        name=name,
        fps=fps,
        cutoff=cutoff_hz,
        doubts=_doubts(femur, tibia),
        judged=isinstance(femur, Poses) and isinstance(tibia, Poses),
    )
    _checks.warn(joint["remarks"])
    steps = joint["by_flexion"]
    names = tuple(joint["names"])
    return Kinematics(
        name=name,
        side=side,
        fps=fps,
        cutoff_hz=cutoff_hz,
        names=names,
        units=tuple(joint["units"]),
        values=joint["values"],
        sd=joint["sd"],
        filtered=None if cutoff_hz is None else joint["filtered"],
        doubt=tuple(joint["doubt"]),
        axes=(joint["axes"][0], joint["axes"][1]),
        remarks=tuple(joint["remarks"]),
        version=VERSION,
        by_flexion=ByFlexion(steps["flexion_deg"], names, steps["mean"], steps["sd"], steps["n"]),
        _cycles=joint["cycles"],
        _files={"csv": joint["csv"], "mot": joint["mot"], "svg": joint["svg"], "pdf": joint["pdf"]},
        _figure=joint["figure"],
    )


def _place(names: tuple[str, ...], name: str) -> int:
    if name not in names:
        raise KeyError(f"{name!r} is none of {', '.join(names)}")
    return names.index(name)


def _covariances(poses: object) -> NDArray[np.float64] | None:
    if not isinstance(poses, Poses):
        return None
    parts = (poses.covariance.reshape(len(poses), 36), poses.film_steps.reshape(len(poses), 12))
    return np.concatenate(parts, axis=1)


def _doubts(*both: object) -> dict[int, str]:
    """Why frames are doubtful, as the command tells it."""
    doubts: dict[int, str] = {}
    for poses in both:
        if not isinstance(poses, Poses):
            continue
        for frame, verdict in enumerate(poses.verdict):
            if verdict != "good":
                why = f"{poses.name} {poses.state[frame]}: {poses.because[frame]}"
                doubts[frame] = f"{doubts[frame]}; {why}" if frame in doubts else why
    return doubts
