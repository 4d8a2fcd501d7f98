// SPDX-License-Identifier: Apache-2.0
// All checks are made before a file is opened. Jobs run in parallel; their lines are printed in the
// order of the command line.
// Tests: tests/tools/file_jobs_test.cpp, batch_test.cpp.
#include "common/file_jobs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <mutex>
#include <optional>
#include <regex>
#include <set>

#include "common/command.h"
#include "common/summary.h"
#include "common/text.h"
#include "parallel.h"

namespace relief::tools {
using namespace relief::detail;

namespace {

namespace fs = std::filesystem;
using NameInFolder = std::function<fs::path(const fs::path&)>;

constexpr std::string_view first_tile = "1001";

bool is_folder(const std::string& output) {
    return output.ends_with('/') || fs::is_directory(output);
}

bool names_tiles(const fs::path& file) {
    return names_word(file, tile_word);
}

/// Returns the four digits in place of "<UDIM>", if the name matches the pattern.
std::optional<std::string> tile_of(const std::string& pattern, const std::string& name) {
    const std::size_t place = pattern.find(tile_word);
    const std::string_view after = std::string_view(pattern).substr(place + tile_word.size());
    if (name.size() != place + first_tile.size() + after.size()) return std::nullopt;
    std::string tile = name.substr(place, first_tile.size());
    const bool is_number = std::all_of(
        tile.begin(), tile.end(), [](unsigned char letter) { return std::isdigit(letter) != 0; });
    if (!is_number || tile < first_tile || !name.starts_with(pattern.substr(0, place)) ||
        !name.ends_with(after))
        return std::nullopt;
    return tile;
}

/// Returns the existing tiles in ascending order.
std::vector<std::string> tiles_of(const fs::path& file) {
    const std::string pattern = file.filename().string();
    const fs::path folder = file.parent_path().empty() ? "." : file.parent_path();
    std::vector<std::string> tiles;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        if (std::optional<std::string> tile = tile_of(pattern, entry.path().filename().string()))
            tiles.push_back(std::move(*tile));
    }
    if (tiles.empty())
        throw failure(file, "there is no such tile", "tiles are numbered 1001 and on");
    std::sort(tiles.begin(), tiles.end());
    return tiles;
}

/// Returns a job per tile, or the given job without tiles.
JobList in_tiles(const Job& job) {
    const bool has_tiles = names_tiles(job.input);
    if (has_tiles != names_tiles(job.output)) {
        throw UsageError(fmt::format("{}, {}: <UDIM> must be in both names or in none",
                                     job.input.string(), job.output.string()));
    }
    if (!has_tiles) return {{job}, std::nullopt, false};
    JobList list{{}, std::nullopt, true};
    for (const std::string& tile : tiles_of(job.input))
        list.jobs.push_back(
            {with_word(job.input, tile_word, tile), with_word(job.output, tile_word, tile)});
    return list;
}

/// IN OUT
JobList pair_of(const FileWords& words) {
    if (words.files.empty()) throw UsageError("IN is missing");
    if (words.files.size() == 1) throw UsageError("OUT is missing");
    if (words.files.size() > 2) {
        throw UsageError(
            fmt::format("{} files: inputs and output are ambiguous", words.files.size()),
            "for several inputs, give a folder: -o out/");
    }
    check_placeholders(words.files[1], std::array{tile_word});
    return in_tiles({words.files[0], words.files[1]});
}

/// IN -o OUT
JobList single(const FileWords& words, const std::string& kind) {
    const fs::path output = *words.output;
    if (words.files.size() > 1) {
        throw UsageError(fmt::format("-o {}: is a file, but there are {} {}s", output.string(),
                                     words.files.size(), kind),
                         "the name of a folder ends in /");
    }
    if (output.extension().empty())
        throw UsageError(fmt::format("-o {}: has no extension", *words.output),
                         "the name of a folder ends in /");
    check_placeholders(output, std::array{tile_word});
    return in_tiles({words.files[0], output});
}

/// Refuses jobs with the same input or the same output. An output cannot replace the input of
/// another job, because outputs keep the names of their inputs.
void check_clashes(const std::vector<Job>& jobs) {
    std::set<fs::path> inputs;
    for (const Job& job : jobs) {
        if (!inputs.insert(identity_of(job.input)).second)
            throw UsageError(job.input.string() + ": named twice", "name it once");
    }
    std::map<fs::path, fs::path> input_of;
    for (const Job& job : jobs) {
        const auto [known, is_new] = input_of.emplace(identity_of(job.output), job.input);
        if (is_new) continue;
        throw UsageError(fmt::format("{} and {}: have the same output {}", known->second.string(),
                                     job.input.string(), job.output.string()),
                         "process them by separate calls, to different folders");
    }
}

/// IN... -o DIR/
JobList into_folder(const FileWords& words, const NameInFolder& name_in_folder) {
    JobList list{{}, fs::path(*words.output), false};
    for (const fs::path& input : words.files) {
        const JobList tiles = in_tiles({input, *list.folder / name_in_folder(input)});
        list.jobs.insert(list.jobs.end(), tiles.jobs.begin(), tiles.jobs.end());
        list.has_tiles |= tiles.has_tiles;
    }
    check_clashes(list.jobs);
    return list;
}

}  // namespace

fs::path identity_of(const fs::path& file) {
    const fs::path whole = fs::absolute(file);
    std::error_code error;
    fs::path canonical = fs::weakly_canonical(whole, error);
    // A path with an error, such as a name that is too long, differs from all others. Opening it
    // reports the error.
    return error ? whole.lexically_normal() : canonical;
}

void check_distinct(const std::string& option, const fs::path& file,
                    const std::vector<fs::path>& others) {
    const fs::path identity = identity_of(file);
    for (const fs::path& other : others) {
        if (identity == identity_of(other)) {
            throw UsageError(
                fmt::format("{} {}: is also the input or the output", option, file.string()));
        }
    }
}

std::vector<fs::path> names_of(const std::map<fs::path, FileStamp>& files) {
    std::vector<fs::path> names;
    for (const auto& [file, stamp] : files)
        names.push_back(file);
    return names;
}

fs::path with_word(const fs::path& file, std::string_view word, const std::string& replacement) {
    std::string name = file.filename().string();
    const std::size_t place = name.find(word);
    if (place == std::string::npos) return file;
    name.replace(place, word.size(), replacement);
    return file.parent_path() / name;
}

bool names_word(const fs::path& file, std::string_view word) {
    return file.filename().string().find(word) != std::string::npos;
}

void check_placeholders(const fs::path& file, std::span<const std::string_view> known) {
    const std::string name = file.filename().string();
    static const std::regex placeholder("<[A-Za-z]+>");
    for (std::sregex_iterator match(name.begin(), name.end(), placeholder), end; match != end;
         ++match) {
        const std::string word = match->str();
        if (std::ranges::find(known, word) != known.end()) continue;
        throw UsageError(fmt::format("{}: {} is not a placeholder", file.string(), word),
                         fmt::format("use {}, or another name", fmt::join(known, " or ")));
    }
}

JobList jobs_of(const FileWords& words, const std::string& kind,
                const NameInFolder& name_in_folder) {
    if (!words.output) return pair_of(words);
    if (words.files.empty()) throw UsageError("IN is missing");
    return is_folder(*words.output) ? into_folder(words, name_in_folder) : single(words, kind);
}

// Running the jobs.

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
    } catch (const std::filesystem::filesystem_error& error) {
        return file_error(error).what();
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
            print_text(fmt::format("{}\n", printable(outcome.done->line)));
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

Json file_json(const Job& job, const Outcome& outcome) {
    Json json = {{"input", job.input.string()}, {"output", job.output.string()}};
    if (outcome.done)
        json.update(outcome.done->summary.json());
    else
        json["error"] = outcome.error;
    return json;
}

Json report_json(const Batch& batch, const std::vector<Outcome>& outcomes, std::size_t failed) {
    Json json = batch.head;
    json["failed"] = failed;
    json["files"] = Json::array();
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
    run_all(app, batch, outcomes, general.quiet || is_out_reserved());
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
