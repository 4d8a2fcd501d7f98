// SPDX-License-Identifier: Apache-2.0
/// \file
/// Declares parts of scene graphs (scene_graph.h) that files, validation, poses and framing share,
/// and parts of load_scene_graph (scene_file.h), one function for each kind of file. World space,
/// radians, seconds.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "portable_math.h"
#include "relief/export.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"
#include "relief/shade/scene_graph.h"

namespace RELIEF_API relief {
namespace shade::detail {

// Numbers

using relief::detail::is_finite;

inline bool is_finite(const glm::mat4& matrix) {
    for (int column = 0; column < 4; ++column) {
        if (!is_finite(glm::vec3(matrix[column])) || !std::isfinite(matrix[column].w)) return false;
    }
    return true;
}

/// Checks that a vertical field of view is within its range, without the limits.
/// \param owner  begins the message: "camera: "
void check_field_of_view(const std::string& owner, float vertical_fov);

/// Returns the width and the height of an image, from its header. \throws FileError if it cannot be
/// read
glm::ivec2 image_size(const ImageSource& source);

/// Returns what the metadata of an image state. Nothing if it cannot be read, which the decoder
/// reports.
MapDescription stated_description(const ImageSource& source);

/// Reports the maps whose files state another kind than the one as which they are drawn.
/// \param origin  the file that names the images; the others are left out
void report_stated_kinds(const Scene& scene, const std::filesystem::path& origin, Report& report);

/// Sets the green direction of a model's normal maps whose files state that it is down; glTF and
/// MTL mean up. \param report  counts these materials
void apply_stated_green(Scene& scene, Report& report);

/// Returns half of the height of the picture: in world units if the camera is orthographic, else on
/// the plane at distance 1.
inline double half_height(const Camera& camera) {
    return camera.orthographic_height
               ? 0.5 * static_cast<double>(*camera.orthographic_height)
               : relief::detail::portable::tan(static_cast<double>(camera.vertical_fov) * 0.5);
}

/// Returns the position of a perspective camera as (x,y,z,1), and the direction to an orthographic
/// camera as (x,y,z,0), in world space.
inline glm::vec4 homogeneous_eye(const Camera& camera) {
    return camera.orthographic_height ? glm::vec4(glm::vec3(camera.world_from_view[2]), 0.0F)
                                      : glm::vec4(glm::vec3(camera.world_from_view[3]), 1.0F);
}

/// The smallest ratio of the near to the far plane. A smaller one would cost depth precision.
inline constexpr float min_near_share = 1e-4F;

// Scene graphs

/// Returns the axes of a viewer who looks at a point from a direction on the sphere. Defined at the
/// poles too.
///
/// \param azimuth    from +z towards +x
/// \param elevation  above the xz plane
/// \return right, up, and back: the unit vector towards the eye
glm::mat3 orbit_axes(double azimuth, double elevation);

/// Returns the value of a channel at a time.
/// \return rotations as unit quaternions x, y, z, w
/// \throws InvalidInput as pose() does for keys
glm::vec4 value_at(const KeyChannel& channel, double seconds);

/// Checks that keys are as KeyChannel requires. \throws InvalidInput naming the first offence
void check_keys(const KeyChannel& channel);

/// Checks that a channel of Property::pointer names a number or color of the graph.
/// \throws InvalidInput if it does not
void check_pointer(const SceneGraph& graph, const KeyChannel& channel);

/// Returns whether all keys of such a channel are within the range of its field.
bool is_in_range(const SceneGraph& graph, const KeyChannel& channel);

/// Adds a model to a graph as a part that hangs on a node: the world of the part becomes the space
/// of the node, and its animations play along. Its ambient light is added; its camera, environment
/// and settings are not.
void append(SceneGraph& graph, SceneGraph part, std::size_t node);

/// The morph weights of a node at one time.
struct NodeWeights {
    std::size_t node = 0;
    std::vector<float> weights;
};

/// Returns the weights of a channel at a time. \throws InvalidInput as pose() does for keys
std::vector<float> weights_at(const KeyChannel& channel, double seconds);

/// Sets the poses of the instances that joints and morph targets of a graph deform.
/// \param weights  those that animations change
void set_poses(SceneGraph& graph, std::span<const glm::mat4> world_from_node,
               std::span<const NodeWeights> weights);

/// Returns true if the pose deforms the mesh, so that it is not drawn as it is at rest.
inline bool is_deformed(const Instance& instance) {
    return instance.pose && (is_morphed(*instance.pose) || is_skinned(*instance.pose));
}

/// Returns the values for vertices that were made of those of the given ones.
/// \param source_vertex  for each new vertex, the old one; empty: the same
inline std::vector<float> of_vertices(const std::vector<float>& values,
                                      std::span<const std::uint32_t> source_vertex) {
    if (source_vertex.empty() || values.empty()) return values;
    std::vector<float> result;
    for (const std::uint32_t vertex : source_vertex)
        result.push_back(values[vertex]);
    return result;
}

/// Extends the bounds in world space by an instance as its pose deforms it.
void add_instance(const Scene& scene, std::size_t instance, Bounds& world);

/// Deforms a mesh at rest as deformed_mesh() does.
/// \param source_vertex  the vertex of the deformation for each vertex of the mesh; empty: the same
void deform(const MeshPose& pose, std::span<const std::uint32_t> source_vertex, Mesh& mesh);

/// Computes frames after giving each triangle vertices of its own, for flat normals that follow
/// deformed triangles (MeshPose::has_flat_normals).
FramedMesh with_separate_frames(Mesh mesh, const FrameOptions& options, Report& report);

/// Returns the deformation for vertices that were made of those of the given one.
/// \param source_vertex  for each new vertex, the old one
GltfDeformation of_vertices(GltfDeformation deformation,
                            std::span<const std::uint32_t> source_vertex);

// Scenes from files

/// Returns the default scene of a glTF document, not posed yet.
///
/// \param model  the document's file, for messages
/// \throws InvalidInput if a primitive cannot be read
SceneGraph graph_from(const GltfDocument& document, const std::filesystem::path& model,
                      const SceneOptions& options, Report& report);

/// Returns the scene of a scene file (docs/scene-files.md), neither validated nor posed for
/// rendering.
///
/// \throws FileError if the file, or a file that it names, is missing or invalid; problems of the
///         scene file itself are named by their JSON pointer
SceneGraph read_scene_json(const std::filesystem::path& file, const SceneOptions& options,
                           Report& report);

/// Returns the number of a foreign material as a scene allows it: within [0, limit]; NaN counts as
/// 0.
inline float usable(float value, float limit) {
    return value > 0.0F ? std::min(value, limit) : 0.0F;
}

inline glm::vec3 usable(const glm::vec3& color, float limit) {
    return {usable(color.r, limit), usable(color.g, limit), usable(color.b, limit)};
}

/// Returns the mean color of an image, for a material model that has no place for its texture.
/// Colors are averaged in linear light, data as they are. Every texel has the same weight, and
/// alpha is ignored. The mean is taken in double in row order, so it is the same bits every time.
///
/// \return red, green, blue (gray three times); non-finite samples are left out, and the mean of an
///         image without finite samples is 1
glm::vec3 mean_color(const Image& image);

}  // namespace shade::detail
}  // namespace relief
