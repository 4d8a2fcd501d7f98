// SPDX-License-Identifier: Apache-2.0
#include "common/findings.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/file_jobs.h"
#include "common/options.h"
#include "common/text.h"

namespace relief::tools {

void Findings::add(const std::string& where, const Report& report) {
    for (const Finding& finding : report.findings())
        findings_.push_back({where, finding});
}

std::vector<std::string> Findings::lines(std::size_t limit) const {
    std::vector<std::string> lines;
    for (const PlacedFinding& placed : findings_) {
        if (lines.size() == limit) {
            lines.push_back(fmt::format("... and {} more", findings_.size() - limit));
            break;
        }
        const std::string prefix = placed.where.empty() ? "" : placed.where + ": ";
        lines.push_back(prefix + to_string(placed.finding));
    }
    return lines;
}

nlohmann::ordered_json Findings::json() const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& [where, finding] : findings_) {
        list.push_back({{"where", where},
                        {"kind", finding.kind},
                        {"element", finding.element},
                        {"count", finding.count},
                        {"first", finding.first},
                        {"outcome", finding.outcome}});
    }
    return list;
}

void add_report_options(CLI::App& app, ReportOptions& options, const std::string& strict) {
    add_path(app, "--report", options.file,
             "Write a JSON report with results and findings to FILE.")
        .group("Report");
    add_switch(app, "--strict", options.strict,
               strict.empty() ? "Exit with 3 if there are findings on the input; the output is "
                                "written anyway."
                              : strict)
        .group("Report");
}

void check(const ReportOptions& options, const std::vector<std::filesystem::path>& files) {
    if (!options.file) return;
    for (const std::filesystem::path& file : files) {
        if (identity_of(*options.file) == identity_of(file))
            throw UsageError(fmt::format("--report {}: is also the input or the output",
                                         options.file->string()));
    }
    require_folder_of(*options.file);
}

bool found_fault(const CLI::App& app, const ReportOptions& options,
                 const std::filesystem::path& input, const Findings& findings) {
    if (!options.strict || findings.empty()) return false;
    warn(app, fmt::format("{}: {} (exit code 3, because of --strict)", input.string(),
                          counted(findings.all().size(), "finding")));
    return true;
}

ExitCode finish(const CLI::App& app, const ReportOptions& options,
                const std::filesystem::path& input, const Findings& findings,
                const nlohmann::ordered_json& report) {
    if (options.file) write_json(*options.file, report);
    return found_fault(app, options, input, findings) ? ExitCode::fell_back : ExitCode::done;
}

}  // namespace relief::tools
