// SPDX-License-Identifier: Apache-2.0
// The health check of a mesh, whole and in parts, on a sound mesh and on shapes for which looking
// at pairs would take hours: none may take much longer for each triangle than the others.
#include "relief/mesh/diagnose.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mesh/bumpy_sphere.h"
#include "relief/mesh/threads.h"

namespace relief::bench {
namespace {

constexpr std::uint32_t count = 1'000'000;

Mesh sphere() {
    return bumpy_sphere(count);
}

/// A point of the unit circle, in the plane of the image as well.
void add_on_circle(Mesh& mesh, std::uint32_t i, float height) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), height);
    mesh.texcoords.emplace_back(std::cos(angle), std::sin(angle));
}

/// All triangles around one vertex, in space and in the image.
Mesh fan() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}};
    mesh.texcoords = {{0, 0}};
    for (std::uint32_t i = 0; i < count; ++i) {
        add_on_circle(mesh, i, 0.0F);
        mesh.triangles.emplace_back(0, i + 1, (i + 1) % count + 1);
    }
    return mesh;
}

/// All triangles on one edge.
Mesh book() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}};
    mesh.texcoords = {{0, 0}, {0, 1}};
    for (std::uint32_t i = 0; i < count; ++i) {
        add_on_circle(mesh, i, 0.5F);
        mesh.triangles.emplace_back(0, 1, i + 2);
    }
    return mesh;
}

/// Triangles anywhere, each with the whole image on it.
Mesh soup() {
    Mesh mesh;
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> anywhere(0.0F, 1.0F);
    const auto random = [&] {
        return glm::vec3(anywhere(generator), anywhere(generator), anywhere(generator));
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 place = random();
        for (int k = 0; k < 3; ++k) {
            mesh.positions.push_back(place + 0.01F * random());
            mesh.texcoords.emplace_back(k == 1 ? 1.0F : 0.0F, k == 2 ? 1.0F : 0.0F);
        }
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return mesh;
}

/// All vertices at one place.
Mesh point() {
    Mesh mesh;
    mesh.positions.assign(count, glm::vec3(1, 2, 3));
    for (std::uint32_t i = 0; i < count; ++i)
        mesh.triangles.emplace_back(i, (i + 1) % count, (i + 2) % count);
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

RELIEF_DIAGNOSIS(sphere_values, sphere, least);
RELIEF_DIAGNOSIS(sphere_edges, sphere, with(&DiagnoseOptions::edges));
RELIEF_DIAGNOSIS(sphere_near_duplicates, sphere, with(&DiagnoseOptions::near_duplicates));
RELIEF_DIAGNOSIS(sphere_texture_overlap, sphere, with(&DiagnoseOptions::texture_overlap));
RELIEF_DIAGNOSIS(sphere, sphere, DiagnoseOptions{});
RELIEF_DIAGNOSIS(fan, fan, DiagnoseOptions{});
RELIEF_DIAGNOSIS(book, book, DiagnoseOptions{});
RELIEF_DIAGNOSIS(soup, soup, DiagnoseOptions{});
RELIEF_DIAGNOSIS(point, point, DiagnoseOptions{});

}  // namespace
}  // namespace relief::bench
