// SPDX-License-Identifier: Apache-2.0
// The convention of a normal map: maps altered in every known way are identified, and maps are
// converted between tangent and object space.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "mesh/bake/bake_support.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/tangents.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::accuracy;

namespace {

using test::sized;

constexpr int map_width = 96;
constexpr int map_height = 96;

/// A torus with a nonuniform image that is mirrored on its right half.
Mesh torus(int slices, int sides) {
    const Mesh even = make_torus(0.4F, slices, sides);
    Mesh mesh;
    for (const glm::uvec3& triangle : even.triangles) {
        const float middle = (even.texcoords[triangle.x].x + even.texcoords[triangle.y].x +
                              even.texcoords[triangle.z].x) /
                             3.0F;
        for (int i = 0; i < 3; ++i) {
            glm::vec2 uv = even.texcoords[triangle[i]];
            const float x = uv.x;
            uv.x += 0.25F / static_cast<float>(slices) * std::sin(40.0F * uv.y) *
                    std::sin(12.566371F * x);
            uv.y += 0.25F / static_cast<float>(sides) * std::sin(100.0F * x) *
                    std::sin(6.2831853F * uv.y);
            if (middle > 0.5F) uv.x = 1.5F - uv.x;
            mesh.positions.push_back(even.positions[triangle[i]]);
            mesh.normals.push_back(even.normals[triangle[i]]);
            mesh.texcoords.push_back(uv);
        }
        const auto end = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.triangles.emplace_back(end - 3, end - 2, end - 1);
    }
    return mesh;
}

Mesh bumpy(Mesh mesh, double bumps) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 p = mesh.positions[i];
        mesh.positions[i] +=
            mesh.normals[i] *
            static_cast<float>(0.2 / bumps * std::sin(bumps * p.x) *
                               std::cos(0.7 * bumps * p.y + 0.3) * std::sin(1.3 * bumps * p.z));
    }
    mesh.normals.clear();
    mesh.texcoords.clear();
    return mesh;
}

struct Pair {
    Mesh high, low;
    Pair() {
        Report report;
        high = bumpy(make_torus(0.4F, 200, 100), 9.0);
        low = with_frames(torus(24, 12), {.tangents = TangentMethod::mikktspace}, report).mesh;
    }
};

const Pair& pair() {
    static const Pair made;
    return made;
}

BakeOptions options_of(VectorSpace space = VectorSpace::tangent) {
    BakeOptions options = sized(map_width, map_height);
    options.space = space;
    return options;
}

Image baked(const Mesh& high, const Mesh& low, const BakeOptions& options) {
    Image image = make_image(map_width, map_height, 3, 32, ColorSpace::data);
    const auto normals = test::bake({high}, low, options).normals;
    std::copy(normals.begin(), normals.end(), image.as<float>().begin());
    return image;
}

Image encoded(const Image& normals, const NormalMapFormat& format = {.bits = 16}) {
    Report report;
    return encode_normal_map(normals, format, report);
}

ConventionFit fit(const Image& map, VectorSpace space = VectorSpace::tangent,
                  const Mesh& low = pair().low) {
    Report report;
    const Baker baker(std::span(&pair().high, 1), low, options_of(space), report);
    BakeCheckOptions check;
    check.map = baker.options().map;
    check.given = &low;
    return check_bake(baker, map, check, {}, report).convention;
}

/// Applies `change` to each vector of a map of normals, with its position.
Image changed(Image normals, const std::function<glm::vec3(glm::vec3)>& change) {
    const auto samples = normals.as<float>();
    for (std::size_t i = 0; i < samples.size(); i += 3) {
        const glm::vec3 n = change({samples[i], samples[i + 1], samples[i + 2]});
        for (int axis = 0; axis < 3; ++axis)
            samples[i + static_cast<std::size_t>(axis)] = n[axis];
    }
    return normals;
}

const Image& tangent_normals() {
    static const Image normals = baked(pair().high, pair().low, options_of());
    return normals;
}

void expect_explained(const ConventionFit& found, const std::vector<ConventionPart>& changes) {
    EXPECT_TRUE(found.was_searched);
    EXPECT_TRUE(found.is_explained)
        << found.given_degrees << " to " << found.best_degrees << " degrees";
    EXPECT_EQ(found.changes, changes);
    EXPECT_LT(found.best_degrees, 1.5 * found.expected_degrees + 0.02);
}

TEST(MapConvention, RecognizesItsOwnBakes) {
    for (const int bits : {8, 16, 32}) {
        const ConventionFit found = fit(encoded(tangent_normals(), {.bits = bits}));
        EXPECT_FALSE(found.was_searched) << bits;
        EXPECT_EQ(found.tried, 1U);
        EXPECT_TRUE(found.changes.empty());
        EXPECT_NEAR(found.given_degrees, found.expected_degrees, 1e-4);
    }
    const Image object = baked(pair().high, pair().low, options_of(VectorSpace::object));
    EXPECT_FALSE(fit(encoded(object), VectorSpace::object).was_searched);
}

TEST_LABELS(not_sanitized);
TEST(MapConvention, RecognizesRotatedAxes) {
    const SignedAxis x{0, false}, y{1, false}, z{2, false}, minus_x{0, true}, minus_y{1, true};
    const auto axes_of = [](const std::function<glm::vec3(glm::vec3)>& change) {
        const ConventionFit found = fit(encoded(changed(tangent_normals(), change)));
        expect_explained(found, {ConventionPart::axes});
        return found.convention.axes;
    };
    EXPECT_EQ(axes_of([](glm::vec3 n) { return glm::vec3(n.x, -n.y, n.z); }),
              (AxisMapping{x, minus_y, z}));
    EXPECT_EQ(axes_of([](glm::vec3 n) { return glm::vec3(-n.x, n.y, n.z); }),
              (AxisMapping{minus_x, y, z}));
    EXPECT_EQ(axes_of([](glm::vec3 n) { return glm::vec3(-n.x, -n.y, n.z); }),
              (AxisMapping{minus_x, minus_y, z}));
    EXPECT_EQ(axes_of([](glm::vec3 n) { return glm::vec3(n.y, n.x, n.z); }),
              (AxisMapping{y, x, z}));
    EXPECT_EQ(axes_of([](glm::vec3 n) { return glm::vec3(-n.y, n.x, n.z); }),
              (AxisMapping{y, minus_x, z}));
}

TEST_LABELS(not_sanitized);
TEST(MapConvention, SpacesAreRecognised) {
    const Image object = baked(pair().high, pair().low, options_of(VectorSpace::object));
    const ConventionFit told_tangent = fit(encoded(object));
    expect_explained(told_tangent, {ConventionPart::space});
    EXPECT_EQ(told_tangent.convention.space, VectorSpace::object);
    const ConventionFit told_object = fit(encoded(tangent_normals()), VectorSpace::object);
    expect_explained(told_object, {ConventionPart::space});
    EXPECT_EQ(told_object.convention.space, VectorSpace::tangent);
    // Another up axis: y becomes z, z becomes -y.
    const Image z_up = changed(object, [](glm::vec3 n) { return glm::vec3(n.x, -n.z, n.y); });
    const ConventionFit turned = fit(encoded(z_up), VectorSpace::object);
    expect_explained(turned, {ConventionPart::axes});
    EXPECT_EQ(turned.convention.axes, (AxisMapping{{{0, false}, {2, false}, {1, true}}}));
    expect_explained(fit(encoded(z_up)), {ConventionPart::axes, ConventionPart::space});
}

TEST(MapConvention, CurvesAreRecognised) {
    Image bright = encoded(tangent_normals());
    for (std::uint16_t& code : bright.as<std::uint16_t>()) {
        code = static_cast<std::uint16_t>(
            std::lround(65535.0F * srgb_from_linear(static_cast<float>(code) / 65535.0F)));
    }
    const ConventionFit found = fit(bright);
    expect_explained(found, {ConventionPart::curve});
    EXPECT_EQ(found.convention.curve, StoredCurve::srgb_encoded);
}

TEST_LABELS(not_sanitized);
TEST(MapConvention, RecognizesFlippedImages) {
    Image turned = tangent_normals();
    const auto from = tangent_normals().as<float>();
    for (std::size_t y = 0; y < map_height; ++y) {
        std::copy_n(&from[(map_height - 1 - y) * map_width * 3], map_width * 3,
                    &turned.as<float>()[y * map_width * 3]);
    }
    const ConventionFit found = fit(encoded(turned));
    expect_explained(found, {ConventionPart::turn});
    EXPECT_EQ(found.convention.turn, ImageOrientation::upside_down);
    const Image down = changed(turned, [](glm::vec3 n) { return glm::vec3(n.x, -n.y, n.z); });
    expect_explained(fit(encoded(down)), {ConventionPart::turn, ConventionPart::axes});
}

/// The low mesh with other tangents.
Mesh low_by(TangentMethod mode) {
    Report report;
    return with_frames(pair().low, {.tangents = mode}, report).mesh;
}

TEST_LABELS(not_sanitized);
TEST(MapConvention, BasesOfTangentsAreRecognised) {
    const auto basis_of = [](TangentMethod mode) {
        const ConventionFit found = fit(encoded(baked(pair().high, low_by(mode), options_of())));
        expect_explained(found, {ConventionPart::basis});
        return found.convention.basis;
    };
    EXPECT_EQ(basis_of(TangentMethod::area_weighted), TangentMethod::area_weighted);
    EXPECT_EQ(basis_of(TangentMethod::lengyel), TangentMethod::lengyel);
    // The model has other tangents, and the map was baked with those of MikkTSpace.
    const ConventionFit found =
        fit(encoded(tangent_normals()), VectorSpace::tangent, low_by(TangentMethod::area_weighted));
    expect_explained(found, {ConventionPart::basis});
    EXPECT_EQ(found.convention.basis, TangentMethod::mikktspace);
}

/// Returns the components of the exact normals in a frame that another baker uses.
Image baked_by(const std::function<glm::dmat3(glm::dvec3 n, glm::dvec4 t, glm::dvec3 b)>& frame) {
    const Image object = baked(pair().high, pair().low, options_of(VectorSpace::object));
    Image result = object;
    const Mesh& low = pair().low;
    Report report;
    cover_texels(
        low.texcoords, low.triangles, {.width = map_width, .height = map_height},
        [&](int first_row, std::span<const CoveredTexel> texels) {
            for (std::size_t i = 0; i < texels.size(); ++i) {
                if (!texels[i].is_covered()) continue;
                glm::dvec3 n(0.0), b(0.0);
                glm::dvec4 t(0.0);
                for (int corner = 0; corner < 3; ++corner) {
                    const auto vertex = low.triangles[texels[i].triangle][corner];
                    const double weight = texels[i].weights()[corner];
                    const glm::dvec3 vertex_n(low.normals[vertex]);
                    const glm::dvec4 vertex_t(low.tangents[vertex]);
                    n += weight * vertex_n;
                    t += weight * vertex_t;
                    b += weight * vertex_t.w * glm::cross(vertex_n, glm::dvec3(vertex_t));
                }
                const std::size_t at = 3 * (static_cast<std::size_t>(first_row) * map_width + i);
                const auto from = object.as<float>();
                const glm::dvec3 components =
                    glm::normalize(glm::inverse(frame(n, t, b)) *
                                   glm::dvec3(from[at], from[at + 1], from[at + 2]));
                for (int axis = 0; axis < 3; ++axis)
                    result.as<float>()[at + static_cast<std::size_t>(axis)] =
                        static_cast<float>(components[axis]);
            }
        },
        report);
    return result;
}

TEST_LABELS(not_sanitized);
TEST(MapConvention, FramesOfOtherShadersAreRecognised) {
    const ConventionFit unit = fit(encoded(baked_by([](glm::dvec3 n, glm::dvec4 t, glm::dvec3) {
        const glm::dvec3 unit_n = glm::normalize(n), unit_t = glm::normalize(glm::dvec3(t));
        return glm::dmat3(unit_t, t.w * glm::cross(unit_n, unit_t), unit_n);
    })));
    expect_explained(unit, {ConventionPart::frame});
    EXPECT_EQ(unit.convention.frame, FrameInterpolation::unit);
    const ConventionFit mirrored = fit(encoded(baked_by([](glm::dvec3 n, glm::dvec4 t, glm::dvec3) {
        return glm::dmat3(glm::dvec3(t), glm::cross(n, glm::dvec3(t)), n);
    })));
    expect_explained(mirrored, {ConventionPart::mirroring});
    EXPECT_TRUE(mirrored.convention.ignores_mirroring);
}

TEST(MapConvention, AMapOfAnotherModelIsExplainedByNone) {
    const Mesh other = bumpy(make_torus(0.4F, 400, 200), 14.0);
    const ConventionFit found = fit(encoded(baked(other, pair().low, options_of())));
    EXPECT_TRUE(found.was_searched);
    EXPECT_FALSE(found.is_explained);
    EXPECT_GT(found.best_degrees, 5.0);
    EXPECT_GT(found.tried, 100U);
}

Image flat_map(int width, int height) {
    Image normals = make_image(width, height, 3, 32, ColorSpace::data);
    for (std::size_t i = 2; i < normals.sample_count(); i += 3)
        normals.as<float>()[i] = 1.0F;
    return normals;
}

Image hills(int width, int height) {
    Report report;
    return normals_from_height(
        wave_heights(width, height, tiling_waves(width, height, 8, 8.0, 0.5, 3)).heights,
        {Kernel::central3, Wrap::repeat, 1.0}, report);
}

glm::dvec3 at(const Image& normals, std::size_t texel) {
    const std::span<const float> n = normals.as<float>();
    return {n[texel * 3], n[texel * 3 + 1], n[texel * 3 + 2]};
}

/// Returns the outward direction on a sphere at a texel center; shapes.h defines u and v.
glm::dvec3 outward(int column, int row, int width, int height) {
    const double longitude = 2.0 * std::numbers::pi * (column + 0.5) / width;
    const double polar = std::numbers::pi * (row + 0.5) / height;
    return {std::sin(longitude) * std::sin(polar), std::cos(polar),
            std::cos(longitude) * std::sin(polar)};
}

TEST(NormalSpace, MakesOfAFlatMapTheNormalsOfASphere) {
    // Facets have 5.6 and 2.8 degrees. The poles are omitted, because their texture differs from
    // their shape.
    const auto largest_error = [](int slices) {
        Report report;
        const ConvertedNormals object = object_from_tangent(
            flat_map(512, 256), test::with_tangents(make_sphere(slices, slices / 2)), {}, report);
        EXPECT_TRUE(report.empty());
        EXPECT_EQ(object.coverage.inside, 512U * 256U);
        double largest = 0.0;
        for (int row = 64; row < 192; ++row) {
            for (int column = 0; column < 512; ++column) {
                const auto texel = static_cast<std::size_t>(row * 512 + column);
                largest = std::max(largest, degrees_between(at(object.normals, texel),
                                                            outward(column, row, 512, 256)));
            }
        }
        return largest;
    };
    const double coarse = largest_error(64);
    EXPECT_LT(coarse, 0.1);
    // Linear interpolation has second order.
    EXPECT_NEAR(coarse / largest_error(128), 4.0, 0.3);
}

TEST(NormalSpace, ThereAndBackIsTheSameMap) {
    for (const Mesh& mesh :
         {test::with_tangents(make_sphere(24, 12)), test::with_tangents(make_torus()),
          test::with_tangents(make_quad()), test::with_tangents(make_cube())}) {
        const Image map = hills(200, 96);
        Report report;
        const ConvertedNormals object = object_from_tangent(map, mesh, {}, report);
        const ConvertedNormals back = tangent_from_object(object.normals, mesh, {}, report);
        EXPECT_EQ(report.count("texel without a frame"), 0U);
        EXPECT_EQ(report.count("normal behind the surface"), 0U);
        double worst = 0.0;
        for (std::size_t texel = 0; texel < 200UL * 96UL; ++texel)
            worst = std::max(worst, degrees_between(at(back.normals, texel), at(map, texel)));
        // 16-bit codes of a normal are 0.003 degrees apart.
        EXPECT_LT(worst, 1e-4);
    }
}

TEST(NormalSpace, TurnsAQuadsMapByItsOwnAxes) {
    // The upright image on the square in the xy plane: object space is tangent space.
    const Image map = hills(64, 64);
    Report report;
    const Mesh quad = test::with_tangents(make_quad());
    const ConvertedNormals object = object_from_tangent(map, quad, {}, report);
    for (std::size_t texel = 0; texel < 64UL * 64UL; ++texel)
        EXPECT_LT(degrees_between(at(object.normals, texel), at(map, texel)), 1e-5);
    // With a mirrored image, x is reversed.
    Mesh mirrored = make_quad();
    for (glm::vec2& texcoord : mirrored.texcoords)
        texcoord.x = 1.0F - texcoord.x;
    const ConvertedNormals other =
        object_from_tangent(map, test::with_tangents(mirrored), {}, report);
    for (std::size_t texel = 0; texel < 64UL * 64UL; ++texel) {
        const glm::dvec3 n = at(map, texel);
        EXPECT_LT(degrees_between(at(other.normals, texel), {-n.x, n.y, n.z}), 1e-5);
    }
    EXPECT_TRUE(report.empty());
}

TEST(NormalSpace, CountsTexelsWithoutMeshFrameOrNormal) {
    Mesh quad = test::with_tangents(make_quad());
    for (glm::vec2& texcoord : quad.texcoords)
        texcoord *= 0.5F;
    Image map = flat_map(16, 16);
    map.as<float>()[17 * 3 + 2] = 0.0F;
    Report report;
    const ConvertedNormals object = object_from_tangent(map, quad, {}, report);
    EXPECT_EQ(object.coverage.empty, 256U - 64U);
    EXPECT_EQ(report.count("normal without direction"), 1U);
    EXPECT_EQ(at(object.normals, 255), glm::dvec3(0, 0, 1));
    for (glm::vec4& tangent : quad.tangents)
        tangent = glm::vec4(0, 0, 1, 1);
    Report other;
    tangent_from_object(map, quad, {}, other);
    EXPECT_EQ(other.count("texel without a frame"), 64U);
    // A map of another mesh, which faces the opposite direction.
    for (std::size_t i = 2; i < map.sample_count(); i += 3)
        map.as<float>()[i] = -1.0F;
    Report behind;
    tangent_from_object(map, test::with_tangents(make_quad()), {}, behind);
    EXPECT_EQ(behind.count("normal behind the surface"), 256U);
}

TEST(NormalSpace, IsTheSameForAnyNumberOfThreads) {
    const Mesh sphere = test::with_tangents(make_sphere(24, 12));
    Report one_report, many_report;
    set_thread_limit(1);
    const ConvertedNormals one = object_from_tangent(hills(150, 300), sphere, {}, one_report);
    set_thread_limit(0);
    const ConvertedNormals many = object_from_tangent(hills(150, 300), sphere, {}, many_report);
    EXPECT_TRUE(std::ranges::equal(one.normals.as<float>(), many.normals.as<float>()));
    EXPECT_TRUE(std::ranges::equal(one_report.findings(), many_report.findings()));
}

TEST(NormalSpace, RefusesMeshesWithoutFrames) {
    Report report;
    const auto message = [&](const Image& map, const Mesh& mesh) {
        return test::message_of<InvalidInput>([&] { object_from_tangent(map, mesh, {}, report); });
    };
    EXPECT_EQ(message(Image{}, make_quad()), "the normal map is empty");
    EXPECT_EQ(message(flat_map(4, 4), make_quad()), "the mesh has no tangents");
    Mesh bare = test::with_tangents(make_quad());
    bare.texcoords.clear();
    EXPECT_EQ(message(flat_map(4, 4), bare), "the mesh has no texture coordinates");
}

}  // namespace
}  // namespace relief
