// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commit from which the tools were built. cmake/commit.cmake writes the definition.
#pragma once

namespace relief::tools {

/// Twelve digits, with "-modified" if the sources were changed; empty if the sources do not say.
extern const char* const build_commit;

}  // namespace relief::tools
