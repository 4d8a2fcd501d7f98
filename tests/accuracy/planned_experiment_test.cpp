// SPDX-License-Identifier: Apache-2.0
// Plans are run in order, and told.
#include "planned_experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace relief {
namespace {

PlannedExperiment planned(const std::string& name) {
    return {"Title of " + name, [name] {
                Experiment experiment;
                experiment.id = name;
                return experiment;
            }};
}

TEST(RunPlanned, TellsOfEachBeforeItAndGivesItsTitle) {
    std::vector<std::string> told;
    RunOptions options;
    options.tell = [&](const std::string& title, std::size_t done, std::size_t total) {
        told.push_back(title + " " + std::to_string(done) + "/" + std::to_string(total));
    };
    const std::vector<PlannedExperiment> plan = {planned("a"), planned("b")};
    const std::vector<Experiment> found = run_planned(plan, options);
    EXPECT_THAT(told, testing::ElementsAre("Title of a 0/2", "Title of b 1/2"));
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].id, "a");
    EXPECT_EQ(found[1].title, "Title of b");
}

TEST(RunPlanned, EndsWhereTheTellerThrows) {
    RunOptions options;
    options.tell = [](const std::string&, std::size_t done, std::size_t) {
        if (done == 1) throw std::runtime_error("enough");
    };
    std::size_t runs = 0;
    const PlannedExperiment counted{"x", [&] { return ++runs, Experiment{}; }};
    const std::vector<PlannedExperiment> plan = {counted, counted};
    EXPECT_THROW(run_planned(plan, options), std::runtime_error);
    EXPECT_EQ(runs, 1U);
}

}  // namespace
}  // namespace relief
