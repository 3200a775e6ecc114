"""What is wrong is told with the argument's name; what is not found is NaN with a status."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

import fluoropose as fp
from study import DEMO, OnTheDemo


class Arguments(OnTheDemo):
    def refused(self, kind: type[Exception], word: str, call: Callable[[], object]) -> None:
        with self.assertRaises(kind) as caught:
            call()
        self.assertIn(word, str(caught.exception))

    def test_a_folder_of_another_film_is_refused_and_stays_as_it_was(self) -> None:
        frames = np.arange(2 * 64 * 64, dtype=np.uint16).reshape(2, 64, 64)
        camera = fp.Camera(np.diag([3000.0, 3000.0, 1.0]), (64, 64))
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            (place / "frames").mkdir()
            for name in ("journal.txt", "femur.jts", "study.toml", "calibration.txt", "frames/000001.png"):
                (place / name).write_text(f"another film's {name}", encoding="utf-8")

            def files() -> dict[str, bytes]:
                return {str(file.relative_to(place)): file.read_bytes() for file in place.rglob("*") if file.is_file()}

            before = files()
            self.refused(ValueError, "anew=True", lambda: fp.track(frames, self.femur, None, camera, "left", out=place))
            self.assertEqual(files(), before)

    def test_swapped_models_are_told_before_a_film_is_followed(self) -> None:
        with self.assertWarnsRegex(UserWarning, "femur: .*swapped"), self.assertRaises(ValueError):
            fp.track([], self.tibia, self.femur, self.camera, "left")

    def test_shapes_and_types_are_told_by_name(self) -> None:
        mask = np.zeros((1024, 1024), bool)
        frames = np.zeros((2, 64, 64), np.uint8)
        poses = np.zeros((2, 6))
        small = fp.Camera(np.diag([3000.0, 3000.0, 1.0]), (64, 64))
        one, two = self.femur, self.tibia
        refused = self.refused
        refused(TypeError, "mask ", lambda: fp.estimate(mask.astype(float), one, self.camera))
        refused(ValueError, "mask ", lambda: fp.estimate(mask[None], one, self.camera))
        refused(ValueError, "masks ", lambda: fp.estimate_all(mask, one, self.camera))
        refused(TypeError, "model ", lambda: fp.estimate(mask, "femur.stl", self.camera))  # type: ignore[arg-type]
        refused(TypeError, "camera ", lambda: fp.estimate(mask, one, None))  # type: ignore[arg-type]
        refused(ValueError, "masks: 1024", lambda: fp.estimate(mask, one, small))
        refused(ValueError, "method ", lambda: fp.estimate(mask, one, self.camera, method="guess"))
        refused(ValueError, "frames ", lambda: fp.estimate(mask, one, self.camera, method="image"))
        refused(ValueError, "unknown ", lambda: fp.estimate(mask, one, self.camera, unknown=mask[:5]))
        refused(ValueError, "role ", lambda: fp.estimate(mask, one, self.camera, beside=poses[:1]))
        refused(ValueError, "beside ", lambda: fp.estimate(mask, one, self.camera, role="femur", beside=poses))
        refused(ValueError, "distance_mm ", lambda: fp.estimate(mask, one, self.camera, distance_mm=-1))
        refused(TypeError, "mask or frame", lambda: fp.estimate(None, one, self.camera))
        refused(ValueError, "method ", lambda: fp.estimate(None, one, self.camera, frame=frames[0], method="image"))
        refused(TypeError, "frame ", lambda: fp.estimate(None, one, self.camera, frame=mask))
        refused(TypeError, "frames ", lambda: fp.track(frames.astype(float), one, two, self.camera, "left"))
        refused(TypeError, "frames ", lambda: fp.track(5, one, two, self.camera, "left"))  # type: ignore[arg-type]
        refused(ValueError, "frames", lambda: fp.track([], one, two, self.camera, "left"))
        refused(FileNotFoundError, "frames", lambda: fp.track(["nowhere.png"], one, two, self.camera, "left"))
        nowhere = fp.Click("femur", 0, float("nan"), 3.0)
        refused(ValueError, "clicks", lambda: fp.track(frames, one, two, self.camera, "left", clicks=[nowhere]))
        refused(ValueError, "side ", lambda: fp.track(frames, one, two, self.camera, "up"))
        refused(TypeError, "femur ", lambda: fp.track(frames, "f.stl", two, self.camera, "left"))  # type: ignore[arg-type]
        refused(ValueError, "fps ", lambda: fp.track(frames, one, two, self.camera, "left", 0.0))
        refused(ValueError, "fixed['tibia']", lambda: fp.track(frames, one, two, self.camera, "left", fixed={"tibia": [1, 2]}))
        refused(ValueError, "'patella'", lambda: fp.track(frames, one, two, self.camera, "left", fixed={"patella": poses}))
        refused(ValueError, "3 rows", lambda: fp.track(frames, one, None, self.camera, "left", fixed={"femur": np.full((3, 6), np.nan)}))
        refused(ValueError, "K ", lambda: fp.Camera(np.eye(4), (64, 64)))
        refused(TypeError, "size ", lambda: fp.Camera(np.eye(3), 64))  # type: ignore[arg-type]
        refused(ValueError, "source", lambda: fp.Camera.from_mayacam(DEMO / "calibration.txt"))
        refused(FileNotFoundError, "nowhere", lambda: fp.Model.from_file("nowhere.stl"))
        refused(ValueError, "faces ", lambda: fp.Model(np.zeros((3, 3)), [[0, 1, 3]]))
        refused(TypeError, "faces ", lambda: fp.Model(np.zeros((3, 3)), [[0.5, 1, 2]]))
        refused(ValueError, "vertices ", lambda: fp.Model(np.zeros((3, 2)), [[0, 1, 2]]))
        joint = {"femur_model": one, "tibia_model": two, "side": "left"}
        refused(ValueError, "tibia 2", lambda: fp.kinematics(poses[:1], poses, **joint))  # type: ignore[arg-type]
        refused(ValueError, "fps ", lambda: fp.kinematics(poses, poses, cutoff_hz=3.0, **joint))  # type: ignore[arg-type]

    def test_nothing_is_nan_with_a_reason(self) -> None:
        nothing = fp.estimate(np.zeros((1024, 1024), bool), self.femur, self.camera)
        self.assertEqual((nothing.status, bool(nothing)), ("none", False))
        self.assertTrue(np.isnan(nothing.pose.numbers).all() and np.isnan(nothing.sd.numbers).all())
        self.assertTrue(np.isnan(nothing.covariance).all() and np.isnan(nothing.pose.matrix).all())
        self.assertIn("empty", nothing.because)
        self.assertEqual(nothing.version, fp.__version__)
        self.assertEqual(nothing.settings["model"], self.femur.digest)

    def test_a_camera_matrix_is_that_of_the_file(self) -> None:
        matrix = self.camera.matrix(1024, 1024)
        by_matrix = fp.Camera(matrix, (1024, 1024))
        np.testing.assert_allclose(by_matrix.matrix(1024, 1024), matrix, rtol=1e-15)
        mask = fp.read_frames(DEMO / "masks/femur")[0]
        library = fp.estimate(mask, self.femur, self.camera, distance_mm=1000.0).pose.numbers
        np.testing.assert_allclose(fp.estimate(mask, self.femur, by_matrix).pose.numbers, library, atol=1e-6)
