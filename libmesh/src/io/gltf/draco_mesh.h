// SPDX-License-Identifier: Apache-2.0
/// \file
/// A triangle mesh that Draco has compressed: decoded, in plain arrays.
///
/// Tests: tests/mesh/io/gltf/gltf_draco_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// Types of numbers that glTF and Draco have in common.
enum class DracoComponent { int8, uint8, int16, uint16, uint32, float32 };

class DracoMesh {
  public:
    /// Decodes; quantised attributes come out as the numbers they stand for.
    /// \throws InvalidInput if the data is damaged or holds points without triangles
    explicit DracoMesh(std::string_view bytes);
    DracoMesh(DracoMesh&&) noexcept;
    DracoMesh& operator=(DracoMesh&&) noexcept;
    ~DracoMesh();

    [[nodiscard]] std::size_t vertex_count() const;

    /// Three for every triangle. \throws InvalidInput if one names a vertex that does not exist
    [[nodiscard]] std::vector<std::uint32_t> indices() const;

    /// An attribute by the number that it keeps for good: for every vertex, `components` numbers
    /// of a type, packed. Where Draco stores another type, numbers are converted by value.
    /// \throws InvalidInput if there is no such attribute, if it has another number of components,
    ///         or if a number does not fit
    [[nodiscard]] std::string attribute(std::uint32_t unique_id, std::size_t components,
                                        DracoComponent component) const;

  private:
    struct Decoded;
    std::unique_ptr<Decoded> decoded_;
};

}  // namespace relief
