// SPDX-License-Identifier: Apache-2.0
/// \file
/// Explains one pixel of the reference picture (reference.h): the surfaces that its ray meets,
/// their vectors, lights and textures, and the radiance as a sum of named terms, each a product of
/// named factors, followed by exposure, tone curve and sRGB codes.
///
/// The reference itself records all of this while it computes the pixel, so the terms are its
/// formulas and not a copy. Text, JSON and panels are drawn from the one structure Probe.
///
/// World space, linear light. The functions belong to the library relief::reference.
/// Tests: tests/shade/reference/probe_test.cpp, tests/shade/render/probe_agreement_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/material.h"
#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/reference.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
namespace shade {

// Names

/// A summand of the radiance of Material (material.h).
enum class ProbeTermKind : std::uint8_t {
    ambient,
    diffuse,
    highlight,
    environment_light,
    reflection,
    interreflection,  ///< Light that bounced between facets more than once.
    refraction,       ///< Phong's model: the refracted environment.
    transmission,     ///< glTF's model: what is behind the surface.
    emission,
    unlit,
    sheen_highlight,
    sheen_ambient,
    sheen_environment,
    coat_highlight,
    coat_ambient,
    coat_reflection,
    coat_interreflection,
    skybox,
    limit,  ///< The correction of a sum that is negative, too large or not finite.
};

struct ProbeTermInfo {
    ProbeTermKind kind;
    std::string_view name;  ///< "coat highlight"
    DebugView view;         ///< The term view that shows it; picture: none does.
};

/// All kinds of terms, in the order of the enumeration.
std::span<const ProbeTermInfo> probe_terms();
const ProbeTermInfo& probe_term_info(ProbeTermKind kind);

/// A symbol of factors, quantities and vectors, as in the formula of Material.
struct ProbeSymbol {
    std::string_view symbol;   ///< "n.l"
    std::string_view meaning;  ///< "cosine of the angle between normal and light"
    /// A factor that is 1 on most surfaces; texts omit it there.
    bool is_often_one = false;
};

/// All symbols that a probe can have.
std::span<const ProbeSymbol> probe_symbols();
/// Returns the row of a symbol of a probe.
const ProbeSymbol& probe_symbol(std::string_view symbol);

/// The part of an effect (effects.h) in a probe.
enum class ProbeRole : std::uint8_t {
    term,      ///< It adds light: `what` is the name of its term.
    factor,    ///< It changes a factor: `what` is its symbol.
    lookup,    ///< A texture: `what` is the name of its slot.
    vector,    ///< It changes a vector: `what` is its symbol.
    coverage,  ///< It changes ProbeLayer::alpha.
    picture,   ///< It changes a value of ProbePicture.
    position,  ///< It moves vertices.
    texcoord,  ///< It moves ProbeLayer::texcoord.
    storage,   ///< It changes no value: how numbers are stored or passed.
    absent,    ///< The reference does without it; the difference to the renderer shows it.
};

struct ProbeEffect {
    std::string_view effect;  ///< A name of effects().
    ProbeRole role;
    std::string_view what = "";
};

/// The part of each effect of effects(). A test requires a row for every effect.
std::span<const ProbeEffect> probe_effects();

// The description of a pixel

/// A named number or color.
struct ProbeFactor {
    ProbeFactor(std::string_view name, double number)
        : symbol(name), value(number), is_scalar(true) {}
    ProbeFactor(std::string_view name, const glm::dvec3& color) : symbol(name), value(color) {}

    std::string_view symbol;  ///< One of probe_symbols().
    glm::dvec3 value;
    bool is_scalar = false;  ///< The three channels are one number.
};

enum class ProbeLightKind : std::uint8_t { directional, point, spot };
std::string_view to_string(ProbeLightKind kind);

/// A light at a point of a surface. A light that is off, or touches the point, is absent.
struct ProbeLight {
    ProbeLightKind kind = ProbeLightKind::directional;
    std::size_t index = 0;                 ///< In its list of the scene.
    std::optional<std::size_t> corner;     ///< At this corner of the triangle (Gouraud shading).
    double n_dot_l = 0.0;                  ///< Not positive: the light is behind the surface.
    glm::dvec3 intensity{0.0};             ///< Of the light; irradiance over pi if directional.
    double falloff = 1.0;                  ///< With distance and range.
    double cone = 1.0;                     ///< The share within a spot light's cone.
    double shadow = 1.0;                   ///< The share that no surface hides.
    glm::dvec3 irradiance{0.0};            ///< L: the product, at most max_light.
    glm::dvec3 highlight_irradiance{0.0};  ///< H
};

/// A vector at a point, in four spaces.
struct ProbeVector {
    std::string_view symbol;            ///< One of probe_symbols().
    std::optional<std::size_t> light;   ///< Index into ProbeLayer::lights, for l, h and r.
    std::optional<std::size_t> corner;  ///< As ProbeLight::corner.
    glm::dvec3 world{0.0};              ///< Unit, or zero if undefined.
    /// Unit: directions by the inverse matrix of the instance, normals by its transpose, so that
    /// they are normals there too. Zero if the matrix is singular.
    glm::dvec3 object{0.0};
    glm::dvec3 camera{0.0};
    /// The components along the surface's unit vectors t, b and n0; absent without such a frame.
    std::optional<glm::dvec3> tangent;
};

/// A lookup in a texture.
struct ProbeLookup {
    std::size_t image = 0;  ///< Index into Scene::images.
    ImageUse use = ImageUse::color;
    std::vector<TextureSlot> slots;  ///< The slots of the material that share this lookup.
    bool second_texcoords = false;
    TextureFilter filter = TextureFilter::linear;
    glm::ivec2 size{0};  ///< Of the image in texels.
    glm::dvec2 texcoord{0.0};
    glm::dvec2 texel{0.0};  ///< texcoord times size; texel centers are at halves.
    /// The way of the lookup in texels to the pixel on the right and to the one below, on the plane
    /// of the triangle; absent if that plane is seen edge-on.
    std::optional<glm::dvec2> texels_right;
    std::optional<glm::dvec2> texels_down;
    glm::dvec4 value{0.0};  ///< Decoded and filtered.

    /// Returns the longer and the shorter axis of the pixel's ellipse in the texture, in texels;
    /// zero if they are unknown.
    [[nodiscard]] glm::dvec2 footprint() const;
};

/// The fate of a surface on the pixel's ray.
enum class ProbeOutcome : std::uint8_t {
    shown,        ///< It adds its light.
    culled,       ///< Its back, which single-sided materials do not show.
    cut_out,      ///< Its alpha is below the cutoff of an alpha mask.
    transparent,  ///< It is blended with alpha 0.
};
std::string_view to_string(ProbeOutcome outcome);

/// A surface that the ray meets.
struct ProbeLayer {
    ProbeOutcome outcome = ProbeOutcome::shown;
    ReferenceHit hit;
    std::optional<std::size_t> material;  ///< Index into Scene::materials; none: the default.
    glm::dvec3 barycentric{0.0};
    double depth = 0.0;  ///< Distance along the camera's -z.
    // The following members are set only if the surface is not culled.
    double alpha = 1.0;     ///< As Material says, whatever its mode.
    double coverage = 1.0;  ///< By its mode.
    double share = 0.0;     ///< Of the pixel: the coverage times what nearer surfaces leave.
    glm::dvec3 position_world{0.0};
    glm::dvec3 position_object{0.0};
    glm::dvec3 position_camera{0.0};
    std::optional<glm::dvec2> texcoord;
    std::optional<glm::dvec2> texcoord_2;
    std::vector<ProbeVector> vectors;
    std::vector<ProbeLight> lights;
    std::vector<ProbeLookup> lookups;
};

/// A summand of the pixel's radiance.
struct ProbeTerm {
    ProbeTermKind kind = ProbeTermKind::limit;
    std::optional<std::size_t> layer;  ///< Index into Probe::layers; none: the skybox.
    std::optional<std::size_t> light;  ///< Index into that layer's lights.
    /// Their product is the value, apart from rounding (term_rounding). A clamp is the factor that
    /// it amounts to.
    std::vector<ProbeFactor> factors;
    std::vector<ProbeFactor> quantities;  ///< Intermediate values of the factors.
    glm::dvec3 value{0.0};
};

/// From radiance to the picture's code, step by step.
struct ProbePicture {
    glm::dvec3 exposed{0.0};   ///< radiance * exposure, at most the largest float.
    glm::dvec3 toned{0.0};     ///< By the tone curve, at most 1.
    glm::dvec4 composed{0.0};  ///< Over the background.
    glm::dvec4 codes{0.0};     ///< sRGB codes and alpha, 0 to 255, not rounded.
};

/// The relative error of a sum of terms, and of a product of factors: the rounding of double, which
/// depends on the order of operations.
inline constexpr double term_rounding = 1e-12;

struct Probe {
    int width = 0;
    int height = 0;
    int x = 0;
    int y = 0;  ///< From the top.
    DebugView view = DebugView::picture;
    /// As in Reference::edges: rounding may decide the color, or OpenGL averages a texture.
    bool is_edge = false;
    std::vector<ProbeLayer> layers;  ///< Nearest first; none behind a surface that hides the rest.
    std::vector<ProbeTerm> terms;    ///< By layer, and in the order of their kinds.
    /// The sum of the terms: the pixel of Reference::radiance in double, alpha not multiplied in.
    glm::dvec3 radiance{0.0};
    double alpha = 0.0;                          ///< The coverage of the background.
    glm::dvec3 direction_world{0.0, 0.0, -1.0};  ///< Of the ray; unit.
    glm::dvec4 background{0.0};                  ///< Scene::background.
    double exposure = 1.0;
    ToneMapping tone_mapping = ToneMapping::none;
    ProbePicture picture;
};

/// Explains pixels of one picture as the reference renders them: by one ray through the center of
/// the pixel. Multisampled pictures average several such samples at edges; the probe explains the
/// one at the center.
class Prober {
  public:
    /// Prepares a picture.
    /// \param scene  must outlive the prober and not change
    /// \param report  as in render_reference()
    /// \throws InvalidInput, FileError as render_reference() does
    Prober(const Scene& scene, const ReferenceSettings& settings, Report& report = IgnoredReport());
    ~Prober();
    Prober(const Prober&) = delete;
    Prober& operator=(const Prober&) = delete;

    /// Explains a pixel. Threads may call this at the same time.
    ///
    /// \param x, y  counted from the upper left pixel
    /// \param view  the picture, or a term view (is_term()), whose terms alone the probe has then
    /// \return a pixel that shows no surface has the term skybox, or no term and the coverage 0
    /// \throws InvalidInput if the pixel is outside of the picture or the view is another one
    [[nodiscard]] Probe at(int x, int y, DebugView view = DebugView::picture) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace shade
}  // namespace relief
