// SPDX-License-Identifier: Apache-2.0
// Tests: tests/make/make_start_test.cpp.
#include "make_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "common/command.h"
#include "common/content_hash.h"
#include "common/model_file.h"
#include "files.h"
#include "make_baked.h"
#include "make_options.h"
#include "make_parts.h"
#include "make_stages.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/model.h"

namespace relief::tools {
namespace {

constexpr const char* record_name = "stages.json";
constexpr const char* fresh = "run without --from";

/// The stage whose file is the mesh with which a stage begins.
std::string stage_before(const std::string& stage, const make::AssetOptions& options,
                         bool is_remeshed) {
    if (stage == "bake" || stage == "write") return "frames";
    if (stage == "frames") return options.keep_texcoords ? "decimate" : "unwrap";
    if (stage == "unwrap") return "decimate";
    return is_remeshed && stage != "remesh" ? "remesh" : "repair";
}

}  // namespace

Json read_stage_record(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / record_name;
    if (!std::filesystem::exists(file))
        throw failure(file, "is missing, so that the files of --keep-stages cannot be checked",
                      fresh);
    Json record = Json::parse(relief::detail::read_file(file), nullptr, false);
    const auto has_texts = [&](const char* name) {
        const auto found = record.find(name);
        return found != record.end() && found->is_object() &&
               std::ranges::all_of(*found, [](const Json& value) { return value.is_string(); });
    };
    const bool is_sound = record.is_object() && has_texts("inputs") && has_texts("options") &&
                          has_texts("files") && record.contains("remeshed") &&
                          record.contains("version") && record["version"].is_string();
    if (!is_sound) throw failure(file, "is damaged", fresh);
    if (record["version"] != version()) {
        throw failure(
            file, fmt::format("was written by version {}", record["version"].get<std::string>()),
            fresh);
    }
    return record;
}

namespace {

/// \throws FileError if the model or an option of a stage up to `last` has changed
void check_fresh(const std::filesystem::path& folder, const Json& record, std::string_view last,
                 const MakeRequest& request, const std::vector<std::filesystem::path>& inputs) {
    const auto stale = [&](const std::string& reason) {
        return failure(folder, "is stale: " + reason, fresh);
    };
    std::set<std::string> names;
    for (const std::filesystem::path& input : inputs) {
        const std::string name = input.string();
        names.insert(name);
        const auto hash = record["inputs"].find(name);
        if (hash == record["inputs"].end()) throw stale(name + " was not a part of the model");
        if (*hash != file_hash(input)) throw stale(name + " has changed since");
    }
    for (const auto& [name, hash] : record["inputs"].items()) {
        if (!names.contains(name)) throw stale(name + " was a part of the model");
    }
    for (const MakeOption& option : make_options()) {
        if (option.stage.empty() || stage_number(option.stage) > stage_number(last)) continue;
        const std::string before = record["options"].value(std::string(option.name), "unknown");
        const std::string now = option_text(option, request);
        if (before != now)
            throw stale(fmt::format("--{} was {}, and is {} now", option.name, before, now));
    }
}

/// \throws FileError if a file before `last` was edited, but not used
void check_earlier_files(const StageFiles& files, const Json& record, std::string_view last) {
    for (const std::string_view stage : {"repair", "remesh", "decimate", "unwrap", "frames"}) {
        if (stage_number(stage) >= stage_number(last)) break;
        const std::filesystem::path file = files.mesh_file(stage);
        const auto hash = record["files"].find(file.filename().string());
        if (hash == record["files"].end() || *hash == file_hash(file)) continue;
        throw failure(file, "has changed, but the files of later stages were made before",
                      "continue from an earlier stage");
    }
}

Json runs_json(const std::vector<make::StageRun>& runs) {
    return json_list(runs, [](const make::StageRun& run) -> Json {
        return {run.count, run.primitives};
    });
}

std::vector<make::StageRun> runs_of(const Json& json) {
    std::vector<make::StageRun> runs;
    for (const Json& run : json)
        runs.push_back(
            {run.at(0).get<std::uint32_t>(), run.at(1).get<std::vector<std::uint32_t>>()});
    return runs;
}

Json layout_json(const make::StageLayout& layout) {
    return {{"has_parts", layout.has_parts},
            {"triangles", runs_json(layout.triangles)},
            {"vertices", runs_json(layout.vertices)}};
}

/// \throws FileError if the record is damaged
make::StageLayout layout_of(const std::filesystem::path& folder, const Json& record,
                            const std::string& file) {
    try {
        const Json& layout = record.at("layouts").at(file);
        return {layout.at("has_parts").get<bool>(), runs_of(layout.at("triangles")),
                runs_of(layout.at("vertices"))};
    } catch (const Json::exception&) {
        throw failure(folder / record_name, "has damaged layouts", fresh);
    }
}

/// Reads a file that was edited, in the space of an origin. The names of its objects are parts, and
/// their materials have its alpha modes, if there are several.
void read_edited(const std::filesystem::path& file, const glm::dvec3& origin,
                 make::AssetStart& start, Report& report) {
    MapModel model = map_model(read_model(file, report), ModelSpace::world, report);
    const glm::dvec3 shift = model.origin - origin;
    for (const MapModelPart& part : model.parts) {
        add_named_parts(part, "", BakeSide::low, start.parts);
        std::vector<AlphaMode> modes(part.mesh.triangles.size(), AlphaMode::opaque);
        for (const MaterialRange& range : part.mesh.material_ranges) {
            if (!range.material || *range.material >= model.appearance.materials.size()) continue;
            std::fill_n(modes.begin() + range.first_triangle, range.triangle_count,
                        model.appearance.materials[*range.material].alpha_mode);
        }
        start.alpha_modes.insert(start.alpha_modes.end(), modes.begin(), modes.end());
    }
    if (start.parts.names.size() < 2) start.parts = {};
    start.mesh = joined(std::move(model.parts));
    if (shift != glm::dvec3(0.0)) {
        for (glm::vec3& position : start.mesh.positions)
            position = glm::vec3(glm::dvec3(position) + shift);
    }
    start.mesh.material_ranges.clear();
}

}  // namespace

std::filesystem::path write_stage_record(const std::filesystem::path& folder,
                                         const make::Asset& asset, const MakeRequest& request,
                                         const std::vector<std::filesystem::path>& inputs,
                                         const StageLayouts& layouts, const Json& before) {
    const make::AssetOptions& options = request.asset;
    Json record = {{"tool", "relief make"}, {"version", version()}};
    record["inputs"] = Json::object();
    for (const std::filesystem::path& input : inputs)
        record["inputs"][input.string()] = file_hash(input);
    record["options"] = Json::object();
    for (const MakeOption& option : make_options()) {
        if (!option.stage.empty())
            record["options"][std::string(option.name)] = option_text(option, request);
    }
    const bool is_remeshed =
        options.start ? options.start->is_remeshed : asset.remesh && asset.remesh->is_remeshed;
    record["remeshed"] = is_remeshed;
    record["files"] = Json::object();
    const StageFiles files(folder, options);
    for (const std::string& stage : make::stages_of(options)) {
        if (stage == "bake" || (stage == "remesh" && !is_remeshed)) continue;
        const std::filesystem::path file = files.mesh_file(stage);
        record["files"][file.filename().string()] = file_hash(file);
    }
    if (options.start) {  // Files of the stages that did not run.
        for (const std::string_view stage : {"remesh", "decimate", "unwrap", "frames"}) {
            const std::filesystem::path file = files.mesh_file(stage);
            if (stage == "remesh" && !is_remeshed) continue;
            if (stage_number(stage) < stage_number(options.start->stage) &&
                std::filesystem::exists(file))
                record["files"][file.filename().string()] = file_hash(file);
        }
    }
    record["layouts"] = Json::object();
    for (const auto& [file, hash] : record["files"].items()) {
        const auto layout = layouts.find(file);
        if (layout != layouts.end()) {
            record["layouts"][file] = layout_json(layout->second);
        } else if (before.contains("layouts") && before["layouts"].contains(file) &&
                   before["files"].value(file, "") == hash) {
            record["layouts"][file] = before["layouts"][file];
        }
    }
    record["bake"] = baked_record(folder, asset);
    write_json(folder / record_name, record);
    return folder / record_name;
}

make::AssetStart read_start(const Json& record, const std::filesystem::path& folder,
                            const std::string& stage, const MakeRequest& request,
                            const std::vector<std::filesystem::path>& inputs,
                            const glm::dvec3& origin, Report& report) {
    const make::AssetOptions& options = request.asset;
    make::AssetStart start;
    start.stage = stage;
    start.is_remeshed = record["remeshed"] == true;
    const std::string before = stage_before(stage, options, start.is_remeshed);
    // The maps depend on all options of the bake, and on the mesh before it.
    const std::string last = stage == "write" ? "bake" : before;
    check_fresh(folder, record, last, request, inputs);
    const StageFiles files(folder, options);
    check_earlier_files(files, record, last);
    const std::filesystem::path file = files.mesh_file(before);
    if (!std::filesystem::exists(file))
        throw failure(file, fmt::format("is missing, but --from {} needs it", stage), fresh);
    const bool is_edited = record["files"].value(file.filename().string(), "") != file_hash(file);
    if (is_edited)
        report.add("stage file that was edited", "file", 0,
                   fmt::format("{} replaces the result of its stage", file.string()));
    if (stage == "remesh" && !is_edited) return start;
    if (is_edited) {
        about(file, [&] { read_edited(file, origin, start, report); });
        return start;
    }
    make::StageContents contents =
        make::read_stage_file(file, layout_of(folder, record, file.filename().string()));
    start.mesh = std::move(contents.mesh);
    start.parts = std::move(contents.parts);
    start.alpha_modes = std::move(contents.alpha_modes);
    start.is_repaired_source = stage == "decimate" && before == "repair";
    return start;
}

}  // namespace relief::tools
