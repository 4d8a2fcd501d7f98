// SPDX-License-Identifier: Apache-2.0
// The image module as a source of rows. It decodes bands of whole tiles, or of as many rows as
// compressed formats decode at once, of which the caller's rows are cut. Whatever is wrong is a
// FileError. Tests: tests/mesh/io/image/image_rows_test.cpp, image_file_test.cpp.
#include "io/image/module_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file_bytes.h"
#include "io/image/image_file_module.h"
#include "random_access_file.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

using Metadata = std::map<std::string, std::string>;

/// Text that the file itself holds. Of what OpenImageIO adds, these are facts of the coding; the
/// text of PNG is read by ourselves, and other formats have none worth keeping.
ImageModuleText text_into(Metadata& metadata) {
    return {&metadata, [](void* receiver, const char* key, const char* value) {
                for (const std::string_view coding : {"compression", "textureformat", "wrapmodes",
                                                      "ResolutionUnit", "planarconfig"}) {
                    if (key == coding) return;
                }
                static_cast<Metadata*>(receiver)->emplace(key, value);
            }};
}

/// TIFF has no place for entries of one's own: they stand in its description, one a line.
void unfold_description(Metadata& metadata) {
    const auto description = metadata.find("ImageDescription");
    if (description == metadata.end()) return;
    std::string_view rest = description->second;
    while (!rest.empty()) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
        const std::size_t equals = line.find('=');
        if (line.starts_with("relief:") && equals != std::string_view::npos)
            metadata.emplace(line.substr(0, equals), line.substr(equals + 1));
    }
}

ImageInfo info_from(const ImageModuleHeader& header, const std::filesystem::path& name) {
    if (header.width < 1 || header.height < 1) {
        throw FileError(name, fmt::format("is empty: {} x {} texels", header.width, header.height));
    }
    if (header.channels < 1 || header.channels > 4)
        throw FileError(name, fmt::format("has {} channels; relief reads 1 to 4", header.channels));
    return {static_cast<int>(header.width),
            static_cast<int>(header.height),
            static_cast<int>(header.channels),
            header.bits,
            {}};
}

struct CloseReader {
    const ImageModule* module = nullptr;
    void operator()(ImageModuleReader* reader) const { module->close(reader); }
};
using Reader = std::unique_ptr<ImageModuleReader, CloseReader>;

class ModuleSource final : public RowSource {
  public:
    /// \param open  opens the reader, given the header, the text and the reason to fill
    template <typename Open>
    ModuleSource(const char* format, std::filesystem::path name, ImageContainer container,
                 bool is_streamed, Open open)
        : name_(std::move(name)), container_(std::move(container)), is_streamed_(is_streamed) {
        const ImageModule& module = image_module(name_);
        ImageModuleHeader header;
        Metadata text;
        std::string reason;
        reader_ = {open(module, container_, &header, text_into(text), failure_into(reason)),
                   CloseReader{&module}};
        if (reader_ == nullptr) throw FileError(name_, reason);
        info_ = info_from(header, name_);
        check_streamed_size(info_, name_);
        const std::string_view kind = format;
        if (kind == "png") info_.metadata = container_.text;
        if (kind == "openexr" || kind == "tiff") info_.metadata = text;
        if (kind == "tiff") unfold_description(info_.metadata);
        row_bytes_ = row_bytes_of(info_);
        // Whole tiles, and else a multiple of 64 rows, which compressed formats decode at once.
        const auto tile = static_cast<std::size_t>(module.row_grain(reader_.get()));
        grain_ = tile > 1 ? tile : 64;
        band_rows_ = std::max<std::size_t>(module_bytes_per_band / row_bytes_ / grain_, 1) * grain_;
    }

    [[nodiscard]] const ImageInfo& info() const override { return info_; }
    [[nodiscard]] bool is_streamed() const override { return is_streamed_; }

    void read(std::byte* rows, std::size_t count) override {
        while (count > 0) {
            const std::size_t taken = next_ >= band_first_ && next_ < band_end_
                                          ? copy_from_band(rows, count)
                                          : decode(rows, count);
            next_ += taken;
            rows += taken * row_bytes_;
            count -= taken;
        }
    }

    void skip(std::size_t count) override { next_ += count; }

  private:
    std::size_t copy_from_band(std::byte* rows, std::size_t count) {
        const std::size_t taken = std::min(count, band_end_ - next_);
        std::memcpy(rows, band_.data() + (next_ - band_first_) * row_bytes_, taken * row_bytes_);
        return taken;
    }

    /// Straight to the caller where it takes a whole band. \return how many rows it has got
    std::size_t decode(std::byte* rows, std::size_t count) {
        const auto height = static_cast<std::size_t>(info_.height);
        const std::size_t first = next_ / grain_ * grain_;
        const std::size_t end = std::min(first + band_rows_, height);
        if (first == next_ && count >= end - first) {
            decode_to(rows, first, end);
            return end - first;
        }
        band_.resize(band_rows_ * row_bytes_);
        decode_to(band_.data(), first, end);
        band_first_ = first;
        band_end_ = end;
        return 0;
    }

    void decode_to(std::byte* rows, std::size_t first, std::size_t end) {
        std::string reason;
        if (reader_.get_deleter().module->read(reader_.get(), static_cast<std::int64_t>(first),
                                               static_cast<std::int64_t>(end), rows,
                                               failure_into(reason))) {
            return;
        }
        throw FileError(name_, fmt::format("rows {} to {} of {} are damaged: {}", first, end - 1,
                                           info_.height, reason));
    }

    std::filesystem::path name_;
    ImageContainer container_;
    bool is_streamed_;
    Reader reader_;  ///< May read from `container_`.
    ImageInfo info_;
    std::size_t row_bytes_ = 0;
    std::size_t grain_ = 1;
    std::size_t band_rows_ = 1;
    std::vector<std::byte> band_;  ///< Rows [band_first_, band_end_).
    std::size_t band_first_ = 0;
    std::size_t band_end_ = 0;
    std::size_t next_ = 0;
};

/// Reads as much of the beginning as the check of an EXR's header needs.
void check_exr_file(const std::filesystem::path& path) {
    const RandomAccessFile file(path);
    std::vector<std::byte> start;
    for (std::uint64_t size = 1 << 16;; size *= 4) {
        start.resize(static_cast<std::size_t>(std::min(size, file.size())));
        file.read(0, start);
        if (check_exr(start, file.size(), path)) return;
    }
}

}  // namespace

std::unique_ptr<RowSource> open_module_rows(const std::filesystem::path& file) {
    std::array<std::byte, 16> start{};
    {
        const RandomAccessFile opened(file);
        opened.read(0, std::span(start).first(std::min<std::size_t>(opened.size(), start.size())));
    }
    const char* const format =
        format_by_signature({reinterpret_cast<const char*>(start.data()), start.size()});
    if (std::string_view(format) == "openexr") check_exr_file(file);
    return std::make_unique<ModuleSource>(
        format, file, ImageContainer{}, true,
        [&](const ImageModule& module, const ImageContainer&, ImageModuleHeader* header,
            ImageModuleText text, ImageModuleFailure failure) {
            return module.open_file(format, file.c_str(), header, text, failure);
        });
}

std::unique_ptr<RowSource> module_rows(ImageContainer container, std::span<const std::byte> bytes,
                                       const std::filesystem::path& name) {
    const char* const format = container.format;
    return std::make_unique<ModuleSource>(
        format, name, std::move(container), false,
        [&](const ImageModule& module, const ImageContainer& held, ImageModuleHeader* header,
            ImageModuleText text, ImageModuleFailure failure) {
            // PNG and JPEG without what does not define their samples.
            const std::span<const std::byte> encoded =
                held.stripped.empty() ? bytes : std::span(held.stripped);
            return module.open(format, encoded.data(), encoded.size(), header, text, failure);
        });
}

Image read_by_module(const std::filesystem::path& file) {
    const std::string contents = read_file(file);
    const auto bytes = std::as_bytes(std::span(contents));
    const auto rows = module_rows(examine_image(bytes, file), bytes, file);
    return read_all(*rows, file);
}

}  // namespace relief
