// SPDX-License-Identifier: Apache-2.0
// Edge collapses in passes: costs, checks of normals and textures, and parallel execution. Tests:
// tests/mesh/topology/decimate_test.cpp.
#include "topology/edge_collapse.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "parallel.h"
#include "portable_math.h"
#include "relaxed_store.h"
#include "topology/collapse_deviation.h"
#include "topology/collapse_fit.h"
#include "topology/collapse_normals.h"
#include "topology/edge_collapse_parts.h"
#include "topology/triangle_distance.h"

namespace relief::detail {
namespace {

constexpr std::uint32_t none = no_corner;
constexpr float no_collapse = std::numeric_limits<float>::infinity();

/// The maximum number of vertices at one position that move together.
constexpr std::size_t max_linked = 8;

/// A move of one of the vertices at a position.
struct LinkedMove {
    std::uint32_t vertex = none;
    Ring ring;
    Move move;
};

/// The maximum rotation of a triangle in one move: about 78 degrees. Several moves may add up; see
/// Collapser::is_near_normals().
constexpr double min_turn_cosine = 0.2;

/// The maximum distance of a vertex from the triangles that replace it, relative to the size of its
/// connected part. Half of a square and a corner of a cube are farther away, which are their shape.
constexpr double max_part_distance = 0.2;

/// The weight of the squared length, which prefers short edges if costs are otherwise equal. For
/// pictures it is smaller, because long edges of flat parts compete with rough parts.
constexpr double length_preference = 1e-7;
constexpr double length_preference_in_pictures = 1e-13;

/// The part of the possible collapses that a pass executes. Smaller fractions follow the order of
/// cost more exactly and take more passes.
constexpr double pass_fraction = 0.25;

/// The number of vertices in a group, neighbors along the curve, that one thread executes.
constexpr std::size_t group_size = 16384;

/// A candidate whose cost has grown by at most this factor since its pass began is executed.
constexpr float tolerance = 1.5F;

constexpr std::uint8_t is_dirty = 1;    ///< The cost must be computed.
constexpr std::uint8_t is_careful = 2;  ///< The cheapest collapse was refused once, so all checks
                                        ///< are made when the cost is computed.
constexpr std::uint8_t is_locked = 4;
constexpr std::uint8_t is_linked = 16;  ///< Other vertices have its position and move with it.

class Collapser {
  public:
    explicit Collapser(CollapseInput input);
    Collapsed run();

  private:
    [[nodiscard]] glm::dvec2 texcoord(std::uint32_t wedge) const {
        const std::span<const float> values = input_.attributes_at(wedge);
        return {values[0], values[1]};
    }

    void add_triangle(std::size_t triangle);

    [[nodiscard]] bool may_move(std::uint32_t vertex, const Ring& ring) const;
    [[nodiscard]] bool is_valid(std::uint32_t vertex, const Ring& ring, const Move& move) const;
    [[nodiscard]] bool keeps_part(std::uint32_t vertex, const Ring& ring, const Move& move) const;
    [[nodiscard]] bool turns_over(std::uint32_t vertex, Corner corner, const Move& move) const;
    [[nodiscard]] bool turns_texture_over(Corner corner, std::uint32_t wedge_after) const;
    [[nodiscard]] bool leaves_normals(Corner corner, const Move& move) const;
    /// Costs of vertices whose neighborhood changed are not computed again until they are
    /// candidates: mostly they have become larger.
    [[nodiscard]] bool needs_cost(std::uint32_t vertex) const {
        return (flags_[vertex] & is_dirty) != 0 && costs_[vertex] == no_collapse;
    }

    float best_move(std::uint32_t vertex, const Ring& ring, Move& best) const;
    [[nodiscard]] std::uint32_t next_at_position(std::uint32_t vertex) const {
        return input_.next_at_position.empty() ? vertex : input_.next_at_position[vertex];
    }
    /// Returns the smallest vertex at the position of a vertex, which stands for all.
    [[nodiscard]] std::uint32_t first_at_position(std::uint32_t vertex) const {
        return first_at_position_.empty() ? vertex : first_at_position_[vertex];
    }
    [[nodiscard]] std::vector<LinkedMove> linked_vertices(std::uint32_t first) const;
    [[nodiscard]] bool find_linked_moves(std::uint32_t position, std::span<LinkedMove> moves) const;
    [[nodiscard]] bool is_valid(std::span<const LinkedMove> moves) const;
    float best_linked_moves(std::uint32_t first, std::vector<LinkedMove>& best) const;
    std::size_t collapse_linked_if_cheap(std::uint32_t first, float limit);
    float evaluate(std::uint32_t vertex, std::size_t& examined) const;
    bool postpone(std::uint32_t vertex, const Ring& ring, const Move& move, float limit);
    std::size_t collapse(std::uint32_t vertex, const Ring& ring, const Move& move);
    std::size_t collapse_if_cheap(std::uint32_t vertex, const Ring& ring, float limit);
    std::size_t execute(std::span<const std::uint64_t> order, float limit, std::size_t most);
    void assign_groups();
    std::size_t execute_groups(std::span<const std::uint64_t> order, float limit);
    void run_pass(double fraction);

    void fit_remaining();
    void start_anew();
    void compute_all_costs_anew(std::uint8_t flags);
    [[nodiscard]] Obstacles obstacles() const;

    CollapseInput input_;
    std::vector<glm::vec3> original_positions_;  ///< If positions are fitted.
    CollapseSurface surface_;
    std::optional<CollapseError> error_;          ///< If edges are to collapse,
    std::optional<CollapseNormals> normals_;      ///< and then, too.
    std::optional<CollapseDeviation> deviation_;  ///< If the largest distance counts.
    double area_ = 0.0;                           ///< Of the input.
    std::atomic<std::size_t> postponed_ = 0;      ///< The collapses that moved the surface too far.
    std::size_t more_candidates_ = 0;             ///< Instead of those that a pass has postponed.
    bool is_before_fit_ = false;  ///< Positions are fitted before the end once more.
    // By vertex:
    std::vector<float> costs_;  ///< CollapseError::priority() of the cheapest collapse.
    std::vector<std::uint8_t> flags_;
    std::vector<std::uint32_t> first_at_position_;  ///< Empty: no vertices share a position.
    std::vector<std::uint32_t> alive_;              ///< The vertices that may move, ascending.
    // Only if there are at least two groups:
    std::vector<std::uint32_t> groups_;    ///< By vertex; none for locked ones.
    std::vector<std::uint8_t> at_border_;  ///< By vertex: a neighbor may be in another group.
    std::size_t grouped_ = 0;              ///< The number of vertices that may move at the time.
    std::size_t triangles_ = 0;
    std::size_t target_ = 0;
    std::size_t max_count_ = 1;  ///< The largest one of CollapseInput::counts.
    Collapsed result_;
    std::atomic<std::size_t> examined_ = 0;
};

Collapser::Collapser(CollapseInput input) : input_(std::move(input)), surface_(input_) {
    const std::size_t vertices = input_.positions.size();
    const std::size_t triangles = surface_.corners().size() / 3;
    triangles_ = triangles;
    if (!input_.counts.empty()) {
        triangles_ = std::accumulate(input_.counts.begin(), input_.counts.end(), std::size_t(0));
        max_count_ = *std::max_element(input_.counts.begin(), input_.counts.end());
    }
    target_ = input_.triangles.value_or(0);
    if (triangles_ <= target_) return;
    error_.emplace(input_, surface_);
    if (input_.fits_positions) original_positions_ = input_.positions;
    normals_.emplace(input_, surface_);
    for (std::size_t t = 0; t < triangles; ++t)
        add_triangle(t);
    for (std::size_t t = 0; t < triangles; ++t)
        error_->add_lines(t);
    flags_.assign(vertices, 0);
    normals_->finish();
    costs_.assign(vertices, no_collapse);
    if (input_.for_largest_distance && !input_.max_error) {
        deviation_.emplace(input_, surface_,
                           input_.fits_positions ? original_positions_ : input_.positions);
    }
    if (!input_.next_at_position.empty()) first_at_position_.assign(vertices, none);
    for (std::uint32_t v = 0; v < first_at_position_.size(); ++v) {
        for (std::uint32_t at = v; first_at_position_[at] == none; at = next_at_position(at))
            first_at_position_[at] = v;
    }
    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (next_at_position(v) != v) {
            flags_[v] |= is_linked;
            if (first_at_position(v) != v) continue;
            flags_[v] |= is_dirty;
            alive_.push_back(v);
        } else if (input_.topology.is_cut[v]) {
            flags_[v] |= is_locked;
        } else {
            flags_[v] |= is_dirty;
            alive_.push_back(v);
        }
    }
}

void Collapser::add_triangle(std::size_t triangle) {
    const glm::dvec3 cross = cross_of(input_, surface_, triangle);
    const double doubled_area = glm::length(cross);
    if (!(doubled_area > 0.0)) return;
    area_ += doubled_area / 2.0;
    const glm::dvec3 normal = cross / doubled_area;
    normals_->add_triangle(triangle, normal);
    error_->add_triangle(triangle, normal, doubled_area);
}

bool Collapser::may_move(std::uint32_t vertex, const Ring& ring) const {
    if ((flags_[vertex] & is_locked) != 0 || (ring.lines != 0 && ring.lines != 2)) return false;
    if (ring.has_border) return !input_.keeps_borders;
    return ring.lines == 0 || !input_.keeps_seams;
}

bool Collapser::turns_over(std::uint32_t vertex, Corner corner, const Move& move) const {
    const glm::dvec3 b = input_.point(surface_[next_in_triangle(corner)].vertex);
    const glm::dvec3 c = input_.point(surface_[previous_in_triangle(corner)].vertex);
    const glm::dvec3 before = glm::cross(b - input_.point(vertex), c - input_.point(vertex));
    const glm::dvec3 after =
        glm::cross(b - input_.point(move.target), c - input_.point(move.target));
    const double squared_before = glm::dot(before, before);
    if (!(squared_before > 0.0)) return false;  // A triangle without area has no orientation.
    return !(glm::dot(before, after) >
             min_turn_cosine * std::sqrt(squared_before * glm::dot(after, after)));
}

bool Collapser::turns_texture_over(Corner corner, std::uint32_t wedge_after) const {
    const glm::dvec2 b = texcoord(surface_[next_in_triangle(corner)].wedge);
    const glm::dvec2 c = texcoord(surface_[previous_in_triangle(corner)].wedge);
    const auto area_from = [&](const glm::dvec2& a) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    const double before = area_from(texcoord(surface_[corner].wedge));
    return before != 0.0 && !(before * area_from(texcoord(wedge_after)) > 0.0);
}

/// Returns whether the normal of a moved triangle differs too much from those of the input.
bool Collapser::leaves_normals(Corner corner, const Move& move) const {
    const std::uint32_t vb = surface_[next_in_triangle(corner)].vertex;
    const std::uint32_t vc = surface_[previous_in_triangle(corner)].vertex;
    const glm::dvec3 cross = glm::cross(input_.point(vb) - input_.point(move.target),
                                        input_.point(vc) - input_.point(move.target));
    return !normals_->is_near(cross, move.target, vb, vc);
}

/// Returns whether the connected part around a vertex keeps its shape: the triangles after the move
/// are near the vertex, relative to the size of the part.
bool Collapser::keeps_part(std::uint32_t vertex, const Ring& ring, const Move& move) const {
    if (input_.part_sizes.empty()) return true;
    const double most = max_part_distance * input_.part_sizes[vertex];
    const glm::dvec3 p = input_.point(vertex);
    const glm::dvec3 target = input_.point(move.target);
    if (glm::dot(target - p, target - p) <= most * most) return true;
    bool is_near = false;
    CollapseSurface::for_moved(ring, move, [&](std::size_t i) {
        if (is_near) return;
        const Corner corner = ring.corners[i];
        const glm::dvec3 b = input_.point(surface_[next_in_triangle(corner)].vertex);
        const glm::dvec3 c = input_.point(surface_[previous_in_triangle(corner)].vertex);
        is_near = squared_distance(p, Corners{target, b, c}) <= most * most;
    });
    return is_near;
}

/// Makes all checks that do not concern the cost.
bool Collapser::is_valid(std::uint32_t vertex, const Ring& ring, const Move& move) const {
    if (surface_.joins_lines(ring, move)) return false;
    bool is_good = true;
    CollapseSurface::for_moved(ring, move, [&](std::size_t i) {
        if (!is_good) return;
        const Corner corner = ring.corners[i];
        is_good = !turns_over(vertex, corner, move) &&
                  !(input_.has_texcoords &&
                    turns_texture_over(corner, surface_.wedge_after(ring, move, i))) &&
                  !leaves_normals(corner, move);
    });
    return is_good && keeps_part(vertex, ring, move) && surface_.keeps_topology(ring, move);
}

/// Finds the cheapest collapse of a vertex, and makes all checks if the vertex is careful.
float Collapser::best_move(std::uint32_t vertex, const Ring& ring, Move& best) const {
    if (!may_move(vertex, ring)) return no_collapse;
    const bool careful = (flags_[vertex] & is_careful) != 0;
    const double preference =
        input_.for_picture ? length_preference_in_pictures : length_preference;
    double least = std::numeric_limits<double>::infinity();
    Move move;
    for (std::size_t spoke = 0; spoke < ring.spokes; ++spoke) {
        if (!surface_.find_move(ring, spoke, move)) continue;
        const double error = error_->cost(vertex, move);
        const glm::dvec3 along = input_.point(move.target) - input_.point(vertex);
        const double squared_length = glm::dot(along, along);
        const double here =
            error_->priority(error + preference * squared_length * squared_length, vertex, move);
        if (here > least || (here == least && move.target > best.target)) continue;
        if (careful && !is_valid(vertex, ring, move)) continue;
        if (!error_->is_within_limit(error, vertex, move) ||
            !error_->keeps_part(error, vertex, move))
            continue;
        least = here;
        best = move;
    }
    return std::isinf(least) ? no_collapse : static_cast<float>(std::min(least, 1e30));
}

/// Gathers the rings of all vertices at a position if their sheets share two lines from it and
/// nothing else: a line of all sheets passes through the position. Otherwise empty.
std::vector<LinkedMove> Collapser::linked_vertices(std::uint32_t first) const {
    std::vector<LinkedMove> moves;
    std::array<std::uint32_t, 2> ends = {none, none};
    std::uint32_t vertex = first;
    do {
        if (moves.size() == max_linked) return {};
        LinkedMove& here = moves.emplace_back();
        here.vertex = vertex;
        if (!surface_.find_ring(vertex, here.ring)) return {};
        const Ring& ring = here.ring;
        if (!ring.has_border || ring.lines != 2 || !may_move(vertex, ring)) return {};
        std::array<std::uint32_t, 2> here_ends = {
            first_at_position(ring.neighbors[0]),
            first_at_position(ring.neighbors[ring.spokes - 1])};
        std::sort(here_ends.begin(), here_ends.end());
        if (ends[0] == none) ends = here_ends;
        if (ends != here_ends || ends[0] == ends[1]) return {};
        for (std::size_t i = 0; i < ring.spokes; ++i) {
            if (first_at_position(ring.neighbors[i]) == first) return {};
        }
        vertex = next_at_position(vertex);
    } while (vertex != first);
    return moves;
}

/// Describes the moves of all vertices at a position to another one. \return false if lines forbid
/// one, or if the sheets touch there otherwise
bool Collapser::find_linked_moves(std::uint32_t position, std::span<LinkedMove> moves) const {
    for (LinkedMove& each : moves) {
        const bool is_first = first_at_position(each.ring.neighbors[0]) == position;
        if (!surface_.find_move(each.ring, is_first ? 0 : each.ring.spokes - 1, each.move))
            return false;
    }
    for (const LinkedMove& a : moves) {
        for (const LinkedMove& b : moves) {
            if (a.vertex == b.vertex) continue;
            const auto end = b.ring.neighbors.begin() + static_cast<std::ptrdiff_t>(b.ring.spokes);
            if (std::find(b.ring.neighbors.begin(), end, a.move.target) != end) return false;
        }
    }
    return true;
}

bool Collapser::is_valid(std::span<const LinkedMove> moves) const {
    return std::all_of(moves.begin(), moves.end(), [&](const LinkedMove& each) {
        return is_valid(each.vertex, each.ring, each.move);
    });
}

/// Finds the cheapest move of all vertices at a position together, like best_move(). Its cost is
/// the mean over the sheets, because each of them loses a triangle, as at a boundary.
float Collapser::best_linked_moves(std::uint32_t first, std::vector<LinkedMove>& best) const {
    std::vector<LinkedMove> moves = linked_vertices(first);
    if (moves.empty()) return no_collapse;
    const bool careful = (flags_[first] & is_careful) != 0;
    const double preference =
        input_.for_picture ? length_preference_in_pictures : length_preference;
    std::array<std::uint32_t, 2> ends = {
        first_at_position(moves[0].ring.neighbors[0]),
        first_at_position(moves[0].ring.neighbors[moves[0].ring.spokes - 1])};
    std::sort(ends.begin(), ends.end());
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t end : ends) {
        if (!find_linked_moves(end, moves)) continue;
        double sum = 0.0;
        bool is_within = true;
        for (const LinkedMove& each : moves) {
            const double error = error_->cost(each.vertex, each.move);
            const glm::dvec3 along = input_.point(each.move.target) - input_.point(each.vertex);
            const double squared_length = glm::dot(along, along);
            sum += error_->priority(error + preference * squared_length * squared_length,
                                    each.vertex, each.move);
            is_within = is_within && error_->is_within_limit(error, each.vertex, each.move) &&
                        error_->keeps_part(error, each.vertex, each.move);
        }
        const double mean = sum / static_cast<double>(moves.size());
        if (!is_within || !(mean < least) || (careful && !is_valid(moves))) continue;
        least = mean;
        best = moves;
    }
    return std::isinf(least) ? no_collapse : static_cast<float>(std::min(least, 1e30));
}

/// Like collapse_if_cheap(), for all vertices at a position.
std::size_t Collapser::collapse_linked_if_cheap(std::uint32_t first, float limit) {
    std::vector<LinkedMove> moves;
    flags_[first] &= static_cast<std::uint8_t>(~is_dirty);
    costs_[first] = best_linked_moves(first, moves);
    if (!(costs_[first] <= limit)) return 0;
    if ((flags_[first] & is_careful) == 0 && !is_valid(moves)) {
        costs_[first] = no_collapse;
        flags_[first] |= is_careful | is_dirty;
        return 0;
    }
    std::size_t removed = 0;
    for (const LinkedMove& each : moves)
        removed += collapse(each.vertex, each.ring, each.move);
    return removed;
}

float Collapser::evaluate(std::uint32_t vertex, std::size_t& examined) const {
    if ((flags_[vertex] & is_linked) != 0) {
        std::vector<LinkedMove> moves;
        const float cost = best_linked_moves(vertex, moves);
        for (const LinkedMove& each : moves)
            examined += each.ring.size;
        return cost;
    }
    Ring ring;
    const bool is_small = surface_.find_ring(vertex, ring);
    examined += ring.size;
    if (!is_small) return no_collapse;
    Move move;
    return best_move(vertex, ring, move);
}

/// Raises the cost of a collapse that moves the surface farther than the pass allows.
bool Collapser::postpone(std::uint32_t vertex, const Ring& ring, const Move& move, float limit) {
    // The distance is that of the first sample beyond the limit, so the next attempt waits.
    constexpr float delay = 1.5F;
    if (!deviation_) return false;
    const double allowed = deviation_->allowed() * deviation_->allowed();
    const double squared = deviation_->squared_distance(vertex, ring, move, allowed);
    if (!(squared > allowed)) return false;
    costs_[vertex] = std::max(delay * limit, static_cast<float>(deviation_->cost_of(squared)));
    ++postponed_;
    return true;
}

/// \return the number of triangles that it removes
std::size_t Collapser::collapse(std::uint32_t vertex, const Ring& ring, const Move& move) {
    error_->merge(vertex, move);
    if (deviation_) deviation_->merge(vertex, move);
    std::size_t removed = 0;
    for (const std::size_t side : {ring.left(move.spoke), ring.right(move.spoke)}) {
        if (side == Ring::no_triangle) continue;
        removed += input_.counts.empty() ? 1 : input_.counts[triangle_of(ring.corners[side])];
    }
    surface_.collapse(vertex, ring, move);
    for (std::size_t i = 0; i < ring.spokes; ++i)
        flags_[first_at_position(ring.neighbors[i])] |= is_dirty;
    return removed;
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
    if (!(costs_[vertex] <= limit) || postpone(vertex, ring, move, limit)) return 0;
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
        const bool is_alone = (flags_[vertex] & is_linked) == 0;
        if (is_alone && !surface_.find_ring(vertex, ring)) ring.size = 0;
        if (is_alone) examined += ring.size;
        const std::size_t removed = is_alone ? collapse_if_cheap(vertex, ring, limit)
                                             : collapse_linked_if_cheap(vertex, limit);
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
    groups_.assign(input_.positions.size(), none);
    at_border_.assign(input_.positions.size(), 0);
    for (std::size_t i = 0; i < alive_.size(); ++i)
        groups_[alive_[i]] = static_cast<std::uint32_t>(i / group_size);
    // Linked vertices are executed one after another.
    for (std::uint32_t v = 0; v < input_.next_at_position.size(); ++v)
        at_border_[v] = input_.next_at_position[v] != v ? 1 : 0;
    parallel_for(surface_.corners().size() / 3, group_size,
                 [&](std::size_t begin, std::size_t end) {
                     for (std::size_t first = 3 * begin; first < 3 * end; first += 3) {
                         if (surface_[first].vertex == none) continue;
                         const std::uint32_t group = groups_[surface_[first].vertex];
                         if (group != none && groups_[surface_[first + 1].vertex] == group &&
                             groups_[surface_[first + 2].vertex] == group)
                             continue;
                         // Other threads may write the same value.
                         for (std::size_t corner = first; corner < first + 3; ++corner)
                             relaxed_store(at_border_[surface_[corner].vertex], 1);
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
                    if (!surface_.find_ring(vertex, ring)) ring.size = ring.spokes = 0;
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
    std::erase_if(alive_, [&](std::uint32_t v) { return surface_.is_removed(v); });
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
    const std::size_t wanted =
        std::max<std::size_t>((triangles_ - target_ + 1) / (2 * max_count_), 1);
    const auto share = static_cast<std::size_t>(fraction * static_cast<double>(order.size()));
    const std::size_t count =
        std::min({order.size(), std::max(share, least), wanted + more_candidates_});
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(count - 1);
    std::nth_element(order.begin(), last, order.end());
    const std::uint64_t bound = *last;
    const auto limit = std::bit_cast<float>(static_cast<std::uint32_t>(bound >> 32));
    order.resize(count);
    if (deviation_) {
        // A vertex has the area of its triangles, and a cost that of two vertices.
        const double mean_area = 12.0 * area_ / static_cast<double>(triangles_);
        deviation_->set_limit(tolerance * limit, mean_area, is_before_fit_);
    }
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

/// Moves the remaining vertices to where they fit best.
void Collapser::fit_remaining() {
    const FittedSurface fitted{input_,  surface_,  original_positions_,
                               *error_, *normals_, deviation_};
    examined_ += fit_positions(fitted, alive_, [&](std::uint32_t vertex, const Ring& ring) {
        return may_move(vertex, ring) && (flags_[vertex] & is_linked) == 0;
    });
}

/// Continues with the planes of the present surface instead of those of the input, whose noise
/// would count at every vertex. Source: memoryless simplification [Lindstrom and Turk 1998].
void Collapser::start_anew() {
    error_->forget_planes();
    for (std::size_t t = 0; t < surface_.corners().size() / 3; ++t) {
        if (surface_[3 * t].vertex == none) continue;
        const glm::dvec3 cross = cross_of(input_, surface_, t);
        const double doubled_area = glm::length(cross);
        if (doubled_area > 0.0) error_->add_triangle(t, cross / doubled_area, doubled_area);
    }
    for (std::size_t t = 0; t < surface_.corners().size() / 3; ++t) {
        if (surface_[3 * t].vertex != none) error_->add_lines(t);
    }
    error_->spread_errors();
    compute_all_costs_anew(is_dirty);
}

/// Counts why the remaining vertices do not move.
Obstacles Collapser::obstacles() const {
    Obstacles found;
    for (std::uint32_t v = 0; v < flags_.size(); ++v) {
        if ((flags_[v] & is_locked) != 0 && !surface_.is_removed(v)) ++found.non_manifold;
    }
    Ring ring;
    for (const std::uint32_t v : alive_) {
        if ((flags_[v] & is_linked) != 0) {
            if (surface_.is_removed(v)) continue;
            ++(linked_vertices(v).empty() ? found.non_manifold : found.folds);
            continue;
        }
        if (surface_.is_removed(v) || !surface_.find_ring(v, ring)) continue;
        if (!may_move(v, ring)) {
            ++found.lines;
            continue;
        }
        bool is_beyond_limit = false;
        bool breaks_part = false;
        Move move;
        for (std::size_t spoke = 0; spoke < ring.spokes; ++spoke) {
            if (!surface_.find_move(ring, spoke, move)) continue;
            breaks_part = breaks_part || !keeps_part(v, ring, move);
            if (!is_valid(v, ring, move)) continue;
            const double error = error_->cost(v, move);
            is_beyond_limit = is_beyond_limit || !error_->is_within_limit(error, v, move);
            breaks_part = breaks_part || !error_->keeps_part(error, v, move);
        }
        ++(is_beyond_limit ? found.limits : breaks_part ? found.parts : found.folds);
    }
    return found;
}

void Collapser::compute_all_costs_anew(std::uint8_t flags) {
    for (const std::uint32_t v : alive_) {
        flags_[v] |= flags;
        costs_[v] = no_collapse;
    }
}

Collapsed Collapser::run() {
    // If a pass has no success, all vertices are checked carefully once more: what lies around
    // their neighbors may have changed. The number of such checks is limited, so that the time is
    // linear.
    constexpr std::size_t max_checks = 8;
    std::size_t checks = 0;
    bool was_checked = false;
    bool are_parts_relaxed = false;
    std::vector<std::size_t> fitted;
    if (input_.fits_positions && target_ > 0) fitted = fitted_counts(triangles_, target_);
    auto next_fit = fitted.begin();
    while (triangles_ > target_) {
        if (next_fit != fitted.end() && triangles_ <= *next_fit) {
            while (next_fit != fitted.end() && triangles_ <= *next_fit)
                ++next_fit;
            is_before_fit_ = true;
            fit_remaining();
            start_anew();
        }
        is_before_fit_ = next_fit != fitted.end();
        const std::size_t before = result_.collapses;
        const std::size_t postponed = postponed_;
        ++result_.passes;
        run_pass(was_checked ? 1.0 : pass_fraction);
        const bool has_success = result_.collapses > before;
        more_candidates_ = has_success ? 0 : more_candidates_ + postponed_ - postponed;
        // The costs of what was postponed are larger now, so the next pass has other candidates.
        if (!has_success && postponed_ > postponed) continue;
        const bool is_stuck = !has_success && (was_checked || checks == max_checks);
        if (is_stuck) {
            // Small parts keep their shape until nothing else is left.
            if (target_ == 0 || !error_ || !error_->relax_parts()) break;
            are_parts_relaxed = true;
            checks = 0;
        }
        if (has_success && are_parts_relaxed) result_.relaxed_part_error = error_->part_error();
        was_checked = !has_success;
        if (has_success) continue;
        ++checks;
        compute_all_costs_anew(is_dirty | is_careful);
    }
    if (triangles_ > target_ && target_ > 0) result_.obstacles = obstacles();
    if (input_.fits_positions && error_) {
        fit_remaining();
        for (const CornerData& corner : surface_.corners()) {
            if (corner.vertex == none) continue;
            const glm::vec3& position = input_.positions[corner.vertex];
            if (position != original_positions_[corner.vertex])
                result_.moved.emplace_back(corner.wedge, position);
        }
    }
    result_.triangles = triangles_;
    result_.examined = examined_;
    result_.remaining.reserve(triangles_ / max_count_);
    result_.wedges.reserve(triangles_ / max_count_);
    for (Corner first = 0; first < surface_.corners().size(); first += 3) {
        if (surface_[first].vertex == none) continue;
        result_.remaining.push_back(first / 3);
        result_.wedges.emplace_back(surface_[first].wedge, surface_[first + 1].wedge,
                                    surface_[first + 2].wedge);
    }
    return std::move(result_);
}

}  // namespace

Collapsed collapse_edges(CollapseInput input) {
    return Collapser(std::move(input)).run();
}

}  // namespace relief::detail
