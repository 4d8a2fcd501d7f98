// SPDX-License-Identifier: Apache-2.0
// Compiles and links programs, and queries their active variables.
#include "gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>

#include "relief/shade/renderer.h"

namespace relief::shade::gl {

namespace {

std::string without_trailing_space(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\0' || text.back() == ' ')) {
        text.pop_back();
    }
    return text.empty() ? "the driver gives no reason" : text;
}

std::string shader_log(const Api& api, GLuint shader) {
    GLint length = 0;
    api->GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    api->GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    return without_trailing_space(log);
}

std::string program_log(const Api& api, GLuint program) {
    GLint length = 0;
    api->GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    api->GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    return without_trailing_space(log);
}

Shader compile(const Api& api, GLenum stage, const std::string& source, const std::string& label) {
    Shader shader(api, stage);
    const char* text = source.data();
    const auto length = static_cast<GLint>(source.size());
    api->ShaderSource(shader.name(), 1, &text, &length);
    api->CompileShader(shader.name());
    GLint compiled = 0;
    api->GetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_FALSE) {
        const std::string log = shader_log(api, shader.name());
        (void)api.take_messages();  // The same log again: this exception reports it.
        throw GpuError(fmt::format("{}: {} shader: {}", label,
                                   stage == GL_VERTEX_SHADER ? "vertex" : "fragment", log));
    }
    return shader;
}

Program link(const Api& api, const ProgramSources& sources, const std::string& label) {
    const Shader vertex = compile(api, GL_VERTEX_SHADER, sources.vertex, label);
    const Shader fragment = compile(api, GL_FRAGMENT_SHADER, sources.fragment, label);
    Program program(api);
    api->AttachShader(program.name(), vertex.name());
    api->AttachShader(program.name(), fragment.name());
    for (const Location& attribute : sources.attributes) {
        api->BindAttribLocation(program.name(), attribute.location, attribute.name.c_str());
    }
    for (const Location& output : sources.outputs) {
        api->BindFragDataLocation(program.name(), output.location, output.name.c_str());
    }
    api->LinkProgram(program.name());
    GLint linked = 0;
    api->GetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (linked == GL_FALSE) {
        const std::string log = program_log(api, program.name());
        (void)api.take_messages();
        throw GpuError(fmt::format("{}: linking: {}", label, log));
    }
    api->DetachShader(program.name(), vertex.name());
    api->DetachShader(program.name(), fragment.name());
    return program;
}

bool is_sampler(GLenum type) {
    switch (type) {
        case GL_SAMPLER_1D:
        case GL_SAMPLER_2D:
        case GL_SAMPLER_3D:
        case GL_SAMPLER_CUBE:
        case GL_SAMPLER_1D_SHADOW:
        case GL_SAMPLER_2D_SHADOW:
        case GL_SAMPLER_CUBE_SHADOW:
        case GL_SAMPLER_2D_ARRAY:
        case GL_SAMPLER_2D_ARRAY_SHADOW:
        case GL_SAMPLER_2D_MULTISAMPLE:
        case GL_SAMPLER_2D_RECT:
        case GL_SAMPLER_BUFFER:
        case GL_INT_SAMPLER_2D:
        case GL_INT_SAMPLER_BUFFER:
        case GL_UNSIGNED_INT_SAMPLER_2D:
        case GL_UNSIGNED_INT_SAMPLER_BUFFER:
            return true;
        default:
            return false;
    }
}

/// The driver names an array after its first element.
std::string without_index(std::string name) {
    if (name.ends_with("[0]")) name.resize(name.size() - 3);
    return name;
}

std::string name_buffer(const Api& api, const Program& program, GLenum length_query) {
    GLint length = 0;
    api->GetProgramiv(program.name(), length_query, &length);
    return std::string(static_cast<std::size_t>(std::max(length, 1)), '\0');
}

std::vector<ActiveVariable> active_attributes(const Api& api, const Program& program) {
    std::string buffer = name_buffer(api, program, GL_ACTIVE_ATTRIBUTE_MAX_LENGTH);
    GLint count = 0;
    api->GetProgramiv(program.name(), GL_ACTIVE_ATTRIBUTES, &count);
    std::vector<ActiveVariable> attributes;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        ActiveVariable attribute;
        api->GetActiveAttrib(program.name(), i, static_cast<GLsizei>(buffer.size()), nullptr,
                             &attribute.size, &attribute.type, buffer.data());
        attribute.name = buffer.c_str();
        attribute.location = api->GetAttribLocation(program.name(), buffer.c_str());
        if (!attribute.name.starts_with("gl_")) attributes.push_back(attribute);
    }
    std::ranges::sort(attributes, {}, &ActiveVariable::name);
    return attributes;
}

/// Returns the uniforms outside blocks, samplers among them.
std::vector<ActiveVariable> active_uniforms(const Api& api, const Program& program) {
    std::string buffer = name_buffer(api, program, GL_ACTIVE_UNIFORM_MAX_LENGTH);
    GLint count = 0;
    api->GetProgramiv(program.name(), GL_ACTIVE_UNIFORMS, &count);
    std::vector<ActiveVariable> uniforms;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        GLint block = -1;
        api->GetActiveUniformsiv(program.name(), 1, &i, GL_UNIFORM_BLOCK_INDEX, &block);
        if (block != -1) continue;
        ActiveVariable uniform;
        api->GetActiveUniform(program.name(), i, static_cast<GLsizei>(buffer.size()), nullptr,
                              &uniform.size, &uniform.type, buffer.data());
        uniform.location = api->GetUniformLocation(program.name(), buffer.c_str());
        uniform.name = without_index(buffer.c_str());
        uniforms.push_back(uniform);
    }
    std::ranges::sort(uniforms, {}, &ActiveVariable::name);
    return uniforms;
}

std::vector<std::string> active_blocks(const Api& api, const Program& program) {
    std::string buffer = name_buffer(api, program, GL_ACTIVE_UNIFORM_BLOCK_MAX_NAME_LENGTH);
    GLint count = 0;
    api->GetProgramiv(program.name(), GL_ACTIVE_UNIFORM_BLOCKS, &count);
    std::vector<std::string> blocks;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        api->GetActiveUniformBlockName(program.name(), i, static_cast<GLsizei>(buffer.size()),
                                       nullptr, buffer.data());
        blocks.emplace_back(buffer.c_str());
    }
    std::ranges::sort(blocks);
    return blocks;
}

ProgramInterface interface_of(const Api& api, const Program& program) {
    ProgramInterface result;
    result.attributes = active_attributes(api, program);
    for (ActiveVariable& uniform : active_uniforms(api, program)) {
        (is_sampler(uniform.type) ? result.samplers : result.uniforms).push_back(uniform);
    }
    result.uniform_blocks = active_blocks(api, program);
    return result;
}

const ActiveVariable* find(const std::vector<ActiveVariable>& variables, std::string_view name) {
    const auto found = std::ranges::lower_bound(variables, name, {}, &ActiveVariable::name);
    return found != variables.end() && found->name == name ? &*found : nullptr;
}

}  // namespace

LinkedProgram::LinkedProgram(const Api& api, const ProgramSources& sources)
    : api_(&api), label_("program '" + sources.name + "'"), program_(link(api, sources, label_)) {
    interface_ = interface_of(api, program_);
    api.check(label_);
}

void LinkedProgram::use() const {
    (*api_)->UseProgram(program_.name());
}

const ActiveVariable* LinkedProgram::uniform(std::string_view name, GLenum type) const {
    const ActiveVariable* found = find(interface_.uniforms, name);
    if (found != nullptr && found->type != type) {
        throw GpuError(
            fmt::format("{}: uniform '{}' has the type 0x{:x}, but a value of type "
                        "0x{:x} is given",
                        label_, name, found->type, type));
    }
    return found;
}

bool LinkedProgram::set(std::string_view name, int value) const {
    const ActiveVariable* sampler = find(interface_.samplers, name);
    const ActiveVariable* found = sampler != nullptr ? sampler : uniform(name, GL_INT);
    if (found == nullptr) return false;
    (*api_)->Uniform1i(found->location, value);
    return true;
}

bool LinkedProgram::set(std::string_view name, const glm::ivec3& value) const {
    const ActiveVariable* found = uniform(name, GL_INT_VEC3);
    if (found == nullptr) return false;
    (*api_)->Uniform3iv(found->location, 1, glm::value_ptr(value));
    return true;
}

bool LinkedProgram::set(std::string_view name, float value) const {
    const ActiveVariable* found = uniform(name, GL_FLOAT);
    if (found == nullptr) return false;
    (*api_)->Uniform1f(found->location, value);
    return true;
}

bool LinkedProgram::set(std::string_view name, const glm::vec2& value) const {
    const ActiveVariable* found = uniform(name, GL_FLOAT_VEC2);
    if (found == nullptr) return false;
    (*api_)->Uniform2fv(found->location, 1, glm::value_ptr(value));
    return true;
}

bool LinkedProgram::set(std::string_view name, const glm::vec3& value) const {
    const ActiveVariable* found = uniform(name, GL_FLOAT_VEC3);
    if (found == nullptr) return false;
    (*api_)->Uniform3fv(found->location, 1, glm::value_ptr(value));
    return true;
}

bool LinkedProgram::set(std::string_view name, const glm::vec4& value) const {
    return set(name, std::span(&value, 1));
}

bool LinkedProgram::set(std::string_view name, const glm::mat3& value) const {
    const ActiveVariable* found = uniform(name, GL_FLOAT_MAT3);
    if (found == nullptr) return false;
    (*api_)->UniformMatrix3fv(found->location, 1, GL_FALSE, glm::value_ptr(value));
    return true;
}

bool LinkedProgram::set(std::string_view name, const glm::mat4& value) const {
    const ActiveVariable* found = uniform(name, GL_FLOAT_MAT4);
    if (found == nullptr) return false;
    (*api_)->UniformMatrix4fv(found->location, 1, GL_FALSE, glm::value_ptr(value));
    return true;
}

bool LinkedProgram::set(std::string_view name, std::span<const glm::vec4> values) const {
    const ActiveVariable* found = uniform(name, GL_FLOAT_VEC4);
    if (found == nullptr) return false;
    if (values.size() > static_cast<std::size_t>(found->size)) {
        throw GpuError(fmt::format("{}: uniform '{}' has {} elements, but {} are given", label_,
                                   name, found->size, values.size()));
    }
    if (values.empty()) return true;
    (*api_)->Uniform4fv(found->location, static_cast<GLsizei>(values.size()),
                        glm::value_ptr(values.front()));
    return true;
}

bool LinkedProgram::bind_block(std::string_view name, GLuint binding) const {
    if (!std::ranges::binary_search(interface_.uniform_blocks, name)) return false;
    const GLuint index = (*api_)->GetUniformBlockIndex(program_.name(), std::string(name).c_str());
    (*api_)->UniformBlockBinding(program_.name(), index, binding);
    return true;
}

}  // namespace relief::shade::gl
