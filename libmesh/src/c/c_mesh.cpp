// SPDX-License-Identifier: Apache-2.0
// Normals, tangents, vertices of corners, and unwrapping.
#include <span>
#include <vector>

#include "c/c_call.h"
#include "progress_stage.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"
#include "relief/mesh/unwrap.h"

using namespace relief;
using namespace relief::detail;

namespace {

constexpr std::array weights = {
    NormalWeight::uniform, NormalWeight::area,        NormalWeight::angle,     NormalWeight::sine,
    NormalWeight::max,     NormalWeight::angle_edges, NormalWeight::area_angle};
constexpr std::array arithmetics = {Arithmetic::float64, Arithmetic::float32};
constexpr std::array flattenings = {Flattening::arap, Flattening::conformal};

relief_normal_options default_normal_options() {
    const NormalOptions defaults;
    relief_normal_options options{};
    options.weld_tolerance = defaults.weld_tolerance.value_or(RELIEF_ABSENT);
    options.crease_angle = RELIEF_ABSENT;
    options.weight = number_of(defaults.weight, weights);
    options.arithmetic = number_of(defaults.arithmetic, arithmetics);
    return options;
}

/// The options of a call as those of C++.
struct GivenNormalOptions {
    explicit GivenNormalOptions(const relief_normal_options* given) {
        const relief_normal_options read =
            read_struct(given, default_normal_options(), "relief_normal_options");
        weight = optional_enumerator(read.weight, weights, "weight");
        if (weight) options.weight = *weight;
        options.arithmetic = enumerator(read.arithmetic, arithmetics, "arithmetic");
        options.weld_tolerance = optional_value(read.weld_tolerance);
        crease_angle = optional_value(read.crease_angle);
    }

    NormalOptions options;
    std::optional<NormalWeight> weight;  ///< Absent: automatic.
    std::optional<double> crease_angle;
};

/// The output of `count` vectors of `size` floats. \throws InvalidInput if it is not as documented
Extent output_extent(const char* name, float* data, std::size_t count, std::size_t size,
                     std::size_t stride) {
    const Extent extent{name, data, count, size * sizeof(float), stride};
    return {name, data, count, extent.size, extent.checked_stride(sizeof(float))};
}

/// The output of three values for each triangle.
Extent corner_extent(const char* name, float* data, const CMesh& mesh, std::size_t size) {
    return output_extent(name, data, 3 * mesh.triangles().size(), size, 0);
}

template <typename Value>
void copy_to(const std::vector<Value>& values, float* floats) {
    if (!values.empty()) std::memcpy(floats, values.data(), values.size() * sizeof(Value));
}

relief_unwrap_options default_unwrap_options() {
    const UnwrapOptions defaults;
    relief_unwrap_options options{};
    options.width = defaults.size.x;
    options.height = defaults.size.y;
    options.padding = defaults.padding;
    options.alignment = defaults.alignment;
    options.max_stretch = defaults.max_stretch;
    options.split_hard = defaults.split_hard.value_or(RELIEF_ABSENT);
    options.texels_per_unit = defaults.texels_per_unit.value_or(RELIEF_ABSENT);
    options.keep_seams = defaults.keep_seams ? 1 : 0;
    options.flattening = number_of(defaults.flattening, flattenings);
    return options;
}

UnwrapOptions unwrap_options(const relief_unwrap_options* given) {
    const relief_unwrap_options read =
        read_struct(given, default_unwrap_options(), "relief_unwrap_options");
    UnwrapOptions options;
    options.size = {read.width, read.height};
    options.padding = read.padding;
    options.alignment = read.alignment;
    options.max_stretch = read.max_stretch;
    options.split_hard = optional_value(read.split_hard);
    options.texels_per_unit = optional_value(read.texels_per_unit);
    options.keep_seams = read.keep_seams != 0;
    options.flattening = enumerator(read.flattening, flattenings, "flattening");
    return options;
}

/// Splits vertices by values of two to four floats.
VertexSplit split_by_values(const CMesh& mesh, const float* values, std::size_t components) {
    std::vector<glm::uvec3> triangles(mesh.triangles().size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        triangles[i] = mesh.triangles()[i];
    std::vector<glm::vec4> corner_values(3 * triangles.size(), glm::vec4(0.0F));
    for (std::size_t corner = 0; corner < corner_values.size(); ++corner)
        std::copy_n(values + components * corner, components, &corner_values[corner].x);
    return split_where_corners_differ(mesh.vertex_count(), triangles, corner_values);
}

}  // namespace

relief_status relief_normal_options_init(relief_normal_options* options, size_t size) {
    return init_struct(options, size, default_normal_options(), "relief_normal_options");
}

relief_status relief_vertex_normals(const relief_mesh* mesh, const relief_normal_options* options,
                                    const relief_execution* execution, float* normals,
                                    size_t normal_stride, relief_report* report) {
    return guarded([&] {
        const CMesh given(mesh);
        const GivenNormalOptions read(options);
        if (read.crease_angle) {
            throw InvalidInput(
                "crease_angle: a vertex has one normal here (use relief_corner_normals())");
        }
        const StridedSpan<const glm::vec3> positions = given.positions();
        const Extent output =
            output_extent("output normals", normals, given.vertex_count(), 3, normal_stride);
        check_apart(output, given.position_extent());
        check_apart(output, given.indices());
        const StridedSpan<glm::vec3> to(normals, output.count, output.stride);
        const Execution run(execution);
        const ExecutionScope scope(run.options());
        const ProgressStage stage("normals");
        CallReport findings(report);
        if (read.weight)
            return vertex_normals(positions, given.triangles(), read.options, to, findings);
        const ChosenNormals chosen =
            chosen_normals(positions, given.triangles(), read.options, findings);
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] = chosen.normals[i];
    });
}

relief_status relief_corner_normals(const relief_mesh* mesh, const relief_normal_options* options,
                                    const relief_execution* execution, float* normals,
                                    relief_report* report) {
    return guarded([&] {
        const CMesh given(mesh);
        const GivenNormalOptions read(options);
        const StridedSpan<const glm::vec3> positions = given.positions();
        const Extent output = corner_extent("output normals", normals, given, 3);
        check_apart(output, given.position_extent());
        check_apart(output, given.indices());
        const Execution run(execution);
        const ExecutionScope scope(run.options());
        const ProgressStage stage("normals");
        CallReport findings(report);
        HardEdges hard_edges;
        hard_edges.crease_angle = read.crease_angle;
        copy_to(corner_normals(positions, given.triangles(), read.weight, read.options, hard_edges,
                               findings)
                    .normals,
                normals);
    });
}

relief_status relief_vertex_tangents(const relief_mesh* mesh, const relief_execution* execution,
                                     float* tangents, size_t tangent_stride,
                                     relief_report* report) {
    return guarded([&] {
        const CMesh given(mesh);
        const Extent output =
            output_extent("output tangents", tangents, given.vertex_count(), 4, tangent_stride);
        for (const Extent& input : {given.position_extent(), given.normal_extent(),
                                    given.texcoord_extent(), given.indices()})
            check_apart(output, input);
        const Execution run(execution);
        CallReport findings(report);
        vertex_tangents(given.positions(), given.normals(), given.texcoords(), given.triangles(),
                        StridedSpan<glm::vec4>(tangents, output.count, output.stride), findings,
                        run.options());
    });
}

relief_status relief_corner_tangents(const relief_mesh* mesh, const relief_execution* execution,
                                     float* tangents, relief_report* report) {
    return guarded([&] {
        const CMesh given(mesh);
        const Extent output = corner_extent("output tangents", tangents, given, 4);
        for (const Extent& input : {given.position_extent(), given.normal_extent(),
                                    given.texcoord_extent(), given.indices()})
            check_apart(output, input);
        const Execution run(execution);
        CallReport findings(report);
        corner_tangents(given.positions(), given.normals(), given.texcoords(), given.triangles(),
                        std::span(reinterpret_cast<glm::vec4*>(tangents), output.count), findings,
                        run.options());
    });
}

relief_status relief_split_vertices(const relief_mesh* mesh, const float* corner_values,
                                    size_t components, uint32_t* indices, uint32_t* source_vertices,
                                    size_t capacity, size_t* vertex_count) {
    return guarded([&] {
        const CMesh given(mesh);
        if (components < 2 || components > 4) {
            throw InvalidInput(
                fmt::format("components is {}, but must be within 2 to 4", components));
        }
        if (vertex_count == nullptr) throw InvalidInput("vertex_count is NULL");
        const std::size_t corners = 3 * given.triangles().size();
        const Extent values{"corner values", corner_values, corners, components * sizeof(float), 0};
        const Extent sources{"source vertices", source_vertices, capacity, sizeof(uint32_t), 0};
        const Extent new_indices{"output indices", indices, corners, sizeof(uint32_t), 0};
        for (const Extent& array : {values, sources, new_indices})
            static_cast<void>(array.checked_stride(sizeof(float)));
        check_apart(new_indices, sources);
        const VertexSplit split = split_by_values(given, corner_values, components);
        *vertex_count = split.source_vertex.size();
        if (capacity < split.source_vertex.size()) {
            throw InvalidInput(fmt::format("the capacity is {}, but there are {} vertices",
                                           capacity, split.source_vertex.size()));
        }
        std::copy(split.source_vertex.begin(), split.source_vertex.end(), source_vertices);
        for (std::size_t i = 0; i < corners; ++i)
            indices[i] = split.triangles[i / 3][static_cast<int>(i % 3)];
    });
}

relief_status relief_unwrap_options_init(relief_unwrap_options* options, size_t size) {
    return init_struct(options, size, default_unwrap_options(), "relief_unwrap_options");
}

relief_status relief_atlas_stats_init(relief_atlas_stats* stats, size_t size) {
    return init_struct(stats, size, {}, "relief_atlas_stats");
}

relief_status relief_unwrap(const relief_mesh* mesh, const relief_unwrap_options* options,
                            const relief_execution* execution, float* texcoords, uint32_t* charts,
                            relief_atlas_stats* stats, relief_report* report) {
    return guarded([&] {
        const CMesh given(mesh);
        UnwrapOptions read = unwrap_options(options);
        static_cast<void>(corner_extent("output texture coordinates", texcoords, given, 2));
        if (stats != nullptr)
            check_struct_size<relief_atlas_stats>(stats->size, "relief_atlas_stats");
        const Execution run(execution);
        read.execution = run.options();
        CallReport findings(report);
        const Unwrapped unwrapped = unwrap(given.copy(), read, findings);
        copy_to(unwrapped.corner_texcoords, texcoords);
        for (std::size_t i = 0; charts != nullptr && i < unwrapped.chart.size(); ++i)
            charts[i] = unwrapped.chart[i].value_or(RELIEF_NO_CHART);
        const AtlasStats& made = unwrapped.stats;
        write_struct(stats,
                     {.size = 0,
                      .charts = made.charts,
                      .used = made.used,
                      .texels_per_unit = made.texels_per_unit,
                      .stretch = made.stretch,
                      .max_anisotropy = made.max_anisotropy,
                      .seam_length = made.seam_length,
                      .area = made.area},
                     "relief_atlas_stats");
    });
}
