// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tells whether an image is unchanged since it was decoded.
#pragma once

#include <filesystem>
#include <variant>

#include "relief/mesh/execution.h"
#include "relief/shade/scene.h"

namespace relief {

class ImageIdentity {
  public:
    explicit ImageIdentity(const ImageSource& source);

    /// Tells whether the source is the same value in memory, or a file of the same name and stamp.
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
