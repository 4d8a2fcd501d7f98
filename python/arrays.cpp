// SPDX-License-Identifier: Apache-2.0
// The exceptions of the module, and the conversion of arrays, images and reports.
// Tests: tests/python/test_arrays.py.
#include "arrays.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <utility>
#include <variant>

#include "relief/mesh/bake.h"
#include "relief/mesh/execution.h"
#include "relief/shade/renderer.h"

namespace relief::python {
namespace {

/// "float64 of shape (8, 3)"
std::string description(const py::array& array) {
    std::string shape;
    for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
        shape += fmt::format("{}{}", axis == 0 ? "" : ", ", array.shape(axis));
    if (array.ndim() == 1) shape += ",";
    return fmt::format("{} of shape ({})", py::str(array.dtype()).cast<std::string>(), shape);
}

py::array as_array(const py::handle& value, const char* name, const std::string& expected) {
    if (!py::isinstance<py::array>(value)) {
        throw py::type_error(fmt::format("{}: expected a numpy array of {}, not {}", name, expected,
                                         Py_TYPE(value.ptr())->tp_name));
    }
    // Views of a numpy.ma.MaskedArray have all values.
    if (py::hasattr(value, "mask") && value.attr("mask").attr("any")().cast<bool>()) {
        throw InvalidInput(
            fmt::format("{}: has masked values (replace them: {}.filled(0))", name, name));
    }
    return py::reinterpret_borrow<py::array>(value);
}

[[noreturn]] void refuse_type(const py::array& array, const char* name, const std::string& expected,
                              const char* type) {
    throw py::type_error(fmt::format("{}: {}, expected {} (convert it: {}.astype(numpy.{}))", name,
                                     description(array), expected, name, type));
}

[[noreturn]] void refuse_shape(const py::array& array, const char* name,
                               const std::string& expected) {
    throw InvalidInput(fmt::format("{}: {}, expected {}", name, description(array), expected));
}

[[noreturn]] void refuse_layout(const char* name, const char* problem) {
    throw InvalidInput(
        fmt::format("{}: {} (copy it: numpy.ascontiguousarray({}))", name, problem, name));
}

bool is_aligned(const py::array& array) {
    return (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
}

bool is_packed(const py::array& array) {
    return (array.flags() & py::array::c_style) != 0 && is_aligned(array);
}

template <typename Scalar>
bool holds(const py::array& array) {
    return py::dtype::of<Scalar>().is(array.dtype()) ||
           (array.dtype().kind() == py::dtype::of<Scalar>().kind() &&
            array.itemsize() == static_cast<py::ssize_t>(sizeof(Scalar)) &&
            array.dtype().byteorder() != '>');
}

template <typename Scalar>
Image::Samples copied_samples(const py::array& array) {
    const auto packed = py::array_t<Scalar, py::array::c_style | py::array::forcecast>(array);
    const Scalar* const first = packed.data();
    const auto size = static_cast<std::size_t>(packed.size());
    constexpr std::size_t step = std::size_t{1} << 20;
    std::vector<Scalar> samples;
    samples.reserve(size);
    for (std::size_t begin = 0; begin < size; begin += step) {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        samples.insert(samples.end(), first + begin, first + std::min(size, begin + step));
    }
    return samples;
}

/// Makes a str of a message. File names in it may be any bytes: those that are not UTF-8 become
/// "\xe4" and the like.
py::str text_object(std::string_view text) {
    PyObject* const object = PyUnicode_DecodeUTF8(
        text.data(), static_cast<py::ssize_t>(text.size()), "backslashreplace");
    if (object == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::str>(object);
}

// Exceptions. The objects live as long as the process.

PyObject* error = nullptr;
PyObject* invalid_input = nullptr;
PyObject* bake_mismatch = nullptr;
PyObject* file_error = nullptr;
PyObject* gpu_error = nullptr;
PyObject* cancelled = nullptr;

PyObject* add_error(py::module_& module, const char* name, const char* text,
                    const py::tuple& bases) {
    PyObject* type = PyErr_NewExceptionWithDoc(fmt::format("relief.{}", name).c_str(), text,
                                               bases.ptr(), nullptr);
    if (type == nullptr) throw py::error_already_set();
    module.attr(name) = py::handle(type);
    return type;
}

void set_error(PyObject* type, const Error& problem) {
    PyErr_SetObject(type, text_object(problem.what()).ptr());
}

void translate(std::exception_ptr pointer) {
    try {
        if (pointer) std::rethrow_exception(std::move(pointer));
    } catch (const BakeMismatch& problem) {
        set_error(bake_mismatch, problem);
    } catch (const InvalidInput& problem) {
        set_error(invalid_input, problem);
    } catch (const FileError& problem) {
        set_error(file_error, problem);
    } catch (const shade::GpuError& problem) {
        set_error(gpu_error, problem);
    } catch (const Cancelled& problem) {
        set_error(cancelled, problem);
    } catch (const Error& problem) {
        set_error(error, problem);
    }
}

}  // namespace

void add_errors(py::module_& module) {
    const auto bases = [](auto... types) { return py::make_tuple(py::handle(types)...); };
    error = add_error(module, "Error", "The base class of relief's exceptions.",
                      bases(PyExc_RuntimeError));
    invalid_input =
        add_error(module, "InvalidInput", "Data or options are contradictory or out of range.",
                  bases(error, PyExc_ValueError));
    bake_mismatch =
        add_error(module, "BakeMismatch", "The high and low meshes of a bake do not match.",
                  bases(invalid_input));
    file_error = add_error(module, "FileError", "A file cannot be read or written.",
                           bases(error, PyExc_OSError));
    gpu_error =
        add_error(module, "GpuError", "OpenGL is missing or refuses something.", bases(error));
    cancelled = add_error(module, "Cancelled", "An operation was cancelled.", bases(error));
    py::register_exception_translator(&translate);

    module.def("set_thread_limit", &set_thread_limit, py::arg("count"),
               "Set the maximum number of threads of all parallel loops of this process.\n\n"
               "0 means all processors. Results do not depend on it.");
}

RowView float_rows(const py::handle& value, const char* name, int columns, bool is_output) {
    const std::string expected = fmt::format("float32 of shape (n, {})", columns);
    const py::array array = as_array(value, name, expected);
    if (!holds<float>(array)) refuse_type(array, name, expected, "float32");
    if (array.ndim() != 2 || array.shape(1) != columns) refuse_shape(array, name, expected);
    if (is_output && !array.writeable())
        throw InvalidInput(fmt::format("{}: the array is read-only", name));
    const auto size = static_cast<std::size_t>(array.shape(0));
    const std::size_t packed = static_cast<std::size_t>(columns) * sizeof(float);
    if (size == 0) return {nullptr, 0, packed};
    if (array.strides(1) != sizeof(float))
        refuse_layout(name, "the values of a row are not adjacent in memory");
    const py::ssize_t stride = size == 1 ? static_cast<py::ssize_t>(packed) : array.strides(0);
    if (stride < 0) refuse_layout(name, "the rows are in reverse order in memory");
    if (!is_aligned(array) || stride % static_cast<py::ssize_t>(alignof(float)) != 0)
        refuse_layout(name, "the values are not aligned to 4 bytes");
    if (is_output && static_cast<std::size_t>(stride) < packed)
        refuse_layout(name, "the rows overlap");
    return {const_cast<void*>(array.data()), size, static_cast<std::size_t>(stride)};
}

TriangleSpan triangles_of(const py::handle& value, const char* name) {
    const std::string expected = "uint16 or uint32 of shape (m, 3)";
    const py::array array = as_array(value, name, expected);
    const bool is_short = holds<std::uint16_t>(array);
    if (!is_short && !holds<std::uint32_t>(array)) refuse_type(array, name, expected, "uint32");
    if (array.ndim() != 2 || array.shape(1) != 3) refuse_shape(array, name, expected);
    if (!is_packed(array)) refuse_layout(name, "the indices have gaps in memory");
    const auto size = static_cast<std::size_t>(array.size());
    if (is_short) {
        return TriangleSpan(std::span(static_cast<const std::uint16_t*>(array.data()), size));
    }
    return TriangleSpan(std::span(static_cast<const std::uint32_t*>(array.data()), size));
}

std::vector<glm::uvec3> copied_triangles(const py::handle& value, const char* name) {
    const TriangleSpan triangles = triangles_of(value, name);
    std::vector<glm::uvec3> result;
    result.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        result.push_back(triangles[i]);
    return result;
}

std::span<const std::uint32_t> indices_of(const py::handle& value, const char* name) {
    if (value.is_none()) return {};
    const std::string expected = "uint32 of shape (n,)";
    const py::array array = as_array(value, name, expected);
    if (!holds<std::uint32_t>(array)) refuse_type(array, name, expected, "uint32");
    if (array.ndim() != 1) refuse_shape(array, name, expected);
    if (!is_packed(array)) refuse_layout(name, "the values have gaps in memory");
    return {static_cast<const std::uint32_t*>(array.data()),
            static_cast<std::size_t>(array.size())};
}

Image image_of(const py::handle& value, const char* name, ColorSpace color_space) {
    const std::string expected =
        "uint8, uint16 or float32 of shape (height, width) or (height, width, channels)";
    const py::array array = as_array(value, name, expected);
    if (array.ndim() < 2 || array.ndim() > 3) refuse_shape(array, name, expected);
    const py::ssize_t channels = array.ndim() == 2 ? 1 : array.shape(2);
    constexpr py::ssize_t max_side = 1 << 24;
    if (array.shape(0) > max_side || array.shape(1) > max_side || channels < 1 || channels > 4)
        refuse_shape(array, name, expected + " with 1 to 4 channels");
    Image image;
    image.height = static_cast<int>(array.shape(0));
    image.width = static_cast<int>(array.shape(1));
    image.channels = static_cast<int>(channels);
    image.color_space = color_space;
    if (holds<std::uint8_t>(array))
        image.samples = copied_samples<std::uint8_t>(array);
    else if (holds<std::uint16_t>(array))
        image.samples = copied_samples<std::uint16_t>(array);
    else if (holds<float>(array))
        image.samples = copied_samples<float>(array);
    else
        refuse_type(array, name, expected, "float32");
    return image;
}

py::array array_of(Image&& image) {
    std::vector<py::ssize_t> shape = {image.height, image.width};
    if (image.channels != 1) shape.push_back(image.channels);
    return std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) -> py::array {
            return array_of<Sample>(std::move(samples), shape);
        },
        image.samples);
}

void refuse_name(const char* option, const std::string& name,
                 const std::vector<std::string>& valid) {
    throw InvalidInput(
        fmt::format("{}: '{}' is not one of {}", option, name, fmt::join(valid, ", ")));
}

py::list to_list(const Report& report) {
    py::list list;
    for (const Finding& finding : report.findings()) {
        py::dict entry;
        entry["kind"] = text_object(finding.kind);
        entry["element"] = text_object(finding.element);
        entry["count"] = finding.count;
        entry["first"] = finding.first;
        entry["outcome"] = text_object(finding.outcome);
        list.append(std::move(entry));
    }
    return list;
}

void append(const Report& report, const FindingList& list) {
    if (!list) return;
    py::list target = *list;  // The same list object.
    for (const py::handle entry : to_list(report))
        target.append(entry);
}

py::dict to_dict(const ErrorStats& errors, const char* element) {
    py::list histogram;
    for (std::size_t i = 0; i < errors.histogram.size(); ++i) {
        py::dict bin;
        bin["up_to"] = ErrorStats::bounds[i];
        bin[element] = errors.histogram[i];
        histogram.append(std::move(bin));
    }
    py::dict result;
    result[element] = errors.count;
    result["undefined"] = errors.undefined;
    result["rms"] = errors.rms;
    result["mean"] = errors.mean;
    result["p99"] = errors.p99;
    result["max"] = errors.max;
    result["histogram"] = std::move(histogram);
    return result;
}

}  // namespace relief::python
