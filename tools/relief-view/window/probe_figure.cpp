// SPDX-License-Identifier: Apache-2.0
#include "window/probe_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "relief/shade/frame_settings.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// The length of a unit vector, in heights of the picture.
constexpr double arrow_length = 0.2;

/// Projects points of the world to the picture.
class Projection {
  public:
    Projection(const Camera& camera, double aspect)
        : view_from_world_(glm::inverse(glm::dmat4(camera.world_from_view))),
          is_orthographic_(camera.orthographic_height.has_value()),
          half_height_(is_orthographic_ ? 0.5 * static_cast<double>(*camera.orthographic_height)
                                        : std::tan(0.5 * static_cast<double>(camera.vertical_fov))),
          aspect_(aspect) {}

    /// Returns half of the height of the picture at the depth of a point; none behind the camera.
    [[nodiscard]] std::optional<double> half_height_at(const glm::dvec3& world) const {
        const double depth = -(view_from_world_ * glm::dvec4(world, 1.0)).z;
        if (is_orthographic_) return half_height_;
        return depth > 0.0 ? std::optional(half_height_ * depth) : std::nullopt;
    }

    /// Returns the place of a point; none behind the camera.
    [[nodiscard]] std::optional<glm::vec2> place_of(const glm::dvec3& world) const {
        const std::optional<double> half = half_height_at(world);
        if (!half) return std::nullopt;
        const glm::dvec2 view(view_from_world_ * glm::dvec4(world, 1.0));
        return glm::vec2(0.5 + 0.5 * view.x / (*half * aspect_), 0.5 - 0.5 * view.y / *half);
    }

  private:
    glm::dmat4 view_from_world_;
    bool is_orthographic_;
    double half_height_;
    double aspect_;
};

const ProbeLayer* visible_layer(const Probe& probe) {
    for (const ProbeLayer& layer : probe.layers) {
        if (layer.outcome == ProbeOutcome::shown) return &layer;
    }
    return nullptr;
}

std::optional<glm::vec3> color_of(std::string_view symbol) {
    constexpr std::array<std::pair<std::string_view, glm::vec3>, 7> colors{
        {{"n", normal_color},
         {"t", tangent_color},
         {"b", bitangent_color},
         {"v", {1.0F, 1.0F, 1.0F}},
         {"l", {1.0F, 0.87F, 0.3F}},
         {"h", {1.0F, 0.6F, 0.2F}},
         {"r", {0.9F, 0.45F, 0.9F}}}};
    for (const auto& [name, color] : colors) {
        if (name == symbol) return color;
    }
    return std::nullopt;
}

std::optional<double> quantity_of(const ProbeTerm& term, std::string_view symbol) {
    for (const ProbeFactor& quantity : term.quantities) {
        if (quantity.symbol == symbol) return quantity.value.x;
    }
    return std::nullopt;
}

/// Returns a vector of a layer in world space; none if it is absent or zero.
std::optional<glm::dvec3> vector_of(const ProbeLayer& layer, std::string_view symbol,
                                    std::optional<std::size_t> light = std::nullopt) {
    for (const ProbeVector& vector : layer.vectors) {
        if (vector.symbol == symbol && vector.light == light && !vector.corner &&
            vector.world != glm::dvec3(0.0))
            return vector.world;
    }
    return std::nullopt;
}

void add_arrows(const ProbeLayer& layer, const Projection& projection, double length,
                std::vector<ProbeArrow>& arrows) {
    const std::optional<glm::vec2> from = projection.place_of(layer.position_world);
    if (!from) return;
    for (const ProbeVector& vector : layer.vectors) {
        const std::optional<glm::vec3> color = color_of(vector.symbol);
        const bool is_behind = vector.light && !(layer.lights[*vector.light].n_dot_l > 0.0);
        if (!color || vector.corner || is_behind || vector.world == glm::dvec3(0.0)) continue;
        const std::optional<glm::vec2> to =
            projection.place_of(layer.position_world + length * vector.world);
        if (!to) continue;
        std::string label(vector.symbol);
        if (vector.light && layer.lights.size() > 1) label += fmt::format("{}", *vector.light + 1);
        arrows.push_back({std::move(label), *from, *to, *color});
    }
}

/// The lobe as a grid of directions about an axis.
class LobeSurface {
  public:
    static constexpr int around = 24;
    static constexpr int along = 12;

    LobeSurface(const HighlightLobe& lobe, const glm::dvec3& axis) : lobe_(lobe), z_(axis) {
        const glm::dvec3 other = std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        x_ = glm::normalize(glm::cross(other, axis));
        y_ = glm::cross(axis, x_);
    }

    /// Returns a point of the surface, for a peak at distance 1 from the origin.
    [[nodiscard]] glm::dvec3 point(int row, int column) const {
        // Rows are denser at the peak.
        const double share = static_cast<double>(row) / along;
        const double polar = share * share * std::numbers::pi;
        const double turn = 2.0 * std::numbers::pi * column / around;
        const glm::dvec3 direction =
            std::sin(polar) * (std::cos(turn) * x_ + std::sin(turn) * y_) + std::cos(polar) * z_;
        return lobe_.at(direction) * direction;
    }

  private:
    const HighlightLobe& lobe_;
    glm::dvec3 x_, y_, z_;
};

void add_lobe(const Probe& probe, const ProbeLayer& layer, const Camera& camera,
              const Projection& projection, double length, std::vector<ProbeFacet>& facets) {
    const auto term = std::find_if(probe.terms.begin(), probe.terms.end(), [&](const auto& each) {
        return each.kind == ProbeTermKind::highlight && each.layer &&
               &probe.layers[*each.layer] == &layer;
    });
    if (term == probe.terms.end()) return;
    const std::optional<HighlightLobe> lobe = HighlightLobe::of(layer, *term);
    const std::optional<glm::dvec3> axis = vector_of(layer, "r", term->light);
    if (!lobe || !axis) return;
    const LobeSurface surface(*lobe, *axis);
    const glm::dvec3 eye(glm::dvec4(camera.world_from_view[3]));
    std::vector<std::pair<double, ProbeFacet>> sorted;
    const auto add = [&](const std::array<glm::dvec3, 3>& points) {
        const glm::dvec3 normal = glm::cross(points[1] - points[0], points[2] - points[0]);
        if (!(glm::length(normal) > 1e-9)) return;
        ProbeFacet facet;
        glm::dvec3 middle(0.0);
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 world = layer.position_world + length * points[i];
            const std::optional<glm::vec2> place = projection.place_of(world);
            if (!place) return;
            facet.corners[i] = *place;
            middle += world / 3.0;
        }
        const glm::dvec3 to_eye = glm::normalize(eye - middle);
        facet.shade = static_cast<float>(std::abs(glm::dot(glm::normalize(normal), to_eye)));
        sorted.emplace_back(glm::distance(eye, middle), facet);
    };
    for (int row = 0; row < LobeSurface::along; ++row) {
        for (int column = 0; column < LobeSurface::around; ++column) {
            const glm::dvec3 a = surface.point(row, column);
            const glm::dvec3 b = surface.point(row, column + 1);
            const glm::dvec3 c = surface.point(row + 1, column);
            const glm::dvec3 d = surface.point(row + 1, column + 1);
            add({a, c, d});
            add({a, d, b});
        }
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [distance, facet] : sorted)
        facets.push_back(facet);
}

}  // namespace

std::optional<HighlightLobe> HighlightLobe::of(const ProbeLayer& layer, const ProbeTerm& term) {
    const std::optional<glm::dvec3> normal = vector_of(layer, "n");
    const std::optional<glm::dvec3> light = vector_of(layer, "l", term.light);
    if (!normal || !light) return std::nullopt;
    HighlightLobe lobe;
    lobe.normal_ = *normal;
    lobe.light_ = *light;
    if (const auto alpha = quantity_of(term, "alpha")) {
        lobe.kind_ = Kind::ggx;
        lobe.parameter_ = *alpha;
    } else if (const auto shininess = quantity_of(term, "shininess")) {
        lobe.kind_ = quantity_of(term, "r.v") ? Kind::phong : Kind::blinn_phong;
        lobe.parameter_ = *shininess;
    } else {
        return std::nullopt;
    }
    return lobe;
}

double HighlightLobe::at(const glm::dvec3& direction_world) const {
    if (!(glm::dot(normal_, direction_world) > 0.0)) return 0.0;
    if (kind_ == Kind::phong) {
        const glm::dvec3 mirrored = 2.0 * glm::dot(normal_, light_) * normal_ - light_;
        return std::pow(std::max(glm::dot(mirrored, direction_world), 0.0), parameter_);
    }
    const glm::dvec3 sum = light_ + direction_world;
    const double length = glm::length(sum);
    const double n_dot_h = length > 1e-15 ? std::max(glm::dot(normal_, sum) / length, 0.0) : 0.0;
    if (kind_ == Kind::blinn_phong) return std::pow(n_dot_h, parameter_);
    // GGX's distribution over that at n.h = 1.
    const double squared = parameter_ * parameter_;
    const double spread = squared / (n_dot_h * n_dot_h * (squared - 1.0) + 1.0);
    return spread * spread;
}

ProbeFigure figure_of(const Probe& probe, const Camera& camera, double aspect) {
    ProbeFigure figure;
    const ProbeLayer* const layer = visible_layer(probe);
    if (layer == nullptr) return figure;
    const Projection projection(camera, aspect);
    const std::optional<double> half = projection.half_height_at(layer->position_world);
    if (!half) return figure;
    const double length = arrow_length * 2.0 * *half;
    add_arrows(*layer, projection, length, figure.arrows);
    add_lobe(probe, *layer, camera, projection, length, figure.lobe);
    return figure;
}

std::vector<glm::vec2> footprint_outline(const ProbeLookup& lookup) {
    if (!lookup.texels_right || !lookup.texels_down) return {};
    constexpr int corners = 24;
    std::vector<glm::vec2> outline;
    for (int i = 0; i < corners; ++i) {
        const double turn = 2.0 * std::numbers::pi * i / corners;
        const glm::dvec2 texel = lookup.texel + 0.5 * std::cos(turn) * *lookup.texels_right +
                                 0.5 * std::sin(turn) * *lookup.texels_down;
        outline.emplace_back(texel / glm::dvec2(lookup.size));
    }
    return outline;
}

}  // namespace relief::tools
