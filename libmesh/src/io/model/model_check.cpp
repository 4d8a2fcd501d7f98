// SPDX-License-Identifier: Apache-2.0
// Checks the parts of glTF documents and mesh files, whose materials decide the severities.
// Tests: tests/tools/relief_mesh_check_test.cpp.
#include "relief/mesh/model.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh_file.h"

namespace relief {

bool CheckedModel::is_sound() const {
    return reading_problems.empty() &&
           std::all_of(parts.begin(), parts.end(),
                       [](const CheckedPart& part) { return part.problems.empty(); });
}

namespace {

/// Identifies the method of a primitive's stored tangents. If no method matches with the texture
/// coordinates that glTF assigns to the tangents, the other sets are tried.
/// \return nothing if the primitive has no tangents
std::optional<CheckedTangents> check_tangents(const GltfDocument& document, GltfPrimitiveId id,
                                              const Mesh& mesh) {
    if (mesh.tangents.empty()) return std::nullopt;
    CheckedTangents result;
    result.usual_set = document.tangent_texcoords(id).set;
    result.texcoord_set = result.usual_set;
    result.has_normals = !mesh.normals.empty();
    const std::vector<int> sets = document.texcoord_sets(id);
    result.has_texcoords = !sets.empty();
    if (!result.has_normals || sets.empty()) return result;
    result.identified = identify_tangents(document.mesh(id, result.usual_set));
    for (const int set : sets) {
        if (result.identified.method) break;
        if (set == result.usual_set) continue;
        IdentifiedTangents other = identify_tangents(document.mesh(id, set));
        if (!other.method) continue;
        result.identified = std::move(other);
        result.texcoord_set = set;
    }
    return result;
}

/// Returns whether the model is complete in spite of a finding of its reader.
bool is_harmless(const Finding& finding) {
    static constexpr std::array kinds = {"far from the origin",
                                         "point",
                                         "line",
                                         "unknown statement",
                                         "line with more values than the header names",
                                         "bytes behind the GLB",
                                         "bytes behind the last triangle",
                                         "name that is not UTF-8"};
    return finding.kind.starts_with("PLY property") ||
           std::find(kinds.begin(), kinds.end(), finding.kind) != kinds.end();
}

void add_reading(CheckedModel& model, const Report& reading) {
    for (const Finding& finding : reading.findings())
        (is_harmless(finding) ? model.reading_notes : model.reading_problems).add(finding);
}

/// The intended use of a part, which decides the severity of a condition.
struct Use {
    bool tangents = false;
    bool baking = false;
};

Severity severity_of(MeshCondition condition, const Use& use) {
    if (condition == MeshCondition::texture_degenerate && !use.tangents && !use.baking)
        return Severity::note;
    if (condition == MeshCondition::texture_overlapping && use.baking) return Severity::problem;
    return condition_info(condition).severity;
}

void add_part(CheckedModel& model, std::string name, const Mesh& mesh, const Use& use) {
    CheckedPart part{
        std::move(name), mesh.triangles.size(), mesh.positions.size(), diagnose(mesh), {}, {}, {}};
    for (const MeshConditionCount& found : part.diagnosis.conditions) {
        const bool is_problem = severity_of(found.condition, use) == Severity::problem;
        (is_problem ? part.problems : part.notes).add(to_finding(found));
    }
    model.parts.push_back(std::move(part));
}

bool wants_tangents(const Mesh& mesh, const std::vector<GltfMaterial>& materials) {
    if (!mesh.tangents.empty()) return true;
    return std::any_of(mesh.material_ranges.begin(), mesh.material_ranges.end(),
                       [&](const MaterialRange& range) {
                           return range.material && *range.material < materials.size() &&
                                  materials[*range.material].normal_map;
                       });
}

/// Returns true also if no material has a texture, because the use of the mesh is then unknown.
bool wants_tangents(const std::vector<MtlMaterial>& materials) {
    bool has_textures = false;
    for (const MtlMaterial& material : materials) {
        if (material.normal_map || material.bump_map) return true;
        has_textures = has_textures || material.diffuse_map || material.emission_map;
    }
    return !has_textures;
}

std::size_t hash_of(const Mesh& mesh) {
    std::size_t hash = 0;
    const auto add = [&](const auto& values) {
        const std::string_view bytes(reinterpret_cast<const char*>(values.data()),
                                     values.size() * sizeof(values.front()));
        hash = hash * 31 + std::hash<std::string_view>()(bytes);
    };
    add(mesh.positions);
    add(mesh.triangles);
    return hash;
}

/// Compares bits, so that a mesh with NaN equals its copy.
bool are_equal(const Mesh& a, const Mesh& b) {
    const auto equal = [](const auto& x, const auto& y) {
        return x.size() == y.size() &&
               (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x.front())) == 0);
    };
    return equal(a.positions, b.positions) && equal(a.normals, b.normals) &&
           equal(a.tangents, b.tangents) && equal(a.texcoords, b.texcoords) &&
           equal(a.colors, b.colors) && equal(a.triangles, b.triangles);
}

/// The parts of a document whose meshes differ. Primitives often share all of their data, and
/// reading it again costs little beside a diagnosis.
class PartsByMesh {
  public:
    explicit PartsByMesh(const GltfDocument& document) : document_(document) {}

    /// Returns the number of an equal part, or adds this one.
    std::optional<std::size_t> equal_part(GltfPrimitiveId id, const Mesh& mesh,
                                          bool wants_tangents) {
        // Tangents may belong to a texture coordinate set that is not in the mesh.
        const std::vector<int> sets = document_.texcoord_sets(id);
        if (!mesh.tangents.empty() && !sets.empty() && sets != std::vector{0}) {
            ++count_;
            return std::nullopt;
        }
        const std::size_t hash = hash_of(mesh);
        const auto [begin, end] = parts_.equal_range(hash);
        for (auto it = begin; it != end; ++it) {
            const Part& part = it->second;
            if (part.wants_tangents != wants_tangents || !are_equal(document_.mesh(part.id), mesh))
                continue;
            ++count_;
            return part.number;
        }
        parts_.emplace(hash, Part{id, wants_tangents, count_++});
        return std::nullopt;
    }

  private:
    struct Part {
        GltfPrimitiveId id;
        bool wants_tangents = false;
        std::size_t number = 0;
    };

    const GltfDocument& document_;
    std::unordered_multimap<std::size_t, Part> parts_;
    std::size_t count_ = 0;
};

void add_parts(CheckedModel& model, const GltfDocument& document, bool for_baking) {
    const std::vector<GltfMaterial> materials = document.view().materials;
    PartsByMesh known(document);
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const Mesh mesh = document.mesh(id);
        const Use use{wants_tangents(mesh, materials), for_baking};
        if (const auto equal = known.equal_part(id, mesh, use.tangents)) {
            CheckedPart copy = model.parts[*equal];
            copy.name = document.describe(id);
            model.parts.push_back(std::move(copy));
            continue;
        }
        add_part(model, document.describe(id), mesh, use);
        model.parts.back().tangents = check_tangents(document, id, mesh);
    }
}

void add_parts(CheckedModel& model, const MeshFile& contents, bool for_baking) {
    add_part(model, "", contents.mesh, {wants_tangents(contents.materials), for_baking});
}

}  // namespace

CheckedModel check_model(const Model& model, const Report& reading, bool for_baking) {
    CheckedModel checked;
    add_reading(checked, reading);
    std::visit([&](const auto& contents) { add_parts(checked, contents, for_baking); }, model);
    return checked;
}

}  // namespace relief
