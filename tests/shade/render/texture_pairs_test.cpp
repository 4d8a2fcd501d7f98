// SPDX-License-Identifier: Apache-2.0
// Pairs of a texture and another effect against the CPU reference, on every backend. A texture
// makes values differ between neighboring pixels that an effect may take as equal.
#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <string>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/reference.h"
#include "relief/shade/scene_fields.h"
#include "shade/effects/feature_sets.h"
#include "shade/render/draw_support.h"
#include "shade/render/random_scene.h"
#include "shade/render/reference_agreement.h"
#include "support/gl_environment.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr int picture_size = 16;
#else
constexpr int picture_size = 24;
#endif

/// In codes. Lookups of OpenGL differ from the reference in the last digits, and so do the effects.
constexpr double pair_tolerance = 2.0;

/// A part of a scene: a texture or another effect of the first material.
struct ScenePart {
    const char* name;
    std::function<void(Scene& scene, test::Dice& dice)> add;
};

Material& material_of(Scene& scene) {
    return scene.materials[0];
}

/// Returns glTF's model of the material, which becomes one of that model.
MetallicRoughness& model_of(Scene& scene) {
    auto& model = material_of(scene).metallic_roughness;
    // These belong to Phong's model.
    material_of(scene).transmission = 0.0F;
    if (material_of(scene).interpolation == Interpolation::gouraud)
        material_of(scene).interpolation = Interpolation::per_pixel;
    if (!model) model = MetallicRoughness{{0.8F, 0.5F, 0.3F}, 0.3F, 0.6F, std::nullopt};
    return *model;
}

Texture texture_of(Scene& scene, test::Dice& dice, int channels, ColorSpace space) {
    scene.images.push_back({"image", test::random_image(dice, channels, space)});
    return Texture{scene.images.size() - 1};
}

NormalMap normal_map_of(Scene& scene, test::Dice& dice) {
    scene.images.push_back({"normals", test::random_normals(dice)});
    return NormalMap{Texture{scene.images.size() - 1}, 1.0F, Green::up, FlatCode::middle};
}

/// Makes the first surface let through what is behind it: a glowing cube.
MetallicRoughness& clear_model_of(Scene& scene) {
    MetallicRoughness& model = model_of(scene);
    model.metallic = 0.1F;
    if (model.transmission > 0.0F) return model;
    model.transmission = 0.9F;
    Mesh cube = test::cube();
    cube.material_ranges = {{0, 12, 1}};
    scene.meshes.emplace_back(cube);
    scene.materials.resize(2);
    scene.materials[1].emission = {0.8F, 0.4F, 0.1F};
    glm::mat4 place(0.5F);
    place[3] = {0.3F, 0.2F, -1.0F, 1.0F};
    scene.instances.push_back({scene.meshes.size() - 1, place, "behind"});
    scene.background = {0.2F, 0.4F, 0.6F, 0.8F};
    return scene.materials[0].metallic_roughness.value();
}

/// Returns a texture of glTF's model; `prepare` adds what it changes.
template <auto Member>
ScenePart model_slot(const char* name, int channels, ColorSpace space,
                     std::function<void(Scene& scene)> prepare) {
    return {name, [=](Scene& scene, test::Dice& dice) {
                prepare(scene);
                model_of(scene).*Member = texture_of(scene, dice, channels, space);
            }};
}

void add_coat(Scene& scene) {
    model_of(scene).clearcoat = 0.8F;
    model_of(scene).clearcoat_roughness = 0.6F;
}

void add_sheen(Scene& scene) {
    model_of(scene).sheen_color = {0.3F, 0.6F, 0.1F};
    model_of(scene).sheen_roughness = 0.6F;
}

void add_film(Scene& scene) {
    model_of(scene).iridescence = 0.9F;
    model_of(scene).iridescence_index = 1.4F;
    model_of(scene).iridescence_thickness = 480.0F;
}

void add_anisotropy(Scene& scene) {
    model_of(scene).anisotropy = 0.7F;
    model_of(scene).anisotropy_rotation = 0.6F;
}

/// The texture slots of glTF's model.
std::vector<ScenePart> model_slots() {
    using M = MetallicRoughness;
    const auto nothing = [](Scene&) {};
    return {
        {"metallic-roughness texture",
         [](Scene& scene, test::Dice& dice) {
             model_of(scene).texture = texture_of(scene, dice, 3, ColorSpace::data);
             model_of(scene).roughness = 1.0F;
         }},
        model_slot<&M::specular_texture>("specular weight texture", 4, ColorSpace::data, nothing),
        model_slot<&M::specular_color_texture>("specular color texture", 3, ColorSpace::linear,
                                               nothing),
        model_slot<&M::sheen_color_texture>("sheen color texture", 3, ColorSpace::linear,
                                            add_sheen),
        model_slot<&M::sheen_roughness_texture>("sheen roughness texture", 4, ColorSpace::data,
                                                add_sheen),
        model_slot<&M::clearcoat_texture>("clearcoat texture", 3, ColorSpace::data, add_coat),
        model_slot<&M::clearcoat_roughness_texture>("clearcoat roughness texture", 3,
                                                    ColorSpace::data, add_coat),
        {"clearcoat normal map",
         [](Scene& scene, test::Dice& dice) {
             add_coat(scene);
             model_of(scene).clearcoat_normal_map = normal_map_of(scene, dice);
         }},
        {"anisotropy texture",
         [](Scene& scene, test::Dice& dice) {
             add_anisotropy(scene);
             model_of(scene).anisotropy_texture = normal_map_of(scene, dice).texture;
         }},
        model_slot<&M::iridescence_texture>("iridescence texture", 3, ColorSpace::data, add_film),
        model_slot<&M::iridescence_thickness_texture>("film thickness texture", 3, ColorSpace::data,
                                                      add_film),
        model_slot<&M::transmission_texture>("transmission texture", 3, ColorSpace::data,
                                             [](Scene& scene) { clear_model_of(scene); }),
        model_slot<&M::thickness_texture>(
            "thickness texture", 3, ColorSpace::data,
            [](Scene& scene) { clear_model_of(scene).thickness = 0.5F; }),
    };
}

/// The texture slots of both models.
std::vector<ScenePart> common_slots() {
    return {
        {"diffuse texture",
         [](Scene& scene, test::Dice& dice) {
             material_of(scene).diffuse_texture = texture_of(scene, dice, 4, ColorSpace::linear);
         }},
        {"specular texture",
         [](Scene& scene, test::Dice& dice) {
             material_of(scene).specular = glm::vec3(0.6F);
             material_of(scene).specular_texture = texture_of(scene, dice, 3, ColorSpace::linear);
         }},
        {"emission texture",
         [](Scene& scene, test::Dice& dice) {
             material_of(scene).emission = glm::vec3(0.4F);
             material_of(scene).emission_texture = texture_of(scene, dice, 3, ColorSpace::linear);
         }},
        {"occlusion texture",
         [](Scene& scene, test::Dice& dice) {
             material_of(scene).occlusion_texture = texture_of(scene, dice, 1, ColorSpace::data);
         }},
        {"opacity texture",
         [](Scene& scene, test::Dice& dice) {
             if (material_of(scene).alpha_mode == AlphaMode::opaque)
                 material_of(scene).alpha_mode = AlphaMode::blend;
             material_of(scene).opacity_texture = texture_of(scene, dice, 1, ColorSpace::data);
         }},
        {"normal map",
         [](Scene& scene, test::Dice& dice) {
             material_of(scene).bump_map.reset();
             material_of(scene).normal_map = normal_map_of(scene, dice);
         }},
        {"object-space normal map",
         [](Scene& scene, test::Dice& dice) {
             material_of(scene).bump_map.reset();
             material_of(scene).normal_map = normal_map_of(scene, dice);
             material_of(scene).normal_map->space = NormalSpace::object;
         }},
        {"bump map",
         [](Scene& scene, test::Dice& dice) {
             material_of(scene).normal_map.reset();
             scene.images.push_back({"heights", test::random_heights(dice)});
             material_of(scene).bump_map = BumpMap{Texture{scene.images.size() - 1}, 1.5F};
         }},
    };
}

/// Returns an effect that takes no random numbers.
ScenePart plain_part(const char* name, void (*add)(Scene& scene)) {
    return {name, [=](Scene& scene, test::Dice&) { add(scene); }};
}

std::vector<ScenePart> model_parts() {
    return {
        plain_part("metallic-roughness", [](Scene& s) { model_of(s).roughness = 0.35F; }),
        plain_part("metal of roughness 1",
                   [](Scene& s) { model_of(s).metallic = model_of(s).roughness = 1.0F; }),
        plain_part("smooth dielectric",
                   [](Scene& s) { model_of(s).metallic = model_of(s).roughness = 0.0F; }),
        plain_part("dielectric reflectance",
                   [](Scene& s) {
                       model_of(s).refractive_index = 2.2F;
                       model_of(s).specular = 0.7F;
                       model_of(s).specular_color = {0.2F, 0.5F, 1.5F};
                   }),
        plain_part("sheen", add_sheen),
        plain_part("clearcoat", add_coat),
        plain_part("anisotropy", add_anisotropy),
        plain_part("iridescence", add_film),
        plain_part("transmission", [](Scene& s) { clear_model_of(s).roughness = 0.4F; }),
        plain_part("transmission of a rough surface",
                   [](Scene& s) { clear_model_of(s).roughness = 1.0F; }),
        plain_part("volume",
                   [](Scene& s) {
                       MetallicRoughness& model = clear_model_of(s);
                       model.roughness = 0.4F;
                       model.thickness = 0.5F;
                       model.attenuation_distance = 0.7F;
                       model.attenuation_color = {0.9F, 0.3F, 0.0F};
                   }),
    };
}

std::vector<ScenePart> surface_parts() {
    return {
        plain_part("flat", [](Scene& s) { material_of(s).interpolation = Interpolation::flat; }),
        plain_part("Gouraud",
                   [](Scene& s) { material_of(s).interpolation = Interpolation::gouraud; }),
        plain_part("unlit", [](Scene& s) { material_of(s).unlit = true; }),
        plain_part("emission",
                   [](Scene& s) {
                       material_of(s).emission = {0.2F, 0.1F, 0.0F};
                   }),
        plain_part("Phong highlights",
                   [](Scene& s) {
                       material_of(s).specular = {0.5F, 0.4F, 0.3F};
                       material_of(s).specular_model = SpecularModel::phong;
                   }),
        plain_part("Fresnel on highlights",
                   [](Scene& s) {
                       material_of(s).specular = {0.3F, 0.1F, 0.2F};
                       material_of(s).highlight_fresnel = true;
                   }),
        plain_part("derivative frames",
                   [](Scene& s) { material_of(s).tangent_frame = TangentFrame::derivatives; }),
        plain_part("back faces",
                   [](Scene& s) {
                       material_of(s).double_sided = true;
                       for (glm::uvec3& triangle : s.meshes[0].edit().triangles)
                           std::swap(triangle.y, triangle.z);
                   }),
        plain_part("alpha mask",
                   [](Scene& s) {
                       material_of(s).alpha_mode = AlphaMode::mask;
                       material_of(s).alpha_cutoff = 0.4F;
                   }),
        plain_part("blending",
                   [](Scene& s) {
                       material_of(s).alpha_mode = AlphaMode::blend;
                       material_of(s).opacity = 0.6F;
                   }),
        plain_part("vertex colors",
                   [](Scene& s) {
                       Mesh& mesh = s.meshes[0].edit();
                       for (const glm::vec3& position : mesh.positions)
                           mesh.colors.emplace_back(position * 0.5F + 0.5F, 1.0F);
                   }),
        plain_part("second texture coordinates",
                   [](Scene& s) {
                       Mesh& mesh = s.meshes[0].edit();
                       for (const glm::vec2& texcoord : mesh.texcoords)
                           mesh.texcoords_2.emplace_back(0.7F * texcoord.y,
                                                         0.3F + 0.6F * texcoord.x);
                   }),
        plain_part("morphing and skinning",
                   [](Scene& s) {
                       Features f;
                       f.morphing = f.skinning = true;
                       s.instances[0].pose = test::pose_calling_for(s.meshes[0], f);
                   }),
        plain_part("vertex occlusion",
                   [](Scene& s) { s.instances[0].open_shares = test::shares_of(s.meshes[0]); }),
    };
}

std::vector<ScenePart> lighting_parts() {
    return {
        plain_part("nothing else", [](Scene&) {}),
        plain_part("no lights",
                   [](Scene& s) {
                       s.directional_lights.clear();
                       s.point_lights.clear();
                   }),
        plain_part("spot light",
                   [](Scene& s) {
                       s.spot_lights = {{{{0, 1, 3}, {4, 3, 2}}, {0, -1, -3}, 0.1F, 0.35F}};
                   }),
        plain_part("mixed falloff",
                   [](Scene& s) {
                       s.point_lights[0].range = 4.0F;
                       s.point_lights.push_back({{2, 2, 2}, glm::vec3(0.2F), 4.0F, Falloff::none});
                   }),
        plain_part("highlight colors",
                   [](Scene& s) {
                       material_of(s).specular = glm::vec3(0.5F);
                       s.point_lights[0].highlight_intensity = glm::vec3(2, 0, 1);
                   }),
        plain_part("Khronos PBR Neutral",
                   [](Scene& s) {
                       s.exposure = 1.7F;
                       s.tone_mapping = ToneMapping::khronos_neutral;
                   }),
    };
}

std::vector<ScenePart> environment_parts() {
    std::vector<ScenePart> effects;
    for (const FresnelModel fresnel :
         {FresnelModel::schlick, FresnelModel::dielectric, FresnelModel::conductor}) {
        effects.push_back({enum_name(fresnel), [=](Scene& scene, test::Dice& dice) {
                               scene.environment = test::random_environment(dice);
                               scene.environment->lights = true;
                               material_of(scene).reflectivity = {0.9F, 0.5F, 0.2F};
                               material_of(scene).fresnel = fresnel;
                               material_of(scene).transmission = 0.5F;
                           }});
    }
    return effects;
}

std::vector<ScenePart> joined(std::initializer_list<std::vector<ScenePart>> lists) {
    std::vector<ScenePart> all;
    for (const std::vector<ScenePart>& list : lists)
        all.insert(all.end(), list.begin(), list.end());
    return all;
}

std::vector<ScenePart> all_slots() {
    return joined({model_slots(), common_slots()});
}

/// New effects come last, so that the scenes of the other effects stay the same.
std::vector<ScenePart> newest_parts() {
    return {
        plain_part("dispersion",
                   [](Scene& s) {
                       MetallicRoughness& model = clear_model_of(s);
                       model.roughness = 0.2F;
                       model.thickness = 0.5F;
                       model.dispersion = 5.0F;
                   }),
    };
}

std::vector<ScenePart> all_parts() {
    return joined(
        {lighting_parts(), model_parts(), surface_parts(), environment_parts(), newest_parts()});
}

/// A sphere that nearly fills the picture, under two lights and ambient light.
Scene lit_ball() {
    Scene scene = test::scene_of(test::sphere(32, 24), Material{});
    scene.instances[0].world_from_object =
        glm::mat4(1.6F, 0.3F, 0, 0, -0.3F, 1.6F, 0, 0, 0, 0, 1.3F, 0, 0, 0, 0, 1);
    scene.ambient = {0.1F, 0.15F, 0.2F};
    scene.directional_lights = {{{-1, -2, -3}, {0.6F, 0.5F, 0.4F}}};
    scene.point_lights = {{{-2, 1, 2}, {0.9F, 1.2F, 1.5F}}};
    return scene;
}

/// Looks every texture that may be at the second texture coordinates up there, if the mesh has any.
void use_second_texcoords(Scene& scene) {
    if (scene.meshes[0]->texcoords_2.empty()) return;
    Material& material = material_of(scene);
    auto& model = material.metallic_roughness;
    const auto use = [](std::optional<Texture>& texture) {
        if (texture) texture->second_texcoords = true;
    };
    for (auto* texture :
         {&material.diffuse_texture, &material.specular_texture, &material.emission_texture,
          &material.occlusion_texture, &material.opacity_texture})
        use(*texture);
    if (!model) return;
    for (auto* texture : {&model->texture, &model->specular_texture, &model->specular_color_texture,
                          &model->sheen_color_texture, &model->sheen_roughness_texture,
                          &model->clearcoat_texture, &model->clearcoat_roughness_texture,
                          &model->iridescence_texture, &model->iridescence_thickness_texture,
                          &model->transmission_texture, &model->thickness_texture})
        use(*texture);
}

bool blurs_environment(const Scene& scene) {
    const FramePlan plan = plan_effects(scene, {.samples = 1});
    return plan.prefiltered_map;
}

/// Draws the scene of several parts, which are added in this order.
void expect_agreement_of(const Context& context, const std::vector<ScenePart>& parts,
                         std::uint64_t seed) {
    test::Dice dice(seed);
    Scene scene = lit_ball();
    for (const ScenePart& part : parts)
        part.add(scene, dice);
    use_second_texcoords(scene);
    test::expect_agreement(context, scene, picture_size,
                           blurs_environment(scene) ? test::blurred_tolerance : pair_tolerance);
}

/// All slots of a model at once, with each group of effects.
class TexturesTogether : public test::GlTest {
  protected:
    void expect_agreement_with(const std::vector<ScenePart>& slots,
                               const std::vector<ScenePart>& effects) const {
        for (std::size_t i = 0; i < effects.size(); ++i) {
            SCOPED_TRACE(effects[i].name);
            std::vector<ScenePart> parts{effects[i]};
            parts.insert(parts.end(), slots.begin(), slots.end());
            expect_agreement_of(context(), parts, i);
        }
    }
};

RELIEF_ON_EACH_BACKEND(TexturesTogether);

/// Returns one effect that is several.
ScenePart united(const char* name, const std::vector<ScenePart>& parts) {
    return {name, [=](Scene& scene, test::Dice& dice) {
                for (const ScenePart& part : parts)
                    part.add(scene, dice);
            }};
}

/// Returns the effects of these names, as one.
ScenePart united(const char* name, const std::vector<const char*>& names) {
    std::vector<ScenePart> parts;
    for (const ScenePart& part : all_parts()) {
        if (std::find(names.begin(), names.end(), std::string(part.name)) != names.end())
            parts.push_back(part);
    }
    EXPECT_EQ(parts.size(), names.size()) << name;
    return united(name, parts);
}

std::vector<ScenePart> effect_groups() {
    return {
        united("lights", {"spot light", "mixed falloff", "highlight colors", "vertex occlusion",
                          "Fresnel on highlights", "second texture coordinates"}),
        united("surfaces", {"flat", "vertex colors", "emission", "back faces", "blending",
                            "dielectric reflectance"}),
        united("frames and masks", {"derivative frames", "alpha mask", "Khronos PBR Neutral",
                                    "morphing and skinning", "Phong highlights"}),
        united("an environment", {"schlick", "no lights", "metal of roughness 1"}),
    };
}

/// Every group with OSMesa, and the first with EGL, which draws with the same code without a GPU.
/// TexturePairs has all effects with OSMesa, and a ninth of them with EGL.
std::vector<ScenePart> effect_groups(Backend backend) {
    std::vector<ScenePart> groups = effect_groups();
    if (backend == Backend::egl) groups.erase(groups.begin() + 1, groups.end());
    return groups;
}

TEST_P(TexturesTogether, OfMetallicRoughnessMatchTheReference) {
    std::vector<ScenePart> slots = model_slots();
    for (const ScenePart& slot : common_slots()) {
        if (slot.name != std::string("object-space normal map") &&
            slot.name != std::string("bump map"))
            slots.push_back(slot);
    }
    expect_agreement_with(slots, effect_groups(GetParam()));
}

TEST_P(TexturesTogether, OfPhongMatchTheReference) {
    std::vector<ScenePart> phong;
    const auto keep = [&](Scene& scene) { material_of(scene).metallic_roughness.reset(); };
    for (const ScenePart& group : effect_groups(GetParam())) {
        phong.push_back({group.name, [=](Scene& scene, test::Dice& dice) {
                             group.add(scene, dice);
                             keep(scene);
                         }});
    }
    expect_agreement_with(common_slots(), phong);
}

/// Roughness differs between neighbors, and so does the level of the picture behind the surface.
TEST_P(TexturesTogether, OfRoughnessAndTransmissionMatchTheReference) {
    for (const bool is_thick : {false, true}) {
        for (std::uint64_t seed = 0; seed < 2; ++seed) {
            const ScenePart clear = united("clear", {is_thick ? "volume" : "transmission"});
            expect_agreement_of(context(), {clear, model_slots()[0]}, seed);
        }
    }
}

/// One slot on one backend, with each effect alone. These tests are slow.
class TexturePairs : public ::testing::TestWithParam<std::tuple<Backend, std::size_t>> {
  protected:
    static void TearDownTestSuite() { test::release_shared_context(); }
};

TEST_LABELS(slow, sweep);
TEST_P(TexturePairs, AgreeWithTheReference) {
    const auto [backend, slot] = GetParam();
    const Context* const context = test::shared_context(backend);
    if (context == nullptr) GTEST_SKIP() << "the backend is not installed";
    const ScenePart texture = all_slots().at(slot);
    const std::vector<ScenePart> effects = all_parts();
    for (std::size_t i = 0; i < effects.size(); ++i) {
        // Both backends run the same compiler of shaders: a ninth of the pairs is enough for EGL.
        if (backend == Backend::egl && (i + slot) % 9 != 0) continue;
        SCOPED_TRACE(std::string(texture.name) + " with " + effects[i].name);
        expect_agreement_of(*context, {effects[i], texture}, i);
    }
    test::expect_clean_context();
}

std::string name_of(const ::testing::TestParamInfo<TexturePairs::ParamType>& info) {
    std::string name = std::get<0>(info.param) == Backend::osmesa ? "osmesa_" : "egl_";
    for (const char c : std::string(all_slots().at(std::get<1>(info.param)).name))
        name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(On, TexturePairs,
                         ::testing::Combine(::testing::Values(Backend::osmesa, Backend::egl),
                                            ::testing::Range(std::size_t{0}, all_slots().size())),
                         name_of);

}  // namespace
}  // namespace relief
