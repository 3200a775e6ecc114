"""Ctrl-C ends a call within a second, and other threads go on while it works."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import fluoropose as fp
from study import DEMO, OnTheDemo

# Of all processors, as this program uses them: by the clock others may take their time.
A_SECOND = float(os.cpu_count() or 1)


class Threads(OnTheDemo):
    def test_progress_is_told_and_may_end_the_work(self) -> None:
        steps: list[tuple[int, int, str]] = []
        fixed = {"femur": fp.read_poses(DEMO / "femur.jts")}
        fixed["femur"][1] = np.nan
        fp.track(
            DEMO / "frames",
            self.femur,
            None,
            self.camera,
            "left",
            fixed=fixed,
            progress=lambda done, of, what: steps.append((done, of, what)),
        )
        self.assertEqual(steps[-1], (2, 2, "done"))
        self.assertEqual(sorted(steps, key=lambda step: step[0]), steps)
        self.assertTrue(all(of == 2 and what for _, of, what in steps))
        # The steps of a search too, which takes seconds.
        def until(done: int, of: int, what: str) -> None:
            if "% searched" in what:
                raise LookupError(what)

        with self.assertRaisesRegex(LookupError, r"frame \d: \d+ % searched"):
            fp.track(DEMO / "frames", self.femur, self.tibia, self.camera, "left", progress=until)
        blank, told = np.full((1, 128, 128), 200, np.uint8), list[str]()
        camera = fp.Camera([[600, 0, 63.5], [0, 600, 63.5], [0, 0, 1]], (128, 128))
        fp.track(blank, self.femur, None, camera, "left", progress=lambda done, of, what: told.append(what))
        for words in ("femur: looked for in frame 1", "femur frame 1: searched", "femur frame 1: compared with views from"):
            self.assertTrue(any(words in what for what in told), told)
        called: list[float] = []

        def enough(done: int, of: int, what: str) -> None:
            called.append(time.process_time())
            raise LookupError(f"{what}: enough")

        with self.assertRaisesRegex(LookupError, r"looked for in frame \d: enough"):
            fp.track(DEMO / "frames", self.femur, self.tibia, self.camera, "left", progress=enough)
        self.assertEqual(len(called), 1)
        self.assertLess(time.process_time() - called[0], A_SECOND)

    @unittest.skipIf(os.name == "nt", "signals are told otherwise there")
    def test_the_command_ends_without_a_word_where_nobody_reads(self) -> None:
        words = [sys.executable, "-m", "fluoropose", "batch", "--help"]
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as command:
            assert command.stdout is not None and command.stderr is not None
            command.stdout.close()
            said = command.stderr.read()
        self.assertEqual((command.returncode, said), (-signal.SIGPIPE, b""))

    @unittest.skipIf(os.name == "nt", "signals are told otherwise there")
    def test_ctrl_c_ends_a_film_and_a_stack_of_masks(self) -> None:
        # A program that was started in the background would not hear it.
        self.addCleanup(signal.signal, signal.SIGINT, signal.getsignal(signal.SIGINT))
        signal.signal(signal.SIGINT, signal.default_int_handler)
        masks = np.repeat(fp.read_frames(DEMO / "masks/femur")[:1], 300, axis=0)
        calls = {
            "track": lambda: fp.track(DEMO / "frames", self.femur, self.tibia, self.camera, "left"),
            "estimate": lambda: fp.estimate_all(masks, self.femur, self.camera),
        }
        for name, call in calls.items():
            pressed: list[float] = []

            def press() -> None:
                # Another thread comes to its turn many times meanwhile, or this one ends without having been pressed.
                begun = time.monotonic()
                counted = 0
                while counted < 50 or time.monotonic() - begun < 0.7:
                    time.sleep(0.001)
                    counted += 1
                pressed.append(time.process_time())
                os.kill(os.getpid(), signal.SIGINT)

            presser = threading.Thread(target=press, daemon=True)
            presser.start()
            with self.assertRaises(KeyboardInterrupt, msg=f"{name} ended before, or held the other thread up"):
                call()
            took = time.process_time() - pressed[0]
            presser.join()
            self.assertLess(took, A_SECOND, name)
