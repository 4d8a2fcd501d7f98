// SPDX-License-Identifier: Apache-2.0
// Chooses blocks of a level at random, one of each run, and computes the statistics of their errors
// with the uncertainty of the mean. The blocks of a run are neighbors, so the variance of all
// blocks is at least that within runs, and the stated interval is wide enough.
#include "io/image/block_sample.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "image/texel_loops.h"
#include "parallel.h"
#include "relief/mesh/image.h"

namespace relief::detail {
namespace {

/// A permutation of 64 bits whose result bits all depend on all bits (splitmix64).
std::uint64_t mixed(std::uint64_t value) {
    value += 0x9E3779B97F4A7C15U;
    value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
    value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
    return value ^ (value >> 31U);
}

constexpr std::size_t texels_of_block = 16;

/// Returns half of the interval that has the mean of all blocks with a confidence of 95 %.
/// \param measured  the share of the blocks that were measured
double margin_of_mean(const std::vector<double>& values, double measured) {
    const auto count = static_cast<double>(values.size());
    double sum = 0.0;
    for (const double value : values)
        sum += value;
    double squares = 0.0;
    for (const double value : values)
        squares += (value - sum / count) * (value - sum / count);
    constexpr double deviations_of_95_percent = 1.96;
    const double variance = squares / std::max(count - 1.0, 1.0);
    return deviations_of_95_percent * std::sqrt(variance / count * (1.0 - measured));
}

}  // namespace

BlockSample::BlockSample(int width, int height, std::size_t max_texels)
    : blocks_across_((static_cast<std::size_t>(width) + 3) / 4),
      blocks_(blocks_across_ * ((static_cast<std::size_t>(height) + 3) / 4)) {
    const std::size_t measured = std::max<std::size_t>(max_texels / texels_of_block, 1);
    run_ = (blocks_ + measured - 1) / measured;
}

std::vector<std::size_t> BlockSample::columns(std::size_t row) const {
    std::vector<std::size_t> result;
    const std::size_t begin = row * blocks_across_;
    const std::size_t end = std::min(begin + blocks_across_, blocks_);
    for (std::size_t first = begin / run_ * run_; first < end; first += run_) {
        const std::size_t size = std::min(run_, blocks_ - first);
        const std::size_t block = first + mixed(first / run_) % size;
        if (block >= begin && block < end) result.push_back(block - begin);
    }
    return result;
}

void BlockSample::measure(
    std::size_t first_row, std::size_t end_row,
    const std::function<BlockErrors(std::size_t, std::span<const std::size_t>)>& errors_of) {
    std::vector<BlockErrors> found(end_row - first_row);
    const std::size_t grain = texels_per_piece / texels_of_block * run_ / blocks_across_ + 1;
    parallel_for(found.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::vector<std::size_t> chosen = columns(first_row + i);
            if (!chosen.empty()) found[i] = errors_of(first_row + i, chosen);
        }
    });
    for (const BlockErrors& of_row : found)
        add(of_row);
}

void BlockSample::add(const BlockErrors& found) {
    errors_.insert(errors_.end(), found.errors.begin(), found.errors.end());
    if (run_ == 1) return;  // All blocks are measured.
    std::size_t begin = 0;
    for (const std::size_t count : found.counts) {
        double sum = 0.0;
        double squares = 0.0;
        for (std::size_t i = begin; i < begin + count; ++i) {
            const auto error = static_cast<double>(found.errors[i]);
            sum += error;
            squares += error * error;
        }
        means_.push_back(sum / static_cast<double>(count));
        mean_squares_.push_back(squares / static_cast<double>(count));
        begin += count;
    }
}

MeasuredError BlockSample::result() {
    MeasuredError result{error_stats(std::exchange(errors_, {})), {}};
    if (run_ == 1) return result;
    const auto count = static_cast<double>(means_.size());
    const double measured = count / static_cast<double>(blocks_);
    // If this share of all blocks has some property, `count` random blocks include none of them
    // with a probability of at most 5 %: (1 - share)^count <= exp(-share * count).
    constexpr double minus_log_of_5_percent = 2.9957322735539909;
    const double square_margin = margin_of_mean(mean_squares_, measured);
    result.confidence = SampleConfidence{
        .mean_margin = margin_of_mean(means_, measured),
        .rms_margin = result.error.rms > 0.0 ? square_margin / (2.0 * result.error.rms) : 0.0,
        .share_above_max = std::min(minus_log_of_5_percent / count, 1.0)};
    return result;
}

Image decoded_columns(const EncodedRow& row, std::span<const std::size_t> columns) {
    GpuTexture part;
    part.format = row.format;
    part.width = static_cast<int>(4 * columns.size());
    part.height = row.rows;
    std::vector<std::byte> chosen(texture_level_size(row.format, part.width, row.rows));
    if (block_format_of(row.format)) {
        const std::size_t size = texture_level_size(row.format, 4, 4);
        for (std::size_t i = 0; i < columns.size(); ++i)
            std::memcpy(chosen.data() + i * size, row.bytes.data() + columns[i] * size, size);
    } else {
        const std::size_t size = texture_level_size(row.format, 1, 1);
        const auto width = static_cast<std::size_t>(row.width);
        std::byte* to = chosen.data();
        for (std::size_t y = 0; y < static_cast<std::size_t>(row.rows); ++y) {
            for (const std::size_t column : columns) {
                for (std::size_t x = 0; x < 4; ++x, to += size) {
                    const std::size_t texel = y * width + std::min(4 * column + x, width - 1);
                    std::memcpy(to, row.bytes.data() + texel * size, size);
                }
            }
        }
    }
    part.levels.push_back(std::move(chosen));
    return decode_texture_level(part, 0);
}

BlockErrors normal_block_errors(const EncodedRow& row, std::span<const std::size_t> columns,
                                const float* exact, Green green) {
    const Image decoded = decoded_columns(row, columns);
    const FlatCode flat = flat_code_of(row.format);
    const Image normals = decoded.channels == 2 ? decode_xy_map(decoded, {0, 1}, green, flat)
                                                : decode_normal_map(decoded, green, flat);
    const float* const stored = normals.as<float>().data();
    return block_errors(row, columns, [&](std::size_t texel, std::size_t texel_of_level) {
        const float* const x = exact + 3 * texel_of_level;
        const float* const y = stored + 3 * texel;
        return static_cast<float>(degrees_between({x[0], x[1], x[2]}, {y[0], y[1], y[2]}));
    });
}

FlatCode flat_code_of(TextureFormat format) {
    const std::optional<BlockFormat> blocks = block_format_of(format);
    return blocks && is_signed(*blocks) ? FlatCode::middle : FlatCode::half;
}

}  // namespace relief::detail
