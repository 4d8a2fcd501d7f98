// SPDX-License-Identifier: Apache-2.0
// Ids: their colors, the id of a texel at a border of materials, in the padding, and for any order
// of the triangles.
#include "relief/mesh/bake_ids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "support/invariants.h"

namespace relief {
namespace {

using test::bake;
using test::BakedImage;
using test::moved;
using test::sized;

int difference(const SurfaceId& a, const SurfaceId& b) {
    int largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max(largest, std::abs(a.color[i] - b.color[i]));
    return largest;
}

TEST(SurfaceIds, AreSortedAndUnique) {
    const auto ids = surface_ids({"wood", "Metal", "wood", "", "metal"});
    ASSERT_EQ(ids.size(), 4U);
    EXPECT_EQ(ids[0].name, "");
    EXPECT_EQ(ids[1].name, "Metal");
    EXPECT_EQ(ids[2].name, "metal");
    EXPECT_EQ(ids[3].name, "wood");
    EXPECT_EQ(surface_ids({"metal", "", "wood", "Metal"}), ids);
    EXPECT_TRUE(surface_ids({}).empty());
}

TEST(SurfaceIds, KeepTheColorsOfTheirNames) {
    // Files of several versions must agree.
    EXPECT_EQ(color_text(surface_ids({"metal"})[0]), "#e7a942");
    EXPECT_EQ(color_text(surface_ids({"material-0"})[0]), "#8b1851");
    const auto all = surface_ids({"body", "glass", "leather", "metal", "wood"});
    for (const SurfaceId& id : all)
        EXPECT_EQ(id, surface_ids({id.name})[0]) << id.name;
}

TEST(SurfaceIds, HaveDistinctColorsThatAreNotBlack) {
    std::vector<std::string> names;
    for (int i = 0; i < 24; ++i)
        names.push_back("part " + std::to_string(i));
    const auto few = surface_ids(names);
    for (std::size_t i = 0; i < few.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GE(difference(few[i], few[j]), 32) << i << " " << j;
    }
    for (int i = 24; i < 5000; ++i)
        names.push_back("part " + std::to_string(i));
    std::set<std::string> colors;
    for (const SurfaceId& id : surface_ids(names)) {
        colors.insert(color_text(id));
        EXPECT_GE(std::max({id.color.r, id.color.g, id.color.b}), 64);
    }
    EXPECT_EQ(colors.size(), 5000U);
    for (int i = 5000; i < 65537; ++i)
        names.push_back("part " + std::to_string(i));
    EXPECT_EQ(test::message_of<InvalidInput>([&] { surface_ids(names); }),
              "there are 65537 ids, but at most 65536 are possible");
}

TEST(SurfaceIds, AreNamedByMaterial) {
    Mesh mesh = make_quad(2);
    using Names = std::vector<NamedTriangles>;
    EXPECT_EQ(names_by_material(mesh, {}), (Names{{0, "no-material"}}));
    EXPECT_EQ(names_by_material(mesh, {}, "crate"), (Names{{0, "crate"}}));
    mesh.material_ranges = {{0, 2, 1}, {2, 0, 0}, {2, 3, std::nullopt}, {5, 3, 2}};
    const std::vector<std::string> names = {"a", "b", ""};
    EXPECT_EQ(names_by_material(mesh, names, "crate"),
              (Names{{0, "b"}, {2, "crate"}, {5, "material-2"}}));
    const std::vector<std::string> repeated = {"a", "b", "b"};
    EXPECT_EQ(names_by_material(mesh, repeated), (Names{{0, "b"}, {2, "no-material"}, {5, "b-2"}}));
}

/// A square of 2 x 2 whose triangles left of x = 0 are one material and the others another.
Mesh halves(std::uint32_t left, std::uint32_t right) {
    Mesh mesh = make_quad(2);
    std::ranges::stable_sort(mesh.triangles, {}, [&](const glm::uvec3& t) {
        return mesh.positions[t.x].x + mesh.positions[t.y].x + mesh.positions[t.z].x > 0.0F;
    });
    mesh.material_ranges = {{0, 4, left}, {4, 4, right}};
    return mesh;
}

BakeOptions id_options(int width, int height, int samples = 1) {
    BakeOptions options = sized(width, height);
    options.map.layers = {.normals = false, .ids = true};
    options.map.samples = samples;
    return options;
}

struct BakedIds {
    std::vector<float> texels;
    std::vector<SurfaceId> ids;
    Report report;
};

BakedIds baked_ids(const std::vector<Mesh>& high, const Mesh& low, const BakeOptions& options) {
    BakedIds result;
    const Baker baker(high, low, options, result.report);
    result.ids = baker.ids();
    baker.bake(options.map, [&](const BakedRows& rows) {
        result.texels.insert(result.texels.end(), rows.ids.begin(), rows.ids.end());
    });
    return result;
}

TEST(BakedIds, AtABorderAreThoseOfMostSamples) {
    // Three texels of a row: the border of the materials is in the middle of the second one.
    for (const int samples : {4, 16, 64}) {
        const BakedIds image = baked_ids({halves(7, 3)}, make_quad(), id_options(3, 1, samples));
        ASSERT_EQ(image.ids.size(), 2U);
        EXPECT_EQ(image.ids[0].name, "material-3");
        EXPECT_EQ(image.ids[1].name, "material-7");
        // Half of the samples have each of them: the first name wins, on both sides.
        EXPECT_EQ(image.texels, (std::vector<float>{1, 0, 0})) << samples;
        EXPECT_EQ(baked_ids({halves(3, 7)}, make_quad(), id_options(3, 1, samples)).texels,
                  (std::vector<float>{0, 0, 1}));
        // In 5 texels of a square that is shifted by 1/20, three quarters are left of the border.
        Mesh low = make_quad();
        for (glm::vec3& position : low.positions)
            position.x -= 0.1F;
        EXPECT_EQ(
            baked_ids({moved(halves(7, 3), 1.2F, glm::vec3(0))}, low, id_options(5, 1, samples))
                .texels,
            (std::vector<float>{1, 1, 1, 0, 0}));
    }
    // One sample on the border hits the triangle whose corners come first.
    const BakedIds one = baked_ids({halves(7, 3)}, make_quad(), id_options(4, 1));
    EXPECT_EQ(one.texels, (std::vector<float>{1, 1, 0, 0}));
}

TEST(BakedIds, DoNotDependOnTheOrderOfTriangles) {
    Mesh high = make_torus(0.45F, 60, 30);
    // Four materials by the position of the first corner.
    const auto material_of = [&](const glm::uvec3& t) {
        const glm::vec3& p = high.positions[t.x];
        return (p.x > 0.1F ? 1U : 0U) + (p.z > 0.2F ? 2U : 0U);
    };
    const auto grouped = [&](Mesh mesh) {
        std::ranges::stable_sort(mesh.triangles, {}, material_of);
        mesh.material_ranges.clear();
        for (std::uint32_t material = 0; material < 4; ++material) {
            const auto begin = std::ranges::lower_bound(mesh.triangles, material, {}, material_of);
            const auto end = std::ranges::upper_bound(mesh.triangles, material, {}, material_of);
            mesh.material_ranges.push_back(
                {static_cast<std::uint32_t>(begin - mesh.triangles.begin()),
                 static_cast<std::uint32_t>(end - begin), material});
        }
        return mesh;
    };
    BakeOptions options = id_options(60, 40, 16);
    options.map.padding = 4;
    const BakedIds expected = baked_ids({grouped(high)}, make_torus(), options);
    EXPECT_EQ(expected.ids.size(), 4U);
    for (const float id : {0.0F, 1.0F, 2.0F, 3.0F})
        EXPECT_GT(std::ranges::count(expected.texels, id), 100);
    Mesh shuffled = high;
    const std::vector<std::size_t> order = test::shuffled(high.triangles.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        shuffled.triangles[i] = high.triangles[order[i]];
    EXPECT_EQ(baked_ids({grouped(shuffled)}, make_torus(), options).texels, expected.texels);
    set_thread_limit(1);
    EXPECT_EQ(baked_ids({grouped(high)}, make_torus(), options).texels, expected.texels);
    set_thread_limit(0);
}

TEST(BakedIds, OfNamedTrianglesAreSharedByName) {
    const std::vector<Mesh> high = {moved(make_quad(), 1.0F, {-1, 0, 0}),
                                    moved(make_quad(), 1.0F, {1, 0, 0})};
    Mesh low = make_quad();
    for (glm::vec3& position : low.positions)
        position.x *= 2.0F;
    BakeOptions options = id_options(4, 1);
    options.ids = {{&high[1], {{0, "red"}, {1, "blue"}}}, {&high[0], {{0, "red"}}}};
    const BakedIds image = baked_ids(high, low, options);
    EXPECT_EQ(image.ids, surface_ids({"red", "blue"}));
    EXPECT_EQ(image.texels[0], 1.0F);
    EXPECT_EQ(image.texels[1], 1.0F);
    EXPECT_EQ(std::set<float>(image.texels.begin(), image.texels.end()).size(), 2U);
    options.ids[0].triangles = {{1, "blue"}};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { baked_ids(high, low, options); }),
              "the names of a high mesh's triangles do not begin at triangle 0, or are not in "
              "ascending order");
    options.ids.clear();
    EXPECT_EQ(baked_ids(high, low, options).ids, surface_ids({"quad"})) << "the name of the mesh";
}

TEST(BakedIds, AreNotMixedInThePadding) {
    // Two charts of three columns each, up to just before their edges, and a gap of three. The
    // middle of the gap is equally far from both.
    Mesh low = make_quad();
    const Mesh second = low;
    for (const glm::vec3& position : second.positions)
        low.positions.push_back(position + glm::vec3(2, 0, 0));
    for (const glm::uvec3& triangle : second.triangles)
        low.triangles.push_back(triangle + 4U);
    low.normals.clear();
    low.tangents.clear();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord.x *= 0.33F;
    for (std::size_t i = 0; i < 4; ++i)
        low.texcoords.push_back(low.texcoords[i] + glm::vec2(0.67F, 0.0F));
    const std::vector<Mesh> high = {make_quad(), moved(make_quad(), 1.0F, {2, 0, 0})};
    BakeOptions options = id_options(9, 1);
    options.map.padding = 2;
    for (const auto& [left, right] : {std::pair("b", "a"), {"a", "b"}}) {
        options.ids = {{&high[0], {{0, left}}}, {&high[1], {{0, right}}}};
        const float id = std::string(left) == "a" ? 0.0F : 1.0F;
        EXPECT_EQ(baked_ids(high, low, options).texels,
                  (std::vector<float>{id, id, id, id, 0.0F, 1 - id, 1 - id, 1 - id, 1 - id}));
    }
    options.map.padding = 0;
    EXPECT_EQ(baked_ids(high, low, options).texels[4], -1.0F);
}

TEST(BakedIds, AreColorsInFiles) {
    const std::vector<float> values = {1.0F, 0.0F, -1.0F};
    const std::vector<TexelState> states = {TexelState::baked, TexelState::padded,
                                            TexelState::empty};
    LayerCoding coding{.kind = LayerKind::id, .bits = 8};
    coding.ids = {{"a", {1, 128, 255}}, {"b c", {77, 0, 3}}};
    const auto codes = encode_layer(values, states, coding, true, 0);
    const std::vector<int> expected = {77, 0, 3, 255, 1, 128, 255, 255, 0, 0, 0, 0};
    ASSERT_EQ(codes.size(), expected.size());
    for (std::size_t i = 0; i < codes.size(); ++i)
        EXPECT_EQ(static_cast<int>(codes[i]), expected[i]) << i;
    EXPECT_EQ(coding.color_space(), ColorSpace::data);
    const auto metadata = layer_metadata(coding);
    EXPECT_EQ(metadata.at("relief:content"), "ids");
    EXPECT_EQ(metadata.at("relief:ids"), "#0180ff a\n#4d0003 b c\n");
}

}  // namespace
}  // namespace relief
