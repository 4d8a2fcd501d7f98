// SPDX-License-Identifier: Apache-2.0
/// \file
/// Names and limits of options for scene fields, derived from the description of the fields
/// (relief/shade/scene_fields.h).
#pragma once

#include "common/options.h"
#include "relief/shade/scene_fields.h"

namespace relief::tools {

/// Options use the same enumeration names as scene files.
template <typename Enum>
Choices<Enum> enum_choices() {
    Choices<Enum> choices;
    for (const EnumName<Enum>& entry : enum_names<Enum>)
        choices.emplace_back(entry.name, entry.value);
    return choices;
}

template <typename Owner, typename Value>
Range field_limits(Value Owner::*member) {
    const FieldRange range = field_range(member);
    return {static_cast<double>(range.min), static_cast<double>(range.max), ""};
}

}  // namespace relief::tools
