// SPDX-License-Identifier: Apache-2.0
// Uploads vertex streams in object space without conversion. Missing frames are computed by
// libmesh's with_frames, which counts its fallbacks. The data of deformations is arranged for the
// loops of vertex.glsl.
#include "render/gpu_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "progress_stage.h"
#include "relief/mesh/frames.h"
#include "scene/scene_parts.h"

namespace relief::shade::detail {
using namespace relief::detail;

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

FramedMesh with_planned_frames(const Mesh& mesh, const PlannedStreams& streams, Report& report) {
    FrameOptions options;
    if (streams.tangents && mesh.tangents.empty() && !mesh.texcoords.empty()) {
        options.tangents = TangentMethod::mikktspace;
    }
    return with_frames(mesh, options, report);
}

GpuMesh::GpuMesh(const gl::Api& api, const Mesh& mesh, const PlannedStreams& streams,
                 std::vector<std::uint32_t> source_vertex)
    : vertices_(api), source_vertex_(std::move(source_vertex)) {
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
    FramedMesh framed = with_planned_frames(mesh, streams, findings);
    return std::make_shared<GpuMesh>(api, framed.mesh, streams, std::move(framed.source_vertex));
}

/// Returns the joints of a vertex that move it, with weights whose sum in this order is exactly 1:
/// the last one, which has the largest weight, is what the others leave.
std::vector<glm::vec2> joints_of(const GltfDeformation& deformation, std::size_t vertex,
                                 std::size_t joint_count) {
    std::vector<glm::vec2> joints;
    double total = 0.0;
    for (const GltfJoints& set : deformation.joints) {
        for (int k = 0; k < 4; ++k) {
            const float weight = set.weights[vertex][k];
            if (!(weight > 0.0F) || set.joints[vertex][k] >= joint_count) continue;
            joints.emplace_back(static_cast<float>(set.joints[vertex][k]), weight);
            total += static_cast<double>(weight);
        }
    }
    // A vertex without weights follows the first joint.
    if (joints.empty()) return {{0.0F, 1.0F}};
    std::stable_sort(joints.begin(), joints.end(),
                     [](const glm::vec2& a, const glm::vec2& b) { return a.y < b.y; });
    float others = 0.0F;
    for (glm::vec2& joint : joints) {
        joint.y = static_cast<float>(static_cast<double>(joint.y) / total);
        if (&joint == &joints.back()) joint.y = 1.0F - others;
        others += joint.y;
    }
    return joints;
}

/// The texels of vertex.glsl's joint_weights, and their number for each vertex.
struct JointTexels {
    std::vector<glm::vec4> texels;
    std::size_t per_vertex = 0;
};

JointTexels joint_texels(const GltfDeformation& deformation, std::size_t vertices,
                         std::span<const std::uint32_t> source, std::size_t joint_count) {
    std::vector<std::vector<glm::vec2>> joints;
    std::size_t most = 0;
    for (std::size_t i = 0; i < vertices; ++i) {
        joints.push_back(joints_of(deformation, source.empty() ? i : source[i], joint_count));
        most = std::max(most, joints.back().size());
    }
    JointTexels result;
    result.per_vertex = (most + 1) / 2;
    result.texels.reserve(vertices * result.per_vertex);
    for (std::vector<glm::vec2>& of_vertex : joints) {
        // A joint of the vertex itself without a weight: a matrix that is not finite stays away.
        const glm::vec2 filling(of_vertex.front().x, 0.0F);
        of_vertex.resize(2 * result.per_vertex, filling);
        for (std::size_t i = 0; i < of_vertex.size(); i += 2)
            result.texels.emplace_back(of_vertex[i], of_vertex[i + 1]);
    }
    return result;
}

/// Returns the components of a vertex in vertex.glsl's morph_displacements.
int morph_components(const GltfDeformation& deformation, const PlannedDeformation& planned) {
    const auto any = [&](const std::vector<glm::vec3> GltfMorphTarget::*values) {
        return std::any_of(
            deformation.targets.begin(), deformation.targets.end(),
            [&](const GltfMorphTarget& target) { return !(target.*values).empty(); });
    };
    if (planned.target_tangents && any(&GltfMorphTarget::tangents)) return 3;
    return planned.target_normals && any(&GltfMorphTarget::normals) ? 2 : 1;
}

std::vector<glm::vec4> morph_texels(const GltfDeformation& deformation, std::size_t vertices,
                                    std::span<const std::uint32_t> source, int components) {
    std::vector<glm::vec4> texels;
    texels.reserve(deformation.targets.size() * vertices * static_cast<std::size_t>(components));
    for (const GltfMorphTarget& target : deformation.targets) {
        const std::array<const std::vector<glm::vec3>*, 3> values = {
            &target.positions, &target.normals, &target.tangents};
        for (std::size_t i = 0; i < vertices; ++i) {
            const std::size_t vertex = source.empty() ? i : source[i];
            for (std::size_t k = 0; k < static_cast<std::size_t>(components); ++k) {
                texels.emplace_back(values[k]->empty() ? glm::vec3(0.0F) : (*values[k])[vertex],
                                    0.0F);
            }
        }
    }
    return texels;
}

/// Returns the two next corners of the triangle of each vertex, and their numbers.
std::vector<glm::vec4> facet_texels(const Mesh& mesh, std::size_t vertices,
                                    std::span<const std::uint32_t> source) {
    // The vertex on the GPU of each vertex of the mesh. All that were made of one are equal here.
    std::vector<std::uint32_t> uploaded(mesh.positions.size());
    std::iota(uploaded.begin(), uploaded.end(), 0U);
    for (std::size_t i = 0; i < source.size(); ++i)
        uploaded[source[i]] = static_cast<std::uint32_t>(i);
    std::vector<std::array<glm::vec4, 2>> of_mesh(mesh.positions.size());
    for (const glm::uvec3& t : mesh.triangles) {
        const auto corner = [&](int k) {
            const std::uint32_t vertex = t[k % 3];
            return glm::vec4(mesh.positions[vertex], static_cast<float>(uploaded[vertex]));
        };
        for (int k = 0; k < 3; ++k)
            of_mesh[t[k]] = {corner(k + 1), corner(k + 2)};
    }
    std::vector<glm::vec4> texels;
    texels.reserve(2 * vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
        for (const glm::vec4& corner : of_mesh[source.empty() ? i : source[i]])
            texels.push_back(corner);
    }
    return texels;
}

void bind_texels(const gl::Api& api, TextureUnit unit, const gl::Texture& texture) {
    if (!texture) return;
    api->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    api->BindTexture(GL_TEXTURE_BUFFER, texture.name());
}

}  // namespace

std::shared_ptr<GpuMesh> MeshCache::get(const Shared<Mesh>& mesh, const PlannedStreams& streams,
                                        Report& report) {
    const auto [first, last] = meshes_.equal_range(&*mesh);
    auto entry = std::find_if(first, last, [&](const auto& known) {
        return known.second.streams == streams && known.second.identity.is(mesh);
    });
    if (entry == last) {
        Report findings;
        std::shared_ptr<GpuMesh> made = uploaded(*api_, mesh, streams, findings);
        entry = meshes_.emplace(
            &*mesh, Entry{mesh.identity(), streams, std::move(findings), std::move(made)});
    }
    report.merge(entry->second.findings);
    return entry->second.mesh;
}

void PlannedDeformation::add(const PlannedInterface& planned) {
    const auto uses = [](const std::vector<std::string>& names, const char* name) {
        return std::binary_search(names.begin(), names.end(), name);
    };
    joints |= uses(planned.samplers, "joint_weights");
    const bool morphs = uses(planned.samplers, "morph_displacements");
    targets |= morphs;
    target_normals |= morphs && uses(planned.attributes, "normal_object");
    target_tangents |= morphs && uses(planned.attributes, "tangent_object");
    facets |= uses(planned.samplers, "facet_corners");
}

GpuDeformation::GpuDeformation(const gl::Api& api, const Mesh& mesh, const GpuMesh& uploaded,
                               const MeshPose& pose, const PlannedDeformation& planned) {
    const std::span<const std::uint32_t> source = uploaded.source_vertex();
    const std::size_t vertices = source.empty() ? mesh.positions.size() : source.size();
    const GltfDeformation& deformation = pose.deformation;
    const auto add = [&](gl::Texture& texture, const std::vector<glm::vec4>& texels,
                         const char* what) {
        if (texels.empty()) return;
        const std::string name = fmt::format("{} of mesh '{}'", what, mesh.name);
        buffers.push_back(gl::make_buffer(api, texels, name));
        texture = gl::make_buffer_texture(api, buffers.back(), GL_RGBA32F, texels.size(), name);
    };
    if (planned.joints && !pose.joint_matrices.empty()) {
        const JointTexels joints =
            joint_texels(deformation, vertices, source, pose.joint_matrices.size());
        joint_pairs = static_cast<int>(joints.per_vertex);
        add(joint_weights, joints.texels, "joints");
    }
    if (planned.targets && !deformation.targets.empty()) {
        const int components = morph_components(deformation, planned);
        target_texels = {static_cast<int>(vertices) * components, components};
        add(morph_displacements, morph_texels(deformation, vertices, source, components),
            "morph targets");
    }
    if (planned.facets) add(facet_corners, facet_texels(mesh, vertices, source), "facets");
}

GpuOpenShares::GpuOpenShares(const gl::Api& api, const Mesh& mesh, const GpuMesh& uploaded,
                             const std::vector<float>& shares) {
    std::vector<float> hidden = of_vertices(shares, uploaded.source_vertex());
    for (float& share : hidden)
        share = 1.0F - share;
    // An effect that is forced on without shares is neutral.
    const std::size_t vertices =
        uploaded.source_vertex().empty() ? mesh.positions.size() : uploaded.source_vertex().size();
    hidden.resize(vertices, 0.0F);
    const std::string name = fmt::format("open shares of mesh '{}'", mesh.name);
    buffer_ = gl::make_buffer(api, hidden, name);
    texture_ = gl::make_buffer_texture(api, buffer_, GL_R32F, hidden.size(), name);
}

void GpuOpenShares::bind(const gl::Api& api) const {
    bind_texels(api, TextureUnit::hidden_shares, texture_);
}

void GpuPose::update(const gl::Api& api, std::shared_ptr<const GpuDeformation> vertices,
                     const MeshPose* pose) {
    vertices_ = std::move(vertices);
    weight_count_ = 0;
    if (!vertices_ || pose == nullptr) return;
    const auto upload = [&](gl::Buffer& buffer, gl::Texture& texture, std::size_t& size,
                            const std::vector<glm::vec4>& texels, const char* name) {
        if (texels.empty()) return;
        if (size == texels.size()) {
            gl::replace_content(api, buffer, std::as_bytes(std::span(texels)), name);
            return;
        }
        texture = {};
        buffer = gl::make_buffer(api, texels, name, GL_DYNAMIC_DRAW);
        texture = gl::make_buffer_texture(api, buffer, GL_RGBA32F, texels.size(), name);
        size = texels.size();
    };
    if (vertices_->joint_pairs > 0) {
        std::vector<glm::vec4> rows;
        for (const glm::mat4& matrix : pose->joint_matrices) {
            const glm::mat4 transposed = glm::transpose(matrix);
            rows.insert(rows.end(), {transposed[0], transposed[1], transposed[2]});
        }
        upload(matrices_, joint_matrices_, matrix_count_, rows, "joint matrices");
    }
    if (vertices_->target_texels.x > 0) {
        const std::size_t targets = pose->deformation->targets.size();
        std::vector<glm::vec4> active;
        for (std::size_t i = 0; i < std::min(targets, pose->weights.size()); ++i) {
            const float weight = pose->weights[i];
            if (weight != 0.0F) active.emplace_back(weight, static_cast<float>(i), 0.0F, 0.0F);
        }
        weight_count_ = static_cast<int>(active.size());
        active.resize(targets, glm::vec4(0.0F));
        upload(weights_, morph_weights_, max_weights_, active, "morph weights");
    }
}

void GpuPose::bind(const gl::Api& api) const {
    if (!vertices_) return;
    bind_texels(api, TextureUnit::joint_matrices, joint_matrices_);
    bind_texels(api, TextureUnit::joint_weights, vertices_->joint_weights);
    bind_texels(api, TextureUnit::morph_weights, morph_weights_);
    bind_texels(api, TextureUnit::morph_displacements, vertices_->morph_displacements);
    bind_texels(api, TextureUnit::facet_corners, vertices_->facet_corners);
}

glm::ivec3 GpuPose::morph_layout() const {
    return vertices_ ? glm::ivec3(weight_count_, vertices_->target_texels) : glm::ivec3(0);
}

std::shared_ptr<const GpuDeformation> MeshCache::get(const Shared<Mesh>& mesh,
                                                     const std::shared_ptr<GpuMesh>& uploaded,
                                                     const MeshPose& pose,
                                                     const PlannedDeformation& planned) {
    const std::size_t joints = pose.joint_matrices.size();
    const auto [first, last] = deformations_.equal_range(uploaded.get());
    const auto known = std::find_if(first, last, [&](const auto& item) {
        const DeformationEntry& entry = item.second;
        return entry.joints == joints && entry.planned == planned &&
               entry.mesh.lock() == uploaded && entry.identity.is(pose.deformation);
    });
    if (known != last) return known->second.deformation;
    auto made = std::make_shared<const GpuDeformation>(*api_, mesh, *uploaded, pose, planned);
    deformations_.emplace(uploaded.get(), DeformationEntry{pose.deformation.identity(), joints,
                                                           planned, uploaded, made});
    return made;
}

void MeshCache::drop_unused() {
    std::erase_if(deformations_,
                  [](const auto& entry) { return entry.second.deformation.use_count() == 1; });
    std::erase_if(meshes_, [](const auto& entry) { return entry.second.mesh.use_count() == 1; });
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

}  // namespace relief::shade::detail
