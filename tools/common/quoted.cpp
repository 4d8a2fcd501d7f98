// SPDX-License-Identifier: Apache-2.0
#include "common/quoted.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace relief::tools {

std::string quoted(const std::filesystem::path& file) {
    const std::string name = file.string();
    const bool is_plain = std::all_of(name.begin(), name.end(), [](unsigned char letter) {
        return std::isalnum(letter) != 0 || letter > 127 ||
               std::string_view("/._-+=,:@%").find(static_cast<char>(letter)) !=
                   std::string_view::npos;
    });
    if (is_plain) return name;
    std::string result = "'";
    for (const char letter : name)
        result += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return result + "'";
}

}  // namespace relief::tools
