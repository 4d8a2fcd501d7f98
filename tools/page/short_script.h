// SPDX-License-Identifier: Apache-2.0
/// \file
/// Makes the runtime of pages small: scripts without comments, spaces and long names, and style
/// sheets without comments and spaces. Tests: tests/tools/view_page/short_script_test.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace relief::tools {

/// A constant of the object `gl`: `gl.TEXTURE_2D` is 3553.
struct ScriptConstant {
    std::string_view name;
    int value = 0;
};

/// Returns a script that does the same with fewer bytes.
///
/// \param script  in the style of tools/page/runtime/: each statement ends with a semicolon or a
///         closing brace, `$` is in no name, and a slash after a closing bracket divides
/// \param constants  numbers that replace the names; other constants stay
///
/// Comments and needless spaces and line ends are left out. Names of parameters and variables of
/// each function or class member become single letters, and names of top-level functions, classes
/// and variables get two. A name stays where the text does not show that it is only that: names
/// that are also short keys (`{name}`) or methods there, and names declared by other
/// patterns than lists and arrays. Properties (`.name`) always stay. A letter never hides another
/// name that a function uses.
std::string short_script(std::string_view script, std::span<const ScriptConstant> constants = {});

/// Returns a style sheet without comments and needless spaces.
std::string short_style(std::string_view style);

}  // namespace relief::tools
