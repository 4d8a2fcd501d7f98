// SPDX-License-Identifier: Apache-2.0
// `relief-mesh info IN` lists the contents of a model file: counts, memory, bounds, attributes,
// materials, and the parts of a scene that are not meshes. Tests: tests/tools/relief_mesh_test.cpp.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/mesh.h"

namespace relief::tools {
namespace {

constexpr std::size_t max_lines = 24;

/// The size of a mesh's arrays in bytes, with 32-bit floats and indices.
struct MeshBytes {
    std::size_t attributes = 0;
    std::size_t indices = 0;
};

/// A triangle primitive of a glTF file, or the mesh of another file.
struct PartInfo {
    std::string name;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    /// "normals", "texcoords", ...; positions are not listed.
    std::vector<std::string> attributes;
    std::vector<std::string> materials;  ///< The names of the materials in use.
    Bounds bounds;                       ///< In object space.
    MeshBytes memory;
};

struct MaterialInfo {
    std::string name;
    std::vector<std::string> textures;  ///< "base color", "normal", ...
};

struct ModelInfo {
    std::string format;
    std::uintmax_t bytes = 0;
    std::vector<PartInfo> parts;
    std::size_t instances = 0;  ///< The scene may contain a part several times.
    std::size_t vertices = 0;   ///< Each part counts once.
    std::size_t triangles = 0;
    MeshBytes memory;  ///< Each part counts once.
    Bounds bounds;     ///< The bounds of all instances in world space.
    std::vector<MaterialInfo> materials;
    std::size_t images = 0;
    std::size_t lights = 0;
    std::size_t cameras = 0;
    std::vector<std::string> unsupported_contents;  ///< "2 animations", "1 skin", ...
    std::vector<std::string> compression;  ///< "EXT_meshopt_compression of 3 buffer views", ...
    Findings findings;
};

std::vector<std::string> attributes_of(const Mesh& mesh) {
    std::vector<std::string> names;
    if (!mesh.normals.empty()) names.emplace_back("normals");
    if (!mesh.texcoords.empty()) names.emplace_back("texcoords");
    if (!mesh.tangents.empty()) names.emplace_back("tangents");
    if (!mesh.colors.empty()) names.emplace_back("colors");
    return names;
}

/// Returns the name, or "material 3" for a material without a name.
std::string material_name(const std::string& name, std::size_t index) {
    return name.empty() ? fmt::format("material {}", index) : name;
}

std::vector<std::string> materials_of(const Mesh& mesh,
                                      const std::vector<MaterialInfo>& materials) {
    std::set<std::uint32_t> used;
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.material) used.insert(*range.material);
    }
    std::vector<std::string> names;
    for (const std::uint32_t index : used) {
        if (index < materials.size()) names.push_back(materials[index].name);
    }
    return names;
}

template <typename T>
std::size_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

MeshBytes memory_of(const Mesh& mesh) {
    return {bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.texcoords) +
                bytes_of(mesh.tangents) + bytes_of(mesh.colors),
            bytes_of(mesh.triangles)};
}

void add_part(ModelInfo& info, std::string name, const Mesh& mesh) {
    info.parts.push_back({.name = std::move(name),
                          .vertices = mesh.positions.size(),
                          .triangles = mesh.triangles.size(),
                          .attributes = attributes_of(mesh),
                          .materials = materials_of(mesh, info.materials),
                          .bounds = bounds_of(mesh),
                          .memory = memory_of(mesh)});
    info.memory.attributes += info.parts.back().memory.attributes;
    info.memory.indices += info.parts.back().memory.indices;
    info.vertices += mesh.positions.size();
    info.triangles += mesh.triangles.size();
}

/// Extends bounds by the transformed vertices, whose bounds are tighter than the transformed
/// bounds. Positions that are not finite are left out.
void include(Bounds& all, const Mesh& mesh, const glm::mat4& world_from_object) {
    for (const glm::vec3& position : mesh.positions) {
        const glm::vec3 world(world_from_object * glm::vec4(position, 1.0F));
        const bool is_finite =
            std::isfinite(world.x) && std::isfinite(world.y) && std::isfinite(world.z);
        if (!is_finite) continue;
        all.min = glm::min(all.min, world);
        all.max = glm::max(all.max, world);
    }
}

MaterialInfo material_info(const GltfMaterial& material, std::size_t index) {
    MaterialInfo info{material_name(material.name, index), {}};
    for (const TextureSlotInfo& slot : texture_slots) {
        if (find_texture(material, slot.slot) != nullptr) info.textures.emplace_back(slot.name);
    }
    return info;
}

MaterialInfo material_info(const MtlMaterial& material, std::size_t index) {
    MaterialInfo info{material_name(material.name, index), {}};
    if (material.diffuse_map) info.textures.emplace_back("diffuse");
    if (material.normal_map) info.textures.emplace_back("normal");
    if (material.bump_map) info.textures.emplace_back("bump");
    if (material.emission_map) info.textures.emplace_back("emission");
    return info;
}

template <typename Material>
void add_materials(ModelInfo& info, const std::vector<Material>& materials) {
    for (std::size_t i = 0; i < materials.size(); ++i)
        info.materials.push_back(material_info(materials[i], i));
}

void describe(const GltfDocument& document, ModelInfo& info) {
    const GltfView view = document.view();
    add_materials(info, view.materials);
    // A mesh is decoded once, however many instances it has.
    std::map<std::pair<std::size_t, std::size_t>, std::vector<glm::mat4>> transforms;
    for (const GltfInstance<GltfPrimitiveId>& instance : view.primitives) {
        transforms[{instance.what.mesh, instance.what.primitive}].push_back(
            instance.world_from_object);
    }
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const Mesh mesh = document.mesh(id);
        add_part(info, document.describe(id), mesh);
        for (const glm::mat4& world_from_object : transforms[{id.mesh, id.primitive}])
            include(info.bounds, mesh, world_from_object);
    }
    info.instances = view.primitives.size();
    info.images = view.images.size();
    info.lights = view.lights.size();
    info.cameras = view.cameras.size();
    info.unsupported_contents = document.unsupported_contents();
    info.compression = compression_text(document, false);
}

void describe(const MeshFile& contents, ModelInfo& info) {
    add_materials(info, contents.materials);
    add_part(info, contents.mesh.name, contents.mesh);
    info.bounds = info.parts.front().bounds;
    if (!info.bounds.empty()) {
        info.bounds.min = glm::vec3(glm::dvec3(info.bounds.min) + contents.origin);
        info.bounds.max = glm::vec3(glm::dvec3(info.bounds.max) + contents.origin);
    }
    info.instances = 1;
}

/// \throws FileError if the file cannot be read
ModelInfo model_info(const std::filesystem::path& file) {
    ModelInfo info;
    info.format = format_name(readable_format(file));
    Report report;
    const Model model = read_model(file, report);
    info.bytes = std::filesystem::file_size(file);
    about(file,
          [&] { std::visit([&](const auto& contents) { describe(contents, info); }, model); });
    info.findings.add("", report);
    return info;
}

std::string as_text(const Bounds& bounds) {
    if (bounds.empty()) return "empty: no finite position";
    const glm::vec3 size = bounds.max - bounds.min;
    return fmt::format(
        "({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}), size {:.4g} x {:.4g} x {:.4g}",
        bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y, bounds.max.z, size.x,
        size.y, size.z);
}

std::string as_text(const MeshBytes& memory) {
    return fmt::format("{} of attributes, {} of indices, the same on the GPU",
                       byte_size(memory.attributes), byte_size(memory.indices));
}

Json json_of(const MeshBytes& memory) {
    return {{"attributes", memory.attributes}, {"indices", memory.indices}};
}

Json json_of(const Bounds& bounds) {
    if (bounds.empty()) return nullptr;
    return {{"min", {bounds.min.x, bounds.min.y, bounds.min.z}},
            {"max", {bounds.max.x, bounds.max.y, bounds.max.z}}};
}

std::string as_text(const PartInfo& part) {
    std::string text = part.name.empty() ? "" : part.name + ": ";
    text += counted(part.triangles, "triangle") + ", " +
            counted(part.vertices, "vertex", "vertices") + "; " +
            (part.attributes.empty() ? "positions only"
                                     : fmt::format("{}", fmt::join(part.attributes, ", ")));
    if (!part.materials.empty())
        text += fmt::format("; material {}", fmt::join(part.materials, ", "));
    return text;
}

Json json_of(const PartInfo& part) {
    return {{"name", part.name},
            {"triangles", part.triangles},
            {"vertices", part.vertices},
            {"attributes", part.attributes},
            {"materials", part.materials},
            {"memory", json_of(part.memory)},
            {"bounds", json_of(part.bounds)}};
}

std::string as_text(const MaterialInfo& material) {
    if (material.textures.empty()) return material.name;
    return fmt::format("{}: textures {}", material.name, fmt::join(material.textures, ", "));
}

Json json_of(const MaterialInfo& material) {
    return {{"name", material.name}, {"textures", material.textures}};
}

/// Adds one line per thing, and cuts long lists of the text.
template <typename Thing>
void add_list(Summary& summary, const std::string& label, const std::string& key,
              const std::vector<Thing>& things) {
    Summary::Lines lines;
    for (const Thing& thing : things) {
        if (lines.size() == max_lines) {
            lines.push_back(
                fmt::format("... and {} more (--json lists all)", things.size() - lines.size()));
            break;
        }
        lines.push_back(as_text(thing));
    }
    summary.add(label, lines,
                {{key, json_list(things, [](const Thing& thing) { return json_of(thing); })}});
}

Summary summary_of(const std::filesystem::path& file, const ModelInfo& info) {
    Summary summary;
    summary.add("file",
                fmt::format("{}: {}, {}", file.string(), info.format, byte_size(info.bytes)),
                {{"file", file.string()}, {"format", info.format}, {"bytes", info.bytes}});
    summary.add("contents",
                fmt::format("{}, {}, {}", counted(info.triangles, "triangle"),
                            counted(info.vertices, "vertex", "vertices"),
                            counted(info.parts.size(), "primitive")) +
                    (info.instances != info.parts.size()
                         ? fmt::format(", {} in the scene", counted(info.instances, "instance"))
                         : ""),
                {{"triangles", info.triangles},
                 {"vertices", info.vertices},
                 {"instances", info.instances}});
    summary.add("memory", as_text(info.memory), {{"memory", json_of(info.memory)}});
    summary.add("bounds", as_text(info.bounds), {{"bounds", json_of(info.bounds)}});
    add_list(summary, "parts", "primitives", info.parts);
    add_list(summary, "materials", "materials", info.materials);
    std::vector<std::string> rest = info.unsupported_contents;
    if (info.images != 0) rest.push_back(counted(info.images, "image"));
    summary.add("also", fmt::format("{}", fmt::join(rest, ", ")),
                {{"images", info.images},
                 {"lights", info.lights},
                 {"cameras", info.cameras},
                 {"beyond_a_mesh", info.unsupported_contents}});
    summary.add("packed", info.compression, {{"compression", info.compression}});
    summary.add_findings(info.findings, "");
    return summary;
}

struct InfoOptions {
    std::filesystem::path input;
    bool json = false;
};

ExitCode run(const InfoOptions& options) {
    const Summary summary = summary_of(options.input, model_info(options.input));
    if (options.json)
        print_json(summary.json());
    else
        summary.print();
    return ExitCode::done;
}

}  // namespace

Command add_info_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "info",
        "Lists the contents of a model file: counts, memory, bounds, attributes, materials.");
    const auto options = std::make_shared<InfoOptions>();
    add_file(app, "IN", options->input, "Model to read: .glb .gltf .obj .ply .stl .off");
    add_limit_options(app);
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
