// SPDX-License-Identifier: Apache-2.0
#include "check/map_check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "check/map_remedies.h"
#include "common/choices.h"
#include "common/command.h"
#include "common/findings.h"
#include "common/text.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/image_tags.h"

namespace relief::tools {
namespace {

Choices<MapContent> content_words() {
    return {{"tangent-space normals", MapContent::tangent_normals},
            {"object-space normals", MapContent::object_normals},
            {"x and y of tangent-space normals", MapContent::xy_normals},
            {"grey, so heights or a mask", MapContent::grey},
            {"no normals: colours, or several masks", MapContent::other}};
}

Choices<MapContent> content_names() {
    return {{"tangent-space", MapContent::tangent_normals},
            {"object-space", MapContent::object_normals},
            {"xy", MapContent::xy_normals},
            {"grey", MapContent::grey},
            {"other", MapContent::other}};
}

Choices<StoredCurve> curve_names() {
    return {{"none", StoredCurve::none},
            {"srgb-encoded", StoredCurve::srgb_encoded},
            {"srgb-decoded", StoredCurve::srgb_decoded}};
}

bool has_directions(const NormalMapCheck& check) {
    return check.content != MapContent::grey && check.content != MapContent::other;
}

bool has_green(const NormalMapCheck& check) {
    return check.content == MapContent::tangent_normals || check.content == MapContent::xy_normals;
}

/// "mean 0.975, off 1 by 0.048 (RMS), 95.3 % within 0.1"
std::string lengths_in_words(const VectorLengths& lengths) {
    return fmt::format("mean {:.3f}, off 1 by {:.3f} (RMS), {:.1f} % within {:g}", lengths.mean,
                       lengths.rms_deviation, 100.0 * lengths.within[3], VectorLengths::bounds[3]);
}

std::string green_in_words(const GreenEvidence& green) {
    const std::string evidence =
        fmt::format("(correlation {:+.2f} +- {:.2g}; up would be +1, down -1)", green.correlation,
                    green.deviation);
    if (!green.green) return "cannot be told from the slopes " + evidence;
    return fmt::format("{}, by its slopes {}", name_of(*green.green, green_choices()), evidence);
}

/// "along x and y", "along x", "along no axis"; and how much more changes across the seams.
std::string tiling_in_words(const Tiling& tiling) {
    const std::string axes = tiling.tiles_x() && tiling.tiles_y() ? "x and y"
                             : tiling.tiles_x()                   ? "x"
                             : tiling.tiles_y()                   ? "y"
                                                                  : "no axis";
    return fmt::format(
        "along {} (across the seams it changes {:.2g} and {:.2g} times as much as inside)", axes,
        tiling.seam_x, tiling.seam_y);
}

/// "8, 8, 8"; "more than 16" where 0 says so.
std::string bits_in_words(const std::vector<int>& bits) {
    std::vector<std::string> words;
    for (const int one : bits)
        words.push_back(one == 0 ? "more than 16" : fmt::format("{}", one));
    return fmt::format("{} really used", fmt::join(words, ", "));
}

/// The findings of one severity, each followed by its remedy.
std::vector<std::string> lines_of(const CheckedMap& map, Severity severity) {
    std::vector<std::string> lines;
    for (const FoundMapCondition& found : map.check.found) {
        const MapConditionInfo& info = condition_info(found.condition);
        if (info.severity != severity) continue;
        lines.push_back(
            info.element == "map"
                ? fmt::format("{}: {}", info.word, info.meaning)
                : to_string(Finding{std::string(info.word), std::string(info.element),
                                    std::string(info.meaning), found.count, found.first}));
        const std::string remedy = remedy_for(found.condition, map.check.content, map.file);
        if (!remedy.empty()) lines.push_back("-> " + remedy);
    }
    return lines;
}

nlohmann::ordered_json findings_json(const CheckedMap& map, Severity severity) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const FoundMapCondition& found : map.check.found) {
        const MapConditionInfo& info = condition_info(found.condition);
        if (info.severity != severity) continue;
        list.push_back({{"kind", info.word},
                        {"element", info.element},
                        {"count", found.count},
                        {"first", found.first},
                        {"meaning", info.meaning},
                        {"remedy", remedy_for(found.condition, map.check.content, map.file)}});
    }
    return list;
}

nlohmann::ordered_json lengths_json(const VectorLengths& lengths) {
    nlohmann::ordered_json within = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < lengths.within.size(); ++i)
        within[fmt::format("{:g}", VectorLengths::bounds[i])] = lengths.within[i];
    return {{"mean", lengths.mean},
            {"rms_deviation", lengths.rms_deviation},
            {"within", std::move(within)}};
}

nlohmann::ordered_json green_json(const NormalMapCheck& check) {
    if (!has_green(check)) return nullptr;
    return {{"is", check.green.green ? name_of(*check.green.green, green_choices()) : "unknown"},
            {"correlation", check.green.correlation},
            {"deviation", check.green.deviation},
            {"confidence", check.green.confidence},
            {"scale", check.green.scale}};
}

double megapixels_per_second(const CheckedMap& map) {
    const double pixels = static_cast<double>(map.width) * map.height;
    return map.milliseconds > 0.0 ? pixels / map.milliseconds / 1000.0 : 0.0;
}

}  // namespace

CheckedMap check_map(const std::filesystem::path& file, std::optional<Green> green) {
    CheckedMap map;
    map.file = file;
    try {
        const Image image = read_image(file, ImageUse::data);
        std::map<std::string, std::string> metadata = read_image_info(file).metadata;
        if (green) metadata["relief:green"] = name_of(*green, green_choices());
        map.color_tag = color_tag(file);
        map.width = image.width;
        map.height = image.height;
        map.channels = image.channels;
        map.bits = image.bits();
        Stages stages(true);
        map.check =
            stages.run("check", [&] { return check_normal_map(image, metadata, map.color_tag); });
        map.milliseconds = stages.milliseconds("check");
    } catch (const FileError& error) {
        map.error = error.what();
    }
    return map;
}

void print_text(const CheckedMap& map) {
    const NormalMapCheck& check = map.check;
    print_entry("file",
                fmt::format("{}: {} x {}, {}, {} bit: {}", map.file.string(), map.width, map.height,
                            counted(static_cast<std::size_t>(map.channels), "channel"), map.bits,
                            map.is_sound() ? "sound" : "trouble"));
    print_entry("content", name_of(check.content, content_words()));
    if (has_directions(check)) {
        print_entry("lengths", lengths_in_words(check.lengths));
        if (check.curve != StoredCurve::none)
            print_entry("uncurved", lengths_in_words(check.lengths_uncurved));
    }
    if (has_green(check)) print_entry("green", green_in_words(check.green));
    if (has_directions(check)) {
        if (map.bits != 32)
            print_entry("zero", check.flat == FlatCode::middle
                                    ? "a code (128 of 255)"
                                    : "between two codes (127.5 of 255), as glTF decodes");
        print_entry("tiles", tiling_in_words(check.tiling));
    }
    print_entry("bits", bits_in_words(check.bits));
    print_entry("trouble", lines_of(map, Severity::trouble));
    print_entry("remarks", lines_of(map, Severity::remark));
    print_entry("time", fmt::format("{} ({:.0f} MPixel/s without the file)",
                                    duration(map.milliseconds), megapixels_per_second(map)));
}

nlohmann::ordered_json json_of(const CheckedMap& map) {
    if (!map.error.empty())
        return {{"file", map.file.string()}, {"sound", false}, {"error", map.error}};
    const NormalMapCheck& check = map.check;
    return {{"file", map.file.string()},
            {"sound", map.is_sound()},
            {"width", map.width},
            {"height", map.height},
            {"channels", map.channels},
            {"bits", map.bits},
            {"content", name_of(check.content, content_names())},
            {"curve", name_of(check.curve, curve_names())},
            {"color_tag", map.color_tag},
            {"lengths", lengths_json(check.lengths)},
            {"lengths_uncurved", lengths_json(check.lengths_uncurved)},
            {"green", green_json(check)},
            {"zero_code", name_of(check.flat, zero_code_choices())},
            {"seams", {check.tiling.seam_x, check.tiling.seam_y}},
            {"bits_used", check.bits},
            {"alpha_correlation", check.alpha_correlation
                                      ? nlohmann::ordered_json(*check.alpha_correlation)
                                      : nlohmann::ordered_json()},
            {"trouble", findings_json(map, Severity::trouble)},
            {"remarks", findings_json(map, Severity::remark)},
            {"milliseconds", map.milliseconds},
            {"megapixels_per_second", megapixels_per_second(map)}};
}

}  // namespace relief::tools
