// SPDX-License-Identifier: Apache-2.0
#include "report_files.h"

#include <nlohmann/json.hpp>
#include <span>

#include "common/text.h"
#include "file_replacement.h"
#include "report/report_html.h"
#include "report_csv.h"
#include "report_json.h"
#include "report_pictures.h"

namespace relief::tools {

void write_text(const std::filesystem::path& file, const std::string& text) {
    replace_file(file, std::as_bytes(std::span(text)));
}

std::vector<std::filesystem::path> write_report(const std::filesystem::path& folder,
                                                const AccuracyReport& report) {
    write_pictures(folder, report);
    write_text(folder / "accuracy.csv", measurements_csv(report));
    write_text(folder / "accuracy-curves.csv", curves_csv(report));
    const nlohmann::ordered_json json = json_of(report, true);
    write_text(folder / "report.html", report_html(json, folder));
    write_json(folder / "accuracy.json", json);
    return {folder / "report.html", folder / "accuracy.json", folder / "accuracy.csv",
            folder / "accuracy-curves.csv"};
}

}  // namespace relief::tools
