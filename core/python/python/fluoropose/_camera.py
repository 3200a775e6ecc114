"""The camera: where the X-ray source is, seen from the frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from . import _checks
from ._native import Calibration


@dataclass(frozen=True, init=False, repr=False)
class Camera:
    """A calibrated X-ray camera.

    `K` is its matrix in pixels, whole numbers at pixel centres, and `size` is (columns, rows) of its frames: the convention of
    computer vision and of MayaCam 2.0. Files are read by `from_intcalib` and `from_mayacam`. What is unusual of it is warned of:
    of files that name no frame size when frames are seen, and where those are of another size than frames before.
    """

    K: tuple[tuple[float, float, float], ...] | None
    """None where the frame size is not known; `matrix` tells it for frames of a size."""
    size: tuple[int, int] | None
    """Columns and rows of its frames; None where nobody says."""
    remarks: tuple[str, ...] = field(compare=False)
    """What is unusual of it, most often because the calibration is wrong."""
    _calibration: Calibration = field(repr=False, compare=False)
    text: str = field(repr=False)
    _seen: list[tuple[int, int]] = field(compare=False)
    """Size of the frames that were seen with it last, where there were any."""

    def __init__(self, K: ArrayLike, size: tuple[int, int]) -> None:
        matrix = _checks.numbers(K, (3, 3), "K")
        if not np.isfinite(matrix).all():
            row, column = np.argwhere(~np.isfinite(matrix))[0]
            raise ValueError(f"K must be of finite numbers; K[{row}][{column}] is {matrix[row, column]}")
        width, height = _size(size)
        rows = "\n".join(",".join(repr(float(number)) for number in row) for row in matrix)
        text = f"image size\n{width},{height}\n\ncamera matrix\n{rows}\n"
        with _checks.argument("K or size"):
            calibration = Calibration(text)
        self._set(calibration, matrix.tolist(), (width, height))

    def __repr__(self) -> str:
        """Matrix and size where they are known, else what the file says."""
        told = None if self.K is None else f"K={self.K}, size={self.size}"
        return f"Camera({', '.join(filter(None, (told, self._calibration.words())))})"

    @classmethod
    def from_intcalib(cls, source: _checks.PathLike, size: tuple[int, int] | None = None) -> Camera:
        """Reads a `JT_INTCALIB` file: principal distance, principal point and pitch, mm.

        It names no frame size: with `size` (columns, rows) masks and frames of another size are refused, as with a matrix; without it
        they are taken for whole frames of the detector, and only told where they differ from those that the camera was used with before.
        """
        return cls._read(source, None if size is None else _size(size))

    @classmethod
    def from_mayacam(cls, source: _checks.PathLike) -> Camera:
        """Reads a camera matrix as MayaCam 2.0 writes it."""
        camera = cls._read(source)
        if camera.size is None:
            raise ValueError("source is no file of MayaCam 2.0: it states no image size")
        return camera

    @classmethod
    def _read(cls, source: _checks.PathLike, stated: tuple[int, int] | None = None) -> Camera:
        name = _checks.path(source, "source")
        try:
            text = Path(name).read_text(encoding="utf-8-sig")
        except UnicodeDecodeError as error:
            raise ValueError(f"source: {name} is no text, as calibrations are") from error
        with _checks.argument(f"source: {name}"):
            calibration = Calibration(text)
        camera = object.__new__(cls)
        size = calibration.size() or stated
        if stated not in (None, size):
            raise ValueError(f"size is {stated}, but {name} is for {size}")
        matrix = None
        if size is not None:
            with _checks.argument("size"):
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
            ("_seen", []),
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
            doubts += self.others(width, height)
            _checks.warn(doubts)
        return doubts

    def others(self, width: int, height: int) -> list[str]:
        """That frames of another size were seen with it just before: it can be of one size alone."""
        others = [size for size in self._seen if size != (width, height)]
        self._seen[:] = [(width, height)]
        return [
            f"camera: these are {width} x {height} pixels, those before {columns} x {rows}: a calibration is of frames of one size, neither scaled "
            "nor cut; state it, as in Camera.from_intcalib(path, size=(columns, rows))"
            for columns, rows in others[:1]
        ]

    def matrix(self, width: int, height: int) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        """`K` for frames of this size, for files that name none."""
        fx, fy, cx, cy = self._calibration.camera(width, height)
        return np.array([[fx, 0.0, cx - 0.5], [0.0, fy, cy - 0.5], [0.0, 0.0, 1.0]])


def _size(value: tuple[int, int]) -> tuple[int, int]:
    try:
        columns, rows = value
    except (TypeError, ValueError) as error:
        raise TypeError("size must be (columns, rows)") from error
    size = _checks.whole(columns, "size"), _checks.whole(rows, "size")
    if min(size) < 1:
        raise ValueError(f"size must be of columns and rows above 0, not {size}")
    return size
