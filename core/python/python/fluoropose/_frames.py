"""Frames and masks from files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _checks, _native


def read_frames(path: _checks.PathLike) -> NDArray[Any]:
    """The frames (frames, rows, columns) of a file, or of a folder's files in the order of their names: 8 or 16 bits.

    PNG, JPEG, JPEG 2000, TIFF and DICOM, decoded as the command decodes them. All of them are in memory then; `track` takes the
    folder itself and reads one at a time.
    """
    place = Path(_checks.path(path, "path"))
    files = [place]
    if place.is_dir():
        files = sorted(file for file in place.iterdir() if file.is_file() and not file.name.startswith("."))
    frames = [frame for file in files for frame in _decoded(file)]
    if not frames:
        raise ValueError(f"path: {place} holds no frames")
    if any(frame.shape != frames[0].shape for frame in frames):
        raise ValueError(f"path: the frames of {place} differ in size")
    return np.stack(frames)


def _decoded(file: Path) -> list[NDArray[Any]]:
    with _checks.argument(f"path: {file}"):
        return _native.read_frames(str(file))
