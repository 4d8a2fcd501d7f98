// SPDX-License-Identifier: Apache-2.0
/// \file
/// The images that the plan calls for, decoded on all threads and uploaded once each.
/// Tests: tests/shade/render/renderer_test.cpp.
#pragma once

#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "gl/texture.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/scene.h"

namespace relief {

/// Images of a scene in memory, by what they are read for.
class DecodedImages {
  public:
    /// \throws FileError if one cannot be read
    void want(std::size_t image, ImageUse use) { images_.try_emplace({image, use}); }
    void decode_all(const std::vector<ImageSource>& sources);

    [[nodiscard]] const Image& get(std::size_t image, ImageUse use) const {
        return images_.at({image, use});
    }
    [[nodiscard]] const auto& all() const { return images_; }

  private:
    std::map<std::pair<std::size_t, ImageUse>, Image> images_;
};

/// A texture and its sampler, to be bound to one unit.
struct BoundTexture {
    GLuint texture = 0;
    GLuint sampler = 0;
};

/// Textures and samplers, and the neutral ones that stand in where a plan names a texture that a
/// material does not have: white, and flat.
class SceneTextures {
  public:
    explicit SceneTextures(const gl::Api& api) : api_(&api) {}

    /// Uploads every decoded image. \throws GpuError
    void upload(const DecodedImages& images, const std::vector<ImageSource>& sources);

    BoundTexture get(const Texture& texture, ImageUse use);
    BoundTexture white();
    BoundTexture flat();  ///< Looks up as (0, 0, 1).

    [[nodiscard]] std::size_t size() const { return textures_.size(); }

  private:
    GLuint sampler(TextureWrap u, TextureWrap v, TextureFilter filter);
    BoundTexture constant(std::optional<gl::Texture>& texture, float rg, float b, const char* name);

    const gl::Api* api_;
    std::map<std::pair<std::size_t, ImageUse>, gl::Texture> textures_;
    std::map<std::tuple<TextureWrap, TextureWrap, TextureFilter>, gl::Sampler> samplers_;
    std::optional<gl::Texture> white_;
    std::optional<gl::Texture> flat_;
};

/// Which stored code of a normal map stands for zero: as the material says, as the file's text
/// says, or as the image looks.
FlatCode flat_code_of(const NormalMap& map, const Image& image, const ImageSource& source);

}  // namespace relief
