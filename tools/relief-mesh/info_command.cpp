// SPDX-License-Identifier: Apache-2.0
// `relief-mesh info IN`: what is in a model file, as text or JSON.
// Tests: tests/tools/relief_mesh_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "common/options.h"
#include "common/text.h"
#include "model_info.h"

namespace relief::tools {
namespace {

constexpr std::size_t lines_listed_at_most = 24;

std::string in_words(const Bounds& bounds) {
    if (bounds.empty()) return "empty: no finite position";
    const glm::vec3 size = bounds.max - bounds.min;
    return fmt::format(
        "({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}), size {:.4g} x {:.4g} x {:.4g}",
        bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y, bounds.max.z, size.x,
        size.y, size.z);
}

std::string in_words(const MeshBytes& memory) {
    return fmt::format("{} of attributes, {} of indices, alike on the GPU",
                       byte_size(memory.attributes), byte_size(memory.indices));
}

nlohmann::ordered_json memory_json(const MeshBytes& memory) {
    return {{"attributes", memory.attributes}, {"indices", memory.indices}};
}

nlohmann::ordered_json bounds_json(const Bounds& bounds) {
    if (bounds.empty()) return nullptr;
    return {{"min", {bounds.min.x, bounds.min.y, bounds.min.z}},
            {"max", {bounds.max.x, bounds.max.y, bounds.max.z}}};
}

std::string in_words(const PartInfo& part) {
    std::string text = part.name.empty() ? "" : part.name + ": ";
    text += counted(part.triangles, "triangle") + ", " +
            counted(part.vertices, "vertex", "vertices") + "; " +
            (part.attributes.empty() ? "positions only"
                                     : fmt::format("{}", fmt::join(part.attributes, ", ")));
    if (!part.materials.empty())
        text += fmt::format("; material {}", fmt::join(part.materials, ", "));
    return text;
}

std::string in_words(const MaterialInfo& material) {
    if (material.textures.empty()) return material.name;
    return fmt::format("{}: textures {}", material.name, fmt::join(material.textures, ", "));
}

/// One line each, cut off where a list gets too long to read.
template <typename Things>
std::vector<std::string> list(const Things& things) {
    std::vector<std::string> lines;
    for (const auto& thing : things) {
        if (lines.size() == lines_listed_at_most) {
            lines.push_back(
                fmt::format("... and {} more (--json lists all)", things.size() - lines.size()));
            break;
        }
        lines.push_back(in_words(thing));
    }
    return lines;
}

void print_info(const std::filesystem::path& file, const ModelInfo& info) {
    print_entry("file",
                fmt::format("{}: {}, {}", file.string(), info.format, byte_size(info.bytes)));
    print_entry("contents",
                fmt::format("{}, {}, {}", counted(info.triangles, "triangle"),
                            counted(info.vertices, "vertex", "vertices"),
                            counted(info.parts.size(), "primitive")) +
                    (info.instances != info.parts.size()
                         ? fmt::format(", placed {} in the scene", counted(info.instances, "time"))
                         : ""));
    print_entry("memory", in_words(info.memory));
    print_entry("bounds", in_words(info.bounds));
    print_entry("parts", list(info.parts));
    print_entry("materials", list(info.materials));
    std::vector<std::string> rest = info.beyond_a_mesh;
    if (info.images != 0) rest.push_back(counted(info.images, "image"));
    if (!rest.empty()) print_entry("also", fmt::format("{}", fmt::join(rest, ", ")));
    print_entry("packed", info.compression);
    print_entry("findings", info.findings.lines());
}

nlohmann::ordered_json json_of(const std::filesystem::path& file, const ModelInfo& info) {
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    for (const PartInfo& part : info.parts) {
        parts.push_back({{"name", part.name},
                         {"triangles", part.triangles},
                         {"vertices", part.vertices},
                         {"attributes", part.attributes},
                         {"materials", part.materials},
                         {"memory", memory_json(part.memory)},
                         {"bounds", bounds_json(part.bounds)}});
    }
    nlohmann::ordered_json materials = nlohmann::ordered_json::array();
    for (const MaterialInfo& material : info.materials)
        materials.push_back({{"name", material.name}, {"textures", material.textures}});
    return {{"file", file.string()},
            {"format", info.format},
            {"bytes", info.bytes},
            {"triangles", info.triangles},
            {"vertices", info.vertices},
            {"instances", info.instances},
            {"memory", memory_json(info.memory)},
            {"bounds", bounds_json(info.bounds)},
            {"primitives", std::move(parts)},
            {"materials", std::move(materials)},
            {"images", info.images},
            {"lights", info.lights},
            {"cameras", info.cameras},
            {"beyond_a_mesh", info.beyond_a_mesh},
            {"compression", info.compression},
            {"findings", info.findings.json()}};
}

struct InfoOptions {
    std::filesystem::path input;
    bool json = false;
};

ExitCode run(const InfoOptions& options) {
    const ModelInfo info = model_info(options.input);
    if (options.json)
        print_json(json_of(options.input, info));
    else
        print_info(options.input, info);
    return ExitCode::done;
}

}  // namespace

Command add_info_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "info",
        "Says what is in a model file: counts, memory, bounds, attributes, materials.");
    const auto options = std::make_shared<InfoOptions>();
    add_file(app, "IN", options->input, "Model to read: .glb .gltf .obj .ply .stl .off");
    add_switch(app, "--json", options->json,
               "Print one JSON object: file, format, bytes, triangles, vertices, instances, memory "
               "{attributes, indices} in bytes, bounds {min, max} in world space (null if empty), "
               "primitives [name, triangles, vertices, attributes, materials, memory, bounds], "
               "materials [name, textures], images, lights, "
               "cameras, beyond_a_mesh, compression, findings [where, kind, element, count, first, "
               "outcome].");
    set_examples(app, {"relief-mesh info data/vase.obj", "relief-mesh info data/vase.obj --json"});
    return {&app, [options] { return run(*options); }};
}

}  // namespace relief::tools
