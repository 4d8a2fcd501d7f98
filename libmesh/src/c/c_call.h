// SPDX-License-Identifier: Apache-2.0
/// \file
/// The common part of all functions of the C interface: errors instead of exceptions, structs of
/// any version, enumerators, execution, and checked views of the caller's memory.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <glm/glm.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "relief/mesh/bake.h"
#include "relief/mesh/buffers.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/relief.h"

/// A report, and the texts of findings that the caller has seen.
struct relief_report {  // NOLINT: the name of C.
    relief::Report report;
    std::deque<std::string> texts;
};

namespace relief::detail {

/// A function that this configuration of the library does not have.
class Unavailable : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Clears the message of this thread.
void begin_call() noexcept;

/// Stores the message of the exception that is being handled, and returns its status.
relief_status status_of_exception() noexcept;

/// Calls a function; exceptions become a status.
template <typename Function>
relief_status guarded(const Function& function) noexcept {
    begin_call();
    try {
        function();
        return RELIEF_OK;
    } catch (...) {
        return status_of_exception();
    }
}

// Structs. `size` is their first field. Fields are only added, at the end.

/// The size of a struct in the first version that had it. A struct that grows needs a
/// specialization with its former size.
template <typename Struct>
inline constexpr std::size_t first_size = sizeof(Struct);
template <>
inline constexpr std::size_t first_size<relief_bake_options> = offsetof(relief_bake_options,
                                                                        thickness_distance);
template <>
inline constexpr std::size_t first_size<relief_bake_maps> = offsetof(relief_bake_maps,
                                                                     bent_normals);
template <>
inline constexpr std::size_t first_size<relief_bake_result> = offsetof(relief_bake_result,
                                                                       occlusion_rays);

/// A larger size is taken for that of a struct that was not initialized.
inline constexpr std::size_t max_struct_size = 4096;

/// \throws InvalidInput unless a struct can have this size
template <typename Struct>
void check_struct_size(std::size_t size, const char* name) {
    if (size >= first_size<Struct> && size <= max_struct_size) return;
    throw InvalidInput(fmt::format("{}: the size is {}, but must be at least {} (call {}_init())",
                                   name, size, first_size<Struct>, name));
}

/// Initializes the caller's struct of `size` bytes; what this version does not know becomes 0.
template <typename Struct>
relief_status init_struct(Struct* to, std::size_t size, Struct defaults,
                          const char* name) noexcept {
    return guarded([&] {
        if (to == nullptr) throw InvalidInput(fmt::format("{} is NULL", name));
        check_struct_size<Struct>(size, name);
        defaults.size = size;
        std::memset(static_cast<void*>(to), 0, size);
        std::memcpy(static_cast<void*>(to), &defaults, std::min(size, sizeof(Struct)));
    });
}

/// Returns the caller's struct; fields that it does not have are those of `defaults`.
///
/// \throws InvalidInput if it was not initialized, or sets fields that this version does not know
template <typename Struct>
Struct read_struct(const Struct* from, Struct defaults, const char* name) {
    if (from == nullptr) return defaults;
    const std::size_t size = from->size;
    check_struct_size<Struct>(size, name);
    std::memcpy(&defaults, from, std::min(size, sizeof(Struct)));
    const auto* const bytes = reinterpret_cast<const unsigned char*>(from);
    if (size > sizeof(Struct) && std::any_of(bytes + sizeof(Struct), bytes + size,
                                             [](unsigned char byte) { return byte != 0; })) {
        throw InvalidInput(
            fmt::format("{}: a field is set that version {} does not have", name, RELIEF_VERSION));
    }
    return defaults;
}

/// Writes a result into the caller's struct, which keeps its size. NULL does nothing.
template <typename Struct>
void write_struct(Struct* to, Struct result, const char* name) {
    if (to == nullptr) return;
    check_struct_size<Struct>(to->size, name);
    result.size = to->size;
    std::memcpy(static_cast<void*>(to), &result, std::min(result.size, sizeof(Struct)));
}

/// \throws InvalidInput unless a reserved field is 0
template <typename Integer>
void check_reserved(Integer reserved, const char* name) {
    if (reserved == 0) return;
    throw InvalidInput(fmt::format("{}: the reserved field is {}, but must be 0", name, reserved));
}

/// Returns the enumerator of a number. \throws InvalidInput if there is none
template <typename Enum, std::size_t count>
Enum enumerator(std::int32_t number, const std::array<Enum, count>& enumerators,
                const char* field) {
    if (number >= 0 && static_cast<std::size_t>(number) < count)
        return enumerators[static_cast<std::size_t>(number)];
    throw InvalidInput(
        fmt::format("{} is {}, but must be within 0 to {}", field, number, count - 1));
}

/// The same; RELIEF_..._AUTOMATIC is absent.
template <typename Enum, std::size_t count>
std::optional<Enum> optional_enumerator(std::int32_t number,
                                        const std::array<Enum, count>& enumerators,
                                        const char* field) {
    if (number == -1) return std::nullopt;
    return enumerator(number, enumerators, field);
}

/// Returns the number of an enumerator.
template <typename Enum, std::size_t count>
std::int32_t number_of(Enum wanted, const std::array<Enum, count>& enumerators) {
    return static_cast<std::int32_t>(std::find(enumerators.begin(), enumerators.end(), wanted) -
                                     enumerators.begin());
}

/// Returns a value that may be RELIEF_ABSENT.
inline std::optional<double> optional_value(double value) {
    return value == RELIEF_ABSENT ? std::nullopt : std::optional(value);
}

/// Green, code of zero and dithering of a normal map of the caller.
NormalMapFormat normal_map_format(std::int32_t green, std::int32_t flat, std::int32_t dither,
                                  const relief_output_image& map);

/// The numbers of NormalMapFormat.
struct FormatNumbers {
    std::int32_t green, flat, dither;
};
FormatNumbers numbers_of(const NormalMapFormat& format);

// The enumerators of relief_bake_options, and its defaults.
inline constexpr std::array bake_spaces = {VectorSpace::tangent, VectorSpace::object};
inline constexpr std::array bake_ray_directions = {RayDirections::averaged, RayDirections::shading,
                                                   RayDirections::face};
relief_bake_options default_bake_options();

/// The execution of a call, which the progress function of the caller can cancel.
class Execution {
  public:
    explicit Execution(const relief_execution* execution);
    Execution(const Execution&) = delete;
    Execution& operator=(const Execution&) = delete;

    [[nodiscard]] const ExecutionOptions& options() const { return options_; }

  private:
    Progress progress_;
    ExecutionOptions options_;
};

/// The report of a call: that of the caller, or one that nobody reads.
class CallReport {
  public:
    explicit CallReport(relief_report* report) : report_(report ? report->report : ignored_) {}
    operator Report&() { return report_; }  // NOLINT: implicit, as an argument.

  private:
    Report ignored_;
    Report& report_;
};

// Memory of the caller.

/// The memory of elements at equal distances.
struct Extent {
    const char* name;  ///< "positions"
    const void* data;
    std::size_t count;
    std::size_t size;    ///< Of an element, in bytes.
    std::size_t stride;  ///< 0: contiguous.

    /// The distance between elements. \throws InvalidInput if the pointer is null or not aligned to
    /// `alignment`, elements overlap each other, or the memory exceeds the address space
    [[nodiscard]] std::size_t checked_stride(std::size_t alignment) const;
};

/// \throws InvalidInput if an output shares memory with another array. Interleaved elements of the
///         same stride do not
void check_apart(const Extent& output, const Extent& other);

/// The caller's mesh, with its pointers checked.
class CMesh {
  public:
    /// \throws InvalidInput if the struct is NULL or was not initialized, or if positions or
    /// indices
    ///         are missing or not as documented
    explicit CMesh(const relief_mesh* mesh);

    [[nodiscard]] std::size_t vertex_count() const { return mesh_.vertex_count; }
    [[nodiscard]] TriangleSpan triangles() const { return triangles_; }
    [[nodiscard]] Extent indices() const;

    /// \throws InvalidInput if the attribute is missing (if there are vertices) or not as
    /// documented
    [[nodiscard]] StridedSpan<const glm::vec3> positions() const;
    [[nodiscard]] StridedSpan<const glm::vec3> normals() const;
    [[nodiscard]] StridedSpan<const glm::vec2> texcoords() const;

    /// The memory of attributes, to compare with outputs.
    [[nodiscard]] Extent position_extent() const;
    [[nodiscard]] Extent normal_extent() const;
    [[nodiscard]] Extent texcoord_extent() const;

    /// Copies the mesh, with all attributes.
    [[nodiscard]] Mesh copy() const;

  private:
    relief_mesh mesh_;
    TriangleSpan triangles_;
};

/// \param name  "height map". \throws InvalidInput if the image is empty or not as documented
ImageView view_of(const relief_image* image, const char* name);
MutableImageView view_of(const relief_output_image& image, const char* name);

/// \throws InvalidInput if two images share memory
void check_apart(const relief_output_image& output, const char* output_name,
                 const relief_image& other, const char* other_name);

}  // namespace relief::detail
