// SPDX-License-Identifier: Apache-2.0
// Hits of rays from the eye, and frames, matrices and textures of a scene with the attributes and
// normals at a hit, in double. Embree gets the scene divided by the camera's far distance, so that
// no scale is too large or too small for its floats. Normals are transformed by the matrix of
// cofactors, which for a singular matrix is the limit of the inverse transpose. The basis of a map
// is used as interpolated, neither normalized nor orthogonalized, as MikkTSpace requires [Mikkelsen
// 2008]; heights bend the normal as in [Blinn 1978].
#include "reference/reference_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "bake/embree_scene.h"
#include "effects/light_rows.h"
#include "geometry/direction.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/map_kind_check.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/reference.h"
#include "relief/shade/scene_file.h"
#include "render/textures.h"
#include "scene/scene_parts.h"

namespace relief::shade::reference {
using namespace relief::detail;
using namespace relief::shade::detail;

// Rays from the eye

Visibility::Visibility(std::vector<ViewMesh> meshes, const Camera& camera)
    : meshes_(std::move(meshes)),
      near_(static_cast<double>(camera.near)),
      far_(static_cast<double>(camera.far)),
      is_orthographic_(camera.orthographic_height.has_value()) {
    const double reach = is_orthographic_ ? std::max(far_, half_height(camera)) : far_;
    embree_ =
        std::make_unique<EmbreeScene>(EmbreeSpace{glm::dvec3(0.0), reach}, SceneBuild::thorough);
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        if (meshes_[i].triangles.empty()) continue;
        embree_->add(static_cast<std::uint32_t>(i), meshes_[i].positions_view,
                     meshes_[i].triangles);
    }
    embree_->build();
}

Visibility::~Visibility() = default;

/// Tells whether b has the edge or the vertex of a on which the hit a lies: all corners of a whose
/// weights are not 0.
bool Visibility::shares_place(const Hit& a, const Hit& b) const {
    if (a.instance != b.instance) return false;
    const ViewMesh& mesh = meshes_[a.instance];
    const glm::uvec3& corners = mesh.triangles[a.triangle];
    const glm::uvec3& others = mesh.triangles[b.triangle];
    for (int i = 0; i < 3; ++i) {
        if (a.barycentric[i] == 0.0) continue;
        const glm::dvec3& position = mesh.positions_view[corners[i]];
        if (position != mesh.positions_view[others.x] &&
            position != mesh.positions_view[others.y] && position != mesh.positions_view[others.z])
            return false;
    }
    return true;
}

/// Tells whether a hit on an edge or a vertex repeats an earlier hit there.
bool Visibility::is_repeated(const std::vector<Hit>& all, std::size_t index) const {
    const glm::dvec3& weights = all[index].barycentric;
    if (weights.x != 0.0 && weights.y != 0.0 && weights.z != 0.0) return false;
    return std::any_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(index),
                       [&](const Hit& before) { return shares_place(all[index], before); });
}

std::vector<Hit> Visibility::hits(double x, double y) const {
    const glm::dvec3 origin = is_orthographic_ ? glm::dvec3(x, y, 0.0) : glm::dvec3(0.0);
    const glm::dvec3 direction = glm::dvec3(x, y, -1.0) - origin;
    // The search range is slightly larger; the exact depth decides below.
    std::vector<MetTriangle> candidates;
    embree_->find_all({origin, direction, 0.999 * near_, 1.001 * far_}, candidates);

    const RayFrame ray = frame_of(origin, direction);
    std::vector<Hit> all;
    for (const MetTriangle& met : candidates) {
        const std::array<glm::dvec3, 3> corners = embree_->corners(met);
        ExactHit exact;
        if (!intersect(ray, corners, exact)) continue;
        Hit hit{met.mesh, met.triangle};
        hit.barycentric = exact.weights;
        hit.counter_clockwise = exact.faces_origin;
        for (int i = 0; i < 3; ++i)
            hit.depth -= exact.weights[i] * corners[static_cast<std::size_t>(i)].z;
        if (hit.depth >= near_ && hit.depth <= far_) all.push_back(hit);
    }
    std::sort(all.begin(), all.end(), [](const Hit& a, const Hit& b) {
        return std::tie(a.depth, a.instance, a.triangle) <
               std::tie(b.depth, b.instance, b.triangle);
    });
    std::vector<Hit> once;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!is_repeated(all, i)) once.push_back(all[i]);
    }
    return once;
}

// Shadows

ShadowCasters::ShadowCasters(ShadowView view, std::vector<ViewMesh> meshes)
    : view_(std::move(view)),
      embree_(std::make_unique<EmbreeScene>(EmbreeSpace{view_.center_world, view_.radius},
                                            SceneBuild::thorough)) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (!meshes[i].triangles.empty())
            embree_->add(static_cast<std::uint32_t>(i), meshes[i].positions_view,
                         meshes[i].triangles);
    }
    embree_->build();
}

ShadowCasters::~ShadowCasters() = default;

std::vector<Hit> ShadowCasters::between(const glm::dvec3& position_world,
                                        const glm::dvec2& point) const {
    const glm::dvec3 to_light = view_.to_light(position_world, point);
    std::vector<MetTriangle> met;
    embree_->find_all({position_world, to_light, 0.0, 1.0}, met);
    const RayFrame ray = frame_of(position_world, to_light);
    std::vector<Hit> hits;
    for (const MetTriangle& triangle : met) {
        ExactHit exact;
        if (!intersect(ray, embree_->corners(triangle), exact)) continue;
        Hit hit{triangle.mesh, triangle.triangle};
        hit.barycentric = exact.weights;
        hit.counter_clockwise = !exact.faces_origin;  // As the light sees it.
        hits.push_back(hit);
    }
    return hits;
}

// Prepared scenes

namespace {

const Material& material_of_range(const std::vector<Material>& materials,
                                  const MaterialRange& range) {
    return range.material ? materials[*range.material] : default_material();
}

bool is_anisotropic(const Material& material) {
    return material.metallic_roughness && material.metallic_roughness->anisotropy > 0.0F;
}

/// Returns the normal map of the material's clear coat.
std::optional<NormalMap> coat_map(const Material& material) {
    return material.metallic_roughness ? material.metallic_roughness->clearcoat_normal_map
                                       : std::nullopt;
}

bool uses_stored_tangents(const Material& material) {
    if (material.tangent_frame != TangentFrame::stored) return false;
    return material.bump_map || is_anisotropic(material) || coat_map(material) ||
           (material.normal_map && material.normal_map->space == NormalSpace::tangent);
}

bool needs_tangents(const std::vector<Material>& materials, const Mesh& mesh) {
    if (mesh.texcoords.empty() || !mesh.tangents.empty()) return false;
    return std::any_of(mesh.material_ranges.begin(), mesh.material_ranges.end(),
                       [&](const MaterialRange& range) {
                           return uses_stored_tangents(material_of_range(materials, range));
                       });
}

/// Returns the mesh at rest with the frames that materials need.
FramedMesh framed_mesh(const std::vector<Material>& materials, const Mesh& mesh, Report& report) {
    FrameOptions options;
    if (needs_tangents(materials, mesh)) options.tangents = TangentMethod::mikktspace;
    const bool complete = !mesh.normals.empty() && options.tangents == TangentMethod::keep;
    if (!complete) return with_frames(mesh, options, report);
    FramedMesh framed;
    framed.mesh = mesh;
    return framed;
}

/// The matrix of normals, up to a positive factor, and whether the instance is mirrored.
struct NormalMatrix {
    glm::dmat3 matrix;
    bool mirrors = false;
};

NormalMatrix normal_matrix(const glm::dmat3& m) {
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                               glm::cross(m[0], m[1]));
    const bool mirrors = glm::dot(m[0], cofactors[0]) < 0.0;
    return {mirrors ? -cofactors : cofactors, mirrors};
}

PreparedInstance prepared(const Instance& instance, const Mesh& mesh,
                          const glm::dmat4& view_from_world) {
    const glm::dmat4 world_from_object(instance.world_from_object);
    const auto [matrix, mirrors] = normal_matrix(glm::dmat3(world_from_object));
    PreparedInstance result;
    result.mesh = &mesh;
    result.mirrors = mirrors;
    result.world_from_object_normal = matrix;
    for (const glm::vec3& position : mesh.positions) {
        const glm::dvec4 world = world_from_object * glm::dvec4(glm::dvec3(position), 1.0);
        result.positions_world.emplace_back(world);
        result.positions_view.emplace_back(view_from_world * world);
    }
    for (const glm::vec3& normal : mesh.normals)
        result.normals_world.push_back(direction_or_zero(matrix * glm::dvec3(normal)));
    for (const glm::vec4& tangent : mesh.tangents) {
        const glm::dvec3 along =
            direction_or_zero(glm::dmat3(world_from_object) * glm::dvec3(tangent));
        const double w = static_cast<double>(tangent.w);
        result.tangents_world.emplace_back(along, mirrors ? -w : w);
    }
    return result;
}

/// Finds the code of zero of normal maps, and reports normals and heights of another kind.
void examine_maps(PreparedScene& prepared, const Scene& scene, std::uint32_t number,
                  Report& report) {
    const Material& material = prepared.materials[number];
    for (const TextureSlotInfo& slot : texture_slots) {
        const Texture* const texture = find_texture(material, slot.slot);
        const std::vector<MapKind> drawn = drawn_kinds(material, slot.slot);
        if (texture == nullptr || !is_judged_by_texels(drawn)) continue;
        const ImageSource& source = scene.images[texture->image];
        const Image decoded = decode(source, ImageUse::data);
        if (slot.neutral == NeutralTexel::flat) {
            prepared.normal_map_bits[texture->image] = decoded.bits();
            prepared.detected_flat_codes[texture->image] = detected_flat_code(source, decoded);
        }
        const auto content = unstated_content(decoded, stated_description(source));
        const auto wrong = content ? judged_wrong_kind(drawn, *content) : std::nullopt;
        if (wrong) report_drawn_kind(*wrong, slot.slot, drawn.front(), number, report);
    }
}

/// Prepares the relief of a material that has one with a depth.
void prepare_relief(PreparedScene& prepared, const Scene& scene, std::uint32_t number,
                    Report& report) {
    const std::optional<ReliefMap>& map = prepared.materials[number].height_map;
    if (!map || map->depth == 0.0F) return;
    if (map->method == HeightMethod::relaxed_cones && !map->cones) return;
    const Image heights = channel_of(decode(scene.images[map->texture.image], ImageUse::data), 0);
    prepared.reliefs.emplace(
        number, HeightField(heights, {map->texture.wrap_u, map->texture.wrap_v}, report));
}

/// Decodes the textures of all materials that are on meshes with texture coordinates.
void decode_textures(PreparedScene& prepared, const Scene& scene, Report& report) {
    std::set<std::uint32_t> textured;
    for (const Mesh& mesh : scene.meshes) {
        for (const MaterialRange& range : mesh.material_ranges) {
            const bool has_texcoords = !mesh.texcoords.empty() || !mesh.texcoords_2.empty();
            if (has_texcoords && range.material) textured.insert(*range.material);
        }
    }
    for (const std::uint32_t number : textured)
        prepared.texels.request(scene, scene.materials[number]);
    for (const std::uint32_t number : textured) {
        Material& material = prepared.materials[number];
        leave_out_textures(scene, prepared.texels.unreadable(), number, material, report);
        examine_maps(prepared, scene, number, report);
        prepare_relief(prepared, scene, number, report);
    }
}

/// Reports triangles with a vertex that is not finite.
void report_non_finite(const Mesh& mesh, Report& report) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3& corners = mesh.triangles[i];
        for (int corner = 0; corner < 3; ++corner) {
            if (is_finite(mesh.positions[corners[corner]])) continue;
            report.add("vertex that is not finite", "triangle", i, "is not drawn");
            break;
        }
    }
}

}  // namespace

PreparedScene::PreparedScene(const Scene& described, Report& report)
    : scene(described), materials(described.materials) {
    validate(scene);
    if (!scene.camera) throw InvalidInput("the scene has no camera");
    const glm::dmat4 world_from_view(scene.camera->world_from_view);
    eye_world = glm::dvec4(homogeneous_eye(*scene.camera));
    decode_textures(*this, scene, report);
    for (const Mesh& mesh : scene.meshes) {
        meshes.push_back(framed_mesh(materials, mesh, report));
        report_non_finite(mesh, report);
    }
    for (const Instance& instance : scene.instances) {
        const FramedMesh& at_rest = meshes[instance.mesh];
        const Mesh* mesh = &at_rest.mesh;
        if (is_deformed(instance)) {
            Mesh& deformed = deformed_meshes.emplace_back(at_rest.mesh);
            deform(*instance.pose, at_rest.source_vertex, deformed);
            report_non_finite(deformed, report);
            mesh = &deformed;
        }
        instances.push_back(prepared(instance, *mesh, glm::inverse(world_from_view)));
        instances.back().open_shares = of_vertices(instance.open_shares, at_rest.source_vertex);
    }
    if (scene.environment) environment.emplace(*scene.environment, report);
    if (shadow_term(scene) != ShadowTerm::none) {
        std::vector<ViewMesh> casters;
        for (const PreparedInstance& instance : instances)
            casters.push_back({instance.positions_world, instance.mesh->triangles});
        shadow = std::make_unique<ShadowCasters>(*shadow_view(scene), std::move(casters));
    }
    for (const Material& material : materials) {
        const auto& model = material.metallic_roughness;
        if (!model || model->sheen_color == glm::vec3(0.0F)) continue;
        const double roughness = static_cast<double>(model->sheen_roughness);
        if (!model->sheen_roughness_texture) {
            sheen_albedos.try_emplace(model->sheen_roughness, sheen_albedo_table(roughness));
        } else if (!sheen_tables.contains(model->sheen_roughness)) {
            sheen_tables.emplace(model->sheen_roughness, sheen_albedo_tables(roughness));
        }
    }
}

const HeightField* PreparedScene::relief_of(std::uint32_t instance, std::uint32_t triangle) const {
    const auto& ranges = instances[instance].mesh->material_ranges;
    if (ranges.empty()) return nullptr;
    const std::optional<std::uint32_t> material = ranges[range_of(instance, triangle)].material;
    const auto relief = material ? reliefs.find(*material) : reliefs.end();
    return relief == reliefs.end() ? nullptr : &relief->second;
}

std::size_t PreparedScene::range_of(std::uint32_t instance, std::uint32_t triangle) const {
    const auto& ranges = instances[instance].mesh->material_ranges;
    const auto after = std::upper_bound(
        ranges.begin(), ranges.end(), triangle,
        [](std::uint32_t t, const MaterialRange& range) { return t < range.first_triangle; });
    return after == ranges.begin() ? 0 : static_cast<std::size_t>(after - ranges.begin()) - 1;
}

const Material& PreparedScene::material_of(std::uint32_t instance, std::uint32_t triangle) const {
    const auto& ranges = instances[instance].mesh->material_ranges;
    if (ranges.empty()) return default_material();
    return material_of_range(materials, ranges[range_of(instance, triangle)]);
}

FlatCode PreparedScene::flat_code(const NormalMap& map) const {
    return map.flat ? *map.flat : detected_flat_codes.at(map.texture.image);
}

// Surfaces

namespace {

/// Returns the unit vector, or the fallback if a float cannot hold the squared length.
glm::dvec3 unit_or(const glm::dvec3& vector, const glm::dvec3& fallback) {
    const double squared = glm::dot(vector, vector);
    return squared > 1e-30 && squared < 1e30 ? vector / std::sqrt(squared) : fallback;
}

const glm::dvec3 z_axis(0.0, 0.0, 1.0);

/// A hit with the corners of its triangle.
struct Triangle {
    const PreparedInstance& instance;
    glm::uvec3 corners;
    glm::dvec3 barycentric;

    template <typename T>
    [[nodiscard]] T interpolated(const std::vector<T>& by_vertex) const {
        return by_vertex[corners.x] * barycentric.x + by_vertex[corners.y] * barycentric.y +
               by_vertex[corners.z] * barycentric.z;
    }
    template <typename Double, typename Float>
    [[nodiscard]] Double interpolated_as(const std::vector<Float>& by_vertex) const {
        return Double(by_vertex[corners.x]) * barycentric.x +
               Double(by_vertex[corners.y]) * barycentric.y +
               Double(by_vertex[corners.z]) * barycentric.z;
    }
};

Triangle triangle_of(const PreparedScene& prepared, const Hit& hit) {
    const PreparedInstance& instance = prepared.instances[hit.instance];
    return {instance, instance.mesh->triangles[hit.triangle], hit.barycentric};
}

/// Returns the normal of the triangle's plane on its front side, from which its corners are
/// counter-clockwise, or clockwise if the instance is mirrored.
glm::dvec3 front_of_plane(const Triangle& triangle) {
    const auto& positions = triangle.instance.positions_world;
    const glm::dvec3 a = positions[triangle.corners.x];
    const glm::dvec3 normal = direction_or_zero(
        glm::cross(positions[triangle.corners.y] - a, positions[triangle.corners.z] - a));
    return triangle.instance.mirrors ? -normal : normal;
}

/// The basis of tangent space. Its vectors need not be unit or perpendicular.
struct Basis {
    glm::dvec3 tangent{0.0};
    glm::dvec3 bitangent{0.0};
    glm::dvec3 normal{0.0};
};

Basis stored_basis(const Triangle& triangle, const glm::dvec3& normal) {
    if (triangle.instance.tangents_world.empty()) return {glm::dvec3(0.0), glm::dvec3(0.0), normal};
    const glm::dvec4 tangent = triangle.interpolated(triangle.instance.tangents_world);
    const glm::dvec3 along(tangent);
    return {along, tangent.w * glm::cross(normal, along), normal};
}

/// Returns the basis from the derivatives of positions by texture coordinates over the triangle. If
/// the texture coordinates have no area, tangent and bitangent are zero.
Basis derived_basis(const Triangle& triangle, const glm::dvec3& normal) {
    const auto& positions = triangle.instance.positions_world;
    const auto& texcoords = triangle.instance.mesh->texcoords;
    if (texcoords.empty()) return {glm::dvec3(0.0), glm::dvec3(0.0), normal};
    const glm::uvec3& corners = triangle.corners;
    const glm::dvec3 p1 = positions[corners.y] - positions[corners.x];
    const glm::dvec3 p2 = positions[corners.z] - positions[corners.x];
    const glm::dvec2 t1 = glm::dvec2(texcoords[corners.y]) - glm::dvec2(texcoords[corners.x]);
    const glm::dvec2 t2 = glm::dvec2(texcoords[corners.z]) - glm::dvec2(texcoords[corners.x]);
    const double area = t1.x * t2.y - t1.y * t2.x;
    const glm::dvec3 unit_normal = unit_or(normal, z_axis);
    if (!(std::abs(area) > 0.0)) return {glm::dvec3(0.0), glm::dvec3(0.0), unit_normal};
    const glm::dvec3 along_u = (p1 * t2.y - p2 * t1.y) * (area < 0.0 ? -1.0 : 1.0);
    const glm::dvec3 tangent = direction_or_zero(in_plane(along_u, unit_normal));
    // v grows downwards: a texture that is upright on the front side has a negative area.
    const bool upright = (area < 0.0) != triangle.instance.mirrors;
    return {tangent, (upright ? 1.0 : -1.0) * glm::cross(unit_normal, tangent), unit_normal};
}

Basis basis_of(const Material& material, const Triangle& triangle, const glm::dvec3& normal) {
    return material.tangent_frame == TangentFrame::derivatives ? derived_basis(triangle, normal)
                                                               : stored_basis(triangle, normal);
}

/// Returns the vector of a normal map's filtered codes; y up, without the scale of x and y.
glm::dvec3 decoded(const glm::dvec3& sample, int bits, FlatCode flat, Green green) {
    glm::dvec3 vector = 2.0 * sample - 1.0;
    if (bits < 32 && flat == FlatCode::middle) {
        const double largest = bits == 8 ? 255.0 : 65535.0;
        const double middle = (largest + 1.0) / 2.0;
        vector = (sample * largest - middle) / (middle - 1.0);
    }
    if (green == Green::down) vector.y = -vector.y;
    return vector;
}

glm::dvec3 mapped_vector(const PreparedScene& prepared, const NormalMap& map,
                         const glm::dvec2& texcoord, Trace& trace) {
    const glm::dvec3 sample(prepared.texels.look_up(map.texture, ImageUse::data, texcoord, trace));
    return decoded(sample, prepared.normal_map_bits.at(map.texture.image), prepared.flat_code(map),
                   map.green);
}

/// Returns the normal of a height map, by central differences over one texel on either side.
glm::dvec3 bumped_vector(const PreparedScene& prepared, const BumpMap& map,
                         const glm::dvec2& texcoord, Trace& trace) {
    const Texels& texels = prepared.texels.get(map.texture.image, ImageUse::data);
    const auto height = [&](double x, double y) {
        const glm::dvec2 uv = texcoord + glm::dvec2(x / texels.width(), y / texels.height());
        return prepared.texels.look_up(map.texture, ImageUse::data, uv, trace).x;
    };
    const double strength = static_cast<double>(map.strength);
    const double along_u = 0.5 * strength * (height(1.0, 0.0) - height(-1.0, 0.0));
    const double along_v = 0.5 * strength * (height(0.0, 1.0) - height(0.0, -1.0));
    return {-along_u, along_v, 1.0};
}

/// Returns the tangent-space normal of a material's normal or bump map at a point.
glm::dvec3 vector_tangent(const PreparedScene& prepared, const Material& material,
                          const glm::dvec2& texcoord, Trace& trace) {
    if (material.bump_map) return bumped_vector(prepared, *material.bump_map, texcoord, trace);
    const double scale = static_cast<double>(material.normal_map->scale);
    return mapped_vector(prepared, *material.normal_map, texcoord, trace) *
           glm::dvec3(scale, scale, 1.0);
}

/// Tells whether a vector is shorter than the rounding of its codes.
bool is_undefined(const glm::dvec3& vector) {
    return !(glm::dot(vector, vector) > 1e-12);
}

/// Returns the normal of an object-space map, in world space; zero if the map defines none.
glm::dvec3 stored_normal(const PreparedScene& prepared, const Hit& hit, const NormalMap& map,
                         const glm::dvec2& texcoord, Trace& trace) {
    const glm::dvec3 normal_object = mapped_vector(prepared, map, texcoord, trace);
    if (is_undefined(normal_object)) return glm::dvec3(0.0);
    return direction_or_zero(prepared.instances[hit.instance].world_from_object_normal *
                             normal_object);
}

/// Returns the normal on the front side.
glm::dvec3 front_normal(const PreparedScene& prepared, const Hit& hit, const Material& material,
                        const glm::dvec2& texcoord, Trace& trace) {
    const Triangle triangle = triangle_of(prepared, hit);
    const glm::dvec3 normal = material.interpolation == Interpolation::flat
                                  ? front_of_plane(triangle)
                                  : triangle.interpolated(triangle.instance.normals_world);
    const glm::dvec3 fallback = unit_or(normal, z_axis);
    // Flat shading uses the plane of the triangle only, and Gouraud shading the vertex normals.
    const bool has_map = material.interpolation == Interpolation::per_pixel &&
                         (material.normal_map || material.bump_map);
    if (!has_map || triangle.instance.mesh->texcoords.empty()) return fallback;
    if (material.normal_map && material.normal_map->space == NormalSpace::object) {
        return unit_or(stored_normal(prepared, hit, *material.normal_map, texcoord, trace),
                       fallback);
    }
    const glm::dvec3 vector = vector_tangent(prepared, material, texcoord, trace);
    if (is_undefined(vector)) return fallback;
    const Basis basis = basis_of(material, triangle, normal);
    return unit_or(vector.x * basis.tangent + vector.y * basis.bitangent + vector.z * basis.normal,
                   fallback);
}

/// Returns the attributes that need no material.
Surface attributes_at(const PreparedScene& prepared, const Hit& hit) {
    const Triangle triangle = triangle_of(prepared, hit);
    const Mesh& mesh = *triangle.instance.mesh;
    Surface surface;
    surface.position_world = triangle.interpolated(triangle.instance.positions_world);
    surface.has_texcoord = !mesh.texcoords.empty();
    if (surface.has_texcoord) {
        surface.texcoord = triangle.interpolated_as<glm::dvec2>(mesh.texcoords);
    }
    surface.has_texcoord_2 = !mesh.texcoords_2.empty();
    if (surface.has_texcoord_2)
        surface.texcoord_2 = triangle.interpolated_as<glm::dvec2>(mesh.texcoords_2);
    if (!triangle.instance.open_shares.empty())
        surface.open_share = triangle.interpolated_as<double>(triangle.instance.open_shares);
    if (!mesh.colors.empty()) surface.color = triangle.interpolated_as<glm::dvec4>(mesh.colors);
    return surface;
}

// Reliefs

/// Returns the relief of a triangle, with the frame of its texels; none if there is none, or if the
/// triangle has no area in the map.
std::optional<ReliefHit> relief_frame(const PreparedScene& prepared, const Hit& hit,
                                      const Material& material) {
    ReliefHit relief;
    relief.field = prepared.relief_of(hit.instance, hit.triangle);
    const Triangle triangle = triangle_of(prepared, hit);
    const auto& texcoords = triangle.instance.mesh->texcoords;
    if (relief.field == nullptr || texcoords.empty()) return std::nullopt;
    relief.black_depth = static_cast<double>(material.height_map->depth);
    const auto& positions = triangle.instance.positions_world;
    const glm::dvec2 size(relief.field->size());
    const glm::uvec3& corners = triangle.corners;
    const glm::dvec3 p1 = positions[corners.y] - positions[corners.x];
    const glm::dvec3 p2 = positions[corners.z] - positions[corners.x];
    const glm::dvec2 t1 =
        size * (glm::dvec2(texcoords[corners.y]) - glm::dvec2(texcoords[corners.x]));
    const glm::dvec2 t2 =
        size * (glm::dvec2(texcoords[corners.z]) - glm::dvec2(texcoords[corners.x]));
    const double area = t1.x * t2.y - t1.y * t2.x;
    if (area == 0.0) return std::nullopt;
    relief.normal_world = direction_or_zero(triangle.interpolated(triangle.instance.normals_world));
    relief.along_x_world = (p1 * t2.y - p2 * t1.y) / area;
    relief.along_y_world = (p2 * t1.x - p1 * t2.x) / area;
    relief.texel_world =
        std::sqrt(glm::length(glm::cross(relief.along_x_world, relief.along_y_world)));
    if (material.height_map->silhouette != ReliefSilhouette::curve) return relief;
    const auto& normals = triangle.instance.normals_world;
    const glm::dvec3 n1 = normals[corners.y] - normals[corners.x];
    const glm::dvec3 n2 = normals[corners.z] - normals[corners.x];
    relief.curvature =
        height_curvature(triangle.interpolated(normals), relief.along_x_world, relief.along_y_world,
                         (n1 * t2.y - n2 * t1.y) / area, (n2 * t1.x - n1 * t2.x) / area);
    return relief;
}

/// Returns the texels that a ray of view or light passes along both axes of a map for each texel of
/// depth, as shaders/height_march.glsl says; none if it does not enter.
/// \param outward_world  against the ray, of any length
std::optional<glm::dvec2> texels_per_depth(const ReliefHit& relief,
                                           const glm::dvec3& outward_world) {
    const glm::dvec3& normal = relief.normal_world;
    const double turned = glm::dot(normal, glm::cross(relief.along_x_world, relief.along_y_world));
    const double toward = glm::dot(normal, outward_world);
    const glm::dvec2 moved(glm::dot(normal, glm::cross(outward_world, relief.along_y_world)),
                           glm::dot(normal, glm::cross(relief.along_x_world, outward_world)));
    const glm::dvec2 result = -moved * relief.texel_world / (turned * toward);
    const bool enters = toward > 0.0 && glm::dot(result, result) < 1e12;
    return enters ? std::optional(result) : std::nullopt;
}

glm::dvec3 vector_to_eye(const PreparedScene& prepared, const glm::dvec3& position_world) {
    return glm::dvec3(prepared.eye_world) - prepared.eye_world.w * position_world;
}

/// Returns where a ray meets the relief under a point of the surface; none if it does not.
/// \param outward_world  against the ray: the vector to the eye, or to a light
std::optional<ReliefHit> relief_hit(const PreparedScene& prepared, const Hit& hit,
                                    const Material& material, const Surface& surface,
                                    const glm::dvec3& outward_world) {
    std::optional<ReliefHit> relief = relief_frame(prepared, hit, material);
    if (!relief) return std::nullopt;
    relief->outward_world = outward_world;
    relief->texcoord_surface = relief->texcoord = surface.texcoord;
    const auto along = texels_per_depth(*relief, outward_world);
    if (!along) {
        // A front face whose interpolated normal points away from the eye is beyond the outline.
        relief->leaves_surface = !is_back(prepared, hit) &&
                                 relief->curvature.turn != glm::dmat2(0.0) &&
                                 glm::dot(relief->normal_world, outward_world) < 0.0;
        return relief->leaves_surface ? relief : std::nullopt;
    }
    HeightRay ray;
    ray.texcoord = surface.texcoord;
    ray.direction = glm::dvec3(*along, 1.0);
    ray.black_depth = relief->black_depth;
    const CurvedHeightRay curved = curved_ray(ray, relief->curvature);
    const HeightHit met = relief->field->first_hit(curved.ray);
    relief->texcoord = met.texcoord;
    relief->leaves_surface = met.end == HeightRayEnd::left;
    const double plane_depth = (curved.plane.x + curved.plane.y * met.way) * met.way;
    relief->beyond =
        plane_depth * relief->texel_world / glm::dot(relief->normal_world, outward_world);
    return relief;
}

/// Moves the texture coordinates of a surface to where a ray meets its relief.
void displace(const PreparedScene& prepared, const Hit& hit, const Material& material,
              const glm::dvec3& outward_world, Surface& surface) {
    surface.relief = relief_hit(prepared, hit, material, surface, outward_world);
    if (!surface.relief) return;
    const glm::dvec2 moved = surface.relief->texcoord - surface.texcoord;
    surface.texcoord += moved;
    if (!surface.has_texcoord_2) return;
    const Triangle triangle = triangle_of(prepared, hit);
    const auto edge = [&](const auto& texcoords, int corner) {
        return glm::dvec2(texcoords[triangle.corners[corner]]) -
               glm::dvec2(texcoords[triangle.corners.x]);
    };
    const Mesh& mesh = *triangle.instance.mesh;
    const glm::dvec2 t1 = edge(mesh.texcoords, 1);
    const glm::dvec2 t2 = edge(mesh.texcoords, 2);
    const double area = t1.x * t2.y - t1.y * t2.x;
    surface.texcoord_2 += edge(mesh.texcoords_2, 1) * (moved.x * t2.y - moved.y * t2.x) / area +
                          edge(mesh.texcoords_2, 2) * (moved.y * t1.x - moved.x * t1.y) / area;
}

void face_viewer(const PreparedScene& prepared, const Hit& hit, Surface& surface) {
    if (is_back(prepared, hit)) {
        surface.normal_world = -surface.normal_world;
        surface.coat_normal_world = -surface.coat_normal_world;
    }
    surface.view_world =
        unit_or(vector_to_eye(prepared, surface.position_world), surface.normal_world);
}

/// Records the vectors of a surface: those of the formula, and the frame of its tangent space, for
/// which a mesh without stored tangents has the derivatives of its texture coordinates.
void record(Recorder& recorder, const PreparedScene& prepared, const Hit& hit,
            const Material& material, const Surface& surface) {
    const Triangle triangle = triangle_of(prepared, hit);
    const glm::dvec3 interpolated = triangle.interpolated(triangle.instance.normals_world);
    Basis basis = basis_of(material, triangle, interpolated);
    if (basis.tangent == glm::dvec3(0.0)) basis = derived_basis(triangle, interpolated);
    ProbeLayer& layer = recorder.layer();
    layer.position_world = surface.position_world;
    if (surface.has_texcoord) layer.texcoord = surface.texcoord;
    if (surface.has_texcoord_2) layer.texcoord_2 = surface.texcoord_2;
    recorder.add_vector("n", surface.normal_world);
    recorder.add_vector("v", surface.view_world);
    if (coat_map(material)) recorder.add_vector("n'", surface.coat_normal_world);
    recorder.add_vector("n0", unit_or(interpolated, z_axis));
    recorder.add_vector("ng", front_of_plane(triangle));
    if (basis.tangent == glm::dvec3(0.0)) return;
    recorder.add_vector("t", direction_or_zero(basis.tangent));
    recorder.add_vector("b", direction_or_zero(basis.bitangent));
}

}  // namespace

bool is_back(const PreparedScene& prepared, const Hit& hit) {
    return hit.counter_clockwise == prepared.instances[hit.instance].mirrors;
}

Surface surface_at(const PreparedScene& prepared, const Hit& hit, const Material& material,
                   Trace& trace, const glm::dvec3* to_light_world) {
    Surface surface = attributes_at(prepared, hit);
    if (to_light_world == nullptr)
        displace(prepared, hit, material, vector_to_eye(prepared, surface.position_world), surface);
    else if (has_displaced_shadow(material))
        displace(prepared, hit, material, *to_light_world, surface);
    surface.normal_world = front_normal(prepared, hit, material, surface.texcoord, trace);
    Material coat;
    coat.interpolation = material.interpolation;
    coat.tangent_frame = material.tangent_frame;
    coat.normal_map = coat_map(material);
    surface.coat_normal_world = front_normal(prepared, hit, coat, surface.texcoord, trace);
    if (is_anisotropic(material)) {
        const Triangle triangle = triangle_of(prepared, hit);
        const Basis basis =
            basis_of(material, triangle, triangle.interpolated(triangle.instance.normals_world));
        surface.tangent_world = basis.tangent;
        surface.bitangent_world = basis.bitangent;
    }
    face_viewer(prepared, hit, surface);
    if (Recorder* const recorder = trace.recorder())
        record(*recorder, prepared, hit, material, surface);
    return surface;
}

Surface surface_at_corner(const PreparedScene& prepared, const Hit& hit, int corner) {
    Hit at_corner = hit;
    at_corner.barycentric = glm::dvec3(0.0);
    at_corner.barycentric[corner] = 1.0;
    Surface surface = attributes_at(prepared, at_corner);
    const Triangle triangle = triangle_of(prepared, at_corner);
    surface.normal_world = unit_or(triangle.interpolated(triangle.instance.normals_world), z_axis);
    face_viewer(prepared, at_corner, surface);
    return surface;
}

bool is_shadowed(const ReliefHit& relief, const glm::dvec3& light_world) {
    const auto along = texels_per_depth(relief, light_world);
    if (!along) return true;
    HeightRay ray;
    ray.texcoord = relief.texcoord;
    ray.direction = -glm::dvec3(*along, 1.0);
    ray.black_depth = relief.black_depth;
    return relief.field->is_shadowed(ray);
}

bool is_clipped(const Material& material, const Surface& surface) {
    if (!surface.relief || material.height_map->silhouette == ReliefSilhouette::none) return false;
    if (surface.relief->leaves_surface) return true;
    const auto leaves = [](double from, double to) {
        return (to < 0.0 || to > 1.0) && from >= 0.0 && from <= 1.0;
    };
    const glm::dvec2& from = surface.relief->texcoord_surface;
    const glm::dvec2& to = surface.relief->texcoord;
    const Texture& texture = material.height_map->texture;
    return (texture.wrap_u == Wrap::clamp && leaves(from.x, to.x)) ||
           (texture.wrap_v == Wrap::clamp && leaves(from.y, to.y));
}

void set_relief_depth(const PreparedScene& prepared, const Material& material, Hit& hit) {
    if (!material.height_map || !material.height_map->write_depth) return;
    const Surface surface = attributes_at(prepared, hit);
    const auto relief = relief_hit(prepared, hit, material, surface,
                                   vector_to_eye(prepared, surface.position_world));
    if (!relief) return;
    // An orthographic camera looks along a vector of any length.
    hit.depth +=
        relief->beyond *
        (prepared.eye_world.w > 0.0 ? hit.depth : glm::length(glm::dvec3(prepared.eye_world)));
}

}  // namespace relief::shade::reference

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

// Ambient occlusion

namespace {

/// Returns the mesh of an instance in world space as its pose deforms it, with normals.
Mesh in_world(const Scene& scene, std::size_t instance) {
    const glm::mat4& world_from_object = scene.instances[instance].world_from_object;
    const Shared<Mesh> mesh = deformed_mesh(scene, instance);
    const glm::dmat3 to_world = reference::normal_matrix(glm::dmat3(world_from_object)).matrix;
    Mesh world;
    world.triangles = mesh->triangles;
    for (const glm::vec3& position : mesh->positions)
        world.positions.emplace_back(world_from_object * glm::vec4(position, 1.0F));
    const std::vector<glm::vec3> normals =
        mesh->normals.empty() ? vertex_normals(mesh->positions, mesh->triangles, NormalOptions{})
                              : mesh->normals;
    for (const glm::vec3& normal : normals)
        world.normals.emplace_back(direction_or_zero(to_world * glm::dvec3(normal)));
    return world;
}

/// Returns the triangles of the mesh whose materials cast shadows.
std::vector<glm::uvec3> casting_triangles(const Scene& scene, const Mesh& mesh) {
    if (mesh.material_ranges.empty()) return mesh.triangles;
    std::vector<glm::uvec3> triangles;
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.material && !casts_shadow(scene.materials[*range.material])) continue;
        const auto first = mesh.triangles.begin() + range.first_triangle;
        triangles.insert(triangles.end(), first, first + range.triangle_count);
    }
    return triangles;
}

}  // namespace

void add_ambient_occlusion(Scene& scene, int rays) {
    validate(scene);
    if (!scene.ambient_occlusion) return;
    std::vector<Mesh> receivers;
    std::vector<Mesh> occluders;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        Mesh& receiver = receivers.emplace_back(in_world(scene, i));
        Mesh& occluder = occluders.emplace_back();
        occluder.positions = receiver.positions;
        occluder.triangles = casting_triangles(scene, scene.meshes[scene.instances[i].mesh]);
    }
    const Bounds bounds = world_bounds(scene);
    OcclusionOptions options;
    options.rays = rays;
    options.distance = 0.0;
    if (!bounds.empty()) {
        const glm::dvec3 extent = glm::dvec3(bounds.max) - glm::dvec3(bounds.min);
        options.distance = static_cast<double>(scene.ambient_occlusion->distance) *
                           std::max({extent.x, extent.y, extent.z});
    }
    std::vector<std::vector<float>> shares = vertex_occlusion(receivers, occluders, options);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const bool is_open = std::all_of(shares[i].begin(), shares[i].end(),
                                         [](float share) { return share == 1.0F; });
        if (is_open) shares[i].clear();
        scene.instances[i].open_shares = std::move(shares[i]);
    }
}

}  // namespace relief::shade
