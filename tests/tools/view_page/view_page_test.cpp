// SPDX-License-Identifier: Apache-2.0
// Pages as text: their code, their policy and their refusals. view_page_test.py compares their
// pictures with those of the command line in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "page_command.h"
#include "page_quantize.h"
#include "page_writer.h"
#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

TEST(PageCode, IsSmall) {
    const std::string code = page_frame("vase.obj", "");
    EXPECT_LT(code.size(), 60'000U);
    EXPECT_GT(code.size(), 40'000U);
    const Workplace workplace;
    workplace.write("code.html", code);
    const ProgramResult compressed = workplace.run("gzip -9 -c code.html | wc -c");
    ASSERT_EQ(compressed.exit_code, 0) << compressed.error;
    EXPECT_LT(std::stoi(compressed.out), 20'000);
    EXPECT_GT(std::stoi(compressed.out), 10'000);
    EXPECT_THAT(code, Not(HasSubstr("import ")));
    EXPECT_THAT(code, Not(HasSubstr("fetch(")));
}

TEST(PageQuantize, KeepsTheEndsAndStatesTheError) {
    const std::vector<float> values = {-1.0F, 5.0F, 0.25F, 5.0F, 1.0F, 5.0F};
    const std::optional<QuantizedFloats> codes = quantized(values, 2);
    ASSERT_TRUE(codes);
    EXPECT_EQ(codes->min, (std::vector<float>{-1.0F, 5.0F}));
    EXPECT_EQ(codes->max, (std::vector<float>{1.0F, 5.0F}));
    // 0.25 is at 0.625 * 65535 = 40959.375, and a step is 2 / 65535.
    EXPECT_EQ(codes->codes, (std::vector<std::uint16_t>{0, 0, 40959, 0, 65535, 0}));
    EXPECT_NEAR(codes->error, 0.375 * 2.0 / 65535.0, 1e-9);
    EXPECT_FALSE(quantized(std::vector<float>{1.0F, NAN}, 1)) << "is kept as it is";
}

TEST(PageQuantize, MakesTheVaseSmaller) {
    const Workplace workplace;
    std::vector<std::size_t> sizes;
    for (const char* option : {"", "--page-quantize"}) {
        const ProgramResult result = workplace.run(
            std::string("relief-view data/vase.obj --output out/vase.html --json --quiet ") +
            option);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        const json page = json::parse(result.out)["page"];
        sizes.push_back(page["bytes"]);
        const json& errors = page["quantization"];
        EXPECT_EQ(errors.contains("position_object"), *option != '\0');
        EXPECT_LT(errors.value("position_object", 0.0), 1e-4);
    }
    EXPECT_LT(sizes[1], sizes[0]);
}

TEST(ViewPage, IsOneFileThatLoadsNothing) {
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-view data/vase.obj --output out/vase.html --json --quiet");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(workplace.outputs(), "vase.html");
    const std::string page = workplace.read("out/vase.html");
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
    EXPECT_THAT(page, HasSubstr("<title>vase.obj</title>"));
    EXPECT_THAT(page, Not(HasSubstr("https:")));
    EXPECT_THAT(page, Not(HasSubstr("{{")));
    const json summary = json::parse(result.out)["page"];
    EXPECT_EQ(summary["bytes"], page.size());
    EXPECT_EQ(summary["programs"], 2) << "that of the surface, and the finishing pass";
    EXPECT_EQ(summary["pictures"], 1);
    EXPECT_LT(page.size(), 1'000'000U) << "the vase needs at most 1 MB";
}

TEST(ViewPage, IsTheSameForAnyNumberOfThreads) {
    const Workplace workplace;
    for (const char* threads : {"1", "3"}) {
        const ProgramResult result = workplace.run(
            std::string("relief-view data/vase.obj --environment data/sky --reflectivity 0.3 "
                        "--quiet --threads ") +
            threads + " --output out/" + threads + ".html");
        ASSERT_EQ(result.exit_code, 0) << result.error;
    }
    EXPECT_EQ(workplace.read("out/1.html"), workplace.read("out/3.html"));
}

TEST(ViewPage, RefusesWhatAPageDoesNotHave) {
    const Workplace workplace;
    const std::string page = "relief-view data/vase.obj --output out/p.html ";
    for (const char* option :
         {"--turntable 4", "--benchmark 3", "--compare map=none --difference-map out/d.png",
          "--reference data/bricks-diffuse.png"}) {
        const ProgramResult result = workplace.run(page + option);
        EXPECT_EQ(result.exit_code, 2) << option;
        EXPECT_THAT(result.error, HasSubstr("applies to pictures, not to pages")) << option;
    }
    const ProgramResult exercise = workplace.run(
        "relief-view --exercise data/exercises/phong-by-reflection.json --output out/p.html");
    EXPECT_EQ(exercise.exit_code, 2);
    EXPECT_THAT(exercise.error, HasSubstr("--exercise: compares a picture with the solution"));
    const ProgramResult alone =
        workplace.run("relief-view data/vase.obj --output out/p.png --page-views diffuse");
    EXPECT_EQ(alone.exit_code, 2);
    EXPECT_THAT(alone.error, HasSubstr("--page-views: there is no page"));
    for (const char* option : {"--output out/p.png", "--show diffuse --output out/p.html",
                               "--compare map=none --output out/p.html"}) {
        const ProgramResult probes =
            workplace.run(std::string("relief-view data/vase.obj --page-probes 4x4 ") + option);
        EXPECT_EQ(probes.exit_code, 2) << option;
        EXPECT_THAT(probes.error, HasSubstr("--page-probes: ")) << option;
    }
    const ProgramResult many = workplace.run(page + "--page-probes 65x64");
    EXPECT_EQ(many.exit_code, 2);
    EXPECT_THAT(many.error, HasSubstr("a page explains at most 4096 pixels"));
    const ProgramResult unknown = workplace.run(page + "--page-views diffuse,normal");
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_THAT(unknown.error, HasSubstr("there is no view 'normal'"));
    EXPECT_EQ(workplace.outputs(), "");
}

TEST(PageSize, WarnsAbove100Megabytes) {
    Report report;
    report_size(100'000'000, report);
    EXPECT_TRUE(report.findings().empty());
    report_size(123'456'789, report);
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_EQ(report.findings().front().kind, "page larger than 100 MB");
    EXPECT_EQ(report.findings().front().first, (std::vector<std::size_t>{123}));
}

/// A glTF file with one triangle, whose metallic-roughness material has a map in each slot.
json material_of_all_maps(bool has_layers) {
    const json map = {{"index", 0}};
    json material = {
        {"pbrMetallicRoughness", {{"baseColorTexture", map}, {"metallicRoughnessTexture", map}}},
        {"normalTexture", map},
        {"occlusionTexture", map},
        {"emissiveTexture", map},
        {"emissiveFactor", {1, 1, 1}}};
    json& more = material["extensions"];
    more["KHR_materials_specular"] = {{"specularTexture", map}, {"specularColorTexture", map}};
    more["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1},
                                       {"clearcoatTexture", map},
                                       {"clearcoatRoughnessFactor", 1},
                                       {"clearcoatRoughnessTexture", map},
                                       {"clearcoatNormalTexture", map}};
    if (has_layers) {
        more["KHR_materials_sheen"] = {{"sheenColorFactor", {1, 1, 1}},
                                       {"sheenColorTexture", map},
                                       {"sheenRoughnessFactor", 1},
                                       {"sheenRoughnessTexture", map}};
        more["KHR_materials_anisotropy"] = {{"anisotropyStrength", 1}, {"anisotropyTexture", map}};
        more["KHR_materials_iridescence"] = {{"iridescenceFactor", 1},
                                             {"iridescenceTexture", map},
                                             {"iridescenceThicknessTexture", map}};
        more["KHR_materials_transmission"] = {{"transmissionFactor", 1},
                                              {"transmissionTexture", map}};
        more["KHR_materials_volume"] = {{"thicknessFactor", 1}, {"thicknessTexture", map}};
    }
    return material;
}

json triangle_with(const json& material) {
    json file = {{"asset", {{"version", "2.0"}}},
                 {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},
                 {"nodes", {{{"mesh", 0}}}},
                 {"images", {{{"uri", "map.png"}}}},
                 {"textures", {{{"source", 0}}}},
                 {"materials", {material}},
                 {"meshes",
                  {{{"primitives",
                     {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"material", 0}}}}}}},
                 {"buffers", {{{"byteLength", 60}, {"uri", "triangle.bin"}}}},
                 {"bufferViews",
                  {{{"buffer", 0}, {"byteLength", 36}},
                   {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 24}}}},
                 {"accessors",
                  {{{"bufferView", 0},
                    {"componentType", 5126},
                    {"count", 3},
                    {"type", "VEC3"},
                    {"min", {0, 0, 0}},
                    {"max", {1, 1, 0}}},
                   {{"bufferView", 1}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}}}};
    for (const auto& [name, value] : material["extensions"].items())
        file["extensionsUsed"].push_back(name);
    return file;
}

void write_floats(const Workplace& workplace, const std::string& name,
                  const std::vector<float>& values) {
    workplace.write(name, std::string(reinterpret_cast<const char*>(values.data()),
                                      values.size() * sizeof(float)));
}

TEST(ViewPage, RefusesMoreTexturesThanWebGlGuarantees) {
    const Workplace workplace;
    write_floats(workplace, "triangle.bin", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1});
    ASSERT_EQ(workplace.run("cp data/bricks-diffuse.png map.png").exit_code, 0);
    for (const bool has_layers : {false, true}) {
        workplace.write("all.gltf", triangle_with(material_of_all_maps(has_layers)).dump());
        const ProgramResult result = workplace.run(
            "relief-view all.gltf --environment data/sky --output out/p.html --quiet");
        if (!has_layers) {
            EXPECT_EQ(result.exit_code, 0) << result.error;
            EXPECT_EQ(workplace.outputs(), "p.html");
            ASSERT_EQ(workplace.run("rm out/p.html").exit_code, 0);
            continue;
        }
        EXPECT_EQ(result.exit_code, 1) << result.out;
        EXPECT_THAT(result.error, HasSubstr("textures at once, and a shader of WebGL 2 can sample "
                                            "16: "));
        EXPECT_EQ(workplace.outputs(), "") << "nothing is written";
    }
}

TEST(ViewPage, ReportsTexturesLargerThanWebGlGuarantees) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    for (const int width : {2048, 2049}) {
        write_image(workplace / "wide.png", make_image(width, 2, 3, 8, ColorSpace::srgb));
        const ProgramResult result = workplace.run(
            "relief-view square.obj --diffuse-map wide.png --output out/p.html --json --quiet");
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_EQ(result.out.find("texture larger than the 2048 texels that WebGL 2 guarantees") !=
                      std::string::npos,
                  width > 2048);
    }
}

TEST(ViewPage, RefusesMoreRowsThanATextureHolds) {
    const Workplace workplace;
    // A grid of 260 x 260 vertices with 63 morph targets, which are one accessor.
    constexpr int side = 260;
    std::vector<float> positions;
    for (int i = 0; i < side * side; ++i)
        positions.insert(positions.end(), {static_cast<float>(i % side) / side,
                                           static_cast<float>(i / side) / side, 0.0F});
    write_floats(workplace, "triangle.bin", positions);
    json file = triangle_with(json::object({{"extensions", json::object()}}));
    file.erase("images");
    file.erase("textures");
    file.erase("materials");
    file["buffers"][0]["byteLength"] = positions.size() * sizeof(float);
    file["bufferViews"] = json::array(
        {json::object({{"buffer", 0}, {"byteLength", positions.size() * sizeof(float)}})});
    json accessor = file["accessors"][0];
    accessor["count"] = side * side;
    file["accessors"] = json::array({accessor});
    const json targets(63, json({{"POSITION", 0}}));
    file["meshes"][0] = {
        {"primitives", {{{"attributes", {{"POSITION", 0}}}, {"mode", 5}, {"targets", targets}}}},
        {"weights", std::vector<double>(63, 0.01)}};
    workplace.write("many.gltf", file.dump());
    const ProgramResult result =
        workplace.run("relief-view many.gltf --output out/p.html --quiet --size 64x64");
    EXPECT_EQ(result.exit_code, 1) << result.out;
    EXPECT_THAT(result.error, HasSubstr("a texture of WebGL 2 holds 4194304"));
    EXPECT_EQ(workplace.outputs(), "") << "nothing is written";
}

/// Runs a script of this folder.
void expect_passing(const std::string& name, const std::string& arguments) {
    const Workplace workplace;
    const std::filesystem::path script = test::source_directory() / "tests/tools/view_page" / name;
    const ProgramResult result = workplace.run("python3 -B '" + script.string() +
                                               "' \"$(command -v relief-view)\" . " + arguments);
    constexpr int no_browser = 77;
    if (result.exit_code == no_browser) GTEST_SKIP() << result.error;
    EXPECT_EQ(result.exit_code, 0) << result.out << result.error;
}

TEST_LABELS(not_sanitized);
TEST(ViewPage, WorksInABrowser) {
    expect_passing("view_page_test.py", "few '' ViewPage");
}

TEST_LABELS(not_sanitized);
TEST(ViewPage, FollowsInputInABrowser) {
    expect_passing("page_input_test.py", "few '' PageInput");
}

TEST_LABELS(not_sanitized);
TEST(ViewPage, TeachesInABrowser) {
    expect_passing("view_page_test.py", "few '' LessonPage");
}

/// Every fourth of all scenes and models, from one of them on.
class PageSweep : public testing::TestWithParam<int> {};

TEST_LABELS(slow, sweep, not_sanitized);
TEST_P(PageSweep, ShowsScenesInABrowser) {
    expect_passing("view_page_test.py", std::to_string(GetParam()) + "/4 '" +
                                            test::shared_directory().string() +
                                            "' ViewPage.test_draws_the_same_picture "
                                            "ViewPage.test_deforms_as_the_renderer_does");
}

INSTANTIATE_TEST_SUITE_P(Parts, PageSweep, testing::Range(0, 4));

}  // namespace
}  // namespace relief::tools
