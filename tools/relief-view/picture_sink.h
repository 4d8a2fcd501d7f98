// SPDX-License-Identifier: Apache-2.0
/// \file
/// The destinations of pictures: one file, numbered files, an animated PNG file, or a video by the
/// program ffmpeg. Tests: tests/tools/sequence_test.cpp.
#pragma once

#include <filesystem>
#include <memory>

#include "relief/mesh/image.h"
#include "view_options.h"

namespace relief::tools {

/// Returns whether the file is a video (.mp4, .webm).
bool is_video(const std::filesystem::path& output);

/// Returns whether the file stores several pictures (.mp4, .webm, .apng).
bool is_animation(const std::filesystem::path& output);

/// The file of picture `index`, counted from 1. The number replaces a run of # in the name, or is
/// appended: "spin-0001.png".
std::filesystem::path numbered_file(const std::filesystem::path& output, int index);

/// The destination of pictures: one file, numbered files or an animation.
class PictureSink {
  public:
    virtual ~PictureSink() = default;
    virtual void take(const Image& picture) = 0;
    /// Called after the last picture. \throws FileError
    virtual void finish() {}
};
std::unique_ptr<PictureSink> make_sink(const ViewOptions& options);

}  // namespace relief::tools
