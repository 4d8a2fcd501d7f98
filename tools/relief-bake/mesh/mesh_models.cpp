// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_bake_mesh_test.cpp.
#include "mesh/mesh_models.h"

#include <algorithm>

#include "common/model_file.h"
#include "relief/mesh/placed.h"

namespace relief::tools {
namespace {

/// Tangents in the order of flattened(): those of the file, where every primitive has them, and
/// normals too, so that no vertex was split.
std::vector<glm::vec4> tangents_of(const GltfDocument& document, const GltfView& view) {
    std::vector<glm::vec4> all;
    for (const auto& primitive : view.primitives) {
        Mesh part = document.mesh(primitive.what);
        if (part.tangents.empty() || part.normals.empty()) return {};
        part = placed(std::move(part), primitive.world_from_object);
        all.insert(all.end(), part.tangents.begin(), part.tangents.end());
    }
    return all;
}

BakeModel model_of(const GltfDocument& document) {
    BakeModel model;
    model.mesh = flattened(document).mesh;
    const GltfView view = document.view();
    model.mesh.tangents = tangents_of(document, view);
    if (view.primitives.size() == 1)
        model.world_from_object = glm::dmat3(glm::dmat4(view.primitives[0].world_from_object));
    return model;
}

}  // namespace

BakeModel read_bake_model(const std::filesystem::path& file, Findings& findings) {
    Report report;
    Model read = read_model(file, report);
    findings.add(file.string(), report);
    return about(file, [&] {
        if (const auto* document = std::get_if<GltfDocument>(&read)) return model_of(*document);
        auto& contents = std::get<MeshFile>(read);
        BakeModel model;
        model.origin = contents.origin;
        model.mesh = std::move(contents.mesh);
        model.world_from_object = glm::dmat3(1.0);
        return model;
    });
}

void move_to(BakeModel& model, const glm::dvec3& origin) {
    const glm::dvec3 by = model.origin - origin;
    model.origin = origin;
    if (by == glm::dvec3(0.0)) return;
    for (glm::vec3& position : model.mesh.positions)
        position = glm::vec3(glm::dvec3(position) + by);
}

}  // namespace relief::tools
