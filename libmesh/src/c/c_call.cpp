// SPDX-License-Identifier: Apache-2.0
// Errors, reports, execution, and checked views of the caller's memory.
#include "c/c_call.h"

#include <limits>
#include <new>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace relief::detail {
namespace {

/// The message of the last call in this thread. A message that cannot be stored is a constant.
struct CallMessage {
    std::string text;
    const char* shown = "";

    void set(const char* message) noexcept {
        try {
            text = message;
            shown = text.c_str();
        } catch (const std::bad_alloc&) {
            shown = "out of memory";
        }
    }
};
thread_local CallMessage call_message;

constexpr std::array flat_codes = {FlatCode::middle, FlatCode::half};
constexpr std::array greens = {Green::up, Green::down};
constexpr std::array dithers = {Dither::none, Dither::ordered, Dither::blue_noise};
constexpr std::array<std::size_t, 3> sample_sizes = {1, 2, sizeof(float)};

std::uintptr_t address(const void* pointer) {
    return reinterpret_cast<std::uintptr_t>(pointer);
}

}  // namespace

void begin_call() noexcept {
    call_message.shown = "";
}

relief_status status_of_exception() noexcept {
    try {
        throw;
    } catch (const Cancelled& error) {
        call_message.set(error.what());
        return RELIEF_CANCELLED;
    } catch (const InvalidInput& error) {
        call_message.set(error.what());
        return RELIEF_INVALID_INPUT;
    } catch (const Unavailable& error) {
        call_message.set(error.what());
        return RELIEF_UNAVAILABLE;
    } catch (const std::bad_alloc&) {
        call_message.shown = "out of memory";
        return RELIEF_OUT_OF_MEMORY;
    } catch (const std::length_error&) {  // Of a vector.
        call_message.shown = "out of memory";
        return RELIEF_OUT_OF_MEMORY;
    } catch (const std::exception& error) {
        call_message.set(error.what());
        return RELIEF_FAILED;
    } catch (...) {
        call_message.shown = "unknown error";
        return RELIEF_FAILED;
    }
}

NormalMapFormat normal_map_format(std::int32_t green, std::int32_t flat, std::int32_t dither,
                                  const relief_output_image& map) {
    return {.bits = view_of(map, "normal map").bits(),
            .green = enumerator(green, greens, "green"),
            .flat = enumerator(flat, flat_codes, "flat"),
            .dither = enumerator(dither, dithers, "dither")};
}

FormatNumbers numbers_of(const NormalMapFormat& format) {
    return {number_of(format.green, greens), number_of(format.flat, flat_codes),
            number_of(format.dither, dithers)};
}

Execution::Execution(const relief_execution* execution)
    : progress_([this, execution](const Progress::State& state) {
          const double fraction = state.part.value_or(-1.0);
          if (execution->progress(execution->user, state.stage.c_str(), fraction) != 0)
              progress_.cancel();
      }) {
    const relief_execution given = read_struct(execution, {}, "relief_execution");
    check_reserved(given.reserved, "relief_execution");
    options_ = {.threads = given.threads, .progress = given.progress ? &progress_ : nullptr};
}

std::size_t Extent::checked_stride(std::size_t alignment) const {
    const std::size_t distance = stride == 0 ? size : stride;
    if (count == 0) return distance;
    if (data == nullptr) throw InvalidInput(fmt::format("the {} are NULL", name));
    if (address(data) % alignment != 0 || distance % alignment != 0) {
        throw InvalidInput(
            fmt::format("the {} are at the address {:#x} with the stride {}, but both must be "
                        "multiples of {}",
                        name, address(data), distance, alignment));
    }
    if (distance < size) {
        throw InvalidInput(
            fmt::format("the stride of the {} is {} bytes, but must be at least {}, or 0 for "
                        "contiguous elements",
                        name, distance, size));
    }
    if (count > (std::numeric_limits<std::uintptr_t>::max() - address(data)) / distance)
        throw InvalidInput(fmt::format("{} {} do not fit into memory", count, name));
    return distance;
}

void check_apart(const Extent& output, const Extent& other) {
    if (output.count == 0 || other.count == 0 || other.data == nullptr) return;
    const std::size_t stride = output.stride == 0 ? output.size : output.stride;
    const std::size_t other_stride = other.stride == 0 ? other.size : other.stride;
    const std::uintptr_t begin = address(output.data), other_begin = address(other.data);
    if (begin >= other_begin + (other.count - 1) * other_stride + other.size ||
        other_begin >= begin + (output.count - 1) * stride + output.size)
        return;
    if (stride == other_stride) {
        const std::size_t shift = begin <= other_begin
                                      ? (other_begin - begin) % stride
                                      : (stride - (begin - other_begin) % stride) % stride;
        if (shift >= output.size && stride - shift >= other.size) return;
    }
    throw InvalidInput(fmt::format("the {} overlap the {}", output.name, other.name));
}

CMesh::CMesh(const relief_mesh* mesh) : mesh_{} {
    if (mesh == nullptr) throw InvalidInput("the mesh is NULL");
    mesh_ = read_struct(mesh, {}, "relief_mesh");
    check_reserved(mesh_.reserved, "relief_mesh");
    const bool is_short = mesh_.index_type == RELIEF_INDEX_UINT16;
    constexpr std::array<std::size_t, 3> index_sizes = {4, 4, 2};
    const std::size_t index_size = enumerator(mesh_.index_type, index_sizes, "index_type");
    if (mesh_.triangle_count > std::numeric_limits<std::size_t>::max() / (3 * index_size))
        throw InvalidInput(
            fmt::format("{} triangles do not fit into memory", mesh_.triangle_count));
    static_cast<void>(indices().checked_stride(index_size));
    const std::size_t corners = 3 * mesh_.triangle_count;
    triangles_ =
        is_short
            ? TriangleSpan(std::span(static_cast<const std::uint16_t*>(mesh_.indices), corners))
            : TriangleSpan(std::span(static_cast<const std::uint32_t*>(mesh_.indices), corners));
}

Extent CMesh::indices() const {
    const std::size_t size = mesh_.index_type == RELIEF_INDEX_UINT16 ? 2 : 4;
    return {"indices", mesh_.indices, 3 * mesh_.triangle_count, size, 0};
}

Extent CMesh::position_extent() const {
    return {"positions", mesh_.positions, mesh_.vertex_count, sizeof(glm::vec3),
            mesh_.position_stride};
}

Extent CMesh::normal_extent() const {
    return {"normals", mesh_.normals, mesh_.vertex_count, sizeof(glm::vec3), mesh_.normal_stride};
}

Extent CMesh::texcoord_extent() const {
    return {"texture coordinates", mesh_.texcoords, mesh_.vertex_count, sizeof(glm::vec2),
            mesh_.texcoord_stride};
}

StridedSpan<const glm::vec3> CMesh::positions() const {
    return {mesh_.positions, mesh_.vertex_count, position_extent().checked_stride(sizeof(float))};
}

StridedSpan<const glm::vec3> CMesh::normals() const {
    return {mesh_.normals, mesh_.vertex_count, normal_extent().checked_stride(sizeof(float))};
}

StridedSpan<const glm::vec2> CMesh::texcoords() const {
    return {mesh_.texcoords, mesh_.vertex_count, texcoord_extent().checked_stride(sizeof(float))};
}

namespace {

template <typename Value>
std::vector<Value> copied(StridedSpan<const Value> values) {
    std::vector<Value> copy(values.size());
    for (std::size_t i = 0; i < copy.size(); ++i)
        copy[i] = values[i];
    return copy;
}

}  // namespace

Mesh CMesh::copy() const {
    Mesh mesh;
    mesh.positions = copied(positions());
    if (mesh_.normals) mesh.normals = copied(normals());
    if (mesh_.texcoords) mesh.texcoords = copied(texcoords());
    if (mesh_.tangents) {
        const Extent extent{"tangents", mesh_.tangents, mesh_.vertex_count, sizeof(glm::vec4),
                            mesh_.tangent_stride};
        mesh.tangents = copied(StridedSpan<const glm::vec4>(mesh_.tangents, mesh_.vertex_count,
                                                            extent.checked_stride(sizeof(float))));
    }
    mesh.triangles.resize(triangles_.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        mesh.triangles[i] = triangles_[i];
    return mesh;
}

namespace {

/// Returns the bytes of a row. \throws InvalidInput if the image is not as documented
std::size_t checked_row_size(const relief_image& image, const char* name) {
    const std::size_t sample = enumerator(image.sample_type, sample_sizes, "sample_type");
    if (image.pixels == nullptr) throw InvalidInput(fmt::format("the {} is NULL", name));
    constexpr std::int32_t max_size = 1 << 24;
    if (image.width < 1 || image.height < 1 || image.width > max_size || image.height > max_size) {
        throw InvalidInput(fmt::format("the {} has {} x {} texels, but must have 1 to {} each",
                                       name, image.width, image.height, max_size));
    }
    if (image.channels < 1 || image.channels > 4) {
        throw InvalidInput(
            fmt::format("the {} has {} channels, but must have 1 to 4", name, image.channels));
    }
    const std::size_t row =
        sample * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    // The absolute value, also of the smallest number.
    const auto stride = static_cast<std::size_t>(image.row_stride);
    const std::size_t distance = image.row_stride < 0 ? 0 - stride : stride;
    if (address(image.pixels) % sample != 0 || distance % sample != 0) {
        throw InvalidInput(
            fmt::format("the {} is at the address {:#x} with the row stride {}, but both must be "
                        "multiples of {}",
                        name, address(image.pixels), image.row_stride, sample));
    }
    const std::size_t used = distance == 0 ? row : distance;
    if (used < row) {
        throw InvalidInput(fmt::format("the row stride of the {} is {} bytes, but a row has {}",
                                       name, image.row_stride, row));
    }
    if (used > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) /
                   static_cast<std::size_t>(image.height))
        throw InvalidInput(fmt::format("the {} does not fit into memory", name));
    return row;
}

relief_image read_only(const relief_output_image& image) {
    return {image.pixels, image.row_stride, image.width,
            image.height, image.channels,   image.sample_type};
}

/// The memory of all rows.
Extent extent_of(const relief_image& image, const char* name) {
    const std::size_t row = checked_row_size(image, name);
    if (image.row_stride >= 0) {
        return {name, image.pixels, static_cast<std::size_t>(image.height), row,
                static_cast<std::size_t>(image.row_stride)};
    }
    const auto* const first = static_cast<const std::byte*>(image.pixels);
    return {name, first + image.row_stride * (image.height - 1),
            static_cast<std::size_t>(image.height), row,
            static_cast<std::size_t>(-image.row_stride)};
}

/// Returns View(pixels of the sample type, ...).
template <typename View, typename AnyImage>
View checked_view(const AnyImage& image, const relief_image& readable, const char* name) {
    static_cast<void>(checked_row_size(readable, name));
    constexpr bool is_const = std::is_same_v<View, ImageView>;
    const auto viewed = [&]<typename Sample>(Sample) {
        using Access = std::conditional_t<is_const, const Sample, Sample>;
        return View(static_cast<Access*>(image.pixels), image.width, image.height, image.channels,
                    image.row_stride);
    };
    if (image.sample_type == RELIEF_SAMPLE_UINT8) return viewed(std::uint8_t{});
    if (image.sample_type == RELIEF_SAMPLE_UINT16) return viewed(std::uint16_t{});
    return viewed(float{});
}

}  // namespace

ImageView view_of(const relief_image* image, const char* name) {
    if (image == nullptr) throw InvalidInput(fmt::format("the {} is NULL", name));
    return checked_view<ImageView>(*image, *image, name);
}

MutableImageView view_of(const relief_output_image& image, const char* name) {
    return checked_view<MutableImageView>(image, read_only(image), name);
}

void check_apart(const relief_output_image& output, const char* output_name,
                 const relief_image& other, const char* other_name) {
    check_apart(extent_of(read_only(output), output_name), extent_of(other, other_name));
}

}  // namespace relief::detail

using namespace relief;
using namespace relief::detail;

const char* relief_version() {
    return RELIEF_VERSION;
}

const char* relief_last_error() {
    return call_message.shown;
}

relief_status relief_finding_init(relief_finding* finding, size_t size) {
    return init_struct(finding, size, {}, "relief_finding");
}

relief_status relief_execution_init(relief_execution* execution, size_t size) {
    return init_struct(execution, size, {}, "relief_execution");
}

relief_status relief_mesh_init(relief_mesh* mesh, size_t size) {
    return init_struct(mesh, size, {}, "relief_mesh");
}

relief_report* relief_report_create() {
    return new (std::nothrow) relief_report;
}

void relief_report_destroy(relief_report* report) {
    delete report;
}

void relief_report_clear(relief_report* report) {
    if (report == nullptr) return;
    report->report = {};
    report->texts.clear();
}

size_t relief_report_count(const relief_report* report) {
    return report == nullptr ? 0 : report->report.findings().size();
}

relief_status relief_report_finding(relief_report* report, size_t index, relief_finding* finding) {
    return guarded([&] {
        if (report == nullptr || finding == nullptr)
            throw InvalidInput(report == nullptr ? "the report is NULL" : "the finding is NULL");
        const std::span<const Finding> findings = report->report.findings();
        if (index >= findings.size()) {
            throw InvalidInput(
                fmt::format("there is no finding {}, but only {}", index, findings.size()));
        }
        const Finding& found = findings[index];
        if (report->texts.size() <= index) report->texts.resize(index + 1);
        std::string& text = report->texts[index];
        std::string current = to_string(found);
        if (text != current) text = std::move(current);
        write_struct(finding,
                     {.size = 0,
                      .text = text.c_str(),
                      .kind = found.kind.c_str(),
                      .element = found.element.c_str(),
                      .outcome = found.outcome.c_str(),
                      .count = found.count,
                      .first = found.first.data(),
                      .first_count = found.first.size()},
                     "relief_finding");
    });
}
