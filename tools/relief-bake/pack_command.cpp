// SPDX-License-Identifier: Apache-2.0
// The command `relief-bake pack`: occlusion, roughness and metalness in the channels of one image,
// as an engine reads them. Codes of the same depth are kept. Tests:
// tests/tools/relief_bake_pack_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include "commands.h"
#include "common/map_kind.h"
#include "common/options.h"
#include "common/summary.h"
#include "engines.h"
#include "pack.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

struct PackRequest {
    std::filesystem::path output;
    PackContents contents;
    ReportOptions report;
    GeneralOptions general;
};

/// Parses "0.5", "FILE" or "FILE:g".
ChannelInput parse_input(const std::string& subject, const std::string& text) {
    const bool is_number =
        text.find_first_not_of("0123456789.") == std::string::npos && text.front() != '/';
    if (is_number) return parse_number(subject, text, {0.0, 1.0, ""});
    constexpr std::string_view letters = "rgba";
    const bool names_channel = text.size() > 2 && text[text.size() - 2] == ':' &&
                               letters.find(text.back()) != std::string_view::npos;
    if (!names_channel) return ChannelFile{text, std::nullopt};
    return ChannelFile{text.substr(0, text.size() - 2),
                       static_cast<int>(letters.find(text.back()))};
}

void add_input(CLI::App& app, const std::string& name, std::optional<ChannelInput>& target,
               const std::string& description) {
    add_value(app, name, "FILE[:r|g|b|a]|V", description,
              [&target](const std::string& subject, const std::string& text) {
                  target = parse_input(subject, text);
              })
        .group("Maps");
}

/// Returns the source of a channel. Maps that are not given are 1, and metalness is 0.
ChannelSource source_of(const PackContents& request, PackedChannel channel) {
    switch (channel) {
        case PackedChannel::occlusion:
            return {channel, request.occlusion.value_or(1.0), false};
        case PackedChannel::metalness:
            return {channel, request.metalness.value_or(0.0), false};
        case PackedChannel::roughness:
            if (request.smoothness) return {channel, *request.smoothness, true};
            return {channel, request.roughness.value_or(1.0), false};
        case PackedChannel::smoothness:
            if (request.smoothness) return {channel, *request.smoothness, false};
            return {channel, request.roughness.value_or(1.0), true};
        case PackedChannel::zero:
            break;
    }
    return {channel, 0.0, false};
}

std::string to_string(const ChannelSource& source) {
    const std::string inverted = source.is_inverted ? "1 - " : "";
    if (const auto* constant = std::get_if<double>(&source.input)) {
        if (source.content == PackedChannel::zero) return "0";
        return fmt::format("{} {}{:g}", enum_name(source.content), inverted, *constant);
    }
    const auto& file = std::get<ChannelFile>(source.input);
    return fmt::format("{} {}{}{}", enum_name(source.content), inverted, file.file.string(),
                       file.channel ? fmt::format(", {}", "rgba"[*file.channel]) : "");
}

/// Returns the kinds of maps that may hold a property. A packed map has several.
std::vector<MapKind> accepted_kinds(PackedChannel content) {
    if (content == PackedChannel::occlusion) return {MapKind::occlusion, MapKind::packed};
    if (content == PackedChannel::metalness) return {MapKind::metalness, MapKind::packed};
    return {MapKind::roughness, MapKind::packed};
}

/// Returns whether red, green and blue are equal in every texel.
bool is_gray(const Image& image) {
    if (image.channels < 3) return true;
    return std::visit(
        [&](const auto& samples) {
            const auto channels = static_cast<std::size_t>(image.channels);
            for (std::size_t i = 0; i < samples.size(); i += channels) {
                if (samples[i] != samples[i + 1] || samples[i] != samples[i + 2]) return false;
            }
            return true;
        },
        image.samples);
}

}  // namespace

int channel_to_read(const ChannelFile& file, const Image& image) {
    if (file.channel) {
        // The second channel of two is alpha.
        const bool is_alpha_of_gray = image.channels == 2 && *file.channel == 3;
        if (is_alpha_of_gray) return 1;
        if (*file.channel < image.channels && (image.channels != 2 || *file.channel == 0))
            return *file.channel;
        throw failure(
            file.file, fmt::format("has no channel {}", "rgba"[*file.channel]),
            fmt::format("it has {}", counted(static_cast<std::size_t>(image.channels), "channel")));
    }
    if (!is_gray(image)) {
        throw failure(file.file, "is not gray",
                      fmt::format("name the channel: {}:g", file.file.string()));
    }
    return 0;
}

namespace {

double value_of(std::uint8_t code) {
    return code / 255.0;
}
double value_of(std::uint16_t code) {
    return code / 65535.0;
}
double value_of(float value) {
    return value;
}

/// Writes one channel of the packed image.
template <typename Code>
void fill_channel(std::span<Code> codes, std::size_t channel, std::size_t channels,
                  const ChannelSource& source, const Image* image, int from, Report& report) {
    constexpr double largest = sizeof(Code) == 1 ? 255.0 : 65535.0;
    const std::size_t texels = codes.size() / channels;
    const auto store = [&](std::size_t texel, double value) {
        if (!(value >= 0.0 && value <= 1.0)) {
            report.add(fmt::format("{} that is not between 0 and 1", enum_name(source.content)),
                       "texel", texel, "is written as the nearest of 0 and 1, or as 0");
            value = value > 1.0 ? 1.0 : 0.0;
        }
        if (source.is_inverted) value = 1.0 - value;
        codes[channels * texel + channel] = static_cast<Code>(std::floor(value * largest + 0.5));
    };
    if (image == nullptr) {
        for (std::size_t i = 0; i < texels; ++i)
            store(i, std::get<double>(source.input));
        return;
    }
    std::visit(
        [&](const auto& samples) {
            const auto step = static_cast<std::size_t>(image->channels);
            for (std::size_t i = 0; i < texels; ++i)
                store(i, value_of(samples[step * i + static_cast<std::size_t>(from)]));
        },
        image->samples);
}

}  // namespace

Packed pack(const PackContents& request) {
    const EngineRules& rules = rules_of(request.engine);
    Packed packed;
    for (int i = 0; i < rules.channels; ++i)
        packed.sources.push_back(source_of(request, rules.packed.at(static_cast<std::size_t>(i))));
    Report report;
    std::optional<std::filesystem::path> first_file;
    for (const bool with_files : {true, false}) {
        for (std::size_t i = 0; i < packed.sources.size(); ++i) {
            const ChannelSource& source = packed.sources[i];
            const auto* file = std::get_if<ChannelFile>(&source.input);
            if ((file != nullptr) != with_files) continue;
            std::optional<Image> image;
            int from = 0;
            if (file != nullptr) {
                check_kind(file->file, accepted_kinds(source.content), request.assumed);
                image = read_image(file->file, ImageUse::data);
                from = channel_to_read(*file, *image);
                if (!first_file) {
                    first_file = file->file;
                    packed.image = make_image(image->width, image->height, rules.channels,
                                              request.bits, ColorSpace::data);
                }
                if (image->width != packed.image.width || image->height != packed.image.height) {
                    throw failure(
                        file->file,
                        fmt::format("is {} x {}, but {} is {} x {}", image->width, image->height,
                                    first_file->string(), packed.image.width, packed.image.height),
                        "resize one of them");
                }
            }
            const Image* const read = image ? &*image : nullptr;
            const auto channels = packed.sources.size();
            if (request.bits == 8) {
                fill_channel(packed.image.as<std::uint8_t>(), i, channels, source, read, from,
                             report);
            } else {
                fill_channel(packed.image.as<std::uint16_t>(), i, channels, source, read, from,
                             report);
            }
        }
    }
    packed.findings.add("", report, packed.image.width);
    return packed;
}

namespace {

/// \throws UsageError, FileError
void check_pack(const PackRequest& request) {
    const PackContents& contents = request.contents;
    if (contents.roughness && contents.smoothness)
        throw UsageError("--roughness, --smoothness: contradict each other", "give one of them");
    std::vector<std::filesystem::path> files = {request.output};
    for (const auto* input :
         {&contents.occlusion, &contents.roughness, &contents.smoothness, &contents.metalness}) {
        if (!*input) continue;
        if (const auto* file = std::get_if<ChannelFile>(&**input)) files.push_back(file->file);
    }
    if (files.size() == 1)
        throw UsageError("no map",
                         "give --occlusion, --roughness, --smoothness or --metalness a file");
    const std::string extension = extension_of(request.output);
    const bool is_image = extension == ".png" || extension == ".tif" || extension == ".tiff";
    if (!is_image && !is_texture(request.output)) {
        throw UsageError(
            fmt::format("{}: the format cannot store packed maps", request.output.string()),
            "use .png, .tif, .ktx2 or .dds");
    }
    for (std::size_t i = 1; i < files.size(); ++i) {
        if (identity_of(files[i]) == identity_of(request.output)) {
            throw UsageError(fmt::format("{}: would replace its input", request.output.string()),
                             "choose another output file");
        }
    }
    check(request.report, files);
    require_folder_of(request.output);
}

ExitCode run_pack(const CLI::App& app, const PackRequest& request) {
    check_pack(request);
    set_thread_limit(request.general.threads);
    Stages stages(request.general.quiet);
    Packed packed = stages.run("pack", [&] { return pack(request.contents); });
    const std::string engine = enum_name(request.contents.engine);
    stages.run("write", [&] {
        Report report;
        write_image(
            request.output, packed.image,
            write_description(
                {.kind = MapKind::packed, .detail = engine, .color_space = ColorSpace::data},
                request.contents.bits),
            {}, report);
        packed.findings.add("", report);
    });
    constexpr std::array names = {"red", "green", "blue", "alpha"};
    std::vector<std::string> lines;
    Json channels = Json::array();
    for (std::size_t i = 0; i < packed.sources.size(); ++i) {
        lines.push_back(fmt::format("{}: {}", names.at(i), to_string(packed.sources[i])));
        channels.push_back({{"channel", names.at(i)},
                            {"content", enum_name(packed.sources[i].content)},
                            {"source", to_string(packed.sources[i])}});
    }
    Summary summary;
    summary.add_tool("relief-bake pack");
    summary.add("for", engine, {{"for", engine}, {"output", request.output.string()}});
    summary.add("map",
                fmt::format("{} x {}, {}, {} bit", packed.image.width, packed.image.height,
                            counted(packed.sources.size(), "channel"), request.contents.bits),
                {{"width", packed.image.width},
                 {"height", packed.image.height},
                 {"bits", request.contents.bits}});
    summary.add("channels", lines, {{"channels", std::move(channels)}});
    summary.add_findings(packed.findings);
    summary.add_times(stages);
    summary.add("wrote", file_and_size(request.output));
    if (!request.general.quiet) summary.print();
    return finish(app, request.report, request.output, packed.findings, summary.json());
}

void add_pack_options(CLI::App& app, PackRequest& request) {
    add_file(app, "OUT", request.output,
             "Image to write (.png .tif), or texture (.ktx2 .dds) in bc7 with mip "
             "levels.");
    add_input(app, "--occlusion", request.contents.occlusion,
              "Ambient occlusion: a gray image, a channel of an image (FILE:g), or a value from 0 "
              "to 1. Default: 1, not occluded.");
    add_input(app, "--roughness", request.contents.roughness, "Roughness. Default: 1.");
    add_input(app, "--smoothness", request.contents.smoothness,
              "Smoothness, 1 - roughness, in place of --roughness.");
    add_input(app, "--metalness", request.contents.metalness, "Metalness. Default: 0.");
    add_choice(app, "--for", request.contents.engine, enum_choices<Engine>(),
               "Channels: occlusion, roughness, metalness (gltf, godot, unreal), or metalness, "
               "occlusion, 0, smoothness in alpha (unity). Default: gltf.")
        .group("Output");
    add_choice(app, "--bits", request.contents.bits, Choices<int>{{"8", 8}, {"16", 16}},
               "Bits per channel. Default: 8.")
        .group("Output");
    add_assume_option(app, request.contents.assumed,
                      {MapKind::occlusion, MapKind::roughness, MapKind::packed})
        .group("Maps");
    add_report_options(app, request.report);
    add_general_options(app, request.general);
    set_examples(app, {"relief-mesh subdivide data/vase.obj out/high.obj --levels 2",
                       "relief-bake mesh out/high.obj data/vase.obj out/vase-normal.png --size 64 "
                       "--occlusion-map out/vase-occlusion.png",
                       "relief-bake pack out/vase-orm.png --occlusion out/vase-occlusion.png "
                       "--roughness 0.6",
                       "relief-bake pack out/vase_MaskMap.png --occlusion out/vase-occlusion.png "
                       "--roughness 0.6 --for unity"});
}

}  // namespace

Command add_pack_command(CLI::App& tool) {
    return add_command<PackRequest>(
        tool, "pack", "Packs occlusion, roughness and metalness into the channels of one image.",
        add_pack_options, run_pack);
}

}  // namespace relief::tools
