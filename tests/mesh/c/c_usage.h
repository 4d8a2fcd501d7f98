// SPDX-License-Identifier: Apache-2.0
/// \file
/// The C interface as strict C99 calls it.
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

/// Calls functions of the C interface. \return the first call that did not do as documented, or
/// NULL
const char* problem_of_c_usage(void);

#ifdef __cplusplus
}
#endif
