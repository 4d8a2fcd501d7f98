// SPDX-License-Identifier: Apache-2.0
// Writes a report as JSON and reads it. One list of members per struct serves both directions;
// derived values (medians, totals) are written only.
// Tests: tests/tools/accuracy_report_test.cpp.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <type_traits>

#include "accuracy_report.h"
#include "common/command.h"
#include "common/text.h"
#include "files.h"
#include "json_cursor.h"
#include "relief/accuracy/experiment.h"

namespace relief::tools {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

/// A member of a struct. An optional one is absent if it has the value of a default struct.
template <typename Struct, typename Member, bool optional = false>
struct Field {
    static constexpr bool is_optional = optional;
    const char* key;
    Member Struct::*member;
};

template <typename Struct, typename Member>
Field(const char*, Member Struct::*) -> Field<Struct, Member>;

template <typename Struct, typename Member>
constexpr Field<Struct, Member, true> maybe(const char* key, Member Struct::*member) {
    return {key, member};
}

template <typename Struct>
constexpr auto fields = std::tuple{};

template <>
constexpr auto fields<Machine> =
    std::tuple{Field{"processor", &Machine::processor},       Field{"cores", &Machine::cores},
               Field{"memory_bytes", &Machine::memory_bytes}, Field{"system", &Machine::system},
               Field{"compiler", &Machine::compiler},         Field{"build", &Machine::build}};

template <>
constexpr auto fields<OtherPrograms> = std::tuple{Field{"processors", &OtherPrograms::processors},
                                                  Field{"available", &OtherPrograms::available}};

template <>
constexpr auto fields<RunSettings> = std::tuple{
    Field{"quick", &RunSettings::quick},     Field{"timed", &RunSettings::timed},
    Field{"repeats", &RunSettings::repeats}, maybe("passes", &RunSettings::passes),
    Field{"threads", &RunSettings::threads}, maybe("other_programs", &RunSettings::other_programs)};

template <>
constexpr auto fields<ErrorStats> =
    std::tuple{Field{"count", &ErrorStats::count}, Field{"undefined", &ErrorStats::undefined},
               Field{"rms", &ErrorStats::rms},     Field{"mean", &ErrorStats::mean},
               Field{"p99", &ErrorStats::p99},     Field{"max", &ErrorStats::max},
               maybe("psnr", &ErrorStats::psnr)};

template <>
constexpr auto fields<Cost> =
    std::tuple{maybe("one_thread", &Cost::one_thread), maybe("all_threads", &Cost::all_threads),
               maybe("peak_bytes", &Cost::peak_bytes), maybe("stored_bytes", &Cost::stored_bytes)};

template <>
constexpr auto fields<ExpectedError> =
    std::tuple{Field{"map", &ExpectedError::map}, Field{"added", &ExpectedError::added}};

template <>
constexpr auto fields<Measurement> = std::tuple{Field{"method", &Measurement::method},
                                                Field{"choices", &Measurement::choices},
                                                Field{"error", &Measurement::error},
                                                Field{"cost", &Measurement::cost},
                                                Field{"efficient", &Measurement::is_pareto_optimal},
                                                Field{"note", &Measurement::note},
                                                maybe("expected_error", &Measurement::expected)};

template <>
constexpr auto fields<Curve> = std::tuple{
    Field{"method", &Curve::method}, Field{"points", &Curve::points}, maybe("order", &Curve::order),
    maybe("expected_order", &Curve::expected_order), maybe("breaks_at", &Curve::breaks_at)};

template <>
constexpr auto fields<Chart> =
    std::tuple{Field{"id", &Chart::id},           Field{"title", &Chart::title},
               Field{"x_label", &Chart::x_label}, Field{"y_label", &Chart::y_label},
               Field{"x_log", &Chart::is_x_log},  maybe("bound", &Chart::bound),
               Field{"curves", &Chart::curves}};

template <>
constexpr auto fields<HeatMap> =
    std::tuple{Field{"title", &HeatMap::title}, Field{"method", &HeatMap::method},
               Field{"brightest", &HeatMap::brightest}};

template <>
constexpr auto fields<PicturePair> = std::tuple{Field{"title", &PicturePair::title},
                                                Field{"before_label", &PicturePair::before_label},
                                                Field{"after_label", &PicturePair::after_label}};

template <>
constexpr auto fields<Experiment> =
    std::tuple{Field{"id", &Experiment::id},
               Field{"subject", &Experiment::subject},
               Field{"title", &Experiment::title},
               Field{"question", &Experiment::question},
               Field{"truth", &Experiment::ground_truth},
               Field{"input", &Experiment::input},
               Field{"error_unit", &Experiment::error_unit},
               Field{"item", &Experiment::item},
               Field{"items", &Experiment::items},
               Field{"command", &Experiment::command},
               Field{"finding", &Experiment::finding},
               maybe("input_findings", &Experiment::input_findings),
               Field{"measurements", &Experiment::measurements},
               Field{"charts", &Experiment::charts},
               maybe("reference_error", &Experiment::reference_error),
               maybe("reference_error_upper", &Experiment::reference_error_upper),
               Field{"heat_maps", &Experiment::heat_maps},
               Field{"pictures", &Experiment::pictures}};

template <>
constexpr auto fields<AccuracyReport> = std::tuple{
    Field{"relief", &AccuracyReport::relief}, Field{"command", &AccuracyReport::command},
    Field{"machine", &AccuracyReport::machine}, Field{"settings", &AccuracyReport::settings},
    Field{"experiments", &AccuracyReport::experiments}};

template <typename Value>
constexpr bool has_fields = std::tuple_size_v<std::decay_t<decltype(fields<Value>)>> != 0;
template <typename Value>
constexpr bool is_vector = false;
template <typename Element>
constexpr bool is_vector<std::vector<Element>> = true;
template <typename Value>
constexpr bool is_maybe = false;
template <typename Value>
constexpr bool is_maybe<std::optional<Value>> = true;

template <typename Value>
Json written(const Value& value) {
    if constexpr (has_fields<Value>) {
        Json json = Json::object();
        const auto add = [&]<typename One>(const One& field) {
            if constexpr (One::is_optional) {
                const auto& member = value.*field.member;
                if constexpr (is_maybe<std::decay_t<decltype(member)>>) {
                    if (!member) return;
                } else if (member == Value().*field.member) {
                    return;
                }
            }
            json[field.key] = written(value.*field.member);
        };
        std::apply([&](const auto&... all) { (add(all), ...); }, fields<Value>);
        return json;
    } else if constexpr (is_maybe<Value>) {
        return value ? written(*value) : Json();
    } else if constexpr (std::is_same_v<Value, Choices>) {
        Json json = Json::object();
        for (const auto& [choice, name] : value)
            json[choice] = name;
        return json;
    } else if constexpr (is_vector<Value>) {
        Json json = Json::array();
        for (const auto& one : value)
            json.push_back(written(one));
        return json;
    } else if constexpr (std::is_same_v<Value, Timing>) {
        const TimeStatistics spread = value.spread();
        return {{"median", spread.median},
                {"p10", spread.p10},
                {"p90", spread.p90},
                {"rounds", value.rounds}};
    } else if constexpr (std::is_same_v<Value, CurvePoint>) {
        return Json::array({value.x, value.error});
    } else if constexpr (std::is_same_v<Value, Subject>) {
        return enum_name(value);
    } else {
        return value;
    }
}

/// Adds the derived values of an experiment, and the files of its pictures, or null.
void complete(Json& json, const Experiment& one, bool has_files) {
    const auto file = [&](PictureRole role, std::size_t index) {
        return has_files ? Json(picture_file(one, role, index)) : Json();
    };
    if (one.input_findings.empty()) json["input_findings"] = Json::array();
    for (std::size_t i = 0; i < one.measurements.size(); ++i) {
        const std::optional<ExpectedError>& expected = one.measurements[i].expected;
        if (!expected) continue;
        Json& total = json["measurements"][i]["expected_error"];
        total["total"] = expected->total();
        if (one.reference_error_upper)
            total["total_upper"] =
                ExpectedError{*one.reference_error_upper, expected->added}.total();
    }
    for (std::size_t i = 0; i < one.heat_maps.size(); ++i) {
        json["heat_maps"][i]["unit"] = one.error_unit;
        json["heat_maps"][i]["file"] = file(PictureRole::heat, i);
    }
    for (std::size_t i = 0; i < one.pictures.size(); ++i) {
        json["pictures"][i]["before"] = file(PictureRole::before, i);
        json["pictures"][i]["after"] = file(PictureRole::after, i);
    }
}

void read(const JsonCursor& place, std::string& value) {
    value = place.text();
}
void read(const JsonCursor& place, bool& value) {
    value = place.boolean();
}
void read(const JsonCursor& place, double& value) {
    value = place.number_or_nan();
}
void read(const JsonCursor& place, Subject& value) {
    value = subject_from(place.text());
}
void read(const JsonCursor& place, Choices& value) {
    for (const auto& [choice, name] : place.members())
        value.emplace_back(choice, name.text());
}
void read(const JsonCursor& place, Timing& value) {
    for (const JsonCursor& round : place.at("rounds").elements()) {
        value.rounds.push_back(round.double_number());
        if (!(value.rounds.back() > 0.0)) round.fail("must be above 0 seconds");
    }
}
void read(const JsonCursor& place, CurvePoint& value) {
    const std::vector<JsonCursor> numbers = place.elements();
    if (numbers.size() != 2) place.fail(fmt::format("has {} numbers, not 2", numbers.size()));
    value = {numbers[0].double_number(), numbers[1].number_or_nan()};
}

/// Returns the property that no other element of an array may have: "id 'normals/large'".
template <typename Element>
std::string key_of(const Element& element) {
    if constexpr (std::is_same_v<Element, Experiment>) return "id '" + element.id + "'";
    if constexpr (std::is_same_v<Element, Measurement>) return "method '" + element.method + "'";
    return "";
}

template <typename Value>
void read(const JsonCursor& place, Value& value) {
    if constexpr (has_fields<Value>) {
        const auto read_field = [&](const auto& field) {
            const auto found = field.is_optional ? place.find_value(field.key)
                                                 : std::optional(place.at(field.key));
            if (found) read(*found, value.*field.member);
        };
        std::apply([&](const auto&... all) { (read_field(all), ...); }, fields<Value>);
    } else if constexpr (is_maybe<Value>) {
        read(place, value.emplace());
    } else if constexpr (is_vector<Value>) {
        std::set<std::string> keys;
        for (const JsonCursor& element : place.elements()) {
            read(element, value.emplace_back());
            const std::string key = key_of(value.back());
            if (!key.empty() && !keys.insert(key).second) element.fail("repeats " + key);
        }
    } else {
        value = static_cast<Value>(place.unsigned_number());
    }
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

}  // namespace

Json json_of(const Experiment& experiment, bool has_files) {
    Json json = written(experiment);
    complete(json, experiment, has_files);
    return json;
}

Json json_of(const AccuracyReport& report, bool has_files) {
    Json json = {{"format", "relief-accuracy"}, {"version", report_version}};
    json.update(written(report));
    json["machine"]["opengl"] = written(report.machine.opengl);
    for (std::size_t i = 0; i < report.experiments.size(); ++i)
        complete(json["experiments"][i], report.experiments[i], has_files);
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
    return about(file, [&] {
        const JsonCursor root(std::move(json), JsonCursor::Wording::type);
        check_format(root);
        AccuracyReport report;
        read(root, report);
        if (const auto opengl = root.at("machine").find_value("opengl"))
            report.machine.opengl = opengl->text();
        return report;
    });
}

}  // namespace relief::tools
