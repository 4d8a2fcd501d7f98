// SPDX-License-Identifier: Apache-2.0
// Conversion between glTF documents and meshes with MTL materials, in both directions.
//
// from_mesh() keeps object space: it becomes the space of the only node. Phong's exponent Ns
// becomes GGX's alpha by alpha^2 = 2 / (Ns + 2) [Karis 2013]; glTF's roughness is the square root
// of alpha. A missing image is a finding, or a FileError if there is no report.
//
// flattened() transforms all primitives of the scene to world space. Attributes that only some
// primitives have are completed: flat normals (as glTF requires), texture coordinate (0, 0), white.
// MeshFile has no tangents.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "file_replacement.h"
#include "files.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The arrays of a document that is made from a mesh.
enum class Arrays {
    copied,
    borrowed,  ///< Where possible: the mesh must outlive the document.
};

/// Builds the document of one mesh.
class DocumentBuilder {
  public:
    DocumentBuilder(const MeshFile& file, Report* report, Arrays arrays)
        : file_(file), report_(report), arrays_(arrays) {}
    GltfContents build();

  private:
    template <typename Element>
    std::size_t add_accessor(std::span<const Element> elements, const char* type,
                             int component_type, int target, Arrays arrays);
    std::size_t add_indices(const Mesh& mesh, Arrays arrays);
    void add_primitive(const Mesh& mesh, std::optional<std::uint32_t> material, Arrays arrays);
    void add_range(const MaterialRange& range);
    void add_material(const MtlMaterial& material, std::size_t index);
    Json texture_info(const std::filesystem::path& image);
    void add_texture(Json& holder, const char* key, const char* texture,
                     const std::optional<std::filesystem::path>& image, const MtlMaterial& material,
                     std::size_t index);

    const MeshFile& file_;
    Report* report_;
    Arrays arrays_;
    GltfContents contents_;
    std::map<std::filesystem::path, std::size_t> textures_;
    bool uses_emissive_strength_ = false;
};

template <typename Element>
std::size_t DocumentBuilder::add_accessor(std::span<const Element> elements, const char* type,
                                          int component_type, int target, Arrays arrays) {
    const std::string_view bytes(reinterpret_cast<const char*>(elements.data()),
                                 elements.size_bytes());
    const std::size_t view = arrays == Arrays::borrowed ? add_borrowed_view(contents_, bytes)
                                                        : add_view(contents_, bytes);
    contents_.root["bufferViews"][view]["target"] = target;
    Json& accessors = contents_.root["accessors"];
    accessors.push_back({{"bufferView", view},
                         {"componentType", component_type},
                         {"count", elements.size() * sizeof(Element) /
                                       (component_count(type) * component_size(component_type))},
                         {"type", type}});
    return accessors.size() - 1;
}

std::size_t DocumentBuilder::add_indices(const Mesh& mesh, Arrays arrays) {
    static_assert(sizeof(glm::uvec3) == 3 * sizeof(std::uint32_t));
    const std::span indices(reinterpret_cast<const std::uint32_t*>(mesh.triangles.data()),
                            3 * mesh.triangles.size());
    // 65535 restarts strips, so it must not be a vertex.
    if (mesh.positions.size() > 0xFFFF)
        return add_accessor(indices, "SCALAR", gltf_code::uint32, gltf_code::element_array_buffer,
                            arrays);
    const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
    return add_accessor(std::span(narrow), "SCALAR", gltf_code::uint16,
                        gltf_code::element_array_buffer, Arrays::copied);
}

/// Returns whether a normal is not unit within glTF's tolerance, although it has a direction.
bool needs_normalizing(const glm::vec3& normal) {
    const double length = glm::length(glm::dvec3(normal));
    return length > 0.0 && std::isfinite(length) && std::abs(length - 1.0) > 5e-4;
}

/// Normalizes normals for glTF, because OBJ allows any length. Normals that are unit within glTF's
/// tolerance keep their bits; zero and non-finite ones stay.
void normalize_for_gltf(Mesh& mesh) {
    for (glm::vec3& normal : mesh.normals) {
        if (needs_normalizing(normal))
            normal = glm::vec3(glm::dvec3(normal) / glm::length(glm::dvec3(normal)));
    }
}

/// The triangles of a range as a mesh of their own, with the vertices that they use, ascending.
Mesh part_of(const Mesh& mesh, const MaterialRange& range) {
    std::vector<bool> is_used(mesh.positions.size());
    Mesh part;
    const auto first = mesh.triangles.begin() + range.first_triangle;
    part.triangles.assign(first, first + range.triangle_count);
    for (const glm::uvec3& triangle : part.triangles) {
        for (int k = 0; k < 3; ++k)
            is_used[triangle[k]] = true;
    }
    std::vector<std::uint32_t> place(mesh.positions.size(), 0);
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < is_used.size(); ++i) {
        if (!is_used[i]) continue;
        place[i] = count++;
        const auto pick = [&](const auto& values, auto& picked) {
            if (!values.empty()) picked.push_back(values[i]);
        };
        pick(mesh.positions, part.positions);
        pick(mesh.normals, part.normals);
        pick(mesh.tangents, part.tangents);
        pick(mesh.texcoords, part.texcoords);
        pick(mesh.colors, part.colors);
    }
    for (glm::uvec3& triangle : part.triangles)
        triangle = glm::uvec3(place[triangle.x], place[triangle.y], place[triangle.z]);
    return part;
}

/// Returns the bytes of a primitive, at most.
std::size_t size_of(const Mesh& mesh) {
    const auto bytes = [](const auto& values) { return values.size() * sizeof(values[0]); };
    return bytes(mesh.positions) + bytes(mesh.normals) + bytes(mesh.tangents) +
           bytes(mesh.texcoords) + bytes(mesh.colors) + bytes(mesh.triangles);
}

/// Adds all triangles of a mesh as a primitive.
void DocumentBuilder::add_primitive(const Mesh& mesh, std::optional<std::uint32_t> material,
                                    Arrays arrays) {
    if (arrays == Arrays::copied) reserve_bytes(contents_, size_of(mesh));
    Json attributes;
    const auto add = [&](const char* name, const auto& values, const char* type) {
        if (values.empty()) return;
        attributes[name] = add_accessor(std::span(values), type, gltf_code::float32,
                                        gltf_code::array_buffer, arrays);
    };
    add("POSITION", mesh.positions, "VEC3");
    set_bounds(contents_.root["accessors"][attributes["POSITION"].get<std::size_t>()],
               mesh.positions);
    add("NORMAL", mesh.normals, "VEC3");
    if (!mesh.normals.empty()) add("TANGENT", mesh.tangents, "VEC4");
    add("TEXCOORD_0", mesh.texcoords, "VEC2");
    add("COLOR_0", mesh.colors, "VEC4");
    Json primitive = {{"attributes", attributes}};
    primitive["indices"] = add_indices(mesh, arrays);
    if (material) primitive["material"] = *material;
    contents_.root["meshes"][0]["primitives"].push_back(primitive);
}

/// Only what a primitive changes is copied: large meshes are mostly one primitive.
void DocumentBuilder::add_range(const MaterialRange& range) {
    const Mesh& mesh = file_.mesh;
    const bool is_whole = range.triangle_count == mesh.triangles.size();
    if (is_whole && std::none_of(mesh.normals.begin(), mesh.normals.end(), needs_normalizing)) {
        add_primitive(mesh, range.material, arrays_);
        return;
    }
    Mesh part = is_whole ? mesh : part_of(mesh, range);
    normalize_for_gltf(part);
    add_primitive(part, range.material, Arrays::copied);
}

/// The texture of an image file. Each file is embedded once.
Json DocumentBuilder::texture_info(const std::filesystem::path& image) {
    auto entry = textures_.find(image);
    if (entry == textures_.end()) {
        const std::string bytes = read_file(image);
        entry = textures_.emplace(image, textures_.size()).first;
        const std::string media_type = image_media_type(bytes);
        if (media_type != "image/png" && media_type != "image/jpeg") {
            throw FileError(image, "is neither PNG nor JPEG, the formats of glTF");
        }
        Report ignored;
        const std::string name = utf8_name(image.stem().string(), "image", entry->second,
                                           report_ == nullptr ? ignored : *report_);
        contents_.root["images"].push_back(
            {{"bufferView", add_view(contents_, bytes)}, {"mimeType", media_type}, {"name", name}});
        contents_.root["textures"].push_back({{"sampler", 0}, {"source", entry->second}});
        contents_.root["samplers"] = Json::array({{{"wrapS", 10497}, {"wrapT", 10497}}});
    }
    return {{"index", entry->second}};
}

/// Sets a member of a material to the texture of an image, if the material has a readable one.
///
/// \param texture  its name in the report
void DocumentBuilder::add_texture(Json& holder, const char* key, const char* texture,
                                  const std::optional<std::filesystem::path>& image,
                                  const MtlMaterial& material, std::size_t index) {
    if (!image) return;
    if (file_.mesh.texcoords.empty()) {
        if (report_ != nullptr) {
            report_->add(fmt::format("{} of material '{}' without texture coordinates", texture,
                                     material.name),
                         "material", index, "left out");
        }
        return;
    }
    std::error_code ignored;
    const bool may_read = material.may_read(*image);
    if (may_read &&
        (report_ == nullptr || std::filesystem::is_regular_file(staged_file(*image), ignored))) {
        holder[key] = texture_info(*image);
        return;
    }
    constexpr const char* outside = "lies outside of the model's folder";
    if (report_ == nullptr) throw FileError(*image, outside);
    const bool exists = std::filesystem::exists(*image, ignored);
    report_->add(fmt::format("unreadable {} of material '{}'", texture, material.name), "material",
                 index,
                 fmt::format("left out: {}: {}", image->string(),
                             !may_read ? outside
                             : exists  ? "is not a file"
                                       : "no such file"));
}

void DocumentBuilder::add_material(const MtlMaterial& material, std::size_t index) {
    const auto clamped = [](float value) { return std::clamp(value, 0.0F, 1.0F); };
    const glm::vec3 color = glm::clamp(material.diffuse, 0.0F, 1.0F);
    const float opacity = clamped(material.opacity);
    Json pbr = {
        {"baseColorFactor", {color.r, color.g, color.b, opacity}},
        {"metallicFactor", 0.0F},
        {"roughnessFactor",
         clamped(std::sqrt(std::sqrt(2.0F / (std::max(material.shininess, 0.0F) + 2.0F))))}};
    add_texture(pbr, "baseColorTexture", "diffuse texture", material.diffuse_map, material, index);
    Json json = {{"name", material.name}, {"pbrMetallicRoughness", pbr}};
    const bool has_alpha_texture =
        material.opacity_map && material.opacity_map == material.diffuse_map;
    if (opacity < 1.0F || has_alpha_texture) json["alphaMode"] = "BLEND";
    if (material.opacity_map && !has_alpha_texture && report_ != nullptr) {
        report_->add(fmt::format("map_d '{}' of material '{}', which is not its map_Kd",
                                 material.opacity_map->string(), material.name),
                     "material", index, "is left out (store the opacity in the alpha of map_Kd)");
    }
    add_texture(json, "emissiveTexture", "emission texture", material.emission_map, material,
                index);
    // An emissive texture needs a factor to have an effect, but the default of Ke in MTL is black.
    glm::vec3 emission = glm::max(material.emission, 0.0F);
    const bool has_emission_texture = json.contains("emissiveTexture");
    if (has_emission_texture && emission == glm::vec3(0.0F)) emission = glm::vec3(1.0F);
    // Without its texture the object would glow as a whole, while most texels of such textures are
    // black.
    if (material.emission_map && !has_emission_texture) emission = glm::vec3(0.0F);
    const float strength = std::max({emission.r, emission.g, emission.b, 1.0F});
    if (emission != glm::vec3(0.0F)) {
        emission /= strength;
        json["emissiveFactor"] = {emission.r, emission.g, emission.b};
    }
    if (strength > 1.0F) {
        json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
        uses_emissive_strength_ = true;
    }
    add_texture(json, "normalTexture", "normal map", material.normal_map, material, index);
    contents_.root["materials"].push_back(json);
}

GltfContents DocumentBuilder::build() {
    const Mesh& mesh = file_.mesh;
    Json& root = contents_.root;
    root["asset"] = {{"version", "2.0"}, {"generator", "relief"}};
    root["scene"] = 0;
    root["scenes"] = Json::array({{{"nodes", {0}}}});
    root["nodes"] = Json::array({{{"mesh", 0}}});
    if (file_.origin != glm::dvec3(0.0))
        root["nodes"][0]["translation"] = {file_.origin.x, file_.origin.y, file_.origin.z};
    root["meshes"] = Json::array({{{"primitives", Json::array()}}});
    if (!mesh.name.empty()) {
        root["nodes"][0]["name"] = mesh.name;
        root["meshes"][0]["name"] = mesh.name;
    }
    std::vector<MaterialRange> ranges = mesh.material_ranges;
    if (ranges.empty()) {
        ranges.push_back({0, static_cast<std::uint32_t>(mesh.triangles.size()), std::nullopt});
    }
    for (const MaterialRange& range : ranges) {
        if (range.triangle_count > 0) add_range(range);
    }
    for (std::size_t i = 0; i < file_.materials.size(); ++i)
        add_material(file_.materials[i], i);
    if (uses_emissive_strength_) root["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    contents_.position_uses.assign(array_in(root, "accessors").size(), 0);
    return std::move(contents_);
}

/// \param report  if null, an unreadable image is a FileError
GltfContents gltf_from_mesh(const MeshFile& file, Report* report, Arrays arrays = Arrays::copied) {
    validate(file.mesh);
    if (file.mesh.triangles.empty()) throw InvalidInput("the mesh has no triangle");
    for (const MaterialRange& range : file.mesh.material_ranges) {
        if (range.material && *range.material >= file.materials.size()) {
            throw InvalidInput(
                fmt::format("a material range names material {}, but there are "
                            "only {}",
                            *range.material, file.materials.size()));
        }
    }
    GltfContents contents = DocumentBuilder(file, report, arrays).build();
    const std::size_t primitives = contents.root["meshes"][0]["primitives"].size();
    for (std::size_t i = 0; report != nullptr && i < primitives; ++i)
        repair_values(contents, {0, i}, *report);
    return contents;
}

}  // namespace

GltfDocument GltfDocument::from_mesh(const MeshFile& contents) {
    return GltfDocument(std::make_unique<Contents>(Contents{gltf_from_mesh(contents, nullptr)}));
}

GltfDocument GltfDocument::from_mesh(const MeshFile& contents, Report& report) {
    return GltfDocument(std::make_unique<Contents>(Contents{gltf_from_mesh(contents, &report)}));
}

void GltfDocument::write_mesh(const std::filesystem::path& file, const MeshFile& contents,
                              Report& report) {
    GltfDocument(
        std::make_unique<Contents>(Contents{gltf_from_mesh(contents, &report, Arrays::borrowed)}))
        .write(file);
}

namespace {

/// Translates a material: the inverse of DocumentBuilder::add_material().
MtlMaterial translated(const GltfMaterial& material, const GltfView& view) {
    MtlMaterial result;
    result.name = material.name;
    const MetallicRoughness& model = *material.metallic_roughness;
    result.diffuse = model.base_color;
    result.opacity = material.opacity;
    result.emission = material.emission;
    const float alpha = std::max(model.roughness * model.roughness, 1e-3F);
    result.shininess = std::max(2.0F / (alpha * alpha) - 2.0F, 0.0F);
    const auto path = [&](TextureSlot slot) {
        std::optional<std::filesystem::path> file;
        if (const Texture* texture = find_texture(material, slot)) {
            const auto* found =
                std::get_if<std::filesystem::path>(&view.images[texture->image].source);
            if (found != nullptr) file = *found;
        }
        return file;
    };
    result.diffuse_map = path(TextureSlot::base_color);
    result.emission_map = path(TextureSlot::emission);
    result.normal_map = path(TextureSlot::normal);
    return result;
}

/// Appends one transformed primitive and completes its missing arrays.
void append(Mesh& all, const Mesh& part) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    all.normals.insert(all.normals.end(), part.normals.begin(), part.normals.end());
    all.texcoords.insert(all.texcoords.end(), part.texcoords.begin(), part.texcoords.end());
    all.colors.insert(all.colors.end(), part.colors.begin(), part.colors.end());
    const auto first_triangle = static_cast<std::uint32_t>(all.triangles.size());
    for (const glm::uvec3& triangle : part.triangles)
        all.triangles.push_back(triangle + first);
    for (MaterialRange range : part.material_ranges) {
        range.first_triangle += first_triangle;
        MaterialRange* last = all.material_ranges.empty() ? nullptr : &all.material_ranges.back();
        if (last != nullptr && last->material == range.material) {
            last->triangle_count += range.triangle_count;
        } else {
            all.material_ranges.push_back(range);
        }
    }
}

struct ByIndex {
    bool operator()(GltfPrimitiveId a, GltfPrimitiveId b) const {
        return std::pair(a.mesh, a.primitive) < std::pair(b.mesh, b.primitive);
    }
};

}  // namespace

MeshFile flattened(const GltfDocument& document) {
    document.require_memory_of_instances();
    const GltfView view = document.view();
    std::map<GltfPrimitiveId, Mesh, ByIndex> parts;
    bool any_normals = false;
    bool any_texcoords = false;
    bool any_colors = false;
    std::size_t vertex_count = 0;
    for (const auto& instance : view.primitives) {
        auto entry = parts.find(instance.what);
        if (entry == parts.end())
            entry = parts.emplace(instance.what, document.mesh(instance.what)).first;
        const Mesh& part = entry->second;
        any_normals = any_normals || !part.normals.empty();
        any_texcoords = any_texcoords || !part.texcoords.empty();
        any_colors = any_colors || !part.colors.empty();
        vertex_count += part.positions.size();
    }
    if (vertex_count > std::numeric_limits<std::uint32_t>::max()) {
        throw InvalidInput(fmt::format("{} vertices are too many for one mesh", vertex_count));
    }
    MeshFile result;
    for (auto& [id, part] : parts) {
        if (any_normals && part.normals.empty()) {
            FrameOptions options;
            options.if_missing = NormalMode::flat;
            Report ignored;  // The document's own processing reports these findings.
            part = with_frames(std::move(part), options, ignored).mesh;
        }
        const std::size_t count = part.positions.size();
        if (any_texcoords && part.texcoords.empty()) part.texcoords.assign(count, glm::vec2(0.0F));
        if (any_colors && part.colors.empty()) part.colors.assign(count, glm::vec4(1.0F));
    }
    for (const auto& instance : view.primitives)
        append(result.mesh, transformed(parts.at(instance.what), instance.world_from_object));
    for (const GltfMaterial& material : view.materials) {
        result.materials.push_back(translated(material, view));
    }
    return result;
}

}  // namespace relief
