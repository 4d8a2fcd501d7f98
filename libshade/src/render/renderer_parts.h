// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of a renderer: its draws, the values and textures that they share, and the resources
/// of its passes. Beside the renderer itself, the recorder of pages (src/page/) reads it. Tests:
/// tests/shade/render/renderer_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "effects/features.h"
#include "effects/light_rows.h"
#include "gl/resources.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"
#include "render/draw_values.h"
#include "render/environment.h"
#include "render/gpu_mesh.h"
#include "render/overlays.h"
#include "render/picture.h"
#include "render/program_cache.h"
#include "render/textures.h"

namespace relief::shade {

/// The resources that renderers of one context share.
struct RenderCache::Implementation {
    explicit Implementation(const gl::Api& api)
        : programs(api), meshes(api), textures(api), environments(api), targets(api) {}

    detail::ProgramCaches programs;
    detail::MeshCache meshes;
    detail::TextureCache textures;
    detail::EnvironmentCache environments;
    detail::TargetPool targets;
    detail::SheenCache sheens;
};

namespace detail {

/// The values and textures that the draws of a mesh with one material and the same effects share.
struct Surface {
    DrawValues values;  ///< Without those of instances and cameras.
    std::array<BoundTexture, texture_slot_count> textures;  ///< By TextureSlot.
    bool both_sides = false;
    bool casts_shadow = false;
};

/// The mesh, the material and the planned effects.
using SurfaceKey = std::tuple<std::size_t, std::optional<std::uint32_t>, Features>;

/// The resources and state of a draw. There may be hundreds of thousands.
struct Draw {
    std::shared_ptr<const DrawProgram> program;
    Features features;
    std::size_t planned = 0;  ///< Index into the draws of the plan.
    std::size_t instance = 0;
    std::size_t mesh = 0;
    MaterialRange range;
    const Surface* surface = nullptr;
    glm::mat4 world_from_object{1.0F};
    std::shared_ptr<SortedTriangles> sorted;  ///< Only for blended draws.
};

/// The mesh, the first triangle and the number of triangles.
using SortedKey = std::tuple<std::size_t, std::uint32_t, std::uint32_t>;

/// The scene objects that the plan of a draw refers to.
struct Planned {
    const Features& features;
    const Material& material;
    const Mesh& mesh;
};

inline Planned planned(const Scene& scene, const DrawPlan& draw) {
    return {draw.features,
            draw.range.material ? scene.materials[*draw.range.material] : default_material(),
            scene.meshes[scene.instances[draw.instance].mesh]};
}

/// How the texture of a slot is decoded.
inline ImagePurpose purpose_of(const UsedTexture& used) {
    const TextureSlotInfo& slot = slot_info(used.slot);
    ImagePurpose purpose{slot.use, slot.neutral == NeutralTexel::flat,
                         used.slot == TextureSlot::bump || used.slot == TextureSlot::height};
    if (used.slot == TextureSlot::height)
        purpose.maxima = {used.texture->wrap_u, used.texture->wrap_v};
    return purpose;
}

inline bool is_blended(const Draw& draw) {
    return draw.features.alpha == AlphaMode::blend;
}

/// True for surfaces that are part of the transmission background.
inline bool is_covering(const Draw& draw) {
    return !is_blended(draw) && !transmits(draw.features);
}

/// A scene on the GPU, with what its passes need.
struct PreparedScene {
    /// \param given  the shared cache; null: the renderer has its own
    PreparedScene(const Context& context, const Scene& scene, FramePlan frame_plan,
                  const FrameSettings& settings, RenderCache* given, Report& report);

    void prepare_meshes(const Scene& scene, Report& report);
    void check_meshes(const Scene& scene) const;
    void replace_meshes(const Scene& scene);
    void prepare_draws(const Scene& scene, relief::detail::ProgressStage& stage);
    Surface prepare_surface(const Scene& scene, const Planned& p);
    Draw prepare_draw(const Scene& scene, std::size_t planned_draw);
    void follow_poses(const Scene& scene);
    void upload_poses(const Scene& scene);
    void bind_planned_textures(Surface& surface, const Planned& p);
    std::shared_ptr<SortedTriangles> sorted_triangles(const Scene& scene, const Draw& draw);
    void set_environment_values(DrawValues& values) const;
    void move(const Scene& scene);
    void bind_textures(const Draw& draw) const;
    void set_state(const Draw& draw) const;
    void use_program(const DrawProgram& program, const Draw& draw, const glm::dmat4& to_clip,
                     const std::optional<glm::vec4>& eye_world) const;
    void issue(Draw& draw, const glm::dmat4& to_clip, const Camera& camera);
    void draw_range(const Draw& draw);
    void in_bands(const std::function<void()>& draw_band);
    [[nodiscard]] int rows_per_band() const;
    void issue_blended(const glm::dmat4& to_clip, const Camera& camera);
    void count_fragments() const;
    void draw_overlays(const glm::dmat4& to_clip) const;
    void prepare_shadow(const Scene& scene);
    void draw_shadow_maps();
    void draw_frame(const Camera& camera);

    const gl::Api& api;
    std::unique_ptr<RenderCache> own;  ///< If none was given.
    RenderCache::Implementation& cache;
    std::shared_ptr<const ShaderTexts> shaders;  ///< Kept for the programs.
    ProgramCache& linked;
    FramePlan plan;
    std::array<std::size_t, 4> counts;
    FrameTimes times;
    Picture picture;
    std::set<Features> programs;
    SceneTextures textures;
    LightStorage lights;
    std::map<std::size_t, std::shared_ptr<GpuMesh>> meshes;  ///< Drawn meshes by index.
    std::map<std::size_t, PlannedStreams> streams;           ///< What they hold.
    std::map<std::size_t, Shared<Mesh>::Identity> drawn;     ///< The meshes that they were made of.
    std::map<SurfaceKey, Surface> surfaces;
    std::map<SortedKey, std::shared_ptr<SortedTriangles>> sorted;  ///< Of meshes at rest.
    std::vector<Draw> draws;                                       ///< Opaque ones first.
    std::map<std::size_t, GpuPose> poses;                          ///< Of deformed instances.
    std::map<std::size_t, GpuOpenShares> open_shares;              ///< Of instances that need them.
    std::optional<EnvironmentMaps> environment;
    std::optional<Skybox> skybox;
    std::unique_ptr<OverlayDrawing> overlays;  ///< If any is requested.
    bool counts_fragments;                     ///< For the overdraw view.
    std::optional<ShadowView> shadow;          ///< If the plan has shadow maps.
    std::optional<gl::DepthLayers> shadow_maps;
    bool has_old_shadow = false;             ///< The maps show an earlier scene, or none.
    std::size_t triangle_total = 0;          ///< Of all draws.
    std::uint32_t unfinished_triangles = 0;  ///< Drawn since OpenGL was waited for.
};

/// Returns the plan for a renderer, after checks that it refers to objects of the scene: with a
/// finishing pass if samples, blending or transmission need it, and changed to the view of the
/// settings. \throws InvalidInput
FramePlan checked_plan(const Scene& scene, FramePlan plan, const FrameSettings& settings,
                       Report& report);

}  // namespace detail
}  // namespace relief::shade
