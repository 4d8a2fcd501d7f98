// SPDX-License-Identifier: Apache-2.0
/// \file
/// Accessors and primitives of a glTF document as plain arrays.
///
/// Sparse substitutions are applied and normalized integers become fractions. The document must
/// have passed check_gltf(). Source: glTF 2.0 (ISO/IEC 12113), section 3.6.2.
#pragma once

#include <cstdint>
#include <glm/ext/vector_float1.hpp>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"

namespace relief::detail {

/// Numeric codes that glTF takes from OpenGL.
namespace gltf_code {
inline constexpr int int8 = 5120;
inline constexpr int uint8 = 5121;
inline constexpr int int16 = 5122;
inline constexpr int uint16 = 5123;
inline constexpr int uint32 = 5125;
inline constexpr int float32 = 5126;
inline constexpr int array_buffer = 34962;
inline constexpr int element_array_buffer = 34963;
inline constexpr std::size_t triangles = 4;
inline constexpr std::size_t triangle_strip = 5;
inline constexpr std::size_t triangle_fan = 6;
}  // namespace gltf_code

/// Bytes of one component; 0 for an unknown code.
std::size_t component_size(int component_type);

/// Components of a type such as "VEC3"; 0 for an unknown type.
std::size_t component_count(std::string_view type);

/// The memory layout of one element of an accessor.
struct ElementLayout {
    int component_type = 0;
    std::size_t components = 0;
    std::size_t size = 0;  ///< Bytes, including padding between matrix columns.
};
ElementLayout element_layout(const Json& accessor);

/// Returns the layout of an accessor of indices. \throws InvalidInput if it is not of scalar
/// unsigned integers
ElementLayout index_layout(const GltfContents& contents, std::size_t accessor);

/// All elements, tightly packed: a view of the buffer if they are packed there, otherwise a copy.
struct PackedElements {
    std::string copy;
    std::string_view in_buffer;

    [[nodiscard]] std::string_view bytes() const { return copy.empty() ? in_buffer : copy; }
};

/// \throws InvalidInput if a sparse index is out of range
PackedElements packed_elements(const GltfContents& contents, std::size_t accessor);

/// Like packed_elements(), but always a copy.
std::string raw_elements(const GltfContents& contents, std::size_t accessor);

/// Returns all elements as vectors of floats. \throws InvalidInput if the number of components
/// differs, or as packed_elements()
template <typename Vector>
std::vector<Vector> float_elements(const GltfContents& contents, std::size_t accessor);

/// Returns some elements, in the order of `chosen`, whose numbers must be below the count. Costs
/// nothing for the others, unless the accessor is sparse.
template <typename Vector>
std::vector<Vector> float_elements(const GltfContents& contents, std::size_t accessor,
                                   std::span<const std::uint32_t> chosen);

/// Returns all elements as indices. \throws InvalidInput if they are not scalar unsigned integers
std::vector<std::uint32_t> index_elements(const GltfContents& contents, std::size_t accessor);

/// Returns all elements as triangles. \throws InvalidInput also if the count is not a multiple of 3
std::vector<glm::uvec3> index_triples(const GltfContents& contents, std::size_t accessor);

const Json& primitive_json(const GltfContents& contents, GltfPrimitiveId id);

/// See GltfDocument::describe().
std::string describe_primitive(const GltfContents& contents, GltfPrimitiveId id);

/// \throws InvalidInput if an attribute or a morph target has another number of elements
void check_counts(const GltfContents& contents, const Json& primitive, std::size_t vertex_count);

/// Returns true if other primitives have the same POSITION.
bool shares_vertices(const GltfContents& contents, const Json& primitive);

/// The triangles of a primitive over the vertices of its accessors, and the vertices that its mesh
/// has.
struct GltfTriangles {
    std::vector<glm::uvec3> triangles;  ///< Indices into the accessors' elements.
    std::size_t vertex_count = 0;       ///< Element count of the accessors.
    /// Vertices that the primitive uses, ascending. Set only if it shares POSITION with others and
    /// does not use all vertices. The mesh then has only these.
    std::optional<std::vector<std::uint32_t>> used;
};

/// \throws InvalidInput if indices are out of range or their count is not a multiple of 3, or if
///         attributes differ in length
GltfTriangles read_triangles(const GltfContents& contents, GltfPrimitiveId id);

}  // namespace relief::detail
