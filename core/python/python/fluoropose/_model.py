"""Models of implants."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _native
from ._alike import Alike


@dataclass(frozen=True, eq=False, init=False)
class Model(Alike):
    """The CAD model of an implant, mm: the very size that was implanted.

    Libraries of its views are built when they are first needed and kept as long as the model.
    """

    path: str | None = field(compare=False)
    digest: str
    """SHA-256 of its vertices and triangles: models are equal where theirs are."""
    remarks: tuple[str, ...] = field(compare=False)
    _handle: _native.Model = field(repr=False, compare=False)

    def __init__(self, vertices: ArrayLike, faces: ArrayLike) -> None:
        places = _checks.numbers(vertices, (None, 3), "vertices")
        corners = np.asarray(faces)
        if not np.issubdtype(corners.dtype, np.integer):
            raise TypeError(f"faces must be of whole numbers, not {corners.dtype}")
        if corners.ndim != 2 or corners.shape[1] != 3:
            raise ValueError(f"faces must have the shape (any, 3), not {corners.shape}")
        if corners.size and (corners.min() < 0 or corners.max() >= len(places)):
            raise ValueError(f"faces name a vertex that is not there: there are {len(places)}")
        with _checks.argument("vertices or faces"):
            self._set(_native.Model(places.astype(np.float32), corners.astype(np.uint32)), None)

    @classmethod
    def from_file(cls, path: _checks.PathLike) -> Model:
        """Reads STL, OBJ or PLY, mm."""
        name = _checks.path(path, "path")
        model = object.__new__(cls)
        with _checks.argument(f"path: {name}"):
            model._set(_native.Model.read(name), name)
        return model

    def seen(self, name: str, role: str | None) -> list[str]:
        """What has to be known of it as an argument and a component: its units and faults, or that it has the other one's shape; warned of."""
        doubt = None if role is None else self._handle.doubt(role)
        told = [f"{name}: {remark}" for remark in (*self.remarks, doubt) if remark is not None]
        _checks.warn(told)
        return told

    def _set(self, native: _native.Model, path: str | None) -> None:
        values = (("path", path), ("digest", native.digest()), ("remarks", tuple(native.remarks())), ("_handle", native))
        for name, value in values:
            object.__setattr__(self, name, value)

    @property
    def vertices(self) -> NDArray[np.float32]:
        """Vertices (n, 3), mm."""
        return self._handle.vertices()

    @property
    def faces(self) -> NDArray[np.uint32]:
        """Vertex numbers of each triangle (n, 3)."""
        return self._handle.triangles()
