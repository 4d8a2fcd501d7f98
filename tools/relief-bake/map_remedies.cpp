// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_bake_check_test.cpp, tests/check/check_report_test.cpp.
#include "map_remedies.h"

#include <algorithm>

namespace relief::tools {

std::string with_files(std::string_view command, const std::string& input,
                       const std::string& output) {
    std::string text;
    while (!command.empty()) {
        const std::size_t end = std::min(command.find(' '), command.size());
        const std::string_view word = command.substr(0, end);
        text += text.empty() ? "" : " ";
        text += word == "IN" ? input : word == "OUT" ? output : std::string(word);
        command.remove_prefix(std::min(end + 1, command.size()));
    }
    return text;
}

}  // namespace relief::tools
