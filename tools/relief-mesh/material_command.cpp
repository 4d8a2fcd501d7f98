// SPDX-License-Identifier: Apache-2.0
// `relief-mesh material IN OUT --normal MAP ...` stores maps in a material of a glTF file.
// Tests: tests/tools/material_test.cpp.
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/file_jobs.h"
#include "common/material_maps.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "common/text.h"
#include "relief/mesh/execution.h"

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
    AssumedKinds assumed;
    ReportOptions report;
    GeneralOptions general;
};

MaterialRequest request_of(const MaterialCommand& command) {
    MaterialRequest request;
    request.input = command.input;
    request.output = command.output;
    request.embeds = command.embed;
    request.adds_tangents = !command.no_tangents;
    request.normal_scale = command.scale;
    request.assumed = command.assumed;
    request.materials.push_back({command.material, {}});
    const auto add = [&](TextureSlot slot, const OptionalFile& file) {
        if (file) request.materials.front().maps.push_back({slot, *file});
    };
    add(TextureSlot::base_color, command.base_color);
    add(TextureSlot::metallic_roughness, command.metallic_roughness);
    add(TextureSlot::normal, command.normal);
    add(TextureSlot::occlusion, command.occlusion);
    add(TextureSlot::emission, command.emissive);
    return request;
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
    const MaterialRequest request = request_of(command);
    if (request.materials.front().maps.empty())
        throw UsageError("no map",
                         "give --normal, --base-color, --metallic-roughness, --occlusion or "
                         "--emissive");
    if (!command.normal) refuse_given(app, {"--scale", "--no-tangents"}, "--normal");
    check(command.report, {command.input, command.output});
    require_folder_of(command.output);
    set_thread_limit(command.general.threads);
    Stages stages(command.general.quiet);
    const MaterialResult done = store_maps(request, stages);
    Summary summary = summary_of(done);
    summary.add_findings(done.findings);
    summary.add_times(stages);
    summary.add("wrote", file_and_size(command.output));
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
    add_assume_option(app, command.assumed,
                      {MapKind::normal, MapKind::color, MapKind::packed, MapKind::occlusion})
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
