// SPDX-License-Identifier: Apache-2.0
// Decimation of one mesh or of the meshes of a scene: runs edge collapses (edge_collapse.h) within
// the limits and gathers what remains. Tests: tests/mesh/topology/decimate_test.cpp.
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
#include <string>
#include <utility>
#include <vector>

#include "geometry/direction.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "topology/collapse_input.h"
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
    if (!(options.drop_parts >= 0.0))
        throw InvalidInput(fmt::format("the size of parts to drop is {}, but must be at least 0",
                                       options.drop_parts));
    const AttributeWeights& weights = options.weights;
    for (const double weight :
         {weights.texcoord, weights.normal, weights.color, weights.joint, weights.target}) {
        if (!(weight >= 0.0 && std::isfinite(weight)))
            throw InvalidInput(
                fmt::format("a weight is {}, but must be finite and at least 0", weight));
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
Remains gathered_remains(const Mesh& mesh, const Collapsed& collapsed,
                         const PreparedMesh& prepared) {
    std::vector<std::pair<std::uint32_t, glm::uvec3>> all;
    all.reserve(collapsed.remaining.size() + prepared.set_aside.size());
    for (std::size_t i = 0; i < collapsed.remaining.size(); ++i) {
        const std::uint32_t source = prepared.sources[collapsed.remaining[i]];
        const Corner first = first_corner(mesh, source);
        const std::span<const Layer> layers = layers_of(prepared.layers, source);
        if (layers.empty()) {
            glm::uvec3 triangle{};
            for (int k = 0; k < 3; ++k)
                triangle[static_cast<int>((first + static_cast<Corner>(k)) % 3)] =
                    prepared.vertex_of_wedge[collapsed.wedges[i][k]];
            all.emplace_back(source, triangle);
        }
        const glm::uvec3 corners = triangle_from(first, mesh.triangles);
        for (const Layer& layer : layers) {
            glm::uvec3 triangle{};
            for (int k = 0; k < 3; ++k) {
                const glm::vec3& position = mesh.positions[mesh.triangles[layer.triangle][k]];
                int corner = 0;
                while (mesh.positions[corners[corner]] != position)
                    ++corner;
                const auto& wedges = prepared.layered_wedges[collapsed.wedges[i][corner]];
                triangle[k] = std::lower_bound(wedges.begin(), wedges.end(),
                                               std::pair(layer.key, std::uint32_t(0)))
                                  ->second;
            }
            all.emplace_back(layer.triangle, triangle);
        }
    }
    for (std::size_t i = 0; i < prepared.set_aside.size(); ++i)
        all.emplace_back(prepared.set_aside[i], prepared.set_aside_triangles[i]);
    std::sort(all.begin(), all.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    Remains remains;
    remains.sources.reserve(all.size());
    remains.triangles.reserve(all.size());
    for (const auto& [source, triangle] : all) {
        remains.sources.push_back(source);
        remains.triangles.push_back(triangle);
    }
    for (const auto& [wedge, position] : collapsed.moved) {
        if (prepared.layers.empty()) {
            remains.moved.emplace_back(prepared.vertex_of_wedge[wedge], position);
            continue;
        }
        for (const auto& [key, vertex] : prepared.layered_wedges[wedge])
            remains.moved.emplace_back(vertex, position);
    }
    return remains;
}

/// The meshes that are decimated together.
class Scene {
  public:
    Scene(std::span<const SceneMesh> meshes, const DecimateOptions& options) : meshes_(meshes) {
        const bool keeps_normals = options.frames.normals == NormalMode::keep;
        double longest = 0.0;
        for (const SceneMesh& mesh : meshes) {
            surfaces_.push_back({mesh.mesh, mesh.deformation, keeps_normals});
            const double scale = unit_space(mesh.mesh).scale;
            longest = std::max(longest, mesh.scale / scale);
            triangles_ += mesh.mesh.triangles.size();
        }
        if (meshes.size() == 1)
            scale_ = unit_space(meshes[0].mesh).scale / meshes[0].scale;
        else if (longest > 0.0)
            scale_ = std::ldexp(1.0, -(std::ilogb(longest) + 1));
    }

    [[nodiscard]] std::size_t size() const { return meshes_.size(); }
    [[nodiscard]] std::size_t triangles() const { return triangles_; }
    /// Maps lengths in the scene to those of points in edge collapses, within [-1, 1].
    [[nodiscard]] double scale() const { return scale_; }
    [[nodiscard]] const SceneMesh& operator[](std::size_t mesh) const { return meshes_[mesh]; }
    [[nodiscard]] const AttributedMesh& surface(std::size_t mesh) const { return surfaces_[mesh]; }

  private:
    std::span<const SceneMesh> meshes_;
    std::vector<AttributedMesh> surfaces_;
    std::size_t triangles_ = 0;
    double scale_ = 1.0;
};

/// The remaining triangles of each mesh of a scene.
struct SceneRemains {
    std::vector<Remains> meshes;
    std::vector<Report> reports;  ///< By mesh.
    Obstacles obstacles;
    std::optional<double> relaxed_part_error;  ///< As in Collapsed.

    [[nodiscard]] std::size_t count() const {
        std::size_t sum = 0;
        for (const Remains& mesh : meshes)
            sum += mesh.count();
        return sum;
    }
};

SceneRemains remains_of(const Scene& scene, const DecimateOptions& options) {
    SceneRemains result;
    result.reports.resize(scene.size());
    std::vector<PreparedMesh> prepared_meshes;
    std::vector<double> factors;
    std::size_t set_aside = 0;
    for (std::size_t m = 0; m < scene.size(); ++m) {
        factors.push_back(scene[m].scale * scene.scale() / unit_space(scene[m].mesh).scale);
        // The weights of attributes without a length are relative to the size of the scene.
        AttributeWeights weights = options.weights;
        for (double* weight : {&weights.normal, &weights.color, &weights.joint})
            *weight /= factors[m];
        prepared_meshes.push_back(prepared(scene.surface(m), options, weights,
                                           options.drop_parts / scene[m].scale, result.reports[m]));
        set_aside += prepared_meshes.back().set_aside.size();
    }
    const auto with_limits = [&](CollapseInput input) {
        if (options.triangles)
            input.triangles = *options.triangles - std::min(*options.triangles, set_aside);
        if (options.max_error) input.max_error = *options.max_error * scene.scale();
        input.for_picture = options.goal == DecimateGoal::picture;
        input.for_largest_distance = options.goal == DecimateGoal::largest_distance;
        return input;
    };
    std::vector<Collapsed> collapsed;
    if (scene.size() == 1) {
        collapsed.push_back(collapse_edges(with_limits(std::move(prepared_meshes[0].input))));
        result.obstacles = collapsed[0].obstacles;
        result.relaxed_part_error = collapsed[0].relaxed_part_error;
    } else {
        JoinedSurfaces joined(prepared_meshes, factors);
        const Collapsed all = collapse_edges(with_limits(joined.take()));
        collapsed = joined.separated(all);
        result.obstacles = all.obstacles;
        result.relaxed_part_error = all.relaxed_part_error;
    }
    for (std::size_t m = 0; m < scene.size(); ++m) {
        result.meshes.push_back(gathered_remains(scene[m].mesh, collapsed[m], prepared_meshes[m]));
    }
    return result;
}

/// The surfaces before and after a decimation.
std::array<Mesh, 2> compared_surfaces(const Mesh& mesh, const Remains& remains) {
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
    // Samples are measured from the first corner.
    for (Mesh* surface : {&before, &after}) {
        for (std::uint32_t t = 0; t < surface->triangles.size(); ++t)
            surface->triangles[t] = triangle_from(first_corner(*surface, t), surface->triangles);
    }
    return {std::move(before), std::move(after)};
}

double larger_max(const SurfaceDistance& distance) {
    return std::max(distance.from_a.max, distance.from_b.max);
}

/// Searches the fewest triangles within a measured distance. The errors of collapses only estimate
/// it, so two kinds of results are tried: those of limits of the errors, and, because the largest
/// distance may be that of few places, those of numbers of triangles.
class DistanceSearch {
  public:
    DistanceSearch(const Scene& scene, const DecimateOptions& options)
        : scene_(scene),
          options_(options),
          allowed_(*options.max_error + rounding / scene.scale()) {}

    SceneRemains result() {
        search_limits();
        if (!best_) {
            // Not even collapses without an error keep the distance.
            DecimateOptions all = options_;
            all.triangles = scene_.triangles();
            return remains_of(scene_, all);
        }
        if (*options_.max_error > 0.0 && !has_reached()) search_counts();
        return *std::move(best_);
    }

  private:
    static constexpr int max_limits = 9;
    static constexpr int max_counts = 10;
    static constexpr double well_used = 0.97;  ///< The part of the distance that is a good result.
    static constexpr double rounding = 2.5e-7;

    /// A limit and its distance.
    struct Tried {
        double limit, distance;
    };

    /// Decimates and measures. \return the distance; if it is above the limit, a part of it
    double attempt(const DecimateOptions& options) {
        SceneRemains remains = remains_of(scene_, options);
        const double distance = distance_of(remains);
        if (distance <= allowed_ && (!best_ || remains.count() <= best_->count()))
            best_ = std::move(remains);
        return distance;
    }

    double distance_of(SceneRemains& remains) const {
        double distance = 0.0;
        std::vector<std::array<Mesh, 2>> surfaces;
        for (std::size_t m = 0; m < scene_.size(); ++m) {
            surfaces.push_back(compared_surfaces(scene_[m].mesh, remains.meshes[m]));
            // Samples refuse most of the results that are too far away, at a fraction of the cost.
            const std::size_t samples =
                std::clamp<std::size_t>(surfaces[m][0].triangles.size() / 16, 1000, 20000);
            distance = std::max(
                distance, scene_[m].scale * larger_max(sampled_distance(
                                                surfaces[m][0], surfaces[m][1], samples, samples)));
        }
        for (std::size_t m = 0; m < scene_.size() && distance <= allowed_; ++m) {
            const SurfaceDistance exact = surface_distance(surfaces[m][0], surfaces[m][1]);
            if (const std::size_t omitted = exact.from_a.omitted + exact.from_b.omitted) {
                remains.reports[m].add(
                    "distance of crossing triangles", "mesh", 0,
                    fmt::format("is not measured at {} vertices and triangles", omitted));
            }
            distance = std::max(distance, scene_[m].scale * larger_max(exact));
        }
        return distance;
    }

    [[nodiscard]] bool has_reached() const {
        return options_.triangles && best_ && best_->count() <= *options_.triangles;
    }

    void search_limits() {
        DecimateOptions options = options_;
        std::optional<Tried> good, bad;  // The largest limit within the distance, and the smallest.
        for (int i = 0; i < max_limits; ++i) {
            const double limit = *options.max_error;
            const double distance = attempt(options);
            const bool is_within = distance <= allowed_;
            (is_within ? good : bad) = Tried{limit, distance};
            if (limit == 0.0 || has_reached()) return;
            if (is_within && distance >= well_used * *options_.max_error) return;
            if (good && bad && bad->limit < 1.03 * good->limit) return;
            double next = next_limit(good, bad);
            if (!(next < std::numeric_limits<double>::max())) return;
            if (i + 2 == max_limits && !good) next = 0.0;
            options.max_error = next;
        }
    }

    /// Interpolates logarithms, between limits that are known.
    [[nodiscard]] double next_limit(const std::optional<Tried>& good,
                                    const std::optional<Tried>& bad) const {
        const double aim = (1.0 + well_used) / 2.0 * *options_.max_error;
        const auto ratio = [&](const Tried& tried) {
            return tried.distance > 0.0 ? aim / tried.distance : 4.0;
        };
        if (!bad) return good->limit * std::clamp(ratio(*good), 1.05, 4.0);
        if (!good) return bad->limit * std::clamp(0.9 * ratio(*bad), 0.25, 0.9);
        if (good->limit == 0.0) return bad->limit / 4.0;
        // With distances that do not grow with the limit, this is the middle.
        double part = 0.5;
        if (good->distance > 0.0 && bad->distance > good->distance) {
            part =
                portable::log(aim / good->distance) / portable::log(bad->distance / good->distance);
        }
        return good->limit *
               portable::exp(std::clamp(part, 0.2, 0.8) * portable::log(bad->limit / good->limit));
    }

    /// Tries smaller numbers of triangles than that of the best result, by steps that shrink.
    void search_counts() {
        DecimateOptions options = options_;
        options.max_error.reset();
        const std::size_t least = options_.triangles.value_or(0);
        double step = 0.75;
        for (int i = 0; i < max_counts && !has_reached(); ++i) {
            const auto count = static_cast<double>(best_->count());
            options.triangles = std::max(static_cast<std::size_t>(step * count), least);
            const std::size_t before = best_->count();
            if (*options.triangles >= before) return;
            attempt(options);
            if (best_->count() < before) continue;
            if (step > 0.95) return;
            step = std::sqrt(step);
        }
    }

    const Scene& scene_;
    const DecimateOptions& options_;
    double allowed_;
    std::optional<SceneRemains> best_;
};

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

/// Names the reasons why no more vertices can be removed, the most frequent first.
std::string obstacles_text(const Obstacles& obstacles) {
    std::array<std::pair<std::size_t, const char*>, 5> reasons = {
        std::pair{obstacles.lines, "vertices where seams, hard edges or borders meet or are kept"},
        {obstacles.parts, "vertices whose part would lose its shape"},
        {obstacles.folds, "vertices whose triangles would turn over"},
        {obstacles.non_manifold, "vertices at non-manifold edges"},
        {obstacles.limits, "vertices that would exceed the maximum error"}};
    std::stable_sort(reasons.begin(), reasons.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::string text;
    for (const auto& [count, reason] : reasons) {
        if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, reason);
    }
    return text.empty() ? "the shape allows no fewer" : text;
}

/// Returns the normal of a triangle with length 1, or zero if it has none.
glm::dvec3 unit_normal(const Mesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a(mesh.positions[t.x]);
    const glm::dvec3 cross =
        glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
    const double length = glm::length(cross);
    return length > 0.0 && std::isfinite(length) ? cross / length : glm::dvec3(0.0);
}

/// The normals of a mesh's triangles at the positions that a decimated mesh uses.
class TrianglesAtPositions {
  public:
    TrianglesAtPositions(const Mesh& original, const FramedMesh& result)
        : classes_(weld_positions(original.positions)), first_(original.positions.size() + 1, 0) {
        std::vector<bool> is_used(original.positions.size(), false);
        for (const std::uint32_t source : result.source_vertex)
            is_used[classes_[source]] = true;
        // Calls visit() with the position and the normal.
        const auto visit_all = [&](const auto& visit) {
            for (const glm::uvec3& triangle : original.triangles) {
                const glm::uvec3 at(classes_[triangle.x], classes_[triangle.y],
                                    classes_[triangle.z]);
                if (!is_used[at.x] && !is_used[at.y] && !is_used[at.z]) continue;
                const glm::dvec3 normal = unit_normal(original, triangle);
                if (normal == glm::dvec3(0.0)) continue;
                for (int i = 0; i < 3; ++i) {
                    if (is_used[at[i]]) visit(at[i], normal);
                }
            }
        };
        visit_all([&](std::uint32_t at, const glm::dvec3&) { ++first_[at + 1]; });
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        normals_.resize(first_.back());
        std::vector<std::size_t> next = first_;
        visit_all(
            [&](std::uint32_t at, const glm::dvec3& normal) { normals_[next[at]++] = normal; });
    }

    /// Returns the normals at the position of a vertex of the original.
    [[nodiscard]] std::span<const glm::dvec3> normals(std::uint32_t vertex) const {
        const std::uint32_t at = classes_[vertex];
        return std::span(normals_).subspan(first_[at], first_[at + 1] - first_[at]);
    }

  private:
    std::vector<std::uint32_t> classes_;
    std::vector<std::size_t> first_;  ///< By position, the index of the first one of normals_.
    std::vector<glm::dvec3> normals_;
};

}  // namespace

std::vector<FramedMesh> decimated(std::span<const SceneMesh> meshes, const DecimateOptions& options,
                                  std::span<Report> reports, Report& scene_report) {
    if (reports.size() != meshes.size())
        throw InvalidInput(
            fmt::format("there are {} meshes, but {} reports", meshes.size(), reports.size()));
    for (const SceneMesh& mesh : meshes) {
        check(mesh.mesh, mesh.deformation, options);
        if (!(mesh.scale > 0.0 && std::isfinite(mesh.scale)))
            throw InvalidInput(fmt::format(
                "the scale of a mesh is {}, but must be finite and above 0", mesh.scale));
    }
    if (meshes.empty()) return {};
    const Scene scene(meshes, options);
    const SceneRemains remains =
        options.max_error ? DistanceSearch(scene, options).result() : remains_of(scene, options);
    // One interior move removes two triangles and their layers, so the result may be less than
    // requested.
    if (options.triangles && !options.max_error && remains.count() > *options.triangles)
        scene_report.add(
            "number of triangles out of reach", "mesh", 0,
            fmt::format("{} are left: {}", remains.count(), obstacles_text(remains.obstacles)));
    if (remains.relaxed_part_error) {
        scene_report.add(
            "small parts lose their shape", "mesh", 0,
            fmt::format("to reach the number of triangles, connected parts have errors "
                        "of up to {:g} % of their size",
                        100.0 * *remains.relaxed_part_error));
    }
    std::vector<FramedMesh> results;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        reports[m].merge(remains.reports[m]);
        const Mesh& mesh = meshes[m].mesh;
        results.push_back(framed(mesh, gathered(mesh, remains.meshes[m], reports[m]),
                                 options.frames, reports[m]));
    }
    return results;
}

FramedMesh decimated(const Mesh& mesh, const DecimateOptions& options, Report& report,
                     const Deformation& deformation) {
    const SceneMesh input{mesh, deformation};
    Report own;
    std::vector<FramedMesh> results =
        decimated(std::span(&input, 1), options, std::span(&own, 1), own);
    report.merge(own);
    return std::move(results.front());
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
    const TrianglesAtPositions triangles_at(original, result);
    // The squared length between unit vectors grows with their angle, and is faster.
    std::vector<double> largest(decimated.triangles.size(), 0.0);
    parallel_for(largest.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::dvec3 normal = unit_normal(decimated, decimated.triangles[t]);
            if (normal == glm::dvec3(0.0)) continue;
            for (int i = 0; i < 3; ++i) {
                const std::uint32_t source = result.source_vertex[decimated.triangles[t][i]];
                const auto normals = triangles_at.normals(source);
                if (normals.empty() || normals.size() > max_valence) continue;
                double nearest = std::numeric_limits<double>::infinity();
                for (const glm::dvec3& candidate : normals) {
                    const glm::dvec3 difference = normal - candidate;
                    nearest = std::min(nearest, glm::dot(difference, difference));
                }
                largest[t] = std::max(largest[t], nearest);
            }
        }
    });
    if (largest.empty()) return 0.0;
    const double half_length =
        std::min(std::sqrt(*std::max_element(largest.begin(), largest.end())) / 2.0, 1.0);
    return 2.0 * portable::atan2(half_length, std::sqrt(1.0 - half_length * half_length));
}

}  // namespace relief
