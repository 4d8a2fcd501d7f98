// SPDX-License-Identifier: Apache-2.0
// Documents as scenes: transforms, materials, lights, cameras, flattening into one mesh, and
// animation channels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <type_traits>

#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using nlohmann::json;

class GltfViewTest : public testing::Test {
  protected:
    GltfDocument document(const json& root) {
        test::write_gltf_file(folder_ / "a.gltf", root);
        return GltfDocument::read(folder_ / "a.gltf", report_);
    }
    GltfDocument read(const std::filesystem::path& file) {
        return GltfDocument::read(file, report_);
    }

    test::TemporaryDirectory folder_;
    Report report_;
};

TEST_F(GltfViewTest, MaterialsHaveTheirValuesOrGltfsDefaults) {
    const GltfView view = document(json::parse(R"({"asset": {"version": "2.0"},
        "images": [{"uri": "a.png", "name": "A"}, {"uri": "data:image/png;base64,AAAA"}, {"uri": "../b.png"}],
        "samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}],
        "textures": [{"source": 0}, {"source": 1, "sampler": 0},
                     {"extensions": {"EXT_texture_webp": {"source": 1}}}, {}],
        "materials": [{}, {"name": "m",
            "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5,
                "roughnessFactor": 0.25, "baseColorTexture": {"index": 1, "texCoord": 1,
                    "extensions": {"KHR_texture_transform": {"texCoord": 2, "offset": [0.5, 0.25], "rotation": 1.5, "scale": [2, 3]}}},
                "metallicRoughnessTexture": {"index": 2}},
            "normalTexture": {"index": 0, "scale": 0.75}, "occlusionTexture": {"index": 1, "strength": 0.5}, "emissiveTexture": {"index": 3},
            "emissiveFactor": [1, 0.5, 0], "alphaMode": "MASK", "alphaCutoff": 0.25,
            "doubleSided": true, "extensions": {"KHR_materials_unlit": {},
                "KHR_materials_ior": {"ior": 1.25}, "KHR_materials_specular":
                    {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 2], "specularTexture": {"index": 0},
                     "specularColorTexture": {"index": 1}},
                "KHR_materials_clearcoat": {"clearcoatFactor": 0.25, "clearcoatRoughnessFactor": 0.125,
                    "clearcoatTexture": {"index": 1}, "clearcoatRoughnessTexture": {"index": 2},
                    "clearcoatNormalTexture": {"index": 2, "scale": 0.5}},
                "KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3], "sheenRoughnessFactor": 0.5,
                    "sheenColorTexture": {"index": 0}, "sheenRoughnessTexture": {"index": 1}},
                "KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceIor": 1.5,
                    "iridescenceThicknessMinimum": 50, "iridescenceThicknessMaximum": 250,
                    "iridescenceTexture": {"index": 2}, "iridescenceThicknessTexture": {"index": 0}},
                "KHR_materials_transmission": {"transmissionFactor": 0.5, "transmissionTexture": {"index": 1}},
                "KHR_materials_volume": {"thicknessFactor": 3, "attenuationDistance": 2,
                    "attenuationColor": [0.5, 0.25, 1], "thicknessTexture": {"index": 2}},
                "KHR_materials_anisotropy": {"anisotropyStrength": 0.75, "anisotropyRotation": -0.5,
                    "anisotropyTexture": {"index": 0}},
                "KHR_materials_emissive_strength": {"emissiveStrength": 4}}}]})"))
                              .view();
    const GltfMaterial& plain = view.materials[0];
    EXPECT_EQ(plain.metallic_roughness->base_color, glm::vec3(1.0F));
    EXPECT_EQ(plain.opacity, 1.0F);
    EXPECT_EQ(plain.metallic_roughness->metallic, 1.0F);
    EXPECT_EQ(plain.metallic_roughness->roughness, 1.0F);
    EXPECT_EQ(plain.emission, glm::vec3(0.0F));
    EXPECT_EQ(plain.alpha_mode, AlphaMode::opaque);
    EXPECT_FALSE(plain.diffuse_texture || plain.normal_map || plain.double_sided);
    const GltfMaterial& full = view.materials[1];
    const MetallicRoughness& factors = *full.metallic_roughness;
    const MetallicRoughness& defaults = *plain.metallic_roughness;
    EXPECT_EQ(full.name, "m");
    EXPECT_EQ(factors.base_color, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(full.opacity, 0.4F);
    EXPECT_EQ(factors.metallic, 0.5F);
    EXPECT_EQ(factors.roughness, 0.25F);
    EXPECT_EQ(full.emission, glm::vec3(4, 2, 0));
    EXPECT_EQ(defaults.refractive_index, 1.5F);
    EXPECT_EQ(factors.refractive_index, 1.25F);
    EXPECT_EQ(factors.specular, 0.5F);
    EXPECT_EQ(factors.specular_color, glm::vec3(1, 0.5F, 2));
    EXPECT_TRUE(full.more_extensions.empty());
    EXPECT_EQ(factors.specular_texture->image, full.normal_map->texture.image);
    EXPECT_EQ(factors.specular_color_texture->image, full.occlusion_texture->image);
    EXPECT_EQ(factors.clearcoat_texture->image, full.occlusion_texture->image);
    EXPECT_EQ(factors.clearcoat_roughness_texture->image, factors.texture->image);
    EXPECT_EQ(factors.clearcoat_normal_map->texture.image, factors.texture->image);
    EXPECT_EQ(factors.clearcoat_normal_map->scale, 0.5F);
    EXPECT_EQ(factors.sheen_color_texture->image, full.normal_map->texture.image);
    EXPECT_EQ(factors.sheen_roughness_texture->image, full.occlusion_texture->image);
    EXPECT_EQ(factors.anisotropy_texture->image, full.normal_map->texture.image);
    EXPECT_EQ(factors.iridescence_texture->image, factors.texture->image);
    EXPECT_EQ(factors.iridescence_thickness_texture->image, full.normal_map->texture.image);
    EXPECT_FALSE(defaults.specular_texture || defaults.clearcoat_normal_map);
    EXPECT_EQ(defaults.clearcoat, 0.0F);
    EXPECT_EQ(factors.clearcoat, 0.25F);
    EXPECT_EQ(factors.clearcoat_roughness, 0.125F);
    EXPECT_EQ(factors.sheen_color, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(factors.sheen_roughness, 0.5F);
    EXPECT_EQ(factors.transmission, 0.5F);
    EXPECT_EQ(factors.transmission_texture->image, full.occlusion_texture->image);
    EXPECT_EQ(factors.thickness, 3.0F);
    EXPECT_EQ(factors.thickness_texture->image, factors.texture->image);
    EXPECT_EQ(factors.attenuation_distance, 2.0F);
    EXPECT_EQ(factors.attenuation_color, glm::vec3(0.5F, 0.25F, 1));
    EXPECT_EQ(defaults.transmission, 0.0F);
    EXPECT_FALSE(defaults.attenuation_distance);
    EXPECT_EQ(defaults.anisotropy, 0.0F);
    EXPECT_EQ(factors.anisotropy, 0.75F);
    EXPECT_EQ(factors.anisotropy_rotation, -0.5F);
    EXPECT_EQ(defaults.iridescence, 0.0F);
    EXPECT_EQ(factors.iridescence, 0.5F);
    EXPECT_EQ(factors.iridescence_index, 1.5F);
    EXPECT_EQ(factors.iridescence_thickness, 250.0F);
    EXPECT_EQ(factors.iridescence_thickness_minimum, 50.0F);
    EXPECT_EQ(full.normal_map->scale, 0.75F);
    EXPECT_EQ(full.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(full.alpha_cutoff, 0.25F);
    EXPECT_TRUE(full.unlit && full.double_sided);
    const Texture& base = *full.diffuse_texture;
    EXPECT_EQ(base.image, 1U);
    EXPECT_EQ(base.wrap_u, Wrap::clamp);
    EXPECT_EQ(base.wrap_v, Wrap::mirror);
    EXPECT_EQ(base.filter, TextureFilter::nearest);
    EXPECT_EQ(full.texcoords_of(TextureSlot::base_color),
              (GltfTexcoords{2, {{0.5F, 0.25F}, 1.5F, {2.0F, 3.0F}}}));
    EXPECT_EQ(full.texcoords_of(TextureSlot::normal), GltfTexcoords{});
    EXPECT_EQ(full.occlusion_texture->image, 1U);
    EXPECT_EQ(full.occlusion_strength, 0.5F);
    EXPECT_EQ(full.normal_map->texture.wrap_u, Wrap::repeat);
    EXPECT_EQ(factors.texture->image, 1U);
    EXPECT_FALSE(full.emission_texture);
    EXPECT_EQ(std::get<std::filesystem::path>(view.images[0].source), folder_ / "a.png");
    EXPECT_EQ(std::get<std::vector<std::byte>>(view.images[1].source).size(), 3U);
    // The file is outside the folder and is not opened, so the image is empty.
    EXPECT_TRUE(std::get<std::vector<std::byte>>(view.images[2].source).empty());
    EXPECT_EQ(view.images[0].fault, "");
    EXPECT_EQ(view.images[1].fault, "");
    EXPECT_EQ(view.images[2].fault,
              "images[2].uri '../b.png' leads out of the document's folder, so it is not read");
}

TEST_F(GltfViewTest, EveryFactorOfTheTableIsReadFromItsPath) {
    json material = json::object();
    float next = 0.0F;
    for_each_field<MetallicRoughness>(
        [&]<typename Value>(const SceneField<MetallicRoughness, Value>& field) {
            if (*field.gltf == '\0') return;
            json& value = material[json::json_pointer(std::string("/") + field.gltf)];
            value = next += 0.03125F;
            if constexpr (std::is_same_v<Value, glm::vec3>) value = {next, next, next};
            if (std::string(field.gltf).ends_with("baseColorFactor")) value.push_back(1.0F);
        });
    const GltfMaterial read =
        document({{"asset", {{"version", "2.0"}}}, {"materials", {material}}}).view().materials[0];
    next = 0.0F;
    for_each_field<MetallicRoughness>([&](const auto& field) {
        if (*field.gltf == '\0') return;
        next += 0.03125F;
        const auto& value = (*read.metallic_roughness).*field.member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (requires { value == Value(next); }) {
            EXPECT_EQ(value, Value(next)) << field.name;
        } else {
            ADD_FAILURE() << field.name << " is not a factor";
        }
    });
    EXPECT_TRUE(read.more_extensions.empty());
}

TEST_F(GltfViewTest, EveryTextureOfTheTableIsReadFromItsPath) {
    json root = {{"asset", {{"version", "2.0"}}}, {"materials", {json::object()}}};
    for (const TextureSlotInfo& slot : texture_slots) {
        const std::size_t number = root["textures"].size();
        root["images"].push_back({{"uri", std::string(slot.sampler) + ".png"}});
        root["textures"].push_back({{"source", number}});
        if (*slot.gltf == '\0') continue;
        root["materials"][0][json::json_pointer(std::string("/") + slot.gltf)] = {
            {"index", number}, {"texCoord", number}};
    }
    GltfMaterial read = document(root).view().materials[0];
    for (std::size_t i = 0; i < texture_slot_count; ++i) {
        const TextureSlotInfo& slot = texture_slots[i];
        const Texture* const texture = find_texture(read, slot.slot);
        ASSERT_EQ(texture != nullptr, *slot.gltf != '\0') << slot.name;
        if (texture == nullptr) continue;
        EXPECT_EQ(texture->image, i) << slot.name;
        EXPECT_EQ(read.texcoords_of(slot.slot).set, static_cast<int>(i)) << slot.name;
    }
}

TEST(MaterialTextures, AreFoundSetAndRemovedBySlot) {
    Material material;
    for (const bool has_model : {false, true}) {
        if (has_model) material.metallic_roughness.emplace();
        for (const TextureSlotInfo& slot : texture_slots) {
            EXPECT_EQ(find_texture(material, slot.slot), nullptr) << slot.name;
            if (slot.slot == TextureSlot::cones) {
                set_texture(material, slot.slot, {7});
                EXPECT_EQ(find_texture(material, slot.slot), nullptr) << "without a height map";
                material.height_map.emplace();
            }
            set_texture(material, slot.slot, {7});
            const bool can_have_it = has_model || !is_of_metallic_roughness(slot);
            ASSERT_EQ(find_texture(material, slot.slot) != nullptr, can_have_it) << slot.name;
            if (can_have_it) {
                EXPECT_EQ(find_texture(material, slot.slot)->image, 7U) << slot.name;
            }
            remove_texture(material, slot.slot);
            EXPECT_EQ(find_texture(material, slot.slot), nullptr) << slot.name;
            material.height_map.reset();
        }
    }
}

TEST(MaterialTextures, KeepTheOtherFieldsOfTheirMap) {
    Material material;
    material.normal_map = NormalMap{.texture = {1}, .scale = 0.5F, .green = Green::down};
    set_texture(material, TextureSlot::normal, {2});
    EXPECT_EQ(material.normal_map->texture.image, 2U);
    EXPECT_EQ(material.normal_map->scale, 0.5F);
    EXPECT_EQ(material.normal_map->green, Green::down);
}

TEST_F(GltfViewTest, TextureTransformsScaleThenTurnThenShift) {
    const GltfTextureTransform transform{{0.5F, 0.25F}, 1.5707963F, {2.0F, 3.0F}};
    const glm::vec2 at = transformed(transform, {0.25F, 0.5F});
    // (0.5, 1.5), rotated by 90 degrees: counter-clockwise with v down, so to (1.5, -0.5).
    EXPECT_NEAR(at.x, 2.0F, 1e-6F);
    EXPECT_NEAR(at.y, -0.25F, 1e-6F);
}

TEST_F(GltfViewTest, TextureTransformsTurnTangentsAsTheyTurnTheImage) {
    const auto framed = [](Mesh mesh) {
        Report report;
        mesh.tangents.clear();
        return with_frames(std::move(mesh), {.tangents = TangentMethod::mikktspace}, report).mesh;
    };
    const std::vector<std::pair<Mesh, GltfTextureTransform>> cases = {
        // An undistorted image allows any rotation; otherwise, only scales and mirrors.
        {make_quad(2), {{0.5F, 0.25F}, 0.7F, {2.0F, 2.0F}}},
        {make_quad(2), {{0.0F, 0.0F}, -2.0F, {-3.0F, 3.0F}}},
        {make_quad(2), {{0.0F, 0.0F}, 1.5707963F, {0.5F, -0.5F}}},
        {make_torus(0.4F, 24, 12), {{0.0F, 0.0F}, 0.0F, {-1.0F, 4.0F}}},
        {make_torus(0.4F, 24, 12), {{0.0F, 0.0F}, 3.1415927F, {2.0F, 3.0F}}}};
    for (const auto& [shape, transform] : cases) {
        const Mesh before = framed(shape);
        Mesh after = before;
        for (glm::vec2& texcoord : after.texcoords)
            texcoord = transformed(transform, texcoord);
        after = framed(after);
        ASSERT_EQ(after.tangents.size(), before.tangents.size());
        for (std::size_t v = 0; v < before.tangents.size(); ++v) {
            const glm::vec4 turned = transformed(transform, before.tangents[v], before.normals[v]);
            EXPECT_LT(test::degrees_between(glm::vec3(turned), glm::vec3(after.tangents[v])), 1e-3);
            EXPECT_EQ(turned.w, after.tangents[v].w);
        }
    }
    const glm::vec4 tangent(1, 0, 0, -1);
    EXPECT_EQ(transformed({{0, 0}, 1.0F, {0.0F, 1.0F}}, tangent, {0, 0, 1}), tangent)
        << "a line of the image";
}

TEST_F(GltfViewTest, LightsAndCamerasHaveTheTransformOfTheirNodes) {
    const GltfView view = document(json::parse(R"({"asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "color": [1, 0.5, 0], "intensity": 20, "range": 9,
             "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}},
            {"type": "directional"}, {"type": "point"}]}},
        "cameras": [{"type": "perspective", "name": "c", "perspective": {"yfov": 0.7, "znear": 0.01}},
                    {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 2, "znear": 0, "zfar": 3}}],
        "scenes": [{"nodes": []}, {"nodes": [0, 4]}], "scene": 1,
        "nodes": [{"children": [1, 2, 3], "translation": [1, 2, 3]},
            {"name": "lamp", "rotation": [0, 0.70710678, 0, 0.70710678], "scale": [2, 2, 2],
             "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"extensions": {"KHR_lights_punctual": {"light": 1}}, "camera": 0},
            {"extensions": {"KHR_lights_punctual": {"light": 2}}, "camera": 1},
            {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 7,8,9,1], "camera": 0, "name": "last"}]})"))
                              .view();
    ASSERT_EQ(view.lights.size(), 3U);
    const GltfLight& spot = view.lights[0].what;
    EXPECT_EQ(view.lights[0].name, "lamp");
    EXPECT_EQ(spot.type, LightType::spot);
    EXPECT_EQ(spot.color, glm::vec3(1, 0.5F, 0));
    EXPECT_EQ(spot.intensity, 20.0F);
    EXPECT_EQ(spot.range, 9.0F);
    EXPECT_EQ(spot.inner_cone, 0.1F);
    EXPECT_EQ(spot.outer_cone, 0.2F);
    // A quarter turn about y maps -z to -x.
    const glm::vec3 looks(view.lights[0].world_from_object * glm::vec4(0, 0, -1, 0));
    EXPECT_LT(test::degrees_between(looks, {-1, 0, 0}), 1e-5);
    EXPECT_NEAR(glm::length(looks), 2.0F, 1e-6F);
    EXPECT_EQ(glm::vec3(view.lights[0].world_from_object[3]), glm::vec3(1, 2, 3));
    EXPECT_EQ(view.lights[1].what.type, LightType::directional);
    EXPECT_EQ(view.lights[2].what.type, LightType::point);
    EXPECT_FALSE(view.lights[2].what.range);
    ASSERT_EQ(view.cameras.size(), 3U);
    EXPECT_EQ(view.cameras[0].what.vertical_fov, 0.7F);
    EXPECT_EQ(view.cameras[0].what.near, 0.01F);
    EXPECT_FALSE(view.cameras[0].what.far);
    EXPECT_FALSE(view.cameras[0].what.orthographic_height);
    EXPECT_EQ(view.cameras[1].what.orthographic_height, 4.0F) << "twice ymag";
    EXPECT_EQ(view.cameras[1].what.near, 0.0F);
    EXPECT_EQ(view.cameras[1].what.far, 3.0F);
    EXPECT_EQ(glm::vec3(view.cameras[2].world_from_object[3]), glm::vec3(7, 8, 9));
    EXPECT_EQ(view.cameras[2].name, "last");
}

TEST_F(GltfViewTest, InstancesAreRepeated) {
    RELIEF_NEEDS_SHARED(file, "data/models/gltf/SimpleInstancing/glTF-Binary/SimpleInstancing.glb");
    const GltfView view = read(file).view();
    EXPECT_EQ(view.primitives.size(), 125U);  // Five to the power of three cubes.
    EXPECT_NE(view.primitives[0].world_from_object, view.primitives[124].world_from_object);
}

TEST_F(GltfViewTest, TheDefaultSceneOrTheFirstIsShown) {
    RELIEF_NEEDS_SHARED(file, "data/models/gltf/MultipleScenes/glTF-Embedded/MultipleScenes.gltf");
    EXPECT_EQ(read(file).view().primitives.size(), 1U);
}

TEST_F(GltfViewTest, MirroringNodesTurnTriangles) {
    RELIEF_NEEDS_SHARED(folder, "data/models/gltf-ext/misc");
    const auto facing = [&](const char* name) {
        const Mesh mesh = flattened(read(folder / name)).mesh;
        const glm::uvec3 t = mesh.triangles.at(0);
        return glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                          mesh.positions[t.z] - mesh.positions[t.x]);
    };
    const glm::vec3 plain = facing("one_face_123.gltf");
    const glm::vec3 moved = facing("one_face_123_translated.gltf");
    EXPECT_LT(test::degrees_between(plain, moved), 1e-4);
    const GltfView view = read(folder / "one_face_123_mirror.gltf").view();
    const glm::mat3 mirror(view.primitives[0].world_from_object);
    ASSERT_LT(glm::determinant(mirror), 0.0F);
    // A mirrored surface shows its mirrored front.
    EXPECT_LT(test::degrees_between(mirror * plain, facing("one_face_123_mirror.gltf")), 1e-4);
}

TEST_F(GltfViewTest, FlattenedNormalsStayPerpendicularUnderUnevenScale) {
    json root;
    {
        GltfDocument::from_mesh({test::sphere(32, 16), {}}).write(folder_ / "s.gltf");
        root = json::parse(std::ifstream(folder_ / "s.gltf"));
    }
    for (const float x : {3.0F, -3.0F, 3e-15F}) {
        root["nodes"][0]["scale"] = {x, x / 3, x / 6};
        root["nodes"][0]["rotation"] = {0.5, 0.5, 0.5, 0.5};
        test::write_gltf_file(folder_ / "t.gltf", root);
        const MeshFile flat = flattened(read(folder_ / "t.gltf"));
        // The exact normal of the ellipsoid is the gradient of its equation.
        const glm::dmat3 rotation(0, 1, 0, 0, 0, 1, 1, 0, 0);  // The rotation of the quaternion: x
                                                               // to y to z.
        const glm::dvec3 scale(x, x / 3, x / 6);
        for (std::size_t i = 0; i < flat.mesh.positions.size(); ++i) {
            const glm::dvec3 local =
                glm::transpose(rotation) * glm::dvec3(flat.mesh.positions[i]) / scale;
            const glm::dvec3 reference = rotation * (local / scale);
            // The rounding of float positions and normals, stretched by the ratio of the scales.
            ASSERT_LT(test::degrees_between(flat.mesh.normals[i], reference), 1e-4)
                << x << " " << i;
        }
        // Front faces are outside, mirrored or not.
        const glm::uvec3 t = flat.mesh.triangles[100];
        const glm::dvec3 a(flat.mesh.positions[t.x]), b(flat.mesh.positions[t.y]),
            c(flat.mesh.positions[t.z]);
        EXPECT_GT(glm::dot(glm::normalize(glm::cross((b - a) / double(x), (c - a) / double(x))),
                           glm::normalize(a + b + c)),
                  0.0);
    }
}

TEST_F(GltfViewTest, FlatteningFillsMissingAttributes) {
    MeshFile plain{test::cube(), {}};
    plain.mesh.texcoords.clear();
    plain.mesh.normals.clear();
    GltfDocument::from_mesh(plain).write(folder_ / "p.gltf");
    GltfDocument::from_mesh({test::cube(), {}}).write(folder_ / "q.gltf");
    const Mesh alone = flattened(read(folder_ / "p.gltf")).mesh;
    EXPECT_TRUE(alone.normals.empty() && alone.texcoords.empty() && alone.colors.empty());
    RELIEF_NEEDS_SHARED(file,
                        "data/models/gltf/PrimitiveModeNormalsTest/PrimitiveModeNormalsTest.glb");
    const Mesh mixed = flattened(read(file)).mesh;
    EXPECT_NO_THROW(validate(mixed));
    EXPECT_EQ(mixed.normals.size(), mixed.positions.size());
    for (const glm::vec3& normal : mixed.normals)
        ASSERT_NEAR(glm::length(normal), 1.0F, 1e-3F);
}

TEST_F(GltfViewTest, AllRealModelsFlattenIntoValidMeshes) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    for (const auto& file : test::gltf_files_below(models)) {
        if (file.parent_path().filename() == "glTF-Draco") continue;
        const MeshFile flat = flattened(read(file));
        EXPECT_NO_THROW(validate(flat.mesh)) << file;
    }
    const MeshFile spheres = flattened(read(models / "MetalRoughSpheresNoTextures/glTF-Binary/"
                                                     "MetalRoughSpheresNoTextures.glb"));
    EXPECT_GT(spheres.mesh.triangles.size(), 1'000'000U);
}

/// Arrays of floats in one buffer, each an accessor.
class Animated : public testing::Test {
  protected:
    std::size_t add(const std::vector<float>& values, const char* type, std::size_t components) {
        root_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", values.size() * 4}});
        root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                      {"componentType", 5126},
                                      {"count", values.size() / components},
                                      {"type", type}});
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * 4);
        return root_["accessors"].size() - 1;
    }
    std::size_t times(const std::vector<float>& values) { return add(values, "SCALAR", 1); }

    /// Adds a channel with its own sampler.
    void channel(const json& target, std::size_t input, std::size_t output,
                 const char* interpolation = "LINEAR") {
        json& animation = root_["animations"][0];
        animation["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", interpolation}});
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size() - 1}, {"target", target}});
    }

    std::vector<KeyAnimation> read() {
        root_["buffers"] = {{{"byteLength", bytes_.size()}}};
        test::write_gltf_file(folder_ / "a.glb", root_, bytes_);
        return GltfDocument::read(folder_ / "a.glb", report_).animations(report_);
    }

    test::TemporaryDirectory folder_;
    Report report_;
    json root_ = {{"asset", {{"version", "2.0"}}},
                  {"nodes", {{{"name", "a"}}, {{"matrix", std::vector<float>(16, 1.0F)}}}},
                  {"animations",
                   {{{"name", "move"}, {"samplers", json::array()}, {"channels", json::array()}}}}};
    std::string bytes_;
};

TEST_F(Animated, ChannelsAreKeysOfNodes) {
    const std::size_t two = times({0.5F, 2.0F});
    channel({{"node", 0}, {"path", "translation"}}, two, add({1, 2, 3, 4, 5, 6}, "VEC3", 3));
    channel({{"node", 0}, {"path", "rotation"}}, two, add({0, 0, 0, 1, 1, 0, 0, 0}, "VEC4", 4),
            "STEP");
    channel({{"node", 0}, {"path", "scale"}}, two,
            add({0, 0, 0, 1, 1, 1, 0, 0, 0, 9, 9, 9, 2, 2, 2, 9, 9, 9}, "VEC3", 3), "CUBICSPLINE");
    channel({{"node", 1}, {"path", "weights"}}, two, add({1, 2, 3, 4}, "SCALAR", 1));
    const std::vector<KeyAnimation> animations = read();
    ASSERT_EQ(animations.size(), 1U);
    EXPECT_EQ(animations[0].name, "move");
    ASSERT_EQ(animations[0].channels.size(), 4U);
    EXPECT_EQ(animations[0].channels[3].weights, (std::vector<float>{1, 2, 3, 4}))
        << "of two morph targets; the node may have a matrix";
    const KeyChannel& translation = animations[0].channels[0];
    EXPECT_EQ(translation.times, (std::vector<float>{0.5F, 2.0F}));
    EXPECT_EQ(translation.values, (std::vector<glm::vec4>{{1, 2, 3, 0}, {4, 5, 6, 0}}));
    EXPECT_EQ(translation.interpolation, KeyInterpolation::linear);
    const KeyChannel& rotation = animations[0].channels[1];
    EXPECT_EQ(rotation.values[1], glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(rotation.interpolation, KeyInterpolation::step);
    EXPECT_EQ(animations[0].channels[2].values.size(), 6U);
    EXPECT_TRUE(report_.empty());
}

TEST_F(Animated, PointersAddressNodesAndProperties) {
    const std::size_t two = times({0, 2});
    const auto point_at = [](const char* pointer) {
        return json{{"path", "pointer"},
                    {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
    };
    channel(point_at("/nodes/0/scale"), two, add({1, 2, 3, 4, 5, 6}, "VEC3", 3));
    channel(point_at("/materials/7/alphaCutoff"), two, add({0.25F, 0.5F}, "SCALAR", 1), "STEP");
    channel(point_at("/materials/0/pbrMetallicRoughness/baseColorFactor"), two,
            add({1, 2, 3, 4, 5, 6, 7, 8}, "VEC4", 4));
    channel(point_at("/nodes/0/color"), two, add({1, 2, 3, 4}, "VEC2", 2));
    channel(point_at("/nodes/9/scale"), two, add({1, 2, 3, 4, 5, 6}, "VEC3", 3));
    channel(point_at("/nodes/1/translation"), two, add({1, 2, 3, 4, 5, 6}, "VEC3", 3));
    const std::vector<KeyChannel> channels = read()[0].channels;
    ASSERT_EQ(channels.size(), 5U);
    EXPECT_EQ(channels[0].property, KeyChannel::Property::scale);
    EXPECT_TRUE(channels[0].pointer.empty());
    EXPECT_EQ(channels[1].property, KeyChannel::Property::pointer);
    EXPECT_EQ(channels[1].pointer, "/materials/7/alphaCutoff");
    EXPECT_EQ(channels[1].interpolation, KeyInterpolation::step);
    EXPECT_EQ(channels[1].values[1], glm::vec4(0.5F, 0, 0, 0));
    EXPECT_EQ(channels[2].values[1], glm::vec4(5, 6, 7, 8));
    EXPECT_EQ(channels[3].pointer, "/nodes/0/color");
    EXPECT_EQ(channels[3].values[0], glm::vec4(1, 2, 0, 0));
    EXPECT_EQ(channels[4].pointer, "/nodes/9/scale");
    EXPECT_EQ(report_.count("animated node with a matrix"), 1U);
}

TEST_F(Animated, UnusableChannelsAreOmittedAndCounted) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::size_t two = times({0, 1});
    const std::size_t good = add({1, 2, 3, 4, 5, 6}, "VEC3", 3);
    const json place = {{"node", 0}, {"path", "translation"}};
    channel({{"node", 0}, {"path", "weights"}}, two, good);      // 0: vectors
    channel({{"path", "pointer"}}, two, good);                   // 1: to nothing
    channel({{"path", "translation"}}, two, good);               // 2: without node
    channel({{"node", 1}, {"path", "translation"}}, two, good);  // 3: the node has a matrix
    channel(place, times({1, 1}), good);                         // 4: not ascending
    channel(place, times({1, nan}), good);                       // 5
    channel(place, times({-1, 1}), good);                        // 6: before all time
    channel(place, times({0, 1, 2}), good);                      // 7: too few values
    channel(place, two, good, "CUBICSPLINE");                    // 8: likewise
    channel(place, two, add({1, 2, 3, 4, nan, 6}, "VEC3", 3));   // 9
    channel(place, two, two);                                    // 10: scalars
    channel({{"node", 0}, {"path", "rotation"}}, two,
            add({0, 0, 0, 1, 0, 0, 0, 0}, "VEC4", 4));  // 11: no rotation
    channel(place, two, good);
    const std::vector<KeyAnimation> animations = read();
    EXPECT_EQ(animations[0].channels.size(), 1U);
    EXPECT_EQ(report_.count("animation of an extension"), 1U);
    EXPECT_EQ(report_.count("animated node with a matrix"), 1U);
    EXPECT_EQ(report_.count("animation channel with unusable keys"), 9U);
    EXPECT_EQ(report_.findings()[0].first, (std::vector<std::size_t>{0, 4, 5, 6, 7, 8, 9, 10}));
}

TEST_F(Animated, NodesHaveParentsAndTransforms) {
    root_["nodes"] = json::parse(R"([{"name": "root", "children": [2], "scale": [2, 2, 2]},
        {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 4,5,6,1]}, {"rotation": [0, 1, 0, 0], "skin": 0}])");
    root_["skins"] = json::parse(R"([{"joints": [0]}])");
    root_.erase("animations");
    test::write_gltf_file(folder_ / "a.glb", root_, bytes_);
    const GltfView view = GltfDocument::read(folder_ / "a.glb", report_).view();
    ASSERT_EQ(view.nodes.size(), 3U);
    EXPECT_EQ(view.nodes[0].scale, glm::vec3(2.0F));
    EXPECT_FALSE(view.nodes[0].parent || view.nodes[0].matrix || view.nodes[0].has_skin);
    EXPECT_EQ(view.nodes[1].matrix.value()[3], glm::vec4(4, 5, 6, 1));
    EXPECT_EQ(view.nodes[2].parent, 0U);
    EXPECT_EQ(view.nodes[2].rotation, glm::vec4(0, 1, 0, 0));
    EXPECT_TRUE(view.nodes[2].has_skin);
}

TEST(GltfAnimations, RealModelsAreReadCompletely) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    Report report;
    const auto channels = [&](const char* file) {
        std::size_t count = 0;
        for (const auto& animation : GltfDocument::read(models / file, report).animations(report))
            count += animation.channels.size();
        return count;
    };
    EXPECT_EQ(channels("InterpolationTest/glTF-Binary/InterpolationTest.glb"), 9U);
    EXPECT_EQ(channels("BoxAnimated/glTF-Binary/BoxAnimated.glb"), 2U);
    EXPECT_TRUE(report.empty());
}

}  // namespace

}  // namespace relief
