// SPDX-License-Identifier: Apache-2.0
#include "atlas/stack.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "atlas/atlas_stats.h"
#include "atlas/existing_charts.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The largest difference of lengths in equal parts, relative to the longest edge: six digits in a
/// text file have such errors.
constexpr double length_tolerance = 1e-4;
/// A part is compared with at most so many others, so that the time stays linear.
constexpr std::size_t max_candidates = 8;
/// The number of faces that a comparison may visit, relative to the faces of the part.
constexpr std::size_t max_visits = 32;

struct SurfacePart {
    std::vector<std::uint32_t> faces;
    double area = 0.0;
    double longest = 0.0;  ///< Edge.
    Corner start = 0;      ///< The first corner of a longest edge.
};

class PartComparison {
  public:
    PartComparison(const AtlasSurface& surface, std::span<const std::uint32_t> kind)
        : surface_(surface),
          kind_(kind),
          length_(surface.opposite.size()),
          partner_(surface.faces.size(), no_corner),
          is_taken_(surface.faces.size(), 0) {
        for (Corner corner = 0; corner < length_.size(); ++corner)
            length_[corner] = surface.edge_length(corner);
    }

    [[nodiscard]] SurfacePart part(std::vector<std::uint32_t> faces) const {
        SurfacePart part;
        for (const std::uint32_t face : faces) {
            part.area += surface_.areas[face];
            for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner) {
                if (length_[corner] <= part.longest) continue;
                part.longest = length_[corner];
                part.start = corner;
            }
        }
        part.faces = std::move(faces);
        return part;
    }

    /// Compares a part with an earlier one.
    /// \return for each face of `part`, the corner of `first` that is equal to its corner 0; empty
    ///         if the parts differ
    std::vector<Corner> corners_in(const SurfacePart& first, const SurfacePart& part) {
        tolerance_ = length_tolerance * first.longest;
        std::size_t visits = max_visits * part.faces.size();
        for (const std::uint32_t face : part.faces) {
            for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner) {
                if (!are_equal_triangles(first.start, corner)) continue;
                if (visits == 0) return {};
                const bool is_equal = match(first.start, corner, visits);
                std::vector<Corner> result;
                if (is_equal && visited_.size() == part.faces.size())
                    for (const std::uint32_t each : part.faces)
                        result.push_back(partner_[each]);
                for (const std::uint32_t each : visited_) {
                    is_taken_[partner_[each] / 3] = 0;
                    partner_[each] = no_corner;
                }
                visited_.clear();
                if (!result.empty()) return result;
            }
        }
        return {};
    }

  private:
    [[nodiscard]] bool is_near(double a, double b) const { return std::abs(a - b) <= tolerance_; }

    [[nodiscard]] bool are_equal_triangles(Corner a, Corner b) const {
        for (int k = 0; k < 3; ++k) {
            if (!is_near(length_[a], length_[b])) return false;
            a = next_in_triangle(a);
            b = next_in_triangle(b);
        }
        return kind_[a / 3] == kind_[b / 3];
    }

    /// The height of the neighbor's third vertex above the face, positive in a fold.
    [[nodiscard]] double height(Corner edge) const {
        const Corner apex = previous_in_triangle(surface_.opposite[edge]);
        return glm::dot(surface_.normal(edge / 3),
                        surface_.position(apex) - surface_.position(edge));
    }

    bool is_joined(Corner edge) const { return surface_.opposite[edge] != no_corner; }

    /// Notes that corner `b` is equal to corner `a`. \return false if that contradicts what is
    /// known
    bool pair(Corner a, Corner b) {
        // The corner that is equal to corner 0 of the face of b.
        for (; b % 3 != 0; b = previous_in_triangle(b))
            a = previous_in_triangle(a);
        if (partner_[b / 3] != no_corner) return partner_[b / 3] == a;
        if (is_taken_[a / 3] != 0 || !are_equal_triangles(a, b)) return false;
        is_taken_[a / 3] = 1;
        partner_[b / 3] = a;
        visited_.push_back(b / 3);
        return true;
    }

    /// Follows both parts from two corners.
    bool match(Corner a, Corner b, std::size_t& visits) {
        if (!pair(a, b)) return false;
        for (std::size_t i = 0; i < visited_.size(); ++i) {
            if (visits == 0) return false;
            --visits;
            Corner edge = 3 * visited_[i];
            Corner other = partner_[visited_[i]];
            for (int k = 0; k < 3; ++k) {
                if (is_joined(edge) != is_joined(other)) return false;
                if (is_joined(edge) && (!is_near(height(edge), height(other)) ||
                                        !pair(surface_.opposite[other], surface_.opposite[edge])))
                    return false;
                edge = next_in_triangle(edge);
                other = next_in_triangle(other);
            }
        }
        return true;
    }

    const AtlasSurface& surface_;
    std::span<const std::uint32_t> kind_;
    std::vector<double> length_;   ///< Of each edge.
    std::vector<Corner> partner_;  ///< For each face, the corner that is equal to its corner 0.
    std::vector<std::uint8_t> is_taken_;
    std::vector<std::uint32_t> visited_;
    double tolerance_ = 0.0;
};

}  // namespace

EqualParts equal_parts(const AtlasSurface& surface, std::span<const std::uint32_t> kind) {
    EqualParts result;
    result.source.resize(surface.opposite.size());
    std::iota(result.source.begin(), result.source.end(), 0U);
    PartComparison comparison(surface, kind);
    // Parts without an equal earlier one, by number of faces and area.
    std::map<std::pair<std::size_t, double>, SurfacePart> firsts;
    for (std::vector<std::uint32_t>& faces : connected_faces(surface)) {
        check_cancelled();
        SurfacePart part = comparison.part(std::move(faces));
        // Areas differ by about twice as much as lengths.
        const double margin = 4.0 * length_tolerance * part.area;
        auto candidate = firsts.lower_bound({part.faces.size(), part.area - margin});
        bool is_copy = false;
        for (std::size_t i = 0; i < max_candidates && candidate != firsts.end() && !is_copy;
             ++i, ++candidate) {
            if (candidate->first > std::pair(part.faces.size(), part.area + margin)) break;
            const std::vector<Corner> corners = comparison.corners_in(candidate->second, part);
            for (std::size_t k = 0; k < corners.size(); ++k) {
                const Corner corner = 3 * part.faces[k];
                result.source[corner] = corners[k];
                result.source[corner + 1] = next_in_triangle(corners[k]);
                result.source[corner + 2] = previous_in_triangle(corners[k]);
            }
            is_copy = !corners.empty();
        }
        if (is_copy)
            ++result.count;
        else
            firsts.emplace(std::pair(part.faces.size(), part.area), std::move(part));
    }
    return result;
}

namespace {

/// A number for each face: faces with equal numbers have the same material and density.
std::vector<std::uint32_t> kinds_of_faces(const Mesh& mesh, std::span<const float> densities,
                                          const AtlasSurface& surface) {
    std::map<std::pair<std::uint32_t, float>, std::uint32_t> numbers;
    std::vector<std::uint32_t> result;
    std::vector<std::uint32_t> material(mesh.triangles.size(), 0);
    for (const MaterialRange& range : mesh.material_ranges)
        std::fill_n(material.begin() + range.first_triangle, range.triangle_count,
                    range.material ? *range.material + 1 : 0);
    for (const std::uint32_t triangle : triangles_of_faces(surface)) {
        const std::pair key(material[triangle], densities.empty() ? 1.0F : densities[triangle]);
        result.push_back(
            numbers.emplace(key, static_cast<std::uint32_t>(numbers.size())).first->second);
    }
    return result;
}

/// Returns a mesh with all vertices and some triangles.
Mesh with_triangles(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
    Mesh result;
    result.positions = mesh.positions;
    result.texcoords = mesh.texcoords;
    result.triangles.reserve(triangles.size());
    std::size_t next = 0;
    for (const MaterialRange& range : mesh.material_ranges) {
        const std::size_t end = std::size_t{range.first_triangle} + range.triangle_count;
        const std::size_t first = next;
        while (next < triangles.size() && triangles[next] < end)
            ++next;
        if (next > first)
            result.material_ranges.push_back({static_cast<std::uint32_t>(first),
                                              static_cast<std::uint32_t>(next - first),
                                              range.material});
    }
    for (const std::uint32_t t : triangles)
        result.triangles.push_back(mesh.triangles[t]);
    return result;
}

}  // namespace

Unwrapped stacked(const Mesh& mesh, UnwrapOptions options, Report& report) {
    options.stack = false;
    const AtlasSurface surface = atlas_surface(
        mesh, {.at_seams = options.keep_seams, .first_vertices = options.first_vertices}, report);
    const EqualParts equal = equal_parts(surface, kinds_of_faces(mesh, options.densities, surface));
    const auto is_copy = [&](std::uint32_t face) {
        return face != no_face && equal.source[3 * face] != 3 * face;
    };
    std::vector<std::uint32_t> kept;
    const std::vector<std::uint32_t> triangle_of = triangles_of_faces(surface);
    std::vector<float> densities;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t face = surface.face_of_triangle[t];
        if (is_copy(face)) continue;
        kept.push_back(t);
        if (!options.densities.empty()) densities.push_back(options.densities[t]);
    }
    options.densities = std::move(densities);
    const Unwrapped unique = unwrap(with_triangles(mesh, kept), options, IgnoredReport());

    Unwrapped result;
    result.stats = unique.stats;
    result.stats.stacked_parts = equal.count;
    result.corner_texcoords.assign(3 * mesh.triangles.size(), glm::vec2(0.0F));
    result.chart.assign(mesh.triangles.size(), std::nullopt);
    for (std::size_t i = 0; i < kept.size(); ++i) {
        std::copy_n(unique.corner_texcoords.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                    result.corner_texcoords.begin() + std::ptrdiff_t{3} * kept[i]);
        result.chart[kept[i]] = unique.chart[i];
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t face = surface.face_of_triangle[t];
        if (!is_copy(face)) continue;
        const std::size_t first = triangle_of[equal.source[3 * face] / 3];
        result.chart[t] = result.chart[first];
        for (std::uint32_t k = 0; k < 3; ++k) {
            const Corner source = equal.source[3 * face + k];
            result.corner_texcoords[3 * t + (k + surface.first_corner[t]) % 3] =
                result.corner_texcoords[3 * first + (source % 3 + surface.first_corner[first]) % 3];
        }
    }
    return result;
}

}  // namespace relief::detail
