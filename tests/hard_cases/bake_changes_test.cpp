// SPDX-License-Identifier: Apache-2.0
// Changes of the high or the low mesh (mesh_changes.h) that must not change a baked map, with
// random options of bakes: of four pairs of meshes, and of each mesh onto itself.
//
// Rotated corners of the low mesh may change last bits: sums over the three corners of a triangle
// begin at its first one, and so does MikkTSpace's gradient.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hard_cases/mesh_changes.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/sanitized.h"

namespace relief::test {
namespace {

struct BakePair {
    std::string name;
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
    for (Mesh* mesh : {&waves, &folded, &needles}) {
        for (const glm::vec3& position : mesh->positions)
            mesh->colors.emplace_back(position.x > 0.25F ? 1.0F : 0.25F, 0.5F, 0.75F, 1.0F);
    }
    return {{"waves", waves, make_quad(2)},
            {"torus", make_torus(0.42F, 40, 20), make_torus(0.4F, 12, 8)},
            {"folded cube", folded, cube},
            {"needles", needles, make_quad()}};
}

struct Baked {
    std::vector<float> normals, heights, occlusion, curvature, positions, bent_normals, thickness;
    std::vector<float> colors, opacity, surface, emission, ids;
    std::vector<TexelState> states;
};

/// The options of a bake. Those that name triangles and vertices are made for each variant.
struct BakeCase {
    BakeOptions options;
    bool has_cage = false;
    bool has_parts = false;   ///< Every other low triangle sees no high mesh.
    bool has_subset = false;  ///< Two thirds of the low triangles are baked.
    bool has_materials = false;
    bool has_normal_map = false;  ///< Of the high material.
};

/// Returns the low mesh, moved outwards.
std::shared_ptr<const Mesh> cage_of(const MeshVariant& low) {
    Mesh cage = low.mesh;
    for (std::size_t v = 0; v < cage.positions.size(); ++v)
        cage.positions[v] += 0.125F * low.scale * cage.normals[v];
    return std::make_shared<const Mesh>(std::move(cage));
}

/// Returns an image of 5 x 4 texels with any codes.
std::shared_ptr<const Image> any_image(std::uint32_t seed) {
    Image image = make_image(5, 4, 3, 8, ColorSpace::linear);
    Dice dice(seed);
    for (std::uint8_t& code : image.as<std::uint8_t>())
        code = static_cast<std::uint8_t>(dice.below(256));
    return std::make_shared<const Image>(std::move(image));
}

HighMaterials materials_of(const Mesh& high, bool has_normal_map) {
    HighMaterial material;
    material.color = glm::vec3(0.75F, 0.5F, 0.25F);
    material.color_texture = SurfaceTexture{any_image(1)};
    material.opacity = 0.5F;
    material.roughness = 0.5F;
    material.surface_texture = SurfaceTexture{any_image(2)};
    material.emission = glm::vec3(2.0F);
    material.emission_texture = SurfaceTexture{any_image(3)};
    if (has_normal_map) material.normal_map = SurfaceNormalMap{SurfaceTexture{any_image(4)}};
    HighMaterials all;
    all.mesh = &high;
    all.otherwise = material;
    return all;
}

std::uint32_t original_triangle(const MeshVariant& variant, std::size_t triangle) {
    return variant.original[3 * triangle] / 3;
}

/// Names the triangles by the original ones.
HighIds ids_of(const MeshVariant& high) {
    HighIds ids;
    ids.mesh = &high.mesh;
    for (std::size_t t = 0; t < high.mesh.triangles.size(); ++t) {
        const char* const name = original_triangle(high, t) % 4 == 0 ? "fourth" : "other";
        ids.triangles.push_back({static_cast<std::uint32_t>(t), name});
    }
    return ids;
}

/// Returns the triangles of a variant with a remainder of the original's index by 3 or 2.
std::vector<std::uint32_t> triangles_with(const MeshVariant& variant, std::uint32_t divisor,
                                          std::uint32_t remainder, bool has_it) {
    std::vector<std::uint32_t> selected;
    for (std::size_t t = 0; t < variant.mesh.triangles.size(); ++t) {
        if ((original_triangle(variant, t) % divisor == remainder) == has_it)
            selected.push_back(static_cast<std::uint32_t>(t));
    }
    return selected;
}

Baked baked_of(const MeshVariant& high, const MeshVariant& low, const BakeCase& bake) {
    BakeOptions options = bake.options;
    const auto scale = double(low.scale);
    if (options.offset) *options.offset *= scale;
    if (options.max_distance) *options.max_distance *= scale;
    for (auto* rays : {&options.map.layers.occlusion, &options.map.layers.bent_normals}) {
        if (*rays && (*rays)->distance) *(*rays)->distance *= scale;
    }
    if (bake.has_cage) options.cage = cage_of(low);
    if (bake.has_materials)
        options.materials.push_back(materials_of(high.mesh, bake.has_normal_map));
    if (options.map.layers.ids) options.ids.push_back(ids_of(high));
    if (bake.has_subset) options.map.triangles = triangles_with(low, 3, 1, false);
    const std::span<const Mesh> all_high(&high.mesh, 1);
    std::vector<BakePart> parts{{all_high, triangles_with(low, 2, 0, true)},
                                {{}, triangles_with(low, 2, 0, false)}};
    const Baker baker =
        bake.has_parts ? Baker(parts, low.mesh, options) : Baker(all_high, low.mesh, options);
    Baked map;
    const auto append = [](auto& all, const auto& rows) {
        all.insert(all.end(), rows.begin(), rows.end());
    };
    baker.bake(options.map, [&](const BakedRows& rows) {
        append(map.normals, rows.normals);
        append(map.heights, rows.heights);
        append(map.occlusion, rows.occlusion);
        append(map.curvature, rows.curvature);
        append(map.positions, rows.positions);
        append(map.bent_normals, rows.bent_normals);
        append(map.thickness, rows.thickness);
        append(map.colors, rows.colors);
        append(map.opacity, rows.opacity);
        append(map.surface, rows.surface);
        append(map.emission, rows.emission);
        append(map.ids, rows.ids);
        append(map.states, rows.states);
    });
    return map;
}

BakeLayers random_layers(Dice& dice) {
    BakeLayers layers;
    layers.heights = true;
    layers.curvature = dice.one_in(2);
    layers.positions = dice.one_in(2);
    if (layers.positions)
        layers.position_from_mesh = glm::dmat4(glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 2));
    OcclusionOptions rays{16, {}};
    if (dice.one_in(3)) rays.distance = 0.5;
    if (dice.one_in(2)) layers.occlusion = rays;
    if (dice.one_in(2)) layers.bent_normals = rays;
    if (dice.one_in(2)) layers.thickness = ThicknessOptions{16, {}};
    layers.colors = dice.one_in(2);
    layers.opacity = layers.colors && dice.one_in(2);
    layers.surface = dice.one_in(3);
    layers.emission = dice.one_in(3);
    layers.ids = dice.one_in(3);
    return layers;
}

BakeCase random_bake(Dice& dice) {
    BakeCase bake;
    BakeOptions& options = bake.options;
    options.map.width = static_cast<int>(8 + dice.below(20));
    options.map.height = static_cast<int>(8 + dice.below(20));
    options.map.samples = dice.one_in(3) ? 4 : 1;
    if (options.map.samples > 1 && dice.one_in(2)) options.map.sample_angle = 0.05;
    options.map.padding = static_cast<int>(dice.below(4));
    options.map.placement.repeat = dice.one_in(3);
    options.map.measures_missed = dice.one_in(4);
    options.map.layers = random_layers(dice);
    options.space = enum_names<VectorSpace>[dice.below(enum_names<VectorSpace>.size())].value;
    if (options.space != VectorSpace::tangent && dice.one_in(2))
        options.output_from_mesh = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
    options.directions = enum_names<RayDirections>[dice.below(3)].value;
    if (options.directions == RayDirections::averaged) options.hardness = 0.25 * dice.below(5);
    options.back_faces = dice.one_in(3) ? BackFaces::take : BackFaces::skip;
    options.allow_size_mismatch = true;
    options.map_count = dice.one_in(3) ? 100 : 1;
    bake.has_parts = dice.one_in(4);
    options.parts_occlude = bake.has_parts && dice.one_in(2);
    bake.has_cage = dice.one_in(4);
    bake.has_subset = dice.one_in(4);
    bake.has_materials = dice.one_in(2);
    bake.has_normal_map = bake.has_materials && dice.one_in(2);
    if (dice.one_in(2)) options.offset = options.max_distance = 0.25;
    if (bake.has_cage) options.offset = std::nullopt;
    return bake;
}

/// Limits of differences. By default, maps are equal.
struct Tolerances {
    double degrees = 0.0;
    double length = 0.0;     ///< Of heights, curvatures and positions.
    double occlusion = 0.0;  ///< Of the share of rays.
    /// The largest difference of a component of bent normals. If few of 16 rays are open, one ray
    /// more can turn the mean by any angle.
    double bent = 0.0;
    double thickness = 0.0;
    double color = 0.0;  ///< Of all values of materials.
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
    constexpr float largest = std::numeric_limits<float>::max();
    const auto compare = [&](const char* name, const std::vector<float>& was,
                             const std::vector<float>& is, double factor, double limit) {
        for (std::size_t i = 0; i < was.size(); ++i) {
            const double value = double(is[i]) / factor;
            if (double(was[i]) == value || std::abs(double(was[i]) - value) <= limit) continue;
            // The largest float stands for any larger value.
            if (std::max(std::abs(was[i]), std::abs(is[i])) == largest) continue;
            add(i * texels / was.size(), fmt::format("{} {} became {}", name, was[i], value));
        }
    };
    compare("height", before.heights, after.heights, scale, tolerances.length);
    compare("curvature", before.curvature, after.curvature, 1.0 / scale, tolerances.length);
    compare("position", before.positions, after.positions, scale, tolerances.length);
    compare("occlusion", before.occlusion, after.occlusion, 1.0, tolerances.occlusion);
    compare("bent normal", before.bent_normals, after.bent_normals, 1.0, tolerances.bent);
    compare("thickness", before.thickness, after.thickness, scale, tolerances.thickness);
    compare("color", before.colors, after.colors, 1.0, tolerances.color);
    compare("opacity", before.opacity, after.opacity, 1.0, tolerances.color);
    compare("surface", before.surface, after.surface, 1.0, tolerances.color);
    compare("emission", before.emission, after.emission, 1.0, tolerances.color);
    compare("id", before.ids, after.ids, 1.0, 0.0);
    const auto others = std::count(differs.begin(), differs.end(), true);
    if (double(others) <= tolerances.others * double(texels)) return "";
    return fmt::format("{} texels, first {}", others, first);
}

/// Returns the mesh at a scale by a power of two, which concerns both meshes.
MeshVariant scaled(const Mesh& mesh, float scale) {
    MeshVariant variant(mesh);
    for (glm::vec3& position : variant.mesh.positions)
        position *= scale;
    variant.scale = scale;
    return variant;
}

/// Applies a change to one mesh of a pair. Maps show texture coordinates that are not scaled.
std::pair<MeshVariant, MeshVariant> changed_pair(const BakePair& pair, const MeshChange& change,
                                                 bool changes_low, Dice& dice) {
    MeshVariant variant(changes_low ? pair.low : pair.high);
    change.apply(variant, dice);
    for (glm::vec2& texcoord : variant.mesh.texcoords)
        texcoord /= variant.texture_scale;
    MeshVariant other = scaled(changes_low ? pair.high : pair.low, variant.scale);
    if (changes_low) return {std::move(other), std::move(variant)};
    return {std::move(variant), std::move(other)};
}

Tolerances tolerances_of(const MeshVariant& changed, bool changes_low, const BakeCase& bake) {
    if (!changes_low || !changed.has_rotated_corners) {
        Tolerances tolerances;
        // Smaller floats have fewer digits.
        const auto scale = double(std::max(changed.scale, 1.0F / changed.scale));
        tolerances.length = tolerances.thickness =
            scale * double(std::numeric_limits<float>::min());
        if (changed.has_rotated_corners && bake.has_normal_map)
            tolerances.degrees = 0.001;  // MikkTSpace on the high mesh.
        return tolerances;
    }
    return {.degrees = 0.001,
            .length = 1e-5,
            .occlusion = 1.0 / 16.0,
            .bent = 2.0,
            .thickness = 4.0 / 16.0,
            .color = 1e-4,
            .others = 0.04};
}

/// Bakes a pair with one of its meshes changed.
std::string changed_bake_difference(const BakePair& pair, const MeshChange& change,
                                    bool changes_low, Dice& dice) {
    BakeCase bake = random_bake(dice);
    BakeOptions& options = bake.options;
    // The automatic distances depend slightly on the order of the low triangles.
    if (changes_low) options.max_distance = 0.25;
    if (changes_low && !bake.has_cage) options.offset = 0.25;
    // Duplicate triangles are non-manifold: their vertices have no curvature.
    if (change.apply == duplicate_all) options.map.layers.curvature = false;
    const Baked before = baked_of(MeshVariant(pair.high), MeshVariant(pair.low), bake);
    const auto [high, low] = changed_pair(pair, change, changes_low, dice);
    return map_difference(before, baked_of(high, low, bake), double(low.scale),
                          tolerances_of(changes_low ? low : high, changes_low, bake));
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
        const auto [high, low] = changed_pair(pair, GetParam(), true, dice);
        const double before = automatic_distances({&pair.high, 1}, pair.low).offset;
        const double after = automatic_distances({&high.mesh, 1}, low.mesh).offset;
        EXPECT_NEAR(after / double(low.scale), before, 0.05 * before) << pair.name;
    }
}

/// Returns the mesh with separate triangles, each in its own cell of the texture.
Mesh in_cells(const Mesh& mesh) {
    Mesh result;
    result.smoothing_groups = mesh.smoothing_groups;
    std::uint32_t side = 1;
    while (std::size_t{side} * side < mesh.triangles.size())
        ++side;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::vec2 cell(t % side, t / side);
        constexpr glm::vec2 corners[] = {{0.125F, 0.125F}, {0.125F, 0.875F}, {0.875F, 0.125F}};
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[t][k];
            result.positions.push_back(mesh.positions[vertex]);
            result.normals.push_back(mesh.normals[vertex]);
            result.tangents.push_back(mesh.tangents[vertex]);
            result.texcoords.push_back((cell + corners[k]) / static_cast<float>(side));
        }
        result.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
    return result;
}

/// Bakes every `step`-th mesh onto itself, and changes one of both. If the low mesh changes,
/// texels do not have several triangles. Meshes that cannot be baked are left out.
void expect_same_bakes(const MeshChange& change, bool changes_low, std::size_t step) {
    const std::vector<NamedMesh>& meshes = metamorphic_meshes();
    std::size_t baked = 0;
    std::size_t refused = 0;
    for (std::size_t m = 0; m < meshes.size(); m += step) {
        Dice dice(static_cast<std::uint32_t>(m));
        try {
            const Mesh& mesh = meshes[m].mesh;
            const BakePair pair{meshes[m].name, mesh, changes_low ? in_cells(mesh) : mesh};
            EXPECT_EQ(changed_bake_difference(pair, change, changes_low, dice), "")
                << meshes[m].name;
            ++baked;
        } catch (const InvalidInput&) {
            ++refused;
        }
    }
    EXPECT_GT(baked, refused);
}

TEST_P(BakeChanges, OfAnyHighMeshLeaveTheMapAlone) {
    expect_same_bakes(GetParam(), false, is_sanitized ? 50 : 10);
}

class BakeHighMeshSweep : public testing::TestWithParam<MeshChange> {};

TEST_LABELS(slow, sweep);
TEST_P(BakeHighMeshSweep, LeavesTheMapAlone) {
    expect_same_bakes(GetParam(), false, 1);
}

// Where surfaces coincide or are needles, the rounding that rotated corners of the low mesh change
// decides which of them a ray hits.
constexpr MeshChange changes_of_any_low_mesh[] = {{"OrderOfTriangles", reorder_triangles},
                                                  {"OrderOfVertices", reorder_vertices},
                                                  {"CollapsedTriangles", add_collapsed},
                                                  {"PowersOfTwo", scale_by_power_of_two},
                                                  {"EachTriangleTwice", duplicate_all}};

class BakeLowMeshSweep : public testing::TestWithParam<MeshChange> {};

TEST_LABELS(slow, sweep);
TEST_P(BakeLowMeshSweep, LeavesTheMapAlone) {
    expect_same_bakes(GetParam(), true, 1);
}

INSTANTIATE_TEST_SUITE_P(Metamorphic, BakeChanges, testing::ValuesIn(tested_changes),
                         name_of_change);
INSTANTIATE_TEST_SUITE_P(Metamorphic, BakeHighMeshSweep, testing::ValuesIn(mesh_changes),
                         name_of_change);
INSTANTIATE_TEST_SUITE_P(Metamorphic, BakeLowMeshSweep, testing::ValuesIn(changes_of_any_low_mesh),
                         name_of_change);

}  // namespace
}  // namespace relief::test
