# SPDX-License-Identifier: Apache-2.0
"""Arrays in and out: views without copies, conversions, shapes that are refused, exceptions, reports and threads."""
import copy
import json
import os
import pathlib
import pickle
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy
import relief

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"


def grid(side, dtype="uint32"):
    """A wave over the unit square: positions, texture coordinates and triangles."""
    v, u = numpy.meshgrid(numpy.linspace(0, 1, side), numpy.linspace(0, 1, side), indexing="ij")
    positions = numpy.stack([u, 1 - v, 0.1 * numpy.sin(6 * u + 4 * v)], axis=-1).reshape(-1, 3)
    first = (numpy.arange(side - 1)[:, None] * side + numpy.arange(side - 1)).reshape(-1)
    corners = [first, first + side, first + side + 1, first, first + side + 1, first + 1]
    texcoords = numpy.stack([u, v], axis=-1).reshape(-1, 2)
    return (positions.astype("float32"), texcoords.astype("float32"),
            numpy.stack(corners, axis=-1).reshape(-1, 3).astype(dtype))


class Views(unittest.TestCase):
    """Arrays are read and written where they are."""

    def test_interleaved_buffer(self):
        positions, texcoords, triangles = grid(33, "uint16")
        vertices = numpy.zeros(len(positions), dtype=[("position", "f4", 3), ("normal", "f4", 3),
                                                      ("tangent", "f4", 4), ("texcoord", "f4", 2)])
        vertices["position"], vertices["texcoord"] = positions, texcoords
        result = relief.vertex_normals(vertices["position"], triangles, out=vertices["normal"])
        self.assertTrue(numpy.shares_memory(result, vertices))
        relief.vertex_tangents(vertices["position"], vertices["normal"], vertices["texcoord"], triangles,
                               out=vertices["tangent"])
        packed = relief.vertex_normals(positions, triangles.astype("uint32"))
        numpy.testing.assert_array_equal(vertices["normal"], packed)
        numpy.testing.assert_array_equal(
            vertices["tangent"], relief.vertex_tangents(positions, packed, texcoords, triangles))
        numpy.testing.assert_array_equal(vertices["position"], positions)

    def test_mesh_attributes_are_views(self):
        positions, texcoords, triangles = grid(5)
        mesh = relief.Mesh(positions, triangles, texcoords=texcoords)
        mesh.positions[:, 2] = 2.0
        self.assertEqual(mesh.positions[7, 2], 2.0)
        self.assertNotEqual(positions[7, 2], 2.0)
        self.assertIsNone(mesh.normals)
        view = mesh.positions
        del mesh  # The view keeps the memory.
        self.assertEqual(view[24, 2], 2.0)

    def test_input_is_not_copied(self):
        # A process of its own, because peak memory never decreases.
        script = """
import numpy, resource, relief
def peak(): return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
positions = numpy.random.default_rng(1).random((8_000_000, 3), dtype=numpy.float32)
triangles = numpy.zeros((1, 3), dtype=numpy.uint32)
relief.triangle_normals(positions[:9], triangles)
before = peak()
relief.triangle_normals(positions, triangles)
print((peak() - before) / positions.nbytes)
"""
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        self.assertLess(float(done.stdout), 0.1)

    def test_result_owns_its_memory(self):
        positions, _, triangles = grid(9)
        normals = relief.triangle_normals(positions, triangles)
        before = normals.copy()
        for _ in range(20):
            relief.triangle_normals(positions + 1.0, triangles)
        numpy.testing.assert_array_equal(normals, before)
        self.assertTrue(normals.flags.writeable)


class Vectors:
    """Gives numpy an array as the vectors of Open3D do."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array


class Conversions(unittest.TestCase):
    """Other numbers and layouts are converted to the same results, which the report states."""

    def setUp(self):
        self.positions, self.texcoords, self.triangles = grid(5)
        self.normals = relief.vertex_normals(self.positions, self.triangles)

    def expect_normals(self, positions, triangles, *kinds):
        report = []
        numpy.testing.assert_array_equal(relief.vertex_normals(positions, triangles, report=report), self.normals)
        self.assertEqual([finding["kind"] for finding in report], [f"converted {kind}" for kind in kinds])
        return report

    def test_types(self):
        for dtype in ("float64", ">f4", "longdouble"):
            with self.subTest(dtype):
                self.expect_normals(self.positions.astype(dtype), self.triangles, "positions")
        for dtype in ("int64", "uint64", "uint8", "int8", ">u4", ">i4"):
            with self.subTest(dtype):
                self.expect_normals(self.positions, self.triangles.astype(dtype), "triangles")
        report = self.expect_normals(self.positions.astype("float64"), self.triangles.astype("int64"),
                                     "positions", "triangles")
        self.assertEqual([(finding["count"], finding["outcome"]) for finding in report],
                         [(75, "float64 copied to float32, 0.0003 MB"), (96, "int64 copied to uint32, 0.000384 MB")])

    def test_signed_indices_of_16_and_32_bits_are_not_copied(self):
        for dtype in ("int16", "int32"):
            with self.subTest(dtype), relief.Execution(strict=True):
                self.expect_normals(self.positions, self.triangles.astype(dtype))

    def test_layouts(self):
        unaligned = numpy.zeros(25, dtype=[("flag", "u1"), ("position", "f4", 3)])["position"]
        unaligned[:] = self.positions
        for positions in (numpy.asfortranarray(self.positions), self.positions[::-1].copy()[::-1], unaligned):
            self.expect_normals(positions, self.triangles, "positions")
        wide = numpy.zeros((32, 4), "uint32")
        wide[:, :3] = self.triangles
        self.expect_normals(self.positions, wide[:, :3], "triangles")
        self.expect_normals(self.positions, numpy.asfortranarray(self.triangles), "triangles")

    def test_objects_that_give_arrays(self):
        self.expect_normals(Vectors(self.positions.astype("float64")), Vectors(self.triangles.astype("int32")),
                            "positions")
        self.expect_normals(memoryview(self.positions), memoryview(self.triangles))

    def test_rounding_is_reported(self):
        report = []
        relief.vertex_normals(self.positions.astype("float64") + 0.1, self.triangles, report=report)
        self.assertTrue(report[0]["outcome"].endswith(", rounded to 24 bits"), report)

    def test_distant_positions_keep_their_digits(self):
        positions, _, triangles = grid(9)
        distant = positions.astype("float64") + (500000.0, 4000000.0, 0.0)
        report = []
        numpy.testing.assert_array_equal(relief.vertex_normals(distant, triangles, report=report),
                                         relief.vertex_normals(positions, triangles))
        self.assertRegex(report[0]["outcome"], r"relative to \(50000[01], 400000[01], 0\)$")
        mesh = relief.Mesh(distant, triangles)
        self.assertEqual(mesh.origin[2], 0.0)
        numpy.testing.assert_allclose(mesh.positions + numpy.array(mesh.origin), distant, atol=1e-9)
        # As a file does.
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "distant.obj")
            lines = [f"v {x} {y} {z}" for x, y, z in distant]
            lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
            file.write_text("\n".join(lines) + "\n", encoding="utf-8")
            stored = relief.read_mesh(file)
        self.assertEqual(stored.origin, mesh.origin)
        numpy.testing.assert_array_equal(stored.positions[stored.triangles], mesh.positions[mesh.triangles])

    def test_images(self):
        height = numpy.random.default_rng(1).random((8, 8), dtype=numpy.float32)
        report = []
        numpy.testing.assert_array_equal(relief.bump(height.astype("float64"), kernel="sobel3", report=report),
                                         relief.bump(height, kernel="sobel3"))
        self.assertEqual(report[0]["kind"], "converted height")
        self.assertEqual(report[0]["outcome"], "float64 rounded to float32")

    def test_meshes(self):
        mesh = relief.Mesh(self.positions.astype("float64"), self.triangles.astype("int64"),
                           texcoords=self.texcoords.astype("float16"), smoothing_groups=numpy.ones(32, "int64"))
        numpy.testing.assert_array_equal(mesh.positions, self.positions)
        numpy.testing.assert_array_equal(mesh.texcoords, self.texcoords)

    def test_values_that_do_not_fit(self):
        with self.assertRaisesRegex(relief.InvalidInput, "triangles: row 31 has -2, expected 0 to 4294967295"):
            triangles = self.triangles.astype("int64")
            triangles[31, 1] = -2
            relief.vertex_normals(self.positions, triangles)
        with self.assertRaisesRegex(relief.InvalidInput, "triangles: row 31 has -2, expected at least 0"):
            relief.vertex_normals(self.positions, triangles.astype("int32"))
        with self.assertRaisesRegex(relief.InvalidInput, "triangles: row 0 has 18446744073709551615, expected"):
            relief.vertex_normals(self.positions, numpy.full((1, 3), 2**64 - 1, "uint64"))
        with self.assertRaisesRegex(relief.InvalidInput, "positions: row 0 has 1e.300, but float32 holds at most"):
            relief.vertex_normals(numpy.array([(1e300, 0, 0), (0, 0, 0)]), self.triangles[:0])


class Copies(unittest.TestCase):
    def test_meshes_are_copied_and_pickled_whole(self):
        mesh = relief.read_mesh(DATA / "urn-low.obj")
        mesh, _ = relief.with_frames(mesh, normals="angle", tangents="mikktspace")
        for name, other in {"copy": copy.copy(mesh), "deepcopy": copy.deepcopy(mesh),
                            "pickle": pickle.loads(pickle.dumps(mesh))}.items():
            with self.subTest(name):
                self.assertEqual((other.name, other.origin), (mesh.name, mesh.origin))
                for attribute in ("positions", "triangles", "normals", "texcoords", "tangents", "colors"):
                    numpy.testing.assert_array_equal(getattr(other, attribute), getattr(mesh, attribute))
                self.assertFalse(numpy.shares_memory(other.positions, mesh.positions))
        empty = pickle.loads(pickle.dumps(relief.Mesh(numpy.zeros((0, 3)), numpy.zeros((0, 3), int))))
        self.assertIsNone(empty.positions)

    def test_smoothing_groups_are_pickled(self):
        positions, _, triangles = grid(5)
        mesh = relief.Mesh(positions, triangles, smoothing_groups=numpy.arange(32, dtype="uint32"))
        expected, _ = relief.with_frames(mesh, normals="angle")
        again, _ = relief.with_frames(pickle.loads(pickle.dumps(mesh)), normals="angle")
        numpy.testing.assert_array_equal(again.normals, expected.normals)
        self.assertGreater(len(again.positions), len(positions))

    def test_errors_of_other_processes_arrive_whole(self):
        error = pickle.loads(pickle.dumps(relief.ToolError("failed", 2, "output")))
        self.assertEqual((str(error), error.exit_code, error.output), ("failed", 2, "output"))
        self.assertEqual(str(pickle.loads(pickle.dumps(relief.InvalidInput("wrong")))), "wrong")

    def test_scenes_are_copied(self):
        positions, _, triangles = grid(5)
        scene = relief.Scene(relief.Mesh(positions, triangles))
        other = copy.deepcopy(scene)
        other.exposure = 2.0
        self.assertEqual(scene.exposure, 1.0)
        with self.assertRaisesRegex(TypeError, "cannot pickle"):
            pickle.dumps(scene)

    def test_short_texts(self):
        positions, texcoords, triangles = grid(5)
        mesh = relief.Mesh(positions, triangles, texcoords=texcoords)
        self.assertEqual(repr(mesh), "<relief.Mesh of 25 vertices and 32 triangles>")
        self.assertEqual(repr(relief.Scene(mesh)), "<relief.Scene, instances: 1, meshes: 1, materials: 1>")
        self.assertEqual(repr(relief.Execution(threads=2)), "<relief.Execution, threads: 2>")
        baked = relief.bake(mesh, mesh, (8, 4), layers=["normals", "heights"])
        self.assertEqual(repr(baked), "<relief.Baked of 8 x 4 texels: normals, heights>")
        self.assertEqual(repr(relief.unwrap(mesh, size=(64, 64))), "<relief.Unwrapped of 32 triangles in 1 charts>")


class Refusals(unittest.TestCase):
    """Wrong arrays and options give errors that name the argument, the value and the remedy."""

    def setUp(self):
        self.positions, self.texcoords, self.triangles = grid(5)

    def test_types(self):
        with self.assertRaisesRegex(TypeError, "triangles: float64 .*astype"):
            relief.vertex_normals(self.positions, self.triangles.astype("float64"))
        with self.assertRaisesRegex(TypeError, "positions: complex64 .*astype"):
            relief.vertex_normals(self.positions.astype("complex64"), self.triangles)
        with self.assertRaisesRegex(TypeError, "positions: expected a numpy array .*, not list"):
            relief.vertex_normals(self.positions.tolist(), self.triangles)
        with self.assertRaisesRegex(TypeError, "height: int64 .*uint16"):
            relief.bump(numpy.zeros((4, 4), "int64"))
        with self.assertRaisesRegex(TypeError, "out: float64"):
            relief.vertex_normals(self.positions, self.triangles, out=numpy.zeros((25, 3)))

    def test_strict_blocks_refuse_conversions(self):
        with relief.Execution(strict=True), relief.Execution():
            with self.assertRaisesRegex(TypeError, r"positions: float64 of shape \(25, 3\), expected float32 of shape "
                                                   r"\(n, 3\) \(convert it: positions.astype\(numpy.float32\)\)"):
                relief.vertex_normals(self.positions.astype("float64"), self.triangles)
            with self.assertRaisesRegex(TypeError, "triangles: int64 .*astype"):
                relief.vertex_normals(self.positions, self.triangles.astype("int64"))
            with self.assertRaisesRegex(TypeError, "positions: >f4|positions: float32"):
                relief.vertex_normals(self.positions.astype(">f4"), self.triangles)
            with self.assertRaisesRegex(TypeError, "height: float64"):
                relief.bump(numpy.zeros((4, 4)))
            with self.assertRaisesRegex(relief.InvalidInput, "reverse order .*ascontiguousarray"):
                relief.vertex_normals(self.positions[::-1], self.triangles)
            with self.assertRaisesRegex(relief.InvalidInput, "not adjacent"):
                relief.vertex_normals(numpy.asfortranarray(self.positions), self.triangles)
            with self.assertRaisesRegex(relief.InvalidInput, "triangles: the values have gaps"):
                relief.vertex_normals(self.positions, self.triangles[::2])
        relief.vertex_normals(self.positions[::-1], self.triangles)

    def test_shapes(self):
        with self.assertRaisesRegex(relief.InvalidInput, r"positions: float32 of shape \(25, 2\), expected"):
            relief.vertex_normals(self.texcoords, self.triangles)
        with self.assertRaisesRegex(ValueError, r"triangles: uint32 of shape \(96,\)"):
            relief.vertex_normals(self.positions, self.triangles.reshape(-1))
        with self.assertRaisesRegex(relief.InvalidInput, "out: 24 rows for 25 positions"):
            relief.vertex_normals(self.positions, self.triangles, out=numpy.zeros((24, 3), "float32"))
        with self.assertRaisesRegex(relief.InvalidInput, "1 to 4 channels"):
            relief.decode_normals(numpy.zeros((4, 4, 5), "uint8"))
        with self.assertRaisesRegex(relief.InvalidInput, "normals: .* \\(4,\\)"):
            relief.encode_normals(numpy.zeros(4, "float32"))

    def test_layouts(self):
        target = numpy.zeros_like(self.positions)
        with self.assertRaisesRegex(relief.InvalidInput, "out: the rows are in reverse order .*ascontiguousarray"):
            relief.vertex_normals(self.positions, self.triangles, out=target[::-1])
        with self.assertRaisesRegex(relief.InvalidInput, "out: the values of a row are not adjacent"):
            relief.vertex_normals(self.positions, self.triangles, out=numpy.asfortranarray(target))
        unaligned = numpy.zeros(25, dtype=[("flag", "u1"), ("position", "f4", 3)])["position"]
        with self.assertRaisesRegex(relief.InvalidInput, "not aligned"):
            relief.vertex_normals(self.positions, self.triangles, out=unaligned)
        frozen = numpy.zeros_like(self.positions)
        frozen.flags.writeable = False
        with self.assertRaisesRegex(relief.InvalidInput, "out: the array is read-only"):
            relief.vertex_normals(self.positions, self.triangles, out=frozen)
        with self.assertRaisesRegex(relief.InvalidInput, "also the input"):
            relief.vertex_normals(self.positions, self.triangles, out=self.positions)

    def test_masked_values(self):
        hidden = numpy.zeros(self.positions.shape, bool)
        whole = numpy.ma.masked_array(self.positions, hidden)
        numpy.testing.assert_array_equal(relief.vertex_normals(whole, self.triangles),
                                         relief.vertex_normals(self.positions, self.triangles))
        hidden[3, 1] = True
        with self.assertRaisesRegex(relief.InvalidInput, r"positions: has masked values .*positions\.filled\(0\)"):
            relief.vertex_normals(numpy.ma.masked_array(self.positions, hidden), self.triangles)

    def test_wrong_arguments_have_short_errors(self):
        height = numpy.zeros((64, 64), "uint16")

        def error_of(call):
            with self.assertRaises(TypeError) as refused:
                call()
            return str(refused.exception)

        self.assertEqual(error_of(lambda: relief.bump(height, kernal="sobel3")),
                         "bump() has no argument 'kernal': did you mean 'kernel'?")
        self.assertEqual(error_of(lambda: relief.Scene.load("a.gltf", zz=1)),
                         "Scene.load() has no argument 'zz': its arguments are file, studio, assume, report")
        self.assertEqual(error_of(lambda: relief.Mesh(self.positions, self.triangles, texcoord=self.texcoords)),
                         "Mesh() has no argument 'texcoord': did you mean 'texcoords'?")
        self.assertEqual(error_of(lambda: relief.Execution(thread=1)),
                         "Execution() has no argument 'thread': did you mean 'threads'?")
        self.assertRegex(error_of(lambda: relief.bump(height, strength="high")),
                         r"^bump\(\) got \(ndarray, strength: str\), expected \(height: Image, .*strength: float")
        self.assertRegex(error_of(lambda: relief.vertex_normals(self.positions)),
                         r"^vertex_normals\(\): missing a required argument: 'triangles'; expected ")
        self.assertEqual(error_of(lambda: relief.bake(None, None, (4, 4), layer=["normals"])),
                         "bake() has no argument 'layer': did you mean 'layers'?")

    def test_values(self):
        with self.assertRaisesRegex(relief.InvalidInput, "triangle 0 names vertex 5, but there are only 5"):
            relief.vertex_normals(self.positions[:5], self.triangles)
        with self.assertRaisesRegex(relief.InvalidInput, "weight: 'heavy' is not one of auto, uniform"):
            relief.vertex_normals(self.positions, self.triangles, weight="heavy")
        with self.assertRaisesRegex(relief.InvalidInput, "tolerance"):
            relief.vertex_normals(self.positions, self.triangles, weld_tolerance=float("nan"))
        with self.assertRaises(relief.InvalidInput):
            relief.resize_normals(numpy.ones((4, 4, 3), "float32"), -1, 4)
        with self.assertRaises(TypeError):
            relief.split_vertices(-1, self.triangles, numpy.zeros((32, 3, 3), "float32"))
        mesh = relief.Mesh(self.positions, self.triangles, texcoords=self.texcoords)
        with self.assertRaisesRegex(relief.InvalidInput, "size: -4 x 4 texels"):
            relief.bake(mesh, mesh, (-4, 4))
        with self.assertRaisesRegex(relief.InvalidInput, "size: 0 x 4 pixels"):
            relief.Scene(mesh).render(size=(0, 4))

    def test_meshes_whose_triangles_were_changed(self):
        mesh = relief.Mesh(self.positions, self.triangles, texcoords=self.texcoords)
        mesh.triangles[0, 0] = 100_000_000
        for work in (
            lambda: relief.bake(mesh, mesh, (4, 4)),
            lambda: relief.check_mesh(mesh),
            lambda: relief.compare_meshes(mesh, mesh),
            lambda: relief.decimate(mesh, triangles=4),
            lambda: relief.displace(mesh, numpy.zeros((4, 4), numpy.uint8), height=1.0),
            lambda: relief.levels_of_detail(mesh, [4]),
            lambda: relief.subdivide(mesh, 1),
            lambda: relief.surface_distance(mesh, mesh),
            lambda: relief.with_frames(mesh),
            lambda: relief.write_mesh(pathlib.Path(tempfile.gettempdir(), "changed.obj"), mesh),
            lambda: relief.Scene(mesh),
        ):
            with self.assertRaisesRegex(relief.InvalidInput, "triangle 0 names vertex 100000000, but"):
                work()

    def test_files(self):
        with self.assertRaisesRegex(relief.FileError, "missing.obj: no such file") as caught:
            relief.read_mesh("missing.obj")
        self.assertIsInstance(caught.exception, OSError)
        self.assertIsInstance(caught.exception, relief.Error)
        with self.assertRaisesRegex(relief.FileError, r"b\\xe4r.obj: no such file"):
            relief.read_mesh(os.fsdecode(b"b\xe4r.obj"))
        with self.assertRaises(relief.ToolError) as failed:
            relief.run("relief-mesh", "check", "--unknown")
        self.assertEqual(failed.exception.exit_code, 2)
        with self.assertRaisesRegex(relief.FileError, "relief-none: not found"):
            relief.run("relief-none")

    def test_far_apart_meshes(self):
        low = relief.Mesh(self.positions, self.triangles, texcoords=self.texcoords)
        high = relief.Mesh(self.positions + numpy.float32(50), self.triangles)
        with self.assertRaises(relief.BakeMismatch):
            relief.bake(high, low, (8, 8))


class Reports(unittest.TestCase):
    def test_findings(self):
        positions, _, triangles = grid(5)
        positions[7] = numpy.nan
        report = []
        normals = relief.vertex_normals(positions, triangles, report=report)
        self.assertTrue(numpy.isfinite(normals).all())
        kinds = {finding["kind"]: finding for finding in report}
        self.assertGreater(len(kinds), 0)
        for finding in report:
            self.assertEqual(list(finding), ["kind", "element", "count", "first", "outcome"])
        self.assertIn(7, [index for finding in report if finding["element"] == "vertex" for index in finding["first"]])

    def test_findings_name_files_that_are_not_utf8(self):
        with tempfile.TemporaryDirectory() as folder:
            model = pathlib.Path(folder, "a.obj")
            model.with_suffix(".mtl").write_bytes(b"newmtl a\nmap_Kd b\xe4r.png\n")
            model.write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n")
            report = []
            relief.Scene.load(model).render(size=(8, 8), report=report)
        self.assertIn(r"b\xe4r.png", "".join(finding["outcome"] for finding in report))

    def test_maps_of_another_kind_in_models_are_findings(self):
        with tempfile.TemporaryDirectory() as folder:
            model = pathlib.Path(folder, "a.obj")
            shutil.copy(DATA / "bricks-diffuse.png", folder)
            model.with_suffix(".mtl").write_text("newmtl a\nKd 1 1 1\nnorm bricks-diffuse.png\n")
            model.write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                             "usemtl a\nf 1/1 2/2 3/3\n")
            for assume, kinds in (
                    ([], ["normal map that is not a normal map: its texels are colors, or several masks"]),
                    (["height", "normal"], [])):
                report = []
                relief.Scene.load(model, assume=assume, report=report).render(size=(8, 8), report=report)
                self.assertEqual([finding["kind"] for finding in report], kinds)

    def test_list_is_needed(self):
        positions, _, triangles = grid(5)
        with self.assertRaises(TypeError):
            relief.vertex_normals(positions, triangles, report={})


class MapKinds(unittest.TestCase):
    """Arrays whose texels are clearly another kind of map are refused, unless `assume` names the kind."""

    @classmethod
    def setUpClass(cls):
        cls.photo, _ = relief.read_image(DATA / "bricks-diffuse.png")
        cls.heights, _ = relief.read_image(DATA / "bricks-height.png")
        cls.normals = relief.bump(cls.heights, bits=8)
        positions, texcoords, triangles = grid(5)
        cls.mesh, _ = relief.with_frames(relief.Mesh(positions, triangles, texcoords=texcoords), tangents="mikktspace")

    def expect_refusal(self, call, message, kind):
        with self.assertRaises(relief.InvalidInput) as raised:
            call()
        self.assertEqual(str(raised.exception), f'{message}; assume="{kind}" reads it anyway)')
        call(assume=kind)
        with self.assertRaisesRegex(relief.InvalidInput, "assume"):
            call(assume="color")

    def test_colors_and_heights_are_no_normals(self):
        colors = "is not a normal map: its texels are colors, or several masks (give a normal map in tangent space"
        gray = "is gray, like a height map or a mask, so it is not a normal map (bump() converts height maps"
        for map_, problem in ((self.photo, colors), (numpy.dstack([self.heights] * 3), gray)):
            for call in (relief.decode_normals, relief.flip_green):
                self.expect_refusal(lambda **options: call(map_, **options), f"map: {problem}", "normal")
            self.expect_refusal(lambda **options: relief.Scene(self.mesh, normal_map=map_, **options),
                                f"normal_map: {problem}", "normal")
        report = []
        relief.Scene(self.mesh, normal_map=self.photo, assume="normal").render(size=(8, 8), report=report)
        self.assertEqual(report, [])

    def test_normals_are_no_heights(self):
        message = "height: seems to be a normal map (decode_normals() and heights() convert normal maps"
        for call in (relief.bump, relief.slopes, relief.bump_options):
            self.expect_refusal(lambda **options: call(self.normals, **options), message, "height")
        relief.bump(numpy.dstack([self.normals, self.normals[..., 2]]), channel="alpha", kernel="sobel3")
        relief.bump(self.photo, kernel="sobel3")  # Colors can be heights: their mean.

    def test_scene_files_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "scene.json")
            scene.write_text(json.dumps({
                "relief_scene": 1,
                "lights": [{"type": "directional", "direction": [0, 0, -1]}],
                "nodes": [{"shape": "quad", "material": "photo"}],
                "materials": {"photo": {"normal_map": str(DATA / "bricks-diffuse.png")}}}))
            with self.assertRaises(relief.FileError) as raised:
                relief.Scene.load(scene)
            self.assertEqual(str(raised.exception),
                             f"{scene}: normal map of material 'photo': {DATA / 'bricks-diffuse.png'}: is not a normal "
                             "map: its texels are colors, or several masks (give a normal map in tangent space; "
                             'assume=["normal"] reads it anyway)')
            report = []
            relief.Scene.load(scene, assume=["normal"], report=report).render(size=(8, 8), report=report)
            self.assertEqual(report, [])
            with self.assertRaisesRegex(relief.InvalidInput, "assume"):
                relief.Scene.load(scene, assume=["occlusion"])

    def test_normal_maps_of_all_kinds_are_read(self):
        object_normals = relief.convert_space(relief.decode_normals(self.normals), self.mesh, to="object")
        for normals in (relief.decode_normals(self.normals), object_normals):
            for bits in (8, 16, 32):
                relief.decode_normals(relief.encode_normals(normals, bits=bits))
        relief.decode_normals(self.photo[:7, :7])  # Few texels are not judged.


class Threads(unittest.TestCase):
    def test_other_threads_run_meanwhile(self):
        positions, texcoords, triangles = grid(700)
        normals = relief.vertex_normals(positions, triangles)
        running, ticks = threading.Event(), []

        def work():
            running.set()
            relief.corner_tangents(positions, normals, texcoords, triangles)
            running.clear()

        worker = threading.Thread(target=work)
        worker.start()
        running.wait()
        while running.is_set():  # With the GIL held, this thread would not run before the end.
            ticks.append(time.monotonic())
            time.sleep(0.001)
        worker.join()
        self.assertGreater(len(ticks), 5)

    def test_two_calls_at_once_are_correct(self):
        positions, _, triangles = grid(300)
        expected = relief.vertex_normals(positions, triangles)
        results = [None] * 4

        def work(index):
            results[index] = relief.vertex_normals(positions, triangles)

        workers = [threading.Thread(target=work, args=(index,)) for index in range(4)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        for result in results:
            numpy.testing.assert_array_equal(result, expected)

    def test_number_of_threads_changes_nothing(self):
        positions, _, triangles = grid(200)
        expected = relief.vertex_normals(positions, triangles)
        relief.set_thread_limit(1)
        try:
            numpy.testing.assert_array_equal(relief.vertex_normals(positions, triangles), expected)
        finally:
            relief.set_thread_limit(0)

    def test_execution_limits_threads_and_reports_progress(self):
        positions, texcoords, triangles = grid(300)
        normals = relief.vertex_normals(positions, triangles)
        expected = relief.corner_tangents(positions, normals, texcoords, triangles)
        told = []
        with relief.Execution(threads=1, progress=lambda stage, part: told.append((stage, part))) as execution:
            tangents = relief.corner_tangents(positions, normals, texcoords, triangles)
            self.assertEqual(execution.state, ("", None))
        numpy.testing.assert_array_equal(tangents, expected)
        self.assertEqual(told[0], ("tangents", 0.0))
        self.assertEqual(told, sorted(told, key=lambda entry: entry[1]))
        self.assertGreater(told[-1][1], 0.5)
        count = len(told)
        relief.corner_tangents(positions, normals, texcoords, triangles)
        self.assertEqual(len(told), count)  # After the block, nothing is reported.

    def test_execution_ends_operations(self):
        positions, texcoords, triangles = grid(300)
        normals = relief.vertex_normals(positions, triangles)

        def stop(stage, part):
            raise KeyError(stage)

        with self.assertRaisesRegex(KeyError, "tangents"), relief.Execution(progress=stop):
            relief.corner_tangents(positions, normals, texcoords, triangles)
            self.fail("the operation went on")
        cancelled = relief.Execution()
        with self.assertRaises(relief.Cancelled), cancelled:
            cancelled.cancel()
            relief.corner_tangents(positions, normals, texcoords, triangles)
        with self.assertRaises(relief.Cancelled), cancelled:  # It stays cancelled.
            self.fail("the block was entered")
        with relief.Execution() as outer, self.assertRaisesRegex(relief.InvalidInput, "not finished"), outer:
            pass
        relief.corner_tangents(positions, normals, texcoords, triangles)

    def test_progress_can_end_a_bake(self):
        positions, texcoords, triangles = grid(9)
        mesh = relief.Mesh(positions, triangles, texcoords=texcoords)
        fractions = []
        relief.bake(mesh, mesh, (64, 256), progress=fractions.append)
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(fractions[-1], 1.0)

        def stop(fraction):
            raise KeyError(fraction)

        with self.assertRaises(KeyError):
            relief.bake(mesh, mesh, (64, 256), progress=stop)


class Files(unittest.TestCase):
    def test_images_keep_their_samples(self):
        random = numpy.random.default_rng(3)
        with tempfile.TemporaryDirectory() as folder:
            for name, image in {"a.png": random.integers(0, 256, (5, 7, 3), dtype=numpy.uint8),
                                "b.png": random.integers(0, 65536, (5, 7), dtype=numpy.uint16),
                                "c.exr": random.random((5, 7, 4), dtype=numpy.float32)}.items():
                file = pathlib.Path(folder) / name
                relief.write_image(file, image, metadata={"Author": "relief"})
                stored, metadata = relief.read_image(file)
                self.assertEqual(stored.dtype, image.dtype)
                numpy.testing.assert_array_equal(stored, image)
                self.assertEqual(metadata["Author"], "relief")
            # Any memory layout is an image.
            relief.write_image(file, image[::-1, ::2])
            numpy.testing.assert_array_equal(relief.read_image(file)[0], image[::-1, ::2])

    def test_meshes(self):
        mesh = relief.read_mesh(DATA / "vase.obj")
        with tempfile.TemporaryDirectory() as folder:
            relief.write_mesh(pathlib.Path(folder) / "vase.ply", mesh)
            again = relief.read_mesh(pathlib.Path(folder) / "vase.ply")
            mesh.name = "two\nlines"
            report = []
            relief.write_mesh(pathlib.Path(folder) / "vase.obj", mesh, report=report)
            self.assertEqual([finding["kind"] for finding in report], ["mesh name that OBJ cannot store"])
        numpy.testing.assert_array_equal(again.positions, mesh.positions)
        numpy.testing.assert_array_equal(again.triangles, mesh.triangles)
        self.assertEqual(mesh.origin, (0.0, 0.0, 0.0))
