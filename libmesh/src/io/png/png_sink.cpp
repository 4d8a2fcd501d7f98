// SPDX-License-Identifier: Apache-2.0
// PNG files by rows. Tests: tests/mesh/io/image/image_rows_test.cpp.
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "io/image/row_sink.h"
#include "io/png/png_encoder.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

class PngSink final : public RowSink {
  public:
    explicit PngSink(const RowSinkPlan& plan)
        : file_(plan.file),
          out_(plan.written, std::ios::binary),
          encoder_(plan.shape, plan.metadata, plan.options.effort, [this](std::string_view bytes) {
              out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
              check();
          }) {}

    void write(const std::byte* rows, int count) override {
        encoder_.write(rows, static_cast<std::size_t>(count));
    }

    void finish() override {
        out_.close();
        check();
    }

  private:
    void check() const {
        if (!out_)
            throw FileError(file_, fmt::format("cannot be written: {}", std::strerror(errno)));
    }

    std::filesystem::path file_;
    std::ofstream out_;
    PngEncoder encoder_;  ///< Last: it writes from its beginning.
};

}  // namespace

std::unique_ptr<RowSink> make_png_sink(const RowSinkPlan& plan) {
    return std::make_unique<PngSink>(plan);
}

}  // namespace relief
