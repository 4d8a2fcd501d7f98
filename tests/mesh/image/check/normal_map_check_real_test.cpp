// SPDX-License-Identifier: Apache-2.0
// What the check says of every normal map of the shared data, as its notes or its glTF material
// have it, and that it takes none of the pictures and height maps there for one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map_check.h"
#include "support/shared_data.h"

namespace relief {
namespace {

struct RealMap {
    const char* file;
    std::optional<Green> green;  ///< Absent: flakes, ripples, wires: cannot be told.
};

void PrintTo(const RealMap& map, std::ostream* out) {
    *out << map.file;
}

class RealNormalMaps : public testing::TestWithParam<RealMap> {};

/// With green the other way round.
Image green_flipped(Image map) {
    if (map.bits() == 32) {
        for (std::size_t i = 1; i < map.sample_count(); i += static_cast<std::size_t>(map.channels))
            map.as<float>()[i] = 1.0F - map.as<float>()[i];
    } else {
        for (std::size_t i = 1; i < map.sample_count(); i += static_cast<std::size_t>(map.channels))
            map.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(255 - map.as<std::uint8_t>()[i]);
    }
    return map;
}

TEST_P(RealNormalMaps, AreKnownAndTheirGreenIsToldEitherWay) {
    RELIEF_NEEDS_SHARED(file, std::string("data/") + GetParam().file);
    const Image map = read_image(file, ImageUse::data);
    const NormalMapCheck check = check_normal_map(map);
    EXPECT_EQ(check.content, MapContent::tangent_normals);
    EXPECT_EQ(check.curve, StoredCurve::none);
    EXPECT_EQ(check.green.green, GetParam().green) << check.green.correlation;
    const NormalMapCheck flipped = check_normal_map(green_flipped(map));
    if (GetParam().green) {
        EXPECT_EQ(flipped.green.green, *GetParam().green == Green::up ? Green::down : Green::up);
    } else {
        EXPECT_FALSE(flipped.green.green);
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, RealNormalMaps,
    testing::Values(
        RealMap{"textures/bricks_godot/texture_bricks_normal.jpg", Green::up},
        RealMap{"textures/cheese_godot/texture_cheese_normal.png", Green::up},
        RealMap{"textures/oiio_bump_normal/normal.exr", Green::down},
        RealMap{"textures/sand_ambientcg/sand_normal.png", Green::down},
        RealMap{"textures/rock023_ambientcg/rock023_nrm_rgh.png", Green::up},
        RealMap{"textures/parallax_bgfx/parallax-n.png", Green::down},
        RealMap{"textures/parallax_cube_bevy/cube_normal.png", Green::up},
        RealMap{"textures/materialx/mesh_wire_norm.png", std::nullopt},
        RealMap{"models/gltf/Box With Spaces/glTF/Normal Map.png", Green::up},
        RealMap{"models/gltf/BoomBox/glTF/BoomBox_normal.png", Green::up},
        RealMap{"models/gltf/Avocado/glTF/Avocado_normal.png", Green::up},
        RealMap{"models/gltf/TwoSidedPlane/glTF/TwoSidedPlane_Normal.png", Green::up},
        RealMap{"models/gltf/WaterBottle/glTF/WaterBottle_normal.png", Green::up},
        RealMap{"models/gltf-ext/tangent-pair/sphere_Texture0_Normal.png", std::nullopt},
        RealMap{"models/gltf-ext/misc/DuplicateMeshes/Texture0_Normal.png", std::nullopt},
        RealMap{"models/gltf-generator/Mesh_PrimitiveAttribute/Textures/"
                "Normal_Plane.png",
                Green::up}));

TEST(RealPictures, AreNotTakenForNormalMaps) {
    RELIEF_NEEDS_SHARED(folder, "data/textures");
    int analyzed = 0;
    for (const char* root : {"data/textures", "data/models", "data/env/cube"}) {
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(test::shared_directory() / root)) {
            const std::string name = entry.path().filename().string();
            const std::string extension = entry.path().extension().string();
            if (extension != ".png" && extension != ".jpg") continue;
            const std::string path = entry.path().string();
            if (path.find("decoder") != std::string::npos) continue;
            if (path.find("orm") != std::string::npos || path.find("nrm") != std::string::npos ||
                name == "parallax-n.png")
                continue;  // A normal map: BoomBox_normal, Normal Map, rock023_nrm_rgh, ...
            const NormalMapCheck check = check_normal_map(read_image(entry.path(), ImageUse::data));
            EXPECT_TRUE(check.has(MapCondition::not_normals)) << name;
            ++analyzed;
        }
    }
    EXPECT_GE(analyzed, 40);
}

}  // namespace
}  // namespace relief
