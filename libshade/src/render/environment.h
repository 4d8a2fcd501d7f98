// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surroundings on the GPU, and their picture behind the model.
/// Tests: tests/shade/render/environment_test.cpp.
#pragma once

#include <optional>

#include "gl/cube_map.h"
#include "gl/program.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

namespace relief {

/// The environment's images, decoded on all threads: six, or one.
/// \throws FileError if one cannot be read
std::vector<Image> decode_environment(const Environment& environment);

/// A cube map of them. \throws InvalidInput if six do not fit together; GpuError
gl::CubeMap make_environment(const gl::Api& api, const Environment& environment,
                             std::span<const Image> images, Report& report);

/// A cube map without light, for a plan that names an environment where there is none.
gl::CubeMap make_black_environment(const gl::Api& api);

/// Draws the environment wherever nothing is nearer.
class Skybox {
  public:
    /// \throws GpuError
    Skybox(const gl::Api& api, OutputCoding output, float intensity);

    /// The environment must be bound to its texture unit.
    void draw(const gl::Api& api, const Camera& camera, float aspect) const;

  private:
    gl::LinkedProgram program_;
    gl::VertexArray nothing_;  ///< Core OpenGL draws only with a vertex array.
    float intensity_;
};

}  // namespace relief
