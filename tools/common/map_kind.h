// SPDX-License-Identifier: Apache-2.0
/// \file
/// Refuses maps of the wrong kind (map_kind_check.h), by the metadata of their file or else by
/// their texels. --assume overrides both.
/// Tests: tests/tools/map_kind_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/options.h"
#include "relief/mesh/image.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"

namespace relief::tools {

/// The kinds that --assume names. Files that are read as one of them are not examined.
using AssumedKinds = std::vector<MapKind>;

/// Adds --assume KIND. \param kinds  those as which the command reads files
AddedOption add_assume_option(CLI::App& app, AssumedKinds& assumed,
                              const std::vector<MapKind>& kinds);

/// A map that a command reads.
struct MapInput {
    std::filesystem::path file;
    /// The kinds that the command accepts. The first one is what --assume must name.
    std::vector<MapKind> accepted;
    std::map<std::string, std::string> metadata;
    int channels = 0;  ///< 0 if they are checked elsewhere.
};

/// The error for a map of the wrong kind. The message names the remedy.
class RefusedMap : public FileError {
  public:
    RefusedMap(const FileError& error, std::optional<MapKind> wanted)
        : FileError(error), wanted_(wanted) {}

    /// The kind that --assume must name to read the file anyway. Absent if it cannot be read.
    [[nodiscard]] std::optional<MapKind> wanted() const { return wanted_; }

  private:
    std::optional<MapKind> wanted_;
};

/// Checks that a map of normals has at least two channels. Nothing overrides that.
/// \throws RefusedMap if it has one
void check_normal_channels(const std::filesystem::path& file, int channels);

/// Checks the kind that the file states.
/// \return whether it is settled, because the file states a kind or it is assumed
/// \throws RefusedMap if it is not accepted, or has too few channels for normals
bool check_stated_kind(const MapInput& input, const AssumedKinds& assumed);

/// Reads eight evenly spaced bands of 32 rows, by which the kind is judged, or a small image as a
/// whole. Textures of two channels get z. \throws FileError as read_image() does
Image read_sample(const std::filesystem::path& file);

/// Checks the kind that the texels show, for a file that does not state it.
/// \param image  the samples of the file, or evenly spaced ones; floats are (n + 1) / 2
/// \throws RefusedMap if it is clearly not accepted
void check_judged_kind(const MapInput& input, const ImageView& image);

/// Checks the kind of a file that is not read otherwise. It is decoded only if it does not state
/// its kind and that is judged by the texels. \return its text entries
/// \throws RefusedMap if it is not accepted
std::map<std::string, std::string> check_kind(const std::filesystem::path& file,
                                              const std::vector<MapKind>& accepted,
                                              const AssumedKinds& assumed);

/// Returns a report without the findings about maps that are drawn as an assumed kind
/// (report_drawn_kind()).
Report without_assumed(const Report& report, const AssumedKinds& assumed);

}  // namespace relief::tools
