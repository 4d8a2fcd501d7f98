// SPDX-License-Identifier: Apache-2.0
/// \file
/// Environment maps on the GPU, in the forms that the plan requires, and the skybox.
/// Tests: tests/shade/render/environment_test.cpp.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "environment/convolution.h"
#include "gl/cube_map.h"
#include "gl/program.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene.h"
#include "render/program_cache.h"
#include "render/textures.h"

namespace relief::shade::detail {

/// The maps of an environment, each computed on first use.
struct GpuEnvironment {
    gl::CubeMap sharp;
    std::optional<gl::CubeMap> blurred;
    std::optional<IrradianceSh> irradiance;
    Report findings;  ///< Of the upload.
};

/// The environments of a context by the identity of their images, and the GGX albedo table that all
/// share.
class EnvironmentCache {
  public:
    explicit EnvironmentCache(const gl::Api& api) : api_(&api) {}

    /// Decodes the images of an environment that is not in the cache. \throws FileError if one
    /// cannot be read
    void decode(const Environment& environment);

    /// Gets the maps, which are uploaded on first use after decode().
    /// \throws InvalidInput if images do not fit together; GpuError
    std::shared_ptr<GpuEnvironment> get(const Environment& environment, Report& report);

    std::shared_ptr<GpuEnvironment> black();
    std::shared_ptr<const gl::Texture> brdf();

    void drop_unused();
    [[nodiscard]] std::size_t size() const { return environments_.size(); }

  private:
    struct Entry {
        std::vector<ImageIdentity> images;
        std::size_t layout = 0;  ///< The index of the variant Environment::source.
        bool left_handed = false;
        std::shared_ptr<GpuEnvironment> maps;

        [[nodiscard]] bool is(const Environment& environment) const;
    };
    std::shared_ptr<GpuEnvironment> find(const Environment& environment) const;

    const gl::Api* api_;
    std::vector<Entry> environments_;
    std::vector<Image> decoded_;
    std::shared_ptr<GpuEnvironment> black_;
    std::shared_ptr<const gl::Texture> brdf_;
};

/// The maps that the effects of a plan sample. They are black if a forced plan names a missing
/// environment.
class EnvironmentMaps {
  public:
    /// \param is_shown  the scene has an environment that the plan shows and that is decoded
    /// \throws InvalidInput if images do not fit together; GpuError
    EnvironmentMaps(const gl::Api& api, EnvironmentCache& cache, const Scene& scene,
                    const FramePlan& plan, bool is_shown, Report& report);

    /// Binds the maps to their texture units.
    void bind(const gl::Api& api) const;

    [[nodiscard]] std::size_t texture_count() const;
    /// Returns the last level of the blurred map, for roughness 1.
    [[nodiscard]] float blurred_levels() const;
    /// Returns the nine coefficients of the irradiance in shaders/environment.glsl, times the
    /// intensity.
    [[nodiscard]] const std::array<glm::vec4, 9>& irradiance_sh() const { return irradiance_sh_; }

  private:
    std::shared_ptr<GpuEnvironment> maps_;
    bool has_blurred_ = false;
    std::shared_ptr<const gl::Texture> brdf_;
    std::array<glm::vec4, 9> irradiance_sh_{};
};

/// Draws the environment behind all surfaces.
class Skybox {
  public:
    /// \param output  the encoding that surfaces write
    /// \param blurred_levels  of the environment's maps
    /// \throws GpuError
    Skybox(const gl::Api& api, ProgramCache& programs, const Scene& scene, OutputCoding output,
           float blurred_levels);

    /// The environment must be bound to its texture unit.
    void draw(const gl::Api& api, const Camera& camera, float aspect) const;

  private:
    std::shared_ptr<const gl::LinkedProgram> program_;
    gl::VertexArray empty_vertices_;  ///< Core OpenGL draws only with a vertex array.
    float intensity_;
    glm::vec2 turn_;
    float exposure_;
    float blur_;
    float blurred_levels_;
};

}  // namespace relief::shade::detail
