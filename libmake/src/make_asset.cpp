// SPDX-License-Identifier: Apache-2.0
// The stages from a dense mesh to the maps of an asset. Tests: tests/make/asset_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "bake_stage.h"
#include "relief/make/asset.h"
#include "relief/mesh/frames.h"

namespace relief::make {
namespace {

constexpr int min_size = 16;
constexpr int max_size = 16384;

void check(const AssetOptions& options) {
    if (options.triangles < 1)
        throw InvalidInput("the number of triangles must be at least 1, but is 0");
    const glm::ivec2& size = options.size;
    if (std::min(size.x, size.y) < min_size || std::max(size.x, size.y) > max_size) {
        throw InvalidInput(fmt::format("the size of maps is {} x {}, but must be {} to {}", size.x,
                                       size.y, min_size, max_size));
    }
    for (const LayerKind kind : options.layers) {
        if (kind != LayerKind::height && kind != LayerKind::curvature &&
            kind != LayerKind::position) {
            throw InvalidInput(fmt::format(
                "further layers are height, curvature and position, not {}", enum_name(kind)));
        }
        if (std::ranges::count(options.layers, kind) > 1)
            throw InvalidInput(fmt::format("the layer {} is requested twice", enum_name(kind)));
    }
}

/// Runs stages and collects their reports.
class Maker {
  public:
    Maker(const AssetSource& source, const AssetOptions& options)
        : source_(source), options_(options) {}

    Asset run();

  private:
    void run_stage(const std::string& name, void (Maker::*work)(Report&));
    void repair(Report& report);
    void decimate(Report& report);
    void unwrap_mesh(Report& report);
    void compute_frames(Report& report);
    void bake(Report& report);

    const AssetSource& source_;
    const AssetOptions& options_;
    Mesh high_;
    Asset asset_;
};

/// Returns whether a triangle has an area in double precision.
bool is_usable(const Mesh& mesh, const glm::uvec3& triangle) {
    const glm::dvec3 a(mesh.positions[triangle.x]);
    const glm::dvec3 b(mesh.positions[triangle.y]);
    const glm::dvec3 c(mesh.positions[triangle.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::dot(normal, normal);
    return std::isfinite(length) && length > 0.0;
}

void Maker::repair(Report& report) {
    validate(source_.mesh);
    Mesh mesh =
        options_.repair ? repaired(source_.mesh, *options_.repair, report).mesh : source_.mesh;
    std::vector<std::uint32_t> usable;
    usable.reserve(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (is_usable(mesh, mesh.triangles[i])) {
            usable.push_back(static_cast<std::uint32_t>(i));
        } else {
            report.add("triangle without area or with a position that is not finite", "triangle", i,
                       "is removed");
        }
    }
    if (usable.empty()) throw InvalidInput("has no triangle with an area and finite positions");
    high_ = usable.size() == mesh.triangles.size() ? std::move(mesh) : part_of(mesh, usable);
    if (high_.normals.empty()) {
        FrameOptions frames;
        frames.normals = NormalWeight::angle;
        frames.crease_angle = options_.crease_angle;
        frames.tangents = TangentMethod::keep;
        high_ = with_frames(std::move(high_), frames, report).mesh;
    }
    asset_.source_triangles = high_.triangles.size();
}

void Maker::decimate(Report& report) {
    Mesh surface;
    surface.positions = high_.positions;
    surface.triangles = high_.triangles;
    if (options_.keep_texcoords) {
        surface.texcoords = high_.texcoords;
        if (surface.texcoords.empty())
            throw InvalidInput("has no texture coordinates that can be kept");
    }
    if (surface.triangles.size() < options_.triangles) {
        report.add("source with fewer triangles than requested", "source", 0,
                   "keeps all its triangles");
    }
    DecimateOptions limits;
    limits.triangles = options_.triangles;
    limits.fit_positions = true;
    limits.frames.normals = NormalWeight::angle;
    limits.frames.tangents = TangentMethod::none;
    asset_.mesh = decimated(surface, limits, report).mesh;
    if (asset_.mesh.triangles.empty()) throw InvalidInput("no triangle is left after decimation");
}

void Maker::unwrap_mesh(Report& report) {
    UnwrapOptions unwrapping;
    unwrapping.size = options_.size;
    unwrapping.padding = options_.padding;
    unwrapping.split_hard = options_.crease_angle;
    unwrapping.execution = options_.execution;
    const Unwrapped unwrapped = unwrap(asset_.mesh, unwrapping, report);
    asset_.atlas = unwrapped.stats;
    asset_.mesh = with_texcoords(asset_.mesh, unwrapped).mesh;
}

void Maker::compute_frames(Report& report) {
    FrameOptions frames;
    frames.normals = NormalWeight::angle;
    frames.crease_angle = options_.crease_angle;
    frames.tangents = TangentMethod::mikktspace;
    asset_.mesh = with_frames(std::move(asset_.mesh), frames, report).mesh;
    asset_.mesh.name = source_.name;
}

void Maker::bake(Report& report) {
    detail::bake_maps(source_, high_, options_, asset_, report);
}

void Maker::run_stage(const std::string& name, void (Maker::*work)(Report&)) {
    StageReport& stage = asset_.reports.emplace_back(StageReport{name, {}});
    if (options_.run_stage) {
        options_.run_stage(name, [&] { (this->*work)(stage.report); });
    } else {
        (this->*work)(stage.report);
    }
    if (options_.take_mesh && name != "bake")
        options_.take_mesh(name, name == "repair" ? high_ : asset_.mesh);
}

Asset Maker::run() {
    check(options_);
    const ExecutionScope scope(options_.execution);
    asset_.name = source_.name;
    asset_.origin = source_.origin;
    run_stage("repair", &Maker::repair);
    run_stage("decimate", &Maker::decimate);
    if (!options_.keep_texcoords) run_stage("unwrap", &Maker::unwrap_mesh);
    run_stage("frames", &Maker::compute_frames);
    run_stage("bake", &Maker::bake);
    return std::move(asset_);
}

}  // namespace

std::vector<std::string> stages_of(const AssetOptions& options) {
    std::vector<std::string> stages = {"repair", "decimate", "unwrap", "frames", "bake"};
    if (options.keep_texcoords) std::erase(stages, "unwrap");
    return stages;
}

Asset make_asset(const AssetSource& source, const AssetOptions& options) {
    return Maker(source, options).run();
}

}  // namespace relief::make
