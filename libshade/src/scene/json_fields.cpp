// SPDX-License-Identifier: Apache-2.0
// The parts of json_fields.h that are no templates: images and their files, materials,
// environments, and numbers as text.
#include "scene/json_fields.h"

#include <fmt/format.h>

#include <charconv>
#include <string>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"
#include "scene/scene_parts.h"

namespace relief::shade::detail {
using namespace relief::detail;

namespace {

/// Returns the value of two hexadecimal digits, divided by 255.
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

glm::vec3 color_in(const JsonCursor& cursor) {
    if (cursor.is_number()) return glm::vec3(cursor.number());
    if (cursor.is_array()) return cursor.vector();
    const char* const allowed = "must be three numbers, one number, or \"#rrggbb\"";
    if (!cursor.is_text()) cursor.fail(allowed);
    const std::string& code = cursor.text();
    if (code.size() != 7 || code.front() != '#') cursor.fail(allowed);
    glm::vec3 color(0.0F);
    for (int i = 0; i < 3; ++i) {
        const auto channel =
            hex_code(std::string_view(code).substr(1 + 2 * static_cast<std::size_t>(i), 2));
        if (!channel) cursor.fail(allowed);
        color[i] = linear_from_srgb(*channel);
    }
    return color;
}

std::filesystem::path JsonImages::file(const JsonCursor& cursor) const {
    const std::filesystem::path path = folder(cursor);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        cursor.fail(fmt::format("there is no file {}", path.string()));
    return path;
}

std::filesystem::path JsonImages::folder(const JsonCursor& cursor) const {
    return (folder_ / cursor.text()).lexically_normal();
}

ImageSource JsonImages::source(const JsonCursor& cursor) const {
    const std::filesystem::path path = file(cursor);
    return {path.string(), path};
}

std::size_t JsonImages::model_image(const JsonCursor& number) const {
    if (images_.empty()) number.fail("is the index of an image, but there is no model with images");
    return static_cast<std::size_t>(number.whole_number(0, static_cast<int>(images_.size()) - 1));
}

Texture JsonImages::texture(const JsonCursor& cursor) {
    const JsonCursor image = cursor.is_object() ? cursor.at("image") : cursor;
    Texture texture;
    if (image.is_number()) {
        texture.image = model_image(image);
    } else {
        const std::filesystem::path path = folder(image);
        const auto [entry, is_new] = index_of_.try_emplace(path, images_.size());
        if (is_new) images_.push_back({path.string(), path, scene_file_.string()});
        texture.image = entry->second;
    }
    if (cursor.is_object()) {
        allow_fields<Texture>(cursor, {"image"});
        read_fields(cursor, *this, texture);
    }
    return texture;
}

void JsonImages::apply_description(const JsonCursor& cursor, NormalMap& map) const {
    const bool has_green = cursor.is_object() && cursor.find("green");
    const bool has_space = cursor.is_object() && cursor.find("space");
    if (has_green && has_space) return;
    const MapDescription stated = stated_description(images_[map.texture.image]);
    if (!has_green) map.green = stated.green.value_or(map.green);
    if (!has_space && stated.kind == MapKind::object_normal) map.space = NormalSpace::object;
}

void read_material(const JsonCursor& object, JsonImages& images, Material& material) {
    if (const auto like = object.find("like")) {
        const auto classic = material_by_name(like->text());
        if (!classic) like->fail_unknown(like->text(), material_names());
        material = *classic;
    }
    allow_fields<Material>(object, {"like"});
    read_fields(object, images, material);
    if (material.normal_map && material.bump_map)
        object.fail("has a normal map and a bump map, but a surface has one normal");
}

Environment environment_from(const JsonCursor& object, JsonImages& images) {
    allow_fields<Environment>(
        object, {"faces", "folder", "cross", "panorama", "angular_map", "studio", "left_handed"});
    Environment environment;
    int sources = 0;
    if (const auto faces = object.find("faces")) {
        const std::vector<JsonCursor> files = faces->elements();
        if (files.size() != 6) faces->fail("must be six images: +x -x +y -y +z -z");
        CubeFaces cube;
        std::transform(files.begin(), files.end(), cube.faces.begin(),
                       [&](const JsonCursor& file) { return images.source(file); });
        environment.source = std::move(cube);
        ++sources;
    }
    if (const auto folder = object.find("folder")) {
        try {
            environment.source = cube_faces_in(images.folder(*folder));
        } catch (const FileError& error) {
            folder->fail(error.what());
        }
        ++sources;
    }
    const auto single = [&]<typename Source>(const char* key, Source) {
        const auto image = object.find(key);
        if (!image) return;
        environment.source = Source{images.source(*image)};
        ++sources;
    };
    single("cross", CubeCross{});
    single("panorama", Equirectangular{});
    single("angular_map", AngularMap{});
    if (const auto studio = object.find("studio")) {
        if (!studio->boolean()) studio->fail("can only be true");
        environment = studio_environment();
        ++sources;
    }
    if (sources != 1) {
        object.fail(
            "must have one of 'faces', 'folder', 'cross', 'panorama', 'angular_map' and 'studio'");
    }
    read_fields(object, images, environment);
    if (const auto left_handed = object.find("left_handed")) {
        auto* cube = std::get_if<CubeFaces>(&environment.source);
        if (cube == nullptr) left_handed->fail("applies only to six faces");
        cube->left_handed = left_handed->boolean();
    }
    return environment;
}

float radians_from(const JsonCursor& cursor) {
    return static_cast<float>(glm::radians(cursor.exact_number()));
}

glm::vec3 direction_from(const JsonCursor& cursor) {
    const glm::vec3 direction = cursor.vector();
    if (direction == glm::vec3(0.0F)) cursor.fail("must have a length");
    return direction;
}

glm::mat4 matrix_from(const JsonCursor& cursor) {
    const std::vector<float> values = cursor.numbers(16);
    glm::mat4 matrix;
    for (std::size_t i = 0; i < 16; ++i)
        matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = values[i];
    return matrix;
}

namespace {

/// Reads back a formatted number. (strtod() depends on the locale of the process.)
double double_of(const std::string& text) {
    double value = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

}  // namespace

Json number_json(float value) {
    return double_of(fmt::format("{}", value));
}

Json vector_json(const glm::vec3& value) {
    return Json::array({number_json(value.x), number_json(value.y), number_json(value.z)});
}

Json degrees_json(float radians) {
    constexpr int usual_digits = 6;
    constexpr int digits_of_double = 17;
    const double degrees = glm::degrees(static_cast<double>(radians));
    for (int digits = usual_digits;; ++digits) {
        const double rounded = double_of(fmt::format("{:.{}g}", degrees, digits));
        if (static_cast<float>(glm::radians(rounded)) == radians || digits == digits_of_double)
            return rounded;
    }
}

Json matrix_json(const glm::mat4& matrix) {
    Json values = Json::array();
    for (int i = 0; i < 16; ++i)
        values.push_back(number_json(matrix[i / 4][i % 4]));
    return values;
}

Json environment_json(const Environment& environment, const SourceName& name) {
    Json object;
    if (is_studio(environment)) {
        object["studio"] = true;
    } else if (const auto* cube = std::get_if<CubeFaces>(&environment.source)) {
        object["faces"] = Json::array();
        for (const ImageSource& face : cube->faces)
            object["faces"].push_back(name(face));
        object["left_handed"] = cube->left_handed;
    } else if (const auto* cross = std::get_if<CubeCross>(&environment.source)) {
        object["cross"] = name(cross->image);
    } else if (const auto* panorama = std::get_if<Equirectangular>(&environment.source)) {
        object["panorama"] = name(panorama->image);
    } else {
        object["angular_map"] = name(std::get<AngularMap>(environment.source).image);
    }
    add_fields(object, environment, {});
    return object;
}

}  // namespace relief::shade::detail
