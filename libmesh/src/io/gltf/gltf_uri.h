// SPDX-License-Identifier: Apache-2.0
/// \file
/// URIs in glTF files (data URIs, and names of files beside the document) and media types of
/// images. Source: RFC 2397, RFC 3986, RFC 4648.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace relief {

/// The contents of a data URI.
struct DataUri {
    std::string media_type;  ///< "image/png"; empty if the URI has none.
    std::string bytes;
};

bool is_data_uri(std::string_view uri);

/// \throws InvalidInput if it is no data URI or its base64 is malformed
DataUri decode_data_uri(std::string_view uri);

/// Returns true if a URI has a scheme ("https:", "file:"), so that it does not depend on a folder.
bool has_scheme(std::string_view uri);

/// Returns the path of a relative URI below a folder; nullopt if it leads out of the folder
/// (absolute path,
/// "..", scheme) or has a zero byte.
std::optional<std::filesystem::path> path_inside(const std::filesystem::path& folder,
                                                 std::string_view uri);

/// The same for a file that is read: if the limits of the process permit it (relief/mesh/limits.h),
/// the path may lead out of the folder.
std::optional<std::filesystem::path> readable_path(const std::filesystem::path& folder,
                                                   std::string_view uri);

/// Encodes a file name as a URI: all bytes except letters, digits and -._~ are percent-encoded.
std::string uri_of(const std::string& file_name);

/// Returns the media type of an encoded image, from its first bytes: PNG, JPEG, WebP, AVIF, KTX2 or
/// DDS; empty for any other format.
std::string image_media_type(std::string_view bytes);

}  // namespace relief
