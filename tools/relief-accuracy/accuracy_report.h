// SPDX-License-Identifier: Apache-2.0
/// \file
/// A report on accuracy: the experiments, the machine and the settings, and its forms as JSON, CSV,
/// text and files. docs/accuracy-schema.md describes the JSON.
/// Tests: tests/tools/accuracy_report_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/mesh/statistics.h"

namespace relief::tools {

/// The machine and the build, on which times depend, without names of hosts or folders.
struct Machine {
    std::string processor;           ///< "AMD EPYC 7763 64-Core Processor"; empty: unknown.
    unsigned cores = 0;              ///< Available to this process.
    std::uint64_t memory_bytes = 0;  ///< 0: unknown.
    std::string system;              ///< "Debian GNU/Linux 12 (bookworm), Linux 6.1.0 x86_64"
    std::string compiler;            ///< "GCC 12.2.0"
    std::string build;               ///< "Release"
    /// "llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6"; absent without drawing.
    std::optional<std::string> opengl;

    friend bool operator==(const Machine&, const Machine&) = default;
};

/// The processors that other programs used during a run.
struct OtherPrograms {
    double processors = 0.0;  ///< The mean over the run.
    unsigned available = 0;   ///< All processors of the machine.

    /// Returns whether they lengthened wall-clock times noticeably.
    [[nodiscard]] bool is_busy() const { return processors > 0.05 * available; }

    friend bool operator==(const OtherPrograms&, const OtherPrograms&) = default;
};

/// "used 1.7 of 2 processors: the machine was busy, and wall-clock times are too long"
std::string to_string(const OtherPrograms& others);

/// Measures processor times from its construction. On Linux it reads /proc/stat.
class ProcessorUse {
  public:
    ProcessorUse();
    /// Returns the use by others since construction; nullopt if the system does not state it.
    [[nodiscard]] std::optional<OtherPrograms> of_others() const;

  private:
    Stopwatch clock_;
    double own_seconds_ = 0.0;
    std::optional<double> all_seconds_;
};

/// The version of the JSON that is written and read.
inline constexpr int report_version = 1;

struct RunSettings {
    bool quick = false;
    bool timed = true;
    std::size_t repeats = 0;  ///< In all passes together.
    std::size_t passes = 1;
    unsigned threads = 0;                           ///< The number of threads behind "all threads".
    std::optional<OtherPrograms> other_programs{};  ///< Absent: nothing was timed, or unknown.
};

struct AccuracyReport {
    std::string relief;   ///< The version of relief.
    std::string command;  ///< The command that repeats the run.
    Machine machine;
    RunSettings settings;
    std::vector<accuracy::Experiment> experiments;
};

/// \param draws  whether OpenGL was used; then its name is included
Machine this_machine(bool draws);

/// Returns the differences: "processor: A, then B", or an empty text.
std::string difference_of(const Machine& old_one, const Machine& new_one);

/// Returns whether absolute times are comparable: the machines are equal except for compiler and
/// build, which are part of the comparison.
bool may_compare_times(const Machine& old_one, const Machine& new_one);

/// \param has_files  whether the pictures are written; then the JSON names their files
nlohmann::ordered_json json_of(const AccuracyReport& report, bool has_files);
nlohmann::ordered_json json_of(const accuracy::Experiment& experiment, bool has_files);

/// Reads a report. Its pictures get only their titles. Unknown content is ignored.
///
/// \throws FileError with the place, as in "/experiments/0/id: is missing", if the file is not a
///         report of relief-accuracy, has another version, or is incomplete
AccuracyReport read_report(const std::filesystem::path& file);

/// Returns a CSV table (RFC 4180) with full precision and a row per measurement: experiment,
/// subject, method, choices ("a=b; c=d"), error_unit, count, undefined, rms, mean, p99, max, psnr,
/// item, items, one_thread_seconds with its _p10, _p90 and _rounds, the same for all_threads,
/// peak_bytes, stored_bytes, efficient (1 or 0).
std::string measurements_csv(const AccuracyReport& report);

/// Returns a CSV table with a row per point of a curve: experiment, chart, method, x_label, x,
/// error_unit, error.
std::string curves_csv(const AccuracyReport& report);

/// The kind of an experiment's picture.
enum class PictureRole { heat, before, after };

/// Returns a picture's path relative to the report: "pictures/bump-sine-heat-1.png".
std::string picture_file(const accuracy::Experiment& experiment, PictureRole role,
                         std::size_t index);

/// Writes a report to a folder: report.html, accuracy.json, accuracy.csv, accuracy-curves.csv and
/// pictures/. Each file is written beside its final name and renamed; the JSON is written last.
///
/// \return the main files
std::vector<std::filesystem::path> write_report(const std::filesystem::path& folder,
                                                const AccuracyReport& report);

/// Writes a text file beside its final name and renames it. \throws FileError
void write_text(const std::filesystem::path& file, const std::string& text);

/// Returns an experiment as text for a terminal: its question and input, a row per method, notes, a
/// line per curve, and the finding. Rows on the frontier begin with an asterisk. Empty columns are
/// omitted.
std::string table_of(const accuracy::Experiment& experiment);

}  // namespace relief::tools
