// SPDX-License-Identifier: Apache-2.0
// PNG files by rows. Tests: tests/mesh/io/image/image_rows_test.cpp.
#include <cstring>

#include "file_replacement.h"
#include "io/image/png_encoder.h"
#include "io/image/row_sink.h"

namespace relief {
namespace {

class PngSink final : public RowSink {
  public:
    explicit PngSink(const RowSinkPlan& plan)
        : plan_(plan),
          image_(make_image(plan.shape.width, plan.shape.height, plan.shape.channels,
                            plan.shape.bits, plan.shape.color_space)) {}

    void write(const std::byte* rows, int count) override {
        std::byte* const all =
            std::visit([](auto& held) { return std::as_writable_bytes(std::span(held)).data(); },
                       image_.samples);
        const std::size_t size = plan_.row_bytes() * static_cast<std::size_t>(count);
        std::memcpy(all + written_, rows, size);
        written_ += size;
    }

    void finish() override {
        const std::string encoded = encode_png(image_, plan_.metadata);
        replace_file(plan_.written, std::as_bytes(std::span(encoded)));
    }

  private:
    RowSinkPlan plan_;
    Image image_;
    std::size_t written_ = 0;
};

}  // namespace

std::unique_ptr<RowSink> make_png_sink(const RowSinkPlan& plan) {
    return std::make_unique<PngSink>(plan);
}

}  // namespace relief
