// SPDX-License-Identifier: Apache-2.0
#include "map_remedies.h"

#include <fmt/format.h>

#include <algorithm>

namespace relief::tools {
namespace {

/// As it is typed in a shell.
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

}  // namespace

std::string remedy_for(MapCondition condition, MapContent content,
                       const std::filesystem::path& file) {
    const std::string name = quoted(file);
    switch (condition) {
        case MapCondition::not_normals:
            if (content != MapContent::grey) return "";
            return fmt::format("relief-bake bump {} out.png", name);
        default:
            return "";
    }
}

}  // namespace relief::tools
