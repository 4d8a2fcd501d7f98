// SPDX-License-Identifier: Apache-2.0
// The folder of a farm, and the engines that run its scripts: GNU parallel and Slurm.
// Tests: tests/tools/farm_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "common/command.h"
#include "farm.h"
#include "run_program.h"

namespace relief::tools {
namespace {

/// Tasks in a folder of scripts, and tasks in an array of Slurm, whose default limit is 1001.
constexpr std::size_t group_size = 1000;

void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) throw FileError(file, "cannot be written; the disk may be full");
}

/// The script of a task. It does nothing if the task is done; its mark is a file that appears
/// complete or not at all.
std::string script_text(const FarmTask& task, const std::filesystem::path& working_folder,
                        const std::filesystem::path& done, const std::filesystem::path& log) {
    return fmt::format(
        "#!/bin/bash\n"
        "done={}\n"
        "log={}\n"
        "[ ! -e \"$done\" ] || exit 0\n"
        "cd -- {} || exit 1\n"
        "SECONDS=0\n"
        "{} >\"$log\" 2>&1 </dev/null\n"
        "code=$?\n"
        "case $code in\n"
        "0 | 3) ;;\n"
        "*) exit $code ;;\n"
        "esac\n"
        "echo \"$code $SECONDS\" >\"$done.$$\" && mv -f -- \"$done.$$\" \"$done\"\n",
        shell_word(done.string()), shell_word(log.string()), shell_word(working_folder.string()),
        shell_line(task.command));
}

/// The script of an array: runs the line of the list with the number of the task. A task that a
/// signal ended is put into the queue again.
std::string array_script(const std::filesystem::path& list) {
    return fmt::format(
        "#!/bin/bash\n"
        "script=$(sed -n \"${{SLURM_ARRAY_TASK_ID}}p\" {})\n"
        "eval \"script=$script\"\n"
        "bash -- \"$script\"\n"
        "code=$?\n"
        "if [ $code -gt 128 ] && [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt 3 ]; then\n"
        "    scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}\" && sleep 60\n"
        "fi\n"
        "exit $code\n",
        shell_word(list.string()));
}

/// The file of the numbers of arrays.
std::filesystem::path arrays_file(const FarmFolder& folder) {
    return folder.path() / "slurm" / "arrays.txt";
}

}  // namespace

FarmFolder::FarmFolder(const std::filesystem::path& folder, const FarmJobs& jobs)
    : folder_(std::filesystem::absolute(folder)), jobs_(jobs) {}

std::filesystem::path FarmFolder::place(const char* kind, std::size_t task,
                                        const char* extension) const {
    return folder_ / kind / std::to_string(task / group_size) /
           fmt::format("{}{}", task + 1, extension);
}

std::filesystem::path FarmFolder::script(std::size_t task) const {
    return place("tasks", task, ".sh");
}

std::filesystem::path FarmFolder::log(std::size_t task) const {
    return place("logs", task, ".txt");
}

std::filesystem::path FarmFolder::done_mark(std::size_t task) const {
    return place("done", task, "");
}

void FarmFolder::write_scripts() const {
    const std::filesystem::path working_folder = std::filesystem::current_path();
    make_folder(folder_ / "parts");
    make_folder(folder_ / "slurm");
    for (std::size_t task = 0; task < jobs_.tasks.size(); ++task) {
        if (task % group_size == 0) {
            for (const auto& file : {script(task), log(task), done_mark(task)})
                make_folder(file.parent_path());
        }
        // A script that exists is complete: the folder belongs to the same jobs.
        if (std::filesystem::exists(script(task))) continue;
        const std::filesystem::path draft = script(task).string() + ".new";
        write_text(draft,
                   script_text(jobs_.tasks[task], working_folder, done_mark(task), log(task)));
        std::filesystem::rename(draft, script(task));
    }
}

bool FarmFolder::is_done(std::size_t task) const {
    std::error_code error;
    return std::filesystem::exists(done_mark(task), error);
}

std::vector<std::size_t> FarmFolder::open_tasks(bool merges) const {
    std::vector<std::size_t> open;
    for (std::size_t task = 0; task < jobs_.tasks.size(); ++task) {
        if (jobs_.tasks[task].is_merge == merges && !is_done(task)) open.push_back(task);
    }
    return open;
}

std::filesystem::path FarmFolder::write_list(const std::string& name,
                                             const std::vector<std::size_t>& tasks) const {
    const std::filesystem::path file = folder_ / name;
    std::string text;
    for (const std::size_t task : tasks)
        text += shell_word(script(task).string()) + "\n";
    write_text(file, text);
    return file;
}

Json FarmFolder::report() const {
    Json tasks = Json::array();
    std::size_t failed = 0;
    for (std::size_t task = 0; task < jobs_.tasks.size(); ++task) {
        const FarmTask& one = jobs_.tasks[task];
        Json json = {{"job", jobs_.names[one.job]}, {"task", one.name}, {"done", is_done(task)}};
        std::ifstream mark(done_mark(task));
        int code = 0;
        double seconds = 0.0;
        if (mark >> code >> seconds) {
            json["exit_code"] = code;
            json["seconds"] = seconds;
        } else {
            ++failed;
            json["log"] = log(task).string();
        }
        tasks.push_back(std::move(json));
    }
    return {{"jobs", jobs_.names.size()},
            {"tasks", jobs_.tasks.size()},
            {"failed", failed},
            {"results", std::move(tasks)}};
}

void run_parallel(const FarmFolder& folder, const FarmLimits& limits) {
    for (const bool merges : {false, true}) {
        const std::vector<std::size_t> open = folder.open_tasks(merges);
        if (open.empty()) continue;
        std::vector<std::string> words = {"parallel", "--will-cite", "--no-notice"};
        const std::size_t at_once =
            limits.at_once > 0
                ? limits.at_once
                : std::max<std::size_t>(std::thread::hardware_concurrency() / limits.threads, 1);
        words.push_back(fmt::format("--jobs={}", at_once));
        if (limits.minutes) words.push_back(fmt::format("--timeout={:.0f}", 60 * *limits.minutes));
        words.insert(words.end(), limits.passed_on.begin(), limits.passed_on.end());
        // A line of the list is a word of a shell already: parallel must not quote it again.
        words.insert(words.end(),
                     {"-a", folder.write_list("list.txt", open).string(), "bash {= uq() =}"});
        const ProgramOutput output = run_program(words);
        if (output.exit_code == 127) {
            throw failure("parallel", "cannot be run: " + output.text,
                          "install GNU parallel, or use --engine commands");
        }
    }
}

std::vector<std::string> submit_slurm(const FarmFolder& folder, const FarmLimits& limits) {
    std::vector<std::string> arrays;
    std::ofstream submitted(arrays_file(folder));
    std::string shards;  // Their numbers, as a dependency.
    for (const bool merges : {false, true}) {
        const std::vector<std::size_t> open = folder.open_tasks(merges);
        for (std::size_t first = 0; first < open.size(); first += group_size) {
            const std::size_t count = std::min(group_size, open.size() - first);
            const std::string name =
                fmt::format("{}-{}", merges ? "merges" : "shards", first / group_size);
            const std::filesystem::path list =
                folder.write_list("slurm/" + name + ".txt",
                                  {open.begin() + static_cast<std::ptrdiff_t>(first),
                                   open.begin() + static_cast<std::ptrdiff_t>(first + count)});
            const std::filesystem::path script = folder.path() / "slurm" / (name + ".sh");
            write_text(script, array_script(list));
            std::vector<std::string> words = {
                "sbatch",
                "--parsable",
                "--requeue",
                "--job-name=relief-" + folder.path().filename().string(),
                fmt::format("--array=1-{}{}", count,
                            limits.at_once > 0 ? fmt::format("%{}", limits.at_once) : ""),
                fmt::format("--cpus-per-task={}", limits.threads),
                "--output=/dev/null",
                "--error=/dev/null"};
            if (limits.minutes) {
                words.push_back(fmt::format("--time={:.0f}", std::ceil(*limits.minutes)));
            }
            if (limits.megabytes) words.push_back(fmt::format("--mem={:.0f}M", *limits.megabytes));
            if (merges && !shards.empty()) words.push_back("--dependency=afterany" + shards);
            words.insert(words.end(), limits.passed_on.begin(), limits.passed_on.end());
            words.push_back(script.string());
            const ProgramOutput output = run_program(words);
            if (output.exit_code != 0) {
                throw failure("sbatch",
                              fmt::format("failed with {}{}", output.exit_code,
                                          output.text.empty() ? "" : ": " + output.text),
                              "submit from a machine of the cluster");
            }
            std::string number = output.text.substr(0, output.text.find_first_of(";\n"));
            if (!merges) shards += ":" + number;
            submitted << number << std::endl;
            arrays.push_back(std::move(number));
        }
    }
    return arrays;
}

std::vector<std::string> submitted_arrays(const FarmFolder& folder) {
    std::vector<std::string> arrays;
    std::ifstream stream(arrays_file(folder));
    for (std::string number; stream >> number;) {
        if (std::ranges::all_of(number, [](char digit) { return digit >= '0' && digit <= '9'; }))
            arrays.push_back(number);
    }
    return arrays;
}

QueueState look_into_queue(const std::vector<std::string>& arrays) {
    constexpr double limit = 60.0;  // squeue itself tries again for some seconds.
    if (arrays.empty()) return {};
    const ProgramOutput queue =
        run_program({"squeue", "--noheader", "--me", "--format=%F"}, CapturedStream::output, limit);
    if (queue.exit_code == 127) {
        throw failure("squeue", "cannot be run: " + queue.text, "wait on a machine of the cluster");
    }
    if (queue.exit_code == ProgramOutput::timed_out) return {false, false, "squeue does not end"};
    if (queue.exit_code != 0)
        return {false, false, fmt::format("squeue ended with {}", queue.exit_code)};
    std::istringstream lines(queue.text);
    for (std::string number; lines >> number;) {
        if (std::ranges::find(arrays, number) != arrays.end()) return {true, true, ""};
    }
    return {};
}

}  // namespace relief::tools
