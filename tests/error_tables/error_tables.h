// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tables of errors in the pages of docs/, and the sections of a page. The tables hold no times;
/// programs in bench/ measure those. tests/docs/generated_documents.h has the list of pages.
#pragma once

#include <string>
#include <vector>

#include "relief/mesh/statistics.h"

namespace relief::test {

/// The text between the line `begin` of a page and the next comment `<!-- end of ... -->`.
struct PageSection {
    std::string begin;  ///< The whole line, with its line break. Empty: the section is the page.
    std::string text;
};

// The sections of each page. The text is Markdown, and the same on every machine and for every
// compiler.
std::vector<PageSection> normal_tables();      ///< docs/normals.md
std::vector<PageSection> tangent_tables();     ///< docs/tangents.md
std::vector<PageSection> bump_tables();        ///< docs/bump.md
std::vector<PageSection> normal_map_tables();  ///< docs/normal-maps.md
std::vector<PageSection> bake_tables();        ///< docs/bake.md

// Tables of real inputs, which are files below shared_directory() (support/shared_data.h).
inline constexpr const char* real_cloth = "data/dense/clothFolds.glb";
inline constexpr const char* real_heights = "data/textures/height_only/hexMap_height_1024_u16.png";
inline constexpr const char* real_normals = "data/textures/rock023_ambientcg/rock023_nrm_rgh.png";
std::vector<PageSection> real_normal_table();
std::vector<PageSection> real_tangent_tables();
std::vector<PageSection> real_bump_table();
std::vector<PageSection> real_bake_table();
std::vector<PageSection> real_compression_table();

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

/// The same without a comparison.
std::string table_row(const std::string& name, const std::vector<std::string>& cells);

/// "0.453 / 2.03"
std::string rms_and_max(const ErrorStats& error);

/// The section that begins with "<!-- NAME: written by relief-documents -->".
PageSection written_section(const std::string& name, const std::string& text);

/// The present text of a section. \throws std::runtime_error if the page has no such section
std::string section_in(const std::string& page, const std::string& begin);

/// Returns the page with other texts of sections. \throws std::runtime_error as section_in()
std::string with_sections(std::string page, const std::vector<PageSection>& sections);

/// The contents of a text file. \throws std::runtime_error if it cannot be read
std::string contents_of_page(const std::string& path);

}  // namespace relief::test
