// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/mesh_preview_test.cpp.
#include "mesh/preview_options.h"

#include <fmt/format.h>

#include "common/file_jobs.h"
#include "common/options.h"
#include "common/text.h"

namespace relief::tools {

void add_preview_options(CLI::App& app, PreviewOptions& options) {
    const std::string group = "Report";
    add_path(app, "--preview", options.file,
             "Write a picture (.png) as well: the high models, the low one with the finished map, "
             "and the low one without, side by side.")
        .group(group);
    add_value(app, "--preview-size", "WxH",
              "Of each of its three panels, in pixels. Default: 512x512.",
              [&](const std::string& subject, const std::string& text) {
                  options.size = parse_size(subject, text);
              })
        .group(group);
}

namespace {

void require_another(const PreviewOptions& options, const std::filesystem::path& file) {
    if (!options.file || identity_of(*options.file) != identity_of(file)) return;
    throw UsageError(
        fmt::format("--preview {}: is also the input or the output", options.file->string()));
}

}  // namespace

void check(const PreviewOptions& options, const std::vector<std::filesystem::path>& files) {
    if (!options.file) {
        if (options.size) throw UsageError("--preview-size: has no effect without --preview");
        return;
    }
    if (extension_of(*options.file) != ".png")
        throw UsageError(
            fmt::format("--preview {}: no format to write it in", options.file->string()),
            "use .png");
    for (const std::filesystem::path& file : files)
        require_another(options, file);
    require_folder_of(*options.file);
}

}  // namespace relief::tools
