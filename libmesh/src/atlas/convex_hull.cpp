// SPDX-License-Identifier: Apache-2.0
#include "atlas/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace relief::detail {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

}  // namespace

std::vector<glm::dvec2> convex_hull(std::vector<glm::dvec2> points) {
    std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    });
    std::vector<glm::dvec2> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t start = hull.size();
        for (const glm::dvec2& point : points) {
            while (hull.size() >= start + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0.0)
                hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

double area_of_hull(std::span<const glm::dvec2> hull) {
    double area = 0.0;
    for (std::size_t i = 2; i < hull.size(); ++i)
        area += 0.5 * cross(hull[i - 1] - hull[0], hull[i] - hull[0]);
    return area;
}

SmallestBox smallest_box(std::span<const glm::dvec2> hull) {
    SmallestBox best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const glm::dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
        const double length = std::sqrt(glm::dot(edge, edge));
        if (!(length > 0.0)) continue;
        const glm::dvec2 along = edge / length;
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        double top = 0.0;
        for (const glm::dvec2& point : hull) {
            const double x = glm::dot(along, point);
            low = std::min(low, x);
            high = std::max(high, x);
            top = std::max(top, cross(along, point - hull[i]));
        }
        if ((high - low) * top >= least) continue;
        least = (high - low) * top;
        best = {along, least};
    }
    return best;
}

}  // namespace relief::detail
