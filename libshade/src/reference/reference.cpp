// SPDX-License-Identifier: Apache-2.0
// The reference picture, pixel by pixel: the hits of the ray through the center of a pixel are
// shaded and composed front to back over the skybox, and radiance becomes a picture by exposure,
// tone mapping and sRGB codes over the background. Linear light, in double; hard cases as in
// shaders/README.md. Sources: [Porter and Duff 1984] (composition), [Reinhard et al. 2002],
// [Narkowicz 2016], [Hill 2017], [Khronos PBR Neutral] (tone curves).
#include "relief/shade/reference.h"
#include "scene/scene_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "parallel.h"
#include "portable_math.h"
#include "reference/reference_parts.h"
#include "relief/mesh/report.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

namespace {

/// The largest radiance in a linear picture.
constexpr double max_radiance = 3e38;

/// Clamps to [0, limit]; NaN becomes 0.
glm::dvec3 limited(const glm::dvec3& radiance, double limit) {
    glm::dvec3 result(0.0);
    for (int i = 0; i < 3; ++i) {
        if (radiance[i] > 0.0) result[i] = std::min(radiance[i], limit);
    }
    return result;
}

}  // namespace

// Radiance

namespace {

using reference::Hit;
using reference::PreparedScene;
using reference::Trace;

/// The result of one ray.
struct Sample {
    explicit Sample(bool needs_radiance) : trace(needs_radiance) {}

    glm::dvec4 color{0.0};    ///< Alpha not multiplied in.
    std::vector<Hit> layers;  ///< The hits, nearest first, including transparent
                              ///< ones; without culled sides.
    std::optional<Hit> first_shown;
    Trace trace;
    bool ambiguous = false;  ///< Two surfaces at depths that OpenGL may not tell apart.
};

/// Returns the coverage of a surface by its alpha mode; 0 for NaN.
double coverage(const Material& material, double alpha) {
    switch (material.alpha_mode) {
        case AlphaMode::mask:
            return alpha >= static_cast<double>(material.alpha_cutoff) ? 1.0 : 0.0;
        case AlphaMode::blend:
            return alpha > 0.0 ? std::min(alpha, 1.0) : 0.0;
        case AlphaMode::opaque:
            break;
    }
    return 1.0;
}

std::vector<reference::ViewMesh> view_meshes(const PreparedScene& prepared) {
    std::vector<reference::ViewMesh> meshes;
    for (const reference::PreparedInstance& instance : prepared.instances)
        meshes.push_back({instance.positions_view, instance.mesh->triangles});
    return meshes;
}

/// Traces the rays of a picture.
class Tracer {
  public:
    /// \param only_covering  surfaces with transmission or blending are invisible
    Tracer(const PreparedScene& prepared, const ReferenceSettings& settings,
           const reference::Visibility& visibility, bool only_covering)
        : prepared_(prepared),
          settings_(settings),
          visibility_(visibility),
          only_covering_(only_covering) {
        top_ = half_height(camera());
    }

    /// \param x, y  in pixels from the upper left corner
    [[nodiscard]] Sample trace(double x, double y) const { return traced(x, y, true); }

    /// Returns the sample of a ray beside a pixel, without its radiance, to compare it with the
    /// sample of the pixel.
    [[nodiscard]] Sample trace_beside(double x, double y) const { return traced(x, y, false); }

    /// Tells whether the picture is continuous between two samples.
    [[nodiscard]] bool is_continuous(const Sample& a, const Sample& b) const;

    /// Tells whether the next pixel may lie beyond the horizon of a textured triangle's plane,
    /// where the differences between pixels by which OpenGL chooses a mip level mean nothing.
    [[nodiscard]] bool is_edge_on(const Sample& sample, double x, double y) const;

  private:
    [[nodiscard]] Sample traced(double x, double y, bool needs_radiance) const;
    [[nodiscard]] const Camera& camera() const { return *prepared_.scene.camera; }
    [[nodiscard]] glm::dvec2 on_view_plane(double x, double y) const;
    /// Returns the direction of the ray, in the space of the camera.
    [[nodiscard]] glm::dvec3 direction(const glm::dvec2& view_plane) const {
        return {camera().orthographic_height ? glm::dvec2(0.0) : view_plane, -1.0};
    }
    [[nodiscard]] bool uses_opengl(const Hit& hit, const Material& material) const {
        return material.double_sided || !reference::is_back(prepared_, hit);
    }
    [[nodiscard]] bool is_covering(const Hit& hit, const Material& material) const {
        return material.alpha_mode != AlphaMode::blend &&
               !reference::is_transmissive(material, *prepared_.instances[hit.instance].mesh);
    }
    [[nodiscard]] bool is_same_surface(const Hit& a, const Hit& b) const;
    [[nodiscard]] bool is_too_close(const Hit& front, const Hit& behind) const;
    /// Adds the color of a hit, alpha multiplied in. \return whether it hides all hits behind it
    bool add(const Hit& hit, Sample& sample) const;
    /// Returns the skybox, or transparency.
    [[nodiscard]] glm::dvec4 skybox(const glm::dvec2& view_plane, Trace& trace) const;

    const PreparedScene& prepared_;
    const ReferenceSettings& settings_;
    const reference::Visibility& visibility_;
    bool only_covering_;
    double top_ = 1.0;  ///< The upper edge of the picture, as half_height() defines it.
};

glm::dvec2 Tracer::on_view_plane(double x, double y) const {
    const double aspect = static_cast<double>(settings_.width) / settings_.height;
    return {(2.0 * x / settings_.width - 1.0) * top_ * aspect,
            (1.0 - 2.0 * y / settings_.height) * top_};
}

bool Tracer::add(const Hit& hit, Sample& sample) const {
    const Material& material = prepared_.material_of(hit.instance, hit.triangle);
    if (!uses_opengl(hit, material) || (only_covering_ && !is_covering(hit, material)))
        return false;
    sample.layers.push_back(hit);
    const reference::Shaded shaded = reference::shade(prepared_, hit, material, sample.trace);
    const double alpha = coverage(material, shaded.alpha);
    sample.trace.decide(alpha > 0.0 ? 1 : 0);
    if (alpha == 0.0) return false;
    if (!sample.first_shown) sample.first_shown = hit;
    const glm::dvec3 radiance = limited(shaded.radiance, max_radiance);
    const double share = (1.0 - sample.color.a) * alpha;
    sample.color += glm::dvec4(radiance * share, share);
    return alpha == 1.0;
}

glm::dvec4 Tracer::skybox(const glm::dvec2& view_plane, Trace& trace) const {
    const auto& environment = prepared_.scene.environment;
    if (!environment || !environment->skybox) return glm::dvec4(0.0);
    const glm::dmat3 world_from_view(camera().world_from_view);
    const glm::dvec3 radiance =
        prepared_.environment->blurred(world_from_view * direction(view_plane),
                                       static_cast<double>(environment->skybox_blur), trace);
    return {limited(radiance, max_radiance), 1.0};
}

/// Tells whether the depths differ by less than half a millionth of the depth range, about twenty
/// steps of a 24-bit depth buffer.
bool Tracer::is_too_close(const Hit& front, const Hit& behind) const {
    const double near = static_cast<double>(camera().near);
    const double far = static_cast<double>(camera().far);
    const double apart = camera().orthographic_height
                             ? (behind.depth - front.depth) / (far - near)
                             : near * far / (far - near) * (1.0 / front.depth - 1.0 / behind.depth);
    return apart < 1e-6 && !is_same_surface(front, behind);
}

Sample Tracer::traced(double x, double y, bool needs_radiance) const {
    const glm::dvec2 view_plane = on_view_plane(x, y);
    const std::vector<Hit> hits = visibility_.hits(view_plane.x, view_plane.y);
    Sample sample(needs_radiance);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const std::size_t layers_before = sample.layers.size();
        const bool hides_the_rest = add(hits[i], sample);
        if (sample.layers.size() > layers_before && i + 1 < hits.size()) {
            const Material& next =
                prepared_.material_of(hits[i + 1].instance, hits[i + 1].triangle);
            sample.ambiguous = sample.ambiguous || (uses_opengl(hits[i + 1], next) &&
                                                    is_too_close(hits[i], hits[i + 1]));
        }
        if (hides_the_rest) break;
    }
    if (sample.color.a < 1.0)
        sample.color += (1.0 - sample.color.a) * skybox(view_plane, sample.trace);
    if (sample.color.a > 0.0) {
        sample.color = {glm::dvec3(sample.color) / sample.color.a, sample.color.a};
    }
    return sample;
}

/// Tells whether two hits lie on one piece of surface with continuous attributes.
bool Tracer::is_same_surface(const Hit& a, const Hit& b) const {
    if (a.instance != b.instance || reference::is_back(prepared_, a) != is_back(prepared_, b)) {
        return false;
    }
    if (a.triangle == b.triangle) return true;
    if (prepared_.range_of(a.instance, a.triangle) != prepared_.range_of(b.instance, b.triangle)) {
        return false;
    }
    const Material& material = prepared_.material_of(a.instance, a.triangle);
    if (material.interpolation == Interpolation::flat ||
        material.tangent_frame == TangentFrame::derivatives) {
        return false;
    }
    const auto& triangles = prepared_.instances[a.instance].mesh->triangles;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (triangles[a.triangle][i] == triangles[b.triangle][j]) return true;
        }
    }
    return false;
}

bool Tracer::is_continuous(const Sample& a, const Sample& b) const {
    return a.trace.decided_like(b.trace) && !a.ambiguous && !b.ambiguous &&
           !a.trace.is_doubtful() &&
           std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), b.layers.end(),
                      [&](const Hit& i, const Hit& j) { return is_same_surface(i, j); });
}

bool Tracer::is_edge_on(const Sample& sample, double x, double y) const {
    if (sample.trace.places().empty()) return false;
    const auto ray = [&](double right, double down) {
        return direction(on_view_plane(x + right, y + down));
    };
    return std::any_of(sample.layers.begin(), sample.layers.end(), [&](const Hit& hit) {
        const reference::PreparedInstance& instance = prepared_.instances[hit.instance];
        const glm::uvec3& corners = instance.mesh->triangles[hit.triangle];
        const glm::dvec3 a = instance.positions_view[corners.x];
        const glm::dvec3 normal = glm::cross(instance.positions_view[corners.y] - a,
                                             instance.positions_view[corners.z] - a);
        const double here = glm::dot(normal, ray(0.0, 0.0));
        const double beside = std::abs(glm::dot(normal, ray(1.0, 0.0)) - here) +
                              std::abs(glm::dot(normal, ray(0.0, 1.0)) - here);
        return std::abs(here) <= beside;
    });
}

/// Tells whether a texture lookup moves by more than 0.7 texels a pixel between two rays.
/// \param apart  the distance of the rays in pixels
bool moves_fast(const Sample& a, const Sample& b, double apart) {
    constexpr double max_texels = 0.7;
    const auto& from = a.trace.places();
    const auto& to = b.trace.places();
    if (from.size() != to.size()) return true;
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (!(glm::length(to[i] - from[i]) <= max_texels * apart)) return true;
    }
    return false;
}

/// Tells whether OpenGL minifies a texture: by the derivative of its lookup here and, since OpenGL
/// takes differences within blocks of four pixels, between this pixel and all its neighbors. If
/// another surface begins there, OpenGL extrapolates this one, which is not known here: that counts
/// as minified.
bool is_minified(const Tracer& tracer, const Sample& center, double x, double y, double margin) {
    if (center.trace.places().empty()) return false;
    for (const double apart : {margin, 1.0}) {
        for (const double down : {-apart, 0.0, apart}) {
            for (const double right : {-apart, 0.0, apart}) {
                if (right == 0.0 && down == 0.0) continue;
                const Sample beside = tracer.trace_beside(x + right, y + down);
                if (moves_fast(center, beside, std::hypot(right, down))) return true;
            }
        }
    }
    return false;
}

bool is_near_edge(const Tracer& tracer, const Sample& center, double x, double y, double margin) {
    if (!(margin > 0.0)) return false;
    for (const glm::dvec2& corner : {glm::dvec2(1, 1), {1, -1}, {-1, 1}, {-1, -1}}) {
        const Sample beside = tracer.trace_beside(x + margin * corner.x, y + margin * corner.y);
        if (!tracer.is_continuous(center, beside)) return true;
    }
    return tracer.is_edge_on(center, x, y) || is_minified(tracer, center, x, y, margin);
}

ReferenceHit first_shown(const PreparedScene& prepared, const Sample& sample) {
    if (!sample.first_shown) return {};
    const Hit& hit = *sample.first_shown;
    return {hit.instance, hit.triangle, reference::is_back(prepared, hit)};
}

bool has_transmission(const PreparedScene& prepared) {
    return std::any_of(prepared.materials.begin(), prepared.materials.end(), [](const Material& m) {
        return m.metallic_roughness && m.metallic_roughness->transmission > 0.0F;
    });
}

/// Returns the picture behind transmissive surfaces.
reference::PictureBehind picture_behind(const PreparedScene& prepared,
                                        const ReferenceSettings& settings,
                                        const reference::Visibility& visibility) {
    const Tracer tracer(prepared, settings, visibility, true);
    reference::PictureBehind::Level picture{settings.width, settings.height, {}};
    const auto width = static_cast<std::size_t>(settings.width);
    picture.texels.resize(width * static_cast<std::size_t>(settings.height));
    std::vector<std::uint8_t> edges(picture.texels.size());
    parallel_for(edges.size(), width, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
            const double x = static_cast<double>(pixel % width) + 0.5;
            const std::size_t row = pixel / width;
            const double y = static_cast<double>(row) + 0.5;
            const Sample sample = tracer.trace(x, y);
            picture.texels[pixel] = {glm::dvec3(sample.color) * sample.color.a, sample.color.a};
            edges[pixel] = is_near_edge(tracer, sample, x, y, settings.edge_margin) ? 1 : 0;
        }
    });
    return {prepared.scene, std::move(picture), std::move(edges)};
}

void check(const ReferenceSettings& settings) {
    if (!(settings.edge_margin >= 0.0 && settings.edge_margin <= 1.0)) {
        throw InvalidInput("the reference's edge margin must be within [0, 1] pixels");
    }
}

}  // namespace

Reference render_reference(const Scene& scene, const ReferenceSettings& settings, Report& report) {
    check(settings);
    Reference result;
    result.radiance = make_image(settings.width, settings.height, 4, 32, ColorSpace::linear);
    result.edges = make_image(settings.width, settings.height, 1, 8, ColorSpace::data);
    PreparedScene prepared(scene, report);
    const reference::Visibility visibility(view_meshes(prepared), *scene.camera);
    if (has_transmission(prepared))
        prepared.behind.emplace(picture_behind(prepared, settings, visibility));
    const Tracer tracer(prepared, settings, visibility, false);
    const auto width = static_cast<std::size_t>(settings.width);
    result.hits.resize(width * static_cast<std::size_t>(settings.height));
    const std::span<float> radiance = result.radiance.as<float>();
    const std::span<std::uint8_t> edges = result.edges.as<std::uint8_t>();
    parallel_for(result.hits.size(), width, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
            const double x = static_cast<double>(pixel % width) + 0.5;
            const std::size_t row = pixel / width;
            const double y = static_cast<double>(row) + 0.5;
            const Sample sample = tracer.trace(x, y);
            for (int i = 0; i < 4; ++i) {
                radiance[4 * pixel + static_cast<std::size_t>(i)] =
                    static_cast<float>(sample.color[i]);
            }
            edges[pixel] = is_near_edge(tracer, sample, x, y, settings.edge_margin) ? 255 : 0;
            result.hits[pixel] = first_shown(prepared, sample);
        }
    });
    return result;
}

// Pictures

namespace {

/// Returns a fit to the ACES reference rendering and display transforms, in their own color space
/// [Hill 2017].
glm::dvec3 filmic(const glm::dvec3& x) {
    const glm::dmat3 aces_from_srgb(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823,
                                    0.01566, 0.83777);
    const glm::dmat3 srgb_from_aces(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276,
                                    -0.07367, -0.00605, 1.07602);
    const glm::dvec3 v = aces_from_srgb * x;
    return srgb_from_aces *
           ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
}

/// Returns colors as they are up to a peak of 0.76, apart from the reflectance of dielectrics,
/// which it takes away; brighter ones are compressed and lose their saturation [Khronos PBR
/// Neutral].
glm::dvec3 khronos_neutral(glm::dvec3 x) {
    constexpr double start = 0.8 - 0.04;
    constexpr double desaturation = 0.15;
    const double darkest = std::min({x.r, x.g, x.b});
    x -= darkest < 0.08 ? darkest - 6.25 * darkest * darkest : 0.04;
    const double peak = std::max({x.r, x.g, x.b});
    if (peak < start) return x;
    constexpr double room = 1.0 - start;
    const double compressed = 1.0 - room * room / (peak + room - start);
    const double kept = 1.0 / (desaturation * (peak - compressed) + 1.0);
    return glm::mix(glm::dvec3(compressed), x * (compressed / peak), kept);
}

glm::dvec3 tone_mapped(const glm::dvec3& x, ToneMapping mapping) {
    switch (mapping) {
        case ToneMapping::reinhard:
            return x / (1.0 + x);
        case ToneMapping::aces:
            return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
        case ToneMapping::khronos_neutral:
            return khronos_neutral(x);
        case ToneMapping::aces_hill:
            return filmic(x);
        case ToneMapping::aces_hill_boost:
            return filmic(x / 0.6);
        case ToneMapping::none:
            break;
    }
    return x;
}

/// Returns radiance as a picture shows it, before coding.
glm::dvec3 shown(const glm::dvec3& radiance, const Scene& scene, OutputCoding output) {
    if (output == OutputCoding::linear) return limited(radiance, max_radiance);
    if (output == OutputCoding::clamped) return limited(radiance, 1.0);
    const glm::dvec3 light = limited(radiance * static_cast<double>(scene.exposure), max_radiance);
    return limited(tone_mapped(light, scene.tone_mapping), 1.0);
}

/// Composes a color over the background; neither is multiplied by its alpha.
glm::dvec4 over(const glm::dvec4& front, const glm::dvec4& background) {
    const double behind = background.a * (1.0 - front.a);
    const double alpha = front.a + behind;
    if (alpha <= 0.0) return glm::dvec4(0.0);
    return {(glm::dvec3(front) * front.a + glm::dvec3(background) * behind) / alpha, alpha};
}

}  // namespace

Image reference_picture(const Image& radiance, const Scene& scene, OutputCoding output) {
    if (output == OutputCoding::half) throw InvalidInput("pictures cannot have the coding half");
    const bool codes = output == OutputCoding::srgb;
    Image picture = make_image(radiance.width, radiance.height, 4, 32,
                               codes ? ColorSpace::srgb : ColorSpace::linear);
    const std::span<const float> from = radiance.as<float>();
    const std::span<float> to = picture.as<float>();
    glm::dvec4 background(scene.background);
    if (output != OutputCoding::linear) background = glm::min(background, glm::dvec4(1.0));
    for (std::size_t i = 0; i < to.size(); i += 4) {
        const glm::dvec3 color(from[i], from[i + 1], from[i + 2]);
        const glm::dvec4 pixel =
            over({shown(color, scene, output), static_cast<double>(from[i + 3])}, background);
        for (int channel = 0; channel < 4; ++channel) {
            const auto value = static_cast<float>(pixel[channel]);
            to[i + static_cast<std::size_t>(channel)] =
                codes && channel < 3 ? srgb_from_linear(value) : value;
        }
    }
    return picture;
}

}  // namespace relief::shade
