// SPDX-License-Identifier: Apache-2.0
// The distance between surfaces, by closest points on a bounding volume hierarchy. The triangles of
// the hierarchy are sorted along a curve through space and grouped in pairs, so it is a complete
// binary tree in an array. Axis-aligned boxes of long, thin triangles overlap: in a fan, a point is
// in the boxes of a large part of the triangles. Nodes with such triangles have a second bound, an
// oriented prism. If they cross each other in all directions, prisms do not help; then the
// triangles are divided into slabs with boxes of their own, which refer to the whole triangle. The
// time is limited: the work of a search is measured first, and if all searches together would
// exceed the limit, fewer points are examined, and the others are counted.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "geometry/direction.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relief/mesh/topology.h"
#include "topology/triangle_distance.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Positions are in single precision, so boxes in single precision are exact.
struct Box {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};

    void add(const glm::vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    [[nodiscard]] double squared_distance(const glm::dvec3& p) const {
        // Written for each axis, which compiles without branches.
        const auto away = [](double from, double to, double at) {
            return std::max(std::max(from - at, at - to), 0.0);
        };
        const double x = away(low.x, high.x, p.x);
        const double y = away(low.y, high.y, p.y);
        const double z = away(low.z, high.z, p.z);
        return x * x + y * y + z * z;
    }
};

/// An infinite prism with a rectangular cross-section, along the mean direction of long triangles.
struct Prism {
    std::array<glm::dvec3, 2> across;  ///< Perpendicular to the prism and to each other.
    std::array<double, 2> low{infinite, infinite};
    std::array<double, 2> high{-infinite, -infinite};

    void add(const glm::dvec3& p) {
        for (std::size_t i = 0; i < 2; ++i) {
            const double at = glm::dot(across[i], p);
            low[i] = std::min(low[i], at);
            high[i] = std::max(high[i], at);
        }
    }
    /// Returns a lower bound of the squared distance, which considers the rounding of `across`.
    [[nodiscard]] double squared_distance(const glm::dvec3& p) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < 2; ++i) {
            const double at = glm::dot(across[i], p);
            const double away = std::max({low[i] - at, at - high[i], 0.0});
            sum += away * away;
        }
        return sum * (1.0 - 1e-12);
    }
};

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

/// The work of a search: the number of examined boxes, a triangle counting as four.
using Work = std::uint64_t;

/// The mean work of a search that needs no limit: that on a surface without thin triangles is about
/// 150.
constexpr Work little_work = 500;

/// Beyond that, the work for all vertices, which takes one to six seconds of processor time.
constexpr Work max_work = 200'000'000;

/// The triangle that is nearest to a point.
struct Nearest {
    double squared = infinite;
    std::uint32_t triangle = 0;  ///< Index in the surface.
};

/// The finite triangles of a mesh, with a hierarchy.
class Surface {
  public:
    explicit Surface(const Mesh& mesh);

    [[nodiscard]] std::size_t size() const { return triangles_.size(); }
    [[nodiscard]] Corners corners(std::size_t triangle) const {
        const auto& at = corners_[triangle];
        return {glm::dvec3(at[0]), glm::dvec3(at[1]), glm::dvec3(at[2])};
    }
    [[nodiscard]] const glm::uvec3& vertices(std::size_t triangle) const {
        return triangles_[triangle];
    }
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    /// A bound of the rounding of positions in single precision.
    [[nodiscard]] double rounding() const {
        const glm::dvec3 size = glm::dvec3(boxes_[1].high) - glm::dvec3(boxes_[1].low);
        return 1e-7 * std::max({size.x, size.y, size.z});
    }
    /// \param enough  a search ends at a triangle within this squared distance
    [[nodiscard]] Nearest nearest(const glm::dvec3& p, std::uint32_t guess, Work& work,
                                  double enough = 0.0) const;
    /// Adds prisms to the nodes that have thin triangles and are not too large, so that the time is
    /// linear. The results of searches do not change.
    void add_prisms();
    /// Divides long triangles into up to `more` additional slabs, and builds the hierarchy of
    /// these. The results of searches do not change.
    void divide(std::size_t more);

  private:
    /// A part of a triangle.
    struct Slab {
        Box box;
        std::uint32_t triangle;
    };

    void gather_corners();
    void sort_along_curve();
    [[nodiscard]] double slab_length(std::size_t more) const;
    void add_slabs(std::uint32_t triangle, double length);
    void sort_slabs();
    void build();
    [[nodiscard]] Prism prism_of(std::size_t begin, std::size_t end) const;
    /// Returns a lower bound of the squared distance of a node, and the node. The prism is
    /// considered only if the box does not exceed `known`.
    [[nodiscard]] std::pair<double, std::size_t> entry(const glm::dvec3& p, std::size_t node,
                                                       double known) const {
        const double distance = boxes_[node].squared_distance(p);
        const std::uint32_t prism =
            prism_of_node_.empty() || distance > known ? no_prism : prism_of_node_[node];
        return {
            prism == no_prism ? distance : std::max(distance, prisms_[prism].squared_distance(p)),
            node};
    }
    /// The leaves hold the triangles, or the slabs if there are any.
    [[nodiscard]] std::size_t items() const { return slabs_.empty() ? size() : slabs_.size(); }
    [[nodiscard]] std::uint32_t triangle_of(std::size_t item) const {
        return slabs_.empty() ? static_cast<std::uint32_t>(item) : slabs_[item].triangle;
    }
    [[nodiscard]] Box box_of(std::size_t item) const {
        if (!slabs_.empty()) return slabs_[item].box;
        const auto& at = corners_[item];
        return {glm::min(glm::min(at[0], at[1]), at[2]), glm::max(glm::max(at[0], at[1]), at[2])};
    }

    static constexpr std::size_t leaf_size = 4;
    static constexpr std::uint32_t no_prism = std::numeric_limits<std::uint32_t>::max();
    const Mesh& mesh_;
    std::vector<glm::uvec3> triangles_;
    std::vector<std::array<glm::vec3, 3>> corners_;  ///< By triangle.
    std::vector<Slab> slabs_;
    std::size_t leaves_ = 1;  ///< A power of two.
    std::vector<Box> boxes_;  ///< Children of node i are 2i and 2i + 1; leaves begin at leaves_.
    std::vector<Prism> prisms_;
    std::vector<std::uint32_t> prism_of_node_;  ///< Empty if there is no prism.
};

Surface::Surface(const Mesh& mesh) : mesh_(mesh) {
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

void Surface::gather_corners() {
    corners_.resize(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        check_cancelled(t);
        for (int i = 0; i < 3; ++i)
            corners_[t][static_cast<std::size_t>(i)] = mesh_.positions[triangles_[t][i]];
    }
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

void Surface::sort_along_curve() {
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
double Surface::slab_length(std::size_t more) const {
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
void Surface::add_slabs(std::uint32_t triangle, double length) {
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
        glm::dvec3 low(infinite);
        glm::dvec3 high(-infinite);
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

void Surface::sort_slabs() {
    const auto order = order_along_curve(mesh_, slabs_.size(), [&](std::size_t i) {
        return (glm::dvec3(slabs_[i].box.low) + glm::dvec3(slabs_[i].box.high)) / 2.0;
    });
    std::vector<Slab> sorted;
    sorted.reserve(order.size());
    for (const std::uint32_t i : order)
        sorted.push_back(slabs_[i]);
    slabs_ = std::move(sorted);
}

void Surface::divide(std::size_t more) {
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

void Surface::build() {
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

void Surface::add_prisms() {
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

Prism Surface::prism_of(std::size_t begin, std::size_t end) const {
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
Nearest Surface::nearest(const glm::dvec3& p, std::uint32_t guess, Work& work,
                         double enough) const {
    constexpr Work of_triangle = 4;
    Nearest best{squared_distance(p, corners(guess)), guess};
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

/// Returns the mean work of searching for points of another surface, which is at least 1.
///
/// \param most  the maximum number of searches
Work mean_work(const Surface& from, const Surface& to, std::size_t most) {
    const std::size_t count = std::min(most, from.size());
    Work work = 0;
    std::uint32_t guess = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Corners at = from.corners(i * from.size() / count);
        guess = to.nearest((at[0] + at[1] + at[2]) / 3.0, guess, work).triangle;
    }
    return 1 + work / count;
}

glm::dvec3 normal_of(const Corners& corners) {
    return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

/// Visits the pieces of a parallel loop with fixed borders, so that sums do not depend on the
/// number of threads.
template <typename Value, typename Measure>
std::vector<Value> measured_in_pieces(std::size_t count, const Measure& measure,
                                      std::size_t piece = 4096) {
    std::vector<Value> values((count + piece - 1) / piece);
    parallel_for(values.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            values[i] = measure(i * piece, std::min(count, (i + 1) * piece));
    });
    return values;
}

/// A place on a surface.
struct Sample {
    double area;             ///< The area of the triangles before it, and of a part of its own.
    glm::dvec2 in_triangle;  ///< In the unit square, which is folded onto the triangle.
};

/// Places samples at equal steps of area, and within their triangles by a sequence with low
/// discrepancy.
struct EvenSamples {
    static constexpr std::size_t piece = 4096;
    std::size_t count;

    [[nodiscard]] EvenSamples starting_at(std::size_t /*begin*/) const { return *this; }
    [[nodiscard]] Sample at(std::size_t i, double area) const {
        constexpr double step_u = 0.7548776662466927;
        constexpr double step_v = 0.5698402909980532;
        const double u = static_cast<double>(i) * step_u;
        const double v = static_cast<double>(i) * step_v;
        return {(static_cast<double>(i) + 0.5) / static_cast<double>(count) * area,
                {u - std::floor(u), v - std::floor(v)}};
    }
};

/// Divides the area into equal parts, and places an independent random sample in each.
struct RandomSamples {
    static constexpr std::size_t piece = 512;
    std::size_t count;
    std::uint32_t seed;
    Random random{0};

    /// Returns the samples of a piece, whose numbers do not depend on those of other pieces.
    [[nodiscard]] RandomSamples starting_at(std::size_t begin) const {
        const auto mixed = seed * 0x9e3779b9U + static_cast<std::uint32_t>(begin);
        return {count, seed, Random(mixed)};
    }
    Sample at(std::size_t i, double area) {
        const double part = static_cast<double>(i) + random.between(0.0, 1.0);
        const double u = random.between(0.0, 1.0);
        return {part / static_cast<double>(count) * area, {u, random.between(0.0, 1.0)}};
    }
};

/// The sum of the areas up to each triangle.
std::vector<double> area_sums(const Surface& surface) {
    std::vector<double> sums;
    sums.reserve(surface.size());
    double area = 0.0;
    for (std::size_t t = 0; t < surface.size(); ++t) {
        area += glm::length(normal_of(surface.corners(t))) / 2.0;
        sums.push_back(area);
    }
    return sums;
}

/// Computes means over samples, the 95 % of them, and the maximum.
///
/// \param areas  area_sums() of `from`
template <typename Samples>
void measure_samples(const Surface& from, const Surface& to, std::span<const double> areas,
                     const Samples& all_samples, DistanceStats& stats) {
    const std::size_t count = all_samples.count;
    stats.area = areas.back();
    if (!(stats.area > 0.0) || count == 0) return;
    stats.samples = count;
    using Sums = DistanceStats;
    std::vector<double> squared(count);
    const std::vector<Sums> pieces = measured_in_pieces<Sums>(
        count,
        [&](std::size_t begin, std::size_t end) {
            Sums sums;
            Work work = 0;
            std::uint32_t guess = 0;
            Samples samples = all_samples.starting_at(begin);
            for (std::size_t i = begin; i < end; ++i) {
                check_cancelled();
                const Sample sample = samples.at(i, stats.area);
                const auto found = std::lower_bound(areas.begin(), areas.end(), sample.area);
                const auto t =
                    std::min(static_cast<std::size_t>(found - areas.begin()), from.size() - 1);
                double u = sample.in_triangle.x;
                double v = sample.in_triangle.y;
                if (u + v > 1.0) {
                    u = 1.0 - u;
                    v = 1.0 - v;
                }
                const Corners c = from.corners(t);
                const Nearest nearest =
                    to.nearest(c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]), guess, work);
                guess = nearest.triangle;
                squared[i] = nearest.squared;
                sums.mean += std::sqrt(nearest.squared);
                sums.rms += nearest.squared;
                sums.max = std::max(sums.max, nearest.squared);
                const glm::dvec3 a = normal_of(c);
                const glm::dvec3 b = normal_of(to.corners(nearest.triangle));
                const double degrees = angle_between(a, b) * 180.0 / std::numbers::pi;
                sums.mean_degrees += degrees;
                sums.max_degrees = std::max(sums.max_degrees, degrees);
            }
            return sums;
        },
        Samples::piece);
    for (const Sums& piece : pieces) {
        stats.mean += piece.mean;
        stats.rms += piece.rms;
        stats.max = std::max(stats.max, piece.max);
        stats.mean_degrees += piece.mean_degrees;
        stats.max_degrees = std::max(stats.max_degrees, piece.max_degrees);
    }
    stats.mean /= static_cast<double>(count);
    stats.rms = std::sqrt(stats.rms / static_cast<double>(count));
    const auto rank = squared.begin() + static_cast<std::ptrdiff_t>((95 * count + 99) / 100 - 1);
    std::nth_element(squared.begin(), rank, squared.end());
    stats.p95 = std::sqrt(*rank);
    stats.max = std::sqrt(stats.max);
    stats.mean_degrees /= static_cast<double>(count);
}

/// A point of a surface with the nearest triangle of the other one.
struct Probe {
    glm::dvec3 point;
    Nearest nearest;
};

/// Searches the interior of triangles for the largest distance.
struct InteriorSearch {
    const Surface& to;
    Work work = 0;
    Work most;
    double slack = 1.004;      ///< Of squares: what is not told apart, 0.2 %.
    double enough = 0.0;       ///< Searches end at a triangle within this squared distance.
    bool was_stopped = false;  ///< The work has exceeded `most`.

    double largest(const std::array<Probe, 3>& piece, double known, int depth);
};

/// Returns the largest squared distance at the corners of a piece of a triangle and of its parts.
/// The distance from one triangle is convex, so the largest one at the corners bounds it. The piece
/// is divided while that bound is above `known`.
double InteriorSearch::largest(const std::array<Probe, 3>& piece, double known, int depth) {
    double corner = 0.0;
    for (const Probe& probe : piece)
        corner = std::max(corner, probe.nearest.squared);
    const auto is_bounded_by = [&](std::uint32_t candidate) {
        const Corners triangle = to.corners(candidate);
        const double allowed = std::max(known, corner) * slack;
        return std::all_of(piece.begin(), piece.end(), [&](const Probe& probe) {
            return squared_distance(probe.point, triangle) <= allowed;
        });
    };
    for (const Probe& probe : piece) {
        if (is_bounded_by(probe.nearest.triangle)) return corner;
    }
    if (work > most) {
        was_stopped = true;
        return corner;
    }
    const glm::dvec3 center = (piece[0].point + piece[1].point + piece[2].point) / 3.0;
    const Nearest of_center = to.nearest(center, piece[0].nearest.triangle, work, enough);
    corner = std::max(corner, of_center.squared);
    if (depth == 0 || is_bounded_by(of_center.triangle)) return corner;
    std::array<Probe, 3> middle;
    for (std::size_t i = 0; i < 3; ++i) {
        middle[i].point = (piece[(i + 1) % 3].point + piece[(i + 2) % 3].point) / 2.0;
        middle[i].nearest = to.nearest(middle[i].point, of_center.triangle, work, enough);
        corner = std::max(corner, middle[i].nearest.squared);
    }
    known = std::max(known, corner);
    double most_found = std::max(corner, largest(middle, known, depth - 1));
    for (std::size_t i = 0; i < 3; ++i) {
        const std::array<Probe, 3> part = {piece[i], middle[(i + 2) % 3], middle[(i + 1) % 3]};
        most_found = std::max(most_found, largest(part, std::max(known, most_found), depth - 1));
    }
    return most_found;
}

/// The largest squared distance of some points, and the number of those that were left out.
struct Largest {
    double squared = 0.0;
    std::size_t omitted = 0;
};

/// Computes the distances of the used vertices.
///
/// \param step  only each vertex at a multiple of this index is examined
/// \param least  squared distances below it are not told apart
Largest largest_of_vertices(const Surface& from, const Surface& to, std::size_t step, double least,
                            std::vector<Nearest>& nearest) {
    const std::vector<glm::vec3>& positions = from.mesh().positions;
    std::vector<bool> is_used(positions.size(), false);
    for (std::size_t t = 0; t < from.size(); ++t) {
        for (int i = 0; i < 3; ++i)
            is_used[from.vertices(t)[i]] = true;
    }
    nearest.resize(positions.size());
    const auto pieces =
        measured_in_pieces<Largest>(positions.size(), [&](std::size_t begin, std::size_t end) {
            Largest largest;
            Work work = 0;
            std::uint32_t guess = 0;
            for (std::size_t v = begin; v < end; ++v) {
                check_cancelled();
                if (!is_used[v]) continue;
                if (v % step != 0) {
                    ++largest.omitted;
                    continue;
                }
                nearest[v] = to.nearest(glm::dvec3(positions[v]), guess, work, least);
                guess = nearest[v].triangle;
                largest.squared = std::max(largest.squared, nearest[v].squared);
            }
            return largest;
        });
    Largest all;
    for (const Largest& piece : pieces) {
        all.squared = std::max(all.squared, piece.squared);
        all.omitted += piece.omitted;
    }
    return all;
}

/// Computes the maximum distance of vertices and of points inside the triangles.
///
/// \param work  the mean work of a search
/// \param least  squared distances below it are not told apart
void measure_maximum(const Surface& from, const Surface& to, Work work, DistanceStats& stats,
                     double least = 0.0) {
    const std::size_t vertices = from.mesh().positions.size();
    const Work excess = work > little_work ? vertices * work / max_work : 0;
    const auto step = static_cast<std::size_t>(1 + excess);
    std::vector<Nearest> nearest;
    const Largest at_vertices = largest_of_vertices(from, to, step, least, nearest);
    const double of_all = std::max(at_vertices.squared, stats.max * stats.max);
    stats.max = std::sqrt(of_all);
    stats.omitted = at_vertices.omitted;
    if (step > 1) {
        stats.omitted += from.size();
        return;
    }
    // Distances below the rounding of positions are not told apart.
    const double known = std::max({of_all, to.rounding() * to.rounding(), least});
    constexpr std::size_t max_pieces = 500'000;
    int depth = 1;
    while (depth < 6 && (from.size() << (2 * depth + 2)) <= max_pieces)
        ++depth;
    // The work for one triangle, on average over a piece of the loop.
    const Work allowed = std::max<Work>(4 * max_work / from.size(), 2 * little_work);
    const auto of_triangles =
        measured_in_pieces<Largest>(from.size(), [&](std::size_t begin, std::size_t end) {
            Largest largest{of_all, 0};
            InteriorSearch search{to, 0, allowed * (end - begin)};
            // Searches that ended early have found any near triangle: with slack, the result would
            // depend on which.
            if (least > 0.0) search.slack = 1.0;
            search.enough = least;
            for (std::size_t t = begin; t < end; ++t) {
                check_cancelled();
                std::array<Probe, 3> piece;
                const Corners corners = from.corners(t);
                for (std::size_t i = 0; i < 3; ++i)
                    piece[i] = {corners[i], nearest[from.vertices(t)[static_cast<int>(i)]]};
                search.was_stopped = false;
                largest.squared = std::max(largest.squared, search.largest(piece, known, depth));
                if (search.was_stopped) ++largest.omitted;
            }
            return largest;
        });
    double squared = of_all;
    for (const Largest& piece : of_triangles) {
        squared = std::max(squared, piece.squared);
        stats.omitted += piece.omitted;
    }
    stats.max = std::sqrt(squared);
}

DistanceStats distances_on(const Surface& from, const Surface& to, Work work) {
    constexpr std::size_t min_samples = 1000;
    DistanceStats stats;
    const std::size_t most = std::max<std::size_t>(min_samples, max_work / work);
    const std::size_t count =
        std::min(most, std::clamp<std::size_t>(std::max(from.size(), to.size()), 20'000, 50'000));
    measure_samples(from, to, area_sums(from), EvenSamples{count}, stats);
    measure_maximum(from, to, work, stats);
    return stats;
}

/// Calls measure(to, work) with the surface, or with its triangles divided if searches take less
/// work then.
template <typename Measure>
DistanceStats measured_with_little_work(const Surface& from, const Surface& to,
                                        const Measure& measure) {
    constexpr std::size_t searches = 256;
    const Work work = mean_work(from, to, searches);
    if (work <= little_work) return measure(to, work);
    Surface divided = to;
    Work of_divided = work;
    for (const std::size_t more : {500'000, 2'000'000}) {
        divided.divide(more);
        of_divided = mean_work(from, divided, searches);
        if (of_divided <= little_work) break;
    }
    return of_divided < work ? measure(divided, of_divided) : measure(to, work);
}

DistanceStats distances(const Surface& from, const Surface& to) {
    return measured_with_little_work(from, to, [&](const Surface& surface, Work work) {
        return distances_on(from, surface, work);
    });
}

double largest_distance(const Surface& from, const Surface& to, double least) {
    const DistanceStats stats =
        measured_with_little_work(from, to, [&](const Surface& surface, Work work) {
            DistanceStats largest;
            measure_maximum(from, surface, work, largest, least * least);
            return largest;
        });
    return std::max(stats.max, least);
}

/// Measures at random samples, fewer if searches take long.
DistanceStats random_distances(const Surface& from, Surface& to, std::size_t samples,
                               std::uint32_t seed) {
    DistanceStats stats;
    if (samples > 0) {
        constexpr std::size_t searches = 16;
        Work work = mean_work(from, to, searches);
        if (work > little_work) {
            to.add_prisms();
            work = mean_work(from, to, searches);
        }
        // A few searches far from each other have worse guesses than those of many samples.
        constexpr Work enough = 2 * little_work;
        if (work > enough) samples = std::max<std::size_t>(samples * enough / work, 1);
    }
    measure_samples(from, to, area_sums(from), RandomSamples{samples, seed}, stats);
    return stats;
}

}  // namespace

SurfaceDistance surface_distance(const Mesh& a, const Mesh& b) {
    validate(a);
    validate(b);
    Surface surface_a(a);
    Surface surface_b(b);
    if (surface_a.size() == 0 || surface_b.size() == 0) return {};
    surface_a.add_prisms();
    surface_b.add_prisms();
    return {distances(surface_a, surface_b), distances(surface_b, surface_a)};
}

SurfaceDistance sampled_distance(const Mesh& a, const Mesh& b, std::size_t samples_a,
                                 std::size_t samples_b, std::uint32_t seed) {
    validate(a);
    validate(b);
    Surface surface_a(a);
    Surface surface_b(b);
    if (surface_a.size() == 0 || surface_b.size() == 0) return {};
    return {random_distances(surface_a, surface_b, samples_a, seed),
            random_distances(surface_b, surface_a, samples_b, seed)};
}

double largest_distance(const Mesh& a, const Mesh& b, double least) {
    validate(a);
    validate(b);
    if (!(least >= 0.0))
        throw InvalidInput(fmt::format("the least distance is {}, but must be at least 0", least));
    Surface surface_a(a);
    Surface surface_b(b);
    if (surface_a.size() == 0 || surface_b.size() == 0) return least;
    surface_a.add_prisms();
    surface_b.add_prisms();
    // What one direction has found need not be found again.
    return largest_distance(surface_b, surface_a, largest_distance(surface_a, surface_b, least));
}

double max_farther_part(std::size_t samples, double confidence) {
    if (!(confidence > 0.0 && confidence < 1.0))
        throw InvalidInput(
            fmt::format("the confidence is {}, but must be between 0 and 1", confidence));
    // The probability that no sample is in a part p of the area is at most (1 - p)^samples.
    return samples == 0 ? 1.0
                        : 1.0 - portable::pow(1.0 - confidence, 1.0 / static_cast<double>(samples));
}

}  // namespace relief
