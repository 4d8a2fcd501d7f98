// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/material_test.cpp, write_into_test.cpp.
#include "common/material_maps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "common/model_file.h"
#include "common/options.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

/// "material-N" stands for a material without a name, as in the files of `relief-bake mesh`.
std::string shown_name(const GltfMaterial& material, std::size_t index) {
    return material.name.empty() ? fmt::format("material-{}", index) : material.name;
}

std::vector<std::string> names_of(const std::vector<GltfMaterial>& materials) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < materials.size(); ++i)
        names.push_back(shown_name(materials[i], i));
    return names;
}

/// Returns the index of the material with a name.
std::size_t named_material(const MaterialRequest& request, const std::vector<std::string>& names,
                           const std::string& name) {
    const auto count = std::ranges::count(names, name);
    if (count == 1) {
        return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    }
    if (count > 1) {
        throw failure(request.input, fmt::format("has {} materials '{}'", count, name),
                      "rename them first");
    }
    throw failure(request.input, fmt::format("has no material '{}'", name),
                  fmt::format("available: '{}'", fmt::join(names, "', '")));
}

/// Returns the indices of the materials that get some maps. A model without materials gets one.
std::vector<std::size_t> chosen_materials(GltfDocument& document, const MaterialRequest& request,
                                          const std::optional<std::string>& name, bool& is_new) {
    const std::vector<std::string> names = names_of(document.view().materials);
    is_new = names.empty();
    if (names.empty()) return {document.add_material(name.value_or("material"))};
    if (name) return {named_material(request, names, *name)};
    if (names.size() > 1 && !request.all_materials) {
        throw failure(request.input, fmt::format("has {} materials", names.size()),
                      fmt::format("choose one with --material: '{}'", fmt::join(names, "', '")));
    }
    std::vector<std::size_t> all(names.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
}

/// Returns the texture coordinate set for which maps of a material are baked.
int baked_set(const GltfDocument& document, std::size_t material) {
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const Mesh mesh = document.mesh(id);
        if (!mesh.material_ranges.empty() && mesh.material_ranges.front().material == material)
            return document.tangent_texcoords(id).set;
    }
    return 0;
}

/// Checks that a material shows a baked map as it is stored. \throws FileError
void check_baked(const MaterialRequest& request, const GltfDocument& document, std::size_t material,
                 const MaterialMap& map, Report& report) {
    const GltfMaterial view = document.view().materials[material];
    const GltfTexcoords& texcoords = view.texcoords_of(map.slot);
    const std::string what = fmt::format("the {} texture of material '{}'",
                                         slot_info(map.slot).name, shown_name(view, material));
    if (texcoords.transform != GltfTextureTransform{}) {
        throw failure(request.input,
                      what + " has KHR_texture_transform, which would move the baked map",
                      "remove the transform");
    }
    const int set = baked_set(document, material);
    if (texcoords.set != set) {
        throw failure(request.input,
                      fmt::format("{} uses another texture coordinate set than {}, for which the "
                                  "map is baked",
                                  what, set),
                      "change one of them");
    }
    const bool is_white = view.metallic_roughness->base_color == glm::vec3(1.0F) &&
                          (!request.alpha || view.opacity == 1.0F);
    if (map.slot == TextureSlot::base_color && !is_white) {
        report.add("base color factor of a material with baked colors", "material", material,
                   "multiplies them");
    }
}

/// The kinds of maps that glTF prescribes for a slot.
std::vector<MapKind> kinds_of_gltf(TextureSlot slot) {
    switch (slot) {
        case TextureSlot::normal:
            return {MapKind::normal};
        case TextureSlot::metallic_roughness:
            return {MapKind::packed};
        case TextureSlot::occlusion:
            return {MapKind::occlusion, MapKind::packed};
        default:
            return {MapKind::color};
    }
}

/// Checks that a map is what glTF prescribes for its slot. A damaged image is an error here, not in
/// a renderer.
void check_slot(const MaterialMap& map, const AssumedKinds& assumed) {
    const std::vector<MapKind> accepted = kinds_of_gltf(map.slot);
    const MapDescription stated = read_description(check_kind(map.file, accepted, assumed));
    if (std::ranges::count(assumed, accepted.front()) > 0) return;
    const auto refuse = [&](bool is_wrong, const char* problem, const char* option) {
        if (!is_wrong) return;
        throw failure(map.file, fmt::format("has {}, as its metadata say", problem),
                      fmt::format("convert it with relief-bake convert {} OUT.png {}",
                                  quoted(map.file), option));
    };
    if (map.slot == TextureSlot::normal) {
        refuse(stated.green == Green::down, "green down, but glTF has green up", "--flip green");
        refuse(stated.flat == FlatCode::middle, "zero at 128, but glTF decodes zero at 127.5",
               "--zero-code 127.5");
        refuse(stated.xy_only, "only x and y, but glTF needs z", "--rebuild-z rg");
    }
    if (stated.kind == MapKind::packed && stated.detail == "unity") {
        throw failure(map.file, "is packed for Unity, as its metadata say",
                      "pack it with relief-bake pack --for gltf");
    }
}

void store_in_material(GltfDocument& document, std::size_t material, const MaterialRequest& request,
                       const std::vector<MaterialMap>& maps, Report& report) {
    const bool is_glb = writable_format(request.output) == ModelFormat::glb;
    const GltfImageStorage storage =
        request.embeds || is_glb ? GltfImageStorage::embedded : GltfImageStorage::external;
    for (const MaterialMap& map : maps) {
        check_slot(map, request.assumed);
        if (request.are_baked) check_baked(request, document, material, map, report);
        document.set_texture(material, map.slot, map.file, storage, report);
        if (map.slot != TextureSlot::normal) continue;
        const float old_scale = document.view().materials[material].normal_map->scale;
        if (request.normal_scale)
            document.set_normal_scale(material, *request.normal_scale);
        else if (request.are_baked && old_scale != 1.0F)
            document.set_normal_scale(material, 1.0);
    }
}

GltfDocument read_model_for_maps(const MaterialRequest& request, Report& report) {
    Model model = read_model(request.input, report);
    if (auto* document = std::get_if<GltfDocument>(&model)) return std::move(*document);
    return about(request.input, [&] {
        auto& file = std::get<MeshFile>(model);
        // The maps are for these normals; glTF would show flat ones instead.
        if (file.mesh.normals.empty()) {
            FrameOptions frames;
            frames.tangents = TangentMethod::none;
            file.mesh = with_frames(std::move(file.mesh), frames, report).mesh;
        }
        return GltfDocument::from_mesh(file, report);
    });
}

/// Makes materials show the alpha of their baked colors. If one of them is not opaque, the author
/// of the model has decided about all.
void set_alpha(GltfDocument& document, const std::vector<std::size_t>& materials,
               const BakedAlpha& alpha, Report& report) {
    const std::vector<GltfMaterial> before = document.view().materials;
    const bool is_opaque = std::ranges::all_of(
        materials, [&](std::size_t i) { return before[i].alpha_mode == AlphaMode::opaque; });
    if (!is_opaque) return;
    for (const std::size_t material : materials) {
        document.set_alpha_mode(material, alpha.mode, alpha.cutoff);
        report.add("opaque material with transparent baked colors", "material", material,
                   fmt::format("gets the alpha mode {}",
                               alpha.mode == AlphaMode::mask ? "MASK" : "BLEND"));
    }
}

bool has_normal_map(const StoredMaterial& material) {
    return std::ranges::any_of(
        material.maps, [](const MaterialMap& map) { return map.slot == TextureSlot::normal; });
}

}  // namespace

void check_materials(const MaterialRequest& request) {
    Report unused;  // store_maps() reports the same findings.
    GltfDocument document = read_model_for_maps(request, unused);
    about(request.input, [&] {
        for (const MaterialMaps& maps : request.materials) {
            bool is_new = false;
            for (const std::size_t material :
                 chosen_materials(document, request, maps.material, is_new)) {
                if (!request.are_baked) continue;
                for (const MaterialMap& map : maps.maps)
                    check_baked(request, document, material, map, unused);
            }
        }
    });
}

MaterialResult store_maps(const MaterialRequest& request, Stages& stages) {
    MaterialResult result;
    Report read_report;
    Model model = stages.run("read", [&] { return read_model_for_maps(request, read_report); });
    result.findings.add("", read_report);
    auto& document = std::get<GltfDocument>(model);
    Report report;
    std::vector<FramedPart> parts;
    about(request.input, [&] {
        for (const MaterialMaps& maps : request.materials) {
            bool is_new = false;
            const std::vector<std::size_t> chosen =
                chosen_materials(document, request, maps.material, is_new);
            if (request.alpha) set_alpha(document, chosen, *request.alpha, report);
            for (const std::size_t material : chosen) {
                store_in_material(document, material, request, maps.maps, report);
                result.materials.push_back(
                    {names_of(document.view().materials)[material], is_new, maps.maps});
                if (!request.adds_tangents || !has_normal_map(result.materials.back())) continue;
                for (FramedPart& part :
                     stages.run("tangents", [&] { return add_tangents(document, material); }))
                    parts.push_back(std::move(part));
            }
        }
    });
    result.findings.add("", report);
    for (const FramedPart& part : parts) {
        result.findings.add(part.name, part.report);
        result.primitives_with_new_tangents +=
            part.tangents == AttributeOutcome::computed ? std::size_t{1} : std::size_t{0};
    }
    Report write_report;
    stages.run("write",
               [&] { write_model(request.output, model, request.input, true, write_report); });
    result.findings.add("", write_report);
    return result;
}

Summary summary_of(const MaterialResult& result) {
    Summary summary;
    std::vector<std::string> names, lines;
    Json materials = Json::array();
    for (const StoredMaterial& material : result.materials) {
        names.push_back(fmt::format("'{}'{}", material.name, material.is_new ? ", new" : ""));
        Json maps = Json::array();
        for (const MaterialMap& map : material.maps) {
            const std::string line =
                fmt::format("{}: {}", slot_info(map.slot).name, map.file.string());
            if (std::ranges::find(lines, line) == lines.end()) lines.push_back(line);
            maps.push_back({{"map", slot_info(map.slot).name}, {"file", map.file.string()}});
        }
        materials.push_back(
            {{"material", material.name}, {"is_new", material.is_new}, {"maps", std::move(maps)}});
    }
    summary.add(
        "material", fmt::format("{}", fmt::join(names, ", ")),
        materials.size() == 1 ? materials.front() : Json{{"materials", std::move(materials)}});
    summary.add("maps", lines);
    const std::size_t count = result.primitives_with_new_tangents;
    if (std::ranges::any_of(result.materials, has_normal_map)) {
        summary.add("tangents",
                    count == 0
                        ? "unchanged"
                        : fmt::format("mikktspace, added to {}", counted(count, "primitive")),
                    {{"primitives_with_new_tangents", count}});
    }
    return summary;
}

void add_write_into_options(CLI::App& app, WriteIntoOptions& options,
                            const std::string& description) {
    const std::string group = "glTF";
    add_path(app, "--write-into", options.model, description).group(group);
    add_value(app, "--material", "NAME",
              "The material of --write-into. Default: its only one. A model without materials gets "
              "one.",
              [&options](const std::string&, const std::string& text) { options.material = text; })
        .group(group);
    add_switch(app, "--embed", options.embed,
               "Store the images in the buffer of a .gltf, as a .glb always does.")
        .group(group);
    add_switch(app, "--external", options.external, "Copy the images beside a .gltf (default).")
        .group(group);
}

void check(const CLI::App& app, const WriteIntoOptions& options) {
    if (!options.model) {
        return refuse_given(app, {"--material", "--embed", "--external"}, "--write-into",
                            "give --write-into MODEL.glb");
    }
    if (!is_document(writable_format(*options.model))) {
        throw UsageError(
            fmt::format("--write-into {}: cannot store materials of glTF", options.model->string()),
            "write a .glb or .gltf");
    }
    if (options.embed && options.external)
        throw UsageError("--embed and --external contradict each other", "give one of them");
    if (options.external && writable_format(*options.model) == ModelFormat::glb)
        throw UsageError("--external: a .glb embeds its images", "write a .gltf");
    require_folder_of(*options.model);
}

void check_image(const std::string& option, const std::filesystem::path& file) {
    const std::string extension = extension_of(file);
    if (extension == ".png" || extension == ".jpg" || extension == ".jpeg") return;
    throw UsageError(fmt::format("{}: glTF cannot store {}", option, file.string()), "use a .png");
}

}  // namespace relief::tools
