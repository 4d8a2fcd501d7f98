// SPDX-License-Identifier: Apache-2.0
/// \file
/// Animated PNG files (APNG), written frame by frame: what browsers play, and what any PNG reader
/// shows the first frame of. Source: the APNG chunks of [PNG 3], section 11.3.6.
/// Tests: tests/mesh/io/png/animated_png_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "relief/mesh/image.h"

namespace relief {

/// A file being written. It takes the old one's place in finish(), and not before.
class AnimatedPng {
  public:
    /// \param frames   how many there will be, at least 1; played again and again
    /// \param seconds  that each is shown, from 0 to 65
    /// \throws FileError if the file cannot be written, InvalidInput if a number is out of range
    AnimatedPng(const std::filesystem::path& file, std::uint32_t frames, double seconds);
    ~AnimatedPng();
    AnimatedPng(const AnimatedPng&) = delete;
    AnimatedPng& operator=(const AnimatedPng&) = delete;

    /// The next frame: 8 or 16 bits, sRGB or data; only this one is held in memory.
    /// \throws InvalidInput if it is not of the first one's size, channels and bits, or one too
    ///         many; FileError
    void add(const Image& frame);

    /// \throws InvalidInput if frames are missing; FileError
    void finish();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
