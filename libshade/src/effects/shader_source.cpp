// SPDX-License-Identifier: Apache-2.0
// Expands includes depth first, each part once, refuses cycles, and keeps the file and number of
// every line, since drivers report only the line of the whole. Missing parts and cycles throw
// GpuError. Tests: tests/shade/effects/shader_source_test.cpp.
#include "effects/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <list>
#include <optional>
#include <set>
#include <system_error>

#include "progress_stage.h"
#include "relief/shade/renderer.h"

namespace relief::shade::detail {
using namespace relief::detail;

namespace {

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

/// Returns "light.glsl:12".
std::string origin_name(const ShaderSource& source, SourceLine origin) {
    return fmt::format("{}:{}", source.files[static_cast<std::size_t>(origin.file)], origin.line);
}

/// A value that GLSL computes where it declares a global variable: "vec4 x = texture(...);".
struct GlobalValue {
    std::string_view declaration;  ///< "vec4 x"
    std::string_view assignment;   ///< "x = texture(...);"
};

std::optional<GlobalValue> global_value_of(std::string_view line) {
    const std::size_t equals = line.find(" = ");
    const std::size_t end = line.find(';');
    if (equals == std::string_view::npos || end == std::string_view::npos) return std::nullopt;
    const std::size_t space = line.find(' ');
    const bool is_declared =
        std::isalpha(static_cast<unsigned char>(line.front())) != 0 && space < equals;
    // Constants and functions have more between the type and the sign than a name.
    const std::string_view name = line.substr(space + 1, equals - space - 1);
    if (!is_declared || name.find_first_of(" (") != std::string_view::npos) return std::nullopt;
    return GlobalValue{line.substr(0, equals), line.substr(space + 1, end - space)};
}

/// The files of one shader: those of $RELIEF_SHADER_DIR are read once each.
class ShaderFiles {
  public:
    explicit ShaderFiles(const ShaderTexts& texts) : texts_(texts) {}

    /// Returns a part or neutral code.
    /// \throws GpuError if there is no such file or part, or a file is malformed
    const ShaderPart& part(std::string_view address) {
        const std::string_view file = file_of(address);
        const std::list<Override>& overrides = overrides_of(file);
        for (const Override& override_file : overrides) {
            for (const ShaderPart& part : override_file.parts) {
                if (part.address == address) return part;
                if (part.address == file)
                    throw GpuError(fmt::format("shader {}: no line begins with //@part", file));
                if (address == file)
                    throw GpuError(
                        fmt::format("shader {}: a file of one part has no //@part", file));
            }
        }
        if (const ShaderPart* const part = find_embedded_part(address)) return *part;
        const auto& all = embedded_shaders();
        const bool is_known = std::any_of(
            all.begin(), all.end(), [&](const EmbeddedShader& each) { return each.name == file; });
        if (!is_known && overrides.empty())
            throw GpuError(fmt::format("there is no shader file '{}'", file));
        throw GpuError(fmt::format("there is no part '{}' in shader file '{}'",
                                   address.substr(std::min(file.size() + 1, address.size())),
                                   file));
    }

  private:
    struct Override {
        std::string text;
        std::vector<ShaderPart> parts;
    };

    /// Returns the files of a name that replace the embedded one, the first one first.
    const std::list<Override>& overrides_of(std::string_view name) {
        const auto [entry, is_new] = overrides_.try_emplace(std::string(name));
        if (!is_new) return entry->second;
        if (const auto given = texts_.files.find(entry->first); given != texts_.files.end())
            entry->second.push_back({given->second, {}});
        const char* const folder = texts_.uses_folder ? std::getenv("RELIEF_SHADER_DIR") : nullptr;
        if (folder != nullptr) {
            const std::filesystem::path path = std::filesystem::path(folder) / name;
            note_file(path);
            std::ifstream file(path, std::ios::binary);
            if (file)
                entry->second.push_back(
                    {{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()}, {}});
        }
        for (Override& each : entry->second)
            each.parts = parts_of(entry->first, each.text);
        return entry->second;
    }

    const ShaderTexts& texts_;
    std::map<std::string, std::list<Override>> overrides_;
};

/// Assembles one shader.
class Assembler {
  public:
    Assembler(const ShaderSteps& steps, GlslVersion version, const ShaderTexts& texts)
        : steps_(steps), version_(version), files_(texts) {}

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
        if (!added_.insert(std::string(address)).second) return;
        const ShaderPart& part = read(address, place);
        if (!part.is_neutral) source_.parts.emplace_back(address);
        open_.emplace_back(address);
        SourceLine origin{file_number(part.file), part.first_line};
        for (const std::string_view line : part.lines) {
            add_source_line(line, origin);
            ++origin.line;
        }
        open_.pop_back();
    }

    /// Adds the part that includes all others, and returns the source.
    /// \throws GpuError if global variables have values, and no line is "void main() {"
    ShaderSource finish(std::string_view main) {
        source_.main = main;
        source_.head_size = source_.text.size();
        add_part(main, "");
        if (!assignments_.empty()) throw GpuError("a shader has no line 'void main() {'");
        return std::move(source_);
    }

  private:
    const ShaderPart& read(std::string_view address, const std::string& place) {
        try {
            return files_.part(address);
        } catch (const GpuError& error) {
            const std::string_view message = error.what();
            if (place.empty() || message.starts_with("shader ")) throw;
            throw GpuError(fmt::format("{}: {}", place, message));
        }
    }

    int file_number(std::string_view file) {
        auto& files = source_.files;
        const auto known = std::find(files.begin(), files.end(), file);
        if (known != files.end()) return static_cast<int>(known - files.begin());
        files.emplace_back(file);
        return static_cast<int>(files.size()) - 1;
    }

    void add_source_line(std::string_view line, SourceLine origin) {
        const std::optional<ShaderInclude> include = include_of(line);
        if (!include) {
            add_code(line, origin);
            return;
        }
        const std::string place = fmt::format("shader {}", origin_name(source_, origin));
        if (include->is_step) {
            add_step(include->name, place);
        } else {
            add_part(include->name, place);
        }
    }

    void add_step(std::string_view name, const std::string& place) {
        if (const auto step = steps_.find(name); step != steps_.end()) {
            source_.steps.emplace(name, step->second);
            add_part(step->second, place);
        } else if (const ShaderPart* const neutral = find_neutral_code(name)) {
            source_.steps.emplace(name, neutral->address);
            add_part(neutral->address, place);
        } else {
            throw GpuError(fmt::format("{}: no part is chosen for <{}>", place, name));
        }
    }

    /// GLSL ES computes no values where it declares global variables: main() begins with them.
    void add_code(std::string_view line, SourceLine origin) {
        if (version_ == GlslVersion::core_330) {
            add_line(line, origin);
        } else if (const std::optional<GlobalValue> value = global_value_of(line)) {
            add_line(fmt::format("{};", value->declaration), origin);
            assignments_.emplace_back(value->assignment, origin);
        } else {
            add_line(line, origin);
            if (line != "void main() {") return;
            for (const auto& [assignment, place] : assignments_)
                add_line(fmt::format("    {}", assignment), place);
            assignments_.clear();
        }
    }

    const ShaderSteps& steps_;
    GlslVersion version_;
    ShaderFiles files_;
    std::vector<std::string> open_;
    std::set<std::string> added_;
    std::vector<std::pair<std::string, SourceLine>> assignments_;
    ShaderSource source_;
};

}  // namespace

ShaderSource assemble(std::string_view part, const ShaderSteps& steps,
                      const ShaderConstants& constants, GlslVersion version,
                      const ShaderTexts& texts) {
    const bool is_es = version == GlslVersion::es_300;
    ShaderSteps all_steps = steps;
    if (is_es) choose_part(all_steps, "version.glsl#es_buffers");
    Assembler assembler(all_steps, version, texts);
    assembler.add_line(is_es ? "#version 300 es" : "#version 330 core", {});
    if (is_es) assembler.add_part("version.glsl#es_precision", "");
    for (const auto& [name, value] : constants) {
        assembler.add_line(fmt::format("const int {} = {};", name, value), {});
    }
    return assembler.finish(part);
}

void choose_part(ShaderSteps& steps, std::string_view part) {
    const ShaderPart* const chosen = find_embedded_part(part);
    if (chosen == nullptr || chosen->step.empty())
        throw GpuError(fmt::format("no shader part '{}' implements a step", part));
    [[maybe_unused]] const bool is_new = steps.emplace(chosen->step, chosen->address).second;
    assert(is_new && "two parts for one step");
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
        result += origin_name(source, source.lines[mention->line - 1]);
        position = mention->end;
    }
    return result;
}

}  // namespace relief::shade::detail

namespace relief::shade {
using namespace relief::shade::detail;

ShaderPartText shader_part_text(std::string_view address, const ShaderTexts& texts) {
    ShaderFiles files(texts);
    const ShaderPart& part = files.part(address);
    ShaderPartText result;
    result.file = part.file;
    result.first_line = part.first_line;
    result.is_built_in = &part == find_embedded_part(address);
    if (part.address != part.file) {
        result.text = marker_line(part) + '\n';
        --result.first_line;
    }
    for (const std::string_view line : part.lines)
        result.text.append(line) += '\n';
    return result;
}

}  // namespace relief::shade
