// SPDX-License-Identifier: Apache-2.0
// Writes the meshes of the conformance kit into a folder: relief-make-conformance-kit FOLDER. Every
// run writes the same bytes. Exit codes: 0 done, 1 failed, 2 wrong usage.
// Tests: tests/tools/conformance_test.cpp.
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "kit_meshes.h"

namespace relief::conformance {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "GLB is little-endian");

void write_file(const std::filesystem::path& file, const std::string& contents) {
    std::ofstream stream(file, std::ios::binary);
    stream << contents;
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

void append_number(std::string& bytes, std::uint32_t number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// The accessors, buffer views and bytes of a GLB.
class Buffer {
  public:
    template <typename T>
    std::size_t add(std::span<const T> values, Json accessor, int target) {
        views_.push_back({{"buffer", 0},
                          {"byteOffset", bytes_.size()},
                          {"byteLength", values.size_bytes()},
                          {"target", target}});
        accessor["bufferView"] = views_.size() - 1;
        accessor["count"] = values.size();
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        accessors_.push_back(std::move(accessor));
        return accessors_.size() - 1;
    }

    void put_into(Json& document) const {
        document["accessors"] = accessors_;
        document["bufferViews"] = views_;
        document["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
    }

    [[nodiscard]] const std::string& bytes() const { return bytes_; }

  private:
    Json accessors_ = Json::array();
    Json views_ = Json::array();
    std::string bytes_;
};

Json float_accessor(const char* type) {
    return {{"componentType", 5126}, {"type", type}};
}

Json position_accessor(const std::vector<glm::vec3>& positions) {
    glm::vec3 low = positions.front();
    glm::vec3 high = low;
    for (const glm::vec3& position : positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    Json accessor = float_accessor("VEC3");
    accessor["min"] = {low.x, low.y, low.z};
    accessor["max"] = {high.x, high.y, high.z};
    return accessor;
}

Json primitive_of(const KitMesh& kit, Buffer& buffer) {
    constexpr int vertices = 34962;
    constexpr int indices = 34963;
    const Mesh& mesh = kit.mesh;
    Json attributes;
    attributes["POSITION"] =
        buffer.add<glm::vec3>(mesh.positions, position_accessor(mesh.positions), vertices);
    attributes["NORMAL"] = buffer.add<glm::vec3>(mesh.normals, float_accessor("VEC3"), vertices);
    attributes["TEXCOORD_0"] =
        buffer.add<glm::vec2>(mesh.texcoords, float_accessor("VEC2"), vertices);
    Json primitive = {{"attributes", attributes}, {"mode", 4}};
    if (!kit.is_indexed) return primitive;
    std::vector<std::uint16_t> named;
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            named.push_back(static_cast<std::uint16_t>(triangle[i]));
    }
    primitive["indices"] =
        buffer.add<std::uint16_t>(named, {{"componentType", 5123}, {"type", "SCALAR"}}, indices);
    return primitive;
}

/// Writes a GLB with POSITION, NORMAL and TEXCOORD_0 as floats, 16-bit indices if the mesh is
/// indexed, one primitive and one node, without TANGENT. It does not use relief's glTF documents,
/// so that the bytes never change, and normals of any length are kept.
void write_glb(const std::filesystem::path& file, const KitMesh& mesh) {
    Buffer buffer;
    Json document;
    document["asset"] = {{"version", "2.0"}, {"generator", "relief conformance kit"}};
    document["scene"] = 0;
    document["scenes"] = Json::array({{{"nodes", {0}}}});
    document["nodes"] = Json::array({{{"mesh", 0}, {"name", mesh.name}}});
    document["meshes"] = Json::array(
        {{{"name", mesh.name}, {"primitives", Json::array({primitive_of(mesh, buffer)})}}});
    buffer.put_into(document);
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF";
    append_number(bytes, 2);
    append_number(bytes, static_cast<std::uint32_t>(28 + text.size() + buffer.bytes().size()));
    append_number(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += "JSON" + text;
    append_number(bytes, static_cast<std::uint32_t>(buffer.bytes().size()));
    bytes += std::string("BIN\0", 4) + buffer.bytes();
    write_file(file, bytes);
}

/// Writes an OBJ with the quads of the mesh. Its numbers are read as the same floats.
void write_obj(const std::filesystem::path& file, const KitMesh& mesh) {
    std::string text = "# relief conformance kit: " + mesh.name + "\n";
    for (const glm::vec3& p : mesh.mesh.positions)
        text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    // All digits are written, so that a reader that converts v in double gets the same numbers.
    for (const glm::dvec2 t : mesh.mesh.texcoords)
        text += fmt::format("vt {} {}\n", t.x, 1.0 - t.y);
    for (const glm::vec3& n : mesh.mesh.normals)
        text += fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
    for (const glm::uvec4& quad : mesh.quads) {
        text += "f";
        for (int i = 0; i < 4; ++i)
            text += fmt::format(" {0}/{0}/{0}", quad[i] + 1);
        text += "\n";
    }
    write_file(file, text);
}

/// Writes kit.json: name, group, description, and numbers of vertices and triangles of each mesh.
void write_list(const std::filesystem::path& file, const std::vector<KitMesh>& meshes) {
    Json list = Json::array();
    for (const KitMesh& mesh : meshes) {
        list.push_back({{"name", mesh.name},
                        {"group", enum_name(mesh.group)},
                        {"about", mesh.about},
                        {"vertices", mesh.mesh.positions.size()},
                        {"triangles", mesh.mesh.triangles.size()}});
    }
    const Json kit = {{"format", 1}, {"meshes", list}};
    write_file(file, kit.dump(1) + "\n");
}

void write_all(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    const std::vector<KitMesh> meshes = kit_meshes();
    for (const KitMesh& mesh : meshes) {
        write_glb(folder / (mesh.name + ".glb"), mesh);
        if (!mesh.quads.empty()) write_obj(folder / (mesh.name + ".obj"), mesh);
    }
    write_list(folder / "kit.json", meshes);
}

}  // namespace
}  // namespace relief::conformance

int main(int count, char** arguments) {
    if (count != 2 || arguments[1][0] == '-') {
        fmt::print(stderr, "usage: relief-make-conformance-kit FOLDER\n");
        return 2;
    }
    try {
        relief::conformance::write_all(arguments[1]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "relief-make-conformance-kit: error: {}\n", error.what());
        return 1;
    }
    return 0;
}
