// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surroundings on the GPU, in the forms that the plan calls for, and their picture behind the
/// model. Tests: tests/shade/render/environment_test.cpp.
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
#include "scene/image_identity.h"

namespace relief {

/// An environment's maps, each made when it is wanted first.
struct GpuEnvironment {
    gl::CubeMap sharp;
    std::optional<gl::CubeMap> blurred;
    std::optional<IrradianceSh> irradiance;
    Report found;  ///< When it was uploaded.
};

/// Environments on the GPU, kept by what they are made of, and GGX's albedo, which all have in
/// common.
class EnvironmentCache {
  public:
    explicit EnvironmentCache(const gl::Api& api) : api_(&api) {}

    /// Decodes the images of one that is not there. \throws FileError if one cannot be read
    void decode(const Environment& environment);

    /// Uploaded if it is not there yet; decode() came before.
    /// \throws InvalidInput if images do not fit together; GpuError
    std::shared_ptr<GpuEnvironment> get(const Environment& environment, Report& report);

    std::shared_ptr<GpuEnvironment> black();
    std::shared_ptr<const gl::Texture> brdf();

    void drop_unused();
    [[nodiscard]] std::size_t size() const { return environments_.size(); }

  private:
    struct Entry {
        std::vector<ImageIdentity> images;
        std::size_t layout = 0;  ///< Which of Environment's.
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

/// What the plan's effects look up. A plan may name an environment where there is none: it is
/// black.
class EnvironmentMaps {
  public:
    /// \param is_shown  the scene has an environment and the plan shows it; decode() came before
    /// \throws InvalidInput if images do not fit together; GpuError
    EnvironmentMaps(const gl::Api& api, EnvironmentCache& cache, const Scene& scene,
                    const FramePlan& plan, bool is_shown, Report& report);

    /// To their texture units.
    void bind(const gl::Api& api) const;

    [[nodiscard]] std::size_t texture_count() const;
    /// The last level of the blurred map, which stands for roughness 1.
    [[nodiscard]] float blurred_levels() const;
    /// The nine numbers of shaders/environment.glsl (irradiance), times the intensity.
    [[nodiscard]] const std::array<glm::vec4, 9>& irradiance_sh() const { return irradiance_sh_; }

  private:
    std::shared_ptr<GpuEnvironment> maps_;
    bool has_blurred_ = false;
    std::shared_ptr<const gl::Texture> brdf_;
    std::array<glm::vec4, 9> irradiance_sh_{};
};

/// Draws the environment wherever nothing is nearer.
class Skybox {
  public:
    /// \param output  what surfaces write (picture.h)
    /// \throws GpuError
    Skybox(const gl::Api& api, ProgramCache& programs, const Scene& scene, OutputCoding output);

    /// The environment must be bound to its texture unit.
    void draw(const gl::Api& api, const Camera& camera, float aspect) const;

  private:
    std::shared_ptr<const gl::LinkedProgram> program_;
    gl::VertexArray nothing_;  ///< Core OpenGL draws only with a vertex array.
    float intensity_;
    float exposure_;
};

}  // namespace relief
