// SPDX-License-Identifier: Apache-2.0
/// \file
/// Plans effects: decides which effects a scene requires, and why. Pure: no OpenGL, no files.
///
/// Every draw (one material range of one instance) gets a Features value. It names everything that
/// its program, vertex streams and textures contain; an omitted effect has no code, no uniform, no
/// memory and no time. Omitting an effect never changes a pixel, because an effect is omitted only
/// if its contribution is exactly zero (force_effects() can add it anyway).
/// Tests: tests/shade/effects/, tests/shade/render/forced_effects_test.cpp,
/// tests/shade/effects/effects_test.cpp, tests/shade/effects/shader_source_test.cpp.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"
#include "relief/shade/shader_texts.h"

namespace RELIEF_API relief {
namespace shade {

/// The map that perturbs the normal.
enum class NormalDetail : std::uint8_t { none, normal_map, object_normal_map, bump_map };

/// The method by which heights displace what a surface shows along the view: HeightMethod, or none.
enum class DepthMapping : std::uint8_t {
    none,
    parallax,
    parallax_occlusion,
    relief_mapping,
    relaxed_cones,
    maximum_mipmaps,
};

enum class SpecularTerm : std::uint8_t { none, phong, blinn_phong };

/// The reflection of the environment.
enum class ReflectionTerm : std::uint8_t {
    none,
    mirror,
    glossy,  ///< Blurred, from a prefiltered chain of mip levels.
};

/// The reflectance as a function of the angle.
enum class FresnelTerm : std::uint8_t { constant, schlick, dielectric, conductor };

/// The falloff of point and spot lights with distance.
enum class FalloffTerm : std::uint8_t {
    inverse_square,
    none,
    mixed,  ///< Some lights have a falloff and some do not.
};

/// The kind of the light that casts a shadow: the first one of its kind that shines.
enum class ShadowTerm : std::uint8_t { none, directional_light, spot_light, point_light };

/// The effects of one draw. Two draws with equal Features share one program.
struct Features {
    // The reflection model and its interpolation.
    bool unlit = false;  ///< The picture shows the diffuse color without lighting.
    bool metallic_roughness = false;
    /// Dielectrics reflect another share than 4% (KHR_materials_ior, KHR_materials_specular).
    bool dielectric_reflectance = false;
    bool specular_weight_texture = false;
    bool specular_color_texture = false;
    bool energy_compensation = false;  ///< Light that bounces between facets is kept.
    bool sheen = false;                ///< KHR_materials_sheen
    bool sheen_color_texture = false;
    bool sheen_roughness_texture = false;
    bool clearcoat = false;  ///< KHR_materials_clearcoat
    bool clearcoat_texture = false;
    bool clearcoat_roughness_texture = false;
    bool clearcoat_normal_map = false;
    bool anisotropy = false;  ///< KHR_materials_anisotropy
    bool anisotropy_texture = false;
    bool iridescence = false;  ///< KHR_materials_iridescence
    bool iridescence_texture = false;
    bool film_thickness_texture = false;
    bool transmission = false;  ///< KHR_materials_transmission
    bool transmission_texture = false;
    bool volume = false;      ///< KHR_materials_volume
    bool dispersion = false;  ///< KHR_materials_dispersion
    bool thickness_texture = false;
    /// The textures that are looked up at the second texture coordinates: 1 << TextureSlot for
    /// each.
    std::uint32_t second_texcoords = 0;
    Interpolation interpolation = Interpolation::per_pixel;
    // The deformation of the mesh, in the vertex stage.
    bool morphing = false;         ///< Displacements of morph targets are added.
    bool skinning = false;         ///< Joints move the vertices.
    bool deformed_facets = false;  ///< Flat normals, those of the deformed triangles.
    // Factors of the colors.
    bool diffuse_texture = false;
    bool specular_texture = false;
    bool metallic_roughness_texture = false;
    bool occlusion_texture = false;
    bool vertex_colors = false;
    // Coverage.
    AlphaMode alpha = AlphaMode::opaque;
    bool opacity_texture = false;
    // The normal.
    NormalDetail detail = NormalDetail::none;
    TangentFrame frame = TangentFrame::stored;  ///< For tangent-space maps and anisotropy.
    bool specular_antialiasing = false;
    bool double_sided = false;  ///< Back faces have the opposite normal.
    // The displacement of texture coordinates along the view.
    DepthMapping depth_mapping = DepthMapping::none;
    Wrap height_wrap_u = Wrap::repeat;  ///< Of the height map, where the program computes with it.
    Wrap height_wrap_v = Wrap::repeat;
    bool self_shadow = false;     ///< The relief hides light from its own points.
    bool clipped_relief = false;  ///< Nothing is drawn where the view leaves a map that is clamped.
    bool curved_relief = false;   ///< The relief curves with the surface, and ends at its outline.
    bool written_depth = false;   ///< The depth buffer gets the depth of the relief.
    /// Shadow maps hold the depth of the relief, and its points look them up.
    bool displaced_shadow = false;
    // Light.
    bool ambient = false;
    std::uint32_t directional_lights = 0;
    std::uint32_t point_lights = 0;
    std::uint32_t spot_lights = 0;
    FalloffTerm falloff = FalloffTerm::inverse_square;
    bool light_ranges = false;      ///< Some point or spot light has a range.
    bool highlight_colors = false;  ///< Some light's highlights differ from its color.
    bool lights_in_buffer = false;  ///< Too many for a uniform block.
    bool environment_diffuse = false;
    bool diffuse = false;                        ///< Light of light sources is scattered.
    SpecularTerm specular = SpecularTerm::none;  ///< Phong's model only.
    bool highlight_fresnel = false;
    bool emission = false;
    bool emission_texture = false;
    // The environment in the surface.
    ReflectionTerm reflection = ReflectionTerm::none;
    FresnelTerm fresnel = FresnelTerm::constant;  ///< Phong's model only.
    bool reflection_by_normal = false;            ///< Phong's model only.
    bool environment_tint = false;                ///< Phong's model only.
    bool refraction = false;
    bool environment_rotation = false;
    // The picture.
    OutputCoding output = OutputCoding::srgb;
    ToneMapping tone_mapping = ToneMapping::none;
    bool exposure = false;
    DebugView view = DebugView::picture;
    ShadowTerm shadow = ShadowTerm::none;  ///< Surfaces hide one of the lights.
    bool vertex_occlusion = false;         ///< Light from all around is dimmed by vertex.
    bool clamped_terms = false;            ///< Phong's model only: Scene::clamp_terms.

    friend auto operator<=>(const Features&, const Features&) = default;
};

/// Describes features for messages: "normal map, 2 directional lights, diffuse, Blinn-Phong, sRGB".
std::string describe(const Features& features);

/// One effect, on or off, and the reason, which names the object that decides.
struct EffectReason {
    std::string effect;  ///< "normal map"
    bool on = false;
    std::string reason;  ///< "material 'body' has one and the mesh has texture coordinates"
};

/// The reasons for the effects of one draw. Equal draws share them until they are edited, because
/// they need some kilobytes.
class EffectReasons : public Shared<std::vector<EffectReason>> {
  public:
    using Shared::Shared;

    [[nodiscard]] auto begin() const { return (**this).begin(); }
    [[nodiscard]] auto end() const { return (**this).end(); }
    [[nodiscard]] std::size_t size() const { return (**this).size(); }
};

/// The effects of one draw, and the reasons.
struct DrawPlan {
    std::size_t instance = 0;
    MaterialRange range;
    Features features;
    EffectReasons reasons;
    bool needs_tangents = false;  ///< The draw needs them and the mesh has none.
    /// plan_pose() decides how the mesh is deformed. False if that was forced.
    bool follows_pose = true;
};

/// The whole frame.
struct FramePlan {
    std::vector<DrawPlan> draws;
    bool environment_map = false;         ///< Decoded and uploaded.
    bool prefiltered_map = false;         ///< Its mip levels for glossy reflections.
    bool environment_brdf = false;        ///< The table of GGX's directional albedo.
    bool environment_irradiance = false;  ///< Its spherical harmonics.
    bool skybox = false;
    bool blurred_skybox = false;           ///< The skybox shows the prefiltered map.
    bool transmission_background = false;  ///< A copy of what is behind transmissive surfaces.
    bool sorted_blending = false;          ///< Blended draws last, farthest triangle first.
    bool finishing_pass = false;           ///< Averages and codes the drawn samples.
    std::vector<EffectReason> reasons;     ///< Those of the frame-wide effects.
    bool shadow_maps = false;              ///< The surfaces as the main light sees them.
};

/// Returns the canonical effects of a draw of this material and mesh in this scene, at rest.
Features features_of(const Scene& scene, const Material& material, const Mesh& mesh,
                     OutputCoding output = OutputCoding::srgb);

/// Plans the whole scene, which must be valid.
FramePlan plan_effects(const Scene& scene, const FrameSettings& settings);

/// Decides again how meshes are deformed, and why, after the poses of the scene's instances
/// changed. All else stays unchanged. Renderer::move() calls this itself.
void plan_pose(const Scene& scene, FramePlan& plan);

/// Updates the frame-wide effects after the features of draws were changed.
void plan_frame(const Scene& scene, const FrameSettings& settings, FramePlan& plan);

/// Returns the plan of the settings' debug view: every draw shows the view, without effects that
/// the view does not need. The plan does not change if the view is the picture. Renderer calls this
/// itself.
///
/// \param report  counts draws that have nothing to show in this view
/// \throws InvalidInput if no draw has anything to show, with the reason
FramePlan plan_view(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                    Report& report = IgnoredReport());

/// Removes effects that are invisible: normals without light, normal maps without normals, and so
/// on. features_of() already returns canonical values; canonical(canonical(f)) == canonical(f).
Features canonical(Features features);

/// An effect as users name it.
struct Effect {
    const char* name;
    /// Returns true if these features have it.
    bool (*on)(const Features& features);
    /// Switches it on, with the fewest other effects, or off; the result is not canonical.
    void (*set)(Features& features, bool on);
    /// The reason why canonical() drops it.
    const char* hidden;
};

/// All effects of draws, in the order of the plan's reasons.
const std::vector<Effect>& effects();

/// The inputs of a draw's program by GLSL name, each list sorted.
struct PlannedInterface {
    std::vector<std::string> attributes;
    std::vector<std::string> uniforms;
    std::vector<std::string> uniform_blocks;
    std::vector<std::string> samplers;

    friend bool operator==(const PlannedInterface&, const PlannedInterface&) = default;
};

/// Returns the inputs of the program for these features: exactly those that are active after
/// linking.
PlannedInterface planned_interface(const Features& features);

/// The material of meshes that name no material.
const Material& default_material();

// Effects can be forced on or off by name, independent of the scene.
//
// An effect that is forced on without anything to show is neutral: its values are zero, its
// texture is white, its lights are black, and the picture does not change by a bit. Effects
// without a neutral form are properties of the scene and are refused: the reflection model and
// interpolation (unlit, metallic-roughness, Gouraud, flat), the meaning of maps (object-space
// normal maps, derivative frames, antialiasing of an existing map), facets that are deformed,
// blending, transmission, the falloff of existing lights, the exact Fresnel term of an existing
// reflection, tone curves, and whether the environment is visible or lights surfaces. Any effect
// can be forced off, which changes the picture.

/// The effects before single ones are forced.
enum class EffectBase {
    planned,      ///< The effects that the scene requires.
    all_neutral,  ///< These, and on every draw all effects that change no pixel there.
    nothing,      ///< No effects; effects that are forced on have the values of the scene.
};

/// One effect by name (effects(), or a frame-wide one of FramePlan::reasons). Case and separators
/// do not matter: "normal map", "Normal-Map".
struct ForcedEffect {
    std::string name;
    bool on = true;
};

struct EffectRequest {
    EffectBase base = EffectBase::planned;
    std::vector<ForcedEffect> forced;
};

/// Forces effects on and off on every draw of a plan, and updates their reasons.
///
/// \param plan  of this scene and these settings
/// \return a plan for Renderer. An effect that is forced on shows on every draw that can have it;
///         the reasons of the other draws explain why they cannot
/// \throws InvalidInput if there is no effect of a name (similar names are suggested), one name is
///         forced both ways, two effects exclude each other, or no draw can have an effect: the
///         message names effect, material and reason
FramePlan force_effects(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                        const EffectRequest& requests);

/// Returns the effects that are on in any draw of a plan, and "skybox": those that can be forced
/// off.
std::vector<std::string> effects_in(const FramePlan& plan);

/// One stream of vertices.
struct PlannedAttribute {
    std::string name;     ///< GLSL: "tangent_object".
    bool stored = false;  ///< Otherwise it is computed, or a constant.
    std::string reason;
};

/// One texture that a draw samples.
struct PlannedTexture {
    std::string sampler;     ///< GLSL: "normal_texture".
    std::string image;       ///< The name of its source; empty for relief's own.
    bool mip_chain = false;  ///< It has smaller levels for minification.
    std::string reason;
};

struct DrawInputs {
    std::vector<PlannedAttribute> attributes;
    std::vector<PlannedTexture> textures;
};

/// Returns the inputs of a draw's program: the attributes and samplers of planned_interface().
DrawInputs planned_inputs(const Scene& scene, const DrawPlan& draw);

/// A pass of a frame, with its reason.
struct PlannedPass {
    std::string name;
    std::string reason;
};
std::vector<PlannedPass> planned_passes(const FramePlan& plan);

/// One program, assembled from the files in shaders/.
struct ShaderListing {
    Features features;
    std::vector<std::size_t> draws;  ///< Indices of the draws that use it.
    std::string vertex;              ///< GLSL.
    std::string fragment;
    std::vector<std::string> files;  ///< Parts of both stages, such as "light.glsl#point"; sorted.
};

/// Returns one entry per program, in the order of the first draw that uses it.
/// \param texts  replace parts of the shaders
/// \throws GpuError if a file of `texts` or $RELIEF_SHADER_DIR includes a missing part
std::vector<ShaderListing> shader_listings(const FramePlan& plan, const ShaderTexts& texts = {});

}  // namespace shade
}  // namespace relief
