// SPDX-License-Identifier: Apache-2.0
// Writes a report as JSON and reads it. Derived values (medians, is_pareto_optimal) are either read
// or computed. Tests: tests/tools/accuracy_report_test.cpp.
#include "accuracy_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "common/command.h"
#include "common/text.h"
#include "files.h"
#include "json_cursor.h"
#include "relief/accuracy/experiment.h"

namespace relief::tools {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

Json json_of(const Machine& machine) {
    return {{"processor", machine.processor},
            {"cores", machine.cores},
            {"memory_bytes", machine.memory_bytes},
            {"system", machine.system},
            {"compiler", machine.compiler},
            {"build", machine.build},
            {"opengl", machine.opengl ? Json(*machine.opengl) : Json()}};
}

Json json_of(const RunSettings& settings) {
    Json json = {{"quick", settings.quick},
                 {"timed", settings.timed},
                 {"repeats", settings.repeats},
                 {"passes", settings.passes},
                 {"threads", settings.threads}};
    if (const auto& others = settings.other_programs) {
        json["other_programs"] = {{"processors", others->processors},
                                  {"available", others->available}};
    }
    return json;
}

Json json_of(const ErrorStats& error) {
    Json json = {{"count", error.count}, {"undefined", error.undefined},
                 {"rms", error.rms},     {"mean", error.mean},
                 {"p99", error.p99},     {"max", error.max}};
    if (error.psnr) json["psnr"] = *error.psnr;
    return json;
}

Json json_of(const Timing& timing) {
    const TimeStatistics spread = timing.spread();
    return {{"median", spread.median},
            {"p10", spread.p10},
            {"p90", spread.p90},
            {"rounds", timing.rounds}};
}

Json json_of(const Cost& cost) {
    Json json = Json::object();
    if (cost.one_thread) json["one_thread"] = json_of(*cost.one_thread);
    if (cost.all_threads) json["all_threads"] = json_of(*cost.all_threads);
    if (cost.peak_bytes) json["peak_bytes"] = *cost.peak_bytes;
    if (cost.stored_bytes > 0.0) json["stored_bytes"] = cost.stored_bytes;
    return json;
}

Json json_of(const Measurement& one, const std::optional<double>& reference_upper) {
    Json choices = Json::object();
    for (const auto& [choice, value] : one.choices)
        choices[choice] = value;
    Json json = {{"method", one.method},
                 {"choices", choices},
                 {"error", json_of(one.error)},
                 {"cost", json_of(one.cost)},
                 {"efficient", one.is_pareto_optimal},
                 {"note", one.note}};
    if (one.expected) {
        json["expected_error"] = {{"map", one.expected->map},
                                  {"added", one.expected->added},
                                  {"total", one.expected->total()}};
        if (reference_upper) {
            json["expected_error"]["total_upper"] =
                ExpectedError{*reference_upper, one.expected->added}.total();
        }
    }
    return json;
}

Json json_of(const Curve& curve) {
    Json points = Json::array();
    for (const CurvePoint& point : curve.points)
        points.push_back(Json::array({point.x, point.error}));
    Json json = {{"method", curve.method}, {"points", points}};
    if (curve.order) json["order"] = *curve.order;
    if (curve.expected_order) json["expected_order"] = *curve.expected_order;
    if (curve.breaks_at) json["breaks_at"] = *curve.breaks_at;
    return json;
}

Json json_of(const Chart& chart) {
    Json json = {{"id", chart.id},
                 {"title", chart.title},
                 {"x_label", chart.x_label},
                 {"y_label", chart.y_label},
                 {"x_log", chart.is_x_log}};
    if (chart.bound) json["bound"] = *chart.bound;
    json["curves"] = Json::array();
    for (const Curve& curve : chart.curves)
        json["curves"].push_back(json_of(curve));
    return json;
}

/// Adds the pictures of an experiment with their files, or null.
void add_pictures(Json& json, const Experiment& one, bool has_files) {
    const auto file = [&](PictureRole role, std::size_t index) {
        return has_files ? Json(picture_file(one, role, index)) : Json();
    };
    json["heat_maps"] = Json::array();
    for (std::size_t i = 0; i < one.heat_maps.size(); ++i) {
        const HeatMap& map = one.heat_maps[i];
        json["heat_maps"].push_back({{"title", map.title},
                                     {"method", map.method},
                                     {"unit", one.error_unit},
                                     {"brightest", map.brightest},
                                     {"file", file(PictureRole::heat, i)}});
    }
    json["pictures"] = Json::array();
    for (std::size_t i = 0; i < one.pictures.size(); ++i) {
        const PicturePair& pair = one.pictures[i];
        json["pictures"].push_back({{"title", pair.title},
                                    {"before_label", pair.before_label},
                                    {"after_label", pair.after_label},
                                    {"before", file(PictureRole::before, i)},
                                    {"after", file(PictureRole::after, i)}});
    }
}

Json json_of(const Experiment& one, bool has_files) {
    Json json = {{"id", one.id},
                 {"subject", enum_name(one.subject)},
                 {"title", one.title},
                 {"question", one.question},
                 {"truth", one.ground_truth},
                 {"input", one.input},
                 {"error_unit", one.error_unit},
                 {"item", one.item},
                 {"items", one.items},
                 {"command", one.command},
                 {"finding", one.finding},
                 {"input_findings", one.input_findings},
                 {"measurements", Json::array()},
                 {"charts", Json::array()}};
    if (one.reference_error) json["reference_error"] = *one.reference_error;
    if (one.reference_error_upper) json["reference_error_upper"] = *one.reference_error_upper;
    for (const Measurement& measurement : one.measurements)
        json["measurements"].push_back(json_of(measurement, one.reference_error_upper));
    for (const Chart& chart : one.charts)
        json["charts"].push_back(json_of(chart));
    add_pictures(json, one, has_files);
    return json;
}

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
    const auto passes = place.find_value("passes");  // Absent in old reports with one pass.
    RunSettings settings{.quick = place.at("quick").boolean(),
                         .timed = place.at("timed").boolean(),
                         .repeats = place.at("repeats").unsigned_number(),
                         .passes = passes ? passes->unsigned_number() : 1,
                         .threads = static_cast<unsigned>(place.at("threads").unsigned_number())};
    if (const auto others = place.find_value("other_programs")) {
        settings.other_programs =
            OtherPrograms{others->at("processors").double_number(),
                          static_cast<unsigned>(others->at("available").unsigned_number())};
    }
    return settings;
}

ErrorStats error_at(const JsonCursor& place) {
    ErrorStats error{.count = place.at("count").unsigned_number(),
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
        if (!(timing.rounds.back() > 0.0)) round.fail("must be above 0 seconds");
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
    one.is_pareto_optimal = place.at("efficient").boolean();
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
    one.ground_truth = place.at("truth").text();
    one.input = place.at("input").text();
    one.error_unit = place.at("error_unit").text();
    one.item = place.at("item").text();
    one.items = place.at("items").double_number();
    one.command = place.at("command").text();
    one.finding = place.at("finding").text();
    if (const auto error = place.find_value("reference_error"))
        one.reference_error = error->double_number();
    if (const auto error = place.find_value("reference_error_upper"))
        one.reference_error_upper = error->double_number();
    if (const auto findings = place.find_value("input_findings")) {
        for (const JsonCursor& finding : findings->elements())
            one.input_findings.push_back(finding.text());
    }
    std::set<std::string> methods;
    for (const JsonCursor& measurement : place.at("measurements").elements()) {
        one.measurements.push_back(measurement_at(measurement));
        const std::string& method = one.measurements.back().method;
        if (!methods.insert(method).second)
            measurement.fail(fmt::format("repeats method '{}'", method));
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

/// Checks format and version before the other content.
void check_format(const JsonCursor& root) {
    if (root.at("format").text() != "relief-accuracy")
        root.at("format").fail(
            fmt::format("is '{}', not 'relief-accuracy'", root.at("format").text()));
    const std::uint64_t version = root.at("version").unsigned_number();
    if (version != report_version) {
        root.at("version").fail(
            fmt::format("is {}, but only {} can be read (create the report again with this "
                        "relief-accuracy, or use the version that created it)",
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
        if (!ids.insert(id).second) experiment.fail(fmt::format("repeats id '{}'", id));
    }
    return report;
}

}  // namespace

Json json_of(const AccuracyReport& report, bool has_files) {
    Json json = {{"format", "relief-accuracy"},
                 {"version", report_version},
                 {"relief", report.relief},
                 {"command", report.command},
                 {"machine", json_of(report.machine)},
                 {"settings", json_of(report.settings)},
                 {"experiments", Json::array()}};
    for (const Experiment& one : report.experiments)
        json["experiments"].push_back(json_of(one, has_files));
    return json;
}

AccuracyReport read_report(const std::filesystem::path& file) {
    const std::string text = read_file(file);
    constexpr std::size_t max_depth = 64;
    about(file, [&] { require_json_depth(text, max_depth); });
    nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded()) {
        throw failure(file, "is not JSON",
                      "relief-accuracy run SUBJECT --output DIR writes DIR/accuracy.json");
    }
    return about(file,
                 [&] { return report_at(JsonCursor(std::move(json), JsonCursor::Wording::type)); });
}

}  // namespace relief::tools
