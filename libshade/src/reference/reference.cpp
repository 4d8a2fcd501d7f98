// SPDX-License-Identifier: Apache-2.0
// A scene's picture, pixel by pixel: what the ray through the centre meets, each shaded, composed
// front to back, the skybox behind. Linear light, in double; hard cases as in shaders/README.md.
// Composition: [Porter and Duff 1984]. Tests: tests/shade/reference/reference_test.cpp.
#include "relief/shade/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "parallel.h"
#include "reference/limited.h"
#include "reference/prepared_scene.h"
#include "reference/shading.h"
#include "reference/surface.h"
#include "reference/visibility.h"
#include "relief/mesh/error.h"

namespace relief {

namespace {

using reference::Hit;
using reference::PreparedScene;
using reference::Trace;

/// One ray's outcome.
struct Sample {
    glm::dvec4 color{0.0};    ///< Alpha not multiplied in.
    std::vector<Hit> layers;  ///< What it met, nearest first; holes as well, but no hidden sides.
    std::optional<Hit> first_shown;
    Trace trace;
    bool ambiguous = false;  ///< Two surfaces at depths that OpenGL may not tell apart.
};

/// How much of what is behind it a surface hides; NaN hides nothing.
double shown_alpha(const Material& material, double alpha) {
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

/// Draws rays through a picture.
class Tracer {
  public:
    Tracer(const PreparedScene& prepared, const ReferenceSettings& settings)
        : prepared_(prepared),
          settings_(settings),
          visibility_(view_meshes(prepared), static_cast<double>(camera().near),
                      static_cast<double>(camera().far)) {
        top_ = std::tan(static_cast<double>(camera().vertical_fov) * 0.5);
    }

    /// \param x, y  in pixels from the upper left corner
    [[nodiscard]] Sample trace(double x, double y) const;

    /// Whether going from one sample to the other nothing jumps.
    [[nodiscard]] bool is_continuous(const Sample& a, const Sample& b) const;

    /// Whether the next pixel may lie beyond the horizon of a textured triangle's plane, where the
    /// differences between pixels by which OpenGL chooses a mip level mean nothing.
    [[nodiscard]] bool is_edge_on(const Sample& sample, double x, double y) const;

  private:
    [[nodiscard]] const Camera& camera() const { return *prepared_.scene.camera; }
    [[nodiscard]] glm::dvec2 on_view_plane(double x, double y) const;
    [[nodiscard]] bool is_drawn(const Hit& hit, const Material& material) const {
        return material.double_sided || !reference::is_back(prepared_, hit);
    }
    [[nodiscard]] bool is_same_surface(const Hit& a, const Hit& b) const;
    [[nodiscard]] bool is_too_close(const Hit& front, const Hit& behind) const;
    /// Adds what a hit shows to the colour, alpha multiplied in. \return whether it hides the rest
    bool add(const Hit& hit, Sample& sample) const;
    [[nodiscard]] glm::dvec4 behind(const glm::dvec2& view_plane, Trace& trace) const;

    const PreparedScene& prepared_;
    const ReferenceSettings& settings_;
    reference::Visibility visibility_;
    double top_ = 1.0;  ///< Of the picture on the plane at distance 1.
};

glm::dvec2 Tracer::on_view_plane(double x, double y) const {
    const double aspect = static_cast<double>(settings_.width) / settings_.height;
    return {(2.0 * x / settings_.width - 1.0) * top_ * aspect,
            (1.0 - 2.0 * y / settings_.height) * top_};
}

bool Tracer::add(const Hit& hit, Sample& sample) const {
    const Material& material = prepared_.material_of(hit.instance, hit.triangle);
    if (!is_drawn(hit, material)) return false;
    sample.layers.push_back(hit);
    const reference::Shaded shaded = reference::shade(prepared_, hit, material, sample.trace);
    const double alpha = shown_alpha(material, shaded.alpha);
    sample.trace.decide(alpha > 0.0 ? 1 : 0);
    if (alpha == 0.0) return false;
    if (!sample.first_shown) sample.first_shown = hit;
    const glm::dvec3 radiance = reference::limited(shaded.radiance, reference::largest_radiance);
    const double share = (1.0 - sample.color.a) * alpha;
    sample.color += glm::dvec4(radiance * share, share);
    return alpha == 1.0;
}

glm::dvec4 Tracer::behind(const glm::dvec2& view_plane, Trace& trace) const {
    const auto& described = prepared_.scene.environment;
    if (!described || !described->skybox) return glm::dvec4(0.0);
    const glm::dmat3 world_from_view(camera().world_from_view);
    const glm::dvec3 way = world_from_view * glm::dvec3(view_plane, -1.0);
    const glm::dvec3 radiance = prepared_.environment->looked_up(way, trace);
    return {reference::limited(radiance, reference::largest_radiance), 1.0};
}

/// Half a millionth of the depth range: what a depth buffer of 24 bits tells apart, twenty times.
bool Tracer::is_too_close(const Hit& front, const Hit& behind) const {
    const double near = static_cast<double>(camera().near);
    const double far = static_cast<double>(camera().far);
    const double scale = near * far / (far - near);
    const double apart = scale * (1.0 / front.depth - 1.0 / behind.depth);
    return apart < 1e-6 && !is_same_surface(front, behind);
}

Sample Tracer::trace(double x, double y) const {
    const glm::dvec2 view_plane = on_view_plane(x, y);
    const std::vector<Hit> hits = visibility_.hits(view_plane.x, view_plane.y);
    Sample sample;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const std::size_t shown = sample.layers.size();
        const bool hides_the_rest = add(hits[i], sample);
        if (sample.layers.size() > shown && i + 1 < hits.size()) {
            const Material& next =
                prepared_.material_of(hits[i + 1].instance, hits[i + 1].triangle);
            sample.ambiguous = sample.ambiguous ||
                               (is_drawn(hits[i + 1], next) && is_too_close(hits[i], hits[i + 1]));
        }
        if (hides_the_rest) break;
    }
    if (sample.color.a < 1.0)
        sample.color += (1.0 - sample.color.a) * behind(view_plane, sample.trace);
    if (sample.color.a > 0.0) {
        sample.color = {glm::dvec3(sample.color) / sample.color.a, sample.color.a};
    }
    return sample;
}

/// Whether two hits lie on one piece of surface whose attributes go on from one to the other.
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
           std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), b.layers.end(),
                      [&](const Hit& i, const Hit& j) { return is_same_surface(i, j); });
}

bool Tracer::is_edge_on(const Sample& sample, double x, double y) const {
    if (sample.trace.places().empty()) return false;
    const auto ray = [&](double right, double down) {
        return glm::dvec3(on_view_plane(x + right, y + down), -1.0);
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

/// Whether textures pass by faster than most of a texel a pixel between two rays.
/// \param apart  how many pixels they are apart
bool passes_fast(const Sample& a, const Sample& b, double apart) {
    constexpr double most = 0.7;
    const auto& from = a.trace.places();
    const auto& to = b.trace.places();
    if (from.size() != to.size()) return true;
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (!(glm::length(to[i] - from[i]) <= most * apart)) return true;
    }
    return false;
}

/// Whether OpenGL averages a texture: by how fast it passes here, and, since it takes differences
/// within blocks of four pixels, on the way to all pixels around. Where another surface begins
/// there, OpenGL goes on along this one, and nothing is known: that counts as averaged.
bool is_minified(const Tracer& tracer, const Sample& center, double x, double y, double margin) {
    if (center.trace.places().empty()) return false;
    for (const double apart : {margin, 1.0}) {
        for (const double down : {-apart, 0.0, apart}) {
            for (const double right : {-apart, 0.0, apart}) {
                if (right == 0.0 && down == 0.0) continue;
                const Sample beside = tracer.trace(x + right, y + down);
                if (passes_fast(center, beside, std::hypot(right, down))) return true;
            }
        }
    }
    return false;
}

bool is_near_edge(const Tracer& tracer, const Sample& center, double x, double y, double margin) {
    if (!(margin > 0.0)) return false;
    for (const glm::dvec2& way : {glm::dvec2(1, 1), {1, -1}, {-1, 1}, {-1, -1}}) {
        const Sample beside = tracer.trace(x + margin * way.x, y + margin * way.y);
        if (!tracer.is_continuous(center, beside)) return true;
    }
    return tracer.is_edge_on(center, x, y) || is_minified(tracer, center, x, y, margin);
}

ReferenceHit first_shown(const PreparedScene& prepared, const Sample& sample) {
    if (!sample.first_shown) return {};
    const Hit& hit = *sample.first_shown;
    return {hit.instance, hit.triangle, reference::is_back(prepared, hit)};
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
    const PreparedScene prepared(scene, report);
    const Tracer tracer(prepared, settings);
    const auto width = static_cast<std::size_t>(settings.width);
    result.hits.resize(width * static_cast<std::size_t>(settings.height));
    const std::span<float> radiance = result.radiance.as<float>();
    const std::span<std::uint8_t> edges = result.edges.as<std::uint8_t>();
    parallel_for(result.hits.size(), width, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
            const double x = static_cast<double>(pixel % width) + 0.5;
            const double y = static_cast<double>(pixel / width) + 0.5;
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

}  // namespace relief
