// SPDX-License-Identifier: Apache-2.0
// Operations on single normals (z from x and y, lengths, slopes) and blending of normal maps.
//
// All formulas are computed in double precision and rounded once. The blending formulas are those
// of [Barré-Brisebois and Hill 2012], normalized at the end. An undefined direction becomes flat,
// or the base's own direction when blending, and is counted.
#include "relief/mesh/normal_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "image/normal_bands.h"
#include "image/normal_coding.h"
#include "image/texel_loops.h"
#include "image/unit_vectors.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr double largest_strength = 1e6;

/// Returns the normal with these coordinates that points outwards.
Direction facing_outwards(double x, double y, std::size_t texel, Report& found) {
    const double square = x * x + y * y;
    if (!std::isfinite(square)) {
        found.add("normal without direction", "texel", texel, "read as flat");
        return {0.0, 0.0, 1.0};
    }
    if (square <= 1.0) return {x, y, std::sqrt(1.0 - square)};
    found.add("x and y longer than 1", "texel", texel, "shortened to 1, with z = 0");
    const double length = std::sqrt(square);
    return {x / length, y / length, 0.0};
}

/// Returns the largest change of length by rounding or dithering.
template <typename Sample>
double length_tolerance(FlatCode flat) {
    if constexpr (std::is_same_v<Sample, float>)
        return 1e-3;
    else
        return std::numbers::sqrt3 / NormalCoding<Sample>::steps(flat);
}

template <typename Sample>
RowLengths lengths_of_row(const Image& map, const SampleDecoder<Sample>& decoded, double tolerance,
                          std::size_t row, Report& found) {
    const auto width = static_cast<std::size_t>(map.width);
    const auto stride = static_cast<std::size_t>(map.channels);
    const UnitVectorFunctions functions = unit_vector_functions();
    const Sample* sample = map.as<Sample>().data() + row * width * stride;
    RowLengths result;
    std::vector<std::size_t> odd;  // Often all texels; the report gets them at once.
    VectorGroup group;
    VectorNumbers lengths;
    for (std::size_t first = 0; first < width; first += vectors_per_group) {
        const std::size_t count = std::min(vectors_per_group, width - first);
        for (std::size_t i = 0; i < count; ++i, sample += stride) {
            group.x[i] = decoded(sample[0]);
            group.y[i] = decoded(sample[1]);
            group.z[i] = decoded(sample[2]);
        }
        functions.lengths(group, lengths);
        for (std::size_t i = 0; i < count; ++i) {
            const double length = lengths[i];
            if (!(std::abs(length - 1.0) <= tolerance)) odd.push_back(row * width + first + i);
            if (!std::isfinite(length)) continue;
            result.min = std::min(result.min, length);
            result.max = std::max(result.max, length);
            result.sum += length;
            ++result.count;
        }
    }
    if (!odd.empty())
        found.add({"normal not of unit length", "texel", "scaled to length 1", odd.size(), odd});
    return result;
}

template <typename Sample>
void decode_xy(const ImageView& map, const XyChannels& channels, double up, FlatCode flat,
               const ExactFlat<Sample>& exact, float* normals, Report& report) {
    const auto stride = static_cast<std::size_t>(map.channels);
    const auto x = static_cast<std::size_t>(channels.x);
    const auto y = static_cast<std::size_t>(channels.y);
    const NormalCoding<Sample> coding{flat};
    for_each_row(map.width, map.height, report, [&](std::size_t row, Report& found) {
        const Sample* sample = map.row<Sample>(static_cast<int>(row));
        const std::size_t first = row * static_cast<std::size_t>(map.width);
        const std::size_t end = first + static_cast<std::size_t>(map.width);
        for (std::size_t texel = first; texel < end; ++texel, sample += stride) {
            const Direction normal =
                exact.is_flat(sample[x], sample[y])
                    ? Direction{0.0, 0.0, 1.0}
                    : facing_outwards(coding.decoded(sample[x]), coding.decoded(sample[y]) * up,
                                      texel, found);
            store(normal, normals + texel * 3);
        }
    });
}

}  // namespace

void detail::check_xy_channels(int count, const XyChannels& channels) {
    for (const int channel : {channels.x, channels.y}) {
        if (channel < 0 || channel >= count)
            throw InvalidInput(
                fmt::format("there is no channel {}, but only {}", channel + 1, count));
    }
}

Image decode_xy_map(const ImageView& map, const XyChannels& channels, Green green, FlatCode flat,
                    Report& report, FlatTexels texels) {
    if (map.empty()) throw InvalidInput("the normal map is empty");
    check_xy_channels(map.channels, channels);
    Image result = make_image(map.width, map.height, 3, 32, ColorSpace::data);
    float* const normals = result.as<float>().data();
    const double up = green == Green::up ? 1.0 : -1.0;
    with_sample_type(map, [&]<typename Sample>(Sample) {
        const ExactFlat<Sample> exact(map, flat, texels, channels.x, channels.y);
        decode_xy<Sample>(map, channels, up, flat, exact, normals, report);
    });
    return result;
}

Image detail::decode_xy_rows(const ImageView& map, const XyChannels& channels, FlatCode flat,
                             const FlatCodes& codes, Report& report) {
    check_xy_channels(map.channels, channels);
    Image result = make_image(map.width, map.height, 3, 32, ColorSpace::data);
    with_sample_type(map, [&]<typename Sample>(Sample) {
        decode_xy<Sample>(map, channels, 1.0, flat, ExactFlat<Sample>(codes),
                          result.as<float>().data(), report);
    });
    return result;
}

void detail::append_row_lengths(const Image& map, FlatCode flat, std::vector<RowLengths>& lengths,
                                Report& report) {
    if (map.empty()) throw InvalidInput("the normal map is empty");
    if (map.channels < 3)
        throw InvalidInput(fmt::format("a normal map has 3 or 4 channels, not {}", map.channels));
    const std::size_t first = lengths.size();
    lengths.resize(first + static_cast<std::size_t>(map.height));
    with_sample_type(map, [&]<typename Sample>(Sample) {
        const SampleDecoder<Sample> decoded(flat);
        const double tolerance = length_tolerance<Sample>(flat);
        for_each_row(map.width, map.height, report, [&](std::size_t row, Report& found) {
            lengths[first + row] = lengths_of_row<Sample>(map, decoded, tolerance, row, found);
        });
    });
}

LengthRange detail::range_of(const std::vector<RowLengths>& rows) {
    RowLengths all;
    for (const RowLengths& row : rows) {
        all.min = std::min(all.min, row.min);
        all.max = std::max(all.max, row.max);
        all.sum += row.sum;
        all.count += row.count;
    }
    if (all.count == 0) return {};
    return {all.min, all.sum / static_cast<double>(all.count), all.max};
}

LengthRange measure_lengths(const Image& map, FlatCode flat, Report& report) {
    std::vector<RowLengths> rows;
    append_row_lengths(map, flat, rows, report);
    return range_of(rows);
}

void scale_slopes(Image& normals, double strength, Report& report) {
    check_floats(normals, 3, "normals");
    if (!(std::abs(strength) <= largest_strength)) {
        throw InvalidInput(
            fmt::format("the strength is {}, but must be within +-{}", strength, largest_strength));
    }
    const std::span<float> all = normals.as<float>();
    for_each_texel(all.size() / 3, report, [&](std::size_t texel, Report& found) {
        float* const normal = &all[texel * 3];
        if (!(normal[2] > 0.0F))
            found.add("normal that does not face outwards", "texel", texel,
                      "x and y are multiplied");
        Direction scaled{normal[0] * strength, normal[1] * strength, normal[2]};
        if (!make_unit(scaled)) found.add("normal without direction", "texel", texel, "made flat");
        store(scaled, normal);
    });
}

Image slopes_from_normals(const Image& normals, Report& report) {
    check_floats(normals, 3, "normals");
    Image result = make_image(normals.width, normals.height, 2, 32, ColorSpace::data);
    const std::span<const float> from = normals.as<float>();
    const std::span<float> to = result.as<float>();
    for_each_texel(from.size() / 3, report, [&](std::size_t texel, Report& found) {
        const double x = from[texel * 3];
        const double y = from[texel * 3 + 1];
        const double z = from[texel * 3 + 2];
        const double across = std::sqrt(x * x + y * y);
        double scale = -1.0 / z;
        if (!(z > 0.0 && across <= largest_slope * z)) {
            found.add("normal too steep for a slope", "texel", texel,
                      fmt::format("its slope taken as {:g}", largest_slope));
            scale = across > 0.0 ? -largest_slope / across : 0.0;
        }
        to[texel * 2] = static_cast<float>(x * scale + 0.0);
        to[texel * 2 + 1] = static_cast<float>(y * scale + 0.0);
    });
    return result;
}

Image normals_from_slopes(const Image& slopes, Report& report) {
    check_floats(slopes, 2, "slopes");
    Image result = make_image(slopes.width, slopes.height, 3, 32, ColorSpace::data);
    const std::span<const float> from = slopes.as<float>();
    const std::span<float> to = result.as<float>();
    for_each_texel(from.size() / 2, report, [&](std::size_t texel, Report& found) {
        Direction normal{-static_cast<double>(from[texel * 2]),
                         -static_cast<double>(from[texel * 2 + 1]), 1.0};
        if (!make_unit(normal)) found.add("slope that is not finite", "texel", texel, "made flat");
        store(normal, &to[texel * 3]);
    });
    return result;
}

namespace {

Direction sum_of_slopes(const Direction& b, const Direction& d) {
    return {b.x * d.z + d.x * b.z, b.y * d.z + d.y * b.z, b.z * d.z};
}

/// Computes t (t . u) / t.z - u with t = b + (0,0,1) and u = (-d.x, -d.y, d.z), multiplied by t.z.
/// The factor is positive unless the base points straight back; then it is zero.
Direction reoriented(const Direction& b, const Direction& d) {
    const Direction t{b.x, b.y, b.z + 1.0};
    const double along = d.z * t.z - t.x * d.x - t.y * d.y;
    return {t.x * along + d.x * t.z, t.y * along + d.y * t.z, t.z * (along - d.z)};
}

/// Returns the detail in a frame of three rows: the base, and the base rotated by 90 degrees about
/// y and about x.
Direction in_turned_frame(const Direction& b, const Direction& d) {
    return {d.x * b.z + d.y * b.x + d.z * b.x, d.x * b.y + d.y * b.z + d.z * b.y,
            -d.x * b.x - d.y * b.y + d.z * b.z};
}

/// Blends two components, each as a color from 0 to 1.
double overlay(double b, double d) {
    const double base = (b + 1.0) / 2.0;
    const double detail = (d + 1.0) / 2.0;
    const double mixed =
        base < 0.5 ? 2.0 * base * detail : 1.0 - 2.0 * (1.0 - base) * (1.0 - detail);
    return 2.0 * mixed - 1.0;
}

Direction blended(NormalBlend method, const Direction& b, const Direction& d) {
    switch (method) {
        case NormalBlend::reoriented:
            return reoriented(b, d);
        case NormalBlend::partial_derivative:
            return sum_of_slopes(b, d);
        case NormalBlend::whiteout:
            return {b.x + d.x, b.y + d.y, b.z * d.z};
        case NormalBlend::udn:
            return {b.x + d.x, b.y + d.y, b.z};
        case NormalBlend::unity:
            return in_turned_frame(b, d);
        case NormalBlend::linear:
            return {b.x + d.x, b.y + d.y, b.z + d.z};
        case NormalBlend::overlay:
            break;
    }
    return {overlay(b.x, d.x), overlay(b.y, d.y), overlay(b.z, d.z)};
}

void blend_row(float* base, const float* detail, std::size_t width, std::size_t period,
               NormalBlend method, std::size_t first_texel, Report& found) {
    for (std::size_t x = 0, at = 0; x < width; ++x, at = at + 1 == period ? 0 : at + 1) {
        float* const b = base + x * 3;
        const float* const d = detail + at * 3;
        Direction result = blended(method, {b[0], b[1], b[2]}, {d[0], d[1], d[2]});
        const bool base_faces_out = b[2] >= 0.0F;
        if (!make_unit(result)) {
            found.add("blend without direction", "texel", first_texel + x, "left as the base");
            continue;
        }
        store(result, b);
        if (base_faces_out && result.z < 0.0)
            found.add("detail facing back on its base", "texel", first_texel + x, "left so");
    }
}

}  // namespace

void detail::blend_normal_rows(Image& base, int first_row, const Image& detail, NormalBlend method,
                               Report& report) {
    check_floats(base, 3, "normals of a base");
    check_floats(detail, 3, "normals of a detail");
    float* const to = base.as<float>().data();
    const float* const from = detail.as<float>().data();
    const auto width = static_cast<std::size_t>(base.width);
    const auto period_x = static_cast<std::size_t>(detail.width);
    const auto period_y = static_cast<std::size_t>(detail.height);
    for_each_row(base.width, base.height, report, [&](std::size_t row, Report& found) {
        const std::size_t detail_row = (static_cast<std::size_t>(first_row) + row) % period_y;
        blend_row(to + row * width * 3, from + detail_row * period_x * 3, width, period_x, method,
                  row * width, found);
    });
}

void blend_normals(Image& base, const Image& detail, NormalBlend method, Report& report) {
    blend_normal_rows(base, 0, detail, method, report);
}

}  // namespace relief
