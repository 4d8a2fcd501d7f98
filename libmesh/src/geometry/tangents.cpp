// SPDX-License-Identifier: Apache-2.0
// MikkTSpace tangents, written from the method's description [Mikkelsen 2008] and the contract of
// its header. Object space, unit vectors; computed in double precision and rounded to float once.
//
// Vertices with equal position, normal and texture coordinate are one. Around each, triangles that
// follow each other across edges and have the same texture orientation form a group
// (tangent_groups.h). Their tangents are averaged with the angle of the corner as weight, seen
// along the normal. Comments mark each place where this deviates from the reference implementation
// because the reference gives no usable or no stable result.
//
// Corners whose group has no tangent (degenerate, non-finite and isolated triangles) take one from
// their vertex. The candidates of each vertex are collected first, from finished corners only, and
// the open corners are filled afterwards, so the order of triangles does not matter. (The reference
// implementation takes the first triangle of the list, and (1,0,0) if the vertex has none.) Every
// fallback is counted.
#include "relief/mesh/tangents.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "geometry/check_triangles.h"
#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/tangent_contributions.h"
#include "geometry/tangent_groups.h"
#include "geometry/tangent_signs.h"
#include "geometry/vertex_tangents.h"
#include "geometry/weld.h"
#include "large_memory.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/report.h"
#include "work_array.h"

namespace relief {
using namespace relief::detail;

namespace {

using Offer = std::optional<glm::vec3>;

/// Candidate tangents of a vertex for its open corners: one for each w, +1 and -1.
using VertexOffers = std::array<Offer, 2>;

std::size_t slot_of(float sign) {
    return sign > 0.0F ? 0 : 1;
}

template <glm::length_t size>
bool comes_first(const glm::vec<size, float>& a, const glm::vec<size, float>& b) {
    return std::lexicographical_compare(&a[0], &a[0] + size, &b[0], &b[0] + size);
}

/// Returns the most frequent value, if there is one; ties: the first by value. Sorts the values.
template <glm::length_t size>
std::optional<glm::vec<size, float>> most_frequent(std::vector<glm::vec<size, float>>& values) {
    std::sort(values.begin(), values.end(), comes_first<size>);
    std::optional<glm::vec<size, float>> best;
    std::ptrdiff_t most = 0;
    for (auto first = values.begin(); first != values.end();) {
        const auto last = std::upper_bound(first, values.end(), *first, comes_first<size>);
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

/// Candidates of all vertices that have an open corner.
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

/// The w that is available at more corners of a triangle without a sign.
float majority_sign(std::uint32_t triangle, const GroupInput& input, const Offers& offers) {
    std::array<int, 2> contributions{};
    for (int i = 0; i < 3; ++i) {
        const VertexOffers& offer = offers.at(input.mesh.triangles[triangle][i]);
        for (std::size_t slot = 0; slot < 2; ++slot)
            contributions[slot] += offer[slot] ? 1 : 0;
    }
    return contributions[0] > 0 && contributions[0] >= contributions[1] ? 1.0F : -1.0F;
}

void copy_twin(const GroupFindings::Repeated& repeated, TriangleSpan triangles,
               std::span<glm::vec4> tangents) {
    const Corner first = 3 * repeated.triangle;
    for (Corner corner = first; corner < first + 3; ++corner) {
        Corner same = 3 * repeated.twin;
        while (vertex_of(same, triangles) != vertex_of(corner, triangles))
            ++same;
        tangents[corner] = tangents[same];
    }
}

/// Corners without a tangent, except those of duplicate triangles.
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

/// Assigns a tangent to every corner that has none. All corners of a triangle share w.
///
/// A corner takes the most frequent tangent of its welded vertex (ties: the first by value), among
/// those with its triangle's w if there are any. If the vertex has none, the tangent is the x axis,
/// or the y axis if the normal is near the x axis, projected onto the plane of the normal. A
/// triangle without a sign (tangent_signs.h) takes the w that is available at more of its corners,
/// +1 before -1, and -1 if there is none, like the reference implementation. A duplicate triangle
/// copies its twin.
///
/// \return the corners whose vertex had no tangent, ascending
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
                                                      : majority_sign(triangle, input, offers);
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

void check(const TangentInput& input) {
    const std::size_t positions = input.positions.size();
    const std::size_t normals = input.normals.size();
    const std::size_t texcoords = input.texcoords.size();
    if (normals != positions) {
        throw InvalidInput(
            fmt::format("there are {} normals, but {} positions", normals, positions));
    }
    if (texcoords != positions) {
        throw InvalidInput(fmt::format("there are {} texture coordinates, but {} positions",
                                       texcoords, positions));
    }
    check_triangles(input.triangles, positions);
}

void report_normals(StridedSpan<const glm::vec3> normals, Report& report) {
    parallel_for_reporting(normals.size(), 16384, report,
                           [&](std::size_t begin, std::size_t end, Report& found) {
                               for (std::size_t v = begin; v < end; ++v) {
                                   if (!is_finite(normals[v]) || normals[v] == glm::vec3(0.0F)) {
                                       found.add("normal without direction", "vertex", v,
                                                 "its tangents depend only on the texture");
                                   }
                               }
                           });
}

/// The numbers of triangles and corners in the mesh if only some of its triangles are computed.
class MeshNumbers {
  public:
    MeshNumbers() = default;
    /// \param triangles  ascending; empty: all
    explicit MeshNumbers(std::span<const std::uint32_t> triangles) : triangles_(triangles) {}
    [[nodiscard]] std::uint32_t triangle(std::uint32_t index) const {
        return triangles_.empty() ? index : triangles_[index];
    }
    [[nodiscard]] Corner corner(Corner index) const {
        return 3 * triangle(triangle_of(index)) + index % 3;
    }

  private:
    std::span<const std::uint32_t> triangles_;
};

void report_triangles(const TriangleGradients& gradients, const MeshNumbers& numbers,
                      Report& report) {
    for (const std::uint32_t index : gradients.without) {
        const std::uint32_t triangle = numbers.triangle(index);
        switch (gradients.kinds[index]) {
            case Gradient::upright:
            case Gradient::mirrored:
                break;
            case Gradient::none:
                report.add("triangle without texture gradient", "triangle", triangle,
                           "gets the tangents of its neighbors");
                break;
            case Gradient::coinciding:
                report.add("triangle with coinciding corners", "triangle", triangle,
                           "gets the tangents of other triangles at its vertices");
                break;
            case Gradient::non_finite:
                report.add("triangle with non-finite values", "triangle", triangle,
                           "gets the tangents of other triangles at its vertices");
                break;
        }
    }
}

void report_groups(const GroupFindings& findings, const MeshNumbers& numbers, Report& report) {
    for (const GroupFindings::Repeated& repeated : findings.repeated) {
        report.add("repeated triangle", "triangle", numbers.triangle(repeated.triangle),
                   "counts once and gets the same tangents");
    }
    for (const Corner corner : findings.along_normal) {
        report.add("texture direction along the normal", "corner", numbers.corner(corner),
                   "gets the tangent of other corners at its vertex");
    }
    for (const Corner corner : findings.cancelled) {
        report.add("cancelling tangents", "corner", numbers.corner(corner),
                   "keeps the tangent of its triangle");
    }
}

/// Triangles with indices of welded vertices. Copies nothing if all vertices differ.
class WeldedTriangles {
  public:
    explicit WeldedTriangles(const TangentInput& input) : triangles_(input.triangles) {
        const std::vector<std::uint32_t> first =
            weld_vertices(input.positions, input.normals, input.texcoords);
        std::uint32_t vertex = 0;
        if (std::all_of(first.begin(), first.end(),
                        [&](std::uint32_t index) { return index == vertex++; }))
            return;
        welded_ = WorkArray<glm::uvec3>(input.triangles.size());
        weld_triangles(input.triangles, first, welded_);
        triangles_ = welded_;
    }
    [[nodiscard]] TriangleSpan get() const { return triangles_; }
    /// Returns whether all vertices differ.
    [[nodiscard]] bool is_unchanged() const { return welded_.size() == 0; }

  private:
    WorkArray<glm::uvec3> welded_;
    TriangleSpan triangles_;
};

/// \param input  triangles with indices of welded vertices; all triangles at vertices without a
///               usual tangent, at least
/// \param tangents  three per triangle
void compute_welded_tangents(const TangentInput& input, TangentWeight weight, TangentGroups groups,
                             const MeshNumbers& numbers, std::span<glm::vec4> tangents,
                             ProgressStage& stage, Report& report) {
    const TriangleGradients gradients = compute_contributions(input, weight, tangents);
    stage.advance(1);
    const CornersByVertex corners(input.positions.size(), input.triangles,
                                  [&](std::size_t t) { return takes_part(gradients.kinds[t]); });
    stage.advance(1);
    const TriangleSigns signs = triangle_signs(input, corners, gradients);
    stage.advance(1);
    const GroupInput group_input{input, corners, gradients, signs, groups};
    const GroupFindings findings = average_groups(group_input, tangents);
    stage.advance(1);

    report_normals(input.normals, report);
    report_triangles(gradients, numbers, report);
    report_groups(findings, numbers, report);
    for (const Corner corner : fill_open_corners(group_input, findings, tangents)) {
        report.add("corner without texture direction", "corner", numbers.corner(corner),
                   "gets a fixed tangent perpendicular to its normal");
    }
}

/// \param tangents  three per triangle
void compute_tangents(TangentInput input, TangentWeight weight, TangentGroups groups,
                      std::span<glm::vec4> tangents, Report& report) {
    ProgressStage stage("tangents", 6);
    check(input);
    const WeldedTriangles welded(input);
    input.triangles = welded.get();
    stage.advance(1);
    compute_welded_tangents(input, weight, groups, MeshNumbers(), tangents, stage, report);
}

std::vector<glm::vec4> tangents_of(const TangentInput& input, TangentWeight weight,
                                   TangentGroups groups, Report& report) {
    std::vector<glm::vec4> tangents;
    reserve_to_fill(tangents, 3 * input.triangles.size());
    tangents.resize(3 * input.triangles.size());
    compute_tangents(input, weight, groups, tangents, report);
    return tangents;
}

/// Writes the tangent of a vertex's first corner, and w = 0 for vertices without a triangle.
/// \return the vertices with corners that differ, ascending
std::vector<std::uint32_t> write_first_tangents(std::span<const glm::vec4> of_corners,
                                                TriangleSpan triangles,
                                                StridedSpan<glm::vec4> tangents) {
    for (std::size_t v = 0; v < tangents.size(); ++v)
        tangents[v] = glm::vec4(0.0F);
    std::vector<std::uint32_t> differing;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const glm::uvec3 triangle = triangles[t];
        for (int i = 0; i < 3; ++i) {
            const glm::vec4& tangent = of_corners[3 * t + static_cast<std::size_t>(i)];
            glm::vec4& result = tangents[triangle[i]];
            if (result.w == 0.0F)
                result = tangent;
            else if (result != tangent)
                differing.push_back(triangle[i]);
        }
    }
    std::sort(differing.begin(), differing.end());
    differing.erase(std::unique(differing.begin(), differing.end()), differing.end());
    return differing;
}

/// Writes the most frequent tangent of the corners at each listed vertex; ties: the first by value.
void settle_differing(std::span<const glm::vec4> of_corners, TriangleSpan triangles,
                      std::span<const std::uint32_t> differing, StridedSpan<glm::vec4> tangents,
                      Report& report) {
    if (differing.empty()) return;
    const CornersByVertex corners(tangents.size(), triangles);
    std::vector<glm::vec4> values;
    for (const std::uint32_t vertex : differing) {
        values.clear();
        for (const Corner corner : corners.at(vertex))
            values.push_back(of_corners[corner]);
        if (const auto value = most_frequent(values)) tangents[vertex] = *value;
        report.add("vertex whose corners have different tangents", "vertex", vertex,
                   "gets the tangent of most of its corners (split it to keep all)");
    }
}

/// Computes the tangents of the corners of all triangles.
VertexTangents at_all_corners(const TangentInput& input, ProgressStage& stage, Report& report) {
    VertexTangents tangents{{}, {}, WorkArray<glm::vec4>(3 * input.triangles.size())};
    compute_welded_tangents(input, TangentWeight::angle, TangentGroups::connected, MeshNumbers(),
                            tangents.at_corners, stage, report);
    return tangents;
}

/// Computes the tangents of the corners of triangles at vertices that are not usual.
VertexTangents at_unusual_vertices(TangentInput input, UsualTangents usual, ProgressStage& stage,
                                   Report& report) {
    VertexTangents tangents{std::move(usual.by_vertex), {}, {}};
    if (!usual.any_unusual) {
        report_normals(input.normals, report);
        return tangents;
    }
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t t = 0; t < input.triangles.size(); ++t) {
        const glm::uvec3 triangle = input.triangles[t];
        if ((usual.is_unusual[triangle.x] | usual.is_unusual[triangle.y] |
             usual.is_unusual[triangle.z]) == 0)
            continue;
        triangles.push_back(triangle);
        tangents.triangles.push_back(t);
    }
    input.triangles = triangles;
    tangents.at_corners = WorkArray<glm::vec4>(3 * triangles.size());
    compute_welded_tangents(input, TangentWeight::angle, TangentGroups::connected,
                            MeshNumbers(tangents.triangles), tangents.at_corners, stage, report);
    for (Corner corner = 0; corner < 3 * triangles.size(); ++corner) {
        const std::uint32_t vertex = vertex_of(corner, input.triangles);
        if (usual.is_unusual[vertex] == 0) tangents.at_corners[corner] = tangents.by_vertex[vertex];
    }
    return tangents;
}

}  // namespace

namespace detail {

VertexTangents tangents_by_vertex(const TangentInput& input, Report& report) {
    ProgressStage stage("tangents", 6);
    check(input);
    const WeldedTriangles welded(input);
    stage.advance(1);
    TangentInput mesh = input;
    mesh.triangles = welded.get();
    if (!welded.is_unchanged()) return at_all_corners(mesh, stage, report);
    UsualTangents usual;
    {
        const CornersByVertex corners(mesh.positions.size(), mesh.triangles);
        if (has_local_triangles(corners, mesh.triangles.size()))
            usual = usual_tangents(mesh, corners);
    }
    if (usual.by_vertex.empty()) return at_all_corners(mesh, stage, report);
    return at_unusual_vertices(mesh, std::move(usual), stage, report);
}

}  // namespace detail

std::vector<glm::vec4> mikktspace_tangents(StridedSpan<const glm::vec3> positions,
                                           StridedSpan<const glm::vec3> normals,
                                           StridedSpan<const glm::vec2> texcoords,
                                           TriangleSpan triangles, Report& report) {
    return tangents_of({positions, normals, texcoords, triangles}, TangentWeight::angle,
                       TangentGroups::connected, report);
}

void corner_tangents(StridedSpan<const glm::vec3> positions, StridedSpan<const glm::vec3> normals,
                     StridedSpan<const glm::vec2> texcoords, TriangleSpan triangles,
                     std::span<glm::vec4> tangents, Report& report,
                     const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    if (tangents.size() != 3 * triangles.size()) {
        throw InvalidInput(fmt::format("there is memory for {} tangents, but there are {} corners",
                                       tangents.size(), 3 * triangles.size()));
    }
    compute_tangents({positions, normals, texcoords, triangles}, TangentWeight::angle,
                     TangentGroups::connected, tangents, report);
}

void vertex_tangents(StridedSpan<const glm::vec3> positions, StridedSpan<const glm::vec3> normals,
                     StridedSpan<const glm::vec2> texcoords, TriangleSpan triangles,
                     StridedSpan<glm::vec4> tangents, Report& report,
                     const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    if (tangents.size() != positions.size()) {
        throw InvalidInput(
            fmt::format("there is memory for {} tangents, but there are {} positions",
                        tangents.size(), positions.size()));
    }
    WorkArray<glm::vec4> of_corners(3 * triangles.size());
    compute_tangents({positions, normals, texcoords, triangles}, TangentWeight::angle,
                     TangentGroups::connected, of_corners, report);
    const std::vector<std::uint32_t> differing =
        write_first_tangents(of_corners, triangles, tangents);
    settle_differing(of_corners, triangles, differing, tangents, report);
    for (std::size_t v = 0; v < tangents.size(); ++v) {
        if (tangents[v].w != 0.0F) continue;
        tangents[v] = glm::vec4(perpendicular_to(normals[v]), -1.0F);
        report.add("isolated vertex", "vertex", v,
                   "gets a fixed tangent perpendicular to its normal");
    }
}

std::vector<glm::vec4> area_weighted_tangents(StridedSpan<const glm::vec3> positions,
                                              StridedSpan<const glm::vec3> normals,
                                              StridedSpan<const glm::vec2> texcoords,
                                              TriangleSpan triangles, Report& report) {
    return tangents_of({positions, normals, texcoords, triangles}, TangentWeight::area,
                       TangentGroups::connected, report);
}

std::vector<glm::vec4> lengyel_tangents(StridedSpan<const glm::vec3> positions,
                                        StridedSpan<const glm::vec3> normals,
                                        StridedSpan<const glm::vec2> texcoords,
                                        TriangleSpan triangles, Report& report) {
    return tangents_of({positions, normals, texcoords, triangles}, TangentWeight::stretch,
                       TangentGroups::all, report);
}

}  // namespace relief
