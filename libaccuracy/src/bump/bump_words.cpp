// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/own_maps_test.cpp.
#include "bump/bump_words.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "analytic_words.h"

namespace relief {

std::string word_of(Kernel kernel) {
    constexpr std::array<std::string_view, 10> words = {
        "forward", "central3", "prewitt3", "sobel3",   "scharr3",
        "sobel5",  "scharr5",  "central5", "central7", "gaussian"};
    return std::string(words.at(static_cast<std::size_t>(kernel)));
}

std::string words_of(const Wraps& wraps) {
    constexpr std::array<std::string_view, 3> words = {"repeat", "clamp", "mirror"};
    const std::string x(words.at(static_cast<std::size_t>(wraps.x)));
    if (wraps.x == wraps.y) return x;
    return fmt::format("{},{}", x, words.at(static_cast<std::size_t>(wraps.y)));
}

MeasuredMethod measured_method(const BumpMethod& method, const ErrorFigures& error) {
    const std::string kernel = method.kernel == Kernel::gaussian
                                   ? fmt::format("gaussian {}", method.gaussian_radius)
                                   : word_of(method.kernel);
    const std::string bits = fmt::format("{} bit", method.bits);
    MeasuredMethod measured;
    measured.name = fmt::format("{}, {}, {}{}", kernel, word_of(method.arithmetic), bits,
                                method.destaircased ? ", steps smoothed" : "");
    measured.choices = {{"kernel", kernel},
                        {"arithmetic", word_of(method.arithmetic)},
                        {"depth", bits},
                        {"steps", method.destaircased ? "smoothed" : "as they are"}};
    measured.error = error;
    measured.stored_bytes = 3.0 * method.bits / 8.0;
    return measured;
}

}  // namespace relief
