// SPDX-License-Identifier: Apache-2.0
// Parts matched by name: which names, which parts, what has no counterpart; and that neighbours do
// not catch each other's rays in a map.
#include "mesh/model_pairs.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/shapes.h"
#include "support/message_of.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ModelPairs, NamesAreWhatStandsBeforeTheWord) {
    const auto low = [](const char* name) { return pair_name(name, PairSide::low).value_or("-"); };
    EXPECT_EQ(low("Bolt_low"), "bolt");
    EXPECT_EQ(low("bolt.LOW"), "bolt");
    EXPECT_EQ(low("big bolt-low.001"), "big bolt");
    EXPECT_EQ(low("a low b_low_c"), "a low b");
    EXPECT_EQ(low("below"), "-");
    EXPECT_EQ(low("bolt_lower"), "-");
    EXPECT_EQ(low("bolt_high"), "-");
    EXPECT_EQ(low("_low"), "-");
    EXPECT_EQ(low("low"), "-");
    EXPECT_EQ(low(""), "-");
    EXPECT_EQ(pair_name("bolt_high_cap", PairSide::high), "bolt");
}

/// A model of one mesh, whose triangles are an object each.
MapModel model(const std::vector<std::string>& objects) {
    MapModel result;
    MapModelPart part;
    part.objects = objects;
    part.mesh = make_quad();
    part.mesh.triangles.clear();
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        part.mesh.triangles.emplace_back(0, 1, 2);
        part.object_of.push_back(i);
    }
    result.parts.push_back(std::move(part));
    return result;
}

TEST(ModelPairs, PartsGoByTheirObjectsElseByTheirFiles) {
    const MapModel low = model({"a_low", "b_low", "A_LOW"});
    const MapModel a = model({"one", "two"}), b = model({"x", "b_high"});
    const std::vector<NamedModel> high = {{"dir/a_high.obj", &a}, {"a-high-2.obj", &b}};
    const ModelPairs pairs = pair_models(high, {"low.obj", &low}, MatchChoice::automatic);
    ASSERT_EQ(pairs.pairs.size(), 2U);
    EXPECT_EQ(pairs.pairs[0].name, "a");
    EXPECT_THAT(pairs.pairs[0].low, ElementsAre(0, 2));
    ASSERT_EQ(pairs.pairs[0].high.size(), 3U);
    EXPECT_EQ(pairs.pairs[0].high[2].model, 1U);
    EXPECT_THAT(pairs.pairs[0].high[2].triangles, ElementsAre(0));
    EXPECT_EQ(pairs.pairs[1].name, "b");
    EXPECT_THAT(pairs.pairs[1].low, ElementsAre(1));
    EXPECT_TRUE(pair_models(high, {"low.obj", &low}, MatchChoice::all).pairs.empty());
}

TEST(ModelPairs, WhatHasNoCounterpartIsSeenByAllOrRefusedOrCounted) {
    const MapModel low = model({"a_low", "b_low", "c"}), full = model({"a_low", "b_low"});
    const MapModel high = model({"a_high", "b_high", "floor"}), some = model({"a_high"});
    const std::vector<NamedModel> all = {{"h.obj", &high}}, one = {{"h.obj", &some}};
    const ModelPairs automatic = pair_models(all, {"l.obj", &full}, MatchChoice::automatic);
    EXPECT_THAT(automatic.pairs, IsEmpty());
    EXPECT_THAT(automatic.unpaired, ElementsAre("parts without a name"));
    EXPECT_THAT(pair_models(one, {"l.obj", &full}, MatchChoice::automatic).unpaired,
                ElementsAre("b"));
    const ModelPairs named = pair_models(all, {"l.obj", &full}, MatchChoice::name);
    EXPECT_EQ(named.pairs.size(), 2U);
    EXPECT_EQ(named.report.count("high part without a low one"), 1U);
    EXPECT_EQ(test::message_of<FileError>([&] {
                  pair_models(all, {"l.obj", &low}, MatchChoice::name);
              }),
              "l.obj: 1 of its parts has no high part of the same name: c (name them X_low and "
              "X_high, or use --match all)");
    EXPECT_EQ(test::message_of<FileError>([&] {
                  pair_models(one, {"l.obj", &low}, MatchChoice::name);
              }),
              "l.obj: 2 of its parts have no high part of the same name: c, b_low (name them X_low "
              "and X_high, or use --match all)");
}

/// Two squares of side 2 side by side, each with half of the map; and 0.05 above each a high one,
/// of which the right one's is so large that it covers the left one's, 0.02 above it.
class PairedBake : public testing::Test {
  protected:
    PairedBake() {
        place_.write("low.obj",
                     "o left_low\nv -2 -1 0\nv 0 -1 0\nv 0 1 0\nv -2 1 0\n"
                     "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1\n"
                     "f 1/1 2/2 3/3 4/4\n"
                     "o right_low\nv 0 -1 0\nv 2 -1 0\nv 2 1 0\nv 0 1 0\n"
                     "f 5/2 6/5 7/6 8/3\n");
        place_.write("high.obj", high("left_high", "right_high"));
    }

    static std::string high(const std::string& left, const std::string& right) {
        return fmt::format(
            "o {}\nv -2 -1 0.05\nv 0 -1 0.05\nv 0 1 0.05\nv -2 1 0.05\n"
            "vn 0.6 0 0.8\nvn 0 0.6 0.8\nf 1//1 2//1 3//1 4//1\n"
            "o {}\nv -2 -1 0.07\nv 2 -1 0.07\nv 2 1 0.07\nv -2 1 0.07\n"
            "f 5//2 6//2 7//2 8//2\n",
            left, right);
    }

    [[nodiscard]] ProgramResult bake(const std::string& more) const {
        return place_.run("relief-bake mesh high.obj low.obj out/n.png --size 8x4 " + more);
    }

    /// What a texel's red stands for.
    [[nodiscard]] double x_of(std::size_t texel) const {
        const Image map = read_image(place_ / "out/n.png", ImageUse::data);
        return (map.as<std::uint16_t>()[3 * texel] - 32768.0) / 32767.0;
    }

    const Workplace place_;
};

TEST_F(PairedBake, NeighboursDoNotCatchEachOthersRays) {
    const ProgramResult all = bake("--match all");
    EXPECT_EQ(all.error, "");
    EXPECT_NEAR(x_of(0), 0.0, 1e-4);
    const ProgramResult result = bake("--report out/report.json");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr("          2 parts matched by name: left, right\n"));
    EXPECT_NEAR(x_of(0), 0.6, 1e-4);
    EXPECT_NEAR(x_of(7), 0.0, 1e-4);
    const json report = json::parse(place_.read("out/report.json"));
    EXPECT_EQ(report["pairs"],
              json::parse(R"([{"name": "left", "high_triangles": 2, "low_triangles": 2},
                              {"name": "right", "high_triangles": 2, "low_triangles": 2}])"));
}

TEST_F(PairedBake, GltfNodesAreMatchedLikeObjects) {
    for (const char* name : {"left", "right"}) {
        const bool is_left = std::string(name) == "left";
        place_.write(std::string(name) + "_high.obj",
                     is_left ? "v -2 -1 0.05\nv 0 -1 0.05\nv 0 1 0.05\nv -2 1 0.05\n"
                               "vn 0.6 0 0.8\nf 1//1 2//1 3//1 4//1\n"
                             : "v -2 -1 0.07\nv 2 -1 0.07\nv 2 1 0.07\nv -2 1 0.07\n"
                               "vn 0 0.6 0.8\nf 1//1 2//1 3//1 4//1\n");
    }
    EXPECT_EQ(place_
                  .run("relief-bake mesh left_high.obj right_high.obj low.obj out/n.png --size 8x4 "
                       "--match name --quiet")
                  .error,
              "");
    EXPECT_NEAR(x_of(0), 0.6, 1e-4);
    // One node for each mesh, named by it.
    ASSERT_EQ(place_.run("relief-mesh process high.obj out/high.gltf").exit_code, 0);
    json document = json::parse(place_.read("out/high.gltf"));
    document["nodes"][0]["name"] = "left_high";
    place_.write("out/high.gltf", document.dump());
    const ProgramResult result =
        place_.run("relief-bake mesh out/high.gltf low.obj out/n.png --size 8x4");
    EXPECT_THAT(result.out,
                HasSubstr("          not matched by name, as these have no counterpart: right\n"));
    EXPECT_EQ(place_.run("relief-bake mesh out/high.gltf low.obj out/n.png --size 8x4 --match name")
                  .error,
              "relief-bake: error: low.obj: 1 of its parts has no high part of the same name: "
              "right_low (name them X_low and X_high, or use --match all)\n");
}

TEST_F(PairedBake, WithoutACounterpartAllIsSeenByAllAndSaid) {
    place_.write("high.obj", high("left_high", "floor"));
    EXPECT_THAT(bake("").out, HasSubstr("          not matched by name, as these have no "
                                        "counterpart: parts without a name, right\n"));
    EXPECT_NEAR(x_of(0), 0.0, 1e-4);
}

}  // namespace
}  // namespace relief::tools
