// SPDX-License-Identifier: Apache-2.0
#include "page_probes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "window/probe_figure.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

Json json_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

Json json_of(const glm::dvec2& v) {
    return {v.x, v.y};
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

/// The lobe of the first highlight of a layer: {"axis": the mirrored light, "shares"}. Row i of the
/// shares has the directions at the angle pi (i / last row)^2 from the axis, counter-clockwise.
Json lobe_json(const Probe& probe, const ProbeLayer& layer) {
    constexpr int rows = 9;
    constexpr int columns = 12;
    const auto term = std::find_if(probe.terms.begin(), probe.terms.end(), [&](const auto& each) {
        return each.kind == ProbeTermKind::highlight && each.layer &&
               &probe.layers[*each.layer] == &layer;
    });
    if (term == probe.terms.end()) return {};
    const std::optional<HighlightLobe> lobe = HighlightLobe::of(layer, *term);
    const auto mirrored =
        std::find_if(layer.vectors.begin(), layer.vectors.end(), [&](const ProbeVector& vector) {
            return vector.symbol == "r" && vector.light == term->light && !vector.corner;
        });
    if (!lobe || mirrored == layer.vectors.end() || mirrored->world == glm::dvec3(0.0)) return {};
    const glm::dvec3 z = mirrored->world;
    const glm::dvec3 x = glm::normalize(
        glm::cross(std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), z));
    const glm::dvec3 y = glm::cross(z, x);
    Json shares = Json::array();
    for (int row = 0; row < rows; ++row) {
        const double polar = std::numbers::pi * row * row / ((rows - 1) * (rows - 1));
        Json ring = Json::array();
        for (int column = 0; column < columns; ++column) {
            const double turn = 2.0 * std::numbers::pi * column / columns;
            const glm::dvec3 direction =
                std::sin(polar) * (std::cos(turn) * x + std::sin(turn) * y) + std::cos(polar) * z;
            ring.push_back(std::round(100.0 * lobe->at(direction)) / 100.0);
        }
        shares.push_back(std::move(ring));
    }
    return {{"axis", json_of(z)}, {"shares", std::move(shares)}};
}

/// The pixel in each texture: the place, and the ways to the pixel on the right and to the one
/// below, as shares of the texture. Without the lookups whose footprint is unknown.
Json lookups_json(const ProbeLayer& layer, const Scene& scene) {
    Json list = Json::array();
    for (const ProbeLookup& lookup : layer.lookups) {
        if (!lookup.texels_right || !lookup.texels_down) continue;
        const glm::dvec2 size(lookup.size);
        list.push_back({{"image", scene.images[lookup.image].name},
                        {"at", json_of(lookup.texel / size)},
                        {"right", json_of(*lookup.texels_right / size)},
                        {"down", json_of(*lookup.texels_down / size)}});
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
            {"lobe", lobe_json(probe, *layer)},
            {"lookups", lookups_json(*layer, scene)},
            {"text", text_of(pixel, scene)},
            {"terms", terms},
            {"radiance", json_of(probe.radiance)},
            {"codes", {codes.r, codes.g, codes.b, codes.a}}};
}

}  // namespace relief::tools
