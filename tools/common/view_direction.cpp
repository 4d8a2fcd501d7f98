// SPDX-License-Identifier: Apache-2.0
#include "common/view_direction.h"

#include <fmt/format.h>

#include <cmath>

#include "portable_math.h"

namespace relief::tools {

glm::vec3 towards(float azimuth, float elevation) {
    const auto sine = [](float angle) {
        return static_cast<float>(relief::detail::portable::sin(static_cast<double>(angle)));
    };
    const auto cosine = [](float angle) {
        return static_cast<float>(relief::detail::portable::cos(static_cast<double>(angle)));
    };
    return {cosine(elevation) * sine(azimuth), sine(elevation),
            cosine(elevation) * cosine(azimuth)};
}

glm::vec3 parse_view(const std::string& subject, const std::string& text) {
    const std::vector<std::string> fields = split(text, ',');
    if (fields.size() != 2) throw UsageError(subject + ": not azimuth,elevation");
    const auto degrees = [&](const std::string& field, double most) {
        return static_cast<float>(
            glm::radians(parse_number(subject + ": " + field, field, {-most, most, "degrees"})));
    };
    glm::vec3 direction = towards(degrees(fields[0], 360.0), degrees(fields[1], 90.0));
    for (int i = 0; i < 3; ++i) {
        // Right angles are rounded to single precision.
        if (std::abs(direction[i]) < 1e-6F) direction[i] = 0.0F;
    }
    return direction;
}

std::string view_text(const glm::vec3& direction) {
    const glm::dvec3 to(direction);
    const double across = std::sqrt(to.x * to.x + to.z * to.z);
    const auto degrees = [](double y, double x) {
        // Zero has no sign in the text.
        return glm::degrees(relief::detail::portable::atan2(y, x)) + 0.0;
    };
    return fmt::format("{:.6g},{:.6g}", degrees(to.x, to.z), degrees(to.y, across));
}

AddedOption add_view_option(CLI::App& app, std::vector<glm::vec3>& views) {
    return add_repeatable(
        app, "--view", "AZIMUTH,ELEVATION",
        "Also measure the view from this direction, in degrees from +z towards +x and above the "
        "horizon, as for the camera of relief-view. May be repeated. The numbers of these views "
        "follow those of the others.",
        [&views](const std::string& subject, const std::string& text) {
            views.push_back(parse_view(subject, text));
        });
}

}  // namespace relief::tools
