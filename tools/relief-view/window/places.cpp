// SPDX-License-Identifier: Apache-2.0
// One list for the process, as Dear ImGui has one context. Tests:
// tests/tools/window/window_test.cpp.
#include "window/places.h"

#include <imgui.h>

#include <cmath>

namespace relief::tools {
namespace {

struct Places {
    bool is_wanted = false;
    nlohmann::ordered_json marked = nlohmann::ordered_json::object();
};

Places& places() {
    static Places all;
    return all;
}

}  // namespace

void keep_places() {
    places().is_wanted = true;
}

void forget_places() {
    places().marked = nlohmann::ordered_json::object();
}

void mark_place(const std::string& name) {
    if (!places().is_wanted || !ImGui::IsItemVisible()) return;
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    places().marked[name] = {std::round(0.5F * (min.x + max.x)),
                             std::round(0.5F * (min.y + max.y))};
}

nlohmann::ordered_json places_json() {
    return places().marked;
}

}  // namespace relief::tools
