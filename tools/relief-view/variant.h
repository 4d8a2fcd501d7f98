// SPDX-License-Identifier: Apache-2.0
/// \file
/// One change to a scene, to be seen beside the scene as it is, and the words for it:
///
///     interpolation=flat  map=bump_map  kernel=central3  tangents=lengyel  bits=8  normals=area
///
/// What a change does to a scene: variant_scene.h. Tests: tests/tools/variant_test.cpp.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/shade/material.h"

namespace relief::tools {

/// What bends the normals.
enum class MapUse { none, bump_map, normal_map };

/// Where the frame of a normal or bump map comes from, of all that there are.
enum class TangentBasis { stored, mikktspace, area_weighted, lengyel, derivatives };

/// Of a normal map's codes.
enum class MapBits { eight = 8, sixteen = 16 };

using Variant = std::variant<Interpolation, MapUse, Kernel, TangentBasis, MapBits, NormalMode>;

/// All variants of one thing.
struct VariantTopic {
    std::string name;  ///< "kernel"
    std::string what;  ///< "How slopes are taken from heights"
    std::vector<std::pair<std::string, Variant>> choices;
};
const std::vector<VariantTopic>& variant_topics();

/// \throws UsageError naming what there is
Variant parse_variant(const std::string& subject, const std::string& text);

/// "kernel=central3", as parse_variant takes it.
std::string to_text(const Variant& variant);

}  // namespace relief::tools
