// SPDX-License-Identifier: Apache-2.0
// URIs in glTF files. Paths are checked as text, before any file is accessed; malformed base64
// throws InvalidInput. Source: RFC 2397, RFC 3986, RFC 4648.
#include "io/gltf/gltf_uri.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "relief/mesh/limits.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

int hexadecimal(char c) {
    if (is_digit(c)) return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// Decodes percent-encoded bytes; other percent signs stay.
std::string percent_decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const int high = i + 2 < text.size() ? hexadecimal(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? hexadecimal(text[i + 2]) : -1;
        if (text[i] == '%' && high >= 0 && low >= 0) {
            result += static_cast<char>(high * 16 + low);
            i += 2;
        } else {
            result += text[i];
        }
    }
    return result;
}

constexpr std::string_view base64_alphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string base64_decoded(std::string_view text) {
    static const auto values = [] {
        std::array<std::int8_t, 256> result{};
        result.fill(-1);
        for (std::size_t i = 0; i < base64_alphabet.size(); ++i) {
            result[static_cast<unsigned char>(base64_alphabet[i])] = static_cast<std::int8_t>(i);
        }
        return result;
    }();
    while (text.ends_with('='))
        text.remove_suffix(1);
    if (text.size() % 4 == 1) throw InvalidInput("base64 data ends in the middle of a byte");
    std::string result;
    result.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        const std::int8_t value = values[static_cast<unsigned char>(c)];
        if (value < 0) throw InvalidInput(fmt::format("byte {} is not base64", int{c}));
        bits = bits << 6U | static_cast<std::uint32_t>(value);
        bit_count += 6;
        if (bit_count < 8) continue;
        bit_count -= 8;
        result += static_cast<char>(bits >> static_cast<unsigned>(bit_count) & 0xFFU);
    }
    return result;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

DataUri decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == uri.npos) throw InvalidInput("is no data URI");
    std::string_view head = uri.substr(5, comma - 5);
    const std::string_view body = uri.substr(comma + 1);
    const bool is_base64 = head.ends_with(";base64");
    head = head.substr(0, head.find(';'));
    return {std::string(head), is_base64 ? base64_decoded(body) : percent_decoded(body)};
}

bool has_scheme(std::string_view uri) {
    if (uri.empty() || !is_letter(uri.front())) return false;
    std::size_t i = 0;
    while (i < uri.size() && (is_letter(uri[i]) || is_digit(uri[i]) || uri[i] == '+' ||
                              uri[i] == '-' || uri[i] == '.')) {
        ++i;
    }
    return i < uri.size() && uri[i] == ':';
}

std::optional<std::filesystem::path> path_inside(const std::filesystem::path& folder,
                                                 std::string_view uri) {
    const std::string name = percent_decoded(uri);
    if (name.empty() || has_scheme(uri) || name.find('\0') != name.npos) return std::nullopt;
    const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
    if (relative.is_absolute() || *relative.begin() == "..") return std::nullopt;
    const std::filesystem::path path = folder / relative;
    // Some writers do not encode percent signs.
    std::error_code ignored;
    const std::filesystem::path as_written = folder / std::filesystem::path(uri);
    if (!std::filesystem::exists(path, ignored) && name != uri && uri.find("..") == uri.npos &&
        uri.front() != '/' && std::filesystem::exists(as_written, ignored)) {
        return as_written;
    }
    return path;
}

std::optional<std::filesystem::path> readable_path(const std::filesystem::path& folder,
                                                   std::string_view uri) {
    if (auto path = path_inside(folder, uri)) return path;
    const std::string name = percent_decoded(uri);
    if (!input_limits().outside_files || name.empty() || has_scheme(uri) ||
        name.find('\0') != name.npos) {
        return std::nullopt;
    }
    return (folder / name).lexically_normal();
}

std::string uri_of(const std::string& file_name) {
    std::string result;
    for (const char c : file_name) {
        if (is_letter(c) || is_digit(c) || c == '-' || c == '.' || c == '_' || c == '~') {
            result += c;
        } else {
            result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return result;
}

std::string image_media_type(std::string_view bytes) {
    const auto at = [&](std::size_t offset, std::string_view text) {
        return bytes.size() >= offset + text.size() && bytes.substr(offset, text.size()) == text;
    };
    if (at(0, "\x89PNG\r\n\x1A\n")) return "image/png";
    if (at(0, "\xFF\xD8\xFF")) return "image/jpeg";
    if (at(0, "RIFF") && at(8, "WEBP")) return "image/webp";
    if (at(4, "ftypavif")) return "image/avif";
    if (at(0, "\xABKTX 20\xBB")) return "image/ktx2";
    if (at(0, "DDS ")) return "image/vnd-ms.dds";
    return {};
}

}  // namespace relief
