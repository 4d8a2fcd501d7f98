// SPDX-License-Identifier: Apache-2.0
/// \file
/// The files of a dense model, and how they are read.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace relief::tools {

struct DenseModel {
    std::vector<std::filesystem::path> files;  ///< At least one, in one space.
    bool has_z_up = false;                 ///< Read with y_up() of its positions and directions.
    std::optional<double> crease_angle{};  ///< For files without normals, in radians.
};

/// Rotates a space whose z points up to that of glTF, whose y does.
template <typename Number>
glm::vec<3, Number> y_up(const glm::vec<3, Number>& v) {
    return {v.x, v.z, Number(0) - v.y};
}

}  // namespace relief::tools
