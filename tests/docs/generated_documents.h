// SPDX-License-Identifier: Apache-2.0
/// \file
/// The generated documents: tables of errors in the pages of docs/, the page of hard cases, and the
/// tables and plots of docs/accuracy.md. relief_documents.cpp writes them, and
/// generated_documents_test.cpp compares them with new measurements.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "error_tables/error_tables.h"

namespace relief::test {

/// Generated sections of a page.
struct GeneratedDocument {
    const char* name;  ///< Unique; the name of the test.
    const char* page;  ///< Relative to docs/.
    std::vector<PageSection> (*sections)();
    /// The file below shared_directory() that is measured; without it, the sections stay as they
    /// are. Null: none.
    const char* file = nullptr;
};

/// Returns the documents that are measured without times, and so equal on every machine.
const std::vector<GeneratedDocument>& generated_documents();

/// A section of docs/accuracy.md, and the plots that it shows.
struct AccuracySection {
    PageSection section;
    struct Picture {
        std::string name;  ///< Relative to docs/: "images/accuracy-bump.svg".
        std::string svg;
    };
    std::vector<Picture> pictures;
};

/// Returns the section of a report's main experiments, one of each subject.
/// \param folder  of `relief-accuracy run all --output`
AccuracySection accuracy_results(const std::filesystem::path& folder);

/// Returns the section of reports on assets.
/// \param folders  of `relief-accuracy own --output`
AccuracySection accuracy_of_assets(const std::vector<std::filesystem::path>& folders);

/// Writes or checks documents: the main function of relief-documents. Errors go to standard error.
/// \param docs  the folder docs/
/// \return 0: done, 1: a document differs or has an error, 2: wrong usage
int run_documents(const std::vector<std::string>& arguments, const std::filesystem::path& docs);

}  // namespace relief::test
