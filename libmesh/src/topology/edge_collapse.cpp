// SPDX-License-Identifier: Apache-2.0
// Edge collapses on corner tables. A vertex never moves to a new place, so the error that has
// accumulated at a vertex is one number, and the cost of moving v onto u is the quadric of v at u
// plus that number of u.
#include "topology/edge_collapse.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "parallel.h"
#include "portable_math.h"

namespace relief {
namespace {

constexpr std::uint32_t none = no_corner;
constexpr float no_collapse = std::numeric_limits<float>::infinity();

/// The maximum rotation of a triangle in one move: about 78 degrees. Several moves may add up; see
/// Collapser::is_near_normals().
constexpr double min_turn_cosine = 0.2;

/// The same for the adjustment of positions at the end: 45 degrees.
constexpr double min_fit_cosine = 0.7071067811865476;

/// A vertex is sharp if the normal of one of its triangles differs by more than this angle, 60
/// degrees, from their mean.
constexpr double min_smooth_cosine = 0.5;

/// The weight of the squared length, which prefers short edges if costs are otherwise equal.
constexpr double length_preference = 1e-7;

/// The part of the possible collapses that a pass executes. Smaller fractions follow the order of
/// cost more exactly and take more passes.
constexpr double pass_fraction = 0.25;

/// The number of vertices in a group, neighbors along the curve, that one thread executes.
constexpr std::size_t group_size = 16384;

/// A candidate whose cost has grown by at most this factor since its pass began is executed.
constexpr float tolerance = 1.5F;

/// The squared distance, in the unit of the points, that counts as 0.
constexpr double rounding = 1e-15;

/// The quadric p * A * p + 2 b * p + c.
struct Quadric {
    double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
    glm::dvec3 linear{0.0};
    double constant = 0.0;

    /// Adds weight * (slope * p + offset)^2.
    void add(double weight, const glm::dvec3& slope, double offset) {
        const glm::dvec3 weighted = weight * slope;
        xx += weighted.x * slope.x;
        xy += weighted.x * slope.y;
        xz += weighted.x * slope.z;
        yy += weighted.y * slope.y;
        yz += weighted.y * slope.z;
        zz += weighted.z * slope.z;
        linear += weighted * offset;
        constant += weight * offset * offset;
    }

    Quadric& operator+=(const Quadric& other) {
        xx += other.xx;
        xy += other.xy;
        xz += other.xz;
        yy += other.yy;
        yz += other.yz;
        zz += other.zz;
        linear += other.linear;
        constant += other.constant;
        return *this;
    }

    [[nodiscard]] double operator()(const glm::dvec3& p) const {
        const double x = xx * p.x + 2.0 * (xy * p.y + xz * p.z + linear.x);
        const double y = yy * p.y + 2.0 * (yz * p.z + linear.y);
        const double z = zz * p.z + 2.0 * linear.z;
        return x * p.x + y * p.y + z * p.z + constant;
    }
};

/// The triangles around a vertex, counter-clockwise. Spoke i is the edge at which triangle i
/// begins; at a boundary there is one spoke more than triangles.
struct Ring {
    std::size_t size = 0;                     ///< Number of triangles.
    std::size_t spokes = 0;                   ///< Number of edges.
    std::size_t lines = 0;                    ///< Number of spokes that are lines.
    bool has_border = false;                  ///< Whether the vertex is at a boundary.
    std::array<Corner, max_valence> corners;  ///< The corner of each triangle at the vertex.
    std::array<std::uint32_t, max_valence + 1> neighbors;  ///< The vertex of each spoke.
    std::array<bool, max_valence + 1> is_line;

    /// The triangle to the left of a spoke, as an index into `corners`; none at a boundary.
    [[nodiscard]] std::size_t left(std::size_t spoke) const {
        return spoke < size ? spoke : max_valence;
    }
    /// The triangle to the right of a spoke; none at a boundary.
    [[nodiscard]] std::size_t right(std::size_t spoke) const {
        if (spoke > 0) return spoke - 1;
        return has_border ? max_valence : size - 1;
    }
};

constexpr std::size_t no_side = max_valence;

/// A move of a vertex along a spoke of its ring. Where the spoke is a line, the triangles on its
/// two sides have different wedges.
struct Move {
    std::size_t spoke = 0;
    std::uint32_t target = none;
    std::array<std::uint32_t, 2> before = {none, none};  ///< Wedges on the left and on the right.
    std::array<std::uint32_t, 2> after = {none, none};
};

constexpr std::uint8_t is_dirty = 1;    ///< The cost must be computed.
constexpr std::uint8_t is_careful = 2;  ///< The cheapest collapse was refused once, so all checks
                                        ///< are made when the cost is computed.
constexpr std::uint8_t is_locked = 4;
constexpr std::uint8_t is_sharp = 8;  ///< See min_smooth_cosine.

struct CornerData {
    std::uint32_t vertex;  ///< `none` in removed triangles.
    std::uint32_t wedge;
    Corner opposite;  ///< As in Topology.
};

/// Returns freed memory to the system. The C library keeps blocks of up to 32 MB, which would add a
/// quarter to the peak.
void return_free_memory() {
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

class Collapser {
  public:
    explicit Collapser(CollapseInput input);
    Collapsed run();

  private:
    [[nodiscard]] glm::dvec3 point(std::uint32_t vertex) const {
        return (glm::dvec3(input_.positions[vertex]) - input_.center) * input_.scale;
    }
    [[nodiscard]] std::span<const float> attributes(std::uint32_t wedge) const {
        return std::span(input_.attributes).subspan(wedge * attribute_count_, attribute_count_);
    }
    [[nodiscard]] glm::dvec2 texcoord(std::uint32_t wedge) const {
        const std::span<const float> values = attributes(wedge);
        return {values[0], values[1]};
    }
    [[nodiscard]] std::span<double> attribute_sums(std::uint32_t wedge) {
        return std::span(attribute_sums_).subspan(wedge * sums_per_wedge_, sums_per_wedge_);
    }

    void add_triangle(std::size_t triangle);
    void add_lines(std::size_t triangle);
    void add_attributes(std::size_t triangle, const glm::dvec3& normal, double doubled_area);
    void prepare_normals();
    void list_normals();

    [[nodiscard]] bool gather(Corner start, Ring& ring) const;
    [[nodiscard]] bool find_ring(std::uint32_t vertex, Ring& ring) const;
    [[nodiscard]] bool may_move(std::uint32_t vertex, const Ring& ring) const;
    [[nodiscard]] bool find_move(const Ring& ring, std::size_t spoke, Move& move) const;
    [[nodiscard]] double own_cost(std::uint32_t vertex, const Move& move) const;
    [[nodiscard]] double cost(std::uint32_t vertex, const Move& move) const;
    [[nodiscard]] bool is_valid(std::uint32_t vertex, const Ring& ring, const Move& move) const;
    [[nodiscard]] bool joins_lines(const Ring& ring, const Move& move) const;
    [[nodiscard]] bool keeps_topology(const Ring& ring, const Move& move) const;
    [[nodiscard]] bool is_adjacent(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] bool turns_over(std::uint32_t vertex, Corner corner, const Move& move) const;
    [[nodiscard]] bool turns_texture_over(Corner corner, std::uint32_t wedge_after) const;
    [[nodiscard]] bool has_normal_near(std::uint32_t vertex, const glm::dvec3& cross) const;
    [[nodiscard]] bool is_near_normals(const glm::dvec3& cross, std::uint32_t a, std::uint32_t b,
                                       std::uint32_t c) const;
    [[nodiscard]] bool leaves_normals(Corner corner, const Move& move) const;
    [[nodiscard]] glm::dvec3 input_normal(std::size_t triangle) const;
    [[nodiscard]] bool is_line_at(Corner corner, std::uint32_t wedge) const;
    [[nodiscard]] std::uint32_t wedge_after(const Ring& ring, const Move& move,
                                            std::size_t index) const;
    /// Costs of vertices whose neighborhood changed are not computed again until they are
    /// candidates: mostly they have become larger.
    [[nodiscard]] bool needs_cost(std::uint32_t vertex) const {
        return (flags_[vertex] & is_dirty) != 0 && costs_[vertex] == no_collapse;
    }
    template <typename Visit>
    void for_moved(const Ring& ring, const Move& move, const Visit& visit) const;

    float best_move(std::uint32_t vertex, const Ring& ring, Move& best) const;
    float evaluate(std::uint32_t vertex, std::size_t& examined) const;
    std::size_t collapse(std::uint32_t vertex, const Ring& ring, const Move& move);
    void remove(Corner first, Corner second);
    std::size_t collapse_if_cheap(std::uint32_t vertex, const Ring& ring, float limit);
    std::size_t execute(std::span<const std::uint64_t> order, float limit, std::size_t most);
    void assign_groups();
    std::size_t execute_groups(std::span<const std::uint64_t> order, float limit);
    void run_pass(double fraction);

    [[nodiscard]] glm::dvec3 fitted_offset(std::uint32_t vertex, const Ring& ring) const;
    [[nodiscard]] bool may_be_at(std::uint32_t vertex, const Ring& ring, const glm::vec3& position);
    void fit_positions();

    CollapseInput input_;
    std::size_t attribute_count_ = 0;
    std::vector<CornerData> corners_;
    // By vertex:
    std::vector<Corner> corner_of_;  ///< A corner at the vertex; none if it was removed.
    std::vector<Quadric> quadrics_;
    std::vector<double> errors_;  ///< The quadric at the vertex itself.
    std::vector<double> areas_;   ///< Only with a maximum error.
    std::vector<float> costs_;    ///< The cost of the cheapest collapse.
    std::vector<std::uint8_t> flags_;
    std::vector<glm::vec3> mean_normals_;  ///< The sum of the unit normals of the input, or 0.
    // For sharp vertices; with a maximum angle of normals, for all; otherwise empty:
    std::vector<std::uint32_t> normal_begin_;  ///< By vertex: its first entry in normals_at_.
    std::vector<glm::vec3> normals_at_;        ///< The normals of the input at each vertex.
    /// By wedge: the sums of weight, and of gradient and offset of each attribute.
    std::vector<double> attribute_sums_;
    std::size_t sums_per_wedge_ = 0;

    std::vector<std::uint32_t> alive_;  ///< The vertices that may move, ascending.
    // Only if there are at least two groups:
    std::vector<std::uint32_t> groups_;    ///< By vertex; none for locked ones.
    std::vector<std::uint8_t> at_border_;  ///< By vertex: a neighbor may be in another group.
    std::size_t grouped_ = 0;              ///< The number of vertices that may move at the time.
    std::size_t triangles_ = 0;
    std::size_t target_ = 0;
    Collapsed result_;
    std::atomic<std::size_t> examined_ = 0;
};

Collapser::Collapser(CollapseInput input)
    : input_(std::move(input)), attribute_count_(input_.attribute_weights.size()) {
    Topology& topology = input_.topology;
    const std::size_t triangles = topology.triangles.size();
    const std::size_t vertices = input_.positions.size();
    corners_.resize(3 * triangles);
    corner_of_.assign(vertices, none);
    for (std::size_t t = 0; t < triangles; ++t) {
        for (int i = 0; i < 3; ++i) {
            const auto corner = static_cast<Corner>(3 * t + static_cast<std::size_t>(i));
            const std::uint32_t vertex = topology.triangles[t][i];
            corners_[corner] = {vertex, input_.wedges[t][i], topology.opposite[corner]};
            corner_of_[vertex] = corner;
        }
    }
    free_memory(topology.triangles);
    free_memory(topology.opposite);
    free_memory(input_.wedges);
    return_free_memory();
    triangles_ = triangles;
    target_ = input_.triangles.value_or(0);
    if (triangles_ <= target_) return;
    quadrics_.resize(vertices);
    errors_.assign(vertices, 0.0);
    mean_normals_.assign(vertices, glm::vec3(0.0F));
    if (input_.max_error) areas_.assign(vertices, 0.0);
    if (attribute_count_ > 0) {
        sums_per_wedge_ = 1 + 4 * attribute_count_;
        attribute_sums_.assign(input_.wedge_count * sums_per_wedge_, 0.0);
    }
    for (std::size_t t = 0; t < triangles; ++t)
        add_triangle(t);
    for (std::size_t t = 0; t < triangles; ++t)
        add_lines(t);
    flags_.assign(vertices, 0);
    prepare_normals();
    costs_.assign(vertices, no_collapse);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (topology.is_cut[v]) {
            flags_[v] |= is_locked;
        } else {
            flags_[v] |= is_dirty;
            alive_.push_back(v);
        }
    }
}

void Collapser::add_triangle(std::size_t triangle) {
    const auto first = static_cast<Corner>(3 * triangle);
    const glm::dvec3 a = point(corners_[first].vertex);
    const glm::dvec3 cross =
        glm::cross(point(corners_[first + 1].vertex) - a, point(corners_[first + 2].vertex) - a);
    const double doubled_area = glm::length(cross);
    if (!(doubled_area > 0.0)) return;
    const glm::dvec3 normal = cross / doubled_area;
    const double area = doubled_area / 2.0;
    Quadric quadric;
    quadric.add(area, normal, -glm::dot(normal, a));
    for (Corner corner = first; corner < first + 3; ++corner) {
        quadrics_[corners_[corner].vertex] += quadric;
        mean_normals_[corners_[corner].vertex] += glm::vec3(normal);
        if (!areas_.empty()) areas_[corners_[corner].vertex] += area;
    }
    if (sums_per_wedge_ > 0) add_attributes(triangle, normal, doubled_area);
}

/// The gradient in the plane of the triangle results from the dual basis of its edges.
void Collapser::add_attributes(std::size_t triangle, const glm::dvec3& normal,
                               double doubled_area) {
    const auto first = static_cast<Corner>(3 * triangle);
    const glm::dvec3 a = point(corners_[first].vertex);
    const glm::dvec3 dual_b =
        glm::cross(point(corners_[first + 2].vertex) - a, normal) / doubled_area;
    const glm::dvec3 dual_c =
        glm::cross(normal, point(corners_[first + 1].vertex) - a) / doubled_area;
    const double area = doubled_area / 2.0;
    const std::span<const float> at_a = attributes(corners_[first].wedge);
    const std::span<const float> at_b = attributes(corners_[first + 1].wedge);
    const std::span<const float> at_c = attributes(corners_[first + 2].wedge);
    Quadric quadric;
    std::array<double, 1 + 4 * max_attributes> sums{};
    sums[0] = area;
    for (std::size_t k = 0; k < attribute_count_; ++k) {
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
        quadrics_[corners_[corner].vertex] += quadric;
        const std::span<double> sum = attribute_sums(corners_[corner].wedge);
        for (std::size_t k = 0; k < sum.size(); ++k)
            sum[k] += sums[k];
    }
}

/// Adds planes through lines, perpendicular to the triangle, which keep the lines in place.
void Collapser::add_lines(std::size_t triangle) {
    const auto first = static_cast<Corner>(3 * triangle);
    for (Corner corner = first; corner < first + 3; ++corner) {
        const Corner next = next_in_triangle(corner);
        if (!is_line_at(corner, corners_[corner].wedge) &&
            !is_line_at(corner, corners_[next].wedge))
            continue;
        const std::uint32_t from = corners_[corner].vertex;
        const std::uint32_t to = corners_[next].vertex;
        const glm::dvec3 along = point(to) - point(from);
        const glm::dvec3 upright = glm::cross(
            along, glm::cross(along, point(corners_[next_in_triangle(next)].vertex) - point(from)));
        const double length = glm::length(upright);
        if (!(length > 0.0)) continue;
        const glm::dvec3 normal = upright / length;
        Quadric quadric;
        quadric.add(glm::dot(along, along), normal, -glm::dot(normal, point(from)));
        quadrics_[from] += quadric;
        quadrics_[to] += quadric;
    }
}

/// Returns the unit normal of a triangle before any collapse; 0 without area.
glm::dvec3 Collapser::input_normal(std::size_t triangle) const {
    const std::size_t first = 3 * triangle;
    const glm::dvec3 a = point(corners_[first].vertex);
    const glm::dvec3 cross =
        glm::cross(point(corners_[first + 1].vertex) - a, point(corners_[first + 2].vertex) - a);
    const double length = glm::length(cross);
    return length > 0.0 ? cross / length : glm::dvec3(0.0);
}

/// Marks sharp vertices.
void Collapser::prepare_normals() {
    std::atomic<bool> has_sharp = false;
    parallel_for(corners_.size() / 3, group_size, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::dvec3 normal = input_normal(t);
            if (normal == glm::dvec3(0.0)) continue;
            for (std::size_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
                const std::uint32_t vertex = corners_[corner].vertex;
                const glm::dvec3 mean(mean_normals_[vertex]);
                if (glm::dot(normal, mean) > min_smooth_cosine * glm::length(mean)) continue;
                // Other threads may write the same value.
                std::atomic_ref(flags_[vertex]).store(is_sharp, std::memory_order_relaxed);
                has_sharp = true;
            }
        }
    });
    if (has_sharp || input_.min_normal_cosine) list_normals();
}

void Collapser::list_normals() {
    const auto is_listed = [&](std::uint32_t vertex) {
        return input_.min_normal_cosine || (flags_[vertex] & is_sharp) != 0;
    };
    normal_begin_.assign(input_.positions.size() + 1, 0);
    for (const CornerData& corner : corners_) {
        if (is_listed(corner.vertex)) ++normal_begin_[corner.vertex + 1];
    }
    std::partial_sum(normal_begin_.begin(), normal_begin_.end(), normal_begin_.begin());
    normals_at_.resize(normal_begin_.back());
    std::vector<std::uint32_t> end(normal_begin_.begin(), normal_begin_.end() - 1);
    for (std::size_t corner = 0; corner < corners_.size(); ++corner) {
        const std::uint32_t vertex = corners_[corner].vertex;
        if (is_listed(vertex)) normals_at_[end[vertex]++] = glm::vec3(input_normal(corner / 3));
    }
}

/// Returns whether the edge that begins at a corner is a line at the end with the given wedge of
/// the corner's triangle. What differs only at the other end, as at the pole of a sphere, does not
/// bind this one.
bool Collapser::is_line_at(Corner corner, std::uint32_t wedge) const {
    const Corner beyond = corners_[corner].opposite;
    if (beyond == no_corner) return true;
    return wedge != corners_[beyond].wedge && wedge != corners_[next_in_triangle(beyond)].wedge;
}

/// Gathers triangles counter-clockwise, beginning at a corner. \return false if there are more than
/// max_valence
bool Collapser::gather(Corner start, Ring& ring) const {
    ring.size = 0;
    ring.lines = 0;
    std::uint32_t wedge = corners_[start].wedge;
    const Corner* const first = ring.corners.data();
    for (Corner corner = start;;) {
        if (ring.size == max_valence) return false;
        ring.corners[ring.size] = corner;
        ring.neighbors[ring.size] = corners_[next_in_triangle(corner)].vertex;
        ring.is_line[ring.size] = corners_[corner].wedge != wedge;
        ring.lines += ring.is_line[ring.size] ? 1 : 0;
        wedge = corners_[corner].wedge;
        ++ring.size;
        const CornerData& previous = corners_[previous_in_triangle(corner)];
        corner = previous.opposite;
        if (corner == *first) {
            ring.has_border = false;
            ring.spokes = ring.size;
            ring.is_line[0] = corners_[corner].wedge != wedge;
            ring.lines += ring.is_line[0] ? 1 : 0;
            return true;
        }
        if (corner != no_corner) continue;
        ring.has_border = true;
        ring.neighbors[ring.size] = previous.vertex;
        ring.spokes = ring.size + 1;
        ring.is_line[0] = true;
        ring.is_line[ring.size] = true;
        ring.lines += 2;
        return true;
    }
}

/// Gathers the triangles around a vertex; at a boundary, the ring begins at its clockwise end.
/// \return false if there are more than max_valence
bool Collapser::find_ring(std::uint32_t vertex, Ring& ring) const {
    Corner start = corner_of_[vertex];
    if (!gather(start, ring)) return false;
    if (!ring.has_border || corners_[start].opposite == no_corner) return true;
    for (std::size_t steps = 0; corners_[start].opposite != no_corner; ++steps) {
        if (steps == max_valence) return false;
        start = next_in_triangle(corners_[start].opposite);
    }
    return gather(start, ring);
}

bool Collapser::may_move(std::uint32_t vertex, const Ring& ring) const {
    if ((flags_[vertex] & is_locked) != 0 || (ring.lines != 0 && ring.lines != 2)) return false;
    if (ring.has_border) return !input_.keeps_borders;
    return ring.lines == 0 || !input_.keeps_seams;
}

/// Describes the move along a spoke. \return false if lines forbid it
bool Collapser::find_move(const Ring& ring, std::size_t spoke, Move& move) const {
    if (ring.lines != 0 && !ring.is_line[spoke]) return false;
    move.spoke = spoke;
    move.target = ring.neighbors[spoke];
    const std::size_t left = ring.left(spoke);
    const std::size_t right = ring.right(spoke);
    move.before = {none, none};
    move.after = {none, none};
    if (left != no_side) {
        move.before[0] = corners_[ring.corners[left]].wedge;
        move.after[0] = corners_[next_in_triangle(ring.corners[left])].wedge;
    }
    if (right != no_side) {
        move.before[1] = corners_[ring.corners[right]].wedge;
        move.after[1] = corners_[previous_in_triangle(ring.corners[right])].wedge;
    }
    if (ring.lines != 0) return true;
    // If the neighbor has two wedges, it is undefined which one the vertex becomes.
    return move.after[0] == move.after[1];
}

/// Returns the quadric of the moved vertex at its target.
double Collapser::own_cost(std::uint32_t vertex, const Move& move) const {
    const glm::dvec3 p = point(move.target);
    double sum = quadrics_[vertex](p);
    if (sums_per_wedge_ == 0) return sum;
    for (std::size_t side = 0; side < 2; ++side) {
        if (move.before[side] == none || (side == 1 && move.before[1] == move.before[0])) continue;
        const double* sums = &attribute_sums_[move.before[side] * sums_per_wedge_];
        const std::span<const float> values = attributes(move.after[side]);
        for (std::size_t k = 0; k < values.size(); ++k) {
            const double* s = sums + 4 * k + 1;
            const double value = values[k];
            const double linear = s[0] * p.x + s[1] * p.y + s[2] * p.z + s[3];
            sum += value * (sums[0] * input_.attribute_weights[k] * value - 2.0 * linear);
        }
    }
    return sum;
}

double Collapser::cost(std::uint32_t vertex, const Move& move) const {
    return std::max(0.0, own_cost(vertex, move)) + errors_[move.target];
}

/// Returns the wedge that triangle `index` of the ring gets at its moved corner.
std::uint32_t Collapser::wedge_after(const Ring& ring, const Move& move, std::size_t index) const {
    return corners_[ring.corners[index]].wedge == move.before[0] ? move.after[0] : move.after[1];
}

/// Visits the indices of the triangles that remain.
template <typename Visit>
void Collapser::for_moved(const Ring& ring, const Move& move, const Visit& visit) const {
    const std::size_t left = ring.left(move.spoke);
    const std::size_t right = ring.right(move.spoke);
    for (std::size_t i = 0; i < ring.size; ++i) {
        if (i != left && i != right) visit(i);
    }
}

/// Returns whether a removed triangle has lines on both its other sides. The move would join them,
/// and the last triangle between them, of a texture island or a material, would vanish.
bool Collapser::joins_lines(const Ring& ring, const Move& move) const {
    const std::size_t left = ring.left(move.spoke);
    if (left != no_side) {
        const Corner beside = next_in_triangle(ring.corners[left]);
        const std::size_t spoke = left + 1 < ring.spokes ? left + 1 : 0;
        if (ring.is_line[spoke] && is_line_at(beside, corners_[beside].wedge)) return true;
    }
    const std::size_t right = ring.right(move.spoke);
    if (right == no_side) return false;
    const Corner beside = next_in_triangle(ring.corners[right]);
    return ring.is_line[right] && is_line_at(beside, corners_[next_in_triangle(beside)].wedge);
}

/// Returns whether two vertices have a common edge; true if both have too many edges to tell.
bool Collapser::is_adjacent(std::uint32_t a, std::uint32_t b) const {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
        const Corner given = corner_of_[from];
        Corner corner = given;
        std::size_t steps = 0;
        bool is_whole = false;
        for (; steps < max_valence; ++steps) {
            if (corners_[next_in_triangle(corner)].vertex == to) return true;
            const Corner previous = previous_in_triangle(corner);
            if (corners_[previous].vertex == to) return true;
            corner = corners_[previous].opposite;
            is_whole = corner == given;
            if (is_whole || corner == no_corner) break;
        }
        if (is_whole) return false;
        if (corner != no_corner) continue;
        for (corner = given; steps < max_valence; ++steps) {
            const Corner beyond = corners_[corner].opposite;
            if (beyond == no_corner) return false;
            corner = next_in_triangle(beyond);
            if (corners_[next_in_triangle(corner)].vertex == to) return true;
        }
    }
    return true;
}

/// The link condition: the surface stays a manifold of the same topology.
bool Collapser::keeps_topology(const Ring& ring, const Move& move) const {
    const auto index_of = [&](std::size_t i) { return i < ring.spokes ? i : i - ring.spokes; };
    for (std::size_t i = 0; i < ring.spokes; ++i) {
        if (i == move.spoke) continue;
        const bool is_beside =
            (ring.left(move.spoke) != no_side && i == index_of(move.spoke + 1)) ||
            (ring.right(move.spoke) != no_side && index_of(i + 1) == move.spoke);
        if (!is_beside && is_adjacent(ring.neighbors[i], move.target)) return false;
    }
    if (ring.has_border || ring.size > 3) return true;
    // The triangle that remains must not lie on the one beyond it, as in a tetrahedron.
    bool is_free = true;
    for_moved(ring, move, [&](std::size_t i) {
        const Corner beyond = corners_[next_in_triangle(ring.corners[i])].opposite;
        if (beyond != no_corner && corners_[previous_in_triangle(beyond)].vertex == move.target)
            is_free = false;
    });
    return is_free;
}

bool Collapser::turns_over(std::uint32_t vertex, Corner corner, const Move& move) const {
    const glm::dvec3 b = point(corners_[next_in_triangle(corner)].vertex);
    const glm::dvec3 c = point(corners_[previous_in_triangle(corner)].vertex);
    const glm::dvec3 before = glm::cross(b - point(vertex), c - point(vertex));
    const glm::dvec3 after = glm::cross(b - point(move.target), c - point(move.target));
    const double squared_before = glm::dot(before, before);
    if (!(squared_before > 0.0)) return false;  // A triangle without area has no orientation.
    return !(glm::dot(before, after) >
             min_turn_cosine * std::sqrt(squared_before * glm::dot(after, after)));
}

bool Collapser::turns_texture_over(Corner corner, std::uint32_t wedge_after) const {
    const glm::dvec2 b = texcoord(corners_[next_in_triangle(corner)].wedge);
    const glm::dvec2 c = texcoord(corners_[previous_in_triangle(corner)].wedge);
    const auto area_from = [&](const glm::dvec2& a) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    const double before = area_from(texcoord(corners_[corner].wedge));
    return before != 0.0 && !(before * area_from(texcoord(wedge_after)) > 0.0);
}

/// Returns whether a triangle of the input at a vertex has a normal within the maximum angle, or
/// 90 degrees, of a cross product. At a vertex with more than max_valence triangles, a part of them
/// is compared.
///
/// A cross product within 90 degrees of the sum of the normals is within 90 degrees of one of them.
/// At vertices that are not sharp, only those are accepted.
bool Collapser::has_normal_near(std::uint32_t vertex, const glm::dvec3& cross) const {
    const glm::dvec3 mean(mean_normals_[vertex]);
    if (!input_.min_normal_cosine && glm::dot(mean, cross) > 0.0) return true;
    bool has_normal = mean != glm::dvec3(0.0);
    const std::uint32_t begin = normal_begin_.empty() ? 0 : normal_begin_[vertex];
    const std::uint32_t end = normal_begin_.empty() ? 0 : normal_begin_[vertex + 1];
    const std::uint32_t step = 1 + (end - begin) / static_cast<std::uint32_t>(max_valence);
    const double cosine = std::max(input_.min_normal_cosine.value_or(0.0), 0.0);
    const double least = cosine * glm::length(cross);
    for (std::uint32_t i = begin; i < end; i += step) {
        const glm::dvec3 normal(normals_at_[i]);
        if (normal == glm::dvec3(0.0)) continue;
        if (glm::dot(normal, cross) >= least) return true;
        has_normal = true;
    }
    return !has_normal;
}

/// Returns whether a triangle is near the input at each of its corners.
bool Collapser::is_near_normals(const glm::dvec3& cross, std::uint32_t a, std::uint32_t b,
                                std::uint32_t c) const {
    return has_normal_near(a, cross) && has_normal_near(b, cross) && has_normal_near(c, cross);
}

/// Returns whether the normal of a moved triangle differs too much from those of the input.
bool Collapser::leaves_normals(Corner corner, const Move& move) const {
    const std::uint32_t vb = corners_[next_in_triangle(corner)].vertex;
    const std::uint32_t vc = corners_[previous_in_triangle(corner)].vertex;
    const glm::dvec3 cross =
        glm::cross(point(vb) - point(move.target), point(vc) - point(move.target));
    return !is_near_normals(cross, move.target, vb, vc);
}

/// Makes all checks that do not concern the cost.
bool Collapser::is_valid(std::uint32_t vertex, const Ring& ring, const Move& move) const {
    if (joins_lines(ring, move)) return false;
    bool is_good = true;
    for_moved(ring, move, [&](std::size_t i) {
        if (!is_good) return;
        const Corner corner = ring.corners[i];
        is_good =
            !turns_over(vertex, corner, move) &&
            !(input_.has_texcoords && turns_texture_over(corner, wedge_after(ring, move, i))) &&
            !leaves_normals(corner, move);
    });
    return is_good && keeps_topology(ring, move);
}

/// Finds the cheapest collapse of a vertex, and makes all checks if the vertex is careful.
float Collapser::best_move(std::uint32_t vertex, const Ring& ring, Move& best) const {
    if (!may_move(vertex, ring)) return no_collapse;
    const bool careful = (flags_[vertex] & is_careful) != 0;
    double least = std::numeric_limits<double>::infinity();
    Move move;
    for (std::size_t spoke = 0; spoke < ring.spokes; ++spoke) {
        if (!find_move(ring, spoke, move)) continue;
        const double error = cost(vertex, move);
        const glm::dvec3 along = point(move.target) - point(vertex);
        const double squared_length = glm::dot(along, along);
        const double here = error + length_preference * squared_length * squared_length;
        if (here > least || (here == least && move.target > best.target)) continue;
        if (careful && !is_valid(vertex, ring, move)) continue;
        if (input_.max_error) {
            const double area = areas_[vertex] + areas_[move.target];
            if (error > (*input_.max_error * *input_.max_error + rounding) * area) continue;
        }
        least = here;
        best = move;
    }
    return std::isinf(least) ? no_collapse : static_cast<float>(std::min(least, 1e30));
}

float Collapser::evaluate(std::uint32_t vertex, std::size_t& examined) const {
    Ring ring;
    const bool is_small = find_ring(vertex, ring);
    examined += ring.size;
    if (!is_small) return no_collapse;
    Move move;
    return best_move(vertex, ring, move);
}

/// Joins what lies beyond two edges that become one.
void Collapser::remove(Corner first, Corner second) {
    const Corner beyond_first = corners_[first].opposite;
    const Corner beyond_second = corners_[second].opposite;
    if (beyond_first != no_corner) corners_[beyond_first].opposite = beyond_second;
    if (beyond_second != no_corner) corners_[beyond_second].opposite = beyond_first;
    // The vertex that is left at the joined edge gets a corner of a triangle that remains.
    const std::uint32_t left_over = corners_[second].vertex;
    if (beyond_first != no_corner) {
        corner_of_[left_over] = beyond_first;
    } else if (beyond_second != no_corner) {
        corner_of_[left_over] = next_in_triangle(beyond_second);
    }
    const Corner start = first - first % 3;
    for (Corner corner = start; corner < start + 3; ++corner)
        corners_[corner].vertex = none;
}

/// \return the number of triangles that it removes
std::size_t Collapser::collapse(std::uint32_t vertex, const Ring& ring, const Move& move) {
    errors_[move.target] += std::max(0.0, own_cost(vertex, move));
    quadrics_[move.target] += quadrics_[vertex];
    if (!areas_.empty()) areas_[move.target] += areas_[vertex];
    if (sums_per_wedge_ > 0) {
        for (std::size_t side = 0; side < 2; ++side) {
            if (move.before[side] == none || (side == 1 && move.before[1] == move.before[0]))
                continue;
            const std::span<double> from = attribute_sums(move.before[side]);
            const std::span<double> to = attribute_sums(move.after[side]);
            for (std::size_t k = 0; k < to.size(); ++k)
                to[k] += from[k];
        }
    }
    const std::size_t left = ring.left(move.spoke);
    const std::size_t right = ring.right(move.spoke);
    Corner kept = no_corner;
    for_moved(ring, move, [&](std::size_t i) {
        const Corner corner = ring.corners[i];
        corners_[corner].wedge = wedge_after(ring, move, i);
        kept = corner;
    });
    for_moved(ring, move, [&](std::size_t i) { corners_[ring.corners[i]].vertex = move.target; });
    if (kept == no_corner) {
        // Only one triangle is there, and it is removed: the target has one beyond it.
        const Corner corner = ring.corners[0];
        const Corner between = next_in_triangle(corner);
        const Corner beyond = corners_[between].opposite;
        kept = corners_[beyond].vertex == move.target ? beyond : next_in_triangle(beyond);
    }
    if (left != no_side) {
        const Corner corner = ring.corners[left];
        remove(next_in_triangle(corner), previous_in_triangle(corner));
    }
    if (right != no_side) {
        const Corner corner = ring.corners[right];
        remove(corner, next_in_triangle(corner));
    }
    corner_of_[move.target] = kept;
    corner_of_[vertex] = no_corner;
    for (std::size_t i = 0; i < ring.spokes; ++i)
        flags_[ring.neighbors[i]] |= is_dirty;
    return (left != no_side ? 1U : 0U) + (right != no_side ? 1U : 0U);
}

/// Collapses a vertex if that costs no more than a limit on the current surface: previous collapses
/// may have changed its ring or the error of the target.
///
/// \param ring  that of the vertex; of size 0 if it is too large
/// \return the number of triangles that were removed
std::size_t Collapser::collapse_if_cheap(std::uint32_t vertex, const Ring& ring, float limit) {
    Move move;
    flags_[vertex] &= static_cast<std::uint8_t>(~is_dirty);
    costs_[vertex] = ring.size > 0 ? best_move(vertex, ring, move) : no_collapse;
    if (!(costs_[vertex] <= limit)) return 0;
    if ((flags_[vertex] & is_careful) == 0 && !is_valid(vertex, ring, move)) {
        costs_[vertex] = no_collapse;
        flags_[vertex] |= is_careful | is_dirty;
        return 0;
    }
    return collapse(vertex, ring, move);
}

/// Executes collapses in the given order (cost in the upper half, vertex in the lower half) if
/// their cost on the current surface is within the limit. \return how many there were
std::size_t Collapser::execute(std::span<const std::uint64_t> order, float limit,
                               std::size_t most) {
    std::size_t done = 0;
    std::size_t examined = 0;
    Ring ring;
    for (const std::uint64_t entry : order) {
        if (done == most || triangles_ <= target_) break;
        const auto vertex = static_cast<std::uint32_t>(entry);
        const bool is_small = find_ring(vertex, ring);
        examined += ring.size;
        if (!is_small) ring.size = 0;
        const std::size_t removed = collapse_if_cheap(vertex, ring, limit);
        if (removed == 0) continue;
        triangles_ -= removed;
        ++done;
        // The rings around now may contain vertices of other groups.
        for (std::size_t i = 0; !groups_.empty() && i < ring.spokes; ++i)
            at_border_[ring.neighbors[i]] = 1;
    }
    examined_ += examined;
    return done;
}

/// Divides the vertices that may move into groups, anew whenever their number has halved.
void Collapser::assign_groups() {
    if (alive_.size() < 2 * group_size) {
        free_memory(groups_);
        free_memory(at_border_);
        return;
    }
    if (!groups_.empty() && 2 * alive_.size() > grouped_) return;
    grouped_ = alive_.size();
    groups_.assign(corner_of_.size(), none);
    at_border_.assign(corner_of_.size(), 0);
    for (std::size_t i = 0; i < alive_.size(); ++i)
        groups_[alive_[i]] = static_cast<std::uint32_t>(i / group_size);
    parallel_for(corners_.size() / 3, group_size, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = 3 * begin; first < 3 * end; first += 3) {
            if (corners_[first].vertex == none) continue;
            const std::uint32_t group = groups_[corners_[first].vertex];
            if (group != none && groups_[corners_[first + 1].vertex] == group &&
                groups_[corners_[first + 2].vertex] == group)
                continue;
            // Other threads may write the same value.
            for (std::size_t corner = first; corner < first + 3; ++corner)
                std::atomic_ref(at_border_[corners_[corner].vertex])
                    .store(1, std::memory_order_relaxed);
        }
    });
}

/// Executes the collapses in the order of the vertices, the groups in parallel.
///
/// A collapse reads and writes only the triangles around the vertex and around its neighbors. So a
/// group executes those whose neighbors have no neighbors in other groups, which collapses within
/// the group do not change. The others follow afterwards, so the result does not depend on the
/// number of threads. \return how many there were
std::size_t Collapser::execute_groups(std::span<const std::uint64_t> order, float limit) {
    struct Work {
        std::size_t begin = 0;
        std::size_t end = 0;
        std::size_t done = 0;
        std::size_t removed = 0;
        std::size_t examined = 0;
        std::vector<std::uint64_t> left;
    };
    std::vector<Work> works;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::uint32_t group = groups_[static_cast<std::uint32_t>(order[i])];
        if (i == 0 || groups_[static_cast<std::uint32_t>(order[i - 1])] != group)
            works.emplace_back().begin = i;
        works.back().end = i + 1;
    }
    parallel_for(works.size(), 1, [&](std::size_t first, std::size_t last) {
        Ring ring;
        for (std::size_t w = first; w < last; ++w) {
            Work& work = works[w];
            for (std::size_t i = work.begin; i < work.end; ++i) {
                const auto vertex = static_cast<std::uint32_t>(order[i]);
                bool is_inside = at_border_[vertex] == 0;
                if (is_inside) {
                    if (!find_ring(vertex, ring)) ring.size = ring.spokes = 0;
                    for (std::size_t k = 0; k < ring.spokes; ++k)
                        is_inside = is_inside && at_border_[ring.neighbors[k]] == 0;
                    work.examined += ring.size;
                }
                if (!is_inside) {
                    work.left.push_back(order[i]);
                    continue;
                }
                const std::size_t removed = collapse_if_cheap(vertex, ring, limit);
                work.removed += removed;
                work.done += removed > 0 ? 1 : 0;
            }
        }
    });
    std::size_t done = 0;
    std::vector<std::uint64_t> left;
    for (const Work& work : works) {
        done += work.done;
        triangles_ -= work.removed;
        examined_ += work.examined;
        left.insert(left.end(), work.left.begin(), work.left.end());
    }
    return done + execute(left, limit, left.size());
}

/// Computes costs, chooses candidates and executes them.
void Collapser::run_pass(double fraction) {
    constexpr std::size_t grain = 4096;
    std::erase_if(alive_, [&](std::uint32_t v) { return corner_of_[v] == no_corner; });
    assign_groups();
    parallel_for(alive_.size(), grain, [&](std::size_t begin, std::size_t end) {
        std::size_t examined = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t v = alive_[i];
            if (needs_cost(v)) costs_[v] = evaluate(v, examined);
        }
        examined_ += examined;
    });
    const auto key_of = [&](std::uint32_t v) {
        return (std::uint64_t(std::bit_cast<std::uint32_t>(costs_[v])) << 32) | v;
    };
    std::vector<std::uint64_t> order;
    for (const std::uint32_t v : alive_) {
        if (needs_cost(v)) flags_[v] &= static_cast<std::uint8_t>(~is_dirty);
        if (costs_[v] < no_collapse) order.push_back(key_of(v));
    }
    if (order.empty()) return;
    constexpr std::size_t least = 16;
    const std::size_t wanted = (triangles_ - target_ + 1) / 2;
    const auto share = static_cast<std::size_t>(fraction * static_cast<double>(order.size()));
    const std::size_t count = std::min({order.size(), std::max(share, least), wanted});
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(count - 1);
    std::nth_element(order.begin(), last, order.end());
    const std::uint64_t bound = *last;
    const auto limit = std::bit_cast<float>(static_cast<std::uint32_t>(bound >> 32));
    order.resize(count);
    if (count < wanted) {
        // All candidates are executed, and neighbors in memory follow each other.
        order.clear();
        for (const std::uint32_t v : alive_) {
            if (key_of(v) <= bound) order.push_back(key_of(v));
        }
        result_.collapses += groups_.empty() ? execute(order, tolerance * limit, wanted)
                                             : execute_groups(order, tolerance * limit);
    } else {
        std::sort(order.begin(), order.end());
        result_.collapses += execute(order, tolerance * limit, wanted);
    }
}

/// Returns where a vertex fits the planes and attributes of its quadric best, relative to its
/// position. Directions that the quadric does not determine are left out.
///
/// The minimum is the mean height of the planes above the vertex. On a curved surface, triangles
/// between such vertices still lie below the surface by about half as much (measured on tori), so
/// the vertex moves on by that. There, a quarter of the quadric remains at the minimum; at a
/// corner, which the minimum restores exactly, nothing does.
glm::dvec3 Collapser::fitted_offset(std::uint32_t vertex, const Ring& ring) const {
    constexpr double damping = 1e-3;
    constexpr double beyond = 0.55;
    constexpr double remainder_of_curvature = 0.25;
    const Quadric& q = quadrics_[vertex];
    const glm::dvec3 p = point(vertex);
    double before = q(p);
    glm::dvec3 slope(q.xx * p.x + q.xy * p.y + q.xz * p.z + q.linear.x,
                     q.xy * p.x + q.yy * p.y + q.yz * p.z + q.linear.y,
                     q.xz * p.x + q.yz * p.y + q.zz * p.z + q.linear.z);
    std::uint32_t last = none;
    for (std::size_t i = 0; sums_per_wedge_ > 0 && i < ring.size; ++i) {
        const std::uint32_t wedge = corners_[ring.corners[i]].wedge;
        if (wedge == last) continue;
        last = wedge;
        // On a closed ring with a line, the first wedge may come again at the end.
        if (i > 0 && wedge == corners_[ring.corners[0]].wedge) break;
        const double* sums = &attribute_sums_[wedge * sums_per_wedge_];
        const std::span<const float> values = attributes(wedge);
        for (std::size_t k = 0; k < values.size(); ++k) {
            const double* s = sums + 4 * k + 1;
            const double value = values[k];
            slope -= value * glm::dvec3(s[0], s[1], s[2]);
            before += value * (sums[0] * input_.attribute_weights[k] * value -
                               2.0 * (s[0] * p.x + s[1] * p.y + s[2] * p.z + s[3]));
        }
    }
    const double trace = q.xx + q.yy + q.zz;
    const double xx = q.xx + damping * trace;
    const double yy = q.yy + damping * trace;
    const double zz = q.zz + damping * trace;
    const glm::dvec3 row_x(xx, q.xy, q.xz);
    const glm::dvec3 row_y(q.xy, yy, q.yz);
    const glm::dvec3 row_z(q.xz, q.yz, zz);
    const glm::dvec3 yz = glm::cross(row_y, row_z);
    const double determinant = glm::dot(row_x, yz);
    if (!(determinant > 0.0) || !(before > rounding * trace)) return glm::dvec3(0.0);
    const glm::dvec3 offset =
        -(slope.x * yz + slope.y * glm::cross(row_z, row_x) + slope.z * glm::cross(row_x, row_y)) /
        determinant;
    const double after = before + glm::dot(slope, offset);
    const double remainder = std::clamp(after / (remainder_of_curvature * before), 0.0, 1.0);
    return (1.0 + beyond * remainder) * offset;
}

/// Returns whether a vertex can be at another position: no triangle turns over or leaves the
/// normals of the input. The vertex is there afterwards.
bool Collapser::may_be_at(std::uint32_t vertex, const Ring& ring, const glm::vec3& position) {
    const glm::dvec3 before = point(vertex);
    input_.positions[vertex] = position;
    const glm::dvec3 after = point(vertex);
    for (std::size_t i = 0; i < ring.size; ++i) {
        const std::uint32_t vb = corners_[next_in_triangle(ring.corners[i])].vertex;
        const std::uint32_t vc = corners_[previous_in_triangle(ring.corners[i])].vertex;
        const glm::dvec3 b = point(vb);
        const glm::dvec3 c = point(vc);
        const glm::dvec3 cross_before = glm::cross(b - before, c - before);
        const glm::dvec3 cross_after = glm::cross(b - after, c - after);
        const double lengths = glm::length(cross_before) * glm::length(cross_after);
        if (!(glm::dot(cross_before, cross_after) > min_fit_cosine * lengths)) return false;
        if (!is_near_normals(cross_after, vertex, vb, vc)) return false;
    }
    return true;
}

/// Moves the remaining vertices to where they fit the input best, one after another. Boundaries
/// stay in place, because another mesh may meet them.
void Collapser::fit_positions() {
    Ring ring;
    std::vector<bool> has_moved(input_.positions.size(), false);
    for (const std::uint32_t v : alive_) {
        if (corner_of_[v] == none || (!input_.is_fixed.empty() && input_.is_fixed[v])) continue;
        const bool is_small = find_ring(v, ring);
        examined_ += ring.size;
        if (!is_small || ring.has_border || !may_move(v, ring)) continue;
        const glm::dvec3 offset = fitted_offset(v, ring);
        const glm::vec3 before = input_.positions[v];
        const glm::vec3 after(input_.center + (point(v) + offset) / input_.scale);
        if (after == before || !is_finite(after)) continue;
        if (may_be_at(v, ring, after)) {
            has_moved[v] = true;
        } else {
            input_.positions[v] = before;
        }
    }
    for (const CornerData& corner : corners_) {
        if (corner.vertex != none && has_moved[corner.vertex])
            result_.moved.emplace_back(corner.wedge, input_.positions[corner.vertex]);
    }
}

Collapsed Collapser::run() {
    // If a pass has no success, all vertices are checked carefully once more: what lies around
    // their neighbors may have changed. The number of such checks is limited, so that the time is
    // linear.
    constexpr std::size_t max_checks = 8;
    std::size_t checks = 0;
    bool was_checked = false;
    while (triangles_ > target_) {
        const std::size_t before = result_.collapses;
        ++result_.passes;
        run_pass(was_checked ? 1.0 : pass_fraction);
        const bool has_success = result_.collapses > before;
        if (!has_success && (was_checked || checks == max_checks)) break;
        was_checked = !has_success;
        if (has_success) continue;
        ++checks;
        for (const std::uint32_t v : alive_) {
            flags_[v] |= is_dirty | is_careful;
            costs_[v] = no_collapse;
        }
    }
    if (input_.fits_positions && !quadrics_.empty()) fit_positions();
    result_.triangles = triangles_;
    result_.examined = examined_;
    result_.remaining.reserve(triangles_);
    result_.wedges.reserve(triangles_);
    for (Corner first = 0; first < corners_.size(); first += 3) {
        if (corners_[first].vertex == none) continue;
        result_.remaining.push_back(first / 3);
        result_.wedges.emplace_back(corners_[first].wedge, corners_[first + 1].wedge,
                                    corners_[first + 2].wedge);
    }
    return std::move(result_);
}

}  // namespace

Collapsed collapse_edges(CollapseInput input) {
    return Collapser(std::move(input)).run();
}

}  // namespace relief
