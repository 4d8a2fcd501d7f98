// SPDX-License-Identifier: Apache-2.0
// Several maps in one bake: parts of the low mesh, tiles and matched high parts. The result has
// the same bytes on every instruction set, packet size and triangle order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/invariants.h"
#include "support/sanitized.h"

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
    mesh.colors.insert(mesh.colors.end(), more.colors.begin(), more.colors.end());
    for (const glm::uvec3& triangle : more.triangles)
        mesh.triangles.push_back(triangle + first);
    return mesh;
}

/// Two adjacent squares, the second one in the tile to the right.
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
    options.map.samples = 4;
    options.map.padding = 3;
    Report report;
    const Baker baker(high, low, options, report);
    const BakedImage alone = bake(high, low, options);
    EXPECT_EQ(baked(baker, options.map).normals, alone.normals);
    EXPECT_EQ(baked(baker, sized(64, 64).map).normals, bake(high, low, sized(64, 64)).normals);
    EXPECT_EQ(baked(baker, options.map).heights, alone.heights);
    EXPECT_EQ(baker.distances().offset, alone.result.distances.offset);
}

TEST(Baker, ReportsItsRowsAndCanBeCancelledThere) {
    const std::vector<Mesh> high = {make_quad()};
    Report report;
    const Baker baker(high, make_quad(), sized(32, 256), report);
    const auto bake_with = [&](Progress& progress) {
        int rows = 0;
        baker.bake(sized(32, 256).map, [&](const BakedRows& band) { rows += band.row_count; },
                   report, {.progress = &progress});
        return rows;
    };
    std::vector<double> parts;
    Progress progress([&](const Progress::State& state) {
        if (state.stage == "baking") parts.push_back(state.part.value_or(-1.0));
    });
    EXPECT_EQ(bake_with(progress), 256);
    EXPECT_EQ(parts.front(), 0.0);
    EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
    EXPECT_EQ(parts.back(), 1.0);
    EXPECT_EQ(progress.state().stage, "");

    Progress* ended = nullptr;
    Progress ending([&](const Progress::State& state) {
        if (state.part.value_or(0.0) > 0.0) ended->cancel();
    });
    ended = &ending;
    EXPECT_THROW(bake_with(ending), Cancelled);
}

TEST(Baker, MapOfSomeTrianglesEqualsTheWholeMapThere) {
    // A hard edge lies between the faces of a cube. The rays of one face must not depend on the
    // omitted faces.
    const Mesh low = make_cube();
    const std::vector<Mesh> high = {make_sphere(64, 32)};
    Report report;
    const Baker baker(high, low, sized(1, 1), report);
    const BakedImage all = baked(baker, sized(48, 48).map);
    std::size_t texels = 0;
    for (std::uint32_t first = 0; first < low.triangles.size(); first += 2) {
        const std::vector<std::uint32_t> face = {first, first + 1};
        BakeMapOptions map = sized(48, 48).map;
        map.triangles = face;
        const BakedImage some = baked(baker, map);
        for (std::size_t i = 0; i < some.states.size(); ++i) {
            if (some.states[i] == TexelState::empty) continue;
            if (all.normal(i) == some.normal(i)) ++texels;
        }
        EXPECT_EQ(some.result.coverage.shared, 0U);
    }
    // The parts agree at texels inside one face, except those that two faces touch.
    EXPECT_GE(texels, all.result.coverage.inside);
    const std::vector<std::uint32_t> none;
    BakeMapOptions map = sized(8, 8).map;
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
        BakeMapOptions map = sized(16, 16).map;
        map.placement.tile = {tile, 0};
        const BakedImage image = baked(baker, map);
        EXPECT_EQ(image.count(TexelState::baked), 256U);
        const glm::dvec3 expected = tile == 0 ? glm::dvec3(0.6, 0, 0.8) : glm::dvec3(0, 0.6, 0.8);
        EXPECT_LT(degrees_between(image.normal(100), expected), 1e-4);
    }
    BakeMapOptions map = sized(16, 16).map;
    map.placement.tile = {2, 0};
    EXPECT_EQ(baked(baker, map).count(TexelState::empty), 256U);
}

TEST(Baker, PartsDoNotCatchEachOthersRays) {
    // A square with another one 0.04 above it. Each has its own high square.
    const Mesh low = two_tiles();
    const std::vector<Mesh> left = {leaning(make_quad(), {0.6F, 0, 0.8F}, {0, 0, 0.01F})};
    const std::vector<Mesh> right = {leaning(make_quad(), {0, 0.6F, 0.8F}, {2, 0, 0.01F}),
                                     leaning(make_quad(), {0, 0.6F, 0.8F}, {0, 0, 0.04F})};
    const std::vector<Mesh> all = {left[0], right[0], right[1]};
    Report report;
    const Baker together(all, low, sized(1, 1), report);
    EXPECT_LT(degrees_between(baked(together, sized(16, 16).map).normal(0), {0, 0.6, 0.8}), 1e-4);
    const std::vector<BakePart> parts = {{left, {0, 1}}, {right, {2, 3}}};
    const Baker baker(parts, low, sized(1, 1), report);
    const BakedImage image = baked(baker, sized(16, 16).map);
    EXPECT_EQ(image.count(TexelState::baked), 256U);
    for (std::size_t i = 0; i < 256; ++i)
        EXPECT_LT(degrees_between(image.normal(i), {0.6, 0, 0.8}), 1e-4);
    // The distance to the other part does not lengthen the rays: it is 0.01, not 2 or 0.04.
    EXPECT_NEAR(image.result.max_height, 0.01, 1e-7);
    const std::vector<Mesh> far = {leaning(make_quad(), {0, 0.6F, 0.8F}, {2, 0, 5})};
    const std::vector<BakePart> apart = {{left, {0, 1}}, {far, {2, 3}}};
    // A distance of 5 is accepted only with an explicit option.
    EXPECT_THROW(Baker(apart, low, sized(1, 1), report), BakeMismatch);
    BakeOptions longer = sized(1, 1);
    longer.max_distance = 6.0;
    EXPECT_GT(Baker(apart, low, longer, report).distances().offset, 7.0);
}

TEST(Baker, PartsWithoutAnythingHighAreMissed) {
    const std::vector<Mesh> high = {make_quad()};
    const std::vector<BakePart> parts = {{high, {0, 1}}, {{}, {2, 3}}};
    Report report;
    const Baker baker(parts, two_tiles(), sized(1, 1), report);
    BakeMapOptions map = sized(8, 8).map;
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

TEST(Baker, RefusesInvalidMapOptions) {
    const std::vector<Mesh> high = {make_quad()};
    Report report;
    const Baker baker(high, make_quad(), sized(1, 1), report);
    const auto message = [&](const BakeMapOptions& map) {
        return test::message_of<InvalidInput>([&] { baked(baker, map); });
    };
    BakeMapOptions map = sized(std::numeric_limits<int>::max(), 4).map;
    map.samples = 64;
    EXPECT_EQ(message(map),
              "the map has 2147483647 x 4 texels of 64 samples, but must have 1 to 8192 texels "
              "along each side");
    map = sized(4, 1 << 30).map;
    map.samples = 16;
    EXPECT_EQ(message(map),
              "the map has 4 x 1073741824 texels of 16 samples, but must have 1 to 16384 texels "
              "along each side");
    const std::vector<std::uint32_t> beyond = {0, 2}, turned = {1, 0};
    map = sized(4, 4).map;
    map.triangles = beyond;
    EXPECT_EQ(message(map), "there is no triangle 2 in the low mesh");
    map.triangles = turned;
    EXPECT_EQ(message(map), "the triangles of a map are not in ascending order");
}

TEST(Baker, CountsATexelOfSeveralTrianglesOnceForAllItsSamples) {
    const Mesh twice = joined(make_quad(), make_quad());
    for (const int samples : {1, 4, 16, 64}) {
        BakeOptions options = sized(70, 66);
        options.map.samples = samples;
        const BakedImage image = bake({make_quad()}, twice, options);
        EXPECT_EQ(image.report.count("texel of several triangles"), 70U * 66U);
        const auto found = image.report.findings();
        const auto shared = std::find_if(found.begin(), found.end(), [](const Finding& finding) {
            return finding.kind == "texel of several triangles";
        });
        EXPECT_EQ(shared->first.back(), 7U);
    }
}

/// Returns the exception of a baker with these meshes.
BakeMismatch mismatch_of(const std::vector<Mesh>& high, const Mesh& low,
                         const BakeOptions& options = sized(1, 1)) {
    Report report;
    try {
        const Baker baker(high, low, options, report);
    } catch (const BakeMismatch& mismatch) {
        return mismatch;
    }
    ADD_FAILURE() << "no mismatch";
    return {BakeMismatch::Kind::apart, {}, 0.0, ""};
}

TEST(Baker, ComparesBoxesOfTrianglesAlone) {
    Mesh high = test::moved(make_quad(), 3.0F, {0, 0, 0.5F});
    high.positions.emplace_back(100.0F, 0.0F, 0.0F);  // A vertex without triangle.
    high.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
    high.triangles.emplace_back(0, 1, 5);
    high.normals.clear();
    high.texcoords.clear();
    high.tangents.clear();
    const std::vector<Mesh> meshes = {high, test::moved(make_quad(), 1.0F, {0, 0, 1.5F})};
    const BakeFit fit = compare_boxes(meshes, make_quad());
    EXPECT_EQ(fit.high.min, glm::vec3(-3, -3, 0.5F));
    EXPECT_EQ(fit.high.max, glm::vec3(3, 3, 1.5F));
    EXPECT_EQ(fit.low.max, glm::vec3(1, 1, 0));
    EXPECT_DOUBLE_EQ(fit.gap, 0.5);
    EXPECT_DOUBLE_EQ(fit.size_ratio, std::sqrt(73.0 / 8.0));
    EXPECT_FALSE(fit.fits_rotated);
    // The mesh is beside and above, so the corners are apart.
    const std::vector<Mesh> corner = {test::moved(make_quad(), 1.0F, {5, 0, 4})};
    EXPECT_DOUBLE_EQ(compare_boxes(corner, make_quad()).gap, 5.0);
}

TEST(Baker, RefusesMeshesOfOtherSizesUnlessAllowed) {
    for (const float scale : {10.5F, 1.0F / 10.5F}) {
        const std::vector<Mesh> high = {test::moved(make_quad(), scale, {0, 0, 0})};
        const BakeMismatch mismatch = mismatch_of(high, make_quad());
        EXPECT_EQ(mismatch.kind(), BakeMismatch::Kind::size);
        EXPECT_NEAR(mismatch.fit().size_ratio, scale, 1e-6);
        BakeOptions options = sized(16, 16);
        options.allow_size_mismatch = true;
        EXPECT_GT(bake(high, make_quad(), options).result.texels_baked, 0U);
    }
    EXPECT_STREQ(mismatch_of({test::moved(make_quad(), 16.0F, {0, 0, 0})}, make_quad()).what(),
                 "the high meshes are 16 times as large as the low mesh, which is not within 1/10 "
                 "to 10: the box of the high meshes is (-16, -16, 0) to (16, 16, 0), of the low "
                 "mesh (-1, -1, 0) to (1, 1, 0)");
    const std::vector<Mesh> nearly = {test::moved(make_quad(), 9.5F, {0, 0, 0})};
    EXPECT_EQ(bake(nearly, make_quad(), sized(8, 8)).result.texels_baked, 64U);
}

TEST(Baker, RefusesMeshesThatRaysDoNotReach) {
    const std::vector<Mesh> high = {test::moved(make_quad(), 1.0F, {0, 0, 1.5F})};
    const BakeMismatch mismatch = mismatch_of(high, make_quad());
    EXPECT_EQ(mismatch.kind(), BakeMismatch::Kind::apart);
    EXPECT_DOUBLE_EQ(mismatch.reach(), std::sqrt(2.0));
    EXPECT_DOUBLE_EQ(mismatch.fit().gap, 1.5);
    BakeOptions options = sized(8, 8);
    options.offset = options.max_distance = 1.25;
    EXPECT_DOUBLE_EQ(mismatch_of(high, make_quad(), options).reach(), 1.25);
    options.offset = 1.75;
    EXPECT_EQ(bake(high, make_quad(), options).result.texels_baked, 64U);
    // With a cage, the length of rays is its distance.
    const Mesh cage = test::moved(make_quad(), 1.0F, {0, 0, 0.5F});
    BakeOptions caged = sized(8, 8);
    caged.cage = std::make_shared<const Mesh>(cage);
    EXPECT_DOUBLE_EQ(mismatch_of(high, make_quad(), caged).reach(), 0.5);
}

TEST(Baker, RefusesHighMeshesWithoutASurface) {
    Mesh broken = make_quad();
    for (glm::vec3& position : broken.positions)
        position.y = std::numeric_limits<float>::infinity();
    for (const Mesh& high : {Mesh{}, broken}) {
        EXPECT_EQ(mismatch_of({high}, make_quad()).kind(), BakeMismatch::Kind::no_surface);
    }
}

TEST(Baker, ReportsBoxesThatFitOnlyIfRotated) {
    Mesh upright = make_sphere();
    for (glm::vec3& position : upright.positions)
        position *= glm::vec3(0.3F, 1.0F, 0.3F);
    Mesh lying = upright;
    for (glm::vec3& position : lying.positions)
        position = {position.x, -position.z, position.y};
    const std::string kind = "high box that fits only with y and z swapped";
    EXPECT_EQ(bake({lying}, upright, sized(16, 16)).report.count(kind), 1U);
    EXPECT_EQ(bake({upright}, lying, sized(16, 16)).report.count(kind), 1U);
    EXPECT_EQ(bake({upright}, upright, sized(16, 16)).report.count(kind), 0U);
}

TEST(Baker, MeasuresTheRaysThatMissedTexelsNeed) {
    // Steps 1/4 to 1 above the low square, each of two columns of texels.
    Mesh stairs;
    for (int step = 0; step < 4; ++step) {
        const auto first = static_cast<std::uint32_t>(stairs.positions.size());
        const float x = -1.0F + 0.5F * static_cast<float>(step);
        const float z = 0.25F * static_cast<float>(step + 1);
        stairs.positions.insert(stairs.positions.end(),
                                {{x, -1, z}, {x + 0.5F, -1, z}, {x + 0.5F, 1, z}, {x, 1, z}});
        stairs.triangles.insert(stairs.triangles.end(),
                                {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
    }
    BakeOptions options = sized(8, 8);
    options.offset = 0.375;
    options.max_distance = 0.0;
    options.map.measures_missed = true;
    for (const int samples : {1, 4, 16}) {
        options.map.samples = samples;
        const BakeResult result = bake({stairs}, make_quad(), options).result;
        EXPECT_EQ(result.texels_missed, 48U);
        EXPECT_EQ(result.measuring_rays, 96U);
        EXPECT_EQ(result.clipped_outside.texels, 48U);
        EXPECT_DOUBLE_EQ(result.clipped_outside.shortest, 0.5);
        EXPECT_DOUBLE_EQ(result.clipped_outside.longest, 1.0);
        // 0.75, rounded up by at most an eighth.
        EXPECT_GE(result.clipped_outside.half, 0.75);
        EXPECT_LE(result.clipped_outside.half, 0.75 * 1.125);
        EXPECT_EQ(result.clipped_inside.texels, 0U);
        EXPECT_EQ(result.missed_from_behind, 0U);
        ASSERT_EQ(result.first_missed.size(), 8U);
        EXPECT_EQ(result.first_missed[0].x, 2);
        EXPECT_EQ(result.first_missed[6].y, 1);
        const glm::dvec2 place(result.first_missed[0].position);
        EXPECT_LT(glm::distance(place, {-0.375, 0.875}), 0.2);
        // The reported length hits everything.
        BakeOptions longer = options;
        longer.offset = 1.001 * result.clipped_outside.longest;
        EXPECT_EQ(bake({stairs}, make_quad(), longer).result.texels_missed, 0U);
    }
    options.map.samples = 1;
    // The same below the low square, and then with reversed faces.
    Mesh below = stairs;
    for (glm::vec3& position : below.positions)
        position.z = -position.z;
    options.offset = 0.0;
    options.max_distance = 0.375;
    const BakeResult inside = bake({below}, make_quad(), options).result;
    EXPECT_EQ(inside.clipped_inside.texels, 48U);
    EXPECT_DOUBLE_EQ(inside.clipped_inside.longest, 1.0);
    for (glm::uvec3& triangle : below.triangles)
        std::swap(triangle.y, triangle.z);
    options.max_distance = 2.0;
    const BakeResult behind = bake({below}, make_quad(), options).result;
    EXPECT_EQ(behind.missed_from_behind, 64U);
    EXPECT_EQ(behind.clipped_inside.texels, 0U);
    options.map.measures_missed = false;
    EXPECT_EQ(bake({below}, make_quad(), options).result.measuring_rays, 0U);
}

/// Sets an environment variable and restores it in the destructor.
class Environment {
  public:
    Environment(const char* name, const std::string& value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        setenv(name, value.c_str(), 1);
    }
    ~Environment() {
        if (before_)
            setenv(name_, before_->c_str(), 1);
        else
            unsetenv(name_);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

  private:
    const char* name_;
    std::optional<std::string> before_;
};

std::vector<std::string> instruction_sets() {
    __builtin_cpu_init();
    std::vector<std::string> sets = {"sse2"};
    if (__builtin_cpu_supports("sse4.2")) sets.emplace_back("sse4.2");
    if (__builtin_cpu_supports("avx")) sets.emplace_back("avx");
    if (__builtin_cpu_supports("avx2")) sets.emplace_back("avx2");
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
        sets.emplace_back("avx512");
    return sets;
}

/// Gives each triangle its own three vertices with its own normal and color.
Mesh faceted(const Mesh& smooth, unsigned seed) {
    std::mt19937 random(seed);
    Mesh mesh;
    for (const glm::uvec3& triangle : smooth.triangles) {
        const glm::vec3& a = smooth.positions[triangle.x];
        const glm::vec3& b = smooth.positions[triangle.y];
        const glm::vec3& c = smooth.positions[triangle.z];
        const glm::vec3 cross = glm::cross(b - a, c - a);
        if (glm::length(cross) == 0.0F) continue;
        const glm::vec4 color(static_cast<float>(random() % 256) / 255.0F,
                              static_cast<float>(random() % 256) / 255.0F,
                              static_cast<float>(random() % 256) / 255.0F, 1.0F);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        for (const glm::vec3& corner : {a, b, c}) {
            mesh.positions.push_back(corner);
            mesh.normals.push_back(glm::normalize(cross));
            mesh.colors.push_back(color);
        }
    }
    return mesh;
}

/// Returns the same triangles in another order.
Mesh shuffled(Mesh mesh, unsigned seed) {
    std::mt19937 random(seed);
    for (std::size_t i = mesh.triangles.size(); i > 1; --i)
        std::swap(mesh.triangles[i - 1], mesh.triangles[random() % i]);
    return mesh;
}

/// Columns of different heights with vertical walls, `cells` along each side of the square from -1
/// to 1.
Mesh steps(int cells) {
    Mesh mesh;
    const auto quad = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                          const glm::vec3& d) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    };
    const auto at = [&](int i) {
        return 2.0F * static_cast<float>(i) / static_cast<float>(cells) - 1.0F;
    };
    const auto height = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= cells || y >= cells) return -0.25F;
        return static_cast<float>((x * 5 + y * 3) % 4) / 30.0F;
    };
    for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
            const float z = height(x, y);
            const float l = at(x), r = at(x + 1), b = at(y), t = at(y + 1);
            quad({l, b, z}, {r, b, z}, {r, t, z}, {l, t, z});
            const float right = height(x + 1, y), left = height(x - 1, y);
            const float above = height(x, y + 1), below = height(x, y - 1);
            if (right < z) quad({r, b, z}, {r, b, right}, {r, t, right}, {r, t, z});
            if (left < z) quad({l, t, z}, {l, t, left}, {l, b, left}, {l, b, z});
            if (above < z) quad({r, t, z}, {r, t, above}, {l, t, above}, {l, t, z});
            if (below < z) quad({l, b, z}, {l, b, below}, {r, b, below}, {r, b, z});
        }
    }
    return mesh;
}

struct Model {
    const char* name;
    Mesh high, low;
    int side;
};

/// In most models, rows and columns of texel centers lie on edges, and some on vertices.
std::vector<Model> models() {
    std::vector<Model> all;
    all.push_back({"cube", faceted(make_cube(), 1), make_cube(), 24});
    all.push_back({"steps", faceted(steps(8), 2), make_quad(), 36});
    all.push_back({"steps whose corners are rounded", faceted(steps(6), 3), make_quad(), 30});
    all.push_back({"sphere", faceted(make_sphere(12, 6), 4), make_sphere(12, 6), 36});
    all.push_back(
        {"sphere in a finer one", faceted(make_sphere(16, 8), 5), make_sphere(24, 12), 40});
    const Mesh twice = joined(faceted(steps(4), 6), faceted(steps(4), 7));
    all.push_back({"steps, each triangle twice in other colors", twice, make_quad(), 20});
    Mesh turned = faceted(make_quad(4), 8);
    for (glm::uvec3& triangle : turned.triangles)
        std::swap(triangle.x, triangle.y);
    for (glm::vec3& normal : turned.normals)
        normal = -normal;
    all.push_back(
        {"sheet with two faces", joined(faceted(make_quad(4), 9), turned), make_quad(), 20});
    return all;
}

BakedImage baked(const Mesh& high, const Model& model, std::size_t map_count = 1) {
    BakeOptions options = sized(model.side, model.side);
    options.map.samples = 4;
    options.map.layers.occlusion = OcclusionOptions{.rays = 8, .distance = {}};
    options.map.layers.curvature = true;
    options.map.layers.positions = true;
    options.map.layers.colors = true;
    options.map.padding = 2;
    options.map_count = map_count;
    return bake({high}, model.low, options);
}

/// Returns the names of the layers in which two bakes differ.
std::string differences(const BakedImage& a, const BakedImage& b) {
    std::string all;
    if (a.normals != b.normals) all += " normals";
    if (a.heights != b.heights) all += " heights";
    if (a.occlusion != b.occlusion) all += " occlusion";
    if (a.curvature != b.curvature) all += " curvature";
    if (a.positions != b.positions) all += " positions";
    if (a.colors != b.colors) all += " colors";
    if (a.states != b.states) all += " states";
    return all;
}

TEST(BakeProcessors, EveryInstructionSetPacketAndOrderGivesTheSameBytes) {
    for (const Model& model : models()) {
        const BakedImage expected = baked(model.high, model);
        EXPECT_GT(expected.count(TexelState::baked), 100U) << model.name;
        for (const std::string& isa : instruction_sets()) {
            const Environment device("RELIEF_EMBREE", "isa=" + isa);
            for (const char* rays : {"1", "4", "8", "16"}) {
                if (test::is_sanitized && *rays != '1') continue;  // The smallest and the largest.
                const Environment packet("RELIEF_RAY_PACKET", rays);
                EXPECT_EQ(differences(baked(model.high, model), expected), "")
                    << model.name << ", " << isa << ", packets of " << rays;
            }
        }
    }
}

TEST(BakeProcessors, TheOrderOfTrianglesAndTheBuildOfTheSceneChangeNoByte) {
    for (const Model& model : models()) {
        const BakedImage expected = baked(model.high, model);
        for (const unsigned seed : {11U, 12U, 13U}) {
            EXPECT_EQ(differences(baked(shuffled(model.high, seed), model), expected), "")
                << model.name << ", " << seed;
        }
        EXPECT_EQ(differences(baked(model.high, model, 1'000'000), expected), "") << model.name;
    }
}

}  // namespace
}  // namespace relief
