"""All there is can be pickled and copied, and works in other processes."""

from __future__ import annotations

import copy
import dataclasses
import multiprocessing
import pickle
import unittest
from typing import Any, ClassVar

import numpy as np

import fluoropose as fp
from study import DEMO, SIDE, OnTheDemo


def pose(given: tuple[fp.Model, fp.Camera, Any]) -> fp.Estimate:
    """What another process does."""
    model, camera, mask = given
    return fp.estimate(mask, model, camera, nominal=(0.0, 0.0))


class Copies(OnTheDemo):
    film: ClassVar[fp.Track]

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        fixed = {name: fp.read_poses(DEMO / f"{name}.jts") for name in ("femur", "tibia")}
        cls.film = fp.track(DEMO / "frames", cls.femur, cls.tibia, cls.camera, "left", 15.0, fixed=fixed)

    def test_models_and_cameras_are_the_same_after_pickling(self) -> None:
        of_matrix = fp.Camera(self.camera.matrix(SIDE, SIDE), (SIDE, SIDE))
        for camera in (self.camera, of_matrix):
            for other in (pickle.loads(pickle.dumps(camera)), copy.copy(camera), copy.deepcopy(camera)):
                self.assertEqual(other, camera)
                np.testing.assert_array_equal(other.matrix(SIDE, SIDE), camera.matrix(SIDE, SIDE))
        for other in (pickle.loads(pickle.dumps(self.tibia)), copy.copy(self.tibia), copy.deepcopy(self.tibia)):
            self.assertEqual((other.digest, other.path, other.remarks), (self.tibia.digest, self.tibia.path, self.tibia.remarks))
            np.testing.assert_array_equal(other.vertices, self.tibia.vertices, strict=True)
            np.testing.assert_array_equal(other.faces, self.tibia.faces, strict=True)

    def test_results_are_the_same_after_pickling(self) -> None:
        film = self.film
        other: fp.Track = pickle.loads(pickle.dumps(film))
        assert film.femur is not None and other.femur is not None
        np.testing.assert_array_equal(other.femur.pose, film.femur.pose)
        self.assertEqual(other.femur.because, film.femur.because)
        self.assertEqual(repr(other.femur), "Poses('femur', 2 frames: 2 fixed)")
        joints = [one.kinematics(cutoff_hz=3.0) for one in (film, other)]
        joints.append(pickle.loads(pickle.dumps(joints[0])))
        texts = []
        for number, joint in enumerate(joints):
            np.testing.assert_array_equal(joint.values, joints[0].values)
            np.testing.assert_array_equal(joint.by_flexion.mean, joints[0].by_flexion.mean)
            np.testing.assert_array_equal(joint.cycle("flexion_deg"), joints[0].cycle("flexion_deg"))
            file = self.folder / f"{number}.csv"
            joint.to_csv(file)
            texts.append(file.read_bytes())
        self.assertEqual(texts[1:], texts[:1] * 2)

    def test_equality_is_of_what_they_hold_and_nan_is_nan(self) -> None:
        masks = [fp.read_frames(DEMO / "masks/femur")[0], np.zeros((SIDE, SIDE), bool)]
        found, nothing = (fp.estimate(mask, self.femur, self.camera) for mask in masks)
        film = self.film
        joint = film.kinematics()
        for one in (found, nothing, nothing.pose, found.rivals, film, film.femur, joint, joint.by_flexion, self.femur):
            other = pickle.loads(pickle.dumps(one))
            self.assertEqual(one, other)
            self.assertEqual(hash(one), hash(other))
            self.assertEqual(one, copy.deepcopy(one))
        assert film.femur is not None
        self.assertNotEqual(found, nothing)
        self.assertNotEqual(film.femur, film.tibia)
        self.assertNotEqual(self.femur, self.tibia)
        self.assertNotEqual(found.pose, dataclasses.replace(found.pose, x_mm=float("nan")))
        moved = film.femur.pose.copy()
        moved[1, 2] += 1e-9
        self.assertNotEqual(film.femur, dataclasses.replace(film.femur, pose=moved))
        self.assertNotEqual(found, 1)

    def test_other_processes_find_the_same(self) -> None:
        """Also those that are forked when threads of this one were at work: they have threads of their own."""
        masks = fp.read_frames(DEMO / "masks/femur")
        given = [(self.femur, self.camera, mask) for mask in masks]
        ours = [pose(one) for one in given]
        for method in multiprocessing.get_all_start_methods():
            if method == "forkserver":
                continue
            with multiprocessing.get_context(method).Pool(1) as pool:
                theirs = pool.map_async(pose, given).get(timeout=600)
            for own, other in zip(ours, theirs, strict=True):
                self.assertEqual((own.pose, own.sd, own.status, own.rivals), (other.pose, other.sd, other.status, other.rivals))


if __name__ == "__main__":
    unittest.main()
