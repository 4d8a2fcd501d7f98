// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which shader file stands for which step of a stage, for a set of effects, and what it takes from
/// outside: the one table that programs and their planned interfaces are read from.
/// Tests: tests/shade/effects/surface_program_test.cpp.
#pragma once

#include <string_view>
#include <vector>

#include "relief/shade/effects.h"

namespace relief {

/// What a file takes from outside the shader, by GLSL name.
struct Takes {
    std::vector<std::string_view> attributes = {};
    std::vector<std::string_view> uniforms = {};
    std::vector<std::string_view> samplers = {};
    std::vector<std::string_view> blocks = {};
};

/// A shader file, the step that it stands for, and whether these features choose it.
struct Part {
    std::string_view step;
    std::string_view file;
    bool chosen = false;
    Takes takes = {};
};

using Parts = std::vector<Part>;

/// The vertex stage: passing things on, and Gouraud's lamps with all that they ask for.
std::vector<Parts> vertex_parts(const Features& features);

/// The fragment stage of a lit surface.
std::vector<Parts> fragment_parts(const Features& features);

/// The fragment stage of a surface without light.
std::vector<Parts> unlit_parts(const Features& features);

/// The fragment stage of a debug view of data.
std::vector<Parts> data_parts(const Features& features);

/// How the picture is coded.
Parts output_parts(const Features& features);

}  // namespace relief
