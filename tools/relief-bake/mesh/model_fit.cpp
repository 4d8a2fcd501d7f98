// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_bake_fit_test.cpp.
#include "mesh/model_fit.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/options.h"
#include "common/text.h"

namespace relief::tools {
namespace {

constexpr double default_max_missed = 50.0;  // Percent.
constexpr double early_margin = 5.0;         // Percent points that a small map may be off.
constexpr double early_texels = 65536.0;     // Of a small map.

struct UnitPair {
    double ratio;
    const char* small;
    const char* large;
};
/// 1 of the large unit is `ratio` of the small one.
constexpr std::array unit_pairs = {
    UnitPair{2.54, "centimeters", "inches"},      UnitPair{3.2808399, "feet", "meters"},
    UnitPair{10.0, "millimeters", "centimeters"}, UnitPair{12.0, "inches", "feet"},
    UnitPair{25.4, "millimeters", "inches"},      UnitPair{30.48, "centimeters", "feet"},
    UnitPair{39.370079, "inches", "meters"},      UnitPair{100.0, "centimeters", "meters"},
    UnitPair{304.8, "millimeters", "feet"},       UnitPair{1000.0, "millimeters", "meters"}};

std::string high_name(const MeshBakeRequest& request) {
    return request.high.size() == 1 ? request.high[0].string()
                                    : counted(request.high.size(), "high model");
}

glm::dvec3 box_size(const Bounds& box) {
    return glm::dvec3(box.max) - glm::dvec3(box.min);
}

std::string point_words(const glm::dvec3& point) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", point.x, point.y, point.z);
}

/// "(0, 0, 0) to (1, 1, 1), diagonal 1.732", in the world.
std::string box_words(const Bounds& box, const glm::dvec3& origin) {
    if (box.empty()) return "empty";
    return fmt::format("{} to {}, diagonal {:.4g}", point_words(glm::dvec3(box.min) + origin),
                       point_words(glm::dvec3(box.max) + origin), glm::length(box_size(box)));
}

std::string boxes_words(const MeshBakeRequest& request, const BakeFit& fit,
                        const glm::dvec3& origin) {
    return fmt::format("the box of {} is {}; that of {} is {}", high_name(request),
                       box_words(fit.high, origin), request.low.string(),
                       box_words(fit.low, origin));
}

/// Units in which the same model would have these sizes; empty where none explain the ratio.
std::string unit_words(double size_ratio) {
    const double ratio = std::max(size_ratio, 1.0 / size_ratio);
    for (const UnitPair& pair : unit_pairs) {
        if (std::abs(std::log(ratio / pair.ratio)) > std::log(1.05)) continue;
        const bool high_is_larger = size_ratio > 1.0;
        return fmt::format("is the high model in {} and the low one in {}?",
                           high_is_larger ? pair.small : pair.large,
                           high_is_larger ? pair.large : pair.small);
    }
    return "";
}

/// Names the likely mistake of the export, as far as the boxes show it; empty if none fits.
std::string cause_words(const BakeFit& fit) {
    if (fit.low.empty() || fit.high.empty()) return "";
    const std::string units = unit_words(fit.size_ratio);
    if (!units.empty()) return units;
    if (fit.fits_turned) return "is one of them Y up and the other Z up?";
    const glm::dvec3 moved = 0.5 * (glm::dvec3(fit.high.max) + glm::dvec3(fit.high.min) -
                                    glm::dvec3(fit.low.max) - glm::dvec3(fit.low.min));
    const bool is_alike = fit.size_ratio < 1.25 && fit.size_ratio > 0.8;
    const bool is_moved = glm::length(moved) > 0.1 * glm::length(box_size(fit.low));
    if (is_moved) {
        return fmt::format(
            "the high model is moved by {}{}: was one of them exported without its "
            "transform?",
            point_words(moved), is_alike ? ", and as large as the low one" : "");
    }
    return fit.differs_in_size()
               ? "are they in different units, or was one exported without its scale?"
               : "";
}

FileError mismatch_error(const MeshBakeRequest& request, const BakeMismatch& mismatch,
                         const glm::dvec3& origin) {
    const BakeFit& fit = mismatch.fit();
    const std::string part =
        mismatch.part().empty() ? "" : fmt::format("part '{}': ", mismatch.part());
    const std::string file = high_name(request);
    if (mismatch.kind() == BakeMismatch::Kind::no_surface) {
        return failure(file, part + "has no triangle whose corners are finite",
                       "nothing can be baked from it");
    }
    const std::string boxes = boxes_words(request, fit, origin);
    std::string cause = cause_words(fit);
    if (!cause.empty()) cause = "; " + cause;
    if (mismatch.kind() == BakeMismatch::Kind::size) {
        const double ratio = fit.size_ratio;
        return failure(
            file,
            fmt::format("{}is {:.4g} times as {} as {}: {}{}", part, std::max(ratio, 1.0 / ratio),
                        ratio > 1.0 ? "large" : "small", request.low.string(), boxes, cause),
            "scale one of them, or give --allow-size-mismatch");
    }
    const char* const longer =
        request.cage ? "or move the cage outwards" : "or give a longer --offset and --max-distance";
    return failure(file,
                   fmt::format("{}lies {:.4g} away from {}, but rays reach only {:.4g}: {}{}", part,
                               fit.gap, request.low.string(), mismatch.reach(), boxes, cause),
                   fmt::format("move one of them, {}", longer));
}

/// A length that is longer by a thousandth, in four digits: no rounding makes it too short.
std::string length_words(double length) {
    const double longer = 1.001 * length;
    const double unit = std::pow(10.0, std::floor(std::log10(longer)) - 3.0);
    return fmt::format("{:.4g}", std::ceil(longer / unit) * unit);
}

/// "312 of them would be hit with --offset 0.12, half of those with 0.08"
std::string clipped_words(const ClippedRays& clipped, const std::string& remedy) {
    std::string words = fmt::format("{} of them would be hit with {} {}", clipped.texels, remedy,
                                    length_words(clipped.longest));
    if (clipped.half < clipped.longest)
        words += fmt::format(", half of those with {}", length_words(clipped.half));
    return words;
}

/// Describes the hits of missed texels that lie beyond the ray length or are seen from behind.
std::vector<std::string> ray_lines(const MeshBakeRequest& request, const BakeResult& result) {
    std::vector<std::string> lines;
    if (result.clipped_outside.texels > 0) {
        lines.push_back(clipped_words(result.clipped_outside,
                                      request.cage ? "the cage outwards by" : "--offset"));
    }
    if (result.clipped_inside.texels > 0)
        lines.push_back(clipped_words(result.clipped_inside, "--max-distance"));
    if (result.missed_from_behind > 0) {
        lines.push_back(fmt::format(
            "{} of them see {} only from behind (turn its faces round, or give --back-faces take)",
            result.missed_from_behind, high_name(request)));
    }
    return lines;
}

nlohmann::ordered_json point_json(const glm::dvec3& point) {
    return {point.x, point.y, point.z};
}

nlohmann::ordered_json clipped_json(const ClippedRays& clipped) {
    return {{"texels", clipped.texels},
            {"shortest", clipped.shortest},
            {"half", clipped.half},
            {"longest", clipped.longest}};
}

/// \param measured  where the share was measured, if not on the map: "on 256 x 256 texels"
FileError missed_error(const MeshBakeRequest& request, const BakeModels& models,
                       const std::string& map, const BakeResult& result,
                       const std::string& measured) {
    const std::size_t all = result.texels_missed + result.texels_baked;
    const std::string share =
        result.texels_baked == 0
            ? fmt::format("no ray hits {}: all {} texels{} are missed", high_name(request), all,
                          measured)
            : fmt::format(
                  "{} of {} texels{} ({:.3g} %) are missed by their rays, more than the "
                  "{:g} % of --max-missed",
                  result.texels_missed, all, measured,
                  missed_percent(result.texels_missed, result.texels_baked), missed_limit(request));
    std::string problem =
        fmt::format("{}{}{}; {}", map, map.empty() ? "" : ": ", share, fit_words(request, models));
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

void add_fit_options(CLI::App& app, MeshBakeRequest& request, const std::string& consequence) {
    add_number(app, "--max-missed", "PERCENT", request.max_missed, {0.0, 100.0, "percent"},
               fmt::format("The rays of so many of the texels that LOW covers may hit nothing: {}. "
                           "Default: {:g}.",
                           consequence, default_max_missed))
        .group("Rays");
    add_switch(app, "--allow-size-mismatch", request.allow_size_mismatch,
               fmt::format("Take models whose boxes differ in size by more than {:g} times, which "
                           "is an error otherwise.",
                           max_size_ratio))
        .group("Rays");
}

double missed_limit(const MeshBakeRequest& request) {
    return request.max_missed.value_or(default_max_missed);
}

double missed_percent(std::size_t missed, std::size_t baked) {
    return missed == 0 ? 0.0
                       : 100.0 * static_cast<double>(missed) / static_cast<double>(missed + baked);
}

Baker make_baker(const MeshBakeRequest& request, const BakeModels& models,
                 const BakeOptions& options, Report& report) {
    try {
        return models.baker(options, report);
    } catch (const BakeMismatch& mismatch) {
        throw mismatch_error(request, mismatch, models.origin);
    }
}

std::string fit_words(const MeshBakeRequest& request, const BakeModels& models) {
    const BakeFit fit = compare_boxes(models.high, models.low);
    const std::string cause = cause_words(fit);
    return boxes_words(request, fit, models.origin) + (cause.empty() ? "" : "; " + cause);
}

void check_missed(const MeshBakeRequest& request, const BakeModels& models, const std::string& map,
                  const BakeResult& result) {
    if (misses_too_much(result, missed_limit(request)))
        throw missed_error(request, models, map, result, "");
}

void check_missed_early(const MeshBakeRequest& request, const BakeModels& models,
                        const Baker& baker, const BakeMapOptions& map, const std::string& name,
                        bool always) {
    if (missed_limit(request) + early_margin >= 100.0) return;
    const double texels = static_cast<double>(map.width) * static_cast<double>(map.height);
    // A map of about this size is baked as fast itself.
    if (!always && texels <= 2.0 * early_texels) return;
    BakeMapOptions small = map;
    const double scale = std::min(std::sqrt(early_texels / texels), 1.0);
    small.width = std::max(static_cast<int>(std::lround(scale * map.width)), 1);
    small.height = std::max(static_cast<int>(std::lround(scale * map.height)), 1);
    small.samples = 1;
    small.sample_angle.reset();
    small.padding = 0;
    small.border_folder.reset();
    small.progress = nullptr;
    small.measures_missed = true;
    small.layers = {.normals = false, .heights = true};
    Report said_by_the_bake;
    const BakeResult result = baker.bake(
        small, [](const BakedRows&) {}, said_by_the_bake);
    if (!misses_too_much(result, missed_limit(request) + early_margin)) return;
    throw missed_error(request, models, name, result,
                       fmt::format(" of a map of {} x {}", small.width, small.height));
}

std::vector<std::string> missed_lines(const MeshBakeRequest& request, const BakeResult& result,
                                      const glm::dvec3& origin) {
    constexpr std::size_t most = 4;
    std::vector<std::string> lines;
    if (result.texels_missed == 0) return lines;
    std::string places;
    for (std::size_t i = 0; i < std::min(most, result.first_missed.size()); ++i) {
        const MissedTexel& texel = result.first_missed[i];
        places += fmt::format("{}({}, {}) at {}", i == 0 ? "" : "; ", texel.x, texel.y,
                              point_words(texel.position + origin));
    }
    if (result.texels_missed > most) places += "; ...";
    lines.push_back(fmt::format("{}, {:.3g} % of those covered: {}",
                                counted(result.texels_missed, "texel"),
                                missed_percent(result.texels_missed, result.texels_baked), places));
    for (std::string& line : ray_lines(request, result))
        lines.push_back(std::move(line));
    return lines;
}

nlohmann::ordered_json missed_json(const BakeResult& result, const glm::dvec3& origin) {
    nlohmann::ordered_json first = nlohmann::ordered_json::array();
    for (const MissedTexel& texel : result.first_missed) {
        first.push_back(
            {{"x", texel.x}, {"y", texel.y}, {"position", point_json(texel.position + origin)}});
    }
    return {{"percent", missed_percent(result.texels_missed, result.texels_baked)},
            {"first", first},
            {"from_behind", result.missed_from_behind},
            {"clipped_outside", clipped_json(result.clipped_outside)},
            {"clipped_inside", clipped_json(result.clipped_inside)},
            {"measuring_rays", result.measuring_rays}};
}

nlohmann::ordered_json boxes_json(const BakeFit& fit, const glm::dvec3& origin) {
    const auto box_json = [&](const Bounds& box) -> nlohmann::ordered_json {
        if (box.empty()) return nullptr;
        return {{"min", point_json(glm::dvec3(box.min) + origin)},
                {"max", point_json(glm::dvec3(box.max) + origin)}};
    };
    return {{"high", box_json(fit.high)},
            {"low", box_json(fit.low)},
            {"gap", fit.gap},
            {"size_ratio", fit.size_ratio}};
}

std::string words_of_swapped_models(const MeshBakeRequest& request, std::size_t high_triangles,
                                    std::size_t low_triangles) {
    if (low_triangles / 4 <= high_triangles) return "";
    return fmt::format(
        "{}: has {}, more than four times as many as the high model, {} (are they swapped? "
        "HIGH comes before LOW)",
        request.low.string(), counted(low_triangles, "triangle"), high_triangles);
}

}  // namespace relief::tools
