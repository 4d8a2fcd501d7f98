// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy run SUBJECT...` runs experiments, prints a table of each, and writes a report.
// It shares its options and the description of the machine with `own`. Tests:
// tests/tools/accuracy_run_test.cpp, accuracy_report_test.cpp.
#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

#include "accuracy_report.h"
#include "commands.h"
#include "common/command.h"
#include "common/text.h"
#include "parallel.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/execution.h"
#include "relief/shade/renderer.h"

namespace relief::tools {
using namespace relief::accuracy;
using namespace relief::detail;

// The options of `run` and `own`.

namespace {

constexpr int max_repeats = 1000;

}  // namespace

void add_experiment_options(CLI::App& app, ExperimentOptions& options) {
    add_value(app, "--output", "DIR",
              "Output folder for report.html (interactive plots in one file), accuracy.json, "
              "accuracy.csv (a row per measurement), accuracy-curves.csv (a row per point of a "
              "curve) and pictures/. It is created if necessary. Default: no files are written.",
              [&options](const std::string&, const std::string& text) { options.output = text; });
    add_switch(app, "--json", options.json,
               "Print the report as JSON instead of tables; docs/accuracy-schema.md describes it.");
    const char* group = "Effort";
    add_switch(app, "--quick", options.quick, "Use small inputs: all subjects take a few minutes.")
        .group(group);
    add_switch(
        app, "--no-times", options.no_times,
        "Measure only errors, which are the same in each run (with OpenGL, on the same renderer).")
        .group(group);
    add_value(
        app, "--repeats", "N",
        "The number of rounds of each time, interleaved with the other methods of the experiment, "
        "3 to 1000. With more rounds, `compare` detects smaller changes. Default: 10.",
        [&options](const std::string& subject, const std::string& text) {
            options.repeats = parse_integer(subject, text, 3, max_repeats);
        })
        .group(group);
    add_general_options(app, options.general);
}

void check(const ExperimentOptions& options) {
    if (options.json && options.general.quiet)
        throw UsageError("--json and --quiet contradict each other");
    if (options.no_times && options.repeats)
        throw UsageError("--no-times and --repeats contradict each other");
    if (options.general.quiet && !options.output)
        throw UsageError("--quiet without --output would discard the results");
}

RunOptions run_options(const ExperimentOptions& options) {
    RunOptions run;
    run.is_quick = options.quick;
    run.is_timed = !options.no_times;
    run.threads = options.general.threads;
    if (options.repeats) run.repeats.counted = static_cast<std::size_t>(*options.repeats);
    return run;
}

std::string repeated_options(const CLI::App& app) {
    constexpr std::array<std::string_view, 5> left_out = {"--output", "--json", "--quiet",
                                                          "--max-memory", "--max-pixels"};
    std::string text;
    for (const GivenOption& option : given_options(app, left_out)) {
        text += " " + option.name;
        for (const std::string& value : option.values)
            text += " " + quoted(std::filesystem::path(value));
    }
    return text;
}

bool prints_tables(const ExperimentOptions& options) {
    return !options.json && !options.general.quiet;
}

void prepare(const ExperimentOptions& options) {
    if (options.output) make_folder(*options.output);
    set_thread_limit(options.general.threads);
}

void finish_report(const ExperimentOptions& options, AccuracyReport report, bool draws,
                   const ProcessorUse& use) {
    const RunOptions run = run_options(options);
    report.relief = version();
    report.machine = this_machine(draws);
    report.settings = {.quick = options.quick,
                       .timed = run.is_timed,
                       .repeats = run.is_timed ? run.repeats.counted : 0,
                       .passes = report.settings.passes,
                       .threads = static_cast<unsigned>(thread_count()),
                       .other_programs = run.is_timed ? use.of_others() : std::nullopt};
    std::vector<std::string> written;
    if (options.output) {
        for (const std::filesystem::path& file : write_report(*options.output, report))
            written.push_back(file_and_size(file));
    }
    if (options.json) {
        print_json(json_of(report, options.output.has_value()));
    } else if (!options.general.quiet) {
        if (!options.no_times)
            print_text(
                "* efficient: faster than all efficient methods that are more accurate; times "
                "within 10 % are tied\n"
                "times: median, and range from the 10th to the 90th percentile of the rounds\n");
        if (report.settings.other_programs)
            print_text(
                fmt::format("other programs {}\n", to_string(*report.settings.other_programs)));
        print_entry("written", written);
    }
}

// The machine, described by /proc, uname and the compiler.

namespace {

/// Returns the text after `separator` in the first line of a file that begins with `key`.
std::string value_in(const char* file, const std::string& key, char separator) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t end = line.find(separator);
        if (!line.starts_with(key) || end == std::string::npos) continue;
        const std::size_t begin = line.find_first_not_of(" \"", end + 1);
        if (begin == std::string::npos) return "";
        return line.substr(begin, line.find_last_not_of(" \"") - begin + 1);
    }
    return "";
}

unsigned usable_cores() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<unsigned>(CPU_COUNT(&set));
    return std::thread::hardware_concurrency();
}

std::uint64_t installed_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES);
    const long size = sysconf(_SC_PAGE_SIZE);
    if (pages <= 0 || size <= 0) return 0;
    return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size);
}

std::string system_name() {
    utsname kernel{};
    uname(&kernel);
    const std::string kernel_name =
        fmt::format("{} {} {}", kernel.sysname, kernel.release, kernel.machine);
    const std::string distribution = value_in("/etc/os-release", "PRETTY_NAME", '=');
    return distribution.empty() ? kernel_name : fmt::format("{}, {}", distribution, kernel_name);
}

std::string compiler_name() {
#if defined(__clang__)
    return "Clang " __clang_version__;
#else
    return "GCC " __VERSION__;
#endif
}

std::optional<std::string> opengl_name() {
    try {
        return shade::Context().renderer_name();
    } catch (const shade::GpuError&) {
        return std::nullopt;
    }
}

/// The memory that the kernel reserves differs slightly between starts.
bool have_same_memory(const Machine& a, const Machine& b) {
    const auto least = static_cast<double>(std::min(a.memory_bytes, b.memory_bytes));
    const auto most = static_cast<double>(std::max(a.memory_bytes, b.memory_bytes));
    return most <= 1.02 * least;
}

}  // namespace

Machine this_machine(bool draws) {
    return {.processor = value_in("/proc/cpuinfo", "model name", ':'),
            .cores = usable_cores(),
            .memory_bytes = installed_memory(),
            .system = system_name(),
            .compiler = compiler_name(),
            .build = RELIEF_BUILD_TYPE,
            .opengl = draws ? opengl_name() : std::nullopt};
}

std::string difference_of(const Machine& old_one, const Machine& new_one) {
    std::vector<std::string> words;
    const auto compare = [&](const char* what, const std::string& before,
                             const std::string& after) {
        if (before != after) words.push_back(fmt::format("{}: {}, then {}", what, before, after));
    };
    compare("processor", old_one.processor, new_one.processor);
    compare("cores", fmt::to_string(old_one.cores), fmt::to_string(new_one.cores));
    if (!have_same_memory(old_one, new_one))
        compare("memory", byte_size(old_one.memory_bytes), byte_size(new_one.memory_bytes));
    compare("system", old_one.system, new_one.system);
    compare("compiler", old_one.compiler, new_one.compiler);
    compare("build", old_one.build, new_one.build);
    if (old_one.opengl && new_one.opengl) compare("OpenGL", *old_one.opengl, *new_one.opengl);
    return fmt::format("{}", fmt::join(words, "; "));
}

bool may_compare_times(const Machine& old_one, const Machine& new_one) {
    const bool same_opengl =
        !old_one.opengl || !new_one.opengl || *old_one.opengl == *new_one.opengl;
    return old_one.processor == new_one.processor && old_one.cores == new_one.cores &&
           have_same_memory(old_one, new_one) && old_one.system == new_one.system && same_opengl;
}

// The load by other programs.

namespace {

/// Returns the processor time of this process and of its children that have ended.
double own_seconds() {
    double seconds = 0.0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage use{};
        getrusage(who, &use);
        for (const timeval& time : {use.ru_utime, use.ru_stime})
            seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return seconds;
}

/// Returns the time that all processors were busy since the start of the system.
std::optional<double> all_seconds() {
    std::ifstream stream("/proc/stat");
    std::string name;
    // Guests count as "user" already.
    double user = 0, nice = 0, system = 0, idle = 0, waiting = 0, irq = 0, softirq = 0, steal = 0;
    stream >> name >> user >> nice >> system >> idle >> waiting >> irq >> softirq >> steal;
    const long ticks = sysconf(_SC_CLK_TCK);
    if (!stream || name != "cpu" || ticks <= 0) return std::nullopt;
    return (user + nice + system + irq + softirq + steal) / static_cast<double>(ticks);
}

}  // namespace

std::string to_string(const OtherPrograms& others) {
    return fmt::format(
        "used {:.2g} of {} processors{}", others.processors, others.available,
        others.is_busy() ? ": the machine was busy, and wall-clock times are too long" : "");
}

ProcessorUse::ProcessorUse() : own_seconds_(own_seconds()), all_seconds_(all_seconds()) {}

std::optional<OtherPrograms> ProcessorUse::of_others() const {
    const std::optional<double> all = all_seconds();
    const double wall = clock_.seconds();
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    if (!all || !all_seconds_ || !(wall > 0.0) || processors <= 0) return std::nullopt;
    const double others = *all - *all_seconds_ - (own_seconds() - own_seconds_);
    const auto available = static_cast<unsigned>(processors);
    return OtherPrograms{std::clamp(others / wall, 0.0, static_cast<double>(available)), available};
}

// The command `run`.

namespace {

constexpr int max_passes = 100;

struct RunCommandOptions {
    std::vector<std::string> words;
    std::optional<int> passes;
    ExperimentOptions how;

    /// The default is 3 passes: the median is robust if a third of the rounds is disturbed.
    [[nodiscard]] std::size_t pass_count() const {
        return how.no_times ? 1 : static_cast<std::size_t>(passes.value_or(3));
    }
};

std::string subject_choices() {
    std::string words = "all";
    for (const EnumName<Subject>& one : enum_names<Subject>)
        words += std::string(", ") + one.name;
    return words;
}

/// Returns the requested subjects in the order of reports. \throws UsageError
std::vector<Subject> subjects_of(const std::vector<std::string>& words) {
    const bool is_all = words == std::vector<std::string>{"all"};
    std::vector<Subject> requested;
    std::vector<std::string_view> known;
    for (const EnumName<Subject>& one : enum_names<Subject>) {
        known.emplace_back(one.name);
        const auto count = std::count(words.begin(), words.end(), known.back());
        if (count > 1) throw UsageError(fmt::format("{}: given twice", one.name));
        if (is_all || count == 1) requested.push_back(one.value);
    }
    for (const std::string& word : words) {
        if (is_all || std::find(known.begin(), known.end(), word) != known.end()) continue;
        throw UsageError(word == "all" ? "all: includes the other subjects"
                                       : fmt::format("{}: not one of {}", word, subject_choices()));
    }
    return requested;
}

/// Returns the command that repeats the run.
std::string command_for(const CLI::App& app, const std::string& subjects) {
    return "relief-accuracy run " + subjects + repeated_options(app);
}

/// Runs all subjects. The last pass prints each table as soon as it is complete.
std::vector<Experiment> run_subjects(const CLI::App& app, const std::vector<Subject>& subjects,
                                     const RunCommandOptions& options, Stages& stages) {
    RunOptions run = run_options(options.how);
    run.passes = options.pass_count();
    run.tell = [&](const RunProgress& progress) {
        const auto all = static_cast<double>(run.passes * progress.total);
        const std::size_t done = progress.pass * progress.total + progress.done;
        stages.show_progress(
            fmt::format("pass {} of {}, {} of {} ({}):", progress.pass + 1, run.passes,
                        progress.done + 1, progress.total, progress.title),
            static_cast<double>(done) / all);
    };
    run.finished = [&](Experiment& experiment) {
        experiment.command = command_for(app, enum_name(experiment.subject));
        if (!prints_tables(options.how)) return;
        stages.clear_progress();
        print_text(fmt::format("{}\n", printable_lines(table_of(experiment))));
        std::fflush(out());
    };
    std::vector<Experiment> experiments = run_experiments(subjects, run);
    stages.clear_progress();
    return experiments;
}

void check(const RunCommandOptions& options) {
    check(options.how);
    if (!options.passes) return;
    if (options.how.no_times) throw UsageError("--no-times and --passes contradict each other");
    const std::size_t rounds = run_options(options.how).repeats.counted;
    if (options.pass_count() > rounds) {
        throw UsageError(fmt::format("--passes {}: more than the {} of each time", *options.passes,
                                     counted(rounds, "round")),
                         "give more --repeats");
    }
}

ExitCode run(const CLI::App& app, const RunCommandOptions& options) {
    check(options);
    const std::vector<Subject> subjects = subjects_of(options.words);
    prepare(options.how);
    Stages stages(options.how.general.quiet);
    AccuracyReport report;
    const ProcessorUse use;
    report.experiments = run_subjects(app, subjects, options, stages);
    report.settings.passes = options.pass_count();
    report.command = command_for(app, fmt::format("{}", fmt::join(options.words, " ")));
    const bool draws = std::any_of(subjects.begin(), subjects.end(), uses_opengl);
    finish_report(options.how, std::move(report), draws, use);
    return ExitCode::done;
}

void add_options(CLI::App& app, RunCommandOptions& options) {
    app.add_option("SUBJECT", options.words,
                   fmt::format("The subjects to measure, one or more of {}.", subject_choices()))
        ->required();
    add_experiment_options(app, options.how);
    add_value(
        app, "--passes", "N",
        "The number of passes over all experiments, 1 to 100. The repeats are distributed over the "
        "passes, so that a disturbance of the machine affects only one pass. Default: 3.",
        [&options](const std::string& subject, const std::string& text) {
            options.passes = parse_integer(subject, text, 1, max_passes);
        })
        .group("Effort");
    set_examples(app, {"relief-accuracy run storage --quick --output out/accuracy",
                       "relief-accuracy run storage --quick --no-times --json"});
}

}  // namespace

Command add_run_command(CLI::App& tool) {
    return add_command<RunCommandOptions>(
        tool, "run", "Measures the error and time of methods on inputs with a known ground truth.",
        add_options, run);
}

}  // namespace relief::tools
