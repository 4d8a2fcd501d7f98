// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/topology/decimate_layers_test.cpp.
#include "topology/triangle_layers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#include "geometry/direction.h"
#include "geometry/triangle_stacks.h"
#include "geometry/weld.h"

namespace relief::detail {
namespace {

/// A triangle of the order that is not collapsed or set aside.
struct Member {
    std::uint32_t stack = 0;   ///< The smallest triangle at its positions.
    std::uint32_t place = 0;   ///< Index in the order.
    bool is_opposite = false;  ///< To the first member of the stack.
};

/// Selects a winding for each stack: that of the neighbors if the stack has both.
class Windings {
  public:
    /// \param stacks  for each stack, its positions with the winding of its first member
    /// \param has_both  for each stack, whether it can be turned
    Windings(std::span<const glm::uvec3> stacks, const std::vector<bool>& has_both)
        : stacks_(stacks),
          has_both_(has_both),
          is_turned_(stacks.size(), false),
          is_chosen_(stacks.size(), false) {
        for (std::uint32_t corner = 0; corner < 3 * stacks.size(); ++corner) {
            const std::uint32_t a = vertex_of(corner, stacks);
            const std::uint32_t b = vertex_of(next_in_triangle(corner), stacks);
            edges_.push_back({std::min(a, b), std::max(a, b), corner});
        }
        std::sort(edges_.begin(), edges_.end());
        neighbor_.assign(3 * stacks.size(), no_corner);
        for (std::size_t first = 0, end = 0; first < edges_.size(); first = end) {
            while (end < edges_.size() && edges_[end][0] == edges_[first][0] &&
                   edges_[end][1] == edges_[first][1])
                ++end;
            if (end - first != 2) continue;
            neighbor_[edges_[first][2]] = edges_[first + 1][2];
            neighbor_[edges_[first + 1][2]] = edges_[first][2];
        }
    }

    /// \return by stack: whether its front is opposite to its first member
    std::vector<bool> choose() {
        for (std::uint32_t s = 0; s < stacks_.size(); ++s) {
            if (!has_both_[s]) add(s);
        }
        spread();
        for (std::uint32_t s = 0; s < stacks_.size(); ++s) {
            if (is_chosen_[s]) continue;
            add(s);
            spread();
        }
        return std::move(is_turned_);
    }

  private:
    void add(std::uint32_t stack) {
        is_chosen_[stack] = true;
        queue_.push_back(stack);
    }
    void spread() {
        for (; next_ < queue_.size(); ++next_) {
            const std::uint32_t stack = queue_[next_];
            for (Corner corner = 3 * stack; corner < 3 * stack + 3; ++corner) {
                const Corner beyond = neighbor_[corner];
                if (beyond == no_corner || is_chosen_[triangle_of(beyond)]) continue;
                const bool is_same_direction =
                    vertex_of(corner, stacks_) == vertex_of(beyond, stacks_);
                is_turned_[triangle_of(beyond)] = is_turned_[stack] != is_same_direction;
                add(triangle_of(beyond));
            }
        }
    }

    std::span<const glm::uvec3> stacks_;
    const std::vector<bool>& has_both_;
    std::vector<bool> is_turned_;
    std::vector<bool> is_chosen_;
    std::vector<std::array<std::uint32_t, 3>> edges_;  ///< Two vertices, and a corner.
    std::vector<Corner> neighbor_;
    std::vector<std::uint32_t> queue_;
    std::size_t next_ = 0;
};

}  // namespace

std::span<const Layer> layers_of(const TriangleLayers& layers, std::uint32_t front) {
    const auto [first, last] =
        std::equal_range(layers.begin(), layers.end(), Layer{front, {}, 0},
                         [](const Layer& a, const Layer& b) { return a.front < b.front; });
    return {first, last};
}

TriangleLayers separate_layers(
    const Mesh& mesh, std::span<const std::uint32_t> classes,
    const std::function<std::uint32_t(std::uint32_t triangle)>& part_of,
    const std::function<std::uint32_t(std::uint32_t vertex, std::uint32_t part)>& wedge_of,
    std::vector<Corner>& order, Report& report) {
    const std::vector<std::uint32_t> stacks = triangle_stacks(mesh.triangles, classes);
    if (stacks.empty()) return {};
    const auto welded = [&](Corner first) {
        const glm::uvec3 t = triangle_from(first, mesh.triangles);
        return glm::uvec3(classes[t.x], classes[t.y], classes[t.z]);
    };
    const auto is_on_surface = [&](const glm::uvec3& t) {
        return t.x != t.y && t.y != t.z && t.z != t.x && is_finite(mesh.positions[t.x]) &&
               is_finite(mesh.positions[t.y]) && is_finite(mesh.positions[t.z]);
    };
    std::vector<Member> members;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        if (is_on_surface(welded(order[i]))) members.push_back({stacks[triangle_of(order[i])], i});
    }
    std::sort(members.begin(), members.end(), [](const Member& a, const Member& b) {
        return std::tuple(a.stack, a.place) < std::tuple(b.stack, b.place);
    });
    // Stacks in the order of their first members, whose numbers do not depend on those of
    // triangles.
    struct Stack {
        std::size_t begin = 0;
        std::size_t end = 0;
        bool has_both = false;
    };
    std::vector<Stack> all;
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (i == 0 || members[i].stack != members[i - 1].stack) all.push_back({i, i, false});
        Stack& stack = all.back();
        stack.end = i + 1;
        members[i].is_opposite = are_opposite(welded(order[members[i].place]),
                                              welded(order[members[stack.begin].place]));
        stack.has_both = stack.has_both || members[i].is_opposite;
    }
    std::sort(all.begin(), all.end(), [&](const Stack& a, const Stack& b) {
        return members[a.begin].place < members[b.begin].place;
    });
    std::vector<glm::uvec3> firsts;
    std::vector<bool> has_both;
    for (const Stack& stack : all) {
        firsts.push_back(welded(order[members[stack.begin].place]));
        has_both.push_back(stack.has_both);
    }
    const std::vector<bool> is_turned = Windings(firsts, has_both).choose();

    TriangleLayers layers;
    std::vector<bool> is_removed(order.size(), false);
    std::vector<Corner> fronts = order;
    for (std::size_t s = 0; s < all.size(); ++s) {
        if (all[s].end - all[s].begin == 1) continue;
        std::vector<Member> stack(members.begin() + static_cast<std::ptrdiff_t>(all[s].begin),
                                  members.begin() + static_cast<std::ptrdiff_t>(all[s].end));
        const auto key_of = [&](const Member& member) {
            return LayerKey{member.is_opposite != is_turned[s],
                            part_of(triangle_of(order[member.place]))};
        };
        std::stable_sort(stack.begin(), stack.end(),
                         [&](const Member& a, const Member& b) { return key_of(a) < key_of(b); });
        const auto wedges_of = [&](const Member& member) {
            const std::uint32_t part = key_of(member).part;
            std::array<std::uint32_t, 3> wedges{};
            const glm::uvec3 triangle = triangle_from(order[member.place], mesh.triangles);
            for (int i = 0; i < 3; ++i)
                wedges[static_cast<std::size_t>(i)] = wedge_of(triangle[i], part);
            std::sort(wedges.begin(), wedges.end());
            return wedges;
        };
        // The tangents of a triangle depend on its first corner. Therefore, of the repeated
        // triangles of the first smoothing group, the one with the first corner in front stays.
        const auto preference = [&](const Member& member) {
            const Corner first = order[member.place];
            return std::pair(
                mesh.smoothing_groups.empty() ? 0U : mesh.smoothing_groups[triangle_of(first)],
                first % 3);
        };
        for (std::size_t begin = 0, end = 0; begin < stack.size(); begin = end) {
            while (end < stack.size() && key_of(stack[end]) == key_of(stack[begin]) &&
                   wedges_of(stack[end]) == wedges_of(stack[begin]))
                ++end;
            std::stable_sort(
                stack.begin() + static_cast<std::ptrdiff_t>(begin),
                stack.begin() + static_cast<std::ptrdiff_t>(end),
                [&](const Member& a, const Member& b) { return preference(a) < preference(b); });
        }
        const std::uint32_t front = triangle_of(order[stack[0].place]);
        TriangleLayers here;
        for (std::size_t i = 0; i < stack.size(); ++i) {
            const Member& member = stack[i];
            const std::uint32_t triangle = triangle_of(order[member.place]);
            if (i > 0 && key_of(member) == key_of(stack[i - 1])) {
                if (wedges_of(member) != wedges_of(stack[i - 1])) continue;
                report.add("repeated triangle", "triangle", triangle, "is left out");
            } else {
                here.push_back({front, key_of(member), triangle});
            }
            is_removed[member.place] = true;
        }
        // The front takes the place of the first member.
        const std::uint32_t place = members[all[s].begin].place;
        fronts[place] = order[stack[0].place];
        is_removed[place] = false;
        if (all[s].has_both)
            report.add("double-sided triangle", "triangle", front,
                       "is reduced together with its other side");
        if (here.size() > 1) layers.insert(layers.end(), here.begin(), here.end());
    }
    order.clear();
    for (std::size_t i = 0; i < fronts.size(); ++i) {
        if (!is_removed[i]) order.push_back(fronts[i]);
    }
    std::sort(layers.begin(), layers.end());
    return layers;
}

}  // namespace relief::detail
