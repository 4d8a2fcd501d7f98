// SPDX-License-Identifier: Apache-2.0
// From file arguments to pairs of input and output, all checks made before any file is opened.
// Tests: tests/tools/process_jobs_test.cpp.
#include "process_jobs.h"

#include <fmt/format.h>

#include "common/command.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// The name of a model in the output folder.
fs::path name_in_folder(const fs::path& input, std::optional<ModelFormat> format) {
    const ModelFormat own = readable_format(input);
    fs::path name = input.filename();
    if (format) return name.replace_extension(extension_for(*format));
    const bool is_writable = !name_of(own, writable_choices()).empty();
    return is_writable ? name : name.replace_extension(extension_for(ModelFormat::glb));
}

void refuse_format(ModelFormat format, const fs::path& output) {
    throw UsageError(fmt::format("--format {}: the name {} says the format already",
                                 name_of(format, writable_choices()), output.string()),
                     "leave --format out, or name a folder: -o out/");
}

}  // namespace

JobList model_jobs_of(const FileWords& words, std::optional<ModelFormat> format) {
    JobList list = jobs_of(words, "model",
                           [&](const fs::path& input) { return name_in_folder(input, format); });
    if (format && !list.folder) refuse_format(*format, list.jobs.front().output);
    return list;
}

}  // namespace relief::tools
