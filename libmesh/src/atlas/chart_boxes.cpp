// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "atlas/convex_hull.h"
#include "atlas/flat_charts.h"

namespace relief::detail {

void align_to_box(FlatChart& chart) {
    const glm::dvec2 axis = smallest_box(convex_hull(chart.coordinates)).axis;
    const glm::dvec2 turn(axis.x, -axis.y);
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
