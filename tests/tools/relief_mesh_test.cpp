// SPDX-License-Identifier: Apache-2.0
// The commands `relief-mesh process` and `info`: output files, printed text, and errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/gltf_document.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::degrees_between;
using test::expect_refusals;
using test::ProgramResult;
using test::read_document;
using test::Workplace;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// The tolerance of float normals that are read from a file.
constexpr double normal_tolerance = 1e-4;

/// Writes a glTF file with two primitives of the same triangle without normals. Only the first has
/// texture coordinates.
void write_two_primitives(const Workplace& workplace, const std::string& name) {
    // Three positions (0,0,0) (1,0,0) (0,1,0), then three texture coordinates (0,0) (1,0) (0,1).
    const std::vector<float> numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1};
    workplace.write(name + ".bin", std::string(reinterpret_cast<const char*>(numbers.data()),
                                               numbers.size() * sizeof(float)));
    workplace.write(name + ".gltf", R"({
        "asset": {"version": "2.0"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "buffers": [{"uri": ")" + name + R"(.bin", "byteLength": 60}],
        "bufferViews": [{"buffer": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "meshes": [{"name": "Pair", "primitives": [
            {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}},
            {"attributes": {"POSITION": 0}}]}]
    })");
}

TEST(ProcessCommand, GivesAMeshFileNormalsAndTangents) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result =
        workplace.run("relief-mesh process square.obj out/square.glb --tangents mikktspace");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "") << "progress is for terminals";
    EXPECT_THAT(result.out, HasSubstr("read      square.obj: Wavefront OBJ, 1 primitive, 2 "
                                      "triangles, 4 vertices\n"
                                      "normals   computed, averaged by angle\n"
                                      "tangents  computed, MikkTSpace\n"
                                      "splits    none needed\n"
                                      "findings  none\n"));
    EXPECT_THAT(result.out, HasSubstr("wrote     out/square.glb: "));
    EXPECT_EQ(workplace.outputs(), "square.glb");

    const Mesh mesh = read_document(workplace / "out/square.glb").mesh({0, 0});
    ASSERT_EQ(mesh.triangles.size(), 2U);
    ASSERT_EQ(mesh.normals.size(), 4U);
    ASSERT_EQ(mesh.tangents.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_LT(degrees_between(mesh.normals[i], {0, 0, 1}), normal_tolerance);
        EXPECT_LT(degrees_between(glm::vec3(mesh.tangents[i]), {1, 0, 0}), normal_tolerance);
        EXPECT_EQ(mesh.tangents[i].w, 1.0F) << "upright texture";
    }
}

TEST(ProcessCommand, ReplacesItsInputWhenAskedTo) {
    const Workplace workplace;
    workplace.write_square("out/square.obj");
    const ProgramResult result =
        workplace.run("relief-mesh process out/square.obj out/square.obj --normals area");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(workplace.read("out/square.obj"), HasSubstr("vn 0 0 1"));
    EXPECT_EQ(workplace.outputs(), "square.obj");
}

TEST(ProcessCommand, FlatNormalsSplitTheCornersOfACube) {
    const Workplace workplace;
    workplace.write("cube.obj",
                    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    const ProgramResult result =
        workplace.run("relief-mesh process cube.obj out/cube.ply --normals flat");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    // Each of the eight corners is in three faces.
    EXPECT_THAT(result.out, HasSubstr("normals   computed, one per triangle\n"));
    EXPECT_THAT(result.out, HasSubstr("splits    8 -> 24 vertices\n"));
}

/// Returns a cube with shared corners, with or without smoothing groups.
std::string cube_text(bool with_groups) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    const char* faces[] = {"4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"};
    for (int i = 0; i < 6; ++i) {
        // Top and bottom have no group, and the sides share one.
        if (with_groups) text += i < 2 ? "s off\n" : "s 1\n";
        text += std::string("f ") + faces[i] + "\n";
    }
    return text;
}

TEST(ProcessCommand, ACreaseAngleMakesEdgesHard) {
    const Workplace workplace;
    workplace.write("cube.obj", cube_text(false));
    const auto splits = [&](const std::string& options) {
        const ProgramResult result = workplace.run(
            "relief-mesh process cube.obj out/cube.ply --report out/r.json " + options);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return json::parse(workplace.read("out/r.json"))["primitives"][0]["vertices_written"]
            .get<int>();
    };
    EXPECT_EQ(splits("--normals auto --crease 89"), 24);
    EXPECT_EQ(splits("--normals auto --crease 90"), 8);
    EXPECT_EQ(splits("--normals auto"), 8);
    const json report = json::parse(workplace.read("out/r.json"));
    EXPECT_EQ(report["primitives"][0]["normal_method"], "auto");
    EXPECT_EQ(report["primitives"][0]["vertices_by_area"], 0);
}

TEST(ProcessCommand, SmoothingGroupsOfAnObjFileAreFollowed) {
    const Workplace workplace;
    workplace.write("cube.obj", cube_text(true));
    const ProgramResult followed =
        workplace.run("relief-mesh process cube.obj out/cube.ply --normals angle");
    ASSERT_EQ(followed.exit_code, 0) << followed.error;
    EXPECT_THAT(followed.out, HasSubstr("normals   computed, averaged by angle, within the file's "
                                        "smoothing groups\n"
                                        "tangents  none\n"
                                        "splits    8 -> 16 vertices\n"));
    const ProgramResult ignored = workplace.run(
        "relief-mesh process cube.obj out/cube.ply --normals angle --ignore-smoothing-groups");
    EXPECT_THAT(ignored.out, HasSubstr("splits    none needed\n"));
}

TEST(ProcessCommand, NearVerticesShareNormalsWithinTheTolerance) {
    const Workplace workplace;
    workplace.write("roof.obj",
                    "v -1 0 0\nv 0 0 0\nv 0 1 0\nv 0.001 0 0\nv 0.001 0 -1\nv 0.001 1 0\n"
                    "f 1 2 3\nf 4 5 6\n");
    const auto normal_of_ridge = [&](const std::string& options) {
        const ProgramResult result =
            workplace.run("relief-mesh process roof.obj out/roof.glb --normals uniform " + options);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return read_document(workplace / "out/roof.glb").mesh({0, 0}).normals[1];
    };
    EXPECT_LT(degrees_between(normal_of_ridge(""), {0, 0, 1}), normal_tolerance);
    EXPECT_LT(degrees_between(normal_of_ridge("--weld 0.01"), {1, 0, 1}), normal_tolerance);
}

TEST(ProcessCommand, BrokenNormalsAreRepairedOnRequestAlone) {
    const Workplace workplace;
    workplace.write("bad.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 3\nvn 0 0 0\nvn nan 0 0\n"
                    "f 1//1 2//2 3//3\n");
    const ProgramResult kept = workplace.run("relief-mesh process bad.obj out/bad.ply --strict");
    EXPECT_EQ(kept.exit_code, 3);
    EXPECT_THAT(kept.out, HasSubstr("kept as it is"));
    const ProgramResult repaired =
        workplace.run("relief-mesh process bad.obj out/bad.glb --repair-normals --strict");
    EXPECT_EQ(repaired.exit_code, 3) << "a repair is a finding";
    for (const glm::vec3& normal : read_document(workplace / "out/bad.glb").mesh({0, 0}).normals)
        EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

TEST(ProcessCommand, GltfWithoutNormalsGetsFlatOnes) {
    const Workplace workplace;
    write_two_primitives(workplace, "pair");
    const ProgramResult result = workplace.run("relief-mesh process pair.gltf out/pair.glb");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("normals   computed, one per triangle\n"
                                      "tangents  none\n"));
}

TEST(ProcessCommand, GltfOutputNamesItsBuffer) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result = workplace.run("relief-mesh process square.obj out/square.gltf");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr(", its buffer and images beside it\n"));
    EXPECT_EQ(workplace.outputs(), "square.bin square.gltf");
    EXPECT_EQ(read_document(workplace / "out/square.gltf").mesh({0, 0}).normals.size(), 4U);
}

TEST(ProcessCommand, ReportsPrimitivesWithoutTangents) {
    const Workplace workplace;
    write_two_primitives(workplace, "pair");
    const ProgramResult result = workplace.run(
        "relief-mesh process pair.gltf out/pair.glb --tangents mikktspace --report out/r.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out,
                HasSubstr("tangents  computed, MikkTSpace in 1 primitive; none in 1 primitive\n"));
    const GltfDocument document = read_document(workplace / "out/pair.glb");
    EXPECT_EQ(document.mesh({0, 0}).tangents.size(), 3U);
    EXPECT_TRUE(document.mesh({0, 1}).tangents.empty());

    const json report = json::parse(workplace.read("out/r.json"));
    ASSERT_EQ(report["findings"].size(), 1U);
    EXPECT_EQ(report["findings"][0]["where"], document.describe({0, 1}));
    EXPECT_EQ(report["findings"][0]["kind"], "primitive without texture coordinates");
    EXPECT_EQ(report["primitives"][0]["tangents"], "computed");
    EXPECT_EQ(report["primitives"][1]["tangents"], "none");
}

TEST(ProcessCommand, StrictExitsWith3AfterWriting) {
    const Workplace workplace;
    workplace.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");
    const std::string line = "relief-mesh process bad.obj out/bad.ply --normals angle";
    const ProgramResult lenient = workplace.run(line);
    EXPECT_EQ(lenient.exit_code, 0);
    EXPECT_EQ(lenient.error, "");
    EXPECT_THAT(lenient.out, Not(HasSubstr("findings  none")));

    std::filesystem::remove(workplace / "out/bad.ply");
    const ProgramResult strict = workplace.run(line + " --strict --quiet");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_EQ(strict.out, "");
    EXPECT_THAT(strict.error, testing::MatchesRegex("relief-mesh: warning: bad.obj: [0-9]+ "
                                                    "findings? .exit code 3, because of "
                                                    "--strict.\n"));
    EXPECT_EQ(workplace.outputs(), "bad.ply");
}

TEST(ProcessCommand, StrictIsSilentAboutAFaultlessInput) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result =
        workplace.run("relief-mesh process square.obj out/square.ply --strict --quiet");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out + result.error, "");
}

TEST(ProcessCommand, OutputDoesNotDependOnThreads) {
    const Workplace workplace;
    for (const char* threads : {"1", "2", "7"}) {
        const ProgramResult result =
            workplace.run(std::string("relief-mesh process data/vase.obj out/") + threads +
                          ".glb --normals angle --tangents mikktspace --threads " + threads);
        ASSERT_EQ(result.exit_code, 0) << result.error;
    }
    EXPECT_EQ(workplace.read("out/1.glb"), workplace.read("out/2.glb"));
    EXPECT_EQ(workplace.read("out/1.glb"), workplace.read("out/7.glb"));
}

TEST(ProcessCommand, MissingTexturesOfMtlAreOmittedAndReported) {
    const Workplace workplace;
    workplace.write_square("plain.obj");
    workplace.write("square.mtl", "newmtl wall\nKd 0.5 0.25 1\nmap_Kd gone.png\n");
    workplace.write("square.obj", "mtllib square.mtl\nusemtl wall\n" + workplace.read("plain.obj"));
    for (const std::string verb : {"process square.obj out/a.glb --tangents mikktspace --strict",
                                   "subdivide square.obj out/a.glb --strict"}) {
        const ProgramResult result = workplace.run("relief-mesh " + verb);
        EXPECT_EQ(result.exit_code, 3) << result.error;
        EXPECT_THAT(result.out, HasSubstr("1 x unreadable diffuse texture of material 'wall' "
                                          "(material 0): left out: "));
        EXPECT_THAT(result.out, HasSubstr("gone.png: no such file"));
        Report report;
        const GltfView view = GltfDocument::read(workplace / "out/a.glb", report).view();
        EXPECT_TRUE(view.images.empty());
        ASSERT_EQ(view.materials.size(), 1U);
        EXPECT_FALSE(view.materials[0].diffuse_texture);
        EXPECT_EQ(view.materials[0].metallic_roughness->base_color, glm::vec3(0.5F, 0.25F, 1.0F));
        EXPECT_EQ(view.materials[0].opacity, 1.0F);
    }
}

TEST(ProcessCommand, ReportsContentThatTheFormatCannotStore) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    ASSERT_EQ(
        workplace.run("relief-mesh process square.obj out/a.glb --tangents mikktspace").exit_code,
        0);
    const ProgramResult result = workplace.run("relief-mesh process out/a.glb out/a.obj");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("omitted   tangents (cannot be stored in .obj)\n"));
}

TEST(ProcessCommand, KeepsTangentsAndTexturesByDefault) {
    RELIEF_NEEDS_SHARED(bottle, "data/models/gltf/WaterBottle/glTF/WaterBottle.gltf");
    const Workplace workplace;
    const std::string input = bottle.string();
    const ProgramResult kept = workplace.run("relief-mesh process " + input + " out/kept.glb");
    ASSERT_EQ(kept.exit_code, 0) << kept.error;
    EXPECT_THAT(kept.out, HasSubstr("normals   kept\ntangents  kept\n"));
    const GltfDocument before = read_document(input);
    const GltfDocument after = read_document(workplace / "out/kept.glb");
    EXPECT_EQ(before.mesh({0, 0}).tangents, after.mesh({0, 0}).tangents);
    EXPECT_EQ(before.view().images.size(), after.view().images.size());

    const ProgramResult removed = workplace.run(
        "relief-mesh process out/kept.glb out/removed.glb --tangents none --normals angle");
    ASSERT_EQ(removed.exit_code, 0) << removed.error;
    EXPECT_THAT(removed.out,
                HasSubstr("normals   computed, averaged by angle\ntangents  removed\n"));
}

TEST(InfoCommand, CountsContent) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result = workplace.run("relief-mesh info square.obj");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out,
                HasSubstr("contents  2 triangles, 4 vertices, 1 primitive\n"
                          // 4 x (3 + 2) floats, 6 indices.
                          "memory    80 B of attributes, 24 B of indices, the same on the "
                          "GPU\n"
                          "bounds    (-1, -1, 0) to (1, 1, 0), size 2 x 2 x 0\n"));
    EXPECT_THAT(result.out, HasSubstr("2 triangles, 4 vertices; texcoords\n"));
}

TEST(InfoCommand, PrintsOneJsonObject) {
    const Workplace workplace;
    write_two_primitives(workplace, "pair");
    const ProgramResult result = workplace.run("relief-mesh info pair.gltf --json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const json info = json::parse(result.out);
    EXPECT_EQ(info["format"], "glTF");
    EXPECT_EQ(info["triangles"], 2);
    EXPECT_EQ(info["vertices"], 6);
    EXPECT_EQ(info["instances"], 2);
    EXPECT_EQ(info["memory"], json({{"attributes", 96}, {"indices", 24}}));
    EXPECT_EQ(info["primitives"][1]["memory"], json({{"attributes", 36}, {"indices", 12}}));
    EXPECT_EQ(info["bounds"]["max"], json({1.0, 1.0, 0.0}));
    EXPECT_EQ(info["primitives"][0]["attributes"], json({"texcoords"}));
    EXPECT_EQ(info["primitives"][1]["attributes"], json::array());
    EXPECT_EQ(info["primitives"][1]["bounds"]["min"], json({0.0, 0.0, 0.0}));
}

/// The processor time of this process and of its ended children, in seconds.
double processor_seconds() {
    double sum = 0.0;
    for (const int whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        ::getrusage(whose, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime})
            sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return sum;
}

TEST_LABELS(not_sanitized);
TEST(InfoCommand, DecodesAMeshOnceForAllItsInstances) {
    const Workplace workplace;
    MeshFile sphere;
    sphere.mesh = make_sphere(400, 100);
    sphere.mesh.colors.assign(sphere.mesh.positions.size(), glm::vec4(0.5F));
    GltfDocument::from_mesh(sphere).write(workplace / "one.gltf");
    json root = json::parse(workplace.read("one.gltf"));
    constexpr int count = 300;
    for (int i = 0; i < count; ++i) {
        root["nodes"][i] = {{"mesh", 0}, {"translation", {0, 0, 3 * i}}};
        root["scenes"][0]["nodes"][i] = i;
    }
    workplace.write("many.gltf", root.dump());

    const GltfDocument document = read_document(workplace / "many.gltf");
    double decoding = -processor_seconds();
    for (int i = 0; i < count; ++i)
        ASSERT_FALSE(document.mesh({0, 0}).positions.empty());
    decoding += processor_seconds();
    double describing = -processor_seconds();
    const json info = json::parse(workplace.run("relief-mesh info many.gltf --json").out);
    describing += processor_seconds();
    EXPECT_EQ(info["instances"], count);
    EXPECT_EQ(info["primitives"].size(), 1U);
    EXPECT_EQ(info["bounds"]["max"][2], 3.0 * (count - 1) + 1.0);
    EXPECT_LT(describing, 0.6 * decoding)
        << describing << " s; " << decoding << " s to decode " << count << " times";
}

TEST(InfoCommand, DescribesARealScene) {
    RELIEF_NEEDS_SHARED(bottle, "data/models/gltf/WaterBottle/glTF/WaterBottle.gltf");
    const Workplace workplace;
    const json info = json::parse(workplace.run("relief-mesh info --json " + bottle.string()).out);
    EXPECT_EQ(info["triangles"], 4510);
    EXPECT_EQ(info["images"], 4);
    EXPECT_EQ(info["primitives"][0]["attributes"], json({"normals", "texcoords", "tangents"}));
    EXPECT_THAT(info["materials"][0]["textures"].get<std::vector<std::string>>(),
                ElementsAre("base color", "metallic-roughness", "normal", "occlusion", "emission"));
}

TEST(InfoCommand, DescribesCompression) {
    RELIEF_NEEDS_SHARED(pirate, "data/models/gltf-ext/meshopt/pirate.glb");
    const Workplace workplace;
    EXPECT_THAT(workplace.run("relief-mesh info " + pirate.string()).out,
                HasSubstr("packed    EXT_meshopt_compression of 3 buffer views\n"));
    const json info = json::parse(workplace.run("relief-mesh info --json " + pirate.string()).out);
    EXPECT_EQ(info["compression"], json({"EXT_meshopt_compression of 3 buffer views"}));
}

TEST(ProcessCommand, ReportsDecompression) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    const Workplace workplace;
    const auto file = models / "MorphPrimitivesTest/glTF-Draco/MorphPrimitivesTest.gltf";
    const ProgramResult result = workplace.run("relief-mesh process " + file.string() +
                                               " out/plain.glb --report out/plain.json --strict");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("unpacked  KHR_draco_mesh_compression of 2 primitives "
                                      "(written uncompressed)\n"));
    const json report = json::parse(workplace.read("out/plain.json"));
    EXPECT_EQ(report["decompressed"], json({"KHR_draco_mesh_compression of 2 primitives"}));
    const json info = json::parse(workplace.run("relief-mesh info --json out/plain.glb").out);
    EXPECT_EQ(info["compression"], json::array());
}

TEST(MeshRefusal, StatesTheReasonAndWritesNoFile) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write_square("plain.obj", true);
    workplace.write("empty.obj", "");
    workplace.write("noise.glb", "this is no glTF");
    workplace.write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    write_two_primitives(workplace, "pair");
    workplace.write("square.mtl", "newmtl wall\n");
    std::filesystem::create_symlink("square.mtl", workplace / "link.json");
    expect_refusals(
        workplace, "relief-mesh", "old.glb",
        {{"relief-mesh process missing.obj out/old.glb", 1, "missing.obj: "},
         {"relief-mesh process missing.glb out/old.glb", 1, "missing.glb: "},
         {"relief-mesh process empty.obj out/old.glb", 1, "empty.obj: "},
         {"relief-mesh process noise.glb out/old.glb", 1, "noise.glb: "},
         {"relief-mesh process index.obj out/old.glb", 1, "index.obj: "},
         {"relief-mesh process . out/old.glb", 2, ".: is a folder (name the files in it)"},
         {"relief-mesh process square.txt out/old.glb", 2,
          "square.txt: .txt is not a format that can be read (use one of .glb, .gltf, .obj, "
          ".ply, .stl, .off)"},
         {"relief-mesh process square.obj out/square.stl", 2,
          "out/square.stl: .stl is not a format that can be written (use one of .glb, .gltf, "
          ".obj, .ply)"},
         {"relief-mesh process square.obj out/square", 2,
          "out/square: has no extension (use one of .glb, "},
         {"relief-mesh process square.obj out/square.obj --tangents mikktspace", 2,
          "--tangents mikktspace: .obj cannot store tangents (write .glb or .gltf)"},
         {"relief-mesh process square.obj out/old.glb --crease 30", 2,
          "--crease: applies only to averaged normals: --normals auto, angle, max, ..."},
         {"relief-mesh process square.obj out/old.glb --normals flat --weld 1", 2,
          "--weld: applies only to averaged normals"},
         {"relief-mesh process square.obj out/old.glb --normals max --repair-normals", 2,
          "--repair-normals: applies only to kept normals"},
         {"relief-mesh process square.obj out/old.glb --normals max --crease 181", 2,
          "--crease 181: "},
         {"relief-mesh process square.obj out/old.glb --normals max --weld -1", 2, "--weld -1: "},
         {"relief-mesh process plain.obj out/old.glb --tangents mikktspace", 1,
          "plain.obj: no texture coordinates, so there can be no tangents (unwrap the model "
          "first with relief-mesh unwrap, or leave --tangents out)"},
         {"relief-mesh process square.obj nowhere/square.glb", 1,
          "nowhere/square.glb: the folder nowhere does not exist (create it first)"},
         {"relief-mesh process square.obj /dev/full/square.glb", 1, "/dev/full/square.glb: "},
         {"relief-mesh process square.obj out/new.glb --report nowhere/r.json", 1,
          "nowhere/r.json: the folder nowhere does not exist (create it first)"},
         {"relief-mesh process square.obj out/new.glb --report out", 1, "out: is a folder"},
         {"relief-mesh process square.obj out/new.glb --report /dev/full", 1,
          "/dev/full: is a device or a pipe"},
         {"relief-mesh process square.obj out/new.glb --report ./out/new.glb", 2,
          "--report ./out/new.glb: is also the input or the output"},
         {"relief-mesh process square.obj out/new.gltf --report out/new.bin", 2,
          "--report out/new.bin: is the name of a model or an image (use .json)"},
         {"relief-mesh process square.obj out/new.glb --report link.json", 2,
          "--report link.json: is a link to "},
         {"relief-mesh info missing.obj", 1, "missing.obj: "},
         {"relief-mesh info noise.glb --json", 1, "noise.glb: "},
         {"relief-mesh info", 2, "IN is missing (see relief-mesh info --help)"}});
}

}  // namespace
}  // namespace relief::tools
