#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares pages with pictures in a headless browser: view_page_test.py TOOL FOLDER few|K/N SHARED
[TEST...].

FOLDER is one in which `relief-view data/vase.obj` has its model; K/N draws every Nth of all scenes
of data and of the glTF models of SHARED, if that is a folder. Exits with 77 without a browser
(Debian's chromium and chromium-driver). Run by view_page_test.cpp.
"""
import base64
import html
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

import pages

TOOL = FOLDER = SCOPE = SHARED = None
SIZE = (256, 192)
# Two rasterizers differ by more than 2 of 255 at edges of triangles, whose corners SwiftShader rounds
# to 1/16 of a pixel and Mesa to 1/256, and where they choose levels of cube maps for curved mirrors:
# at most in 4.8 % of the pixels (lighting-and-environment.json). FLIP says what is seen of it.
MAX_FLIP = 0.01
MAX_SHARE = 0.06
# In SIZE, each pixel of its spheres has 40 triangles, so that those vertices decide what is drawn, and
# SwiftShader's depths (test_knows_the_depths_of_samples of page_input_test.py): FLIP 0.0153.
SIZE_OF = {"MetalRoughSpheresNoTextures": (512, 384)}
FEW = ["data/vase.obj --height-map data/bricks-height.png --strength 12",
       "data/scenes/environment-mapping.json", "data/scenes/pot.glb --samples 1",
       "data/scenes/relief-mapping.json --height-shadow on --height-write-depth on",
       "data/scenes/relief-mapping.json --height-write-depth on --height-method relief_mapping "
       "--height-layers 64 --shadow 1"]
MODELS = ["AnisotropyStrengthTest", "Avocado", "BoomBox", "BoxTexturedNonPowerOfTwo", "BoxVertexColors",
          "CesiumMan", "ClearCoatCarPaint", "ClearCoatTest", "Corset", "Duck", "EmissiveStrengthTest", "Fox",
          "InterpolationTest", "MetalRoughSpheresNoTextures", "MorphPrimitivesTest", "MultiUVTest",
          "NegativeScaleTest", "NormalTangentMirrorTest", "NormalTangentTest", "OrientationTest",
          "RiggedFigure", "SimpleMorph", "SimpleSkin", "SpecularTest", "TextureLinearInterpolationTest",
          "TextureSettingsTest", "TextureTransformTest", "UnlitTest", "VertexColorTest", "WaterBottle"]


# Everything that needs a pass of its own: transmission over a copy, blending, a skybox, tone mapping.
PASSES = {
    "relief_scene": 1,
    "background": "#20242c",
    "camera": {"eye": [0, 0.6, 12], "fov": 20},
    "ambient": 0.15,
    "tone_mapping": "khronos_neutral",
    "exposure": 1.3,
    "nodes": [
        {"translation": [-1.5, 0, 1], "shape": "sphere", "material": {"metallic_roughness": {
            "base_color": [0.9, 0.95, 1], "metallic": 0, "roughness": 0.2, "transmission": 0.9, "thickness": 0.5}}},
        {"translation": [1.5, 0, 1], "shape": "sphere", "material": {
            "alpha_mode": "blend", "opacity": 0.5, "diffuse": [0.3, 0.12, 0.05]}},
        {"translation": [2.2, 0, 2], "shape": "sphere", "material": {
            "alpha_mode": "blend", "opacity": 0.4, "diffuse": [0.1, 0.4, 0.05], "specular": 0.6}},
        {"translation": [0, 0, -1], "shape": "sphere", "material": {"diffuse": [0.6, 0.6, 0.1], "specular": 0.6}}],
    "lights": [{"type": "directional", "direction": [0.7, -0.8, -0.9], "color": [2, 2, 2]}]}
# A triangle with two materials and a variant for each.
VARIANTS = {
    "asset": {"version": "2.0"},
    "extensionsUsed": ["KHR_materials_variants", "KHR_materials_unlit"],
    "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "blue"}]}},
    "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0, "extensions": {
        "KHR_materials_variants": {"mappings": [{"material": 0, "variants": [0]}, {"material": 1, "variants": [1]}]}}}]}],
    "materials": [{"name": name, "pbrMetallicRoughness": {"baseColorFactor": color},
                   "extensions": {"KHR_materials_unlit": {}}}
                  for name, color in (("red", [1, 0, 0, 1]), ("blue", [0, 0, 1, 1]))],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-4, -4, 0], "max": [4, 4, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + base64.b64encode(
        struct.pack("<9f", -4, -4, 0, 4, -4, 0, 0, 4, 0)).decode()}]}
# A triangle whose color and emission change: black at the beginning, which needs no emission then.
MOVING_MATERIAL = {
    "asset": {"version": "2.0"},
    "extensionsUsed": ["KHR_animation_pointer"],
    "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}, "emissiveFactor": [0, 0, 0]}],
    "animations": [{
        "samplers": [{"input": 1, "output": 2}, {"input": 1, "output": 3, "interpolation": "STEP"}],
        "channels": [{"sampler": i, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {
            "pointer": f"/materials/0/{name}"}}}}
            for i, name in enumerate(("emissiveFactor", "pbrMetallicRoughness/baseColorFactor"))]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-4, -4, 0], "max": [4, 4, 0]},
        {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0], "max": [2]},
        {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 3, "type": "VEC3"},
        {"bufferView": 0, "byteOffset": 84, "componentType": 5126, "count": 3, "type": "VEC4"}],
    "bufferViews": [{"buffer": 0, "byteLength": 132}],
    "buffers": [{"byteLength": 132, "uri": "data:application/octet-stream;base64," + base64.b64encode(struct.pack(
        "<33f", -4, -4, 0, 4, -4, 0, 0, 4, 0, 0, 1, 2, 0, 0, 0, 0.5, 0, 0.25, 0, 0.75, 0,
        1, 1, 1, 1, 0.2, 0.4, 0.6, 1, 0.1, 0.1, 0.1, 1)).decode()}]}
MOVING = ["Fox", "CesiumMan", "InterpolationTest", "AnimatedMorphCube", "BoxAnimated", "AnimatedMorphSphere"]


def model(name):
    return sorted((SHARED / "data/models/gltf" / name).rglob("*.gl*"))[0]


def part_of(cases):
    part, parts = map(int, SCOPE.split("/"))
    return cases[part::parts]


def cases():
    if SCOPE == "few":
        return FEW
    scenes = sorted(p for p in (FOLDER / "data/scenes").iterdir() if p.suffix in (".json", ".glb"))
    found = [str(model(name)) for name in MODELS] if SHARED else []
    return part_of([str(scene.relative_to(FOLDER)) for scene in scenes] + found)


class PageTest(unittest.TestCase):
    """Opens pages in one browser."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.work = pathlib.Path(cls.folder.name)
        cls.window = pages.open_browser()

    @classmethod
    def tearDownClass(cls):
        cls.window.close()
        cls.folder.cleanup()

    def scene(self, name, content):
        file = self.work / name
        file.write_text(json.dumps(content))
        return file

    def page(self, name, *arguments):
        file = self.work / name
        pages.relief_view(TOOL, *arguments, "--output", file)
        pages.open_page(self.window, file)
        return file

    def pixels(self, width=96, height=72):
        return pages.pixels(self.window, width, height)

    def run_in(self, script, *arguments):
        return self.window.run(f"const page = {pages.ROOT}.relief; {script}", *arguments)

    def tearDown(self):
        # The browser itself reports slow readings of pixels, and the lost context of a test.
        messages = [entry for entry in self.window.log("browser")
                    if "ReadPixels" not in entry["message"] and "CONTEXT_LOST" not in entry["message"]]
        self.assertEqual(messages, [], "the console has messages")


class ViewPage(PageTest):
    def test_draws_the_same_picture(self):
        for case in cases():
            with self.subTest(case):
                size = next((size for name, size in SIZE_OF.items() if name in case), SIZE)
                difference = pages.compared(TOOL, self.window, case.split(), self.work / "case", *size)
                share = difference["pixels_above"] / (size[0] * size[1])
                print(f"{difference['max']:5.0f} {share:9.5f} {difference['flip_mean']:9.5f}  {case}",
                      flush=True)
                self.assertLess(difference["flip_mean"], MAX_FLIP)
                self.assertLess(share, MAX_SHARE)

    def test_draws_all_passes(self):
        sky = {"folder": str(FOLDER / "data/sky")}
        for samples in (1, 4):
            for content in ({**PASSES, "environment": sky}, {**PASSES, "nodes": PASSES["nodes"][1:]}):
                file = self.scene("passes.json", content)
                difference = pages.compared(TOOL, self.window, [file, "--samples", samples], self.work / "case", *SIZE)
                self.assertLess(difference["flip_mean"], MAX_FLIP)
        for options in ("--show overdraw", "--show shading-normal", "--orthographic", "--shadow 2"):
            difference = pages.compared(TOOL, self.window, ["data/vase.obj", *options.split()], self.work / "case", *SIZE)
            self.assertLess(difference["flip_mean"], MAX_FLIP, options)

    def test_draws_second_texture_coordinates(self):
        content = json.loads(json.dumps(VARIANTS))
        del content["extensions"], content["extensionsUsed"], content["meshes"][0]["primitives"][0]["extensions"]
        content["meshes"][0]["primitives"][0]["attributes"] |= {"TEXCOORD_0": 1, "TEXCOORD_1": 2}
        content["materials"] = [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0, "texCoord": 1},
                                 "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}}]
        texels = bytes([255, 0, 0, 255] * 8 + [0, 0, 255, 255] * 8)
        pages.write_png(self.work / "texels.png", texels, 4, 4)
        content |= {"textures": [{"source": 0}], "images": [{"uri": "texels.png"}]}
        content["accessors"] += [{"bufferView": 0, "byteOffset": 36 + 24 * i, "componentType": 5126, "count": 3, "type": "VEC2"}
                                 for i in range(2)]
        content["bufferViews"][0]["byteLength"] = content["buffers"][0]["byteLength"] = 84
        content["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(struct.pack(
            "<21f", -4, -4, 0, 4, -4, 0, 0, 4, 0, 0, 0, 1, 0, 0, 1, 1, 1, 1, 0, 0, 1)).decode()
        file = self.scene("second.gltf", content)
        difference = pages.compared(TOOL, self.window, [file, "--samples", "1"], self.work / "case", *SIZE)
        self.assertLess(difference["flip_mean"], MAX_FLIP)
        self.assertGreater(len(self.run_in("return page.page.programs.flatMap((p) => p.fragment.second)")), 0)

    def test_offers_material_variants(self):
        self.page("variants.html", self.scene("variants.gltf", VARIANTS), "--samples", "1", "--camera", "0,0")
        self.assertEqual(self.run_in("return [...page.part('variant').options].map((o) => o.value)"),
                         ["default", "red", "blue"])
        for name, color in (("red", b"\xff\0\0\xff"), ("blue", b"\0\0\xff\xff")):
            self.run_in("const list = page.part('variant'); list.value = arguments[0];"
                        "list.dispatchEvent(new Event('change'))", name)
            middle = 4 * (96 * 40 + 48)
            self.assertEqual(self.pixels()[middle:middle + 4], color)

    def test_loads_nothing(self):
        self.window.log("performance")
        file = self.page("alone.html", "data/vase.obj", "--size", "64x64")
        requests = [a for a in self.window.requests() if not a.startswith(("data:", "blob:"))]
        self.assertEqual(requests, [file.resolve().as_uri()])
        self.assertIn("default-src 'none'", file.read_text())

    def test_orbits_zooms_pans_and_returns(self):
        self.page("orbit.html", "data/vase.obj")
        first = self.pixels()
        for key in ["ArrowLeft", "+"]:
            self.run_in("page.canvas.dispatchEvent(new KeyboardEvent('keydown', {key: arguments[0]}))", key)
            self.assertNotEqual(self.pixels(), first, key)
            self.run_in("page.canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'Home'}))")
            self.assertEqual(self.pixels(), first)
        self.run_in("page.pan(10, 0)")
        self.assertNotEqual(self.pixels(), first)
        self.run_in("page.part('reset').click()")
        self.assertEqual(self.pixels(), first)

    def test_survives_the_loss_of_the_context(self):
        self.page("loss.html", "data/vase.obj", "--height-map", "data/bricks-height.png")
        first = self.pixels()
        self.run_in("window.lost = page.painter.gl.getExtension('WEBGL_lose_context'); lost.loseContext()")
        self.window.wait_for("return document.querySelector('.relief').relief.painter.gl.isContextLost()")
        self.run_in(f"{pages.ROOT}.dataset.state = ''; setTimeout(() => lost.restoreContext(), 50)")
        self.window.wait_for(f"return {pages.ROOT}.dataset.state === 'ready'", 120)
        self.assertEqual(self.pixels(), first)

    def test_plays_only_when_asked(self):
        self.page("play.html", "data/scenes/illumination.json")
        self.assertFalse(self.run_in("return page.part('animation').hidden"))
        first = self.pixels()
        self.assertFalse(self.run_in("return Boolean(page.isPlaying)"))
        self.run_in("page.part('play').click()")
        self.window.wait_for(f"return {pages.ROOT}.relief.scene.time > 0.05")
        self.run_in("page.part('play').click()")
        self.assertNotEqual(self.pixels(), first)

    def test_moves_to_a_time_as_the_renderer_does(self):
        self.page("time.html", "data/scenes/illumination.json", "--size", "{}x{}".format(*SIZE))
        self.run_in("page.moveTo(1.5)")
        pages.write_png(self.work / "time.png", self.pixels(*SIZE), *SIZE)
        result = pages.relief_view(TOOL, "data/scenes/illumination.json", "--time", "1.5", "--size",
                                   "{}x{}".format(*SIZE), "--reference", self.work / "time.png",
                                   "--max-difference", 255)
        self.assertLess(result["comparison"]["flip_mean"], MAX_FLIP)

    def test_deforms_as_the_renderer_does(self):
        for name in part_of(MOVING) if SHARED else []:
            file = self.page("moving.html", model(name), "--time", "0.5", "--shadow", "2", "--size",
                             "{}x{}".format(*SIZE))
            pages.with_mesas_decoding(file)
            pages.open_page(self.window, file)
            self.run_in("page.moveTo(0.1); page.moveTo(0.5)")
            pages.write_png(self.work / "moving.png", self.pixels(*SIZE), *SIZE)
            result = pages.relief_view(TOOL, model(name), "--time", "0.5", "--shadow", "2", "--size",
                                       "{}x{}".format(*SIZE), "--reference", self.work / "moving.png",
                                       "--max-difference", 255)
            self.assertLess(result["comparison"]["flip_mean"], MAX_FLIP, name)

    def test_offers_views(self):
        self.page("views.html", "data/vase.obj", "--page-views", "shading-normal,diffuse")
        self.assertEqual(self.run_in("return [...page.part('view').options].map((o) => o.value)"),
                         ["picture", "shading-normal", "diffuse"])
        first = self.pixels()
        self.run_in("const list = page.part('view'); list.value = 'diffuse'; list.dispatchEvent(new Event('change'))")
        self.assertNotEqual(self.pixels(), first)

    def test_quantizes_vertices(self):
        difference = pages.compared(TOOL, self.window, ["data/vase.obj"], self.work / "case", *SIZE,
                                    page_options=["--page-quantize"])
        self.assertLess(difference["flip_mean"], MAX_FLIP)

    def lost_pixels(self, a, b):
        """Pixels of a whose color, and nothing near it, is in b within a pixel."""
        width, height = SIZE
        lost = 0
        for y in range(height):
            for x in range(width):
                at = 4 * (width * y + x)
                near = (4 * (width * row + column) for row in range(max(y - 1, 0), min(y + 2, height))
                        for column in range(max(x - 1, 0), min(x + 2, width)))
                lost += a[at:at + 3] != b[at:at + 3] and all(
                    max(abs(a[at + k] - b[other + k]) for k in range(3)) > 16 for other in near)
        return lost

    def test_draws_overlays(self):
        # OpenGL lets a line take neighboring pixels, and the two rasterizers choose others.
        vase = "data/vase.obj --samples 1"
        for options, kinds in (("--wireframe", ["wireframe"]), ("--grid --camera 200,40", ["grid"] * 4),
                               ("--vertex-frames --frame-length 0.02", ["frames"] * 3),
                               ("--grid --wireframe --health-markers all", ["grid"] * 4 + ["wireframe", "markers"])):
            difference = pages.compared(TOOL, self.window, [*vase.split(), *options.split()], self.work / "case", *SIZE)
            self.assertEqual(self.run_in("return page.page.pictures[0].overlays.map((o) => o.kind)"), kinds)
            picture, drawn = pages.read_png(self.work / "case/picture.png"), pages.read_png(self.work / "case/page.png")
            lost = [self.lost_pixels(picture, drawn), self.lost_pixels(drawn, picture)]
            print(f"{difference['max']:5.0f} {difference['flip_mean']:9.5f} {lost}  {options}", flush=True)
            self.assertLess(max(lost), 0.003 * SIZE[0] * SIZE[1], options)
            self.assertLess(difference["flip_mean"], 0.08, options)
            # They are seen, and are part of the picture of a moved camera, too.
            self.run_in("page.page.pictures[0].overlays = []")
            plain = self.pixels(*SIZE)
            self.assertGreater(sum(plain[i:i + 3] != drawn[i:i + 3] for i in range(0, len(drawn), 4)), 100, options)

    def test_stores_normal_maps_in_less_space(self):
        # Heights whose left and right borders differ, so that they continue beyond these.
        width, height = 64, 48
        heights = bytes(min(255, 2 * x + (60 if (x // 8 + y // 12) % 2 else 0)) for y in range(height) for x in range(width))
        pages.write_png(self.work / "heights.png", heights, width, height, channels=1)
        bake = pathlib.Path(TOOL).parent / "relief-bake"
        subprocess.run([bake, "bump", self.work / "heights.png", "-o", self.work / "normals.png", "--bits", "16", "--quiet"], check=True)
        vase = ["data/vase.obj", "--show", "shading-normal"]
        texels = {}
        for name, field, options in (("central5", "heights", ["--height-map", self.work / "heights.png", "--kernel", "central5"]),
                                     ("gaussian", "heights", ["--height-map", self.work / "heights.png", "--kernel", "gaussian"]),
                                     ("file", "z", ["--normal-map", self.work / "normals.png"])):
            difference = pages.compared(TOOL, self.window, [*vase, *options], self.work / "case", *SIZE)
            self.assertLess(difference["flip_mean"], MAX_FLIP, name)
            self.assertLess(difference["pixels_above"] / (SIZE[0] * SIZE[1]), MAX_SHARE, name)
            texels[name] = self.run_in("const t = page.page.textures.find((t) => arguments[0] in t); return t && Array.from(page.data.spread(t).samples)", field)
            self.assertEqual(len(texels[name] or []), 4 * width * height, name)
            if field == "heights":
                self.assertEqual(self.run_in("return page.page.textures.find((t) => t.heights).heights.wraps[0]"), False)
        # The slope of the ramp across the left border: the height rises by 2 / 255 of 16 texels.
        slope = 16 * 2 / 255
        x, _, z = [value * 65535 / 32767 - 32768 / 32767 for value in texels["central5"][:3]]
        self.assertAlmostEqual(x / z, -slope, delta=1e-3)

    def test_fits_a_phone(self):
        self.page("phone.html", "data/scenes/illumination.json")
        self.window.resize(390, 844, is_phone=True)
        self.assertEqual(self.window.run("return document.scrollingElement.scrollWidth"), 390)
        self.assertEqual(self.window.run("return document.scrollingElement.scrollHeight"), 844)
        outside = ("return [...page.root.querySelectorAll('canvas, button, input, select, summary')].filter((e) => e.checkVisibility())"
                   ".map((e) => e.getBoundingClientRect()).filter((b) => b.left < 0 || b.right > 390 || b.bottom > 844).length")
        self.assertEqual(self.run_in(outside), 0)
        self.assertGreater(self.run_in("return page.canvas.getBoundingClientRect().height"), 500)
        self.run_in("page.part('shader').open = true")
        self.assertEqual(self.run_in(outside), 0)
        self.assertEqual(self.window.run("return document.scrollingElement.scrollWidth"), 390)
        self.assertGreater(self.run_in("return page.canvas.getBoundingClientRect().height"), 200)
        self.window.resize(1280, 900)

    def test_respects_reduced_motion(self):
        for value in ("reduce", "no-preference"):
            self.window.devtools("Emulation.setEmulatedMedia",
                                 features=[{"name": "prefers-reduced-motion", "value": value}])
            self.page("still.html", "data/scenes/illumination.json", "--size", "64x64")
            self.run_in("page.drawn = 0; const draw = page.draw; page.draw = (...size) => { page.drawn++; draw.apply(page, size); };"
                        "page.orbit(0.3, 0.1)")
            self.window.wait_for(f"return {pages.ROOT}.relief.drawn > 0")
            # Nothing moves by itself: neither the scene, nor the camera after it was let go.
            before = self.run_in("return JSON.stringify(page.camera)")
            self.window.run("return new Promise((done) => setTimeout(done, 400))")
            self.assertEqual(self.run_in("return [page.drawn, page.scene.time, Boolean(page.isPlaying)]"), [1, 0, False])
            self.assertEqual(self.run_in("return JSON.stringify(page.camera)"), before)
            self.assertEqual(self.window.run("return document.getAnimations().length"), 0)
        self.window.devtools("Emulation.setEmulatedMedia", features=[])

    def test_has_the_numbers_of_constants(self):
        header = pathlib.Path(__file__).resolve().parents[3] / "tools/page/webgl_constants.h"
        rows = re.findall(r'\{"(\w+)", (\w+)\}', header.read_text())
        self.assertGreater(len(rows), 70)
        self.page("constants.html", "data/vase.obj", "--size", "64x64")
        for name, value in rows:
            self.assertEqual(self.run_in("return page.painter.gl[arguments[0]]", name), int(value, 16), name)

    def test_says_what_is_missing(self):
        file = self.work / "missing.html"
        pages.relief_view(TOOL, "data/vase.obj", "--size", "64x64", "--output", file)
        text = file.read_text().replace("getContext('webgl2'", "getContext('webgl9'")
        file.write_text(text)
        with self.assertRaisesRegex(RuntimeError, "WebGL 2"):
            pages.open_page(self.window, file)


class LessonPage(PageTest):
    """Sides, steps, shaders, explained pixels, and several pages."""

    def split_at(self, share):
        self.run_in("page.split.move(arguments[0])", share)
        return self.pixels(*SIZE)

    def test_splits_two_pictures(self):
        bricks = ["data/vase.obj", "--height-map", "data/bricks-height.png", "--strength", "20", "--size", "{}x{}".format(*SIZE)]
        self.page("split.html", *bricks, "--kernel", "scharr3", "--compare", "kernel=central5", "--split", "0.25")
        self.assertEqual(self.run_in("return [page.split.at, page.part('split').hidden, page.part('split').textContent]"),
                         [0.25, False, "vase.objkernel=central5"])
        both, left, right = self.pixels(*SIZE), self.split_at(1), self.split_at(0)
        self.assertNotEqual(left, right)
        width, height = SIZE
        for y in range(height):
            row, line = slice(4 * width * y, 4 * width * (y + 1)), 4 * width // 4
            self.assertEqual(both[row], left[row][:line] + right[row][line:])
        for kernel, drawn in (("scharr3", left), ("central5", right)):
            pages.write_png(self.work / "side.png", drawn, *SIZE)
            result = pages.relief_view(TOOL, *bricks, "--kernel", kernel, "--reference", self.work / "side.png",
                                       "--max-difference", 255)
            self.assertLess(result["comparison"]["flip_mean"], MAX_FLIP, kernel)
        self.run_in("page.part('split').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'}))")
        self.assertAlmostEqual(self.run_in("return page.split.at"), 0.02)
        # Both sides of a comparison with the file itself are the same, also when it moves.
        for scene in ("data/scenes/illumination.json", "data/vase.obj"):
            self.page("same.html", scene, "--compare-to", scene, "--size", "{}x{}".format(*SIZE))
            self.run_in("page.scene.duration > 0 && page.moveTo(0.7); page.orbit(0.3, 0.1)")
            self.assertEqual(self.split_at(0), self.split_at(1), scene)

    def test_shows_steps(self):
        scene = ["data/scenes/environment-mapping.json", "--size", "{}x{}".format(*SIZE)]
        result = pages.relief_view(TOOL, *scene, "--steps", "--output", self.work / "step-#.png")
        file = self.page("steps.html", *scene, "--steps")
        pages.with_mesas_decoding(file)
        pages.open_page(self.window, file)
        names = [step["name"] for step in result["steps"]]
        self.assertEqual(self.run_in("return page.page.steps.map((s) => s.name)"), names)
        self.assertGreater(len(names), 2)
        before = None
        for i, name in enumerate(names):
            self.run_in("const list = page.part('step'); list.value = arguments[0] + 1; list.dispatchEvent(new Event('input'))", i)
            self.assertTrue(self.run_in("return page.part('what').textContent").startswith(name))
            first = self.run_in("return page.part('address').value")
            self.assertIn(first, result["steps"][i]["parts"] or [first])
            drawn = self.pixels(*SIZE)
            self.assertNotEqual(drawn, before)
            before = drawn
            picture = pages.read_png(sorted(self.work.glob("step-*.png"))[i])
            share = sum(max(abs(drawn[k + c] - picture[k + c]) for c in range(4)) > 2 for k in range(0, len(drawn), 4))
            self.assertLess(share / (SIZE[0] * SIZE[1]), MAX_SHARE, name)

    def test_edits_shaders(self):
        self.page("edit.html", "data/vase.obj")
        first = self.pixels()
        self.run_in("page.part('shader').open = true")
        self.assertIn("phong.glsl#lambert", self.run_in("return [...page.part('address').options].map((o) => o.value)"))
        self.run_in("const list = page.part('address'); list.value = 'phong.glsl#lambert'; list.dispatchEvent(new Event('change'))")
        original = self.run_in("return page.editor.code.value")
        self.assertIn("return diffuse_color * n_dot_l;", original)
        edit = ("page.editor.code.value = arguments[0]; page.editor.code.dispatchEvent(new Event('input'))")
        marks = "return page.part('marks').textContent"
        # It applies by itself when typing pauses.
        self.run_in(edit, original.replace("* n_dot_l;", "* n_dot_l * 0.25;"))
        self.assertEqual(self.pixels(), first)
        self.window.wait_for(f"return {pages.ROOT}.relief.data.parts['phong.glsl#lambert'].includes('0.25')")
        self.assertEqual(self.run_in(marks), "")
        darker = self.pixels()
        self.assertLess(sum(darker), sum(first))
        # An error stands at its line, and the picture stays.
        wrong = original.replace("return diffuse_color", "return diffuse_colour")
        self.run_in(edit, wrong)
        self.window.wait_for(f"{marks.replace('page.', pages.ROOT + '.relief.')} !== ''")
        message = self.run_in(marks).split("\n")
        line = next(i for i, text in enumerate(wrong.split("\n")) if "diffuse_colour" in text)
        self.assertEqual(len(message), line + 1)
        self.assertIn("'diffuse_colour' : undeclared identifier", message[line])
        self.assertEqual(self.pixels(), darker)
        # The difference to the original, and back.
        self.run_in("page.part('difference').click()")
        shown = self.run_in("return page.editor.code.value").split("\n")
        self.assertEqual([text[:1] for text in shown if "diffuse_colo" in text and "return" in text], ["-", "+"])
        self.run_in("page.part('difference').click(); page.part('undo').click()")
        self.assertEqual(self.run_in("return page.editor.code.value"), original)
        self.assertEqual(self.run_in(marks), "")
        self.assertEqual(self.pixels(), first)
        # What is saved replaces the part on the command line.
        self.run_in(edit, original.replace("* n_dot_l;", "* n_dot_l * 0.25;"))
        self.run_in("page.editor.apply(); window.saved = ''; const make = URL.createObjectURL;"
                    "URL.createObjectURL = (blob) => { blob.text().then((text) => window.saved = text); return make(blob); };"
                    "HTMLAnchorElement.prototype.click = function() { window.file = this.download; }; page.part('save').click()")
        self.window.wait_for("return window.saved")
        (self.work / "shaders").mkdir()
        (self.work / "shaders" / self.window.run("return window.file")).write_text(self.window.run("return window.saved"))
        os.environ["RELIEF_SHADER_DIR"] = str(self.work / "shaders")
        try:
            self.page("saved.html", "data/vase.obj")
        finally:
            del os.environ["RELIEF_SHADER_DIR"]
        self.assertEqual(self.pixels(), darker)

    def check_footprints(self, drawn):
        """A chosen pixel shows its textures, with a cross at the place of the lookup."""
        self.run_in("page.probes.choose(page.probes.probes.find((p) => p.lookups.length === 2))")
        self.window.wait_for(f"return {pages.ROOT}.relief.part('lookups').children.length === 2")
        probe = self.run_in("return page.probes.chosen")
        places = re.findall(r"texel \(([-\d.]+), ([-\d.]+)\) of (\d+) x (\d+), linear, footprint ([\d.]+) x ([\d.]+)", probe["text"])
        self.assertEqual(len(places), 2)
        for i, (lookup, place) in enumerate(zip(probe["lookups"], places)):
            x, y, width, height, longer, shorter = map(float, place)
            self.assertAlmostEqual(lookup["at"][0] * width, x, delta=0.006)
            self.assertAlmostEqual(lookup["at"][1] * height, y, delta=0.006)
            right, down = ([value * side for value, side in zip(lookup[way], (width, height))] for way in ("right", "down"))
            # The axes of an ellipse span the area of its conjugate radii.
            area = abs(right[0] * down[1] - right[1] * down[0])
            self.assertAlmostEqual(area, longer * shorter, delta=0.02 * area)
            ink = self.run_in("const canvas = page.part('lookups').children[arguments[0]], at = page.probes.chosen.lookups[arguments[0]].at;"
                              "const [x, y] = at.map((v, k) => Math.floor((v - Math.floor(v)) * [canvas.width, canvas.height][k]));"
                              "return [canvas.width, canvas.height, ...canvas.getContext('2d').getImageData(x, y, 1, 1).data]", i)
            self.assertEqual(ink, [width, height, 255, 220, 60, 255])
        # What the page draws stays the same.
        self.run_in("page.probes.choose(null)")
        self.assertTrue(self.run_in("return page.part('lookups').hidden || new Promise((done) => setTimeout(() => done(page.part('lookups').hidden), 100))"))
        self.assertEqual(self.pixels(*SIZE), drawn)

    def test_explains_pixels(self):
        for scene in ("data/vase.obj --height-map data/bricks-height.png", "data/vase.obj --material gold",
                      "data/scenes/illumination.json"):
            self.page("probes.html", *scene.split(), "--samples", "1", "--size", "{}x{}".format(*SIZE), "--page-probes", "8x6")
            probes = self.run_in("return page.page.probes")
            self.assertGreater(len(probes), 5)
            drawn = self.pixels(*SIZE)
            for probe in probes:
                for k in range(3):
                    total = sum(value[k] for _, value in probe["terms"])
                    self.assertAlmostEqual(total, probe["radiance"][k], delta=1e-9)
                at = 4 * (SIZE[0] * probe["y"] + probe["x"])
                # The reference does not average textures, and says so.
                is_edge = "rounding may decide this pixel, or a texture is averaged" in probe["text"]
                self.assertEqual(is_edge, "--height-map" in scene)
                if not is_edge:
                    self.assertLessEqual(max(abs(drawn[at + k] - probe["codes"][k]) for k in range(4)), 1)
            if "bricks" in scene:
                self.check_footprints(drawn)
        self.assertFalse(self.run_in("return page.part('explain').hidden"))
        self.run_in("page.part('explain').click()")
        text = self.run_in("return page.part('probe').textContent")
        self.assertRegex(text, r"(?s)terms.*diffuse, .* = .*sum: .*this page\n  one sample: codes \d+ \d+ \d+")
        self.window.wait_for(f"return {pages.ROOT}.relief.part('arrows').children.length > 5")
        labels = self.run_in("return [...page.part('arrows').querySelectorAll('text')].map((t) => t.textContent)")
        self.assertTrue({"n", "v", "l1", "h1", "r1"} <= set(labels), labels)
        # The lobe has its peak in the direction of the mirrored light.
        self.run_in("page.probes.choose(page.probes.probes.find((p) => p.lobe))")
        self.window.wait_for(f"return {pages.ROOT}.relief.part('arrows').querySelector('path[fill-opacity]')")
        lobe = self.run_in("return page.probes.chosen.lobe")
        self.assertEqual(lobe["shares"][0], [1] * 12)
        self.assertLess(lobe["shares"][4][0], 1)
        self.assertEqual(self.run_in("return page.part('arrows').querySelectorAll('path[fill-opacity]').length"), 8)
        # A click chooses the point below the pointer.
        last = self.run_in("const p = page.probes.probes.at(-1); page.probes.pick(...page.probes.place(p.at)); return page.probes.chosen === p")
        self.assertTrue(last)

    def test_moves_materials_as_the_renderer_does(self):
        file = self.scene("moving.gltf", MOVING_MATERIAL)
        self.page("materials.html", file, "--samples", "1", "--camera", "0,0", "--size", "96x72")
        middle = slice(4 * (96 * 40 + 48), 4 * (96 * 40 + 48) + 4)
        colors = set()
        for seconds in (0, 0.3, 0.5, 0.99, 1, 1.7):
            self.run_in("page.moveTo(arguments[0])", seconds)
            drawn = self.pixels()[middle]
            pages.relief_view(TOOL, file, "--samples", "1", "--camera", "0,0", "--size", "96x72", "--time", seconds,
                              "--output", self.work / "then.png")
            expected = pages.read_png(self.work / "then.png")[middle]
            self.assertLessEqual(max(abs(a - b) for a, b in zip(drawn, expected)), 1, (seconds, drawn, expected))
            colors.add(drawn)
        self.assertEqual(len(colors), 6)

    def test_two_pages_at_once(self):
        sources = {"vase": ["data/vase.obj", "--height-map", "data/bricks-height.png"],
                   "illumination": ["data/scenes/illumination.json"]}
        alone = {}
        for name, arguments in sources.items():
            self.page(f"{name}.html", *arguments)
            alone[name] = self.pixels()
        frames = "".join(f'<iframe srcdoc="{html.escape((self.work / name).with_suffix(".html").read_text())}"></iframe>'
                         for name in sources)
        both = self.work / "both.html"
        both.write_text(f"<!doctype html><title>both</title>{frames}")
        self.window.open(both)
        root = "frames[arguments[0]].document.querySelector('.relief')"
        self.window.wait_for(f"return [0, 1].every((i) => {root.replace('arguments[0]', 'i')}?.dataset.state === 'ready')", 300)
        drawn = [self.window.run(f"return {root}.relief.pixels(96, 72)", i) for i in (0, 1, 0)]
        self.assertNotEqual(drawn[0], drawn[1])
        self.assertEqual(drawn[0], drawn[2])
        for name, coded in zip(sources, drawn):
            rows = base64.b64decode(coded)
            self.assertEqual(b"".join(rows[384 * y:384 * (y + 1)] for y in reversed(range(72))), alone[name])


def main():
    """Runs the tests of the script that was started, which may be another one that uses PageTest."""
    global TOOL, FOLDER, SCOPE, SHARED
    TOOL, FOLDER, SCOPE = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
    SHARED = pathlib.Path(sys.argv[4]) if sys.argv[4] and pathlib.Path(sys.argv[4]).is_dir() else None
    if pages.browser.programs() is None:
        print("needs chromium and chromedriver", file=sys.stderr)
        sys.exit(77)
    os.chdir(FOLDER)
    unittest.main(argv=[sys.argv[0], *sys.argv[5:]])


if __name__ == "__main__":
    main()
