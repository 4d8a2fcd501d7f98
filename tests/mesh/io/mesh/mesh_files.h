// SPDX-License-Identifier: Apache-2.0
/// \file
/// Mesh files with given bytes, for tests that read or refuse them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief::test {

/// A fixture with its own folder and a report for all reads.
class MeshTextTest : public testing::Test {
  protected:
    /// \param name  of the file that read() makes; its extension names the format
    explicit MeshTextTest(std::string name) : name_(std::move(name)) {}

    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }
    MeshFile read(const std::string& bytes) { return read_mesh(write(name_, bytes), report_); }
    std::string error_of(const std::string& bytes) {
        return message_of<FileError>([&] { read(bytes); });
    }

    TemporaryDirectory folder_;
    Report report_;

  private:
    std::string name_;
};

}  // namespace relief::test
