// SPDX-License-Identifier: Apache-2.0
// Measures normals, tangents and bump maps while their input grows or shrinks by powers of ten. The
// ground truth stays known in closed form. Textbook code without guards is measured for contrast.
#include "stability_experiments.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "bump_experiments.h"
#include "error_metrics.h"
#include "experiment_driver.h"
#include "normals_experiments.h"
#include "relief/mesh/error_stats.h"
#include "report_names.h"
#include "stability_inputs.h"
#include "tangent_methods.h"

namespace relief {
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
    : methods_(std::move(methods)), bound_(bound), degrees_(methods_.size()) {}

void Sweeps::add(const std::string& id, const std::string& title, const std::string& x_label,
                 int decades, int step, const Errors& errors) {
    Chart chart{.id = id,
                .title = title,
                .x_label = x_label,
                .y_label = "RMS error, degrees",
                .bound = bound_};
    for (std::size_t method = 0; method < methods_.size(); ++method) {
        Curve curve{.method = methods_[method]};
        for (int decade = 0; decade <= decades; decade += step) {
            const double value = std::pow(10.0, decade);
            const std::vector<float> degrees = errors(method, value);
            degrees_[method].insert(degrees_[method].end(), degrees.begin(), degrees.end());
            const double error = curve_error(error_stats(degrees));
            curve.points.push_back({value, error});
            if (!curve.breaks_at && !(error <= bound_)) curve.breaks_at = value;
        }
        chart.curves.push_back(std::move(curve));
    }
    charts_.push_back(std::move(chart));
}

ErrorStats Sweeps::figures(std::size_t method) const {
    return error_stats(degrees_[method]);
}

std::string Sweeps::breaks() const {
    std::string text;
    for (const Chart& chart : charts_)
        text += (text.empty() ? "" : ". ") + breaks_of(chart);
    return text + ".";
}

namespace {

/// A method for inputs of one kind.
template <typename Input, typename Result>
struct SweptMethod {
    std::string name;
    std::vector<std::pair<std::string, std::string>> choices;
    std::function<Result(const Input&)> compute;
    bool is_textbook = false;  ///< Code without guards, measured for contrast.
};
using SweptNormals = SweptMethod<Mesh, std::vector<glm::vec3>>;
using SweptTangents = SweptMethod<Mesh, CornerTangents>;
using SweptSlopes = SweptMethod<WaveMap, Image>;

template <typename Method>
std::vector<std::string> names_of(const std::vector<Method>& methods) {
    std::vector<std::string> names;
    for (const Method& one : methods)
        names.push_back(one.name);
    return names;
}

/// Adds a measurement of each method with its errors in all sweeps and its time on one thread, the
/// charts, and the values at which methods fail.
///
/// \param methods  in the order of the sweeps
/// \param input  the input on which methods are timed
template <typename Input, typename Result>
void measure_swept(const std::vector<SweptMethod<Input, Result>>& methods, const Sweeps& sweeps,
                   const Input& input, const RunOptions& options, Experiment& experiment) {
    std::vector<MeasuredMethod> measured;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const bool is_textbook = methods[i].is_textbook;
        MeasuredMethod& method = measured.emplace_back();
        method.name = methods[i].name;
        method.choices = methods[i].choices;
        method.choices.emplace_back("guarded", is_textbook ? "no" : "yes");
        method.error = sweeps.figures(i);
        method.work = [&input, compute = methods[i].compute] { compute(input); };
        if (is_textbook)
            method.note =
                "Textbook code without guards, which is not part of relief, for contrast.";
    }
    experiment.error_unit = "degrees";
    measure_methods(measured, options, {.all_threads = false, .memory = false}, experiment);
    experiment.charts = sweeps.charts();
    experiment.finding = fmt::format("A method fails where its RMS error exceeds {} degree. {}",
                                     broken_degrees, sweeps.breaks());
}

/// The same for methods on meshes.
template <typename Result>
void measure_on_mesh(const std::vector<SweptMethod<Mesh, Result>>& methods, const Sweeps& sweeps,
                     const Mesh& mesh, const RunOptions& options, Experiment& experiment) {
    experiment.item = "triangle";
    experiment.items = static_cast<double>(mesh.triangles.size());
    measure_swept(methods, sweeps, mesh, options, experiment);
}

constexpr const char* torus_ground_truth =
    "The exact normals of the torus in closed form, which do not depend on scale and position. "
    "Tests verify them by numerical differentiation of the surface.";
constexpr std::uint32_t torus_seed = 1;
constexpr std::uint32_t needles_seed = 1;

int torus_cells(const RunOptions& options) {
    return options.is_quick ? 32 : 64;
}

AnalyticMesh swept_torus(const RunOptions& options) {
    return analytic_mesh(AnalyticSurface::torus, Triangulation::regular, torus_cells(options),
                         torus_seed);
}

SweptNormals swept(const NormalMethod& method, bool is_textbook = false) {
    return {method.name(), method.choices(), method.normals, is_textbook};
}

SweptNormals textbook_normals(const char* name, std::vector<glm::vec3> (*normals)(const Mesh&)) {
    NormalMethod method;
    method.weighting = name;
    method.arithmetic = Arithmetic::float32;
    method.normals = normals;
    return swept(method, true);
}

/// The methods of the library in both arithmetics, and textbook code.
std::vector<SweptNormals> swept_normal_methods() {
    std::vector<SweptNormals> methods;
    for (const NormalMethod& method : normal_methods(both_arithmetics))
        methods.push_back(swept(method));
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

}  // namespace

Experiment normals_by_scale(const RunOptions& options) {
    const AnalyticMesh ground_truth = swept_torus(options);
    const std::vector<SweptNormals> methods = swept_normal_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    const auto scaled = [&](bool is_larger) {
        return [&, is_larger](std::size_t method, double value) {
            const Mesh mesh =
                with_positions(ground_truth.mesh, {.scale = is_larger ? value : 1.0 / value});
            return normal_degrees(methods[method].compute(mesh), ground_truth.normals);
        };
    };
    sweeps.add("smaller", "Smaller", "times smaller than radius 1", 30, 2, scaled(false));
    sweeps.add("larger", "Larger", "times larger than radius 1", 30, 2, scaled(true));
    Experiment experiment{
        .id = "stability/normals-scale",
        .question = "At which scales of a mesh are its normals accurate?",
        .ground_truth = torus_ground_truth,
        .input =
            fmt::format("torus of {} triangles at 31 scales from 1e-30 to 1e30; the errors are "
                        "those of all together, the times those at scale 1",
                        ground_truth.mesh.triangles.size())};
    measure_on_mesh(methods, sweeps, ground_truth.mesh, options, experiment);
    return experiment;
}

Experiment normals_by_offset(const RunOptions& options) {
    const AnalyticMesh ground_truth = swept_torus(options);
    const std::vector<SweptNormals> methods = swept_normal_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    sweeps.add("offset", "Farther away", "distance along each axis, in radii of the torus", 8, 1,
               [&](std::size_t method, double value) {
                   const Mesh mesh = with_positions(ground_truth.mesh, {.offset = value});
                   return normal_degrees(methods[method].compute(mesh), ground_truth.normals);
               });
    Experiment experiment{
        .id = "stability/normals-offset",
        .question = "At which distances of a mesh from the origin are its normals accurate?",
        .ground_truth = torus_ground_truth,
        .input = fmt::format("torus of {} triangles at 9 distances from 1 to 1e8; the errors are "
                             "those of all together, the times those at the origin",
                             ground_truth.mesh.triangles.size())};
    measure_on_mesh(methods, sweeps, ground_truth.mesh, options, experiment);
    experiment.finding +=
        " float64 is exact for the given positions: its error is that of rounding the positions to "
        "float, which no method can undo. Move meshes to the origin before storing them.";
    return experiment;
}

Experiment normals_of_needles(const RunOptions& options) {
    const std::size_t count = options.is_quick ? 1000 : 4000;
    const std::vector<SweptNormals> methods = swept_normal_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    sweeps.add("width", "Narrower", "length over width", 12, 1,
               [&](std::size_t method, double value) {
                   const Needles needles = make_needles(count, 1.0 / value, needles_seed);
                   return normal_degrees(methods[method].compute(needles.mesh), needles.normals);
               });
    const Needles wide = make_needles(count, 1.0, needles_seed);
    Experiment experiment{
        .id = "stability/normals-needles",
        .question = "At which widths of a triangle is its normal accurate?",
        .ground_truth =
            "The cross product of the float corners in double; two of them are so near to the "
            "origin that nothing cancels. A test verifies it in integers.",
        .input =
            fmt::format("{} single triangles at 13 widths from 1 to 1e-12 of their length; the "
                        "errors are those of all together, the times those at width 1",
                        count)};
    measure_on_mesh(methods, sweeps, wide.mesh, options, experiment);
    return experiment;
}

Experiment normals_beside_hard_triangles(const RunOptions& options) {
    const AnalyticMesh ground_truth = swept_torus(options);
    const std::vector<SweptNormals> methods = swept_normal_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    for (const HardTriangleName& one : hard_triangle_names) {
        sweeps.add(one.id, one.title, "number of hard triangles", 3, 1,
                   [&](std::size_t method, double count) {
                       const Mesh mesh = with_hard_triangles(ground_truth.mesh, one.kind,
                                                             static_cast<std::size_t>(count));
                       return normal_degrees(methods[method].compute(mesh), ground_truth.normals);
                   });
    }
    Experiment experiment{
        .id = "stability/normals-hard-triangles",
        .question =
            "With how many triangles of the hard-case catalogue are the normals around them "
            "accurate?",
        .ground_truth =
            fmt::format("{} The added triangles have no area, no position or two sides, and are "
                        "therefore not part of the surface.",
                        torus_ground_truth),
        .input = fmt::format("torus of {} triangles with 1 to 1000 added hard triangles of five "
                             "kinds; the errors are those of all together, the times those without "
                             "them",
                             ground_truth.mesh.triangles.size())};
    measure_on_mesh(methods, sweeps, ground_truth.mesh, options, experiment);
    return experiment;
}

namespace {

/// The methods with stored tangents, and textbook code.
std::vector<SweptTangents> swept_tangent_methods() {
    std::vector<SweptTangents> methods;
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

TexturedMesh textured_torus(const RunOptions& options) {
    return textured_mesh(AnalyticSurface::torus, Triangulation::regular, TextureLayout::upright,
                         torus_cells(options), 1);
}

/// The errors of a method on a mesh with changed positions and texture coordinates.
std::vector<float> tangent_degrees(const SweptTangents& method, const TexturedMesh& ground_truth,
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

}  // namespace

Experiment tangents_by_scale(const RunOptions& options) {
    const TexturedMesh ground_truth = textured_torus(options);
    const std::vector<SweptTangents> methods = swept_tangent_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    const auto add = [&](const char* id, const char* title, const char* label, bool is_image,
                         bool is_larger) {
        sweeps.add(id, title, label, 30, 2, [&, is_image, is_larger](std::size_t i, double value) {
            const Change change{.scale = is_larger ? value : 1.0 / value};
            return is_image ? tangent_degrees(methods[i], ground_truth, {}, change)
                            : tangent_degrees(methods[i], ground_truth, change, {});
        });
    };
    add("smaller", "Smaller meshes", "times smaller than radius 1", false, false);
    add("larger", "Larger meshes", "times larger than radius 1", false, true);
    add("smaller-image", "Smaller texture coordinates", "times smaller than one image", true,
        false);
    add("larger-image", "Larger texture coordinates", "times larger than one image", true, true);
    Experiment experiment{
        .id = "stability/tangents-scale",
        .question = "At which scales of a mesh and its texture coordinates are tangents accurate?",
        .ground_truth = textured_torus_ground_truth,
        .input = fmt::format("torus of {} triangles, its positions and its texture coordinates at "
                             "31 scales each from 1e-30 to 1e30; the errors are those of all "
                             "together, the times those at scale 1",
                             ground_truth.mesh.triangles.size())};
    measure_on_mesh(methods, sweeps, ground_truth.mesh, options, experiment);
    return experiment;
}

Experiment tangents_by_offset(const RunOptions& options) {
    const TexturedMesh ground_truth = textured_torus(options);
    const std::vector<SweptTangents> methods = swept_tangent_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    sweeps.add("offset", "Meshes farther away", "distance along each axis, in radii", 8, 1,
               [&](std::size_t i, double value) {
                   return tangent_degrees(methods[i], ground_truth, {.offset = value}, {});
               });
    sweeps.add("offset-image", "Texture coordinates farther away",
               "distance along each axis, in images", 8, 1, [&](std::size_t i, double value) {
                   return tangent_degrees(methods[i], ground_truth, {}, {.offset = value});
               });
    Experiment experiment{
        .id = "stability/tangents-offset",
        .question =
            "At which distances of a mesh and its texture coordinates from the origin are "
            "tangents accurate?",
        .ground_truth = textured_torus_ground_truth,
        .input =
            fmt::format("torus of {} triangles, its positions and its texture coordinates at "
                        "9 distances each from 1 to 1e8; the errors are those of all together, "
                        "the times those at the origin",
                        ground_truth.mesh.triangles.size())};
    measure_on_mesh(methods, sweeps, ground_truth.mesh, options, experiment);
    return experiment;
}

namespace {

constexpr double swept_wavelength = 32.0;

SweptSlopes by_kernel(Kernel kernel, Arithmetic arithmetic) {
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

std::vector<SweptSlopes> swept_slope_methods() {
    std::vector<SweptSlopes> methods;
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

int map_side(const RunOptions& options) {
    return (options.is_quick ? 64 : 192) + 2 * wave_margin;
}

std::vector<float> slope_degrees(const SweptSlopes& method, const WaveMap& wave) {
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

/// The same as measure_swept() on a wave.
void measure_on_wave(const std::vector<SweptSlopes>& methods, const Sweeps& sweeps,
                     const WaveMap& wave, const RunOptions& options, Experiment& experiment) {
    experiment.item = "texel";
    experiment.items = static_cast<double>(wave.normals.size());
    measure_swept(methods, sweeps, wave, options, experiment);
}

}  // namespace

Experiment bump_by_steepness(const RunOptions& options) {
    const WaveMap wave = oblique_wave(map_side(options), swept_wavelength, 32);
    const std::vector<SweptSlopes> methods = swept_slope_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    sweeps.add("steeper", "Steeper", "slope", 30, 2, [&](std::size_t method, double value) {
        return slope_degrees(methods[method], steeper(wave, value));
    });
    sweeps.add("flatter", "Flatter", "1 / slope", 30, 2, [&](std::size_t method, double value) {
        return slope_degrees(methods[method], steeper(wave, 1.0 / value));
    });
    Experiment experiment{
        .id = "stability/bump-steepness",
        .question = "At which slopes of a height map are its normals accurate?",
        .ground_truth =
            "The slopes of the wave in closed form, multiplied by the same factor. Tests verify "
            "them by numerical differentiation.",
        .input = fmt::format("{0} x {0} texels of a wave {1} texels long, at 31 slopes from 1e-30 "
                             "to 1e30; the errors are those of all together, the times those at "
                             "slope 1",
                             map_side(options), swept_wavelength)};
    measure_on_wave(methods, sweeps, wave, options, experiment);
    return experiment;
}

Experiment bump_by_offset(const RunOptions& options) {
    const WaveMap wave = oblique_wave(map_side(options), swept_wavelength, 32);
    const std::vector<SweptSlopes> methods = swept_slope_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    sweeps.add("offset", "Higher", "height above zero, texels", 8, 1,
               [&](std::size_t method, double value) {
                   return slope_degrees(methods[method], higher(wave, value));
               });
    Experiment experiment{
        .id = "stability/bump-offset",
        .question = "At which distances of the heights from zero are their normals accurate?",
        .ground_truth =
            "The slopes of the wave in closed form, which do not depend on an added constant. "
            "Tests verify them by numerical differentiation.",
        .input =
            fmt::format("{0} x {0} texels of a wave {1} texels long and 10 high, slope 1, at 9 "
                        "heights from 1 to 1e8; the errors are those of all together, the times "
                        "those at 0",
                        map_side(options), swept_wavelength)};
    measure_on_wave(methods, sweeps, wave, options, experiment);
    experiment.finding +=
        " The error of float64 is that of rounding these heights to float, which no method can "
        "undo: store heights relative to a zero within their range.";
    return experiment;
}

std::vector<Experiment> stability_experiments(const RunOptions& options) {
    const std::vector<PlannedExperiment> plan = {
        {"Normals: scale", [&] { return normals_by_scale(options); }},
        {"Normals: distance from the origin", [&] { return normals_by_offset(options); }},
        {"Normals: needles", [&] { return normals_of_needles(options); }},
        {"Normals: hard triangles", [&] { return normals_beside_hard_triangles(options); }},
        {"Tangents: scale", [&] { return tangents_by_scale(options); }},
        {"Tangents: distance from the origin", [&] { return tangents_by_offset(options); }},
        {"Bump: steepness", [&] { return bump_by_steepness(options); }},
        {"Bump: height above zero", [&] { return bump_by_offset(options); }}};
    std::vector<Experiment> experiments = run_planned(plan, options);
    for (Experiment& experiment : experiments) {
        experiment.subject = Subject::stability;
        experiment.finding += " docs/hard-cases.md lists single hard inputs and their outcomes.";
    }
    return experiments;
}

}  // namespace relief
