// SPDX-License-Identifier: Apache-2.0
// Refuses arrays that are maps of the wrong kind, as the command lines refuse files
// (relief/mesh/map_kind_check.h). Tests: tests/python/test_arrays.py.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"

namespace relief::python {

/// Refuses a map whose texels show another kind. Arrays state none.
/// \param name      of the argument, for the message
/// \param accepted  the kinds that it may have
/// \param assume    the name of the first one, which accepts any texels
/// \throws InvalidInput if the texels clearly show another kind, or `assume` is another name
void check_kind(const ImageView& map, const char* name, const std::vector<MapKind>& accepted,
                const std::optional<std::string>& assume);

/// Returns a report without the findings about maps that are drawn as normal maps.
Report without_assumed_normals(const Report& report);

}  // namespace relief::python
