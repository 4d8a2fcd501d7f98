// SPDX-License-Identifier: Apache-2.0
// Rays from a point of the high surface into a hemisphere: ambient occlusion, bent normals and
// thickness. Tests: tests/mesh/bake/bake_layers_test.cpp, bent_normals_test.cpp.
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

/// The directions of the rays of a point: cosine-distributed about an axis, without those below the
/// plane of the triangle.
class Hemisphere {
  public:
    /// \param report  counts a normal that is nearly in or behind the plane
    Hemisphere(const OcclusionPlace& point, std::uint32_t rays, Report& report)
        : face_(point.face), first_index_(point.sample * rays), rays_(rays) {
        const bool is_usable = glm::dot(point.normal, point.face) >= min_cosine;
        if (!is_usable) {
            report.add("normal along its triangle or behind it", "texel", point.texel,
                       "casts its rays about the normal of its triangle");
        }
        axes_ = axes_about(is_usable ? point.normal : point.face);
        const std::uint64_t scramble = mixed_bits(point.texel + split_mix_step);
        first_ = static_cast<std::uint32_t>(scramble >> 32);
        second_ = static_cast<std::uint32_t>(scramble);
    }

    [[nodiscard]] const glm::dvec3& axis() const { return axes_[2]; }

    /// Calls visit(direction) for each ray, with a unit vector.
    template <typename Visit>
    void for_each(const Visit& visit) const {
        for (std::uint32_t k = 0; k < rays_; ++k) {
            const std::uint32_t index = first_index_ + k;
            const double u = unit_of(reversed(index) ^ first_);
            const double angle = 2.0 * std::numbers::pi * unit_of(sobol2(index) ^ second_);
            // A uniform distribution on the disk is cosine-weighted on the hemisphere.
            const double radius = std::sqrt(u);
            const glm::dvec3 direction =
                axes_ * glm::dvec3(radius * portable::cos(angle), radius * portable::sin(angle),
                                   std::sqrt(1.0 - u));
            if (glm::dot(direction, face_) > 0.0) visit(direction);
        }
    }

  private:
    glm::dvec3 face_;
    std::uint32_t first_index_, rays_;
    glm::dmat3 axes_{1.0};
    std::uint32_t first_ = 0, second_ = 0;
};

/// The sums of the rays of a point.
struct RaySums {
    std::uint32_t cast = 0;
    std::uint32_t blocked = 0;
};

/// The sums of the directions of the rays of a point.
struct DirectionSums {
    glm::dvec3 all{0.0};
    glm::dvec3 open{0.0};  ///< Of the rays that hit nothing.
};

/// Collects rays in packets and adds up the blocked ones and the directions of each point, in the
/// order of its rays.
class OcclusionPackets {
  public:
    /// \param directions  by point; empty: they are not added up
    OcclusionPackets(const RayScene& scene, std::span<RaySums> sums,
                     std::span<DirectionSums> directions)
        : scene_(scene), sums_(sums), direction_sums_(directions) {}

    void add(std::size_t point, const Ray& ray) {
        ++sums_[point].cast;
        scene_.set(packet_, count_, ray);
        if (!direction_sums_.empty()) {
            directions_[count_] = ray.direction;
            direction_sums_[point].all += ray.direction;
        }
        points_[count_++] = point;
        if (count_ == RayPacket::size) flush();
    }
    void flush() {
        scene_.find_any(packet_, count_);
        for (std::size_t lane = 0; lane < count_; ++lane) {
            if (packet_.is_blocked(lane))
                ++sums_[points_[lane]].blocked;
            else if (!direction_sums_.empty())
                direction_sums_[points_[lane]].open += directions_[lane];
        }
        count_ = 0;
    }

  private:
    const RayScene& scene_;
    std::span<RaySums> sums_;
    std::span<DirectionSums> direction_sums_;
    RayPacket packet_{};
    std::array<glm::dvec3, RayPacket::size> directions_{};
    std::array<std::size_t, RayPacket::size> points_{};
    std::size_t count_ = 0;
};

/// Collects rays in packets and adds up the distances of their hits.
class DistancePackets {
  public:
    DistancePackets(const RayScene& scene, double far, std::span<PointThickness> points)
        : scene_(scene), far_(far), sums_(points) {}

    void add(std::size_t point, const Ray& ray) {
        scene_.set(packet_, count_, ray);
        points_[count_++] = point;
        if (count_ == RayPacket::size) flush();
    }
    void flush() {
        scene_.find(packet_, count_);
        for (std::size_t lane = 0; lane < count_; ++lane) {
            PointThickness& sums = sums_[points_[lane]];
            ++sums.rays;
            const bool hits = packet_.hits(lane);
            if (hits) ++sums.hits;
            sums.distance += hits ? packet_.distance[lane] : far_;
        }
        count_ = 0;
    }

  private:
    const RayScene& scene_;
    double far_;
    std::span<PointThickness> sums_;
    RayPacket packet_{};
    std::array<std::size_t, RayPacket::size> points_{};
    std::size_t count_ = 0;
};

/// The mean direction of a cosine distribution is its axis times 2/3. The mean of the rays deviates
/// from it at random, and where the triangle's plane cuts the hemisphere. Open rays count with the
/// deviation corrected in proportion to their share.
glm::dvec3 bent_direction(const RaySums& sums, const DirectionSums& directions,
                          const glm::dvec3& axis) {
    constexpr double mean_cosine = 2.0 / 3.0;
    if (sums.cast == 0) return mean_cosine * axis;
    const auto cast = static_cast<double>(sums.cast);
    const double open = 1.0 - static_cast<double>(sums.blocked) / cast;
    if (sums.blocked == 0) return mean_cosine * axis;
    return open * mean_cosine * axis + (directions.open - open * directions.all) / cast;
}

void check_rays(const char* what, int rays, const std::optional<double>& distance) {
    constexpr int max_rays = 65536;
    if (distance && !(*distance >= 0.0 && std::isfinite(*distance))) {
        throw InvalidInput(fmt::format(
            "the distance of {} is {}, but must be finite and at least 0", what, *distance));
    }
    if (rays < 1 || rays > max_rays) {
        throw InvalidInput(fmt::format("the number of {} rays is {}, but must be within [1, {}]",
                                       what, rays, max_rays));
    }
}

std::uint32_t shared_rays(int rays, std::uint32_t samples) {
    return (static_cast<std::uint32_t>(rays) + samples - 1) / samples;
}

}  // namespace

void detail::check(const BakeLayers& layers) {
    const auto& occlusion = layers.occlusion;
    const auto& bent = layers.bent_normals;
    if (occlusion) check_rays("occlusion", occlusion->rays, occlusion->distance);
    if (bent) check_rays(occlusion ? "occlusion" : "bent normal", bent->rays, bent->distance);
    if (layers.thickness)
        check_rays("thickness", layers.thickness->rays, layers.thickness->distance);
    if (occlusion && bent && *occlusion != *bent)
        throw InvalidInput("occlusion and bent normals have different rays, which they share");
}

Occlusion::Occlusion(const OcclusionOptions& options, std::uint32_t samples)
    : distance_(options.distance), rays_(shared_rays(options.rays, samples)) {}

std::vector<double> Occlusion::open_shares(const RayScene& scene,
                                           std::span<const OcclusionPlace> points, Report& report,
                                           std::span<glm::dvec3> bent) const {
    std::vector<RaySums> sums(points.size());
    std::vector<DirectionSums> directions(bent.size());
    std::vector<glm::dvec3> axes(bent.size());
    OcclusionPackets packets(scene, sums, directions);
    const double start = relative_start * scene.half_size();
    const double far = distance_.value_or(scene.half_size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        check_cancelled();  // A point has up to 65536 rays.
        const Hemisphere hemisphere(points[i], rays_, report);
        if (!bent.empty()) axes[i] = hemisphere.axis();
        const glm::dvec3 origin = points[i].position + start * points[i].face;
        hemisphere.for_each([&](const glm::dvec3& direction) {
            packets.add(i, {origin, direction, 0.0, far});
        });
    }
    packets.flush();
    std::vector<double> open(points.size(), 1.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (sums[i].cast > 0) open[i] = 1.0 - static_cast<double>(sums[i].blocked) / sums[i].cast;
        if (!bent.empty()) bent[i] = bent_direction(sums[i], directions[i], axes[i]);
    }
    return open;
}

Thickness::Thickness(const ThicknessOptions& options, std::uint32_t samples)
    : distance_(options.distance), rays_(shared_rays(options.rays, samples)) {}

double Thickness::limit(const RayScene& scene, const ThicknessOptions& options) {
    return options.distance.value_or(2.0 * scene.half_size());
}

std::vector<PointThickness> Thickness::measure(const RayScene& scene,
                                               std::span<const OcclusionPlace> points,
                                               Report& report) const {
    std::vector<PointThickness> result(points.size());
    const double far = limit(scene, {.distance = distance_});
    DistancePackets packets(scene, far, result);
    const double start = relative_start * scene.half_size();
    for (std::size_t i = 0; i < points.size(); ++i) {
        check_cancelled();  // A point has up to 65536 rays.
        OcclusionPlace inwards = points[i];
        inwards.normal = -inwards.normal;
        inwards.face = -inwards.face;
        const glm::dvec3 origin = inwards.position + start * inwards.face;
        Hemisphere(inwards, rays_, report).for_each([&](const glm::dvec3& direction) {
            packets.add(i, {origin, direction, 0.0, far});
        });
    }
    packets.flush();
    return result;
}

std::vector<std::vector<float>> vertex_occlusion(std::span<const Mesh> receivers,
                                                 std::span<const Mesh> occluders,
                                                 const OcclusionOptions& options,
                                                 const ExecutionOptions& execution) {
    check(BakeLayers{.occlusion = options});
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

}  // namespace relief
