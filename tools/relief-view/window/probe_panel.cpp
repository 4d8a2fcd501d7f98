// SPDX-License-Identifier: Apache-2.0
#include "window/probe_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "window/controls.h"
#include "window/probe_figure.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Returns the term view that a picture shows, or the picture.
DebugView explained_view(DebugView view) {
    return is_term(view) ? view : DebugView::picture;
}

}  // namespace

// Explaining

void ProbePanel::toggle() {
    is_on_ = !is_on_;
    pinned_.reset();
    started_.reset();
    drawn_.reset();
    is_drawing_wanted_ = false;
    if (!is_on_) {
        job_.cancel();
        result_.reset();
        prepared_.reset();
    }
}

void ProbePanel::click(const glm::ivec2& pixel) {
    if (!is_on_) return;
    if (pinned_) {
        pinned_.reset();
        drawn_.reset();
    } else {
        pinned_ = pixel;
        started_.reset();
    }
}

/// Returns whether two requests show the same picture.
bool ProbePanel::is_same(const DrawRequest& a, const DrawRequest& b) {
    return a.revision == b.revision && a.pose == b.pose && a.camera == b.camera &&
           a.settings.width == b.settings.width && a.settings.height == b.settings.height &&
           a.settings.view == b.settings.view;
}

ProbePanel::Result ProbePanel::explain(std::shared_ptr<const Prepared> prepared,
                                       const DrawRequest& request, const glm::ivec2& pixel) {
    Result result;
    try {
        const FrameSettings& settings = request.settings;
        if (!prepared || !is_same(prepared->request, request)) {
            auto renewed = std::make_shared<Prepared>();
            renewed->request = request;
            renewed->scene = *request.scene;
            renewed->scene.camera = request.camera;
            renewed->prober = std::make_unique<Prober>(
                renewed->scene, ReferenceSettings{settings.width, settings.height});
            prepared = std::move(renewed);
        }
        const Probe probe = prepared->prober->at(pixel.x, pixel.y, explained_view(settings.view));
        result.pixel = reference_values(probe, prepared->scene);
        result.prepared = std::move(prepared);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        result.error = error.what();
    }
    return result;
}

DrawTask ProbePanel::drawing_of(const DrawRequest& request, const glm::ivec2& pixel) {
    drawn_ = std::make_shared<Drawn>();
    return [request, pixel, drawn = drawn_](const Context& context, RenderCache& cache) {
        PixelValues values;
        const auto draw = [&](OutputCoding output) {
            FrameSettings settings = request.settings;
            settings.samples = 1;
            settings.output = output;
            settings.overlays = {};
            settings.view = explained_view(settings.view);
            Report same;
            Renderer renderer(
                cache, context, *request.scene,
                plan_view(*request.scene, settings,
                          forced_plan(*request.scene, settings, request.effects), same),
                settings, same);
            return pixel_of(renderer.draw(request.camera).image, pixel);
        };
        bool is_drawn = true;
        try {
            values = {draw(OutputCoding::linear), draw(OutputCoding::srgb)};
        } catch (const std::exception&) {
            is_drawn = false;  // The picture reports the error.
        }
        const std::lock_guard lock(drawn->mutex);
        drawn->has_ended = true;
        if (is_drawn) drawn->values = values;
        return false;
    };
}

void ProbePanel::take_results() {
    if (std::optional<Result> found = job_.take()) {
        if (found->prepared) prepared_ = found->prepared;
        result_ = std::move(*found);
    }
    if (!drawn_ || !result_) return;
    const std::lock_guard lock(drawn_->mutex);
    if (drawn_->values) result_->pixel.shader = drawn_->values;
}

std::optional<DrawTask> ProbePanel::follow(const std::optional<DrawRequest>& request,
                                           const std::optional<glm::ivec2>& pointer) {
    if (!is_on_) return std::nullopt;
    take_results();
    const std::optional<glm::ivec2> pixel = pinned_ ? pinned_ : pointer;
    if (!request || !pixel || job_.is_running()) return std::nullopt;
    const bool is_inside = pixel->x >= 0 && pixel->y >= 0 && pixel->x < request->settings.width &&
                           pixel->y < request->settings.height;
    if (!is_inside) return std::nullopt;
    if (started_ == pixel && request_ && is_same(*request_, *request)) return std::nullopt;
    started_ = pixel;
    request_ = request;
    job_.start([prepared = prepared_, wanted = *request, place = *pixel](const Progress&) {
        return explain(prepared, wanted, place);
    });
    if (!pinned_) {
        drawn_.reset();
        return std::nullopt;
    }
    return drawing_of(*request, *pixel);
}

bool ProbePanel::is_working() const {
    if (job_.is_running()) return true;
    if (!drawn_) return false;
    const std::lock_guard lock(drawn_->mutex);
    return !drawn_->has_ended || (result_ && drawn_->values && !result_->pixel.shader);
}

nlohmann::ordered_json ProbePanel::json() const {
    const auto pixel_json = [](const std::optional<glm::ivec2>& pixel) {
        return pixel ? nlohmann::ordered_json{pixel->x, pixel->y} : nullptr;
    };
    const bool has_probe = result_ && result_->prepared;
    return {{"on", is_on_},
            {"pinned", pixel_json(pinned_)},
            {"pixel", pixel_json(started_)},
            {"error", result_ ? result_->error : ""},
            {"probe", has_probe ? probe_json(result_->pixel, result_->prepared->scene) : Json()}};
}

// Drawing

namespace {

ImU32 color_code(const glm::vec3& color, float alpha) {
    return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, alpha});
}

ImVec2 imgui_point(const glm::vec2& v) {
    return {v.x, v.y};
}

void draw_arrow(ImDrawList& list, const glm::vec2& from, const glm::vec2& to, ImU32 color) {
    constexpr float width = 2.5F;
    constexpr float head = 9.0F;
    constexpr ImU32 outline = IM_COL32(0, 0, 0, 160);
    const float length = glm::distance(from, to);
    list.AddLine(imgui_point(from), imgui_point(to), outline, width + 2.0F);
    list.AddLine(imgui_point(from), imgui_point(to), color, width);
    if (!(length > 1.0F)) return;
    const glm::vec2 along = (to - from) / length;
    const glm::vec2 across(-along.y, along.x);
    const float size = std::min(head, 0.4F * length);
    const glm::vec2 neck = to - size * along;
    list.AddTriangleFilled(imgui_point(to), imgui_point(neck + 0.5F * size * across),
                           imgui_point(neck - 0.5F * size * across), color);
}

void draw_figure(const ProbeFigure& figure, const WindowArea& picture) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto place = [&](const glm::vec2& share) {
        return picture.min + share * (picture.max - picture.min);
    };
    list.PushClipRect(imgui_point(picture.min), imgui_point(picture.max));
    for (const ProbeFacet& facet : figure.lobe) {
        const glm::vec3 color = glm::vec3(1.0F, 0.75F, 0.45F) * (0.4F + 0.6F * facet.shade);
        list.AddTriangleFilled(imgui_point(place(facet.corners[0])),
                               imgui_point(place(facet.corners[1])),
                               imgui_point(place(facet.corners[2])), color_code(color, 0.25F));
    }
    for (const ProbeArrow& arrow : figure.arrows)
        draw_arrow(list, place(arrow.from), place(arrow.to), color_code(arrow.color_srgb, 1.0F));
    for (const ProbeArrow& arrow : figure.arrows) {
        const glm::vec2 text = place(arrow.to) + glm::vec2(5.0F, -0.5F * ImGui::GetFontSize());
        const ImVec2 size = ImGui::CalcTextSize(arrow.label.c_str());
        list.AddRectFilled({text.x - 3.0F, text.y - 1.0F},
                           {text.x + size.x + 3.0F, text.y + size.y + 1.0F},
                           IM_COL32(20, 22, 26, 190));
        list.AddText(imgui_point(text), color_code(arrow.color_srgb, 1.0F), arrow.label.c_str());
    }
    list.PopClipRect();
}

/// Shows a small picture of the texture with the outline of the pixel in it.
void draw_footprint(const ProbeLookup& lookup, Thumbnails& images,
                    const PictureExchange::Shown& texture) {
    const std::optional<Thumbnails::Place> cell = images.place_of(lookup.image);
    if (!cell || texture.texture == 0) return;
    const glm::vec2 whole(texture.width, texture.height);
    const glm::vec2 from = glm::vec2(cell->min) / whole;
    const glm::vec2 to = glm::vec2(cell->min + cell->size) / whole;
    const glm::vec2 size(cell->size);
    // Row 0 of the texture is at the bottom.
    ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.texture)),
                 imgui_point(size), {from.x, 1.0F - from.y}, {to.x, 1.0F - to.y});
    const ImVec2 corner = ImGui::GetItemRectMin();
    const glm::vec2 origin(corner.x, corner.y);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const glm::vec2 middle = glm::vec2(lookup.texel / glm::dvec2(lookup.size));
    const glm::vec2 shift = glm::floor(middle);  // Textures repeat.
    std::vector<ImVec2> outline;
    for (const glm::vec2& point : footprint_outline(lookup))
        outline.push_back(imgui_point(origin + (point - shift) * size));
    list.PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
    constexpr ImU32 color = IM_COL32(255, 220, 60, 255);
    if (!outline.empty())
        list.AddPolyline(outline.data(), static_cast<int>(outline.size()), color,
                         ImDrawFlags_Closed, 1.5F);
    const glm::vec2 center = origin + (middle - shift) * size;
    list.AddLine({center.x - 6.0F, center.y}, {center.x + 6.0F, center.y}, color);
    list.AddLine({center.x, center.y - 6.0F}, {center.x, center.y + 6.0F}, color);
    list.PopClipRect();
}

std::string triple(const glm::dvec3& v) {
    return fmt::format("{:.3f} {:.3f} {:.3f}", v.x, v.y, v.z);
}

void draw_vectors(const ProbeLayer& layer) {
    constexpr ImGuiTableFlags flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg;
    if (layer.vectors.empty() || !ImGui::BeginTable("vectors", 5, flags)) return;
    for (const char* const title : {"", "object", "world", "camera", "tangent"})
        ImGui::TableSetupColumn(title);
    ImGui::TableHeadersRow();
    for (const ProbeVector& vector : layer.vectors) {
        std::string name(vector.symbol);
        if (vector.light) name += fmt::format("{}", *vector.light + 1);
        if (vector.corner) name += fmt::format(" at {}", *vector.corner + 1);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name.c_str());
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", std::string(probe_symbol(vector.symbol).meaning).c_str());
        const std::string tangent = vector.tangent ? triple(*vector.tangent) : "";
        for (const std::string& text :
             {triple(vector.object), triple(vector.world), triple(vector.camera), tangent}) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(text.c_str());
        }
    }
    ImGui::EndTable();
}

/// Draws the vectors of each surface as a table; other sections are lines, wrapped at a width.
void draw_sections(const ProbedPixel& pixel, const Scene& scene, float wrap_width,
                   Thumbnails* images, const PictureExchange::Shown& texture) {
    std::size_t layer = 0;
    for (const ProbeSection& section : probe_sections(pixel, scene)) {
        ImGui::TextDisabled("%s", section.label.c_str());
        if (section.label == "vectors") {
            ImGui::PushID(static_cast<int>(layer));
            while (layer < pixel.probe.layers.size() && pixel.probe.layers[layer].vectors.empty())
                ++layer;
            if (layer < pixel.probe.layers.size()) draw_vectors(pixel.probe.layers[layer]);
            ++layer;
            ImGui::PopID();
            continue;
        }
        ImGui::PushTextWrapPos(wrap_width);
        for (const std::string& line : section.lines)
            ImGui::TextUnformatted(line.c_str());
        ImGui::PopTextWrapPos();
        if (section.label != "textures" || images == nullptr || layer == 0) continue;
        images->want();
        bool is_first = true;
        for (const ProbeLookup& lookup : pixel.probe.layers[layer - 1].lookups) {
            if (!std::exchange(is_first, false)) ImGui::SameLine();
            draw_footprint(lookup, *images, texture);
        }
    }
}

}  // namespace

WindowArea ProbePanel::draw(const WindowArea& picture, Thumbnails* images,
                            const PictureExchange::Shown& image_texture) const {
    if (!is_on_) return {};
    const glm::vec2 size = picture.max - picture.min;
    if (result_ && result_->prepared) {
        const double aspect = static_cast<double>(size.x) / static_cast<double>(size.y);
        draw_figure(figure_of(result_->pixel.probe, *result_->prepared->scene.camera, aspect),
                    picture);
    }
    const float margin = ImGui::GetFontSize();
    const float width = std::min(44.0F * ImGui::GetFontSize(), 0.55F * size.x);
    ImGui::SetNextWindowPos({picture.max.x - width - margin, picture.min.y + margin});
    ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, size.y - 2.0F * margin});
    ImGui::SetNextWindowBgAlpha(0.92F);
    constexpr ImGuiWindowFlags flags =
        ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_HorizontalScrollbar |
        ImGuiWindowFlags_NoFocusOnAppearing;
    ImGui::Begin("Pixel", nullptr, flags);
    if (!result_) {
        ImGui::TextUnformatted("Point at a pixel. A click pins it.");
    } else if (!result_->error.empty()) {
        ImGui::TextWrapped("%s", result_->error.c_str());
    } else {
        ImGui::TextDisabled("%s", pinned_ ? "pinned; a click follows the pointer again"
                                          : "a click pins the pixel and draws its shader's value");
        draw_sections(result_->pixel, result_->prepared->scene,
                      width - ImGui::GetStyle().WindowPadding.x, images, image_texture);
    }
    const ImVec2 corner = ImGui::GetWindowPos();
    const ImVec2 extent = ImGui::GetWindowSize();
    ImGui::End();
    return {{corner.x, corner.y}, {corner.x + extent.x, corner.y + extent.y}};
}

}  // namespace relief::tools
