// SPDX-License-Identifier: Apache-2.0
// The command `relief farm`. Tests: tests/tools/farm_test.cpp.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/content_hash.h"
#include "common/options.h"
#include "common/summary.h"
#include "driver.h"
#include "farm.h"
#include "files.h"
#include "run_program.h"

namespace relief::tools {

namespace {

enum class FarmEngine { commands, parallel, slurm };

const Choices<FarmEngine> farm_engines = {{"commands", FarmEngine::commands},
                                          {"parallel", FarmEngine::parallel},
                                          {"slurm", FarmEngine::slurm}};

struct FarmCommand {
    std::filesystem::path jobs;
    FarmEngine engine = FarmEngine::commands;
    std::optional<std::size_t> shards;
    std::optional<std::filesystem::path> folder;
    FarmLimits limits;
    int retries = 2;
    double silence_minutes = 10.0;
    bool submits = false;
    bool measures = false;
    bool cleans = false;
    ReportOptions report;
    bool quiet = false;
};

/// Reserves a folder for this process.
class FolderLock {
  public:
    /// \throws FileError if another process has it
    explicit FolderLock(const std::filesystem::path& folder) {
        const std::filesystem::path file = folder / "lock";
        descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
        if (descriptor_ < 0) throw FileError(file, std::strerror(errno));
        if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
        ::close(descriptor_);
        throw failure(folder, "is in use by another relief farm", "wait until it has ended");
    }
    ~FolderLock() { ::close(descriptor_); }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int descriptor_ = -1;
};

std::filesystem::path folder_of(const FarmCommand& command) {
    if (command.folder) return std::filesystem::absolute(*command.folder);
    const std::string hash = file_hash(command.jobs);
    const std::string shards = command.shards ? fmt::format("-{}", *command.shards) : "";
    return std::filesystem::current_path() / (".relief-farm-" + hash + shards);
}

/// The mark of a folder that a farm made: the file of its jobs, and their hash.
std::filesystem::path mark_of(const std::filesystem::path& folder) {
    return folder / "farm.json";
}

/// \throws FileError if the folder belongs to other jobs, or to no farm
void claim(const std::filesystem::path& folder, const FarmCommand& command) {
    const std::string hash =
        fmt::format("{} {}", file_hash(command.jobs), command.shards.value_or(0));
    if (std::filesystem::exists(mark_of(folder))) {
        const Json mark = Json::parse(relief::detail::read_file(mark_of(folder)), nullptr, false);
        if (mark.is_object() && mark.value("hash", "") == hash) return;
        throw failure(folder, "belongs to other jobs, or to another --shards",
                      "give another --folder, or remove it with --clean");
    }
    if (std::filesystem::exists(folder) && !std::filesystem::is_empty(folder))
        throw failure(folder, "is not empty and not of a farm", "give another --folder");
    make_folder(folder);
    write_json(mark_of(folder),
               {{"tool", "relief farm"}, {"jobs", command.jobs.string()}, {"hash", hash}});
}

ExitCode clean(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder)) return ExitCode::done;
    if (!std::filesystem::exists(mark_of(folder)))
        throw failure(folder, "is not the folder of a farm", "remove it yourself");
    const FolderLock lock(folder);
    std::filesystem::remove_all(folder);
    print_entry("removed", folder.string());
    return ExitCode::done;
}

void print_commands(const FarmCommand& command, const FarmJobs& jobs,
                    const std::filesystem::path& folder) {
    const bool has_merges = jobs.tasks.back().is_merge;
    if (has_merges) {
        claim(folder, command);
        make_folder(folder / "parts");
    }
    bool merges = false;
    for (const FarmTask& task : jobs.tasks) {
        if (task.is_merge && !merges) print_text("# When all of these are done:\n");
        merges = task.is_merge;
        print_text(shell_line(task.command) + "\n");
    }
}

/// Runs the first open task here, and derives limits of time and memory from it.
void measure(const FarmFolder& folder, FarmLimits& limits) {
    constexpr double time_margin = 4.0;    // Slower machines, and larger shards.
    constexpr double memory_margin = 1.5;  // Larger shards.
    constexpr double min_minutes = 2.0;    // A queue counts whole minutes.
    constexpr double min_megabytes = 256.0;
    const std::vector<std::size_t> open = folder.open_tasks(false);
    if (open.empty()) return;
    const ProgramOutput output = run_program({"bash", folder.script(open.front()).string()});
    if (output.exit_code != 0) {
        throw failure(folder.log(open.front()),
                      fmt::format("the first task failed with {}", output.exit_code),
                      "correct it before the others run");
    }
    if (!limits.minutes)
        limits.minutes = std::max(min_minutes, std::ceil(time_margin * output.seconds / 60.0));
    if (!limits.megabytes) {
        limits.megabytes = std::max(
            min_megabytes, std::ceil(memory_margin * static_cast<double>(output.peak_bytes) / 1e6));
    }
    print_entry("measured",
                fmt::format("{} and {} for a task: limits of {:.0f} min and {:.0f} MB",
                            duration(1000.0 * output.seconds), byte_size(output.peak_bytes),
                            *limits.minutes, *limits.megabytes));
}

std::size_t open_count(const FarmFolder& folder) {
    return folder.open_tasks(false).size() + folder.open_tasks(true).size();
}

/// Waits until no array is in the queue, or until Slurm has not answered for too long.
class QueueWait {
  public:
    QueueWait(const CLI::App& app, const FarmCommand& command, const FarmFolder& folder,
              std::size_t all, Stages& stages)
        : app_(app), command_(command), folder_(folder), all_(all), stages_(stages) {}

    /// \return why Slurm was given up; empty if the arrays have ended
    std::string run(const std::vector<std::string>& arrays) {
        std::chrono::milliseconds pause(1000);
        constexpr std::chrono::milliseconds longest(10'000);
        while (true) {
            const QueueState state = look_into_queue(arrays);
            if (state.has_answered && !state.has_arrays) break;
            if (!is_patient(state)) return given_up(state);
            show_progress();
            std::this_thread::sleep_for(silent_since_ ? std::min(pause, limit() / 4) : pause);
            pause = std::min(2 * pause, longest);
        }
        stages_.clear_progress();
        return "";
    }

  private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] std::chrono::milliseconds limit() const {
        return std::chrono::milliseconds(
            static_cast<std::int64_t>(60'000.0 * command_.silence_minutes));
    }

    /// Returns whether to ask again.
    bool is_patient(const QueueState& state) {
        if (state.has_answered) {
            silent_since_.reset();
            return true;
        }
        if (!silent_since_) {
            silent_since_ = Clock::now();
            warn(app_, fmt::format("Slurm does not answer ({}); asking again for {:.4g} min",
                                   state.problem, command_.silence_minutes));
        }
        return Clock::now() - *silent_since_ < limit();
    }

    std::string given_up(const QueueState& state) const {
        stages_.clear_progress();
        return fmt::format("Slurm has not answered for {:.4g} min ({})", command_.silence_minutes,
                           state.problem);
    }

    void show_progress() {
        const std::size_t done = all_ - open_count(folder_);
        stages_.show_progress("farm", static_cast<double>(done) / static_cast<double>(all_),
                              fmt::format("{} of {} tasks", done, all_));
    }

    const CLI::App& app_;
    const FarmCommand& command_;
    const FarmFolder& folder_;
    std::size_t all_;
    Stages& stages_;
    std::optional<Clock::time_point> silent_since_;
};

/// \param problem  why the farm was given up; empty if it has ended
ExitCode finish_farm(const CLI::App& app, const FarmCommand& command, const FarmFolder& folder,
                     const FarmJobs& jobs, int attempts, const std::string& problem) {
    constexpr std::size_t max_shown = 5;
    Json report = {{"tool", "relief farm"},
                   {"version", version()},
                   {"engine", name_of(command.engine, farm_engines)},
                   {"folder", folder.path().string()},
                   {"attempts", attempts},
                   {"given_up", problem.empty() ? Json() : Json(problem)}};
    report.update(folder.report());
    const std::size_t open = open_count(folder);
    if (!command.quiet) {
        print_entry("farm", fmt::format("{} of {} done", jobs.tasks.size() - open,
                                        counted(jobs.tasks.size(), "task")));
    }
    if (command.report.file) write_json(*command.report.file, report);
    if (!problem.empty()) {
        // Tasks that are not done may still run.
        complain(app, fmt::format("{}; tasks go on without relief, and the same command continues",
                                  problem));
        return ExitCode::failed;
    }
    std::size_t shown = 0;
    for (const bool merges : {false, true}) {
        for (const std::size_t task : folder.open_tasks(merges)) {
            if (shown++ >= max_shown) continue;
            complain(app, fmt::format("{}: failed, see {}", printable(jobs.tasks[task].name),
                                      folder.log(task).string()));
        }
    }
    return open > 0 ? ExitCode::failed : ExitCode::done;
}

ExitCode run(const CLI::App& app, const FarmCommand& command) {
    const std::filesystem::path path = folder_of(command);
    if (command.cleans) return clean(path);
    if (command.engine == FarmEngine::commands && (command.submits || command.measures))
        throw UsageError("--submit, --measure: have no effect with --engine commands",
                         "give --engine slurm or parallel");
    if (command.engine != FarmEngine::slurm && is_given(app, "--silence"))
        throw UsageError("--silence: has no effect without --engine slurm");
    check(command.report, {command.jobs});
    const FarmJobs jobs =
        read_farm_jobs(command.jobs, command.shards, path / "parts", command.limits.threads);
    if (command.engine == FarmEngine::commands) {
        print_commands(command, jobs, path);
        return ExitCode::done;
    }
    claim(path, command);
    const FolderLock lock(path);
    const FarmFolder folder(path, jobs);
    folder.write_scripts();
    if (!command.submits) {
        print_entry("wrote", fmt::format("{} in {}", counted(jobs.tasks.size(), "script"),
                                         (path / "tasks").string()));
        print_entry("next", "the same command with --submit runs them");
        return ExitCode::done;
    }
    Stages stages(command.quiet);
    FarmLimits limits = command.limits;
    QueueWait queue(app, command, folder, jobs.tasks.size(), stages);
    std::string problem;
    if (command.engine == FarmEngine::slurm) problem = queue.run(submitted_arrays(folder));
    if (command.measures && problem.empty()) measure(folder, limits);
    int attempts = 0;
    for (; problem.empty() && attempts <= command.retries && open_count(folder) > 0; ++attempts) {
        if (command.engine == FarmEngine::parallel)
            run_parallel(folder, limits);
        else
            problem = queue.run(submit_slurm(folder, limits));
    }
    return finish_farm(app, command, folder, jobs, attempts, problem);
}

void add_options(CLI::App& app, FarmCommand& command) {
    add_file(app, "JOBS", command.jobs,
             "A JSON file: {\"jobs\": [{\"name\": \"vase\", \"command\": [\"bake\", \"mesh\", "
             "\"high.obj\", \"low.obj\", \"map.png\"], \"shards\": 16}]}. A command is the "
             "arguments of relief, relative to the current folder. Or the file of relief make "
             "--job.");
    add_choice(app, "--engine", command.engine, farm_engines,
               "Who runs the tasks: Slurm; GNU parallel on this machine, or on others with --pass "
               "--sshlogin=...; or commands, which prints the lines of a shell for any other "
               "engine. Default: commands.");
    add_value(
        app, "--shards", "N",
        "The number of shards of bake mesh, check, make and mesh process, if the job does not say "
        "it. Default: 1; for the file of relief make --job, one for each asset.",
        [&command](const std::string& subject, const std::string& text) {
            command.shards = static_cast<std::size_t>(parse_integer(subject, text, 1, 100'000));
        });
    add_path(app, "--folder", command.folder,
             "The folder of scripts, logs and parts, on a file system that all machines share. "
             "Default: .relief-farm-HASH in the current folder.");
    add_switch(app, "--submit", command.submits,
               "Run the tasks, wait for them, and run those that failed again. Tasks that are done "
               "are not repeated, also after an interruption. Default: only write the scripts.");
    add_switch(app, "--clean", command.cleans, "Remove the folder.");
    const std::string group = "Tasks";
    add_value(app, "--retries", "N", "How often failed tasks are repeated, 0 to 100. Default: 2.",
              [&command](const std::string& subject, const std::string& text) {
                  command.retries = parse_integer(subject, text, 0, 100);
              })
        .group(group);
    add_value(app, "--task-threads", "N", "Threads of a task. Default: 1.",
              [&command](const std::string& subject, const std::string& text) {
                  command.limits.threads =
                      static_cast<unsigned>(parse_integer(subject, text, 1, 1024));
              })
        .group(group);
    add_value(app, "--at-once", "N",
              "Run at most N tasks at once. Default: as many as processors, or as Slurm decides.",
              [&command](const std::string& subject, const std::string& text) {
                  command.limits.at_once =
                      static_cast<std::size_t>(parse_integer(subject, text, 1, 100'000));
              })
        .group(group);
    add_number(app, "--time", "MINUTES", command.limits.minutes, {1.0, 1e6, "minutes"},
               "Limit of the time of a task. Default: that of the engine.")
        .group(group);
    add_number(app, "--memory", "MB", command.limits.megabytes, {1.0, 1e9, "MB"},
               "Memory that Slurm reserves for a task. Default: that of Slurm.")
        .group(group);
    add_number(app, "--silence", "MINUTES", command.silence_minutes, {0.01, 1e5, "minutes"},
               "Give up if Slurm's controller does not answer for so long, with the exit code 1. "
               "Its tasks go on, and the same command continues. Default: 10.")
        .group(group);
    add_switch(app, "--measure", command.measures,
               "Run the first task here, and limit the time of the others to 4 times its time, and "
               "their memory to 1.5 times its memory.")
        .group(group);
    add_repeatable(app, "--pass", "WORD",
                   "Another argument of sbatch or parallel: --pass=--partition=long.",
                   [&command](const std::string&, const std::string& text) {
                       command.limits.passed_on.push_back(text);
                   })
        .group(group);
    add_value(app, "--report", "FILE",
              "Write the state of all tasks as JSON, or to standard output for -.",
              [&command](const std::string&, const std::string& text) {
                  command.report.file = text;
                  if (text == standard_stream) reserve_out_for_report();
              });
    add_switch(app, "--quiet", command.quiet, "Print only warnings and errors.");
    set_examples(app,
                 {"relief farm data/farm-jobs.json",
                  "relief farm data/farm-jobs.json --engine slurm --shards 4",
                  "relief farm data/make-job.json", "relief farm data/farm-jobs.json --clean"});
}

}  // namespace

Command add_farm_command(CLI::App& tool) {
    return add_command<FarmCommand>(
        tool, "farm", "Divides jobs into tasks for many machines: Slurm, GNU parallel or others.",
        add_options, run);
}

}  // namespace relief::tools
