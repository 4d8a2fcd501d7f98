// SPDX-License-Identifier: Apache-2.0
#include "window/effects_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "common/text.h"
#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {
namespace {

/// The drawing thread checks for requests after this time, and the window updates the progress.
constexpr std::chrono::milliseconds step_time(100);

bool have_same_effects(const FramePlan& a, const FramePlan& b) {
    const auto same_features = [](const DrawPlan& one, const DrawPlan& other) {
        return one.features == other.features;
    };
    return effects_in(a) == effects_in(b) &&
           std::equal(a.draws.begin(), a.draws.end(), b.draws.begin(), b.draws.end(),
                      same_features);
}

}  // namespace

/// The part of a measurement that the drawing thread owns.
class EffectTimes::MeasurementTask {
  public:
    MeasurementTask(DrawRequest request, std::shared_ptr<Measurement> measurement)
        : request_(std::move(request)), measurement_(std::move(measurement)) {}

    /// Runs steps for at most step_time. \return whether there is more to do
    bool work(const Context& context, RenderCache& cache) {
        if (!measurement_->is_wanted) return false;
        bool has_more = false;
        std::string error;
        try {
            const auto end = std::chrono::steady_clock::now() + step_time;
            if (!pricing_) prepare(context, cache);
            do {
                has_more = pricing_->step();
            } while (has_more && measurement_->is_wanted && std::chrono::steady_clock::now() < end);
        } catch (const std::exception& failure) {
            has_more = false;
            error = failure.what();
        }
        const std::lock_guard lock(measurement_->mutex);
        State& state = measurement_->state;
        if (pricing_) state.costs = pricing_->costs();
        state.error = error;
        state.is_running = has_more;
        return has_more;
    }

  private:
    void prepare(const Context& context, RenderCache& cache) {
        FramePlan plan =
            force_effects(*request_.scene, request_.settings,
                          plan_effects(*request_.scene, request_.settings), request_.effects);
        const MeasuredFrame frame{.context = context,
                                  .scene = *request_.scene,
                                  .settings = request_.settings,
                                  .camera = request_.camera,
                                  .cache = &cache};
        pricing_ = std::make_unique<EffectCostMeasurement>(frame, plan);
        const std::lock_guard lock(measurement_->mutex);
        measurement_->plan = std::move(plan);
        measurement_->state.count = pricing_->count();
    }

    DrawRequest request_;
    std::shared_ptr<Measurement> measurement_;
    std::unique_ptr<EffectCostMeasurement> pricing_;
};

EffectTimes::State EffectTimes::state() const {
    if (!current_) return {};
    const std::lock_guard lock(current_->mutex);
    return current_->state;
}

DrawTask EffectTimes::start(const DrawRequest& request) {
    cancel();
    current_ = std::make_shared<Measurement>();
    State& state = current_->state;
    state.is_running = true;
    state.width = request.settings.width;
    state.height = request.settings.height;
    state.samples = request.settings.samples;
    DrawRequest picture = request;
    picture.settings.overlays = {};
    const auto measuring = std::make_shared<MeasurementTask>(std::move(picture), current_);
    return [measuring](const Context& context, RenderCache& cache) {
        return measuring->work(context, cache);
    };
}

void EffectTimes::cancel() {
    if (current_) current_->is_wanted = false;
    current_.reset();
}

void EffectTimes::discard_unless_valid_for(const FramePlan& plan, const DrawRequest& request) {
    if (!current_) return;
    bool holds = false;
    {
        const std::lock_guard lock(current_->mutex);
        const State& state = current_->state;
        const bool is_known = state.count > 0;
        holds = state.width == request.settings.width && state.height == request.settings.height &&
                state.samples == request.settings.samples &&
                (!is_known || have_same_effects(current_->plan, plan));
    }
    if (!holds) cancel();
}

std::optional<double> EffectTimes::milliseconds(const std::string& effect) const {
    const State now = state();
    const auto found = std::find_if(now.costs.effects.begin(), now.costs.effects.end(),
                                    [&](const EffectCost& cost) { return cost.effect == effect; });
    if (found == now.costs.effects.end()) return std::nullopt;
    return found->milliseconds;
}

nlohmann::ordered_json json_of(const EffectTimes::State& state) {
    if (state.width == 0) return nullptr;
    nlohmann::ordered_json effects = nlohmann::ordered_json::object();
    for (const EffectCost& cost : state.costs.effects)
        effects[cost.effect] = cost.milliseconds;
    return {{"going_on", state.is_running},
            {"done", state.costs.effects.size()},
            {"count", state.count},
            {"frame", state.costs.frame.median},
            {"size", {state.width, state.height}},
            {"samples", state.samples},
            {"effects", effects},
            {"error", state.error}};
}

std::string numbered_lines(const std::string& source) {
    const bool has_open_end = !source.empty() && source.back() != '\n';
    const auto count = std::count(source.begin(), source.end(), '\n') + (has_open_end ? 1 : 0);
    const std::size_t width = fmt::format("{}", count).size();
    std::istringstream lines(source);
    std::string text;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number)
        text += fmt::format("{:>{}}  {}\n", number, width, line);
    return text;
}

void ShaderPanel::assemble(const FramePlan& plan) {
    programs_.clear();
    error_.clear();
    try {
        for (ShaderListing& listing : shader_listings(plan)) {
            Program program{describe(listing.features), std::move(listing), "", ""};
            program.vertex = numbered_lines(program.listing.vertex);
            program.fragment = numbered_lines(program.listing.fragment);
            programs_.push_back(std::move(program));
        }
    } catch (const std::exception& error) {  // A file in RELIEF_SHADER_DIR may be incomplete.
        error_ = error.what();
    }
}

void ShaderPanel::draw_stage(const char* name, const std::string& source, std::string& numbered) {
    if (!ImGui::BeginTabItem(name)) return probe_item(name);
    probe_item(name);
    // The field is read-only, so the text does not change.
    ImGui::InputTextMultiline("##source", numbered.data(), numbered.size() + 1,
                              {-1.0F, 24.0F * ImGui::GetTextLineHeight()},
                              ImGuiInputTextFlags_ReadOnly);
    if (ImGui::Button("Copy without numbers")) ImGui::SetClipboardText(source.c_str());
    probe_item("Copy without numbers");
    ImGui::EndTabItem();
}

void ShaderPanel::draw(const std::shared_ptr<const FramePlan>& plan) {
    if (plan_ != plan) assemble(*plan);
    plan_ = plan;
    if (!error_.empty()) ImGui::TextWrapped("%s", error_.c_str());
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        Program& program = programs_[i];
        const bool is_open = ImGui::TreeNode(fmt::format("{}##{}", program.name, i).c_str());
        probe_item(fmt::format("Program {}", i + 1));
        if (!is_open) continue;
        if (ImGui::BeginTabBar("stages")) {
            draw_stage("Fragment shader", program.listing.fragment, program.fragment);
            draw_stage("Vertex shader", program.listing.vertex, program.vertex);
            ImGui::EndTabBar();
        }
        ImGui::TreePop();
    }
}

namespace {

/// 0: automatic, 1: forced on, 2: forced off.
int forced(const EffectRequest& requests, const std::string& name) {
    for (const ForcedEffect& effect : requests.forced) {
        if (effect.name == name) return effect.on ? 1 : 2;
    }
    return 0;
}

void draw_switch(ViewerState& state, const std::string& name) {
    int choice = forced(state.effects(), name);
    ImGui::PushID(name.c_str());
    ImGui::SetNextItemWidth(4.5F * ImGui::GetFontSize());
    if (ImGui::Combo("##forced", &choice, "auto\0on\0off\0")) {
        EffectRequest requests = state.effects();
        std::erase_if(requests.forced,
                      [&](const ForcedEffect& effect) { return effect.name == name; });
        if (choice != 0) requests.forced.push_back({name, choice == 1});
        state.set_effects(std::move(requests));
    }
    probe_item("force " + name);
    ImGui::PopID();
}

void draw_reasons(const PanelInput& input, const std::vector<EffectReason>& reasons) {
    for (const EffectReason& reason : reasons) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        draw_switch(input.state, reason.effect);
        // The times come before the names, because long names reach beyond the panel.
        ImGui::TableNextColumn();
        if (const std::optional<double> milliseconds =
                input.effect_times.milliseconds(reason.effect))
            ImGui::Text("%.2f ms", *milliseconds);
        ImGui::TableNextColumn();
        const ImVec4 color =
            ImGui::GetStyleColorVec4(reason.on ? ImGuiCol_Text : ImGuiCol_TextDisabled);
        ImGui::TextColored(color, "%s", reason.effect.c_str());
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", reason.reason.c_str());
    }
}

/// Draws the measured times, or a button that measures them.
void draw_effect_times(const PanelInput& input, PanelRequests& requests) {
    const EffectTimes::State effect_times = input.effect_times.state();
    if (effect_times.is_running) {
        const std::size_t done = effect_times.costs.effects.size();
        const std::string text = fmt::format("effect {} of {}", done + 1, effect_times.count);
        ImGui::ProgressBar(effect_times.count == 0
                               ? 0.0F
                               : static_cast<float>(done) / static_cast<float>(effect_times.count),
                           {0.5F * ImGui::GetContentRegionAvail().x, 0.0F}, text.c_str());
        ImGui::SameLine();
        if (ImGui::Button("Stop")) requests.stop_measuring = true;
        probe_item("Stop");
        return;
    }
    if (ImGui::Button("Measure times")) requests.measure_effects = true;
    probe_item("Measure times");
    if (!effect_times.error.empty()) return ImGui::TextWrapped("%s", effect_times.error.c_str());
    if (effect_times.costs.effects.empty())
        return ImGui::TextWrapped(
            "The time of an effect is the difference between a frame with it and a frame without "
            "it.");
    const TimeStatistics& frame = effect_times.costs.frame;
    ImGui::TextWrapped("Frame: %.2f ms (%.2f to %.2f), %d x %d pixels, %s", frame.median, frame.p10,
                       frame.p90, effect_times.width, effect_times.height,
                       counted(static_cast<std::size_t>(effect_times.samples), "sample").c_str());
}

}  // namespace

void draw_effects_panel(const PanelInput& input, PanelRequests& requests) {
    if (!input.drawn.plan) return;
    const FramePlan& plan = *input.drawn.plan;
    // Debug views do not draw the effects.
    if (input.state.debug().view == DebugView::picture) draw_effect_times(input, requests);
    const bool is_open = ImGui::TreeNode("Shaders");
    probe_item("Shaders");
    if (is_open) {
        input.shaders.draw(input.drawn.plan);
        ImGui::TreePop();
    }
    if (ImGui::BeginTable("effects", 3, ImGuiTableFlags_SizingFixedFit)) {
        draw_reasons(input, plan.reasons);
        if (!plan.draws.empty()) draw_reasons(input, plan.draws.front().reasons);
        ImGui::EndTable();
    }
}

}  // namespace relief::tools
