// SPDX-License-Identifier: Apache-2.0
/// \file
/// A value in a JSON document and its location, read with checks of type and range.
///
/// Every error is an InvalidInput that begins with the location as a JSON pointer (RFC 6901):
/// "/nodes/0/light/type: is ...".
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <glm/glm.hpp>
#include <initializer_list>
#include <limits>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

/// Limits the nesting of a document before it is parsed. Broken text is not noticed.
/// \throws InvalidInput if arrays and objects are nested deeper
void require_json_depth(std::string_view text, std::size_t max_depth);

/// Returns the message of an nlohmann::json::exception without the name of the error in brackets,
/// with which it begins.
std::string json_problem(const std::exception& error);

class JsonCursor {
  public:
    /// The text of errors: "must be a string" and "has no 'id'" for files that people write, "is of
    /// type number, not string" and "is missing" for files that programs write.
    enum class Wording { requirement, type };

    /// Parses a document whose errors say the requirement. A key that occurs twice in one object is
    /// an error.
    static JsonCursor parse(std::string_view text);

    /// Makes the root of a document.
    explicit JsonCursor(nlohmann::json&& document, Wording wording);

    [[nodiscard]] bool is_object() const;
    [[nodiscard]] bool is_array() const;
    [[nodiscard]] bool is_text() const;
    [[nodiscard]] bool is_number() const;
    [[nodiscard]] bool is_null() const;

    /// Returns a member of an object; nullopt if it is absent.
    [[nodiscard]] std::optional<JsonCursor> find(std::string_view key) const;
    /// Returns a member of an object; nullopt if it is absent or null.
    [[nodiscard]] std::optional<JsonCursor> find_value(std::string_view key) const;
    /// Returns a member of an object, which must exist.
    [[nodiscard]] JsonCursor at(std::string_view key) const;
    /// Returns the keys of an object, sorted.
    [[nodiscard]] std::vector<std::string> keys() const;
    /// Returns the members of an object, sorted by key.
    [[nodiscard]] std::vector<std::pair<std::string, JsonCursor>> members() const;
    /// Throws if the value is not an object or has other keys.
    void allow(std::span<const std::string> keys) const;
    void allow(std::initializer_list<const char*> keys) const;
    /// Returns the elements of an array.
    [[nodiscard]] std::vector<JsonCursor> elements() const;

    [[nodiscard]] bool boolean() const;
    [[nodiscard]] const std::string& text() const;
    [[nodiscard]] float number(float min = std::numeric_limits<float>::lowest(),
                               float max = std::numeric_limits<float>::max()) const;
    /// Returns a number within the range of float, not rounded to float.
    [[nodiscard]] double exact_number() const;
    /// Returns any number.
    [[nodiscard]] double double_number() const;
    /// Returns any number; null gives NaN.
    [[nodiscard]] double number_or_nan() const;
    [[nodiscard]] int whole_number(int min, int max) const;
    [[nodiscard]] std::uint64_t unsigned_number() const;
    /// Returns an array of `count` finite numbers.
    [[nodiscard]] std::vector<float> numbers(std::size_t count) const;
    [[nodiscard]] glm::vec3 vector() const;

    /// \throws InvalidInput "LOCATION: problem"
    [[noreturn]] void fail(const std::string& problem) const;
    /// Fails with "is 'tree', but must be one of ...; did you mean ...?".
    [[noreturn]] void fail_unknown(std::string_view value,
                                   std::span<const std::string> known) const;

  private:
    JsonCursor(std::shared_ptr<const nlohmann::json> document, const nlohmann::json* value,
               std::string location, Wording wording);
    [[nodiscard]] JsonCursor below(const nlohmann::json& value, std::string_view step) const;
    /// Fails with the wording of the document; `requirement` is "a string", `type` is "string".
    [[noreturn]] void fail_type(const char* requirement, const char* type) const;

    std::shared_ptr<const nlohmann::json> document_;
    const nlohmann::json* value_;
    std::string location_;
    Wording wording_;
};

}  // namespace detail
}  // namespace relief
