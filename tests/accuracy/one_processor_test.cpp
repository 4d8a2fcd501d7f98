// SPDX-License-Identifier: Apache-2.0
// All threads of the process on one processor, and back.
#include "drawn/one_processor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace relief {
namespace {

int processors_of_this_thread() {
    ::cpu_set_t allowed;
    CPU_ZERO(&allowed);
    EXPECT_EQ(::sched_getaffinity(0, sizeof allowed, &allowed), 0);
    return CPU_COUNT(&allowed);
}

/// What a thread that was there before says of itself when it is asked.
class OtherThread {
  public:
    OtherThread()
        : thread_([this] {
              for (int asked = ask_.load(); asked >= 0; ask_.wait(asked), asked = ask_.load()) {
                  if (asked == answered_.load()) continue;
                  processors_ = processors_of_this_thread();
                  answered_ = asked;
                  answered_.notify_all();
              }
          }) {}
    ~OtherThread() {
        ask_ = -1;
        ask_.notify_all();
        thread_.join();
    }
    OtherThread(const OtherThread&) = delete;
    OtherThread& operator=(const OtherThread&) = delete;

    int processors() {
        const int question = ++ask_;
        ask_.notify_all();
        for (int last = answered_; last != question; last = answered_)
            answered_.wait(last);
        return processors_;
    }

  private:
    std::atomic<int> ask_ = 0;
    std::atomic<int> answered_ = 0;
    std::atomic<int> processors_ = 0;
    std::thread thread_;  // Last: it uses the others.
};

TEST(OneProcessor, KeepsAllThreadsAndLetsThemGo) {
    const int before = processors_of_this_thread();
    OtherThread other;
    ASSERT_EQ(other.processors(), before);
    {
        const OneProcessor one;
        if (!one.is_kept()) GTEST_SKIP() << "this system does not let threads be placed";
        EXPECT_EQ(processors_of_this_thread(), 1);
        EXPECT_EQ(other.processors(), 1);
    }
    EXPECT_EQ(processors_of_this_thread(), before);
    EXPECT_EQ(other.processors(), before);
}

}  // namespace
}  // namespace relief
