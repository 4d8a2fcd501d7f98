// SPDX-License-Identifier: Apache-2.0
// The page: page/page.html with its places filled. Tests:
// tests/tools/accuracy_page/report_html_test.cpp.
#include "report/report_html.h"

#include <fmt/format.h>

#include <cassert>
#include <map>
#include <nlohmann/json.hpp>

#include "report/html_text.h"
#include "report/report_sections.h"

namespace relief::tools {
namespace {

using nlohmann::ordered_json;

/// All parts of a kind, ".css", one after the other. Their order does not matter.
std::string joined_parts(std::string_view ending) {
    std::string text;
    for (const ReportPart& part : report_parts()) {
        if (part.name.ends_with(ending)) text += part.text;
    }
    return text;
}

/// The template with each {{name}} replaced, once: what is put in is not looked at again.
std::string filled(std::string_view page, const std::map<std::string, std::string>& places) {
    std::string text;
    for (;;) {
        const std::size_t begin = page.find("{{");
        text += page.substr(0, begin);
        if (begin == std::string_view::npos) return text;
        const std::size_t end = page.find("}}", begin);
        const auto place = places.find(std::string(page.substr(begin + 2, end - begin - 2)));
        assert(place != places.end());
        text += place->second;
        page.remove_prefix(end + 2);
    }
}

}  // namespace

std::string report_html(const ordered_json& report, const std::filesystem::path& folder) {
    // Invalid UTF-8 in names is replaced, as in the JSON report itself.
    const std::string data = report.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    return filled(joined_parts("page.html"),
                  {{"style", joined_parts(".css")},
                   {"script", joined_parts(".js")},
                   {"command", html_escaped(report.value("command", ""))},
                   {"machine", machine_html(report)},
                   {"contents", contents_html(report)},
                   {"summary", summary_html(report)},
                   {"experiments", experiments_html(report, folder)},
                   {"data", script_escaped(data)}});
}

}  // namespace relief::tools
