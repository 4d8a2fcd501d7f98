// SPDX-License-Identifier: Apache-2.0
// The results as text, JSON, JUnit and annotations of GitHub.
// Tests: tests/check/check_report_test.cpp.
#include "check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "common/command.h"
#include "common/html.h"
#include "common/text.h"
#include "map_remedies.h"

namespace relief::tools {
namespace {

constexpr const char* page_of_rules = "docs/check-rules.md";

std::string severity_name(CheckSeverity severity) {
    return std::string(enum_name(severity));
}

/// Returns the name of the output in a shown command.
std::string output_name(const std::filesystem::path& file) {
    if (can_be_fixed(file)) return "out" + extension_of(file);
    return has_image_extension(file) ? "out.png" : "out.glb";
}

/// "3 errors, 1 warning, 12 notes"
std::string counts_text(const CheckResults& results) {
    return fmt::format("{}, {}, {}", counted(results.count(CheckSeverity::error), "error"),
                       counted(results.count(CheckSeverity::warning), "warning"),
                       counted(results.count(CheckSeverity::note), "note"));
}

std::string with_place(const CheckFinding& finding) {
    return finding.place.empty() ? finding.text
                                 : fmt::format("{}: {}", finding.place, finding.text);
}

std::string text_of(const CheckResults& results) {
    std::string text;
    for (const CheckedItem& item : results.items) {
        for (const CheckFinding& finding : item.findings) {
            if (finding.severity == CheckSeverity::note && !results.shows_notes) continue;
            text += printable(fmt::format("{}: {}: {} [{}]", item.file.string(),
                                          enum_name(finding.severity), with_place(finding),
                                          finding.rule->id)) +
                    "\n";
            const std::string remedy = remedy_text(item, finding);
            if (!remedy.empty()) text += printable("    -> " + remedy) + "\n";
        }
    }
    for (const CheckFix& fix : results.fixes) {
        text += printable(fix.error.empty()
                              ? fmt::format("fixed {}: {}", fix.output.string(), fix.command)
                              : fmt::format("not fixed {}: {}", fix.file.string(), fix.error)) +
                "\n";
    }
    text += fmt::format("{:<10}{}: {}", "in all", counted(results.items.size(), "file"),
                        counts_text(results));
    if (results.suppressed > 0) text += fmt::format(", {} suppressed", results.suppressed);
    if (results.in_baseline > 0) text += fmt::format(", {} in the baseline", results.in_baseline);
    if (results.from_cache > 0) text += fmt::format("; {} from the cache", results.from_cache);
    text += "\n";
    const std::size_t notes = results.count(CheckSeverity::note);
    if (notes > 0 && !results.shows_notes)
        text += fmt::format("{:<10}--notes shows them\n", "notes");
    text += fmt::format("{:<10}{} describes each rule\n", "details", page_of_rules);
    return text;
}

Json file_json(const CheckedItem& item) {
    Json json = {{"file", item.file.string()},
                 {"kind", item.kind == CheckedKind::model   ? "model"
                          : item.kind == CheckedKind::image ? "image"
                                                            : "folder"},
                 {"unreadable", item.is_unreadable},
                 {"from_cache", item.is_from_cache}};
    if (item.kind == CheckedKind::model) {
        json["triangles"] = item.model.triangles;
        json["vertices"] = item.model.vertices;
        json["materials"] = item.model.materials;
        json["images"] = json_list(
            item.images, [](const UsedImage& image) { return Json(image.file.string()); });
    } else if (item.kind == CheckedKind::image) {
        json["width"] = item.image.width;
        json["height"] = item.image.height;
    }
    json["findings"] = json_list(item.findings, [&](const CheckFinding& finding) -> Json {
        return {{"rule", finding.rule->id},     {"severity", enum_name(finding.severity)},
                {"place", finding.place},       {"text", finding.text},
                {"count", finding.count},       {"remedy", remedy_text(item, finding)},
                {"fixable", finding.is_fixable}};
    });
    return json;
}

Json results_json(const CheckResults& results) {
    return {{"tool", "relief check"},
            {"version", version()},
            {"documentation", page_of_rules},
            {"errors", results.count(CheckSeverity::error)},
            {"warnings", results.count(CheckSeverity::warning)},
            {"notes", results.count(CheckSeverity::note)},
            {"unreadable", results.unreadable()},
            {"suppressed", results.suppressed},
            {"in_baseline", results.in_baseline},
            {"from_cache", results.from_cache},
            {"files",
             json_list(results.items, [](const CheckedItem& item) { return file_json(item); })},
            {"fixes", json_list(results.fixes, [](const CheckFix& fix) -> Json {
                 return {{"file", fix.file.string()},
                         {"output", fix.output.string()},
                         {"command", fix.command},
                         {"error", fix.error},
                         {"findings", json_list(fix.findings, [](const FixedFinding& one) -> Json {
                              return {{"rule", one.rule},
                                      {"place", one.place},
                                      {"count", one.count},
                                      {"remaining", one.remaining}};
                          })}};
             })}};
}

/// Each file is a test case, which fails by its errors and warnings.
std::string junit_of(const CheckResults& results) {
    const auto is_failure = [](const CheckFinding& finding) {
        return finding.severity >= CheckSeverity::warning;
    };
    const auto failed = std::ranges::count_if(results.items, [&](const CheckedItem& item) {
        return std::ranges::any_of(item.findings, is_failure);
    });
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    text += fmt::format(
        "<testsuites>\n<testsuite name=\"relief check\" tests=\"{}\" failures=\"{}\" errors=\"0\" "
        "skipped=\"0\">\n",
        results.items.size(), failed);
    for (const CheckedItem& item : results.items) {
        const auto attribute = [](const std::string& value) {
            return html_escaped(printable(value));
        };
        const std::string name = attribute(item.file.string());
        std::string lines;
        const CheckFinding* first = nullptr;
        for (const CheckFinding& finding : item.findings) {
            if (!is_failure(finding)) continue;
            if (first == nullptr) first = &finding;
            lines += attribute(fmt::format("{}: {} [{}]", enum_name(finding.severity),
                                           with_place(finding), finding.rule->id)) +
                     "\n";
        }
        text += fmt::format("<testcase name=\"{}\" classname=\"relief\"", name);
        if (first == nullptr) {
            text += "/>\n";
            continue;
        }
        text += fmt::format(">\n<failure message=\"{}\" type=\"{}\">\n{}</failure>\n</testcase>\n",
                            attribute(with_place(*first)), first->rule->id, lines);
    }
    return text + "</testsuite>\n</testsuites>\n";
}

/// Escapes a value of a workflow command: its data, or with commas and colons a property.
std::string workflow_text(std::string_view text, bool is_property) {
    std::string result;
    for (const char letter : text) {
        if (letter == '%' || letter == '\r' || letter == '\n' ||
            (is_property && (letter == ':' || letter == ',')))
            result += fmt::format("%{:02X}", static_cast<unsigned char>(letter));
        else
            result += letter;
    }
    return result;
}

std::string github_of(const CheckResults& results) {
    std::string text;
    for (const CheckedItem& item : results.items) {
        for (const CheckFinding& finding : item.findings) {
            const bool is_note = finding.severity == CheckSeverity::note;
            if (is_note && !results.shows_notes) continue;
            const std::string remedy = remedy_text(item, finding);
            const std::string message =
                with_place(finding) + (remedy.empty() ? "" : "\n-> " + remedy);
            text += fmt::format(
                "::{} file={},title={}::{}\n", is_note ? "notice" : severity_name(finding.severity),
                // GitHub knows files by their names in the repository.
                workflow_text(item.file.lexically_normal().generic_string(), true),
                workflow_text(finding.rule->id, true), workflow_text(message, false));
        }
    }
    return text;
}

}  // namespace

std::size_t CheckResults::count(CheckSeverity severity) const {
    std::size_t count = 0;
    for (const CheckedItem& item : items) {
        count += static_cast<std::size_t>(
            std::ranges::count(item.findings, severity, &CheckFinding::severity));
    }
    return count;
}

std::size_t CheckResults::unreadable() const {
    // One whose finding is suppressed, off or in the baseline does not count.
    return static_cast<std::size_t>(std::ranges::count_if(items, [](const CheckedItem& item) {
        return item.is_unreadable &&
               std::ranges::any_of(item.findings, [](const CheckFinding& finding) {
                   return finding.severity == CheckSeverity::error;
               });
    }));
}

std::filesystem::path as_argument(const std::filesystem::path& file) {
    return file.string().starts_with('-') || file.string().starts_with('@')
               ? std::filesystem::path("./" + file.string())
               : file;
}

std::string remedy_text(const CheckedItem& item, const CheckFinding& finding) {
    const std::string_view remedy = finding.rule->remedy;
    if (!finding.rule->is_fixable()) return std::string(remedy);
    const bool is_of_image =
        finding.rule->id.starts_with("map/") || finding.rule->id.starts_with("texture/");
    if (is_of_image && item.kind == CheckedKind::model) {
        // The image is embedded, and the command alone does not reach it.
        if (!finding.is_fixable || finding.severity < CheckSeverity::warning)
            return "export it again";
        return fmt::format("relief check {} --fix -o fixed", quoted(as_argument(item.file)));
    }
    return with_files(remedy, quoted(as_argument(item.file)), output_name(item.file));
}

std::string report_text(const CheckResults& results, CheckFormat format) {
    switch (format) {
        case CheckFormat::json:
            return dumped(results_json(results));
        case CheckFormat::sarif:
            return dumped(sarif_json(results));
        case CheckFormat::junit:
            return junit_of(results);
        case CheckFormat::github:
            return github_of(results);
        default:
            return text_of(results);
    }
}

}  // namespace relief::tools
