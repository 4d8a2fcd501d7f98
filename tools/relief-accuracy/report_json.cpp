// SPDX-License-Identifier: Apache-2.0
// Writing a report as JSON: names as in docs/accuracy-schema.md, seconds and bytes, null for what
// has no number. Tests: tests/tools/accuracy_report_test.cpp.
#include "report_json.h"

#include <nlohmann/json.hpp>

#include "relief/accuracy/subjects.h"
#include "report_pictures.h"

namespace relief::tools {
namespace {

using Json = nlohmann::ordered_json;

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
    return {{"quick", settings.quick},
            {"timed", settings.timed},
            {"repeats", settings.repeats},
            {"passes", settings.passes},
            {"threads", settings.threads}};
}

Json json_of(const ErrorFigures& error) {
    Json json = {{"count", error.count}, {"undefined", error.undefined},
                 {"rms", error.rms},     {"mean", error.mean},
                 {"p99", error.p99},     {"max", error.max}};
    if (error.psnr) json["psnr"] = *error.psnr;
    return json;
}

Json json_of(const Timing& timing) {
    const Spread spread = timing.spread();
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

Json json_of(const Measurement& one) {
    Json choices = Json::object();
    for (const auto& [choice, value] : one.choices)
        choices[choice] = value;
    Json json = {{"method", one.method},          {"choices", choices},
                 {"error", json_of(one.error)},   {"cost", json_of(one.cost)},
                 {"efficient", one.is_efficient}, {"note", one.note}};
    if (one.expected) {
        json["expected_error"] = {{"map", one.expected->map},
                                  {"added", one.expected->added},
                                  {"total", one.expected->total()}};
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

/// The pictures of an experiment, each with its file, or null.
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
                 {"subject", word_of(one.subject)},
                 {"title", one.title},
                 {"question", one.question},
                 {"truth", one.truth},
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
    for (const Measurement& measurement : one.measurements)
        json["measurements"].push_back(json_of(measurement));
    for (const Chart& chart : one.charts)
        json["charts"].push_back(json_of(chart));
    add_pictures(json, one, has_files);
    return json;
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

}  // namespace relief::tools
