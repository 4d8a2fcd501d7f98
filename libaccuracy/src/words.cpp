// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/accuracy_report_test.cpp.
#include "relief/accuracy/words.h"

#include <fmt/format.h>

#include <array>

namespace relief {

std::string seconds_in_words(double seconds) {
    struct Unit {
        double seconds;
        const char* name;
    };
    static constexpr std::array units = {Unit{1e-9, "ns"}, Unit{1e-6, "µs"}, Unit{1e-3, "ms"},
                                         Unit{1.0, "s"}};
    // What would be rounded to 1000 is told in the next unit.
    std::size_t unit = 0;
    while (unit + 1 < units.size() && seconds >= 999.5 * units.at(unit).seconds)
        ++unit;
    const double value = seconds / units.at(unit).seconds;
    const int digits = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return fmt::format("{:.{}f} {}", value, digits, units.at(unit).name);
}

}  // namespace relief
