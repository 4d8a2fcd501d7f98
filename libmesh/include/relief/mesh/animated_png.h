// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writes animated PNG files (APNG) frame by frame. Browsers play them; other readers show the
/// first
/// frame. Source: the APNG chunks of [PNG 3], section 11.3.6.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "relief/mesh/image.h"

namespace relief {

/// Writes an animated PNG file. The file replaces an old one in finish().
class AnimatedPng {
  public:
    /// \param frames   number of frames, at least 1; the animation repeats forever
    /// \param seconds  duration of a frame, from 0 to 65
    /// \throws FileError if the file cannot be written, InvalidInput if a number is out of range
    AnimatedPng(const std::filesystem::path& file, std::uint32_t frames, double seconds);
    ~AnimatedPng();
    AnimatedPng(const AnimatedPng&) = delete;
    AnimatedPng& operator=(const AnimatedPng&) = delete;

    /// Adds a frame of 8 or 16 bits, sRGB-coded or data. Only one frame is held in memory.
    /// \throws InvalidInput if its size, channels or bits differ from the first frame's, or if
    ///         there are too many frames; FileError
    void add(const Image& frame);

    /// Completes the file. \throws InvalidInput if frames are missing; FileError
    void finish();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
