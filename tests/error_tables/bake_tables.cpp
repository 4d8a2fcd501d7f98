// SPDX-License-Identifier: Apache-2.0
// Errors of baked maps by samples and depth, by the direction of rays, and by padding.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "error_tables/bumpy_reference.h"
#include "error_tables/error_tables.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/statistics.h"

namespace relief::test {
using namespace relief::accuracy::detail;

namespace {

constexpr int sampled_map_side = 256;
constexpr LowSphere low_sphere{46, 23};

/// Bakes a map in tangent space.
WholeBake baked(const Baker& baker, int samples, bool is_auto) {
    BakeMapOptions map;
    map.width = map.height = sampled_map_side;
    map.samples = samples;
    if (is_auto) map.sample_angle = glm::radians(2.0);
    return whole_bake(baker, map);
}

/// Returns the normals that a shader reads from the stored map, in object space.
Image as_seen(const Image& normals, const Mesh& low, int bits) {
    Report report;
    const NormalMapFormat format{.bits = bits};
    const Image decoded = decode_normal_map(encode_normal_map(normals, format, report),
                                            format.green, format.flat, report);
    return object_from_tangent(decoded, low, {}, report).normals;
}

std::string errors(const Image& seen, const std::vector<TexelReference>& references,
                   glm::dvec3 TexelReference::*which) {
    std::vector<float> degrees;
    for (const TexelReference& reference : references) {
        const float* const n = &seen.as<float>()[3 * reference.texel];
        degrees.push_back(
            static_cast<float>(degrees_between(glm::dvec3(n[0], n[1], n[2]), reference.*which)));
    }
    const ErrorStats all = error_stats(degrees);
    const auto digits = [](double value) {
        return value < 0.1 ? fmt::format("{:.4f}", value) : fmt::format("{:.2f}", value);
    };
    return digits(all.rms) + " / " + digits(all.p99) + " / " + digits(all.max);
}

std::string sample_tables() {
    const BumpySphere high(200);
    Report report;
    const Mesh low = with_frames(make_sphere(low_sphere.slices, low_sphere.stacks),
                                 {.tangents = TangentMethod::mikktspace}, report)
                         .mesh;
    Mesh rays = low;  // The default ray direction is the smoothed normal.
    rays.normals = vertex_normals(low.positions, low.triangles, NormalWeight::angle, report);
    const std::vector<TexelReference> all =
        texel_references(high, rays, low_sphere, sampled_map_side);
    const Baker baker(std::span(&high.mesh(), 1), low, {}, report);
    const WholeBake single = baked(baker, 1, false);
    std::string text =
        "\nError of one ray from the surface at the center of each texel, in degrees: RMS / 99 % / "
        "maximum\n\n" +
        table_header({"against the mesh's triangles", "against the surface itself"});
    for (const int bits : {8, 16, 32}) {
        const Image seen = as_seen(single.normals, low, bits);
        text += table_row(fmt::format("{} bit", bits),
                          {errors(seen, all, &TexelReference::mesh_middle),
                           errors(seen, all, &TexelReference::surface_middle)});
    }
    text +=
        "\nError from the mean over the square of each texel, in degrees: RMS / 99 % / "
        "maximum\n\n" +
        table_header(
            {"rays per texel", "8 bit, mesh", "16 bit, mesh", "8 bit, surface", "16 bit, surface"});
    struct Choice {
        const char* name;
        int samples;
        bool is_auto;
    };
    for (const Choice& choice : {Choice{"`--samples 1`", 1, false},
                                 {"`--samples 4`", 4, false},
                                 {"`--samples 16`", 16, false},
                                 {"`--samples 64`", 64, false},
                                 {"`--samples auto`", 16, true}}) {
        const WholeBake map = baked(baker, choice.samples, choice.is_auto);
        const Image coarse = as_seen(map.normals, low, 8);
        const Image fine = as_seen(map.normals, low, 16);
        text += table_row(
            choice.name,
            {fmt::format("{:.1f}",
                         static_cast<double>(map.rays) / (sampled_map_side * sampled_map_side)),
             errors(coarse, all, &TexelReference::mesh), errors(fine, all, &TexelReference::mesh),
             errors(coarse, all, &TexelReference::surface),
             errors(fine, all, &TexelReference::surface)});
    }
    return text;
}

constexpr int direction_map_side = 64;
constexpr double outside = 1.1;

/// A cube of half size 1 whose face +z has cells x cells cells. Only this face lies in the map.
Mesh low_cube(int cells) {
    Mesh cube = make_cube();
    cube.triangles.erase(cube.triangles.begin(), cube.triangles.begin() + 2);
    for (glm::vec2& texcoord : cube.texcoords)
        texcoord += glm::vec2(4.0F);
    Mesh face = make_quad(cells);
    for (glm::vec3& position : face.positions)
        position.z = 1.0F;
    const auto first = static_cast<std::uint32_t>(cube.positions.size());
    for (std::size_t i = 0; i < face.positions.size(); ++i) {
        cube.positions.push_back(face.positions[i]);
        cube.normals.push_back({0, 0, 1});
        cube.texcoords.push_back(face.texcoords[i]);
    }
    for (const glm::uvec3& triangle : face.triangles)
        cube.triangles.push_back(triangle + first);
    return cube;
}

Mesh high_cube() {
    Mesh cube = make_cube();
    for (std::size_t i = 0; i < cube.positions.size(); ++i) {
        cube.normals[i] = cube.positions[i];
        cube.positions[i] *= static_cast<float>(outside);
    }
    return cube;
}

struct Kept {
    double seen = 0.0;    ///< The share of the side of the high face that the map shows.
    double skewed = 0.0;  ///< The largest shift of a point along the face, divided by its height.
};

Kept kept(const Mesh& low, BakeOptions options) {
    options.map.width = options.map.height = direction_map_side;
    options.space = VectorSpace::object;
    options.offset = 0.2;
    options.max_distance = 0.1;
    Kept result;
    const Mesh high = high_cube();
    Report report;
    bake_normals(
        std::span(&high, 1), low, options,
        [&](const BakedRows& rows) {
            for (std::size_t i = 0; i < rows.states.size(); ++i) {
                if (rows.states[i] != TexelState::baked) continue;
                const float* const n = &rows.normals[3 * i];
                const glm::dvec2 met = outside / double{n[2]} * glm::dvec2(n[0], n[1]);
                const auto x = static_cast<double>(i % direction_map_side);
                const auto y = static_cast<double>(i / direction_map_side) + rows.first_row;
                const glm::dvec2 from((x + 0.5) / direction_map_side * 2.0 - 1.0,
                                      1.0 - (y + 0.5) / direction_map_side * 2.0);
                // The map shows half a texel beyond the outermost texel center.
                const double end = std::max(std::abs(met.x), std::abs(met.y)) * direction_map_side /
                                   (direction_map_side - 1.0);
                result.seen = std::max(result.seen, std::min(end / outside, 1.0));
                result.skewed = std::max(result.skewed, glm::length(met - from) / (outside - 1.0));
            }
        },
        report);
    return result;
}

std::string direction_row(const std::string& name, const BakeOptions& options) {
    std::vector<std::string> cells;
    for (const int cells_of_face : {1, 8}) {
        const Kept result = kept(low_cube(cells_of_face), options);
        cells.push_back(fmt::format("{:.0f}%", 100.0 * (1.0 - result.seen * result.seen)));
        cells.push_back(fmt::format("{:.2f}", result.skewed));
    }
    return table_row(name, cells);
}

std::string direction_tables() {
    std::string text =
        "\nFraction of the high-poly face that is not in the map, and the maximum shift of a point "
        "along\nthe face, in units of its height above the low-poly face\n\n" +
        table_header(
            {"missing, face of 2 triangles", "shift", "missing, face of 128 triangles", "shift"});
    text += direction_row("`--rays averaged` (default)", {});
    for (const double hardness : {0.5, 1.0}) {
        BakeOptions options;
        options.hardness = hardness;
        text += direction_row(fmt::format("`--hardness {:g}`", hardness), options);
    }
    BakeOptions shading;
    shading.directions = RayDirections::shading;
    text += direction_row("`--rays shading`", shading);
    BakeOptions face;
    face.directions = RayDirections::face;
    text += direction_row("`--rays face`", face);
    return text;
}

constexpr int padded_map_side = 256;
constexpr int level_count = 6;
/// Corners of the chart in the map. At no level do they lie on the border of a texel.
constexpr float chart_begin = 0.3134F;
constexpr float chart_end = 0.6921F;
constexpr glm::vec3 slant{0.6F, 0.0F, 0.8F};

Image baked(int padding) {
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord = chart_begin + (chart_end - chart_begin) * texcoord;
    Mesh high = low;
    std::fill(high.normals.begin(), high.normals.end(), slant);
    BakeOptions options;
    options.map.width = options.map.height = padded_map_side;
    options.map.padding = padding;
    options.space = VectorSpace::object;
    Report report;
    return whole_bake(Baker(std::span(&high, 1), low, options, report), options.map).normals;
}

/// Returns the largest error that a bilinear lookup within the chart can see. It includes the
/// texels next to the chart.
double max_error_seen(const Image& level) {
    const auto seen = [&](double edge, double by) {
        return static_cast<int>(std::floor(edge * level.width - 0.5 + by));
    };
    double max = 0.0;
    for (int y = seen(chart_begin, 0.0); y <= seen(chart_end, 1.0); ++y) {
        for (int x = seen(chart_begin, 0.0); x <= seen(chart_end, 1.0); ++x) {
            const float* const n =
                &level.as<float>()[3 * static_cast<std::size_t>(y * level.width + x)];
            max = std::max(max, degrees_between(glm::dvec3(n[0], n[1], n[2]), glm::dvec3(slant)));
        }
    }
    return max;
}

std::string padding_tables() {
    std::vector<std::string> columns = {"the map itself"};
    for (int level = 1; level < level_count; ++level)
        columns.push_back(fmt::format("level {}", level));
    std::string text = "\nMaximum error of bilinear lookups within the chart, in degrees\n\n" +
                       table_header(columns);
    for (const int padding : {0, 1, 2, 4, 8, 16, 32, 64}) {
        const Image map = baked(padding);
        std::vector<std::string> cells = {in_digits(max_error_seen(map))};
        const std::vector<Image> smaller = mip_levels(map);
        for (int level = 1; level < level_count; ++level)
            cells.push_back(
                in_digits(max_error_seen(smaller[static_cast<std::size_t>(level - 1)])));
        text += table_row(fmt::format("`--padding {}`", padding), cells);
    }
    return text;
}

}  // namespace

std::vector<PageSection> bake_tables() {
    return {written_section("tables of samples", sample_tables()),
            written_section("tables of directions", direction_tables()),
            written_section("tables of padding", padding_tables())};
}

}  // namespace relief::test
