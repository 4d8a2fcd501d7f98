// SPDX-License-Identifier: Apache-2.0
// Measures normals, tangents and bump maps while their input grows or shrinks by powers of ten. The
// ground truth stays known in closed form. Textbook code without guards is measured for contrast.
#include "experiment_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <type_traits>

#include "experiment_driver.h"
#include "relief/mesh/statistics.h"

namespace relief::accuracy::detail {
namespace {

/// A larger RMS error than this is a failure.
constexpr double broken_degrees = 1.0;

/// Lists the methods that fail from each value on.
std::string breaks_of(const Chart& chart) {
    std::map<double, std::vector<std::string>> broken;
    for (const Curve& curve : chart.curves) {
        if (curve.breaks_at) broken[*curve.breaks_at].push_back(curve.method);
    }
    std::string text = fmt::format("{} ({}): ", chart.title, chart.x_label);
    if (broken.empty()) return text + "all are within the limit";
    std::size_t count = 0;
    for (const auto& [value, methods] : broken) {
        count += methods.size();
        const bool is_many = methods.size() > 4;
        text += is_many ? fmt::format("{} methods", methods.size())
                        : fmt::format("{}", fmt::join(methods, " and "));
        // Small values are counts, which are not written as powers of ten.
        const std::string where =
            value < 1e4 ? fmt::format("{:g}", value) : fmt::format("{:.0e}", value);
        text += fmt::format(" fail{} from {} on, ", methods.size() == 1 ? "s" : "", where);
    }
    if (count == chart.curves.size()) return text + "none is within the limit everywhere";
    return text + "all others are within the limit";
}

}  // namespace

SweptErrors measured_sweeps(const std::vector<std::string>& methods, double bound,
                            const std::vector<Sweep>& sweeps) {
    std::vector<std::vector<float>> all(methods.size());
    SweptErrors result;
    for (const Sweep& sweep : sweeps) {
        std::vector<double> values;
        for (int decade = 0; decade <= sweep.decades; decade += sweep.step)
            values.push_back(std::pow(10.0, decade));
        Chart& chart = result.charts.emplace_back(chart_over(
            {.id = sweep.id,
             .title = sweep.title,
             .x_label = sweep.x_label,
             .y_label = "RMS error, degrees",
             .bound = bound},
            methods, values, [](double value) { return value; },
            [&](std::size_t method, double value) {
                const std::vector<float> degrees = sweep.errors(method, value);
                all[method].insert(all[method].end(), degrees.begin(), degrees.end());
                return curve_error(error_stats(degrees));
            }));
        for (Curve& curve : chart.curves) {
            const auto broken = std::ranges::find_if(
                curve.points, [&](const CurvePoint& point) { return !(point.error <= bound); });
            if (broken != curve.points.end()) curve.breaks_at = broken->x;
        }
        result.breaks += (result.breaks.empty() ? "" : ". ") + breaks_of(chart);
    }
    result.breaks += ".";
    for (std::vector<float>& degrees : all)
        result.errors.push_back(error_stats(std::move(degrees)));
    return result;
}

namespace {

/// Methods, and the input that sweeps change.
template <typename Truth, typename Input, typename Result>
struct Swept {
    Truth ground_truth;
    std::vector<MethodOn<Input, Result>> methods;
    const Input& (*input)(const Truth& ground_truth);
    /// The errors of the result on a changed input.
    std::vector<float> (*degrees)(const Result& result, const Truth& changed);
    const char* item;
    double items = 0.0;
};
template <typename Truth>
const Mesh& mesh_of(const Truth& ground_truth) {
    return ground_truth.mesh;
}

/// A sweep without its errors, and the effect of its quantity on an input.
template <typename Truth>
struct Growth {
    Sweep sweep;
    std::function<Truth(Truth unchanged, double value)> changed;
};
template <typename Truth>
using Growths = std::vector<Growth<std::type_identity_t<Truth>>>;

/// An experiment whose methods have their errors in all sweeps and their time on one thread. Its
/// finding gives the values at which methods fail.
///
/// \param report  the input is completed with `unchanged`, the value at which methods are timed
/// \param advice  a sentence for the finding, after a space
template <typename Truth, typename Input, typename Result>
PreparedExperiment swept_experiment(Experiment report, const std::string& unchanged,
                                    const std::shared_ptr<const Swept<Truth, Input, Result>>& swept,
                                    const Growths<Truth>& growths, const std::string& advice = {}) {
    std::vector<Sweep> sweeps;
    for (const Growth<Truth>& one : growths) {
        sweeps.push_back(one.sweep);
        sweeps.back().errors = [swept, changed = one.changed](std::size_t method, double value) {
            const Truth truth = changed(swept->ground_truth, value);
            return swept->degrees(swept->methods[method].compute(swept->input(truth)), truth);
        };
    }
    std::vector<MethodOn<Input, Result>> functions = swept->methods;
    for (MethodOn<Input, Result>& one : functions) {
        one.choices.emplace_back("guarded", one.is_textbook ? "no" : "yes");
        if (one.is_textbook)
            one.note = "Textbook code without guards, which is not part of relief, for contrast.";
    }
    PreparedExperiment prepared;
    prepared.report = std::move(report);
    prepared.report.input +=
        fmt::format("; the errors are those of all together, the times those {}", unchanged);
    prepared.report.error_unit = "degrees";
    prepared.report.item = swept->item;
    prepared.report.items = swept->items;
    prepared.costs = {.all_threads = false, .memory = false};
    prepared.methods =
        methods_on(std::shared_ptr<const Input>(swept, &swept->input(swept->ground_truth)),
                   functions, [](const auto&) { return ErrorStats(); });
    const SharedInput<SweptErrors> measured([names = names_of(functions), sweeps] {
        return std::make_shared<const SweptErrors>(measured_sweeps(names, broken_degrees, sweeps));
    });
    for (std::size_t i = 0; i < functions.size(); ++i)
        prepared.methods[i].error = [measured, i] { return measured.get()->errors[i]; };
    prepared.finish = [measured, advice](Experiment& finished) {
        finished.charts = measured.get()->charts;
        finished.finding = fmt::format(
            "A method fails where its RMS error exceeds {} degree. {}{} docs/hard-cases.md lists "
            "single hard inputs and their outcomes.",
            broken_degrees, measured.get()->breaks, advice);
    };
    return prepared;
}

// Changes

/// Scales and moves positions or texture coordinates in double, then rounds them to float, as a
/// file would.
struct Change {
    double scale = 1.0;
    double offset = 0.0;

    template <typename Vector>
    void apply(std::vector<Vector>& values) const {
        for (Vector& value : values) {
            for (glm::length_t i = 0; i < Vector::length(); ++i)
                value[i] = static_cast<float>(static_cast<double>(value[i]) * scale + offset);
        }
    }
};

Change smaller(double value) {
    return {.scale = 1.0 / value};
}
Change larger(double value) {
    return {.scale = value};
}
Change farther(double value) {
    return {.offset = value};
}

/// Changes the positions or texture coordinates of a mesh.
template <typename Truth, typename Vector>
auto changing(std::vector<Vector> Mesh::*values, Change (*change)(double value)) {
    return [=](Truth truth, double value) {
        change(value).apply(truth.mesh.*values);
        return truth;
    };
}

// Normals

constexpr const char* torus_ground_truth =
    "The exact normals of the torus in closed form, which do not depend on scale and position. "
    "Tests verify them by numerical differentiation of the surface.";
constexpr std::uint32_t torus_seed = 1;
constexpr std::uint32_t needles_seed = 1;

int torus_cells(const PlanOptions& options) {
    return options.is_quick ? 32 : 64;
}

NormalMethod textbook_normals(const std::string& name,
                              std::vector<glm::vec3> (*normals)(const Mesh&)) {
    return {name + ", float32", {{"weighting", name}, {"arithmetic", "float32"}}, normals, true};
}

/// The errors of the first normals, which have a ground truth.
std::vector<float> normal_degrees(const std::vector<glm::vec3>& normals,
                                  const AnalyticMesh& ground_truth) {
    std::vector<float> degrees;
    for (std::size_t v = 0; v < ground_truth.normals.size(); ++v)
        degrees.push_back(angle_of(glm::dvec3(normals[v]), ground_truth.normals[v]));
    return degrees;
}

/// The methods of the library in both arithmetics, and textbook code, on a mesh.
auto swept_normals(AnalyticMesh mesh) {
    std::vector<NormalMethod> methods = normal_methods(both_arithmetics);
    methods.push_back(textbook_normals("plain area", textbook_area_normals));
    methods.push_back(textbook_normals("plain angle", textbook_angle_normals));
    const auto triangles = static_cast<double>(mesh.mesh.triangles.size());
    using SweptNormals = Swept<AnalyticMesh, Mesh, std::vector<glm::vec3>>;
    return std::make_shared<const SweptNormals>(SweptNormals{std::move(mesh), std::move(methods),
                                                             mesh_of<AnalyticMesh>, normal_degrees,
                                                             "triangle", triangles});
}

auto swept_torus(const PlanOptions& options) {
    return swept_normals(analytic_mesh(AnalyticSurface::torus, Triangulation::regular,
                                       torus_cells(options), torus_seed));
}

PreparedExperiment normals_by_scale(const PlanOptions& options) {
    const auto torus = swept_torus(options);
    return swept_experiment(
        {.question = "At which scales of a mesh are its normals accurate?",
         .ground_truth = torus_ground_truth,
         .input =
             fmt::format("torus of {} triangles at 31 scales from 1e-30 to 1e30", torus->items)},
        "at scale 1", torus,
        {{{"smaller", "Smaller", "times smaller than radius 1", 30, 2},
          changing<AnalyticMesh>(&Mesh::positions, smaller)},
         {{"larger", "Larger", "times larger than radius 1", 30, 2},
          changing<AnalyticMesh>(&Mesh::positions, larger)}});
}

PreparedExperiment normals_by_offset(const PlanOptions& options) {
    const auto torus = swept_torus(options);
    return swept_experiment(
        {.question = "At which distances of a mesh from the origin are its normals accurate?",
         .ground_truth = torus_ground_truth,
         .input = fmt::format("torus of {} triangles at 9 distances from 1 to 1e8", torus->items)},
        "at the origin", torus,
        {{{"offset", "Farther away", "distance along each axis, in radii of the torus", 8, 1},
          changing<AnalyticMesh>(&Mesh::positions, farther)}},
        " float64 is exact for the given positions: its error is that of rounding the positions to "
        "float, which no method can undo. Move meshes to the origin before storing them.");
}

PreparedExperiment normals_of_needles(const PlanOptions& options) {
    const std::size_t count = options.is_quick ? 1000 : 4000;
    const auto by_width = [count](const AnalyticMesh&, double value) {
        return make_needles(count, 1.0 / value, needles_seed);
    };
    return swept_experiment(
        {.question = "At which widths of a triangle is its normal accurate?",
         .ground_truth =
             "The cross product of the float corners in double; two of them are so near to the "
             "origin that nothing cancels. A test verifies it in integers.",
         .input = fmt::format("{} single triangles at 13 widths from 1 to 1e-12 of their length",
                              count)},
        "at width 1", swept_normals(make_needles(count, 1.0, needles_seed)),
        {{{"width", "Narrower", "length over width", 12, 1}, by_width}});
}

PreparedExperiment normals_beside_hard_triangles(const PlanOptions& options) {
    const auto torus = swept_torus(options);
    Growths<AnalyticMesh> growths;
    for (const HardTriangleName& one : hard_triangle_names) {
        growths.push_back({{one.id, one.title, "number of hard triangles", 3, 1},
                           [kind = one.kind](AnalyticMesh mesh, double count) {
                               mesh.mesh = with_hard_triangles(mesh.mesh, kind,
                                                               static_cast<std::size_t>(count));
                               return mesh;
                           }});
    }
    return swept_experiment(
        {.question = "With how many triangles of the hard-case catalogue are the normals around "
                     "them accurate?",
         .ground_truth =
             fmt::format("{} The added triangles have no area, no position or two sides, and are "
                         "therefore not part of the surface.",
                         torus_ground_truth),
         .input = fmt::format("torus of {} triangles with 1 to 1000 added hard triangles of five "
                              "kinds",
                              torus->items)},
        "without them", torus, growths);
}

// Tangents

constexpr const char* textured_torus_ground_truth =
    "The exact tangents of the textured torus in closed form, which do not depend on scale and "
    "position. Tests verify them by numerical differentiation of the surface.";

/// The methods with stored tangents and textbook code, on a textured torus.
auto textured_torus(const PlanOptions& options) {
    std::vector<FrameMethod> methods;
    for (FrameMethod& method : tangent_methods()) {
        method.choices = {{"frames", method.name}};
        method.stored_bytes = 0.0;
        if (method.has_work) methods.push_back(std::move(method));
    }
    methods.push_back({"plain",
                       {{"frames", "plain"}},
                       [](const Mesh& mesh) { return TangentFrames{textbook_tangents(mesh)}; },
                       true});
    TexturedMesh torus = textured_mesh(AnalyticSurface::torus, Triangulation::regular,
                                       TextureLayout::upright, torus_cells(options), 1);
    const auto triangles = static_cast<double>(torus.mesh.triangles.size());
    using SweptTangents = Swept<TexturedMesh, Mesh, TangentFrames>;
    return std::make_shared<const SweptTangents>(
        SweptTangents{std::move(torus), std::move(methods), mesh_of<TexturedMesh>,
                      [](const TangentFrames& frames, const TexturedMesh& changed) {
                          return corner_tangent_angles(changed, frames.tangents);
                      },
                      "triangle", triangles});
}

PreparedExperiment tangents_by_scale(const PlanOptions& options) {
    const auto torus = textured_torus(options);
    return swept_experiment(
        {.question = "At which scales of a mesh and its texture coordinates are tangents accurate?",
         .ground_truth = textured_torus_ground_truth,
         .input = fmt::format("torus of {} triangles, its positions and its texture coordinates at "
                              "31 scales each from 1e-30 to 1e30",
                              torus->items)},
        "at scale 1", torus,
        {{{"smaller", "Smaller meshes", "times smaller than radius 1", 30, 2},
          changing<TexturedMesh>(&Mesh::positions, smaller)},
         {{"larger", "Larger meshes", "times larger than radius 1", 30, 2},
          changing<TexturedMesh>(&Mesh::positions, larger)},
         {{"smaller-image", "Smaller texture coordinates", "times smaller than one image", 30, 2},
          changing<TexturedMesh>(&Mesh::texcoords, smaller)},
         {{"larger-image", "Larger texture coordinates", "times larger than one image", 30, 2},
          changing<TexturedMesh>(&Mesh::texcoords, larger)}});
}

PreparedExperiment tangents_by_offset(const PlanOptions& options) {
    const auto torus = textured_torus(options);
    return swept_experiment(
        {.question = "At which distances of a mesh and its texture coordinates from the origin are "
                     "tangents accurate?",
         .ground_truth = textured_torus_ground_truth,
         .input = fmt::format("torus of {} triangles, its positions and its texture coordinates at "
                              "9 distances each from 1 to 1e8",
                              torus->items)},
        "at the origin", torus,
        {{{"offset", "Meshes farther away", "distance along each axis, in radii", 8, 1},
          changing<TexturedMesh>(&Mesh::positions, farther)},
         {{"offset-image", "Texture coordinates farther away",
           "distance along each axis, in images", 8, 1},
          changing<TexturedMesh>(&Mesh::texcoords, farther)}});
}

// Height maps

constexpr double swept_wavelength = 32.0;

int map_side(const PlanOptions& options) {
    return (options.is_quick ? 64 : 192) + 2 * wave_margin;
}

/// Two kernels in both arithmetics and textbook code, on a wave.
auto swept_wave(const PlanOptions& options) {
    using SweptSlopes = Swept<BumpField, BumpField, Image>;
    SweptSlopes swept{oblique_wave(map_side(options), swept_wavelength, 32),
                      {},
                      [](const BumpField& wave) -> const BumpField& { return wave; },
                      [](const Image& normals, const BumpField& wave) {
                          return inner_angles(normals, wave.normals, wave_margin);
                      },
                      "texel"};
    swept.items = static_cast<double>(swept.ground_truth.normals.size());
    for (const Kernel kernel : {Kernel::sobel3, Kernel::central7}) {
        for (const Arithmetic arithmetic : both_arithmetics) {
            const std::string name = name_of(kernel, 0);
            swept.methods.push_back(
                {fmt::format("{}, {}", name, enum_name(arithmetic)),
                 {{"kernel", name}, {"arithmetic", enum_name(arithmetic)}},
                 [=](const BumpField& wave) {
                     return normals_by({kernel, 2, arithmetic}, wave.heights, wave.options);
                 }});
        }
    }
    swept.methods.push_back({"plain sobel3",
                             {{"kernel", "sobel3"}, {"arithmetic", "float32"}},
                             [](const BumpField& wave) {
                                 return textbook_sobel_normals(
                                     wave.heights, static_cast<float>(wave.options.strength));
                             },
                             true});
    return std::make_shared<const SweptSlopes>(std::move(swept));
}

/// The wave with its heights multiplied by `times`.
BumpField steeper(BumpField wave, double times) {
    wave.options.strength *= times;
    for (glm::dvec3& normal : wave.normals)
        normal = glm::normalize(normal * glm::dvec3(times, times, 1.0));
    return wave;
}

BumpField flatter(BumpField wave, double times) {
    return steeper(std::move(wave), 1.0 / times);
}

/// The wave with `by` added to its heights in double, then rounded to float, as a file would.
BumpField higher(BumpField wave, double by) {
    for (float& texel : wave.heights.as<float>())
        texel = static_cast<float>(double{texel} + by);
    return wave;
}

PreparedExperiment bump_by_steepness(const PlanOptions& options) {
    return swept_experiment(
        {.question = "At which slopes of a height map are its normals accurate?",
         .ground_truth =
             "The slopes of the wave in closed form, multiplied by the same factor. Tests verify "
             "them by numerical differentiation.",
         .input = fmt::format("{0} x {0} texels of a wave {1} texels long, at 31 slopes from 1e-30 "
                              "to 1e30",
                              map_side(options), swept_wavelength)},
        "at slope 1", swept_wave(options),
        {{{"steeper", "Steeper", "slope", 30, 2}, steeper},
         {{"flatter", "Flatter", "1 / slope", 30, 2}, flatter}});
}

PreparedExperiment bump_by_offset(const PlanOptions& options) {
    return swept_experiment(
        {.question = "At which distances of the heights from zero are their normals accurate?",
         .ground_truth =
             "The slopes of the wave in closed form, which do not depend on an added constant. "
             "Tests verify them by numerical differentiation.",
         .input =
             fmt::format("{0} x {0} texels of a wave {1} texels long and 10 high, slope 1, at 9 "
                         "heights from 1 to 1e8",
                         map_side(options), swept_wavelength)},
        "at 0", swept_wave(options),
        {{{"offset", "Higher", "height above zero, texels", 8, 1}, higher}},
        " The error of float64 is that of rounding these heights to float, which no method can "
        "undo: store heights relative to a zero within their range.");
}

}  // namespace

std::vector<PlannedExperiment> stability_plan(const PlanOptions&) {
    return {{"stability/normals-scale", "Normals: scale", normals_by_scale},
            {"stability/normals-offset", "Normals: distance from the origin", normals_by_offset},
            {"stability/normals-needles", "Normals: needles", normals_of_needles},
            {"stability/normals-hard-triangles", "Normals: hard triangles",
             normals_beside_hard_triangles},
            {"stability/tangents-scale", "Tangents: scale", tangents_by_scale},
            {"stability/tangents-offset", "Tangents: distance from the origin", tangents_by_offset},
            {"stability/bump-steepness", "Bump: steepness", bump_by_steepness},
            {"stability/bump-offset", "Bump: height above zero", bump_by_offset}};
}

}  // namespace relief::accuracy::detail
