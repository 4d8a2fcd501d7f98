// SPDX-License-Identifier: Apache-2.0
// Jobs run in parallel. Their lines are printed in the order of the command line.
// Tests: tests/tools/batch_test.cpp, process_batch_test.cpp.
#include "common/batch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "common/command.h"
#include "common/text.h"
#include "parallel.h"

namespace relief::tools {
namespace {

/// The outcome of a job.
struct Outcome {
    std::optional<FileOutcome> done;  ///< Absent after an error.
    std::string error;
    bool is_finished = false;
};

/// Returns the current exception as "bad.obj: PROBLEM".
std::string error_text(const Job& job) {
    try {
        throw;
    } catch (const FileError& error) {
        return error.what();
    } catch (const UsageError& error) {
        return error.what();
    } catch (const std::bad_alloc&) {
        return job.input.string() + ": out of memory";
    } catch (const std::exception& error) {
        return fmt::format("{}: {}", job.input.string(), error.what());
    }
}

/// Prints the outcomes in order, and the progress on a terminal.
class OutcomePrinter {
  public:
    OutcomePrinter(const CLI::App& app, std::vector<Outcome>& outcomes, bool quiet)
        : app_(app),
          outcomes_(outcomes),
          quiet_(quiet),
          shows_progress_(!quiet && is_err_terminal()) {
        show_progress();
    }
    ~OutcomePrinter() { clear_progress(); }
    OutcomePrinter(const OutcomePrinter&) = delete;
    OutcomePrinter& operator=(const OutcomePrinter&) = delete;

    /// Any thread may call it.
    void finished(std::size_t index) {
        const std::lock_guard lock(mutex_);
        outcomes_[index].is_finished = true;
        ++finished_;
        clear_progress();
        for (; printed_ < outcomes_.size() && outcomes_[printed_].is_finished; ++printed_)
            print(outcomes_[printed_]);
        show_progress();
    }

  private:
    void print(const Outcome& outcome) const {
        if (!outcome.done)
            complain(app_, outcome.error);
        else if (!quiet_)
            fmt::print(out(), "{}\n", outcome.done->line);
    }
    void show_progress() const {
        if (!shows_progress_ || finished_ == outcomes_.size()) return;
        std::fflush(out());
        fmt::print(err(), "\r\033[Kfile {} of {} ...", finished_ + 1, outcomes_.size());
        std::fflush(err());
    }
    void clear_progress() const {
        if (shows_progress_) fmt::print(err(), "\r\033[K");
    }

    const CLI::App& app_;
    std::vector<Outcome>& outcomes_;
    bool quiet_;
    bool shows_progress_;
    std::mutex mutex_;
    std::size_t finished_ = 0;
    std::size_t printed_ = 0;
};

nlohmann::ordered_json file_json(const Job& job, const Outcome& outcome) {
    nlohmann::ordered_json json = {{"input", job.input.string()}, {"output", job.output.string()}};
    if (outcome.done)
        json.update(outcome.done->json);
    else
        json["error"] = outcome.error;
    return json;
}

nlohmann::ordered_json report_json(const Batch& batch, const std::vector<Outcome>& outcomes,
                                   std::size_t failed) {
    nlohmann::ordered_json json = batch.head;
    json["failed"] = failed;
    json["files"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < outcomes.size(); ++i)
        json["files"].push_back(file_json(batch.jobs[i], outcomes[i]));
    return json;
}

void run(const Batch& batch, std::size_t index, Outcome& outcome) {
    try {
        outcome.done = batch.work(index);
    } catch (...) {
        outcome.error = error_text(batch.jobs[index]);
    }
}

void run_all(const CLI::App& app, const Batch& batch, std::vector<Outcome>& outcomes, bool quiet) {
    OutcomePrinter printer(app, outcomes, quiet);
    const std::size_t count = outcomes.size();
    parallel_for(count, batch.one_by_one ? count : 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            run(batch, i, outcomes[i]);
            printer.finished(i);
        }
    });
}

}  // namespace

ExitCode run_batch(const CLI::App& app, const Batch& batch, const ReportOptions& report,
                   const GeneralOptions& general) {
    std::vector<Outcome> outcomes(batch.jobs.size());
    run_all(app, batch, outcomes, general.quiet);
    const auto failed = static_cast<std::size_t>(std::count_if(
        outcomes.begin(), outcomes.end(), [](const Outcome& outcome) { return !outcome.done; }));
    if (!general.quiet) {
        print_entry("in all", counted(batch.jobs.size(), "file") +
                                  (failed == 0 ? "" : fmt::format(", {} failed", failed)));
    }
    if (report.file) write_json(*report.file, report_json(batch, outcomes, failed));
    bool at_fault = false;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        if (outcomes[i].done &&
            found_fault(app, report, batch.jobs[i].input, outcomes[i].done->findings))
            at_fault = true;
    }
    if (failed != 0) return ExitCode::failed;
    return at_fault ? ExitCode::fell_back : ExitCode::done;
}

}  // namespace relief::tools
