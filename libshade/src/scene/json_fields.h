// SPDX-License-Identifier: Apache-2.0
/// \file
/// Described fields (scene_fields.h) in JSON, both ways. What fields_json() writes, read_fields()
/// reads back bit for bit. Errors are InvalidInput with the place in the document.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "json_cursor.h"
#include "relief/shade/scene_fields.h"

namespace relief::shade::detail {

// Reading

/// The images of a scene by file; each file is one image.
class JsonImages {
  public:
    /// \param scene_file  relative paths begin in its folder
    JsonImages(const std::filesystem::path& scene_file, std::vector<ImageSource>& images)
        : scene_file_(scene_file), folder_(scene_file.parent_path()), images_(images) {}

    /// Returns the file that a string names. \throws InvalidInput if it does not exist
    [[nodiscard]] std::filesystem::path file(const relief::detail::JsonCursor& cursor) const;
    /// Returns the folder that a string names; it need not exist.
    [[nodiscard]] std::filesystem::path folder(const relief::detail::JsonCursor& cursor) const;
    [[nodiscard]] ImageSource source(const relief::detail::JsonCursor& cursor) const;
    /// Returns the texture of an image. A missing file is no error here: the renderer reports it.
    Texture texture(const relief::detail::JsonCursor& cursor);
    /// Sets the green direction and the space of a normal map as its file states them, unless the
    /// scene does.
    /// \param cursor  the map: a texture, or an object with one
    void apply_description(const relief::detail::JsonCursor& cursor, NormalMap& map) const;

  private:
    [[nodiscard]] std::size_t model_image(const relief::detail::JsonCursor& number) const;

    std::filesystem::path scene_file_;
    std::filesystem::path folder_;
    std::vector<ImageSource>& images_;
    std::map<std::filesystem::path, std::size_t> index_of_;
};

/// Returns a linear color: three numbers, one number for gray, or "#rrggbb", which is sRGB-coded.
glm::vec3 color_in(const relief::detail::JsonCursor& cursor);
/// Returns degrees as radians. The conversion is in double, so that a written angle gives the same
/// bits.
float radians_from(const relief::detail::JsonCursor& cursor);
/// Returns a vector of any length but 0.
glm::vec3 direction_from(const relief::detail::JsonCursor& cursor);
/// Returns a matrix by columns.
glm::mat4 matrix_from(const relief::detail::JsonCursor& cursor);

/// Returns the value of that name. Another name is refused with all names.
template <typename Names>
auto one_of(const relief::detail::JsonCursor& cursor, const Names& names) {
    std::vector<std::string> known;
    for (const auto& entry : names) {
        if (cursor.text() == entry.name) return entry.value;
        known.emplace_back(entry.name);
    }
    cursor.fail_unknown(cursor.text(), known);
}

/// Returns the keys of the fields of T, including those of a member whose fields are in the same
/// object.
template <typename T>
std::vector<std::string> field_names() {
    std::vector<std::string> names;
    for_each_field<T>([&](const auto& field) {
        if (*field.name != '\0') {
            names.emplace_back(field.name);
            return;
        }
        using Member = std::decay_t<decltype(field.default_value())>;
        const std::vector<std::string> inner = field_names<Member>();
        names.insert(names.end(), inner.begin(), inner.end());
    });
    return names;
}

/// Refuses all members but the fields of T and these.
template <typename T>
void allow_fields(const relief::detail::JsonCursor& object,
                  std::initializer_list<const char*> more = {}) {
    std::vector<std::string> known = field_names<T>();
    known.insert(known.end(), more.begin(), more.end());
    std::sort(known.begin(), known.end());
    object.allow(known);
}

/// Sets the fields that an object names, by their descriptions; the others keep their values.
template <typename Owner>
void read_fields(const relief::detail::JsonCursor& object, JsonImages& images, Owner& owner);

/// Sets what an object says about a material. "like" replaces the material by one of the classic
/// table first.
void read_material(const relief::detail::JsonCursor& object, JsonImages& images,
                   Material& material);

Environment environment_from(const relief::detail::JsonCursor& object, JsonImages& images);

/// Returns a normal, bump or height map: a texture, or an object with one.
template <typename Map>
Map map_from(const relief::detail::JsonCursor& cursor, JsonImages& images) {
    Map map;
    if (cursor.is_text()) {
        map.texture = images.texture(cursor);
    } else {
        allow_fields<Map>(cursor);
        read_fields(cursor, images, map);
        (void)cursor.at("texture");
    }
    if constexpr (std::is_same_v<Map, NormalMap>) images.apply_description(cursor, map);
    return map;
}

template <typename Field, typename Value>
void read_value(const relief::detail::JsonCursor& cursor, const Field& field, JsonImages& images,
                Value& value) {
    if constexpr (std::is_same_v<Value, std::optional<Environment>>) {
        value = environment_from(cursor, images);
    } else if constexpr (is_optional_value<Value>) {
        using Inner = typename Value::value_type;
        value.reset();
        // A null takes textures, maps and models away.
        if (has_fields<Inner> && cursor.is_null()) return;
        Inner inner{};
        read_value(cursor, field, images, inner);
        value = std::move(inner);
    } else if constexpr (std::is_same_v<Value, float>) {
        const bool is_angle =
            field.unit == FieldUnit::radians || field.unit == FieldUnit::radians_per_second;
        value = is_angle ? radians_from(cursor) : cursor.number(field.range.min, field.range.max);
    } else if constexpr (std::is_same_v<Value, int>) {
        value = cursor.whole_number(static_cast<int>(field.range.min),
                                    static_cast<int>(field.range.max));
    } else if constexpr (std::is_same_v<Value, glm::vec3>) {
        value = field.unit == FieldUnit::color             ? color_in(cursor)
                : field.unit == FieldUnit::world_direction ? direction_from(cursor)
                                                           : cursor.vector();
    } else if constexpr (std::is_same_v<Value, glm::vec4>) {
        if (cursor.is_array() && cursor.elements().size() == 4) {
            const std::vector<float> c = cursor.numbers(4);
            value = {c[0], c[1], c[2], c[3]};
        } else {
            value = glm::vec4(color_in(cursor), 1.0F);
        }
    } else if constexpr (std::is_same_v<Value, bool>) {
        value = cursor.boolean();
    } else if constexpr (std::is_same_v<Value, std::string>) {
        value = cursor.text();
    } else if constexpr (std::is_enum_v<Value>) {
        value = one_of(cursor, enum_names<Value>);
    } else if constexpr (std::is_same_v<Value, Texture>) {
        value = images.texture(cursor);
    } else if constexpr (std::is_same_v<Value, NormalMap> || std::is_same_v<Value, BumpMap> ||
                         std::is_same_v<Value, ReliefMap>) {
        value = map_from<Value>(cursor, images);
    } else {
        static_assert(has_fields<Value>);
        allow_fields<Value>(cursor);
        read_fields(cursor, images, value);
    }
}

template <typename Owner>
void read_fields(const relief::detail::JsonCursor& object, JsonImages& images, Owner& owner) {
    // In the order of the keys, which numbers the images of textures. Saved scenes rely on it.
    for (const std::string& key : object.keys()) {
        for_each_field<Owner>([&](const auto& field) {
            if (key == field.name) read_value(object.at(key), field, images, owner.*field.member);
        });
    }
    for_each_field<Owner>([&](const auto& field) {
        if constexpr (std::is_same_v<std::decay_t<decltype(owner.*field.member)>, PointLight>)
            read_fields(object, images, owner.*field.member);
    });
}

// Writing

using Json = nlohmann::ordered_json;

/// The name of an image in the file: a path, or the number of an image that a model brings.
using ImageName = std::function<Json(std::size_t image)>;
/// The path of an image that is no texture.
using SourceName = std::function<Json(const ImageSource& source)>;

/// Returns the number with the fewest digits that read back as this float.
Json number_json(float value);
Json vector_json(const glm::vec3& value);
/// Returns radians as degrees.
Json degrees_json(float radians);
/// Returns a matrix by columns.
Json matrix_json(const glm::mat4& matrix);
Json environment_json(const Environment& environment, const SourceName& name);

/// Adds the fields of a value to an object.
template <typename Owner>
void add_fields(Json& object, const Owner& owner, const ImageName& name);

template <typename Owner>
Json fields_json(const Owner& owner, const ImageName& name) {
    Json object = Json::object();
    add_fields(object, owner, name);
    return object;
}

template <typename Field, typename Value>
Json value_json(const Field& field, const Value& value, const ImageName& name) {
    if constexpr (is_optional_value<Value>) {
        return value ? value_json(field, *value, name) : Json(nullptr);
    } else if constexpr (std::is_same_v<Value, float>) {
        return field.unit == FieldUnit::radians ? degrees_json(value) : number_json(value);
    } else if constexpr (std::is_same_v<Value, glm::vec3>) {
        return vector_json(value);
    } else if constexpr (std::is_same_v<Value, glm::vec4>) {
        Json numbers = vector_json(glm::vec3(value));
        numbers.push_back(number_json(value.a));
        return numbers;
    } else if constexpr (std::is_same_v<Value, bool> || std::is_same_v<Value, int> ||
                         std::is_same_v<Value, std::string>) {
        return value;
    } else if constexpr (std::is_enum_v<Value>) {
        return enum_name(value);
    } else if constexpr (std::is_same_v<Value, Texture>) {
        Json object = {{"image", name(value.image)}};
        add_fields(object, value, name);
        return object;
    } else {
        static_assert(has_fields<Value>);
        return fields_json(value, name);
    }
}

template <typename Owner>
void add_fields(Json& object, const Owner& owner, const ImageName& name) {
    for_each_field<Owner>([&](const auto& field) {
        const auto& value = owner.*field.member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, PointLight>) {
            add_fields(object, value, name);
        } else if constexpr (is_optional_value<Value>) {
            // An absent texture, map or model is null, so that an edit can take it away.
            if (value || has_fields<typename Value::value_type>)
                object[field.name] = value_json(field, value, name);
        } else {
            object[field.name] = value_json(field, value, name);
        }
    });
}

}  // namespace relief::shade::detail
