// SPDX-License-Identifier: Apache-2.0
#include "window/bindings.h"

#include <gtest/gtest.h>

#include <set>

namespace relief::tools {
namespace {

TEST(Bindings, NoKeyDoesTwoThings) {
    std::set<std::string_view> keys;
    for (const Binding& binding : bindings())
        EXPECT_TRUE(keys.insert(binding.key).second) << binding.key;
}

TEST(Bindings, EveryActionHasAKey) {
    std::set<Action> actions;
    for (const Binding& binding : bindings())
        actions.insert(binding.action);
    EXPECT_EQ(actions.size(), static_cast<std::size_t>(Action::quit) + 1);
}

TEST(Bindings, AreListedALineEach) {
    const std::string text = bindings_text();
    const auto lines = std::count(text.begin(), text.end(), '\n');
    EXPECT_EQ(static_cast<std::size_t>(lines), bindings().size() + gestures().size());
    EXPECT_EQ(text.substr(0, text.find('\n')),
              "F                               Show all of the model");
}

}  // namespace
}  // namespace relief::tools
