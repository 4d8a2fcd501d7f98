// SPDX-License-Identifier: Apache-2.0
/// \file
/// Texture lookups in double precision, as OpenGL defines them at full resolution: bilinear between
/// texel centres or nearest, with all three ways to go on beyond the border. Colours are decoded
/// from sRGB before they are filtered; (0,0) is the upper left corner, v grows downwards. A
/// coordinate that is not finite looks up NaN. Source: OpenGL 3.3, section 3.8.
/// Tests: tests/shade/reference/texels_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "reference/trace.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/scene.h"

namespace relief::reference {

/// An image as RGBA: grey as (g, g, g, 1), grey with alpha as (g, g, g, a), RGB as (r, g, b, 1).
class Texels {
  public:
    Texels() = default;
    explicit Texels(const Image& image);

    [[nodiscard]] int width() const { return image_.width; }
    [[nodiscard]] int height() const { return image_.height; }

    [[nodiscard]] glm::dvec4 at(int x, int y) const;
    [[nodiscard]] glm::dvec4 bilinear(const glm::dvec2& uv, TextureWrap u, TextureWrap v) const;
    [[nodiscard]] glm::dvec4 nearest(const glm::dvec2& uv, TextureWrap u, TextureWrap v,
                                     Trace& trace) const;

  private:
    Image image_;  ///< Linear float.
};

/// The index that a texel index beyond the border stands for.
int wrapped(double index, int size, TextureWrap wrap);

/// The images that a scene's materials look up, decoded once for each use.
class SceneTexels {
  public:
    /// Decodes a material's images. Those that cannot be read are in unreadable().
    /// \throws FileError if an image that is required cannot be read
    void want(const Scene& scene, const Material& material);

    /// By index of the image, what is wrong with it.
    [[nodiscard]] const std::map<std::size_t, std::string>& unreadable() const {
        return unreadable_;
    }

    [[nodiscard]] const Texels& get(std::size_t image, ImageUse use) const {
        return texels_.at({image, use});
    }
    [[nodiscard]] glm::dvec4 look_up(const Texture& texture, ImageUse use, const glm::dvec2& uv,
                                     Trace& trace) const;

  private:
    std::map<std::pair<std::size_t, ImageUse>, Texels> texels_;
    std::map<std::size_t, std::string> unreadable_;
};

}  // namespace relief::reference
