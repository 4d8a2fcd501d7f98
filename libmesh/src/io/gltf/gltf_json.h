// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reading properties of glTF's JSON, with defaults where they are absent.
///
/// For documents that check_gltf (gltf_check.h) has passed: known properties have their types.
/// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "relief/mesh/error.h"

namespace relief {

/// Keys are kept sorted; JSON gives their order no meaning.
using Json = nlohmann::json;

/// \throws InvalidInput always, saying what the values make of `format`
template <typename... Values>
[[noreturn]] void fail_gltf(fmt::format_string<Values...> format, Values&&... values) {
    throw InvalidInput(fmt::format(format, std::forward<Values>(values)...));
}

/// A property, or null where it is absent.
inline const Json* find(const Json& object, const char* key) {
    const auto it = object.find(key);
    return it == object.end() ? nullptr : &*it;
}

/// What lies under several keys, one inside the other, or null.
template <typename... Keys>
const Json* find(const Json& object, const char* key, const char* next, Keys... rest) {
    const Json* inner = find(object, key);
    return inner == nullptr || !inner->is_object() ? nullptr : find(*inner, next, rest...);
}

/// An array of the document, empty where it is absent.
inline const Json& array_in(const Json& object, const char* key) {
    static const Json empty = Json::array();
    const Json* array = find(object, key);
    return array == nullptr ? empty : *array;
}

inline std::optional<std::size_t> index_in(const Json& object, const char* key) {
    const Json* value = find(object, key);
    return value == nullptr ? std::nullopt : std::optional(value->get<std::size_t>());
}

inline std::size_t size_in(const Json& object, const char* key, std::size_t absent = 0) {
    return index_in(object, key).value_or(absent);
}

inline float float_in(const Json& object, const char* key, float absent) {
    const Json* value = find(object, key);
    return value == nullptr ? absent : value->get<float>();
}

inline bool bool_in(const Json& object, const char* key) {
    const Json* value = find(object, key);
    return value != nullptr && value->get<bool>();
}

inline std::string text_in(const Json& object, const char* key) {
    const Json* value = find(object, key);
    return value == nullptr ? std::string() : value->get<std::string>();
}

/// A glm vector; its components are `absent` where the property is.
template <typename Vector>
Vector vector_in(const Json& object, const char* key, Vector absent) {
    const Json* value = find(object, key);
    if (value == nullptr) return absent;
    Vector result;
    for (int i = 0; i < Vector::length(); ++i) {
        result[i] = value->at(static_cast<std::size_t>(i)).template get<float>();
    }
    return result;
}

}  // namespace relief
