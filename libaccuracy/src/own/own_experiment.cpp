// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/own_mesh_test.cpp.
#include "own/own_experiment.h"

#include <fmt/format.h>

#include <cstdint>

#include "progress_stage.h"
#include "relief/mesh/mesh_part.h"

namespace relief {

OwnExperiment own_experiment(Subject subject, const std::string& topic, const std::string& title,
                             const OwnOptions& options) {
    check_cancelled();
    OwnExperiment own;
    Experiment& experiment = own.experiment;
    experiment.id = "own/" + (options.file.empty() ? topic : options.file + "/" + topic);
    experiment.subject = subject;
    experiment.title = options.file.empty() ? title : fmt::format("{} of {}", title, options.file);
    experiment.error_unit = "degrees";
    experiment.command = options.command;
    if (options.run.tell) options.run.tell(experiment.title, 0, 1);
    return own;
}

void tell_finding(OwnExperiment& own) {
    own.experiment.finding = own.recommendation.words + ".";
    if (!own.command().empty()) own.experiment.finding += " To do it: " + own.command();
}

void finish(OwnExperiment& own, std::vector<OwnMethod> methods, const OwnRule& rule,
            const OwnOptions& options) {
    const ProgressStage stage("measuring");
    std::vector<MeasuredMethod> measured;
    std::vector<unsigned char> choosable;
    std::vector<double> natural_costs;
    for (OwnMethod& method : methods) {
        measured.push_back(std::move(method.measured));
        choosable.push_back(method.command.empty() ? 0 : 1);
        natural_costs.push_back(method.natural_cost);
        own.commands.push_back(std::move(method.command));
    }
    measure_methods(measured, options.run, options.costs, own.experiment);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        Measurement& one = own.experiment.measurements[i];
        if (methods[i].known_time) one.cost.all_threads = methods[i].known_time;
        if (own.experiment.reference_error && one.error.count > 0)
            one.expected = ExpectedError{*own.experiment.reference_error, one.error.rms};
    }
    mark_efficient(own.experiment);
    own.recommendation = recommended(own.experiment, {options.wish, rule.cost, rule.unseen_error,
                                                      choosable, natural_costs, rule.reference});
    tell_finding(own);
}

Mesh part_to_measure(const Mesh& mesh, std::size_t most) {
    const std::size_t count = mesh.triangles.size();
    if (count <= most) return mesh;
    constexpr std::size_t runs = 8;
    const std::size_t length = std::max<std::size_t>(most / runs, 1);
    std::vector<std::uint32_t> triangles;
    for (std::size_t run = 0; run < runs; ++run) {
        const std::size_t first = run * (count - length) / (runs - 1);
        for (std::size_t t = first; t < first + length; ++t)
            triangles.push_back(static_cast<std::uint32_t>(t));
    }
    return part_of(mesh, triangles);
}

}  // namespace relief
