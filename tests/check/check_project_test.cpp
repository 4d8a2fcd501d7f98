// SPDX-License-Identifier: Apache-2.0
// relief.json: severities, suppressions, budgets and the baseline.
#include "check_project.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "check/planted_defects.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

class Project : public testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directory(workplace / "in");
        for (std::size_t kind = 0; kind < test::planted_kinds().size(); ++kind) {
            if (test::planted_kinds()[kind].rule == "mesh/repeated-triangle")
                test::write_planted_model(workplace / "in", "rock", kind, 2);
        }
    }

    /// Runs the check with a project.
    [[nodiscard]] ProgramResult run(const std::string& project,
                                    const std::string& more = "") const {
        workplace.write("in/relief.json", project);
        return workplace.run("relief check in --strict" + more);
    }

    Workplace workplace;
};

TEST_F(Project, SetsSeverities) {
    EXPECT_EQ(run("{}").exit_code, 3);
    EXPECT_EQ(run(R"({"rules": {"mesh/repeated-triangle": "note"}})").exit_code, 0);
    EXPECT_EQ(run(R"({"rules": {"mesh/*": "off"}})").exit_code, 0);
    EXPECT_EQ(run(R"({"rules": {"*": "off"}})").exit_code, 0);
    // The longer pattern wins, in any order.
    const ProgramResult longer =
        run(R"({"rules": {"mesh/repeated-triangle": "error", "mesh/*": "off"}})");
    EXPECT_EQ(longer.exit_code, 3);
    EXPECT_THAT(longer.out, HasSubstr("in/rock.gltf: error: "));
}

TEST_F(Project, SuppressesByRuleAndFile) {
    const ProgramResult fits =
        run(R"({"suppress": [{"rule": "mesh/*", "files": "*.gltf", "reason": "sold as it is"}]})");
    EXPECT_EQ(fits.exit_code, 0);
    EXPECT_THAT(fits.out, HasSubstr(" suppressed"));
    EXPECT_EQ(
        run(R"({"suppress": [{"rule": "mesh/*", "files": ["a/**"], "reason": "old"}]})").exit_code,
        3);
    EXPECT_EQ(run(R"({"exclude": "rock*"})").exit_code, 0);
}

TEST_F(Project, LimitsBudgets) {
    const auto rules = [&](const std::string& budget) {
        return run(R"({"rules": {"mesh/*": "off"}, "budgets": [)" + budget + "]}").out;
    };
    // The sheet has 8 x 8 squares and a repeated triangle.
    EXPECT_THAT(rules(R"({"triangles": 128})"),
                HasSubstr("has 129 triangles of at most 128 [budget/triangles]"));
    EXPECT_THAT(rules(R"({"triangles": 129})"), Not(HasSubstr("budget/")));
    EXPECT_THAT(rules(R"({"map_size": 32})"),
                HasSubstr("in/rock_color.png: error: has 64 x 64 texels of at most 32"));
    EXPECT_THAT(rules(R"({"map_size": 64})"), Not(HasSubstr("budget/")));
    EXPECT_THAT(rules(R"({"materials": 0})"), HasSubstr("has 1 materials of at most 0"));
    // 81 vertices of 48 bytes, 129 triangles of 12, two images of 64 x 64 x 4 x 4/3 bytes.
    EXPECT_THAT(rules(R"({"memory": 49125})"),
                HasSubstr("has 49126 bytes on the GPU of at most 49125 [budget/memory]"));
    EXPECT_THAT(rules(R"({"memory": 49126})"), Not(HasSubstr("budget/")));
    EXPECT_THAT(rules(R"({"file_size": 10})"), HasSubstr("[budget/file-size]"));
    EXPECT_THAT(rules(R"({"files": "a/**", "triangles": 1})"), Not(HasSubstr("budget/")));
    // 0.96 of the image on a sheet of about 2 x 2 units.
    EXPECT_THAT(rules(R"({"texel_density": [40, 80]})"),
                HasSubstr("has 29.15 texels per unit, not 40 to 80 [budget/texel-density]"));
    EXPECT_THAT(rules(R"({"texel_density": [20, 40]})"), Not(HasSubstr("budget/")));
}

// "image 1" is also the place of an embedded image.
TEST_F(Project, LimitsAnImageFileOnceWhateverItsName) {
    json model = json::parse(workplace.read("in/rock.gltf"));
    std::filesystem::rename(workplace / "in/rock_color.png", workplace / "in/image 1.png");
    for (json& image : model["images"]) {
        if (image["uri"] == "rock_color.png") image["uri"] = "image%201.png";
    }
    workplace.write("in/rock.gltf", model.dump());
    const std::string out =
        run(R"({"rules": {"mesh/*": "off"}, "budgets": [{"map_size": 32}]})").out;
    EXPECT_THAT(out, HasSubstr("in/image 1.png: error: has 64 x 64 texels of at most 32"));
    EXPECT_THAT(out, Not(HasSubstr("in/rock.gltf: error: image 1")));
}

TEST_F(Project, MeasuresTexelDensityOfTiledTextures) {
    json model = json::parse(workplace.read("in/rock.gltf"));
    model["extensionsUsed"] = {"KHR_texture_transform"};
    model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform", {{"scale", {2.0, 8.0}}}}};
    workplace.write("in/rock.gltf", model.dump());
    // Four times 29.15.
    EXPECT_THAT(run(R"({"budgets": [{"texel_density": [0, 1]}]})").out,
                HasSubstr("has 116.6 texels per unit"));
}

TEST_F(Project, AcceptsABaselineUntilItGrows) {
    workplace.write("in/relief.json", R"({"rules": {"mesh/bow-tie-vertex": "error"}})");
    const ProgramResult written = workplace.run("relief check in --strict --write-baseline");
    EXPECT_EQ(written.exit_code, 0) << written.error;
    const json project = json::parse(workplace.read("in/relief.json"));
    EXPECT_EQ(project["rules"]["mesh/bow-tie-vertex"], "error");
    EXPECT_EQ(project["baseline"],
              json::parse(R"([{"rule": "mesh/repeated-triangle", "file": "rock.gltf",
                               "place": "mesh 0 primitive 0", "count": 1}])"));
    const ProgramResult again = workplace.run("relief check in --strict");
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_THAT(again.out, HasSubstr("1 in the baseline"));
    json smaller = project;
    smaller["baseline"][0]["count"] = 0;
    EXPECT_EQ(run(smaller.dump()).exit_code, 3);
    EXPECT_EQ(
        workplace.run("relief check in/rock.gltf --config out/new.json --write-baseline").exit_code,
        0);
    EXPECT_THAT(workplace.read("out/new.json"), HasSubstr("\"file\": \"in/rock.gltf\""));
}

TEST_F(Project, TheDocumentedExampleIsValid) {
    const std::string page = test::read_bytes(test::source_directory() / "docs/check.md");
    const std::size_t begin = page.find("```json\n") + 8;
    const ProgramResult result = run(page.substr(begin, page.find("```", begin) - begin));
    EXPECT_EQ(result.exit_code, 3) << result.error;
    EXPECT_THAT(result.out, HasSubstr("in/rock.gltf: error: "));
}

TEST_F(Project, RefusesMistakes) {
    const auto error = [&](const std::string& project) {
        const ProgramResult result = run(project);
        EXPECT_EQ(result.exit_code, 1) << project;
        return result.error;
    };
    EXPECT_THAT(error("{"), HasSubstr("in/relief.json: "));
    EXPECT_THAT(error(R"({"rule": {}})"), HasSubstr("rule"));
    EXPECT_THAT(error(R"({"rules": {"mesh/none": "off"}})"), HasSubstr("/rules/mesh~1none"));
    EXPECT_THAT(error(R"({"rules": {"mesh/*": "fatal"}})"), HasSubstr("'fatal'"));
    EXPECT_THAT(error(R"({"suppress": [{"rule": "mesh/*"}]})"), HasSubstr("reason"));
    EXPECT_THAT(error(R"({"budgets": [{"triangles": -1}]})"), HasSubstr("must not be negative"));
    EXPECT_THAT(error(R"({"budgets": [{"texel_density": [2, 1]}]})"),
                HasSubstr("must be the minimum and the maximum"));
}

}  // namespace
}  // namespace relief::tools
