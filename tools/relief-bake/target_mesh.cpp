// SPDX-License-Identifier: Apache-2.0
#include "target_mesh.h"

#include "common/command.h"
#include "common/text.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh_file.h"

namespace relief::tools {
namespace {

/// Appends arrays that every part has.
void append(Mesh& all, const Mesh& part) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    const auto add = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    add(all.positions, part.positions);
    add(all.normals, part.normals);
    add(all.tangents, part.tangents);
    add(all.texcoords, part.texcoords);
    for (const glm::uvec3& triangle : part.triangles)
        all.triangles.push_back(triangle + first);
}

class Collector {
  public:
    Collector(const std::filesystem::path& file, std::optional<TangentMode> tangents,
              TargetMesh& target, Report& report)
        : file_(file), tangents_(tangents), target_(target), report_(report) {}

    void add(Mesh part, NormalMode if_missing, const std::string& name) {
        const std::string whose = name.empty() ? "" : name + ": ";
        if (part.texcoords.empty())
            throw failure(file_, whose + "no texture coordinates", "unwrap it first");
        FrameOptions options;
        options.if_missing = if_missing;
        const bool keeps = !tangents_ && !part.tangents.empty() && !part.normals.empty();
        options.tangents = keeps ? TangentMode::keep : tangents_.value_or(TangentMode::mikktspace);
        target_.has_own_tangents = target_.has_own_tangents && keeps;
        append(target_.mesh, with_frames(std::move(part), options, report_).mesh);
    }

  private:
    const std::filesystem::path& file_;
    std::optional<TangentMode> tangents_;
    TargetMesh& target_;
    Report& report_;
};

}  // namespace

TargetMesh read_target_mesh(const std::filesystem::path& file, std::optional<TangentMode> tangents,
                            Report& report) {
    TargetMesh target;
    target.has_own_tangents = true;
    Collector collector(file, tangents, target, report);
    const std::string extension = extension_of(file);
    about(file, [&] {
        if (extension != ".gltf" && extension != ".glb") {
            collector.add(read_mesh(file, report).mesh, NormalMode::angle, "");
            return;
        }
        const GltfDocument document = GltfDocument::read(file, report);
        for (const GltfPrimitiveId id : document.triangle_primitives())
            collector.add(document.mesh(id, document.tangent_texcoords(id).set), NormalMode::flat,
                          document.describe(id));
    });
    if (target.mesh.triangles.empty()) throw FileError(file, "holds no triangles");
    return target;
}

}  // namespace relief::tools
