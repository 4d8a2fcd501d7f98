// SPDX-License-Identifier: Apache-2.0
/// \file
/// Height maps and wrap modes as arguments.
#pragma once

#include <optional>
#include <string>

#include "arrays.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief::python {

/// Returns the wrap modes of "repeat", or of two such names for u and v.
/// \throws InvalidInput for another name
Wraps wraps_of(const std::string& text);

/// Returns the heights of an array, one channel.
/// \param name     of the argument, for messages
/// \param channel  the name of a HeightChannel
/// \param assume   "height" accepts texels that show another kind
Image heights_of(const py::object& height, const char* name, const std::string& channel,
                 const std::optional<std::string>& assume, Report& findings);

}  // namespace relief::python
