// SPDX-License-Identifier: Apache-2.0
// The health check of a mesh, and its parts, on a sound mesh and on shapes for which a comparison
// of all pairs would take hours. The time per triangle should be similar for all shapes.
#include "relief/mesh/diagnose.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mesh/bumpy_sphere.h"
#include "relief/mesh/execution.h"

namespace relief::bench {
namespace {

constexpr std::uint32_t triangles_diagnosed = 1'000'000;

Mesh bare_sphere() {
    return bumpy_sphere(triangles_diagnosed);
}

/// Adds a vertex on the unit circle, in space and in the image.
void add_on_circle(Mesh& mesh, std::uint32_t i, float height) {
    const double angle = 2.0 * std::numbers::pi * i / triangles_diagnosed;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), height);
    mesh.texcoords.emplace_back(std::cos(angle), std::sin(angle));
}

/// All triangles share one vertex, in space and in the image.
Mesh textured_fan() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}};
    mesh.texcoords = {{0, 0}};
    for (std::uint32_t i = 0; i < triangles_diagnosed; ++i) {
        add_on_circle(mesh, i, 0.0F);
        mesh.triangles.emplace_back(0, i + 1, (i + 1) % triangles_diagnosed + 1);
    }
    return mesh;
}

/// All triangles share one edge.
Mesh book() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}};
    mesh.texcoords = {{0, 0}, {0, 1}};
    for (std::uint32_t i = 0; i < triangles_diagnosed; ++i) {
        add_on_circle(mesh, i, 0.5F);
        mesh.triangles.emplace_back(0, 1, i + 2);
    }
    return mesh;
}

/// Triangles at random positions, each with the whole image.
Mesh soup() {
    Mesh mesh;
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> anywhere(0.0F, 1.0F);
    const auto random = [&] {
        return glm::vec3(anywhere(generator), anywhere(generator), anywhere(generator));
    };
    for (std::uint32_t i = 0; i < triangles_diagnosed; ++i) {
        const glm::vec3 place = random();
        for (int k = 0; k < 3; ++k) {
            mesh.positions.push_back(place + 0.01F * random());
            mesh.texcoords.emplace_back(k == 1 ? 1.0F : 0.0F, k == 2 ? 1.0F : 0.0F);
        }
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return mesh;
}

/// All vertices have the same position.
Mesh point() {
    Mesh mesh;
    mesh.positions.assign(triangles_diagnosed, glm::vec3(1, 2, 3));
    for (std::uint32_t i = 0; i < triangles_diagnosed; ++i)
        mesh.triangles.emplace_back(i, (i + 1) % triangles_diagnosed,
                                    (i + 2) % triangles_diagnosed);
    return mesh;
}

void diagnosis(benchmark::State& state, Mesh (*make)(), const DiagnoseOptions& options) {
    const Mesh mesh = make();
    set_thread_limit(static_cast<unsigned>(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(diagnose(mesh, options));
    set_thread_limit(0);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
}

constexpr DiagnoseOptions least = {
    .edges = false, .near_duplicates = false, .texture_overlap = false};

DiagnoseOptions with(bool DiagnoseOptions::*part) {
    DiagnoseOptions options = least;
    options.*part = true;
    return options;
}

#define RELIEF_DIAGNOSIS(name, make, options)         \
    BENCHMARK_CAPTURE(diagnosis, name, make, options) \
        ->ArgName("threads")                          \
        ->Arg(1)                                      \
        ->Arg(2)                                      \
        ->UseRealTime()                               \
        ->Unit(benchmark::kMillisecond)

RELIEF_DIAGNOSIS(sphere_values, bare_sphere, least);
RELIEF_DIAGNOSIS(sphere_edges, bare_sphere, with(&DiagnoseOptions::edges));
RELIEF_DIAGNOSIS(sphere_near_duplicates, bare_sphere, with(&DiagnoseOptions::near_duplicates));
RELIEF_DIAGNOSIS(sphere_texture_overlap, bare_sphere, with(&DiagnoseOptions::texture_overlap));
RELIEF_DIAGNOSIS(bare_sphere, bare_sphere, DiagnoseOptions{});
RELIEF_DIAGNOSIS(textured_fan, textured_fan, DiagnoseOptions{});
RELIEF_DIAGNOSIS(book, book, DiagnoseOptions{});
RELIEF_DIAGNOSIS(soup, soup, DiagnoseOptions{});
RELIEF_DIAGNOSIS(point, point, DiagnoseOptions{});

}  // namespace
}  // namespace relief::bench
