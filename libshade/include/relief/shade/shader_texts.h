// SPDX-License-Identifier: Apache-2.0
/// \file
/// The texts of shaders: their parts, and texts that replace parts while somebody edits them. The
/// files and their parts are described in shaders/README.md. Pure, but for the files of
/// $RELIEF_SHADER_DIR. Tests: tests/shade/effects/shader_texts_test.cpp.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace shade {

/// Shader files that replace others, part by part. A part is that of the first of these that has
/// it: `files`, the folder $RELIEF_SHADER_DIR, the files built into the library.
struct ShaderTexts {
    std::map<std::string, std::string> files;  ///< By name: "phong.glsl".
    bool uses_folder = true;                   ///< Otherwise $RELIEF_SHADER_DIR is not read.

    friend bool operator==(const ShaderTexts&, const ShaderTexts&) = default;
};

/// The text of a part.
struct ShaderPartText {
    std::string file;    ///< "phong.glsl"
    int first_line = 1;  ///< The number of its first line in that file, which is "//@part phong".
    std::string text;    ///< Ends with a newline. A file without parts is one part.
    bool is_built_in = true;  ///< Neither of ShaderTexts::files nor of $RELIEF_SHADER_DIR.
};

/// Returns the text of a part as programs get it.
///
/// \param address  "phong.glsl#phong", as in ShaderListing::files
/// \throws GpuError if there is no such file or part, or a file is malformed
ShaderPartText shader_part_text(std::string_view address, const ShaderTexts& texts = {});

/// Replaces a part in the text of a shader file, or appends it if the file does not have it.
///
/// \param file  "" for a file that holds this part alone
/// \param part  from its line "//@part" on; the whole file if the address names no part
/// \throws GpuError if the file is malformed
std::string with_shader_part(std::string_view file, std::string_view address,
                             std::string_view part);

}  // namespace shade
}  // namespace relief
