// SPDX-License-Identifier: Apache-2.0
// Bakes in memory.
// Tests: tests/python/test_command_line.py.
#include <algorithm>
#include <functional>
#include <memory>
#include <numbers>

#include "arrays.h"
#include "mesh_type.h"
#include "relief/mesh/bake.h"

namespace relief::python {
namespace {

/// The arrays of a bake. Absent layers are None.
struct BakeArrays {
    int width = 0;
    py::object normals = py::none();
    py::object heights = py::none();
    py::object occlusion = py::none();
    py::object curvature = py::none();
    py::object positions = py::none();
    py::object colors = py::none();
    py::object bent_normals = py::none();
    py::object thickness = py::none();
    py::object ids = py::none();
    py::array_t<std::uint8_t> states;
};

/// A layer in memory; the pointer is null for an absent one.
struct LayerMemory {
    float* first = nullptr;
    std::size_t row = 0;

    void store(std::span<const float> values, int first_row) const {
        if (first != nullptr)
            std::copy(values.begin(), values.end(),
                      first + row * static_cast<std::size_t>(first_row));
    }
};

/// The same of ids.
struct IdMemory {
    std::int32_t* first = nullptr;
    std::size_t row = 0;

    void store(std::span<const float> ids, int first_row) const {
        if (first == nullptr) return;
        std::transform(ids.begin(), ids.end(), first + row * static_cast<std::size_t>(first_row),
                       [](float id) { return static_cast<std::int32_t>(id); });
    }
};

IdMemory new_ids(const BakeMapOptions& map, py::object& array) {
    if (!map.layers.ids) return {};
    py::array_t<std::int32_t> ids(std::vector<py::ssize_t>{map.height, map.width});
    array = ids;
    return {ids.mutable_data(), static_cast<std::size_t>(map.width)};
}

LayerMemory new_layer(bool is_wanted, const BakeMapOptions& map, int channels, py::object& array) {
    if (!is_wanted) return {};
    std::vector<py::ssize_t> shape = {map.height, map.width};
    if (channels != 1) shape.push_back(channels);
    py::array_t<float> values(shape);
    array = values;
    return {values.mutable_data(),
            static_cast<std::size_t>(map.width) * static_cast<std::size_t>(channels)};
}

void check_size(int width, int height) {
    constexpr int max_side = 65536;
    if (width < 1 || height < 1 || width > max_side || height > max_side) {
        throw InvalidInput("size: " + std::to_string(width) + " x " + std::to_string(height) +
                           " texels, expected 1 to 65536 along each side");
    }
}

BakeLayers layers_of(const std::vector<std::string>& names, const OcclusionOptions& occlusion,
                     const ThicknessOptions& thickness) {
    BakeLayers layers;
    layers.normals = false;
    for (const std::string& name : names) {
        if (name == "normals")
            layers.normals = true;
        else if (name == "heights")
            layers.heights = true;
        else if (name == "occlusion")
            layers.occlusion = occlusion;
        else if (name == "curvature")
            layers.curvature = true;
        else if (name == "positions")
            layers.positions = true;
        else if (name == "colors")
            layers.colors = true;
        else if (name == "bent_normals")
            layers.bent_normals = occlusion;
        else if (name == "thickness")
            layers.thickness = thickness;
        else if (name == "ids")
            layers.ids = true;
        else
            refuse_name("layers", name,
                        {"normals", "heights", "occlusion", "curvature", "positions", "colors",
                         "bent_normals", "thickness", "ids"});
    }
    return layers;
}

py::dict report_of(const BakeResult& result, const BakeFit& fit, const std::vector<SurfaceId>& ids,
                   const Report& findings) {
    py::list first;
    for (const MissedTexel& texel : result.first_missed) {
        py::dict entry;
        entry["x"] = texel.x;
        entry["y"] = texel.y;
        entry["position"] =
            std::vector<double>{texel.position.x, texel.position.y, texel.position.z};
        first.append(std::move(entry));
    }
    py::dict missed;
    missed["first"] = std::move(first);
    py::dict boxes;
    boxes["gap"] = fit.gap;
    boxes["size_ratio"] = fit.size_ratio;
    py::dict report;
    report["offset"] = result.distances.offset;
    report["max_distance"] = result.distances.max_distance;
    report["min_height"] = result.min_height;
    report["max_height"] = result.max_height;
    report["texels_baked"] = result.texels_baked;
    report["texels_missed"] = result.texels_missed;
    report["samples"] = result.samples;
    report["rays"] = result.rays;
    report["occlusion_rays"] = result.occlusion_rays;
    report["thickness_rays"] = result.thickness_rays;
    report["open_thickness_rays"] = result.open_thickness_rays;
    py::list names;
    for (const SurfaceId& id : ids) {
        py::dict entry;
        entry["name"] = id.name;
        entry["color"] = color_text(id);
        names.append(std::move(entry));
    }
    report["ids"] = std::move(names);
    report["boxes"] = std::move(boxes);
    report["missed"] = std::move(missed);
    report["findings"] = to_list(findings);
    return report;
}

/// One mesh is baked from its own memory. Several are copied, because the baker needs them in one
/// array.
struct HighMeshes {
    std::vector<Mesh> copies;
    std::span<const Mesh> span;
};

HighMeshes high_meshes(const py::object& high) {
    HighMeshes meshes;
    if (py::isinstance<MeshObject>(high)) {
        const Mesh& mesh = high.cast<const MeshObject&>();
        meshes.span = std::span(&mesh, 1);
        return meshes;
    }
    for (const py::handle mesh : high)
        meshes.copies.push_back(mesh.cast<const MeshObject&>());
    meshes.span = meshes.copies;
    return meshes;
}

py::dict py_bake(const py::object& high, const MeshObject& low, std::pair<int, int> size,
                 const std::vector<std::string>& layers, const std::string& space,
                 const std::string& rays, double hardness, const MeshObject* cage,
                 std::optional<double> offset, std::optional<double> max_distance,
                 const std::string& back_faces, int samples, std::optional<double> sample_degrees,
                 const std::string& outside, int padding, int occlusion_rays,
                 std::optional<double> occlusion_distance, int thickness_rays,
                 std::optional<double> thickness_distance, bool allow_size_mismatch,
                 const std::optional<py::function>& progress) {
    constexpr auto faces =
        std::to_array<EnumName<BackFaces>>({{"skip", BackFaces::skip}, {"take", BackFaces::take}});
    constexpr auto regions = std::to_array<EnumName<bool>>({{"drop", false}, {"repeat", true}});
    check_size(size.first, size.second);
    BakeOptions options;
    options.map.width = size.first;
    options.map.height = size.second;
    options.map.placement.repeat = value_of<bool>(outside, "outside", regions);
    options.map.layers = layers_of(layers, {occlusion_rays, occlusion_distance},
                                   {thickness_rays, thickness_distance});
    options.space = value_of<VectorSpace>(space, "space");
    options.directions = value_of<RayDirections>(rays, "rays");
    options.hardness = hardness;
    if (cage != nullptr) options.cage = std::make_shared<const Mesh>(*cage);
    options.offset = offset;
    options.max_distance = max_distance;
    options.back_faces = value_of<BackFaces>(back_faces, "back_faces", faces);
    options.map.samples = samples;
    if (sample_degrees) options.map.sample_angle = *sample_degrees * std::numbers::pi / 180.0;
    options.map.padding = padding;
    options.allow_size_mismatch = allow_size_mismatch;

    const HighMeshes meshes = high_meshes(high);
    BakeArrays arrays;
    const BakeLayers& wanted = options.map.layers;
    const LayerMemory normals = new_layer(wanted.normals, options.map, 3, arrays.normals);
    const LayerMemory heights = new_layer(wanted.heights, options.map, 1, arrays.heights);
    const LayerMemory occlusion =
        new_layer(wanted.occlusion.has_value(), options.map, 1, arrays.occlusion);
    const LayerMemory curvature = new_layer(wanted.curvature, options.map, 1, arrays.curvature);
    const LayerMemory positions = new_layer(wanted.positions, options.map, 3, arrays.positions);
    const LayerMemory colors = new_layer(wanted.colors, options.map, 3, arrays.colors);
    const LayerMemory bent_normals =
        new_layer(wanted.bent_normals.has_value(), options.map, 3, arrays.bent_normals);
    const LayerMemory thickness =
        new_layer(wanted.thickness.has_value(), options.map, 1, arrays.thickness);
    const IdMemory ids = new_ids(options.map, arrays.ids);
    arrays.states =
        py::array_t<std::uint8_t>(std::vector<py::ssize_t>{options.map.height, options.map.width});
    std::uint8_t* const states = arrays.states.mutable_data();
    const std::size_t width = static_cast<std::size_t>(options.map.width);

    Report findings;
    BakeFit fit;
    std::vector<SurfaceId> names;
    const auto work = [&] {
        const Baker baker(meshes.span, low, options, findings);
        fit = baker.fit();
        names = baker.ids();
        return baker.bake(
            options.map,
            [&](const BakedRows& rows) {
                normals.store(rows.normals, rows.first_row);
                heights.store(rows.heights, rows.first_row);
                occlusion.store(rows.occlusion, rows.first_row);
                curvature.store(rows.curvature, rows.first_row);
                positions.store(rows.positions, rows.first_row);
                colors.store(rows.colors, rows.first_row);
                bent_normals.store(rows.bent_normals, rows.first_row);
                thickness.store(rows.thickness, rows.first_row);
                ids.store(rows.ids, rows.first_row);
                std::transform(rows.states.begin(), rows.states.end(),
                               states + width * static_cast<std::size_t>(rows.first_row),
                               [](TexelState state) { return static_cast<std::uint8_t>(state); });
            },
            findings);
    };
    const BakeResult result = without_gil(work, [&](const Progress::State& state) {
        if (progress && state.stage == "baking") (*progress)(state.part.value_or(0.0));
    });
    if (result.texels_baked + result.texels_missed == 0)
        throw InvalidInput("the low mesh covers no texel of the map (see `outside`)");
    py::dict baked;
    baked["normals"] = arrays.normals;
    baked["heights"] = arrays.heights;
    baked["occlusion"] = arrays.occlusion;
    baked["curvature"] = arrays.curvature;
    baked["positions"] = arrays.positions;
    baked["colors"] = arrays.colors;
    baked["bent_normals"] = arrays.bent_normals;
    baked["thickness"] = arrays.thickness;
    baked["ids"] = arrays.ids;
    baked["states"] = arrays.states;
    baked["report"] = report_of(result, fit, names, findings);
    return baked;
}

}  // namespace

void add_bake(py::module_& module) {
    using py::arg;
    const py::object none = py::none();
    module.def(
        "bake", &py_bake, arg("high"), arg("low"), arg("size"), py::kw_only(),
        arg("layers") = std::vector<std::string>{"normals"}, arg("space") = "tangent",
        arg("rays") = "averaged", arg("hardness") = 0.0, arg("cage") = none, arg("offset") = none,
        arg("max_distance") = none, arg("back_faces") = "skip", arg("samples") = 1,
        arg("sample_degrees") = none, arg("outside") = "drop", arg("padding") = 16,
        arg("occlusion_rays") = 64, arg("occlusion_distance") = none, arg("thickness_rays") = 64,
        arg("thickness_distance") = none, arg("allow_size_mismatch") = false,
        arg("progress") = none,
        "Bake maps of `size` (width, height) for a low mesh from one or more high meshes.\n\n"
        "See relief.bake() for the result.");
}

}  // namespace relief::python
