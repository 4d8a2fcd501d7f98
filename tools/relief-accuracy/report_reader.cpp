// SPDX-License-Identifier: Apache-2.0
// Reading a report back. What can be computed from the rest (medians, whether a method is
// efficient) is read or computed, never both. Tests: tests/tools/accuracy_report_test.cpp.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "common/command.h"
#include "file_bytes.h"
#include "json_cursor.h"
#include "relief/accuracy/subjects.h"
#include "report_json.h"

namespace relief::tools {
namespace {

Machine machine_at(const JsonCursor& place) {
    Machine machine{.processor = place.at("processor").text(),
                    .cores = static_cast<unsigned>(place.at("cores").unsigned_number()),
                    .memory_bytes = place.at("memory_bytes").unsigned_number(),
                    .system = place.at("system").text(),
                    .compiler = place.at("compiler").text(),
                    .build = place.at("build").text(),
                    .opengl = std::nullopt};
    if (const auto opengl = place.find_value("opengl")) machine.opengl = opengl->text();
    return machine;
}

RunSettings settings_at(const JsonCursor& place) {
    const auto passes = place.find_value("passes");  // Older reports were made in one.
    return {.quick = place.at("quick").boolean(),
            .timed = place.at("timed").boolean(),
            .repeats = place.at("repeats").unsigned_number(),
            .passes = passes ? passes->unsigned_number() : 1,
            .threads = static_cast<unsigned>(place.at("threads").unsigned_number())};
}

ErrorFigures error_at(const JsonCursor& place) {
    ErrorFigures error{.count = place.at("count").unsigned_number(),
                       .undefined = place.at("undefined").unsigned_number(),
                       .rms = place.at("rms").number_or_nan(),
                       .mean = place.at("mean").number_or_nan(),
                       .p99 = place.at("p99").number_or_nan(),
                       .max = place.at("max").number_or_nan(),
                       .psnr = std::nullopt};
    if (const auto psnr = place.find_value("psnr")) error.psnr = psnr->double_number();
    return error;
}

std::optional<Timing> timing_at(const JsonCursor& cost, const std::string& key) {
    const std::optional<JsonCursor> place = cost.find_value(key);
    if (!place) return std::nullopt;
    Timing timing;
    for (const JsonCursor& round : place->at("rounds").elements()) {
        timing.rounds.push_back(round.double_number());
        if (!(timing.rounds.back() > 0.0)) round.fail("is not more than 0 seconds");
    }
    return timing;
}

Cost cost_at(const JsonCursor& place) {
    Cost cost;
    cost.one_thread = timing_at(place, "one_thread");
    cost.all_threads = timing_at(place, "all_threads");
    if (const auto bytes = place.find_value("peak_bytes"))
        cost.peak_bytes = bytes->unsigned_number();
    if (const auto bytes = place.find_value("stored_bytes"))
        cost.stored_bytes = bytes->double_number();
    return cost;
}

Measurement measurement_at(const JsonCursor& place) {
    Measurement one;
    one.method = place.at("method").text();
    for (const auto& [choice, value] : place.at("choices").members())
        one.choices.emplace_back(choice, value.text());
    one.error = error_at(place.at("error"));
    one.cost = cost_at(place.at("cost"));
    one.is_efficient = place.at("efficient").boolean();
    one.note = place.at("note").text();
    if (const auto expected = place.find_value("expected_error")) {
        one.expected = ExpectedError{expected->at("map").double_number(),
                                     expected->at("added").double_number()};
    }
    return one;
}

Curve curve_at(const JsonCursor& place) {
    Curve curve;
    curve.method = place.at("method").text();
    for (const JsonCursor& point : place.at("points").elements()) {
        const std::vector<JsonCursor> numbers = point.elements();
        if (numbers.size() != 2) point.fail(fmt::format("has {} numbers, not 2", numbers.size()));
        curve.points.push_back({numbers[0].double_number(), numbers[1].number_or_nan()});
    }
    if (const auto order = place.find_value("order")) curve.order = order->double_number();
    if (const auto order = place.find_value("expected_order"))
        curve.expected_order = order->double_number();
    if (const auto x = place.find_value("breaks_at")) curve.breaks_at = x->double_number();
    return curve;
}

Chart chart_at(const JsonCursor& place) {
    Chart chart;
    chart.id = place.at("id").text();
    chart.title = place.at("title").text();
    chart.x_label = place.at("x_label").text();
    chart.y_label = place.at("y_label").text();
    chart.is_x_log = place.at("x_log").boolean();
    if (const auto bound = place.find_value("bound")) chart.bound = bound->double_number();
    for (const JsonCursor& curve : place.at("curves").elements())
        chart.curves.push_back(curve_at(curve));
    return chart;
}

Experiment experiment_at(const JsonCursor& place) {
    Experiment one;
    one.id = place.at("id").text();
    one.subject = subject_from(place.at("subject").text());
    one.title = place.at("title").text();
    one.question = place.at("question").text();
    one.truth = place.at("truth").text();
    one.input = place.at("input").text();
    one.error_unit = place.at("error_unit").text();
    one.item = place.at("item").text();
    one.items = place.at("items").double_number();
    one.command = place.at("command").text();
    one.finding = place.at("finding").text();
    if (const auto error = place.find_value("reference_error"))
        one.reference_error = error->double_number();
    if (const auto findings = place.find_value("input_findings")) {
        for (const JsonCursor& finding : findings->elements())
            one.input_findings.push_back(finding.text());
    }
    std::set<std::string> methods;
    for (const JsonCursor& measurement : place.at("measurements").elements()) {
        one.measurements.push_back(measurement_at(measurement));
        const std::string& method = one.measurements.back().method;
        if (!methods.insert(method).second)
            measurement.fail(fmt::format("is the second of method '{}'", method));
    }
    for (const JsonCursor& chart : place.at("charts").elements())
        one.charts.push_back(chart_at(chart));
    for (const JsonCursor& map : place.at("heat_maps").elements()) {
        one.heat_maps.push_back({map.at("title").text(),
                                 map.at("method").text(),
                                 {},
                                 map.at("brightest").double_number()});
    }
    for (const JsonCursor& pair : place.at("pictures").elements()) {
        one.pictures.push_back({pair.at("title").text(),
                                pair.at("before_label").text(),
                                pair.at("after_label").text(),
                                {},
                                {}});
    }
    return one;
}

/// Before anything else is looked at: other formats and versions may have everything elsewhere.
void check_format(const JsonCursor& root) {
    if (root.at("format").text() != "relief-accuracy")
        root.at("format").fail(
            fmt::format("is '{}', not 'relief-accuracy'", root.at("format").text()));
    const std::uint64_t version = root.at("version").unsigned_number();
    if (version != report_version) {
        root.at("version").fail(
            fmt::format("is {}, but only {} can be read (make the report anew with this "
                        "relief-accuracy, or compare with the one that made it)",
                        version, report_version));
    }
}

AccuracyReport report_at(const JsonCursor& root) {
    check_format(root);
    AccuracyReport report;
    report.relief = root.at("relief").text();
    report.command = root.at("command").text();
    report.machine = machine_at(root.at("machine"));
    report.settings = settings_at(root.at("settings"));
    std::set<std::string> ids;
    for (const JsonCursor& experiment : root.at("experiments").elements()) {
        report.experiments.push_back(experiment_at(experiment));
        const std::string& id = report.experiments.back().id;
        if (!ids.insert(id).second) experiment.fail(fmt::format("is the second of id '{}'", id));
    }
    return report;
}

}  // namespace

AccuracyReport read_report(const std::filesystem::path& file) {
    const std::string text = read_file(file);
    nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded()) {
        throw failure(file, "is not JSON",
                      "relief-accuracy run SUBJECT --output DIR writes DIR/accuracy.json");
    }
    return about(file,
                 [&] { return report_at(JsonCursor(std::move(json), JsonCursor::Wording::type)); });
}

}  // namespace relief::tools
