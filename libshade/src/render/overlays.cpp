// SPDX-License-Identifier: Apache-2.0
// Overlay lines and points, whose colors are final codes. The depth of the surfaces is moved back
// by polygon offset, so that a surface does not hide lines on it. Vertex frames are computed in
// double, relative to a center. Tests: tests/shade/render/overlays_test.cpp, draw_values_test.cpp.
#include "render/overlays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "render/draw_values.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

namespace {

/// Adds a line from a point, unless the direction has no length.
void add_line(const glm::dvec3& from, const glm::dvec3& direction, double length,
              std::vector<glm::vec3>& lines) {
    const double size = glm::length(direction);
    if (!(size > 0.0) || !std::isfinite(size)) return;
    lines.emplace_back(from);
    lines.emplace_back(from + direction * (length / size));
}

void check_markers(const Scene& scene, const std::vector<Marker>& markers) {
    for (std::size_t i = 0; i < markers.size(); ++i) {
        if (markers[i].instance < scene.instances.size()) continue;
        throw InvalidInput(fmt::format("marker {} is on instance {}, but there are only {}", i,
                                       markers[i].instance, scene.instances.size()));
    }
}

void check_frame_length(const std::optional<float>& share) {
    if (!share || (*share > 0.0F && *share <= 1000.0F)) return;
    throw InvalidInput(
        fmt::format("the length of vertex frames is {} times the scene's size, but must be above 0 "
                    "and at most 1000",
                    *share));
}

}  // namespace

ShaderSteps detail::overlay_steps(const char* color, bool morphing, bool skinning) {
    ShaderSteps steps = pose_steps(morphing, skinning);
    choose_part(steps, color);
    return steps;
}

Grid grid_below(const Bounds& world) {
    Grid grid;
    if (world.empty()) return grid;
    const glm::dvec3 low(world.min);
    const glm::dvec3 high(world.max);
    const double size = std::max(high.x - low.x, high.z - low.z);
    if (size > 0.0) {
        const double power = std::pow(10.0, std::floor(std::log10(size)) - 1.0);
        const double tens = size / power;  // 10 to 100.
        grid.spacing = power * (tens <= 10.0   ? 1.0
                                : tens <= 20.0 ? 2.0
                                : tens <= 50.0 ? 5.0
                                               : 10.0);
        grid.cells = static_cast<int>(std::ceil(0.75 * size / grid.spacing)) + 1;
    }
    const auto on_line = [&](double value) {
        return grid.spacing * std::round(value / grid.spacing);
    };
    grid.middle = {on_line(0.5 * (low.x + high.x)), low.y, on_line(0.5 * (low.z + high.z))};
    return grid;
}

GridLines detail::grid_lines(const Grid& grid) {
    const double reach = grid.cells * grid.spacing;
    GridLines lines;
    for (int i = -grid.cells; i <= grid.cells; ++i) {
        const double side = i * grid.spacing;
        add_line({-reach, 0.0, side}, {1, 0, 0}, 2.0 * reach, lines.cells);
        add_line({side, 0.0, -reach}, {0, 0, 1}, 2.0 * reach, lines.cells);
    }
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 direction(0.0);
        direction[i] = 1.0;
        add_line(glm::dvec3(0.0), direction, reach, lines.axes[static_cast<std::size_t>(i)]);
    }
    return lines;
}

void detail::add_vertex_frames(const Mesh& mesh, const glm::mat4& world_from_object,
                               const glm::dvec3& center, double length, VertexFrameLines& lines) {
    DrawValues values;
    set_place(values, world_from_object);
    const glm::dmat4 to_world(world_from_object);
    const glm::dmat3 normal_to_world(values.world_from_object_normal);
    const glm::dmat3 tangent_to_world(values.world_from_object_tangent);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 from =
            glm::dvec3(to_world * glm::dvec4(glm::dvec3(mesh.positions[i]), 1.0)) - center;
        if (!is_finite(from)) continue;
        const glm::dvec3 normal = normal_to_world * glm::dvec3(mesh.normals[i]);
        add_line(from, normal, length, lines.normals);
        if (mesh.tangents.empty()) continue;
        const glm::vec4& stored = mesh.tangents[i];
        const glm::dvec3 tangent = tangent_to_world * glm::dvec3(stored);
        const auto handedness = static_cast<double>(stored.w * values.handedness);
        add_line(from, tangent, length, lines.tangents);
        add_line(from, handedness * glm::cross(normal, tangent), length, lines.bitangents);
    }
}

OverlayDrawing::OverlayDrawing(const gl::Api& api, ProgramCache& programs, const Scene& scene,
                               const FramePlan& plan, const FrameSettings& settings, Report& report)
    : api_(&api), overlays_(settings.overlays), output_(settings.output), programs_(&programs) {
    check_frame_length(overlays_.vertex_frames);
    if (overlays_.markers) check_markers(scene, *overlays_.markers);
    for (const DrawPlan& draw : plan.draws)
        instances_.insert(draw.instance);
    if (overlays_.markers) {
        ShaderSteps discs = overlay_steps("overlay.glsl#vertex_color", false, false);
        choose_part(discs, "overlay.glsl#disc");
        discs_program_ = programs.get("overlay", discs);
    }
    if (overlays_.vertex_frames) {
        for (const std::size_t instance : instances_) {
            const std::size_t mesh = scene.instances[instance].mesh;
            if (framed_.contains(mesh)) continue;
            const PlannedStreams streams{.normals = true, .tangents = true};
            framed_.emplace(mesh, with_planned_frames(scene.meshes[mesh], streams, report));
            framed_of_.emplace(mesh, scene.meshes[mesh].identity());
        }
    }
    make_grid();
    make_markers(scene);
    move(scene);
}

OverlayDrawing::Points OverlayDrawing::upload(const std::vector<glm::vec3>& positions,
                                              const std::vector<glm::vec4>& colors) const {
    Points points;
    points.count = static_cast<GLsizei>(positions.size());
    if (positions.empty()) return points;
    const gl::Api& gl = *api_;
    points.vertices = gl::VertexArray(gl);
    gl->BindVertexArray(points.vertices.name());
    const auto add = [&](Attribute attribute, const auto& values, GLint components) {
        if (values.empty()) return;
        points.buffers.push_back(gl::make_buffer(gl, values, "lines and points"));
        gl->BindBuffer(GL_ARRAY_BUFFER, points.buffers.back().name());
        gl->EnableVertexAttribArray(static_cast<GLuint>(attribute));
        gl->VertexAttribPointer(static_cast<GLuint>(attribute), components, GL_FLOAT, GL_FALSE, 0,
                                nullptr);
    };
    add(Attribute::position_object, positions, 3);
    add(Attribute::color_linear, colors, 4);
    gl->BindVertexArray(0);
    return points;
}

void OverlayDrawing::make_frames(const Scene& scene) {
    const Bounds bounds = world_bounds(scene);
    const double size =
        bounds.empty() ? 1.0 : glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
    center_ =
        bounds.empty() ? glm::dvec3(0.0) : 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max));
    const double length = static_cast<double>(*overlays_.vertex_frames) * size;
    VertexFrameLines lines;
    for (const std::size_t i : instances_) {
        const Instance& instance = scene.instances[i];
        const FramedMesh& framed = framed_.at(instance.mesh);
        if (!is_deformed(instance)) {
            add_vertex_frames(framed.mesh, instance.world_from_object, center_, length, lines);
            continue;
        }
        Mesh deformed = framed.mesh;
        deform(*instance.pose, framed.source_vertex, deformed);
        add_vertex_frames(deformed, instance.world_from_object, center_, length, lines);
    }
    frames_ = {upload(lines.tangents, {}), upload(lines.bitangents, {}), upload(lines.normals, {})};
}

void OverlayDrawing::make_grid() {
    if (!overlays_.grid) return;
    const GridLines lines = grid_lines(*overlays_.grid);
    cells_ = upload(lines.cells, {});
    for (std::size_t i = 0; i < axes_.size(); ++i)
        axes_[i] = upload(lines.axes[i], {});
}

void OverlayDrawing::make_markers(const Scene& scene) {
    if (!overlays_.markers) return;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        std::vector<glm::vec3> positions;
        std::vector<glm::vec4> colors;
        for (const Marker& marker : *overlays_.markers) {
            if (marker.instance != i) continue;
            positions.push_back(marker.position_object);
            colors.emplace_back(coded(marker.color_srgb), 1.0F);
        }
        if (!positions.empty()) markers_.emplace(i, upload(positions, colors));
    }
}

void OverlayDrawing::move(const Scene& scene) {
    world_from_object_.clear();
    for (const Instance& instance : scene.instances)
        world_from_object_.push_back(instance.world_from_object);
    if (!overlays_.vertex_frames) return;
    for (auto& [mesh, identity] : framed_of_) {
        if (identity.is(scene.meshes[mesh])) continue;
        Report unused;
        const PlannedStreams streams{.normals = true, .tangents = true};
        framed_.at(mesh) = with_planned_frames(scene.meshes[mesh], streams, unused);
        identity = scene.meshes[mesh].identity();
    }
    make_frames(scene);
}

glm::vec3 OverlayDrawing::coded(const glm::vec3& srgb) const {
    if (output_ == OutputCoding::srgb) return srgb;
    return {linear_from_srgb(srgb.r), linear_from_srgb(srgb.g), linear_from_srgb(srgb.b)};
}

std::shared_ptr<const gl::LinkedProgram> OverlayDrawing::use_lines(const glm::vec3& color,
                                                                   bool morphing,
                                                                   bool skinning) const {
    std::shared_ptr<const gl::LinkedProgram> program =
        programs_->get("overlay", overlay_steps("overlay.glsl#one_color", morphing, skinning));
    program->use();
    program->set("all_color", coded(color));
    return program;
}

void OverlayDrawing::draw_triangles(const glm::dmat4& clip_from_world,
                                    const OverlaySurface& surface, const glm::vec3& color) const {
    const gl::Api& gl = *api_;
    const auto program = use_lines(color, surface.morphing, surface.skinning);
    program->set("clip_from_object",
                 glm::mat4(clip_from_world * glm::dmat4(surface.world_from_object)));
    if (surface.pose != nullptr) {
        surface.pose->bind(gl);
        program->set("joint_pairs", surface.pose->joint_pairs());
        program->set("morph_layout", surface.pose->morph_layout());
    }
    if (surface.both_sides) {
        gl->Disable(GL_CULL_FACE);
    } else {
        gl->Enable(GL_CULL_FACE);
    }
    gl->FrontFace(surface.mirrored ? GL_CW : GL_CCW);
    surface.mesh->draw(gl, surface.range);
}

void OverlayDrawing::draw_depth(const glm::dmat4& clip_from_world,
                                std::span<const OverlaySurface> surfaces) const {
    const gl::Api& gl = *api_;
    gl->ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    gl->Enable(GL_POLYGON_OFFSET_FILL);
    gl->PolygonOffset(1.0F, 1.0F);
    for (const OverlaySurface& surface : surfaces) {
        if (surface.hides) draw_triangles(clip_from_world, surface, glm::vec3(0.0F));
    }
    gl->Disable(GL_POLYGON_OFFSET_FILL);
    gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void OverlayDrawing::draw_wires(const glm::dmat4& clip_from_world,
                                std::span<const OverlaySurface> surfaces) const {
    const gl::Api& gl = *api_;
    gl->PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    for (const OverlaySurface& surface : surfaces)
        draw_triangles(clip_from_world, surface, wireframe_color);
    gl->PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

std::vector<OverlayLines> OverlayDrawing::lines() const {
    std::vector<OverlayLines> all;
    const auto add = [&](const Points& points, const glm::vec3& color, const glm::dvec3& origin,
                         bool are_frames) {
        if (points.count > 0)
            all.push_back({&points.vertices, points.count, color, origin, are_frames, {}});
    };
    const std::array<glm::vec3, 3> colors = {tangent_color, bitangent_color, normal_color};
    if (overlays_.grid) {
        add(cells_, grid_color, overlays_.grid->middle, false);
        // At equal depth, the last line is in front.
        for (std::size_t i = 0; i < axes_.size(); ++i)
            add(axes_[i], colors[i], overlays_.grid->middle, false);
    }
    for (std::size_t i = 0; i < frames_.size() && overlays_.vertex_frames; ++i)
        add(frames_[i], colors[i], center_, true);
    for (const auto& [instance, points] : markers_)
        all.push_back({&points.vertices, points.count, {}, {}, false, instance});
    return all;
}

void OverlayDrawing::draw_lines(const OverlayLines& lines,
                                const glm::dmat4& clip_from_world) const {
    use_lines(lines.color_srgb)
        ->set("clip_from_object", glm::mat4(glm::translate(clip_from_world, lines.origin)));
    (*api_)->BindVertexArray(lines.vertices->name());
    (*api_)->DrawArrays(GL_LINES, 0, lines.count);
}

void OverlayDrawing::draw_discs(const OverlayLines& discs,
                                const glm::dmat4& clip_from_world) const {
    const gl::Api& gl = *api_;
    discs_program_->use();
    discs_program_->set(
        "clip_from_object",
        glm::mat4(clip_from_world * glm::dmat4(world_from_object_[*discs.instance])));
    gl->Disable(GL_DEPTH_TEST);
    gl->PointSize(static_cast<float>(marker_pixels));
    gl->BindVertexArray(discs.vertices->name());
    gl->DrawArrays(GL_POINTS, 0, discs.count);
    gl->Enable(GL_DEPTH_TEST);
}

void OverlayDrawing::draw(const glm::dmat4& clip_from_world,
                          std::span<const OverlaySurface> surfaces) const {
    const gl::Api& gl = *api_;
    gl->DepthMask(GL_TRUE);
    gl->ClearDepth(1.0);
    gl->Clear(GL_DEPTH_BUFFER_BIT);
    gl->Disable(GL_BLEND);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_LEQUAL);
    gl->CullFace(GL_BACK);
    if (overlays_.wireframe || overlays_.vertex_frames || overlays_.grid)
        draw_depth(clip_from_world, surfaces);
    bool has_wires = !overlays_.wireframe;  // They are drawn after the grid.
    const auto draw_wires_once = [&] {
        if (!std::exchange(has_wires, true)) draw_wires(clip_from_world, surfaces);
    };
    for (const OverlayLines& each : lines()) {
        if (each.are_frames || each.instance) draw_wires_once();
        if (each.instance) {
            draw_discs(each, clip_from_world);
        } else {
            draw_lines(each, clip_from_world);
        }
    }
    draw_wires_once();
    gl->Finish();
}

}  // namespace relief::shade
