// SPDX-License-Identifier: Apache-2.0
/// \file
/// URIs in glTF files: data URIs, and names of files that lie beside the document.
/// Source: RFC 2397, RFC 3986, RFC 4648. Tests: tests/mesh/io/gltf/gltf_uri_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace relief {

/// What a data URI holds.
struct DataUri {
    std::string media_type;  ///< "image/png"; empty where none is given.
    std::string bytes;
};

bool is_data_uri(std::string_view uri);

/// \throws InvalidInput if it is no data URI or its base64 is malformed
DataUri decode_data_uri(std::string_view uri);

/// Whether a URI names its scheme ("https:", "file:"), so that it means the same from anywhere.
bool has_scheme(std::string_view uri);

/// The path that a relative URI means below a folder; nothing if it leads out of it: an absolute
/// path, "..", a scheme, or a zero byte.
std::optional<std::filesystem::path> path_inside(const std::filesystem::path& folder,
                                                 std::string_view uri);

/// A file name as a URI: bytes other than letters, digits and -._~ percent-encoded.
std::string uri_of(const std::string& file_name);

}  // namespace relief
