// SPDX-License-Identifier: Apache-2.0
#include "view_options.h"

#include <filesystem>
#include <optional>

#include "common/text.h"

namespace relief::tools {

void refuse(bool useless, const std::string& option, const std::string& because,
            const std::string& remedy) {
    if (useless) throw UsageError(option + ": " + because, remedy);
}

bool is_sequence(const ViewOptions& options) {
    return options.turntable || options.frames;
}

int picture_count(const ViewOptions& options) {
    return options.turntable.value_or(options.frames.value_or(1));
}

bool is_scene_file(const ViewOptions& options) {
    return extension_of(options.model) == ".json";
}

bool is_linear_output(const ViewOptions& options) {
    const std::optional<std::filesystem::path>& file =
        options.output ? options.output : options.reference;
    return file && (extension_of(*file) == ".exr" || extension_of(*file) == ".hdr");
}

}  // namespace relief::tools
