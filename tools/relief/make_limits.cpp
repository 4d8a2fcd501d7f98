// SPDX-License-Identifier: Apache-2.0
// Searches the triangles, the maps and the bits that hold limits of the loss.
// Tests: tests/make/make_limits_test.cpp.
#include "make_limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "relief/mesh/enum_names.h"

namespace relief::tools {
namespace {

/// Rounds to the digits of the printed figures, so that a limit that holds there holds here.
double printed(double figure) {
    return std::round(figure * 1e4) / 1e4;
}

/// Silhouettes that differ by less are those of other samples.
constexpr double wide_silhouettes = 0.25;
/// A growth that leaves more of the ratio did not help.
constexpr double helpful_ratio = 0.9;

const char* name_of_limit(LossLimit limit) {
    return limit == LossLimit::degrees ? "--max-error" : "--max-picture-error";
}

/// An error is at most halved by twice the triangles, as distances are, and quartered by maps of
/// twice the size, as errors of linear interpolation are.
constexpr double gain_of_triangles = 2.0;
constexpr double gain_of_size = 4.0;
/// The largest angle between a normal and its codes of 8 bits: half a code, 1 / 255, along three
/// axes, is 0.39 degrees.
constexpr double max_code_degrees = 0.4;

std::string text_of(const GrowthStep& step) {
    if (step.growth == Growth::bits) return "normals of 16 bits";
    return fmt::format("{} the {}", step.factor == 2 ? "twice" : "4 times",
                       step.growth == Growth::triangles ? "triangles" : "size of maps");
}

/// Returns the growth of a kind that is possible.
std::optional<GrowthStep> possible_step(const LimitAttempt& last, Growth growth,
                                        std::size_t max_triangles) {
    const int side = std::max(last.size.x, last.size.y);
    if (growth == Growth::triangles) {
        if (last.triangles >= max_triangles) return {};
        const bool is_far = last.ratio > gain_of_triangles && 2 * last.triangles < max_triangles;
        return GrowthStep{growth, is_far ? 4 : 2};
    }
    if (2 * side > max_limit_size) return {};
    return GrowthStep{growth, last.ratio > gain_of_size && 4 * side <= max_limit_size ? 4 : 2};
}

Growth other_than(Growth growth) {
    return growth == Growth::triangles ? Growth::size : Growth::triangles;
}

/// Returns the kind that should grow, whether or not it can.
Growth wanted_growth(const std::vector<LimitAttempt>& attempts) {
    const LimitAttempt& last = attempts.back();
    if (attempts.size() > 1) {
        const LimitAttempt& before = attempts[attempts.size() - 2];
        const Growth growth = before.next->growth;
        if (growth != Growth::bits && last.ratio > helpful_ratio * before.ratio)
            return other_than(growth);
    }
    return last.silhouettes > wide_silhouettes ? Growth::triangles : Growth::size;
}

std::string figures_of(const LossLimits& limits, const LimitAttempt& attempt) {
    return fmt::format("{} and maps of {} x {}{}: {:.4f} degrees ({}), FLIP {:.4f}",
                       counted(attempt.triangles, "triangle"), attempt.size.x, attempt.size.y,
                       attempt.bits == 8 ? "" : " with normals of 16 bits", attempt.degrees,
                       statistic_name(limits.normals.statistic()), attempt.flip);
}

std::string text_of(const LossLimits& limits) {
    std::vector<std::string> texts;
    if (limits.normals.degrees)
        texts.push_back(fmt::format("--max-error {:g}", *limits.normals.degrees));
    if (limits.flip) texts.push_back(fmt::format("--max-picture-error {:g}", *limits.flip));
    return fmt::format("{}", fmt::join(texts, " and "));
}

}  // namespace

LimitAttempt attempt_of(const shade::Fidelity& loss, const LossLimits& limits,
                        std::size_t triangles, const glm::ivec2& size, int bits) {
    LimitAttempt attempt;
    attempt.triangles = triangles;
    attempt.size = size;
    attempt.bits = bits;
    attempt.degrees = printed(loss.normals.error(limits.normals.statistic()));
    attempt.flip = printed(loss.max_picture_mean());
    attempt.silhouettes = loss.silhouettes.width;
    const auto compare = [&](LossLimit limit, double figure, const std::optional<double>& most) {
        if (!most) return;
        const double ratio = *most > 0.0    ? figure / *most
                             : figure > 0.0 ? std::numeric_limits<double>::infinity()
                                            : 0.0;
        if (figure > *most && ratio > attempt.ratio) attempt.exceeded = limit;
        attempt.ratio = std::max(attempt.ratio, ratio);
    };
    compare(LossLimit::degrees, attempt.degrees, limits.normals.degrees);
    compare(LossLimit::flip, attempt.flip, limits.flip);
    return attempt;
}

bool may_be_codes(const LimitAttempt& attempt, const LossLimits& limits) {
    return attempt.exceeded == LossLimit::degrees && attempt.bits == 8 &&
           attempt.degrees - *limits.normals.degrees <= max_code_degrees;
}

void note_baked(LimitAttempt& attempt, const LossLimits& limits, const shade::NormalLoss& coded,
                const shade::NormalLoss& baked) {
    const ErrorKind kind = limits.normals.statistic();
    const double gain = std::max(0.0, coded.error(kind) - baked.error(kind));
    attempt.baked_degrees = printed(std::max(0.0, attempt.degrees - gain));
}

std::optional<GrowthStep> next_growth(const std::vector<LimitAttempt>& attempts,
                                      const LossLimits& limits, std::size_t max_triangles) {
    if (attempts.size() >= max_attempts) return {};
    const LimitAttempt& last = attempts.back();
    if (last.baked_degrees && *last.baked_degrees <= *limits.normals.degrees)
        return GrowthStep{Growth::bits, 2};
    const Growth wanted = wanted_growth(attempts);
    for (const Growth growth : {wanted, other_than(wanted)}) {
        if (const auto step = possible_step(last, growth, max_triangles)) return step;
    }
    return {};
}

std::vector<std::string> limit_lines(const LossLimits& limits,
                                     const std::vector<LimitAttempt>& attempts) {
    std::vector<std::string> lines;
    for (const LimitAttempt& attempt : attempts) {
        const std::string before =
            attempt.baked_degrees
                ? fmt::format("; {:.4f} degrees before the codes", *attempt.baked_degrees)
                : std::string();
        const std::string next =
            attempt.next ? fmt::format("; next {}", text_of(*attempt.next)) : std::string();
        lines.push_back(figures_of(limits, attempt) + before +
                        (attempt.exceeded ? fmt::format("; more than {}{}",
                                                        name_of_limit(*attempt.exceeded), next)
                                          : fmt::format("; {} held", text_of(limits))));
    }
    return lines;
}

Json limits_json(const LossLimits& limits, const std::vector<LimitAttempt>& attempts) {
    return {{"max_error", or_null(limits.normals.degrees)},
            {"max_error_kind", enum_name(limits.normals.statistic())},
            {"max_picture_error", or_null(limits.flip)},
            {"attempts", json_list(attempts, [](const LimitAttempt& attempt) -> Json {
                 Json json = {{"triangles", attempt.triangles},
                              {"size", {attempt.size.x, attempt.size.y}},
                              {"normal_bits", attempt.bits},
                              {"degrees", attempt.degrees},
                              {"baked_degrees", or_null(attempt.baked_degrees)},
                              {"flip", attempt.flip},
                              {"silhouette_pixels", attempt.silhouettes},
                              {"exceeded", nullptr},
                              {"next", nullptr},
                              {"factor", nullptr}};
                 if (attempt.exceeded) {
                     json["exceeded"] = *attempt.exceeded == LossLimit::degrees
                                            ? "max_error"
                                            : "max_picture_error";
                 }
                 if (attempt.next) {
                     json["next"] = enum_name(attempt.next->growth);
                     json["factor"] = attempt.next->factor;
                 }
                 return json;
             })}};
}

std::string limits_error(const LossLimits& limits, const std::vector<LimitAttempt>& attempts) {
    const auto best = std::ranges::min_element(attempts, {}, &LimitAttempt::ratio);
    const bool at_bounds = attempts.size() < max_attempts;
    return fmt::format(
        "{} cannot be held: the best of {} has {}; {}", text_of(limits),
        counted(attempts.size(), "attempt"), figures_of(limits, *best),
        at_bounds ? fmt::format("it has all triangles and maps of at most {}; allow a larger error",
                                max_limit_size)
                  : "start with more --triangles and a larger --size, or allow a larger error");
}

}  // namespace relief::tools
