// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads scenes from model files and scene files, saves edited scenes, and decodes their images.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"

namespace RELIEF_API relief {
namespace shade {

/// The axis of a model that points up in the world.
enum class UpAxis {
    y,
    z,
    automatic,  ///< z for STL, as programs for parts and printing write it; y for others.
};

}  // namespace shade

template <>
inline constexpr auto enum_names<shade::UpAxis> = std::to_array<EnumName<shade::UpAxis>>(
    {{"y", shade::UpAxis::y}, {"z", shade::UpAxis::z}, {"auto", shade::UpAxis::automatic}});

namespace shade {

/// Edges of an STL file that are sharper are hard, in radians: 30 degrees. The format has one
/// normal for each triangle, and is used for parts with sharp edges.
inline constexpr double stl_crease_angle = 0.523598775598299;

/// Options of load_scene_graph.
struct SceneOptions {
    /// The model of glTF's materials.
    enum class MaterialModel {
        as_authored,  ///< Metallic-roughness.
        phong,  ///< Phong's model, by phong_from_metallic_roughness() with the means of textures.
    };
    MaterialModel model = MaterialModel::as_authored;
    /// Replaces the normals of models, unless it is keep.
    NormalMode normals = NormalMode::keep;
    /// In radians, 0 to pi: sharper edges are hard in normals that are computed. If absent, STL
    /// has stl_crease_angle, and others have the smoothing groups of their file.
    std::optional<double> crease_angle = std::nullopt;
    /// The axis of a model file that points up. Models within scene files stand as the scene file
    /// says.
    UpAxis up = UpAxis::automatic;
    /// The variant of a glTF file's materials (KHR_materials_variants), by its name or its number
    /// from 1. If absent, primitives have their own materials.
    std::optional<std::string> material_variant = std::nullopt;
};

/// Returns whether the z axis of a model file points up.
bool is_z_up(const std::filesystem::path& model, const SceneOptions& options);

/// Returns the options for the normals of a model file. A format that demands other normals where
/// there are none sets FrameOptions::if_missing.
FrameOptions frame_options(const std::filesystem::path& model, const SceneOptions& options);

/// Reads .gltf, .glb, .obj, .ply, .stl, .off or a scene file (.json, docs/scene-files.md) as a
/// scene graph, posed at time 0.
///
/// Meshes without normals get flat normals in glTF (as it requires) and angle-weighted normals in
/// other formats, with hard edges in STL. The effect plan computes tangents. Lights and
/// cameras come from glTF, of which the first one shows the scene; none are added. Formats that do
/// not define sides (all but glTF) are double-sided. glTF's light units (lux, candela) become
/// irradiance over pi, so that the picture is the one that KHR_lights_punctual describes.
///
/// If animations move the same property of a node, the first one plays (SceneGraph::clip).
///
/// A glTF mesh has the texture coordinates of its material's first texture, with that texture's
/// KHR_texture_transform applied. MTL's bump multiplier -bm, which has no unit, multiplies
/// BumpMap's default strength: -bm 1 is 16 texels. Beside metallic_roughness a material has its
/// Phong equivalent by the factors alone, which is used if metallic_roughness is removed.
///
/// \param report  counts everything that is not drawn as intended: textures with further texture
///                coordinate sets (left out) or another transform than their material's first;
///                extensions of glTF materials that are not drawn, and those that the file
///                requires; statements of MTL without an equivalent (map_Ka, map_Ns, disp, refl,
///                scaled or shifted maps); maps whose files state another kind; animations that
///                cannot be played; and, for MaterialModel::phong, unreadable textures (mean 1)
/// \throws FileError as the readers do, and for an instance that reaches beyond 1e18 in the world,
///         which no camera can show. A missing image file is reported when it is decoded, and only
///         visible images are decoded
SceneGraph load_scene_graph(const std::filesystem::path& file, const SceneOptions& options,
                            Report& report = IgnoredReport());

/// Reads only the scene of that graph.
Scene load_scene(const std::filesystem::path& file, const SceneOptions& options,
                 Report& report = IgnoredReport());

/// Reads only the scene, with the default options.
Scene load_scene(const std::filesystem::path& file, Report& report = IgnoredReport());

/// Returns meshes of a document, each in its object space as a scene without lights. All scenes
/// have the document's materials and images.
///
/// \param meshes  their indices; a scene has an instance for each triangle primitive of its mesh
/// \param file    the document's file, for messages
/// \param report  as load_scene_graph()
/// \throws InvalidInput if a primitive cannot be read
std::vector<Scene> mesh_scenes(const GltfDocument& document, std::span<const std::size_t> meshes,
                               const std::filesystem::path& file, Report& report = IgnoredReport());

/// The means of textures that Phong's model has no place for, colors linear; 1 without a texture.
struct TextureMeans {
    glm::vec3 base_color{1.0F};
    float metallic = 1.0F;
    float roughness = 1.0F;
};

/// Converts a material with glTF's model to Phong's model, without textures. With the base color b,
/// metallic m, roughness r and alpha = r^2 as glTF defines them (r at least 0.045, so that alpha^2
/// is accurate in float):
///
///     F0           = mix(0.04, b, m)
///     shininess s  = 2 / alpha^2 - 2
///     specular     = F0 (s + 2) / 8
///     mirror       = t^2 / (t^2 + alpha^2), t = tan 3 degrees
///     reflectivity = F0 * mirror          grazing_reflectivity = mirror
///     diffuse      = b (1 - m)            ambient = diffuse + F0
///
/// - Exponent and factor give the highlight GGX's own peak. Blinn-Phong's facet distribution
///   D = (s + 2) / (2 pi) (n.h)^s is GGX's 1 / (pi alpha^2) at n.h = 1; a microfacet surface shows
///   F D G / (4 n.v) of a light's irradiance, and Phong's term, which has no n.v, stands for G =
///   n.v: F0 (s + 2) / (8 pi) (n.h)^s. The pi is in the light (lights.h). [Blinn 1977],
///   [Walter et al. 2007] (GGX), [Karis 2013] (s from alpha), [Hoffman 2013] (normalization).
/// - `mirror` is the share of GGX's facets within 3 degrees of the normal (the integral of
///   D (n.h) over that cone). Only these facets reflect a sharp environment; the others blur it,
///   which Phong's model does not show. So a rough metal is not a mirror.
/// - In ambient light, which is the same from all directions, a surface shows the sum of scattered
///   and reflected light.
///
/// F0 includes the mean of the base color's texture; diffuse and ambient do not, since the texture
/// itself multiplies them.
Material phong_from_metallic_roughness(const Material& material, const TextureMeans& means);

/// Converts MTL to Phong's model, without textures: illum 0 is unlit; 1 and Ns 0, which would cover
/// the lit side, have no highlight; 3 to 9 reflect by Ks, 5 and 7 with Fresnel's effect. If d is
/// below 1, illum 6 and 7 refract (transmission 1 - d, by Ni); every other model, and map_d, blend,
/// as OBJ viewers do. Ns above 1e6 counts as 1e6, Ni is clamped to [1, 1000]; colors below 0 count
/// as 0. Source: the MTL format's illumination models (Blinn's half vector for all highlights).
Material phong_from_mtl(const MtlMaterial& material);

/// A scene that was read from a file, with a camera and a picture size.
struct SceneToSave {
    std::filesystem::path source;  ///< The model or scene file.
    const Scene& scene;            ///< The edited scene: lights, environment, materials.
    Camera camera;
    glm::ivec2 size{1024, 1024};
    SceneOptions options{};  ///< Those with which the source was read.
};

/// Writes a scene file that names the model, or repeats the scene file, with the differences:
/// fields of materials, all lights if any changed, the environment and the camera.
///
/// Changed lights do not move any more. Images in memory (a converted height map) are written
/// beside the file as PNG: NAME-image-1.png, and so on.
/// \throws FileError if the source cannot be read again, or a file cannot be written or exists
///         already; InvalidInput if a scene file cannot express the change: meshes were moved or
///         added, a scene file is written to another folder, an environment is no file, or the
///         path of a file is not UTF-8
void save_scene(const std::filesystem::path& file, const SceneToSave& saved);

/// Finds six images in a folder by the ends of their names: posx, negx, posy, negy, posz, negz.
/// \throws FileError naming the first missing face, or two files for one face
CubeFaces cube_faces_in(const std::filesystem::path& folder);

/// Decodes an image.
/// \return the image; a decoded image keeps its samples, and for ImageUse::data its color space is
///         ignored
/// \throws FileError as read_image() does, and with the fault of the source if it has one
Image decode(const ImageSource& source, ImageUse use);

/// Returns the message of an error in decoding an image, after the file that names the image,
/// unless the message begins with that file: "vase.gltf: bricks.png: no such file".
std::string with_origin(const ImageSource& source, const std::string& error);

/// Records that a picture depends on a file (relief/mesh/execution.h), even if the file is not
/// decoded again.
void note_image_file(const ImageSource& source);

/// Returns the code of zero in a normal map: that of the file's metadata, otherwise 127.5, see
/// detect_flat_code(). \param image  decoded from the source
FlatCode detected_flat_code(const ImageSource& source, const Image& image);

}  // namespace shade
}  // namespace relief
