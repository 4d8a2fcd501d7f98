// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/pasted_view_test.cpp.
#include "window/pasted_view.h"

#include <sstream>
#include <vector>

namespace relief::tools {
namespace {

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
        words.push_back(word);
    return words;
}

/// What follows an option, "--fov 35" or "--fov=35"; nothing where it is not there.
std::optional<std::string> value_of(const std::vector<std::string>& words,
                                    const std::string& option) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == option && i + 1 < words.size()) return words[i + 1];
        if (words[i].starts_with(option + "=")) return words[i].substr(option.size() + 1);
    }
    return std::nullopt;
}

}  // namespace

PastedView pasted_view(const std::string& text) {
    const std::vector<std::string> words = words_of(text);
    std::optional<std::string> camera = value_of(words, "--camera");
    if (!camera && words.size() == 1) camera = words.front();
    if (!camera)
        throw UsageError("what was pasted says nothing of a camera", "copy one with Ctrl+C");
    PastedView view;
    view.camera = parse_camera("pasted " + *camera, *camera);
    if (const auto fov = value_of(words, "--fov"))
        view.vertical_fov = parse_fov("pasted --fov " + *fov, *fov);
    return view;
}

}  // namespace relief::tools
