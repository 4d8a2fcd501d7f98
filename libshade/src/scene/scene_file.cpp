// SPDX-License-Identifier: Apache-2.0
// Scenes from model files, by extension: glTF with nodes, lights and cameras (gltf_scene.cpp),
// scene files (scene_reader.cpp), and the other formats as one mesh with MTL materials. World space
// is the file's. Invalid files throw FileError. Also decodes the images of scenes, which happens
// here only, and finds the six faces of a cube map in a folder.
#include "relief/shade/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "files.h"
#include "progress_stage.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/map_kind_check.h"
#include "relief/mesh/report.h"
#include "relief/mesh/texture_file.h"
#include "relief/shade/frame_settings.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

// Images

namespace {

struct Decoder {
    const std::string& name;
    ImageUse use;

    Image operator()(const std::filesystem::path& file) const {
        // Textures of two channels are x and y of normals.
        return use == ImageUse::data ? read_normal_map_image(file) : read_image(file, use);
    }
    Image operator()(const std::vector<std::byte>& bytes) const {
        return read_image(std::span(bytes), name, use);
    }
    Image operator()(const Image& image) const {
        Image copy = image;
        if (use == ImageUse::data) copy.color_space = ColorSpace::data;
        return copy;
    }
};

}  // namespace

Image decode(const ImageSource& source, ImageUse use) {
    if (!source.fault.empty()) throw FileError(source.origin, source.fault);
    return std::visit(Decoder{source.name, use}, source.source);
}

std::string with_origin(const ImageSource& source, const std::string& error) {
    const bool has_origin = source.origin.empty() || error.starts_with(source.origin);
    return has_origin ? error : source.origin + ": " + error;
}

void note_image_file(const ImageSource& source) {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) note_file(*file);
}

namespace {

/// Returns the header of an image; of a decoded one, its size. \throws FileError if it cannot be
/// read
ImageInfo info_of(const ImageSource& source) {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source))
        return read_image_info(*file);
    if (const auto* bytes = std::get_if<Shared<std::vector<std::byte>>>(&source.source))
        return read_image_info(std::span(**bytes), source.name);
    const Image& image = std::get<Shared<Image>>(source.source);
    ImageInfo info;
    info.width = image.width;
    info.height = image.height;
    return info;
}

std::map<std::string, std::string> metadata_of(const ImageSource& source) {
    return info_of(source).metadata;
}

}  // namespace

glm::ivec2 detail::image_size(const ImageSource& source) {
    if (!source.fault.empty()) throw FileError(source.origin, source.fault);
    const ImageInfo info = info_of(source);
    return {info.width, info.height};
}

FlatCode detected_flat_code(const ImageSource& source, const Image& image) {
    return detect_flat_code(image, metadata_of(source));
}

MapDescription detail::stated_description(const ImageSource& source) {
    if (!source.fault.empty()) return {};
    try {
        return read_description(metadata_of(source));
    } catch (const FileError&) {
        return {};
    }
}

namespace {

/// The descriptions of the images of a scene, each read once.
class StatedDescriptions {
  public:
    explicit StatedDescriptions(const Scene& scene) : scene_(scene) {}

    const MapDescription& of(std::size_t image) {
        const auto [entry, is_new] = known_.try_emplace(image);
        if (is_new) entry->second = stated_description(scene_.images[image]);
        return entry->second;
    }

  private:
    const Scene& scene_;
    std::map<std::size_t, MapDescription> known_;
};

}  // namespace

void detail::report_stated_kinds(const Scene& scene, const std::filesystem::path& origin,
                                 Report& report) {
    StatedDescriptions stated(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        for (const TextureSlotInfo& info : texture_slots) {
            const Texture* const texture = find_texture(scene.materials[i], info.slot);
            if (texture == nullptr || scene.images[texture->image].origin != origin.string())
                continue;
            const std::vector<MapKind> drawn = drawn_kinds(scene.materials[i], info.slot);
            if (drawn.empty()) continue;
            if (const auto wrong = stated_wrong_kind(drawn, stated.of(texture->image)))
                report_drawn_kind(*wrong, info.slot, drawn.front(), i, report);
        }
    }
}

void detail::apply_stated_green(Scene& scene, Report& report) {
    StatedDescriptions stated(scene);
    const auto apply = [&](std::optional<NormalMap>& map, std::size_t material) {
        if (!map || stated.of(map->texture.image).green != Green::down) return;
        map->green = Green::down;
        report.add("normal map that states green down", "material", material,
                   "is drawn as it states; other programs expect green up in this file");
    };
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        apply(scene.materials[i].normal_map, i);
        if (auto& model = scene.materials[i].metallic_roughness)
            apply(model->clearcoat_normal_map, i);
    }
}

// Files are visited in order of name, so that messages do not depend on the file system.
CubeFaces cube_faces_in(const std::filesystem::path& folder) {
    constexpr std::array<const char*, 6> ends = {"posx", "negx", "posy", "negy", "posz", "negz"};
    std::set<std::filesystem::path> files;
    std::error_code problem;
    for (const auto& entry : std::filesystem::directory_iterator(folder, problem))
        files.insert(entry.path());
    if (problem) throw FileError(folder, "cannot be read as a folder: " + problem.message());
    CubeFaces faces;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        std::optional<std::filesystem::path> found;
        for (const std::filesystem::path& file : files) {
            if (!file.stem().string().ends_with(ends[i])) continue;
            if (found) {
                throw FileError(folder, fmt::format("both {} and {} end in {} (name the six files "
                                                    "instead)",
                                                    found->filename().string(),
                                                    file.filename().string(), ends[i]));
            }
            found = file;
        }
        if (!found) {
            throw FileError(folder, fmt::format("no file whose name ends in {} (name the six files "
                                                "in the order +x -x +y -y +z -z)",
                                                ends[i]));
        }
        faces.faces[i] = {found->string(), *found};
    }
    return faces;
}

// Models

namespace {

/// The images of the scene by path; each file is one image.
class ImagesByPath {
  public:
    ImagesByPath(const std::filesystem::path& model, std::vector<ImageSource>& images)
        : model_(model.string()), images_(images) {}

    Texture texture(const MtlMaterial& material, const std::filesystem::path& file) {
        const auto [entry, is_new] = index_of_.try_emplace(file, images_.size());
        if (is_new) {
            images_.push_back({file.string(), file, model_});
            if (!material.may_read(file))
                images_.back().fault = file.string() + " lies outside of the model's folder";
        }
        return {entry->second};
    }

  private:
    std::string model_;
    std::vector<ImageSource>& images_;
    std::map<std::filesystem::path, std::size_t> index_of_;
};

/// Makes an invisible material opaque: some programs write opacity where MTL expects transparency
/// (Tr).
MtlMaterial visible_material(MtlMaterial material, std::size_t index, Report& report) {
    if (material.opacity <= 0.0F && !material.opacity_map) {
        material.opacity = 1.0F;
        report.add("invisible material (Tr 1 or d 0)", "material", index, "drawn opaque");
    }
    return material;
}

/// MeshLab writes Ns 0 and a white Ks for every material.
bool has_highlight(const MtlMaterial& material) {
    return material.illumination_model >= 2 && material.shininess > 0.0F;
}

Material material_from(const MtlMaterial& read, std::size_t index, ImagesByPath& images,
                       Report& report) {
    const MtlMaterial material = visible_material(read, index, report);
    Material phong = phong_from_mtl(material);
    if (material.diffuse_map)
        phong.diffuse_texture = images.texture(material, *material.diffuse_map);
    if (material.specular_map) {
        phong.specular_texture = images.texture(material, *material.specular_map);
        // map_Ks without Ks is not scaled.
        if (phong.specular == glm::vec3(0.0F) && has_highlight(material))
            phong.specular = glm::vec3(1.0F);
    }
    if (material.emission_map) {
        phong.emission_texture = images.texture(material, *material.emission_map);
        // map_Ke without Ke is not scaled.
        if (phong.emission == glm::vec3(0.0F)) phong.emission = glm::vec3(1.0F);
    }
    if (material.normal_map) {
        phong.normal_map = NormalMap{images.texture(material, *material.normal_map), 1.0F,
                                     Green::up, std::nullopt};
    }
    if (material.bump_map && material.normal_map) {
        report.add("bump map beside a normal map", "material", index, "left out");
    } else if (material.bump_map) {
        phong.bump_map = BumpMap{images.texture(material, *material.bump_map)};
        phong.bump_map->strength *= material.bump_strength;
    }
    // If map_d names the diffuse map, it means its alpha, which blending uses in any case.
    if (material.opacity_map && material.opacity_map != material.diffuse_map)
        phong.opacity_texture = images.texture(material, *material.opacity_map);
    for (const std::string& statement : material.more)
        report.add(statement + " in MTL", "material", index, "left out");
    return phong;
}

/// Gives every range without a material a double-sided one.
void name_missing_materials(Scene& scene) {
    Mesh& mesh = scene.meshes.front().edit();
    if (mesh.material_ranges.empty()) {
        mesh.material_ranges = {
            {0, static_cast<std::uint32_t>(mesh.triangles.size()), std::nullopt}};
    }
    const auto fallback = static_cast<std::uint32_t>(scene.materials.size());
    bool used = false;
    for (MaterialRange& range : mesh.material_ranges) {
        if (range.material) continue;
        range.material = fallback;
        used = true;
    }
    if (!used) return;
    Material material;
    material.name = "default";
    material.double_sided = true;
    scene.materials.push_back(std::move(material));
}

/// Rotates z to y, exactly.
constexpr glm::mat4 y_up_from_z_up{{1.0F, 0.0F, 0.0F, 0.0F},
                                   {0.0F, 0.0F, -1.0F, 0.0F},
                                   {0.0F, 1.0F, 0.0F, 0.0F},
                                   {0.0F, 0.0F, 0.0F, 1.0F}};

/// Attaches all that stands in the world to a node that turns z up.
void turn_z_up(SceneGraph& graph) {
    for (Instance& instance : graph.scene.instances)
        instance.world_from_object = y_up_from_z_up * instance.world_from_object;
    for (SceneNode& node : graph.nodes) {
        if (!node.parent) node.parent = graph.nodes.size();
    }
    if (graph.nodes.empty()) return;
    SceneNode& root = graph.nodes.emplace_back();
    root.name = "z up";
    root.matrix = y_up_from_z_up;
}

Scene scene_from(MeshFile contents, const std::filesystem::path& file, const SceneOptions& read,
                 Report& report) {
    Scene scene;
    ImagesByPath images(file, scene.images);
    for (std::size_t i = 0; i < contents.materials.size(); ++i) {
        scene.materials.push_back(material_from(contents.materials[i], i, images, report));
    }
    apply_stated_green(scene, report);
    scene.meshes.push_back(
        with_frames(std::move(contents.mesh), frame_options(file, read), report).mesh);
    scene.instances.push_back({0, glm::mat4(1.0F), scene.meshes.front()->name});
    name_missing_materials(scene);
    return scene;
}

}  // namespace

Material phong_from_mtl(const MtlMaterial& material) {
    Material phong;
    phong.name = material.name;
    phong.ambient = usable(material.ambient, max_reflectance);
    phong.diffuse = usable(material.diffuse, max_reflectance);
    phong.emission = usable(material.emission, max_reflectance);
    const glm::vec3 specular = usable(material.specular, max_reflectance);
    const int illumination = material.illumination_model;
    if (has_highlight(material)) phong.specular = specular;
    phong.specular_model = SpecularModel::blinn_phong;
    phong.shininess = usable(material.shininess, 1e6F);
    if (illumination >= 3 && illumination <= 9) {
        phong.reflectivity = glm::min(specular, glm::vec3(1.0F));
        const bool fresnel = illumination == 5 || illumination == 7;
        phong.grazing_reflectivity = fresnel ? glm::vec3(1.0F) : phong.reflectivity;
    }
    phong.refractive_index = std::max(usable(material.refractive_index, 1e3F), 1.0F);
    const float opacity = usable(material.opacity, 1.0F);
    if (illumination == 6 || illumination == 7) {
        phong.transmission = 1.0F - opacity;
    } else {
        phong.opacity = opacity;
    }
    if (phong.opacity < 1.0F || material.opacity_map) phong.alpha_mode = AlphaMode::blend;
    phong.unlit = illumination == 0;
    phong.double_sided = true;
    return phong;
}

bool is_z_up(const std::filesystem::path& model, const SceneOptions& options) {
    const bool is_stl = lower_extension(model) == ".stl";
    return options.up == UpAxis::z || (options.up == UpAxis::automatic && is_stl);
}

FrameOptions frame_options(const std::filesystem::path& model, const SceneOptions& options) {
    FrameOptions frames;
    frames.normals = options.normals;
    frames.crease_angle = options.crease_angle;
    if (!frames.crease_angle && lower_extension(model) == ".stl")
        frames.crease_angle = stl_crease_angle;
    return frames;
}

namespace {

/// Refuses scenes that no camera can show, because squares of their lengths are not finite.
void check_size(const Scene& scene) {
    constexpr float max_coordinate = 1e18F;
    std::vector<float> largest;  // The largest finite coordinate of each mesh.
    for (const Shared<Mesh>& mesh : scene.meshes) {
        largest.push_back(0.0F);
        for (const glm::vec3& position : mesh->positions) {
            const glm::vec3 size = glm::abs(position);
            const float coordinate = std::max({size.x, size.y, size.z});
            if (std::isfinite(coordinate)) largest.back() = std::max(largest.back(), coordinate);
        }
    }
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const glm::mat4& matrix = scene.instances[i].world_from_object;
        const glm::vec3 reach =
            largest[scene.instances[i].mesh] *
                (glm::abs(glm::vec3(matrix[0])) + glm::abs(glm::vec3(matrix[1])) +
                 glm::abs(glm::vec3(matrix[2]))) +
            glm::abs(glm::vec3(matrix[3]));
        const float coordinate = std::max({reach.x, reach.y, reach.z});
        if (coordinate <= max_coordinate) continue;
        throw InvalidInput(fmt::format(
            "{}: reaches up to {:.2g} in the world, but pictures show coordinates up to {:g} "
            "(scale it)",
            instance_label(scene, i), coordinate, max_coordinate));
    }
}

}  // namespace

SceneGraph load_scene_graph(const std::filesystem::path& file, const SceneOptions& options,
                            Report& report) {
    const std::string extension = lower_extension(file);
    SceneGraph graph;
    try {
        if (extension == ".json") {
            graph = read_scene_json(file, options, report);
        } else if (extension == ".gltf" || extension == ".glb") {
            graph = graph_from(GltfDocument::read(file, report), file, options, report);
        } else {
            graph.scene = scene_from(read_mesh(file, report), file, options, report);
        }
        report_stated_kinds(graph.scene, file, report);
        if (extension != ".json" && is_z_up(file, options)) turn_z_up(graph);
        if (clips_exclude_each_other(graph)) graph.clip = 0;
        pose(graph, 0.0);
        validate(graph);
        check_size(graph.scene);
    } catch (const InvalidInput& error) {
        throw FileError(file, error.what());
    }
    return graph;
}

Scene load_scene(const std::filesystem::path& file, const SceneOptions& options, Report& report) {
    return load_scene_graph(file, options, report).scene;
}

Scene load_scene(const std::filesystem::path& file, Report& report) {
    return load_scene(file, SceneOptions{}, report);
}

}  // namespace relief::shade
