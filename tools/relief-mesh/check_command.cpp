// SPDX-License-Identifier: Apache-2.0
// `relief-mesh check FILES...` diagnoses model files, identifies the method of their tangents, and
// prints the result as text or JSON. All files are checked, also after errors.
// Tests: tests/tools/relief_mesh_check_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "atlas_summary.h"
#include "commands.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/model.h"
#include "relief/mesh/tangents.h"
#include "relief/mesh/texcoord_quality.h"

namespace relief::tools {
namespace {

struct CheckOptions {
    std::vector<std::filesystem::path> files;
    bool json = false;
    bool strict = false;
    bool for_baking = false;
    std::optional<glm::ivec2> map_size;
    GeneralOptions general;
};

/// The texture coordinates of all triangles with one material, which share a map.
struct MeasuredMap {
    std::string material;  ///< "material 0", or empty if there is only one.
    TexcoordQuality quality;
    Report report;
};

/// All triangles with one material. Different meshes have no common chart, even if they touch, as
/// in `unwrap`.
struct MaterialMesh {
    Mesh mesh;
    std::vector<std::uint32_t> first_vertices;  ///< Of each mesh of the model.
    std::size_t last_mesh = 0;
};

/// Adds the triangles of a primitive with their coordinates to the mesh of their material.
/// Materials are numbered from 1; 0 is none. \param number  of its mesh
void add_by_material(const Mesh& mesh, std::size_t number,
                     std::map<std::uint32_t, MaterialMesh>& meshes) {
    if (mesh.texcoords.empty()) return;
    std::vector<MaterialRange> ranges = mesh.material_ranges;
    if (ranges.empty())
        ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), std::nullopt}};
    for (const MaterialRange& range : ranges) {
        std::vector<std::uint32_t> triangles(range.triangle_count);
        std::iota(triangles.begin(), triangles.end(), range.first_triangle);
        const Mesh part = part_of(mesh, triangles);
        MaterialMesh& all = meshes[range.material ? *range.material + 1 : 0];
        Mesh& target = all.mesh;
        const auto first = static_cast<std::uint32_t>(target.positions.size());
        if (all.first_vertices.empty() || all.last_mesh != number)
            all.first_vertices.push_back(first);
        all.last_mesh = number;
        target.positions.insert(target.positions.end(), part.positions.begin(),
                                part.positions.end());
        target.texcoords.insert(target.texcoords.end(), part.texcoords.begin(),
                                part.texcoords.end());
        for (const glm::uvec3& triangle : part.triangles)
            target.triangles.push_back(triangle + first);
    }
}

std::vector<MeasuredMap> measured_maps(const Model& model, const glm::ivec2& size) {
    std::map<std::uint32_t, MaterialMesh> meshes;
    if (const auto* const document = std::get_if<GltfDocument>(&model)) {
        for (const GltfPrimitiveId id : document->triangle_primitives())
            add_by_material(document->mesh(id), id.mesh, meshes);
    } else {
        add_by_material(std::get<MeshFile>(model).mesh, 0, meshes);
    }
    std::vector<MeasuredMap> maps;
    for (const auto& [material, all] : meshes) {
        MeasuredMap& map = maps.emplace_back();
        if (meshes.size() > 1)
            map.material = material == 0 ? "no material" : fmt::format("material {}", material - 1);
        map.quality = measure_texcoords(all.mesh, size, map.report, all.first_vertices);
    }
    return maps;
}

/// A file and its check.
struct CheckedFile {
    std::filesystem::path file;
    std::string error;  ///< The reason why the file cannot be read, or empty.
    std::string format;
    CheckedModel model;
    std::vector<MeasuredMap> maps;

    [[nodiscard]] bool is_sound() const { return error.empty() && model.is_sound(); }
};

/// Reads and checks a file. A file that cannot be read, or is not valid, gets an `error`.
CheckedFile check_file(const std::filesystem::path& file, const CheckOptions& options) {
    CheckedFile checked;
    checked.file = file;
    checked.format = format_name(readable_format(file));
    try {
        Report reading;
        const Model contents = read_model(file, reading);
        checked.model =
            about(file, [&] { return check_model(contents, reading, options.for_baking); });
        if (options.map_size)
            checked.maps = about(file, [&] { return measured_maps(contents, *options.map_size); });
    } catch (const FileError& error) {
        checked.error = error.what();
    }
    return checked;
}

/// A few corners may have the other sign: degenerate triangles, welded seams.
constexpr double min_sign_share = 0.99;

/// The share of the corners whose sign w matches the method: all, none or some.
enum class Sign { correct, negated, mixed };

Sign sign_of(const TangentAgreement& agreement) {
    const auto all = static_cast<double>(agreement.agreeing());
    const auto negated = static_cast<double>(agreement.negated);
    if (negated >= min_sign_share * all) return Sign::negated;
    return negated <= (1.0 - min_sign_share) * all ? Sign::correct : Sign::mixed;
}

std::string variant_of(const TangentAgreement& agreement) {
    return std::string(variant_text(agreement.quarter_turns, sign_of(agreement) == Sign::negated));
}

/// Angles below 0.001 degrees are shown as 0.001.
std::string angles_text(ErrorStats angles) {
    for (double* degrees : {&angles.median, &angles.p90, &angles.p99, &angles.max})
        *degrees = std::max(*degrees, 0.001);
    return fmt::format("median {:.2g}, 90 % within {:.2g}, 99 % within {:.2g}, maximum {:.2g}",
                       angles.median, angles.p90, angles.p99, angles.max);
}

std::string identified_text(const CheckedTangents& tangents) {
    const IdentifiedTangents& identified = tangents.identified;
    const TangentAgreement& best = *identified.best();
    std::string text(enum_name(*identified.method));
    const std::string variant = variant_of(best);
    if (!variant.empty()) text += ", " + variant;
    if (sign_of(best) == Sign::mixed) {
        text += fmt::format(", w negated at {} of {} corners", best.negated, best.agreeing());
    }
    if (tangents.texcoord_set != tangents.usual_set)
        text += fmt::format(", from texture coordinate set {}", tangents.texcoord_set);
    text += fmt::format(": {} of {} within {:.2g} degrees ({})", best.agreeing(),
                        counted(identified.corners, "corner"), identified.tolerance,
                        angles_text(best.angles));
    if (!identified.equivalent_methods.empty()) {
        std::vector<std::string_view> words;
        for (const TangentMethod method : identified.equivalent_methods)
            words.push_back(enum_name(method));
        text += fmt::format("; {} {} the same tangents here", fmt::join(words, ", "),
                            words.size() == 1 ? "gives" : "give");
    }
    return text;
}

std::string as_text(const CheckedTangents& tangents) {
    if (!tangents.has_normals) return "no normals: glTF ignores these tangents";
    if (!tangents.has_texcoords) return "of unknown basis: there are no texture coordinates";
    const IdentifiedTangents& identified = tangents.identified;
    if (identified.method) return identified_text(tangents);
    const TangentAgreement* best = identified.best();
    if (best == nullptr) {
        return fmt::format(
            "of unknown basis: all triangles are too small in the image, or all tangents are "
            "without direction ({} omitted, {} without direction)",
            identified.left_out, identified.undefined);
    }
    const std::string variant = variant_of(*best);
    return fmt::format("of unknown basis; nearest{} is {}{}: {} of {} within {:.2g} degrees ({})",
                       identified.is_clearly_best() ? " by far" : "", enum_name(best->method),
                       variant.empty() ? "" : ", " + variant, best->agreeing(),
                       counted(identified.corners, "corner"), identified.tolerance,
                       angles_text(best->angles));
}

Json json_of(const TangentAgreement& agreement) {
    const ErrorStats& angles = agreement.angles;
    return {{"basis", enum_name(agreement.method)},
            {"agreeing", agreement.agreeing()},
            {"variant", variant_of(agreement)},
            {"w_negated", agreement.negated},
            {"rms", angles.rms},
            {"mean", angles.mean},
            {"median", angles.median},
            {"p90", angles.p90},
            {"p99", angles.p99},
            {"max", angles.max},
            {"histogram", histogram_json(angles)}};
}

Json json_of(const CheckedTangents& tangents) {
    const IdentifiedTangents& identified = tangents.identified;
    const TangentAgreement* best = identified.best();
    return {{"basis", identified.method ? std::string(enum_name(*identified.method)) : "unknown"},
            {"variant", best == nullptr ? "" : variant_of(*best)},
            {"nearest", best == nullptr ? "" : std::string(enum_name(best->method))},
            {"nearest_by_far", identified.is_clearly_best()},
            {"same_here", json_list(identified.equivalent_methods, enum_name<TangentMethod>)},
            {"texcoord_set", tangents.texcoord_set},
            {"texcoord_set_of_material", tangents.usual_set},
            {"corners", identified.corners},
            {"left_out", identified.left_out},
            {"without_direction", identified.undefined},
            {"stored_bits", identified.stored_bits == 0 ? 32 : identified.stored_bits},
            {"tolerance", identified.tolerance},
            {"agreements", json_list(identified.agreements, [](const TangentAgreement& agreement) {
                 return json_of(agreement);
             })}};
}

std::size_t triangles_of(const CheckedModel& model) {
    std::size_t triangles = 0;
    for (const CheckedPart& part : model.parts)
        triangles += part.triangles;
    return triangles;
}

std::string verdict(const CheckedModel& model) {
    if (!model.is_sound()) return "has problems";
    return triangles_of(model) == 0 ? "no triangles" : "sound";
}

/// The findings of one condition in all parts.
struct Sum {
    std::size_t count = 0;
    std::size_t parts = 0;
    const CheckedPart* first_part = nullptr;
    Finding first;
};

Sum sum_of(const CheckedModel& model, Report CheckedPart::*list, std::string_view word) {
    Sum sum;
    for (const CheckedPart& part : model.parts) {
        for (const Finding& finding : (part.*list).findings()) {
            if (finding.kind != word) continue;
            sum.count += finding.count;
            if (sum.parts++ > 0) continue;
            sum.first_part = &part;
            sum.first = finding;
        }
    }
    return sum;
}

/// Returns a line per condition, with its first place and the number of primitives.
std::vector<std::string> problem_lines(const CheckedModel& model) {
    std::vector<std::string> lines;
    for (const Finding& finding : model.reading_problems.findings())
        lines.push_back(to_string(finding));
    for (const MeshConditionInfo& condition : mesh_conditions()) {
        const Sum sum = sum_of(model, &CheckedPart::problems, condition.word);
        if (sum.parts == 0) continue;
        const std::string place = sum.first_part->name.empty() ? "" : sum.first_part->name + ": ";
        std::string line = place + to_string(sum.first);
        if (sum.parts > 1)
            line += fmt::format(" ({} in {})", sum.count, counted(sum.parts, "primitive"));
        lines.push_back(line);
    }
    return lines;
}

/// "36 x boundary edge in 3 primitives, 12 x needle triangle"
std::string notes_text(const CheckedModel& model) {
    std::vector<std::string> words;
    for (const Finding& finding : model.reading_notes.findings())
        words.push_back(fmt::format("{} x {} {}", finding.count, finding.kind, finding.outcome));
    for (const MeshConditionInfo& condition : mesh_conditions()) {
        const Sum sum = sum_of(model, &CheckedPart::notes, condition.word);
        if (sum.parts == 0) continue;
        words.push_back(fmt::format("{} x {}", sum.count, condition.word));
        if (model.parts.size() > 1)
            words.back() += fmt::format(" in {}", counted(sum.parts, "primitive"));
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

/// Returns a line per distinct result of the primitives' tangents.
std::vector<std::string> tangents_text(const CheckedModel& model) {
    struct Group {
        std::string words;
        const CheckedPart* first;
        std::size_t parts;
    };
    std::vector<Group> groups;
    for (const CheckedPart& part : model.parts) {
        if (!part.tangents) continue;
        std::string words = as_text(*part.tangents);
        const auto group = std::find_if(groups.begin(), groups.end(),
                                        [&](const Group& other) { return other.words == words; });
        if (group == groups.end())
            groups.push_back({std::move(words), &part, 1});
        else
            ++group->parts;
    }
    constexpr std::size_t max_lines = 12;
    std::vector<std::string> lines;
    for (const Group& group : groups) {
        if (lines.size() == max_lines) {
            lines.push_back(
                fmt::format("... and {} more (--json lists all)", groups.size() - max_lines));
            break;
        }
        const std::string others =
            group.parts == 1 ? "" : fmt::format(" (and {} more)", group.parts - 1);
        const std::string place =
            group.first->name.empty() ? "" : group.first->name + others + ": ";
        lines.push_back(place + group.words);
    }
    return lines;
}

/// Returns findings without "where", which the enclosing object gives.
Json json_of(const Report& report) {
    Findings findings;
    findings.add("", report);
    Json list = findings.json();
    for (Json& finding : list)
        finding.erase("where");
    return list;
}

Json json_of(const CheckedPart& part) {
    return {{"name", part.name},
            {"sound", part.problems.empty()},
            {"triangles", part.triangles},
            {"vertices", part.vertices},
            {"size", part.diagnosis.size},
            {"spacing", part.diagnosis.spacing},
            {"overlap_raster", part.diagnosis.overlap_raster},
            {"tangents", part.tangents ? json_of(*part.tangents) : Json()},
            {"problems", json_of(part.problems)},
            {"notes", json_of(part.notes)}};
}

/// The text of a file that cannot be read is the error message.
/// \param is_measured  whether texture coordinates were measured
Summary summary_of(const CheckedFile& file, bool is_measured) {
    Summary summary;
    summary.add_json({{"file", file.file.string()}, {"sound", file.is_sound()}});
    if (!file.error.empty()) {
        summary.add_json({{"error", file.error}});
        return summary;
    }
    summary.add("file",
                fmt::format("{}: {}, {}, {}: {}", file.file.string(), file.format,
                            counted(file.model.parts.size(), "primitive"),
                            counted(triangles_of(file.model), "triangle"), verdict(file.model)),
                {{"format", file.format}});
    summary.add("problems", problem_lines(file.model),
                {{"problems", json_of(file.model.reading_problems)}});
    summary.add("notes", notes_text(file.model), {{"notes", json_of(file.model.reading_notes)}});
    std::vector<std::string> texcoords;
    for (const MeasuredMap& map : file.maps)
        texcoords.push_back(quality_text(map.material, map.quality));
    if (is_measured && texcoords.empty()) texcoords.emplace_back("none");
    summary.add("texcoords", texcoords,
                {{"texcoords", json_list(file.maps, [](const MeasuredMap& map) {
                      Json json = quality_json(map.quality);
                      json["material"] = map.material;
                      json["findings"] = json_of(map.report);
                      return json;
                  })}});
    summary.add("tangents", tangents_text(file.model),
                {{"primitives", json_list(file.model.parts,
                                          [](const CheckedPart& part) { return json_of(part); })}});
    return summary;
}

constexpr const char* page = "docs/hard-cases.md";

ExitCode run(const CLI::App& app, const CheckOptions& options) {
    if (options.json && options.general.quiet)
        throw UsageError("--json and --quiet contradict each other");
    for (const std::filesystem::path& file : options.files)
        readable_format(file);
    set_thread_limit(options.general.threads);
    const bool prints_text = !options.json && !options.general.quiet;
    Stages stages(options.general.quiet);
    Verdicts verdicts;
    Json files = Json::array();
    for (const std::filesystem::path& file : options.files) {
        const CheckedFile checked = stages.run("check", "check " + file.string(),
                                               [&] { return check_file(file, options); });
        ++(!checked.error.empty() ? verdicts.unreadable
           : checked.is_sound()   ? verdicts.sound
                                  : verdicts.with_problems);
        if (!checked.error.empty()) complain(app, checked.error);
        const Summary summary = summary_of(checked, options.map_size.has_value());
        if (prints_text) summary.print();
        files.push_back(summary.json());
    }
    const Summary all = summary_of("relief-mesh check", verdicts, page, std::move(files));
    if (options.json)
        print_json(all.json());
    else if (prints_text)
        all.print();
    return exit_code_for(app, verdicts, options.strict);
}

}  // namespace

Command add_check_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "check",
        "Reports defects of model files, and identifies the method of their tangents.");
    const auto options = std::make_shared<CheckOptions>();
    add_files(app, "FILES", options->files, "Models to read: .glb .gltf .obj .ply .stl .off")
        .required();
    add_switch(
        app, "--json", options->json,
        "Print one JSON object: tool, version, sound, with_problems and unreadable (numbers of "
        "files), documentation (the page that describes the conditions), files [file, sound, "
        "error or: format, problems and notes of reading, texcoords (with --map-size) [material, "
        "atlas, tiles, shared_charts, overlapping, inverted, flat, outside, mirrored_charts, "
        "min_distance, findings], "
        "primitives [name, sound, triangles, "
        "vertices, size, spacing, overlap_raster, tangents {basis, variant, nearest, "
        "nearest_by_far, same_here, texcoord_set, texcoord_set_of_material, corners, left_out, "
        "without_direction, stored_bits, tolerance, agreements} or null, problems and notes "
        "[kind, element, count, first, outcome]]].");
    add_switch(app, "--strict", options->strict,
               "Exit with 3 if a file has problems. Notes do not count.");
    add_switch(app, "--for-baking", options->for_baking,
               "Check for baking: overlapping texture coordinates and triangles without texture "
               "gradient are problems, for any material.");
    add_value(app, "--map-size", "N|WxH",
              "Measure the texture coordinates too, for a map (or each tile of UDIM) of this size, "
              "16 to 65536 texels: charts, used texels, density, stretch, seams, distances, and "
              "overlapping, inverted and mirrored parts. Charts with exactly the same triangles "
              "in the map share texels, others overlap. Primitives with the same material share "
              "a map.",
              [&map_size = options->map_size](const std::string& subject, const std::string& text) {
                  map_size = parse_atlas_size(subject, text);
              });
    add_general_options(app, options->general);
    set_examples(app, {"relief-mesh check data/vase.obj data/scenes/pot.glb",
                       "relief-mesh check data/scenes/knot.glb --for-baking --strict",
                       "relief-mesh check data/vase.obj --strict --json",
                       "relief-mesh check data/scenes/pot.glb --map-size 2048"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
