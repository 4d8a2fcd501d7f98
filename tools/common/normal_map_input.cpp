// SPDX-License-Identifier: Apache-2.0
#include "common/normal_map_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "common/command.h"
#include "common/options.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map_check.h"

namespace relief::tools {
namespace {

/// Returns the direction of green in the metadata of the file.
std::optional<Green> recorded_green(const std::map<std::string, std::string>& metadata) {
    const auto entry = metadata.find("relief:green");
    if (entry == metadata.end()) return std::nullopt;
    if (entry->second == "up") return Green::up;
    if (entry->second == "down") return Green::down;
    return std::nullopt;
}

std::string green_text(const MapInputOptions& options, const InputMap& map) {
    if (!map.green) return "green unknown";
    const char* source = options.detects_green ? "from its slopes"
                         : options.green       ? "given"
                                               : "from its metadata";
    return fmt::format("green {} ({})", enum_name(*map.green), source);
}

std::string zero_text(const MapInputOptions& options, const InputMap& map) {
    if (options.is_signed) return "zero is 0 (given)";
    if (map.image.bits() == 32) return "zero is 0.5";
    const char* source = options.flat                           ? "given"
                         : map.metadata.contains("relief:flat") ? "from its metadata"
                                                                : "the default of glTF";
    return fmt::format("zero is {} of 255 ({})", enum_name(map.flat), source);
}

/// Returns whether more than one in a thousand float samples is negative. Fewer may be overshoots
/// of a filter.
bool has_negative_samples(const Image& image) {
    std::size_t below = 0;
    for (const float sample : image.as<float>())
        below += sample < -0.01F ? 1 : 0;
    return below > image.sample_count() / 1000;
}

/// Converts signed float samples to (n + 1) / 2, except alpha.
void convert_signs(const std::filesystem::path& file, bool is_signed, Image& image) {
    if (image.bits() != 32) {
        if (is_signed)
            throw UsageError(
                fmt::format("--input-signed: {} has {} bits, but only floats can be signed",
                            file.string(), image.bits()));
        return;
    }
    if (!is_signed && has_negative_samples(image)) {
        throw failure(file, "has samples below 0, so it stores n instead of (n + 1) / 2",
                      "give --input-signed");
    }
    if (!is_signed) return;
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::span<float> samples = image.as<float>();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (i % channels < 3) samples[i] = (samples[i] + 1.0F) / 2.0F;
    }
}

/// Detects the direction of green from the slopes of a map. The metadata is ignored.
Green detected_green(const std::filesystem::path& file, const Image& image) {
    const std::optional<Green> green = check_normal_map(image).green.green;
    if (green) return *green;
    throw failure(file, "its slopes do not determine the direction of green",
                  "give up or down instead of auto");
}

void check_channels(const std::filesystem::path& file, int channels) {
    if (channels > 1) return;
    throw failure(file, "has 1 channel, but normals need at least 2",
                  "relief-bake bump converts height maps");
}

}  // namespace

InputMap read_normal_map(const std::filesystem::path& file, const MapInputOptions& options) {
    InputMap map;
    ImageInfo info = read_image_info(file);
    check_channels(file, info.channels);
    map.image = read_image(file, ImageUse::data);
    convert_signs(file, options.is_signed, map.image);
    map.metadata = std::move(info.metadata);
    map.green = options.green ? options.green : recorded_green(map.metadata);
    if (options.detects_green) map.green = detected_green(file, map.image);
    if (options.flat)
        map.flat = *options.flat;
    else if (map.image.channels > 2)
        map.flat = detect_flat_code(map.image, map.metadata);
    map.conventions = green_text(options, map) + ", " + zero_text(options, map);
    return map;
}

std::map<std::string, std::string> kept_metadata(const std::map<std::string, std::string>& all) {
    constexpr std::array<std::string_view, 10> about_the_work = {
        "Title",   "Author", "Artist",   "Copyright", "Description",
        "Comment", "Source", "comments", "owner",     "Disclaimer"};
    std::map<std::string, std::string> kept;
    for (const auto& [key, value] : all) {
        const bool keeps =
            key.starts_with("relief:") ||
            std::find(about_the_work.begin(), about_the_work.end(), key) != about_the_work.end();
        if (keeps) kept.emplace(key, value);
    }
    return kept;
}

}  // namespace relief::tools
