// SPDX-License-Identifier: Apache-2.0
// Blending of normal maps, see normal_blend.h: the formulas as [Barré-Brisebois and Hill 2012]
// gather them, in double, each made unit at the end. No direction: the base's own, counted.
// Tests: tests/mesh/image/normals/normal_blend_test.cpp.
#include "relief/mesh/normal_blend.h"

#include "image/texel_loops.h"

namespace relief {
namespace {

Direction sum_of_slopes(const Direction& b, const Direction& d) {
    return {b.x * d.z + d.x * b.z, b.y * d.z + d.y * b.z, b.z * d.z};
}

/// t (t . u) / t.z - u with t = b + (0,0,1) and u = (-d.x, -d.y, d.z), times t.z, which is positive
/// but where the base faces straight back. There this is zero.
Direction reoriented(const Direction& b, const Direction& d) {
    const Direction t{b.x, b.y, b.z + 1.0};
    const double along = d.z * t.z - t.x * d.x - t.y * d.y;
    return {t.x * along + d.x * t.z, t.y * along + d.y * t.z, t.z * (along - d.z)};
}

/// The detail along three rows: the base, and the base turned by 90 degrees about y and about x.
Direction in_turned_frame(const Direction& b, const Direction& d) {
    return {d.x * b.z + d.y * b.x + d.z * b.x, d.x * b.y + d.y * b.z + d.z * b.y,
            -d.x * b.x - d.y * b.y + d.z * b.z};
}

/// Of two components, each as a colour from 0 to 1.
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

void blend_normals(Image& base, const Image& detail, NormalBlend method, Report& report) {
    check_floats(base, 3, "normals of a base");
    check_floats(detail, 3, "normals of a detail");
    float* const to = base.as<float>().data();
    const float* const from = detail.as<float>().data();
    const auto width = static_cast<std::size_t>(base.width);
    const auto period_x = static_cast<std::size_t>(detail.width);
    const auto period_y = static_cast<std::size_t>(detail.height);
    for_each_row(base.width, base.height, report, [&](std::size_t row, Report& found) {
        blend_row(to + row * width * 3, from + row % period_y * period_x * 3, width, period_x,
                  method, row * width, found);
    });
}

}  // namespace relief
