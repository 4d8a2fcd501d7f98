// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tangent frames in double, and the same rounded to float.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace relief::test {

/// Frames in double, and the same frames rounded to float.
struct ReferenceFrames {
    std::vector<glm::dvec3> normals;
    std::vector<glm::dvec3> tangents;
    std::vector<glm::vec3> float_normals;
    std::vector<glm::vec4> float_tangents;

    void add(const glm::dvec3& normal, const glm::dvec3& tangent, float w);
};

/// Uniformly distributed frames with alternating handedness, the same on every machine.
ReferenceFrames random_frames(std::size_t count);

}  // namespace relief::test
