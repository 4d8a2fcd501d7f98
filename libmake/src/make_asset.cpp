// SPDX-License-Identifier: Apache-2.0
// The stages from a dense mesh to the maps of an asset. Tests: tests/make/asset_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "bake_stage.h"
#include "draw_modes.h"
#include "geometry/triangle_stacks.h"
#include "geometry/weld.h"
#include "part_groups.h"
#include "relief/make/asset.h"
#include "relief/mesh/frames.h"
#include "remesh_judgment.h"

namespace relief::make {
namespace {

constexpr int min_size = 16;
constexpr int max_size = 16384;

/// Returns whether triangles are replaced only if that is better.
bool judges_remeshing(const AssetOptions& options) {
    return options.remesh == Remeshing::automatic && !options.keep_texcoords &&
           (!options.start || options.start->stage == "remesh");
}

/// Returns whether triangles are replaced in any case.
bool always_remeshes(const AssetOptions& options) {
    return options.remesh == Remeshing::always &&
           (!options.start || options.start->stage == "remesh");
}

/// Stages that can be left out, and a last one that cannot.
constexpr std::array<std::string_view, 5> start_order = {"remesh", "decimate", "unwrap", "frames",
                                                         "bake"};

/// Returns whether AssetOptions::start leaves out a stage.
bool is_left_out(const AssetOptions& options, std::string_view stage) {
    if (!options.start) return false;
    return std::ranges::find(start_order, stage) <
           std::ranges::find(start_order, options.start->stage);
}

/// \throws InvalidInput if the stages cannot begin with the mesh
void check(const AssetStart& start, bool keeps_texcoords) {
    if (std::ranges::find(start_order, start.stage) == start_order.end())
        throw InvalidInput(fmt::format("no job can continue at a stage \"{}\"", start.stage));
    if (start.stage == "remesh" && keeps_texcoords)
        throw InvalidInput("a job that keeps texture coordinates cannot continue at \"remesh\"");
    if (start.stage == "unwrap" && keeps_texcoords)
        throw InvalidInput("a job that keeps texture coordinates cannot continue at \"unwrap\"");
    validate(start.mesh);
    const auto require = [&](bool is_there, const char* what) {
        if (!is_there) {
            throw InvalidInput(
                fmt::format("the mesh for the stage \"{}\" must have {}", start.stage, what));
        }
    };
    require(!start.mesh.triangles.empty(), "triangles");
    if (start.stage == "frames" || start.stage == "bake")
        require(!start.mesh.texcoords.empty(), "texture coordinates");
    if (start.stage != "bake") return;
    require(!start.mesh.normals.empty(), "normals");
    require(!start.mesh.tangents.empty(), "tangents");
}

constexpr std::array further_layers = {LayerKind::height,    LayerKind::curvature,
                                       LayerKind::position,  LayerKind::bent_normal,
                                       LayerKind::thickness, LayerKind::id};

void check(const AssetOptions& options) {
    if (options.triangles < 1)
        throw InvalidInput("the number of triangles must be at least 1, but is 0");
    const glm::ivec2& size = options.size;
    if (std::min(size.x, size.y) < min_size || std::max(size.x, size.y) > max_size) {
        throw InvalidInput(fmt::format("the size of maps is {} x {}, but must be {} to {}", size.x,
                                       size.y, min_size, max_size));
    }
    for (const LayerKind kind : options.layers) {
        if (std::ranges::find(further_layers, kind) == further_layers.end()) {
            throw InvalidInput(fmt::format(
                "further layers are height, curvature, position, bent normals, thickness and ids, "
                "not {}",
                enum_name(kind)));
        }
        if (std::ranges::count(options.layers, kind) > 1)
            throw InvalidInput(fmt::format("the layer {} is requested twice", enum_name(kind)));
    }
    if (options.normal_bits != 8 && options.normal_bits != 16) {
        throw InvalidInput(
            fmt::format("the normal map has {} bits, but must have 8 or 16", options.normal_bits));
    }
    if (options.remesh == Remeshing::always && options.keep_texcoords)
        throw InvalidInput("a mesh that is remeshed cannot keep its texture coordinates");
    if (options.start) check(*options.start, options.keep_texcoords);
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
    void remesh(Report& report);
    void judge(Report& report);
    [[nodiscard]] RemeshOptions grid() const;
    void begin(const AssetStart& start);
    [[nodiscard]] const Mesh& replaceable() const;
    [[nodiscard]] const Mesh& dense_surface() const;
    [[nodiscard]] Mesh replaceable_shape() const;
    void find_parts(const FramedMesh& repaired);
    [[nodiscard]] std::vector<std::uint32_t> parts_of_dense_surface() const;
    [[nodiscard]] std::vector<AlphaMode> alpha_of_replaceable() const;
    [[nodiscard]] std::vector<AlphaMode> alpha_of_dense_surface() const;
    [[nodiscard]] std::string reason_for_one_part() const;
    void match_parts(Report& report);
    void decimate(Report& report);
    void separate_sides(Report& report);
    void unwrap_mesh(Report& report);
    void reduce();
    void compute_frames(Report& report);
    void bake(Report& report);

    const AssetSource& source_;
    const AssetOptions& options_;
    detail::SourceAlpha alpha_;
    Mesh high_;
    NamedParts high_parts_;  ///< Of `high_`, with a name for each number.
    /// The part of each triangle of the asset's mesh; empty: not known.
    std::vector<std::uint32_t> low_parts_;
    /// The alpha of each triangle of the asset's mesh; empty: not known, or all the same.
    std::vector<AlphaMode> low_alpha_;
    std::string unmatched_;       ///< Names of parts of AssetStart that the source does not have.
    std::optional<Mesh> closed_;  ///< The closed surface that replaces the triangles of `high_`.
    detail::RemeshEvidence evidence_;
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

/// Returns options with which the sides of doubled walls are decimated as one.
RepairOptions with_sides_together(RepairOptions options) {
    if (options.two_sided == TwoSided::keep && options.orient)
        options.two_sided = TwoSided::together;
    return options;
}

void Maker::repair(Report& report) {
    validate(source_.mesh);
    alpha_ = detail::source_alpha(source_, report);
    FramedMesh result;
    if (options_.repair) {
        result = repaired(source_.mesh, with_sides_together(*options_.repair), report);
    } else {
        result.mesh = source_.mesh;
        result.source_vertex.resize(result.mesh.positions.size());
        std::iota(result.source_vertex.begin(), result.source_vertex.end(), 0U);
    }
    find_parts(result);
    Mesh& mesh = result.mesh;
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
    if (!high_parts_.names.empty()) {
        std::vector<std::uint32_t> parts;
        for (const std::uint32_t triangle : usable)
            parts.push_back(high_parts_.part_of[triangle]);
        high_parts_.part_of = std::move(parts);
    }
    high_ = usable.size() == mesh.triangles.size() ? std::move(mesh) : part_of(mesh, usable);
    if (high_.normals.empty()) {
        FrameOptions frames;
        frames.normals = NormalWeight::angle;
        frames.crease_angle = source_.crease_angle ? source_.crease_angle : options_.crease_angle;
        frames.tangents = TangentMethod::keep;
        high_ = with_frames(std::move(high_), frames, report).mesh;
    }
    asset_.source_triangles = high_.triangles.size();
    if (judges_remeshing(options_)) {
        const bool is_repaired = options_.repair && !options_.start;
        evidence_.crowded_edges =
            detail::crowded_edge_share(replaceable(), is_repaired ? &report : nullptr);
    }
}

/// Finds the parts of the repaired source that a bake can keep apart.
void Maker::find_parts(const FramedMesh& repaired) {
    if (source_.parts.names.size() < 2) return;
    high_parts_ = detail::separate_parts(source_.mesh, source_.parts);
    high_parts_.part_of = detail::parts_of_copy(source_.mesh, high_parts_.part_of, repaired);
    if (options_.repair && options_.repair->weld_tolerance > 0.0)
        high_parts_ = detail::separate_parts(repaired.mesh, high_parts_);
}

/// Returns the parts of the triangles to decimate; empty if they are not known.
std::vector<std::uint32_t> Maker::parts_of_dense_surface() const {
    if (closed_ || high_parts_.names.empty()) return {};
    if (!options_.start) return high_parts_.part_of;
    if (options_.start->is_repaired_source &&
        options_.start->mesh.triangles.size() == high_.triangles.size())
        return high_parts_.part_of;
    return low_parts_;
}

std::vector<std::uint32_t> numbers_of(std::span<const AlphaMode> modes) {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(modes.size());
    for (const AlphaMode mode : modes)
        numbers.push_back(static_cast<std::uint32_t>(mode));
    return numbers;
}

/// The inverse, from ranges of triangles of one mode.
std::vector<AlphaMode> modes_of_ranges(const Mesh& mesh) {
    std::vector<AlphaMode> modes;
    modes.reserve(mesh.triangles.size());
    for (const std::uint32_t number : detail::parts_of_ranges(mesh))
        modes.push_back(static_cast<AlphaMode>(number));
    return modes;
}

/// Returns the alpha of the triangles that a closed surface may replace.
std::vector<AlphaMode> Maker::alpha_of_replaceable() const {
    if (!options_.start || (options_.start->is_repaired_source &&
                            options_.start->mesh.triangles.size() == high_.triangles.size()))
        return detail::alpha_modes_of(high_, alpha_);
    return low_alpha_;
}

/// Returns the alpha of the triangles to decimate; empty if it is not known, or all the same.
std::vector<AlphaMode> Maker::alpha_of_dense_surface() const {
    if (!closed_) return alpha_of_replaceable();
    std::vector<AlphaMode> modes = modes_of_ranges(*closed_);
    return detail::is_mixed(modes) ? modes : std::vector<AlphaMode>{};
}

/// Returns why each part of the asset sees all parts of the source; empty if it sees its own.
std::string Maker::reason_for_one_part() const {
    if (options_.match == PartMatching::all) return "it was requested";
    if (high_parts_.names.size() < 2) return "the parts of the model touch each other";
    if (closed_ || (options_.start && options_.start->is_remeshed))
        return "a closed surface replaces the parts";
    if (!unmatched_.empty()) return "the model has no part " + unmatched_;
    if (low_parts_.empty()) return "the mesh to continue with has no names of parts";
    return "";
}

/// Decides whether parts are matched. \throws InvalidInput if they must be, but cannot
void Maker::match_parts(Report& report) {
    if (source_.parts.names.size() < 2) return;
    PartDecision& decision = asset_.parts;
    decision.reason = reason_for_one_part();
    decision.is_matched = decision.reason.empty();
    if (!decision.is_matched) {
        if (options_.match == PartMatching::name && !unmatched_.empty())
            throw InvalidInput("parts cannot be matched by name: " + decision.reason);
        const bool lacks_names = !unmatched_.empty() || (options_.start && low_parts_.empty());
        if (lacks_names && high_parts_.names.size() > 1 && options_.match != PartMatching::all &&
            !options_.start->is_remeshed)
            report.add("parts that are not matched by name", "asset", 0,
                       "see all parts of the model: " + decision.reason);
        return;
    }
    for (const std::string& name : high_parts_.names)
        decision.parts.push_back({name, 0, 0});
    for (const std::uint32_t part : high_parts_.part_of)
        ++decision.parts[part].source_triangles;
    for (const std::uint32_t part : low_parts_)
        ++decision.parts[part].triangles;
    for (std::size_t part = 0; part < decision.parts.size(); ++part) {
        if (decision.parts[part].triangles == 0)
            report.add("part of the model without a part of the asset", "part", part,
                       fmt::format("{} is not shown", decision.parts[part].name));
    }
}

RemeshOptions Maker::grid() const {
    return {options_.resolution, options_.shell, options_.sign, options_.execution};
}

/// Replaces the triangles to decimate.
void Maker::remesh(Report& report) {
    RemeshDecision& decision = asset_.remesh.emplace();
    closed_ = detail::closed_surface(replaceable_shape(), grid(), decision, report);
    decision.is_remeshed = true;
    decision.reason = "it was requested";
}

/// Replaces the triangles that were decimated if a criterion requires it and the distance permits
/// it.
void Maker::judge(Report& report) {
    RemeshDecision& decision = asset_.remesh.emplace();
    decision.criteria = detail::remesh_criteria(replaceable(), evidence_);
    const bool is_exceeded = std::ranges::any_of(decision.criteria, &RemeshCriterion::is_exceeded);
    closed_ = detail::better_surface(is_exceeded ? replaceable_shape() : Mesh{}, grid(), decision,
                                     report);
}

/// Sorts triangles by a number, which becomes their material.
void sort_by(Mesh& mesh, std::span<const std::uint32_t> numbers) {
    if (numbers.empty()) return;
    std::vector<std::uint32_t> order(numbers.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return numbers[i]; });
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> sorted;
    for (const std::uint32_t i : order) {
        triangles.push_back(mesh.triangles[i]);
        sorted.push_back(numbers[i]);
    }
    mesh.triangles = std::move(triangles);
    mesh.material_ranges = detail::ranges_of(sorted);
}

/// Moves the sides of doubled walls apart, so that rays meet the right one and each side has charts
/// of its own.
void Maker::separate_sides(Report& report) {
    Report known;  // The repair has counted the others.
    FramedMesh high = repaired(high_, *options_.repair, known);
    if (!low_alpha_.empty())
        asset_.mesh.material_ranges = detail::ranges_of(numbers_of(low_alpha_));
    FramedMesh low = repaired(asset_.mesh, *options_.repair, known);
    if (!high_parts_.names.empty())
        high_parts_.part_of = detail::parts_of_copy(high_, high_parts_.part_of, high);
    if (!low_parts_.empty()) low_parts_ = detail::parts_of_copy(asset_.mesh, low_parts_, low);
    if (!low_alpha_.empty()) {
        low_alpha_ = modes_of_ranges(low.mesh);
        low.mesh.material_ranges.clear();
    }
    high_ = std::move(high.mesh);
    asset_.mesh = std::move(low.mesh);
    report.add("surface with doubled walls", "mesh", 0,
               "has sides that are a millionth of its size apart");
}

/// Returns the triangles that a closed surface may replace.
const Mesh& Maker::replaceable() const {
    return options_.start ? options_.start->mesh : high_;
}

/// Returns its shape, with a material range for each alpha mode.
Mesh Maker::replaceable_shape() const {
    Mesh shape;
    shape.positions = replaceable().positions;
    shape.triangles = replaceable().triangles;
    sort_by(shape, numbers_of(alpha_of_replaceable()));
    return shape;
}

/// Returns the triangles to decimate.
const Mesh& Maker::dense_surface() const {
    return closed_ ? *closed_ : replaceable();
}

/// Takes the mesh of a stage that is left out.
void Maker::begin(const AssetStart& start) {
    const auto name_of = [&](const std::string& name) {
        // "base + hinge" are the names of one part.
        return std::ranges::find_if(high_parts_.names, [&](const std::string& names) {
            return names == name ||
                   (" + " + names + " + ").find(" + " + name + " + ") != std::string::npos;
        });
    };
    if (!start.parts.names.empty() && !high_parts_.names.empty()) {
        std::vector<std::uint32_t> numbers;
        for (const std::string& name : start.parts.names) {
            const auto found = name_of(name);
            if (found == high_parts_.names.end())
                unmatched_ += (unmatched_.empty() ? "" : ", ") + name;
            numbers.push_back(static_cast<std::uint32_t>(found - high_parts_.names.begin()));
        }
        if (unmatched_.empty()) {
            for (const std::uint32_t part : start.parts.part_of)
                low_parts_.push_back(numbers[part]);
        }
    }
    low_alpha_ = start.alpha_modes;
    const auto is_of_source = [&](AlphaMode mode) {
        return std::ranges::find(alpha_.of_material, mode) != alpha_.of_material.end() ||
               mode == AlphaMode::opaque;
    };
    if (!detail::is_mixed(low_alpha_) || !std::ranges::all_of(low_alpha_, is_of_source))
        low_alpha_.clear();
    if (start.stage == "remesh" || start.stage == "decimate") return;
    asset_.mesh = start.mesh;
    asset_.mesh.name = source_.name;
    const bool has_sides = options_.repair && !start.is_remeshed &&
                           !relief::detail::triangle_stacks(
                                high_.triangles, relief::detail::weld_positions(high_.positions))
                                .empty();
    if (has_sides) {
        Report known;
        FramedMesh high = repaired(high_, *options_.repair, known);
        if (!high_parts_.names.empty())
            high_parts_.part_of = detail::parts_of_copy(high_, high_parts_.part_of, high);
        high_ = std::move(high.mesh);
    }
}

void Maker::decimate(Report& report) {
    Mesh surface;
    const Mesh& dense = dense_surface();
    surface.positions = dense.positions;
    surface.triangles = dense.triangles;
    // Parts share no vertex, so that borders between them do not limit the decimation. Those
    // between alpha modes must stay.
    const std::vector<std::uint32_t> parts = parts_of_dense_surface();
    const std::vector<AlphaMode> alpha = alpha_of_dense_surface();
    sort_by(surface, detail::pairs_of(parts, alpha));
    if (options_.keep_texcoords) {
        surface.texcoords = dense.texcoords;
        if (surface.texcoords.empty())
            throw InvalidInput("has no texture coordinates that can be kept");
    }
    if (surface.triangles.size() < options_.triangles) {
        report.add("source with fewer triangles than requested", "source", 0,
                   "keeps all its triangles");
    }
    DecimateOptions limits;
    limits.triangles = options_.triangles;
    // The maps have the normals of the source, so that only distances and silhouettes count.
    limits.goal = DecimateGoal::distance;
    limits.fit_positions = true;
    limits.frames.normals = NormalWeight::angle;
    limits.frames.tangents = TangentMethod::none;
    asset_.mesh = decimated(surface, limits, report).mesh;
    if (asset_.mesh.triangles.empty()) throw InvalidInput("no triangle is left after decimation");
    low_parts_.clear();
    low_alpha_.clear();
    for (const std::uint32_t pair : detail::parts_of_ranges(asset_.mesh)) {
        if (!parts.empty()) low_parts_.push_back(pair / detail::alpha_count);
        if (!alpha.empty())
            low_alpha_.push_back(static_cast<AlphaMode>(pair % detail::alpha_count));
    }
    asset_.mesh.material_ranges.clear();
    const bool is_remeshed = closed_ || (options_.start && options_.start->is_remeshed);
    if (options_.repair && !is_remeshed && report.count("double-sided triangle") > 0)
        separate_sides(report);
    const double ratio =
        static_cast<double>(asset_.mesh.triangles.size()) / static_cast<double>(options_.triangles);
    evidence_.excess = std::max(0.0, ratio - 1.0);
}

void Maker::unwrap_mesh(Report& report) {
    UnwrapOptions unwrapping;
    unwrapping.size = options_.size;
    unwrapping.padding = options_.padding;
    unwrapping.split_hard = options_.crease_angle;
    unwrapping.execution = options_.execution;
    const Unwrapped unwrapped = unwrap(asset_.mesh, unwrapping, report);
    asset_.atlas = unwrapped.stats;
    evidence_.small_charts = detail::small_chart_area(asset_.mesh, unwrapped);
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
    match_parts(report);
    detail::bake_maps(source_, {high_, high_parts_, low_parts_, alpha_, low_alpha_}, options_,
                      asset_, report);
}

void Maker::run_stage(const std::string& name, void (Maker::*work)(Report&)) {
    std::vector<StageReport>& reports = asset_.reports;
    auto stage = std::ranges::find(reports, name, &StageReport::stage);
    if (stage == reports.end()) stage = reports.insert(stage, StageReport{name, {}});
    stage->report = {};  // Of a surface that was replaced.
    if (options_.run_stage) {
        options_.run_stage(name, [&] { (this->*work)(stage->report); });
    } else {
        (this->*work)(stage->report);
    }
    if (!options_.take_mesh || name == "bake") return;
    if (name == "remesh") {
        if (closed_) options_.take_mesh(name, {*closed_, {}, alpha_of_dense_surface()});
    } else if (name == "repair") {
        options_.take_mesh(name, {high_, high_parts_, detail::alpha_modes_of(high_, alpha_)});
    } else {
        const bool has_parts = !low_parts_.empty();
        options_.take_mesh(
            name,
            {asset_.mesh, has_parts ? NamedParts{high_parts_.names, low_parts_} : NamedParts{},
             low_alpha_});
    }
}

/// Decimates and unwraps.
void Maker::reduce() {
    if (!is_left_out(options_, "decimate")) run_stage("decimate", &Maker::decimate);
    if (!options_.keep_texcoords && !is_left_out(options_, "unwrap"))
        run_stage("unwrap", &Maker::unwrap_mesh);
}

Asset Maker::run() {
    check(options_);
    const ExecutionScope scope(options_.execution);
    asset_.name = source_.name;
    asset_.origin = source_.origin;
    run_stage("repair", &Maker::repair);
    if (options_.start) begin(*options_.start);
    if (always_remeshes(options_)) run_stage("remesh", &Maker::remesh);
    reduce();
    if (judges_remeshing(options_)) {
        run_stage("remesh", &Maker::judge);
        if (closed_) reduce();
    }
    if (!is_left_out(options_, "frames")) run_stage("frames", &Maker::compute_frames);
    run_stage("bake", &Maker::bake);
    return std::move(asset_);
}

}  // namespace

std::vector<std::string> stages_of(const AssetOptions& options) {
    std::vector<std::string> stages = {"repair"};
    if (always_remeshes(options)) stages.emplace_back("remesh");
    stages.emplace_back("decimate");
    if (!options.keep_texcoords) stages.emplace_back("unwrap");
    if (judges_remeshing(options)) stages.emplace_back("remesh");
    stages.insert(stages.end(), {"frames", "bake"});
    std::erase_if(stages, [&](const std::string& stage) { return is_left_out(options, stage); });
    return stages;
}

Asset make_asset(const AssetSource& source, const AssetOptions& options) {
    return Maker(source, options).run();
}

}  // namespace relief::make
