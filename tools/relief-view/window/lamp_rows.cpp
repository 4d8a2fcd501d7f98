// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/lamp_rows_test.cpp.
#include "window/lamp_rows.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

namespace relief::tools {

void LampRows::meet(const Scene& scene) {
    std::vector<Known> now;
    for (const Lamp& lamp : lamps_of(scene)) {
        const LampKind kind = kind_of(lamp);
        const auto same = std::find_if(known_.begin(), known_.end(),
                                       [&](const Known& known) { return known.kind == kind; });
        if (same == known_.end()) {
            now.push_back({kind, ++given_, 0.0F});
        } else {
            now.push_back(*same);
            known_.erase(same);
        }
    }
    known_ = std::move(now);
}

std::vector<LampRow> LampRows::rows(const Scene& scene) const {
    const std::vector<Lamp> lamps = lamps_of(scene);
    std::vector<LampRow> rows;
    for (std::size_t i = 0; i < std::min(lamps.size(), known_.size()); ++i)
        rows.push_back({lamps[i], known_[i].id, known_[i].speed});
    return rows;
}

void LampRows::set(Scene& scene, std::vector<LampRow> rows) {
    std::stable_sort(rows.begin(), rows.end(), [](const LampRow& a, const LampRow& b) {
        return kind_of(a.lamp) < kind_of(b.lamp);
    });
    known_.clear();
    std::vector<Lamp> lamps;
    for (const LampRow& row : rows) {
        known_.push_back({kind_of(row.lamp), row.id != 0 ? row.id : ++given_, row.speed});
        lamps.push_back(row.lamp);
    }
    set_lamps(scene, lamps);
}

bool LampRows::is_moving() const {
    return std::any_of(known_.begin(), known_.end(),
                       [](const Known& known) { return known.speed != 0.0F; });
}

void LampRows::pass(Scene& scene, double seconds, const glm::vec3& center) const {
    std::vector<LampRow> moved = rows(scene);
    std::vector<Lamp> lamps;
    for (LampRow& row : moved) {
        const float angle = row.speed * static_cast<float>(seconds);
        if (angle != 0.0F) {
            const glm::mat4 rotation = glm::rotate(glm::mat4(1.0F), angle, {0.0F, 1.0F, 0.0F});
            turn(row.lamp, glm::mat3(rotation), center);
        }
        lamps.push_back(row.lamp);
    }
    set_lamps(scene, lamps);
}

}  // namespace relief::tools
