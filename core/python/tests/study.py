"""The synthetic study that the tests work on, and real ones where they are at hand."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import fluoropose as fp

DEMO = Path(os.environ.get("FLUOROPOSE_DEMO", "demo"))
# Of its frames and masks, pixels.
SIDE = 512
STUDIES = Path(os.environ.get("FLUOROPOSE_STUDIES", "studies"))


def run(*words: object, doubtful: bool = False) -> str:
    """Runs the command that came with the package; what it printed. All it finds may be doubtful where that is said."""
    command = [sys.executable, "-m", "fluoropose", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in ((0, 3) if doubtful else (0,)):
        raise AssertionError(f"{command}: {done.returncode}: {done.stderr}")
    return done.stdout


def skip(case: unittest.TestCase, why: str) -> None:
    """Leaves a test out, visibly."""
    print(f"SKIPPED: {case.id()}: {why}")
    case.skipTest(why)


class OnTheDemo(unittest.TestCase):
    """What all tests on the synthetic study share."""

    camera: fp.Camera
    femur: fp.Model
    tibia: fp.Model
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.camera = fp.Camera.from_intcalib(DEMO / "calibration.txt")
        cls.femur = fp.Model.from_file(DEMO / "femur.stl")
        cls.tibia = fp.Model.from_file(DEMO / "tibia.stl")
        temporary = tempfile.TemporaryDirectory(prefix="fluoropose-test-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
