// SPDX-License-Identifier: Apache-2.0
/// \file
/// Editing lights and materials: their lists, conversions between kinds and models, and the panels.
/// World space, angles in radians. Tests: tests/tools/window/light_panel_test.cpp,
/// material_panel_test.cpp.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/map_kind.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/gltf_document.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"
#include "window/orbit_camera.h"
#include "window/playback.h"

namespace relief::tools {

// Lights.

/// The alternatives are in the order of LightType.
using AnyLight = std::variant<shade::DirectionalLight, shade::PointLight, shade::SpotLight>;

LightType type_of(const AnyLight& light);

/// All lights: directional lights first, then point lights, then spotlights.
std::vector<AnyLight> lights_of(const shade::Scene& scene);

/// Replaces all lights of the scene. The order within a kind stays.
void set_lights(shade::Scene& scene, const std::vector<AnyLight>& lights);

/// A new light at the upper right, for a model of this size.
AnyLight new_light(LightType type, const BoundingSphere& sphere);

/// Converts a light to another kind with the same irradiance at the center of the sphere. A
/// directional light that becomes a point light or spotlight is placed outside the sphere, in the
/// direction of the light. The conversion to a directional light loses the range and falloff.
AnyLight converted_to(const AnyLight& light, LightType type, const BoundingSphere& sphere);

/// Rotates the position and direction of a light about a center.
void turn(AnyLight& light, const glm::mat3& rotation, const glm::vec3& center);

/// A light with the data that only the window stores.
struct LightRow {
    AnyLight light;
    unsigned id = 0;  ///< Constant for the lifetime of the light; 0: not yet assigned.
    /// Radians per second: about the vertical axis through the center of the model, or of the orbit
    /// of its node.
    float speed = 0.0F;
    /// The node that carries it. Without one, animations do not move the light.
    shade::Carried carried = {};
};

/// Identifies lights across edits, and rotates them.
class LightRows {
  public:
    /// Updates the list for another scene, or for changed lights. Lights of the same kind keep
    /// their id and speed in order. Lights that were detached from their node stay so.
    /// \param carriers  the nodes of the lights; the lists may be shorter
    void update(const shade::Scene& scene, const LightCarriers& carriers = {});

    /// The nodes of the lights.
    [[nodiscard]] LightCarriers carriers() const;

    /// Detaches all lights from their nodes.
    void detach_all();

    /// The rows for the scene of the last update().
    [[nodiscard]] std::vector<LightRow> rows(const shade::Scene& scene) const;

    /// Replaces the lights of the scene, sorted by kind. New lights get an id.
    void set(shade::Scene& scene, std::vector<LightRow> rows);

    /// Returns whether any light rotates.
    [[nodiscard]] bool is_moving() const;

    /// Rotates the lights by the elapsed time.
    void advance(shade::Scene& scene, double seconds, const glm::vec3& center) const;

  private:
    struct Entry {
        LightType type;
        unsigned id;
        float speed;
        shade::Carried carried;
        bool is_detached = false;  ///< It had a node.
    };

    std::vector<Entry> entries_;  ///< In the order of the scene's lights.
    unsigned last_id_ = 0;
};

// Materials.

enum class ShadingModel { phong, metallic_roughness, unlit };

}  // namespace relief::tools

namespace relief {

template <>
inline constexpr auto enum_names<tools::ShadingModel> =
    std::to_array<EnumName<tools::ShadingModel>>(
        {{"phong", tools::ShadingModel::phong},
         {"metallic_roughness", tools::ShadingModel::metallic_roughness, "Metallic-roughness"},
         {"unlit", tools::ShadingModel::unlit}});

}  // namespace relief

namespace relief::tools {

ShadingModel model_of(const Material& material);

/// Changes the model and keeps the appearance similar. Phong to metallic-roughness: the base color
/// is the diffuse color, metallic is 0, and the roughness is the inverse of
/// phong_from_metallic_roughness (scene_file.h). Metallic-roughness to Phong: the material keeps
/// its Phong values, which the file reader or an earlier change has set.
void set_model(Material& material, ShadingModel model);

// The images of a material, such as its normal map. Images are decoded when a picture needs them.

/// For example "Normal map".
std::string map_title(TextureSlot slot);

/// Returns whether the material's model uses this map.
bool is_map_used(const Material& material, TextureSlot slot);

/// The extension of a path in a material of glTF ("extensions/KHR_materials_ior/ior"), or empty.
std::string_view gltf_extension_of(std::string_view gltf);

/// The subject of a group of rows of a material.
enum class MaterialTopic {
    base,  ///< Without a header.
    highlights,
    reflection,
    relief,
    occlusion,
    emission,
    transparency,
    extension,  ///< One extension of glTF.
};

/// Rows of a material that belong together.
struct MaterialGroup {
    MaterialTopic topic = MaterialTopic::base;
    std::string title;           ///< For example "Clearcoat".
    std::string_view extension;  ///< For example "KHR_materials_clearcoat".
    bool has_effect = true;      ///< Otherwise its values change nothing, and it starts folded.
    std::vector<TextureSlot> slots;
};

/// The groups of a material in the order of the panel. Those of extensions follow from the tables
/// of fields and textures.
std::vector<MaterialGroup> material_groups(const Material& material);

/// The name of the image, if there is one.
std::optional<std::string> map_name(const shade::Scene& scene, std::size_t material,
                                    TextureSlot slot);

/// Sets a map to a file. The wrap modes stay; the default is repeat. A material has either a normal
/// map or a bump map, so setting one removes the other. The scale and strength of a map stay.
/// \throws RefusedMap if the file is of another kind and that is not assumed; FileError if it is
/// not
///         an image
void set_map(shade::Scene& scene, std::size_t material, TextureSlot slot,
             const std::filesystem::path& file, const AssumedKinds& assumed = {});

}  // namespace relief::tools
