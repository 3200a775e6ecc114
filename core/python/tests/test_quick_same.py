"""Python and the command give the same numbers, to the last bit."""

from __future__ import annotations

import pickle
import tracemalloc
from collections.abc import Iterator

import numpy as np

import fluoropose as fp
from study import DEMO, SIDE, OnTheDemo, run


class SameNumbers(OnTheDemo):
    def test_poses_of_masks(self) -> None:
        library, jts = self.folder / "femur.library", self.folder / "femur.jts"
        given = ("--model", DEMO / "femur.stl", "--calibration", DEMO / "calibration.txt")
        run("library", *given, "--out", library)
        masks = fp.read_frames(DEMO / "masks/femur")
        for method in ("library", "refined"):
            run("pose", *given, "--library", library, "--masks", DEMO / "masks/femur", "--method", method, "--out", jts)
            command = fp.read_poses(jts)
            ours = fp.estimate_all(masks, self.femur, self.camera, method=method)
            np.testing.assert_array_equal([one.pose.numbers for one in ours], command, strict=True)
            read = fp.estimate_all(masks != 0, self.femur, self.camera, method=method, library=library)
            np.testing.assert_array_equal([one.pose.numbers for one in read], command)
        truth = fp.read_poses(DEMO / "femur.jts")
        np.testing.assert_allclose(command, truth, atol=0.1)
        best = ours[0]
        self.assertEqual((best.status, bool(best)), ("good", True))
        self.assertTrue(np.isfinite(best.sd.numbers).all() and np.isfinite(best.covariance).all())
        np.testing.assert_array_equal(best.pose.matrix[:3, 3], best.pose.numbers[:3])
        with self.assertRaises(AttributeError):
            best.pose.x_mm = 0.0  # type: ignore[misc]

    def test_a_film_and_its_joint(self) -> None:
        fixed = {name: fp.read_poses(DEMO / f"{name}.jts") for name in ("femur", "tibia")}
        # The tibia of the second frame is left to be found.
        fixed["tibia"][1] = np.nan
        frames = fp.read_frames(DEMO / "frames")
        rows = self.folder / "tibia.fixed.jts"
        model = fp.Model(self.tibia.vertices, self.tibia.faces)
        ours = fp.track(iter(frames), self.femur, model, self.camera, "left", 15.0, fixed=fixed, out=self.folder / "ours")
        assert ours.femur is not None and ours.tibia is not None
        rows.write_bytes((self.folder / "ours/tibia.fixed.jts").read_bytes())
        out, report = self.folder / "command", self.folder / "report"
        study = self.folder / "ours/study.toml"
        run("track", "--study", study, "--out", out, "--fixed", f"femur={DEMO / 'femur.jts'}", "--fixed", f"tibia={rows}")
        for poses in (ours.femur, ours.tibia):
            np.testing.assert_array_equal(poses.pose, fp.read_poses(out / f"{poses.name}.jts"))
            poses.to_jts(self.folder / "own.jts")
            self.assertEqual((self.folder / "own.jts").read_bytes(), (out / f"{poses.name}.jts").read_bytes())
        self.assertEqual(ours.femur.state, ("fixed", "fixed"))
        self.assertEqual(ours.tibia.state[0], "fixed")
        run("report", "--study", study, "--poses", out, "--out", report, "--cutoff", "3")
        joint = ours.kinematics(cutoff_hz=3.0)
        joint.to_csv(self.folder / "joint.csv")
        joint.to_mot(self.folder / "joint.mot")
        joint.to_svg(self.folder / "figure.svg")
        joint.to_pdf(self.folder / "figure.pdf")
        pickle.loads(pickle.dumps(joint)).to_png(self.folder / "again.png")
        joint.to_png(self.folder / "figure.png")
        self.assertEqual((self.folder / "again.png").read_bytes(), (self.folder / "figure.png").read_bytes())
        for name in ("joint.csv", "joint.mot", "figure.svg", "figure.pdf", "figure.png"):
            self.assertEqual((self.folder / name).read_bytes(), (report / name).read_bytes(), name)
        cycle = (report / "cycle/flexion_deg.csv").read_text(encoding="utf-8").splitlines()[-1]
        np.testing.assert_array_equal(joint.cycle("flexion_deg"), [float(number) for number in cycle.split(",")])
        steps = joint.by_flexion
        np.testing.assert_allclose(steps["flexion_deg"], steps.flexion_deg, atol=1e-9)
        self.assertTrue((steps.n[:, joint.names.index("flexion_deg")] > 0).all())
        alone = fp.kinematics(
            out / "femur.jts", ours.tibia.pose, femur_model=self.femur, tibia_model=self.tibia, side="left"
        )
        np.testing.assert_array_equal(alone.values, joint.values)
        self.assertTrue(np.isnan(alone.sd).all())

    def test_an_iterator_is_read_one_frame_at_a_time(self) -> None:
        fixed = {"femur": fp.read_poses(DEMO / "femur.jts")[[0] * 6]}
        # Every other pixel: it is their memory that is asked for.
        matrix = self.camera.matrix(SIDE, SIDE)
        matrix[:2] /= 2
        camera = fp.Camera(matrix, (SIDE // 2, SIDE // 2))
        frame = fp.read_frames(DEMO / "frames")[0][::2, ::2].copy()

        def frames() -> Iterator[np.ndarray]:
            for _ in range(6):
                yield frame.copy()

        tracemalloc.start()
        found = fp.track(frames(), self.femur, None, camera, "left", fixed=fixed)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        self.assertEqual(len(found), 6)
        self.assertLess(peak, 4 * frame.nbytes)
