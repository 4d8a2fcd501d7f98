// SPDX-License-Identifier: Apache-2.0
// Edge padding: distances along columns first, then the nearest columns of each row. Only baked
// texels are read and only others are written, so rows are filled in place. Tests:
// tests/mesh/bake/padding_test.cpp.
#include "bake/edge_padding.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "bake/layers.h"
#include "file_replacement.h"
#include "geometry/direction.h"
#include "parallel.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// Returns the value that most texels have; of equally frequent ones, the smallest.
float most_frequent(std::span<const float> values, std::span<const std::size_t> from) {
    float best = values[from.front()];
    std::ptrdiff_t best_count = 0;
    for (const std::size_t texel : from) {
        const float value = values[texel];
        const auto count =
            std::ranges::count(from, value, [&](std::size_t other) { return values[other]; });
        if (count > best_count || (count == best_count && value < best)) {
            best = value;
            best_count = count;
        }
    }
    return best;
}

/// Averages texels of a layer. Directions that cancel give the first one.
/// \param values  all channels of the layer, texel by texel
/// \param from    the texels, at least one
/// \param to      gets the mean; it may be part of `values`
void average(const BakedLayer& layer, std::span<const float> values,
             std::span<const std::size_t> from, float* to) {
    if (layer.mean == TexelMean::majority) {
        to[0] = most_frequent(values, from);
        return;
    }
    if (layer.mean == TexelMean::number) {
        for (std::size_t channel = 0; channel < layer.channels; ++channel) {
            double sum = 0.0;
            for (const std::size_t texel : from)
                sum += values[layer.channels * texel + channel];
            to[channel] = static_cast<float>(sum / static_cast<double>(from.size()));
        }
        return;
    }
    const auto direction = [&](std::size_t texel) {
        return glm::dvec3(values[3 * texel], values[3 * texel + 1], values[3 * texel + 2]);
    };
    glm::dvec3 sum(0.0);
    for (const std::size_t texel : from)
        sum += direction(texel);
    const bool cancels = glm::length(sum) < 1e-6 * static_cast<double>(from.size());
    const glm::vec3 mean = rounded(cancels ? direction(from.front()) : direction_or_zero(sum));
    for (int axis = 0; axis < 3; ++axis)
        to[axis] = mean[axis];
}

constexpr int row_step = 64;  // Of rows that are passed on.
constexpr std::size_t columns_at_once = 256;

template <typename T>
void append(std::vector<T>& all, std::span<const T> more) {
    all.insert(all.end(), more.begin(), more.end());
}

constexpr int strip_rows = 64;
constexpr std::uint16_t no_distance = 0xffff;  // No baked texel in that direction.

/// An unlinked temporary file that is mapped into memory.
class UnlinkedFile {
  public:
    explicit UnlinkedFile(const std::filesystem::path& folder) : folder_(folder) {
        std::string name = (folder / ".relief-XXXXXX").string();
        {
            const SignalDelay delay;  // A signal in between would leave the file.
            descriptor_ = mkstemp(name.data());
            if (descriptor_ >= 0) unlink(name.c_str());
        }
        if (descriptor_ < 0) fail("no temporary file can be made");
    }
    ~UnlinkedFile() {
        if (memory_ != nullptr) munmap(memory_, size_);
        close(descriptor_);
    }
    UnlinkedFile(const UnlinkedFile&) = delete;
    UnlinkedFile& operator=(const UnlinkedFile&) = delete;

    void write(std::size_t at, std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t count =
                pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) fail("a temporary file cannot be written");
            bytes = bytes.subspan(static_cast<std::size_t>(count));
            at += static_cast<std::size_t>(count);
        }
    }

    /// Maps the file for reading and writing.
    std::byte* map(std::size_t size) {
        size_ = size;
        void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
        if (memory == MAP_FAILED) fail("a temporary file cannot be read");
        memory_ = memory;
        return static_cast<std::byte*>(memory);
    }

    /// Releases the mapped pages from memory.
    void release() const { madvise(memory_, size_, MADV_DONTNEED); }

  private:
    [[noreturn]] void fail(const char* what) const {
        throw FileError(folder_, fmt::format("{}: {}", what, std::strerror(errno)));
    }

    std::filesystem::path folder_;
    int descriptor_ = -1;
    void* memory_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace

void NearestColumns::add(int column, int distance) {
    const Parabola added{column, std::int64_t{distance} * distance};
    // Products stay below 2^52 for rows of up to 65536 texels.
    while (parabolas_.size() >= 2) {
        const Parabola& last = parabolas_.back();
        const Crossing begins = crossing(parabolas_[parabolas_.size() - 2], last);
        const Crossing ends = crossing(last, added);
        // A parabola that is lowest only in a single point stays.
        if (ends.numerator * begins.denominator >= begins.numerator * ends.denominator) break;
        parabolas_.pop_back();
    }
    parabolas_.push_back(added);
}

std::int64_t NearestColumns::squared_distance(int column) {
    while (current_ + 1 < parabolas_.size()) {
        const Crossing end = crossing(parabolas_[current_], parabolas_[current_ + 1]);
        if (end.numerator >= column * end.denominator) break;
        ++current_;
    }
    const Parabola& lowest = parabolas_[current_];
    return (column - lowest.column) * (column - lowest.column) + lowest.squared;
}

Dilation::Dilation(int width, int height, int texels, std::function<void(const BakedRows&)> output)
    : width_(width), height_(height), texels_(texels), output_(std::move(output)) {
    window_.layers.resize(baked_layers.size());
}

void Dilation::push(const BakedRows& rows) {
    if (texels_ == 0) return output_(rows);
    for (std::size_t i = 0; i < baked_layers.size(); ++i)
        append<float>(window_.layers[i], rows.*baked_layers[i].values);
    append<TexelState>(window_.states, rows.states);
    end_row_ += rows.row_count;
    const int complete = (end_row_ - texels_) / row_step * row_step;
    const int last = end_row_ == height_ ? height_ : complete;
    if (last > next_row_) pass_on(last);
}

void Dilation::pass_on(int last_row) {
    measure_columns(last_row);
    const BakedRows rows = rows_of(first_row_, end_row_);
    parallel_for(static_cast<std::size_t>(last_row - next_row_), 4,
                 [&](std::size_t begin, std::size_t end) {
                     NearestColumns nearest;
                     for (std::size_t i = begin; i < end; ++i)
                         fill_row(next_row_ + static_cast<int>(i), rows, nearest);
                 });
    // The output may change its rows, so rows needed later are copied first.
    const int kept = std::max(last_row - texels_, first_row_);
    Window rest = last_row < height_ ? copy_from(kept) : Window{};
    output_(rows_of(next_row_, last_row));
    window_ = std::move(rest);
    next_row_ = last_row;
    first_row_ = kept;
}

/// Measures blocks of adjacent columns, whose running distances fit a cache.
void Dilation::measure_columns(int last_row) {
    const auto beyond = static_cast<std::uint16_t>(texels_ + 1);
    const auto width = static_cast<std::size_t>(width_);
    const int begin_row = std::max(next_row_ - texels_, first_row_);
    const int end_row = std::min(last_row + texels_, end_row_);
    upwards_.resize(texels_in(last_row - next_row_));
    downwards_.resize(upwards_.size());
    parallel_for(width, columns_at_once, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint16_t> distance;
        const auto pass = [&](int row, std::vector<std::uint16_t>& distances) {
            const TexelState* states = &window_.states[texels_in(row - first_row_)];
            for (std::size_t x = begin; x < end; ++x) {
                const auto farther = static_cast<std::uint16_t>(distance[x - begin] + 1);
                distance[x - begin] =
                    states[x] == TexelState::baked ? std::uint16_t{0} : std::min(farther, beyond);
            }
            if (row < next_row_ || row >= last_row) return;
            const auto to =
                distances.begin() + static_cast<std::ptrdiff_t>(texels_in(row - next_row_));
            std::copy(distance.begin(), distance.end(), to + static_cast<std::ptrdiff_t>(begin));
        };
        distance.assign(end - begin, beyond);
        for (int row = begin_row; row < last_row; ++row)
            pass(row, upwards_);
        distance.assign(end - begin, beyond);
        for (int row = end_row; row-- > next_row_;)
            pass(row, downwards_);
    });
}

void Dilation::fill_row(int row, const BakedRows& rows, NearestColumns& nearest) {
    const std::size_t out = texels_in(row - next_row_);
    const std::size_t here = texels_in(row - first_row_);
    const auto up = [&](int column) { return upwards_[out + static_cast<std::size_t>(column)]; };
    const auto down = [&](int column) {
        return downwards_[out + static_cast<std::size_t>(column)];
    };
    const auto is_baked = [&](int column) {
        return column < 0 || column == width_ || up(column) == 0;
    };
    nearest.clear();
    for (int column = 0; column < width_; ++column) {
        const int distance = std::min(up(column), down(column));
        // A baked texel between two baked ones is not the nearest of any other texel.
        if (distance == 0 && is_baked(column - 1) && is_baked(column + 1)) continue;
        if (distance <= texels_) nearest.add(column, distance);
    }
    if (nearest.is_empty()) return;
    std::vector<std::size_t> from;
    for (int column = 0; column < width_; ++column) {
        if (up(column) == 0) continue;
        if (nearest.squared_distance(column) > std::int64_t{texels_} * texels_) continue;
        from.clear();
        nearest.for_nearest(column, [&](int other) {
            const std::size_t texel = here + static_cast<std::size_t>(other);
            const int above = up(other), below = down(other);
            if (above <= below) from.push_back(texel - texels_in(above));
            if (below <= above && below != 0) from.push_back(texel + texels_in(below));
        });
        const std::size_t to = here + static_cast<std::size_t>(column);
        for (const BakedLayer& layer : baked_layers) {
            const std::span<float> values = rows.*layer.values;
            if (!values.empty()) average(layer, values, from, &values[layer.channels * to]);
        }
        rows.states[to] = TexelState::padded;
    }
}

BakedRows Dilation::rows_of(int first_row, int last_row) {
    BakedRows rows;
    rows.first_row = first_row;
    rows.row_count = last_row - first_row;
    const std::size_t first = texels_in(first_row - first_row_);
    const std::size_t texels = texels_in(rows.row_count);
    for (std::size_t i = 0; i < baked_layers.size(); ++i) {
        const std::size_t channels = baked_layers[i].channels;
        if (window_.layers[i].empty()) continue;
        rows.*baked_layers[i].values =
            std::span(window_.layers[i]).subspan(channels * first, channels * texels);
    }
    rows.states = std::span(window_.states).subspan(first, texels);
    return rows;
}

Dilation::Window Dilation::copy_from(int first_row) const {
    const auto first = static_cast<std::ptrdiff_t>(texels_in(first_row - first_row_));
    Window rest;
    for (std::size_t i = 0; i < baked_layers.size(); ++i) {
        const std::vector<float>& values = window_.layers[i];
        const auto skipped = static_cast<std::ptrdiff_t>(baked_layers[i].channels) * first;
        rest.layers.emplace_back(values.empty() ? values.end() : values.begin() + skipped,
                                 values.end());
    }
    rest.states.assign(window_.states.begin() + first, window_.states.end());
    return rest;
}

struct BorderFill::Implementation {
    Implementation(int map_width, int map_height, const std::filesystem::path& folder,
                   std::function<void(const BakedRows&)> to)
        : width(static_cast<std::size_t>(map_width)),
          height(map_height),
          output(std::move(to)),
          file(folder) {}

    std::size_t width;
    int height;
    std::function<void(const BakedRows&)> output;
    UnlinkedFile file;
    int end_row = 0;
    /// File offsets of the layers, the states and the distances downwards.
    std::array<std::size_t, baked_layers.size()> layer_at{};
    std::array<bool, baked_layers.size()> has_layer{};
    std::size_t states_at = 0, downwards_at = 0, size = 0;
    std::byte* memory = nullptr;

    [[nodiscard]] std::size_t texels() const { return width * static_cast<std::size_t>(height); }
    [[nodiscard]] std::size_t first_of(int row) const {
        return width * static_cast<std::size_t>(row);
    }

    void lay_out(const BakedRows& rows) {
        for (std::size_t i = 0; i < baked_layers.size(); ++i) {
            has_layer[i] = !(rows.*baked_layers[i].values).empty();
            layer_at[i] = size;
            if (has_layer[i]) size += baked_layers[i].channels * sizeof(float) * texels();
        }
        downwards_at = size;
        size += sizeof(std::uint16_t) * texels();
        states_at = size;
        size += sizeof(TexelState) * texels();
    }

    void store(const BakedRows& rows) {
        const std::size_t first = first_of(rows.first_row);
        for (std::size_t i = 0; i < baked_layers.size(); ++i) {
            if (!has_layer[i]) continue;
            file.write(layer_at[i] + sizeof(float) * baked_layers[i].channels * first,
                       std::as_bytes(rows.*baked_layers[i].values));
        }
        file.write(states_at + first, std::as_bytes(rows.states));
        // This allocates the space that is later written through the mapping.
        const std::vector<std::uint16_t> none(rows.states.size(), no_distance);
        file.write(downwards_at + sizeof(std::uint16_t) * first, std::as_bytes(std::span(none)));
    }

    [[nodiscard]] const TexelState* states() const {
        return reinterpret_cast<const TexelState*>(memory + states_at);
    }
    [[nodiscard]] std::uint16_t* downwards() const {
        return reinterpret_cast<std::uint16_t*>(memory + downwards_at);
    }
    [[nodiscard]] std::span<const float> layer(std::size_t i) const {
        return {reinterpret_cast<const float*>(memory + layer_at[i]),
                baked_layers[i].channels * texels()};
    }

    /// Advances the distances from baked texels by one row.
    void step(int row, std::vector<std::uint16_t>& distances) const {
        const TexelState* state = states() + first_of(row);
        for (std::size_t x = 0; x < width; ++x) {
            const auto farther = static_cast<std::uint16_t>(distances[x] + 1);
            distances[x] = state[x] == TexelState::baked ? std::uint16_t{0}
                           : distances[x] == no_distance ? no_distance
                                                         : farther;
        }
    }

    void measure_downwards() const {
        std::vector<std::uint16_t> distances(width, no_distance);
        for (int row = height; row-- > 0;) {
            step(row, distances);
            std::copy(distances.begin(), distances.end(), downwards() + first_of(row));
            if (row % strip_rows == 0) file.release();
        }
    }

    void finish() {
        memory = file.map(size);
        measure_downwards();
        std::vector<std::uint16_t> distances(width, no_distance), upwards;
        for (int first = 0; first < height; first += strip_rows) {
            const int last = std::min(first + strip_rows, height);
            upwards.clear();
            for (int row = first; row < last; ++row) {
                step(row, distances);
                upwards.insert(upwards.end(), distances.begin(), distances.end());
            }
            pass_on(first, last, upwards);
            file.release();
        }
    }

    void pass_on(int first, int last, const std::vector<std::uint16_t>& upwards) const {
        const std::size_t begin = first_of(first);
        const std::size_t count = first_of(last) - begin;
        std::array<std::vector<float>, baked_layers.size()> values;
        std::vector<TexelState> row_states(states() + begin, states() + begin + count);
        BakedRows rows;
        rows.first_row = first;
        rows.row_count = last - first;
        rows.states = row_states;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!has_layer[i]) continue;
            const std::size_t channels = baked_layers[i].channels;
            const auto part = layer(i).subspan(channels * begin, channels * count);
            values[i].assign(part.begin(), part.end());
            rows.*baked_layers[i].values = values[i];
        }
        parallel_for(static_cast<std::size_t>(rows.row_count), 4,
                     [&](std::size_t from, std::size_t to) {
                         NearestColumns nearest;
                         for (std::size_t row = from; row < to; ++row)
                             fill_row(first + static_cast<int>(row), rows,
                                      std::span(upwards).subspan(width * row, width), nearest);
                     });
        output(rows);
    }

    void fill_row(int row, const BakedRows& rows, std::span<const std::uint16_t> up,
                  NearestColumns& nearest) const {
        const std::size_t here = first_of(row);
        const std::span<const std::uint16_t> down(downwards() + here, width);
        nearest.clear();
        for (std::size_t x = 0; x < width; ++x) {
            const std::uint16_t distance = std::min(up[x], down[x]);
            const bool is_interior =
                distance == 0 && (x == 0 || up[x - 1] == 0) && (x + 1 == width || up[x + 1] == 0);
            // A baked texel between two baked ones is not the nearest of any other texel.
            if (distance != no_distance && !is_interior) nearest.add(static_cast<int>(x), distance);
        }
        if (nearest.is_empty()) return;
        std::vector<std::size_t> from;
        for (std::size_t x = 0; x < width; ++x) {
            if (up[x] == 0) continue;
            const int column = static_cast<int>(x);
            static_cast<void>(nearest.squared_distance(column));
            from.clear();
            nearest.for_nearest(column, [&](int other) {
                const auto at = static_cast<std::size_t>(other);
                if (up[at] <= down[at]) from.push_back(here + at - width * up[at]);
                if (down[at] <= up[at] && down[at] != 0)
                    from.push_back(here + at + width * down[at]);
            });
            const std::size_t to = here - first_of(rows.first_row) + x;
            for (std::size_t i = 0; i < baked_layers.size(); ++i) {
                if (!has_layer[i]) continue;
                average(baked_layers[i], layer(i), from,
                        &(rows.*baked_layers[i].values)[baked_layers[i].channels * to]);
            }
            rows.states[to] = TexelState::padded;
        }
    }
};

BorderFill::BorderFill(int width, int height, const std::filesystem::path& folder,
                       std::function<void(const BakedRows&)> output)
    : implementation_(std::make_unique<Implementation>(width, height, folder, std::move(output))) {}

BorderFill::~BorderFill() = default;

void BorderFill::push(const BakedRows& rows) {
    Implementation& work = *implementation_;
    if (work.end_row == 0) work.lay_out(rows);
    work.store(rows);
    work.end_row += rows.row_count;
    if (work.end_row == work.height) work.finish();
}

}  // namespace relief::detail
