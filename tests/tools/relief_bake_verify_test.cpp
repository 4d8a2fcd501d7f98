// SPDX-License-Identifier: Apache-2.0
// Maps held against their models: relief-bake mesh --verify, relief-bake check --high --low.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

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
using testing::Not;

/// A bent surface above the square of Workplace, of strips with normals that turn along x and y.
std::string verified_waves(double frequency = 3.0) {
    std::string text;
    constexpr int cells = 48;
    for (int row = 0; row <= cells; ++row) {
        for (int column = 0; column <= cells; ++column) {
            const double x = 2.0 * column / cells - 1.0, y = 2.0 * row / cells - 1.0;
            text += fmt::format("v {} {} {}\n", x, y,
                                0.1 * std::sin(frequency * x + 1.0) * std::cos(2.0 * y));
        }
    }
    for (int row = 0; row < cells; ++row) {
        for (int column = 1; column <= cells; ++column) {
            const int a = row * (cells + 1) + column;
            text += fmt::format("f {} {} {} {}\n", a, a + 1, a + cells + 2, a + cells + 1);
        }
    }
    return text;
}

class Verify : public testing::Test {
  protected:
    Verify() {
        workplace.write_square("low.obj");
        workplace.write("high.obj", verified_waves());
    }

    void bake(const std::string& options = "") const {
        const ProgramResult result = workplace.run(
            "relief-bake mesh high.obj low.obj out/map.png --size 64 --quiet " + options);
        ASSERT_EQ(result.exit_code, 0) << result.error;
    }
    /// The check of a map against the models; the exit code where it is wanted.
    [[nodiscard]] json check(const std::string& map, const std::string& options = "",
                             int* exit_code = nullptr) const {
        const ProgramResult result = workplace.run(
            "relief-bake check " + map + " --high high.obj --low low.obj --json " + options);
        if (exit_code != nullptr) *exit_code = result.exit_code;
        EXPECT_TRUE(exit_code != nullptr || result.exit_code == 0) << result.error;
        return json::parse(result.out)["files"][0]["surface"];
    }
    /// The red, green and blue codes of the map, changed.
    template <typename Change>
    void change(const Change& each) const {
        Image map = read_image(workplace / "out/map.png", ImageUse::data);
        const auto codes = map.as<std::uint16_t>();
        for (std::size_t i = 0; i < codes.size(); i += 3)
            each(codes[i], codes[i + 1], codes[i + 2]);
        write_image(workplace / "out/map.png", map);
    }

    Workplace workplace;
};

TEST_F(Verify, AFreshMapIsAsTrueAsItsCodes) {
    const ProgramResult result = workplace.run(
        "relief-bake mesh high.obj low.obj out/map.png --size 64 --verify --error-map out/e.png "
        "--report out/report.json --strict");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("from the mean over each texel (16 samples)"));
    EXPECT_THAT(result.out, HasSubstr("verdict   as this bake makes it\n"));
    const json report = json::parse(workplace.read("out/report.json"));
    const json& check = report["maps"][0]["check"];
    EXPECT_EQ(check["centre"]["texels"], 64 * 64);
    EXPECT_LT(check["centre"]["max"].get<double>(), 0.003);
    EXPECT_LT(check["error"]["rms"].get<double>(), 0.5);
    EXPECT_EQ(check["stages"]["other"]["rms"], 0.0);
    double shares = 0.0;
    for (const json& stage : check["stages"])
        shares += stage["share"].get<double>();
    EXPECT_NEAR(shares, 1.0, 1e-9);
    const Image errors = read_image(workplace / "out/e.png", ImageUse::data);
    EXPECT_EQ(errors.width, 64);
    EXPECT_EQ(errors.channels, 4);
    EXPECT_EQ(read_image_info(workplace / "out/e.png").metadata.at("relief:brightest"),
              fmt::format("{:g}", check["error_map"]["brightest"].get<double>()));
}

TEST_F(Verify, TheFileSaysHowItWasBaked) {
    bake("--samples 4 --rays face --offset 0.5 --max-distance 0.25 --dither blue-noise --bits 8");
    const json surface = check("out/map.png");
    EXPECT_EQ(surface["baked"],
              "--dither blue-noise --max-distance 0.25 --offset 0.5 --rays face --samples 4 "
              "--space tangent");
    EXPECT_EQ(surface["file_says"], surface["baked"]);
    EXPECT_EQ(surface["offset"], 0.5);
    EXPECT_EQ(surface["reference_samples"], 64);
    // The very codes, dither among them, are made again.
    EXPECT_EQ(surface["stages"]["other"]["rms"], 0.0);
    EXPECT_GT(surface["stages"]["quantisation"]["rms"].get<double>(), 0.05);
    const json told = check("out/map.png", "--samples 1");
    EXPECT_EQ(told["reference_samples"], 16);
    EXPECT_GT(told["stages"]["other"]["rms"].get<double>(), 0.0);
}

TEST_F(Verify, ABoundIsKeptOrItIsTrouble) {
    bake();
    int exit_code = -1;
    json surface = check("out/map.png", "--max-error 1 --strict", &exit_code);
    EXPECT_EQ(exit_code, 0);
    EXPECT_TRUE(surface["trouble"].empty());
    surface = check("out/map.png", "--max-error 0.01 --max-error-kind p99 --strict", &exit_code);
    EXPECT_EQ(exit_code, 3);
    EXPECT_THAT(surface["trouble"][0].get<std::string>(),
                HasSubstr("more than the 0.01 degrees (99 of 100 texels) allowed"));
}

TEST_F(Verify, TurnedGreenIsNamedAndItsRemedyHelps) {
    bake();
    const double as_baked = check("out/map.png")["error"]["rms"].get<double>();
    change([](std::uint16_t&, std::uint16_t& green, std::uint16_t&) {
        green = static_cast<std::uint16_t>(65535 - green);
    });
    int exit_code = -1;
    const json surface = check("out/map.png", "--strict", &exit_code);
    EXPECT_EQ(exit_code, 3);
    EXPECT_GT(surface["error"]["rms"].get<double>(), 5.0);
    EXPECT_EQ(surface["convention"]["differs_in"], json({"axes"}));
    EXPECT_THAT(surface["trouble"][0].get<std::string>(), HasSubstr("green is turned round"));
    const std::string remedy = surface["remedies"][0];
    EXPECT_EQ(remedy, "relief-bake convert out/map.png out.png --axes=x,-y,z");
    ASSERT_EQ(workplace.run(remedy).exit_code, 0);
    EXPECT_NEAR(check("out.png")["error"]["rms"].get<double>(), as_baked, 1e-9);
}

TEST_F(Verify, AnotherSpaceIsNamedAndItsRemedyHelps) {
    bake("--space world");
    change([](std::uint16_t& red, std::uint16_t& green, std::uint16_t& blue) {
        // On a square in the xy plane, tangent space is the world's: turned, it is not.
        const std::uint16_t old = red;
        red = blue;
        blue = green;
        green = old;
    });
    const json surface = check("out/map.png", "--space world");
    EXPECT_EQ(surface["convention"]["differs_in"], json({"axes"}));
    const std::string remedy = surface["remedies"][0];
    ASSERT_EQ(workplace.run(remedy).exit_code, 0);
    EXPECT_LT(check("out.png", "--space world")["centre"]["max"].get<double>(), 0.003);
}

TEST_F(Verify, AMapOfAnotherModelIsExplainedByNothing) {
    workplace.write("other.obj", verified_waves(7.0));
    ASSERT_EQ(
        workplace.run("relief-bake mesh other.obj low.obj out/map.png --size 64 --quiet").exit_code,
        0);
    int exit_code = -1;
    const json surface = check("out/map.png", "--strict", &exit_code);
    EXPECT_EQ(exit_code, 3);
    EXPECT_EQ(surface["convention"]["explained"], false);
    EXPECT_THAT(surface["trouble"][0].get<std::string>(), HasSubstr("not what this bake makes"));
}

TEST_F(Verify, ACageIsToBeNamedAgain) {
    workplace.write("cage.obj", "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nf 1 2 3 4\n");
    bake("--cage cage.obj");
    const std::string line = "relief-bake check out/map.png --high high.obj --low low.obj ";
    const ProgramResult result = workplace.run(line);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("was baked from a cage, whose file it does not name (give "
                                        "--cage FILE)"));
    EXPECT_EQ(workplace.run(line + "--cage cage.obj --strict").exit_code, 0);
}

TEST_F(Verify, EachMapOfATileIsCheckedByItself) {
    const ProgramResult result = workplace.run(
        "relief-bake mesh high.obj low.obj 'out/<UDIM>.png' --size 32 --verify --report "
        "out/report.json --quiet");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_LT(report["maps"][0]["check"]["centre"]["max"].get<double>(), 0.003);
    EXPECT_LT(check("out/1001.png")["centre"]["max"].get<double>(), 0.003);
    EXPECT_EQ(
        workplace.run("relief-bake check out/1001.png --high high.obj --low low.obj --udim 1002")
            .exit_code,
        1);
}

TEST_F(Verify, ErrorsInDegreesAreWrittenAsFloats) {
    bake();
    const json surface = check("out/map.png", "--error-map out/e.exr");
    const Image errors = read_image(workplace / "out/e.exr", ImageUse::data);
    EXPECT_EQ(errors.channels, 1);
    double squares = 0.0;
    for (const float error : errors.as<float>())
        squares += double{error} * double{error};
    EXPECT_NEAR(std::sqrt(squares / (64 * 64)), surface["error"]["rms"].get<double>(), 1e-6);
}

TEST(VerifyRefusal, LeavesEverythingAsItWas) {
    const Workplace workplace;
    workplace.write_square("low.obj");
    workplace.write("high.obj", verified_waves());
    ASSERT_EQ(workplace.run("relief-bake mesh high.obj low.obj map.png --size 8 --quiet").exit_code,
              0);
    expect_refusals(
        workplace, "relief-bake", "e.png",
        {{"relief-bake check map.png --low low.obj", 2, "--low: has no effect without --high"},
         {"relief-bake check map.png --high high.obj", 2,
          "--high: needs the model that the map is for"},
         {"relief-bake check map.png map.png --high high.obj --low low.obj", 2,
          "--high: is for one map, not 2"},
         {"relief-bake check map.png --max-error 1", 2,
          "--max-error: has no effect without --high"},
         {"relief-bake check map.png --high high.obj --low low.obj --max-error-kind max", 2,
          "--max-error-kind: is for --max-error"},
         {"relief-bake check map.png --high high.obj --low low.obj --error-map map.png", 2,
          "--error-map map.png: is also the input or the output"},
         {"relief-bake check map.png --high high.obj --low low.obj --error-map e.jpg", 2,
          "--error-map e.jpg: no format to write it in"},
         {"relief-bake check map.png --high none.obj --low low.obj", 1, "none.obj: no such file"},
         {"relief-bake mesh high.obj low.obj out/map.png --error-map out/e.png", 2,
          "--error-map: has no effect without --verify"}});
}

}  // namespace
}  // namespace relief::tools
