// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sections, textures, samplers, programs, meshes and surfaces, which the pictures of a page share;
/// each is stored once. Textures and buffers are read back from OpenGL, image files are taken as
/// the scene has them. Tests: tests/tools/view_page/view_page_test.cpp.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "effects/shader_source.h"
#include "gl/api.h"
#include "gl/program.h"
#include "relief/shade/image_source.h"
#include "relief/shade/page.h"

namespace relief::shade::detail {

/// The places of the different values of a list.
template <typename T>
class Places {
  public:
    /// Returns the place of a value, which is added to the list if it is new.
    std::size_t add(std::vector<T>& list, T value) {
        const auto [known, is_new] = places_.try_emplace(value, list.size());
        if (is_new) list.push_back(std::move(value));
        return known->second;
    }

  private:
    std::map<T, std::size_t> places_;
};

class PageContent {
  public:
    explicit PageContent(const gl::Api& api) : api_(&api) {}

    std::size_t section(std::vector<std::byte> bytes);
    /// Stores a program as its stages, and their parts.
    std::size_t program(const SurfaceProgram& program, const ShaderTexts& texts);
    std::size_t surface(PageSurface surface);

    /// Names the image that a texture was made of. Its file is stored if browsers decode it to the
    /// same samples.
    void name_image(GLuint texture, const ImageSource& source) { images_[texture] = &source; }

    /// Stores the texture that is bound to a unit, with its sampler.
    /// \param type  of the sampler: GL_SAMPLER_2D or GL_SAMPLER_CUBE
    PageLookup lookup(GLint unit, GLenum type);

    /// Stores the buffer texture that is bound to a unit.
    std::size_t rows(GLint unit, int channels);

    /// Stores the attributes that a program reads from the bound vertex array, and its triangles.
    std::size_t mesh(const gl::LinkedProgram& program);

    /// Returns the values of the current program's uniforms, except for those of these names.
    [[nodiscard]] std::map<std::string, std::vector<float>> values(
        const gl::LinkedProgram& program, std::span<const std::string_view> except) const;

    PageDescription description;

  private:
    PageStage stage(const ShaderSource& source, const ShaderTexts& texts);
    std::size_t map(GLuint texture);
    std::size_t cube();
    PageSampler sampler(GLint unit, GLenum target) const;
    std::size_t stored_buffer(GLuint name);
    [[nodiscard]] std::vector<std::byte> buffer(GLuint name) const;

    const gl::Api* api_;
    std::map<GLuint, const ImageSource*> images_;
    std::map<GLuint, std::size_t> textures_;  ///< By OpenGL's name.
    std::map<GLuint, std::size_t> buffers_;
    Places<PageProgram> programs_;
    Places<PageSurface> surfaces_;
    Places<PageSampler> samplers_;
    Places<PageMesh> meshes_;
    std::unordered_multimap<std::size_t, std::size_t> sections_;  ///< By the hash of the bytes.
};

}  // namespace relief::shade::detail
