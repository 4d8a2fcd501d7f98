// SPDX-License-Identifier: Apache-2.0
/// \file
/// Parts of a scene as JSON, in the words of scene files; read back, they are the same bit for bit.
/// Tests: tests/tools/window/saving_test.cpp.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "relief/shade/scene.h"

namespace relief {

using Json = nlohmann::ordered_json;

/// How an image is named: a path, or the number of one that a model brings.
using ImageName = std::function<Json(std::size_t image)>;
/// The same for one that is no texture.
using SourceName = std::function<Json(const ImageSource& source)>;

/// With the fewest digits that read back as this float.
Json json_number(float value);
Json json_vector(const glm::vec3& value);
/// Radians as degrees.
Json json_degrees(float radians);

/// Every member that a file can say, null where the material has it not.
Json material_json(const Material& material, const ImageName& name);

/// Directional, point and spot lights, in the world.
Json lights_json(const Scene& scene);

Json environment_json(const Environment& environment, const SourceName& name);

/// By its matrix, so that nothing is lost.
Json camera_json(const Camera& camera);

}  // namespace relief
