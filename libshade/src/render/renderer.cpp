// SPDX-License-Identifier: Apache-2.0
// Draws a scene by its effect plan. The constructor decodes and uploads only what the plan names. A
// frame draws the opaque surfaces, the skybox, the blended surfaces in painter's order, the
// finishing pass, and the overlays. Tests: tests/shade/render/renderer_test.cpp,
// forced_effects_test.cpp.
#include "relief/shade/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "progress_stage.h"
#include "relief/mesh/report.h"
#include "relief/mesh/timing.h"
#include "render/draw_values.h"
#include "render/environment.h"
#include "render/gpu_mesh.h"
#include "render/overlays.h"
#include "render/picture.h"
#include "render/program_cache.h"
#include "render/textures.h"

namespace relief {

/// The resources that renderers of one context share.
struct RenderCache::Implementation {
    explicit Implementation(const gl::Api& api)
        : programs(api), meshes(api), textures(api), environments(api), targets(api) {}

    ProgramCache programs;
    MeshCache meshes;
    TextureCache textures;
    EnvironmentCache environments;
    TargetPool targets;
};

namespace {

/// The resources and state of a draw.
struct Draw {
    std::shared_ptr<const DrawProgram> program;
    Features features;
    std::size_t instance = 0;
    std::size_t mesh = 0;
    MaterialRange range;
    DrawValues values;
    bool both_sides = false;
    std::array<BoundTexture, material_unit_count> textures;  ///< By TextureUnit.
    std::unique_ptr<SortedTriangles> sorted;                 ///< Only for blended draws.
};

bool is_blended(const Draw& draw) {
    return draw.features.alpha == AlphaMode::blend;
}

/// The scene objects that the plan of a draw refers to.
struct Planned {
    const Features& features;
    const Material& material;
    const Mesh& mesh;
};

Planned planned(const Scene& scene, const DrawPlan& draw) {
    return {draw.features,
            draw.range.material ? scene.materials[*draw.range.material] : default_material(),
            scene.meshes[scene.instances[draw.instance].mesh]};
}

ImagePurpose purpose_of(const UsedTexture& used) {
    return {used.use, used.unit == TextureUnit::normal_texture};
}

void request_planned(SceneTextures& textures, const Scene& scene, const FramePlan& plan) {
    for (const DrawPlan& draw : plan.draws) {
        const Planned p = planned(scene, draw);
        for (const UsedTexture& used : used_textures(p.features, p.material, p.mesh)) {
            if (used.texture != nullptr) textures.request(used.texture->image, purpose_of(used));
        }
    }
}

/// Reports textured materials on meshes without texture coordinates.
void report_missing_texcoords(const Scene& scene, const FramePlan& plan, Report& report) {
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        const Planned p = planned(scene, plan.draws[i]);
        if (!has_textures(p.material) || !p.mesh.texcoords.empty()) continue;
        report.add("textured material on a mesh without texture coordinates", "draw", i,
                   "drawn without its textures");
    }
}

/// Returns the numbers of instances and lights, which must stay the same when a scene moves.
std::array<std::size_t, 4> object_counts(const Scene& scene) {
    return {scene.instances.size(), scene.directional_lights.size(), scene.point_lights.size(),
            scene.spot_lights.size()};
}

}  // namespace

struct Renderer::Implementation {
    /// \param given  the shared cache; null: the renderer has its own
    Implementation(const Context& context, const Scene& scene, FramePlan frame_plan,
                   const FrameSettings& settings, RenderCache* given, Report& report);

    void prepare_meshes(const Scene& scene, Report& report);
    void prepare_draws(const Scene& scene);
    Draw prepare_draw(const Scene& scene, const DrawPlan& plan_of_draw);
    void bind_planned_textures(Draw& draw, const Planned& p);
    void set_environment_values(Draw& draw) const;
    void move(const Scene& scene);
    void bind_textures(const Draw& draw) const;
    void set_state(const Draw& draw) const;
    void issue(Draw& draw, const glm::dmat4& to_clip, const Camera& camera);
    void issue_blended(const glm::dmat4& to_clip, const Camera& camera);
    void count_fragments() const;
    void draw_overlays(const glm::dmat4& to_clip) const;
    void draw_frame(const Camera& camera);

    const gl::Api& api;
    std::unique_ptr<RenderCache> own;  ///< If none was given.
    RenderCache::Implementation& cache;
    FramePlan plan;
    std::array<std::size_t, 4> counts;
    FrameTimes times;
    Picture picture;
    std::set<Features> programs;
    SceneTextures textures;
    LightStorage lights;
    std::map<std::size_t, std::shared_ptr<GpuMesh>> meshes;  ///< Drawn meshes by index.
    std::vector<Draw> draws;                                 ///< Opaque ones first.
    std::optional<EnvironmentMaps> environment;
    std::optional<Skybox> skybox;
    std::unique_ptr<OverlayDrawing> overlays;  ///< If any is requested.
    bool counts_fragments;                     ///< For the overdraw view.
};

Renderer::Implementation::Implementation(const Context& context, const Scene& scene,
                                         FramePlan frame_plan, const FrameSettings& settings,
                                         RenderCache* given, Report& report)
    : api(context.api()),
      own(given == nullptr ? std::make_unique<RenderCache>(context) : nullptr),
      cache((given == nullptr ? *own : *given).implementation()),
      plan(std::move(frame_plan)),
      counts(object_counts(scene)),
      picture(api, cache.targets, cache.programs, scene, settings, plan.finishing_pass),
      textures(cache.textures),
      counts_fragments(settings.view == DebugView::overdraw) {
    report_missing_texcoords(scene, plan, report);

    Stopwatch stopwatch;  // OpenGL's timer queries are wrong on llvmpipe.
    request_planned(textures, scene, plan);
    leave_out_textures(scene, textures.decode(scene.images), plan, report);
    const bool shows_environment = plan.environment_map && scene.environment.has_value();
    if (shows_environment) cache.environments.decode(*scene.environment);
    times.decode_images = 1e3 * stopwatch.lap();

    const double linked_before = cache.programs.milliseconds();
    prepare_meshes(scene, report);
    textures.upload(scene.images);
    environment.emplace(api, cache.environments, scene, plan, shows_environment, report);
    if (plan.skybox) {
        skybox.emplace(api, cache.programs, scene, drawn_coding(settings, plan.finishing_pass));
    }
    {
        const ProgressStage stage("programs");
        prepare_draws(scene);
    }
    if (settings.overlays.any()) {
        overlays =
            std::make_unique<OverlayDrawing>(api, cache.programs, scene, plan, settings, report);
    }
    api->Finish();
    api.check("preparing the scene");
    times.link = cache.programs.milliseconds() - linked_before;
    times.prepare = 1e3 * stopwatch.lap();
}

void Renderer::Implementation::prepare_meshes(const Scene& scene, Report& report) {
    std::map<std::size_t, PlannedStreams> streams;
    for (const DrawPlan& draw : plan.draws)
        streams[scene.instances[draw.instance].mesh].add(planned_interface(draw.features));
    ProgressStage stage("uploading meshes", streams.size());
    for (const auto& [mesh, planned] : streams) {
        meshes.emplace(mesh, cache.meshes.get(scene.meshes[mesh], planned, report));
        stage.advance(1);
    }
}

void Renderer::Implementation::prepare_draws(const Scene& scene) {
    for (const DrawPlan& draw : plan.draws) {
        if (draw.range.triangle_count == 0) continue;
        check_cancelled();
        lights.add(api, scene, draw.features);
        draws.push_back(prepare_draw(scene, draw));
    }
    // Adjacent draws with the same program need no program change. The depth buffer hides the
    // order.
    std::stable_sort(draws.begin(), draws.end(), [](const Draw& a, const Draw& b) {
        if (is_blended(a) != is_blended(b)) return is_blended(b);
        return a.features < b.features;
    });
}

Draw Renderer::Implementation::prepare_draw(const Scene& scene, const DrawPlan& plan_of_draw) {
    const Planned p = planned(scene, plan_of_draw);
    const Instance& instance = scene.instances[plan_of_draw.instance];
    Draw draw;
    draw.program = cache.programs.get(p.features);
    programs.insert(p.features);
    draw.features = p.features;
    draw.instance = plan_of_draw.instance;
    draw.mesh = instance.mesh;
    draw.range = plan_of_draw.range;
    draw.both_sides = p.material.double_sided;
    set_material(draw.values, p.material, scene);
    set_environment_values(draw);
    set_place(draw.values, instance.world_from_object);
    bind_planned_textures(draw, p);
    if (is_blended(draw)) draw.sorted = std::make_unique<SortedTriangles>(p.mesh, draw.range);
    return draw;
}

void Renderer::Implementation::bind_planned_textures(Draw& draw, const Planned& p) {
    for (const UsedTexture& used : used_textures(p.features, p.material, p.mesh)) {
        BoundTexture& bound = draw.textures[static_cast<std::size_t>(used.unit)];
        const bool is_normal_map = used.unit == TextureUnit::normal_texture;
        if (used.texture == nullptr) {
            bound = is_normal_map ? cache.textures.flat() : cache.textures.white();
            continue;
        }
        const ImagePurpose purpose = purpose_of(used);
        bound = textures.bound(*used.texture, purpose);
        if (is_normal_map) {
            const GpuImage& image = textures.image(used.texture->image, purpose);
            const NormalMap& map = *p.material.normal_map;
            set_normal_map(draw.values, map, image.bits, map.flat.value_or(image.flat));
        }
    }
}

void Renderer::Implementation::set_environment_values(Draw& draw) const {
    draw.values.blurred_levels = environment->blurred_levels();
    draw.values.irradiance_sh = environment->irradiance_sh();
}

void Renderer::Implementation::move(const Scene& scene) {
    lights.update(api, scene);
    for (Draw& draw : draws)
        set_place(draw.values, scene.instances[draw.instance].world_from_object);
    if (overlays) overlays->move(scene);
}

void Renderer::Implementation::bind_textures(const Draw& draw) const {
    for (std::size_t i = 0; i < draw.textures.size(); ++i) {
        if (draw.textures[i].texture == 0) continue;
        api->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        api->BindTexture(GL_TEXTURE_2D, draw.textures[i].texture);
        api->BindSampler(static_cast<GLuint>(i), draw.textures[i].sampler);
    }
    lights.bind(api, draw.features);
}

void Renderer::Implementation::set_state(const Draw& draw) const {
    if (draw.both_sides) {
        api->Disable(GL_CULL_FACE);
    } else {
        api->Enable(GL_CULL_FACE);
    }
    // A mirroring matrix reverses the winding, but not the front of a surface.
    api->FrontFace(draw.values.handedness < 0.0F ? GL_CW : GL_CCW);
}

void Renderer::Implementation::issue(Draw& draw, const glm::dmat4& to_clip, const Camera& camera) {
    DrawValues values = draw.values;
    values.clip_from_object = glm::mat4(to_clip * glm::dmat4(values.world_from_object));
    values.eye_world = glm::vec3(camera.world_from_view[3]);
    draw.program->linked.use();
    for (const std::string& name : draw.program->planned.uniforms) {
        set_uniform(draw.program->linked, name, values);
    }
    bind_textures(draw);
    set_state(draw);
    if (!draw.sorted) {
        meshes.at(draw.mesh)->draw(api, draw.range);
        return;
    }
    const glm::vec3 farther_world(-camera.world_from_view[2]);
    const glm::vec3 farther_object =
        glm::transpose(glm::mat3(values.world_from_object)) * farther_world;
    meshes.at(draw.mesh)->draw(api, draw.sorted->sort(farther_object));
}

/// Draws blended surfaces over all others, farthest center first, without writing depth.
void Renderer::Implementation::issue_blended(const glm::dmat4& to_clip, const Camera& camera) {
    const auto depth = [&](const Draw& draw) {
        const glm::vec3 center(draw.values.world_from_object *
                               glm::vec4(draw.sorted->center(), 1.0F));
        return glm::dot(center - glm::vec3(camera.world_from_view[3]),
                        -glm::vec3(camera.world_from_view[2]));
    };
    std::vector<std::pair<float, Draw*>> blended;
    for (Draw& draw : draws) {
        if (is_blended(draw)) blended.emplace_back(depth(draw), &draw);
    }
    std::stable_sort(blended.begin(), blended.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    api->Enable(GL_BLEND);
    api->BlendEquation(GL_FUNC_ADD);
    api->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    api->DepthMask(GL_FALSE);
    for (const auto& [distance, draw] : blended)
        issue(*draw, to_clip, camera);
    api->DepthMask(GL_TRUE);
    api->Disable(GL_BLEND);
}

/// Sets the state that counts fragments: additive blending on black without a depth test.
void Renderer::Implementation::count_fragments() const {
    api->ClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    api->Clear(GL_COLOR_BUFFER_BIT);
    api->Disable(GL_DEPTH_TEST);
    api->Enable(GL_BLEND);
    api->BlendEquation(GL_FUNC_ADD);
    api->BlendFuncSeparate(GL_ONE, GL_ONE, GL_ZERO, GL_ONE);
}

void Renderer::Implementation::draw_overlays(const glm::dmat4& to_clip) const {
    std::vector<OverlaySurface> surfaces;
    for (const Draw& draw : draws) {
        surfaces.push_back({meshes.at(draw.mesh).get(), draw.range, draw.values.world_from_object,
                            draw.both_sides, draw.values.handedness < 0.0F,
                            draw.features.alpha == AlphaMode::opaque});
    }
    picture.bind_finished();
    overlays->draw(to_clip, surfaces);
}

void Renderer::Implementation::draw_frame(const Camera& camera) {
    picture.begin();
    api->Disable(GL_BLEND);
    api->Enable(GL_DEPTH_TEST);
    api->DepthFunc(GL_LEQUAL);
    api->CullFace(GL_BACK);
    environment->bind(api);
    set_attribute_constants(api);
    if (counts_fragments) count_fragments();
    const glm::dmat4 to_clip = clip_from_world(camera, static_cast<double>(picture.aspect()));
    for (Draw& draw : draws) {
        if (!is_blended(draw)) issue(draw, to_clip, camera);
    }
    if (skybox) {
        api->Disable(GL_CULL_FACE);
        skybox->draw(api, camera, picture.aspect());
    }
    if (plan.sorted_blending) issue_blended(to_clip, camera);
    if (counts_fragments) api->Disable(GL_BLEND);
    picture.finish();
    if (overlays) draw_overlays(to_clip);
    api.check("drawing the scene");
}

namespace {

/// Plans a scene after validation.
FramePlan checked_plan(const Scene& scene, const FrameSettings& settings, Report& report) {
    validate(scene);
    return plan_view(scene, settings, plan_effects(scene, settings), report);
}

/// Data views have one sample per pixel.
FrameSettings drawn_settings(FrameSettings settings) {
    if (is_data(settings.view)) settings.samples = 1;
    return settings;
}

void check_draw(const Scene& scene, const DrawPlan& draw) {
    if (draw.instance >= scene.instances.size()) {
        throw InvalidInput(fmt::format("the plan names instance {}, but there are only {}",
                                       draw.instance, scene.instances.size()));
    }
    const Mesh& mesh = scene.meshes[scene.instances[draw.instance].mesh];
    const std::uint64_t end = std::uint64_t{draw.range.first_triangle} + draw.range.triangle_count;
    if (end > mesh.triangles.size()) {
        throw InvalidInput(
            fmt::format("the plan names triangle {} of mesh '{}', but there are only {}", end - 1,
                        mesh.name, mesh.triangles.size()));
    }
    if (draw.range.material && *draw.range.material >= scene.materials.size()) {
        throw InvalidInput(fmt::format("the plan names material {}, but there are only {}",
                                       *draw.range.material, scene.materials.size()));
    }
}

/// Checks that a given plan refers to objects of the scene, and completes it for the frame
/// settings.
FramePlan checked_plan(const Scene& scene, FramePlan plan, const FrameSettings& settings,
                       Report& report) {
    validate(scene);
    for (DrawPlan& draw : plan.draws) {
        check_draw(scene, draw);
        draw.features = canonical(draw.features);
        plan.sorted_blending |= draw.features.alpha == AlphaMode::blend;
    }
    plan.finishing_pass |= plan.sorted_blending || settings.samples > 1;
    for (DrawPlan& draw : plan.draws) {
        draw.features.output = drawn_coding(settings, plan.finishing_pass);
        draw.features = canonical(draw.features);
    }
    return plan_view(scene, settings, std::move(plan), report);
}

}  // namespace

Renderer::Renderer(const Context& context, const Scene& scene, const FrameSettings& settings,
                   Report& report)
    : implementation_(
          std::make_unique<Implementation>(context, scene, checked_plan(scene, settings, report),
                                           drawn_settings(settings), nullptr, report)) {}

Renderer::Renderer(const Context& context, const Scene& scene, FramePlan plan,
                   const FrameSettings& settings, Report& report)
    : implementation_(std::make_unique<Implementation>(
          context, scene, checked_plan(scene, std::move(plan), settings, report),
          drawn_settings(settings), nullptr, report)) {}

Renderer::Renderer(RenderCache& cache, const Context& context, const Scene& scene, FramePlan plan,
                   const FrameSettings& settings, Report& report)
    : implementation_(std::make_unique<Implementation>(
          context, scene, checked_plan(scene, std::move(plan), settings, report),
          drawn_settings(settings), &cache, report)) {}

Renderer::~Renderer() = default;

const FramePlan& Renderer::plan() const {
    return implementation_->plan;
}

void Renderer::move(const Scene& scene) {
    validate_transforms(scene);
    if (object_counts(scene) != implementation_->counts) {
        throw InvalidInput(
            "a moved scene has the instances and lamps that it had, no fewer or more");
    }
    implementation_->move(scene);
}

const gl::RenderTarget& Renderer::target() const {
    return implementation_->picture.target();
}

RenderedFrame Renderer::draw_only(const Camera& camera) {
    validate(camera);
    Implementation& self = *implementation_;
    const Stopwatch stopwatch;
    self.draw_frame(camera);
    self.times.draw = 1e3 * stopwatch.seconds();
    self.times.read_back = 0;
    return {self.picture.target().color().name(), self.times, self.programs.size(),
            self.textures.size() + self.environment->texture_count()};
}

Frame Renderer::draw(const Camera& camera) {
    const RenderedFrame drawn = draw_only(camera);
    Frame frame{{}, drawn.times, drawn.programs, drawn.textures};
    const Stopwatch stopwatch;
    frame.image = implementation_->picture.read();
    frame.times.read_back = 1e3 * stopwatch.seconds();
    return frame;
}

RenderCache::RenderCache(const Context& context)
    : implementation_(std::make_unique<Implementation>(context.api())) {}

RenderCache::~RenderCache() = default;

void RenderCache::drop_unused() {
    implementation_->meshes.drop_unused();
    implementation_->textures.drop_unused();
    implementation_->environments.drop_unused();
    implementation_->targets.drop_unused();
}

void RenderCache::drop_programs() {
    implementation_->programs.clear();
}

RenderCache::Contents RenderCache::contents() const {
    return {implementation_->programs.size(), implementation_->meshes.size(),
            implementation_->textures.size(), implementation_->environments.size(),
            implementation_->targets.size()};
}

}  // namespace relief
