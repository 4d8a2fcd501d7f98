// SPDX-License-Identifier: Apache-2.0
// Unit normals stored in few bits: directions over the half sphere, read back; and a smooth surface
// written with and without dither. Tests: tests/accuracy/normal_codes_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "map_errors.h"
#include "measured_methods.h"
#include "storage/frame_codes.h"
#include "storage/normal_codes.h"
#include "storage/storage_experiments.h"

namespace relief {
namespace {

MeasuredMethod method_of(const NormalCode& code, const ErrorFigures& error) {
    MeasuredMethod method;
    method.name = code.name;
    method.choices = code.choices;
    method.error = error;
    method.stored_bytes = code.bytes;
    return method;
}

Experiment of_texels(const std::string& id, std::size_t texels) {
    Experiment experiment;
    experiment.id = id;
    experiment.subject = Subject::storage;
    experiment.error_unit = "degrees";
    experiment.item = "texel";
    experiment.items = static_cast<double>(texels);
    return experiment;
}

/// "The least errors: in 2 bytes 'octahedral 2 x 8 bit, best', 0.32 degrees RMS, 0.66 at most; ..."
std::string best_by_size(const Experiment& experiment) {
    std::vector<std::string> parts;
    for (const double bytes : {2.0, 3.0, 4.0, 6.0}) {
        const Measurement* best = nullptr;
        for (const Measurement& one : experiment.measurements) {
            if (one.cost.stored_bytes != bytes) continue;
            if (best == nullptr || one.error.rms < best->error.rms) best = &one;
        }
        parts.push_back(fmt::format("in {} bytes '{}', {:.2g} degrees RMS, {:.2g} at most", bytes,
                                    best->method, best->error.rms, best->error.max));
    }
    return fmt::format("The least errors: {}.", fmt::join(parts, "; "));
}

/// "8 bits with zero at 128 have an error of 0.18 degrees RMS if they are read so, but of 0.37 ..."
std::string error_by_decoder(const Experiment& experiment) {
    const auto rms_of = [&](std::string_view method) {
        for (const Measurement& one : experiment.measurements) {
            if (one.method == method) return one.error.rms;
        }
        return std::numeric_limits<double>::quiet_NaN();
    };
    return fmt::format(
        " 8 bits with zero at 128 have an error of {:.2g} degrees RMS if they are read so, but of "
        "{:.2g} by the decoder of glTF and engines, whose zero is 127.5; codes with that zero have "
        "{:.2g} there.",
        rms_of("xyz 8 bit, zero at 128"), rms_of("xyz 8 bit, zero at 128, read as glTF does"),
        rms_of("xyz 8 bit"));
}

Chart patches_chart(const Image& truth, const std::vector<NormalCode>& codes) {
    Chart chart;
    chart.id = "patches";
    chart.title = "The mean of larger patches";
    chart.x_label = "side of a patch, texels";
    chart.y_label = "RMS error of the mean normal, degrees";
    for (const NormalCode& code : codes) {
        const Image found = code.stored(truth);
        std::vector<CurvePoint> points;
        for (const int block : {1, 2, 4, 8, 16, 32})
            points.push_back(
                {static_cast<double>(block), curve_error(patch_errors(found, truth, block))});
        chart.curves.push_back(fitted_curve(code.name, std::move(points), std::nullopt));
    }
    return chart;
}

double error_at(const Chart& chart, const std::string& method, double x) {
    for (const Curve& curve : chart.curves) {
        if (curve.method != method) continue;
        for (const CurvePoint& point : curve.points) {
            if (point.x == x) return point.error;
        }
    }
    return 0.0;
}

}  // namespace

Experiment normal_reading_experiment(const RunOptions& options) {
    const int side = options.is_quick ? 128 : 512;
    // The upper half of them: what a map in tangent space can hold.
    std::vector<glm::dvec3> directions =
        even_directions(2 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    directions.resize(directions.size() / 2);
    const Image normals = image_of_normals(directions, side);
    const std::vector<NormalCode> codes = normal_codes();
    Experiment experiment = of_texels("storage/normals", directions.size());
    experiment.question = "How near does a stored normal come back, by layout and bits?";
    experiment.truth = "The directions in double: unit by construction, evenly spread.";
    experiment.input = fmt::format(
        "{} directions spread evenly over the half sphere above a surface", directions.size());
    std::vector<MeasuredMethod> measured;
    for (const NormalCode& code : codes) {
        const Image stored = code.encode(normals);
        MeasuredMethod method =
            method_of(code, figures_of(map_errors(code.decode(stored), directions)));
        method.work = [stored, decode = code.decode] { decode(stored); };
        measured.push_back(std::move(method));
    }
    measure_methods(measured, options, {.one_thread = true, .all_threads = true, .memory = false},
                    experiment);
    experiment.finding = best_by_size(experiment) + error_by_decoder(experiment);
    return experiment;
}

Experiment normal_writing_experiment(const RunOptions& options) {
    constexpr int side = 256;  // As in docs/normal-maps.md.
    const std::vector<glm::dvec3> surface = smooth_surface(side);
    const Image truth = image_of_normals(surface, side);
    const std::vector<NormalCode> codes = normal_codes();
    Experiment experiment = of_texels("storage/smooth-surface", surface.size());
    experiment.question =
        "What does writing a smooth surface take, and does dither keep the mean of a patch?";
    experiment.truth =
        "The surface's normals in closed form, single and summed over patches; a test "
        "differentiates its heights numerically.";
    experiment.input = fmt::format("{} x {} texels of waves of 128 texels and more", side, side);
    std::vector<MeasuredMethod> measured;
    for (const NormalCode& code : codes) {
        MeasuredMethod method =
            method_of(code, figures_of(map_errors(code.stored(truth), surface)));
        method.work = [&truth, encode = code.encode] { encode(truth); };
        measured.push_back(std::move(method));
    }
    measure_methods(measured, options, {.one_thread = true, .all_threads = true, .memory = false},
                    experiment);
    Chart chart = patches_chart(truth, codes);
    experiment.finding = fmt::format(
        "In 8 bits a texel is {:.2g} degrees off and the mean of 16 x 16 still {:.2g}; blue noise "
        "makes them {:.2g} and {:.2g}.",
        error_at(chart, "xyz 8 bit", 1.0), error_at(chart, "xyz 8 bit", 16.0),
        error_at(chart, "xyz 8 bit, blue-noise", 1.0),
        error_at(chart, "xyz 8 bit, blue-noise", 16.0));
    experiment.charts.push_back(std::move(chart));
    return experiment;
}

}  // namespace relief
