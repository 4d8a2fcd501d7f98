// SPDX-License-Identifier: Apache-2.0
/// \file
/// From a scene to a picture. Tests: tests/shade/render/renderer_test.cpp.
#pragma once

#include <memory>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/shade/context.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/render_cache.h"
#include "relief/shade/scene.h"

namespace relief {

namespace gl {
class RenderTarget;
}

/// What drawing took, in milliseconds of wall clock around finished work.
struct FrameTimes {
    double decode_images = 0;  ///< Reading and decoding the textures that the plan calls for.
    double prepare = 0;        ///< Tangents where missing, uploads, programs.
    double link = 0;           ///< Of that, compiling and linking programs.
    double draw =
        0;  ///< The frame itself; the driver may compile shaders to machine code at first.
    double read_back = 0;
};

struct Frame {
    /// Four channels, row 0 at the top, alpha not multiplied in; always finite: where a scene's
    /// data is not (NaN vertices or texels), a pixel that it reaches is black or the largest value.
    Image image;
    FrameTimes times;
    std::size_t programs = 0;  ///< Linked for this scene.
    std::size_t textures = 0;  ///< Uploaded for this scene.
};

/// A frame that stays on the GPU.
struct DrawnFrame {
    /// OpenGL's name of the picture, a 2D texture of one level, row 0 at the bottom, coded as the
    /// settings say; until the renderer draws again or goes.
    unsigned texture = 0;
    FrameTimes times;
    std::size_t programs = 0;
    std::size_t textures = 0;
};

/// Holds one scene on the GPU and draws it.
///
/// Only what the effect plan names is decoded, computed and uploaded. The scene is not needed any
/// more afterwards. The context must outlive the renderer, and be current in every call.
class Renderer {
  public:
    /// Draws as plan_effects() plans.
    ///
    /// \param report  counts fallbacks of tangent and normal computation and of image decoding,
    ///                textures that do not show because a mesh has no texture coordinates, and
    ///                textures whose images are missing or damaged: the picture is drawn as if
    ///                their materials did not have them, but for emission textures, without which
    ///                nothing is emitted. plan() is then the plan without them
    /// \throws InvalidInput if the scene or the settings are not valid, FileError if an image of
    ///         the environment, or one that is required (scene.h), cannot be read, GpuError if
    ///         OpenGL refuses something; a shader's errors are named by file and line
    Renderer(const Context& context, const Scene& scene, const FrameSettings& settings,
             Report& report);

    /// Draws by another plan of the same scene: a plan_effects() plan with effects added, which
    /// changes no pixel, or taken away. Sets that contradict themselves are made canonical, and a
    /// finishing pass that samples or blending need is put in.
    Renderer(const Context& context, const Scene& scene, FramePlan plan,
             const FrameSettings& settings, Report& report);
    /// The same, with what renderers before it left in the cache, which keeps what this one makes.
    Renderer(RenderCache& cache, const Context& context, const Scene& scene, FramePlan plan,
             const FrameSettings& settings, Report& report);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    [[nodiscard]] const FramePlan& plan() const;

    /// Takes over where instances stand and how lamps shine from the same scene at another time
    /// (scene_graph.h); all else stays as it was made. \throws InvalidInput if instances or lamps
    /// are not as many as they were, or not valid
    void move(const Scene& scene);

    /// Draws the scene as the camera sees it. \throws InvalidInput if the camera is not valid
    /// (scene.h); GpuError
    Frame draw(const Camera& camera);

    /// The same without reading the picture back.
    DrawnFrame draw_only(const Camera& camera);

    /// Where that is, for who knows render targets (libshade/src/gl/framebuffer.h).
    [[nodiscard]] const gl::RenderTarget& target() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
