// SPDX-License-Identifier: Apache-2.0
#include "common/report_options.h"

#include <fmt/format.h>

#include "common/file_jobs.h"
#include "common/options.h"
#include "common/text.h"

namespace relief::tools {

void add_report_options(CLI::App& app, ReportOptions& options, const std::string& strict) {
    add_path(app, "--report", options.file, "Write what was done and found to FILE, as JSON.")
        .group("Report");
    add_switch(app, "--strict", options.strict,
               strict.empty() ? "Exit with 3 if anything was found wrong in the input; the output "
                                "is written all the same."
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
