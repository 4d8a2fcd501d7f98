// SPDX-License-Identifier: Apache-2.0
/// \file
/// Traces the rays of a reference picture: the hits of a ray are shaded and composed front to back
/// over the skybox [Porter and Duff 1984]. Linear light, in double.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "reference/recorder.h"
#include "reference/reference_parts.h"
#include "relief/export.h"
#include "relief/shade/reference.h"
#include "scene/scene_parts.h"

namespace relief::shade {
namespace RELIEF_API reference {

/// The largest radiance in a linear picture.
inline constexpr double max_radiance = 3e38;

/// Clamps to [0, limit]; NaN becomes 0.
glm::dvec3 limited(const glm::dvec3& radiance, double limit);

/// The result of one ray.
struct Sample {
    explicit Sample(bool needs_radiance, Recorder* recorder = nullptr)
        : trace(needs_radiance, recorder) {}

    glm::dvec4 color{0.0};    ///< Alpha not multiplied in.
    std::vector<Hit> layers;  ///< The hits, nearest first, including transparent
                              ///< ones; without culled sides.
    std::optional<Hit> first_shown;
    Trace trace;
    bool ambiguous = false;  ///< Two surfaces at depths that OpenGL may not tell apart.
};

/// Traces the rays of a picture.
class Tracer {
  public:
    /// \param only_covering  surfaces with transmission or blending are invisible
    Tracer(const PreparedScene& prepared, const ReferenceSettings& settings,
           const Visibility& visibility, bool only_covering)
        : prepared_(prepared),
          settings_(settings),
          visibility_(visibility),
          only_covering_(only_covering) {
        top_ = detail::half_height(camera());
    }

    /// \param x, y  in pixels from the upper left corner
    /// \param recorder  null, or the recorder of the terms
    [[nodiscard]] Sample trace(double x, double y, Recorder* recorder = nullptr) const {
        return traced(x, y, true, recorder);
    }

    /// Returns the sample of a ray beside a pixel, without its radiance, to compare it with the
    /// sample of the pixel.
    [[nodiscard]] Sample trace_beside(double x, double y) const {
        return traced(x, y, false, nullptr);
    }

    /// Tells whether the picture is continuous between two samples.
    [[nodiscard]] bool is_continuous(const Sample& a, const Sample& b) const;

    /// Tells whether the next pixel may lie beyond the horizon of a textured triangle's plane,
    /// where the differences between pixels by which OpenGL chooses a mip level mean nothing.
    [[nodiscard]] bool is_edge_on(const Sample& sample, double x, double y) const;

    /// Returns the direction of the ray through a point of the picture, in the space of the camera;
    /// not unit.
    [[nodiscard]] glm::dvec3 ray(double x, double y) const {
        return direction(on_view_plane(x, y));
    }

    /// Returns the weights of the corners of a triangle where the ray meets its plane; none if it
    /// does not.
    [[nodiscard]] std::optional<glm::dvec3> weights_on_plane(const ReferenceHit& hit, double x,
                                                             double y) const;

  private:
    [[nodiscard]] Sample traced(double x, double y, bool needs_radiance, Recorder* recorder) const;
    [[nodiscard]] const Camera& camera() const { return *prepared_.scene.camera; }
    [[nodiscard]] glm::dvec2 on_view_plane(double x, double y) const;
    /// Returns the direction of the ray, in the space of the camera.
    [[nodiscard]] glm::dvec3 direction(const glm::dvec2& view_plane) const {
        return {camera().orthographic_height ? glm::dvec2(0.0) : view_plane, -1.0};
    }
    [[nodiscard]] bool uses_opengl(const Hit& hit, const Material& material) const {
        return material.double_sided || !is_back(prepared_, hit);
    }
    [[nodiscard]] bool is_covering(const Hit& hit, const Material& material) const {
        return material.alpha_mode != AlphaMode::blend &&
               !is_transmissive(material, *prepared_.instances[hit.instance].mesh);
    }
    void write_depths(std::vector<Hit>& hits) const;
    [[nodiscard]] bool is_same_surface(const Hit& a, const Hit& b) const;
    [[nodiscard]] bool is_too_close(const Hit& front, const Hit& behind) const;
    /// Begins to record a hit that may be shown.
    void record(const Hit& hit, const Material& material, Sample& sample) const;
    /// Adds the color of a hit, alpha multiplied in. \return whether it hides all hits behind it
    bool add(const Hit& hit, Sample& sample) const;
    /// Returns the skybox, or transparency.
    [[nodiscard]] glm::dvec4 skybox(const glm::dvec2& view_plane, Trace& trace) const;

    const PreparedScene& prepared_;
    const ReferenceSettings& settings_;
    const Visibility& visibility_;
    bool only_covering_;
    double top_ = 1.0;  ///< The upper edge of the picture, as half_height() defines it.
};

/// Tells whether a discrete property changes within the margin around a pixel's center, or OpenGL
/// averages a texture there.
bool is_near_edge(const Tracer& tracer, const Sample& center, double x, double y, double margin);

/// \throws InvalidInput if the settings are not valid
void check(const ReferenceSettings& settings);

/// Everything that the pixels of a picture share.
class PreparedPicture {
  public:
    /// \throws InvalidInput, FileError as render_reference does
    PreparedPicture(const Scene& scene, const ReferenceSettings& settings, Report& report);
    PreparedPicture(const PreparedPicture&) = delete;
    PreparedPicture& operator=(const PreparedPicture&) = delete;

    [[nodiscard]] const PreparedScene& scene() const { return scene_; }
    [[nodiscard]] const Tracer& tracer() const { return tracer_; }

  private:
    PreparedScene scene_;
    Visibility visibility_;
    Tracer tracer_;
};

/// Returns the steps from a pixel's radiance to its picture over the scene's background, without
/// the codes.
/// \param alpha  the coverage of the background
ProbePicture pixel_picture(const glm::dvec3& radiance, double alpha, const Scene& scene,
                           OutputCoding output);

}  // namespace reference
}  // namespace relief::shade
