// SPDX-License-Identifier: Apache-2.0
// Draws the parts of plots as SVG; and error curves: a line per method on logarithmic axes, with
// fitted slopes, the bound, and the points where methods break. Tests:
// tests/tools/accuracy_page/plots_test.cpp, and report_page_test.py in a browser.
#include "plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <tuple>
#include <utility>

#include "report_page.h"

namespace relief::tools::plots {

Value number_at(const nlohmann::ordered_json& json, const std::string& path) {
    const nlohmann::ordered_json::json_pointer pointer(path);
    if (!json.contains(pointer) || !json.at(pointer).is_number()) return std::nullopt;
    return json.at(pointer).get<double>();
}

// Marks and texts.

namespace {

constexpr std::array<std::string_view, 8> shapes = {
    "M-4.2,0a4.2,4.2 0 1,0 8.4,0a4.2,4.2 0 1,0 -8.4,0Z",
    "M-3.8,-3.8h7.6v7.6h-7.6Z",
    "M0,-5L4.6,3.4H-4.6Z",
    "M0,-5.4L4.6,0L0,5.4L-4.6,0Z",
    "M0,5L4.6,-3.4H-4.6Z",
    "M-1.5,-4.8h3v3.3h3.3v3h-3.3v3.3h-3v-3.3h-3.3v-3h3.3Z",
    "M0,-5.2L1.5,-1.7L5.2,-1.5L2.3,0.9L3.3,4.6L0,2.5L-3.3,4.6L-2.3,0.9L-5.2,-1.5L-1.5,-1.7Z",
    "M-5,-2.3L-2.3,-5H2.3L5,-2.3V2.3L2.3,5H-2.3L-5,2.3Z",
};

}  // namespace

std::string hue(std::size_t color) {
    return fmt::format("hue-{}", color % color_count);
}

std::string mark(Look look) {
    return fmt::format(R"(<path class="mark {}" d="{}"/>)", hue(look.color),
                       shapes[look.shape % shapes.size()]);
}

std::string px(double value) {
    std::string text = fmt::format("{:.1f}", value);
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

double text_width(const std::string& text) {
    constexpr double width_of_letter = 6.1;  // The mean at a height of 11.5.
    return width_of_letter *
           static_cast<double>(std::count_if(text.begin(), text.end(),
                                             [](char byte) { return (byte & 0xC0) != 0x80; }));
}

// Axes and their ticks.

namespace {

/// Returns the range of an axis: the range of its numbers with a margin.
std::pair<double, double> padded(const std::vector<double>& numbers, bool is_log) {
    if (numbers.empty()) return is_log ? std::pair{0.1, 10.0} : std::pair{0.0, 1.0};
    const auto [least, greatest] = std::minmax_element(numbers.begin(), numbers.end());
    const double low = *least;
    const double high = *greatest;
    if (is_log) {
        const double margin =
            std::max(0.08 * std::log10(high / low), high / low < 1.5 ? 0.15 : 0.05);
        return {low / std::pow(10.0, margin), high * std::pow(10.0, margin)};
    }
    double margin = 0.06 * (high - low);
    if (margin == 0.0) margin = high != 0.0 ? 0.1 * std::abs(high) : 1.0;
    return {low - margin, high + margin};
}

/// \param begin, end  the coordinates of the smallest and the largest value
/// \param spacing     the minimum distance of labeled ticks in pixels
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

Axis x_axis(const Area& area, const std::vector<Value>& values, bool is_log,
            const std::string& unit) {
    return make_axis(values, is_log, area.left, area.right, unit, 64.0);
}

Axis y_axis(const Area& area, const std::vector<Value>& errors) {
    return make_axis(errors, true, area.bottom, area.top, "", 32.0);
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
        auto chosen = units->second.back();
        for (const auto& [size, name] : units->second) {
            if (value < size * 0.9999) continue;
            chosen = {size, name};
            break;
        }
        return fmt::format("{} {}", in_digits(value / chosen.first), chosen.second);
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

namespace {

std::string line(double x1, double y1, double x2, double y2) {
    return fmt::format(R"(<line x1="{}" y1="{}" x2="{}" y2="{}"/>)", px(x1), px(y1), px(x2),
                       px(y2));
}

std::string text_left_of(const Area& area, double y, const std::string& text) {
    return fmt::format(R"(<text x="{}" y="{}" dy="0.34em" text-anchor="end">{}</text>)",
                       px(area.left - 8.0), px(y), text);
}

std::string text_below(const Area& area, double x, const std::string& text) {
    return fmt::format(R"(<text x="{}" y="{}" text-anchor="middle">{}</text>)", px(x),
                       px(area.bottom + 18.0), text);
}

}  // namespace

std::string drawn_x_axis(const Area& area, const Axis& x, const std::string& name,
                         const std::string& missing) {
    std::string grid;
    double free = -std::numeric_limits<double>::infinity();
    for (const double tick : x.ticks) {
        const double at = x.place(tick);
        grid += line(at, area.top, at, area.bottom);
        const std::string text = tick_text(tick, x.unit);
        const double half = 0.56 * text_width(text);
        if (at - half < free) continue;
        free = at + half + 6.0;
        grid += text_below(area, at, text);
    }
    std::string strips;
    if (x.has_zero)
        strips += line(x.from, area.top, x.from, area.bottom) + text_below(area, x.zero_at, "0");
    if (x.has_missing)
        strips += line(x.to, area.top, x.to, area.bottom) + text_below(area, x.missing_at, missing);
    return fmt::format(
        "<g class=\"grid\">{}</g><g class=\"strips\">{}</g>"
        "<text class=\"axis-name\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{} →</text>",
        grid, strips, px(area.right), px(area.bottom + 38.0), html_escaped(name));
}

std::string drawn_y_axis(const Area& area, const Axis& y, const std::string& name) {
    std::string grid;
    for (const double tick : y.ticks) {
        const double at = y.place(tick);
        grid += line(area.left, at, area.right, at) + text_left_of(area, at, tick_text(tick, ""));
    }
    std::string strips;
    if (y.has_zero)
        strips +=
            line(area.left, y.from, area.right, y.from) + text_left_of(area, y.zero_at, "exact");
    if (y.has_missing)
        strips +=
            line(area.left, y.to, area.right, y.to) + text_left_of(area, y.missing_at, "no result");
    return fmt::format(
        "<g class=\"grid\">{}</g><g class=\"strips\">{}</g>"
        "<text class=\"axis-name\" x=\"10\" y=\"18\">↑ {}</text>",
        grid, strips, html_escaped(name));
}

// The plot and its legend.

namespace {

constexpr double plot_width = 826.0;
constexpr double plot_height = 440.0;

}  // namespace

std::string page_svg(const Plot& plot) {
    return fmt::format(
        "<div class=\"plot\"><svg viewBox=\"0 0 {} {}\" role=\"group\" aria-label=\"{}\">\n"
        "{}</svg></div>\n",
        plot_width, plot_height, html_escaped(plot.label), plot.body);
}

std::string legend_html(const Legend& legend) {
    std::string chips;
    for (const LegendEntry& entry : legend.entries) {
        chips +=
            fmt::format(R"(<label class="chip"><input type="checkbox" checked data-members="{}">)",
                        fmt::join(entry.members, " "));
        if (entry.look)
            chips += fmt::format(
                R"(<svg class="swatch" viewBox="-7 -7 14 14" width="14" height="14" aria-hidden="true">{}</svg>)",
                mark(*entry.look));
        chips += fmt::format("<span>{}</span>", html_escaped(entry.name));
        if (!entry.remark.empty())
            chips += fmt::format("<small>{}</small>", html_escaped(entry.remark));
        chips += "</label>\n";
    }
    return fmt::format(
        "<fieldset class=\"choice\"><legend{}>{}</legend><div "
        "class=\"chips\">\n{}</div></fieldset>\n",
        legend.name.empty() ? " class=\"unseen\"" : "",
        legend.name.empty() ? "Curves" : html_escaped(legend.name), chips);
}

std::string svg_file(const Plot& plot) {
    std::string drawn;
    double y = plot_height;
    for (const Legend& legend : plot.legends) {
        if (legend.entries.empty() || !legend.entries[0].look) continue;
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
                px(x), px(y), mark(*entry.look), html_escaped(entry.name));
            x += room;
        }
    }
    const double height = drawn.empty() ? plot_height : y + 16.0;
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" viewBox=\"0 0 {0} {1}\" "
        "width=\"{0}\" height=\"{1}\" role=\"img\">\n<title>{2}</title>\n<style>\n{3}</style>\n"
        "<rect class=\"sheet\" width=\"100%\" height=\"100%\" rx=\"8\"/>\n{4}{5}</svg>\n",
        px(plot_width), px(height), html_escaped(plot.label), report_part("plot.css"), plot.body,
        drawn);
}

std::string tooltip(const std::string& text) {
    return fmt::format("<title>{}</title><circle class=\"reach\" r=\"11\"/>", html_escaped(text));
}

}  // namespace relief::tools::plots

namespace relief::tools {

using namespace plots;
using nlohmann::ordered_json;

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

struct Point {
    double x = 0.0;
    Value error{};
};

std::vector<Point> points_of(const ordered_json& curve) {
    std::vector<Point> points;
    for (const ordered_json& point : curve.at("points"))
        points.push_back({point.at(0).get<double>(), number_at(point, "/1")});
    return points;
}

bool is_on_axis(const Point& point) {
    return point.error && *point.error > 0.0;
}

/// Returns a line with the fitted slope through the mean of the points, on logarithmic axes.
std::string fit(const ordered_json& curve, std::size_t index, const Axis& x, const Axis& y) {
    std::vector<Point> known;
    for (const Point& point : points_of(curve)) {
        if (point.x > 0.0 && is_on_axis(point)) known.push_back(point);
    }
    const Value order = number_at(curve, "/order");
    if (!order || known.size() < 2 || !x.is_log) return "";
    double level = 0.0;
    for (const Point& point : known)
        level += std::log(*point.error) - *order * std::log(point.x);
    level /= static_cast<double>(known.size());
    const auto fitted = [&](double at) { return y.place(std::exp(level + *order * std::log(at))); };
    const double begin = known.front().x;
    const double end = known.back().x;
    return fmt::format(
        "<line class=\"fit curve {}\" data-index=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" "
        "y2=\"{}\"/>\n",
        hue(index), index, px(x.place(begin)), px(fitted(begin)), px(x.place(end)),
        px(fitted(end)));
}

/// Returns the line and marks of a curve. The line has gaps at missing results and at errors of 0,
/// which are in the strip.
std::string drawn_curve(const ordered_json& curve, std::size_t index, const Axis& x, const Axis& y,
                        std::span<const std::string> tips) {
    const std::vector<Point> points = points_of(curve);
    std::string path;
    bool is_down = false;
    for (const Point& point : points) {
        if (is_on_axis(point))
            path += fmt::format("{}{},{}", is_down ? "L" : "M", px(x.place(point.x)),
                                px(y.place(point.error)));
        is_down = is_on_axis(point);
    }
    std::string drawn = fmt::format(R"(<path class="line curve {}" data-index="{}" d="{}"/>)",
                                    hue(index), index, path);
    const Value breaks_at = number_at(curve, "/breaks_at");
    for (std::size_t i = 0; i < points.size(); ++i) {
        drawn +=
            fmt::format(
                "\n<g class=\"point curve{}\" data-index=\"{}\" transform=\"translate({},{})\">",
                points.size() > 24 ? " dense" : "", index, px(x.place(points[i].x)),
                px(y.place(points[i].error))) +
            (tips.empty() ? "" : tooltip(tips[i])) +
            (breaks_at == points[i].x ? R"(<circle class="breaks" r="9"/>)" : "") +
            mark({index, index}) + "</g>";
    }
    return drawn + "\n";
}

/// Returns the space for names to the right of the lines, if there are few.
double room_for_names(const ordered_json& curves) {
    if (curves.size() > 12) return 0.0;
    double longest = 0.0;
    for (const ordered_json& curve : curves)
        longest = std::max(longest, text_width(curve.value("method", "")));
    return std::min(190.0, 20.0 + 1.02 * longest);
}

/// Returns the names of the curves beside their ends, without overlap.
std::string names_at_ends(const ordered_json& curves, const Axis& x, const Axis& y,
                          const Area& area) {
    struct End {
        std::size_t index;
        Point at;
        double y;
        double level = 0.0;
    };
    std::vector<End> ends;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const std::vector<Point> points = points_of(curves[i]);
        auto last = std::find_if(points.rbegin(), points.rend(), is_on_axis);
        if (last == points.rend())
            last = std::find_if(points.rbegin(), points.rend(),
                                [](const Point& point) { return point.error.has_value(); });
        if (last != points.rend()) ends.push_back({i, *last, y.place(last->error)});
    }
    std::stable_sort(ends.begin(), ends.end(),
                     [](const End& a, const End& b) { return a.y < b.y; });
    const double step =
        std::min(14.0, (area.bottom - area.top) /
                           static_cast<double>(std::max<std::size_t>(1, ends.size())));
    double free = area.top - step;
    for (End& end : ends)
        free = end.level = std::max(end.y, free + step);
    double limit = area.bottom + step;
    for (auto end = ends.rbegin(); end != ends.rend(); ++end)
        limit = end->level = std::min(end->level, limit - step);
    std::string drawn;
    for (const End& end : ends) {
        drawn += fmt::format(
            "<path class=\"leader curve {0}\" data-index=\"{1}\" d=\"M{2},{3}L{4},{5}\"/>"
            "<text class=\"end-name curve\" data-index=\"{1}\" x=\"{6}\" y=\"{5}\" dy=\"0.34em\" "
            "aria-hidden=\"true\">{7}</text>\n",
            hue(end.index), end.index, px(x.place(end.at.x) + 6.0), px(end.y), px(area.right + 4.0),
            px(end.level), px(area.right + 8.0),
            html_escaped(curves[end.index].value("method", "")));
    }
    return drawn;
}

Plot curves_plot(const ordered_json& chart, const std::vector<std::string>& tips) {
    const ordered_json& curves = chart.at("curves");
    Area area;
    const double room = room_for_names(curves);
    area.right -= room;
    std::vector<Value> along;
    std::vector<Value> errors;
    for (const ordered_json& curve : curves) {
        for (const Point& point : points_of(curve)) {
            along.emplace_back(point.x);
            errors.push_back(point.error);
        }
    }
    const Value bound = number_at(chart, "/bound");
    if (bound) errors.push_back(bound);
    const Axis x = x_axis(area, along, chart.value("x_log", true), "");
    const Axis y = y_axis(area, errors);
    const std::string x_label = chart.value("x_label", "");
    const std::string y_label = chart.value("y_label", "");
    Plot plot;
    plot.body = "<g aria-hidden=\"true\">" + drawn_y_axis(area, y, y_label) +
                drawn_x_axis(area, x, x_label, "none") + "</g>\n";
    if (bound) {
        const double at = y.place(bound);
        plot.body += fmt::format(
            "<line class=\"bound\" x1=\"{}\" x2=\"{}\" y1=\"{}\" y2=\"{}\"/>"
            "<text x=\"{}\" y=\"{}\" aria-hidden=\"true\">bound {}</text>\n",
            px(area.left), px(area.right), px(at), px(at), px(area.left + 6.0), px(at - 5.0),
            tick_text(*bound, ""));
    }
    for (std::size_t i = 0; i < curves.size(); ++i)
        plot.body += fit(curves[i], i, x, y);
    std::vector<std::string> words;
    std::size_t next = 0;  // The tip of the next curve's first point.
    plot.legends = {{"", {}}};
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const std::size_t count = curves[i].at("points").size();
        plot.body +=
            drawn_curve(curves[i], i, x, y,
                        tips.empty() ? std::span<const std::string>{}
                                     : std::span<const std::string>(tips).subspan(next, count));
        next += count;
        const std::string method = curves[i].value("method", "");
        const std::string remark = curve_words(curves[i]);
        plot.legends[0].entries.push_back({method, Look{i, i}, remark, {i}});
        words.push_back(remark.empty() ? method : method + ", " + remark);
    }
    if (room > 0.0) plot.body += names_at_ends(curves, x, y, area);
    plot.label = fmt::format("{} against {}: {}.", y_label, x_label, fmt::join(words, "; "));
    return plot;
}

}  // namespace

std::string chart_plot(const ordered_json& chart, const std::vector<std::string>& tips) {
    const Plot plot = curves_plot(chart, tips);
    return page_svg(plot) + legend_html(plot.legends[0]);
}

std::string chart_picture(const ordered_json& chart) {
    return svg_file(curves_plot(chart, {}));
}

}  // namespace relief::tools
