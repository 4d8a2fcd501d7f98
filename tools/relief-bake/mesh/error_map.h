// SPDX-License-Identifier: Apache-2.0
/// \file
/// The errors of a map as an image. Tests: tests/tools/relief_bake_verify_test.cpp.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "relief/mesh/bake_check.h"

namespace relief::tools {

/// Errors by texel, kept only where an image of them is wanted.
class ErrorMap {
  public:
    ErrorMap(int width, int height, bool is_wanted)
        : width_(width), height_(height), is_wanted_(is_wanted) {}

    /// The next rows, in degrees, NaN where there is none.
    void add(std::span<const float> degrees) {
        if (is_wanted_) degrees_.insert(degrees_.end(), degrees.begin(), degrees.end());
    }

    /// PNG: heat from black, no error, to pale yellow, the error that is returned or more; clear
    /// where there is none. EXR, TIFF: degrees, in one channel. The text "relief:brightest" has the
    /// error, in degrees.
    /// \return 99 of 100 errors are no larger; rounded up to 1, 2 or 5 of some power of ten
    double write(const std::filesystem::path& file, const BakeCheck& check);

  private:
    int width_, height_;
    bool is_wanted_;
    std::vector<float> degrees_;
};

}  // namespace relief::tools
