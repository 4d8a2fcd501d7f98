// SPDX-License-Identifier: Apache-2.0
/// \file
/// Marks the namespaces whose functions and classes shared libraries of relief export. All others
/// are hidden. Private headers that other components use are marked, too.
#pragma once

#define RELIEF_API [[gnu::visibility("default")]]

#if __cplusplus < 202002L
#error "relief needs C++20 (-std=c++20); programs in C and older C++ use relief/relief.h"
#endif
