// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of shading that several files need: a point to be shaded, and the light that arrives
/// there. World space, linear light.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "reference/recorder.h"
#include "reference/reference_parts.h"
#include "relief/export.h"
#include "relief/shade/material.h"

namespace relief::shade {
namespace RELIEF_API reference {

/// The light of one source at a point, as lights.h defines it: irradiance over pi at normal
/// incidence. A light that touches the point sends nothing; a close one no more than max_light.
struct Incoming {
    glm::dvec3 light_world;  ///< Unit, to the light.
    glm::dvec3 irradiance;
    glm::dvec3 highlight_irradiance;
    bool casts_shadow = false;
    ProbeLightKind kind = ProbeLightKind::directional;
    std::size_t index = 0;            ///< In its list of the scene.
    std::size_t recorded = no_light;  ///< Its index in the recorded layer.
};

/// A point to be shaded, with its textures.
struct Context {
    const PreparedScene& prepared;
    const Material& material;
    const Surface& surface;
    Trace& trace;

    /// Null unless the pixel is recorded.
    [[nodiscard]] Recorder* recorder() const { return trace.recorder(); }

    /// Records an intermediate value of the next term.
    template <typename Value>
    void note(const char* symbol, const Value& value) const {
        if (Recorder* const listener = recorder()) listener->note({symbol, value});
    }

    /// Returns the texel of a slot of the material; white without a texture.
    [[nodiscard]] glm::dvec4 look_up(TextureSlot slot) const {
        const Texture* const texture = find_texture(material, slot);
        if (texture == nullptr) return glm::dvec4(1.0);
        const bool second = texture->second_texcoords;
        if (!(second ? surface.has_texcoord_2 : surface.has_texcoord)) return glm::dvec4(1.0);
        return prepared.texels.look_up(*texture, slot_info(slot).use,
                                       second ? surface.texcoord_2 : surface.texcoord, trace);
    }
};

/// Returns the opacity of a surface, whatever its alpha mode.
double alpha_at(const Context& context);

/// Returns the unit half vector, or zero if light and eye are opposite.
glm::dvec3 half_vector(const glm::dvec3& light, const Surface& at);

/// Returns the light of all sources but those that touch the point.
std::vector<Incoming> incoming_light(const Context& context, const Surface& at);

}  // namespace reference
}  // namespace relief::shade
