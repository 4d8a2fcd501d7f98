// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines the size, sample count and output coding of a picture.
#pragma once

#include <cstdint>

#include "relief/shade/debug_views.h"

namespace relief {

/// The coding of the finished radiance.
enum class OutputCoding : std::uint8_t {
    linear,   ///< Radiance, up to the largest float.
    clamped,  ///< Radiance clamped to 1.
    srgb,     ///< Exposed and tone-mapped (scene.h), clamped to 1, as sRGB codes.
    half,     ///< Radiance up to 65504, the input of the finishing pass; not for pictures.
};

struct FrameSettings {
    int width = 1024;
    int height = 1024;
    /// Samples per pixel: 1 or 4 (multisampling; edges only). Each is tone-mapped, and they are
    /// averaged in linear light.
    int samples = 4;
    /// srgb: 8-bit RGBA, ready for a screen. linear: float RGBA radiance. clamped: radiance up to
    /// 1.
    OutputCoding output = OutputCoding::srgb;
    /// The view that replaces the picture. Views of data have one sample a pixel and ignore
    /// `samples`.
    DebugView view = DebugView::picture;
    Overlays overlays = {};

    friend bool operator==(const FrameSettings&, const FrameSettings&) = default;
};

}  // namespace relief
