// SPDX-License-Identifier: Apache-2.0
// Reading a report back. What can be computed from the rest (medians, whether a method is
// efficient) is read or computed, never both. Tests: tests/tools/accuracy_report_test.cpp.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "common/command.h"
#include "file_bytes.h"
#include "json_place.h"
#include "relief/accuracy/subjects.h"
#include "report_json.h"

namespace relief::tools {
namespace {

Machine machine_at(const JsonPlace& place) {
    Machine machine{.processor = place.at("processor").text(),
                    .cores = static_cast<unsigned>(place.at("cores").whole_number()),
                    .memory_bytes = place.at("memory_bytes").whole_number(),
                    .system = place.at("system").text(),
                    .compiler = place.at("compiler").text(),
                    .build = place.at("build").text(),
                    .opengl = std::nullopt};
    if (const auto opengl = place.find("opengl")) machine.opengl = opengl->text();
    return machine;
}

RunSettings settings_at(const JsonPlace& place) {
    const auto passes = place.find("passes");  // Older reports were made in one.
    return {.quick = place.at("quick").boolean(),
            .timed = place.at("timed").boolean(),
            .repeats = place.at("repeats").whole_number(),
            .passes = passes ? passes->whole_number() : 1,
            .threads = static_cast<unsigned>(place.at("threads").whole_number())};
}

ErrorFigures error_at(const JsonPlace& place) {
    ErrorFigures error{.count = place.at("count").whole_number(),
                       .undefined = place.at("undefined").whole_number(),
                       .rms = place.at("rms").number_or_nan(),
                       .mean = place.at("mean").number_or_nan(),
                       .p99 = place.at("p99").number_or_nan(),
                       .max = place.at("max").number_or_nan(),
                       .psnr = std::nullopt};
    if (const auto psnr = place.find("psnr")) error.psnr = psnr->number();
    return error;
}

std::optional<Timing> timing_at(const JsonPlace& cost, const std::string& key) {
    const std::optional<JsonPlace> place = cost.find(key);
    if (!place) return std::nullopt;
    Timing timing;
    for (const JsonPlace& round : place->at("rounds").elements()) {
        timing.rounds.push_back(round.number());
        if (!(timing.rounds.back() > 0.0)) round.fail("is not more than 0 seconds");
    }
    return timing;
}

Cost cost_at(const JsonPlace& place) {
    Cost cost;
    cost.one_thread = timing_at(place, "one_thread");
    cost.all_threads = timing_at(place, "all_threads");
    if (const auto bytes = place.find("peak_bytes")) cost.peak_bytes = bytes->whole_number();
    if (const auto bytes = place.find("stored_bytes")) cost.stored_bytes = bytes->number();
    return cost;
}

Measurement measurement_at(const JsonPlace& place) {
    Measurement one;
    one.method = place.at("method").text();
    for (const auto& [choice, value] : place.at("choices").members())
        one.choices.emplace_back(choice, value.text());
    one.error = error_at(place.at("error"));
    one.cost = cost_at(place.at("cost"));
    one.is_efficient = place.at("efficient").boolean();
    one.note = place.at("note").text();
    if (const auto expected = place.find("expected_error")) {
        one.expected = ExpectedError{expected->at("map").number(), expected->at("added").number()};
    }
    return one;
}

Curve curve_at(const JsonPlace& place) {
    Curve curve;
    curve.method = place.at("method").text();
    for (const JsonPlace& point : place.at("points").elements()) {
        const std::vector<JsonPlace> numbers = point.elements();
        if (numbers.size() != 2) point.fail(fmt::format("has {} numbers, not 2", numbers.size()));
        curve.points.push_back({numbers[0].number(), numbers[1].number_or_nan()});
    }
    if (const auto order = place.find("order")) curve.order = order->number();
    if (const auto order = place.find("expected_order")) curve.expected_order = order->number();
    if (const auto x = place.find("breaks_at")) curve.breaks_at = x->number();
    return curve;
}

Chart chart_at(const JsonPlace& place) {
    Chart chart;
    chart.id = place.at("id").text();
    chart.title = place.at("title").text();
    chart.x_label = place.at("x_label").text();
    chart.y_label = place.at("y_label").text();
    chart.is_x_log = place.at("x_log").boolean();
    if (const auto bound = place.find("bound")) chart.bound = bound->number();
    for (const JsonPlace& curve : place.at("curves").elements())
        chart.curves.push_back(curve_at(curve));
    return chart;
}

Experiment experiment_at(const JsonPlace& place) {
    Experiment one;
    one.id = place.at("id").text();
    one.subject = subject_from(place.at("subject").text());
    one.title = place.at("title").text();
    one.question = place.at("question").text();
    one.truth = place.at("truth").text();
    one.input = place.at("input").text();
    one.error_unit = place.at("error_unit").text();
    one.item = place.at("item").text();
    one.items = place.at("items").number();
    one.command = place.at("command").text();
    one.finding = place.at("finding").text();
    if (const auto error = place.find("reference_error")) one.reference_error = error->number();
    if (const auto findings = place.find("input_findings")) {
        for (const JsonPlace& finding : findings->elements())
            one.input_findings.push_back(finding.text());
    }
    std::set<std::string> methods;
    for (const JsonPlace& measurement : place.at("measurements").elements()) {
        one.measurements.push_back(measurement_at(measurement));
        const std::string& method = one.measurements.back().method;
        if (!methods.insert(method).second)
            measurement.fail(fmt::format("is the second of method '{}'", method));
    }
    for (const JsonPlace& chart : place.at("charts").elements())
        one.charts.push_back(chart_at(chart));
    for (const JsonPlace& map : place.at("heat_maps").elements()) {
        one.heat_maps.push_back(
            {map.at("title").text(), map.at("method").text(), {}, map.at("brightest").number()});
    }
    for (const JsonPlace& pair : place.at("pictures").elements()) {
        one.pictures.push_back({pair.at("title").text(),
                                pair.at("before_label").text(),
                                pair.at("after_label").text(),
                                {},
                                {}});
    }
    return one;
}

/// Before anything else is looked at: other formats and versions may have everything elsewhere.
void check_format(const JsonPlace& root) {
    if (root.at("format").text() != "relief-accuracy")
        root.at("format").fail(
            fmt::format("is '{}', not 'relief-accuracy'", root.at("format").text()));
    const std::uint64_t version = root.at("version").whole_number();
    if (version != report_version) {
        root.at("version").fail(
            fmt::format("is {}, but only {} can be read (make the report anew with this "
                        "relief-accuracy, or compare with the one that made it)",
                        version, report_version));
    }
}

AccuracyReport report_at(const JsonPlace& root) {
    check_format(root);
    AccuracyReport report;
    report.relief = root.at("relief").text();
    report.command = root.at("command").text();
    report.machine = machine_at(root.at("machine"));
    report.settings = settings_at(root.at("settings"));
    std::set<std::string> ids;
    for (const JsonPlace& experiment : root.at("experiments").elements()) {
        report.experiments.push_back(experiment_at(experiment));
        const std::string& id = report.experiments.back().id;
        if (!ids.insert(id).second) experiment.fail(fmt::format("is the second of id '{}'", id));
    }
    return report;
}

}  // namespace

AccuracyReport read_report(const std::filesystem::path& file) {
    const std::string text = read_file(file);
    const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded()) {
        throw failure(file, "is not JSON",
                      "relief-accuracy run SUBJECT --output DIR writes DIR/accuracy.json");
    }
    return about(file, [&] { return report_at(JsonPlace(json)); });
}

}  // namespace relief::tools
