// SPDX-License-Identifier: Apache-2.0
/// \file
/// A folder laid out like a checkout that was built in release mode, so that commands can be run as
/// the documents show them, and small inputs to run them on.
#pragma once

#include <filesystem>
#include <string>

#include "support/shared_data.h"
#include "tools/run_program.h"

namespace relief::test {

/// A normal map of the project's own.
inline const std::string bricks_map = "data/scenes/bricks-normal.png";

/// data/, conformance/ and scripts/ as in the sources, build/release/bin, and an empty out/.
/// Removed at exit.
class Workplace {
  public:
    Workplace();

    [[nodiscard]] std::filesystem::path operator/(const std::filesystem::path& name) const {
        return folder_ / name;
    }

    /// Runs a line there as typed in a shell.
    [[nodiscard]] ProgramResult run(const std::string& line) const;

    void write(const std::filesystem::path& name, const std::string& text) const;
    [[nodiscard]] std::string read(const std::filesystem::path& name) const;

    /// A square of two triangles in the xy plane from (-1,-1) to (1,1), facing +z; with texture
    /// coordinates unless `plain`.
    void write_square(const std::filesystem::path& name, bool plain = false) const;

    /// The upper left 256 x 256 texels of data/bricks-height.png: measuring kernels on all of it
    /// takes eight times as long.
    void write_bricks(const std::filesystem::path& name) const;

    /// Puts that part in the place of data/bricks-height.png.
    void shrink_bricks() const;

    /// All that stands in out/, sorted, by name: no half or temporary file escapes.
    [[nodiscard]] std::string outputs() const;

  private:
    TemporaryDirectory folder_;
};

}  // namespace relief::test
