// SPDX-License-Identifier: Apache-2.0
/// \file
/// Limits the number of threads of parallel loops.
#pragma once

namespace relief {

/// Sets the maximum number of threads of relief's parallel loops in this process, including the
/// calling thread. Results do not depend on it.
///
/// \param count  at least 1; 0 means the number of hardware threads
void set_thread_limit(unsigned count);

}  // namespace relief
