// SPDX-License-Identifier: Apache-2.0
#include "json_cursor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "near_names.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

using Json = nlohmann::json;

/// Escapes a key for a JSON pointer.
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

/// Throws if a key occurs twice in an object; the parser alone would keep the last value. This is a
/// pass of its own, because the parser searches all of an array after each object in it if it has a
/// callback.
class DuplicateKeys : public nlohmann::json_sax<Json> {
  public:
    bool start_object(std::size_t) override {
        open_.emplace_back();
        return true;
    }
    bool key(std::string& key) override {
        if (!open_.back().insert(key).second)
            throw InvalidInput(fmt::format("the key '{}' occurs twice in one object", key));
        return true;
    }
    bool end_object() override {
        open_.pop_back();
        return true;
    }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(Json::number_integer_t) override { return true; }
    bool number_unsigned(Json::number_unsigned_t) override { return true; }
    bool number_float(Json::number_float_t, const std::string&) override { return true; }
    bool string(std::string&) override { return true; }
    bool binary(Json::binary_t&) override { return true; }
    /// The parser reports the error.
    bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override {
        return false;
    }

  private:
    std::vector<std::set<std::string>> open_;
};

}  // namespace

std::string json_problem(const std::exception& error) {
    const std::string_view what = error.what();
    const std::size_t name_end = what.find("] ");
    return std::string(name_end == what.npos ? what : what.substr(name_end + 2));
}

void require_json_depth(std::string_view text, std::size_t max_depth) {
    std::size_t depth = 0;
    bool is_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (is_string) {
            if (c == '\\') ++i;
            if (c == '"') is_string = false;
        } else if (c == '"') {
            is_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > max_depth)
                throw InvalidInput(fmt::format("its JSON is nested deeper than {}", max_depth));
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
}

JsonCursor::JsonCursor(std::shared_ptr<const Json> document, const Json* value,
                       std::string location, Wording wording)
    : document_(std::move(document)),
      value_(value),
      location_(std::move(location)),
      wording_(wording) {}

JsonCursor::JsonCursor(Json&& document, Wording wording)
    : document_(std::make_shared<const Json>(std::move(document))),
      value_(document_.get()),
      wording_(wording) {}

JsonCursor JsonCursor::parse(std::string_view text) {
    constexpr std::size_t max_depth = 1024;
    require_json_depth(text, max_depth);
    DuplicateKeys duplicates;
    Json::sax_parse(text.begin(), text.end(), &duplicates);
    try {
        return JsonCursor(Json::parse(text.begin(), text.end()), Wording::requirement);
    } catch (const Json::exception& error) {
        throw InvalidInput(fmt::format("is not valid JSON: {}", json_problem(error)));
    }
}

JsonCursor JsonCursor::below(const Json& value, std::string_view step) const {
    return {document_, &value, location_ + "/" + escaped(step), wording_};
}

void JsonCursor::fail_type(const char* requirement, const char* type) const {
    fail(wording_ == Wording::requirement
             ? fmt::format("must be {}", requirement)
             : fmt::format("is of type {}, not {}", value_->type_name(), type));
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
    if (!value_->is_object()) fail_type("an object", "object");
    const auto found = value_->find(key);
    if (found == value_->end()) return std::nullopt;
    return below(*found, key);
}

std::optional<JsonCursor> JsonCursor::find_value(std::string_view key) const {
    auto found = find(key);
    if (found && found->is_null()) return std::nullopt;
    return found;
}

JsonCursor JsonCursor::at(std::string_view key) const {
    auto found = find(key);
    if (!found) {
        if (wording_ == Wording::requirement) fail(fmt::format("has no '{}'", key));
        below(*value_, key).fail("is missing");
    }
    return std::move(*found);
}

std::vector<std::string> JsonCursor::keys() const {
    if (!value_->is_object()) fail_type("an object", "object");
    std::vector<std::string> result;
    for (const auto& [key, value] : value_->items())
        result.push_back(key);
    return result;
}

std::vector<std::pair<std::string, JsonCursor>> JsonCursor::members() const {
    if (!value_->is_object()) fail_type("an object", "object");
    std::vector<std::pair<std::string, JsonCursor>> result;
    for (const auto& [key, member] : value_->items())
        result.emplace_back(key, below(member, key));
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
    if (!value_->is_array()) fail_type("an array", "array");
    std::vector<JsonCursor> result;
    for (std::size_t i = 0; i < value_->size(); ++i)
        result.push_back(below((*value_)[i], std::to_string(i)));
    return result;
}

bool JsonCursor::boolean() const {
    if (!value_->is_boolean()) fail_type("true or false", "boolean");
    return value_->get<bool>();
}

const std::string& JsonCursor::text() const {
    if (!value_->is_string()) fail_type("a string", "string");
    return value_->get_ref<const std::string&>();
}

float JsonCursor::number(float min, float max) const {
    if (!value_->is_number()) fail_type("a number", "number");
    const auto value = value_->get<double>();
    // Values beyond the range of float are beyond all limits, so the comparison is in double.
    if (!(value >= static_cast<double>(min) && value <= static_cast<double>(max))) {
        fail(fmt::format("is {}, but must be within [{}, {}]", value, min, max));
    }
    return static_cast<float>(value);
}

double JsonCursor::exact_number() const {
    (void)number();
    return value_->get<double>();
}

double JsonCursor::double_number() const {
    if (!value_->is_number()) fail_type("a number", "number");
    return value_->get<double>();
}

double JsonCursor::number_or_nan() const {
    return value_->is_null() ? std::numeric_limits<double>::quiet_NaN() : double_number();
}

int JsonCursor::whole_number(int min, int max) const {
    if (!value_->is_number_integer() || value_->get<double>() < min ||
        value_->get<double>() > max) {
        fail(fmt::format("must be an integer within [{}, {}]", min, max));
    }
    return value_->get<int>();
}

std::uint64_t JsonCursor::unsigned_number() const {
    if (!value_->is_number_unsigned()) fail("must be an integer of at least 0");
    return value_->get<std::uint64_t>();
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

void JsonCursor::fail(const std::string& problem) const {
    throw InvalidInput(fmt::format("{}: {}", location_.empty() ? "/" : location_, problem));
}

void JsonCursor::fail_unknown(std::string_view value, std::span<const std::string> known) const {
    fail(fmt::format("is '{}', but must be one of {}{}", value, fmt::join(known, ", "),
                     did_you_mean(value, known)));
}

}  // namespace relief::detail
