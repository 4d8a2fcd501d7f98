// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/resolution_test.cpp.
#include "window/resolution.h"

#include <algorithm>
#include <cmath>

namespace relief::tools {
namespace {

constexpr double cost_of_samples = 2.4;  // Of 4 samples against 1, in software; measured.
constexpr int coarsest = 4;

}  // namespace

FrameSettings Resolution::settings_for(FrameSettings whole, double now) const {
    if (milliseconds_ <= slow_milliseconds || now - last_move_ >= resting_seconds) return whole;
    const double of_one_sample =
        whole.samples > 1 ? milliseconds_ / cost_of_samples : milliseconds_;
    const double divisor = std::ceil(std::sqrt(of_one_sample / slow_milliseconds));
    const int n = static_cast<int>(std::clamp(divisor, 1.0, static_cast<double>(coarsest)));
    whole.samples = 1;
    whole.width = std::max(whole.width / n, 1);
    whole.height = std::max(whole.height / n, 1);
    return whole;
}

}  // namespace relief::tools
