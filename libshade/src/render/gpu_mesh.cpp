// SPDX-License-Identifier: Apache-2.0
// Uploads vertex streams in object space without conversion. Missing frames are computed by
// libmesh's with_frames, which counts its fallbacks.
#include "render/gpu_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "progress_stage.h"
#include "relief/mesh/frames.h"

namespace relief {

void PlannedStreams::add(const PlannedInterface& planned) {
    const auto uses = [&](const char* name) {
        return std::binary_search(planned.attributes.begin(), planned.attributes.end(), name);
    };
    normals |= uses("normal_object");
    texcoords |= uses("texcoord");
    texcoords_2 |= uses("texcoord_2");
    tangents |= uses("tangent_object");
    colors |= uses("color_linear");
}

Mesh with_planned_frames(const Mesh& mesh, const PlannedStreams& streams, Report& report) {
    FrameOptions options;
    if (streams.tangents && mesh.tangents.empty() && !mesh.texcoords.empty()) {
        options.tangents = TangentMethod::mikktspace;
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
    if (streams.texcoords_2) add_stream(Attribute::texcoord_2, mesh.texcoords_2, 2);
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
    set(Attribute::texcoord_2, glm::vec4(0.0F));
    set(Attribute::tangent_object, {1.0F, 0.0F, 0.0F, 1.0F});
    set(Attribute::color_linear, glm::vec4(1.0F));
}

namespace {

std::shared_ptr<GpuMesh> uploaded(const gl::Api& api, const Mesh& mesh,
                                  const PlannedStreams& streams, Report& findings) {
    const bool lacks_normals = streams.normals && mesh.normals.empty();
    const bool lacks_tangents =
        streams.tangents && mesh.tangents.empty() && !mesh.texcoords.empty();
    if (!lacks_normals && !lacks_tangents) return std::make_shared<GpuMesh>(api, mesh, streams);
    return std::make_shared<GpuMesh>(api, with_planned_frames(mesh, streams, findings), streams);
}

}  // namespace

std::shared_ptr<GpuMesh> MeshCache::get(const Shared<Mesh>& mesh, const PlannedStreams& streams,
                                        Report& report) {
    auto entry = std::find_if(meshes_.begin(), meshes_.end(), [&](const Entry& known) {
        return known.streams == streams && known.identity.is(mesh);
    });
    if (entry == meshes_.end()) {
        Report findings;
        std::shared_ptr<GpuMesh> made = uploaded(*api_, mesh, streams, findings);
        meshes_.push_back({mesh.identity(), streams, std::move(findings), std::move(made)});
        entry = std::prev(meshes_.end());
    }
    report.merge(entry->findings);
    return entry->mesh;
}

void MeshCache::drop_unused() {
    std::erase_if(meshes_, [](const Entry& entry) { return entry.mesh.use_count() == 1; });
}

SortedTriangles::SortedTriangles(const Mesh& mesh, const MaterialRange& range) {
    const auto first = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(range.first_triangle);
    triangles_.assign(first, first + static_cast<std::ptrdiff_t>(range.triangle_count));
    centers_.reserve(triangles_.size());
    glm::dvec3 sum(0.0);
    for (const glm::uvec3& t : triangles_) {
        const glm::vec3 center =
            (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0F;
        centers_.push_back(center);
        const glm::dvec3 finite(center);
        if (std::isfinite(finite.x + finite.y + finite.z)) sum += finite;
    }
    if (!centers_.empty()) center_ = glm::vec3(sum / static_cast<double>(centers_.size()));
    order_.resize(triangles_.size());
    depths_.resize(triangles_.size());
    sorted_.resize(triangles_.size());
}

std::span<const glm::uvec3> SortedTriangles::sort(const glm::vec3& farther_object) {
    for (std::size_t i = 0; i < centers_.size(); ++i) {
        const float depth = glm::dot(centers_[i], farther_object);
        depths_[i] = std::isfinite(depth) ? depth : -std::numeric_limits<float>::infinity();
    }
    std::iota(order_.begin(), order_.end(), 0U);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return depths_[a] > depths_[b]; });
    for (std::size_t i = 0; i < order_.size(); ++i)
        sorted_[i] = triangles_[order_[i]];
    return sorted_;
}

}  // namespace relief
