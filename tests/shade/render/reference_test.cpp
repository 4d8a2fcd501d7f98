// SPDX-License-Identifier: Apache-2.0
// OpenGL's picture against the CPU reference: every effect alone, shadows, blurred environments and
// random combinations, to within one code of 255 away from edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "relief/shade/effects.h"
#include "relief/shade/reference.h"
#include "shade/effects/feature_sets.h"
#include "shade/render/draw_support.h"
#include "shade/render/random_scene.h"
#include "shade/render/reference_agreement.h"
#include "support/labels.h"
#include "support/sanitized.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::AgainstReference;
using test::blurred_tolerance;
using test::lit_sphere;
using test::pixel;

/// In codes, for 8-bit textures: llvmpipe decodes sRGB with a polynomial whose error is up to half
/// a percent, which is half a code, and filters data with weights of 8 bits.
constexpr double coarse_tolerance = 2.0;

/// An optional part of a scene.
struct AddedThing {
    const char* name;
    std::function<void(Scene&, test::Dice&)> add;
};

Texture image(Scene& scene, Image texels) {
    scene.images.push_back({"image", std::move(texels)});
    return Texture{scene.images.size() - 1};
}

std::vector<AddedThing> light_effects() {
    return {
        {"vertex occlusion",
         [](Scene& scene, test::Dice&) {
             scene.instances[0].open_shares = test::shares_of(scene.meshes[0]);
         }},
        {"spot light",
         [](Scene& scene, test::Dice&) {
             scene.spot_lights = {{{{0, 1, 3}, {4, 3, 2}}, {0, -1, -3}, 0.1F, 0.35F}};
         }},
        {"range", [](Scene& scene, test::Dice&) { scene.point_lights[0].range = 2.5F; }},
        {"no falloff",
         [](Scene& scene, test::Dice&) {
             scene.point_lights[0].falloff = Falloff::none;
             scene.point_lights[0].intensity *= 0.3F;
         }},
        {"mixed falloff",
         [](Scene& scene, test::Dice&) {
             scene.point_lights.push_back({{2, 2, 2}, glm::vec3(0.2F), 4.0F, Falloff::none});
         }},
        {"highlight colors",
         [](Scene& scene, test::Dice&) {
             scene.materials[0].specular = glm::vec3(0.5F);
             scene.point_lights[0].highlight_intensity = glm::vec3(2, 0, 1);
             scene.directional_lights[0].highlight_irradiance = glm::vec3(0, 1, 1);
         }},
        {"ambient light of lights, one of which is off",
         [](Scene& scene, test::Dice&) {
             scene.directional_lights[0].ambient = {0.2F, 0.0F, 0.1F};
             scene.directional_lights.push_back(scene.directional_lights[0]);
             scene.directional_lights[1].on = false;
             scene.point_lights[0].ambient = {0.0F, 0.1F, 0.0F};
             scene.spot_lights = {{{{0, 1, 3}, {4, 3, 2}}, {0, -1, -3}, 0.1F, 0.35F}};
             scene.spot_lights[0].point.on = false;
             scene.spot_lights[0].point.ambient = glm::vec3(0.5F);
         }},
        {"exposure", [](Scene& scene, test::Dice&) { scene.exposure = 1.7F; }},
        {"Reinhard", [](Scene& scene, test::Dice&) { scene.tone_mapping = ToneMapping::reinhard; }},
        {"ACES", [](Scene& scene, test::Dice&) { scene.tone_mapping = ToneMapping::aces; }},
    };
}

/// glTF's model with an index, weight and color of its own.
MetallicRoughness colored_dielectric() {
    MetallicRoughness model{{0.8F, 0.5F, 0.3F}, 0.3F, 0.35F, std::nullopt};
    model.refractive_index = 2.2F;
    model.specular = 0.7F;
    model.specular_color = {0.2F, 0.5F, 1.5F};
    return model;
}

/// glTF's model with sheen and coat.
MetallicRoughness with_layers(const glm::vec3& sheen, float clearcoat) {
    MetallicRoughness model{{0.5F, 0.3F, 0.2F}, 0.3F, 0.5F, std::nullopt};
    model.sheen_color = sheen;
    model.sheen_roughness = 0.6F;
    model.clearcoat = clearcoat;
    model.clearcoat_roughness = 0.3F;
    return model;
}

/// glTF's model, brushed at an angle to the tangents.
MetallicRoughness brushed_metal() {
    MetallicRoughness model{{0.8F, 0.5F, 0.3F}, 0.7F, 0.35F, std::nullopt};
    model.anisotropy = 0.8F;
    model.anisotropy_rotation = 0.6F;
    return model;
}

/// glTF's model under a thin film.
MetallicRoughness filmed(float metallic) {
    MetallicRoughness model{{0.8F, 0.5F, 0.3F}, metallic, 0.35F, std::nullopt};
    model.iridescence = 0.9F;
    model.iridescence_index = 1.4F;
    model.iridescence_thickness = 480.0F;
    return model;
}

std::vector<AddedThing> material_effects() {
    std::vector<AddedThing> effects = {
        {"nothing else", [](Scene&, test::Dice&) {}},
        {"flat", [](Scene& s, test::Dice&) { s.materials[0].interpolation = Interpolation::flat; }},
        {"unlit", [](Scene& s, test::Dice&) { s.materials[0].unlit = true; }},
        {"emission",
         [](Scene& s, test::Dice&) {
             s.materials[0].emission = {0.2F, 0.1F, 0.0F};
         }},
        {"metallic-roughness",
         [](Scene& s, test::Dice&) {
             s.materials[0].metallic_roughness =
                 MetallicRoughness{{0.8F, 0.5F, 0.3F}, 0.4F, 0.35F, std::nullopt};
         }},
        {"dielectric reflectance",
         [](Scene& s, test::Dice&) { s.materials[0].metallic_roughness = colored_dielectric(); }},
        {"sheen",
         [](Scene& s, test::Dice&) {
             s.materials[0].metallic_roughness = with_layers({0.9F, 0.5F, 0.2F}, 0.0F);
         }},
        {"clearcoat",
         [](Scene& s, test::Dice&) {
             s.materials[0].metallic_roughness = with_layers(glm::vec3(0.0F), 0.8F);
             s.materials[0].emission = {0.2F, 0.1F, 0.0F};
         }},
        {"anisotropy",
         [](Scene& s, test::Dice&) { s.materials[0].metallic_roughness = brushed_metal(); }},
        {"iridescence of a metal",
         [](Scene& s, test::Dice&) { s.materials[0].metallic_roughness = filmed(1.0F); }},
        {"iridescence of a dielectric",
         [](Scene& s, test::Dice&) {
             s.materials[0].metallic_roughness = filmed(0.0F);
             s.materials[0].metallic_roughness->iridescence_index = 1.8F;
         }},
        {"anisotropy on facets",
         [](Scene& s, test::Dice&) {
             s.materials[0].metallic_roughness = brushed_metal();
             s.materials[0].interpolation = Interpolation::flat;
         }},
        {"coated emission",
         [](Scene& s, test::Dice&) {
             s.directional_lights.clear();
             s.point_lights.clear();
             s.ambient = glm::vec3(0.0F);
             s.materials[0].metallic_roughness = with_layers(glm::vec3(0.0F), 1.0F);
             s.materials[0].emission = {0.2F, 0.1F, 0.4F};
         }},
        {"vertex colors",
         [](Scene& s, test::Dice&) {
             for (const glm::vec3& position : s.meshes[0]->positions)
                 s.meshes[0].edit().colors.emplace_back(position * 0.5F + 0.5F, 1.0F);
         }},
        {"back faces",
         [](Scene& s, test::Dice&) {
             s.materials[0].double_sided = true;
             for (glm::uvec3& triangle : s.meshes[0].edit().triangles)
                 std::swap(triangle.y, triangle.z);
         }},
        {"blending",
         [](Scene& s, test::Dice&) {
             s.materials[0].alpha_mode = AlphaMode::blend;
             s.materials[0].opacity = 0.6F;
             s.materials[0].double_sided = true;
             s.background = {0.2F, 0.4F, 0.6F, 0.8F};
         }},
    };
    for (const Interpolation where : {Interpolation::per_pixel, Interpolation::gouraud}) {
        effects.push_back({"clamped terms", [=](Scene& s, test::Dice&) {
                               s.clamp_terms = true;
                               s.exposure = 0.3F;  // The sum of clamped terms exceeds 1.
                               s.directional_lights[0].irradiance = {3.0F, 1.0F, 0.5F};
                               s.ambient = glm::vec3(2.0F);
                               s.materials[0].specular = {2.0F, 0.4F, 0.3F};
                               s.materials[0].shininess = 3.0F;
                               s.materials[0].emission = {1.5F, 0.2F, 0.0F};
                               s.materials[0].interpolation = where;
                               for (const glm::vec3& position : s.meshes[0]->positions)
                                   s.meshes[0].edit().colors.emplace_back(position * 0.5F + 0.5F,
                                                                          1.0F);
                           }});
    }
    for (const SpecularModel model : {SpecularModel::phong, SpecularModel::blinn_phong,
                                      SpecularModel::blinn_phong_normalized}) {
        for (const Interpolation where : {Interpolation::per_pixel, Interpolation::gouraud}) {
            effects.push_back({"highlights", [=](Scene& s, test::Dice&) {
                                   s.materials[0].specular = {0.5F, 0.4F, 0.3F};
                                   s.materials[0].specular_model = model;
                                   s.materials[0].interpolation = where;
                               }});
            effects.push_back({"Fresnel on highlights", [=](Scene& s, test::Dice&) {
                                   s.materials[0].specular = {0.3F, 0.1F, 1.5F};
                                   s.materials[0].shininess = 3.0F;
                                   s.materials[0].specular_model = model;
                                   s.materials[0].interpolation = where;
                                   s.materials[0].highlight_fresnel = true;
                               }});
        }
    }
    return effects;
}

/// Returns an effect that is a texture of glTF's model with all of its extensions.
template <auto Member>
AddedThing model_texture(const char* name, int channels, ColorSpace space) {
    return {name, [=](Scene& s, test::Dice& d) {
                MetallicRoughness model = colored_dielectric();
                model.sheen_color = {0.3F, 0.6F, 0.1F};
                model.sheen_roughness = 0.6F;
                model.clearcoat = 0.8F;
                model.clearcoat_roughness = 0.6F;
                model.anisotropy = 0.7F;
                model.iridescence = 0.9F;
                model.*Member = image(s, test::random_image(d, channels, space));
                s.materials[0].metallic_roughness = model;
            }};
}

std::vector<AddedThing> texture_effects() {
    using M = MetallicRoughness;
    return {
        {"vertex occlusion of glTF's model",
         [](Scene& scene, test::Dice&) {
             scene.instances[0].open_shares = test::shares_of(scene.meshes[0]);
             scene.materials[0].metallic_roughness = with_layers({0.9F, 0.5F, 0.2F}, 0.5F);
             scene.materials[0].occlusion_texture =
                 image(scene, test::constant_image(glm::vec4(0.5F), 3, 16, ColorSpace::data));
             scene.ambient = glm::vec3(0.5F);
         }},
        model_texture<&M::specular_texture>("specular weight texture", 4, ColorSpace::data),
        model_texture<&M::specular_color_texture>("specular color texture", 3, ColorSpace::linear),
        model_texture<&M::sheen_color_texture>("sheen color texture", 3, ColorSpace::linear),
        model_texture<&M::sheen_roughness_texture>("sheen roughness texture", 4, ColorSpace::data),
        model_texture<&M::clearcoat_texture>("clearcoat texture", 3, ColorSpace::data),
        model_texture<&M::clearcoat_roughness_texture>("clearcoat roughness texture", 3,
                                                       ColorSpace::data),
        model_texture<&M::iridescence_texture>("iridescence texture", 3, ColorSpace::data),
        model_texture<&M::iridescence_thickness_texture>("film thickness texture", 3,
                                                         ColorSpace::data),
        {"anisotropy texture",
         [](Scene& s, test::Dice& d) {
             s.materials[0].metallic_roughness = brushed_metal();
             s.materials[0].metallic_roughness->anisotropy_texture =
                 image(s, test::random_normals(d));
         }},
        {"second texture coordinates",
         [](Scene& s, test::Dice& d) {
             Mesh& mesh = s.meshes[0].edit();
             for (const glm::vec2& texcoord : mesh.texcoords)
                 mesh.texcoords_2.emplace_back(0.7F * texcoord.y, 0.3F + 0.6F * texcoord.x);
             Material& material = s.materials[0];
             material.normal_map = NormalMap{image(s, test::random_normals(d))};
             material.normal_map->flat = FlatCode::middle;
             material.diffuse_texture = image(s, test::random_image(d, 3, ColorSpace::linear));
             material.occlusion_texture = image(s, test::random_image(d, 1, ColorSpace::data));
             material.occlusion_texture->second_texcoords = true;
             MetallicRoughness& model = material.metallic_roughness.emplace();
             model.texture = image(s, test::random_image(d, 3, ColorSpace::data));
             model.texture->second_texcoords = true;
         }},
        {"second texture coordinates that the mesh does not have",
         [](Scene& s, test::Dice& d) {
             Texture& texture = s.materials[0].diffuse_texture.emplace();
             texture = image(s, test::random_image(d, 3, ColorSpace::linear));
             texture.second_texcoords = true;
         }},
        {"mask at second texture coordinates",
         [](Scene& s, test::Dice& d) {
             Mesh& mesh = s.meshes[0].edit();
             for (const glm::vec2& texcoord : mesh.texcoords)
                 mesh.texcoords_2.push_back(0.5F * texcoord);
             mesh.texcoords.clear();
             s.materials[0].alpha_mode = AlphaMode::mask;
             s.materials[0].unlit = true;
             s.materials[0].diffuse_texture =
                 image(s, test::random_image(d, 4, ColorSpace::linear));
             s.materials[0].diffuse_texture->second_texcoords = true;
         }},
        {"diffuse texture",
         [](Scene& s, test::Dice& d) {
             s.materials[0].diffuse_texture =
                 image(s, test::random_image(d, 3, ColorSpace::linear));
         }},
        {"nearest texture",
         [](Scene& s, test::Dice& d) {
             s.materials[0].diffuse_texture =
                 image(s, test::random_image(d, 3, ColorSpace::linear));
             s.materials[0].diffuse_texture->filter = TextureFilter::nearest;
         }},
        {"specular texture",
         [](Scene& s, test::Dice& d) {
             s.materials[0].specular = glm::vec3(0.6F);
             s.materials[0].specular_texture =
                 image(s, test::random_image(d, 3, ColorSpace::linear));
         }},
        {"emission texture",
         [](Scene& s, test::Dice& d) {
             s.materials[0].emission = glm::vec3(0.4F);
             s.materials[0].emission_texture =
                 image(s, test::random_image(d, 3, ColorSpace::linear));
         }},
        {"occlusion texture",
         [](Scene& s, test::Dice& d) {
             s.materials[0].occlusion_texture =
                 image(s, test::random_image(d, 1, ColorSpace::data));
             s.materials[0].occlusion_strength = 0.7F;
             s.ambient = glm::vec3(0.6F);
         }},
        {"opacity texture",
         [](Scene& s, test::Dice& d) {
             s.materials[0].alpha_mode = AlphaMode::blend;
             s.materials[0].opacity_texture = image(s, test::random_image(d, 1, ColorSpace::data));
         }},
        {"alpha mask",
         [](Scene& s, test::Dice& d) {
             s.materials[0].alpha_mode = AlphaMode::mask;
             s.materials[0].double_sided = true;
             s.materials[0].diffuse_texture =
                 image(s, test::random_image(d, 4, ColorSpace::linear));
         }},
        {"metallic-roughness texture",
         [](Scene& s, test::Dice& d) {
             s.materials[0].metallic_roughness =
                 MetallicRoughness{{0.8F, 0.5F, 0.3F},
                                   1.0F,
                                   1.0F,
                                   image(s, test::random_image(d, 3, ColorSpace::data))};
         }},
    };
}

/// Returns all effects that change normals, with both kinds of frame, in place and mirrored.
std::vector<AddedThing> detail_effects() {
    std::vector<AddedThing> effects;
    for (const bool mirrored : {false, true}) {
        for (const TangentFrame frame : {TangentFrame::stored, TangentFrame::derivatives}) {
            const auto prepare = [=](Scene& scene) {
                scene.materials[0].tangent_frame = frame;
                scene.materials[0].specular = glm::vec3(0.3F);
                if (mirrored) scene.instances[0].world_from_object[0].x = -0.8F;
            };
            effects.push_back({"normal map", [=](Scene& s, test::Dice& d) {
                                   prepare(s);
                                   s.materials[0].normal_map =
                                       NormalMap{image(s, test::random_normals(d))};
                                   s.materials[0].normal_map->flat = FlatCode::middle;
                               }});
            effects.push_back(
                {"sheen and coat on a normal map", [=](Scene& s, test::Dice& d) {
                     prepare(s);
                     s.materials[0].normal_map = NormalMap{image(s, test::random_normals(d))};
                     s.materials[0].metallic_roughness = with_layers({0.2F, 0.5F, 0.9F}, 0.9F);
                 }});
            effects.push_back({"coat's own normal map", [=](Scene& s, test::Dice& d) {
                                   prepare(s);
                                   NormalMap map{image(s, test::random_normals(d)), 0.7F};
                                   s.materials[0].metallic_roughness =
                                       with_layers(glm::vec3(0.0F), 0.9F);
                                   s.materials[0].metallic_roughness->clearcoat_normal_map = map;
                                   s.materials[0].double_sided = true;
                               }});
            effects.push_back({"anisotropy on a normal map", [=](Scene& s, test::Dice& d) {
                                   prepare(s);
                                   s.materials[0].normal_map =
                                       NormalMap{image(s, test::random_normals(d))};
                                   s.materials[0].metallic_roughness = brushed_metal();
                                   s.materials[0].metallic_roughness->clearcoat = 0.5F;
                                   s.materials[0].double_sided = true;
                               }});
            effects.push_back(
                {"bump map", [=](Scene& s, test::Dice& d) {
                     prepare(s);
                     s.materials[0].bump_map = BumpMap{image(s, test::random_heights(d)), 1.5F};
                 }});
        }
        effects.push_back({"object-space normal map", [=](Scene& s, test::Dice& d) {
                               NormalMap map{image(s, test::random_normals(d))};
                               map.space = NormalSpace::object;
                               s.materials[0].normal_map = map;
                               if (mirrored) s.instances[0].world_from_object[0].x = -0.8F;
                           }});
    }
    return effects;
}

std::vector<AddedThing> environment_effects() {
    std::vector<AddedThing> effects = {{"skybox", [](Scene& s, test::Dice& d) {
                                            s.environment = test::random_environment(d);
                                            s.environment->skybox = true;
                                        }}};
    for (const FresnelModel model :
         {FresnelModel::schlick, FresnelModel::dielectric, FresnelModel::conductor}) {
        for (const float transmission : {0.0F, 0.7F}) {
            effects.push_back({"reflection", [=](Scene& s, test::Dice& d) {
                                   s.environment = test::random_environment(d);
                                   s.materials[0].reflectivity = {0.9F, 0.5F, 0.2F};
                                   s.materials[0].fresnel = model;
                                   s.materials[0].transmission = transmission;
                               }});
        }
    }
    effects.push_back({"transmission alone", [](Scene& s, test::Dice& d) {
                           s.environment = test::random_environment(d);
                           s.materials[0].transmission = 0.7F;
                       }});
    effects.push_back({"reflection by normal", [](Scene& s, test::Dice& d) {
                           s.environment = test::random_environment(d);
                           s.materials[0].reflectivity = glm::vec3(0.6F);
                           s.materials[0].reflection_by_normal = true;
                       }});
    for (const Interpolation where :
         {Interpolation::per_pixel, Interpolation::gouraud, Interpolation::flat}) {
        effects.push_back({"environment tint", [=](Scene& s, test::Dice& d) {
                               s.environment = test::random_environment(d);
                               s.environment->rotation = 1.0F;
                               s.materials[0].environment_tint = true;
                               s.materials[0].specular = glm::vec3(0.6F);
                               s.materials[0].reflectivity = glm::vec3(0.2F);
                               s.materials[0].interpolation = where;
                               if (where == Interpolation::gouraud) return;
                               s.materials[0].double_sided = true;
                               s.materials[0].normal_map =
                                   NormalMap{image(s, test::random_normals(d))};
                           }});
    }
    effects.push_back({"clamped light of the environment", [](Scene& s, test::Dice& d) {
                           s.environment = test::random_environment(d);
                           s.environment->lights = true;
                           s.environment->intensity = 4.0F;
                           s.exposure = 0.5F;
                           s.clamp_terms = true;
                       }});
    effects.push_back({"rotation", [](Scene& s, test::Dice& d) {
                           s.environment = test::random_environment(d);
                           s.environment->rotation = 2.0F;
                           s.environment->skybox = s.environment->lights = true;
                           s.materials[0].reflectivity = glm::vec3(0.3F);
                           s.materials[0].transmission = 0.3F;
                       }});
    // Gouraud shading uses vertex normals, with and without lights.
    effects.push_back({"Gouraud mirror", [](Scene& s, test::Dice& d) {
                           s.environment = test::random_environment(d);
                           s.materials[0].interpolation = Interpolation::gouraud;
                           s.materials[0].reflectivity = glm::vec3(0.5F);
                           s.materials[0].normal_map = NormalMap{image(s, test::random_normals(d))};
                           s.directional_lights.clear();
                           s.point_lights.clear();
                       }});
    return effects;
}

/// Adds cubes behind the model, and makes it let them through.
MetallicRoughness& clear_before_cubes(Scene& scene, float roughness, float thickness) {
    Mesh cube = test::cube();
    cube.material_ranges = {{0, 12, 1}};
    scene.meshes.emplace_back(cube);
    scene.materials.resize(2);
    scene.materials[1].diffuse = {0.9F, 0.4F, 0.1F};
    for (const float x : {-0.7F, 0.5F}) {
        glm::mat4 place(0.4F);
        place[3] = {x, 0.5F * x, -1.5F, 1.0F};
        scene.instances.push_back({scene.meshes.size() - 1, place, "behind"});
    }
    scene.background = {0.2F, 0.4F, 0.6F, 0.8F};
    MetallicRoughness& model = scene.materials[0].metallic_roughness.emplace();
    model = {{0.9F, 0.8F, 0.6F}, 0.1F, roughness, std::nullopt};
    model.transmission = 0.9F;
    model.thickness = thickness;
    model.attenuation_distance = 0.7F;
    model.attenuation_color = {0.9F, 0.3F, 0.0F};
    return model;
}

std::vector<AddedThing> transmission_effects() {
    using M = MetallicRoughness;
    std::vector<AddedThing> effects;
    for (const float roughness : {0.0F, 0.2F, 0.6F, 1.0F}) {
        for (const float thickness : {0.0F, 0.6F}) {
            effects.push_back({"transmission", [=](Scene& s, test::Dice&) {
                                   clear_before_cubes(s, roughness, thickness);
                               }});
        }
    }
    effects.push_back({"without any light", [](Scene& s, test::Dice& d) {
                           clear_before_cubes(s, 0.1F, 0.4F);
                           s.ambient = glm::vec3(0.0F);
                           s.directional_lights.clear();
                           s.point_lights.clear();
                           s.materials[1].emission = {0.8F, 0.3F, 0.1F};
                           s.materials[0].diffuse_texture =
                               image(s, test::random_image(d, 3, ColorSpace::linear));
                       }});
    for (const float index : {0.0F, 1.0F, 2.2F}) {
        effects.push_back({"another index", [=](Scene& s, test::Dice&) {
                               M& model = clear_before_cubes(s, 0.3F, 0.4F);
                               model.refractive_index = index;
                               model.specular_color = {0.3F, 0.6F, 0.9F};
                           }});
    }
    for (const float index : {0.0F, 0.5F, 1.0F, 1.7F}) {
        for (const float dispersion : {5.0F, 200.0F}) {
            effects.push_back({"dispersion", [=](Scene& s, test::Dice&) {
                                   M& model = clear_before_cubes(s, 0.1F, 0.5F);
                                   model.refractive_index = index;
                                   model.dispersion = dispersion;
                               }});
        }
    }
    effects.push_back({"under film, sheen and coat", [](Scene& s, test::Dice&) {
                           M& model = clear_before_cubes(s, 0.3F, 0.4F);
                           model.iridescence = 0.9F;
                           model.iridescence_thickness = 480.0F;
                           model.sheen_color = {0.3F, 0.6F, 0.1F};
                           model.sheen_roughness = 0.6F;
                           model.clearcoat = 0.8F;
                           model.clearcoat_roughness = 0.6F;
                       }});
    effects.push_back({"textures", [](Scene& s, test::Dice& d) {
                           M& model = clear_before_cubes(s, 0.3F, 0.4F);
                           model.transmission_texture =
                               image(s, test::random_image(d, 3, ColorSpace::data));
                           model.thickness_texture =
                               image(s, test::random_image(d, 3, ColorSpace::data));
                       }});
    effects.push_back({"blended", [](Scene& s, test::Dice&) {
                           clear_before_cubes(s, 0.3F, 0.4F);
                           s.materials[0].alpha_mode = AlphaMode::blend;
                           s.materials[0].opacity = 0.6F;
                       }});
    effects.push_back({"normal map", [](Scene& s, test::Dice& d) {
                           clear_before_cubes(s, 0.3F, 0.4F);
                           s.materials[0].normal_map = NormalMap{image(s, test::random_normals(d))};
                           s.materials[0].normal_map->flat = FlatCode::middle;
                           s.materials[0].double_sided = true;
                       }});
    effects.push_back({"orthographic camera", [](Scene& s, test::Dice&) {
                           clear_before_cubes(s, 0.3F, 0.4F);
                           s.camera->orthographic_height = 3.0F;
                       }});
    effects.push_back({"path that begins behind the eye", [](Scene& s, test::Dice&) {
                           M& model = clear_before_cubes(s, 0.0F, 1e4F);
                           model.attenuation_distance.reset();
                           s.instances[0].world_from_object[0].x *= -1.0F;
                       }});
    return effects;
}

class EffectOnItsOwn : public AgainstReference {
  protected:
    void expect_agreement_of_each(const std::vector<AddedThing>& effects) const {
        for (std::size_t i = 0; i < effects.size(); ++i) {
            SCOPED_TRACE(testing::Message() << effects[i].name << ", number " << i);
            for (const bool on_sphere : {true, false}) {
                if (test::is_sanitized && !on_sphere) continue;  // It calls the same code.
                SCOPED_TRACE(on_sphere ? "on a sphere" : "on a cube");
                test::Dice dice(i);
                Scene scene = lit_sphere();
                if (!on_sphere) {
                    Mesh mesh = test::cube();
                    mesh.material_ranges = {{0, 12, 0}};
                    scene.meshes = {mesh};
                    glm::mat4& place = scene.instances[0].world_from_object;
                    place = {{0.5F, 0.1F, -0.4F, 0},
                             {0, 0.6F, 0.1F, 0},
                             {0.3F, -0.1F, 0.5F, 0},
                             {0, 0, 0, 1}};
                }
                effects[i].add(scene, dice);
                expect_agreement(scene);
            }
        }
    }
};

TEST_F(EffectOnItsOwn, OfLightMatchesTheReference) {
    expect_agreement_of_each(light_effects());
}

TEST_F(EffectOnItsOwn, OfTheMaterialMatchesTheReference) {
    expect_agreement_of_each(material_effects());
}

TEST_F(EffectOnItsOwn, OfTexturesMatchesTheReference) {
    expect_agreement_of_each(texture_effects());
}

TEST_F(EffectOnItsOwn, OfSurfaceDetailMatchesTheReference) {
    expect_agreement_of_each(detail_effects());
}

TEST_F(EffectOnItsOwn, OfTransmissionMatchesTheReference) {
    expect_agreement_of_each(transmission_effects());
}

TEST_F(EffectOnItsOwn, OfTheEnvironmentMatchesTheReference) {
    expect_agreement_of_each(environment_effects());
}

TEST_F(AgainstReference, AgreesWithEightBitTexturesAlmostAsWell) {
    test::Dice dice(1);
    for (const ColorSpace space : {ColorSpace::srgb, ColorSpace::data}) {
        Scene scene = lit_sphere();
        Image coded = make_image(6, 5, 3, 8, space);
        for (std::uint8_t& sample : coded.as<std::uint8_t>())
            sample = static_cast<std::uint8_t>(dice.below(256));
        const Texture texture = image(scene, coded);
        if (space == ColorSpace::srgb) {
            scene.materials[0].diffuse_texture = texture;
        } else {
            scene.materials[0].occlusion_texture = texture;
        }
        expect_agreement(scene, coarse_tolerance);
    }
}

/// A ball above a square, seen from the side, without other light than one that casts a shadow.
Scene ball_above_square(ShadowTerm light, float degrees) {
    Scene scene = test::scene_of(test::sphere(48, 32), Material{});
    scene.meshes.push_back(test::square_scene(Material{}).meshes[0]);
    scene.instances[0].world_from_object =
        glm::scale(glm::translate(glm::mat4(1.0F), {0.0F, 0.0F, 1.5F}), glm::vec3(0.8F));
    scene.instances.push_back({1, glm::mat4(1.0F), "square"});
    scene.materials[0].diffuse = {0.8F, 0.6F, 0.4F};
    scene.materials[0].specular = glm::vec3(0.3F);
    scene.shadow = Shadow{glm::radians(degrees)};
    const glm::vec3 place{-3.0F, 4.0F, 7.0F};
    if (light == ShadowTerm::directional_light)
        scene.directional_lights = {{-place, glm::vec3(0.9F)}};
    if (light == ShadowTerm::point_light) scene.point_lights = {{place, glm::vec3(60.0F)}};
    if (light == ShadowTerm::spot_light)
        scene.spot_lights = {{{place, glm::vec3(60.0F)}, -place, 0.2F, 0.5F}};
    scene.camera = framed(scene, 0.5F, 0.3F, 0.6F, 1.0F);
    return scene;
}

/// The difference between a picture and its reference.
struct ShadowErrors {
    double mean = 0.0;   ///< In codes, over all pixels.
    double large = 0.0;  ///< The share of pixels with a difference above 10 codes.
    double dark = 0.0;   ///< The share of pixels that are darker than without a shadow.
};

class Shadows : public AgainstReference {
  protected:
    [[nodiscard]] ShadowErrors errors_of(const Scene& scene) const {
        constexpr int size = 128;
        Report report;
        const shade::Reference reference = render_reference(scene, {size, size, 0.0}, report);
        const Image expected = reference_picture(reference.radiance, scene, OutputCoding::srgb);
        const FrameSettings settings{size, size, 1, OutputCoding::srgb};
        const Image drawn = render(scene, settings).image;
        Scene without = scene;
        without.shadow.reset();
        const Image lit = render(without, settings).image;
        ShadowErrors errors;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const double is = pixel(drawn, x, y)[0];
                const double apart = std::abs(is - 255.0 * pixel(expected, x, y)[0]);
                errors.mean += apart / (size * size);
                if (apart > 10.0) errors.large += 1.0 / (size * size);
                if (is < pixel(lit, x, y)[0]) errors.dark += 1.0 / (size * size);
            }
        }
        return errors;
    }

    void expect_agreement_of_shadow(const Scene& scene) const {
        const ShadowErrors errors = errors_of(scene);
        // Pictures are rounded to codes. Shadows differ at edges only, by a fraction of a texel of
        // their maps, which are finer than these pictures.
        EXPECT_LT(errors.mean, 0.22);
        EXPECT_LT(errors.large, 0.003);
        EXPECT_GT(errors.dark, 0.03);
        EXPECT_LT(errors.dark, 0.5);
    }
};

TEST_F(Shadows, OfAllLightsMatchTheReference) {
    for (const ShadowTerm light :
         {ShadowTerm::directional_light, ShadowTerm::point_light, ShadowTerm::spot_light}) {
        for (const float degrees : {0.0F, 2.0F, 12.0F, 30.0F}) {
            if (test::is_sanitized && degrees > 2.0F) continue;
            SCOPED_TRACE(testing::Message()
                         << "light " << static_cast<int>(light) << ", " << degrees << " degrees");
            const Scene scene = ball_above_square(light, degrees);
            EXPECT_EQ(plan_effects(scene, {}).draws[0].features.shadow, light);
            expect_agreement_of_shadow(scene);
        }
    }
}

TEST_F(Shadows, OnAllKindsOfSurfacesAreThoseOfTheReference) {
    const auto expect_with = [&](const char* name, const std::function<void(Scene&)>& change) {
        SCOPED_TRACE(name);
        Scene scene = ball_above_square(ShadowTerm::directional_light, 6.0F);
        change(scene);
        expect_agreement_of_shadow(scene);
    };
    expect_with("Gouraud", [](Scene& scene) {
        scene.meshes[1] = test::grid(24);
        scene.instances[1].world_from_object =
            glm::scale(glm::translate(glm::mat4(1.0F), {-2.0F, -2.0F, 0.0F}), glm::vec3(4.0F));
        scene.meshes[1].edit().material_ranges = {
            {0, static_cast<std::uint32_t>(scene.meshes[1]->triangles.size()), 0}};
        scene.materials[0].interpolation = Interpolation::gouraud;
    });
    expect_with("metallic-roughness with layers", [](Scene& scene) {
        scene.materials[0].metallic_roughness = with_layers({0.9F, 0.5F, 0.2F}, 0.0F);
    });
    expect_with("a mask", [](Scene& scene) {
        Image holes = make_image(4, 4, 4, 8, ColorSpace::srgb);
        for (std::size_t i = 0; i < 64; ++i)
            holes.as<std::uint8_t>()[i] = i % 4 != 3 || i / 4 % 2 == 0 ? 255 : 0;
        scene.materials[0].diffuse_texture = image(scene, holes);
        scene.materials[0].diffuse_texture->filter = TextureFilter::nearest;
        scene.materials[0].alpha_mode = AlphaMode::mask;
        scene.materials[0].double_sided = true;
    });
    expect_with("a mirrored instance",
                [](Scene& scene) { scene.instances[0].world_from_object[0] *= -1.0F; });
    expect_with("a pose", [](Scene& scene) {
        Features f;
        f.morphing = f.skinning = true;
        scene.instances[0].pose = test::pose_calling_for(scene.meshes[0], f);
    });
    expect_with("far from the origin", [](Scene& scene) {
        for (Instance& instance : scene.instances)
            instance.world_from_object[3] += glm::vec4(65536.0F, 0.0F, 0.0F, 0.0F);
        scene.camera = framed(scene, 0.5F, 0.3F, 0.6F, 1.0F);
    });
}

TEST_F(Shadows, FollowMovedLightsAndSurfaces) {
    const FrameSettings settings{64, 64, 1, OutputCoding::srgb};
    Scene scene = ball_above_square(ShadowTerm::point_light, 4.0F);
    Renderer renderer(context(), scene, settings);
    const Image before = renderer.draw(*scene.camera).image;
    scene.point_lights[0].position_world = {3.0F, 4.0F, 7.0F};
    scene.instances[0].world_from_object[3].y += 0.3F;
    renderer.move(scene);
    const Image moved = renderer.draw(*scene.camera).image;
    EXPECT_FALSE(test::same_bits(moved, before));
    EXPECT_TRUE(test::same_bits(moved, render(scene, settings).image));
    // A light inside of the scene casts no shadow.
    scene.point_lights[0].position_world = {0.5F, 0.5F, 0.5F};
    renderer.move(scene);
    EXPECT_TRUE(test::same_bits(renderer.draw(*scene.camera).image, render(scene, settings).image));
}

/// A ball that reflects a blurred environment, with Phong's model or, with a metallic share, with
/// glTF's.
Scene glossy_sphere(float roughness, std::optional<float> metallic) {
    test::Dice dice(7);
    Scene scene = lit_sphere();
    scene.environment = test::random_environment(dice, 32);
    scene.environment->lights = true;
    scene.environment->skybox = false;
    Material& material = scene.materials[0];
    if (metallic) {
        material.metallic_roughness =
            MetallicRoughness{{0.9F, 0.6F, 0.3F}, *metallic, roughness, std::nullopt};
    } else {
        material.reflectivity = {0.9F, 0.6F, 0.3F};
        material.reflection_roughness = roughness;
    }
    return scene;
}

TEST_LABELS(slow);
TEST_F(AgainstReference, AgreesInABlurredEnvironment) {
    for (const float roughness : {0.1F, 0.15F, 0.3F, 0.5F, 0.7F, 1.0F}) {
        for (const std::optional<float> metallic :
             {std::optional<float>(), std::optional(0.0F), std::optional(1.0F)}) {
            SCOPED_TRACE(testing::Message()
                         << "roughness " << roughness << ", metallic " << metallic.value_or(-1.0F));
            expect_agreement(glossy_sphere(roughness, metallic), blurred_tolerance);
        }
    }
    for (const float blur : {0.1F, 0.5F, 1.0F}) {
        SCOPED_TRACE(testing::Message() << "skybox, blur " << blur);
        Scene open = glossy_sphere(0.2F, 1.0F);
        open.environment->skybox = true;
        open.environment->skybox_blur = blur;
        open.environment->rotation = 0.8F;
        // The skybox shows the map itself, so that two percent are five codes.
        expect_agreement(open, 0.02 * 255.0);
    }
    Scene painted = glossy_sphere(0.4F, std::nullopt);
    painted.materials[0].reflection_by_normal = true;
    expect_agreement(painted, blurred_tolerance);
}

TEST_F(AgainstReference, AgreesForExtensionsOfMetallicRoughnessInAnEnvironment) {
    Scene scene = glossy_sphere(0.35F, 0.3F);
    scene.materials[0].metallic_roughness = colored_dielectric();
    expect_agreement(scene, blurred_tolerance);
    scene.materials[0].metallic_roughness = with_layers({0.9F, 0.5F, 0.2F}, 0.0F);
    expect_agreement(scene, blurred_tolerance);
    scene.materials[0].metallic_roughness = with_layers({0.9F, 0.5F, 0.2F}, 0.8F);
    expect_agreement(scene, blurred_tolerance);
    scene.materials[0].metallic_roughness = brushed_metal();
    expect_agreement(scene, blurred_tolerance);
    scene.materials[0].metallic_roughness = filmed(0.3F);
    expect_agreement(scene, blurred_tolerance);
    clear_before_cubes(scene, 0.4F, 0.5F);
    scene.environment->skybox = true;
    test::expect_agreement(context(), scene, 48, blurred_tolerance);  // With edges in most pixels.
}

/// Makes the camera of a scene orthographic, with the size at the origin.
Scene seen_in_parallel(Scene scene) {
    Camera& camera = *scene.camera;
    const float distance = glm::length(glm::vec3(camera.world_from_view[3]));
    camera.orthographic_height = 2.0F * distance * std::tan(0.5F * camera.vertical_fov);
    return scene;
}

TEST_F(AgainstReference, AgreesForOrthographicCameras) {
    // Highlights, mirror images and the skybox depend on the direction to the camera.
    for (const std::optional<float> metallic :
         {std::optional<float>(), std::optional(0.0F), std::optional(1.0F)}) {
        Scene scene = glossy_sphere(0.3F, metallic);
        scene.environment->skybox = true;
        expect_agreement(seen_in_parallel(scene), blurred_tolerance);
    }
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        expect_agreement(seen_in_parallel(test::random_scene(seed)));
    }
}

constexpr std::uint64_t few_scenes = 10;

TEST_F(AgainstReference, AgreesInRandomScenes) {
    for (std::uint64_t seed = 0; seed < few_scenes; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        expect_agreement(test::random_scene(seed));
    }
}

/// These tests are slow. RELIEF_RANDOM_SCENES sets another number of scenes. They are divided among
/// cases, which can run at the same time.
class ManyRandomScenes : public AgainstReference, public testing::WithParamInterface<int> {};

constexpr int case_count = 10;

TEST_LABELS(slow, sweep);
TEST_P(ManyRandomScenes, AgreeWithTheReference) {
    const char* asked = std::getenv("RELIEF_RANDOM_SCENES");
    const std::uint64_t count = asked == nullptr ? 300 : std::strtoull(asked, nullptr, 10);
    for (std::uint64_t seed = few_scenes + static_cast<std::uint64_t>(GetParam()); seed < count;
         seed += case_count) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        expect_agreement(test::random_scene(seed));
    }
}

INSTANTIATE_TEST_SUITE_P(Parts, ManyRandomScenes, testing::Range(0, case_count));

}  // namespace
}  // namespace relief
