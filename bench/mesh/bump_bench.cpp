// SPDX-License-Identifier: Apache-2.0
// Heights to 16-bit normal maps in existing memory, in tables in Markdown:
//
//   relief-bump-bench [SIDE [ROUNDS]]   all kernels, with a triad over memory
//   relief-bump-bench peers [ROUNDS]    sobel3 on one thread relative to plain loops, to OpenCV if
//                                       it is installed, and to copying memory, by instruction set
//   relief-bump-bench choice [ROUNDS]   the choice of a kernel relative to the conversion
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bench_support.h"
#include "mesh/plain_bump_loops.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/statistics.h"

#ifdef RELIEF_HAS_OPENCV
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#endif

namespace relief::bench {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

struct Fields {
    Image floats, codes;
    double strength = 1.0;
};

Fields fields(int side) {
    const std::vector<HeightWave> waves = tiling_waves(side, side, 6, 32.0, 0.2, 5);
    BumpField field = wave_heights(side, side, waves);
    CodedHeights coded = coded_heights(field.heights, 16);
    return {std::move(field.heights), std::move(coded.codes), coded.strength};
}

/// The minimum memory traffic: heights are read once, and codes are written once.
double bytes_a_texel(const Image& heights) {
    return heights.bits() / 8.0 + 6.0;
}

Contender ours(const Image& heights, std::string name, BumpOptions options, unsigned threads,
               Image& map) {
    return {fmt::format("relief, {}{}", name, threads == 1 ? "" : ", 2 threads"),
            [&heights, options, threads, &map] {
                set_thread_limit(threads);
                Report report;
                normal_map_from_height(heights, options, {}, map, report);
            },
            {},
            bytes_a_texel(heights)};
}

BumpOptions options_of(Kernel kernel, double strength,
                       std::optional<Arithmetic> arithmetic = std::nullopt) {
    BumpOptions options{kernel, Wrap::repeat, strength};
    options.arithmetic = arithmetic;
    return options;
}

#ifdef RELIEF_HAS_OPENCV
/// Computes two Sobel images, then encodes the rows in a parallel loop of OpenCV. The borders are
/// reflected, because OpenCV's filters cannot repeat them.
///
/// \param right, down  memory that calls reuse
void opencv_sobel(VectorTarget target, const Image& heights, Image& map, int threads,
                  cv::Mat& right, cv::Mat& down) {
    cv::setNumThreads(threads);
    const cv::Mat in(heights.height, heights.width, CV_32F,
                     const_cast<float*>(heights.as<float>().data()));
    cv::Sobel(in, right, CV_32F, 1, 0, 3, 1.0 / 8.0, 0.0, cv::BORDER_REFLECT);
    cv::Sobel(in, down, CV_32F, 0, 1, 3, 1.0 / 8.0, 0.0, cv::BORDER_REFLECT);
    std::uint16_t* const out = map.as<std::uint16_t>().data();
    cv::parallel_for_(cv::Range(0, in.rows), [&](const cv::Range& rows) {
        for (int row = rows.start; row < rows.end; ++row) {
            plain_codes_of_slopes(target, right.ptr<float>(row), down.ptr<float>(row),
                                  static_cast<std::size_t>(in.cols),
                                  out + static_cast<std::ptrdiff_t>(row) * in.cols * 3);
        }
    });
}
#endif

std::vector<Contender> contenders(const Fields& in, Triad& triad, Image& map) {
    const VectorTarget target = best_vector_target();
    std::vector<Contender> all;
    for (const std::size_t size : plain_block_sizes) {
        all.push_back(
            {fmt::format("plain loop in blocks of {}, sobel3, float in", size),
             [&in, &map, target, size] { plain_sobel_codes(target, size, in.floats, 1.0F, map); },
             {},
             bytes_a_texel(in.floats)});
    }
    for (const unsigned threads : {1U, 2U}) {
        all.push_back(
            ours(in.floats, "sobel3, float in", options_of(Kernel::sobel3, 1.0), threads, map));
        all.push_back(ours(in.codes, "sobel3, 16 bit in", options_of(Kernel::sobel3, in.strength),
                           threads, map));
    }
    for (const auto& [name, kernel] :
         {std::pair{"central3", Kernel::central3}, std::pair{"scharr3", Kernel::scharr3},
          std::pair{"central5", Kernel::central5}, std::pair{"sobel5", Kernel::sobel5},
          std::pair{"central7", Kernel::central7},
          std::pair{"gaussian, radius 2", Kernel::gaussian}})
        all.push_back(
            ours(in.floats, fmt::format("{}, float in", name), options_of(kernel, 1.0), 1, map));
    all.push_back(ours(in.floats, "sobel3, float in, in double",
                       options_of(Kernel::sobel3, 1.0, Arithmetic::float64), 1, map));
#ifdef RELIEF_HAS_OPENCV
    for (const int threads : {1, 2}) {
        all.push_back({fmt::format("OpenCV, Sobel, float in{}", threads == 1 ? "" : ", 2 threads"),
                       [&in, &map, target, threads, right = cv::Mat(), down = cv::Mat()]() mutable {
                           opencv_sobel(target, in.floats, map, threads, right, down);
                       },
                       {},
                       bytes_a_texel(in.floats)});
    }
#endif
    all.push_back({"triad", [&triad] { triad.run(); }});
    return all;
}

/// Reads and writes as much memory as a conversion of float heights, as fast as the C library can.
void copy_as_much(const Image& heights, Image& map) {
    auto* const to = reinterpret_cast<char*>(map.as<std::uint16_t>().data());
    const std::size_t bytes = heights.as<float>().size() * sizeof(float);
    std::memcpy(to, heights.as<float>().data(), bytes);
    std::memset(to + bytes, 0, bytes / 2);
}

/// The library and its peers on one thread, with the instruction set of a target.
std::vector<Contender> peers(VectorTarget target, const Fields& in, Image& map) {
    std::vector<Contender> all;
    all.push_back(ours(in.floats, "sobel3", options_of(Kernel::sobel3, 1.0), 1, map));
    for (const std::size_t size : plain_block_sizes) {
        all.push_back({fmt::format("plain loop, blocks of {}", size), [&in, &map, target, size] {
                           plain_sobel_codes(target, size, in.floats, 1.0F, map);
                       }});
    }
    all.push_back({"copying memory", [&in, &map] { copy_as_much(in.floats, map); }});
#ifdef RELIEF_HAS_OPENCV
    all.push_back(
        {"OpenCV, Sobel", [&in, &map, target, right = cv::Mat(), down = cv::Mat()]() mutable {
             opencv_sobel(target, in.floats, map, 1, right, down);
         }});
#endif
    return all;
}

/// \throws std::runtime_error if a plain loop gives other codes than the library
void check_equal_codes(const std::vector<Contender>& all, Image& map) {
    all[0].run();
    const Image expected = map;
    for (std::size_t i = 1; i <= std::size(plain_block_sizes); ++i) {
        std::ranges::fill(map.as<std::uint16_t>(), std::uint16_t{0});
        all[i].run();
        if (map.samples != expected.samples)
            throw std::runtime_error(all[i].name + " has other codes than relief");
    }
}

/// Stores processor times, which other processes disturb less than wall-clock times.
void measure_processor_time(std::vector<Contender>& all, std::size_t rounds) {
    interleave(all.size(), {rounds, 2}, [&](std::size_t i, bool counted) {
        const std::clock_t start = std::clock();
        all[i].run();
        const auto ticks = static_cast<double>(std::clock() - start);
        if (counted) all[i].nanoseconds.push_back(1e9 * ticks / CLOCKS_PER_SEC);
    });
}

/// Prints one row: the speed, and the median over rounds of each peer's time relative to relief's.
void compare_with_peers(VectorTarget target, int side, std::size_t rounds) {
    setenv("RELIEF_VECTOR_BITS", std::to_string(static_cast<int>(target)).c_str(), 1);
    const Fields in = fields(side);
    Image map = make_image(side, side, 3, 16, ColorSpace::data);
    std::vector<Contender> all = peers(target, in, map);
    check_equal_codes(all, map);
    measure_processor_time(all, rounds);
    const double texels = static_cast<double>(side) * side;
    fmt::print("| {} x {}, {} bits | {:.0f} |", side, side, static_cast<int>(target),
               1e3 * texels / time_statistics(all[0].nanoseconds).median);
    for (std::size_t i = 1; i < all.size(); ++i) {
        std::vector<double> ratios = all[i].nanoseconds;
        for (std::size_t round = 0; round < ratios.size(); ++round)
            ratios[round] /= all[0].nanoseconds[round];
        const TimeStatistics ratio = time_statistics(ratios);
        fmt::print(" {:.2f} ({:.2f} to {:.2f}) |", ratio.median, ratio.p10, ratio.p90);
    }
    fmt::print("\n");
}

int run_peers(std::size_t rounds) {
    const VectorTarget best = best_vector_target();
    fmt::print("Processor time on one thread; medians of {} interleaved rounds (10 to 90 %)\n\n",
               rounds);
    fmt::print("| texels, registers | relief, MPixel/s |");
    const Fields any = fields(64);
    Image map = make_image(64, 64, 3, 16, ColorSpace::data);
    const std::vector<Contender> all = peers(best, any, map);
    for (std::size_t i = 1; i < all.size(); ++i)
        fmt::print(" time of {} / relief |", all[i].name);
    fmt::print("\n|---|---|");
    for (std::size_t i = 1; i < all.size(); ++i)
        fmt::print("---|");
    fmt::print("\n");
    for (const VectorTarget target : {VectorTarget::wide, VectorTarget::widest}) {
        if (target > best) continue;
        for (const int side : {1024, 2048, 4096})
            compare_with_peers(target, side, rounds);
    }
    return 0;
}

/// The maps whose kernels are chosen.
std::span<const FieldRecipe> choice_fields() {
    using enum FieldShape;
    using enum FieldCoding;
    static const FieldRecipe all[] = {
        {"detailed, 8 bit", waves, 8.0, 0.3, bits8, 0.0, 3},
        {"smooth, 8 bit", waves, 32.0, 0.3, bits8, 0.0, 1},
        {"noise 0.1, 8 bit", waves, 32.0, 0.3, bits8, 0.1, 1},
        {"smooth, 16 bit", waves, 32.0, 0.3, bits16, 0.0, 1},
        {"noise 0.03, 16 bit", waves, 16.0, 0.3, bits16, 0.03, 1},
        {"smooth, float", waves, 32.0, 0.3, float32, 0.0, 1},
        {"terraces, float", terraces, 24.0, 1.0, float32, 0.0, 1},
    };
    return all;
}

/// Prints one row: the choice, and conversions to 16-bit codes in existing memory by the kernel.
void compare_choice_with_conversion(const FieldRecipe& recipe, int side, std::size_t rounds) {
    const BumpField field = make_bump_field(recipe, side, side);
    BumpOptions open = field.options;
    open.kernel.reset();
    const BumpOptions chosen = resolve_options(field.heights, open);
    BumpOptions exact = chosen;
    exact.arithmetic = Arithmetic::float64;
    Image map = make_image(side, side, 3, 16, ColorSpace::data);
    Image exact_map = map;
    std::vector<Contender> all{
        {"choice", [&] { resolve_options(field.heights, open); }},
        {"float32", [&] { normal_map_from_height(field.heights, chosen, {}, map); }},
        {"float64", [&] { normal_map_from_height(field.heights, exact, {}, exact_map); }}};
    std::vector<Contender> on_two_threads{all[0], all[1]};
    set_thread_limit(1);
    measure_processor_time(all, rounds);
    set_thread_limit(2);
    measure(on_two_threads, rounds);
    const auto median = [](const std::vector<double>& values) {
        return time_statistics(values).median;
    };
    const auto ratio = [&](const Contender& a, const Contender& b) {
        std::vector<double> ratios = a.nanoseconds;
        for (std::size_t i = 0; i < ratios.size(); ++i)
            ratios[i] /= b.nanoseconds[i];
        return median(ratios);
    };
    fmt::print(
        "| {0} x {0} | {1} | {2}{3} | {4:.1f} | {5:.1f} | {6:.1f} | {7:.2f} | {8:.2f} | {9:.2f} "
        "|\n",
        side, recipe.name, enum_name(*chosen.kernel),
        *chosen.kernel == Kernel::gaussian ? fmt::format(" {}", chosen.gaussian_radius) : "",
        1e-6 * median(all[0].nanoseconds), 1e-6 * median(all[1].nanoseconds),
        1e-6 * median(all[2].nanoseconds), ratio(all[0], all[1]), ratio(all[0], all[2]),
        ratio(on_two_threads[0], on_two_threads[1]));
}

int run_choice(std::size_t rounds) {
    fmt::print(
        "Milliseconds of processor time on one thread; medians of {} interleaved rounds\n\n"
        "| texels | map | kernel | choice | float32 | float64 | choice / float32 "
        "| choice / float64 | choice / float32, 2 threads, wall clock |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        rounds);
    for (const int side : {512, 1024, 2048, 4096}) {
        for (const FieldRecipe& recipe : choice_fields())
            compare_choice_with_conversion(recipe, side, rounds);
    }
    return 0;
}

int run(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "choice")
        return run_choice(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 11);
    if (argc > 1 && std::string_view(argv[1]) == "peers")
        return run_peers(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 31);
    const int side = argc > 1 ? std::atoi(argv[1]) : 4096;
    const std::size_t rounds = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 15;
    const Fields in = fields(side);
    Image map = make_image(side, side, 3, 16, ColorSpace::data);
    Triad triad;
    std::vector<Contender> all = contenders(in, triad, map);
    measure(all, rounds);

    const double bandwidth = Triad::bytes / time_statistics(all.back().nanoseconds).median;
    const double texels = static_cast<double>(side) * side;
    fmt::print("{0} x {0} texels; median of {1} interleaved rounds; triad {2:.1f} GB/s\n\n", side,
               rounds, bandwidth);
    fmt::print("| who | MPixel/s | p10 to p90 | of the triad |\n|---|---|---|---|\n");
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const TimeStatistics spread = time_statistics(all[i].nanoseconds);
        fmt::print("| {} | {:.0f} | {:.0f} to {:.0f} | {:.0f} % |\n", all[i].name,
                   1e3 * texels / spread.median, 1e3 * texels / spread.p90,
                   1e3 * texels / spread.p10,
                   100.0 * all[i].bytes * texels / spread.median / bandwidth);
    }
    return 0;
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    return relief::bench::run(argc, argv);
}
