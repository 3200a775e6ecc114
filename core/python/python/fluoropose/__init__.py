"""Poses of knee implants from single X-ray images, and how the joint moves.

Lengths are millimetres, on the frame pixels; angles are degrees. Not a medical device.
"""

from ._camera import Camera
from ._estimate import Estimate, Rival, estimate, estimate_all
from ._frames import read_frames
from ._kinematics import ByFlexion, Kinematics, kinematics
from ._model import Model
from ._native import VERSION as __version__
from ._poses import NUMBERS, Pose, Poses, read_poses
from ._track import Click, Track, track

__all__ = [
    "NUMBERS",
    "ByFlexion",
    "Camera",
    "Click",
    "Estimate",
    "Kinematics",
    "Model",
    "Pose",
    "Poses",
    "Rival",
    "Track",
    "__version__",
    "estimate",
    "estimate_all",
    "kinematics",
    "read_frames",
    "read_poses",
    "track",
]
