// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where the rows of an image being written go: the encoders behind ImageRowWriter.
/// Tests: tests/mesh/io/image/image_rows_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "relief/mesh/image_rows.h"

namespace relief {

/// What is written, checked: the format can hold it.
struct RowSinkPlan {
    std::filesystem::path file;     ///< For messages.
    std::filesystem::path written;  ///< What is really written to.
    const char* format = nullptr;   ///< OpenImageIO's name.
    ImageShape shape;
    std::map<std::string, std::string> metadata;
    ImageWriteOptions options;

    [[nodiscard]] std::size_t row_bytes() const;
};

/// An encoder that takes rows in order. What it makes does not depend on how they are cut up.
class RowSink {
  public:
    virtual ~RowSink() = default;
    /// \throws FileError
    virtual void write(const std::byte* rows, int count) = 0;
    /// After all rows: the file is whole. \throws FileError
    virtual void finish() = 0;
    /// Adds what had to be changed about the samples.
    virtual void report(Report&) const {}
};

std::unique_ptr<RowSink> make_png_sink(const RowSinkPlan& plan);
std::unique_ptr<RowSink> make_module_sink(const RowSinkPlan& plan);

}  // namespace relief
