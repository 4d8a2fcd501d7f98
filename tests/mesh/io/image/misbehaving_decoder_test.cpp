// SPDX-License-Identifier: Apache-2.0
// A decoder that a file has taken over (misbehaving_module.cpp): each misbehavior ends in a defined
// result, the program survives it in little time, and the next image is right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "io/image/decoder_process.h"
#include "io/image/image_module.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::message_of;

constexpr const char* wrong = "its decoder sent a wrong answer";
constexpr const char* late = "decoding it takes too long";
constexpr const char* refused = "Operation not permitted";

struct Misbehavior {
    const char* name;
    const char* error;  ///< A part of the message; empty if the image is read.
};

std::ostream& operator<<(std::ostream& out, const Misbehavior& one) {
    return out << one.name;
}

class MisbehavingDecoder : public testing::TestWithParam<Misbehavior> {
  protected:
    void SetUp() override {
        for (const char* file : {RELIEF_TESTED_DECODER, RELIEF_MISBEHAVING_MODULE}) {
            std::filesystem::copy_file(file, folder_ / std::filesystem::path(file).filename());
        }
        if (const char* before = std::getenv("RELIEF_MODULE_DIR")) before_ = before;
        ::setenv("RELIEF_MODULE_DIR", folder_.path().c_str(), 1);
        max_decoder_milliseconds = 300;
    }
    void TearDown() override {
        max_decoder_milliseconds = 0;
        if (before_)
            ::setenv("RELIEF_MODULE_DIR", before_->c_str(), 1);
        else
            ::unsetenv("RELIEF_MODULE_DIR");
    }

    /// Returns the only texel.
    int read(const std::string& behavior) const {
        std::ofstream(folder_ / "image.psd", std::ios::binary) << "8BPS:" << behavior;
        const Image image = read_image(folder_ / "image.psd", ImageUse::data);
        return image.as<std::uint8_t>()[0];
    }

    test::TemporaryDirectory folder_;
    std::optional<std::string> before_;
};

TEST_LABELS(alone);
TEST_LABELS_OF("ForbiddenCalls/*", not_sanitized);
TEST_LABELS_OF("Faults/*", not_sanitized);
TEST_P(MisbehavingDecoder, EndsInADefinedResult) {
    const auto begin = std::chrono::steady_clock::now();
    const std::string error = GetParam().error;
    if (error.empty()) {
        EXPECT_EQ(read(GetParam().name), 9);
    } else {
        EXPECT_THAT(message_of<FileError>([&] { read(GetParam().name); }),
                    testing::AllOf(testing::StartsWith((folder_ / "image.psd").string() + ": "),
                                   testing::HasSubstr(error)));
    }
    EXPECT_EQ(read("nothing"), 9);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

INSTANTIATE_TEST_SUITE_P(
    ForbiddenCalls, MisbehavingDecoder,
    testing::Values(Misbehavior{"open a file", refused}, Misbehavior{"create a file", refused},
                    Misbehavior{"open a socket", refused},
                    Misbehavior{"send a descriptor", refused}, Misbehavior{"signal all", refused},
                    Misbehavior{"trace", refused},
                    Misbehavior{"choose the receiver of signals", refused},
                    Misbehavior{"choose the signal", refused},
                    Misbehavior{"ask for signals", refused},
                    Misbehavior{"lift the limit of memory", refused},
                    Misbehavior{"lift the limit of time", refused},
                    Misbehavior{"lift a limit by the old call", refused},
                    Misbehavior{"start a thread", refused}, Misbehavior{"start a process", refused},
                    Misbehavior{"start a process by the new call", refused},
                    Misbehavior{"start a program", refused}));

INSTANTIATE_TEST_SUITE_P(
    FalseReplies, MisbehavingDecoder,
    testing::Values(Misbehavior{"huge size", wrong}, Misbehavior{"negative width", wrong},
                    Misbehavior{"width that wraps", wrong}, Misbehavior{"height that wraps", wrong},
                    Misbehavior{"channels that wrap", wrong}, Misbehavior{"unknown bits", wrong},
                    Misbehavior{"no texels", "is empty: 0 x 0 texels"},
                    Misbehavior{"no rows at once", wrong},
                    Misbehavior{"rows at once that wrap", wrong}, Misbehavior{"much text", wrong},
                    Misbehavior{"announce much text", wrong},
                    Misbehavior{"announce a long reason", wrong},
                    Misbehavior{"succeed twice", wrong}, Misbehavior{"send noise", wrong},
                    Misbehavior{"send half", "its decoder ended without an answer"},
                    Misbehavior{"too many samples", wrong}, Misbehavior{"too few samples", wrong},
                    Misbehavior{"answer twice", ""}));

INSTANTIATE_TEST_SUITE_P(
    Faults, MisbehavingDecoder,
    testing::Values(Misbehavior{"crash", "its decoder crashed (Segmentation fault)"},
                    Misbehavior{"abort", "its decoder crashed (Aborted)"},
                    Misbehavior{"exit", "its decoder ended without an answer"},
                    Misbehavior{"be silent", late}, Misbehavior{"drip", late},
                    Misbehavior{"compute", late},
                    Misbehavior{"allocate", "takes more memory than is permitted"},
                    Misbehavior{"grow the image", "its decoder crashed (File size limit exceeded)"},
                    Misbehavior{"crash in a row", "its decoder crashed (Segmentation fault)"},
                    Misbehavior{"be silent in a row", late},
                    Misbehavior{"be silent at the end", ""}, Misbehavior{"crash at the end", ""}));

}  // namespace
}  // namespace relief
