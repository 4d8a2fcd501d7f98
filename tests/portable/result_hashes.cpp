// SPDX-License-Identifier: Apache-2.0
// Prints a hash of the results of each part of relief::mesh, relief::topology and relief::atlas.
// The lines must be equal for all systems, compilers and numbers of threads:
// scripts/dev/try-windows compares them.
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "relief/mesh/block_compression.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/curvature.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"
#include "relief/mesh/topology.h"
#include "relief/mesh/unwrap.h"
#include "support/images.h"

namespace relief {
namespace {

/// FNV-1a.
class Hash {
  public:
    template <typename Value>
    void add(const std::vector<Value>& values) {
        for (const std::byte byte : std::as_bytes(std::span(values)))
            hash_ = (hash_ ^ std::to_integer<std::uint64_t>(byte)) * 1099511628211U;
    }
    void add(const Mesh& mesh) {
        add(mesh.positions);
        add(mesh.normals);
        add(mesh.texcoords);
        add(mesh.tangents);
        add(mesh.triangles);
    }
    void add(const Image& image) {
        std::visit([&](const auto& samples) { add(samples); }, image.samples);
    }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 14695981039346656037U;
};

template <typename... Results>
void print(std::string_view name, const Results&... results) {
    Hash hash;
    (hash.add(results), ...);
    std::fputs(fmt::format("{:<28}{:016x}\n", name, hash.value()).c_str(), stdout);
}

void print_meshes() {
    const Mesh torus = make_torus(0.4F, 160, 80);
    print("torus", torus);
    for (const auto& weight : enum_names<NormalWeight>)
        print(fmt::format("vertex normals {}", weight.name),
              vertex_normals(torus.positions, torus.triangles, weight.value));
    print("mikktspace tangents",
          mikktspace_tangents(torus.positions, torus.normals, torus.texcoords, torus.triangles));
    std::vector<glm::vec4> tangents(torus.positions.size());
    vertex_tangents(torus.positions, torus.normals, torus.texcoords, torus.triangles, tangents);
    print("vertex tangents", tangents);
    DecimateOptions options;
    options.triangles = torus.triangles.size() / 10;
    print("decimation", decimated(torus, options).mesh);
    print("subdivision", subdivided(make_torus(0.4F, 20, 10), 2, {}));
    print("unwrapping", unwrap(make_torus(0.4F, 60, 30)).corner_texcoords);
}

void print_images() {
    const Image heights = test::rough(300, 200);
    for (const auto& kernel : enum_names<Kernel>) {
        BumpOptions options;
        options.kernel = kernel.value;
        options.strength = 4.0;
        print(fmt::format("normal map {}", kernel.name),
              normal_map_from_height(heights, options, {.bits = 8}));
    }
    const Image normals = normals_from_height(heights, {.strength = 2.0});
    for (const Image& level : normal_mip_levels(normals))
        print(fmt::format("mip level {}", level.width), level);
    const Image map = encode_normal_map(normals, {.bits = 8});
    print("bc5 blocks", encode_normal_blocks(normals, {}));
    print("bc7 blocks", encode_bc7(map, BlockQuality::normal));
}

}  // namespace
}  // namespace relief

int main() {
    relief::print_meshes();
    relief::print_images();
}
