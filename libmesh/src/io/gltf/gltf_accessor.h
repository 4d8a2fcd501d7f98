// SPDX-License-Identifier: Apache-2.0
/// \file
/// Elements of glTF accessors: as raw bytes, as floats, as indices.
///
/// Sparse substitutions are applied, integers that stand for fractions divided. The document must
/// have passed check_gltf. Source: glTF 2.0 (ISO/IEC 12113), section 3.6.2.
/// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include <cstdint>
#include <glm/ext/vector_float1.hpp>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/gltf_contents.h"

namespace relief {

/// Numeric codes that glTF takes over from OpenGL.
namespace gltf_code {
inline constexpr int int8 = 5120;
inline constexpr int uint8 = 5121;
inline constexpr int int16 = 5122;
inline constexpr int uint16 = 5123;
inline constexpr int uint32 = 5125;
inline constexpr int float32 = 5126;
inline constexpr int array_buffer = 34962;
inline constexpr int element_array_buffer = 34963;
}  // namespace gltf_code

/// Bytes of one component; 0 for a code that glTF does not know.
std::size_t component_size(int component_type);

/// Components of a type such as "VEC3"; 0 for one that glTF does not know.
std::size_t component_count(std::string_view type);

/// How one element of an accessor lies in memory.
struct ElementLayout {
    int component_type = 0;
    std::size_t components = 0;
    std::size_t size = 0;  ///< Bytes, with the padding between matrix columns.
};
ElementLayout element_layout(const Json& accessor);

/// The same of an accessor that holds indices. \throws InvalidInput if it cannot
ElementLayout index_layout(const GltfContents& contents, std::size_t accessor);

/// All elements, tightly packed: in the buffer itself where they lie so, else in a copy.
struct PackedElements {
    std::string copy;
    std::string_view in_buffer;

    [[nodiscard]] std::string_view bytes() const { return copy.empty() ? in_buffer : copy; }
};

/// \throws InvalidInput if a sparse index is out of range
PackedElements packed_elements(const GltfContents& contents, std::size_t accessor);

/// The same, as a copy in any case.
std::string raw_elements(const GltfContents& contents, std::size_t accessor);

/// All elements as vectors of floats. \throws InvalidInput if they have another number of
/// components, or as raw_elements
template <typename Vector>
std::vector<Vector> float_elements(const GltfContents& contents, std::size_t accessor);

/// All elements as numbers. \throws InvalidInput if they are not scalar unsigned integers
std::vector<std::uint32_t> index_elements(const GltfContents& contents, std::size_t accessor);

/// The same, three by three. \throws InvalidInput also if there is a rest
std::vector<glm::uvec3> index_triples(const GltfContents& contents, std::size_t accessor);

}  // namespace relief
