// SPDX-License-Identifier: Apache-2.0
/// \file
/// Describes the fields of plain structs: name, range, unit, label and glTF path. Reading, writing,
/// validation, options and panels derive from these descriptions. The default of a field is that of
/// its struct: default_value().
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"

namespace RELIEF_API relief {

/// The limits of a number, or of every component of a color; both are allowed values.
struct FieldRange {
    float min = std::numeric_limits<float>::lowest();
    float max = std::numeric_limits<float>::max();

    friend constexpr bool operator==(const FieldRange&, const FieldRange&) = default;
};

/// The range of numbers that must be positive. Its minimum is the smallest value that a file may
/// name; in memory every positive value is valid.
inline constexpr FieldRange positive_range{1e-30F};

inline constexpr FieldRange non_negative_range{0.0F};

/// The unit of a number or vector.
enum class FieldUnit {
    none,   ///< A factor, an exponent, a flag, a name.
    color,  ///< Linear red, green and blue; with a fourth component: alpha, from 0 to 1.
    texels,
    pixels,  ///< Of the picture.
    nanometers,
    world_length,
    world_position,
    world_direction,  ///< Any length but 0.
    radians,          ///< Degrees in files and on command lines.
    radians_per_second,
};

/// Replaces underscores by spaces.
inline std::string spaced(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

/// Begins an English text with a capital letter.
inline std::string capitalized(std::string text) {
    if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
        text.front() = static_cast<char>(text.front() - 'a' + 'A');
    return text;
}

/// The names of an enumeration's values in panels, in the order of its table of names.
template <typename Enum>
std::vector<std::string> enum_labels() {
    std::vector<std::string> labels;
    for (const EnumName<Enum>& entry : enum_names<Enum>)
        labels.push_back(entry.label != nullptr ? entry.label : capitalized(spaced(entry.name)));
    return labels;
}

/// The description of one member of a struct.
template <typename Owner, typename Value>
struct SceneField {
    /// The key in scene files. If empty, the fields of the member are in the owner's own object.
    const char* name;
    Value Owner::*member;
    FieldRange range;
    FieldUnit unit;
    const char* label_text;
    /// The path of the property in a material of glTF, as in the pointers of
    /// KHR_animation_pointer: "pbrMetallicRoughness/metallicFactor". Empty if glTF does not have it
    /// or stores another value.
    const char* gltf;
    FieldRange gltf_range;    ///< The values that glTF permits: in_gltf(), else the range.
    FieldRange slider_range;  ///< The values of a slider: on_slider(), else the range.

    constexpr SceneField(const char* key, Value Owner::*of, FieldRange accepted = {},
                         FieldUnit in = {}, const char* text = nullptr, const char* path = "")
        : name(key),
          member(of),
          range(accepted),
          unit(in),
          label_text(text),
          gltf(path),
          gltf_range(accepted),
          slider_range(accepted) {}

    [[nodiscard]] constexpr SceneField labeled(const char* text) const {
        SceneField result = *this;
        result.label_text = text;
        return result;
    }
    [[nodiscard]] constexpr SceneField in_gltf(FieldRange permitted) const {
        SceneField result = *this;
        result.gltf_range = permitted;
        return result;
    }
    [[nodiscard]] constexpr SceneField on_slider(FieldRange shown) const {
        SceneField result = *this;
        result.slider_range = shown;
        return result;
    }

    /// The name of the field in messages: label_text, or the name with spaces instead of
    /// underscores.
    [[nodiscard]] std::string label() const {
        return label_text != nullptr ? label_text : spaced(name);
    }
    /// The name of the field in panels: the label with a capital initial.
    [[nodiscard]] std::string title() const { return capitalized(label()); }
    [[nodiscard]] Value default_value() const { return Owner{}.*member; }
};

/// The fields of T as a tuple of SceneField, in the order in which scene files are written. Empty
/// for a type that is one value.
template <typename T>
inline constexpr auto fields_of = std::tuple<>{};

template <typename T>
inline constexpr bool has_fields = std::tuple_size_v<std::decay_t<decltype(fields_of<T>)>> != 0;

template <typename T>
inline constexpr bool is_optional_value = false;
template <typename T>
inline constexpr bool is_optional_value<std::optional<T>> = true;

/// Calls visit(field) for every field of T, in order.
template <typename T, typename Visit>
constexpr void for_each_field(const Visit& visit) {
    std::apply([&](const auto&... fields) { (visit(fields), ...); }, fields_of<T>);
}

/// Returns the description of a member that has one.
template <typename Owner, typename Value>
constexpr SceneField<Owner, Value> field_of(Value Owner::*member) {
    SceneField<Owner, Value> found{"", member};
    for_each_field<Owner>([&](const auto& field) {
        if constexpr (std::is_same_v<std::decay_t<decltype(field)>, SceneField<Owner, Value>>) {
            if (field.member == member) found = field;
        }
    });
    return found;
}

}  // namespace relief
