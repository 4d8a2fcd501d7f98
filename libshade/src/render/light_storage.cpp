// SPDX-License-Identifier: Apache-2.0
// Lights as light_rows.h lays them out, uploaded once. World space.
// Tests: tests/shade/render/renderer_test.cpp.
#include "render/light_storage.h"

#include "effects/light_rows.h"
#include "gl/texture.h"
#include "render/program_cache.h"

namespace relief {

LightStorage::Key LightStorage::key(const Features& f) {
    return {f.directional_lights, f.point_lights, f.spot_lights, f.highlight_colors,
            f.lights_in_buffer};
}

void LightStorage::add(const gl::Api& api, const Scene& scene, const Features& features) {
    if (light_row_layout(features).count == 0) return;
    const auto [entry, is_new] = lights_.try_emplace(key(features));
    if (!is_new) return;
    const std::vector<glm::vec4> rows = light_rows(scene, features);
    entry->second.features = features;
    entry->second.rows = gl::make_buffer(api, rows, "lights", GL_DYNAMIC_DRAW);
    if (features.lights_in_buffer) {
        entry->second.texture = gl::make_buffer_texture(api, entry->second.rows, GL_RGBA32F,
                                                        rows.size() * sizeof(glm::vec4), "lights");
    }
}

void LightStorage::update(const gl::Api& api, const Scene& scene) {
    for (const auto& [key, lights] : lights_) {
        const std::vector<glm::vec4> rows = light_rows(scene, lights.features);
        gl::replace_content(api, lights.rows, std::as_bytes(std::span(rows)), "lights");
    }
}

void LightStorage::bind(const gl::Api& api, const Features& features) const {
    const auto entry = lights_.find(key(features));
    if (entry == lights_.end()) return;
    if (features.lights_in_buffer) {
        api->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(TextureUnit::light_buffer));
        api->BindTexture(GL_TEXTURE_BUFFER, entry->second.texture.name());
    } else {
        api->BindBufferBase(GL_UNIFORM_BUFFER, lights_binding, entry->second.rows.name());
    }
}

}  // namespace relief
