// SPDX-License-Identifier: Apache-2.0
// Buffer views compressed by meshopt: every mode, filter and version reproduces the values, and
// damaged ones end in an error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_compression.h"
#include "io/gltf/gltf_contents.h"
#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using nlohmann::json;
using test::write_gltf_file;
using testing::ElementsAre;
using testing::HasSubstr;

/// The decoded contents of a view, and its parameters.
struct PackedCase {
    std::string packed;
    const char* mode = "ATTRIBUTES";
    const char* filter = "NONE";
    std::size_t count = 0;
    std::size_t stride = 0;
};

class GltfMeshopt : public testing::Test {
  protected:
    /// A document with one compressed view and an accessor of bytes over it.
    static json document_of(const PackedCase& packed, const std::string& extension) {
        const std::size_t length = packed.count * packed.stride;
        json root = json::parse(R"({"asset": {"version": "2.0"}})");
        root["buffers"] = {{{"byteLength", packed.packed.size()}},
                           {{"byteLength", length}, {"name", "stand-in"}}};
        root["buffers"][1]["extensions"][extension]["fallback"] = true;
        root["bufferViews"] = {{{"buffer", 1}, {"byteLength", length}}};
        root["bufferViews"][0]["extensions"][extension] = {{"buffer", 0},
                                                           {"byteLength", packed.packed.size()},
                                                           {"byteStride", packed.stride},
                                                           {"mode", packed.mode},
                                                           {"filter", packed.filter},
                                                           {"count", packed.count}};
        root["accessors"] = {
            {{"bufferView", 0}, {"componentType", 5121}, {"type", "SCALAR"}, {"count", length}}};
        root["extensionsUsed"] = {extension};
        root["extensionsRequired"] = {extension};
        return root;
    }
    /// Returns the decoded bytes of a compressed view.
    std::string decoded(const PackedCase& packed,
                        const std::string& extension = "EXT_meshopt_compression") {
        write_gltf_file(in_, document_of(packed, extension), packed.packed);
        return raw_elements(read_gltf(in_, report_), 0);
    }
    std::string error_of(const json& root, const std::string& buffer) {
        write_gltf_file(in_, root, buffer);
        try {
            read_gltf(in_, report_);
        } catch (const FileError& error) {
            return error.what();
        }
        return "no error";
    }

    test::TemporaryDirectory folder_;
    std::filesystem::path in_ = folder_ / "in.glb";
    std::filesystem::path out_ = folder_ / "out.glb";
    Report report_;
    std::mt19937 random_{11};
};

std::string bytes_of(const std::vector<std::uint32_t>& indices, std::size_t size) {
    std::string bytes;
    for (const std::uint32_t index : indices)
        bytes.append(reinterpret_cast<const char*>(&index), size);
    return bytes;
}

template <typename Value>
std::vector<Value> values_in(const std::string& bytes) {
    std::vector<Value> values(bytes.size() / sizeof(Value));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Value));
    return values;
}

/// Packs attributes with meshoptimizer.
std::string packed_attributes(const void* elements, std::size_t count, std::size_t stride) {
    std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
    packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()),
                                             packed.size(), elements, count, stride));
    return packed;
}

TEST_F(GltfMeshopt, AttributesOfEveryStrideComeBackByteForByte) {
    for (const std::size_t stride : {4U, 8U, 12U, 20U, 64U, 256U}) {
        for (const std::size_t count : {1U, 15U, 16U, 17U, 255U, 256U, 257U, 1000U}) {
            std::string elements(count * stride, '\0');
            for (std::size_t i = 0; i < elements.size(); ++i) {
                // Slow and fast bytes, so that all bit lengths occur.
                elements[i] = static_cast<char>(i / stride * (i % 4) + random_() % (1U << i % 8));
            }
            const PackedCase packed{packed_attributes(elements.data(), count, stride), "ATTRIBUTES",
                                    "NONE", count, stride};
            for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
                EXPECT_TRUE(decoded(packed, extension) == elements) << stride << ' ' << count;
        }
    }
}

TEST_F(GltfMeshopt, IndicesOfBothModesAndSizesComeBack) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t row = 0; row < 20; ++row) {
        for (std::uint32_t i = row * 21; i < row * 21 + 20; ++i)
            triangles.insert(triangles.end(), {i, i + 1, i + 21, i + 21, i + 1, i + 22});
    }
    std::string packed(meshopt_encodeIndexBufferBound(triangles.size(), 441), '\0');
    packed.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(packed.data()),
                                            packed.size(), triangles.data(), triangles.size()));
    std::vector<std::uint32_t> sequence(1000);
    for (std::uint32_t& index : sequence)
        index = static_cast<std::uint32_t>(random_() % 60'000);
    std::string packed_sequence(meshopt_encodeIndexSequenceBound(sequence.size(), 60'000), '\0');
    packed_sequence.resize(
        meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(packed_sequence.data()),
                                    packed_sequence.size(), sequence.data(), sequence.size()));
    for (const std::size_t size : {2U, 4U}) {
        EXPECT_TRUE(decoded({packed_sequence, "INDICES", "NONE", sequence.size(), size}) ==
                    bytes_of(sequence, size));
        // Only the first corner of a triangle may change.
        const std::string bytes = decoded({packed, "TRIANGLES", "NONE", triangles.size(), size});
        std::vector<std::uint32_t> result(triangles.size());
        for (std::size_t i = 0; i < result.size(); ++i)
            std::memcpy(&result[i], bytes.data() + i * size, size);
        for (std::size_t i = 0; i < result.size(); i += 3) {
            const auto* begin = triangles.data() + i;
            const auto turn =
                static_cast<std::size_t>(std::find(begin, begin + 3, result[i]) - begin);
            ASSERT_LT(turn, 3U);
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_EQ(result[i + k], begin[(turn + k) % 3]);
        }
    }
}

TEST_F(GltfMeshopt, OctahedralUnitVectorsComeBackWithinTheirPrecision) {
    std::vector<glm::vec4> vectors;
    std::normal_distribution<float> normal;
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 direction(normal(random_), normal(random_), normal(random_));
        vectors.emplace_back(glm::normalize(direction), i % 2 == 0 ? 1.0F : -1.0F);
    }
    std::string filtered(vectors.size() * 8, '\0');
    meshopt_encodeFilterOct(filtered.data(), vectors.size(), 8, 12, &vectors[0].x);
    const auto result =
        values_in<std::int16_t>(decoded({packed_attributes(filtered.data(), vectors.size(), 8),
                                         "ATTRIBUTES", "OCTAHEDRAL", vectors.size(), 8}));
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        glm::vec4 back(result[4 * i], result[4 * i + 1], result[4 * i + 2], result[4 * i + 3]);
        back = back / 32767.0F;
        // 12 bits: half a step of 1/2047 in x and y of the octahedron; on the sphere, up to three
        // times that where its faces are steepest.
        EXPECT_LT(glm::length(glm::vec3(back - vectors[i])), 3.0F * 0.71F / 2047.0F);
        EXPECT_NEAR(glm::length(glm::vec3(back)), 1.0F, 1e-4F);
        EXPECT_EQ(back.w > 0.0F, vectors[i].w > 0.0F);
    }
}

TEST_F(GltfMeshopt, QuaternionsAndExponentialFloatsComeBackWithinTheirPrecision) {
    std::vector<glm::vec4> quaternions;
    std::vector<glm::vec3> numbers;
    std::normal_distribution<float> normal;
    for (int i = 0; i < 100; ++i) {
        const glm::vec4 q(normal(random_), normal(random_), normal(random_), normal(random_));
        quaternions.push_back(glm::normalize(q));
        numbers.push_back(glm::vec3(q) * std::pow(10.0F, static_cast<float>(i % 13 - 6)));
    }
    std::string filtered(quaternions.size() * 8, '\0');
    meshopt_encodeFilterQuat(filtered.data(), quaternions.size(), 8, 16, &quaternions[0].x);
    const auto turned =
        values_in<std::int16_t>(decoded({packed_attributes(filtered.data(), quaternions.size(), 8),
                                         "ATTRIBUTES", "QUATERNION", quaternions.size(), 8}));
    for (std::size_t i = 0; i < quaternions.size(); ++i) {
        const glm::vec4 back(turned[4 * i], turned[4 * i + 1], turned[4 * i + 2],
                             turned[4 * i + 3]);
        // The same rotation, possibly with the opposite sign.
        EXPECT_NEAR(std::abs(glm::dot(back / 32767.0F, quaternions[i])), 1.0F, 2e-4F);
    }
    filtered.assign(numbers.size() * 12, '\0');
    meshopt_encodeFilterExp(filtered.data(), numbers.size(), 12, 15, &numbers[0].x);
    const auto floats =
        values_in<float>(decoded({packed_attributes(filtered.data(), numbers.size(), 12),
                                  "ATTRIBUTES", "EXPONENTIAL", numbers.size(), 12}));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const float largest =
            std::max({std::abs(numbers[i].x), std::abs(numbers[i].y), std::abs(numbers[i].z)});
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(floats[3 * i + static_cast<std::size_t>(k)], numbers[i][k], largest / 8192);
    }
}

/// Attributes of version 1 in 4 byte positions: the first one is the example of the specification,
/// and the others are zeros. The tail holds the element before the first, and the mode of the
/// channel.
std::string specification_example() {
    // The first byte has control mode 1, the others mode 2.
    std::string packed = "\xA1\xA9";
    packed += '\x02';  // The only group of 16 has 4 bits each.
    packed += "\x17\x5F\xF0\xBC\x77\xA9\x21" + std::string(1, '\0') + "\x34\xB5";
    packed += std::string(24 - 5, '\0');
    packed += std::string(5, '\0');
    return packed;
}

TEST_F(GltfMeshopt, VersionOneGivesTheDeltasOfTheSpecificationsExample) {
    std::string elements(16 * 4, 'x');
    ASSERT_TRUE(decode_meshopt_attributes_v1(specification_example(), 16, 4, elements));
    const std::array<int, 16> deltas = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
    int sum = 0;
    for (std::size_t i = 0; i < 16; ++i) {
        sum += deltas[i];
        EXPECT_EQ(static_cast<std::int8_t>(elements[4 * i]), static_cast<std::int8_t>(sum)) << i;
        EXPECT_EQ(elements.substr(4 * i + 1, 3), std::string(3, '\0'));
    }
}

TEST_F(GltfMeshopt, VersionOneHasWiderDeltasAndRotatedDifferences) {
    // Two elements with literal bytes: both codes for each byte position. Channel 0 adds pairs of
    // bytes: code 3 is -2, 0x0200 is 256, 0x0100 is 128. Channel 1 uses exclusive ors of words that
    // are rotated left by 8 bits.
    std::string packed = "\xA1\xFF\xFF";
    packed += std::string("\x03\x00\x00\x00\x00\x00\x02\x01", 8);
    packed += std::string("\x01\x00\x00\x04\x00\x00\x02\x00", 8);
    packed += std::string(24 - 10, '\0');
    packed += std::string("\x05\x00\x00\x01\x44\x33\x22\x11", 8) + "\x01\x82";
    std::string elements(16, 'x');
    ASSERT_TRUE(decode_meshopt_attributes_v1(packed, 2, 8, elements));
    EXPECT_THAT(values_in<std::uint16_t>(elements.substr(0, 4)), ElementsAre(3, 256 + 256));
    EXPECT_THAT(values_in<std::uint16_t>(elements.substr(8, 4)), ElementsAre(3, 512 + 128));
    EXPECT_THAT(values_in<std::uint32_t>(elements.substr(4, 4)), ElementsAre(0x10203344U));
    EXPECT_THAT(values_in<std::uint32_t>(elements.substr(12, 4)), ElementsAre(0x10203340U));
}

TEST_F(GltfMeshopt, ColorsComeBackFromLumaAndChroma) {
    // 8 bits: the highest bit of alpha is that of the scale, so 0x80 + 0x7F is opaque. White, and a
    // red.
    const std::array<std::uint8_t, 8> bytes = {255, 0, 0, 255, 64, 128, 192, 0xC0};
    std::string elements(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    decode_meshopt_colors(elements, 4);
    EXPECT_THAT(values_in<std::uint8_t>(elements), ElementsAre(255, 255, 255, 255, 0, 0, 255, 128));
    // 4 bits in 16: y 5, co 10, cg -5: (20, 0, 0) of 15 would overflow; y 5, co 5, cg 0.
    const std::array<std::uint16_t, 4> wide = {5, 5, 0, 15};
    elements.assign(reinterpret_cast<const char*>(wide.data()), sizeof(wide));
    decode_meshopt_colors(elements, 8);
    EXPECT_THAT(values_in<std::uint16_t>(elements), ElementsAre(43690, 21845, 0, 65535));
}

TEST_F(GltfMeshopt, EveryTruncationOfVersionOneIsDamaged) {
    const std::string packed = specification_example();
    std::string elements(16 * 4, 'x');
    for (std::size_t length = 0; length < packed.size(); ++length) {
        EXPECT_FALSE(decode_meshopt_attributes_v1(packed.substr(0, length), 16, 4, elements));
    }
    EXPECT_FALSE(decode_meshopt_attributes_v1(packed + '\0', 16, 4, elements));
    for (const char mode : {'\x03', '\x10', '\x21'}) {
        EXPECT_FALSE(decode_meshopt_attributes_v1(packed.substr(0, packed.size() - 1) + mode, 16, 4,
                                                  elements));
    }
}

/// Returns the elements of an accessor as floats, with all its components.
std::vector<float> numbers_of(const GltfContents& contents, std::size_t accessor) {
    std::vector<float> numbers;
    const auto add = [&]<typename Vector>(Vector) {
        for (const Vector& value : float_elements<Vector>(contents, accessor)) {
            for (int k = 0; k < Vector::length(); ++k)
                numbers.push_back(value[k]);
        }
    };
    const std::string type = contents.root["accessors"][accessor]["type"];
    if (type == "VEC3") add(glm::vec3());
    if (type == "VEC4") add(glm::vec4());
    if (type == "SCALAR") add(glm::vec1());
    return numbers;
}

float largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    EXPECT_EQ(a.size(), b.size());
    float largest = 0.0F;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

TEST_F(GltfMeshopt, TheKhronosCubesAgreeInAllVersionsModesAndFilters) {
    RELIEF_NEEDS_SHARED(file, "data/models/gltf-ext/meshopt/MeshoptCubeTest/MeshoptCubeTest.gltf");
    const GltfContents contents = read_gltf(file, report_);
    // Five kinds of cubes: plain, packed indices, packed triangles, filtered, and filtered in
    // version 1.
    constexpr std::size_t first = 10;
    for (std::size_t kind = 0; kind < 5; ++kind) {
        const Json& plain = contents.root["meshes"][first + kind]["primitives"][0];
        for (std::size_t row = 1; row < 5; ++row) {
            const Json& packed = contents.root["meshes"][first + 5 * row + kind]["primitives"][0];
            SCOPED_TRACE(contents.root["meshes"][first + 5 * row + kind]["name"]);
            for (const auto& [name, accessor] : plain["attributes"].items()) {
                const float difference =
                    largest_difference(numbers_of(contents, accessor.get<std::size_t>()),
                                       numbers_of(contents, packed["attributes"][name]));
                // Filters keep 8 bits of colors and normals. The interleaved cube has no filter,
                // and the other steps change no bit.
                const bool is_filtered = row >= 3 && kind > 0;
                EXPECT_LE(difference, is_filtered ? 1.0F / 127.0F : 0.0F) << name;
            }
            EXPECT_EQ(index_elements(contents, packed["indices"]).size(), 36U);
            if (row == 1) {
                EXPECT_EQ(index_elements(contents, packed["indices"]),
                          index_elements(contents, plain["indices"]));
            }
        }
    }
    const Json& samplers = contents.root["animations"][0]["samplers"];
    for (std::size_t row = 1; row < 5; ++row) {
        EXPECT_LE(largest_difference(numbers_of(contents, samplers[0]["output"]),
                                     numbers_of(contents, samplers[row]["output"])),
                  row < 3 ? 0.0F : 1e-3F);
    }
    EXPECT_EQ(contents.unpacked.at("KHR_meshopt_compression"), 60U);
}

TEST_F(GltfMeshopt, DecodedDocumentHasNoTraceOfCompression) {
    RELIEF_NEEDS_SHARED(file, "data/models/gltf-ext/meshopt/pirate.glb");
    const GltfDocument document = GltfDocument::read(file, report_);
    document.write(out_);
    const GltfContents written = read_gltf(out_, report_);
    EXPECT_EQ(written.root["extensionsUsed"], json({"KHR_mesh_quantization"}));
    EXPECT_EQ(written.root["extensionsRequired"], json({"KHR_mesh_quantization"}));
    EXPECT_EQ(written.root["buffers"].size(), 1U);
    // 2887 positions of 8 bytes, normals of 4, 15030 indices of 2. The compressed data is gone.
    EXPECT_EQ(written.buffers[0].size, 2887U * 12 + 15030 * 2);
    for (const Json& view : written.root["bufferViews"])
        EXPECT_FALSE(view.contains("extensions"));
    EXPECT_EQ(document.mesh({0, 0}).triangles.size(), 5010U);
}

TEST_F(GltfMeshopt, PlainDataThatIsThereIsTakenAndBothStay) {
    const std::string elements = "twelve bytes";
    const PackedCase packed{packed_attributes(elements.data(), 3, 4), "ATTRIBUTES", "NONE", 3, 4};
    json root = document_of(packed, "EXT_meshopt_compression");
    root.erase("extensionsRequired");
    root["buffers"][1] = {{"byteLength", 12}, {"uri", "data:;base64,b3RoZXIgYnl0ZXMh"}};
    write_gltf_file(in_, root, packed.packed);
    EXPECT_EQ(raw_elements(read_gltf(in_, report_), 0), "other bytes!");
    GltfDocument::read(in_, report_).write(out_);
    const GltfContents written = read_gltf(out_, report_);
    EXPECT_EQ(raw_elements(written, 0), "other bytes!");
    const json copy = written.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
    EXPECT_EQ(written.buffers[0].bytes().substr(size_in(copy, "byteOffset"), packed.packed.size()),
              packed.packed);
    EXPECT_TRUE(written.unpacked.empty());
}

TEST_F(GltfMeshopt, EveryContradictionIsNamed) {
    const std::string elements = "twelve bytes";
    const PackedCase packed{packed_attributes(elements.data(), 3, 4), "ATTRIBUTES", "NONE", 3, 4};
    struct Fault {
        const char* key;
        json value;
        const char* message;
    };
    const std::vector<Fault> faults = {
        {"mode", "POINTS", "its mode is 'POINTS'"},
        {"filter", "BLUR", "its filter is 'BLUR'"},
        {"filter", "QUATERNION", "ATTRIBUTES with filter QUATERNION have no stride of 4"},
        {"byteStride", 6, "ATTRIBUTES with filter NONE have no stride of 6"},
        {"count", 4, "4 elements of 4 bytes are not the 12 bytes of the view"},
        {"count", 9007199254740991, "elements of 4 bytes are not the 12 bytes"},
        {"mode", "TRIANGLES", "its data is damaged"},
        {"mode", "INDICES", "its data is damaged"},
        {"byteLength", 10, "its data is damaged"},
        {"byteLength", 1000, "covers bytes 0 to 1000, but buffers[0] has only"},
        {"buffer", 1, "covers bytes 0 to"},
        {"mode", 1, "mode is not a string"},
    };
    for (const Fault& fault : faults) {
        json root = document_of(packed, "EXT_meshopt_compression");
        root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][fault.key] = fault.value;
        EXPECT_THAT(error_of(root, packed.packed), HasSubstr(fault.message)) << fault.key;
    }
    json root = document_of(packed, "EXT_meshopt_compression");
    root["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 4}});
    EXPECT_THAT(error_of(root, packed.packed), HasSubstr("buffers[1] has no data"));
    // A few bytes with a stated size of a thousand million are refused before memory is allocated.
    root = document_of({packed.packed, "ATTRIBUTES", "NONE", 250'000'000, 4},
                       "EXT_meshopt_compression");
    EXPECT_THAT(error_of(root, packed.packed), HasSubstr("bytes cannot encode 1000000000"));
    // A byte stands for at most 1024: a longer length is refused, a shorter one fails to decode.
    const std::size_t elements_of_limit = 256 * (packed.packed.size() + 1);
    for (const auto& [count, message] : {std::pair(elements_of_limit, "bytes cannot encode"),
                                         {elements_of_limit - 1, "its data is damaged"}}) {
        root =
            document_of({packed.packed, "ATTRIBUTES", "NONE", count, 4}, "EXT_meshopt_compression");
        EXPECT_THAT(error_of(root, packed.packed), HasSubstr(message)) << count;
    }
    EXPECT_EQ(error_of(document_of(packed, "EXT_meshopt_compression"), packed.packed), "no error");
}

TEST_F(GltfMeshopt, FilesWithWrongBytesAreRefusedOrCanBeWorkedWith) {
    RELIEF_NEEDS_SHARED(folder, "data/models/gltf-ext/meshopt");
    int refused = 0;
    for (const char* name : {"BoxMeshopt.glb", "BoxTextured_meshopt.glb", "pirate.glb"}) {
        for (int i = 0; i < 100; ++i) {
            test::write_damaged_copy(folder / name, in_, random_);
            refused += test::is_refused(in_) ? 1 : 0;
        }
    }
    EXPECT_GT(refused, 30);
}

}  // namespace
}  // namespace relief
