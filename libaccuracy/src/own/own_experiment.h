// SPDX-License-Identifier: Apache-2.0
/// \file
/// What own experiments have in common: how they begin, and how they end with a recommendation.
/// Tests: tests/accuracy/own_mesh_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measured_methods.h"
#include "relief/accuracy/own.h"

namespace relief {

/// Nobody sees less; and nothing is worth a byte for it.
inline constexpr double unseen_degrees = 0.01;

/// A method and what does it.
struct OwnMethod {
    MeasuredMethod measured;
    std::string command{};
    std::optional<Timing> known_time{};  ///< On all threads, taken elsewhere.
    double natural_cost = 0.0;           ///< RecommendationRule::natural_costs.
};

/// How one of the methods is recommended.
struct OwnRule {
    CostKind cost = CostKind::time;
    double unseen_error = 0.0;  ///< Degrees; RecommendationRule::unseen_error.
    std::string reference{};    ///< What Experiment::reference_error is the error of.
};

/// An experiment about the file: id "own/FILE/TOPIC", title "TITLE of FILE", unit degrees.
OwnExperiment own_experiment(Subject subject, const std::string& topic, const std::string& title,
                             const OwnOptions& options);

/// Times the methods, and recommends one of those that have a command; that becomes the finding.
/// Experiment::reference_error must have its value before.
void finish(OwnExperiment& own, std::vector<OwnMethod> methods, const OwnRule& rule,
            const OwnOptions& options);

/// The finding is the recommendation, with the command that does it.
void tell_finding(OwnExperiment& own);

/// Eight runs of triangles, evenly spread, that have `most` together; the mesh itself if it has no
/// more.
Mesh part_to_measure(const Mesh& mesh, std::size_t most);

}  // namespace relief
