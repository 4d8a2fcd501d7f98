// SPDX-License-Identifier: Apache-2.0
// Bakes rows of texels: rays in blocks of 4 x 4 samples, so that rays of a packet are coherent,
// then sums and means per texel. Rows are processed in parallel pieces. Tests:
// tests/mesh/bake/bake_test.cpp.
#include "bake/bake_work.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "bake/layers.h"
#include "bake/texel_frame.h"
#include "geometry/direction.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

constexpr int block = 4;                      // Samples along the side of a block.
constexpr std::size_t rays_per_flush = 4096;  // Their data fits a cache.
constexpr std::size_t max_first_missed = 8;

/// Returns whether adaptive sampling casts a sample in its first pass: one in each row and column
/// of 16.
bool is_first(int x, int y, int side) {
    if (side == 2) return x == y;
    constexpr std::array<int, block> column = {1, 3, 0, 2};
    return column[static_cast<std::size_t>(y % block)] == x % block;
}

/// The sums of a texel over its samples.
struct TexelSum {
    glm::dvec3 normal{0.0};
    double height = 0.0;
    glm::dvec3 first{0.0};     ///< The normal of the first sample that hit.
    double min_cosine = 1.0;   ///< Minimum cosine between it and the others.
    bool lacks_frame = false;  ///< True if it holds for any sample.
    bool is_behind = false;    ///< True if any normal points behind the low surface.
    std::uint32_t hits = 0;
    std::uint32_t cast = 0;
};

/// Bakes a piece of the map: whole rows, which no other piece writes.
class Piece {
  public:
    Piece(const BakeWork& work, int first_row, std::span<const CoveredTexel> owners,
          const BakedRows& rows, int begin, int end, Report& report)
        : work_(work),
          owners_(owners),
          rows_(rows),
          first_row_(first_row),
          begin_(begin),
          end_(end),
          width_(work.map.width),
          report_(report),
          needs_normals_(work.map.layers.normals || work.map.sample_angle),
          sums_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(end - begin)) {
        const int samples = work.side * work.side;
        if (LayerBake::is_requested(work.map.layers)) {
            layers_.emplace(
                work, map_index(0), sums_.size(),
                is_adaptive_bake() ? first_count() : static_cast<std::uint32_t>(samples));
        }
    }

    BakeCounts bake() {
        if (is_adaptive_bake()) {
            cast([&](int x, int y, std::size_t) {
                return is_first(x % work_.side, y % work_.side, work_.side);
            });
            const double limit = portable::cos(*work_.map.sample_angle);
            std::vector<bool> disagree(sums_.size());
            for (std::size_t i = 0; i < sums_.size(); ++i) {
                const TexelSum& sum = sums_[i];
                disagree[i] =
                    sum.hits != sum.cast || sum.min_cosine < limit || sum.cast < first_count();
            }
            cast([&](int x, int y, std::size_t texel) {
                return disagree[texel] && !is_first(x % work_.side, y % work_.side, work_.side);
            });
        } else {
            cast([](int, int, std::size_t) { return true; });
        }
        for (std::size_t texel = 0; texel < sums_.size(); ++texel)
            store(texel);
        return counts_;
    }

  private:
    [[nodiscard]] bool is_adaptive_bake() const {
        return work_.side > 1 && work_.map.sample_angle.has_value();
    }
    [[nodiscard]] std::uint32_t first_count() const {
        const int count = work_.side == 2 ? 2 : work_.side * work_.side / block;
        return static_cast<std::uint32_t>(count);
    }

    /// Casts rays for all covered samples that `requested` selects, block by block.
    template <typename Requested>
    void cast(const Requested& requested) {
        const int side = work_.side;
        const int columns = width_ * side;
        const int rows = (end_ - begin_) * side;
        for (int row = 0; row < rows; row += block) {
            for (int column = 0; column < columns; column += block) {
                for (int y = row; y < std::min(row + block, rows); ++y) {
                    for (int x = column; x < std::min(column + block, columns); ++x) {
                        const std::size_t texel =
                            static_cast<std::size_t>(y / side) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(x / side);
                        const CoveredTexel& owner =
                            owners_[(static_cast<std::size_t>(begin_ * side + y)) *
                                        static_cast<std::size_t>(columns) +
                                    static_cast<std::size_t>(x)];
                        if (owner.is_covered() && requested(x, y, texel))
                            add_line(owner, texel, (y % side) * side + x % side);
                    }
                }
                if (lines_.size() + block * block > rays_per_flush) flush();
            }
        }
        flush();
    }

    void add_line(const CoveredTexel& owner, std::size_t texel, int index) {
        const SeenSurface& surface = work_.parts.surface_of(owner.triangle);
        if (&surface != surface_) {
            flush();
            surface_ = &surface;
        }
        lines_.push_back(work_.low.line(owner, surface.distances, map_index(texel), report_));
        samples_.push_back({owner, texel, static_cast<std::uint32_t>(index)});
        ++sums_[texel].cast;
    }

    void flush() {
        if (lines_.empty()) return;
        check_cancelled();
        points_.resize(lines_.size());
        const Projection projection(surface_->high.scene(), work_.options.back_faces);
        counts_.rays += projection.find(lines_, points_);
        counts_.samples += lines_.size();
        cast_again_from_borders(projection);
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            if (points_[i].hit.is_hit()) add_hit(samples_[i], points_[i]);
        }
        if (layers_) add_layers();
        lines_.clear();
        samples_.clear();
    }

    struct Sample {
        CoveredTexel owner;
        std::size_t texel;
        std::uint32_t index;  ///< Index in the texel.
    };

    /// Casts missed samples on the border of their triangle again, from slightly inside.
    void cast_again_from_borders(const Projection& projection) {
        Report ignored;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            if (points_[i].hit.is_hit()) continue;
            const auto moved =
                moved_inside(work_.low.mesh(), samples_[i].owner, projection.border_distance());
            if (!moved) continue;
            lines_[i] =
                work_.low.line(*moved, surface_->distances, map_index(samples_[i].texel), ignored);
            counts_.rays += projection.find({&lines_[i], 1}, {&points_[i], 1});
        }
    }

    void add_layers() {
        std::vector<LayerHit> hits;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            if (points_[i].hit.is_hit())
                hits.push_back(
                    {points_[i].hit, samples_[i].owner, samples_[i].texel, samples_[i].index});
        }
        const LayerRays rays =
            layers_->add(surface_->high, work_.parts.occluders(*surface_), hits, report_);
        counts_.occlusion_rays += rays.occlusion;
        counts_.thickness_rays += rays.thickness;
        counts_.open_thickness_rays += rays.open_thickness;
    }

    void add_hit(const Sample& sample, const ProjectedPoint& point) {
        TexelSum& sum = sums_[sample.texel];
        if (needs_normals_) add_normal(sample, point, sum);
        sum.height += point.height;
        ++sum.hits;
        counts_.min_height = std::min(counts_.min_height, point.height);
        counts_.max_height = std::max(counts_.max_height, point.height);
    }

    void add_normal(const Sample& sample, const ProjectedPoint& point, TexelSum& sum) {
        glm::dvec3 normal = surface_->high.normal(point.hit, map_index(sample.texel), report_);
        if (!point.hit.faces_origin) normal = -normal;
        const std::optional<glm::dvec3> in_map = in_output_space(work_, sample.owner, normal);
        const bool is_tangent = work_.options.space == VectorSpace::tangent;
        sum.lacks_frame |= !in_map;
        sum.is_behind |= is_tangent && in_map && in_map->z < 0.0;
        normal = in_map.value_or(glm::dvec3(0.0, 0.0, 1.0));
        if (sum.hits == 0) sum.first = normal;
        sum.min_cosine = std::min(sum.min_cosine, glm::dot(sum.first, normal));
        sum.normal += normal;
    }

    /// Stores the means over the samples that hit.
    void store(std::size_t texel) {
        const TexelSum& sum = sums_[texel];
        const std::size_t at =
            static_cast<std::size_t>(begin_) * static_cast<std::size_t>(width_) + texel;
        if (sum.lacks_frame)
            report_.add("texel without a frame", "texel", map_index(texel), "is (0, 0, 1)");
        if (sum.is_behind)
            report_.add("normal behind the surface", "texel", map_index(texel), "kept");
        TexelState state = sum.cast == 0 ? TexelState::empty : TexelState::missed;
        if (sum.hits > 0) {
            state = TexelState::baked;
            ++counts_.baked;
        } else if (state == TexelState::missed) {
            ++counts_.missed;
            report_.add("texel missed by its rays", "texel", map_index(texel),
                        "is filled from its neighbors");
            describe_missed(texel);
        }
        rows_.states[at] = state;
        if (work_.map.layers.normals) store_normal(sum, at);
        if (work_.map.layers.heights)
            rows_.heights[at] = sum.hits > 0 ? static_cast<float>(sum.height / sum.hits) : 0.0F;
        if (layers_) layers_->store(texel, rows_, at, report_);
    }

    /// Returns the owner of the first covered sample of a texel.
    [[nodiscard]] const CoveredTexel& first_owner(std::size_t texel) const {
        const auto side = static_cast<std::size_t>(work_.side);
        const auto width = static_cast<std::size_t>(width_);
        const std::size_t row =
            (static_cast<std::size_t>(begin_) + texel / width) * side * width * side;
        const std::size_t first = row + texel % width * side;
        for (std::size_t i = 0; i < side * side; ++i) {
            const CoveredTexel& owner = owners_[first + i / side * width * side + i % side];
            if (owner.is_covered()) return owner;
        }
        return owners_[first];
    }

    void describe_missed(std::size_t texel) {
        const bool is_first = counts_.first_missed.size() < max_first_missed;
        if (!is_first && !work_.map.measures_missed) return;
        const CoveredTexel& owner = first_owner(texel);
        const SeenSurface& surface = work_.parts.surface_of(owner.triangle);
        Report ignored;
        const ProjectionLine line =
            work_.low.line(owner, surface.distances, map_index(texel), ignored);
        if (is_first) {
            const auto width = static_cast<std::size_t>(width_);
            counts_.first_missed.push_back({static_cast<int>(texel % width),
                                            first_row_ + begin_ + static_cast<int>(texel / width),
                                            work_.low.position(owner)});
        }
        if (work_.map.measures_missed && line.outside >= 0.0) measure_missed(line, surface);
    }

    /// Measures the distance of the nearest surfaces of a missed texel, outwards and inwards.
    void measure_missed(const ProjectionLine& line, const SeenSurface& surface) {
        const RayScene& scene = surface.high.scene();
        const RayHit outwards = scene.nearest({line.point, line.outward, 0.0, surface.extent});
        const RayHit inwards = scene.nearest({line.point, -line.outward, 0.0, surface.extent});
        counts_.measuring_rays += 2;
        const bool takes_back_faces = work_.options.back_faces == BackFaces::take;
        const bool is_within = (outwards.is_hit() && outwards.distance <= line.outside) ||
                               (inwards.is_hit() && inwards.distance <= line.inside);
        // Seen from the texel, a front face lies inwards, and faces away outwards.
        const bool hits_outside = outwards.is_hit() && outwards.distance > line.outside &&
                                  (takes_back_faces || !outwards.faces_origin);
        const bool hits_inside = inwards.is_hit() && inwards.distance > line.inside &&
                                 (takes_back_faces || inwards.faces_origin);
        if (hits_outside && !(hits_inside && inwards.distance < outwards.distance))
            counts_.clipped_outside.add(outwards.distance);
        else if (hits_inside)
            counts_.clipped_inside.add(inwards.distance);
        else if (is_within)
            ++counts_.missed_from_behind;
    }

    void store_normal(const TexelSum& sum, std::size_t at) {
        glm::dvec3 normal(0.0, 0.0, 1.0);
        if (sum.hits > 0) {
            normal = direction_or_zero(sum.normal);
            if (normal == glm::dvec3(0.0)) normal = sum.first;
        }
        for (std::size_t axis = 0; axis < 3; ++axis)
            rows_.normals[3 * at + axis] = rounded(normal)[static_cast<int>(axis)];
    }

    [[nodiscard]] std::size_t map_index(std::size_t texel) const {
        return static_cast<std::size_t>(first_row_ + begin_) * static_cast<std::size_t>(width_) +
               texel;
    }

    const BakeWork& work_;
    const SeenSurface* surface_ = nullptr;  ///< The surface of the pending lines.
    std::span<const CoveredTexel> owners_;
    const BakedRows& rows_;
    int first_row_, begin_, end_, width_;
    Report& report_;
    bool needs_normals_;  ///< For the layer, or for adaptive sampling.
    BakeCounts counts_;
    std::optional<LayerBake> layers_;
    std::vector<TexelSum> sums_;
    std::vector<ProjectionLine> lines_;
    std::vector<ProjectedPoint> points_;
    std::vector<Sample> samples_;
};

}  // namespace

std::optional<glm::dvec3> in_output_space(const BakeWork& work, const CoveredTexel& texel,
                                          const glm::dvec3& direction) {
    if (work.options.space != VectorSpace::tangent)
        return direction_or_zero(work.options.output_from_mesh * direction);
    const TexelFrame frame(work.low.mesh(), texel.triangle, glm::dvec3(texel.weights()));
    if (!frame.is_usable()) return std::nullopt;
    return direction_or_zero(frame.to_tangent(direction));
}

BakeCounts bake_rows(const BakeWork& work, int first_row, std::span<const CoveredTexel> owners,
                     const BakedRows& rows, Report& report) {
    const auto piece_rows = static_cast<std::size_t>(std::max(block / work.side, 1));
    BakeCounts counts;
    std::mutex mutex;
    parallel_for_reporting(static_cast<std::size_t>(rows.row_count), piece_rows, report,
                           [&](std::size_t begin, std::size_t end, Report& piece_report) {
                               Piece piece(work, first_row, owners, rows, static_cast<int>(begin),
                                           static_cast<int>(end), piece_report);
                               const BakeCounts more = piece.bake();
                               const std::lock_guard lock(mutex);
                               counts += more;
                           });
    return counts;
}

}  // namespace relief::detail
