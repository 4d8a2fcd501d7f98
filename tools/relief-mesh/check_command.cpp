// SPDX-License-Identifier: Apache-2.0
// `relief-mesh check FILES...` diagnoses model files, identifies the method of their tangents, and
// prints the result as text or JSON. All files are checked, also after errors.
// Tests: tests/tools/relief_mesh_check_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/text.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/tangents.h"

namespace relief::tools {
namespace {

/// The result of identifying the tangents of a primitive.
struct CheckedTangents {
    IdentifiedTangents identified;
    int texcoord_set = 0;       ///< The set that the tangents match, or else `usual_set`.
    int usual_set = 0;          ///< The set that glTF assigns to the tangents.
    bool has_normals = true;    ///< Without normals, glTF ignores tangents.
    bool has_texcoords = true;  ///< Without them, no method can be compared.
};

/// A triangle primitive of a glTF file, or the mesh of another file.
struct CheckedPart {
    std::string name;  ///< Empty for a file with one mesh.
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    Diagnosis diagnosis;
    Report problems;
    Report notes;
    std::optional<CheckedTangents> tangents;  ///< Absent if the primitive has no tangents.
};

struct CheckedModel {
    std::filesystem::path file;
    std::string error;  ///< The reason why the file cannot be read, or empty.
    std::string format;
    /// Findings of the reader. Missing references are problems; content that relief does not use
    /// (points, lines, foreign properties) is a note.
    Report reading_problems;
    Report reading_notes;
    std::vector<CheckedPart> parts;

    [[nodiscard]] bool is_sound() const;
};

bool CheckedModel::is_sound() const {
    return error.empty() && reading_problems.empty() &&
           std::all_of(parts.begin(), parts.end(),
                       [](const CheckedPart& part) { return part.problems.empty(); });
}

/// Identifies the method of a primitive's stored tangents. If no method matches with the texture
/// coordinates that glTF assigns to the tangents, the other sets are tried.
/// \return nothing if the primitive has no tangents
std::optional<CheckedTangents> check_tangents(const GltfDocument& document, GltfPrimitiveId id,
                                              const Mesh& mesh) {
    if (mesh.tangents.empty()) return std::nullopt;
    CheckedTangents result;
    result.usual_set = document.tangent_texcoords(id).set;
    result.texcoord_set = result.usual_set;
    result.has_normals = !mesh.normals.empty();
    const std::vector<int> sets = document.texcoord_sets(id);
    result.has_texcoords = !sets.empty();
    if (!result.has_normals || sets.empty()) return result;
    result.identified = identify_tangents(document.mesh(id, result.usual_set));
    for (const int set : sets) {
        if (result.identified.method) break;
        if (set == result.usual_set) continue;
        IdentifiedTangents other = identify_tangents(document.mesh(id, set));
        if (!other.method) continue;
        result.identified = std::move(other);
        result.texcoord_set = set;
    }
    return result;
}

/// Returns whether the model is complete in spite of a finding of its reader.
bool is_harmless(const Finding& finding) {
    static constexpr std::array kinds = {"far from the origin",
                                         "point",
                                         "line",
                                         "unknown statement",
                                         "line with more values than the header names",
                                         "bytes behind the GLB",
                                         "bytes behind the last triangle"};
    return finding.kind.starts_with("PLY property") ||
           std::find(kinds.begin(), kinds.end(), finding.kind) != kinds.end();
}

void add_reading(CheckedModel& model, const Report& reading) {
    for (const Finding& finding : reading.findings())
        (is_harmless(finding) ? model.reading_notes : model.reading_problems).add(finding);
}

/// The intended use of a part, which decides the severity of a condition.
struct Use {
    bool tangents = false;
    bool baking = false;
};

Severity severity_of(MeshCondition condition, const Use& use) {
    if (condition == MeshCondition::texture_degenerate && !use.tangents && !use.baking)
        return Severity::note;
    if (condition == MeshCondition::texture_overlapping && use.baking) return Severity::problem;
    return condition_info(condition).severity;
}

void add_part(CheckedModel& model, std::string name, const Mesh& mesh, const Use& use) {
    CheckedPart part{
        std::move(name), mesh.triangles.size(), mesh.positions.size(), diagnose(mesh), {}, {}, {}};
    for (const MeshConditionCount& found : part.diagnosis.found) {
        const bool is_problem = severity_of(found.condition, use) == Severity::problem;
        (is_problem ? part.problems : part.notes).add(to_finding(found));
    }
    model.parts.push_back(std::move(part));
}

bool wants_tangents(const Mesh& mesh, const std::vector<GltfMaterial>& materials) {
    if (!mesh.tangents.empty()) return true;
    return std::any_of(mesh.material_ranges.begin(), mesh.material_ranges.end(),
                       [&](const MaterialRange& range) {
                           return range.material && *range.material < materials.size() &&
                                  materials[*range.material].normal_texture;
                       });
}

/// Returns true also if no material has a texture, because the use of the mesh is then unknown.
bool wants_tangents(const std::vector<MtlMaterial>& materials) {
    bool has_textures = false;
    for (const MtlMaterial& material : materials) {
        if (material.normal_map || material.bump_map) return true;
        has_textures = has_textures || material.diffuse_map || material.emission_map;
    }
    return !has_textures;
}

void add_parts(CheckedModel& model, const GltfDocument& document, bool for_baking) {
    const std::vector<GltfMaterial> materials = document.view().materials;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const Mesh mesh = document.mesh(id);
        add_part(model, document.describe(id), mesh, {wants_tangents(mesh, materials), for_baking});
        model.parts.back().tangents = check_tangents(document, id, mesh);
    }
}

void add_parts(CheckedModel& model, const MeshFile& contents, bool for_baking) {
    add_part(model, "", contents.mesh, {wants_tangents(contents.materials), for_baking});
}

/// Reads and diagnoses a file. A file that cannot be read, or is not valid, gets an `error`.
///
/// The severities are those of diagnose.h with two exceptions. With `for_baking`, overlapping
/// texture coordinates are a problem. Triangles without texture gradient are only a note if nothing
/// needs tangents: no baking, no normal or bump map in the materials, and no stored tangents.
CheckedModel check_model(const std::filesystem::path& file, bool for_baking) {
    CheckedModel model;
    model.file = file;
    model.format = format_name(readable_format(file));
    try {
        Report reading;
        const Model contents = read_model(file, reading);
        add_reading(model, reading);
        about(file, [&] {
            std::visit([&](const auto& document) { add_parts(model, document, for_baking); },
                       contents);
        });
    } catch (const FileError& error) {
        model.error = error.what();
    }
    return model;
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

nlohmann::ordered_json json_of(const CheckedTangents& tangents) {
    const IdentifiedTangents& identified = tangents.identified;
    nlohmann::ordered_json agreements = nlohmann::ordered_json::array();
    for (const TangentAgreement& agreement : identified.agreements) {
        const ErrorStats& angles = agreement.angles;
        nlohmann::ordered_json histogram = nlohmann::ordered_json::array();
        for (std::size_t i = 0; i < angles.histogram.size(); ++i)
            histogram.push_back(
                {{"up_to", ErrorStats::bounds[i]}, {"corners", angles.histogram[i]}});
        agreements.push_back({{"basis", enum_name(agreement.method)},
                              {"agreeing", agreement.agreeing()},
                              {"variant", variant_of(agreement)},
                              {"w_negated", agreement.negated},
                              {"rms", angles.rms},
                              {"mean", angles.mean},
                              {"median", angles.median},
                              {"p90", angles.p90},
                              {"p99", angles.p99},
                              {"max", angles.max},
                              {"histogram", std::move(histogram)}});
    }
    nlohmann::ordered_json equivalent_methods = nlohmann::ordered_json::array();
    for (const TangentMethod method : identified.equivalent_methods)
        equivalent_methods.push_back(enum_name(method));
    const TangentAgreement* best = identified.best();
    return {{"basis", identified.method ? std::string(enum_name(*identified.method)) : "unknown"},
            {"variant", best == nullptr ? "" : variant_of(*best)},
            {"nearest", best == nullptr ? "" : std::string(enum_name(best->method))},
            {"nearest_by_far", identified.is_clearly_best()},
            {"same_here", std::move(equivalent_methods)},
            {"texcoord_set", tangents.texcoord_set},
            {"texcoord_set_of_material", tangents.usual_set},
            {"corners", identified.corners},
            {"left_out", identified.left_out},
            {"without_direction", identified.undefined},
            {"stored_bits", identified.stored_bits == 0 ? 32 : identified.stored_bits},
            {"tolerance", identified.tolerance},
            {"agreements", std::move(agreements)}};
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
nlohmann::ordered_json findings_json(const Report& report) {
    Findings findings;
    findings.add("", report);
    nlohmann::ordered_json list = findings.json();
    for (nlohmann::ordered_json& finding : list)
        finding.erase("where");
    return list;
}

nlohmann::ordered_json part_json(const CheckedPart& part) {
    return {{"name", part.name},
            {"sound", part.problems.empty()},
            {"triangles", part.triangles},
            {"vertices", part.vertices},
            {"size", part.diagnosis.size},
            {"spacing", part.diagnosis.spacing},
            {"overlap_raster", part.diagnosis.overlap_raster},
            {"tangents", part.tangents ? json_of(*part.tangents) : nlohmann::ordered_json()},
            {"trouble", findings_json(part.problems)},
            {"remarks", findings_json(part.notes)}};
}

void print_text(const CheckedModel& model) {
    print_entry("file", fmt::format("{}: {}, {}, {}: {}", model.file.string(), model.format,
                                    counted(model.parts.size(), "primitive"),
                                    counted(triangles_of(model), "triangle"), verdict(model)));
    print_entry("problems", problem_lines(model));
    const std::string notes = notes_text(model);
    if (!notes.empty()) print_entry("notes", notes);
    print_entry("tangents", tangents_text(model));
}

nlohmann::ordered_json json_of(const CheckedModel& model) {
    if (!model.error.empty())
        return {{"file", model.file.string()}, {"sound", false}, {"error", model.error}};
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    for (const CheckedPart& part : model.parts)
        parts.push_back(part_json(part));
    return {{"file", model.file.string()},
            {"sound", model.is_sound()},
            {"format", model.format},
            {"trouble", findings_json(model.reading_problems)},
            {"remarks", findings_json(model.reading_notes)},
            {"primitives", std::move(parts)}};
}

constexpr const char* page = "docs/hard-cases.md";

struct CheckOptions {
    std::vector<std::filesystem::path> files;
    bool json = false;
    bool strict = false;
    bool for_baking = false;
    GeneralOptions general;
};

Verdicts verdicts_of(const std::vector<CheckedModel>& models) {
    Verdicts verdicts;
    for (const CheckedModel& model : models) {
        ++(!model.error.empty() ? verdicts.unreadable
           : model.is_sound()   ? verdicts.sound
                                : verdicts.with_problems);
    }
    return verdicts;
}

void print_checks(const std::vector<CheckedModel>& models, const Verdicts& verdicts) {
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const CheckedModel& model : models)
        files.push_back(json_of(model));
    tools::print_json({{"tool", "relief-mesh check"},
                       {"version", version()},
                       {"sound", verdicts.sound},
                       {"with_trouble", verdicts.with_problems},
                       {"unreadable", verdicts.unreadable},
                       {"words", page},
                       {"files", std::move(files)}});
}

ExitCode run(const CLI::App& app, const CheckOptions& options) {
    if (options.json && options.general.quiet)
        throw UsageError("--json and --quiet contradict each other");
    for (const std::filesystem::path& file : options.files)
        readable_format(file);
    set_thread_limit(options.general.threads);
    const bool to_print = !options.json && !options.general.quiet;
    Stages stages(options.general.quiet);
    std::vector<CheckedModel> models;
    for (const std::filesystem::path& file : options.files) {
        models.push_back(stages.run("check", "check " + file.string(),
                                    [&] { return check_model(file, options.for_baking); }));
        if (!models.back().error.empty())
            complain(app, models.back().error);
        else if (to_print)
            print_text(models.back());
    }
    const Verdicts verdicts = verdicts_of(models);
    if (to_print) {
        print_verdicts(verdicts);
        if (verdicts.all() > verdicts.unreadable)
            print_entry("details", fmt::format("{} describes each condition", page));
    }
    if (options.json) print_checks(models, verdicts);
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
        "Print one JSON object: tool, version, sound, with_trouble and unreadable (numbers "
        "of files), words (the documentation), files [file, sound, error or: format, trouble "
        "(problems) and remarks (notes) of reading, "
        "primitives [name, sound, triangles, vertices, size, spacing, overlap_raster, tangents "
        "{basis, variant, nearest, nearest_by_far, same_here, texcoord_set, "
        "texcoord_set_of_material, corners, left_out, "
        "without_direction, stored_bits, tolerance, agreements} or null, "
        "trouble and remarks [kind, element, count, first, outcome]]].");
    add_switch(app, "--strict", options->strict,
               "Exit with 3 if a file has problems. Notes do not count.");
    add_switch(app, "--for-baking", options->for_baking,
               "Check for baking: overlapping texture coordinates and triangles without texture "
               "gradient are problems, for any material.");
    add_general_options(app, options->general);
    set_examples(app, {"relief-mesh check data/vase.obj data/scenes/pot.glb",
                       "relief-mesh check data/scenes/knot.glb --for-baking --strict",
                       "relief-mesh check data/vase.obj --strict --json"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
