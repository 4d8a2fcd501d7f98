// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/own_mesh_test.cpp.
#include "own/own_creases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "relief/mesh/stored_creases.h"

namespace relief {
namespace {

constexpr double least_told_by_normals = 15.0;  // Degrees.

OwnCreases by_angle(double degrees, const std::string& why) {
    OwnCreases creases;
    creases.edges.crease_angle = glm::radians(degrees);
    creases.words = fmt::format("edges sharper than {:g} degrees are hard{}", degrees, why);
    creases.option = fmt::format(" --crease {:g}", degrees);
    return creases;
}

OwnCreases by_normals(const Mesh& mesh) {
    OwnCreases none;
    none.words = "no edge is hard";
    const StoredCreases stored = stored_creases(mesh);
    if (stored.hard == 0) return none;
    const double degrees = std::round(glm::degrees(stored.crease_angle));
    if (degrees < least_told_by_normals) {
        none.words += " (its own normals are those of facets, which says nothing)";
        return none;
    }
    return by_angle(degrees, fmt::format(", which tells {:.3g}% of the edges as its own normals do",
                                         100.0 * (1.0 - static_cast<double>(stored.misjudged) /
                                                            static_cast<double>(stored.edges))));
}

}  // namespace

OwnCreases own_creases(const Mesh& mesh, const std::optional<double>& told) {
    OwnCreases none;
    none.words = "no edge is hard";
    if (told) {
        const bool has_any = *told < std::numbers::pi;
        // Smoothing groups of the file have no say then.
        const std::string option =
            mesh.smoothing_groups.empty() ? "" : " --ignore-smoothing-groups";
        OwnCreases creases = has_any ? by_angle(glm::degrees(*told), "") : none;
        creases.option += option;
        return creases;
    }
    if (std::any_of(mesh.smoothing_groups.begin(), mesh.smoothing_groups.end(),
                    [](std::uint32_t group) { return group != 0; })) {
        OwnCreases groups;
        groups.edges.smoothing_groups = mesh.smoothing_groups;
        groups.words = "edges between the file's smoothing groups are hard";
        return groups;
    }
    return mesh.normals.empty() ? none : by_normals(mesh);
}

}  // namespace relief
