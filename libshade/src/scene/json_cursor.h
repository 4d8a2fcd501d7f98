// SPDX-License-Identifier: Apache-2.0
/// \file
/// A place in a JSON document, and what stands there, typed and within limits. The only header that
/// scene files are read through: json_cursor.cpp alone knows nlohmann-json. Every complaint is an
/// InvalidInput that begins with the place as a JSON pointer (RFC 6901):
/// "/nodes/0/light/type: is ...". Tests: tests/shade/scene/scene_json_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <initializer_list>
#include <limits>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

class JsonCursor {
  public:
    /// The whole of a document. Keys that stand twice in an object are an error.
    static JsonCursor parse(std::string_view text);

    [[nodiscard]] bool is_object() const;
    [[nodiscard]] bool is_array() const;
    [[nodiscard]] bool is_text() const;
    [[nodiscard]] bool is_number() const;
    [[nodiscard]] bool is_null() const;

    /// Of an object: its member, or nothing.
    [[nodiscard]] std::optional<JsonCursor> find(std::string_view key) const;
    /// The same, but it must be there.
    [[nodiscard]] JsonCursor at(std::string_view key) const;
    /// Of an object: its keys, sorted.
    [[nodiscard]] std::vector<std::string> keys() const;
    /// Refuses other keys than these, and what is no object.
    void allow(std::span<const std::string> keys) const;
    void allow(std::initializer_list<const char*> keys) const;
    /// Of an array: its elements.
    [[nodiscard]] std::vector<JsonCursor> elements() const;

    [[nodiscard]] bool boolean() const;
    [[nodiscard]] const std::string& text() const;
    [[nodiscard]] float number(float least = std::numeric_limits<float>::lowest(),
                               float most = std::numeric_limits<float>::max()) const;
    /// The same before it becomes a float.
    [[nodiscard]] double exact_number() const;
    [[nodiscard]] int whole_number(int least, int most) const;
    /// An array of so many finite numbers.
    [[nodiscard]] std::vector<float> numbers(std::size_t count) const;
    [[nodiscard]] glm::vec3 vector() const;
    /// Linear light: three numbers, one number for grey, or "#rrggbb", an sRGB code.
    [[nodiscard]] glm::vec3 color() const;

    /// \throws InvalidInput "PLACE: problem"
    [[noreturn]] void fail(const std::string& problem) const;
    /// "is 'lamp', but must be one of ...; did you mean ...?"
    [[noreturn]] void fail_unknown(std::string_view found,
                                   std::span<const std::string> known) const;

  private:
    JsonCursor(std::shared_ptr<const nlohmann::json> document, const nlohmann::json* value,
               std::string place);
    [[nodiscard]] JsonCursor below(const nlohmann::json& value, std::string_view step) const;

    std::shared_ptr<const nlohmann::json> document_;
    const nlohmann::json* value_;
    std::string place_;
};

}  // namespace relief
