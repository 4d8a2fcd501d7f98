// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace relief {

/// Caps the threads that relief's parallel loops use in this process, the caller's among them.
///
/// \param count  at least 1; 0 means as many as the machine has
///
/// No result depends on it, only the time that it takes.
void set_thread_limit(unsigned count);

}  // namespace relief
