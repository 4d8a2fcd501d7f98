// SPDX-License-Identifier: Apache-2.0
// Files of stages. A job that continues with an unchanged file must give the same bytes, which
// depend on the order of triangles and vertices: a layout restores it, although the file has them
// by part. Tests: tests/make/stage_file_test.cpp.
#include "relief/make/stage_file.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <utility>

#include "draw_modes.h"
#include "io/gltf/gltf_nodes.h"
#include "part_groups.h"
#include "relief/mesh/gltf_document.h"

namespace relief::make {
namespace {

void add_run(std::vector<StageRun>& runs, std::vector<std::uint32_t> primitives) {
    if (runs.empty() || runs.back().primitives != primitives)
        runs.push_back({0, std::move(primitives)});
    ++runs.back().count;
}

/// The primitives of a file, by part and alpha mode.
struct PrimitiveNumbers {
    std::vector<std::uint32_t> pairs;  ///< By primitive (pairs_of()), ascending.
    std::vector<std::uint32_t> of_triangle;
};

PrimitiveNumbers primitives_of(const StageMesh& stage) {
    const std::span<const std::uint32_t> parts = stage.parts.names.size() > 1
                                                     ? std::span(stage.parts.part_of)
                                                     : std::span<const std::uint32_t>();
    PrimitiveNumbers result;
    result.of_triangle = detail::pairs_of(parts, stage.alpha_modes);
    std::map<std::uint32_t, std::uint32_t> number_of;
    for (const std::uint32_t pair : result.of_triangle)
        number_of.try_emplace(pair, 0);
    for (auto& [pair, number] : number_of) {
        number = static_cast<std::uint32_t>(result.pairs.size());
        result.pairs.push_back(pair);
    }
    for (std::uint32_t& pair : result.of_triangle)
        pair = number_of.at(pair);
    return result;
}

/// Returns a mesh without what files of stages leave out.
Mesh bare(const Mesh& mesh, const std::string& name) {
    Mesh result = mesh;
    result.name = name;
    result.material_ranges.clear();  // The materials are those of the source.
    return result;
}

StageLayout layout_of(const StageMesh& stage, const PrimitiveNumbers& numbers) {
    StageLayout layout;
    layout.has_parts = stage.parts.names.size() > 1;
    for (const std::uint32_t primitive : numbers.of_triangle)
        add_run(layout.triangles, {primitive});
    const detail::KeyedVertices vertices(stage.mesh, numbers.of_triangle, numbers.pairs.size());
    for (std::uint32_t v = 0; v < stage.mesh.positions.size(); ++v) {
        std::vector<std::uint32_t> primitives;
        for (const detail::KeyedVertices::Use& use : vertices.of(v))
            primitives.push_back(use.key);
        if (!primitives.empty()) add_run(layout.vertices, std::move(primitives));
    }
    return layout;
}

}  // namespace

StageLayout write_stage_file(const std::filesystem::path& file, const std::string& name,
                             const StageMesh& stage, const glm::dvec3& origin, Report& report) {
    const PrimitiveNumbers numbers = primitives_of(stage);
    const bool has_names = stage.parts.names.size() > 1;
    if (numbers.pairs.size() < 2 && !has_names) {
        MeshFile contents;
        contents.mesh = bare(stage.mesh, name);
        contents.origin = origin;
        GltfDocument::from_mesh(contents, report).write(file, report);
        return {};
    }
    std::vector<Mesh> meshes =
        detail::divided(bare(stage.mesh, name), numbers.of_triangle, numbers.pairs.size());
    std::vector<relief::detail::NodeMaterial> materials;
    if (!stage.alpha_modes.empty()) {
        for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend})
            materials.push_back({std::string(enum_name(mode)), mode});
    }
    std::vector<relief::detail::MeshNode> nodes;
    std::uint32_t last_part = 0;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const std::uint32_t part = numbers.pairs[i] / detail::alpha_count;
        if (nodes.empty() || part != last_part)
            nodes.push_back({has_names ? stage.parts.names[part] : name, {}});
        last_part = part;
        nodes.back().primitives.push_back(
            {std::move(meshes[i]), numbers.pairs[i] % detail::alpha_count});
    }
    relief::detail::write_nodes(file, nodes, materials, origin, report);
    return layout_of(stage, numbers);
}

namespace {

/// Takes primitives apart and joins them in the order of a layout.
class LayoutReader {
  public:
    LayoutReader(const std::filesystem::path& file, const GltfDocument& document)
        : file_(file), ids_(document.triangle_primitives()) {
        for (const GltfPrimitiveId id : ids_)
            primitives_.push_back(document.mesh(id));
        numbers_.resize(primitives_.size());
    }

    StageContents read(const StageLayout& layout, const GltfView& view);

  private:
    void require(bool is_sound) const {
        if (!is_sound) throw FileError(file_, "has another layout than it was written with");
    }
    void add_vertices(const StageLayout& layout, Mesh& mesh);

    const std::filesystem::path& file_;
    std::vector<GltfPrimitiveId> ids_;
    std::vector<Mesh> primitives_;
    std::vector<std::vector<std::uint32_t>> numbers_;  ///< Of their vertices in the mesh.
};

void LayoutReader::add_vertices(const StageLayout& layout, Mesh& mesh) {
    std::uint32_t count = 0;
    for (const StageRun& run : layout.vertices) {
        require(!run.primitives.empty());
        for (std::uint32_t i = 0; i < run.count; ++i, ++count) {
            for (const std::uint32_t primitive : run.primitives) {
                require(primitive < primitives_.size());
                numbers_[primitive].push_back(count);
            }
        }
    }
    for (std::size_t i = 0; i < primitives_.size(); ++i)
        require(numbers_[i].size() == primitives_[i].positions.size());
    const auto join = [&](auto attribute) {
        const bool is_there = std::ranges::all_of(
            primitives_, [&](const Mesh& part) { return !(part.*attribute).empty(); });
        if (!is_there) return;
        (mesh.*attribute).resize(count);
        for (std::size_t i = 0; i < primitives_.size(); ++i) {
            for (std::size_t v = 0; v < numbers_[i].size(); ++v)
                (mesh.*attribute)[numbers_[i][v]] = (primitives_[i].*attribute)[v];
        }
    };
    join(&Mesh::positions);
    join(&Mesh::normals);
    join(&Mesh::texcoords);
    join(&Mesh::tangents);
    join(&Mesh::colors);
}

StageContents LayoutReader::read(const StageLayout& layout, const GltfView& view) {
    StageContents contents;
    Mesh& mesh = contents.mesh;
    add_vertices(layout, mesh);
    std::vector<AlphaMode> alpha_of(primitives_.size(), AlphaMode::opaque);
    std::vector<std::uint32_t> part_of(primitives_.size(), 0);
    std::vector<std::string>& names = contents.parts.names;
    for (std::size_t i = 0; i < primitives_.size(); ++i) {
        const auto placed =
            std::ranges::find(view.primitives, ids_[i], &GltfInstance<GltfPrimitiveId>::what);
        require(placed != view.primitives.end());
        if (ids_[i].primitive == 0) names.push_back(placed->name);
        part_of[i] = static_cast<std::uint32_t>(names.size() - 1);
        const std::vector<MaterialRange>& ranges = primitives_[i].material_ranges;
        if (!ranges.empty() && ranges.front().material)
            alpha_of[i] = view.materials.at(*ranges.front().material).alpha_mode;
    }
    std::vector<std::size_t> next(primitives_.size(), 0);
    for (const StageRun& run : layout.triangles) {
        require(run.primitives.size() == 1 && run.primitives.front() < primitives_.size());
        const std::uint32_t primitive = run.primitives.front();
        for (std::uint32_t i = 0; i < run.count; ++i) {
            require(next[primitive] < primitives_[primitive].triangles.size());
            const glm::uvec3& t = primitives_[primitive].triangles[next[primitive]++];
            const std::vector<std::uint32_t>& numbers = numbers_[primitive];
            mesh.triangles.emplace_back(numbers[t.x], numbers[t.y], numbers[t.z]);
            contents.parts.part_of.push_back(part_of[primitive]);
            contents.alpha_modes.push_back(alpha_of[primitive]);
        }
    }
    for (std::size_t i = 0; i < primitives_.size(); ++i)
        require(next[i] == primitives_[i].triangles.size());
    if (!layout.has_parts) contents.parts = {};
    if (!detail::is_mixed(contents.alpha_modes)) contents.alpha_modes.clear();
    return contents;
}

}  // namespace

StageContents read_stage_file(const std::filesystem::path& file, const StageLayout& layout) {
    const GltfDocument document = GltfDocument::read(file);
    const GltfView view = document.view();
    if (layout.triangles.empty()) {
        if (view.primitives.size() != 1)
            throw FileError(file, "has another layout than it was written with");
        StageContents contents;
        contents.mesh = document.mesh(view.primitives.front().what);
        contents.mesh.material_ranges.clear();
        return contents;
    }
    return LayoutReader(file, document).read(layout, view);
}

}  // namespace relief::make
