// SPDX-License-Identifier: Apache-2.0
#include "option_conflicts.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <variant>

#include "common/text.h"
#include "environment_options.h"
#include "page_command.h"
#include "picture_sheet.h"
#include "picture_sink.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using Options = ViewOptions;

/// An option that is refused if a condition applies.
struct Conflict {
    const char* option;
    bool (*applies)(const Options&);
    const char* reason;
    const char* remedy;
};

constexpr const char* drop_one = "leave one of them out";
constexpr const char* drop_it = "leave it out";
constexpr const char* add_environment = "give one, or leave it out";
constexpr const char* only_pictures = "applies to pictures, not to pages";
constexpr const char* no_environment = "there is no --environment";
constexpr const char* add_height_map = "add --height-map, or leave it out";
constexpr const char* add_normal_map = "add --normal-map, or leave it out";

bool is_gltf(const Options& o) {
    return extension_of(o.model) == ".gltf" || extension_of(o.model) == ".glb";
}
bool has_video(const Options& o) {
    return o.output && is_video(*o.output);
}
bool has_animation(const Options& o) {
    return o.output && is_animation(*o.output);
}
bool has_overlays(const Options& o) {
    return o.debug.wireframe || o.debug.vertex_frames || o.debug.grid || o.debug.health_markers;
}
bool uses_bump_map(const Options& o) {
    return o.height_as == HeightUse::bump_map;
}
/// Returns the method of relief mapping; none if it is that of a scene file.
std::optional<HeightMethod> relief_method(const Options& o) {
    const auto given = o.relief_fields.get(&ReliefMap::method);
    if (given || is_scene_file(o)) return given;
    return HeightMethod::maximum_mipmaps;
}
template <auto Member, HeightMethod... Methods>
bool ignores_setting(const Options& o) {
    const auto method = relief_method(o);
    return o.relief_fields.has(Member) && method && ((*method == Methods) || ...);
}
bool shades_each_pixel(const Options& o) {
    return o.material_fields.get(&Material::interpolation).value_or(Interpolation::per_pixel) ==
           Interpolation::per_pixel;
}
bool chooses_fresnel(const Options& o) {
    return o.no_fresnel || o.material_fields.has(&Material::fresnel);
}
bool hides_skybox(const Options& o) {
    return o.environment_fields.has(&Environment::skybox);
}
/// A scene file may have its own environment, which is not known yet.
bool lacks_environment(const Options& o) {
    return uses_no_environment(o) || (o.environment.empty() && !is_scene_file(o));
}
bool lacks_images(const Options& o) {
    return uses_no_environment(o) || o.environment.empty();
}
bool has_one_image(const Options& o) {
    return !uses_no_environment(o) && o.environment.size() == 1 &&
           !std::filesystem::is_directory(o.environment.front());
}
bool has_mistakes(const Options& o) {
    return !o.mistakes.empty();
}
bool has_forced_effects(const Options& o) {
    return o.effects.requests.base != EffectBase::planned || !o.effects.requests.forced.empty();
}
template <auto Member>
bool changes_material(const Options& o) {
    return o.material_fields.has(Member);
}
template <auto Member>
bool needs_environment(const Options& o) {
    return o.material_fields.has(Member) && lacks_environment(o);
}
template <auto Member>
bool describes_environment(const Options& o) {
    return o.environment_fields.has(Member) && lacks_environment(o);
}
template <auto Member>
bool grades_colors(const Options& o) {
    return o.scene_fields.has(Member) && is_linear_output(o);
}

const Conflict conflicts[] = {
    // The window and the output.
    {"--dump-state", [](const Options& o) { return o.dump_state && !o.wants_window(); },
     "no window is opened", "leave --output out"},
    {"--backend",
     [](const Options& o) { return o.wants_window() && o.backend != Backend::automatic; },
     "applies to pictures; the window uses the OpenGL of its display",
     "add --output, or leave it out"},
    {"--ui-scale", [](const Options& o) { return o.ui_scale && !o.wants_window(); },
     "no window is opened", drop_it},
    {"--no-state", [](const Options& o) { return o.no_state && !o.wants_window(); },
     "no window is opened", drop_it},
    {"--json", [](const Options& o) { return o.wants_window() && o.json; },
     "the window prints no summary", "add --output"},
    {"--strict", [](const Options& o) { return o.wants_window() && o.strict; },
     "the window shows the findings and has no exit code for them", "add --output"},
    {"--exposure", grades_colors<&Scene::exposure>,
     "applies to display colors, not to linear radiance", "write a .png, or leave it out"},
    {"--tone-mapping", grades_colors<&Scene::tone_mapping>,
     "applies to display colors, not to linear radiance", "write a .png, or leave it out"},
    // Sequences.
    {"--turntable", [](const Options& o) { return o.turntable && o.frames; },
     "contradicts --frames", drop_one},
    {"--seconds", [](const Options& o) { return o.seconds && !o.frames; }, "needs --frames",
     "add --frames, or leave it out"},
    {"--fps", [](const Options& o) { return o.frames_per_second && !has_animation(o); },
     "applies to animations and videos", "write an .apng, .mp4 or .webm, or leave it out"},
    {"--background",
     [](const Options& o) {
         return has_video(o) &&
                o.scene_fields.get(&Scene::background).value_or(glm::vec4(1.0F)).a < 1.0F;
     },
     "a video has no transparent pixels", "choose a color, or write an .apng"},
    {"--size",
     [](const Options& o) {
         return has_video(o) && o.size_given && (o.size.x % 2 != 0 || o.size.y % 2 != 0);
     },
     "the width and the height of a video must be even", ""},
    {"--time", [](const Options& o) { return o.time && o.frames; },
     "contradicts --frames, which sets the times", drop_one},
    {"--reference", [](const Options& o) { return is_sequence(o) && o.reference; },
     "applies to one picture, not to a sequence", drop_one},
    {"--turntable", [](const Options& o) { return o.turntable && !o.output; },
     "there is no --output", "add one"},
    {"--frames", [](const Options& o) { return o.frames && !o.output; }, "there is no --output",
     "add one"},
    // Comparisons.
    {"--split", [](const Options& o) { return o.compare.split && !o.compare.compares(); },
     "needs --compare or --compare-to", "add one of them, or leave it out"},
    {"--compare", [](const Options& o) { return o.compare.variant && o.compare.file; },
     "contradicts --compare-to", drop_one},
    // Steps and exercises.
    {"--steps", [](const Options& o) { return o.steps && !o.output; }, "there is no --output",
     "add one; the window has a slider for steps"},
    {"--steps", [](const Options& o) { return o.steps && is_sequence(o); },
     "applies to one picture, not to a sequence", drop_one},
    {"--steps", [](const Options& o) { return o.steps && (o.compare.compares() || o.reference); },
     "draws several pictures, which are not compared with others", drop_one},
    {"--steps",
     [](const Options& o) {
         return o.steps && (o.effects.measures() || has_forced_effects(o) || o.explain_effects ||
                            o.debug.view != DebugView::picture);
     },
     "chooses the effects of its pictures itself",
     "leave out --effects, --explain-effects, --benchmark, --budget and --show"},
    {"--exercise", [](const Options& o) { return o.exercise && is_sequence(o); },
     "applies to one picture, not to a sequence", drop_one},
    {"--exercise",
     [](const Options& o) {
         return o.exercise && (o.compare.compares() || o.reference || o.steps);
     },
     "compares with the solution", "leave out --compare, --reference and --steps"},
    {"--exercise", [](const Options& o) { return o.exercise && !o.output && !o.wants_window(); },
     "there is no --output", "add one"},
    // Mistakes.
    {"--mistake", [](const Options& o) { return has_mistakes(o) && is_sequence(o); },
     "applies to one picture, not to a sequence", "leave --turntable or --frames out"},
    {"--mistake",
     [](const Options& o) {
         return has_mistakes(o) && (o.compare.compares() || o.reference || o.steps || o.exercise);
     },
     "compares with the picture without the mistake",
     "leave out --compare, --reference, --steps and --exercise"},
    {"--mistake",
     [](const Options& o) {
         return has_mistakes(o) && (o.effects.measures() || has_forced_effects(o) ||
                                    o.explain_effects || o.debug.view != DebugView::picture);
     },
     "draws the picture with the effects of the scene",
     "leave out --effects, --explain-effects, --benchmark, --budget and --show"},
    {"--mistake", [](const Options& o) { return has_mistakes(o) && o.effects.print_shaders; },
     "contradicts --print-shaders, which prints the right ones", drop_one},
    {"--mistake", [](const Options& o) { return has_mistakes(o) && o.probe; },
     "contradicts --probe, which explains the right picture", drop_one},
    {"--mistake",
     [](const Options& o) {
         return o.mistakes.size() > 1 && is_linear_output(o) && !has_numbers(*o.output);
     },
     "the sheet of several mistakes has display colors", "write a .png, or put a # into the name"},
    // The probe.
    {"--probe", [](const Options& o) { return o.probe && is_sequence(o); },
     "applies to one picture, not to a sequence", "leave --turntable or --frames out"},
    {"--probe", [](const Options& o) { return o.probe && has_overlays(o); },
     "explains surfaces, and lines and markers are drawn over them", "leave them out"},
    {"--probe", [](const Options& o) { return o.probe && o.compare.compares(); },
     "explains one picture, not a comparison", drop_one},
    // Pages.
    {"--page-views", [](const Options& o) { return !is_page(o) && !o.page_views.empty(); },
     "there is no page", "add --output page.html"},
    {"--page-quantize", [](const Options& o) { return !is_page(o) && o.page_quantize; },
     "there is no page", "add --output page.html"},
    {"--page-probes", [](const Options& o) { return !is_page(o) && o.page_probes.x > 0; },
     "there is no page", "add --output page.html"},
    {"--page-probes", [](const Options& o) { return o.page_probes.x > 0 && o.compare.compares(); },
     "explains one picture, not a comparison", drop_one},
    {"--page-probes",
     [](const Options& o) { return o.page_probes.x > 0 && o.debug.view != DebugView::picture; },
     "explains the picture", "use --page-views for other views"},
    {"--turntable", [](const Options& o) { return is_page(o) && o.turntable; }, only_pictures,
     "leave it out: pages are orbited"},
    {"--frames", [](const Options& o) { return is_page(o) && o.frames; }, only_pictures,
     "leave it out: pages play animations"},
    {"--reference", [](const Options& o) { return is_page(o) && o.reference; }, only_pictures,
     drop_it},
    {"--difference-map", [](const Options& o) { return is_page(o) && o.difference_map; },
     only_pictures, drop_it},
    {"--benchmark", [](const Options& o) { return is_page(o) && o.effects.benchmark; },
     only_pictures, drop_it},
    {"--budget", [](const Options& o) { return is_page(o) && o.effects.budget; }, only_pictures,
     drop_it},
    {"--mistake", [](const Options& o) { return is_page(o) && has_mistakes(o); }, only_pictures,
     drop_it},
    {"--exercise", [](const Options& o) { return is_page(o) && o.exercise; },
     "compares a picture with the solution, and a page is none", "write a picture"},
    // The model.
    {"--up", [](const Options& o) { return o.up && is_scene_file(o); },
     "applies to model files, not to scene files", "rotate the nodes of the scene"},
    {"--normals", [](const Options& o) { return o.normals && is_scene_file(o); },
     "applies to model files, not to scene files", "set 'normals' beside 'model' in the scene"},
    {"--crease", [](const Options& o) { return o.crease_degrees && is_scene_file(o); },
     "applies to model files, not to scene files", "set 'crease' beside 'model' in the scene"},
    {"--crease", [](const Options& o) { return o.crease_degrees && o.normals == NormalMode::flat; },
     "contradicts --normals flat, which makes all edges hard", drop_one},
    {"--material-variant", [](const Options& o) { return o.material_variant && !is_gltf(o); },
     "only glTF files have material variants", drop_it},
    {"--model-camera", [](const Options& o) { return o.model_camera && !is_gltf(o); },
     "only glTF files have cameras", "use --camera"},
    {"--model-camera", [](const Options& o) { return o.model_camera && o.camera; },
     "contradicts --camera", drop_one},
    // Maps.
    {"--height-map", [](const Options& o) { return o.normal_map && o.height_map; },
     "contradicts --normal-map, because both set the normals", drop_one},
    {"--green", [](const Options& o) { return o.green && !o.normal_map; }, "needs --normal-map",
     add_normal_map},
    {"--normal-space", [](const Options& o) { return o.normal_space && !o.normal_map; },
     "needs --normal-map", add_normal_map},
    {"--strength", [](const Options& o) { return o.strength && !o.height_map; },
     "needs --height-map", add_height_map},
    {"--kernel", [](const Options& o) { return o.kernel && !o.height_map; }, "needs --height-map",
     add_height_map},
    {"--height-as", [](const Options& o) { return o.height_as && !o.height_map; },
     "needs --height-map", add_height_map},
    {"--height-layers",
     ignores_setting<&ReliefMap::layers, HeightMethod::parallax, HeightMethod::maximum_mipmaps>,
     "applies to layers and cones", "choose another --height-method, or leave it out"},
    {"--height-bisections",
     ignores_setting<&ReliefMap::bisections, HeightMethod::parallax,
                     HeightMethod::parallax_occlusion, HeightMethod::maximum_mipmaps>,
     "applies to relief mapping and cones", "choose another --height-method, or leave it out"},
    {"--height-steps",
     [](const Options& o) {
         return !o.relief_fields.get(&ReliefMap::self_shadow).value_or(false) &&
                ignores_setting<&ReliefMap::max_steps, HeightMethod::parallax,
                                HeightMethod::parallax_occlusion, HeightMethod::relief_mapping,
                                HeightMethod::relaxed_cones>(o);
     },
     "applies to maximum mipmaps", "choose another --height-method, or leave it out"},
    {"--height-bound",
     [](const Options& o) {
         return o.relief_fields.has(&ReliefMap::bound) && (is_page(o) || is_sequence(o));
     },
     "applies to single pictures: others have all reliefs", drop_it},
    {"--cone-map",
     [](const Options& o) {
         const auto method = relief_method(o);
         return o.cone_map && method && *method != HeightMethod::relaxed_cones;
     },
     "applies to relaxed cones", "add --height-method relaxed_cones, or leave it out"},
    {"--kernel", [](const Options& o) { return uses_bump_map(o) && o.kernel; },
     "applies to converted height maps, not to bump maps", drop_it},
    {"--normal-scale", [](const Options& o) { return uses_bump_map(o) && o.normal_scale; },
     "applies to normal maps, not to bump maps", "use --strength"},
    {"--normal-map", [](const Options& o) { return o.normal_map && !shades_each_pixel(o); },
     "does not show with --interpolation gouraud or flat, which do not shade each pixel", drop_one},
    {"--height-map",
     [](const Options& o) {
         return o.height_map && o.relief_fields.empty() && !shades_each_pixel(o);
     },
     "does not show with --interpolation gouraud or flat, which do not shade each pixel", drop_one},
    {"--tangent-frame",
     [](const Options& o) {
         return changes_material<&Material::tangent_frame>(o) &&
                o.normal_space == NormalSpace::object;
     },
     "object-space normal maps need no tangent frame", drop_it},
    {"--metallic-roughness", [](const Options& o) { return o.metallic_roughness && o.material; },
     "contradicts --material", drop_one},
    // The environment and what reflects it.
    {"--no-skybox", [](const Options& o) { return hides_skybox(o) && lacks_environment(o); },
     no_environment, ""},
    {"--reflectivity", needs_environment<&Material::reflectivity>, no_environment, add_environment},
    {"--reflection-roughness", needs_environment<&Material::reflection_roughness>, no_environment,
     add_environment},
    {"--fresnel", [](const Options& o) { return chooses_fresnel(o) && lacks_environment(o); },
     no_environment, add_environment},
    {"--transmission", needs_environment<&Material::transmission>, no_environment, add_environment},
    {"--environment-tint", needs_environment<&Material::environment_tint>, no_environment,
     add_environment},
    {"--environment-light", describes_environment<&Environment::lights>, no_environment,
     add_environment},
    {"--environment-intensity", describes_environment<&Environment::intensity>, no_environment,
     add_environment},
    {"--environment-rotation", describes_environment<&Environment::rotation>, no_environment,
     add_environment},
    {"--background-blur", describes_environment<&Environment::skybox_blur>, no_environment,
     add_environment},
    {"--environment-layout",
     [](const Options& o) { return o.environment_layout && lacks_images(o); }, no_environment,
     add_environment},
    {"--left-handed", [](const Options& o) { return o.left_handed_environment && lacks_images(o); },
     no_environment, add_environment},
    {"--refractive-index",
     [](const Options& o) {
         return changes_material<&Material::refractive_index>(o) &&
                o.material_fields.get(&Material::fresnel) != FresnelModel::dielectric &&
                !changes_material<&Material::transmission>(o);
     },
     "neither --fresnel dielectric nor --transmission uses it",
     "give one of them, or leave it out"},
    {"--environment-layout",
     [](const Options& o) { return o.environment_layout && (!has_one_image(o) || uses_studio(o)); },
     "applies to one image, not to six or to the studio", drop_it},
    {"--no-skybox", [](const Options& o) { return hides_skybox(o) && uses_studio(o); },
     "the studio is not visible behind the model", drop_it},
    {"--background-blur",
     [](const Options& o) {
         return o.environment_fields.has(&Environment::skybox_blur) &&
                (hides_skybox(o) || uses_studio(o));
     },
     "the environment is not visible behind the model", drop_it},
    {"--left-handed",
     [](const Options& o) { return o.left_handed_environment && has_one_image(o); },
     "applies to six images", drop_it},
    {"--background",
     [](const Options& o) {
         return o.scene_fields.has(&Scene::background) && !lacks_images(o) && !hides_skybox(o) &&
                !uses_studio(o);
     },
     "the environment hides it", "add --no-skybox, or leave one of them out"},
    {"--light none",
     [](const Options& o) {
         return o.lights.size() > 1 &&
                std::any_of(o.lights.begin(), o.lights.end(), [](const LightOption& light) {
                    return std::holds_alternative<NoLight>(light);
                });
     },
     "contradicts the other lights", ""},
    // Debug views.
    {"--frame-length",
     [](const Options& o) { return o.debug.frame_length && !o.debug.vertex_frames; },
     "needs --vertex-frames", "add --vertex-frames, or leave it out"},
    {"--show",
     [](const Options& o) { return o.debug.view != DebugView::picture && o.explain_effects; },
     "contradicts --explain-effects, which needs all effects", drop_one},
    {"--show",
     [](const Options& o) {
         return o.debug.view != DebugView::picture && o.effects.budget.has_value();
     },
     "contradicts --budget, which drops effects of the picture", drop_one},
};

}  // namespace

void check_conflicts(const ViewOptions& options) {
    for (const Conflict& row : conflicts) {
        if (row.applies(options))
            throw UsageError(std::string(row.option) + ": " + row.reason, row.remedy);
    }
}

}  // namespace relief::tools
