// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/lamps_test.cpp.
#include "window/lamps.h"

#include <algorithm>

namespace relief::tools {
namespace {

constexpr float lamp_distance = 2.0F;  // In radii of the ball.
const glm::vec3 upper_right = glm::normalize(glm::vec3(0.6F, 0.8F, 0.6F));

/// What a lamp sheds on the ball's middle.
struct Shed {
    glm::vec3 from{0.0F, 1.0F, 0.0F};  ///< Towards the lamp, of length 1.
    glm::vec3 irradiance{1.0F};
    std::optional<glm::vec3> highlight;
};

glm::vec3 unit_or_up(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 0.0F ? v / length : glm::vec3(0.0F, 1.0F, 0.0F);
}

/// What is left of a light of distance 1.
float share_at(const PointLight& light, float distance) {
    if (light.falloff == Falloff::none) return 1.0F;
    return 1.0F / std::max(distance * distance, 1e-12F);
}

/// A spot sheds what it would in its axis: it is turned to the middle when it becomes another kind.
Shed shed_by(const Lamp& lamp, const Ball& ball) {
    if (const auto* far = std::get_if<DirectionalLight>(&lamp))
        return {unit_or_up(-far->direction_world), far->irradiance, far->highlight_irradiance};
    const auto* spot = std::get_if<SpotLight>(&lamp);
    const PointLight& point = spot != nullptr ? spot->point : std::get<PointLight>(lamp);
    const glm::vec3 offset = point.position_world - ball.center;
    const float share = share_at(point, glm::length(offset));
    Shed shed{unit_or_up(offset), share * point.intensity, {}};
    if (point.highlight_intensity) shed.highlight = share * *point.highlight_intensity;
    return shed;
}

PointLight point_that_sheds(const Shed& shed, const Ball& ball) {
    const float distance = lamp_distance * ball.radius;
    PointLight light;
    light.position_world = ball.center + distance * shed.from;
    const auto bounded = [&](const glm::vec3& irradiance) {
        return glm::min(distance * distance * irradiance, glm::vec3(max_light));
    };
    light.intensity = bounded(shed.irradiance);
    if (shed.highlight) light.highlight_intensity = bounded(*shed.highlight);
    return light;
}

SpotLight spot_at(const PointLight& point, const Ball& ball) {
    SpotLight spot;
    spot.point = point;
    spot.direction_world = -unit_or_up(point.position_world - ball.center);
    return spot;
}

}  // namespace

LampKind kind_of(const Lamp& lamp) {
    return static_cast<LampKind>(lamp.index());
}

const char* name_of(LampKind kind) {
    if (kind == LampKind::directional) return "directional";
    return kind == LampKind::point ? "point" : "spot";
}

std::vector<Lamp> lamps_of(const Scene& scene) {
    std::vector<Lamp> lamps(scene.directional_lights.begin(), scene.directional_lights.end());
    lamps.insert(lamps.end(), scene.point_lights.begin(), scene.point_lights.end());
    lamps.insert(lamps.end(), scene.spot_lights.begin(), scene.spot_lights.end());
    return lamps;
}

void set_lamps(Scene& scene, const std::vector<Lamp>& lamps) {
    scene.directional_lights.clear();
    scene.point_lights.clear();
    scene.spot_lights.clear();
    for (const Lamp& lamp : lamps) {
        if (const auto* directional = std::get_if<DirectionalLight>(&lamp))
            scene.directional_lights.push_back(*directional);
        else if (const auto* point = std::get_if<PointLight>(&lamp))
            scene.point_lights.push_back(*point);
        else
            scene.spot_lights.push_back(std::get<SpotLight>(lamp));
    }
}

Lamp new_lamp(LampKind kind, const Ball& ball) {
    DirectionalLight light;
    light.direction_world = -upper_right;
    return as_kind(light, kind, ball);
}

Lamp as_kind(const Lamp& lamp, LampKind kind, const Ball& ball) {
    if (kind == kind_of(lamp)) return lamp;
    const Shed shed = shed_by(lamp, ball);
    if (kind == LampKind::directional)
        return DirectionalLight{-shed.from, glm::min(shed.irradiance, glm::vec3(max_light)),
                                shed.highlight};
    // What has a place keeps it, with its range and falloff.
    PointLight point = point_that_sheds(shed, ball);
    if (const auto* spot = std::get_if<SpotLight>(&lamp)) point = spot->point;
    if (const auto* own = std::get_if<PointLight>(&lamp)) point = *own;
    if (kind == LampKind::point) return point;
    return spot_at(point, ball);
}

void turn(Lamp& lamp, const glm::mat3& rotation, const glm::vec3& center) {
    const auto move = [&](PointLight& point) {
        point.position_world = center + rotation * (point.position_world - center);
    };
    if (auto* directional = std::get_if<DirectionalLight>(&lamp)) {
        directional->direction_world = rotation * directional->direction_world;
    } else if (auto* point = std::get_if<PointLight>(&lamp)) {
        move(*point);
    } else {
        auto& spot = std::get<SpotLight>(lamp);
        move(spot.point);
        spot.direction_world = rotation * spot.direction_world;
    }
}

}  // namespace relief::tools
