// SPDX-License-Identifier: Apache-2.0
// Calls of the library without the GIL, which signal handlers and progress functions can end, and
// the context manager relief.Execution: the threads, progress and cancellation of everything that a
// block calls. Tests: tests/python/test_interruption.py, test_arrays.py.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "arrays.h"
#include "relief/mesh/execution.h"

namespace relief::python {
namespace {

class Call;

/// The class relief.Execution.
class Execution {
  public:
    Execution(unsigned threads, std::optional<py::function> tell, bool strict)
        : threads_(threads), tell_(std::move(tell)), is_strict_(strict) {}
    ~Execution();
    Execution(const Execution&) = delete;
    Execution& operator=(const Execution&) = delete;

    void enter();
    void exit();

    /// Cancels the calls of the block, and all later ones. Any thread may call it.
    void cancel();

    [[nodiscard]] Progress::State state() const;

    /// The limit of threads in the block; 0 if there is none.
    [[nodiscard]] unsigned limit() const { return limit_; }

    /// Returns true if this block or one around it refuses conversions.
    [[nodiscard]] bool is_strict() const {
        return is_strict_ || (before_ != nullptr && before_->is_strict());
    }

    /// The maximum number of threads that this Execution asks for; 0: all.
    [[nodiscard]] unsigned threads() const { return threads_; }

    /// The progress function of Python. \return nothing if there is none
    [[nodiscard]] const std::optional<py::function>& progress_function() const { return tell_; }

    void add(Call& call);
    void remove(Call& call);

  private:
    unsigned threads_;
    unsigned limit_ = 0;
    std::optional<py::function> tell_;
    bool is_strict_;
    bool is_entered_ = false;
    Execution* before_ = nullptr;
    mutable std::mutex mutex_;
    bool is_cancelled_ = false;
    std::vector<Call*> calls_;  ///< More than one if a progress function calls the library.
};

/// The innermost Execution whose block this thread runs.
thread_local Execution* current_execution = nullptr;

/// A call of the library on a thread of its own. The calling thread waits, and meanwhile runs
/// signal handlers, which Python does only on the main thread, and progress functions.
class Call {
  public:
    /// \param tell  receives the progress, beside the function of the Execution
    explicit Call(const TellProgress& tell)
        : tell_(tell),
          progress_(tells() ? [this](const Progress::State& state) { pass_on(state); }
                            : std::function<void(const Progress::State&)>()) {
        if (execution_ != nullptr) execution_->add(*this);
    }
    ~Call() {
        if (execution_ != nullptr) execution_->remove(*this);
    }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

    /// \throws what `work`, a signal handler or a progress function throws
    void run(const std::function<void()>& work) {
        std::exception_ptr failure;
        {
            const py::gil_scoped_release release;
            std::thread worker([&] {
                const ExecutionScope scope(
                    {.threads = execution_ != nullptr ? execution_->limit() : 0,
                     .progress = &progress_});
                try {
                    work();
                } catch (...) {
                    failure = std::current_exception();
                }
                const std::lock_guard lock(mutex_);
                is_finished_ = true;
                changed_.notify_all();
            });
            wait();
            worker.join();
        }
        if (error_) std::rethrow_exception(error_);
        if (failure) std::rethrow_exception(failure);
    }

    void cancel() { progress_.cancel(); }
    [[nodiscard]] Progress::State state() const { return progress_.state(); }

  private:
    [[nodiscard]] bool tells() const {
        return tell_ || (execution_ != nullptr && execution_->progress_function());
    }

    /// Lets the calling thread pass the progress to Python, and waits for it.
    void pass_on(const Progress::State& state) {
        std::unique_lock lock(mutex_);
        news_ = state;
        changed_.notify_all();
        changed_.wait(lock, [this] { return !news_; });
    }

    /// Waits until the work is finished.
    void wait() {
        // Ctrl+C waits for this time and for the next cancellation point of the library.
        constexpr std::chrono::milliseconds signal_interval(20);
        std::unique_lock lock(mutex_);
        while (!is_finished_) {
            changed_.wait_for(lock, signal_interval, [this] { return is_finished_ || news_; });
            if (is_finished_) return;
            const std::optional<Progress::State> news = news_;
            lock.unlock();
            serve(news);
            lock.lock();
            if (news) news_.reset();
            changed_.notify_all();
        }
    }

    void tell(const Progress::State& state) const {
        if (execution_ != nullptr && execution_->progress_function())
            (*execution_->progress_function())(state.stage, state.part);
        if (tell_) tell_(state);
    }

    /// Runs signal handlers, and tells the news.
    void serve(const std::optional<Progress::State>& news) {
        const py::gil_scoped_acquire acquire;
        if (error_) return;
        // relief functions that a signal handler or the progress function calls report no progress.
        Execution* const before = std::exchange(current_execution, nullptr);
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            if (news) tell(*news);
        } catch (...) {
            error_ = std::current_exception();
            progress_.cancel();
        }
        current_execution = before;
    }

    const TellProgress& tell_;
    Execution* const execution_ = current_execution;
    Progress progress_;
    std::exception_ptr error_;  ///< Of a signal handler or a progress function.
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<Progress::State> news_;
    bool is_finished_ = false;
};

Execution::~Execution() {
    if (current_execution == this) current_execution = before_;
}

void Execution::enter() {
    if (is_entered_) throw InvalidInput("the block of an Execution is not finished");
    const std::lock_guard lock(mutex_);
    if (is_cancelled_) throw Cancelled();
    is_entered_ = true;
    before_ = std::exchange(current_execution, this);
    const unsigned outer = before_ != nullptr ? before_->limit_ : 0;
    limit_ = threads_ == 0 || outer == 0 ? std::max(threads_, outer) : std::min(threads_, outer);
}

void Execution::exit() {
    current_execution = before_;
    is_entered_ = false;
}

void Execution::cancel() {
    const std::lock_guard lock(mutex_);
    is_cancelled_ = true;
    for (Call* const call : calls_)
        call->cancel();
}

Progress::State Execution::state() const {
    const std::lock_guard lock(mutex_);
    return calls_.empty() ? Progress::State{} : calls_.back()->state();
}

void Execution::add(Call& call) {
    const std::lock_guard lock(mutex_);
    calls_.push_back(&call);
    if (is_cancelled_) call.cancel();
}

void Execution::remove(Call& call) {
    const std::lock_guard lock(mutex_);
    std::erase(calls_, &call);
}

}  // namespace

void run_without_gil(const std::function<void()>& work, const TellProgress& tell) {
    Call(tell).run(work);
}

bool is_strict() {
    return current_execution != nullptr && current_execution->is_strict();
}

void add_execution(py::module_& module) {
    using py::arg;
    py::class_<Execution>(
        module, "Execution",
        "Limits threads, reports progress and cancels everything that a `with` block calls.\n\n"
        "It applies to the thread that runs the block. `threads` is the maximum number of\n"
        "threads; 0: all. `progress` is called with the stage and its finished fraction, on the\n"
        "thread that runs the block. An exception that it raises ends the operation. `strict`\n"
        "refuses arrays that would be converted, with TypeError or InvalidInput.")
        .def(py::init<unsigned, std::optional<py::function>, bool>(), py::kw_only(),
             arg("threads") = 0, arg("progress") = py::none(), arg("strict") = false,
             "State the limits of a block.")
        .def(
            "__repr__",
            [](const Execution& self) {
                return "<relief.Execution, threads: " +
                       (self.threads() == 0 ? std::string("all") : std::to_string(self.threads())) +
                       ">";
            })
        .def("__enter__",
             [](const py::object& self) {
                 self.cast<Execution&>().enter();
                 return self;
             })
        .def("__exit__", [](Execution& self, const py::args&) { self.exit(); })
        .def("cancel", &Execution::cancel,
             "End the operation with the exception Cancelled. Any thread may call it.")
        .def_property_readonly(
            "state",
            [](const Execution& self) {
                const Progress::State state = self.state();
                return std::pair(state.stage, state.part);
            },
            "The stage and its finished fraction: (\"reading\", 0.5); (\"\", None) before and "
            "after.");
}

}  // namespace relief::python
