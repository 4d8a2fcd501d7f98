// SPDX-License-Identifier: Apache-2.0
// The gallery of mistakes: one table with a row for each mistake, and the conditions under which it
// shows. Pure, but for reading images. Tests: tests/shade/effects/mistakes_test.cpp.
#include "relief/shade/mistakes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>
#include <variant>

#include "effects/mistake_texts.h"
#include "effects/shader_source.h"
#include "relief/mesh/material.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene_file.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

constexpr std::string_view half_vector =
    "vec3 half_world = normalized_or(light_world + surface.view_world, vec3(0.0));";
constexpr std::string_view long_half_vector = "vec3 half_world = light_world + surface.view_world;";

/// Returns the code of a mistake that is the same in several parts.
std::vector<WrongCode> in_parts(std::initializer_list<std::string_view> parts,
                                std::string_view right, std::string_view wrong) {
    std::vector<WrongCode> code;
    for (const std::string_view part : parts)
        code.push_back({part, right, wrong});
    return code;
}

/// Returns true if a mistake shows on a draw whose program or textures it changes.
using Condition = bool (*)(const Scene& scene, const DrawPlan& draw, OutputCoding output);

struct MistakeRow {
    Mistake mistake;
    const char* hidden;  ///< Why no draw has it.
    Condition shows = nullptr;
    const char* unseen = nullptr;  ///< Why it does not show on draws that have it.
};

glm::dmat3 axes_of(const Scene& scene, const DrawPlan& draw) {
    return glm::dmat3(glm::dmat4(scene.instances[draw.instance].world_from_object));
}

/// Matrices of floats are within this of the exact ones, relative to their largest element.
constexpr double rounding = 1e-6;

bool is_near(const glm::dmat3& a, const glm::dmat3& b, double size) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (!(std::abs(a[i][j] - b[i][j]) <= rounding * size)) return false;
        }
    }
    return true;
}

/// Returns true if a matrix is not a rotation or mirroring with one scale in all directions.
bool is_uneven(const Scene& scene, const DrawPlan& draw, OutputCoding) {
    const glm::dmat3 axes = axes_of(scene, draw);
    const glm::dmat3 squared = glm::transpose(axes) * axes;
    const double mean = (squared[0][0] + squared[1][1] + squared[2][2]) / 3.0;
    return !is_near(squared, glm::dmat3(mean), mean);
}

/// Returns true if a matrix is not one scale in all directions.
bool turns_normals(const Scene& scene, const DrawPlan& draw, OutputCoding) {
    const glm::dmat3 axes = axes_of(scene, draw);
    const double scale = (axes[0][0] + axes[1][1] + axes[2][2]) / 3.0;
    return !(scale > 0.0) || !is_near(axes, glm::dmat3(scale), scale);
}

bool moves(const Scene& scene, const DrawPlan& draw, OutputCoding) {
    return scene.instances[draw.instance].world_from_object != glm::mat4(1.0F);
}

/// Returns true if the frame of a corner or a triangle is left-handed in object space.
bool is_left_handed(const Mesh& mesh, std::size_t triangle) {
    const auto& corners = mesh.triangles[triangle];
    if (!mesh.tangents.empty()) {
        for (int i = 0; i < 3; ++i) {
            if (mesh.tangents[corners[i]].w < 0.0F) return true;
        }
        return false;
    }
    const glm::dvec2 a(mesh.texcoords[corners[0]]);
    const glm::dvec2 u = glm::dvec2(mesh.texcoords[corners[1]]) - a;
    const glm::dvec2 v = glm::dvec2(mesh.texcoords[corners[2]]) - a;
    return u.x * v.y - u.y * v.x > 0.0;  // v grows downwards.
}

/// Returns true if a draw has a left-handed tangent frame in world space.
bool has_left_handed_frame(const Scene& scene, const DrawPlan& draw, OutputCoding) {
    const Mesh& mesh = *scene.meshes[scene.instances[draw.instance].mesh];
    const bool is_mirrored = glm::determinant(axes_of(scene, draw)) < 0.0;
    for (std::size_t i = 0; i < draw.range.triangle_count; ++i) {
        if (is_left_handed(mesh, draw.range.first_triangle + i) != is_mirrored) return true;
    }
    return false;
}

/// Returns true if the picture has sRGB codes.
bool is_coded(const Scene&, const DrawPlan&, OutputCoding output) {
    return output == OutputCoding::srgb;
}

const std::vector<MistakeRow>& rows() {
    using enum MistakenVector;
    static const std::vector<MistakeRow> all = {
        {{"normal-matrix",
          "normals are transformed by the matrix of positions, not by its inverse transpose",
          normal,
          {{"vertex.glsl#normal", "world_from_object_normal * deformed_normal()",
            "world_from_object_tangent * deformed_normal()"},
           {"vertex.glsl#normal", "uniform mat3 world_from_object_normal;",
            "uniform mat3 world_from_object_tangent;  // world_from_object without translation"},
           {"vertex.glsl#normal_and_tangent", "world_from_object_normal * deformed_normal()",
            "world_from_object_tangent * deformed_normal()"},
           {"normal_map.glsl#object_space", "world_from_object_normal * normal_object",
            "world_from_object_tangent * normal_object"},
           {"normal_map.glsl#object_space", "uniform mat3 world_from_object_normal;",
            "uniform mat3 world_from_object_tangent;"}}},
         "no surface has normals of vertices or of an object-space map",
         is_uneven,
         "no object is scaled differently along its axes"},
        {{"object-normal",
          "normals stay in object space, while lights and eye are in world space",
          normal,
          {{"vertex.glsl#normal", "world_from_object_normal * deformed_normal()",
            "deformed_normal()"},
           {"vertex.glsl#normal_and_tangent", "world_from_object_normal * deformed_normal()",
            "deformed_normal()"},
           {"normal_map.glsl#object_space", "world_from_object_normal * normal_object",
            "normal_object"}}},
         "no surface has normals of vertices or of an object-space map",
         turns_normals,
         "no object is rotated or scaled differently along its axes"},
        {{"object-position",
          "positions stay in object space, while lights and eye are in world space",
          light,
          {{"vertex.glsl#position", "vec3(world_from_object * vec4(position_deformed, 1.0))",
            "position_deformed"}}},
         "no surface needs its position: lights and eye are infinitely far, or do not show",
         moves,
         "all objects are where their files place them"},
        {{"eye-at-origin",
          "the direction to the eye is that of camera space, where the eye is the origin, but "
          "positions are in world space",
          view,
          {{"inputs.glsl#eye", "eye_world.xyz - eye_world.w * position_world", "-position_world"}}},
         "no surface shows the direction to the eye"},
        {{"unit-normal",
          "normals are used as interpolated: between vertices, and with a map, they are not of "
          "unit length",
          mirror,
          {{"normal.glsl#interpolated", "normalized_or(normal_world, vec3(0.0, 0.0, 1.0))",
            "normal_world"},
           {"normal.glsl#perturbed",
            "normalized_or(bends ? bent_world : frame[2], vec3(0.0, 0.0, 1.0))",
            "(bends ? bent_world : frame[2])"},
           {"normal_map.glsl#object_space",
            "normalized_or(maps ? mapped_world : normal_world, vec3(0.0, 0.0, 1.0))",
            "(maps ? mapped_world : normal_world)"}}},
         "no surface interpolates normals between vertices"},
        {{"green",
          "the green channel of the normal map is read as pointing down instead of up",
          normal,
          {{"normal_map.glsl#tangent_space", "return normal_texel();",
            "return normal_texel() * vec3(1.0, -1.0, 1.0);"}}},
         "no surface shows a normal map in tangent space"},
        {{"handedness",
          "the bitangent ignores the handedness of the frame, so that mirrored texture "
          "coordinates have a wrong one",
          normal,
          {{"tangent_frame.glsl#stored",
            "vec3 bitangent_world = tangent_world.w * cross(normal_world, tangent_world.xyz);",
            "vec3 bitangent_world = cross(normal_world, tangent_world.xyz);"}}},
         "no surface shows a map by the tangents of its mesh",
         has_left_handed_frame,
         "no tangent frame is left-handed"},
        {{"normal-map-srgb",
          "the texels of the normal map are decoded like sRGB colors",
          normal,
          {{"normal_map.glsl#texel", "return normal_lookup * normal_map_scale + normal_map_bias;",
            "return decoded(normal_lookup) * normal_map_scale + normal_map_bias;"},
           {"normal_map.glsl#texel", "vec3 normal_texel()",
            "vec3 decoded(vec3 code) {\n"
            "    return mix(pow((code + 0.055) / 1.055, vec3(2.4)), code / 12.92,\n"
            "               lessThanEqual(code, vec3(0.04045)));\n"
            "}\n\n"
            "vec3 normal_texel()"}}},
         "no surface shows a normal map"},
        {{"back-faces",
          "the back faces of double-sided surfaces keep the normal of the front",
          normal,
          {{"normal.glsl#both_sides", "gl_FrontFacing ? 1.0 : -1.0", "1.0"},
           {"gouraud.glsl#lights_both_sides", "surface.normal_world = -surface.normal_world;",
            "// The normal stays that of the front."}}},
         "no double-sided surface shows the normals of its vertices"},
        {{"half-vector", "the half vector between light and eye is not of unit length", none,
          in_parts({"phong.glsl#blinn_phong", "metallic_roughness.glsl#receive",
                    "clearcoat.glsl#lights", "sheen.glsl#lights"},
                   half_vector, long_half_vector)},
         "no light has highlights that are computed by half vectors"},
        {{"reflection-sign",
          "reflect() gets the vector to the light or to the eye instead of the incident one",
          mirror,
          {{"reflection.glsl#<reflected_direction>",
            "reflect(-surface.view_world, surface.normal_world)",
            "reflect(surface.view_world, surface.normal_world)"},
           {"reflection.glsl#metallic_roughness",
            "reflect(-surface.view_world, mirror_normal(surface))",
            "reflect(surface.view_world, mirror_normal(surface))"},
           {"clearcoat.glsl#reflection", "reflect(-surface.view_world, normal)",
            "reflect(surface.view_world, normal)"},
           {"phong.glsl#phong", "reflect(-light_world, surface.normal_world)",
            "reflect(light_world, surface.normal_world)"}}},
         "no surface mirrors the environment, or has highlights of Phong's original model"},
        {{"srgb", "the codes of color textures are used as light, without decoding sRGB", none, {}},
         "no surface shows a texture of sRGB colors"},
        {{"gamma-twice",
          "the picture is coded as sRGB twice, by the shader and by the framebuffer",
          none,
          {{"output.glsl#srgb", "return code_of(shown(radiance));",
            "return code_of(code_of(shown(radiance)));"},
           {"picture.glsl#fragment", "code_of(average)", "code_of(code_of(average))"}}},
         "no surface shows light",
         is_coded,
         "the output is linear and has no sRGB codes"},
    };
    return all;
}

const MistakeRow& row_of(const Mistake& mistake) {
    return *std::find_if(rows().begin(), rows().end(),
                         [&](const MistakeRow& row) { return row.mistake.name == mistake.name; });
}

// Images.

/// The textures of colors in a material.
template <typename MaterialLike, typename Visit>
void for_each_color_texture(MaterialLike& material, const Visit& visit) {
    for (const TextureSlotInfo& slot : texture_slots) {
        if (slot.use != ImageUse::color) continue;
        if (auto* const texture = find_texture(material, slot.slot)) visit(slot, *texture);
    }
}

/// Returns true if an image is known to have no sRGB codes before it is read.
bool is_linear(const ImageSource& source) {
    if (const auto* image = std::get_if<Shared<Image>>(&source.source))
        return (**image).color_space != ColorSpace::srgb;
    const auto* const file = std::get_if<std::filesystem::path>(&source.source);
    return file != nullptr && (file->extension() == ".exr" || file->extension() == ".hdr");
}

/// Returns true if a draw samples a texture of sRGB colors.
bool shows_colors(const Scene& scene, const DrawPlan& draw) {
    if (!draw.range.material) return false;
    const std::vector<std::string> samplers = planned_interface(draw.features).samplers;
    bool shows = false;
    for_each_color_texture(scene.materials[*draw.range.material], [&](const TextureSlotInfo& slot,
                                                                      const Texture& texture) {
        const bool is_sampled = std::binary_search(samplers.begin(), samplers.end(), slot.sampler);
        shows = shows || (is_sampled && !is_linear(scene.images[texture.image]));
    });
    return shows;
}

/// The images of a scene as they are without decoding sRGB, by their index.
class UndecodedImages {
  public:
    explicit UndecodedImages(Scene& scene) : scene_(scene) {}

    std::size_t get(std::size_t image) {
        const auto [entry, is_new] = undecoded_.try_emplace(image, image);
        if (is_new) entry->second = add(image);
        return entry->second;
    }

  private:
    std::size_t add(std::size_t image) {
        const ImageSource source = scene_.images[image];
        try {
            Image codes = decode(source, ImageUse::color);
            if (codes.color_space != ColorSpace::srgb) return image;
            codes.color_space = ColorSpace::linear;
            scene_.images.push_back({source.name + " without decoding", Shared(std::move(codes))});
            return scene_.images.size() - 1;
        } catch (const Error&) {  // The renderer reports it.
            return image;
        }
    }

    Scene& scene_;
    std::map<std::size_t, std::size_t> undecoded_;
};

// Programs.

struct ProgramTexts {
    std::map<Features, std::string> surfaces;
    std::string finish;
};

ProgramTexts programs_of(const FramePlan& plan, const Scene& scene, const FrameSettings& settings,
                         const ShaderTexts& texts) {
    ProgramTexts programs;
    for (ShaderListing& listing : shader_listings(plan, texts))
        programs.surfaces[listing.features] = listing.vertex + listing.fragment;
    if (!plan.finishing_pass) return programs;
    const ShaderSteps steps = finishing_steps(
        settings.output, scene,
        settings.samples > 1 ? "picture.glsl#four_samples" : "picture.glsl#one_sample");
    programs.finish = pass_program("picture", steps, GlslVersion::core_330, texts).fragment.text;
    return programs;
}

/// Returns whether the code of a mistake is in the programs of each draw.
std::vector<bool> draws_with(const Mistake& mistake, const Scene& scene,
                             const FrameSettings& settings, const FramePlan& plan) {
    std::vector<bool> have(plan.draws.size());
    if (mistake.code.empty()) {
        for (std::size_t i = 0; i < have.size(); ++i)
            have[i] = shows_colors(scene, plan.draws[i]);
        return have;
    }
    const ShaderTexts base = settings.shaders ? *settings.shaders : ShaderTexts{};
    const ProgramTexts right = programs_of(plan, scene, settings, base);
    const ProgramTexts wrong =
        programs_of(plan, scene, settings, *with_mistake(mistake, settings.shaders));
    for (std::size_t i = 0; i < have.size(); ++i) {
        const Features& features = plan.draws[i].features;
        have[i] = right.finish != wrong.finish ||
                  right.surfaces.at(features) != wrong.surfaces.at(features);
    }
    return have;
}

// The texts of parts.

/// Replaces the one place of `right`. \return whether there is one
bool replace_once(std::string& text, std::string_view right, std::string_view wrong) {
    const std::size_t place = text.find(right);
    if (place == std::string::npos || text.find(right, place + 1) != std::string::npos)
        return false;
    text.replace(place, right.size(), wrong);
    return true;
}

/// Gives a part another text.
void set_part(ShaderTexts& texts, std::string_view address, const std::string& text) {
    std::string& file = texts.files[std::string(address.substr(0, address.find('#')))];
    file = with_shader_part(file, address, text);
}

void make_mistake(ShaderTexts& texts, const Mistake& mistake) {
    for (const WrongCode& code : mistake.code) {
        std::string text = shader_part_text(code.part, texts).text;
        if (!replace_once(text, code.right, code.wrong)) {
            throw GpuError(
                fmt::format("shader {}: the mistake '{}' replaces '{}', which this part "
                            "does not have once",
                            code.part, mistake.name, code.right));
        }
        set_part(texts, code.part, text);
    }
}

// Measured directions.

/// The first point or spot light that is on.
const PointLight* first_place_of_light(const Scene& scene) {
    for (const PointLight& light : scene.point_lights) {
        if (light.on) return &light;
    }
    for (const SpotLight& light : scene.spot_lights) {
        if (light.point.on) return &light.point;
    }
    return nullptr;
}

/// The vector as an expression of GLSL, of a `surface`.
std::string expression_of(MistakenVector vector, const Scene& scene) {
    switch (vector) {
        case MistakenVector::none:
            break;
        case MistakenVector::normal:
            return "surface.normal_world";
        case MistakenVector::mirror:
            return "reflect(-surface.view_world, surface.normal_world)";
        case MistakenVector::view:
            return "surface.view_world";
        case MistakenVector::light:
            if (const PointLight* const light = first_place_of_light(scene)) {
                const glm::vec3& p = light->position_world;
                return fmt::format("vec3({:.9g}, {:.9g}, {:.9g}) - surface.position_world", p.x,
                                   p.y, p.z);
            }
            return "surface.view_world";
    }
    return "vec3(0.0)";
}

}  // namespace

ShaderTexts detail::measuring_texts(const Mistake& mistake, const Scene& scene,
                                    const std::shared_ptr<const ShaderTexts>& base,
                                    bool has_mistake) {
    ShaderTexts texts = base ? *base : ShaderTexts{};
    std::string vector = expression_of(mistake.vector, scene);
    if (has_mistake) {
        make_mistake(texts, mistake);
        for (const WrongCode& code : mistake.code)
            (void)replace_once(vector, code.right, code.wrong);
    }
    set_part(texts, "view.glsl#normal",
             fmt::format("//@part normal implements view\n"
                         "//@include \"surface.glsl#view\"\n\n"
                         "vec3 vector_of(Surface surface) {{ return {}; }}\n\n"
                         "vec3 view_color() {{ return vector_of(surface_here()); }}\n",
                         vector));
    set_part(texts, "view.glsl#hatched",
             "//@part hatched implements view\n\nvec3 view_color() { return vec3(0.0); }\n");
    // Views of normals have no positions of their own.
    std::string position = shader_part_text("vertex.glsl#position", texts).text;
    position.replace(0, position.find('\n'), "//@neutral pass_position");
    set_part(texts, "vertex.glsl#<pass_position>", position);
    set_part(texts, "inputs.glsl#<position>", "//@neutral position\n\nin vec3 position_world;\n");
    return texts;
}

const std::vector<Mistake>& mistakes() {
    static const std::vector<Mistake> all = [] {
        std::vector<Mistake> list;
        for (const MistakeRow& row : rows())
            list.push_back(row.mistake);
        return list;
    }();
    return all;
}

const Mistake* find_mistake(std::string_view name) {
    const auto found = std::find_if(mistakes().begin(), mistakes().end(),
                                    [&](const Mistake& each) { return each.name == name; });
    return found == mistakes().end() ? nullptr : &*found;
}

MistakeReach reach_of(const Mistake& mistake, const Scene& scene, const FrameSettings& settings) {
    const MistakeRow& row = row_of(mistake);
    const FramePlan plan = plan_effects(scene, settings);
    const std::vector<bool> have = draws_with(mistake, scene, settings, plan);
    MistakeReach reach;
    reach.total = plan.draws.size();
    bool is_anywhere = false;
    for (std::size_t i = 0; i < have.size(); ++i) {
        if (!have[i]) continue;
        is_anywhere = true;
        if (row.shows == nullptr || row.shows(scene, plan.draws[i], settings.output)) ++reach.draws;
    }
    if (reach.draws == 0) reach.hidden = is_anywhere ? row.unseen : row.hidden;
    return reach;
}

std::shared_ptr<const ShaderTexts> with_mistake(const Mistake& mistake,
                                                const std::shared_ptr<const ShaderTexts>& texts) {
    if (mistake.code.empty()) return texts;
    ShaderTexts wrong = texts ? *texts : ShaderTexts{};
    make_mistake(wrong, mistake);
    return std::make_shared<const ShaderTexts>(std::move(wrong));
}

Scene with_mistake(const Mistake& mistake, const Scene& scene) {
    Scene result = scene;
    if (!mistake.code.empty()) return result;
    UndecodedImages undecoded(result);
    for (Material& material : result.materials) {
        for_each_color_texture(material, [&](const TextureSlotInfo&, Texture& texture) {
            texture.image = undecoded.get(texture.image);
        });
    }
    return result;
}

std::string_view measured_name(const Mistake& mistake, const Scene& scene) {
    switch (mistake.vector) {
        case MistakenVector::none:
            break;
        case MistakenVector::normal:
            return "normal";
        case MistakenVector::mirror:
            return "mirror direction";
        case MistakenVector::view:
            return "direction to the eye";
        case MistakenVector::light:
            return first_place_of_light(scene) != nullptr ? "direction to the light"
                                                          : "direction to the eye";
    }
    return "";
}

}  // namespace relief::shade
