// SPDX-License-Identifier: Apache-2.0
// The command `relief-mesh displace`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh_file.h"
#include "tools/workplace.h"

namespace relief::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// A square from 0 to 2 in x and y whose texture coordinates run from 0 to 1.
constexpr const char* square =
    "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

void write_steps(const Workplace& workplace, const std::string& name) {
    Image image;
    image.width = 8;
    image.height = 4;
    image.channels = 1;
    std::vector<std::uint16_t> samples;
    for (int i = 0; i < 32; ++i)
        samples.push_back(i % 8 < 4 ? 0 : 65535);
    image.samples = samples;
    write_image(workplace / name, image);
}

TEST(DisplaceCommand, MovesByTheHeightAndStatesTheError) {
    const Workplace workplace;
    workplace.write("square.obj", square);
    write_steps(workplace, "steps.png");
    const ProgramResult result = workplace.run(
        "relief-mesh displace square.obj out/steps.ply --heights steps.png --height 0.5 --zero "
        "0.5 --wrap clamp --max-error 0.01 --report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("error     at most "));
    EXPECT_THAT(result.out, HasSubstr("the limit is 0.01 (unit of the scene)\n"));
    const json report = json::parse(workplace.read("out/r.json"));
    EXPECT_LE(report["error"]["max"].get<double>(), 0.01);
    EXPECT_EQ(report["error"]["triangles_above"], 0);
    EXPECT_EQ(report["error"]["is_complete"], true);
    EXPECT_EQ(report["wrap"], "clamp");
    EXPECT_EQ(report["options"]["zero"], 0.5);
    const Mesh mesh = read_mesh(workplace / "out/steps.ply").mesh;
    const Bounds bounds = bounds_of(mesh);
    EXPECT_EQ(bounds.min.z, -0.25F);
    EXPECT_EQ(bounds.max.z, 0.25F);
    // The step is between the centers of two texels, from x = 0.875 to 1.125.
    for (const glm::vec3& position : mesh.positions) {
        if (position.x <= 0.875F) {
            EXPECT_EQ(position.z, -0.25F);
        } else if (position.x >= 1.125F) {
            EXPECT_EQ(position.z, 0.25F);
        }
    }
    EXPECT_LT(mesh.triangles.size(), 400U) << "only the step is divided";
}

TEST(DisplaceCommand, PixelsGiveAnErrorByTheSizeOfTheModel) {
    const Workplace workplace;
    workplace.write("square.obj", square);
    write_steps(workplace, "steps.png");
    const auto triangles = [&](const std::string& options) {
        const std::string command =
            "relief-mesh displace square.obj out/a.glb --report out/r.json "
            "--heights steps.png --height 0.5 " +
            options;
        EXPECT_EQ(workplace.run(command).exit_code, 0);
        return json::parse(workplace.read("out/r.json"));
    };
    const json small = triangles("--pixels 10");
    const json large = triangles("--pixels 1000");
    // The diagonal of the square is 2 sqrt 2.
    EXPECT_NEAR(small["error"]["limit"].get<double>(), 0.1414, 1e-4);
    EXPECT_NEAR(large["error"]["limit"].get<double>(), 0.001414, 1e-6);
    EXPECT_LT(small["triangles_written"].get<int>(), large["triangles_written"].get<int>());
    EXPECT_EQ(small["wrap"], "repeat") << "the step across the seam is that inside of the map";
}

TEST(DisplaceCommand, KeepsMaterialsAndEndsAtTheLargestNumberOfTriangles) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh process data/vase.obj out/vase.glb").exit_code, 0);
    const ProgramResult result = workplace.run(
        "relief-mesh displace out/vase.glb out/relief.glb --heights data/bricks-height.png "
        "--height 0.05 --max-error 1e-6 --max-triangles 20000");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr(" above it: --max-triangles ended the division"));
    const GltfDocument before = read_document(workplace / "out/vase.glb");
    const GltfDocument after = read_document(workplace / "out/relief.glb");
    EXPECT_EQ(after.view().materials.size(), before.view().materials.size());
    EXPECT_LE(after.mesh({0, 0}).triangles.size(), 20000U);
    EXPECT_GT(after.mesh({0, 0}).triangles.size(), 8000U);
    EXPECT_FALSE(after.mesh({0, 0}).normals.empty());
}

TEST(DisplaceCommand, CountsHeightsAboveTheModel) {
    const Workplace workplace;
    workplace.write("square.obj", square);
    write_steps(workplace, "steps.png");
    const std::string command =
        "relief-mesh displace square.obj out/a.ply --heights steps.png "
        "--max-triangles 100 --height ";
    EXPECT_THAT(workplace.run(command + "3").out, HasSubstr("height above the size of the model"));
    EXPECT_THAT(workplace.run(command + "2").out, Not(HasSubstr("height above")));
    EXPECT_EQ(workplace.run(command + "3 --strict").exit_code, 3);
}

TEST(DisplaceCommand, RefusesWhatCannotBe) {
    const Workplace workplace;
    workplace.write("square.obj", square);
    workplace.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_steps(workplace, "steps.png");
    const auto error = [&](const std::string& options) {
        const ProgramResult result = workplace.run("relief-mesh displace " + options);
        EXPECT_NE(result.exit_code, 0);
        EXPECT_FALSE(std::filesystem::exists(workplace / "out/a.glb"));
        return result.error;
    };
    EXPECT_THAT(error("square.obj out/a.glb --height 1"), HasSubstr("--heights is missing"));
    EXPECT_THAT(error("square.obj out/a.glb --heights steps.png"),
                HasSubstr("--height is missing"));
    EXPECT_THAT(error("square.obj out/a.glb --heights none.png --height 1"), HasSubstr("none.png"));
    EXPECT_THAT(error("bare.obj out/a.glb --heights steps.png --height 1"),
                HasSubstr("(unwrap it with relief-mesh unwrap)"));
    EXPECT_THAT(error("square.obj out/a.glb --heights steps.png --height 1 --max-error 0"),
                HasSubstr("--max-error 0"));
}

}  // namespace
}  // namespace relief::test
