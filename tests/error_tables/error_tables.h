// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tables of errors in the pages of docs/: a program measures and writes them, and a test compares
/// the page with a new measurement. The tables hold no times; programs in bench/ measure those.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace relief::test {

/// The text between the line `begin` of a page and the next line that equals `tables_end`.
struct PageSection {
    std::string begin;  ///< The whole line, with its line break.
    std::string text;
};

inline constexpr const char* tables_end = "<!-- end of tables -->\n";

// The sections of each page. The text is Markdown, and the same on every machine and for every
// compiler.
std::vector<PageSection> normal_tables();      ///< docs/normals.md
std::vector<PageSection> tangent_tables();     ///< docs/tangents.md
std::vector<PageSection> bump_tables();        ///< docs/bump.md
std::vector<PageSection> normal_map_tables();  ///< docs/normal-maps.md
std::vector<PageSection> bake_tables();        ///< docs/bake.md

// The sections of docs/bump.md one by one.
PageSection kernel_tables();
PageSection choice_tables();
PageSection step_tables();
PageSection depth_tables();

/// The last table of docs/normal-maps.md.
std::string mip_tables();

/// Three digits without an exponent. Rounding errors of float become 0.000.
std::string in_digits(double degrees);

/// The first two lines of a Markdown table. The first column has no name.
std::string table_header(const std::vector<std::string>& columns);

/// A line of a table, with the cells of the smallest ranks in bold. A cell of rank NaN takes no
/// part in the comparison.
std::string table_row(const std::string& name, const std::vector<double>& ranks,
                      const std::vector<std::string>& cells);

/// The present text of a section. \throws std::runtime_error if the page has no such section
std::string section_in(const std::string& page, const std::string& begin);

/// Returns whether the arguments of a program are one path. An option such as --help is not a path.
inline bool is_one_path(int argc, const char* const* argv) {
    return argc == 2 && argv[1][0] != '-' && argv[1][0] != '\0';
}

/// The main function of a program whose argument is a page: replaces the sections by measured ones.
/// Errors go to standard error. \return the exit status
int write_sections(int argc, const char* const* argv,
                   const std::function<std::vector<PageSection>()>& measure);

/// The contents of a text file. \throws std::runtime_error if it cannot be read
std::string contents_of_page(const std::string& path);

}  // namespace relief::test
