// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far a finished normal map is from the surface that it was baked from, texel by texel, as a
/// renderer will read it; and what makes up the difference. In the library relief::bake.
/// Tests: tests/mesh/bake/bake_check_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/normal_map.h"

namespace relief {

/// What parts a map from the surface, in the order in which a bake does it.
enum class BakeStage {
    /// Texels that have no one normal: the surface jumps within them, so that its mean height is a
    /// quarter of a texel's width off that of their centre; or their centre's ray meets nothing; or
    /// what they show faces away from the low mesh.
    projection,
    sampling,      ///< Few samples instead of many.
    quantisation,  ///< Normals rounded to codes, angles measured in tangent space.
    basis,  ///< What that becomes in object space, where the low mesh's axes are no right angle.
    other,  ///< The file holds other codes than this bake makes: another basis, another bake,
            ///< edits.
};
inline constexpr std::size_t bake_stage_count = 5;

/// What a stage does.
struct StageError {
    double rms = 0.0;  ///< Of its own angles, in degrees.
    /// Of the mean squared error, which all shares add up to: a stage's vector along the sum of
    /// all. A stage that happens to undo another's error has a negative share.
    double share = 0.0;
};

struct WorstTexel {
    int x = 0;
    int y = 0;
    double degrees = 0.0;
    bool is_torn = false;  ///< By the projection; see BakeStage.
};

struct BakeCheckOptions {
    BakeMapOptions map;      ///< As the map was made; the size is the image's.
    NormalMapFormat format;  ///< What its codes mean; bits are the image's own.
    /// Samples for each texel that the truth is the mean of: 4, 16, 64, 256 or 1024; 0: 16 times
    /// those of the map, at most 256, and 1024 for a map of 256; fewer where the map is so large
    /// that coverage has no room for them (TexelCover::largest_side). A quarter of them is cast
    /// first, the others where those are half a degree apart.
    int reference_samples = 0;
    /// Whether readings of another kind are tried where the map is far off.
    bool finds_convention = true;
    /// The low mesh as given, for tangents of its own that a map in object space has no use for;
    /// may be absent.
    const Mesh* given = nullptr;
    /// The low mesh's own axes, and whether a baker for object space bakes in those.
    glm::dmat3 object_from_mesh{1.0};
    bool is_object = false;
};

struct BakeCheck {
    /// From the mean over the texel's area: what a map should show from afar, or at its own
    /// resolution.
    AngleSummary error;
    /// From the normal where the ray through the texel's centre ends: what it should show from
    /// near. A map of one sample is as good as its codes there; one of many is not, by intent.
    AngleSummary centre;
    /// `error` of the codes that this bake makes now.
    AngleSummary remade;
    std::array<StageError, bake_stage_count> stages{};  ///< By BakeStage.
    std::size_t missed = 0;     ///< Texels on the mesh without a truth: all rays pass everything.
    std::size_t frameless = 0;  ///< And where the low mesh has no tangent space.
    std::size_t torn = 0;       ///< Those of BakeStage::projection.
    std::size_t rays = 0;
    int reference_samples = 0;
    std::vector<WorstTexel> worst;  ///< At most 8, the worst first.
    ConventionFit convention;
};

/// Compares a map with what it should be.
///
/// \param baker   with the rays and the space that the map was made with
/// \param map     the finished image, as read from its file
/// \param take    gets the errors in degrees by rows from the top, NaN where there is no truth; may
///                be empty
/// \param report  counts what the bake counts, and texels of the map that hold no direction
/// \throws InvalidInput if the image has fewer than three channels or another size
///
/// The renderer's own frame (normal_space.h) turns the map's normals into object space. The truth
/// is the mean of many normals of the high surface over the texel, each in the tangent space where
/// it is, since that is what a map can hold; in that frame too. Texels that no chart reaches have
/// none; nor have those filled by padding.
///
/// In double; the same for any number of threads. Memory: the image, some 200 bytes for each texel
/// of a strip of a million.
BakeCheck check_bake(const Baker& baker, const Image& map, const BakeCheckOptions& options,
                     const std::function<void(int first_row, std::span<const float> degrees)>& take,
                     Report& report);

}  // namespace relief
