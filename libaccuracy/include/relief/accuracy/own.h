// SPDX-License-Identifier: Apache-2.0
/// \file
/// What methods err and cost on somebody's own mesh, height map, normal map or pair of meshes, and
/// which of them to take. Nothing here knows the truth by a formula: what errors are counted from,
/// and what that cannot say, each experiment tells. Large inputs are measured on a part, which it
/// tells too. A ProgressScope hears how far it is, and can end it (relief/mesh/progress.h).
/// Tests: tests/accuracy/own_mesh_test.cpp, own_maps_test.cpp, own_bake_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/accuracy/measure.h"
#include "relief/accuracy/recommend.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/bump_experiment.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"

namespace relief {

class Baker;

/// What is alike for all inputs.
struct OwnOptions {
    RunOptions run;
    CostChoice costs;  ///< Windows that draw meanwhile leave one_thread out: it is process-wide.
    std::string file;  ///< As titles name it.
    std::string arguments;  ///< As commands name it, or both of a pair: "'old vase.obj'".
    /// Further arguments for commands on height maps, such as " --channel alpha".
    std::string height_arguments;
    std::string command;  ///< What repeats it all: "relief-accuracy own vase.obj".
    Wish wish;
    /// Of the normal maps that heights are converted to: bits, and whether steps of coarse heights
    /// are smoothed away as well (in 16 bits).
    std::vector<int> map_bits = {8, 16, 32};
    bool smooths_steps = true;
};

/// An experiment, and what to take.
struct OwnExperiment {
    Experiment experiment;
    /// For each measurement, the command or the call that does it; empty where nothing that is
    /// offered does: such are measured, but not recommended.
    std::vector<std::string> commands;
    Recommendation recommendation;
    /// Those of the recommended method; empty where there is none.
    [[nodiscard]] std::string command() const {
        return recommendation.method ? commands[*recommendation.method] : std::string();
    }
};

/// What a mesh's averaged normals are compared with.
enum class NormalTruth {
    surface,  ///< A smooth surface fitted through the vertices: fitted_normals.h.
    file,     ///< The mesh's own normals, whatever they are: who is nearest to them?
};

struct OwnMeshOptions {
    NormalTruth truth = NormalTruth::surface;
    /// Radians: edges sharper than this are hard. Absent: by the mesh's smoothing groups, else by
    /// the angle that its own normals tell (stored_creases.h), else none is.
    std::optional<double> crease_angle;
    std::size_t most_triangles = std::size_t{1} << 20;  ///< Of more, eight runs are taken.
};

/// Normals: every weighting, in double as relief-mesh computes them. With texture coordinates also
/// tangents, from the image's own direction on each triangle and from MikkTSpace's; and both in few
/// bytes.
/// \throws InvalidInput if the mesh is not valid or has no triangle, or if its own normals are
///         asked for and it has none
std::vector<OwnExperiment> measure_own_mesh(const Mesh& mesh, const OwnMeshOptions& mesh_options,
                                            const OwnOptions& options);

/// Kernels, arithmetics and depths, from the truest normals known for this map (measure_bump()).
/// \param size  of the map that the sample is of
/// \param bump  strength, texel and wrap
OwnExperiment measure_own_heights(const BumpSample& sample, glm::ivec2 size,
                                  const BumpOptions& bump, const OwnOptions& options);
/// The same of a map in memory: one channel, as for normals_from_height().
OwnExperiment measure_own_heights(const Image& height, const BumpOptions& bump,
                                  const OwnOptions& options,
                                  std::int64_t most_texels = texels_to_measure);

/// How a file stores a normal map.
struct NormalMapOnFile {
    int bits = 8;  ///< Of each channel.
    int channels = 3;
    std::string extension = ".png";  ///< Of a format that can hold the same codes.
};

/// Ways to store a normal map, from the normals that its file holds; to keep the file is one.
/// \param normals  three float channels, as decode_normal_map() gives them
OwnExperiment measure_own_normals(const Image& normals, const NormalMapOnFile& file,
                                  const OwnOptions& options,
                                  std::int64_t most_texels = texels_to_measure);

/// Samples and codes of a map baked from one mesh for another, from the mean of many samples.
/// \param baker  of the meshes; all its options are those of the maps
/// \param size   texels along each side of the map
OwnExperiment measure_own_bake(const Baker& baker, int size, const OwnOptions& options);

}  // namespace relief
