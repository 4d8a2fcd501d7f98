// SPDX-License-Identifier: Apache-2.0
// Relief mapping on a cylinder and a torus, against the surface displaced with one quad per texel:
// the errors of methods that know only the plane of a triangle, and of those that know its
// curvature. Renders both, too.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bake/ray_scene.h"
#include "portable_math.h"
#include "relief/mesh/normals.h"
#include "relief_parts.h"
#include "rendered_methods.h"
#include "samples.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;

namespace detail {

namespace {

namespace portable = relief::detail::portable;
using relief::detail::Random;

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

/// A ray of view in texel space, with the curvature of the triangle below it.
struct RayOnTriangle {
    HeightRay ray;
    HeightCurvature curvature;
};

/// Returns the ray of a view onto a triangle of the mesh, in texel space as in
/// shaders/height_march.glsl.
/// \param normal  unit, interpolated of `normals` at the corners with a length of `length`
RayOnTriangle ray_on_triangle(const std::array<glm::dvec3, 3>& corners,
                              const std::array<glm::dvec2, 3>& texels,
                              const std::array<glm::dvec3, 3>& normals, const glm::dvec3& normal,
                              double length, const glm::dvec3& direction) {
    const glm::dvec2 a = texels[1] - texels[0];
    const glm::dvec2 b = texels[2] - texels[0];
    const glm::dvec3 along_a = corners[1] - corners[0];
    const glm::dvec3 along_b = corners[2] - corners[0];
    const double area = a.x * b.y - a.y * b.x;
    const glm::dvec3 along_x = (along_a * b.y - along_b * a.y) / area;
    const glm::dvec3 along_y = (along_b * a.x - along_a * b.x) / area;
    const glm::dvec3 across = glm::cross(along_x, along_y);
    RayOnTriangle result;
    result.ray.direction = {
        glm::dot(normal, glm::cross(direction, along_y)) / glm::dot(normal, across),
        glm::dot(normal, glm::cross(along_x, direction)) / glm::dot(normal, across),
        -glm::dot(normal, direction) / std::sqrt(glm::length(across))};
    const glm::dvec3 normal_a = normals[1] - normals[0];
    const glm::dvec3 normal_b = normals[2] - normals[0];
    result.curvature = height_curvature(length * normal, along_x, along_y,
                                        (normal_a * b.y - normal_b * a.y) / area,
                                        (normal_b * a.x - normal_a * b.x) / area);
    return result;
}

/// The rays that pass the displaced surface.
struct PassingRays {
    std::size_t count = 0;
    std::size_t leaving = 0;  ///< Those that leave the relief that curves with the surface.
};

/// Makes rays that meet the mesh of a curved surface at angles of a band. Those that pass the
/// relief are left out and counted.
ReliefInput curved_input(const DisplacedSurface& truth, const ViewBand& band, std::size_t count,
                         PassingRays& passing) {
    const CurvedSurface& surface = truth.surface;
    const glm::dvec2 size(truth.fields->heights.size());
    const glm::dvec2 repeats(surface.repeats);
    const glm::dvec2 cells(cells_of(surface));
    ReliefInput input{truth.fields, {}, {}, {}};
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
        std::array<glm::dvec3, 3> normals;
        glm::dvec3 point(0.0);
        glm::dvec3 normal(0.0);
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = surface.point(at[i], 0.0);
            texels[i] = at[i] * repeats * size;
            point += weights[static_cast<int>(i)] * corners[i];
            normals[i] = normal_on(surface, at[i]);
            normal += weights[static_cast<int>(i)] * normals[i];
        }
        const double length = std::sqrt(glm::dot(normal, normal));
        normal /= length;
        const glm::dvec3 side = glm::normalize(corners[1] - corners[0]);
        const glm::dvec3 right = glm::normalize(side - glm::dot(side, normal) * normal);
        const glm::dvec3 aside =
            portable::cos(azimuth) * right + portable::sin(azimuth) * glm::cross(normal, right);
        const glm::dvec3 direction = -portable::cos(angle) * normal + portable::sin(angle) * aside;
        auto [ray, curvature] =
            ray_on_triangle(corners, texels, normals, normal, length, direction);
        ray.texcoord = uv * repeats;
        ray.black_depth = truth.depth;
        const HeightRay curved = curved_ray(ray, curvature).ray;
        // The relief lies within twice the way through it on a plane, where the surface is convex.
        const double texel = -glm::dot(normal, direction) / ray.direction.z;
        const double before = 8.0 * texel;
        const double way = before + 2.0 * truth.depth / ray.direction.z;
        const relief::detail::RayHit hit =
            truth.scene.nearest({point - before * direction, direction, 0.0, way});
        if (!hit.is_hit()) {
            ++passing.count;
            const HeightHit met = truth.fields->heights.first_hit(curved);
            passing.leaving += met.end == HeightRayEnd::left ? 1 : 0;
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
        input.curved.push_back(curved);
        input.exact.push_back(exact);
    }
    return input;
}

/// Prepares the experiment on a curved surface in one band of angles.
PreparedExperiment curved_experiment(const ReliefSample& map, const ViewBand& band,
                                     const SharedInput<DisplacedSurface>& truth, bool is_quick) {
    PassingRays passing;
    const auto input = std::make_shared<const ReliefInput>(
        curved_input(*truth.get(), band, is_quick ? 2'000 : 20'000, passing));
    const CurvedSurface& surface = truth.get()->surface;
    const glm::ivec2 cells = cells_of(surface);
    const int side = input->fields->heights.size().x;
    const double texel = full_turn / (surface.repeats.x * side);
    const auto count = static_cast<double>(passing.count);
    const std::string leaving =
        passing.count == 0
            ? ""
            : fmt::format(", of which {:.3g} % leave it where it curves with the surface",
                          100.0 * static_cast<double>(passing.leaving) / count);
    return relief_of(
        "The curved surface displaced with one quad per texel, on which the baker's rays are cast.",
        fmt::format(
            "{}, {} x {} texels, {:g} deep, on {}: {} x {} squares, at most {:.2g} texels from it; "
            "{:g} to {:g} degrees from its normal; {:.2g} % of the rays pass the relief and are "
            "left out{}",
            map.description, side, side, map.depth, surface.description, cells.x, cells.y,
            distance_of_mesh(surface) / texel, band.from, band.to,
            100.0 * count / (count + static_cast<double>(input->rays.size())), leaving),
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
            if (method->is_curved) material.height_map->silhouette = ReliefSilhouette::curve;
        }
    }
    shade::Scene scene = lit_scene(std::move(mesh), material);
    scene.images = {{"heights", heights}, {"cones", cones}};
    scene.camera = lit_scene(curved_mesh(truth.surface, cells_of(truth.surface), 0.0), {}).camera;
    scene.camera->vertical_fov = 0.2F;  // So that texels are not smaller than pixels.
    return scene;
}

/// Renders all methods and the displaced mesh, for their times in OpenGL.
PreparedExperiment drawn_experiment(const ReliefSample& map,
                                    const SharedInput<DisplacedSurface>& shared,
                                    const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    const std::shared_ptr<const DisplacedSurface> truth = shared.get();
    const int side = truth->fields->heights.size().x;
    const Image heights = map.heights(side);
    const Image cones = relaxed_cones(truth->fields->heights);
    std::vector<RenderedMethod> methods;
    for (const ReliefMethod& method : relief_methods(true)) {
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
         .compared = {"normal map", "parallax occlusion 16", "maximum mipmaps",
                      "parallax occlusion 16 curved", "maximum mipmaps curved", "displaced mesh"},
         .shown = {0, methods.size() - 2},
         .title = "Relief mapping",
         .brightest = 0.3});
}

}  // namespace

std::vector<PlannedExperiment> curved_relief_plan(const ReliefSample& map,
                                                  const SharedInput<ReliefFields>& fields) {
    std::vector<PlannedExperiment> plan;
    const auto add = [&](const std::string& id, const std::string& title, const auto& prepare) {
        plan.push_back({"relief/" + id, "Relief mapping: " + title, prepare});
    };
    for (const CurvedSurface& surface : curved_surfaces) {
        const SharedInput<DisplacedSurface> truth([&surface, &map, fields] {
            return std::shared_ptr<const DisplacedSurface>(
                new DisplacedSurface{surface, fields.get(), map.depth});
        });
        for (const ViewBand& band : view_bands) {
            add(fmt::format("{}-{}", surface.id, name_of(band)),
                fmt::format("{}, {:g} to {:g} degrees", surface.id, band.from, band.to),
                [=, &map](const PlanOptions& all) {
                    return curved_experiment(map, band, truth, all.is_quick);
                });
        }
        add(fmt::format("{}-drawn", surface.id), fmt::format("{}, rendered", surface.id),
            [=, &map](const PlanOptions& all) { return drawn_experiment(map, truth, all); });
    }
    return plan;
}

}  // namespace detail

}  // namespace relief::accuracy
