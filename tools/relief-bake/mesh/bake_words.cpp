// SPDX-License-Identifier: Apache-2.0
// The options' own parsers read what they wrote. Tests: tests/tools/relief_bake_verify_test.cpp.
#include "mesh/bake_words.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <sstream>

#include "common/choices.h"
#include "common/options.h"

namespace relief::tools {
namespace {

constexpr std::array option_names = {"--back-faces", "--cage",         "--dither",  "--hardness",
                                     "--offset",     "--max-distance", "--outside", "--rays",
                                     "--samples",    "--sample-angle", "--space"};

/// The options alone, without a command.
void add_options(CLI::App& app, MeshBakeRequest& request) {
    add_ray_options(app, request);
    add_texel_options(app, request);
    add_choice(app, "--dither", request.map.dither, dither_choices(), "");
}

const char* word_of(RayDirections directions) {
    return directions == RayDirections::averaged  ? "averaged"
           : directions == RayDirections::shading ? "shading"
                                                  : "face";
}

const char* word_of(SpaceChoice space) {
    return space == SpaceChoice::tangent  ? "tangent"
           : space == SpaceChoice::object ? "object"
                                          : "world";
}

BakeWords words_of(const MeshBakeRequest& request) {
    BakeWords words;
    words["--space"] = word_of(request.space);
    words["--samples"] =
        request.samples.is_auto ? "auto" : fmt::format("{}", request.samples.count);
    if (request.sample_angle) words["--sample-angle"] = fmt::format("{}", *request.sample_angle);
    if (request.directions) words["--rays"] = word_of(*request.directions);
    if (request.hardness) words["--hardness"] = fmt::format("{}", *request.hardness);
    if (request.cage) words["--cage"] = "given";
    if (request.offset) words["--offset"] = fmt::format("{}", *request.offset);
    if (request.max_distance) words["--max-distance"] = fmt::format("{}", *request.max_distance);
    if (request.back_faces == BackFaces::take) words["--back-faces"] = "take";
    if (request.match != MatchChoice::automatic)
        words["--match"] = request.match == MatchChoice::name ? "name" : "all";
    if (request.outside == OutsideChoice::repeat) words["--outside"] = "repeat";
    if (request.map.dither) words["--dither"] = name_of(*request.map.dither, dither_choices());
    return words;
}

}  // namespace

std::string in_line(const BakeWords& words) {
    std::string line;
    for (const auto& [name, value] : words)
        line += fmt::format("{}{} {}", line.empty() ? "" : " ", name, value);
    return line;
}

std::map<std::string, std::string> bake_metadata(const MeshBakeRequest& request,
                                                 const MapPlan& plan) {
    std::map<std::string, std::string> metadata = {{"relief:bake", in_line(words_of(request))}};
    if (plan.material) metadata["relief:material"] = *plan.material;
    if (plan.udim) metadata["relief:udim"] = fmt::format("{}", *plan.udim);
    return metadata;
}

BakeWords bake_words(const std::filesystem::path& file,
                     const std::map<std::string, std::string>& metadata) {
    BakeWords words;
    const auto said = metadata.find("relief:bake");
    if (said == metadata.end()) return words;
    std::istringstream stream(said->second);
    std::string name, value;
    while (stream >> name) {
        const bool is_known =
            std::find(option_names.begin(), option_names.end(), name) != option_names.end();
        if (!is_known || !(stream >> value)) {
            throw failure(file, fmt::format("says that it was baked by '{}'", said->second),
                          "which this version does not know");
        }
        words[name] = value;
    }
    return words;
}

BakeWords bake_words(const CLI::App& app) {
    BakeWords words;
    for (const char* name : option_names) {
        const CLI::Option* option = app.get_option_no_throw(name);
        if (option != nullptr && option->count() > 0) words[name] = option->results().front();
    }
    return words;
}

BakeWords joined(const BakeWords& told, const BakeWords& of_file) {
    BakeWords words = told;
    for (const auto& [name, value] : of_file) {
        const bool is_of_rays = name == "--rays" || name == "--hardness" || name == "--offset";
        if (told.contains("--cage") && is_of_rays) continue;
        const bool is_of_samples = name == "--sample-angle" && told.contains("--samples");
        if (!is_of_samples) words.emplace(name, value);
    }
    return words;
}

void apply_words(const BakeWords& words, MeshBakeRequest& request) {
    CLI::App app;
    add_options(app, request);
    std::vector<std::string> line;  // CLI11 takes the last one first.
    for (const auto& [name, value] : words) {
        line.insert(line.begin(), name);
        line.insert(line.begin(), value);
    }
    try {
        app.parse(line);
    } catch (const CLI::Error& error) {
        throw UsageError(error.what());
    }
    check_bake_options(request);
}

}  // namespace relief::tools
