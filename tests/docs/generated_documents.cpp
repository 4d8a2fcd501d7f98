// SPDX-License-Identifier: Apache-2.0
// The list of generated documents, and the program that writes or checks them.
#include "docs/generated_documents.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "check_rules.h"
#include "hard_cases/hard_cases.h"
#include "support/shared_data.h"

namespace relief::test {
namespace {

std::vector<PageSection> hard_case_sections() {
    return {{"", hard_cases_page()}};
}

std::vector<PageSection> check_rule_sections() {
    return {{"", tools::check_rules_page()}};
}

/// Returns the sections of one function of a page whose sections have several.
template <PageSection (*section)()>
std::vector<PageSection> only() {
    return {section()};
}

constexpr const char* usage =
    "usage: relief-documents [--check] [PAGE...]\n"
    "       relief-documents --accuracy REPORT_FOLDER [ASSET_REPORT_FOLDER...]\n"
    "       relief-documents --assets ASSET_REPORT_FOLDER...\n"
    "Writes the generated documents of docs/, or those of some pages (bump.md). --check writes\n"
    "nothing and exits with 1 if a document differs. --accuracy writes docs/accuracy.md and its\n"
    "plots from reports of relief-accuracy, --assets only its section on own data.\n";

void write_file(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

/// Replaces sections of a page. \return whether the text changed
bool update(const std::filesystem::path& path, const std::vector<PageSection>& sections,
            bool is_check) {
    const std::string before = contents_of_page(path.string());
    const std::string after = with_sections(before, sections);
    if (after == before) return false;
    if (!is_check) write_file(path, after);
    std::cout << (is_check ? "differs   " : "written   ") << path.string() << "\n";
    return true;
}

void write_section(const AccuracySection& one, const std::filesystem::path& docs) {
    update(docs / "accuracy.md", {one.section}, false);
    for (const AccuracySection::Picture& picture : one.pictures)
        write_file(docs / picture.name, picture.svg);
}

int write_accuracy(const std::vector<std::string>& folders, const std::filesystem::path& docs) {
    std::vector<AccuracySection> all = {accuracy_results(folders[0])};
    if (folders.size() > 1) all.push_back(accuracy_of_assets({folders.begin() + 1, folders.end()}));
    for (const AccuracySection& one : all)
        write_section(one, docs);
    return 0;
}

}  // namespace

const std::vector<GeneratedDocument>& generated_documents() {
    static const std::vector<GeneratedDocument> all = {
        {"normals", "normals.md", normal_tables},
        {"tangents", "tangents.md", tangent_tables},
        {"bump_kernels", "bump.md", only<kernel_tables>},
        {"bump_choices", "bump.md", only<choice_tables>},
        {"bump_steps", "bump.md", only<step_tables>},
        {"bump_depths", "bump.md", only<depth_tables>},
        {"normal_maps", "normal-maps.md", normal_map_tables},
        {"bake", "bake.md", bake_tables},
        {"real_normals", "normals.md", real_normal_table, real_cloth},
        {"real_tangents", "tangents.md", real_tangent_tables, real_cloth},
        {"real_bump", "bump.md", real_bump_table, real_heights},
        {"real_bake", "bake.md", real_bake_table, real_cloth},
        {"real_compression", "compression.md", real_compression_table, real_normals},
        {"hard_cases", "hard-cases.md", hard_case_sections},
        {"check_rules", "check-rules.md", check_rule_sections}};
    return all;
}

int run_documents(const std::vector<std::string>& arguments, const std::filesystem::path& docs) {
    std::vector<std::string> names = arguments;
    const bool is_check = std::erase(names, "--check") > 0;
    const bool is_accuracy = std::erase(names, "--accuracy") > 0;
    const bool is_assets = std::erase(names, "--assets") > 0;
    const bool is_wrong = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        const bool is_page =
            std::any_of(generated_documents().begin(), generated_documents().end(),
                        [&](const GeneratedDocument& one) { return one.page == name; });
        return name.empty() || name[0] == '-' || (!is_accuracy && !is_assets && !is_page);
    });
    const bool reads_reports = is_accuracy || is_assets;
    if (is_wrong || (is_accuracy && is_assets) || (reads_reports && (is_check || names.empty()))) {
        std::cerr << usage;
        return 2;
    }
    try {
        if (is_accuracy) return write_accuracy(names, docs);
        if (is_assets) {
            write_section(accuracy_of_assets({names.begin(), names.end()}), docs);
            return 0;
        }
        bool differs = false;
        for (const GeneratedDocument& one : generated_documents()) {
            const bool is_named =
                names.empty() || std::find(names.begin(), names.end(), one.page) != names.end();
            if (!is_named) continue;
            if (one.file != nullptr && !std::filesystem::exists(shared_directory() / one.file))
                std::cerr << "relief-documents: note: " << one.page << ": a table stays as it is, "
                          << "because " << one.file << " is missing\n";
            else
                differs = update(docs / one.page, one.sections(), is_check) || differs;
        }
        return is_check && differs ? 1 : 0;
    } catch (const std::exception& error) {
        std::cerr << "relief-documents: error: " << error.what() << "\n";
        return 1;
    }
}

}  // namespace relief::test
