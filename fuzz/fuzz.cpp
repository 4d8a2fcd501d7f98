// SPDX-License-Identifier: Apache-2.0
// One libFuzzer program with all targets; the environment variable RELIEF_FUZZ_TARGET names one.
// scripts/fuzz builds and runs it. A target may throw the errors of relief; another exception, a
// crash, a finding of a sanitizer or an endless loop is a fault.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy_report.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene_file.h"

namespace relief {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// A folder of this process, which stays until the next run of the system.
const std::filesystem::path& folder() {
    static const std::filesystem::path path = [] {
        std::filesystem::path made =
            std::filesystem::temp_directory_path() / fmt::format("relief-fuzz-{}", ::getpid());
        std::filesystem::create_directories(made);
        return made;
    }();
    return path;
}

std::filesystem::path written(const char* name, std::string_view bytes) {
    std::ofstream stream(folder() / name, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return folder() / name;
}

std::string_view text_of(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Readers.

template <const char* Name>
void mesh_file(Bytes bytes) {
    static_cast<void>(read_mesh(written(Name, text_of(bytes)), IgnoredReport()));
}

void mtl(Bytes bytes) {
    written("input.mtl", text_of(bytes));
    static_cast<void>(read_mesh(written("mtl.obj",
                                        "mtllib input.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                        "usemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n"),
                                IgnoredReport()));
}

void visit_document(const std::filesystem::path& file) {
    Report report;
    const GltfDocument document = GltfDocument::read(file, report);
    static_cast<void>(document.view());
    static_cast<void>(document.animations(report));
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        try {
            static_cast<void>(document.mesh(id));
        } catch (const InvalidInput&) {
        }
    }
}

template <const char* Name>
void gltf(Bytes bytes) {
    visit_document(written(Name, text_of(bytes)));
}

/// Writes a GLB of JSON and a binary chunk.
std::filesystem::path written_glb(std::string json, std::string_view binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string data(binary);
    data.resize((data.size() + 3) / 4 * 4, '\0');
    std::string file = "glTF";
    const auto append = [&](std::size_t word) {
        for (std::size_t i = 0; i < 4; ++i)
            file += static_cast<char>(word >> (8 * i) & 0xFF);
    };
    append(2);
    append(28 + json.size() + data.size());
    append(json.size());
    file += "JSON" + json;
    append(data.size());
    file += std::string("BIN\0", 4) + data;
    return written("packed.glb", file);
}

/// The first bytes choose count, stride, mode and filter of a compressed buffer view.
void meshopt(Bytes bytes) {
    if (bytes.size() < 5) return;
    static constexpr std::array modes = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
    static constexpr std::array filters = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    const int count = 3 * bytes[0];
    const int stride = 4 * (1 + bytes[1] % 16);
    const std::string_view data = text_of(bytes.subspan(4));
    visit_document(written_glb(
        fmt::format(
            R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{0}}},{{"byteLength":{1},)"
            R"("extensions":{{"EXT_meshopt_compression":{{"fallback":true}}}}}}],"bufferViews":[)"
            R"({{"buffer":1,"byteLength":{1},"byteStride":{2},"extensions":{{)"
            R"("EXT_meshopt_compression":{{"buffer":0,"byteLength":{0},"byteStride":{2},)"
            R"("count":{3},"mode":"{4}","filter":"{5}"}}}}}}]}})",
            data.size(), count * stride, stride, count, modes[bytes[2] % modes.size()],
            filters[bytes[3] % filters.size()]),
        data));
}

void draco(Bytes bytes) {
    if (bytes.empty()) return;
    visit_document(written_glb(
        fmt::format(
            R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{0}}}],"bufferViews":[)"
            R"({{"buffer":0,"byteLength":{0}}}],"accessors":[{{"componentType":5126,"count":3,)"
            R"("type":"VEC3"}},{{"componentType":5125,"count":3,"type":"SCALAR"}}],"meshes":[)"
            R"({{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"extensions":{{)"
            R"("KHR_draco_mesh_compression":{{"bufferView":0,"attributes":{{"POSITION":0}}}}}}}}]}}]}})",
            bytes.size()),
        text_of(bytes)));
}

/// Also plans the effects of the scene, and assembles their shaders.
void scene(Bytes bytes) {
    const SceneGraph graph =
        load_scene_graph(written("input.json", text_of(bytes)), SceneOptions{}, IgnoredReport());
    const FramePlan plan = plan_effects(graph.scene, FrameSettings{});
    static_cast<void>(shader_listings(plan));
}

void report(Bytes bytes) {
    static_cast<void>(tools::read_report(written("report.json", text_of(bytes))));
}

void image(Bytes bytes) {
    static_cast<void>(read_image(std::as_bytes(bytes), "input", ImageUse::data));
}

void rows(Bytes bytes) {
    ImageRowReader reader(written("input.png", text_of(bytes)));
    std::vector<std::uint32_t> row((reader.row_bytes() + 3) / 4);
    while (reader.next_row() < reader.info().height)
        reader.read(std::as_writable_bytes(std::span(row)).first(reader.row_bytes()));
}

// Algorithms on arbitrary arrays.

/// Values from the input, and zeros behind its end.
class Values {
  public:
    explicit Values(Bytes bytes) : bytes_(bytes) {}

    template <typename Value>
    Value next() {
        Value value{};
        const std::size_t size = std::min(sizeof value, bytes_.size());
        if (size > 0) std::memcpy(&value, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
        return value;
    }
    /// A float of any bits, or, more often, a small multiple of 1/8.
    float number() {
        const auto kind = next<std::uint8_t>();
        if (kind < 32) return next<float>();
        return static_cast<float>(next<std::int8_t>()) / 8.0F;
    }

  private:
    Bytes bytes_;
};

Mesh mesh_from(Values& values) {
    Mesh mesh;
    const auto vertices = 1U + values.next<std::uint8_t>() % 24U;
    const auto triangles = values.next<std::uint8_t>() % 48U;
    const bool has_texcoords = values.next<std::uint8_t>() % 4 != 0;
    for (unsigned i = 0; i < vertices; ++i) {
        const float x = values.number();
        const float y = values.number();
        mesh.positions.emplace_back(x, y, values.number());
        if (has_texcoords) mesh.texcoords.emplace_back(values.number(), values.number());
    }
    for (unsigned i = 0; i < triangles; ++i) {
        glm::uvec3 triangle(0);
        for (int k = 0; k < 3; ++k)
            triangle[k] = values.next<std::uint8_t>() % vertices;
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

/// Every normal is finite, and so is every tangent.
void require_finite(const Mesh& mesh) {
    for (const glm::vec3& normal : mesh.normals)
        if (!(std::abs(glm::length(normal) - 1.0F) < 1e-3F)) std::abort();
    for (const glm::vec4& tangent : mesh.tangents)
        if (!(std::abs(glm::length(glm::vec3(tangent)) - 1.0F) < 1e-3F)) std::abort();
}

/// Normals, tangents and splits.
void frames(Bytes bytes) {
    Values values(bytes);
    FrameOptions options;
    options.normals = enum_names<NormalMode>[1 + values.next<std::uint8_t>() %
                                                     (enum_names<NormalMode>.size() - 1)]
                          .value;
    const auto tangents = values.next<std::uint8_t>() % 4;
    options.tangents = tangents == 0   ? TangentMethod::none
                       : tangents == 1 ? TangentMethod::lengyel
                                       : TangentMethod::mikktspace;
    if (options.normals.weight() && values.next<std::uint8_t>() % 2 == 0)
        options.crease_angle = 0.7;
    require_finite(with_frames(mesh_from(values), options).mesh);
}

void diagnosis(Bytes bytes) {
    Values values(bytes);
    static_cast<void>(diagnose(mesh_from(values)));
}

void decimation(Bytes bytes) {
    Values values(bytes);
    DecimateOptions options;
    options.triangles = 1 + values.next<std::uint8_t>() % 32;
    validate(decimated(mesh_from(values), options).mesh);
}

void subdivision(Bytes bytes) {
    Values values(bytes);
    validate(subdivided(mesh_from(values), 1, FrameOptions{}, IgnoredReport()));
}

void bump(Bytes bytes) {
    Values values(bytes);
    const int width = 1 + values.next<std::uint8_t>() % 20;
    const int height = 1 + values.next<std::uint8_t>() % 20;
    BumpOptions options;
    const auto kernel = values.next<std::uint8_t>() % (enum_names<Kernel>.size() + 1);
    if (kernel > 0) options.kernel = enum_names<Kernel>[kernel - 1].value;
    options.strength = static_cast<double>(values.number());
    Image heights = make_image(width, height, 1, 32, ColorSpace::data);
    for (float& one : heights.as<float>())
        one = values.number();
    const Image normals = normals_from_height(heights, options);
    for (const float one : normals.as<float>()) {
        if (!(std::abs(one) <= 1.0001F)) std::abort();
    }
}

void baking(Bytes bytes) {
    Values values(bytes);
    BakeOptions options;
    options.map.width = 1 + values.next<std::uint8_t>() % 16;
    options.map.height = 1 + values.next<std::uint8_t>() % 16;
    FrameOptions frames;
    frames.normals = NormalWeight::angle;
    frames.tangents = TangentMethod::mikktspace;
    const Mesh low = with_frames(mesh_from(values), frames).mesh;
    frames.tangents = TangentMethod::none;
    const Mesh high = with_frames(mesh_from(values), frames).mesh;
    const std::vector<Mesh> all = {high};
    bake_normals(all, low, options, [](const BakedRows&) {});
}

constexpr char obj_name[] = "input.obj";
constexpr char ply_name[] = "input.ply";
constexpr char stl_name[] = "input.stl";
constexpr char off_name[] = "input.off";
constexpr char gltf_name[] = "input.gltf";
constexpr char glb_name[] = "input.glb";

struct Target {
    std::string_view name;
    void (*run)(Bytes bytes);
};
constexpr std::array targets = {Target{"obj", mesh_file<obj_name>},
                                Target{"mtl", mtl},
                                Target{"ply", mesh_file<ply_name>},
                                Target{"stl", mesh_file<stl_name>},
                                Target{"off", mesh_file<off_name>},
                                Target{"gltf", gltf<gltf_name>},
                                Target{"glb", gltf<glb_name>},
                                Target{"meshopt", meshopt},
                                Target{"draco", draco},
                                Target{"scene", scene},
                                Target{"report", report},
                                Target{"png", image},
                                Target{"jpeg", image},
                                Target{"rows", rows},
                                Target{"frames", frames},
                                Target{"diagnosis", diagnosis},
                                Target{"decimation", decimation},
                                Target{"subdivision", subdivision},
                                Target{"bump", bump},
                                Target{"bake", baking}};

const Target& chosen_target() {
    const char* const name = std::getenv("RELIEF_FUZZ_TARGET");
    for (const Target& target : targets) {
        if (name != nullptr && target.name == name) return target;
    }
    std::string names;
    for (const Target& target : targets)
        names += fmt::format(" {}", target.name);
    fmt::print(stderr, "RELIEF_FUZZ_TARGET is not one of{}\n", names);
    std::exit(2);
}

}  // namespace
}  // namespace relief

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const relief::Target& target = relief::chosen_target();
    constexpr std::uint64_t memory = 256 << 20;
    constexpr std::uint64_t pixels = 1 << 20;
    relief::set_input_limits({memory, pixels, false});
    try {
        target.run({data, size});
    } catch (const relief::Error&) {
    }
    return 0;
}
