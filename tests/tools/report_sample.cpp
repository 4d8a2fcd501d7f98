// SPDX-License-Identifier: Apache-2.0
#include "tools/report_sample.h"

#include <limits>

namespace relief::test {
using namespace relief::accuracy;

namespace {

Measurement measurement(const std::string& method, double rms, double seconds) {
    Measurement one;
    one.method = method;
    one.choices = {{"code", method}};
    one.error = {.count = 10,
                 .undefined = 0,
                 .rms = rms,
                 .mean = 0.5 * rms,
                 .p99 = 2.0 * rms,
                 .max = 3.0 * rms,
                 .psnr = std::nullopt};
    one.cost.one_thread = Timing{{seconds, 1.1 * seconds, 0.9 * seconds}};
    one.cost.all_threads = Timing{{0.5 * seconds, 0.5 * seconds, 0.5 * seconds}};
    one.cost.peak_bytes = 4096;
    one.cost.stored_bytes = 2.5;
    return one;
}

}  // namespace

tools::AccuracyReport sample_report() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Experiment one;
    one.id = "storage/sample";
    one.subject = Subject::storage;
    one.title = "A sample";
    one.question = "How near is near?";
    one.ground_truth = "made up";
    one.input = "nothing";
    one.error_unit = "degrees";
    one.item = "frame";
    one.items = 10.0;
    one.command = "relief-accuracy run storage";
    one.finding = "near is 0.25 degrees off.";
    one.measurements = {measurement("exact, slow", 0.0, 1e-3), measurement("near", 0.25, 0.5e-3)};
    one.measurements[1].error.psnr = 40.0;
    one.measurements[1].error.undefined = 2;
    one.measurements[1].note = "It is not far.";
    one.reference_error = 0.6;
    one.reference_error_upper = 6.0;
    for (Measurement& measured : one.measurements)
        measured.expected = ExpectedError{*one.reference_error, measured.error.rms};
    one.input_findings = {"2 x non-finite height (texel 5, 17): read as 0"};
    mark_pareto_optimal(one);
    Curve curve;
    curve.method = "near";
    curve.points = {{1e-6, nan}, {0.001, 0.5}, {1.0, 0.25}};
    curve.order = -0.1;
    curve.expected_order = 0.0;
    curve.breaks_at = 1e-6;
    Chart chart;
    chart.id = "scale";
    chart.title = "Smaller frames";
    chart.x_label = "scale";
    chart.y_label = "degrees";
    chart.bound = 1.0;
    chart.curves = {curve};
    one.charts = {chart};
    HeatMap map;
    map.title = "Where";
    map.method = "near";
    map.errors = make_image(2, 1, 1, 32, ColorSpace::data);
    map.errors.as<float>()[1] = 1.0F;
    one.heat_maps = {map};
    PicturePair pair;
    pair.title = "Seen";
    pair.before_label = "near";
    pair.after_label = "truth";
    pair.before = make_image(2, 1, 3, 8, ColorSpace::srgb);
    pair.after = make_image(2, 1, 3, 8, ColorSpace::srgb);
    one.pictures = {pair};
    tools::AccuracyReport report;
    report.relief = "0.1.0";
    report.command = "relief-accuracy run storage";
    report.machine = {"A processor", 2, 1000000, "A system", "A compiler", "Release", "A renderer"};
    report.settings = {.quick = true, .timed = true, .repeats = 3, .passes = 2, .threads = 2};
    report.settings.other_programs = tools::OtherPrograms{1.7, 2};
    report.experiments = {one};
    return report;
}

}  // namespace relief::test
