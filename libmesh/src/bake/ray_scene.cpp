// SPDX-License-Identifier: Apache-2.0
// Which triangle is Embree's word (rays/embree_scene.h); where on it, and which of those that meet
// at an edge, is decided here, in double. Tests: tests/mesh/bake/ray_scene_test.cpp.
#include "bake/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "geometry/direction.h"

namespace relief {
namespace {

/// Hits this near to an edge, as a share of the triangle's height, may be its neighbour's as well.
constexpr float edge_share = 1e-4F;
/// How far around such a hit others are looked for, over the size of the scene.
constexpr float edge_reach = 2e-6F;
/// Where fewer rays are cast for each triangle, Embree's faster way to build a scene pays: it saves
/// 190 of 270 nanoseconds a triangle and costs 15 to 20 a ray. Triangles of very different sizes
/// may cost their rays more, hence only half of what that comes to.
constexpr double few_rays_per_triangle = 5.0;

/// Where a triangle comes in the order of places.
std::array<std::tuple<double, double, double>, 3> place_of(
    const std::array<glm::dvec3, 3>& corners) {
    std::array<std::tuple<double, double, double>, 3> place;
    for (std::size_t i = 0; i < 3; ++i)
        place[i] = {corners[i].x, corners[i].y, corners[i].z};
    std::sort(place.begin(), place.end());
    return place;
}

/// Weights that rounding made negative become 0.
glm::dvec3 drawn_inside(glm::dvec3 weights) {
    weights = glm::max(weights, glm::dvec3(0.0));
    return weights / (weights.x + weights.y + weights.z);
}

/// Origins further away than this, over the size of the scene, are moved along their rays.
constexpr double far_away = 4.0;
/// And so far away doubles are as coarse as floats are within the scene.
constexpr double too_far_away = 1e10;

/// The same ray from where it comes near the scene, which lies within -1 to 1: floats far away are
/// coarse, and Embree ends the program at origins beyond 1.8e18. One that does not come near, or
/// that nobody can tell of, ends before it begins.
Ray from_nearby(const Ray& ray) {
    const double distance = glm::length(ray.origin);
    if (distance <= far_away) return ray;
    const double middle = -glm::dot(ray.origin, ray.direction);
    const glm::dvec3 nearest = ray.origin + middle * ray.direction;
    if (!(distance <= too_far_away && glm::length(nearest) <= 2.0 && middle > -far_away))
        return {glm::dvec3(0.0), ray.direction, 0.0, -1.0};
    const double skipped = std::max(middle - far_away, 0.0);
    return {nearest - (middle - skipped) * ray.direction, ray.direction,
            std::max(ray.near - skipped, 0.0), ray.far - skipped};
}

SceneBuild build_for(double expected_rays, const std::vector<RayMesh>& meshes) {
    std::size_t triangles = 0;
    for (const RayMesh& mesh : meshes)
        triangles += mesh.triangles.size();
    return expected_rays < few_rays_per_triangle * static_cast<double>(triangles)
               ? SceneBuild::fast
               : SceneBuild::thorough;
}

}  // namespace

RayScene::RayScene(std::vector<RayMesh> meshes, double expected_rays)
    : meshes_(std::move(meshes)), embree_(build_for(expected_rays, meshes_)) {
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high(-std::numeric_limits<double>::infinity());
    for (const RayMesh& mesh : meshes_) {
        for (const glm::vec3& position : mesh.positions) {
            if (!is_finite(position)) continue;
            low = glm::min(low, glm::dvec3(position));
            high = glm::max(high, glm::dvec3(position));
        }
    }
    if (low.x <= high.x) {
        centre_ = 0.5 * (low + high);
        const glm::dvec3 size = 0.5 * (high - low);
        half_size_ = std::max({size.x, size.y, size.z});
        if (!(half_size_ > 0.0)) half_size_ = 1.0;
    }
    const double scale = 1.0 / half_size_;
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        const RayMesh& mesh = meshes_[i];
        if (mesh.triangles.empty()) continue;
        is_empty_ = false;
        const auto fill = [&](std::size_t begin, std::size_t end, float* xyz) {
            for (std::size_t v = begin; v < end; ++v) {
                const glm::dvec3 moved = (glm::dvec3(mesh.positions[v]) - centre_) * scale;
                for (int axis = 0; axis < 3; ++axis)
                    *xyz++ = static_cast<float>(moved[axis]);
            }
        };
        embree_.add(static_cast<std::uint32_t>(i), mesh.positions.size(), fill, mesh.triangles);
    }
    embree_.build();
}

void RayScene::set(RayPacket& packet, std::size_t lane, const Ray& ray) const {
    const double scale = 1.0 / half_size_;
    const Ray near = from_nearby(
        {(ray.origin - centre_) * scale, ray.direction, ray.near * scale, ray.far * scale});
    packet.origin_x[lane] = static_cast<float>(near.origin.x);
    packet.origin_y[lane] = static_cast<float>(near.origin.y);
    packet.origin_z[lane] = static_cast<float>(near.origin.z);
    packet.near[lane] = static_cast<float>(near.near);
    packet.direction_x[lane] = static_cast<float>(near.direction.x);
    packet.direction_y[lane] = static_cast<float>(near.direction.y);
    packet.direction_z[lane] = static_cast<float>(near.direction.z);
    packet.time[lane] = 0.0F;
    packet.far[lane] = static_cast<float>(near.far);
    packet.mask[lane] = std::numeric_limits<std::uint32_t>::max();
    packet.id[lane] = 0;
    packet.flags[lane] = 0;
    packet.mesh[lane] = RayPacket::nothing;
    packet.instance[lane] = RayPacket::nothing;
}

void RayScene::find(RayPacket& packet, std::size_t count) const {
    embree_.find_nearest(packet, count);
    for (std::size_t lane = 0; lane < count; ++lane) {
        if (!packet.hits(lane)) continue;
        const float second = packet.second[lane];
        const float third = packet.third[lane];
        if (std::min({second, third, 1.0F - second - third}) < edge_share)
            settle_edges(packet, lane);
    }
}

void RayScene::find_any(RayPacket& packet, std::size_t count) const {
    embree_.find_any(packet, count);
}

/// Of all triangles at the place of a hit, the one that comes first.
void RayScene::settle_edges(RayPacket& packet, std::size_t lane) const {
    const RaySegment around{
        {packet.origin_x[lane], packet.origin_y[lane], packet.origin_z[lane]},
        {packet.direction_x[lane], packet.direction_y[lane], packet.direction_z[lane]},
        std::max(packet.near[lane], packet.far[lane] - edge_reach),
        packet.far[lane] + edge_reach};
    std::vector<MetTriangle> found;
    embree_.find_all(around, found);
    if (found.size() < 2) return;
    const glm::dvec3 direction(around.direction);
    const auto rank = [&](const MetTriangle& met) {
        const std::array<glm::dvec3, 3> corner = corners(met.mesh, met.triangle);
        const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        return std::tuple(!(glm::dot(normal, direction) < 0.0), place_of(corner), met);
    };
    const MetTriangle first = *std::min_element(
        found.begin(), found.end(),
        [&](const MetTriangle& a, const MetTriangle& b) { return rank(a) < rank(b); });
    packet.mesh[lane] = first.mesh;
    packet.triangle[lane] = first.triangle;
}

std::array<glm::dvec3, 3> RayScene::corners(std::uint32_t mesh, std::uint32_t triangle) const {
    const RayMesh& all = meshes_[mesh];
    const glm::uvec3& names = all.triangles[triangle];
    return {glm::dvec3(all.positions[names.x]), glm::dvec3(all.positions[names.y]),
            glm::dvec3(all.positions[names.z])};
}

/// The weights are as the volumes between the ray and each edge: neighbours see exactly opposite
/// ones for the edge that they share.
RayHit RayScene::exact(std::uint32_t mesh, std::uint32_t triangle, const Ray& ray) const {
    const std::array<glm::dvec3, 3> corner = corners(mesh, triangle);
    const glm::dvec3 a = corner[0] - ray.origin;
    const glm::dvec3 b = corner[1] - ray.origin;
    const glm::dvec3 c = corner[2] - ray.origin;
    const glm::dvec3& d = ray.direction;
    const glm::dvec3 volumes(glm::dot(glm::cross(d, c), b), glm::dot(glm::cross(d, a), c),
                             glm::dot(glm::cross(d, b), a));
    const double sum = volumes.x + volumes.y + volumes.z;
    RayHit hit{mesh, triangle};
    // Seen edge-on the plane says nothing; Embree's word stands then, with the nearest corner.
    hit.weights =
        sum != 0.0 && std::isfinite(sum) ? drawn_inside(volumes / sum) : glm::dvec3(1.0, 0.0, 0.0);
    hit.distance = glm::dot(hit.weights.x * a + hit.weights.y * b + hit.weights.z * c, d);
    hit.faces_origin = glm::dot(glm::cross(b - a, c - a), d) < 0.0;
    return hit;
}

RayHit RayScene::hit(const RayPacket& packet, std::size_t lane, const Ray& ray) const {
    if (!packet.hits(lane)) return {};
    return exact(packet.mesh[lane], packet.triangle[lane], ray);
}

RayHit RayScene::nearest(const Ray& ray) const {
    RayPacket packet;
    set(packet, 0, ray);
    find(packet, 1);
    return hit(packet, 0, ray);
}

double RayScene::distance_from(const glm::dvec3& point, double enough) const {
    const glm::dvec3 moved = (point - centre_) / half_size_;
    const float nearest =
        embree_.distance_from(glm::vec3(moved), static_cast<float>(enough / half_size_));
    return static_cast<double>(nearest) * half_size_;
}

}  // namespace relief
