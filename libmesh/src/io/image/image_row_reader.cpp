// SPDX-License-Identifier: Apache-2.0
// Image files read by rows. Tests: tests/mesh/io/image/image_rows_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "relief/mesh/error.h"
#include "relief/mesh/image_rows.h"

namespace relief {

struct ImageRowReader::Implementation {
    ImageInfo info;
    Image image;
    std::size_t row_bytes = 0;
    int next = 0;
};

ImageRowReader::ImageRowReader(const std::filesystem::path& file)
    : implementation_(new Implementation) {
    Implementation& self = *implementation_;
    self.info = read_image_info(file);
    self.image = read_image(file, ImageUse::data);
    self.row_bytes = static_cast<std::size_t>(self.info.width) *
                     static_cast<std::size_t>(self.info.channels) *
                     static_cast<std::size_t>(self.info.bits / 8);
}

ImageRowReader::~ImageRowReader() = default;
ImageRowReader::ImageRowReader(ImageRowReader&&) noexcept = default;
ImageRowReader& ImageRowReader::operator=(ImageRowReader&&) noexcept = default;

const ImageInfo& ImageRowReader::info() const {
    return implementation_->info;
}

std::size_t ImageRowReader::row_bytes() const {
    return implementation_->row_bytes;
}

int ImageRowReader::next_row() const {
    return implementation_->next;
}

bool ImageRowReader::is_streamed() const {
    return false;
}

void ImageRowReader::read(std::span<std::byte> rows) {
    Implementation& self = *implementation_;
    const std::size_t count = rows.size() / self.row_bytes;
    const auto left = static_cast<std::size_t>(self.info.height - self.next);
    if (rows.size() % self.row_bytes != 0 || count > left) {
        throw InvalidInput(
            fmt::format("{} bytes are not up to {} rows of {}", rows.size(), left, self.row_bytes));
    }
    const auto all = std::visit([](const auto& held) { return std::as_bytes(std::span(held)); },
                                std::as_const(self.image.samples));
    const auto wanted =
        all.subspan(static_cast<std::size_t>(self.next) * self.row_bytes, rows.size());
    std::copy(wanted.begin(), wanted.end(), rows.begin());
    self.next += static_cast<int>(count);
}

void ImageRowReader::skip(int rows) {
    Implementation& self = *implementation_;
    if (rows < 0 || rows > self.info.height - self.next) {
        throw InvalidInput(fmt::format("{} rows cannot be left out where {} are left", rows,
                                       self.info.height - self.next));
    }
    self.next += rows;
}

}  // namespace relief
