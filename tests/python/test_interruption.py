# SPDX-License-Identifier: Apache-2.0
"""Ctrl+C, other signals and exceptions of progress functions end calls; progress is reported band by band."""
import os
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy
import relief
from test_arrays import grid

LIMIT = 0.2  # Seconds from the signal to the exception.


def clocks():
    """Elapsed time, which other processes increase, and processor time, which other threads of this one increase."""
    return numpy.array([time.monotonic(), time.process_time()])


class Alarm:
    """Sends this process a signal after some seconds, and measures the time from then on."""

    def __init__(self, seconds, number=signal.SIGINT):
        self.thread = threading.Thread(target=self.send, args=(seconds, number))
        self.sent = None

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *exception):
        self.latency = 0.0 if self.sent is None else min(clocks() - self.sent)
        self.thread.join()

    def send(self, seconds, number):
        time.sleep(seconds)
        self.sent = clocks()
        os.kill(os.getpid(), number)


class Interruption(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        positions, texcoords, triangles = grid(400)
        cls.dense = relief.Mesh(positions, triangles, texcoords=texcoords)
        coarse, coarse_texcoords, coarse_triangles = grid(20)
        cls.low = relief.Mesh(coarse, coarse_triangles, texcoords=coarse_texcoords)
        cls.heights = numpy.random.default_rng(1).integers(0, 65536, (1024, 1024), dtype=numpy.uint16)

    def expect_end(self, call, seconds=0.1):
        """Expects that Ctrl+C ends a call that would run on for a long time."""
        with self.assertRaises(KeyboardInterrupt), relief.Execution(threads=1), Alarm(seconds) as alarm:
            call()
        self.assertLess(alarm.latency, LIMIT)

    def test_bakes_end(self):
        for options in ({"samples": 1024}, {"layers": ["occlusion"], "occlusion_rays": 65536}):
            with self.subTest(**options):
                self.expect_end(lambda: relief.bake(self.dense, self.low, (2048, 2048), **options), 0.5)

    def test_reductions_end(self):
        self.expect_end(lambda: relief.decimate(self.dense, max_error=1e-3))
        self.expect_end(lambda: relief.levels_of_detail(self.dense, [200000, 1000]))
        self.expect_end(lambda: relief.subdivide(self.low, levels=8))
        waves = numpy.random.default_rng(1).random((1024, 1024), numpy.float32)
        self.expect_end(lambda: relief.displace(self.low, waves, height=0.1, max_error=1e-4))
        self.expect_end(lambda: relief.surface_distance(self.dense, self.low))

    def test_unwrapping_ends(self):
        self.expect_end(lambda: relief.unwrap(self.dense), 0.3)

    def test_measuring_texture_coordinates_ends(self):
        positions, texcoords, triangles = grid(700)
        large = relief.Mesh(positions, triangles, texcoords=texcoords)
        for seconds in (0.5, 1.0, 1.5):  # While charts are found and compared, and boxes are sorted.
            with self.subTest(seconds):
                self.expect_end(lambda: relief.measure_texcoords(large, (4096, 4096)), seconds)

    def test_readers_end(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.jpg"
            relief.write_image(file, numpy.tile((self.heights // 256).astype("uint8"), (6, 6)))
            self.expect_end(lambda: relief.read_image(file))
            self.assertEqual(relief.read_image(file)[0].shape, (6144, 6144))

    def test_conversions_end(self):
        positions = numpy.zeros((20_000_000, 3))
        self.expect_end(lambda: relief.triangle_normals(positions, self.dense.triangles))
        image = numpy.zeros((8192, 8192))
        self.expect_end(lambda: relief.bump(image))

    def test_normals_end(self):
        positions, triangles = self.dense.positions, self.dense.triangles
        self.expect_end(lambda: relief.vertex_normals(positions, triangles, weld_tolerance=0.02))
        self.expect_end(lambda: relief.with_frames(self.dense, crease_degrees=10.0))

    def test_images_end(self):
        wide = numpy.tile(self.heights, (2, 2))
        self.expect_end(lambda: relief.bump(wide))
        normals = relief.decode_normals(relief.bump(self.heights, kernel="sobel3", wrap="repeat"))
        self.expect_end(lambda: relief.resize_normals(normals, 2500, 2500))
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.ktx2"
            levels = [numpy.tile(normals, (2, 2, 1))]
            self.expect_end(lambda: relief.write_texture(file, levels, quality="best"))
            self.assertEqual(os.listdir(folder), [])

    def test_large_resizes_end(self):
        normals = numpy.zeros((4096, 8192, 3), "float32")
        normals[..., 2] = 1.0
        for seconds in (0.05, 0.3):  # While the array is copied, and while it is resized.
            with self.subTest(seconds):
                self.expect_end(lambda: relief.resize_normals(normals, 4000, 3000), seconds)

    def test_pictures_end(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.ply"
            relief.write_mesh(file, self.low)
            scene = relief.Scene.load(file)
        scene.render(size=(64, 64), backend="osmesa")  # Loads the driver.
        for seconds in (0.05, 0.15):
            with self.subTest(seconds):
                self.expect_end(lambda: scene.render(size=(2400, 2400), samples=4, backend="osmesa"), seconds)

    def test_exceptions_of_file_names_are_kept(self):
        class Stop:
            def __fspath__(self):
                raise KeyboardInterrupt

        for read in (relief.read_image, relief.read_mesh, relief.Scene.load):
            with self.assertRaises(KeyboardInterrupt):
                read(Stop())
            with self.assertRaises(TypeError):
                read(1.5)

    def test_slow_writers_end(self):
        image = numpy.tile(self.heights.astype("float32"), (3, 3))
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.exr", "a.tif"):
                with self.subTest(name):
                    self.expect_end(lambda: relief.write_image(pathlib.Path(folder) / name, image))
            # A texture of one tile is nearly written after 0.1 s.
            normals = relief.decode_normals(relief.bump(self.heights, kernel="sobel3", wrap="repeat"))
            level = numpy.tile(normals, (3, 3, 1))
            file = pathlib.Path(folder) / "a.ktx2"
            self.expect_end(lambda: relief.write_texture(file, [level], quality="fast", zstd=22))
            self.assertEqual(os.listdir(folder), [])

    def test_tools_end(self):
        with self.assertRaises(KeyboardInterrupt), Alarm(0.3) as alarm:
            relief.run("relief-accuracy", "run", "all", "--json")
        self.assertLess(alarm.latency, LIMIT)
        children = pathlib.Path("/proc/thread-self/children").read_text(encoding="utf-8").split()
        names = [pathlib.Path(f"/proc/{child}/comm").read_text(encoding="utf-8").strip() for child in children]
        self.assertNotIn("relief-accuracy", names)

    def test_any_handler_that_raises_ends_a_call(self):
        class Timeout(Exception):
            pass

        def stop(number, frame):
            raise Timeout(number)

        before = signal.signal(signal.SIGUSR1, stop)
        try:
            with self.assertRaises(Timeout), Alarm(0.1, signal.SIGUSR1):
                relief.decimate(self.dense, max_error=1e-3)
        finally:
            signal.signal(signal.SIGUSR1, before)

    def test_a_handler_that_returns_changes_nothing(self):
        expected, _ = relief.decimate(self.dense, triangles=30000)
        handled = []
        before = signal.signal(signal.SIGUSR1, lambda number, frame: handled.append(number))
        try:
            with Alarm(0.05, signal.SIGUSR1):
                reduced, _ = relief.decimate(self.dense, triangles=30000)
        finally:
            signal.signal(signal.SIGUSR1, before)
        self.assertEqual(handled, [signal.SIGUSR1])
        numpy.testing.assert_array_equal(reduced.positions, expected.positions)


class Bands(unittest.TestCase):
    def test_a_bake_reports_each_band_on_the_calling_thread(self):
        positions, texcoords, triangles = grid(9)
        mesh = relief.Mesh(positions, triangles, texcoords=texcoords)
        threads, fractions = set(), []

        def show(fraction):
            threads.add(threading.get_ident())
            fractions.append(fraction)

        relief.bake(mesh, mesh, (64, 512), progress=show)
        self.assertEqual(fractions, [band / 8 for band in range(9)])
        self.assertEqual(threads, {threading.get_ident()})

    def test_a_progress_function_may_call_the_library(self):
        positions, texcoords, triangles = grid(50)
        mesh = relief.Mesh(positions, triangles, texcoords=texcoords)
        counts = []

        def show(stage, part):
            counts.append(len(relief.vertex_normals(positions, triangles)))

        with relief.Execution(progress=show):
            relief.with_frames(mesh, tangents="mikktspace")
        self.assertGreater(len(counts), 1)
