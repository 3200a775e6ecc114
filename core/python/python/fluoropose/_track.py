"""Both components of a knee through a film."""

from __future__ import annotations

import filecmp
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _native
from ._alike import Alike
from ._camera import Camera
from ._frames import size_in
from ._kinematics import Kinematics, kinematics
from ._model import Model
from ._native import VERSION
from ._poses import Pose, Poses, rows

Frames = _checks.PathLike | NDArray[Any] | Iterable[Any]
"""A folder, an array (frames, rows, columns), or an iterable of paths or of arrays (rows, columns)."""

Progress = Callable[[int, int, str], object]
"""Called with how many frames of components were looked at, of how many, and what was just done."""


@dataclass(frozen=True)
class Click:
    """A place inside a component: its name, the frame from 0, column and row in pixels."""

    component: str
    frame: int
    column: float
    row: float


@dataclass(frozen=True, eq=False)
class Part(Alike):
    """A component as it is looked for."""

    name: str
    model: Model
    axes: str | None = None
    nominal: tuple[float, float] | None = None
    distance_mm: float | None = None


@dataclass(frozen=True, eq=False)
class Track(Alike):
    """The components of a knee in every frame of a film."""

    femur: Poses | None
    tibia: Poses | None
    side: str
    fps: float | None
    version: str
    settings: Mapping[str, Any] = field(repr=False)
    remarks: tuple[str, ...]
    """What has to be known of models and camera: units, models that look swapped, a calibration that does not fit the frames. Told as
    warnings too."""
    _models: Mapping[str, Part] = field(repr=False)

    def __len__(self) -> int:
        return len(self.femur or self.tibia or ())

    def to_jts(self, folder: _checks.PathLike) -> None:
        """Writes femur.jts and tibia.jts."""
        to = Path(_checks.path(folder, "folder"))
        to.mkdir(parents=True, exist_ok=True)
        for poses in (self.femur, self.tibia):
            if poses is not None:
                poses.to_jts(to / f"{poses.name}.jts")

    def kinematics(self, *, cutoff_hz: float | None = None, name: str = "film") -> Kinematics:
        """How the joint moves; frames that are not good are told and left out of means."""
        if self.femur is None or self.tibia is None:
            raise ValueError("kinematics needs both components")
        femur, tibia = self._models["femur"], self._models["tibia"]
        return kinematics(
            self.femur,
            self.tibia,
            femur_model=femur.model,
            tibia_model=tibia.model,
            side=self.side,
            fps=self.fps,
            cutoff_hz=cutoff_hz,
            femur_axes=femur.axes,
            tibia_axes=tibia.axes,
            name=name,
        )


def track(
    frames: Frames,
    femur: Model | None,
    tibia: Model | None,
    camera: Camera,
    side: str,
    fps: float | None = None,
    *,
    fixed: Mapping[str, ArrayLike | Poses | _checks.PathLike] | None = None,
    clicks: Sequence[Click] = (),
    femur_axes: str | None = None,
    tibia_axes: str | None = None,
    metal: str | None = None,
    interpolate: int = 0,
    out: _checks.PathLike | None = None,
    anew: bool = False,
    progress: Progress | None = None,
) -> Track:
    """Follows both components of a knee through a film.

    `frames` are a folder, an array (frames, rows, columns) of 8 or 16 bits, or an iterable of paths or of arrays, of which one at a
    time is in memory. `fixed` poses (a row a frame, NaN where there is none, by femur and tibia) never change. `out` keeps the film as
    a study that the command `fluoropose track` reads too, with what was done after every frame: a call that was broken off goes on there.
    `progress` (as `print`) is called on the caller's thread with every step: how many frames of components were looked at, of how many, and
    what is done, in the command's words; an exception from it ends the work as Ctrl-C does.
    """
    _checks.instance(camera, Camera, "camera")
    _checks.choice(side, ("left", "right"), "side")
    fps = _checks.positive(fps, "fps")
    parts = []
    for name, model, axes in (("femur", femur, femur_axes), ("tibia", tibia, tibia_axes)):
        if model is not None:
            _checks.instance(model, Model, name)
            parts.append(Part(name, model, axes))
    if not parts:
        raise TypeError("femur or tibia must be given")
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be callable, not {type(progress).__name__}")
    told = [remark for part in parts for remark in part.model.seen(part.name, part.name)]
    if isinstance(interpolate, bool) or not isinstance(interpolate, int) or interpolate < 0:
        raise ValueError("interpolate must be a whole number of frames, 0 or more")
    for number, click in enumerate(clicks):
        _checks.instance(click, Click, f"clicks[{number}]")
        _checks.numbers([click.column, click.row], (2,), f"clicks[{number}]: column and row")
        if _checks.whole(click.frame, f"clicks[{number}]: frame") < 0:
            raise ValueError(f"clicks[{number}]: frame is {click.frame}; frames are counted from 0")
    given = {name: rows(poses, f"fixed[{name!r}]") for name, poses in (fixed or {}).items()}
    for name in [*given, *(click.component for click in clicks)]:
        if name not in [part.name for part in parts]:
            raise ValueError(f"fixed or clicks: there is no component {name!r}")

    def hear(remark: str) -> None:
        if remark not in told:
            told.append(remark)
            _checks.warn([remark] if remark not in camera.remarks else [])

    def run(folder: str) -> list[Poses]:
        return follow(
            frames,
            parts,
            camera,
            folder,
            side=side,
            fps=fps,
            fixed=given,
            clicks={f"clicks[{number}]": click for number, click in enumerate(clicks)},
            metal=metal,
            interpolate=interpolate,
            anew=anew,
            hear=hear,
            progress=progress,
        )

    if out is None:
        with tempfile.TemporaryDirectory(prefix="fluoropose-", ignore_cleanup_errors=True) as folder:
            found = run(folder)
    else:
        found = run(_checks.path(out, "out"))
    by_name = {poses.name: poses for poses in found}
    return Track(
        femur=by_name.get("femur"),
        tibia=by_name.get("tibia"),
        side=side,
        fps=fps,
        version=VERSION,
        settings={
            "models": {part.name: part.model.digest for part in parts},
            "camera": camera.text,
            "fixed": sorted(given),
            "clicks": tuple(clicks),
            "metal": metal,
            "interpolate": interpolate,
        },
        remarks=tuple(told),
        _models={part.name: part for part in parts},
    )


def follow(
    frames: Frames,
    parts: Sequence[Part],
    camera: Camera,
    folder: str,
    *,
    side: str = "left",
    fps: float | None = None,
    fixed: Mapping[str, NDArray[np.float64]] | None = None,
    clicks: Mapping[str, Click] | None = None,
    metal: str | None = None,
    interpolate: int = 0,
    anew: bool = False,
    hear: Callable[[str], object] = lambda _: None,
    progress: Progress | None = None,
) -> list[Poses]:
    """Makes a study of what is given and follows its components, as the command does, which tells `hear` what has to be known. Clicks
    stand by what they are called."""
    place = Path(folder)
    with _checks.argument("out"):
        place.mkdir(parents=True, exist_ok=True)
    begun = place / ".begun"
    shutil.rmtree(begun, ignore_errors=True)
    begun.mkdir()
    try:
        size = size_in(_write_study(frames, parts, camera, begun, side=side, fps=fps))
        if size is not None:
            camera.check(*size, "frames")
            for remark in camera.others(*size):
                hear(remark)
        # What is there stays as it is where it is of something else.
        if not anew and (place / "journal.txt").exists() and not _are_alike(begun, place):
            raise ValueError(
                f"out: {place} holds what was found with other frames, models or calibration: "
                "name another folder, or say anew=True"
            )
        _replace(begun, place)
    finally:
        shutil.rmtree(begun, ignore_errors=True)
    for name, poses in (fixed or {}).items():
        # For the command, with --fixed.
        _native.write_poses(str(place / f"{name}.fixed.jts"), poses)
    found = _native.track(
        str(place / "study.toml"),
        str(place),
        clicks=[
            (click.component, click.frame, float(click.column), float(click.row), called)
            for called, click in (clicks or {}).items()
        ],
        fixed=[(name, poses, f"fixed[{name!r}]") for name, poses in (fixed or {}).items()],
        bright=_checks.bright(metal),
        interpolate=interpolate,
        anew=anew,
        remark=hear,
        progress=progress,
    )
    return [_poses(one) for one in found]


def _write_study(
    frames: Frames, parts: Sequence[Part], camera: Camera, place: Path, *, side: str, fps: float | None
) -> Path:
    """The folder of its frames."""
    (place / "calibration.txt").write_text(camera.text, encoding="utf-8")
    pictures = _frames(frames, camera, place)
    lines = ['name = "film"', f'side = "{side}"', 'calibration = "calibration.txt"', f"frames = {_text(pictures)}"]
    if fps is not None:
        lines.append(f"frames_per_s = {fps!r}")
    for part in parts:
        # As it is in memory, whatever has become of its file since.
        model = f"{part.name}.ply"
        part.model._handle.write(str(place / model))
        lines += ["[[component]]", f"name = {_text(part.name)}", f"model = {_text(model)}"]
        if part.axes is not None:
            lines.append(f"axes = {_text(part.axes)}")
        if part.nominal is not None:
            lines.append(f"nominal = [{part.nominal[0]!r}, {part.nominal[1]!r}]")
        if part.distance_mm is not None:
            lines.append(f"distance_mm = {part.distance_mm!r}")
    (place / "study.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return place / pictures


def _are_alike(begun: Path, place: Path) -> bool:
    """Whether a folder has the frames, models and calibration that another begins with. Side and rate may be stated anew."""
    files = [file.relative_to(begun) for file in begun.rglob("*") if file.is_file()]
    if (begun / "frames").exists() and len(list((begun / "frames").iterdir())) != len(
        list((place / "frames").glob("*"))
    ):
        return False
    return all((place / file).is_file() and _is_alike(begun / file, place / file) for file in files)


def _is_alike(one: Path, other: Path) -> bool:
    if one.name != "study.toml":
        return filecmp.cmp(one, other, shallow=False)
    stated = ("side = ", "frames_per_s = ")
    texts = [file.read_text(encoding="utf-8").splitlines() for file in (one, other)]
    lines = [[line for line in text if not line.startswith(stated)] for text in texts]
    return lines[0] == lines[1]


def _replace(begun: Path, place: Path) -> None:
    for entry in begun.iterdir():
        to = place / entry.name
        if to.is_dir() and not to.is_symlink():
            shutil.rmtree(to)
        os.replace(entry, to)


def _text(value: str) -> str:
    """A string of TOML, of which those of JSON are some."""
    return json.dumps(value)


def _frames(frames: Frames, camera: Camera, place: Path) -> str:
    """The folder that holds the frames, made where they come from elsewhere."""
    if isinstance(frames, (str, os.PathLike)):
        folder = os.path.abspath(_checks.path(frames, "frames"))
        if not os.path.isdir(folder):
            raise FileNotFoundError(f"frames: {folder} is no folder")
        return folder
    if isinstance(frames, np.ndarray) and frames.ndim != 3:
        raise ValueError(f"frames must have the shape (frames, rows, columns), not {frames.shape}")
    if not isinstance(frames, Iterable):
        raise TypeError(f"frames must be a folder, an array or an iterable, not {type(frames).__name__}")
    to = place / "frames"
    to.mkdir()
    size: tuple[int, int] | None = None
    number = 0
    for number, one in zip(count(1), frames):
        if _checks.is_path(one):
            _link(Path(_checks.path(one, "frames")), to, number)
            continue
        pixels = _checks.frame(one, "frames")
        if size is None:
            size = (pixels.shape[0], pixels.shape[1])
            camera.check(size[1], size[0], "frames")
        if pixels.shape != size:
            raise ValueError(f"frames: frame {number - 1} has the shape {pixels.shape} and the first {size}")
        _native.write_frame(str(to / f"{number:06}.png"), pixels)
    if number == 0:
        raise ValueError("frames: there is none")
    return "frames"


def _link(file: Path, to: Path, number: int) -> None:
    """A file under a name that keeps the order."""
    if not file.is_file():
        raise FileNotFoundError(f"frames: {file} is no file")
    name = to / f"{number:06}-{file.name}"
    try:
        name.symlink_to(file.resolve())
    except OSError:
        shutil.copyfile(file, name)


def _poses(found: _native.Followed) -> Poses:
    length = len(found["pose"])
    return Poses(
        name=found["name"],
        pose=found["pose"],
        sd=found["sd"],
        covariance=np.reshape(found["covariance"], (length, 6, 6)),
        film_steps=np.reshape(found["film_steps"], (length, 2, 6)),
        state=tuple(found["state"]),
        verdict=tuple(found["verdict"]),
        because=tuple(found["because"]),
        misfit_px=np.array([np.nan if px is None else px for px in found["misfit_px"]]),
        badness=np.array(found["badness"]),
    )


__all__ = ["Click", "Part", "Pose", "Track", "follow", "track"]
