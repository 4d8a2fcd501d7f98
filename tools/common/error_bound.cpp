// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/error_bound_test.cpp.
#include "common/error_bound.h"

#include <fmt/format.h>

#include "common/options.h"

namespace relief::tools {

std::string to_string(const ErrorBound& bound) {
    return fmt::format("{:g} degrees ({})", bound.degrees.value_or(0.0),
                       statistic_name(bound.statistic()));
}

void add_error_bound(CLI::App& app, ErrorBound& bound, const std::string& group,
                     const std::string& description) {
    add_number(app, "--max-error", "DEG", bound.degrees, {0.0, 180.0, "degrees"}, description)
        .group(group);
    add_choice(app, "--max-error-kind", bound.kind, enum_choices<ErrorKind>(),
               "The statistic that --max-error limits: the mean, the root mean square, the error "
               "that 99 % do not exceed (p99), or the maximum. Default: p99.")
        .group(group);
}

void check(const ErrorBound& bound, bool limits_other) {
    if (bound.kind && !bound.degrees && !limits_other)
        throw UsageError("--max-error-kind: has no effect without --max-error",
                         "give --max-error DEG");
}

}  // namespace relief::tools
