// SPDX-License-Identifier: Apache-2.0
/// \file
/// The named parts of models, and how they are matched, as text and JSON.
/// Tests: tests/make/part_matching_test.cpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/text.h"
#include "relief/make/asset.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/model.h"

namespace relief::tools {

/// Appends the objects of a part of a model, and their triangles.
/// \param file  the name of parts whose objects have none; may be empty
void add_named_parts(const MapModelPart& part, const std::string& file, BakeSide side,
                     make::NamedParts& parts);

/// "3 matched by name: lid, base + hinge, handle", or "not matched by name: it was requested";
/// empty if the model has one part.
std::vector<std::string> part_lines(const make::PartDecision& decision);
Json parts_json(const make::PartDecision& decision);

}  // namespace relief::tools
