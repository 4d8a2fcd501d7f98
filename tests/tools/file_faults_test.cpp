// SPDX-License-Identifier: Apache-2.0
// Sets of output files: a failure or a signal at any system call that changes a file leaves all
// files of a set old or all new, and no temporary file. Every call is tried.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "relief/mesh/image_file.h"
#include "support/labels.h"
#include "tools/file_faults.h"
#include "tools/workplace.h"

namespace relief::test {
namespace {

FILE_LABELS(not_sanitized);

/// The contents of a folder's files by name.
using Contents = std::map<std::string, std::string>;

class FileFaults : public testing::Test {
  protected:
    void SetUp() override {
        if (!can_inject_faults()) GTEST_SKIP() << "the kernel has no user notifications of seccomp";
        place_.write_square("square.obj");
        Image heights = make_image(4, 4, 1, 8, ColorSpace::data);
        for (std::size_t i = 0; i < 16; ++i)
            heights.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i * i);
        write_image(place_ / "bump.png", heights);
    }

    /// The command that the faults hit. `words` begin with the name of the tool.
    void set_command(std::vector<std::string> words) {
        words.front() = (place_ / "build/release/bin" / words.front()).string();
        words.insert(words.end(), {"--threads", "1", "--quiet"});
        words_ = std::move(words);
    }

    /// Files in out/ before the command.
    void set_old(Contents old) { old_ = std::move(old); }
    void set_old_from_folder() { old_ = contents(); }

    [[nodiscard]] Contents contents() const {
        Contents all;
        for (const auto& entry : std::filesystem::directory_iterator(place_ / "out"))
            all[entry.path().filename().string()] = place_.read("out" / entry.path().filename());
        return all;
    }

    FaultResult run(const Fault& fault) const {
        for (const auto& entry : std::filesystem::directory_iterator(place_ / "out"))
            std::filesystem::remove(entry.path());
        for (const auto& [name, text] : old_)
            place_.write("out/" + name, text);
        return run_with_fault(words_, place_ / ".", place_ / "out", fault);
    }

    /// Tries a fault at each call. \param count  the number of files that the command writes
    void try_all(Fault fault, std::size_t count) {
        ASSERT_EQ(run({.has_no_links = fault.has_no_links}).exit_code, 0);
        const Contents fresh = contents();
        std::size_t changed = 0;
        for (const auto& [name, text] : fresh)
            changed += old_.contains(name) && old_.at(name) == text ? 0 : 1;
        ASSERT_EQ(changed, count);
        for (fault.call = 0;; ++fault.call) {
            const FaultResult result = run(fault);
            if (result.call_name.empty()) break;
            Contents left = contents();
            SCOPED_TRACE(result.call_name + ", call " + std::to_string(fault.call) + " of " +
                         std::to_string(result.calls));
            if (fault.signal != 0) {
                EXPECT_EQ(result.exit_code, 128 + fault.signal);
                EXPECT_TRUE(left == old_ || left == fresh) << names_in(left);
                continue;
            }
            // A file that cannot be removed remains.
            if (result.call_name.starts_with("unlink")) {
                std::erase_if(left,
                              [](const auto& file) { return file.first.starts_with(".relief-"); });
            }
            EXPECT_THAT(result.exit_code, testing::AnyOf(0, 1));
            EXPECT_TRUE(left == (result.exit_code == 0 ? fresh : old_)) << names_in(left);
        }
        EXPECT_GT(fault.call, 3 * count) << "a file is created, written, completed and renamed";
    }

    void try_all_errors_and_signals(std::size_t count) {
        try_all({.error = EIO}, count);
        try_all({.signal = SIGTERM}, count);
    }

    static std::string names_in(const Contents& contents) {
        std::string names;
        for (const auto& [name, text] : contents)
            names += name + " (" + std::to_string(text.size()) + " bytes) ";
        return names;
    }

    Workplace place_;
    std::vector<std::string> words_;
    Contents old_;
};

TEST_F(FileFaults, KeepAGltfFileWithItsBufferAndImage) {
    ASSERT_EQ(place_.run("relief-mesh process square.obj square.gltf").exit_code, 0);
    ASSERT_EQ(place_.run("relief-bake bump bump.png n.png --kernel sobel3").exit_code, 0);
    set_command({"relief-mesh", "material", "square.gltf", "out/a.gltf", "--normal", "n.png"});
    set_old({{"a.gltf", "old"}, {"a.bin", "old"}});
    try_all_errors_and_signals(3);
}

TEST_F(FileFaults, KeepAnObjFileWithItsMaterials) {
    place_.write("a.mtl", "newmtl a\nKd 1 0 0\n");
    place_.write("a.obj", "mtllib a.mtl\n" + place_.read("square.obj") + "usemtl a\nf 1 2 3\n");
    set_command({"relief-mesh", "process", "a.obj", "out/a.obj"});
    set_old({{"a.obj", "old"}, {"a.mtl", "old"}});
    try_all_errors_and_signals(2);
    for (const int signal : {SIGINT, SIGHUP, SIGQUIT, SIGXCPU})
        try_all({.signal = signal}, 2);
}

TEST_F(FileFaults, KeepNewFilesConsistent) {
    place_.write("a.mtl", "newmtl a\nKd 1 0 0\n");
    place_.write("a.obj", "mtllib a.mtl\n" + place_.read("square.obj") + "usemtl a\nf 1 2 3\n");
    set_command({"relief-mesh", "process", "a.obj", "out/a.obj"});
    try_all_errors_and_signals(2);
}

TEST_F(FileFaults, KeepASetConsistentWithoutHardLinks) {
    set_command({"relief-mesh", "process", "square.obj", "out/a.gltf"});
    set_old({{"a.gltf", "old"}, {"a.bin", "old"}});
    try_all({.error = EIO, .has_no_links = true}, 2);
    try_all({.signal = SIGTERM, .has_no_links = true}, 2);
}

TEST_F(FileFaults, KeepMipLevelsConsistent) {
    ASSERT_EQ(place_.run("relief-bake bump bump.png normals.png --kernel sobel3").exit_code, 0);
    set_command({"relief-bake", "convert", "normals.png", "out/n.png", "--mips"});
    set_old({{"n.png", "old"}, {"n-mip01.png", "old"}});
    try_all_errors_and_signals(3);
}

TEST_F(FileFaults, KeepAMapAndItsModelConsistent) {
    ASSERT_EQ(place_.run("relief-mesh process square.obj out/m.gltf").exit_code, 0);
    set_old_from_folder();
    old_["n.png"] = "old";
    set_command({"relief-bake", "bump", "bump.png", "out/n.png", "--kernel", "sobel3",
                 "--write-into", "out/m.gltf"});
    try_all_errors_and_signals(3);
}

TEST_F(FileFaults, KeepSeparateLevelsOfDetailConsistent) {
    set_command({"relief-mesh", "lods", "square.obj", "out/l.gltf", "--separate", "--levels", "1",
                 "--switch", "distance"});
    set_old({{"l_LOD0.gltf", "old"}, {"l_LOD1.bin", "old"}});
    try_all_errors_and_signals(4);
}

TEST_F(FileFaults, KeepBakedMapsAndTheirModelConsistent) {
    ASSERT_EQ(place_.run("relief-mesh subdivide square.obj high.obj --levels 1").exit_code, 0);
    ASSERT_EQ(place_.run("relief-mesh process square.obj out/m.gltf").exit_code, 0);
    set_old_from_folder();
    old_["n.png"] = "old";
    set_command({"relief-bake", "mesh", "high.obj", "square.obj", "out/n.png", "--size", "8",
                 "--occlusion-map", "out/o.png", "--height-map", "out/h.png", "--write-into",
                 "out/m.gltf", "--padding", "border"});
    try_all_errors_and_signals(5);
}

}  // namespace
}  // namespace relief::test
