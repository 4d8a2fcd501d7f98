// SPDX-License-Identifier: Apache-2.0
// Unwraps a smooth, a noisy and a sharp-edged surface by different options, and measures the
// stretch, the unused texels, the time and the memory.
#include "experiment_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>

#include "portable_math.h"
#include "relief/mesh/unwrap.h"

namespace relief::accuracy::detail {
using namespace relief::detail;

Mesh wavy_sphere(int cells, double noise) {
    const auto n = static_cast<std::uint32_t>(cells);
    // Steps of equal angles; exactly symmetric, so that the sides of the cube have common edges.
    std::vector<double> steps(n + 1, 0.0);
    for (std::uint32_t i = 0; 2 * i < n; ++i) {
        const double angle = std::numbers::pi / 4.0 * (1.0 - 2.0 * i / static_cast<double>(n));
        steps[i] = i == 0 ? -1.0 : -portable::tan(angle);
        steps[n - i] = -steps[i];
    }
    const auto position = [&](const glm::uvec3& place) {
        const glm::dvec3 p =
            glm::normalize(glm::dvec3(steps[place.x], steps[place.y], steps[place.z]));
        const auto waves = [&](const glm::dvec3& frequency, const glm::dvec3& phase) {
            const glm::dvec3 angles = frequency * p + phase;
            return portable::sin(angles.x) * portable::sin(angles.y) * portable::sin(angles.z);
        };
        const std::uint32_t seed = place.x + (place.y << 10) + (place.z << 20);
        const double radius = 1.0 + 0.08 * waves({7, 6, 8}, {1, 2, 0.5}) +
                              0.03 * waves({23, 19, 21}, {0, 1, 2}) + noise * Random(seed).normal();
        return glm::vec3(radius * p);
    };
    Mesh mesh;
    for (std::uint32_t side = 0; side < 6; ++side) {
        const auto axis = static_cast<glm::length_t>(side / 2);
        const bool is_far = side % 2 == 1;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::uint32_t j = 0; j <= n; ++j) {
            for (std::uint32_t i = 0; i <= n; ++i) {
                glm::uvec3 place;
                place[axis] = is_far ? n : 0;
                place[(axis + 1) % 3] = i;
                place[(axis + 2) % 3] = is_far ? j : n - j;
                mesh.positions.push_back(position(place));
                const glm::dvec2 square(side % 3, side / 3);
                const glm::dvec2 inside(i / static_cast<double>(n),
                                        1.0 - j / static_cast<double>(n));
                mesh.texcoords.emplace_back((square + 0.02 + 0.96 * inside) / glm::dvec2(3.0, 2.0));
            }
        }
        for (std::uint32_t j = 0; j < n; ++j) {
            for (std::uint32_t i = 0; i < n; ++i) {
                const std::uint32_t corner = first + j * (n + 1) + i;
                mesh.triangles.emplace_back(corner, corner + 1, corner + n + 2);
                mesh.triangles.emplace_back(corner, corner + n + 2, corner + n + 1);
            }
        }
    }
    return mesh;
}

Mesh gear_wheel(int teeth, int cells) {
    constexpr double half_thickness = 0.2;
    const auto n = static_cast<std::uint32_t>(cells);
    std::vector<glm::dvec2> outline;
    for (int corner = 0; corner < 4 * teeth; ++corner) {
        const auto at = [&](int index) {
            const double angle = 2.0 * std::numbers::pi * index / (4.0 * teeth);
            const double radius = index % 4 < 2 ? 1.0 : 0.8;
            return radius * glm::dvec2(portable::cos(angle), portable::sin(angle));
        };
        const glm::dvec2 from = at(corner);
        const glm::dvec2 to = at((corner + 1) % (4 * teeth));
        for (std::uint32_t i = 0; i < n; ++i)
            outline.push_back(glm::mix(from, to, i / static_cast<double>(n)));
    }
    // Rings from the middle of the lower side over the flanks to the middle of the upper side.
    const auto around = static_cast<std::uint32_t>(outline.size());
    const std::uint32_t rings = 3 * n;
    Mesh mesh;
    mesh.positions.emplace_back(0.0, 0.0, -half_thickness);
    for (std::uint32_t ring = 1; ring < rings; ++ring) {
        const double scale =
            std::min({1.0, ring / static_cast<double>(n), (rings - ring) / static_cast<double>(n)});
        const double height =
            half_thickness *
            (2.0 * (std::clamp(ring, n, 2 * n) - n) / static_cast<double>(n) - 1.0);
        for (const glm::dvec2& point : outline)
            mesh.positions.emplace_back(scale * point.x, scale * point.y, height);
    }
    mesh.positions.emplace_back(0.0, 0.0, half_thickness);
    const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t next = (i + 1) % around;
        mesh.triangles.emplace_back(0, 1 + next, 1 + i);
        mesh.triangles.emplace_back(last, last - around + i, last - around + next);
        for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
            const std::uint32_t lower = 1 + (ring - 1) * around;
            const std::uint32_t upper = lower + around;
            mesh.triangles.emplace_back(lower + i, lower + next, upper + next);
            mesh.triangles.emplace_back(lower + i, upper + next, upper + i);
        }
    }
    return mesh;
}

ErrorStats stretch_errors(const Mesh& mesh, std::span<const glm::vec2> corner_texcoords,
                          const glm::ivec2& size) {
    constexpr std::size_t count = 20'000;
    struct Stretch {
        double largest = 0.0;
        double smallest = 0.0;  ///< Singular values, texels per unit.
    };
    std::vector<Stretch> triangles(mesh.triangles.size());
    double area = 0.0;
    double texels = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& v = mesh.triangles[t];
        const glm::dvec3 origin(mesh.positions[v.x]);
        const glm::dvec3 first = glm::dvec3(mesh.positions[v.y]) - origin;
        const glm::dvec3 second = glm::dvec3(mesh.positions[v.z]) - origin;
        const double length = glm::length(first);
        const double height = glm::length(glm::cross(first, second)) / length;
        if (!(length > 0.0 && height > 0.0)) continue;
        const double along = glm::dot(first, second) / length;
        const auto texel = [&](std::size_t corner) {
            return glm::dvec2(corner_texcoords[3 * t + corner]) * glm::dvec2(size);
        };
        // The columns of the map from an orthonormal basis of the triangle to texels.
        const glm::dvec2 x = (texel(1) - texel(0)) / length;
        const glm::dvec2 y = (texel(2) - texel(0) - along * x) / height;
        const double squares = glm::dot(x, x) + glm::dot(y, y);
        const double product = std::abs(x.x * y.y - x.y * y.x);
        const double sum = std::sqrt(squares + 2.0 * product);
        const double difference = std::sqrt(std::max(squares - 2.0 * product, 0.0));
        area += 0.5 * length * height;
        texels += 0.5 * length * height * product;
        triangles[t] = {0.5 * (sum + difference), 0.5 * (sum - difference)};
    }
    const double density = std::sqrt(texels / area);
    std::vector<float> errors;
    for (const TriangleSample& sample : area_samples(mesh, count)) {
        const Stretch& one = triangles[sample.triangle];
        const double factor = one.smallest > 0.0
                                  ? std::max(one.largest / density, density / one.smallest)
                                  : std::numeric_limits<double>::quiet_NaN();
        errors.push_back(static_cast<float>(100.0 * (factor - 1.0)));
    }
    return error_stats(std::move(errors));
}

namespace {

using UnwrappingMethod = MethodOn<Mesh, Unwrapped>;

/// \param text  the options of relief-mesh unwrap
UnwrappingMethod method_of(const std::string& name, const std::string& text,
                           const UnwrapOptions& options) {
    return {
        name, {{"options", text}}, [options](const Mesh& mesh) { return unwrap(mesh, options); }};
}

UnwrapOptions usual_options(int size) {
    UnwrapOptions options;
    options.size = glm::ivec2(size);
    return options;
}

/// Returns the usual options with one member changed.
template <typename Value>
UnwrapOptions with(UnwrapOptions options, Value UnwrapOptions::*member,
                   const std::type_identity_t<Value>& value) {
    options.*member = value;
    return options;
}

/// \param has_texcoords  methods that need existing charts are included
std::vector<UnwrappingMethod> chart_methods(int size, bool has_texcoords) {
    using Options = UnwrapOptions;
    const Options usual = usual_options(size);
    std::vector<UnwrappingMethod> methods;
    const auto add = [&](const std::string& name, const std::string& text, const Options& options) {
        if (has_texcoords || !(options.repack || options.keep_seams))
            methods.push_back(method_of(name, text, options));
    };
    add("existing charts", "--repack", with(usual, &Options::repack, true));
    add("default", "none", usual);
    add("keep seams", "--keep-seams", with(usual, &Options::keep_seams, true));
    add("conformal", "--flatten conformal",
        with(usual, &Options::flattening, Flattening::conformal));
    add("split hard edges", "--split-hard 30",
        with(usual, &Options::split_hard, std::numbers::pi / 6.0));
    for (const double limit : {1.5, 1.2, 1.1})
        add(fmt::format("within {}", limit), fmt::format("--max-stretch {}", limit),
            with(usual, &Options::max_stretch, limit));
    return methods;
}

std::vector<UnwrappingMethod> packing_methods(int size) {
    using Options = UnwrapOptions;
    const Options usual = usual_options(size);
    std::vector<UnwrappingMethod> methods;
    for (const int padding : {0, 2, 4, 8, 16})
        methods.push_back(method_of(fmt::format("padding {}", padding),
                                    fmt::format("--padding {}", padding),
                                    with(usual, &Options::padding, padding)));
    methods.push_back(
        method_of("padding 4, blocks of 4", "--align 4", with(usual, &Options::alignment, 4)));
    methods.push_back(method_of("padding 4, four tiles",
                                fmt::format("--size {} --udim 4", size / 2),
                                with(usual_options(size / 2), &Options::tiles, 4)));
    return methods;
}

std::string note_on(const AtlasStats& stats) {
    return fmt::format(
        "{} {}, {:.1f} % used, seams {:.3g} times the root of the area, mean ratio of scales "
        "{:.3f}",
        stats.charts, stats.charts == 1 ? "chart" : "charts", 100.0 * stats.used,
        stats.relative_seam_length, stats.mean_anisotropy);
}

/// The quantity that an error of an unwrapping measures.
enum class UnwrappingError { stretch, unused_texels };

ErrorStats error_of(const Unwrapped& result, const Mesh& mesh, int size, UnwrappingError kind) {
    if (kind == UnwrappingError::stretch)
        return stretch_errors(mesh, result.corner_texcoords, glm::ivec2(size));
    return error_stats({static_cast<float>(100.0 * (1.0 - result.stats.used))});
}

/// An experiment without its question and ground truth.
PreparedExperiment unwrapping_of(const std::shared_ptr<const Mesh>& mesh,
                                 const std::string& description, int size,
                                 const std::vector<UnwrappingMethod>& methods,
                                 UnwrappingError kind) {
    PreparedExperiment prepared;
    prepared.report.input = fmt::format("{}, {} triangles, for {} x {} texels", description,
                                        mesh->triangles.size(), size, size);
    prepared.report.error_unit = "%";
    prepared.report.item = "triangle";
    prepared.report.items = static_cast<double>(mesh->triangles.size());
    prepared.costs.memory = false;
    prepared.methods = methods_on(mesh, methods, [=](const UnwrappingMethod& method) {
        const Unwrapped result = method.compute(*mesh);
        return MethodError(error_of(result, *mesh, size, kind), note_on(result.stats));
    });
    return prepared;
}

/// The unused texels and the part of them that the padding takes, over the padding.
Chart padding_chart(const Mesh& mesh, int size) {
    Chart chart{.id = "padding",
                .title = "More padding",
                .x_label = "padding, texels",
                .y_label = "texels that charts do not cover, %",
                .curves = {{.method = "unused"}, {.method = "padding alone"}}};
    for (const int padding : {1, 2, 4, 8, 16}) {
        const AtlasStats stats =
            unwrap(mesh, with(usual_options(size), &UnwrapOptions::padding, padding)).stats;
        chart.curves[0].points.push_back({1.0 * padding, 100.0 * (1.0 - stats.used)});
        chart.curves[1].points.push_back(
            {1.0 * padding, 100.0 * stats.padding_share.value_or(0.0)});
    }
    return chart;
}

PreparedExperiment unwrapping_texels(Mesh given, const std::string& description, int size) {
    const auto mesh = std::make_shared<const Mesh>(std::move(given));
    PreparedExperiment prepared = unwrapping_of(mesh, description, size, packing_methods(size),
                                                UnwrappingError::unused_texels);
    prepared.report.question = "How many texels of the map stay unused?";
    prepared.report.ground_truth =
        "A map that charts cover completely. Tests compare the covered area with the sum of the "
        "areas of all triangles, which do not overlap.";
    prepared.finish = [mesh, size](Experiment& report) {
        report.charts = {padding_chart(*mesh, size)};
    };
    return prepared;
}

PreparedExperiment unwrapping_of_large_mesh(const PlanOptions& options) {
    const int size = options.is_quick ? 512 : 2048;
    const auto mesh = std::make_shared<const Mesh>(wavy_sphere(options.is_quick ? 32 : 289, 0.0));
    std::vector<UnwrappingMethod> methods = chart_methods(size, true);
    std::erase_if(methods, [](const UnwrappingMethod& method) {
        return method.name != "default" && method.name != "keep seams";
    });
    PreparedExperiment prepared =
        unwrapping_of(mesh, "sphere with waves", size, methods, UnwrappingError::stretch);
    prepared.report.question = "How much time and memory does the unwrapping of a large mesh cost?";
    prepared.report.ground_truth =
        "The same lengths on the surface, at the mean density of texels.";
    prepared.costs.memory = true;
    return prepared;
}

}  // namespace

PreparedExperiment unwrapping_stretch(Mesh given, const std::string& description, int size) {
    const auto mesh = std::make_shared<const Mesh>(std::move(given));
    PreparedExperiment prepared =
        unwrapping_of(mesh, description, size, chart_methods(size, !mesh->texcoords.empty()),
                      UnwrappingError::stretch);
    prepared.report.question = "Which options stretch the surface least, and what do they cost?";
    prepared.report.ground_truth =
        "The same lengths on the surface, at the mean density of texels. The error is how much "
        "longer or shorter a line becomes in the map at most, at points that are spread evenly "
        "over the surface. Tests verify it for maps with a known stretch.";
    return prepared;
}

std::vector<PlannedExperiment> unwrapping_plan(const PlanOptions& options) {
    const bool is_quick = options.is_quick;
    const int size = is_quick ? 512 : 2048;
    const int cells = is_quick ? 16 : 64;
    const auto noisy = [cells] { return wavy_sphere(cells, 0.002); };
    return {{"unwrapping/smooth-stretch", "Unwrapping: smooth surface, stretch",
             [=](const auto&) {
                 return unwrapping_stretch(wavy_sphere(cells, 0.0), "sphere with waves", size);
             }},
            {"unwrapping/noisy-stretch", "Unwrapping: noisy surface, stretch",
             [=](const auto&) {
                 return unwrapping_stretch(noisy(), "sphere with waves and noise", size);
             }},
            {"unwrapping/sharp-stretch", "Unwrapping: sharp edges, stretch",
             [=](const auto&) {
                 return unwrapping_stretch(gear_wheel(12, is_quick ? 3 : 16), "gear", size);
             }},
            {"unwrapping/noisy-texels", "Unwrapping: noisy surface, unused texels",
             [=](const auto&) {
                 return unwrapping_texels(noisy(), "sphere with waves and noise", size);
             }},
            {"unwrapping/large", "Unwrapping: a large mesh", unwrapping_of_large_mesh}};
}

}  // namespace relief::accuracy::detail
