// SPDX-License-Identifier: Apache-2.0
// The commands `relief-mesh decimate`, `lods` and `subdivide`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "relief-mesh/reshape.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/topology.h"
#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::read_document;
using test::Workplace;
using testing::HasSubstr;

/// Writes a wavy grid of cells x cells with two materials, left and right of x = 0.
void write_sheet(const Workplace& workplace, const std::string& name, int cells) {
    std::string vertices;
    std::string left = "usemtl left\n";
    std::string right = "usemtl right\n";
    const auto number = [&](int x, int y) { return std::to_string(y * (cells + 1) + x + 1); };
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x) {
            const double u = double(x) / cells;
            const double v = double(y) / cells;
            vertices += "v " + std::to_string(2 * u - 1) + " " + std::to_string(2 * v - 1) + " " +
                        std::to_string(0.2 * std::sin(7 * u) * std::cos(5 * v)) + "\n";
            if (x == cells || y == cells) continue;
            (2 * x < cells ? left : right) += "f " + number(x, y) + " " + number(x + 1, y) + " " +
                                              number(x + 1, y + 1) + " " + number(x, y + 1) + "\n";
        }
    }
    workplace.write(name, vertices + left + right);
}

std::set<std::tuple<float, float, float>> places_near_the_border(const Mesh& mesh) {
    std::set<std::tuple<float, float, float>> places;
    for (const glm::vec3& p : mesh.positions) {
        if (std::abs(p.x) < 0.01F) places.emplace(p.x, p.y, p.z);
    }
    return places;
}

/// Writes the vase with x and y as a second texture coordinate set, which its normal texture uses.
void write_vase_of_two_sets(const Workplace& workplace) {
    ASSERT_EQ(workplace.run("relief-mesh process data/vase.obj out/vase.gltf").exit_code, 0);
    json root = json::parse(workplace.read("out/vase.gltf"));
    json& primitive = root["meshes"][0]["primitives"][0];
    const json position = root["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    json view = root["bufferViews"][position["bufferView"].get<std::size_t>()];
    view["byteStride"] = 12;
    primitive["attributes"]["TEXCOORD_1"] = root["accessors"].size();
    root["accessors"].push_back({{"bufferView", root["bufferViews"].size()},
                                 {"componentType", 5126},
                                 {"type", "VEC2"},
                                 {"count", position["count"]}});
    root["bufferViews"].push_back(view);
    root["images"] = json::parse(R"([{"uri": "data:image/png;base64,AAAA"}])");
    root["textures"] = json::parse(R"([{"source": 0}])");
    root["materials"] = json::parse(R"([{"normalTexture": {"index": 0, "texCoord": 1}}])");
    primitive["material"] = 0;
    workplace.write("out/vase.gltf", root.dump());
    ASSERT_EQ(workplace
                  .run("relief-mesh process out/vase.gltf out/two.glb --normals angle --tangents "
                       "mikktspace")
                  .exit_code,
              0);
}

TEST(DecimateCommand, NewTangentsBelongToTheNormalTexturesSet) {
    const Workplace workplace;
    write_vase_of_two_sets(workplace);
    ASSERT_EQ(
        workplace.run("relief-mesh decimate out/two.glb out/low.glb --triangles 2000").exit_code,
        0);
    const ProgramResult checked = workplace.run("relief-mesh check out/low.glb --json");
    ASSERT_EQ(checked.exit_code, 0) << checked.error;
    const json tangents = json::parse(checked.out)["files"][0]["primitives"][0]["tangents"];
    EXPECT_EQ(tangents["basis"], "mikktspace");
    EXPECT_EQ(tangents["texcoord_set_of_material"], 1);
    EXPECT_EQ(tangents["texcoord_set"], 1);
    EXPECT_EQ(tangents["corners"], tangents["agreements"][0]["agreeing"]);
}

TEST(DecimateCommand, MeetsANumberARatioAndReports) {
    const Workplace workplace;
    ProgramResult result = workplace.run(
        "relief-mesh decimate data/vase.obj out/a.glb --triangles 1000 --report out/a.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("read      data/vase.obj: Wavefront OBJ, 5760 triangles, "));
    EXPECT_THAT(result.out, HasSubstr("result    1000 triangles, "));
    EXPECT_EQ(read_document(workplace / "out/a.glb").mesh({0, 0}).triangles.size(), 1000U);
    const json report = json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["tool"], "relief-mesh decimate");
    EXPECT_EQ(report["options"], json({{"triangles", 1000},
                                       {"for", "picture"},
                                       {"keep_borders", false},
                                       {"keep_seams", false},
                                       {"keep_positions", false},
                                       {"weights",
                                        {{"texcoords", 1.0},
                                         {"normals", 0.02},
                                         {"colors", 0.01},
                                         {"joints", 0.01},
                                         {"targets", 1.0}}},
                                       {"measure", "quick"},
                                       {"normals", "keep"}}));
    EXPECT_EQ(report["triangles_read"], 5760);
    EXPECT_EQ(report["triangles_written"], 1000);

    result = workplace.run("relief-mesh decimate data/vase.obj out/b.ply --ratio 0.25");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("result    1440 triangles, "));
    EXPECT_THAT(result.out, HasSubstr("omitted   1 material (cannot be stored in .ply)\n"));
    // The same command writes the same bytes.
    ASSERT_EQ(workplace.run("relief-mesh decimate data/vase.obj out/c.ply --ratio 0.25 --threads 1")
                  .exit_code,
              0);
    EXPECT_EQ(workplace.read("out/b.ply"), workplace.read("out/c.ply"));
}

TEST(DecimateCommand, AcceptsPercent) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh decimate data/vase.obj out/a.ply --ratio 25%").exit_code,
              0);
    ASSERT_EQ(workplace.run("relief-mesh decimate data/vase.obj out/b.ply --ratio 0.25").exit_code,
              0);
    EXPECT_EQ(workplace.read("out/a.ply"), workplace.read("out/b.ply"));
}

TEST(DecimateCommand, ReportsAnInputWithinTheLimit) {
    const Workplace workplace;
    const ProgramResult one =
        workplace.run("relief-mesh decimate data/urn-low.obj out/a.glb --triangles 5000");
    EXPECT_THAT(one.out, HasSubstr("result    720 triangles, "));
    EXPECT_THAT(one.out, HasSubstr(" (the input is within --triangles)\n"));
    const ProgramResult two = workplace.run(
        "relief-mesh decimate data/urn-low.obj data/vase.obj -o out/ --format glb --triangles "
        "5000");
    EXPECT_THAT(two.out, HasSubstr("out/urn-low.glb: 720 -> 720 triangles (within --triangles), "));
    EXPECT_THAT(two.out, HasSubstr("out/vase.glb: 5760 -> 5000 triangles, "));
}

TEST(DecimateCommand, NoGapOpensBetweenMaterials) {
    const Workplace workplace;
    write_sheet(workplace, "sheet.obj", 24);
    ASSERT_EQ(workplace.run("relief-mesh process sheet.obj out/sheet.glb").exit_code, 0);
    const ProgramResult result =
        workplace.run("relief-mesh decimate out/sheet.glb out/low.glb --ratio 0.2");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const GltfDocument document = read_document(workplace / "out/low.glb");
    ASSERT_EQ(document.triangle_primitives().size(), 2U);
    const auto left = places_near_the_border(document.mesh({0, 0}));
    EXPECT_EQ(left, places_near_the_border(document.mesh({0, 1})));
    EXPECT_GT(left.size(), 2U);
    EXPECT_LT(left.size(), 25U) << "thinned out";
}

/// Writes a roof over the unit square with `rows` rows of triangles on each side: the height is
/// x / 2 up to the ridge at x = 1, and falls behind it.
void write_roof(const Workplace& workplace, const std::string& name, int rows) {
    std::string text;
    for (int column = 0; column <= 2; ++column) {
        for (int row = 0; row <= rows; ++row)
            text += "v " + std::to_string(column) + " " + std::to_string(double(row) / rows) + " " +
                    (column == 1 ? "0.5" : "0") + "\n";
    }
    for (int column = 0; column < 2; ++column) {
        for (int row = 1; row <= rows; ++row) {
            const int at = column * (rows + 1) + row;
            const int next = at + rows + 1;
            text += "f " + std::to_string(at) + " " + std::to_string(next) + " " +
                    std::to_string(next + 1) + " " + std::to_string(at + 1) + "\n";
        }
    }
    workplace.write(name, text);
}

TEST(DecimateCommand, TheDistanceAndTheAngleAreMeasuredInBothDirections) {
    const Workplace workplace;
    write_roof(workplace, "roof.obj", 10);
    // Four triangles describe the roof exactly.
    ASSERT_EQ(workplace
                  .run("relief-mesh decimate roof.obj out/a.ply --triangles 4 --measure full "
                       "--report out/a.json")
                  .exit_code,
              0);
    json report = json::parse(workplace.read("out/a.json"));
    EXPECT_EQ(report["triangles_written"], 4);
    for (const char* direction : {"of_input", "of_output"}) {
        EXPECT_LT(report["distance"][direction]["max"], 1e-6) << direction;
        EXPECT_LT(report["distance"][direction]["max_degrees"], 1e-3) << direction;
    }
    EXPECT_TRUE(report["milliseconds"].contains("measure"));
    // A square of side 2, and above it one of area 1.25, at heights z from 0.5 to 1.25, whose
    // normal differs by 36.87 degrees. Without the second one, the distance of its points is z.
    workplace.write("two.obj",
                    "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3\nf 1 3 4\n"
                    "v 0 0 0.5\nv 1 0 0.5\nv 1 1 1.25\nv 0 1 1.25\nf 5 6 7\nf 5 7 8\n");
    const std::string to_two = "relief-mesh decimate two.obj --triangles 4 --drop-parts 2 ";
    ProgramResult result = workplace.run(to_two + "out/b.ply --measure full --report out/b.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("2 x triangle of a small part"));
    report = json::parse(workplace.read("out/b.json"));
    ASSERT_EQ(report["triangles_written"], 2);
    EXPECT_EQ(report["options"]["drop_parts"], 2.0);
    const json of_input = report["distance"]["of_input"];
    constexpr double area_share = 1.25 / 5.25;
    EXPECT_NEAR(of_input["max"], 1.25, 1e-6);
    EXPECT_NEAR(of_input["mean"], 0.875 * area_share, 3e-3);
    EXPECT_NEAR(of_input["rms"], std::sqrt(0.8125 * area_share), 5e-3);
    EXPECT_NEAR(of_input["mean_degrees"], 36.87 * area_share, 0.2);
    EXPECT_LT(report["distance"]["of_output"]["max"], 1e-6);
    EXPECT_THAT(result.out, HasSubstr("distance  of IN from OUT: mean "));
    EXPECT_THAT(result.out, HasSubstr("          of OUT from IN: mean "));
    EXPECT_THAT(result.out, HasSubstr("angle     between normals of IN and OUT: mean "));
    // Without a report there is nothing to measure for.
    result = workplace.run(to_two + "out/c.ply --quiet");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(workplace.read("out/b.ply"), workplace.read("out/c.ply"));
}

TEST(DecimateCommand, QuickMeasurementsStateTheirConfidence) {
    const Workplace workplace;
    const std::string line = "relief-mesh decimate data/vase.obj out/low.glb --ratio 0.3 ";
    const auto run = [&](const std::string& options) {
        const ProgramResult result = workplace.run(line + "--report out/low.json " + options);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return std::pair(result.out, json::parse(workplace.read("out/low.json")));
    };
    const auto [text, quick] = run("");
    const std::string bytes = workplace.read("out/low.glb");
    EXPECT_EQ(quick["options"]["measure"], "quick");
    EXPECT_EQ(quick["distance"]["confidence"], 0.95);
    EXPECT_THAT(text, HasSubstr("max is that of 1000 random samples on each: with 95 % confidence, "
                                "at most 0.3 % of its area is farther\n"));
    const auto [full_text, full] = run("--measure full");
    EXPECT_EQ(full["options"]["measure"], "full");
    EXPECT_FALSE(full["distance"].contains("confidence"));
    EXPECT_EQ(full_text.find("confidence"), std::string::npos);
    for (const char* direction : {"of_input", "of_output"}) {
        const json& some = quick["distance"][direction];
        const json& all = full["distance"][direction];
        EXPECT_EQ(some["samples"], 1000) << direction;
        // 1 - 0.05^(1 / 1000)
        EXPECT_NEAR(some["max_farther_part"], 0.0029912, 1e-6) << direction;
        EXPECT_EQ(all["samples"], 20'000) << direction;
        EXPECT_NEAR(some["mean"], all["mean"], 0.1 * double(all["mean"])) << direction;
        EXPECT_LE(some["max"], all["max"]) << direction;
        EXPECT_GT(some["max"], 0.3 * double(all["max"])) << direction;
    }
    EXPECT_EQ(quick["max_corner_degrees"], full["max_corner_degrees"]);
    const auto [none_text, none] = run("--measure none");
    EXPECT_EQ(none["options"]["measure"], "none");
    EXPECT_FALSE(none.contains("distance"));
    EXPECT_FALSE(none["milliseconds"].contains("measure"));
    EXPECT_EQ(none_text.find("distance"), std::string::npos);
    EXPECT_EQ(workplace.read("out/low.glb"), bytes);
    // The same numbers for any number of threads.
    EXPECT_EQ(run("--threads 1").second["distance"], quick["distance"]);
    EXPECT_EQ(workplace.run(line + "--quiet --measure none").exit_code, 0);
}

TEST(DecimateCommand, SamplesOfSeveralMeshesCountByTheirAreas) {
    const auto measured = [](double area, std::size_t samples, double max) {
        SurfaceDistance distance;
        distance.from_a.area = area;
        distance.from_a.samples = samples;
        distance.from_a.max = max;
        return distance;
    };
    // 300 samples on three quarters of the area count as 400, and 90 on a quarter as 360. A mesh
    // without area counts for neither.
    const SurfaceDistance all =
        joined_distance({measured(3.0, 300, 0.5), measured(1.0, 90, 0.25), measured(0.0, 0, 0.0)});
    EXPECT_EQ(all.from_a.samples, 360U);
    EXPECT_EQ(all.from_a.max, 0.5);
    EXPECT_EQ(all.from_b.samples, 0U);
    // 1000 samples, each mesh with its share, rounded up.
    EXPECT_EQ(joined_distance({measured(0.1, 334, 0.0), measured(0.2, 667, 0.0)}).from_a.samples,
              1000U);
}

TEST(DecimateCommand, TheMeasuredDistanceIsWithinMaxError) {
    const Workplace workplace;
    write_sheet(workplace, "sheet.obj", 24);
    ASSERT_EQ(workplace
                  .run("relief-mesh decimate sheet.obj out/a.ply --max-error 0.02 --report "
                       "out/a.json")
                  .exit_code,
              0);
    const json report = json::parse(workplace.read("out/a.json"));
    EXPECT_LT(report["triangles_written"], 600);
    for (const char* direction : {"of_input", "of_output"}) {
        EXPECT_LE(report["distance"][direction]["max"], 0.02001) << direction;
        EXPECT_GT(report["distance"][direction]["max"], 0.005) << direction;
    }
}

TEST(DecimateCommand, BordersSeamsAndAnglesAreKeptOnRequest) {
    const Workplace workplace;
    write_sheet(workplace, "sheet.obj", 24);
    ASSERT_EQ(workplace.run("relief-mesh process sheet.obj out/sheet.glb").exit_code, 0);
    const auto decimated = [&](const std::string& options) {
        const ProgramResult result = workplace.run(
            "relief-mesh decimate out/sheet.glb out/low.glb --report out/low.json " + options);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return json::parse(workplace.read("out/low.json"));
    };
    const auto border_vertices = [&] {
        std::set<std::tuple<float, float, float>> places;
        for (const int primitive : {0, 1}) {
            const GltfDocument document = read_document(workplace / "out/low.glb");
            for (const glm::vec3& p :
                 document.mesh({0, static_cast<std::size_t>(primitive)}).positions) {
                if (std::abs(p.x) > 0.9999F || std::abs(p.y) > 0.9999F)
                    places.emplace(p.x, p.y, p.z);
            }
        }
        return places.size();
    };
    const auto seam_vertices = [&] {
        return places_near_the_border(read_document(workplace / "out/low.glb").mesh({0, 0})).size();
    };
    decimated("--ratio 0.3");
    EXPECT_LT(border_vertices(), 90U);
    EXPECT_LT(seam_vertices(), 25U);
    json report = decimated("--ratio 0.3 --keep-borders");
    EXPECT_EQ(border_vertices(), 96U);
    EXPECT_EQ(report["options"]["keep_borders"], true);
    report = decimated("--ratio 0.3 --keep-seams");
    EXPECT_EQ(seam_vertices(), 25U);
    EXPECT_EQ(report["options"]["keep_seams"], true);

    const json free = decimated("--triangles 20");
    const json bounded = decimated("--triangles 20 --max-normal-error 10");
    EXPECT_EQ(bounded["options"]["max_normal_error"], 10.0);
    EXPECT_GT(bounded["triangles_written"], 40);
    EXPECT_LT(bounded["distance"]["of_output"]["mean_degrees"],
              free["distance"]["of_output"]["mean_degrees"]);
}

TEST(DecimateCommand, WeightsAffectTheResult) {
    const Workplace workplace;
    const auto result = [&](const std::string& options) {
        EXPECT_EQ(workplace
                      .run("relief-mesh decimate data/vase.obj out/low.ply --ratio 0.3 --report "
                           "out/low.json " +
                           options)
                      .exit_code,
                  0);
        return json::parse(workplace.read("out/low.json"));
    };
    const json plain = result("");
    const json shape_only = result("--weights texcoords=0,normals=0");
    EXPECT_EQ(shape_only["options"]["weights"], json({{"texcoords", 0.0},
                                                      {"normals", 0.0},
                                                      {"colors", 0.01},
                                                      {"joints", 0.01},
                                                      {"targets", 1.0}}));
    // Without the texture, only the shape counts, so it is nearer.
    EXPECT_LT(shape_only["distance"]["of_input"]["rms"], plain["distance"]["of_input"]["rms"]);
}

TEST(DecimateCommand, VerticesMoveToTheSurfaceUnlessTheyAreKept) {
    const Workplace workplace;
    const auto result = [&](const std::string& file, const std::string& options) {
        const ProgramResult run =
            workplace.run("relief-mesh decimate data/vase.obj " + file +
                          " --ratio 0.1 --normals angle --report out/low.json" + options);
        EXPECT_EQ(run.exit_code, 0) << run.error;
        return json::parse(workplace.read("out/low.json"));
    };
    const json moved = result("out/moved.glb", "");
    const json kept = result("out/kept.glb", " --keep-positions");
    EXPECT_LT(moved["distance"]["of_input"]["rms"],
              0.8 * double(kept["distance"]["of_input"]["rms"]));
    EXPECT_LE(moved["distance"]["of_output"]["max"],
              1.5 * double(kept["distance"]["of_output"]["max"]));
    EXPECT_EQ(kept["options"]["keep_positions"], true);
    const Mesh a = read_document(workplace / "out/moved.glb").mesh({0, 0});
    const Mesh b = read_document(workplace / "out/kept.glb").mesh({0, 0});
    EXPECT_NEAR(double(a.triangles.size()), double(b.triangles.size()), 2.0);
    EXPECT_NE(a.positions, b.positions);
    // The bounds in the file are those of the new positions.
    Report report;
    GltfDocument::read(workplace / "out/moved.glb", report);
    EXPECT_TRUE(report.findings().empty());
}

TEST(DecimateCommand, ARiggedModelKeepsItsRigOnTheVerticesThatStay) {
    RELIEF_NEEDS_SHARED(model, "data/models/gltf/CesiumMan/glTF-Binary/CesiumMan.glb");
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-mesh decimate " + model.string() + " out/man.gltf --ratio 0.3");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const json root = json::parse(workplace.read("out/man.gltf"));
    const json& primitive = root["meshes"][0]["primitives"][0];
    const std::size_t count =
        root["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()]["count"];
    for (const char* name : {"JOINTS_0", "WEIGHTS_0", "TEXCOORD_0", "NORMAL"}) {
        EXPECT_EQ(root["accessors"][primitive["attributes"][name].get<std::size_t>()]["count"],
                  count)
            << name;
    }
    EXPECT_EQ(root["skins"].size(), 1U);
    const Mesh before = read_document(model).mesh({0, 0});
    const Mesh after = read_document(workplace / "out/man.gltf").mesh({0, 0});
    EXPECT_NEAR(double(after.triangles.size()), 0.3 * double(before.triangles.size()), 1.0);
}

TEST(SubdivideCommand, MakesFourOfEachAndKeepsMaterials) {
    const Workplace workplace;
    write_sheet(workplace, "sheet.obj", 6);
    ASSERT_EQ(workplace.run("relief-mesh process sheet.obj out/sheet.glb").exit_code, 0);
    const ProgramResult result = workplace.run(
        "relief-mesh subdivide out/sheet.glb out/fine.glb --levels 2 --report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("result    1152 triangles, "));
    const GltfDocument document = read_document(workplace / "out/fine.glb");
    EXPECT_EQ(document.mesh({0, 0}).triangles.size(), 576U);
    EXPECT_EQ(document.mesh({0, 1}).triangles.size(), 576U);
    EXPECT_EQ(document.view().materials.size(), 2U);
    EXPECT_EQ(places_near_the_border(document.mesh({0, 0})).size(), 25U);
    EXPECT_EQ(places_near_the_border(document.mesh({0, 0})),
              places_near_the_border(document.mesh({0, 1})));
    EXPECT_EQ(json::parse(workplace.read("out/r.json"))["options"],
              json({{"levels", 2}, {"normals", "keep"}}));
}

TEST(Reshaping, SeveralModelsKeepTheirNames) {
    const Workplace workplace;
    write_sheet(workplace, "a.obj", 8);
    write_sheet(workplace, "b.obj", 6);
    workplace.write("bad.obj", "f 1 2 3\n");
    const ProgramResult result = workplace.run(
        "relief-mesh decimate a.obj bad.obj b.obj -o out/ --format glb --ratio 0.5 --report "
        "out/r.json");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("relief-mesh: error: bad.obj: "));
    EXPECT_THAT(result.out, HasSubstr("out/a.glb: 128 -> 64 triangles, "));
    EXPECT_THAT(result.out, HasSubstr("out/b.glb: 72 -> 36 triangles, "));
    EXPECT_THAT(result.out, HasSubstr("in all    3 files, 1 failed\n"));
    const json report = json::parse(workplace.read("out/r.json"));
    EXPECT_EQ(report["tool"], "relief-mesh decimate");
    ASSERT_EQ(report["files"].size(), 3U);
    EXPECT_EQ(report["files"][0]["triangles_written"], 64);
    EXPECT_TRUE(report["files"][0].contains("distance"));
    EXPECT_EQ(workplace.outputs(), "a.glb b.glb r.json");
    // Separate calls write the same bytes.
    ASSERT_EQ(workplace.run("relief-mesh decimate a.obj out/alone.glb --ratio 0.5").exit_code, 0);
    EXPECT_EQ(workplace.read("out/a.glb"), workplace.read("out/alone.glb"));
    const ProgramResult finer =
        workplace.run("relief-mesh subdivide a.obj b.obj -o out/ --format ply --quiet");
    EXPECT_EQ(finer.exit_code, 0) << finer.error;
    EXPECT_EQ(finer.out, "");
    EXPECT_EQ(workplace.outputs(), "a.glb a.ply alone.glb b.glb b.ply r.json");
}

TEST(SubdivideCommand, ARiggedModelIsRefused) {
    RELIEF_NEEDS_SHARED(model, "data/models/gltf/CesiumMan/glTF-Binary/CesiumMan.glb");
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("relief-mesh subdivide " + model.string() + " out/man.glb");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("which another mesh cannot take over"));
    EXPECT_EQ(workplace.outputs(), "");
}

TEST(ReshapingRefusal, StatesTheReasonAndWritesNoFile) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("flat.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n");
    expect_refusals(
        workplace, "relief-mesh", "old.glb",
        {{"relief-mesh decimate square.obj out/old.glb", 2,
          "no limit is given (give --triangles N, --ratio R or --max-error E)"},
         {"relief-mesh decimate square.obj out/old.glb --triangles 1 --ratio 0.5", 2,
          "--triangles and --ratio contradict each other (give one of them)"},
         {"relief-mesh decimate square.obj out/old.glb --triangles 0", 2,
          "--triangles 0: not between 1 and "},
         {"relief-mesh decimate square.obj out/old.glb --ratio 1.5", 2,
          "--ratio 1.5: not between 0 and 1"},
         {"relief-mesh decimate square.obj out/old.glb --ratio 150%", 2,
          "--ratio 150%: not between 0 and 100 %"},
         {"relief-mesh decimate square.obj out/old.glb --ratio %", 2, "--ratio %: not a number"},
         {"relief-mesh decimate square.obj out/old.glb --max-error -1", 2,
          "--max-error -1: not at least 0"},
         {"relief-mesh decimate square.obj out/old.glb --ratio 0.5 --max-normal-error 0", 2,
          "--max-normal-error 0: not between 0.001 and 180 degrees"},
         {"relief-mesh decimate square.obj out/old.glb --ratio 0.5 --measure half", 2,
          "--measure half: "},
         {"relief-mesh decimate square.obj out/old.glb --ratio 0.5 --quiet --measure full", 2,
          "--measure full: has no effect with --quiet without --report (leave it out, or add "
          "--report)"},
         {"relief-mesh decimate square.obj -o out/many/ --ratio 0.5 --measure quick", 2,
          "--measure quick: has no effect on several models without --report"},
         {"relief-mesh decimate square.obj out/old.glb --max-normal-error 20", 2,
          "no limit is given (give --triangles N, --ratio R or --max-error E)"},
         {"relief-mesh decimate square.obj out/old.glb --ratio 0.5 --weights normals", 2,
          "--weights normals: 'normals': not NAME=WEIGHT (for example normals=0.1,colors=0.01)"},
         {"relief-mesh decimate square.obj out/old.glb --ratio 0.5 --weights shine=1", 2,
          "--weights shine=1: 'shine=1': not one of texcoords, normals, colors, joints, targets"},
         {"relief-mesh decimate square.obj out/old.glb --ratio 0.5 --weights colors=-1", 2,
          "--weights colors=-1: 'colors=-1': not at least 0"},
         {"relief-mesh decimate square.obj out/old.glb --ratio 0.5 --weights colors=1,colors=2", 2,
          "--weights colors=1,colors=2: colors is given twice"},
         {"relief-mesh decimate square.obj out/old.glb --ratio 0.5 --normals angle --weights "
          "normals=1",
          2, "--weights normals: has no effect with --normals angle, which replaces them"},
         {"relief-mesh decimate missing.obj out/old.glb --ratio 0.5", 1, "missing.obj: "},
         {"relief-mesh decimate flat.obj out/old.glb --ratio 0.5", 1,
          "flat.obj: none of its triangles has an area"},
         {"relief-mesh subdivide flat.obj out/old.glb", 1,
          "flat.obj: none of its triangles has an area"},
         {"relief-mesh subdivide square.obj out/old.glb --levels 0", 2,
          "--levels 0: not between 1 and 12"},
         {"relief-mesh subdivide square.obj out/new.stl", 2,
          "out/new.stl: .stl is not a format that can be written"}});
}

TEST(LodsCommand, WritesLevelsAndTheSizesAtWhichTheyTakeOver) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief-mesh lods data/vase.obj out/lods.gltf --triangles 2000,500 --error 2px --names "
        "--switch distance --report out/lods.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("LOD1: 2000 triangles, largest distance "));
    const json root = json::parse(workplace.read("out/lods.gltf"));
    EXPECT_EQ(root["extensionsUsed"], json::array({"MSFT_lod"}));
    EXPECT_FALSE(root.contains("extensionsRequired"));
    ASSERT_EQ(root["nodes"].size(), 3U);
    EXPECT_EQ(root["nodes"][0]["extensions"]["MSFT_lod"]["ids"], json::array({1, 2}));
    EXPECT_EQ(root["scenes"][0]["nodes"], json::array({0})) << "lower levels are in no scene";
    for (std::size_t i = 0; i < 3; ++i) {
        const json& node = root["nodes"][i];
        EXPECT_EQ(node["name"], "vase_LOD" + std::to_string(i));
        EXPECT_EQ(node["mesh"], i);
        const json& primitive = root["meshes"][i]["primitives"][0];
        EXPECT_EQ(primitive["material"], 0);
        EXPECT_TRUE(
            root["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()].contains(
                "min"));
    }
    const GltfDocument document = read_document(workplace / "out/lods.gltf");
    const Mesh input = document.mesh({0, 0});
    EXPECT_EQ(input.triangles.size(), 5760U);
    std::set<std::pair<float, float>> texcoords;
    for (const glm::vec2& uv : input.texcoords)
        texcoords.emplace(uv.x, uv.y);
    const json report = json::parse(workplace.read("out/lods.json"));
    const json& coverages = root["nodes"][0]["extras"]["MSFT_screencoverage"];
    ASSERT_EQ(coverages.size(), 3U);
    EXPECT_EQ(coverages[2], 0.0);
    const Bounds bounds = bounds_of(input);
    const double diameter = glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
    double before = 1.0;
    for (std::size_t i = 0; i < 2; ++i) {
        const Mesh level = document.mesh({i + 1, 0});
        EXPECT_EQ(level.triangles.size(), i == 0 ? 2000U : 500U);
        for (const glm::vec2& uv : level.texcoords)
            ASSERT_TRUE(texcoords.contains({uv.x, uv.y})) << "one map serves all levels";
        const json& reported = report["levels"][i];
        EXPECT_EQ(reported["triangles"], level.triangles.size());
        const SurfaceDistance distance = surface_distance(input, level);
        const double largest = std::max(distance.from_a.max, distance.from_b.max);
        const double pixels = 2.0 * diameter / largest;
        EXPECT_NEAR(reported["pixels"].get<double>(), pixels, 1e-6 * pixels);
        const double area = std::numbers::pi / 4.0 * pixels * pixels;
        const double coverage = coverages[i].get<double>();
        EXPECT_NEAR(coverage, area / (1920.0 * 1080.0), 1e-6);
        EXPECT_LT(coverage, before);
        before = coverage;
    }
}

TEST(LodsCommand, KeepsTheChildrenOfANodeOutOfItsLevels) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh process data/vase.obj out/vase.gltf").exit_code, 0);
    json root = json::parse(workplace.read("out/vase.gltf"));
    root["nodes"][0]["children"] = json::array({1});
    root["nodes"][0]["translation"] = {1, 2, 3};
    root["nodes"].push_back({{"name", "handle"}});
    workplace.write("out/vase.gltf", root.dump());
    ASSERT_EQ(workplace
                  .run("relief-mesh lods out/vase.gltf out/lods.gltf --levels 1 --names "
                       "--switch distance")
                  .exit_code,
              0);
    root = json::parse(workplace.read("out/lods.gltf"));
    ASSERT_EQ(root["nodes"].size(), 4U);
    EXPECT_EQ(root["nodes"][0]["children"], json::array({1, 2}));
    EXPECT_FALSE(root["nodes"][0].contains("mesh"));
    EXPECT_EQ(root["nodes"][2]["name"], "vase_LOD0");
    EXPECT_EQ(root["nodes"][2]["extensions"]["MSFT_lod"]["ids"], json::array({3}));
    EXPECT_FALSE(root["nodes"][2].contains("translation"));
    EXPECT_EQ(root["nodes"][3]["name"], "vase_LOD1");
    EXPECT_EQ(read_document(workplace / "out/lods.gltf").view().primitives.size(), 1U);
    for (const std::string separate : {"", " --separate"}) {
        const auto again = workplace.run(
            "relief-mesh lods out/lods.gltf out/again.glb --levels 1 --switch distance" + separate);
        EXPECT_EQ(again.exit_code, 1);
        EXPECT_THAT(again.error, testing::HasSubstr("already has levels of detail"));
    }
    workplace.write("old.glb", "old");
    expect_refusals(workplace, "relief-mesh", "old.glb",
                    {{"relief-mesh lods data/vase.obj out/old.glb --preview out/p.html", 2,
                      "--preview: shows separate files (add --separate, or leave it out)"},
                     {"relief-mesh lods data/vase.obj out/old.glb --separate --preview out/p.png",
                      2, "--preview out/p.png: the format is not supported (use .html)"},
                     {"relief-mesh lods data/vase.obj out/old.glb --names --separate", 2,
                      "--names: has no effect with --separate, whose files have no levels (leave "
                      "one of them out)"},
                     {"relief-mesh lods data/vase.obj out/old.ply", 2,
                      "out/old.ply: cannot store levels of detail (write a .glb or .gltf)"},
                     {"relief-mesh lods data/vase.obj out/old.glb --levels 2 --triangles 5", 2,
                      "--levels and --triangles contradict each other (give one of them)"},
                     {"relief-mesh lods data/vase.obj out/old.glb --triangles 500,500", 2,
                      "--triangles: 500 is not less than 500 (give the finest level first)"},
                     {"relief-mesh lods out/old_LOD1.glb out/old.glb --separate", 2,
                      "--separate out/old_LOD1.glb: is also the input or the output"},
                     {"relief-mesh lods data/vase.obj out/old.glb --separate --report "
                      "out/old_LOD3.glb",
                      2, "--report out/old_LOD3.glb: is also the input or the output"},
                     {"relief-mesh lods data/vase.obj out/old.glb --error 0", 2,
                      "--error 0: not between 0.001 and 1000 pixels"}});
}

TEST_LABELS(not_sanitized);
TEST(LodsCommand, ShowsTheLevelsOnAPage) {
    const Workplace workplace;
    const ProgramResult result = workplace.run(
        "relief-mesh lods data/vase.obj out/v.glb --triangles 1000,300 --switch distance "
        "--separate --preview out/levels.html --quiet");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(workplace.outputs(), "levels.html v_LOD0.glb v_LOD1.glb v_LOD2.glb");
    const std::string page = workplace.read("out/levels.html");
    EXPECT_THAT(page, testing::HasSubstr("<title>levels</title>"));
    EXPECT_GT(page.size(), 100'000U);
    EXPECT_LT(page.size(), 1'500'000U);
}

/// Runs `relief-mesh lods` and returns its report.
json lods_report(const Workplace& workplace, const std::string& arguments) {
    const ProgramResult result =
        workplace.run("relief-mesh lods " + arguments + " --report out/lods.json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return json::parse(workplace.read("out/lods.json"));
}

TEST_LABELS(not_sanitized);
TEST(LodsCommand, SwitchesAtTheDistanceOfEqualDifference) {
    const Workplace workplace;
    const std::string line = "data/vase.obj out/lods.gltf --triangles 700,150";
    const json half = lods_report(workplace, line + " --error 0.5px");
    const json two = lods_report(workplace, line + " --error 2px");
    const json by_distance = lods_report(workplace, line + " --error 0.5px --switch distance");
    EXPECT_EQ(half["flip_not_measured"], nullptr);
    for (std::size_t i = 0; i < 2; ++i) {
        const json& level = half["levels"][i];
        EXPECT_GT(level["flip"], 0.0);
        EXPECT_LE(level["flip"], level["flip_of_moved_input"]);
        EXPECT_LT(level["flip_of_moved_input"], 0.6);
        const double step = 4.0 * std::log2(level["pixels"].get<double>());
        EXPECT_NEAR(step, std::round(step), 1e-6);
        const json& exact = by_distance["levels"][i];
        EXPECT_EQ(level["distance"]["sampled"], true);
        EXPECT_EQ(exact["distance"]["sampled"], false);
        const double largest = exact["distance_pixels"].get<double>() *
                               level["pixels"].get<double>() / exact["pixels"].get<double>();
        EXPECT_LE(level["distance_pixels"].get<double>(), largest * (1.0 + 1e-6))
            << "samples do not exceed the largest distance";
        EXPECT_GT(level["distance_pixels"].get<double>(), 0.3 * largest);
        EXPECT_NEAR(by_distance["levels"][i]["distance_pixels"], 0.5, 1e-6);
        EXPECT_EQ(by_distance["levels"][i]["flip"], nullptr);
        EXPECT_GT(two["levels"][i]["pixels"], level["pixels"]) << "a larger error is permitted";
    }
    EXPECT_LT(half["levels"][1]["pixels"], half["levels"][0]["pixels"]);
}

/// Returns the steps of 2^(1/4) of the sizes at which levels take over.
std::vector<int> steps_of(const json& levels) {
    std::vector<int> steps;
    for (const json& level : levels)
        steps.push_back(
            static_cast<int>(std::lround(4.0 * std::log2(level["pixels"].get<double>()))));
    return steps;
}

TEST_LABELS(not_sanitized);
TEST(LodsCommand, TheSizesOfKnownModelsAreThoseOfAnExhaustiveSearch) {
    // Found by drawing each size in full. Drivers may differ by a step.
    const Workplace workplace;
    const std::vector<int> vase = steps_of(lods_report(workplace, "data/vase.obj a.glb")["levels"]);
    EXPECT_THAT(vase, testing::Pointwise(testing::DoubleNear(1.0), {33, 28, 24}));
    const std::vector<int> urn =
        steps_of(lods_report(workplace, "data/urn-low.obj b.glb")["levels"]);
    EXPECT_THAT(urn, testing::Pointwise(testing::DoubleNear(1.0), {24, 21, 18}));
}

TEST_LABELS(not_sanitized);
TEST(LodsCommand, AFolderGetsTheLevelsOfEachModelOfAList) {
    const Workplace workplace;
    workplace.write("list.txt", "data/urn-low.obj\nsquare.obj\n");
    workplace.write_square("square.obj");
    workplace.write("damaged.obj", "v 0 0\n");
    const ProgramResult result = workplace.run(
        "relief-mesh lods @list.txt damaged.obj -o out/ --format gltf --report lods.json");
    EXPECT_EQ(result.exit_code, 1) << "one model fails, the others are written";
    EXPECT_THAT(result.out, HasSubstr("out/urn-low.gltf: 720 -> 360 below "));
    EXPECT_THAT(result.error, HasSubstr("damaged.obj"));
    EXPECT_EQ(workplace.outputs(), "square.bin square.gltf urn-low.bin urn-low.gltf");
    const json report = json::parse(workplace.read("lods.json"));
    EXPECT_EQ(report["failed"], 1);
    ASSERT_EQ(report["files"].size(), 3U);
    const json& levels = report["files"][0]["levels"];
    const json alone = lods_report(workplace, "data/urn-low.obj alone.glb");
    EXPECT_EQ(steps_of(levels), steps_of(alone["levels"]));
    ASSERT_EQ(levels.size(), 3U);
    for (const json& level : levels) {
        EXPECT_EQ(level["file"], "out/urn-low.gltf");
        ASSERT_EQ(level["meshes"].size(), 1U);
        EXPECT_EQ(level["meshes"][0]["mesh"], 0);
        EXPECT_EQ(level["meshes"][0]["triangles"], level["triangles"]);
        EXPECT_EQ(level["meshes"][0]["pixels"], level["pixels"]);
    }
}

TEST(LodsCommand, LevelsOfOneModelDoNotReplaceFilesOfAnother) {
    const Workplace workplace;
    workplace.write_square("a.obj");
    workplace.write_square("a_LOD1.obj");
    ASSERT_EQ(workplace.run("relief-mesh process a.obj a.glb").exit_code, 0);
    ASSERT_EQ(workplace.run("relief-mesh process a.obj a_LOD1.glb").exit_code, 0);
    workplace.write("old.glb", "old");
    expect_refusals(workplace, "relief-mesh", "old.glb",
                    {{"relief-mesh lods a.glb a_LOD1.glb -o ./ --separate", 2,
                      "--separate ./a_LOD1.glb: is also another file of the command"},
                     {"relief-mesh lods a.obj out/old.glb --format glb", 2,
                      "--format: the name out/old.glb already has a format (omit --format, or give "
                      "a folder: -o out/)"},
                     {"relief-mesh lods a.obj a.glb -o out/", 2,
                      "a.obj and a.glb: have the same output out/a.glb"},
                     {"relief-mesh lods a.obj", 2, "OUT is missing"}});
}

TEST(LodsCommand, WithoutOpenGLUsesDistanceWithANote) {
    const Workplace workplace;
    const std::string arguments = "relief-mesh lods data/vase.obj out/a.gltf --levels 1";
    const ProgramResult result =
        workplace.run("RELIEF_OSMESA_LIBRARY=/none RELIEF_EGL_LIBRARY=/none " + arguments +
                      " --report out/a.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("FLIP      not measured: "));
    EXPECT_THAT(result.out, HasSubstr("; the largest distance decides"));
    const json report = json::parse(workplace.read("out/a.json"));
    EXPECT_THAT(report["flip_not_measured"].get<std::string>(), HasSubstr("/none"));
    EXPECT_EQ(report["levels"][0]["flip"], nullptr);
    EXPECT_NEAR(report["levels"][0]["distance_pixels"], 0.5, 1e-6);
}

TEST(LodsCommand, AnErrorAloneMakesLevelsUntilOneCannotGetSmaller) {
    const Workplace workplace;
    write_sheet(workplace, "sheet.obj", 24);
    const json report =
        lods_report(workplace, "sheet.obj out/a.gltf --error 0.5px --switch distance");
    const json root = json::parse(workplace.read("out/a.gltf"));
    const std::size_t levels = report["levels"].size();
    EXPECT_GT(levels, 4U);
    EXPECT_EQ(root["meshes"].size(), levels + 1) << "the level that is too large is removed";
    double before = 1152.0;
    for (const json& level : report["levels"]) {
        EXPECT_LE(level["triangles"], 0.75 * before);
        EXPECT_GE(level["pixels"], 1.0);
        before = level["triangles"];
    }
    EXPECT_LT(before, 40.0);
    for (std::size_t a = 0; a < root["accessors"].size(); ++a) {
        bool is_used = false;
        for (const json& mesh : root["meshes"]) {
            for (const json& primitive : mesh["primitives"]) {
                is_used = is_used || primitive["indices"] == a;
                for (const auto& [name, accessor] : primitive["attributes"].items())
                    is_used = is_used || accessor == a;
            }
        }
        EXPECT_TRUE(is_used) << "accessor " << a << " belongs to the removed level";
    }
    // One triangle cannot get smaller, so there is no level.
    workplace.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(lods_report(workplace, "one.obj out/b.glb --error 1px")["levels"].size(), 0U);
}

TEST(LodsCommand, SeparateFilesHoldALevelEach) {
    const Workplace workplace;
    const json report =
        lods_report(workplace, "data/vase.obj out/vase.gltf --triangles 2000,500 --separate");
    EXPECT_EQ(workplace.outputs(),
              "lods.json vase_LOD0.bin vase_LOD0.gltf vase_LOD1.bin vase_LOD1.gltf vase_LOD2.bin "
              "vase_LOD2.gltf");
    const std::array<std::size_t, 3> triangles = {5760, 2000, 500};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string file = "out/vase_LOD" + std::to_string(i) + ".gltf";
        EXPECT_EQ(read_document(workplace / file).mesh({0, 0}).triangles.size(), triangles[i]);
        const json root = json::parse(workplace.read(file));
        EXPECT_EQ(root["meshes"].size(), 1U);
        EXPECT_FALSE(root.contains("extensionsUsed"));
    }
    EXPECT_NE(report["levels"][1]["flip"], nullptr);
    EXPECT_EQ(report["levels"][1]["file"], "out/vase_LOD2.gltf");
}

TEST(LodsCommand, ARiggedModelKeepsItsRigInEachLevel) {
    RELIEF_NEEDS_SHARED(model, "data/models/gltf/CesiumMan/glTF-Binary/CesiumMan.glb");
    const Workplace workplace;
    lods_report(workplace, model.string() + " out/man.gltf --levels 2 --switch distance");
    const json root = json::parse(workplace.read("out/man.gltf"));
    ASSERT_EQ(root["meshes"].size(), 3U);
    for (const json& mesh : root["meshes"]) {
        const json& attributes = mesh["primitives"][0]["attributes"];
        const auto count = [&](const char* name) {
            return root["accessors"][attributes[name].get<std::size_t>()]["count"];
        };
        EXPECT_EQ(count("JOINTS_0"), count("POSITION"));
        EXPECT_EQ(count("WEIGHTS_0"), count("POSITION"));
    }
    std::size_t skinned = 0;
    for (const json& node : root["nodes"])
        skinned += node.contains("mesh") && node.contains("skin") ? 1 : 0;
    EXPECT_EQ(skinned, 3U);
}

}  // namespace
}  // namespace relief::tools
