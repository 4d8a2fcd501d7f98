// SPDX-License-Identifier: Apache-2.0
#include "conformance_kit.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/command.h"
#include "common/options.h"
#include "relief/mesh/gltf_document.h"

namespace relief::tools {
namespace {

const Choices<KitGroup> kit_groups = {{"conformance", KitGroup::conformance},
                                      {"defect", KitGroup::defect},
                                      {"stability", KitGroup::stability}};

std::vector<glm::vec4> read_expected(const std::filesystem::path& file, std::size_t corners) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<glm::vec4> expected(corners);
    const auto bytes = static_cast<std::streamsize>(corners * sizeof(glm::vec4));
    stream.read(reinterpret_cast<char*>(expected.data()), bytes);
    if (stream.gcount() != bytes || stream.peek() != std::ifstream::traits_type::eof())
        throw FileError(file, fmt::format("does not hold {} tangents of 16 bytes", corners));
    return expected;
}

/// Appends one vertex attribute; absent in one of them, it becomes zeros.
template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more, std::size_t count) {
    all.insert(all.end(), more.begin(), more.end());
    all.resize(count, T(0.0F));
}

KitMesh read_entry(const nlohmann::json& entry, const std::filesystem::path& folder) {
    KitMesh kit;
    kit.name = entry.at("name").get<std::string>();
    kit.group = parse_choice("group", entry.at("group").get<std::string>(), kit_groups);
    kit.about = entry.at("about").get<std::string>();
    kit.mesh = read_triangles(folder / (kit.name + ".glb"));
    if (kit.group != KitGroup::stability) {
        kit.expected = read_expected(folder / (kit.name + ".f32"), 3 * kit.mesh.triangles.size());
    }
    return kit;
}

}  // namespace

std::vector<KitMesh> read_kit(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "kit.json";
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw failure(file, "cannot be read",
                      "--kit names the folder of the kit: conformance/kit of relief's sources");
    }
    try {
        const nlohmann::json list = nlohmann::json::parse(stream);
        if (list.at("format") != 1) throw FileError(file, "is of another format than 1");
        std::vector<KitMesh> kit;
        for (const nlohmann::json& entry : list.at("meshes"))
            kit.push_back(read_entry(entry, folder));
        if (kit.empty()) throw FileError(file, "names no meshes");
        return kit;
    } catch (const nlohmann::json::exception& error) {
        throw FileError(file, error.what());
    } catch (const UsageError& error) {
        throw FileError(file, error.what());
    }
}

Mesh read_triangles(const std::filesystem::path& file) {
    Report ignored;
    const GltfDocument document = GltfDocument::read(file, ignored);
    Mesh all;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const Mesh mesh = about(file, [&] { return document.mesh(id); });
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        for (const glm::uvec3& triangle : mesh.triangles)
            all.triangles.push_back(triangle + first);
        all.positions.insert(all.positions.end(), mesh.positions.begin(), mesh.positions.end());
        append(all.normals, mesh.normals, all.positions.size());
        append(all.texcoords, mesh.texcoords, all.positions.size());
        append(all.tangents, mesh.tangents, all.positions.size());
    }
    return all;
}

}  // namespace relief::tools
