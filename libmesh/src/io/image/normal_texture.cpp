// SPDX-License-Identifier: Apache-2.0
// Encodes textures of normals by bands. Each level keeps the rows that are not yet a complete row
// of blocks, or that the next level still needs; rows of means pass on to the next level.
#include "relief/mesh/normal_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "image/mip_rows.h"
#include "image/texel_loops.h"
#include "io/image/block_sample.h"
#include "io/image/texture_container.h"
#include "parallel.h"
#include "relief/mesh/normal_map.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t rows_per_block = 4;
constexpr std::size_t texels_per_task = 1 << 14;

/// Rows of floats that are added at the end and dropped at the beginning. Rows that are added to an
/// empty window are not copied until keep_from().
class RowWindow {
  public:
    explicit RowWindow(std::size_t row_size) : row_size_(row_size) {}

    void add(std::span<const float> rows) {
        if (kept_.empty()) {
            rows_ = rows;
            return;
        }
        kept_.insert(kept_.end(), rows.begin(), rows.end());
        rows_ = kept_;
    }

    /// Keeps the rows from `row` on in its own memory.
    void keep_from(std::size_t row) {
        const auto dropped = static_cast<std::ptrdiff_t>((row - first_) * row_size_);
        kept_ = std::vector<float>(rows_.begin() + dropped, rows_.end());
        rows_ = kept_;
        first_ = row;
    }

    [[nodiscard]] const float* at(std::size_t row) const {
        return rows_.data() + (row - first_) * row_size_;
    }
    [[nodiscard]] std::size_t end_row() const { return first_ + rows_.size() / row_size_; }

  private:
    std::size_t row_size_;
    std::size_t first_ = 0;
    std::span<const float> rows_;
    std::vector<float> kept_;
};

/// The first channels of an image.
Image first_channels(const Image& image, int channels) {
    if (image.channels == channels) return image;
    Image result = make_image(image.width, image.height, channels, image.bits(), image.color_space);
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            const auto from = image.as<Sample>();
            const auto held = static_cast<std::size_t>(image.channels);
            const auto kept = static_cast<std::size_t>(channels);
            for (std::size_t i = 0; i < samples.size(); ++i)
                samples[i] = from[i / kept * held + i % kept];
        },
        result.samples);
    return result;
}

/// Encodes rows of unit normals, y as it is stored.
std::vector<std::byte> encoded_rows(const ImageView& normals, const Image* alpha,
                                    const NormalTextureOptions& options, Report& report) {
    const std::optional<BlockFormat> blocks = block_format_of(options.format);
    if (blocks && channels_of(*blocks) == 2) {
        return encode_normal_blocks(normals, {.format = *blocks, .quality = options.quality},
                                    report);
    }
    // BC7 is encoded from the exact components, not from codes of 8 bits.
    const NormalMapFormat stored{.bits = blocks ? 32 : bits_of(options.format),
                                 .green = Green::up,
                                 .flat = flat_code_of(options.format),
                                 .dither = Dither::none};
    Image codes = encode_normal_map(normals, stored, report);
    if (alpha != nullptr) codes = with_alpha(codes, *alpha);
    codes = first_channels(codes, std::min(codes.channels, channels_of(options.format)));
    return encode_texture_level(codes, options.format, options.quality, report);
}

Image image_of_rows(const float* rows, std::size_t width, std::size_t count, int channels) {
    Image image = make_image(static_cast<int>(width), static_cast<int>(count), channels, 32,
                             ColorSpace::data);
    const std::span<float> to = image.as<float>();
    std::copy_n(rows, to.size(), to.begin());
    return image;
}

/// Adds findings of rows, whose texels count from their own first texel.
void add_rows(const Report& of_rows, std::size_t first_texel, Report& report) {
    for (Finding finding : of_rows.findings()) {
        for (std::size_t& texel : finding.first)
            texel += first_texel;
        report.add(finding);
    }
}

void append(const std::vector<std::byte>& from, std::vector<std::byte>& to) {
    to.insert(to.end(), from.begin(), from.end());
}

/// Rows of a level.
struct LevelRows {
    std::vector<float> normals, alpha;
};

/// A level that grows from the top.
class GrowingLevel {
  public:
    GrowingLevel(std::size_t width, std::size_t height, bool is_largest, bool has_alpha,
                 const NormalTextureOptions& options)
        : width_(width),
          height_(height),
          is_largest_(is_largest),
          has_alpha_(has_alpha),
          options_(options),
          normals_(3 * width),
          alpha_(width),
          sample_(static_cast<int>(width), static_cast<int>(height), options.measured_texels) {
        bytes_.reserve(
            texture_level_size(options.format, static_cast<int>(width), static_cast<int>(height)));
    }

    /// Adds rows, which are unit vectors in the largest level, and means in others.
    /// \return the rows of the next level that are complete now
    LevelRows add(std::span<const float> normals, std::span<const float> alpha) {
        normals_.add(normals);
        if (has_alpha_) alpha_.add(alpha);
        const std::size_t end = normals_.end_row();
        const std::size_t complete = end == height_ ? end : end / rows_per_block * rows_per_block;
        if (complete > encoded_) encode(complete);
        LevelRows next;
        std::size_t needed = encoded_;
        if (options_.has_mips) {
            next = halve(end);
            needed = std::min(needed, mip_source_rows(height_, halved_).first);
        }
        needed = std::min(needed, end);
        normals_.keep_from(needed);
        if (has_alpha_) alpha_.keep_from(needed);
        return next;
    }

    /// Moves the result to the texture.
    void finish(NormalTexture& texture, Report& report) {
        const auto texels = static_cast<double>(width_) * static_cast<double>(height_);
        NormalTextureLevel level{.width = static_cast<int>(width_),
                                 .height = static_cast<int>(height_),
                                 .mean_length = is_largest_ ? 1.0 : sum_of_lengths_ / texels,
                                 .min_length = is_largest_ ? 1.0 : min_length_};
        if (options_.measured_texels > 0) {
            MeasuredError measured = sample_.result();
            level.error = std::move(measured.error);
            level.confidence = measured.confidence;
        }
        report.merge(of_lengths_);
        report.merge(of_encoding_);
        texture.texture.levels.push_back(std::move(bytes_));
        if (texture.roughness) {
            level.mean_roughness = sum_of_roughness_ / texels;
            texture.roughness->levels.push_back(std::move(roughness_));
        }
        texture.levels.push_back(std::move(level));
    }

  private:
    /// Encodes rows up to `end`.
    void encode(std::size_t end) {
        const std::size_t first = std::exchange(encoded_, end);
        const std::size_t count = end - first;
        Image units, lengths;
        const float* rows = normals_.at(first);
        if (!is_largest_) {
            Report found;
            units = image_of_rows(rows, width_, count, 3);
            lengths = split_lengths(units, found);
            add_rows(found, first * width_, of_lengths_);
            rows = units.as<float>().data();
        } else if (options_.roughness) {
            lengths = make_image(static_cast<int>(width_), static_cast<int>(count), 1, 32,
                                 ColorSpace::data);
            std::ranges::fill(lengths.as<float>(), 1.0F);
        }
        Image alpha;
        if (has_alpha_) alpha = image_of_rows(alpha_.at(first), width_, count, 1);
        const ImageView view(rows, static_cast<int>(width_), static_cast<int>(count), 3);
        Report found;
        const std::vector<std::byte> bytes =
            encoded_rows(view, has_alpha_ ? &alpha : nullptr, options_, found);
        if (options_.measured_texels > 0) measure(first, count, rows, bytes);
        append(bytes, bytes_);
        if (!lengths.empty()) add_lengths(lengths, found);
        add_rows(found, first * width_, of_encoding_);
    }

    void measure(std::size_t first, std::size_t count, const float* rows,
                 std::span<const std::byte> bytes) {
        const std::size_t row_bytes =
            texture_level_size(options_.format, static_cast<int>(width_), rows_per_block);
        const std::size_t first_row = first / rows_per_block;
        const std::size_t end_row = first_row + (count + rows_per_block - 1) / rows_per_block;
        sample_.measure(
            first_row, end_row, [&](std::size_t row, std::span<const std::size_t> columns) {
                const std::size_t index = row - first_row;
                const std::size_t begin = index * row_bytes;
                const std::size_t height = std::min(rows_per_block, count - index * rows_per_block);
                const EncodedRow encoded{
                    options_.format,
                    bytes.subspan(begin, std::min(row_bytes, bytes.size() - begin)),
                    static_cast<int>(width_), static_cast<int>(height)};
                return normal_block_errors(encoded, columns,
                                           rows + 3 * index * rows_per_block * width_, Green::up);
            });
    }

    /// Adds the lengths of means, and encodes their roughness.
    void add_lengths(const Image& lengths, Report& report) {
        for (const float length : lengths.as<float>()) {
            sum_of_lengths_ += static_cast<double>(length);
            min_length_ = std::min(min_length_, static_cast<double>(length));
        }
        if (!options_.roughness) return;
        const Image roughness = roughness_from_lengths(lengths, *options_.roughness);
        for (const float value : roughness.as<float>())
            sum_of_roughness_ += static_cast<double>(value);
        append(encode_texture_level(roughness, TextureFormat::bc4, options_.quality, report),
               roughness_);
    }

    /// Returns the rows of means whose rows exist. \param end  of the rows that exist
    LevelRows halve(std::size_t end) {
        const std::size_t begin = halved_;
        const std::size_t rows = halved_size(height_);
        while (halved_ < rows) {
            const MipSourceRows from = mip_source_rows(height_, halved_);
            if (from.first + from.count > end) break;
            ++halved_;
        }
        LevelRows next;
        next.normals = halved_rows(normals_, 3, begin);
        if (has_alpha_) next.alpha = halved_rows(alpha_, 1, begin);
        return next;
    }

    /// Returns the rows of means from `begin` to `halved_`.
    [[nodiscard]] std::vector<float> halved_rows(const RowWindow& window, int channels,
                                                 std::size_t begin) const {
        const std::size_t row_size = halved_size(width_) * static_cast<std::size_t>(channels);
        std::vector<float> rows((halved_ - begin) * row_size);
        parallel_for(halved_ - begin, texels_per_task / width_ + 1,
                     [&](std::size_t first, std::size_t last) {
                         for (std::size_t i = first; i < last; ++i) {
                             const std::size_t y = begin + i;
                             halve_float_rows(channels, width_, height_, y,
                                              window.at(mip_source_rows(height_, y).first),
                                              rows.data() + i * row_size);
                         }
                     });
        return rows;
    }

    std::size_t width_, height_;
    bool is_largest_, has_alpha_;
    const NormalTextureOptions& options_;
    RowWindow normals_, alpha_;
    BlockSample sample_;
    std::size_t encoded_ = 0;  ///< Rows that are encoded,
    std::size_t halved_ = 0;   ///< and rows of the next level that are computed.
    std::vector<std::byte> bytes_, roughness_;
    double sum_of_lengths_ = 0.0, min_length_ = 1.0, sum_of_roughness_ = 0.0;
    Report of_lengths_, of_encoding_;
};

}  // namespace

struct NormalTextureEncoder::Implementation {
    NormalTextureOptions options;
    bool has_alpha = false;
    int width = 0;
    int height = 0;
    int next_row = 0;
    std::vector<GrowingLevel> levels;
};

NormalTextureEncoder::NormalTextureEncoder(int width, int height, bool has_alpha,
                                           const NormalTextureOptions& options)
    : implementation_(new Implementation{options, has_alpha, width, height, 0, {}}) {
    const auto formats = find_map_texture_kind(MapKind::normal)->formats;
    if (std::ranges::count(formats, options.format) == 0) {
        throw InvalidInput(fmt::format("normals are not stored in {}", enum_name(options.format)));
    }
    if (has_alpha && !stores_alpha(options.format)) {
        throw InvalidInput(
            fmt::format("the map has alpha, but {} stores none", enum_name(options.format)));
    }
    if (width < 1 || height < 1) {
        throw InvalidInput(
            fmt::format("the map has {} x {} texels, but needs at least 1 x 1", width, height));
    }
    auto across = static_cast<std::size_t>(width);
    auto down = static_cast<std::size_t>(height);
    std::vector<GrowingLevel>& levels = implementation_->levels;
    levels.emplace_back(across, down, true, has_alpha, implementation_->options);
    while (options.has_mips && (across > 1 || down > 1)) {
        across = halved_size(across);
        down = halved_size(down);
        levels.emplace_back(across, down, false, has_alpha, implementation_->options);
    }
}

NormalTextureEncoder::~NormalTextureEncoder() = default;

void NormalTextureEncoder::add(const Image& normals, const Image* alpha) {
    Implementation& state = *implementation_;
    check_floats(normals, 3, "normals");
    if (normals.width != state.width || normals.height > state.height - state.next_row) {
        throw InvalidInput(
            fmt::format("{} x {} texels do not continue a map of {} x {} texels after row {}",
                        normals.width, normals.height, state.width, state.height, state.next_row));
    }
    if ((alpha != nullptr) != state.has_alpha)
        throw InvalidInput(alpha != nullptr ? "there is alpha, which was not announced"
                                            : "alpha is missing");
    if (alpha != nullptr) {
        check_floats(*alpha, 1, "alpha");
        if (alpha->width != normals.width || alpha->height != normals.height)
            throw InvalidInput("alpha has another size than the normals");
    }
    state.next_row += normals.height;
    LevelRows rows = state.levels.front().add(
        normals.as<float>(), alpha != nullptr ? alpha->as<float>() : std::span<const float>{});
    for (std::size_t i = 1; i < state.levels.size() && !rows.normals.empty(); ++i)
        rows = state.levels[i].add(rows.normals, rows.alpha);
}

NormalTexture NormalTextureEncoder::finish(Report& report) {
    Implementation& state = *implementation_;
    if (state.next_row < state.height) {
        throw InvalidInput(fmt::format("{} of {} rows were added", state.next_row, state.height));
    }
    NormalTexture result;
    result.texture.format = state.options.format;
    result.texture.width = state.width;
    result.texture.height = state.height;
    if (channels_of(state.options.format) == 2) result.texture.swizzle = "rg01";
    if (state.options.roughness) {
        result.roughness.emplace();
        result.roughness->format = TextureFormat::bc4;
        result.roughness->width = state.width;
        result.roughness->height = state.height;
    }
    for (GrowingLevel& level : state.levels)
        level.finish(result, report);
    return result;
}

}  // namespace relief
