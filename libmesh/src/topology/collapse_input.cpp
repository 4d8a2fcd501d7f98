// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/topology/decimate_test.cpp, decimate_scene_test.cpp.
#include "topology/collapse_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/direction.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "portable_math.h"
#include "topology/topology.h"

namespace relief::detail {
namespace {

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

}  // namespace

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

Parts parts_of(const Mesh& mesh) {
    if (mesh.material_ranges.size() <= 1) return {};
    std::vector<std::uint32_t> parts(mesh.triangles.size(), 0);
    for (std::uint32_t r = 0; r < mesh.material_ranges.size(); ++r) {
        const MaterialRange& range = mesh.material_ranges[r];
        std::fill_n(parts.begin() + range.first_triangle, range.triangle_count, r);
    }
    return {std::move(parts)};
}

std::strong_ordering AttributedMesh::compare_attributes(std::uint32_t a, std::uint32_t b) const {
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

Corner first_corner(const Mesh& mesh, std::uint32_t triangle) {
    Corner first = 3 * triangle;
    for (Corner corner = first + 1; corner < 3 * triangle + 3; ++corner) {
        if (compare(mesh.positions[vertex_of(corner, mesh.triangles)],
                    mesh.positions[vertex_of(first, mesh.triangles)]) < 0)
            first = corner;
    }
    return first;
}

namespace {

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
    constexpr double largest_difference = 2.0;  // Of opposite normals, and of colors.
    for (const auto& [is_used, weight] : {std::pair{with_normals, weights.normal},
                                          {with_colors, weights.color},
                                          {with_joints, weights.joint}}) {
        const double error = is_used ? largest_difference * weight : 0.0;
        input.attribute_allowance += error * error;
    }
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

}  // namespace

namespace {

/// Returns the diagonals of the bounding boxes of the parts of a mesh that are connected through
/// vertices at equal positions, by vertex, in unit space; 0 where no finite triangle is.
std::vector<float> part_sizes(const Mesh& mesh, std::span<const std::uint32_t> classes,
                              const UnitSpace& space) {
    const auto is_on_surface = [&](const glm::uvec3& t) {
        return is_finite(mesh.positions[t.x]) && is_finite(mesh.positions[t.y]) &&
               is_finite(mesh.positions[t.z]);
    };
    DisjointSets parts(classes.size());
    for (const glm::uvec3& t : mesh.triangles) {
        if (!is_on_surface(t)) continue;
        parts.join(classes[t.x], classes[t.y]);
        parts.join(classes[t.x], classes[t.z]);
    }
    std::vector<Bounds> bounds(classes.size());
    for (const glm::uvec3& t : mesh.triangles) {
        if (!is_on_surface(t)) continue;
        for (int i = 0; i < 3; ++i) {
            Bounds& box = bounds[parts.find(classes[t[i]])];
            box.min = glm::min(box.min, mesh.positions[t[i]]);
            box.max = glm::max(box.max, mesh.positions[t[i]]);
        }
    }
    std::vector<float> sizes(classes.size(), 0.0F);
    for (std::uint32_t v = 0; v < classes.size(); ++v) {
        const Bounds& box = bounds[parts.find(classes[v])];
        if (!box.empty())
            sizes[v] = static_cast<float>(space.scale *
                                          glm::length(glm::dvec3(box.max) - glm::dvec3(box.min)));
    }
    return sizes;
}

/// Removes the triangles of small connected parts from the order of triangles. The largest one of
/// each material stays.
void leave_out_small_parts(const Mesh& mesh, const Parts& materials, std::span<const float> sizes,
                           double smallest, std::vector<Corner>& order, Report& report) {
    const auto size_at = [&](Corner corner) { return sizes[vertex_of(corner, mesh.triangles)]; };
    std::vector<float> largest(std::max<std::size_t>(mesh.material_ranges.size(), 1), 0.0F);
    for (const Corner corner : order) {
        float& value = largest[materials[triangle_of(corner)]];
        value = std::max(value, size_at(corner));
    }
    std::erase_if(order, [&](Corner corner) {
        const std::uint32_t triangle = triangle_of(corner);
        const float size = size_at(corner);
        const bool is_small = size > 0.0F && size < smallest && size < largest[materials[triangle]];
        if (is_small) report.add("triangle of a small part", "triangle", triangle, "is left out");
        return is_small;
    });
}

/// Returns, for each vertex, the next one at the same position, in a circle. Empty if there are no
/// others.
std::vector<std::uint32_t> next_at_position(const Topology& topology) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> cut;  // Positions with their vertices.
    for (std::uint32_t v = 0; v < topology.position_vertex.size(); ++v) {
        if (topology.is_cut[v]) cut.emplace_back(topology.position_vertex[v], v);
    }
    if (cut.empty()) return {};
    std::sort(cut.begin(), cut.end());
    std::vector<std::uint32_t> next(topology.position_vertex.size());
    std::iota(next.begin(), next.end(), 0U);
    for (std::size_t first = 0, end = 0; first < cut.size(); first = end) {
        while (end < cut.size() && cut[end].first == cut[first].first)
            ++end;
        for (std::size_t i = first; i < end; ++i)
            next[cut[i].second] = cut[i + 1 < end ? i + 1 : first].second;
    }
    return next;
}

/// Fills the wedges of a surface. With layers, a wedge stands for those of all layers.
void set_wedges(const Mesh& mesh, const Parts& parts, std::span<const std::uint32_t> classes,
                Wedges wedges, PreparedMesh& result) {
    CollapseInput& input = result.input;
    input.wedges.reserve(result.sources.size());
    if (result.layers.empty()) {
        for (const std::uint32_t source : result.sources) {
            const glm::uvec3 triangle = triangle_from(first_corner(mesh, source), mesh.triangles);
            const std::uint32_t part = parts[source];
            input.wedges.emplace_back(wedges.at(triangle.x, part), wedges.at(triangle.y, part),
                                      wedges.at(triangle.z, part));
        }
        input.wedge_count = wedges.vertex.size();
        result.vertex_of_wedge = std::move(wedges.vertex);
        return;
    }
    std::map<LayeredWedges::value_type, std::uint32_t> numbers;
    for (const std::uint32_t source : result.sources) {
        const glm::uvec3 triangle = triangle_from(first_corner(mesh, source), mesh.triangles);
        const Layer alone{source, {false, parts[source]}, source};
        std::span<const Layer> layers = layers_of(result.layers, source);
        if (layers.empty()) layers = {&alone, 1};
        input.counts.push_back(static_cast<std::uint32_t>(layers.size()));
        glm::uvec3 numbered{};
        for (int i = 0; i < 3; ++i) {
            LayeredWedges::value_type at_corner;
            for (const Layer& layer : layers) {
                const glm::uvec3& corners = mesh.triangles[layer.triangle];
                int k = 0;
                while (classes[corners[k]] != classes[triangle[i]])
                    ++k;
                const std::uint32_t wedge = wedges.at(corners[k], layer.key.part);
                at_corner.emplace_back(layer.key, wedges.vertex[wedge]);
            }
            numbered[i] = numbers.try_emplace(at_corner, static_cast<std::uint32_t>(numbers.size()))
                              .first->second;
            if (numbered[i] == result.layered_wedges.size()) {
                result.vertex_of_wedge.push_back(at_corner.front().second);
                result.layered_wedges.push_back(std::move(at_corner));
            }
        }
        input.wedges.push_back(numbered);
    }
    input.wedge_count = result.layered_wedges.size();
}

}  // namespace

/// Arrays are freed as soon as they are not needed, because the memory for the input is the largest
/// part of that for decimation.
PreparedMesh prepared(const AttributedMesh& surface, const DecimateOptions& options,
                      const AttributeWeights& weights, double smallest_part, Report& report) {
    const Mesh& mesh = surface.mesh;
    const UnitSpace space = unit_space(mesh);
    const Parts parts = parts_of(mesh);
    PreparedMesh result;
    CollapseInput& input = result.input;
    std::vector<std::uint32_t> classes = weld_positions(mesh.positions);
    Wedges wedges = wedges_of(surface, classes, parts);
    const std::vector<float> sizes = part_sizes(mesh, classes, space);
    std::vector<Corner> order = canonical_order(surface, space, parts);
    if (smallest_part > 0.0)
        leave_out_small_parts(mesh, parts, sizes, smallest_part * space.scale, order, report);
    result.layers = separate_layers(
        mesh, classes, [&](std::uint32_t triangle) { return parts[triangle]; },
        [&](std::uint32_t vertex, std::uint32_t part) { return wedges.at(vertex, part); }, order,
        report);
    input.topology = topology_of(mesh, classes, report, order);
    free_memory(order);
    input.next_at_position = next_at_position(input.topology);
    result.sources = std::move(input.topology.source_triangle);
    result.set_aside = std::move(input.topology.set_aside);
    input.center = space.center;
    input.scale = space.scale;
    input.positions.reserve(input.topology.position_vertex.size());
    input.part_sizes.reserve(input.topology.position_vertex.size());
    for (const std::uint32_t vertex : input.topology.position_vertex) {
        input.positions.push_back(mesh.positions[vertex]);
        input.part_sizes.push_back(sizes[vertex]);
    }
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
    for (const std::uint32_t t : result.set_aside) {
        glm::uvec3 triangle{};
        for (int i = 0; i < 3; ++i)
            triangle[i] = wedges.vertex[wedges.at(mesh.triangles[t][i], parts[t])];
        result.set_aside_triangles.push_back(triangle);
    }
    free_memory(input.topology.position_vertex);
    set_wedges(mesh, parts, classes, std::move(wedges), result);
    free_memory(classes);
    set_attributes(input, surface, weights, result.vertex_of_wedge);
    input.keeps_borders = options.keep_borders;
    input.keeps_seams = options.keep_seams;
    if (options.max_normal_error)
        input.min_normal_cosine = portable::cos(*options.max_normal_error);
    return result;
}

JoinedSurfaces::JoinedSurfaces(std::span<PreparedMesh> meshes, std::span<const double> factors) {
    // Attributes are scaled to a weight of 1, and those of a mesh without texture coordinates
    // follow two zeros if others have them.
    std::size_t attributes = 0;
    for (const PreparedMesh& mesh : meshes)
        joined_.has_texcoords = joined_.has_texcoords || mesh.input.has_texcoords;
    const auto omitted_texcoords = [&](const CollapseInput& input) {
        return joined_.has_texcoords && !input.has_texcoords ? 2U : 0U;
    };
    for (const PreparedMesh& mesh : meshes)
        attributes = std::max(attributes,
                              omitted_texcoords(mesh.input) + mesh.input.attribute_weights.size());
    joined_.attribute_weights.assign(attributes, 1.0);
    Topology& topology = joined_.topology;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        CollapseInput input = std::move(meshes[m].input);
        const double factor = factors[m];
        const auto first_vertex = static_cast<std::uint32_t>(joined_.positions.size());
        const auto first_triangle = static_cast<std::uint32_t>(topology.triangles.size());
        const auto first_wedge = static_cast<std::uint32_t>(joined_.wedge_count);
        places_.push_back({first_triangle, first_wedge, input.center, input.scale * factor});
        for (std::uint32_t v = 0; v < input.positions.size(); ++v) {
            joined_.positions.emplace_back(input.point(v) * factor);
            joined_.part_sizes.push_back(static_cast<float>(input.part_sizes[v] * factor));
        }
        for (const glm::uvec3& triangle : input.topology.triangles)
            topology.triangles.push_back(triangle + first_vertex);
        for (const Corner corner : input.topology.opposite)
            topology.opposite.push_back(corner == no_corner ? no_corner
                                                            : corner + 3 * first_triangle);
        topology.is_cut.insert(topology.is_cut.end(), input.topology.is_cut.begin(),
                               input.topology.is_cut.end());
        if (!input.is_fixed.empty() || !joined_.is_fixed.empty()) {
            joined_.is_fixed.resize(first_vertex, false);
            input.is_fixed.resize(input.positions.size(), false);
            joined_.is_fixed.insert(joined_.is_fixed.end(), input.is_fixed.begin(),
                                    input.is_fixed.end());
        }
        if (!input.next_at_position.empty() || !joined_.next_at_position.empty()) {
            const std::size_t before = joined_.next_at_position.size();
            joined_.next_at_position.resize(joined_.positions.size());
            std::iota(joined_.next_at_position.begin() + static_cast<std::ptrdiff_t>(before),
                      joined_.next_at_position.end(), static_cast<std::uint32_t>(before));
            for (std::uint32_t v = 0; v < input.next_at_position.size(); ++v)
                joined_.next_at_position[first_vertex + v] =
                    first_vertex + input.next_at_position[v];
        }
        if (!input.counts.empty() || !joined_.counts.empty()) {
            joined_.counts.resize(first_triangle, 1);
            input.counts.resize(input.topology.triangles.size(), 1);
            joined_.counts.insert(joined_.counts.end(), input.counts.begin(), input.counts.end());
        }
        for (const glm::uvec3& wedges : input.wedges)
            joined_.wedges.push_back(wedges + first_wedge);
        const std::size_t first_attribute = omitted_texcoords(input);
        joined_.attributes.resize((first_wedge + input.wedge_count) * attributes, 0.0F);
        for (std::uint32_t w = 0; w < input.wedge_count; ++w) {
            const std::span<const float> values = input.attributes_at(w);
            // A surface may have no attributes.
            float* place =
                joined_.attributes.data() + (first_wedge + w) * attributes + first_attribute;
            for (std::size_t k = 0; k < values.size(); ++k)
                place[k] =
                    static_cast<float>(values[k] * std::sqrt(input.attribute_weights[k]) * factor);
        }
        joined_.wedge_count += input.wedge_count;
        joined_.attribute_allowance =
            std::max(joined_.attribute_allowance, input.attribute_allowance * factor * factor);
        joined_.keeps_borders = input.keeps_borders;
        joined_.keeps_seams = input.keeps_seams;
        joined_.fits_positions = input.fits_positions;
        joined_.min_normal_cosine = input.min_normal_cosine;
    }
    if (!joined_.is_fixed.empty()) joined_.is_fixed.resize(joined_.positions.size(), false);
}

std::vector<Collapsed> JoinedSurfaces::separated(const Collapsed& all) const {
    std::vector<Collapsed> results(places_.size());
    const auto mesh_of = [&](std::uint32_t index, std::uint32_t Place::*first) {
        const auto after = std::upper_bound(
            places_.begin(), places_.end(), index,
            [&](std::uint32_t value, const Place& place) { return value < place.*first; });
        return static_cast<std::size_t>(after - places_.begin()) - 1;
    };
    for (std::size_t i = 0; i < all.remaining.size(); ++i) {
        const std::size_t m = mesh_of(all.remaining[i], &Place::first_triangle);
        results[m].remaining.push_back(all.remaining[i] - places_[m].first_triangle);
        results[m].wedges.push_back(all.wedges[i] - places_[m].first_wedge);
        ++results[m].triangles;
    }
    for (const auto& [wedge, position] : all.moved) {
        const std::size_t m = mesh_of(wedge, &Place::first_wedge);
        const Place& place = places_[m];
        results[m].moved.emplace_back(wedge - place.first_wedge,
                                      glm::vec3(place.center + glm::dvec3(position) / place.scale));
    }
    return results;
}

}  // namespace relief::detail
