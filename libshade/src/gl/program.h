// SPDX-License-Identifier: Apache-2.0
/// \file
/// Programs: from shader source to a linked program and its active variables.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl/api.h"

namespace relief::shade::gl {

/// The place of a vertex attribute or of a fragment output.
struct Location {
    std::string name;
    GLuint location = 0;
};

/// The sources of a program.
struct ProgramSources {
    std::string name;  ///< For messages: "surface (normal map, 2 point lights)".
    std::string vertex;
    std::string fragment;
    std::vector<Location> attributes;  ///< The driver places the others.
    std::vector<Location> outputs;     ///< Empty: the one output is at 0.
};

/// One active variable of a program. Arrays are named without "[0]".
struct ActiveVariable {
    std::string name;
    GLenum type = 0;      ///< GL_FLOAT_VEC3, GL_SAMPLER_2D, ...
    GLint size = 1;       ///< Elements of an array, else 1.
    GLint location = -1;  ///< -1 if it has none.
};

/// The active variables of a program, each list sorted by name.
struct ProgramInterface {
    std::vector<ActiveVariable> attributes;  ///< Without built-in ones such as gl_VertexID.
    std::vector<ActiveVariable> uniforms;    ///< Without those in blocks and without samplers.
    std::vector<ActiveVariable> samplers;
    std::vector<std::string> uniform_blocks;
};

/// A linked program. Uniforms are set by name while the program is current (use()).
class LinkedProgram {
  public:
    /// \throws GpuError with the driver's log if a stage does not compile or the program does not
    /// link: "program 'NAME': fragment shader: 0:12(3): error: ..."
    LinkedProgram(const Api& api, const ProgramSources& sources);

    [[nodiscard]] GLuint name() const { return program_.name(); }
    [[nodiscard]] const ProgramInterface& interface() const { return interface_; }

    /// Makes the program current.
    void use() const;

    /// Sets a uniform of the current program. Returns false without effect if the program has no
    /// such uniform, because an effect is left out or the driver removed an unused variable.
    /// \throws GpuError if the uniform's type differs
    bool set(std::string_view name, int value) const;  ///< int, or the unit of a sampler.
    bool set(std::string_view name, const glm::ivec3& value) const;
    bool set(std::string_view name, float value) const;
    bool set(std::string_view name, const glm::vec2& value) const;
    bool set(std::string_view name, const glm::vec3& value) const;
    bool set(std::string_view name, const glm::vec4& value) const;
    bool set(std::string_view name, const glm::mat3& value) const;
    bool set(std::string_view name, const glm::mat4& value) const;
    bool set(std::string_view name, std::span<const glm::vec4> values) const;

    /// Connects a uniform block to a binding point; false if the program has no such block.
    bool bind_block(std::string_view name, GLuint binding) const;

  private:
    const ActiveVariable* uniform(std::string_view name, GLenum type) const;

    const Api* api_;
    std::string label_;
    Program program_;
    ProgramInterface interface_;
};

}  // namespace relief::shade::gl
