// SPDX-License-Identifier: Apache-2.0
// The probe of a pixel: the reference records it (recorder.h); here its vectors get their
// coordinates in all spaces, and its lookups their slots and footprints. Textures are compared with
// those of the material; footprints are differences between pixels on the plane of the triangle.
#include "relief/shade/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/direction.h"
#include "reference/recorder.h"
#include "reference/tracer.h"
#include "relief/mesh/report.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::reference;

namespace {

// Vectors

bool is_normal(const ProbeVector& vector) {
    constexpr std::array normals{"n", "n'", "n0", "ng"};
    return std::find(normals.begin(), normals.end(), vector.symbol) != normals.end();
}

/// Returns a vector of a layer that does not belong to a light or a corner; zero if it has none.
glm::dvec3 vector_of(const ProbeLayer& layer, std::string_view symbol) {
    for (const ProbeVector& vector : layer.vectors) {
        if (vector.symbol == symbol && !vector.light && !vector.corner) return vector.world;
    }
    return glm::dvec3(0.0);
}

/// Returns the matrix to the components along t, b and n0; none without such a frame.
std::optional<glm::dmat3> tangent_from_world(const ProbeLayer& layer) {
    const glm::dmat3 world_from_tangent(vector_of(layer, "t"), vector_of(layer, "b"),
                                        vector_of(layer, "n0"));
    // The determinant is the volume of three unit vectors.
    constexpr double min_volume = 1e-6;
    if (!(std::abs(glm::determinant(world_from_tangent)) > min_volume)) return std::nullopt;
    return glm::inverse(world_from_tangent);
}

/// Transforms the position and the vectors of a layer to all spaces.
void transform(const Scene& scene, ProbeLayer& layer) {
    const glm::dmat4 view_from_world = glm::inverse(glm::dmat4(scene.camera->world_from_view));
    const glm::dmat4 world_from_object(scene.instances[layer.hit.instance].world_from_object);
    const glm::dmat3 linear(world_from_object);
    const bool is_regular = glm::determinant(linear) != 0.0;
    const glm::dmat3 object_from_world = is_regular ? glm::inverse(linear) : glm::dmat3(0.0);
    const glm::dmat3 normal_from_world = is_regular ? glm::transpose(linear) : glm::dmat3(0.0);
    const std::optional<glm::dmat3> tangent_space = tangent_from_world(layer);
    layer.position_camera = glm::dvec3(view_from_world * glm::dvec4(layer.position_world, 1.0));
    layer.position_object =
        object_from_world * (layer.position_world - glm::dvec3(world_from_object[3]));
    for (ProbeVector& vector : layer.vectors) {
        const glm::dmat3& to_object = is_normal(vector) ? normal_from_world : object_from_world;
        vector.object = direction_or_zero(to_object * vector.world);
        vector.camera = direction_or_zero(glm::dmat3(view_from_world) * vector.world);
        if (tangent_space) vector.tangent = *tangent_space * vector.world;
    }
}

// Lookups

std::vector<TextureSlot> slots_of(const Material& material, const ProbeLookup& lookup) {
    std::vector<TextureSlot> slots;
    for (const TextureSlotInfo& slot : texture_slots) {
        const Texture* const texture = find_texture(material, slot.slot);
        if (texture != nullptr && texture->image == lookup.image && slot.use == lookup.use &&
            texture->second_texcoords == lookup.second_texcoords &&
            texture->filter == lookup.filter)
            slots.push_back(slot.slot);
    }
    return slots;
}

template <typename Texcoords>
glm::dvec2 interpolated(const Texcoords& texcoords, const glm::uvec3& corners,
                        const glm::dvec3& weights) {
    return glm::dvec2(texcoords[corners.x]) * weights.x +
           glm::dvec2(texcoords[corners.y]) * weights.y +
           glm::dvec2(texcoords[corners.z]) * weights.z;
}

/// Adds the way of the lookups of a layer to the next pixels.
void add_footprints(const PreparedPicture& prepared, const Probe& probe, ProbeLayer& layer) {
    const Mesh& mesh = *prepared.scene().instances[layer.hit.instance].mesh;
    const glm::uvec3& corners = mesh.triangles[layer.hit.triangle];
    const auto at = [&](double right, double down) {
        return prepared.tracer().weights_on_plane(layer.hit, probe.x + 0.5 + right,
                                                  probe.y + 0.5 + down);
    };
    const auto left = at(-0.5, 0.0);
    const auto right = at(0.5, 0.0);
    const auto above = at(0.0, -0.5);
    const auto below = at(0.0, 0.5);
    for (ProbeLookup& lookup : layer.lookups) {
        // Maps in the tangent frame are looked up at the first texture coordinates.
        const bool is_second = lookup.second_texcoords && lookup.texcoord == layer.texcoord_2;
        const auto& texcoords = is_second ? mesh.texcoords_2 : mesh.texcoords;
        const auto way = [&](const auto& from, const auto& to) -> std::optional<glm::dvec2> {
            if (!from || !to) return std::nullopt;
            return (interpolated(texcoords, corners, *to) -
                    interpolated(texcoords, corners, *from)) *
                   glm::dvec2(lookup.size);
        };
        lookup.texels_right = way(left, right);
        lookup.texels_down = way(above, below);
    }
}

void finish(const PreparedPicture& prepared, const Probe& probe, ProbeLayer& layer) {
    const PreparedScene& scene = prepared.scene();
    const Mesh& mesh = *scene.instances[layer.hit.instance].mesh;
    if (!mesh.material_ranges.empty()) {
        const auto& range =
            mesh.material_ranges[scene.range_of(layer.hit.instance, layer.hit.triangle)];
        if (range.material) layer.material = *range.material;
    }
    if (layer.outcome == ProbeOutcome::culled) return;
    transform(scene.scene, layer);
    const Material& material = scene.material_of(layer.hit.instance, layer.hit.triangle);
    for (ProbeLookup& lookup : layer.lookups)
        lookup.slots = slots_of(material, lookup);
    add_footprints(prepared, probe, layer);
}

// Pictures

void add_picture(const Scene& scene, Probe& probe) {
    // The reference stores its pixels as floats.
    const glm::dvec3 stored(glm::vec3(probe.radiance));
    const auto alpha = static_cast<double>(static_cast<float>(probe.alpha));
    probe.background = glm::dvec4(scene.background);
    probe.exposure = static_cast<double>(scene.exposure);
    probe.tone_mapping = scene.tone_mapping;
    probe.picture = pixel_picture(stored, alpha, scene, OutputCoding::srgb);
    for (int channel = 0; channel < 3; ++channel) {
        const auto value = static_cast<float>(probe.picture.composed[channel]);
        probe.picture.codes[channel] = 255.0 * static_cast<double>(srgb_from_linear(value));
    }
    const auto composed_alpha = static_cast<float>(probe.picture.composed.a);
    probe.picture.codes.a = 255.0 * static_cast<double>(composed_alpha);
}

/// Sets the radiance and alpha of a view: the sum of its terms, and the coverage by surfaces.
void add_view_radiance(Probe& probe) {
    probe.radiance = glm::dvec3(0.0);
    probe.alpha = 0.0;
    for (const ProbeTerm& term : probe.terms)
        probe.radiance += term.value;
    for (const ProbeLayer& layer : probe.layers)
        probe.alpha += layer.share;
}

void check(const ReferenceSettings& settings, int x, int y, DebugView view) {
    if (x < 0 || y < 0 || x >= settings.width || y >= settings.height) {
        throw InvalidInput(fmt::format("pixel {},{} is outside of the picture of {} x {} pixels", x,
                                       y, settings.width, settings.height));
    }
    if (view != DebugView::picture && !is_term(view)) {
        throw InvalidInput(fmt::format("the view {} has no terms", debug_view_info(view).name));
    }
}

}  // namespace

glm::dvec2 ProbeLookup::footprint() const {
    if (!texels_right || !texels_down) return glm::dvec2(0.0);
    // The singular values of the matrix of both ways.
    const glm::dvec2& a = *texels_right;
    const glm::dvec2& b = *texels_down;
    const double sum = glm::dot(a, a) + glm::dot(b, b);
    const double area = a.x * b.y - a.y * b.x;
    const double spread = std::sqrt(std::max(sum * sum - 4.0 * area * area, 0.0));
    return {std::sqrt(0.5 * (sum + spread)), std::sqrt(std::max(0.5 * (sum - spread), 0.0))};
}

struct Prober::Implementation {
    Implementation(const Scene& described, const ReferenceSettings& requested, Report& report)
        : settings(requested), prepared(described, settings, report) {}

    ReferenceSettings settings;
    PreparedPicture prepared;
};

Prober::Prober(const Scene& scene, const ReferenceSettings& settings, Report& report) {
    reference::check(settings);
    implementation_ = std::make_unique<Implementation>(scene, settings, report);
}

Prober::~Prober() = default;

Probe Prober::at(int x, int y, DebugView view) const {
    const ReferenceSettings& settings = implementation_->settings;
    check(settings, x, y, view);
    const PreparedPicture& prepared = implementation_->prepared;
    const Scene& scene = prepared.scene().scene;
    Probe probe;
    probe.width = settings.width;
    probe.height = settings.height;
    probe.x = x;
    probe.y = y;
    probe.view = view;
    Recorder recorder(probe);
    const double column = x + 0.5;
    const double row = y + 0.5;
    const Tracer& tracer = prepared.tracer();
    const Sample sample = tracer.trace(column, row, &recorder);
    probe.is_edge = is_near_edge(tracer, sample, column, row, settings.edge_margin);
    probe.radiance = glm::dvec3(sample.color);
    probe.alpha = sample.color.a;
    probe.direction_world =
        direction_or_zero(glm::dmat3(scene.camera->world_from_view) * tracer.ray(column, row));
    if (view != DebugView::picture) add_view_radiance(probe);
    for (ProbeLayer& layer : probe.layers)
        finish(prepared, probe, layer);
    add_picture(scene, probe);
    return probe;
}

}  // namespace relief::shade
