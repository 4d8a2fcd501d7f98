// SPDX-License-Identifier: Apache-2.0
// Compares baked maps with a reference bake of many samples, in strips of rows: the error of each
// texel in degrees, in the space of the meshes, and its causes. Several bakes can be compared with
// one reference, on bands spread over the map.
// Tests: tests/mesh/bake/bake_check_test.cpp, tests/accuracy/bake_accuracy_test.cpp.
#include "relief/mesh/bake_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "bake/texel_frame.h"
#include "geometry/direction.h"
#include "geometry/error_accumulator.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The normals of some rows of a bake.
struct NormalRows {
    std::span<const float> normals;
    std::span<const TexelState> states;

    [[nodiscard]] bool is_baked(std::size_t texel) const {
        return states[texel] == TexelState::baked;
    }
    [[nodiscard]] glm::dvec3 normal(std::size_t texel) const {
        return {normals[3 * texel], normals[3 * texel + 1], normals[3 * texel + 2]};
    }
};

/// The bake of some rows, with heights.
struct CastRows {
    std::vector<float> normals, heights;
    std::vector<TexelState> states;
    std::size_t rays = 0;

    [[nodiscard]] NormalRows rows() const { return {normals, states}; }
};

/// Bakes rows [first, last).
CastRows cast_rows(const Baker& baker, BakeMapOptions map, int first, int last, Report& report);

/// Normals encoded as map codes and decoded again.
std::vector<float> coded_normals(std::span<const float> normals, int width,
                                 const NormalMapFormat& format);

/// Sums of errors over texels.
struct CheckSums {
    ErrorAccumulator error, center, rebaked;
    std::array<ErrorAccumulator, bake_stage_count> stages;
    /// The part of each stage in the squared error vector.
    std::array<double, bake_stage_count> squares{};
    std::size_t missed = 0, frameless = 0, discontinuous = 0, outliers = 0, outliers_at_edges = 0;
    /// Squared angles between codes and normals, in tangent and in object space.
    double tangent_squares = 0.0, object_squares = 0.0;
    std::vector<WorstTexel> worst, worst_outliers;
    std::vector<KnownTexel> known;

    void add(const CheckSums& other);
};

/// Returns the options of the reference bake of a map. \param samples  0: the default of
/// BakeCheckOptions
BakeMapOptions reference_of(const BakeMapOptions& map, int samples);

/// The bakes for a check of some rows.
struct BakeCasts {
    CastRows reference;               ///< Many samples.
    CastRows center;                  ///< One sample, at the center of each texel.
    std::optional<CastRows> several;  ///< The number of samples of the map, if not one.

    /// \param report  gets the findings of the bake with the options of the map
    BakeCasts(const Baker& baker, const BakeMapOptions& map, int reference_samples, int first,
              int last, Report& report);

    [[nodiscard]] const CastRows& made() const { return several ? *several : center; }
    [[nodiscard]] std::size_t rays() const {
        return reference.rays + center.rays + (several ? several->rays : 0);
    }
};

/// Compares rows with the reference, in parallel.
/// \param made     the bake with the options of the map, which may be one of `casts`
/// \param remade   `made`, encoded and decoded
/// \param shown    the map, decoded; empty: `remade`
/// \param first    the first row
/// \param step     the distance, along and across, of texels stored in CheckSums::known; 0: none
/// \param degrees  gets the errors, NaN if there is none
CheckSums compare_rows(const Baker& baker, const BakeMapOptions& map, const BakeCasts& casts,
                       const NormalRows& made, std::span<const float> rebaked,
                       std::span<const float> shown, int first, int step, std::span<float> degrees);

constexpr double reference_angle = 0.5;  // In degrees.
constexpr int usual_max_samples = 256;   // Of a reference, unless the map has as many.
constexpr int max_samples = 1024;
constexpr std::size_t strip_texels = 1'000'000;
constexpr std::size_t known_texels = 16384;  // For the search of a convention.
constexpr std::size_t max_worst = 8;
/// A texel is torn if its mean height differs from that of its center by more than this share of
/// its width. A slope that changes by 45 degrees within a texel gives a sixth.
constexpr double torn_share = 0.25;

/// The input of a comparison of rows, from row `first` of the map on.
struct RowsToCheck {
    int first = 0;
    int width = 0;
    int height = 0;                       ///< The height of the map.
    std::vector<CoveredTexel> owners;     ///< The owners of texel centers.
    std::span<const float> map;           ///< Decoded, three values per texel.
    const CastRows* reference = nullptr;  ///< The bake of many samples.
    const CastRows* center = nullptr;     ///< The bake of one sample.
    NormalRows made;                 ///< The bake with the options of the map; may be `center`.
    std::span<const float> rebaked;  ///< `made`, encoded and decoded.
};

bool is_worse(const WorstTexel& a, const WorstTexel& b) {
    if (a.degrees != b.degrees) return a.degrees > b.degrees;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
}

void keep_worst(std::vector<WorstTexel>& worst, const WorstTexel& texel) {
    if (worst.size() == max_worst && !is_worse(texel, worst.back())) return;
    worst.insert(std::lower_bound(worst.begin(), worst.end(), texel, is_worse), texel);
    if (worst.size() > max_worst) worst.pop_back();
}

/// Transforms normals of a map to the axes of the meshes, at one texel.
class MapToMesh {
  public:
    MapToMesh(const Baker& baker, const CoveredTexel& owner)
        : mesh_(baker.low()), owner_(owner), options_(baker.options()) {
        if (options_.space != VectorSpace::tangent) {
            mesh_from_output_ = glm::inverse(options_.output_from_mesh);
            is_usable_ = std::isfinite(mesh_from_output_[0].x);
            return;
        }
        const TexelFrame frame(mesh_, owner.triangle, glm::dvec3(owner.weights()));
        is_usable_ = frame.is_usable();
        mesh_from_output_ = glm::dmat3(frame.tangent, frame.bitangent, frame.normal);
    }

    [[nodiscard]] bool is_usable() const { return is_usable_; }
    [[nodiscard]] glm::dvec3 shown(const glm::dvec3& normal) const {
        return direction_or_zero(mesh_from_output_ * normal);
    }
    /// Returns the interpolated normal of the low mesh.
    [[nodiscard]] glm::dvec3 low_normal() const {
        const glm::uvec3 corners = mesh_.triangles[owner_.triangle];
        glm::dvec3 sum(0.0);
        for (int i = 0; i < 3; ++i)
            sum += double{owner_.weights()[i]} * glm::dvec3(mesh_.normals[corners[i]]);
        return sum;
    }
    /// Returns the width of a texel on the mesh: the square root of its area.
    [[nodiscard]] double width_of_texel(double texels) const {
        const glm::uvec3 c = mesh_.triangles[owner_.triangle];
        const glm::dvec3 a(mesh_.positions[c.x]);
        const glm::dvec2 u(mesh_.texcoords[c.x]);
        const glm::dvec2 e(glm::dvec2(mesh_.texcoords[c.y]) - u);
        const glm::dvec2 f(glm::dvec2(mesh_.texcoords[c.z]) - u);
        const double area = glm::length(
            glm::cross(glm::dvec3(mesh_.positions[c.y]) - a, glm::dvec3(mesh_.positions[c.z]) - a));
        return std::sqrt(area / (std::abs(e.x * f.y - e.y * f.x) * texels));
    }

  private:
    const Mesh& mesh_;
    const CoveredTexel& owner_;
    const BakeOptions& options_;
    glm::dmat3 mesh_from_output_{1.0};
    bool is_usable_ = true;
};

glm::dvec3 at(std::span<const float> normals, std::size_t texel) {
    return {normals[3 * texel], normals[3 * texel + 1], normals[3 * texel + 2]};
}

/// Compares single texels.
class TexelCheck {
  public:
    TexelCheck(const Baker& baker, const RowsToCheck& rows, int step)
        : baker_(baker), rows_(rows), step_(step) {}

    double check(std::size_t texel, CheckSums& sums) const {
        const double none = std::numeric_limits<double>::quiet_NaN();
        const CoveredTexel& owner = rows_.owners[texel];
        if (!owner.is_covered()) return none;
        if (!rows_.reference->rows().is_baked(texel)) {
            ++sums.missed;
            return none;
        }
        const MapToMesh to_mesh(baker_, owner);
        if (!to_mesh.is_usable()) {
            ++sums.frameless;
            return none;
        }
        const glm::dvec3 reference = to_mesh.shown(rows_.reference->rows().normal(texel));
        const glm::dvec3 shown = to_mesh.shown(at(rows_.map, texel));
        if (rows_.center->rows().is_baked(texel)) {
            sums.center.add(
                degrees_between(shown, to_mesh.shown(rows_.center->rows().normal(texel))));
        }
        const double degrees = degrees_between(shown, reference);
        sums.error.add(degrees);
        const bool is_discontinuous = tears(texel, to_mesh, reference);
        keep_worst(sums.worst, {column(texel), row(texel), degrees, is_discontinuous});
        split(texel, to_mesh, reference, shown, is_discontinuous, sums);
        return degrees;
    }

  private:
    [[nodiscard]] int column(std::size_t texel) const {
        return static_cast<int>(texel % static_cast<std::size_t>(rows_.width));
    }
    [[nodiscard]] int row(std::size_t texel) const {
        return rows_.first + static_cast<int>(texel / static_cast<std::size_t>(rows_.width));
    }

    [[nodiscard]] bool tears(std::size_t texel, const MapToMesh& to_mesh,
                             const glm::dvec3& reference) const {
        if (!rows_.center->rows().is_baked(texel)) return true;
        const double jump = std::abs(double{rows_.reference->heights[texel]} -
                                     double{rows_.center->heights[texel]});
        const double texels = static_cast<double>(rows_.width) * rows_.height;
        return jump > torn_share * to_mesh.width_of_texel(texels) ||
               glm::dot(reference, to_mesh.low_normal()) < 0.0;
    }

    /// Attributes the error to pipeline stages.
    void split(std::size_t texel, const MapToMesh& to_mesh, const glm::dvec3& reference,
               const glm::dvec3& shown, bool is_discontinuous, CheckSums& sums) const {
        const auto stage = [](BakeStage s) { return static_cast<std::size_t>(s); };
        const glm::dvec3 whole = shown - reference;
        const bool is_made = rows_.made.is_baked(texel);
        const glm::dvec3 recoded = at(rows_.rebaked, texel);
        const glm::dvec3 rebaked = to_mesh.shown(recoded);
        if (is_made) sums.rebaked.add(degrees_between(rebaked, reference));
        if (is_discontinuous || !is_made) {
            ++sums.discontinuous;
            sums.stages[stage(BakeStage::projection)].add(degrees_between(shown, reference));
            sums.squares[stage(BakeStage::projection)] += glm::dot(whole, whole);
            return;
        }
        const glm::dvec3 made = to_mesh.shown(rows_.made.normal(texel));
        const double in_map = degrees_between(recoded, rows_.made.normal(texel));
        const double in_object = degrees_between(rebaked, made);
        sums.stages[stage(BakeStage::sampling)].add(degrees_between(made, reference));
        sums.stages[stage(BakeStage::quantization)].add(in_map);
        const double other = degrees_between(shown, rebaked);
        sums.stages[stage(BakeStage::other)].add(other);
        if (other > outlier_degrees) add_outlier(texel, other, sums);
        sums.tangent_squares += in_map * in_map;
        sums.object_squares += in_object * in_object;
        sums.squares[stage(BakeStage::sampling)] += glm::dot(made - reference, whole);
        sums.squares[stage(BakeStage::quantization)] += glm::dot(rebaked - made, whole);
        sums.squares[stage(BakeStage::other)] += glm::dot(shown - rebaked, whole);
        // Conventions are compared at texels where sampling has no influence.
        keep_known(texel, made, in_object, sums);
    }

    void add_outlier(std::size_t texel, double degrees, CheckSums& sums) const {
        ++sums.outliers;
        if (is_at_edge(texel)) ++sums.outliers_at_edges;
        keep_worst(sums.worst_outliers, {column(texel), row(texel), degrees, false});
    }

    /// Returns whether a texel is at most two texels from the border of a chart or of the map, or
    /// from a texel that is missed or torn. Rows beyond the strip are not known.
    [[nodiscard]] bool is_at_edge(std::size_t texel) const {
        constexpr int radius = 2;
        const int x = column(texel), y = row(texel) - rows_.first;
        if (x < radius || x + radius >= rows_.width || row(texel) < radius ||
            row(texel) + radius >= rows_.height)
            return true;
        const int rows = static_cast<int>(rows_.owners.size()) / rows_.width;
        for (int v = std::max(y - radius, 0); v <= std::min(y + radius, rows - 1); ++v) {
            for (int u = x - radius; u <= x + radius; ++u) {
                const auto near =
                    static_cast<std::size_t>(v) * static_cast<std::size_t>(rows_.width) +
                    static_cast<std::size_t>(u);
                if (is_edge(near)) return true;
            }
        }
        return false;
    }

    [[nodiscard]] bool is_edge(std::size_t texel) const {
        const CoveredTexel& owner = rows_.owners[texel];
        if (!owner.is_covered() || !rows_.reference->rows().is_baked(texel)) return true;
        const MapToMesh to_mesh(baker_, owner);
        return !to_mesh.is_usable() ||
               tears(texel, to_mesh, to_mesh.shown(rows_.reference->rows().normal(texel)));
    }

    void keep_known(std::size_t texel, const glm::dvec3& reference, double expected,
                    CheckSums& sums) const {
        if (step_ == 0 || row(texel) % step_ != step_ / 2 || column(texel) % step_ != step_ / 2)
            return;
        const CoveredTexel& owner = rows_.owners[texel];
        sums.known.push_back({column(texel), row(texel), owner.triangle,
                              glm::dvec3(owner.weights()), reference, expected});
    }

    const Baker& baker_;
    const RowsToCheck& rows_;
    int step_;
};

BakeMapOptions with_samples(BakeMapOptions map, int samples, std::optional<double> angle) {
    map.samples = samples;
    map.sample_angle = angle;
    return map;
}

std::vector<CoveredTexel> owners_of(const Baker& baker, const BakeMapOptions& map, int first,
                                    int last) {
    CoverageOptions options;
    options.width = map.width;
    options.height = map.height;
    options.tile = map.placement.tile;
    options.repeat = map.placement.repeat;
    options.only = map.triangles;
    const auto width = static_cast<std::size_t>(map.width);
    std::vector<CoveredTexel> owners(width * static_cast<std::size_t>(last - first));
    Report ignored;
    const TexelRasterizer cover(baker.low().texcoords, baker.low().triangles, options, ignored);
    cover.cover(
        first, last,
        [&](int row, std::span<const CoveredTexel> texels) {
            std::copy(texels.begin(), texels.end(),
                      owners.begin() + static_cast<std::ptrdiff_t>(
                                           width * static_cast<std::size_t>(row - first)));
        },
        ignored);
    return owners;
}

CheckSums check_texels(const Baker& baker, const RowsToCheck& rows, int step,
                       std::span<float> degrees) {
    const auto width = static_cast<std::size_t>(rows.width);
    const std::size_t count = degrees.size() / width;
    constexpr std::size_t piece = 16;  // Rows; each piece has its own histograms.
    std::vector<CheckSums> sums((count + piece - 1) / piece);
    const TexelCheck texels(baker, rows, step);
    parallel_for(sums.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t part = begin; part < end; ++part) {
            const std::size_t last = std::min((part + 1) * piece, count) * width;
            for (std::size_t texel = part * piece * width; texel < last; ++texel)
                degrees[texel] = static_cast<float>(texels.check(texel, sums[part]));
        }
    });
    CheckSums all;
    for (const CheckSums& part : sums)
        all.add(part);
    return all;
}

int check_strip_rows(int width) {
    const auto max_rows = static_cast<int>(strip_texels / static_cast<std::size_t>(width));
    return std::max(max_rows / TexelRasterizer::band_rows, 1) * TexelRasterizer::band_rows;
}

/// Rows of an image, in the same format.
Image part_of(const Image& map, int first, int last) {
    Image part;
    part.width = map.width;
    part.height = last - first;
    part.channels = map.channels;
    part.color_space = ColorSpace::data;
    const std::size_t row =
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.channels);
    std::visit(
        [&](const auto& samples) {
            part.samples = std::decay_t<decltype(samples)>(
                samples.begin() +
                    static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(first)),
                samples.begin() +
                    static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(last)));
        },
        map.samples);
    return part;
}

void check(const Image& map, const BakeMapOptions& options) {
    if (map.channels < 3)
        throw InvalidInput(
            fmt::format("the map has {} channels, but normals need 3", map.channels));
    if (map.width != options.width || map.height != options.height) {
        throw InvalidInput(fmt::format("the map is of {} x {} texels, not {} x {}", map.width,
                                       map.height, options.width, options.height));
    }
}

void summarize(const CheckSums& sums, BakeCheck& check) {
    check.error = sums.error.stats();
    check.center = sums.center.stats();
    check.rebaked = sums.rebaked.stats();
    check.missed = sums.missed;
    check.frameless = sums.frameless;
    check.discontinuous = sums.discontinuous;
    check.worst = sums.worst;
    check.outliers = sums.outliers;
    check.outliers_at_edges = sums.outliers_at_edges;
    check.worst_outliers = sums.worst_outliers;
    double all = 0.0;
    for (const double squares : sums.squares)
        all += squares;
    const auto index = [](BakeStage stage) { return static_cast<std::size_t>(stage); };
    for (std::size_t i = 0; i < bake_stage_count; ++i) {
        check.stages[i].error = sums.stages[i].stats();
        check.stages[i].fraction = all > 0.0 ? sums.squares[i] / all : 0.0;
    }
    // The error of the codes in object space minus that in tangent space is the error of the basis.
    StageError& codes = check.stages[index(BakeStage::quantization)];
    StageError& basis = check.stages[index(BakeStage::basis)];
    const double texels = static_cast<double>(codes.error.count);
    const double more = sums.object_squares - sums.tangent_squares;
    if (!(more > 0.0)) return;
    // This is the difference of two mean squares, not a mean of angles.
    basis.error.rms = std::sqrt(more / texels);
    basis.fraction = codes.fraction * more / sums.object_squares;
    codes.fraction -= basis.fraction;
}

/// Returns the distance of the texels that the search of a convention uses.
int search_step(const BakeMapOptions& map) {
    const double texels = static_cast<double>(map.width) * map.height;
    return std::max(static_cast<int>(std::sqrt(texels / known_texels)), 1);
}

ConventionFit convention_of(const Baker& baker, const Image& map, const BakeCheckOptions& options,
                            const std::vector<KnownTexel>& known) {
    ConventionSearch search;
    search.low = &baker.low();
    search.given = options.given;
    search.green = options.format.green;
    search.stated.flat = options.format.flat;
    search.object_from_mesh = options.object_from_mesh;
    search.stated.space = baker.options().space;
    return find_convention(map, known, search);
}

void CheckSums::add(const CheckSums& other) {
    error.add(other.error);
    center.add(other.center);
    rebaked.add(other.rebaked);
    for (std::size_t i = 0; i < stages.size(); ++i) {
        stages[i].add(other.stages[i]);
        squares[i] += other.squares[i];
    }
    missed += other.missed;
    frameless += other.frameless;
    discontinuous += other.discontinuous;
    tangent_squares += other.tangent_squares;
    object_squares += other.object_squares;
    outliers += other.outliers;
    outliers_at_edges += other.outliers_at_edges;
    for (const WorstTexel& texel : other.worst)
        keep_worst(worst, texel);
    for (const WorstTexel& texel : other.worst_outliers)
        keep_worst(worst_outliers, texel);
    known.insert(known.end(), other.known.begin(), other.known.end());
}

CastRows cast_rows(const Baker& baker, BakeMapOptions map, int first, int last, Report& report) {
    map.rows = BakeRowRange{first, last};
    map.padding = 0;
    map.border_folder.reset();
    map.layers = {.heights = true};
    CastRows cast;
    const auto take = [&](const BakedRows& rows) {
        cast.normals.insert(cast.normals.end(), rows.normals.begin(), rows.normals.end());
        cast.heights.insert(cast.heights.end(), rows.heights.begin(), rows.heights.end());
        cast.states.insert(cast.states.end(), rows.states.begin(), rows.states.end());
    };
    cast.rays = baker.bake(map, take, report).rays;
    return cast;
}

std::vector<float> coded_normals(std::span<const float> normals, int width,
                                 const NormalMapFormat& format) {
    Image image;
    image.width = width;
    image.height = static_cast<int>(normals.size() / (3 * static_cast<std::size_t>(width)));
    image.channels = 3;
    image.samples = std::vector<float>(normals.begin(), normals.end());
    Report ignored;  // Unit normals cause no findings.
    const Image decoded = decode_normal_map(encode_normal_map(image, format, ignored), format.green,
                                            format.flat, ignored);
    return std::get<std::vector<float>>(decoded.samples);
}

BakeMapOptions reference_of(const BakeMapOptions& map, int samples) {
    const int default_count = map.samples < usual_max_samples
                                  ? std::min(16 * map.samples, usual_max_samples)
                                  : max_samples;
    int count = samples > 0 ? samples : default_count;
    // Texel coverage limits the number of samples of large maps.
    const int longest = std::max(map.width, map.height);
    while (count > 4 &&
           std::sqrt(count) * longest > static_cast<double>(TexelRasterizer::largest_side))
        count /= 4;
    return with_samples(map, count, reference_angle * std::numbers::pi / 180.0);
}

BakeCasts::BakeCasts(const Baker& baker, const BakeMapOptions& map, int reference_samples,
                     int first, int last, Report& report) {
    Report ignored;
    center = cast_rows(baker, with_samples(map, 1, std::nullopt), first, last,
                       map.samples == 1 ? report : ignored);
    reference = cast_rows(baker, reference_of(map, reference_samples), first, last, ignored);
    if (map.samples > 1) several = cast_rows(baker, map, first, last, report);
}

CheckSums compare_rows(const Baker& baker, const BakeMapOptions& map, const BakeCasts& casts,
                       const NormalRows& made, std::span<const float> rebaked,
                       std::span<const float> shown, int first, int step,
                       std::span<float> degrees) {
    const auto count = static_cast<int>(degrees.size() / static_cast<std::size_t>(map.width));
    RowsToCheck rows;
    rows.first = first;
    rows.width = map.width;
    rows.height = map.height;
    rows.owners = owners_of(baker, map, first, first + count);
    rows.reference = &casts.reference;
    rows.center = &casts.center;
    rows.made = made;
    rows.rebaked = rebaked;
    rows.map = shown.empty() ? rebaked : shown;
    return check_texels(baker, rows, step, degrees);
}

}  // namespace

BakeCheck check_bake(const Baker& baker, const Image& map, const BakeCheckOptions& options,
                     const std::function<void(int first_row, std::span<const float> degrees)>& take,
                     Report& report) {
    check(map, options.map);
    NormalMapFormat format = options.format;
    format.bits = map.bits();
    BakeCheck result;
    result.reference_samples = reference_of(options.map, options.reference_samples).samples;
    const int step = options.finds_convention ? search_step(options.map) : 0;
    const int rows = check_strip_rows(map.width);
    CheckSums sums;
    for (int first = 0; first < map.height; first += rows) {
        const int last = std::min(first + rows, map.height);
        const Image shown =
            decode_normal_map(part_of(map, first, last), format.green, format.flat, report);
        const BakeCasts casts(baker, options.map, options.reference_samples, first, last, report);
        std::vector<float> degrees(static_cast<std::size_t>(map.width) *
                                   static_cast<std::size_t>(last - first));
        const std::vector<float> rebaked = coded_normals(casts.made().normals, map.width, format);
        sums.add(compare_rows(baker, options.map, casts, casts.made().rows(), rebaked,
                              shown.as<float>(), first, step, degrees));
        result.rays += casts.rays();
        if (take) take(first, degrees);
    }
    summarize(sums, result);
    if (options.finds_convention)
        result.convention = convention_of(baker, map, options, sums.known);
    return result;
}

namespace {

/// Rows with their reference.
struct Band {
    BakeRowRange rows;
    BakeCasts casts;
};

}  // namespace

struct BakeReference::Implementation {
    const Baker& baker;
    BakeMapOptions map;  ///< With one sample.
    int samples = 0;
    std::vector<Band> bands;
    bool is_whole = true;

    [[nodiscard]] std::size_t texels_of(const Band& band) const {
        return static_cast<std::size_t>(map.width) *
               static_cast<std::size_t>(band.rows.last - band.rows.first);
    }
};

BakeReference::BakeReference(const Baker& baker, const BakeMapOptions& map, std::size_t texels,
                             int samples)
    : implementation_(new Implementation{baker, with_samples(map, 1, std::nullopt), 0, {}, true}) {
    Implementation& data = *implementation_;
    data.samples = reference_of(map, samples > 0 ? samples : 256).samples;
    constexpr int band = TexelRasterizer::band_rows;
    const int bands = (map.height + band - 1) / band;
    const std::size_t band_texels =
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(band);
    const auto count =
        static_cast<int>(std::min(texels / band_texels + 1, static_cast<std::size_t>(bands)));
    data.is_whole = count == bands;
    Report ignored;
    for (int i = 0; i < count; ++i) {
        // The middle band of each of `count` equal parts.
        const int first = (2 * i + 1) * bands / (2 * count) * band;
        const BakeRowRange rows{first, std::min(first + band, map.height)};
        data.bands.push_back(
            {rows, BakeCasts(baker, data.map, data.samples, rows.first, rows.last, ignored)});
    }
}

BakeReference::~BakeReference() = default;

BakedTexels BakeReference::bake(int samples, std::optional<double> sample_angle) const {
    const Implementation& data = *implementation_;
    BakedTexels all;
    Report ignored;
    for (const Band& band : data.bands) {
        const CastRows part = cast_rows(data.baker, with_samples(data.map, samples, sample_angle),
                                        band.rows.first, band.rows.last, ignored);
        all.normals.insert(all.normals.end(), part.normals.begin(), part.normals.end());
        all.states.insert(all.states.end(), part.states.begin(), part.states.end());
        all.rays += part.rays;
    }
    return all;
}

std::vector<float> BakeReference::coded(const BakedTexels& bake,
                                        const NormalMapFormat& format) const {
    const Implementation& data = *implementation_;
    std::vector<float> all;
    all.reserve(bake.normals.size());
    std::span<const float> left = bake.normals;
    for (const Band& band : data.bands) {
        const std::size_t values = 3 * data.texels_of(band);
        const std::vector<float> part = coded_normals(left.first(values), data.map.width, format);
        all.insert(all.end(), part.begin(), part.end());
        left = left.subspan(values);
    }
    return all;
}

BakeCheck BakeReference::compare(const BakedTexels& bake, std::span<const float> coded,
                                 std::span<float> degrees) const {
    const Implementation& data = *implementation_;
    BakeCheck result;
    result.reference_samples = data.samples;
    result.rays = bake.rays;
    CheckSums sums;
    std::size_t first = 0;
    for (const Band& band : data.bands) {
        const std::size_t count = data.texels_of(band);
        const NormalRows made = {std::span(bake.normals).subspan(3 * first, 3 * count),
                                 std::span(bake.states).subspan(first, count)};
        sums.add(compare_rows(data.baker, data.map, band.casts, made,
                              coded.subspan(3 * first, 3 * count), {}, band.rows.first, 0,
                              degrees.subspan(first, count)));
        first += count;
    }
    summarize(sums, result);
    return result;
}

int BakeReference::width() const {
    return implementation_->map.width;
}

std::size_t BakeReference::texels() const {
    std::size_t sum = 0;
    for (const Band& band : implementation_->bands)
        sum += implementation_->texels_of(band);
    return sum;
}

bool BakeReference::is_whole() const {
    return implementation_->is_whole;
}

int BakeReference::samples() const {
    return implementation_->samples;
}

std::size_t BakeReference::rays() const {
    std::size_t sum = 0;
    for (const Band& band : implementation_->bands)
        sum += band.casts.reference.rays;
    return sum;
}

}  // namespace relief
