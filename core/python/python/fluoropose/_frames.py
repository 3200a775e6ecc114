"""Frames and masks from files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _checks, _native


def read_frames(path: _checks.PathLike) -> NDArray[Any]:
    """The frames (frames, rows, columns) of a file, or of a folder's files in the order of their names: 8 or 16 bits.

    PNG, JPEG, JPEG 2000, TIFF, BMP, DICOM and NumPy arrays (`.npy`), decoded as the command decodes them. All of them are in memory then; `track` takes the
    folder itself and reads one at a time.
    """
    place = Path(_checks.path(path, "path"))
    files = files_of(place) if place.is_dir() else [place]
    frames = [frame for file in files for frame in _decoded(file)]
    if not frames:
        raise ValueError(f"path: {place} holds no frames")
    if any(frame.shape != frames[0].shape for frame in frames):
        raise ValueError(f"path: the frames of {place} differ in size")
    return np.stack(frames)


def files_of(folder: Path) -> list[Path]:
    """The files of a folder in the order of the frames."""
    return [Path(file) for file in _native.files_in(str(folder))]


def size_in(folder: Path) -> tuple[int, int] | None:
    """Columns and rows of the first frame of a folder; none where it cannot be read."""
    try:
        return _native.frame_size(str(files_of(folder)[0]))
    except (ValueError, OSError, IndexError):
        return None


def _decoded(file: Path) -> list[NDArray[Any]]:
    with _checks.argument(f"path: {file}"):
        return _native.read_frames(str(file))
