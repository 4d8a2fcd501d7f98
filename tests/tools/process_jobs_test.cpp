// SPDX-License-Identifier: Apache-2.0
// Which files a command line of process names: what every form comes to, and what is refused.
#include "process_jobs.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/message_of.h"
#include "support/shared_data.h"

namespace relief::tools {
namespace {

using test::message_of;
using test::TemporaryDirectory;

/// "a.obj -> out/a.obj, ..."
std::string jobs_in_words(const JobList& list) {
    std::string text;
    for (const Job& job : list.jobs) {
        text += (text.empty() ? "" : ", ") + job.input.string() + " -> " + job.output.string();
    }
    return text;
}

std::string refusal(const FileWords& words) {
    return message_of<UsageError>([&] { jobs_of(words); });
}

TEST(ProcessJobs, TwoFilesAreInAndOut) {
    const JobList list = jobs_of({{"a.obj", "b.glb"}, {}, {}});
    EXPECT_EQ(jobs_in_words(list), "a.obj -> b.glb");
    EXPECT_FALSE(list.folder);
}

TEST(ProcessJobs, OutputMayBeAFileForOneModel) {
    EXPECT_EQ(jobs_in_words(jobs_of({{"a.obj"}, "b.glb", {}})), "a.obj -> b.glb");
    EXPECT_FALSE(jobs_of({{"a.obj"}, "b.glb", {}}).folder);
}

TEST(ProcessJobs, InAFolderModelsKeepTheirNamesAndFormatsWhereThoseCanBeWritten) {
    const JobList list = jobs_of({{"x/a.obj", "b.PLY", "c.stl", "d.off", "e.v2.gltf"}, "out/", {}});
    EXPECT_EQ(jobs_in_words(list),
              "x/a.obj -> out/a.obj, b.PLY -> out/b.PLY, c.stl -> out/c.glb, d.off -> out/d.glb, "
              "e.v2.gltf -> out/e.v2.gltf");
    EXPECT_EQ(list.folder, "out/");
    EXPECT_EQ(jobs_in_words(jobs_of({{"x/a.obj", "e.v2.gltf"}, "out/", ModelFormat::ply})),
              "x/a.obj -> out/a.ply, e.v2.gltf -> out/e.v2.ply");
}

TEST(ProcessJobs, WhatExistsAsAFolderNeedsNoSlash) {
    const TemporaryDirectory folder;
    EXPECT_EQ(jobs_in_words(jobs_of({{"a.obj"}, folder.path().string(), {}})),
              "a.obj -> " + (folder / "a.obj").string());
}

TEST(ProcessJobs, AModelMayReplaceItselfButNoOther) {
    const TemporaryDirectory folder;
    const std::string here = folder.path().string() + "/";
    EXPECT_EQ(jobs_of({{here + "a.glb", here + "b.glb"}, here, {}}).jobs.size(), 2U);
    EXPECT_EQ(refusal({{here + "a.glb", here + "a.obj"}, here, ModelFormat::obj}),
              here + "a.glb and " + here + "a.obj: would both become " + here + "a.obj");
    // The same folder by two names.
    std::filesystem::create_directory(folder / "x");
    EXPECT_EQ(refusal({{here + "a.ply", here + "x/../a.ply"}, here, {}}),
              here + "x/../a.ply: named twice");
    EXPECT_EQ(refusal({{here + "x/a.ply", here + "a.ply"}, here + "x/", {}}),
              here + "x/a.ply and " + here + "a.ply: would both become " + here + "x/a.ply");
}

TEST(ProcessJobs, RefusesWhatCouldBeReadInTwoWays) {
    EXPECT_EQ(refusal({{}, {}, {}}), "IN is missing");
    EXPECT_EQ(refusal({{}, "out/", {}}), "IN is missing");
    EXPECT_EQ(refusal({{"a.obj"}, {}, {}}), "OUT is missing");
    EXPECT_EQ(refusal({{"a.obj", "b.obj", "c.obj"}, {}, {}}),
              "3 files: which are to be read, and which to be written?");
    EXPECT_EQ(refusal({{"a.obj", "b.obj"}, "c.glb", {}}),
              "-o c.glb: is one file for 2 models, and no folder");
    EXPECT_EQ(refusal({{"a.obj"}, "nothing", {}}),
              "-o nothing: no extension says what format this is");
    EXPECT_EQ(refusal({{"a.obj", "b.glb"}, {}, ModelFormat::obj}),
              "--format obj: the name b.glb says the format already");
    EXPECT_EQ(refusal({{"a.obj", "x/../a.obj"}, "out/", {}}), "x/../a.obj: named twice");
    EXPECT_EQ(refusal({{"a.obj", "x/a.obj"}, "out/", {}}),
              "a.obj and x/a.obj: would both become out/a.obj");
    EXPECT_EQ(refusal({{"a.txt"}, "out/", {}}), "a.txt: .txt is not a format that can be read");
    const TemporaryDirectory folder;
    EXPECT_EQ(refusal({{folder.path()}, "out/", {}}), folder.path().string() + ": is a folder");
}

}  // namespace
}  // namespace relief::tools
