// SPDX-License-Identifier: Apache-2.0
// `relief-mesh subdivide IN OUT`: a finer, smoother surface. Tests: tests/tools/reshaping_test.cpp.
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "common/frame_choices.h"
#include "relief/mesh/subdivide.h"
#include "reshaping.h"

namespace relief::tools {
namespace {

struct SubdivideWords {
    ReshapeRequest request;
    int levels = 1;
};

ExitCode run(const CLI::App& app, const SubdivideWords& words) {
    const auto change = [&](const Mesh& mesh, std::size_t, Report& report) {
        return FramedMesh{
            subdivided(mesh, words.levels, {.normals = words.request.normals}, report), {}};
    };
    return reshape(
        app, words.request, change,
        {{"levels", words.levels}, {"normals", name_of(words.request.normals, normal_choices())}});
}

void add_options(CLI::App& app, SubdivideWords& words) {
    constexpr int most_levels = 12;
    add_reshape_options(app, words.request,
                        "Normals of the result: one per triangle (flat), or averaged as named. "
                        "Default, keep: by angle where the file has normals, none where it "
                        "has not; its own would not fit.");
    add_value(app, "--levels", "N", "How often, 1 to 12; triangles grow fourfold. Default: 1.",
              [&words](const std::string& subject, const std::string& text) {
                  words.levels = parse_integer(subject, text, 1, most_levels);
              })
        .group("Shape");
    set_examples(app, {"relief-mesh subdivide data/vase.obj out/vase-fine.glb",
                       "relief-mesh subdivide data/vase.obj out/vase-finer.ply --levels 2"});
}

}  // namespace

Command add_subdivide_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "subdivide",
                       "Makes a model finer and smoother, by Loop's scheme; its texture stays.");
    const auto words = std::make_shared<SubdivideWords>();
    add_options(app, *words);
    return {&app, [&app, words] { return run(app, *words); }};
}

}  // namespace relief::tools
