// SPDX-License-Identifier: Apache-2.0
// Changes of the high or the low mesh (mesh_changes.h) that must not change a baked map, with
// random options of bakes.
//
// Rotated corners of the low mesh may change last bits: sums over the three corners of a triangle
// begin at its first one, and so does MikkTSpace's gradient.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hard_cases/mesh_changes.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/sanitized.h"

namespace relief::test {
namespace {

struct BakePair {
    const char* name;
    Mesh high, low;
};

/// Waves over a square, a torus over itself with fewer triangles, a cube with folds over a cube,
/// and needles over a square.
std::vector<BakePair> bake_pairs() {
    Mesh waves = make_quad(12);
    waves.normals.clear();
    for (glm::vec3& position : waves.positions)
        position.z = 0.05F * std::sin(9.0F * position.x) * std::cos(7.0F * position.y);
    Mesh folded = make_cube();
    for (std::size_t v = 0; v < folded.positions.size(); v += 3)
        folded.positions[v] *= 0.75F;
    Mesh cube = make_cube();
    for (std::size_t v = 0; v < cube.texcoords.size(); ++v) {
        const std::size_t face = v / 4;
        cube.texcoords[v] = (cube.texcoords[v] + glm::vec2(face % 4, face / 4)) * 0.25F;
    }
    Mesh needles = make_quad(40);
    for (glm::vec3& position : needles.positions) {
        position.z = 0.02F * position.x;
        position.y = std::round(position.y) + 0.001F * position.y;
    }
    return {{"waves", waves, make_quad(2)},
            {"torus", make_torus(0.42F, 40, 20), make_torus(0.4F, 12, 8)},
            {"folded cube", folded, cube},
            {"needles", needles, make_quad()}};
}

struct Baked {
    std::vector<float> normals, heights, occlusion, curvature, positions, bent_normals, thickness;
    std::vector<TexelState> states;
};

Baked baked_of(const Mesh& high, const Mesh& low, const BakeOptions& options) {
    Baked map;
    const auto append = [](auto& all, const auto& rows) {
        all.insert(all.end(), rows.begin(), rows.end());
    };
    bake_normals({&high, 1}, low, options, [&](const BakedRows& rows) {
        append(map.normals, rows.normals);
        append(map.heights, rows.heights);
        append(map.occlusion, rows.occlusion);
        append(map.curvature, rows.curvature);
        append(map.positions, rows.positions);
        append(map.bent_normals, rows.bent_normals);
        append(map.thickness, rows.thickness);
        append(map.states, rows.states);
    });
    return map;
}

BakeOptions random_options(Dice& dice) {
    BakeOptions options;
    options.map.width = static_cast<int>(8 + dice.below(20));
    options.map.height = static_cast<int>(8 + dice.below(20));
    options.map.samples = dice.one_in(3) ? 4 : 1;
    if (options.map.samples > 1 && dice.one_in(2)) options.map.sample_angle = 0.05;
    options.map.padding = static_cast<int>(dice.below(4));
    options.space = dice.one_in(3) ? VectorSpace::object : VectorSpace::tangent;
    options.directions = enum_names<RayDirections>[dice.below(3)].value;
    if (options.directions == RayDirections::averaged) options.hardness = 0.25 * dice.below(5);
    options.back_faces = dice.one_in(3) ? BackFaces::take : BackFaces::skip;
    options.allow_size_mismatch = true;
    if (dice.one_in(2)) options.offset = options.max_distance = 0.25;
    options.map.layers.heights = true;
    options.map.layers.curvature = dice.one_in(2);
    options.map.layers.positions = dice.one_in(2);
    if (dice.one_in(2)) options.map.layers.occlusion = OcclusionOptions{16, {}};
    if (dice.one_in(2)) options.map.layers.bent_normals = OcclusionOptions{16, {}};
    if (dice.one_in(2)) options.map.layers.thickness = ThicknessOptions{16, {}};
    return options;
}

/// Limits of differences. By default, normals are equal, and the other layers differ at most by the
/// rounding of double to the size of the meshes, about 1.
struct Tolerances {
    double degrees = 0.0;
    double length = 1e-12;   ///< Of heights, curvatures and positions.
    double occlusion = 0.0;  ///< Of the share of rays.
    /// Of the components of bent normals. If few of 16 rays are open, one ray more can turn the mean
    /// by any angle.
    double bent = 1e-15;
    double thickness = 1e-12;
    /// The share of texels beyond these limits: rays that meet an edge may hit its other triangle.
    double others = 0.0;
};

/// Returns the first texel that differs, or an empty string.
///
/// \param scale  of the changed meshes
std::string map_difference(const Baked& before, const Baked& after, double scale,
                           const Tolerances& tolerances) {
    const std::size_t texels = before.states.size();
    std::vector<bool> differs(texels, false);
    std::string first;
    const auto add = [&](std::size_t texel, const std::string& how) {
        if (first.empty()) first = fmt::format("texel {}: {}", texel, how);
        differs[texel] = true;
    };
    for (std::size_t texel = 0; texel < texels; ++texel) {
        const auto normal = [&](const Baked& map) {
            return glm::dvec3(map.normals[3 * texel], map.normals[3 * texel + 1],
                              map.normals[3 * texel + 2]);
        };
        if (before.states[texel] != after.states[texel]) {
            add(texel, "another state");
            continue;
        }
        if (normal(before) == normal(after)) continue;
        const double degrees = degrees_between(normal(before), normal(after));
        if (tolerances.degrees > 0.0 && degrees <= tolerances.degrees) continue;
        add(texel, fmt::format("a normal turned by {} degrees", degrees));
    }
    const auto compare = [&](const char* name, const std::vector<float>& was,
                             const std::vector<float>& is, double factor, double limit) {
        for (std::size_t i = 0; i < was.size(); ++i) {
            const double value = double(is[i]) / factor;
            if (double(was[i]) == value || std::abs(double(was[i]) - value) <= limit) continue;
            add(i * texels / was.size(), fmt::format("{} {} became {}", name, was[i], value));
        }
    };
    compare("height", before.heights, after.heights, scale, tolerances.length);
    compare("curvature", before.curvature, after.curvature, 1.0 / scale, tolerances.length);
    compare("position", before.positions, after.positions, scale, tolerances.length);
    compare("occlusion", before.occlusion, after.occlusion, 1.0, tolerances.occlusion);
    compare("bent normal", before.bent_normals, after.bent_normals, 1.0, tolerances.bent);
    compare("thickness", before.thickness, after.thickness, scale, tolerances.thickness);
    const auto others = std::count(differs.begin(), differs.end(), true);
    if (double(others) <= tolerances.others * double(texels)) return "";
    return fmt::format("{} texels, first {}", others, first);
}

/// A scale by powers of two concerns both meshes.
void scale_mesh(Mesh& mesh, float scale) {
    for (glm::vec3& position : mesh.positions)
        position *= scale;
}

/// Bakes a pair with one of its meshes changed.
std::string changed_bake_difference(const BakePair& pair, const MeshChange& change,
                                    bool changes_low, Dice& dice) {
    BakeOptions options = random_options(dice);
    // The automatic distances depend slightly on the order of the low triangles.
    if (changes_low) options.offset = options.max_distance = 0.25;
    // Duplicate triangles are non-manifold: their vertices have no curvature.
    if (change.apply == duplicate_all) options.map.layers.curvature = false;
    const Baked before = baked_of(pair.high, pair.low, options);
    Mesh high = pair.high;
    Mesh low = pair.low;
    MeshVariant variant(changes_low ? low : high);
    change.apply(variant, dice);
    (changes_low ? low : high) = variant.mesh;
    if (changes_low) {
        for (glm::vec2& texcoord : low.texcoords)
            texcoord /= variant.texture_scale;
    }
    scale_mesh(changes_low ? high : low, variant.scale);
    if (options.offset) *options.offset *= double(variant.scale);
    if (options.max_distance) *options.max_distance *= double(variant.scale);
    // One step of floats near 1. Weights on low triangles are floats, too.
    Tolerances tolerances;
    if (variant.has_rotated_corners) tolerances.length = 1.2e-7;
    if (variant.has_rotated_corners) tolerances.bent = tolerances.thickness = 1e-6;
    if (variant.has_rotated_corners && changes_low) {
        tolerances = {.degrees = 0.001,
                      .length = 1e-5,
                      .occlusion = 1.0 / 16.0,
                      .bent = 2.0,
                      .thickness = 4.0 / 16.0,
                      .others = 0.04};
    }
    return map_difference(before, baked_of(high, low, options), double(variant.scale), tolerances);
}

class BakeChanges : public testing::TestWithParam<MeshChange> {};

TEST_P(BakeChanges, OfTheHighMeshLeaveTheMapAlone) {
    std::uint32_t seed = 0;
    for (const BakePair& pair : bake_pairs()) {
        for (int repetition = 0; repetition < 3; ++repetition) {
            Dice dice(++seed);
            if (is_sanitized && repetition > 0) continue;
            EXPECT_EQ(changed_bake_difference(pair, GetParam(), false, dice), "")
                << pair.name << ", seed " << seed;
        }
    }
}

TEST_P(BakeChanges, OfTheLowMeshLeaveTheMapAlone) {
    std::uint32_t seed = 100;
    for (const BakePair& pair : bake_pairs()) {
        for (int repetition = 0; repetition < 3; ++repetition) {
            Dice dice(++seed);
            if (is_sanitized && repetition > 0) continue;
            EXPECT_EQ(changed_bake_difference(pair, GetParam(), true, dice), "")
                << pair.name << ", seed " << seed;
        }
    }
}

TEST_P(BakeChanges, OfTheLowMeshChangeAutomaticDistancesByAtMostATwentieth) {
    std::uint32_t seed = 200;
    for (const BakePair& pair : bake_pairs()) {
        Dice dice(++seed);
        MeshVariant variant(pair.low);
        GetParam().apply(variant, dice);
        Mesh high = pair.high;
        scale_mesh(high, variant.scale);
        const double before = automatic_distances({&pair.high, 1}, pair.low).offset;
        const double after = automatic_distances({&high, 1}, variant.mesh).offset;
        EXPECT_NEAR(after / double(variant.scale), before, 0.05 * before) << pair.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Metamorphic, BakeChanges, testing::ValuesIn(tested_changes),
                         name_of_change);

}  // namespace
}  // namespace relief::test
