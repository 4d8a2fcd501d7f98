// SPDX-License-Identifier: Apache-2.0
#include "model_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/findings.h"
#include "common/model_file.h"
#include "common/text.h"

namespace relief::tools {
namespace {

/// Whether a finding of a reader leaves the model whole.
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
        (is_harmless(finding) ? model.reading_remarks : model.reading_trouble).add(finding);
}

/// What a part will be used for, which decides what is trouble.
struct Use {
    bool tangents = false;
    bool baking = false;
};

Severity severity_of(MeshCondition condition, const Use& use) {
    if (condition == MeshCondition::texture_degenerate && !use.tangents && !use.baking)
        return Severity::remark;
    if (condition == MeshCondition::texture_overlapping && use.baking) return Severity::trouble;
    return condition_info(condition).severity;
}

void add_part(CheckedModel& model, std::string name, const Mesh& mesh, const Use& use) {
    CheckedPart part{
        std::move(name), mesh.triangles.size(), mesh.positions.size(), diagnose(mesh), {}, {}, {}};
    for (const FoundCondition& found : part.diagnosis.found) {
        const bool is_trouble = severity_of(found.condition, use) == Severity::trouble;
        (is_trouble ? part.trouble : part.remarks).add(to_finding(found));
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

/// Unless the materials name textures, nothing is known of what the mesh is for.
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

std::size_t triangles_of(const CheckedModel& model) {
    std::size_t triangles = 0;
    for (const CheckedPart& part : model.parts)
        triangles += part.triangles;
    return triangles;
}

std::string verdict(const CheckedModel& model) {
    if (!model.is_sound()) return "trouble";
    return triangles_of(model) == 0 ? "nothing to judge" : "sound";
}

/// A condition over all parts.
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

/// One line for each condition: where it is first, and in how many primitives.
std::vector<std::string> trouble_lines(const CheckedModel& model) {
    std::vector<std::string> lines;
    for (const Finding& finding : model.reading_trouble.findings())
        lines.push_back(to_string(finding));
    for (const MeshConditionInfo& condition : mesh_conditions()) {
        const Sum sum = sum_of(model, &CheckedPart::trouble, condition.word);
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
std::string remarks_in_words(const CheckedModel& model) {
    std::vector<std::string> words;
    for (const Finding& finding : model.reading_remarks.findings())
        words.push_back(fmt::format("{} x {} {}", finding.count, finding.kind, finding.outcome));
    for (const MeshConditionInfo& condition : mesh_conditions()) {
        const Sum sum = sum_of(model, &CheckedPart::remarks, condition.word);
        if (sum.parts == 0) continue;
        words.push_back(fmt::format("{} x {}", sum.count, condition.word));
        if (model.parts.size() > 1)
            words.back() += fmt::format(" in {}", counted(sum.parts, "primitive"));
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

/// What the tangents of each primitive are; those of which the same is to be said share a line.
std::vector<std::string> tangents_in_words(const CheckedModel& model) {
    struct Alike {
        std::string words;
        const CheckedPart* first;
        std::size_t parts;
    };
    std::vector<Alike> groups;
    for (const CheckedPart& part : model.parts) {
        if (!part.tangents) continue;
        std::string words = in_words(*part.tangents);
        const auto group = std::find_if(groups.begin(), groups.end(),
                                        [&](const Alike& other) { return other.words == words; });
        if (group == groups.end())
            groups.push_back({std::move(words), &part, 1});
        else
            ++group->parts;
    }
    constexpr std::size_t listed_at_most = 12;
    std::vector<std::string> lines;
    for (const Alike& group : groups) {
        if (lines.size() == listed_at_most) {
            lines.push_back(
                fmt::format("... and {} more (--json lists all)", groups.size() - listed_at_most));
            break;
        }
        const std::string others =
            group.parts == 1 ? "" : fmt::format(" and {} more alike", group.parts - 1);
        const std::string place =
            group.first->name.empty() ? "" : group.first->name + others + ": ";
        lines.push_back(place + group.words);
    }
    return lines;
}

/// Findings of a place that is named beside them.
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
            {"sound", part.trouble.empty()},
            {"triangles", part.triangles},
            {"vertices", part.vertices},
            {"size", part.diagnosis.size},
            {"spacing", part.diagnosis.spacing},
            {"overlap_raster", part.diagnosis.overlap_raster},
            {"tangents", part.tangents ? json_of(*part.tangents) : nlohmann::ordered_json()},
            {"trouble", findings_json(part.trouble)},
            {"remarks", findings_json(part.remarks)}};
}

}  // namespace

bool CheckedModel::is_sound() const {
    return error.empty() && reading_trouble.empty() &&
           std::all_of(parts.begin(), parts.end(),
                       [](const CheckedPart& part) { return part.trouble.empty(); });
}

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

void print_text(const CheckedModel& model) {
    print_entry("file", fmt::format("{}: {}, {}, {}: {}", model.file.string(), model.format,
                                    counted(model.parts.size(), "primitive"),
                                    counted(triangles_of(model), "triangle"), verdict(model)));
    print_entry("trouble", trouble_lines(model));
    const std::string remarks = remarks_in_words(model);
    if (!remarks.empty()) print_entry("remarks", remarks);
    print_entry("tangents", tangents_in_words(model));
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
            {"trouble", findings_json(model.reading_trouble)},
            {"remarks", findings_json(model.reading_remarks)},
            {"primitives", std::move(parts)}};
}

}  // namespace relief::tools
