// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks that apply to every experiment, and functions that look up experiments and methods.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/asset.h"

namespace relief::test {

inline accuracy::RunOptions quick_untimed() {
    accuracy::RunOptions options;
    options.is_quick = true;
    options.is_timed = false;
    return options;
}

/// Runs one experiment by its id, whose first part is the subject.
inline accuracy::Experiment run_one(const std::string& id,
                                    accuracy::RunOptions options = quick_untimed()) {
    options.selects_experiment = [&](const std::string& one) { return one == id; };
    const std::array subjects = {accuracy::subject_from(id.substr(0, id.find('/')))};
    std::vector<accuracy::Experiment> all = accuracy::run_experiments(subjects, options);
    if (all.size() != 1) throw std::runtime_error("no experiment " + id);
    return std::move(all.front());
}

/// Options for an asset report of a file, without times.
inline accuracy::AssetOptions untimed_asset(const std::string& file) {
    accuracy::AssetOptions options;
    options.run.is_timed = false;
    options.file = options.arguments = file;
    return options;
}

inline const accuracy::Measurement& measurement_of(const accuracy::Experiment& experiment,
                                                   const std::string& method) {
    for (const accuracy::Measurement& one : experiment.measurements) {
        if (one.method == method) return one;
    }
    throw std::runtime_error(experiment.id + " has no method " + method);
}

inline void expect_sound(const ErrorStats& error) {
    EXPECT_GT(error.count, 0U);
    EXPECT_EQ(error.undefined, 0U);
    EXPECT_TRUE(std::isfinite(error.rms));
    EXPECT_LE(error.mean, error.rms * (1.0 + 1e-6));
    EXPECT_LE(error.rms, error.max * (1.0 + 1e-6));
    EXPECT_LE(error.p99, error.max);
}

/// Checks what reports rely on: texts, unique names, and plausible numbers.
inline void expect_whole(const std::vector<accuracy::Experiment>& all, accuracy::Subject subject) {
    std::set<std::string> ids;
    for (const accuracy::Experiment& one : all) {
        SCOPED_TRACE(one.id);
        EXPECT_TRUE(ids.insert(one.id).second);
        EXPECT_EQ(one.subject, subject);
        for (const std::string& text : {one.title, one.question, one.ground_truth, one.input,
                                        one.error_unit, one.item, one.finding})
            EXPECT_FALSE(text.empty());
        EXPECT_EQ(one.question.back(), '?');
        // Findings do not mention times that were not measured.
        EXPECT_EQ(one.finding.find("not timed"), std::string::npos) << one.finding;
        EXPECT_GT(one.items, 0.0);
        EXPECT_FALSE(one.measurements.empty());
        std::set<std::string> methods;
        for (const accuracy::Measurement& measurement : one.measurements) {
            SCOPED_TRACE(measurement.method);
            EXPECT_TRUE(methods.insert(measurement.method).second);
            EXPECT_FALSE(measurement.choices.empty());
            expect_sound(measurement.error);
            EXPECT_FALSE(measurement.cost.one_thread || measurement.cost.all_threads);
        }
        for (const accuracy::Chart& chart : one.charts) {
            for (const accuracy::Curve& curve : chart.curves) {
                EXPECT_GE(curve.points.size(), 2U);
                for (std::size_t i = 1; i < curve.points.size(); ++i)
                    EXPECT_GT(curve.points[i].x, curve.points[i - 1].x);
            }
        }
    }
}

inline const accuracy::Measurement& found(const accuracy::AssetExperiment& own,
                                          const std::string& method) {
    return measurement_of(own.experiment, method);
}

}  // namespace relief::test
