// SPDX-License-Identifier: Apache-2.0
#include "common/map_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <variant>

#include "common/file_jobs.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/texture_file.h"

namespace relief::tools {
namespace {

bool holds_normals(MapKind kind) {
    return kind == MapKind::normal || kind == MapKind::object_normal ||
           kind == MapKind::world_normal;
}

/// The way from one kind to another.
struct KindRemedy {
    MapKind from;
    MapKind to;
    std::string_view text;
};

constexpr KindRemedy remedies[] = {
    {MapKind::height, MapKind::normal, "convert it with relief-bake bump"},
    {MapKind::normal, MapKind::height, "convert it with relief-bake heights"},
    {MapKind::object_normal, MapKind::normal,
     "convert it with relief-bake convert --to-tangent MESH"},
    {MapKind::slope_moments, MapKind::normal, "write normals with relief-bake bump"},
};

/// \param is  the kind of the file; absent: no known one
FileError wrong_kind(const MapInput& input, std::optional<MapKind> is, const std::string& problem) {
    const MapKind wanted = input.accepted.front();
    std::string remedy = fmt::format("give {}", map_kind_info(wanted).phrase);
    for (const KindRemedy& known : remedies) {
        if (known.from == is && known.to == wanted) remedy = known.text;
    }
    return failure(input.file, problem,
                   fmt::format("{}; --assume {} reads it anyway", remedy, enum_name(wanted)));
}

/// The kind that an image without normals seems to have.
struct JudgedKind {
    std::optional<MapKind> kind;
    const char* phrase;
};

JudgedKind judged_kind(MapContent content) {
    switch (content) {
        case MapContent::gray:
            return {MapKind::height,
                    "is gray, like a height map or a mask, so it is not a normal map"};
        case MapContent::other:
            return {std::nullopt, "is not a normal map: its texels are colors, or several masks"};
        case MapContent::object_normals:
            return {MapKind::object_normal, "seems to be a normal map in object space"};
        default:
            return {MapKind::normal, "seems to be a normal map"};
    }
}

}  // namespace

AddedOption add_assume_option(CLI::App& app, AssumedKinds& assumed,
                              const std::vector<MapKind>& kinds) {
    Choices<MapKind> choices;
    for (const MapKind kind : kinds)
        choices.emplace_back(enum_name(kind), kind);
    std::vector<std::string_view> names;
    for (const auto& [name, kind] : choices)
        names.push_back(name);
    return add_repeatable(
        app, "--assume", fmt::format("{}", fmt::join(names, "|")),
        "Read a file as a map of this kind, whatever its metadata and its texels say. Default: a "
        "map of another kind is an error.",
        [&assumed, choices](const std::string& subject, const std::string& text) {
            assumed.push_back(parse_choice(subject, text, choices));
        });
}

Image read_sample(const std::filesystem::path& file) {
    constexpr int bands = 8;
    constexpr int rows_of_band = 32;
    const std::string extension = extension_of(file);
    const bool is_texture = extension == ".ktx2" || extension == ".dds";
    if (is_texture || read_image_info(file).height < bands * rows_of_band)
        return read_normal_map_image(file);
    ImageRowReader rows(file);
    const ImageInfo& info = rows.info();
    Image sample =
        make_image(info.width, bands * rows_of_band, info.channels, info.bits, ColorSpace::data);
    std::visit(
        [&](auto& samples) {
            const auto all = std::as_writable_bytes(std::span(samples));
            const std::size_t bytes = rows.row_bytes() * rows_of_band;
            for (int band = 0; band < bands; ++band) {
                rows.skip(info.height / bands * band - rows.next_row());
                rows.read(all.subspan(bytes * static_cast<std::size_t>(band), bytes));
            }
        },
        sample.samples);
    return sample;
}

bool check_stated_kind(const MapInput& input, const AssumedKinds& assumed) {
    if (std::ranges::count(assumed, input.accepted.front()) > 0) return true;
    const std::optional<MapKind> stated = read_description(input.metadata).kind;
    if (!stated) return false;
    if (std::ranges::count(input.accepted, *stated) > 0) return true;
    throw wrong_kind(input, stated,
                     fmt::format("is {}, as its metadata say", map_kind_info(*stated).phrase));
}

void check_judged_kind(const MapInput& input, const ImageView& image) {
    const MapKind wanted = input.accepted.front();
    if (!holds_normals(wanted) && wanted != MapKind::height) return;
    if (static_cast<std::int64_t>(image.width) * image.height < min_judged_texels) return;
    const MapContent content =
        judged_content(image, read_description(input.metadata).flat.value_or(FlatCode::half));
    const JudgedKind judged = judged_kind(content);
    // Colors may be heights: their mean is read, with a finding.
    if (wanted == MapKind::height && !(judged.kind && holds_normals(*judged.kind))) return;
    if (judged.kind && std::ranges::count(input.accepted, *judged.kind) > 0) return;
    throw wrong_kind(input, judged.kind, judged.phrase);
}

std::map<std::string, std::string> check_kind(const std::filesystem::path& file,
                                              const std::vector<MapKind>& accepted,
                                              const AssumedKinds& assumed) {
    const MapInput input = {file, accepted, read_image_info(file).metadata};
    const bool is_judged = holds_normals(accepted.front()) || accepted.front() == MapKind::height;
    if (!check_stated_kind(input, assumed) && is_judged)
        check_judged_kind(input, read_sample(file));
    return input.metadata;
}

}  // namespace relief::tools
