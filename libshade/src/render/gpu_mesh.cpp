// SPDX-License-Identifier: Apache-2.0
// Uploads vertex streams, object space, as they are in the mesh. Missing frames are computed by
// libmesh's with_frames, which counts its fallbacks. Tests: tests/shade/render/renderer_test.cpp.
#include "render/gpu_mesh.h"

#include <algorithm>
#include <utility>

#include "progress_stage.h"
#include "relief/mesh/frames.h"

namespace relief {

void PlannedStreams::add(const PlannedInterface& planned) {
    const auto takes = [&](const char* name) {
        return std::binary_search(planned.attributes.begin(), planned.attributes.end(), name);
    };
    normals |= takes("normal_object");
    texcoords |= takes("texcoord");
    tangents |= takes("tangent_object");
    colors |= takes("color_linear");
}

Mesh with_planned_frames(const Mesh& mesh, const PlannedStreams& streams, Report& report) {
    FrameOptions options;
    if (streams.tangents && mesh.tangents.empty() && !mesh.texcoords.empty()) {
        options.tangents = TangentMode::mikktspace;
    }
    return with_frames(mesh, options, report).mesh;
}

GpuMesh::GpuMesh(const gl::Api& api, const Mesh& mesh, const PlannedStreams& streams)
    : vertices_(api) {
    api->BindVertexArray(vertices_.name());
    const auto add_stream = [&](Attribute attribute, const auto& values, GLint components) {
        if (values.empty()) return;
        check_cancelled();
        buffers_.push_back(gl::make_buffer(api, values, "vertices of mesh '" + mesh.name + "'"));
        const auto location = static_cast<GLuint>(attribute);
        api->BindBuffer(GL_ARRAY_BUFFER, buffers_.back().name());
        api->EnableVertexAttribArray(location);
        api->VertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, 0, nullptr);
    };
    add_stream(Attribute::position_object, mesh.positions, 3);
    if (streams.normals) add_stream(Attribute::normal_object, mesh.normals, 3);
    if (streams.texcoords) add_stream(Attribute::texcoord, mesh.texcoords, 2);
    if (streams.tangents) add_stream(Attribute::tangent_object, mesh.tangents, 4);
    if (streams.colors) add_stream(Attribute::color_linear, mesh.colors, 4);
    buffers_.push_back(
        gl::make_buffer(api, mesh.triangles, "triangles of mesh '" + mesh.name + "'"));
    api->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_.back().name());
    api->BindVertexArray(0);
}

void GpuMesh::draw(const gl::Api& api, const MaterialRange& range) const {
    const auto first = static_cast<std::uintptr_t>(range.first_triangle) * sizeof(glm::uvec3);
    api->BindVertexArray(vertices_.name());
    api->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * range.triangle_count), GL_UNSIGNED_INT,
                      reinterpret_cast<const void*>(first));
}

void GpuMesh::draw(const gl::Api& api, std::span<const glm::uvec3> triangles) {
    if (!ordered_) {
        ordered_ = gl::make_buffer(api, triangles, "sorted triangles", GL_DYNAMIC_DRAW);
    } else {
        gl::replace_content(api, ordered_, std::as_bytes(triangles), "sorted triangles");
    }
    api->BindVertexArray(vertices_.name());
    api->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, ordered_.name());
    api->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles.size()), GL_UNSIGNED_INT,
                      nullptr);
    api->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_.back().name());
}

void set_attribute_constants(const gl::Api& api) {
    const auto set = [&](Attribute attribute, const glm::vec4& value) {
        api->VertexAttrib4f(static_cast<GLuint>(attribute), value.x, value.y, value.z, value.w);
    };
    set(Attribute::normal_object, {0.0F, 0.0F, 1.0F, 0.0F});
    set(Attribute::texcoord, glm::vec4(0.0F));
    set(Attribute::tangent_object, {1.0F, 0.0F, 0.0F, 1.0F});
    set(Attribute::color_linear, glm::vec4(1.0F));
}

}  // namespace relief
