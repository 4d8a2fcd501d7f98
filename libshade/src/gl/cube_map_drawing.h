// SPDX-License-Identifier: Apache-2.0
/// \file
/// Drawing into the faces of a cube map: how panoramas, light probes and blurred copies come to be.
/// Tests: tests/shade/gl/cube_map_test.cpp.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "gl/cube_map.h"
#include "gl/program.h"

namespace relief::gl {

/// RGBA16F faces with nothing in them yet, bound to no unit.
///
/// \param levels  the first so many; the rest does not exist
/// \throws GpuError if they are larger than the context's limit, or memory runs out
CubeMap make_empty_cube_map(const Api& api, int size, int levels, std::string_view name);

/// How the bound cube map is looked up: without seams, between all of its levels.
void set_cube_sampling(const Api& api);

/// A program that gives every texel of a face its colour, for every face.
///
/// The fragment shader is made of `declarations`, which may declare uniforms and functions, and
/// `radiance`, the body of `vec3 radiance(vec3 direction)`, where `direction` is the texel's in
/// world space, not unit. With a grid, the colour is the mean of grid x grid directions in a texel.
///
/// Restores the framebuffer binding, the viewport and the tests; leaves no program or vertex array
/// bound. The active texture unit is 0, and what is bound there stays the caller's business.
class CubePainter {
  public:
    CubePainter(const Api& api, const std::string& name, const std::string& declarations,
                const std::string& radiance);

    /// \param prepare  sets the declared uniforms
    void paint(const CubeMap& cube, int level, int grid,
               const std::function<void(const LinkedProgram&)>& prepare) const;

  private:
    const Api* api_;
    LinkedProgram program_;
    VertexArray no_vertices_;
    Framebuffer framebuffer_;
};

}  // namespace relief::gl
