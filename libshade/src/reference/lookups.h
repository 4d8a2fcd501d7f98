// SPDX-License-Identifier: Apache-2.0
/// \file
/// Texture and environment lookups in double precision, as OpenGL defines them at full resolution,
/// straight from the images: bilinear between texel centers or nearest, with all three wrap modes.
/// Colors are decoded from sRGB before they are filtered; (0,0) is the upper left corner, v grows
/// downwards. A coordinate that is not finite looks up NaN. The environment's images are laid out
/// as scene.h says; faces as in environment/environment_images.h. World space, linear light.
/// Source: OpenGL 3.3, section 3.8.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "environment/convolution.h"
#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"

namespace relief {
namespace RELIEF_API reference {

/// The record of a ray on its way to a color: every discrete decision (which texel, which side of a
/// light), and every place in a texture. Rays whose decisions differ may differ by a jump, so that
/// rounding may decide what is seen; places that lie far apart mean a texture that OpenGL averages.
class Trace {
  public:
    void decide(std::int64_t decision) {
        constexpr std::uint64_t fnv_prime = 0x100000001B3ULL;
        hash_ = (hash_ ^ static_cast<std::uint64_t>(decision)) * fnv_prime;
        hash_ ^= hash_ >> 29;
    }

    /// \param texels  the place of a lookup in texels; for a cube map, a direction whose length is
    ///                the number of texels in a radian
    void look_up(const glm::dvec3& texels) { places_.push_back(texels); }

    [[nodiscard]] bool decided_like(const Trace& other) const {
        return hash_ == other.hash_ && places_.size() == other.places_.size();
    }
    [[nodiscard]] const std::vector<glm::dvec3>& places() const { return places_; }

  private:
    std::uint64_t hash_ = 0xCBF29CE484222325ULL;
    std::vector<glm::dvec3> places_;
};

/// An image as RGBA: gray as (g, g, g, 1), gray with alpha as (g, g, g, a), RGB as (r, g, b, 1).
class Texels {
  public:
    Texels() = default;
    explicit Texels(const Image& image);

    [[nodiscard]] int width() const { return image_.width; }
    [[nodiscard]] int height() const { return image_.height; }

    [[nodiscard]] glm::dvec4 at(int x, int y) const;
    [[nodiscard]] glm::dvec4 bilinear(const glm::dvec2& uv, Wrap u, Wrap v) const;
    [[nodiscard]] glm::dvec4 nearest(const glm::dvec2& uv, Wrap u, Wrap v, Trace& trace) const;

  private:
    Image image_;  ///< Linear float.
};

/// Returns the index within the image of a texel index beyond its border.
int wrapped(double index, int size, Wrap wrap);

/// The images that the materials of a scene look up, decoded once for each use.
class SceneTexels {
  public:
    /// Decodes a material's images. Those that cannot be read are in unreadable().
    /// \throws FileError if an image that is required cannot be read
    void request(const Scene& scene, const Material& material);

    /// Returns the error of each unreadable image, by its index.
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

class EnvironmentLookup {
  public:
    /// \param report  counts samples that half floats cannot hold (storable_radiance)
    /// \throws FileError if an image cannot be read; InvalidInput if images do not fit together
    EnvironmentLookup(const Environment& environment, Report& report);

    /// \param direction_world  of any length but 0
    [[nodiscard]] glm::dvec3 radiance(const glm::dvec3& direction_world) const;

    /// Returns the same radiance, and records the lookup in a trace.
    [[nodiscard]] glm::dvec3 looked_up(const glm::dvec3& direction_world, Trace& trace) const;

    /// Returns the reflection in a surface whose microfacets have GGX's distribution, with normal
    /// and eye along the direction: the mean over directions l, mirrored at normals h that are
    /// sampled from the distribution, weighted by n.l.
    /// \param roughness  0 is a mirror
    [[nodiscard]] glm::dvec3 blurred(const glm::dvec3& direction_world, double roughness,
                                     Trace& trace) const;

    /// Returns the irradiance over pi on a surface of this normal, by spherical harmonics of order
    /// 2 [Ramamoorthi and Hanrahan 2001]; 0 if their sum is negative.
    [[nodiscard]] glm::dvec3 diffuse(const glm::dvec3& normal_world) const;

  private:
    enum class Layout { faces, equirectangular, angular };

    [[nodiscard]] glm::dvec3 face_texel(std::size_t face, int x, int y) const;
    [[nodiscard]] glm::dvec3 face_radiance(const glm::dvec3& direction) const;
    [[nodiscard]] std::vector<Image> faces() const;
    [[nodiscard]] glm::dvec3 texel_mean(std::size_t face, int x, int y, int size) const;

    Layout layout_ = Layout::faces;
    double intensity_ = 1.0;
    std::vector<Texels> images_;  ///< Six faces, or one image.
    IrradianceSh irradiance_{};   ///< Multiplied by the intensity.
};

/// Returns GGX's directional albedo: x multiplies f0, y is added (environment/convolution.h).
glm::dvec2 directional_albedo(double n_dot_v, double roughness);

}  // namespace reference
}  // namespace relief
