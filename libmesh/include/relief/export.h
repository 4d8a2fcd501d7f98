// SPDX-License-Identifier: Apache-2.0
/// \file
/// Marks the namespaces whose functions and classes shared libraries of relief export. All others
/// are hidden. Private headers that other components use are marked, too.
#pragma once

#define RELIEF_API [[gnu::visibility("default")]]
