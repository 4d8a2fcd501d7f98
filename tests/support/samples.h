// SPDX-License-Identifier: Apache-2.0
/// \file
/// The samples of an image as a value, so that those of a temporary can be looked at.
#pragma once

#include <variant>
#include <vector>

#include "relief/mesh/image.h"

namespace relief::test {

template <typename T>
std::vector<T> samples_of(const Image& image) {
    return std::get<std::vector<T>>(image.samples);
}

}  // namespace relief::test
