// SPDX-License-Identifier: Apache-2.0
// Decimation: prepares a mesh for edge collapses (edge_collapse.h) and gathers what remains.
//
// Positions are scaled into [-1, 1] by a power of two, so the result does not depend on the unit of
// length. Triangles are visited along a space-filling curve, with ties in the order of their
// vertices' values, so the result does not depend on the order of triangles.
#include "relief/mesh/topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <glm/glm.hpp>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/direction.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "topology/edge_collapse.h"
#include "topology/topology.h"

namespace relief {
using namespace relief::detail;

namespace {

void check(const Mesh& mesh, const Deformation& deformation, const DecimateOptions& options) {
    validate(mesh);
    const auto check_count = [&](std::size_t count, const char* values) {
        if (count == 0 || count == mesh.positions.size()) return;
        throw InvalidInput(
            fmt::format("there are {} {}, but {} positions", count, values, mesh.positions.size()));
    };
    check_count(deformation.joints.size(), "joint weights");
    for (const auto& displacements : deformation.displacements)
        check_count(displacements.size(), "displacements");
    if (!options.triangles && !options.max_error)
        throw InvalidInput("decimation needs a number of triangles or an error to stop at");
    if (options.triangles && *options.triangles == 0)
        throw InvalidInput("the number of triangles is 0, but must be at least 1");
    if (options.max_error && !(*options.max_error >= 0.0 && std::isfinite(*options.max_error)))
        throw InvalidInput(fmt::format("the maximum error is {}, but must be finite and at least 0",
                                       *options.max_error));
    if (options.max_normal_error && !(*options.max_normal_error > 0.0))
        throw InvalidInput(fmt::format("the maximum error of normals is {}, but must be above 0",
                                       *options.max_normal_error));
    const AttributeWeights& weights = options.weights;
    for (const double weight :
         {weights.texcoord, weights.normal, weights.color, weights.joint, weights.target}) {
        if (!(weight >= 0.0 && std::isfinite(weight)))
            throw InvalidInput(
                fmt::format("a weight is {}, but must be finite and at least 0", weight));
    }
}

/// Maps object space to [-1, 1]; `scale` is the factor of lengths.
struct UnitSpace {
    glm::dvec3 center{0.0};
    double scale = 1.0;

    [[nodiscard]] glm::dvec3 operator()(const glm::vec3& position) const {
        return (glm::dvec3(position) - center) * scale;
    }
};

UnitSpace unit_space(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    UnitSpace space;
    if (bounds.empty()) return space;
    const glm::dvec3 low(bounds.min);
    const glm::dvec3 high(bounds.max);
    space.center = (low + high) / 2.0;
    const glm::dvec3 half = (high - low) / 2.0;
    const double longest = std::max({half.x, half.y, half.z});
    if (longest > 0.0) space.scale = std::ldexp(1.0, -(std::ilogb(longest) + 1));
    return space;
}

/// The index of the material range of each triangle; empty if there is at most one.
struct Parts {
    std::vector<std::uint32_t> of_triangle;

    [[nodiscard]] std::uint32_t operator[](std::size_t triangle) const {
        return of_triangle.empty() ? 0 : of_triangle[triangle];
    }
};

Parts parts_of(const Mesh& mesh) {
    if (mesh.material_ranges.size() <= 1) return {};
    std::vector<std::uint32_t> parts(mesh.triangles.size(), 0);
    for (std::uint32_t r = 0; r < mesh.material_ranges.size(); ++r) {
        const MaterialRange& range = mesh.material_ranges[r];
        std::fill_n(parts.begin() + range.first_triangle, range.triangle_count, r);
    }
    return {std::move(parts)};
}

/// Compares the numbers of two vectors; a NaN is ordered by its bits, and -0 equals +0.
template <typename Vector>
std::strong_ordering compare(const Vector& a, const Vector& b) {
    for (int i = 0; i < Vector::length(); ++i) {
        const auto left = std::bit_cast<std::int32_t>(a[i] + 0.0F);
        const auto right = std::bit_cast<std::int32_t>(b[i] + 0.0F);
        if (left != right) return left <=> right;
    }
    return std::strong_ordering::equal;
}

/// A mesh with the attributes that make seams where they differ.
struct AttributedMesh {
    const Mesh& mesh;
    const Deformation& deformation;
    bool with_normals = false;

    [[nodiscard]] std::strong_ordering compare_attributes(std::uint32_t a, std::uint32_t b) const {
        auto order = std::strong_ordering::equal;
        if (a == b) return order;
        const auto refine = [&](const auto& values) {
            if (order == 0 && !values.empty()) order = compare(values[a], values[b]);
        };
        refine(mesh.texcoords);
        refine(mesh.texcoords_2);
        refine(mesh.colors);
        if (with_normals) refine(mesh.normals);
        refine(deformation.joints);
        for (const auto& displacements : deformation.displacements)
            refine(displacements);
        return order;
    }
};

/// The corners of a surface that share position, part and attributes. A vertex that several parts
/// use has a wedge for each.
struct Wedges {
    std::vector<std::uint32_t> vertex;  ///< By wedge: the mesh vertex.
    /// By mesh vertex: its wedge in the first part that uses it.
    std::vector<std::uint32_t> of_vertex;
    /// Vertex, part and wedge where a vertex is used by another part too; ascending.
    std::vector<std::array<std::uint32_t, 3>> others;
    std::vector<std::uint32_t> first_part;  ///< By mesh vertex; empty with one part.

    [[nodiscard]] std::uint32_t at(std::uint32_t vertex_index, std::uint32_t part) const {
        if (first_part.empty() || first_part[vertex_index] == part) return of_vertex[vertex_index];
        const std::array<std::uint32_t, 3> key = {vertex_index, part, 0};
        return (*std::lower_bound(others.begin(), others.end(), key))[2];
    }
};

/// Joins equal wedges at the same position; the one with the lowest index remains.
Wedges wedges_of(const AttributedMesh& surface, std::span<const std::uint32_t> classes,
                 const Parts& parts) {
    const Mesh& mesh = surface.mesh;
    Wedges wedges;
    const std::size_t vertices = mesh.positions.size();
    wedges.vertex.resize(vertices);
    std::iota(wedges.vertex.begin(), wedges.vertex.end(), 0U);
    if (mesh.material_ranges.size() > 1) {
        wedges.first_part.assign(vertices, no_corner);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            for (int i = 0; i < 3; ++i) {
                const std::uint32_t v = mesh.triangles[t][i];
                if (wedges.first_part[v] == no_corner) wedges.first_part[v] = parts[t];
                if (wedges.first_part[v] != parts[t]) wedges.others.push_back({v, parts[t], 0});
            }
        }
        std::sort(wedges.others.begin(), wedges.others.end());
        wedges.others.erase(std::unique(wedges.others.begin(), wedges.others.end()),
                            wedges.others.end());
        for (auto& other : wedges.others) {
            other[2] = static_cast<std::uint32_t>(wedges.vertex.size());
            wedges.vertex.push_back(other[0]);
        }
    }
    // Only positions with several wedges are sorted.
    std::vector<bool> is_shared(vertices, false);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (classes[v] != v) is_shared[classes[v]] = true;
    }
    for (const auto& other : wedges.others)
        is_shared[classes[other[0]]] = true;
    const auto part_at = [&](std::uint32_t wedge) {
        if (wedge >= vertices) return wedges.others[wedge - vertices][1];
        return wedges.first_part.empty() ? 0U : wedges.first_part[wedge];
    };
    const auto compared = [&](std::uint32_t a, std::uint32_t b) {
        const std::uint32_t va = wedges.vertex[a];
        const std::uint32_t vb = wedges.vertex[b];
        if (classes[va] != classes[vb]) return classes[va] <=> classes[vb];
        if (part_at(a) != part_at(b)) return part_at(a) <=> part_at(b);
        return surface.compare_attributes(va, vb);
    };
    std::vector<std::uint32_t> sorted;
    for (std::uint32_t w = 0; w < wedges.vertex.size(); ++w) {
        if (is_shared[classes[wedges.vertex[w]]]) sorted.push_back(w);
    }
    std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
        const std::strong_ordering order = compared(a, b);
        return order == 0 ? a < b : order < 0;
    });
    std::vector<std::uint32_t> first(wedges.vertex.size());
    std::iota(first.begin(), first.end(), 0U);
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        if (compared(sorted[i - 1], sorted[i]) == 0) first[sorted[i]] = first[sorted[i - 1]];
    }
    for (auto& other : wedges.others)
        other[2] = first[other[2]];
    first.resize(vertices);
    wedges.of_vertex = std::move(first);
    return wedges;
}

/// Returns the position along the Z curve of a point within [-1, 1], with 16 bits for each axis.
std::uint64_t curve_key(const glm::dvec3& p) {
    const auto spread = [](double x) {
        const double scaled = std::clamp((x + 1.0) * 32768.0, 0.0, 65535.0);
        auto bits = static_cast<std::uint64_t>(scaled);
        bits = (bits | (bits << 16)) & 0x0000FF0000FF;
        bits = (bits | (bits << 8)) & 0x00F00F00F00F;
        bits = (bits | (bits << 4)) & 0x0C30C30C30C3;
        return (bits | (bits << 2)) & 0x249249249249;
    };
    return spread(p.x) | (spread(p.y) << 1) | (spread(p.z) << 2);
}

/// Returns the corner of a triangle with the first position by value. All computations begin there,
/// because their rounding depends on the first corner.
Corner first_corner(const Mesh& mesh, std::uint32_t triangle) {
    Corner first = 3 * triangle;
    for (Corner corner = first + 1; corner < 3 * triangle + 3; ++corner) {
        if (compare(mesh.positions[vertex_of(corner, mesh.triangles)],
                    mesh.positions[vertex_of(first, mesh.triangles)]) < 0)
            first = corner;
    }
    return first;
}

/// The first corner of a triangle with a key of 48 bits.
struct KeyedCorner {
    std::uint64_t key = 0;
    Corner corner = 0;
};

/// Sorts by key; equal keys keep their order.
void radix_sort(std::vector<KeyedCorner>& values) {
    constexpr unsigned digit_bits = 12;
    constexpr std::size_t digits = std::size_t(1) << digit_bits;
    std::vector<KeyedCorner> sorted(values.size());
    std::vector<std::size_t> place(digits);
    for (unsigned shift = 0; shift < 48; shift += digit_bits) {
        std::fill(place.begin(), place.end(), 0);
        const auto digit = [&](const KeyedCorner& value) {
            return static_cast<std::size_t>(value.key >> shift) & (digits - 1);
        };
        for (const KeyedCorner& value : values)
            ++place[digit(value)];
        std::exclusive_scan(place.begin(), place.end(), place.begin(), std::size_t(0));
        for (const KeyedCorner& value : values)
            sorted[place[digit(value)]++] = value;
        values.swap(sorted);
    }
}

/// Returns the first corners of the triangles in an order that depends only on their values.
std::vector<Corner> canonical_order(const AttributedMesh& surface, const UnitSpace& space,
                                    const Parts& parts) {
    const Mesh& mesh = surface.mesh;
    std::vector<KeyedCorner> keyed(mesh.triangles.size());
    parallel_for(keyed.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const Corner first = first_corner(mesh, static_cast<std::uint32_t>(t));
            const glm::uvec3 triangle = triangle_from(first, mesh.triangles);
            glm::dvec3 sum(0.0);
            for (int i = 0; i < 3; ++i)
                sum += space(mesh.positions[triangle[i]]);
            const bool finite = is_finite(glm::vec3(sum));
            keyed[t] = {finite ? curve_key(sum / 3.0) : 0, first};
        }
    });
    radix_sort(keyed);
    const auto is_before = [&](const KeyedCorner& a, const KeyedCorner& b) {
        const glm::uvec3 triangle_a = triangle_from(a.corner, mesh.triangles);
        const glm::uvec3 triangle_b = triangle_from(b.corner, mesh.triangles);
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t va = triangle_a[i];
            const std::uint32_t vb = triangle_b[i];
            if (va == vb) continue;
            auto order = compare(mesh.positions[va], mesh.positions[vb]);
            if (order == 0) order = surface.compare_attributes(va, vb);
            if (order != 0) return order < 0;
        }
        const std::uint32_t ta = triangle_of(a.corner);
        const std::uint32_t tb = triangle_of(b.corner);
        if (parts[ta] != parts[tb]) return parts[ta] < parts[tb];
        if (!mesh.smoothing_groups.empty() &&
            mesh.smoothing_groups[ta] != mesh.smoothing_groups[tb])
            return mesh.smoothing_groups[ta] < mesh.smoothing_groups[tb];
        return a.corner < b.corner;
    };
    for (auto first = keyed.begin(); first != keyed.end();) {
        const auto last = std::find_if(
            first, keyed.end(), [&](const KeyedCorner& value) { return value.key != first->key; });
        std::sort(first, last, is_before);
        first = last;
    }
    std::vector<Corner> order;
    order.reserve(keyed.size());
    for (const KeyedCorner& value : keyed)
        order.push_back(value.corner);
    return order;
}

/// Returns the mean squared length of a texture unit on the surface; 0 if the texture has no area.
double texture_scale_of(const Mesh& mesh, const CollapseInput& input,
                        std::span<const std::uint32_t> vertex_of_wedge) {
    double area = 0.0;
    double texture_area = 0.0;
    for (std::size_t t = 0; t < input.wedges.size(); ++t) {
        const auto at = [&](int i) {
            const glm::dvec3 p(input.positions[input.topology.triangles[t][i]]);
            return (p - input.center) * input.scale;
        };
        const auto texcoord = [&](int i) {
            return glm::dvec2(mesh.texcoords[vertex_of_wedge[input.wedges[t][i]]]);
        };
        area += glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
        const glm::dvec2 tb = texcoord(1) - texcoord(0);
        const glm::dvec2 tc = texcoord(2) - texcoord(0);
        const double here = std::abs(tb.x * tc.y - tb.y * tc.x);
        if (std::isfinite(here)) texture_area += here;
    }
    return texture_area > 0.0 ? area / texture_area : 0.0;
}

/// Sets the attributes that the error considers, and their weights.
void set_attributes(CollapseInput& input, const AttributedMesh& surface,
                    const AttributeWeights& weights,
                    std::span<const std::uint32_t> vertex_of_wedge) {
    const Mesh& mesh = surface.mesh;
    const Deformation& deformation = surface.deformation;
    double texture_scale = 0.0;
    if (!mesh.texcoords.empty()) texture_scale = texture_scale_of(mesh, input, vertex_of_wedge);
    input.has_texcoords = texture_scale > 0.0;
    const bool with_normals = weights.normal > 0.0 && !mesh.normals.empty() && surface.with_normals;
    const bool with_colors = weights.color > 0.0 && !mesh.colors.empty();
    const bool with_joints = weights.joint > 0.0 && !deformation.joints.empty();
    const auto add = [&](bool is_used, std::size_t count, double weight) {
        if (is_used) input.attribute_weights.insert(input.attribute_weights.end(), count, weight);
    };
    add(input.has_texcoords, 2, weights.texcoord * weights.texcoord * texture_scale);
    add(with_normals, 3, weights.normal * weights.normal);
    add(with_colors, 4, weights.color * weights.color);
    add(with_joints, 4, weights.joint * weights.joint);
    std::vector<std::span<const glm::vec3>> displacements;
    for (const std::vector<glm::vec3>& values : deformation.displacements) {
        if (weights.target > 0.0 && !values.empty()) displacements.emplace_back(values);
    }
    const double target_weight = weights.target * input.scale;
    add(true, 3 * displacements.size(), target_weight * target_weight);
    input.attributes.reserve(vertex_of_wedge.size() * input.attribute_weights.size());
    const auto append = [&](const auto& value) {
        for (int i = 0; i < value.length(); ++i)
            input.attributes.push_back(std::isfinite(value[i]) ? value[i] : 0.0F);
    };
    for (const std::uint32_t vertex : vertex_of_wedge) {
        if (input.has_texcoords) append(mesh.texcoords[vertex]);
        if (with_normals) append(mesh.normals[vertex]);
        if (with_colors) append(mesh.colors[vertex]);
        if (with_joints) append(deformation.joints[vertex]);
        for (const std::span<const glm::vec3> values : displacements)
            append(values[vertex]);
    }
}

/// The remaining triangles.
struct Remains {
    std::vector<std::uint32_t> sources;  ///< Triangles of the input, ascending.
    std::vector<glm::uvec3> triangles;   ///< Their vertices, of the input.
    /// New positions of vertices of the input.
    std::vector<std::pair<std::uint32_t, glm::vec3>> moved;

    [[nodiscard]] std::size_t count() const { return triangles.size(); }
};

/// Gathers what remains in the order of the input.
///
/// \param sources    for each triangle of the surface, that of the input
/// \param set_aside  triangles of the input that remain as they are
Remains gathered_remains(const Mesh& mesh, const Collapsed& collapsed,
                         std::span<const std::uint32_t> sources,
                         std::span<const std::uint32_t> set_aside,
                         std::span<const std::uint32_t> vertex_of_wedge) {
    std::vector<std::pair<std::uint32_t, glm::uvec3>> all;
    all.reserve(collapsed.remaining.size() + set_aside.size());
    for (std::size_t i = 0; i < collapsed.remaining.size(); ++i) {
        const std::uint32_t source = sources[collapsed.remaining[i]];
        const Corner first = first_corner(mesh, source);
        glm::uvec3 triangle{};
        for (int k = 0; k < 3; ++k)
            triangle[static_cast<int>((first + static_cast<Corner>(k)) % 3)] =
                vertex_of_wedge[collapsed.wedges[i][k]];
        all.emplace_back(source, triangle);
    }
    for (const std::uint32_t t : set_aside)
        all.emplace_back(t, mesh.triangles[t]);
    std::sort(all.begin(), all.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    Remains remains;
    remains.sources.reserve(all.size());
    remains.triangles.reserve(all.size());
    for (const auto& [source, triangle] : all) {
        remains.sources.push_back(source);
        remains.triangles.push_back(triangle);
    }
    for (const auto& [wedge, position] : collapsed.moved)
        remains.moved.emplace_back(vertex_of_wedge[wedge], position);
    return remains;
}

/// The surface of a mesh for edge collapses, and the way back from it.
struct Prepared {
    CollapseInput input;
    std::vector<std::uint32_t> sources;  ///< For each triangle of the surface, that of the mesh.
    std::vector<std::uint32_t> set_aside;
    std::vector<std::uint32_t> vertex_of_wedge;
};

/// Arrays are freed as soon as they are not needed, because the memory for the input is the largest
/// part of that for decimation.
Prepared prepared(const AttributedMesh& surface, const DecimateOptions& options, Report& report) {
    const Mesh& mesh = surface.mesh;
    const UnitSpace space = unit_space(mesh);
    const Parts parts = parts_of(mesh);
    Prepared result;
    CollapseInput& input = result.input;
    std::vector<std::uint32_t> classes = weld_positions(mesh.positions);
    Wedges wedges = wedges_of(surface, classes, parts);
    input.topology = topology_of(mesh, classes, report, canonical_order(surface, space, parts));
    result.sources = std::move(input.topology.source_triangle);
    result.set_aside = std::move(input.topology.set_aside);
    input.center = space.center;
    input.scale = space.scale;
    input.positions.reserve(input.topology.position_vertex.size());
    for (const std::uint32_t vertex : input.topology.position_vertex)
        input.positions.push_back(mesh.positions[vertex]);
    input.fits_positions = options.fit_positions;
    if (options.fit_positions && !result.set_aside.empty()) {
        // Triangles that are set aside keep their vertices.
        std::vector<bool> is_fixed(mesh.positions.size(), false);
        for (const std::uint32_t t : result.set_aside) {
            for (int i = 0; i < 3; ++i)
                is_fixed[classes[mesh.triangles[t][i]]] = true;
        }
        for (const std::uint32_t vertex : input.topology.position_vertex)
            input.is_fixed.push_back(is_fixed[vertex]);
    }
    free_memory(classes);
    free_memory(input.topology.position_vertex);
    input.wedges.reserve(result.sources.size());
    for (const std::uint32_t source : result.sources) {
        const glm::uvec3 triangle = triangle_from(first_corner(mesh, source), mesh.triangles);
        const std::uint32_t part = parts[source];
        input.wedges.emplace_back(wedges.at(triangle.x, part), wedges.at(triangle.y, part),
                                  wedges.at(triangle.z, part));
    }
    input.wedge_count = wedges.vertex.size();
    result.vertex_of_wedge = std::move(wedges.vertex);
    wedges = {};
    set_attributes(input, surface, options.weights, result.vertex_of_wedge);
    input.keeps_borders = options.keep_borders;
    input.keeps_seams = options.keep_seams;
    if (options.triangles)
        input.triangles =
            *options.triangles - std::min(*options.triangles, result.set_aside.size());
    if (options.max_error) input.max_error = *options.max_error * space.scale;
    if (options.max_normal_error)
        input.min_normal_cosine = portable::cos(*options.max_normal_error);
    return result;
}

Remains remains_of(const AttributedMesh& surface, const DecimateOptions& options, Report& report) {
    Prepared input = prepared(surface, options, report);
    const Collapsed collapsed = collapse_edges(std::move(input.input));
    return gathered_remains(surface.mesh, collapsed, input.sources, input.set_aside,
                            input.vertex_of_wedge);
}

/// Returns the larger of the maximum distances in both directions.
///
/// \param report  counts vertices and triangles that were not examined
double distance_from(const Mesh& mesh, const Remains& remains, Report& report) {
    Mesh before;
    Mesh after;
    before.positions = mesh.positions;
    // Triangles with two corners at one position have no surface.
    const std::vector<std::uint32_t> classes = weld_positions(mesh.positions);
    std::copy_if(mesh.triangles.begin(), mesh.triangles.end(), std::back_inserter(before.triangles),
                 [&](const glm::uvec3& t) {
                     return classes[t.x] != classes[t.y] && classes[t.y] != classes[t.z] &&
                            classes[t.z] != classes[t.x];
                 });
    after.positions = mesh.positions;
    for (const auto& [vertex, position] : remains.moved)
        after.positions[vertex] = position;
    after.triangles = remains.triangles;
    const SurfaceDistance distance = surface_distance(before, after);
    if (const std::size_t omitted = distance.from_a.omitted + distance.from_b.omitted) {
        report.add("distance of crossing triangles", "mesh", 0,
                   fmt::format("is not measured at {} vertices and triangles", omitted));
    }
    return std::max(distance.from_a.max, distance.from_b.max);
}

/// Decimates until the measured distance reaches `max_error`. The error of a collapse only
/// estimates that distance, so its limit is adjusted: the result with the fewest triangles within
/// the distance is returned.
Remains remains_within(const AttributedMesh& surface, const DecimateOptions& options,
                       Report& report) {
    const Mesh& mesh = surface.mesh;
    constexpr int max_attempts = 10;
    constexpr double well_used = 0.7;  ///< The part of the distance at which the search ends.
    constexpr double rounding = 2.5e-7;
    const double allowed = *options.max_error + rounding / unit_space(mesh).scale;
    DecimateOptions attempt = options;
    std::optional<Remains> best;
    Report best_report;
    // Limits below `good` keep the distance, and limits above `bad` do not.
    double good = 0.0;
    double bad = std::numeric_limits<double>::infinity();
    for (int i = 0; i < max_attempts; ++i) {
        Report found;
        Remains remains = remains_of(surface, attempt, found);
        const double distance = distance_from(mesh, remains, found);
        const double limit = *attempt.max_error;
        const bool is_within = distance <= allowed;
        if (is_within && (!best || remains.count() <= best->count())) {
            best = std::move(remains);
            best_report = found;
        }
        (is_within ? good : bad) = limit;
        const bool has_reached = options.triangles && best && best->count() <= *options.triangles;
        if (has_reached || limit == 0.0) break;
        if (is_within && distance >= well_used * *options.max_error) break;
        // The distance is nearly proportional to the limit. Steps are at most a factor of 4.
        const double factor = std::clamp(0.9 * *options.max_error / distance, 0.25, 4.0);
        double next = limit * (distance > 0.0 ? factor : 4.0);
        if (next <= good || next >= bad) next = std::sqrt(std::max(good, bad / 16.0) * bad);
        if (!(next < std::numeric_limits<double>::max())) break;
        attempt.max_error = i + 2 == max_attempts && !best ? 0.0 : next;
    }
    if (!best) {
        // Not even collapses without an error keep the distance.
        attempt.triangles = mesh.triangles.size();
        best = remains_of(surface, attempt, best_report);
    }
    report.merge(best_report);
    return *std::move(best);
}

/// Returns the vertices that the remaining triangles use, in their order. Isolated vertices are
/// counted.
std::vector<std::uint32_t> used_vertices(const Mesh& mesh, const Remains& remains, Report& report) {
    std::vector<bool> was_used(mesh.positions.size(), false);
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            was_used[triangle[i]] = true;
    }
    std::vector<bool> is_used(mesh.positions.size(), false);
    for (const glm::uvec3& triangle : remains.triangles) {
        for (int i = 0; i < 3; ++i)
            is_used[triangle[i]] = true;
    }
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (!was_used[v]) report.add("isolated vertex", "vertex", v, "is left out");
        if (is_used[v]) vertices.push_back(v);
    }
    return vertices;
}

FramedMesh gathered(const Mesh& mesh, const Remains& remains, Report& report) {
    VertexSplit left{used_vertices(mesh, remains, report), {}};
    std::vector<std::uint32_t> place(mesh.positions.size(), 0);
    for (std::uint32_t i = 0; i < left.source_vertex.size(); ++i)
        place[left.source_vertex[i]] = i;
    std::vector<MaterialRange> ranges = mesh.material_ranges;
    std::vector<std::uint32_t> groups;
    const Parts parts = parts_of(mesh);
    for (MaterialRange& range : ranges)
        range.triangle_count = 0;
    for (std::size_t i = 0; i < remains.count(); ++i) {
        const glm::uvec3& triangle = remains.triangles[i];
        const std::uint32_t source = remains.sources[i];
        left.triangles.emplace_back(place[triangle.x], place[triangle.y], place[triangle.z]);
        if (!mesh.smoothing_groups.empty()) groups.push_back(mesh.smoothing_groups[source]);
        if (!ranges.empty()) ++ranges[parts[source]].triangle_count;
    }
    std::uint32_t first = 0;
    for (MaterialRange& range : ranges) {
        range.first_triangle = first;
        first += range.triangle_count;
    }
    FramedMesh result;
    result.mesh = carried(mesh, left);
    for (const auto& [vertex, position] : remains.moved)
        result.mesh.positions[place[vertex]] = position;
    result.mesh.tangents.clear();  // The tangents are those of removed triangles.
    result.mesh.material_ranges = std::move(ranges);
    result.mesh.smoothing_groups = std::move(groups);
    result.source_vertex = std::move(left.source_vertex);
    return result;
}

/// Computes normals and tangents as requested. Attributes that are neither requested nor present
/// stay absent.
FramedMesh framed(const Mesh& input, FramedMesh small, FrameOptions frames, Report& report) {
    const bool had_tangents = !input.tangents.empty() && !input.texcoords.empty();
    if (frames.tangents == TangentMethod::keep) {
        frames.tangents = had_tangents ? TangentMethod::mikktspace : TangentMethod::none;
        if (!input.tangents.empty()) {
            report.add(
                "tangents of other triangles", "mesh", 0,
                had_tangents ? "are recomputed" : "are removed: there are no texture coordinates");
        }
    }
    if (frames.normals == NormalMode::keep && frames.tangents == TangentMethod::none) return small;
    FramedMesh result = with_frames(std::move(small.mesh), frames, report);
    for (std::uint32_t& source : result.source_vertex)
        source = small.source_vertex[source];
    return result;
}

}  // namespace

FramedMesh decimated(const Mesh& mesh, const DecimateOptions& options, Report& report,
                     const Deformation& deformation) {
    check(mesh, deformation, options);
    const AttributedMesh surface{mesh, deformation, options.frames.normals == NormalMode::keep};
    const Remains remains = options.max_error ? remains_within(surface, options, report)
                                              : remains_of(surface, options, report);
    // One interior move removes two triangles, so the result may be one less than requested.
    if (options.triangles && !options.max_error && remains.count() > *options.triangles) {
        report.add("number of triangles out of reach", "mesh", 0,
                   fmt::format("{} are left: seams, hard edges, borders and shape allow no fewer",
                               remains.count()));
    }
    return framed(mesh, gathered(mesh, remains, report), options.frames, report);
}

double max_corner_angle(const Mesh& original, const FramedMesh& result) {
    const Mesh& decimated = result.mesh;
    validate(original);
    validate(decimated);
    if (result.source_vertex.size() != decimated.positions.size()) {
        throw InvalidInput(fmt::format("there are {} source vertices, but {} positions",
                                       result.source_vertex.size(), decimated.positions.size()));
    }
    for (const std::uint32_t source : result.source_vertex) {
        if (source < original.positions.size()) continue;
        throw InvalidInput(fmt::format("source vertex {} is named, but there are only {}", source,
                                       original.positions.size()));
    }
    const std::vector<std::uint32_t> classes = weld_positions(original.positions);
    const auto normal_of = [](const Mesh& mesh, const glm::uvec3& t) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 cross =
            glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
        const double length = glm::length(cross);
        return length > 0.0 && std::isfinite(length) ? cross / length : glm::dvec3(0.0);
    };
    // The triangles of the original at each position, sorted by position.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> at;
    for (std::uint32_t t = 0; t < original.triangles.size(); ++t) {
        if (normal_of(original, original.triangles[t]) == glm::dvec3(0.0)) continue;
        for (int i = 0; i < 3; ++i)
            at.emplace_back(classes[original.triangles[t][i]], t);
    }
    std::sort(at.begin(), at.end());
    const double infinite = std::numeric_limits<double>::infinity();
    std::vector<double> largest(decimated.triangles.size(), 0.0);
    parallel_for(largest.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::dvec3 normal = normal_of(decimated, decimated.triangles[t]);
            if (normal == glm::dvec3(0.0)) continue;
            for (int i = 0; i < 3; ++i) {
                const std::uint32_t position =
                    classes[result.source_vertex[decimated.triangles[t][i]]];
                const auto first = std::lower_bound(at.begin(), at.end(), std::pair(position, 0U));
                double nearest = infinite;
                std::size_t count = 0;
                for (auto here = first; here != at.end() && here->first == position; ++here) {
                    if (++count > max_valence) break;
                    const glm::uvec3& triangle = original.triangles[here->second];
                    nearest =
                        std::min(nearest, angle_between(normal, normal_of(original, triangle)));
                }
                if (count > max_valence) continue;
                if (nearest < infinite) largest[t] = std::max(largest[t], nearest);
            }
        }
    });
    return largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
}

}  // namespace relief
