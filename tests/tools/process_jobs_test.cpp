// SPDX-License-Identifier: Apache-2.0
// Which files a command line of process names: what is special to models; for the rest see
// file_jobs_test.cpp.
#include "process_jobs.h"

#include <gtest/gtest.h>

#include "support/message_of.h"
#include "support/shared_data.h"
#include "tools/file_jobs_words.h"

namespace relief::tools {
namespace {

using test::jobs_in_words;
using test::message_of;
using test::TemporaryDirectory;

std::string model_refusal(const FileWords& words, std::optional<ModelFormat> format = {}) {
    return message_of<UsageError>([&] { model_jobs_of(words, format); });
}

TEST(ProcessJobs, InAFolderModelsKeepTheirNamesAndFormatsWhereThoseCanBeWritten) {
    EXPECT_EQ(jobs_in_words(
                  model_jobs_of({{"x/a.obj", "b.PLY", "c.stl", "d.off", "e.v2.gltf"}, "out/"}, {})),
              "x/a.obj -> out/a.obj, b.PLY -> out/b.PLY, c.stl -> out/c.glb, d.off -> out/d.glb, "
              "e.v2.gltf -> out/e.v2.gltf");
    EXPECT_EQ(jobs_in_words(model_jobs_of({{"x/a.obj", "e.v2.gltf"}, "out/"}, ModelFormat::ply)),
              "x/a.obj -> out/a.ply, e.v2.gltf -> out/e.v2.ply");
}

TEST(ProcessJobs, TwoModelsThatGetOneNameByTheirFormatAreRefused) {
    const TemporaryDirectory folder;
    const std::string here = folder.path().string() + "/";
    EXPECT_EQ(model_refusal({{here + "a.glb", here + "a.obj"}, here}, ModelFormat::obj),
              here + "a.glb and " + here + "a.obj: would both become " + here + "a.obj");
}

TEST(ProcessJobs, RefusesFormatsThatDoNotServe) {
    EXPECT_EQ(model_refusal({{"a.obj", "b.obj", "c.obj"}, "d.glb"}),
              "-o d.glb: is one file for 3 models, and no folder");
    EXPECT_EQ(model_refusal({{"a.obj", "b.glb"}, {}}, ModelFormat::obj),
              "--format obj: the name b.glb says the format already");
    EXPECT_EQ(model_refusal({{"a.txt"}, "out/"}), "a.txt: .txt is not a format that can be read");
    const TemporaryDirectory folder;
    EXPECT_EQ(model_refusal({{folder.path()}, "out/"}), folder.path().string() + ": is a folder");
}

}  // namespace
}  // namespace relief::tools
