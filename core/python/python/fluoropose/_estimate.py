"""The pose of an implant in one image, or in many at once."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _native
from ._alike import Alike
from ._camera import Camera
from ._model import Model
from ._native import VERSION
from ._poses import Pose, Poses, rows
from ._track import Click, Part, follow

METHODS = ("library", "refined", "image")


@dataclass(frozen=True, eq=False)
class Rival(Alike):
    """Another pose that explains the image."""

    pose: Pose
    misfit: float
    """What remains: pixels between outlines, or unmatched pixels with the method library."""


@dataclass(frozen=True, eq=False)
class Estimate(Alike):
    """The pose of an implant in an image, and how far it is to be trusted."""

    pose: Pose
    """NaN where nothing was found."""
    sd: Pose
    """One standard deviation of each number; NaN where it is not known."""
    covariance: NDArray[np.float64] = field(repr=False)
    """(6, 6): of a rotation about the middle of the model (radians) and a shift (mm), both in camera axes; NaN where it is not known."""
    status: str
    """good, doubtful or none."""
    because: str
    """Why, in a sentence."""
    decided_by: str
    """What decided for this pose against its rivals."""
    residual_px: float
    """What remains between the outlines, pixels; NaN with the method library."""
    offset_px: float
    """How far the edges lie beyond the model's outline, where `edge_offset` asked for that; pixels."""
    rivals: tuple[Rival, ...] = field(repr=False)
    """The other poses that explain the image, best first."""
    specks: int
    """Pixels of the mask that were left out as specks."""
    film: str | None = field(repr=False)
    """What the frames tell of their film, with the method image."""
    remarks: tuple[str, ...]
    """What has to be known of the model and the camera: units, a shape that is the other component's, a calibration that does not fit the
    frames. Told as warnings too."""
    version: str
    settings: Mapping[str, Any] = field(repr=False)

    def __bool__(self) -> bool:
        """Whether there is a pose."""
        return bool(self.pose)


def estimate(
    mask: ArrayLike | None,
    model: Model,
    camera: Camera,
    *,
    frame: ArrayLike | None = None,
    click: tuple[float, float] | None = None,
    unknown: ArrayLike | None = None,
    method: str | None = None,
    library: _checks.PathLike | None = None,
    nominal: tuple[float, float] | None = None,
    distance_mm: float | None = None,
    metal: str | None = None,
    edge_offset: bool = False,
    role: str | None = None,
    beside: ArrayLike | Pose | None = None,
    beside_model: Model | None = None,
) -> Estimate:
    """The pose of an implant in one image.

    `mask` (rows, columns) is set where the implant is; with a `frame` too, the pose is brought onto the frame's edges. Without a
    mask the implant is looked for in the `frame`, at `click` (column, row) or everywhere. What `unknown` sets says nothing. The other
    arguments are those of `estimate_all`.
    """
    if mask is not None:
        if click is not None:
            raise ValueError("click is for a frame without a mask")
        _checks.instance(camera, Camera, "camera")
        pixels = _checks.masks(mask, 2, "mask")
        camera.check(pixels.shape[1], pixels.shape[0], "mask")
        if method == "image" and frame is None:
            raise ValueError("frame must be given for the method image")
        of_its_size = [("frame", None if frame is None else _checks.frame(frame, "frame"))]
        of_its_size += [("unknown", None if unknown is None else _checks.masks(unknown, 2, "unknown"))]
        for name, other in of_its_size:
            if other is not None and other.shape != pixels.shape:
                raise ValueError(f"{name} must have the shape of the mask, {pixels.shape}, not {other.shape}")
        return estimate_all(
            pixels[None],
            model,
            camera,
            frames=None if frame is None else [frame],
            unknown=None if unknown is None else _checks.masks(unknown, 2, "unknown")[None],
            method=method,
            library=library,
            nominal=nominal,
            distance_mm=distance_mm,
            metal=metal,
            edge_offset=edge_offset,
            role=role,
            beside=beside,
            beside_model=beside_model,
        )[0]
    if frame is None:
        raise TypeError("mask or frame must be given")
    told = {
        "unknown": unknown,
        "method": method,
        "library": library,
        "beside": beside,
        "beside_model": beside_model,
    }
    for name, value in told.items():
        if value is not None:
            raise ValueError(f"{name} needs a mask")
    if edge_offset:
        raise ValueError("edge_offset needs a mask")
    return _on_frame(frame, model, camera, click, nominal, distance_mm, metal, role)


def estimate_all(
    masks: ArrayLike,
    model: Model,
    camera: Camera,
    *,
    frames: Sequence[ArrayLike] | NDArray[Any] | None = None,
    unknown: ArrayLike | None = None,
    method: str | None = None,
    library: _checks.PathLike | None = None,
    nominal: tuple[float, float] | None = None,
    distance_mm: float | None = None,
    metal: str | None = None,
    edge_offset: bool = False,
    role: str | None = None,
    beside: ArrayLike | Poses | Pose | _checks.PathLike | None = None,
    beside_model: Model | None = None,
) -> tuple[Estimate, ...]:
    """The pose of an implant in each of the `masks` (frames, rows, columns) of a film, all of them chosen together.

    `method` is library, refined (the model's outline brought onto the mask's; the default) or image (onto the edges of `frames`; the
    default where they are given). A `library` that the command wrote is read; otherwise one is built and kept with the model: of all
    views, or about the `nominal` one (degrees about x and y), at `distance_mm`. `metal` is dark or bright where the frames do not tell it.
    `role` (femur or tibia) with the other component's poses `beside` tells mirrored poses apart; of a model that has the other
    component's shape all poses are doubtful.
    """
    _checks.instance(model, Model, "model")
    _checks.instance(camera, Camera, "camera")
    pixels = _checks.masks(masks, 3, "masks")
    count, height, width = pixels.shape
    camera.check(width, height, "masks")
    hidden = None if unknown is None else _checks.masks(unknown, 3, "unknown")
    if hidden is not None and hidden.shape != pixels.shape:
        raise ValueError(f"unknown must have the shape of the masks, {pixels.shape}, not {hidden.shape}")
    grey = None
    if frames is not None:
        if _checks.is_path(frames):
            _checks.pixels(frames, False, "frames")  # type: ignore[arg-type]
        grey = [_checks.frame(one, "frames") for one in frames]
        if len(grey) != count or any(one.shape != (height, width) for one in grey):
            raise ValueError(f"frames must be {count} of {height} x {width} pixels, as the masks")
    chosen = method or ("refined" if grey is None else "image")
    _checks.choice(chosen, METHODS, "method")
    if chosen == "image" and grey is None:
        raise ValueError("frames must be given for the method image")
    for name, value in (("nominal", nominal), ("distance_mm", distance_mm)):
        if library is not None and value is not None:
            raise ValueError(f"{name} tells which views are rendered, and library has its own: give one of them")
    other = _other(role, beside, beside_model, count)
    remarks = (*camera.seen(width, height), *model.seen("model", role))
    if beside_model is not None:
        remarks += tuple(beside_model.seen("beside_model", "tibia" if role == "femur" else "femur"))
    answers = _native.estimate(
        model._handle,
        camera._calibration,
        pixels,
        unknown=hidden,
        frames=grey,
        method=chosen,
        library=None if library is None else _checks.path(library, "library"),
        nominal=_nominal(nominal),
        distance_mm=_checks.positive(distance_mm, "distance_mm"),
        bright=_checks.bright(metal),
        edge_offset=bool(edge_offset),
        other=other,
        doubt=None if role is None else model._handle.doubt(role),
    )
    settings = {
        "method": chosen,
        "library": None if library is None else str(library),
        "nominal": nominal,
        "distance_mm": distance_mm,
        "metal": metal,
        "edge_offset": bool(edge_offset),
        "role": role,
        "model": model.digest,
        "camera": camera.text,
    }
    return tuple(_answer(answer, remarks, settings) for answer in answers)


def _nominal(value: tuple[float, float] | None) -> tuple[float, float] | None:
    """A nominal view about which a library can be rendered."""
    two = _checks.pair(value, "nominal")
    # Of the window about it, up to 15 and 20 degrees beside it, within what a library reaches, 89 and 360.
    if two is not None and (abs(two[0]) > 74 or abs(two[1]) > 340):
        raise ValueError(f"nominal must be from -74 to 74 degrees about x and from -340 to 340 about y, not {two}")
    return two


def _other(
    role: str | None,
    beside: ArrayLike | Poses | Pose | _checks.PathLike | None,
    beside_model: Model | None,
    count: int,
) -> tuple[str, NDArray[np.float64], _native.Model | None] | None:
    if role is not None:
        _checks.choice(role, ("femur", "tibia"), "role")
    if beside is None:
        if beside_model is not None:
            raise ValueError("beside_model needs the poses beside")
        return None
    if role is None:
        raise ValueError("role must be given with beside")
    poses = rows(beside, "beside")
    if len(poses) != count:
        raise ValueError(f"beside must have a row for each of {count} masks, not {len(poses)}")
    if beside_model is not None:
        _checks.instance(beside_model, Model, "beside_model")
    return role, poses, None if beside_model is None else beside_model._handle


def _number(value: float | None) -> float:
    return float("nan") if value is None else value


def _answer(answer: _native.Answer, remarks: tuple[str, ...], settings: Mapping[str, Any]) -> Estimate:
    covariance = answer["covariance"]
    return Estimate(
        pose=Pose(*answer["pose"]),
        sd=Pose(*answer["sd"]),
        covariance=np.full((6, 6), np.nan) if covariance is None else np.reshape(covariance, (6, 6)),
        status=answer["verdict"],
        because=answer["because"],
        decided_by=answer["decided_by"],
        residual_px=_number(answer["residual_px"]),
        offset_px=_number(answer["offset_px"]),
        rivals=tuple(Rival(Pose(*pose), misfit) for pose, misfit in answer["rivals"]),
        specks=answer["specks"],
        film=answer["film"],
        remarks=remarks,
        version=VERSION,
        settings=settings,
    )


def _on_frame(
    frame: ArrayLike,
    model: Model,
    camera: Camera,
    click: tuple[float, float] | None,
    nominal: tuple[float, float] | None,
    distance_mm: float | None,
    metal: str | None,
    role: str | None,
) -> Estimate:
    """A film of one frame."""
    _checks.instance(model, Model, "model")
    _checks.instance(camera, Camera, "camera")
    if role is not None:
        _checks.choice(role, ("femur", "tibia"), "role")
    grey = _checks.frame(frame, "frame")
    camera.check(grey.shape[1], grey.shape[0], "frame")
    part = Part(role or "implant", model, None, _nominal(nominal), _checks.positive(distance_mm, "distance_mm"))
    place = None if click is None else _checks.pair(click, "click")
    clicks = {} if place is None else {"click": Click(part.name, 0, place[0], place[1])}
    remarks = (*camera.seen(grey.shape[1], grey.shape[0]), *model.seen("model", role))
    with tempfile.TemporaryDirectory(prefix="fluoropose-", ignore_cleanup_errors=True) as folder:
        found = follow([grey], [part], camera, folder, clicks=clicks, metal=metal)[0]
    settings = {
        "click": place,
        "nominal": part.nominal,
        "distance_mm": part.distance_mm,
        "metal": metal,
        "role": role,
        "model": model.digest,
        "camera": camera.text,
    }
    return Estimate(
        pose=found[0],
        sd=Pose(*map(float, found.sd[0])),
        covariance=found.covariance[0],
        status=found.verdict[0],
        because=found.because[0],
        decided_by="",
        residual_px=float(found.misfit_px[0]),
        offset_px=float("nan"),
        rivals=(),
        specks=0,
        film=None,
        remarks=remarks,
        version=VERSION,
        settings=settings,
    )
