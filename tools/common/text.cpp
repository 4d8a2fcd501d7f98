// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/text_test.cpp.
#include "common/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "common/file_jobs.h"
#include "common/options.h"
#include "file_replacement.h"
#include "files.h"

namespace relief::tools {
using namespace relief::detail;

std::string counted(std::size_t count, const std::string& thing, const std::string& plural) {
    if (count == 1) return "1 " + thing;
    return fmt::format("{} {}", count, plural.empty() ? thing + "s" : plural);
}

std::string byte_size(std::uintmax_t bytes) {
    if (bytes < 1000) return fmt::format("{} B", bytes);
    double size = static_cast<double>(bytes) / 1000;
    const char* unit = "kB";
    for (const char* larger : {"MB", "GB"}) {
        if (size < 999.5) break;
        size /= 1000;
        unit = larger;
    }
    return size < 9.95 ? fmt::format("{:.1f} {}", size, unit)
                       : fmt::format("{:.0f} {}", size, unit);
}

std::string duration(double milliseconds) {
    if (milliseconds < 9.95) return fmt::format("{:.1f} ms", milliseconds);
    if (milliseconds < 999.5) return fmt::format("{:.0f} ms", milliseconds);
    return fmt::format("{:.2f} s", milliseconds / 1000);
}

std::string durations(const std::vector<Stage>& stages) {
    std::string text;
    double sum = 0;
    for (const Stage& stage : stages) {
        text += fmt::format("{} {}, ", stage.name, duration(stage.milliseconds));
        sum += stage.milliseconds;
    }
    return text + duration(sum) + " in all";
}

std::string file_and_size(const std::filesystem::path& file) {
    return fmt::format("{}: {}", file.string(), byte_size(std::filesystem::file_size(file)));
}

std::string extension_of(const std::filesystem::path& file) {
    return in_lower_case(file.extension().string());
}

std::string in_lower_case(std::string text) {
    for (char& letter : text)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return text;
}

bool has_image_extension(const std::filesystem::path& file) {
    static constexpr std::array<std::string_view, 12> images = {".png",  ".jpg",  ".jpeg", ".hdr",
                                                                ".exr",  ".tif",  ".tga",  ".bmp",
                                                                ".tiff", ".ktx2", ".dds",  ".webp"};
    return std::find(images.begin(), images.end(), extension_of(file)) != images.end();
}

std::string quoted(const std::filesystem::path& file) {
    const std::string name = file.string();
    const bool is_plain = std::all_of(name.begin(), name.end(), [](unsigned char letter) {
        return std::isalnum(letter) != 0 || letter > 127 ||
               std::string_view("/._-+=,:@%").find(static_cast<char>(letter)) !=
                   std::string_view::npos;
    });
    if (is_plain) return name;
    std::string result = "'";
    for (const char letter : name)
        result += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return result + "'";
}

std::string printable(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
        const auto first = static_cast<unsigned char>(character[0]);
        // Those of ASCII, and U+0080 to U+009F, which begin commands of terminals too.
        const bool is_control =
            first < 0x20 || first == 0x7F || (length == 2 && character < "\xC2\xA0");
        if (length == 0 || is_control) {
            for (const char byte : character)
                result += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
        } else {
            result += character;
        }
        text.remove_prefix(character.size());
    }
    return result;
}

std::string printable_lines(std::string_view text) {
    std::string result;
    for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n')) {
        result += printable(text.substr(0, end)) + "\n";
        text.remove_prefix(end + 1);
    }
    return result + printable(text);
}

void print_entry(const std::string& label, const std::string& text) {
    if (is_out_reserved()) return;
    print_text(fmt::format("{:<10}{}\n", label, printable(text)));
}

void print_entry(const std::string& label, const std::vector<std::string>& lines) {
    for (std::size_t i = 0; i < lines.size(); ++i)
        print_entry(i == 0 ? label : "", lines[i]);
}

std::string dumped(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void print_json(const nlohmann::ordered_json& json) {
    print_text(dumped(json));
}

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
    if (file == standard_stream) return print_json(json);
    const std::string text = dumped(json);
    replace_file(file, std::as_bytes(std::span(text)));
}

// Findings.

std::string to_string(const PlacedFinding& placed) {
    const Finding& finding = placed.finding;
    const std::string prefix = placed.where.empty() ? "" : placed.where + ": ";
    if (finding.element != "texel" || placed.map_width == 0) return prefix + to_string(finding);
    std::string texels;
    for (const std::size_t index : finding.first)
        texels += (texels.empty() ? "" : "; ") + texel_name(index, placed.map_width);
    if (finding.count > finding.first.size()) texels += "; ...";
    return fmt::format("{}{} x {} ({}): {}", prefix, finding.count, finding.kind, texels,
                       finding.outcome);
}

std::string texel_name(std::size_t index, int width) {
    const auto columns = static_cast<std::size_t>(width);
    return fmt::format("column {}, row {}", index % columns, index / columns);
}

void Findings::add(const std::string& where, const Report& report, int map_width) {
    for (const Finding& finding : report.findings())
        findings_.push_back({where, finding, map_width});
}

std::vector<std::string> Findings::lines(std::size_t limit) const {
    std::vector<std::string> lines;
    for (const PlacedFinding& placed : findings_) {
        if (lines.size() == limit) {
            lines.push_back(fmt::format("... and {} more", findings_.size() - limit));
            break;
        }
        lines.push_back(to_string(placed));
    }
    return lines;
}

std::string Findings::count_text() const {
    return findings_.empty() ? "no findings" : counted(findings_.size(), "finding");
}

nlohmann::ordered_json Findings::json() const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& [where, finding, map_width] : findings_) {
        list.push_back({{"where", where},
                        {"kind", finding.kind},
                        {"element", finding.element},
                        {"count", finding.count},
                        {"first", finding.first},
                        {"outcome", finding.outcome}});
        if (finding.element != "texel" || map_width == 0) continue;
        nlohmann::ordered_json texels = nlohmann::ordered_json::array();
        for (const std::size_t index : finding.first) {
            const auto columns = static_cast<std::size_t>(map_width);
            texels.push_back({{"column", index % columns}, {"row", index / columns}});
        }
        list.back()["texels"] = std::move(texels);
    }
    return list;
}

void add_report_options(CLI::App& app, ReportOptions& options, const std::string& strict) {
    add_path(app, "--report", options.file,
             "Write a JSON report with results and findings to FILE; - prints it instead of the "
             "summary.")
        .group("Report");
    add_switch(app, "--strict", options.strict,
               strict.empty() ? "Exit with 3 if there are findings on the input; the output is "
                                "written anyway."
                              : strict)
        .group("Report");
}

namespace {

/// Returns whether a file may be a model or the buffer or material file of one. Commands read and
/// write such files also if their command line does not name them.
bool belongs_to_model(const std::filesystem::path& file) {
    static constexpr std::array<std::string_view, 8> models = {".glb", ".gltf", ".bin", ".obj",
                                                               ".mtl", ".ply",  ".stl", ".off"};
    return std::find(models.begin(), models.end(), extension_of(file)) != models.end();
}

}  // namespace

void check(const ReportOptions& options, const std::vector<std::filesystem::path>& files) {
    if (!options.file) return;
    if (*options.file == standard_stream) return reserve_out_for_report();
    check_distinct("--report", *options.file, files);
    const std::filesystem::path target = identity_of(*options.file);  // A link is followed.
    for (const std::filesystem::path& file : {*options.file, target}) {
        if (!belongs_to_model(file) && !has_image_extension(file)) continue;
        const std::string place = std::filesystem::is_symlink(*options.file)
                                      ? fmt::format("is a link to {}, ", target.string())
                                      : "is ";
        throw UsageError(fmt::format("--report {}: {}the name of a model or an image",
                                     options.file->string(), place),
                         "use .json");
    }
    require_folder_of(*options.file);
    const FileReplacement can_be_made(*options.file);  // Throws if not; removed at once.
}

bool found_fault(const CLI::App& app, const ReportOptions& options,
                 const std::filesystem::path& input, const Findings& findings) {
    if (!options.strict || findings.empty()) return false;
    warn(app, fmt::format("{}: {} (exit code 3, because of --strict)", input.string(),
                          counted(findings.all().size(), "finding")));
    return true;
}

ExitCode finish(const CLI::App& app, const ReportOptions& options,
                const std::filesystem::path& input, const Findings& findings,
                const nlohmann::ordered_json& report) {
    if (options.file) write_json(*options.file, report);
    return found_fault(app, options, input, findings) ? ExitCode::fell_back : ExitCode::done;
}

}  // namespace relief::tools
