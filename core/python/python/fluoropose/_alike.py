"""Equality of results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np


class Alike:
    """Equal where all that is compared of two is: arrays number by number, and NaN is NaN."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(_are_alike(one, another) for one, another in zip(_compared(self), _compared(other), strict=True))

    def __hash__(self) -> int:
        return hash((type(self).__name__, *map(_key, _compared(self))))


def _compared(value: Any) -> list[Any]:
    return [getattr(value, one.name) for one in fields(value) if one.compare]


def _are_alike(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=True)
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(_are_alike, one, other))
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_are_alike(value, other[key]) for key, value in one.items())
    if isinstance(one, float) and one != one:
        return isinstance(other, float) and other != other
    return bool(one == other)


def _key(value: Any) -> Any:
    """What alike values have in common, and can be hashed."""
    if isinstance(value, float):
        return None if value != value else value
    if isinstance(value, tuple):
        return tuple(map(_key, value))
    return value if isinstance(value, (str, int)) else None
