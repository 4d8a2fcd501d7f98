// SPDX-License-Identifier: Apache-2.0
/// \file
/// The C interface: normals, tangents, unwrapping, normal maps and bakes for engines and other
/// languages. Part of the library relief::c; C99 and C++.
///
/// Memory: all arrays and images belong to the caller. A stride is the distance in bytes between
/// two elements, a multiple of 4 and at least the size of an element; 0 means that elements are
/// contiguous. Outputs must not overlap inputs, except as interleaved vertices: then both have the
/// same stride. relief_unwrap() and relief_bake() copy the meshes, the other functions do not.
///
/// Structs: relief_NAME_init() sets the first field, `size`, and the defaults of all others. A
/// library of a later version accepts the smaller structs of programs that were compiled before. A
/// library of an earlier version accepts larger structs as long as the fields that it does not know
/// are 0. Without options (NULL), functions use the defaults.
///
/// Conventions: object space is right-handed with any unit of length, and triangles are
/// counter-clockwise seen from outside. Texture coordinates and images have their origin in the
/// upper left corner, and v points down. Angles are in radians.
///
/// Errors: functions return a relief_status and never throw. After any status but RELIEF_OK, the
/// contents of outputs are undefined, and relief_last_error() describes the problem. Fallbacks for
/// degenerate input are no errors: they are counted in the report, if there is one. No pointer is
/// kept after a function returns. Functions may be called from several threads at the same time,
/// with different outputs and reports.
///
/// Results are the same bits as those of the C++ functions, for any number of threads.
/// Tests: tests/mesh/c/c_mesh_test.cpp, c_images_test.cpp, c_bake_test.cpp,
/// c_without_bake_test.cpp.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "relief/version.h"

#if defined(_WIN32)  // Libraries for Windows are static.
#define RELIEF_C_API
#else
#define RELIEF_C_API __attribute__((visibility("default")))
#endif

// NOLINTBEGIN: the names of C.
#ifdef __cplusplus
extern "C" {
#endif

/// The result of a function.
typedef enum relief_status {
    RELIEF_OK = 0,
    RELIEF_INVALID_INPUT = 1,  ///< Data or options are contradictory or out of range.
    RELIEF_CANCELLED = 2,      ///< The progress function requested it.
    RELIEF_OUT_OF_MEMORY = 3,
    RELIEF_FAILED = 4,      ///< Any other error, which relief_last_error() describes.
    RELIEF_UNAVAILABLE = 5  ///< The library was built without this function.
} relief_status;

/// Returns the version of the library, such as "1.1.0"; RELIEF_VERSION is that of this header.
RELIEF_C_API const char* relief_version(void);

/// Returns the message of the last function with a status that this thread called: "triangle 7
/// names vertex 12, but there are only 8", or "" if the status was RELIEF_OK.
///
/// \return UTF-8, valid until this thread calls another function with a status
RELIEF_C_API const char* relief_last_error(void);

/// For options of type double that may be absent.
#define RELIEF_ABSENT (-1.0)

// Reports: the problems that functions find in their input, and the fallbacks that they use.

/// Findings, one for each kind. A report is for one thread at a time.
typedef struct relief_report relief_report;

/// A problem of one kind, over all affected elements.
typedef struct relief_finding {
    size_t size;
    const char* text;     ///< All of it: "2 degenerate triangles (triangle 3, 17): ...".
    const char* kind;     ///< The problem, a fixed text: "degenerate triangle".
    const char* element;  ///< The type of element: "triangle", "vertex", "corner", "texel".
    const char* outcome;  ///< The outcome: "does not contribute to vertex normals".
    size_t count;         ///< Number of affected elements.
    const size_t* first;  ///< Their smallest indices, ascending.
    size_t first_count;   ///< Number of these, at most 8.
} relief_finding;
RELIEF_C_API relief_status relief_finding_init(relief_finding* finding, size_t size);

/// Creates an empty report. \return NULL without memory
RELIEF_C_API relief_report* relief_report_create(void);

/// Frees a report. NULL does nothing.
RELIEF_C_API void relief_report_destroy(relief_report* report);

/// Removes all findings. NULL does nothing.
RELIEF_C_API void relief_report_clear(relief_report* report);

/// Returns the number of findings; 0 for NULL.
RELIEF_C_API size_t relief_report_count(const relief_report* report);

/// Returns a finding.
///
/// \param index  below relief_report_count(), in order of first appearance
/// \param finding  initialized; gets pointers that are valid until the report is changed or freed
RELIEF_C_API relief_status relief_report_finding(relief_report* report, size_t index,
                                                 relief_finding* finding);

// Execution.

/// Receives the progress of a function, from any thread, one call at a time: when a stage begins,
/// and at each percent of it if the finished part is known, which is so for tangents and bakes. It
/// must not throw.
///
/// \param user  relief_execution::user
/// \param stage  "normals", "tangents", "unwrapping", "normal map", "baking", ...
/// \param fraction  the finished part of the stage, 0 to 1; negative if it is unknown
/// \return 0, or another value to cancel: the function then returns RELIEF_CANCELLED, usually soon
///         after
typedef int32_t (*relief_progress)(void* user, const char* stage, double fraction);

/// The execution of a function. Results do not depend on it.
typedef struct relief_execution {
    size_t size;
    relief_progress progress;  ///< Default: NULL.
    void* user;                ///< For `progress`. Default: NULL.
    uint32_t threads;          ///< The maximum number, with the calling one. Default: 0, no limit.
    uint32_t reserved;         ///< 0
} relief_execution;
RELIEF_C_API relief_status relief_execution_init(relief_execution* execution, size_t size);

// Meshes.

enum relief_index_type {
    RELIEF_INDEX_UINT32 = 0,
    RELIEF_INDEX_INT32 = 1,  ///< A negative index is an error.
    RELIEF_INDEX_UINT16 = 2
};

/// Triangles and vertex attributes in the caller's memory. Each function documents which attributes
/// it reads; it ignores the others. Pointers are aligned to their elements.
typedef struct relief_mesh {
    size_t size;
    size_t vertex_count;
    size_t triangle_count;
    const float* positions;  ///< Three for each vertex.
    size_t position_stride;
    const float* normals;  ///< Three for each vertex; NULL if absent.
    size_t normal_stride;
    const float* texcoords;  ///< Two for each vertex; NULL if absent.
    size_t texcoord_stride;
    const float* tangents;  ///< Four for each vertex: x, y, z and w, which is +-1; NULL if absent.
    size_t tangent_stride;
    const void* indices;  ///< Three for each triangle, contiguous.
    int32_t index_type;   ///< relief_index_type. Default: RELIEF_INDEX_UINT32.
    int32_t reserved;     ///< 0
} relief_mesh;
RELIEF_C_API relief_status relief_mesh_init(relief_mesh* mesh, size_t size);

/// The weight of a triangle's normal at a corner with the edges e1 and e2 and the angle a.
/// docs/normals.md has the errors and times.
enum relief_normal_weight {
    RELIEF_WEIGHT_AUTOMATIC = -1,  ///< MAX, or AREA at vertices where the mesh folds over itself.
    RELIEF_WEIGHT_UNIFORM = 0,     ///< 1
    RELIEF_WEIGHT_AREA = 1,
    RELIEF_WEIGHT_ANGLE = 2,
    RELIEF_WEIGHT_SINE = 3,
    RELIEF_WEIGHT_MAX = 4,  ///< sin(a) / (|e1| |e2|)
    RELIEF_WEIGHT_ANGLE_EDGES = 5,
    RELIEF_WEIGHT_AREA_ANGLE = 6
};

enum relief_arithmetic {
    RELIEF_ARITHMETIC_AUTOMATIC = -1,  ///< For relief_bump_options.
    RELIEF_ARITHMETIC_FLOAT64 = 0,
    RELIEF_ARITHMETIC_FLOAT32 = 1
};

typedef struct relief_normal_options {
    size_t size;
    /// Vertices within this distance share their normal. Default: 0, vertices at equal positions.
    /// RELIEF_ABSENT: no vertices share normals.
    double weld_tolerance;
    /// Edges with a larger angle between their triangles are hard, 0 to pi. Only for
    /// relief_corner_normals(). Default: RELIEF_ABSENT, no edge is hard.
    double crease_angle;
    int32_t weight;      ///< relief_normal_weight. Default: RELIEF_WEIGHT_ANGLE.
    int32_t arithmetic;  ///< relief_arithmetic. Default: RELIEF_ARITHMETIC_FLOAT64.
} relief_normal_options;
RELIEF_C_API relief_status relief_normal_options_init(relief_normal_options* options, size_t size);

/// Computes the unit normal of every vertex, as vertex_normals() (relief/mesh/normals.h).
///
/// \param mesh  with positions and triangles
/// \param normals  gets three floats for each vertex; (0, 0, 1) if the weighted sum is zero
///         (isolated vertex, only degenerate triangles, normals that cancel, non-finite position)
/// \param report  counts these fallbacks; may be NULL, as in all functions
/// \return RELIEF_INVALID_INPUT if a triangle names a vertex that does not exist, or an option is
///         out of range
RELIEF_C_API relief_status relief_vertex_normals(const relief_mesh* mesh,
                                                 const relief_normal_options* options,
                                                 const relief_execution* execution, float* normals,
                                                 size_t normal_stride, relief_report* report);

/// Computes the unit normal of every corner, as corner_normals() (relief/mesh/normals.h): the mean
/// over the triangles around it that are connected by smooth edges.
///
/// \param normals  gets nine floats for each triangle, contiguous, in corner order. Split vertices
///         whose corners differ by relief_split_vertices()
/// \return as relief_vertex_normals()
RELIEF_C_API relief_status relief_corner_normals(const relief_mesh* mesh,
                                                 const relief_normal_options* options,
                                                 const relief_execution* execution, float* normals,
                                                 relief_report* report);

/// Computes one MikkTSpace tangent for each vertex, as vertex_tangents() (relief/mesh/tangents.h):
/// for meshes whose vertices are split where the texture is mirrored or has a seam.
///
/// \param mesh  with positions, normals, texture coordinates and triangles
/// \param tangents  gets four floats for each vertex: xyz is unit and perpendicular to the normal,
///         w is exactly +1 or -1; bitangent = w * cross(normal, xyz). If corners at a vertex
///         differ, it is the most frequent tangent, and the vertex is reported. Where no texture
///         gradient exists, see relief/mesh/tangents.h
/// \return RELIEF_INVALID_INPUT if an attribute is missing, or a triangle names a vertex that does
///         not exist
RELIEF_C_API relief_status relief_vertex_tangents(const relief_mesh* mesh,
                                                  const relief_execution* execution,
                                                  float* tangents, size_t tangent_stride,
                                                  relief_report* report);

/// Computes a MikkTSpace tangent for every corner, as mikktspace_tangents()
/// (relief/mesh/tangents.h).
///
/// \param tangents  gets twelve floats for each triangle, contiguous, in corner order
/// \return as relief_vertex_tangents()
RELIEF_C_API relief_status relief_corner_tangents(const relief_mesh* mesh,
                                                  const relief_execution* execution,
                                                  float* tangents, relief_report* report);

/// Splits vertices until all corners that share a vertex also share a value, with as few copies as
/// possible: after relief_corner_normals(), relief_corner_tangents() and relief_unwrap().
///
/// \param mesh  with triangles; vertex_count is used, attributes are not
/// \param corner_values  `components` floats for each corner, contiguous, in corner order
/// \param components  2 to 4
/// \param indices  gets three 32-bit vertex indices for each triangle; may be the mesh's own
/// \param source_vertices  gets for each new vertex the vertex that it copies. The first
///         mesh->vertex_count are the old vertices in their order. May be NULL if `capacity` is 0
/// \param capacity  the length of `source_vertices`, at most
///         mesh->vertex_count + 3 * mesh->triangle_count
/// \param vertex_count  gets the number of new vertices, also if `capacity` is too small
/// \return RELIEF_INVALID_INPUT if `capacity` is too small: then `indices` and `source_vertices`
///         are unchanged
RELIEF_C_API relief_status relief_split_vertices(const relief_mesh* mesh,
                                                 const float* corner_values, size_t components,
                                                 uint32_t* indices, uint32_t* source_vertices,
                                                 size_t capacity, size_t* vertex_count);

/// The property that charts keep in the map, as Flattening (relief/mesh/unwrap.h).
enum relief_flattening {
    RELIEF_FLATTENING_ARAP = 0,      ///< Lengths: as rigid as possible.
    RELIEF_FLATTENING_CONFORMAL = 1  ///< Angles.
};

/// Options of relief_unwrap(), as UnwrapOptions (relief/mesh/unwrap.h).
typedef struct relief_unwrap_options {
    size_t size;
    int32_t width;           ///< Of the map in texels, 16 to 65536. Default: 2048.
    int32_t height;          ///< Default: 2048.
    int32_t padding;         ///< Between charts in texels, 0 to 256. Default: 4.
    int32_t alignment;       ///< Texels of blocks that charts do not share, 1 to 64. Default: 1.
    double max_stretch;      ///< Above 1. Default: 4.
    double split_hard;       ///< Angle, 0 to pi. Default: RELIEF_ABSENT.
    double texels_per_unit;  ///< Above 0. Default: RELIEF_ABSENT, as many as fit.
    int32_t keep_seams;      ///< Not 0: seams of the mesh's texture coordinates stay. Default: 0.
    int32_t flattening;      ///< relief_flattening. Default: RELIEF_FLATTENING_ARAP.
} relief_unwrap_options;
RELIEF_C_API relief_status relief_unwrap_options_init(relief_unwrap_options* options, size_t size);

/// The quality of texture coordinates, as AtlasStats (relief/mesh/unwrap.h).
typedef struct relief_atlas_stats {
    size_t size;
    size_t charts;
    double used;             ///< The share of the map that charts cover.
    double texels_per_unit;  ///< The mean.
    double stretch;          ///< L2 stretch, at least 1 for maps that keep the whole area.
    double max_anisotropy;   ///< Of the triangles that max_stretch limits.
    double seam_length;      ///< In units of the mesh.
    double area;             ///< Of the surface, in square units of the mesh.
} relief_atlas_stats;
RELIEF_C_API relief_status relief_atlas_stats_init(relief_atlas_stats* stats, size_t size);

/// The chart of a triangle that has none.
#define RELIEF_NO_CHART UINT32_MAX

/// Computes texture coordinates for all triangles, as unwrap() (relief/mesh/unwrap.h): no triangles
/// overlap, none is mirrored, and charts keep the padding.
///
/// \param mesh  with positions and triangles; texture coordinates matter only with `keep_seams`
/// \param texcoords  gets six floats for each triangle, contiguous, in corner order, within 0 to 1;
///         0 for triangles without area and non-finite ones. relief_split_vertices() makes vertices
///         of them
/// \param charts  gets the chart of each triangle, or RELIEF_NO_CHART; may be NULL
/// \param stats  initialized; may be NULL
/// \return RELIEF_INVALID_INPUT also if the charts do not fit into the map with the padding or the
///         density
RELIEF_C_API relief_status relief_unwrap(const relief_mesh* mesh,
                                         const relief_unwrap_options* options,
                                         const relief_execution* execution, float* texcoords,
                                         uint32_t* charts, relief_atlas_stats* stats,
                                         relief_report* report);

// Images.

enum relief_sample_type {
    RELIEF_SAMPLE_UINT8 = 0,
    RELIEF_SAMPLE_UINT16 = 1,
    RELIEF_SAMPLE_FLOAT = 2
};

/// An image in the caller's memory. This struct never changes.
typedef struct relief_image {
    const void* pixels;    ///< The first sample of the top row, aligned to its type.
    ptrdiff_t row_stride;  ///< In bytes; negative if the bottom row is first; 0: contiguous.
    int32_t width;
    int32_t height;
    int32_t channels;     ///< 1 to 4 interleaved samples for each texel.
    int32_t sample_type;  ///< relief_sample_type
} relief_image;

/// The same for outputs.
typedef struct relief_output_image {
    void* pixels;
    ptrdiff_t row_stride;
    int32_t width;
    int32_t height;
    int32_t channels;
    int32_t sample_type;
} relief_output_image;

enum relief_green {
    RELIEF_GREEN_UP = 0,   ///< OpenGL and glTF.
    RELIEF_GREEN_DOWN = 1  ///< DirectX.
};

/// The code of zero in maps of 8 and 16 bits.
enum relief_flat_code {
    RELIEF_FLAT_MIDDLE = 0,  ///< 128 of 255, 32768 of 65535.
    RELIEF_FLAT_HALF = 1     ///< 127.5 and 32767.5: n = 2 * code / 255 - 1, as engines decode.
};

enum relief_dither {
    RELIEF_DITHER_NONE = 0,
    RELIEF_DITHER_ORDERED = 1,
    RELIEF_DITHER_BLUE_NOISE = 2
};

/// Derivative kernels; docs/bump.md has their errors.
enum relief_kernel {
    RELIEF_KERNEL_AUTOMATIC = -1,  ///< The kernel with the least expected error on this map.
    RELIEF_KERNEL_FORWARD = 0,
    RELIEF_KERNEL_CENTRAL3 = 1,
    RELIEF_KERNEL_PREWITT3 = 2,
    RELIEF_KERNEL_SOBEL3 = 3,
    RELIEF_KERNEL_SCHARR3 = 4,
    RELIEF_KERNEL_SOBEL5 = 5,
    RELIEF_KERNEL_SCHARR5 = 6,
    RELIEF_KERNEL_CENTRAL5 = 7,
    RELIEF_KERNEL_CENTRAL7 = 8,
    RELIEF_KERNEL_GAUSSIAN = 9
};

/// The continuation of a map beyond its border.
enum relief_wrap {
    RELIEF_WRAP_AUTOMATIC = -1,  ///< REPEAT along axes along which the map tiles, else CLAMP.
    RELIEF_WRAP_REPEAT = 0,
    RELIEF_WRAP_CLAMP = 1,
    RELIEF_WRAP_MIRROR = 2
};

typedef struct relief_bump_options {
    size_t size;
    double strength;          ///< The height of the value 1 in the unit of texels. Default: 16.
    double texel_width;       ///< 1e-30 to 1e30. Default: 1, so that `strength` is in texels.
    double texel_height;      ///< Default: 1.
    int32_t kernel;           ///< relief_kernel. Default: RELIEF_KERNEL_AUTOMATIC.
    int32_t gaussian_radius;  ///< Of RELIEF_KERNEL_GAUSSIAN, 1 to 64 texels. Default: 2.
    int32_t wrap_x;  ///< relief_wrap. Both are AUTOMATIC, or none. Default: RELIEF_WRAP_AUTOMATIC.
    int32_t wrap_y;
    int32_t arithmetic;  ///< Default: RELIEF_ARITHMETIC_AUTOMATIC, FLOAT32 for 8 and 16 bits.
    int32_t green;       ///< relief_green. Default: RELIEF_GREEN_UP.
    int32_t flat;        ///< relief_flat_code. Default: RELIEF_FLAT_HALF.
    int32_t dither;      ///< relief_dither. Default: RELIEF_DITHER_NONE.
} relief_bump_options;
RELIEF_C_API relief_status relief_bump_options_init(relief_bump_options* options, size_t size);

/// Replaces the options that are AUTOMATIC by those that relief_normal_map_from_height() chooses
/// for this map.
RELIEF_C_API relief_status relief_resolve_bump_options(const relief_image* height,
                                                       relief_bump_options* options);

/// Computes a normal map in tangent space from a height map, as normal_map_from_height()
/// (relief/mesh/bump.h).
///
/// \param height  one channel: integers for value / 255 and value / 65535, or floats
/// \param map  of the size of `height`, 2 to 4 channels: x and y; x, y and z; or these and an alpha
///         of 1. Floats store (n + 1) / 2. A constant height map is exactly flat
/// \param report  counts heights that are not finite and replaced by their neighborhood
/// \return RELIEF_INVALID_INPUT if an image is empty or does not fit, or an option is out of range
RELIEF_C_API relief_status relief_normal_map_from_height(const relief_image* height,
                                                         const relief_bump_options* options,
                                                         const relief_execution* execution,
                                                         const relief_output_image* map,
                                                         relief_report* report);

// Bakes.

enum relief_vector_space { RELIEF_SPACE_TANGENT = 0, RELIEF_SPACE_OBJECT = 1 };

/// The direction of rays.
enum relief_ray_directions {
    RELIEF_RAYS_AVERAGED = 0,  ///< Smoothed normals: hard edges leave no gaps.
    RELIEF_RAYS_SHADING = 1,   ///< The vertex normals of the low mesh.
    RELIEF_RAYS_FACE = 2       ///< The face normal of each triangle.
};

/// Options of relief_bake(), as BakeOptions (relief/mesh/bake.h).
typedef struct relief_bake_options {
    size_t size;
    const relief_mesh* cage;    ///< The low mesh, moved outwards, with the same triangles; or NULL.
    double offset;              ///< Length of rays outside of the low mesh. Default: RELIEF_ABSENT,
                                ///< automatic.
    double max_distance;        ///< And inside. Default: RELIEF_ABSENT, automatic.
    double hardness;            ///< 0 (averaged) to 1 (vertex normals) at hard edges. Default: 0.
    double sample_angle;        ///< Adaptive sampling: more samples where normals differ by more.
                                ///< Default: RELIEF_ABSENT, all samples.
    double occlusion_distance;  ///< Default: RELIEF_ABSENT, half of the longest side.
    int32_t occlusion_rays;     ///< For each texel, 1 to 65536; also of bent normals. Default: 64.
    int32_t samples;            ///< For each texel: 1, 4, 16, 64 or 256. Default: 1.
    int32_t padding;            ///< Around charts, 0 to 1024 texels. Default: 0.
    int32_t space;              ///< relief_vector_space. Default: RELIEF_SPACE_TANGENT.
    int32_t directions;         ///< relief_ray_directions. Default: RELIEF_RAYS_AVERAGED.
    int32_t take_back_faces;    ///< Not 0: rays hit both sides of the high mesh. Default: 0.
    int32_t allow_size_mismatch;  ///< Not 0: sizes may differ by more than 10 times. Default: 0.
    int32_t green;                ///< relief_green, of both normals. Default: RELIEF_GREEN_UP.
    int32_t flat;                 ///< relief_flat_code. Default: RELIEF_FLAT_HALF.
    int32_t dither;               ///< relief_dither. Default: RELIEF_DITHER_NONE.
    double thickness_distance;    ///< Default: RELIEF_ABSENT, the longest side.
    int32_t thickness_rays;       ///< For each texel, 1 to 65536. Default: 64.
    int32_t reserved;             ///< 0
    /// For each high mesh, a number for each of its triangles, such as that of its material, for
    /// `ids` of relief_bake_maps; NULL: the number of the mesh. A number is below 2^24, and at most
    /// 65536 are different. Default: NULL, the numbers of the meshes.
    const uint32_t* const* high_ids;
} relief_bake_options;
RELIEF_C_API relief_status relief_bake_options_init(relief_bake_options* options, size_t size);

/// The origin of a texel's value.
enum relief_texel_state {
    RELIEF_TEXEL_EMPTY = 0,   ///< No triangle overlaps the texel.
    RELIEF_TEXEL_MISSED = 1,  ///< No ray hit a surface.
    RELIEF_TEXEL_BAKED = 2,
    RELIEF_TEXEL_PADDED = 3  ///< Filled from the nearest baked texels.
};

/// The maps to bake: at least one image, all of one size. Images without pixels are not computed.
typedef struct relief_bake_maps {
    size_t size;
    relief_output_image normals;    ///< 2 to 4 channels, as in relief_normal_map_from_height().
    relief_output_image heights;    ///< One float: above the low mesh, in units of the meshes.
    relief_output_image occlusion;  ///< One float from 0 (hidden) to 1 (open).
    uint8_t* states;                ///< relief_texel_state of each texel, contiguous; or NULL.
    /// The mean directions of occlusion rays that hit nothing, coded as `normals`.
    relief_output_image bent_normals;
    relief_output_image thickness;  ///< One float: the distance to the surface behind.
    relief_output_image curvature;  ///< One float: the mean curvature; convex is positive.
    relief_output_image positions;  ///< Three floats: of the high surface.
    /// One float: the number of the triangle (relief_bake_options::high_ids) that most samples hit.
    relief_output_image ids;
} relief_bake_maps;
RELIEF_C_API relief_status relief_bake_maps_init(relief_bake_maps* maps, size_t size);

typedef struct relief_bake_result {
    size_t size;
    size_t texels_baked;
    size_t texels_missed;
    size_t rays;
    double offset;        ///< The length of rays outside of the low mesh.
    double max_distance;  ///< And inside.
    double min_height;    ///< Of the high surface above the low mesh, over all hits; 0 without any.
    double max_height;
    size_t occlusion_rays;       ///< Also those of bent normals.
    size_t thickness_rays;       ///< All of them.
    size_t open_thickness_rays;  ///< Those that hit nothing.
} relief_bake_result;
RELIEF_C_API relief_status relief_bake_result_init(relief_bake_result* result, size_t size);

/// Bakes maps for a low-poly mesh from high-poly meshes, as Baker (relief/mesh/bake.h).
///
/// \param high  pointers to `high_count` meshes with positions and triangles, in the space of
/// `low`.
///         Missing normals are averaged
/// \param low  with positions, texture coordinates and triangles. Missing normals are averaged, and
///         missing tangents are MikkTSpace's
/// \param maps  texels that are neither baked nor padded are flat, 0 high, open, of the id -1, and
/// 0
///         in all other maps
/// \param result  initialized; may be NULL
/// \param report  counts problems of the meshes and missed texels
/// \return RELIEF_INVALID_INPUT also if the bounding boxes of high and low meshes do not match;
///         RELIEF_UNAVAILABLE for any arguments if the library was built with RELIEF_C_BAKE=OFF,
///         without relief::bake and Embree
RELIEF_C_API relief_status relief_bake(const relief_mesh* const* high, size_t high_count,
                                       const relief_mesh* low, const relief_bake_options* options,
                                       const relief_execution* execution,
                                       const relief_bake_maps* maps, relief_bake_result* result,
                                       relief_report* report);

#ifdef __cplusplus
}
#endif
// NOLINTEND
