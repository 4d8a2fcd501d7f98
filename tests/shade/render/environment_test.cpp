// SPDX-License-Identifier: Apache-2.0
// Environments from real files: six faces and the panorama they were made from look alike, and
// what does not fit is refused by name.
#include "render/environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "draw_test.h"
#include "relief/mesh/error.h"
#include "relief/shade/image_compare.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

class Environments : public test::DrawTest {};

Environment six_files(const std::filesystem::path& folder, const std::string& extension) {
    CubeFaces faces;
    const char* const names[6] = {"posx", "negx", "posy", "negy", "posz", "negz"};
    for (std::size_t i = 0; i < 6; ++i) {
        const std::filesystem::path file = folder / (names[i] + extension);
        faces.faces[i] = {file.string(), file};
    }
    return {faces, 1.0F, true};
}

Scene mirror_ball(const Environment& environment) {
    Material mirror = test::black_material();
    mirror.reflectivity = mirror.grazing_reflectivity = glm::vec3(1.0F);
    Scene scene = test::scene_of(test::sphere(96, 48), mirror);
    scene.environment = environment;
    return scene;
}

TEST_F(Environments, LookAlikeAsSixFacesAndAsAPanorama) {
    RELIEF_NEEDS_SHARED(cube, "data/env/cube/venice_sunset_256");
    RELIEF_NEEDS_SHARED(panorama, "data/env/equirect/venice_sunset_1k.hdr");
    const FrameSettings settings{256, 256, 1, OutputCoding::srgb};
    const Image faces = render(mirror_ball(six_files(cube, ".hdr")), settings).image;
    const Environment round{Equirectangular{{panorama.string(), panorama}}, 1.0F, true};
    const Image equirect = render(mirror_ball(round), settings).image;
    const ImageDifference difference = compare(faces, equirect);
    // The faces were made with mantissas rounded down: half a percent darker, a code or two.
    EXPECT_LE(difference.mean, 1.5);
    Environment turned = round;
    std::get<Equirectangular>(turned.source).image.source =
        test::constant_image({0.2F, 0.2F, 0.2F, 1}, 3, 32, ColorSpace::linear);
    EXPECT_GT(compare(faces, render(mirror_ball(turned), settings).image).mean, 20.0);
}

TEST_F(Environments, NameTheFaceThatDoesNotFit) {
    Environment environment = test::constant_environment(glm::vec3(0.5F), true);
    auto& faces = std::get<CubeFaces>(environment.source).faces;
    faces[3].source = make_image(3, 2, 3, 32, ColorSpace::linear);
    try {
        (void)render(mirror_ball(environment), {8, 8, 1, OutputCoding::srgb});
        FAIL() << "a face that is not square was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("-y"));
    }
}

TEST_F(Environments, ThatAreMissingAreFileErrors) {
    const Environment environment = six_files("/nowhere", ".png");
    try {
        (void)render(mirror_ball(environment), {8, 8, 1, OutputCoding::srgb});
        FAIL() << "missing faces were accepted";
    } catch (const FileError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("/nowhere/"));
    }
}

}  // namespace
}  // namespace relief
