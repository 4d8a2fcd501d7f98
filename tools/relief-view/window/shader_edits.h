// SPDX-License-Identifier: Apache-2.0
/// \file
/// Parts of shaders that the user edits in the window: texts, errors at their lines, differences,
/// and files. It uses no window. Tests: tests/tools/window/shader_edits_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "relief/shade/shader_texts.h"

namespace relief::tools {

struct Exercise;

/// Returns the lines of two texts, those of both after "  ", those of the first alone after "- ",
/// those of the second alone after "+ ".
std::vector<std::string> line_difference(const std::string& before, const std::string& after);

/// A line of a text, from 1, and a message about it.
struct LineMessage {
    int line = 1;
    std::string text;

    friend bool operator==(const LineMessage&, const LineMessage&) = default;
};

/// The edited parts, by address. Pictures are drawn with the texts of the last apply().
class ShaderEdits {
  public:
    /// An edit applies when typing pauses for so many seconds.
    static constexpr double pause_seconds = 0.4;

    /// The text of a part as it was edited last, or else as it is without edits.
    /// \throws GpuError if there is no such part
    [[nodiscard]] std::string text(const std::string& address) const;

    /// The text that is built in.
    [[nodiscard]] static std::string original(const std::string& address);

    /// Sets the text of a part. \param now  in seconds
    void set(const std::string& address, const std::string& text, double now);

    /// Makes the part that of an exercise: its start, unless $RELIEF_SHADER_DIR has the part.
    void begin(const Exercise& exercise);

    /// Returns the part to its text that is built in: as an edit if $RELIEF_SHADER_DIR has another.
    void reset(const std::string& address);

    /// Applies the edits if typing has paused. \return whether texts() changed
    bool apply(double now);
    /// Returns whether there are edits that apply later.
    [[nodiscard]] bool is_pending() const { return is_pending_; }

    [[nodiscard]] bool is_edited(const std::string& address) const {
        return edits_.contains(address);
    }
    [[nodiscard]] bool has_edits() const { return !edits_.empty(); }

    /// The texts for FrameSettings::shaders; null without edits.
    [[nodiscard]] const std::shared_ptr<const shade::ShaderTexts>& texts() const { return texts_; }

    /// Returns the messages of the driver about lines of a part.
    /// \param message  of the renderer: "phong.glsl:12(3): error: ..."
    [[nodiscard]] std::vector<LineMessage> messages(const std::string& address,
                                                    std::string_view message) const;

    /// Writes the edited parts into the files of a folder, whose other parts stay. The edits of
    /// $RELIEF_SHADER_DIR end.
    /// \return the names of the written files
    /// \throws FileError
    std::vector<std::string> save(const std::filesystem::path& folder);

    /// The folder for save(): $RELIEF_SHADER_DIR, or "my-shaders".
    [[nodiscard]] static std::filesystem::path default_folder();

    /// {"edited": addresses, "pending", "applied": how often texts() changed}
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    std::map<std::string, std::string> edits_;
    std::shared_ptr<const shade::ShaderTexts> texts_;
    bool is_pending_ = false;
    double changed_at_ = 0.0;
    std::size_t applied_ = 0;
};

}  // namespace relief::tools
