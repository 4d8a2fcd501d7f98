// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures how much a model differs from its source: in pictures (FLIP), in degrees between
/// shading normals, and in pixels along silhouettes. docs/fidelity.md defines all figures.
/// Tests: tests/shade/render/fidelity_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
namespace shade {

/// The light of a picture. The lights, the environment and the background of the scenes are
/// ignored.
enum class FidelityLight {
    studio,      ///< studio_environment() at an intensity of 0.75, so that white stays below 1.
    grazing,     ///< A directional light from the upper left, 75 degrees from the view axis, with
                 ///< which it turns; white surfaces that face it have radiance 1.
    base_color,  ///< No light: base color, or the diffuse color of Phong's model.
};
inline constexpr std::size_t fidelity_light_count = 3;

}  // namespace shade

template <>
inline constexpr auto enum_names<shade::FidelityLight> =
    std::to_array<EnumName<shade::FidelityLight>>({{"studio", shade::FidelityLight::studio},
                                                   {"grazing", shade::FidelityLight::grazing},
                                                   {"base-color",
                                                    shade::FidelityLight::base_color}});

namespace shade {

/// The directions from the center of the model to the camera: the vertices of an icosahedron in
/// world space, in opposite pairs. The y axis points up in all pictures; in views along it, the x
/// axis points right.
inline constexpr std::size_t fidelity_view_count = 12;
/// \param view  less than fidelity_view_count \return a unit vector
glm::vec3 fidelity_view(std::size_t view);

/// Every fourth of these views is one of SampledFidelity and of the noise floor: 0, 4 and 8.
inline constexpr std::size_t fidelity_sample_stride = 4;

/// The radius of FLIP's filters in pixels: pictures are compared up to this distance from the
/// silhouettes.
inline constexpr int fidelity_margin = 10;

struct FidelityOptions {
    int size = 256;  ///< Pixels of a side of the square pictures, from 16 to 4096.
    /// Samples of a pixel: a square number from 1 to 16. All of them are shaded.
    int samples = 4;
    std::size_t views = fidelity_view_count;  ///< The first ones, from 1 to 12.
    /// More directions to the camera, finite and not zero. Their views are numbered from `views`
    /// on.
    std::vector<glm::vec3> more_views{};
};

/// The view in which a figure is largest; ties: the first view wins.
struct WorstView {
    std::size_t view = 0;
    double value = 0.0;  ///< The mean of that view.
};

/// The difference of the pictures with one light.
struct PictureLoss {
    /// FLIP, over the pixels that a model covers in some view, and those within fidelity_margin.
    double mean = 0.0;
    double p95 = 0.0;  ///< 95 % of these pixels do not exceed it.
    WorstView worst;
    /// The mean difference between the source and itself with (n + 1)^2 samples a pixel instead of
    /// n^2, in the views 0, 4 and 8, as far as they are drawn.
    double floor = 0.0;
    // The pictures of the worst view.
    Image source;      ///< sRGB of 8 bits.
    Image result;      ///< sRGB of 8 bits.
    Image difference;  ///< FLIP: one float channel, data.
};

/// The angles between shading normals in degrees. The normal of a pixel is the mean of its samples.
struct NormalLoss {
    double mean = 0.0;  ///< Over pixels that both models cover completely.
    double rms = 0.0;
    double p95 = 0.0;
    double p99 = 0.0;
    double max = 0.0;
    WorstView worst;
    double floor = 0.0;         ///< As PictureLoss::floor.
    std::size_t pixels = 0;     ///< The compared pixels of all views.
    std::size_t undefined = 0;  ///< Pixels without a normal in one picture; not in the angles.

    /// Returns a figure of all views.
    [[nodiscard]] double error(ErrorKind kind) const;
};

/// The area that only one model covers, divided by the length of the source's silhouettes: a mean
/// distance of the silhouettes in pixels.
struct SilhouetteLoss {
    double width = 0.0;  ///< Of all views.
    WorstView worst;
    double floor = 0.0;  ///< As PictureLoss::floor.
};

/// The figures of a view.
struct ViewLoss {
    glm::vec3 from{0.0F};  ///< The direction to the camera, a unit vector.
    std::array<double, fidelity_light_count> flip{};  ///< Means, by FidelityLight.
    double degrees = 0.0;                             ///< The mean.
    double silhouette_pixels = 0.0;                   ///< The width.
};

/// The figures in the views 0, 4 and 8, as far as they are drawn: those of the noise floor.
struct SampledFidelity {
    std::array<double, fidelity_light_count> flip{};  ///< Means, by FidelityLight.
    NormalLoss normals;                               ///< Without a floor.
    double silhouette_pixels = 0.0;
};

struct Fidelity {
    std::array<PictureLoss, fidelity_light_count> pictures;  ///< By FidelityLight.
    NormalLoss normals;
    SilhouetteLoss silhouettes;
    std::vector<ViewLoss> views;
    SampledFidelity sampled;
    /// The mean FLIP in the studio on black instead of middle gray, in the views 0, 4 and 8. Views
    /// in which they differ by more than 10 %, because silhouettes dominate, are counted as a
    /// finding.
    double studio_mean_on_black = 0.0;
    double diameter = 0.0;       ///< Of the source's bounding sphere, in world units.
    double pixels_across = 0.0;  ///< The same in pixels: 90 % of the side of the pictures.

    /// The largest mean of the lights, which a limit of the difference of pictures applies to.
    [[nodiscard]] double max_picture_mean() const;
};

/// Returns the numbers of the views; the largest difference of pictures, with any light, is first.
/// Ties: the first view wins.
std::vector<std::size_t> worst_views_first(const Fidelity& loss);

/// Measures any number of models against one source, whose pictures are drawn once.
///
/// Both models are drawn by orthographic cameras at the same positions in world space. The source's
/// bounding sphere (around the middle of its box) fills 90 % of the side of the pictures. Models of
/// any size are scaled to that sphere, with their attenuation distances, so that a common factor of
/// both models changes nothing. Equal scenes have no difference.
///
/// If the source has no material (only default_material(), as files without materials do), both
/// models are drawn matte: gray, or with vertex colors and base colors if the source has vertex
/// colors. Of a result's materials, only these colors, normal maps and opacity then count.
class FidelityMeter {
  public:
    /// Draws the source.
    /// \param context  must outlive the meter
    /// \param report  as Renderer's; and a source without materials
    /// \throws InvalidInput if the source has no triangle or no extent, or an option is out of
    ///         range; and as Renderer does
    FidelityMeter(const Context& context, const Scene& source, const FidelityOptions& options = {},
                  Report& report = IgnoredReport());
    ~FidelityMeter();
    FidelityMeter(const FidelityMeter&) = delete;
    FidelityMeter& operator=(const FidelityMeter&) = delete;

    /// Draws a model and compares it.
    ///
    /// \param result  in the world space of the source; without triangles, it covers no pixel
    /// \param report  as Renderer's; and the views in which silhouettes dominate, in which the
    ///         result reaches the edge of the picture, and in which the models share no pixel
    /// \throws as Renderer does
    Fidelity measure(const Scene& result, Report& report = IgnoredReport());

    /// Draws and compares a model only in the views of SampledFidelity, which is faster: for the
    /// stages between the source and a result. The arguments are those of measure(), but no views
    /// are reported.
    SampledFidelity measure_sampled(const Scene& result, Report& report = IgnoredReport());

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Measures one model in a context of its own. \throws GpuError if there is none
Fidelity measure_fidelity(const Scene& source, const Scene& result,
                          const FidelityOptions& options = {}, Report& report = IgnoredReport());

/// Returns all triangles of a scene in world space, deformed by their poses, with positions only:
/// for distances between surfaces (relief/mesh/topology.h).
Mesh world_surface(const Scene& scene);

}  // namespace shade
}  // namespace relief
