// SPDX-License-Identifier: Apache-2.0
// Trials against one truth. Tests: tests/tools/relief_bake_accuracy_test.cpp.
#include "mesh/mesh_accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/trigonometric.hpp>

#include "common/file_jobs.h"
#include "mesh/accuracy_words.h"
#include "mesh/mesh_sets.h"
#include "mesh/mesh_verify.h"
#include "relief/mesh/error.h"
#include "relief/mesh/frontier.h"

namespace relief::tools {
namespace {

constexpr std::size_t texels_for_bound = std::size_t{1} << 17;
constexpr std::size_t texels_for_table = std::size_t{1} << 16;
constexpr std::size_t rounds = 3;

/// The depths that are open to choice, fewest bits first.
std::vector<NormalMapFormat> open_formats(const MeshBakeRequest& request,
                                          const NormalMapFormat& format) {
    std::vector<int> depths = depths_of(request.output);
    if (request.map.bits) depths = {*request.map.bits};
    // What is said of codes has no effect on floats.
    if (!request.map.bits && (request.map.flat || request.map.dither)) std::erase(depths, 32);
    std::sort(depths.begin(), depths.end());
    std::vector<NormalMapFormat> formats;
    for (const int bits : depths) {
        formats.push_back(format);
        formats.back().bits = bits;
    }
    return formats;
}

std::vector<MeasuredBake> measure(const BakeTrials& trials, const SampleChoice& samples,
                                  const std::optional<double>& angle,
                                  std::span<const NormalMapFormat> formats,
                                  std::vector<AngleSummary>* codes = nullptr) {
    const BakeTrial trial = trials.measure({samples.count, angle}, formats);
    std::vector<MeasuredBake> measured;
    for (std::size_t i = 0; i < formats.size(); ++i) {
        measured.push_back({samples, angle, formats[i], trial.errors[i], trial.rays,
                            trial.cast_seconds + trial.code_seconds[i], false});
    }
    if (codes != nullptr) *codes = trial.quantisation;
    return measured;
}

std::vector<SampleChoice> open_samples(const MeshBakeRequest& request) {
    if (request.samples.is_told) return {request.samples};
    return {{1, false, false}, {4, false, false}, {16, false, false}, {64, false, false}};
}

[[noreturn]] void refuse(const ErrorBound& bound, const std::vector<MeasuredBake>& measured) {
    const auto least = std::min_element(
        measured.begin(), measured.end(), [&](const MeasuredBake& a, const MeasuredBake& b) {
            return bounded(a.error, bound) < bounded(b.error, bound);
        });
    throw InvalidInput(
        fmt::format("no way to bake it keeps within {}: the least is {:.3g}, with {}",
                    bound_words(bound), bounded(least->error, bound), method_words(*least)));
}

/// Errors of no texel would keep any bound.
void require_errors(const AngleSummary& error) {
    if (error.count == 0)
        throw InvalidInput(
            "no texel that was looked at has a normal from the high model, so that no error can be "
            "measured");
}

void keep_within(const BakeTrials& trials, MeshBakeRequest& request, NormalMapFormat& format,
                 MeshAccuracy& found) {
    const ErrorBound& bound = request.accuracy.bound;
    const std::vector<NormalMapFormat> formats = open_formats(request, format);
    for (const SampleChoice& samples : open_samples(request)) {
        std::vector<AngleSummary> codes;
        for (MeasuredBake& one :
             measure(trials, samples, angle_of(request, samples), formats, &codes)) {
            require_errors(one.error);
            const bool keeps = bounded(one.error, bound) <= *bound.degrees;
            if (keeps && !found.kept) found.kept = one;
            found.measured.push_back(std::move(one));
        }
        if (found.kept) break;
        const bool can_be_kept = std::any_of(codes.begin(), codes.end(), [&](const auto& alone) {
            return bounded(alone, bound) <= *bound.degrees;
        });
        if (!can_be_kept) break;
    }
    if (!found.kept) refuse(bound, found.measured);
    request.samples = found.kept->samples;
    format = found.kept->format;
}

SampleChoice samples_of(const BakeWay& way) {
    return {way.samples, way.sample_degrees.has_value(), false};
}

/// In all depths: what a file of this name cannot hold, another can.
void compare(const BakeTrials& trials, const NormalMapFormat& format, MeshAccuracy& found) {
    const std::span<const BakeWay> ways = usual_bake_ways();
    const std::vector<NormalMapFormat> formats = usual_map_formats(format);
    const std::vector<TimedBakeTrial> trial = measured_in_turns(trials, ways, formats, {rounds, 0});
    require_errors(trial.front().trial.errors.front());
    for (std::size_t way = 0; way < ways.size(); ++way) {
        for (std::size_t f = 0; f < formats.size(); ++f) {
            found.measured.push_back({samples_of(ways[way]), ways[way].sample_degrees, formats[f],
                                      trial[way].trial.errors[f], trial[way].trial.rays,
                                      spread_of(trial[way].seconds[f]).median, false});
        }
    }
    std::vector<Price> prices;
    for (const MeasuredBake& one : found.measured)
        prices.push_back({one.error.rms, one.seconds});
    const std::vector<bool> marks = efficient(prices);
    for (std::size_t i = 0; i < marks.size(); ++i)
        found.measured[i].is_efficient = marks[i];
}

}  // namespace

void check_accuracy(const MeshBakeRequest& request) {
    const AccuracyChoice& choice = request.accuracy;
    check(choice.bound);
    if (!needs_trials(request)) return;
    if (choice.compare && choice.bound.degrees)
        throw UsageError("--compare, --max-error: one bakes in every way, the other in one");
    const std::string option = choice.compare ? "--compare" : "--max-error";
    if (request.map.half)
        throw UsageError(option + ", --half: errors of half floats are not measured");
    if (names_word(request.output, material_word) || names_word(request.output, tile_word))
        throw UsageError(option + ": is of one map, not those of <material> or <UDIM>");
}

bool needs_trials(const MeshBakeRequest& request) {
    return request.accuracy.compare || request.accuracy.bound.degrees.has_value();
}

MeshAccuracy settle_accuracy(const Baker& baker, const BakeMapOptions& map,
                             MeshBakeRequest& request, NormalMapFormat& format) {
    const bool compares = request.accuracy.compare;
    const bool needs_all = request.accuracy.bound.kind == BoundKind::max;
    const std::size_t whole =
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    const BakeTrials trials(baker, map,
                            needs_all  ? whole
                            : compares ? texels_for_table
                                       : texels_for_bound);
    MeshAccuracy found;
    found.texels = trials.texels();
    found.is_whole = trials.is_whole();
    found.reference_samples = trials.reference_samples();
    found.reference_rays = trials.reference_rays();
    if (compares)
        compare(trials, format, found);
    else
        keep_within(trials, request, format, found);
    return found;
}

}  // namespace relief::tools
