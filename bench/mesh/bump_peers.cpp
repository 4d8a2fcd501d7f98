// SPDX-License-Identifier: Apache-2.0
#include "mesh/peers.h"

#ifdef RELIEF_HAS_OPENCV
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#endif

namespace relief::bench {

#ifdef RELIEF_HAS_OPENCV
namespace {

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

}  // namespace

std::vector<Peer> bump_peers(const Image& heights, Image& map) {
    return {{"OpenCV, Sobel, float in", [&] { opencv_sobel(heights, map, 1); }},
            {"OpenCV, Sobel, float in, 2 threads", [&] { opencv_sobel(heights, map, 2); }}};
}
#else
std::vector<Peer> bump_peers(const Image&, Image&) {
    return {};
}
#endif

}  // namespace relief::bench
