// SPDX-License-Identifier: Apache-2.0
/// \file
/// GLSL assembled from the parts of the files in shaders/ (shader_parts.h), with the origin of each
/// line; the parts that a set of effects chooses; and the source of its program.
///
/// A part includes others by address, or by the step that they implement: the caller chooses one
/// part for each step, and neutral code stands for a step without one. Each part enters a shader
/// once. The files are embedded at build; a part in a file of the same name in ShaderTexts or in
/// $RELIEF_SHADER_DIR takes precedence.
///
/// One table (surface_steps.cpp) has a row for every part that implements a step, with its
/// condition. The inputs of a program are those that its parts declare. Pure. Tests:
/// tests/shade/effects/shader_source_test.cpp, tests/shade/render/render_cache_test.cpp.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "effects/shader_parts.h"
#include "relief/shade/effects.h"
#include "relief/shade/shader_texts.h"

namespace relief::shade::detail {

struct SourceLine {
    int file = -1;  ///< Index into ShaderSource::files; -1 for lines that are in no file.
    int line = 0;   ///< In the file, from 1.
};

/// One stage's source as the driver gets it.
struct ShaderSource {
    std::string text;
    std::vector<SourceLine> lines;   ///< The origin of every line of `text`.
    std::vector<std::string> files;  ///< In the order of their first lines.
    std::vector<std::string> parts;  ///< Addresses, in the same order; without neutral code.

    std::string main;                          ///< The part that includes all others.
    std::size_t head_size = 0;                 ///< Of `text` before that part.
    std::map<std::string, std::string> steps;  ///< The included part or neutral code of each step.
};

/// The address of the part that is chosen for each step.
using ShaderSteps = std::map<std::string_view, std::string_view>;

/// Chooses an embedded part for the step that it implements.
/// \throws GpuError if there is no such part, or it implements no step
void choose_part(ShaderSteps& steps, std::string_view part);

/// Integers known when the shader is compiled.
using ShaderConstants = std::vector<std::pair<std::string_view, int>>;

enum class GlslVersion {
    core_330,
    /// For OpenGL ES 3.0 and WebGL 2. Three things differ: numbers and samplers have a stated
    /// precision; global variables get their values in main(); and buffer textures are textures of
    /// two dimensions, texel i in column i % width of row i / width. All other code is the same.
    es_300,
};

/// Returns the part and everything that it includes, after the version and the constants.
/// \throws GpuError naming file and line if an included part or step does not exist or includes
///         itself, or if a file is malformed (parts_of())
ShaderSource assemble(std::string_view part, const ShaderSteps& steps,
                      const ShaderConstants& constants, GlslVersion version = GlslVersion::core_330,
                      const ShaderTexts& texts = {});

/// Returns a driver's message about this source with lines named by file: "0:12(3): error" becomes
/// "normal_map.glsl:7(3): error". Mesa's and NVIDIA's forms are known; others stay as they are.
std::string with_file_names(const std::string& message, const ShaderSource& source);

struct SurfaceProgram {
    ShaderSource vertex;
    ShaderSource fragment;
};

/// \param features  canonical, or a canonical set with more effects on
/// \throws GpuError if a part is missing (an override folder may hold broken files)
SurfaceProgram surface_program(const Features& features,
                               GlslVersion version = GlslVersion::core_330,
                               const ShaderTexts& texts = {});

/// Returns the program of a pass that shades no surface.
/// \param file  "skybox", "picture" or "overlay", whose parts `vertex` and `fragment` have the
/// main()s \throws GpuError if a part is missing (an override folder may hold broken files)
SurfaceProgram pass_program(std::string_view file, const ShaderSteps& steps,
                            GlslVersion version = GlslVersion::core_330,
                            const ShaderTexts& texts = {});

/// Returns the program after a change of the steps of its fragment stage.
SurfaceProgram surface_program_with(const Features& features, GlslVersion version,
                                    void (*change)(ShaderSteps& fragment),
                                    const ShaderTexts& texts = {});

/// The part with the main() of each stage, and the parts that are chosen for its steps.
struct ChosenSteps {
    std::string_view vertex_main = "surface.vert.glsl";
    std::string_view fragment_main;
    ShaderSteps vertex;
    ShaderSteps fragment;
};
ChosenSteps chosen_steps(const Features& features);

/// Returns the steps that deform positions (vertex.glsl), for passes that shade no surface.
ShaderSteps pose_steps(bool morphing, bool skinning);

/// Returns the steps that code a picture, with the scene's exposure and tone curve if this coding
/// has them: for passes that draw no surface.
ShaderSteps output_steps(OutputCoding coding, const Scene& scene);

/// Returns the same steps, and the way to read the drawn samples: for the finishing pass.
/// \param samples  "picture.glsl#one_sample", "picture.glsl#four_samples" (330 core alone) or
///                 "picture.glsl#four_texels" (from a picture of twice the width and height)
ShaderSteps finishing_steps(OutputCoding coding, const Scene& scene, std::string_view samples);

/// Returns the same steps, and the rotation of the environment if the scene has one.
ShaderSteps skybox_steps(OutputCoding coding, const Scene& scene);

}  // namespace relief::shade::detail
