// SPDX-License-Identifier: Apache-2.0
// Many models by the common batch: each is a request of its own.
// Tests: tests/tools/process_batch_test.cpp.
#include "process_batch.h"

#include <algorithm>

#include "common/batch.h"
#include "process_summary.h"

namespace relief::tools {
namespace {

bool may_share_companions(const std::vector<ProcessRequest>& requests) {
    return std::any_of(requests.begin(), requests.end(), [](const ProcessRequest& request) {
        return writable_format(request.output) == ModelFormat::gltf;
    });
}

FileOutcome outcome_of(const ProcessRequest& request) {
    Stages stages(true);
    const Processed done = process(request, stages);
    return {line_of(request, done, stages), done.findings, results_json(done, stages)};
}

}  // namespace

ExitCode process_all(const CLI::App& app, const std::vector<ProcessRequest>& requests,
                     const ReportOptions& report, const GeneralOptions& general) {
    Batch batch;
    for (const ProcessRequest& request : requests)
        batch.jobs.push_back({request.input, request.output});
    batch.work = [&](std::size_t index) { return outcome_of(requests[index]); };
    batch.one_by_one = may_share_companions(requests);
    batch.head = {{"tool", "relief-mesh process"},
                  {"version", version()},
                  {"options", options_json(requests.front())}};
    return run_batch(app, batch, report, general);
}

}  // namespace relief::tools
