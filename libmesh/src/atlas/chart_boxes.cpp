// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "atlas/flat_charts.h"

namespace relief::detail {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// The convex hull, counter-clockwise.
std::vector<glm::dvec2> hull_of(std::vector<glm::dvec2> points) {
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

/// The cosine and sine of the rotation after which the box is smallest.
glm::dvec2 best_rotation(std::span<const glm::dvec2> hull) {
    glm::dvec2 best(1.0, 0.0);
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
        best = {along.x, -along.y};
    }
    return best;
}

}  // namespace

void align_to_box(FlatChart& chart) {
    const glm::dvec2 turn = best_rotation(hull_of(chart.coordinates));
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    for (glm::dvec2& each : chart.coordinates) {
        each = {turn.x * each.x - turn.y * each.y, turn.y * each.x + turn.x * each.y};
        low = glm::min(low, each);
        high = glm::max(high, each);
    }
    for (glm::dvec2& each : chart.coordinates)
        each -= low;
    chart.size = high - low;
}

}  // namespace relief::detail
