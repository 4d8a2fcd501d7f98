// SPDX-License-Identifier: Apache-2.0
/// \file
/// Creates OpenGL contexts without a window or wraps those of a window library, draws scenes,
/// caches resources between renderers, and measures frame times.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
namespace shade {

/// OpenGL is missing, too old or out of memory, or refuses a shader. The message contains that of
/// the driver.
class GpuError : public Error {
  public:
    using Error::Error;
};

/// The library that provides the context. Libraries are loaded at run time, independently of each
/// other.
///
/// OSMesa is libOSMesa.so.8, .6 or .so, EGL is libEGL.so.1, in the library path of the system;
/// $RELIEF_OSMESA_LIBRARY and $RELIEF_EGL_LIBRARY name other files. A device that claims to be
/// hardware but uses Mesa's rasterizer counts as software.
enum class Backend {
    automatic,  ///< A hardware EGL device if one exists, else OSMesa, else software EGL.
    osmesa,
    egl,
};

/// A function of a window library that returns OpenGL functions of the current context.
using GlLoader = void (*(*)(const char* name))();

namespace gl {
class Api;  // The table of entry points (libshade/src/gl/api.h).
}

/// An OpenGL 3.3 core context, current on the thread that created it until it is destroyed.
///
/// A thread can have at most one, because OSMesa and EGL do not detect each other; any number of
/// threads may have one each. Destroy it on the thread that created it, after all objects in it.
/// The libraries and EGL's displays stay loaded until the process ends.
class Context {
  public:
    /// Creates a context.
    /// \throws GpuError with the reason of every backend that was tried
    /// \throws InvalidInput if this thread has a context already
    explicit Context(Backend backend = Backend::automatic);

    /// Wraps a context that the caller has made current on this thread and keeps current for
    /// longer.
    ///
    /// \param name  for backend_name()
    /// \throws GpuError if it offers less than OpenGL 3.3
    /// \throws InvalidInput if this thread has a context already
    Context(GlLoader loader, std::string name);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// "OSMesa", "EGL (hardware)" or "EGL (software)"; the given name of a wrapped context.
    [[nodiscard]] const std::string& backend_name() const;
    /// "llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6".
    [[nodiscard]] const std::string& renderer_name() const;
    /// Returns true if a rasterizer of Mesa draws on the CPU.
    [[nodiscard]] bool is_software() const;

    [[nodiscard]] const gl::Api& api() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Programs, vertex buffers, textures, environment maps and render targets of one context.
///
/// A renderer with a cache reuses its contents: programs by their Features, meshes and images that
/// are the same Shared value, image files of the same name, size and time of change, and
/// environments likewise. It draws the same pixels as a renderer without a cache. The cache must
/// outlive its renderers, and the context the cache.
class RenderCache {
  public:
    explicit RenderCache(const Context& context);
    ~RenderCache();
    RenderCache(const RenderCache&) = delete;
    RenderCache& operator=(const RenderCache&) = delete;

    /// Frees resources that no renderer uses. Programs are kept, because they are small and slow to
    /// create.
    void drop_unused();

    /// Removes all programs because their sources changed. Existing renderers keep theirs.
    void drop_programs();

    struct Contents {
        std::size_t programs = 0;
        std::size_t meshes = 0;
        std::size_t textures = 0;
        std::size_t environments = 0;
        std::size_t targets = 0;
    };
    [[nodiscard]] Contents contents() const;

    struct Implementation;
    [[nodiscard]] Implementation& implementation() { return *implementation_; }

  private:
    std::unique_ptr<Implementation> implementation_;
};

namespace gl {
class RenderTarget;
}

/// The times of drawing in milliseconds of wall clock, around finished work.
struct FrameTimes {
    double decode_images = 0;  ///< Reading and decoding the textures of the plan.
    double prepare = 0;        ///< Missing tangents, uploads, programs.
    double link = 0;           ///< The part of prepare for compiling and linking programs.
    double draw = 0;  ///< The frame; the driver may compile shaders to machine code on first use.
    double read_back = 0;
};

struct Frame {
    /// Four channels, row 0 at the top, alpha not multiplied in; always finite: a pixel with data
    /// that is not finite (NaN vertices or texels) is black or the largest value.
    Image image;
    FrameTimes times;
    std::size_t programs = 0;  ///< Linked for this scene.
    std::size_t textures = 0;  ///< Uploaded for this scene.
};

/// A frame that stays on the GPU.
struct RenderedFrame {
    /// The OpenGL name of the picture, a 2D texture of one level, row 0 at the bottom, coded as in
    /// the settings; valid until the renderer draws again or is destroyed.
    unsigned texture = 0;
    FrameTimes times;
    std::size_t programs = 0;
    std::size_t textures = 0;
};

/// Holds one scene on the GPU and draws it.
///
/// Only the inputs of the effect plan are decoded, computed and uploaded. The scene is not needed
/// afterwards. The context must outlive the renderer and be current in every call.
class Renderer {
  public:
    /// Prepares the scene with the plan of plan_effects().
    ///
    /// \param report  counts fallbacks of tangent and normal computation and of image decoding,
    ///         textures that are invisible because a mesh has no texture coordinates, and textures
    ///         whose images are missing or damaged: the picture is drawn without them, and
    ///         materials with a missing emission texture emit nothing. plan() is then the plan
    ///         without them
    /// \throws InvalidInput if the scene or the settings are not valid, FileError if an image of
    ///         the environment, or one that is required (image_source.h), cannot be read, GpuError
    ///         if OpenGL refuses something; errors of shaders name the file and line
    Renderer(const Context& context, const Scene& scene, const FrameSettings& settings,
             Report& report = IgnoredReport());

    /// Prepares the scene with another plan: that of plan_effects() with effects added, which
    /// changes no pixel, or removed. Contradictory sets are made canonical, and a finishing pass is
    /// added if samples, blending or transmission need it.
    Renderer(const Context& context, const Scene& scene, FramePlan plan,
             const FrameSettings& settings, Report& report = IgnoredReport());
    /// The same with a cache, which provides resources and keeps new ones.
    Renderer(RenderCache& cache, const Context& context, const Scene& scene, FramePlan plan,
             const FrameSettings& settings, Report& report = IgnoredReport());
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    [[nodiscard]] const FramePlan& plan() const;

    /// Updates instances, their poses, and lights from the same scene at another time
    /// (scene_graph.h); all else stays unchanged. plan() then follows the poses. Only meshes that
    /// are other objects are uploaded. \throws InvalidInput if the number of instances or lights
    /// differs, or something is not valid
    void move(const Scene& scene);

    /// Draws the scene as the camera sees it. \throws InvalidInput if the camera is not valid
    /// (camera.h); GpuError
    Frame draw(const Camera& camera);

    /// Draws without reading the picture back.
    RenderedFrame draw_only(const Camera& camera);

    /// The render target of the picture (libshade/src/gl/resources.h).
    [[nodiscard]] const gl::RenderTarget& target() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// A triple buffer of textures: one is shown, one is the next, one is free for the next copy.
///
/// The contexts of both threads share textures (a window library creates them). The drawing thread
/// owns this object and calls put(); the other thread calls get(), which never waits for a frame
/// and never returns an incomplete one.
class PictureExchange {
  public:
    explicit PictureExchange(const Context& context);
    ~PictureExchange();
    PictureExchange(const PictureExchange&) = delete;
    PictureExchange& operator=(const PictureExchange&) = delete;

    /// Copies the last picture of the renderer, which must have 8 bits, and waits for the copy.
    /// \param beside  a second picture that is passed on together with the first
    void put(const Renderer& renderer, const Renderer* beside = nullptr);

    /// Passes on another picture: 8-bit RGB or RGBA, sRGB.
    void put(const Image& picture);

    struct Shown {
        unsigned texture = 0;  ///< 0 before the first. Row 0 at the bottom, sRGB codes.
        int width = 0;
        int height = 0;
        unsigned beside = 0;  ///< The second picture, of the same size; 0 if there is none.
    };
    /// Returns the newest picture; its texture does not change until the next call.
    Shown get();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

// Frame times are measured by a wall clock around finished work, because the timer queries of
// software drivers are wrong. Renderers draw interleaved, and their first frames are dropped.

/// Milliseconds of each counted frame of one renderer, in the order in which they were drawn.
struct FrameSeries {
    std::vector<double> draw;
    std::vector<double> read_back;
    std::vector<double> frame;  ///< Their sum.
};

/// Measures one series for each renderer, interleaved and without warm-up frames.
/// \throws as Renderer::draw() does
std::vector<FrameSeries> time_frames(std::span<Renderer* const> renderers, const Camera& camera,
                                     const Repeats& repeats);

}  // namespace shade
}  // namespace relief
