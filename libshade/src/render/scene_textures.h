// SPDX-License-Identifier: Apache-2.0
/// \file
/// The images that one scene's plan calls for: those that a cache does not have are decoded on all
/// threads and uploaded once each. Tests: tests/shade/render/renderer_test.cpp.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/shade/scene.h"
#include "render/texture_cache.h"

namespace relief {

class SceneTextures {
  public:
    explicit SceneTextures(TextureCache& cache) : cache_(&cache) {}

    void want(std::size_t image, const ImagePurpose& purpose) {
        images_.try_emplace({image, purpose});
    }

    /// Decodes what is wanted and not in the cache. Images that cannot be read are not wanted any
    /// more.
    /// \return those images, by index, each with what is wrong
    /// \throws FileError if an image that is required cannot be read
    std::map<std::size_t, std::string> decode(const std::vector<ImageSource>& sources);

    /// Uploads what was decoded. \throws GpuError
    void upload(const std::vector<ImageSource>& sources);

    [[nodiscard]] const GpuImage& image(std::size_t image, const ImagePurpose& purpose) const {
        return *images_.at({image, purpose});
    }
    [[nodiscard]] BoundTexture bound(const Texture& texture, const ImagePurpose& purpose) const {
        return {image(texture.image, purpose).texture.name(),
                cache_->sampler(texture.wrap_u, texture.wrap_v, texture.filter)};
    }

    [[nodiscard]] std::size_t size() const { return images_.size(); }

  private:
    using Key = std::pair<std::size_t, ImagePurpose>;

    std::vector<std::string> decode_all(const std::vector<ImageSource>& sources);

    TextureCache* cache_;
    std::map<Key, std::shared_ptr<const GpuImage>> images_;
    std::vector<std::pair<Key, Image>> decoded_;
};

}  // namespace relief
