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
    EXPECT_FALSE(attempt_of(loss, limits, 100, {64, 64}).exceeded) << "2.0000 is printed";
    limits.flip = 0.05;
    const LimitAttempt attempt = attempt_of(loss, limits, 100, {64, 64});
    EXPECT_EQ(attempt.exceeded, LossLimit::flip);
    EXPECT_DOUBLE_EQ(attempt.ratio, 0.09 / 0.05);
    limits.normals.degrees = 0.5;
    EXPECT_EQ(attempt_of(loss, limits, 100, {64, 64}).exceeded, LossLimit::degrees);
}

TEST(LossLimits, GrowWhatDominatesAndHelps) {
    std::vector<LimitAttempt> attempts = {exceeding_attempt(100, 64, 1.0, 4.0)};
    EXPECT_EQ(next_growth(attempts, 1000), Growth::triangles) << "wide silhouettes";
    attempts.front().silhouettes = 0.1;
    EXPECT_EQ(next_growth(attempts, 1000), Growth::size);
    attempts.front().next = Growth::size;
    attempts.push_back(exceeding_attempt(100, 128, 0.1, 3.9));
    EXPECT_EQ(next_growth(attempts, 1000), Growth::triangles) << "larger maps did not help";
    attempts.back().ratio = 2.0;
    EXPECT_EQ(next_growth(attempts, 1000), Growth::size);
}

TEST(LossLimits, EndAtTheirBounds) {
    std::vector<LimitAttempt> attempts = {exceeding_attempt(1000, 64, 1.0, 4.0)};
    EXPECT_EQ(next_growth(attempts, 1000), Growth::size) << "the source has no more triangles";
    attempts.front().size = glm::ivec2(max_limit_size);
    EXPECT_EQ(next_growth(attempts, 1000), std::nullopt);
    EXPECT_EQ(next_growth(attempts, 1001), Growth::triangles);
    attempts.assign(max_attempts, exceeding_attempt(100, 64, 1.0, 4.0));
    for (LimitAttempt& attempt : attempts)
        attempt.next = Growth::triangles;
    EXPECT_EQ(next_growth(attempts, 1000), std::nullopt);
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
    EXPECT_THAT(result.out, HasSubstr("more than --max-error; next twice the "));
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
    EXPECT_EQ(report["stages"].size(), 9U);
    EXPECT_THAT(report["command"].get<std::string>(),
                HasSubstr(" --max-error 3 --max-error-kind mean"));
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
