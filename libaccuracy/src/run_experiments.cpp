// SPDX-License-Identifier: Apache-2.0
// The table of subjects: a subject is there once it has a line here. Tests:
// tests/accuracy/experiment_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "bake/bake_experiments.h"
#include "bump/bump_experiments.h"
#include "normals/normals_experiments.h"
#include "relief/accuracy/subjects.h"
#include "relief/mesh/error.h"
#include "shading/shading_experiments.h"
#include "stability/stability_experiments.h"
#include "storage/storage_experiments.h"
#include "tangents/tangents_experiments.h"

namespace relief {
namespace {

struct SubjectEntry {
    Subject subject;
    std::vector<Experiment> (*run)(const RunOptions&);
    bool is_drawn = false;
};

/// In the order of reports.
constexpr std::array subject_entries = {
    SubjectEntry{Subject::normals, normals_experiments},
    SubjectEntry{Subject::tangents, tangents_experiments, true},
    SubjectEntry{Subject::bump, bump_experiments},
    SubjectEntry{Subject::storage, storage_experiments},
    SubjectEntry{Subject::bake, bake_experiments},
    SubjectEntry{Subject::shading, shading_experiments, true},
    SubjectEntry{Subject::stability, stability_experiments},
};

struct SubjectWord {
    Subject subject;
    std::string_view word;
};

constexpr std::array subject_words = {
    SubjectWord{Subject::normals, "normals"},     SubjectWord{Subject::tangents, "tangents"},
    SubjectWord{Subject::bump, "bump"},           SubjectWord{Subject::storage, "storage"},
    SubjectWord{Subject::bake, "bake"},           SubjectWord{Subject::shading, "shading"},
    SubjectWord{Subject::stability, "stability"},
};

}  // namespace

std::vector<Subject> subjects_with_experiments() {
    std::vector<Subject> subjects;
    for (const SubjectEntry& entry : subject_entries)
        subjects.push_back(entry.subject);
    return subjects;
}

bool is_drawn(Subject subject) {
    return std::any_of(
        subject_entries.begin(), subject_entries.end(),
        [&](const SubjectEntry& one) { return one.subject == subject && one.is_drawn; });
}

std::string_view word_of(Subject subject) {
    const auto* const found =
        std::find_if(subject_words.begin(), subject_words.end(),
                     [&](const SubjectWord& one) { return one.subject == subject; });
    return found->word;
}

Subject subject_from(std::string_view word) {
    std::vector<std::string_view> known;
    for (const SubjectWord& one : subject_words) {
        if (one.word == word) return one.subject;
        known.push_back(one.word);
    }
    throw InvalidInput(fmt::format("subject '{}' is not one of {}", word, fmt::join(known, ", ")));
}

std::vector<Experiment> run_experiments(Subject subject, const RunOptions& options) {
    for (const SubjectEntry& entry : subject_entries) {
        if (entry.subject == subject) return entry.run(options);
    }
    throw InvalidInput(fmt::format("there are no experiments on {} yet", word_of(subject)));
}

}  // namespace relief
