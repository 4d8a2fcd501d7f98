// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion, and texel means of layers.
// Tests: tests/mesh/bake/bake_layers_test.cpp.
#include "bake/layers.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "geometry/direction.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/normals.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The start distance of rays above the surface, relative to the scene's size. It exceeds the
/// errors of Embree's floats, so that no surface occludes itself.
constexpr double relative_start = 4e-6;

/// The minimum cosine between the normal and the face normal for which the normal is used.
constexpr double min_cosine = 0.1;

/// Returns a hash that decorrelates similar numbers. Source: [Steele et al. 2014].
std::uint64_t scrambled(std::uint64_t bits) {
    bits += 0x9e3779b97f4a7c15ULL;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
    return bits ^ (bits >> 31);
}

std::uint32_t reversed(std::uint32_t bits) {
    bits = (bits << 16) | (bits >> 16);
    bits = ((bits & 0x00ff00ffU) << 8) | ((bits & 0xff00ff00U) >> 8);
    bits = ((bits & 0x0f0f0f0fU) << 4) | ((bits & 0xf0f0f0f0U) >> 4);
    bits = ((bits & 0x33333333U) << 2) | ((bits & 0xccccccccU) >> 2);
    return ((bits & 0x55555555U) << 1) | ((bits & 0xaaaaaaaaU) >> 1);
}

/// Returns the second dimension of the Sobol sequence; the first one is reversed(index).
std::uint32_t sobol2(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t column = 0x80000000U; index != 0; index >>= 1, column ^= column >> 1) {
        if ((index & 1U) != 0) result ^= column;
    }
    return result;
}

double unit_of(std::uint32_t bits) {
    return (static_cast<double>(bits) + 0.5) * 0x1p-32;
}

/// Returns an orthonormal basis with the given third axis.
glm::dmat3 axes_about(const glm::dvec3& normal) {
    const glm::dvec3 aside(perpendicular_to(glm::vec3(normal)));
    const glm::dvec3 first = direction_or_zero(in_plane(aside, normal));
    return {first, glm::cross(normal, first), normal};
}

/// Collects rays in packets and counts the blocked rays of each point.
class Packets {
  public:
    Packets(const RayScene& scene, std::span<std::uint32_t> blocked)
        : scene_(scene), blocked_(blocked) {}

    void add(std::size_t point, const Ray& ray) {
        scene_.set(packet_, count_, ray);
        points_[count_++] = point;
        if (count_ == RayPacket::size) flush();
    }
    void flush() {
        scene_.find_any(packet_, count_);
        for (std::size_t lane = 0; lane < count_; ++lane) {
            if (packet_.is_blocked(lane)) ++blocked_[points_[lane]];
        }
        count_ = 0;
    }

  private:
    const RayScene& scene_;
    std::span<std::uint32_t> blocked_;
    RayPacket packet_{};
    std::array<std::size_t, RayPacket::size> points_{};
    std::size_t count_ = 0;
};

void store_mean(const glm::dvec3& sum, std::uint32_t hits, std::span<float> values,
                std::size_t at) {
    const glm::vec3 mean = hits > 0 ? rounded(sum / static_cast<double>(hits)) : glm::vec3(0.0F);
    for (int axis = 0; axis < 3; ++axis)
        values[3 * at + static_cast<std::size_t>(axis)] = mean[axis];
}

}  // namespace

void detail::check(const OcclusionOptions& options) {
    constexpr int max_rays = 65536;
    if (options.distance && !(*options.distance >= 0.0 && std::isfinite(*options.distance))) {
        throw InvalidInput(
            fmt::format("the distance of occlusion is {}, but must be finite and at least 0",
                        *options.distance));
    }
    if (options.rays < 1 || options.rays > max_rays) {
        throw InvalidInput(
            fmt::format("the number of occlusion rays is {}, but must be within [1, {}]",
                        options.rays, max_rays));
    }
}

Occlusion::Occlusion(const OcclusionOptions& options, std::uint32_t samples)
    : distance_(options.distance),
      rays_((static_cast<std::uint32_t>(options.rays) + samples - 1) / samples) {}

std::vector<double> Occlusion::open_shares(const RayScene& scene,
                                           std::span<const OcclusionPlace> points,
                                           Report& report) const {
    std::vector<std::uint32_t> cast(points.size(), 0), blocked(points.size(), 0);
    Packets packets(scene, blocked);
    const double start = relative_start * scene.half_size();
    const double far = distance_.value_or(scene.half_size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        check_cancelled();  // A point has up to 65536 rays.
        const OcclusionPlace& point = points[i];
        const bool is_usable = glm::dot(point.normal, point.face) >= min_cosine;
        if (!is_usable) {
            report.add("normal along its triangle or behind it", "texel", point.texel,
                       "gets the occlusion about the normal of its triangle");
        }
        const glm::dmat3 axes = axes_about(is_usable ? point.normal : point.face);
        const std::uint64_t scramble = scrambled(point.texel);
        const auto first = static_cast<std::uint32_t>(scramble >> 32);
        const auto second = static_cast<std::uint32_t>(scramble);
        const glm::dvec3 origin = point.position + start * point.face;
        for (std::uint32_t k = 0; k < rays_; ++k) {
            const std::uint32_t index = point.sample * rays_ + k;
            const double u = unit_of(reversed(index) ^ first);
            const double angle = 2.0 * std::numbers::pi * unit_of(sobol2(index) ^ second);
            // A uniform distribution on the disk is cosine-weighted on the hemisphere.
            const double radius = std::sqrt(u);
            const glm::dvec3 direction =
                axes * glm::dvec3(radius * portable::cos(angle), radius * portable::sin(angle),
                                  std::sqrt(1.0 - u));
            if (glm::dot(direction, point.face) <= 0.0) continue;
            ++cast[i];
            packets.add(i, {origin, direction, 0.0, far});
        }
    }
    packets.flush();
    std::vector<double> open(points.size(), 1.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (cast[i] > 0) open[i] = 1.0 - static_cast<double>(blocked[i]) / cast[i];
    }
    return open;
}

std::vector<std::vector<float>> vertex_occlusion(std::span<const Mesh> receivers,
                                                 std::span<const Mesh> occluders,
                                                 const OcclusionOptions& options,
                                                 const ExecutionOptions& execution) {
    check(options);
    const ExecutionScope scope(execution);
    std::vector<RayMesh> rays;
    for (const Mesh& mesh : occluders) {
        validate(mesh);
        rays.push_back({mesh.positions, mesh.triangles});
    }
    const RayScene scene(std::move(rays));
    const Occlusion occlusion(options, 1);
    std::size_t vertices = 0;
    for (const Mesh& mesh : receivers)
        vertices += mesh.positions.size();
    ProgressStage stage("ambient occlusion", vertices);
    std::vector<std::vector<float>> shares;
    for (const Mesh& mesh : receivers) {
        validate(mesh);
        const std::vector<glm::vec3> normals =
            mesh.normals.empty() ? vertex_normals(mesh.positions, mesh.triangles, NormalOptions{})
                                 : mesh.normals;
        std::vector<float>& by_vertex = shares.emplace_back(mesh.positions.size(), 1.0F);
        constexpr std::size_t grain = 512;
        parallel_for(by_vertex.size(), grain, [&](std::size_t begin, std::size_t end) {
            std::vector<OcclusionPlace> places;
            for (std::size_t i = begin; i < end; ++i) {
                const glm::dvec3 normal = direction_or_zero(glm::dvec3(normals[i]));
                if (normal != glm::dvec3(0.0) && is_finite(mesh.positions[i]))
                    places.push_back({glm::dvec3(mesh.positions[i]), normal, normal, i, 0});
            }
            Report unused;  // The normal is its own plane, so that nothing is reported.
            const std::vector<double> open = occlusion.open_shares(scene, places, unused);
            for (std::size_t i = 0; i < places.size(); ++i)
                by_vertex[places[i].texel] = static_cast<float>(open[i]);
            stage.advance(end - begin);
        });
    }
    return shares;
}

LayerBake::LayerBake(const BakeLayers& layers, std::size_t first_texel, std::size_t texels,
                     std::uint32_t min_samples)
    : layers_(layers), first_texel_(first_texel), hits_(texels, 0) {
    if (layers.occlusion) {
        occlusion_.emplace(*layers.occlusion, min_samples);
        open_.resize(texels);
    }
    if (layers.curvature) curvature_.resize(texels);
    if (layers.positions) positions_.resize(texels);
    if (layers.colors) colors_.resize(texels);
    if (layers.opacity) opacity_.resize(texels);
    if (layers.surface) surfaces_.resize(texels);
    if (layers.emission) emission_.resize(texels);
}

std::size_t LayerBake::add(const HighSurface& high, const RayScene& occluders,
                           std::span<const LayerHit> hits, Report& report) {
    for (const LayerHit& here : hits) {
        ++hits_[here.texel];
        if (layers_.curvature) curvature_[here.texel] += high.curvature(here.hit);
        if (layers_.colors) colors_[here.texel] += high.color(here.hit);
        if (layers_.opacity) opacity_[here.texel] += high.opacity(here.hit);
        if (layers_.surface) surfaces_[here.texel] += high.surface(here.hit);
        if (layers_.emission) emission_[here.texel] += high.emission(here.hit);
        if (layers_.positions) {
            positions_[here.texel] +=
                glm::dvec3(layers_.position_from_mesh * glm::dvec4(high.position(here.hit), 1.0));
        }
    }
    return occlusion_ ? add_occlusion(high, occluders, hits, report) : 0;
}

std::size_t LayerBake::add_occlusion(const HighSurface& high, const RayScene& occluders,
                                     std::span<const LayerHit> hits, Report& report) {
    std::vector<OcclusionPlace> points;
    Report ignored;  // The normal layer reports the same findings.
    Report& normal_report = layers_.normals ? ignored : report;
    for (const LayerHit& here : hits) {
        const double side = here.hit.faces_origin ? 1.0 : -1.0;
        const std::size_t texel = first_texel_ + here.texel;
        points.push_back({high.position(here.hit),
                          side * high.smooth_normal(here.hit, texel, normal_report),
                          side * high.face_normal(here.hit), texel, here.sample});
    }
    const std::vector<double> shares = occlusion_->open_shares(occluders, points, report);
    for (std::size_t i = 0; i < hits.size(); ++i)
        open_[hits[i].texel] += shares[i];
    return points.size() * occlusion_->rays_of_sample();
}

void LayerBake::store(std::size_t texel, const BakedRows& rows, std::size_t at) const {
    const std::uint32_t hits = hits_[texel];
    if (layers_.occlusion)
        rows.occlusion[at] = hits > 0 ? static_cast<float>(open_[texel] / hits) : 1.0F;
    if (layers_.curvature)
        rows.curvature[at] = hits > 0 ? static_cast<float>(curvature_[texel] / hits) : 0.0F;
    if (layers_.positions) store_mean(positions_[texel], hits, rows.positions, at);
    if (layers_.colors) store_mean(colors_[texel], hits, rows.colors, at);
    if (layers_.surface) store_mean(surfaces_[texel], hits, rows.surface, at);
    if (layers_.emission) store_mean(emission_[texel], hits, rows.emission, at);
    if (layers_.opacity)
        rows.opacity[at] = hits > 0 ? static_cast<float>(opacity_[texel] / hits) : 0.0F;
}

}  // namespace relief
