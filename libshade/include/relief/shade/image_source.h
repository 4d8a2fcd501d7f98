// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines where the images of a scene come from.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/shade/shared.h"

namespace RELIEF_API relief {
namespace shade {

/// The source of an image: a file, an encoded file in memory, or a decoded image.
struct ImageSource {
    std::string name;  ///< For messages.
    std::variant<std::filesystem::path, Shared<std::vector<std::byte>>, Shared<Image>> source;
    std::string origin{};  ///< The file that names the image, for messages; empty: none.
    /// The reason why the image cannot be decoded; empty if there is none.
    std::string fault{};
    /// True if a Renderer throws if it cannot decode the image. Otherwise it reports the error and
    /// draws without the texture.
    bool is_required = false;
};

}  // namespace shade
}  // namespace relief
