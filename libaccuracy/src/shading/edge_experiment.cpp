// SPDX-License-Identifier: Apache-2.0
// Edges of bodies, by one sample a pixel, by multisampling, and by drawing more pixels than are
// wanted. Tests: tests/accuracy/shading_experiments_test.cpp.
#include <fmt/format.h>

#include "drawn/lit_scene.h"
#include "drawn/many_samples.h"
#include "drawn/picture_error.h"
#include "relief/mesh/shapes.h"
#include "shading/shading_plan.h"

namespace relief {
namespace {

Scene cube_and_ring() {
    Scene scene = lit_scene(make_torus(0.12F, 192, 48), glossy_plastic());
    Mesh cube = make_cube();
    for (glm::vec3& position : cube.positions)
        position *= 0.42F;
    scene.meshes.emplace_back(std::move(cube));
    scene.instances.push_back({1, glm::mat4(1.0F), "cube"});
    scene.camera->world_from_view = lit_scene(make_torus(0.2F), {}).camera->world_from_view;
    return scene;
}

std::vector<DrawnMethod> edge_methods() {
    const Scene scene = cube_and_ring();
    const auto averaged_by = [](const char* way, const char* samples) {
        return std::vector<std::pair<std::string, std::string>>{{"averaged", way},
                                                                {"samples a pixel", samples}};
    };
    return {{"1 sample", averaged_by("nothing", "1"), scene, 1, 1},
            {"MSAA, 4 samples", averaged_by("coverage", "4"), scene, 4, 1},
            {"2 x 2 pixels", averaged_by("pixels", "4"), scene, 1, 2},
            {"2 x 2 pixels, MSAA", averaged_by("coverage and pixels", "16"), scene, 4, 2},
            {"4 x 4 pixels", averaged_by("pixels", "16"), scene, 1, 4}};
}

}  // namespace

Experiment edge_experiment(const Drawing& drawing, const RunOptions& options) {
    const int size = options.is_quick ? 128 : 256;
    const int rays = options.is_quick ? 8 : 16;
    Experiment experiment{
        .id = "shading/edges",
        .question = "What do smooth edges cost?",
        .truth = fmt::format("the reference shader in double, mean of {} rays a pixel in linear "
                             "light; a test holds its coverage to the closed form of a disc",
                             rays * rays),
        .input = fmt::format("ring and cube before a dark background, {0} x {0} pixels", size),
        .error_unit = "FLIP",
        .item = "pixel",
        .items = static_cast<double>(size) * size};
    if (!drawing.is_possible_for(experiment)) return experiment;
    const std::vector<DrawnMethod> all = edge_methods();
    const Image truth = many_samples(all.front().scene, size, rays);
    const std::vector<DrawnPicture> pictures =
        measure_drawn(drawing, all, truth, options, experiment);
    for (const std::size_t i : {0U, 1U}) {
        experiment.pictures.push_back(pair_of("Edges", all[i].name, pictures[i].picture, truth));
        experiment.heat_maps.push_back({"Where it is seen", all[i].name, pictures[i].errors, 0.3});
    }
    const auto& found = experiment.measurements;
    experiment.finding = fmt::format(
        "Multisampling of 4 brings FLIP from {:.4f} (RMS) to {:.4f}; 4 pixels drawn for each bring "
        "it to {:.4f}, 16 to {:.4f}.",
        found[0].error.rms, found[1].error.rms, found[2].error.rms, found[4].error.rms);
    experiment.finding += frame_times({{"none", found[0]},
                                       {"multisampling of 4", found[1]},
                                       {"4 pixels", found[2]},
                                       {"16 pixels", found[4]}});
    return experiment;
}

}  // namespace relief
