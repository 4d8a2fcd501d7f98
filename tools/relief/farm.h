// SPDX-License-Identifier: Apache-2.0
/// \file
/// Jobs on many machines: a list of commands is divided into tasks, which any engine can run in any
/// order and repeat, and merges, which follow. A folder on a shared file system holds a script for
/// each task and a mark for each finished one. Tests: tests/tools/farm_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/text.h"

namespace relief::tools {

/// A command of the farm: a shard, an undivided job, or a merge.
struct FarmTask {
    std::string name;                  ///< "vase 3/16" or "vase merge".
    std::vector<std::string> command;  ///< The program and its arguments.
    std::size_t job = 0;               ///< The index of its job.
    bool is_merge = false;             ///< It begins when all shards of the job are done.
};

struct FarmJobs {
    std::vector<std::string> names;  ///< Of the jobs.
    std::vector<FarmTask> tasks;     ///< Shards first, then merges.
};

/// Reads a list of jobs, or the file of `relief make --job`.
///
/// {"jobs": [{"name": "vase", "command": ["bake", "mesh", ...], "shards": 16}, ...]}; "name" and
/// "shards" may be missing. A divided job is `bake mesh`, `check`, `make` or `mesh process`.
/// \param shards   of jobs that do not state their number
/// \param parts    the folder for parts of bakes
/// \param threads  of a task, unless its command states them
/// \throws FileError
FarmJobs read_farm_jobs(const std::filesystem::path& file, std::optional<std::size_t> shards,
                        const std::filesystem::path& parts, unsigned threads);

/// Returns a word as bash, zsh and ksh read it. Control characters are escaped, so that the result
/// is one line.
std::string shell_word(const std::string& word);

/// Returns a command as a line of a shell.
std::string shell_line(const std::vector<std::string>& words);

/// The folder of a farm.
class FarmFolder {
  public:
    FarmFolder(const std::filesystem::path& folder, const FarmJobs& jobs);

    /// Writes the scripts of all tasks. \throws FileError
    void write_scripts() const;

    [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
    [[nodiscard]] std::filesystem::path script(std::size_t task) const;
    [[nodiscard]] std::filesystem::path log(std::size_t task) const;
    [[nodiscard]] bool is_done(std::size_t task) const;
    /// The tasks that are not done. \param merges  those of merges, or those of shards
    [[nodiscard]] std::vector<std::size_t> open_tasks(bool merges) const;

    /// Writes the scripts of some tasks into a list, one per line. \return its name
    std::filesystem::path write_list(const std::string& name,
                                     const std::vector<std::size_t>& tasks) const;

    /// The state of all tasks, with the exit code and the seconds of finished ones.
    [[nodiscard]] Json report() const;

  private:
    [[nodiscard]] std::filesystem::path done_mark(std::size_t task) const;
    [[nodiscard]] std::filesystem::path place(const char* kind, std::size_t task,
                                              const char* extension) const;

    std::filesystem::path folder_;
    const FarmJobs& jobs_;
};

struct FarmLimits {
    unsigned threads = 1;                ///< Of a task.
    std::optional<double> minutes;       ///< Of a task.
    std::optional<double> megabytes;     ///< Of a task.
    std::size_t at_once = 0;             ///< Tasks; 0: as many as the engine likes.
    std::vector<std::string> passed_on;  ///< Further arguments of sbatch or parallel.
};

/// Runs all open tasks, then the merges, with GNU parallel. Returns when it has ended.
/// \throws FileError if it cannot be run
void run_parallel(const FarmFolder& folder, const FarmLimits& limits);

/// Writes and submits arrays of Slurm for all open tasks, and arrays of the merges that depend on
/// them. Their numbers are stored in the folder, one by one.
/// \return the numbers of the arrays
/// \throws FileError if sbatch fails
std::vector<std::string> submit_slurm(const FarmFolder& folder, const FarmLimits& limits);

/// Returns the arrays that were submitted last, also by an interrupted farm.
std::vector<std::string> submitted_arrays(const FarmFolder& folder);

/// An answer of Slurm's queue.
struct QueueState {
    bool has_answered = true;
    bool has_arrays = false;
    std::string problem;  ///< Why it has not answered.
};

/// Looks for arrays in the queue of Slurm.
/// \throws FileError if squeue cannot be run
QueueState look_into_queue(const std::vector<std::string>& arrays);

}  // namespace relief::tools
