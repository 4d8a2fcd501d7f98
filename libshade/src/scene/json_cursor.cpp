// SPDX-License-Identifier: Apache-2.0
// JSON by nlohmann-json, read through typed cursors. Colours come out linear. What is not as asked
// throws InvalidInput with its JSON pointer. Tests: tests/shade/scene/scene_json_test.cpp.
#include "scene/json_cursor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "near_names.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image.h"

namespace relief {

namespace {

using PlainJson = nlohmann::json;

/// A key as a step of a JSON pointer.
std::string escaped(std::string_view key) {
    std::string result;
    for (const char c : key) {
        if (c == '~') {
            result += "~0";
        } else if (c == '/') {
            result += "~1";
        } else {
            result += c;
        }
    }
    return result;
}

/// Refuses keys that stand twice in an object, of which JSON parsers keep the last.
class DuplicateKeys {
  public:
    bool operator()(int, PlainJson::parse_event_t event, PlainJson& value) {
        if (event == PlainJson::parse_event_t::object_start) open_.emplace_back();
        if (event == PlainJson::parse_event_t::object_end) open_.pop_back();
        if (event == PlainJson::parse_event_t::key &&
            !open_.back().insert(value.get<std::string>()).second) {
            throw InvalidInput(
                fmt::format("the key '{}' stands twice in one object", value.get<std::string>()));
        }
        return true;
    }

  private:
    std::vector<std::set<std::string>> open_;
};

/// The value of two hexadecimal digits, over 255.
std::optional<float> hex_code(std::string_view digits) {
    int code = 0;
    for (const char c : digits) {
        int digit = 0;
        if (c >= '0' && c <= '9') {
            digit = c - '0';
        } else if (c >= 'a' && c <= 'f') {
            digit = c - 'a' + 10;
        } else if (c >= 'A' && c <= 'F') {
            digit = c - 'A' + 10;
        } else {
            return std::nullopt;
        }
        code = 16 * code + digit;
    }
    return static_cast<float>(code) / 255.0F;
}

}  // namespace

JsonCursor::JsonCursor(std::shared_ptr<const PlainJson> document, const PlainJson* value,
                       std::string place)
    : document_(std::move(document)), value_(value), place_(std::move(place)) {}

JsonCursor JsonCursor::parse(std::string_view text) {
    DuplicateKeys duplicates;
    try {
        auto document = std::make_shared<const PlainJson>(
            PlainJson::parse(text.begin(), text.end(), std::ref(duplicates)));
        const PlainJson* root = document.get();
        return {std::move(document), root, ""};
    } catch (const PlainJson::exception& error) {
        throw InvalidInput(fmt::format("is no JSON: {}", error.what()));
    }
}

JsonCursor JsonCursor::below(const PlainJson& value, std::string_view step) const {
    return {document_, &value, place_ + "/" + escaped(step)};
}

bool JsonCursor::is_object() const {
    return value_->is_object();
}
bool JsonCursor::is_array() const {
    return value_->is_array();
}
bool JsonCursor::is_text() const {
    return value_->is_string();
}
bool JsonCursor::is_number() const {
    return value_->is_number();
}
bool JsonCursor::is_null() const {
    return value_->is_null();
}

std::optional<JsonCursor> JsonCursor::find(std::string_view key) const {
    if (!value_->is_object()) fail("must be an object");
    const auto found = value_->find(key);
    if (found == value_->end()) return std::nullopt;
    return below(*found, key);
}

JsonCursor JsonCursor::at(std::string_view key) const {
    auto found = find(key);
    if (!found) fail(fmt::format("has no '{}'", key));
    return std::move(*found);
}

std::vector<std::string> JsonCursor::keys() const {
    if (!value_->is_object()) fail("must be an object");
    std::vector<std::string> result;
    for (const auto& [key, value] : value_->items())
        result.push_back(key);
    return result;
}

void JsonCursor::allow(std::span<const std::string> known) const {
    for (const std::string& key : keys()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        fail(fmt::format("'{}' is not known here{} (known: {})", key, did_you_mean(key, known),
                         fmt::join(known, ", ")));
    }
}

void JsonCursor::allow(std::initializer_list<const char*> known) const {
    allow(std::vector<std::string>(known.begin(), known.end()));
}

std::vector<JsonCursor> JsonCursor::elements() const {
    if (!value_->is_array()) fail("must be an array");
    std::vector<JsonCursor> result;
    for (std::size_t i = 0; i < value_->size(); ++i)
        result.push_back(below((*value_)[i], std::to_string(i)));
    return result;
}

bool JsonCursor::boolean() const {
    if (!value_->is_boolean()) fail("must be true or false");
    return value_->get<bool>();
}

const std::string& JsonCursor::text() const {
    if (!value_->is_string()) fail("must be a string");
    return value_->get_ref<const std::string&>();
}

float JsonCursor::number(float least, float most) const {
    if (!value_->is_number()) fail("must be a number");
    const auto value = value_->get<double>();
    // Comparing in double: what is beyond float's range is beyond every limit.
    if (!(value >= static_cast<double>(least) && value <= static_cast<double>(most))) {
        fail(fmt::format("is {}, but must be within [{}, {}]", value, least, most));
    }
    return static_cast<float>(value);
}

double JsonCursor::exact_number() const {
    (void)number();
    return value_->get<double>();
}

int JsonCursor::whole_number(int least, int most) const {
    if (!value_->is_number_integer() || value_->get<double>() < least ||
        value_->get<double>() > most) {
        fail(fmt::format("must be a whole number within [{}, {}]", least, most));
    }
    return value_->get<int>();
}

std::vector<float> JsonCursor::numbers(std::size_t count) const {
    if (!value_->is_array() || value_->size() != count)
        fail(fmt::format("must be an array of {} numbers", count));
    std::vector<float> result;
    for (const JsonCursor& element : elements())
        result.push_back(element.number());
    return result;
}

glm::vec3 JsonCursor::vector() const {
    const std::vector<float> values = numbers(3);
    return {values[0], values[1], values[2]};
}

glm::vec3 JsonCursor::color() const {
    if (value_->is_number()) return glm::vec3(number());
    if (value_->is_array()) return vector();
    const char* const allowed = "must be three numbers, one number, or \"#rrggbb\"";
    if (!value_->is_string()) fail(allowed);
    const std::string& code = text();
    if (code.size() != 7 || code.front() != '#') fail(allowed);
    glm::vec3 color(0.0F);
    for (int i = 0; i < 3; ++i) {
        const auto channel =
            hex_code(std::string_view(code).substr(1 + 2 * static_cast<std::size_t>(i), 2));
        if (!channel) fail(allowed);
        color[i] = linear_from_srgb(*channel);
    }
    return color;
}

void JsonCursor::fail(const std::string& problem) const {
    throw InvalidInput(fmt::format("{}: {}", place_.empty() ? "/" : place_, problem));
}

void JsonCursor::fail_unknown(std::string_view found, std::span<const std::string> known) const {
    fail(fmt::format("is '{}', but must be one of {}{}", found, fmt::join(known, ", "),
                     did_you_mean(found, known)));
}

}  // namespace relief
