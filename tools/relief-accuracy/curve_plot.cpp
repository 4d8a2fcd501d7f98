// SPDX-License-Identifier: Apache-2.0
// Draws error curves: a line per method on logarithmic axes, with fitted slopes, the bound, and the
// points where methods break. Tests: tests/tools/accuracy_page/plots_test.cpp, and
// report_page_test.py in a browser.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "plot_parts.h"
#include "plots.h"
#include "report_page.h"

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
        "<line class=\"fit curve {}\" data-curve=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" "
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
    std::string drawn = fmt::format(R"(<path class="line curve {}" data-curve="{}" d="{}"/>)",
                                    hue(index), index, path);
    const Value breaks_at = number_at(curve, "/breaks_at");
    for (std::size_t i = 0; i < points.size(); ++i) {
        drawn +=
            fmt::format(
                "\n<g class=\"point curve{}\" data-curve=\"{}\" transform=\"translate({},{})\">",
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
            "<path class=\"leader curve {0}\" data-curve=\"{1}\" d=\"M{2},{3}L{4},{5}\"/>"
            "<text class=\"end-name curve\" data-curve=\"{1}\" x=\"{6}\" y=\"{5}\" dy=\"0.34em\" "
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
        plot.legends[0].entries.push_back({method, Look{i, i}, remark});
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
