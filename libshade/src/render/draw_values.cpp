// SPDX-License-Identifier: Apache-2.0
// Uniform values of a draw: materials, places and cameras as numbers, computed in double and
// rounded once. World space. Singular and mirroring matrices have the outcomes stated in
// draw_values.h. Tests: tests/shade/render/draw_values_test.cpp.
#include "render/draw_values.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace relief {

namespace {

using Setter = bool (*)(const gl::LinkedProgram&, std::string_view, const DrawValues&);

template <auto Member>
bool set_member(const gl::LinkedProgram& program, std::string_view name, const DrawValues& values) {
    return program.set(name, values.*Member);
}

const std::map<std::string_view, Setter>& setters() {
    static const std::map<std::string_view, Setter> all = {
        {"clip_from_object", set_member<&DrawValues::clip_from_object>},
        {"world_from_object", set_member<&DrawValues::world_from_object>},
        {"world_from_object_normal", set_member<&DrawValues::world_from_object_normal>},
        {"world_from_object_tangent", set_member<&DrawValues::world_from_object_tangent>},
        {"handedness", set_member<&DrawValues::handedness>},
        {"eye_world", set_member<&DrawValues::eye_world>},
        {"ambient_scattered", set_member<&DrawValues::ambient_scattered>},
        {"diffuse_color", set_member<&DrawValues::diffuse_color>},
        {"specular_color", set_member<&DrawValues::specular_color>},
        {"shininess", set_member<&DrawValues::shininess>},
        {"emission_color", set_member<&DrawValues::emission_color>},
        {"reflectivity", set_member<&DrawValues::reflectivity>},
        {"grazing_reflectivity", set_member<&DrawValues::grazing_reflectivity>},
        {"environment_intensity", set_member<&DrawValues::environment_intensity>},
        {"normal_map_scale", set_member<&DrawValues::normal_map_scale>},
        {"normal_map_bias", set_member<&DrawValues::normal_map_bias>},
    };
    return all;
}

/// A matrix with its largest element scaled to 1, so that directions keep within a float's range.
glm::mat3 scaled_to_one(const glm::dmat3& matrix) {
    double largest = 0.0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            largest = std::max(largest, std::abs(matrix[column][row]));
        }
    }
    return largest > 0.0 ? glm::mat3(matrix / largest) : glm::mat3(0.0F);
}

}  // namespace

bool set_uniform(const gl::LinkedProgram& program, std::string_view name,
                 const DrawValues& values) {
    const auto setter = setters().find(name);
    return setter != setters().end() && setter->second(program, name, values);
}

void set_material(DrawValues& values, const Material& material, const Scene& scene) {
    values.ambient_scattered = material.ambient * scene.ambient;
    values.diffuse_color = material.diffuse;
    values.specular_color = material.specular;
    values.shininess = material.shininess;
    values.emission_color = material.emission;
    if (scene.environment && material.reflectivity != glm::vec3(0.0F)) {
        values.reflectivity = material.reflectivity;
        values.grazing_reflectivity = material.grazing_reflectivity;
        values.environment_intensity = scene.environment->intensity;
    }
}

void set_place(DrawValues& values, const glm::mat4& world_from_object) {
    const glm::dmat3 m(world_from_object);
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                               glm::cross(m[0], m[1]));
    const bool mirrors = glm::dot(m[0], cofactors[0]) < 0.0;
    values.world_from_object = world_from_object;
    values.world_from_object_normal = scaled_to_one(mirrors ? -cofactors : cofactors);
    values.world_from_object_tangent = scaled_to_one(m);
    values.handedness = mirrors ? -1.0F : 1.0F;
}

NormalMapNumbers normal_map_numbers(int bits, FlatCode flat, Green green, float scale) {
    glm::dvec3 factor(2.0);
    glm::dvec3 bias(-1.0);
    if (flat == FlatCode::middle && bits < 32) {
        // n = (code - middle) / (middle - 1), and a texel is looked up as code / largest.
        const double largest = bits == 8 ? 255.0 : 65535.0;
        const double middle = bits == 8 ? 128.0 : 32768.0;
        factor = glm::dvec3(largest / (middle - 1.0));
        bias = glm::dvec3(-middle / (middle - 1.0));
    }
    const double along = static_cast<double>(scale);
    const glm::dvec3 by_channel(along, green == Green::up ? along : -along, 1.0);
    return {glm::vec3(factor * by_channel), glm::vec3(bias * by_channel)};
}

glm::dmat4 clip_from_world(const Camera& camera, double aspect) {
    const double near = static_cast<double>(camera.near);
    const double far = static_cast<double>(camera.far);
    const double y = 1.0 / std::tan(static_cast<double>(camera.vertical_fov) * 0.5);
    glm::dmat4 clip_from_view(0.0);
    clip_from_view[0][0] = y / aspect;
    clip_from_view[1][1] = y;
    clip_from_view[2][2] = (far + near) / (near - far);
    clip_from_view[2][3] = -1.0;
    clip_from_view[3][2] = 2.0 * far * near / (near - far);
    return clip_from_view * glm::inverse(glm::dmat4(camera.world_from_view));
}

}  // namespace relief
