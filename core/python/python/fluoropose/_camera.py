"""The camera: where the X-ray source is, seen from the frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from . import _checks
from ._native import Calibration


@dataclass(frozen=True, init=False)
class Camera:
    """A calibrated X-ray camera.

    `K` is its matrix in pixels, whole numbers at pixel centres, and `size` is (columns, rows) of its frames: the convention of
    computer vision and of MayaCam 2.0. Files are read by `from_intcalib` and `from_mayacam`. What is unusual of it is warned of:
    of files that name no frame size when the first frames are seen.
    """

    K: tuple[tuple[float, float, float], ...] | None
    size: tuple[int, int] | None
    remarks: tuple[str, ...] = field(compare=False)
    """What is unusual of it, most often because the calibration is wrong."""
    _calibration: Calibration = field(repr=False, compare=False)
    text: str = field(repr=False)

    def __init__(self, K: ArrayLike, size: tuple[int, int]) -> None:
        matrix = _checks.numbers(K, (3, 3), "K")
        try:
            columns, rows_ = size
        except (TypeError, ValueError) as error:
            raise TypeError("size must be (columns, rows)") from error
        width, height = _checks.whole(columns, "size"), _checks.whole(rows_, "size")
        rows = "\n".join(",".join(repr(float(number)) for number in row) for row in matrix)
        text = f"image size\n{width},{height}\n\ncamera matrix\n{rows}\n"
        with _checks.argument("K or size"):
            calibration = Calibration(text)
        self._set(calibration, matrix.tolist(), (width, height))

    @classmethod
    def from_intcalib(cls, source: _checks.PathLike) -> Camera:
        """Reads a `JT_INTCALIB` file: principal distance, principal point and pitch, mm. It names no frame size."""
        return cls._read(source)

    @classmethod
    def from_mayacam(cls, source: _checks.PathLike) -> Camera:
        """Reads a camera matrix as MayaCam 2.0 writes it."""
        camera = cls._read(source)
        if camera.size is None:
            raise ValueError("source is no file of MayaCam 2.0: it states no image size")
        return camera

    @classmethod
    def _read(cls, source: _checks.PathLike) -> Camera:
        name = _checks.path(source, "source")
        try:
            text = Path(name).read_text(encoding="utf-8-sig")
        except UnicodeDecodeError as error:
            raise ValueError(f"source: {name} is no text, as calibrations are") from error
        with _checks.argument(f"source: {name}"):
            calibration = Calibration(text)
        camera = object.__new__(cls)
        size = calibration.size()
        matrix = None
        if size is not None:
            fx, fy, cx, cy = calibration.camera(*size)
            matrix = [[fx, 0.0, cx - 0.5], [0.0, fy, cy - 0.5], [0.0, 0.0, 1.0]]
        camera._set(calibration, matrix, size)
        return camera

    def _set(
        self, calibration: Calibration, matrix: list[list[float]] | None, size: tuple[int, int] | None
    ) -> None:
        rows = None if matrix is None else tuple((row[0], row[1], row[2]) for row in matrix)
        remarks = () if size is None else tuple(calibration.doubts(*size))
        _checks.warn(remarks)
        for name, value in (
            ("K", rows),
            ("size", size),
            ("remarks", remarks),
            ("_calibration", calibration),
            ("text", calibration.text()),
        ):
            object.__setattr__(self, name, value)

    def check(self, width: int, height: int, name: str) -> None:
        """Raises where frames of this size are not the camera's."""
        if self.size is not None and self.size != (width, height):
            raise ValueError(f"{name}: {width} x {height} pixels, but camera is for {self.size[0]} x {self.size[1]}")

    def seen(self, width: int, height: int) -> list[str]:
        """What is unusual of it for frames of this size; it is warned of where that was not done before."""
        doubts = self._calibration.doubts(width, height)
        if self.size is None:
            _checks.warn(doubts)
        return doubts

    def matrix(self, width: int, height: int) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        """`K` for frames of this size, for files that name none."""
        fx, fy, cx, cy = self._calibration.camera(width, height)
        return np.array([[fx, 0.0, cx - 0.5], [0.0, fy, cy - 0.5], [0.0, 0.0, 1.0]])
