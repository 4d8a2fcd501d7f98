// SPDX-License-Identifier: Apache-2.0
/// \file
/// Limits of the memory and the size of inputs, which readers check before they allocate memory,
/// and of the files that a model may name. Tests: tests/mesh/io/image/image_file_test.cpp,
/// tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include <cstdint>

#include "relief/export.h"

namespace RELIEF_API relief {

/// The inputs that are read.
struct InputLimits {
    /// The most bytes of one image or one array of a model, as it is in memory. Computations on it
    /// need a few times as much. 0: three quarters of the memory of the machine, or of its control
    /// group.
    ///
    /// It also limits all contents of one file that can be much larger in memory than the file:
    /// arrays without data, compressed data, and copies of shared data. 0: 256 MiB for these. Files
    /// of more than a 256th of the limit may take 256 times their bytes.
    std::uint64_t memory = 0;
    /// The most texels of an image. 0: a whole image may have as many as `memory` holds, and there
    /// is no limit for images that are read by rows. If it is set, textures that zstd compresses
    /// may have as many, however small their files are.
    std::uint64_t pixels = 0;
    /// True if buffers, materials and images that a model names may lie outside of its folder.
    /// Symbolic links in the folder are followed in any case.
    bool outside_files = false;
};

/// Sets the limits of this process. Inputs that exceed a limit are FileErrors, and images of more
/// bytes cannot be made. Programs call it once, when they start.
void set_input_limits(const InputLimits& limits);

/// Returns the limits of this process; `memory` is never 0.
InputLimits input_limits();

}  // namespace relief
