// SPDX-License-Identifier: Apache-2.0
// Fills the pages of `relief make`. Tests: tests/make/make_page_test.cpp.
#include "page_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "common/html.h"
#include "file_replacement.h"
#include "files.h"
#include "page_parts.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

/// Returns the bytes of a PNG file.
std::string png_of(const Image& image, const std::filesystem::path& folder) {
    const relief::detail::FileSet temporary;  // It is never committed.
    const std::filesystem::path file = folder / "picture.png";
    write_image(file, image);
    return relief::detail::read_file(file);
}

}  // namespace

std::string_view page_part(std::string_view name) {
    const auto& parts = make_page_parts();
    const auto found = std::ranges::find(parts, name, &MakePagePart::name);
    assert(found != parts.end());
    return found->text;
}

std::string filled_page(std::string_view name, const std::map<std::string, std::string>& texts) {
    std::string_view page = page_part(name);
    std::string result;
    while (true) {
        const std::size_t begin = page.find("{{");
        result += page.substr(0, begin);
        if (begin == std::string_view::npos) return result;
        const std::size_t end = page.find("}}", begin);
        assert(end != std::string_view::npos);
        result += texts.at(std::string(page.substr(begin + 2, end - begin - 2)));
        page.remove_prefix(end + 2);
    }
}

std::string html_image(const Image& image, const std::string& alt, const std::string& id,
                       const std::filesystem::path& folder) {
    const std::string name = id.empty() ? "" : fmt::format(" id=\"{}\"", id);
    return fmt::format(
        "<img{} alt=\"{}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\">", name,
        html_escaped(alt), image.width, image.height, base64(png_of(image, folder)));
}

}  // namespace relief::tools
