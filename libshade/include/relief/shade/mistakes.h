// SPDX-License-Identifier: Apache-2.0
/// \file
/// A gallery of mistakes, for teaching: errors that programs for shading often have, each of which
/// can be switched on, with the change of the picture that it costs. docs/mistakes.md shows them.
///
/// A mistake replaces lines of shader parts, or what a scene says of its images. A picture without
/// a mistake is drawn by the same shaders as ever. Tests: tests/shade/effects/mistakes_test.cpp,
/// tests/shade/render/mistake_pictures_test.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/camera.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"
#include "relief/shade/shader_texts.h"

namespace RELIEF_API relief {
namespace shade {

/// Code of a shader part, and what stands there by mistake.
struct WrongCode {
    std::string_view part;   ///< Its address: "vertex.glsl#normal".
    std::string_view right;  ///< Text that the part has once.
    std::string_view wrong;
};

/// The direction that a mistake bends, and in which its cost is measured in degrees.
enum class MistakenVector {
    none,    ///< Colors and lengths are wrong, not directions.
    normal,  ///< The shading normal.
    mirror,  ///< The mirror direction of the view.
    view,    ///< The direction to the eye.
    light,   ///< That to the first point or spot light; to the eye if there is none.
};

struct Mistake {
    std::string_view name;  ///< "normal-matrix", as on command lines.
    std::string_view what;  ///< The mistake in one sentence, without a period.
    MistakenVector vector = MistakenVector::none;
    std::vector<WrongCode> code;  ///< Empty: the scene's images are read in another way.
};

/// All mistakes.
const std::vector<Mistake>& mistakes();

/// Returns the mistake of a name; null if there is none.
const Mistake* find_mistake(std::string_view name);

/// The surfaces that a mistake can change.
struct MistakeReach {
    std::size_t draws = 0;  ///< Draws of the plan whose program or textures it changes.
    std::size_t total = 0;  ///< All draws.
    std::string hidden;     ///< Why it changes no picture of the scene; empty if it changes some.
};

/// Finds the surfaces that a mistake can change. Whether a pixel changes depends on the camera,
/// too.
/// \throws GpuError as with_mistake() does
MistakeReach reach_of(const Mistake& mistake, const Scene& scene, const FrameSettings& settings);

/// Returns the texts of shaders with a mistake.
/// \param texts  other texts to begin with; null: none
/// \return null if the mistake changes no shader and `texts` is null
/// \throws GpuError if a part that somebody replaced, there or in $RELIEF_SHADER_DIR, does not have
///         the code that the mistake changes
std::shared_ptr<const ShaderTexts> with_mistake(const Mistake& mistake,
                                                const std::shared_ptr<const ShaderTexts>& texts);

/// Returns the scene with a mistake: the same scene, unless the mistake is in reading its images.
/// Images that cannot be read stay as they are.
Scene with_mistake(const Mistake& mistake, const Scene& scene);

/// Returns the name of the measured direction in a scene: "normal", "direction to the light"; empty
/// for none.
std::string_view measured_name(const Mistake& mistake, const Scene& scene);

/// The cost of a mistake.
struct MistakeCost {
    Image right;  ///< The picture without the mistake.
    Image wrong;  ///< The picture with it.
    ImageDifference difference;
    FlipDifference flip;
    /// Angles in degrees between right and wrong directions, at the centers of the pixels that show
    /// a surface. `undefined` counts pixels in which one of the two has no direction. None if the
    /// mistake bends no direction.
    std::optional<ErrorStats> angles;
};

/// Draws a scene without and with a mistake, and compares.
///
/// \param settings  those of the picture without the mistake
/// \param report    gets the findings of the right picture
/// \param right     the picture without the mistake; null: it is drawn
/// \throws as Renderer does; GpuError as with_mistake() does
MistakeCost mistake_cost(const Mistake& mistake, const Scene& scene, const Camera& camera,
                         const FrameSettings& settings, const Context& context, RenderCache& cache,
                         Report& report = IgnoredReport(), const Image* right = nullptr);

}  // namespace shade
}  // namespace relief
