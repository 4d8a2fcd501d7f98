// SPDX-License-Identifier: Apache-2.0
// Tests: tests/shade/render/render_cache_test.cpp.
#include "scene/image_identity.h"

#include <utility>

namespace relief {

/// A file that cannot be looked at is as one that is not there; reading it says what is wrong.
ImageIdentity::File::File(std::filesystem::path name)
    : path(std::move(name)), stamp(stamp_of(path)) {}

decltype(ImageIdentity::identity_) ImageIdentity::identity_of(const ImageSource& source) {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) return File(*file);
    if (const auto* bytes = std::get_if<Shared<std::vector<std::byte>>>(&source.source))
        return bytes->identity();
    return std::get<Shared<Image>>(source.source).identity();
}

ImageIdentity::ImageIdentity(const ImageSource& source) : identity_(identity_of(source)) {}

bool ImageIdentity::is(const ImageSource& source) const {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) {
        const auto* known = std::get_if<File>(&identity_);
        return known != nullptr && *known == File(*file);
    }
    if (const auto* bytes = std::get_if<Shared<std::vector<std::byte>>>(&source.source)) {
        const auto* known = std::get_if<Shared<std::vector<std::byte>>::Identity>(&identity_);
        return known != nullptr && known->is(*bytes);
    }
    const auto* known = std::get_if<Shared<Image>::Identity>(&identity_);
    return known != nullptr && known->is(std::get<Shared<Image>>(source.source));
}

}  // namespace relief
