// SPDX-License-Identifier: Apache-2.0
// Packets of rays, and a walk for what they leave open. See projection.h.
// Tests: tests/mesh/bake/projection_test.cpp.
#include "bake/projection.h"

#include <algorithm>
#include <optional>

namespace relief {
namespace {

constexpr double step_share = 4e-6;  // Of the scene's size.
constexpr int most_steps = 256;      // Through so many layers of surface.

Ray from_outside(const ProjectionLine& line) {
    return {line.point + line.outside * line.outward, -line.outward, 0.0,
            line.outside + line.inside};
}

}  // namespace

Projection::Projection(const RayScene& scene, BackFaces back_faces)
    : scene_(scene), back_faces_(back_faces), step_(step_share * scene.half_size()) {}

std::size_t Projection::find(std::span<const ProjectionLine> lines,
                             std::span<ProjectedPoint> points) const {
    std::size_t rays = lines.size();
    for (const std::size_t i : find_from_outside(lines, points))
        rays += walk(lines[i], points[i]);
    return rays;
}

std::vector<std::size_t> Projection::find_from_outside(std::span<const ProjectionLine> lines,
                                                       std::span<ProjectedPoint> points) const {
    std::vector<std::size_t> doubtful;
    RayPacket packet;
    for (std::size_t first = 0; first < lines.size(); first += RayPacket::size) {
        const std::size_t lanes = std::min(RayPacket::size, lines.size() - first);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const ProjectionLine& line = lines[first + lane];
            if (back_faces_ == BackFaces::take)
                scene_.set(packet, lane, from_outside(line));
            else
                scene_.set(packet, lane, from_outside(line), line.outside);
        }
        scene_.find(packet, lanes);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const std::size_t i = first + lane;
            const RayHit hit = scene_.hit(packet, lane);
            points[i] = {hit, lines[i].outside - hit.distance};
            if (!hit.is_hit() || back_faces_ == BackFaces::take) continue;
            if (!hit.faces_origin || packet.last[lane] > hit.distance + step_)
                doubtful.push_back(i);
        }
    }
    return doubtful;
}

/// Along a line from its point, outwards or inwards, one triangle after another.
struct Projection::Walk {
    const RayScene& scene;
    const ProjectionLine& line;
    double sign;  ///< 1: outwards.
    double far;
    double step;
    double at = 0.0;
    std::size_t rays = 0;

    std::optional<RayHit> next() {
        if (at > far || rays >= most_steps) return std::nullopt;
        ++rays;
        const RayHit hit = scene.nearest({line.point, sign * line.outward, at, far});
        if (!hit.is_hit()) return std::nullopt;
        at = std::max(hit.distance, at) + step;
        return hit;
    }
    /// The same hit, as seen from outside.
    [[nodiscard]] ProjectedPoint seen(RayHit hit) const {
        const double height = sign * hit.distance;
        if (sign > 0.0) hit.faces_origin = !hit.faces_origin;
        hit.distance = line.outside - height;
        return {hit, height};
    }
};

std::size_t Projection::walk(const ProjectionLine& line, ProjectedPoint& point) const {
    Walk inwards{scene_, line, -1.0, line.inside, step_};
    std::optional<ProjectedPoint> first_inwards;
    bool lies_outside = false;  // What is inwards of the point faces it.
    for (auto hit = inwards.next(); hit; hit = inwards.next()) {
        if (inwards.rays == 1) lies_outside = hit->faces_origin;
        if (!hit->faces_origin) continue;
        first_inwards = inwards.seen(*hit);
        break;
    }
    Walk outwards{scene_, line, 1.0, line.outside, step_};
    std::optional<ProjectedPoint> left, left_within;
    int depth = lies_outside ? 0 : 1;  // Of the point: in how many solids.
    bool may_enter = !lies_outside;
    for (auto hit = outwards.next(); hit; hit = outwards.next()) {
        const bool enters = hit->faces_origin;
        if (enters && !may_enter) break;
        depth = enters ? depth + 1 : std::max(depth - 1, 0);
        if (enters) continue;
        may_enter = depth > 0;
        (depth == 0 ? left : left_within) = outwards.seen(*hit);
    }
    if (!left) left = left_within;
    if (!left) left = first_inwards;
    point = left.value_or(ProjectedPoint{});
    return inwards.rays + outwards.rays;
}

}  // namespace relief
