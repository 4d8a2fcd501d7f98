// SPDX-License-Identifier: Apache-2.0
/// \file
/// The texts of shaders that measure what a mistake costs. Pure.
/// Tests: tests/shade/render/mistake_pictures_test.cpp.
#pragma once

#include <memory>

#include "relief/shade/mistakes.h"
#include "relief/shade/scene.h"
#include "relief/shade/shader_texts.h"

namespace relief::shade::detail {

/// Returns texts with which the view of shading normals, in linear floats, stores the measured
/// direction of a mistake: in world space, of any length, and zero where there is no surface.
///
/// \param base         other texts to begin with; null: none
/// \param has_mistake  otherwise the direction is the right one
/// \throws GpuError as with_mistake() does
ShaderTexts measuring_texts(const Mistake& mistake, const Scene& scene,
                            const std::shared_ptr<const ShaderTexts>& base, bool has_mistake);

}  // namespace relief::shade::detail
