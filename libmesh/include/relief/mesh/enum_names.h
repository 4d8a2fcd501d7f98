// SPDX-License-Identifier: Apache-2.0
/// \file
/// The names of enumerators in files, on command lines and in reports. An enumeration has one table
/// of names, which follows its definition.
#pragma once

#include <array>

#include "relief/export.h"

namespace RELIEF_API relief {

/// A value of an enumeration and its name.
template <typename Enum>
struct EnumName {
    const char* name;
    Enum value;
    const char* label = nullptr;  ///< In panels, if the name is not suitable.
};

/// The names of all values of an enumeration; empty for a type without names.
template <typename Enum>
inline constexpr auto enum_names = std::array<EnumName<Enum>, 0>{};

/// Returns the name of an enumeration's value.
template <typename Enum>
constexpr const char* enum_name(Enum value) {
    for (const EnumName<Enum>& entry : enum_names<Enum>) {
        if (entry.value == value) return entry.name;
    }
    return "";
}

}  // namespace relief
