// SPDX-License-Identifier: Apache-2.0
// Measures normals, tangents and bump maps while their input grows or shrinks by powers of ten. The
// ground truth stays known in closed form. Textbook code without guards is measured for contrast.
#include "experiment_parts.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>

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

Sweeps::Sweeps(std::vector<std::string> methods, double bound)
    : methods_(std::move(methods)), bound_(bound) {}

void Sweeps::add(const std::string& id, const std::string& title, const std::string& x_label,
                 int decades, int step, Errors errors) {
    charts_.push_back({.id = id,
                       .title = title,
                       .x_label = x_label,
                       .y_label = "RMS error, degrees",
                       .bound = bound_});
    values_.push_back({decades, step, std::move(errors)});
}

ErrorStats Sweeps::measure(std::size_t method) {
    std::vector<float> all;
    for (std::size_t i = 0; i < charts_.size(); ++i) {
        const Values& values = values_[i];
        Curve curve{.method = methods_[method]};
        for (int decade = 0; decade <= values.decades; decade += values.step) {
            const double value = std::pow(10.0, decade);
            const std::vector<float> degrees = values.errors(method, value);
            all.insert(all.end(), degrees.begin(), degrees.end());
            const double error = curve_error(error_stats(degrees));
            curve.points.push_back({value, error});
            if (!curve.breaks_at && !(error <= bound_)) curve.breaks_at = value;
        }
        charts_[i].curves.push_back(std::move(curve));
    }
    return error_stats(std::move(all));
}

std::string Sweeps::breaks() const {
    std::string text;
    for (const Chart& chart : charts_)
        text += (text.empty() ? "" : ". ") + breaks_of(chart);
    return text + ".";
}

namespace {

using TangentsMethod = MethodOn<Mesh, CornerTangents>;
using SlopesMethod = MethodOn<WaveMap, Image>;

template <typename Method>
std::vector<std::string> names_of(const std::vector<Method>& methods) {
    std::vector<std::string> names;
    for (const Method& one : methods)
        names.push_back(one.name);
    return names;
}

/// An experiment whose methods have their errors in all sweeps and their time on one thread. Its
/// finding gives the values at which methods fail.
///
/// \param methods  in the order of the sweeps
/// \param input  the input on which methods are timed
/// \param advice  a sentence for the finding, after a space
template <typename Input, typename Result>
PreparedExperiment swept_experiment(Experiment report,
                                    const std::vector<MethodOn<Input, Result>>& methods,
                                    Sweeps all_sweeps, std::shared_ptr<const Input> input,
                                    const std::string& advice = {}) {
    const auto sweeps = std::make_shared<Sweeps>(std::move(all_sweeps));
    PreparedExperiment prepared;
    prepared.report = std::move(report);
    prepared.report.error_unit = "degrees";
    prepared.costs = {.all_threads = false, .memory = false};
    for (std::size_t i = 0; i < methods.size(); ++i) {
        Method& method = prepared.methods.emplace_back();
        method.name = methods[i].name;
        method.choices = methods[i].choices;
        method.choices.emplace_back("guarded", methods[i].is_textbook ? "no" : "yes");
        method.error = [sweeps, i] { return sweeps->measure(i); };
        method.work = [input, compute = methods[i].compute] { compute(*input); };
        if (methods[i].is_textbook)
            method.note =
                "Textbook code without guards, which is not part of relief, for contrast.";
    }
    prepared.finish = [sweeps, advice](Experiment& finished) {
        finished.charts = sweeps->charts();
        finished.finding = fmt::format(
            "A method fails where its RMS error exceeds {} degree. {}{} docs/hard-cases.md lists "
            "single hard inputs and their outcomes.",
            broken_degrees, sweeps->breaks(), advice);
    };
    return prepared;
}

/// Sets the unit of work of an experiment on a mesh.
Experiment on_triangles(Experiment report, const Mesh& mesh) {
    report.item = "triangle";
    report.items = static_cast<double>(mesh.triangles.size());
    return report;
}

constexpr const char* torus_ground_truth =
    "The exact normals of the torus in closed form, which do not depend on scale and position. "
    "Tests verify them by numerical differentiation of the surface.";
constexpr std::uint32_t torus_seed = 1;
constexpr std::uint32_t needles_seed = 1;

int torus_cells(bool is_quick) {
    return is_quick ? 32 : 64;
}

NormalMethod textbook_normals(const std::string& name,
                              std::vector<glm::vec3> (*normals)(const Mesh&)) {
    return {name + ", float32", {{"weighting", name}, {"arithmetic", "float32"}}, normals, true};
}

/// The methods of the library in both arithmetics, and textbook code.
std::vector<NormalMethod> swept_normal_methods() {
    std::vector<NormalMethod> methods = normal_methods(both_arithmetics);
    methods.push_back(textbook_normals("plain area", textbook_area_normals));
    methods.push_back(textbook_normals("plain angle", textbook_angle_normals));
    return methods;
}

/// The errors of the first normals; `normals` may have more elements than `ground_truth`.
std::vector<float> normal_degrees(const std::vector<glm::vec3>& normals,
                                  const std::vector<glm::dvec3>& ground_truth) {
    std::vector<float> degrees;
    for (std::size_t v = 0; v < ground_truth.size(); ++v)
        degrees.push_back(
            static_cast<float>(degrees_between(glm::dvec3(normals[v]), ground_truth[v])));
    return degrees;
}

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

Mesh with_positions(Mesh mesh, const Change& change) {
    change.apply(mesh.positions);
    return mesh;
}

/// A mesh and the methods that are swept on it.
struct NormalsInput {
    AnalyticMesh ground_truth;
    std::vector<NormalMethod> methods = swept_normal_methods();

    /// The errors of a method on a mesh whose first vertices are those of the ground truth.
    [[nodiscard]] std::vector<float> degrees(std::size_t method, const Mesh& mesh) const {
        return normal_degrees(methods[method].compute(mesh), ground_truth.normals);
    }
};

std::shared_ptr<const NormalsInput> swept_torus(bool is_quick) {
    return std::make_shared<const NormalsInput>(NormalsInput{analytic_mesh(
        AnalyticSurface::torus, Triangulation::regular, torus_cells(is_quick), torus_seed)});
}

PreparedExperiment normals_experiment(Experiment report,
                                      const std::shared_ptr<const NormalsInput>& input,
                                      Sweeps sweeps, const std::string& advice = {}) {
    const Mesh& mesh = input->ground_truth.mesh;
    return swept_experiment(on_triangles(std::move(report), mesh), input->methods,
                            std::move(sweeps), std::shared_ptr<const Mesh>(input, &mesh), advice);
}

PreparedExperiment normals_by_scale(bool is_quick) {
    const auto input = swept_torus(is_quick);
    Sweeps sweeps(names_of(input->methods), broken_degrees);
    const auto scaled = [input](bool is_larger) {
        return [input, is_larger](std::size_t method, double value) {
            return input->degrees(method,
                                  with_positions(input->ground_truth.mesh,
                                                 {.scale = is_larger ? value : 1.0 / value}));
        };
    };
    sweeps.add("smaller", "Smaller", "times smaller than radius 1", 30, 2, scaled(false));
    sweeps.add("larger", "Larger", "times larger than radius 1", 30, 2, scaled(true));
    return normals_experiment(
        {.question = "At which scales of a mesh are its normals accurate?",
         .ground_truth = torus_ground_truth,
         .input =
             fmt::format("torus of {} triangles at 31 scales from 1e-30 to 1e30; the errors are "
                         "those of all together, the times those at scale 1",
                         input->ground_truth.mesh.triangles.size())},
        input, std::move(sweeps));
}

PreparedExperiment normals_by_offset(bool is_quick) {
    const auto input = swept_torus(is_quick);
    Sweeps sweeps(names_of(input->methods), broken_degrees);
    sweeps.add("offset", "Farther away", "distance along each axis, in radii of the torus", 8, 1,
               [input](std::size_t method, double value) {
                   return input->degrees(
                       method, with_positions(input->ground_truth.mesh, {.offset = value}));
               });
    return normals_experiment(
        {.question = "At which distances of a mesh from the origin are its normals accurate?",
         .ground_truth = torus_ground_truth,
         .input = fmt::format("torus of {} triangles at 9 distances from 1 to 1e8; the errors are "
                              "those of all together, the times those at the origin",
                              input->ground_truth.mesh.triangles.size())},
        input, std::move(sweeps),
        " float64 is exact for the given positions: its error is that of rounding the positions to "
        "float, which no method can undo. Move meshes to the origin before storing them.");
}

PreparedExperiment normals_of_needles(bool is_quick) {
    const std::size_t count = is_quick ? 1000 : 4000;
    const auto methods = std::make_shared<const std::vector<NormalMethod>>(swept_normal_methods());
    Sweeps sweeps(names_of(*methods), broken_degrees);
    sweeps.add("width", "Narrower", "length over width", 12, 1,
               [methods, count](std::size_t method, double value) {
                   const Needles needles = make_needles(count, 1.0 / value, needles_seed);
                   return normal_degrees((*methods)[method].compute(needles.mesh), needles.normals);
               });
    const auto wide = std::make_shared<const Mesh>(make_needles(count, 1.0, needles_seed).mesh);
    Experiment report{
        .question = "At which widths of a triangle is its normal accurate?",
        .ground_truth =
            "The cross product of the float corners in double; two of them are so near to the "
            "origin that nothing cancels. A test verifies it in integers.",
        .input =
            fmt::format("{} single triangles at 13 widths from 1 to 1e-12 of their length; the "
                        "errors are those of all together, the times those at width 1",
                        count)};
    return swept_experiment(on_triangles(std::move(report), *wide), *methods, std::move(sweeps),
                            wide);
}

PreparedExperiment normals_beside_hard_triangles(bool is_quick) {
    const auto input = swept_torus(is_quick);
    Sweeps sweeps(names_of(input->methods), broken_degrees);
    for (const HardTriangleName& one : hard_triangle_names) {
        sweeps.add(one.id, one.title, "number of hard triangles", 3, 1,
                   [input, kind = one.kind](std::size_t method, double count) {
                       return input->degrees(method,
                                             with_hard_triangles(input->ground_truth.mesh, kind,
                                                                 static_cast<std::size_t>(count)));
                   });
    }
    return normals_experiment(
        {.question = "With how many triangles of the hard-case catalogue are the normals around "
                     "them accurate?",
         .ground_truth =
             fmt::format("{} The added triangles have no area, no position or two sides, and are "
                         "therefore not part of the surface.",
                         torus_ground_truth),
         .input = fmt::format("torus of {} triangles with 1 to 1000 added hard triangles of five "
                              "kinds; the errors are those of all together, the times those "
                              "without them",
                              input->ground_truth.mesh.triangles.size())},
        input, std::move(sweeps));
}

/// The methods with stored tangents, and textbook code.
std::vector<TangentsMethod> swept_tangent_methods() {
    std::vector<TangentsMethod> methods;
    for (const TangentFrameMethod& method : tangent_methods()) {
        if (method.tangents)
            methods.push_back({method.name, {{"frames", method.name}}, method.tangents});
    }
    methods.push_back({"plain", {{"frames", "plain"}}, textbook_tangents, true});
    return methods;
}

constexpr const char* textured_torus_ground_truth =
    "The exact tangents of the textured torus in closed form, which do not depend on scale and "
    "position. Tests verify them by numerical differentiation of the surface.";

/// The errors of a method on a mesh with changed positions and texture coordinates.
std::vector<float> tangent_degrees(const TangentsMethod& method, const TexturedMesh& ground_truth,
                                   const Change& positions, const Change& texcoords) {
    Mesh mesh = ground_truth.mesh;
    positions.apply(mesh.positions);
    texcoords.apply(mesh.texcoords);
    const CornerTangents actual = method.compute(mesh);
    const CornerTangents expected = exact_tangents(ground_truth);
    std::vector<float> degrees;
    for (std::size_t corner = 0; corner < actual.size(); ++corner) {
        const std::uint32_t vertex =
            ground_truth.mesh.triangles[corner / 3][static_cast<glm::length_t>(corner % 3)];
        if (ground_truth.inner[vertex] == 0) continue;
        degrees.push_back(static_cast<float>(
            degrees_between(glm::dvec3(actual[corner]), glm::dvec3(expected[corner]))));
    }
    return degrees;
}

/// A textured mesh and the methods that are swept on it.
struct TangentsInput {
    TexturedMesh ground_truth;
    std::vector<TangentsMethod> methods = swept_tangent_methods();

    [[nodiscard]] std::vector<float> degrees(std::size_t method, const Change& positions,
                                             const Change& texcoords) const {
        return tangent_degrees(methods[method], ground_truth, positions, texcoords);
    }
};

std::shared_ptr<const TangentsInput> textured_torus(bool is_quick) {
    return std::make_shared<const TangentsInput>(
        TangentsInput{textured_mesh(AnalyticSurface::torus, Triangulation::regular,
                                    TextureLayout::upright, torus_cells(is_quick), 1)});
}

PreparedExperiment tangents_experiment(Experiment report,
                                       const std::shared_ptr<const TangentsInput>& input,
                                       Sweeps sweeps) {
    const Mesh& mesh = input->ground_truth.mesh;
    return swept_experiment(on_triangles(std::move(report), mesh), input->methods,
                            std::move(sweeps), std::shared_ptr<const Mesh>(input, &mesh));
}

PreparedExperiment tangents_by_scale(bool is_quick) {
    const auto input = textured_torus(is_quick);
    Sweeps sweeps(names_of(input->methods), broken_degrees);
    const auto add = [&](const char* id, const char* title, const char* label, bool is_image,
                         bool is_larger) {
        sweeps.add(id, title, label, 30, 2,
                   [input, is_image, is_larger](std::size_t method, double value) {
                       const Change change{.scale = is_larger ? value : 1.0 / value};
                       return is_image ? input->degrees(method, {}, change)
                                       : input->degrees(method, change, {});
                   });
    };
    add("smaller", "Smaller meshes", "times smaller than radius 1", false, false);
    add("larger", "Larger meshes", "times larger than radius 1", false, true);
    add("smaller-image", "Smaller texture coordinates", "times smaller than one image", true,
        false);
    add("larger-image", "Larger texture coordinates", "times larger than one image", true, true);
    return tangents_experiment(
        {.question = "At which scales of a mesh and its texture coordinates are tangents accurate?",
         .ground_truth = textured_torus_ground_truth,
         .input = fmt::format("torus of {} triangles, its positions and its texture coordinates at "
                              "31 scales each from 1e-30 to 1e30; the errors are those of all "
                              "together, the times those at scale 1",
                              input->ground_truth.mesh.triangles.size())},
        input, std::move(sweeps));
}

PreparedExperiment tangents_by_offset(bool is_quick) {
    const auto input = textured_torus(is_quick);
    Sweeps sweeps(names_of(input->methods), broken_degrees);
    sweeps.add("offset", "Meshes farther away", "distance along each axis, in radii", 8, 1,
               [input](std::size_t method, double value) {
                   return input->degrees(method, {.offset = value}, {});
               });
    sweeps.add("offset-image", "Texture coordinates farther away",
               "distance along each axis, in images", 8, 1,
               [input](std::size_t method, double value) {
                   return input->degrees(method, {}, {.offset = value});
               });
    return tangents_experiment(
        {.question = "At which distances of a mesh and its texture coordinates from the origin are "
                     "tangents accurate?",
         .ground_truth = textured_torus_ground_truth,
         .input =
             fmt::format("torus of {} triangles, its positions and its texture coordinates at "
                         "9 distances each from 1 to 1e8; the errors are those of all together, "
                         "the times those at the origin",
                         input->ground_truth.mesh.triangles.size())},
        input, std::move(sweeps));
}

constexpr double swept_wavelength = 32.0;

SlopesMethod by_kernel(Kernel kernel, Arithmetic arithmetic) {
    const std::string name = name_of(kernel, 0);
    return {fmt::format("{}, {}", name, enum_name(arithmetic)),
            {{"kernel", name}, {"arithmetic", enum_name(arithmetic)}},
            [=](const WaveMap& wave) {
                BumpOptions options = wave.options;
                options.kernel = kernel;
                options.arithmetic = arithmetic;
                Report report;
                return normals_from_height(wave.heights, options, report);
            }};
}

std::vector<SlopesMethod> swept_slope_methods() {
    std::vector<SlopesMethod> methods;
    for (const Kernel kernel : {Kernel::sobel3, Kernel::central7}) {
        for (const Arithmetic arithmetic : {Arithmetic::float64, Arithmetic::float32})
            methods.push_back(by_kernel(kernel, arithmetic));
    }
    methods.push_back({"plain sobel3",
                       {{"kernel", "sobel3"}, {"arithmetic", "float32"}},
                       [](const WaveMap& wave) {
                           return textbook_sobel_normals(wave.heights,
                                                         static_cast<float>(wave.options.strength));
                       },
                       true});
    return methods;
}

int map_side(bool is_quick) {
    return (is_quick ? 64 : 192) + 2 * wave_margin;
}

std::vector<float> slope_degrees(const SlopesMethod& method, const WaveMap& wave) {
    return inner_angles(method.compute(wave), wave.normals, wave_margin);
}

/// The wave with its heights multiplied by `times`.
WaveMap steeper(WaveMap wave, double times) {
    wave.options.strength *= times;
    for (glm::dvec3& normal : wave.normals)
        normal = glm::normalize(normal * glm::dvec3(times, times, 1.0));
    return wave;
}

/// The wave with `by` added to its heights in double, then rounded to float, as a file would.
WaveMap higher(WaveMap wave, double by) {
    for (float& texel : wave.heights.as<float>())
        texel = static_cast<float>(double{texel} + by);
    return wave;
}

/// A wave and the methods that are swept on it.
struct SlopesInput {
    WaveMap wave;
    std::vector<SlopesMethod> methods = swept_slope_methods();
};

std::shared_ptr<const SlopesInput> swept_wave(bool is_quick) {
    return std::make_shared<const SlopesInput>(
        SlopesInput{oblique_wave(map_side(is_quick), swept_wavelength, 32)});
}

PreparedExperiment slopes_experiment(Experiment report,
                                     const std::shared_ptr<const SlopesInput>& input, Sweeps sweeps,
                                     const std::string& advice = {}) {
    report.item = "texel";
    report.items = static_cast<double>(input->wave.normals.size());
    return swept_experiment(std::move(report), input->methods, std::move(sweeps),
                            std::shared_ptr<const WaveMap>(input, &input->wave), advice);
}

PreparedExperiment bump_by_steepness(bool is_quick) {
    const auto input = swept_wave(is_quick);
    Sweeps sweeps(names_of(input->methods), broken_degrees);
    sweeps.add("steeper", "Steeper", "slope", 30, 2, [input](std::size_t method, double value) {
        return slope_degrees(input->methods[method], steeper(input->wave, value));
    });
    sweeps.add("flatter", "Flatter", "1 / slope", 30, 2, [input](std::size_t method, double value) {
        return slope_degrees(input->methods[method], steeper(input->wave, 1.0 / value));
    });
    return slopes_experiment(
        {.question = "At which slopes of a height map are its normals accurate?",
         .ground_truth =
             "The slopes of the wave in closed form, multiplied by the same factor. Tests verify "
             "them by numerical differentiation.",
         .input = fmt::format("{0} x {0} texels of a wave {1} texels long, at 31 slopes from 1e-30 "
                              "to 1e30; the errors are those of all together, the times those at "
                              "slope 1",
                              map_side(is_quick), swept_wavelength)},
        input, std::move(sweeps));
}

PreparedExperiment bump_by_offset(bool is_quick) {
    const auto input = swept_wave(is_quick);
    Sweeps sweeps(names_of(input->methods), broken_degrees);
    sweeps.add("offset", "Higher", "height above zero, texels", 8, 1,
               [input](std::size_t method, double value) {
                   return slope_degrees(input->methods[method], higher(input->wave, value));
               });
    return slopes_experiment(
        {.question = "At which distances of the heights from zero are their normals accurate?",
         .ground_truth =
             "The slopes of the wave in closed form, which do not depend on an added constant. "
             "Tests verify them by numerical differentiation.",
         .input =
             fmt::format("{0} x {0} texels of a wave {1} texels long and 10 high, slope 1, at 9 "
                         "heights from 1 to 1e8; the errors are those of all together, the times "
                         "those at 0",
                         map_side(is_quick), swept_wavelength)},
        input, std::move(sweeps),
        " The error of float64 is that of rounding these heights to float, which no method can "
        "undo: store heights relative to a zero within their range.");
}

}  // namespace

std::vector<PlannedExperiment> stability_plan(const PlanOptions& options) {
    const auto planned = [is_quick = options.is_quick](const char* id, const char* title,
                                                       PreparedExperiment (*prepare)(bool)) {
        return PlannedExperiment{id, Subject::stability, title,
                                 [is_quick, prepare] { return prepare(is_quick); }};
    };
    return {
        planned("stability/normals-scale", "Normals: scale", normals_by_scale),
        planned("stability/normals-offset", "Normals: distance from the origin", normals_by_offset),
        planned("stability/normals-needles", "Normals: needles", normals_of_needles),
        planned("stability/normals-hard-triangles", "Normals: hard triangles",
                normals_beside_hard_triangles),
        planned("stability/tangents-scale", "Tangents: scale", tangents_by_scale),
        planned("stability/tangents-offset", "Tangents: distance from the origin",
                tangents_by_offset),
        planned("stability/bump-steepness", "Bump: steepness", bump_by_steepness),
        planned("stability/bump-offset", "Bump: height above zero", bump_by_offset)};
}

}  // namespace relief::accuracy::detail
