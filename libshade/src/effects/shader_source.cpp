// SPDX-License-Identifier: Apache-2.0
// Expands #include lines depth first, once per file, refuses cycles, and keeps for every line its
// file and number, since drivers report only the line of the whole. Missing files and cycles throw
// GpuError. Tests: tests/shade/effects/shader_source_test.cpp.
#include "effects/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>

#include "progress_stage.h"
#include "relief/shade/error.h"

namespace relief {

namespace {

/// What an #include line asks for, in its quotes or brackets.
struct Include {
    bool is_step = false;
    std::string_view name;
};

std::optional<Include> include_of(std::string_view line) {
    constexpr std::string_view directive = "#include ";
    if (!line.starts_with(directive)) return std::nullopt;
    line.remove_prefix(directive.size());
    if (line.size() > 2 && line.front() == '<' && line.back() == '>') {
        return Include{true, line.substr(1, line.size() - 2)};
    }
    if (line.size() > 2 && line.front() == '"' && line.back() == '"') {
        return Include{false, line.substr(1, line.size() - 2)};
    }
    return Include{};
}

/// A line number in a driver's message, and where its mention ends.
struct LineMention {
    std::size_t line = 0;
    std::size_t end = 0;
};

/// The mention that starts here, if one does: "0:12" before "(" (Mesa), or "0(12)" (NVIDIA), at the
/// start of a word.
std::optional<LineMention> line_mention(std::string_view message, std::size_t begin) {
    const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
    if (begin > 0 && is_word(message[begin - 1])) return std::nullopt;
    const std::string_view rest = message.substr(begin);
    if (!rest.starts_with("0:") && !rest.starts_with("0(")) return std::nullopt;
    LineMention mention;
    const char* const first = rest.data() + 2;
    const auto [last, error] = std::from_chars(first, rest.data() + rest.size(), mention.line);
    const auto length = static_cast<std::size_t>(last - rest.data());
    if (error != std::errc() || last == first || length == rest.size()) return std::nullopt;
    const bool mesa = rest[1] == ':';
    if (*last != (mesa ? '(' : ')')) return std::nullopt;
    mention.end = begin + length + (mesa ? 0 : 1);
    return mention;
}

/// Puts one shader together.
class Assembler {
  public:
    explicit Assembler(const ShaderSteps& steps) : steps_(steps) {}

    void add_line(std::string_view text, SourceLine place) {
        source_.text += text;
        source_.text += '\n';
        source_.lines.push_back(place);
    }

    /// `place` is where it is included, for messages.
    void add_file(std::string_view name, const std::string& place) {
        if (std::find(open_.begin(), open_.end(), name) != open_.end()) {
            throw GpuError(fmt::format("{}: {} includes itself: {} -> {}", place, name,
                                       fmt::join(open_, " -> "), name));
        }
        if (std::find(source_.files.begin(), source_.files.end(), name) != source_.files.end()) {
            return;
        }
        source_.files.emplace_back(name);
        open_.emplace_back(name);
        const std::string text = read(name, place);
        SourceLine here{static_cast<int>(source_.files.size()) - 1, 1};
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            add_source_line(std::string_view(text).substr(begin, end - begin), name, here);
            ++here.line;
            begin = end + 1;
        }
        open_.pop_back();
    }

    ShaderSource take() { return std::move(source_); }

  private:
    static std::string read(std::string_view name, const std::string& place) {
        try {
            return shader_file(name);
        } catch (const GpuError& error) {
            throw GpuError(place.empty() ? error.what()
                                         : fmt::format("{}: {}", place, error.what()));
        }
    }

    void add_source_line(std::string_view line, std::string_view file, SourceLine place) {
        const std::optional<Include> include = include_of(line);
        if (!include) {
            add_line(line, place);
            return;
        }
        const std::string where = fmt::format("shader {}:{}", file, place.line);
        if (include->name.empty()) {
            throw GpuError(fmt::format("{}: '{}' names nothing", where, line));
        }
        if (!include->is_step) {
            add_file(include->name, where);
            return;
        }
        const auto step = steps_.find(include->name);
        if (step == steps_.end()) {
            throw GpuError(fmt::format("{}: no file is chosen for <{}>", where, include->name));
        }
        add_file(step->second, where);
    }

    const ShaderSteps& steps_;
    std::vector<std::string> open_;
    ShaderSource source_;
};

}  // namespace

ShaderSource assemble(std::string_view file, const ShaderSteps& steps,
                      const ShaderConstants& constants) {
    Assembler assembler(steps);
    assembler.add_line("#version 330 core", {});
    for (const auto& [name, value] : constants) {
        assembler.add_line(fmt::format("const int {} = {};", name, value), {});
    }
    assembler.add_file(file, "");
    return assembler.take();
}

std::string with_file_names(const std::string& message, const ShaderSource& source) {
    std::string result;
    std::size_t position = 0;
    while (position < message.size()) {
        const std::optional<LineMention> mention = line_mention(message, position);
        if (!mention || mention->line == 0 || mention->line > source.lines.size() ||
            source.lines[mention->line - 1].file < 0) {
            result += message[position++];
            continue;
        }
        const SourceLine place = source.lines[mention->line - 1];
        const std::string& file = source.files[static_cast<std::size_t>(place.file)];
        result += fmt::format("{}:{}", file, place.line);
        position = mention->end;
    }
    return result;
}

std::string shader_file(std::string_view name) {
    if (const char* folder = std::getenv("RELIEF_SHADER_DIR")) {
        const std::filesystem::path path = std::filesystem::path(folder) / name;
        note_file(path);
        std::ifstream file(path, std::ios::binary);
        if (file) return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }
    const auto& all = embedded_shaders();
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const EmbeddedShader& s) { return s.name == name; });
    if (found == all.end()) throw GpuError(fmt::format("there is no shader file '{}'", name));
    return std::string(found->text);
}

}  // namespace relief
