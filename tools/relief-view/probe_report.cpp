// SPDX-License-Identifier: Apache-2.0
#include "probe_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <variant>

#include "common/text.h"
#include "relief/shade/reference.h"
#include "relief/shade/scene_fields.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

// Numbers

std::string number_text(double value) {
    return fmt::format("{:.4g}", value);
}

/// Returns a vector with three decimals, aligned.
std::string vector_text(glm::dvec3 v) {
    for (int i = 0; i < 3; ++i) {
        if (std::abs(v[i]) < 0.0005) v[i] = 0.0;  // Not -0.000.
    }
    return fmt::format("{:7.3f}{:7.3f}{:7.3f}", v.x, v.y, v.z);
}

std::string position_text(const glm::dvec3& p) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z);
}

std::string codes_text(const glm::dvec4& codes, int decimals) {
    return fmt::format("{:.{}f} {:.{}f} {:.{}f}, alpha {:.{}f}", codes.r, decimals, codes.g,
                       decimals, codes.b, decimals, codes.a, decimals);
}

std::string color_text(const glm::dvec4& color) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}), alpha {:.4g}", color.r, color.g, color.b,
                       color.a);
}

// Names

std::string light_name(const ProbeLight& light) {
    std::string name = fmt::format("{} {}", to_string(light.kind), light.index + 1);
    if (light.corner) name += fmt::format(", corner {}", *light.corner + 1);
    return name;
}

std::string place_name(const ProbeLayer& layer, const ProbeVector& vector) {
    if (vector.light) return ", " + light_name(layer.lights[*vector.light]);
    return vector.corner ? fmt::format(", corner {}", *vector.corner + 1) : "";
}

std::string slots_name(const ProbeLookup& lookup) {
    std::string names;
    for (const TextureSlot slot : lookup.slots)
        names += (names.empty() ? "" : ", ") + std::string(slot_info(slot).name);
    return names;
}

std::string image_name(const Scene& scene, const ProbeLookup& lookup) {
    return scene.images[lookup.image].name;
}

// Text

/// Returns for example "diffuse, point light 1, surface 2".
std::string term_name(const Probe& probe, const ProbeTerm& term) {
    std::string name(probe_term_info(term.kind).name);
    if (term.layer && term.light)
        name += ", " + light_name(probe.layers[*term.layer].lights[*term.light]);
    const auto shown =
        std::count_if(probe.layers.begin(), probe.layers.end(),
                      [](const ProbeLayer& layer) { return layer.outcome == ProbeOutcome::shown; });
    if (term.layer && shown > 1) name += fmt::format(", surface {}", *term.layer + 1);
    return name;
}

bool is_omitted(const ProbeFactor& factor) {
    return factor.value == glm::dvec3(1.0) && probe_symbol(factor.symbol).is_often_one;
}

std::string quantities_text(const ProbeTerm& term) {
    std::string text;
    for (const ProbeFactor& quantity : term.quantities) {
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", quantity.symbol,
                            tools::number_text(quantity.value));
    }
    return text;
}

std::string outcome_text(const ProbeLayer& layer) {
    switch (layer.outcome) {
        case ProbeOutcome::culled:
            return "its back, which is not drawn";
        case ProbeOutcome::cut_out:
            return fmt::format("cut out: alpha {:.4g} is below the cutoff", layer.alpha);
        case ProbeOutcome::transparent:
            return "blended with alpha 0";
        case ProbeOutcome::shown:
            break;
    }
    return layer.share == 1.0 ? "" : fmt::format("covers {:.4g} of the pixel", layer.share);
}

std::vector<std::string> surface_lines(const ProbeLayer& layer, const Scene& scene) {
    std::vector<std::string> lines;
    const std::string outcome = outcome_text(layer);
    lines.push_back(
        fmt::format("{}, triangle {}, {}, {}{}", instance_label(scene, layer.hit.instance),
                    layer.hit.triangle, layer.hit.back ? "back" : "front",
                    material_label(scene, layer.material), outcome.empty() ? "" : "; " + outcome));
    if (layer.outcome == ProbeOutcome::culled) return lines;
    lines.push_back(fmt::format(
        "position: object {}, world {}, camera {}", position_text(layer.position_object),
        position_text(layer.position_world), position_text(layer.position_camera)));
    if (layer.texcoord) {
        lines.push_back(fmt::format("texture coordinates: ({:.6g}, {:.6g})", layer.texcoord->x,
                                    layer.texcoord->y));
    }
    if (layer.texcoord_2) {
        lines.push_back(fmt::format("second texture coordinates: ({:.6g}, {:.6g})",
                                    layer.texcoord_2->x, layer.texcoord_2->y));
    }
    return lines;
}

std::vector<std::string> vector_lines(const ProbeLayer& layer) {
    std::vector<std::string> lines;
    if (layer.vectors.empty()) return lines;
    lines.push_back(
        fmt::format("   {:>21}{:>21}{:>21}{:>21}", "object", "world", "camera", "tangent space"));
    for (const ProbeVector& vector : layer.vectors) {
        const std::string tangent = vector.tangent ? vector_text(*vector.tangent) : "";
        lines.push_back(
            fmt::format("{:<3}{}{}{}{:>21}  {}{}", vector.symbol, vector_text(vector.object),
                        vector_text(vector.world), vector_text(vector.camera), tangent,
                        probe_symbol(vector.symbol).meaning, place_name(layer, vector)));
    }
    return lines;
}

std::string lookup_text(const ProbeLookup& lookup, const Scene& scene) {
    const glm::dvec2 footprint = lookup.footprint();
    const std::string area =
        footprint == glm::dvec2(0.0)
            ? "footprint unknown, edge-on"
            : fmt::format("footprint {:.3g} x {:.3g} texels", footprint.x, footprint.y);
    return fmt::format("{} '{}': texel ({:.2f}, {:.2f}) of {} x {}, {}, {}: {}", slots_name(lookup),
                       image_name(scene, lookup), lookup.texel.x, lookup.texel.y, lookup.size.x,
                       lookup.size.y, enum_name(lookup.filter), area, color_text(lookup.value));
}

std::string light_text(const ProbeLight& light) {
    std::string symbols = "intensity";
    std::string numbers = tools::number_text(light.intensity);
    const auto multiply = [&](const char* name, double value) {
        if (value == 1.0) return;
        symbols += std::string(" * ") + name;
        numbers += " * " + number_text(value);
    };
    multiply("falloff", light.falloff);
    multiply("cone", light.cone);
    multiply("shadow", light.shadow);
    const std::string product = tools::number_text(light.irradiance);
    std::string text =
        fmt::format("{}: L = {} = {}{}, n.l = {}", light_name(light), symbols, numbers,
                    numbers == product ? "" : " = " + product, number_text(light.n_dot_l));
    if (light.highlight_irradiance != light.irradiance)
        text += ", H = " + tools::number_text(light.highlight_irradiance);
    if (!(light.n_dot_l > 0.0)) text += " (behind the surface)";
    return text;
}

std::vector<std::string> term_lines(const Probe& probe) {
    std::vector<std::string> lines;
    std::string zero;
    for (const ProbeTerm& term : probe.terms) {
        if (term.value == glm::dvec3(0.0)) {
            zero += (zero.empty() ? "" : ", ") + term_name(probe, term);
            continue;
        }
        lines.push_back(term_text(probe, term));
        const std::string quantities = quantities_text(term);
        if (!quantities.empty()) lines.push_back("    with " + quantities);
    }
    if (!zero.empty()) lines.push_back("zero: " + zero);
    if (probe.layers.empty() && probe.terms.empty()) {
        lines.push_back("no surface: the background of the scene");
    } else {
        lines.push_back(fmt::format("sum: {}{}", tools::number_text(probe.radiance),
                                    probe.terms.empty() ? ", without light" : ""));
    }
    return lines;
}

std::vector<std::string> picture_lines(const Probe& probe) {
    const ProbePicture& picture = probe.picture;
    return {fmt::format("exposure {:.4g}: {}", probe.exposure, tools::number_text(picture.exposed)),
            fmt::format("tone curve {}: {}", enum_name(probe.tone_mapping),
                        tools::number_text(picture.toned)),
            fmt::format("over the background {} with coverage {:.4g}: {}",
                        color_text(probe.background), probe.alpha, color_text(picture.composed)),
            fmt::format("sRGB codes: {}", codes_text(picture.codes, 3))};
}

std::vector<std::string> compared_lines(const ProbedPixel& pixel) {
    std::vector<std::string> lines = {fmt::format("reference:  {}; codes {}",
                                                  color_text(pixel.reference.linear),
                                                  codes_text(pixel.reference.codes, 3))};
    if (!pixel.shader) return lines;
    lines.push_back(fmt::format("shader:     {}; codes {}", color_text(pixel.shader->linear),
                                codes_text(pixel.shader->codes, 0)));
    const glm::dvec4 linear = pixel.shader->linear - pixel.reference.linear;
    lines.push_back(fmt::format("difference: ({:.2g}, {:.2g}, {:.2g}), alpha {:.2g}; codes {}",
                                linear.r, linear.g, linear.b, linear.a,
                                codes_text(pixel.shader->codes - pixel.reference.codes, 3)));
    if (pixel.probe.is_edge)
        lines.emplace_back(
            "rounding may decide this pixel, or a texture is averaged here: an edge "
            "or a minified texture");
    if (pixel.samples > 1)
        lines.push_back(fmt::format("picture with {} samples: codes {}", pixel.samples,
                                    codes_text(pixel.picture, 0)));
    return lines;
}

// JSON

Json json_of(const glm::dvec2& v) {
    return {v.x, v.y};
}
Json json_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}
Json json_of(const glm::dvec4& v) {
    return {v.x, v.y, v.z, v.w};
}
template <typename Vector>
Json json_or_null(const std::optional<Vector>& vector) {
    return vector ? json_of(*vector) : Json();
}

Json factors_json(const std::vector<ProbeFactor>& factors) {
    return json_list(factors, [](const ProbeFactor& factor) -> Json {
        return {{"symbol", factor.symbol},
                {"meaning", probe_symbol(factor.symbol).meaning},
                {"value", factor.is_scalar ? Json(factor.value.x) : json_of(factor.value)}};
    });
}

Json lookup_json(const ProbeLookup& lookup, const Scene& scene) {
    return {{"image", image_name(scene, lookup)},
            {"slots",
             json_list(lookup.slots, [](TextureSlot slot) { return Json(slot_info(slot).name); })},
            {"texcoord", json_of(lookup.texcoord)},
            {"texel", json_of(lookup.texel)},
            {"size", {lookup.size.x, lookup.size.y}},
            {"filter", enum_name(lookup.filter)},
            {"footprint", json_of(lookup.footprint())},
            {"texels_right", json_or_null(lookup.texels_right)},
            {"texels_down", json_or_null(lookup.texels_down)},
            {"value", json_of(lookup.value)}};
}

Json light_json(const ProbeLight& light) {
    return {{"kind", to_string(light.kind)},
            {"index", light.index},
            {"corner", or_null(light.corner)},
            {"n_dot_l", light.n_dot_l},
            {"intensity", json_of(light.intensity)},
            {"falloff", light.falloff},
            {"cone", light.cone},
            {"shadow", light.shadow},
            {"irradiance", json_of(light.irradiance)},
            {"highlight_irradiance", json_of(light.highlight_irradiance)}};
}

Json vector_json(const ProbeVector& vector) {
    return {{"symbol", vector.symbol},          {"meaning", probe_symbol(vector.symbol).meaning},
            {"light", or_null(vector.light)},   {"corner", or_null(vector.corner)},
            {"object", json_of(vector.object)}, {"world", json_of(vector.world)},
            {"camera", json_of(vector.camera)}, {"tangent", json_or_null(vector.tangent)}};
}

Json layer_json(const ProbeLayer& layer, const Scene& scene) {
    return {{"outcome", to_string(layer.outcome)},
            {"instance", layer.hit.instance},
            {"name", instance_label(scene, layer.hit.instance)},
            {"triangle", layer.hit.triangle},
            {"back", layer.hit.back},
            {"material", material_label(scene, layer.material)},
            {"barycentric", json_of(layer.barycentric)},
            {"depth", layer.depth},
            {"alpha", layer.alpha},
            {"coverage", layer.coverage},
            {"share", layer.share},
            {"position",
             {{"object", json_of(layer.position_object)},
              {"world", json_of(layer.position_world)},
              {"camera", json_of(layer.position_camera)}}},
            {"texcoord", json_or_null(layer.texcoord)},
            {"texcoord_2", json_or_null(layer.texcoord_2)},
            {"vectors", json_list(layer.vectors, vector_json)},
            {"lights", json_list(layer.lights, light_json)},
            {"textures", json_list(layer.lookups, [&](const ProbeLookup& lookup) {
                 return lookup_json(lookup, scene);
             })}};
}

Json term_json(const ProbeTerm& term) {
    return {{"name", probe_term_info(term.kind).name},
            {"layer", or_null(term.layer)},
            {"light", or_null(term.light)},
            {"factors", factors_json(term.factors)},
            {"quantities", factors_json(term.quantities)},
            {"value", json_of(term.value)}};
}

Json values_json(const PixelValues& values) {
    return {{"linear", json_of(values.linear)}, {"codes", json_of(values.codes)}};
}

}  // namespace

glm::dvec4 pixel_of(const Image& image, const glm::ivec2& pixel) {
    const std::size_t first =
        4 * (static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(image.width) +
             static_cast<std::size_t>(pixel.x));
    glm::dvec4 value(0.0);
    std::visit(
        [&](const auto& samples) {
            for (int i = 0; i < 4; ++i)
                value[i] = static_cast<double>(samples[first + static_cast<std::size_t>(i)]);
        },
        image.samples);
    return value;
}

ProbedPixel reference_values(const Probe& probe, const Scene& scene) {
    Image radiance = make_image(1, 1, 4, 32, ColorSpace::linear);
    const std::span<float> stored = radiance.as<float>();
    for (int i = 0; i < 3; ++i)
        stored[static_cast<std::size_t>(i)] = static_cast<float>(probe.radiance[i]);
    stored[3] = static_cast<float>(probe.alpha);
    ProbedPixel pixel{probe, {}, std::nullopt};
    pixel.reference = {pixel_of(reference_picture(radiance, scene, OutputCoding::linear), {0, 0}),
                       probe.picture.codes};
    return pixel;
}

std::string number_text(const glm::dvec3& value) {
    if (value.r == value.g && value.g == value.b) return number_text(value.r);
    return position_text(value);
}

std::string term_text(const Probe& probe, const ProbeTerm& term) {
    std::string text = term_name(probe, term);
    std::string symbols;
    std::string numbers;
    std::size_t count = 0;
    for (const ProbeFactor& factor : term.factors) {
        if (is_omitted(factor)) continue;
        symbols +=
            (symbols.empty() ? "" : " * ") + (factor.symbol.find(' ') == std::string_view::npos
                                                  ? std::string(factor.symbol)
                                                  : fmt::format("[{}]", factor.symbol));
        numbers += (numbers.empty() ? "" : " * ") + number_text(factor.value);
        ++count;
    }
    text += fmt::format(": {} = {}", symbols, numbers);
    if (count > 1) text += " = " + number_text(term.value);
    return text;
}

std::vector<ProbeSection> probe_sections(const ProbedPixel& pixel, const Scene& scene) {
    const Probe& probe = pixel.probe;
    std::vector<ProbeSection> sections;
    const std::string view = probe.view == DebugView::picture
                                 ? ""
                                 : fmt::format(", view {}", debug_view_info(probe.view).name);
    sections.push_back({"pixel",
                        {fmt::format("{},{} of {} x {}, at its center, one sample{}", probe.x,
                                     probe.y, probe.width, probe.height, view)}});
    for (std::size_t i = 0; i < probe.layers.size(); ++i) {
        const ProbeLayer& layer = probe.layers[i];
        sections.push_back({probe.layers.size() > 1 ? fmt::format("surface {}", i + 1) : "surface",
                            surface_lines(layer, scene)});
        sections.push_back({"vectors", vector_lines(layer)});
        ProbeSection textures{"textures", {}};
        for (const ProbeLookup& lookup : layer.lookups)
            textures.lines.push_back(lookup_text(lookup, scene));
        sections.push_back(std::move(textures));
        ProbeSection lights{"lights", {}};
        for (const ProbeLight& light : layer.lights)
            lights.lines.push_back(light_text(light));
        sections.push_back(std::move(lights));
    }
    sections.push_back({"terms", term_lines(probe)});
    sections.push_back({"picture", picture_lines(probe)});
    sections.push_back({"compared", compared_lines(pixel)});
    std::erase_if(sections, [](const ProbeSection& section) { return section.lines.empty(); });
    return sections;
}

Json probe_json(const ProbedPixel& pixel, const Scene& scene) {
    const Probe& probe = pixel.probe;
    Json compared = {{"reference", values_json(pixel.reference)}};
    if (pixel.shader) {
        compared["shader"] = values_json(*pixel.shader);
        compared["difference"] = values_json({pixel.shader->linear - pixel.reference.linear,
                                              pixel.shader->codes - pixel.reference.codes});
        compared["picture"] = {{"samples", pixel.samples}, {"codes", json_of(pixel.picture)}};
    }
    return {
        {"x", probe.x},
        {"y", probe.y},
        {"width", probe.width},
        {"height", probe.height},
        {"view", debug_view_info(probe.view).name},
        {"edge", probe.is_edge},
        {"direction_world", json_of(probe.direction_world)},
        {"layers", json_list(probe.layers,
                             [&](const ProbeLayer& layer) { return layer_json(layer, scene); })},
        {"terms", json_list(probe.terms, term_json)},
        {"radiance", json_of(probe.radiance)},
        {"coverage", probe.alpha},
        {"picture",
         {{"exposure", probe.exposure},
          {"tone_mapping", enum_name(probe.tone_mapping)},
          {"background", json_of(probe.background)},
          {"exposed", json_of(probe.picture.exposed)},
          {"toned", json_of(probe.picture.toned)},
          {"composed", json_of(probe.picture.composed)},
          {"codes", json_of(probe.picture.codes)}}},
        {"compared", std::move(compared)}};
}

Summary probe_summary(const ProbedPixel& pixel, const Scene& scene) {
    Summary summary;
    for (const ProbeSection& section : probe_sections(pixel, scene))
        summary.add(section.label, section.lines);
    summary.add_json({{"probe", probe_json(pixel, scene)}});
    return summary;
}

}  // namespace relief::tools
