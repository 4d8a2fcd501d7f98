// SPDX-License-Identifier: Apache-2.0
/// \file
/// Linked programs by their Features, and the bindings that all programs share: attribute
/// locations, texture units, and the binding point of the lights. Tests:
/// tests/shade/render/render_cache_test.cpp.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "effects/shader_source.h"
#include "gl/program.h"
#include "relief/shade/effects.h"
#include "relief/shade/shader_texts.h"

namespace relief::shade::detail {

/// Vertex attributes, by GLSL name.
enum class Attribute : GLuint {
    position_object,
    normal_object,
    texcoord,
    tangent_object,
    color_linear,
    texcoord_2
};

/// Texture units, by the GLSL names of samplers. Those of materials come first: TextureSlot.
enum class TextureUnit : GLint {
    environment = texture_slot_count,
    blurred_environment,
    environment_brdf,
    light_buffer,
    shadow_maps,
    behind,
    joint_matrices,
    joint_weights,
    morph_weights,
    morph_displacements,
    facet_corners,
    hidden_shares,
    drawn,
};

/// The binding point of the uniform block Lights.
inline constexpr GLuint lights_binding = 0;

/// A program and its planned uniforms.
struct DrawProgram {
    gl::LinkedProgram linked;
    PlannedInterface planned;
};

/// Links two stages with the bindings above.
/// \throws GpuError with the driver's log, in which lines name shader files
gl::LinkedProgram link(const gl::Api& api, const std::string& name, const ShaderSource& vertex,
                       const ShaderSource& fragment);

/// True if the vertex stage samples the texture of a unit: data by vertex or joint.
constexpr bool is_vertex_texture(TextureUnit unit) {
    return unit >= TextureUnit::joint_matrices && unit <= TextureUnit::hidden_shares;
}

/// Checks that a program does not sample more textures than a fragment shader can. OpenGL 3.3
/// guarantees 16; surfaces with nearly all textures of glTF's extensions need more.
/// \param where  for the message
/// \throws GpuError with the names of the samplers
void check_texture_units(const PlannedInterface& planned, int available,
                         std::string_view where = "this OpenGL driver");

class ProgramCache {
  public:
    /// \param texts  replace parts of the shaders, and outlive all calls of get()
    explicit ProgramCache(const gl::Api& api, const ShaderTexts& texts = no_texts())
        : api_(&api), texts_(&texts) {}

    /// Returns the program for canonical features, linked on first use.
    /// \throws GpuError if it does not link, or samples more textures than the driver allows
    std::shared_ptr<const DrawProgram> get(const Features& features);

    /// Returns a program that draws no surface, from the parts "vertex" and "fragment" of
    /// NAME.glsl.
    std::shared_ptr<const gl::LinkedProgram> get(const std::string& name, const ShaderSteps& steps);

    /// Removes all programs from the cache; their owners keep them.
    void clear();

    [[nodiscard]] std::size_t size() const { return programs_.size(); }

    /// Returns the wall-clock time of assembling, compiling and linking surface programs so far.
    [[nodiscard]] double milliseconds() const { return milliseconds_; }

  private:
    static const ShaderTexts& no_texts();

    const gl::Api* api_;
    const ShaderTexts* texts_;
    std::map<Features, std::shared_ptr<const DrawProgram>> programs_;
    std::map<std::pair<std::string, ShaderSteps>, std::shared_ptr<const gl::LinkedProgram>> others_;
    double milliseconds_ = 0;
};

/// The programs of one context by the texts that replace parts of their shaders.
class ProgramCaches {
  public:
    explicit ProgramCaches(const gl::Api& api) : api_(&api), plain_(api) {}

    /// Returns the programs of these texts, which the caller keeps alive; null: those of the files.
    /// Programs of texts that nobody keeps are removed.
    ProgramCache& with(const std::shared_ptr<const ShaderTexts>& texts);

    void clear();

    [[nodiscard]] std::size_t size() const;

  private:
    const gl::Api* api_;
    ProgramCache plain_;
    std::map<std::weak_ptr<const ShaderTexts>, ProgramCache, std::owner_less<>> edited_;
};

}  // namespace relief::shade::detail
