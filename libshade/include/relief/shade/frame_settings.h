// SPDX-License-Identifier: Apache-2.0
/// \file
/// How large, how smooth and in which coding a picture is wanted.
#pragma once

#include <cstdint>

#include "relief/shade/debug_views.h"

namespace relief {

/// How the finished radiance is stored.
enum class OutputCoding : std::uint8_t {
    linear,   ///< Radiance as it is, as far as a float goes.
    clamped,  ///< The same, no more than 1.
    srgb,     ///< Exposed and tone-mapped (scene.h), no more than 1, as sRGB codes.
    half,     ///< Radiance up to 65504: what a finishing pass averages and codes. Not a picture's.
};

struct FrameSettings {
    int width = 1024;
    int height = 1024;
    /// Per pixel: 1 or 4 (multisampling; edges only). Samples are tone-mapped each, and averaged in
    /// linear light.
    int samples = 4;
    /// srgb: 8-bit RGBA, ready for a screen. linear: float RGBA radiance. clamped: the same up
    /// to 1.
    OutputCoding output = OutputCoding::srgb;
    /// What is shown instead of the picture. Views of data take one sample a pixel, whatever
    /// `samples` says.
    DebugView view = DebugView::picture;
    Overlays overlays = {};

    friend bool operator==(const FrameSettings&, const FrameSettings&) = default;
};

}  // namespace relief
