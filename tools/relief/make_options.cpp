// SPDX-License-Identifier: Apache-2.0
// The options of an asset. Tests: tests/make/make_options_test.cpp.
#include "make_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <sstream>

#include "common/error_bound.h"
#include "common/file_jobs.h"
#include "common/model_file.h"
#include "common/view_direction.h"

namespace relief::tools {
namespace {

using Words = std::vector<std::string>;

/// Parses "height,curvature".
std::vector<LayerKind> parse_layers(const std::string& subject, const std::string& text) {
    const Choices<LayerKind> choices = {
        {"height", LayerKind::height},       {"curvature", LayerKind::curvature},
        {"position", LayerKind::position},   {"bent", LayerKind::bent_normal},
        {"thickness", LayerKind::thickness}, {"ids", LayerKind::id}};
    std::vector<LayerKind> layers;
    std::istringstream names(text);
    for (std::string name; std::getline(names, name, ',');) {
        const auto kind = parse_choice<LayerKind>(subject, name, choices);
        if (std::ranges::find(layers, kind) != layers.end())
            throw UsageError(fmt::format("{}: {} is named twice", subject, name));
        layers.push_back(kind);
    }
    if (layers.empty()) throw UsageError(subject + ": names no layer");
    return layers;
}

/// Parses "2048" or "2048x1024".
glm::ivec2 parse_map_size(const std::string& subject, const std::string& text) {
    if (text.find('x') != std::string::npos) return parse_size(subject, text);
    return glm::ivec2(parse_integer(subject, text, 16, 16384));
}

double degrees_of(double radians) {
    return radians * 180.0 / std::numbers::pi;
}

/// Parses "60" or "none".
std::optional<double> parse_crease(const std::string& subject, const std::string& text) {
    if (text == "none") return std::nullopt;
    return parse_number(subject, text, {0.0, 180.0, "degrees"}) * std::numbers::pi / 180;
}

std::string crease_text(const std::optional<double>& angle) {
    return angle ? fmt::format("{:.6g}", degrees_of(*angle)) : "none";
}

std::string not_remeshed(const MakeRequest& request) {
    const bool can_remesh =
        request.asset.remesh != make::Remeshing::never && !request.asset.keep_texcoords;
    return can_remesh ? "" : "nothing is remeshed";
}

std::string not_measured(const MakeRequest& request) {
    return request.measures_loss || request.limits.any() ? "" : "no loss is measured";
}

std::vector<MakeOption> source_options() {
    return {
        {.name = "with",
         .key = "with",
         .stage = "",
         .heading = "Source",
         .values = OptionValues::files,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_repeatable(
                 app, option, "FILE",
                 "A further file of the dense model, in the same space as IN. Can be repeated. "
                 "Only for one asset.",
                 [&request](const std::string&, const std::string& text) {
                     readable_format(text);
                     request.more_sources.emplace_back(text);
                 });
         },
         .value = [](const MakeRequest& request) -> Json {
             return json_list(request.more_sources, [](const std::filesystem::path& file) -> Json {
                 return file.string();
             });
         },
         .words = [](const MakeRequest& request) -> Words {
             Words words;
             for (const std::filesystem::path& file : request.more_sources)
                 words.push_back(quoted(file));
             return words;
         }},
        {.name = "up",
         .key = "up",
         .stage = "repair",
         .heading = "Source",
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_choice(
                 app, option, request.up, enum_choices<shade::UpAxis>(),
                 "The axis of the model that points up. In the asset it is y, as glTF requires. "
                 "auto is z for STL files and y for others, as in relief-view. Default: auto.");
         },
         .value = [](const MakeRequest& request) -> Json { return enum_name(request.up); },
         .words = [](const MakeRequest& request) -> Words {
             if (request.up == shade::UpAxis::automatic) return {};
             return {enum_name(request.up)};
         }},
        {.name = "source-crease",
         .key = "source_crease",
         .stage = "repair",
         .heading = "Source",
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(
                 app, option, "DEGREES",
                 "For a model without normals: edges with a larger angle between their triangles "
                 "are hard. none: all are smooth. Default: 30 for STL files, as in relief-view, "
                 "and otherwise that of --crease.",
                 [&request](const std::string& subject, const std::string& text) {
                     request.source_crease = parse_crease(subject, text);
                 });
         },
         .value = [](const MakeRequest& request) -> Json {
             if (!request.source_crease) return "auto";
             if (!*request.source_crease) return nullptr;
             return degrees_of(**request.source_crease);
         },
         .words = [](const MakeRequest& request) -> Words {
             if (!request.source_crease) return {};
             return {crease_text(*request.source_crease)};
         }},
    };
}

std::vector<MakeOption> shape_options() {
    constexpr std::string_view shape = "Shape";
    return {
        {.name = "triangles",
         .key = "triangles",
         .stage = "decimate",
         .heading = shape,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(app, option, "N",
                              "The number of triangles of the asset. Default: 5000.",
                              [&request](const std::string& subject, const std::string& text) {
                                  request.asset.triangles = static_cast<std::size_t>(parse_integer(
                                      subject, text, 1, std::numeric_limits<int>::max()));
                              });
         },
         .value = [](const MakeRequest& request) -> Json { return request.asset.triangles; }},
        {.name = "crease",
         .key = "crease",
         .stage = "unwrap",
         .heading = shape,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(
                 app, option, "DEGREES",
                 "Edges with a larger angle between their triangles are hard: normals differ on "
                 "both sides, and charts end there. none: all edges are smooth. Default: 60.",
                 [&request](const std::string& subject, const std::string& text) {
                     request.asset.crease_angle = parse_crease(subject, text);
                 });
         },
         .value = [](const MakeRequest& request) -> Json {
             if (!request.asset.crease_angle) return nullptr;
             return degrees_of(*request.asset.crease_angle);
         },
         .words = [](const MakeRequest& request) -> Words {
             return {crease_text(request.asset.crease_angle)};
         }},
        {.name = "lods",
         .key = "lods",
         .stage = "",
         .heading = shape,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(
                 app, option, "N",
                 "The number of levels of detail below the asset, 0 to 16. Each has half the "
                 "triangles of the one before, and the same maps. Default: 0.",
                 [&request](const std::string& subject, const std::string& text) {
                     request.asset.levels =
                         static_cast<std::size_t>(parse_integer(subject, text, 0, 16));
                 });
         },
         .value = [](const MakeRequest& request) -> Json { return request.asset.levels; }},
        {.name = "no-repair",
         .key = "repair",
         .stage = "repair",
         .heading = shape,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_switch(
                 app, option,
                 "Keep the triangles as they are, apart from those without an area or finite "
                 "positions. Otherwise equal vertices are merged, repeated triangles removed, "
                 "parts oriented outwards and non-manifold edges cut (relief-mesh repair).",
                 [&request] { request.asset.repair.reset(); });
         },
         .value = [](const MakeRequest& request) -> Json {
             return request.asset.repair.has_value();
         },
         .words = [](const MakeRequest& request) -> Words {
             return request.asset.repair ? Words{} : Words{""};
         }},
        {.name = "remesh",
         .key = "remesh",
         .stage = "remesh",
         .heading = shape,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_choice(
                 app, option, request.asset.remesh, enum_choices<make::Remeshing>(),
                 "Replace the triangles by a closed surface before they are decimated "
                 "(relief-mesh remesh): always; never; or if one of four printed figures exceeds "
                 "its limit and the surface is near enough (auto). Maps still show the model. "
                 "Default: auto.");
         },
         .value = [](const MakeRequest& request) -> Json {
             return enum_name(request.asset.remesh);
         }},
        {.name = "resolution",
         .key = "resolution",
         .stage = "remesh",
         .heading = shape,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(
                 app, option, "N",
                 "The number of cells of --remesh along the longest side, 8 to 1024. Default: "
                 "256.",
                 [&request](const std::string& subject, const std::string& text) {
                     request.asset.resolution = parse_integer(subject, text, 8, 1024);
                 });
         },
         .value = [](const MakeRequest& request) -> Json { return request.asset.resolution; },
         .useless = not_remeshed},
        {.name = "shell",
         .key = "shell",
         .stage = "remesh",
         .heading = shape,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_switch(
                 app, option, request.asset.shell,
                 "With --remesh, everything within 0.75 cells of a triangle is solid, so that "
                 "open surfaces become shells 1.5 cells thick. Default: only what triangles "
                 "enclose is solid, and sheets vanish.");
         },
         .value = [](const MakeRequest& request) -> Json { return request.asset.shell; },
         .useless = not_remeshed},
        {.name = "sign",
         .key = "sign",
         .stage = "remesh",
         .heading = shape,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_choice(
                 app, option, request.asset.sign, enum_choices<RemeshSign>(),
                 "With --remesh, what is solid: all that cannot be reached from outside (flood), "
                 "or all with a winding number of at least a half, which closes holes of any size "
                 "(winding). Default: flood.");
         },
         .value = [](const MakeRequest& request) -> Json { return enum_name(request.asset.sign); },
         .useless = not_remeshed},
    };
}

std::vector<MakeOption> map_options() {
    constexpr std::string_view maps = "Maps";
    return {
        {.name = "size",
         .key = "size",
         .stage = "unwrap",
         .heading = maps,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(app, option, "N|WxH",
                              "The size of the maps in texels. Default: 2048.",
                              [&request](const std::string& subject, const std::string& text) {
                                  request.asset.size = parse_map_size(subject, text);
                              });
         },
         .value = [](const MakeRequest& request) -> Json {
             return {request.asset.size.x, request.asset.size.y};
         },
         .words = [](const MakeRequest& request) -> Words {
             return {fmt::format("{}x{}", request.asset.size.x, request.asset.size.y)};
         }},
        {.name = "padding",
         .key = "padding",
         .stage = "unwrap",
         .heading = maps,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(
                 app, option, "N",
                 "The distance of charts in texels, and the width of the padding around them, 0 "
                 "to 256. Default: 8.",
                 [&request](const std::string& subject, const std::string& text) {
                     request.asset.padding = parse_integer(subject, text, 0, 256);
                 });
         },
         .value = [](const MakeRequest& request) -> Json { return request.asset.padding; }},
        {.name = "keep-uvs",
         .key = "keep_uvs",
         .stage = "decimate",
         .heading = maps,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_switch(app, option, request.asset.keep_texcoords,
                               "Keep the texture coordinates of the model instead of computing "
                               "new ones. They must not overlap.");
         },
         .value = [](const MakeRequest& request) -> Json { return request.asset.keep_texcoords; }},
        {.name = "normal-bits",
         .key = "normal_bits",
         .stage = "bake",
         .heading = maps,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_choice<int>(
                 app, option, {{"8", 8}, {"16", 16}},
                 "The bits of the normal map. Few programs read more than 8 from glTF files. "
                 "Default: 8, and 16 if --max-error needs them.",
                 [&request](int bits) { request.asset.normal_bits = bits; });
         },
         .value = [](const MakeRequest& request) -> Json { return request.asset.normal_bits; }},
        {.name = "samples",
         .key = "samples",
         .stage = "bake",
         .heading = maps,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(
                 app, option, "N",
                 "The rays of a texel for normals and colors: 1, 4, 16 or 64. Default: 1.",
                 [&request](const std::string& subject, const std::string& text) {
                     request.asset.samples = parse_choice<int>(
                         subject, text, {{"1", 1}, {"4", 4}, {"16", 16}, {"64", 64}});
                 });
         },
         .value = [](const MakeRequest& request) -> Json { return request.asset.samples; }},
        {.name = "match",
         .key = "match",
         .stage = "bake",
         .heading = maps,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_choice(
                 app, option, request.asset.match, enum_choices<PartMatching>(),
                 "What the rays of a part of the asset hit: auto, only the part of the model of "
                 "the same name, if the model has several; name, the same, and it is an error if "
                 "a mesh of --from has a part without a counterpart; all, all of the model. "
                 "Default: auto.");
         },
         .value = [](const MakeRequest& request) -> Json {
             return enum_name(request.asset.match);
         }},
        {.name = "occlusion-rays",
         .key = "occlusion_rays",
         .stage = "bake",
         .heading = maps,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(
                 app, option, "N",
                 "The rays of a texel of the occlusion map, which has a quarter of their size, "
                 "0 to 4096. 0: there is no occlusion map. Default: 32.",
                 [&request](const std::string& subject, const std::string& text) {
                     request.asset.occlusion_rays = parse_integer(subject, text, 0, 4096);
                     request.asset.occlusion = request.asset.occlusion_rays > 0;
                 });
         },
         .value = [](const MakeRequest& request) -> Json {
             return request.asset.occlusion ? request.asset.occlusion_rays : 0;
         }},
        {.name = "layers",
         .key = "layers",
         .stage = "bake",
         .heading = maps,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_value(
                 app, option, "NAMES",
                 "Also write further layers, from the same rays, as PNG files of 16 bits beside "
                 "the asset: height (of the model above the asset), curvature, position; ids (a "
                 "flat color for each material, of 8 bits); bent (bent normals) and thickness, "
                 "with a quarter of the size and the rays of the occlusion map (32 without one). "
                 "Several are separated by commas.",
                 [&request](const std::string& subject, const std::string& text) {
                     request.asset.layers = parse_layers(subject, text);
                 });
         },
         .value = [](const MakeRequest& request) -> Json {
             return json_list(request.asset.layers,
                              [](LayerKind kind) -> Json { return make::layer_name(kind); });
         },
         .words = [](const MakeRequest& request) -> Words {
             Words names;
             for (const LayerKind kind : request.asset.layers)
                 names.push_back(make::layer_name(kind));
             return names.empty() ? names : Words{fmt::format("{}", fmt::join(names, ","))};
         }},
    };
}

std::vector<MakeOption> output_options() {
    constexpr std::string_view output = "Output";
    return {
        {.name = "for",
         .key = "for",
         .stage = "",
         .heading = output,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_choice(
                 app, option, request.engine, enum_choices<Engine>(),
                 "The engine. unity and unreal: also write maps as PNG files beside the asset, "
                 "with the names, channels and green of the engine. Default: gltf.");
         },
         .value = [](const MakeRequest& request) -> Json { return enum_name(request.engine); }},
        {.name = "loss",
         .key = "loss",
         .stage = "",
         .heading = output,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_switch(
                 app, option, request.measures_loss,
                 "Measure what was lost: differences of pictures (FLIP) with three lights, "
                 "degrees between normals and pixels between silhouettes, in 12 views, after "
                 "each stage, and distances between the surfaces. Needs OpenGL, also without a "
                 "GPU. With --report NAME.html, the report is a page with pictures of the source "
                 "and the asset, also without --loss; for a folder, an index with a picture of "
                 "each asset, worst first.");
         },
         .value = [](const MakeRequest& request) -> Json { return request.measures_loss; }},
        {.name = "view",
         .key = "views",
         .stage = "",
         .heading = output,
         .values = OptionValues::many,
         .add = [](CLI::App& app, const std::string&, MakeRequest& request)
             -> std::optional<AddedOption> { return add_view_option(app, request.more_views); },
         .value = [](const MakeRequest& request) -> Json {
             return json_list(request.more_views, [](const glm::vec3& view) -> Json {
                 return {view.x, view.y, view.z};
             });
         },
         .words = [](const MakeRequest& request) -> Words {
             Words views;
             for (const glm::vec3& view : request.more_views)
                 views.push_back(view_text(view));
             return views;
         },
         .useless = not_measured},
        {.name = "max-error",
         .key = "max_error",
         .stage = "",
         .heading = output,
         .add = [](CLI::App& app, const std::string&,
                   MakeRequest& request) -> std::optional<AddedOption> {
             add_error_bound(
                 app, request.limits.normals, "Output",
                 "The largest angle between normals of the source and the asset, which 99 % of "
                 "the pixels of --loss do not exceed. The asset gets more triangles, up to those "
                 "of the source, larger maps, up to 8192, or normals of 16 bits, from "
                 "--triangles and --size on, in at most 6 attempts. If the limit does not hold "
                 "then, nothing is written.");
             return std::nullopt;
         },
         .value = [](const MakeRequest& request) -> Json {
             return or_null(request.limits.normals.degrees);
         }},
        {.name = "max-error-kind",
         .key = "max_error_kind",
         .stage = "",
         .heading = output,
         .value = [](const MakeRequest& request) -> Json {
             return enum_name(request.limits.normals.statistic());
         },
         .words = [](const MakeRequest& request) -> Words {
             const std::optional<ErrorKind>& kind = request.limits.normals.kind;
             return kind ? Words{std::string(enum_name(*kind))} : Words{};
         }},
        {.name = "max-picture-error",
         .key = "max_picture_error",
         .stage = "",
         .heading = output,
         .add = [](CLI::App& app, const std::string& option,
                   MakeRequest& request) -> std::optional<AddedOption> {
             return add_number(
                 app, option, "FLIP", request.limits.flip, {1e-4, 1.0, ""},
                 "The same for the largest mean FLIP of the three lights. Both limits can be "
                 "given.");
         },
         .value = [](const MakeRequest& request) -> Json { return or_null(request.limits.flip); }},
    };
}

/// Returns the words of an option without words of its own.
Words arguments_of_value(const Json& value) {
    if (value.is_null()) return {};
    if (value.is_boolean()) return value.get<bool>() ? Words{""} : Words{};
    if (value.is_number_float()) return {fmt::format("{}", value.get<double>())};
    return {value.is_string() ? value.get<std::string>() : value.dump()};
}

Words arguments_of(const MakeOption& option, const MakeRequest& request) {
    return option.words != nullptr ? option.words(request)
                                   : arguments_of_value(option.value(request));
}

std::string useless_reason(const MakeOption& option, const MakeRequest& request) {
    return option.useless == nullptr ? "" : option.useless(request);
}

}  // namespace

const std::vector<MakeOption>& make_options() {
    static const std::vector<MakeOption> options = [] {
        std::vector<MakeOption> all;
        for (auto* group : {source_options, shape_options, map_options, output_options})
            std::ranges::move(group(), std::back_inserter(all));
        return all;
    }();
    return options;
}

void add_asset_options(CLI::App& app, MakeRequest& request) {
    for (const MakeOption& option : make_options()) {
        if (option.add == nullptr) continue;
        const auto added = option.add(app, fmt::format("--{}", option.name), request);
        if (added) added->group(std::string(option.heading));
    }
}

void check_asset_options(const CLI::App& app, const MakeRequest& request) {
    const make::AssetOptions& asset = request.asset;
    if (asset.keep_texcoords && asset.remesh == make::Remeshing::always) {
        throw UsageError("--remesh always and --keep-uvs contradict each other",
                         "a closed surface needs new texture coordinates");
    }
    for (const MakeOption& option : make_options()) {
        const std::string name = fmt::format("--{}", option.name);
        const std::string reason = useless_reason(option, request);
        if (reason.empty() || !is_given(app, name)) continue;
        throw UsageError(fmt::format("{}: has no effect, because {}", name, reason),
                         "leave it out");
    }
}

Json options_json(const MakeRequest& request) {
    Json json = Json::object();
    for (const MakeOption& option : make_options())
        json[std::string(option.key)] = option.value(request);
    return json;
}

std::string options_line(const MakeRequest& request) {
    std::string line;
    for (const MakeOption& option : make_options()) {
        if (!useless_reason(option, request).empty()) continue;
        for (const std::string& word : arguments_of(option, request))
            line += fmt::format(" --{}{}{}", option.name, word.empty() ? "" : " ", word);
    }
    return line;
}

std::string option_text(const MakeOption& option, const MakeRequest& request) {
    const Words words = arguments_of(option, request);
    if (words.empty()) return "off";
    return words.front().empty() ? "on" : fmt::format("{}", fmt::join(words, ","));
}

}  // namespace relief::tools
