// SPDX-License-Identifier: Apache-2.0
// Evaluates tangent bases at points inside triangles, as a fragment shader does, and measures
// tangent methods by the normal that a tilted texel stands for in each basis, compared with the
// frames of the surface in closed form.
#include "experiment_parts.h"

#include <fmt/format.h>

#include <array>
#include <memory>

#include "experiment_driver.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/tangents.h"
#include "rendered_methods.h"

namespace relief::accuracy::detail {
namespace {

template <typename Values>
auto interpolated(const Values& values, const glm::uvec3& corners, const glm::dvec3& weights) {
    using Value = std::decay_t<decltype(values[0])>;
    using Double = glm::vec<Value::length(), double>;
    return Double(values[corners.x]) * weights.x + Double(values[corners.y]) * weights.y +
           Double(values[corners.z]) * weights.z;
}

/// Implements shaders/tangent_frame.glsl#derivatives with two edges of the triangle instead of the
/// screen's axes. Any two directions in the plane of the triangle give the same result.
glm::dmat3 derived_basis(const Mesh& mesh, const glm::uvec3& corners, const glm::dvec3& normal) {
    const auto edge = [&](std::uint32_t to) {
        return glm::dvec3(mesh.positions[to]) - glm::dvec3(mesh.positions[corners.x]);
    };
    const auto step = [&](std::uint32_t to) {
        return glm::dvec2(mesh.texcoords[to]) - glm::dvec2(mesh.texcoords[corners.x]);
    };
    const glm::dvec3 right = edge(corners.y), up = edge(corners.z);
    const glm::dvec2 right_texture = step(corners.y), up_texture = step(corners.z);
    const double area = right_texture.x * up_texture.y - right_texture.y * up_texture.x;
    const double sign = area < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 n = glm::normalize(normal);
    const glm::dvec3 along_u = (right * up_texture.y - up * right_texture.y) * sign;
    const glm::dvec3 tangent = glm::normalize(along_u - n * glm::dot(n, along_u));
    const double turned = sign * (glm::dot(n, glm::cross(right, up)) < 0.0 ? -1.0 : 1.0);
    return {tangent, -turned * glm::cross(n, tangent), n};
}

glm::dmat3 matrix_of(const SurfaceFrame& frame) {
    return {frame.tangent, frame.handedness * glm::cross(frame.normal, frame.tangent),
            frame.normal};
}

}  // namespace

std::array<Sample, 4> samples_in(std::uint32_t triangle) {
    std::array<Sample, 4> samples;
    samples.fill({triangle, glm::dvec3(1.0 / 6.0)});
    samples[0].barycentric = glm::dvec3(1.0 / 3.0);
    for (std::size_t corner = 0; corner < 3; ++corner)
        samples.at(corner + 1).barycentric[static_cast<int>(corner)] = 2.0 / 3.0;
    return samples;
}

std::vector<Sample> samples_of(const TexturedMesh& ground_truth) {
    std::vector<Sample> samples;
    const auto count = static_cast<std::uint32_t>(ground_truth.mesh.triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::uvec3& corners = ground_truth.mesh.triangles[t];
        if (ground_truth.inner[corners.x] + ground_truth.inner[corners.y] +
                ground_truth.inner[corners.z] <
            3)
            continue;
        const std::array<Sample, 4> all = samples_in(t);
        samples.insert(samples.end(), all.begin(), all.end());
    }
    return samples;
}

glm::dmat3 basis_at(const Mesh& mesh, const TangentFrames& frames, const Sample& sample) {
    const glm::uvec3& corners = mesh.triangles[sample.triangle];
    glm::dvec3 normal = interpolated(mesh.normals, corners, sample.barycentric);
    if (frames.basis == ShaderBasis::derived) return derived_basis(mesh, corners, normal);
    const glm::uvec3 first = glm::uvec3(0, 1, 2) + 3 * sample.triangle;
    const glm::dvec4 stored = interpolated(frames.tangents, first, sample.barycentric);
    glm::dvec3 tangent(stored);
    if (frames.basis == ShaderBasis::made_unit) {
        normal = glm::normalize(normal);
        tangent = glm::normalize(tangent);
    }
    return {tangent, stored.w * glm::cross(normal, tangent), normal};
}

glm::dmat3 exact_basis_at(const TexturedMesh& ground_truth, const Sample& sample) {
    const glm::uvec3& corners = ground_truth.mesh.triangles[sample.triangle];
    return matrix_of(
        ground_truth.frame_at(interpolated(ground_truth.parameters, corners, sample.barycentric)));
}

CornerTangents exact_tangents(const TexturedMesh& ground_truth) {
    CornerTangents tangents;
    for (std::uint32_t t = 0; t < ground_truth.mesh.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            // Stay slightly inside the triangle: a mirrored texture has two frames at its edge.
            Sample sample{t, glm::dvec3(1e-9)};
            sample.barycentric[corner] = 1.0 - 2e-9;
            const glm::uvec3& corners = ground_truth.mesh.triangles[t];
            const SurfaceFrame frame = ground_truth.frame_at(
                interpolated(ground_truth.parameters, corners, sample.barycentric));
            tangents.emplace_back(glm::vec3(frame.tangent), static_cast<float>(frame.handedness));
        }
    }
    return tangents;
}

namespace {

using TangentFunction = decltype(&mikktspace_tangents);

FrameMethod stored(const char* name, TangentFunction function) {
    return {.name = name,
            .choices = {{"frames", name}, {"shader", "as interpolated"}},
            .compute =
                [function](const Mesh& mesh) {
                    Report report;
                    return TangentFrames{function(mesh.positions, mesh.normals, mesh.texcoords,
                                                  mesh.triangles, report)};
                },
            .stored_bytes = 28.0};  // Normal, tangent and w as floats.
}

}  // namespace

std::vector<FrameMethod> tangent_methods() {
    return {stored("mikktspace", mikktspace_tangents),
            stored("area-weighted", area_weighted_tangents),
            stored("lengyel", lengyel_tangents),
            {.name = "screen-space",
             .choices = {{"frames", "screen-space"}, {"shader", "derived"}},
             .compute =
                 [](const Mesh&) {
                     return TangentFrames{{}, ShaderBasis::derived};
                 },
             .has_work = false,
             .stored_bytes = 12.0,  // The normal.
             .note = "No work for the mesh: shaders derive the frame of each pixel. tangents/drawn "
                     "measures the time of that."}};
}

FrameMethod made_unit(const FrameMethod& method) {
    FrameMethod unit = method;
    unit.name += ", made unit";
    unit.choices.back().second = "made unit";
    unit.compute = [compute = method.compute](const Mesh& mesh) {
        return TangentFrames{compute(mesh).tangents, ShaderBasis::made_unit};
    };
    return unit;
}

void add_texel_angles(std::vector<float>& degrees, const glm::dmat3& actual,
                      const glm::dmat3& expected) {
    for (const glm::dvec3& texel : tilted_texels)
        degrees.push_back(angle_of(actual * texel, expected * texel));
}

ErrorStats texel_errors(const TexturedMesh& ground_truth, const TangentFrames& frames) {
    std::vector<float> degrees;
    for (const Sample& sample : samples_of(ground_truth)) {
        add_texel_angles(degrees, basis_at(ground_truth.mesh, frames, sample),
                         exact_basis_at(ground_truth, sample));
    }
    return error_stats(std::move(degrees));
}

ErrorStats inner_tangent_errors(const TexturedMesh& ground_truth, const TangentFrames& frames) {
    std::vector<float> degrees;
    for (const Sample& sample : samples_of(ground_truth)) {
        degrees.push_back(angle_of(basis_at(ground_truth.mesh, frames, sample)[0],
                                   exact_basis_at(ground_truth, sample)[0]));
    }
    return error_stats(std::move(degrees));
}

std::vector<float> corner_tangent_angles(const TexturedMesh& ground_truth,
                                         const CornerTangents& tangents) {
    const CornerTangents expected = exact_tangents(ground_truth);
    std::vector<float> degrees;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::uint32_t vertex =
            ground_truth.mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        if (ground_truth.inner[vertex] == 0) continue;
        degrees.push_back(angle_of(glm::dvec3(tangents[corner]), glm::dvec3(expected[corner])));
    }
    return degrees;
}

ErrorStats mismatch_errors(const TexturedMesh& ground_truth, const FrameMethod& baker,
                           const FrameMethod& reader) {
    const TangentFrames baked = baker.compute(ground_truth.mesh);
    const TangentFrames read = reader.compute(ground_truth.mesh);
    std::vector<float> degrees;
    for (const Sample& sample : samples_of(ground_truth)) {
        const glm::dmat3 expected = exact_basis_at(ground_truth, sample);
        const glm::dmat3 to_texel = glm::inverse(basis_at(ground_truth.mesh, baked, sample));
        const glm::dmat3 from_texel = basis_at(ground_truth.mesh, read, sample);
        for (const glm::dvec3& tilt : tilted_texels) {
            const glm::dvec3 normal = expected * tilt;
            degrees.push_back(angle_of(from_texel * glm::normalize(to_texel * normal), normal));
        }
    }
    return error_stats(std::move(degrees));
}

namespace {

TexturedCase case_of(AnalyticSurface surface, Triangulation triangulation, TextureLayout layout) {
    constexpr std::uint32_t seed = 1;
    TexturedCase one;
    one.id = name_of(surface) + "-" + name_of(triangulation);
    one.name = name_of(surface) + ", " + name_of(triangulation);
    one.triangulation = triangulation;
    if (layout == TextureLayout::upright) {
        one.is_quick = triangulation == Triangulation::anisotropic
                           ? surface == AnalyticSurface::cubic
                           : surface == AnalyticSurface::torus;
    } else {
        const std::string word = layout == TextureLayout::sheared ? "sheared" : "mirrored";
        one.id += "-" + word;
        one.name += ", image " + word;
        one.is_quick = layout == TextureLayout::mirrored;
    }
    one.mesh = [=](int cells) {
        return textured_mesh(surface, triangulation, layout, cells, seed);
    };
    return one;
}

}  // namespace

std::vector<TexturedCase> textured_cases() {
    std::vector<TexturedCase> cases;
    for (const Triangulation triangulation :
         {Triangulation::regular, Triangulation::jittered, Triangulation::anisotropic}) {
        for (const AnalyticSurface surface : all_surfaces)
            cases.push_back(case_of(surface, triangulation, TextureLayout::upright));
    }
    for (const TextureLayout layout : {TextureLayout::sheared, TextureLayout::mirrored})
        cases.push_back(case_of(AnalyticSurface::torus, Triangulation::jittered, layout));
    cases.push_back({.id = "plate",
                     .name = "plate with thin bevels and a sheared image on them",
                     .is_quick = true,
                     .mesh = [](int) { return beveled_plate(0.02); }});
    return cases;
}

namespace {

/// Waves of at least a quarter of the map, so that its smaller mip levels lose nothing.
Image wavy_normals() {
    constexpr int side = 64;
    BumpField field = wave_heights(side, side, tiling_waves(side, side, 12, side / 4.0, 0.5, 1));
    field.options.wrap = Wrap::repeat;
    Report report;
    return normal_map_from_height(field.heights, field.options, {.bits = 8}, report);
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

/// Compares stored frames with frames that shaders derive; only in rendered images do derived
/// frames cost time.
PreparedExperiment rendered_frames_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    const auto torus = [](TangentFrame frame) {
        return [frame](int around) { return bumpy_torus(around, frame); };
    };
    constexpr double normal = 12.0;  // Bytes of a vertex, as floats.
    RenderedExperiment experiment = on_tori(
        {.question = "Which tangent frames cost less in rendering: stored ones, or ones that "
                     "shaders derive?",
         .ground_truth = fmt::format(
             "The reference shader in double on a torus of {} triangles with MikkTSpace's "
             "tangents, one ray through the center of each pixel. Tests verify that shader by "
             "closed forms.",
             torus_triangles(smooth_torus_slices)),
         .input = fmt::format("torus with a normal map of waves, {0} x {0} pixels", size)},
        "frames",
        {{"stored", torus(TangentFrame::stored), normal + 16.0},
         {"derived", torus(TangentFrame::derivatives), normal}},
        {24, 96, 384}, torus(TangentFrame::stored), size);
    const auto without_map = [](int around) {
        shade::Scene scene = bumpy_torus(around, TangentFrame::derivatives);
        scene.materials.front().normal_map.reset();
        return scene;
    };
    RenderedMethod& smooth = experiment.methods.emplace_back(
        method_on_torus("frames", {"no normal map", without_map, normal}, 96));
    smooth.choices.front().second = "none";
    smooth.note = "The time of a frame without a normal map, for comparison.";
    experiment.compared = {"stored, 9216 triangles", "derived, 9216 triangles",
                           "no normal map, 9216 triangles"};
    experiment.shown = {0, 3, 6};
    experiment.title = "A normal map on few triangles";
    return prepare_rendering(options.device.get(), std::move(experiment));
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

PreparedExperiment on_case(const TexturedCase& one, const PlanOptions& options) {
    const std::string input = one.triangulation
                                  ? fmt::format("{}, {} x {} cells", one.name,
                                                cells_of_tangent_tables, cells_of_tangent_tables)
                                  : one.name;
    PreparedExperiment prepared = on_mesh(one.mesh(cells_of_tangent_tables), input);
    prepared.report.question = fmt::format(
        "What is the error of the normal of a texel tilted by 30 degrees, by frame method ({})?",
        one.name);
    prepared.costs.memory = false;
    prepared.finish = [one, is_quick = options.is_quick](Experiment& report) {
        report.charts = {one.triangulation ? cells_chart(one, is_quick) : bevels_chart()};
    };
    return prepared;
}

PreparedExperiment tangents_on_large_mesh(const PlanOptions& options) {
    const int cells = options.is_quick ? 128 : 400;
    PreparedExperiment prepared =
        on_mesh(textured_mesh(AnalyticSurface::torus, Triangulation::jittered,
                              TextureLayout::upright, cells, 1),
                fmt::format("torus, jittered, {} x {} cells", cells, cells));
    prepared.report.question = "How much time and memory do the tangents of a large mesh cost?";
    return prepared;
}

PreparedExperiment mismatches(const PlanOptions& options) {
    const auto ground_truth = std::make_shared<const TexturedMesh>(
        textured_mesh(AnalyticSurface::torus, Triangulation::jittered, TextureLayout::upright,
                      options.is_quick ? 32 : cells_of_tangent_tables, 1));
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
    std::vector<PlannedExperiment> plan;
    for (const TexturedCase& one : textured_cases()) {
        if (options.is_quick && !one.is_quick) continue;
        plan.push_back({"tangents/" + one.id, "Tangents: " + one.name,
                        [one](const PlanOptions& all) { return on_case(one, all); }});
    }
    plan.push_back({"tangents/large", "Tangents: a large mesh", tangents_on_large_mesh});
    plan.push_back({"tangents/mismatch", "Tangents: bases that differ", mismatches});
    plan.push_back({"tangents/drawn", "Tangents: frames stored and derived, drawn",
                    rendered_frames_experiment});
    return plan;
}

}  // namespace relief::accuracy::detail
