// SPDX-License-Identifier: Apache-2.0
// Tests: tests/check/check_fix_test.cpp.
#include "check_fix.h"

#include <fmt/format.h>

#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <variant>

#include "check_files.h"
#include "common/command.h"
#include "common/file_jobs.h"
#include "common/options.h"
#include "driver.h"
#include "relief/mesh/gltf_document.h"
#include "run_program.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// Returns the arguments of a remedy with the names of the files.
std::vector<std::string> command_line_of(std::string_view remedy, const fs::path& input,
                                         const fs::path& output) {
    std::vector<std::string> words = split(remedy, ' ');
    for (std::string& word : words) {
        if (word == "IN") word = as_argument(input).string();
        if (word == "OUT") word = as_argument(output).string();
    }
    words.emplace_back("--quiet");
    return words;
}

/// Runs a tool of relief. \return its first message, or a reason; empty if it succeeded
std::string run(std::vector<std::string> words) {
    const std::string tool = words.front();
    words.front() = sibling_program(tool).string();
    const ProgramOutput output = run_program(words, CapturedStream::errors);
    if (output.exit_code == 0) return "";
    if (output.exit_code == 127) return fmt::format("{}: {}", tool, output.text);
    const std::string line = output.text.substr(0, output.text.find('\n'));
    return line.empty() ? tool + " failed" : line;
}

/// A remedy of a file or of an embedded image.
struct Remedy {
    std::string_view command;
    std::optional<std::size_t> image;

    bool operator==(const Remedy&) const = default;
};

bool is_to_fix(const CheckFinding& finding) {
    return finding.is_fixable && finding.severity >= CheckSeverity::warning;
}

/// Returns the remedies of a file, repairs of triangles first: they change normals and tangents;
/// images last.
std::vector<Remedy> remedies_of(const CheckedItem& item) {
    const auto rank = [](const Remedy& remedy) {
        return std::tuple(remedy.image, !remedy.command.starts_with("relief-mesh repair"),
                          remedy.command);
    };
    std::vector<Remedy> remedies;
    for (const CheckFinding& finding : item.findings) {
        const Remedy remedy{finding.rule->remedy, finding.image};
        if (is_to_fix(finding) && std::ranges::find(remedies, remedy) == remedies.end())
            remedies.push_back(remedy);
    }
    std::ranges::sort(remedies, {}, rank);
    return remedies;
}

/// Returns the name of a copy: that of the file, without what leads out of the folder.
fs::path copy_of(const fs::path& file, const fs::path& folder) {
    fs::path inside;
    for (const fs::path& part : file.lexically_normal().relative_path()) {
        if (part != "..") inside /= part;
    }
    return folder / inside;
}

/// A folder of temporary files.
class TemporaryFolder {
  public:
    /// \throws FileError
    TemporaryFolder() {
        std::string name = (fs::temp_directory_path() / "relief-fix-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw FileError(name, "cannot be made");
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

/// Returns the name of a file for an image, which becomes the name of the new image.
std::string stem_of(const GltfImage& image, std::size_t index) {
    const bool is_plain =
        !image.name.empty() && image.name.front() != '.' && image.name.size() < 200 &&
        std::ranges::all_of(image.name, [](char letter) {
            return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                   (letter >= '0' && letter <= '9') ||
                   std::string_view("._- ").find(letter) != std::string_view::npos;
        });
    return is_plain ? image.name : fmt::format("image-{}", index);
}

/// Replaces an embedded image in all materials that show it.
void replace_image(GltfDocument& document, std::size_t index, const fs::path& file) {
    const GltfView view = document.view();
    for (std::size_t material = 0; material < view.materials.size(); ++material) {
        for (const TextureSlotInfo& slot : texture_slots) {
            const Texture* const texture = find_texture(view.materials[material], slot.slot);
            if (texture != nullptr && texture->image == index)
                document.set_texture(material, slot.slot, file, GltfImageStorage::embedded);
        }
    }
}

/// Runs the remedies of embedded images. \return the first message, or a reason; empty if all
/// succeeded
std::string fix_images(const fs::path& input, const fs::path& output,
                       std::span<const Remedy> remedies) {
    const TemporaryFolder folder;
    Report reading;
    GltfDocument document = GltfDocument::read(input, reading);
    const std::vector<GltfImage> images = document.view().images;
    std::map<std::size_t, fs::path> fixed;
    for (std::size_t step = 0; step < remedies.size(); ++step) {
        const Remedy& remedy = remedies[step];
        const std::size_t index = *remedy.image;
        fs::path& file = fixed[index];
        if (file.empty()) {
            const auto& bytes = std::get<std::vector<std::byte>>(images.at(index).source);
            file = folder.path() / fmt::format("{}-in{}", index, image_suffix(bytes));
            std::ofstream stream(file, std::ios::binary);
            stream.write(reinterpret_cast<const char*>(bytes.data()),
                         static_cast<std::streamsize>(bytes.size()));
            stream.close();
            if (!stream) return "an embedded image cannot be written to the temporary folder";
        }
        const fs::path next =
            folder.path() / std::to_string(step) / (stem_of(images.at(index), index) + ".png");
        fs::create_directories(next.parent_path());
        const std::string error = run(command_line_of(remedy.command, file, next));
        if (!error.empty()) return error;
        file = next;
    }
    for (const auto& [index, file] : fixed)
        replace_image(document, index, file);
    document.write(output);
    return "";
}

std::string shown(const Remedy& remedy) {
    return remedy.image ? fmt::format("{} (image {})", remedy.command, *remedy.image)
                        : std::string(remedy.command);
}

/// Runs the remedies one after another on the output of the one before.
CheckFix fix(const CheckedItem& item, const fs::path& output) {
    CheckFix done{item.file, output, "", "", {}};
    try {
        if (output != item.file) make_folder(output.parent_path());
        fs::path input = item.file;
        const std::vector<Remedy> remedies = remedies_of(item);
        for (std::size_t i = 0; i < remedies.size(); ++i) {
            if (!done.command.empty()) done.command += "; ";
            done.command += shown(remedies[i]);
            if (remedies[i].image) {
                for (std::size_t k = i + 1; k < remedies.size(); ++k)
                    done.command += "; " + shown(remedies[k]);
                done.error = fix_images(input, done.output, std::span(remedies).subspan(i));
                return done;
            }
            done.error = run(command_line_of(remedies[i].command, input, done.output));
            if (!done.error.empty()) return done;
            input = done.output;
        }
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        done.error = error.what();
    }
    return done;
}

// The check of the fixed files.

using Roles = std::map<fs::path, std::vector<ImageRole>>;

Roles roles_of(const std::vector<CheckedItem>& items) {
    Roles roles;
    for (const CheckedItem& item : items) {
        for (const UsedImage& image : item.images)
            roles[identity_of(image.file)].push_back(image.role);
    }
    for (auto& [file, list] : roles) {
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return roles;
}

/// Checks a fixed file as the one that it replaces.
CheckedItem checked_again(const CheckedItem& item, const CheckFix& fix, const Roles& roles,
                          CheckProject project) {
    const auto uses = roles.find(identity_of(item.file));
    CheckedItem again =
        item.kind == CheckedKind::model
            ? check_model_file({fix.output, CheckedKind::model, {}})
            : check_image_file(fix.output,
                               uses == roles.end() ? std::vector<ImageRole>{} : uses->second);
    again.file = item.file;
    project.budgets.clear();
    apply(project, {}, again);
    return again;
}

/// Returns the count of a finding after the fix. A new image has another index, so that images are
/// compared by the number of those with the finding.
std::size_t remaining_count(const CheckedItem& before, const CheckedItem& after,
                            const CheckFinding& finding) {
    const auto is_same = [&](const CheckFinding& other) {
        return other.rule == finding.rule && other.image.has_value() == finding.image.has_value() &&
               other.severity >= CheckSeverity::warning;
    };
    // Images that no material shows, and those that are neither PNG nor JPEG.
    const auto others = std::ranges::count_if(before.findings, [&](const CheckFinding& other) {
        return is_same(other) && !is_to_fix(other);
    });
    if (std::ranges::count_if(after.findings, is_same) <= others) return 0;
    std::size_t count = 0;
    for (const CheckFinding& other : after.findings)
        count += is_same(other) ? other.count : 0;
    return count;
}

/// Compares the findings before and after a fix.
void compare(const CheckedItem& before, const CheckedItem& after, CheckFix& fix) {
    std::set<std::string_view> remaining, known;
    for (const CheckFinding& finding : before.findings) {
        if (finding.severity < CheckSeverity::warning) continue;
        known.insert(finding.rule->id);
        if (!is_to_fix(finding)) continue;
        FixedFinding fixed{finding.rule->id, finding.place, finding.count, 0};
        fixed.remaining = remaining_count(before, after, finding);
        if (fixed.remaining > 0) remaining.insert(fixed.rule);
        fix.findings.push_back(std::move(fixed));
    }
    std::set<std::string_view> caused;
    for (const CheckFinding& finding : after.findings) {
        if (finding.severity >= CheckSeverity::warning && !known.contains(finding.rule->id))
            caused.insert(finding.rule->id);
    }
    if (!remaining.empty())
        fix.error = fmt::format("{} remains after the remedy", fmt::join(remaining, ", "));
    if (!caused.empty()) {
        fix.error += fmt::format("{}the fixed file has {}", fix.error.empty() ? "" : "; ",
                                 fmt::join(caused, ", "));
    }
}

}  // namespace

std::vector<CheckFix> fix_files(const std::vector<CheckedItem>& items,
                                const std::optional<fs::path>& folder,
                                const CheckProject& project) {
    std::vector<CheckFix> fixes;
    std::vector<const CheckedItem*> fixed;
    std::map<fs::path, fs::path> copies;  // The files of the copies.
    for (const CheckedItem& item : items)
        copies.emplace(identity_of(item.file), item.file);
    // A fixed copy of a model brings copies of its images, which fixed ones then replace.
    for (const CheckedKind kind : {CheckedKind::model, CheckedKind::image}) {
        for (const CheckedItem& item : items) {
            if (item.kind != kind || remedies_of(item).empty()) continue;
            fixed.push_back(&item);
            const fs::path copy = folder ? copy_of(item.file, *folder) : item.file;
            const auto [other, is_new] = copies.emplace(identity_of(copy), item.file);
            if (folder && !is_new) {
                fixes.push_back({item.file,
                                 copy,
                                 "",
                                 fmt::format("its copy would replace {} (give another folder)",
                                             other->second.string()),
                                 {}});
                continue;
            }
            fixes.push_back(fix(item, copy));
        }
    }
    const Roles roles = roles_of(items);
    for (std::size_t i = 0; i < fixes.size(); ++i) {
        if (fixes[i].error.empty())
            compare(*fixed[i], checked_again(*fixed[i], fixes[i], roles, project), fixes[i]);
    }
    return fixes;
}

}  // namespace relief::tools
