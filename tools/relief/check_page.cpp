// SPDX-License-Identifier: Apache-2.0
// The page of `relief check --report FILE.html`: a card for each file with findings, worst first,
// and a table of the rules. Tests: tests/check/check_report_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "check_report.h"
#include "common/html.h"
#include "common/text.h"
#include "file_replacement.h"
#include "make_pictures.h"
#include "page_text.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

/// The files with a picture, the worst ones; a page of thousands would be too large to open.
constexpr std::size_t max_pictures = 48;
/// The findings that a card lists.
constexpr std::size_t max_lines = 12;

std::size_t count_of(const CheckedItem& item, CheckSeverity severity) {
    return static_cast<std::size_t>(
        std::ranges::count(item.findings, severity, &CheckFinding::severity));
}

std::vector<const CheckedItem*> worst_first(const CheckResults& results) {
    std::vector<const CheckedItem*> items;
    for (const CheckedItem& item : results.items) {
        if (!item.findings.empty()) items.push_back(&item);
    }
    std::ranges::stable_sort(items, std::ranges::greater{}, [](const CheckedItem* item) {
        return std::tuple(count_of(*item, CheckSeverity::error),
                          count_of(*item, CheckSeverity::warning),
                          count_of(*item, CheckSeverity::note));
    });
    return items;
}

/// Draws models and reads images, as long as that is possible.
class Thumbnails {
  public:
    explicit Thumbnails(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Returns an element, or nothing for a file that cannot be shown.
    std::string of(const CheckedItem& item) {
        if (item.is_unreadable || item.kind == CheckedKind::folder) return "";
        try {
            if (item.kind == CheckedKind::image) return image(item.file);
            if (item.model.triangles == 0) return "";
            if (!drawer_) drawer_ = std::make_unique<AssetDrawer>();
            return html_image(drawer_->draw(item.file, {320, 240}), "", "", folder_);
        } catch (const Cancelled&) {
            throw;
        } catch (const Error&) {
            return "";
        }
    }

  private:
    [[nodiscard]] std::string image(const std::filesystem::path& file) const {
        constexpr int size = 240;
        const Image whole = read_image(file, ImageUse::color);
        if (whole.bits() == 32) return "";
        return html_image(reduced(whole, size), "", "", folder_);
    }

    std::filesystem::path folder_;
    std::unique_ptr<AssetDrawer> drawer_;
};

std::string line_of(const CheckedItem& item, const CheckFinding& finding) {
    const std::string place = finding.place.empty() ? "" : finding.place + ": ";
    const std::string remedy = remedy_text(item, finding);
    const auto escaped = [](const std::string& text) { return html_escaped(printable(text)); };
    const std::string advice = remedy.empty() ? ""
                               : finding.rule->is_fixable() && remedy.starts_with("relief-")
                                   ? fmt::format("<br>→ <code>{}</code>", escaped(remedy))
                                   : fmt::format("<br>→ {}", escaped(remedy));
    return fmt::format("<li class=\"{0}\"><b>{0}</b> {1} <code>{2}</code>{3}</li>\n",
                       enum_name(finding.severity), escaped(place + finding.text), finding.rule->id,
                       advice);
}

/// Returns a list of findings; empty if there are none.
std::string list_of(const CheckedItem& item, const std::vector<const CheckFinding*>& findings) {
    std::string lines;
    for (std::size_t i = 0; i < std::min(findings.size(), max_lines); ++i)
        lines += line_of(item, *findings[i]);
    if (findings.size() > max_lines)
        lines += fmt::format("<li>... and {} more</li>\n", findings.size() - max_lines);
    return lines.empty() ? "" : fmt::format("<ul>\n{}</ul>\n", lines);
}

std::string card_of(const CheckedItem& item, const std::string& picture) {
    std::vector<const CheckFinding*> alarms, notes;
    for (const CheckFinding& finding : item.findings)
        (finding.severity == CheckSeverity::note ? notes : alarms).push_back(&finding);
    std::ranges::stable_sort(alarms, std::ranges::greater{}, &CheckFinding::severity);
    const std::string folded =
        notes.empty() ? ""
                      : fmt::format("<details><summary>{}</summary>\n{}</details>\n",
                                    counted(notes.size(), "note"), list_of(item, notes));
    const bool has_error = count_of(item, CheckSeverity::error) > 0;
    return fmt::format("<article{}>{}\n<h2>{}</h2>\n{}{}</article>\n",
                       has_error ? " class=\"failed\"" : "", picture,
                       html_escaped(printable(item.file.string())), list_of(item, alarms), folded);
}

/// The rules with findings, and their numbers of files.
std::string rules_table(const CheckResults& results) {
    std::map<std::string_view, std::size_t> files;
    for (const CheckedItem& item : results.items) {
        std::vector<std::string_view> ids;
        for (const CheckFinding& finding : item.findings)
            ids.push_back(finding.rule->id);
        std::ranges::sort(ids);
        ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
        for (const std::string_view id : ids)
            ++files[id];
    }
    if (files.empty()) return "";
    std::string rows;
    for (const auto& [id, count] : files) {
        const CheckRule& rule = rule_named(id);
        rows += fmt::format("<tr><th><code>{}</code></th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                            id, count, html_escaped(rule.title), html_escaped(rule.cost));
    }
    return fmt::format(
        "<h2>Rules</h2>\n<div class=\"scrolled\"><table>\n<thead><tr><th>rule</th><th>files</th>"
        "<th>finding</th><th>cost</th></tr></thead>\n<tbody>\n{}</tbody>\n</table></div>\n",
        rows);
}

}  // namespace

void write_check_page(const std::filesystem::path& file, const CheckResults& results) {
    Thumbnails thumbnails(file.parent_path());
    std::string cards;
    std::size_t shown = 0;
    for (const CheckedItem* item : worst_first(results)) {
        const std::string picture = shown < max_pictures ? thumbnails.of(*item) : "";
        if (!picture.empty()) ++shown;
        cards += card_of(*item, picture);
    }
    const std::string figures =
        fmt::format("{}: {}, {}, {}.", counted(results.items.size(), "file"),
                    counted(results.count(CheckSeverity::error), "error"),
                    counted(results.count(CheckSeverity::warning), "warning"),
                    counted(results.count(CheckSeverity::note), "note"));
    const std::string page =
        filled_page("check.html", {{"title", "Checked assets"},
                                   {"style", std::string(page_part("make.css"))},
                                   {"figures", figures},
                                   {"files", cards},
                                   {"rules", rules_table(results)},
                                   {"version", html_escaped("relief " + version() + ".")}});
    relief::detail::replace_file(file, std::as_bytes(std::span(page)));
}

}  // namespace relief::tools
