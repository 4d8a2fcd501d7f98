// SPDX-License-Identifier: Apache-2.0
/// \file
/// From a scene to a picture. Tests: tests/shade/render/renderer_test.cpp.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/shade/context.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

namespace relief {

struct FrameSettings {
    int width = 1024;
    int height = 1024;
    int samples = 4;  ///< Per pixel: 1 or 4 (multisampling; edges only).
    /// srgb: 8-bit RGBA, ready for a screen. linear: float RGBA radiance.
    OutputCoding output = OutputCoding::srgb;
};

/// What drawing took, in milliseconds of wall clock around finished work.
struct FrameTimes {
    double decode_images = 0;  ///< Reading and decoding the textures that the plan calls for.
    double prepare = 0;        ///< Tangents where missing, uploads, programs.
    double draw = 0;           ///< The frame itself, including shader compilation at first use.
    double read_back = 0;
};

struct Frame {
    Image image;  ///< Four channels, row 0 at the top, alpha not multiplied in.
    FrameTimes times;
    std::size_t programs = 0;  ///< Linked for this scene.
    std::size_t textures = 0;  ///< Uploaded for this scene.
};

/// Holds one scene on the GPU and draws it.
///
/// Only what plan_effects() names is decoded, computed and uploaded. The context must outlive it
/// and be current.
class Renderer {
  public:
    /// \param report  counts fallbacks of tangent computation and of image decoding
    /// \throws InvalidInput if the scene is not valid; FileError if an image that is needed cannot
    /// be
    ///         read; GpuError
    Renderer(const Context& context, const Scene& scene, const FrameSettings& settings,
             Report& report);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    [[nodiscard]] const FramePlan& plan() const;

    /// Draws the scene as the camera sees it. \throws GpuError
    Frame draw(const Camera& camera);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
