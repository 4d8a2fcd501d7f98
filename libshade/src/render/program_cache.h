// SPDX-License-Identifier: Apache-2.0
/// \file
/// Linked programs by the value of their Features, and what all of them agree on: attribute
/// locations, texture units, the binding point of the lights.
/// Tests: tests/shade/render/programs_test.cpp.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "effects/shader_source.h"
#include "gl/program.h"
#include "relief/shade/effects.h"

namespace relief {

/// Vertex attributes, by their GLSL names.
enum class Attribute : GLuint {
    position_object,
    normal_object,
    texcoord,
    tangent_object,
    color_linear
};

/// Texture units, by the samplers' GLSL names. Those of materials come first.
enum class TextureUnit : GLint {
    diffuse_texture,
    specular_texture,
    emission_texture,
    occlusion_texture,
    opacity_texture,
    metallic_roughness_texture,
    normal_texture,
    bump_texture,
    environment,
    blurred_environment,
    environment_brdf,
    light_buffer,
    drawn,
};

/// The sampler that is bound to a unit.
std::string_view sampler_name(TextureUnit unit);

/// How many units materials have.
inline constexpr std::size_t material_unit_count = 8;

/// The binding point of the uniform block Lights.
inline constexpr GLuint lights_binding = 0;

/// A program and the uniforms to set for every draw.
struct DrawProgram {
    gl::LinkedProgram linked;
    PlannedInterface planned;
};

/// Links two stages with everything bound as above.
/// \throws GpuError with the driver's log, its lines named by shader file
gl::LinkedProgram link(const gl::Api& api, const std::string& name, const ShaderSource& vertex,
                       const ShaderSource& fragment);

class ProgramCache {
  public:
    explicit ProgramCache(const gl::Api& api) : api_(&api) {}

    /// The program for these (canonical) features, linked at first use. \throws GpuError
    std::shared_ptr<const DrawProgram> get(const Features& features);

    /// A program that draws no surface: the parts "vertex" and "fragment" of NAME.glsl.
    std::shared_ptr<const gl::LinkedProgram> get(const std::string& name, const ShaderSteps& steps);

    /// Whoever holds a program keeps it.
    void clear();

    [[nodiscard]] std::size_t size() const { return programs_.size(); }

    /// Wall-clock milliseconds that assembling, compiling and linking of surfaces' programs took
    /// so far.
    [[nodiscard]] double milliseconds() const { return milliseconds_; }

  private:
    const gl::Api* api_;
    std::map<Features, std::shared_ptr<const DrawProgram>> programs_;
    std::map<std::pair<std::string, ShaderSteps>, std::shared_ptr<const gl::LinkedProgram>> others_;
    double milliseconds_ = 0;
};

}  // namespace relief
