// SPDX-License-Identifier: Apache-2.0
// The errors of edge collapses. A vertex moves to a new place only before planes are forgotten, or
// at the end, so the error that has accumulated at a vertex is one number, and the cost of moving v
// onto u is the quadric of v at u plus that number of u. Tests:
// tests/mesh/topology/decimate_test.cpp.
#include <algorithm>

#include "topology/edge_collapse_parts.h"

namespace relief::detail {

CollapseError::CollapseError(const CollapseInput& input, const CollapseSurface& surface)
    : input_(input),
      surface_(surface),
      quadrics_(input.positions.size()),
      errors_(input.positions.size(), 0.0),
      areas_(input.positions.size(), 0.0) {
    if (input_.attribute_weights.empty()) return;
    sums_per_wedge_ = 1 + 4 * input_.attribute_weights.size();
    attribute_sums_.assign(input_.wedge_count * sums_per_wedge_, 0.0);
}

void CollapseError::add_triangle(std::size_t triangle, const glm::dvec3& normal,
                                 double doubled_area) {
    const auto first = static_cast<Corner>(3 * triangle);
    const glm::dvec3 a = input_.point(surface_[first].vertex);
    const double area = doubled_area / 2.0;
    Quadric quadric;
    quadric.add(area, normal, -glm::dot(normal, a));
    for (Corner corner = first; corner < first + 3; ++corner) {
        quadrics_[surface_[corner].vertex] += quadric;
        areas_[surface_[corner].vertex] += area;
    }
    if (sums_per_wedge_ > 0) add_attributes(triangle, normal, doubled_area);
}

/// The gradient in the plane of the triangle results from the dual basis of its edges.
void CollapseError::add_attributes(std::size_t triangle, const glm::dvec3& normal,
                                   double doubled_area) {
    const auto first = static_cast<Corner>(3 * triangle);
    const glm::dvec3 a = input_.point(surface_[first].vertex);
    const glm::dvec3 dual_b =
        glm::cross(input_.point(surface_[first + 2].vertex) - a, normal) / doubled_area;
    const glm::dvec3 dual_c =
        glm::cross(normal, input_.point(surface_[first + 1].vertex) - a) / doubled_area;
    const double area = doubled_area / 2.0;
    const std::span<const float> at_a = input_.attributes_at(surface_[first].wedge);
    const std::span<const float> at_b = input_.attributes_at(surface_[first + 1].wedge);
    const std::span<const float> at_c = input_.attributes_at(surface_[first + 2].wedge);
    Quadric quadric;
    std::array<double, 1 + 4 * max_attributes> sums{};
    sums[0] = area;
    for (std::size_t k = 0; k < input_.attribute_weights.size(); ++k) {
        const double weight = area * input_.attribute_weights[k];
        const double value = at_a[k];
        const glm::dvec3 gradient = (at_b[k] - value) * dual_b + (at_c[k] - value) * dual_c;
        const double offset = value - glm::dot(gradient, a);
        quadric.add(weight, gradient, offset);
        sums[4 * k + 1] = weight * gradient.x;
        sums[4 * k + 2] = weight * gradient.y;
        sums[4 * k + 3] = weight * gradient.z;
        sums[4 * k + 4] = weight * offset;
    }
    for (Corner corner = first; corner < first + 3; ++corner) {
        quadrics_[surface_[corner].vertex] += quadric;
        const std::span<double> sum = attribute_sums(surface_[corner].wedge);
        for (std::size_t k = 0; k < sum.size(); ++k)
            sum[k] += sums[k];
    }
}

void CollapseError::add_lines(std::size_t triangle) {
    const auto first = static_cast<Corner>(3 * triangle);
    for (Corner corner = first; corner < first + 3; ++corner) {
        const Corner next = next_in_triangle(corner);
        if (!surface_.is_line_at(corner, surface_[corner].wedge) &&
            !surface_.is_line_at(corner, surface_[next].wedge))
            continue;
        const std::uint32_t from = surface_[corner].vertex;
        const std::uint32_t to = surface_[next].vertex;
        const glm::dvec3 along = input_.point(to) - input_.point(from);
        const glm::dvec3 upright = glm::cross(
            along, glm::cross(along, input_.point(surface_[next_in_triangle(next)].vertex) -
                                         input_.point(from)));
        const double length = glm::length(upright);
        if (!(length > 0.0)) continue;
        const glm::dvec3 normal = upright / length;
        Quadric quadric;
        quadric.add(glm::dot(along, along), normal, -glm::dot(normal, input_.point(from)));
        quadrics_[from] += quadric;
        quadrics_[to] += quadric;
    }
}

void CollapseError::forget_planes() {
    // Without attributes, no ring is needed.
    Ring ring;
    for (std::uint32_t v = 0; v < quadrics_.size(); ++v) {
        if (sums_per_wedge_ == 0)
            errors_[v] = std::max(0.0, quadrics_[v](input_.point(v)));
        else if (!surface_.is_removed(v) && surface_.find_ring(v, ring))
            errors_[v] = std::max(0.0, local(v, ring).value);
        errors_[v] = areas_[v] > 0.0 ? errors_[v] / areas_[v] : 0.0;
    }
    std::fill(quadrics_.begin(), quadrics_.end(), Quadric());
    std::fill(areas_.begin(), areas_.end(), 0.0);
    std::fill(attribute_sums_.begin(), attribute_sums_.end(), 0.0);
}

void CollapseError::spread_errors() {
    for (std::uint32_t v = 0; v < errors_.size(); ++v)
        errors_[v] *= areas_[v];
}

void CollapseError::merge(std::uint32_t vertex, const Move& move) {
    errors_[move.target] += std::max(0.0, own_cost(vertex, move));
    quadrics_[move.target] += quadrics_[vertex];
    areas_[move.target] += areas_[vertex];
    if (sums_per_wedge_ > 0) {
        for (std::size_t side = 0; side < 2; ++side) {
            if (move.before[side] == no_corner || (side == 1 && move.before[1] == move.before[0]))
                continue;
            const std::span<double> from = attribute_sums(move.before[side]);
            const std::span<double> to = attribute_sums(move.after[side]);
            for (std::size_t k = 0; k < to.size(); ++k)
                to[k] += from[k];
        }
    }
}

CollapseError::Local CollapseError::local(std::uint32_t vertex, const Ring& ring) const {
    const Quadric& q = quadrics_[vertex];
    const glm::dvec3 p = input_.point(vertex);
    Local result{q(p),
                 {q.xx * p.x + q.xy * p.y + q.xz * p.z + q.linear.x,
                  q.xy * p.x + q.yy * p.y + q.yz * p.z + q.linear.y,
                  q.xz * p.x + q.yz * p.y + q.zz * p.z + q.linear.z}};
    std::uint32_t last = no_corner;
    for (std::size_t i = 0; sums_per_wedge_ > 0 && i < ring.size; ++i) {
        const std::uint32_t wedge = surface_[ring.corners[i]].wedge;
        if (wedge == last) continue;
        last = wedge;
        // On a closed ring with a line, the first wedge may come again at the end.
        if (i > 0 && wedge == surface_[ring.corners[0]].wedge) break;
        const double* sums = &attribute_sums_[wedge * sums_per_wedge_];
        const std::span<const float> values = input_.attributes_at(wedge);
        for (std::size_t k = 0; k < values.size(); ++k) {
            const double* s = sums + 4 * k + 1;
            const double value = values[k];
            result.slope -= value * glm::dvec3(s[0], s[1], s[2]);
            result.value += value * (sums[0] * input_.attribute_weights[k] * value -
                                     2.0 * (s[0] * p.x + s[1] * p.y + s[2] * p.z + s[3]));
        }
    }
    return result;
}

/// The minimum is the mean height of the planes above the vertex. On a curved surface, triangles
/// between such vertices still lie below the surface by about half as much (measured on tori), so
/// the vertex moves on by that. There, a quarter of the quadric remains at the minimum; at a
/// corner, which the minimum restores exactly, nothing does. If the planes are nearly parallel, the
/// minimum may be far away: an offset of more than 16 times the error, its root mean square over
/// the area, is refused.
glm::dvec3 CollapseError::fitted_offset(std::uint32_t vertex, const Ring& ring) const {
    constexpr double damping = 1e-3;
    constexpr double beyond = 0.55;
    constexpr double remainder_of_curvature = 0.25;
    constexpr double most = 16.0;
    const Quadric& q = quadrics_[vertex];
    const auto [before, slope] = local(vertex, ring);
    const double trace = q.xx + q.yy + q.zz;
    const double xx = q.xx + damping * trace;
    const double yy = q.yy + damping * trace;
    const double zz = q.zz + damping * trace;
    const glm::dvec3 row_x(xx, q.xy, q.xz);
    const glm::dvec3 row_y(q.xy, yy, q.yz);
    const glm::dvec3 row_z(q.xz, q.yz, zz);
    const glm::dvec3 yz = glm::cross(row_y, row_z);
    const double determinant = glm::dot(row_x, yz);
    if (!(determinant > 0.0) || !(before > collapse_rounding * trace)) return glm::dvec3(0.0);
    const glm::dvec3 offset =
        -(slope.x * yz + slope.y * glm::cross(row_z, row_x) + slope.z * glm::cross(row_x, row_y)) /
        determinant;
    const double after = before + glm::dot(slope, offset);
    if (glm::dot(offset, offset) * areas_[vertex] > most * most * before) return glm::dvec3(0.0);
    const double remainder = std::clamp(after / (remainder_of_curvature * before), 0.0, 1.0);
    return (1.0 + beyond * remainder) * offset;
}

double CollapseError::plane_distance(std::uint32_t vertex) const {
    return std::sqrt(std::max(0.0, quadrics_[vertex](input_.point(vertex))) / areas_[vertex]);
}

}  // namespace relief::detail
