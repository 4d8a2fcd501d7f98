// SPDX-License-Identifier: Apache-2.0
// Drawing into the faces of a cube map, one triangle over each; see cube_map_drawing.h. Directions
// are those of environment/cube_faces.h. Tests: tests/shade/gl/cube_map_test.cpp.
#include "gl/cube_map_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "environment/cube_faces.h"
#include "gl/texture.h"

namespace relief::gl {

namespace {

/// Covers the viewport with one triangle, without any vertex data.
constexpr const char* covering_vertex_shader = R"(#version 330 core
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";

std::string fragment_shader(const std::string& declarations, const std::string& radiance) {
    return R"(#version 330 core
uniform mat3 world_from_face;  // Columns: along s, along t, outwards.
uniform float face_size;       // In texels.
uniform int grid;              // Directions along a side of a texel.
out vec4 color;
)" + declarations +
           "\nvec3 radiance(vec3 direction) {\n" + radiance + R"(
}

void main() {
    vec2 corner = floor(gl_FragCoord.xy);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < grid; ++y) {
        for (int x = 0; x < grid; ++x) {
            vec2 texel = corner + (vec2(x, y) + 0.5) / float(grid);
            vec2 st = 2.0 * texel / face_size - 1.0;
            sum += radiance(world_from_face * vec3(st, 1.0));
        }
    }
    color = vec4(sum / float(grid * grid), 1.0);
}
)";
}

/// What drawing into a cube face changes; restored at the end of life.
class SavedState {
  public:
    explicit SavedState(const Api& api) : api_(api) {
        api->GetIntegerv(GL_VIEWPORT, viewport_.data());
        api->GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_);
        api->GetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_);
        for (std::size_t i = 0; i < tests.size(); ++i) {
            enabled_.at(i) = api->IsEnabled(tests.at(i));
            api->Disable(tests.at(i));
        }
    }
    ~SavedState() {
        for (std::size_t i = 0; i < tests.size(); ++i) {
            if (enabled_.at(i) != GL_FALSE) api_->Enable(tests.at(i));
        }
        api_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_));
        api_->BindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_));
        api_->Viewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    }
    SavedState(const SavedState&) = delete;
    SavedState& operator=(const SavedState&) = delete;

  private:
    static constexpr std::array<GLenum, 4> tests{GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND,
                                                 GL_SCISSOR_TEST};
    const Api& api_;
    std::array<GLint, 4> viewport_{};
    GLint draw_ = 0;
    GLint read_ = 0;
    std::array<GLboolean, 4> enabled_{};
};

}  // namespace

CubeMap make_empty_cube_map(const Api& api, int size, int levels, std::string_view name) {
    check_cube_size(api, size, name);
    CubeMap cube{Texture(api), size, levels};
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    for (int level = 0; level < levels; ++level) {
        const int side = std::max(1, size >> level);
        for (std::size_t face = 0; face < 6; ++face) {
            api->TexImage2D(cube_face_target(face), level, GL_RGBA16F, side, side, 0, GL_RGBA,
                            GL_FLOAT, nullptr);
        }
    }
    api->TexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAX_LEVEL, levels - 1);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    api.check(fmt::format("making cube map '{}', six faces of {} x {}", name, size, size));
    return cube;
}

void set_cube_sampling(const Api& api) {
    Sampling sampling;
    sampling.wrap_s = GL_CLAMP_TO_EDGE;
    sampling.wrap_t = GL_CLAMP_TO_EDGE;
    set_sampling(api, GL_TEXTURE_CUBE_MAP, sampling);
}

CubePainter::CubePainter(const Api& api, const std::string& name, const std::string& declarations,
                         const std::string& radiance)
    : api_(&api),
      program_(api,
               {name, covering_vertex_shader, fragment_shader(declarations, radiance), {}, {}}),
      no_vertices_(api),
      framebuffer_(api) {}

void CubePainter::paint(const CubeMap& cube, int level, int grid,
                        const std::function<void(const LinkedProgram&)>& prepare) const {
    const Api& api = *api_;
    const SavedState saved(api);
    const int size = std::max(1, cube.size >> level);
    api->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    api->Viewport(0, 0, size, size);
    api->BindVertexArray(no_vertices_.name());
    program_.use();
    program_.set("face_size", static_cast<float>(size));
    program_.set("grid", grid);
    prepare(program_);
    for (std::size_t face = 0; face < 6; ++face) {
        program_.set("world_from_face", world_from_face().at(face));
        api->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, cube_face_target(face),
                                  cube.texture.name(), level);
        api->DrawArrays(GL_TRIANGLES, 0, 3);
    }
    api->UseProgram(0);
    api->BindVertexArray(0);
}

}  // namespace relief::gl
