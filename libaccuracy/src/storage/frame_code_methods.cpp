// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/frame_codes_test.cpp.
#include "storage/frame_code_methods.h"

#include <fmt/format.h>

namespace relief {

std::string FrameCode::rounding_word() const {
    return rounding == FrameRounding::nearest ? "nearest" : "best";
}

MeasuredMethod FrameCode::measured(const SampleFrames& frames) const {
    MeasuredMethod method;
    method.name = fmt::format("{}, {}", word_of(encoding), rounding_word());
    method.choices = {{"encoding", std::string(word_of(encoding))}, {"rounding", rounding_word()}};
    const FrameCodeErrors errors = frame_code_errors(frames, encoding, rounding);
    method.error = figures_of(errors.both);
    method.stored_bytes = 4.0 * static_cast<double>(words_per_frame(encoding));
    if (errors.lost_hands > 0)
        method.note = fmt::format("{} frames changed hands", errors.lost_hands);
    return method;
}

std::vector<FrameCode> all_frame_codes() {
    std::vector<FrameCode> codes;
    for (const FrameEncoding encoding : all_frame_encodings) {
        codes.push_back({encoding, FrameRounding::nearest});
        if (encoding != FrameEncoding::float32) codes.push_back({encoding, FrameRounding::best});
    }
    return codes;
}

}  // namespace relief
