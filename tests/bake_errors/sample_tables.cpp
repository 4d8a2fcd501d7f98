// SPDX-License-Identifier: Apache-2.0
// A sphere with bumps of 160,000 triangles, baked onto one of 2,024 by 1 to 64 samples, stored in 8
// and 16 bits, and read back as a shader does: codes decoded, put through the low mesh's basis. The
// truth is what a texel's square shows, the mean of 16 x 16 lines through it, by the formula of the
// surface and by the triangles that stand for it.
#include <fmt/format.h>

#include <cmath>

#include "bake_errors/bumpy_sphere.h"
#include "bake_errors/error_tables.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/shapes.h"

namespace relief::test {
namespace {

constexpr int map_side = 256;
constexpr int low_slices = 46;
constexpr int low_stacks = 23;
constexpr int truth_side = 16;
constexpr int truth_stride = 37;  ///< Every so many texels are looked at.

/// A texel's normals, object space.
struct Truth {
    std::size_t texel = 0;
    glm::dvec3 surface{0.0};  ///< The mean over its square.
    glm::dvec3 mesh{0.0};
    glm::dvec3 surface_middle{0.0};  ///< At its centre.
    glm::dvec3 mesh_middle{0.0};
};

/// Where a place of the texture is on the low mesh, and its outward direction there.
struct LowPoint {
    glm::dvec3 position{0.0};
    glm::dvec3 outward{0.0};
};

LowPoint low_point(const Mesh& low, double u, double v) {
    const double x = u * low_slices;
    const double y = v * low_stacks;
    const auto cell = static_cast<std::size_t>(std::floor(y)) * low_slices +
                      static_cast<std::size_t>(std::floor(x));
    for (const std::size_t index : {2 * cell, 2 * cell + 1}) {
        const glm::uvec3& t = low.triangles[index];
        const auto at = [&](std::uint32_t corner) { return glm::dvec2(low.texcoords[corner]); };
        const glm::dvec2 a = at(t.x), e = at(t.y) - a, f = at(t.z) - a, p = glm::dvec2(u, v) - a;
        const double area = e.x * f.y - e.y * f.x;
        const double second = (p.x * f.y - p.y * f.x) / area;
        const double third = (e.x * p.y - e.y * p.x) / area;
        if (std::min({second, third, 1.0 - second - third}) < -1e-6) continue;
        const auto mixed = [&](const std::vector<glm::vec3>& values) {
            return (1.0 - second - third) * glm::dvec3(values[t.x]) +
                   second * glm::dvec3(values[t.y]) + third * glm::dvec3(values[t.z]);
        };
        return {mixed(low.positions), glm::normalize(mixed(low.normals))};
    }
    throw std::logic_error("a texel lies on no triangle");
}

Truth truth_of(const BumpySphere& high, const Mesh& low, std::size_t texel) {
    Truth truth{texel};
    const auto add = [&](double x, double y, glm::dvec3& surface, glm::dvec3& mesh) {
        const LowPoint point = low_point(low, x / map_side, y / map_side);
        const glm::dvec3 from = point.position + 0.05 * point.outward;
        surface += BumpySphere::on_surface(from, -point.outward).normal;
        mesh += high.on_mesh(from, -point.outward).normal;
    };
    const auto x = static_cast<double>(texel % map_side);
    const auto y = static_cast<double>(texel / map_side);
    for (int i = 0; i < truth_side * truth_side; ++i) {
        add(x + (i % truth_side + 0.5) / truth_side, y + (i / truth_side + 0.5) / truth_side,
            truth.surface, truth.mesh);
    }
    add(x + 0.5, y + 0.5, truth.surface_middle, truth.mesh_middle);
    return truth;
}

/// Away from the poles, where the formula's surface is none.
std::vector<Truth> truths(const BumpySphere& high, const Mesh& low) {
    std::vector<Truth> all;
    constexpr std::size_t first = map_side * (map_side / 10);
    for (std::size_t texel = first; texel < map_side * map_side - first; texel += truth_stride)
        all.push_back(truth_of(high, low, texel));
    return all;
}

struct Baked {
    Image normals;  ///< Tangent space.
    double rays_per_texel = 0.0;
};

Baked baked(const BumpySphere& high, const Mesh& low, int samples, bool is_auto) {
    Baked result{make_image(map_side, map_side, 3, 32, ColorSpace::data)};
    BakeOptions options;
    options.width = options.height = map_side;
    options.samples = samples;
    if (is_auto) options.sample_angle = glm::radians(2.0);
    Report report;
    const std::span<float> all = result.normals.as<float>();
    const BakeResult done = bake_normals(
        std::span(&high.mesh(), 1), low, options,
        [&](const BakedRows& rows) {
            std::copy(rows.normals.begin(), rows.normals.end(),
                      all.begin() + std::ptrdiff_t{3} * map_side * rows.first_row);
        },
        report);
    result.rays_per_texel = static_cast<double>(done.rays) / (map_side * map_side);
    return result;
}

/// What a shader makes of the map once it is stored, object space.
Image as_seen(const Image& normals, const Mesh& low, int bits) {
    Report report;
    const NormalMapFormat format{.bits = bits};
    const Image decoded = decode_normal_map(encode_normal_map(normals, format, report),
                                            format.green, format.flat, report);
    return object_from_tangent(decoded, low, {}, report).normals;
}

std::string errors(const Image& seen, const std::vector<Truth>& truths, glm::dvec3 Truth::*which) {
    std::vector<float> degrees;
    for (const Truth& truth : truths) {
        const float* const n = &seen.as<float>()[3 * truth.texel];
        degrees.push_back(
            static_cast<float>(degrees_between(glm::dvec3(n[0], n[1], n[2]), truth.*which)));
    }
    const AngleDistribution all = angle_distribution(degrees);
    const auto digits = [](double value) {
        return value < 0.1 ? fmt::format("{:.4f}", value) : fmt::format("{:.2f}", value);
    };
    return digits(all.rms) + " / " + digits(all.p99) + " / " + digits(all.max);
}

std::string row(const std::string& name, const std::vector<std::string>& cells) {
    return table_row(name, std::vector<double>(cells.size(), NAN), cells);
}

}  // namespace

std::string sample_tables() {
    const BumpySphere high(200);
    Report report;
    const Mesh low = with_frames(make_sphere(low_slices, low_stacks),
                                 {.tangents = TangentMode::mikktspace}, report)
                         .mesh;
    Mesh rays = low;  // By default they run along averaged normals, whatever the mesh's own are.
    rays.normals = vertex_normals(low.positions, low.triangles, NormalWeight::angle, report);
    const std::vector<Truth> all = truths(high, rays);
    const Baked single = baked(high, low, 1, false);
    std::string text =
        "\nOne ray, against the place on the surface that it asks about: RMS / 99 of 100 / "
        "greatest "
        "error in degrees\n\n" +
        table_header({"against the mesh's triangles", "against the surface itself"});
    for (const int bits : {8, 16, 32}) {
        const Image seen = as_seen(single.normals, low, bits);
        text += row(fmt::format("{} bit", bits), {errors(seen, all, &Truth::mesh_middle),
                                                  errors(seen, all, &Truth::surface_middle)});
    }
    text +=
        "\nAgainst all that a texel shows, the mean over its square: RMS / 99 of 100 / greatest "
        "error in degrees\n\n" +
        table_header(
            {"rays a texel", "8 bit, mesh", "16 bit, mesh", "8 bit, surface", "16 bit, surface"});
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
        const Baked map = baked(high, low, choice.samples, choice.is_auto);
        const Image coarse = as_seen(map.normals, low, 8);
        const Image fine = as_seen(map.normals, low, 16);
        text += row(choice.name,
                    {fmt::format("{:.1f}", map.rays_per_texel), errors(coarse, all, &Truth::mesh),
                     errors(fine, all, &Truth::mesh), errors(coarse, all, &Truth::surface),
                     errors(fine, all, &Truth::surface)});
    }
    return text;
}

}  // namespace relief::test
