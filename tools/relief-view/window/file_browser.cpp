// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/file_browser_test.cpp.
#include "window/file_browser.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cfloat>
#include <cstdint>
#include <utility>

#include "relief/mesh/image_file.h"
#include "window/shortcuts.h"

namespace relief::tools {
using namespace relief::shade;

std::filesystem::path folder_to_browse(const std::optional<std::string>& image,
                                       const std::filesystem::path& otherwise) {
    std::error_code none;
    if (image && std::filesystem::exists(*image, none)) {
        const std::filesystem::path file = *image;
        if (std::filesystem::is_directory(file, none)) return file;
        if (file.has_parent_path()) return file.parent_path();
    }
    if (std::filesystem::is_directory(otherwise, none)) return otherwise;
    return otherwise.has_parent_path() ? otherwise.parent_path()
                                       : std::filesystem::current_path(none);
}

Thumbnail thumbnail_in(const PictureExchange::Shown& texture, const Thumbnails::Place& place) {
    // The first row of a texture is at the bottom.
    const glm::vec2 scale(1.0F / static_cast<float>(texture.width),
                          1.0F / static_cast<float>(texture.height));
    const glm::vec2 min = glm::vec2(place.min) * scale;
    const glm::vec2 max = glm::vec2(place.min + place.size) * scale;
    return {texture.texture,
            {min.x, 1.0F - min.y},
            {max.x, 1.0F - max.y},
            place.size,
            place.image_size};
}

std::optional<Thumbnails::Place> ImagePreviews::want(const std::filesystem::path& file) {
    const auto known = entries_.find(file);
    if (known != entries_.end()) return known->second.place;
    entries_.emplace(file, Entry{stamp_of(file), std::nullopt});
    wanted_.push_back(file);
    return std::nullopt;
}

void ImagePreviews::update() {
    if (wanted_.empty() || job_.is_running()) return;
    if (count_ + max_batch > Thumbnails::max_count) {  // Begins again with what is in view.
        entries_.clear();
        wanted_.clear();
        count_ = 0;
        return;
    }
    std::vector<std::filesystem::path> files;
    while (!wanted_.empty() && files.size() < max_batch) {
        files.push_back(std::move(wanted_.front()));
        wanted_.pop_front();
    }
    job_.start([files](const Progress&) {
        std::vector<ImageSource> images;
        for (const std::filesystem::path& file : files)
            images.push_back({.name = file.string(), .source = file, .is_required = true});
        return Batch{files, Thumbnails::reduced(images)};
    });
}

std::optional<Image> ImagePreviews::take() {
    std::optional<Batch> batch = job_.take();
    if (!batch) return std::nullopt;
    constexpr int cell = Thumbnails::cell;
    constexpr int columns = Thumbnails::columns;
    for (std::size_t i = 0; i < batch->files.size(); ++i) {
        const auto entry = entries_.find(batch->files[i]);
        if (entry == entries_.end()) continue;
        Thumbnails::Place place = batch->made.places[i];
        const auto index = static_cast<int>(count_++);
        const glm::ivec2 to(cell * (index % columns), cell * (index / columns));
        if (to.y + cell > picture_.height) {
            Image larger = make_image(columns * cell, to.y + cell, 4, 8, ColorSpace::srgb);
            if (!picture_.empty())
                std::copy_n(picture_.as<std::uint8_t>().begin(), picture_.as<std::uint8_t>().size(),
                            larger.as<std::uint8_t>().begin());
            picture_ = std::move(larger);
        }
        const auto stride = static_cast<std::size_t>(4 * columns * cell);
        for (int row = 0; row < place.size.y; ++row) {
            const auto at = [&](const glm::ivec2& corner) {
                return static_cast<std::ptrdiff_t>(static_cast<std::size_t>(corner.y + row) *
                                                       stride +
                                                   4 * static_cast<std::size_t>(corner.x));
            };
            std::copy_n(batch->made.picture.as<std::uint8_t>().begin() + at(place.min),
                        4 * place.size.x, picture_.as<std::uint8_t>().begin() + at(to));
        }
        place.min = to;
        entry->second.place = place;
    }
    return picture_;
}

/// The user's choice in this frame.
struct FileDialog::Choice {
    std::optional<std::filesystem::path> file;
    std::optional<std::filesystem::path> folder;
    bool is_cancelled = false;
};

namespace {

constexpr float preview_height = 2.6F;  // In line heights.

bool is_image(const std::filesystem::path& file) {
    return dropped_as(file) != DroppedAs::model;
}

/// Draws an image into a rectangle, at its upper left and as large as fits.
void draw_fitting(const Thumbnail& thumbnail, const ImVec2& corner, float side) {
    const float scale =
        side / static_cast<float>(std::max({thumbnail.size.x, thumbnail.size.y, 1}));
    const glm::vec2 size = scale * glm::vec2(thumbnail.size);
    ImGui::GetWindowDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(thumbnail.texture)), corner,
        {corner.x + size.x, corner.y + size.y}, {thumbnail.min.x, thumbnail.min.y},
        {thumbnail.max.x, thumbnail.max.y});
}

/// Draws the row of an image file with its preview. \return whether it was clicked
bool draw_image_row(const std::filesystem::path& file, ImagePreviews& previews,
                    const PictureExchange::Shown& texture) {
    const float side = preview_height * ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool is_clicked =
        ImGui::Selectable(("##" + file.string()).c_str(), false, 0, {0.0F, side});
    const bool is_hovered = ImGui::IsItemHovered();
    if (!ImGui::IsItemVisible()) return is_clicked;
    std::string size;
    if (const std::optional<Thumbnails::Place> place = previews.want(file)) {
        if (place->size.x > 0 && texture.texture != 0) {
            const Thumbnail thumbnail = thumbnail_in(texture, *place);
            draw_fitting(thumbnail, corner, side);
            if (is_hovered) {
                ImGui::BeginTooltip();
                const ImVec2 large = ImGui::GetCursorScreenPos();
                ImGui::Dummy({4.0F * side, 4.0F * side});
                draw_fitting(thumbnail, large, 4.0F * side);
                ImGui::EndTooltip();
            }
        }
        size = place->size.x > 0 ? fmt::format("{} x {}", place->image_size.x, place->image_size.y)
                                 : "cannot be read";
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float x = corner.x + side + ImGui::GetStyle().ItemSpacing.x;
    list.AddText({x, corner.y + 0.2F * ImGui::GetFontSize()}, ImGui::GetColorU32(ImGuiCol_Text),
                 file.filename().string().c_str());
    list.AddText({x, corner.y + 1.3F * ImGui::GetFontSize()},
                 ImGui::GetColorU32(ImGuiCol_TextDisabled), size.c_str());
    return is_clicked;
}

}  // namespace

void FileDialog::open(BrowseRequest request) {
    listing_ = list_folder(request.folder, request.target.kind == BrowseTarget::Kind::input
                                               ? ListedFiles::all
                                               : ListedFiles::images);
    request_ = std::move(request);
    search_.clear();
}

/// Draws the path, the present image and the search.
void FileDialog::draw_head(Choice& choice) {
    std::string path = listing_.folder.string();
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::InputText("##path", &path, ImGuiInputTextFlags_EnterReturnsTrue)) {
        std::error_code none;
        const std::filesystem::path typed = pasted_path(path);
        (std::filesystem::is_directory(typed, none) ? choice.folder : choice.file) = typed;
    }
    probe_item("path");
    if (request_->present) {
        ImGui::TextDisabled("Now");
        ImGui::SameLine();
        if (request_->thumbnail) {
            const float side = preview_height * ImGui::GetFontSize();
            draw_fitting(*request_->thumbnail, ImGui::GetCursorScreenPos(), side);
            ImGui::Dummy({side, side});
            probe_item("present image");
            ImGui::SameLine();
        }
        ImGui::TextWrapped("%s",
                           std::filesystem::path(*request_->present).filename().string().c_str());
    }
    if (request_->target.kind == BrowseTarget::Kind::environment) {
        if (ImGui::Button("Use this folder")) choice.file = listing_.folder;
        probe_item("Use this folder");
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("A folder with the six images of a cube");
        ImGui::SameLine();
    }
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::InputTextWithHint("##names", "Search names", &search_);
    probe_item("search names");
    if (!listing_.error.empty()) ImGui::TextWrapped("%s", listing_.error.c_str());
}

void FileDialog::draw_list(const std::vector<std::string>& recent, ImagePreviews* previews,
                           const PictureExchange::Shown& texture, Choice& choice) {
    const auto draw_file = [&](const std::filesystem::path& file, const std::string& probe) {
        const bool is_clicked = previews != nullptr && is_image(file)
                                    ? draw_image_row(file, *previews, texture)
                                    : ImGui::Selectable(file.filename().string().c_str());
        if (is_clicked) choice.file = file;
        probe_item(probe + file.filename().string());
    };
    const auto is_kept = [&](const std::filesystem::path& file) {
        return matches_search(search_, {file.filename().string()});
    };
    for (const std::filesystem::path& inner : listing_.folders) {
        const std::string name = inner.filename().string() + "/";
        const bool is_parent = inner == listing_.folder.parent_path();
        if (!is_parent && !is_kept(inner)) continue;
        if (ImGui::Selectable(is_parent ? "../" : name.c_str())) choice.folder = inner;
        probe_item(is_parent ? "../" : name);
    }
    for (const std::filesystem::path& file : listing_.files) {
        if (is_kept(file)) draw_file(file, "");
    }
    if (recent.empty()) return;
    ImGui::Separator();
    ImGui::TextDisabled("Used recently");
    ImGui::PushID("recent");
    for (const std::string& file : recent) {
        if (is_kept(file)) draw_file(file, "recent file ");
    }
    ImGui::PopID();
}

std::optional<BrowseResult> FileDialog::draw(const std::vector<std::string>& recent,
                                             ImagePreviews* previews,
                                             const PictureExchange::Shown& texture) {
    if (!request_) return std::nullopt;
    const std::string title = request_->title + "###browser";
    if (!ImGui::IsPopupOpen(title.c_str())) ImGui::OpenPopup(title.c_str());
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float letter = ImGui::GetFontSize();
    ImGui::SetNextWindowPos({0.5F * screen.x, 0.5F * screen.y}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSize(
        {std::min(0.96F * screen.x, std::max(0.6F * screen.x, 34.0F * letter)),
         std::min(0.94F * screen.y, std::max(0.8F * screen.y, 30.0F * letter))});
    if (!ImGui::BeginPopupModal(title.c_str(), nullptr,
                                ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove))
        return std::nullopt;
    Choice choice;
    draw_head(choice);
    ImGui::BeginChild("files", {0.0F, -1.5F * ImGui::GetFrameHeightWithSpacing()}, true);
    draw_list(recent, previews, texture, choice);
    ImGui::EndChild();
    choice.is_cancelled =
        ImGui::Button("Cancel##dialog") ||
        (!ImGui::IsAnyItemActive() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)));
    probe_item("Cancel the dialog");
    if (choice.folder)
        listing_ = list_folder(*choice.folder, request_->target.kind == BrowseTarget::Kind::input
                                                   ? ListedFiles::all
                                                   : ListedFiles::images);
    std::optional<BrowseResult> result;
    if (choice.file) result = BrowseResult{request_->target, *choice.file};
    if (result || choice.is_cancelled) {
        request_.reset();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    return result;
}

}  // namespace relief::tools
