// SPDX-License-Identifier: Apache-2.0
// Words and JSON of a bake. Tests: tests/tools/relief_bake_mesh_test.cpp.
#include "mesh/mesh_summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/choices.h"
#include "common/text.h"
#include "mesh/model_fit.h"

namespace relief::tools {
namespace {

/// Through the whole bake, coding and writing among it.
double megarays_per_second(const MeshBake& baked, const Stages& stages) {
    const double milliseconds = stages.milliseconds("bake");
    return milliseconds > 0 ? static_cast<double>(baked.all.rays) / milliseconds / 1000 : 0;
}

std::string distance_words(const MeshBakeRequest& request, const BakeResult& result) {
    const std::string found = result.texels_baked == 0
                                  ? ""
                                  : fmt::format("; the surface lies {:.4g} to {:.4g} outside",
                                                result.least_height, result.greatest_height);
    if (request.cage) return "from the cage" + found;
    const bool is_told = request.offset && request.max_distance;
    return fmt::format("from {:.4g} outside to {:.4g} inside{}{}", result.distances.offset,
                       result.distances.max_distance, is_told ? "" : " (found)", found);
}

std::string space_words(const MeshBakeRequest& request, const MeshBake& baked) {
    if (request.space == SpaceChoice::object) return "object space";
    if (request.space == SpaceChoice::world) return "world space";
    return baked.has_own_tangents ? "tangent space, by the model's own tangents"
                                  : "tangent space, by MikkTSpace's tangents";
}

const char* space_name(SpaceChoice space) {
    return space == SpaceChoice::tangent  ? "tangent"
           : space == SpaceChoice::object ? "object"
                                          : "world";
}

/// "a, b, c", or of many the first and "...".
std::string first_of(std::vector<std::string> names) {
    constexpr std::size_t most = 8;
    if (names.size() > most) {
        names.resize(most);
        names.emplace_back("...");
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<std::string> read_lines(const MeshBakeRequest& request, const MeshBake& baked) {
    const std::string high =
        request.high.size() == 1 ? request.high[0].string() : counted(request.high.size(), "model");
    const std::string looks = baked.looks.empty() ? "" : ", " + baked.looks;
    std::vector<std::string> lines = {
        fmt::format("{}: {}{}", high, counted(baked.high_triangles, "triangle"), looks),
        fmt::format("{}: {}", request.low.string(), counted(baked.low_triangles, "triangle"))};
    if (!baked.pairs.empty()) {
        std::vector<std::string> names;
        for (const BakePair& pair : baked.pairs)
            names.push_back(pair.name);
        const std::string count = counted(names.size(), "part");
        lines.push_back(fmt::format("{} matched by name: {}", count, first_of(std::move(names))));
    }
    if (!baked.unpaired.empty()) {
        lines.push_back("not matched by name, as these have no counterpart: " +
                        first_of(baked.unpaired));
    }
    return lines;
}

std::vector<std::string> map_lines(const MeshBakeRequest& request, const MeshBake& baked) {
    std::vector<std::string> lines;
    for (const BakedMap& map : baked.maps) {
        const std::string name = map.plan.name();
        lines.push_back(fmt::format(
            "{}{}{} x {}: {} baked, {} missed", name, name.empty() ? "" : ": ", request.size.x,
            request.size.y, counted(map.result.texels_baked, "texel"), map.result.texels_missed));
    }
    return lines;
}

void print_missed(const MeshBakeRequest& request, const MeshBake& baked) {
    std::vector<std::string> lines;
    for (const BakedMap& map : baked.maps) {
        const std::string name = map.plan.name();
        for (const std::string& line : missed_lines(request, map.result, baked.origin))
            lines.push_back(fmt::format("{}{}{}", name, name.empty() ? "" : ": ", line));
    }
    if (!lines.empty()) print_entry("missed", lines);
}

void print_layers(const MeshBake& baked) {
    std::vector<std::string> lines;
    for (const BakedMap& map : baked.maps) {
        for (const WrittenLayer& layer : map.layers)
            lines.push_back(layer_words(layer));
    }
    if (lines.empty()) return;
    for (const WrittenLayer& layer : baked.maps.front().layers) {
        if (layer.coding.kind != LayerKind::height) continue;
        for (const std::string& line : height_use(layer, baked.texel_size))
            lines.push_back("heights " + line);
    }
    if (baked.all.occlusion_rays > 0)
        lines.push_back(fmt::format("{} rays for occlusion", baked.all.occlusion_rays));
    print_entry("layers", lines);
}

nlohmann::ordered_json map_json(const BakedMap& map, const glm::dvec3& origin) {
    nlohmann::ordered_json json = {{"output", map.plan.output.string()}};
    if (map.plan.material) json["material"] = *map.plan.material;
    if (map.plan.udim) json["tile"] = *map.plan.udim;
    json.update({{"texels_baked", map.result.texels_baked},
                 {"texels_missed", map.result.texels_missed},
                 {"least_height", map.result.least_height},
                 {"greatest_height", map.result.greatest_height},
                 {"samples", map.result.samples},
                 {"rays", map.result.rays},
                 {"missed", missed_json(map.result, origin)}});
    if (map.verified) json["check"] = verified_json(*map.verified);
    for (const WrittenLayer& layer : map.layers)
        json["layers"].push_back(layer_json(layer));
    return json;
}

}  // namespace

std::string remedy_for_shared_texels(const MeshBakeRequest& request, const MeshBake& baked) {
    if (baked.materials < 2 || baked.all.coverage.shared == 0 || baked.maps.front().plan.material)
        return "";
    return fmt::format(
        "{}: {} share one map, in which some texels belong to several triangles "
        "(<material> in the map's name gives each a map of its own)",
        request.low.string(), counted(baked.materials, "material"));
}

void print_summary(const MeshBakeRequest& request, const MeshBake& baked, const Stages& stages) {
    const BakeResult& result = baked.all;
    print_entry("read", read_lines(request, baked));
    print_entry("rays", {distance_words(request, result),
                         fmt::format("{} for {}, {:.2f} million a second", result.rays,
                                     counted(result.samples, "sample"),
                                     megarays_per_second(baked, stages))});
    print_entry(baked.maps.size() == 1 ? "map" : "maps", map_lines(request, baked));
    print_missed(request, baked);
    print_entry("coded",
                fmt::format("{}, {}", space_words(request, baked), format_words(baked.format)));
    if (baked.accuracy) print_accuracy(request, *baked.accuracy);
    for (const BakedMap& map : baked.maps) {
        if (map.verified) print_verified(*map.verified);
    }
    print_layers(baked);
    print_entry("findings",
                baked.findings.empty() ? std::vector<std::string>{"none"} : baked.findings.lines());
    print_entry("time", durations(stages.finished()));
    std::vector<std::string> written;
    for (const BakedMap& map : baked.maps) {
        written.push_back(file_and_size(map.plan.output));
        for (const WrittenLayer& layer : map.layers)
            written.push_back(file_and_size(layer.file));
    }
    if (request.preview.file)
        written.push_back(file_and_size(*request.preview.file) +
                          " (high, low with the map, low without)");
    print_entry("wrote", written);
}

nlohmann::ordered_json results_json(const MeshBakeRequest& request, const MeshBake& baked,
                                    const Stages& stages) {
    const BakeResult& result = baked.all;
    nlohmann::ordered_json high = nlohmann::ordered_json::array();
    for (const std::filesystem::path& file : request.high)
        high.push_back(file.string());
    nlohmann::ordered_json pairs = nlohmann::ordered_json::array();
    for (const BakePair& pair : baked.pairs) {
        pairs.push_back({{"name", pair.name},
                         {"high_triangles", pair.high_triangles},
                         {"low_triangles", pair.low.size()}});
    }
    nlohmann::ordered_json maps = nlohmann::ordered_json::array();
    for (const BakedMap& map : baked.maps)
        maps.push_back(map_json(map, baked.origin));
    nlohmann::ordered_json results = {
        {"high", high},
        {"low", request.low.string()},
        {"output", request.output.string()},
        {"width", request.size.x},
        {"height", request.size.y},
        {"space", space_name(request.space)},
        {"bits", baked.format.bits},
        {"green", name_of(baked.format.green, green_choices())},
        {"zero_code", name_of(baked.format.flat, zero_code_choices())},
        {"dither", name_of(baked.format.dither, dither_choices())},
        {"high_triangles", baked.high_triangles},
        {"low_triangles", baked.low_triangles},
        {"offset", result.distances.offset},
        {"max_distance", result.distances.max_distance},
        {"least_height", result.least_height},
        {"greatest_height", result.greatest_height},
        {"texels_baked", result.texels_baked},
        {"texels_missed", result.texels_missed},
        {"samples", result.samples},
        {"rays", result.rays},
        {"occlusion_rays", result.occlusion_rays},
        {"rays_per_second", megarays_per_second(baked, stages) * 1e6},
        {"boxes", boxes_json(baked.fit, baked.origin)},
        {"pairs", pairs},
        {"maps", maps},
        {"findings", baked.findings.json()},
        {"milliseconds", durations_json(stages.finished())}};
    if (baked.accuracy) add_accuracy(*baked.accuracy, results);
    if (request.preview.file) results["preview"] = request.preview.file->string();
    return results;
}

}  // namespace relief::tools
