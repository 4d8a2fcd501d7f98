// SPDX-License-Identifier: Apache-2.0
// --probe as users write it: its text, its JSON against docs/probe.md, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// A square of Phong's model under one light, seen from the front.
class ProbeOption : public testing::Test {
  protected:
    void SetUp() override {
        workplace_.write_square("square.obj");
        workplace_.write("scene.json", R"({
  "relief_scene": 1,
  "camera": {"eye": [0, 0, 3], "target": [0, 0, 0], "fov": 60},
  "background": [0.25, 0.5, 1],
  "ambient": 0.5,
  "materials": {"paint": {"ambient": 0.5, "diffuse": [0.5, 0.75, 1]}},
  "nodes": [{"model": "square.obj", "material": "paint"}],
  "lights": [{"type": "directional", "direction": [-3, 0, -4], "color": [0.5, 0.5, 0.5]}]
})");
    }

    [[nodiscard]] ProgramResult run(const std::string& options) const {
        return workplace_.run("relief-view scene.json --size 33x33 " + options);
    }

    [[nodiscard]] json probe(const std::string& options) const {
        const ProgramResult result = run(options + " --json");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return json::parse(result.out).at("probe");
    }

    Workplace workplace_;
};

TEST_F(ProbeOption, PrintsFormulasWithNumbers) {
    const ProgramResult result = run("--probe 16,16");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("pixel     16,16 of 33 x 33, at its center, one sample\n"));
    EXPECT_THAT(result.out, HasSubstr("ambient: ka * La = 0.5 * 0.5 = 0.25\n"));
    EXPECT_THAT(result.out, HasSubstr("diffuse, directional light 1: L * n.l * kd = 0.5 * 0.8 * "
                                      "(0.5, 0.75, 1) = (0.2, 0.3, 0.4)\n"));
    EXPECT_THAT(result.out, HasSubstr("sum: (0.45, 0.55, 0.65)\n"));
    EXPECT_THAT(result.out, HasSubstr("difference: "));
}

TEST_F(ProbeOption, PrintsTheBackground) {
    const ProgramResult result = run("--probe 0,0");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("no surface: the background of the scene\n"));
    EXPECT_THAT(result.out, HasSubstr("over the background (0.25, 0.5, 1), alpha 1"));
}

TEST_F(ProbeOption, ComparesTheReferenceWithTheShader) {
    const json compared = probe("--probe 16,16").at("compared");
    // Rounding to codes, and of float arithmetic.
    for (int i = 0; i < 4; ++i) {
        EXPECT_LE(std::abs(compared.at("difference").at("codes").at(i).get<double>()), 0.51);
        EXPECT_LE(std::abs(compared.at("difference").at("linear").at(i).get<double>()), 1e-5);
    }
    EXPECT_EQ(compared.at("picture").at("samples"), 4);
    EXPECT_EQ(compared.at("picture").at("codes"), compared.at("shader").at("codes"));
}

TEST_F(ProbeOption, ExplainsTermViews) {
    const json found = probe("--probe 16,16 --show ambient");
    EXPECT_EQ(found.at("view"), "ambient");
    ASSERT_EQ(found.at("terms").size(), 1U);
    EXPECT_NEAR(found.at("radiance").at(0).get<double>(), 0.25, 1e-6);
    EXPECT_NEAR(found.at("compared").at("shader").at("linear").at(0).get<double>(), 0.25, 1e-5);
}

TEST_F(ProbeOption, RefusesWhatItCannotExplain) {
    const std::string line = "relief-view scene.json --size 33x33 ";
    for (const auto& [options, message] : std::map<std::string, std::string>{
             {"--probe 33,0", "--probe 33,0: is outside of the picture of 33 x 33 pixels"},
             {"--probe 0,40", "--probe 0,40: is outside of the picture"},
             {"--probe 5", "--probe 5: not a pixel like 320,240"},
             {"--probe=-1,5", "not between 0 and 16383"},
             {"--probe 5,x", "not a whole number"},
             {"--probe 1,1 --turntable 4 --output out/a.apng", "applies to one picture"},
             {"--probe 1,1 --wireframe --output out/a.png", "lines and markers"},
             {"--probe 1,1 --show shading-normal", "--show shading-normal shows none"},
             {"--probe 1,1 --compare kernel=central3 --output out/a.png", "not a comparison"}}) {
        const ProgramResult result = run(options);
        EXPECT_EQ(result.exit_code, 2) << options << result.out;
        EXPECT_THAT(result.error, HasSubstr(message)) << options;
    }
}

/// Adds the paths of all values below a value: "layers[].vectors[].symbol". Arrays of numbers are
/// values.
void add_paths(const json& value, const std::string& path, std::set<std::string>& paths) {
    if (value.is_object()) {
        for (const auto& [key, member] : value.items())
            add_paths(member, path.empty() ? key : path + "." + key, paths);
    } else if (value.is_array() && !value.empty() && !value.front().is_number()) {
        for (const json& element : value)
            add_paths(element, path + "[]", paths);
    } else if (!value.is_array() || !value.empty()) {
        paths.insert(path);
    }
}

TEST_F(ProbeOption, WritesTheJsonOfItsDocument) {
    workplace_.shrink_bricks();
    const ProgramResult result = workplace_.run(
        "relief-view data/vase.obj --height-map data/bricks-height.png --strength 12 --size 64x64 "
        "--light directional:-60,20 --probe 32,32 --json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    std::set<std::string> written;
    add_paths(json::parse(result.out).at("probe"), "", written);
    std::set<std::string> documented;
    const std::string text = test::read_bytes(test::source_directory() / "docs/probe.md");
    const std::string table = text.substr(text.find("\n## JSON"));
    const std::regex row("\n\\| (`[^|]*`) \\|");
    for (std::sregex_iterator match(table.begin(), table.end(), row);
         match != std::sregex_iterator(); ++match) {
        const std::string cell = (*match)[1];
        const std::regex path("`([^`]*)`");
        for (std::sregex_iterator name(cell.begin(), cell.end(), path);
             name != std::sregex_iterator(); ++name)
            documented.insert((*name)[1]);
    }
    EXPECT_EQ(written, documented);
}

}  // namespace
}  // namespace relief::tools
