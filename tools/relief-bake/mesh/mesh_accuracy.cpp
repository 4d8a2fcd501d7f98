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
constexpr std::size_t texels_for_finest = std::size_t{1} << 14;
constexpr std::size_t rounds = 3;
constexpr int most_samples = 256;  // Of those that --samples offers.
constexpr int finest_reference = 1024;

/// The depths that the file can hold and the options leave open, fewest bits first.
std::vector<int> available_depths(const MeshBakeRequest& request) {
    if (request.map.bits) return {*request.map.bits};
    std::vector<int> depths = depths_of(request.output);
    // What is said of codes has no effect on floats.
    if (request.map.flat || request.map.dither) std::erase(depths, 32);
    std::sort(depths.begin(), depths.end());
    return depths;
}

/// All choices of samples and bits; those of other files too, for the remedy of a refusal.
class Choosing {
  public:
    Choosing(const MeshBakeRequest& request, const NormalMapFormat& format)
        : request_(request), bound_(request.accuracy.bound), open_(available_depths(request)) {
        for (const int bits : {8, 16, 32}) {
            formats_.push_back(format);
            formats_.back().bits = bits;
        }
        // Other depths, such as those of half floats, are not measured.
        std::erase_if(open_, [](int bits) { return bits != 8 && bits != 16 && bits != 32; });
    }

    /// Measures one count of samples in all formats.
    std::vector<MeasuredBake> measure(const BakeTrials& trials, const SampleChoice& samples) {
        const std::optional<double> angle = angle_of(request_, samples);
        const BakeTrial trial = trials.measure({samples.count, angle}, formats_);
        std::vector<MeasuredBake> measured;
        for (std::size_t i = 0; i < formats_.size(); ++i) {
            measured.push_back({samples, angle, formats_[i], trial.errors[i], trial.quantisation[i],
                                trial.sampling, trial.rays,
                                trial.cast_seconds + trial.code_seconds[i], false});
        }
        require_errors(measured.front().error);
        return measured;
    }

    /// The same; the file's formats are added to the steps. \return whether one is within the limit
    bool try_samples(const BakeTrials& trials, const SampleChoice& samples, MeshAccuracy& found) {
        for (MeasuredBake& one : measure(trials, samples)) {
            const bool is_open = opens(one);
            if (is_open && !found.kept && keeps(one)) found.kept = one;
            if (is_open) found.measured.push_back(one);
            all_.push_back(std::move(one));
        }
        return found.kept.has_value();
    }

    /// Forgets what was measured of other texels.
    void restart() { all_.clear(); }

    /// Whether in each of the file's formats rounding alone is beyond the limit.
    [[nodiscard]] bool is_bound_by_rounding() const {
        return std::all_of(all_.begin(), all_.end(), [&](const MeasuredBake& one) {
            return !opens(one) || bounded(one.rounding, bound_) > *bound_.degrees;
        });
    }

    /// \param has_all_samples  whether 256 samples were measured
    [[noreturn]] void refuse(bool has_all_samples) const {
        const MeasuredBake* least = nullptr;
        const MeasuredBake* elsewhere = nullptr;  // In another file, within the limit.
        for (const MeasuredBake& one : all_) {
            if (opens(one)) {
                if (least == nullptr || error(one) < error(*least)) least = &one;
            } else if (keeps(one) &&
                       (elsewhere == nullptr || one.format.bits < elsewhere->format.bits)) {
                elsewhere = &one;
            }
        }
        const double rounding = bounded(least->rounding, bound_);
        const double sampling = bounded(least->sampling, bound_);
        std::string parts =
            rounding >= sampling
                ? fmt::format("rounding to {} bits alone makes {:.3g}, sampling {:.3g}",
                              least->format.bits, rounding, sampling)
                : fmt::format("sampling alone makes {:.3g}, rounding to {} bits {:.3g}", sampling,
                              least->format.bits, rounding);
        if (!has_all_samples) parts += "; 256 samples cannot be measured on so large a map";
        throw InvalidInput(fmt::format(
            "no choice of samples and bits keeps the error within {}: the least is {:.3g}, with "
            "{}; {} ({})",
            bound_words(bound_), error(*least), method_words(*least), parts, remedy(elsewhere)));
    }

  private:
    [[nodiscard]] bool opens(const MeasuredBake& bake) const {
        return std::find(open_.begin(), open_.end(), bake.format.bits) != open_.end();
    }
    [[nodiscard]] double error(const MeasuredBake& bake) const {
        return bounded(bake.error, bound_);
    }
    [[nodiscard]] bool keeps(const MeasuredBake& bake) const {
        return error(bake) <= *bound_.degrees;
    }
    /// Errors of no texel would keep any bound.
    static void require_errors(const AngleSummary& error) {
        if (error.count == 0)
            throw InvalidInput(
                "no texel that was looked at has a normal from the high model, so that no error "
                "can be measured");
    }
    [[nodiscard]] std::string remedy(const MeasuredBake* elsewhere) const {
        if (elsewhere == nullptr) return "allow a larger error";
        const int bits = elsewhere->format.bits;
        const std::vector<int> depths = depths_of(request_.output);
        const bool fits = std::find(depths.begin(), depths.end(), bits) != depths.end();
        const std::string file = fits         ? fmt::format("give --bits {}", bits)
                                 : bits == 32 ? "write .exr or .tif"
                                              : "write .png or .tif";
        return fmt::format("{} bits would do, with {:.3g}: {}", bits, error(*elsewhere), file);
    }

    const MeshBakeRequest& request_;
    const ErrorBound& bound_;
    std::vector<int> open_;
    std::vector<NormalMapFormat> formats_;
    std::vector<MeasuredBake> all_;
};

std::size_t texels_for(const MeshBakeRequest& request, const BakeMapOptions& map,
                       std::size_t usual) {
    const bool needs_all = request.accuracy.bound.kind == BoundKind::max;
    return needs_all ? static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height)
                     : usual;
}

void describe(const BakeTrials& trials, MeshAccuracy& found) {
    found.texels = trials.texels();
    found.is_whole = trials.is_whole();
    found.reference_samples = trials.reference_samples();
    found.reference_rays += trials.reference_rays();
}

void keep_within(const Baker& baker, const BakeMapOptions& map, MeshBakeRequest& request,
                 NormalMapFormat& format, MeshAccuracy& found) {
    Choosing choosing(request, format);
    const bool is_told = request.samples.is_told;
    const bool needs_finest = is_told && request.samples.count == most_samples;
    const bool has_finest = std::max(map.width, map.height) * 32 <= TexelCover::largest_side;
    if (needs_finest && !has_finest)
        throw InvalidInput(
            "the error of 256 samples is measured only for maps of at most 2048 texels along a "
            "side");
    if (!needs_finest) {
        const BakeTrials trials(baker, map, texels_for(request, map, texels_for_bound));
        describe(trials, found);
        if (is_told) {
            if (!choosing.try_samples(trials, request.samples, found)) choosing.refuse(true);
        } else {
            for (const int count : {1, 4, 16, 64}) {
                if (choosing.try_samples(trials, {count, false, false}, found)) break;
                // More samples do not help: only the refusal needs them.
                if (has_finest && choosing.is_bound_by_rounding()) break;
            }
        }
    }
    if (!found.kept) {
        if (!has_finest) choosing.refuse(false);
        const BakeTrials trials(baker, map, texels_for(request, map, texels_for_finest),
                                finest_reference);
        describe(trials, found);
        choosing.restart();
        if (!choosing.try_samples(trials, {most_samples, false, is_told}, found)) {
            // All choices on the same texels, for the least error.
            MeshAccuracy unused;
            if (!is_told) {
                for (const int count : {1, 4, 16, 64})
                    choosing.try_samples(trials, {count, false, false}, unused);
            }
            choosing.refuse(true);
        }
    }
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
    if (trial.front().trial.errors.front().count == 0)
        throw InvalidInput("no texel has a normal from the high model: no error can be measured");
    for (std::size_t way = 0; way < ways.size(); ++way) {
        for (std::size_t f = 0; f < formats.size(); ++f) {
            found.measured.push_back({samples_of(ways[way]), ways[way].sample_degrees, formats[f],
                                      trial[way].trial.errors[f], trial[way].trial.quantisation[f],
                                      trial[way].trial.sampling, trial[way].trial.rays,
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
    MeshAccuracy found;
    if (request.accuracy.compare) {
        const BakeTrials trials(baker, map, texels_for(request, map, texels_for_table));
        describe(trials, found);
        compare(trials, format, found);
    } else {
        keep_within(baker, map, request, format, found);
    }
    return found;
}

}  // namespace relief::tools
