// SPDX-License-Identifier: Apache-2.0
// Expands #include lines depth first, each part once, refuses cycles, and keeps the file and number
// of every line, since drivers report only the line of the whole. Missing parts and cycles throw
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
#include <set>
#include <system_error>

#include "progress_stage.h"
#include "relief/shade/renderer.h"

namespace relief {

namespace {

/// The name in the quotes or brackets of an #include line.
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

/// Returns the mention that starts here, if one does: "0:12" before "(" (Mesa), or "0(12)"
/// (NVIDIA), at the start of a word.
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

/// The address of a part: "light.glsl" and "point".
struct PartAddress {
    std::string_view file;
    std::string_view part;  ///< Empty for a file without parts.
};

PartAddress split_address(std::string_view address) {
    const std::size_t mark = address.find('#');
    if (mark == std::string_view::npos) return {address, {}};
    return {address.substr(0, mark), address.substr(mark + 1)};
}

/// Returns "light.glsl:12".
std::string origin_name(const ShaderSource& source, SourceLine origin) {
    const std::string& address = source.parts[static_cast<std::size_t>(origin.part)];
    return fmt::format("{}:{}", split_address(address).file, origin.line);
}

/// The lines of a part, and the number of the first in its file.
struct PartText {
    std::vector<std::string_view> lines;
    int first_line = 1;
};

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

constexpr std::string_view part_directive = "#part ";

/// \throws GpuError if there is code, which no part would hold
void check_head(std::string_view file, const std::vector<std::string_view>& lines) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i].starts_with(part_directive)) return;
        if (lines[i].empty() || lines[i].starts_with("//")) continue;
        throw GpuError(fmt::format("shader {}:{}: code before the first #part", file, i + 1));
    }
}

/// Returns the part of this text, without empty lines at its ends; none if the text does not have
/// it.
std::optional<PartText> find_part(PartAddress address, std::string_view text) {
    const std::vector<std::string_view> lines = lines_of(text);
    if (address.part.empty()) return PartText{lines, 1};
    check_head(address.file, lines);
    const auto is_start = [](std::string_view line) { return line.starts_with(part_directive); };
    const auto start = std::find_if(lines.begin(), lines.end(), [&](std::string_view line) {
        return is_start(line) && line.substr(part_directive.size()) == address.part;
    });
    if (start == lines.end()) return std::nullopt;
    auto end = std::find_if(start + 1, lines.end(), is_start);
    while (end != start + 1 && (end - 1)->empty())
        --end;
    return PartText{{start + 1, end}, static_cast<int>(start - lines.begin()) + 2};
}

/// The texts of the files of one shader: each file is read once.
class ShaderFiles {
  public:
    /// \throws GpuError if there is no such file or part
    PartText part(std::string_view address) {
        const PartAddress place = split_address(address);
        if (const std::optional<std::string>& text = override_of(place.file)) {
            if (const auto found = find_part(place, *text)) return *found;
        }
        const auto& all = embedded_shaders();
        const auto embedded = std::find_if(
            all.begin(), all.end(), [&](const EmbeddedShader& s) { return s.name == place.file; });
        if (embedded != all.end()) {
            if (const auto found = find_part(place, embedded->text)) return *found;
        } else if (!override_of(place.file)) {
            throw GpuError(fmt::format("there is no shader file '{}'", place.file));
        }
        throw GpuError(
            fmt::format("there is no part '{}' in shader file '{}'", place.part, place.file));
    }

  private:
    /// The text in $RELIEF_SHADER_DIR.
    const std::optional<std::string>& override_of(std::string_view name) {
        const auto [entry, is_new] = overrides_.try_emplace(std::string(name));
        const char* const folder = std::getenv("RELIEF_SHADER_DIR");
        if (is_new && folder != nullptr) {
            const std::filesystem::path path = std::filesystem::path(folder) / name;
            note_file(path);
            std::ifstream file(path, std::ios::binary);
            if (file)
                entry->second.emplace(std::istreambuf_iterator<char>(file),
                                      std::istreambuf_iterator<char>());
        }
        return entry->second;
    }

    std::map<std::string, std::optional<std::string>> overrides_;
};

/// Assembles one shader.
class Assembler {
  public:
    explicit Assembler(const ShaderSteps& steps) : steps_(steps) {}

    void add_line(std::string_view text, SourceLine origin) {
        source_.text += text;
        source_.text += '\n';
        source_.lines.push_back(origin);
    }

    /// `place` is where it is included, for messages.
    void add_part(std::string_view address, const std::string& place) {
        if (std::find(open_.begin(), open_.end(), address) != open_.end()) {
            throw GpuError(fmt::format("{}: {} includes itself: {} -> {}", place, address,
                                       fmt::join(open_, " -> "), address));
        }
        auto& parts = source_.parts;
        if (std::find(parts.begin(), parts.end(), address) != parts.end()) return;
        parts.emplace_back(address);
        open_.emplace_back(address);
        const PartText text = read(address, place);
        SourceLine origin{static_cast<int>(parts.size()) - 1, text.first_line};
        for (const std::string_view line : text.lines) {
            add_source_line(line, origin);
            ++origin.line;
        }
        open_.pop_back();
    }

    ShaderSource take() { return std::move(source_); }

  private:
    PartText read(std::string_view address, const std::string& place) {
        try {
            return files_.part(address);
        } catch (const GpuError& error) {
            throw GpuError(place.empty() ? error.what()
                                         : fmt::format("{}: {}", place, error.what()));
        }
    }

    void add_source_line(std::string_view line, SourceLine origin) {
        const std::optional<Include> include = include_of(line);
        if (!include) {
            add_line(line, origin);
            return;
        }
        const std::string place = fmt::format("shader {}", origin_name(source_, origin));
        if (include->name.empty()) {
            throw GpuError(fmt::format("{}: '{}' names nothing", place, line));
        }
        if (include->is_step) {
            add_step(include->name, place);
        } else {
            add_part(include->name, place);
        }
    }

    void add_step(std::string_view name, const std::string& place) {
        const auto step = steps_.find(name);
        if (step == steps_.end()) {
            throw GpuError(fmt::format("{}: no part is chosen for <{}>", place, name));
        }
        if (!step->second.part.empty()) {
            add_part(step->second.part, place);
        } else if (neutral_.insert(name).second) {
            add_line(step->second.neutral, {});
        }
    }

    const ShaderSteps& steps_;
    ShaderFiles files_;
    std::vector<std::string> open_;
    std::set<std::string_view> neutral_;  ///< Steps with a neutral value that is in the source.
    ShaderSource source_;
};

}  // namespace

ShaderSource assemble(std::string_view part, const ShaderSteps& steps,
                      const ShaderConstants& constants) {
    Assembler assembler(steps);
    assembler.add_line("#version 330 core", {});
    for (const auto& [name, value] : constants) {
        assembler.add_line(fmt::format("const int {} = {};", name, value), {});
    }
    assembler.add_part(part, "");
    return assembler.take();
}

std::string with_file_names(const std::string& message, const ShaderSource& source) {
    std::string result;
    std::size_t position = 0;
    while (position < message.size()) {
        const std::optional<LineMention> mention = line_mention(message, position);
        if (!mention || mention->line == 0 || mention->line > source.lines.size() ||
            source.lines[mention->line - 1].part < 0) {
            result += message[position++];
            continue;
        }
        result += origin_name(source, source.lines[mention->line - 1]);
        position = mention->end;
    }
    return result;
}

}  // namespace relief
