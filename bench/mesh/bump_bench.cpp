// SPDX-License-Identifier: Apache-2.0
// Heights to 16-bit normal maps, interleaved with a naive loop, with OpenCV if it is installed, and
// with a triad over memory: `relief-bump-bench [SIDE [ROUNDS]]` prints a table in Markdown. All
// methods write into allocated memory.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "bench_support.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/statistics.h"

#ifdef RELIEF_HAS_OPENCV
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#endif

namespace relief::bench {
namespace {

/// A naive method: Sobel in float without border texels, green up.
void plain_loop(const Image& heights, float strength, Image& map) {
    const auto width = static_cast<std::size_t>(heights.width);
    const float* const in = heights.as<float>().data();
    std::uint16_t* const out = map.as<std::uint16_t>().data();
    const float scale = strength / 8.0F;
    for (std::size_t row = 1; row + 1 < static_cast<std::size_t>(heights.height); ++row) {
        const float* const a = in + (row - 1) * width;
        const float* const h = a + width;
        const float* const b = h + width;
        std::uint16_t* const to = out + row * width * 3;
        for (std::size_t i = 1; i + 1 < width; ++i) {
            const float right =
                (a[i + 1] + 2.0F * h[i + 1] + b[i + 1] - a[i - 1] - 2.0F * h[i - 1] - b[i - 1]) *
                scale;
            const float up =
                (a[i - 1] + 2.0F * a[i] + a[i + 1] - b[i - 1] - 2.0F * b[i] - b[i + 1]) * scale;
            const float length = 1.0F / std::sqrt(right * right + up * up + 1.0F);
            to[3 * i] = static_cast<std::uint16_t>(32768.5F - 32767.0F * right * length);
            to[3 * i + 1] = static_cast<std::uint16_t>(32768.5F - 32767.0F * up * length);
            to[3 * i + 2] = static_cast<std::uint16_t>(32768.5F + 32767.0F * length);
        }
    }
}

struct Fields {
    Image floats, codes;
    double strength = 1.0;
};

Fields fields(int side) {
    const std::vector<HeightWave> waves = tiling_waves(side, side, 6, 32.0, 0.2, 5);
    AnalyticHeights field = wave_heights(side, side, waves);
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
/// Computes two Sobel images, then normalizes and encodes the rows in a parallel loop of OpenCV.
void opencv_sobel(const Image& heights, Image& map, int threads) {
    cv::setNumThreads(threads);
    const cv::Mat in(heights.height, heights.width, CV_32F,
                     const_cast<float*>(heights.as<float>().data()));
    cv::Mat right;
    cv::Mat down;
    cv::Sobel(in, right, CV_32F, 1, 0, 3, 1.0 / 8.0, 0.0, cv::BORDER_REFLECT);
    cv::Sobel(in, down, CV_32F, 0, 1, 3, 1.0 / 8.0, 0.0, cv::BORDER_REFLECT);
    std::uint16_t* const out = map.as<std::uint16_t>().data();
    cv::parallel_for_(cv::Range(0, in.rows), [&](const cv::Range& rows) {
        for (int row = rows.start; row < rows.end; ++row) {
            const float* const x = right.ptr<float>(row);
            const float* const y = down.ptr<float>(row);
            std::uint16_t* const to = out + static_cast<std::ptrdiff_t>(row) * in.cols * 3;
            for (int i = 0; i < in.cols; ++i) {
                const float length = 1.0F / std::sqrt(x[i] * x[i] + y[i] * y[i] + 1.0F);
                to[3 * i] = static_cast<std::uint16_t>(32768.5F - 32767.0F * x[i] * length);
                to[3 * i + 1] = static_cast<std::uint16_t>(32768.5F + 32767.0F * y[i] * length);
                to[3 * i + 2] = static_cast<std::uint16_t>(32768.5F + 32767.0F * length);
            }
        }
    });
}

/// The same work by OpenCV, if it was found at build time. The images must outlive the result.
std::vector<Contender> bump_peers(const Image& heights, Image& map) {
    return {{"OpenCV, Sobel, float in", [&] { opencv_sobel(heights, map, 1); }},
            {"OpenCV, Sobel, float in, 2 threads", [&] { opencv_sobel(heights, map, 2); }}};
}
#else
std::vector<Contender> bump_peers(const Image&, Image&) {
    return {};
}
#endif

std::vector<Contender> contenders(const Fields& in, Triad& triad, Image& map) {
    std::vector<Contender> all;
    all.push_back({"plain loop, sobel3, float in",
                   [&in, &map] { plain_loop(in.floats, 1.0F, map); },
                   {},
                   bytes_a_texel(in.floats)});
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
    for (Contender& peer : bump_peers(in.floats, map)) {
        peer.bytes = bytes_a_texel(in.floats);
        all.push_back(std::move(peer));
    }
    all.push_back({"triad", [&triad] { triad.run(); }});
    return all;
}

int run(int argc, char** argv) {
    const int side = argc > 1 ? std::atoi(argv[1]) : 4096;
    const std::size_t rounds = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 15;
    const Fields in = fields(side);
    Image map = make_image(side, side, 3, 16, ColorSpace::data);
    Triad triad;
    std::vector<Contender> all = contenders(in, triad, map);
    measure(all, rounds);

    const double bandwidth = Triad::bytes / time_statistics(all.back().nanoseconds).median;
    const double texels = static_cast<double>(side) * side;
    fmt::print("{0} x {0} texels; median of {1} rounds in turns; triad {2:.1f} GB/s\n\n", side,
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
