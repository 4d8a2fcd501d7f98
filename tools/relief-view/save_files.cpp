// SPDX-License-Identifier: Apache-2.0
#include "save_files.h"

#include <algorithm>

#include "common/model_file.h"
#include "common/text.h"
#include "relief/mesh/error.h"
#include "relief/mesh/frames.h"
#include "relief/shade/scene_writer.h"

namespace relief::tools {
namespace {

/// glTF asks for flat normals where there are none, and then tangents do not count.
void frame(GltfDocument& document, Report& report) {
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const GltfTangentTexcoords texcoords = document.tangent_texcoords(id);
        Mesh mesh = document.mesh(id, texcoords.set);
        FrameOptions options;
        options.if_missing = NormalMode::flat;
        const bool has_normals = !mesh.normals.empty();
        const bool has_tangents = has_normals && !mesh.tangents.empty();
        if (!has_tangents) options.tangents = TangentMode::none;
        if (!has_tangents && !mesh.texcoords.empty() && texcoords.texture == "normalTexture")
            options.tangents = TangentMode::mikktspace;
        if (has_normals && !computes_tangents(options.tangents)) continue;
        const FramedMesh framed = with_frames(std::move(mesh), options, report);
        document.set_frames(id, framed, options, report);
    }
}

void frame(MeshFile& contents, Report& report) {
    const bool has_map =
        std::any_of(contents.materials.begin(), contents.materials.end(),
                    [](const MtlMaterial& material) { return material.normal_map.has_value(); });
    FrameOptions options;
    if (has_map && !contents.mesh.texcoords.empty()) options.tangents = TangentMode::mikktspace;
    contents.mesh = with_frames(std::move(contents.mesh), options, report).mesh;
}

}  // namespace

void add_save_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Output";
    add_path(app, "--save-scene", options.save_scene,
             "Scene file (.json) to write, which draws this picture: the model, and what the "
             "options change of its materials, lights, surroundings and camera.")
        .group(group);
    add_path(app, "--save-model", options.save_model,
             "Model to write as .glb or .gltf, with the normals and tangents that it is drawn "
             "with. Materials stay as they are in the model's file.")
        .group(group);
}

void check_save_options(const ViewOptions& options) {
    const auto check = [&](const std::optional<std::filesystem::path>& file,
                           const std::string& option, bool has_format, const char* formats) {
        if (!file) return;
        refuse(!has_format, option + " " + file->string(), "no format to write it in", formats);
        refuse(*file == options.model || file == options.output, option,
               "would overwrite the model or the picture", "");
        require_folder_of(*file);
    };
    const auto extension = [](const auto& file) { return file ? extension_of(*file) : ""; };
    check(options.save_scene, "--save-scene", extension(options.save_scene) == ".json",
          "use .json");
    const std::string model = extension(options.save_model);
    check(options.save_model, "--save-model", model == ".glb" || model == ".gltf",
          "use .glb or .gltf");
}

void save_files(const ViewOptions& options, const ComposedScene& composed, Stages& stages) {
    const auto save = [&](const std::optional<std::filesystem::path>& file, const auto& work) {
        if (!file) return;
        stages.run("save", [&] { about(options.model, work); });
        if (!options.general.quiet && !options.json) print_entry("saved", file_and_size(*file));
    };
    save(options.save_scene, [&] {
        save_scene(*options.save_scene,
                   {options.model, composed.scene(), composed.camera, options.size});
    });
    save(options.save_model, [&] { save_model(*options.save_model, options.model); });
}

void save_model(const std::filesystem::path& file, const std::filesystem::path& model) {
    if (extension_of(model) == ".json")
        throw InvalidInput("is a scene file, not a model that could be saved as one");
    Report told;  // Who shows the model has said it.
    Model contents = read_model(model, told);
    std::visit([&](auto& read) { frame(read, told); }, contents);
    write_model(file, contents, model, true, told);
}

}  // namespace relief::tools
