// SPDX-License-Identifier: Apache-2.0
// relief-bake convert --to-object and --to-tangent as users run them: there and back, by the mesh's
// own tangents and new ones, and how they refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/image_file.h"
#include "tools/refusal.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::bricks_map;
using test::expect_refusal;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// The greatest difference of two files' samples, in codes.
int largest_difference(const Workplace& workplace, const char* a, const std::filesystem::path& b) {
    const Image one = read_image(workplace / a, ImageUse::data);
    const Image other = read_image(workplace / b, ImageUse::data);
    EXPECT_EQ(one.sample_count(), other.sample_count());
    int largest = 0;
    for (std::size_t i = 0; i < one.sample_count(); ++i)
        largest =
            std::max(largest, std::abs(one.as<std::uint16_t>()[i] - other.as<std::uint16_t>()[i]));
    return largest;
}

TEST(ConvertSpace, ThereAndBackIsTheSameMapToTheCode) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ASSERT_EQ(workplace
                  .run("relief-bake convert " + bricks_map +
                       " out/map.png --bits 16 --zero-code 128 "
                       "--normalize --quiet")
                  .exit_code,
              0);
    for (const char* mesh : {"square.obj", "data/scenes/knot.glb", "data/vase.obj"}) {
        const std::string outside = " --outside repeat";
        const ProgramResult there = workplace.run(
            std::string("relief-bake convert out/map.png out/object.png --input-green "
                        "up --to-object ") +
            mesh + outside);
        ASSERT_EQ(there.exit_code, 0) << there.error;
        EXPECT_THAT(there.out, HasSubstr(std::string("to the object space of ") + mesh));
        EXPECT_THAT(there.out, HasSubstr("object space\n"));
        EXPECT_EQ(read_image_info(workplace / "out/object.png").metadata.at("relief:content"),
                  "normal map, object space");
        const ProgramResult back = workplace.run(
            std::string("relief-bake convert out/object.png out/back.png --to-tangent ") + mesh +
            outside);
        ASSERT_EQ(back.exit_code, 0) << back.error;
        EXPECT_EQ(read_image_info(workplace / "out/back.png").metadata.at("relief:content"),
                  "normal map, tangent space");
        if (back.out.find("100.0 % of the map") == std::string::npos) continue;
        EXPECT_LE(largest_difference(workplace, "out/map.png", "out/back.png"), 4) << mesh;
    }
}

TEST(ConvertSpace, TurnsGreenAsAskedFor) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    // The image upright on the square: its object space is tangent space with green up.
    for (const char* green : {"up", "down"}) {
        const std::string flat = " --bits 16 --zero-code 128 --quiet";
        ASSERT_EQ(workplace
                      .run("relief-bake convert " + bricks_map +
                           " out/tangent.png --input-green up "
                           "--green " +
                           green + flat)
                      .exit_code,
                  0);
        ASSERT_EQ(workplace
                      .run("relief-bake convert out/tangent.png out/object.png --to-object "
                           "square.obj" +
                           flat)
                      .exit_code,
                  0);
        ASSERT_EQ(workplace
                      .run("relief-bake convert out/object.png out/back.png --to-tangent "
                           "square.obj --green " +
                           std::string(green) + flat)
                      .exit_code,
                  0);
        EXPECT_LE(largest_difference(workplace, "out/tangent.png", "out/back.png"), 2) << green;
    }
}

TEST(ConvertSpace, TellsTheMeshesOwnTangentsFromNewOnes) {
    const Workplace workplace;
    const std::string line = "relief-bake convert " + bricks_map +
                             " out/object.png --input-green up --to-object data/scenes/knot.glb";
    EXPECT_THAT(workplace.run(line + " --tangents lengyel").out,
                HasSubstr(", with new tangents; "));
    ASSERT_EQ(workplace
                  .run("relief-mesh process data/scenes/knot.glb out/own.glb --tangents "
                       "mikktspace --quiet")
                  .exit_code,
              0);
    EXPECT_THAT(workplace
                    .run("relief-bake convert " + bricks_map +
                         " out/object.png --input-green up "
                         "--to-object out/own.glb")
                    .out,
                HasSubstr(", with its own tangents; "));
}

TEST(ConvertSpace, RefusesWhatCannotBe) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write_square("bare.obj", true);
    const std::string start = "relief-bake convert " + bricks_map + " out/old.png ";
    const std::string no_green = start + "--to-object square.obj";
    const std::string bare = start + "--input-green up --to-object bare.obj";
    const std::string missing = start + "--input-green up --to-object missing.obj";
    const std::string both = start + "--to-object square.obj --to-tangent square.obj";
    const std::string useless = start + "--udim 1002";
    const std::string green = start + "--to-object square.obj --green down";
    for (const auto& [line, code, message] :
         {test::Refused{no_green.c_str(), 1,
                        "data/scenes/bricks-normal.png: where its green is bright is not known "
                        "(give --input-green)"},
          test::Refused{bare.c_str(), 1, "bare.obj: no texture coordinates (unwrap it first)"},
          test::Refused{missing.c_str(), 1, "missing.obj: "},
          test::Refused{both.c_str(), 2, "--to-object, --to-tangent: contradict each other"},
          test::Refused{useless.c_str(), 2,
                        "--udim: has no effect without --to-object or --to-tangent"},
          test::Refused{green.c_str(), 2, "--green, --to-object: object space has no green"}}) {
        expect_refusal(workplace, "relief-bake", {line, code, message}, "old.png");
    }
}

}  // namespace
}  // namespace relief::tools
