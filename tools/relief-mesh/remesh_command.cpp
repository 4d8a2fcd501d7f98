// SPDX-License-Identifier: Apache-2.0
// `relief-mesh remesh IN OUT` replaces the triangles of a model by a closed manifold surface.
// Tests: tests/tools/repair_test.cpp.
#include "relief/mesh/remesh.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/options.h"
#include "common/summary.h"
#include "reshape.h"

namespace relief::tools {
namespace {

struct RemeshCommand {
    ReshapeRequest request;
    RemeshOptions options;
};

/// The angle above which an edge of the result is hard, if normals are computed.
constexpr double crease_degrees = 40.0;

ExitCode remesh_model(const CLI::App& app, const RemeshCommand& command) {
    const ModelChange change = [&](std::span<const TriangleInput> meshes, std::span<Report> reports,
                                   Report&) {
        std::vector<FramedMesh> results;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            Mesh mesh = remeshed(meshes[i].mesh, command.options, reports[i]);
            const NormalMode normals = command.request.normals;
            if (normals != NormalMode::keep) {
                FrameOptions frames;
                frames.normals = normals;
                if (normals != NormalMode::flat)
                    frames.crease_angle = crease_degrees * std::numbers::pi / 180.0;
                mesh = with_frames(std::move(mesh), frames, reports[i]).mesh;
            }
            results.push_back({std::move(mesh), {}});
        }
        return results;
    };
    return reshape(app, command.request, change, measuring_of(command.request),
                   {{"resolution", command.options.resolution},
                    {"shell", command.options.shell},
                    {"sign", enum_name(command.options.sign)},
                    {"normals", enum_name(command.request.normals)},
                    {"measure", name_of(measuring_of(command.request), measuring_words)}},
                   std::nullopt, true);
}

void add_remesh_options(CLI::App& app, RemeshCommand& command) {
    command.request.normals = NormalMode::automatic;
    add_reshape_options(app, command.request,
                        "Normals of the result: averaged with the named weights, with hard edges "
                        "above 40 degrees; one per triangle (flat); or none (keep). Default: "
                        "automatic.");
    const std::string shape = "Shape";
    add_value(app, "--resolution", "N",
              "The number of cells along the longest side of each mesh, 8 to 1024. Details below a "
              "cell are lost. Default: 128.",
              [&command](const std::string& subject, const std::string& text) {
                  command.options.resolution = parse_integer(subject, text, 8, 1024);
              })
        .group(shape);
    add_switch(app, "--shell", command.options.shell,
               "Everything within 0.75 cells of a triangle is solid, too: sheets become shells 1.5 "
               "cells thick, and solids grow by 0.75 cells. Default: only what triangles enclose "
               "is solid, and sheets vanish.")
        .group(shape);
    add_choice(app, "--sign", command.options.sign, enum_choices<RemeshSign>(),
               "What is solid: all that cannot be reached from outside (flood); or all with a "
               "winding number of at least a half, which closes holes of any size, but needs "
               "consistent orientation (relief-mesh repair) and takes ten times as long "
               "(winding). Default: flood.")
        .group(shape);
    add_choice(app, "--measure", command.request.measuring, measuring_words,
               "The distances between IN and OUT: at random samples (quick); also at all vertices "
               "and inside triangles, which takes several times as long (full); or none. Default: "
               "quick.")
        .group("Measuring");
    set_examples(app,
                 {"relief-mesh remesh data/vase.obj out/vase-solid.glb --resolution 96",
                  "relief-mesh remesh data/vase.obj out/vase-shell.obj --resolution 64 --shell "
                  "--measure full",
                  "relief-mesh remesh data/vase.obj out/vase-coarse.ply --resolution 24 "
                  "--normals flat --report out/vase-remesh.json",
                  "relief-mesh remesh data/vase.obj out/vase-closed.ply --resolution 48 --sign "
                  "winding"});
}

}  // namespace

Command add_remesh_command(CLI::App& tool) {
    return add_command<RemeshCommand>(
        tool, "remesh",
        "Replaces the triangles by a closed manifold surface around what they enclose.",
        add_remesh_options, remesh_model);
}

}  // namespace relief::tools
