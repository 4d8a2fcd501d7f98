// SPDX-License-Identifier: Apache-2.0
// Embree's scene, robust, and packets of sixteen: of all its ways to cast rays the fastest for
// those that run side by side (bench/mesh/ray_bench.cpp). Tests:
// tests/mesh/bake/ray_scene_test.cpp.
#include "bake/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <tuple>

#include "geometry/direction.h"
#include "large_memory.h"
#include "parallel.h"

namespace relief {
namespace {

static_assert(sizeof(RayPacket) == sizeof(RTCRayHit16) && alignof(RayPacket) == 64 &&
              offsetof(RayPacket, far) == offsetof(RTCRay16, tfar) &&
              offsetof(RayPacket, normal_x) == offsetof(RTCRayHit16, hit) &&
              offsetof(RayPacket, instance) ==
                  offsetof(RTCRayHit16, hit) + offsetof(RTCHit16, instID));

/// Hits this near to an edge, as a share of the triangle's height, may be its neighbour's as well.
constexpr float edge_share = 1e-4F;
/// How far around such a hit others are looked for, over the size of the scene.
constexpr float edge_reach = 2e-6F;

RTCRayHit16* embree_of(RayPacket& packet) {
    return reinterpret_cast<RTCRayHit16*>(&packet);
}

template <typename T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, 3 * sizeof(T), count);
    if (buffer == nullptr) throw std::bad_alloc();
    expect_filling(buffer, 3 * sizeof(T) * count);
    return static_cast<T*>(buffer);
}

/// Embree leaves out triangles with a vertex that is not finite.
void fill(RTCGeometry geometry, const RayMesh& mesh, const glm::dvec3& centre, double scale) {
    auto* vertices = new_buffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                       mesh.positions.size());
    auto* corners = new_buffer<std::uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                              mesh.triangles.size());
    constexpr std::size_t grain = 1 << 16;
    parallel_for(mesh.positions.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 moved = (glm::dvec3(mesh.positions[i]) - centre) * scale;
            for (int axis = 0; axis < 3; ++axis)
                vertices[3 * i + static_cast<std::size_t>(axis)] = static_cast<float>(moved[axis]);
        }
    });
    std::copy_n(&mesh.triangles.data()->x, 3 * mesh.triangles.size(), corners);
}

/// All triangles that a ray meets, for Embree's filter: the context comes first, as Embree casts.
struct Collector {
    RTCIntersectContext context;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;  ///< Mesh and triangle.
};

void collect(const RTCFilterFunctionNArguments* arguments) {
    auto* collector = reinterpret_cast<Collector*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        collector->found.emplace_back(RTCHitN_geomID(arguments->hit, arguments->N, i),
                                      RTCHitN_primID(arguments->hit, arguments->N, i));
        arguments->valid[i] = 0;
    }
}

/// The point of a triangle that is nearest to another. Source: [Ericson 2005], 5.1.5.
glm::vec3 nearest_point(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                        const glm::vec3& c) {
    const glm::vec3 ab = b - a;
    const glm::vec3 ac = c - a;
    const float d1 = glm::dot(ab, p - a), d2 = glm::dot(ac, p - a);
    if (d1 <= 0.0F && d2 <= 0.0F) return a;
    const float d3 = glm::dot(ab, p - b), d4 = glm::dot(ac, p - b);
    if (d3 >= 0.0F && d4 <= d3) return b;
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0F && d1 >= 0.0F && d3 <= 0.0F) return a + d1 / (d1 - d3) * ab;
    const float d5 = glm::dot(ab, p - c), d6 = glm::dot(ac, p - c);
    if (d6 >= 0.0F && d5 <= d6) return c;
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0F && d2 >= 0.0F && d6 <= 0.0F) return a + d2 / (d2 - d6) * ac;
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0F && d4 - d3 >= 0.0F && d5 - d6 >= 0.0F)
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    const float sum = va + vb + vc;
    return a + vb / sum * ab + vc / sum * ac;
}

/// What a point query needs: the buffers of all meshes, in Embree's space.
struct PointQuery {
    RTCScene scene;
    glm::vec3 point;
};

bool come_nearer(RTCPointQueryFunctionArguments* arguments) {
    const auto* query = static_cast<const PointQuery*>(arguments->userPtr);
    RTCGeometry geometry = rtcGetGeometry(query->scene, arguments->geomID);
    const auto* vertices =
        static_cast<const float*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    const auto* corners = static_cast<const std::uint32_t*>(
        rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
    const auto corner = [&](std::size_t i) {
        const float* v =
            &vertices[3 * std::size_t{corners[3 * std::size_t{arguments->primID} + i]}];
        return glm::vec3(v[0], v[1], v[2]);
    };
    const float distance =
        glm::distance(query->point, nearest_point(query->point, corner(0), corner(1), corner(2)));
    if (!(distance < arguments->query->radius)) return false;
    arguments->query->radius = distance;
    return true;
}

/// Where a triangle comes in the order of places.
std::array<std::tuple<double, double, double>, 3> place_of(
    const std::array<glm::dvec3, 3>& corners) {
    std::array<std::tuple<double, double, double>, 3> place;
    for (std::size_t i = 0; i < 3; ++i)
        place[i] = {corners[i].x, corners[i].y, corners[i].z};
    std::sort(place.begin(), place.end());
    return place;
}

/// Weights that rounding made negative become 0.
glm::dvec3 drawn_inside(glm::dvec3 weights) {
    weights = glm::max(weights, glm::dvec3(0.0));
    return weights / (weights.x + weights.y + weights.z);
}

}  // namespace

struct RayScene::EmbreeScene {
    EmbreeScene() : device(rtcNewDevice(nullptr)), scene(rtcNewScene(device)) {
        // Filters are for rays near edges only.
        rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                           RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    }
    ~EmbreeScene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCDevice device;
    RTCScene scene;
};

RayScene::RayScene(std::vector<RayMesh> meshes)
    : meshes_(std::move(meshes)), embree_(std::make_unique<EmbreeScene>()) {
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high(-std::numeric_limits<double>::infinity());
    for (const RayMesh& mesh : meshes_) {
        for (const glm::vec3& position : mesh.positions) {
            if (!is_finite(position)) continue;
            low = glm::min(low, glm::dvec3(position));
            high = glm::max(high, glm::dvec3(position));
        }
    }
    if (low.x <= high.x) {
        centre_ = 0.5 * (low + high);
        const glm::dvec3 size = 0.5 * (high - low);
        half_size_ = std::max({size.x, size.y, size.z});
        if (!(half_size_ > 0.0)) half_size_ = 1.0;
    }
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        if (meshes_[i].triangles.empty()) continue;
        is_empty_ = false;
        RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        fill(geometry, meshes_[i], centre_, 1.0 / half_size_);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(embree_->scene, geometry, static_cast<unsigned>(i));
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(embree_->scene);
}

RayScene::~RayScene() = default;

void RayScene::set(RayPacket& packet, std::size_t lane, const Ray& ray) const {
    const double scale = 1.0 / half_size_;
    const glm::dvec3 origin = (ray.origin - centre_) * scale;
    packet.origin_x[lane] = static_cast<float>(origin.x);
    packet.origin_y[lane] = static_cast<float>(origin.y);
    packet.origin_z[lane] = static_cast<float>(origin.z);
    packet.near[lane] = static_cast<float>(ray.near * scale);
    packet.direction_x[lane] = static_cast<float>(ray.direction.x);
    packet.direction_y[lane] = static_cast<float>(ray.direction.y);
    packet.direction_z[lane] = static_cast<float>(ray.direction.z);
    packet.time[lane] = 0.0F;
    packet.far[lane] = static_cast<float>(ray.far * scale);
    packet.mask[lane] = std::numeric_limits<std::uint32_t>::max();
    packet.id[lane] = 0;
    packet.flags[lane] = 0;
    packet.mesh[lane] = RayPacket::nothing;
    packet.instance[lane] = RayPacket::nothing;
}

void RayScene::find(RayPacket& packet, std::size_t count) const {
    alignas(64) std::array<int, RayPacket::size> valid{};
    std::fill_n(valid.begin(), count, -1);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid.data(), embree_->scene, &context, embree_of(packet));
    for (std::size_t lane = 0; lane < count; ++lane) {
        if (!packet.hits(lane)) continue;
        const float second = packet.second[lane];
        const float third = packet.third[lane];
        if (std::min({second, third, 1.0F - second - third}) < edge_share)
            settle_edges(packet, lane);
    }
}

/// Of all triangles at the place of a hit, the one that comes first.
void RayScene::settle_edges(RayPacket& packet, std::size_t lane) const {
    Collector collector{};
    rtcInitIntersectContext(&collector.context);
    collector.context.filter = collect;
    RTCRayHit query{};
    query.ray.org_x = packet.origin_x[lane];
    query.ray.org_y = packet.origin_y[lane];
    query.ray.org_z = packet.origin_z[lane];
    query.ray.dir_x = packet.direction_x[lane];
    query.ray.dir_y = packet.direction_y[lane];
    query.ray.dir_z = packet.direction_z[lane];
    query.ray.tnear = std::max(packet.near[lane], packet.far[lane] - edge_reach);
    query.ray.tfar = packet.far[lane] + edge_reach;
    query.ray.mask = std::numeric_limits<std::uint32_t>::max();
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &collector.context, &query);
    if (collector.found.size() < 2) return;
    const glm::dvec3 direction(query.ray.dir_x, query.ray.dir_y, query.ray.dir_z);
    const auto rank = [&](const std::pair<std::uint32_t, std::uint32_t>& found) {
        const std::array<glm::dvec3, 3> corner = corners(found.first, found.second);
        const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        return std::tuple(!(glm::dot(normal, direction) < 0.0), place_of(corner), found);
    };
    const auto first =
        *std::min_element(collector.found.begin(), collector.found.end(),
                          [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    packet.mesh[lane] = first.first;
    packet.triangle[lane] = first.second;
}

std::array<glm::dvec3, 3> RayScene::corners(std::uint32_t mesh, std::uint32_t triangle) const {
    const RayMesh& all = meshes_[mesh];
    const glm::uvec3& names = all.triangles[triangle];
    return {glm::dvec3(all.positions[names.x]), glm::dvec3(all.positions[names.y]),
            glm::dvec3(all.positions[names.z])};
}

/// The weights are as the volumes between the ray and each edge: neighbours see exactly opposite
/// ones for the edge that they share.
RayHit RayScene::exact(std::uint32_t mesh, std::uint32_t triangle, const Ray& ray) const {
    const std::array<glm::dvec3, 3> corner = corners(mesh, triangle);
    const glm::dvec3 a = corner[0] - ray.origin;
    const glm::dvec3 b = corner[1] - ray.origin;
    const glm::dvec3 c = corner[2] - ray.origin;
    const glm::dvec3& d = ray.direction;
    const glm::dvec3 volumes(glm::dot(glm::cross(d, c), b), glm::dot(glm::cross(d, a), c),
                             glm::dot(glm::cross(d, b), a));
    const double sum = volumes.x + volumes.y + volumes.z;
    RayHit hit{mesh, triangle};
    // Seen edge-on the plane says nothing; Embree's word stands then, with the nearest corner.
    hit.weights =
        sum != 0.0 && std::isfinite(sum) ? drawn_inside(volumes / sum) : glm::dvec3(1.0, 0.0, 0.0);
    hit.distance = glm::dot(hit.weights.x * a + hit.weights.y * b + hit.weights.z * c, d);
    hit.faces_origin = glm::dot(glm::cross(b - a, c - a), d) < 0.0;
    return hit;
}

RayHit RayScene::hit(const RayPacket& packet, std::size_t lane, const Ray& ray) const {
    if (!packet.hits(lane)) return {};
    return exact(packet.mesh[lane], packet.triangle[lane], ray);
}

RayHit RayScene::nearest(const Ray& ray) const {
    RayPacket packet;
    set(packet, 0, ray);
    find(packet, 1);
    return hit(packet, 0, ray);
}

double RayScene::distance_from(const glm::dvec3& point) const {
    const glm::dvec3 moved = (point - centre_) / half_size_;
    PointQuery ours{embree_->scene, glm::vec3(moved)};
    RTCPointQuery query{};
    query.x = ours.point.x;
    query.y = ours.point.y;
    query.z = ours.point.z;
    query.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(embree_->scene, &query, &context, come_nearer, &ours);
    return static_cast<double>(query.radius) * half_size_;
}

}  // namespace relief
