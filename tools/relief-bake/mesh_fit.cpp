// SPDX-License-Identifier: Apache-2.0
// Checks whether high and low models belong together: their bounding boxes, and the share of texels
// whose rays hit nothing. Messages name the likely cause. Tests:
// tests/tools/relief_bake_models_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/text.h"
#include "mesh_bake.h"
#include "relief/mesh/bake_matching.h"

namespace relief::tools {
namespace {

constexpr double estimate_margin = 5.0;  // Error of the estimate, in percent points.

std::string high_name(const MeshBakeRequest& request) {
    return request.high.size() == 1 ? request.high[0].string()
                                    : counted(request.high.size(), "high model");
}

std::string to_text(const glm::dvec3& point) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", point.x, point.y, point.z);
}

/// "(0, 0, 0) to (1, 1, 1), diagonal 1.732", in world space.
std::string to_text(const Bounds& box, const glm::dvec3& origin) {
    if (box.empty()) return "empty";
    const glm::dvec3 min(box.min), max(box.max);
    return fmt::format("{} to {}, diagonal {:.4g}", to_text(min + origin), to_text(max + origin),
                       glm::length(max - min));
}

std::string describe_boxes(const MeshBakeRequest& request, const BakeFit& fit,
                           const glm::dvec3& origin) {
    const std::string cause = likely_cause(fit);
    return fmt::format("the bounding box of {} is {}; that of {} is {}{}{}", high_name(request),
                       to_text(fit.high, origin), request.low.string(), to_text(fit.low, origin),
                       cause.empty() ? "" : "; ", cause);
}

FileError mismatch_error(const MeshBakeRequest& request, const BakeMismatch& mismatch,
                         const glm::dvec3& origin) {
    const BakeFit& fit = mismatch.fit();
    const std::string part =
        mismatch.part().empty() ? "" : fmt::format("part '{}': ", mismatch.part());
    const std::string file = high_name(request);
    if (mismatch.kind() == BakeMismatch::Kind::no_surface) {
        return failure(file, part + "has no triangle with finite corners",
                       "nothing can be baked from it");
    }
    const std::string boxes = describe_boxes(request, fit, origin);
    if (mismatch.kind() == BakeMismatch::Kind::size) {
        const double ratio = fit.size_ratio;
        return failure(
            file,
            fmt::format("{}is {:.4g} times as {} as {}: {}", part, std::max(ratio, 1.0 / ratio),
                        ratio > 1.0 ? "large" : "small", request.low.string(), boxes),
            "scale one of them, or give --allow-size-mismatch");
    }
    return failure(file,
                   fmt::format("{}is {:.4g} away from {}, but rays are only {:.4g} long: {}", part,
                               fit.gap, request.low.string(), mismatch.reach(), boxes),
                   request.cage ? "move one of them, or move the cage outwards"
                                : "move one of them, or give a longer --offset and --max-distance");
}

/// A length rounded up to four digits, after adding a thousandth, so that it is never too short.
std::string length_text(double length) {
    const double longer = 1.001 * length;
    const double unit = std::pow(10.0, std::floor(std::log10(longer)) - 3.0);
    return fmt::format("{:.4g}", std::ceil(longer / unit) * unit);
}

/// "312 of them would be hit with --offset 0.12, half of those with 0.08"
std::string clipped_text(const ClippedRays& clipped, const std::string& remedy) {
    std::string text = fmt::format("{} of them would be hit with {} {}", clipped.texels, remedy,
                                   length_text(clipped.longest));
    if (clipped.half < clipped.longest)
        text += fmt::format(", half of those with {}", length_text(clipped.half));
    return text;
}

/// Describes the missed texels that longer rays, or rays that accept back faces, would hit.
std::vector<std::string> ray_lines(const MeshBakeRequest& request, const BakeResult& result) {
    std::vector<std::string> lines;
    if (result.clipped_outside.texels > 0) {
        lines.push_back(clipped_text(result.clipped_outside,
                                     request.cage ? "the cage moved outwards by" : "--offset"));
    }
    if (result.clipped_inside.texels > 0)
        lines.push_back(clipped_text(result.clipped_inside, "--max-distance"));
    if (result.missed_from_behind > 0) {
        lines.push_back(
            fmt::format("{} of them see only back faces of {} (flip its faces, or give "
                        "--back-faces take)",
                        result.missed_from_behind, high_name(request)));
    }
    return lines;
}

/// \param measured  the place of an estimate: " of a map of 256 x 256"; empty: the map itself
FileError missed_error(const MeshBakeRequest& request, const BakeModels& models,
                       const std::string& map, const BakeResult& result,
                       const std::string& measured) {
    const std::size_t all = result.texels_missed + result.texels_baked;
    const std::string share =
        result.texels_baked == 0
            ? fmt::format("no ray hits {}: all {} texels{} are missed", high_name(request), all,
                          measured)
            : fmt::format(
                  "the rays of {} of {} texels{} ({:.3g} %) hit nothing, more than the "
                  "{:g} % of --max-missed",
                  result.texels_missed, all, measured,
                  missed_percent(result.texels_missed, result.texels_baked),
                  request.missed_limit());
    std::string problem = fmt::format("{}{}{}; {}", map, map.empty() ? "" : ": ", share,
                                      describe_fit(request, models));
    for (const std::string& line : ray_lines(request, result))
        problem += "; " + line;
    return failure(request.low, problem,
                   result.texels_baked == 0 ? "nothing is written"
                                            : "nothing is written; --max-missed allows more");
}

bool misses_too_much(const BakeResult& result, double limit) {
    if (result.texels_missed == 0) return false;
    return result.texels_baked == 0 ||
           missed_percent(result.texels_missed, result.texels_baked) > limit;
}

}  // namespace

double missed_percent(std::size_t missed, std::size_t baked) {
    return missed == 0 ? 0.0
                       : 100.0 * static_cast<double>(missed) / static_cast<double>(missed + baked);
}

Baker make_baker(const MeshBakeRequest& request, const BakeModels& models,
                 const BakeOptions& options, Report& report) {
    try {
        if (models.pairs.empty()) return {models.high, models.low, options, report};
        std::vector<BakePart> parts;
        for (const BakePair& pair : models.pairs) {
            parts.push_back({std::span(models.high).subspan(pair.first_high, pair.high_count),
                             pair.low, pair.name});
        }
        return {parts, models.low, options, report};
    } catch (const BakeMismatch& mismatch) {
        throw mismatch_error(request, mismatch, models.origin);
    }
}

std::string describe_fit(const MeshBakeRequest& request, const BakeModels& models) {
    return describe_boxes(request, compare_boxes(models.high, models.low), models.origin);
}

void check_missed(const MeshBakeRequest& request, const BakeModels& models, const std::string& map,
                  const BakeResult& result) {
    if (misses_too_much(result, request.missed_limit()))
        throw missed_error(request, models, map, result, "");
}

void check_missed_early(const MeshBakeRequest& request, const BakeModels& models,
                        const Baker& baker, const BakeMapOptions& map, const std::string& name) {
    const double limit = request.missed_limit() + estimate_margin;
    if (limit >= 100.0) return;
    // The estimate is not faster than the bake of a small map, but faster than trials.
    const double texels = static_cast<double>(map.width) * static_cast<double>(map.height);
    if (!request.needs_trials() && texels <= 2.0 * estimate_texels) return;
    const MissedEstimate estimate = estimate_missed(baker, map);
    if (!misses_too_much(estimate.result, limit)) return;
    throw missed_error(request, models, name, estimate.result,
                       fmt::format(" of a map of {} x {}", estimate.width, estimate.height));
}

std::vector<std::string> missed_lines(const MeshBakeRequest& request, const BakeResult& result,
                                      const glm::dvec3& origin) {
    constexpr std::size_t max_places = 4;
    std::vector<std::string> lines;
    if (result.texels_missed == 0) return lines;
    std::string places;
    for (std::size_t i = 0; i < std::min(max_places, result.first_missed.size()); ++i) {
        const MissedTexel& texel = result.first_missed[i];
        places += fmt::format("{}({}, {}) at {}", i == 0 ? "" : "; ", texel.x, texel.y,
                              to_text(texel.position + origin));
    }
    if (result.texels_missed > max_places) places += "; ...";
    lines.push_back(fmt::format("{}, {:.3g} % of those covered: {}",
                                counted(result.texels_missed, "texel"),
                                missed_percent(result.texels_missed, result.texels_baked), places));
    std::ranges::move(ray_lines(request, result), std::back_inserter(lines));
    return lines;
}

std::string swapped_models_warning(const MeshBakeRequest& request, std::size_t high_triangles,
                                   std::size_t low_triangles) {
    if (low_triangles / 4 <= high_triangles) return "";
    return fmt::format(
        "{}: has {}, more than four times as many as the high model, {} (are they swapped? "
        "HIGH comes before LOW)",
        request.low.string(), counted(low_triangles, "triangle"), high_triangles);
}

}  // namespace relief::tools
