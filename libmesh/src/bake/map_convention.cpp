// SPDX-License-Identifier: Apache-2.0
// Finds the convention of a normal map by local search: candidate conventions are compared on some
// of its texels, and the best one is kept. Errors are in degrees, in the space of the meshes.
// Tests: tests/mesh/bake/map_convention_test.cpp.
#include "relief/mesh/map_convention.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/direction.h"
#include "geometry/error_accumulator.h"
#include "parallel.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/tangents.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t max_texels = 4096;
constexpr double kept_share = 0.98;  // Of the best texels; the others may be silhouettes.
constexpr double sure_degrees = 0.02;
constexpr double max_remaining = 0.8;  // A round must reduce the error to this share.
constexpr double tie_ratio = 0.98;     // Errors within this ratio are ties.
constexpr int max_rounds = 3;

constexpr std::array curves = {StoredCurve::none, StoredCurve::srgb_encoded,
                               StoredCurve::srgb_decoded};
constexpr std::array flats = {FlatCode::middle, FlatCode::half};
constexpr std::array turns = {ImageOrientation::upright, ImageOrientation::upside_down,
                              ImageOrientation::mirrored, ImageOrientation::half_turn};
constexpr std::array spaces = {VectorSpace::tangent, VectorSpace::object, VectorSpace::world};
constexpr std::array<std::optional<TangentMethod>, 4> bases = {
    std::nullopt, TangentMethod::mikktspace, TangentMethod::area_weighted, TangentMethod::lengyel};
constexpr std::array frames = {FrameInterpolation::interpolated, FrameInterpolation::unit,
                               FrameInterpolation::orthonormal,
                               FrameInterpolation::vertex_bitangent};

/// Returns all signed permutations, or those that keep z; positive signs come first.
std::vector<AxisMapping> mappings(bool keeps_z) {
    std::vector<AxisMapping> all;
    std::array<int, 3> order = {0, 1, 2};
    do {
        if (keeps_z && order[2] != 2) continue;
        for (int signs = 0; signs < (keeps_z ? 4 : 8); ++signs) {
            AxisMapping mapping;
            for (std::size_t i = 0; i < 3; ++i)
                mapping[i] = {order[i], (signs >> i & 1) != 0};
            all.push_back(mapping);
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return all;
}

/// Tangents by corner.
using CornerTangents = std::vector<glm::vec4>;

CornerTangents corner_tangents(const Mesh& mesh) {
    CornerTangents corners;
    corners.reserve(3 * mesh.triangles.size());
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            corners.push_back(mesh.tangents[triangle[i]]);
    }
    return corners;
}

CornerTangents make_corner_tangents(const Mesh& mesh, std::optional<TangentMethod> basis) {
    Report ignored;  // The bake reports defects of the mesh.
    const auto make = basis == TangentMethod::area_weighted ? area_weighted_tangents
                      : basis == TangentMethod::lengyel     ? lengyel_tangents
                                                            : mikktspace_tangents;
    return make(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, ignored);
}

/// The errors of a map under different conventions.
class Readings {
  public:
    Readings(const Image& map, std::span<const KnownTexel> texels, const ConventionSearch& search)
        : map_(map), search_(search) {
        const std::size_t step = (texels.size() + max_texels - 1) / max_texels;
        for (std::size_t i = 0; i < texels.size(); i += step)
            texels_.push_back(texels[i]);
    }

    /// Returns the error of the map under a convention.
    double error(const MapConvention& convention) {
        ++tried;
        const CornerTangents* tangents =
            convention.space == VectorSpace::tangent ? &tangents_by(convention.basis) : nullptr;
        std::vector<double> degrees(texels_.size());
        parallel_for(texels_.size(), 512, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const glm::dvec3 shown =
                    in_mesh(texels_[i], stored(texels_[i], convention), convention, tangents);
                const double angle = degrees_between(shown, texels_[i].reference);
                degrees[i] = std::isnan(angle) ? 180.0 : angle;
            }
        });
        return trimmed(std::move(degrees));
    }
    [[nodiscard]] double expected() const {
        std::vector<double> degrees;
        for (const KnownTexel& texel : texels_)
            degrees.push_back(texel.expected);
        return trimmed(std::move(degrees));
    }

    std::size_t tried = 0;

  private:
    static double trimmed(std::vector<double> degrees) {
        std::sort(degrees.begin(), degrees.end());
        const auto count =
            static_cast<std::size_t>(std::ceil(kept_share * static_cast<double>(degrees.size())));
        ErrorMoments kept;
        for (std::size_t i = 0; i < count; ++i)
            kept.add(degrees[i]);
        return kept.rms();
    }

    const CornerTangents& tangents_by(std::optional<TangentMethod> basis) {
        const auto known = corners_.find(basis);
        if (known != corners_.end()) return known->second;
        const Mesh& low = *search_.low;
        const bool has_given = search_.given != nullptr && !search_.given->tangents.empty();
        CornerTangents made;
        if (!basis && !low.tangents.empty())
            made = corner_tangents(low);
        else if (!basis && has_given)
            made = corner_tangents(*search_.given);
        else
            made = make_corner_tangents(low, basis);
        return corners_.emplace(basis, std::move(made)).first->second;
    }

    /// Returns a sample of the map, 0 to 1.
    [[nodiscard]] double sample(std::size_t index) const {
        if (map_.bits() == 8) return map_.as<std::uint8_t>()[index] / 255.0;
        if (map_.bits() == 16) return map_.as<std::uint16_t>()[index] / 65535.0;
        return map_.as<float>()[index];
    }

    [[nodiscard]] double decoded(double value, const MapConvention& convention) const {
        if (convention.curve == StoredCurve::srgb_encoded)
            value = linear_from_srgb(static_cast<float>(value));
        if (convention.curve == StoredCurve::srgb_decoded)
            value = srgb_from_linear(static_cast<float>(value));
        if (map_.bits() == 32 || convention.flat == FlatCode::half) return 2.0 * value - 1.0;
        const double half = map_.bits() == 8 ? 127.0 : 32767.0;
        return std::max((value * (2.0 * half + 1.0) - (half + 1.0)) / half, -1.0);
    }

    [[nodiscard]] glm::dvec3 stored(const KnownTexel& texel,
                                    const MapConvention& convention) const {
        const bool flips_x = convention.turn == ImageOrientation::mirrored ||
                             convention.turn == ImageOrientation::half_turn;
        const bool flips_y = convention.turn == ImageOrientation::upside_down ||
                             convention.turn == ImageOrientation::half_turn;
        const int x = flips_x ? map_.width - 1 - texel.x : texel.x;
        const int y = flips_y ? map_.height - 1 - texel.y : texel.y;
        const std::size_t first =
            (static_cast<std::size_t>(y) * static_cast<std::size_t>(map_.width) +
             static_cast<std::size_t>(x)) *
            static_cast<std::size_t>(map_.channels);
        glm::dvec3 vector;
        for (int i = 0; i < 3; ++i)
            vector[i] = decoded(sample(first + static_cast<std::size_t>(i)), convention);
        if (search_.green == Green::down) vector.y = -vector.y;
        glm::dvec3 result;
        for (int i = 0; i < 3; ++i) {
            const SignedAxis& from = convention.axes[static_cast<std::size_t>(i)];
            result[i] = from.is_negative ? -vector[from.axis] : vector[from.axis];
        }
        return result;
    }

    [[nodiscard]] glm::dvec3 in_mesh(const KnownTexel& texel, const glm::dvec3& vector,
                                     const MapConvention& convention,
                                     const CornerTangents* tangents) const {
        if (convention.space == VectorSpace::world) return vector;
        if (convention.space == VectorSpace::object)
            return glm::inverse(search_.object_from_mesh) * vector;
        glm::dvec3 n(0.0), t(0.0), b(0.0);
        double w = 0.0;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 corner_n(
                search_.low->normals[search_.low->triangles[texel.triangle][i]]);
            const glm::dvec4 corner_t(
                (*tangents)[3 * std::size_t{texel.triangle} + static_cast<std::size_t>(i)]);
            const double corner_w = convention.ignores_mirroring ? 1.0 : corner_t.w;
            n += texel.weights[i] * corner_n;
            t += texel.weights[i] * glm::dvec3(corner_t);
            w += texel.weights[i] * corner_w;
            b += texel.weights[i] * corner_w * glm::cross(corner_n, glm::dvec3(corner_t));
        }
        if (convention.frame != FrameInterpolation::interpolated) {
            n = direction_or_zero(n);
            if (convention.frame == FrameInterpolation::orthonormal) t = in_plane(t, n);
            t = direction_or_zero(t);
        }
        if (convention.frame == FrameInterpolation::vertex_bitangent)
            b = direction_or_zero(b);
        else
            b = w * glm::cross(n, t);
        return vector.x * t + vector.y * b + vector.z * n;
    }

    const Image& map_;
    const ConventionSearch& search_;
    std::vector<KnownTexel> texels_;
    std::map<std::optional<TangentMethod>, CornerTangents> corners_;
};

/// Returns all conventions one step away from another, the simplest first.
std::vector<MapConvention> neighbors_of(const MapConvention& from) {
    static const std::vector<AxisMapping> in_plane_mappings = mappings(true);
    static const std::vector<AxisMapping> all_mappings = mappings(false);
    const auto mappings_of = [](VectorSpace space) -> const std::vector<AxisMapping>& {
        return space == VectorSpace::tangent ? in_plane_mappings : all_mappings;
    };
    std::vector<MapConvention> all;
    const auto add = [&](const auto& change) {
        MapConvention one = from;
        change(one);
        all.push_back(one);
    };
    for (const AxisMapping& axes : mappings_of(from.space))
        add([&](MapConvention& c) { c.axes = axes; });
    for (const StoredCurve curve : curves)
        add([&](MapConvention& c) { c.curve = curve; });
    for (const FlatCode flat : flats)
        add([&](MapConvention& c) { c.flat = flat; });
    if (from.space == VectorSpace::tangent) {
        for (const bool ignores : {false, true}) {
            for (const std::optional<TangentMethod> basis : bases) {
                for (const FrameInterpolation frame : frames) {
                    add([&](MapConvention& c) {
                        c.ignores_mirroring = ignores;
                        c.basis = basis;
                        c.frame = frame;
                    });
                }
            }
        }
    }
    for (const VectorSpace space : spaces) {
        for (const AxisMapping& axes : mappings_of(space)) {
            if (space == from.space) break;
            add([&](MapConvention& c) {
                c.space = space;
                c.axes = axes;
            });
        }
    }
    for (const ImageOrientation turn : turns) {
        for (const AxisMapping& axes : mappings_of(from.space)) {
            add([&](MapConvention& c) {
                c.turn = turn;
                c.axes = axes;
            });
        }
    }
    return all;
}

std::vector<ConventionPart> changes_between(const MapConvention& a, const MapConvention& b) {
    using enum ConventionPart;
    std::vector<ConventionPart> parts;
    const auto note = [&](bool differs, ConventionPart part) {
        if (differs) parts.push_back(part);
    };
    note(a.curve != b.curve, curve);
    note(a.flat != b.flat, flat);
    note(a.turn != b.turn, turn);
    note(a.axes != b.axes, axes);
    note(a.space != b.space, space);
    note(a.basis != b.basis, basis);
    note(a.frame != b.frame, frame);
    note(a.ignores_mirroring != b.ignores_mirroring, mirroring);
    return parts;
}

}  // namespace

ConventionFit find_convention(const Image& map, std::span<const KnownTexel> texels,
                              const ConventionSearch& search) {
    ConventionFit fit;
    fit.convention = search.stated;
    if (texels.empty()) return fit;
    Readings readings(map, texels, search);
    fit.expected_degrees = readings.expected();
    fit.given_degrees = readings.error(search.stated);
    fit.best_degrees = fit.given_degrees;
    const double fine = std::max(2.0 * fit.expected_degrees, fit.expected_degrees + sure_degrees);
    fit.was_searched = fit.given_degrees > fine;
    for (int round = 0; round < max_rounds && fit.best_degrees > fine; ++round) {
        MapConvention best = fit.convention;
        double min_degrees = fit.best_degrees;
        for (const MapConvention& one : neighbors_of(fit.convention)) {
            const double degrees = readings.error(one);
            if (degrees >= tie_ratio * min_degrees) continue;
            best = one;
            min_degrees = degrees;
        }
        if (min_degrees > max_remaining * fit.best_degrees) break;
        fit.convention = best;
        fit.best_degrees = min_degrees;
    }
    fit.tried = readings.tried;
    fit.changes = changes_between(search.stated, fit.convention);
    fit.is_explained = fit.was_searched && fit.best_degrees < fit.given_degrees / 2.0 &&
                       fit.given_degrees - fit.best_degrees > sure_degrees;
    return fit;
}

}  // namespace relief
