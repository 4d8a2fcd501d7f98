// SPDX-License-Identifier: Apache-2.0
// Measures tangent methods by the normal that a tilted texel stands for in each basis, compared
// with the frames of the surface in closed form.
#include <fmt/format.h>

#include <array>
#include <memory>

#include "experiment_driver.h"
#include "experiment_parts.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "rendered_methods.h"

namespace relief::accuracy::detail {
namespace {

constexpr std::array rendered_slices = {24, 96, 384};
constexpr int middle_slices = 96;

struct FrameChoice {
    const char* name;
    TangentFrame frame;
    double stored_bytes;  ///< Per vertex: normal, tangent and w as floats, or only the normal.
};
constexpr std::array frame_choices = {FrameChoice{"stored", TangentFrame::stored, 28.0},
                                      FrameChoice{"derived", TangentFrame::derivatives, 12.0}};

/// Waves of at least a quarter of the map, so that its smaller mip levels lose nothing.
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

/// Repeats the texture so that texels are square halfway between the inner and outer equator.
Mesh repeating_torus(int around, TangentFrame frame) {
    Mesh mesh = make_torus(0.4F, around, around / 2);
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord *= glm::vec2(5.0F, 2.0F);
    if (frame == TangentFrame::derivatives) return mesh;
    Report report;
    return with_frames(std::move(mesh), {.tangents = TangentMethod::mikktspace}, report).mesh;
}

shade::Scene bumpy_torus(int around, TangentFrame frame) {
    Material material = glossy_plastic();
    material.tangent_frame = frame;
    shade::Scene scene = bumpy_scene(repeating_torus(around, frame), material, wavy_normals());
    scene.camera = torus_camera();
    return scene;
}

std::vector<RenderedMethod> frame_methods() {
    std::vector<RenderedMethod> all;
    for (const FrameChoice& choice : frame_choices) {
        for (const int slices : rendered_slices) {
            all.push_back(method_on_torus("frames", choice.name, slices, [choice](int around) {
                return bumpy_torus(around, choice.frame);
            }));
            all.back().stored_bytes = choice.stored_bytes;
        }
    }
    RenderedMethod smooth =
        method_on_torus("frames", "no normal map", middle_slices, [](int around) {
            shade::Scene scene = bumpy_torus(around, TangentFrame::derivatives);
            scene.materials.front().normal_map.reset();
            return scene;
        });
    smooth.choices.front().second = "none";
    smooth.stored_bytes = 12.0;
    smooth.note = "The time of a frame without a normal map, for comparison.";
    all.push_back(std::move(smooth));
    return all;
}

/// Compares stored frames with frames that shaders derive; only in rendered images do derived
/// frames cost time.
PreparedExperiment rendered_frames_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    return prepare_rendering(
        options.device.get(),
        {.report =
             {.question = "Which tangent frames cost less in rendering: stored ones, or ones that "
                          "shaders derive?",
              .ground_truth = fmt::format(
                  "The reference shader in double on a torus of {} triangles with MikkTSpace's "
                  "tangents, one ray through the center of each pixel. Tests verify that shader by "
                  "closed forms.",
                  torus_triangles(smooth_torus_slices)),
              .input = fmt::format("torus with a normal map of waves, {0} x {0} pixels", size)},
         .size = size,
         .methods = frame_methods(),
         .ground_truth =
             [size] {
                 return supersampled_reference(
                     bumpy_torus(smooth_torus_slices, TangentFrame::stored), size, 1);
             },
         .compared = {"stored, 9216 triangles", "derived, 9216 triangles",
                      "no normal map, 9216 triangles"},
         .shown = {0, rendered_slices.size(), 2 * rendered_slices.size()},
         .title = "A normal map on few triangles",
         .finish =
             [](Experiment& report, const Renderings&) {
                 report.charts = {torus_chart(report, names_of(frame_choices), rendered_slices)};
             }});
}

constexpr int cells_of_tangent_tables = 64;  ///< The same number as in docs/tangents.md.
constexpr const char* ground_truth_text =
    "The exact frames of the textured surface in closed form. Tests verify them by numerical "
    "differentiation of the surface.";

/// All methods; the first one also with a shader that normalizes its vectors.
std::vector<FrameMethod> compared_tangent_methods() {
    std::vector<FrameMethod> methods = tangent_methods();
    methods.insert(methods.begin() + 1, made_unit(methods.front()));
    return methods;
}

/// The exact frames of the surface at its vertices.
Method exact_frames(const std::shared_ptr<const TexturedMesh>& ground_truth) {
    return {
        .name = "surface's own",
        .choices = {{"frames", "surface's own"}, {"shader", "as interpolated"}},
        .error =
            [ground_truth] { return texel_errors(*ground_truth, {exact_tangents(*ground_truth)}); },
        .stored_bytes = 28.0,
        .note =
            "Not a method: the exact frames at the vertices. The error that remains is "
            "that of interpolation."};
}

/// The expected exponent of the error over the number of cells. The error of a single triangle is
/// of first order. If the errors of opposite triangles cancel, the RMS is of second order.
/// Anisotropic cells have no expectation: the second-order error of the interpolation dominates at
/// these sizes.
std::optional<double> expected_order(const TexturedCase& one, const FrameMethod& method) {
    if (one.triangulation == Triangulation::anisotropic) return std::nullopt;
    return one.triangulation == Triangulation::regular && method.has_work ? -2.0 : -1.0;
}

/// The errors of all methods over a varying mesh.
Chart mesh_chart(Chart chart, const std::vector<double>& all_x,
                 const std::function<TexturedMesh(double x)>& mesh_at) {
    const std::vector<FrameMethod> methods = compared_tangent_methods();
    chart.y_label = "RMS error, degrees";
    return chart_over(
        std::move(chart), names_of(methods), all_x, mesh_at,
        [&](std::size_t i, const TexturedMesh& ground_truth) {
            return curve_error(texel_errors(ground_truth, methods[i].compute(ground_truth.mesh)));
        });
}

Chart cells_chart(const TexturedCase& one, bool is_quick) {
    std::vector<double> sizes = {16, 32, 64};
    if (!is_quick) sizes.push_back(128);
    Chart chart =
        mesh_chart({.id = "cells", .title = "Finer cells", .x_label = "cells along each parameter"},
                   sizes, [&](double cells) { return one.mesh(static_cast<int>(cells)); });
    const std::vector<FrameMethod> methods = compared_tangent_methods();
    for (std::size_t m = 0; m < methods.size(); ++m)
        fit(chart.curves[m], expected_order(one, methods[m]));
    return chart;
}

Chart bevels_chart() {
    return mesh_chart({.id = "bevels",
                       .title = "Wider bevels",
                       .x_label = "width of the bevels (half the width of the plate is 1)"},
                      {0.01, 0.02, 0.05, 0.1, 0.2, 0.5}, beveled_plate);
}

using relief::accuracy::detail::described;

Experiment described(const TexturedMesh& ground_truth) {
    return {.error_unit = "degrees",
            .item = "triangle",
            .items = static_cast<double>(ground_truth.mesh.triangles.size())};
}

/// All methods on a mesh. \param input  describes the mesh
PreparedExperiment on_mesh(TexturedMesh mesh, const std::string& input) {
    const auto ground_truth = std::make_shared<const TexturedMesh>(std::move(mesh));
    PreparedExperiment prepared;
    prepared.report = described(*ground_truth);
    prepared.report.ground_truth = ground_truth_text;
    prepared.report.input =
        fmt::format("{}: {} triangles", input, ground_truth->mesh.triangles.size());
    prepared.methods =
        methods_on(std::shared_ptr<const Mesh>(ground_truth, &ground_truth->mesh),
                   compared_tangent_methods(), [ground_truth](const FrameMethod& method) {
                       return texel_errors(*ground_truth, method.compute(ground_truth->mesh));
                   });
    prepared.methods.insert(prepared.methods.begin(), exact_frames(ground_truth));
    prepared.compared = names_of(tangent_methods());
    return prepared;
}

PreparedExperiment on_case(const TexturedCase& one, bool is_quick) {
    const std::string input = one.triangulation
                                  ? fmt::format("{}, {} x {} cells", one.name,
                                                cells_of_tangent_tables, cells_of_tangent_tables)
                                  : one.name;
    PreparedExperiment prepared = on_mesh(one.mesh(cells_of_tangent_tables), input);
    prepared.report.question = fmt::format(
        "What is the error of the normal of a texel tilted by 30 degrees, by frame method ({})?",
        one.name);
    prepared.costs.memory = false;
    prepared.finish = [one, is_quick](Experiment& report) {
        report.charts = {one.triangulation ? cells_chart(one, is_quick) : bevels_chart()};
    };
    return prepared;
}

PreparedExperiment tangents_on_large_mesh(bool is_quick) {
    const int cells = is_quick ? 128 : 400;
    PreparedExperiment prepared =
        on_mesh(textured_mesh(AnalyticSurface::torus, Triangulation::jittered,
                              TextureLayout::upright, cells, 1),
                fmt::format("torus, jittered, {} x {} cells", cells, cells));
    prepared.report.question = "How much time and memory do the tangents of a large mesh cost?";
    return prepared;
}

PreparedExperiment mismatches(bool is_quick) {
    const auto ground_truth = std::make_shared<const TexturedMesh>(
        textured_mesh(AnalyticSurface::torus, Triangulation::jittered, TextureLayout::upright,
                      is_quick ? 32 : cells_of_tangent_tables, 1));
    PreparedExperiment prepared;
    prepared.report = described(*ground_truth);
    prepared.report.question =
        "What is the error of a map that is baked in one basis and read in another?";
    prepared.report.ground_truth =
        "The normal that was baked. Reading it in the same basis restores it exactly.";
    prepared.report.input =
        fmt::format("normals tilted by 30 degrees on a jittered torus of {} triangles",
                    ground_truth->mesh.triangles.size());
    for (const FrameMethod& baker : compared_tangent_methods()) {
        for (const FrameMethod& reader : compared_tangent_methods()) {
            prepared.methods.push_back(
                {.name = fmt::format("baked in {}, read in {}", baker.name, reader.name),
                 .choices = {{"baked in", baker.name}, {"read in", reader.name}},
                 .error = [ground_truth, baker, reader] {
                     return mismatch_errors(*ground_truth, baker, reader);
                 }});
        }
    }
    return prepared;
}

}  // namespace

std::vector<PlannedExperiment> tangents_plan(const PlanOptions& options) {
    const bool is_quick = options.is_quick;
    std::vector<PlannedExperiment> plan;
    for (const TexturedCase& one : textured_cases()) {
        if (is_quick && !one.is_quick) continue;
        plan.push_back({"tangents/" + one.id, Subject::tangents, "Tangents: " + one.name,
                        [one, is_quick] { return on_case(one, is_quick); }});
    }
    plan.push_back({"tangents/large", Subject::tangents, "Tangents: a large mesh",
                    [is_quick] { return tangents_on_large_mesh(is_quick); }});
    plan.push_back({"tangents/mismatch", Subject::tangents, "Tangents: bases that differ",
                    [is_quick] { return mismatches(is_quick); }});
    plan.push_back({"tangents/drawn", Subject::tangents,
                    "Tangents: frames stored and derived, drawn",
                    [options] { return rendered_frames_experiment(options); }});
    return plan;
}

}  // namespace relief::accuracy::detail
