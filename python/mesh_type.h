// SPDX-License-Identifier: Apache-2.0
/// \file
/// The class relief.Mesh.
#pragma once

#include <utility>

#include "arrays.h"
#include "relief/mesh/mesh.h"

namespace relief::python {

/// A mesh with the origin of its positions (relief/mesh/mesh_file.h). Arrays of Python view its
/// vectors, so their sizes never change.
struct MeshObject : Mesh {
    MeshObject() = default;
    explicit MeshObject(Mesh mesh, const glm::dvec3& its_origin = glm::dvec3(0.0))
        : Mesh(std::move(mesh)), origin(its_origin) {}

    glm::dvec3 origin{0.0};
};

}  // namespace relief::python
