# SPDX-License-Identifier: Apache-2.0
"""Surface detail: normals, tangents, normal maps, baking and rendering on numpy arrays.

Functions take arrays (positions: float32 of shape (n, 3), triangles: uint16 or uint32 of shape (m, 3), images:
uint8, uint16 or float32) and return new arrays. Options have the names of the command lines. A list that is
passed as `report` receives findings as dictionaries. docs/python.md is a tutorial.
"""
from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict

from . import _arguments, _relief
from ._relief import (
    BakeMismatch,
    Cancelled,
    Error,
    Execution,
    FileError,
    GpuError,
    InvalidInput,
    Mesh,
    Scene,
    __version__,
    blend_normals,
    bump,
    bump_options,
    check_mesh,
    check_normal_map,
    compare_images,
    compare_meshes,
    compare_normals,
    convert_space,
    corner_normals,
    corner_tangents,
    decimate,
    decode_normals,
    encode_normals,
    flip_green,
    heights,
    levels_of_detail,
    mean_curvatures,
    normal_mip_levels,
    read_image,
    read_mesh,
    resize_normals,
    scale_slopes,
    set_thread_limit,
    slopes,
    split_vertices,
    subdivide,
    surface_distance,
    triangle_normals,
    vertex_normals,
    vertex_tangents,
    with_frames,
    write_image,
    write_mesh,
    write_texture,
)

if TYPE_CHECKING:
    from ._relief import Floats, Layer, Rays, Space, States

__all__ = [
    "BakeMismatch", "Baked", "Cancelled", "Error", "Execution", "FileError", "Finding", "GpuError", "InvalidInput",
    "Mesh", "Scene", "ToolError", "__version__", "accuracy", "bake", "blend_normals", "bump", "bump_options",
    "check_mesh", "check_normal_map", "compare_images", "compare_meshes", "compare_normals", "convert_space",
    "corner_normals", "corner_tangents", "decimate", "decode_normals", "encode_normals", "flip_green", "heights",
    "levels_of_detail", "mean_curvatures", "normal_mip_levels", "read_image", "read_mesh", "resize_normals", "run",
    "scale_slopes", "set_thread_limit", "slopes", "split_vertices", "subdivide", "surface_distance",
    "triangle_normals", "vertex_normals", "vertex_tangents", "with_frames", "write_image", "write_mesh",
    "write_texture",
]

_arguments.shorten_errors(globals())


class Finding(TypedDict):
    """A problem of one kind in the input, or a fallback, over all affected elements."""

    kind: str
    element: str
    count: int
    first: list[int]
    """The smallest indices, at most 8."""
    outcome: str


@dataclasses.dataclass(frozen=True)
class Baked:
    """The arrays of a bake. Layers that were not requested are None.

    All arrays have one entry per texel. `normals`, `positions` and `colors` have three channels.
    """

    normals: Floats | None
    heights: Floats | None
    occlusion: Floats | None
    curvature: Floats | None
    positions: Floats | None
    colors: Floats | None
    states: States
    """0: no chart; 1: missed, because no ray hit a surface; 2: baked; 3: padded."""
    report: dict[str, Any]
    """Results and findings, with the keys of `relief-bake mesh --report`."""


def bake(
    high: Mesh | Sequence[Mesh],
    low: Mesh,
    size: tuple[int, int],
    *,
    layers: Sequence[Layer] = ("normals",),
    space: Space = "tangent",
    rays: Rays = "averaged",
    hardness: float = 0.0,
    cage: Mesh | None = None,
    offset: float | None = None,
    max_distance: float | None = None,
    back_faces: Literal["skip", "take"] = "skip",
    samples: int = 1,
    sample_degrees: float | None = None,
    outside: Literal["drop", "repeat"] = "drop",
    padding: int = 16,
    occlusion_rays: int = 64,
    occlusion_distance: float | None = None,
    allow_size_mismatch: bool = False,
    progress: Callable[[float], object] | None = None,
) -> Baked:
    """Bake maps of `size` (width, height) for a low mesh from one or more high meshes.

    The low mesh needs texture coordinates. The options are those of `relief-bake mesh`; several high meshes are
    copied, a single one is not. Encode the normals with encode_normals(). `progress` is called with the finished
    fraction after each band of 64 rows; an exception of it ends the bake.
    """
    return Baked(**_relief.bake(
        high, low, size, layers=list(layers), space=space, rays=rays, hardness=hardness, cage=cage, offset=offset,
        max_distance=max_distance, back_faces=back_faces, samples=samples, sample_degrees=sample_degrees,
        outside=outside, padding=padding, occlusion_rays=occlusion_rays, occlusion_distance=occlusion_distance,
        allow_size_mismatch=allow_size_mismatch, progress=progress))


class ToolError(Error):
    """A command-line tool failed. `exit_code` is 1 (failed), 2 (wrong usage) or 3 (--strict found a problem)."""

    def __init__(self, message: str, exit_code: int, output: str) -> None:
        super().__init__(message)
        self.exit_code = exit_code
        self.output = output
        """What the tool printed to standard output."""


def _tool(name: str) -> str:
    beside = pathlib.Path(__file__).parent / _relief.tool_directory / name
    found = str(beside.resolve()) if beside.exists() else shutil.which(name)
    if found is None:
        raise FileError(f"{name}: not found in {beside.parent.resolve()} and in PATH")
    return found


def _output_of(command: list[str]) -> tuple[int, bytes, bytes]:
    """Exit code, standard output and standard error of a command, which any exception, as Ctrl+C, ends."""
    with subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        try:
            while True:
                # Without a timeout, communicate() waits a quarter of a second after Ctrl+C.
                with contextlib.suppress(subprocess.TimeoutExpired):
                    out, error = process.communicate(timeout=0.05)
                    return process.returncode, out, error
        except BaseException:
            process.terminate()  # The tool removes its temporary files.
            process.wait()
            raise


def run(tool: str, *arguments: str | os.PathLike[str], report: bool = False) -> Any:
    """Run a command-line tool on files: run("relief-mesh", "check", "vase.glb", "--json").

    With --json among the arguments, the result is the printed report as a dictionary. With `report`, --report is
    added, and the result is that report. Otherwise it is the printed text. Raises ToolError with the message of
    the tool if its exit code is not 0.
    """
    words = [os.fspath(argument) for argument in arguments]
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "report.json"
        extra = ["--report", str(file)] if report else []
        exit_code, out, error = _output_of([_tool(tool), *words, *extra])
        output = out.decode("utf-8", "replace")
        if exit_code != 0:
            message = error.decode("utf-8", "replace").strip()
            raise ToolError(message or f"{tool}: exit code {exit_code}", exit_code, output)
        if report:
            return json.loads(file.read_text(encoding="utf-8"))
    return json.loads(output) if "--json" in words else output


def accuracy(
    *subjects: Literal["all", "normals", "tangents", "bump", "storage", "bake", "shading", "stability"],
    quick: bool = True,
    times: bool = True,
) -> dict[str, Any]:
    """Measure the error and time of methods on inputs with a known ground truth.

    The experiments run in a process of their own, so that times are not disturbed. The result is the report of
    `relief-accuracy run --json`, which docs/accuracy-schema.md describes.
    """
    options = (["--quick"] if quick else []) + ([] if times else ["--no-times"])
    report: dict[str, Any] = run("relief-accuracy", "run", *subjects, *options, "--json")
    return report
