// SPDX-License-Identifier: Apache-2.0
/// \file
/// A checker of what unwrap() promises for every mesh: it decides by pairs of triangles, in
/// integers, that nothing overlaps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "relief/mesh/unwrap.h"

namespace relief::test {

/// Texture coordinates on the lattice, y up.
struct AtlasPoint {
    std::int64_t x, y;
    friend bool operator==(const AtlasPoint&, const AtlasPoint&) = default;
};
using AtlasCorners = std::array<AtlasPoint, 3>;

inline AtlasPoint point_of(const glm::vec2& texcoord) {
    return {static_cast<std::int64_t>(texcoord.x * 0x1p24),
            static_cast<std::int64_t>(0x1p24 - texcoord.y * 0x1p24)};
}

inline std::int64_t area_of(const AtlasPoint& a, const AtlasPoint& b, const AtlasPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// True if an edge of `a` has all of `b` on its outer side.
inline bool separates(const AtlasCorners& a, const AtlasCorners& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        const auto is_outside = [&](const AtlasPoint& p) {
            return area_of(a[i], a[(i + 1) % 3], p) <= 0;
        };
        if (std::all_of(b.begin(), b.end(), is_outside)) return true;
    }
    return false;
}

/// The triangles of an atlas that have a chart.
struct ChartTriangles {
    std::vector<AtlasCorners> corners;
    std::vector<std::uint32_t> chart;
    std::size_t without_chart = 0;
};

inline ChartTriangles triangles_of(const Unwrapped& unwrapped) {
    ChartTriangles result;
    for (std::size_t t = 0; t < unwrapped.chart.size(); ++t) {
        if (!unwrapped.chart[t]) {
            ++result.without_chart;
            continue;
        }
        const glm::vec2* const uv = &unwrapped.corner_texcoords[3 * t];
        result.corners.push_back({point_of(uv[0]), point_of(uv[1]), point_of(uv[2])});
        result.chart.push_back(*unwrapped.chart[t]);
    }
    return result;
}

/// Returns the first violation of what unwrap() promises for every mesh, or an empty string.
inline std::string broken_promise(const Unwrapped& unwrapped) {
    for (const glm::vec2& uv : unwrapped.corner_texcoords) {
        for (const float x : {uv.x, uv.y}) {
            if (!(x >= 0.0F && x <= 1.0F)) return "a coordinate outside of [0,1]";
            if (std::floor(x * 0x1p24) != x * 0x1p24) return "a coordinate off the lattice";
        }
    }
    const ChartTriangles checked = triangles_of(unwrapped);
    std::vector<std::size_t> order(checked.corners.size());
    const auto low = [&](std::size_t i) {
        const AtlasCorners& c = checked.corners[i];
        return std::min({c[0].x, c[1].x, c[2].x});
    };
    const auto high = [&](std::size_t i) {
        const AtlasCorners& c = checked.corners[i];
        return std::max({c[0].x, c[1].x, c[2].x});
    };
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
        const AtlasCorners& c = checked.corners[i];
        if (area_of(c[0], c[1], c[2]) <= 0) return "an inverted or flat triangle";
    }
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return low(a) < low(b); });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const AtlasCorners& a = checked.corners[order[i]];
        for (std::size_t j = i + 1; j < order.size() && low(order[j]) < high(order[i]); ++j) {
            const AtlasCorners& b = checked.corners[order[j]];
            const auto is_corner = [&](const AtlasPoint& p) {
                return std::find(a.begin(), a.end(), p) != a.end();
            };
            // Repeated triangles have the same coordinates.
            if (std::all_of(b.begin(), b.end(), is_corner)) continue;
            if (!separates(a, b) && !separates(b, a)) return "triangles that overlap";
        }
    }
    return "";
}

}  // namespace relief::test
