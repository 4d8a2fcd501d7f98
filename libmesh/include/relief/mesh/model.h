// SPDX-License-Identifier: Apache-2.0
/// \file
/// Operations on all meshes of a model: normals and tangents, new triangles, models for maps,
/// comparison, and checks.
/// Tests: tests/tools/relief_mesh_test.cpp, process_tangents_test.cpp, reshaping_test.cpp,
/// tests/tools/relief_mesh_compare_test.cpp, map_models_test.cpp, relief_mesh_check_test.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/compare.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"

namespace RELIEF_API relief {

/// The contents of a model file: a glTF document, or a mesh with its materials.
using Model = std::variant<GltfDocument, MeshFile>;

/// The outcome for an attribute of a primitive.
enum class AttributeOutcome { kept, computed, removed, absent };

/// The texture coordinates from which tangents were computed.
struct TangentTexcoords {
    int set = 0;
    bool is_only = true;  ///< The primitive has no other set.
    std::string reason;   ///< "requested", "of normalTexture", ..., "the first".
};

/// A primitive after compute_frames().
struct FramedPart {
    std::string name;  ///< "mesh 'Body' primitive 0"; empty for a file with one mesh and for the
                       ///< whole model.
    std::size_t triangles = 0;
    std::size_t vertices_read = 0;
    std::size_t vertices_written = 0;  ///< Larger than `vertices_read` if vertices were split.
    AttributeOutcome normals = AttributeOutcome::absent;
    NormalMode normal_mode = NormalMode::keep;  ///< The method of computed normals.
    std::size_t normals_by_area = 0;  ///< Vertices for which the automatic mode used area weights.
    bool smoothing_groups = false;    ///< The normals followed the smoothing groups of the file.
    AttributeOutcome tangents = AttributeOutcome::absent;
    TangentMethod tangent_method = TangentMethod::keep;  ///< The method of computed tangents.
    TangentTexcoords texcoords;
    std::vector<std::string> notes;  ///< Notes that do not concern a defect of the input.
    Report report;
};

/// Computes the normals and tangents of each triangle primitive by with_frames().
///
/// Tangents of a glTF primitive belong to the texture coordinates of its normal texture, or to
/// `texcoord_set`. A primitive without them gets no new tangents, which its report counts.
///
/// \param options  `if_missing` is ignored: glTF requires flat normals, other formats get `angle`
/// \throws InvalidInput if there are no triangles, or as with_frames() does
std::vector<FramedPart> compute_frames(Model& model, FrameOptions options,
                                       std::optional<int> texcoord_set = std::nullopt);

/// Computes MikkTSpace tangents of the primitives of a material that have none, as a renderer does
/// for a normal map. Normals stay; a primitive without normals gets flat ones, as glTF requires.
/// \return the changed primitives
std::vector<FramedPart> add_tangents(GltfDocument& document, std::size_t material);

/// A mesh whose triangles are to be changed.
struct TriangleInput {
    const Mesh& mesh;
    const Deformation& deformation;  ///< Of a glTF mesh.
    /// The scale of its largest instance in the default scene of a document; otherwise 1.
    double scale = 1.0;
};

/// Returns a mesh with other triangles. `source_vertex` of the result is empty if its vertices are
/// not copies of the given ones.
using TriangleChange = std::function<FramedMesh(const TriangleInput& input, Report& report)>;

/// Changes all meshes of a model together.
/// \param reports  by mesh
/// \param whole    on the model as a whole
/// \return by mesh, as from a TriangleChange
using ModelChange = std::function<std::vector<FramedMesh>(
    std::span<const TriangleInput> meshes, std::span<Report> reports, Report& whole)>;

/// A report on a part of a model.
struct PartReport {
    std::string part;  ///< "mesh 'Body' primitive 0"; empty for a file with one mesh and for the
                       ///< whole model.
    Report report;
};

/// The result of change_triangles().
struct ChangedModel {
    std::size_t triangles_read = 0;
    std::size_t triangles_written = 0;
    std::size_t vertices_read = 0;
    std::size_t vertices_written = 0;
    bool has_tangents = false;
    std::vector<PartReport> reports;
};

/// Replaces the triangles of each mesh.
///
/// The primitives of a glTF mesh are joined, with a material range each, so that no gap opens
/// between materials; they are changed together and separated again. Their tangents are recomputed.
///
/// \param normals  the mode of the change: with `keep`, primitives without normals get none
/// \throws InvalidInput if there are no triangles, or if none of a mesh file is left
ChangedModel change_triangles(Model& model, NormalMode normals, const TriangleChange& change);
ChangedModel change_triangles(Model& model, NormalMode normals, const ModelChange& change);

/// The same for some meshes of a document, given by their indices.
ChangedModel change_triangles(GltfDocument& document, std::span<const std::size_t> meshes,
                              NormalMode normals, const TriangleChange& change);

/// object: each primitive of a document once, in object space. world: each instance in the scene.
enum class ModelSpace { object, world };

/// A primitive of a document, or the mesh of another file.
struct MapModelPart {
    std::string name;  ///< "mesh 'Body' primitive 0"; empty for the mesh of another file.
    Mesh mesh;
    /// The names of its objects: those of an OBJ file (MeshFile::objects), or the node.
    std::vector<std::string> objects{};
    std::vector<std::uint32_t> object_of{};  ///< By triangle; empty for a single object.
    int texcoord_set = 0;                    ///< The set in `mesh.texcoords` for a document.
};

/// The materials and images of a scene, without decoded pixels.
struct MapAppearance {
    std::vector<GltfMaterial> materials;
    std::vector<GltfImage> images;
};

/// A model for maps, with separate parts.
struct MapModel {
    std::vector<MapModelPart> parts;
    MapAppearance appearance;            ///< In the order of `materials`; only in world space.
    std::vector<std::string> materials;  ///< Names, by the indices in the material ranges.
    glm::dvec3 origin{0.0};              ///< The origin of the positions (mesh_file.h).
    /// The transform of the only primitive of a scene, or the identity for a mesh file; absent for
    /// several primitives.
    std::optional<glm::dmat3> world_from_object;
};

/// Returns all triangles of a model with their attributes.
///
/// Texture coordinates are the set of a primitive's normal texture
/// (GltfDocument::tangent_texcoords). Normals and tangents are those of the file. A glTF primitive
/// without normals gets flat ones, as glTF requires, and no tangents. If only some primitives of a
/// scene have tangents, the others get those of MikkTSpace, as in a renderer. Other files without
/// normals get none.
/// \throws InvalidInput if the document or the mesh is not valid
MapModel map_model(Model model, ModelSpace space, Report& report = IgnoredReport());

/// Joins the parts in their order to one mesh with their material ranges and the attributes that
/// all of them have. Colors are kept if any part has them; the other parts are white, as in glTF.
/// \throws InvalidInput if there are too many vertices for 32-bit indices
Mesh joined(std::vector<MapModelPart> parts);

/// Changes the origin of the positions.
void move_to(MapModel& model, const glm::dvec3& origin);

/// A primitive of a joined model.
struct ComparedPart {
    std::string name;  ///< Empty for a file with one mesh.
    std::size_t first_triangle = 0;
    std::size_t triangle_count = 0;
    bool has_normals = false;
    bool has_tangents = false;
    std::size_t unmatched = 0;   ///< The number of triangles without partner.
    FrameComparison comparison;  ///< Only for parts of the first model.
};

/// The primitives of a model, joined to one mesh with a material range per primitive.
struct JoinedModel {
    Mesh mesh;
    glm::dvec3 origin{0.0};  ///< The origin of the positions (mesh_file.h).
    std::vector<ComparedPart> parts;
    bool in_world_space = false;
};

/// Joins the primitives in object space, or with `in_world_space` all their instances in world
/// space. Mesh files are always in world space.
/// \throws InvalidInput if there are no triangles, or the mesh is not valid
JoinedModel joined_model(Model model, bool in_world_space);

struct ModelMatchOptions {
    /// The tolerance of positions. Default: 1e-5 of the size of the models, the precision of six
    /// digits, but at least the spacing of floats at their coordinates.
    std::optional<double> position_tolerance;
    /// The tolerance of texture coordinates. Default: 1e-6, times the largest if that is above 1.
    std::optional<double> texcoord_tolerance;
    bool by_texcoord = true;
};

struct ModelComparison {
    JoinedModel a;
    JoinedModel b;
    MatchOptions options;  ///< The tolerances in use.
    CornerMatch match;
    FrameComparison all;
    /// Matched corners with normals, or tangents, in only one of the models.
    std::size_t normals_in_one = 0;
    std::size_t tangents_in_one = 0;

    /// Returns whether no matched corner differs by more than `degrees` or in its sign.
    [[nodiscard]] bool is_within(double degrees) const;
    /// Returns whether each triangle has exactly one possible partner, and all directions could be
    /// compared.
    [[nodiscard]] bool is_complete() const;
    /// Returns whether the models have normals or tangents in common.
    [[nodiscard]] bool has_directions() const;
};

/// Matches the corners of two models and measures the angles between their normals and tangents.
/// Each comparison lists at most 24 of the worst corners.
ModelComparison compare_models(JoinedModel a, JoinedModel b, const ModelMatchOptions& options = {});

/// The result of identifying the tangents of a primitive.
struct CheckedTangents {
    IdentifiedTangents identified;
    int texcoord_set = 0;       ///< The set that the tangents match, or else `usual_set`.
    int usual_set = 0;          ///< The set that glTF assigns to the tangents.
    bool has_normals = true;    ///< Without normals, glTF ignores tangents.
    bool has_texcoords = true;  ///< Without them, no method can be compared.
};

/// A triangle primitive of a glTF file, or the mesh of another file.
struct CheckedPart {
    std::string name;  ///< Empty for a file with one mesh.
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    Diagnosis diagnosis;
    Report problems;
    Report notes;
    std::optional<CheckedTangents> tangents;  ///< Absent if the primitive has no tangents.
};

struct CheckedModel {
    /// Findings of the reader. Missing references are problems; content that relief does not use
    /// (points, lines, foreign properties) is a note.
    Report reading_problems;
    Report reading_notes;
    std::vector<CheckedPart> parts;

    /// Returns whether there is no problem.
    [[nodiscard]] bool is_sound() const;
};

/// Checks a model.
///
/// The severities are those of diagnose.h with two exceptions. With `for_baking`, overlapping
/// texture coordinates are a problem. Triangles without texture gradient are only a note if nothing
/// needs tangents: no baking, no normal or bump map in the materials, and no stored tangents.
///
/// \param reading  the report of the reader of the model
/// \throws InvalidInput if a mesh is not valid
CheckedModel check_model(const Model& model, const Report& reading, bool for_baking);

}  // namespace relief
