// SPDX-License-Identifier: Apache-2.0
// Generalized winding numbers. Tests: tests/mesh/topology/winding_number_test.cpp.
#include "topology/winding_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/direction.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

constexpr std::uint32_t leaf_size = 8;

/// Returns half of the signed solid angle of a triangle; 0 at its plane's edges and corners.
double half_solid_angle(const WoundTriangle& triangle, const glm::dvec3& point) {
    const glm::dvec3 a = triangle[0] - point;
    const glm::dvec3 b = triangle[1] - point;
    const glm::dvec3 c = triangle[2] - point;
    const double length_a = std::sqrt(glm::dot(a, a));
    const double length_b = std::sqrt(glm::dot(b, b));
    const double length_c = std::sqrt(glm::dot(c, c));
    const double volume = glm::dot(a, glm::cross(b, c));
    const double divisor = length_a * length_b * length_c + glm::dot(a, b) * length_c +
                           glm::dot(b, c) * length_a + glm::dot(c, a) * length_b;
    if (volume == 0.0) return 0.0;
    return portable::atan2(volume, divisor);
}

/// Returns a triangle that begins with its smallest corner, with the same winding.
WoundTriangle canonical(const WoundTriangle& triangle) {
    std::size_t first = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if (comes_before(triangle[i], triangle[first])) first = i;
    }
    return {triangle[first], triangle[(first + 1) % 3], triangle[(first + 2) % 3]};
}

glm::dvec3 center_of(const WoundTriangle& triangle) {
    return (triangle[0] + triangle[1] + triangle[2]) / 3.0;
}

}  // namespace

double exact_winding_number(std::span<const WoundTriangle> triangles, const glm::dvec3& point) {
    double sum = 0.0;
    for (const WoundTriangle& triangle : triangles)
        sum += half_solid_angle(triangle, point);
    return sum / (2.0 * std::numbers::pi);
}

WindingTree::WindingTree(std::vector<WoundTriangle> triangles) : sorted_(std::move(triangles)) {
    for (WoundTriangle& triangle : sorted_)
        triangle = canonical(triangle);
    std::ranges::sort(sorted_, [](const WoundTriangle& a, const WoundTriangle& b) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (a[i] != b[i]) return comes_before(a[i], b[i]);
        }
        return false;
    });
    triangles_.resize(sorted_.size());
    std::vector<std::uint32_t> order(sorted_.size());
    std::iota(order.begin(), order.end(), 0U);
    nodes_.emplace_back();
    build(0, order, 0);
    sorted_ = {};
}

/// Divides triangles at the median of their centers along the longest side of the box of these.
void WindingTree::build(std::uint32_t node, std::span<std::uint32_t> triangles,
                        std::size_t offset) {
    nodes_[node].first = static_cast<std::uint32_t>(offset);
    nodes_[node].count = static_cast<std::uint32_t>(triangles.size());
    if (triangles.size() <= leaf_size) {
        std::ranges::sort(triangles);
        for (std::size_t i = 0; i < triangles.size(); ++i)
            triangles_[offset + i] = sorted_[triangles[i]];
        sum(nodes_[node]);
        return;
    }
    glm::dvec3 low = center_of(sorted_[triangles[0]]);
    glm::dvec3 high = low;
    for (const std::uint32_t triangle : triangles) {
        low = glm::min(low, center_of(sorted_[triangle]));
        high = glm::max(high, center_of(sorted_[triangle]));
    }
    const glm::dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::size_t half = triangles.size() / 2;
    // Equal centers are in the order of the triangles, so that the halves are determined.
    std::ranges::nth_element(triangles, triangles.begin() + static_cast<std::ptrdiff_t>(half),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 const double at_a = center_of(sorted_[a])[axis];
                                 const double at_b = center_of(sorted_[b])[axis];
                                 return at_a != at_b ? at_a < at_b : a < b;
                             });
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].children = children;
    nodes_.resize(nodes_.size() + 2);
    build(children, triangles.first(half), offset);
    build(children + 1, triangles.subspan(half), offset + half);
    sum(nodes_[node]);
}

/// Computes the sums over the triangles of a node, in the order of the leaves.
void WindingTree::sum(Node& node) const {
    const std::span<const WoundTriangle> triangles(&triangles_[node.first], node.count);
    double area = 0.0;
    glm::dvec3 center(0.0);
    glm::dvec3 mean(0.0);
    for (const WoundTriangle& triangle : triangles) {
        const glm::dvec3 normal =
            0.5 * glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        const double weight = std::sqrt(glm::dot(normal, normal));
        area += weight;
        center += weight * center_of(triangle);
        mean += center_of(triangle);
        node.normal += normal;
    }
    node.center = area > 0.0 ? center / area : mean / static_cast<double>(triangles.size());
    double squared = 0.0;
    for (const WoundTriangle& triangle : triangles) {
        const glm::dvec3 normal =
            0.5 * glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        const glm::dvec3 offset = center_of(triangle) - node.center;
        for (int i = 0; i < 3; ++i)
            node.moment[i] += normal[i] * offset;
        for (const glm::dvec3& corner : triangle)
            squared = std::max(squared, glm::dot(corner - node.center, corner - node.center));
    }
    node.radius = std::sqrt(squared);
}

double WindingTree::winding_number(const glm::dvec3& point, double far_radii) const {
    double near = 0.0;  // Half solid angles.
    double far = 0.0;   // Solid angles.
    std::array<std::uint32_t, 128> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        const glm::dvec3 to = node.center - point;
        const double squared = glm::dot(to, to);
        const double reach = far_radii * node.radius;
        if (squared > reach * reach) {
            // The series of n . r / |r|^3 for r = to + offset.
            const double cubed = squared * std::sqrt(squared);
            const glm::dmat3& m = node.moment;
            const double trace = m[0][0] + m[1][1] + m[2][2];
            const double form =
                to.x * glm::dot(m[0], to) + to.y * glm::dot(m[1], to) + to.z * glm::dot(m[2], to);
            far += (glm::dot(node.normal, to) + trace - 3.0 * form / squared) / cubed;
        } else if (node.children == 0) {
            for (std::uint32_t i = 0; i < node.count; ++i)
                near += half_solid_angle(triangles_[node.first + i], point);
        } else {
            stack[depth++] = node.children + 1;
            stack[depth++] = node.children;
        }
    }
    return near / (2.0 * std::numbers::pi) + far / (4.0 * std::numbers::pi);
}

}  // namespace relief::detail
