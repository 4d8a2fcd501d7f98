// SPDX-License-Identifier: Apache-2.0
// All rows to the file; from below, how far the next baked texel downwards is; then from the top
// the same upwards, and along each row the nearest of both. Tests:
// tests/mesh/bake/border_fill_test.cpp.
#include "bake/border_fill.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "bake/baked_layers.h"
#include "bake/nearest_columns.h"
#include "bake/texel_mean.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr int strip_rows = 64;
constexpr std::uint16_t never = 0xffff;  // No baked texel in that direction.

/// A file without a name, in memory as far as the system likes.
class NamelessFile {
  public:
    explicit NamelessFile(const std::filesystem::path& folder) : folder_(folder) {
        std::string name = (folder / ".relief-XXXXXX").string();
        descriptor_ = mkstemp(name.data());
        if (descriptor_ < 0) fail("no temporary file can be made");
        unlink(name.c_str());
    }
    ~NamelessFile() {
        if (memory_ != nullptr) munmap(memory_, size_);
        close(descriptor_);
    }
    NamelessFile(const NamelessFile&) = delete;
    NamelessFile& operator=(const NamelessFile&) = delete;

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

    /// All of it, to be read and, where it was written before, written.
    std::byte* map(std::size_t size) {
        size_ = size;
        void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
        if (memory == MAP_FAILED) fail("a temporary file cannot be read");
        memory_ = memory;
        return static_cast<std::byte*>(memory);
    }

    /// What was looked at need not stay in memory.
    void forget() const { madvise(memory_, size_, MADV_DONTNEED); }

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

struct BorderFill::Implementation {
    Implementation(int map_width, int map_height, const std::filesystem::path& folder,
                   std::function<void(const BakedRows&)> to)
        : width(static_cast<std::size_t>(map_width)),
          height(map_height),
          take(std::move(to)),
          file(folder) {}

    std::size_t width;
    int height;
    std::function<void(const BakedRows&)> take;
    NamelessFile file;
    int end_row = 0;
    /// Where the layers, the states and the distances downwards begin; layers that there are not
    /// have no place.
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
        // Room, so that none is missing when it is written through memory.
        const std::vector<std::uint16_t> none(rows.states.size(), never);
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

    /// One row further from the texels that are baked.
    void step(int row, std::vector<std::uint16_t>& distances) const {
        const TexelState* state = states() + first_of(row);
        for (std::size_t x = 0; x < width; ++x) {
            const auto further = static_cast<std::uint16_t>(distances[x] + 1);
            distances[x] = state[x] == TexelState::baked ? std::uint16_t{0}
                           : distances[x] == never       ? never
                                                         : further;
        }
    }

    void measure_downwards() const {
        std::vector<std::uint16_t> distances(width, never);
        for (int row = height; row-- > 0;) {
            step(row, distances);
            std::copy(distances.begin(), distances.end(), downwards() + first_of(row));
            if (row % strip_rows == 0) file.forget();
        }
    }

    void finish() {
        memory = file.map(size);
        measure_downwards();
        std::vector<std::uint16_t> distances(width, never), upwards;
        for (int first = 0; first < height; first += strip_rows) {
            const int last = std::min(first + strip_rows, height);
            upwards.clear();
            for (int row = first; row < last; ++row) {
                step(row, distances);
                upwards.insert(upwards.end(), distances.begin(), distances.end());
            }
            hand_on(first, last, upwards);
            file.forget();
        }
    }

    void hand_on(int first, int last, const std::vector<std::uint16_t>& upwards) const {
        const std::size_t begin = first_of(first);
        const std::size_t count = first_of(last) - begin;
        std::array<std::vector<float>, baked_layers.size()> values;
        std::vector<TexelState> found(states() + begin, states() + begin + count);
        BakedRows rows;
        rows.first_row = first;
        rows.row_count = last - first;
        rows.states = found;
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
        take(rows);
    }

    void fill_row(int row, const BakedRows& rows, std::span<const std::uint16_t> up,
                  NearestColumns& nearest) const {
        const std::size_t here = first_of(row);
        const std::span<const std::uint16_t> down(downwards() + here, width);
        nearest.clear();
        for (std::size_t x = 0; x < width; ++x) {
            const std::uint16_t distance = std::min(up[x], down[x]);
            const bool is_inside =
                distance == 0 && (x == 0 || up[x - 1] == 0) && (x + 1 == width || up[x + 1] == 0);
            // Between two that are baked, a texel is nearest to none that is not.
            if (distance != never && !is_inside) nearest.add(static_cast<int>(x), distance);
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
                       std::function<void(const BakedRows&)> take)
    : implementation_(std::make_unique<Implementation>(width, height, folder, std::move(take))) {}

BorderFill::~BorderFill() = default;

void BorderFill::push(const BakedRows& rows) {
    Implementation& work = *implementation_;
    if (work.end_row == 0) work.lay_out(rows);
    work.store(rows);
    work.end_row += rows.row_count;
    if (work.end_row == work.height) work.finish();
}

}  // namespace relief
