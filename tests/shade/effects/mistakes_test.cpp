// SPDX-License-Identifier: Apache-2.0
// The gallery of mistakes: its table, the programs that it changes, and the surfaces that each
// mistake can change.
#include "relief/shade/mistakes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>

#include "effects/shader_parts.h"
#include "relief/shade/effects.h"
#include "shade/effects/feature_sets.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const Mistake& mistake(std::string_view name) {
    const Mistake* const found = find_mistake(name);
    if (found == nullptr) throw std::runtime_error("no mistake " + std::string(name));
    return *found;
}

TEST(Mistakes, ChangeCodeThatTheirPartsHaveOnce) {
    std::set<std::string_view> names;
    for (const Mistake& each : mistakes()) {
        SCOPED_TRACE(each.name);
        EXPECT_TRUE(names.insert(each.name).second);
        EXPECT_FALSE(each.what.ends_with('.'));
        std::map<std::string_view, std::string> parts;
        for (const WrongCode& code : each.code) {
            SCOPED_TRACE(code.part);
            EXPECT_NE(code.right, code.wrong);
            const std::string text = shader_part_text(code.part, {{}, false}).text;
            const std::size_t place = text.find(code.right);
            ASSERT_NE(place, std::string::npos);
            EXPECT_EQ(text.find(code.right, place + 1), std::string::npos);
            parts[code.part] = text;
        }
        const auto texts = with_mistake(each, nullptr);
        EXPECT_EQ(texts == nullptr, each.code.empty());
        for (const auto& [part, right] : parts) {
            const ShaderPartText wrong = shader_part_text(part, *texts);
            EXPECT_FALSE(wrong.is_built_in);
            EXPECT_NE(wrong.text, right);
        }
    }
    EXPECT_EQ(find_mistake("Green"), nullptr);
}

TEST(Mistakes, LeaveAllOtherPartsAsTheyAre) {
    for (const Mistake& each : mistakes()) {
        SCOPED_TRACE(each.name);
        const auto texts = with_mistake(each, nullptr);
        if (!texts) continue;
        for (const ShaderPart& part : embedded_parts()) {
            const bool is_changed =
                std::any_of(each.code.begin(), each.code.end(),
                            [&](const WrongCode& code) { return code.part == part.address; });
            EXPECT_EQ(shader_part_text(part.address, *texts).is_built_in, !is_changed)
                << part.address;
        }
    }
}

TEST(Mistakes, BeginWithOtherTexts) {
    const auto edited = std::make_shared<const ShaderTexts>(
        ShaderTexts{{{"phong.glsl",
                      "//@part lambert implements diffuse\n\n"
                      "vec3 diffuse_scattering(float n_dot_l) { return vec3(n_dot_l); }\n"}},
                    false});
    const auto texts = with_mistake(mistake("half-vector"), edited);
    EXPECT_EQ(shader_part_text("phong.glsl#lambert", *texts).text,
              shader_part_text("phong.glsl#lambert", *edited).text);
    EXPECT_THAT(shader_part_text("phong.glsl#blinn_phong", *texts).text,
                HasSubstr("vec3 half_world = light_world + surface.view_world;"));
    EXPECT_FALSE(texts->uses_folder);
    EXPECT_EQ(with_mistake(mistake("srgb"), edited), edited);

    const auto other = std::make_shared<const ShaderTexts>(ShaderTexts{
        {{"inputs.glsl", "//@part eye\n\nvec3 to_eye(vec3 p) { return -p; }\n"}}, false});
    try {
        (void)with_mistake(mistake("eye-at-origin"), other);
        FAIL();
    } catch (const GpuError& error) {
        EXPECT_THAT(error.what(), HasSubstr("inputs.glsl#eye: the mistake 'eye-at-origin'"));
    }
}

TEST(Mistakes, StandInTheirDocumentWithTheirCode) {
    std::ifstream file(test::source_directory() / "docs/mistakes.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    for (const Mistake& each : mistakes()) {
        EXPECT_THAT(page, HasSubstr("**`" + std::string(each.name) + "`: "));
        if (each.code.empty()) continue;
        const WrongCode& code = each.code.front();
        EXPECT_THAT(page, HasSubstr("```glsl\n" + std::string(code.right) + "\n" +
                                    std::string(code.wrong) + "\n```"));
    }
}

std::string hidden(std::string_view name, const Scene& scene, const FrameSettings& settings = {}) {
    return reach_of(mistake(name), scene, settings).hidden;
}

/// A grid that all mistakes with matrices change.
Scene transformed_scene() {
    Scene scene = test::lit_scene(test::gray());
    scene.materials[0].specular = glm::vec3(0.5F);
    scene.instances[0].world_from_object = glm::mat4(1.0F);
    scene.instances[0].world_from_object[0] = {0, 1, 0, 0};
    scene.instances[0].world_from_object[1] = {-3, 0, 0, 0};
    scene.instances[0].world_from_object[3] = {1, 0, 0, 1};
    return scene;
}

TEST(Mistakes, WithMatricesNeedTheMatrix) {
    Scene scene = transformed_scene();
    EXPECT_THAT(hidden("normal-matrix", scene), IsEmpty());
    EXPECT_THAT(hidden("object-normal", scene), IsEmpty());
    EXPECT_THAT(hidden("object-position", scene), IsEmpty());
    EXPECT_THAT(hidden("eye-at-origin", scene), IsEmpty());
    glm::mat4& matrix = scene.instances[0].world_from_object;
    matrix[1] = {-1, 0, 0, 0};  // A rotation.
    EXPECT_THAT(hidden("normal-matrix", scene), HasSubstr("scaled differently"));
    EXPECT_THAT(hidden("object-normal", scene), IsEmpty());
    matrix[0] = {-1, 0, 0, 0};  // A mirror image keeps its normals only along two axes.
    matrix[1] = {0, 1, 0, 0};
    EXPECT_THAT(hidden("normal-matrix", scene), HasSubstr("scaled differently"));
    EXPECT_THAT(hidden("object-normal", scene), IsEmpty());
    matrix = glm::mat4(2.0F);
    matrix[3] = {1, 0, 0, 1};
    EXPECT_THAT(hidden("object-normal", scene), HasSubstr("rotated"));
    EXPECT_THAT(hidden("object-position", scene), IsEmpty());
    matrix = glm::mat4(1.0F);
    EXPECT_THAT(hidden("object-position", scene), HasSubstr("where their files place them"));
    scene.materials[0].specular = glm::vec3(0.0F);
    EXPECT_THAT(hidden("object-position", scene), HasSubstr("needs its position"));
    EXPECT_THAT(hidden("eye-at-origin", scene), HasSubstr("direction to the eye"));
}

TEST(Mistakes, FollowTheInterpolation) {
    Scene scene = transformed_scene();
    Material& material = scene.materials[0];
    material.double_sided = true;
    EXPECT_THAT(hidden("unit-normal", scene), IsEmpty());
    EXPECT_THAT(hidden("back-faces", scene), IsEmpty());
    material.interpolation = Interpolation::gouraud;
    EXPECT_THAT(hidden("normal-matrix", scene), IsEmpty());
    EXPECT_THAT(hidden("back-faces", scene), IsEmpty());
    EXPECT_THAT(hidden("half-vector", scene), IsEmpty());
    // Normals are of unit length at the vertices, where the lights are computed.
    EXPECT_THAT(hidden("unit-normal", scene), HasSubstr("interpolates"));
    material.interpolation = Interpolation::flat;
    EXPECT_THAT(hidden("normal-matrix", scene), HasSubstr("normals of vertices"));
    EXPECT_THAT(hidden("unit-normal", scene), HasSubstr("interpolates"));
    // Planes get their normals from derivatives, which face the eye.
    EXPECT_THAT(hidden("back-faces", scene), HasSubstr("double-sided"));
    material.interpolation = Interpolation::per_pixel;
    material.double_sided = false;
    EXPECT_THAT(hidden("back-faces", scene), HasSubstr("double-sided"));
}

/// A normal map of one texel.
void add_map(Scene& scene, NormalSpace space) {
    Image map = make_image(1, 1, 3, 8, ColorSpace::data);
    scene.images.push_back({"map", map});
    scene.materials[0].normal_map =
        NormalMap{Texture{scene.images.size() - 1}, 1.0F, Green::up, std::nullopt, space};
}

TEST(Mistakes, WithMapsFollowSpaceAndFrame) {
    Scene scene = transformed_scene();
    EXPECT_THAT(hidden("green", scene), HasSubstr("normal map in tangent space"));
    EXPECT_THAT(hidden("normal-map-srgb", scene), HasSubstr("normal map"));
    EXPECT_THAT(hidden("handedness", scene), HasSubstr("tangents of its mesh"));
    add_map(scene, NormalSpace::object);
    EXPECT_THAT(hidden("green", scene), HasSubstr("normal map in tangent space"));
    EXPECT_THAT(hidden("normal-map-srgb", scene), IsEmpty());
    EXPECT_THAT(hidden("normal-matrix", scene), IsEmpty());
    add_map(scene, NormalSpace::tangent);
    EXPECT_THAT(hidden("green", scene), IsEmpty());
    EXPECT_THAT(hidden("handedness", scene), HasSubstr("left-handed"));
    scene.instances[0].world_from_object[2] = {0, 0, -1, 0};  // Mirrored.
    EXPECT_THAT(hidden("handedness", scene), IsEmpty());
    for (glm::vec2& uv : scene.meshes[0].edit().texcoords)
        uv.x = -uv.x;
    EXPECT_THAT(hidden("handedness", scene), HasSubstr("left-handed"));
    scene.instances[0].world_from_object[2] = {0, 0, 1, 0};
    EXPECT_THAT(hidden("handedness", scene), IsEmpty());
    scene.materials[0].tangent_frame = TangentFrame::derivatives;
    EXPECT_THAT(hidden("handedness", scene), HasSubstr("tangents of its mesh"));
    EXPECT_THAT(hidden("green", scene), IsEmpty());
}

TEST(Mistakes, WithColorsNeedThem) {
    Scene scene = test::lit_scene(test::gray());
    EXPECT_THAT(hidden("srgb", scene), HasSubstr("texture of sRGB colors"));
    EXPECT_THAT(hidden("gamma-twice", scene), IsEmpty());
    EXPECT_THAT(hidden("gamma-twice", scene, {.samples = 1}), IsEmpty());
    EXPECT_THAT(hidden("gamma-twice", scene, {.output = OutputCoding::linear}),
                HasSubstr("linear"));
    Image image = make_image(1, 1, 3, 8, ColorSpace::srgb);
    scene.images = {{"colors", image}};
    scene.materials[0].opacity_texture = Texture{0};
    EXPECT_THAT(hidden("srgb", scene), HasSubstr("texture of sRGB colors"));
    scene.materials[0].diffuse_texture = Texture{0};
    EXPECT_THAT(hidden("srgb", scene), IsEmpty());
    const Scene wrong = with_mistake(mistake("srgb"), scene);
    ASSERT_EQ(wrong.images.size(), 2U);
    EXPECT_EQ(wrong.materials[0].diffuse_texture->image, 1U);
    EXPECT_EQ(wrong.materials[0].opacity_texture->image, 0U);
    image.color_space = ColorSpace::linear;
    scene.images = {{"colors", image}};
    EXPECT_THAT(hidden("srgb", scene), HasSubstr("texture of sRGB colors"));
    EXPECT_EQ(with_mistake(mistake("srgb"), scene).images.size(), 1U);
}

TEST(Mistakes, WithDirectionsFollowTheModelOfLight) {
    Scene scene = transformed_scene();
    EXPECT_THAT(hidden("half-vector", scene), IsEmpty());
    EXPECT_THAT(hidden("reflection-sign", scene), HasSubstr("mirrors the environment"));
    scene.materials[0].specular_model = SpecularModel::phong;
    EXPECT_THAT(hidden("half-vector", scene), HasSubstr("half vectors"));
    EXPECT_THAT(hidden("reflection-sign", scene), IsEmpty());
    scene.materials[0].metallic_roughness = MetallicRoughness{};
    EXPECT_THAT(hidden("half-vector", scene), IsEmpty());
}

TEST(Mistakes, CountTheSurfacesThatTheyChange) {
    Scene scene = transformed_scene();
    scene.instances.push_back(scene.instances[0]);
    scene.instances[1].world_from_object = glm::mat4(1.0F);
    const MistakeReach one = reach_of(mistake("normal-matrix"), scene, {});
    EXPECT_EQ(one.draws, 1U);
    EXPECT_EQ(one.total, 2U);

    // Two materials in one mesh, of which one is double-sided.
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].double_sided = true;
    Mesh& mesh = scene.meshes[0].edit();
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.material_ranges = {{0, 1, 0}, {1, count - 1, 1}};
    const MistakeReach half = reach_of(mistake("back-faces"), scene, {});
    EXPECT_EQ(half.draws, 2U);
    EXPECT_EQ(half.total, 4U);
    EXPECT_THAT(half.hidden, IsEmpty());
}

}  // namespace
}  // namespace relief
