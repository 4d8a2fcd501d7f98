// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is drawn over a finished picture: wireframe, vertex frames, markers (debug_views.h).
/// Tests: tests/shade/render/overlays_test.cpp.
#pragma once

#include <array>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "render/gpu_mesh.h"
#include "render/vertex_frames.h"

namespace relief {

/// A surface that was drawn, for what lies on it and what it hides.
struct OverlaySurface {
    const GpuMesh* mesh = nullptr;
    MaterialRange range;
    glm::mat4 world_from_object{1.0F};
    bool both_sides = false;
    bool mirrored = false;
    bool hides = true;  ///< Opaque everywhere.
};

/// Only made where some overlay is asked for. Lines are tested against a depth buffer of their own,
/// since the finished picture has none; so they are the same for any number of samples.
class OverlayDrawing {
  public:
    /// \param report  gets what computing missing frames found
    OverlayDrawing(const gl::Api& api, ProgramCache& programs, const Scene& scene,
                   const FramePlan& plan, const FrameSettings& settings, Report& report);

    /// Takes over where instances stand.
    void move(const Scene& scene);

    /// Draws into the bound target, whose depth is lost.
    void draw(const glm::dmat4& clip_from_world, std::span<const OverlaySurface> surfaces) const;

  private:
    /// Points on the GPU, with or without a colour each.
    struct Points {
        gl::VertexArray vertices;
        std::vector<gl::Buffer> buffers;
        GLsizei count = 0;
    };

    [[nodiscard]] Points upload(const std::vector<glm::vec3>& positions,
                                const std::vector<glm::vec4>& colors) const;
    void make_frames(const Scene& scene);
    void make_markers(const Scene& scene);
    [[nodiscard]] glm::vec3 coded(const glm::vec3& srgb) const;
    /// With the lines' program, as the polygon mode says, facing as the surface was drawn.
    void draw_triangles(const glm::dmat4& clip_from_world, const OverlaySurface& surface) const;
    void draw_depth(const glm::dmat4& clip_from_world,
                    std::span<const OverlaySurface> surfaces) const;
    void draw_wires(const glm::dmat4& clip_from_world,
                    std::span<const OverlaySurface> surfaces) const;
    void draw_frames(const glm::dmat4& clip_from_world) const;
    void draw_markers(const glm::dmat4& clip_from_world) const;

    const gl::Api* api_;
    Overlays overlays_;
    OutputCoding output_;
    std::shared_ptr<const gl::LinkedProgram> lines_program_;
    std::shared_ptr<const gl::LinkedProgram> discs_program_;
    std::set<std::size_t> instances_;           ///< That are drawn.
    std::map<std::size_t, Mesh> framed_;        ///< By index; with the frames that it lacked.
    glm::dvec3 center_{0.0};                    ///< Of the frames' lines.
    std::array<Points, 3> frames_;              ///< Tangents, bitangents, normals.
    std::map<std::size_t, Points> markers_;     ///< By instance.
    std::vector<glm::mat4> world_from_object_;  ///< Of instances.
};

}  // namespace relief
