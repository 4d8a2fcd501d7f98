# SPDX-License-Identifier: Apache-2.0
"""Results on arrays equal those of the command line on files, bit for bit."""
import inspect
import json
import pathlib
import shutil
import tempfile
import unittest

import numpy
import relief

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
WEIGHTS = ("auto", "uniform", "area", "angle", "sine", "max", "angle-edges", "area-angle")


class CommandLineCase(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def run_tool(self, tool, *arguments):
        return relief.run(tool, *map(str, arguments))

    def assert_equal_meshes(self, a, b, *attributes):
        for name in ("positions", "triangles", *attributes):
            numpy.testing.assert_array_equal(getattr(a, name), getattr(b, name), name)


class MeshTools(CommandLineCase):
    def test_normals_of_each_weight(self):
        urn = relief.read_mesh(DATA / "urn-high.ply")
        out = self.folder / "out.ply"
        for weight in WEIGHTS:
            with self.subTest(weight):
                self.run_tool("relief-mesh", "process", DATA / "urn-high.ply", out, "--normals", weight)
                stored = relief.read_mesh(out)
                normals = relief.vertex_normals(urn.positions, urn.triangles, weight=weight)
                numpy.testing.assert_array_equal(normals, stored.normals)
        self.run_tool("relief-mesh", "process", DATA / "urn-high.ply", out, "--normals", "area", "--weld", "0.01")
        numpy.testing.assert_array_equal(
            relief.vertex_normals(urn.positions, urn.triangles, weight="area", weld_tolerance=0.01),
            relief.read_mesh(out).normals)

    def test_hard_edges_and_splits(self):
        mesh = relief.read_mesh(DATA / "urn-low.obj")
        out = self.folder / "out.ply"
        self.run_tool("relief-mesh", "process", DATA / "urn-low.obj", out, "--normals", "angle", "--crease", "30",
                      "--ignore-smoothing-groups")
        stored = relief.read_mesh(out)
        corners = relief.corner_normals(mesh.positions, mesh.triangles, crease_degrees=30.0)
        source, triangles = relief.split_vertices(len(mesh.positions), mesh.triangles, corners)
        numpy.testing.assert_array_equal(mesh.positions[source], stored.positions)
        numpy.testing.assert_array_equal(triangles, stored.triangles)
        normals = numpy.empty_like(stored.normals)
        normals[triangles.reshape(-1)] = corners.reshape(-1, 3)
        numpy.testing.assert_array_equal(normals, stored.normals)
        framed, copied = relief.with_frames(mesh, normals="angle", crease_degrees=30.0, smoothing_groups=False)
        self.assert_equal_meshes(framed, stored, "normals")
        numpy.testing.assert_array_equal(copied, source)
        self.assertGreater(len(source), len(mesh.positions))

    def test_tangents(self):
        mesh = relief.read_mesh(DATA / "vase.obj")
        out = self.folder / "out.glb"
        for method in ("mikktspace", "area-weighted", "lengyel"):
            with self.subTest(method):
                self.run_tool("relief-mesh", "process", DATA / "vase.obj", out, "--normals", "angle", "--tangents",
                              method)
                stored = relief.read_mesh(out, space="object")
                framed, _ = relief.with_frames(mesh, normals="angle", tangents=method)
                self.assert_equal_meshes(framed, stored, "normals", "texcoords", "tangents")
                normals = relief.vertex_normals(mesh.positions, mesh.triangles)
                corners = relief.corner_tangents(mesh.positions, normals, mesh.texcoords, mesh.triangles,
                                                 method=method)
                numpy.testing.assert_array_equal(corners, stored.tangents[stored.triangles])
        self.run_tool("relief-mesh", "process", DATA / "vase.obj", out, "--normals", "angle", "--tangents",
                      "mikktspace")
        stored = relief.read_mesh(out, space="object")
        numpy.testing.assert_array_equal(
            relief.vertex_tangents(stored.positions, stored.normals, stored.texcoords, stored.triangles),
            stored.tangents)

    def test_flat_normals(self):
        urn = relief.read_mesh(DATA / "urn-low.obj")
        out = self.folder / "out.ply"
        self.run_tool("relief-mesh", "process", DATA / "urn-low.obj", out, "--normals", "flat")
        stored = relief.read_mesh(out)
        faces = relief.triangle_normals(urn.positions, urn.triangles)
        for corner in range(3):
            numpy.testing.assert_array_equal(stored.normals[stored.triangles[:, corner]], faces)

    def test_decimate_and_subdivide(self):
        mesh = relief.read_mesh(DATA / "vase.obj")
        out = self.folder / "out.ply"
        self.run_tool("relief-mesh", "decimate", DATA / "vase.obj", out, "--triangles", "1000")
        coarse, source = relief.decimate(mesh, triangles=1000)
        self.assert_equal_meshes(coarse, relief.read_mesh(out))
        numpy.testing.assert_array_equal(coarse.texcoords, mesh.texcoords[source])
        kept, source = relief.decimate(mesh, triangles=1000, keep_positions=True)
        numpy.testing.assert_array_equal(kept.positions, mesh.positions[source])
        self.assertEqual(len(kept.triangles), len(coarse.triangles))
        self.run_tool("relief-mesh", "decimate", DATA / "vase.obj", out, "--triangles", "1000", "--max-error", "0.02",
                      "--max-normal-error", "30", "--keep-borders", "--keep-seams", "--weights", "texcoords=2,normals=0.1")
        limited, _ = relief.decimate(mesh, triangles=1000, max_error=0.02, max_normal_degrees=30.0, keep_borders=True,
                                     keep_seams=True, weights={"texcoords": 2.0, "normals": 0.1})
        self.assert_equal_meshes(limited, relief.read_mesh(out))
        self.assertGreater(len(limited.triangles), len(coarse.triangles))
        from_a, from_b = relief.surface_distance(mesh, coarse)
        report = relief.run("relief-mesh", "decimate", str(DATA / "vase.obj"), str(out), "--triangles", "1000", "--measure", "full",
                            report=True)
        self.assertTrue(from_a["mean"] < from_a["p95"] <= from_a["max"])
        for key in ("mean", "rms", "max", "mean_degrees", "max_degrees"):
            self.assertEqual(from_a[key], report["distance"]["of_input"][key], key)
            self.assertEqual(from_b[key], report["distance"]["of_output"][key], key)
        levels = relief.levels_of_detail(mesh, [1000, 300])
        self.assert_equal_meshes(levels[0], coarse, "texcoords")
        again, _ = relief.decimate(levels[0], triangles=300)
        self.assert_equal_meshes(levels[1], again, "texcoords")
        with self.assertRaisesRegex(relief.InvalidInput, "weights: 'uv' is not one of texcoords, normals, colors"):
            relief.decimate(mesh, triangles=1000, weights={"uv": 1.0})
        self.run_tool("relief-mesh", "subdivide", DATA / "vase.obj", out, "--levels", "2")
        fine, stored = relief.subdivide(mesh, 2), relief.read_mesh(out)
        self.assert_equal_meshes(fine, stored)
        numpy.testing.assert_allclose(fine.texcoords, stored.texcoords, atol=6e-8)  # PLY stores 1 - v.

    def test_repair_and_remesh(self):
        mesh = relief.read_mesh(DATA / "vase.obj")
        out = self.folder / "out.ply"
        # Doubled and reversed triangles.
        faulty = relief.Mesh(mesh.positions, numpy.concatenate(
            [mesh.triangles[:, ::-1], mesh.triangles[:50, ::-1]]))
        relief.write_mesh(self.folder / "faulty.ply", faulty)
        self.run_tool("relief-mesh", "repair", self.folder / "faulty.ply", out, "--two-sided", "single")
        report = []
        repaired, source = relief.repair(faulty, two_sided="single", report=report)
        self.assert_equal_meshes(repaired, relief.read_mesh(out))
        self.assertEqual(len(source), len(repaired.positions))
        self.assertEqual(len(repaired.triangles), len(relief.repair(mesh)[0].triangles))
        self.assertIn(50, [finding["count"] for finding in report])
        kept, _ = relief.repair(faulty, weld=None, keep_duplicates=True, orient=False, separate=False)
        self.assertEqual(len(kept.triangles), len(faulty.triangles))
        with self.assertRaisesRegex(relief.InvalidInput, "two_sided: 'both' is not one of keep, together, single, remove"):
            relief.repair(mesh, two_sided="both")
        self.run_tool("relief-mesh", "remesh", DATA / "vase.obj", out, "--resolution", "24", "--shell", "--normals", "keep")
        self.assert_equal_meshes(relief.remesh(mesh, resolution=24, shell=True), relief.read_mesh(out))
        self.run_tool("relief-mesh", "remesh", DATA / "vase.obj", out, "--resolution", "24", "--sign", "winding",
                      "--normals", "keep")
        self.assert_equal_meshes(relief.remesh(mesh, resolution=24, sign="winding"), relief.read_mesh(out))
        with self.assertRaises(relief.InvalidInput):
            relief.remesh(mesh, resolution=4)

    def test_displace(self):
        mesh, out = relief.read_mesh(DATA / "vase.obj"), self.folder / "out.glb"
        heights, _ = relief.read_image(DATA / "bricks-height.png")
        report = relief.run("relief-mesh", "displace", str(DATA / "vase.obj"), str(out), "--heights", str(DATA / "bricks-height.png"),
                               "--height", "-0.05", "--zero", "0.5", "--max-error", "0.02", report=True)
        moved, details = relief.displace(mesh, heights, height=-0.05, zero=0.5, max_error=0.02)
        stored = relief.read_mesh(out)
        numpy.testing.assert_array_equal(moved.positions, stored.positions)
        numpy.testing.assert_array_equal(moved.triangles, stored.triangles)
        numpy.testing.assert_allclose(moved.normals, stored.normals, atol=6e-8)  # The writer normalizes them again.
        for key, value in (("max", "max_error"), ("limit", "limit"), ("triangles_above", "above_limit")):
            self.assertEqual(report["error"][key], details[value], key)
        self.assertEqual((details["wrap"], details["is_complete"]), (report["wrap"], True))
        few, details = relief.displace(mesh, heights, height=0.05, pixels=300, max_triangles=7000)
        self.assertFalse(details["is_complete"])
        self.assertLessEqual(len(few.triangles), 7000)
        size = numpy.linalg.norm(numpy.ptp(mesh.positions, axis=0))
        self.assertAlmostEqual(details["limit"], 0.5 * size / 300, delta=1e-6 * size)
        with self.assertRaisesRegex(relief.InvalidInput, "pixels must be at least 1"):
            relief.displace(mesh, heights, height=0.05, pixels=0)
        with self.assertRaisesRegex(relief.InvalidInput, "heights"):
            relief.displace(mesh, relief.bump(heights), height=0.05)

    def test_check(self):
        out = self.folder / "vase.glb"
        self.run_tool("relief-mesh", "process", DATA / "vase.obj", out, "--normals", "angle", "--tangents", "lengyel")
        for file in (DATA / "urn-high.ply", DATA / "urn-low.obj", out):
            for options, words in (({}, []), ({"for_baking": True}, ["--for-baking"])):
                with self.subTest(file.name, **options):
                    expected = self.run_tool("relief-mesh", "check", file, "--json", *words)["files"][0]
                    result = relief.check_mesh(relief.read_mesh(file, space="object"), **options)
                    part = expected["primitives"][0]
                    if part["tangents"] is not None:  # A mesh in memory has one set of texture coordinates.
                        del part["tangents"]["texcoord_set"], part["tangents"]["texcoord_set_of_material"]
                    del part["name"], result["name"]
                    self.assertEqual(json.loads(json.dumps(result)), part)
                    self.assertEqual(list(result), list(part))

    def test_compare(self):
        a, b = self.folder / "a.glb", self.folder / "b.glb"
        self.run_tool("relief-mesh", "process", DATA / "vase.obj", a, "--normals", "angle", "--tangents", "mikktspace")
        self.run_tool("relief-mesh", "process", DATA / "vase.obj", b, "--normals", "area", "--tangents", "lengyel")
        expected = self.run_tool("relief-mesh", "compare", a, b, "--json")
        result = relief.compare_meshes(*(relief.read_mesh(file, space="object") for file in (a, b)))
        self.assertGreater(result["normals"]["max"], 0.0)
        for name in ("worst_normals", "worst_tangents"):
            for corner in expected[name]:
                del corner["primitive"]
        self.assertEqual({name: expected[name] for name in result}, json.loads(json.dumps(result)))


class Unwrapping(CommandLineCase):
    def test_unwrap(self):
        file, out = DATA / "urn-low.obj", self.folder / "out.ply"
        for options, words in (({}, []), ({"flatten": "conformal"}, ["--flatten", "conformal"]),
                               ({"padding": 8, "align": 4, "max_stretch": 1.5, "split_hard_degrees": 40.0,
                                 "keep_seams": True},
                                ["--padding", "8", "--align", "4", "--max-stretch", "1.5", "--split-hard", "40",
                                 "--keep-seams"])):
            with self.subTest(**options):
                report = relief.run("relief-mesh", "unwrap", file, out, "--size", "256x128", *words, report=True)
                unwrapped = relief.unwrap(relief.read_mesh(file), size=(256, 128), **options)
                self.assertEqual(unwrapped.stats, report["atlas"])
                stored = relief.read_mesh(out)
                self.assert_equal_meshes(unwrapped.mesh, stored)
                # PLY stores v upwards, which rounds v near 1.
                numpy.testing.assert_allclose(unwrapped.mesh.texcoords, stored.texcoords, atol=1e-7)
                self.assertEqual(len(set(unwrapped.charts)), unwrapped.stats["charts"])
        mesh = relief.read_mesh(file)
        numpy.testing.assert_array_equal(mesh.positions[unwrapped.source_vertex], unwrapped.mesh.positions)

    def test_densities_stacks_and_repacking(self):
        mesh = relief.read_mesh(DATA / "urn-low.obj")
        densities = numpy.ones(len(mesh.triangles))
        densities[: len(densities) // 2] = 3.0
        report = []
        dense = relief.unwrap(mesh, size=(256, 256), densities=densities, report=report)
        self.assertGreater(dense.stats["max_density"], 1.2)
        self.assertEqual(report[0]["kind"], "converted densities")
        with self.assertRaisesRegex(relief.InvalidInput, "densit"):
            relief.unwrap(mesh, densities=numpy.ones(3, "float32"))
        twice = relief.Mesh(numpy.concatenate([mesh.positions, mesh.positions + numpy.float32(8)]),
                            numpy.concatenate([mesh.triangles, mesh.triangles + numpy.uint32(len(mesh.positions))]))
        self.assertEqual(relief.unwrap(twice, size=(256, 256), stack=True).stats["stacked_parts"], 1)
        out = self.folder / "out.obj"
        report = relief.run("relief-mesh", "unwrap", DATA / "urn-low.obj", out, "--size", "256", "--repack", report=True)
        self.assertEqual(relief.unwrap(mesh, size=(256, 256), repack=True).stats, report["atlas"])
        tiles = relief.unwrap(mesh, size=(64, 64), udim=2).mesh.texcoords[:, 0]
        self.assertGreater(tiles.max(), 1.0)
        self.assertLessEqual(tiles.max(), 2.0)

    def test_measured_texcoords(self):
        file = DATA / "urn-low.obj"
        (expected,) = self.run_tool("relief-mesh", "check", file, "--map-size", "256", "--json")["files"][0]["texcoords"]
        mesh = relief.read_mesh(file)
        quality = relief.measure_texcoords(mesh, (256, 256))
        self.assertEqual(quality["charts"].shape, (len(mesh.triangles),))
        self.assertEqual(quality["atlas"].pop("stacked_parts"), 0)
        expected["atlas"].pop("stacked_parts", None)
        self.assertEqual({name: expected[name] for name in quality if name != "charts"},
                         {name: quality[name] for name in quality if name != "charts"})
        with self.assertRaisesRegex(relief.InvalidInput, "no texture coordinates"):
            relief.measure_texcoords(relief.Mesh(mesh.positions, mesh.triangles), (256, 256))

    def test_triangles_that_are_set_aside(self):
        positions = numpy.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 0, 0)])
        report = []
        unwrapped = relief.unwrap(relief.Mesh(positions, numpy.array([(0, 1, 2), (0, 1, 3)])), size=(64, 64),
                                  report=report)
        self.assertEqual(unwrapped.charts.tolist(), [0, -1])
        self.assertEqual([finding["count"] for finding in report], [1])
        with self.assertRaisesRegex(relief.InvalidInput, "padding"):
            relief.unwrap(unwrapped.mesh, padding=1000)
        with self.assertRaisesRegex(TypeError, r"unwrap\(\) has no argument 'sise': did you mean 'size'"):
            relief.unwrap(unwrapped.mesh, sise=(64, 64))


class MapTools(CommandLineCase):
    @classmethod
    def setUpClass(cls):
        cls.heights, _ = relief.read_image(DATA / "bricks-height.png")
        cls.map, cls.metadata = relief.read_image(DATA / "scenes" / "bricks-normal.png")

    def bump(self, name, *options):
        file = self.folder / name
        self.run_tool("relief-bake", "bump", DATA / "bricks-height.png", file, *options)
        return relief.read_image(file)[0]

    def convert(self, file, name, *options):
        out = self.folder / name
        self.run_tool("relief-bake", "convert", file, out, *options)
        return relief.read_image(out)[0]

    def test_bump(self):
        numpy.testing.assert_array_equal(relief.bump(self.heights), self.bump("auto.png"))
        for kernel in ("forward", "sobel3", "scharr5", "central7", "gaussian"):
            with self.subTest(kernel):
                numpy.testing.assert_array_equal(
                    relief.bump(self.heights, kernel=kernel, strength=24.0, wrap="clamp", bits=8, green="down",
                                zero_code="128", dither="blue-noise"),
                    self.bump("map.png", "--kernel", kernel, "--strength", "24", "--wrap", "clamp", "--bits", "8",
                              "--green", "down", "--zero-code", "128", "--dither", "blue-noise"))
        numpy.testing.assert_array_equal(
            relief.bump(self.heights, kernel="sobel5", wrap="repeat,mirror", bits=32, arithmetic="float32"),
            self.bump("map.exr", "--kernel", "sobel5", "--wrap", "repeat,mirror", "--precision", "float32"))

    def test_slopes(self):
        options = {"kernel": "central5", "wrap": "repeat", "strength": 8.0}
        slopes = relief.slopes(self.heights, **options)
        normals = 2 * relief.bump(self.heights, bits=32, **options) - 1
        numpy.testing.assert_allclose(slopes, -normals[:, :, :2] / normals[:, :, 2:], atol=2e-5)
        self.assertGreater(numpy.abs(slopes).max(), 0.5)

    def test_heights(self):
        out = self.folder / "heights.exr"
        file = DATA / "scenes" / "bricks-normal.png"
        self.run_tool("relief-bake", "heights", file, out, "--kernel", "central5", "--wrap", "repeat")
        normals = relief.decode_normals(self.map, exact_flat=True)
        heights, details = relief.heights(normals, kernel="central5", wrap="repeat")
        stored, _ = relief.read_image(out)
        numpy.testing.assert_array_equal(heights / numpy.float32(1), stored)
        self.assertGreater(details["highest"], 0.0)

    def test_textures(self):
        file = self.folder / "map.png"
        decoded = relief.decode_normals(self.map, exact_flat=True)
        relief.write_image(file, self.map)
        expected = self.folder / "expected.ktx2"
        self.run_tool("relief-bake", "convert", file, expected, "--format", "bc5", "--input-zero-code", "127.5")
        result = self.folder / "result.ktx2"
        relief.write_texture(result, [decoded], format="bc5")
        numpy.testing.assert_array_equal(relief.read_image(result)[0], relief.read_image(expected)[0])
        levels = relief.normal_mip_levels(decoded)
        self.assertEqual(levels[0].shape, (decoded.shape[0] // 2, decoded.shape[1] // 2, 3))
        self.assertEqual(levels[-1].shape, (1, 1, 3))
        numpy.testing.assert_allclose(levels[-1][0, 0], decoded.mean(axis=(0, 1), dtype=numpy.float64), atol=1e-6)
        relief.write_texture(result, [decoded, *levels], format="bc5-snorm", quality="fast", zstd=3)
        self.assertLess(result.stat().st_size, decoded.shape[0] * decoded.shape[1] * 4 // 3)
        with self.assertRaisesRegex(relief.InvalidInput, "levels: is empty"):
            relief.write_texture(result, [])
        with self.assertRaisesRegex(relief.InvalidInput, "format: 'bc6' is not one of r8"):
            relief.write_texture(result, [decoded], format="bc6")

    def test_convert(self):
        file = DATA / "scenes" / "bricks-normal.png"
        numpy.testing.assert_array_equal(relief.flip_green(self.map), self.convert(file, "flip.png", "--flip", "green"))
        normals = relief.decode_normals(self.map, exact_flat=True)
        bits = 8 * self.map.itemsize
        numpy.testing.assert_array_equal(relief.encode_normals(relief.scale_slopes(normals, 2.0), bits=bits),
                                         self.convert(file, "strong.png", "--strength", "2"))
        for filter_name in ("best", "box", "lanczos"):
            for domain in ("slopes", "vectors"):
                with self.subTest(filter_name, domain=domain):
                    smaller = relief.resize_normals(normals, 100, 60, filter=filter_name, domain=domain)
                    numpy.testing.assert_array_equal(
                        relief.encode_normals(smaller, bits=16),
                        self.convert(file, "small.png", "--resize", "100x60", "--resize-filter", filter_name,
                                     "--resize-of", domain, "--bits", "16", "--wrap", "repeat"))
        for blend in ("reoriented", "partial-derivative", "whiteout", "udn", "unity", "linear", "overlay"):
            with self.subTest(blend):
                numpy.testing.assert_array_equal(
                    relief.encode_normals(relief.blend_normals(normals, normals, blend=blend), bits=16),
                    self.convert(file, "blend.png", "--detail", file, "--blend", blend, "--bits", "16"))

    def test_spaces(self):
        model = self.folder / "vase.glb"
        self.run_tool("relief-mesh", "process", DATA / "vase.obj", model, "--normals", "angle", "--tangents",
                      "mikktspace")
        mesh = relief.read_mesh(model, space="object")
        file = DATA / "scenes" / "bricks-normal.png"
        stored = self.convert(file, "object.exr", "--to-object", model, "--input-green", "up")
        tangent = relief.decode_normals(self.map, exact_flat=True)
        normals = relief.convert_space(tangent, mesh, to="object")
        numpy.testing.assert_array_equal(relief.encode_normals(normals, bits=32), stored)
        back = relief.convert_space(normals, mesh, to="tangent")
        covered = (normals != (0, 0, 1)).any(axis=-1)
        self.assertGreater(covered.mean(), 0.5)
        self.assertLess(numpy.abs(back - tangent)[covered].max(), 1e-5)

    def test_check(self):
        for file in (DATA / "scenes" / "bricks-normal.png", DATA / "bricks-height.png", DATA / "bricks-diffuse.png"):
            with self.subTest(file.name):
                expected = self.run_tool("relief-bake", "check", file, "--json")["files"][0]
                image, metadata = relief.read_image(file)
                result = relief.check_normal_map(image, metadata=metadata, color_tag=expected["color_tag"])
                for finding in expected["problems"] + expected["notes"]:
                    del finding["remedy"]
                self.assertEqual({name: expected[name] for name in result}, json.loads(json.dumps(result)))


class Bakes(CommandLineCase):
    def test_bake(self):
        high, low = DATA / "urn-high.ply", DATA / "urn-low.obj"
        out = self.folder / "map.png"
        layers = {"heights": "height", "occlusion": "occlusion", "curvature": "curvature", "thickness": "thickness"}
        words = [word for name in layers.values() for word in (f"--{name}-map", str(self.folder / f"{name}.exr"))]
        report = relief.run("relief-bake", "mesh", high, low, out, "--size", "128x96", "--samples", "4",
                            "--occlusion-rays", "16", "--thickness-rays", "8", "--bent-normal-map",
                            self.folder / "bent.png", "--id-map", self.folder / "ids.png", *words, report=True)
        baked = relief.bake(relief.read_mesh(high), relief.read_mesh(low), (128, 96), samples=4, occlusion_rays=16,
                            thickness_rays=8, layers=["normals", "bent_normals", "ids", *layers])
        numpy.testing.assert_array_equal(relief.encode_normals(baked.normals), relief.read_image(out)[0])
        for name, file in layers.items():
            numpy.testing.assert_array_equal(getattr(baked, name),
                                             relief.read_image(self.folder / f"{file}.exr")[0], name)
        numpy.testing.assert_array_equal(relief.encode_normals(baked.bent_normals),
                                         relief.read_image(self.folder / "bent.png")[0])
        self.assertEqual(baked.ids.dtype, numpy.int32)
        numpy.testing.assert_array_equal(baked.ids, numpy.where(baked.states >= 2, 0, -1))
        self.assertEqual(len(baked.report["ids"]), 1)
        self.assertEqual(len(report["maps"][0]["layers"][-1]["ids"]), 1)
        self.assertIsNone(baked.colors)
        self.assertEqual(baked.states.shape, (96, 128))
        for name in ("offset", "max_distance", "min_height", "max_height", "texels_baked", "texels_missed",
                     "samples", "rays", "occlusion_rays", "thickness_rays", "open_thickness_rays"):
            self.assertEqual(baked.report[name], report[name], name)
        self.assertEqual(baked.report["texels_baked"], int((baked.states == 2).sum()))

    def test_several_high_meshes(self):
        high, low = relief.read_mesh(DATA / "urn-high.ply"), relief.read_mesh(DATA / "urn-low.obj")
        alone = relief.bake(high, low, (64, 64), padding=0)
        twice = relief.bake([high, high], low, (64, 64), padding=0)
        numpy.testing.assert_array_equal(alone.normals, twice.normals)


class Pictures(CommandLineCase):
    def test_render(self):
        model = self.folder / "vase.glb"
        self.run_tool("relief-mesh", "process", DATA / "vase.obj", model, "--normals", "angle", "--tangents",
                      "mikktspace")
        for file in (model, DATA / "vase.obj"):
            for options, words in (({}, []), ({"samples": 1, "camera": (-20.0, 40.0, 1.5)},
                                              ["--samples", "1", "--camera=-20,40,1.5"])):
                with self.subTest(file.name, **options):
                    out = self.folder / "out.png"
                    self.run_tool("relief-view", file, "--output", out, "--size", "96x64", *words)
                    picture = relief.Scene.load(file).render(size=(96, 64), **options)
                    numpy.testing.assert_array_equal(picture, relief.read_image(out)[0])
        explained = relief.run("relief-view", model, "--explain-effects", "--samples", "1", "--json")["effects"]
        scene = relief.Scene.load(model)
        self.assertEqual(scene.frame_effects(samples=1), explained["frame"])
        self.assertEqual(scene.effects(samples=1)[0], explained["draws"][0]["effects"])
        metal = self.folder / "metal.glb"
        self.run_tool("relief-mesh", "process", DATA / "vase.obj", self.folder / "vase.gltf")
        document = json.loads((self.folder / "vase.gltf").read_text())
        for material in document["materials"]:
            material["pbrMetallicRoughness"]["metallicFactor"] = 1
        (self.folder / "vase.gltf").write_text(json.dumps(document))
        self.run_tool("relief-mesh", "process", self.folder / "vase.gltf", metal)
        for studio, words in ((True, []), (False, ["--environment", "none"])):
            self.run_tool("relief-view", metal, "--output", self.folder / "out.png", "--size", "96x64", *words)
            picture = relief.Scene.load(metal, studio=studio).render(size=(96, 64))
            numpy.testing.assert_array_equal(picture, relief.read_image(self.folder / "out.png")[0])
        out = self.folder / "out.exr"
        scene = self.folder / "scene.json"
        self.run_tool("relief-view", model, "--output", out, "--size", "96x64", "--material", "gold", "--light",
                      "point:2,2,2,4", "--normal-map", DATA / "scenes" / "bricks-normal.png", "--save-scene", scene)
        picture = relief.Scene.load(scene).render(output="linear")
        self.assertEqual(picture.shape, (64, 96, 3))
        numpy.testing.assert_array_equal(picture, relief.read_image(out)[0])

    def test_scene_of_arrays(self):
        mesh, _ = relief.with_frames(relief.read_mesh(DATA / "vase.obj"), normals="angle", tangents="mikktspace")
        scene = relief.Scene(mesh, diffuse=(0.5, 0.5, 0.5))
        scene.add_light((0.0, 0.0, -1.0))
        scene.background = (0.0, 0.0, 0.0, 0.0)
        picture = scene.render(size=(65, 65), output="linear", camera=(0.0, 0.0, 1.0))
        self.assertEqual(picture.shape, (65, 65, 4))
        self.assertLessEqual(picture[..., :3].max(), 0.5 + 1e-3)  # The light comes from the camera.
        self.assertGreater(picture[..., :3].max(), 0.45)
        names = {effect["effect"]: effect for effect in scene.effects()[0]}
        self.assertFalse(names["normal map"]["on"])
        self.assertEqual(scene.effects(size=(8, 8), output="linear", camera=(0.0, 0.0, 1.0))[0], scene.effects()[0])
        for samples in (1, 4):
            frame = {effect["effect"]: effect for effect in scene.frame_effects(samples=samples)}
            self.assertEqual(frame["finishing pass"]["on"], samples == 4, frame["finishing pass"]["reason"])
        with self.assertRaisesRegex(relief.InvalidInput, "material: 'butter' is not one of"):
            relief.Scene(mesh, material="butter")

    def test_compare(self):
        a, b = self.folder / "a.png", self.folder / "b.png"
        self.run_tool("relief-view", DATA / "vase.obj", "--output", a, "--size", "64x64")
        report = self.run_tool("relief-view", DATA / "vase.obj", "--output", b, "--size", "64x64", "--exposure", "0.1",
                               "--reference", a, "--max-difference", "255", "--json")["comparison"]
        result = relief.compare_images(relief.read_image(a)[0], relief.read_image(b)[0])
        self.assertGreater(result["flip_mean"], 0.0)
        self.assertEqual(result.pop("flip_map").shape, (64, 64))
        self.assertEqual({name: report[name] for name in result}, result)

    def test_compare_normals(self):
        map_, _ = relief.read_image(DATA / "scenes" / "bricks-normal.png")
        exact = relief.decode_normals(map_)
        coarse = relief.decode_normals(relief.encode_normals(exact, bits=8))
        errors, degrees = relief.compare_normals(exact, coarse)
        self.assertEqual(degrees.shape, exact.shape[:2])
        self.assertLess(errors["max"], 0.7)
        self.assertAlmostEqual(errors["max"], float(degrees.max()), places=5)


class Assets(unittest.TestCase):
    def test_make(self):
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder) / "urn.glb"
            report = relief.make(DATA / "urn-high.ply", output, triangles=300, size=64, lods=1)
            self.assertTrue(output.exists())
            self.assertEqual(report["triangles"], 300)
            self.assertEqual(len(report["levels"]), 1)
            with self.assertRaises(relief.ToolError):
                relief.make(pathlib.Path(folder) / "none.ply", output)

    # Options of the command that are no arguments of make(): the output and the report are those of the function.
    NO_ARGUMENTS = {"--output", "--report", "--job", "--shard", "--force", "--explain", "--help", "--help-json", "--json", "--quiet",
                    "--strict", "--threads", "--max-memory", "--max-pixels", "--allow-outside", "--no-live-view"}

    def make_arguments(self):
        return {name: parameter for name, parameter in inspect.signature(relief.make).parameters.items()
                if parameter.kind is parameter.KEYWORD_ONLY}

    def test_make_has_all_options_of_the_command(self):
        tool = json.loads(relief.run("relief", "--help-json"))
        command, = [command for command in tool["commands"] if command["name"] == "make"]
        options = {option["name"] for option in command["options"]} - self.NO_ARGUMENTS
        other_names = relief._MAKE_OPTIONS
        arguments = {"--" + other_names.get(name, name.replace("_", "-")) for name in self.make_arguments()}
        self.assertEqual(options - arguments, set(), "options that make() lacks")
        self.assertEqual(arguments - options, set(), "arguments that the command lacks")
        words = {option["name"]: option.get("words") for option in command["options"]}
        for name, option in (("engine", "--for"), ("remesh", "--remesh"), ("match", "--match"), ("sign", "--sign"), ("max_error_kind", "--max-error-kind"),
                             ("start", "--from")):
            for word in words[option]:
                self.assertIn(f"'{word}'", str(self.make_arguments()[name].annotation), name)

    def test_make_has_the_defaults_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            report = relief.make(DATA / "vase.obj", pathlib.Path(folder) / "a.glb", size=256)
        other_keys = {"more_sources": "with", "engine": "for", "more_views": "views"}
        for name, parameter in self.make_arguments().items():
            if name in ("size", "keep_stages", "start"):
                continue
            with self.subTest(name):
                value = report["options"][other_keys.get(name, name)]
                value = tuple(value) if isinstance(value, list) else value
                if isinstance(value, float):
                    self.assertAlmostEqual(value, parameter.default)
                else:
                    self.assertEqual(value, parameter.default)

    def test_make_passes_its_arguments(self):
        given = {"more_sources": [DATA / "urn-low.obj"], "up": "z", "triangles": 200, "crease": None, "lods": 1,
                 "repair": False, "remesh": "always", "resolution": 16, "shell": True, "sign": "winding", "padding": 1,
                 "normal_bits": 16, "samples": 4, "match": "all", "occlusion_rays": 0,
                 "layers": ["height", "position"], "engine": "unity"}
        with tempfile.TemporaryDirectory() as folder:
            report = relief.make(DATA / "vase.obj", pathlib.Path(folder) / "a.glb", size=(64, 32),
                                 keep_stages=folder + "/s", **given)
            self.assertTrue((pathlib.Path(folder) / "s" / "02-remesh.glb").exists())
        options = report["options"]
        self.assertEqual(options["size"], [64, 32])
        self.assertEqual(options["with"], [str(DATA / "urn-low.obj")])
        self.assertEqual(options["for"], "unity")
        self.assertTrue(report["remesh"]["remeshed"])
        for name in set(given) - {"more_sources", "engine"}:
            self.assertEqual(options[name], given[name], name)

    def test_fidelity(self):
        report = relief.fidelity(DATA / "vase.obj", DATA / "vase.obj", DATA / "urn-low.obj", size=32, samples=1, views=1,
                                 more_views=[(30.0, 20.0)])
        equal, other = report["stages"]
        self.assertEqual(equal["pictures"]["studio"]["mean"], 0.0)
        self.assertGreater(other["pictures"]["studio"]["mean"], 0.05)
        self.assertEqual(len(other["views"]), 2)
        with self.assertRaises(relief.ToolError):
            relief.fidelity(DATA / "vase.obj")


class Experiments(unittest.TestCase):
    def test_accuracy(self):
        report = relief.accuracy("storage", times=False)
        self.assertEqual(report["format"], "relief-accuracy")
        self.assertFalse(report["settings"]["timed"])
        self.assertIn("storage/normals", [experiment["id"] for experiment in report["experiments"]])
