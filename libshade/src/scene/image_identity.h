// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whether an image is what it was when it was decoded last. Tests:
/// tests/shade/render/render_cache_test.cpp.
#pragma once

#include <filesystem>
#include <variant>

#include "relief/mesh/progress.h"
#include "relief/shade/scene.h"

namespace relief {

class ImageIdentity {
  public:
    explicit ImageIdentity(const ImageSource& source);

    /// The same value in memory; or a file of the same name whose stamp is what it was.
    [[nodiscard]] bool is(const ImageSource& source) const;

  private:
    struct File {
        std::filesystem::path path;
        FileStamp stamp;

        explicit File(std::filesystem::path name);
        bool operator==(const File&) const = default;
    };

    std::variant<File, Shared<std::vector<std::byte>>::Identity, Shared<Image>::Identity> identity_;

    static decltype(identity_) identity_of(const ImageSource& source);
};

}  // namespace relief
