// SPDX-License-Identifier: Apache-2.0
/// \file
/// Compressed data for programs that read zlib streams, such as browsers.
/// Tests: tests/tools/view_page/view_page_test.cpp.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

/// Returns a zlib stream [RFC 1950] of these bytes, the same on all machines and for any number of
/// threads.
std::string zlib_stream(std::span<const std::byte> bytes);

}  // namespace detail
}  // namespace relief
