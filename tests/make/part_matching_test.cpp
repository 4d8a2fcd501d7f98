// SPDX-License-Identifier: Apache-2.0
// Rays from a part of an asset hit only the part of the source of the same name.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr int side = 24;

/// A sheet with a color: the square from -1 to 1, or its left half; heights alternate.
std::string sheet(const std::string& name, double height, double bump, int columns,
                  const std::string& color, int first_vertex = 1) {
    std::string text = name.empty() ? "" : "o " + name + "\n";
    for (int y = 0; y <= side; ++y) {
        for (int x = 0; x <= columns; ++x)
            text += fmt::format("v {} {} {} {}\n", 2.0 * x / side - 1.0, 2.0 * y / side - 1.0,
                                height + bump * ((x * x + 3 * y) % 4), color);
    }
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < columns; ++x) {
            const int a = first_vertex + y * (columns + 1) + x;
            const int b = a + columns + 1;
            text += fmt::format("f {} {} {}\nf {} {} {}\n", a, a + 1, b + 1, a, b + 1, b);
        }
    }
    return text;
}

constexpr int body_vertices = (side + 1) * (side + 1);
const std::string red = "1 0 0";
const std::string green = "0 1 0";

/// A flat red body, and a rough green jacket above its left half.
class Overlap : public testing::Test {
  protected:
    Overlap() {
        workplace.write("out/body.obj", sheet("", 0.0, 0.0, side, red));
        workplace.write("out/jacket.obj", sheet("", 0.01, 0.01, side / 2, green));
    }

    /// Writes both into one file.
    void write_both(const std::string& body, const std::string& jacket) const {
        workplace.write("out/both.obj",
                        sheet(body, 0.0, 0.0, side, red) +
                            sheet(jacket, 0.01, 0.01, side / 2, green, 1 + body_vertices));
    }

    /// Writes both as nodes of a glTF file.
    void write_nodes(const std::string& body, const std::string& jacket) const {
        write_both(body, jacket);
        ASSERT_EQ(workplace.run("relief-mesh process out/both.obj out/both.gltf").exit_code, 0);
        json document = json::parse(workplace.read("out/both.gltf"));
        json part = document["meshes"][0]["primitives"][0];
        json& accessors = document["accessors"];
        const std::size_t indices = part["indices"];
        json of_jacket = accessors[indices];
        constexpr int body_indices = 6 * side * side;
        const int bytes = of_jacket["componentType"] == 5125 ? 4 : 2;
        of_jacket["byteOffset"] = of_jacket.value("byteOffset", 0) + bytes * body_indices;
        of_jacket["count"] = of_jacket["count"].get<int>() - body_indices;
        accessors[indices]["count"] = body_indices;
        part["indices"] = accessors.size();
        accessors.push_back(of_jacket);
        document["meshes"].push_back({{"primitives", {part}}});
        document["nodes"] = {{{"name", body}, {"mesh", 0}}, {{"name", jacket}, {"mesh", 1}}};
        document["scenes"] = {{{"nodes", {0, 1}}}};
        workplace.write("out/both.gltf", document.dump());
    }

    [[nodiscard]] ProgramResult make(const std::string& files, const std::string& more = "") const {
        return workplace.run("relief make " + files +
                             " -o out/a.glb --triangles 300 --size 128 --padding 2 "
                             "--occlusion-rays 8 --remesh never --report out/a.json " +
                             more);
    }

    /// Returns the share of the body's triangles whose center is green.
    [[nodiscard]] double leak() const {
        const GltfDocument document = test::read_document(workplace / "out/a.glb");
        const Mesh mesh = document.mesh({0, 0});
        const GltfView view = document.view();
        const Texture* texture = find_texture(view.materials.front(), TextureSlot::base_color);
        const Image map =
            read_image(std::get<std::vector<std::byte>>(view.images[texture->image].source), "map",
                       ImageUse::color);
        const auto samples = map.as<std::uint8_t>();
        int all = 0, wrong = 0;
        for (const glm::uvec3& t : mesh.triangles) {
            const float height =
                std::max({mesh.positions[t.x].z, mesh.positions[t.y].z, mesh.positions[t.z].z});
            if (height > 0.005F) continue;
            const glm::vec2 uv =
                (mesh.texcoords[t.x] + mesh.texcoords[t.y] + mesh.texcoords[t.z]) / 3.0F;
            const auto x = static_cast<std::size_t>(uv.x * static_cast<float>(map.width));
            const auto y = static_cast<std::size_t>(uv.y * static_cast<float>(map.height));
            const std::size_t texel = 3 * (y * static_cast<std::size_t>(map.width) + x);
            ++all;
            if (samples[texel + 1] > samples[texel]) ++wrong;
        }
        EXPECT_GT(all, 1);
        return static_cast<double>(wrong) / all;
    }

    [[nodiscard]] json report() const { return json::parse(workplace.read("out/a.json")); }

    Workplace workplace;
};

TEST_F(Overlap, OfFilesDoesNotLeak) {
    ASSERT_EQ(make("out/body.obj --with out/jacket.obj", "--match all").exit_code, 0);
    EXPECT_GT(leak(), 0.3);
    EXPECT_EQ(report()["parts"]["reason"], "it was requested");
    const ProgramResult matched = make("out/body.obj --with out/jacket.obj");
    ASSERT_EQ(matched.exit_code, 0) << matched.error;
    EXPECT_EQ(leak(), 0.0);
    EXPECT_THAT(matched.out, HasSubstr("2 matched by name: body, jacket"));
    const json parts = report()["parts"];
    EXPECT_EQ(parts["matched"], true);
    EXPECT_EQ(parts["parts"][0]["source_triangles"], 2 * side * side);
    EXPECT_EQ(parts["parts"][1]["source_triangles"], side * side);
    EXPECT_EQ(parts["parts"][0]["triangles"].get<std::size_t>() +
                  parts["parts"][1]["triangles"].get<std::size_t>(),
              report()["triangles"].get<std::size_t>());
}

TEST_F(Overlap, OfObjectsWithNamesOfTheConventionDoesNotLeak) {
    write_both("Body_high", "Jacket_High.001");
    ASSERT_EQ(make("out/both.obj").exit_code, 0);
    EXPECT_EQ(leak(), 0.0);
    EXPECT_EQ(report()["parts"]["parts"][1]["name"], "jacket");
    // The same as nodes of glTF.
    write_nodes("body", "Jacket");
    ASSERT_EQ(make("out/both.gltf").exit_code, 0);
    EXPECT_EQ(leak(), 0.0);
    EXPECT_EQ(report()["parts"]["parts"][1]["name"], "jacket");
}

TEST_F(Overlap, OfPartsWithOneNameOrWithoutNamesLeaks) {
    write_both("x_high", "X_high.001");
    const ProgramResult same = make("out/both.obj");
    EXPECT_GT(leak(), 0.3);
    EXPECT_THAT(same.out, Not(HasSubstr("matched by name")));
    EXPECT_TRUE(report()["parts"]["reason"].is_null());
}

// Rays at the border between parts that touch must hit both.
TEST_F(Overlap, OfPartsThatTouchIsOnePart) {
    workplace.write("out/more.obj", sheet("", 0.0, 0.0, side / 2, red));
    const ProgramResult touching = make("out/body.obj --with out/more.obj --with out/jacket.obj");
    ASSERT_EQ(touching.exit_code, 0) << touching.error;
    EXPECT_EQ(report()["parts"]["parts"][0]["name"], "body + more");
    ASSERT_EQ(make("out/body.obj --with out/more.obj").exit_code, 0);
    EXPECT_EQ(report()["parts"]["reason"], "the parts of the model touch each other");
}

// The jacket still hides the body from the sky.
TEST_F(Overlap, KeepsTheOcclusionBetweenParts) {
    const auto mean_occlusion = [&] {
        const Image map = read_image(workplace / "out/s/06-bake-occlusion.png", ImageUse::data);
        double sum = 0.0;
        for (const std::uint8_t code : map.as<std::uint8_t>())
            sum += code;
        return sum / static_cast<double>(map.samples.index() == 0 ? map.sample_count() : 1);
    };
    ASSERT_EQ(make("out/body.obj", "--keep-stages out/s").exit_code, 0);
    const double alone = mean_occlusion();
    ASSERT_EQ(make("out/body.obj --with out/jacket.obj", "--keep-stages out/s").exit_code, 0);
    EXPECT_LT(mean_occlusion(), alone - 20.0);
}

class OverlapStages : public Overlap {
  protected:
    void SetUp() override {
        ASSERT_EQ(run().exit_code, 0);
        asset = workplace.read("out/a.glb");
    }
    [[nodiscard]] ProgramResult run(const std::string& more = "") const {
        return make("out/body.obj --with out/jacket.obj", "--keep-stages out/s " + more);
    }
    /// Replaces the mesh of the maps by one with objects.
    void edit(const std::string& body, const std::string& jacket) const {
        write_nodes(body, jacket);
        ASSERT_EQ(
            workplace.run("relief-mesh process out/both.gltf out/s/03-decimate.glb").exit_code, 0);
    }
    std::string asset;
};

TEST_F(OverlapStages, AreMatchedAgainIfNoFileWasEdited) {
    for (const char* stage : {"decimate", "unwrap", "frames", "bake"}) {
        SCOPED_TRACE(stage);
        const ProgramResult result = run(std::string("--from ") + stage);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        EXPECT_TRUE(workplace.read("out/a.glb") == asset) << "other bytes";
        EXPECT_EQ(report()["parts"]["matched"], true);
    }
}

TEST_F(OverlapStages, AreMatchedByTheNamesOfAnEditedFile) {
    edit("Body_low", "JACKET");
    ASSERT_EQ(run("--from unwrap").exit_code, 0);
    EXPECT_EQ(report()["parts"]["matched"], true);
    EXPECT_EQ(leak(), 0.0);
}

// Other programs show the parts, and keep their names.
TEST_F(OverlapStages, HaveTheNamesOfPartsInEachFile) {
    for (const char* file : {"01-repair.glb", "03-decimate.glb", "05-frames.glb"}) {
        const GltfView view = test::read_document(workplace / "out/s" / file).view();
        ASSERT_EQ(view.nodes.size(), 2U) << file;
        EXPECT_EQ(view.nodes[0].name, "body");
        EXPECT_EQ(view.nodes[1].name, "jacket");
    }
    const std::string decimated = (workplace / "out/s/03-decimate.glb").string();
    ASSERT_EQ(
        workplace.run("relief-mesh decimate " + decimated + " " + decimated + " --triangles 150")
            .exit_code,
        0);
    const ProgramResult result = run("--from unwrap");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("stage file that was edited"));
    EXPECT_EQ(report()["parts"]["matched"], true);
    EXPECT_EQ(leak(), 0.0);
}

TEST_F(OverlapStages, SeeAllPartsIfNamesAreMissing) {
    edit("body_low", "hat_low");
    const ProgramResult result = run("--from unwrap");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("parts that are not matched by name"));
    EXPECT_EQ(report()["parts"]["reason"], "the model has no part hat");
    EXPECT_EQ(
        make("out/body.obj --with out/jacket.obj", "--keep-stages out/t --match name").exit_code,
        0);
    std::filesystem::copy(workplace / "out/s/03-decimate.glb", workplace / "out/t/03-decimate.glb",
                          std::filesystem::copy_options::overwrite_existing);
    const ProgramResult named = make("out/body.obj --with out/jacket.obj",
                                     "--keep-stages out/t --match name --from unwrap");
    EXPECT_EQ(named.exit_code, 1);
    EXPECT_THAT(named.error,
                HasSubstr("parts cannot be matched by name: the model has no part hat"));
}

}  // namespace
}  // namespace relief::tools
