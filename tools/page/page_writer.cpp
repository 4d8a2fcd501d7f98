// SPDX-License-Identifier: Apache-2.0
// Writes pages: the description and the scene as JSON, the sections behind it, and the runtime of
// runtime/. The data is a zlib stream in base64.
#include "page_writer.h"

#include <algorithm>
#include <cstring>
#include <map>

#include "common/html.h"
#include "common/text.h"
#include "short_script.h"
#include "webgl_constants.h"
#include "zlib_stream.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

// The description

Json json_of(const PageTexture& t) {
    return {{"kind", enum_name(t.kind)},
            {"t", enum_name(t.texels)},
            {"srgb", t.is_srgb},
            {"levels", t.has_levels},
            {"maxima", t.has_maxima},
            {"gray", t.is_gray},
            {"c", t.channels},
            {"image", t.image},
            {"w", t.width},
            {"h", t.height},
            {"d", t.section}};
}

Json json_of(const PageSampler& s) {
    return {{"u", s.wrap_u},
            {"v", s.wrap_v},
            {"min", s.minify},
            {"mag", s.magnify},
            {"anisotropy", s.anisotropy}};
}

Json json_of(const PageMesh& mesh) {
    Json streams = Json::array();
    for (const PageStream& stream : mesh.streams)
        streams.push_back(
            {{"attribute", stream.attribute}, {"c", stream.components}, {"d", stream.section}});
    return {{"streams", streams}, {"triangles", mesh.triangles}};
}

Json json_of(const PageSurface& surface) {
    Json textures = Json::object();
    for (const auto& [name, lookup] : surface.textures)
        textures[name] = {lookup.texture, lookup.sampler};
    return {{"values", surface.values}, {"textures", textures}};
}

Json json_of(const PageDraw& d) {
    Json json = {{"pass", enum_name(d.pass)},
                 {"program", d.program},
                 {"mesh", d.mesh},
                 {"surface", d.surface},
                 {"instance", d.instance},
                 {"first", d.first_triangle},
                 {"count", d.triangle_count},
                 {"bothSides", d.both_sides},
                 {"lights",
                  {{"directional", d.lights.directional},
                   {"point", d.lights.point},
                   {"spot", d.lights.spot},
                   {"colors", d.lights.highlight_colors}}},
                 {"rows", Json(d.rows)},
                 {"jointPairs", d.joint_pairs},
                 {"morphTexels", {d.morph_texels.x, d.morph_texels.y}}};
    if (d.shadow_program) json["shadowProgram"] = *d.shadow_program;
    if (d.rows.empty()) json["rows"] = Json::object();
    if (d.overlay_program) json["overlay"] = *d.overlay_program;
    if (d.hides_overlays) json["hides"] = true;
    return json;
}

Json json_of(const PageScreenPass& pass) {
    Json json = json_of(pass.surface);
    json["program"] = pass.program;
    return json;
}

Json json_of(const PageOverlay& o) {
    return {{"kind", enum_name(o.kind)},
            {"program", o.program},
            {"mesh", o.mesh},
            {"count", o.count},
            {"color", {o.color_srgb.r, o.color_srgb.g, o.color_srgb.b}},
            {"origin", {o.origin.x, o.origin.y, o.origin.z}},
            {"instance", or_null(o.instance)}};
}

Json json_of(const PagePicture& p, const PagePictureName& name) {
    Json draws = Json::array();
    for (const PageDraw& draw : p.draws)
        draws.push_back(json_of(draw));
    Json overlays = Json::array();
    for (const PageOverlay& overlay : p.overlays)
        overlays.push_back(json_of(overlay));
    return {{"view", name.view},
            {"variant", name.variant},
            {"step", or_null(name.step)},
            {"left", or_null(name.left)},
            {"scene", name.scene},
            {"draws", draws},
            {"overlays", overlays},
            {"skybox", p.skybox ? json_of(*p.skybox) : Json()},
            {"finishing", p.finishing ? json_of(*p.finishing) : Json()},
            {"samples", p.samples},
            {"shadowMaps", p.has_shadow_maps},
            {"copiesBehind", p.copies_behind},
            {"counts", p.counts_fragments},
            {"clear", {p.clear_color.r, p.clear_color.g, p.clear_color.b, p.clear_color.a}}};
}

Json json_of(const PageStage& stage) {
    return {{"head", stage.head},
            {"main", stage.main},
            {"steps", Json(stage.steps)},
            {"lookups", Json(stage.lookups)}};
}

Json json_of(const PageProgram& program) {
    return {{"vertex", json_of(program.vertex)}, {"fragment", json_of(program.fragment)}};
}

Json json_of(const PictureStep& step) {
    return {{"name", step.name}, {"what", step.what}, {"parts", step.parts}};
}

Json json_of(const PageSplit& split) {
    return {{"at", split.position}, {"left", split.left}, {"right", split.right}};
}

template <typename T>
Json list_of(const std::vector<T>& values) {
    Json list = Json::array();
    for (const T& value : values)
        list.push_back(json_of(value));
    return list;
}

/// The surfaces of the first picture at the times: {"clip", "times", "surfaces": {surface:
/// [surface of each time]}}.
Json motion_json(const PageDescription& page, const PageSettings& settings) {
    Json surfaces = Json::object();
    const std::vector<PageDraw>& draws = page.pictures.front().draws;
    for (std::size_t i = 0; i < draws.size(); ++i) {
        std::vector<std::size_t> moved;
        for (std::size_t k = settings.names.size(); k < page.pictures.size(); ++k) {
            const std::vector<PageDraw>& then = page.pictures[k].draws;
            if (then.size() == draws.size()) moved.push_back(then[i].surface);
        }
        const std::size_t surface = draws[i].surface;
        const bool moves = std::any_of(moved.begin(), moved.end(),
                                       [&](std::size_t each) { return each != surface; });
        if (moves && moved.size() == settings.motion_times.size())
            surfaces[std::to_string(surface)] = moved;
    }
    const SceneGraph& graph = *settings.scenes.front().graph;
    return {{"clip", graph.clip ? Json(*graph.clip) : Json()},
            {"times", settings.motion_times},
            {"surfaces", surfaces}};
}

std::string_view part(std::string_view name) {
    for (const PagePart& each : page_parts()) {
        if (each.name == name) return each.text;
    }
    return {};
}

std::string filled(std::string_view text, const std::map<std::string, std::string>& values) {
    std::string result;
    while (true) {
        const std::size_t begin = text.find("{{");
        result += text.substr(0, begin);
        if (begin == std::string_view::npos) return result;
        const std::size_t end = text.find("}}", begin);
        result += values.at(std::string(text.substr(begin + 2, end - begin - 2)));
        text.remove_prefix(end + 2);
    }
}

}  // namespace

std::string page_script() {
    std::string script;
    for (const PagePart& each : page_parts()) {
        if (each.name.ends_with(".js")) script += each.text;
    }
    return "(()=>{'use strict';" + short_script(script, webgl_constants) + "})()";
}

std::string page_frame(const std::string& title, const std::string& data) {
    return filled(part("page.html"), {{"title", html_escaped(title)},
                                      {"style", short_style(part("page.css"))},
                                      {"script", page_script()},
                                      {"data", data}});
}

std::string page_html(const PageDescription& page, const PageSettings& settings,
                      const PageQuantization& codes) {
    PageSections sections;
    const std::map<std::size_t, PackedImage> images = packed_images(page, settings.heights);
    for (std::size_t i = 0; i < page.sections.size(); ++i) {
        const auto quantized = codes.sections.find(i);
        const auto image = images.find(i);
        if (quantized != codes.sections.end()) {
            sections.add(quantized->second.codes);
        } else if (image != images.end()) {
            sections.add(image->second.bytes);
        } else {
            sections.add(page.sections[i]);
        }
    }
    Json textures = list_of(page.textures);
    for (std::size_t i = 0; i < page.textures.size(); ++i)
        if (const auto image = images.find(page.textures[i].section); image != images.end())
            textures[i].update(image->second.fields);
    Json pictures = Json::array();
    for (std::size_t i = 0; i < settings.names.size(); ++i)
        pictures.push_back(json_of(page.pictures.at(i), settings.names[i]));
    if (!settings.motion_times.empty()) pictures.front()["motion"] = motion_json(page, settings);
    Json scenes = Json::array();
    for (const PageScene& scene : settings.scenes)
        scenes.push_back(page_scene_json(scene, settings.seconds, sections));
    Json json = {{"scenes", scenes},
                 {"size", {settings.size.x, settings.size.y}},
                 {"seconds", settings.seconds},
                 {"probes", settings.probes},
                 {"pictures", pictures},
                 {"surfaces", list_of(page.surfaces)},
                 {"meshes", list_of(page.meshes)},
                 {"textures", textures},
                 {"samplers", list_of(page.samplers)},
                 {"programs", list_of(page.programs)},
                 {"parts", page.parts},
                 {"steps", list_of(settings.steps)},
                 {"split", settings.split ? json_of(*settings.split) : Json()}};
    json["quantized"] = Json::object();
    for (const auto& [section, quantized] : codes.sections)
        json["quantized"][std::to_string(section)] = {{"min", quantized.min},
                                                      {"max", quantized.max}};
    json["sections"] = sections.places();
    const std::string text = json.dump();
    std::string bytes(4, '\0');
    const auto length = static_cast<std::uint32_t>(text.size());
    std::memcpy(bytes.data(), &length, sizeof(length));
    bytes += text + sections.bytes();
    const std::string stream =
        relief::detail::zlib_stream(std::as_bytes(std::span(bytes.data(), bytes.size())));
    return page_frame(settings.title, base64(stream));
}

}  // namespace relief::tools
