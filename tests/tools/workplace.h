// SPDX-License-Identifier: Apache-2.0
/// \file
/// Runs programs of the project as a user does, in a folder with the layout of a checkout that was
/// built in release mode, so that commands run as the documents show them; small inputs; refusals.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"

namespace relief::test {

struct ProgramResult {
    int exit_code = 0;  ///< 128 + the signal's number, if one ended it.
    std::string out;
    std::string error;

    /// The first line of stderr, without its end.
    [[nodiscard]] std::string first_error_line() const;
};

/// Runs words[0] with the others as arguments; stdin is empty, neither output is a terminal.
///
/// \param words   words[0] without a slash is looked for among the project's own programs
/// \param folder  the program's working directory
ProgramResult run_program(const std::vector<std::string>& words,
                          const std::filesystem::path& folder);

/// The same, but for a signal that is sent as soon as `is_time` says so; not, where the program
/// ends before.
ProgramResult run_program_until(const std::vector<std::string>& words,
                                const std::filesystem::path& folder,
                                const std::function<bool()>& is_time, int signal);

/// The same as run_program() for a line as typed in a shell; the project's programs are found
/// first.
ProgramResult run_line(const std::string& line, const std::filesystem::path& folder);

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

/// A command line that must fail.
struct Refused {
    std::string line;  ///< With or without the tool's name.
    int exit_code;
    std::string error;  ///< A part of the line on stderr, after "TOOL: error: ".
};

/// Runs a line where out/ contains only `old_file`, with "old" in it.
void expect_refusal(const Workplace& workplace, const std::string& tool, const Refused& refused,
                    const std::string& old_file);
/// The same for each row of a table.
void expect_refusals(const Workplace& workplace, const std::string& tool,
                     const std::string& old_file, const std::vector<Refused>& rows);

inline GltfDocument read_document(const std::filesystem::path& file) {
    Report report;
    return GltfDocument::read(file, report);
}

inline Image picture_in(const std::filesystem::path& file) {
    return read_image(file, ImageUse::color);
}

/// Returns a part of a picture of 8 bits.
inline Image part_of(const Image& image, int x, int y, int width, int height) {
    Image part = make_image(width, height, image.channels, 8, image.color_space);
    auto to = part.as<std::uint8_t>().begin();
    for (int row = 0; row < height; ++row) {
        const auto first =
            image.as<std::uint8_t>().begin() + ((y + row) * image.width + x) * image.channels;
        to = std::copy(first, first + width * image.channels, to);
    }
    return part;
}

}  // namespace relief::test
