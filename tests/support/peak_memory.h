// SPDX-License-Identifier: Apache-2.0
/// \file
/// The most memory that this process held so far: libraries, threads and all.
///
/// A test of it has the process to itself, or it sees what others took. It links
/// relief_memory_test_support, without which AddressSanitizer counts up to 256 MB of what was
/// freed.
#pragma once

namespace relief::test {

double peak_megabytes();

}  // namespace relief::test
