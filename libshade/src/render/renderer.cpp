// SPDX-License-Identifier: Apache-2.0
// Draws a scene as its effect plan says: decodes and uploads what the plan names and nothing else,
// then one pass over the draws, the skybox behind them, and the finished picture. World space,
// linear light. Tests: tests/shade/render/renderer_test.cpp, forced_effects_test.cpp.
#include "relief/shade/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "relief/mesh/error.h"
#include "render/draw_values.h"
#include "render/environment.h"
#include "render/gpu_mesh.h"
#include "render/light_storage.h"
#include "render/picture.h"
#include "render/program_cache.h"
#include "render/scene_textures.h"

namespace relief {

namespace {

/// Milliseconds since the last lap, by the wall clock: timer queries are wrong on llvmpipe.
class Stopwatch {
  public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double elapsed = std::chrono::duration<double, std::milli>(now - last_).count();
        last_ = now;
        return elapsed;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Everything that one draw binds and sets.
struct Draw {
    const DrawProgram* program = nullptr;
    Features features;
    std::size_t mesh = 0;
    MaterialRange range;
    DrawValues values;
    bool both_sides = false;
    std::array<BoundTexture, 3> textures;  ///< By TextureUnit: diffuse, normal, emission.
};

/// The parts of one draw's plan, looked up in the scene.
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

/// The material's textures that this draw samples: without texture coordinates, none. A forced plan
/// may name textures that do not exist.
struct PlannedTextures {
    const Texture* diffuse = nullptr;
    const NormalMap* normal = nullptr;
    const Texture* emission = nullptr;
};

PlannedTextures planned_textures(const Planned& p) {
    PlannedTextures textures;
    if (p.mesh.texcoords.empty()) return textures;
    const auto pick = [](bool on, const auto& texture) {
        return on && texture ? &*texture : nullptr;
    };
    textures.diffuse = pick(p.features.diffuse_texture, p.material.diffuse_texture);
    textures.normal = pick(p.features.normal_map, p.material.normal_map);
    textures.emission = pick(p.features.emission_texture, p.material.emission_texture);
    return textures;
}

DecodedImages decode_planned(const Scene& scene, const FramePlan& plan) {
    DecodedImages images;
    for (const DrawPlan& draw : plan.draws) {
        const PlannedTextures textures = planned_textures(planned(scene, draw));
        if (textures.diffuse != nullptr) images.want(textures.diffuse->image, ImageUse::color);
        if (textures.normal != nullptr) images.want(textures.normal->texture.image, ImageUse::data);
        if (textures.emission != nullptr) images.want(textures.emission->image, ImageUse::color);
    }
    images.decode_all(scene.images);
    return images;
}

/// Counts what a material asks for and a mesh without texture coordinates cannot show.
void report_missing_texcoords(const Scene& scene, const FramePlan& plan, Report& report) {
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        const Planned p = planned(scene, plan.draws[i]);
        const bool textured =
            p.material.diffuse_texture || p.material.normal_map || p.material.emission_texture;
        if (!textured || !p.mesh.texcoords.empty()) continue;
        report.add("textured material on a mesh without texture coordinates", "draw", i,
                   "drawn without its textures");
    }
}

}  // namespace

struct Renderer::Implementation {
    Implementation(const Context& context, const Scene& scene, FramePlan frame_plan,
                   const FrameSettings& settings, Report& report);

    void prepare_meshes(const Scene& scene, Report& report);
    void prepare_environment(const Scene& scene, std::span<const Image> images,
                             const FrameSettings& settings, Report& report);
    void prepare_draws(const Scene& scene, const DecodedImages& images);
    Draw prepare_draw(const Scene& scene, const DrawPlan& plan_of_draw,
                      const DecodedImages& images);
    void bind_textures(const Draw& draw) const;
    void issue(const Draw& draw, const glm::dmat4& to_clip, const Camera& camera) const;
    void draw_frame(const Camera& camera) const;

    const gl::Api& api;
    FramePlan plan;
    glm::vec4 background;
    FrameTimes times;
    Picture picture;
    ProgramCache programs;
    SceneTextures textures;
    LightStorage lights;
    std::vector<GpuMesh> meshes;
    std::vector<Draw> draws;
    std::optional<gl::CubeMap> environment;
    std::optional<Skybox> skybox;
};

Renderer::Implementation::Implementation(const Context& context, const Scene& scene,
                                         FramePlan frame_plan, const FrameSettings& settings,
                                         Report& report)
    : api(context.api()),
      plan(std::move(frame_plan)),
      background(scene.background),
      picture(api, settings),
      programs(api),
      textures(api) {
    for (DrawPlan& draw : plan.draws)
        draw.features = canonical(draw.features);
    report_missing_texcoords(scene, plan, report);

    Stopwatch stopwatch;
    const DecodedImages images = decode_planned(scene, plan);
    std::vector<Image> surroundings;
    if (plan.environment_map && scene.environment) {
        surroundings = decode_environment(*scene.environment);
    }
    times.decode_images = stopwatch.lap();

    prepare_meshes(scene, report);
    textures.upload(images, scene.images);
    prepare_environment(scene, surroundings, settings, report);
    prepare_draws(scene, images);
    api->Finish();
    api.check("preparing the scene");
    times.prepare = stopwatch.lap();
}

void Renderer::Implementation::prepare_meshes(const Scene& scene, Report& report) {
    std::vector<PlannedStreams> streams(scene.meshes.size());
    for (const DrawPlan& draw : plan.draws) {
        streams[scene.instances[draw.instance].mesh].add(planned_interface(draw.features));
    }
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i];
        const bool lacks_normals = streams[i].normals && mesh.normals.empty();
        const bool lacks_tangents =
            streams[i].tangents && mesh.tangents.empty() && !mesh.texcoords.empty();
        if (lacks_normals || lacks_tangents) {
            meshes.emplace_back(api, with_planned_frames(mesh, streams[i], report), streams[i]);
        } else {
            meshes.emplace_back(api, mesh, streams[i]);
        }
    }
}

void Renderer::Implementation::prepare_environment(const Scene& scene,
                                                   std::span<const Image> images,
                                                   const FrameSettings& settings, Report& report) {
    const bool mirrored =
        std::any_of(plan.draws.begin(), plan.draws.end(),
                    [](const DrawPlan& draw) { return draw.features.reflection; });
    if (!images.empty()) {
        environment = make_environment(api, *scene.environment, images, report);
    } else if (mirrored || plan.skybox) {
        environment = make_black_environment(api);
    }
    if (plan.skybox) {
        const float intensity = scene.environment ? scene.environment->intensity : 0.0F;
        skybox.emplace(api, Picture::drawn_coding(settings), intensity);
    }
}

void Renderer::Implementation::prepare_draws(const Scene& scene, const DecodedImages& images) {
    for (const DrawPlan& draw : plan.draws) {
        if (draw.range.triangle_count == 0) continue;
        lights.add(api, scene, draw.features);
        draws.push_back(prepare_draw(scene, draw, images));
    }
    // Neighbours with one program need no change of it; the depth buffer makes order invisible.
    std::stable_sort(draws.begin(), draws.end(),
                     [](const Draw& a, const Draw& b) { return a.features < b.features; });
}

Draw Renderer::Implementation::prepare_draw(const Scene& scene, const DrawPlan& plan_of_draw,
                                            const DecodedImages& images) {
    const Planned p = planned(scene, plan_of_draw);
    const PlannedTextures used = planned_textures(p);
    const Instance& instance = scene.instances[plan_of_draw.instance];
    Draw draw;
    draw.program = &programs.get(p.features);
    draw.features = p.features;
    draw.mesh = instance.mesh;
    draw.range = plan_of_draw.range;
    draw.both_sides = p.material.double_sided;
    set_material(draw.values, p.material, scene);
    set_place(draw.values, instance.world_from_object);
    const auto unit = [&](TextureUnit name) -> BoundTexture& {
        return draw.textures[static_cast<std::size_t>(name)];
    };
    if (p.features.diffuse_texture) {
        unit(TextureUnit::diffuse_texture) =
            used.diffuse ? textures.get(*used.diffuse, ImageUse::color) : textures.white();
    }
    if (p.features.emission_texture) {
        unit(TextureUnit::emission_texture) =
            used.emission ? textures.get(*used.emission, ImageUse::color) : textures.white();
    }
    if (p.features.normal_map && used.normal != nullptr) {
        const NormalMap& map = *used.normal;
        const Image& image = images.get(map.texture.image, ImageUse::data);
        const FlatCode flat = flat_code_of(map, image, scene.images[map.texture.image]);
        const NormalMapNumbers numbers =
            normal_map_numbers(image.bits(), flat, map.green, map.scale);
        draw.values.normal_map_scale = numbers.scale;
        draw.values.normal_map_bias = numbers.bias;
        unit(TextureUnit::normal_texture) = textures.get(map.texture, ImageUse::data);
    } else if (p.features.normal_map) {
        unit(TextureUnit::normal_texture) = textures.flat();
    }
    return draw;
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

void Renderer::Implementation::issue(const Draw& draw, const glm::dmat4& to_clip,
                                     const Camera& camera) const {
    DrawValues values = draw.values;
    values.clip_from_object = glm::mat4(to_clip * glm::dmat4(values.world_from_object));
    values.eye_world = glm::vec3(camera.world_from_view[3]);
    draw.program->linked.use();
    for (const std::string& name : draw.program->planned.uniforms) {
        set_uniform(draw.program->linked, name, values);
    }
    bind_textures(draw);
    if (draw.both_sides) {
        api->Disable(GL_CULL_FACE);
    } else {
        api->Enable(GL_CULL_FACE);
    }
    // A mirroring matrix turns counter-clockwise triangles clockwise; the front stays the front.
    api->FrontFace(draw.values.handedness < 0.0F ? GL_CW : GL_CCW);
    meshes[draw.mesh].draw(api, draw.range);
}

void Renderer::Implementation::draw_frame(const Camera& camera) const {
    picture.begin(background);
    api->Disable(GL_BLEND);
    api->Enable(GL_DEPTH_TEST);
    api->DepthFunc(GL_LEQUAL);
    api->CullFace(GL_BACK);
    if (environment) {
        api->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(TextureUnit::environment));
        api->BindTexture(GL_TEXTURE_CUBE_MAP, environment->texture.name());
        api->BindSampler(static_cast<GLuint>(TextureUnit::environment), 0);
    }
    set_attribute_constants(api);
    const glm::dmat4 to_clip = clip_from_world(camera, static_cast<double>(picture.aspect()));
    for (const Draw& draw : draws)
        issue(draw, to_clip, camera);
    if (skybox) {
        api->Disable(GL_CULL_FACE);
        skybox->draw(api, camera, picture.aspect());
    }
    picture.finish();
    api.check("drawing the scene");
}

namespace {

/// The plan that the renderer makes itself, of a scene found valid.
FramePlan checked_plan(const Scene& scene, const FrameSettings& settings) {
    validate(scene);
    return plan_effects(scene, Picture::drawn_coding(settings));
}

/// Another's plan must name what the scene has.
FramePlan checked_plan(const Scene& scene, FramePlan plan, const FrameSettings& settings) {
    validate(scene);
    for (DrawPlan& draw : plan.draws) {
        if (draw.instance >= scene.instances.size()) {
            throw InvalidInput(fmt::format("the plan names instance {}, but there are only {}",
                                           draw.instance, scene.instances.size()));
        }
        const Mesh& mesh = scene.meshes[scene.instances[draw.instance].mesh];
        const std::uint64_t end =
            std::uint64_t{draw.range.first_triangle} + draw.range.triangle_count;
        if (end > mesh.triangles.size()) {
            throw InvalidInput(
                fmt::format("the plan names triangle {} of mesh '{}', but there are "
                            "only {}",
                            end - 1, mesh.name, mesh.triangles.size()));
        }
        if (draw.range.material && *draw.range.material >= scene.materials.size()) {
            throw InvalidInput(fmt::format("the plan names material {}, but there are only {}",
                                           *draw.range.material, scene.materials.size()));
        }
        draw.features.output = Picture::drawn_coding(settings);
    }
    return plan;
}

}  // namespace

Renderer::Renderer(const Context& context, const Scene& scene, const FrameSettings& settings,
                   Report& report)
    : implementation_(std::make_unique<Implementation>(
          context, scene, checked_plan(scene, settings), settings, report)) {}

Renderer::Renderer(const Context& context, const Scene& scene, FramePlan plan,
                   const FrameSettings& settings, Report& report)
    : implementation_(std::make_unique<Implementation>(
          context, scene, checked_plan(scene, std::move(plan), settings), settings, report)) {}

Renderer::~Renderer() = default;

const FramePlan& Renderer::plan() const {
    return implementation_->plan;
}

Frame Renderer::draw(const Camera& camera) {
    validate(camera);
    Implementation& self = *implementation_;
    Frame frame;
    Stopwatch stopwatch;
    self.draw_frame(camera);
    self.times.draw = stopwatch.lap();
    frame.image = self.picture.read();
    self.times.read_back = stopwatch.lap();
    frame.times = self.times;
    frame.programs = self.programs.size();
    frame.textures = self.textures.size() + (self.environment ? 1 : 0);
    return frame;
}

}  // namespace relief
