// SPDX-License-Identifier: Apache-2.0
/// \file
/// The variants of --compare as text, and their preparation from the options
/// (relief/shade/scene_variant.h):
///
///     interpolation=flat  map=bump_map  kernel=central3  tangents=lengyel  bits=8  normals=area
///
/// Tests: tests/tools/variant_test.cpp.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/command.h"
#include "relief/shade/scene_variant.h"
#include "view_options.h"

namespace relief::tools {

/// All variants of one property.
struct VariantTopic {
    std::string name;  ///< For example "kernel".
    std::string what;  ///< For example "The kernel that computes slopes from heights".
    std::vector<std::pair<std::string, Variant>> choices;
};
const std::vector<VariantTopic>& variant_topics();

/// \throws UsageError with the valid names
Variant parse_variant(const std::string& subject, const std::string& text);

/// For example "kernel=central3". The inverse of parse_variant().
std::string to_text(const Variant& variant);

/// Prepares a variant.
/// \param options  the options of the scene, which contain its height map
/// \throws UsageError if the variant would change nothing
/// \throws FileError if a map cannot be read
shade::PreparedVariant prepare(const Variant& variant, const shade::Scene& scene,
                               const ViewOptions& options, Report& report);

}  // namespace relief::tools
