// SPDX-License-Identifier: Apache-2.0
// The extension module relief._relief, and the context manager relief.Execution: the threads,
// progress and cancellation of everything that a block calls. relief/__init__.py is the public
// interface. Tests: tests/python/test_arrays.py.
#include "arrays.h"

#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "relief/mesh/execution.h"
#include "relief/version.h"

namespace relief::python {
namespace {

class Execution {
  public:
    Execution(unsigned threads, std::optional<py::function> tell)
        : threads_(threads), tell_(std::move(tell)) {
        if (tell_)
            progress_.emplace([this](const Progress::State& state) { call(state); });
        else
            progress_.emplace();
    }

    void enter() {
        if (scope_) throw InvalidInput("the block of an Execution is not finished");
        if (progress_->is_cancelled()) throw Cancelled();
        scope_.emplace(ExecutionOptions{.threads = threads_, .progress = &*progress_});
    }

    /// Ends the block. \throws the exception of the progress function that cancelled it
    void exit() {
        scope_.reset();
        if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    }

    void cancel() { progress_->cancel(); }

    [[nodiscard]] Progress::State state() const { return progress_->state(); }

  private:
    /// Calls the progress function, from any thread that has no GIL.
    void call(const Progress::State& state) {
        const py::gil_scoped_acquire acquire;
        if (error_) return;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            (*tell_)(state.stage, state.part);
        } catch (...) {
            error_ = std::current_exception();
            progress_->cancel();
        }
    }

    unsigned threads_;
    std::optional<py::function> tell_;
    std::optional<Progress> progress_;
    std::optional<ExecutionScope> scope_;
    std::exception_ptr error_;
};

}  // namespace

void add_execution(py::module_& module) {
    using py::arg;
    py::class_<Execution>(
        module, "Execution",
        "Limits threads, reports progress and cancels everything that a `with` block calls.\n\n"
        "It applies to the thread that runs the block. `threads` is the maximum number of\n"
        "threads; 0: all. `progress` is called with the stage and its finished fraction, from\n"
        "any thread, one call at a time. An exception that it raises, or Ctrl+C, ends the\n"
        "operation and leaves the block.")
        .def(py::init<unsigned, std::optional<py::function>>(), py::kw_only(), arg("threads") = 0,
             arg("progress") = py::none())
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

PYBIND11_MODULE(_relief, module) {
    namespace py = relief::python::py;
    py::options options;
    options.disable_function_signatures();  // relief/_relief.pyi states them with the exact types.
    module.doc() = "The functions of the relief library on numpy arrays.";
    module.attr("__version__") = RELIEF_VERSION;
    module.attr("tool_directory") = RELIEF_TOOL_DIRECTORY;
    relief::python::add_errors(module);
    relief::python::add_execution(module);
    relief::python::add_meshes(module);
    relief::python::add_images(module);
    relief::python::add_bake(module);
    relief::python::add_scenes(module);
}
