"""Long calls let other threads run and stop for Ctrl-C; what goes wrong in C++ is Python's exception."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np
import numpy.typing as npt
import patchlight
from cornell import BOX, SOURCE, box


def long_options() -> patchlight.AdaptiveOptions:
    """Minutes of work."""
    return patchlight.AdaptiveOptions(
        max_elements=200000, gather=patchlight.GatherOptions(rays=16384), final=patchlight.SolveOptions(tolerance=1e-9)
    )


class LongCalls(unittest.TestCase):
    def interrupted_after(self, call: object, delay: float) -> float:
        """Seconds from the signal to the exception."""
        sent: list[float] = []

        def send() -> None:
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(delay, send)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            call()  # type: ignore[operator]
        timer.join()
        return time.monotonic() - sent[0]

    def test_ctrl_c_ends_the_loop_within_a_second(self) -> None:
        scene, options = box(), long_options()
        self.assertLess(self.interrupted_after(lambda: patchlight.solve_adaptively(scene, options), 0.6), 1)
        # And leaves the module as it was.
        patchlight.triangulate(scene, patchlight.MeshingOptions(max_elements=100))

    def test_ctrl_c_ends_one_step_within_a_second(self) -> None:
        scene, options = box(), patchlight.AdaptiveOptions()
        options.form_factors = patchlight.FormFactorOptions(rays=16384)
        emitted = patchlight.emitted_light(scene, options)
        mesh = patchlight.triangulate(scene, patchlight.MeshingOptions(max_elements=5000))
        exchange = patchlight.Exchange(scene, patchlight.RayCaster(scene), mesh, emitted)
        self.assertLess(self.interrupted_after(lambda: patchlight.assemble(exchange, options), 0.3), 1)

    def test_other_threads_go_on(self) -> None:
        counted = 0
        done = threading.Event()

        def count() -> None:
            nonlocal counted
            while not done.is_set():
                counted += 1
                time.sleep(0.001)

        scene = box()
        thread = threading.Thread(target=count)
        thread.start()
        begin, counted = time.monotonic(), 0
        patchlight.solve_adaptively(scene, patchlight.AdaptiveOptions(max_elements=1500))
        took = time.monotonic() - begin
        during = counted
        done.set()
        thread.join()
        # Some hundred a second where both cores are busy; none at all if the lock were kept.
        self.assertGreater(during, 20 * took)

    def test_observer_is_called_on_the_calling_thread_and_may_end_the_loop(self) -> None:
        scene, options = box(), patchlight.AdaptiveOptions(max_elements=800)
        threads = set()

        def observe(step: patchlight.AdaptiveStep) -> None:
            threads.add(threading.get_ident())
            if step.cycle == 1:
                raise RuntimeError("seen enough")

        with self.assertRaisesRegex(RuntimeError, "seen enough"):
            patchlight.solve_adaptively(scene, options, observe)
        self.assertEqual(threads, {threading.get_ident()})

    def test_from_several_threads_at_once(self) -> None:
        scene, options = box(), patchlight.AdaptiveOptions(max_elements=400)
        found: list[npt.NDArray[np.float64]] = []

        def solve() -> None:
            found.append(patchlight.solve_adaptively(scene, options).B)

        threads = [threading.Thread(target=solve) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(found), 3)
        for B in found[1:]:
            np.testing.assert_array_equal(B, found[0])


class Errors(unittest.TestCase):
    def test_scenes(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            bad = Path(folder) / "room.obj"
            bad.write_text("v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n")
            with self.assertRaises(patchlight.SceneError) as caught:
                patchlight.read_scene(bad)
            by_command = subprocess.run(
                [os.environ["PATCHLIGHT_COMMAND"], "inspect", str(bad)], capture_output=True, text=True, check=False
            ).stderr
            self.assertIn(f"error[{caught.exception.code}]: {caught.exception}", by_command)
            self.assertEqual(caught.exception.code, "nonfinite")
            self.assertIsInstance(caught.exception, ValueError)
            with self.assertRaises(patchlight.SceneError):
                patchlight.read_scene(Path(folder) / "none.obj")
            with self.assertRaises(patchlight.SceneError):
                patchlight.read_solution(bad)

    def test_options(self) -> None:
        with self.assertRaisesRegex(ValueError, "discontinuity"):
            patchlight.AdaptiveOptions(refine="boht")  # type: ignore[arg-type]
        with self.assertRaisesRegex(TypeError, "max_egde"):
            patchlight.MeshingOptions(max_egde=1)  # type: ignore[call-arg]
        for bad in (-1.0, float("nan"), 21.0):
            with self.assertRaisesRegex(ValueError, "min_angle"):
                patchlight.MeshingOptions(min_angle=bad)
        with self.assertRaises(TypeError):
            patchlight.AdaptiveOptions(max_elements=-1)
        with self.assertRaisesRegex(ValueError, "refine"):
            mesh = patchlight.triangulate(box())
            patchlight.solve_adaptively(box(), patchlight.AdaptiveOptions(mesh=mesh.arrays))

    def test_what_does_not_belong_together(self) -> None:
        other = patchlight.read_scene(SOURCE / "data" / "scenes" / "furnace.obj")
        scene, options = box(), patchlight.AdaptiveOptions()
        mesh, emitted = patchlight.triangulate(scene), patchlight.emitted_light(scene, options)
        with self.assertRaises(ValueError):
            patchlight.Exchange(other, patchlight.RayCaster(other), mesh, emitted)
        with self.assertRaises(TypeError):
            patchlight.Exchange(None, patchlight.RayCaster(scene), mesh, emitted)  # type: ignore[arg-type]

    def test_more_rows_than_memory_holds(self) -> None:
        options = patchlight.AdaptiveOptions()
        options.form_factors.method = "exact"
        limit = 0.8 * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        elements = int((limit / 10) ** 0.5 * 1.3)  # ten bytes an entry: an upper estimate takes more
        if elements > 150_000:
            self.skipTest("this machine holds more than a test wants to mesh")
        scene = box()
        emitted = patchlight.emitted_light(scene, options)
        mesh = patchlight.triangulate(scene, patchlight.MeshingOptions(max_elements=elements))
        exchange = patchlight.Exchange(scene, patchlight.RayCaster(scene), mesh, emitted)
        with self.assertRaisesRegex(MemoryError, "hierarchical"):
            patchlight.assemble(exchange, options)

    def test_warnings_are_pythons(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "box.obj"
            scene.write_text(BOX.read_text().replace("mtllib ", "mtllib gone-"))
            with self.assertWarns(UserWarning):
                patchlight.read_scene(scene, patchlight.SceneOptions(require_emitter=False))


if __name__ == "__main__":
    unittest.main()
