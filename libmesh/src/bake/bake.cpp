// SPDX-License-Identifier: Apache-2.0
// Bakes maps of high-poly meshes for a low-poly mesh: positions and ray directions of texels,
// checks of options, parts, and strips of the map. Tests: tests/mesh/bake/bake_test.cpp,
// baker_test.cpp, padding_test.cpp.
#include "relief/mesh/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <set>

#include "bake/bake_work.h"
#include "bake/layers.h"
#include "bake/map_rows.h"
#include "geometry/direction.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

std::vector<glm::vec3> cage_corners(const Mesh& cage, const Mesh& low) {
    validate(cage);
    if (cage.triangles.size() != low.triangles.size()) {
        throw InvalidInput(fmt::format("the cage has {} triangles, not {} as the low mesh",
                                       cage.triangles.size(), low.triangles.size()));
    }
    std::vector<glm::vec3> positions;
    positions.reserve(3 * cage.triangles.size());
    for (const glm::uvec3& triangle : cage.triangles) {
        for (int i = 0; i < 3; ++i)
            positions.push_back(cage.positions[triangle[i]]);
    }
    return positions;
}

/// Returns the ray directions by vertex: smoothed normals (hard edges ignored), blended with the
/// vertex normals by the hardness. Empty for face normals.
std::vector<glm::vec3> ray_directions(const Mesh& mesh, const BakeOptions& options) {
    if (options.directions == RayDirections::face) return {};
    if (options.directions == RayDirections::shading) return mesh.normals;
    Report ignored;  // Frames and rays report defects of triangles.
    std::vector<glm::vec3> directions =
        vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, ignored);
    if (options.hardness == 0.0) return directions;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        directions[i] = rounded(direction_or_zero(
            glm::mix(glm::dvec3(directions[i]), glm::dvec3(mesh.normals[i]), options.hardness)));
    }
    return directions;
}

double sum(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

/// Returns the inverse of the height of each corner above its opposite edge.
glm::dvec3 inverse_heights(const Mesh& mesh, const glm::uvec3& corners) {
    const glm::dvec3 a(mesh.positions[corners.x]);
    const glm::dvec3 b(mesh.positions[corners.y]);
    const glm::dvec3 c(mesh.positions[corners.z]);
    const double twice_area = glm::length(glm::cross(b - a, c - a));
    return glm::dvec3(glm::distance(b, c), glm::distance(c, a), glm::distance(a, b)) / twice_area;
}

}  // namespace

LowSurface::LowSurface(const Mesh& low, const BakeOptions& options, Report& report) {
    validate(low);
    if (low.texcoords.empty()) throw InvalidInput("the low mesh has no texture coordinates");
    const bool to_tangent =
        options.space == VectorSpace::tangent &&
        (options.map.layers.normals || options.map.layers.bent_normals || options.map.sample_angle);
    FrameOptions frames;
    frames.tangents = !to_tangent            ? TangentMethod::none
                      : low.tangents.empty() ? TangentMethod::mikktspace
                                             : TangentMethod::keep;
    mesh_ = with_frames(low, frames, report).mesh;
    if (options.cage != nullptr) {
        cage_ = cage_corners(*options.cage, low);
        cage_inside_ = options.max_distance;
    } else {
        directions_ = ray_directions(mesh_, options);
    }
}

double LowSurface::cage_reach() const {
    double reach = 0.0;
    for (std::size_t i = 0; i < cage_.size(); ++i) {
        const std::uint32_t vertex = mesh_.triangles[i / 3][static_cast<int>(i % 3)];
        const double here =
            glm::distance(glm::dvec3(cage_[i]), glm::dvec3(mesh_.positions[vertex]));
        if (std::isfinite(here)) reach = std::max(reach, here);
    }
    return reach;
}

glm::dvec3 LowSurface::interpolated(std::span<const glm::vec3> values,
                                    const CoveredTexel& texel) const {
    const glm::uvec3 corners = mesh_.triangles[texel.triangle];
    const glm::dvec3 weights(texel.weights());
    return weights.x * glm::dvec3(values[corners.x]) + weights.y * glm::dvec3(values[corners.y]) +
           weights.z * glm::dvec3(values[corners.z]);
}

glm::dvec3 LowSurface::direction(const CoveredTexel& texel, std::size_t sample,
                                 Report& report) const {
    if (!directions_.empty()) {
        const glm::dvec3 outward = direction_or_zero(interpolated(directions_, texel));
        if (outward != glm::dvec3(0.0)) return outward;
        report.add("ray without a direction", "texel", sample, "runs along its triangle's normal");
    }
    const glm::uvec3 corners = mesh_.triangles[texel.triangle];
    const glm::dvec3 a(mesh_.positions[corners.x]);
    return direction_or_zero(glm::cross(glm::dvec3(mesh_.positions[corners.y]) - a,
                                        glm::dvec3(mesh_.positions[corners.z]) - a));
}

ProjectionLine LowSurface::line(const CoveredTexel& texel, const BakeDistances& distances,
                                std::size_t sample, Report& report) const {
    ProjectionLine line;
    line.point = interpolated(mesh_.positions, texel);
    line.outside = distances.offset;
    line.inside = distances.max_distance;
    if (has_cage()) {
        const glm::dvec3 weights(texel.weights());
        glm::dvec3 start(0.0);
        for (int i = 0; i < 3; ++i) {
            start +=
                weights[i] *
                glm::dvec3(cage_[3 * std::size_t{texel.triangle} + static_cast<std::size_t>(i)]);
        }
        line.outside = glm::distance(start, line.point);
        line.inside = cage_inside_.value_or(line.outside);
        line.outward = direction_or_zero(start - line.point);
    } else {
        line.outward = direction(texel, sample, report);
    }
    // A line without a direction, or that is not finite, gets a negative length.
    if (!(glm::length(line.outward) > 0.5) || !is_finite(line.point)) {
        report.add("sample without a ray", "texel", sample, "missed");
        line = {glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0), -1.0, 0.0};
    }
    return line;
}

std::optional<CoveredTexel> detail::moved_inside(const Mesh& mesh, const CoveredTexel& texel,
                                                 double distance) {
    const glm::dvec3 weights(texel.weights());
    glm::dvec3 least = distance * inverse_heights(mesh, mesh.triangles[texel.triangle]);
    if (!std::isfinite(sum(least))) return std::nullopt;
    if (glm::all(glm::greaterThanEqual(weights, least))) return std::nullopt;
    // The distance from an edge is the weight of the opposite corner times that corner's height.
    // Weights that are too small are raised; the others give in proportion to their excess.
    glm::dvec3 moved;
    if (sum(least) >= 1.0) {
        moved = least / sum(least);  // Proportional to the lengths of the edges: the incenter.
    } else {
        const glm::dvec3 excess = glm::max(weights - least, glm::dvec3(0.0));
        moved = least + excess * ((1.0 - sum(least)) / sum(excess));
    }
    CoveredTexel result = texel;
    result.second = static_cast<float>(moved.y);
    result.third = static_cast<float>(moved.z);
    return result;
}

namespace {

/// The largest gap between the boxes that measured ray lengths bridge, relative to the diagonal of
/// the low box. A larger gap indicates a misplaced mesh.
constexpr double max_automatic_share = 0.5;

BakeDistances ray_distances(std::span<const Mesh> high, const HighSurface& surface, const Mesh& low,
                            const BakeOptions& options) {
    const bool all_given = options.cage != nullptr || (options.offset && options.max_distance);
    BakeDistances distances;
    if (!all_given) distances = distances_between(high, surface.scene(), low);
    distances.offset = options.offset.value_or(distances.offset);
    distances.max_distance = options.max_distance.value_or(distances.max_distance);
    return distances;
}

/// Returns the maximum distance of rays from the low mesh.
double ray_reach(const BakeOptions& options, double cage_reach, double low_diagonal) {
    if (options.cage != nullptr)
        return std::max(cage_reach, options.max_distance.value_or(cage_reach));
    const double automatic = max_automatic_share * low_diagonal;
    return std::max(options.offset.value_or(automatic), options.max_distance.value_or(automatic));
}

/// Checks the boxes before the ray scene is built. \return the diagonal of the box around both
double checked_extent(const BakeFit& fit, std::span<const Mesh> high, const BakeOptions& options,
                      double cage_reach, const std::string& name, Report& report) {
    if (fit.low.empty()) return 0.0;
    if (fit.high.empty()) {
        // A part may have no high mesh.
        if (high.empty()) return 0.0;
        throw BakeMismatch(BakeMismatch::Kind::no_surface, fit, 0.0, name);
    }
    const double reach = ray_reach(options, cage_reach, diagonal(fit.low));
    if (fit.differs_in_size() && !options.allow_size_mismatch)
        throw BakeMismatch(BakeMismatch::Kind::size, fit, reach, name);
    if (fit.gap > reach) throw BakeMismatch(BakeMismatch::Kind::apart, fit, reach, name);
    if (fit.fits_rotated) {
        report.add("high box that fits only with y and z swapped", "part", 0,
                   "baked as it is: one side may be Y up, the other Z up");
    }
    return glm::distance(glm::max(glm::dvec3(fit.high.max), glm::dvec3(fit.low.max)),
                         glm::min(glm::dvec3(fit.high.min), glm::dvec3(fit.low.min)));
}

std::vector<std::uint32_t> parts_of_triangles(std::span<const BakePart> parts, const Mesh& low) {
    constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint32_t> result(low.triangles.size(), none);
    for (std::size_t part = 0; part < parts.size(); ++part) {
        for (const std::uint32_t triangle : parts[part].triangles) {
            if (triangle >= result.size() || result[triangle] != none) {
                throw InvalidInput(
                    fmt::format("triangle {} of the low mesh is {}", triangle,
                                triangle < result.size() ? "in two parts" : "not there"));
            }
            result[triangle] = static_cast<std::uint32_t>(part);
        }
    }
    const auto unassigned = std::find(result.begin(), result.end(), none);
    if (unassigned != result.end()) {
        throw InvalidInput(
            fmt::format("triangle {} of the low mesh is in no part", unassigned - result.begin()));
    }
    return result;
}

int samples_across(int samples) {
    for (const int side : {1, 2, 4, 8, 16, 32}) {
        if (side * side == samples) return side;
    }
    throw InvalidInput(
        fmt::format("the number of samples is {}, but must be 1, 4, 16, 64, 256 or 1024", samples));
}

void check_distance(const std::optional<double>& distance, const char* what) {
    if (distance && !(*distance >= 0.0 && std::isfinite(*distance)))
        throw InvalidInput(
            fmt::format("{} is {}, but must be finite and at least 0", what, *distance));
}

void check_surfaces(const BakeOptions& options) {
    check_distance(options.offset, "the offset");
    check_distance(options.max_distance, "the maximum distance");
    if (!(options.hardness >= 0.0 && options.hardness <= 1.0))
        throw InvalidInput(
            fmt::format("the hardness is {}, but must be within [0, 1]", options.hardness));
}

void check_triangle_numbers(std::span<const std::uint32_t> numbers, std::size_t count) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (numbers[i] >= count)
            throw InvalidInput(fmt::format("there is no triangle {} in the low mesh", numbers[i]));
        if (i > 0 && numbers[i] <= numbers[i - 1])
            throw InvalidInput("the triangles of a map are not in ascending order");
    }
}

void check_rows(const BakeRowRange& rows, const BakeMapOptions& map) {
    const bool ends_well = rows.last == map.height || rows.last % TexelRasterizer::band_rows == 0;
    if (rows.first < 0 || rows.first % TexelRasterizer::band_rows != 0 || rows.last <= rows.first ||
        rows.last > map.height || !ends_well) {
        throw InvalidInput(
            fmt::format("rows {} to {} must be multiples of {} within a map of {} rows", rows.first,
                        rows.last, TexelRasterizer::band_rows, map.height));
    }
    if (map.padding > 0)
        throw InvalidInput("padding needs all rows of a map, but only some are baked");
}

void check_shard_rows(const BakeRowRange& rows, const BakeMapOptions& map) {
    constexpr int step = 4;  // Blocks of samples of other rows are then the same.
    if (map.rows) throw InvalidInput("a shard has its own rows, but the map has some, too");
    if (rows.first < 0 || rows.first % step != 0 || rows.last <= rows.first ||
        rows.last > map.height || (rows.last % step != 0 && rows.last != map.height)) {
        throw InvalidInput(
            fmt::format("rows {} to {} must be multiples of {} within a map of {} rows", rows.first,
                        rows.last, step, map.height));
    }
}

void check_map(const BakeMapOptions& map, const Mesh& low) {
    const int side = samples_across(map.samples);
    // The limit of texel coverage applies to samples.
    for (const int texels : {map.width, map.height}) {
        if (texels < 1 || texels > TexelRasterizer::largest_side / side) {
            throw InvalidInput(fmt::format(
                "the map has {} x {} texels of {} samples, but must have 1 to {} texels along each "
                "side",
                map.width, map.height, map.samples, TexelRasterizer::largest_side / side));
        }
    }
    check_padding(map);
    if (map.sample_angle && !(*map.sample_angle >= 0.0 && *map.sample_angle <= std::numbers::pi))
        throw InvalidInput(
            fmt::format("the angle is {}, but must be within [0, pi]", *map.sample_angle));
    if (map.rows) check_rows(*map.rows, map);
    if (map.triangles) check_triangle_numbers(*map.triangles, low.triangles.size());
}

void check_layers(const BakeLayers& requested, const BakeLayers& prepared) {
    if ((requested.normals && !prepared.normals) || (requested.curvature && !prepared.curvature) ||
        (requested.colors && !prepared.colors) || (requested.opacity && !prepared.opacity) ||
        (requested.surface && !prepared.surface) || (requested.emission && !prepared.emission) ||
        (requested.bent_normals && !prepared.bent_normals) || (requested.ids && !prepared.ids))
        throw InvalidInput("a map requests a layer that its Baker does not have");
    check(requested);
}

CoverageOptions coverage_options(const BakeMapOptions& map, int side) {
    CoverageOptions coverage;
    coverage.width = map.width * side;
    coverage.height = map.height * side;
    coverage.samples_across = side;
    coverage.tile = map.placement.tile;
    coverage.repeat = map.placement.repeat;
    coverage.only = map.triangles;
    return coverage;
}

/// Bakes the rows of a shard, strip by strip.
class ShardBake {
  public:
    /// \param work  must outlive this object
    ShardBake(const BakeWork& work, const Mesh& low, const BakeRowRange& rows)
        : work_(work),
          side_(work.side),
          shard_{.rows = rows},
          cover_(low.texcoords, low.triangles, coverage_options(work.map, work.side),
                 rows.first == 0 ? shard_.triangles : ignored_),
          stage_("baking", static_cast<std::size_t>(rows.last - rows.first)) {}

    /// Bakes rows [first, last) into a strip.
    void bake(Strip& strip, int first, int last) {
        constexpr int band = TexelRasterizer::band_rows;
        const int begin = first * side_;
        const int end = last * side_;
        const int map_end = work_.map.height * side_;
        const int first_whole = (begin + band - 1) / band * band;
        // A band counts where its first row is.
        Report ignored;
        if (begin < first_whole) {
            cover(strip, first, last, first_whole - band, std::min(first_whole, map_end), ignored);
        }
        if (first_whole < end) {
            const int last_whole = std::min((end + band - 1) / band * band, map_end);
            shard_.coverage += cover(strip, first, last, first_whole, last_whole, shard_.texels);
        }
        for (const auto& [row, report] : reports_)
            shard_.rays.merge(report);
        reports_.clear();
    }

    BakeShard finish() { return std::move(shard_); }

  private:
    /// Covers bands of sample rows, and bakes those of their rows that are in the strip.
    Coverage cover(Strip& strip, int first, int last, int begin, int end, Report& report) {
        const auto row_samples =
            static_cast<std::size_t>(work_.map.width) * static_cast<std::size_t>(side_ * side_);
        const auto take = [&](int first_sample_row, std::span<const CoveredTexel> owners) {
            const int band_first = first_sample_row / side_;
            const int band_last = band_first + static_cast<int>(owners.size() / row_samples);
            const int from = std::max(band_first, first);
            const int to = std::min(band_last, last);
            if (from >= to) return;
            bake_band(strip.rows(work_.map.width, from, from - first, to - from), from,
                      owners.subspan(static_cast<std::size_t>(from - band_first) * row_samples,
                                     static_cast<std::size_t>(to - from) * row_samples));
        };
        return cover_.cover(begin, end, take, report);
    }

    void bake_band(const BakedRows& rows, int row, std::span<const CoveredTexel> owners) {
        Report report;
        const BakeCounts more = bake_rows(work_, row, owners, rows, report);
        const std::lock_guard lock(mutex_);
        shard_.counts += more;
        rows_done_ += rows.row_count;
        if (work_.map.progress) work_.map.progress({rows_done_, shard_.counts.rays});
        stage_.advance(static_cast<std::size_t>(rows.row_count));
        reports_.emplace(row, std::move(report));
    }

    const BakeWork& work_;
    int side_;
    Report ignored_;
    BakeShard shard_;
    TexelRasterizer cover_;
    ProgressStage stage_;
    std::mutex mutex_;
    std::map<int, Report> reports_;  ///< By row, so that the order does not depend on threads.
    int rows_done_ = 0;
};

}  // namespace

SeenSurface::SeenSurface(std::span<const Mesh> meshes, const Mesh& low, const BakeOptions& options,
                         double reach, const std::string& name, Report& report)
    : fit(compare_boxes(meshes, low)),
      extent(checked_extent(fit, meshes, options, reach, name, report)),
      high(meshes, options, report),
      distances(ray_distances(meshes, high, low, options)) {}

BakeParts::BakeParts(std::span<const Mesh> high, const LowSurface& low, const BakeOptions& options,
                     Report& report) {
    surfaces_.push_back(
        std::make_unique<SeenSurface>(high, low.mesh(), options, low.cage_reach(), "", report));
    number_ids(options);
}

BakeParts::BakeParts(std::span<const BakePart> parts, const LowSurface& low,
                     const BakeOptions& options, Report& report)
    : part_of_triangle_(parts_of_triangles(parts, low.mesh())) {
    const double reach = low.cage_reach();
    for (const BakePart& part : parts) {
        const Mesh own = part_of(low.mesh(), part.triangles);
        surfaces_.push_back(
            std::make_unique<SeenSurface>(part.high, own, options, reach, part.name, report));
    }
    number_ids(options);
    const BakeLayers& layers = options.map.layers;
    if (!options.parts_occlude || !(layers.occlusion || layers.bent_normals)) return;
    std::set<const Mesh*> known;
    std::vector<RayMesh> meshes;
    for (const BakePart& part : parts) {
        for (const Mesh& mesh : part.high) {
            if (known.insert(&mesh).second) meshes.push_back({mesh.positions, mesh.triangles});
        }
    }
    occluders_ = std::make_unique<RayScene>(std::move(meshes));
}

void BakeParts::number_ids(const BakeOptions& options) {
    if (!options.map.layers.ids) return;
    std::vector<std::string> names;
    for (const auto& surface : surfaces_)
        surface->high.add_names(names);
    ids_ = surface_ids(std::move(names));
    for (const auto& surface : surfaces_)
        surface->high.number_ids(ids_);
}

LayerBounds BakeParts::bounds(const BakeLayers& layers) const {
    LayerBounds bounds;
    for (const auto& surface : surfaces_) {
        if (layers.curvature) {
            const HighSurface::CurvatureRange range = surface->high.curvature_range();
            bounds.curvature = std::max(bounds.curvature, range.max);
            bounds.curvature_p99 = std::max(bounds.curvature_p99, range.usual);
        }
        if (layers.positions) {
            bounds.position = std::max(bounds.position,
                                       surface->high.largest_coordinate(layers.position_from_mesh));
        }
        if (layers.emission)
            bounds.emission = std::max(bounds.emission, surface->high.largest_emission());
        if (layers.thickness) {
            bounds.thickness = std::max(bounds.thickness,
                                        Thickness::limit(surface->high.scene(), *layers.thickness));
        }
    }
    return bounds;
}

BakeFit BakeParts::fit() const {
    const auto grow = [](Bounds& box, const Bounds& other) {
        box.min = glm::min(box.min, other.min);
        box.max = glm::max(box.max, other.max);
    };
    Bounds high;
    Bounds low;
    for (const auto& surface : surfaces_) {
        grow(high, surface->fit.high);
        grow(low, surface->fit.low);
    }
    return compare_boxes(high, low);
}

BakeDistances BakeParts::largest_distances() const {
    BakeDistances largest;
    for (const auto& surface : surfaces_) {
        largest.offset = std::max(largest.offset, surface->distances.offset);
        largest.max_distance = std::max(largest.max_distance, surface->distances.max_distance);
    }
    return largest;
}

struct Baker::Implementation {
    template <typename High>
    Implementation(std::span<High> high, const Mesh& mesh, const BakeOptions& given, Report& report)
        : options(given),
          low(mesh, options, report),
          parts(high, low, options, report),
          agreement(agreement_of(parts, low, options)) {
        report_agreement(agreement, options, report);
    }

    BakeOptions options;
    LowSurface low;
    BakeParts parts;
    BakeAgreement agreement;
};

Baker::Baker(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options,
             Report& report) {
    check_surfaces(options);
    implementation_ = std::make_unique<Implementation>(high, low, options, report);
}

Baker::Baker(std::span<const BakePart> parts, const Mesh& low, const BakeOptions& options,
             Report& report) {
    check_surfaces(options);
    implementation_ = std::make_unique<Implementation>(parts, low, options, report);
}

Baker::~Baker() = default;
Baker::Baker(Baker&&) noexcept = default;
Baker& Baker::operator=(Baker&&) noexcept = default;

const Mesh& Baker::low() const {
    return implementation_->low.mesh();
}

const BakeOptions& Baker::options() const {
    return implementation_->options;
}

BakeDistances Baker::distances() const {
    return implementation_->parts.largest_distances();
}

BakeFit Baker::fit() const {
    return implementation_->parts.fit();
}

const BakeAgreement& Baker::agreement() const {
    return implementation_->agreement;
}

const std::vector<SurfaceId>& Baker::ids() const {
    return implementation_->parts.ids();
}

LayerBounds Baker::bounds(const BakeLayers& layers) const {
    LayerBounds bounds = implementation_->parts.bounds(layers);
    if (layers.heights) {
        const BakeDistances reach = distances();
        bounds.height =
            std::max({reach.offset, reach.max_distance, implementation_->low.cage_reach()});
    }
    return bounds;
}

BakeShard Baker::bake_range(const BakeMapOptions& map, const BakeRowRange& rows,
                            const std::function<void(const BakedRows& rows)>& take) const {
    check_layers(map.layers, implementation_->options.map.layers);
    const BakeWork work{implementation_->parts, implementation_->low, implementation_->options, map,
                        samples_across(map.samples)};
    ShardBake bake(work, low(), rows);
    const int strip_rows = Strip::row_count(map.layers, map.width, rows.last - rows.first);
    Strip strip(map.layers, static_cast<std::size_t>(map.width),
                static_cast<std::size_t>(strip_rows));
    for (int first = rows.first; first < rows.last; first += strip_rows) {
        const int last = std::min(first + strip_rows, rows.last);
        bake.bake(strip, first, last);
        take(strip.rows(map.width, first, 0, last - first));
    }
    return bake.finish();
}

BakeShard Baker::bake_shard(const BakeMapOptions& map, const BakeRowRange& rows,
                            const std::function<void(const BakedRows& rows)>& take,
                            const ExecutionOptions& execution) const {
    const ExecutionScope scope(execution);
    check_map(map, low());
    check_shard_rows(rows, map);
    return bake_range(map, rows, take);
}

BakeResult Baker::bake(const BakeMapOptions& map,
                       const std::function<void(const BakedRows& rows)>& take, Report& report,
                       const ExecutionOptions& execution) const {
    const ExecutionScope scope(execution);
    check_map(map, low());
    const BakeRowRange rows = map.rows.value_or(BakeRowRange{0, map.height});
    PaddedRows padded(map, take);
    const BakeShard shard =
        bake_range(map, rows, [&](const BakedRows& done) { padded.push(done); });
    return completed(shard, distances(), rows.first == 0 && rows.last == map.height, report);
}

BakeResult bake_normals(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options,
                        const std::function<void(const BakedRows& rows)>& take, Report& report,
                        const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    // Errors of the map options are reported before the meshes are prepared, which is slow.
    check_map(options.map, low);
    return Baker(high, low, options, report).bake(options.map, take, report);
}

}  // namespace relief
