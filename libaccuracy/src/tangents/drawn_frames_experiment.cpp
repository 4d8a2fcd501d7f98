// SPDX-License-Identifier: Apache-2.0
// A torus with a normal map, of few to many triangles, its frames stored or derived. Tests:
// tests/accuracy/drawn_frames_experiment_test.cpp.
#include "tangents/drawn_frames_experiment.h"

#include <fmt/format.h>

#include <array>

#include "drawn/lit_scene.h"
#include "drawn/many_samples.h"
#include "measured_methods.h"
#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/shapes.h"

namespace relief {
namespace {

/// Around the tube's circle; half as many around the tube.
constexpr std::array slices = {24, 96, 384};
constexpr int middle = 96;
constexpr int true_slices = 768;

struct Choice {
    const char* frames;
    TangentFrame frame;
    double stored_bytes;  ///< Of a vertex: normal, tangent and w, as floats; or the normal alone.
};
constexpr std::array choices = {Choice{"stored", TangentFrame::stored, 28.0},
                                Choice{"derived", TangentFrame::derivatives, 12.0}};

std::size_t triangles_of(int around) {
    return static_cast<std::size_t>(around) * static_cast<std::size_t>(around);
}

std::string name_of(const char* frames, int around) {
    return fmt::format("{}, {} triangles", frames, triangles_of(around));
}

/// Waves of no less than a quarter of the map: nothing that smaller levels of it would lose.
Image waves() {
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
Mesh torus(int around, TangentFrame frame) {
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
    Scene scene = bumpy_scene(torus(around, frame), material, waves());
    // The camera is that of the smooth one: coarse ones are a little smaller.
    scene.camera = lit_scene(make_torus(), {}).camera;
    return scene;
}

std::vector<DrawnMethod> methods() {
    std::vector<DrawnMethod> all;
    for (const Choice& choice : choices) {
        for (const int around : slices) {
            all.push_back({name_of(choice.frames, around),
                           {{"frames", choice.frames},
                            {"triangles", fmt::format("{}", triangles_of(around))}},
                           bumpy_torus(around, choice.frame),
                           1,
                           1,
                           choice.stored_bytes});
        }
    }
    DrawnMethod smooth{name_of("no normal map", middle),
                       {{"frames", "none"}, {"triangles", fmt::format("{}", triangles_of(middle))}},
                       bumpy_torus(middle, TangentFrame::derivatives),
                       1,
                       1,
                       12.0,
                       "What a frame takes before there is a map to read."};
    smooth.scene.materials.front().normal_map.reset();
    all.push_back(std::move(smooth));
    return all;
}

Chart chart_of(const Experiment& experiment) {
    Chart chart{.id = "triangles",
                .title = "Error by triangles",
                .x_label = "triangles",
                .y_label = "FLIP"};
    for (const Choice& choice : choices) {
        Curve curve{.method = choice.frames};
        for (const int around : slices) {
            curve.points.push_back(
                {static_cast<double>(triangles_of(around)),
                 method_in(experiment, name_of(choice.frames, around)).error.rms});
        }
        curve.order = fitted_order(curve.points);
        chart.curves.push_back(std::move(curve));
    }
    return chart;
}

std::string finding_of(const Experiment& experiment) {
    const auto at = [&](const char* frames, int around) -> const Measurement& {
        return method_in(experiment, name_of(frames, around));
    };
    return fmt::format(
        "With {} triangles pictures are off by FLIP {:.3f} (RMS) with stored frames and {:.3f} "
        "with "
        "derived ones, with {} by {:.3f} and {:.3f}; frames of {} triangles took {} and {}, and {} "
        "without a normal map.",
        triangles_of(slices[0]), at("stored", slices[0]).error.rms,
        at("derived", slices[0]).error.rms, triangles_of(slices[2]),
        at("stored", slices[2]).error.rms, at("derived", slices[2]).error.rms, triangles_of(middle),
        frame_words(at("stored", middle)), frame_words(at("derived", middle)),
        frame_words(at("no normal map", middle)));
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
            triangles_of(true_slices)),
        .input = fmt::format("torus with a normal map of waves, {0} x {0} pixels", size),
        .error_unit = "FLIP",
        .item = "pixel",
        .items = static_cast<double>(size) * size};
    if (!drawing.is_possible_for(experiment)) return experiment;
    const Image truth = many_samples(bumpy_torus(true_slices, TangentFrame::stored), size, 1);
    const std::vector<DrawnMethod> all = methods();
    const std::vector<DrawnPicture> pictures =
        measure_drawn(drawing, all, truth, options, experiment);
    experiment.charts = {chart_of(experiment)};
    for (std::size_t i = 0; i < all.size(); i += slices.size()) {
        experiment.pictures.push_back(
            pair_of("A normal map on few triangles", all[i].name, pictures[i].picture, truth));
        experiment.heat_maps.push_back({"Where it is seen", all[i].name, pictures[i].errors, 0.5});
    }
    mark_efficient(experiment);
    experiment.finding = finding_of(experiment);
    return experiment;
}

}  // namespace relief
