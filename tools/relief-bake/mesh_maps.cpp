// SPDX-License-Identifier: Apache-2.0
// The maps of a bake. The triangles of the low mesh are split by material, then by tile. Map files
// record the options of the bake, so that `relief-bake check` can repeat it. Rows of normals and
// layers are encoded and written one part after another, so that no image is in memory as a whole.
// Tests: tests/tools/relief_bake_mesh_test.cpp, relief_bake_check_test.cpp,
// relief_bake_layers_test.cpp.

#include "mesh_maps.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>
#include <type_traits>

#include "common/options.h"
#include "common/text.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/texel_coverage.h"

namespace relief::tools {

// The plan.

namespace {

/// The triangles of a material, and its names.
struct MaterialPart {
    std::string name;
    std::string file_name;  ///< The name in file names.
    std::vector<std::uint32_t> triangles;
};

std::string safe_file_name(const std::string& name) {
    std::string safe = name;
    for (char& letter : safe) {
        const auto code = static_cast<unsigned char>(letter);
        const bool is_safe = code >= 0x80 || std::isalnum(code) != 0 || letter == '-' ||
                             letter == '_' || letter == '.';
        if (!is_safe) letter = '_';
    }
    if (safe.starts_with('.')) safe.front() = '_';
    return safe;
}

MaterialPart named_part(std::optional<std::uint32_t> material,
                        const std::vector<std::string>& names) {
    if (!material) return {"no-material", "no-material", {}};
    std::string name = *material < names.size() ? names[*material] : "";
    if (name.empty()) name = fmt::format("material-{}", *material);
    return {name, safe_file_name(name), {}};
}

/// Splits a mesh by material. Triangles without a material come first.
std::vector<MaterialPart> material_parts(const Mesh& low, const std::vector<std::string>& names) {
    std::map<std::optional<std::uint32_t>, MaterialPart> parts;
    std::vector<MaterialRange> ranges = low.material_ranges;
    if (ranges.empty())
        ranges.push_back({0, static_cast<std::uint32_t>(low.triangles.size()), std::nullopt});
    for (const MaterialRange& range : ranges) {
        if (range.triangle_count == 0) continue;
        MaterialPart& part =
            parts.emplace(range.material, named_part(range.material, names)).first->second;
        for (std::uint32_t i = 0; i < range.triangle_count; ++i)
            part.triangles.push_back(range.first_triangle + i);
    }
    std::vector<MaterialPart> result;
    for (auto& [index, part] : parts) {
        std::ranges::sort(part.triangles);
        result.push_back(std::move(part));
    }
    return result;
}

void report_outside(const MapTiles& tiles, const std::string& remedy, Report& report) {
    for (const std::uint32_t triangle : tiles.outside)
        report.add("triangle outside of the map", "triangle", triangle, "is not baked" + remedy);
    for (const std::uint32_t triangle : tiles.partly_outside) {
        report.add("triangle partly outside of the map", "triangle", triangle,
                   "is baked only inside the map" + remedy);
    }
}

/// Counts the texels that triangles cover if those outside of the unit square are shifted into it.
Coverage shifted_coverage(const Mesh& low, std::vector<std::uint32_t> triangles) {
    constexpr int side = 256;  // A count of texels, not of every triangle, decides.
    std::ranges::sort(triangles);
    const CoverageOptions options{.width = side,
                                  .height = side,
                                  .repeat = true,
                                  .touched = false,
                                  .only = std::move(triangles)};
    return cover_texels(low.texcoords, low.triangles, options,
                        [](int, std::span<const CoveredTexel>) {});
}

/// Advises what to do with triangles outside of the map. `--outside repeat` is meant if they fill
/// gaps of the map, if they are mirrored copies of its charts, or if most lie in no UDIM tile.
std::string outside_remedy(const Mesh& low,
                           const std::optional<std::span<const std::uint32_t>>& triangles,
                           const MapTiles& tiles) {
    std::vector<std::uint32_t> outside = tiles.outside;
    outside.insert(outside.end(), tiles.partly_outside.begin(), tiles.partly_outside.end());
    if (outside.empty()) return "";
    std::ranges::sort(outside);
    const char* const repeat = "; --outside repeat moves it into the map";
    const MapTiles udims = tiles_of(low.texcoords, low.triangles, outside, udim_tiles);
    if (2 * (udims.outside.size() + udims.partly_outside.size()) > outside.size()) return repeat;
    std::vector<std::uint32_t> all, inside;
    for (std::uint32_t i = 0; i < (triangles ? triangles->size() : low.triangles.size()); ++i)
        all.push_back(triangles ? (*triangles)[i] : i);
    std::ranges::set_difference(all, outside, std::back_inserter(inside));
    const std::size_t covered = shifted_coverage(low, outside).inside;
    const Coverage before = shifted_coverage(low, std::move(inside));
    const Coverage after = shifted_coverage(low, std::move(all));
    const std::size_t overlap = after.shared - before.shared;
    const std::size_t mirrored = after.mirrored - before.mirrored;
    if (overlap <= covered / 10 || 2 * mirrored >= overlap) return repeat;
    return std::string(repeat) + ", and <UDIM> in the map's name gives a map for each tile";
}

/// Adds the plan of some triangles: one map, or one per tile.
void add_maps(const MeshBakeRequest& request, const Mesh& low, const MapPlan& plan,
              MapPlans& plans) {
    const bool has_tiles = names_word(request.output, tile_word);
    if (!has_tiles && request.bake.map.placement.repeat) {
        plans.maps.push_back(plan);
        return;
    }
    const std::optional<std::span<const std::uint32_t>> triangles =
        plan.triangles ? std::optional<std::span<const std::uint32_t>>(*plan.triangles)
                       : std::nullopt;
    MapTiles tiles =
        tiles_of(low.texcoords, low.triangles, triangles, has_tiles ? udim_tiles : TileRange{});
    report_outside(tiles, has_tiles ? "" : outside_remedy(low, triangles, tiles), plans.report);
    if (!has_tiles) {
        plans.maps.push_back(plan);
        plans.maps.back().is_exceeded = !tiles.outside.empty() || !tiles.partly_outside.empty();
        return;
    }
    for (const std::uint32_t triangle : tiles.not_finite)
        plans.report.add("texture not finite", "triangle", triangle, "covers no texel");
    for (MapTile& tile : tiles.tiles) {
        MapPlan tile_plan = plan;
        tile_plan.tile = tile.tile;
        tile_plan.udim = udim_of(tile.tile);
        tile_plan.triangles = std::move(tile.triangles);
        tile_plan.output = with_word(plan.output, tile_word, fmt::format("{}", *tile_plan.udim));
        plans.maps.push_back(std::move(tile_plan));
    }
}

/// Checks that each output is a separate file, and none of the models.
void check_files(const MeshBakeRequest& request, const std::vector<MapPlan>& maps) {
    std::map<std::filesystem::path, std::string> used;
    for (const std::filesystem::path& file : request.high)
        used[identity_of(file)] = "a model";
    used[identity_of(request.low)] = "a model";
    if (request.cage) used[identity_of(*request.cage)] = "the cage";
    const auto use = [&](const std::filesystem::path& file, const std::string& name) {
        const auto [other, is_new] = used.emplace(identity_of(file), name);
        if (is_new) return;
        throw failure(
            request.low,
            fmt::format("{} and {} would be the same file {}", other->second, name, file.string()),
            "give one of them another name");
    };
    for (const MapPlan& map : maps) {
        use(map.output, map.name().empty() ? "the map" : map.name());
        for (const auto& [kind, file] : request.layers.files) {
            use(map.named(file), fmt::format("{}{}{}", enum_name(kind),
                                             map.name().empty() ? "" : " of ", map.name()));
        }
    }
}

bool has_word_twice(const std::filesystem::path& file, std::string_view word) {
    return names_word(with_word(file, word, ""), word);
}

}  // namespace

std::filesystem::path MapPlan::named(const std::filesystem::path& file) const {
    std::filesystem::path result = file;
    if (material) result = with_word(result, material_word, material_in_files);
    if (udim) result = with_word(result, tile_word, fmt::format("{}", *udim));
    return result;
}

std::string MapPlan::name() const {
    const std::string number = udim ? fmt::format("tile {}", *udim) : "";
    if (!material) return number;
    return fmt::format("material '{}'{}", *material, udim ? ", " + number : "");
}

BakeMapOptions map_options(const BakeOptions& options, const MapPlan& plan) {
    BakeMapOptions map = options.map;
    map.placement.tile = plan.tile;
    if (plan.triangles) map.triangles = *plan.triangles;
    return map;
}

void check_map_names(const MeshBakeRequest& request) {
    const std::filesystem::path& output = request.output;
    constexpr std::array placeholders = {tile_word, material_word};
    check_placeholders(output, placeholders);
    for (const auto& [kind, file] : request.layers.files) {
        check_placeholders(file, placeholders);
        for (const std::string_view word : {material_word, tile_word}) {
            if (names_word(file, word) == names_word(output, word)) continue;
            throw UsageError(fmt::format("{}: {} must be in the names of all files, or of none",
                                         file.string(), word));
        }
    }
    for (const std::string_view word : {material_word, tile_word}) {
        if (output.parent_path().string().find(word) != std::string::npos)
            throw UsageError(fmt::format("{}: {} is in a folder's name", output.string(), word),
                             "use it only in the file name");
        if (has_word_twice(output, word))
            throw UsageError(fmt::format("{}: {} occurs twice", output.string(), word),
                             "use it once");
    }
    if (names_word(output, tile_word) && request.bake.map.placement.repeat)
        throw UsageError("--outside repeat: has no effect with <UDIM>, which bakes all tiles");
}

MapPlans plan_maps(const MeshBakeRequest& request, const Mesh& low,
                   const std::vector<std::string>& materials) {
    MapPlans plans;
    std::vector<MaterialPart> parts = material_parts(low, materials);
    plans.materials = parts.size();
    if (names_word(request.output, material_word)) {
        for (MaterialPart& part : parts) {
            MapPlan plan;
            plan.output = with_word(request.output, material_word, part.file_name);
            plan.material = part.name;
            plan.material_in_files = part.file_name;
            plan.triangles = std::move(part.triangles);
            add_maps(request, low, plan, plans);
        }
    } else {
        MapPlan plan;
        plan.output = request.output;
        add_maps(request, low, plan, plans);
    }
    if (plans.maps.empty()) {
        throw failure(request.low, "no triangle lies in a UDIM tile",
                      "remove <UDIM> from the map's name, or move the texture coordinates");
    }
    check_files(request, plans.maps);
    return plans;
}

// The record. The parsers of the options read it.

namespace {

constexpr std::array recorded_options = {
    "--back-faces", "--cage",    "--dither", "--hardness", "--match",        "--max-distance",
    "--offset",     "--outside", "--rays",   "--samples",  "--sample-angle", "--space"};

BakeRecord record_of(const MeshBakeRequest& request) {
    BakeRecord record;
    const auto add_number = [&](const char* name, const std::optional<double>& number) {
        if (number) record[name] = fmt::format("{}", *number);
    };
    record["--space"] = enum_name(request.bake.space);
    record["--samples"] =
        request.samples.is_auto ? "auto" : fmt::format("{}", request.samples.count);
    add_number("--sample-angle", request.sample_angle);
    if (request.directions) record["--rays"] = enum_name(*request.directions);
    add_number("--hardness", request.hardness);
    if (request.cage) record["--cage"] = "given";
    add_number("--offset", request.bake.offset);
    add_number("--max-distance", request.bake.max_distance);
    if (request.bake.back_faces == BackFaces::take) record["--back-faces"] = "take";
    if (request.match != PartMatching::automatic) record["--match"] = enum_name(request.match);
    if (request.bake.map.placement.repeat) record["--outside"] = "repeat";
    if (request.map.dither) record["--dither"] = enum_name(*request.map.dither);
    return record;
}

}  // namespace

std::string to_string(const BakeRecord& record) {
    std::string line;
    for (const auto& [name, value] : record)
        line += fmt::format("{}{} {}", line.empty() ? "" : " ", name, value);
    return line;
}

std::map<std::string, std::string> bake_metadata(const MeshBakeRequest& request,
                                                 const MapPlan& plan) {
    std::map<std::string, std::string> metadata = {{"relief:bake", to_string(record_of(request))}};
    if (plan.material) metadata["relief:material"] = *plan.material;
    if (plan.udim) metadata["relief:udim"] = fmt::format("{}", *plan.udim);
    return metadata;
}

BakeRecord read_record(const std::filesystem::path& file,
                       const std::map<std::string, std::string>& metadata) {
    BakeRecord record;
    const auto entry = metadata.find("relief:bake");
    if (entry == metadata.end()) return record;
    std::istringstream stream(entry->second);
    std::string name, value;
    while (stream >> name) {
        const bool is_known = std::ranges::find(recorded_options, name) != recorded_options.end();
        if (!is_known || !(stream >> value)) {
            throw failure(file,
                          fmt::format("its record of the bake is '{}', which is not supported",
                                      entry->second),
                          "it may be from a newer version");
        }
        record[name] = value;
    }
    return record;
}

BakeRecord record_of(const CLI::App& app) {
    BakeRecord record;
    for (const char* name : recorded_options) {
        const CLI::Option* option = app.get_option_no_throw(name);
        if (option != nullptr && option->count() > 0) record[name] = option->results().front();
    }
    return record;
}

BakeRecord merged(const BakeRecord& command_line, const BakeRecord& of_file) {
    BakeRecord record = command_line;
    for (const auto& [name, value] : of_file) {
        const bool is_of_rays = name == "--rays" || name == "--hardness" || name == "--offset";
        if (command_line.contains("--cage") && is_of_rays) continue;
        const bool is_of_samples = name == "--sample-angle" && command_line.contains("--samples");
        if (!is_of_samples) record.emplace(name, value);
    }
    return record;
}

void apply_record(const BakeRecord& record, MeshBakeRequest& request) {
    CLI::App app;
    add_ray_options(app, request);
    add_texel_options(app, request);
    add_choice(app, "--dither", request.map.dither, enum_choices<Dither>(), "");
    std::vector<std::string> arguments;  // In reverse order, as CLI11 expects.
    for (const auto& [name, value] : record) {
        arguments.insert(arguments.begin(), name);
        arguments.insert(arguments.begin(), value);
    }
    try {
        app.parse(arguments);
    } catch (const CLI::Error& error) {
        throw UsageError(error.what());
    }
    check_bake_options(request);
}

// The files.

namespace {

/// Full alpha.
template <typename Sample>
constexpr Sample full_sample = std::is_floating_point_v<Sample>
                                   ? Sample{1}
                                   : std::numeric_limits<Sample>::max();

double layer_range(LayerKind kind, const LayerOptions& options, const LayerBounds& bounds) {
    switch (kind) {
        case LayerKind::height:
            return options.height_range.value_or(bounds.height);
        case LayerKind::curvature:
            // Outliers would leave few of 256 codes for the other values.
            return options.curvature_range.value_or(
                bits_of(options, kind) == 8 ? bounds.curvature_p99 : bounds.curvature);
        case LayerKind::position:
            return options.position_range.value_or(bounds.position);
        case LayerKind::thickness:
            return bounds.thickness;
        default:
            return 1.0;
    }
}

std::map<std::string, std::string> map_metadata(const MeshBakeRequest& request, const MapPlan& plan,
                                                const NormalMapFormat& format) {
    MapDescription description = read_description(normal_map_metadata(format));
    if (request.bake.space == VectorSpace::object) description.kind = MapKind::object_normal;
    if (request.bake.space == VectorSpace::world) description.kind = MapKind::world_normal;
    if (request.background == Background::transparent) description.alpha = AlphaContent::coverage;
    std::map<std::string, std::string> metadata = write_description(description, format.bits);
    metadata.merge(bake_metadata(request, plan));
    return metadata;
}

/// The options of the map; --half applies only to layers in .exr files.
ImageWriteOptions layer_write_options(const MapOutputOptions& map,
                                      const std::filesystem::path& file) {
    MapOutputOptions options = map;
    options.half = map.half && extension_of(file) == ".exr";
    return write_options_of(options, file);
}

/// Appends an alpha channel: 1 in baked texels, and in padded ones if they count.
template <typename Sample>
std::vector<Sample> append_alpha(std::span<const Sample> codes, std::span<const TexelState> states,
                                 bool has_padding) {
    std::vector<Sample> result(4 * states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
        std::copy_n(&codes[3 * i], 3, &result[4 * i]);
        const bool is_filled =
            states[i] == TexelState::baked || (has_padding && states[i] == TexelState::padded);
        result[4 * i + 3] = is_filled ? full_sample<Sample> : Sample{0};
    }
    return result;
}

}  // namespace

std::vector<WrittenLayer> planned_layers(const MeshBakeRequest& request, const MapPlan& plan,
                                         const BakeFacts& facts) {
    std::vector<WrittenLayer> planned;
    if (request.layers.files.empty()) return planned;
    const NormalMapFormat format = format_of(request.map, request.output);
    for (const auto& [kind, file] : request.layers.files) {
        const double range = layer_range(kind, request.layers, facts.bounds);
        // If all values are 0, any range stores them.
        const bool is_usable = range > 0.0 && std::isfinite(range);
        LayerCoding coding{kind, bits_of(request.layers, kind), is_usable ? range : 1.0};
        coding.normal_format = {.green = format.green, .flat = format.flat};
        coding.space = request.bake.space;
        if (kind == LayerKind::id) coding.ids = facts.ids;
        planned.push_back(
            {plan.named(file), std::move(coding), kind == LayerKind::color && facts.has_opacity});
    }
    return planned;
}

std::string id_text(const std::vector<SurfaceId>& ids) {
    constexpr std::size_t max_shown = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(max_shown, ids.size()); ++i)
        text += fmt::format("{}{} {}", i > 0 ? ", " : "", color_text(ids[i]), ids[i].name);
    if (ids.size() > max_shown)
        text += fmt::format(", and {} more (see --report)", ids.size() - max_shown);
    return text;
}

Json ids_json(const std::vector<SurfaceId>& ids) {
    return json_list(ids, [](const SurfaceId& id) -> Json {
        return {{"name", id.name}, {"color", color_text(id)}};
    });
}

struct MapWriter::Files {
    struct LayerFile {
        WrittenLayer layer;
        bool has_alpha;
        ImageRowWriter rows;
    };

    NormalMapFormat format;
    bool has_alpha, padding_is_opaque;
    Report& report;
    ImageRowWriter normals;
    std::vector<std::unique_ptr<LayerFile>> layers;

    void write_normals(const BakedRows& rows) {
        Image image;
        image.width =
            static_cast<int>(rows.states.size() / static_cast<std::size_t>(rows.row_count));
        image.height = rows.row_count;
        image.channels = 3;
        image.color_space = ColorSpace::data;
        image.samples = std::vector<float>(rows.normals.begin(), rows.normals.end());
        // Row counts are multiples of the dither tile, so that its pattern continues.
        const Image codes = encode_normal_map(image, format, report);
        std::visit(
            [&]<typename Sample>(const std::vector<Sample>& samples) {
                if (!has_alpha) return normals.write(std::as_bytes(std::span(samples)));
                const std::vector<Sample> all =
                    append_alpha(std::span(samples), rows.states, padding_is_opaque);
                normals.write(std::as_bytes(std::span(all)));
            },
            codes.samples);
    }

    void write_layers(const BakedRows& rows) {
        const std::size_t width = rows.states.size() / static_cast<std::size_t>(rows.row_count);
        const std::size_t first = width * static_cast<std::size_t>(rows.first_row);
        for (const auto& file : layers) {
            const LayerCoding& coding = file->layer.coding;
            file->rows.write(encode_layer(
                layer_values(coding.kind, rows), rows.states, coding, file->has_alpha, first,
                report, file->layer.has_opacity ? rows.opacity : std::span<float>()));
        }
    }
};

MapWriter::MapWriter(const MeshBakeRequest& request, const MapPlan& plan,
                     const NormalMapFormat& format, const std::vector<WrittenLayer>& layers,
                     Report& report) {
    const bool has_alpha = request.background == Background::transparent;
    const ImageShape shape{request.size.x, request.size.y, has_alpha ? 4 : 3, format.bits,
                           ColorSpace::data};
    files_ = std::make_unique<Files>(
        Files{format,
              has_alpha,
              !request.fills_to_border,
              report,
              ImageRowWriter(plan.output, shape, map_metadata(request, plan, format),
                             write_options_of(request.map, plan.output)),
              {}});
    for (const WrittenLayer& layer : layers) {
        const std::optional<AlphaContent> alpha = layer.has_opacity ? AlphaContent::opacity
                                                  : has_alpha
                                                      ? std::optional(AlphaContent::coverage)
                                                      : std::nullopt;
        const ImageShape layer_shape{request.size.x, request.size.y,
                                     static_cast<int>(layer.coding.channels()) + (alpha ? 1 : 0),
                                     layer.coding.bits, layer.coding.color_space()};
        files_->layers.push_back(std::make_unique<Files::LayerFile>(Files::LayerFile{
            layer, alpha.has_value(),
            ImageRowWriter(layer.file, layer_shape, layer_metadata(layer.coding, alpha),
                           layer_write_options(request.map, layer.file))}));
    }
}

MapWriter::~MapWriter() = default;

void MapWriter::write(const BakedRows& rows) {
    files_->write_normals(rows);
    files_->write_layers(rows);
}

void MapWriter::complete() {
    files_->normals.complete(files_->report);
    for (const auto& file : files_->layers)
        file->rows.complete(files_->report);
}

void MapWriter::finish() {
    files_->normals.finish(files_->report);
    for (const auto& file : files_->layers)
        file->rows.finish(files_->report);
}

}  // namespace relief::tools
