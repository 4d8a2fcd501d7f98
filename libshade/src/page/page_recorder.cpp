// SPDX-License-Identifier: Apache-2.0
// Records what drawing has prepared: it binds each draw as drawing does, and asks OpenGL what is
// bound. Programs are assembled again as GLSL ES. Prepared scenes stay alive while a page is
// recorded, because the names of OpenGL tell which textures and buffers are the same. Tests:
// tests/tools/view_page/view_page_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "effects/shader_source.h"
#include "gl/resources.h"
#include "page/page_content.h"
#include "relief/shade/page.h"
#include "render/renderer_parts.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

/// The uniforms whose values depend on the camera, on an instance or on the time.
constexpr std::array<std::string_view, 17> moving_values = {"clip_from_object",
                                                            "clip_from_world",
                                                            "eye_world",
                                                            "world_from_object",
                                                            "world_from_object_normal",
                                                            "world_from_object_tangent",
                                                            "handedness",
                                                            "object_scale",
                                                            "joint_pairs",
                                                            "morph_layout",
                                                            "shadow_from_object",
                                                            "shadow_from_world",
                                                            "shadow_lift",
                                                            "shadow_shift",
                                                            "shadow_samples",
                                                            "shadow_points",
                                                            "world_from_screen"};

/// The samplers whose textures the page makes itself.
constexpr std::array<std::string_view, 5> drawn_textures = {"behind", "drawn", "shadow_maps",
                                                            "joint_matrices", "morph_weights"};

constexpr int guaranteed_textures = 16;
constexpr int guaranteed_texture_size = 2048;
/// Texels of a texture of rows, which is 2048 wide and at most as high.
constexpr int max_row_texels = guaranteed_texture_size * guaranteed_texture_size;

/// Writes what the picture shows of a sample, to be averaged, in place of its code.
bool averages_shown(const FramePlan& plan, const FrameSettings& settings) {
    return settings.samples > 1 && !plan.sorted_blending && !plan.transmission_background &&
           !is_data(settings.view);
}

void replace_output(ShaderSteps& steps) {
    const auto output = steps.find("output");
    if (output != steps.end() && output->second == "output.glsl#srgb")
        output->second = "output.glsl#shown";
}

/// The texts that replace parts of the shaders of a scene.
ShaderTexts texts_of(const PreparedScene& renderer) {
    return renderer.shaders ? *renderer.shaders : ShaderTexts();
}

SurfaceProgram surface_page_program(const PreparedScene& of, const Features& features,
                                    bool shows_samples) {
    return surface_program_with(features, GlslVersion::es_300,
                                shows_samples ? replace_output : nullptr, texts_of(of));
}

SurfaceProgram screen_program(const PreparedScene& of, std::string_view name,
                              const ShaderSteps& steps) {
    return pass_program(name, steps, GlslVersion::es_300, texts_of(of));
}

std::vector<float> floats_of(const glm::vec4& v) {
    return {v.x, v.y, v.z, v.w};
}

/// Returns the plan with all deformations of meshes that move in time.
FramePlan with_deformations(const SceneGraph& graph, FramePlan plan) {
    if (!(duration(graph) > 0.0)) return plan;
    Scene moved = graph.scene;
    for (const DeformedInstance& deformed : graph.deformed) {
        std::optional<MeshPose>& pose = moved.instances.at(deformed.instance).pose;
        if (!pose) continue;
        pose->weights.assign(pose->deformation->targets.size(), 1.0F);
        for (glm::mat4& matrix : pose->joint_matrices)
            matrix = glm::mat4(2.0F);
    }
    plan_pose(moved, plan);
    return plan;
}

/// Reports textures that devices with no more than WebGL 2's guarantee cannot hold.
void report_large_textures(const PageDescription& page, Report& report) {
    for (std::size_t i = 0; i < page.textures.size(); ++i) {
        const PageTexture& texture = page.textures[i];
        if (texture.kind == PageTexture::Kind::rows ||
            std::max(texture.width, texture.height) <= guaranteed_texture_size)
            continue;
        report.add("texture larger than the 2048 texels that WebGL 2 guarantees", "texture", i,
                   "devices that cannot hold it show a smaller level");
    }
}

/// Adds the edges of triangles after the grid.
void add_wireframe(PagePicture& picture) {
    PageOverlay wireframe;
    wireframe.kind = PageOverlay::Kind::wireframe;
    wireframe.color_srgb = wireframe_color;
    const auto after_grid =
        std::find_if(picture.overlays.begin(), picture.overlays.end(),
                     [](const PageOverlay& each) { return each.kind != PageOverlay::Kind::grid; });
    picture.overlays.insert(after_grid, wireframe);
}

}  // namespace

struct PageRecorder::Implementation {
    explicit Implementation(const Context& context_of_page)
        : context(context_of_page), cache(context), content(context.api()) {}

    void name_images(const Scene& scene, const PreparedScene& renderer);
    PageDraw record(const PreparedScene& renderer, const Draw& draw, bool shows_samples);
    void add_lookups(const gl::LinkedProgram& program, PageSurface& surface, PageDraw& draw);
    std::optional<PageScreenPass> skybox(const Scene& scene, const PreparedScene& of,
                                         OutputCoding coding, bool shows_samples);
    PageScreenPass finishing(const Scene& scene, const PreparedScene& of,
                             const FrameSettings& settings, bool shows_samples);

    void record_overlays(const PreparedScene& of, PagePicture& picture);

    const Context& context;
    RenderCache cache;
    PageContent content;
    std::vector<std::unique_ptr<PreparedScene>> renderers;
};

void PageRecorder::Implementation::name_images(const Scene& scene, const PreparedScene& renderer) {
    for (const Draw& draw : renderer.draws) {
        const Planned p = planned(scene, renderer.plan.draws[draw.planned]);
        for (const UsedTexture& used : used_textures(p.features, p.material, p.mesh)) {
            if (used.texture == nullptr) continue;
            content.name_image(
                renderer.textures.image(used.texture->image, purpose_of(used)).texture.name(),
                scene.images[used.texture->image]);
        }
    }
}

/// Adds the textures that a program samples: those of the material, and those by vertex.
void PageRecorder::Implementation::add_lookups(const gl::LinkedProgram& program,
                                               PageSurface& surface, PageDraw& draw) {
    const gl::Api& gl = context.api();
    for (const gl::ActiveVariable& sampler : program.interface().samplers) {
        const auto& made = drawn_textures;
        if (std::find(made.begin(), made.end(), sampler.name) != made.end()) continue;
        GLint unit = 0;
        gl->GetUniformiv(program.name(), sampler.location, &unit);
        if (sampler.type != GL_SAMPLER_BUFFER) {
            const PageLookup lookup = content.lookup(unit, sampler.type);
            if (sampler.name == "height_texture")
                content.description.textures[lookup.texture].has_maxima = true;
            surface.textures.emplace(sampler.name, lookup);
        } else if (sampler.name != "light_buffer") {
            const std::size_t texture = content.rows(unit, sampler.name == "hidden_shares" ? 1 : 4);
            if (content.description.textures[texture].width > max_row_texels) {
                throw InvalidInput(
                    fmt::format("{} has {} texels, but a texture of WebGL 2 holds {}", sampler.name,
                                content.description.textures[texture].width, max_row_texels));
            }
            draw.rows.emplace(sampler.name, texture);
        }
    }
}

PageDraw PageRecorder::Implementation::record(const PreparedScene& renderer, const Draw& draw,
                                              bool shows_samples) {
    const Features& f = draw.features;
    check_texture_units(draw.program->planned, guaranteed_textures, "WebGL 2");
    PageDraw result;
    result.pass = is_blended(draw)    ? PagePass::blended
                  : is_covering(draw) ? PagePass::covering
                                      : PagePass::transmissive;
    result.program =
        content.program(surface_page_program(renderer, f, shows_samples), texts_of(renderer));
    if (renderer.plan.shadow_maps && draw.surface->casts_shadow) {
        result.shadow_program = content.program(
            surface_page_program(renderer, casting_features(f), false), texts_of(renderer));
    }
    result.instance = draw.instance;
    result.first_triangle = draw.range.first_triangle;
    result.triangle_count = draw.range.triangle_count;
    result.both_sides = draw.surface->both_sides;
    result.lights = {f.directional_lights, f.point_lights, f.spot_lights, f.highlight_colors};

    renderer.use_program(*draw.program, draw, glm::dmat4(1.0), std::nullopt);
    renderer.bind_textures(draw);
    renderer.environment->bind(renderer.api);
    const gl::LinkedProgram& linked = draw.program->linked;
    PageSurface surface;
    surface.values = content.values(linked, moving_values);
    if (f.displaced_shadow) {
        // The march from the light has settings that another method of the view lacks.
        const auto casting = renderer.linked.get(casting_features(f));
        renderer.use_program(*casting, draw, glm::dmat4(1.0), std::nullopt);
        surface.values.merge(content.values(casting->linked, moving_values));
        draw.program->linked.use();
    }
    // The page multiplies it by the last level of its own size.
    if (const auto level = surface.values.find("blurred_level"); level != surface.values.end())
        level->second.front() /= static_cast<float>(std::max(renderer.picture.last_level(), 1));
    add_lookups(linked, surface, result);
    result.surface = content.surface(std::move(surface));
    renderer.meshes.at(draw.mesh)->bind(renderer.api);
    result.mesh = content.mesh(linked);
    if (const auto pose = renderer.poses.find(draw.instance); pose != renderer.poses.end()) {
        const glm::ivec3 layout = pose->second.morph_layout();
        result.joint_pairs = pose->second.joint_pairs();
        result.morph_texels = {layout.y, layout.z};
    }
    return result;
}

std::optional<PageScreenPass> PageRecorder::Implementation::skybox(const Scene& scene,
                                                                   const PreparedScene& of,
                                                                   OutputCoding coding,
                                                                   bool shows_samples) {
    if (!of.skybox) return std::nullopt;
    ShaderSteps steps = skybox_steps(coding, scene);
    const auto linked = of.linked.get("skybox", steps);
    if (shows_samples) replace_output(steps);
    PageScreenPass pass;
    pass.program = content.program(screen_program(of, "skybox", steps), texts_of(of));
    const glm::vec2 turn =
        scene.environment ? environment_turn(*scene.environment) : glm::vec2(1.0F, 0.0F);
    pass.surface.values = {
        {"environment_intensity", {scene.environment ? scene.environment->intensity : 0.0F}},
        {"environment_turn", {turn.x, turn.y}},
        {"exposure", {scene.exposure}},
        {"skybox_blur", {scene.environment ? scene.environment->skybox_blur : 0.0F}},
        {"blurred_levels", {of.environment->blurred_levels()}}};
    linked->use();
    of.environment->bind(of.api);
    PageDraw unused;
    add_lookups(*linked, pass.surface, unused);
    return pass;
}

PageScreenPass PageRecorder::Implementation::finishing(const Scene& scene, const PreparedScene& of,
                                                       const FrameSettings& settings,
                                                       bool shows_samples) {
    ShaderSteps steps = output_steps(settings.output, scene);
    if (shows_samples) steps = {{"output", "output.glsl#codes"}};
    choose_part(steps, "picture.glsl#one_sample");
    PageScreenPass pass;
    pass.program = content.program(screen_program(of, "picture", steps), texts_of(of));
    const glm::vec4 background = shown_background(scene.background, settings.output);
    pass.surface.values = {
        {"background", floats_of({glm::vec3(background) * background.a, background.a})},
        {"exposure", {scene.exposure}}};
    return pass;
}

void PageRecorder::Implementation::record_overlays(const PreparedScene& of, PagePicture& picture) {
    if (!of.overlays) return;
    const auto program = [&](const ShaderSteps& steps) {
        return content.program(screen_program(of, "overlay", steps), texts_of(of));
    };
    for (std::size_t i = 0; i < of.draws.size(); ++i) {
        const Features& f = of.draws[i].features;
        picture.draws[i].overlay_program =
            program(overlay_steps("overlay.glsl#one_color", f.morphing, f.skinning));
        picture.draws[i].hides_overlays = f.alpha == AlphaMode::opaque;
    }
    for (const OverlayLines& lines : of.overlays->lines()) {
        ShaderSteps steps = overlay_steps(
            lines.instance ? "overlay.glsl#vertex_color" : "overlay.glsl#one_color", false, false);
        if (lines.instance) choose_part(steps, "overlay.glsl#disc");
        PageOverlay overlay;
        overlay.kind = lines.instance     ? PageOverlay::Kind::markers
                       : lines.are_frames ? PageOverlay::Kind::frames
                                          : PageOverlay::Kind::grid;
        overlay.program = program(steps);
        of.api->BindVertexArray(lines.vertices->name());
        overlay.mesh = content.mesh(*of.linked.get("overlay", steps));
        of.api->BindVertexArray(0);
        overlay.count = static_cast<std::size_t>(lines.count);
        overlay.color_srgb = lines.color_srgb;
        overlay.origin = lines.origin;
        overlay.instance = lines.instance;
        picture.overlays.push_back(overlay);
    }
}

PageRecorder::PageRecorder(const Context& context)
    : implementation_(std::make_unique<Implementation>(context)) {}

PageRecorder::~PageRecorder() = default;

void PageRecorder::add(const SceneGraph& graph, const FramePlan& plan,
                       const FrameSettings& settings, Report& report) {
    Implementation& self = *implementation_;
    const Scene& scene = graph.scene;
    FrameSettings single = settings;
    single.samples = 1;
    self.renderers.push_back(std::make_unique<PreparedScene>(
        self.context, scene, checked_plan(scene, with_deformations(graph, plan), single, report),
        single, &self.cache, report));
    PreparedScene& renderer = *self.renderers.back();
    const bool shows_samples = averages_shown(renderer.plan, settings);
    self.name_images(scene, renderer);
    PagePicture picture;
    picture.samples = is_data(settings.view) ? 1 : settings.samples;
    picture.has_shadow_maps = renderer.plan.shadow_maps && renderer.shadow;
    picture.copies_behind = renderer.plan.transmission_background;
    picture.counts_fragments = renderer.counts_fragments;
    const bool finishes = renderer.plan.finishing_pass || shows_samples;
    picture.skybox = self.skybox(scene, renderer,
                                 drawn_coding(single, renderer.plan.finishing_pass), shows_samples);
    if (finishes) picture.finishing = self.finishing(scene, renderer, settings, shows_samples);
    if (!finishes) picture.clear_color = clear_color(scene.background, settings.output);
    for (const Draw& draw : renderer.draws)
        picture.draws.push_back(self.record(renderer, draw, shows_samples));
    self.record_overlays(renderer, picture);
    if (settings.overlays.wireframe) add_wireframe(picture);
    renderer.api.check("recording a page");
    if (self.content.description.pictures.empty())
        report_large_textures(self.content.description, report);
    self.content.description.pictures.push_back(std::move(picture));
}

const PageDescription& PageRecorder::description() const {
    return implementation_->content.description;
}

}  // namespace relief::shade
