// SPDX-License-Identifier: Apache-2.0
#include "picture_sheet.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <variant>

namespace relief::tools {

bool has_numbers(const std::filesystem::path& output) {
    return output.filename().string().find('#') != std::string::npos;
}

Image sheet_of(const std::vector<std::vector<Image>>& rows) {
    const Image& first = rows.front().front();
    const std::size_t columns = rows.front().size();
    Image sheet = make_image(static_cast<int>(columns) * first.width,
                             static_cast<int>(rows.size()) * first.height, first.channels,
                             first.bits(), first.color_space);
    std::visit(
        [&](auto& to) {
            const auto line = static_cast<std::ptrdiff_t>(first.width) * first.channels;
            auto place = to.begin();
            for (const std::vector<Image>& row : rows) {
                for (std::ptrdiff_t y = 0; y < first.height; ++y) {
                    for (const Image& picture : row) {
                        const auto& from = std::get<std::decay_t<decltype(to)>>(picture.samples);
                        place = std::copy(from.begin() + y * line, from.begin() + (y + 1) * line,
                                          place);
                    }
                }
            }
        },
        sheet.samples);
    return sheet;
}

}  // namespace relief::tools
