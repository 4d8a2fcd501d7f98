// SPDX-License-Identifier: Apache-2.0
#include "check/planted_defects.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <span>

#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"

namespace relief::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// A model before it is written.
struct Asset {
    Mesh mesh;
    std::optional<Image> color;
    std::optional<Image> normals;
    std::map<std::string, std::string> metadata;  ///< Of the normals.
    bool shows_color_as_occlusion = false;
    std::function<void(const fs::path& folder, const std::string& name)> damage;
};

/// A curved sheet of n x n squares, with its normals and its place in the image.
Mesh sheet(int n) {
    Mesh mesh;
    const auto side = static_cast<std::uint32_t>(n + 1);
    for (int row = 0; row <= n; ++row) {
        for (int column = 0; column <= n; ++column) {
            const glm::vec2 at = glm::vec2(column, row) / static_cast<float>(n);
            const glm::vec2 p = 2.0F * at - 1.0F;
            mesh.positions.emplace_back(p.x, -p.y, 0.3F * (p.x * p.x - p.y * p.y));
            mesh.normals.push_back(glm::normalize(glm::vec3(-0.6F * p.x, -0.6F * p.y, 1.0F)));
            mesh.texcoords.push_back(0.02F + 0.96F * at);
        }
    }
    for (std::uint32_t row = 0; row + 1 < side; ++row) {
        for (std::uint32_t column = 0; column + 1 < side; ++column) {
            const std::uint32_t a = row * side + column;
            mesh.triangles.emplace_back(a, a + side, a + side + 1);
            mesh.triangles.emplace_back(a, a + side + 1, a + 1);
        }
    }
    return mesh;
}

Image image_with(int size, const std::function<glm::vec3(int column, int row)>& at) {
    std::vector<std::uint8_t> samples;
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            const glm::vec3 value = at(column, row);
            for (int i = 0; i < 3; ++i)
                samples.push_back(static_cast<std::uint8_t>(std::lround(255.0F * value[i])));
        }
    }
    return {size, size, 3, ColorSpace::data, std::move(samples)};
}

/// The normal of waves in three directions, green up.
glm::vec3 wave_normal(int column, int row, int size, int variant) {
    constexpr double turn = 2.0 * std::numbers::pi;
    const double x = static_cast<double>(column) / size;
    const double y = static_cast<double>(row) / size;
    const double phase = 0.3 * variant;
    const double slope_1 = 0.35 * std::cos(turn * (2.0 * x + 3.0 * y) + phase);
    const double slope_2 = 0.25 * std::cos(turn * (4.0 * x - 3.0 * y) - phase);
    const double slope_3 = 0.2 * std::cos(turn * (x + 5.0 * y) + 2.0 * phase);
    const double along_x = 2.0 * slope_1 + 4.0 * slope_2 + slope_3;
    const double along_y = 3.0 * slope_1 - 3.0 * slope_2 + 5.0 * slope_3;
    return glm::normalize(glm::vec3(-0.3 * along_x, 0.3 * along_y, 1.0));
}

glm::vec3 code_of(const glm::vec3& normal) {
    return 0.5F * normal + 0.5F;
}

Image wave_normals(int variant, const std::function<glm::vec3(glm::vec3)>& change = code_of) {
    constexpr int size = 64;
    return image_with(
        size, [&](int column, int row) { return change(wave_normal(column, row, size, variant)); });
}

/// Replaces a square of texels.
void stamp(Image& image, int variant, const glm::vec3& value) {
    const std::span<std::uint8_t> samples = image.as<std::uint8_t>();
    for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < 6; ++column) {
            const int texel = (8 + 3 * variant + row) * image.width + 5 + 4 * variant + column;
            for (int i = 0; i < 3; ++i)
                samples[static_cast<std::size_t>(3 * texel + i)] =
                    static_cast<std::uint8_t>(std::lround(255.0F * value[i]));
        }
    }
}

Image colors(int variant) {
    return image_with(64, [&](int column, int row) {
        const bool is_odd = ((column / 8 + row / 8 + variant) & 1) != 0;
        return is_odd ? glm::vec3(0.7F, 0.3F, 0.1F)
                      : glm::vec3(0.2F, 0.25F, 0.05F * static_cast<float>(variant));
    });
}

float srgb_of(float linear) {
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

Asset sound_asset(int variant) {
    Asset asset;
    asset.mesh = sheet(6 + variant);
    asset.color = colors(variant);
    asset.normals = wave_normals(variant);
    return asset;
}

/// Gives the sheet tangents along u, which are perpendicular to its normals.
void add_tangents(Mesh& mesh) {
    for (const glm::vec3& normal : mesh.normals) {
        const glm::vec3 u(1.0F, 0.0F, 0.0F);
        mesh.tangents.emplace_back(glm::normalize(u - glm::dot(u, normal) * normal), 1.0F);
    }
}

using Plant = void (*)(Asset& asset, int variant);

struct KindRow {
    PlantedKind kind;
    Plant plant;
};

std::size_t some_vertex(const Asset& asset, int variant) {
    return (7 + 5 * static_cast<std::size_t>(variant)) % asset.mesh.positions.size();
}

std::size_t some_triangle(const Asset& asset, int variant) {
    return (9 + 4 * static_cast<std::size_t>(variant)) % asset.mesh.triangles.size();
}

/// The first kinds concern the mesh.
std::vector<KindRow> mesh_rows() {
    return {
        {{""}, [](Asset&, int) {}},
        {{"mesh/repeated-triangle"},
         [](Asset& asset, int variant) {
             asset.mesh.triangles.push_back(asset.mesh.triangles[some_triangle(asset, variant)]);
         }},
        {{"mesh/flipped-neighbors", {"mesh/normal-opposed"}},
         [](Asset& asset, int variant) {
             glm::uvec3& triangle = asset.mesh.triangles[some_triangle(asset, variant)];
             std::swap(triangle.y, triangle.z);
         }},
        {{"mesh/isolated-vertex"},
         [](Asset& asset, int variant) {
             asset.mesh.positions.emplace_back(0.1F * static_cast<float>(variant), 2.0F, 0.0F);
             asset.mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
             asset.mesh.texcoords.emplace_back(0.5F, 0.5F);
         }},
        {{"mesh/position-not-finite", {"mesh/triangle-not-finite", "mesh/degenerate-fan"}},
         [](Asset& asset, int variant) {
             asset.mesh.positions[some_vertex(asset, variant)].y = not_a_number;
         }},
        {{"mesh/far-from-origin", {"mesh/no-texture-gradient"}},
         [](Asset& asset, int variant) {
             for (glm::vec3& position : asset.mesh.positions)
                 position.x += 1e6F * static_cast<float>(1 + variant);
         }},
        {{"mesh/normal-not-unit"},
         [](Asset& asset, int variant) {
             asset.mesh.normals[some_vertex(asset, variant)] *=
                 1.1F + 0.1F * static_cast<float>(variant);
         }},
        {{"mesh/normal-zero"},
         [](Asset& asset, int variant) {
             asset.mesh.normals[some_vertex(asset, variant)] = glm::vec3(0.0F);
         }},
        {{"mesh/normal-not-finite"},
         [](Asset& asset, int variant) {
             asset.mesh.normals[some_vertex(asset, variant)].x = not_a_number;
         }},
        {{"mesh/normal-opposed"},
         [](Asset& asset, int variant) {
             for (std::size_t i = 0; i < 8 + static_cast<std::size_t>(variant); ++i)
                 asset.mesh.normals[i] = -asset.mesh.normals[i];
         }},
        {{"mesh/tangent-sign"},
         [](Asset& asset, int variant) {
             add_tangents(asset.mesh);
             asset.mesh.tangents[some_vertex(asset, variant)].w = 0.0F;
         }},
        {{"mesh/tangent-not-unit"},
         [](Asset& asset, int variant) {
             add_tangents(asset.mesh);
             glm::vec4& tangent = asset.mesh.tangents[some_vertex(asset, variant)];
             tangent = glm::vec4(glm::vec3(tangent) * (1.2F + 0.1F * static_cast<float>(variant)),
                                 tangent.w);
         }},
        {{"mesh/tangent-along-normal"},
         [](Asset& asset, int variant) {
             add_tangents(asset.mesh);
             const std::size_t vertex = some_vertex(asset, variant);
             asset.mesh.tangents[vertex] = glm::vec4(asset.mesh.normals[vertex], 1.0F);
         }},
        {{"mesh/no-texture-gradient"},
         [](Asset& asset, int variant) {
             for (int i = 0; i <= variant; ++i) {
                 const glm::uvec3& triangle = asset.mesh.triangles[static_cast<std::size_t>(6 * i)];
                 const glm::vec2 at = asset.mesh.texcoords[triangle.x];
                 asset.mesh.texcoords[triangle.y] = at;
                 asset.mesh.texcoords[triangle.z] = at;
             }
         }},
        {{"mesh/texcoord-not-finite"},
         [](Asset& asset, int variant) {
             asset.mesh.texcoords[some_vertex(asset, variant)].x = not_a_number;
         }},
        {{"mesh/texcoords-far"},
         [](Asset& asset, int variant) {
             for (glm::vec2& texcoord : asset.mesh.texcoords)
                 texcoord.x += 1e5F * static_cast<float>(1 + variant);
         }},
        {{"model/missing-texcoords"}, [](Asset& asset, int) { asset.mesh.texcoords.clear(); }},
    };
}

/// The others concern the maps.
std::vector<KindRow> map_rows() {
    return {
        {{"model/missing-image"},
         [](Asset& asset, int variant) {
             const char* const map = variant % 2 == 0 ? "color" : "normal";
             asset.damage = [map](const fs::path& folder, const std::string& name) {
                 fs::remove(folder / fmt::format("{}_{}.png", name, map));
             };
         }},
        {{"file/unreadable"},
         [](Asset& asset, int variant) {
             asset.damage = [variant](const fs::path& folder, const std::string& name) {
                 const fs::path file = folder / (name + "_color.png");
                 fs::resize_file(
                     file, fs::file_size(file) * (3U + static_cast<unsigned>(variant) / 2) / 9);
             };
         }},
        {{"model/overlapping-bake"},
         [](Asset& asset, int variant) {
             asset.metadata["relief:bake"] = "--samples 4";
             const Mesh part = asset.mesh;
             const auto first = static_cast<std::uint32_t>(part.positions.size());
             for (std::size_t i = 0; i < part.positions.size(); ++i) {
                 asset.mesh.positions.push_back(part.positions[i] + glm::vec3(3.0F, 0.0F, 0.0F));
                 asset.mesh.normals.push_back(part.normals[i]);
                 asset.mesh.texcoords.push_back(part.texcoords[i] * 0.5F +
                                                0.03F * static_cast<float>(variant));
             }
             for (const glm::uvec3& triangle : part.triangles)
                 asset.mesh.triangles.push_back(triangle + first);
         }},
        {{"texture/green-down"},
         [](Asset& asset, int variant) {
             asset.normals = wave_normals(variant, [](glm::vec3 normal) {
                 normal.y = -normal.y;
                 return code_of(normal);
             });
         }},
        {{"texture/wrong-kind"},
         [](Asset& asset, int variant) {
             asset.color = wave_normals(variant);
             asset.normals.reset();
         }},
        {{"texture/two-uses"}, [](Asset& asset, int) { asset.shows_color_as_occlusion = true; }},
        {{"map/not-normals"}, [](Asset& asset, int variant) { asset.normals = colors(variant); }},
        {{"map/through-srgb", {"map/not-unit"}},
         [](Asset& asset, int variant) {
             asset.normals = wave_normals(variant, [](const glm::vec3& normal) {
                 const glm::vec3 code = code_of(normal);
                 return glm::vec3(srgb_of(code.x), srgb_of(code.y), srgb_of(code.z));
             });
         }},
        {{"map/not-unit"},
         [](Asset& asset, int variant) {
             const float length = 0.7F + 0.02F * static_cast<float>(variant);
             asset.normals = wave_normals(
                 variant, [&](const glm::vec3& normal) { return code_of(length * normal); });
         }},
        {{"map/object-space", {"texture/wrong-kind"}},
         [](Asset& asset, int variant) {
             asset.normals = image_with(64, [&](int column, int row) {
                 constexpr double half_turn = std::numbers::pi;
                 const double longitude = half_turn * (column + 4 * variant) / 32.0;
                 const double latitude = half_turn * (row + 0.5) / 64.0;
                 return code_of(glm::vec3(std::sin(latitude) * std::cos(longitude),
                                          std::cos(latitude),
                                          std::sin(latitude) * std::sin(longitude)));
             });
         }},
        {{"map/z-missing"},
         [](Asset& asset, int variant) {
             asset.normals = wave_normals(variant, [](const glm::vec3& normal) {
                 return glm::vec3(glm::vec2(code_of(normal)), 0.0F);
             });
         }},
        {{"map/no-directions"},
         [](Asset& asset, int variant) { stamp(*asset.normals, variant, glm::vec3(0.5F)); }},
        {{"map/facing-back"},
         [](Asset& asset, int variant) {
             stamp(*asset.normals, variant, code_of(glm::normalize(glm::vec3(0.5F, 0.4F, -0.6F))));
         }},
        {{"map/all-flat"},
         [](Asset& asset, int variant) {
             const int size = variant % 2 == 0 ? 64 : 128;
             asset.normals = image_with(
                 size, [](int, int) { return glm::vec3(128.0F, 128.0F, 255.0F) / 255.0F; });
         }},
    };
}

const std::vector<KindRow>& rows() {
    static const std::vector<KindRow> all = [] {
        std::vector<KindRow> list = mesh_rows();
        for (KindRow& row : map_rows())
            list.push_back(std::move(row));
        return list;
    }();
    return all;
}

/// Returns a file name as a relative reference of glTF.
std::string uri_of(const std::string& name) {
    std::string uri;
    for (const char letter : name) {
        const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 ||
                              letter == '.' || letter == '_' || letter == '-';
        uri += is_plain ? std::string(1, letter)
                        : fmt::format("%{:02X}", static_cast<unsigned char>(letter));
    }
    return uri;
}

/// The buffer of a document.
class Buffer {
  public:
    template <typename Value>
    std::size_t add(const std::vector<Value>& values, const char* type, int component,
                    std::size_t components) {
        const std::size_t offset = bytes_.size();
        const std::size_t size = values.size() * sizeof(Value);
        bytes_.resize(offset + size);
        std::memcpy(bytes_.data() + offset, values.data(), size);
        views_.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
        accessors_.push_back({{"bufferView", views_.size() - 1},
                              {"componentType", component},
                              {"count", size / 4 / components},
                              {"type", type}});
        return accessors_.size() - 1;
    }

    void set_bounds(std::size_t accessor, const Bounds& bounds) {
        accessors_[accessor]["min"] = {bounds.min.x, bounds.min.y, bounds.min.z};
        accessors_[accessor]["max"] = {bounds.max.x, bounds.max.y, bounds.max.z};
    }

    void write(const fs::path& folder, const std::string& name, json& root) const {
        std::ofstream(folder / (name + ".bin"), std::ios::binary)
            .write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
        root["buffers"] = {{{"uri", uri_of(name + ".bin")}, {"byteLength", bytes_.size()}}};
        root["bufferViews"] = views_;
        root["accessors"] = accessors_;
    }

  private:
    std::vector<char> bytes_;
    json views_ = json::array();
    json accessors_ = json::array();
};

json primitive_of(const Mesh& mesh, Buffer& buffer) {
    constexpr int floats = 5126;
    json attributes;
    const std::size_t positions = buffer.add(mesh.positions, "VEC3", floats, 3);
    buffer.set_bounds(positions, bounds_of(mesh));
    attributes["POSITION"] = positions;
    attributes["NORMAL"] = buffer.add(mesh.normals, "VEC3", floats, 3);
    if (!mesh.tangents.empty())
        attributes["TANGENT"] = buffer.add(mesh.tangents, "VEC4", floats, 4);
    if (!mesh.texcoords.empty())
        attributes["TEXCOORD_0"] = buffer.add(mesh.texcoords, "VEC2", floats, 2);
    const std::size_t indices = buffer.add(mesh.triangles, "SCALAR", 5125, 1);
    return {{"attributes", attributes}, {"indices", indices}, {"material", 0}};
}

}  // namespace

const std::vector<PlantedKind>& planted_kinds() {
    static const std::vector<PlantedKind> kinds = [] {
        std::vector<PlantedKind> list;
        for (const KindRow& row : rows())
            list.push_back(row.kind);
        return list;
    }();
    return kinds;
}

std::string planted_name(std::size_t kind, int variant) {
    return fmt::format("{:02}-{}", kind, variant);
}

void write_planted_model(const fs::path& folder, const std::string& name, std::size_t kind,
                         int variant) {
    Asset asset = sound_asset(variant);
    rows()[kind].plant(asset, variant);
    Buffer buffer;
    json root = {{"asset", {{"version", "2.0"}}},
                 {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},
                 {"nodes", {{{"mesh", 0}}}},
                 {"meshes", {{{"primitives", {primitive_of(asset.mesh, buffer)}}}}}};
    json material = json::object();
    const auto texture = [&](const Image& image, const std::string& file,
                             const std::map<std::string, std::string>& metadata) -> json {
        write_image(folder / file, image, metadata);
        root["images"].push_back({{"uri", uri_of(file)}});
        root["textures"].push_back({{"source", root["images"].size() - 1}});
        return {{"index", root["textures"].size() - 1}};
    };
    material["pbrMetallicRoughness"]["metallicFactor"] = 0.0;
    if (asset.color) {
        const json index = texture(*asset.color, name + "_color.png", {});
        material["pbrMetallicRoughness"]["baseColorTexture"] = index;
        if (asset.shows_color_as_occlusion) material["occlusionTexture"] = index;
    }
    if (asset.normals)
        material["normalTexture"] = texture(*asset.normals, name + "_normal.png", asset.metadata);
    root["materials"] = json::array({material});
    buffer.write(folder, name, root);
    std::ofstream(folder / (name + ".gltf")) << root.dump(1);
    if (asset.damage) asset.damage(folder, name);
}

void write_planted_defects(const fs::path& folder) {
    for (std::size_t kind = 0; kind < rows().size(); ++kind) {
        for (int variant = 0; variant < planted_variants; ++variant)
            write_planted_model(folder, planted_name(kind, variant), kind, variant);
    }
    // For bench/checkers.
    json kinds = json::array();
    for (const KindRow& row : rows())
        kinds.push_back({{"rule", row.kind.rule}, {"also", row.kind.also}});
    std::ofstream(folder / "kinds.json") << kinds.dump(1);
}

}  // namespace relief::test
