// SPDX-License-Identifier: Apache-2.0
// Records in a map's file the options with which it was baked, so that `relief-bake check` can
// repeat the bake. The parsers of the options read the record.
// Tests: tests/tools/relief_bake_check_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <sstream>

#include "common/choices.h"
#include "mesh_bake.h"

namespace relief::tools {
namespace {

constexpr std::array recorded_options = {
    "--back-faces", "--cage",    "--dither", "--hardness", "--match",        "--max-distance",
    "--offset",     "--outside", "--rays",   "--samples",  "--sample-angle", "--space"};

const char* to_text(RayDirections directions) {
    return directions == RayDirections::averaged  ? "averaged"
           : directions == RayDirections::shading ? "shading"
                                                  : "face";
}

const char* to_text(SpaceChoice space) {
    return space == SpaceChoice::tangent  ? "tangent"
           : space == SpaceChoice::object ? "object"
                                          : "world";
}

BakeRecord record_of(const MeshBakeRequest& request) {
    BakeRecord record;
    const auto add_number = [&](const char* name, const std::optional<double>& number) {
        if (number) record[name] = fmt::format("{}", *number);
    };
    record["--space"] = to_text(request.space);
    record["--samples"] =
        request.samples.is_auto ? "auto" : fmt::format("{}", request.samples.count);
    add_number("--sample-angle", request.sample_angle);
    if (request.directions) record["--rays"] = to_text(*request.directions);
    add_number("--hardness", request.hardness);
    if (request.cage) record["--cage"] = "given";
    add_number("--offset", request.bake.offset);
    add_number("--max-distance", request.bake.max_distance);
    if (request.bake.back_faces == BackFaces::take) record["--back-faces"] = "take";
    if (request.match != MatchChoice::automatic)
        record["--match"] = request.match == MatchChoice::name ? "name" : "all";
    if (request.bake.placement.repeat) record["--outside"] = "repeat";
    if (request.map.dither) record["--dither"] = name_of(*request.map.dither, dither_choices());
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
    add_choice(app, "--dither", request.map.dither, dither_choices(), "");
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

}  // namespace relief::tools
