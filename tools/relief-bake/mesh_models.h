// SPDX-License-Identifier: Apache-2.0
/// \file
/// The models of a bake: reading, pairs of parts by name, textures of the high models, and checks
/// whether the models fit. Tests: tests/tools/relief_bake_models_test.cpp,
/// relief_bake_layers_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/model_file.h"
#include "common/text.h"
#include "mesh_request.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {

// Models.

/// Pairs parts by pair_parts(). \throws FileError naming low parts without a counterpart
ModelPairs pair_models(std::span<const NamedModel> high, const NamedModel& low,
                       PartMatching matching);

/// The properties of high materials that are read besides normal maps.
struct HighProperties {
    bool colors = false;    ///< With opacity.
    bool surfaces = false;  ///< Roughness, metalness and occlusion.
    bool emission = false;
};

/// The textures of the high models, decoded.
class HighTextures {
  public:
    /// Adds the materials of a mesh with their textures. The mesh must keep its address.
    /// \param report  counts textures with other texture coordinates, which are left out
    /// \throws FileError if an image cannot be read
    void add(const std::filesystem::path& file, const Mesh& mesh, const MapAppearance& appearance,
             const HighTextureOptions& options, const HighProperties& properties, Report& report);

    [[nodiscard]] const std::vector<HighMaterials>& materials() const { return materials_; }

    /// The alpha mode for a material with the baked colors: mask if all transparent materials have
    /// the same cutoff. Absent: all are opaque.
    [[nodiscard]] const std::optional<BakedAlpha>& alpha() const { return alpha_; }

    /// "1 normal map added to their normals, 2 color textures, 1 emission texture"; empty if there
    /// are none.
    [[nodiscard]] std::string description() const;

  private:
    std::shared_ptr<const Image> image(const std::filesystem::path& model,
                                       const MapAppearance& appearance, std::size_t index,
                                       TextureSlot slot);
    std::shared_ptr<const Image> image(const std::filesystem::path& file, TextureSlot slot);
    /// Returns a texture that the material has.
    SurfaceTexture texture(const std::filesystem::path& model, const MapAppearance& appearance,
                           const GltfMaterial& material, TextureSlot slot);
    /// \throws FileError if it is no normal map in tangent space
    [[nodiscard]] SurfaceNormalMap normal_map(const SurfaceTexture& texture, float scale,
                                              const AssumedKinds& assumed) const;
    /// \throws FileError if the image states another kind than colors
    [[nodiscard]] SurfaceTexture color(const SurfaceTexture& texture,
                                       const AssumedKinds& assumed) const;
    /// Sets a texture of a material, if it has one at the texture coordinates of its meshes.
    void add_texture(const std::filesystem::path& model, const MapAppearance& appearance,
                     std::size_t material, TextureSlot slot, std::optional<SurfaceTexture>& target,
                     Report& report);
    void add_surface(const std::filesystem::path& model, const MapAppearance& appearance,
                     std::size_t index, HighMaterial& material, Report& report);
    void add_emission(const std::filesystem::path& model, const MapAppearance& appearance,
                      std::size_t index, HighMaterial& material, Report& report);
    void add_alpha(const BakedAlpha& alpha);

    std::vector<HighMaterials> materials_;
    std::map<std::string, std::shared_ptr<const Image>> images_;  ///< By file, index and kind.
    std::map<const Image*, std::map<std::string, std::string>> metadata_;
    std::map<const Image*, std::filesystem::path> names_;  ///< Files, or images of models.
    std::optional<BakedAlpha> alpha_;
    std::size_t normal_maps_ = 0;
    std::map<TextureSlot, std::size_t> textures_;  ///< The numbers of the others.
};

/// Returns the names of the triangles of a part for maps of ids: those of their materials, else of
/// their objects, else of their file.
/// \param materials  names, by index
std::vector<NamedTriangles> id_names(const MapModelPart& part,
                                     const std::vector<std::string>& materials,
                                     const std::filesystem::path& file);

/// The high meshes of a pair, which are adjacent in BakeModels::high.
struct BakePair {
    std::string name;
    std::size_t first_high = 0;
    std::size_t high_count = 0;
    std::size_t high_triangles = 0;
    std::vector<std::uint32_t> low;  ///< Triangles.
};

/// The models of a bake, with the same axes and origin.
struct BakeModels {
    std::vector<Mesh> high;  ///< One per file, or with pairs one per part.
    Mesh low;
    std::vector<std::string> materials;  ///< Of the low mesh.
    std::optional<glm::dmat3> world_from_low;
    glm::dvec3 origin{0.0};  ///< The world position of the origin.
    std::shared_ptr<const Mesh> cage;
    HighTextures textures;
    std::vector<HighIds> ids;     ///< Of the high meshes; only if ids are baked.
    std::vector<BakePair> pairs;  ///< Empty: every low part sees all high parts.
    std::vector<std::string> unpaired;
    /// The files that were read, and the textures of the high models. Textures of the low model are
    /// not among them: a new map may replace an old one.
    std::vector<std::filesystem::path> files;
};

/// \throws FileError if a model cannot be read, or the low one has no texture coordinates
BakeModels read_bake_models(const MeshBakeRequest& request, Findings& findings);

/// The transform of normals from the axes of the models to those of --space.
/// \throws FileError if the low model has no axes of its own, and --space object needs them
glm::dmat3 output_axes(const MeshBakeRequest& request,
                       const std::optional<glm::dmat3>& world_from_low);

// Checks whether the models fit.

/// Missed texels in percent of those that the low model covers; 0 if it covers none.
double missed_percent(std::size_t missed, std::size_t baked);

/// Makes the baker, which refers to the models.
/// \throws FileError if the models do not fit, with their boxes and the likely cause
Baker make_baker(const MeshBakeRequest& request, const BakeModels& models,
                 const BakeOptions& options, Report& report);

/// Describes the boxes of the models and the likely cause of a misfit.
std::string describe_fit(const MeshBakeRequest& request, const BakeModels& models);

/// \param fit     of the models, in coordinates relative to `origin`
/// \param map     its name if there are several maps, else empty
/// \throws FileError if no ray hits, or too many texels are missed
void check_missed(const MeshBakeRequest& request, const BakeFit& fit, const glm::dvec3& origin,
                  const std::string& map, const BakeResult& result);

/// The error if the low model covers no texel of any map.
FileError uncovered_error(const MeshBakeRequest& request, const Mesh& low);

/// Estimates on a reduced map, before the bake, whether too many texels are missed.
/// \throws FileError like check_missed(), if the estimate is 5 percent points above the limit
void check_missed_early(const MeshBakeRequest& request, const BakeModels& models,
                        const Baker& baker, const BakeMapOptions& map, const std::string& name);

/// Lists missed texels, their positions, and the ray lengths that would hit.
std::vector<std::string> missed_lines(const MeshBakeRequest& request, const BakeResult& result,
                                      const glm::dvec3& origin);

/// A warning if the low model has many more triangles than the high one; else empty.
std::string swapped_models_warning(const MeshBakeRequest& request, std::size_t high_triangles,
                                   std::size_t low_triangles);

}  // namespace relief::tools
