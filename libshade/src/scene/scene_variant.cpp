// SPDX-License-Identifier: Apache-2.0
// Prepares variants of scenes: converts maps between heights and normals, and recomputes frames.
// Tests: tests/tools/variant_test.cpp.
#include "relief/shade/scene_variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <span>

#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/shade/scene_file.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

/// The format of converted height maps.
constexpr NormalMapFormat converted_format{
    .bits = 16, .green = Green::up, .flat = FlatCode::middle};

/// The heights of a material: its bump map, or the source of its converted normal map.
struct Heights {
    ImageSource image;
    BumpMap map;
};

/// Prepares one variant.
class Preparation {
  public:
    Preparation(const SceneVariant& variant, const Scene& scene, const SceneHeights& heights,
                Report& report)
        : variant_(variant), scene_(scene), height_map_(heights), report_(report) {}

    PreparedVariant run() {
        std::visit([this](const auto& choice) { change(choice); }, variant_);
        return std::move(result_);
    }

  private:
    using Lack = UnchangedScene::Lack;

    [[noreturn]] static void refuse_current() {
        throw UnchangedScene(Lack::nothing, "is the current setting");
    }

    void change(Interpolation interpolation) {
        const bool is_so = std::all_of(
            scene_.materials.begin(), scene_.materials.end(),
            [&](const Material& material) { return material.interpolation == interpolation; });
        if (is_so) refuse_current();
        result_.interpolation = interpolation;
    }

    void change(MapUse use) {
        begin_maps();
        bool changed = false;
        for (std::size_t i = 0; i < result_.maps.size(); ++i) {
            MaterialMaps& maps = result_.maps[i];
            const std::optional<Heights> heights = heights_of(scene_.materials[i]);
            if (use == MapUse::none) {
                changed |= maps.normal_map || maps.bump_map;
                maps = {};
            } else if (use == MapUse::bump_map && heights && maps.normal_map) {
                maps = {std::nullopt, as_bump_map(*heights)};
                changed = true;
            } else if (use == MapUse::normal_map && maps.bump_map) {
                convert(maps, *heights, std::nullopt, MapBits::sixteen);
                changed = true;
            }
        }
        if (changed) return;
        throw UnchangedScene(Lack::heights,
                             use == MapUse::none ? "there is no normal map or bump map to remove"
                             : use == MapUse::bump_map
                                 ? "there is no normal map that was converted from heights"
                                 : "there is no bump map to convert");
    }

    void change(Kernel kernel) {
        const bool is_converted = height_map_.file && !height_map_.is_bump_map;
        if (is_converted && kernel == displayed_kernel(height_map_)) refuse_current();
        begin_maps();
        bool changed = false;
        for (std::size_t i = 0; i < result_.maps.size(); ++i) {
            const std::optional<Heights> heights = heights_of(scene_.materials[i]);
            if (!heights) continue;
            changed |= unless_unreadable(heights->image, [&] {
                convert(result_.maps[i], *heights, kernel, MapBits::sixteen);
                return true;
            });
        }
        if (!changed) throw UnchangedScene(Lack::heights, "there is no height map");
    }

    void change(MapBits bits) {
        begin_maps();
        bool changed = false;
        for (std::size_t i = 0; i < result_.maps.size(); ++i) {
            MaterialMaps& maps = result_.maps[i];
            if (!maps.normal_map) continue;
            const ImageSource& source = scene_.images[maps.normal_map->texture.image];
            changed |= unless_unreadable(source, [&] {
                const Image image = decode(source, ImageUse::data);
                if (image.bits() <= static_cast<int>(bits)) return false;
                if (const std::optional<Heights> heights = heights_of(scene_.materials[i])) {
                    convert(maps, *heights, height_map_.kernel, bits);
                } else {
                    requantize(*maps.normal_map, source, image, bits);
                }
                return true;
            });
        }
        if (!changed) throw UnchangedScene(Lack::heights, "there is no normal map with more bits");
    }

    void change(TangentMethod method) {
        const bool has_frames = std::any_of(
            scene_.materials.begin(), scene_.materials.end(), [](const Material& material) {
                const std::optional<NormalMap>& map = material.normal_map;
                const auto& model = material.metallic_roughness;
                return material.bump_map || (map && map->space == NormalSpace::tangent) ||
                       (model && (model->anisotropy > 0.0F || model->clearcoat_normal_map));
            });
        if (!has_frames) {
            throw UnchangedScene(Lack::maps,
                                 "there is no normal map, bump map or anisotropy that needs "
                                 "tangents");
        }
        const bool is_derived = method == TangentMethod::none;
        result_.tangent_frame = is_derived ? TangentFrame::derivatives : TangentFrame::stored;
        if (!computes_tangents(method)) return;
        FrameOptions frames;
        frames.tangents = method;
        change_meshes(frames);
    }

    void change(NormalMode mode) {
        FrameOptions frames;
        frames.normals = mode;
        result_.has_flat_normals = mode == NormalMode::flat;
        change_meshes(frames);
    }

    void change_meshes(const FrameOptions& frames) {
        for (const Shared<Mesh>& mesh : scene_.meshes) {
            std::optional<Shared<GltfDeformation>> deformation =
                deformation_of(result_.meshes.size());
            if (computes_tangents(frames.tangents) && mesh->texcoords.empty()) {
                result_.meshes.push_back(mesh);
            } else {
                const bool separates = deformation && result_.has_flat_normals == true;
                FramedMesh framed = separates ? with_separate_frames(*mesh, frames, report_)
                                              : with_frames(*mesh, frames, report_);
                if (deformation) deformation = of_vertices(*deformation, framed.source_vertex);
                result_.source_vertices.resize(result_.meshes.size());
                result_.source_vertices.push_back(framed.source_vertex);
                result_.meshes.emplace_back(std::move(framed.mesh));
            }
            result_.deformations.push_back(std::move(deformation));
        }
    }

    /// Returns what deforms a mesh, or none. The instances of a mesh share it.
    [[nodiscard]] std::optional<Shared<GltfDeformation>> deformation_of(std::size_t mesh) const {
        for (const Instance& instance : scene_.instances) {
            if (instance.mesh == mesh && instance.pose) return instance.pose->deformation;
        }
        return std::nullopt;
    }

    /// Runs the work for a material. If an optional image cannot be read, the picture is drawn
    /// without it, and so is the variant. \return the result of the work, or false
    static bool unless_unreadable(const ImageSource& image, const std::function<bool()>& work) {
        try {
            return work();
        } catch (const FileError&) {
            if (image.is_required) throw;
            return false;
        }
    }

    void begin_maps() {
        for (const Material& material : scene_.materials)
            result_.maps.push_back({material.normal_map, material.bump_map});
        result_.first_image = scene_.images.size();
    }

    [[nodiscard]] std::optional<Heights> heights_of(const Material& material) const {
        if (material.bump_map)
            return Heights{scene_.images[material.bump_map->texture.image], *material.bump_map};
        if (!material.normal_map || !height_map_.file) return std::nullopt;
        BumpMap map;
        map.texture = material.normal_map->texture;
        map.strength = static_cast<float>(height_map_.strength.value_or(BumpOptions{}.strength));
        return Heights{
            {.name = height_map_.file->string(), .source = *height_map_.file, .is_required = true},
            map};
    }

    BumpMap as_bump_map(const Heights& heights) {
        BumpMap map = heights.map;
        map.texture.image = added(heights.image.name, [&] { return heights.image; });
        return map;
    }

    /// \param kernel  if absent, the kernel is chosen for the map
    void convert(MaterialMaps& maps, const Heights& heights, std::optional<Kernel> kernel,
                 MapBits bits) {
        BumpOptions bump;
        bump.kernel = kernel;
        bump.strength = heights.map.strength;
        const std::string name = fmt::format("{}, {}", heights.image.name, bump.strength);
        NormalMap map = converted_map(heights.map.texture);
        map.scale = maps.normal_map ? maps.normal_map->scale : 1.0F;
        map.texture.image = added(name, [&] {
            try {
                const Image image = decode(heights.image, ImageUse::data);
                return ImageSource{name,
                                   converted_heights(image, bump, static_cast<int>(bits), report_)};
            } catch (const InvalidInput& error) {
                throw FileError(heights.image.name, error.what());
            }
        });
        maps = {map, std::nullopt};
    }

    /// Encodes a normal map with fewer bits.
    void requantize(NormalMap& map, const ImageSource& source, const Image& image, MapBits bits) {
        const FlatCode flat = map.flat.value_or(detected_flat_code(source, image));
        const std::string name =
            fmt::format("{}, {}", map.texture.image, static_cast<int>(map.green));
        map.texture.image = added(name, [&] {
            const NormalMapFormat format{
                .bits = static_cast<int>(bits), .green = map.green, .flat = flat};
            const Image normals = decode_normal_map(image, map.green, flat, report_);
            return ImageSource{source.name, encode_normal_map(normals, format, report_)};
        });
        map.flat = flat;
    }

    /// Adds an image that several materials may share.
    template <typename Make>
    std::size_t added(const std::string& name, const Make& make) {
        const auto [entry, is_new] =
            index_of_.try_emplace(name, result_.first_image + result_.images.size());
        if (is_new) result_.images.push_back(make());
        return entry->second;
    }

    const SceneVariant& variant_;
    const Scene& scene_;
    const SceneHeights& height_map_;
    Report& report_;
    PreparedVariant result_;
    std::map<std::string, std::size_t> index_of_;
};

/// Sets the maps of the variant and keeps the current scale.
void set_maps(Material& material, const MaterialMaps& maps, std::size_t first, std::size_t moved) {
    const std::optional<NormalMap> before = material.normal_map;
    const auto place = [&](Texture& texture) {
        if (texture.image >= first) texture.image += moved;
    };
    material.normal_map = maps.normal_map;
    material.bump_map = maps.bump_map;
    if (material.normal_map) place(material.normal_map->texture);
    if (material.bump_map) place(material.bump_map->texture);
    if (before && material.normal_map) material.normal_map->scale = before->scale;
}

}  // namespace

Image converted_heights(const Image& image, const BumpOptions& bump, int bits, Report& report) {
    NormalMapFormat format = converted_format;
    format.bits = bits;
    return encode_normal_map(normals_from_height(height_field(image), bump, report), format,
                             report);
}

NormalMap converted_map(const Texture& texture) {
    return {.texture = texture, .green = converted_format.green, .flat = converted_format.flat};
}

std::optional<Kernel> displayed_kernel(const SceneHeights& heights) {
    if (heights.kernel || !heights.file) return heights.kernel;
    BumpOptions bump;
    bump.strength = heights.strength.value_or(bump.strength);
    bump = resolve_options(height_field(read_image(*heights.file, ImageUse::data)), bump);
    if (bump.kernel == Kernel::gaussian && bump.gaussian_radius != BumpOptions{}.gaussian_radius)
        return std::nullopt;
    return bump.kernel;
}

PreparedVariant prepare_variant(const SceneVariant& variant, const Scene& scene,
                                const SceneHeights& heights, Report& report) {
    Scene named = scene;
    name_default_material(named);
    return Preparation(variant, named, heights, report).run();
}

Scene with_variant(const Scene& scene, const PreparedVariant& prepared) {
    Scene changed = scene;
    name_default_material(changed);
    for (Material& material : changed.materials) {
        material.interpolation = prepared.interpolation.value_or(material.interpolation);
        material.tangent_frame = prepared.tangent_frame.value_or(material.tangent_frame);
        if (prepared.interpolation == Interpolation::gouraud) material.metallic_roughness.reset();
    }
    if (!prepared.meshes.empty()) {
        changed.meshes = prepared.meshes;
        for (Instance& instance : changed.instances) {
            if (instance.mesh < prepared.source_vertices.size())
                instance.open_shares =
                    of_vertices(instance.open_shares, prepared.source_vertices[instance.mesh]);
            const auto& deformation = prepared.deformations.at(instance.mesh);
            if (!instance.pose || !deformation) continue;
            instance.pose->deformation = *deformation;
            instance.pose->has_flat_normals =
                prepared.has_flat_normals.value_or(instance.pose->has_flat_normals);
        }
    }
    if (prepared.maps.empty()) return changed;
    const std::size_t moved = changed.images.size() - prepared.first_image;
    changed.images.insert(changed.images.end(), prepared.images.begin(), prepared.images.end());
    for (std::size_t i = 0; i < changed.materials.size() && i < prepared.maps.size(); ++i)
        set_maps(changed.materials[i], prepared.maps[i], prepared.first_image, moved);
    return changed;
}

Scene with_lighting_of(const Scene& scene, Scene other) {
    other.ambient = scene.ambient;
    other.clamp_terms = scene.clamp_terms;
    other.directional_lights = scene.directional_lights;
    other.point_lights = scene.point_lights;
    other.spot_lights = scene.spot_lights;
    other.environment = scene.environment;
    other.background = scene.background;
    other.exposure = scene.exposure;
    other.tone_mapping = scene.tone_mapping;
    other.shadow = scene.shadow;
    return other;
}

}  // namespace relief::shade
