// SPDX-License-Identifier: Apache-2.0
// Several maps of one bake: parts of the low mesh, tiles, high parts that only some see.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"
#include "relief/mesh/shapes.h"
#include "support/message_of.h"

namespace relief {
namespace {

using test::bake;
using test::BakedImage;
using test::sized;

BakedImage baked(const Baker& baker, const BakeMapOptions& map) {
    BakedImage image;
    image.result = baker.bake(
        map, [&](const BakedRows& rows) { test::append(image, rows); }, image.report);
    return image;
}

Mesh leaning(Mesh mesh, const glm::vec3& normal, const glm::vec3& by) {
    mesh.normals.assign(mesh.positions.size(), glm::normalize(normal));
    for (glm::vec3& position : mesh.positions)
        position += by;
    return mesh;
}

Mesh joined(Mesh mesh, const Mesh& more) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    mesh.normals.insert(mesh.normals.end(), more.normals.begin(), more.normals.end());
    mesh.texcoords.insert(mesh.texcoords.end(), more.texcoords.begin(), more.texcoords.end());
    for (const glm::uvec3& triangle : more.triangles)
        mesh.triangles.push_back(triangle + first);
    return mesh;
}

/// Two squares beside each other, the second one in the tile to the right.
Mesh two_tiles() {
    Mesh right = leaning(make_quad(), {0, 0, 1}, {2, 0, 0});
    for (glm::vec2& texcoord : right.texcoords)
        texcoord.x += 1.0F;
    return joined(make_quad(), right);
}

TEST(Baker, BakesAsManyMapsAsAreAskedForEachAsAlone) {
    const Mesh low = make_torus();
    const std::vector<Mesh> high = {make_torus(0.43F, 100, 50)};
    BakeOptions options = sized(40, 30);
    options.samples = 4;
    options.padding = 3;
    Report report;
    const Baker baker(high, low, options, report);
    const BakedImage alone = bake(high, low, options);
    EXPECT_EQ(baked(baker, options).normals, alone.normals);
    EXPECT_EQ(baked(baker, sized(64, 64)).normals, bake(high, low, sized(64, 64)).normals);
    EXPECT_EQ(baked(baker, options).heights, alone.heights);
    EXPECT_EQ(baker.distances().offset, alone.result.distances.offset);
}

TEST(Baker, AMapOfSomeTrianglesHasTheirTexelsAsTheWholeMapHasThem) {
    // A hard edge runs between the faces of a cube: rays of one must not know what is left out.
    const Mesh low = make_cube();
    const std::vector<Mesh> high = {make_sphere(64, 32)};
    Report report;
    const Baker baker(high, low, sized(1, 1), report);
    const BakedImage all = baked(baker, sized(48, 48));
    std::size_t texels = 0;
    for (std::uint32_t first = 0; first < low.triangles.size(); first += 2) {
        const std::vector<std::uint32_t> face = {first, first + 1};
        BakeMapOptions map = sized(48, 48);
        map.triangles = face;
        const BakedImage some = baked(baker, map);
        for (std::size_t i = 0; i < some.states.size(); ++i) {
            if (some.states[i] == TexelState::empty) continue;
            if (all.normal(i) == some.normal(i)) ++texels;
        }
        EXPECT_EQ(some.result.coverage.shared, 0U);
    }
    // Those that lie in a face, and none that two of them touch, are the same.
    EXPECT_GE(texels, all.result.coverage.inside);
    const std::vector<std::uint32_t> none;
    BakeMapOptions map = sized(8, 8);
    map.triangles = none;
    EXPECT_EQ(baked(baker, map).count(TexelState::empty), 64U);
}

TEST(Baker, TilesOfOneMeshAreMapsOfTheirOwn) {
    const std::vector<Mesh> high = {leaning(make_quad(), {0.6F, 0, 0.8F}, {0, 0, 0}),
                                    leaning(make_quad(), {0, 0.6F, 0.8F}, {2, 0, 0})};
    const Mesh low = two_tiles();
    Report report;
    const Baker baker(high, low, sized(1, 1), report);
    for (int tile = 0; tile < 2; ++tile) {
        BakeMapOptions map = sized(16, 16);
        map.placement.tile = {tile, 0};
        const BakedImage image = baked(baker, map);
        EXPECT_EQ(image.count(TexelState::baked), 256U);
        const glm::dvec3 expected = tile == 0 ? glm::dvec3(0.6, 0, 0.8) : glm::dvec3(0, 0.6, 0.8);
        EXPECT_LT(degrees_between(image.normal(100), expected), 1e-4);
    }
    BakeMapOptions map = sized(16, 16);
    map.placement.tile = {2, 0};
    EXPECT_EQ(baked(baker, map).count(TexelState::empty), 256U);
}

TEST(Baker, PartsDoNotCatchEachOthersRays) {
    // A square with another one 0.04 above it; each has its own high square.
    const Mesh low = two_tiles();
    const std::vector<Mesh> left = {leaning(make_quad(), {0.6F, 0, 0.8F}, {0, 0, 0.01F})};
    const std::vector<Mesh> right = {leaning(make_quad(), {0, 0.6F, 0.8F}, {2, 0, 0.01F}),
                                     leaning(make_quad(), {0, 0.6F, 0.8F}, {0, 0, 0.04F})};
    const std::vector<Mesh> all = {left[0], right[0], right[1]};
    Report report;
    const Baker together(all, low, sized(1, 1), report);
    EXPECT_LT(degrees_between(baked(together, sized(16, 16)).normal(0), {0, 0.6, 0.8}), 1e-4);
    const std::vector<BakePart> parts = {{left, {0, 1}}, {right, {2, 3}}};
    const Baker baker(parts, low, sized(1, 1), report);
    const BakedImage image = baked(baker, sized(16, 16));
    EXPECT_EQ(image.count(TexelState::baked), 256U);
    for (std::size_t i = 0; i < 256; ++i)
        EXPECT_LT(degrees_between(image.normal(i), {0.6, 0, 0.8}), 1e-4);
    // What is far from the other part does not lengthen its rays: 0.01 apart, not 2 or 0.04.
    EXPECT_NEAR(image.result.greatest_height, 0.01, 1e-7);
    const std::vector<Mesh> far = {leaning(make_quad(), {0, 0.6F, 0.8F}, {2, 0, 5})};
    const std::vector<BakePart> apart = {{left, {0, 1}}, {far, {2, 3}}};
    EXPECT_GT(Baker(apart, low, sized(1, 1), report).distances().offset, 7.0);
}

TEST(Baker, PartsWithoutAnythingHighAreMissed) {
    const std::vector<Mesh> high = {make_quad()};
    const std::vector<BakePart> parts = {{high, {0, 1}}, {{}, {2, 3}}};
    Report report;
    const Baker baker(parts, two_tiles(), sized(1, 1), report);
    BakeMapOptions map = sized(8, 8);
    EXPECT_EQ(baked(baker, map).count(TexelState::baked), 64U);
    map.placement.tile = {1, 0};
    EXPECT_EQ(baked(baker, map).result.texels_missed, 64U);
}

TEST(Baker, EveryTriangleIsInOnePart) {
    const std::vector<Mesh> high = {make_quad()};
    const auto message = [&](const std::vector<BakePart>& parts) {
        return test::message_of<InvalidInput>([&] {
            Report report;
            const Baker baker(parts, make_quad(), sized(1, 1), report);
        });
    };
    EXPECT_EQ(message({{high, {0}}}), "triangle 1 of the low mesh is in no part");
    EXPECT_EQ(message({{high, {0, 1}}, {high, {1}}}), "triangle 1 of the low mesh is in two parts");
    EXPECT_EQ(message({{high, {0, 1, 2}}}), "triangle 2 of the low mesh is not there");
}

TEST(Baker, SaysWhatIsWrongWithAMap) {
    const std::vector<Mesh> high = {make_quad()};
    Report report;
    const Baker baker(high, make_quad(), sized(1, 1), report);
    const auto message = [&](const BakeMapOptions& map) {
        return test::message_of<InvalidInput>([&] { baked(baker, map); });
    };
    BakeMapOptions map = sized(std::numeric_limits<int>::max(), 4);
    map.samples = 64;
    EXPECT_EQ(message(map), "a map of 2147483647 x 4 texels of 64 samples is not within 1 to 8192");
    map = sized(4, 1 << 30);
    map.samples = 16;
    EXPECT_EQ(message(map),
              "a map of 4 x 1073741824 texels of 16 samples is not within 1 to 16384");
    const std::vector<std::uint32_t> beyond = {0, 2}, turned = {1, 0};
    map = sized(4, 4);
    map.triangles = beyond;
    EXPECT_EQ(message(map), "there is no triangle 2 in the low mesh");
    map.triangles = turned;
    EXPECT_EQ(message(map), "the triangles of a map are not in ascending order");
}

TEST(Baker, CountsATexelOfSeveralTrianglesOnceForAllItsSamples) {
    const Mesh twice = joined(make_quad(), make_quad());
    for (const int samples : {1, 4, 16, 64}) {
        BakeOptions options = sized(70, 66);
        options.samples = samples;
        const BakedImage image = bake({make_quad()}, twice, options);
        EXPECT_EQ(image.report.count("texel of several triangles"), 70U * 66U);
        const auto found = image.report.findings();
        const auto shared = std::find_if(found.begin(), found.end(), [](const Finding& finding) {
            return finding.kind == "texel of several triangles";
        });
        EXPECT_EQ(shared->first.back(), 7U);
    }
}

}  // namespace
}  // namespace relief
