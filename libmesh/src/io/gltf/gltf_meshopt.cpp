// SPDX-License-Identifier: Apache-2.0
// Decoding meshopt's buffer views: all modes and filters. The only file that knows meshoptimizer.
//
// meshoptimizer checks the data but not the parameters, so those are checked here, before anything
// is allocated: what a view claims is held against the most that its bytes could stand for. What
// 0.18 does not know is meshopt_bitstream.h's. Source: the glTF
// extensions EXT_meshopt_compression and KHR_meshopt_compression. Tests:
// tests/mesh/io/gltf/gltf_meshopt_test.cpp.
#include "io/gltf/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "io/gltf/gltf_edit.h"
#include "io/gltf/meshopt_bitstream.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// The parameters of one compressed view, and its bytes.
struct PackedView {
    std::string mode;
    std::string filter;
    std::size_t count = 0;
    std::size_t stride = 0;
    std::string_view bytes;
};

PackedView packed_view(const GltfContents& contents, const Json& packed) {
    const std::string_view buffer = contents.buffers[size_in(packed, "buffer")].bytes();
    const std::size_t offset = size_in(packed, "byteOffset");
    const std::size_t length = size_in(packed, "byteLength");
    if (offset + length > buffer.size()) fail_gltf("its data lies in a buffer without data");
    PackedView view;
    view.mode = text_in(packed, "mode");
    view.filter = packed.contains("filter") ? text_in(packed, "filter") : "NONE";
    view.count = size_in(packed, "count");
    view.stride = size_in(packed, "byteStride");
    view.bytes = buffer.substr(offset, length);
    return view;
}

/// That the stride is one that the mode and the filter can have.
void check_stride(const PackedView& view) {
    const std::size_t stride = view.stride;
    bool fits = false;
    if (view.mode == "ATTRIBUTES") {
        fits = stride % 4 == 0 && stride >= 4 && stride <= 256;
        if (view.filter == "OCTAHEDRAL" || view.filter == "COLOR") {
            fits = stride == 4 || stride == 8;
        } else if (view.filter == "QUATERNION") {
            fits = stride == 8;
        } else if (view.filter != "EXPONENTIAL" && view.filter != "NONE") {
            fail_gltf("its filter is '{}'", view.filter);
        }
    } else if (view.mode == "TRIANGLES" || view.mode == "INDICES") {
        if (view.filter != "NONE") fail_gltf("{} have no filter {}", view.mode, view.filter);
        fits = stride == 2 || stride == 4;
    } else {
        fail_gltf("its mode is '{}'", view.mode);
    }
    if (!fits) fail_gltf("{} with filter {} have no stride of {}", view.mode, view.filter, stride);
    if (view.mode == "TRIANGLES" && view.count % 3 != 0)
        fail_gltf("{} indices make no whole triangles", view.count);
}

/// That so few bytes could stand for so many.
void check_claim(const PackedView& view, std::size_t length) {
    // The most that a byte can stand for: in version 1 of the attributes, one control byte for four
    // byte positions of 256 elements that are all alike.
    constexpr std::size_t most_bytes_per_byte = 1024;
    // Both are below 2^53, and strides below 2^9 by now: nothing wraps.
    if (view.count > length || view.count * view.stride != length) {
        fail_gltf("{} elements of {} bytes are not the {} bytes of the view", view.count,
                  view.stride, length);
    }
    if (length / most_bytes_per_byte > view.bytes.size())
        fail_gltf("{} bytes cannot stand for {}", view.bytes.size(), length);
}

bool decode_view(const PackedView& view, std::string& elements) {
    const auto* data = reinterpret_cast<const unsigned char*>(view.bytes.data());
    const std::size_t size = view.bytes.size();
    if (view.mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(elements.data(), view.count, view.stride, data, size) == 0;
    if (view.mode == "INDICES") {
        return meshopt_decodeIndexSequence(elements.data(), view.count, view.stride, data, size) ==
               0;
    }
    if (size > 0 && data[0] == meshopt_attributes_v1)
        return decode_meshopt_attributes_v1(view.bytes, view.count, view.stride, elements);
    return meshopt_decodeVertexBuffer(elements.data(), view.count, view.stride, data, size) == 0;
}

void unfilter(const PackedView& view, std::string& elements) {
    if (view.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(elements.data(), view.count, view.stride);
    } else if (view.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(elements.data(), view.count, view.stride);
    } else if (view.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(elements.data(), view.count, view.stride);
    } else if (view.filter == "COLOR") {
        decode_meshopt_colors(elements, view.stride);
    }
}

std::string unpacked_bytes(const PackedView& view, std::size_t length) {
    check_stride(view);
    check_claim(view, length);
    std::string elements(length, '\0');
    if (length == 0) return elements;
    if (!decode_view(view, elements)) fail_gltf("its data is damaged");
    unfilter(view, elements);
    return elements;
}

/// The name of the extension that compresses a view, or null.
const char* extension_of(const Json& view) {
    for (const char* extension : meshopt_extensions) {
        if (find(view, "extensions", extension) != nullptr) return extension;
    }
    return nullptr;
}

/// Replaces one view by its decoded form.
void unpack_view(GltfContents& contents, std::size_t number, const char* extension) {
    const Json packed = contents.root["bufferViews"][number]["extensions"][extension];
    const std::size_t length = size_in(contents.root["bufferViews"][number], "byteLength");
    std::string elements;
    try {
        elements = unpacked_bytes(packed_view(contents, packed), length);
    } catch (const InvalidInput& error) {
        fail_gltf("bufferViews[{}].extensions.{}: {}", number, extension, error.what());
    }
    const std::size_t offset = append_bytes(contents, elements);
    Json& view = contents.root["bufferViews"][number];
    view["buffer"] = contents.added_buffer;
    view["byteOffset"] = offset;
    erase_extension(view, extension);
    const std::size_t begin = size_in(packed, "byteOffset");
    contents.retired_bytes.push_back(
        {size_in(packed, "buffer"), begin, begin + size_in(packed, "byteLength")});
    ++contents.unpacked[extension];
}

bool says_fallback(const Json& buffer) {
    for (const char* extension : meshopt_extensions) {
        const Json* fallback = find(buffer, "extensions", extension, "fallback");
        if (fallback != nullptr && *fallback == true) return true;
    }
    return false;
}

}  // namespace

std::vector<bool> meshopt_placeholders(const Json& root, bool has_binary_chunk) {
    const Json& buffers = array_in(root, "buffers");
    std::vector<bool> has_views(buffers.size(), false);
    std::vector<bool> needs_data(buffers.size(), false);
    for (const Json& view : array_in(root, "bufferViews")) {
        const std::size_t buffer = size_in(view, "buffer");
        const char* extension = extension_of(view);
        has_views[buffer] = true;
        if (extension == nullptr)
            needs_data[buffer] = true;
        else
            needs_data[size_in(view["extensions"][extension], "buffer")] = true;
    }
    std::vector<bool> result(buffers.size(), false);
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const bool is_chunk = i == 0 && has_binary_chunk && !says_fallback(buffers[i]);
        result[i] = !buffers[i].contains("uri") && !is_chunk && has_views[i] && !needs_data[i];
    }
    return result;
}

void unpack_meshopt(GltfContents& contents) {
    std::vector<std::size_t> packed_views;
    std::size_t total = 0;
    const Json& views = array_in(contents.root, "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (!contents.buffers[size_in(views[i], "buffer")].is_placeholder) continue;
        packed_views.push_back(i);
        total += size_in(views[i], "byteLength");
    }
    if (packed_views.empty()) return;
    std::size_t packed_size = 0;
    for (const GltfBuffer& buffer : contents.buffers)
        packed_size += buffer.size;
    // At once, but no more than the data at hand may call for.
    reserve_bytes(contents, std::min(total, 16 * packed_size));
    ProgressStage stage("unpacking", packed_views.size());
    for (const std::size_t i : packed_views) {
        unpack_view(contents, i, extension_of(contents.root["bufferViews"][i]));
        stage.advance(1);
    }
    for (const char* extension : meshopt_extensions) {
        for (std::size_t i = 0; i < contents.buffers.size(); ++i) {
            if (contents.buffers[i].is_placeholder)
                erase_extension(contents.root["buffers"][i], extension);
        }
        forget_if_unused(contents.root, extension);
    }
}

}  // namespace relief
