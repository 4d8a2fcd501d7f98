// SPDX-License-Identifier: Apache-2.0
/// \file
/// Maps filled up to their borders, so that no mip level at all mixes in what is no part of the
/// mesh: what dilation.h does within some texels, without a limit. Tests:
/// tests/mesh/bake/border_fill_test.cpp.
///
/// Any texel may be filled from any other, so rows cannot be handed on before the last one is
/// there. Until then they are in a file without a name, which goes with the process whatever ends
/// it: 4 bytes a texel for each channel of each layer, and 3. In memory are a strip of 64 rows, and
/// what the system keeps of the file as long as it has nothing better to do with its memory.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "relief/mesh/bake.h"

namespace relief {

class BorderFill {
  public:
    static constexpr int largest_side = 32768;

    /// \param folder  where the file is to be: it needs room there
    /// \throws FileError if there can be none
    BorderFill(int width, int height, const std::filesystem::path& folder,
               std::function<void(const BakedRows&)> take);
    ~BorderFill();
    BorderFill(const BorderFill&) = delete;
    BorderFill& operator=(const BorderFill&) = delete;

    /// The next rows; all have the same layers. The last ones hand on all, in strips of 64 rows.
    /// \throws FileError if there is no room
    void push(const BakedRows& rows);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
