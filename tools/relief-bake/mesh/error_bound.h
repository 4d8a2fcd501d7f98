// SPDX-License-Identifier: Apache-2.0
/// \file
/// What error is allowed. Tests: tests/tools/relief_bake_verify_test.cpp.
#pragma once

#include <optional>

namespace relief::tools {

/// Which error a bound is for: the root mean square, that of 99 of 100 texels, or the greatest.
enum class BoundKind { rms, p99, max };

struct ErrorBound {
    std::optional<double> degrees;
    std::optional<BoundKind> kind;  ///< rms unless told.
};

}  // namespace relief::tools
