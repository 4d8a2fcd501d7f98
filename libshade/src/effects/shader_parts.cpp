// SPDX-License-Identifier: Apache-2.0
// Splits shader files at the markers in their comments, and reads the inputs that declarations
// name. Tests: tests/shade/effects/shader_parts_test.cpp.
#include "effects/shader_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <unordered_map>

#include "relief/shade/renderer.h"
#include "relief/shade/shader_texts.h"

namespace relief::shade::detail {

namespace {

constexpr std::string_view any_marker = "//@";
constexpr std::string_view part_marker = "//@part ";
constexpr std::string_view neutral_marker = "//@neutral ";
constexpr std::string_view include_marker = "//@include ";

[[noreturn]] void refuse_line(std::string_view file, std::size_t line, std::string_view problem) {
    throw GpuError(fmt::format("shader {}:{}: {}", file, line, problem));
}

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

/// True for the characters of names of parts, steps and GLSL.
bool is_name_character(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool is_name(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), is_name_character);
}

/// Removes the next word from a line and returns it.
std::string_view next_word(std::string_view& line) {
    const auto begin = std::find_if(line.begin(), line.end(), is_name_character);
    const auto end = std::find_if_not(begin, line.end(), is_name_character);
    const std::string_view word(line.data() + (begin - line.begin()),
                                static_cast<std::size_t>(end - begin));
    line.remove_prefix(static_cast<std::size_t>(end - line.begin()));
    return word;
}

/// Returns the input that a line declares: "uniform vec4 shadow_points[8];",
/// "in vec3 normal_object;" or "layout(std140) uniform Lights {".
std::optional<ShaderInput> input_of(std::string_view line) {
    if (line.starts_with("in ")) {
        next_word(line);
        next_word(line);
        return ShaderInput{ShaderInputKind::varying, next_word(line)};
    }
    if (line.starts_with("uniform ")) {
        next_word(line);
        const bool samples = next_word(line).starts_with("sampler");
        return ShaderInput{samples ? ShaderInputKind::sampler : ShaderInputKind::uniform,
                           next_word(line)};
    }
    constexpr std::string_view block = ") uniform ";
    const std::size_t name = line.find(block);
    if (!line.starts_with("layout(") || name == std::string_view::npos) return std::nullopt;
    line.remove_prefix(name + block.size());
    return ShaderInput{ShaderInputKind::block, next_word(line)};
}

/// Returns the part or neutral code that a line begins; none if it begins neither.
std::optional<ShaderPart> begun_part(std::string_view file, std::string_view line,
                                     std::size_t number) {
    ShaderPart part;
    part.file = file;
    part.first_line = static_cast<int>(number) + 1;
    if (line.starts_with(part_marker)) {
        constexpr std::string_view implements = " implements ";
        std::string_view name = line.substr(part_marker.size());
        if (const std::size_t at = name.find(implements); at != std::string_view::npos) {
            part.step = name.substr(at + implements.size());
            name = name.substr(0, at);
            if (!is_name(part.step))
                refuse_line(file, number, fmt::format("'{}' names no step", line));
        }
        if (!is_name(name)) refuse_line(file, number, fmt::format("'{}' names no part", line));
        part.address = fmt::format("{}#{}", file, name);
        return part;
    }
    if (!line.starts_with(neutral_marker)) return std::nullopt;
    part.step = line.substr(neutral_marker.size());
    part.is_neutral = true;
    part.address = fmt::format("{}#<{}>", file, part.step);
    if (!is_name(part.step)) refuse_line(file, number, fmt::format("'{}' names no step", line));
    return part;
}

/// Appends a line to a part.
void add_line(ShaderPart& part, std::string_view line, std::size_t number) {
    part.lines.push_back(line);
    if (const std::optional<ShaderInput> input = input_of(line)) part.inputs.push_back(*input);
    if (!line.starts_with(any_marker)) return;
    const std::optional<ShaderInclude> include = include_of(line);
    if (!include) refuse_line(part.file, number, fmt::format("'{}' is not a marker", line));
    part.includes.push_back(*include);
}

void remove_empty_end(ShaderPart& part) {
    while (!part.lines.empty() && part.lines.back().empty())
        part.lines.pop_back();
}

struct EmbeddedParts {
    std::vector<ShaderPart> all;
    std::unordered_map<std::string_view, const ShaderPart*> by_address;
    std::unordered_map<std::string_view, const ShaderPart*> neutral_by_step;
};

EmbeddedParts read_embedded_parts() {
    EmbeddedParts parts;
    for (const EmbeddedShader& shader : embedded_shaders()) {
        for (ShaderPart& part : parts_of(shader.name, shader.text))
            parts.all.push_back(std::move(part));
    }
    for (const ShaderPart& part : parts.all) {
        parts.by_address.emplace(part.address, &part);
        if (part.is_neutral) parts.neutral_by_step.emplace(part.step, &part);
    }
    return parts;
}

const EmbeddedParts& embedded_index() {
    static const EmbeddedParts parts = read_embedded_parts();
    return parts;
}

const ShaderPart* find_in(const std::unordered_map<std::string_view, const ShaderPart*>& parts,
                          std::string_view key) {
    const auto found = parts.find(key);
    return found == parts.end() ? nullptr : found->second;
}

}  // namespace

std::string marker_line(const ShaderPart& part) {
    if (part.is_neutral) return fmt::format("{}{}", neutral_marker, part.step);
    const std::string_view name = std::string_view(part.address).substr(part.file.size() + 1);
    return part.step.empty() ? fmt::format("{}{}", part_marker, name)
                             : fmt::format("{}{} implements {}", part_marker, name, part.step);
}

std::optional<ShaderInclude> include_of(std::string_view line) {
    if (!line.starts_with(include_marker)) return std::nullopt;
    line.remove_prefix(include_marker.size());
    if (line.size() <= 2) return std::nullopt;
    const std::string_view name = line.substr(1, line.size() - 2);
    if (line.front() == '<' && line.back() == '>') return ShaderInclude{true, name};
    if (line.front() == '"' && line.back() == '"') return ShaderInclude{false, name};
    return std::nullopt;
}

std::vector<ShaderPart> parts_of(std::string_view file, std::string_view text) {
    std::vector<ShaderPart> parts;
    ShaderPart whole;
    whole.address = whole.file = file;
    std::size_t first_code = 0;  // The number of the first line of code before all parts.
    std::size_t number = 0;
    for (const std::string_view line : lines_of(text)) {
        ++number;
        if (std::optional<ShaderPart> begun = begun_part(file, line, number)) {
            const bool is_new = std::none_of(parts.begin(), parts.end(), [&](const auto& part) {
                return part.address == begun->address;
            });
            if (!is_new) refuse_line(file, number, fmt::format("there are two parts '{}'", line));
            parts.push_back(std::move(*begun));
            continue;
        }
        add_line(parts.empty() ? whole : parts.back(), line, number);
        const bool is_comment = line.starts_with("//") && !line.starts_with(any_marker);
        if (parts.empty() && first_code == 0 && !line.empty() && !is_comment) first_code = number;
    }
    if (!parts.empty() && first_code != 0)
        refuse_line(file, first_code, "code before the first //@part");
    if (first_code != 0) parts.push_back(std::move(whole));
    for (ShaderPart& part : parts)
        remove_empty_end(part);
    return parts;
}

const std::vector<ShaderPart>& embedded_parts() {
    return embedded_index().all;
}

const ShaderPart* find_embedded_part(std::string_view address) {
    return find_in(embedded_index().by_address, address);
}

const ShaderPart* find_neutral_code(std::string_view step) {
    return find_in(embedded_index().neutral_by_step, step);
}

}  // namespace relief::shade::detail

namespace relief::shade {
using namespace relief::shade::detail;

std::string with_shader_part(std::string_view file, std::string_view address,
                             std::string_view part) {
    const std::string_view name = file_of(address);
    if (name == address) return std::string(part);
    const std::vector<std::string_view> lines = lines_of(file);
    std::size_t first = lines.size();  // The lines from here to `last` are replaced.
    std::size_t last = lines.size();
    for (const ShaderPart& old : parts_of(name, file)) {
        const auto begin = static_cast<std::size_t>(old.first_line) - 2;
        if (old.address == address) first = begin;
        if (old.address != address && first < begin && last == lines.size()) last = begin;
    }
    std::string result;
    for (std::size_t i = 0; i < first; ++i)
        result.append(lines[i]) += '\n';
    if (!result.empty() && !result.ends_with("\n\n")) result += '\n';
    result += part;
    if (!result.ends_with('\n')) result += '\n';
    if (last < lines.size()) result += '\n';
    for (std::size_t i = last; i < lines.size(); ++i)
        result.append(lines[i]) += '\n';
    return result;
}

}  // namespace relief::shade
