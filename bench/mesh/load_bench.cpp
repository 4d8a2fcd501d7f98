// SPDX-License-Identifier: Apache-2.0
// Reading of model files, interleaved with direct calls of tinygltf and tinyobjloader and with
// reading only the bytes: `relief-load-bench [TRIANGLES [ROUNDS]]` prints a table in Markdown. The
// files are in the page cache.
#include <fmt/format.h>
#include <tiny_gltf.h>
#include <tiny_obj_loader.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "bench_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/statistics.h"

namespace relief::bench {
namespace {

struct Reading {
    std::string format;
    std::string who;
    std::function<std::size_t()> run;  ///< Returns the number of triangles, or of bytes.
    std::vector<double> seconds;
};

std::size_t read_bytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> bytes(std::filesystem::file_size(file));
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return bytes.size();
}

std::size_t by_relief(const std::filesystem::path& file) {
    Report report;
    if (file.extension() == ".glb") {
        const GltfDocument document = GltfDocument::read(file, report);
        return document.mesh({0, 0}).triangles.size();
    }
    return read_mesh(file, report).mesh.triangles.size();
}

std::size_t by_tinyobjloader(const std::filesystem::path& file) {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string problems;
    tinyobj::LoadObj(&attributes, &shapes, &materials, &problems, &problems, file.c_str());
    return shapes.empty() ? 0 : shapes.front().mesh.num_face_vertices.size();
}

std::size_t by_tinygltf(const std::filesystem::path& file) {
    tinygltf::TinyGLTF reader;
    tinygltf::Model model;
    std::string problems;
    reader.LoadBinaryFromFile(&model, &problems, &problems, file.string());
    return model.accessors.size();
}

std::vector<Reading> readings(const std::filesystem::path& folder, const Mesh& mesh) {
    write_mesh(folder / "sphere.obj", {mesh, {}});
    write_mesh(folder / "sphere.ply", {mesh, {}});
    GltfDocument::from_mesh({mesh, {}}).write(folder / "sphere.glb");
    std::vector<Reading> all;
    const auto add = [&](const char* format, const char* who,
                         std::size_t (*read)(const std::filesystem::path&)) {
        const std::filesystem::path file = folder / (std::string("sphere.") + format);
        all.push_back({format, who, [file, read] { return read(file); }, {}});
    };
    for (const char* format : {"obj", "ply", "glb"}) {
        add(format, "bytes alone", read_bytes);
        add(format, "relief, to arrays", by_relief);
    }
    add("obj", "tinyobjloader, bare call", by_tinyobjloader);
    add("glb", "tinygltf, bare call", by_tinygltf);
    return all;
}

int run(int argc, char** argv) {
    const std::size_t triangles = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1'000'000;
    const std::size_t rounds = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 7;
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / "relief-load-bench";
    std::filesystem::create_directories(folder);
    const Mesh mesh = bumpy_sphere(triangles);
    std::vector<Reading> all = readings(folder, mesh);
    interleave(all.size(), {rounds, 1}, [&](std::size_t i, bool counted) {
        const Stopwatch stopwatch;
        if (all[i].run() == 0) std::abort();
        const double taken = stopwatch.seconds();
        if (counted) all[i].seconds.push_back(taken);
    });
    fmt::print(
        "{} triangles with normals and texture coordinates; median of {} rounds in turns\n\n",
        mesh.triangles.size(), rounds);
    fmt::print("| file | MB | who | seconds | p10 to p90 |\n|---|---|---|---|---|\n");
    for (const char* format : {"obj", "ply", "glb"}) {
        const auto bytes = std::filesystem::file_size(folder / (std::string("sphere.") + format));
        for (const Reading& reading : all) {
            if (reading.format != format) continue;
            const TimeStatistics spread = time_statistics(reading.seconds);
            fmt::print("| {} | {:.0f} | {} | {:.3f} | {:.3f} to {:.3f} |\n", format,
                       static_cast<double>(bytes) / 1e6, reading.who, spread.median, spread.p10,
                       spread.p90);
        }
    }
    std::filesystem::remove_all(folder);
    return 0;
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    return relief::bench::run(argc, argv);
}
