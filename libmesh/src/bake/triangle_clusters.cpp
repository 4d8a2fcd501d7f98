// SPDX-License-Identifier: Apache-2.0
// Clustering of triangles along a space-filling curve [Morton 1966], and ray tests of whole
// clusters. Tests: tests/mesh/rays/embree_scene_test.cpp.
#include "bake/triangle_clusters.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "parallel.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

constexpr std::size_t size = TriangleCluster<float>::size;

/// The position of the center of a triangle's box on the curve.
struct CurvePlace {
    std::uint64_t key = 0;
    std::uint32_t triangle = 0;
};

constexpr std::uint64_t not_met = std::numeric_limits<std::uint64_t>::max();
constexpr int key_bits = 48;

/// Moves the 16 bits of a number to every third bit.
std::uint64_t spread(std::uint64_t bits) {
    bits = (bits | (bits << 16)) & 0x0000ff0000ffULL;
    bits = (bits | (bits << 8)) & 0x00f00f00f00fULL;
    bits = (bits | (bits << 4)) & 0x0c30c30c30c3ULL;
    return (bits | (bits << 2)) & 0x249249249249ULL;
}

/// A range is split into several clusters only if that reduces the expected number of ray tests by
/// this factor, because each cluster takes memory and enlarges the tree.
constexpr double split_gain = 1.3;

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void add(const Box& box) {
        low = glm::min(low, box.low);
        high = glm::max(high, box.high);
    }
    /// Returns half of the surface of the enlarged box.
    [[nodiscard]] double area() const {
        const glm::dvec3 side = high - low + 2.0 * embree_margin;
        return side.x * side.y + side.y * side.z + side.z * side.x;
    }
};

/// Sorts by key, stably.
void sort(std::vector<CurvePlace>& places) {
    constexpr int digit_bits = 12;
    constexpr std::size_t digits = std::size_t{1} << digit_bits;
    constexpr std::size_t piece_size = 65536;
    const std::size_t count = places.size();
    const std::size_t pieces = (count + piece_size - 1) / piece_size;
    std::vector<CurvePlace> sorted(count);
    std::vector<std::uint32_t> starts(pieces * digits);
    for (int shift = 0; shift < key_bits; shift += digit_bits) {
        const auto digit = [&](const CurvePlace& place) {
            return static_cast<std::size_t>(place.key >> shift) % digits;
        };
        const auto for_pieces = [&](const auto& body) {
            parallel_for(pieces, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t piece = begin; piece < end; ++piece) {
                    std::uint32_t* const of_piece = starts.data() + piece * digits;
                    const std::size_t last = std::min((piece + 1) * piece_size, count);
                    body(of_piece, piece * piece_size, last);
                }
            });
        };
        for_pieces([&](std::uint32_t* counts, std::size_t first, std::size_t last) {
            std::fill_n(counts, digits, 0U);
            for (std::size_t i = first; i < last; ++i)
                ++counts[digit(places[i])];
        });
        std::uint32_t start = 0;
        for (std::size_t i = 0; i < digits; ++i) {
            for (std::size_t piece = 0; piece < pieces; ++piece) {
                const std::uint32_t here = starts[piece * digits + i];
                starts[piece * digits + i] = start;
                start += here;
            }
        }
        for_pieces([&](std::uint32_t* next, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                sorted[next[digit(places[i])]++] = places[i];
        });
        places.swap(sorted);
    }
}

/// A range of the sorted triangles.
struct Range {
    std::uint32_t first = 0;
    std::uint32_t last = 0;

    [[nodiscard]] std::uint32_t count() const { return last - first; }
};

template <typename Number>
class Clustering {
  public:
    using Position = glm::vec<3, Number>;

    Clustering(std::span<const Position> positions, std::span<const glm::uvec3> triangles,
               const EmbreeSpace& space)
        : positions_(positions), triangles_(triangles), space_(space) {}

    TriangleClusters<Number> run() {
        find_places();
        sort(places_);
        std::vector<Range> large;
        split({0, static_cast<std::uint32_t>(places_.size())}, 4096, large);
        std::vector<std::vector<Range>> parts(large.size());
        parallel_for(large.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                cluster(large[i], parts[i]);
        });
        std::vector<std::size_t> starts;
        std::size_t count = 0;
        for (const auto& part : parts) {
            starts.push_back(count);
            count += part.size();
        }
        TriangleClusters<Number> result;
        result.clusters.resize(count);
        result.boxes.resize(count);
        parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                for (std::size_t k = 0; k < parts[i].size(); ++k)
                    fill(parts[i][k], result.clusters[starts[i] + k], result.boxes[starts[i] + k]);
            }
        });
        return result;
    }

  private:
    void find_places() {
        places_.resize(triangles_.size());
        parallel_for(places_.size(), 16384, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                places_[i] = {key_of(triangles_[i]), static_cast<std::uint32_t>(i)};
        });
        std::erase_if(places_, [](const CurvePlace& place) { return place.key == not_met; });
    }

    [[nodiscard]] std::uint64_t key_of(const glm::uvec3& triangle) const {
        const glm::dvec3 a(positions_[triangle.x]);
        const glm::dvec3 b(positions_[triangle.y]);
        const glm::dvec3 c(positions_[triangle.z]);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double area = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
        if (!(area > 0.0 && area < std::numeric_limits<double>::infinity())) return not_met;
        const glm::dvec3 center = 0.5 * (glm::min(a, glm::min(b, c)) + glm::max(a, glm::max(b, c)));
        const glm::dvec3 cell = glm::clamp(
            (center - space_.center) * (32768.0 / space_.half_size) + 32768.0, 0.0, 65535.0);
        return spread(static_cast<std::uint64_t>(cell.x)) * 4 +
               spread(static_cast<std::uint64_t>(cell.y)) * 2 +
               spread(static_cast<std::uint64_t>(cell.z));
    }

    /// Returns the first position after the highest differing bit of the keys changes, or the
    /// middle.
    [[nodiscard]] std::uint32_t middle_of(const Range& range) const {
        const std::uint64_t first = places_[range.first].key;
        const std::uint64_t last = places_[range.last - 1].key;
        if (first == last) return range.first + range.count() / 2;
        const int bit = 63 - std::countl_zero(first ^ last);
        const std::uint64_t second_half = (last >> bit) << bit;
        const auto begin = places_.begin();
        const auto found = std::lower_bound(
            begin + range.first, begin + range.last, second_half,
            [](const CurvePlace& place, std::uint64_t key) { return place.key < key; });
        return static_cast<std::uint32_t>(found - begin);
    }

    void split(const Range& range, std::uint32_t most, std::vector<Range>& ranges) const {
        if (range.count() <= most) {
            if (range.count() > 0) ranges.push_back(range);
            return;
        }
        const std::uint32_t middle = middle_of(range);
        split({range.first, middle}, most, ranges);
        split({middle, range.last}, most, ranges);
    }

    void cluster(const Range& range, std::vector<Range>& clusters) const {
        if (range.count() <= size) {
            Box box;
            join(range, clusters, box);
            return;
        }
        const std::uint32_t middle = middle_of(range);
        cluster({range.first, middle}, clusters);
        cluster({middle, range.last}, clusters);
    }

    /// Makes one cluster of a range, or several if that is cheaper.
    /// \param box  gets the box around all
    /// \return the expected number of ray tests
    double join(const Range& range, std::vector<Range>& clusters, Box& box) const {
        if (range.count() == 1) {
            const glm::uvec3& triangle = triangles_[places_[range.first].triangle];
            for (int i = 0; i < 3; ++i)
                box.add(in_space(glm::dvec3(positions_[triangle[i]])));
            clusters.push_back(range);
            return box.area();
        }
        const std::size_t before = clusters.size();
        const std::uint32_t middle = middle_of(range);
        Box second;
        double apart = join({range.first, middle}, clusters, box);
        apart += join({middle, range.last}, clusters, second);
        box.add(second);
        const double together = box.area();
        if (together > split_gain * apart) return apart;
        clusters.resize(before);
        clusters.push_back(range);
        return together;
    }

    [[nodiscard]] glm::dvec3 in_space(const glm::dvec3& position) const {
        return (position - space_.center) * (1.0 / space_.half_size);
    }

    void fill(const Range& range, TriangleCluster<Number>& cluster, EmbreeBox& box) const {
        cluster.triangles.fill(TriangleCluster<Number>::none);
        for (auto& corner : cluster.corners) {
            for (auto& axis : corner)
                axis.fill(std::numeric_limits<Number>::quiet_NaN());
        }
        Box around;
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            const std::size_t place = i - range.first;
            const std::uint32_t triangle = places_[i].triangle;
            cluster.triangles[place] = triangle;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const Position& position =
                    positions_[triangles_[triangle][static_cast<int>(corner)]];
                for (std::size_t axis = 0; axis < 3; ++axis)
                    cluster.corners[corner][axis][place] = position[static_cast<int>(axis)];
                around.add(glm::dvec3(position));
            }
        }
        // Embree ignores boxes that are too large; rays do not reach that far.
        constexpr double beyond = 1e9;
        box.lower = glm::vec3(glm::clamp(in_space(around.low) - embree_margin, -beyond, beyond));
        box.upper = glm::vec3(glm::clamp(in_space(around.high) + embree_margin, -beyond, beyond));
    }

    std::span<const Position> positions_;
    std::span<const glm::uvec3> triangles_;
    EmbreeSpace space_;
    std::vector<CurvePlace> places_;
};

struct Line {
    std::size_t x, y, z;
    double origin_x, origin_y, origin_z, slope_x, slope_y;
};

RELIEF_INLINE Line line_of(const RayLines<16>& lines, std::size_t i) {
    const std::size_t z = lines.along[i];
    return {z == 2 ? 0 : z + 1, z == 0 ? 2U : z - 1, z,
            lines.origin_x[i],  lines.origin_y[i],   lines.origin_z[i],
            lines.slope_x[i],   lines.slope_y[i]};
}

/// Returns whether a line may hit a triangle, 1 or 0. The coordinates equal those of intersect()
/// bit for bit. Each area has the correct sign or is 0; see exact_cross().
template <typename Axis>
RELIEF_INLINE std::uint64_t may_meet(const std::array<Axis, 3>& x, const std::array<Axis, 3>& y,
                                     const std::array<Axis, 3>& z, double origin_x, double origin_y,
                                     double origin_z, double slope_x, double slope_y) {
    const double az = static_cast<double>(z[0]) - origin_z;
    const double bz = static_cast<double>(z[1]) - origin_z;
    const double cz = static_cast<double>(z[2]) - origin_z;
    const double ax = (static_cast<double>(x[0]) - origin_x) + az * slope_x;
    const double bx = (static_cast<double>(x[1]) - origin_x) + bz * slope_x;
    const double cx = (static_cast<double>(x[2]) - origin_x) + cz * slope_x;
    const double ay = (static_cast<double>(y[0]) - origin_y) + az * slope_y;
    const double by = (static_cast<double>(y[1]) - origin_y) + bz * slope_y;
    const double cy = (static_cast<double>(y[2]) - origin_y) + cz * slope_y;
    const double first = bx * cy - by * cx;
    const double second = cx * ay - cy * ax;
    const double third = ax * by - ay * bx;
    const double least = std::min(first, std::min(second, third));
    const double greatest = std::max(first, std::max(second, third));
    return (least >= 0.0 ? 1U : 0U) | (greatest <= 0.0 ? 1U : 0U);
}

template <typename Number>
RELIEF_INLINE std::uint32_t of_one_line(const TriangleCluster<Number>& cluster,
                                        const RayLines<16>& lines, std::size_t index) {
    const Line line = line_of(lines, index);
    const auto& a = cluster.corners[0];
    const auto& b = cluster.corners[1];
    const auto& c = cluster.corners[2];
    std::array<std::uint64_t, size> meets;
    std::uint64_t any = 0;
    for (std::size_t i = 0; i < size; ++i) {
        meets[i] = may_meet<Number>({a[line.x][i], b[line.x][i], c[line.x][i]},
                                    {a[line.y][i], b[line.y][i], c[line.y][i]},
                                    {a[line.z][i], b[line.z][i], c[line.z][i]}, line.origin_x,
                                    line.origin_y, line.origin_z, line.slope_x, line.slope_y);
        any |= meets[i];
    }
    if (any == 0) return 0;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < size; ++i)
        bits |= static_cast<std::uint32_t>(meets[i]) << i;
    return bits;
}

template <std::size_t count, typename Number>
RELIEF_INLINE void of_lines(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                            std::size_t begin, std::uint64_t* bits) {
    const Line axes = line_of(lines, begin);
    std::fill_n(bits, count, 0U);
    for (std::size_t place = 0; place < size && cluster.triangles[place] != cluster.none; ++place) {
        const auto corners = [&](std::size_t axis) {
            return std::array<double, 3>{static_cast<double>(cluster.corners[0][axis][place]),
                                         static_cast<double>(cluster.corners[1][axis][place]),
                                         static_cast<double>(cluster.corners[2][axis][place])};
        };
        const std::array<double, 3> x = corners(axes.x);
        const std::array<double, 3> y = corners(axes.y);
        const std::array<double, 3> z = corners(axes.z);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t k = begin + i;
            bits[i] |= may_meet<double>(x, y, z, lines.origin_x[k], lines.origin_y[k],
                                        lines.origin_z[k], lines.slope_x[k], lines.slope_y[k])
                       << place;
        }
    }
}

template <typename Number>
RELIEF_INLINE void of_lines(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                            std::size_t begin, std::size_t count, std::uint64_t* bits) {
    if (count == 16)
        of_lines<16>(cluster, lines, begin, bits);
    else if (count == 8)
        of_lines<8>(cluster, lines, begin, bits);
    else
        of_lines<4>(cluster, lines, begin, bits);
}

/// The loops for one set of vector instructions.
template <typename Number>
struct Loops {
    std::uint32_t (*of_one_line)(const TriangleCluster<Number>&, const RayLines<16>&, std::size_t);
    void (*of_lines)(const TriangleCluster<Number>&, const RayLines<16>&, std::size_t, std::size_t,
                     std::uint64_t*);
};

template <typename Number>
std::uint32_t of_one_line_128(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                              std::size_t line) {
    return of_one_line(cluster, lines, line);
}
template <typename Number>
RELIEF_TARGET_256 std::uint32_t of_one_line_256(const TriangleCluster<Number>& cluster,
                                                const RayLines<16>& lines, std::size_t line) {
    return of_one_line(cluster, lines, line);
}
template <typename Number>
RELIEF_TARGET_512 std::uint32_t of_one_line_512(const TriangleCluster<Number>& cluster,
                                                const RayLines<16>& lines, std::size_t line) {
    return of_one_line(cluster, lines, line);
}
template <typename Number>
void of_lines_128(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                  std::size_t begin, std::size_t count, std::uint64_t* bits) {
    of_lines(cluster, lines, begin, count, bits);
}
template <typename Number>
RELIEF_TARGET_256 void of_lines_256(const TriangleCluster<Number>& cluster,
                                    const RayLines<16>& lines, std::size_t begin, std::size_t count,
                                    std::uint64_t* bits) {
    of_lines(cluster, lines, begin, count, bits);
}
template <typename Number>
RELIEF_TARGET_512 void of_lines_512(const TriangleCluster<Number>& cluster,
                                    const RayLines<16>& lines, std::size_t begin, std::size_t count,
                                    std::uint64_t* bits) {
    of_lines(cluster, lines, begin, count, bits);
}

/// All three give the same results, because none fuses or reorders operations.
template <typename Number>
const Loops<Number> best_loops = [] {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            return Loops<Number>{of_one_line_512<Number>, of_lines_512<Number>};
        case VectorTarget::wide:
            return Loops<Number>{of_one_line_256<Number>, of_lines_256<Number>};
        case VectorTarget::any:
            break;
    }
    return Loops<Number>{of_one_line_128<Number>, of_lines_128<Number>};
}();

}  // namespace

template <typename Number>
TriangleClusters<Number> make_clusters(std::span<const glm::vec<3, Number>> positions,
                                       std::span<const glm::uvec3> triangles,
                                       const EmbreeSpace& space) {
    return Clustering<Number>(positions, triangles, space).run();
}

template <typename Number>
std::uint32_t candidates(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                         std::size_t line) {
    return best_loops<Number>.of_one_line(cluster, lines, line);
}

template <typename Number>
void candidates(const TriangleCluster<Number>& cluster, const RayLines<16>& lines,
                std::size_t begin, std::size_t count, std::span<std::uint64_t, 16> bits) {
    best_loops<Number>.of_lines(cluster, lines, begin, count, bits.data());
}

template TriangleClusters<float> make_clusters(std::span<const glm::vec3>,
                                               std::span<const glm::uvec3>, const EmbreeSpace&);
template TriangleClusters<double> make_clusters(std::span<const glm::dvec3>,
                                                std::span<const glm::uvec3>, const EmbreeSpace&);
template std::uint32_t candidates(const TriangleCluster<float>&, const RayLines<16>&, std::size_t);
template std::uint32_t candidates(const TriangleCluster<double>&, const RayLines<16>&, std::size_t);
template void candidates(const TriangleCluster<float>&, const RayLines<16>&, std::size_t,
                         std::size_t, std::span<std::uint64_t, 16>);
template void candidates(const TriangleCluster<double>&, const RayLines<16>&, std::size_t,
                         std::size_t, std::span<std::uint64_t, 16>);

}  // namespace relief::detail
