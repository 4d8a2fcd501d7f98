// SPDX-License-Identifier: Apache-2.0
// Measures how well the surfaces of a bake agree, with a few rays before any texel is baked, and
// searches for a scale or a shift of the high meshes that explains a difference. Tests:
// tests/mesh/bake/agreement_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "bake/bake_work.h"
#include "geometry/direction.h"

namespace relief::detail {
namespace {

constexpr std::size_t sample_count = 1024;
constexpr std::size_t max_triangles = 65536;  // Of larger meshes, every n-th triangle is sampled.

// Pairs that agree at least as well as this need no explanation.
constexpr double small_angle = 8.0 * std::numbers::pi / 180.0;
constexpr double small_distance = 0.01;  // Of half of the low box's diagonal.
// A correction explains a difference if it leaves at most these parts of it.
constexpr double max_angle_left = 0.75;
constexpr double max_distance_left = 0.25;
/// A correction that scales, or a later candidate, must be better by this factor.
constexpr double better = 0.8;
/// Larger differences are reported even if no correction explains them.
constexpr double large_angle = 35.0 * std::numbers::pi / 180.0;
constexpr double large_distance = 0.05;
/// Ratios of sizes within this factor are differences of detail.
constexpr double same_size = 1.02;

double area_of(std::span<const glm::vec3> positions, const glm::uvec3& triangle,
               glm::dvec3& cross) {
    const glm::uvec3 t =
        from_first_position(positions, triangle);  // As HighSurface::face_normal().
    const glm::dvec3 a(positions[t.x]);
    cross = glm::cross(glm::dvec3(positions[t.y]) - a, glm::dvec3(positions[t.z]) - a);
    const double area = glm::length(cross);
    return std::isfinite(area) ? area : 0.0;
}

std::size_t stride_of(std::size_t triangles) {
    return triangles / max_triangles + 1;
}

/// A point on the low mesh, its line, and the unit normal of its triangle.
struct Sample {
    const SeenSurface* surface = nullptr;
    ProjectionLine line;
    glm::dvec3 normal{0.0};
};

/// Returns points that are distributed over the area of the low mesh: within a triangle by the
/// two-dimensional golden ratio sequence.
std::vector<Sample> samples_on(const BakeParts& parts, const LowSurface& low) {
    const Mesh& mesh = low.mesh();
    const std::size_t stride = stride_of(mesh.triangles.size());
    std::vector<double> areas;
    glm::dvec3 cross;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += stride)
        areas.push_back(area_of(mesh.positions, mesh.triangles[t], cross));
    std::partial_sum(areas.begin(), areas.end(), areas.begin());
    std::vector<Sample> samples;
    if (areas.empty() || !(areas.back() > 0.0)) return samples;
    Report ignored;
    for (std::size_t i = 0; i < sample_count; ++i) {
        const auto k = static_cast<double>(i);
        const double at = areas.back() * (k + 0.5) / static_cast<double>(sample_count);
        const auto found = std::upper_bound(areas.begin(), areas.end(), at);
        const auto index = static_cast<std::size_t>(found - areas.begin()) * stride;
        if (found == areas.end()) continue;
        double second = std::fmod(0.5 + k * 0.7548776662466927, 1.0);
        double third = std::fmod(0.5 + k * 0.5698402909980532, 1.0);
        if (second + third > 1.0) {
            second = 1.0 - second;
            third = 1.0 - third;
        }
        CoveredTexel texel;
        texel.triangle = static_cast<std::uint32_t>(index);
        // The weights stay positive if they are rounded.
        texel.second = static_cast<float>(0.999 * second);
        texel.third = static_cast<float>(0.999 * third);
        const SeenSurface& surface = parts.surface_of(texel.triangle);
        Sample sample{&surface, low.line(texel, surface.distances, 0, ignored), glm::dvec3(0.0)};
        const double area = area_of(mesh.positions, mesh.triangles[index], cross);
        sample.normal = cross / area;
        if (sample.line.outside >= 0.0) samples.push_back(sample);
    }
    return samples;
}

/// Maps points of the low mesh to the high meshes.
struct Similarity {
    double scale = 1.0;
    glm::dvec3 from{0.0};
    glm::dvec3 to{0.0};

    [[nodiscard]] ProjectionLine operator()(ProjectionLine line) const {
        line.point = scale * (line.point - from) + to;
        line.outside *= scale;
        line.inside *= scale;
        return line;
    }
};

/// Casts the rays of a bake at the samples. Back faces count with 90 degrees. Rays that hit nothing
/// count with their length, but have no angle: they may only be too short.
BakeAgreement measure(std::span<const Sample> samples, const Similarity& placement,
                      BackFaces back_faces) {
    // Grouped in the order of the samples, so that sums do not depend on addresses.
    std::vector<std::pair<const SeenSurface*, std::vector<std::size_t>>> by_surface;
    std::map<const SeenSurface*, std::size_t> group_of;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const SeenSurface* surface = samples[i].surface;
        const auto [group, is_new] = group_of.emplace(surface, by_surface.size());
        if (is_new) by_surface.push_back({surface, {}});
        by_surface[group->second].second.push_back(i);
    }
    constexpr double right_angle = std::numbers::pi / 2.0;
    std::vector<double> distances(samples.size());
    double angles = 0.0;
    BakeAgreement result;
    result.samples = samples.size();
    for (const auto& [surface, indices] : by_surface) {
        std::vector<ProjectionLine> lines;
        for (const std::size_t i : indices)
            lines.push_back(placement(samples[i].line));
        std::vector<ProjectedPoint> points(lines.size());
        Projection(surface->high.scene(), back_faces).find(lines, points);
        for (std::size_t k = 0; k < lines.size(); ++k) {
            const std::size_t i = indices[k];
            const RayHit& hit = points[k].hit;
            distances[i] = hit.is_hit() ? std::abs(points[k].height)
                                        : std::max(lines[k].outside, lines[k].inside);
            distances[i] /= placement.scale;
            if (!hit.is_hit()) {
                ++result.missed;
                const RayHit any = surface->high.scene().nearest(from_outside(lines[k]));
                result.from_behind += any.is_hit() ? 1 : 0;
                continue;
            }
            if (!hit.faces_origin) {
                ++result.from_behind;
                angles += right_angle;
                continue;
            }
            const double angle = angle_between(samples[i].normal, surface->high.face_normal(hit));
            angles += std::min(angle, right_angle);
        }
    }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    result.median_distance = *middle;
    const std::size_t hits = result.samples - result.missed;
    result.mean_angle = hits > 0 ? angles / static_cast<double>(hits) : right_angle;
    return result;
}

/// The center of a surface, and the root mean square distance of its area from it.
class Moments {
  public:
    void add(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
        const std::size_t stride = stride_of(triangles.size());
        glm::dvec3 cross;
        for (std::size_t i = 0; i < triangles.size(); i += stride) {
            const glm::uvec3& t = triangles[i];
            const double area = static_cast<double>(stride) * area_of(positions, t, cross);
            if (!(area > 0.0)) continue;
            const glm::dvec3 center = (glm::dvec3(positions[t.x]) + glm::dvec3(positions[t.y]) +
                                       glm::dvec3(positions[t.z])) /
                                      3.0;
            area_ += area;
            first_ += area * center;
            second_ += area * glm::dot(center, center);
        }
    }
    [[nodiscard]] bool empty() const { return !(area_ > 0.0); }
    [[nodiscard]] glm::dvec3 center() const { return first_ / area_; }
    [[nodiscard]] double radius() const {
        return std::sqrt(std::max(second_ / area_ - glm::dot(center(), center()), 0.0));
    }

  private:
    double area_ = 0.0;
    glm::dvec3 first_{0.0};
    double second_ = 0.0;
};

glm::dvec3 center_of(const Bounds& box) {
    return 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
}

/// Returns the corrections to try, by the boxes and by the areas of both surfaces: shifts, then
/// scales.
std::vector<Similarity> candidates_of(const BakeParts& parts, const LowSurface& low,
                                      std::span<const Sample> samples) {
    const BakeFit fit = parts.fit();
    Moments of_low;
    of_low.add(low.mesh().positions, low.mesh().triangles);
    Moments of_high;
    std::vector<const SeenSurface*> seen;
    for (const Sample& sample : samples) {
        if (std::find(seen.begin(), seen.end(), sample.surface) != seen.end()) continue;
        seen.push_back(sample.surface);
        for (const RayMesh& mesh : sample.surface->high.scene().meshes())
            of_high.add(mesh.positions, mesh.triangles);
    }
    std::vector<Similarity> candidates;
    if (fit.high.empty() || of_low.empty() || of_high.empty()) return candidates;
    const glm::dvec3 low_box = center_of(fit.low);
    const glm::dvec3 high_box = center_of(fit.high);
    candidates.push_back({1.0, low_box, high_box});
    candidates.push_back({1.0, of_low.center(), of_high.center()});
    candidates.push_back({fit.size_ratio, low_box, high_box});
    if (of_low.radius() > 0.0 && of_high.radius() > 0.0) {
        candidates.push_back(
            {of_high.radius() / of_low.radius(), of_low.center(), of_high.center()});
    }
    return candidates;
}

std::string to_text(const glm::dvec3& v) {
    return fmt::format("({:.3g}, {:.3g}, {:.3g})", v.x, v.y, v.z);
}

}  // namespace

BakeAgreement agreement_of(const BakeParts& parts, const LowSurface& low,
                           const BakeOptions& options) {
    const std::vector<Sample> samples = samples_on(parts, low);
    if (samples.empty()) return {};
    BakeAgreement agreement = measure(samples, {}, options.back_faces);
    agreement.half_diagonal = 0.5 * diagonal(parts.fit().low);
    if (agreement.mean_angle <= small_angle ||
        agreement.median_distance <= small_distance * agreement.half_diagonal)
        return agreement;
    double best = max_angle_left * agreement.mean_angle / better;
    for (const Similarity& candidate : candidates_of(parts, low, samples)) {
        const BakeAgreement corrected = measure(samples, candidate, options.back_faces);
        if (corrected.median_distance > max_distance_left * agreement.median_distance ||
            corrected.mean_angle > better * best || corrected.missed > agreement.missed)
            continue;
        best = corrected.mean_angle;
        agreement.correction = {candidate.scale, candidate.to - candidate.from,
                                corrected.median_distance, corrected.mean_angle};
    }
    return agreement;
}

void report_agreement(const BakeAgreement& agreement, const BakeOptions& options, Report& report) {
    if (const std::optional<BakeCorrection>& correction = agreement.correction) {
        const double ratio = std::max(correction->scale, 1.0 / correction->scale);
        if (ratio > same_size && options.allow_size_mismatch) return;
        if (ratio > same_size) {
            const std::string units = unit_cause(correction->scale);
            report.add("high model of another size", "model", 0,
                       fmt::format("is about {:.3g} times as {} as the low one, which explains "
                                   "most of their difference{}{}{}; scale one of them",
                                   ratio, correction->scale > 1.0 ? "large" : "small",
                                   units.empty() ? "" : " (", units, units.empty() ? "" : ")"));
            return;
        }
        report.add("high model at another position", "model", 0,
                   fmt::format("is moved by {} from the low one, which explains most of their "
                               "difference; move one of them",
                               to_text(correction->shift)));
        return;
    }
    if (agreement.mean_angle > large_angle &&
        agreement.median_distance > large_distance * agreement.half_diagonal) {
        report.add("surfaces that do not agree", "model", 0,
                   fmt::format("differ by {:.0f} degrees and {:.0f} % of the low model's half "
                               "diagonal: do the models belong together?",
                               agreement.mean_angle * 180.0 / std::numbers::pi,
                               100.0 * agreement.median_distance / agreement.half_diagonal));
    }
}

}  // namespace relief::detail
