// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy report REPORT`: the page of a report that is there already, from its JSON.
// Tests: tests/tools/accuracy_report_command_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.h"
#include "common/file_jobs.h"
#include "common/options.h"
#include "common/text.h"
#include "file_bytes.h"
#include "report/report_html.h"
#include "report_files.h"
#include "report_json.h"

namespace relief::tools {
namespace {

struct ReportCommandOptions {
    std::filesystem::path report;
    std::optional<std::filesystem::path> output;
    bool quiet = false;
};

ExitCode run(const ReportCommandOptions& options) {
    const std::filesystem::path folder = options.report.parent_path();
    const std::filesystem::path page = options.output.value_or(folder / "report.html");
    if (identity_of(page) == identity_of(options.report))
        throw UsageError(fmt::format("{}: would replace the report", page.string()));
    require_folder_of(page);
    read_report(options.report);  // For what it refuses: the page is made of the JSON as it stands.
    const auto json = nlohmann::ordered_json::parse(read_file(options.report));
    write_text(page, about(options.report, [&] { return report_html(json, folder); }));
    if (!options.quiet) print_entry("written", file_and_size(page));
    return ExitCode::done;
}

}  // namespace

Command add_page_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "report",
        "Makes the page with plots anew from a report's JSON, and measures nothing.");
    const auto options = std::make_shared<ReportCommandOptions>();
    add_file(app, "REPORT", options->report,
             "accuracy.json of an earlier run; its pictures are looked for beside it.");
    add_path(app, "--output", options->output,
             "Where to write the page. Default: report.html beside the JSON.");
    add_switch(app, "--quiet", options->quiet, "Print nothing but errors.");
    set_examples(app, {"relief-accuracy run storage --quick --no-times --output out/accuracy",
                       "relief-accuracy report out/accuracy/accuracy.json",
                       "relief-accuracy report out/accuracy/accuracy.json --output out/page.html"});
    return {&app, [options] { return run(*options); }};
}

}  // namespace relief::tools
