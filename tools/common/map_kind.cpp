// SPDX-License-Identifier: Apache-2.0
#include "common/map_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <variant>

#include "common/file_jobs.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_kind_check.h"
#include "relief/mesh/texture_file.h"

namespace relief::tools {
namespace {

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

RefusedMap refused(const MapInput& input, const WrongMapKind& wrong) {
    const MapKind wanted = input.accepted.front();
    std::string remedy = fmt::format("give {}", map_kind_info(wanted).phrase);
    for (const KindRemedy& known : remedies) {
        if (known.from == wrong.kind && known.to == wanted) remedy = known.text;
    }
    return {failure(input.file, wrong.problem,
                    fmt::format("{}; --assume {} reads it anyway", remedy, enum_name(wanted))),
            wanted};
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

void check_normal_channels(const std::filesystem::path& file, int channels) {
    if (channels > 1) return;
    throw RefusedMap(failure(file, "has 1 channel, but normals need at least 2",
                             "relief-bake bump converts height maps"),
                     std::nullopt);
}

bool check_stated_kind(const MapInput& input, const AssumedKinds& assumed) {
    const MapKind wanted = input.accepted.front();
    const bool wants_normals = wanted == MapKind::normal || wanted == MapKind::object_normal;
    if (wants_normals && input.channels > 0) check_normal_channels(input.file, input.channels);
    if (std::ranges::count(assumed, wanted) > 0) return true;
    const MapDescription stated = read_description(input.metadata);
    if (const auto wrong = stated_wrong_kind(input.accepted, stated)) throw refused(input, *wrong);
    return stated.kind.has_value();
}

void check_judged_kind(const MapInput& input, const ImageView& image) {
    if (!is_judged_by_texels(input.accepted)) return;
    const auto content = unstated_content(image, read_description(input.metadata));
    if (!content) return;
    if (const auto wrong = judged_wrong_kind(input.accepted, *content))
        throw refused(input, *wrong);
}

std::map<std::string, std::string> check_kind(const std::filesystem::path& file,
                                              const std::vector<MapKind>& accepted,
                                              const AssumedKinds& assumed) {
    const ImageInfo info = read_image_info(file);
    const MapInput input = {file, accepted, info.metadata, info.channels};
    if (!check_stated_kind(input, assumed) && is_judged_by_texels(accepted))
        check_judged_kind(input, read_sample(file));
    return input.metadata;
}

Report without_assumed(const Report& report, const AssumedKinds& assumed) {
    Report rest;
    for (const Finding& finding : report.findings()) {
        const bool is_assumed = std::ranges::any_of(assumed, [&](MapKind kind) {
            // The space of normals has an option of its own.
            return finding.outcome == drawn_as(kind) ||
                   (kind == MapKind::normal && finding.outcome == drawn_as(MapKind::object_normal));
        });
        if (!is_assumed) rest.add(finding);
    }
    return rest;
}

}  // namespace relief::tools
