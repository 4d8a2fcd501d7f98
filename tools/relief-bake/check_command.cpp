// SPDX-License-Identifier: Apache-2.0
// The command `relief-bake check`: identifies the content and conventions of images that should be
// normal maps, finds their problems, and with --high compares a map with its models. It checks all
// files, even if one fails. Tests: tests/tools/relief_bake_check_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "commands.h"
#include "common/options.h"
#include "common/summary.h"
#include "convert.h"
#include "map_remedies.h"
#include "mesh_accuracy.h"
#include "mesh_maps.h"
#include "mesh_models.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/texture_file.h"

namespace relief::tools {
namespace {

constexpr const char* documentation = "docs/map-check.md";

// The check of an image by itself.

struct CheckedMap {
    std::filesystem::path file;
    std::string error;  ///< The reason if it cannot be read.
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits = 0;
    std::string color_tag;  ///< Empty: the file has no color tag.
    MapDescription stated;  ///< By its metadata.
    bool is_baked = false;  ///< Its file has the record of a bake.
    NormalMapCheck check;
    double milliseconds = 0.0;  ///< Of the check, without reading.

    /// Returns whether a condition is right or wrong by the map alone. Where the high surface leans
    /// far over the low one, the normals of a sound bake face back.
    [[nodiscard]] bool is_judged(MapCondition condition) const {
        return !is_baked || condition != MapCondition::texel_facing_back;
    }
    [[nodiscard]] bool is_sound() const {
        return error.empty() && std::ranges::none_of(check.conditions, [&](const auto& found) {
                   return condition_info(found.condition).severity == Severity::problem &&
                          is_judged(found.condition);
               });
    }
    [[nodiscard]] bool has_green() const {
        return check.content == MapContent::tangent_normals ||
               check.content == MapContent::xy_normals;
    }
    [[nodiscard]] bool has_directions() const {
        return has_green() || check.content == MapContent::object_normals;
    }
    [[nodiscard]] double megapixels_per_second() const {
        const double pixels = static_cast<double>(width) * height;
        return milliseconds > 0.0 ? pixels / milliseconds / 1000.0 : 0.0;
    }
};

/// Reads and checks an image.
/// \param green  the expected direction of green; absent: that of the file's metadata
CheckedMap check_map(const std::filesystem::path& file, std::optional<Green> green,
                     const AssumedKinds& assumed) {
    CheckedMap map;
    map.file = file;
    try {
        const Image image = read_normal_map_image(file);
        std::map<std::string, std::string> metadata = read_image_info(file).metadata;
        map.stated = read_description(metadata);
        if (green) metadata["relief:green"] = enum_name(*green);
        std::optional<MapContent> content;
        if (!assumed.empty()) {
            content = assumed.back() == MapKind::normal ? MapContent::tangent_normals
                                                        : MapContent::object_normals;
        }
        map.is_baked = metadata.contains("relief:bake");
        map.color_tag = color_tag(file);
        map.width = image.width;
        map.height = image.height;
        map.channels = image.channels;
        map.bits = image.bits();
        Stages stages(true);
        map.check = stages.run(
            "check", [&] { return check_normal_map(image, metadata, map.color_tag, content); });
        map.milliseconds = stages.milliseconds("check");
    } catch (const FileError& error) {
        map.error = error.what();
    }
    return map;
}

/// The command that remedies a condition; empty if there is none. Output files are "out.png".
std::string remedy_for(MapCondition condition, const CheckedMap& map) {
    switch (condition) {
        case MapCondition::not_normals:
            if (map.check.content != MapContent::gray) return "";
            return fmt::format("relief-bake bump {} out.png", quoted(map.file));
        case MapCondition::object_space:
            return fmt::format("relief-bake convert {} out.png --to-tangent mesh.glb",
                               quoted(map.file));
        default:
            return with_files(map_remedy(condition), quoted(map.file), "out.png");
    }
}

const char* describe(MapContent content) {
    switch (content) {
        case MapContent::tangent_normals:
            return "tangent-space normals";
        case MapContent::object_normals:
            return "object-space normals";
        case MapContent::xy_normals:
            return "x and y of tangent-space normals";
        case MapContent::gray:
            return "grayscale: heights or a mask";
        default:
            return "not normals: colors, or several masks";
    }
}

/// "a normal map in tangent space, green up, zero is 127.5 of 255"; empty if nothing is stated.
std::string describe(const MapDescription& stated) {
    std::vector<std::string> parts;
    if (stated.kind) parts.emplace_back(map_kind_info(*stated.kind).phrase);
    if (stated.green) parts.push_back(fmt::format("green {}", enum_name(*stated.green)));
    if (stated.flat) parts.push_back(fmt::format("zero is {} of 255", enum_name(*stated.flat)));
    if (stated.xy_only) parts.emplace_back("x and y only");
    if (stated.color_space && *stated.color_space != ColorSpace::data)
        parts.push_back(*stated.color_space == ColorSpace::srgb ? "sRGB" : "linear light");
    if (stated.alpha) parts.push_back(fmt::format("{} in alpha", enum_name(*stated.alpha)));
    return fmt::format("{}", fmt::join(parts, ", "));
}

Json description_json(const MapDescription& stated) {
    Json json = Json::object();
    for (const auto& [key, text] : write_description(stated, 8))
        json[key.substr(key.find(':') + 1)] = text;
    return json;
}

/// "mean 0.975, RMS deviation from 1: 0.048, 95.3 % within 0.1"
std::string describe(const VectorLengths& lengths) {
    return fmt::format("mean {:.3f}, RMS deviation from 1: {:.3f}, {:.1f} % within {:g}",
                       lengths.mean, lengths.rms_deviation, 100.0 * lengths.within[3],
                       VectorLengths::bounds[3]);
}

std::string describe(const GreenEvidence& green) {
    const std::string evidence =
        fmt::format("(correlation {:+.2f} +- {:.2g}; +1 is up, -1 is down)", green.correlation,
                    green.deviation);
    if (!green.green) return "cannot be determined from the slopes " + evidence;
    return fmt::format("{}, from the slopes {}", enum_name(*green.green), evidence);
}

/// "along x and y", and the differences across the seams.
std::string describe(const Tiling& tiling) {
    const std::string axes = tiling.tiles_x() && tiling.tiles_y() ? "x and y"
                             : tiling.tiles_x()                   ? "x"
                             : tiling.tiles_y()                   ? "y"
                                                                  : "no axis";
    return fmt::format(
        "along {} (differences across the seams are {:.2g} and {:.2g} times those inside)", axes,
        tiling.seam_x, tiling.seam_y);
}

/// "8, 8, 8 used"; the library reports more than 16 bits as 0.
std::string describe_bits(const std::vector<int>& bits) {
    std::vector<std::string> counts;
    for (const int count : bits)
        counts.push_back(count == 0 ? "more than 16" : fmt::format("{}", count));
    return fmt::format("{} used", fmt::join(counts, ", "));
}

/// The findings of one severity, each followed by its remedy.
std::vector<std::string> finding_lines(const CheckedMap& map, Severity severity) {
    std::vector<std::string> lines;
    for (const MapConditionCount& found : map.check.conditions) {
        const MapConditionInfo& info = condition_info(found.condition);
        if (info.severity != severity || !map.is_judged(found.condition)) continue;
        lines.push_back(
            info.element == "map"
                ? fmt::format("{}: {}", info.word, info.meaning)
                : to_string(PlacedFinding{"",
                                          {std::string(info.word), std::string(info.element),
                                           std::string(info.meaning), found.count, found.first},
                                          map.width}));
        const std::string remedy = remedy_for(found.condition, map);
        if (!remedy.empty()) lines.push_back("-> " + remedy);
    }
    return lines;
}

/// The conditions that only the models of the map show to be right or wrong.
std::vector<std::string> unjudged_lines(const CheckedMap& map) {
    std::vector<std::string> lines;
    for (const MapConditionCount& found : map.check.conditions) {
        if (map.is_judged(found.condition)) continue;
        const MapConditionInfo& info = condition_info(found.condition);
        lines.push_back(to_string(
            PlacedFinding{"",
                          {std::string(info.word), std::string(info.element),
                           "cannot be judged without the models: the high surface may lean so far",
                           found.count, found.first},
                          map.width}));
    }
    if (!lines.empty()) {
        lines.push_back(
            fmt::format("-> relief-bake check {} --high HIGH --low LOW", quoted(map.file)));
    }
    return lines;
}

Json unjudged_json(const CheckedMap& map) {
    Json list = Json::array();
    for (const MapConditionCount& found : map.check.conditions) {
        if (map.is_judged(found.condition)) continue;
        const MapConditionInfo& info = condition_info(found.condition);
        list.push_back({{"kind", info.word},
                        {"element", info.element},
                        {"count", found.count},
                        {"first", found.first}});
    }
    return list;
}

/// The findings of one severity.
Json findings_json(const CheckedMap& map, Severity severity) {
    Json list = Json::array();
    for (const MapConditionCount& found : map.check.conditions) {
        const MapConditionInfo& info = condition_info(found.condition);
        if (info.severity != severity || !map.is_judged(found.condition)) continue;
        list.push_back({{"kind", info.word},
                        {"element", info.element},
                        {"count", found.count},
                        {"first", found.first},
                        {"meaning", info.meaning},
                        {"remedy", remedy_for(found.condition, map)}});
    }
    return list;
}

Json lengths_json(const VectorLengths& lengths) {
    Json within = Json::object();
    for (std::size_t i = 0; i < lengths.within.size(); ++i)
        within[fmt::format("{:g}", VectorLengths::bounds[i])] = lengths.within[i];
    return {{"mean", lengths.mean},
            {"rms_deviation", lengths.rms_deviation},
            {"within", std::move(within)}};
}

Json green_json(const CheckedMap& map) {
    if (!map.has_green()) return nullptr;
    const GreenEvidence& green = map.check.green;
    return {{"is", green.green ? enum_name(*green.green) : "unknown"},
            {"correlation", green.correlation},
            {"deviation", green.deviation},
            {"confidence", green.confidence},
            {"scale", green.scale}};
}

/// The text of a file that cannot be read is the error message.
/// \param has_models  whether the map is also compared with its models
Summary summary_of(const CheckedMap& map, bool has_models) {
    Summary summary;
    summary.add_json({{"file", map.file.string()}, {"sound", map.is_sound()}});
    if (!map.error.empty()) {
        summary.add_json({{"error", map.error}});
        return summary;
    }
    const Choices<MapContent> contents = {{"tangent-space", MapContent::tangent_normals},
                                          {"object-space", MapContent::object_normals},
                                          {"xy", MapContent::xy_normals},
                                          {"gray", MapContent::gray},
                                          {"other", MapContent::other}};
    const Choices<StoredCurve> curves = {{"none", StoredCurve::none},
                                         {"srgb-encoded", StoredCurve::srgb_encoded},
                                         {"srgb-decoded", StoredCurve::srgb_decoded}};
    const NormalMapCheck& check = map.check;
    const bool is_curved = check.curve != StoredCurve::none;
    const auto if_normals = [&](const std::string& text) {
        return map.has_directions() ? text : "";
    };
    summary.add("file",
                fmt::format("{}: {} x {}, {}, {} bit: {}", map.file.string(), map.width, map.height,
                            counted(static_cast<std::size_t>(map.channels), "channel"), map.bits,
                            map.is_sound() ? "sound" : "has problems"),
                {{"width", map.width},
                 {"height", map.height},
                 {"channels", map.channels},
                 {"bits", map.bits}});
    summary.add("content", describe(check.content),
                {{"content", name_of(check.content, contents)},
                 {"curve", name_of(check.curve, curves)},
                 {"color_tag", map.color_tag}});
    summary.add("stated", describe(map.stated), {{"stated", description_json(map.stated)}});
    summary.add("lengths", if_normals(describe(check.lengths)),
                {{"lengths", lengths_json(check.lengths)}});
    summary.add("decoded", if_normals(is_curved ? describe(check.lengths_uncurved) : ""),
                {{"lengths_uncurved", lengths_json(check.lengths_uncurved)}});
    summary.add("green", map.has_green() ? describe(check.green) : "",
                {{"green", green_json(map)}});
    const char* const zero = map.bits == 32 ? ""
                             : check.flat == FlatCode::middle
                                 ? "a code (128 of 255)"
                                 : "between two codes (127.5 of 255), as in glTF";
    summary.add("zero", if_normals(zero), {{"zero_code", enum_name(check.flat)}});
    summary.add("tiles", if_normals(describe(check.tiling)),
                {{"seams", {check.tiling.seam_x, check.tiling.seam_y}}});
    summary.add("bits", describe_bits(check.bits), {{"bits_used", check.bits}});
    summary.add_json({{"alpha_correlation", or_null(check.alpha_correlation)}});
    summary.add("problems", finding_lines(map, Severity::problem),
                {{"problems", findings_json(map, Severity::problem)}});
    summary.add("unjudged", has_models ? std::vector<std::string>{} : unjudged_lines(map),
                {{"unjudged", unjudged_json(map)}});
    summary.add("notes", finding_lines(map, Severity::note),
                {{"notes", findings_json(map, Severity::note)}});
    summary.add("time",
                fmt::format("{} ({:.0f} MPixel/s without file access)", duration(map.milliseconds),
                            map.megapixels_per_second()),
                {{"milliseconds", map.milliseconds},
                 {"megapixels_per_second", map.megapixels_per_second()}});
    return summary;
}

// The check of a map against its models: the bake is repeated in memory.

struct SurfaceCheckRequest {
    MeshBakeRequest bake;
    VerifyRequest verify;
    std::optional<int> udim;

    [[nodiscard]] bool is_wanted() const { return !bake.high.empty(); }
};

struct SurfaceCheck {
    BakeRecord of_file;  ///< The record of the file.
    BakeRecord used;     ///< The record completed by the command line.
    BakeDistances distances;
    VerifiedMap map;
    Findings findings;
};

void add_surface_options(CLI::App& app, SurfaceCheckRequest& request) {
    add_repeatable(
        app, "--high", "FILE",
        "Compare a single map with this detailed model, as a renderer shows the map on --low. May "
        "be given several times.",
        [&](const std::string&, const std::string& text) { request.bake.high.emplace_back(text); })
        .group("Models");
    add_path(app, "--low", request.bake.low,
             "The simple model of the map. Options of the bake are read from the file if relief "
             "baked it; those on the command line take precedence.")
        .group("Models");
    add_value(app, "--udim", "N", "UDIM tile of the map, from 1001.",
              [&](const std::string& subject, const std::string& text) {
                  request.udim = parse_integer(subject, text, 1001, 9999);
              })
        .group("Models");
    add_ray_options(app, request.bake);
    add_fit_options(app, request.bake, "More are a problem.");
    add_texel_options(app, request.bake);
    add_high_normal_map_option(app, request.bake.textures);
    add_error_bound(app, request.verify.bound, "Accuracy",
                    "Errors above DEG degrees are a problem. Default: it is a problem if the map "
                    "differs by 1 degree (RMS) from this bake, or if another convention explains "
                    "the map.");
    add_error_map_option(app, request.verify.error_map);
}

/// \throws UsageError if options have no effect, models are missing, or there are several maps
void check(const CLI::App& app, const SurfaceCheckRequest& request,
           const std::vector<std::filesystem::path>& maps) {
    if (!request.is_wanted()) {
        return refuse_given(
            app,
            {"--low", "--cage", "--match", "--rays", "--hardness", "--offset", "--space",
             "--back-faces", "--max-distance", "--samples", "--outside", "--sample-angle", "--udim",
             "--max-error", "--max-error-kind", "--error-map", "--high-normal-map", "--max-missed",
             "--allow-size-mismatch"},
            "--high", "give --high FILE and --low FILE");
    }
    if (request.bake.low.empty())
        throw UsageError("--high: needs the model of the map", "give --low FILE");
    if (maps.size() > 1)
        throw UsageError(fmt::format("--high: needs a single map, not {}", maps.size()));
    check_bake_options(request.bake);
    check(request.verify.bound);
    std::vector<std::filesystem::path> files = request.bake.high;
    files.push_back(request.bake.low);
    if (request.bake.cage) files.push_back(*request.bake.cage);
    files.push_back(maps.front());
    check_error_map(request.verify.error_map, files);
}

/// Finds the plan of the map by the material and tile in its file.
MapPlan plan_of(const SurfaceCheckRequest& request, const BakeModels& models,
                const std::map<std::string, std::string>& metadata) {
    const auto entry = [&](const char* key) {
        const auto found = metadata.find(key);
        return found == metadata.end() ? std::string() : found->second;
    };
    MeshBakeRequest bake = request.bake;
    const std::string material = entry("relief:material");
    const std::string udim = request.udim ? fmt::format("{}", *request.udim) : entry("relief:udim");
    bake.output = fmt::format("{}{}.png", material.empty() ? "map" : material_word,
                              udim.empty() ? std::string_view() : tile_word);
    MapPlans plans = plan_maps(bake, models.low, models.materials);
    for (MapPlan& plan : plans.maps) {
        const bool matches = plan.material.value_or("") == material &&
                             (udim.empty() || fmt::format("{}", plan.udim.value_or(0)) == udim);
        if (matches) return std::move(plan);
    }
    throw failure(
        request.bake.low,
        fmt::format("has no {}{}{}", material.empty() ? "" : "material '" + material + "'",
                    material.empty() || udim.empty() ? "" : " in ",
                    udim.empty() ? "" : "tile " + udim),
        "is it the model of the map?");
}

/// If the map was converted to another space after the bake, its content entry has the new space.
void apply_content(const std::map<std::string, std::string>& metadata, BakeRecord& record) {
    const auto content = metadata.find("relief:content");
    if (record.empty() || content == metadata.end()) return;
    for (const char* space : {"tangent", "object", "world"}) {
        if (content->second.ends_with(fmt::format("{} space", space))) record["--space"] = space;
    }
}

/// Reads models and map, and compares them. \throws FileError, UsageError
SurfaceCheck check_surface(const CLI::App& app, const SurfaceCheckRequest& request,
                           Stages& stages) {
    SurfaceCheck result;
    const ImageInfo info = read_image_info(request.verify.map);
    const auto& metadata = info.metadata;
    result.of_file = read_record(request.verify.map, metadata);
    apply_content(metadata, result.of_file);
    result.used = merged(record_of(app), result.of_file);
    if (result.used.contains("--cage") && !request.bake.cage) {
        throw failure(request.verify.map, "was baked with a cage, but does not name its file",
                      "give --cage FILE");
    }
    SurfaceCheckRequest settled = request;
    settled.bake = MeshBakeRequest{};
    settled.bake.high = request.bake.high;
    settled.bake.low = request.bake.low;
    settled.bake.textures = request.bake.textures;
    settled.bake.bake.allow_size_mismatch = request.bake.bake.allow_size_mismatch;
    settled.bake.max_missed = request.bake.max_missed;
    apply_record(result.used, settled.bake);
    const BakeModels models =
        stages.run("read", [&] { return read_bake_models(settled.bake, result.findings); });
    BakeOptions options = bake_options_of(settled.bake);
    options.output_from_mesh = output_axes(settled.bake, models.world_from_low);
    options.materials = models.textures.materials();
    options.cage = models.cage;
    const MapPlan plan = plan_of(settled, models, metadata);
    Report report;
    about(request.bake.low, [&] {
        stages.run("check", [&] {
            const Baker baker = make_baker(settled.bake, models, options, report);
            result.distances = baker.distances();
            result.map = verify_map(baker, models, settled.bake, map_options(options, plan),
                                    request.verify, report);
        });
    });
    result.findings.add("", report, info.width);
    return result;
}

Summary summary_of(const SurfaceCheck& check) {
    const char* const source = check.of_file.empty()         ? "the file has no record of its bake"
                               : check.of_file == check.used ? "from the file"
                                                             : "from the command line and the file";
    Summary summary;
    summary.add("baked",
                {fmt::format("{} ({})", to_string(check.used), source),
                 fmt::format("rays from {:.4g} outside to {:.4g} inside", check.distances.offset,
                             check.distances.max_distance)},
                {{"baked", to_string(check.used)},
                 {"file_says", to_string(check.of_file)},
                 {"offset", check.distances.offset},
                 {"max_distance", check.distances.max_distance}});
    summary.add_part("", summary_of(check.map));
    summary.add_findings(check.findings, "");
    return summary;
}

// The check of a map against an exact one.

Summary summary_of(const std::filesystem::path& exact, const ExactComparison& comparison) {
    std::vector<std::string> lines;
    Json list = Json::array();
    for (std::size_t i = 0; i < comparison.levels.size(); ++i) {
        const LevelError& level = comparison.levels[i];
        lines.push_back(level_text(i, level));
        list.push_back({{"width", level.width},
                        {"height", level.height},
                        {"mean", level.error.mean},
                        {"rms", level.error.rms},
                        {"p99", level.error.p99},
                        {"max", level.error.max}});
    }
    if (comparison.inverts_exact) {
        lines.emplace_back(
            "compared with inverted green: only one of the maps states its direction, and so they "
            "fit");
    }
    if (comparison.may_be_inverted) {
        lines.emplace_back(
            "the maps fit better with inverted green, but none states its direction (give "
            "--input-green)");
    }
    Summary summary;
    summary.add("exact", lines,
                {{"exact",
                  {{"file", exact.string()},
                   {"levels", std::move(list)},
                   {"inverted_green", comparison.inverts_exact}}}});
    return summary;
}

// The command.

struct CheckOptions {
    std::vector<std::filesystem::path> files;
    std::optional<std::filesystem::path> exact;
    std::optional<Green> green;
    MapInputOptions input;
    bool json = false;
    bool strict = false;
    GeneralOptions general;
    SurfaceCheckRequest surface;
};

ExitCode run(const CLI::App& app, const CheckOptions& options) {
    if (options.json && options.general.quiet)
        throw UsageError("--json and --quiet contradict each other");
    check(app, options.surface, options.files);
    set_thread_limit(options.general.threads);
    const bool prints_text = !options.json && !options.general.quiet;
    Stages stages(options.general.quiet);
    Verdicts verdicts;
    Json files = Json::array();
    std::optional<ExactMap> exact;
    if (options.exact) exact = read_exact_map(*options.exact, options.input.assumed);
    MapInputOptions input = options.input;
    if (!input.green && !input.detects_green) input.green = options.green;
    for (const std::filesystem::path& file : options.files) {
        const CheckedMap map = stages.run("check", "check " + file.string(), [&] {
            return check_map(file, options.green, input.assumed);
        });
        Summary summary = summary_of(map, options.surface.is_wanted());
        bool is_sound = map.is_sound();
        if (options.surface.is_wanted() && map.error.empty()) {
            SurfaceCheckRequest request = options.surface;
            request.verify.map = file;
            request.bake.textures.assumed = input.assumed;
            request.verify.input = input;
            // The check itself reports the kind.
            request.verify.input.assumed = {MapKind::normal};
            const SurfaceCheck surface = check_surface(app, request, stages);
            is_sound = is_sound && surface.map.problems.empty();
            summary.add_part("surface", summary_of(surface));
        }
        if (exact && map.error.empty()) {
            summary.add_part("", summary_of(exact->file, compare_levels(file, *exact, input)));
        }
        ++(!map.error.empty() ? verdicts.unreadable
           : is_sound         ? verdicts.sound
                              : verdicts.with_problems);
        if (!map.error.empty()) complain(app, map.error);
        if (prints_text) summary.print();
        files.push_back(summary.json());
    }
    const Summary all = summary_of("relief-bake check", verdicts, documentation, std::move(files));
    if (options.json)
        print_json(all.json());
    else if (prints_text)
        all.print();
    return exit_code_for(app, verdicts, options.strict);
}

}  // namespace

Command add_map_check_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(tool, "check",
                                   "Checks whether images are normal maps, detects their "
                                   "conventions and finds their problems.");
    const auto options = std::make_shared<CheckOptions>();
    add_files(app, "MAPS", options->files, "Images to read: PNG, JPEG, TIFF, EXR, ...").required();
    add_surface_options(app, options->surface);
    add_choice(app, "--green", options->green, enum_choices<Green>(),
               "Expected direction of the green channel; slopes that contradict it are a problem. "
               "Default: from the file's metadata, if it has an entry.");
    add_green_choice(app, "--input-green", options->input,
                     "Direction of the green channel of MAPS for --exact and --high: up (OpenGL), "
                     "down (DirectX), or detected from the slopes (auto). Default: --green, else "
                     "from the file's metadata, else up. A map whose direction is not known is "
                     "compared with --exact so that they fit.");
    add_assume_option(app, options->input.assumed, {MapKind::normal, MapKind::object_normal});
    add_path(app, "--exact", options->exact,
             "State the error of each mip level against this map, which has the same size: the "
             "16-bit or float map from which a texture was made.");
    add_switch(
        app, "--json", options->json,
        "Print one JSON object: tool, version, sound, with_problems and unreadable (numbers of "
        "files), documentation (the page that describes the conditions), files [file, sound, "
        "error or: width, height, channels, bits, content, stated {content, green, flat, "
        "channels, color-space, alpha}, curve, color_tag, lengths and lengths_uncurved {mean, "
        "rms_deviation, within}, green {is, correlation, deviation, confidence, scale} or null, "
        "zero_code, seams [x, y], bits_used, alpha_correlation, problems and notes [kind, "
        "element, count, first, meaning, remedy], unjudged (without the models) [kind, element, "
        "count, first], milliseconds, megapixels_per_second, exact {file, levels [width, height, "
        "mean, rms, p99, max], inverted_green}, surface {baked, error and center {rms, mean, p99, "
        "max, texels}, stages {fraction, rms}, worst, convention, problems, remedies, ...}].");
    add_switch(app, "--strict", options->strict,
               "Exit with 3 if a file has problems, by itself or on its models. Notes are not "
               "problems.");
    add_general_options(app, options->general);
    set_examples(app,
                 {"relief-bake check data/scenes/bricks-normal.png",
                  "relief-bake convert data/scenes/bricks-normal.png out/bricks.ktx2 --mips",
                  "relief-bake check out/bricks.ktx2 --exact data/scenes/bricks-normal.png",
                  "relief-bake check data/scenes/bricks-normal.png --green up --strict",
                  "relief-mesh subdivide data/vase.obj out/high.obj --levels 2",
                  "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 256",
                  "relief-bake check out/vase-baked.png --high out/high.obj --low data/vase.obj",
                  "relief-bake check data/bricks-height.png data/scenes/bricks-normal.png --json"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
