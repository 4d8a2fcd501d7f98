// SPDX-License-Identifier: Apache-2.0
// What `relief-bake bump` takes by itself, what it keeps within a bound, and what it prints of
// both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "relief/mesh/bump_fields.h"
#include "relief/mesh/image_file.h"
#include "tools/refusal.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// A field in a file, and the strength that belongs to it.
BumpField write_field(const Workplace& workplace, const std::string& name, FieldCoding coding) {
    BumpField field = make_bump_field({"", FieldShape::waves, 32.0, 0.3, coding, 0.0, 5}, 160, 128);
    write_image(workplace / name, field.heights);
    return field;
}

std::string strength_of(const BumpField& field) {
    return " --strength " + std::to_string(field.options.strength);
}

double error_of(const Workplace& workplace, const std::string& name, const BumpField& field) {
    Report report;
    const Image normals = decode_normal_map(read_image(workplace / name, ImageUse::data), Green::up,
                                            FlatCode::half, report);
    return field_error(normals, field).rms;
}

TEST(BumpAccuracyCommand, TakesTheKernelThatTheMapCallsForAndSaysWhy) {
    const Workplace workplace;
    const BumpField coarse = write_field(workplace, "coarse.png", FieldCoding::bits8);
    const BumpField fine = write_field(workplace, "fine.png", FieldCoding::bits16);
    const ProgramResult of_coarse = workplace.run("relief-bake bump coarse.png out/c.png" +
                                                  strength_of(coarse) + " --report out/c.json");
    ASSERT_EQ(of_coarse.exit_code, 0) << of_coarse.error;
    EXPECT_THAT(of_coarse.out, HasSubstr("slopes    gaussian of radius "));
    EXPECT_THAT(of_coarse.out, HasSubstr("because   8 bits used: steps of 0."));
    const json report = json::parse(workplace.read("out/c.json"));
    EXPECT_EQ(report["kernel"], "gaussian");
    EXPECT_THAT(report["kernel_reason"].get<std::string>(), HasSubstr("8 bits used"));
    EXPECT_EQ(report["destaircased_step"], nullptr);
    const ProgramResult of_fine =
        workplace.run("relief-bake bump fine.png out/f.png" + strength_of(fine));
    EXPECT_THAT(of_fine.out, HasSubstr("slopes    central"));
    EXPECT_THAT(of_fine.out, HasSubstr("because   16 bits used: detail outweighs"));

    // Truer than what was the default.
    ASSERT_EQ(
        workplace.run("relief-bake bump coarse.png out/s.png --kernel sobel3" + strength_of(coarse))
            .exit_code,
        0);
    EXPECT_LT(2.0 * error_of(workplace, "out/c.png", coarse),
              error_of(workplace, "out/s.png", coarse));
}

TEST(BumpAccuracyCommand, DestaircasingGainsOnA8BitMap) {
    const Workplace workplace;
    const BumpField field = write_field(workplace, "h.png", FieldCoding::bits8);
    const std::string line = "relief-bake bump h.png" + strength_of(field);
    ASSERT_EQ(workplace.run(line + " out/plain.png").exit_code, 0);
    const ProgramResult smooth =
        workplace.run(line + " out/smooth.png --destaircase --report out/r.json");
    ASSERT_EQ(smooth.exit_code, 0) << smooth.error;
    EXPECT_THAT(smooth.out, HasSubstr("steps     smoothed away: of 1/255, heights moved by half"));
    EXPECT_NEAR(json::parse(workplace.read("out/r.json"))["destaircased_step"].get<double>(),
                1.0 / 255.0, 1e-12);
    EXPECT_LT(1.2 * error_of(workplace, "out/smooth.png", field),
              error_of(workplace, "out/plain.png", field));
}

TEST(BumpAccuracyCommand, KeepsWithinABoundAtTheLeastCost) {
    const Workplace workplace;
    const BumpField field = write_field(workplace, "h.png", FieldCoding::bits16);
    const std::string line = "relief-bake bump h.png" + strength_of(field);
    const ProgramResult loose = workplace.run(line + " out/a.png --max-error 0.5");
    ASSERT_EQ(loose.exit_code, 0) << loose.error;
    EXPECT_THAT(loose.out, HasSubstr(", 8 bit: 0."));
    EXPECT_EQ(read_image(workplace / "out/a.png", ImageUse::data).bits(), 8);
    const ProgramResult tight = workplace.run(line + " out/b.png --max-error 0.02 --report out/r");
    ASSERT_EQ(tight.exit_code, 0) << tight.error;
    EXPECT_EQ(read_image(workplace / "out/b.png", ImageUse::data).bits(), 16);
    const json report = json::parse(workplace.read("out/r"));
    EXPECT_LE(report["kept"]["degrees"]["rms"].get<double>(), 0.02);
    EXPECT_EQ(report["kept"]["kernel"], report["kernel"]);
    EXPECT_EQ(report["bits"], 16);
    EXPECT_TRUE(report["reference"]["whole"].get<bool>());
    // What the command line fixes stays.
    const ProgramResult fixed =
        workplace.run(line + " out/c.png --max-error 2 --bits 16 --kernel scharr3");
    EXPECT_THAT(fixed.out, HasSubstr("kept      scharr3 in float32, 16 bit: "));
    // Nothing is written where nothing keeps to it.
    const ProgramResult none =
        workplace.run(line + " out/d.png --max-error 0.02 --max-error-kind max --bits 8");
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_THAT(none.error, HasSubstr("h.png: no way to convert it keeps within 0.02 degrees "
                                      "(greatest): "));
    EXPECT_THAT(workplace.outputs(), testing::Not(HasSubstr("d.png")));
}

TEST(BumpAccuracyCommand, ALimitIsForTheErrorOfTheMapAsWell) {
    const Workplace workplace;
    const BumpField field =
        make_bump_field({"", FieldShape::waves, 32.0, 0.3, FieldCoding::bits8, 1.0, 5}, 160, 128);
    write_image(workplace / "noisy.png", field.heights);
    const std::string line = "relief-bake bump noisy.png" + strength_of(field);
    // The map is some degrees off whatever is done, however close kernels are to each other.
    const ProgramResult refused = workplace.run(line + " out/a.png --max-error 0.5");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.error, HasSubstr("noisy.png: no way to convert it keeps within 0.5 degrees "
                                         "(RMS): the map itself has an expected error of "));
    EXPECT_THAT(refused.error, HasSubstr("limit what is added by --max-added-error"));
    EXPECT_THAT(workplace.outputs(), testing::Not(HasSubstr("a.png")));
    const ProgramResult added =
        workplace.run(line + " out/b.png --max-added-error 0.5 --report out/b.json");
    ASSERT_EQ(added.exit_code, 0) << added.error;
    EXPECT_THAT(added.out, HasSubstr(" degrees RMS expected\n"));
    EXPECT_THAT(added.out, HasSubstr(" from the map itself, "));
    const json expected = json::parse(workplace.read("out/b.json"))["kept"]["expected_degrees"];
    EXPECT_LE(expected["added"].get<double>(), 0.5);
    EXPECT_NEAR(expected["total"].get<double>(),
                std::hypot(expected["map"].get<double>(), expected["added"].get<double>()), 1e-9);
    // What is printed is the error that there is.
    EXPECT_NEAR(expected["total"].get<double>() / error_of(workplace, "out/b.png", field), 1.0,
                0.4);
}

TEST(BumpAccuracyCommand, SaysWhatFollowsIfGrainIsDetail) {
    const Workplace workplace;
    const BumpField field =
        make_bump_field({"", FieldShape::waves, 32.0, 0.3, FieldCoding::bits8, 1.5, 5}, 160, 128);
    write_image(workplace / "noisy.png", field.heights);
    const std::string line = "relief-bake bump noisy.png" + strength_of(field);
    const ProgramResult result = workplace.run(line + " out/a.png --report out/a.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("fine grain that may be noise or detail"));
    EXPECT_THAT(result.out, HasSubstr("(--grain detail)"));
    const json report = json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["grain"]["taken_for"], "noise");
    EXPECT_TRUE(report["grain"]["ambiguous"].get<bool>());
    EXPECT_GT(report["grain"]["otherwise"]["expected_degrees"].get<double>(),
              5.0 * report["expected_degrees"].get<double>());
    EXPECT_GE(report["expected_degrees_upper"].get<double>(),
              report["expected_degrees"].get<double>());
    ASSERT_EQ(workplace.run(line + " out/b.png --grain detail --report out/b.json").exit_code, 0);
    const json detail = json::parse(workplace.read("out/b.json"));
    EXPECT_EQ(detail["grain"]["taken_for"], "detail");
    EXPECT_NE(detail["kernel"], "gaussian");
}

TEST(BumpAccuracyCommand, APictureIsNoHeightMap) {
    const Workplace workplace;
    Image picture = make_image(64, 64, 4, 8, ColorSpace::data);
    for (std::size_t i = 0; i < picture.sample_count(); ++i)
        picture.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i * 37 % 251);
    write_image(workplace / "photo.png", picture);
    const ProgramResult result =
        workplace.run("relief-bake bump photo.png out/a.png --kernel sobel3");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("color image read as heights"));
    EXPECT_THAT(result.out, HasSubstr("choose one channel by --channel"));
    EXPECT_THAT(result.out, HasSubstr("alpha with values between 0 and 1"));
    EXPECT_EQ(
        workplace.run("relief-bake bump photo.png out/b.png --kernel sobel3 --strict").exit_code,
        3);
    const ProgramResult chosen =
        workplace.run("relief-bake bump photo.png out/c.png --kernel sobel3 --channel red");
    EXPECT_THAT(chosen.out, testing::Not(HasSubstr("color image")));
}

TEST(BumpAccuracyCommand, ComparesEveryWayOnTheMap) {
    const Workplace workplace;
    const BumpField field = write_field(workplace, "h.png", FieldCoding::bits16);
    const ProgramResult result = workplace.run("relief-bake bump h.png out/n.png --compare" +
                                               strength_of(field) + " --report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("measured on all of the map, against the kernel chosen"));
    EXPECT_THAT(result.out, HasSubstr("MPixel/s\n"));
    EXPECT_THAT(result.out, HasSubstr("* no other method is both faster and more accurate\n"));
    const json report = json::parse(workplace.read("out/r.json"));
    ASSERT_EQ(report["comparison"].size(), 20U);
    int efficient = 0;
    for (const json& one : report["comparison"]) {
        EXPECT_GT(one["milliseconds"]["median"].get<double>(), 0.0);
        EXPECT_LE(one["degrees"]["rms"].get<double>(), one["degrees"]["max"].get<double>());
        efficient += one["efficient"].get<bool>() ? 1 : 0;
    }
    EXPECT_GE(efficient, 1);
}

TEST(BumpAccuracyRefusal, SaysWhyAndLeavesNothingBehind) {
    const Workplace workplace;
    write_image(workplace / "flat.png", make_image(4, 4, 1, 8, ColorSpace::data));
    expect_refusals(workplace, "relief-bake", "old.png",
                    {{"relief-bake bump flat.png out/n.png --max-error-kind max", 2,
                      "--max-error-kind: is for --max-error (give --max-error DEG)"},
                     {"relief-bake bump flat.png out/n.png --max-error -1", 2, "--max-error -1: "},
                     {"relief-bake bump flat.png out/n.png --max-error 1 --compare", 2,
                      "--compare, --max-error: one converts in every way, the other in one"},
                     {"relief-bake bump flat.png out/n.exr --max-error 1 --slope-moments", 2,
                      "--max-error, --slope-moments: errors are those of normals"},
                     {"relief-bake bump flat.png out/n.exr --compare --half", 2,
                      "--compare, --half: errors of half floats are not measured"}});
}

}  // namespace
}  // namespace relief::tools
