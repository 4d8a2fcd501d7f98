// SPDX-License-Identifier: Apache-2.0
// Intersects rays of view with height maps by the methods of relief mapping, and measures how far
// their points are from the first intersection, in texels along the map: on a plane, and on a
// cylinder and a torus, where the methods know only the plane of a triangle. Renders both, too.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "asset_report.h"
#include "bake/ray_scene.h"
#include "experiment_parts.h"
#include "portable_math.h"
#include "relief/mesh/height_march.h"
#include "relief/mesh/normals.h"
#include "rendered_methods.h"
#include "samples.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;

namespace detail {

namespace {

namespace portable = relief::detail::portable;
using relief::detail::Random;

/// A pixel is a miss if its point is farther than this from the first intersection, in texels.
constexpr double miss_distance = 1.0;

/// Cone maps of larger height maps of a user would take longer than everything else.
constexpr int max_texels_of_cones = 1 << 20;

struct ReliefMap {
    const char* id;
    const char* description;
    double depth;  ///< Of black, in texels.
    Image (*heights)(int side);
};

Image heights_over_square(int side, const std::function<double(double u, double v)>& height) {
    Image image = make_image(side, side, 1, 16, ColorSpace::data);
    const auto samples = image.as<std::uint16_t>();
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double h = std::clamp(height((x + 0.5) / side, (y + 0.5) / side), 0.0, 1.0);
            samples[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                    static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(h * 65535.0 + 0.5);
        }
    }
    return image;
}

Image fractal_heights(int side) {
    return heights_over_square(side, [](double u, double v) {
        return 0.5 + 0.45 * sample::tiling_octaves(u, v, 4, 4, 7);
    });
}

Image wave_map(int side) {
    return heights_over_square(side, [](double u, double v) {
        constexpr double turn = 2.0 * std::numbers::pi;
        return 0.5 + 0.2 * portable::sin(turn * (3.0 * u + v)) +
               0.15 * portable::cos(turn * (5.0 * v - 2.0 * u)) +
               0.1 * portable::sin(turn * 4.0 * u);
    });
}

/// Poles of two texels at distances of 32 texels.
Image pole_heights(int side) {
    return heights_over_square(side, [side](double u, double v) {
        const auto is_pole = [side](double at) { return static_cast<int>(at * side) % 32 < 2; };
        return is_pole(u) && is_pole(v) ? 1.0 : 0.2;
    });
}

constexpr std::array relief_maps = {
    ReliefMap{"bricks", "the wall of bricks of data/bricks-height.png", 12.0,
              sample::brick_heights},
    ReliefMap{"fractal", "smooth noise of four octaves", 24.0, fractal_heights},
    ReliefMap{"poles", "poles of 2 x 2 texels, 32 texels apart", 16.0, pole_heights},
    ReliefMap{"waves", "a sum of waves", 16.0, wave_map}};

/// Angles between the view and the normal of the plane, in degrees.
struct ViewBand {
    double from;
    double to;
};
constexpr std::array view_bands = {ViewBand{0.0, 30.0}, ViewBand{30.0, 45.0}, ViewBand{45.0, 70.0},
                                   ViewBand{70.0, 85.0}};

struct ReliefFields {
    HeightField heights;
    HeightField cones;
};

std::shared_ptr<const ReliefFields> fields_of(const ReliefMap& map, int side) {
    const HeightField heights(map.heights(side), Wrap::repeat);
    const HeightField cones(channel_of(relaxed_cones(heights), 1), Wrap::repeat);
    return std::make_shared<const ReliefFields>(ReliefFields{heights, cones});
}

/// A map with rays of view.
struct ReliefInput {
    std::shared_ptr<const ReliefFields> fields;
    std::vector<HeightRay> rays;
    std::vector<HeightHit> exact;
};

ReliefInput relief_input(std::shared_ptr<const ReliefFields> fields, double depth,
                         const ViewBand& band, std::size_t count) {
    ReliefInput input{std::move(fields), {}, {}};
    Random random(52);
    for (std::size_t i = 0; i < count; ++i) {
        HeightRay ray;
        ray.texcoord = {random.between(0.0, 1.0), random.between(0.0, 1.0)};
        const double angle = random.between(band.from, band.to) * std::numbers::pi / 180.0;
        const double azimuth = random.between(0.0, 2.0 * std::numbers::pi);
        const double slant = portable::tan(angle);
        ray.direction = {slant * portable::cos(azimuth), slant * portable::sin(azimuth), 1.0};
        ray.black_depth = depth;
        input.rays.push_back(ray);
        input.exact.push_back(input.fields->heights.first_hit(ray));
    }
    return input;
}

/// A surface that u and v from 0 to 1 cover, and which repeats a map so that its texels are squares
/// where the surface is not stretched.
struct CurvedSurface {
    const char* id;
    const char* description;
    glm::ivec2 repeats;
    glm::dvec2 rays;  ///< The range of v in which rays begin.
    /// Returns a point; lies outwards of the surface by a height.
    glm::dvec3 (*point)(const glm::dvec2& uv, double height);
    double (*area)(double v);  ///< Of the surface, by the area in u and v.
};

constexpr double full_turn = 2.0 * std::numbers::pi;
constexpr double tube_radius = 0.4;
constexpr double cylinder_length = full_turn / 4.0 * 2.0;  // As a fourth of the turn for each map.

constexpr std::array curved_surfaces = {
    CurvedSurface{"cylinder",
                  "a cylinder with 4 maps around it",
                  {4, 2},
                  {0.25, 0.75},
                  [](const glm::dvec2& uv, double height) {
                      const double turn = full_turn * uv.x;
                      return glm::dvec3((1.0 + height) * portable::sin(turn),
                                        cylinder_length * (0.5 - uv.y),
                                        (1.0 + height) * portable::cos(turn));
                  },
                  [](double) { return full_turn * cylinder_length; }},
    CurvedSurface{"torus",
                  "a torus with 5 maps around it and 2 around its tube",
                  {5, 2},
                  {0.0, 1.0},
                  [](const glm::dvec2& uv, double height) {
                      const double turn = full_turn * uv.x;
                      const double tube = full_turn * uv.y;
                      const double tall = tube_radius + height;
                      const double wide = 1.0 - tall * portable::cos(tube);
                      return glm::dvec3(wide * portable::sin(turn), tall * portable::sin(tube),
                                        wide * portable::cos(turn));
                  },
                  [](double v) {
                      const double wide = 1.0 - tube_radius * portable::cos(full_turn * v);
                      return full_turn * full_turn * tube_radius * wide;
                  }}};

glm::dvec3 normal_on(const CurvedSurface& surface, const glm::dvec2& uv) {
    return surface.point(uv, 1.0) - surface.point(uv, 0.0);
}

/// Returns the mesh of a surface whose vertices are at (i + offset) / cells; displaced inwards if
/// there are heights of a depth in texels.
Mesh curved_mesh(const CurvedSurface& surface, const glm::ivec2& cells, double offset,
                 const HeightField* heights = nullptr, double depth = 0.0) {
    Mesh mesh;
    for (int j = 0; j <= cells.y; ++j) {
        for (int i = 0; i <= cells.x; ++i) {
            const glm::dvec2 uv = (glm::dvec2(i, j) + offset) / glm::dvec2(cells);
            const glm::dvec2 texcoord = uv * glm::dvec2(surface.repeats);
            double height = 0.0;
            if (heights != nullptr) {
                const glm::dvec2 texels = glm::dvec2(heights->size() * surface.repeats);
                const double texel = std::sqrt(surface.area(uv.y) / (texels.x * texels.y));
                height = texel * depth * (heights->height(texcoord) - 1.0);
            }
            mesh.positions.emplace_back(surface.point(uv, height));
            mesh.texcoords.emplace_back(texcoord);
            if (heights == nullptr) mesh.normals.emplace_back(normal_on(surface, uv));
        }
    }
    const auto stride = static_cast<std::uint32_t>(cells.x + 1);
    for (std::uint32_t first = 0; first + stride < mesh.positions.size(); ++first) {
        if (first % stride + 1 == stride) continue;
        mesh.triangles.emplace_back(first, first + stride, first + stride + 1);
        mesh.triangles.emplace_back(first, first + stride + 1, first + 1);
    }
    return mesh;
}

glm::ivec2 cells_of(const CurvedSurface& surface) {
    return 32 * surface.repeats;
}

/// Returns the largest distance of the middles of the mesh's squares from the surface.
double distance_of_mesh(const CurvedSurface& surface) {
    const glm::dvec2 cells(cells_of(surface));
    double largest = 0.0;
    for (double j = 0.0; j < cells.y; j += 1.0) {
        const glm::dvec2 first = glm::dvec2(0.0, j) / cells;
        const glm::dvec2 last = glm::dvec2(1.0, j + 1.0) / cells;
        const glm::dvec3 middle = 0.5 * (surface.point(first, 0.0) + surface.point(last, 0.0));
        const glm::dvec3 off = middle - surface.point(0.5 * (first + last), 0.0);
        largest = std::max(largest, std::sqrt(glm::dot(off, off)));
    }
    return largest;
}

/// The surface with its heights as a mesh of a quad per texel.
struct DisplacedSurface {
    const CurvedSurface& surface;
    std::shared_ptr<const ReliefFields> fields;
    double depth;
    Mesh mesh = curved_mesh(surface, fields->heights.size() * surface.repeats, 0.5,
                            &fields->heights, depth);
    relief::detail::RayScene scene{{{mesh.positions, mesh.triangles}}};
};

/// Returns the ray of a view onto a triangle of the mesh, in texel space as in
/// shaders/height_march.glsl.
HeightRay ray_on_triangle(const std::array<glm::dvec3, 3>& corners,
                          const std::array<glm::dvec2, 3>& texels, const glm::dvec3& normal,
                          const glm::dvec3& direction) {
    const glm::dvec2 a = texels[1] - texels[0];
    const glm::dvec2 b = texels[2] - texels[0];
    const glm::dvec3 along_a = corners[1] - corners[0];
    const glm::dvec3 along_b = corners[2] - corners[0];
    const double area = a.x * b.y - a.y * b.x;
    const glm::dvec3 along_x = (along_a * b.y - along_b * a.y) / area;
    const glm::dvec3 along_y = (along_b * a.x - along_a * b.x) / area;
    const glm::dvec3 across = glm::cross(along_x, along_y);
    HeightRay ray;
    ray.direction = {glm::dot(normal, glm::cross(direction, along_y)) / glm::dot(normal, across),
                     glm::dot(normal, glm::cross(along_x, direction)) / glm::dot(normal, across),
                     -glm::dot(normal, direction) / std::sqrt(glm::length(across))};
    return ray;
}

/// Makes rays that meet the mesh of a curved surface at angles of a band. Those that pass the
/// relief are left out and counted.
ReliefInput curved_input(const DisplacedSurface& truth, const ViewBand& band, std::size_t count,
                         std::size_t& passing) {
    const CurvedSurface& surface = truth.surface;
    const glm::dvec2 size(truth.fields->heights.size());
    const glm::dvec2 repeats(surface.repeats);
    const glm::dvec2 cells(cells_of(surface));
    ReliefInput input{truth.fields, {}, {}};
    Random random(52);
    while (input.rays.size() < count) {
        const glm::dvec2 uv(random.between(0.0, 1.0),
                            random.between(surface.rays.x, surface.rays.y));
        const double angle = random.between(band.from, band.to) * std::numbers::pi / 180.0;
        const double azimuth = random.between(0.0, full_turn);
        const glm::dvec2 cell = glm::floor(uv * cells);
        const glm::dvec2 in = uv * cells - cell;
        // The corners, and the weights of the last two.
        const bool is_lower = in.y > in.x;
        const std::array<glm::dvec2, 3> at = {
            cell / cells, (cell + (is_lower ? glm::dvec2(0, 1) : glm::dvec2(1, 0))) / cells,
            (cell + 1.0) / cells};
        const glm::dvec3 weights = is_lower ? glm::dvec3(1.0 - in.y, in.y - in.x, in.x)
                                            : glm::dvec3(1.0 - in.x, in.x - in.y, in.y);
        std::array<glm::dvec3, 3> corners;
        std::array<glm::dvec2, 3> texels;
        glm::dvec3 point(0.0);
        glm::dvec3 normal(0.0);
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = surface.point(at[i], 0.0);
            texels[i] = at[i] * repeats * size;
            point += weights[static_cast<int>(i)] * corners[i];
            normal += weights[static_cast<int>(i)] * normal_on(surface, at[i]);
        }
        normal /= std::sqrt(glm::dot(normal, normal));
        const glm::dvec3 side = glm::normalize(corners[1] - corners[0]);
        const glm::dvec3 right = glm::normalize(side - glm::dot(side, normal) * normal);
        const glm::dvec3 aside =
            portable::cos(azimuth) * right + portable::sin(azimuth) * glm::cross(normal, right);
        const glm::dvec3 direction = -portable::cos(angle) * normal + portable::sin(angle) * aside;
        HeightRay ray = ray_on_triangle(corners, texels, normal, direction);
        ray.texcoord = uv * repeats;
        ray.black_depth = truth.depth;
        // The relief lies within twice the way through it on a plane, where the surface is convex.
        const double texel = -glm::dot(normal, direction) / ray.direction.z;
        const double before = 8.0 * texel;
        const double way = before + 2.0 * truth.depth / ray.direction.z;
        const relief::detail::RayHit hit =
            truth.scene.nearest({point - before * direction, direction, 0.0, way});
        if (!hit.is_hit()) {
            ++passing;
            continue;
        }
        glm::dvec2 found(0.0);
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t vertex = truth.mesh.triangles[hit.triangle][i];
            const int stride = surface.repeats.x * truth.fields->heights.size().x + 1;
            const int column = static_cast<int>(vertex) % stride;
            const int row = static_cast<int>(vertex) / stride;
            const glm::dvec2 vertex_at(column, row);
            found += hit.weights[i] * (vertex_at + 0.5) / (repeats * size);
        }
        // The nearest of the coordinates of the point.
        found -= glm::floor(found - uv + 0.5);
        HeightHit exact;
        exact.texcoord = found * repeats;
        exact.slope = truth.depth * truth.fields->heights.slope(exact.texcoord);
        input.rays.push_back(ray);
        input.exact.push_back(exact);
    }
    return input;
}

/// A method; without one, only the normal map is looked up, where the ray meets the plane.
struct ReliefMethod {
    std::string name;
    std::optional<HeightMarch> march;
    double bytes;  ///< Per texel, with heights of 16 bits.
};

std::vector<ReliefMethod> relief_methods() {
    constexpr double heights = 2.0;
    std::vector<ReliefMethod> methods{{"normal map", std::nullopt, 0.0}};
    const auto add = [&](const std::string& settings, HeightMethod method, int layers,
                         double bytes) {
        HeightMarch march;
        march.method = method;
        march.layers = layers;
        std::string name = enum_name(method);
        std::replace(name.begin(), name.end(), '_', ' ');
        if (!settings.empty()) name += " " + settings;
        methods.push_back({name, march, bytes});
    };
    add("", HeightMethod::parallax, 1, heights);
    for (const int layers : {8, 16, 32, 128})
        add(fmt::format("{}", layers), HeightMethod::parallax_occlusion, layers, heights);
    for (const int layers : {16, 32})
        add(fmt::format("{}+6", layers), HeightMethod::relief_mapping, layers, heights);
    for (const int layers : {16, 64})
        add(fmt::format("{}+6", layers), HeightMethod::relaxed_cones, layers, heights + 4.0);
    add("", HeightMethod::maximum_mipmaps, 1, heights * 4.0 / 3.0);
    return methods;
}

HeightHit hit_by(const ReliefMethod& method, const ReliefFields& fields, const HeightRay& ray) {
    if (method.march) return fields.heights.march(ray, *method.march, &fields.cones);
    HeightHit hit;
    hit.texcoord = ray.texcoord;
    hit.slope = ray.black_depth * fields.heights.slope(ray.texcoord);
    return hit;
}

/// The errors of a method over all rays.
struct ReliefErrors {
    ErrorStats texels;
    double rms_degrees = 0.0;
    double misses = 0.0;        ///< Fraction of the rays.
    double miss_squares = 0.0;  ///< The fraction of the squared errors that is that of misses.
    double lookups = 0.0;       ///< Mean.
    std::size_t exceeded = 0;   ///< Rays beyond the bound on steps.
};

/// Returns a squared distance, which is 0 below a billionth: that is the rounding of coordinates.
double without_rounding(double square) {
    constexpr double rounding = 1e-9;
    return square < rounding * rounding ? 0.0 : square;
}

ReliefErrors errors_of(const ReliefMethod& method, const ReliefInput& input) {
    ReliefErrors errors;
    std::vector<float> distances;
    double squares = 0.0;
    double squares_of_misses = 0.0;
    double squared_degrees = 0.0;
    std::size_t misses = 0;
    const glm::dvec2 size(input.fields->heights.size());
    for (std::size_t i = 0; i < input.rays.size(); ++i) {
        const HeightHit hit = hit_by(method, *input.fields, input.rays[i]);
        const HeightHit& exact = input.exact[i];
        const glm::dvec2 aside = (hit.texcoord - exact.texcoord) * size;
        const double square = without_rounding(glm::dot(aside, aside));
        const double degrees =
            degrees_between(glm::dvec3(-hit.slope, 1.0), glm::dvec3(-exact.slope, 1.0));
        distances.push_back(static_cast<float>(std::sqrt(square)));
        squares += square;
        squared_degrees += without_rounding(degrees * degrees);
        errors.lookups += hit.lookups;
        errors.exceeded += hit.end == HeightRayEnd::exceeded ? 1 : 0;
        if (square <= miss_distance * miss_distance) continue;
        ++misses;
        squares_of_misses += square;
    }
    const auto count = static_cast<double>(input.rays.size());
    errors.texels = error_stats(std::move(distances));
    errors.rms_degrees = std::sqrt(squared_degrees / count);
    errors.misses = static_cast<double>(misses) / count;
    errors.miss_squares = squares > 0.0 ? squares_of_misses / squares : 0.0;
    errors.lookups /= count;
    return errors;
}

std::string note_of(const ReliefErrors& errors) {
    std::string note = fmt::format("{:.3g} % misses, {:.3g} degrees RMS, {:.1f} lookups",
                                   100.0 * errors.misses, errors.rms_degrees, errors.lookups);
    if (errors.exceeded > 0) note += fmt::format(", {} rays beyond the steps", errors.exceeded);
    return note;
}

const ReliefMethod& method_named(const std::vector<ReliefMethod>& methods,
                                 const std::string& name) {
    return *std::find_if(methods.begin(), methods.end(),
                         [&](const ReliefMethod& one) { return one.name == name; });
}

/// States what the misses mean for the choice of a method, or what no method can reduce.
std::string relief_finding(const ReliefInput& input) {
    const std::vector<ReliefMethod> methods = relief_methods();
    const auto errors = [&](const char* name) {
        return errors_of(method_named(methods, name), input);
    };
    const ReliefErrors exact = errors("maximum mipmaps");
    const ReliefErrors layers = errors("relief mapping 16+6");
    const ReliefErrors more = errors("parallax occlusion 128");
    const std::string lookups =
        fmt::format(", with {:.1f} lookups, {:.2g} times those of 'parallax occlusion 128', which",
                    exact.lookups, exact.lookups / more.lookups);
    if (exact.texels.max > 0.0) {
        return fmt::format(
            "The curvature, which the plane of a triangle does not have, limits all methods: "
            "'maximum mipmaps', exact on the plane, has an RMS error of {:.2g} texels and misses "
            "{:.2g} % of the rays{} misses {:.2g} %. 'parallax occlusion 16' has {:.2g} texels.",
            exact.texels.rms, 100.0 * exact.misses, lookups, 100.0 * more.misses,
            errors("parallax occlusion 16").texels.rms);
    }
    std::string text = fmt::format(
        "'maximum mipmaps' is exact to rounding for every ray{} misses {:.2g} % of the "
        "rays.",
        lookups, 100.0 * more.misses);
    if (layers.misses > 0.0) {
        text += fmt::format(
            " Misses are {:.2g} % of the rays of 'relief mapping 16+6', but {:.0f} % of its "
            "squared error, which more bisections do not reduce; 'relaxed cones 16+6' ends before "
            "the surface on {:.2g} %.",
            100.0 * layers.misses, 100.0 * layers.miss_squares,
            100.0 * errors("relaxed cones 16+6").misses);
    }
    return text;
}

/// The error over the angle of view.
Chart angle_chart(const std::function<ReliefInput(const ViewBand& band)>& input_of) {
    std::vector<ReliefMethod> methods = relief_methods();
    std::erase_if(methods, [](const ReliefMethod& one) {
        return one.name.ends_with(" 8") || one.name.ends_with(" 32");
    });
    std::vector<std::string> names;
    for (const ReliefMethod& one : methods)
        names.push_back(one.name);
    Chart chart{.id = "angles",
                .title = "Slanted views",
                .x_label = "degrees from the normal",
                .y_label = "RMS error, texels",
                .is_x_log = false};
    return chart_over(
        std::move(chart), names, {10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 85.0},
        [&](double angle) {
            return input_of({angle, angle});
        },
        [&](std::size_t i, const ReliefInput& input) {
            return errors_of(methods[i], input).texels.rms;
        });
}

/// Describes an experiment on rays, and adds its methods.
PreparedExperiment relief_of(const std::string& ground_truth, const std::string& description,
                             const std::shared_ptr<const ReliefInput>& input) {
    PreparedExperiment prepared;
    prepared.report = {.question = "Which method finds where a ray of view meets the heights?",
                       .ground_truth = ground_truth,
                       .input = description,
                       .error_unit = "texels",
                       .item = "ray",
                       .items = static_cast<double>(input->rays.size())};
    for (const ReliefMethod& method : relief_methods()) {
        prepared.methods.push_back({.name = method.name,
                                    .choices = {{"method", method.name}},
                                    .error =
                                        [method, input] {
                                            const ReliefErrors errors = errors_of(method, *input);
                                            return MethodError(errors.texels, note_of(errors));
                                        },
                                    .work =
                                        [method, input] {
                                            double sum = 0.0;
                                            for (const HeightRay& ray : input->rays)
                                                sum += hit_by(method, *input->fields, ray).depth;
                                            volatile double result = sum;
                                            (void)result;
                                        },
                                    .stored_bytes = method.bytes});
    }
    prepared.costs.all_threads = false;
    prepared.costs.memory = false;
    prepared.finish = [input](Experiment& report) { report.finding = relief_finding(*input); };
    return prepared;
}

std::string name_of(const ViewBand& band) {
    return fmt::format("{:g}-{:g}", band.from, band.to);
}

PreparedExperiment plane_experiment(const ReliefMap& map, const ViewBand& band,
                                    const SharedInput<ReliefFields>& shared, bool is_quick) {
    const std::shared_ptr<const ReliefFields> fields = shared.get();
    const auto input_of = [fields, &map](const ViewBand& one, std::size_t rays) {
        return relief_input(fields, map.depth, one, rays);
    };
    const int side = fields->heights.size().x;
    PreparedExperiment prepared = relief_of(
        "The first intersection with the bilinear patches between texels, from the roots of their "
        "quadratics in double precision. Tests compare it with the displaced mesh of a quad per "
        "texel, which other code intersects.",
        fmt::format("{}, {} x {} texels, {:g} deep, on a plane; {:g} to {:g} degrees from its "
                    "normal",
                    map.description, side, side, map.depth, band.from, band.to),
        std::make_shared<const ReliefInput>(input_of(band, is_quick ? 2'000 : 60'000)));
    if (band.from != 45.0) return prepared;
    prepared.finish = [input_of, is_quick, finish = prepared.finish](Experiment& report) {
        finish(report);
        report.charts = {
            angle_chart([&](const ViewBand& at) { return input_of(at, is_quick ? 500 : 10'000); })};
    };
    return prepared;
}

PreparedExperiment curved_experiment(const ReliefMap& map, const ViewBand& band,
                                     const SharedInput<DisplacedSurface>& truth, bool is_quick) {
    std::size_t passing = 0;
    const auto input = std::make_shared<const ReliefInput>(
        curved_input(*truth.get(), band, is_quick ? 2'000 : 20'000, passing));
    const CurvedSurface& surface = truth.get()->surface;
    const glm::ivec2 cells = cells_of(surface);
    const int side = input->fields->heights.size().x;
    const double texel = full_turn / (surface.repeats.x * side);
    return relief_of(
        "The curved surface displaced with one quad per texel, on which the baker's rays are cast.",
        fmt::format(
            "{}, {} x {} texels, {:g} deep, on {}: {} x {} squares, at most {:.2g} texels from it; "
            "{:g} to {:g} degrees from its normal; {:.2g} % of the rays pass the relief and are "
            "left out",
            map.description, side, side, map.depth, surface.description, cells.x, cells.y,
            distance_of_mesh(surface) / texel, band.from, band.to,
            100.0 * static_cast<double>(passing) /
                static_cast<double>(passing + input->rays.size())),
        input);
}

/// The surface with the heights as its colors, which a method displaces; or the displaced mesh.
shade::Scene curved_scene(const DisplacedSurface& truth, const ReliefMethod* method,
                          const Image& heights, const Image& cones) {
    Mesh mesh =
        method != nullptr ? curved_mesh(truth.surface, cells_of(truth.surface), 0.0) : truth.mesh;
    if (method == nullptr)
        mesh.normals = vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle);
    Material material;
    material.ambient = material.diffuse = glm::vec3(1.0F);
    material.diffuse_texture = Texture{0};
    if (method != nullptr) {
        const auto depth = static_cast<float>(truth.depth);
        material.bump_map = BumpMap{Texture{0}, depth};
        if (method->march) {
            const HeightMarch& march = *method->march;
            material.height_map =
                relief::ReliefMap{Texture{0},       depth,           march.method, march.layers,
                                  march.bisections, march.max_steps, Texture{1}};
        }
    }
    shade::Scene scene = lit_scene(std::move(mesh), material);
    scene.images = {{"heights", heights}, {"cones", cones}};
    scene.camera = lit_scene(curved_mesh(truth.surface, cells_of(truth.surface), 0.0), {}).camera;
    scene.camera->vertical_fov = 0.2F;  // So that texels are not smaller than pixels.
    return scene;
}

/// Renders all methods and the displaced mesh, for their times in OpenGL.
PreparedExperiment drawn_experiment(const ReliefMap& map,
                                    const SharedInput<DisplacedSurface>& shared,
                                    const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    const std::shared_ptr<const DisplacedSurface> truth = shared.get();
    const int side = truth->fields->heights.size().x;
    const Image heights = map.heights(side);
    const Image cones = relaxed_cones(truth->fields->heights);
    std::vector<RenderedMethod> methods;
    for (const ReliefMethod& method : relief_methods()) {
        methods.push_back({method.name, {{"method", method.name}}, [=](double) {
                               return Rendering{curved_scene(*truth, &method, heights, cones), 4};
                           }});
        methods.back().stored_bytes = method.bytes;
    }
    methods.push_back({"displaced mesh", {{"method", "displaced mesh"}}, [=](double) {
                           return Rendering{curved_scene(*truth, nullptr, heights, cones), 4};
                       }});
    methods.back().stored_bytes = 56.0;
    methods.back().note = "Bytes are those of a vertex and two triangles for each texel.";
    return prepare_rendering(
        options.device.get(),
        {.report = {.question = "What does relief mapping cost in the renderer, and how near is it "
                                "to real geometry?",
                    .ground_truth =
                        "The reference shader in double on the curved surface displaced "
                        "with one quad per texel, mean of 4 rays per pixel.",
                    .input = fmt::format("{}, {} x {} texels, {:g} deep, on {}, {} x {} pixels",
                                         map.description, side, side, map.depth,
                                         truth->surface.description, size, size)},
         .size = size,
         .methods = methods,
         .ground_truth =
             [=] {
                 return supersampled_reference(curved_scene(*truth, nullptr, heights, cones), size,
                                               2);
             },
         .compared = {"normal map", "parallax occlusion 16", "maximum mipmaps", "displaced mesh"},
         .shown = {0, methods.size() - 2},
         .title = "Relief mapping",
         .brightest = 0.3});
}

}  // namespace

std::vector<PlannedExperiment> relief_plan(const PlanOptions& options) {
    const int side = options.is_quick ? 128 : 256;
    std::vector<PlannedExperiment> plan;
    const auto add = [&](const std::string& id, const std::string& title, const auto& prepare) {
        plan.push_back({"relief/" + id, "Relief mapping: " + title, prepare});
    };
    const auto fields_of_map = [side](const ReliefMap& map) {
        return SharedInput<ReliefFields>([&map, side] { return fields_of(map, side); });
    };
    for (const ReliefMap& map : relief_maps) {
        const SharedInput<ReliefFields> fields = fields_of_map(map);
        for (const ViewBand& band : view_bands) {
            add(fmt::format("{}-{}", map.id, name_of(band)),
                fmt::format("{}, {:g} to {:g} degrees", map.id, band.from, band.to),
                [=, &map](const PlanOptions& all) {
                    return plane_experiment(map, band, fields, all.is_quick);
                });
        }
    }
    const ReliefMap& bricks = relief_maps.front();
    const SharedInput<ReliefFields> fields = fields_of_map(bricks);
    for (const CurvedSurface& surface : curved_surfaces) {
        const SharedInput<DisplacedSurface> truth([&surface, fields] {
            return std::shared_ptr<const DisplacedSurface>(
                new DisplacedSurface{surface, fields.get(), bricks.depth});
        });
        for (const ViewBand& band : view_bands) {
            add(fmt::format("{}-{}", surface.id, name_of(band)),
                fmt::format("{}, {:g} to {:g} degrees", surface.id, band.from, band.to),
                [=](const PlanOptions& all) {
                    return curved_experiment(bricks, band, truth, all.is_quick);
                });
        }
        add(fmt::format("{}-drawn", surface.id), fmt::format("{}, rendered", surface.id),
            [=](const PlanOptions& all) { return drawn_experiment(bricks, truth, all); });
    }
    return plan;
}

}  // namespace detail

AssetExperiment measure_asset_relief(const Image& heights, const Wraps& wraps, double depth,
                                     const glm::dvec2& degrees, const AssetOptions& options) {
    AssetExperiment asset = asset_experiment(Subject::relief, "relief", "Relief mapping", options);
    Report report;
    const HeightField field(heights, wraps, report);
    const bool has_cones = field.size().x * field.size().y <= max_texels_of_cones;
    const auto fields = std::make_shared<const ReliefFields>(ReliefFields{
        field, has_cones ? HeightField(channel_of(relaxed_cones(field), 1), wraps) : field});
    PreparedExperiment prepared = relief_of(
        "The first intersection with the bilinear patches between texels, in double precision.",
        fmt::format("{} x {} texels, {:g} deep, on a plane; {:g} to {:g} degrees from its normal{}",
                    field.size().x, field.size().y, depth, degrees.x, degrees.y,
                    has_cones ? "" : "; too large for a cone map"),
        std::make_shared<const ReliefInput>(relief_input(fields, depth, {degrees.x, degrees.y},
                                                         options.run.is_quick ? 2'000 : 20'000)));
    for (const ReliefMethod& method : relief_methods()) {
        if (!method.march) continue;
        const HeightMethod kind = method.march->method;
        std::string& command =
            std::find_if(prepared.methods.begin(), prepared.methods.end(), [&](const Method& one) {
                return one.name == method.name;
            })->command;
        command = fmt::format(
            "relief-view MODEL --height-map {} --height-depth {:g} "
            "--height-method {}",
            options.arguments, depth, enum_name(kind));
        if (kind != HeightMethod::parallax && kind != HeightMethod::maximum_mipmaps)
            command += fmt::format(" --height-layers {}", method.march->layers);
        if (kind == HeightMethod::relaxed_cones) command += " --cone-map CONES.png";
    }
    if (!has_cones) {
        std::erase_if(prepared.methods,
                      [](const Method& one) { return one.name.starts_with("relaxed"); });
    }
    Experiment& described = prepared.report;
    std::swap(described.id, asset.experiment.id);
    described.subject = asset.experiment.subject;
    described.title = asset.experiment.title;
    described.command = asset.experiment.command;
    asset.experiment = std::move(described);
    AssetOptions own = options;
    own.costs.all_threads = own.costs.memory = false;
    own.request.max_error.reset();  // A limit is in degrees.
    detail::finish(asset, prepared.methods, {.negligible_error = 0.01}, own);
    return asset;
}

}  // namespace relief::accuracy
