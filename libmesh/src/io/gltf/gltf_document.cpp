// SPDX-License-Identifier: Apache-2.0
// The public face of glTF documents; the work is done in the files that each function names.
// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#include "relief/mesh/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/gltf/gltf_animation.h"
#include "io/gltf/gltf_from_mesh.h"
#include "io/gltf/gltf_morph.h"
#include "io/gltf/gltf_primitive.h"
#include "io/gltf/gltf_reader.h"
#include "io/gltf/gltf_tangent_texcoords.h"
#include "io/gltf/gltf_view.h"
#include "io/gltf/gltf_writer.h"

namespace relief {
namespace {

void add_count(std::vector<std::string>& lines, std::size_t count, const char* thing) {
    if (count > 0) lines.push_back(fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s"));
}

/// Sums over all primitives.
struct PrimitiveCounts {
    std::size_t morph_targets = 0;
    std::size_t points_and_lines = 0;
    std::size_t more_attributes = 0;  ///< Beyond what Mesh has.
};

PrimitiveCounts count_primitives(const Json& root) {
    PrimitiveCounts counts;
    for (const Json& mesh : array_in(root, "meshes")) {
        for (const Json& primitive : mesh["primitives"]) {
            counts.morph_targets += array_in(primitive, "targets").size();
            if (size_in(primitive, "mode", 4) < 4) ++counts.points_and_lines;
            for (const auto& [name, accessor] : primitive["attributes"].items()) {
                if (name != "POSITION" && name != "NORMAL" && name != "TANGENT" &&
                    name != "TEXCOORD_0" && name != "COLOR_0") {
                    ++counts.more_attributes;
                }
            }
        }
    }
    return counts;
}

/// How many buffer views have a compressed copy by an extension.
std::size_t packed_views(const Json& root, const char* extension) {
    const Json& views = array_in(root, "bufferViews");
    return static_cast<std::size_t>(std::count_if(
        views.begin(), views.end(),
        [&](const Json& view) { return find(view, "extensions", extension) != nullptr; }));
}

/// How many primitives have a compressed copy.
std::size_t packed_primitives(const Json& root) {
    std::size_t count = 0;
    for (const Json& mesh : array_in(root, "meshes")) {
        for (const Json& primitive : mesh["primitives"])
            count += find(primitive, "extensions", draco_extension) != nullptr ? 1 : 0;
    }
    return count;
}

}  // namespace

struct GltfDocument::Contents {
    GltfContents data;
};

GltfDocument::GltfDocument(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
GltfDocument::GltfDocument(GltfDocument&&) noexcept = default;
GltfDocument& GltfDocument::operator=(GltfDocument&&) noexcept = default;
GltfDocument::~GltfDocument() = default;

GltfDocument GltfDocument::read(const std::filesystem::path& file, Report& report) {
    return GltfDocument(std::make_unique<Contents>(Contents{read_gltf(file, report)}));
}

GltfDocument GltfDocument::from_mesh(const MeshFile& contents) {
    return GltfDocument(std::make_unique<Contents>(Contents{gltf_from_mesh(contents, nullptr)}));
}

GltfDocument GltfDocument::from_mesh(const MeshFile& contents, Report& report) {
    return GltfDocument(std::make_unique<Contents>(Contents{gltf_from_mesh(contents, &report)}));
}

void GltfDocument::write(const std::filesystem::path& file) const {
    write_gltf(file, contents_->data);
}

std::vector<GltfPrimitiveId> GltfDocument::triangle_primitives() const {
    return triangle_primitives_of(contents_->data);
}

std::string GltfDocument::describe(GltfPrimitiveId id) const {
    return describe_primitive(contents_->data, id);
}

Mesh GltfDocument::mesh(GltfPrimitiveId id, int texcoord_set) const {
    return read_primitive(contents_->data, id, texcoord_set);
}

std::vector<int> GltfDocument::texcoord_sets(GltfPrimitiveId id) const {
    return texcoord_sets_of(contents_->data, id);
}

GltfTangentTexcoords GltfDocument::tangent_texcoords(GltfPrimitiveId id) const {
    return tangent_texcoords_of(contents_->data, id);
}

void GltfDocument::set_frames(GltfPrimitiveId id, const FramedMesh& framed) {
    replace_frames(contents_->data, id, framed);
}

std::size_t GltfDocument::set_frames(GltfPrimitiveId id, const FramedMesh& framed,
                                     const FrameOptions& options, Report& report) {
    return replace_all_frames(contents_->data, id, framed, options, report);
}

void GltfDocument::set_geometry(GltfPrimitiveId id, const Mesh& mesh) {
    replace_geometry(contents_->data, id, mesh);
}

GltfView GltfDocument::view() const {
    return view_of(contents_->data);
}

std::vector<GltfAnimation> GltfDocument::animations(Report& report) const {
    return animations_of(contents_->data, report);
}

std::vector<GltfCompression> GltfDocument::compression() const {
    const GltfContents& contents = contents_->data;
    std::vector<GltfCompression> result;
    const auto add = [&](const char* extension, const char* element, std::size_t copies) {
        const auto decoded = contents.unpacked.find(extension);
        const std::size_t count = decoded == contents.unpacked.end() ? 0 : decoded->second;
        if (count + copies > 0) result.push_back({extension, element, count, copies});
    };
    add(draco_extension, "primitive", packed_primitives(contents.root));
    for (const char* extension : meshopt_extensions)
        add(extension, "buffer view", packed_views(contents.root, extension));
    return result;
}

std::vector<std::string> GltfDocument::beyond_a_mesh() const {
    const Json& root = contents_->data.root;
    const PrimitiveCounts counts = count_primitives(root);
    std::vector<std::string> lines;
    add_count(lines, array_in(root, "animations").size(), "animation");
    add_count(lines, array_in(root, "skins").size(), "skin");
    add_count(lines, counts.morph_targets, "morph target");
    add_count(lines, array_in(root, "cameras").size(), "camera");
    if (const Json* lights = find(root, "extensions", "KHR_lights_punctual")) {
        add_count(lines, array_in(*lights, "lights").size(), "light");
    }
    add_count(lines, counts.more_attributes, "further vertex attribute");
    add_count(lines, counts.points_and_lines, "primitive of points or lines");
    return lines;
}

}  // namespace relief
