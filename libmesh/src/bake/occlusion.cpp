// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/bake/occlusion_test.cpp.
#include "bake/occlusion.h"

#include <array>
#include <cmath>
#include <numbers>

#include "geometry/direction.h"
#include "geometry/portable_math.h"

namespace relief {
namespace {

/// How far rays begin above the surface, over the size of the scene: above the errors of Embree's
/// floats, so that no surface hides itself.
constexpr double start_share = 4e-6;

/// Cosine between the normal and the triangle's own below which the former is of no use.
constexpr double least_cosine = 0.1;

/// A number made of another such that similar ones have nothing in common. [Steele et al. 2014]
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

/// The second dimension of Sobol's sequence; the first is reversed(index).
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

/// Three perpendicular unit vectors, the last of which is given.
glm::dmat3 axes_about(const glm::dvec3& normal) {
    const glm::dvec3 aside(perpendicular_to(glm::vec3(normal)));
    const glm::dvec3 first = direction_or_zero(in_plane(aside, normal));
    return {first, glm::cross(normal, first), normal};
}

/// Rays in packets as they come, each for one of the places.
class Packets {
  public:
    Packets(const RayScene& scene, std::span<std::uint32_t> blocked)
        : scene_(scene), blocked_(blocked) {}

    void add(std::size_t place, const Ray& ray) {
        scene_.set(packet_, count_, ray);
        places_[count_++] = place;
        if (count_ == RayPacket::size) flush();
    }
    void flush() {
        scene_.find_any(packet_, count_);
        for (std::size_t lane = 0; lane < count_; ++lane) {
            if (packet_.is_blocked(lane)) ++blocked_[places_[lane]];
        }
        count_ = 0;
    }

  private:
    const RayScene& scene_;
    std::span<std::uint32_t> blocked_;
    RayPacket packet_{};
    std::array<std::size_t, RayPacket::size> places_{};
    std::size_t count_ = 0;
};

}  // namespace

Occlusion::Occlusion(const OcclusionOptions& options, std::uint32_t samples)
    : distance_(options.distance),
      rays_((static_cast<std::uint32_t>(options.rays) + samples - 1) / samples) {}

std::vector<double> Occlusion::open_shares(const RayScene& scene,
                                           std::span<const OcclusionPlace> places,
                                           Report& report) const {
    std::vector<std::uint32_t> cast(places.size(), 0), blocked(places.size(), 0);
    Packets packets(scene, blocked);
    const double start = start_share * scene.half_size();
    const double far = distance_.value_or(scene.half_size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const OcclusionPlace& place = places[i];
        const bool is_usable = glm::dot(place.normal, place.face) >= least_cosine;
        if (!is_usable) {
            report.add("normal along its triangle or behind it", "texel", place.texel,
                       "has its occlusion about the triangle's");
        }
        const glm::dmat3 axes = axes_about(is_usable ? place.normal : place.face);
        const std::uint64_t scramble = scrambled(place.texel);
        const auto first = static_cast<std::uint32_t>(scramble >> 32);
        const auto second = static_cast<std::uint32_t>(scramble);
        const glm::dvec3 origin = place.point + start * place.face;
        for (std::uint32_t k = 0; k < rays_; ++k) {
            const std::uint32_t index = place.sample * rays_ + k;
            const double u = unit_of(reversed(index) ^ first);
            const double turn = 2.0 * std::numbers::pi * unit_of(sobol2(index) ^ second);
            // Even on the disc is by the cosine on the hemisphere above it.
            const double radius = std::sqrt(u);
            const glm::dvec3 direction =
                axes * glm::dvec3(radius * portable::cos(turn), radius * portable::sin(turn),
                                  std::sqrt(1.0 - u));
            if (glm::dot(direction, place.face) <= 0.0) continue;
            ++cast[i];
            packets.add(i, {origin, direction, 0.0, far});
        }
    }
    packets.flush();
    std::vector<double> open(places.size(), 1.0);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (cast[i] > 0) open[i] = 1.0 - static_cast<double>(blocked[i]) / cast[i];
    }
    return open;
}

}  // namespace relief
