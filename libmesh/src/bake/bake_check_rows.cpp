// SPDX-License-Identifier: Apache-2.0
// One texel at a time: what it shows, what it should show, and the way between. Rows in parallel,
// sums in the order of rows. Tests: tests/mesh/bake/bake_check_test.cpp.
#include "bake/bake_check_rows.h"

#include <algorithm>
#include <limits>

#include "bake/texel_frame.h"
#include "geometry/direction.h"
#include "parallel.h"
#include "relief/mesh/direction_error.h"

namespace relief {
namespace {

constexpr std::size_t most_worst = 8;
/// Of a texel's width: by so much its mean height is off that of its centre. Slopes that turn by 45
/// degrees within a texel make a sixth of it.
constexpr double torn_share = 0.25;

bool is_worse(const WorstTexel& a, const WorstTexel& b) {
    if (a.degrees != b.degrees) return a.degrees > b.degrees;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
}

void keep_worst(std::vector<WorstTexel>& worst, const WorstTexel& texel) {
    if (worst.size() == most_worst && !is_worse(texel, worst.back())) return;
    worst.insert(std::lower_bound(worst.begin(), worst.end(), texel, is_worse), texel);
    if (worst.size() > most_worst) worst.pop_back();
}

/// From what a map holds to the axes of the meshes, at one place.
class Renderer {
  public:
    Renderer(const Baker& baker, const CoveredTexel& owner)
        : mesh_(baker.low()), owner_(owner), options_(baker.options()) {
        if (options_.space != BakeSpace::tangent) {
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
    /// Of the low mesh, interpolated.
    [[nodiscard]] glm::dvec3 low_normal() const {
        const glm::uvec3 corners = mesh_.triangles[owner_.triangle];
        glm::dvec3 sum(0.0);
        for (int i = 0; i < 3; ++i)
            sum += double{owner_.weights()[i]} * glm::dvec3(mesh_.normals[corners[i]]);
        return sum;
    }
    /// How wide a texel is on the mesh: the root of its area.
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

class Row {
  public:
    Row(const Baker& baker, const RowsToCheck& rows, int step) : baker_(baker), rows_(rows) {
        step_ = step;
    }

    double check(std::size_t texel, CheckSums& sums) const {
        const double none = std::numeric_limits<double>::quiet_NaN();
        const CoveredTexel& owner = rows_.owners[texel];
        if (!owner.is_covered()) return none;
        if (!rows_.reference->is_baked(texel)) {
            ++sums.missed;
            return none;
        }
        const Renderer renderer(baker_, owner);
        if (!renderer.is_usable()) {
            ++sums.frameless;
            return none;
        }
        const glm::dvec3 truth = renderer.shown(rows_.reference->normal(texel));
        const glm::dvec3 shown = renderer.shown(at(rows_.map, texel));
        if (rows_.centre->is_baked(texel)) {
            sums.centre.add(degrees_between(shown, renderer.shown(rows_.centre->normal(texel))));
        }
        const double degrees = degrees_between(shown, truth);
        sums.error.add(degrees);
        const bool is_torn = tears(texel, renderer, truth);
        keep_worst(sums.worst, {column(texel), row(texel), degrees, is_torn});
        split(texel, renderer, truth, shown, is_torn, sums);
        return degrees;
    }

  private:
    [[nodiscard]] int column(std::size_t texel) const {
        return static_cast<int>(texel % static_cast<std::size_t>(rows_.width));
    }
    [[nodiscard]] int row(std::size_t texel) const {
        return rows_.first + static_cast<int>(texel / static_cast<std::size_t>(rows_.width));
    }

    [[nodiscard]] bool tears(std::size_t texel, const Renderer& renderer,
                             const glm::dvec3& truth) const {
        if (!rows_.centre->is_baked(texel)) return true;
        const double jump = std::abs(double{rows_.reference->heights[texel]} -
                                     double{rows_.centre->heights[texel]});
        const double texels = static_cast<double>(rows_.width) * rows_.height;
        return jump > torn_share * renderer.width_of_texel(texels) ||
               glm::dot(truth, renderer.low_normal()) < 0.0;
    }

    /// Books the way from the truth to what is shown.
    void split(std::size_t texel, const Renderer& renderer, const glm::dvec3& truth,
               const glm::dvec3& shown, bool is_torn, CheckSums& sums) const {
        const auto stage = [](BakeStage s) { return static_cast<std::size_t>(s); };
        const glm::dvec3 whole = shown - truth;
        const bool is_made = rows_.made->is_baked(texel);
        const glm::dvec3 recoded = at(rows_.remade, texel);
        const glm::dvec3 remade = renderer.shown(recoded);
        if (is_made) sums.remade.add(degrees_between(remade, truth));
        if (is_torn || !is_made) {
            ++sums.torn;
            sums.stages[stage(BakeStage::projection)].add(degrees_between(shown, truth));
            sums.squares[stage(BakeStage::projection)] += glm::dot(whole, whole);
            return;
        }
        const glm::dvec3 made = renderer.shown(rows_.made->normal(texel));
        const double in_map = degrees_between(recoded, rows_.made->normal(texel));
        const double in_object = degrees_between(remade, made);
        sums.stages[stage(BakeStage::sampling)].add(degrees_between(made, truth));
        sums.stages[stage(BakeStage::quantisation)].add(in_map);
        sums.stages[stage(BakeStage::other)].add(degrees_between(shown, remade));
        sums.tangent_squares += in_map * in_map;
        sums.object_squares += in_object * in_object;
        sums.squares[stage(BakeStage::sampling)] += glm::dot(made - truth, whole);
        sums.squares[stage(BakeStage::quantisation)] += glm::dot(remade - made, whole);
        sums.squares[stage(BakeStage::other)] += glm::dot(shown - remade, whole);
        // Readings are told apart where samples make no difference.
        keep_known(texel, made, in_object, sums);
    }

    void keep_known(std::size_t texel, const glm::dvec3& truth, double expected,
                    CheckSums& sums) const {
        if (step_ == 0 || row(texel) % step_ != step_ / 2 || column(texel) % step_ != step_ / 2)
            return;
        const CoveredTexel& owner = rows_.owners[texel];
        sums.known.push_back({column(texel), row(texel), owner.triangle,
                              glm::dvec3(owner.weights()), truth, expected});
    }

    const Baker& baker_;
    const RowsToCheck& rows_;
    int step_ = 0;
};

}  // namespace

void CheckSums::add(const CheckSums& others) {
    error.add(others.error);
    centre.add(others.centre);
    remade.add(others.remade);
    for (std::size_t i = 0; i < stages.size(); ++i) {
        stages[i].add(others.stages[i]);
        squares[i] += others.squares[i];
    }
    missed += others.missed;
    frameless += others.frameless;
    torn += others.torn;
    tangent_squares += others.tangent_squares;
    object_squares += others.object_squares;
    for (const WorstTexel& texel : others.worst)
        keep_worst(worst, texel);
    known.insert(known.end(), others.known.begin(), others.known.end());
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

std::vector<float> coded(const std::vector<float>& normals, int width,
                         const NormalMapFormat& format) {
    Image image;
    image.width = width;
    image.height = static_cast<int>(normals.size() / (3 * static_cast<std::size_t>(width)));
    image.channels = 3;
    image.samples = normals;
    Report unsaid;  // Unit normals have no trouble.
    const Image decoded = decode_normal_map(encode_normal_map(image, format, unsaid), format.green,
                                            format.flat, unsaid);
    return std::get<std::vector<float>>(decoded.samples);
}

CheckSums check_rows(const Baker& baker, const RowsToCheck& rows, int step,
                     std::span<float> degrees) {
    const auto width = static_cast<std::size_t>(rows.width);
    const std::size_t count = degrees.size() / width;
    // Pieces are few, for each has its bins.
    constexpr std::size_t piece = 16;
    std::vector<CheckSums> sums((count + piece - 1) / piece);
    const Row row(baker, rows, step);
    parallel_for(sums.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t part = begin; part < end; ++part) {
            const std::size_t last = std::min((part + 1) * piece, count) * width;
            for (std::size_t texel = part * piece * width; texel < last; ++texel)
                degrees[texel] = static_cast<float>(row.check(texel, sums[part]));
        }
    });
    CheckSums all;
    for (const CheckSums& part : sums)
        all.add(part);
    return all;
}

}  // namespace relief
