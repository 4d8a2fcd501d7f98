// SPDX-License-Identifier: Apache-2.0
#include "common/html.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

namespace relief::tools {

std::string html_escaped(std::string_view text) {
    static const std::map<char, std::string_view> entities = {
        {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
    std::string escaped;
    for (const char letter : text) {
        const auto entity = entities.find(letter);
        if (entity == entities.end())
            escaped += letter;
        else
            escaped += entity->second;
    }
    return escaped;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t given = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < given ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= given ? letters[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace relief::tools
