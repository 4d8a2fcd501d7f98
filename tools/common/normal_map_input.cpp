// SPDX-License-Identifier: Apache-2.0
#include "common/normal_map_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "common/command.h"
#include "common/options.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/normal_map_file.h"
#include "relief/mesh/texture_file.h"

namespace relief::tools {

namespace {

std::string green_text(const MapInputOptions& options, const InputMap& map) {
    if (!map.green) return "green unknown";
    const char* source = options.detects_green ? "from its slopes"
                         : options.green       ? "given"
                                               : "from its metadata";
    return fmt::format("green {} ({})", enum_name(*map.green), source);
}

std::string zero_text(const MapInputOptions& options, const InputMap& map) {
    if (options.is_signed) return "zero is 0 (given)";
    if (map.info.bits == 32) return "zero is 0.5";
    const char* source = options.flat                          ? "given"
                         : read_description(map.metadata).flat ? "from its metadata"
                                                               : "the default of glTF";
    return fmt::format("zero is {} of 255 ({})", enum_name(map.flat), source);
}

/// Counts float samples that only n has. A few may be overshoots of a filter.
std::size_t count_negative(std::span<const float> samples) {
    return static_cast<std::size_t>(
        std::ranges::count_if(samples, [](float sample) { return sample < -0.01F; }));
}

std::size_t count_negative(ImageRowReader& rows) {
    std::vector<float> row(rows.row_bytes() / sizeof(float));
    std::size_t count = 0;
    while (rows.next_row() < rows.info().height) {
        rows.read(std::as_writable_bytes(std::span(row)));
        count += count_negative(row);
    }
    return count;
}

/// \param negative  the number of negative samples. \throws UsageError, FileError if the samples do
/// not have the form that is given
void check_signs(const std::filesystem::path& file, bool is_signed, const ImageInfo& info,
                 const std::function<std::size_t()>& negative) {
    if (info.bits != 32 && is_signed) {
        throw UsageError(
            fmt::format("--input-signed: {} has {} bits, but only floats can be signed",
                        file.string(), info.bits));
    }
    if (info.bits != 32 || is_signed) return;
    const auto samples = static_cast<std::size_t>(info.width) *
                         static_cast<std::size_t>(info.height) *
                         static_cast<std::size_t>(info.channels);
    if (negative() > samples / 1000) {
        throw failure(file, "has samples below 0, so it stores n instead of (n + 1) / 2",
                      "give --input-signed");
    }
}

/// Detects the direction of green from the slopes of a map. The metadata is ignored.
Green detected_green(const std::filesystem::path& file, const Image& image) {
    const std::optional<Green> green = check_normal_map(image).green.green;
    if (green) return *green;
    throw failure(file, "its slopes do not determine the direction of green",
                  "give up or down instead of auto");
}

/// Returns whether a file has more bytes of samples than `max_memory`, and can be read by rows.
bool leaves_samples(const std::filesystem::path& file, const ImageInfo& info,
                    std::size_t max_memory) {
    const std::size_t row = static_cast<std::size_t>(info.width) *
                            static_cast<std::size_t>(info.channels * info.bits / 8);
    if (row * static_cast<std::size_t>(info.height) <= max_memory) return false;
    return ImageRowReader(file).is_streamed();
}

void check_map_kind(const std::filesystem::path& file, const MapInputOptions& options,
                    const InputMap& map) {
    if (options.needs_z) require_z(file, map);
    const MapInput input = {file, options.accepted, map.info.metadata, map.info.channels};
    if (check_stated_kind(input, options.assumed) || !options.judges_texels) return;
    if (!map.image.empty()) return check_judged_kind(input, map.image);
    Image sample = read_sample(file);
    if (options.is_signed) remove_signs(sample);
    check_judged_kind(input, sample);
}

}  // namespace

AddedOption add_green_choice(CLI::App& app, const std::string& name, MapInputOptions& input,
                             const std::string& description) {
    Choices<std::optional<Green>> choices = {{"auto", std::nullopt}};
    for (const auto& [word, green] : enum_choices<Green>())
        choices.emplace_back(word, green);
    return add_value(app, name, "up|down|auto", description,
                     [&input, choices](const std::string& subject, const std::string& text) {
                         input.green = parse_choice(subject, text, choices);
                         input.detects_green = !input.green;
                     });
}

void require_z(const std::filesystem::path& file, const InputMap& map) {
    if (map.info.channels < 3 || !read_description(map.info.metadata).xy_only) return;
    throw failure(file, "has only x and y, as its metadata say",
                  "compute z with relief-bake convert --rebuild-z rg");
}

InputMap read_normal_map(const std::filesystem::path& file, const MapInputOptions& options) {
    return open_normal_map(file, options, std::numeric_limits<std::size_t>::max());
}

InputMap open_normal_map(const std::filesystem::path& file, const MapInputOptions& options,
                         std::size_t max_memory) {
    InputMap map;
    bool has_new_z = false;
    map.info = read_image_info(file);
    check_normal_channels(file, map.info.channels);
    if (options.detects_green || !leaves_samples(file, map.info, max_memory)) {
        map.image =
            options.is_signed ? read_image(file, ImageUse::data) : read_normal_map_image(file);
        has_new_z = map.image.channels != map.info.channels;
        map.info.channels = map.image.channels;
        check_signs(file, options.is_signed, map.info,
                    [&] { return count_negative(map.image.as<float>()); });
        if (options.is_signed) remove_signs(map.image);
    } else {
        check_signs(file, options.is_signed, map.info, [&] {
            ImageRowReader rows(file);
            return count_negative(rows);
        });
    }
    map.metadata = map.info.metadata;
    check_map_kind(file, options, map);
    map.green = options.green ? options.green : read_description(map.metadata).green;
    if (options.detects_green) map.green = detected_green(file, map.image);
    if (options.flat) {
        map.flat = *options.flat;
    } else if (map.info.channels > 2) {
        // Only the metadata decides; the samples may be in the file.
        const Image any = make_image(1, 1, 3, 8, ColorSpace::data);
        map.flat = detect_flat_code(any, map.metadata);
    }
    map.conventions = green_text(options, map) + ", " + zero_text(options, map);
    if (has_new_z) map.conventions += ", z computed from x and y";
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
