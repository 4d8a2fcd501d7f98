// SPDX-License-Identifier: Apache-2.0
/// \file
/// For the commands that change triangles: their files and summaries, measured distances of meshes,
/// and pictures that compare levels of detail with the input at the sizes at which they may take
/// over. OpenGL is loaded by the constructor of LevelPictures, so other commands do not pay for it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/file_jobs.h"
#include "common/measuring.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/model.h"
#include "relief/mesh/topology.h"

namespace relief::tools {

/// The options that all commands have which change triangles.
struct ReshapeRequest {
    FileWords words;
    std::optional<ModelFormat> format;  ///< Of files in an output folder.
    NormalMode normals = NormalMode::keep;
    /// The measurement of the distance between IN and OUT; `full`: at all vertices and inside the
    /// triangles.
    std::optional<Measuring> measuring;
    ReportOptions report;
    GeneralOptions general;
};

/// Adds the files, --normals, --report, --strict, --threads and --quiet.
/// \param about_normals  empty: the command has no --normals
void add_reshape_options(CLI::App& app, ReshapeRequest& request, const std::string& about_normals);

/// Returns how distances are measured: by default at random samples, and not at all if nothing is
/// reported.
Measuring measuring_of(const ReshapeRequest& request);

/// A change of all meshes of a model that adds lines of its own to the summary.
using SummarizedChange = std::function<std::vector<FramedMesh>(
    std::span<const TriangleInput> meshes, std::span<Report> reports, Report& whole,
    Summary& results)>;

/// Runs a command: reads, changes and writes the models, and reports.
///
/// \param options  the command's options for the report
/// \param max_triangles  --triangles
/// \param with_conditions  counts the conditions of `relief-mesh check` before and after
/// \throws UsageError, FileError; then no file is written
ExitCode reshape(const CLI::App& app, const ReshapeRequest& request, const ModelChange& change,
                 Measuring measuring, const Json& options,
                 std::optional<std::size_t> max_triangles = std::nullopt,
                 bool with_conditions = false);
ExitCode reshape(const CLI::App& app, const ReshapeRequest& request, const SummarizedChange& change,
                 Measuring measuring, const Json& options,
                 std::optional<std::size_t> max_triangles = std::nullopt,
                 bool with_conditions = false);

/// Returns the positions and triangles.
Mesh without_attributes(const Mesh& mesh);

/// Joins the distances of several meshes. Means are over area.
SurfaceDistance joined_distance(const std::vector<SurfaceDistance>& distances);

/// {"mean", "rms", "max", "mean_degrees", "max_degrees",
/// "omitted"}
Json distance_json(const DistanceStats& stats);

/// The screen on which the pixels of levels of detail are counted.
inline constexpr double lod_screen_width = 1920.0;
inline constexpr double lod_screen_height = 1080.0;

/// The size at which a level may take over: the diameter, in pixels, of the sphere around its mesh.
struct LevelSwitch {
    double pixels = 0.0;
    /// The mean FLIP difference of the level from the input over the pixels that one of them
    /// covers, in the worst view at that size.
    double flip = 0.0;
    /// The same of the input that is moved by the error, in the same view.
    double moved_flip = 0.0;
};

/// Pictures of the meshes of a document and of their levels, with their materials.
class LevelPictures {
  public:
    /// \param pixel_error  the input that is moved by it is what a level is compared with
    /// \throws Error with the reason if nothing can be drawn
    explicit LevelPictures(double pixel_error);
    ~LevelPictures();
    LevelPictures(const LevelPictures&) = delete;
    LevelPictures& operator=(const LevelPictures&) = delete;

    /// Sets the input: meshes as they are in the document now. Replaces an earlier input.
    /// \param file  the document's file, for messages
    void set_input(const GltfDocument& document, std::span<const std::size_t> meshes,
                   const std::filesystem::path& file);
    /// Sets the level: as many meshes, in the same order.
    void set_level(const GltfDocument& document, std::span<const std::size_t> meshes,
                   const std::filesystem::path& file);

    /// Finds the largest size, up to the screen's height, at which the level of a mesh differs from
    /// the input, in each of three views, no more than the input that is moved by the error. Sizes
    /// are powers of 2^(1/4), at least 4 pixels. Above 215 pixels, pictures of this size are
    /// compared, with an error that is the same part of the mesh.
    ///
    /// \param mesh   index in the lists of set_input() and set_level()
    /// \param start  the size at which the search begins, in pixels; 64 if it is larger
    /// \param most   the largest size
    /// \return none if the mesh has no extent or if its size exceeds the range of a camera
    /// \throws GpuError, InvalidInput if it cannot be drawn
    std::optional<LevelSwitch> find_switch(std::size_t mesh, double start, double most);

    /// "OSMesa"
    [[nodiscard]] const std::string& backend_name() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Writes a page (docs/page.md) with the input on the left of a line, and one of its levels on the
/// right, in the default light.
/// \param levels  files, LOD0 first
/// \throws Error if they cannot be drawn; FileError
void write_level_page(const std::filesystem::path& page,
                      const std::vector<std::filesystem::path>& levels);

}  // namespace relief::tools
