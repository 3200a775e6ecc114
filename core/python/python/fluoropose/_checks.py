"""Arguments as they have to be; what is wrong is told with the argument's name."""

from __future__ import annotations

import operator
import os
import sys
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

PathLike = str | os.PathLike[str]


def warn(remarks: Iterable[str]) -> None:
    """Warns of what has to be known, where the caller of this package stands."""
    level = 2
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "fluoropose":
        frame = frame.f_back
        level += 1
    for remark in remarks:
        warnings.warn(remark, stacklevel=level)


@contextmanager
def argument(name: str) -> Iterator[None]:
    """What goes wrong inside is told with the argument's name."""
    try:
        yield
    except (ValueError, OSError) as error:
        raise type(error)(f"{name}: {error}") from error


def whole(value: object, name: str) -> int:
    """A whole number."""
    try:
        return operator.index(value)  # type: ignore[arg-type]
    except TypeError as error:
        raise TypeError(f"{name} must be a whole number, not {type(value).__name__}") from error


def is_path(value: object) -> bool:
    """Whether a value names a file or a folder."""
    return isinstance(value, (str, os.PathLike))


def path(value: object, name: str) -> str:
    """A path."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value) if isinstance(value, str) else str(os.fspath(value))
    raise TypeError(f"{name} must be a path, not {type(value).__name__}")


def instance(value: object, kind: type, name: str) -> None:
    """A value of a class."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be a {kind.__name__}, not {type(value).__name__}")


def choice(value: object, words: Sequence[str], name: str) -> None:
    """One of some words."""
    if value not in words:
        raise ValueError(f"{name} must be one of {', '.join(words)}, not {value!r}")


def bright(metal: str | None) -> bool | None:
    """Whether metal is bright, where that is said."""
    if metal is not None:
        choice(metal, ("dark", "bright"), "metal")
    return None if metal is None else metal == "bright"


def pixels(value: ArrayLike, one: bool, name: str) -> NDArray[Any]:
    """An array of pixels; a path in its place is told how to become one."""
    if is_path(value):
        remedy = f"fluoropose.read_frames(path){'[0]' if one else ''}"
        raise TypeError(f"{name} must be an array, not a path: read the file with {remedy}")
    parts = value if isinstance(value, (list, tuple)) else (value,)
    if any(isinstance(part, np.ma.MaskedArray) and np.ma.is_masked(part) for part in parts):
        raise TypeError(
            f"{name} is a masked array, and what it masks would count as any other pixel: "
            "give its data alone, and with estimate or estimate_all what is not known of it as unknown=numpy.ma.getmaskarray(...)"
        )
    try:
        return np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name} must be an array: its rows, or frames, differ in length") from error


def masks(value: ArrayLike, dimensions: int, name: str) -> NDArray[np.uint8]:
    """Masks as bytes: rows, columns, and before them the frames where there are three dimensions."""
    array = pixels(value, dimensions == 2, name)
    if array.dtype != np.bool_ and not np.issubdtype(array.dtype, np.integer):
        remedy = f": give {name} > 0.5, or above whatever tells the implant" if np.issubdtype(array.dtype, np.floating) else ""
        raise TypeError(f"{name} must be of booleans or whole numbers, not {array.dtype}{remedy}")
    if array.ndim != dimensions or 0 in array.shape:
        shape = "(rows, columns)" if dimensions == 2 else "(frames, rows, columns)"
        raise ValueError(f"{name} must have the shape {shape}, none of them 0, not {array.shape}")
    if array.dtype in (np.bool_, np.uint8):
        return np.ascontiguousarray(array).view(np.uint8)
    return np.ascontiguousarray(array != 0).view(np.uint8)


def frame(value: ArrayLike, name: str) -> NDArray[Any]:
    """A grey frame of 8 or 16 bits."""
    array = pixels(value, True, name)
    native = array.dtype.newbyteorder("=")
    if native not in (np.uint8, np.uint16):
        raise TypeError(f"{name} must be of uint8 or uint16, not {array.dtype}")
    if array.ndim != 2 or 0 in array.shape:
        raise ValueError(f"{name} must have the shape (rows, columns), not {array.shape}")
    return np.asarray(array, dtype=native)


def numbers(value: ArrayLike, shape: tuple[int | None, ...], name: str) -> NDArray[np.float64]:
    """Numbers of a shape, in which None is any length."""
    try:
        array = np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} must be of numbers") from error
    fits = array.ndim == len(shape) and all(
        want is None or want == is_ for want, is_ in zip(shape, array.shape, strict=False)
    )
    if not fits:
        words = ", ".join("any" if length is None else str(length) for length in shape)
        raise ValueError(f"{name} must have the shape ({words}), not {array.shape}")
    return array


def pair(value: tuple[float, float] | None, name: str) -> tuple[float, float] | None:
    """Two finite numbers, or none."""
    if value is None:
        return None
    two = numbers(value, (2,), name)
    if not np.isfinite(two).all():
        raise ValueError(f"{name} must be of finite numbers, not ({two[0]}, {two[1]})")
    return float(two[0]), float(two[1])


def positive(value: float | None, name: str) -> float | None:
    """A number above 0, or none."""
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, (int, float, np.floating, np.integer)):
        raise TypeError(f"{name} must be a number, not {type(value).__name__}")
    if not (np.isfinite(value) and value > 0):
        raise ValueError(f"{name} must be above 0, not {value}")
    return float(value)
