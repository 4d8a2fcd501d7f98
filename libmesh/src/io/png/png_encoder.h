// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writing PNG files without the image module, by rows and on all threads.
/// Tests: tests/mesh/io/png/png_test.cpp, image/image_rows_test.cpp.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "relief/mesh/image_rows.h"

namespace relief {

/// A PNG file in the making: header, sRGB chunk where the image is sRGB-coded, a tEXt chunk for
/// each entry, all samples. The same rows give the same bytes, however they are cut up.
class PngEncoder {
  public:
    /// Takes the next bytes of the file.
    using Output = std::function<void(std::string_view bytes)>;

    /// \param shape  of 1 to 4 channels, 8 or 16 bits, at most 2^30 bytes a row
    PngEncoder(const ImageShape& shape, const std::map<std::string, std::string>& text,
               WriteEffort effort, Output output);
    ~PngEncoder();

    /// The next rows, not more than there are. The end of the file follows the last one.
    void write(const std::byte* rows, std::size_t count);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// A whole PNG file in memory.
std::string encode_png(const Image& image, const std::map<std::string, std::string>& text);

}  // namespace relief
