// SPDX-License-Identifier: Apache-2.0
// First it is found out what each vertex concerned can offer, from settled corners only; then the
// open corners are filled. So the order of triangles plays no part, which it does in the reference
// implementation: that takes the first triangle of the list, and leaves (1,0,0) where the vertex
// has none, whatever the normal. Tests: tests/mesh/geometry/tangents/tangents_test.cpp.
#include "geometry/tangents/tangent_fill.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <tuple>

#include "geometry/direction.h"

namespace relief {
namespace {

using Offer = std::optional<glm::vec3>;

/// What a vertex offers to its open corners: a tangent for each w, +1 and -1.
using VertexOffers = std::array<Offer, 2>;

std::size_t slot_of(float sign) {
    return sign > 0.0F ? 0 : 1;
}

bool offer_comes_before(const glm::vec3& a, const glm::vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// The most frequent value, and the first of those.
Offer most_frequent(std::vector<glm::vec3>& values) {
    std::sort(values.begin(), values.end(), offer_comes_before);
    Offer best;
    std::ptrdiff_t most = 0;
    for (auto first = values.begin(); first != values.end();) {
        const auto last = std::upper_bound(first, values.end(), *first, offer_comes_before);
        if (last - first > most) {
            most = last - first;
            best = *first;
        }
        first = last;
    }
    return best;
}

VertexOffers offers_at(std::span<const Corner> around, std::span<const glm::vec4> tangents) {
    std::array<std::vector<glm::vec3>, 2> found;
    for (const Corner corner : around) {
        const glm::vec4& tangent = tangents[corner];
        if (tangent.w != 0.0F) found[slot_of(tangent.w)].emplace_back(tangent);
    }
    return {most_frequent(found[0]), most_frequent(found[1])};
}

/// The offers of all vertices that have an open corner.
class Offers {
  public:
    Offers(const GroupInput& input, std::span<const Corner> open,
           std::span<const glm::vec4> tangents)
        : slots_(input.corners.vertex_count(), none) {
        for (const Corner corner : open) {
            std::uint32_t& slot = slots_[vertex_of(corner, input.mesh.triangles)];
            if (slot != none) continue;
            slot = static_cast<std::uint32_t>(offers_.size());
            offers_.push_back(
                offers_at(input.corners.at(vertex_of(corner, input.mesh.triangles)), tangents));
        }
    }

    [[nodiscard]] const VertexOffers& at(std::uint32_t vertex) const {
        return offers_[slots_[vertex]];
    }

  private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> slots_;
    std::vector<VertexOffers> offers_;
};

/// The w that can be had at more corners of a triangle without one.
float voted_sign(std::uint32_t triangle, const GroupInput& input, const Offers& offers) {
    std::array<int, 2> votes{};
    for (int i = 0; i < 3; ++i) {
        const VertexOffers& offer = offers.at(input.mesh.triangles[triangle][i]);
        for (std::size_t slot = 0; slot < 2; ++slot)
            votes[slot] += offer[slot] ? 1 : 0;
    }
    return votes[0] > 0 && votes[0] >= votes[1] ? 1.0F : -1.0F;
}

void copy_twin(const GroupFindings::Repeated& repeated, std::span<const glm::uvec3> triangles,
               std::span<glm::vec4> tangents) {
    const Corner first = 3 * repeated.triangle;
    for (Corner corner = first; corner < first + 3; ++corner) {
        Corner same = 3 * repeated.twin;
        while (vertex_of(same, triangles) != vertex_of(corner, triangles))
            ++same;
        tangents[corner] = tangents[same];
    }
}

/// The corners without a tangent, but for those of repeated triangles.
std::vector<Corner> open_corners(const GroupInput& input, const GroupFindings& findings,
                                 std::span<const glm::vec4> tangents) {
    std::vector<Corner> open;
    auto next = findings.repeated.begin();
    const auto look_at = [&](std::uint32_t triangle) {
        while (next != findings.repeated.end() && next->triangle < triangle)
            ++next;
        if (next != findings.repeated.end() && next->triangle == triangle) return;
        for (Corner corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
            if (tangents[corner].w == 0.0F) open.push_back(corner);
        }
    };
    if (findings.all_settled) {
        for (const std::uint32_t triangle : input.gradients.without)
            look_at(triangle);
    } else {
        for (std::uint32_t triangle = 0; triangle < input.mesh.triangles.size(); ++triangle)
            look_at(triangle);
    }
    return open;
}

}  // namespace

std::vector<Corner> fill_open_corners(const GroupInput& input, const GroupFindings& findings,
                                      std::span<glm::vec4> tangents) {
    const std::vector<Corner> open = open_corners(input, findings, tangents);
    if (open.empty() && findings.repeated.empty()) return {};
    const Offers offers(input, open, tangents);
    std::vector<Corner> invented;
    for (const Corner corner : open) {
        const std::uint32_t triangle = triangle_of(corner);
        const std::uint32_t vertex = vertex_of(corner, input.mesh.triangles);
        const float sign = input.signs[triangle] != 0 ? static_cast<float>(input.signs[triangle])
                                                      : voted_sign(triangle, input, offers);
        const VertexOffers& offer = offers.at(vertex);
        const Offer& found = offer[slot_of(sign)] ? offer[slot_of(sign)] : offer[slot_of(-sign)];
        if (!found) invented.push_back(corner);
        tangents[corner] =
            glm::vec4(found ? *found : perpendicular_to(input.mesh.normals[vertex]), sign);
    }
    for (const GroupFindings::Repeated& repeated : findings.repeated)
        copy_twin(repeated, input.mesh.triangles, tangents);
    return invented;
}

}  // namespace relief
