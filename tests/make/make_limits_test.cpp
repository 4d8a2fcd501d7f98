// SPDX-License-Identifier: Apache-2.0
// The limits of `relief make`: --max-error and --max-picture-error.
#include "make_limits.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/labels.h"
#include "support/shapes.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

LimitAttempt exceeding_attempt(std::size_t triangles, int size, double silhouettes, double ratio) {
    LimitAttempt attempt;
    attempt.triangles = triangles;
    attempt.size = glm::ivec2(size);
    attempt.silhouettes = silhouettes;
    attempt.exceeded = LossLimit::degrees;
    attempt.ratio = ratio;
    return attempt;
}

TEST(LossLimits, ApplyToThePrintedFigures) {
    shade::Fidelity loss;
    loss.normals.mean = 2.00004;
    loss.pictures[1].mean = 0.09;
    LossLimits limits;
    limits.normals = {2.0, ErrorKind::mean};
    EXPECT_FALSE(attempt_of(loss, limits, 100, {64, 64}, 8).exceeded) << "2.0000 is printed";
    limits.flip = 0.05;
    const LimitAttempt attempt = attempt_of(loss, limits, 100, {64, 64}, 8);
    EXPECT_EQ(attempt.exceeded, LossLimit::flip);
    EXPECT_DOUBLE_EQ(attempt.ratio, 0.09 / 0.05);
    limits.normals.degrees = 0.5;
    EXPECT_EQ(attempt_of(loss, limits, 100, {64, 64}, 8).exceeded, LossLimit::degrees);
}

constexpr GrowthStep twice_triangles{Growth::triangles, 2};
constexpr GrowthStep twice_size{Growth::size, 2};

TEST(LossLimits, GrowWhatDominatesAndHelps) {
    const LossLimits limits;
    std::vector<LimitAttempt> attempts = {exceeding_attempt(100, 64, 1.0, 2.0)};
    EXPECT_EQ(next_growth(attempts, limits, 1000), twice_triangles) << "wide silhouettes";
    attempts.front().silhouettes = 0.1;
    EXPECT_EQ(next_growth(attempts, limits, 1000), twice_size);
    attempts.front().next = twice_size;
    attempts.push_back(exceeding_attempt(100, 128, 0.1, 1.9));
    EXPECT_EQ(next_growth(attempts, limits, 1000), twice_triangles) << "larger maps did not help";
    attempts.back().ratio = 1.5;
    EXPECT_EQ(next_growth(attempts, limits, 1000), twice_size);
}

TEST(LossLimits, GrowByFourWhereTwoCannotSuffice) {
    const LossLimits limits;
    // Twice the triangles at most halve an error, and maps of twice the size at most quarter it.
    const auto next = [&](double silhouettes, double ratio, std::size_t max_triangles) {
        return next_growth({exceeding_attempt(100, 64, silhouettes, ratio)}, limits, max_triangles);
    };
    EXPECT_EQ(next(1.0, 2.1, 1000), (GrowthStep{Growth::triangles, 4}));
    EXPECT_EQ(next(1.0, 2.1, 150), twice_triangles) << "the source has no more";
    EXPECT_EQ(next(0.1, 3.9, 1000), twice_size);
    EXPECT_EQ(next(0.1, 4.1, 1000), (GrowthStep{Growth::size, 4}));
}

TEST(LossLimits, UseSixteenBitsIfTheCodesExceedTheLimit) {
    LossLimits limits;
    limits.normals = {2.0, ErrorKind::p99};
    shade::Fidelity loss;
    loss.normals.p99 = 2.3;
    LimitAttempt attempt = attempt_of(loss, limits, 100, {64, 64}, 8);
    EXPECT_TRUE(may_be_codes(attempt, limits));
    EXPECT_EQ(next_growth({attempt}, limits, 1000), twice_size) << "not measured";
    shade::NormalLoss coded, baked;
    coded.p99 = 2.4;
    baked.p99 = 2.2;
    note_baked(attempt, limits, coded, baked);
    EXPECT_EQ(attempt.baked_degrees, 2.1);
    EXPECT_EQ(next_growth({attempt}, limits, 1000), twice_size) << "the codes are not enough";
    baked.p99 = 2.0;
    note_baked(attempt, limits, coded, baked);
    attempt.next = next_growth({attempt}, limits, 1000);
    EXPECT_EQ(attempt.next, (GrowthStep{Growth::bits, 2}));
    EXPECT_THAT(
        limit_lines(limits, {attempt}).front(),
        HasSubstr("2.3000 degrees (99 %), FLIP 0.0000; 1.9000 degrees before the codes; more "
                  "than --max-error; next normals of 16 bits"));
    // The next step after 16 bits does not depend on how much they helped.
    LimitAttempt fine = attempt_of(loss, limits, 100, {64, 64}, 16);
    EXPECT_FALSE(may_be_codes(fine, limits));
    EXPECT_EQ(next_growth({attempt, fine}, limits, 1000), twice_size);
    // A larger excess is not that of codes, and neither is that of pictures.
    loss.normals.p99 = 2.5;
    EXPECT_FALSE(may_be_codes(attempt_of(loss, limits, 100, {64, 64}, 8), limits));
    limits.flip = 0.01;
    loss.normals.p99 = 2.3;
    loss.pictures[0].mean = 0.1;
    EXPECT_FALSE(may_be_codes(attempt_of(loss, limits, 100, {64, 64}, 8), limits));
}

TEST(LossLimits, EndAtTheirBounds) {
    const LossLimits limits;
    std::vector<LimitAttempt> attempts = {exceeding_attempt(1000, 64, 1.0, 2.0)};
    EXPECT_EQ(next_growth(attempts, limits, 1000), twice_size)
        << "the source has no more triangles";
    attempts.front().size = glm::ivec2(max_limit_size);
    EXPECT_EQ(next_growth(attempts, limits, 1000), std::nullopt);
    EXPECT_EQ(next_growth(attempts, limits, 1001), twice_triangles);
    attempts.assign(max_attempts, exceeding_attempt(100, 64, 1.0, 4.0));
    for (LimitAttempt& attempt : attempts)
        attempt.next = twice_triangles;
    EXPECT_EQ(next_growth(attempts, limits, 1000), std::nullopt);
}

/// Writes a sphere with ripples of about 4,000 triangles.
void write_rippled_sphere(const Workplace& workplace, const std::string& name) {
    const Mesh mesh = test::sphere(64, 32);
    std::string text;
    for (glm::vec3 position : mesh.positions) {
        position *= 1.0F + 0.03F * std::sin(12.0F * position.x) * std::sin(12.0F * position.y);
        text += fmt::format("v {} {} {}\n", position.x, position.y, position.z);
    }
    for (const glm::uvec3& triangle : mesh.triangles)
        text += fmt::format("f {} {} {}\n", triangle.x + 1, triangle.y + 1, triangle.z + 1);
    workplace.write(name, text);
}

constexpr const char* coarse = " --triangles 100 --size 32 --padding 2 --occlusion-rays 0";

TEST_LABELS(slow, not_sanitized);
TEST(MakeLimits, ChooseTrianglesAndMapsThatHoldThem) {
    const Workplace workplace;
    write_rippled_sphere(workplace, "out/ball.obj");
    const std::string line = std::string("relief make out/ball.obj -o out/ball.glb") + coarse;
    const ProgramResult result =
        workplace.run(line + " --max-error 3 --max-error-kind mean --report out/ball.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("--max-error 3 held"));
    EXPECT_THAT(result.out, HasSubstr("more than --max-error; next "));
    const auto report = nlohmann::json::parse(workplace.read("out/ball.json"));
    EXPECT_LE(report["loss"]["figures"][3]["mean"].get<double>(), 3.00005);
    const auto& attempts = report["limits"]["attempts"];
    ASSERT_GE(attempts.size(), 2U);
    EXPECT_EQ(attempts[0]["triangles"], 100);
    EXPECT_EQ(attempts[0]["exceeded"], "max_error");
    const auto& last = attempts.back();
    EXPECT_EQ(last["exceeded"], nullptr);
    EXPECT_EQ(report["maps"][0]["width"], last["size"][0]);
    EXPECT_NEAR(report["triangles"].get<double>(), last["triangles"].get<double>(), 2.0);
    // Each stage is listed once, with the time of all attempts.
    EXPECT_EQ(report["stages"].size(), 10U);
    EXPECT_THAT(report["command"].get<std::string>(),
                HasSubstr(" --max-error 3 --max-error-kind mean"));
}

TEST_LABELS(slow, not_sanitized);
TEST(MakeLimits, CodeNormalsWithSixteenBitsIfThatSuffices) {
    const Workplace workplace;
    workplace.write_square("out/square.obj");
    // The codes of 8 bits are 0.32 degrees from flat.
    const std::string line =
        "relief make out/square.obj -o out/a.glb --size 32 --padding 2 --occlusion-rays 0 "
        "--max-error 0.2 --report out/a.json";
    const ProgramResult result = workplace.run(line);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("; next normals of 16 bits"));
    const auto report = nlohmann::json::parse(workplace.read("out/a.json"));
    const auto& attempts = report["limits"]["attempts"];
    ASSERT_EQ(attempts.size(), 2U);
    EXPECT_EQ(attempts[0]["next"], "bits");
    EXPECT_GT(attempts[0]["degrees"].get<double>(), 0.2);
    EXPECT_EQ(attempts[1]["normal_bits"], 16);
    EXPECT_EQ(attempts[1]["size"], attempts[0]["size"]);
    EXPECT_EQ(report["maps"][0]["bits"], 16);
    // It is the asset that --normal-bits 16 makes.
    std::filesystem::create_directory(workplace / "out/b");
    ASSERT_EQ(workplace
                  .run("relief make out/square.obj -o out/b/a.glb --size 32 --padding 2 "
                       "--occlusion-rays 0 --normal-bits 16")
                  .exit_code,
              0);
    EXPECT_EQ(workplace.read("out/a.glb"), workplace.read("out/b/a.glb"));
}

TEST_LABELS(slow, not_sanitized);
TEST(MakeLimits, EndWithWhatWasReached) {
    const Workplace workplace;
    write_rippled_sphere(workplace, "out/ball.obj");
    workplace.write("out/ball.glb", "old");
    const ProgramResult result =
        workplace.run(std::string("relief make out/ball.obj -o out/ball.glb") + coarse +
                      " --max-error 30 --max-picture-error 0.0001");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error,
                HasSubstr("out/ball.obj: --max-error 30 and --max-picture-error 0.0001 cannot be "
                          "held: the best of 6 attempts has "));
    EXPECT_THAT(result.error, HasSubstr("degrees (99 %), FLIP "));
    EXPECT_EQ(workplace.read("out/ball.glb"), "old");
    EXPECT_EQ(workplace.outputs(), "ball.glb ball.obj");
}

}  // namespace
}  // namespace relief::tools
