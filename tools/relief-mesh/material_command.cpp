// SPDX-License-Identifier: Apache-2.0
// `relief-mesh material IN OUT --normal MAP ...` stores maps in a material of a glTF file.
// Tests: tests/tools/material_test.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/file_jobs.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "common/text.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/model.h"

namespace relief::tools {
namespace {

using OptionalFile = std::optional<std::filesystem::path>;

struct MaterialCommand {
    std::filesystem::path input;
    std::filesystem::path output;
    OptionalFile base_color;
    OptionalFile metallic_roughness;
    OptionalFile normal;
    OptionalFile occlusion;
    OptionalFile emissive;
    std::optional<std::string> material;
    std::optional<double> scale;
    bool embed = false;
    bool external = false;
    bool no_tangents = false;
    ReportOptions report;
    GeneralOptions general;
};

/// A map of the command line.
struct RequestedMap {
    GltfTextureSlot slot;
    std::string name;
    std::filesystem::path file;
};

std::vector<RequestedMap> requested_maps(const MaterialCommand& command) {
    std::vector<RequestedMap> maps;
    const auto add = [&](GltfTextureSlot slot, const char* name, const OptionalFile& file) {
        if (file) maps.push_back({slot, name, *file});
    };
    add(GltfTextureSlot::base_color, "base color", command.base_color);
    add(GltfTextureSlot::metallic_roughness, "metallic-roughness", command.metallic_roughness);
    add(GltfTextureSlot::normal, "normal", command.normal);
    add(GltfTextureSlot::occlusion, "occlusion", command.occlusion);
    add(GltfTextureSlot::emissive, "emissive", command.emissive);
    return maps;
}

struct MaterialResult {
    std::string material;
    bool is_new = false;
    std::vector<RequestedMap> maps;
    std::vector<FramedPart> parts;  ///< That got tangents.
    Findings findings;
};

/// Returns the index of the material with a name, or of the only one. A model without materials
/// gets one.
std::size_t chosen_material(GltfDocument& document, const MaterialCommand& command,
                            MaterialResult& done) {
    const std::vector<GltfMaterial> materials = document.view().materials;
    std::vector<std::string> names;
    std::vector<std::size_t> fitting;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        names.push_back("'" + materials[i].name + "'");
        if (!command.material || materials[i].name == *command.material) fitting.push_back(i);
    }
    if (materials.empty()) {
        done.material = command.material.value_or("material");
        done.is_new = true;
        return document.add_material(done.material);
    }
    if (!command.material && fitting.size() > 1) {
        throw failure(command.input, fmt::format("has {} materials", materials.size()),
                      fmt::format("choose one with --material: {}", fmt::join(names, ", ")));
    }
    if (fitting.empty()) {
        throw failure(command.input, fmt::format("has no material '{}'", *command.material),
                      fmt::format("available: {}", fmt::join(names, ", ")));
    }
    if (fitting.size() > 1) {
        throw failure(command.input,
                      fmt::format("has {} materials '{}'", fitting.size(), *command.material),
                      "rename them first");
    }
    done.material = materials[fitting.front()].name;
    return fitting.front();
}

/// Returns whether the images become files beside OUT.
GltfImageStorage storage_of(const MaterialCommand& command) {
    const bool is_glb = writable_format(command.output) == ModelFormat::glb;
    if (command.embed || is_glb) return GltfImageStorage::embedded;
    return GltfImageStorage::external;
}

MaterialResult store_maps(const MaterialCommand& command, Stages& stages) {
    MaterialResult done;
    Report read_report;
    Model model = stages.run("read", [&] { return read_model(command.input, read_report); });
    if (const auto* contents = std::get_if<MeshFile>(&model))
        model =
            about(command.input, [&] { return GltfDocument::from_mesh(*contents, read_report); });
    done.findings.add("", read_report);
    auto& document = std::get<GltfDocument>(model);
    Report report;
    about(command.input, [&] {
        const std::size_t material = chosen_material(document, command, done);
        done.maps = requested_maps(command);
        for (const RequestedMap& map : done.maps) {
            read_image_info(map.file);  // A damaged image is an error here, not in a renderer.
            document.set_texture(material, map.slot, map.file, storage_of(command), report);
        }
        if (command.scale) document.set_normal_scale(material, *command.scale);
        if (command.normal && !command.no_tangents)
            done.parts = stages.run("tangents", [&] { return add_tangents(document, material); });
    });
    done.findings.add("", report);
    for (const FramedPart& part : done.parts)
        done.findings.add(part.name, part.report);
    Report write_report;
    stages.run("write",
               [&] { write_model(command.output, model, command.input, true, write_report); });
    done.findings.add("", write_report);
    return done;
}

Summary material_summary(const MaterialCommand& command, const MaterialResult& done,
                         const Stages& stages) {
    Summary summary;
    summary.add("material", fmt::format("'{}'{}", done.material, done.is_new ? ", new" : ""),
                {{"material", done.material}, {"is_new", done.is_new}});
    std::vector<std::string> lines;
    Json maps = Json::array();
    for (const RequestedMap& map : done.maps) {
        lines.push_back(fmt::format("{}: {}", map.name, map.file.string()));
        maps.push_back({{"map", map.name}, {"file", map.file.string()}});
    }
    summary.add("maps", lines, {{"maps", std::move(maps)}});
    if (command.normal) {
        std::size_t with_tangents = 0;
        for (const FramedPart& part : done.parts)
            with_tangents += part.tangents == AttributeOutcome::computed ? 1 : 0;
        summary.add("tangents",
                    with_tangents == 0 ? "unchanged"
                                       : fmt::format("mikktspace, added to {}",
                                                     counted(with_tangents, "primitive")),
                    {{"primitives_with_new_tangents", with_tangents}});
    }
    summary.add_findings(done.findings);
    summary.add_times(stages);
    summary.add("wrote", file_and_size(command.output));
    return summary;
}

ExitCode store(const CLI::App& app, const MaterialCommand& command) {
    readable_format(command.input);
    if (!is_document(writable_format(command.output))) {
        throw UsageError(fmt::format("{}: cannot store materials of glTF", command.output.string()),
                         "write a .glb or .gltf");
    }
    if (command.embed && command.external)
        throw UsageError("--embed and --external contradict each other", "give one of them");
    if (command.external && writable_format(command.output) == ModelFormat::glb)
        throw UsageError("--external: a .glb embeds its images", "write a .gltf");
    if (requested_maps(command).empty())
        throw UsageError("no map",
                         "give --normal, --base-color, --metallic-roughness, --occlusion or "
                         "--emissive");
    if (!command.normal) refuse_given(app, {"--scale", "--no-tangents"}, "--normal");
    check(command.report, {command.input, command.output});
    require_folder_of(command.output);
    set_thread_limit(command.general.threads);
    Stages stages(command.general.quiet);
    const MaterialResult done = store_maps(command, stages);
    const Summary summary = material_summary(command, done, stages);
    if (!command.general.quiet) summary.print();
    Json report = {{"tool", "relief-mesh " + command_name(app)},
                   {"version", version()},
                   {"input", command.input.string()},
                   {"output", command.output.string()}};
    report.update(summary.json());
    return finish(app, command.report, command.input, done.findings, report);
}

void add_material_options(CLI::App& app, MaterialCommand& command) {
    add_file(app, "IN", command.input, "Model to read: .glb .gltf .obj .ply .stl .off");
    add_file(app, "OUT", command.output, "Model to write: .glb .gltf. May be IN itself.");
    const std::string maps = "Maps, as PNG or JPEG; their bytes are kept";
    add_path(app, "--normal", command.normal,
             "Normal map in tangent space, green up. Primitives without tangents get those of "
             "MikkTSpace.")
        .group(maps);
    add_path(app, "--base-color", command.base_color, "Base color in sRGB, with alpha.")
        .group(maps);
    add_path(app, "--metallic-roughness", command.metallic_roughness,
             "Roughness in green and metalness in blue.")
        .group(maps);
    add_path(app, "--occlusion", command.occlusion,
             "Ambient occlusion in red. May be the same file as --metallic-roughness.")
        .group(maps);
    add_path(app, "--emissive", command.emissive,
             "Emitted light in sRGB. A material that emits no light gets the emissive factor 1.")
        .group(maps);
    const std::string place = "Where they are stored";
    add_value(app, "--material", "NAME",
              "The material. Required if IN has several; a model without materials gets one.",
              [&command](const std::string&, const std::string& text) { command.material = text; })
        .group(place);
    add_number(app, "--scale", "S", command.scale, {-100.0, 100.0, ""},
               "Factor of the x and y of the normal map. Default: that of IN, or 1.")
        .group(place);
    add_switch(app, "--embed", command.embed,
               "Store the images in the buffer of a .gltf, as a .glb always does.")
        .group(place);
    add_switch(app, "--external", command.external, "Copy the images beside a .gltf (default).")
        .group(place);
    add_switch(app, "--no-tangents", command.no_tangents, "Do not add tangents.").group(place);
    add_report_options(app, command.report);
    add_general_options(app, command.general);
    set_examples(app, {"relief-bake bump data/bricks-height.png out/bricks-n.png --strength 24",
                       "relief-mesh material data/vase.obj out/vase-bricks.glb --normal "
                       "out/bricks-n.png --base-color data/bricks-diffuse.png"});
}

}  // namespace

Command add_material_command(CLI::App& tool) {
    return add_command<MaterialCommand>(
        tool, "material", "Stores normal maps and other maps in a material of a glTF file.",
        add_material_options, store);
}

}  // namespace relief::tools
