// SPDX-License-Identifier: Apache-2.0
// Puts the parts of a diagnosis together. Tests: tests/mesh/geometry/health/diagnose_test.cpp.
#include "relief/mesh/diagnose.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "geometry/direction.h"
#include "geometry/health/diagnose_parts.h"
#include "geometry/health/texture_overlap.h"
#include "parallel.h"

namespace relief {
namespace {

constexpr std::size_t small_mesh = 2048;

// What is coarser than this part of its size keeps fewer than 16 of a float's 24 bits: steps that
// show in shading and in the image.
constexpr float coarsest = 1.0F / 65536.0F;

/// The box of all finite points, and how coarse floats are out there.
template <int N>
struct PointExtent {
    float size = 0.0F;     ///< The longest side.
    float spacing = 0.0F;  ///< Between neighbouring floats at the largest coordinate.

    explicit PointExtent(std::span<const glm::vec<N, float>> points) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        glm::vec<N, float> low(infinity);
        glm::vec<N, float> high(-infinity);
        for (const auto& point : points) {
            if (!is_finite(point)) continue;
            low = glm::min(low, point);
            high = glm::max(high, point);
        }
        if (!(low.x <= high.x)) return;
        float farthest = 0.0F;
        for (int i = 0; i < N; ++i) {
            farthest = std::max({farthest, std::abs(low[i]), std::abs(high[i])});
            // Half of each: the difference of two large floats may overflow.
            const float side = 0.5F * high[i] - 0.5F * low[i];
            size = std::max(size, std::min(side, 0x1.fffffep126F) * 2.0F);
        }
        spacing = farthest - std::nextafter(farthest, 0.0F);
    }

    [[nodiscard]] bool is_far() const { return size > 0.0F && spacing > coarsest * size; }
};

void diagnose_places(const Mesh& mesh, Diagnosis& diagnosis, Tally& tally) {
    const PointExtent<3> positions(mesh.positions);
    diagnosis.size = positions.size;
    diagnosis.spacing = positions.spacing;
    if (positions.is_far()) tally.add(MeshCondition::mesh_far_away, 0);
    if (PointExtent<2>(mesh.texcoords).is_far()) tally.add(MeshCondition::texture_far_away, 0);
}

/// The triangles that have an area in space; others are moved together, so that they have none in
/// the image either.
std::vector<glm::uvec3> drawn_triangles(const Subject& subject) {
    std::vector<glm::uvec3> triangles = subject.mesh.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (!has_area(subject.shapes[t])) triangles[t] = glm::uvec3(triangles[t].x);
    }
    return triangles;
}

void diagnose_overlap(const Subject& subject, Diagnosis& diagnosis, Tally& tally) {
    const TextureOverlap overlap =
        texture_overlap(subject.mesh.texcoords, drawn_triangles(subject));
    diagnosis.overlap_raster = overlap.raster;
    for (std::size_t t = 0; t < overlap.overlapping.size(); ++t) {
        if (overlap.overlapping[t] != 0) tally.add(MeshCondition::texture_overlapping, t);
    }
}

}  // namespace

Tally::Tally(std::size_t listed) : listed_(listed) {
    for (const MeshConditionInfo& condition : mesh_conditions())
        conditions_.push_back({condition.condition, 0, {}});
}

void Tally::add(MeshCondition condition, std::size_t index) {
    FoundCondition& found = conditions_[static_cast<std::size_t>(condition)];
    ++found.count;
    if (found.first.size() < listed_ && (found.first.empty() || found.first.back() != index))
        found.first.push_back(index);
}

void Tally::merge(const Tally& other) {
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
        if (other.conditions_[i].count != 0) conditions_[i] = other.conditions_[i];
    }
}

std::vector<FoundCondition> Tally::found() const {
    std::vector<FoundCondition> found;
    std::copy_if(conditions_.begin(), conditions_.end(), std::back_inserter(found),
                 [](const FoundCondition& condition) { return condition.count != 0; });
    return found;
}

std::size_t Diagnosis::count(MeshCondition condition) const {
    for (const FoundCondition& one : found) {
        if (one.condition == condition) return one.count;
    }
    return 0;
}

bool Diagnosis::has_trouble() const {
    return std::any_of(found.begin(), found.end(), [](const FoundCondition& one) {
        return condition_info(one.condition).severity == Severity::trouble;
    });
}

Diagnosis diagnose(const Mesh& mesh, const DiagnoseOptions& options) {
    validate(mesh);
    const Subject subject(mesh);
    Diagnosis diagnosis;
    const std::vector<std::function<void(Tally&)>> parts = {
        [&](Tally& tally) { diagnose_triangles(subject, tally); },
        [&](Tally& tally) {
            if (options.edges) diagnose_edges(subject, tally);
        },
        [&](Tally& tally) { diagnose_vertices(subject, tally); },
        [&](Tally& tally) {
            if (options.near_duplicates) diagnose_near_duplicates(subject, tally);
        },
        [&](Tally& tally) { diagnose_frames(subject, tally); },
        [&](Tally& tally) { diagnose_texture(subject, tally); },
        [&](Tally& tally) {
            if (options.texture_overlap && !mesh.texcoords.empty())
                diagnose_overlap(subject, diagnosis, tally);
        },
        [&](Tally& tally) { diagnose_places(mesh, diagnosis, tally); },
    };
    std::vector<Tally> tallies(parts.size(), Tally(options.listed));
    std::vector<std::function<void()>> tasks;
    for (std::size_t i = 0; i < parts.size(); ++i)
        tasks.emplace_back([&, i] { parts[i](tallies[i]); });
    parallel_tasks(tasks, mesh.triangles.size() < small_mesh);

    Tally all(options.listed);
    for (const Tally& tally : tallies)
        all.merge(tally);
    diagnosis.found = all.found();
    return diagnosis;
}

Finding to_finding(const FoundCondition& found) {
    const MeshConditionInfo& words = condition_info(found.condition);
    return {std::string(words.word), std::string(words.element), std::string(words.meaning),
            found.count, found.first};
}

Report to_report(const Diagnosis& diagnosis, std::optional<Severity> severity) {
    Report report;
    for (const FoundCondition& one : diagnosis.found) {
        if (!severity || condition_info(one.condition).severity == *severity)
            report.add(to_finding(one));
    }
    return report;
}

}  // namespace relief
