// SPDX-License-Identifier: Apache-2.0
/// \file
/// The limit of measured angles, which means the same in all commands: `--max-error DEG` limits the
/// error that 99 % of the texels or vertices do not exceed, and `--max-error-kind` selects another
/// statistic. Tests: tests/tools/error_bound_test.cpp.
#pragma once

#include <optional>
#include <string>

#include "common/command.h"
#include "relief/mesh/statistics.h"

namespace relief::tools {

/// A limit of the error.
struct ErrorBound {
    std::optional<double> degrees;
    std::optional<ErrorKind> kind;  ///< Absent: default_error_kind.

    [[nodiscard]] ErrorKind statistic() const { return kind.value_or(default_error_kind); }
    /// The error that the limit applies to.
    [[nodiscard]] double error(const ErrorStats& errors) const {
        return errors.*figure_of(statistic());
    }
    [[nodiscard]] bool allows(const ErrorStats& errors) const {
        return !degrees || error(errors) <= *degrees;
    }
};

/// "0.5 degrees (99 %)"
std::string to_string(const ErrorBound& bound);

/// Adds --max-error and --max-error-kind.
/// \param group  the heading in the help
/// \param description  the effect of the limit
void add_error_bound(CLI::App& app, ErrorBound& bound, const std::string& group,
                     const std::string& description);

/// \param limits_other  whether another option is a limit of the same statistic
/// \throws UsageError if a kind is given without a limit
void check(const ErrorBound& bound, bool limits_other = false);

}  // namespace relief::tools
