// SPDX-License-Identifier: Apache-2.0
#include "relief/mesh/unwrap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "atlas/atlas_stats.h"
#include "atlas/charts.h"
#include "atlas/existing_charts.h"
#include "atlas/flat_charts.h"
#include "atlas/injectivity.h"
#include "atlas/packing.h"
#include "atlas/stack.h"
#include "atlas/surface.h"
#include "atlas/tiles.h"
#include "geometry/corner_texcoords.h"
#include "progress_stage.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Coordinates are multiples of one part in so many of the map. With tiles, whose coordinates are
/// up to 10, floats have four bits less.
constexpr double lattice_of_map = 16777216.0;
constexpr double lattice_of_tile = 1048576.0;
constexpr int tiles_per_row = 10;
double lattice_size_of(const UnwrapOptions& options) {
    return options.tiles == 1 ? lattice_of_map : lattice_of_tile;
}
/// The share of the map that charts are expected to cover, before they are packed.
constexpr double expected_use = 0.65;
/// The length of a chart, in sides of the map, above which it is divided instead of shrinking all
/// charts.
constexpr double max_overlength = 1.25;
/// The same for several tiles: each should have several charts, so that all can be filled.
constexpr double max_overlength_of_tiles = 0.75;

void check(const UnwrapOptions& options, const Mesh& mesh) {
    const auto refuse = [](const std::string& what, double value, const std::string& range) {
        throw InvalidInput(fmt::format("{} is {}, but must be {}", what, value, range));
    };
    for (const int side : {options.size.x, options.size.y})
        if (side < 16 || side > 65536) refuse("the size of the map", side, "16 to 65536 texels");
    if (options.padding < 0 || options.padding > 256)
        refuse("the padding", options.padding, "0 to 256 texels");
    if (options.tiles < 1 || options.tiles > 100)
        refuse("the number of tiles", options.tiles, "1 to 100");
    if (!(options.max_stretch > 1.0)) refuse("the stretch limit", options.max_stretch, "above 1");
    if (options.alignment < 1 || options.alignment > 64)
        refuse("the alignment", options.alignment, "1 to 64 texels");
    if (options.split_hard &&
        !(*options.split_hard >= 0.0 && *options.split_hard <= std::numbers::pi))
        refuse("the angle of hard edges", *options.split_hard, "0 to pi");
    if (options.texels_per_unit &&
        !(*options.texels_per_unit > 0.0 && std::isfinite(*options.texels_per_unit)))
        refuse("the density", *options.texels_per_unit, "finite and above 0 texels per unit");
    if (!options.densities.empty() && options.densities.size() != mesh.triangles.size())
        throw InvalidInput(fmt::format("there are {} densities for {} triangles",
                                       options.densities.size(), mesh.triangles.size()));
    for (const float each : options.densities)
        if (!(each > 0.0F && std::isfinite(each)))
            refuse("a relative density", static_cast<double>(each), "finite and above 0");
    check_parts(mesh, options.first_vertices);
}

/// A single triangle may be so small or thin that its corners round to a line.
void widen_single_triangle(const FlatChart& chart, std::vector<LatticePoint>& points) {
    if (chart.mesh.faces.size() != 1 || orientation(points[0], points[1], points[2]) > 0) return;
    const glm::uvec3& v = chart.mesh.vertices[0];
    const LatticePoint first = points[v.x];
    points[v.y] = first + LatticePoint(1, 0);
    points[v.z] = first + LatticePoint(0, 1);
}

/// The map, or the tiles, into which charts are packed.
struct Layout {
    PackingOptions packing;
    int tiles = 1;
    double lattice_size = lattice_of_map;
};

/// A chart on the lattice of the map; y points up. Its points may be in one place.
std::vector<LatticePoint> lattice_points(const FlatChart& chart, const Placement& placement,
                                         double texels_per_unit, const Layout& layout) {
    const glm::dvec2 steps = layout.lattice_size / glm::dvec2(layout.packing.size);
    std::vector<LatticePoint> points;
    points.reserve(chart.coordinates.size());
    for (const glm::dvec2& each : chart.coordinates) {
        const glm::dvec2 p = placed(each, placement, texels_per_unit) * steps + 0.5;
        points.emplace_back(static_cast<int>(std::clamp(p.x, 0.0, layout.lattice_size)),
                            static_cast<int>(std::clamp(p.y, 0.0, layout.lattice_size)));
    }
    return points;
}

/// A chart in its place on the lattice.
struct PlacedChart {
    std::vector<std::uint32_t> faces;
    std::vector<glm::uvec3> vertices;  ///< For each of `faces`.
    std::vector<LatticePoint> points;  ///< In the tile, for each vertex.
    int tile = 0;
};

/// Moves what the coordinates need out of charts: large meshes leave little memory for the rest.
std::vector<PlacedChart> placed_charts(std::vector<FlatChart> charts,
                                       std::vector<std::vector<LatticePoint>> points,
                                       std::span<const int> tiles) {
    std::vector<PlacedChart> result;
    for (std::size_t i = 0; i < charts.size(); ++i)
        result.push_back({std::move(charts[i].mesh.faces), std::move(charts[i].mesh.vertices),
                          std::move(points[i]), tiles[i]});
    return result;
}

/// Scales charts by the mean density of their triangles.
class DensityScale {
  public:
    /// \param densities  of the triangles of the mesh; empty: equal
    DensityScale(const AtlasSurface& surface, std::span<const float> densities)
        : surface_(surface) {
        if (densities.empty()) return;
        for (const std::uint32_t triangle : triangles_of_faces(surface))
            density_.push_back(static_cast<double>(densities[triangle]));
    }
    void apply(FlatChart& chart) const {
        if (density_.empty()) return;
        double sum = 0.0;
        for (const std::uint32_t face : chart.mesh.faces)
            sum += surface_.areas[face] * density_[face];
        const double scale = sum / chart.area;
        for (glm::dvec2& each : chart.coordinates)
            each *= scale;
        chart.size *= scale;
        chart.area *= scale * scale;
    }

  private:
    const AtlasSurface& surface_;
    std::vector<double> density_;  ///< Of each face.
};

/// Packs charts, and divides those that overlap themselves once they are rounded at their place,
/// until there is none.
std::vector<PlacedChart> packed_atlas(const AtlasSurface& surface, std::vector<FlatChart> charts,
                                      ChartMembers& members, const FlatnessLimits& limits,
                                      const DensityScale& density, const Layout& layout) {
    for (;;) {
        const TiledPacking tiled = packed_into_tiles(charts, layout.packing, layout.tiles);
        const Packing& packing = tiled.packing;
        std::vector<std::vector<LatticePoint>> points;
        std::vector<std::optional<std::uint32_t>> problems;
        for (std::size_t i = 0; i < charts.size(); ++i) {
            points.push_back(
                lattice_points(charts[i], packing.placements[i], packing.texels_per_unit, layout));
            widen_single_triangle(charts[i], points[i]);
            problems.push_back(overlap_in(charts[i].mesh, points[i]));
        }
        if (std::none_of(problems.begin(), problems.end(),
                         [](const auto& problem) { return problem.has_value(); }))
            return placed_charts(std::move(charts), std::move(points), tiled.tile);
        std::vector<FlatChart> next;
        for (std::size_t i = 0; i < charts.size(); ++i) {
            if (!problems[i]) {
                next.push_back(std::move(charts[i]));
                continue;
            }
            for (FlatChart& part :
                 divided_further(surface, members, charts[i], *problems[i], limits)) {
                density.apply(part);
                next.push_back(std::move(part));
            }
        }
        charts = std::move(next);
    }
}

/// Returns the result of a stage of unwrapping.
template <typename Work>
auto during(const char* name, const Work& work) {
    const ProgressStage stage(name);
    return work();
}

/// Divides a surface into charts, and packs them.
std::vector<PlacedChart> new_atlas(const AtlasSurface& surface, const UnwrapOptions& options,
                                   Layout layout) {
    Segmentation segmentation = during("dividing into charts", [&] {
        Segmentation merged = divided(surface, ChartLimits{});
        straighten_borders(surface, merged);
        return merged;
    });

    const double area = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
    const glm::dvec2 size(options.size);
    // Triangles cannot be divided, so that the longest edge must fit into the map.
    double longest = 0.0;
    for (Corner edge = 0; edge < surface.opposite.size(); ++edge)
        longest = std::max(longest, surface.edge_length(edge));
    const double texels_per_unit =
        options.texels_per_unit
            ? *options.texels_per_unit * surface.unit
            : std::min(std::sqrt(expected_use * options.tiles * size.x * size.y / area),
                       std::max(size.x, size.y) / longest);
    FlatnessLimits limits;
    limits.method = options.flattening;
    limits.max_stretch = options.max_stretch;
    limits.lattice_scale = texels_per_unit * layout.lattice_size / std::max(size.x, size.y);
    limits.texel = 1.0 / texels_per_unit;
    limits.padding = options.padding;
    limits.max_side = (options.tiles == 1 ? max_overlength : max_overlength_of_tiles) *
                      std::max(size.x, size.y) / texels_per_unit;
    ChartMembers members(segmentation.chart);
    std::vector<FlatChart> charts = during(
        "flattening charts", [&] { return flat_charts(surface, segmentation, members, limits); });
    segmentation = {};
    if (options.texels_per_unit) layout.packing.texels_per_unit = texels_per_unit;
    const DensityScale density(surface, options.densities);
    for (FlatChart& chart : charts)
        density.apply(chart);
    return packed_atlas(surface, std::move(charts), members, limits, density, layout);
}

/// Packs existing charts, and reports those that overlap themselves.
std::vector<PlacedChart> repacked_atlas(std::vector<FlatChart> charts, const Layout& layout,
                                        Report& report) {
    std::vector<std::vector<LatticePoint>> all_points;
    const TiledPacking tiled = packed_into_tiles(charts, layout.packing, layout.tiles);
    const Packing& packing = tiled.packing;
    for (std::size_t i = 0; i < charts.size(); ++i) {
        std::vector<LatticePoint> points =
            lattice_points(charts[i], packing.placements[i], packing.texels_per_unit, layout);
        all_points.push_back(points);
        // Mirrored charts have their own finding.
        const auto reflect = [](LatticePoint p) { return LatticePoint(-p.x, p.y); };
        if (!overlap_in(charts[i].mesh, points)) continue;
        std::transform(points.begin(), points.end(), points.begin(), reflect);
        if (overlap_in(charts[i].mesh, points))
            report.add("chart with overlapping or inverted triangles", "chart", i,
                       "keeps its shape");
    }
    return placed_charts(std::move(charts), std::move(all_points), tiled.tile);
}

/// Texture coordinates from lattice coordinates: v points down, and tiles are numbered to the right
/// and up. The result is exact.
glm::vec2 texcoord_of(const LatticePoint& point, int tile, double lattice_size) {
    const int column = tile % tiles_per_row;
    const int row = tile / tiles_per_row;
    return {static_cast<float>(point.x / lattice_size + column),
            static_cast<float>((lattice_size - point.y) / lattice_size - row)};
}

/// Fills the coordinates and charts of triangles. \return the charts of faces
FaceCharts fill_corners(const AtlasSurface& surface, std::span<const PlacedChart> atlas,
                        double lattice_size, Unwrapped& result) {
    const std::size_t triangle_count = surface.face_of_triangle.size();
    result.corner_texcoords.assign(3 * triangle_count, glm::vec2(0.0F));
    result.chart.assign(triangle_count, std::nullopt);
    struct Place {
        std::uint32_t chart = 0, index = 0;
    };
    std::vector<Place> places(surface.faces.size());
    FaceCharts charts{std::vector<std::uint32_t>(surface.faces.size()), atlas.size()};
    for (std::uint32_t c = 0; c < atlas.size(); ++c) {
        const std::vector<std::uint32_t>& faces = atlas[c].faces;
        for (std::uint32_t i = 0; i < faces.size(); ++i) {
            places[faces[i]] = {c, i};
            charts.chart[faces[i]] = c;
        }
    }
    for (std::size_t t = 0; t < triangle_count; ++t) {
        const std::uint32_t face = surface.face_of_triangle[t];
        if (face == no_face) continue;
        const Place& place = places[face];
        result.chart[t] = place.chart;
        const PlacedChart& chart = atlas[place.chart];
        const glm::uvec3& v = chart.vertices[place.index];
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t corner = (i + surface.first_corner[t]) % 3;
            result.corner_texcoords[3 * t + corner] = texcoord_of(
                chart.points[v[static_cast<glm::length_t>(i)]], chart.tile, lattice_size);
        }
    }
    return charts;
}

/// Measures the result, with what depends on the number of tiles and on the padding.
AtlasStats stats_of(const AtlasSurface& surface, std::span<const glm::vec2> corner_texcoords,
                    const FaceCharts& charts, const UnwrapOptions& options) {
    AtlasStats stats = detail::stats_of(surface, corner_texcoords, charts, options.size);
    stats.used /= options.tiles;
    const double half = 0.5 * options.padding;
    const double texels =
        stats.perimeter * half + static_cast<double>(stats.charts) * std::numbers::pi * half * half;
    stats.padding_share =
        texels / (static_cast<double>(options.size.x) * options.size.y * options.tiles);
    stats.safe_mip_level = safe_mip_level(options.padding);
    return stats;
}

}  // namespace

Unwrapped unwrap(const Mesh& mesh, const UnwrapOptions& options, Report& report) {
    validate(mesh);
    check(options, mesh);
    const ExecutionScope scope(options.execution);
    const ProgressStage stage("unwrapping");
    if (options.stack) return stacked(mesh, options, report);
    Unwrapped result;
    const AtlasSurface surface = during("joining triangles", [&] {
        return atlas_surface(mesh,
                             {options.split_materials, options.keep_seams || options.repack,
                              options.split_hard, options.first_vertices, options.densities},
                             report);
    });
    if (surface.faces.empty()) {
        fill_corners(surface, {}, 1.0, result);
        return result;
    }
    Layout layout{{options.size, options.padding, options.alignment, std::nullopt},
                  options.tiles,
                  lattice_size_of(options)};
    if (options.repack) {
        if (options.texels_per_unit)
            layout.packing.texels_per_unit = *options.texels_per_unit * surface.unit;
        const std::vector<PlacedChart> atlas = repacked_atlas(
            existing_charts(surface, mesh, options.size, options.unmirror, report), layout, report);
        const FaceCharts face_charts = fill_corners(surface, atlas, layout.lattice_size, result);
        result.stats = stats_of(surface, result.corner_texcoords, face_charts, options);
        return result;
    }
    std::vector<PlacedChart> atlas = new_atlas(surface, options, layout);
    const ProgressStage measuring("measuring charts");
    const FaceCharts face_charts = fill_corners(surface, atlas, layout.lattice_size, result);
    atlas = {};  // Measuring needs memory too.
    result.stats = stats_of(surface, result.corner_texcoords, face_charts, options);
    return result;
}

FramedMesh with_texcoords(const Mesh& mesh, const Unwrapped& unwrapped) {
    FramedMesh result = with_corner_texcoords(mesh, unwrapped.corner_texcoords);
    result.mesh.tangents.clear();
    return result;
}

}  // namespace relief
