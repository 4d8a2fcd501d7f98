// SPDX-License-Identifier: Apache-2.0
#include "light_options.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "common/options.h"
#include "common/text.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

const Range intensities{0, 1e9, ""};

/// The values after the colon of a light.
class Fields {
  public:
    Fields(std::string subject, std::string form, std::string_view text)
        : subject_(std::move(subject)), form_(std::move(form)), fields_(split(text, ',')) {}

    /// The next value, which is required.
    float number(const Range& range) {
        if (done()) throw UsageError(subject_ + ": too few values", form_);
        const std::string& field = fields_[used_++];
        return static_cast<float>(parse_number(subject_ + ": '" + field + "'", field, range));
    }

    /// The next value, or a default at the end of the text.
    float number_or(float otherwise, const Range& range) {
        return done() ? otherwise : number(range);
    }

    glm::vec3 position() {
        const float x = number({});
        const float y = number({});
        const float z = number({});
        return {x, y, z};
    }

    struct Power {
        glm::vec3 light{1.0F};
        glm::vec3 ambient{0.0F};
    };

    /// The common end of all lights: INTENSITY[,#RRGGBB[,AMBIENT]].
    Power power() {
        glm::vec3 light(number_or(1.0F, intensities));
        if (!done()) {
            const std::string& field = fields_[used_++];
            light *= parse_color(subject_ + ": '" + field + "'", field);
        }
        const float share = number_or(0.0F, {0, 1000, ""});
        if (!done()) throw UsageError(subject_ + ": too many values", form_);
        return {light, share * light};
    }

  private:
    [[nodiscard]] bool done() const { return used_ == fields_.size(); }

    std::string subject_;
    std::string form_;
    std::vector<std::string> fields_;
    std::size_t used_ = 0;
};

DirectionalLight directional(const std::string& subject, std::string_view text) {
    Fields fields(subject, "directional:azimuth,elevation[,intensity[,#rrggbb[,ambient]]]", text);
    const float azimuth = glm::radians(fields.number({-360, 360, "degrees"}));
    const float elevation = glm::radians(fields.number({-90, 90, "degrees"}));
    const Fields::Power power = fields.power();
    return {.direction_world = -towards(azimuth, elevation),
            .irradiance = power.light,
            .ambient = power.ambient};
}

PointLight point(const std::string& subject, std::string_view text) {
    Fields fields(subject, "point:x,y,z[,intensity[,#rrggbb[,ambient]]]", text);
    PointLight light;
    light.position_world = fields.position();
    const Fields::Power power = fields.power();
    light.intensity = power.light;
    light.ambient = power.ambient;
    return light;
}

SpotLight spot(const std::string& subject, std::string_view text) {
    Fields fields(subject, "spot:x,y,z,tx,ty,tz[,angle[,intensity[,#rrggbb[,ambient]]]]", text);
    // The ratio of the inner to the outer cone.
    constexpr float full_share = 0.75F;
    SpotLight light;
    light.point.position_world = fields.position();
    light.direction_world = fields.position() - light.point.position_world;
    if (light.direction_world == glm::vec3(0.0F))
        throw UsageError(subject + ": the position and the target of the spotlight are the same");
    light.outer_cone = glm::radians(fields.number_or(30.0F, {0.1, 90, "degrees"}));
    light.inner_cone = full_share * light.outer_cone;
    const Fields::Power power = fields.power();
    light.point.intensity = power.light;
    light.point.ambient = power.ambient;
    return light;
}

}  // namespace

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
                     "start with directional:, point: or spot:, or use none");
}

namespace {

/// Computes in double precision, so that degrees_text() (orbit_camera.h) is inverted exactly.
float radians_from(double degrees) {
    return static_cast<float>(glm::radians(degrees));
}

}  // namespace

CameraOption parse_camera(const std::string& subject, const std::string& text) {
    const std::size_t at = text.find('@');
    const bool has_place = at != std::string::npos;
    std::vector<std::string> fields = split(text.substr(0, at), ',');
    if (fields.size() < 2 || fields.size() > (has_place ? 2 : 3)) {
        throw UsageError(subject +
                         ": not azimuth,elevation or azimuth,elevation,factor or "
                         "azimuth,elevation@x,y,z,distance");
    }
    const auto number = [&](std::size_t i, const Range& range) {
        const std::string field = subject + ": '" + fields[i] + "'";
        return parse_number(field, fields[i], range);
    };
    CameraOption camera{.azimuth = radians_from(number(0, {-360, 360, "degrees"})),
                        .elevation = radians_from(number(1, {-90, 90, "degrees"}))};
    if (fields.size() == 3)
        camera.distance_factor = static_cast<float>(number(2, {0.01, 1000, ""}));
    if (!has_place) return camera;
    fields = split(text.substr(at + 1), ',');
    if (fields.size() != 4) throw UsageError(subject + ": expected x,y,z,distance after the @");
    const auto coordinate = [&](std::size_t i) {
        return static_cast<float>(number(i, {-1e30, 1e30, ""}));
    };
    camera.place = {{coordinate(0), coordinate(1), coordinate(2)},
                    static_cast<float>(number(3, {1e-30, 1e30, ""}))};
    return camera;
}

float parse_fov(const std::string& subject, const std::string& text) {
    return radians_from(parse_number(subject, text, {1, 170, "degrees"}));
}

void set_occlusion(ViewOptions& options, float distance) {
    options.scene_fields.set(
        &Scene::ambient_occlusion,
        distance > 0.0F ? std::optional(AmbientOcclusion{distance}) : std::nullopt);
}

void add_light_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Lights and camera";
    add_repeatable(
        app, "--light", "LIGHT",
        "Replace the model's lights; may be given several times. "
        "directional:azimuth,elevation[,intensity[,#rrggbb[,ambient]]] shines from this direction, "
        "in degrees; point:x,y,z[,intensity[,#rrggbb[,ambient]]] is in world space, y up; "
        "spot:x,y,z,tx,ty,tz[,angle[,intensity[,#rrggbb[,ambient]]]] shines from x,y,z towards "
        "tx,ty,tz in a cone of 30 or angle degrees from its axis; none removes all lights. "
        "Intensity 1 makes a white surface white, at distance 1 for point and spot. ambient (0) is "
        "the fraction of the light that it adds as ambient light, everywhere. Default: the model's "
        "lights, else a key light and a fill light.",
        [&](const std::string& subject, const std::string& text) {
            options.lights.push_back(parse_light(subject, text));
        })
        .group(group);
    add_value(app, "--ambient", "A",
              "Set the ambient light of the scene, to which lights may add. Default: 0, or 0.08 "
              "with the key light and fill light.",
              [&](const std::string& subject, const std::string& text) {
                  const double gray = parse_number(subject, text, {0, 1000, ""});
                  options.scene_fields.set(&Scene::ambient, glm::vec3(static_cast<float>(gray)));
              })
        .group(group);
    add_switch(app, "--clamp-terms",
               "Clamp each term of the Phong model to 0 to 1 before the sum, for each light, as "
               "hardware with fixed functions did.",
               [&] { options.scene_fields.set(&Scene::clamp_terms, true); })
        .group(group);
    add_value(app, "--shadow", "DEG",
              "Show the shadow of the first directional light, else of the first spot or point "
              "light. DEG is the size of the light as an angle: 0 gives hard edges, 2 soft ones. "
              "Default: that of the scene file, else no shadow.",
              [&](const std::string& subject, const std::string& text) {
                  const auto degrees =
                      static_cast<float>(parse_number(subject, text, {0, 30, "degrees"}));
                  options.scene_fields.set(&Scene::shadow, Shadow{glm::radians(degrees)});
              })
        .group(group);
    add_value(
        app, "--ambient-occlusion", "D",
        "Dim ambient light and the environment's light where surfaces within D times the "
        "scene's size hide it: 0.5 is usual, 0 is none. It is computed once for every "
        "vertex. Default: that of the scene file, else 0.",
        [&](const std::string& subject, const std::string& text) {
            set_occlusion(options, static_cast<float>(parse_number(subject, text, {0, 100, ""})));
        })
        .group(group);
    add_number(
        app, "--light-markers", "R", options.light_markers, {1e-6, 1, ""},
        "Show point lights and spotlights as spheres with a radius of R times the scene's size.")
        .group(group);
    add_value(app, "--camera", "AZIMUTH,ELEVATION[,FACTOR|@X,Y,Z,DISTANCE]",
              "Set the direction of the camera in degrees, from +z towards +x and above the "
              "horizon, and its distance as a factor of the distance that shows the whole model. "
              "Alternatively, set the target and the distance from it, as the window copies them; "
              "then the default lights do not move. Default: the model's camera, else 30,20,1.",
              [&](const std::string& subject, const std::string& text) {
                  options.camera = parse_camera(subject, text);
              })
        .group(group);
    add_value(app, "--fov", "DEGREES",
              "Set the vertical field of view. Default: that of the model's camera, else 35.",
              [&](const std::string& subject, const std::string& text) {
                  options.vertical_fov = parse_fov(subject, text);
              })
        .group(group);
    add_switch(app, "--orthographic", options.orthographic,
               "Use parallel projection. The size of the model is that at the target of --camera, "
               "else the whole model is shown.")
        .group(group);
    add_value(app, "--model-camera", "NAME|N",
              "Look through the camera of this name or number of a glTF file. Default: the first "
              "camera.",
              [&](const std::string&, const std::string& text) { options.model_camera = text; })
        .group(group);
}

}  // namespace relief::tools
