// SPDX-License-Identifier: Apache-2.0
// Typed access with complaints that name the place. Tests: tests/tools/accuracy_report_test.cpp.
#include "json_place.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "relief/mesh/error.h"

namespace relief::tools {

JsonPlace::JsonPlace(const nlohmann::json& value, std::string place)
    : value_(&value), place_(std::move(place)) {}

void JsonPlace::fail(const std::string& problem) const {
    throw InvalidInput(fmt::format("{}: {}", place_.empty() ? "/" : place_, problem));
}

std::optional<JsonPlace> JsonPlace::find(const std::string& key) const {
    if (!value_->is_object()) fail(fmt::format("is of type {}, not object", value_->type_name()));
    const auto found = value_->find(key);
    if (found == value_->end() || found->is_null()) return std::nullopt;
    return JsonPlace(*found, place_ + "/" + key);
}

JsonPlace JsonPlace::at(const std::string& key) const {
    if (!value_->is_object()) fail(fmt::format("is of type {}, not object", value_->type_name()));
    const auto found = value_->find(key);
    if (found == value_->end()) JsonPlace(*value_, place_ + "/" + key).fail("is missing");
    return JsonPlace(*found, place_ + "/" + key);
}

std::vector<JsonPlace> JsonPlace::elements() const {
    if (!value_->is_array()) fail(fmt::format("is of type {}, not array", value_->type_name()));
    std::vector<JsonPlace> all;
    for (const nlohmann::json& element : *value_)
        all.emplace_back(element, fmt::format("{}/{}", place_, all.size()));
    return all;
}

std::vector<std::pair<std::string, JsonPlace>> JsonPlace::members() const {
    if (!value_->is_object()) fail(fmt::format("is of type {}, not object", value_->type_name()));
    std::vector<std::pair<std::string, JsonPlace>> all;
    for (const auto& [key, member] : value_->items())
        all.emplace_back(key, JsonPlace(member, place_ + "/" + key));
    return all;
}

std::string JsonPlace::text() const {
    if (!value_->is_string()) fail(fmt::format("is of type {}, not string", value_->type_name()));
    return value_->get<std::string>();
}

bool JsonPlace::boolean() const {
    if (!value_->is_boolean()) fail(fmt::format("is of type {}, not boolean", value_->type_name()));
    return value_->get<bool>();
}

double JsonPlace::number() const {
    if (!value_->is_number()) fail(fmt::format("is of type {}, not number", value_->type_name()));
    return value_->get<double>();
}

double JsonPlace::number_or_nan() const {
    return value_->is_null() ? std::numeric_limits<double>::quiet_NaN() : number();
}

std::uint64_t JsonPlace::whole_number() const {
    if (!value_->is_number_unsigned()) fail("is not a whole number of 0 or more");
    return value_->get<std::uint64_t>();
}

}  // namespace relief::tools
