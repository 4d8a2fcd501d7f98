// SPDX-License-Identifier: Apache-2.0
/// \file
/// An asset from file to file: reading the dense model, the stages of relief/make/asset.h, writing,
/// verification, and the summary. Tests: tests/tools/relief_make_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/file_jobs.h"
#include "common/summary.h"
#include "dense_model.h"
#include "engines.h"
#include "make_limits.h"
#include "make_loss.h"
#include "relief/make/asset.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {

struct MakeRequest {
    make::AssetOptions asset;
    std::vector<std::filesystem::path> more_sources;  ///< Further files of the dense model.
    shade::UpAxis up = shade::UpAxis::automatic;      ///< Of the dense model.
    /// The crease angle for a dense model without normals, in radians, or none for smooth ones.
    /// Absent: shade::stl_crease_angle for STL files, otherwise that of the asset.
    std::optional<std::optional<double>> source_crease;
    Engine engine = Engine::gltf;
    bool measures_loss = false;  ///< Also without limits.
    /// Directions to the camera of views that are measured besides the 12.
    std::vector<glm::vec3> more_views;
    LossLimits limits;
    /// Gets the results of all stages (make_stages.h).
    std::optional<std::filesystem::path> stages_folder;
    /// The stage at which the job continues with the files of `stages_folder` (make_start.h);
    /// empty: it begins with the model.
    std::string from;
};

/// The properties of the dense model that are known after it is read.
struct SourceFacts {
    std::string format;  ///< "glTF"; of the first file.
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    std::string textures;   ///< HighTextures::description()
    bool has_z_up = false;  ///< In the files; the source has y up.
};

/// Reads the files of a dense model in world space, with y up, and their materials and textures.
///
/// Textures that are missing are left out, which is reported; so are cameras, lights, points and
/// lines, and the properties of materials that an asset cannot have.
/// \throws FileError if one cannot be read, or if it has skins, morph targets or animations, which
///         the asset would lose
make::AssetSource read_source(const DenseModel& model, SourceFacts& facts, Findings& findings);

/// The dense model of a job. If its axis is automatic, the first file decides.
DenseModel dense_model(const MakeRequest& request, const Job& job);

/// The resources that a stage used besides the time in Stages.
struct StageUse {
    std::string stage;
    std::uint64_t peak_bytes = 0;  ///< Of the process, up to the end of the stage.
    double processor_seconds = 0.0;
};

struct MadeAsset {
    SourceFacts source;
    make::Asset asset;
    std::vector<make::AssetLevel> levels;
    std::optional<AssetLoss> loss;
    /// With limits: the assets of the search. The last one is this asset.
    std::vector<LimitAttempt> attempts;
    std::vector<std::filesystem::path> inputs;  ///< Every file that was read or searched.
    std::vector<std::filesystem::path> files;
    std::vector<StageUse> stages;
    Findings findings;
};

/// A stage of the plan that --explain prints.
struct PlannedStage {
    std::string name;
    std::string text;
    double processor_seconds = 0.0;  ///< Estimated.
    double parallel = 0.0;           ///< The part of it that all threads share.
};
/// \param reading  the time that reading the source took, in seconds, on one thread
std::vector<PlannedStage> plan_of(const MakeRequest& request, const make::AssetSource& source,
                                  double reading);

/// Returns the number of threads that are used. \param requested  0: all of the machine
unsigned threads_of(unsigned requested);

std::vector<std::string> lines_of(const std::vector<PlannedStage>& plan, unsigned threads);
Json plan_json(const std::vector<PlannedStage>& plan, unsigned threads);

/// The files of a job: the asset, for some engines its maps, and the results of stages.
std::vector<std::filesystem::path> outputs_of(const MakeRequest& request,
                                              const std::filesystem::path& output);

/// Reads, makes, writes and verifies an asset. The stages are those of make::stages_of() between
/// "read", and "write", "verify" and, if requested, "loss". All files are replaced together at the
/// end. With limits, the stages run again with more triangles, larger maps or normals of 16 bits
/// until the limits hold.
/// \throws FileError, also if a limit cannot be held; UsageError. Then no file is changed
MadeAsset make_file(const MakeRequest& request, const Job& job, Stages& stages);

Summary summary_of(const MakeRequest& request, const Job& job, const MadeAsset& made,
                   const Stages& stages);

/// A line of a batch.
std::string line_of(const Job& job, const MadeAsset& made, const Stages& stages);

}  // namespace relief::tools
