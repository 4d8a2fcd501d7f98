// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/shading_experiments_test.cpp, drawn_frames_experiment_test.cpp.
#include "drawn/refined_torus.h"

#include <fmt/format.h>

#include "drawn/lit_scene.h"
#include "measured_methods.h"
#include "relief/mesh/shapes.h"

namespace relief {

std::size_t torus_triangles(int slices) {
    return static_cast<std::size_t>(slices) * static_cast<std::size_t>(slices);
}

std::string name_on_torus(const std::string& way, int slices) {
    return fmt::format("{}, {} triangles", way, torus_triangles(slices));
}

Camera torus_camera() {
    return *lit_scene(make_torus(), {}).camera;
}

Chart torus_chart(const Experiment& experiment, std::span<const std::string> ways,
                  std::span<const int> slices) {
    Chart chart{.id = "triangles",
                .title = "Error by triangles",
                .x_label = "triangles",
                .y_label = experiment.error_unit};
    for (const std::string& way : ways) {
        Curve curve{.method = way};
        for (const int around : slices) {
            curve.points.push_back({static_cast<double>(torus_triangles(around)),
                                    method_in(experiment, name_on_torus(way, around)).error.rms});
        }
        curve.order = fitted_order(curve.points);
        chart.curves.push_back(std::move(curve));
    }
    return chart;
}

}  // namespace relief
