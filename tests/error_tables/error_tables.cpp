// SPDX-License-Identifier: Apache-2.0
#include "error_tables/error_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace relief::test {
namespace {

struct Place {
    std::size_t first;
    std::size_t size;
};

Place place_in(const std::string& page, const std::string& begin) {
    if (begin.empty()) return {0, page.size()};
    const std::size_t line = page.find(begin);
    const std::size_t end = line == std::string::npos ? line : page.find("<!-- end of ", line);
    if (end == std::string::npos) throw std::runtime_error("has no place for " + begin);
    const std::size_t first = line + begin.size();
    return {first, end - first};
}

}  // namespace

std::string in_digits(double degrees) {
    if (degrees < 0.0005) return "0.000";
    return degrees < 10.0 ? fmt::format("{:.3f}", degrees) : fmt::format("{:.1f}", degrees);
}

std::string table_header(const std::vector<std::string>& columns) {
    std::string first = "| |";
    std::string second = "|---|";
    for (const std::string& column : columns) {
        first += " " + column + " |";
        second += "---|";
    }
    return first + "\n" + second + "\n";
}

std::string table_row(const std::string& name, const std::vector<double>& ranks,
                      const std::vector<std::string>& cells) {
    double best = std::numeric_limits<double>::infinity();
    for (const double rank : ranks) {
        if (!std::isnan(rank)) best = std::min(best, rank);
    }
    std::string text = fmt::format("| {} |", name);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        text += ranks[i] <= best * 1.0005 + 5e-4 ? fmt::format(" **{}** |", cells[i])
                                                 : fmt::format(" {} |", cells[i]);
    }
    return text + "\n";
}

std::string table_row(const std::string& name, const std::vector<std::string>& cells) {
    return table_row(name, std::vector<double>(cells.size(), NAN), cells);
}

std::string rms_and_max(const ErrorStats& error) {
    return in_digits(error.rms) + " / " + in_digits(error.max);
}

PageSection written_section(const std::string& name, const std::string& text) {
    return {fmt::format("<!-- {}: written by relief-documents -->\n", name), text + "\n"};
}

std::string section_in(const std::string& page, const std::string& begin) {
    const Place place = place_in(page, begin);
    return page.substr(place.first, place.size);
}

std::string contents_of_page(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error(path + ": cannot be read");
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string with_sections(std::string page, const std::vector<PageSection>& sections) {
    for (const PageSection& section : sections) {
        const Place place = place_in(page, section.begin);
        page.replace(place.first, place.size, section.text);
    }
    return page;
}

}  // namespace relief::test
