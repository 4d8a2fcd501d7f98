// SPDX-License-Identifier: Apache-2.0
// Every row of the catalogue, and the invariants of tangents on
// thousands of random meshes in which many things are wrong at once.
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <set>

#include "hard_cases/hard_cases.h"
#include "hard_cases/mesh_case.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "support/invariants.h"

namespace relief::test {
namespace {

class HardCases : public testing::TestWithParam<HardCase> {};

TEST_P(HardCases, HaveTheirOutcome) {
    ASSERT_FALSE(GetParam().expectations.empty());
    for (const Expectation& expectation : GetParam().expectations)
        EXPECT_EQ(expectation.problem(), "") << expectation.step << ": " << expectation.outcome;
}

std::string test_name(const testing::TestParamInfo<HardCase>& row) {
    std::string name;
    for (const char letter : row.param.name)
        name += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
    return name + "_" + std::to_string(row.index);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, HardCases, testing::ValuesIn(hard_cases()), test_name);

TEST(HardCasesTable, NamesEachRowOnceAndSaysWhereItIsKnownFrom) {
    std::set<std::string> names;
    for (const HardCase& row : hard_cases()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_FALSE(row.what.empty()) << row.name;
        EXPECT_FALSE(row.source.empty()) << row.name;
    }
}

TEST(HardCasesTable, HasARowForEveryWordOfCheck) {
    std::string all;
    for (const HardCase& row : hard_cases()) {
        for (const Expectation& expectation : row.expectations) {
            if (expectation.step == "check") all += expectation.outcome + ",";
        }
    }
    for (const MeshConditionInfo& condition : mesh_conditions())
        EXPECT_NE(all.find("x " + std::string(condition.word) + ","), std::string::npos)
            << condition.word;
}

/// Random values. The standard distributions differ between libraries, so the class has its own.
/// The order of calls determines the values; braced initializers keep it.
class Dice {
  public:
    explicit Dice(std::uint32_t seed) : generator_(seed) {}

    std::uint32_t below(std::uint32_t limit) {
        return static_cast<std::uint32_t>(generator_()) % limit;
    }
    bool one_in(std::uint32_t n) { return below(n) == 0; }

    /// Returns a multiple of 1/4 from -1 to 1, so that values often coincide and cancel.
    float common() { return 0.25F * static_cast<float>(below(9)) - 1.0F; }

    /// Returns a value from -1 to 1 with random digits.
    float any_digits() { return static_cast<float>(generator_()) * 0x1p-31F - 1.0F; }

    float special() {
        constexpr float values[] = {-0.0F,
                                    0x1p-149F,
                                    -0x1.8p-130F,
                                    1e-38F,
                                    -1e-25F,
                                    1e-18F,
                                    1e6F,
                                    -1e20F,
                                    1e25F,
                                    std::numeric_limits<float>::max(),
                                    -std::numeric_limits<float>::max(),
                                    std::numeric_limits<float>::infinity(),
                                    std::numeric_limits<float>::quiet_NaN()};
        return values[below(std::size(values))];
    }

    /// \param rarity  one value in `rarity` is special
    float value(std::uint32_t rarity, bool is_common) {
        if (one_in(rarity)) return special();
        return is_common ? common() : any_digits();
    }

  private:
    std::mt19937 generator_;
};

/// The choice of random values for one mesh.
struct Temper {
    std::uint32_t rarity;
    bool is_common;
    float position_scale;
    float position_offset;
    float texture_scale;
    float texture_offset;
    float normal_scale;
};

Temper temper(Dice& dice) {
    constexpr float scales[] = {1, 1, 1, 1, 1e-30F, 1e-18F, 1e18F, 1e30F};
    constexpr float offsets[] = {0, 0, 0, 1e6F};
    const auto scale = [&] { return scales[dice.below(std::size(scales))]; };
    const auto offset = [&] { return offsets[dice.below(std::size(offsets))]; };
    const std::uint32_t rarity = dice.one_in(2) ? 1U << 30 : dice.one_in(2) ? 40 : 6;
    return {rarity, dice.one_in(2), scale(), offset(), scale(), offset(), scale()};
}

void add_vertex(Mesh& mesh, const Temper& temper, Dice& dice) {
    const auto draw = [&] { return dice.value(temper.rarity, temper.is_common); };
    mesh.positions.push_back(temper.position_scale * glm::vec3{draw(), draw(), draw()} +
                             temper.position_offset);
    mesh.normals.push_back(temper.normal_scale * glm::vec3{draw(), draw(), draw()});
    mesh.texcoords.push_back(temper.texture_scale * glm::vec2{draw(), draw()} +
                             temper.texture_offset);
    if (mesh.positions.size() == 1 || !dice.one_in(2)) return;
    const std::uint32_t other = dice.below(static_cast<std::uint32_t>(mesh.positions.size() - 1));
    if (!dice.one_in(3)) mesh.positions.back() = mesh.positions[other];
    if (!dice.one_in(3)) mesh.normals.back() = mesh.normals[other];
    if (!dice.one_in(3)) mesh.texcoords.back() = mesh.texcoords[other];
}

void add_triangle(Mesh& mesh, Dice& dice) {
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    glm::uvec3 triangle{dice.below(count), dice.below(count), dice.below(count)};
    if (!mesh.triangles.empty() && !dice.one_in(3)) {
        // The triangle shares an edge with the last one, in either direction. Sometimes it is the
        // same triangle.
        const glm::uvec3& last = mesh.triangles.back();
        triangle = dice.one_in(3) ? glm::uvec3(last.x, last.y, triangle.z)
                                  : glm::uvec3(last.z, last.y, triangle.z);
        if (dice.one_in(8)) triangle = {last.y, last.z, last.x};
    }
    mesh.triangles.push_back(triangle);
}

Mesh hostile_mesh(std::uint32_t seed) {
    Dice dice(seed);
    const Temper how = temper(dice);
    Mesh mesh;
    const std::uint32_t vertices = 1 + dice.below(12);
    for (std::uint32_t v = 0; v < vertices; ++v)
        add_vertex(mesh, how, dice);
    const std::uint32_t triangles = dice.below(25);
    for (std::uint32_t t = 0; t < triangles; ++t)
        add_triangle(mesh, dice);
    return mesh;
}

constexpr std::uint32_t mesh_count = 10000;

class HostileMeshes : public testing::TestWithParam<NamedTangentMethod> {};

TEST_P(HostileMeshes, HaveSoundTangentsWithTheSameBitsInAnyOrder) {
    for (std::uint32_t seed = 0; seed < mesh_count; ++seed) {
        const Mesh mesh = hostile_mesh(seed);
        const auto tangents = tangents_of(mesh, GetParam());
        ASSERT_EQ(broken_tangents(mesh, tangents), "") << "seed " << seed;
        const std::size_t count = mesh.triangles.size();
        for (const auto& order : {reversed(count), shuffled(count, seed), shuffled(count, ~seed)}) {
            const auto again = tangents_of(with_triangle_order(mesh, order), GetParam());
            ASSERT_TRUE(same_bits(again, corners_in_order(tangents, order))) << "seed " << seed;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(EveryMethod, HostileMeshes, testing::ValuesIn(all_tangent_methods()),
                         [](const auto& method) {
                             std::string name = method.param.name;
                             for (char& letter : name)
                                 letter = letter == '-' ? '_' : letter;
                             return name;
                         });

TEST(HostileMeshesThemselves, HoldEveryKindOfTrouble) {
    std::vector<std::size_t> meshes_with(mesh_conditions().size());
    for (std::uint32_t seed = 0; seed < 500; ++seed) {
        Mesh mesh = hostile_mesh(seed);
        for (const MeshConditionCount& found : diagnose(mesh).found)
            ++meshes_with[static_cast<std::size_t>(found.condition)];
    }
    for (const MeshConditionInfo& condition : mesh_conditions()) {
        if (condition.element == "vertex" && condition.word.find("tangent") != std::string::npos)
            continue;  // These meshes store no tangents.
        EXPECT_GT(meshes_with[static_cast<std::size_t>(condition.condition)], 0U) << condition.word;
    }
}

}  // namespace
}  // namespace relief::test
