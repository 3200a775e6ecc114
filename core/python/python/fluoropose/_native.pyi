"""What the extension has; the package's own modules are the way to it."""

from collections.abc import Callable
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray

VERSION: str

class Calibration:
    def __new__(cls, text: str) -> Calibration: ...
    def text(self) -> str: ...
    def size(self) -> tuple[int, int] | None: ...
    def words(self) -> str | None: ...
    def camera(self, width: int, height: int) -> tuple[float, float, float, float]: ...
    def doubts(self, width: int, height: int) -> list[str]: ...

class Model:
    def __new__(
        cls, vertices: NDArray[np.float32], triangles: NDArray[np.uint32], remarks: list[str] | None = None
    ) -> Model: ...
    @staticmethod
    def read(path: str) -> Model: ...
    def vertices(self) -> NDArray[np.float32]: ...
    def triangles(self) -> NDArray[np.uint32]: ...
    def digest(self) -> str: ...
    def remarks(self) -> list[str]: ...
    def doubt(self, role: str) -> str | None: ...
    def write(self, path: str) -> None: ...

class Figure:
    def __new__(cls, png: bytes) -> Figure: ...
    def png(self) -> bytes: ...

class Answer(TypedDict):
    pose: list[float]
    sd: list[float]
    covariance: list[float] | None
    misfit: float | None
    residual_px: float | None
    offset_px: float | None
    verdict: str
    because: str
    decided_by: str
    rivals: list[tuple[list[float], float]]
    specks: int
    film: str | None

class Followed(TypedDict):
    name: str
    pose: NDArray[np.float64]
    sd: NDArray[np.float64]
    covariance: list[float]
    film_steps: list[float]
    state: list[str]
    verdict: list[str]
    because: list[str]
    misfit_px: list[float | None]
    badness: list[float]

class ByFlexion(TypedDict):
    flexion_deg: NDArray[np.float64]
    mean: NDArray[np.float64]
    sd: NDArray[np.float64]
    n: NDArray[np.uint64]

class Joint(TypedDict):
    names: list[str]
    units: list[str]
    values: NDArray[np.float64]
    sd: NDArray[np.float64]
    filtered: NDArray[np.float64]
    doubt: list[str | None]
    by_flexion: ByFlexion
    cycles: NDArray[np.float64]
    csv: str
    mot: str | None
    svg: str
    pdf: bytes
    figure: Figure
    axes: list[str]
    remarks: list[str]

def command(words: list[str]) -> int: ...
def estimate(
    model: Model,
    calibration: Calibration,
    masks: NDArray[np.uint8],
    *,
    unknown: NDArray[np.uint8] | None,
    frames: list[NDArray[Any]] | None,
    method: str,
    library: str | None,
    nominal: tuple[float, float] | None,
    distance_mm: float | None,
    bright: bool | None,
    edge_offset: bool,
    other: tuple[str, NDArray[np.float64], Model | None] | None,
    doubt: str | None,
) -> list[Answer]: ...
def track(
    study: str,
    out: str,
    *,
    clicks: list[tuple[str, int, float, float, str]],
    fixed: list[tuple[str, NDArray[np.float64], str]],
    bright: bool | None,
    interpolate: int,
    anew: bool,
    remark: Callable[[str], object],
    progress: Callable[[int, int, str], object] | None,
) -> list[Followed]: ...
def joint(
    femur: tuple[Model, NDArray[np.float64], NDArray[np.float64] | None, str | None],
    tibia: tuple[Model, NDArray[np.float64], NDArray[np.float64] | None, str | None],
    *,
    side: str,
    name: str,
    fps: float | None,
    cutoff: float | None,
    doubts: dict[int, str],
    judged: bool,
) -> Joint: ...
def read_frames(path: str) -> list[NDArray[Any]]: ...
def files_in(folder: str) -> list[str]: ...
def frame_size(path: str) -> tuple[int, int]: ...
def write_frame(path: str, frame: NDArray[Any]) -> None: ...
def read_poses(path: str) -> NDArray[np.float64]: ...
def write_poses(path: str, rows: NDArray[np.float64]) -> None: ...
def matrices(rows: NDArray[np.float64]) -> NDArray[np.float64]: ...
