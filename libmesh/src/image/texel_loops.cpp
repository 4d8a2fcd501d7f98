// SPDX-License-Identifier: Apache-2.0
#include "image/texel_loops.h"

#include <fmt/format.h>

#include "relief/mesh/error.h"

namespace relief {

void check_floats(const Image& image, int channels, const char* what) {
    if (image.empty()) throw InvalidInput(fmt::format("an empty image holds no {}", what));
    if (image.channels != channels || image.bits() != 32) {
        throw InvalidInput(fmt::format("{} have {} float channels, not {} of {} bits", what,
                                       channels, image.channels, image.bits()));
    }
}

}  // namespace relief
