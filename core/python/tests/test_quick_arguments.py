"""What is wrong is told with the argument's name; what is not found is NaN with a status."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

import fluoropose as fp
from fluoropose import _checks as checks
from study import DEMO, SIDE, OnTheDemo

EMPTY = "the frame is empty: nearly all of it has one grey value"


def fixed_two() -> np.ndarray:
    """Two frames without a pose."""
    return np.full((2, 6), np.nan)


class Arguments(OnTheDemo):
    def refused(self, kind: type[Exception], word: str, call: Callable[[], object]) -> None:
        with self.assertRaises(kind) as caught:
            call()
        self.assertIn(word, str(caught.exception))

    def test_a_folder_of_another_film_is_refused_and_stays_as_it_was(self) -> None:
        frames = np.arange(2 * 64 * 64, dtype=np.uint16).reshape(2, 64, 64)
        camera = fp.Camera([[200, 0, 31.5], [0, 200, 31.5], [0, 0, 1]], (64, 64))
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

    def test_a_joint_that_no_knee_has_is_told(self) -> None:
        femur, tibia = (fp.read_poses(DEMO / f"{name}.jts") for name in ("femur", "tibia"))
        given = {"femur_model": self.femur, "tibia_model": self.tibia, "side": "left"}
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(fp.kinematics(femur, tibia, **given).remarks, ())  # type: ignore[arg-type]
        with self.assertWarnsRegex(UserWarning, "frame 1.*which no knee does") as caught:
            joint = fp.kinematics(tibia, femur, **given)  # type: ignore[arg-type]
        self.assertEqual(caught.filename, __file__)
        self.assertIn("which no knee does", joint.remarks[0])

    def test_models_of_the_other_component_are_told_with_the_pose(self) -> None:
        mask = fp.read_frames(DEMO / "masks/tibia")[0]
        with self.assertWarnsRegex(UserWarning, "model: .*swapped") as caught:
            found = fp.estimate(mask, self.tibia, self.camera, role="femur")
        self.assertEqual(caught.filename, __file__)
        self.assertIn("swapped", found.remarks[0])
        self.assertEqual((found.status, found.because), ("doubtful", found.remarks[0].removeprefix("model: ")))
        mask = np.zeros((SIDE, SIDE), bool)
        # A plate has no axes of a femoral component, and that it is one was told before.
        with self.assertWarnsRegex(UserWarning, "beside_model: .*swapped"), self.assertRaisesRegex(ValueError, "does not tell its axes"):
            fp.estimate(mask, self.tibia, self.camera, role="tibia", beside=np.zeros((1, 6)), beside_model=self.tibia)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(fp.estimate(mask, self.tibia, self.camera, role="tibia").remarks, ())

    def test_a_camera_that_does_not_fit_its_frames_is_told(self) -> None:
        def matrix(fx: float, fy: float, cx: float, cy: float) -> list[list[float]]:
            return [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]

        size = (1024, 1024)
        for numbers, words in (
            ((3200, 3200, 0, -1.5), "principal point, column 0.5"),
            ((3200, 3200, 256, 256), "principal point"),
            ((1198, 1198, 511.5, 511.5), "not mm"),
            ((3200, 2900, 511.5, 511.5), "not square"),
        ):
            with self.assertWarnsRegex(UserWarning, words):
                camera = fp.Camera(matrix(*numbers), size)
            self.assertRegex(camera.remarks[0], words)
        for numbers, words in (
            ((3200, -3200, 511.5, 511.5), "K or size: .*negative focal length, -3200.*whose y runs the other way"),
            ((3.2, 3.2, 0.5, 0.5), "focal length is 3.2; it must be at least a tenth"),
            ((3200, 3200, 2e5, 511.5), "principal point"),
        ):
            with self.assertRaisesRegex(ValueError, words):
                fp.Camera(matrix(*numbers), size)
        with self.assertRaisesRegex(ValueError, "K or size: the last row of the camera matrix is 0,0,2, but"):
            fp.Camera([[6400, 0, 1023], [0, 6400, 1023], [0, 0, 2]], size)
        for skewed in ([[3200, 1, 511], [0, 3200, 511], [0, 0, 1]], np.transpose(matrix(3200, 3200, 511, 511))):
            with self.assertRaisesRegex(ValueError, "K or size: .*fx,0,cx"):
                fp.Camera(skewed, size)
        # A file that names no size is seen with its frames.
        unseen = fp.Camera.from_intcalib(DEMO / "calibration.txt")
        quarter = SIDE // 4
        with self.assertWarnsRegex(UserWarning, "camera: .*focal length, 1608.6 pixels, is 12.5"):
            found = fp.estimate(np.zeros((quarter, quarter), bool), self.femur, unseen)
        self.assertEqual(len(found.remarks), 1)
        frames = np.zeros((2, quarter, quarter), np.uint8)
        frames[1] += 1  # No frame twice, which is told too.
        fixed = {"femur": fp.read_poses(DEMO / "femur.jts")}
        with self.assertWarnsRegex(UserWarning, "camera: .*is 12.5") as caught:
            film = fp.track(frames, self.femur, None, unseen, "left", fixed=fixed)
        self.assertEqual((caught.filename, len(film.remarks)), (__file__, 1))

    def test_masks_of_another_size_than_the_cameras_are_told_or_refused(self) -> None:
        file, half = DEMO / "calibration.txt", np.zeros((SIDE // 2, SIDE // 2), bool)
        whole, less = f"{SIDE} x {SIDE}", f"{SIDE // 2} x {SIDE // 2}"
        camera = fp.Camera.from_intcalib(file)
        fp.estimate(np.zeros((SIDE, SIDE), bool), self.femur, camera)
        with self.assertWarnsRegex(UserWarning, f"these are {less} pixels, those before {whole}"):
            found = fp.estimate(half, self.femur, camera)
        self.assertIn("size=(columns, rows)", found.remarks[-1])
        # One mask of another size is told at each change, and spoils nothing for good.
        with self.assertWarnsRegex(UserWarning, f"these are {whole} pixels, those before {less}"):
            fp.estimate(np.zeros((SIDE, SIDE), bool), self.femur, camera)
        self.assertEqual(fp.estimate(np.zeros((SIDE, SIDE), bool), self.femur, camera).remarks, ())
        fixed = {"femur": fp.read_poses(DEMO / "femur.jts")}
        small = fp.Camera.from_intcalib(file)
        fp.estimate(half, self.femur, small)
        with self.assertWarnsRegex(UserWarning, f"these are {whole} pixels, those before {less}") as caught:
            film = fp.track(DEMO / "frames", self.femur, None, small, "left", fixed=fixed)
        self.assertEqual((caught.filename, len(film.remarks)), (__file__, 1))
        sized = fp.Camera.from_intcalib(file, size=(SIDE, SIDE))
        self.refused(ValueError, f"mask: {less} pixels, but camera is for {whole}", lambda: fp.estimate(half, self.femur, sized))
        wrong = fp.Camera.from_intcalib(file, size=(SIDE // 2, SIDE // 2))
        self.refused(ValueError, f"frames: {whole} pixels", lambda: fp.track(DEMO / "frames", self.femur, None, wrong, "left"))
        assert sized.K is not None
        np.testing.assert_array_equal(sized.K, camera.matrix(SIDE, SIDE))
        self.assertNotEqual(sized, camera)
        self.assertRegex(repr(camera), r"^Camera\(principal distance 1[0-9.]+ mm, principal point .* pixels of 0\.[0-9]+ mm\)$")
        self.assertRegex(repr(sized), rf"^Camera\(K=.*, size=\({SIDE}, {SIDE}\), principal distance")
        self.refused(TypeError, "size ", lambda: fp.Camera.from_intcalib(file, size=1024))  # type: ignore[arg-type]

    def test_a_path_in_place_of_pixels_is_told_how_to_become_some(self) -> None:
        one, camera, file = self.femur, self.camera, str(DEMO / "masks/femur")
        self.refused(TypeError, "mask must be an array, not a path: read the file with fluoropose.read_frames(path)[0]", lambda: fp.estimate(file, one, camera))
        self.refused(TypeError, "masks must be an array, not a path: read the file with fluoropose.read_frames(path)", lambda: fp.estimate_all(file, one, camera))
        self.refused(TypeError, "frame must be an array, not a path", lambda: fp.estimate(None, one, camera, frame=file))
        mask = np.zeros((1, SIDE, SIDE), bool)
        self.refused(TypeError, "frames must be an array, not a path", lambda: fp.estimate_all(mask, one, camera, frames=file))  # type: ignore[arg-type]

    def test_a_frame_of_the_other_byte_order_is_the_same_frame(self) -> None:
        frame = np.arange(12, dtype=np.uint16).reshape(3, 4) * 1000
        for swapped in (frame.astype(">u2"), frame.astype("<u2")):
            native = checks.frame(swapped, "frame")
            self.assertEqual(native.dtype, np.uint16)
            np.testing.assert_array_equal(native, frame)
        self.refused(TypeError, "frame must be of uint8 or uint16, not", lambda: checks.frame(frame.astype(">i2"), "frame"))

    def test_messages_name_the_argument_and_no_file_that_nobody_gave(self) -> None:
        frames = np.zeros((2, 64, 48), np.uint8)
        camera = fp.Camera([[150, 0, 24], [0, 150, 32], [0, 0, 1]], (48, 64))
        binary = self.folder / "binary"
        binary.write_bytes(bytes(range(128, 256)) * 8)
        three = {"femur": np.full((3, 6), np.nan)}
        one, two = self.femur, self.tibia

        def told(call: Callable[[], object], *words: str) -> None:
            with self.assertRaises(ValueError) as caught:
                call()
            for word in words:
                self.assertIn(word, str(caught.exception))
            self.assertNotIn("fluoropose-", str(caught.exception).replace("fluoropose-test-", ""))

        told(lambda: fp.track(frames, one, None, camera, "left", fixed=three), "fixed['femur']: there are 3 rows, but the film has 2 frames")
        told(lambda: fp.track(frames, one, None, camera, "left", fixed={"femur": binary}), "fixed['femur']", str(binary))
        for column, row in ((49, 5), (48, 5), (5, 64), (-1, 5), (5, float("inf"))):
            click = fp.Click("femur", 0, column, row)
            told(lambda click=click: fp.track(frames, one, two, camera, "left", clicks=[click]), "clicks")  # type: ignore[misc]
        far = fp.Click("tibia", 1, 5, 640)
        told(lambda: fp.track(frames, one, two, camera, "left", clicks=[far]), "clicks[0]: column 5, row 640", "48 columns and 64 rows")
        late = fp.Click("tibia", 2, 5, 6)
        told(lambda: fp.track(frames, one, two, camera, "left", clicks=[late]), "clicks[0]: there is no such frame, the film has 2")
        early = fp.Click("tibia", -1, 5, 6)
        told(lambda: fp.track(frames, one, two, camera, "left", clicks=[early]), "clicks[0]: frame is -1")
        told(lambda: fp.track(DEMO, one, two, camera, "left"), "frames: ", "calibration.txt: this is a calibration, not a frame")
        told(lambda: fp.estimate(frames[0], one, camera, library=binary), "library: ", str(binary))
        told(lambda: fp.estimate(None, one, camera, frame=frames[0], click=(640, 5)), "click: column 640, row 5", "48 columns and 64 rows")
        told(lambda: fp.Camera.from_intcalib(binary), "source: ", str(binary))
        told(lambda: fp.Model.from_file(binary), "path: ", str(binary))
        told(lambda: fp.kinematics(binary, fixed_two(), femur_model=one, tibia_model=two, side="left"), "femur: ", str(binary))
        told(lambda: fp.read_frames(binary), str(binary))

    def test_shapes_and_types_are_told_by_name(self) -> None:
        mask = np.zeros((SIDE, SIDE), bool)
        frames = np.zeros((2, 64, 64), np.uint8)
        poses = np.zeros((2, 6))
        small = fp.Camera([[200, 0, 31.5], [0, 200, 31.5], [0, 0, 1]], (64, 64))
        one, two = self.femur, self.tibia
        refused = self.refused
        refused(TypeError, "mask ", lambda: fp.estimate(mask.astype(float), one, self.camera))
        refused(ValueError, "mask ", lambda: fp.estimate(mask[None], one, self.camera))
        refused(ValueError, "masks ", lambda: fp.estimate_all(mask, one, self.camera))
        refused(TypeError, "model ", lambda: fp.estimate(mask, "femur.stl", self.camera))  # type: ignore[arg-type]
        refused(TypeError, "camera ", lambda: fp.estimate(mask, one, None))  # type: ignore[arg-type]
        refused(ValueError, f"mask: {SIDE}", lambda: fp.estimate(mask, one, small))
        refused(ValueError, f"masks: {SIDE}", lambda: fp.estimate_all(mask[None], one, small))
        refused(ValueError, "none of them 0, not (0, ", lambda: fp.estimate_all(mask[None][:0], one, self.camera))
        refused(ValueError, "masks must be an array: its rows", lambda: fp.estimate_all([[[0, 1], [1]]], one, self.camera))
        refused(ValueError, "frame must have the shape of the mask", lambda: fp.estimate(mask, one, self.camera, frame=np.zeros((4, 4), np.uint8)))
        refused(ValueError, "method ", lambda: fp.estimate(mask, one, self.camera, method="guess"))
        refused(ValueError, "frame ", lambda: fp.estimate(mask, one, self.camera, method="image"))
        refused(ValueError, "frames ", lambda: fp.estimate_all(mask[None], one, self.camera, method="image"))
        refused(ValueError, "unknown must have the shape of the mask,", lambda: fp.estimate(mask, one, self.camera, unknown=mask[:5]))
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
        refused(TypeError, "progress ", lambda: fp.track(frames, one, two, self.camera, "left", progress=1))  # type: ignore[arg-type]
        refused(ValueError, "K ", lambda: fp.Camera(np.eye(4), (64, 64)))
        refused(ValueError, "K[1][2] is nan", lambda: fp.Camera([[200, 0, 31], [0, 200, np.nan], [0, 0, 1]], (64, 64)))
        refused(ValueError, "size must be of columns and rows above 0, not (-1, 64)", lambda: fp.Camera(np.eye(3), (-1, 64)))
        refused(TypeError, "size ", lambda: fp.Camera(np.eye(3), 64))  # type: ignore[arg-type]
        refused(TypeError, "size ", lambda: fp.Camera(np.eye(3), (64.5, 64)))  # type: ignore[arg-type]
        refused(TypeError, "clicks[0]: frame ", lambda: fp.track(frames, one, two, self.camera, "left", clicks=[fp.Click("femur", 0.5, 1, 1)]))  # type: ignore[arg-type]
        refused(TypeError, "clicks[0]: column", lambda: fp.track(frames, one, two, self.camera, "left", clicks=[fp.Click("femur", 0, "x", 1)]))  # type: ignore[arg-type]
        refused(FileNotFoundError, "fixed['femur']: ", lambda: fp.track(frames, one, two, self.camera, "left", fixed={"femur": "nowhere"}))
        refused(OSError, "out: ", lambda: fp.track(frames, one, two, self.camera, "left", out=DEMO / "femur.stl"))
        refused(ValueError, "source", lambda: fp.Camera.from_mayacam(DEMO / "calibration.txt"))
        refused(FileNotFoundError, "nowhere", lambda: fp.Model.from_file("nowhere.stl"))
        refused(ValueError, "faces ", lambda: fp.Model(np.zeros((3, 3)), [[0, 1, 3]]))
        refused(TypeError, "faces ", lambda: fp.Model(np.zeros((3, 3)), [[0.5, 1, 2]]))
        refused(ValueError, "vertices ", lambda: fp.Model(np.zeros((3, 2)), [[0, 1, 2]]))
        joint = {"femur_model": one, "tibia_model": two, "side": "left"}
        refused(ValueError, "tibia 2", lambda: fp.kinematics(poses[:1], poses, **joint))  # type: ignore[arg-type]
        refused(ValueError, "fps ", lambda: fp.kinematics(poses, poses, cutoff_hz=3.0, **joint))  # type: ignore[arg-type]

    def test_what_would_be_ignored_is_refused(self) -> None:
        mask, one, refused = np.ones((SIDE, SIDE), bool), self.femur, self.refused
        masked = np.ma.masked_array(mask, mask=False)
        np.testing.assert_array_equal(checks.masks(masked, 2, "mask"), mask)
        masked[0, 0] = np.ma.masked
        sentence = "is a masked array, and what it masks would count as any other pixel: "
        grey = np.ma.masked_array(mask.astype(np.uint8), mask=masked.mask)
        refused(TypeError, f"mask {sentence}", lambda: fp.estimate(masked, one, self.camera))
        refused(TypeError, "unknown=numpy.ma.getmaskarray", lambda: fp.estimate_all([masked], one, self.camera))
        refused(TypeError, f"frame {sentence}", lambda: fp.estimate(mask, one, self.camera, frame=grey))
        refused(TypeError, f"frames {sentence}", lambda: fp.track([grey], one, None, self.camera, "left"))
        refused(TypeError, "not float64: give mask > 0.5", lambda: fp.estimate(mask * 0.3, one, self.camera))
        library = self.folder / "femur.library"
        refused(ValueError, "nominal tells which views", lambda: fp.estimate(mask, one, self.camera, library=library, nominal=(0, 0)))
        refused(ValueError, "distance_mm tells which views", lambda: fp.estimate(mask, one, self.camera, library=library, distance_mm=900))

    def test_a_nominal_view_is_told_by_name(self) -> None:
        frame, nowhere = np.zeros((SIDE, SIDE), np.uint8), np.zeros((SIDE, SIDE), bool)
        for nominal, words in (
            ((np.nan, 0), "nominal must be of finite numbers, not (nan, 0.0)"),
            ((75, 0), "nominal must be from -74 to 74 degrees about x and from -340 to 340 about y, not (75.0, 0.0)"),
            ((0, -341), "nominal must be from -74"),
        ):
            self.refused(ValueError, words, lambda nominal=nominal: fp.estimate(nowhere, self.femur, self.camera, nominal=nominal))  # type: ignore[misc]
            self.refused(ValueError, words, lambda nominal=nominal: fp.estimate(None, self.femur, self.camera, frame=frame, nominal=nominal))  # type: ignore[misc]
        for nominal in ((74, 340), (-74, -340)):
            self.assertEqual(fp.estimate(nowhere, self.femur, self.camera, nominal=nominal).status, "none")

    def test_a_frame_without_a_picture_is_told(self) -> None:
        mask = fp.read_frames(DEMO / "masks/femur")[0]
        for kind in (np.uint8, np.uint16):
            blank = np.full((SIDE, SIDE), 7, kind)
            found = fp.estimate(mask, self.femur, self.camera, frame=blank)
            self.assertEqual((found.status, found.because), ("none", EMPTY))
            found = fp.estimate(None, self.femur, self.camera, frame=blank, click=(250, 250))
            self.assertEqual((found.status, found.because), ("none", EMPTY))

    def test_a_mask_in_pieces_is_told(self) -> None:
        mask = fp.read_frames(DEMO / "masks/femur")[0] != 0
        self.assertFalse(mask[:80, :80].any())
        area = int(mask.sum())
        mask[10:70, 10:70] = True
        found = fp.estimate(mask, self.femur, self.camera)
        self.assertEqual(found.status, "none")
        self.assertIn(f"the mask has 2 separate pieces, of 3600 and {area} pixels", found.because)
        # Where something is told to hide what lies between, pieces are no fault.
        found = fp.estimate(mask, self.femur, self.camera, unknown=np.eye(SIDE, dtype=bool))
        self.assertNotIn("pieces,", found.because)

    def test_nothing_is_nan_with_a_reason(self) -> None:
        nothing = fp.estimate(np.zeros((SIDE, SIDE), bool), self.femur, self.camera)
        self.assertEqual((nothing.status, bool(nothing)), ("none", False))
        self.assertTrue(np.isnan(nothing.pose.numbers).all() and np.isnan(nothing.sd.numbers).all())
        self.assertTrue(np.isnan(nothing.covariance).all() and np.isnan(nothing.pose.matrix).all())
        self.assertIn("empty", nothing.because)
        self.assertEqual(nothing.version, fp.__version__)
        self.assertEqual(nothing.settings["model"], self.femur.digest)

    def test_a_camera_matrix_is_that_of_the_file(self) -> None:
        matrix = self.camera.matrix(SIDE, SIDE)
        by_matrix = fp.Camera(matrix, (SIDE, SIDE))
        np.testing.assert_allclose(by_matrix.matrix(SIDE, SIDE), matrix, rtol=1e-15)
        mask = fp.read_frames(DEMO / "masks/femur")[0]
        library = fp.estimate(mask, self.femur, self.camera, distance_mm=1000.0).pose.numbers
        np.testing.assert_allclose(fp.estimate(mask, self.femur, by_matrix).pose.numbers, library, atol=1e-6)
