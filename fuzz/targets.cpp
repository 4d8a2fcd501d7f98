// SPDX-License-Identifier: Apache-2.0
// A target may throw the errors of relief; another exception, a crash, a finding of a sanitizer or
// an endless loop is a fault.
#include "targets.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "accuracy_report.h"
#include "check_part.h"
#include "common/content_hash.h"
#include "part_file.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/texture_file.h"
#include "relief/mesh/topology.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene_file.h"

namespace relief {
using namespace relief::shade;

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

/// KTX2 and DDS files, with all their levels.
void texture(Bytes bytes) {
    const GpuTexture read = read_texture(std::as_bytes(bytes), "input");
    for (std::size_t i = 0; i < read.levels.size(); ++i)
        static_cast<void>(decode_texture_level(read, i));
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

/// A map of arbitrary codes: decoding, resizing, blending, mip levels and encoding.
void maps(Bytes bytes) {
    Values values(bytes);
    const std::array all_bits = {8, 16, 32};
    const int bits = all_bits[values.next<std::uint8_t>() % all_bits.size()];
    const int width = 1 + values.next<std::uint8_t>() % 20;
    const int height = 1 + values.next<std::uint8_t>() % 20;
    ResizeOptions options;
    options.filter = static_cast<ResizeFilter>(values.next<std::uint8_t>() % 5);
    options.domain = static_cast<ResizeDomain>(values.next<std::uint8_t>() % 2);
    options.wrap.x = enum_names<Wrap>[values.next<std::uint8_t>() % 3].value;
    options.wrap.y = enum_names<Wrap>[values.next<std::uint8_t>() % 3].value;
    const int new_width = 1 + values.next<std::uint8_t>() % 40;
    const int new_height = 1 + values.next<std::uint8_t>() % 40;
    const auto blend =
        all_normal_blends[values.next<std::uint8_t>() % std::size(all_normal_blends)];
    NormalMapFormat format;
    format.bits = all_bits[values.next<std::uint8_t>() % all_bits.size()];
    format.flat = enum_names<FlatCode>[values.next<std::uint8_t>() % 2].value;
    format.dither = enum_names<Dither>[values.next<std::uint8_t>() % 3].value;
    const double strength = static_cast<double>(values.number());
    Image map = make_image(width, height, 3, bits, ColorSpace::data);
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            for (Sample& one : samples)
                one = values.next<Sample>();
        },
        map.samples);
    static_cast<void>(measure_lengths(map, format.flat));
    const Image normals =
        decode_normal_map(map, Green::up, format.flat, IgnoredReport(), FlatTexels::exact);
    Image resized = resize_normals(normals, new_width, new_height, options);
    scale_slopes(resized, strength);
    blend_normals(resized, normals, blend);
    for (std::size_t i = 0; i < resized.sample_count(); i += 3) {
        const std::span<const float> all = std::as_const(resized).as<float>();
        if (!(std::abs(std::hypot(all[i], all[i + 1], all[i + 2]) - 1.0F) < 1e-3F)) std::abort();
    }
    static_cast<void>(encode_normal_map(resized, format));
    static_cast<void>(normal_mip_levels(resized));
}

using relief::shade::effects;

/// A scene of arbitrary materials and lights: the plan of its effects and their shaders.
void effects(Bytes bytes) {
    Values values(bytes);
    const auto chance = [&] { return values.next<std::uint8_t>() % 2 == 1; };
    // Most scenes are valid: 0, 1 and values between.
    const auto unit = [&] { return static_cast<float>(values.next<std::uint8_t>() % 5) / 4.0F; };
    const auto color = [&] {
        const float r = unit();
        const float g = unit();
        return glm::vec3(r, g, unit());
    };
    const auto texture = [&](std::optional<Texture>& place) {
        if (chance()) place = Texture{};
    };
    Scene scene;
    Mesh mesh = mesh_from(values);
    if (chance()) mesh.normals.assign(mesh.positions.size(), glm::vec3(0, 0, 1));
    if (chance() && !mesh.normals.empty() && !mesh.texcoords.empty())
        mesh.tangents.assign(mesh.positions.size(), glm::vec4(1, 0, 0, 1));
    if (chance()) mesh.colors.assign(mesh.positions.size(), glm::vec4(values.number()));
    scene.images.push_back({"image", std::filesystem::path("none.png")});
    Material material;
    material.interpolation = static_cast<Interpolation>(values.next<std::uint8_t>() % 3);
    for (glm::vec3* const one :
         {&material.ambient, &material.diffuse, &material.specular, &material.emission,
          &material.reflectivity, &material.grazing_reflectivity}) {
        if (chance()) *one = color();
    }
    material.specular_model = static_cast<SpecularModel>(values.next<std::uint8_t>() % 3);
    material.fresnel = static_cast<FresnelModel>(values.next<std::uint8_t>() % 3);
    material.reflection_roughness = unit();
    material.transmission = unit();
    if (chance()) material.metallic_roughness = MetallicRoughness{};
    for (std::optional<Texture>* const one :
         {&material.diffuse_texture, &material.specular_texture, &material.emission_texture,
          &material.occlusion_texture, &material.opacity_texture}) {
        texture(*one);
    }
    if (chance()) {
        material.normal_map = NormalMap{};
        material.normal_map->space = static_cast<NormalSpace>(values.next<std::uint8_t>() % 2);
    } else if (chance()) {
        material.bump_map = BumpMap{};
    }
    material.tangent_frame = static_cast<TangentFrame>(values.next<std::uint8_t>() % 2);
    material.specular_antialiasing = chance();
    material.alpha_mode = static_cast<AlphaMode>(values.next<std::uint8_t>() % 3);
    material.opacity = unit();
    material.double_sided = chance();
    material.unlit = chance();
    scene.materials.push_back(material);
    mesh.material_ranges.push_back({0, static_cast<std::uint32_t>(mesh.triangles.size()), 0});
    scene.meshes.emplace_back(std::move(mesh));
    scene.instances.push_back({0, glm::mat4(unit()), "instance"});
    scene.ambient = color();
    scene.directional_lights.resize(values.next<std::uint8_t>() % 3);
    scene.point_lights.resize(values.next<std::uint8_t>() % 40);
    for (PointLight& light : scene.point_lights) {
        light.intensity = color();
        if (chance()) light.range = 1.0F + unit();
    }
    scene.spot_lights.resize(values.next<std::uint8_t>() % 3);
    if (chance()) {
        scene.environment = Environment{Equirectangular{scene.images[0]}};
        scene.environment->lights = chance();
        scene.environment->intensity = unit();
    }
    scene.tone_mapping = static_cast<ToneMapping>(values.next<std::uint8_t>() % 6);
    validate(scene);
    const FramePlan plan = plan_effects(scene, FrameSettings{});
    for (const DrawPlan& draw : plan.draws) {
        if (canonical(draw.features) != draw.features) std::abort();
        static_cast<void>(planned_interface(draw.features));
        static_cast<void>(planned_inputs(scene, draw));
    }
    static_cast<void>(shader_listings(plan));
    static_cast<void>(shader_listings(
        force_effects(scene, FrameSettings{}, plan, {EffectBase::all_neutral, {}})));
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

// Parts of shards. Their hashes find damage, so that changed bytes are read only with new hashes.

/// Returns 8 bytes of a number.
std::string bytes_of(std::uint64_t number) {
    std::string bytes;
    for (int i = 0; i < 8; ++i)
        bytes.push_back(static_cast<char>(number >> (8 * i) & 0xFF));
    return bytes;
}

std::uint64_t number_at(std::string_view bytes, std::size_t offset) {
    std::uint64_t number = 0;
    for (std::size_t i = 8; i-- > 0;)
        number = number << 8 | static_cast<unsigned char>(bytes[offset + i]);
    return number;
}

std::uint64_t hash_of(std::string_view bytes) {
    tools::ContentHash hash;
    hash.add(bytes);
    return hash.value();
}

/// Returns the part of a bake with the hashes and lengths of what it holds.
std::string with_bake_hashes(std::string part) {
    constexpr std::string_view magic = "relief part 1\n";
    constexpr std::size_t trailer = 32;
    if (part.size() < magic.size() + trailer) return part;
    part.replace(0, magic.size(), magic);
    const std::size_t end = part.size() - trailer;
    const std::size_t json = std::min(part.find("{\"tool\"", magic.size()), end);
    for (std::size_t at = magic.size(); at + 16 <= json;) {
        const std::size_t size = std::min<std::size_t>(number_at(part, at), json - at - 16);
        part.replace(at + 8, 8, bytes_of(hash_of(std::string_view(part).substr(at + 16, size))));
        at += 16 + size;
    }
    part.resize(end);
    return part + bytes_of(json) + bytes_of(end - json) +
           bytes_of(hash_of(std::string_view(part).substr(json))) + "end part";
}

/// Reads all rows of the part of a bake.
void read_bake_part(const std::filesystem::path& file) {
    const tools::PartFile part(file);
    for (const tools::PartRows& rows : part.part().rows) {
        constexpr int max_width = 64;
        std::uint64_t offset = rows.offset;
        for (int first = rows.found.rows.first; first < rows.found.rows.last;
             first += tools::part_chunk_rows) {
            const int count = std::min(tools::part_chunk_rows, rows.found.rows.last - first);
            std::vector<TexelState> states(static_cast<std::size_t>(count * max_width));
            std::vector<float> normals(3 * states.size());
            BakedRows chunk;
            chunk.first_row = first;
            chunk.row_count = count;
            chunk.states = states;
            chunk.normals = normals;
            part.read(chunk, offset, part.part().facts.ids.size());
        }
    }
}

void part(Bytes bytes) {
    for (const std::string& text :
         {std::string(text_of(bytes)), with_bake_hashes(std::string(text_of(bytes)))}) {
        try {
            read_bake_part(written("input.part", text));
        } catch (const Error&) {
        }
    }
}

void checkpart(Bytes bytes) {
    const std::string_view text = text_of(bytes);
    const std::string json(text.substr(std::min(text.find('\n'), text.size() - 1) + 1));
    const std::string hashed = fmt::format("relief check part 1 {:016x}\n{}", hash_of(json), json);
    for (const std::string_view part : {text, std::string_view(hashed)}) {
        try {
            const std::vector parts = {tools::read_check_part(written("input.part", part))};
            const tools::CheckSource source = tools::merged_source(parts, {"input.part"});
            for (const tools::CheckInput& input : parts.front().walked.files) {
                if (input.kind == tools::CheckedKind::model) static_cast<void>(source.model(input));
            }
            for (const tools::ImageFacts& facts : parts.front().images)
                static_cast<void>(tools::judge_image(facts, {}));
        } catch (const Error&) {
        }
    }
}

constexpr char obj_name[] = "input.obj";
constexpr char ply_name[] = "input.ply";
constexpr char stl_name[] = "input.stl";
constexpr char off_name[] = "input.off";
constexpr char gltf_name[] = "input.gltf";
constexpr char glb_name[] = "input.glb";

constexpr std::array targets = {FuzzTarget{"obj", mesh_file<obj_name>},
                                FuzzTarget{"mtl", mtl},
                                FuzzTarget{"ply", mesh_file<ply_name>},
                                FuzzTarget{"stl", mesh_file<stl_name>},
                                FuzzTarget{"off", mesh_file<off_name>},
                                FuzzTarget{"gltf", gltf<gltf_name>},
                                FuzzTarget{"glb", gltf<glb_name>},
                                FuzzTarget{"meshopt", meshopt},
                                FuzzTarget{"draco", draco},
                                FuzzTarget{"scene", scene},
                                FuzzTarget{"report", report},
                                FuzzTarget{"png", image},
                                FuzzTarget{"jpeg", image},
                                FuzzTarget{"texture", texture},
                                FuzzTarget{"rows", rows},
                                FuzzTarget{"frames", frames},
                                FuzzTarget{"diagnosis", diagnosis},
                                FuzzTarget{"decimation", decimation},
                                FuzzTarget{"subdivision", subdivision},
                                FuzzTarget{"bump", bump},
                                FuzzTarget{"maps", maps},
                                FuzzTarget{"effects", effects},
                                FuzzTarget{"bake", baking},
                                FuzzTarget{"part", part},
                                FuzzTarget{"checkpart", checkpart}};

}  // namespace

std::span<const FuzzTarget> fuzz_targets() {
    return targets;
}

void run_target(const FuzzTarget& target, std::span<const std::uint8_t> bytes) {
    constexpr std::uint64_t memory = 256 << 20;
    constexpr std::uint64_t pixels = 1 << 20;
    set_input_limits({memory, pixels, false});
    try {
        target.run(bytes);
    } catch (const Error&) {
    }
}

}  // namespace relief
