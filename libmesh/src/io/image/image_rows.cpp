// SPDX-License-Identifier: Apache-2.0
// Reading and writing image files by rows: checks of what formats can hold, selection of a decoder
// or encoder, and ImageRowReader, ImageRowWriter and write_image() on top of them.
#include "relief/mesh/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "file_replacement.h"
#include "files.h"
#include "io/image/image_file_container.h"
#include "io/image/image_module_client.h"
#include "io/image/row_codec.h"
#include "io/png/png_format.h"
#include "large_memory.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

void check_shape(const ImageShape& shape) {
    if (shape.width < 1 || shape.height < 1) {
        throw InvalidInput(
            fmt::format("an image of {} x {} texels is empty", shape.width, shape.height));
    }
    constexpr int max_named_channels = 8;
    const bool is_named = !shape.channel_names.empty();
    const int max_channels = is_named ? max_named_channels : 4;
    if (shape.channels < 1 || shape.channels > max_channels) {
        throw InvalidInput(
            fmt::format("an image has 1 to {} channels, not {}", max_channels, shape.channels));
    }
    if (is_named && shape.channel_names.size() != static_cast<std::size_t>(shape.channels)) {
        throw InvalidInput(
            fmt::format("{} names for {} channels", shape.channel_names.size(), shape.channels));
    }
    if (shape.bits != 8 && shape.bits != 16 && shape.bits != 32)
        throw InvalidInput(fmt::format("samples have 8, 16 or 32 bits, not {}", shape.bits));
    const auto width = static_cast<std::size_t>(shape.width);
    const auto height = static_cast<std::size_t>(shape.height);
    const std::size_t row = width * static_cast<std::size_t>(shape.channels);
    if (row > max_image_samples || row > max_streamed_samples / height) {
        throw InvalidInput(
            fmt::format("an image of {} x {} x {} samples; relief writes up to {} a "
                        "row, {} in all",
                        width, height, shape.channels, max_image_samples, max_streamed_samples));
    }
}

/// Returns the name of the format for an extension, which is OpenImageIO's for all but textures.
/// \throws FileError if relief does not write it
const char* format_by_extension(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".png") return "png";
    if (extension == ".tif" || extension == ".tiff") return "tiff";
    if (extension == ".exr") return "openexr";
    if (extension == ".hdr") return "hdr";
    if (extension == ".jpg" || extension == ".jpeg") return "jpeg";
    if (extension == ".ktx2") return "ktx2";
    if (extension == ".dds") return "dds";
    throw FileError(
        file, fmt::format("relief cannot write '{}' images, only .png, .tif, .exr, .hdr, .jpg, "
                          ".ktx2 and .dds",
                          extension));
}

/// Refuses images that the format cannot hold without loss. \throws InvalidInput
void check_writable(const std::string& format, const ImageShape& shape,
                    const ImageWriteOptions& options) {
    check_shape(shape);
    const int bits = shape.bits;
    const bool holds_float_only = format == "openexr" || format == "hdr";
    if (holds_float_only && bits != 32)
        throw InvalidInput(fmt::format("EXR and HDR store float samples, not {} bits", bits));
    if (options.half && format != "openexr")
        throw InvalidInput("half-float samples are written to EXR only");
    if (!shape.channel_names.empty() && format != "openexr" && format != "tiff")
        throw InvalidInput("channels have names of their own in EXR and TIFF only");
    constexpr std::size_t max_png_row = std::size_t{1} << 30;
    if (format == "png" && static_cast<std::size_t>(shape.width) *
                                   static_cast<std::size_t>(shape.channels * bits / 8) >
                               max_png_row) {
        throw InvalidInput(fmt::format("a row of {} texels is too long for PNG", shape.width));
    }
    if (format == "png" && bits == 32) throw InvalidInput("PNG stores 8 or 16 bits, not float");
    if (format == "jpeg" && bits != 8)
        throw InvalidInput(fmt::format("JPEG stores 8 bits, not {}", bits));
    if (format == "jpeg" && shape.channels % 2 == 0) throw InvalidInput("JPEG cannot store alpha");
    if (format == "hdr" && shape.channels != 3)
        throw InvalidInput(fmt::format("HDR stores 3 channels, not {}", shape.channels));
    if (shape.color_space == ColorSpace::linear && bits != 32)
        throw InvalidInput("linear color is stored as float; encode it with to_srgb first");
    if (shape.color_space == ColorSpace::srgb && bits == 32)
        throw InvalidInput("sRGB-coded color is stored in 8 or 16 bits; decode it with to_linear");
}

/// \throws InvalidInput if a key is empty or too long for PNG
void check_metadata(const std::map<std::string, std::string>& metadata) {
    constexpr std::size_t max_png_key_length = 79;
    for (const auto& [key, value] : metadata) {
        if (key.empty() || key.size() > max_png_key_length) {
            throw InvalidInput(fmt::format("the metadata key '{}' has {} letters, not 1 to {}", key,
                                           key.size(), max_png_key_length));
        }
    }
}

class WholeImageSource final : public RowSource {
  public:
    WholeImageSource(Image image, ImageInfo info)
        : image_(std::move(image)), info_(std::move(info)) {}

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
    // Whole bands of the module, so that it decodes directly into the result.
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

std::size_t detail::row_bytes_of(const ImageInfo& info) {
    return static_cast<std::size_t>(info.width) *
           static_cast<std::size_t>(info.channels * info.bits / 8);
}

void detail::require_image_fits(const ImageInfo& info, const std::filesystem::path& name) {
    const auto width = static_cast<std::size_t>(info.width);
    const auto height = static_cast<std::size_t>(info.height);
    require_pixels(name, info.width, info.height);
    if (width > max_image_samples / height / static_cast<std::size_t>(info.channels)) {
        throw FileError(name, fmt::format("has {} x {} texels of {} channels; relief reads up to "
                                          "{} samples",
                                          width, height, info.channels, max_image_samples));
    }
    require_memory_for(name, row_bytes_of(info), height);
}

void detail::check_streamed_size(const ImageInfo& info, const std::filesystem::path& name) {
    const std::size_t row =
        static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.channels);
    const auto height = static_cast<std::size_t>(info.height);
    require_pixels(name, info.width, info.height);
    require_memory_for(name, row_bytes_of(info));
    if (row <= max_image_samples && row <= max_streamed_samples / height) return;
    throw FileError(name,
                    fmt::format("has {} x {} texels of {} channels; relief reads up to {} "
                                "samples",
                                info.width, info.height, info.channels, max_streamed_samples));
}

Image detail::read_all(RowSource& rows, const std::filesystem::path& name) {
    const ImageInfo& info = rows.info();
    require_image_fits(info, name);
    Image image{info.width, info.height, info.channels, ColorSpace::data, {}};
    if (info.bits == 8)
        image.samples = all_samples<std::uint8_t>(rows);
    else if (info.bits == 16)
        image.samples = all_samples<std::uint16_t>(rows);
    else
        image.samples = all_samples<float>(rows);
    return image;
}

std::unique_ptr<RowSource> detail::rows_of_image(Image image, ImageInfo info) {
    return std::make_unique<WholeImageSource>(std::move(image), std::move(info));
}

std::unique_ptr<RowSource> detail::open_streamed_rows(const std::filesystem::path& file) {
    std::array<char, 16> start{};
    {
        const RandomAccessFile opened(file);
        const auto size = std::min<std::uint64_t>(opened.size(), start.size());
        opened.read(0, std::as_writable_bytes(std::span(start)).first(size));
    }
    const char* const format = format_by_signature({start.data(), start.size()});
    const std::string_view kind = format == nullptr ? "" : format;
    if (kind == "png") return open_png_rows(file);
    if (kind == "tiff" || kind == "openexr") return open_module_rows(file);
    return nullptr;
}

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
        throw InvalidInput(fmt::format("{} rows cannot be skipped: only {} are left", rows,
                                       info().height - self.next));
    }
    self.source->skip(static_cast<std::size_t>(rows));
    self.next += rows;
}

std::size_t RowSinkPlan::row_bytes() const {
    return static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.channels) *
           static_cast<std::size_t>(shape.bits / 8);
}

struct ImageRowWriter::Implementation {
    FileReplacement replacement;
    RowSinkPlan plan;
    std::unique_ptr<RowSink> sink;  ///< Null after an error, which makes the file useless.
    int next = 0;
    bool is_complete = false;
};

ImageRowWriter::ImageRowWriter(const std::filesystem::path& file, const ImageShape& shape,
                               const std::map<std::string, std::string>& metadata,
                               const ImageWriteOptions& options) {
    const char* const format = format_by_extension(file);
    check_writable(format, shape, options);
    check_metadata(metadata);
    const std::string_view name = format;
    const bool is_texture = name == "ktx2" || name == "dds";
    if (is_texture) check_texture_shape(shape, metadata);
    implementation_.reset(new Implementation{FileReplacement(file), {}, nullptr});
    Implementation& self = *implementation_;
    self.plan = {file, self.replacement.written_path(), format, shape, metadata, options};
    if (is_texture)
        self.sink = make_texture_sink(self.plan);
    else
        self.sink = name == "png" ? make_png_sink(self.plan) : make_module_sink(self.plan);
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
    std::unique_ptr<RowSink> sink = std::move(self.sink);  // Destroyed if writing throws.
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
