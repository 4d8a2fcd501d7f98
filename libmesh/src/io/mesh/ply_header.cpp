// SPDX-License-Identifier: Apache-2.0
// Parses the header of PLY files. Malformed headers throw FileError.
#include "io/mesh/ply_header.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "files.h"
#include "io/mesh/mesh_formats.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

PlyType type_named(std::string_view name, const TextScanner& text) {
    static constexpr std::array<std::pair<std::string_view, PlyType>, 16> types = {{
        {"char", PlyType::int8},
        {"int8", PlyType::int8},
        {"uchar", PlyType::uint8},
        {"uint8", PlyType::uint8},
        {"short", PlyType::int16},
        {"int16", PlyType::int16},
        {"ushort", PlyType::uint16},
        {"uint16", PlyType::uint16},
        {"int", PlyType::int32},
        {"int32", PlyType::int32},
        {"uint", PlyType::uint32},
        {"uint32", PlyType::uint32},
        {"float", PlyType::float32},
        {"float32", PlyType::float32},
        {"double", PlyType::float64},
        {"float64", PlyType::float64},
    }};
    for (const auto& [known, type] : types) {
        if (known == name) return type;
    }
    text.fail(fmt::format("{} is not a PLY type", quoted(name)));
}

PlyProperty parse_property(TextScanner& text) {
    PlyProperty property;
    std::string_view word = text.word_on_line();
    if (word == "list") {
        property.count_type = type_named(text.word_on_line(), text);
        if (*property.count_type == PlyType::float32 || *property.count_type == PlyType::float64) {
            text.fail("a list is counted in a floating-point type");
        }
        word = text.word_on_line();
    }
    property.type = type_named(word, text);
    property.name = text.word_on_line();
    if (property.name.empty()) text.fail("a property has no name");
    if (const auto more = text.word_on_line(); !more.empty()) {
        text.fail(fmt::format("a property line continues with {}", quoted(more)));
    }
    return property;
}

PlyElement parse_element(TextScanner& text) {
    PlyElement element;
    element.name = text.word_on_line();
    const std::string_view count = text.word_on_line();
    const auto number = number_in<std::uint64_t>(count);
    if (element.name.empty() || !number) {
        text.fail(fmt::format("an element has the count {}", quoted(count)));
    }
    element.count = *number;
    return element;
}

PlyFormat parse_format(TextScanner& text) {
    const std::string_view format = text.word_on_line();
    if (format == "ascii") return PlyFormat::ascii;
    if (format == "binary_little_endian") return PlyFormat::little_endian;
    if (format == "binary_big_endian") return PlyFormat::big_endian;
    text.fail(fmt::format("{} is not a PLY format", quoted(format)));
}

}  // namespace

PlyHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& file) {
    TextScanner text(bytes, file);
    if (text.word() != "ply") throw FileError(file, "does not begin with 'ply'");
    text.skip_line();
    PlyHeader header;
    bool has_format = false;
    for (std::string_view word = text.word(); word != "end_header"; word = text.word()) {
        if (word.empty()) throw FileError(file, "the header has no end_header line");
        if (word == "format") {
            if (!header.elements.empty()) text.fail("the format must precede the elements");
            header.format = parse_format(text);
            has_format = true;
        } else if (word == "element") {
            header.elements.push_back(parse_element(text));
        } else if (word == "property") {
            if (header.elements.empty()) text.fail("a property must follow an element");
            header.elements.back().properties.push_back(parse_property(text));
        } else if (word != "comment" && word != "obj_info") {
            text.fail(fmt::format("{} is not a keyword of PLY headers", quoted(word)));
        }
        text.skip_line();
    }
    if (!has_format) throw FileError(file, "the header has no format");
    text.skip_line();
    header.data_begin = bytes.size() - text.rest().size();
    return header;
}

}  // namespace relief::detail
