// SPDX-License-Identifier: Apache-2.0
#include "window/shader_edits.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <set>
#include <span>
#include <utility>

#include "common/command.h"
#include "exercise.h"
#include "file_replacement.h"
#include "files.h"
#include "relief/mesh/report.h"

namespace relief::tools {
using namespace relief::detail;
using namespace relief::shade;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

std::string file_of(const std::string& address) {
    return address.substr(0, address.find('#'));
}

}  // namespace

std::vector<std::string> line_difference(const std::string& before, const std::string& after) {
    const std::vector<std::string> a = lines_of(before);
    const std::vector<std::string> b = lines_of(after);
    // common[i][j] is the largest number of lines that a from i and b from j have in common.
    std::vector<std::vector<int>> common(a.size() + 1, std::vector<int>(b.size() + 1, 0));
    for (std::size_t i = a.size(); i-- > 0;) {
        for (std::size_t j = b.size(); j-- > 0;)
            common[i][j] = a[i] == b[j] ? common[i + 1][j + 1] + 1
                                        : std::max(common[i + 1][j], common[i][j + 1]);
    }
    std::vector<std::string> lines;
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() || j < b.size()) {
        if (i < a.size() && j < b.size() && a[i] == b[j]) {
            lines.push_back("  " + a[i]);
            ++i;
            ++j;
        } else if (j == b.size() || (i < a.size() && common[i + 1][j] >= common[i][j + 1])) {
            lines.push_back("- " + a[i++]);
        } else {
            lines.push_back("+ " + b[j++]);
        }
    }
    return lines;
}

std::string ShaderEdits::text(const std::string& address) const {
    const auto edit = edits_.find(address);
    return edit != edits_.end() ? edit->second : shader_part_text(address).text;
}

std::string ShaderEdits::original(const std::string& address) {
    return shader_part_text(address, {{}, false}).text;
}

void ShaderEdits::set(const std::string& address, const std::string& text, double now) {
    if (shader_part_text(address).text == text)
        edits_.erase(address);
    else
        edits_[address] = text;
    changed_at_ = now;
    is_pending_ = true;
}

void ShaderEdits::begin(const Exercise& exercise) {
    if (!attempt_at(exercise).is_start()) return;
    set(exercise.part, exercise.start, -pause_seconds);
}

void ShaderEdits::reset(const std::string& address) {
    set(address, original(address), -pause_seconds);
}

bool ShaderEdits::apply(double now) {
    if (!is_pending_ || now - changed_at_ < pause_seconds) return false;
    is_pending_ = false;
    ShaderTexts texts;
    for (const auto& [address, text] : edits_) {
        std::string& file = texts.files[file_of(address)];
        try {
            file = with_shader_part(file, address, text);
        } catch (const Error&) {  // A marker is malformed: the assembler reports its line.
            file = text;
        }
    }
    if (texts.files.empty() ? texts_ == nullptr : texts_ && *texts_ == texts) return false;
    texts_ = texts.files.empty() ? nullptr : std::make_shared<const ShaderTexts>(std::move(texts));
    ++applied_;
    return true;
}

std::vector<LineMessage> ShaderEdits::messages(const std::string& address,
                                               std::string_view message) const {
    std::vector<LineMessage> result;
    if (message.empty()) return result;
    int first = 1;
    try {
        first = shader_part_text(address, texts_ ? *texts_ : ShaderTexts{}).first_line;
    } catch (const Error&) {  // The text is malformed: it is a file of its own.
        first = 1;
    }
    const auto count = static_cast<int>(lines_of(text(address)).size());
    const std::string mention = file_of(address) + ":";
    for (std::size_t at = message.find(mention); at != std::string_view::npos;
         at = message.find(mention, at + 1)) {
        const char* const begin = message.data() + at + mention.size();
        const char* const end = message.data() + message.size();
        int line = 0;
        const auto [last, error] = std::from_chars(begin, end, line);
        line -= first - 1;
        if (error != std::errc() || line < 1 || line > count) continue;
        const std::size_t text_at = static_cast<std::size_t>(last - message.data());
        const std::size_t text_end = std::min(message.find('\n', text_at), message.size());
        std::string_view words = message.substr(text_at, text_end - text_at);
        if (const std::size_t colon = words.find(": "); colon != std::string_view::npos)
            words.remove_prefix(colon + 2);
        result.push_back({line, std::string(words)});
    }
    return result;
}

std::vector<std::string> ShaderEdits::save(const std::filesystem::path& folder) {
    make_folder(folder);
    std::map<std::string, std::string> files;
    std::error_code none;
    for (const auto& edit : edits_) {
        const std::string name = file_of(edit.first);
        const auto added = files.try_emplace(name);
        std::string& file = added.first->second;
        if (added.second && std::filesystem::exists(folder / name, none))
            file = read_file(folder / name);
        file =
            about(folder / name, [&] { return with_shader_part(file, edit.first, edit.second); });
    }
    std::vector<std::string> names;
    for (const auto& [name, text] : files) {
        replace_file(folder / name, std::as_bytes(std::span(text)));
        names.push_back(name);
    }
    const char* const live = std::getenv("RELIEF_SHADER_DIR");
    if (live != nullptr && std::filesystem::equivalent(folder, live, none)) {
        edits_.clear();
        is_pending_ = true;
    }
    return names;
}

std::filesystem::path ShaderEdits::default_folder() {
    const char* const folder = std::getenv("RELIEF_SHADER_DIR");
    return folder == nullptr || *folder == '\0' ? "my-shaders" : folder;
}

nlohmann::ordered_json ShaderEdits::json() const {
    nlohmann::ordered_json edited = nlohmann::ordered_json::array();
    for (const auto& [address, text] : edits_)
        edited.push_back(address);
    return {{"edited", edited}, {"pending", is_pending_}, {"applied", applied_}};
}

}  // namespace relief::tools
