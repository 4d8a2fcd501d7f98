// SPDX-License-Identifier: Apache-2.0
/// \file
/// Overlays on a finished picture: wireframe, vertex frames, markers (frame_settings.h).
/// Tests: tests/shade/render/overlays_test.cpp, draw_values_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "effects/shader_source.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "render/gpu_mesh.h"

namespace relief::shade::detail {

/// Lines along the frames of vertices; each pair of points is a line.
struct VertexFrameLines {
    std::vector<glm::vec3> tangents;
    std::vector<glm::vec3> bitangents;
    std::vector<glm::vec3> normals;
};

/// Adds the lines of an instance, along the world-space frame of each vertex as shaders compute it
/// (vertex.glsl, normal_and_tangent). Vertices that are not finite and directions without length
/// get no line.
///
/// \param mesh    with normals; tangents are optional
/// \param center  the origin of the points, in world space, which keeps precision far from the
/// world origin \param length  the length of each line, in world space
void add_vertex_frames(const Mesh& mesh, const glm::mat4& world_from_object,
                       const glm::dvec3& center, double length, VertexFrameLines& lines);

/// The lines of a grid and of its axes, relative to its middle; each pair of points is a line.
struct GridLines {
    std::vector<glm::vec3> cells;
    std::array<std::vector<glm::vec3>, 3> axes;
};

GridLines grid_lines(const Grid& grid);

/// A surface of the picture, which may show a wireframe and hide overlays.
struct OverlaySurface {
    const GpuMesh* mesh = nullptr;
    MaterialRange range;
    glm::mat4 world_from_object{1.0F};
    bool both_sides = false;
    bool mirrored = false;
    bool hides = true;  ///< It is opaque everywhere.
    bool morphing = false;
    bool skinning = false;
    const GpuPose* pose = nullptr;  ///< Only with one of the two.
};

/// Returns the steps of the program of overlays (shaders/overlay.glsl).
/// \param color  the part of the step overlay_color
ShaderSteps overlay_steps(const char* color, bool morphing, bool skinning);

/// The part of the overlays that is not edges of surfaces: lines of one color in world space, or
/// discs with their own colors on an instance.
struct OverlayLines {
    const gl::VertexArray* vertices = nullptr;
    GLsizei count = 0;
    glm::vec3 color_srgb{0.0F};           ///< Of lines.
    glm::dvec3 origin{0.0};               ///< Of the positions of lines, in world space.
    bool are_frames = false;              ///< They move with the vertices.
    std::optional<std::size_t> instance;  ///< Of discs.
};

/// Draws the overlays. The finished picture has no depth buffer, so the depth of the surfaces is
/// drawn again. Hence overlays are the same for any number of samples.
class OverlayDrawing {
  public:
    /// \param report  gets the findings of computing missing frames
    OverlayDrawing(const gl::Api& api, ProgramCache& programs, const Scene& scene,
                   const FramePlan& plan, const FrameSettings& settings, Report& report);

    /// Updates the matrices of the instances.
    void move(const Scene& scene);

    /// Returns all lines and discs, in the order in which they are drawn.
    [[nodiscard]] std::vector<OverlayLines> lines() const;

    /// Draws into the bound target and overwrites its depth.
    void draw(const glm::dmat4& clip_from_world, std::span<const OverlaySurface> surfaces) const;

  private:
    /// Points on the GPU, optionally with colors.
    struct Points {
        gl::VertexArray vertices;
        std::vector<gl::Buffer> buffers;
        GLsizei count = 0;
    };

    [[nodiscard]] Points upload(const std::vector<glm::vec3>& positions,
                                const std::vector<glm::vec4>& colors) const;
    void make_frames(const Scene& scene);
    void make_grid();
    void make_markers(const Scene& scene);
    [[nodiscard]] glm::vec3 coded(const glm::vec3& srgb) const;
    /// Returns the program of lines and surfaces, current, with this color.
    [[nodiscard]] std::shared_ptr<const gl::LinkedProgram> use_lines(const glm::vec3& color,
                                                                     bool morphing = false,
                                                                     bool skinning = false) const;
    /// Draws a surface in one color in the current polygon mode.
    void draw_triangles(const glm::dmat4& clip_from_world, const OverlaySurface& surface,
                        const glm::vec3& color) const;
    void draw_depth(const glm::dmat4& clip_from_world,
                    std::span<const OverlaySurface> surfaces) const;
    void draw_wires(const glm::dmat4& clip_from_world,
                    std::span<const OverlaySurface> surfaces) const;
    void draw_lines(const OverlayLines& lines, const glm::dmat4& clip_from_world) const;
    void draw_discs(const OverlayLines& discs, const glm::dmat4& clip_from_world) const;

    const gl::Api* api_;
    Overlays overlays_;
    OutputCoding output_;
    ProgramCache* programs_;
    std::shared_ptr<const gl::LinkedProgram> discs_program_;
    std::set<std::size_t> instances_;           ///< The drawn instances.
    std::map<std::size_t, FramedMesh> framed_;  ///< Meshes at rest with computed frames, by index.
    std::map<std::size_t, Shared<Mesh>::Identity> framed_of_;  ///< Of these meshes.
    glm::dvec3 center_{0.0};                                   ///< The origin of the frame lines.
    std::array<Points, 3> frames_;                             ///< Tangents, bitangents, normals.
    Points cells_;                                             ///< The grid without its axes.
    std::array<Points, 3> axes_;
    std::map<std::size_t, Points> markers_;     ///< By instance.
    std::vector<glm::mat4> world_from_object_;  ///< By instance.
};

}  // namespace relief::shade::detail
