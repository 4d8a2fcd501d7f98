// SPDX-License-Identifier: Apache-2.0
// Measures time and resident memory of several works in interleaved rounds.
#include "relief/accuracy/measure.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <string>

#include "progress_stage.h"
#include "relief/mesh/execution.h"

namespace relief {
namespace {

/// A time slice of the scheduler. Shorter rounds are mostly noise, and all rounds of a method could
/// be within one busy moment of the machine, which distorts the median.
constexpr double min_round_seconds = 4e-3;

/// Returns how often a work must be repeated so that a round is long enough.
std::size_t repeats_per_round(const std::function<void()>& work) {
    const double seconds = seconds_of(work);
    return seconds >= min_round_seconds
               ? 1
               : static_cast<std::size_t>(std::ceil(min_round_seconds / std::max(seconds, 1e-7)));
}

/// Limits parallel loops to one thread, and sets another limit when it is destroyed.
class OneThread {
  public:
    explicit OneThread(unsigned afterwards) : afterwards_(afterwards) { set_thread_limit(1); }
    ~OneThread() { set_thread_limit(afterwards_); }
    OneThread(const OneThread&) = delete;
    OneThread& operator=(const OneThread&) = delete;

  private:
    unsigned afterwards_;
};

/// Processor time of this process with all its threads, in seconds.
double processor_seconds() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Measures the processor time of one thread, which excludes the time of other programs; a wall
/// clock includes it.
double processor_seconds_of(const std::function<void()>& work) {
    constexpr double min_seconds = 1e-9;  // Work that only waits must have a positive time.
    const double begin = processor_seconds();
    work();
    return std::max(processor_seconds() - begin, min_seconds);
}

/// \param clock  returns the wall time or the processor time of a work
std::vector<Timing> timings(const std::string& group, std::span<const std::function<void()>> works,
                            const RunOptions& options,
                            double (*clock)(const std::function<void()>&)) {
    std::vector<std::size_t> times;
    for (const std::function<void()>& work : works) {
        check_cancelled();
        work();  // The first run fills caches and is slower.
        times.push_back(repeats_per_round(work));
    }
    return measure_interleaved_rounds(group, works.size(), options, [&](std::size_t i) {
        const double seconds = clock([&] {
            for (std::size_t repeat = 0; repeat < times[i]; ++repeat)
                works[i]();
        });
        return seconds / static_cast<double>(times[i]);
    });
}

/// The value of a line such as "VmHWM:   12345 kB" in /proc/self/status, in bytes.
std::optional<std::uint64_t> status_bytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::uint64_t kilobytes = 0;
        if (word == name + ":" && status >> kilobytes) return kilobytes * 1024;
    }
    return std::nullopt;
}

}  // namespace

std::vector<Timing> on_one_thread(const RunOptions& options,
                                  const std::function<std::vector<Timing>()>& measured) {
    const OneThread limit(options.threads);
    return measured();
}

std::vector<Timing> measure_interleaved_rounds(
    const std::string& group, std::size_t things, const RunOptions& options,
    const std::function<double(std::size_t thing)>& seconds_of_round) {
    std::vector<Timing> of_one_pass(things);
    std::vector<Timing>& timings =
        options.earlier ? options.earlier->group(group, things) : of_one_pass;
    Repeats repeats = options.repeats;
    if (options.earlier) repeats.counted = options.earlier->share_of(repeats.counted);
    interleave(things, repeats, [&](std::size_t thing, bool counted) {
        check_cancelled();
        const double seconds = seconds_of_round(thing);
        if (counted) timings[thing].rounds.push_back(seconds);
    });
    return timings;
}

std::optional<std::uint64_t> peak_bytes_of(const std::function<void()>& work) {
    ::malloc_trim(0);  // Otherwise the work could reuse memory that is already resident.
    std::ofstream reset("/proc/self/clear_refs");
    reset << 5 << std::flush;  // Sets VmHWM to the current VmRSS.
    const std::optional<std::uint64_t> before = status_bytes("VmRSS");
    if (!reset || !before) return std::nullopt;
    work();
    const std::optional<std::uint64_t> peak = status_bytes("VmHWM");
    if (!peak) return std::nullopt;
    return *peak - std::min(*peak, *before);
}

std::vector<Cost> measure_costs(std::span<const std::function<void()>> works,
                                const RunOptions& options, const CostChoice& choice) {
    std::vector<Cost> costs(works.size());
    if (!options.is_timed) return costs;
    if (choice.one_thread) {
        const std::vector<Timing> result = on_one_thread(
            options, [&] { return timings("one thread", works, options, processor_seconds_of); });
        for (std::size_t i = 0; i < works.size(); ++i)
            costs[i].one_thread = result[i];
    }
    set_thread_limit(options.threads);
    if (choice.all_threads) {
        const std::vector<Timing> result = timings("all threads", works, options, seconds_of);
        for (std::size_t i = 0; i < works.size(); ++i)
            costs[i].all_threads = result[i];
    }
    if (choice.memory) {
        for (std::size_t i = 0; i < works.size(); ++i)
            costs[i].peak_bytes = peak_bytes_of(works[i]);
    }
    return costs;
}

}  // namespace relief
