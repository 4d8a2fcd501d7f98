// SPDX-License-Identifier: Apache-2.0
// Draws plots as SVG: axes and their ticks, marks of methods with the line of efficient ones, and
// error curves with fitted slopes, the bound, and the points where methods break.
#include "plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <tuple>
#include <utility>

#include "common/html.h"
#include "relief/accuracy/experiment.h"
#include "report_page.h"

namespace relief::tools {
using nlohmann::ordered_json;

Value number_at(const ordered_json& json, const std::string& path) {
    const ordered_json::json_pointer pointer(path);
    if (!json.contains(pointer) || !json.at(pointer).is_number()) return std::nullopt;
    const double value = json.at(pointer).get<double>();
    return std::isfinite(value) ? Value(value) : std::nullopt;
}

// Axes and their ticks.

namespace {

/// The plot, and the area within its axes.
constexpr double plot_width = 826.0, plot_height = 440.0;
constexpr double left = 62.0, right = 808.0, top = 30.0, bottom = 394.0;

/// Returns the range of an axis: the range of its numbers with a margin.
std::pair<double, double> padded(const std::vector<double>& numbers, bool is_log) {
    if (numbers.empty()) return is_log ? std::pair{0.1, 10.0} : std::pair{0.0, 1.0};
    const auto [min, max] = std::minmax_element(numbers.begin(), numbers.end());
    if (is_log) {
        const double ratio = *max / *min;
        const double margin = std::max(0.08 * std::log10(ratio), ratio < 1.5 ? 0.15 : 0.05);
        return {*min / std::pow(10.0, margin), *max * std::pow(10.0, margin)};
    }
    double margin = 0.06 * (*max - *min);
    if (margin == 0.0) margin = *max != 0.0 ? 0.1 * std::abs(*max) : 1.0;
    return {*min - margin, *max + margin};
}

/// \param begin, end  the coordinates of the smallest and the largest value
/// \param spacing     the minimum distance of labeled ticks
Axis make_axis(const std::vector<Value>& values, bool is_log, double begin, double end,
               const std::string& unit, double spacing) {
    constexpr double strip = 34.0;  // The width of a strip.
    Axis axis{.is_log = is_log, .unit = unit};
    std::vector<double> shown;
    for (const Value& value : values) {
        const bool is_number = value && std::isfinite(*value);
        axis.has_missing = axis.has_missing || !is_number;
        axis.has_zero = axis.has_zero || (is_number && is_log && *value <= 0.0);
        if (is_number && (!is_log || *value > 0.0)) shown.push_back(*value);
    }
    const double way = end > begin ? 1.0 : -1.0;
    axis.from = begin + (axis.has_zero ? way * strip : 0.0);
    axis.to = end - (axis.has_missing ? way * strip : 0.0);
    axis.zero_at = begin + way * strip / 2.0;
    axis.missing_at = end - way * strip / 2.0;
    std::tie(axis.low, axis.high) = padded(shown, is_log);
    if (!shown.empty())
        axis.ticks = ticks_of(axis.low, axis.high, is_log, std::abs(axis.to - axis.from) / spacing);
    return axis;
}

std::vector<double> linear_ticks(double low, double high, double room) {
    const double rough = (high - low) / room;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    double step = 10.0 * power;
    for (const double factor : {5.0, 2.0, 1.0}) {
        if (factor * power >= rough) step = factor * power;
    }
    std::vector<double> ticks;
    for (double i = std::ceil(low / step); i * step <= high; ++i)
        ticks.push_back(std::stod(fmt::format("{:.11e}", i * step)));
    return ticks;
}

}  // namespace

double Axis::place(Value value) const {
    if (!value || !std::isfinite(*value)) return missing_at;
    if (is_log && *value <= 0.0) return zero_at;
    const auto measure = [&](double one) { return is_log ? std::log10(one) : one; };
    return from + (to - from) * (measure(*value) - measure(low)) / (measure(high) - measure(low));
}

Axis x_axis(const std::vector<Value>& values, bool is_log, const std::string& unit) {
    return make_axis(values, is_log, left, right, unit, 64.0);
}

Axis y_axis(const std::vector<Value>& errors) {
    return make_axis(errors, true, bottom, top, "", 32.0);
}

std::vector<double> ticks_of(double low, double high, bool is_log, double room) {
    room = std::max(2.0, std::floor(room));
    if (!is_log) return linear_ticks(low, high, room);
    const double decades = std::log10(high / low);
    const bool has_steps = decades * 3.0 <= room || decades <= 1.2;
    const int every = std::max(1, static_cast<int>(std::ceil(decades / room)));
    std::vector<double> ticks;
    for (int power = static_cast<int>(std::floor(std::log10(low))); power <= std::log10(high);
         ++power) {
        for (const int step : {1, 2, 5}) {
            const double value = std::stod(fmt::format("{}e{}", step, power));
            const bool is_shown = (step == 1 || has_steps) && power % every == 0;
            if (is_shown && value >= low && value <= high) ticks.push_back(value);
        }
    }
    return ticks.size() >= 2 ? ticks : linear_ticks(low, high, std::min(room, 4.0));
}

std::string tick_text(double value, const std::string& unit) {
    const auto in_digits = [](double number) {
        return fmt::format("{}", std::stod(fmt::format("{:.2e}", number)));
    };
    using Units = std::vector<std::pair<double, const char*>>;
    static const std::map<std::string, Units> all_units = {
        {"seconds", {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "µs"}, {1e-9, "ns"}}},
        {"bytes", {{1e9, "GB"}, {1e6, "MB"}, {1e3, "kB"}, {1.0, "B"}}}};
    if (const auto units = all_units.find(unit); units != all_units.end()) {
        const auto chosen =
            std::find_if(units->second.begin(), units->second.end() - 1,
                         [&](const auto& one) { return value >= one.first * 0.9999; });
        return fmt::format("{} {}", in_digits(value / chosen->first), chosen->second);
    }
    const double size = std::abs(value);
    if (size == 0.0 || (size >= 0.001 && size < 1e5)) return in_digits(value);
    const std::string text = fmt::format("{:.0e}", value);
    const std::size_t e = text.find('e');
    static constexpr std::array<std::string_view, 10> raised = {"⁰", "¹", "²", "³", "⁴",
                                                                "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string power;
    for (const char digit : std::to_string(std::stoi(text.substr(e + 1))))
        power += digit == '-' ? "⁻" : raised[static_cast<std::size_t>(digit - '0')];
    const std::string digits = text.substr(0, e);
    return digits == "1" ? "10" + power : digits + "·10" + power;
}

// The parts of plots.

namespace {

constexpr std::size_t color_count = 10;  // The classes hue-0 to hue-9 of plot.css.
constexpr std::array<std::string_view, 8> shapes = {
    "M-4.2,0a4.2,4.2 0 1,0 8.4,0a4.2,4.2 0 1,0 -8.4,0Z",
    "M-3.8,-3.8h7.6v7.6h-7.6Z",
    "M0,-5L4.6,3.4H-4.6Z",
    "M0,-5.4L4.6,0L0,5.4L-4.6,0Z",
    "M0,5L4.6,-3.4H-4.6Z",
    "M-1.5,-4.8h3v3.3h3.3v3h-3.3v3.3h-3v-3.3h-3.3v-3h3.3Z",
    "M0,-5.2L1.5,-1.7L5.2,-1.5L2.3,0.9L3.3,4.6L0,2.5L-3.3,4.6L-2.3,0.9L-5.2,-1.5L-1.5,-1.7Z",
    "M-5,-2.3L-2.3,-5H2.3L5,-2.3V2.3L2.3,5H-2.3L-5,2.3Z"};

std::string hue(std::size_t color) {
    return fmt::format("hue-{}", color % color_count);
}

std::string mark(std::size_t color, std::size_t shape) {
    return fmt::format(R"(<path class="mark {}" d="{}"/>)", hue(color),
                       shapes.at(shape % shapes.size()));
}

/// Returns a coordinate with at most one decimal.
std::string px(double value) {
    std::string text = fmt::format("{:.1f}", value);
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

/// Returns about the width of a text.
double text_width(const std::string& text) {
    constexpr double width_of_letter = 6.1;  // The mean at a height of 11.5.
    return width_of_letter * static_cast<double>(code_points_in(text));
}

std::string line(double x1, double y1, double x2, double y2) {
    return fmt::format(R"(<line x1="{}" y1="{}" x2="{}" y2="{}"/>)", px(x1), px(y1), px(x2),
                       px(y2));
}

/// Returns the grid, ticks, strips and names of both axes.
/// \param missing  the label of the strip of values without x
std::string drawn_axes(const Axis& x, const std::string& x_name, const std::string& missing,
                       const Axis& y, const std::string& y_name) {
    const auto below = [](double at, const std::string& text) {
        return fmt::format(R"(<text x="{}" y="{}" text-anchor="middle">{}</text>)", px(at),
                           px(bottom + 18.0), text);
    };
    const auto beside = [](double at, const std::string& text) {
        return fmt::format(R"(<text x="{}" y="{}" dy="0.34em" text-anchor="end">{}</text>)",
                           px(left - 8.0), px(at), text);
    };
    std::string grid, strips;
    double free = -std::numeric_limits<double>::infinity();
    for (const double tick : x.ticks) {
        const double at = x.place(tick);
        grid += line(at, top, at, bottom);
        const std::string text = tick_text(tick, x.unit);
        const double half = 0.56 * text_width(text);
        if (at - half < free) continue;
        free = at + half + 6.0;
        grid += below(at, text);
    }
    for (const double tick : y.ticks) {
        const double at = y.place(tick);
        grid += line(left, at, right, at) + beside(at, tick_text(tick, ""));
    }
    if (x.has_zero) strips += line(x.from, top, x.from, bottom) + below(x.zero_at, "0");
    if (x.has_missing) strips += line(x.to, top, x.to, bottom) + below(x.missing_at, missing);
    if (y.has_zero) strips += line(left, y.from, right, y.from) + beside(y.zero_at, "exact");
    if (y.has_missing) strips += line(left, y.to, right, y.to) + beside(y.missing_at, "no result");
    return fmt::format(
        "<g aria-hidden=\"true\"><g class=\"grid\">{}</g><g class=\"strips\">{}</g>"
        "<text class=\"axis-name\" x=\"10\" y=\"18\">↑ {}</text>"
        "<text class=\"axis-name\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{} →</text></g>\n",
        grid, strips, html_escaped(y_name), px(right), px(bottom + 38.0), html_escaped(x_name));
}

/// Returns a point with its tooltip, and an area to point at.
/// \param classes  more classes, after a space
std::string point(std::size_t index, double x, double y, const std::string& classes,
                  const std::string& tip, const std::string& content) {
    return fmt::format(
        "<g class=\"point{}\" data-index=\"{}\" transform=\"translate({},{})\">{}{}</g>\n", classes,
        index, px(x), px(y),
        tip.empty() ? ""
                    : "<title>" + html_escaped(tip) + "</title><circle class=\"reach\" r=\"11\"/>",
        content);
}

}  // namespace

std::string plot_html(const Plot& plot) {
    std::string html = fmt::format(
        "<div class=\"plot\"><svg viewBox=\"0 0 {} {}\" role=\"group\" aria-label=\"{}\">\n"
        "{}</svg></div>\n",
        plot_width, plot_height, html_escaped(plot.label), plot.body);
    for (const Legend& legend : plot.legends) {
        html += fmt::format("<fieldset class=\"choice\"><legend>{}</legend>\n",
                            html_escaped(legend.name));
        for (const LegendEntry& entry : legend.entries) {
            html += fmt::format(
                "<label><input type=\"checkbox\" checked data-members=\"{}\">{}{} "
                "<small>{}</small></label>\n",
                fmt::join(entry.members, " "),
                entry.has_mark ? "<svg viewBox=\"-7 -7 14 14\" width=\"14\" height=\"14\">" +
                                     mark(entry.color, entry.shape) + "</svg>"
                               : "",
                html_escaped(entry.name), html_escaped(entry.remark));
        }
        html += "</fieldset>\n";
    }
    return html;
}

std::string svg_file(const Plot& plot) {
    std::string drawn;
    double y = plot_height;
    for (const Legend& legend : plot.legends) {
        if (legend.entries.empty() || !legend.entries[0].has_mark) continue;
        double x = 24.0;
        y += 20.0;
        for (const LegendEntry& entry : legend.entries) {
            const double room = 30.0 + 1.08 * text_width(entry.name);
            if (x + room > plot_width && x > 24.0) {
                x = 24.0;
                y += 20.0;
            }
            drawn += fmt::format(
                "<g transform=\"translate({},{})\">{}<text class=\"legend\" x=\"10\" y=\"4\">{}"
                "</text></g>\n",
                px(x), px(y), mark(entry.color, entry.shape), html_escaped(entry.name));
            x += room;
        }
    }
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" viewBox=\"0 0 {0} {1}\" "
        "width=\"{0}\" height=\"{1}\" role=\"img\">\n<title>{2}</title>\n<style>\n{3}</style>\n"
        "<rect class=\"sheet\" width=\"100%\" height=\"100%\" rx=\"8\"/>\n{4}{5}</svg>\n",
        px(plot_width), px(drawn.empty() ? plot_height : y + 16.0), html_escaped(plot.label),
        report_part("plot.css"), plot.body, drawn);
}

// Methods.

namespace {

/// A cost that can be the axis of a plot.
struct CostAxis {
    const char* name;
    const char* unit;
    const char* path;  ///< Of its value in a measurement; empty: the order of the table.
    const char* p10 = "";
    const char* p90 = "";
};
constexpr std::array<CostAxis, 5> cost_axes = {
    {{"time on one thread", "seconds", "/cost/one_thread/median", "/cost/one_thread/p10",
      "/cost/one_thread/p90"},
     {"time on all threads", "seconds", "/cost/all_threads/median", "/cost/all_threads/p10",
      "/cost/all_threads/p90"},
     {"peak memory", "bytes", "/cost/peak_bytes"},
     {"stored size", "bytes", "/cost/stored_bytes"},
     {"order of the table (no times)", "", ""}}};

/// Returns the first cost that some method has.
CostAxis cost_axis(const ordered_json& measurements) {
    return *std::find_if(cost_axes.begin(), cost_axes.end() - 1, [&](const CostAxis& cost) {
        return std::any_of(measurements.begin(), measurements.end(), [&](const ordered_json& one) {
            return number_at(one, cost.path).value_or(0.0) > 0.0;
        });
    });
}

/// Returns a legend for each choice with more than one value.
std::vector<Legend> varying_choices(const ordered_json& measurements) {
    std::vector<Legend> choices;
    for (const ordered_json& one : measurements) {
        const ordered_json all = one.value("choices", ordered_json::object());
        for (const auto& [name, value] : all.items()) {
            if (std::none_of(choices.begin(), choices.end(), [&wanted = name](const Legend& known) {
                    return known.name == wanted;
                }))
                choices.push_back({name, {}});
        }
    }
    for (Legend& choice : choices) {
        for (std::size_t i = 0; i < measurements.size(); ++i) {
            const ordered_json all = measurements[i].value("choices", ordered_json::object());
            const std::string value = all.value(choice.name, "–");
            auto entry = std::find_if(choice.entries.begin(), choice.entries.end(),
                                      [&](const LegendEntry& one) { return one.name == value; });
            if (entry == choice.entries.end())
                entry = choice.entries.insert(entry, {.name = value});
            entry->members.push_back(i);
        }
    }
    std::erase_if(choices, [](const Legend& choice) { return choice.entries.size() < 2; });
    // Colors show the first choice and shapes the second, or both the only one.
    for (std::size_t c = 0; c < std::min<std::size_t>(choices.size(), 2); ++c) {
        for (std::size_t i = 0; i < choices[c].entries.size(); ++i) {
            LegendEntry& entry = choices[c].entries[i];
            entry.has_mark = true;
            entry.color = c == 0 ? i : color_count - 1;
            entry.shape = c == 1 || choices.size() == 1 ? i : 0;
        }
    }
    return choices;
}

/// Returns the entry of a choice that a method has.
std::size_t entry_of(const Legend& choice, std::size_t index) {
    const auto has_method = [&](const LegendEntry& one) {
        return std::find(one.members.begin(), one.members.end(), index) != one.members.end();
    };
    return static_cast<std::size_t>(
        std::find_if(choice.entries.begin(), choice.entries.end(), has_method) -
        choice.entries.begin());
}

/// A method with its position.
struct Dot {
    std::size_t index = 0;
    double x = 0.0, y = 0.0;
    Value cost{}, p10{}, p90{};
    bool is_partial = false;    ///< It has undefined results.
    bool is_efficient = false;  ///< By the times of the report, or else by the cost.
};

/// Returns the methods by increasing cost.
std::vector<Dot> dots_of(const ordered_json& measurements, const CostAxis& cost) {
    const bool is_time = std::string_view(cost.unit) == "seconds";
    std::vector<Dot> dots;
    std::vector<accuracy::MethodCost> costs;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        const ordered_json& one = measurements[i];
        Dot& dot = dots.emplace_back(Dot{.index = i});
        dot.cost = *cost.path != '\0' ? number_at(one, cost.path) : static_cast<double>(i);
        if (is_time) dot.p10 = number_at(one, cost.p10), dot.p90 = number_at(one, cost.p90);
        dot.is_partial = number_at(one, "/error/undefined").value_or(0.0) > 0.0;
        dot.is_efficient = one.value("efficient", false);
        const bool is_known = *cost.path != '\0' && !dot.is_partial;
        costs.push_back(
            {is_known ? number_at(one, "/error/rms").value_or(NAN) : NAN, dot.cost.value_or(NAN)});
    }
    if (!is_time) {
        const std::vector<bool> marks = accuracy::pareto_optimal(costs);
        for (Dot& dot : dots)
            dot.is_efficient = marks[dot.index];
    }
    return dots;
}

/// Returns the label of a method, unless it overlaps the last one.
std::string label_of(const Dot& dot, const std::string& method, Dot& last) {
    const bool is_left = dot.x + 9.0 + text_width(method) > right;
    if (std::abs(dot.y - last.y) < 13.0 && dot.x < last.x) return "";
    last = {.x = dot.x + 9.0 + text_width(method), .y = dot.y};
    return fmt::format(
        "<text class=\"point-label\" x=\"{}\" y=\"-7\" text-anchor=\"{}\" "
        "aria-hidden=\"true\">{}</text>",
        is_left ? "-9" : "9", is_left ? "end" : "start", html_escaped(method));
}

}  // namespace

Plot scatter_plot(const ordered_json& experiment, const std::vector<std::string>& tips) {
    const ordered_json& measurements = experiment.at("measurements");
    const CostAxis cost = cost_axis(measurements);
    std::vector<Dot> dots = dots_of(measurements, cost);
    std::vector<Value> costs, errors;
    for (const Dot& dot : dots) {
        costs.push_back(dot.cost);
        if (dot.p10 && dot.p90) costs.insert(costs.end(), {dot.p10, dot.p90});
        errors.push_back(number_at(measurements[dot.index], "/error/rms"));
    }
    Axis x = x_axis(costs, *cost.path != '\0', cost.unit);
    if (*cost.path == '\0') x.ticks.clear();
    const Axis y = y_axis(errors);
    for (Dot& dot : dots) {
        dot.x = x.place(dot.cost);
        dot.y = y.place(errors[dot.index]);
    }
    std::stable_sort(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) {
        return std::pair(a.x, -a.y) < std::pair(b.x, -b.y);
    });
    Plot plot;
    plot.legends = varying_choices(measurements);
    std::string frontier, marks;
    std::vector<std::string> names;
    Dot last{.y = -plot_height};
    for (const Dot& dot : dots) {
        const std::string method = measurements[dot.index].value("method", "");
        std::size_t color = dot.index, shape = dot.index;
        if (!plot.legends.empty()) {
            color = entry_of(plot.legends[0], dot.index);
            shape = plot.legends.size() == 1 ? color : entry_of(plot.legends[1], dot.index);
        }
        std::string content;
        if (dot.p10 && dot.p90)
            content = fmt::format(R"(<line class="whisker {}" x1="{}" x2="{}"/>)", hue(color),
                                  px(x.place(dot.p10) - dot.x), px(x.place(dot.p90) - dot.x));
        content += mark(color, shape);
        if (dot.is_efficient) {
            names.push_back(method);
            content += label_of(dot, method, last);
            frontier += frontier.empty() ? fmt::format("M{},{}V{}", px(dot.x), px(top), px(dot.y))
                                         : fmt::format("H{}V{}", px(dot.x), px(dot.y));
        }
        marks += point(
            dot.index, dot.x, dot.y,
            std::string(dot.is_partial ? " partial" : "") + (dot.is_efficient ? " efficient" : ""),
            tips.empty() ? "" : tips[dot.index], content);
    }
    if (!frontier.empty()) frontier += "H" + px(right);
    plot.body = drawn_axes(x, cost.name, "not timed", y,
                           "RMS error, " + experiment.value("error_unit", "")) +
                fmt::format("<path class=\"frontier\" d=\"{}\"/>\n", frontier) + marks;
    plot.label = fmt::format("RMS error against {}: {} methods.", cost.name, measurements.size());
    if (!names.empty()) plot.label += fmt::format(" Efficient: {}.", fmt::join(names, "; "));
    return plot;
}

// Curves.

namespace {

std::string signed_text(const std::string& number) {
    return number.starts_with('-') ? "−" + number.substr(1) : number;
}

/// Returns "slope 1.98, theory 2, breaks at 10⁻⁶".
std::string curve_words(const ordered_json& curve) {
    std::vector<std::string> words;
    if (const Value order = number_at(curve, "/order"))
        words.push_back("slope " + signed_text(fmt::format("{:.2f}", *order)));
    if (const Value expected = number_at(curve, "/expected_order"))
        words.push_back("theory " +
                        signed_text(fmt::format("{}", std::round(*expected * 100.0) / 100.0)));
    if (const Value breaks = number_at(curve, "/breaks_at"))
        words.push_back("breaks at " + tick_text(*breaks, ""));
    return fmt::format("{}", fmt::join(words, ", "));
}

/// Returns a line with the fitted slope through the mean of the points, on logarithmic axes.
std::string fit(const ordered_json& curve, std::size_t index, const Axis& x, const Axis& y) {
    const Value order = number_at(curve, "/order");
    if (!order || !x.is_log) return "";
    std::vector<double> known;
    double level = 0.0;
    for (const ordered_json& one : curve.at("points")) {
        const double at = one.at(0).get<double>();
        const double error = number_at(one, "/1").value_or(0.0);
        if (!(at > 0.0 && error > 0.0)) continue;
        known.push_back(at);
        level += std::log(error) - *order * std::log(at);
    }
    if (known.size() < 2) return "";
    level /= static_cast<double>(known.size());
    const auto fitted = [&](double at) {
        return px(y.place(std::exp(level + *order * std::log(at))));
    };
    return fmt::format(
        "<line class=\"fit {}\" data-index=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>\n",
        hue(index), index, px(x.place(known.front())), fitted(known.front()),
        px(x.place(known.back())), fitted(known.back()));
}

}  // namespace

Plot curves_plot(const ordered_json& chart, const std::vector<std::string>& tips) {
    const ordered_json& curves = chart.at("curves");
    std::vector<Value> along, errors;
    for (const ordered_json& curve : curves) {
        for (const ordered_json& one : curve.at("points")) {
            along.emplace_back(one.at(0).get<double>());
            errors.push_back(number_at(one, "/1"));
        }
    }
    const Value bound = number_at(chart, "/bound");
    if (bound) errors.push_back(bound);
    const Axis x = x_axis(along, chart.value("x_log", true), "");
    const Axis y = y_axis(errors);
    const std::string x_label = chart.value("x_label", ""), y_label = chart.value("y_label", "");
    Plot plot{.body = drawn_axes(x, x_label, "none", y, y_label), .legends = {{"curves", {}}}};
    if (bound)
        plot.body +=
            fmt::format("<g class=\"bound\">{}<text x=\"{}\" y=\"{}\">bound {}</text></g>\n",
                        line(left, y.place(bound), right, y.place(bound)), px(left + 6.0),
                        px(y.place(bound) - 5.0), tick_text(*bound, ""));
    std::vector<std::string> words;
    std::size_t next = 0;  // The tip of the next point.
    for (std::size_t i = 0; i < curves.size(); ++i) {
        plot.body += fit(curves[i], i, x, y);
        const ordered_json& points = curves[i].at("points");
        const Value breaks_at = number_at(curves[i], "/breaks_at");
        // The line has gaps at missing results and at errors of 0, which are in the strip.
        std::string path, marks;
        bool is_down = false;
        for (const ordered_json& one : points) {
            const double at = one.at(0).get<double>();
            const Value error = number_at(one, "/1");
            const bool is_on_axis = error && *error > 0.0;
            if (is_on_axis)
                path += (is_down ? "L" : "M") + px(x.place(at)) + "," + px(y.place(error));
            is_down = is_on_axis;
            marks +=
                point(i, x.place(at), y.place(error), points.size() > 24 ? " dense" : "",
                      tips.empty() ? "" : tips[next++],
                      (breaks_at == at ? R"(<circle class="breaks" r="9"/>)" : "") + mark(i, i));
        }
        plot.body += fmt::format("<path class=\"line {}\" data-index=\"{}\" d=\"{}\"/>\n{}", hue(i),
                                 i, path, marks);
        const std::string method = curves[i].value("method", "");
        const std::string remark = curve_words(curves[i]);
        plot.legends[0].entries.push_back({method, remark, i, i, true, {i}});
        words.push_back(remark.empty() ? method : method + ", " + remark);
    }
    plot.label = fmt::format("{} against {}: {}.", y_label, x_label, fmt::join(words, "; "));
    return plot;
}

}  // namespace relief::tools
