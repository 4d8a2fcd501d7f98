// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_bake_mesh_test.cpp, model_pairs_test.cpp.
#include "mesh/bake_models.h"

#include <utility>

#include "common/map_models.h"
#include "relief/mesh/mesh_part.h"

namespace relief::tools {
namespace {

MapModel read(const std::filesystem::path& file, Findings& findings) {
    Report report;
    MapModel model = read_map_model(file, ModelSpace::world, report);
    findings.add(file.string(), report);
    return model;
}

MapModel read_beside(const MapModel& low, const std::filesystem::path& file, Findings& findings) {
    MapModel model = read(file, findings);
    move_to(model, low.origin);
    return model;
}

Mesh joined_of(const std::filesystem::path& file, MapModel model) {
    return about(file, [&] { return joined(std::move(model.parts)); });
}

/// A part's triangles as a mesh; all of them as they are.
Mesh taken(std::vector<MapModel>& models, const HighPiece& piece) {
    Mesh& mesh = models[piece.model].parts[piece.part].mesh;
    return piece.triangles.size() == mesh.triangles.size() ? std::move(mesh)
                                                           : part_of(mesh, piece.triangles);
}

/// The high meshes, one pair after another where they are matched by name.
/// \return the file that each is from
std::vector<std::size_t> add_high(const MeshBakeRequest& request, const MapModel& low,
                                  std::vector<MapModel> high, BakeModels& models,
                                  Findings& findings) {
    std::vector<NamedModel> named;
    for (std::size_t i = 0; i < high.size(); ++i)
        named.push_back({request.high[i], &high[i]});
    ModelPairs paired = pair_models(named, {request.low, &low}, request.match);
    findings.add("", paired.report);
    models.unpaired = std::move(paired.unpaired);
    std::vector<std::size_t> file_of;
    for (ModelPair& pair : paired.pairs) {
        BakePair range{pair.name, models.high.size(), pair.high.size(), 0, std::move(pair.low)};
        for (const HighPiece& piece : pair.high) {
            file_of.push_back(piece.model);
            models.high.push_back(taken(high, piece));
            range.high_triangles += models.high.back().triangles.size();
        }
        models.pairs.push_back(std::move(range));
    }
    if (!paired.pairs.empty()) return file_of;
    for (std::size_t i = 0; i < high.size(); ++i) {
        file_of.push_back(i);
        models.high.push_back(joined_of(request.high[i], std::move(high[i])));
    }
    return file_of;
}

/// What the high meshes have beside their vertices, once these are in their places.
void add_looks(const MeshBakeRequest& request, const std::vector<MapLooks>& looks,
               std::span<const std::size_t> file_of, BakeModels& models, Findings& findings) {
    const bool with_colors = request.layers.files.contains(LayerKind::color);
    std::vector<Report> reports(looks.size());
    for (std::size_t i = 0; i < models.high.size(); ++i) {
        const std::size_t file = file_of[i];
        models.looks.add(request.high[file], models.high[i], looks[file], request.looks,
                         with_colors, reports[file]);
    }
    for (std::size_t file = 0; file < looks.size(); ++file)
        findings.add(request.high[file].string(), reports[file]);
}

}  // namespace

Baker BakeModels::baker(const BakeOptions& options, Report& report) const {
    if (pairs.empty()) return {high, low, options, report};
    std::vector<BakePart> parts;
    for (const BakePair& pair : pairs)
        parts.push_back(
            {std::span(high).subspan(pair.first_high, pair.high_count), pair.low, pair.name});
    return {parts, low, options, report};
}

BakeModels read_bake_models(const MeshBakeRequest& request, Findings& findings) {
    BakeModels models;
    MapModel low = read(request.low, findings);
    require_texcoords(request.low, low, "no texture coordinates, by which a map lies on a mesh",
                      "unwrap it in a modelling program");
    std::vector<MapModel> high;
    std::vector<MapLooks> looks;
    for (const std::filesystem::path& file : request.high) {
        high.push_back(read_beside(low, file, findings));
        looks.push_back(std::move(high.back().looks));
    }
    if (request.cage)
        models.cage = joined_of(*request.cage, read_beside(low, *request.cage, findings));
    const std::vector<std::size_t> file_of =
        add_high(request, low, std::move(high), models, findings);
    add_looks(request, looks, file_of, models, findings);
    models.materials = low.materials;
    models.world_from_low = low.world_from_object;
    models.origin = low.origin;
    models.low = joined_of(request.low, std::move(low));
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
