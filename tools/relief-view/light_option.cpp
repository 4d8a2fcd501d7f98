// SPDX-License-Identifier: Apache-2.0
#include "light_option.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "common/options.h"

namespace relief::tools {
namespace {

const Range intensities{0, 1e9, ""};

/// The values after the colon, and how many of them have been used.
class Fields {
  public:
    Fields(std::string subject, std::string form, std::string_view text)
        : subject_(std::move(subject)), form_(std::move(form)), fields_(split(text, ',')) {}

    /// The next field, which must be there.
    float number(const Range& range) {
        if (done()) throw UsageError(subject_ + ": too few values", form_);
        const std::string& field = fields_[used_++];
        return static_cast<float>(parse_number(subject_ + ": '" + field + "'", field, range));
    }

    /// The next field, or this where the text has ended.
    float number_or(float otherwise, const Range& range) {
        return done() ? otherwise : number(range);
    }

    glm::vec3 position() {
        const float x = number({});
        const float y = number({});
        const float z = number({});
        return {x, y, z};
    }

    /// INTENSITY[,#RRGGBB] at the end of every kind of light.
    glm::vec3 light() {
        const float intensity = number_or(1.0F, intensities);
        if (done()) return glm::vec3(intensity);
        const std::string& field = fields_[used_++];
        if (!done()) throw UsageError(subject_ + ": too many values", form_);
        return intensity * parse_color(subject_ + ": '" + field + "'", field);
    }

  private:
    [[nodiscard]] bool done() const { return used_ == fields_.size(); }

    std::string subject_;
    std::string form_;
    std::vector<std::string> fields_;
    std::size_t used_ = 0;
};

DirectionalLight directional(const std::string& subject, std::string_view text) {
    Fields fields(subject, "directional:azimuth,elevation[,intensity[,#rrggbb]]", text);
    const float azimuth = glm::radians(fields.number({-360, 360, "degrees"}));
    const float elevation = glm::radians(fields.number({-90, 90, "degrees"}));
    return {.direction_world = -towards(azimuth, elevation), .irradiance = fields.light()};
}

PointLight point(const std::string& subject, std::string_view text) {
    Fields fields(subject, "point:x,y,z[,intensity[,#rrggbb]]", text);
    PointLight light;
    light.position_world = fields.position();
    light.intensity = fields.light();
    return light;
}

SpotLight spot(const std::string& subject, std::string_view text) {
    Fields fields(subject, "spot:x,y,z,tx,ty,tz[,angle[,intensity[,#rrggbb]]]", text);
    // Light fades towards the cone's edge over this share of its angle.
    constexpr float full_share = 0.75F;
    SpotLight light;
    light.point.position_world = fields.position();
    light.direction_world = fields.position() - light.point.position_world;
    if (light.direction_world == glm::vec3(0.0F))
        throw UsageError(subject + ": the spot light shines at its own place");
    light.outer_cone = glm::radians(fields.number_or(30.0F, {0.1, 90, "degrees"}));
    light.inner_cone = full_share * light.outer_cone;
    light.point.intensity = fields.light();
    return light;
}

}  // namespace

glm::vec3 towards(float azimuth, float elevation) {
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
            std::cos(elevation) * std::cos(azimuth)};
}

LightOption parse_light(const std::string& subject, const std::string& text) {
    if (text == "none") return NoLight{};
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    const std::string_view rest =
        colon == std::string::npos ? "" : std::string_view(text).substr(colon + 1);
    if (kind == "directional") return directional(subject, rest);
    if (kind == "point") return point(subject, rest);
    if (kind == "spot") return spot(subject, rest);
    throw UsageError(subject + ": not a light",
                     "begin with directional:, point: or spot:, or say none");
}

}  // namespace relief::tools
