// SPDX-License-Identifier: Apache-2.0
#include "saved_files.h"

#include <unistd.h>

#include <algorithm>
#include <variant>

#include "common/command.h"
#include "common/file_jobs.h"
#include "common/material_maps.h"
#include "common/model_file.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// glTF requires flat normals if there are none, and then ignores stored tangents.
void frame(GltfDocument& document, const FrameOptions& read, Report& report) {
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const GltfTangentTexcoords texcoords = document.tangent_texcoords(id);
        Mesh mesh = document.mesh(id, texcoords.set);
        FrameOptions options = read;
        options.if_missing = read.crease_angle ? NormalMode(NormalWeight::angle) : NormalMode::flat;
        const bool has_normals = !mesh.normals.empty();
        const bool has_tangents = has_normals && !mesh.tangents.empty();
        if (!has_tangents) options.tangents = TangentMethod::none;
        if (!has_tangents && !mesh.texcoords.empty() && !texcoords.texture.empty())
            options.tangents = TangentMethod::mikktspace;
        const bool keeps_normals = has_normals && options.normals == NormalMode::keep;
        if (keeps_normals && !computes_tangents(options.tangents)) continue;
        const FramedMesh framed = with_frames(std::move(mesh), options, report);
        document.set_frames(id, framed, options, report);
    }
}

void frame(MeshFile& contents, FrameOptions options, Report& report) {
    const bool has_map =
        std::any_of(contents.materials.begin(), contents.materials.end(),
                    [](const MtlMaterial& material) { return material.normal_map.has_value(); });
    if (has_map && !contents.mesh.texcoords.empty()) options.tangents = TangentMethod::mikktspace;
    contents.mesh = with_frames(std::move(contents.mesh), options, report).mesh;
}

/// Turns z up: glTF's y points up.
void turn_y_up(Model& model) {
    auto* contents = std::get_if<MeshFile>(&model);
    if (contents == nullptr)
        throw InvalidInput("is drawn with z up, which a copy of a glTF file cannot store");
    const auto turn = [](auto& v) {
        const auto y = v.y;
        v.y = v.z;
        v.z = -y;
    };
    turn(contents->origin);
    for (glm::vec3& position : contents->mesh.positions)
        turn(position);
    for (glm::vec3& normal : contents->mesh.normals)
        turn(normal);
    for (glm::vec4& tangent : contents->mesh.tangents)
        turn(tangent);
}

}  // namespace

void add_save_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Output";
    add_path(app, "--save-scene", options.save_scene,
             "Write a scene file (.json) that draws this picture. It refers to the model and "
             "contains the materials, lights, environment and camera that the options change.")
        .group(group);
    add_path(app, "--save-model", options.save_model,
             "Write the model as .glb or .gltf with the normals and tangents that it is drawn "
             "with. --normal-map and --diffuse-map are stored in all of its materials, which "
             "otherwise stay as they are in the model file.")
        .group(group);
}

namespace {

/// The maps of --save-model must be what glTF prescribes.
void check_saved_maps(const ViewOptions& options) {
    const std::string option = "--save-model";
    refuse(options.height_map.has_value(), option, "glTF has no height maps",
           "convert it with relief-bake bump, or leave --height-map out");
    for (const auto& file : {options.normal_map, options.diffuse_map}) {
        if (file) check_image(option, *file);
    }
    if (!options.normal_map) return;
    refuse(options.normal_space && *options.normal_space != NormalSpace::tangent, option,
           "normals of glTF are in tangent space", "convert the map with relief-bake convert");
    const MapDescription stated = read_description(read_image_info(*options.normal_map).metadata);
    refuse(options.green.value_or(stated.green.value_or(Green::up)) == Green::down, option,
           "glTF has green up", "convert the map with relief-bake convert --flip green");
}

/// Stores the maps of the command line in the saved model.
void save_maps(const ViewOptions& options) {
    MaterialRequest request;
    request.input = request.output = *options.save_model;
    request.all_materials = true;
    request.normal_scale = options.normal_scale;
    // The kinds were checked for the scene. A direction of green that is given is up.
    request.assumed = options.assumed;
    if (options.green) request.assumed.push_back(MapKind::normal);
    std::vector<MaterialMap> maps;
    if (options.normal_map) maps.push_back({TextureSlot::normal, *options.normal_map});
    if (options.diffuse_map) maps.push_back({TextureSlot::base_color, *options.diffuse_map});
    if (maps.empty()) return;
    request.materials.push_back({std::nullopt, std::move(maps)});
    Stages unused(true);
    store_maps(request, unused);
}

}  // namespace

void check_save_options(const ViewOptions& options) {
    const auto check = [&](const std::optional<std::filesystem::path>& file,
                           const std::string& option, bool has_format, const char* formats) {
        if (!file) return;
        refuse(!has_format, option + " " + file->string(), "unsupported format", formats);
        require_folder_of(*file);
    };
    const auto extension = [](const auto& file) { return file ? extension_of(*file) : ""; };
    check(options.save_scene, "--save-scene", extension(options.save_scene) == ".json",
          "use .json");
    const std::string model = extension(options.save_model);
    check(options.save_model, "--save-model", model == ".glb" || model == ".gltf",
          "use .glb or .gltf");
    if (options.save_model) check_saved_maps(options);
}

void save_files(const ViewOptions& options, const ComposedScene& composed, Stages& stages) {
    const auto save = [&](const std::optional<std::filesystem::path>& file, const auto& work) {
        if (!file) return;
        stages.run("save", [&] { about(options.model, work); });
        if (!options.general.quiet && !options.json) print_entry("saved", file_and_size(*file));
    };
    save(options.save_scene, [&] {
        save_scene(*options.save_scene, {options.model, composed.scene(), composed.camera,
                                         options.size, scene_options(options)});
    });
    save(options.save_model, [&] {
        save_model(*options.save_model, options.model, scene_options(options));
        save_maps(options);
    });
}

void save_model(const std::filesystem::path& file, const std::filesystem::path& model,
                const SceneOptions& options) {
    if (extension_of(model) == ".json")
        throw InvalidInput("is a scene file and cannot be saved as a model");
    Report unused;  // These findings have already been reported.
    Model contents = read_model(model, unused);
    std::visit([&](auto& read) { frame(read, frame_options(model, options), unused); }, contents);
    if (is_z_up(model, options)) turn_y_up(contents);
    write_model(file, contents, model, true, unused);
}

}  // namespace relief::tools
