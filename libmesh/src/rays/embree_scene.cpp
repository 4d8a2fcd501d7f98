// SPDX-License-Identifier: Apache-2.0
// Embree's scene, robust, and packets of sixteen: of all its ways to cast rays the fastest for
// those that run side by side (bench/mesh/ray_bench.cpp).
// Tests: tests/mesh/rays/embree_scene_test.cpp.
#include "rays/embree_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <new>

#include "large_memory.h"
#include "parallel.h"

namespace relief {
namespace {

static_assert(sizeof(RayPacket) == sizeof(RTCRayHit16) && alignof(RayPacket) == 64 &&
              offsetof(RayPacket, far) == offsetof(RTCRay16, tfar) &&
              offsetof(RayPacket, normal_x) == offsetof(RTCRayHit16, hit) &&
              offsetof(RayPacket, instance) ==
                  offsetof(RTCRayHit16, hit) + offsetof(RTCHit16, instID));

RTCRayHit16* embree_of(RayPacket& packet) {
    return reinterpret_cast<RTCRayHit16*>(&packet);
}

float* new_vertices(RTCGeometry geometry, std::size_t count) {
    constexpr std::size_t size = 3 * sizeof(float);
    void* buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           size, count);
    if (buffer == nullptr) throw std::bad_alloc();
    expect_filling(buffer, size * count);
    return static_cast<float*>(buffer);
}

/// What Embree's filter gets: a place to put every hit. The context comes first, as Embree casts.
struct Collector {
    RTCIntersectContext context;
    std::vector<MetTriangle>* found;
};

/// Keeps the hit in mind and sends the ray on.
void collect(const RTCFilterFunctionNArguments* arguments) {
    auto* collector = reinterpret_cast<Collector*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        collector->found->push_back({RTCHitN_geomID(arguments->hit, arguments->N, i),
                                     RTCHitN_primID(arguments->hit, arguments->N, i)});
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
    std::span<const EmbreeBuffers> meshes;
    glm::vec3 point;
    float enough;  ///< A triangle as near as that ends the query.
    float distance = std::numeric_limits<float>::infinity();
};

bool come_nearer(RTCPointQueryFunctionArguments* arguments) {
    auto* query = static_cast<PointQuery*>(arguments->userPtr);
    const EmbreeBuffers& mesh = query->meshes[arguments->geomID];
    const glm::uvec3& corners = mesh.corners[arguments->primID];
    const auto corner = [&](int i) {
        const float* v = &mesh.vertices[3 * std::size_t{corners[i]}];
        return glm::vec3(v[0], v[1], v[2]);
    };
    const float distance =
        glm::distance(query->point, nearest_point(query->point, corner(0), corner(1), corner(2)));
    if (!(distance < query->distance)) return false;
    query->distance = distance;
    arguments->query->radius = distance <= query->enough ? 0.0F : distance;
    return true;
}

/// Lanes that are not asked for become rays of no length: Embree looks at them all
/// the same, and ends the program where an origin or a direction there is beyond 1.8e18 or NaN.
void empty_lanes(RayPacket& packet, std::size_t count) {
    for (auto* axis :
         {&packet.origin_x, &packet.origin_y, &packet.origin_z, &packet.near, &packet.direction_x,
          &packet.direction_y, &packet.direction_z, &packet.time, &packet.far})
        std::fill(axis->begin() + static_cast<std::ptrdiff_t>(count), axis->end(), 0.0F);
}

RTCBuildQuality quality_of(SceneBuild build) {
    return build == SceneBuild::fast ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

}  // namespace

EmbreeScene::EmbreeScene(SceneBuild build)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)), build_(build) {
    rtcSetSceneBuildQuality(scene_, quality_of(build_));
    // Filters are for those who want every hit alone.
    rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                        RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

void EmbreeScene::add(std::uint32_t name, std::size_t vertex_count, const VertexFill& fill,
                      std::span<const glm::uvec3> triangles) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, quality_of(build_));
    float* vertices = new_vertices(geometry, vertex_count);
    constexpr std::size_t grain = 1 << 16;
    parallel_for(vertex_count, grain, [&](std::size_t begin, std::size_t end) {
        fill(begin, end, vertices + 3 * begin);
    });
    // Of this buffer, unlike the other, Embree reads nothing past its end.
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               triangles.data(), 0, sizeof(glm::uvec3), triangles.size());
    if (name >= meshes_.size()) meshes_.resize(std::size_t{name} + 1);
    meshes_[name] = {vertices, triangles.data()};
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, name);
    rtcReleaseGeometry(geometry);
}

void EmbreeScene::build() {
    rtcCommitScene(scene_);
}

void EmbreeScene::find_nearest(RayPacket& packet, std::size_t count) const {
    alignas(64) std::array<int, RayPacket::size> valid{};
    std::fill_n(valid.begin(), count, -1);
    empty_lanes(packet, count);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid.data(), scene_, &context, embree_of(packet));
}

void EmbreeScene::find_any(RayPacket& packet, std::size_t count) const {
    alignas(64) std::array<int, RayPacket::size> valid{};
    std::fill_n(valid.begin(), count, -1);
    empty_lanes(packet, count);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    // Embree makes `far` of those that hit minus infinity.
    rtcOccluded16(valid.data(), scene_, &context, &embree_of(packet)->ray);
}

void EmbreeScene::find_all(const RaySegment& segment, std::vector<MetTriangle>& found) const {
    Collector collector{};
    rtcInitIntersectContext(&collector.context);
    collector.context.filter = collect;
    collector.found = &found;
    RTCRayHit query{};
    query.ray.org_x = segment.origin.x;
    query.ray.org_y = segment.origin.y;
    query.ray.org_z = segment.origin.z;
    query.ray.dir_x = segment.direction.x;
    query.ray.dir_y = segment.direction.y;
    query.ray.dir_z = segment.direction.z;
    query.ray.tnear = segment.near;
    query.ray.tfar = segment.far;
    query.ray.mask = std::numeric_limits<std::uint32_t>::max();
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &collector.context, &query);
}

float EmbreeScene::distance_from(const glm::vec3& point, float enough) const {
    PointQuery ours{meshes_, point, enough};
    RTCPointQuery query{};
    query.x = point.x;
    query.y = point.y;
    query.z = point.z;
    query.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, come_nearer, &ours);
    return ours.distance;
}

}  // namespace relief
