"""The README's example, real studies, and what other programs make of the files."""

from __future__ import annotations

import io
import os
import re
import sys
import tempfile
import threading
import time
import unittest
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

import fluoropose as fp
from study import DEMO, SIDE, STUDIES, OnTheDemo, run, skip

HERE = Path(__file__).parent


class Readme(OnTheDemo):
    def test_its_example_runs_as_it_stands(self) -> None:
        text = (HERE.parent / "README.md").read_text(encoding="utf-8")
        found = re.search(r"```python\n(.*?)```", text, re.DOTALL)
        assert found is not None
        for name in ("calibration.txt", "femur.stl", "tibia.stl", "masks", "frames"):
            (self.folder / name).symlink_to(DEMO / name)
        # As it stands, but for the size of the frames, which are smaller here.
        stated = "size=(1024, 1024)"
        self.assertIn(stated, found[1])
        program = found[1].replace(stated, f"size=({SIDE}, {SIDE})")
        said = io.StringIO()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        with redirect_stdout(said):
            exec(compile(program, "README.md", "exec"), {})
        self.assertEqual(said.getvalue().count("good -1"), 2, said.getvalue())
        for name in ("poses/femur.jts", "joint.csv", "joint.mot"):
            self.assertTrue((self.folder / name).is_file(), name)
        self.readers()

    def readers(self) -> None:
        """pandas takes the table, spm1d the rows, and a reader of OpenSim's files the motion."""
        import pandas
        import spm1d

        table = pandas.read_csv(self.folder / "joint.csv", comment="#")
        self.assertEqual(list(table["frame"]), [1, 2])
        self.assertEqual(table["flexion_deg"].dtype, np.float64)
        lines = (self.folder / "joint.mot").read_text(encoding="utf-8").splitlines()
        head = dict(line.split("=") for line in lines[1 : lines.index("endheader")] if "=" in line and line[0] != "#")
        body = pandas.read_csv(self.folder / "joint.mot", sep="\t", skiprows=lines.index("endheader") + 1)
        self.assertEqual(body.shape, (int(head["nRows"]), int(head["nColumns"])))
        np.testing.assert_allclose(body["time"], [0.0, 1 / 15])
        np.testing.assert_array_equal(body["flexion_deg"], table["flexion_deg"])
        one = np.linspace(0.0, 60.0, 101)
        rows = np.stack([one + noise for noise in np.random.default_rng(1).normal(0, 2, (6, 101))])
        joint = fp.kinematics(
            DEMO / "femur.jts", DEMO / "tibia.jts", femur_model=self.femur, tibia_model=self.tibia, side="left"
        )
        rows[0] = joint.cycle("flexion_deg")
        test = spm1d.stats.ttest_paired(rows, rows[::-1] + 1.0).inference(0.05)
        self.assertEqual(np.shape(test.z), (101,))


class OnFrames(OnTheDemo):
    def test_poses_on_frames(self) -> None:
        given = ("--model", DEMO / "tibia.stl", "--calibration", DEMO / "calibration.txt")
        library, jts = self.folder / "tibia.library", self.folder / "tibia.jts"
        run("library", *given, "--out", library)
        beside = ("--role", "tibia", "--counterpart", DEMO / "femur.jts", "--counterpart-model", DEMO / "femur.stl")
        masks = ("--masks", DEMO / "masks/tibia", "--method", "image", "--frames", DEMO / "frames")
        run("pose", *given, "--library", library, *masks, *beside, "--out", jts)
        ours = fp.estimate_all(
            fp.read_frames(DEMO / "masks/tibia"),
            self.tibia,
            self.camera,
            frames=fp.read_frames(DEMO / "frames"),
            role="tibia",
            beside=DEMO / "femur.jts",
            beside_model=self.femur,
        )
        np.testing.assert_array_equal([one.pose.numbers for one in ours], fp.read_poses(jts))
        self.assertTrue(all(one.film for one in ours))


class FrameAlone(OnTheDemo):
    def test_an_implant_is_found_in_a_frame_without_a_mask(self) -> None:
        frame = fp.read_frames(DEMO / "frames")[0]
        row, column = np.argwhere(fp.read_frames(DEMO / "masks/femur")[0]).mean(0)
        truth = fp.read_poses(DEMO / "femur.jts")[0]
        for click in (None, (column, row)):
            found = fp.estimate(None, self.femur, self.camera, frame=frame, click=click)
            self.assertEqual(found.status, "good", found.because)
            off = np.array(found.pose.numbers) - truth
            np.testing.assert_allclose(off[[0, 1, 3, 4, 5]], 0, atol=1.0)
            self.assertLess(abs(off[2]), 3 * found.sd.z_mm)


class RealStudies(unittest.TestCase):
    def study(self, name: str) -> tuple[Path, dict[str, Any]]:
        folder = STUDIES / name
        if not (folder / "study.toml").is_file():
            skip(self, f"no study {name} in FLUOROPOSE_STUDIES")
        if sys.version_info < (3, 11):
            skip(self, "this Python reads no TOML")
        import tomllib

        return folder, tomllib.loads((folder / "study.toml").read_text(encoding="utf-8"))

    def test_left8_is_posed_as_by_the_command(self) -> None:
        folder, study = self.study("left8")
        camera = fp.Camera.from_intcalib(folder / study["calibration"])
        with tempfile.TemporaryDirectory() as place:
            for component in study["component"]:
                model, masks = folder / component["model"], folder / component["masks"]["cnn"]
                library, jts = Path(place) / "library", Path(place) / "poses.jts"
                given = ("--model", model, "--calibration", folder / study["calibration"])
                run("library", *given, "--out", library)
                found = ("--masks", masks, "--method", "refined", "--out", jts)
                # A tray without its femur may be its mirror image in every frame.
                run("pose", *given, "--library", library, *found, doubtful=True)
                ours = fp.estimate_all(fp.read_frames(masks), fp.Model.from_file(model), camera)
                np.testing.assert_array_equal([one.pose.numbers for one in ours], fp.read_poses(jts))

    def test_film70_uses_all_cores_and_another_thread_goes_on(self) -> None:
        folder, study = self.study("film70")
        models = {one["name"]: fp.Model.from_file(folder / one["model"]) for one in study["component"]}
        camera = fp.Camera.from_mayacam(folder / study["calibration"])
        counted = 0
        end = threading.Event()

        def count() -> None:
            nonlocal counted
            while not end.wait(0.001):
                counted += 1

        counter = threading.Thread(target=count, daemon=True)
        counter.start()
        wall = time.monotonic()
        film = fp.track(folder / study["frames"], models["femur"], models["tibia"], camera, study.get("side", "left"))
        wall = time.monotonic() - wall
        end.set()
        counter.join()
        busy = busy_threads()
        print(f"film70: {wall:.1f} s; {busy} of {os.cpu_count()} cores had their thread; the other thread counted {counted}")
        assert film.femur is not None
        self.assertGreater(sum(verdict == "good" for verdict in film.femur.verdict), 50)
        self.assertGreater(counted, 100 * wall)
        if busy is not None:
            self.assertGreaterEqual(busy, os.cpu_count() or 1)


def busy_threads() -> int | None:
    """Threads that had at least a third of a fair part of the work, where the system tells it: wall time does not, on a busy machine."""
    tasks = Path("/proc/self/task")
    if not tasks.is_dir():
        return None
    fields = [(task / "stat").read_text().rpartition(")")[2].split() for task in tasks.iterdir()]
    times = [int(one[11]) + int(one[12]) for one in fields]
    return sum(time >= sum(times) / (3 * (os.cpu_count() or 1)) for time in times)


class Notebook(unittest.TestCase):
    def test_it_runs_from_its_first_cell_to_its_last(self) -> None:
        import nbformat
        from nbclient import NotebookClient

        notebook = nbformat.read(HERE.parent / "examples/film.ipynb", as_version=4)
        os.environ["FLUOROPOSE_DEMO"] = str(DEMO.absolute())
        with tempfile.TemporaryDirectory() as place:
            where = {"metadata": {"path": place}}
            NotebookClient(notebook, timeout=600, kernel_name="python3", resources=where).execute()
        outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
        self.assertTrue(any("image/png" in output.get("data", {}) for output in outputs), "it draws")
