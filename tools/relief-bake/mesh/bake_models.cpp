// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_bake_mesh_test.cpp.
#include "mesh/bake_models.h"

#include "map_models.h"

namespace relief::tools {
namespace {

MapModel read(const std::filesystem::path& file, Findings& findings) {
    Report report;
    MapModel model = read_map_model(file, ModelSpace::world, report);
    findings.add(file.string(), report);
    return model;
}

Mesh read_beside(const MapModel& low, const std::filesystem::path& file, Findings& findings) {
    MapModel model = read(file, findings);
    move_to(model, low.origin);
    return about(file, [&] { return joined(std::move(model.parts)); });
}

}  // namespace

BakeModels read_bake_models(const MeshBakeRequest& request, Findings& findings) {
    BakeModels models;
    MapModel low = read(request.low, findings);
    require_texcoords(request.low, low, "no texture coordinates, by which a map lies on a mesh",
                      "unwrap it in a modelling program");
    for (const std::filesystem::path& file : request.high)
        models.high.push_back(read_beside(low, file, findings));
    if (request.cage) models.cage = read_beside(low, *request.cage, findings);
    models.materials = low.materials;
    models.world_from_low = low.world_from_object;
    models.low = about(request.low, [&] { return joined(std::move(low.parts)); });
    return models;
}

glm::dmat3 output_axes(const MeshBakeRequest& request,
                       const std::optional<glm::dmat3>& world_from_low) {
    if (request.space != SpaceChoice::object) return glm::dmat3(1.0);
    if (!world_from_low) {
        throw failure(request.low, "has several primitives, so no axes of its own",
                      "use --space world or tangent");
    }
    // Normals go by the inverse transpose of what positions go by.
    return glm::transpose(*world_from_low);
}

}  // namespace relief::tools
