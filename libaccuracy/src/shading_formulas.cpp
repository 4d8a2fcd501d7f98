// SPDX-License-Identifier: Apache-2.0
// Experiments on formulas of shading, without images: approximations of Fresnel's reflectance, and
// the light of interpolated normals with and without normalization [Phong 1975].
#include "shading_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "portable_math.h"
#include "reference/reference_parts.h"

namespace relief::accuracy::detail {
using namespace relief::detail;
using namespace relief::shade;

ErrorStats formula_error(const FormulaMethod& method, std::span<const double> ground_truth) {
    std::vector<float> results(ground_truth.size());
    method.compute(results);
    for (std::size_t i = 0; i < ground_truth.size(); ++i)
        results[i] =
            static_cast<float>(std::abs(static_cast<double>(results[i]) - ground_truth[i]));
    return error_stats(std::move(results));
}

namespace {

/// Methods that are timed on one thread; the time is that of all inputs.
/// \param inputs  owns what the methods refer to
PreparedExperiment formula_experiment(Experiment report, const std::shared_ptr<const void>& inputs,
                                      const std::vector<FormulaMethod>& methods,
                                      const std::vector<double>& ground_truth) {
    struct FormulaState {
        std::shared_ptr<const void> inputs;
        std::vector<float> results;
        std::span<float> to = results;
    };
    const auto state = std::make_shared<FormulaState>(
        FormulaState{inputs, std::vector<float>(ground_truth.size())});
    PreparedExperiment prepared;
    prepared.report = std::move(report);
    prepared.costs = {.all_threads = false, .memory = false};
    prepared.methods = methods_on(std::shared_ptr<const std::span<float>>(state, &state->to),
                                  methods, [state, ground_truth](const FormulaMethod& method) {
                                      return formula_error(method, ground_truth);
                                  });
    return prepared;
}

/// A method that evaluates a formula of one cosine for each input.
template <typename Formula>
FormulaMethod method_of(const char* name, const char* reflectance, std::span<const float> cosines,
                        Formula formula) {
    return {name, {{"reflectance", reflectance}}, [cosines, formula](std::span<float> results) {
                for (std::size_t i = 0; i < results.size(); ++i)
                    results[i] = formula(cosines[i]);
            }};
}

float fifth_power(float x) {
    const float squared = x * x;
    return squared * squared * x;
}

/// The reflectance at normal incidence, and the correction that makes Schlick's approximation exact
/// at a cosine of 1/7.
struct Fit {
    explicit Fit(std::complex<double> index)
        : f0(static_cast<float>(reference::fresnel(index, 1.0))) {
        constexpr double at = 1.0 / 7.0;
        constexpr double away = 1.0 - at;
        constexpr double fifth = away * away * away * away * away;
        const double there = f0 + (1.0 - f0) * fifth;
        excess = static_cast<float>((there - reference::fresnel(index, at)) / (at * fifth * away));
    }
    float f0;
    float excess = 0.0F;
};

/// [Born and Wolf 1999], 1.5.2, for a real index, in float.
float dielectric(float index, float cosine) {
    const float inside = std::sqrt(std::max(index * index - 1.0F + cosine * cosine, 0.0F));
    const float across = (cosine - inside) / (cosine + inside);
    const float squared = index * index * cosine;
    const float along = (squared - inside) / (squared + inside);
    return 0.5F * (across * across + along * along);
}

/// [Born and Wolf 1999], 14.2, for n + ik without complex numbers: a and b are the real and
/// imaginary part of the square root of index^2 - sine^2.
float conductor(float n, float k, float cosine) {
    const float sine2 = 1.0F - cosine * cosine;
    const float real = n * n - k * k - sine2;
    const float length = std::sqrt(real * real + 4.0F * n * n * k * k);
    const float a = std::sqrt(std::max(0.5F * (length + real), 0.0F));
    const float sum = length + cosine * cosine;
    const float across = (sum - 2.0F * a * cosine) / (sum + 2.0F * a * cosine);
    const float first = cosine * cosine * length + sine2 * sine2;
    const float second = 2.0F * a * cosine * sine2;
    const float along = across * (first - second) / (first + second);
    return 0.5F * (across + along);
}

FormulaMethod table_of(std::complex<double> index, std::span<const float> cosines) {
    constexpr std::size_t entries = 64;
    auto table = std::make_shared<std::vector<float>>();
    for (std::size_t i = 0; i <= entries; ++i) {
        table->push_back(static_cast<float>(
            reference::fresnel(index, static_cast<double>(i) / static_cast<double>(entries))));
    }
    return method_of("table of 65", "tabulated", cosines, [table](float cosine) {
        const float place = cosine * static_cast<float>(entries);
        const std::size_t before = std::min(static_cast<std::size_t>(place), entries - 1);
        const float share = place - static_cast<float>(before);
        return (*table)[before] + share * ((*table)[before + 1] - (*table)[before]);
    });
}

}  // namespace

std::vector<FormulaMethod> fresnel_methods(std::complex<double> index,
                                           std::span<const float> cosines) {
    const Fit fit(index);
    const auto n = static_cast<float>(index.real());
    const auto k = static_cast<float>(index.imag());
    const auto schlick = [fit](float cosine) {
        return fit.f0 + (1.0F - fit.f0) * fifth_power(1.0F - cosine);
    };
    std::vector<FormulaMethod> methods = {
        method_of("constant", "that of normal incidence", cosines, [fit](float) { return fit.f0; }),
        method_of("Schlick", "Schlick's", cosines, schlick),
        method_of("Schlick, power of two", "Schlick's", cosines,
                  [fit](float cosine) {
                      const float power = (-5.55473F * cosine - 6.98316F) * cosine;
                      const double two_to_power = portable::exp(std::numbers::ln2 * power);
                      return fit.f0 + (1.0F - fit.f0) * static_cast<float>(two_to_power);
                  }),
        method_of("Schlick, right at 82 degrees", "Schlick's and a third number", cosines,
                  [schlick, fit](float cosine) {
                      const float away = 1.0F - cosine;
                      return schlick(cosine) - fit.excess * cosine * fifth_power(away) * away;
                  }),
        table_of(index, cosines)};
    if (k == 0.0F) {
        methods.push_back(method_of("Fresnel, float32", "Fresnel's", cosines,
                                    [n](float cosine) { return dielectric(n, cosine); }));
    } else {
        methods.push_back(method_of("Fresnel, float32", "Fresnel's", cosines,
                                    [n, k](float cosine) { return conductor(n, k, cosine); }));
    }
    return methods;
}

std::vector<double> exact_reflectances(std::complex<double> index, std::span<const float> cosines) {
    std::vector<double> ground_truth;
    for (const float cosine : cosines)
        ground_truth.push_back(reference::fresnel(index, static_cast<double>(cosine)));
    return ground_truth;
}

std::vector<float> cosines_of_angles(std::size_t count) {
    std::vector<float> cosines;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle =
            0.5 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count - 1);
        cosines.push_back(static_cast<float>(std::max(portable::cos(angle), 0.0)));
    }
    cosines.back() = 0.0F;
    return cosines;
}

namespace {

constexpr std::size_t schlick = 1;  ///< The index in fresnel_methods().

struct Boundary {
    const char* name;
    std::complex<double> index;
};
/// The indices of metals are for green light.
const std::array boundaries = {Boundary{"water, 1.33", 1.33},
                               Boundary{"glass, 1.5", 1.5},
                               Boundary{"diamond, 2.42", 2.42},
                               Boundary{"silicon, 4.1", 4.1},
                               Boundary{"gold, 0.43 + 2.46i", {0.43, 2.46}},
                               Boundary{"aluminium, 0.96 + 6.69i", {0.96, 6.69}},
                               Boundary{"iron, 2.95 + 2.93i", {2.95, 2.93}}};

/// The error of Schlick's approximation by angle, with one curve per boundary.
Chart chart_by_incidence() {
    Chart chart{.id = "angle",
                .title = "Schlick's error by angle",
                .x_label = "angle of incidence, degrees",
                .y_label = "reflectance",
                .is_x_log = false};
    const std::vector<float> cosines = cosines_of_angles(91);
    for (const Boundary& boundary : boundaries) {
        std::vector<float> actual(cosines.size());
        fresnel_methods(boundary.index, cosines).at(schlick).compute(actual);
        const std::vector<double> ground_truth = exact_reflectances(boundary.index, cosines);
        Curve curve{.method = boundary.name};
        for (std::size_t i = 0; i < actual.size(); ++i) {
            curve.points.push_back({static_cast<double>(i),
                                    std::abs(static_cast<double>(actual[i]) - ground_truth[i])});
        }
        chart.curves.push_back(std::move(curve));
    }
    return chart;
}

Chart index_chart(std::span<const float> cosines) {
    struct Input {
        std::vector<FormulaMethod> methods;
        std::vector<double> ground_truth;
    };
    return chart_over(
        {.id = "index",
         .title = "Error by index of refraction",
         .x_label = "index of refraction",
         .y_label = "reflectance",
         .is_x_log = false},
        names_of(fresnel_methods(1.5, cosines)),
        {1.1, 1.2, 1.33, 1.4, 1.5, 1.6, 1.8, 2.0, 2.42, 3.0, 3.5, 4.0},
        [&](double index) {
            return Input{fresnel_methods(index, cosines), exact_reflectances(index, cosines)};
        },
        [](std::size_t i, const Input& input) {
            return curve_error(formula_error(input.methods[i], input.ground_truth));
        });
}

Experiment described(const Boundary& boundary, std::size_t angles) {
    return {.question =
                "What is the error of Schlick's approximation, and what does Fresnel's formula "
                "cost?",
            .ground_truth =
                "Fresnel's formulas for unpolarized light in double. Tests verify them by the "
                "closed forms of normal incidence, Brewster's angle and grazing incidence.",
            .input = fmt::format("{}: {} angles from 0 to 90 degrees", boundary.name, angles),
            .error_unit = "reflectance",
            .item = "angle",
            .items = static_cast<double>(angles)};
}

PreparedExperiment fresnel_experiment(const Boundary& boundary) {
    const auto cosines = std::make_shared<const std::vector<float>>(cosines_of_angles(4096));
    PreparedExperiment prepared = formula_experiment(described(boundary, cosines->size()), cosines,
                                                     fresnel_methods(boundary.index, *cosines),
                                                     exact_reflectances(boundary.index, *cosines));
    prepared.compared = {"constant", "Schlick", "Schlick, right at 82 degrees", "Fresnel, float32"};
    return prepared;
}

}  // namespace

PreparedExperiment glass_experiment(const PlanOptions&) {
    PreparedExperiment prepared = fresnel_experiment(boundaries[1]);
    prepared.finish = [](Experiment& report) {
        report.charts = {chart_by_incidence(), index_chart(cosines_of_angles(901))};
    };
    return prepared;
}

PreparedExperiment metal_experiment(const PlanOptions&) {
    return fresnel_experiment(boundaries[6]);
}

namespace {

constexpr double diffuse = 0.55;
constexpr double specular = 0.45;

/// Blinn-Phong with shininess 40 [Blinn 1977], by products: 40 = 32 + 8.
template <typename Number>
Number radiance(Number n_dot_l, Number n_dot_h) {
    const Number h = std::max(n_dot_h, Number(0));
    const Number h2 = h * h;
    const Number h4 = h2 * h2;
    const Number h8 = h4 * h4;
    const Number h16 = h8 * h8;
    return static_cast<Number>(diffuse) * std::max(n_dot_l, Number(0)) +
           static_cast<Number>(specular) * h16 * h16 * h8;
}

/// \param shaded  returns the radiance of an interpolated normal
template <typename Shaded>
FormulaMethod method_of(const char* name, const char* unit, const NormalSamples& samples,
                        Shaded shaded) {
    return {name, {{"made unit", unit}}, [&samples, shaded](std::span<float> results) {
                for (std::size_t i = 0; i < results.size(); ++i)
                    results[i] = shaded(samples.interpolated()[i]);
            }};
}

/// The radiance of the interpolated normal multiplied by `scale`.
float scaled_radiance(const glm::vec3& n, float scale) {
    return radiance(scale * glm::dot(n, NormalSamples::light()),
                    scale * glm::dot(n, NormalSamples::half()));
}

double exact_radiance(const glm::vec3& interpolated) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(interpolated));
    return radiance(glm::dot(n, glm::dvec3(NormalSamples::light())),
                    glm::dot(n, glm::dvec3(NormalSamples::half())));
}

}  // namespace

NormalSamples::NormalSamples(double degrees, int side) {
    // The corners are on a circle around +z, 120 degrees apart; their distance is sqrt(3) sine.
    const double sine = 2.0 * portable::sin(glm::radians(degrees) * 0.5) / std::numbers::sqrt3;
    std::array<glm::dvec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / 3.0;
        corners.at(i) = {sine * portable::cos(turn), sine * portable::sin(turn),
                         std::sqrt(1.0 - sine * sine)};
    }
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x + y < side; ++x) {
            const double a = (x + 1.0 / 3.0) / side;
            const double b = (y + 1.0 / 3.0) / side;
            interpolated_.emplace_back(a * corners[0] + b * corners[1] +
                                       (1.0 - a - b) * corners[2]);
        }
    }
}

std::vector<double> NormalSamples::exact_radiances() const {
    std::vector<double> ground_truth;
    for (const glm::vec3& normal : interpolated_)
        ground_truth.push_back(exact_radiance(normal));
    return ground_truth;
}

const glm::vec3& NormalSamples::light() {
    static const glm::vec3 unit = glm::normalize(glm::vec3(0.3F, 0.1F, 1.0F));
    return unit;
}

const glm::vec3& NormalSamples::half() {
    static const glm::vec3 unit = glm::normalize(light() + glm::vec3(0.0F, 0.0F, 1.0F));
    return unit;
}

std::vector<FormulaMethod> unit_normal_methods(const NormalSamples& samples) {
    return {method_of("as interpolated", "no", samples,
                      [](const glm::vec3& n) { return scaled_radiance(n, 1.0F); }),
            method_of("one step of Newton's", "nearly", samples,
                      [](const glm::vec3& n) {
                          return scaled_radiance(n, 1.5F - 0.5F * glm::dot(n, n));
                      }),
            method_of("square root, float32", "in float", samples,
                      [](const glm::vec3& n) {
                          return scaled_radiance(n, 1.0F / std::sqrt(glm::dot(n, n)));
                      }),
            method_of("square root, float64", "in double", samples,
                      [](const glm::vec3& n) { return static_cast<float>(exact_radiance(n)); })};
}

namespace {

Chart chart_by_turn() {
    Chart chart = chart_over(
        {.id = "angle",
         .title = "Error by the angle between neighboring normals",
         .x_label = "degrees between the normals of a triangle's corners",
         .y_label = "radiance"},
        names_of(unit_normal_methods(NormalSamples(1.0, 1))),
        {1.0, 2.0, 4.0, 8.0, 15.0, 30.0, 60.0, 90.0},
        [](double degrees) { return NormalSamples(degrees, 32); },
        [](std::size_t i, const NormalSamples& samples) {
            return formula_error(unit_normal_methods(samples)[i], samples.exact_radiances()).rms;
        });
    // The length of a chord is too short by the square of its angle, and a Newton step squares that
    // error again. Both hold for small angles, as long as rounding to float is negligible.
    chart.curves[0].expected_order = 2.0;
    chart.curves[1].expected_order = 4.0;
    for (std::size_t i = 0; i < 2; ++i) {
        std::vector<CurvePoint> small = chart.curves[i].points;
        std::erase_if(small, [](const CurvePoint& p) { return p.x < 2.0 || p.x > 8.0; });
        chart.curves[i].order = fitted_order(small);
    }
    return chart;
}

}  // namespace

PreparedExperiment unit_normal_experiment(const PlanOptions&) {
    constexpr double degrees = 30.0;
    const auto samples = std::make_shared<const NormalSamples>(degrees, 96);
    Experiment experiment{
        .question = "Is it necessary to normalize the interpolated normal?",
        .ground_truth =
            "The same lighting in double, from the normalized normal. Tests verify it by a formula "
            "in angles, and the length in the middle of the triangle by its closed form.",
        .input = fmt::format("{} points on a triangle whose corner normals are {} degrees apart; "
                             "diffuse light and a highlight of shininess 40, light of irradiance 1",
                             samples->count(), degrees),
        .error_unit = "radiance",
        .item = "place",
        .items = static_cast<double>(samples->count())};
    PreparedExperiment prepared = formula_experiment(
        std::move(experiment), samples, unit_normal_methods(*samples), samples->exact_radiances());
    prepared.compared = names_of(prepared.methods);
    prepared.finish = [](Experiment& report) { report.charts = {chart_by_turn()}; };
    return prepared;
}

}  // namespace relief::accuracy::detail
