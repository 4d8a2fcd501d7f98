// SPDX-License-Identifier: Apache-2.0
// Texels at chart borders: samples moved inside the chart, padding against a brute-force search,
// and filling up to the border of the map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "bake/bake_work.h"
#include "bake/edge_padding.h"
#include "mesh/bake/bake_support.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::bake;
using test::BakedImage;
using test::sized;

/// A triangle with legs of 3 and 4, whose inscribed circle has radius 1.
Mesh right_triangle() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

glm::dvec3 place(const Mesh& mesh, const CoveredTexel& texel) {
    const glm::dvec3 weights(texel.weights());
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 3; ++i)
        sum += weights[i] * glm::dvec3(mesh.positions[mesh.triangles[texel.triangle][i]]);
    return sum;
}

CoveredTexel at(float second, float third) {
    return {0, second, third, false};
}

TEST(BorderSample, MovesAwayFromItsEdges) {
    const Mesh mesh = right_triangle();
    // The points are on the leg along x and on the corner of both legs.
    const auto on_edge = moved_inside(mesh, at(0.25F, 0.0F), 0.01);
    ASSERT_TRUE(on_edge);
    EXPECT_NEAR(place(mesh, *on_edge).y, 0.01, 1e-6);
    EXPECT_LT(glm::distance(place(mesh, *on_edge), {1, 0.01, 0}), 0.011);
    const auto on_corner = moved_inside(mesh, at(0.0F, 0.0F), 0.01);
    ASSERT_TRUE(on_corner);
    EXPECT_LT(glm::distance(place(mesh, *on_corner), {0.01, 0.01, 0}), 1e-6);
    EXPECT_EQ(on_corner->triangle, 0U);
}

TEST(BorderSample, StaysInsideTheTriangle) {
    EXPECT_FALSE(moved_inside(right_triangle(), at(0.25F, 0.25F), 0.01));
    EXPECT_FALSE(moved_inside(right_triangle(), at(0.25F, 0.0F), 0.0));
}

TEST(BorderSample, MovesToTheIncenterOfSmallTriangles) {
    const auto moved = moved_inside(right_triangle(), at(1.0F, 0.0F), 2.0);
    ASSERT_TRUE(moved);
    EXPECT_LT(glm::distance(place(right_triangle(), *moved), {1, 1, 0}), 1e-6);
}

TEST(BorderSample, IsAbsentWithoutArea) {
    Mesh line = right_triangle();
    line.positions[2] = {2, 0, 0};
    EXPECT_FALSE(moved_inside(line, at(0.5F, 0.0F), 0.01));
    line.positions[2].x = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(moved_inside(line, at(0.5F, 0.0F), 0.01));
}

/// Rotates the mesh in space and in the image, where its borders cross texels, not around
/// the origin.
Mesh askew(Mesh mesh) {
    const glm::dvec3 x = glm::normalize(glm::dvec3(0.7, -0.5, 0.4));
    const glm::dvec3 z = glm::normalize(glm::cross(x, glm::dvec3(0.2, 0.9, 0.1)));
    const glm::dmat3 turn(x, glm::cross(z, x), z);
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(turn * glm::dvec3(position) * 0.37 + glm::dvec3(1.3, -0.7, 2.1));
    for (glm::vec2& texcoord : mesh.texcoords) {
        const glm::dvec2 from = glm::dvec2(texcoord) - 0.5;
        texcoord =
            glm::vec2(0.5 + 0.61 * from.x - 0.23 * from.y, 0.5 + 0.23 * from.x + 0.61 * from.y);
    }
    mesh.normals.clear();
    mesh.tangents.clear();
    return mesh;
}

Mesh open_grid() {
    Mesh mesh = make_quad(9);
    for (glm::vec3& position : mesh.positions)
        position.z = 0.2F * std::sin(3.0F * position.x) * std::cos(2.0F * position.y);
    return askew(mesh);
}

Mesh strip_of_one() {
    Mesh mesh = right_triangle();
    mesh.texcoords = {{0.0F, 0.1F}, {1.0F, 0.3F}, {0.2F, 0.9F}};
    return askew(mesh);
}

/// Triangles without common vertices.
Mesh confetti() {
    const Mesh grid = open_grid();
    Mesh mesh;
    for (const glm::uvec3& triangle : grid.triangles) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int i = 0; i < 3; ++i) {
            mesh.positions.push_back(grid.positions[triangle[i]] +
                                     glm::vec3(0, 0, 0.01F * static_cast<float>(first)));
            mesh.texcoords.push_back(grid.texcoords[triangle[i]]);
        }
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

TEST(OpenBorders, NoTexelOfAMeshOntoItselfIsMissed) {
    for (const Mesh& mesh : {open_grid(), strip_of_one(), confetti()}) {
        for (const int samples : {1, 4}) {
            BakeOptions options = sized(256, 256);
            options.map.samples = samples;
            const BakedImage image = bake({mesh}, mesh, options);
            EXPECT_GT(image.result.coverage.touched, 100U);
            EXPECT_EQ(image.result.texels_missed, 0U);
            EXPECT_FALSE(image.report.count("texel missed by its rays"));
            double worst = 0.0;
            for (std::size_t i = 0; i < image.states.size(); ++i)
                worst = std::max(worst, degrees_between(image.normal(i), {0, 0, 1}));
            EXPECT_LT(worst, 0.02);
            EXPECT_LT(image.result.max_height, 1e-6);
            EXPECT_GT(image.result.min_height, -1e-6);
        }
    }
}

TEST(OpenBorders, AreNotMissedFromACageEither) {
    const Mesh mesh = open_grid();
    Mesh cage = mesh;
    // The normal points outwards everywhere, because the grid is almost flat.
    const glm::dvec3 a(mesh.positions[mesh.triangles[0].x]);
    const glm::dvec3 b(mesh.positions[mesh.triangles[0].y]);
    const glm::dvec3 c(mesh.positions[mesh.triangles[0].z]);
    const glm::vec3 outwards(glm::normalize(glm::cross(b - a, c - a)));
    for (glm::vec3& position : cage.positions)
        position += 0.05F * outwards;
    BakeOptions options = sized(256, 256);
    options.cage = std::make_shared<const Mesh>(cage);
    const BakedImage image = bake({mesh}, mesh, options);
    EXPECT_GT(image.result.coverage.touched, 100U);
    EXPECT_EQ(image.result.texels_missed, 0U);
}

TEST(OpenBorders, AreTheSameForAnyNumberOfThreads) {
    const Mesh mesh = confetti();
    const BakedImage usual = bake({mesh}, mesh, sized(200, 200));
    set_thread_limit(1);
    const BakedImage alone = bake({mesh}, mesh, sized(200, 200));
    set_thread_limit(0);
    EXPECT_EQ(usual.normals, alone.normals);
    EXPECT_EQ(usual.heights, alone.heights);
    EXPECT_EQ(usual.result.rays, alone.result.rays);
}

TEST(OpenBorders, TrueMissesStayMissed) {
    // The high mesh ends a thousandth of its size before the low one, which is far less than a
    // texel.
    const Mesh low = strip_of_one();
    Mesh high = low;
    const glm::vec3 center = (low.positions[0] + low.positions[1] + low.positions[2]) / 3.0F;
    for (glm::vec3& position : high.positions)
        position = center + 0.999F * (position - center);
    const BakedImage image = bake({high}, low, sized(64, 64));
    EXPECT_GT(image.result.coverage.touched, 50U);
    EXPECT_GE(image.result.texels_missed, image.result.coverage.touched);
    EXPECT_LE(image.result.texels_missed, image.result.coverage.touched + 5);
    EXPECT_EQ(image.report.count("texel missed by its rays"), image.result.texels_missed);
}

struct Place {
    int column, distance;
};

void expect_as_tried(const std::vector<Place>& places, int width) {
    NearestColumns nearest;
    for (const Place& place : places)
        nearest.add(place.column, place.distance);
    for (int column = 0; column < width; ++column) {
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        std::vector<int> expected;
        for (const Place& place : places) {
            const std::int64_t across = column - place.column;
            const std::int64_t squared =
                across * across + std::int64_t{place.distance} * place.distance;
            if (squared > least) continue;
            if (squared < least) expected.clear();
            least = squared;
            expected.push_back(place.column);
        }
        ASSERT_EQ(nearest.squared_distance(column), least) << column;
        std::vector<int> found;
        nearest.for_nearest(column, [&](int other) { found.push_back(other); });
        ASSERT_EQ(found, expected) << column;
    }
}

TEST(NearestColumns, FindsAllTies) {
    std::mt19937 random(5);
    for (int round = 0; round < 400; ++round) {
        std::vector<Place> places;
        for (int column = 0; column < 90; ++column) {
            if (random() % 3 != 0) places.push_back({column, static_cast<int>(random() % 40)});
        }
        if (!places.empty()) expect_as_tried(places, 90);
    }
}

/// The 12 integer points of a circle of radius 5 have the same distance to its center.
TEST(NearestColumns, FindsMoreThanTwo) {
    const std::vector<Place> circle = {{0, 0}, {1, 3}, {2, 4}, {5, 5}, {8, 4}, {9, 3}, {10, 0}};
    expect_as_tried(circle, 11);
    NearestColumns nearest;
    for (const Place& place : circle)
        nearest.add(place.column, place.distance);
    EXPECT_EQ(nearest.squared_distance(5), 25);
    int count = 0;
    nearest.for_nearest(5, [&](int) { ++count; });
    EXPECT_EQ(count, 7);
}

TEST(NearestColumns, IsExactForTheLongestRows) {
    expect_as_tried({{0, 65535}, {65535, 65535}}, 65536);
    expect_as_tried({{0, 3}, {65534, 3}}, 65536);
}

struct Map {
    int width, height;
    std::vector<float> normals, heights;
    std::vector<TexelState> states;
};

/// A few baked texels with different directions.
Map sparse(int width, int height, unsigned one_in) {
    Map map{width, height, {}, {}, {}};
    std::mt19937 random(3);
    for (int i = 0; i < width * height; ++i) {
        const bool is_baked = random() % one_in == 0;
        const double angle = static_cast<double>(random() % 1000) / 1000.0;
        map.states.push_back(is_baked ? TexelState::baked : TexelState::empty);
        map.normals.push_back(is_baked ? static_cast<float>(std::sin(angle)) : 0.0F);
        map.normals.push_back(0.0F);
        map.normals.push_back(is_baked ? static_cast<float>(std::cos(angle)) : 1.0F);
        map.heights.push_back(is_baked ? static_cast<float>(angle) : 0.0F);
    }
    return map;
}

Map dilated(Map map, int texels, int rows_at_once) {
    Map result{map.width, map.height, {}, {}, {}};
    Dilation dilation(map.width, map.height, texels, [&](const BakedRows& rows) {
        EXPECT_EQ(rows.first_row * map.width, static_cast<int>(result.states.size()));
        EXPECT_TRUE(rows.row_count % 64 == 0 || rows.first_row + rows.row_count == map.height);
        result.normals.insert(result.normals.end(), rows.normals.begin(), rows.normals.end());
        result.heights.insert(result.heights.end(), rows.heights.begin(), rows.heights.end());
        result.states.insert(result.states.end(), rows.states.begin(), rows.states.end());
    });
    for (int row = 0; row < map.height; row += rows_at_once) {
        const int count = std::min(rows_at_once, map.height - row);
        const auto first = static_cast<std::size_t>(row * map.width);
        const auto texel_count = static_cast<std::size_t>(count * map.width);
        dilation.push({row, count, std::span(map.normals).subspan(3 * first, 3 * texel_count),
                       std::span(map.heights).subspan(first, texel_count),
                       std::span(map.states).subspan(first, texel_count)});
    }
    return result;
}

TEST(Dilation, FillsWithTheMeanOfTheNearest) {
    const Map map = sparse(61, 150, 60);
    const int texels = 6;
    const Map filled = dilated(map, texels, 64);
    ASSERT_EQ(filled.states.size(), map.states.size());
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            int nearest = std::numeric_limits<int>::max();
            double sum_x = 0.0, sum_z = 0.0;
            for (int v = 0; v < map.height; ++v) {
                for (int u = 0; u < map.width; ++u) {
                    const auto other = static_cast<std::size_t>(v * map.width + u);
                    if (map.states[other] != TexelState::baked) continue;
                    const int squared = (u - x) * (u - x) + (v - y) * (v - y);
                    if (squared > nearest) continue;
                    if (squared < nearest) sum_x = sum_z = 0.0;
                    nearest = squared;
                    sum_x += map.normals[3 * other];
                    sum_z += map.normals[3 * other + 2];
                }
            }
            const auto texel = static_cast<std::size_t>(y * map.width + x);
            if (nearest > texels * texels) {
                EXPECT_EQ(filled.states[texel], TexelState::empty);
                continue;
            }
            EXPECT_EQ(filled.states[texel], nearest == 0 ? TexelState::baked : TexelState::padded);
            const double length = std::hypot(sum_x, sum_z);
            ASSERT_NEAR(filled.normals[3 * texel], sum_x / length, 1e-6) << x << " " << y;
            ASSERT_NEAR(filled.normals[3 * texel + 2], sum_z / length, 1e-6);
        }
    }
}

TEST(Dilation, IsTheSameInStripsOfAnySize) {
    const Map map = sparse(40, 500, 200);
    for (const int texels : {0, 1, 30, 100, 700}) {
        const Map whole = dilated(map, texels, 500);
        EXPECT_EQ(dilated(map, texels, 64).normals, whole.normals) << texels;
        EXPECT_EQ(dilated(map, texels, 192).heights, whole.heights) << texels;
    }
    EXPECT_EQ(dilated(map, 0, 64).normals, map.normals);
}

/// A layer that was not requested does not exist, and the other layers do not change.
TEST(Dilation, FillsTheLayersThatThereAre) {
    Map map = sparse(50, 130, 80);
    const Map all = dilated(map, 9, 64);
    std::vector<float> heights;
    Dilation dilation(map.width, map.height, 9, [&](const BakedRows& rows) {
        EXPECT_TRUE(rows.normals.empty());
        heights.insert(heights.end(), rows.heights.begin(), rows.heights.end());
    });
    dilation.push({0, map.height, {}, map.heights, map.states});
    EXPECT_EQ(heights, all.heights);
}

/// A receiver may modify its rows. The following rows are filled from the baked values.
TEST(Dilation, DoesNotReadEmittedRows) {
    const Map map = sparse(40, 400, 300);
    std::vector<float> heights;
    Dilation dilation(map.width, map.height, 50, [&](const BakedRows& rows) {
        heights.insert(heights.end(), rows.heights.begin(), rows.heights.end());
        std::fill(rows.heights.begin(), rows.heights.end(), -1.0F);
        std::fill(rows.states.begin(), rows.states.end(), TexelState::empty);
    });
    Map pushed = map;
    for (int row = 0; row < map.height; row += 64) {
        const int count = std::min(64, map.height - row);
        const auto first = static_cast<std::size_t>(row * map.width);
        const auto texels = static_cast<std::size_t>(count * map.width);
        dilation.push({row,
                       count,
                       {},
                       std::span(pushed.heights).subspan(first, texels),
                       std::span(pushed.states).subspan(first, texels)});
    }
    EXPECT_EQ(heights, dilated(map, 50, 400).heights);
}

/// A few baked texels; the share is 1 / one_in.
BakedImage sparse(std::size_t texels, unsigned one_in) {
    BakedImage image;
    std::mt19937 random(7);
    for (std::size_t i = 0; i < texels; ++i) {
        const bool is_baked = random() % one_in == 0;
        image.states.push_back(is_baked ? TexelState::baked : TexelState::empty);
        const float height = static_cast<float>(random() % 100);
        image.heights.push_back(is_baked ? height : 0.0F);
        const glm::vec3 normal = glm::normalize(glm::vec3(height, 1.0F, 50.0F));
        for (int axis = 0; axis < 3; ++axis)
            image.normals.push_back(is_baked ? normal[axis] : 0.0F);
    }
    return image;
}

/// Passes a map to a filler, several rows at a time.
template <typename Filler>
void push(BakedImage image, int width, int height, int rows_at_once, Filler& filler) {
    for (int row = 0; row < height; row += rows_at_once) {
        BakedRows rows;
        rows.first_row = row;
        rows.row_count = std::min(rows_at_once, height - row);
        const auto first = static_cast<std::size_t>(row * width);
        const auto count = static_cast<std::size_t>(rows.row_count * width);
        rows.normals = std::span(image.normals).subspan(3 * first, 3 * count);
        if (!image.heights.empty()) rows.heights = std::span(image.heights).subspan(first, count);
        rows.states = std::span(image.states).subspan(first, count);
        filler.push(rows);
    }
}

BakedImage filled(const BakedImage& image, int width, int height, int rows_at_once,
                  const test::TemporaryDirectory& folder) {
    BakedImage result;
    BorderFill fill(width, height, folder / ".", [&](const BakedRows& rows) {
        EXPECT_TRUE(rows.row_count == 64 || rows.first_row + rows.row_count == height);
        test::append(result, rows);
    });
    push(image, width, height, rows_at_once, fill);
    EXPECT_TRUE(std::filesystem::is_empty(folder / "."));
    return result;
}

TEST(BorderFill, IsPaddingWithoutALimit) {
    const test::TemporaryDirectory folder;
    for (const auto& [width, height, one_in] :
         {std::tuple(61, 150, 60U), {200, 300, 9000U}, {1, 130, 40U}, {90, 1, 30U}}) {
        const BakedImage image = sparse(static_cast<std::size_t>(width * height), one_in);
        ASSERT_GT(image.count(TexelState::baked), 0U);
        BakedImage padded;
        Dilation dilation(width, height, 1024,
                          [&](const BakedRows& rows) { test::append(padded, rows); });
        push(image, width, height, 64, dilation);
        const BakedImage result = filled(image, width, height, 64, folder);
        EXPECT_EQ(result.normals, padded.normals) << width;
        EXPECT_EQ(result.heights, padded.heights);
        EXPECT_EQ(result.states, padded.states);
        EXPECT_EQ(result.count(TexelState::empty), 0U);
        EXPECT_EQ(filled(image, width, height, 128, folder).normals, padded.normals);
    }
}

TEST(BorderFill, KeepsAbsentLayersEmptyAndUnbakedMapsUnchanged) {
    const test::TemporaryDirectory folder;
    BakedImage image = sparse(64 * 70, 500);
    const BakedImage all = filled(image, 64, 70, 64, folder);
    image.heights.clear();
    const BakedImage without = filled(image, 64, 70, 64, folder);
    EXPECT_EQ(without.normals, all.normals);
    EXPECT_TRUE(without.heights.empty());
    image.states.assign(image.states.size(), TexelState::missed);
    const BakedImage none = filled(image, 64, 70, 64, folder);
    EXPECT_EQ(none.states, image.states);
    EXPECT_EQ(none.normals, image.normals);
}

TEST(BorderFill, ReachesTheBorderOfABake) {
    const test::TemporaryDirectory folder;
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord = glm::vec2(0.4F) + 0.1F * texcoord;
    Mesh high = make_quad();
    high.normals.assign(4, glm::normalize(glm::vec3(0.6F, 0, 0.8F)));
    BakeOptions options = test::sized(100, 90);
    options.map.border_folder = folder / ".";
    const BakedImage image = test::bake({high}, low, options);
    EXPECT_EQ(image.count(TexelState::baked), 90U);
    EXPECT_EQ(image.count(TexelState::padded), 100U * 90U - 90U);
    for (const std::size_t corner : {0UL, 99UL, 8900UL, 8999UL})
        EXPECT_NEAR(image.normal(corner).x, 0.6, 1e-6);
    options.map.padding = 1;
    EXPECT_EQ(test::message_of<InvalidInput>([&] { test::bake({high}, low, options); }),
              "filling a map to its border needs all rows and a padding of 0");
    options = test::sized(40000, 1);
    options.map.border_folder = folder / ".";
    EXPECT_EQ(test::message_of<InvalidInput>([&] { test::bake({high}, low, options); }),
              "a map of 40000 x 1 texels is too large to be filled: 32768");
    options = test::sized(4, 4);
    options.map.border_folder = folder / "none";
    EXPECT_THAT(test::message_of<FileError>([&] { test::bake({high}, low, options); }),
                testing::HasSubstr("none: no temporary file can be made: No such file"));
}

}  // namespace
}  // namespace relief
