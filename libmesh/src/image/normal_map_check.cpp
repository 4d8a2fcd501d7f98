// SPDX-License-Identifier: Apache-2.0
// Checking of normal maps: the names of all conditions, and the classification of a map.
//
// The steps: a sample of texels gives the encoding (curve, sign, content); all texels are then
// evaluated with that encoding; the last step tests properties that only surfaces have. The limits
// are calibrated on the maps and photographs of the shared data; normal_map_check_test.cpp has a
// row for each. An empty image throws.
#include "relief/mesh/normal_map_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "image/map_statistics.h"
#include "parallel.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

using enum MapCondition;
using enum Severity;

constexpr std::array all_map_conditions = {
    MapConditionInfo{not_normals, "no normal map", "map", problem,
                     "its vectors have no common length, or all its channels are the same"},
    MapConditionInfo{
        object_space, "object-space normals", "map", note,
        "its vectors face all directions: it fits only one mesh, and is not a tangent-space map"},
    MapConditionInfo{
        z_missing, "no third component", "map", problem,
        "only x and y are stored: programs that read three channels get wrong normals"},
    MapConditionInfo{z_constant, "constant third component", "map", note,
                     "x and y contain all information; valid only for small slopes"},
    MapConditionInfo{stored_through_srgb, "stored through the sRGB curve", "map", problem,
                     "too bright: flat is 188 of 255 instead of 128"},
    MapConditionInfo{decoded_from_srgb, "darkened by the sRGB curve", "map", problem,
                     "read as color and stored as light: flat is 55 of 255 instead of 128"},
    MapConditionInfo{tagged_as_color, "tagged as a color", "map", note,
                     "its file is tagged as a color: programs that apply such tags change the "
                     "normals (relief and glTF do not)"},
    MapConditionInfo{signed_samples, "signed samples", "map", problem,
                     "float samples hold n itself; relief and most others read (n + 1) / 2"},
    MapConditionInfo{texel_not_finite, "texel not finite", "texel", problem, "is read as flat"},
    MapConditionInfo{texel_without_direction, "texel without direction", "texel", problem,
                     "is (0,0,0) or nearly so: programs read it differently"},
    MapConditionInfo{texel_facing_back, "texel facing back", "texel", problem,
                     "has z below 0, which no surface seen from outside has in tangent space"},
    MapConditionInfo{texel_gray, "gray texel", "texel", note,
                     "is black, white or gray: a background, which filtering mixes into its "
                     "neighbors"},
    MapConditionInfo{not_unit, "not of unit length", "map", problem,
                     "lengths are off by more than 0.05 (RMS): programs that do not normalize "
                     "shade it wrong"},
    MapConditionInfo{not_quite_unit, "not quite of unit length", "map", note,
                     "lengths are off by more than 0.02 (RMS): filtered or compressed"},
    MapConditionInfo{green_contradicted, "green is not as stated", "map", problem,
                     "its slopes are those of a surface only with the opposite green"},
    MapConditionInfo{green_down, "green is down", "map", note,
                     "as in DirectX; OpenGL and glTF have it up"},
    MapConditionInfo{green_unknown, "green is undecidable", "map", note,
                     "its slopes fit a surface equally well with green up and down"},
    MapConditionInfo{flat_contradicted, "zero is not as stated", "map", problem,
                     "its flat texels have another code than the file states"},
    MapConditionInfo{all_flat, "every texel the same", "map", note, "shows nothing"},
    MapConditionInfo{x_constant, "constant first component", "map", note,
                     "no slope left and right"},
    MapConditionInfo{y_constant, "constant second component", "map", note, "no slope up and down"},
    MapConditionInfo{bits_unused, "bits unused", "map", note,
                     "has only 8-bit content: 16 bits or float need more memory without a benefit"},
    MapConditionInfo{alpha_opaque, "constant alpha", "map", note,
                     "a fourth channel without information"},
    MapConditionInfo{alpha_heights, "heights in alpha", "map", note,
                     "the slopes of the fourth channel are those of the normals"},
    MapConditionInfo{alpha_other, "something in alpha", "map", note,
                     "a fourth channel that is not these normals' heights"},
    MapConditionInfo{seam_x, "seam left and right", "map", note, "does not tile along x"},
    MapConditionInfo{seam_y, "seam top and bottom", "map", note, "does not tile along y"},
};

static_assert([] {
    for (std::size_t i = 0; i < all_map_conditions.size(); ++i) {
        if (all_map_conditions[i].condition != static_cast<MapCondition>(i)) return false;
    }
    return all_map_conditions.size() == static_cast<std::size_t>(seam_y) + 1;
}());

}  // namespace

std::span<const MapConditionInfo> map_conditions() {
    return all_map_conditions;
}

const MapConditionInfo& condition_info(MapCondition condition) {
    return all_map_conditions[static_cast<std::size_t>(condition)];
}

bool NormalMapCheck::has(MapCondition condition) const {
    return std::any_of(
        conditions.begin(), conditions.end(),
        [condition](const MapConditionCount& one) { return one.condition == condition; });
}

bool NormalMapCheck::has_problem() const {
    return std::any_of(conditions.begin(), conditions.end(), [](const MapConditionCount& one) {
        return condition_info(one.condition).severity == problem;
    });
}

Report to_report(const NormalMapCheck& check, std::optional<Severity> severity) {
    Report report;
    for (const MapConditionCount& found : check.conditions) {
        const MapConditionInfo& info = condition_info(found.condition);
        if (severity && info.severity != *severity) continue;
        report.add(Finding{std::string(info.word), std::string(info.element),
                           std::string(info.meaning), found.count, found.first});
    }
    return report;
}

namespace {

constexpr std::size_t max_samples = 1 << 18;  // The texels from which the meaning is determined.

/// Another meaning is accepted if it reduces the error of the lengths by this factor, to at most
/// this value.
constexpr double largest_other_rms = 0.1;
constexpr double min_gain = 2.0;

bool is_gray(const MapStatistics& all) {
    return static_cast<double>(all.equal) >= 0.995 * static_cast<double>(all.texels);
}

/// Returns whether the directions lean towards z: lengths are near 1, or at least x and y around 0.
bool are_tangent_normals(const MapStatistics& all) {
    if (all.share(all.upwards) < 0.9 || all.mean.z < 0.4) return false;
    if (all.lengths.rms_deviation <= 0.1) return true;
    return all.lengths.rms_deviation <= 0.25 && std::abs(all.mean.x) <= 0.2 &&
           std::abs(all.mean.y) <= 0.2;
}

/// Returns whether the vectors have unit length and point in all directions, which colors of about
/// unit length do not. Vectors of exact unit length may all face one side.
bool are_object_normals(const MapStatistics& all) {
    constexpr double exact_rms = 0.02;
    if (all.lengths.rms_deviation <= exact_rms && all.vectors > 0) return true;
    return all.lengths.rms_deviation <= 0.12 && glm::length(all.mean) <= 0.6 &&
           all.share(all.upwards) <= 0.98;
}

/// Returns whether two components lie within the unit disk, around 0, and the third one is
/// constant.
bool are_xy_normals(const ImageView& map, const MapStatistics& all) {
    const bool has_no_z = map.channels == 2 || all.constant[2];
    return has_no_z && !(all.constant[0] && all.constant[1]) && all.share(all.in_disk) >= 0.99 &&
           std::abs(all.mean.x) <= 0.2 && std::abs(all.mean.y) <= 0.2;
}

MapContent content_of(const ImageView& map, const MapStatistics& all) {
    if (map.channels == 1 || is_gray(all)) return MapContent::gray;
    if (map.channels >= 3 && are_tangent_normals(all)) return MapContent::tangent_normals;
    if (are_xy_normals(map, all)) return MapContent::xy_normals;
    if (map.channels == 2) return MapContent::gray;
    return are_object_normals(all) ? MapContent::object_normals : MapContent::other;
}

struct Meaning {
    SampleMeaning samples;
    MapContent content = MapContent::other;
};

/// Returns the meaning that gives vectors nearest to unit length. Samples are taken as stored
/// unless another meaning is much better.
Meaning meaning_of(const ImageView& map, FlatCode flat) {
    const std::size_t count =
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    const std::size_t step = std::max<std::size_t>(1, count / max_samples);
    SampleMeaning plain;
    plain.flat = flat;
    plain.z_is_stored = map.channels >= 3;
    const MapStatistics as_stored = map_statistics(map, plain, step);
    Meaning best{plain, content_of(map, as_stored)};
    if (map.channels < 3 || is_gray(as_stored)) return best;
    double least = as_stored.lengths.rms_deviation / min_gain;
    const auto consider = [&](const SampleMeaning& other) {
        const MapStatistics statistics = map_statistics(map, other, step);
        const MapContent content = content_of(map, statistics);
        if (content != MapContent::tangent_normals && content != MapContent::object_normals) return;
        if (statistics.lengths.rms_deviation > std::min(least, largest_other_rms)) return;
        least = statistics.lengths.rms_deviation;
        best = {other, content};
    };
    for (const StoredCurve curve : {StoredCurve::srgb_encoded, StoredCurve::srgb_decoded}) {
        SampleMeaning other = plain;
        other.curve = curve;
        consider(other);
    }
    if (map.bits() == 32) {
        SampleMeaning other = plain;
        other.is_signed = true;
        consider(other);
    }
    return best;
}

/// Returns the content of normals whose space is stated: those of an object that is nearly flat
/// look like normals in tangent space.
MapContent with_stated_space(MapContent judged, const MapDescription& stated) {
    const bool has_object_axes =
        stated.kind == MapKind::object_normal || stated.kind == MapKind::world_normal;
    return judged == MapContent::tangent_normals && has_object_axes ? MapContent::object_normals
                                                                    : judged;
}

/// Returns one channel of a map, for the statistics of height maps.
Image channel_to_check(const ImageView& map, int channel) {
    Image one = make_image(map.width, map.height, 1, map.bits(), ColorSpace::data);
    with_sample_type(map, [&](auto sample) {
        using Sample = decltype(sample);
        const MutableImageView to(one);
        const std::size_t rows_per_piece = (1 << 16) / static_cast<std::size_t>(map.width) + 1;
        parallel_for(static_cast<std::size_t>(map.height), rows_per_piece,
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t row = begin; row < end; ++row) {
                             const Sample* from = map.row<Sample>(static_cast<int>(row)) + channel;
                             Sample* const values = to.row<Sample>(static_cast<int>(row));
                             for (int x = 0; x < map.width; ++x, from += map.channels)
                                 values[x] = *from;
                         }
                     });
    });
    return one;
}

/// Determines the larger seams of x and y, and the bits of every channel.
void look_at_channels(const ImageView& map, NormalMapCheck& check) {
    for (int channel = 0; channel < map.channels; ++channel) {
        const Image one = channel_to_check(map, channel);
        check.bits.push_back(height_depth(one).bits);
        if (channel >= 2) continue;
        const Tiling tiling = detect_tiling(one);
        check.tiling.seam_x = std::max(check.tiling.seam_x, tiling.seam_x);
        check.tiling.seam_y = std::max(check.tiling.seam_y, tiling.seam_y);
    }
}

/// Collects conditions in the order of the enumeration.
class FoundConditions {
  public:
    explicit FoundConditions(NormalMapCheck& check) : check_(check) {}

    void if_so(bool is_so, MapCondition condition) {
        if (is_so) check_.conditions.push_back({condition, 1, {}});
    }
    void texels(const MapConditionCount& found) {
        if (found.count > 0) check_.conditions.push_back(found);
    }

  private:
    NormalMapCheck& check_;
};

bool has_directions(MapContent content) {
    return content == MapContent::tangent_normals || content == MapContent::object_normals;
}

void find_meaning(const NormalMapCheck& check, const SampleMeaning& meaning,
                  const MapStatistics& all, int channels, bool is_tagged, FoundConditions& found) {
    using enum MapCondition;
    found.if_so(check.content == MapContent::gray || check.content == MapContent::other,
                not_normals);
    found.if_so(check.content == MapContent::object_normals, object_space);
    found.if_so(check.content == MapContent::xy_normals, z_missing);
    const bool is_flat = all.constant[0] && all.constant[1];
    found.if_so(check.content == MapContent::tangent_normals && channels >= 3 && all.constant[2] &&
                    !is_flat,
                z_constant);
    found.if_so(check.curve == StoredCurve::srgb_encoded, stored_through_srgb);
    found.if_so(check.curve == StoredCurve::srgb_decoded, decoded_from_srgb);
    const bool is_color = check.content == MapContent::gray || check.content == MapContent::other;
    found.if_so(is_tagged && !is_color, tagged_as_color);
    found.if_so(meaning.is_signed, signed_samples);
}

void find_texels(const NormalMapCheck& check, const MapStatistics& all, FoundConditions& found) {
    found.texels(all.not_finite);
    if (!has_directions(check.content)) return;
    found.texels(all.without_direction);
    if (check.content == MapContent::tangent_normals) found.texels(all.facing_back);
    found.texels({MapCondition::texel_gray, all.background, {}});
    const double rms = check.lengths_uncurved.rms_deviation;
    found.if_so(rms > 0.05, MapCondition::not_unit);
    found.if_so(rms > 0.02 && rms <= 0.05, MapCondition::not_quite_unit);
}

/// Returns whether flat texels have 127 although the file says that zero is 128. The opposite case
/// cannot be detected: maps with zero at 127.5 have 128 in flat texels too.
bool contradicts_flat_code(const ImageView& map, const MapDescription& stated) {
    return stated.flat == FlatCode::middle && flat_evidence(map).is_half();
}

void find_conventions(const ImageView& map, const NormalMapCheck& check,
                      const MapDescription& stated, const MapStatistics& all,
                      FoundConditions& found) {
    using enum MapCondition;
    const bool has_slopes =
        (check.content == MapContent::tangent_normals || check.content == MapContent::xy_normals) &&
        !(all.constant[0] && all.constant[1]);
    if (has_slopes) {
        found.if_so(stated.green && check.green.green && check.green.green != stated.green,
                    green_contradicted);
        found.if_so(check.green.green == Green::down, green_down);
        found.if_so(!check.green.green, green_unknown);
    }
    if (has_directions(check.content))
        found.if_so(contradicts_flat_code(map, stated), flat_contradicted);
}

void find_channels(const ImageView& map, const NormalMapCheck& check, const MapStatistics& all,
                   FoundConditions& found) {
    using enum MapCondition;
    if (check.content == MapContent::gray || check.content == MapContent::other) return;
    const bool is_flat = all.constant[0] && all.constant[1];
    found.if_so(is_flat, all_flat);
    found.if_so(all.constant[0] && !is_flat, x_constant);
    found.if_so(all.constant[1] && !is_flat, y_constant);
    found.if_so(map.bits() > 8 && !is_flat &&
                    std::all_of(check.bits.begin(),
                                check.bits.begin() + std::min<std::ptrdiff_t>(3, map.channels),
                                [](int bits) { return bits > 0 && bits <= 8; }),
                bits_unused);
    if (map.channels == 4) {
        found.if_so(all.constant[3], alpha_opaque);
        const bool are_heights = std::abs(check.alpha_correlation.value_or(0.0)) >= 0.5;
        found.if_so(!all.constant[3] && are_heights, alpha_heights);
        found.if_so(!all.constant[3] && !are_heights, alpha_other);
    }
    found.if_so(!check.tiling.tiles_x(), seam_x);
    found.if_so(!check.tiling.tiles_y(), seam_y);
}

/// Measures lengths with the detected meaning, and as stored.
void measure_lengths(const ImageView& map, const SampleMeaning& meaning, const MapStatistics& all,
                     NormalMapCheck& check) {
    check.lengths = check.lengths_uncurved = all.lengths;
    if (meaning.curve == StoredCurve::none) return;
    SampleMeaning stored = meaning;
    stored.curve = StoredCurve::none;
    check.lengths = map_statistics(map, stored).lengths;
}

/// Returns whether vectors that are too short or too long have the slopes of a surface.
bool is_surface(const MapStatistics& all, const GreenEvidence& green) {
    return all.share(all.upwards) >= 0.95 && all.mean.z >= 0.3 && std::abs(all.mean.x) <= 0.1 &&
           std::abs(all.mean.y) <= 0.1 && green.green && std::abs(green.correlation) >= 0.3;
}

/// Evaluates the properties of tangent-space normals, and sets the content if the map turns out to
/// hold some.
void look_at_surface(const ImageView& map, SampleMeaning meaning, const MapStatistics& all,
                     NormalMapCheck& check) {
    if (check.content == MapContent::gray || check.content == MapContent::object_normals) return;
    meaning.z_is_stored = check.content != MapContent::xy_normals;
    const SurfaceEvidence surface = surface_evidence(map, meaning);
    if (check.content == MapContent::other) {
        if (!is_surface(all, surface.green)) return;
        check.content = MapContent::tangent_normals;
    }
    check.green = surface.green;
    check.alpha_correlation = surface.alpha_correlation;
}

}  // namespace

MapContent judged_content(const ImageView& map, FlatCode flat) {
    if (map.empty()) throw InvalidInput("the normal map is empty");
    if (map.channels == 1) return MapContent::gray;
    const Meaning meaning = meaning_of(map, flat);
    if (meaning.content != MapContent::other) return meaning.content;
    NormalMapCheck check;
    look_at_surface(map, meaning.samples, map_statistics(map, meaning.samples), check);
    return check.content;
}

NormalMapCheck check_normal_map(const ImageView& map,
                                const std::map<std::string, std::string>& metadata,
                                std::string_view color_tag, std::optional<MapContent> assumed) {
    if (map.empty()) throw InvalidInput("the normal map is empty");
    NormalMapCheck check;
    FoundConditions found(check);
    look_at_channels(map, check);
    const MapDescription stated = read_description(metadata);
    if (map.channels == 1) {
        check.content = MapContent::gray;
        found.if_so(true, MapCondition::not_normals);
        return check;
    }
    if (map.channels >= 3) {
        check.flat = contradicts_flat_code(map, stated) ? FlatCode::half
                                                        : stated.flat.value_or(FlatCode::half);
    }
    const Meaning meaning = meaning_of(map, check.flat);
    check.content = assumed.value_or(with_stated_space(meaning.content, stated));
    check.curve = meaning.samples.curve;
    const MapStatistics all = map_statistics(map, meaning.samples);
    measure_lengths(map, meaning.samples, all, check);
    look_at_surface(map, meaning.samples, all, check);
    find_meaning(check, meaning.samples, all, map.channels, !color_tag.empty(), found);
    find_texels(check, all, found);
    find_conventions(map, check, stated, all, found);
    find_channels(map, check, all, found);
    return check;
}

}  // namespace relief
