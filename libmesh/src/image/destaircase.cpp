// SPDX-License-Identifier: Apache-2.0
// De-staircasing: surfaces are smoothed from fine to wide. Each is accepted where its residual is
// that of rounding [Lepski 1991], and the result is then limited to half a step around the stored
// code. Heights are in steps during the computation. Holes remain; their filled values serve their
// neighbors. An invalid image or step throws.
#include "relief/mesh/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "image/height_holes.h"
#include "image/texel_loops.h"
#include "parallel.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The number of scales, each twice as wide as the one before; the widest has a deviation of 37
/// texels.
constexpr int scales = 6;
/// Slightly less than half a step, so that rounding to float does not exceed the limit.
constexpr float bound = 0.49F;
/// Rounding has a mean square error of 1/12. A smooth surface with this mean square distance from
/// the codes is trusted completely, ...
constexpr float believed = 1.0F / 12.0F;
/// ... and one with this distance is not trusted at all.
constexpr float refused = 1.7F / 12.0F;

struct Plane {
    int width = 0;
    int height = 0;
    std::vector<float> values;

    [[nodiscard]] const float* row(int y) const {
        return values.data() + static_cast<std::ptrdiff_t>(y) * width;
    }
    [[nodiscard]] float* row(int y) {
        return values.data() + static_cast<std::ptrdiff_t>(y) * width;
    }
};

template <typename WithRows>
void for_rows(const Plane& plane, const WithRows& with_rows) {
    const auto grain = static_cast<std::size_t>(std::max(1, (1 << 16) / plane.width));
    parallel_for(static_cast<std::size_t>(plane.height), grain,
                 [&](std::size_t begin, std::size_t end) {
                     with_rows(static_cast<int>(begin), static_cast<int>(end));
                 });
}

/// Smooths with the binomial (1 4 6 4 1) / 16 over rows, then over columns. Taps are `spacing`
/// apart.
class Binomial {
  public:
    Binomial(int width, int spacing) : width_(width), spacing_(spacing) {
        line_.resize(static_cast<std::size_t>(width + 4 * spacing));
    }

    /// \param rows    the rows y - 2 s, y - s, y, y + s and y + 2 s
    /// \param extend  extends a line of columns inside beyond both ends by some columns
    template <typename Extend>
    void row(const std::array<const float*, 5>& rows, const Extend& extend, float* result) {
        const std::ptrdiff_t s = spacing_;
        float* const line = line_.data() + 2 * s;
        for (std::ptrdiff_t x = 0; x < width_; ++x)
            line[x] = sum(rows[0][x], rows[1][x], rows[2][x], rows[3][x], rows[4][x]);
        extend(line, 2 * spacing_);
        for (std::ptrdiff_t x = 0; x < width_; ++x)
            result[x] = sum(line[x - 2 * s], line[x - s], line[x], line[x + s], line[x + 2 * s]);
    }

  private:
    static float sum(float a, float b, float c, float d, float e) {
        return 0.375F * c + 0.25F * (b + d) + 0.0625F * (a + e);
    }

    int width_;
    int spacing_;
    std::vector<float> line_;
};

/// Extends a line by the rule of a border. Columns beyond the other end are known already.
void extend_line(float* line, int width, int columns, Wrap wrap) {
    float* const last = line + width - 1;
    for (int x = 1; x <= columns; ++x) {
        if (wrap == Wrap::mirror) {
            line[-x] = line[x - 1];
            last[x] = last[1 - x];
        } else if (wrap == Wrap::repeat) {
            line[-x] = line[width - x];
            last[x] = line[x - 1];
        } else {
            line[-x] = line[0];
            last[x] = last[0];
        }
    }
}

/// Extends a line by reflected(), whose reflections of columns beyond the other end are known
/// already.
void extend_reflected(float* line, int width, int columns) {
    if (width == 1) return extend_line(line, width, columns, Wrap::clamp);
    float* const last = line + width - 1;
    for (int x = 1; x <= columns; ++x) {
        line[-x] = 2 * line[0] - line[x];
        last[x] = 2 * last[0] - last[-x];
    }
}

/// Applies reflected() to a whole row.
void read_reflected(const Plane& plane, int row, float* to) {
    if (row >= 0 && row < plane.height) {
        std::copy_n(plane.row(row), plane.width, to);
        return;
    }
    if (plane.height == 1) return read_reflected(plane, 0, to);
    const int edge = row < 0 ? 0 : plane.height - 1;
    read_reflected(plane, 2 * edge - row, to);
    const float* const border = plane.row(edge);
    for (std::ptrdiff_t x = 0; x < plane.width; ++x)
        to[x] = 2 * border[x] - to[x];
}

/// Computes the low frequencies of the next scale.
void smooth(const Plane& from, const Wraps& wrap, int spacing, Plane& to) {
    for_rows(from, [&](int begin, int end) {
        Binomial binomial(from.width, spacing);
        std::array<std::vector<float>, 5> rooms;
        const auto extend = [&](float* line, int columns) {
            if (wrap.x == Wrap::clamp) return extend_reflected(line, from.width, columns);
            extend_line(line, from.width, columns, wrap.x);
        };
        for (int y = begin; y < end; ++y) {
            std::array<const float*, 5> rows{};
            for (std::size_t k = 0; k < 5; ++k) {
                const int place = y + (static_cast<int>(k) - 2) * spacing;
                const bool is_made = wrap.y == Wrap::clamp && (place < 0 || place >= from.height);
                rows[k] = is_made ? nullptr : from.row(place_within(place, from.height, wrap.y));
                if (!is_made) continue;
                rooms[k].resize(static_cast<std::size_t>(from.width));
                read_reflected(from, place, rooms[k].data());
                rows[k] = rooms[k].data();
            }
            binomial.row(rows, extend, to.row(y));
        }
    });
}

/// A smooth surface of one scale. Smoothing bends curved ground; the difference of two scales
/// removes that bend [Richardson 1911].
struct Surface {
    const Plane& low;
    const Plane& lower;
    float share;  ///< The share of the difference that is added.

    void row(int y, float* to) const {
        const float* const a = low.row(y);
        const float* const b = lower.row(y);
        for (std::ptrdiff_t x = 0; x < low.width; ++x)
            to[x] = a[x] + share * (a[x] - b[x]);
    }
};

/// Moves the heights towards the surface by its trust, which is full where its distance from the
/// codes is that of rounding.
///
/// \param squares  gets the squared distances
void follow(const Surface& surface, const Plane& codes, const Wraps& wrap, int spacing,
            Plane& squares, Plane& trust, Plane& heights) {
    const int width = codes.width;
    // A power continues beyond a clamped border with its mirror image, not with its point
    // reflection.
    const Wrap x_rule = wrap.x == Wrap::clamp ? Wrap::mirror : wrap.x;
    const Wrap y_rule = wrap.y == Wrap::clamp ? Wrap::mirror : wrap.y;
    for_rows(codes, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            const float* const code = codes.row(y);
            float* const square = squares.row(y);
            surface.row(y, square);
            for (std::ptrdiff_t x = 0; x < width; ++x)
                square[x] = (square[x] - code[x]) * (square[x] - code[x]);
        }
    });
    for_rows(codes, [&](int begin, int end) {
        Binomial binomial(width, spacing);
        const auto extend = [&](float* line, int columns) {
            extend_line(line, width, columns, x_rule);
        };
        std::vector<float> own(static_cast<std::size_t>(width));
        std::vector<float> power(static_cast<std::size_t>(width));
        for (int y = begin; y < end; ++y) {
            std::array<const float*, 5> rows{};
            for (std::size_t k = 0; k < 5; ++k)
                rows[k] = squares.row(
                    place_within(y + (static_cast<int>(k) - 2) * spacing, codes.height, y_rule));
            binomial.row(rows, extend, power.data());
            surface.row(y, own.data());
            const float* const smooth_power = power.data();
            const float* const to = own.data();
            float* const trusted = trust.row(y);
            float* const height = heights.row(y);
            for (std::ptrdiff_t x = 0; x < width; ++x) {
                const float share = (refused - smooth_power[x]) * (1.0F / (refused - believed));
                // A texel that is not trusted at one scale is not trusted at wider ones.
                trusted[x] = std::max(0.0F, std::min(share, trusted[x]));
                height[x] += trusted[x] * (to[x] - height[x]);
            }
        }
    });
}

void check(const Image& height, const DestaircaseOptions& options) {
    if (height.empty()) throw InvalidInput("the height field is empty");
    if (height.channels != 1)
        throw InvalidInput(fmt::format("a height field has one channel, not {}", height.channels));
    if (!(options.step >= 0.0 && std::isfinite(options.step)))
        throw InvalidInput(fmt::format("the step is {}, but must be at least 0", options.step));
}

}  // namespace

Destaircased destaircase(const Image& height, const DestaircaseOptions& options) {
    check(height, options);
    Destaircased result{to_float(height)};
    const std::span<const float> stored = result.heights.as<float>();
    result.step = options.step;
    if (result.step == 0.0) {
        const HeightDepth depth = height_depth(height);
        // A constant map has only one "step", and there is nothing to smooth.
        result.step = depth.bits > 0 ? depth.step : 0.0;
    }
    if (result.step == 0.0) return result;

    Report holes;  // The caller counts holes when it uses the heights.
    Plane codes{height.width, height.height, filled_holes(result.heights, options.wrap, holes)};
    if (codes.values.empty()) codes.values.assign(stored.begin(), stored.end());
    const auto per_step = static_cast<float>(1.0 / result.step);
    for (float& code : codes.values)
        code *= per_step;

    Plane now = codes;
    Plane trust{codes.width, codes.height, std::vector<float>(codes.values.size(), 1.0F)};
    Plane low = codes;
    Plane lower = codes;
    Plane squares = codes;
    smooth(codes, options.wrap, 1, low);
    float variance = 1.0F;  // The variance of the smoothing so far, in squared texels.
    for (int scale = 0; scale < scales; ++scale) {
        const int spacing = 1 << scale;
        const float more = 4.0F * static_cast<float>(spacing) * static_cast<float>(spacing);
        smooth(low, options.wrap, 2 * spacing, lower);
        follow({low, lower, variance / more}, codes, options.wrap, 2 * spacing, squares, trust,
               now);
        variance += more;
        std::swap(low.values, lower.values);
    }
    const std::span<float> heights = result.heights.as<float>();
    const auto step = static_cast<float>(result.step);
    parallel_for(heights.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t texel = begin; texel < end; ++texel) {
            const float code = codes.values[texel];
            const float moved = std::min(std::max(now.values[texel], code - bound), code + bound);
            // Unchanged heights keep their bits.
            if (std::isfinite(heights[texel]) && moved != code) heights[texel] = moved * step;
        }
    });
    return result;
}

}  // namespace relief
