// SPDX-License-Identifier: Apache-2.0
// Image files read by rows. Tests: tests/mesh/io/image/image_rows_test.cpp.
#include <fmt/format.h>

#include "io/image/streamed_rows.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_rows.h"

namespace relief {

struct ImageRowReader::Implementation {
    std::unique_ptr<RowSource> source;
    std::size_t row_bytes = 0;
    int next = 0;
};

ImageRowReader::ImageRowReader(const std::filesystem::path& file)
    : implementation_(new Implementation) {
    Implementation& self = *implementation_;
    self.source = open_streamed_rows(file);
    if (!self.source)
        self.source = rows_of_image(read_image(file, ImageUse::data), read_image_info(file));
    self.row_bytes = row_bytes_of(info());
}

ImageRowReader::~ImageRowReader() = default;
ImageRowReader::ImageRowReader(ImageRowReader&&) noexcept = default;
ImageRowReader& ImageRowReader::operator=(ImageRowReader&&) noexcept = default;

const ImageInfo& ImageRowReader::info() const {
    return implementation_->source->info();
}

std::size_t ImageRowReader::row_bytes() const {
    return implementation_->row_bytes;
}

int ImageRowReader::next_row() const {
    return implementation_->next;
}

bool ImageRowReader::is_streamed() const {
    return implementation_->source->is_streamed();
}

void ImageRowReader::read(std::span<std::byte> rows) {
    Implementation& self = *implementation_;
    const std::size_t count = rows.size() / self.row_bytes;
    const auto left = static_cast<std::size_t>(info().height - self.next);
    if (rows.size() % self.row_bytes != 0 || count > left) {
        throw InvalidInput(
            fmt::format("{} bytes are not up to {} rows of {}", rows.size(), left, self.row_bytes));
    }
    self.source->read(rows.data(), count);
    self.next += static_cast<int>(count);
}

void ImageRowReader::skip(int rows) {
    Implementation& self = *implementation_;
    if (rows < 0 || rows > info().height - self.next) {
        throw InvalidInput(fmt::format("{} rows cannot be left out where {} are left", rows,
                                       info().height - self.next));
    }
    self.source->skip(static_cast<std::size_t>(rows));
    self.next += rows;
}

}  // namespace relief
