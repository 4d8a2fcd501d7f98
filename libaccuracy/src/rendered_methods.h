// SPDX-License-Identifier: Apache-2.0
/// \file
/// Renders several variants of a scene with OpenGL, times them in interleaved rounds, and computes
/// their errors against a reference image. Also holds the scenes that several experiments share.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
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

/// One way to render the scene.
struct RenderedMethod {
    std::string name;
    Choices choices;
    shade::Scene scene;
    int samples = 1;  ///< Per pixel: 1, or 4 with OpenGL's multisampling.
    /// Rendered pixels along each side of an output pixel; they are averaged afterwards.
    int pixels_per_side = 1;
    double stored_bytes = 0.0;
    std::string note = {};
};

/// The image of one method, and its error.
struct RenderedImage {
    Image picture;  ///< 8-bit sRGB, three channels.
    Image errors;   ///< FLIP per pixel.
};

/// The methods of an experiment and what they rendered, by their index.
struct Renderings {
    std::vector<RenderedMethod> methods;
    Image ground_truth;  ///< Three float channels, linear light.
    std::vector<RenderedImage> images;
};

/// Prepares an experiment that renders.
///
/// \param report  describes the experiment
/// \param ground_truth  three float channels, linear light; it determines the size of the images
/// \param finish  as PreparedExperiment::finish; all images exist
/// \param compared  as PreparedExperiment::compared
///
/// Times are whole frames, from the first command to the last pixel, without reading back and
/// without the averaging of `pixels_per_side`. The time on all threads uses the threads of the
/// driver. The time on one thread is measured only with software OpenGL: the same threads on one
/// processor.
PreparedExperiment prepare_rendering(
    std::shared_ptr<const GlDevice> device, Experiment report, std::vector<RenderedMethod> methods,
    Image ground_truth,
    std::function<void(Experiment& report, const Renderings& renderings)> finish,
    std::vector<std::string> compared = {});

/// Returns the mean seconds of a few frames of a renderer, without reading back.
double seconds_of_frames(shade::Renderer& renderer, const shade::Camera& camera);

/// Returns the note on the renderer and its times that every rendered method has.
std::string rendering_note(const GlDevice& device);

/// Sets which costs of frames are measured, as prepare_rendering() does.
void set_frame_costs(PreparedExperiment& prepared, const GlDevice& device);

/// An experiment without methods, whose finding says why OpenGL is not available.
PreparedExperiment not_rendered(Experiment report, const GlDevice& device);

/// The RMS error of one method without timing, for a point of a curve.
double rendered_error(const GlDevice& device, const RenderedMethod& method,
                      const Image& ground_truth);

/// The image of a method beside the reference image.
PicturePair image_pair(const std::string& title, const std::string& method, const Image& picture,
                       const Image& ground_truth);

/// Adds the image of a method beside the reference image, and a heat map of its errors.
/// \param brightest  the FLIP error that is shown at full brightness
void add_images(const std::string& title, const Renderings& renderings, std::size_t method,
                double brightest, Experiment& experiment);

/// An experiment on square images of `size` pixels along each side, with errors in FLIP.
Experiment image_experiment(int size);

/// Direction in which the light of lit_scene() travels; not unit length.
inline constexpr glm::vec3 light_direction_world{-0.5F, -0.8F, -0.6F};
inline constexpr float light_irradiance = 0.9F;
inline constexpr float lit_ambient = 0.08F;
/// Linear color, opaque.
inline constexpr glm::vec4 lit_background{0.03F, 0.04F, 0.06F, 1.0F};

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

/// "flat, 576 triangles"
std::string name_on_torus(const std::string& method, int slices);

/// The camera at which the smooth torus fills the image.
shade::Camera torus_camera();

/// A chart of the error by triangle count, with one curve per method.
///
/// \param experiment  its first measurements are those of the methods in order, each on all meshes
///         in the order of `slices`
/// \throws std::out_of_range if a measurement is missing
Chart torus_chart(const Experiment& experiment, std::span<const std::string> methods,
                  std::span<const int> slices);

}  // namespace relief::accuracy::detail
