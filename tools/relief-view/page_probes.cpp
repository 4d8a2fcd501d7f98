// SPDX-License-Identifier: Apache-2.0
#include "page_probes.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace relief::tools {
using namespace relief::shade;

namespace {

Json json_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

/// Returns for example "n", or "l2" for the second light of several.
std::string label_of(const ProbeLayer& layer, const ProbeVector& vector) {
    return vector.light && layer.lights.size() > 1
               ? fmt::format("{}{}", vector.symbol, *vector.light + 1)
               : std::string(vector.symbol);
}

/// The vectors of a layer; h and r only of lights before the surface.
Json vectors_json(const ProbeLayer& layer) {
    Json list = Json::array();
    for (const ProbeVector& vector : layer.vectors) {
        const bool is_behind = vector.light && !(layer.lights[*vector.light].n_dot_l > 0.0);
        if (vector.corner || is_behind) continue;
        list.push_back({label_of(layer, vector), json_of(vector.world)});
    }
    return list;
}

std::string text_of(const ProbedPixel& pixel, const Scene& scene) {
    std::string text;
    for (const ProbeSection& section : probe_sections(pixel, scene)) {
        text += section.label + '\n';
        for (const std::string& line : section.lines)
            text += "  " + line + '\n';
    }
    return text;
}

}  // namespace

std::vector<glm::ivec2> page_probe_places(const ViewOptions& options, const glm::ivec2& size) {
    std::vector<glm::ivec2> places;
    if (options.probe) places.push_back(*options.probe);
    const glm::ivec2 count = glm::min(options.page_probes, size);
    for (int y = 0; y < count.y; ++y) {
        for (int x = 0; x < count.x; ++x)
            places.emplace_back((2 * x + 1) * size.x / (2 * count.x),
                                (2 * y + 1) * size.y / (2 * count.y));
    }
    return places;
}

Json page_probe_json(const ProbedPixel& pixel, const Scene& scene) {
    const Probe& probe = pixel.probe;
    const auto layer =
        std::find_if(probe.layers.begin(), probe.layers.end(),
                     [](const ProbeLayer& each) { return each.outcome == ProbeOutcome::shown; });
    if (layer == probe.layers.end()) return {};
    Json terms = Json::array();
    for (const ProbeTerm& term : probe.terms)
        terms.push_back({probe_term_info(term.kind).name, json_of(term.value)});
    const glm::dvec4& codes = pixel.reference.codes;
    return {{"x", probe.x},
            {"y", probe.y},
            {"at", json_of(layer->position_world)},
            {"vectors", vectors_json(*layer)},
            {"text", text_of(pixel, scene)},
            {"terms", terms},
            {"radiance", json_of(probe.radiance)},
            {"codes", {codes.r, codes.g, codes.b, codes.a}}};
}

}  // namespace relief::tools
