// SPDX-License-Identifier: Apache-2.0
// Reads textures, samplers, vertex arrays and uniforms back. Cube maps of floats are stored as
// RGB9E5, whose error is at most 1/1024 of the largest channel, a quarter of an 8-bit code.
#include "page/page_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>

#include "files.h"
#include "gl/cube_map.h"
#include "relief/mesh/report.h"

namespace relief::shade::detail {

namespace {

template <typename T>
std::vector<std::byte> bytes_of(std::span<const T> values) {
    const auto bytes = std::as_bytes(values);
    return {bytes.begin(), bytes.end()};
}

// Image files

std::vector<std::byte> file_of(const ImageSource& source) {
    if (const auto* bytes = std::get_if<Shared<std::vector<std::byte>>>(&source.source))
        return **bytes;
    const auto* path = std::get_if<std::filesystem::path>(&source.source);
    if (path == nullptr) return {};
    return bytes_of(std::span<const char>(relief::detail::read_file(*path)));
}

bool begins_with(std::span<const std::byte> file, std::string_view start, std::size_t at = 0) {
    return file.size() >= at + start.size() &&
           std::memcmp(file.data() + at, start.data(), start.size()) == 0;
}

bool contains(std::span<const std::byte> bytes, std::string_view word) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.find(word) != std::string_view::npos;
}

/// Tells whether browsers decode a file to the samples that relief does: PNG of up to 8 bits per
/// sample, and JPEG of one or three channels without an orientation. Color profiles are ignored.
bool is_same_in_browsers(std::span<const std::byte> file) {
    constexpr std::size_t bit_depth = 24;
    if (begins_with(file, "\x89PNG\r\n\x1a\n")) {
        return file.size() > bit_depth && static_cast<int>(file[bit_depth]) <= 8 &&
               !contains(file.first(std::min<std::size_t>(file.size(), 4096)), "acTL");
    }
    if (!begins_with(file, "\xff\xd8\xff")) return false;
    // Adobe's segment belongs to files of four channels, and to some that are not YCbCr.
    const auto start = file.first(std::min<std::size_t>(file.size(), 1 << 16));
    return !contains(start, "Exif") && !contains(start, "Adobe");
}

// Texels

/// The memory of the samples of an internal format.
struct Samples {
    PageTexels texels = PageTexels::bits_8;
    int channels = 4;
    bool is_srgb = false;
};

Samples samples_of(GLint format) {
    switch (format) {
        case GL_SRGB8:
            return {PageTexels::bits_8, 3, true};
        case GL_SRGB8_ALPHA8:
            return {PageTexels::bits_8, 4, true};
        case GL_R8:
            return {PageTexels::bits_8, 1};
        case GL_RG8:
            return {PageTexels::bits_8, 2};
        case GL_RGB8:
            return {PageTexels::bits_8, 3};
        case GL_RGBA8:
            return {PageTexels::bits_8, 4};
        case GL_R16:
            return {PageTexels::bits_16, 1};
        case GL_RG16:
            return {PageTexels::bits_16, 2};
        case GL_RGB16:
            return {PageTexels::bits_16, 3};
        case GL_RGBA16:
            return {PageTexels::bits_16, 4};
        case GL_R16F:
        case GL_R32F:
            return {PageTexels::floats, 1};
        case GL_RG16F:
        case GL_RG32F:
            return {PageTexels::floats, 2};
        case GL_RGB16F:
        case GL_RGB32F:
            return {PageTexels::floats, 3};
        case GL_RGBA16F:
        case GL_RGBA32F:
            return {PageTexels::floats, 4};
        default:
            throw GpuError(fmt::format("a page cannot store the texture format 0x{:x}", format));
    }
}

std::size_t sample_bytes(PageTexels texels) {
    return texels == PageTexels::floats ? 4 : texels == PageTexels::bits_16 ? 2 : 1;
}

/// The format with a shared exponent of OpenGL 3.3, section 3.8.3: nine bits per channel.
std::uint32_t rgb9e5(const float* rgb) {
    constexpr int bias = 15;
    constexpr int bits = 9;
    static constexpr float largest = 65408.0F;
    const auto clamped = [](float value) { return value > 0.0F ? std::min(value, largest) : 0.0F; };
    const std::array<float, 3> c = {clamped(rgb[0]), clamped(rgb[1]), clamped(rgb[2])};
    const float most = std::max({c[0], c[1], c[2]});
    if (most <= 0.0F) return 0;
    int exponent = std::max(-bias - 1, std::ilogb(most)) + 1 + bias;
    const auto code = [&](float value) {
        return static_cast<std::uint32_t>(
            std::floor(std::ldexp(value, bits + bias - exponent) + 0.5F));
    };
    if (code(most) == 1U << bits) ++exponent;
    return code(c[0]) | code(c[1]) << 9U | code(c[2]) << 18U |
           static_cast<std::uint32_t>(exponent) << 27U;
}

GLint level_parameter(const gl::Api& api, GLenum target, GLint level, GLenum parameter) {
    GLint value = 0;
    api->GetTexLevelParameteriv(target, level, parameter, &value);
    return value;
}

/// Returns the lookups that were changed after the parts were assembled, by the text in the parts
/// (surface_program.cpp).
std::map<std::string, std::string> changed_lookups(const std::string& text) {
    constexpr std::string_view in_parts = ", texcoord_surface";
    std::map<std::string, std::string> lookups;
    const auto add = [&](const std::string& call, const std::string& coordinates) {
        for (std::size_t at = text.find(coordinates); at != std::string::npos;
             at = text.find(coordinates, at + 1)) {
            const std::size_t begin = text.rfind(call, at);
            const std::size_t end = text.find(')', at);
            const std::size_t sampler = begin + call.size();
            const std::string name = text.substr(sampler, at - sampler);
            if (name.find_first_of("(), ;") != std::string::npos) continue;
            lookups[fmt::format("texture({}{})", name, in_parts)] =
                text.substr(begin, end + 1 - begin);
        }
    };
    add("texture(", ", texcoord_surface_2)");
    add("textureGrad(", ", texcoord_displaced,");
    add("textureGrad(", ", texcoord_displaced_2,");
    return lookups;
}

}  // namespace

std::size_t PageContent::section(std::vector<std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t hash = std::hash<std::string_view>()(text);
    const auto [first, last] = sections_.equal_range(hash);
    for (auto entry = first; entry != last; ++entry) {
        if (description.sections[entry->second] == bytes) return entry->second;
    }
    sections_.emplace(hash, description.sections.size());
    description.sections.push_back(std::move(bytes));
    return description.sections.size() - 1;
}

PageStage PageContent::stage(const ShaderSource& source, const ShaderTexts& texts) {
    const auto store = [&](const std::string& address) {
        const auto [part, is_new] = description.parts.try_emplace(address);
        if (is_new) part->second = shader_part_text(address, texts).text;
    };
    for (const std::string& part : source.parts)
        store(part);
    for (const auto& [step, part] : source.steps)
        store(part);
    return {source.text.substr(0, source.head_size), source.main, source.steps,
            changed_lookups(source.text)};
}

std::size_t PageContent::program(const SurfaceProgram& program, const ShaderTexts& texts) {
    return programs_.add(description.programs,
                         {stage(program.vertex, texts), stage(program.fragment, texts)});
}

std::size_t PageContent::surface(PageSurface surface) {
    return surfaces_.add(description.surfaces, std::move(surface));
}

PageSampler PageContent::sampler(GLint unit, GLenum target) const {
    const gl::Api& gl = *api_;
    GLint object = 0;
    gl->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl->GetIntegerv(GL_SAMPLER_BINDING, &object);
    const auto number = [&](GLenum parameter) {
        GLint value = 0;
        if (object != 0) {
            gl->GetSamplerParameteriv(static_cast<GLuint>(object), parameter, &value);
        } else {
            gl->GetTexParameteriv(target, parameter, &value);
        }
        return static_cast<unsigned>(value);
    };
    PageSampler sampler{number(GL_TEXTURE_WRAP_S), number(GL_TEXTURE_WRAP_T),
                        number(GL_TEXTURE_MIN_FILTER), number(GL_TEXTURE_MAG_FILTER)};
    if (gl.limits().anisotropy > 1.0F)
        sampler.anisotropy = static_cast<float>(number(GL_TEXTURE_MAX_ANISOTROPY));
    return sampler;
}

std::size_t PageContent::map(GLuint name) {
    const gl::Api& gl = *api_;
    const Samples samples =
        samples_of(level_parameter(gl, GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT));
    PageTexture texture;
    texture.texels = samples.texels;
    texture.is_srgb = samples.is_srgb;
    texture.channels = samples.channels;
    texture.width = level_parameter(gl, GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH);
    texture.height = level_parameter(gl, GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT);
    GLint last = 0;
    gl->GetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, &last);
    texture.has_levels = last > 0;
    std::array<GLint, 4> swizzle{};
    gl->GetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, swizzle.data());
    texture.is_gray = samples.channels <= 2 && swizzle[1] == GL_RED;
    if (const auto image = images_.find(name); image != images_.end()) {
        texture.image = image->second->name;
        std::vector<std::byte> file;
        if (samples.texels == PageTexels::bits_8) file = file_of(*image->second);
        if (is_same_in_browsers(file)) {
            texture.texels = PageTexels::encoded;
            texture.section = section(std::move(file));
        }
    }
    if (texture.texels != PageTexels::encoded) {
        constexpr std::array<GLenum, 4> layouts{GL_RED, GL_RG, GL_RGB, GL_RGBA};
        const GLenum type = samples.texels == PageTexels::floats    ? GL_FLOAT
                            : samples.texels == PageTexels::bits_16 ? GL_UNSIGNED_SHORT
                                                                    : GL_UNSIGNED_BYTE;
        const auto channels = static_cast<std::size_t>(samples.channels);
        std::vector<std::byte> texels(static_cast<std::size_t>(texture.width) *
                                      static_cast<std::size_t>(texture.height) * channels *
                                      sample_bytes(samples.texels));
        gl->GetTexImage(GL_TEXTURE_2D, 0, layouts.at(channels - 1), type, texels.data());
        texture.section = section(std::move(texels));
    }
    description.textures.push_back(texture);
    return description.textures.size() - 1;
}

std::size_t PageContent::cube() {
    const gl::Api& gl = *api_;
    const GLenum first = gl::cube_face_target(0);
    const Samples samples = samples_of(level_parameter(gl, first, 0, GL_TEXTURE_INTERNAL_FORMAT));
    PageTexture texture;
    texture.kind = PageTexture::Kind::cube;
    const bool has_codes = samples.texels == PageTexels::bits_8;
    texture.texels = has_codes ? PageTexels::bits_8 : PageTexels::rgb9e5;
    texture.is_srgb = samples.is_srgb;
    texture.channels = 3;
    texture.width = texture.height = level_parameter(gl, first, 0, GL_TEXTURE_WIDTH);
    GLint last = 0;
    gl->GetTexParameteriv(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAX_LEVEL, &last);
    const int levels = std::min(last + 1, gl::level_count(texture.width));
    texture.has_levels = levels > 1;
    std::vector<std::byte> all;
    for (int level = 0; level < levels; ++level) {
        const auto side = static_cast<std::size_t>(std::max(texture.width >> level, 1));
        for (std::size_t face = 0; face < 6; ++face) {
            const GLenum target = gl::cube_face_target(face);
            if (has_codes) {
                std::vector<std::byte> codes(side * side * 3);
                gl->GetTexImage(target, level, GL_RGB, GL_UNSIGNED_BYTE, codes.data());
                all.insert(all.end(), codes.begin(), codes.end());
                continue;
            }
            std::vector<float> radiance(side * side * 3);
            gl->GetTexImage(target, level, GL_RGB, GL_FLOAT, radiance.data());
            std::vector<std::uint32_t> texels(side * side);
            for (std::size_t i = 0; i < texels.size(); ++i)
                texels[i] = rgb9e5(&radiance[3 * i]);
            const auto bytes = std::as_bytes(std::span(texels));
            all.insert(all.end(), bytes.begin(), bytes.end());
        }
    }
    texture.section = section(std::move(all));
    description.textures.push_back(texture);
    return description.textures.size() - 1;
}

PageLookup PageContent::lookup(GLint unit, GLenum type) {
    const gl::Api& gl = *api_;
    const bool is_cube = type == GL_SAMPLER_CUBE;
    const GLenum target = is_cube ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D;
    gl->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    GLint bound = 0;
    gl->GetIntegerv(is_cube ? GL_TEXTURE_BINDING_CUBE_MAP : GL_TEXTURE_BINDING_2D, &bound);
    const auto name = static_cast<GLuint>(bound);
    PageLookup lookup;
    lookup.sampler = samplers_.add(description.samplers, sampler(unit, target));
    if (const auto known = textures_.find(name); known != textures_.end()) {
        lookup.texture = known->second;
    } else {
        lookup.texture = is_cube ? cube() : map(name);
        textures_.emplace(name, lookup.texture);
    }
    gl.check("reading a texture for a page");
    return lookup;
}

std::vector<std::byte> PageContent::buffer(GLuint name) const {
    const gl::Api& gl = *api_;
    gl->BindBuffer(GL_COPY_READ_BUFFER, name);
    GLint64 size = 0;
    gl->GetBufferParameteri64v(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &size);
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    if (size > 0)
        gl->GetBufferSubData(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(size), bytes.data());
    gl->BindBuffer(GL_COPY_READ_BUFFER, 0);
    return bytes;
}

std::size_t PageContent::stored_buffer(GLuint name) {
    const auto known = buffers_.find(name);
    if (known != buffers_.end()) return known->second;
    return buffers_.emplace(name, section(buffer(name))).first->second;
}

std::size_t PageContent::rows(GLint unit, int channels) {
    const gl::Api& gl = *api_;
    gl->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    GLint bound = 0;
    gl->GetIntegerv(GL_TEXTURE_BINDING_BUFFER, &bound);
    const auto name = static_cast<GLuint>(bound);
    if (const auto known = textures_.find(name); known != textures_.end()) return known->second;
    GLint source = 0;
    gl->GetIntegerv(GL_TEXTURE_BUFFER_DATA_STORE_BINDING, &source);
    std::vector<std::byte> texels = buffer(static_cast<GLuint>(source));
    PageTexture texture;
    texture.kind = PageTexture::Kind::rows;
    texture.texels = PageTexels::floats;
    texture.channels = channels;
    texture.width = static_cast<int>(texels.size() / (4 * static_cast<std::size_t>(channels)));
    texture.section = section(std::move(texels));
    description.textures.push_back(texture);
    textures_.emplace(name, description.textures.size() - 1);
    gl.check("reading a buffer texture for a page");
    return description.textures.size() - 1;
}

std::size_t PageContent::mesh(const gl::LinkedProgram& program) {
    const gl::Api& gl = *api_;
    PageMesh mesh;
    for (const gl::ActiveVariable& attribute : program.interface().attributes) {
        const auto location = static_cast<GLuint>(attribute.location);
        GLint is_enabled = 0;
        gl->GetVertexAttribiv(location, GL_VERTEX_ATTRIB_ARRAY_ENABLED, &is_enabled);
        if (is_enabled == 0) continue;
        GLint components = 0;
        GLint source = 0;
        gl->GetVertexAttribiv(location, GL_VERTEX_ATTRIB_ARRAY_SIZE, &components);
        gl->GetVertexAttribiv(location, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING, &source);
        mesh.streams.push_back(
            {attribute.name, components, stored_buffer(static_cast<GLuint>(source))});
    }
    GLint triangles = 0;
    gl->GetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &triangles);
    mesh.triangles = triangles == 0 ? section({}) : stored_buffer(static_cast<GLuint>(triangles));
    gl.check("reading a mesh for a page");
    return meshes_.add(description.meshes, std::move(mesh));
}

std::map<std::string, std::vector<float>> PageContent::values(
    const gl::LinkedProgram& program, std::span<const std::string_view> except) const {
    const gl::Api& gl = *api_;
    std::map<std::string, std::vector<float>> values;
    for (const gl::ActiveVariable& uniform : program.interface().uniforms) {
        if (std::find(except.begin(), except.end(), uniform.name) != except.end()) continue;
        const std::optional<std::size_t> components = [&]() -> std::optional<std::size_t> {
            switch (uniform.type) {
                case GL_FLOAT:
                    return 1;
                case GL_FLOAT_VEC2:
                    return 2;
                case GL_FLOAT_VEC3:
                    return 3;
                case GL_FLOAT_VEC4:
                    return 4;
                case GL_FLOAT_MAT3:
                    return 9;
                case GL_FLOAT_MAT4:
                    return 16;
                default:
                    return std::nullopt;
            }
        }();
        if (!components) continue;
        std::vector<float>& all = values[uniform.name];
        all.resize(*components * static_cast<std::size_t>(uniform.size));
        for (int i = 0; i < uniform.size; ++i) {
            const std::string name =
                uniform.size == 1 ? uniform.name : fmt::format("{}[{}]", uniform.name, i);
            gl->GetUniformfv(program.name(), gl->GetUniformLocation(program.name(), name.c_str()),
                             all.data() + *components * static_cast<std::size_t>(i));
        }
    }
    return values;
}

}  // namespace relief::shade::detail
