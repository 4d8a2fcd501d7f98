// SPDX-License-Identifier: Apache-2.0
#include "relief/mesh/model_texcoords.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "geometry/corner_texcoords.h"
#include "io/model/mesh_instances.h"
#include "relief/mesh/frames.h"

namespace relief {
using namespace relief::detail;

namespace {

/// A primitive and its triangles in the joined mesh.
struct JoinedPart {
    GltfPrimitiveId id;
    std::size_t first_triangle = 0;
    std::size_t triangle_count = 0;
};

/// The set whose coordinates the input of a change has.
int known_set(const std::vector<int>& sets, int wanted) {
    return sets.empty() || std::find(sets.begin(), sets.end(), wanted) != sets.end() ? wanted
                                                                                     : sets.front();
}

/// Joins all primitives, and counts meshes and instances that are special.
class DocumentJoiner {
  public:
    DocumentJoiner(const GltfDocument& document, int set, Report& report)
        : document_(document), set_(set), report_(report), instances_(instances_of(document)) {
        for (const GltfPrimitiveId id : document.triangle_primitives())
            add(id);
    }

    [[nodiscard]] TexcoordInput input() const { return {mesh_, first_vertices_}; }
    [[nodiscard]] const std::vector<JoinedPart>& parts() const { return parts_; }
    [[nodiscard]] std::vector<std::string> notes() const {
        std::size_t shared = 0;
        std::optional<std::size_t> scaled;
        for (const auto& [mesh, instances] : instances_) {
            if (instances.count <= 1) continue;
            ++shared;
            if (instances.largest > instances.smallest * 1.001 && !scaled) scaled = mesh;
        }
        std::vector<std::string> notes;
        if (shared > 0)
            notes.push_back(fmt::format("{} {} several instances, which share texels", shared,
                                        shared == 1 ? "mesh has" : "meshes have"));
        if (scaled)
            notes.push_back(fmt::format(
                "instances have different scales: the density is that of the largest (the first "
                "is {})",
                document_.describe({*scaled, 0})));
        return notes;
    }

  private:
    void add(GltfPrimitiveId id) {
        const bool is_new_mesh = parts_.empty() || parts_.back().id.mesh != id.mesh;
        const auto instances = instances_.find(id.mesh);
        if (is_new_mesh && instances == instances_.end())
            report_.add("mesh outside of the scene", "mesh", id.mesh,
                        "gets texels of its own, at the scale of its object space");
        const Mesh part = document_.mesh(id, known_set(document_.texcoord_sets(id), set_));
        const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
        if (is_new_mesh) first_vertices_.push_back(first);
        const glm::dmat3 transform =
            instances == instances_.end() ? glm::dmat3(1.0) : instances->second.world_from_object;
        for (const glm::vec3& position : part.positions)
            mesh_.positions.emplace_back(transform * glm::dvec3(position));
        append(part.texcoords, glm::vec2(0.0F), mesh_.texcoords);
        append(part.colors, glm::vec4(1.0F), mesh_.colors);
        parts_.push_back({id, mesh_.triangles.size(), part.triangles.size()});
        mesh_.material_ranges.push_back(
            {static_cast<std::uint32_t>(mesh_.triangles.size()),
             static_cast<std::uint32_t>(part.triangles.size()),
             part.material_ranges.empty() ? std::nullopt : part.material_ranges.front().material});
        for (const glm::uvec3& triangle : part.triangles)
            mesh_.triangles.push_back(triangle + first);
    }

    /// Appends the values of the last vertices. Vertices without values get `filler` if others have
    /// some.
    template <typename Value>
    void append(const std::vector<Value>& values, const Value& filler,
                std::vector<Value>& all) const {
        if (values.empty() && all.empty()) return;
        all.resize(mesh_.positions.size() - values.size(), filler);
        all.insert(all.end(), values.begin(), values.end());
    }

    const GltfDocument& document_;
    int set_;
    Report& report_;
    std::map<std::size_t, MeshInstances> instances_;
    Mesh mesh_;
    std::vector<std::uint32_t> first_vertices_;
    std::vector<JoinedPart> parts_;
};

/// Recomputes the tangents of a primitive.
std::size_t renew_tangents(GltfDocument& document, GltfPrimitiveId id, int set, Report& report) {
    Mesh mesh = document.mesh(id, set);
    const bool has_normals = !mesh.normals.empty();
    report.add(
        "tangents of replaced texture coordinates", "primitive", id.primitive,
        has_normals ? "are recomputed by MikkTSpace" : "are removed, because there are no normals");
    if (!has_normals) mesh.tangents.clear();
    const FrameOptions options{
        .normals = NormalMode::keep,
        .tangents = has_normals ? TangentMethod::mikktspace : TangentMethod::none};
    FramedMesh framed;
    if (has_normals) {
        framed = with_frames(std::move(mesh), options, report);
    } else {
        framed.source_vertex.resize(mesh.positions.size());
        std::iota(framed.source_vertex.begin(), framed.source_vertex.end(), 0U);
        framed.mesh = std::move(mesh);
    }
    const std::size_t vertices = framed.mesh.positions.size();
    if (has_normals) return document.set_frames(id, framed, options, report);
    document.set_frames(id, framed);
    return vertices;
}

/// Reports textures at replaced coordinates. \return their materials
std::set<std::size_t> textured_materials(const GltfDocument& document,
                                         const std::vector<JoinedPart>& parts,
                                         const TexcoordOptions& options, Report& report) {
    std::set<std::size_t> materials;
    for (const JoinedPart& part : parts) {
        const std::vector<int> sets = document.texcoord_sets(part.id);
        if (std::find(sets.begin(), sets.end(), options.set) == sets.end()) continue;
        for (const std::size_t each : document.materials_with_textures_at(part.id, options.set))
            materials.insert(each);
    }
    for (const std::size_t each : materials)
        report.add("material with textures at replaced texture coordinates", "material", each,
                   options.remove_textures ? "loses these textures; its factors stay"
                                           : "keeps the textures, which do not fit any more");
    return materials;
}

void check_set(const GltfDocument& document, const std::vector<JoinedPart>& parts, int set) {
    int first_free = 0;
    for (const JoinedPart& part : parts) {
        const std::vector<int> sets = document.texcoord_sets(part.id);
        if (!sets.empty()) first_free = std::max(first_free, sets.back() + 1);
    }
    if (set < 0 || set > first_free)
        throw InvalidInput(fmt::format("texture coordinate set {} would leave a gap (give 0 to {})",
                                       set, first_free));
}

void require_three_each(const std::vector<glm::vec2>& corners, std::size_t triangles) {
    if (corners.size() != 3 * triangles)
        throw InvalidInput(fmt::format("there are {} texture coordinates for {} triangles",
                                       corners.size(), triangles));
}

ChangedTexcoords change_texcoords_of(GltfDocument& document, const TexcoordOptions& options,
                                     const TexcoordChange& change) {
    ChangedTexcoords done;
    Report report;
    const DocumentJoiner joined(document, options.set, report);
    if (joined.parts().empty()) throw InvalidInput("has no triangles");
    check_set(document, joined.parts(), options.set);
    const TexcoordInput input = joined.input();
    done.triangles = input.mesh.triangles.size();
    done.vertices_read = input.mesh.positions.size();
    done.notes = joined.notes();
    const std::vector<glm::vec2> corners = change(input, report);
    require_three_each(corners, done.triangles);

    std::vector<bool> has_old_tangents;
    for (const JoinedPart& part : joined.parts())
        has_old_tangents.push_back(document.tangent_texcoords(part.id).set == options.set &&
                                   !document.mesh(part.id).tangents.empty());
    const std::set<std::size_t> textured =
        textured_materials(document, joined.parts(), options, report);
    if (options.remove_textures) {
        for (const std::size_t material : textured)
            document.remove_textures_at(material, options.set);
    }
    done.reports.push_back({"", std::move(report)});
    for (std::size_t i = 0; i < joined.parts().size(); ++i) {
        const JoinedPart& part = joined.parts()[i];
        PartReport own{document.describe(part.id), {}};
        const FramedMesh split = with_corner_texcoords(
            document.mesh(part.id),
            std::span(corners).subspan(3 * part.first_triangle, 3 * part.triangle_count));
        document.set_texcoords(part.id, options.set, split, own.report);
        std::size_t vertices = split.mesh.positions.size();
        if (has_old_tangents[i])
            vertices = renew_tangents(document, part.id, options.set, own.report);
        done.vertices_written += vertices;
        done.has_tangents = done.has_tangents || !document.mesh(part.id).tangents.empty();
        done.reports.push_back(std::move(own));
    }
    return done;
}

/// Reports the maps of materials, and removes them if that is wanted.
void handle_maps(std::vector<MtlMaterial>& materials, bool remove, Report& report) {
    for (std::size_t i = 0; i < materials.size(); ++i) {
        MtlMaterial& material = materials[i];
        bool is_found = false;
        for (auto* map : {&material.diffuse_map, &material.specular_map, &material.emission_map,
                          &material.opacity_map, &material.normal_map, &material.bump_map}) {
            is_found = is_found || map->has_value();
            if (remove) map->reset();
        }
        if (is_found)
            report.add("material with textures at replaced texture coordinates", "material", i,
                       remove ? "loses these textures; its factors stay"
                              : "keeps the textures, which do not fit any more");
    }
}

ChangedTexcoords change_texcoords_of(MeshFile& file, const TexcoordOptions& options,
                                     const TexcoordChange& change) {
    if (options.set != 0)
        throw InvalidInput(fmt::format(
            "texture coordinate set {} does not exist, only glTF has several", options.set));
    ChangedTexcoords done;
    Report report;
    const Mesh& mesh = file.mesh;
    done.triangles = mesh.triangles.size();
    done.vertices_read = mesh.positions.size();
    const std::vector<glm::vec2> corners = change({mesh, {}}, report);
    require_three_each(corners, done.triangles);
    if (!mesh.texcoords.empty()) handle_maps(file.materials, options.remove_textures, report);
    file.mesh = with_corner_texcoords(mesh, corners).mesh;
    file.mesh.tangents.clear();
    done.vertices_written = file.mesh.positions.size();
    done.reports.push_back({"", std::move(report)});
    return done;
}

}  // namespace

ChangedTexcoords change_texcoords(Model& model, const TexcoordOptions& options,
                                  const TexcoordChange& change) {
    if (auto* document = std::get_if<GltfDocument>(&model))
        return change_texcoords_of(*document, options, change);
    return change_texcoords_of(std::get<MeshFile>(model), options, change);
}

}  // namespace relief
