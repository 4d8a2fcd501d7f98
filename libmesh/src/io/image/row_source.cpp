// SPDX-License-Identifier: Apache-2.0
// What all sources of rows share, and the one that an image in memory is.
// Tests: tests/mesh/io/image/image_rows_test.cpp.
#include "io/image/row_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "progress_stage.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_rows.h"

namespace relief {
namespace {

class ImageSource final : public RowSource {
  public:
    ImageSource(Image image, ImageInfo info) : image_(std::move(image)), info_(std::move(info)) {}

    [[nodiscard]] const ImageInfo& info() const override { return info_; }
    [[nodiscard]] bool is_streamed() const override { return false; }

    void read(std::byte* rows, std::size_t count) override {
        const std::size_t row = row_bytes_of(info_);
        const std::byte* const all =
            std::visit([](const auto& held) { return std::as_bytes(std::span(held)).data(); },
                       std::as_const(image_.samples));
        std::memcpy(rows, all + next_ * row, count * row);
        next_ += count;
    }
    void skip(std::size_t count) override { next_ += count; }

  private:
    Image image_;
    ImageInfo info_;
    std::size_t next_ = 0;
};

template <typename Sample>
std::vector<Sample> all_samples(RowSource& rows) {
    constexpr std::size_t bytes_per_step = std::size_t{1} << 24;
    const ImageInfo& info = rows.info();
    const std::size_t row_bytes = row_bytes_of(info);
    const std::size_t row = row_bytes / sizeof(Sample);
    const auto height = static_cast<std::size_t>(info.height);
    // Whole bands of the module, so that it decodes to where the samples stay.
    const std::size_t step = std::max<std::size_t>(bytes_per_step / row_bytes / 64, 1) * 64;
    std::vector<Sample> samples;
    samples.reserve(row * height);
    for (std::size_t first = 0; first < height; first += step) {
        const std::size_t end = std::min(first + step, height);
        samples.resize(row * end);
        check_cancelled();
        rows.read(std::as_writable_bytes(std::span(samples)).data() + first * row_bytes,
                  end - first);
    }
    return samples;
}

}  // namespace

std::size_t row_bytes_of(const ImageInfo& info) {
    return static_cast<std::size_t>(info.width) *
           static_cast<std::size_t>(info.channels * info.bits / 8);
}

void check_streamed_size(const ImageInfo& info, const std::filesystem::path& name) {
    const std::size_t row =
        static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.channels);
    const auto height = static_cast<std::size_t>(info.height);
    if (row <= max_image_samples && row <= max_streamed_samples / height) return;
    throw FileError(name,
                    fmt::format("has {} x {} texels of {} channels; relief reads up to {} "
                                "samples",
                                info.width, info.height, info.channels, max_streamed_samples));
}

Image read_all(RowSource& rows, const std::filesystem::path& name) {
    const ImageInfo& info = rows.info();
    const auto width = static_cast<std::size_t>(info.width);
    const auto height = static_cast<std::size_t>(info.height);
    if (width > max_image_samples / height / static_cast<std::size_t>(info.channels)) {
        throw FileError(name, fmt::format("has {} x {} texels of {} channels; relief reads up to "
                                          "{} samples",
                                          width, height, info.channels, max_image_samples));
    }
    Image image{info.width, info.height, info.channels, ColorSpace::data, {}};
    if (info.bits == 8)
        image.samples = all_samples<std::uint8_t>(rows);
    else if (info.bits == 16)
        image.samples = all_samples<std::uint16_t>(rows);
    else
        image.samples = all_samples<float>(rows);
    return image;
}

std::unique_ptr<RowSource> rows_of_image(Image image, ImageInfo info) {
    return std::make_unique<ImageSource>(std::move(image), std::move(info));
}

}  // namespace relief
