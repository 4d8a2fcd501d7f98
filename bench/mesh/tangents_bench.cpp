// SPDX-License-Identifier: Apache-2.0
// Tangents in the caller's memory and with a Workspace, interleaved with a naive loop and with a
// triad over memory: `relief-tangents-bench [TRIANGLES [ROUNDS]]` prints tables in Markdown.
// `relief-tangents-bench shapes` measures shapes on which a search for neighbors, a recursion or a
// comparison of sets can need quadratic time. `relief-tangents-bench reference LIBRARY [TRIANGLES
// [ROUNDS]]` compares with MikkTSpace's reference implementation in a shared library, which is not
// part of the project.
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "bench_support.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/tangents.h"

namespace relief::bench {
namespace {

// Meshes.

void add_vertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal,
                const glm::dvec2& texcoord) {
    mesh.positions.emplace_back(position);
    mesh.normals.emplace_back(normal);
    mesh.texcoords.emplace_back(texcoord);
}

/// A square of hills with about `triangles` triangles. The texture is projected from above.
Mesh displaced_grid(std::size_t triangles) {
    const auto cells = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 2.0));
    Mesh mesh;
    for (std::uint32_t row = 0; row <= cells; ++row) {
        for (std::uint32_t column = 0; column <= cells; ++column) {
            const double x = static_cast<double>(column) / cells;
            const double y = static_cast<double>(row) / cells;
            // The hills have two sizes and slopes of at most 45 degrees.
            const auto slope = [](double at, double waves) { return 0.35 * std::cos(waves * at); };
            const double height = 0.35 * (std::sin(20.0 * x) / 20.0 + std::sin(20.0 * y) / 20.0 +
                                          std::sin(90.0 * x) / 90.0 + std::sin(90.0 * y) / 90.0);
            const glm::dvec3 normal(-slope(x, 20.0) - slope(x, 90.0),
                                    -slope(y, 20.0) - slope(y, 90.0), 1.0);
            add_vertex(mesh, {x, y, height}, glm::normalize(normal), {x, 1.0 - y});
        }
    }
    for (std::uint32_t row = 0; row < cells; ++row) {
        for (std::uint32_t column = 0; column < cells; ++column) {
            const std::uint32_t lower = row * (cells + 1) + column;
            const std::uint32_t upper = lower + cells + 1;
            mesh.triangles.emplace_back(lower, lower + 1, upper + 1);
            mesh.triangles.emplace_back(lower, upper + 1, upper);
        }
    }
    return mesh;
}

/// A disc of triangles that share one vertex.
Mesh fan(std::size_t triangles) {
    const auto count = static_cast<std::uint32_t>(triangles);
    Mesh mesh;
    add_vertex(mesh, {0, 0, 0}, {0, 0, 1}, {0.5, 0.5});
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        const glm::dvec2 rim(std::cos(angle), std::sin(angle));
        add_vertex(mesh, {rim, 0}, {0, 0, 1}, glm::dvec2(0.5) + 0.5 * glm::dvec2(rim.x, -rim.y));
        mesh.triangles.emplace_back(0, i + 1, (i + 1) % count + 1);
    }
    return mesh;
}

/// Triangles that share one edge, like the pages of a book. Half of them have the other
/// orientation.
Mesh book(std::size_t triangles) {
    const auto count = static_cast<std::uint32_t>(triangles);
    Mesh mesh;
    add_vertex(mesh, {0, 0, 0}, {0, 0, 1}, {0, 0});
    add_vertex(mesh, {0, 1, 0}, {0, 0, 1}, {0, 1});
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = std::numbers::pi * i / count;
        add_vertex(mesh, {std::cos(angle), 0.5, std::sin(angle)}, {0, 0, 1},
                   {1.0 + i % 7, 0.3 * (i % 5)});
        mesh.triangles.emplace_back(i % 2, 1 - i % 2, i + 2);
    }
    return mesh;
}

/// The grid with all vertices at one point.
Mesh collapsed_to_a_point(std::size_t triangles) {
    Mesh mesh = displaced_grid(triangles);
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(0.0F);
    return mesh;
}

/// The grid with all vertices on a line.
Mesh collapsed_to_a_line(std::size_t triangles) {
    Mesh mesh = displaced_grid(triangles);
    for (glm::vec3& position : mesh.positions)
        position = {position.x, 0, 0};
    return mesh;
}

// Methods.

/// A naive method of engines: texture gradients are summed at the vertices, in float. It is wrong
/// if the texture is mirrored, gives NaN without a gradient, does not average across seams, and
/// depends on the order of triangles.
struct NaiveTangents {
    explicit NaiveTangents(const Mesh& source)
        : mesh(source),
          along_u(source.positions.size()),
          along_v(source.positions.size()),
          tangents(source.positions.size()) {}

    void run() {
        std::fill(along_u.begin(), along_u.end(), glm::vec3(0.0F));
        std::fill(along_v.begin(), along_v.end(), glm::vec3(0.0F));
        for (const glm::uvec3& triangle : mesh.triangles) {
            const glm::vec3& origin = mesh.positions[triangle.x];
            const glm::vec3 d1 = mesh.positions[triangle.y] - origin;
            const glm::vec3 d2 = mesh.positions[triangle.z] - origin;
            const glm::vec2 s1 = mesh.texcoords[triangle.y] - mesh.texcoords[triangle.x];
            const glm::vec2 s2 = mesh.texcoords[triangle.z] - mesh.texcoords[triangle.x];
            const float per_area = 1.0F / (s1.x * s2.y - s1.y * s2.x);
            const glm::vec3 u = per_area * (s2.y * d1 - s1.y * d2);
            const glm::vec3 v = per_area * (s1.x * d2 - s2.x * d1);
            for (int corner = 0; corner < 3; ++corner) {
                along_u[triangle[corner]] += u;
                along_v[triangle[corner]] += v;
            }
        }
        for (std::size_t v = 0; v < tangents.size(); ++v) {
            const glm::vec3& n = mesh.normals[v];
            const glm::vec3 tangent = glm::normalize(along_u[v] - glm::dot(n, along_u[v]) * n);
            const float w = glm::dot(glm::cross(n, tangent), along_v[v]) < 0.0F ? 1.0F : -1.0F;
            tangents[v] = glm::vec4(tangent, w);
        }
    }

    const Mesh& mesh;
    std::vector<glm::vec3> along_u, along_v;
    std::vector<glm::vec4> tangents;
};

/// The results, and the memory for intermediate ones.
struct Memory {
    explicit Memory(const Mesh& mesh)
        : of_corners(3 * mesh.triangles.size()), of_vertices(mesh.positions.size()) {}
    std::vector<glm::vec4> of_corners, of_vertices;
    Workspace workspace;
};

std::string named(const std::string& name, unsigned threads) {
    return fmt::format("{}{}", name, threads == 1 ? "" : ", 2 threads");
}

Contender of_corners(const Mesh& mesh, Memory& memory, unsigned threads) {
    return {named("mikktspace", threads),
            [&mesh, &memory, threads] {
                const WorkspaceScope scope(memory.workspace);
                corner_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                                memory.of_corners, IgnoredReport(), {.threads = threads});
            },
            {}};
}

Contender of_vertices(const Mesh& mesh, Memory& memory, unsigned threads) {
    return {named("mikktspace, one per vertex", threads),
            [&mesh, &memory, threads] {
                const WorkspaceScope scope(memory.workspace);
                vertex_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                                memory.of_vertices, IgnoredReport(), {.threads = threads});
            },
            {}};
}

using Method = decltype(&mikktspace_tangents);

Contender in_new_memory(const Mesh& mesh, const std::string& name, Method method,
                        unsigned threads) {
    return {named(name, threads),
            [&mesh, method, threads] {
                const ExecutionScope scope({.threads = threads});
                (void)method(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                             IgnoredReport());
            },
            {}};
}

/// A value of /proc/self/status, in MiB; 0 if it does not exist.
double status_mib(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with(key)) return std::strtod(line.c_str() + key.size(), nullptr) / 1024.0;
    }
    return 0.0;
}

/// The peak of the additional memory of a call, including its result.
double peak_mib(const std::function<void()>& work) {
    std::ofstream("/proc/self/clear_refs") << "5";  // Linux: resets VmHWM.
    const double before = status_mib("VmRSS:");
    work();
    return status_mib("VmHWM:") - before;
}

/// The first three are those of the targets: the naive loop, and MikkTSpace on one and on two
/// threads.
std::vector<Contender> contenders(const Mesh& mesh, NaiveTangents& naive, Memory& memory,
                                  Triad& triad) {
    std::vector<Contender> all;
    all.push_back({"plain loop, float", [&naive] { naive.run(); }, {}});
    for (const unsigned threads : {1U, 2U})
        all.push_back(of_corners(mesh, memory, threads));
    for (const unsigned threads : {1U, 2U})
        all.push_back(of_vertices(mesh, memory, threads));
    for (const unsigned threads : {1U, 2U}) {
        all.push_back(in_new_memory(mesh, "mikktspace, new memory", mikktspace_tangents, threads));
        all.push_back(
            in_new_memory(mesh, "area-weighted, new memory", area_weighted_tangents, threads));
        all.push_back(in_new_memory(mesh, "lengyel, new memory", lengyel_tangents, threads));
    }
    all.push_back({"triad", [&triad] { triad.run(); }, {}});
    return all;
}

void print_table(const std::string& title, const Mesh& mesh, std::size_t rounds) {
    Triad triad;
    NaiveTangents naive(mesh);
    Memory memory(mesh);
    const double peak = peak_mib(in_new_memory(mesh, "", mikktspace_tangents, 1).run);
    std::vector<Contender> all = contenders(mesh, naive, memory, triad);
    measure(all, rounds, 1);

    const auto count = static_cast<double>(mesh.triangles.size());
    fmt::print(
        "\n{}, {} triangles, {} vertices; {} interleaved rounds\n\n| who | ns/triangle, least | "
        "median | times the plain loop |\n|---|---|---|---|\n",
        title, mesh.triangles.size(), mesh.positions.size(), rounds);
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        fmt::print("| {} | {:.1f} | {:.1f} | {:.2f} |\n", all[i].name, least(all[i]) / count,
                   time_statistics(all[i].nanoseconds).median / count,
                   least(all[i]) / least(all[0]));
    }
    fmt::print(
        "\nMikkTSpace in existing memory: {:.1f} ns/triangle (target 100 with AVX2, 90 with "
        "AVX-512), on two threads {:.1f} (target 50).\n",
        least(all[1]) / count, least(all[2]) / count);
    const double bandwidth = Triad::bytes / least(all.back());
    const double vertex_bytes = 32.0 * static_cast<double>(mesh.positions.size());
    const double input = 12.0 * count + vertex_bytes;
    const double output = 48.0 * count;
    fmt::print(
        "Triad: {:.1f} GB/s. Input read and output written once: {:.1f} ns/triangle.\n"
        "Input {:.0f} MiB, output {:.0f}; the peak of mikktspace is {:.0f}, including the output: "
        "{:.2f} times input and output.\n",
        bandwidth, (input + output) / bandwidth / count, input / 0x1p20, output / 0x1p20, peak,
        (input / 0x1p20 + peak) / ((input + output) / 0x1p20));
}

void print_shapes() {
    struct Shape {
        const char* name;
        Mesh mesh;
    };
    const Shape shapes[] = {{"fan, 100k", fan(100'000)},
                            {"fan, 1M", fan(1'000'000)},
                            {"on one edge, 100k", book(100'000)},
                            {"on one edge, 1M", book(1'000'000)},
                            {"collapsed to a point, 100k", collapsed_to_a_point(100'000)},
                            {"collapsed to a line, 100k", collapsed_to_a_line(100'000)}};
    fmt::print("| shape | mikktspace, s | 2 threads | lengyel |\n|---|---|---|---|\n");
    for (const Shape& shape : shapes) {
        const auto seconds = [&](Method method, unsigned threads) {
            Contender contender = in_new_memory(shape.mesh, "", method, threads);
            for (int round = 0; round < 5; ++round)
                contender.nanoseconds.push_back(1e9 * seconds_of(contender.run));
            return time_statistics(contender.nanoseconds).median * 1e-9;
        };
        fmt::print("| {} | {:.3f} | {:.3f} | {:.3f} |\n", shape.name,
                   seconds(mikktspace_tangents, 1), seconds(mikktspace_tangents, 2),
                   seconds(lengyel_tangents, 1));
    }
}

// MikkTSpace's reference implementation.

struct ReferenceContext;

/// The C interface of the reference, genTangSpaceDefault(): it reads the mesh by callbacks.
struct ReferenceCallbacks {
    int (*face_count)(const ReferenceContext*);
    int (*corner_count)(const ReferenceContext*, int face);
    void (*position)(const ReferenceContext*, float* out, int face, int corner);
    void (*normal)(const ReferenceContext*, float* out, int face, int corner);
    void (*texcoord)(const ReferenceContext*, float* out, int face, int corner);
    void (*store_tangent)(const ReferenceContext*, const float* tangent, float sign, int face,
                          int corner);
    void (*store_frame)();  ///< Not used.
};

struct ReferenceInput {
    const Mesh& mesh;
    std::vector<glm::vec4>& tangents;  ///< One per corner.

    [[nodiscard]] std::size_t vertex(int face, int corner) const {
        return mesh.triangles[static_cast<std::size_t>(face)][corner];
    }
};

struct ReferenceContext {
    ReferenceCallbacks* callbacks;
    ReferenceInput* input;
};

template <typename Vector>
void store(const Vector& from, float* out) {
    for (int axis = 0; axis < Vector::length(); ++axis)
        out[axis] = from[axis];
}

ReferenceCallbacks reference_callbacks() {
    using Context = const ReferenceContext*;
    return {[](Context c) { return static_cast<int>(c->input->mesh.triangles.size()); },
            [](Context, int) { return 3; },
            [](Context c, float* out, int face, int corner) {
                store(c->input->mesh.positions[c->input->vertex(face, corner)], out);
            },
            [](Context c, float* out, int face, int corner) {
                store(c->input->mesh.normals[c->input->vertex(face, corner)], out);
            },
            [](Context c, float* out, int face, int corner) {
                // The reference's v grows upwards, glTF's downwards.
                const glm::vec2 texcoord = c->input->mesh.texcoords[c->input->vertex(face, corner)];
                store(glm::vec2(texcoord.x, 1.0F - texcoord.y), out);
            },
            [](Context c, const float* tangent, float sign, int face, int corner) {
                c->input->tangents[static_cast<std::size_t>(3 * face + corner)] = {
                    tangent[0], tangent[1], tangent[2], sign};
            },
            nullptr};
}

using GenerateReference = int (*)(const ReferenceContext*);

/// Prints a row: the times of both on one thread, and the corners at which the results differ.
void print_reference_row(const std::string& title, const Mesh& mesh, GenerateReference generate,
                         std::size_t rounds) {
    std::vector<glm::vec4> tangents(3 * mesh.triangles.size());
    ReferenceInput input{mesh, tangents};
    ReferenceCallbacks callbacks = reference_callbacks();
    const ReferenceContext context{&callbacks, &input};
    Memory memory(mesh);
    std::vector<Contender> both;
    both.push_back({"reference", [&] { (void)generate(&context); }, {}});
    both.push_back(of_corners(mesh, memory, 1));
    measure(both, rounds, 1);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < both[0].nanoseconds.size(); ++i)
        ratios.push_back(both[0].nanoseconds[i] / both[1].nanoseconds[i]);
    const TimeStatistics ratio = time_statistics(ratios);
    std::size_t differing = 0;
    for (std::size_t i = 0; i < tangents.size(); ++i) {
        const double degrees =
            degrees_between(glm::dvec3(tangents[i]), glm::dvec3(memory.of_corners[i]));
        differing += degrees > 0.1 || tangents[i].w != memory.of_corners[i].w ? 1 : 0;
    }
    const auto count = static_cast<double>(mesh.triangles.size());
    fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} ({:.1f} to {:.1f}) | {} of {} |\n", title,
               time_statistics(both[0].nanoseconds).median / count,
               time_statistics(both[1].nanoseconds).median / count, ratio.median, ratio.p10,
               ratio.p90, differing, tangents.size());
}

int run_reference(const char* library, std::size_t triangles, std::size_t rounds) {
    void* const handle = dlopen(library, RTLD_NOW);
    void* const symbol = handle != nullptr ? dlsym(handle, "genTangSpaceDefault") : nullptr;
    if (symbol == nullptr) {
        fmt::print(stderr, "{}: {} (compile mikktspace.c with -O3 -shared -fPIC)\n", library,
                   handle != nullptr ? "has no genTangSpaceDefault" : dlerror());
        return 1;
    }
    const auto generate = reinterpret_cast<GenerateReference>(symbol);
    fmt::print(
        "{} triangles, one thread, {} interleaved rounds; medians\n\n| mesh | reference, "
        "ns/triangle | relief | ratio (10 % to 90 %) | corners that differ by 0.1 degrees "
        "|\n|---|---|---|---|---|\n",
        triangles, rounds);
    print_reference_row("bumpy sphere", bumpy_sphere(triangles), generate, rounds);
    print_reference_row("displaced grid", displaced_grid(triangles), generate, rounds);
    return 0;
}

int run(int argc, char** argv) {
    if (argc > 2 && std::string(argv[1]) == "reference") {
        return run_reference(argv[2], argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 1'000'000,
                             argc > 4 ? std::strtoul(argv[4], nullptr, 10) : 5);
    }
    if (argc > 1 && std::string(argv[1]) == "shapes") {
        print_shapes();
        return 0;
    }
    const std::size_t triangles = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1'000'000;
    const std::size_t rounds = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 11;
    print_table("Bumpy sphere", bumpy_sphere(triangles), rounds);
    print_table("Displaced grid", displaced_grid(triangles), rounds);
    return 0;
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    return relief::bench::run(argc, argv);
}
