// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures what assets lost. Tests: tests/make/make_loss_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "dense_model.h"
#include "make_loss.h"
#include "relief/make/asset.h"
#include "relief/mesh/image.h"
#include "relief/shade/fidelity.h"

namespace relief::tools {

/// Measures what assets lost against one source, whose pictures are drawn once. OpenGL is loaded by
/// the constructor.
class LossMeter {
  public:
    /// \param source  its materials are those of glTF
    /// \param beside  a file in the folder for a temporary file
    /// \throws Error if nothing can be drawn
    LossMeter(const DenseModel& source, const std::filesystem::path& beside,
              const shade::FidelityOptions& options = {});
    ~LossMeter();
    LossMeter(const LossMeter&) = delete;
    LossMeter& operator=(const LossMeter&) = delete;

    /// Measures a written asset without its stages.
    AssetLoss measure(const std::filesystem::path& asset, Report& report);

    /// Measures an asset with other normals: those before they were coded.
    shade::SampledFidelity measure_with_normals(const std::filesystem::path& asset,
                                                const Image& normal_map);

    /// Measures the stages before and after a written asset: without maps, before the normals were
    /// coded if `made` has them, and its levels of detail.
    /// \param made  the content of the file
    /// \param loss  what measure() returned for the file
    std::vector<LossStage> measure_stages(const std::filesystem::path& asset,
                                          const make::Asset& made, const AssetLoss& loss);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief::tools
