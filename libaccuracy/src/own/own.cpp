// SPDX-License-Identifier: Apache-2.0
// Which experiments a mesh is good for. Tests: tests/accuracy/own_mesh_test.cpp.
#include "relief/accuracy/own.h"

#include <fmt/format.h>

#include "own/own_experiment.h"
#include "own/own_normals.h"
#include "own/own_tangents.h"
#include "relief/mesh/error.h"

namespace relief {

std::vector<OwnExperiment> measure_own_mesh(const Mesh& mesh, const OwnMeshOptions& mesh_options,
                                            const OwnOptions& options) {
    validate(mesh);
    if (mesh.triangles.empty()) throw InvalidInput("the mesh has no triangle to measure on");
    const Mesh part = part_to_measure(mesh, mesh_options.most_triangles);
    const std::string whole =
        part.triangles.size() == mesh.triangles.size()
            ? ""
            : fmt::format(", eight runs of the mesh's {}", mesh.triangles.size());
    std::vector<OwnExperiment> all;
    all.push_back(own_normals(part, whole, mesh_options, options));
    if (!mesh.texcoords.empty()) {
        for (OwnExperiment& one : own_tangents(part, whole, options))
            all.push_back(std::move(one));
    }
    return all;
}

}  // namespace relief
