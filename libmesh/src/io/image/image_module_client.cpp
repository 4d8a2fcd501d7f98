// SPDX-License-Identifier: Apache-2.0
// Finds and loads the image module, and implements the decoder and encoder of rows with it. The
// encoder uses the module in this process; the decoder uses it in another one.
#include "io/image/image_module_client.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files.h"
#include "io/image/decoder_process.h"
#include "large_memory.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// Returns the file of the shared library that contains this function. It is empty in a program.
std::filesystem::path shared_library() {
    Dl_info info;
    link_map* map = nullptr;
    const bool is_known = ::dladdr1(reinterpret_cast<void*>(&shared_library), &info,
                                    reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0;
    return is_known && map->l_name != nullptr ? map->l_name : "";
}

/// Returns the file of the shared library or program that contains this function. It is empty if it
/// is unknown.
std::filesystem::path this_library() {
    std::filesystem::path library = shared_library();
    if (!library.empty()) return library;
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error);
}

/// Returns the run path of the shared library or program that contains this function, without the
/// folders of the system.
std::vector<std::filesystem::path> run_path() {
    const std::filesystem::path library = shared_library();
    void* const program =
        ::dlopen(library.empty() ? nullptr : library.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    Dl_serinfo size{};
    if (program == nullptr || ::dlinfo(program, RTLD_DI_SERINFOSIZE, &size) != 0) return {};
    std::vector<std::max_align_t> memory(size.dls_size / sizeof(std::max_align_t) + 1);
    auto* const info = reinterpret_cast<Dl_serinfo*>(memory.data());
    std::vector<std::filesystem::path> folders;
    if (::dlinfo(program, RTLD_DI_SERINFOSIZE, info) == 0 &&
        ::dlinfo(program, RTLD_DI_SERINFO, info) == 0) {
        const Dl_serpath* const paths = info->dls_serpath;
        for (unsigned i = 0; i < info->dls_cnt; ++i) {
            if ((paths[i].dls_flags & LA_SER_DEFAULT) == 0) folders.emplace_back(paths[i].dls_name);
        }
    }
    ::dlclose(program);
    return folders;
}

/// Loads the module from one folder. If this fails, the result is null and `reasons` gets the
/// reason.
const ImageModule* loaded_from(const std::filesystem::path& place, std::string& reasons) {
    std::error_code error;
    if (!std::filesystem::exists(place, error)) {
        reasons += fmt::format("; not at {}", place.string());
        return nullptr;
    }
    void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        reasons += fmt::format("; {} does not load: {}", place.string(), ::dlerror());
        return nullptr;
    }
    using Entry = const ImageModule* (*)();
    const auto entry = reinterpret_cast<Entry>(::dlsym(library, image_module_entry));
    const ImageModule* module = entry == nullptr ? nullptr : entry();
    if (module != nullptr && module->version == image_module_version) return module;
    ::dlclose(library);
    reasons += fmt::format("; {} belongs to another version of relief", place.string());
    return nullptr;
}

}  // namespace

std::vector<std::filesystem::path> image_module_folders() {
    std::vector<std::filesystem::path> folders;
    const char* named = std::getenv("RELIEF_MODULE_DIR");
    if (named != nullptr && *named != '\0') folders.emplace_back(named);
    if (const std::filesystem::path library = this_library(); !library.empty()) {
        const std::filesystem::path folder = library.parent_path();
        folders.push_back(folder / "relief");
        folders.push_back(folder.parent_path() / RELIEF_MODULE_DIRECTORY);
    }
    for (std::filesystem::path& folder : run_path()) {
        if (std::find(folders.begin(), folders.end(), folder) == folders.end())
            folders.push_back(std::move(folder));
    }
    return folders;
}

const ImageModule& image_module(const std::filesystem::path& file) {
    static std::mutex mutex;
    static const ImageModule* module = nullptr;
    const std::lock_guard lock(mutex);
    if (module != nullptr) return *module;
    std::string reasons;
    for (const std::filesystem::path& folder : image_module_folders()) {
        module = loaded_from(folder / image_module_name, reasons);
        if (module != nullptr) return *module;
    }
    throw FileError(file, fmt::format("relief's image module {} was not found{}; install the "
                                      "package relief-image-formats, or set RELIEF_MODULE_DIR to "
                                      "its folder",
                                      image_module_name, reasons));
}

namespace {

using Metadata = std::map<std::string, std::string>;

/// Returns the text entries of the file without those that OpenImageIO adds about the encoding.
/// relief reads the text of PNG itself, and other formats have none worth keeping.
Metadata text_of_file(Metadata text) {
    for (const char* coding :
         {"compression", "textureformat", "wrapmodes", "ResolutionUnit", "planarconfig"})
        text.erase(coding);
    return text;
}

/// TIFF has no custom entries: relief stores them in the description, one per line.
void split_description(Metadata& metadata) {
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

class ModuleSource final : public RowSource {
  public:
    ModuleSource(const char* format, const RandomAccessFile& file)
        : name_(file.path()),
          is_streamed_(true),
          decoded_(format, file.descriptor(), file.size(), name_) {
        prepare(format, {});
    }

    ModuleSource(const ImageContainer& container, std::span<const std::byte> bytes,
                 std::filesystem::path name)
        : name_(std::move(name)),
          is_streamed_(false),
          // PNG and JPEG without chunks that do not define samples.
          decoded_(container.format,
                   container.stripped.empty() ? bytes : std::span(container.stripped), name_) {
        prepare(container.format, container.text);
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
    void prepare(std::string_view kind, const Metadata& png_text) {
        info_ = info_from(decoded_.header(), name_);
        check_streamed_size(info_, name_);
        if (kind == "png") info_.metadata = png_text;
        if (kind == "openexr" || kind == "tiff") info_.metadata = text_of_file(decoded_.text());
        if (kind == "tiff") split_description(info_.metadata);
        row_bytes_ = row_bytes_of(info_);
        // Whole tiles, otherwise a multiple of 64 rows, which compressed formats decode together.
        const auto tile = static_cast<std::size_t>(decoded_.row_grain());
        grain_ = tile > 1 ? tile : 64;
        band_rows_ = std::max<std::size_t>(module_bytes_per_band / row_bytes_ / grain_, 1) * grain_;
    }

    std::size_t copy_from_band(std::byte* rows, std::size_t count) {
        const std::size_t taken = std::min(count, band_end_ - next_);
        std::memcpy(rows, band_.data() + (next_ - band_first_) * row_bytes_, taken * row_bytes_);
        return taken;
    }

    /// Decodes directly into the caller's memory if it takes a whole band. \return the number of
    /// rows that it got
    std::size_t decode(std::byte* rows, std::size_t count) {
        const auto height = static_cast<std::size_t>(info_.height);
        const std::size_t first = next_ / grain_ * grain_;
        const std::size_t end = std::min(first + band_rows_, height);
        if (first == next_ && count >= end - first) {
            decode_to(rows, first, end);
            return end - first;
        }
        require_memory_for(name_, row_bytes_, end - first);
        band_.resize((end - first) * row_bytes_);
        decode_to(band_.data(), first, end);
        band_first_ = first;
        band_end_ = end;
        return 0;
    }

    void decode_to(std::byte* rows, std::size_t first, std::size_t end) {
        decoded_.read(first, end, std::span(rows, (end - first) * row_bytes_));
    }

    std::filesystem::path name_;
    bool is_streamed_;
    DecodedImage decoded_;
    ImageInfo info_;
    std::size_t row_bytes_ = 0;
    std::size_t grain_ = 1;
    std::size_t band_rows_ = 1;
    std::vector<std::byte> band_;  ///< Rows [band_first_, band_end_).
    std::size_t band_first_ = 0;
    std::size_t band_end_ = 0;
    std::size_t next_ = 0;
};

/// Reads as much of an EXR's beginning as its check needs.
void check_exr_file(const RandomAccessFile& file) {
    std::vector<std::byte> start;
    for (std::uint64_t size = 1 << 16;; size *= 4) {
        start.resize(static_cast<std::size_t>(std::min(size, file.size())));
        file.read(0, start);
        if (check_exr(start, file.size(), file.path())) return;
    }
}

}  // namespace

std::unique_ptr<RowSource> open_module_rows(const std::filesystem::path& file) {
    const RandomAccessFile opened(file);
    std::array<std::byte, 16> start{};
    opened.read(0, std::span(start).first(std::min<std::size_t>(opened.size(), start.size())));
    const char* const format =
        format_by_signature({reinterpret_cast<const char*>(start.data()), start.size()});
    if (std::string_view(format) == "openexr") check_exr_file(opened);
    return std::make_unique<ModuleSource>(format, opened);
}

std::unique_ptr<RowSource> module_rows(const ImageContainer& container,
                                       std::span<const std::byte> bytes,
                                       const std::filesystem::path& name) {
    return std::make_unique<ModuleSource>(container, bytes, name);
}

Image read_by_module(const std::filesystem::path& file) {
    const std::string contents = read_file(file);
    const auto bytes = std::as_bytes(std::span(contents));
    const auto rows = module_rows(examine_image(bytes, file), bytes, file);
    return read_all(*rows, file);
}

namespace {

/// Bands consist of whole strips of TIFF and blocks of EXR, for all heights that the module
/// chooses: the operation can be cancelled after each of them.
constexpr std::size_t band_grain = 32;
constexpr std::size_t written_bytes_per_band = std::size_t{1} << 21;

constexpr float max_half = 65504.0F;
/// Halfway to the next number beyond the range: this and larger values round to infinity.
constexpr float rounds_to_infinity = 65520.0F;

std::string join_description(const Metadata& metadata) {
    std::string description;
    for (const auto& [key, value] : metadata)
        description += fmt::format("{}={}\n", key, value);
    return description;
}

/// The metadata in a form that the format can hold.
Metadata entries_for(std::string_view format, const Metadata& metadata) {
    if (format == "openexr") return metadata;
    if (format == "tiff" && !metadata.empty())
        return {{"ImageDescription", join_description(metadata)}};
    return {};
}

int zip_quality(WriteEffort effort) {
    // 1 is twice as fast as zlib's default, and within 1 % of its size for 16-bit normal maps.
    return effort == WriteEffort::small ? 9 : 1;
}

struct ReleaseWriter {
    const ImageModule* module = nullptr;
    void operator()(ImageModuleWriter* writer) const { module->release(writer); }
};

class ModuleSink final : public RowSink {
  public:
    explicit ModuleSink(const RowSinkPlan& plan)
        : plan_(plan),
          row_bytes_(plan.row_bytes()),
          band_rows_(std::max<std::size_t>(written_bytes_per_band / row_bytes_ / band_grain, 1) *
                     band_grain) {
        const Metadata entries = entries_for(plan.format, plan.metadata);
        std::vector<const char*> keys, values;
        for (const auto& [key, value] : entries) {
            keys.push_back(key.c_str());
            values.push_back(value.c_str());
        }
        const ImageShape& shape = plan.shape;
        std::vector<const char*> names;
        for (const std::string& name : shape.channel_names)
            names.push_back(name.c_str());
        const ImageModulePicture picture{{shape.width, shape.height, shape.channels, shape.bits},
                                         shape.color_space == ColorSpace::srgb,
                                         plan.options.half,
                                         zip_quality(plan.options.effort),
                                         names.empty() ? nullptr : names.data(),
                                         keys.data(),
                                         values.data(),
                                         entries.size()};
        const ImageModule& module = image_module(plan.file);
        std::string reason;
        writer_ = {module.create(plan.format, plan.written.c_str(), &picture, failure_into(reason)),
                   ReleaseWriter{&module}};
        if (!writer_) fail(reason);
    }

    void write(const std::byte* rows, int count) override {
        auto left = static_cast<std::size_t>(count);
        while (left > 0) {
            const std::size_t taken = std::min(left, band_rows_ - pending_.size() / row_bytes_);
            const std::size_t size = taken * row_bytes_;
            if (taken == band_rows_ && !plan_.options.half) {
                write_to_module(rows, band_rows_);
            } else {
                pending_.insert(pending_.end(), rows, rows + size);
                if (pending_.size() == band_rows_ * row_bytes_) write_pending();
            }
            rows += size;
            left -= taken;
        }
    }

    void finish() override {
        if (!pending_.empty()) write_pending();
        std::string reason;
        if (!writer_.get_deleter().module->finish(writer_.get(), failure_into(reason)))
            fail(reason);
    }

    void report(Report& report) const override {
        if (clamped_.count > 0) report.add(clamped_);
    }

  private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw FileError(plan_.file, "cannot be written: " + reason);
    }

    void write_pending() {
        if (plan_.options.half) clamp_to_half();
        write_to_module(pending_.data(), pending_.size() / row_bytes_);
        pending_.clear();
    }

    void write_to_module(const std::byte* rows, std::size_t count) {
        check_cancelled();
        std::string reason;
        const auto first = static_cast<std::int64_t>(next_);
        const auto end = first + static_cast<std::int64_t>(count);
        if (!writer_.get_deleter().module->write(writer_.get(), first, end, rows,
                                                 failure_into(reason)))
            fail(reason);
        next_ += count;
    }

    void clamp_to_half() {
        constexpr std::size_t max_named_texels = 8;
        for (std::size_t at = 0; at < pending_.size(); at += sizeof(float)) {
            float value = 0.0F;
            std::memcpy(&value, &pending_[at], sizeof value);
            if (!(std::abs(value) >= rounds_to_infinity) || std::isinf(value)) continue;
            value = std::copysign(max_half, value);
            std::memcpy(&pending_[at], &value, sizeof value);
            const auto texel = (next_ * row_bytes_ + at) / sizeof(float) /
                               static_cast<std::size_t>(plan_.shape.channels);
            if (clamped_.count > 0 && texel == last_clamped_) continue;
            ++clamped_.count;
            last_clamped_ = texel;
            if (clamped_.first.size() < max_named_texels) clamped_.first.push_back(texel);
        }
    }

    RowSinkPlan plan_;
    std::size_t row_bytes_;
    std::size_t band_rows_;
    std::unique_ptr<ImageModuleWriter, ReleaseWriter> writer_;
    std::vector<std::byte> pending_;  ///< Rows of an incomplete band.
    std::size_t next_ = 0;            ///< The next row that is passed to the module.
    std::size_t last_clamped_ = 0;
    Finding clamped_{
        "texel beyond half's range", "texel", "is written as 65504 with its sign", 0, {}};
};

}  // namespace

std::unique_ptr<RowSink> make_module_sink(const RowSinkPlan& plan) {
    return std::make_unique<ModuleSink>(plan);
}

}  // namespace relief::detail
