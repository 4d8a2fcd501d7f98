// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numpy arrays as views of relief's types, results as arrays without a copy, names of enumerators,
/// findings as dictionaries, and calls without the interpreter's lock (GIL).
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "relief/mesh/buffers.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief::python {

namespace py = pybind11;

// Each function adds the functions of a topic to the module.
void add_errors(py::module_& module);
void add_execution(py::module_& module);
void add_meshes(py::module_& module);
void add_displace(py::module_& module);
void add_repair(py::module_& module);
void add_unwrap(py::module_& module);
void add_images(py::module_& module);
void add_bake(py::module_& module);
void add_scenes(py::module_& module);

/// Receives the progress of a call, with the GIL. An exception ends the call.
using TellProgress = std::function<void(const Progress::State& state)>;

/// The same as without_gil() for work without a result.
void run_without_gil(const std::function<void()>& work, const TellProgress& tell = {});

/// Calls `work` without the GIL on another thread, so that this and other Python threads run
/// meanwhile. This thread calls `tell` and the progress function of the Execution, and runs signal
/// handlers: Ctrl+C ends the call with KeyboardInterrupt.
template <typename Work>
auto without_gil(Work&& work, const TellProgress& tell = {}) {
    using Result = std::invoke_result_t<Work>;
    if constexpr (std::is_void_v<Result>) {
        run_without_gil(work, tell);
    } else {
        std::optional<Result> result;
        run_without_gil([&] { result.emplace(work()); }, tell);
        return std::move(*result);
    }
}

// Input arrays.

/// Returns true within a block of an Execution that refuses conversions.
bool is_strict();

/// Rows of numbers in an array: n rows of equal length at equal distances.
struct RowView {
    void* data = nullptr;
    std::size_t size = 0;
    std::size_t stride = 0;  ///< In bytes.
};

/// The arrays that a call reads. An array of another type or layout is converted: the copy lives as
/// long as this object, and a finding states what was copied. Create and destroy it with the GIL.
///
/// Arrays are those of numpy, and objects that give numpy one: with a buffer, __array__ or
/// __array_interface__. The functions throw TypeError for another type, InvalidInput for another
/// shape, values that are masked or out of range, and in strict blocks for what would be converted.
/// `name` is for messages.
class Inputs {
  public:
    /// \param findings  must outlive this object
    explicit Inputs(Report& findings) : findings_(findings) {}

    /// Views an array of float32 and shape (n, columns). The values of a row must be adjacent; rows
    /// may have any distance, as in an interleaved vertex buffer. Other numbers are converted.
    template <typename Vector>
    StridedSpan<const Vector> rows(const py::handle& value, const char* name) {
        const RowView rows = floats(value, name, Vector::length(), nullptr);
        return {static_cast<const Vector*>(rows.data), rows.size, rows.stride};
    }

    /// The same for positions. If they are far from 0 and float32 cannot hold them, they are
    /// relative to `origin` afterwards (relief/mesh/local_origin.h), as those of files are.
    StridedSpan<const glm::vec3> positions(const py::handle& value, glm::dvec3& origin);

    /// The same for results that do not depend on the origin.
    StridedSpan<const glm::vec3> positions(const py::handle& value) {
        glm::dvec3 unused(0.0);
        return positions(value, unused);
    }

    /// Copies rows of floats; empty for None.
    template <typename Vector>
    std::vector<Vector> copied_rows(const py::handle& value, const char* name) {
        if (value.is_none()) return {};
        return copied(rows<Vector>(value, name));
    }

    /// Views an array of shape (m, 3) without gaps, of uint16, uint32, int16 or int32. Other
    /// integers are converted to uint32.
    TriangleSpan triangles(const py::handle& value, const char* name = "triangles");

    /// Copies such an array.
    std::vector<glm::uvec3> copied_triangles(const py::handle& value);

    /// Views an array of uint32 or int32 and shape (n), without gaps; empty for None. Other
    /// integers are converted.
    std::span<const std::uint32_t> indices(const py::handle& value, const char* name);

    template <typename Vector>
    static std::vector<Vector> copied(const StridedSpan<const Vector>& rows) {
        std::vector<Vector> values;
        values.reserve(rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i)
            values.push_back(rows[i]);
        return values;
    }

  private:
    RowView floats(const py::handle& value, const char* name, int columns, glm::dvec3* origin);
    py::array kept(const py::handle& value, const char* name, const std::string& expected);
    py::array converted_integers(const py::array& array, const char* name,
                                 const std::string& expected);
    void report(const py::array& from, const py::array& to, const char* name,
                const std::string& remark);

    Report& findings_;
    std::vector<py::array> arrays_;
};

/// Views an output array of float32 and shape (n, columns), which is never converted.
RowView output_floats(const py::handle& value, const char* name, int columns);

template <typename Vector>
StridedSpan<Vector> output_rows(const py::handle& value, const char* name) {
    const RowView rows = output_floats(value, name, Vector::length());
    return {static_cast<Vector*>(rows.data), rows.size, rows.stride};
}

// Results.

/// Creates an array on the memory of a vector, which it then owns.
template <typename Scalar, typename Value>
py::array_t<Scalar> array_of(std::vector<Value>&& values, std::vector<py::ssize_t> shape) {
    auto* owner = new std::vector<Value>(std::move(values));
    const py::capsule capsule(
        owner, [](void* memory) { delete static_cast<std::vector<Value>*>(memory); });
    return py::array_t<Scalar>(std::move(shape), reinterpret_cast<Scalar*>(owner->data()), capsule);
}

/// The same for vectors of GLM: shape (n, columns).
template <typename Vector>
py::array_t<typename Vector::value_type> array_of(std::vector<Vector>&& values) {
    const auto size = static_cast<py::ssize_t>(values.size());
    return array_of<typename Vector::value_type>(std::move(values), {size, Vector::length()});
}

// File names.

/// A file name from a str, bytes or an object with __fspath__.
struct FileName : std::filesystem::path {
    using std::filesystem::path::path;
    FileName& operator=(std::filesystem::path name) {
        std::filesystem::path::operator=(std::move(name));
        return *this;
    }
};

// Images.

/// Copies an array of uint8, uint16 or float32 and shape (height, width) or (height, width,
/// channels). Other floats are converted, which a finding states. Other integers are refused,
/// because their largest value is unknown. \throws TypeError, InvalidInput
Image image_of(const py::handle& value, const char* name, Report& findings,
               ColorSpace color_space = ColorSpace::data);

/// Creates an array on the memory of an image. Images of one channel have the shape (height,
/// width).
py::array array_of(Image&& image);

// Options and reports.

/// The error for a name that is not one of an enumeration.
[[noreturn]] void refuse_name(const char* option, const std::string& name,
                              const std::vector<std::string>& valid);

/// Returns the enumerator with the name that command lines use.
template <typename Enum, typename Names = decltype(enum_names<Enum>)>
Enum value_of(const std::string& name, const char* option, const Names& names = enum_names<Enum>) {
    std::vector<std::string> valid;
    for (const EnumName<Enum>& entry : names) {
        if (entry.name == name) return entry.value;
        valid.emplace_back(entry.name);
    }
    refuse_name(option, name, valid);
}

/// Returns the value of a name, or nothing for None and "auto".
template <typename Enum>
std::optional<Enum> optional_value(const std::optional<std::string>& name, const char* option) {
    if (!name || *name == "auto") return std::nullopt;
    return value_of<Enum>(*name, option);
}

/// Receives findings as dictionaries, if the caller passes a list.
using FindingList = std::optional<py::list>;

/// Converts findings to dictionaries with the keys of the tools' JSON, without "where".
py::list to_list(const Report& report);

void append(const Report& report, const FindingList& list);

/// Converts statistics with the keys of the tools' JSON.
/// \param element  the key of the count: "corners"
py::dict to_dict(const ErrorStats& errors, const char* element);

}  // namespace relief::python

/// Converts file names as pybind11 does for std::filesystem::path, but an exception that __fspath__
/// raises, such as KeyboardInterrupt, is passed on instead of becoming a TypeError.
template <>
struct pybind11::detail::type_caster<relief::python::FileName> {
    PYBIND11_TYPE_CASTER(relief::python::FileName, const_name("os.PathLike"));

    bool load(handle source, bool convert) {
        const object text = reinterpret_steal<object>(PyOS_FSPath(source.ptr()));
        if (!text) {
            if (PyErr_ExceptionMatches(PyExc_TypeError) == 0) throw error_already_set();
            PyErr_Clear();
            return false;
        }
        type_caster<std::filesystem::path> path;
        if (!path.load(text, convert)) return false;
        value = cast_op<std::filesystem::path&>(path);
        return true;
    }
};
