// SPDX-License-Identifier: Apache-2.0
// A sphere with bumps of 160,000 triangles, baked onto one of 2,024 by 1 to 64 samples, stored in 8
// and 16 bits, and read back as a shader does: codes decoded, put through the low mesh's basis. The
// truth is what a texel's square shows, the mean of 16 x 16 lines through it, by the formula of the
// surface and by the triangles that stand for it.
#include <fmt/format.h>

#include <cmath>

#include "bake_errors/bumpy_truth.h"
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

constexpr int sampled_map_side = 256;
constexpr LowSphere low_sphere{46, 23};

struct Baked {
    Image normals;  ///< Tangent space.
    double rays_per_texel = 0.0;
};

Baked baked(const BumpySphere& high, const Mesh& low, int samples, bool is_auto) {
    Baked result{make_image(sampled_map_side, sampled_map_side, 3, 32, ColorSpace::data)};
    BakeOptions options;
    options.width = options.height = sampled_map_side;
    options.samples = samples;
    if (is_auto) options.sample_angle = glm::radians(2.0);
    Report report;
    const std::span<float> all = result.normals.as<float>();
    const BakeResult done = bake_normals(
        std::span(&high.mesh(), 1), low, options,
        [&](const BakedRows& rows) {
            std::copy(rows.normals.begin(), rows.normals.end(),
                      all.begin() + std::ptrdiff_t{3} * sampled_map_side * rows.first_row);
        },
        report);
    result.rays_per_texel = static_cast<double>(done.rays) / (sampled_map_side * sampled_map_side);
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

std::string errors(const Image& seen, const std::vector<TexelReference>& references,
                   glm::dvec3 TexelReference::*which) {
    std::vector<float> degrees;
    for (const TexelReference& ground_truth : references) {
        const float* const n = &seen.as<float>()[3 * ground_truth.texel];
        degrees.push_back(
            static_cast<float>(degrees_between(glm::dvec3(n[0], n[1], n[2]), ground_truth.*which)));
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
    const Mesh low = with_frames(make_sphere(low_sphere.slices, low_sphere.stacks),
                                 {.tangents = TangentMode::mikktspace}, report)
                         .mesh;
    Mesh rays = low;  // By default they run along averaged normals, whatever the mesh's own are.
    rays.normals = vertex_normals(low.positions, low.triangles, NormalWeight::angle, report);
    const std::vector<TexelReference> all =
        texel_references(high, rays, low_sphere, sampled_map_side);
    const Baked single = baked(high, low, 1, false);
    std::string text =
        "\nOne ray, against the place on the surface that it asks about: RMS / 99 of 100 / "
        "greatest "
        "error in degrees\n\n" +
        table_header({"against the mesh's triangles", "against the surface itself"});
    for (const int bits : {8, 16, 32}) {
        const Image seen = as_seen(single.normals, low, bits);
        text +=
            row(fmt::format("{} bit", bits), {errors(seen, all, &TexelReference::mesh_middle),
                                              errors(seen, all, &TexelReference::surface_middle)});
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
        text += row(choice.name, {fmt::format("{:.1f}", map.rays_per_texel),
                                  errors(coarse, all, &TexelReference::mesh),
                                  errors(fine, all, &TexelReference::mesh),
                                  errors(coarse, all, &TexelReference::surface),
                                  errors(fine, all, &TexelReference::surface)});
    }
    return text;
}

}  // namespace relief::test
