// SPDX-License-Identifier: Apache-2.0
/// \file
/// Options that set one field of all materials, of the environment or of the scene. The words, the
/// limits and the type of their values come from the description of the field
/// (relief/shade/scene_fields.h).
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "common/options.h"
#include "relief/shade/scene_fields.h"

namespace relief::tools {

/// The fields of an Owner that options set, and their values.
template <typename Owner>
class FieldChanges {
  public:
    template <typename Value>
    void set(Value Owner::*member, const std::type_identity_t<Value>& value) {
        changes_[field_of(member).name] = [member, value](Owner& owner) { owner.*member = value; };
    }
    template <typename Value>
    [[nodiscard]] bool has(Value Owner::*member) const {
        return changes_.contains(field_of(member).name);
    }
    template <typename Value>
    [[nodiscard]] std::optional<Value> get(Value Owner::*member) const {
        if (!has(member)) return std::nullopt;
        Owner owner;
        changes_.at(field_of(member).name)(owner);
        return owner.*member;
    }
    [[nodiscard]] bool empty() const { return changes_.empty(); }
    void apply(Owner& owner) const {
        for (const auto& [name, change] : changes_)
            change(owner);
    }

  private:
    std::map<std::string_view, std::function<void(Owner&)>> changes_;  ///< By name of the field.
};

/// The limits of an option that sets a field of the scene.
template <typename Owner, typename Value>
Range field_limits(Value Owner::*member) {
    const FieldRange range = field_of(member).range;
    return {static_cast<double>(range.min), static_cast<double>(range.max), ""};
}

/// Adds an option that sets a field by a word: of an enumeration, or on and off.
template <typename Owner, typename Value>
requires std::is_enum_v<Value> || std::is_same_v<Value, bool> AddedOption
add_field(CLI::App& app, FieldChanges<Owner>& changes, const std::string& option,
          Value Owner::*member, const std::string& description) {
    Choices<Value> words;
    if constexpr (std::is_same_v<Value, bool>)
        words = {{"on", true}, {"off", false}};
    else
        words = enum_choices<Value>();
    return add_choice<Value>(app, option, words, description,
                             [&changes, member](Value value) { changes.set(member, value); });
}

/// Adds an option that sets a field by a number, which becomes a gray if the field is a color.
template <typename Owner, typename Value>
AddedOption add_field(CLI::App& app, FieldChanges<Owner>& changes, const std::string& option,
                      const std::string& value_name, Value Owner::*member,
                      const std::string& description) {
    const Range range = field_limits(member);
    return add_value(
        app, option, value_name, description,
        [&changes, member, range](const std::string& subject, const std::string& text) {
            if constexpr (std::is_same_v<Value, int>)
                changes.set(member, parse_integer(subject, text, static_cast<int>(range.min),
                                                  static_cast<int>(range.max)));
            else
                changes.set(member, Value(static_cast<float>(parse_number(subject, text, range))));
        });
}

}  // namespace relief::tools
