# SPDX-License-Identifier: Apache-2.0
"""Pages of relief-view in a headless browser: their pixels as PNG files, compared with the pictures
of the command line.
"""
import base64
import json
import pathlib
import struct
import subprocess
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "accuracy_page"))
import browser  # noqa: E402

FLAGS = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
ROOT = "document.querySelector('.relief')"


def open_browser():
    return browser.Browser(FLAGS)


def open_page(window, page):
    """Waits until the page has drawn; its message is an error."""
    window.open(pathlib.Path(page))
    window.wait_for(f"return ['ready', 'failed'].includes({ROOT}.dataset.state)", 300)
    message = window.run(f"return {ROOT}.querySelector('[data-part=message]').textContent")
    if message:
        raise RuntimeError(message)


def pixels(window, width, height):
    """The picture of the page as rows of RGBA from the top."""
    coded = window.run(f"return {ROOT}.relief.pixels(arguments[0], arguments[1])", width, height)
    rows = base64.b64decode(coded)
    return b"".join(rows[4 * width * y:4 * width * (y + 1)] for y in reversed(range(height)))


def write_png(file, samples, width, height, channels=4):
    """Writes rows of 8-bit gray (channels=1) or RGBA."""
    def chunk(kind, content):
        body = kind + content
        return struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body))
    size = channels * width
    lines = b"".join(b"\0" + samples[size * y:size * (y + 1)] for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 4: 6}[channels], 0, 0, 0)
    pathlib.Path(file).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                                   chunk(b"IDAT", zlib.compress(lines, 1)) + chunk(b"IEND", b""))


def relief_view(tool, *arguments):
    """Runs the tool and returns its JSON."""
    command = [tool, *map(str, arguments), "--json", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True)
    if not done.stdout:
        raise RuntimeError(f"{' '.join(command)}: {done.stderr}")
    return json.loads(done.stdout)


def read_png(file):
    """Rows of 8-bit RGB or RGBA as the tool writes them, as RGBA. `relief-view` checks all else."""
    data = pathlib.Path(file).read_bytes()
    width, height, _, kind = struct.unpack(">IIBB", data[16:26])
    channels = {2: 3, 6: 4}[kind]
    packed, at = b"", 8
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        if name == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    lines = zlib.decompress(packed)
    size = width * channels
    above, rgba = bytearray(size), bytearray()
    for y in range(height):
        start = y * (size + 1)
        row = bytearray(lines[start + 1:start + 1 + size])
        for i in range(size):
            left = row[i - channels] if i >= channels else 0
            corner = above[i - channels] if i >= channels else 0
            guess = left + above[i] - corner
            nearest = min((abs(guess - left), 0, left), (abs(guess - above[i]), 1, above[i]),
                          (abs(guess - corner), 2, corner))[2]
            row[i] = (row[i] + [0, left, above[i], (left + above[i]) // 2, nearest][lines[start]]) & 255
        above = row
        for i in range(0, size, channels):
            rgba += row[i:i + channels] + (b"\xff" if channels == 3 else b"")
    return bytes(rgba)


# Mesa's rasterizer, with which the command line draws here, decodes sRGB texels by a cubic
# polynomial (lp_build_srgb_to_linear), which is up to 0.4 % too bright: 0.2 of an 8-bit code on
# average, of which FLIP sees up to 0.015. This script, before that of the page, uploads such texels
# as it decodes them, so that all other differences show.
DECODING = """<script>
const mesaLight = (c) => (c <= 10.3 ? c / 3294.6 : 0.0023 + 0.003 * c / 255 + 0.6935 * (c / 255) ** 2 + 0.3012 * (c / 255) ** 3);
const mesaLights = Float32Array.from({length: 256}, (_, c) => mesaLight(c));
const {prototype} = WebGL2RenderingContext, {texImage2D} = prototype;
prototype.texImage2D = function(...all) {
  if (all[2] === this.SRGB8_ALPHA8)
    [all[2], all[7], all[8]] = [this.RGBA16F, this.FLOAT,
                                Float32Array.from(all[8], (c, i) => (i % 4 === 3 ? c / 255 : mesaLights[c]))];
  return texImage2D.apply(this, all);
};
</script>
"""
SCRIPT = "<script>\n"  # Where the script of a page begins.


def with_mesas_decoding(page):
    text = pathlib.Path(page).read_text()
    if text.count(SCRIPT) != 1:
        raise RuntimeError("a page has one script")
    pathlib.Path(page).write_text(text.replace(SCRIPT, DECODING + SCRIPT))


def compared(tool, window, arguments, folder, width, height, page_options=()):
    """Writes the page of these arguments, and returns the comparison of its pixels with the picture."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    common = [*arguments, "--size", f"{width}x{height}"]
    relief_view(tool, *common, *page_options, "--output", folder / "page.html")
    with_mesas_decoding(folder / "page.html")
    open_page(window, folder / "page.html")
    drawn = pixels(window, width, height)
    write_png(folder / "page.png", drawn, width, height)
    difference = relief_view(tool, *common, "--output", folder / "picture.png", "--reference",
                             folder / "page.png", "--max-difference", 255)["comparison"]
    picture = read_png(folder / "picture.png")
    difference["pixels_above"] = sum(
        max(abs(drawn[i + k] - picture[i + k]) for k in range(4)) > 2 for i in range(0, len(drawn), 4))
    return difference
