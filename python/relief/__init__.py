# SPDX-License-Identifier: Apache-2.0
"""Surface detail: normals, tangents, normal maps, baking and rendering on numpy arrays.

Functions take arrays (positions: float32 of shape (n, 3), triangles: uint16 or uint32 of shape (m, 3), images:
uint8, uint16 or float32) and return new arrays. Other numbers and memory layouts are converted by a copy, which
`with Execution(strict=True):` refuses. Options have the names of the command lines. A list that is passed as
`report` receives findings as dictionaries. All exceptions but TypeError are a relief.Error. docs/python.md is a
tutorial.
"""
from __future__ import annotations

import contextlib
import dataclasses
import inspect
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
    displace,
    encode_normals,
    flip_green,
    heights,
    levels_of_detail,
    mean_curvatures,
    measure_texcoords,
    normal_mip_levels,
    read_image,
    read_mesh,
    remesh,
    repair,
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
    import numpy
    import numpy.typing

    from ._relief import FloatArray, Floats, IdArray, Indices, Layer, Rays, Report, Space, States

__all__ = [
    "BakeMismatch", "Baked", "Cancelled", "Error", "Execution", "FileError", "Finding", "GpuError", "InvalidInput",
    "Mesh", "Scene", "ToolError", "Unwrapped", "__version__", "accuracy", "bake", "blend_normals", "bump", "bump_options",
    "check_mesh", "check_normal_map", "compare_images", "compare_meshes", "compare_normals", "convert_space",
    "corner_normals", "corner_tangents", "decimate", "decode_normals", "displace", "encode_normals", "fidelity", "flip_green",
    "heights", "levels_of_detail", "make", "mean_curvatures", "measure_texcoords", "normal_mip_levels", "read_image", "read_mesh",
    "remesh", "repair", "resize_normals", "run", "scale_slopes", "set_thread_limit", "slopes", "split_vertices", "subdivide", "surface_distance",
    "triangle_normals", "unwrap", "vertex_normals", "vertex_tangents", "with_frames", "write_image", "write_mesh",
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


@dataclasses.dataclass(frozen=True, repr=False)
class Baked:
    """The arrays of a bake. Layers that were not requested are None.

    All arrays have one entry per texel. `normals`, `positions`, `colors` and `bent_normals` have three channels.
    """

    normals: Floats | None
    heights: Floats | None
    occlusion: Floats | None
    curvature: Floats | None
    positions: Floats | None
    colors: Floats | None
    bent_normals: Floats | None
    thickness: Floats | None
    """The mean distance to the surface behind, in the unit of the meshes."""
    ids: IdArray | None
    """Indices in `report["ids"]`, a list of names and colors; -1 in texels that are neither baked nor padded."""
    states: States
    """0: no chart; 1: missed, because no ray hit a surface; 2: baked; 3: padded."""
    report: dict[str, Any]
    """Results and findings, with the keys of `relief-bake mesh --report`."""

    def __repr__(self) -> str:
        layers = [field.name for field in dataclasses.fields(self)[:9] if getattr(self, field.name) is not None]
        height, width = self.states.shape
        return f"<relief.Baked of {width} x {height} texels: {', '.join(layers)}>"


@_arguments.checks_keywords
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
    thickness_rays: int = 64,
    thickness_distance: float | None = None,
    allow_size_mismatch: bool = False,
    progress: Callable[[float], object] | None = None,
) -> Baked:
    """Bake maps of `size` (width, height) for a low mesh from one or more high meshes.

    The low mesh needs texture coordinates: unwrap() computes them. The options are those of `relief-bake mesh`;
    several high meshes are copied, a single one is not. Layers are float32 of shape (height, width), or (height,
    width, 3); `ids` are int32. Ids are those of the materials of the high meshes, "material-N", and of the names of
    meshes without materials. Encode normals and bent normals with encode_normals(). `progress` is called with the
    finished fraction, from 0.0 to 1.0, after each band of rows; an exception of it ends the bake.

    Raises BakeMismatch if the meshes do not fit, InvalidInput for wrong options or missing texture coordinates, and
    TypeError for wrong types.
    """
    return Baked(**_relief.bake(
        high, low, size, layers=list(layers), space=space, rays=rays, hardness=hardness, cage=cage, offset=offset,
        max_distance=max_distance, back_faces=back_faces, samples=samples, sample_degrees=sample_degrees,
        outside=outside, padding=padding, occlusion_rays=occlusion_rays, occlusion_distance=occlusion_distance,
        thickness_rays=thickness_rays, thickness_distance=thickness_distance,
        allow_size_mismatch=allow_size_mismatch, progress=progress))


@dataclasses.dataclass(frozen=True, repr=False)
class Unwrapped:
    """A mesh with texture coordinates, and how good they are."""

    mesh: Mesh
    """The mesh, with vertices split along seams."""
    source_vertex: Indices
    """For each vertex of `mesh`, the vertex of the input that it copies: uint32 of shape (k,)."""
    charts: numpy.typing.NDArray[numpy.int32]
    """The chart of each triangle, of shape (m,); -1 for triangles without area and non-finite ones."""
    stats: dict[str, Any]
    """The quality, with the keys of "atlas" in the report of `relief-mesh unwrap`."""

    def __repr__(self) -> str:
        return f"<relief.Unwrapped of {len(self.charts)} triangles in {self.stats['charts']} charts>"


@_arguments.checks_keywords
def unwrap(
    mesh: Mesh,
    *,
    size: tuple[int, int] = (2048, 2048),
    padding: int = 4,
    align: int = 1,
    texels_per_unit: float | None = None,
    flatten: Literal["arap", "conformal"] = "arap",
    max_stretch: float = 4.0,
    split_hard_degrees: float | None = None,
    split_materials: bool = False,
    keep_seams: bool = False,
    densities: FloatArray | None = None,
    stack: bool = False,
    repack: bool = False,
    fix_mirrored: bool = False,
    udim: int = 1,
    report: Report | None = None,
) -> Unwrapped:
    """Compute texture coordinates for a map of `size` (width, height), without overlapping or mirrored triangles.

    The options are those of `relief-mesh unwrap`: `padding` is the least distance of charts in texels, 0 to 256; no
    two charts share a block of `align` x `align` texels; `flatten` says whether charts keep lengths ("arap") or angles
    ("conformal"); `max_stretch`, above 1, limits the ratio of a triangle's two scales; `split_hard_degrees` puts seams at sharper edges where they separate charts. Tangents are removed, and
    old texture coordinates matter only with `keep_seams` and `repack`. `densities`, float32 (m,), are the relative
    densities of texels of the triangles. With `stack`, equal parts share texels. With `repack`, the old charts are
    only packed anew; `fix_mirrored` reflects mirrored ones. `udim` is the number of maps of this size, as tiles.
    Every mesh with a triangle has a result; what is cut or set aside is appended to the list `report`.

    Raises InvalidInput for wrong options, or if the charts do not fit into the map, and TypeError for wrong types.
    """
    return Unwrapped(**_relief.unwrap(
        mesh, size=size, padding=padding, align=align, texels_per_unit=texels_per_unit, flatten=flatten,
        max_stretch=max_stretch, split_hard_degrees=split_hard_degrees, split_materials=split_materials,
        keep_seams=keep_seams, densities=densities, stack=stack, repack=repack, fix_mirrored=fix_mirrored, udim=udim, report=report))


class ToolError(Error):
    """A command-line tool failed. `exit_code` is 1 (failed), 2 (wrong usage) or 3 (--strict found a problem)."""

    def __init__(self, message: str, exit_code: int, output: str) -> None:
        super().__init__(message)
        self.exit_code = exit_code
        self.output = output
        """What the tool printed to standard output."""

    def __reduce__(self) -> tuple[type[ToolError], tuple[str, int, str]]:
        """Pickle all arguments, so that the error of another process arrives whole."""
        return type(self), (str(self), self.exit_code, self.output)


def _tool(name: str) -> str:
    package = pathlib.Path(__file__).parent
    installed = package / _relief.tool_directory / name
    for file in (package / "bin" / name, installed):  # The first one is in a wheel.
        if file.exists():
            return str(file.resolve())
    found = shutil.which(name)
    if found is None:
        raise FileError(f"{name}: not found in {installed.parent.resolve()} and in PATH")
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


@_arguments.checks_keywords
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


@_arguments.checks_keywords
def accuracy(
    *subjects: Literal["all", "normals", "tangents", "bump", "storage", "compression", "bake", "decimation",
                       "unwrapping", "relief", "shading", "stability"],
    quick: bool = True,
    times: bool = True,
) -> dict[str, Any]:
    """Measure the error and time of methods on inputs with a known ground truth.

    The experiments run in a process of their own, so that times are not disturbed. The result is the report of
    `relief-accuracy run --json`, which docs/accuracy-schema.md describes. Raises ToolError if the tool fails.
    """
    options = (["--quick"] if quick else []) + ([] if times else ["--no-times"])
    report: dict[str, Any] = run("relief-accuracy", "run", *subjects, *options, "--json")
    return report


_MAKE_OPTIONS = {"more_sources": "with", "repair": "no-repair", "engine": "for", "more_views": "view", "start": "from"}
"""The arguments of make() whose names differ from the options of `relief make`, as some are keywords of Python."""


def _make_words(name: str, value: Any) -> list[str]:
    """The words on the command line for an argument of make() that is not its default."""
    option = "--" + _MAKE_OPTIONS.get(name, name.replace("_", "-"))
    if isinstance(value, bool):
        return [option]
    if name == "size" and not isinstance(value, int):
        value = "x".join(map(str, value))
    if name == "layers":
        value = ",".join(value)
    values = value if name in ("more_sources", "more_views") else [value]
    texts = [",".join(map(str, one)) if isinstance(one, tuple) else os.fspath(one) if isinstance(one, os.PathLike)
             else "none" if one is None else str(one) for one in values]
    return [f"{option}={text}" for text in texts]


@_arguments.checks_keywords
def make(
    source: str | os.PathLike[str],
    output: str | os.PathLike[str],
    *,
    more_sources: Sequence[str | os.PathLike[str]] = (),
    up: Literal["y", "z", "auto"] = "auto",
    source_crease: float | Literal["auto"] | None = "auto",
    triangles: int = 5000,
    crease: float | None = 60.0,
    lods: int = 0,
    repair: bool = True,
    remesh: Literal["auto", "always", "never"] = "auto",
    resolution: int = 256,
    shell: bool = False,
    sign: Literal["flood", "winding"] = "flood",
    size: int | tuple[int, int] = 2048,
    padding: int = 8,
    keep_uvs: bool = False,
    normal_bits: Literal[8, 16] = 8,
    samples: Literal[1, 4, 16, 64] = 1,
    match: Literal["auto", "name", "all"] = "auto",
    occlusion_rays: int = 32,
    layers: Sequence[Literal["height", "curvature", "position", "bent", "thickness", "ids"]] = (),
    engine: Literal["gltf", "godot", "unity", "unreal"] = "gltf",
    loss: bool = False,
    more_views: Sequence[tuple[float, float]] = (),
    max_error: float | None = None,
    max_error_kind: Literal["mean", "rms", "p99", "max"] = "p99",
    max_picture_error: float | None = None,
    keep_stages: str | os.PathLike[str] | None = None,
    start: Literal["remesh", "decimate", "unwrap", "frames", "bake", "write"] | None = None,
) -> dict[str, Any]:
    """Make an asset with maps from the file of a dense model, as `relief make` does (docs/make.md).

    The arguments are the options of the command: `more_sources` are further files of the model (--with), `up` is its
    axis that becomes y (auto: z for STL files), `source_crease` and `crease` are in degrees, or None for smooth edges,
    `repair=False` is --no-repair, `engine` is --for, `more_views` are (azimuth, elevation) in degrees (--view), and
    `start` is --from, the stage at which the files of `keep_stages` are used.

    It runs in a process of its own. The result is the report of `relief make --report`: the stages, the numbers of
    triangles, the maps and the findings, with `loss` what was lost, and with limits of it (in degrees, and of FLIP)
    the attempts that held them. Raises ToolError if the tool fails; then no file is changed.
    """
    given = dict(locals())
    options: list[str] = []
    for parameter in inspect.signature(make).parameters.values():
        value = given[parameter.name]
        if parameter.kind is parameter.KEYWORD_ONLY and value != parameter.default:
            options += _make_words(parameter.name, value)
    report: dict[str, Any] = run("relief", "make", source, "-o", output, *options, report=True)
    return report


@_arguments.checks_keywords
def fidelity(
    source: str | os.PathLike[str],
    *results: str | os.PathLike[str],
    size: int = 256,
    samples: Literal[1, 4, 9, 16] = 4,
    views: int = 12,
    more_views: Sequence[tuple[float, float]] = (),
) -> dict[str, Any]:
    """Measure how much the files of models differ from their source, as `relief-accuracy fidelity` does.

    It runs in a process of its own. `more_views` has directions to the camera, (azimuth, elevation) in degrees. The
    result is the report that docs/fidelity.md describes: "stages" has one dictionary for each result, with pictures,
    normals, silhouettes, distances and views. Raises ToolError if the tool fails.
    """
    options = ["--size", str(size), "--samples", str(samples), "--views", str(views)]
    for azimuth, elevation in more_views:
        options += ["--view", f"{azimuth},{elevation}"]
    report: dict[str, Any] = run("relief-accuracy", "fidelity", source, *results, *options, report=True)
    return report
