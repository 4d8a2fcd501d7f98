// SPDX-License-Identifier: Apache-2.0
/// \file
/// Vertex attributes in 16 bits, for smaller pages (--page-quantize).
/// Tests: tests/tools/view_page/view_page_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/shade/page.h"

namespace relief::tools {

/// Floats as codes: value = min + (max - min) code / 65535, by component.
struct QuantizedFloats {
    std::vector<float> min;
    std::vector<float> max;
    std::vector<std::uint16_t> codes;
    double error = 0;  ///< The largest difference of a component.
};

/// Returns nothing if a value is not finite.
std::optional<QuantizedFloats> quantized(std::span<const float> values, std::size_t components);

/// The sections that were quantized, and the largest error of each attribute.
struct PageQuantization {
    std::map<std::size_t, QuantizedFloats> sections;
    std::map<std::string, double> errors;
};

/// Quantizes the attributes of all meshes whose values are finite.
PageQuantization quantized(const shade::PageDescription& page);

}  // namespace relief::tools
