// SPDX-License-Identifier: Apache-2.0
// A torus with a normal map, of few to many triangles, its frames stored or derived. Tests:
// tests/accuracy/drawn_frames_experiment_test.cpp.
#include "tangents/drawn_frames_experiment.h"

#include <fmt/format.h>

#include <array>

#include "drawn/lit_scene.h"
#include "drawn/many_samples.h"
#include "drawn/refined_torus.h"
#include "measured_methods.h"
#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/shapes.h"

namespace relief {
namespace {

constexpr std::array drawn_slices = {24, 96, 384};
constexpr int middle_slices = 96;

struct FrameChoice {
    const char* frames;
    TangentFrame frame;
    double stored_bytes;  ///< Of a vertex: normal, tangent and w, as floats; or the normal alone.
};
constexpr std::array frame_choices = {FrameChoice{"stored", TangentFrame::stored, 28.0},
                                      FrameChoice{"derived", TangentFrame::derivatives, 12.0}};

/// Waves of no less than a quarter of the map: nothing that smaller levels of it would lose.
Image wavy_normals() {
    constexpr int side = 64;
    const AnalyticHeights field =
        wave_heights(side, side, tiling_waves(side, side, 12, side / 4.0, 0.5, 1));
    Report report;
    BumpOptions bump;
    bump.strength = 1.0;
    bump.wrap = Wrap::repeat;
    return normal_map_from_height(field.heights, bump, {.bits = 8}, report);
}

/// Repeated so that its texels are as wide as high where the tube is halfway out.
Mesh repeating_torus(int around, TangentFrame frame) {
    Mesh mesh = make_torus(0.4F, around, around / 2);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord *= glm::vec2(5.0F, 2.0F);
    if (frame == TangentFrame::derivatives) return mesh;
    Report report;
    return with_frames(std::move(mesh), {.tangents = TangentMode::mikktspace}, report).mesh;
}

Scene bumpy_torus(int around, TangentFrame frame) {
    Material material = glossy_plastic();
    material.tangent_frame = frame;
    Scene scene = bumpy_scene(repeating_torus(around, frame), material, wavy_normals());
    scene.camera = torus_camera();
    return scene;
}

std::vector<DrawnMethod> frame_methods() {
    std::vector<DrawnMethod> all;
    for (const FrameChoice& choice : frame_choices) {
        for (const int around : drawn_slices) {
            all.push_back({name_on_torus(choice.frames, around),
                           {{"frames", choice.frames},
                            {"triangles", fmt::format("{}", torus_triangles(around))}},
                           bumpy_torus(around, choice.frame),
                           1,
                           1,
                           choice.stored_bytes});
        }
    }
    DrawnMethod smooth{
        name_on_torus("no normal map", middle_slices),
        {{"frames", "none"}, {"triangles", fmt::format("{}", torus_triangles(middle_slices))}},
        bumpy_torus(middle_slices, TangentFrame::derivatives),
        1,
        1,
        12.0,
        "What a frame takes before there is a map to read."};
    smooth.scene.materials.front().normal_map.reset();
    all.push_back(std::move(smooth));
    return all;
}

std::string frames_finding(const Experiment& experiment) {
    const auto at = [&](const char* frames, int around) -> const Measurement& {
        return method_in(experiment, name_on_torus(frames, around));
    };
    return fmt::format(
               "With {} triangles pictures are off by FLIP {:.3f} (RMS) with stored frames and "
               "{:.3f} with derived ones, with {} by {:.3f} and {:.3f}.",
               torus_triangles(drawn_slices[0]), at("stored", drawn_slices[0]).error.rms,
               at("derived", drawn_slices[0]).error.rms, torus_triangles(drawn_slices[2]),
               at("stored", drawn_slices[2]).error.rms, at("derived", drawn_slices[2]).error.rms) +
           frame_times({{fmt::format("stored, {} triangles", torus_triangles(middle_slices)),
                         at("stored", middle_slices)},
                        {fmt::format("derived, {} triangles", torus_triangles(middle_slices)),
                         at("derived", middle_slices)},
                        {"no normal map", at("no normal map", middle_slices)}});
}

}  // namespace

Experiment drawn_frames_experiment(const Drawing& drawing, const RunOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    Experiment experiment{
        .id = "tangents/drawn",
        .subject = Subject::tangents,
        .question = "What do frames that shaders derive cost, where stored ones cost memory?",
        .truth = fmt::format(
            "the reference shader in double on a torus of {} triangles with MikkTSpace's tangents, "
            "one ray through the centre of each pixel; tests hold that shader to closed forms",
            torus_triangles(smooth_torus_slices)),
        .input = fmt::format("torus with a normal map of waves, {0} x {0} pixels", size),
        .error_unit = "FLIP",
        .item = "pixel",
        .items = static_cast<double>(size) * size};
    if (!drawing.is_possible_for(experiment)) return experiment;
    const Image truth =
        many_samples(bumpy_torus(smooth_torus_slices, TangentFrame::stored), size, 1);
    const std::vector<DrawnMethod> all = frame_methods();
    const std::vector<DrawnPicture> pictures =
        measure_drawn(drawing, all, truth, options, experiment);
    std::vector<std::string> ways;
    for (const FrameChoice& choice : frame_choices)
        ways.emplace_back(choice.frames);
    experiment.charts = {torus_chart(experiment, ways, drawn_slices)};
    for (std::size_t i = 0; i < all.size(); i += drawn_slices.size()) {
        experiment.pictures.push_back(
            pair_of("A normal map on few triangles", all[i].name, pictures[i].picture, truth));
        experiment.heat_maps.push_back({"Where it is seen", all[i].name, pictures[i].errors, 0.5});
    }
    mark_efficient(experiment);
    experiment.finding = frames_finding(experiment);
    return experiment;
}

}  // namespace relief
