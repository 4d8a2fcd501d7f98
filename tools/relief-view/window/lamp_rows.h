// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lamps as the window lists them: which is which whatever becomes of it, and how fast each goes
/// round the model by itself. Neither a window nor OpenGL.
/// Tests: tests/tools/window/lamp_rows_test.cpp.
#pragma once

#include <vector>

#include "window/lamps.h"

namespace relief::tools {

/// A lamp, and what the window knows of it beside the scene.
struct LampRow {
    Lamp lamp;
    unsigned id = 0;     ///< The same for as long as the lamp is there; 0: not yet given.
    float speed = 0.0F;  ///< Radians a second about the vertical through the model's middle.
};

class LampRows {
  public:
    /// Another scene, or other lamps in it: as many of a kind as there were are taken for the same.
    void meet(const Scene& scene);

    /// Of the scene that was met last.
    [[nodiscard]] std::vector<LampRow> rows(const Scene& scene) const;

    /// Takes the place of the scene's lamps, sorted by kind; what is new gets its number.
    void set(Scene& scene, std::vector<LampRow> rows);

    /// Whether any lamp moves by itself.
    [[nodiscard]] bool is_moving() const;

    /// Lets time pass for the lamps that do.
    void pass(Scene& scene, double seconds, const glm::vec3& center) const;

  private:
    struct Known {
        LampKind kind;
        unsigned id;
        float speed;
    };

    std::vector<Known> known_;  ///< As the lamps are sorted.
    unsigned given_ = 0;
};

}  // namespace relief::tools
