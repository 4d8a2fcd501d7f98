// SPDX-License-Identifier: Apache-2.0
// Draws the error of methods against their cost: a mark per method, and the line of efficient
// methods. Tests: tests/tools/accuracy_page/plots_test.cpp, and report_page_test.py in a browser.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <utility>

#include "plots.h"
#include "relief/accuracy/experiment.h"
#include "report_page.h"

namespace relief::tools {

using namespace plots;
using nlohmann::ordered_json;

namespace {

/// An axis of costs or errors.
struct AxisChoice {
    const char* value;
    const char* label;  ///< The label of its switch.
    const char* name;   ///< The name of the axis.
    const char* unit;
    const char* path;  ///< The path of its value in a measurement; empty: the order of the table.
};

constexpr std::array<AxisChoice, 4> all_costs = {
    {{"one_thread", "one thread", "time on one thread", "seconds", "/cost/one_thread/median"},
     {"all_threads", "all threads", "time on all threads", "seconds", "/cost/all_threads/median"},
     {"peak_bytes", "memory", "peak memory", "bytes", "/cost/peak_bytes"},
     {"stored_bytes", "size", "stored size", "bytes", "/cost/stored_bytes"}}};
constexpr AxisChoice no_cost = {"none", "none", "order of the table (no times)", "", ""};
constexpr std::array<AxisChoice, 4> all_errors = {
    {{"rms", "RMS", "RMS error", "", "/error/rms"},
     {"mean", "mean", "mean error", "", "/error/mean"},
     {"p99", "99 %", "99 % error", "", "/error/p99"},
     {"max", "max", "max error", "", "/error/max"}}};

/// Returns the costs that some method has.
std::vector<AxisChoice> costs_of(const ordered_json& measurements) {
    std::vector<AxisChoice> costs;
    for (const AxisChoice& cost : all_costs) {
        if (std::any_of(measurements.begin(), measurements.end(), [&](const ordered_json& one) {
                return number_at(one, cost.path).value_or(0.0) > 0.0;
            }))
            costs.push_back(cost);
    }
    if (costs.empty()) costs.push_back(no_cost);
    return costs;
}

std::string choice_of(const ordered_json& measurement, const std::string& name) {
    const auto choices = measurement.find("choices");
    return choices == measurement.end() ? "–" : choices->value(name, "–");
}

/// Returns the choices with more than one value.
std::vector<Legend> varying_choices(const ordered_json& measurements) {
    std::vector<Legend> choices;
    for (const ordered_json& one : measurements) {
        const ordered_json all = one.value("choices", ordered_json::object());
        for (const auto& [name, value] : all.items()) {
            if (std::none_of(choices.begin(), choices.end(),
                             [&name = name](const Legend& known) { return known.name == name; }))
                choices.push_back({name, {}});
        }
    }
    for (Legend& choice : choices) {
        for (const ordered_json& one : measurements) {
            const std::string value = choice_of(one, choice.name);
            if (std::none_of(choice.entries.begin(), choice.entries.end(),
                             [&](const LegendEntry& known) { return known.name == value; }))
                choice.entries.push_back({value, {}});
        }
    }
    std::erase_if(choices, [](const Legend& choice) { return choice.entries.size() < 2; });
    // Colors show the first choice and shapes the second, or both the only one.
    for (std::size_t c = 0; c < std::min<std::size_t>(choices.size(), 2); ++c) {
        for (std::size_t i = 0; i < choices[c].entries.size(); ++i) {
            const Look look = choices.size() == 1 ? Look{i, i}
                              : c == 0            ? Look{i, 0}
                                                  : Look{color_count - 1, i};
            choices[c].entries[i].look = look;
        }
    }
    return choices;
}

Look look_of(const ordered_json& measurement, const std::vector<Legend>& choices,
             std::size_t index) {
    if (choices.empty()) return {index, index};
    const auto place = [&](const Legend& choice) {
        const std::string value = choice_of(measurement, choice.name);
        const auto entry = std::find_if(choice.entries.begin(), choice.entries.end(),
                                        [&](const LegendEntry& one) { return one.name == value; });
        return static_cast<std::size_t>(entry - choice.entries.begin());
    };
    return {place(choices[0]), place(choices[std::min<std::size_t>(1, choices.size() - 1)])};
}

Value cost_of(const ordered_json& measurement, std::size_t index, const AxisChoice& cost) {
    const std::string path = cost.path;
    if (path.empty()) return static_cast<double>(index);
    const Value value = number_at(measurement, path);
    // A stored size of 0 is not a size.
    return path == "/cost/stored_bytes" && value == 0.0 ? std::nullopt : value;
}

/// Returns the range of the middle 80 % of the rounds, or nothing without times.
std::optional<std::pair<double, double>> range_of(const ordered_json& measurement,
                                                  const AxisChoice& cost) {
    if (std::string_view(cost.unit) != "seconds") return std::nullopt;
    const std::string path = std::string("/cost/") + cost.value;
    const Value p10 = number_at(measurement, path + "/p10");
    const Value p90 = number_at(measurement, path + "/p90");
    if (!p10 || !p90) return std::nullopt;
    return std::pair{*p10, *p90};
}

/// The methods of an experiment with their axes.
struct Scatter {
    const ordered_json& measurements;
    std::vector<AxisChoice> costs{};
    std::vector<AxisChoice> errors{};
    std::vector<Axis> x_axes{};  ///< One for each cost.
    std::vector<Axis> y_axes{};  ///< One for each error.
    std::vector<Legend> choices{};
    Area area{};

    [[nodiscard]] double x_of(std::size_t index, std::size_t cost) const {
        return x_axes[cost].place(cost_of(measurements[index], index, costs[cost]));
    }
    [[nodiscard]] double y_of(std::size_t index, std::size_t error) const {
        return y_axes[error].place(number_at(measurements[index], errors[error].path));
    }
    [[nodiscard]] bool has_undefined(std::size_t index) const {
        return number_at(measurements[index], "/error/undefined").value_or(0.0) > 0.0;
    }
};

/// \param has_choices  whether all choices of axes are drawn, or only the first
Scatter scatter_of(const ordered_json& experiment, bool has_choices) {
    Scatter scatter{.measurements = experiment.at("measurements")};
    const ordered_json& measurements = scatter.measurements;
    scatter.choices = varying_choices(measurements);
    scatter.costs = costs_of(measurements);
    scatter.errors.assign(all_errors.begin(), all_errors.end());
    if (!has_choices) {
        scatter.costs.resize(1);
        scatter.errors.resize(1);
    }
    for (const AxisChoice& cost : scatter.costs) {
        std::vector<Value> values;
        for (std::size_t i = 0; i < measurements.size(); ++i) {
            values.push_back(cost_of(measurements[i], i, cost));
            if (const auto range = range_of(measurements[i], cost))
                values.insert(values.end(), {range->first, range->second});
        }
        const bool has_cost = cost.path[0] != '\0';
        scatter.x_axes.push_back(x_axis(scatter.area, values, has_cost, cost.unit));
        if (!has_cost) scatter.x_axes.back().ticks.clear();
    }
    for (const AxisChoice& error : scatter.errors) {
        std::vector<Value> values;
        for (const ordered_json& one : measurements)
            values.push_back(number_at(one, error.path));
        scatter.y_axes.push_back(y_axis(scatter.area, values));
    }
    return scatter;
}

/// The positions of all methods for one choice of axes.
struct View {
    std::vector<double> x;
    std::vector<double> y;
    std::vector<std::size_t> efficient;  ///< By increasing cost.
};

View view_of(const Scatter& scatter, std::size_t cost, std::size_t error) {
    const ordered_json& measurements = scatter.measurements;
    View view;
    std::vector<MethodCost> costs;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        view.x.push_back(scatter.x_of(i, cost));
        view.y.push_back(scatter.y_of(i, error));
        const bool is_known = scatter.costs[cost].path[0] != '\0' && !scatter.has_undefined(i);
        const Value missed = number_at(measurements[i], scatter.errors[error].path);
        costs.push_back({is_known ? missed.value_or(NAN) : NAN,
                         cost_of(measurements[i], i, scatter.costs[cost]).value_or(NAN)});
    }
    const std::vector<bool> is_efficient = pareto_optimal(costs);
    for (std::size_t i = 0; i < costs.size(); ++i) {
        if (is_efficient[i]) view.efficient.push_back(i);
    }
    std::stable_sort(view.efficient.begin(), view.efficient.end(),
                     [&](std::size_t a, std::size_t b) {
                         return std::pair(costs[a].time, costs[a].error) <
                                std::pair(costs[b].time, costs[b].error);
                     });
    return view;
}

/// The position of a label relative to its point.
struct LabelPlace {
    double dx, dy;
    const char* anchor;
};
constexpr std::array<LabelPlace, 4> label_places = {
    {{9.0, -7.0, "start"}, {9.0, 15.0, "start"}, {-9.0, 15.0, "end"}, {-9.0, -7.0, "end"}}};

struct Box {
    double left, right, top, bottom;
};

/// Returns the index of each method's label_places, or nothing where it has no space. Labels
/// overlap neither each other nor points. Efficient methods come first; the labels of the others
/// show only if a filter makes them efficient.
std::vector<std::optional<std::size_t>> label_places_of(const View& view,
                                                        const ordered_json& measurements,
                                                        const Area& area) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < view.x.size(); ++i)
        boxes.push_back({view.x[i] - 5.0, view.x[i] + 5.0, view.y[i] - 5.0, view.y[i] + 5.0});
    std::vector<std::size_t> order = view.efficient;
    for (std::size_t i = 0; i < view.x.size(); ++i) {
        if (std::find(order.begin(), order.end(), i) == order.end()) order.push_back(i);
    }
    std::vector<std::optional<std::size_t>> places(view.x.size());
    for (const std::size_t i : order) {
        const double width = text_width(measurements[i].value("method", ""));
        for (std::size_t place = 0; place < label_places.size() && !places[i]; ++place) {
            const auto& [dx, dy, anchor] = label_places[place];
            const double left = view.x[i] + dx - (dx < 0.0 ? width : 0.0);
            const Box box = {left, left + width, view.y[i] + dy - 10.0, view.y[i] + dy + 3.0};
            const bool is_free = box.left >= area.left && box.right <= area.right &&
                                 box.top >= area.top && box.bottom <= area.bottom &&
                                 std::none_of(boxes.begin(), boxes.end(), [&](const Box& other) {
                                     return box.left < other.right && other.left < box.right &&
                                            box.top < other.bottom && other.top < box.bottom;
                                 });
            if (!is_free) continue;
            places[i] = place;
            boxes.push_back(box);
        }
    }
    return places;
}

/// Returns the smallest error for each cost as a step line.
std::string frontier(const View& view, const Area& area) {
    std::string path;
    for (const std::size_t i : view.efficient)
        path += path.empty() ? fmt::format("M{},{}V{}", px(view.x[i]), px(area.top), px(view.y[i]))
                             : fmt::format("H{}V{}", px(view.x[i]), px(view.y[i]));
    if (!path.empty()) path += "H" + px(area.right);
    return fmt::format(R"(<path class="frontier" d="{}" data-top="{}" data-right="{}"/>)", path,
                       px(area.top), px(area.right));
}

std::string hidden_unless(bool is_shown) {
    return is_shown ? "" : R"( display="none")";
}

/// Returns the axes of all choices. The first of each kind is visible.
std::string scatter_axes(const Scatter& scatter, const std::string& error_unit) {
    const auto group = [](const char* kind, const AxisChoice& choice, bool is_shown,
                          const std::string& drawn) {
        return fmt::format("<g class=\"{}\" data-path=\"{}\" aria-hidden=\"true\"{}>{}</g>\n", kind,
                           choice.path, hidden_unless(is_shown), drawn);
    };
    std::string axes;
    for (std::size_t c = 0; c < scatter.costs.size(); ++c) {
        const AxisChoice& cost = scatter.costs[c];
        axes += group("x-axis", cost, c == 0,
                      drawn_x_axis(scatter.area, scatter.x_axes[c], cost.name, "not timed"));
    }
    for (std::size_t e = 0; e < scatter.errors.size(); ++e) {
        const AxisChoice& error = scatter.errors[e];
        axes += group("y-axis", error, e == 0,
                      drawn_y_axis(scatter.area, scatter.y_axes[e],
                                   fmt::format("{}, {}", error.name, error_unit)));
    }
    return axes;
}

/// Returns a text for each method with a character for each choice of axes, all errors of the first
/// cost first: the index of its label_places, or "-".
std::vector<std::string> label_texts(const Scatter& scatter) {
    std::vector<std::string> texts(scatter.measurements.size());
    for (std::size_t c = 0; c < scatter.costs.size(); ++c) {
        for (std::size_t e = 0; e < scatter.errors.size(); ++e) {
            const auto places =
                label_places_of(view_of(scatter, c, e), scatter.measurements, scatter.area);
            for (std::size_t i = 0; i < texts.size(); ++i)
                texts[i] += places[i] ? static_cast<char>('0' + *places[i]) : '-';
        }
    }
    return texts;
}

/// Returns the bars of a method's times, one for each axis of times.
std::string whiskers(const Scatter& scatter, std::size_t index, std::size_t color) {
    std::string drawn;
    for (std::size_t c = 0; c < scatter.costs.size(); ++c) {
        const auto range = range_of(scatter.measurements[index], scatter.costs[c]);
        if (!range) continue;
        const double at = scatter.x_of(index, c);
        drawn +=
            fmt::format(R"(<line class="whisker {}" data-cost="{}" x1="{}" x2="{}"{}/>)",
                        hue(color), c, px(scatter.x_axes[c].place(range->first) - at),
                        px(scatter.x_axes[c].place(range->second) - at), hidden_unless(c == 0));
    }
    return drawn;
}

/// Returns the attributes with which the script moves a method's point.
std::string positions(const Scatter& scatter, std::size_t index, const std::string& labels) {
    std::string x;
    for (std::size_t c = 0; c < scatter.costs.size(); ++c)
        x += (c == 0 ? "" : " ") + px(scatter.x_of(index, c));
    std::string y;
    for (std::size_t e = 0; e < scatter.errors.size(); ++e)
        y += (e == 0 ? "" : " ") + px(scatter.y_of(index, e));
    return fmt::format(R"( data-index="{}" data-x="{}" data-y="{}" data-labels="{}")", index, x, y,
                       labels);
}

/// Returns the label of a method, hidden if it is not efficient or has no space.
/// \param place  of label_texts()
std::string label(const std::string& method, bool is_efficient, char place) {
    const bool is_shown = is_efficient && place != '-';
    const LabelPlace& at = label_places[is_shown ? static_cast<std::size_t>(place - '0') : 0];
    return fmt::format(
        "<text class=\"point-label\" x=\"{}\" y=\"{}\" text-anchor=\"{}\" aria-hidden=\"true\"{}>{}"
        "</text>",
        px(at.dx), px(at.dy), at.anchor, hidden_unless(is_shown), html_escaped(method));
}

/// \param tips  the text of each method's tooltip; empty for a picture that no script changes
Plot scatter_plot(const ordered_json& experiment, const std::vector<std::string>& tips) {
    const bool is_live = !tips.empty();
    const Scatter scatter = scatter_of(experiment, is_live);
    const ordered_json& measurements = scatter.measurements;
    const View view = view_of(scatter, 0, 0);
    const std::vector<std::string> labels = label_texts(scatter);
    Plot plot;
    plot.legends = scatter.choices;
    plot.body = scatter_axes(scatter, experiment.value("error_unit", "")) +
                frontier(view, scatter.area) + "\n";
    std::vector<std::size_t> order(measurements.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return view.x[a] < view.x[b]; });
    for (const std::size_t i : order) {
        const Look look = look_of(measurements[i], scatter.choices, i);
        const bool is_efficient =
            std::find(view.efficient.begin(), view.efficient.end(), i) != view.efficient.end();
        plot.body +=
            fmt::format(
                "<g class=\"point{}{}\"{} transform=\"translate({},{})\">",
                scatter.has_undefined(i) ? " partial" : "", is_efficient ? " efficient" : "",
                is_live ? positions(scatter, i, labels[i]) : "", px(view.x[i]), px(view.y[i])) +
            (is_live ? tooltip(tips[i]) : "") + whiskers(scatter, i, look.color) + mark(look);
        if (is_live || (is_efficient && labels[i] != "-"))
            plot.body += label(measurements[i].value("method", ""), is_efficient, labels[i][0]);
        plot.body += "</g>\n";
    }
    std::vector<std::string> names;
    for (const std::size_t i : view.efficient)
        names.push_back(measurements[i].value("method", ""));
    plot.label = fmt::format("{} against {}: {} methods.", scatter.errors[0].name,
                             scatter.costs[0].name, measurements.size());
    if (!names.empty()) plot.label += fmt::format(" Efficient: {}.", fmt::join(names, "; "));
    return plot;
}

/// Returns a row of radio buttons.
std::string switch_html(const char* legend, const char* axis, const std::string& group,
                        std::span<const AxisChoice> choices) {
    std::string labels;
    for (std::size_t i = 0; i < choices.size(); ++i)
        labels += fmt::format(
            "<label><input type=\"radio\" name=\"{}-{}\" value=\"{}\"{}><span>{}</span></label>",
            axis, html_escaped(group), choices[i].value, i == 0 ? " checked" : "",
            choices[i].label);
    return fmt::format(
        "<fieldset class=\"switch\" data-axis=\"{}\"><legend>{}</legend>{}</fieldset>\n", axis,
        legend, labels);
}

}  // namespace

std::string scatter_figure(const ordered_json& experiment, const std::vector<std::string>& tips) {
    const Plot plot = scatter_plot(experiment, tips);
    const std::vector<AxisChoice> costs = costs_of(experiment.at("measurements"));
    const std::string group = experiment.value("id", "");
    std::string html =
        "<figure class=\"scatter\"><figcaption><h4>Error against cost</h4></figcaption>\n"
        "<div class=\"switches\">";
    if (costs.size() > 1) html += switch_html("Cost", "x", group, costs);
    html += switch_html("Error", "y", group, all_errors) + "</div>\n" + page_svg(plot);
    if (!plot.legends.empty()) {
        html += "<details class=\"filters\" open><summary>Legend and filter</summary>\n";
        for (const Legend& legend : plot.legends)
            html += legend_html(legend);
        html += "</details>\n";
    }
    return html + "</figure>\n";
}

std::string scatter_picture(const ordered_json& experiment) {
    return svg_file(scatter_plot(experiment, {}));
}

}  // namespace relief::tools
