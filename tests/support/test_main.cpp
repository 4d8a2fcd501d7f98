// SPDX-License-Identifier: Apache-2.0
// The main function of every test program. Many cases share a process, so each begins with the
// state of a fresh process. A case that changes the environment, the working directory or a signal
// and does not restore it fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cfenv>
#include <clocale>
#include <csignal>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "relief/mesh/execution.h"

namespace relief::test {
namespace {

/// Name and value of each part of the state that a case must restore.
using ProcessState = std::map<std::string, std::string>;

ProcessState process_state() {
    ProcessState state;
    for (char** variable = environ; variable != nullptr && *variable != nullptr; ++variable) {
        const std::string text = *variable;
        const std::size_t equals = text.find('=');
        state["environment variable " + text.substr(0, equals)] =
            equals == std::string::npos ? "" : text.substr(equals + 1);
    }
    std::error_code error;
    state["working directory"] = std::filesystem::current_path(error).string();
    state["locale"] = std::setlocale(LC_ALL, nullptr);
    state["rounding mode"] = std::to_string(std::fegetround());
    const mode_t mask = ::umask(0);
    ::umask(mask);
    state["file mode mask"] = std::to_string(mask);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ, SIGCHLD}) {
        struct sigaction now {};
        ::sigaction(signal, nullptr, &now);
        state["action of signal " + std::to_string(signal)] = now.sa_handler == SIG_DFL ? "default"
                                                              : now.sa_handler == SIG_IGN
                                                                  ? "ignored"
                                                                  : "handled";
    }
    const std::array limits = {
        std::pair(RLIMIT_FSIZE, "file size"), std::pair(RLIMIT_AS, "address space"),
        std::pair(RLIMIT_NOFILE, "open files"), std::pair(RLIMIT_CORE, "core size")};
    for (const auto& [which, name] : limits) {
        rlimit limit{};
        ::getrlimit(which, &limit);
        state[std::string("limit of ") + name] = std::to_string(limit.rlim_cur);
    }
    return state;
}

/// The processor time of this process and of its ended children, in milliseconds.
long processor_milliseconds() {
    long sum = 0;
    for (const int whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        ::getrusage(whose, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime})
            sum += time.tv_sec * 1000 + time.tv_usec / 1000;
    }
    return sum;
}

/// Also records the processor time of each case, which scripts/dev/run-tests reports.
class RestoredState : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo&) override {  // NOLINT(readability-identifier-naming)
        set_thread_limit(0);
        before_ = process_state();
        processor_begin_ = processor_milliseconds();
    }
    void OnTestEnd(const testing::TestInfo&) override {  // NOLINT(readability-identifier-naming)
        testing::Test::RecordProperty("processor_ms",
                                      std::to_string(processor_milliseconds() - processor_begin_));
        const ProcessState after = process_state();
        for (const auto& [name, value] : before_) {
            const auto now = after.find(name);
            if (now == after.end())
                ADD_FAILURE() << "the test removed the " << name << " (restore it)";
            else if (now->second != value)
                ADD_FAILURE() << "the test changed the " << name << " from \"" << value
                              << "\" to \"" << now->second << "\" (restore it)";
        }
        for (const auto& [name, value] : after) {
            if (!before_.contains(name))
                ADD_FAILURE() << "the test added the " << name << " = \"" << value
                              << "\" (remove it)";
        }
    }

    ProcessState before_;
    long processor_begin_ = 0;
};

}  // namespace
}  // namespace relief::test

int main(int argc, char** argv) {
    testing::InitGoogleMock(&argc, argv);
    testing::UnitTest::GetInstance()->listeners().Append(new relief::test::RestoredState);
    return RUN_ALL_TESTS();
}
