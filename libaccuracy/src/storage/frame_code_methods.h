// SPDX-License-Identifier: Apache-2.0
/// \file
/// Encodings of tangent frames as methods of an experiment. Tests:
/// tests/accuracy/frame_codes_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "measured_methods.h"
#include "storage/frame_codes.h"

namespace relief {

/// One encoding, rounded one way.
struct FrameCode {
    FrameEncoding encoding = FrameEncoding::float32;
    FrameRounding rounding = FrameRounding::nearest;

    [[nodiscard]] std::string rounding_word() const;
    /// Its name, choices, bytes, and errors on these frames; no work.
    [[nodiscard]] MeasuredMethod measured(const SampleFrames& frames) const;
};

/// Every encoding, rounded both ways.
std::vector<FrameCode> all_frame_codes();

}  // namespace relief
