// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks of the limits of this process (relief/mesh/limits.h) before memory is allocated.
#pragma once

#include <cstdint>
#include <filesystem>

#include "relief/export.h"

namespace RELIEF_API relief {

/// \throws InvalidInput if `count` elements of `size` bytes exceed the limit of memory
void require_memory(std::uint64_t count, std::uint64_t size);

/// \throws FileError if `count` elements of `size` bytes exceed the limit of memory
void require_memory_for(const std::filesystem::path& file, std::uint64_t count,
                        std::uint64_t size = 1);

/// \throws FileError if an image exceeds the limit of pixels
void require_pixels(const std::filesystem::path& file, int width, int height);

}  // namespace relief
