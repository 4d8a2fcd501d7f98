// SPDX-License-Identifier: Apache-2.0
// The exceptions of the module, and the conversion of arrays, images and reports.
// Tests: tests/python/test_arrays.py.
#include "arrays.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>
#include <variant>

#include "relief/mesh/bake.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/local_origin.h"
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

/// Views an array of numpy. \throws TypeError for other objects
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

/// The same, also for objects that give numpy an array, such as the vectors of Open3D.
py::array as_input_array(const py::handle& value, const char* name, const std::string& expected) {
    const bool gives_array =
        !py::isinstance<py::array>(value) &&
        (PyObject_CheckBuffer(value.ptr()) != 0 || py::hasattr(value, "__array__") ||
         py::hasattr(value, "__array_interface__"));
    if (!gives_array) return as_array(value, name, expected);
    return as_array(py::module_::import("numpy").attr("asarray")(value), name, expected);
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

[[noreturn]] void refuse_layout(const char* name, const std::string& problem) {
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

/// Calls `work` with the first row and the converted values of blocks of rows. Ctrl+C ends it.
template <typename Scalar, typename Work>
void for_blocks(const py::array& array, const Work& work) {
    constexpr py::ssize_t values = py::ssize_t{1} << 20;
    const py::ssize_t rows = array.shape(0);
    const py::ssize_t step =
        std::max<py::ssize_t>(1, values * rows / std::max<py::ssize_t>(1, array.size()));
    for (py::ssize_t begin = 0; begin < rows; begin += step) {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        const py::array_t<Scalar, py::array::c_style | py::array::forcecast> block(
            array[py::slice(begin, std::min(begin + step, rows), 1)]);
        work(begin, std::span(block.data(), static_cast<std::size_t>(block.size())));
    }
}

template <typename Scalar>
Image::Samples copied_samples(const py::array& array) {
    std::vector<Scalar> samples;
    samples.reserve(static_cast<std::size_t>(array.size()));
    for_blocks<Scalar>(array, [&](py::ssize_t, std::span<const Scalar> values) {
        samples.insert(samples.end(), values.begin(), values.end());
    });
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

namespace {

/// Returns the reason why rows of float32 cannot be read or written in place; empty if they can.
std::string layout_problem(const py::array& array) {
    if (array.shape(0) == 0) return "";
    if (array.strides(1) != sizeof(float)) return "the values of a row are not adjacent in memory";
    if (array.shape(0) > 1 && array.strides(0) < 0)
        return "the rows are in reverse order in memory";
    if (!is_aligned(array) ||
        (array.shape(0) > 1 && array.strides(0) % static_cast<py::ssize_t>(alignof(float)) != 0))
        return "the values are not aligned to 4 bytes";
    return "";
}

/// Views rows without a layout problem.
RowView row_view(const py::array& array) {
    const auto size = static_cast<std::size_t>(array.shape(0));
    const std::size_t packed = static_cast<std::size_t>(array.shape(1)) * sizeof(float);
    if (size == 0) return {nullptr, 0, packed};
    return {const_cast<void*>(array.data()), size,
            size == 1 ? packed : static_cast<std::size_t>(array.strides(0))};
}

bool is_float(const py::array& array) {
    return array.dtype().kind() == 'f';
}

bool is_integer(const py::array& array) {
    return array.dtype().kind() == 'i' || array.dtype().kind() == 'u';
}

/// Returns the origin for positions of any type.
glm::dvec3 origin_of(const py::array& array) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    glm::dvec3 low(infinity);
    glm::dvec3 high(-infinity);
    for_blocks<double>(array, [&](py::ssize_t, std::span<const double> values) {
        for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
            const glm::dvec3 point(values[i], values[i + 1], values[i + 2]);
            if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
                continue;
            low = glm::min(low, point);
            high = glm::max(high, point);
        }
    });
    return low.x <= high.x ? local_origin(low, high) : glm::dvec3(0.0);
}

/// Rows as float32, and whether this changed a value.
struct Floats {
    py::array_t<float> values;
    bool is_rounded = false;
};

/// Converts rows, minus an origin, to float32. \throws InvalidInput for too large numbers
Floats to_floats(const py::array& array, const char* name, const glm::dvec3& origin) {
    Floats result{py::array_t<float>({array.shape(0), array.shape(1)}), false};
    const auto columns = static_cast<std::size_t>(array.shape(1));
    const bool is_moved = origin != glm::dvec3(0.0);
    for_blocks<double>(array, [&](py::ssize_t first_row, std::span<const double> values) {
        float* const target =
            result.values.mutable_data() + static_cast<std::size_t>(first_row) * columns;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double value =
                is_moved ? values[i] - origin[static_cast<int>(i % columns)] : values[i];
            if (std::isfinite(value) && std::abs(value) > std::numeric_limits<float>::max()) {
                throw InvalidInput(
                    fmt::format("{}: row {} has {}, but float32 holds at most 3.4e+38", name,
                                static_cast<std::size_t>(first_row) + i / columns, values[i]));
            }
            target[i] = static_cast<float>(value);
            result.is_rounded |= static_cast<double>(target[i]) != value && !std::isnan(value);
        }
    });
    return result;
}

/// Checks that an array of signed integers of native order, which is read as one of unsigned ones,
/// has no negative value.
template <typename Scalar>
void refuse_negative(const py::array& array, const char* name) {
    const std::span values(static_cast<const Scalar*>(array.data()),
                           static_cast<std::size_t>(array.size()));
    const auto negative =
        std::find_if(values.begin(), values.end(), [](Scalar v) { return v < 0; });
    if (negative == values.end()) return;
    const py::ssize_t row = array.ndim() == 2 ? array.shape(1) : 1;
    throw InvalidInput(fmt::format("{}: row {} has {}, expected at least 0", name,
                                   (negative - values.begin()) / row, *negative));
}

}  // namespace

py::array Inputs::kept(const py::handle& value, const char* name, const std::string& expected) {
    arrays_.push_back(as_input_array(value, name, expected));
    return arrays_.back();
}

void Inputs::report(const py::array& from, const py::array& to, const char* name,
                    const std::string& remark) {
    const auto type = [](const py::array& array) {
        return py::str(array.dtype()).cast<std::string>();
    };
    findings_.add(
        Finding{.kind = fmt::format("converted {}", name),
                .element = "value",
                .outcome = fmt::format("{} copied to {}, {:.3g} MB{}", type(from), type(to),
                                       1e-6 * static_cast<double>(to.nbytes()), remark),
                .count = static_cast<std::size_t>(to.size()),
                .first = {}});
}

RowView Inputs::floats(const py::handle& value, const char* name, int columns, glm::dvec3* origin) {
    const std::string expected = fmt::format("float32 of shape (n, {})", columns);
    const py::array array = kept(value, name, expected);
    if (!is_float(array) && !is_integer(array)) refuse_type(array, name, expected, "float32");
    if (array.ndim() != 2 || array.shape(1) != columns) refuse_shape(array, name, expected);
    const bool is_float32 = holds<float>(array);
    const std::string problem = is_float32 ? layout_problem(array) : "";
    if (is_float32 && problem.empty()) return row_view(array);
    if (is_strict() && is_float32) refuse_layout(name, problem);
    if (is_strict()) refuse_type(array, name, expected, "float32");
    glm::dvec3 shift(0.0);
    Floats converted = to_floats(array, name, shift);
    if (origin != nullptr && converted.is_rounded) {
        *origin = shift = origin_of(array);
        if (shift != glm::dvec3(0.0)) converted = to_floats(array, name, shift);
    }
    std::string remark = problem.empty() ? "" : ": " + problem;
    if (shift != glm::dvec3(0.0))
        remark += fmt::format(", relative to ({}, {}, {})", shift.x, shift.y, shift.z);
    if (converted.is_rounded) remark += ", rounded to 24 bits";
    report(array, converted.values, name, remark);
    arrays_.push_back(converted.values);
    return row_view(converted.values);
}

StridedSpan<const glm::vec3> Inputs::positions(const py::handle& value, glm::dvec3& origin) {
    const RowView rows = floats(value, "positions", 3, &origin);
    return {static_cast<const glm::vec3*>(rows.data), rows.size, rows.stride};
}

py::array Inputs::converted_integers(const py::array& array, const char* name,
                                     const std::string& expected) {
    if (is_strict() && (holds<std::uint16_t>(array) || holds<std::uint32_t>(array)))
        refuse_layout(name, "the values have gaps in memory");
    if (is_strict()) refuse_type(array, name, expected, "uint32");
    py::array_t<std::uint32_t> converted(
        std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()));
    const auto columns = static_cast<std::size_t>(array.ndim() == 2 ? array.shape(1) : 1);
    const auto convert = [&]<typename Scalar>(Scalar) {
        for_blocks<Scalar>(array, [&](py::ssize_t first_row, std::span<const Scalar> values) {
            std::uint32_t* const target =
                converted.mutable_data() + static_cast<std::size_t>(first_row) * columns;
            for (std::size_t i = 0; i < values.size(); ++i) {
                if (!std::in_range<std::uint32_t>(values[i])) {
                    throw InvalidInput(
                        fmt::format("{}: row {} has {}, expected 0 to 4294967295", name,
                                    static_cast<std::size_t>(first_row) + i / columns, values[i]));
                }
                target[i] = static_cast<std::uint32_t>(values[i]);
            }
        });
    };
    if (array.dtype().kind() == 'u')
        convert(std::uint64_t{});
    else
        convert(std::int64_t{});
    report(array, converted, name, "");
    arrays_.push_back(converted);
    return converted;
}

TriangleSpan Inputs::triangles(const py::handle& value, const char* name) {
    const std::string expected = "uint16 or uint32 of shape (m, 3)";
    py::array array = kept(value, name, expected);
    if (!is_integer(array)) refuse_type(array, name, expected, "uint32");
    if (array.ndim() != 2 || array.shape(1) != 3) refuse_shape(array, name, expected);
    const bool is_short = holds<std::uint16_t>(array) || holds<std::int16_t>(array);
    const bool is_long = holds<std::uint32_t>(array) || holds<std::int32_t>(array);
    const auto size = static_cast<std::size_t>(array.size());
    if (is_packed(array) && is_short) {
        if (holds<std::int16_t>(array)) refuse_negative<std::int16_t>(array, name);
        return TriangleSpan(std::span(static_cast<const std::uint16_t*>(array.data()), size));
    }
    if (!is_packed(array) || !is_long)
        array = converted_integers(array, name, expected);
    else if (holds<std::int32_t>(array))
        refuse_negative<std::int32_t>(array, name);
    return TriangleSpan(std::span(static_cast<const std::uint32_t*>(array.data()), size));
}

std::vector<glm::uvec3> Inputs::copied_triangles(const py::handle& value) {
    const TriangleSpan views = triangles(value);
    std::vector<glm::uvec3> result;
    result.reserve(views.size());
    for (std::size_t i = 0; i < views.size(); ++i)
        result.push_back(views[i]);
    return result;
}

std::span<const std::uint32_t> Inputs::indices(const py::handle& value, const char* name) {
    if (value.is_none()) return {};
    const std::string expected = "uint32 of shape (n,)";
    py::array array = kept(value, name, expected);
    if (!is_integer(array)) refuse_type(array, name, expected, "uint32");
    if (array.ndim() != 1) refuse_shape(array, name, expected);
    const bool is_signed = holds<std::int32_t>(array);
    if (!is_packed(array) || (!is_signed && !holds<std::uint32_t>(array)))
        array = converted_integers(array, name, expected);
    else if (is_signed)
        refuse_negative<std::int32_t>(array, name);
    return {static_cast<const std::uint32_t*>(array.data()),
            static_cast<std::size_t>(array.size())};
}

RowView output_floats(const py::handle& value, const char* name, int columns) {
    const std::string expected = fmt::format("float32 of shape (n, {})", columns);
    const py::array array = as_array(value, name, expected);
    if (!holds<float>(array)) refuse_type(array, name, expected, "float32");
    if (array.ndim() != 2 || array.shape(1) != columns) refuse_shape(array, name, expected);
    if (!array.writeable()) throw InvalidInput(fmt::format("{}: the array is read-only", name));
    if (const std::string problem = layout_problem(array); !problem.empty())
        refuse_layout(name, problem);
    const RowView rows = row_view(array);
    if (rows.stride < static_cast<std::size_t>(columns) * sizeof(float))
        refuse_layout(name, "the rows overlap");
    return rows;
}

Image image_of(const py::handle& value, const char* name, Report& findings,
               ColorSpace color_space) {
    const std::string expected =
        "uint8, uint16 or float32 of shape (height, width) or (height, width, channels)";
    const py::array array = as_input_array(value, name, expected);
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
    else if (is_float(array) && (holds<float>(array) || !is_strict()))
        image.samples = copied_samples<float>(array);
    else
        refuse_type(array, name, expected, is_float(array) ? "float32" : "uint16");
    if (is_float(array) && !holds<float>(array)) {
        findings.add(Finding{.kind = fmt::format("converted {}", name),
                             .element = "value",
                             .outcome = fmt::format("{} rounded to float32",
                                                    py::str(array.dtype()).cast<std::string>()),
                             .count = static_cast<std::size_t>(array.size()),
                             .first = {}});
    }
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
