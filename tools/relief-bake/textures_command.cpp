// SPDX-License-Identifier: Apache-2.0
// `relief-bake textures`: turns the maps of materials into the textures of an engine.
//
// The kind of a map is given, stated by a glTF material or by the metadata of the file, or read
// from its name, in this order. Maps of the same name without the word of their kind are a set.
// Tests: tests/tools/relief_bake_textures_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "commands.h"
#include "common/file_jobs.h"
#include "common/map_kind.h"
#include "common/normal_map_input.h"
#include "common/options.h"
#include "common/summary.h"
#include "engines.h"
#include "file_replacement.h"
#include "map_textures.h"
#include "pack.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_texture.h"
#include "texture_names.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

enum class TextureContainerFormat { ktx2, dds };

struct TexturesRequest {
    std::vector<fs::path> inputs;
    fs::path folder;
    Engine engine = Engine::gltf;
    std::optional<fs::path> model;
    std::map<std::string, MapKind> given_kinds;  ///< By file name.
    TextureContainerFormat container = TextureContainerFormat::ktx2;
    BlockQuality quality = BlockQuality::normal;
    int max_size = 0;  ///< 0: not limited.
    std::optional<int> zstd_level;
    std::optional<Green> input_green;
    ReportOptions report;
    GeneralOptions general;
};

/// A file and what it holds.
struct SourceMap {
    fs::path file;
    NamedMap map;
    std::string reason;  ///< How the kind was recognized: "by its name".
    std::optional<float> alpha_cutoff;
};

/// The maps of one material.
struct TextureSet {
    std::string name;
    std::vector<SourceMap> maps;

    [[nodiscard]] const SourceMap* find(MapKind kind, bool smoothness = false) const {
        for (const SourceMap& source : maps) {
            if (source.map.kind == kind && source.map.is_smoothness == smoothness) return &source;
        }
        return nullptr;
    }
};

/// A texture to write, and the maps it is made of.
struct PlannedTexture {
    fs::path file;
    MapKind kind = MapKind::color;
    const TextureSet* set = nullptr;
};

// Recognition.

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        if (entry.is_regular_file() && has_image_extension(entry.path()))
            files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

/// Returns whether the textures of engines are made of maps of a kind.
bool is_read_by_engines(MapKind kind) {
    return find_map_texture_kind(kind) != nullptr && kind != MapKind::curvature &&
           kind != MapKind::object_normal;
}

/// The kinds of the slots of glTF's metallic-roughness material.
std::optional<MapKind> kind_of_slot(TextureSlot slot) {
    switch (slot) {
        case TextureSlot::base_color:
            return MapKind::color;
        case TextureSlot::metallic_roughness:
            return MapKind::packed;
        case TextureSlot::normal:
            return MapKind::normal;
        case TextureSlot::occlusion:
            return MapKind::occlusion;
        case TextureSlot::emission:
            return MapKind::emission;
        default:
            return std::nullopt;
    }
}

/// The uses of the image files of a model.
struct ModelUse {
    std::string material;
    MapKind kind = MapKind::color;
    bool has_occlusion = false;  ///< Of packed maps: the same image is the occlusion.
    std::optional<float> alpha_cutoff;
};

std::map<fs::path, ModelUse> uses_of_model(const fs::path& file, Report& report) {
    const GltfDocument document = GltfDocument::read(file, report);
    const GltfView view = document.view();
    std::map<fs::path, ModelUse> uses;
    for (std::size_t i = 0; i < view.materials.size(); ++i) {
        const GltfMaterial& material = view.materials[i];
        const std::string name =
            material.name.empty() ? fmt::format("material-{}", i) : material.name;
        for (const TextureSlotInfo& slot : texture_slots) {
            const std::optional<MapKind> kind = kind_of_slot(slot.slot);
            const Texture* const texture = find_texture(material, slot.slot);
            if (!kind || texture == nullptr) continue;
            const auto* const path = std::get_if<fs::path>(&view.images[texture->image].source);
            if (path == nullptr || path->empty()) {
                report.add("embedded image", "image", texture->image,
                           "is not converted (write the model as .gltf with images beside it)");
                continue;
            }
            ModelUse use{name, *kind, false, std::nullopt};
            if (*kind == MapKind::color && material.alpha_mode == AlphaMode::mask)
                use.alpha_cutoff = material.alpha_cutoff;
            const auto [known, is_new] = uses.emplace(identity_of(*path), use);
            if (is_new || known->second.kind == *kind) continue;
            const bool are_occlusion_and_packed =
                std::set<MapKind>{known->second.kind, *kind} ==
                std::set<MapKind>{MapKind::occlusion, MapKind::packed};
            if (!are_occlusion_and_packed) {
                throw failure(*path,
                              fmt::format("is {} and {} in the materials of {}",
                                          map_kind_info(known->second.kind).phrase,
                                          map_kind_info(*kind).phrase, file.string()),
                              "give its kind with --kind FILE=KIND");
            }
            known->second.kind = MapKind::packed;
            known->second.has_occlusion = true;
        }
    }
    return uses;
}

/// Recognizes a file. The kind stays absent if it is not certain.
SourceMap recognized(const fs::path& file, const TexturesRequest& request,
                     const std::map<fs::path, ModelUse>& uses) {
    SourceMap source{file, named_map(file.stem().string()), "by its name", std::nullopt};
    const auto given = request.given_kinds.find(file.filename().string());
    const auto use = uses.find(identity_of(file));
    if (use != uses.end()) {
        source.map.set = use->second.material;
        source.alpha_cutoff = use->second.alpha_cutoff;
    }
    const auto set_kind = [&](MapKind kind, const char* reason) {
        const bool is_same = source.map.kind == kind;
        if (!is_same) {
            const std::string set = source.map.set;
            source.map = NamedMap{};
            source.map.set = set;
        }
        source.map.kind = kind;
        source.map.problem.clear();
        source.reason = reason;
    };
    if (given != request.given_kinds.end()) {
        set_kind(given->second, "as given");
        return source;
    }
    if (use != uses.end()) {
        set_kind(use->second.kind, "by the material");
        source.map.has_occlusion = use->second.has_occlusion;
        source.map.is_unity_mask = false;
        if (source.map.kind == MapKind::normal) source.map.green = Green::up;
        return source;
    }
    const MapDescription stated = read_description(read_image_info(file).metadata);
    if (!stated.kind) return source;
    if (!is_read_by_engines(*stated.kind)) {
        source.map.kind.reset();
        source.map.problem =
            fmt::format("is {}, which engines do not read", map_kind_info(*stated.kind).phrase);
        return source;
    }
    set_kind(*stated.kind, "by its metadata");
    source.map.is_unity_mask = stated.detail == "unity";
    if (stated.green) source.map.green = stated.green;
    return source;
}

/// Uses that of two normal maps with opposite directions of green which the engine expects.
void choose_normal_map(TextureSet& set, Engine engine, Report& report) {
    const Green wanted = rules_of(engine).green;
    const auto has_green = [&](const SourceMap& source, Green green) {
        return source.map.kind == MapKind::normal && source.map.green == green;
    };
    const Green other = wanted == Green::up ? Green::down : Green::up;
    const bool has_wanted =
        std::ranges::any_of(set.maps, [&](const auto& map) { return has_green(map, wanted); });
    if (!has_wanted) return;
    std::erase_if(set.maps, [&](const SourceMap& source) {
        if (!has_green(source, other)) return false;
        report.add(fmt::format("normal map {} with the other direction of green",
                               source.file.filename().string()),
                   "file", 0, "is left out, because the set has one for the engine");
        return true;
    });
}

/// \throws UsageError if two files of a set are maps of the same kind
void check_set(const TextureSet& set) {
    std::map<MapKind, fs::path> known;
    for (const SourceMap& source : set.maps) {
        const auto [first, is_new] = known.emplace(*source.map.kind, source.file);
        if (is_new) continue;
        throw UsageError(
            fmt::format("{} and {}: both are {} of '{}'", first->second.string(),
                        source.file.string(), map_kind_info(*source.map.kind).phrase, set.name),
            "leave one out, or give the kind of one with --kind FILE=KIND");
    }
    const bool has_parts = known.contains(MapKind::roughness) || known.contains(MapKind::metalness);
    if (!known.contains(MapKind::packed) || !has_parts) return;
    throw UsageError(fmt::format("{}: '{}' also has separate maps of roughness or metalness",
                                 known[MapKind::packed].string(), set.name),
                     "leave one of them out");
}

/// \param names_files  files were named, so that each of them must be recognized
std::vector<TextureSet> sets_of(const TexturesRequest& request, Report& report) {
    std::map<fs::path, ModelUse> uses;
    if (request.model) uses = uses_of_model(*request.model, report);
    std::map<std::string, TextureSet> sets;
    std::set<std::string> unused_kinds;
    for (const auto& [name, kind] : request.given_kinds)
        unused_kinds.insert(name);
    for (const fs::path& input : request.inputs) {
        const bool is_folder = fs::is_directory(input);
        for (const fs::path& file : is_folder ? files_in(input) : std::vector<fs::path>{input}) {
            unused_kinds.erase(file.filename().string());
            const SourceMap source = recognized(file, request, uses);
            if (!source.map.kind && !is_folder)
                throw failure(file, source.map.problem, "give its kind with --kind FILE=KIND");
            if (!source.map.kind) {
                report.add(fmt::format("file {}: {}", file.filename().string(), source.map.problem),
                           "file", 0, "is left out (--kind FILE=KIND gives its kind)");
                continue;
            }
            TextureSet& set = sets[source.map.set];
            set.name = source.map.set;
            set.maps.push_back(source);
        }
    }
    if (!unused_kinds.empty())
        throw UsageError(fmt::format("--kind {}: no input has this name", *unused_kinds.begin()));
    std::vector<TextureSet> result;
    for (auto& [name, set] : sets) {
        choose_normal_map(set, request.engine, report);
        check_set(set);
        result.push_back(std::move(set));
    }
    return result;
}

// Planning.

const char* engine_suffix(MapKind kind, const EngineRules& rules) {
    switch (kind) {
        case MapKind::normal:
            return rules.normal_name;
        case MapKind::packed:
            return rules.packed_name;
        case MapKind::color:
            return rules.color_name;
        case MapKind::emission:
            return rules.emission_name;
        default:
            return rules.height_name;
    }
}

std::vector<PlannedTexture> planned(const TexturesRequest& request,
                                    const std::vector<TextureSet>& sets) {
    std::vector<PlannedTexture> textures;
    const EngineRules& rules = rules_of(request.engine);
    const char* const extension =
        request.container == TextureContainerFormat::dds ? ".dds" : ".ktx2";
    for (const TextureSet& set : sets) {
        const auto add = [&](MapKind kind) {
            const std::string name = set.name.empty() ? "material" : set.name;
            textures.push_back(
                {request.folder / (name + engine_suffix(kind, rules) + extension), kind, &set});
        };
        for (const MapKind kind :
             {MapKind::color, MapKind::normal, MapKind::emission, MapKind::height}) {
            if (set.find(kind) != nullptr) add(kind);
        }
        const bool has_parts = set.find(MapKind::packed) != nullptr ||
                               set.find(MapKind::occlusion) != nullptr ||
                               set.find(MapKind::roughness) != nullptr ||
                               set.find(MapKind::roughness, true) != nullptr ||
                               set.find(MapKind::metalness) != nullptr;
        if (has_parts) add(MapKind::packed);
    }
    return textures;
}

/// \throws UsageError if a texture would replace an input, or two have the same name
void check_outputs(const TexturesRequest& request, const std::vector<TextureSet>& sets,
                   const std::vector<PlannedTexture>& textures) {
    std::map<fs::path, std::string> written;
    for (const PlannedTexture& texture : textures) {
        const auto [known, is_new] = written.emplace(identity_of(texture.file), texture.set->name);
        if (!is_new) {
            throw UsageError(fmt::format("{}: would be written for '{}' and '{}'",
                                         texture.file.string(), known->second, texture.set->name),
                             "convert them by separate calls, to different folders");
        }
    }
    std::vector<fs::path> inputs;
    for (const TextureSet& set : sets) {
        for (const SourceMap& source : set.maps) {
            inputs.push_back(source.file);
            if (!written.contains(identity_of(source.file))) continue;
            throw UsageError(fmt::format("{}: would be replaced", source.file.string()),
                             "choose another output folder");
        }
    }
    check(request.report, inputs);
}

// Conversion.

/// Reads normals, y up.
Image read_set_normals(const SourceMap& source, const TexturesRequest& request) {
    MapInputOptions options;
    options.assumed = {MapKind::normal};
    options.green = source.map.green ? source.map.green : request.input_green;
    options.detects_green = !options.green;
    const InputMap map = read_normal_map(source.file, options);
    require_z(source.file, map);
    return decode_normal_map(map.image, map.green.value_or(Green::up), map.flat, IgnoredReport(),
                             FlatTexels::exact);
}

PackContents pack_contents(const TextureSet& set, Engine engine) {
    PackContents contents;
    contents.engine = engine;
    contents.assumed = {MapKind::occlusion, MapKind::roughness, MapKind::metalness,
                        MapKind::packed};
    const auto gray = [&](MapKind kind, bool smoothness) -> std::optional<ChannelInput> {
        const SourceMap* const source = set.find(kind, smoothness);
        if (source == nullptr) return std::nullopt;
        return ChannelFile{source->file, std::nullopt};
    };
    contents.occlusion = gray(MapKind::occlusion, false);
    contents.roughness = gray(MapKind::roughness, false);
    contents.smoothness = gray(MapKind::roughness, true);
    contents.metalness = gray(MapKind::metalness, false);
    const SourceMap* const packed = set.find(MapKind::packed);
    if (packed == nullptr) return contents;
    if (packed->map.is_unity_mask) {
        contents.metalness = ChannelFile{packed->file, 0};
        contents.smoothness = ChannelFile{packed->file, 3};
        if (!contents.occlusion) contents.occlusion = ChannelFile{packed->file, 1};
        return contents;
    }
    if (packed->map.has_occlusion && !contents.occlusion)
        contents.occlusion = ChannelFile{packed->file, 0};
    contents.roughness = ChannelFile{packed->file, 1};
    contents.metalness = ChannelFile{packed->file, 2};
    return contents;
}

bool is_power_of_two(int side) {
    return side > 0 && (side & (side - 1)) == 0;
}

/// The result of a texture.
struct FinishedTexture {
    WrittenTexture written;
    std::vector<std::string> sources;
    Findings findings;
};

/// Replaces a map by the first of its mip levels within the limit.
void limit_size(int max_size, const MapTextureOptions& options, const Image* normals, Image& map) {
    if (max_size == 0 || std::max(map.width, map.height) <= max_size) return;
    for (Image& level : map_mip_levels(map, options, normals)) {
        if (std::max(level.width, level.height) > max_size) continue;
        map = std::move(level);
        return;
    }
}

FinishedTexture convert_texture(const PlannedTexture& planned, const TexturesRequest& request) {
    FinishedTexture result;
    Report report;
    const TextureSet& set = *planned.set;
    MapTextureOptions options;
    options.kind = planned.kind;
    options.quality = request.quality;
    options.green = rules_of(request.engine).green;
    Image map;
    std::optional<Image> normals;
    const auto note = [&](const SourceMap& source) {
        result.sources.push_back(
            fmt::format("{} ({})", source.file.filename().string(), source.reason));
    };
    std::string detail;
    if (planned.kind == MapKind::packed) {
        Packed packed = pack(pack_contents(set, request.engine));
        map = std::move(packed.image);
        result.findings = std::move(packed.findings);
        detail = enum_name(request.engine);
        const auto& channels = rules_of(request.engine).packed;
        for (std::size_t i = 0; i < channels.size(); ++i) {
            if (channels[i] != PackedChannel::roughness && channels[i] != PackedChannel::smoothness)
                continue;
            options.roughness_channel = static_cast<int>(i);
            options.is_smoothness = channels[i] == PackedChannel::smoothness;
        }
        for (const SourceMap& source : set.maps) {
            const MapKind kind = *source.map.kind;
            if (kind == MapKind::packed || kind == MapKind::occlusion ||
                kind == MapKind::roughness || kind == MapKind::metalness)
                note(source);
        }
        if (const SourceMap* const source = set.find(MapKind::normal))
            normals = read_set_normals(*source, request);
    } else {
        const SourceMap& source = *set.find(planned.kind);
        note(source);
        options.alpha_cutoff = source.alpha_cutoff;
        map = planned.kind == MapKind::normal
                  ? read_set_normals(source, request)
                  : read_value_map(source.file, planned.kind, std::nullopt, true);
        if (planned.kind == MapKind::emission && map.channels == 4) drop_alpha(map);
    }
    const Image* const of_surface = normals ? &*normals : nullptr;
    const glm::ivec2 size = {map.width, map.height};
    MapTextureOptions normal_options;
    normal_options.kind = MapKind::normal;
    limit_size(request.max_size, options, of_surface, map);
    if (size != glm::ivec2(map.width, map.height) && of_surface != nullptr)
        limit_size(request.max_size, normal_options, nullptr, *normals);
    if (!is_power_of_two(map.width) || !is_power_of_two(map.height)) {
        report.add(fmt::format("size {} x {} that is no power of two", map.width, map.height),
                   "texture", 0, "is kept (some engines stream only powers of two)");
    }
    MapTexture encoded =
        about(planned.file, [&] { return encode_map_texture(map, options, of_surface, report); });
    if (!detail.empty()) {
        const MapDescription description = {.kind = MapKind::packed, .detail = detail};
        for (const auto& [key, value] : write_description(description, 8))
            encoded.texture.metadata[key] = value;
    }
    // DDS stores no text, and what it would say is what the engine expects.
    if (request.container == TextureContainerFormat::dds) encoded.texture.metadata.clear();
    result.written = write_map_texture(planned.file, planned.kind, std::move(encoded),
                                       request.zstd_level, report);
    result.findings.add(planned.file.filename().string(), report);
    return result;
}

// The summary.

std::string line_of(const FinishedTexture& texture) {
    const WrittenTexture& written = texture.written;
    return fmt::format(
        "{}: {} x {}, {}, {}, {}, from {}", file_and_size(written.file), written.header.width,
        written.header.height, format_text(written.header), counted(written.levels.size(), "level"),
        error_text(written.kind, written.levels.front()), fmt::join(texture.sources, ", "));
}

ExitCode run_textures(const CLI::App& app, const TexturesRequest& request) {
    if (request.inputs.empty()) throw UsageError("no maps", "name files or folders");
    if (request.zstd_level && request.container == TextureContainerFormat::dds)
        throw UsageError("--zstd: compresses .ktx2 files only");
    set_thread_limit(request.general.threads);
    Stages stages(request.general.quiet);
    Report report;
    const std::vector<TextureSet> sets =
        stages.run("look", [&] { return sets_of(request, report); });
    if (sets.empty())
        throw UsageError(fmt::format("{}: no map was recognized", request.inputs.front().string()),
                         "give the kinds with --kind FILE=KIND");
    const std::vector<PlannedTexture> textures = planned(request, sets);
    check_outputs(request, sets, textures);
    make_folder(request.folder);
    // All textures replace old ones, or none.
    relief::detail::FileSet written;
    std::vector<FinishedTexture> finished;
    for (const PlannedTexture& texture : textures) {
        finished.push_back(
            stages.run("convert", [&] { return convert_texture(texture, request); }));
    }
    written.commit();
    Findings findings;
    findings.add("", report);
    Summary summary;
    summary.add_tool("relief-bake textures");
    summary.add("for",
                fmt::format("{}: {} of {}", enum_name(request.engine),
                            counted(textures.size(), "texture"), counted(sets.size(), "set")),
                {{"for", enum_name(request.engine)}, {"sets", sets.size()}});
    std::vector<std::string> lines;
    Json files = Json::array();
    std::uintmax_t bytes = 0;
    for (const FinishedTexture& texture : finished) {
        lines.push_back(line_of(texture));
        bytes += fs::file_size(texture.written.file);
        Json json = json_of(texture.written);
        json["sources"] = texture.sources;
        files.push_back(std::move(json));
        for (const PlacedFinding& finding : texture.findings.all()) {
            Report one;
            one.add(finding.finding);
            findings.add(finding.where, one);
        }
    }
    summary.add("wrote", lines, {{"textures", std::move(files)}});
    summary.add("in all", byte_size(bytes), {{"bytes", bytes}});
    summary.add_findings(findings);
    summary.add_times(stages);
    if (!request.general.quiet) summary.print();
    return finish(app, request.report, request.inputs.front(), findings, summary.json());
}

void add_kind(const std::string& subject, const std::string& text, TexturesRequest& request) {
    const std::size_t place = text.rfind('=');
    if (place == std::string::npos || place == 0) throw UsageError(subject + ": is not FILE=KIND");
    Choices<MapKind> choices = texture_kind_choices();
    std::erase_if(choices, [](const auto& choice) { return !is_read_by_engines(choice.second); });
    const MapKind kind = parse_choice(subject, text.substr(place + 1), choices);
    request.given_kinds[fs::path(text.substr(0, place)).filename().string()] = kind;
}

void add_textures_options(CLI::App& app, TexturesRequest& request) {
    add_files(app, "MAPS", request.inputs,
              "Folders with maps, or maps. In a folder, files whose kind is not certain are left "
              "out and reported; a named file of this kind is an error.");
    add_path(app, "--output,-o", request.folder, "Folder for the textures.").required();
    add_choice(app, "--for", request.engine, enum_choices<Engine>(),
               "Engine: the direction of green, the packing of occlusion, roughness and metalness, "
               "and the names of the files. Default: gltf.");
    add_path(app, "--model", request.model,
             "glTF model whose materials say the kinds of image files, before their metadata and "
             "their names.")
        .group("Maps");
    add_repeatable(app, "--kind", "FILE=KIND",
                   "Kind of a file: normal, color, occlusion, roughness, metalness, packed "
                   "(occlusion, roughness, metalness), emission or height.",
                   [&request](const std::string& subject, const std::string& text) {
                       add_kind(subject, text, request);
                   })
        .group("Maps");
    add_choice(app, "--input-green", request.input_green, enum_choices<Green>(),
               "Direction of the green channel of normal maps that do not say it. Default: "
               "detected from their slopes.")
        .group("Maps");
    add_choice(app, "--container", request.container,
               Choices<TextureContainerFormat>{{"ktx2", TextureContainerFormat::ktx2},
                                               {"dds", TextureContainerFormat::dds}},
               "Format of the files. Default: ktx2.")
        .group("Textures");
    add_choice(app, "--quality", request.quality, enum_choices<BlockQuality>(),
               "Search of the encoder: fast, normal or best. Default: normal.")
        .group("Textures");
    add_value(app, "--max-size", "N",
              "Largest width and height: larger maps are replaced by one of their mip levels.",
              [&request](const std::string& subject, const std::string& text) {
                  request.max_size = parse_integer(subject, text, 1, 65536);
              })
        .group("Textures");
    add_value(app, "--zstd", "LEVEL",
              "Compress .ktx2 with zstd, from 1 (fast) to 22 (small). Default: not compressed.",
              [&request](const std::string& subject, const std::string& text) {
                  request.zstd_level = parse_integer(subject, text, 1, 22);
              })
        .group("Textures");
    add_report_options(app, request.report);
    add_general_options(app, request.general);
    set_examples(app, {"relief-bake bump data/bricks-height.png out/bricks_normal.png",
                       "relief-bake textures out/bricks_normal.png data/bricks-diffuse.png -o "
                       "out/engine --for unity",
                       "relief-bake textures data -o out/godot --for godot --max-size 256"});
}

}  // namespace

Command add_textures_command(CLI::App& tool) {
    return add_command<TexturesRequest>(
        tool, "textures", "Turns the maps of materials into the textures of an engine.",
        add_textures_options, run_textures);
}

}  // namespace relief::tools
