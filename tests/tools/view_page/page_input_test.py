#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pages in a headless browser that get events of a mouse, a touch screen and a keyboard, and the
preferences of a user: page_input_test.py with the arguments of view_page_test.py.
"""
import base64
import math
import struct

import pages
import view_page_test
from view_page_test import PageTest

# A triangle that one clip moves by 2 in 1 s, and another one scales to 3 in 2 s.
CLIPS = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "animations": [
        {"name": name, "samplers": [{"input": 1 + 2 * i, "output": 2 + 2 * i}],
         "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}]}
        for i, (name, path) in enumerate((("slide", "translation"), ("grow", "scale")))],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-4, -4, 0], "max": [4, 4, 0]},
        {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
        {"bufferView": 0, "byteOffset": 44, "componentType": 5126, "count": 2, "type": "VEC3"},
        {"bufferView": 0, "byteOffset": 68, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2]},
        {"bufferView": 0, "byteOffset": 76, "componentType": 5126, "count": 2, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 100}],
    "buffers": [{"byteLength": 100, "uri": "data:application/octet-stream;base64," + base64.b64encode(struct.pack(
        "<25f", -4, -4, 0, 4, -4, 0, 0, 4, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 2, 1, 1, 1, 3, 3, 3)).decode()}]}

# Draws a slope over the half of a pixel's samples that is right of its center, behind a plane that it
# meets there: the share of the slope that is seen.
SLOPE = """
const gl = document.createElement('canvas').getContext('webgl2'), program = gl.createProgram();
for (const [kind, text] of [
  [gl.VERTEX_SHADER, `#version 300 es
    uniform vec2 line; // Where the triangle begins, and its slope.
    void main() {
      vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - vec2(line.y == 0.0 ? 1.0 : -line.x, 1.0);
      gl_Position = vec4(corner, line.y * (corner.x - line.x), 1);
    }`],
  [gl.FRAGMENT_SHADER, `#version 300 es
    precision highp float; uniform float gray; out vec4 color; void main() { color = vec4(gray); }`]]) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  gl.attachShader(program, shader);
}
gl.linkProgram(program);
gl.useProgram(program);
const target = (samples) => {
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  for (const [format, place] of [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
    const buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, 16, 16);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
  }
  return gl.getParameter(gl.FRAMEBUFFER_BINDING);
};
const drawn = target(4), resolved = target(0);
gl.enable(gl.DEPTH_TEST);
gl.depthFunc(gl.LEQUAL);
gl.viewport(0, 0, 16, 16);
return [0.5, -0.5].map((slope) => {
  gl.bindFramebuffer(gl.FRAMEBUFFER, drawn);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  for (const [gray, of] of [[0, 0], [1, slope]]) {
    gl.uniform1f(gl.getUniformLocation(program, 'gray'), gray);
    gl.uniform2f(gl.getUniformLocation(program, 'line'), 8.5 / 8 - 1, of);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
  gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, resolved);
  gl.blitFramebuffer(0, 0, 16, 16, 0, 0, 16, 16, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, resolved);
  const code = new Uint8Array(4);
  gl.readPixels(8, 8, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, code);
  return code[0] / 255;
});
"""


class PageInput(PageTest):
    def camera(self):
        """Target, distance, azimuth, elevation and axes of the page's camera."""
        matrix, target = self.run_in("const c = page.own(); return [c.matrix, page.target]")
        right, up, back, eye = (matrix[4 * i:4 * i + 3] for i in range(4))
        distance = math.dist(eye, target)
        return {"target": target, "distance": distance, "azimuth": math.atan2(back[0], back[2]),
                "elevation": math.asin(back[1]), "right": right, "up": up}

    def expect(self, before, azimuth=0.0, elevation=0.0, zoom=1.0, pan=(0, 0), drift=0.0):
        """Expects this change of the camera. pan is in pixels that the point in the middle moves, and
        drift in pixels that it may move otherwise.
        """
        after = self.camera()
        self.assertAlmostEqual(after["azimuth"], before["azimuth"] + azimuth, delta=1e-4)
        self.assertAlmostEqual(after["elevation"], before["elevation"] + elevation, delta=1e-4)
        self.assertAlmostEqual(after["distance"], before["distance"] * zoom, delta=1e-4 * before["distance"])
        fov, height = self.run_in("const b = page.canvas.getBoundingClientRect();"
                                  "return [page.fitted(b.width / b.height).fov, b.height]")
        per_pixel = 2 * math.tan(fov / 2) * before["distance"] / height
        for k in range(3):
            shift = -pan[0] * per_pixel * before["right"][k] + pan[1] * per_pixel * before["up"][k]
            self.assertAlmostEqual(after["target"][k], before["target"][k] + shift,
                                   delta=1e-4 * before["distance"] + drift * per_pixel)

    def mouse(self, kind, x, y, **more):
        self.window.devtools("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def drag(self, button="left", modifiers=0):
        """Drags by 40 pixels to the right and 25 down."""
        bit = {"left": 1, "right": 2, "middle": 4}[button]
        self.mouse("mousePressed", 300, 200, button=button, buttons=bit, clickCount=1, modifiers=modifiers)
        for share in (0.5, 1):
            self.mouse("mouseMoved", 300 + 40 * share, 200 + 25 * share, button=button, buttons=bit, modifiers=modifiers)
        self.mouse("mouseReleased", 340, 225, button=button, buttons=0, clickCount=1, modifiers=modifiers)

    def touch(self, kind, *points):
        self.window.devtools("Input.dispatchTouchEvent", type=kind,
                             touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)])
        # Movements arrive with the next frame, and several ones before it as one.
        self.window.run("return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def key(self, key, code, modifiers=0):
        for kind in ("keyDown", "keyUp"):
            self.window.devtools("Input.dispatchKeyEvent", type=kind, key=key, code=code, modifiers=modifiers)

    def test_follows_the_mouse(self):
        self.page("mouse.html", "data/vase.obj", "--size", "64x48")
        before = self.camera()
        self.drag()
        self.expect(before, azimuth=-0.4, elevation=0.25)
        shift = 8
        for button, modifiers in (("left", shift), ("right", 0), ("middle", 0)):
            before = self.camera()
            self.drag(button, modifiers)
            self.expect(before, pan=(40, 25))
        before = self.camera()
        self.mouse("mouseWheel", 300, 200, deltaX=0, deltaY=-200)
        self.window.wait_for(f"return {pages.ROOT}.relief.own().matrix && true")
        self.expect(before, zoom=math.exp(-0.3))
        for count in (1, 2):
            self.mouse("mousePressed", 300, 200, button="left", buttons=1, clickCount=count)
            self.mouse("mouseReleased", 300, 200, button="left", buttons=0, clickCount=count)
        self.assertIsNone(self.run_in("return page.camera"))

    def test_follows_fingers(self):
        self.page("touch.html", "data/vase.obj", "--size", "64x48")
        before = self.camera()
        self.touch("touchStart", (300, 200))
        self.touch("touchMove", (320, 200))
        self.touch("touchMove", (340, 225))
        self.touch("touchEnd")
        self.expect(before, azimuth=-0.4, elevation=0.25)
        # Two fingers move together, and then apart: the gap of 100 pixels doubles. Each finger has an
        # event of its own, between which the gap is another one: small steps across it keep it.
        before = self.camera()
        self.touch("touchStart", (300, 200), (400, 200))
        for y in range(202, 222, 2):
            self.touch("touchMove", (300, y), (400, y))
        self.expect(before, pan=(0, 20))
        before = self.camera()
        for apart in range(2, 52, 2):
            self.touch("touchMove", (300 - apart, 220), (400 + apart, 220))
        self.expect(before, zoom=0.5, drift=1)  # Half a step at the first and at the last distance.
        self.touch("touchEnd")
        self.assertEqual(self.window.run("return [scrollX, scrollY, visualViewport.scale]"), [0, 0, 1])

    def test_follows_keys(self):
        self.page("keys.html", "data/scenes/illumination.json", "--size", "64x48")
        self.key("Tab", "Tab")
        self.assertTrue(self.run_in("return document.activeElement === page.canvas"))
        shift = 8
        for key, code, modifiers, change in (
                ("ArrowRight", "ArrowRight", 0, {"azimuth": 0.1}), ("ArrowDown", "ArrowDown", 0, {"elevation": -0.1}),
                ("ArrowLeft", "ArrowLeft", 0, {"azimuth": -0.1}), ("ArrowUp", "ArrowUp", 0, {"elevation": 0.1}),
                ("ArrowLeft", "ArrowLeft", shift, {"pan": (20, 0)}), ("ArrowUp", "ArrowUp", shift, {"pan": (0, 20)}),
                ("+", "Equal", shift, {"zoom": 1 / 1.1}), ("-", "Minus", 0, {"zoom": 1.1})):
            with self.subTest(key, modifiers=modifiers):
                before = self.camera()
                self.key(key, code, modifiers)
                self.expect(before, **change)
        for _ in range(40):
            self.key("ArrowUp", "ArrowUp")
        self.assertAlmostEqual(self.camera()["elevation"], 1.55, delta=1e-4)  # It doesn't go over the pole.
        self.key("Home", "Home")
        self.assertIsNone(self.run_in("return page.camera"))
        for is_playing in (True, False):
            self.key(" ", "Space")
            self.assertEqual(self.run_in("return [page.isPlaying, page.part('play').textContent]"),
                             [is_playing, "Pause" if is_playing else "Play"])

    def test_plays_one_clip_or_all(self):
        self.page("clips.html", self.scene("clips.gltf", CLIPS), "--size", "64x48")
        self.assertEqual(self.run_in("return [...page.part('clip').options].map((o) => o.value)"), ["all", "slide", "grow"])
        # The end of the slider, and x and scale at 1.5 s: a clip begins again after its own duration.
        for clip, duration, x, scale in (("slide", 1, 1, 1), ("grow", 2, 0, 2.5), ("all", 2, 1, 2.5), ("slide", 1, 1, 1)):
            with self.subTest(clip):
                self.run_in("const list = page.part('clip'); list.value = arguments[0]; list.dispatchEvent(new Event('change'))", clip)
                self.assertEqual(self.run_in("return [page.scene.duration, Number(page.part('time').max), page.scene.time]"),
                                 [duration, duration, 0])
                self.run_in("page.moveTo(1.5)")
                matrix = self.run_in("return page.scene.matrices[0]")
                self.assertAlmostEqual(matrix[12], x, delta=1e-6)
                self.assertAlmostEqual(matrix[0], scale, delta=1e-6)

    def test_is_light_or_dark(self):
        for scheme, paper in (("light", 1.0), ("dark", 0.0)):
            self.window.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
            self.page("theme.html", "data/vase.obj", "--size", "64x48")
            colors = self.run_in("const s = getComputedStyle(document.body); return [s.backgroundColor, s.color]"
                                 ".map((c) => c.match(/\\d+/g).slice(0, 3).map(Number))")
            light = [sum(f * ((c / 255 + 0.055) / 1.055) ** 2.4 for f, c in zip((0.2126, 0.7152, 0.0722), color)) for color in colors]
            self.assertAlmostEqual(light[0], paper, delta=0.02)
            self.assertGreater((max(light) + 0.05) / (min(light) + 0.05), 7, "the contrast of text [WCAG 2.2, 1.4.6]")
        self.window.devtools("Emulation.setEmulatedMedia", features=[])

    def test_knows_the_depths_of_samples(self):
        # SwiftShader compares the depth of the place that is mirrored at the pixel's center: it shows
        # the far half of the slope, and hides the near one. If this fails, SwiftShader is mended, and
        # view_page_test.py needs no size of its own for small spheres with two sides.
        self.page("depths.html", "data/vase.obj", "--size", "64x48")
        far, near = self.window.run(SLOPE)
        self.assertAlmostEqual(far, 0.5, delta=0.01)
        self.assertAlmostEqual(near, 0.0, delta=0.01)


if __name__ == "__main__":
    view_page_test.main()
