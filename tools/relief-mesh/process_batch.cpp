// SPDX-License-Identifier: Apache-2.0
// Many models, side by side; what is said about them comes in the order of the command line.
// Tests: tests/tools/process_batch_test.cpp.
#include "process_batch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "common/text.h"
#include "parallel.h"
#include "process_summary.h"

namespace relief::tools {
namespace {

/// What became of one model.
struct Outcome {
    std::optional<Processed> done;  ///< Absent where it failed.
    std::string error;
    Stages stages{true};
    bool is_finished = false;
};

/// "bad.obj: PROBLEM", of whatever was thrown.
std::string error_text(const ProcessRequest& request) {
    try {
        throw;
    } catch (const FileError& error) {
        return error.what();
    } catch (const UsageError& error) {
        return error.what();
    } catch (const std::bad_alloc&) {
        return request.input.string() + ": out of memory";
    } catch (const std::exception& error) {
        return fmt::format("{}: {}", request.input.string(), error.what());
    }
}

void run(const ProcessRequest& request, Outcome& outcome) {
    try {
        outcome.done = process(request, outcome.stages);
    } catch (...) {
        outcome.error = error_text(request);
    }
}

/// Says what became of the models, in their order, and on a terminal how many are done.
class Spokesman {
  public:
    Spokesman(const CLI::App& app, const std::vector<ProcessRequest>& requests,
              std::vector<Outcome>& outcomes, bool quiet)
        : app_(app),
          requests_(requests),
          outcomes_(outcomes),
          quiet_(quiet),
          shows_progress_(!quiet && isatty(STDERR_FILENO) == 1) {
        show_progress();
    }
    ~Spokesman() { clear_progress(); }
    Spokesman(const Spokesman&) = delete;
    Spokesman& operator=(const Spokesman&) = delete;

    /// Called by any thread.
    void finished(std::size_t index) {
        const std::lock_guard lock(mutex_);
        outcomes_[index].is_finished = true;
        ++finished_;
        clear_progress();
        for (; told_ < outcomes_.size() && outcomes_[told_].is_finished; ++told_)
            tell(requests_[told_], outcomes_[told_]);
        show_progress();
    }

  private:
    void tell(const ProcessRequest& request, const Outcome& outcome) const {
        if (!outcome.done)
            complain(app_, outcome.error);
        else if (!quiet_)
            print_line(request, *outcome.done, outcome.stages);
    }
    void show_progress() const {
        if (!shows_progress_ || finished_ == outcomes_.size()) return;
        std::fflush(stdout);
        fmt::print(stderr, "\r\033[Kfile {} of {} ...", finished_ + 1, outcomes_.size());
        std::fflush(stderr);
    }
    void clear_progress() const {
        if (shows_progress_) fmt::print(stderr, "\r\033[K");
    }

    const CLI::App& app_;
    const std::vector<ProcessRequest>& requests_;
    std::vector<Outcome>& outcomes_;
    bool quiet_;
    bool shows_progress_;
    std::mutex mutex_;
    std::size_t finished_ = 0;
    std::size_t told_ = 0;
};

bool may_share_companions(const std::vector<ProcessRequest>& requests) {
    return std::any_of(requests.begin(), requests.end(), [](const ProcessRequest& request) {
        return writable_format(request.output) == ModelFormat::gltf;
    });
}

nlohmann::ordered_json report_json(const std::vector<ProcessRequest>& requests,
                                   const std::vector<Outcome>& outcomes, std::size_t failed) {
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < requests.size(); ++i) {
        files.push_back(outcomes[i].done
                            ? file_json(requests[i], *outcomes[i].done, outcomes[i].stages)
                            : failed_file_json(requests[i], outcomes[i].error));
    }
    return {{"tool", "relief-mesh process"},
            {"version", version()},
            {"options", options_json(requests.front())},
            {"failed", failed},
            {"files", std::move(files)}};
}

}  // namespace

ExitCode process_all(const CLI::App& app, const std::vector<ProcessRequest>& requests,
                     const ReportOptions& report, const GeneralOptions& general) {
    std::vector<Outcome> outcomes(requests.size());
    {
        Spokesman spokesman(app, requests, outcomes, general.quiet);
        const std::size_t at_a_time = may_share_companions(requests) ? requests.size() : 1;
        parallel_for(requests.size(), at_a_time, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                run(requests[i], outcomes[i]);
                spokesman.finished(i);
            }
        });
    }
    const auto failed = static_cast<std::size_t>(std::count_if(
        outcomes.begin(), outcomes.end(), [](const Outcome& outcome) { return !outcome.done; }));
    if (!general.quiet) {
        print_entry("in all", counted(requests.size(), "file") +
                                  (failed == 0 ? "" : fmt::format(", {} failed", failed)));
    }
    if (report.file) write_json(*report.file, report_json(requests, outcomes, failed));
    bool at_fault = false;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (outcomes[i].done &&
            found_fault(app, report, requests[i].input, outcomes[i].done->findings))
            at_fault = true;
    }
    if (failed != 0) return ExitCode::failed;
    return at_fault ? ExitCode::fell_back : ExitCode::done;
}

}  // namespace relief::tools
