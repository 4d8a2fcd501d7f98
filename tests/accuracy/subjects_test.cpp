// SPDX-License-Identifier: Apache-2.0
// Words for subjects, and what is run for them.
#include "relief/accuracy/subjects.h"

#include <gtest/gtest.h>

#include "relief/mesh/error.h"

namespace relief {
namespace {

TEST(Subjects, HaveWordsThatLeadBackToThem) {
    for (const Subject subject : subjects_with_experiments())
        EXPECT_EQ(subject_from(word_of(subject)), subject);
    EXPECT_EQ(word_of(Subject::stability), "stability");
    EXPECT_THROW(subject_from("colour"), InvalidInput);
}

TEST(Subjects, ThatDrawAreKnown) {
    EXPECT_TRUE(is_drawn(Subject::shading));
    EXPECT_TRUE(is_drawn(Subject::tangents));
    EXPECT_FALSE(is_drawn(Subject::bump));
}

}  // namespace
}  // namespace relief
