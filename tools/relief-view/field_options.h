// SPDX-License-Identifier: Apache-2.0
/// \file
/// Names and limits of options that set a field of a scene, from the description of the field
/// (relief/shade/scene_fields.h).
#pragma once

#include "common/options.h"
#include "relief/shade/scene_fields.h"

namespace relief::tools {

/// The names of an enumeration in scene files are those of its option.
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
