// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surroundings on the GPU, in the forms that the plan calls for, and their picture behind the
/// model. Tests: tests/shade/render/environment_test.cpp.
#pragma once

#include <array>
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

/// What the plan's effects look up. A plan may name an environment where there is none: it is
/// black.
class EnvironmentMaps {
  public:
    /// \param images  decoded; empty where the scene has none or nothing shows it
    /// \throws InvalidInput if images do not fit together; GpuError
    EnvironmentMaps(const gl::Api& api, const Scene& scene, const FramePlan& plan,
                    std::span<const Image> images, Report& report);

    /// To their texture units.
    void bind(const gl::Api& api) const;

    [[nodiscard]] std::size_t texture_count() const;
    /// The last level of the blurred map, which stands for roughness 1.
    [[nodiscard]] float blurred_levels() const;
    /// The nine numbers of shaders/light/environment_irradiance.glsl, times the intensity.
    [[nodiscard]] const std::array<glm::vec4, 9>& irradiance_sh() const { return irradiance_sh_; }

  private:
    std::optional<gl::CubeMap> sharp_;
    std::optional<gl::CubeMap> blurred_;
    std::optional<gl::Texture> brdf_;
    std::array<glm::vec4, 9> irradiance_sh_{};
};

/// Draws the environment wherever nothing is nearer.
class Skybox {
  public:
    /// \param output  what surfaces write (picture.h)
    /// \throws GpuError
    Skybox(const gl::Api& api, const Scene& scene, OutputCoding output);

    /// The environment must be bound to its texture unit.
    void draw(const gl::Api& api, const Camera& camera, float aspect) const;

  private:
    gl::LinkedProgram program_;
    gl::VertexArray nothing_;  ///< Core OpenGL draws only with a vertex array.
    float intensity_;
    float exposure_;
};

}  // namespace relief
