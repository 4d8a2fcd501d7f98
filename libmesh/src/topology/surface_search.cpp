// SPDX-License-Identifier: Apache-2.0
// The hierarchy of a surface: its order along a curve, slabs of long triangles, boxes and prisms,
// and the search. Tests: tests/mesh/topology/surface_distance_test.cpp.
#include "topology/surface_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "geometry/direction.h"
#include "parallel.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The longest edge of a triangle, and its normal with twice the area as length.
struct Extent {
    glm::dvec3 edge{0.0};
    glm::dvec3 normal{0.0};

    /// Returns whether the triangle is at least 8 times as long as it is wide.
    [[nodiscard]] bool is_thin() const { return glm::dot(edge, edge) > 8.0 * glm::length(normal); }
};

Extent extent_of(const Corners& corners) {
    Extent extent;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
        if (glm::dot(edge, edge) > glm::dot(extent.edge, extent.edge)) extent.edge = edge;
    }
    extent.normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    return extent;
}

/// Returns a unit vector perpendicular to a unit vector.
glm::dvec3 perpendicular(const glm::dvec3& unit) {
    const glm::dvec3 away = std::abs(unit.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(glm::cross(unit, away));
}

/// Returns the key of a point along a curve through space, with 20 bits for each axis.
std::uint64_t curve_key(const glm::dvec3& offset, double longest) {
    // Moves bit i to bit 3 i: the upper half of each group of bits moves away from the lower one.
    const auto spread = [&](double x) {
        auto bits = static_cast<std::uint64_t>(std::clamp(x / longest * 1048575.0, 0.0, 1048575.0));
        bits = (bits | bits << 32) & 0x001f00000000ffff;
        bits = (bits | bits << 16) & 0x001f0000ff0000ff;
        bits = (bits | bits << 8) & 0x100f00f00f00f00f;
        bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
        return (bits | bits << 2) & 0x1249249249249249;
    };
    return spread(offset.x) | (spread(offset.y) << 1) | (spread(offset.z) << 2);
}

/// Returns an order of things along the curve through their centers.
template <typename Center>
std::vector<std::uint32_t> order_along_curve(const Mesh& mesh, std::size_t count,
                                             const Center& center) {
    const Bounds bounds = bounds_of(mesh);
    const glm::dvec3 low(bounds.min);
    const glm::dvec3 size = glm::dvec3(bounds.max) - low;
    const double longest = std::max({size.x, size.y, size.z, 1e-300});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(count);
    parallel_for(count, 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            keys[i] = {curve_key(center(i) - low, longest), static_cast<std::uint32_t>(i)};
    });
    check_cancelled();
    std::sort(keys.begin(), keys.end());
    check_cancelled();
    std::vector<std::uint32_t> order;
    order.reserve(count);
    for (const auto& key : keys)
        order.push_back(key.second);
    return order;
}

}  // namespace

SurfaceSearch::SurfaceSearch(const Mesh& mesh) : mesh_(mesh) {
    for (const glm::uvec3& t : mesh.triangles) {
        if (is_finite(mesh.positions[t.x]) && is_finite(mesh.positions[t.y]) &&
            is_finite(mesh.positions[t.z]))
            triangles_.push_back(t);
    }
    if (triangles_.empty()) return;
    gather_corners();
    sort_along_curve();
    gather_corners();
    build();
}

void SurfaceSearch::gather_corners() {
    corners_.resize(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        check_cancelled(t);
        for (int i = 0; i < 3; ++i)
            corners_[t][static_cast<std::size_t>(i)] = mesh_.positions[triangles_[t][i]];
    }
}

void SurfaceSearch::sort_along_curve() {
    const auto order = order_along_curve(mesh_, size(), [&](std::size_t t) {
        const Corners at = corners(t);
        return (at[0] + at[1] + at[2]) / 3.0;
    });
    std::vector<glm::uvec3> sorted;
    sorted.reserve(order.size());
    for (const std::uint32_t t : order)
        sorted.push_back(triangles_[t]);
    triangles_ = std::move(sorted);
}

/// Returns the length of slabs at which their number is limited.
double SurfaceSearch::slab_length(std::size_t more) const {
    double longest = 0.0;
    for (std::size_t t = 0; t < size(); ++t)
        longest = std::max(longest, glm::length(extent_of(corners(t)).edge));
    const auto count = [&](double length) {
        double sum = 0.0;
        check_cancelled();
        for (std::size_t t = 0; t < size(); ++t)
            sum += std::ceil(glm::length(extent_of(corners(t)).edge) / length);
        return sum;
    };
    constexpr int max_halvings = 12;
    double length = longest;
    for (int i = 0; i < max_halvings; ++i) {
        if (!(length > 0.0) || count(length / 2.0) > static_cast<double>(size() + more)) break;
        length /= 2.0;
    }
    return length;
}

/// Adds the parts of a triangle between planes across its longest edge.
void SurfaceSearch::add_slabs(std::uint32_t triangle, double length) {
    Corners at = corners(triangle);
    // The longest edge is that from corner 0 to corner 1.
    const auto edge = [&](std::size_t i) { return at[(i + 1) % 3] - at[i]; };
    std::size_t first = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if (glm::dot(edge(i), edge(i)) > glm::dot(edge(first), edge(first))) first = i;
    }
    std::rotate(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(first), at.end());
    const glm::dvec3 along = edge(0);
    const double squared = glm::dot(along, along);
    const auto count = static_cast<std::size_t>(
        std::max(1.0, length > 0.0 ? std::ceil(std::sqrt(squared) / length) : 1.0));
    const double apex =
        squared > 0.0 ? std::clamp(glm::dot(at[2] - at[0], along) / squared, 0.0, 1.0) : 0.0;
    const glm::dvec3 largest =
        glm::max(glm::abs(at[0]), glm::max(glm::abs(at[1]), glm::abs(at[2])));
    const double margin = 1e-12 * (largest.x + largest.y + largest.z);
    // The point on the two other edges, at a part of the longest edge.
    const auto beside = [&](double part) {
        if (part < apex) return at[0] + (part / apex) * (at[2] - at[0]);
        return apex < 1.0 ? at[2] + ((part - apex) / (1.0 - apex)) * (at[1] - at[2]) : at[2];
    };
    for (std::size_t i = 0; i < count; ++i) {
        const double begin = static_cast<double>(i) / static_cast<double>(count);
        const double end = static_cast<double>(i + 1) / static_cast<double>(count);
        glm::dvec3 low(std::numeric_limits<double>::infinity());
        glm::dvec3 high(-low);
        const auto add = [&](const glm::dvec3& p) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        };
        add(at[0] + begin * along);
        add(at[0] + end * along);
        add(beside(begin));
        add(beside(end));
        if (begin <= apex && apex <= end) add(at[2]);
        // Rounding to single precision must not make the box smaller.
        constexpr float limit = std::numeric_limits<float>::infinity();
        Slab slab{{}, triangle};
        for (int k = 0; k < 3; ++k) {
            slab.box.low[k] = std::nextafter(static_cast<float>(low[k] - margin), -limit);
            slab.box.high[k] = std::nextafter(static_cast<float>(high[k] + margin), limit);
        }
        slabs_.push_back(slab);
    }
}

void SurfaceSearch::sort_slabs() {
    const auto order = order_along_curve(mesh_, slabs_.size(), [&](std::size_t i) {
        return (glm::dvec3(slabs_[i].box.low) + glm::dvec3(slabs_[i].box.high)) / 2.0;
    });
    std::vector<Slab> sorted;
    sorted.reserve(order.size());
    for (const std::uint32_t i : order)
        sorted.push_back(slabs_[i]);
    slabs_ = std::move(sorted);
}

void SurfaceSearch::divide(std::size_t more) {
    const double length = slab_length(more);
    slabs_.clear();
    for (std::uint32_t t = 0; t < size(); ++t) {
        check_cancelled(t);
        add_slabs(t, length);
    }
    sort_slabs();
    prisms_.clear();
    prism_of_node_.clear();
    build();
}

void SurfaceSearch::build() {
    leaves_ = std::bit_ceil((items() + leaf_size - 1) / leaf_size);
    boxes_.assign(2 * leaves_, Box());
    for (std::size_t i = 0; i < items(); ++i) {
        check_cancelled(i);
        Box& box = boxes_[leaves_ + i / leaf_size];
        const Box of_item = box_of(i);
        box.add(of_item.low);
        box.add(of_item.high);
    }
    for (std::size_t node = leaves_ - 1; node > 0; --node) {
        for (const std::size_t child : {2 * node, 2 * node + 1}) {
            boxes_[node].low = glm::min(boxes_[node].low, boxes_[child].low);
            boxes_[node].high = glm::max(boxes_[node].high, boxes_[child].high);
        }
    }
}

void SurfaceSearch::add_prisms() {
    constexpr std::size_t max_leaves = 256;
    std::vector<std::uint8_t> is_thin(leaves_, 0);
    parallel_for(leaves_, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t leaf = begin; leaf < end; ++leaf) {
            const std::size_t last = std::min((leaf + 1) * leaf_size, size());
            for (std::size_t t = leaf * leaf_size; t < last; ++t)
                is_thin[leaf] |= static_cast<std::uint8_t>(extent_of(corners(t)).is_thin());
        }
    });
    struct Piece {
        std::size_t node, begin, end;
    };
    std::vector<Piece> pieces;
    for (std::size_t leaves = 1; leaves <= std::min(max_leaves, leaves_); leaves *= 2) {
        check_cancelled();
        for (std::size_t first = 0; first < leaves_; first += leaves) {
            const auto begin = is_thin.begin() + static_cast<std::ptrdiff_t>(first);
            if (std::find(begin, begin + static_cast<std::ptrdiff_t>(leaves), 1) ==
                begin + static_cast<std::ptrdiff_t>(leaves))
                continue;
            pieces.push_back({(leaves_ + first) / leaves, first * leaf_size,
                              std::min((first + leaves) * leaf_size, size())});
        }
    }
    if (pieces.empty()) return;
    prism_of_node_.assign(2 * leaves_, no_prism);
    prisms_.resize(pieces.size());
    parallel_for(pieces.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            prism_of_node_[pieces[i].node] = static_cast<std::uint32_t>(i);
            prisms_[i] = prism_of(pieces[i].begin, pieces[i].end);
        }
    });
}

SurfaceSearch::Prism SurfaceSearch::prism_of(std::size_t begin, std::size_t end) const {
    glm::dvec3 along(0.0);
    glm::dvec3 normal(0.0);
    for (std::size_t t = begin; t < end; ++t) {
        const Extent extent = extent_of(corners(t));
        along += glm::dot(extent.edge, along) < 0.0 ? -extent.edge : extent.edge;
        normal += glm::dot(extent.normal, normal) < 0.0 ? -extent.normal : extent.normal;
    }
    const double length = glm::length(along);
    along = length > 0.0 ? along / length : glm::dvec3(1, 0, 0);
    normal -= glm::dot(normal, along) * along;
    const double height = glm::length(normal);
    Prism prism;
    prism.across[0] = height > 0.0 ? normal / height : perpendicular(along);
    prism.across[1] = glm::cross(along, prism.across[0]);
    for (std::size_t t = begin; t < end; ++t) {
        for (const glm::dvec3& corner : corners(t))
            prism.add(corner);
    }
    // Projections are rounded relative to coordinates.
    const glm::dvec3 largest =
        glm::max(glm::abs(glm::dvec3(boxes_[1].low)), glm::abs(glm::dvec3(boxes_[1].high)));
    const double margin = 1e-14 * (largest.x + largest.y + largest.z);
    for (std::size_t i = 0; i < 2; ++i) {
        prism.low[i] -= margin;
        prism.high[i] += margin;
    }
    return prism;
}

/// Finds the nearest triangle; a good guess makes it faster. Ties: the lowest index wins.
NearestTriangle SurfaceSearch::nearest(const glm::dvec3& p, std::uint32_t guess, SearchWork& work,
                                       double enough) const {
    constexpr SearchWork of_triangle = 4;
    NearestTriangle best{squared_distance(p, corners(guess)), guess};
    if (best.squared < enough) return best;
    std::array<std::pair<double, std::size_t>, 64> stack;
    std::size_t height = 0;
    stack[height++] = entry(p, 1, best.squared);
    while (height > 0) {
        const auto [distance, node] = stack[--height];
        if (distance > best.squared) continue;
        if (node >= leaves_) {
            const std::size_t first = (node - leaves_) * leaf_size;
            const std::size_t last = std::min(first + leaf_size, items());
            for (std::size_t i = first; i < last; ++i) {
                ++work;
                if (box_of(i).squared_distance(p) > best.squared) continue;
                work += of_triangle;
                const std::uint32_t index = triangle_of(i);
                const double here = squared_distance(p, corners(index));
                if (here < best.squared || (here == best.squared && index < best.triangle))
                    best = {here, index};
            }
            if (best.squared < enough) return best;
            continue;
        }
        work += 2;
        std::pair<double, std::size_t> near = entry(p, 2 * node, best.squared);
        std::pair<double, std::size_t> far = entry(p, 2 * node + 1, best.squared);
        if (far.first < near.first) std::swap(near, far);
        if (far.first <= best.squared) stack[height++] = far;
        if (near.first <= best.squared) stack[height++] = near;
    }
    return best;
}
}  // namespace relief::detail
