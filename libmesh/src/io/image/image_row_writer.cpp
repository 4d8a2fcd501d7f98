// SPDX-License-Identifier: Apache-2.0
// Image files written by rows: checks -> a file beside -> an encoder by format -> renamed. Whole
// images are written the same way. Tests: tests/mesh/io/image/image_rows_test.cpp.
#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "file_replacement.h"
#include "io/image/row_sink.h"
#include "io/image/write_checks.h"
#include "relief/mesh/error.h"

namespace relief {

std::size_t RowSinkPlan::row_bytes() const {
    return static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.channels) *
           static_cast<std::size_t>(shape.bits / 8);
}

struct ImageRowWriter::Implementation {
    FileReplacement replacement;
    RowSinkPlan plan;
    std::unique_ptr<RowSink> sink;  ///< Null once an error has made the file useless.
    int next = 0;
    bool is_complete = false;
};

ImageRowWriter::ImageRowWriter(const std::filesystem::path& file, const ImageShape& shape,
                               const std::map<std::string, std::string>& metadata,
                               const ImageWriteOptions& options) {
    const char* const format = format_by_extension(file);
    check_writable(format, shape, options);
    check_metadata(metadata);
    implementation_.reset(new Implementation{FileReplacement(file), {}, nullptr});
    Implementation& self = *implementation_;
    self.plan = {file, self.replacement.temporary(), format, shape, metadata, options};
    self.sink =
        std::string_view(format) == "png" ? make_png_sink(self.plan) : make_module_sink(self.plan);
}

ImageRowWriter::~ImageRowWriter() = default;
ImageRowWriter::ImageRowWriter(ImageRowWriter&&) noexcept = default;
ImageRowWriter& ImageRowWriter::operator=(ImageRowWriter&&) noexcept = default;

std::size_t ImageRowWriter::row_bytes() const {
    return implementation_->plan.row_bytes();
}

void ImageRowWriter::write(std::span<const std::byte> rows) {
    Implementation& self = *implementation_;
    const std::size_t row = row_bytes();
    const std::size_t count = rows.size() / row;
    const auto left = static_cast<std::size_t>(self.plan.shape.height - self.next);
    if (rows.size() % row != 0 || count > left) {
        throw InvalidInput(
            fmt::format("{} bytes are not up to {} rows of {}", rows.size(), left, row));
    }
    if (!self.sink) throw FileError(self.plan.file, "cannot be written any further");
    std::unique_ptr<RowSink> sink = std::move(self.sink);  // Gone if writing throws.
    sink->write(rows.data(), static_cast<int>(count));
    self.sink = std::move(sink);
    self.next += static_cast<int>(count);
}

void ImageRowWriter::complete(Report& report) {
    Implementation& self = *implementation_;
    if (self.is_complete) return;
    const int missing = self.plan.shape.height - self.next;
    if (missing > 0)
        throw InvalidInput(
            fmt::format("{} rows of {} are missing", missing, self.plan.shape.height));
    if (!self.sink) throw FileError(self.plan.file, "cannot be written any further");
    const std::unique_ptr<RowSink> sink = std::move(self.sink);
    sink->finish();
    sink->report(report);
    self.is_complete = true;
}

void ImageRowWriter::finish(Report& report) {
    complete(report);
    implementation_->replacement.commit();
}

void ImageRowWriter::finish() {
    Report unread;
    finish(unread);
}

void write_image(const std::filesystem::path& file, const Image& image,
                 const std::map<std::string, std::string>& metadata,
                 const ImageWriteOptions& options, Report& report) {
    const auto bytes =
        std::visit([](const auto& all) { return std::as_bytes(std::span(all)); }, image.samples);
    const std::size_t held = bytes.size() / static_cast<std::size_t>(image.bits() / 8);
    if (image.empty() || held != image.sample_count()) {
        throw InvalidInput(fmt::format("an image of {} x {} x {} samples holds {}", image.width,
                                       image.height, image.channels, held));
    }
    ImageRowWriter writer(
        file, {image.width, image.height, image.channels, image.bits(), image.color_space},
        metadata, options);
    writer.write(bytes);
    writer.finish(report);
}

void write_image(const std::filesystem::path& file, const Image& image,
                 const std::map<std::string, std::string>& metadata,
                 const ImageWriteOptions& options) {
    Report unread;
    write_image(file, image, metadata, options, unread);
}

}  // namespace relief
