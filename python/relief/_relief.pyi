# SPDX-License-Identifier: Apache-2.0
# The types of the extension module. The docstrings are in the bindings.
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Self

import numpy
import numpy.typing

from . import Finding

__version__: str
tool_directory: str

Floats = numpy.typing.NDArray[numpy.float32]
Indices = numpy.typing.NDArray[numpy.uint32]
# Inputs: what is not float32, or uint16 or uint32, is converted.
FloatArray = numpy.typing.NDArray[numpy.floating[Any]] | numpy.typing.NDArray[numpy.integer[Any]]
IntegerArray = numpy.typing.NDArray[numpy.integer[Any]]
States = numpy.typing.NDArray[numpy.uint8]
IdArray = numpy.typing.NDArray[numpy.int32]
# uint8, uint16 or float32.
Image = numpy.typing.NDArray[Any]
File = str | os.PathLike[str]

Weight = Literal["auto", "uniform", "area", "angle", "sine", "max", "angle-edges", "area-angle"]
NormalMode = Literal[
    "keep", "flat", "auto", "uniform", "area", "angle", "sine", "max", "angle-edges", "area-angle"
]
TangentMode = Literal["keep", "none", "mikktspace", "area-weighted", "lengyel"]
Arithmetic = Literal["float64", "float32"]
Kernel = Literal[
    "forward", "central3", "prewitt3", "sobel3", "scharr3", "sobel5", "scharr5", "central5", "central7", "gaussian"
]
KernelOrAuto = Kernel | Literal["auto"]
Channel = Literal["mean", "luminance", "red", "green", "blue", "alpha"]
Bits = Literal[8, 16, 32]
Green = Literal["up", "down"]
ZeroCode = Literal["127.5", "128"]
Dither = Literal["none", "ordered", "blue-noise"]
Blend = Literal["reoriented", "partial-derivative", "whiteout", "udn", "unity", "linear", "overlay"]
Filter = Literal["best", "box", "triangle", "cubic", "lanczos"]
ColorSpace = Literal["data", "linear", "srgb"]
TextureFormat = Literal[
    "r8", "rg8", "rgba8", "r16", "rg16", "rgba16", "r16f", "rg16f", "rgba16f", "r32f", "rg32f", "rgba32f",
    "bc4", "bc4-snorm", "bc5", "bc5-snorm", "bc7", "bc1", "bc1a", "bc3", "bc6h", "bc6h-sfloat",
]
Layer = Literal["normals", "heights", "occlusion", "curvature", "positions", "colors", "bent_normals", "thickness", "ids"]
Space = Literal["tangent", "object", "world"]
Rays = Literal["averaged", "shading", "face"]

Report = list[Finding]

class Error(RuntimeError): ...
class InvalidInput(Error, ValueError): ...
class BakeMismatch(InvalidInput): ...
class FileError(Error, OSError): ...
class GpuError(Error): ...
class Cancelled(Error): ...

def set_thread_limit(count: int) -> None: ...

class Execution:
    def __init__(
        self,
        *,
        threads: int = 0,
        progress: Callable[[str, float | None], object] | None = None,
        strict: bool = False,
    ) -> None: ...
    def __enter__(self) -> Self: ...
    def __exit__(self, *exception: object) -> None: ...
    def cancel(self) -> None: ...
    @property
    def state(self) -> tuple[str, float | None]: ...

class Mesh:
    def __init__(
        self,
        positions: FloatArray,
        triangles: IntegerArray,
        *,
        normals: FloatArray | None = None,
        texcoords: FloatArray | None = None,
        tangents: FloatArray | None = None,
        colors: FloatArray | None = None,
        smoothing_groups: IntegerArray | None = None,
        name: str = "",
        report: Report | None = None,
    ) -> None: ...
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: dict[int, Any]) -> Self: ...
    name: str
    @property
    def origin(self) -> tuple[float, float, float]: ...
    @property
    def positions(self) -> Floats: ...
    @property
    def triangles(self) -> Indices: ...
    @property
    def normals(self) -> Floats | None: ...
    @property
    def texcoords(self) -> Floats | None: ...
    @property
    def tangents(self) -> Floats | None: ...
    @property
    def colors(self) -> Floats | None: ...

def vertex_normals(
    positions: FloatArray,
    triangles: IntegerArray,
    *,
    weight: Weight = "angle",
    arithmetic: Arithmetic = "float64",
    weld_tolerance: float | None = 0.0,
    out: Floats | None = None,
    report: Report | None = None,
) -> Floats: ...
def corner_normals(
    positions: FloatArray,
    triangles: IntegerArray,
    *,
    weight: Weight = "angle",
    crease_degrees: float | None = None,
    smoothing_groups: IntegerArray | None = None,
    arithmetic: Arithmetic = "float64",
    weld_tolerance: float | None = 0.0,
    report: Report | None = None,
) -> Floats: ...
def triangle_normals(positions: FloatArray, triangles: IntegerArray, *, report: Report | None = None) -> Floats: ...
def corner_tangents(
    positions: FloatArray,
    normals: FloatArray,
    texcoords: FloatArray,
    triangles: IntegerArray,
    *,
    method: Literal["mikktspace", "area-weighted", "lengyel"] = "mikktspace",
    report: Report | None = None,
) -> Floats: ...
def vertex_tangents(
    positions: FloatArray,
    normals: FloatArray,
    texcoords: FloatArray,
    triangles: IntegerArray,
    *,
    out: Floats | None = None,
    report: Report | None = None,
) -> Floats: ...
def split_vertices(
    vertex_count: int, triangles: IntegerArray, corner_values: FloatArray, *, report: Report | None = None
) -> tuple[Indices, Indices]: ...
def mean_curvatures(positions: FloatArray, triangles: IntegerArray, *, report: Report | None = None) -> Floats: ...
def read_mesh(
    file: File, *, space: Literal["object", "world"] = "world", report: Report | None = None
) -> Mesh: ...
def write_mesh(file: File, mesh: Mesh, *, report: Report | None = None) -> None: ...
def with_frames(
    mesh: Mesh,
    *,
    normals: NormalMode = "keep",
    tangents: TangentMode = "keep",
    crease_degrees: float | None = None,
    weld_tolerance: float = 0.0,
    smoothing_groups: bool = True,
    repair: bool = False,
    report: Report | None = None,
) -> tuple[Mesh, Indices]: ...
def decimate(
    mesh: Mesh,
    *,
    triangles: int | None = None,
    max_error: float | None = None,
    max_normal_degrees: float | None = None,
    keep_borders: bool = False,
    keep_seams: bool = False,
    keep_positions: bool = False,
    drop_parts: float = 0.0,
    goal: Literal["picture", "distance", "largest-distance"] | None = None,
    weights: Mapping[Literal["texcoords", "normals", "colors"], float] = {},
    normals: NormalMode = "keep",
    report: Report | None = None,
) -> tuple[Mesh, Indices]: ...
def levels_of_detail(
    mesh: Mesh,
    triangles: Sequence[int],
    *,
    weights: Mapping[Literal["texcoords", "normals", "colors"], float] = {},
    report: Report | None = None,
) -> list[Mesh]: ...
def surface_distance(a: Mesh, b: Mesh) -> tuple[dict[str, float], dict[str, float]]: ...
def repair(
    mesh: Mesh,
    *,
    weld: float | None = 0.0,
    keep_non_finite: bool = False,
    keep_degenerate: bool = False,
    keep_duplicates: bool = False,
    two_sided: Literal["keep", "together", "single", "remove"] = "keep",
    drop_parts: float = 0.0,
    orient: bool = True,
    separate: bool = True,
    report: Report | None = None,
) -> tuple[Mesh, Indices]: ...
def remesh(
    mesh: Mesh,
    *,
    resolution: int = 128,
    shell: bool = False,
    sign: Literal["flood", "winding"] = "flood",
    report: Report | None = None,
) -> Mesh: ...
def displace(
    mesh: Mesh,
    heights: Image,
    *,
    height: float,
    zero: float = 0.0,
    max_error: float | None = None,
    pixels: float = 2000.0,
    wrap: str = "auto",
    max_triangles: int = 20_000_000,
    channel: Channel = "mean",
    assume: Literal["height"] | None = None,
    report: Report | None = None,
) -> tuple[Mesh, dict[str, Any]]: ...
def subdivide(mesh: Mesh, levels: int, *, normals: NormalMode = "keep", report: Report | None = None) -> Mesh: ...
def check_mesh(mesh: Mesh, *, for_baking: bool = False, for_tangents: bool = True) -> dict[str, Any]: ...
def compare_meshes(
    a: Mesh,
    b: Mesh,
    *,
    position_tolerance: float | None = None,
    texcoord_tolerance: float | None = None,
    by_texcoord: bool = True,
) -> dict[str, Any]: ...
def read_image(file: File) -> tuple[Image, dict[str, str]]: ...
def write_image(
    file: File,
    image: Image,
    *,
    color_space: ColorSpace = "data",
    metadata: dict[str, str] = {},
    half: bool = False,
    report: Report | None = None,
) -> None: ...
def write_texture(
    file: File,
    levels: list[Image],
    *,
    format: TextureFormat = "bc5",
    quality: Literal["fast", "normal", "best"] = "normal",
    srgb: bool = False,
    metadata: dict[str, str] = {},
    zstd: int | None = None,
    report: Report | None = None,
) -> None: ...
def normal_mip_levels(normals: FloatArray) -> list[Floats]: ...
def bump(
    height: Image,
    *,
    strength: float = 16.0,
    kernel: KernelOrAuto | None = None,
    kernel_radius: int = 2,
    wrap: str | None = None,
    texel: tuple[float, float] = (1.0, 1.0),
    arithmetic: Arithmetic | None = None,
    channel: Channel = "mean",
    bits: Bits = 16,
    green: Green = "up",
    zero_code: ZeroCode = "127.5",
    dither: Dither = "none",
    assume: Literal["height"] | None = None,
    report: Report | None = None,
) -> Image: ...
def slopes(
    height: Image,
    *,
    strength: float = 16.0,
    kernel: KernelOrAuto | None = None,
    kernel_radius: int = 2,
    wrap: str | None = None,
    texel: tuple[float, float] = (1.0, 1.0),
    arithmetic: Arithmetic | None = None,
    channel: Channel = "mean",
    assume: Literal["height"] | None = None,
    report: Report | None = None,
) -> Floats: ...
def bump_options(
    height: Image,
    *,
    strength: float = 16.0,
    kernel: KernelOrAuto | None = None,
    wrap: str | None = None,
    channel: Channel = "mean",
    assume: Literal["height"] | None = None,
) -> dict[str, Any]: ...
def heights(
    normals: FloatArray,
    *,
    kernel: Kernel = "central7",
    wrap: str = "repeat",
    max_slope: float = 16.0,
    level: bool = False,
    report: Report | None = None,
) -> tuple[Floats, dict[str, Any]]: ...
def encode_normals(
    normals: FloatArray,
    *,
    bits: Bits = 16,
    green: Green = "up",
    zero_code: ZeroCode = "127.5",
    dither: Dither = "none",
    report: Report | None = None,
) -> Image: ...
def decode_normals(
    map: Image,
    *,
    green: Green = "up",
    zero_code: ZeroCode = "127.5",
    exact_flat: bool = False,
    assume: Literal["normal"] | None = None,
    report: Report | None = None,
) -> Floats: ...
def flip_green(
    map: Image,
    *,
    zero_code: ZeroCode = "127.5",
    assume: Literal["normal"] | None = None,
    report: Report | None = None,
) -> Image: ...
def blend_normals(
    base: FloatArray, detail: FloatArray, *, blend: Blend = "reoriented", report: Report | None = None
) -> Floats: ...
def scale_slopes(normals: FloatArray, strength: float, *, report: Report | None = None) -> Floats: ...
def resize_normals(
    normals: FloatArray,
    width: int,
    height: int,
    *,
    filter: Filter = "best",
    domain: Literal["slopes", "vectors"] = "slopes",
    wrap: str = "repeat",
    report: Report | None = None,
) -> Floats: ...
def convert_space(
    normals: FloatArray,
    mesh: Mesh,
    *,
    to: Literal["tangent", "object"],
    repeat: bool = False,
    report: Report | None = None,
) -> Floats: ...
def check_normal_map(map: Image, *, metadata: dict[str, str] = {}, color_tag: str = "") -> dict[str, Any]: ...
def compare_images(
    a: Image, b: Image, *, color_space: ColorSpace = "srgb", pixels_per_degree: float = 67.02064327658225
) -> dict[str, Any]: ...
def compare_normals(a: FloatArray, b: FloatArray) -> tuple[dict[str, Any], Floats]: ...
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
) -> dict[str, Any]: ...
def measure_texcoords(mesh: Mesh, size: tuple[int, int], *, report: Report | None = None) -> dict[str, Any]: ...
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
) -> dict[str, Any]: ...

class Scene:
    def __init__(
        self,
        mesh: Mesh,
        *,
        diffuse: tuple[float, float, float] = (0.8, 0.8, 0.8),
        specular: tuple[float, float, float] = (0.0, 0.0, 0.0),
        shininess: float = 32.0,
        material: str | None = None,
        normal_map: Image | None = None,
        green: Green = "up",
        normal_space: Literal["tangent", "object"] = "tangent",
        assume: Literal["normal"] | None = None,
        report: Report | None = None,
    ) -> None: ...
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: dict[int, Any]) -> Self: ...
    @staticmethod
    def load(
        file: File,
        *,
        studio: bool = True,
        assume: Sequence[Literal["normal", "height", "color"]] = (),
        report: Report | None = None,
    ) -> Scene: ...
    ambient: tuple[float, float, float]
    background: tuple[float, float, float, float]
    exposure: float
    def add_light(
        self,
        direction: tuple[float, float, float],
        *,
        irradiance: tuple[float, float, float] = (1.0, 1.0, 1.0),
    ) -> None: ...
    def render(
        self,
        *,
        size: tuple[int, int] | None = None,
        samples: Literal[1, 4] = 4,
        output: Literal["srgb", "linear", "clamped"] = "srgb",
        camera: tuple[float, float, float] | None = None,
        fov_degrees: float | None = None,
        backend: Literal["auto", "osmesa", "egl"] = "auto",
        report: Report | None = None,
    ) -> Image: ...
    def effects(
        self,
        *,
        size: tuple[int, int] | None = None,
        samples: Literal[1, 4] = 4,
        output: Literal["srgb", "linear", "clamped"] = "srgb",
        camera: tuple[float, float, float] | None = None,
        fov_degrees: float | None = None,
    ) -> list[list[dict[str, Any]]]: ...
    def frame_effects(
        self,
        *,
        size: tuple[int, int] | None = None,
        samples: Literal[1, 4] = 4,
        output: Literal["srgb", "linear", "clamped"] = "srgb",
        camera: tuple[float, float, float] | None = None,
        fov_degrees: float | None = None,
    ) -> list[dict[str, Any]]: ...
