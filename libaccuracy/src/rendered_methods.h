// SPDX-License-Identifier: Apache-2.0
/// \file
/// Renders several variants of a scene with OpenGL, times them in interleaved rounds, and computes
/// their errors against a reference image. Also holds the scenes that several experiments share.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/shade/effects.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"

namespace relief::accuracy::detail {

/// An OpenGL context, or the reason why there is none.
class GlDevice {
  public:
    explicit GlDevice(shade::Backend backend = shade::Backend::automatic);

    [[nodiscard]] const shade::Context& context() const { return *context_; }
    [[nodiscard]] bool is_available() const { return context_ != nullptr; }
    /// The reason why OpenGL is not available.
    [[nodiscard]] const std::string& absence() const { return absence_; }

  private:
    std::unique_ptr<shade::Context> context_;
    std::string absence_;
};

/// A scene, and how it is rendered.
struct Rendering {
    shade::Scene scene;
    int samples = 1;  ///< Per pixel: 1, or 4 with OpenGL's multisampling.
    /// Rendered pixels along each side of an output pixel; they are averaged afterwards.
    int pixels_per_side = 1;
    std::vector<shade::ForcedEffect> effects = {};
};

/// A way to render, as a function of a quantity that charts vary, such as the roughness.
using RenderedMethod = MethodOn<double, Rendering>;

/// The comparison of images with the reference image.
enum class PictureMetric {
    flip,     ///< FLIP of 8-bit sRGB.
    percent,  ///< The difference of linear light, in percent of the reference.
};

/// The image of one method, and its error.
struct RenderedImage {
    Image picture;  ///< Three channels: 8-bit sRGB, or linear floats with PictureMetric::percent.
    Image errors;   ///< FLIP per pixel; empty with PictureMetric::percent.
};

/// The methods of an experiment and what they rendered, by their index.
struct Renderings {
    std::shared_ptr<const GlDevice> device;
    std::vector<RenderedMethod> methods;
    Image ground_truth;  ///< Three float channels, linear light.
    std::vector<RenderedImage> images;
};

/// An experiment on square images.
struct RenderedExperiment {
    Experiment report{};  ///< Describes the experiment, without units and items.
    int size = 0;         ///< Width and height of the images in pixels.
    std::vector<RenderedMethod> methods{};
    double x = 0.0;  ///< The quantity for which the methods render.
    /// Makes the reference image: three float channels, linear light.
    std::function<Image()> ground_truth{};
    PictureMetric metric = PictureMetric::flip;
    std::vector<std::string> compared{};  ///< PreparedExperiment::compared
    /// The methods whose images and errors are shown, with a title, and the FLIP error that is
    /// shown at full brightness.
    std::vector<std::size_t> shown{};
    std::string title{};
    double brightest = 0.5;
    /// As PreparedExperiment::finish; all images exist.
    std::function<void(Experiment& report, const Renderings& renderings)> finish{};
};

/// Prepares an experiment that renders. Without OpenGL, it has no methods, and its finding says why
/// OpenGL is not available.
///
/// Times are whole frames, from the first command to the last pixel, without reading back and
/// without the averaging of `pixels_per_side`. The time on all threads uses the threads of the
/// driver. The time on one thread is measured only with software OpenGL: the same threads on one
/// processor.
PreparedExperiment prepare_rendering(std::shared_ptr<const GlDevice> device,
                                     RenderedExperiment experiment);

/// Completes a chart over the quantity on which methods depend.
/// \param ground_truth  makes the reference image at x
Chart rendered_chart(const GlDevice& device, Chart chart,
                     const std::vector<RenderedMethod>& methods, const std::vector<double>& all_x,
                     const std::function<Image(double x)>& ground_truth,
                     PictureMetric metric = PictureMetric::flip);

/// The image of a method beside the reference image.
PicturePair image_pair(const std::string& title, const std::string& method, const Image& picture,
                       const Image& ground_truth);

/// Direction in which the light of lit_scene() travels; not unit length.
inline constexpr glm::vec3 light_direction_world{-0.5F, -0.8F, -0.6F};
inline constexpr float light_irradiance = 0.9F;
inline constexpr float lit_ambient = 0.08F;

/// A mesh under one directional light and weak ambient light before a dark background. The camera
/// is 30 degrees to the right and 35 degrees above; the image is square.
shade::Scene lit_scene(Mesh mesh, Material material);

/// lit_scene() with a repeated normal map.
shade::Scene bumpy_scene(Mesh mesh, Material material, Image normal_map);

/// A smooth reddish material with a highlight of shininess 40.
Material glossy_plastic();

/// Renders a reference image with the CPU reference shader in double precision.
///
/// \param scene        has a camera and an opaque background; no tone mapping
/// \param size         width and height in pixels
/// \param rays_per_side  rays along each side of a pixel, at the centers of a regular grid
/// \return three float channels, linear light. Each ray is clamped to [0,1] before the average, as
///         a renderer with as many samples does
Image supersampled_reference(const shade::Scene& scene, int size, int rays_per_side);

/// Slices around the circle of the torus; the tube has half as many. With this number the torus
/// stands for the smooth surface.
inline constexpr int smooth_torus_slices = 768;

std::size_t torus_triangles(int slices);

/// A way to render the torus with a number of slices.
struct TorusMethod {
    std::string name{};
    std::function<shade::Scene(int slices)> scene{};
    double stored_bytes = 0.0;
};

/// A method on a torus, "flat, 576 triangles", whose choices are the method and the number of
/// triangles.
RenderedMethod method_on_torus(const std::string& choice, const TorusMethod& method, int slices);

/// An experiment with each method on tori of several numbers of slices, and a chart of the error by
/// triangle count. The ground truth has one ray through the center of each pixel.
/// \param smooth  makes the scene of the ground truth, with smooth_torus_slices
RenderedExperiment on_tori(Experiment report, const std::string& choice,
                           const std::vector<TorusMethod>& methods, const std::vector<int>& slices,
                           const std::function<shade::Scene(int slices)>& smooth, int size);

/// The camera at which the smooth torus fills the image.
shade::Camera torus_camera();

}  // namespace relief::accuracy::detail
