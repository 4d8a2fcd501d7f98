// SPDX-License-Identifier: Apache-2.0
// Rays of the reference picture, as tracer.h says. Hard cases as in shaders/README.md.
#include "reference/tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "parallel.h"
#include "relief/mesh/report.h"

namespace relief::shade::reference {
using namespace relief::detail;
using namespace relief::shade::detail;

glm::dvec3 limited(const glm::dvec3& radiance, double limit) {
    glm::dvec3 result(0.0);
    for (int i = 0; i < 3; ++i) {
        if (radiance[i] > 0.0) result[i] = std::min(radiance[i], limit);
    }
    return result;
}

namespace {

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

}  // namespace

glm::dvec2 Tracer::on_view_plane(double x, double y) const {
    const double aspect = static_cast<double>(settings_.width) / settings_.height;
    return {(2.0 * x / settings_.width - 1.0) * top_ * aspect,
            (1.0 - 2.0 * y / settings_.height) * top_};
}

void Tracer::record(const Hit& hit, const Material& material, Sample& sample) const {
    Recorder& recorder = *sample.trace.recorder();
    recorder.begin_layer();
    ProbeLayer& layer = recorder.layer();
    layer.hit = {hit.instance, hit.triangle, is_back(prepared_, hit)};
    layer.barycentric = hit.barycentric;
    layer.depth = hit.depth;
    layer.outcome = uses_opengl(hit, material) ? ProbeOutcome::shown : ProbeOutcome::culled;
}

bool Tracer::add(const Hit& hit, Sample& sample) const {
    const Material& material = prepared_.material_of(hit.instance, hit.triangle);
    Recorder* const recorder = sample.trace.recorder();
    if (recorder != nullptr) record(hit, material, sample);
    if (!uses_opengl(hit, material) || (only_covering_ && !is_covering(hit, material)))
        return false;
    sample.layers.push_back(hit);
    Shaded shaded = shade(prepared_, hit, material, sample.trace);
    const double alpha = shaded.is_clipped ? 0.0 : coverage(material, shaded.alpha);
    sample.trace.decide(alpha > 0.0 ? 1 : 0);
    const double share = (1.0 - sample.color.a) * alpha;
    if (recorder != nullptr) recorder->end_layer(shaded.alpha, alpha, share, material.alpha_mode);
    if (alpha == 0.0) return false;
    if (!sample.first_shown) sample.first_shown = hit;
    const glm::dvec3 radiance = limited(shaded.radiance.value(), max_radiance);
    sample.color += glm::dvec4(radiance * share, share);
    if (recorder != nullptr) recorder->add_radiance(std::move(shaded.radiance), radiance, share);
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

std::optional<glm::dvec3> Tracer::weights_on_plane(const ReferenceHit& hit, double x,
                                                   double y) const {
    const glm::dvec2 view_plane = on_view_plane(x, y);
    const glm::dvec3 origin =
        camera().orthographic_height ? glm::dvec3(view_plane, 0.0) : glm::dvec3(0.0);
    const glm::dvec3 along = direction(view_plane);
    const PreparedInstance& instance = prepared_.instances[hit.instance];
    const glm::uvec3& corners = instance.mesh->triangles[hit.triangle];
    const glm::dvec3 a = instance.positions_view[corners.x] - origin;
    const glm::dvec3 b = instance.positions_view[corners.y] - origin;
    const glm::dvec3 c = instance.positions_view[corners.z] - origin;
    const glm::dvec3 volumes(glm::dot(along, glm::cross(b, c)), glm::dot(along, glm::cross(c, a)),
                             glm::dot(along, glm::cross(a, b)));
    const double sum = volumes.x + volumes.y + volumes.z;
    const glm::dvec3 weights = volumes / sum;
    if (!std::isfinite(weights.x + weights.y + weights.z)) return std::nullopt;
    return weights;
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

/// Gives hits the depth that they write, in its order.
void Tracer::write_depths(std::vector<Hit>& hits) const {
    for (Hit& hit : hits)
        set_relief_depth(prepared_, prepared_.material_of(hit.instance, hit.triangle), hit);
    std::erase_if(hits,
                  [&](const Hit& hit) { return hit.depth > static_cast<double>(camera().far); });
    std::stable_sort(hits.begin(), hits.end(),
                     [](const Hit& a, const Hit& b) { return a.depth < b.depth; });
}

Sample Tracer::traced(double x, double y, bool needs_radiance, Recorder* recorder) const {
    const glm::dvec2 view_plane = on_view_plane(x, y);
    std::vector<Hit> hits = visibility_.hits(view_plane.x, view_plane.y);
    write_depths(hits);
    Sample sample(needs_radiance, recorder);
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
    if (sample.color.a < 1.0) {
        const double share = 1.0 - sample.color.a;
        const glm::dvec4 behind = skybox(view_plane, sample.trace);
        if (recorder != nullptr && behind.a > 0.0) recorder->add_skybox(glm::dvec3(behind), share);
        sample.color += share * behind;
    }
    if (recorder != nullptr) recorder->end(sample.color.a);
    if (sample.color.a > 0.0) {
        sample.color = {glm::dvec3(sample.color) / sample.color.a, sample.color.a};
    }
    return sample;
}

/// Tells whether two hits lie on one piece of surface with continuous attributes.
bool Tracer::is_same_surface(const Hit& a, const Hit& b) const {
    if (a.instance != b.instance || is_back(prepared_, a) != is_back(prepared_, b)) {
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
        const PreparedInstance& instance = prepared_.instances[hit.instance];
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

namespace {

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

}  // namespace

bool is_near_edge(const Tracer& tracer, const Sample& center, double x, double y, double margin) {
    if (!(margin > 0.0)) return false;
    for (const glm::dvec2& corner : {glm::dvec2(1, 1), {1, -1}, {-1, 1}, {-1, -1}}) {
        const Sample beside = tracer.trace_beside(x + margin * corner.x, y + margin * corner.y);
        if (!tracer.is_continuous(center, beside)) return true;
    }
    return tracer.is_edge_on(center, x, y) || is_minified(tracer, center, x, y, margin);
}

void check(const ReferenceSettings& settings) {
    if (!(settings.edge_margin >= 0.0 && settings.edge_margin <= 1.0)) {
        throw InvalidInput("the reference's edge margin must be within [0, 1] pixels");
    }
}

// Prepared pictures

namespace {

std::vector<ViewMesh> view_meshes(const PreparedScene& prepared) {
    std::vector<ViewMesh> meshes;
    for (const PreparedInstance& instance : prepared.instances)
        meshes.push_back({instance.positions_view, instance.mesh->triangles});
    return meshes;
}

bool has_transmission(const PreparedScene& prepared) {
    return std::any_of(prepared.materials.begin(), prepared.materials.end(), [](const Material& m) {
        return m.metallic_roughness && m.metallic_roughness->transmission > 0.0F;
    });
}

/// Returns the picture behind transmissive surfaces.
PictureBehind picture_behind(const PreparedScene& prepared, const ReferenceSettings& settings,
                             const Visibility& visibility) {
    const Tracer tracer(prepared, settings, visibility, true);
    PictureBehind::Level picture{settings.width, settings.height, {}};
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

}  // namespace

PreparedPicture::PreparedPicture(const Scene& scene, const ReferenceSettings& settings,
                                 Report& report)
    : scene_(scene, report),
      visibility_(view_meshes(scene_), *scene.camera),
      tracer_(scene_, settings, visibility_, false) {
    if (has_transmission(scene_))
        scene_.behind.emplace(picture_behind(scene_, settings, visibility_));
}

}  // namespace relief::shade::reference
