// SPDX-License-Identifier: Apache-2.0
// From file arguments to pairs of input and output, all checks made before any file is opened.
// Tests: tests/tools/process_jobs_test.cpp.
#include "process_jobs.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "common/command.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// A path by which the same file has the same name, whether it exists or not.
fs::path identity_of(const fs::path& file) {
    return fs::weakly_canonical(fs::absolute(file));
}

bool is_folder(const std::string& output) {
    return output.ends_with('/') || fs::is_directory(output);
}

void refuse_format(const FileWords& words, const fs::path& output) {
    if (!words.format) return;
    throw UsageError(fmt::format("--format {}: the name {} says the format already",
                                 name_of(*words.format, writable_choices()), output.string()),
                     "leave --format out, or name a folder: -o out/");
}

/// IN OUT
JobList pair_of(const FileWords& words) {
    if (words.files.empty()) throw UsageError("IN is missing");
    if (words.files.size() == 1) throw UsageError("OUT is missing");
    if (words.files.size() > 2) {
        throw UsageError(fmt::format("{} files: which are to be read, and which to be written?",
                                     words.files.size()),
                         "read all and write to a folder: -o out/");
    }
    refuse_format(words, words.files[1]);
    return {{{words.files[0], words.files[1]}}, std::nullopt};
}

/// IN -o OUT
JobList single(const FileWords& words) {
    const fs::path output = *words.output;
    if (words.files.size() > 1) {
        throw UsageError(fmt::format("-o {}: is one file for {} models, and no folder",
                                     output.string(), words.files.size()),
                         "the name of a folder ends in /");
    }
    if (output.extension().empty())
        throw UsageError(fmt::format("-o {}: no extension says what format this is", *words.output),
                         "the name of a folder ends in /");
    refuse_format(words, output);
    return {{{words.files[0], output}}, std::nullopt};
}

/// The name of a model in the output folder.
fs::path name_in_folder(const fs::path& input, std::optional<ModelFormat> format) {
    fs::path name = input.filename();
    if (format) return name.replace_extension(extension_for(*format));
    const ModelFormat own = readable_format(input);
    const bool is_writable = !name_of(own, writable_choices()).empty();
    return is_writable ? name : name.replace_extension(extension_for(ModelFormat::glb));
}

/// Refuses results that would replace each other. None can replace another's input: what keeps its
/// name in the input's folder is the input's own result.
void check_clashes(const std::vector<Job>& jobs) {
    std::set<fs::path> inputs;
    for (const Job& job : jobs) {
        if (!inputs.insert(identity_of(job.input)).second)
            throw UsageError(job.input.string() + ": named twice", "name it once");
    }
    std::map<fs::path, fs::path> input_of;
    for (const Job& job : jobs) {
        const auto [known, is_new] = input_of.emplace(identity_of(job.output), job.input);
        if (is_new) continue;
        throw UsageError(fmt::format("{} and {}: would both become {}", known->second.string(),
                                     job.input.string(), job.output.string()),
                         "process them by separate calls, to different folders");
    }
}

/// IN... -o DIR/
JobList into_folder(const FileWords& words) {
    JobList list{{}, fs::path(*words.output)};
    for (const fs::path& input : words.files) {
        readable_format(input);
        list.jobs.push_back({input, *list.folder / name_in_folder(input, words.format)});
    }
    check_clashes(list.jobs);
    return list;
}

}  // namespace

JobList jobs_of(const FileWords& words) {
    if (!words.output) return pair_of(words);
    if (words.files.empty()) throw UsageError("IN is missing");
    return is_folder(*words.output) ? into_folder(words) : single(words);
}

}  // namespace relief::tools
