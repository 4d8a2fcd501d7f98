// SPDX-License-Identifier: Apache-2.0
// Draws the parts of plots as SVG. Tests: tests/tools/accuracy_page/plots_test.cpp.
#include "plot_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
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
        chips += fmt::format(R"(<label class="chip"><input type="checkbox" checked value="{}">)",
                             html_escaped(entry.name));
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
