// SPDX-License-Identifier: Apache-2.0
// Draws a scene by its effect plan. The constructor decodes and uploads only what the plan names. A
// frame draws the shadow maps if something has moved, the opaque surfaces, the skybox, the
// transmissive surfaces over a copy of these, the blended surfaces in painter's order, the
// finishing pass and the overlays.
// Tests: tests/shade/render/renderer_test.cpp, shading_test.cpp, forced_effects_test.cpp,
// render_cache_test.cpp.
#include "relief/shade/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "effects/features.h"
#include "effects/light_rows.h"
#include "gl/resources.h"
#include "progress_stage.h"
#include "relief/mesh/map_kind_check.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"
#include "render/draw_values.h"
#include "render/environment.h"
#include "render/gpu_mesh.h"
#include "render/overlays.h"
#include "render/picture.h"
#include "render/program_cache.h"
#include "render/renderer_parts.h"
#include "render/textures.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

namespace {

/// Returns the texture of an effect that is forced on without one.
BoundTexture neutral_texture(TextureCache& textures, NeutralTexel texel) {
    switch (texel) {
        case NeutralTexel::flat:
            return textures.flat();
        case NeutralTexel::tangent:
            return textures.tangent();
        case NeutralTexel::white:
            break;
    }
    return textures.white();
}

/// Sets the decoding of the surface's normal map, or of its coat's.
void set_planned_map(DrawValues& values, TextureSlot slot, const Material& material,
                     const GpuImage& image) {
    const bool coats = slot == TextureSlot::clearcoat_normal;
    const NormalMap& map =
        coats ? *material.metallic_roughness->clearcoat_normal_map : *material.normal_map;
    DrawValues decoding;
    set_normal_map(coats ? decoding : values, map, image.bits, map.flat.value_or(image.flat));
    if (!coats) return;
    values.clearcoat_normal_scale = decoding.normal_map_scale;
    values.clearcoat_normal_bias = decoding.normal_map_bias;
}

void request_planned(SceneTextures& textures, const Scene& scene, const FramePlan& plan) {
    for (const DrawPlan& draw : plan.draws) {
        const Planned p = planned(scene, draw);
        for (const UsedTexture& used : used_textures(p.features, p.material, p.mesh)) {
            if (used.texture != nullptr) textures.request(used.texture->image, purpose_of(used));
        }
    }
}

/// Reports maps whose texels show another kind than the one as which they are drawn.
void report_judged_kinds(const SceneTextures& textures, const Scene& scene, const FramePlan& plan,
                         Report& report) {
    std::set<std::pair<std::uint32_t, TextureSlot>> reported;
    for (const DrawPlan& draw : plan.draws) {
        const Planned p = planned(scene, draw);
        for (const UsedTexture& used : used_textures(p.features, p.material, p.mesh)) {
            if (used.texture == nullptr || !draw.range.material) continue;
            const std::vector<MapKind> drawn = drawn_kinds(p.material, used.slot);
            if (!is_judged_by_texels(drawn)) continue;
            const auto& content = textures.image(used.texture->image, purpose_of(used)).content;
            const auto wrong = content ? judged_wrong_kind(drawn, *content) : std::nullopt;
            if (wrong && reported.emplace(*draw.range.material, used.slot).second)
                report_drawn_kind(*wrong, used.slot, drawn.front(), *draw.range.material, report);
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

/// Reports a shadow that the scene requests and no light casts.
void report_missing_shadow(const Scene& scene, Report& report) {
    if (!scene.shadow || shadow_term(scene) != ShadowTerm::none) return;
    report.add("requested shadow that nothing casts", "scene", 0,
               "drawn without a shadow: no light shines from outside of the scene, or no surface "
               "casts a shadow");
}

// Software OpenGL draws large pictures for seconds. Operations that can be cancelled wait for it
// after these amounts of work.
constexpr std::size_t samples_per_band = std::size_t{1} << 22;
constexpr std::uint32_t triangles_per_piece = 1 << 18;
/// Every band draws all triangles. A triangle costs as much as some samples.
constexpr std::size_t samples_per_triangle = 8;
/// Software OpenGL rasterizes tiles of this many rows.
constexpr int rows_per_tile = 64;

/// Limits drawing and clearing to some rows of the picture during the lifetime of this object.
class Scissor {
  public:
    explicit Scissor(const gl::Api& api) : api_(&api) { api->Enable(GL_SCISSOR_TEST); }
    ~Scissor() { (*api_)->Disable(GL_SCISSOR_TEST); }
    Scissor(const Scissor&) = delete;
    Scissor& operator=(const Scissor&) = delete;

    void set(int first_row, int width, int rows) const {
        (*api_)->Scissor(0, first_row, width, rows);
    }

  private:
    const gl::Api* api_;
};

/// True if the operation can be cancelled.
bool is_cancellable() {
    return current_progress != nullptr;
}

/// Returns the numbers of instances and lights, which must stay the same when a scene moves.
std::array<std::size_t, 4> object_counts(const Scene& scene) {
    return {scene.instances.size(), scene.directional_lights.size(), scene.point_lights.size(),
            scene.spot_lights.size()};
}

}  // namespace

PreparedScene::PreparedScene(const Context& context, const Scene& scene, FramePlan frame_plan,
                             const FrameSettings& settings, RenderCache* given, Report& report)
    : api(context.api()),
      own(given == nullptr ? std::make_unique<RenderCache>(context) : nullptr),
      cache((given == nullptr ? *own : *given).implementation()),
      shaders(settings.shaders),
      linked(cache.programs.with(shaders)),
      plan(std::move(frame_plan)),
      counts(object_counts(scene)),
      picture(api, cache.targets, linked, scene, settings, plan.finishing_pass),
      textures(cache.textures),
      counts_fragments(settings.view == DebugView::overdraw) {
    report_missing_texcoords(scene, plan, report);
    report_missing_shadow(scene, report);

    Stopwatch stopwatch;  // OpenGL's timer queries are wrong on llvmpipe.
    request_planned(textures, scene, plan);
    leave_out_textures(scene, textures.decode(scene.images), plan, report);
    const bool shows_environment = plan.environment_map && scene.environment.has_value();
    if (shows_environment) cache.environments.decode(*scene.environment);
    times.decode_images = 1e3 * stopwatch.lap();

    const double linked_before = linked.milliseconds();
    prepare_meshes(scene, report);
    textures.upload(scene.images);
    report_judged_kinds(textures, scene, plan, report);
    environment.emplace(api, cache.environments, scene, plan, shows_environment, report);
    if (plan.skybox) {
        skybox.emplace(api, linked, scene, drawn_coding(settings, plan.finishing_pass),
                       environment->blurred_levels());
    }
    {
        ProgressStage stage("programs", plan.draws.size());
        prepare_shadow(scene);
        prepare_draws(scene, stage);
    }
    if (settings.overlays.any()) {
        overlays = std::make_unique<OverlayDrawing>(api, linked, scene, plan, settings, report);
    }
    api->Finish();
    api.check("preparing the scene");
    times.link = linked.milliseconds() - linked_before;
    times.prepare = 1e3 * stopwatch.lap();
}

void PreparedScene::prepare_meshes(const Scene& scene, Report& report) {
    std::set<std::pair<std::size_t, Features>> added;
    for (const DrawPlan& draw : plan.draws) {
        const std::size_t mesh = scene.instances[draw.instance].mesh;
        if (added.emplace(mesh, draw.features).second)
            streams[mesh].add(planned_interface(draw.features));
    }
    ProgressStage stage("uploading meshes", streams.size());
    for (const auto& [mesh, planned] : streams) {
        meshes.emplace(mesh, cache.meshes.get(scene.meshes[mesh], planned, report));
        drawn.emplace(mesh, scene.meshes[mesh].identity());
        stage.advance(1);
    }
}

/// Checks that meshes that were replaced are valid, and that draws have all of their triangles.
void PreparedScene::check_meshes(const Scene& scene) const {
    for (const auto& [index, identity] : drawn) {
        if (index >= scene.meshes.size())
            throw InvalidInput("a moved scene must have the same meshes as before");
        const Shared<Mesh>& mesh = scene.meshes[index];
        if (identity.is(mesh)) continue;
        validate(*mesh);
        for (const Draw& draw : draws) {
            if (draw.mesh == index &&
                draw.range.first_triangle + draw.range.triangle_count > mesh->triangles.size())
                throw InvalidInput("a moved mesh must have the same triangles as before");
        }
    }
}

/// Uploads the meshes that are not those of the last picture.
void PreparedScene::replace_meshes(const Scene& scene) {
    bool has_changed = false;
    for (auto& [index, identity] : drawn) {
        const Shared<Mesh>& mesh = scene.meshes.at(index);
        if (identity.is(mesh)) continue;
        Report unused;  // The findings are those of the mesh at rest.
        meshes.at(index) = cache.meshes.get(mesh, streams.at(index), unused);
        identity = mesh.identity();
        has_changed = true;
        std::erase_if(sorted, [replaced = index](const auto& entry) {
            return std::get<0>(entry.first) == replaced;
        });
        for (Draw& draw : draws) {
            if (draw.mesh == index && draw.sorted) draw.sorted = sorted_triangles(scene, draw);
        }
    }
    if (has_changed) cache.meshes.drop_unused();
}

/// Returns the triangles of a blended draw at their deformed positions. Draws of a mesh at rest
/// share them.
std::shared_ptr<SortedTriangles> PreparedScene::sorted_triangles(const Scene& scene,
                                                                 const Draw& draw) {
    if (is_deformed(draw.features)) {
        return std::make_shared<SortedTriangles>(deformed_mesh(scene, draw.instance), draw.range);
    }
    std::shared_ptr<SortedTriangles>& at_rest =
        sorted[{draw.mesh, draw.range.first_triangle, draw.range.triangle_count}];
    if (!at_rest) at_rest = std::make_shared<SortedTriangles>(scene.meshes[draw.mesh], draw.range);
    return at_rest;
}

void PreparedScene::prepare_draws(const Scene& scene, ProgressStage& stage) {
    draws.reserve(plan.draws.size());
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        if (plan.draws[i].range.triangle_count == 0) continue;
        check_cancelled();
        lights.add(api, scene, plan.draws[i].features);
        triangle_total += plan.draws[i].range.triangle_count;
        draws.push_back(prepare_draw(scene, i));
        stage.advance(1);
    }
    // Adjacent draws with the same program need no program change. The depth buffer hides the
    // order.
    std::stable_sort(draws.begin(), draws.end(), [](const Draw& a, const Draw& b) {
        if (is_blended(a) != is_blended(b)) return is_blended(b);
        return a.features < b.features;
    });
    upload_poses(scene);
}

Surface PreparedScene::prepare_surface(const Scene& scene, const Planned& p) {
    Surface surface;
    surface.both_sides = p.material.double_sided;
    surface.casts_shadow = casts_shadow(p.material);
    set_material(surface.values, p.material, scene, picture.last_level());
    if (p.features.sheen_roughness_texture &&
        p.material.metallic_roughness->sheen_roughness_texture)
        surface.values.sheen_albedo_rows =
            cache.sheens.get(p.material.metallic_roughness->sheen_roughness);
    set_environment_values(surface.values);
    bind_planned_textures(surface, p);
    return surface;
}

Draw PreparedScene::prepare_draw(const Scene& scene, std::size_t planned_draw) {
    const DrawPlan& plan_of_draw = plan.draws[planned_draw];
    const Planned p = planned(scene, plan_of_draw);
    const Instance& instance = scene.instances[plan_of_draw.instance];
    Draw draw;
    draw.program = linked.get(p.features);
    programs.insert(p.features);
    draw.features = p.features;
    draw.planned = planned_draw;
    draw.instance = plan_of_draw.instance;
    draw.mesh = instance.mesh;
    draw.range = plan_of_draw.range;
    draw.world_from_object = instance.world_from_object;
    const SurfaceKey key(draw.mesh, draw.range.material, p.features);
    auto shared = surfaces.find(key);
    if (shared == surfaces.end()) shared = surfaces.emplace(key, prepare_surface(scene, p)).first;
    draw.surface = &shared->second;
    if (p.features.vertex_occlusion && !open_shares.contains(draw.instance)) {
        open_shares.emplace(
            draw.instance, GpuOpenShares(api, p.mesh, *meshes.at(draw.mesh), instance.open_shares));
    }
    if (is_blended(draw)) draw.sorted = sorted_triangles(scene, draw);
    return draw;
}

/// Switches draws to the programs for the poses of the scene: a mesh that returns to rest is drawn
/// without deformation again.
void PreparedScene::follow_poses(const Scene& scene) {
    plan_pose(scene, plan);
    for (Draw& draw : draws) {
        const Features& features = plan.draws[draw.planned].features;
        const bool was_deformed = is_deformed(draw.features);
        if (draw.features != features) {
            draw.program = linked.get(features);
            programs.insert(features);
            draw.features = features;
        }
        if (draw.sorted && (was_deformed || is_deformed(features)))
            draw.sorted = sorted_triangles(scene, draw);
    }
    upload_poses(scene);
}

/// Uploads joint matrices and morph weights, and on first use what they deform.
void PreparedScene::upload_poses(const Scene& scene) {
    std::map<std::size_t, PlannedDeformation> planned;
    for (const Draw& draw : draws) {
        if (is_deformed(draw.features)) planned[draw.instance].add(draw.program->planned);
    }
    std::erase_if(poses, [&](const auto& entry) { return !planned.contains(entry.first); });
    for (const auto& [index, needs] : planned) {
        const Instance& instance = scene.instances[index];
        const MeshPose* const pose = instance.pose ? &*instance.pose : nullptr;
        std::shared_ptr<const GpuDeformation> vertices;
        if (pose != nullptr) {
            vertices = cache.meshes.get(scene.meshes[instance.mesh], meshes.at(instance.mesh),
                                        *pose, needs);
        }
        poses[index].update(api, std::move(vertices), pose);
    }
}

void PreparedScene::bind_planned_textures(Surface& surface, const Planned& p) {
    for (const UsedTexture& used : used_textures(p.features, p.material, p.mesh)) {
        BoundTexture& bound = surface.textures[static_cast<std::size_t>(used.slot)];
        if (used.texture == nullptr) {
            bound = neutral_texture(cache.textures, slot_info(used.slot).neutral);
            continue;
        }
        const ImagePurpose purpose = purpose_of(used);
        bound = textures.bound(*used.texture, purpose);
        if (purpose.normals) {
            set_planned_map(surface.values, used.slot, p.material,
                            textures.image(used.texture->image, purpose));
        }
    }
}

void PreparedScene::set_environment_values(DrawValues& values) const {
    values.blurred_levels = environment->blurred_levels();
    values.irradiance_sh = environment->irradiance_sh();
}

void PreparedScene::move(const Scene& scene) {
    replace_meshes(scene);
    lights.update(api, scene);
    prepare_shadow(scene);
    for (Draw& draw : draws)
        draw.world_from_object = scene.instances[draw.instance].world_from_object;
    follow_poses(scene);
    if (overlays) overlays->move(scene);
}

void PreparedScene::bind_textures(const Draw& draw) const {
    const auto& textures_of_draw = draw.surface->textures;
    for (std::size_t i = 0; i < textures_of_draw.size(); ++i) {
        if (textures_of_draw[i].texture == 0) continue;
        api->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        api->BindTexture(GL_TEXTURE_2D, textures_of_draw[i].texture);
        api->BindSampler(static_cast<GLuint>(i), textures_of_draw[i].sampler);
    }
    lights.bind(api, draw.features);
    if (const auto pose = poses.find(draw.instance); pose != poses.end()) pose->second.bind(api);
    if (draw.features.vertex_occlusion) open_shares.at(draw.instance).bind(api);
}

void PreparedScene::set_state(const Draw& draw) const {
    if (draw.surface->both_sides) {
        api->Disable(GL_CULL_FACE);
    } else {
        api->Enable(GL_CULL_FACE);
    }
    // A mirroring matrix reverses the winding, but not the front of a surface.
    api->FrontFace(mirrors(draw.world_from_object) ? GL_CW : GL_CCW);
}

/// Sets the uniforms of a draw.
/// \param eye_world  homogeneous_eye(), or the light of a shadow map; none: it is not set
void PreparedScene::use_program(const DrawProgram& program, const Draw& draw,
                                const glm::dmat4& to_clip,
                                const std::optional<glm::vec4>& eye_world) const {
    DrawValues values = draw.surface->values;
    set_place(values, draw.world_from_object);
    set_shadow(values, shadow, draw.world_from_object);
    values.clip_from_object = glm::mat4(to_clip * glm::dmat4(values.world_from_object));
    values.clip_from_world = glm::mat4(to_clip);
    if (eye_world) values.eye_world = *eye_world;
    if (const auto pose = poses.find(draw.instance); pose != poses.end()) {
        values.joint_pairs = pose->second.joint_pairs();
        values.morph_layout = pose->second.morph_layout();
    }
    program.linked.use();
    for (const std::string& name : program.planned.uniforms)
        set_uniform(program.linked, name, values);
}

void PreparedScene::issue(Draw& draw, const glm::dmat4& to_clip, const Camera& camera) {
    use_program(*draw.program, draw, to_clip, homogeneous_eye(camera));
    bind_textures(draw);
    set_state(draw);
    if (!draw.sorted) {
        draw_range(draw);
        return;
    }
    const glm::vec3 farther_world(-camera.world_from_view[2]);
    const glm::vec3 farther_object =
        glm::transpose(glm::mat3(draw.world_from_object)) * farther_world;
    meshes.at(draw.mesh)->draw(api, draw.sorted->sort(farther_object));
}

/// Draws the triangles of an opaque draw in pieces, after which the operation can be cancelled.
void PreparedScene::draw_range(const Draw& draw) {
    const GpuMesh& mesh = *meshes.at(draw.mesh);
    MaterialRange piece = draw.range;
    const std::uint32_t end = piece.first_triangle + piece.triangle_count;
    for (; piece.first_triangle < end; piece.first_triangle += piece.triangle_count) {
        const std::uint32_t rest = end - piece.first_triangle;
        piece.triangle_count =
            is_cancellable() ? std::min(rest, triangles_per_piece - unfinished_triangles) : rest;
        mesh.draw(api, piece);
        if (!is_cancellable()) continue;
        unfinished_triangles += piece.triangle_count;
        if (unfinished_triangles < triangles_per_piece) continue;
        api->Finish();
        check_cancelled();
        unfinished_triangles = 0;
    }
}

/// Returns the rows of the picture after which the operation can be cancelled.
int PreparedScene::rows_per_band() const {
    if (!is_cancellable()) return picture.height();
    const std::size_t samples = picture.sample_total();
    const std::size_t bands =
        std::clamp<std::size_t>(samples / (samples_per_triangle * triangle_total + 1), 1,
                                std::max<std::size_t>(samples / samples_per_band, 1));
    const int tiles = picture.height() / rows_per_tile / static_cast<int>(bands);
    return bands == 1 ? picture.height() : std::max(tiles, 1) * rows_per_tile;
}

/// Calls a function that draws the whole picture for each band of rows.
void PreparedScene::in_bands(const std::function<void()>& draw_band) {
    const int rows = rows_per_band();
    if (rows >= picture.height()) {
        draw_band();
        return;
    }
    const Scissor scissor(api);
    for (int first = 0; first < picture.height(); first += rows) {
        scissor.set(first, picture.width(), std::min(rows, picture.height() - first));
        draw_band();
        api->Finish();
        check_cancelled();
    }
}

/// Draws blended surfaces over all others, farthest center first, without writing depth.
void PreparedScene::issue_blended(const glm::dmat4& to_clip, const Camera& camera) {
    const auto depth = [&](const Draw& draw) {
        const glm::vec3 center(draw.world_from_object * glm::vec4(draw.sorted->center(), 1.0F));
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
void PreparedScene::count_fragments() const {
    api->ClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    api->Clear(GL_COLOR_BUFFER_BIT);
    api->Disable(GL_DEPTH_TEST);
    api->Enable(GL_BLEND);
    api->BlendEquation(GL_FUNC_ADD);
    api->BlendFuncSeparate(GL_ONE, GL_ONE, GL_ZERO, GL_ONE);
}

void PreparedScene::draw_overlays(const glm::dmat4& to_clip) const {
    std::vector<OverlaySurface> drawn_surfaces;
    for (const Draw& draw : draws) {
        const auto pose = poses.find(draw.instance);
        drawn_surfaces.push_back({meshes.at(draw.mesh).get(), draw.range, draw.world_from_object,
                                  draw.surface->both_sides, mirrors(draw.world_from_object),
                                  draw.features.alpha == AlphaMode::opaque, draw.features.morphing,
                                  draw.features.skinning,
                                  pose == poses.end() ? nullptr : &pose->second});
    }
    picture.bind_finished();
    overlays->draw(to_clip, drawn_surfaces);
}

void PreparedScene::prepare_shadow(const Scene& scene) {
    if (!plan.shadow_maps) return;
    shadow = shadow_view(scene);
    has_old_shadow = shadow.has_value();
    if (!shadow) return;
    const int layers = static_cast<int>(shadow->points.size());
    if (!shadow_maps || shadow_maps->layers() != layers || shadow_maps->width() != shadow->texels)
        shadow_maps.emplace(api, shadow->texels, layers);
}

/// Draws both sides of all surfaces that cast shadows into the maps. Their programs compute
/// positions, the holes of masks and the depth of reliefs only.
void PreparedScene::draw_shadow_maps() {
    has_old_shadow = false;
    std::vector<std::pair<const Draw*, std::shared_ptr<const DrawProgram>>> casting;
    for (const Draw& draw : draws) {
        if (!draw.surface->casts_shadow) continue;
        casting.emplace_back(&draw, linked.get(casting_features(draw.features)));
    }
    api->ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    api->Disable(GL_CULL_FACE);
    for (std::size_t i = 0; i < shadow->points.size(); ++i) {
        shadow_maps->begin(static_cast<int>(i));
        const glm::dmat4 to_clip = shadow->clip_from_world(shadow->points[i]);
        const glm::vec4 light_world(shadow->homogeneous_light(shadow->points[i]));
        for (const auto& [draw, program] : casting) {
            use_program(*program, *draw, to_clip, light_world);
            bind_textures(*draw);
            meshes.at(draw->mesh)->draw(api, draw->range);
        }
    }
    api->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void PreparedScene::draw_frame(const Camera& camera) {
    api->Disable(GL_BLEND);
    api->Enable(GL_DEPTH_TEST);
    api->DepthFunc(GL_LEQUAL);
    api->CullFace(GL_BACK);
    set_attribute_constants(api);
    if (has_old_shadow) draw_shadow_maps();
    unfinished_triangles = 0;
    environment->bind(api);
    if (shadow) {
        api->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(TextureUnit::shadow_maps));
        api->BindTexture(GL_TEXTURE_2D_ARRAY, shadow_maps->texture().name());
        api->BindSampler(static_cast<GLuint>(TextureUnit::shadow_maps), 0);
    }
    const glm::dmat4 to_clip = clip_from_world(camera, static_cast<double>(picture.aspect()));
    in_bands([&] {
        picture.begin();
        if (counts_fragments) count_fragments();
        for (Draw& draw : draws) {
            if (is_covering(draw)) issue(draw, to_clip, camera);
        }
        if (skybox) {
            api->Disable(GL_CULL_FACE);
            skybox->draw(api, camera, picture.aspect());
        }
    });
    if (plan.transmission_background) {
        picture.copy_behind();
        in_bands([&] {
            for (Draw& draw : draws) {
                if (!is_covering(draw) && !is_blended(draw)) issue(draw, to_clip, camera);
            }
        });
    }
    if (plan.sorted_blending) in_bands([&] { issue_blended(to_clip, camera); });
    if (counts_fragments) api->Disable(GL_BLEND);
    in_bands([&] { picture.finish(); });
    if (overlays) draw_overlays(to_clip);
    api.check("drawing the scene");
}

namespace {

/// Plans a scene after validation.
FramePlan planned_view(const Scene& scene, const FrameSettings& settings, Report& report) {
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

}  // namespace

FramePlan detail::checked_plan(const Scene& scene, FramePlan plan, const FrameSettings& settings,
                               Report& report) {
    validate(scene);
    for (DrawPlan& draw : plan.draws) {
        check_draw(scene, draw);
        draw.features = canonical(draw.features);
        plan.sorted_blending |= draw.features.alpha == AlphaMode::blend;
        plan.transmission_background |= transmits(draw.features);
        plan.shadow_maps |= draw.features.shadow != ShadowTerm::none;
    }
    plan.finishing_pass |=
        plan.sorted_blending || plan.transmission_background || settings.samples > 1;
    for (DrawPlan& draw : plan.draws) {
        draw.features.output = drawn_coding(settings, plan.finishing_pass);
        draw.features = canonical(draw.features);
    }
    return plan_view(scene, settings, std::move(plan), report);
}

struct Renderer::Implementation : PreparedScene {
    using PreparedScene::PreparedScene;
};

Renderer::Renderer(const Context& context, const Scene& scene, const FrameSettings& settings,
                   Report& report)
    : implementation_(
          std::make_unique<Implementation>(context, scene, planned_view(scene, settings, report),
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
            "a moved scene must have the same numbers of instances and lights as before");
    }
    implementation_->check_meshes(scene);
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
    implementation_->sheens.drop_unused();
}

void RenderCache::drop_programs() {
    implementation_->programs.clear();
}

RenderCache::Contents RenderCache::contents() const {
    return {implementation_->programs.size(), implementation_->meshes.size(),
            implementation_->textures.size(), implementation_->environments.size(),
            implementation_->targets.size()};
}

}  // namespace relief::shade
