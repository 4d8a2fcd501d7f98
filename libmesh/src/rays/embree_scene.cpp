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

template <typename T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, 3 * sizeof(T), count);
    if (buffer == nullptr) throw std::bad_alloc();
    expect_filling(buffer, 3 * sizeof(T) * count);
    return static_cast<T*>(buffer);
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

}  // namespace

EmbreeScene::EmbreeScene() : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
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
    auto* vertices =
        new_buffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertex_count);
    auto* corners = new_buffer<std::uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                              triangles.size());
    constexpr std::size_t grain = 1 << 16;
    parallel_for(vertex_count, grain, [&](std::size_t begin, std::size_t end) {
        fill(begin, end, vertices + 3 * begin);
    });
    std::copy_n(&triangles.data()->x, 3 * triangles.size(), corners);
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
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid.data(), scene_, &context, embree_of(packet));
}

void EmbreeScene::find_any(RayPacket& packet, std::size_t count) const {
    alignas(64) std::array<int, RayPacket::size> valid{};
    std::fill_n(valid.begin(), count, -1);
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

float EmbreeScene::distance_from(const glm::vec3& point) const {
    PointQuery ours{scene_, point};
    RTCPointQuery query{};
    query.x = point.x;
    query.y = point.y;
    query.z = point.z;
    query.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, come_nearer, &ours);
    return query.radius;
}

}  // namespace relief
