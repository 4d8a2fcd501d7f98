// SPDX-License-Identifier: Apache-2.0
// Triangles are "user geometry" to Embree: it asks back for the boxes of triangles, and for the
// hits of each triangle whose box a ray meets. Tests: tests/mesh/rays/embree_scene_test.cpp.
#include "rays/embree_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <tuple>
#include <utility>

#include "vector_targets.h"

namespace relief {

/// A hit that may be as near as another one of the same ray.
struct TiedHit {
    std::size_t lane = 0;
    double distance = 0.0;
    MetTriangle met;
};

struct EmbreeScene::MeshOfScene {
    const glm::vec3* floats = nullptr;
    const glm::dvec3* doubles = nullptr;
    std::span<const glm::uvec3> triangles;
    std::uint32_t name = 0;
    EmbreeSpace space;
    /// Embree sees each entry as one shape: a triangle, or two that follow each other and share an
    /// edge. An entry is twice the index of the first triangle, plus 1 for two triangles.
    std::vector<std::uint32_t> shapes{};

    [[nodiscard]] std::uint32_t first_of(std::uint32_t shape) const { return shapes[shape] / 2; }
    [[nodiscard]] std::uint32_t last_of(std::uint32_t shape) const {
        return shapes[shape] / 2 + shapes[shape] % 2;
    }
    [[nodiscard]] glm::dvec3 position(std::uint32_t vertex) const {
        return doubles != nullptr ? doubles[vertex] : glm::dvec3(floats[vertex]);
    }
    [[nodiscard]] std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const {
        const glm::uvec3& all = triangles[triangle];
        return {position(all.x), position(all.y), position(all.z)};
    }
};

namespace {

using MeshOfScene = EmbreeScene::MeshOfScene;
using Corners = std::array<glm::dvec3, 3>;

/// Boxes are larger than their triangles, and rays longer than requested, by this much in Embree's
/// space. Embree's floats round origins by 4.8e-7 (they are at most 11 away), directions by 3e-8
/// for each unit of length, and boxes by 6e-8. Embree's tests of boxes add 2^-22 of the distance
/// from the origin, and 2^-24 of the origin. Together that makes less than 4e-6 within the scene.
constexpr double margin = 8e-6;
/// Hits this near to each other are equally near, in Embree's space: what doubles leave of
/// distances along a ray, with a factor of 1000 for triangles that the ray grazes.
constexpr double tie_share = 1e-12;
/// Origins further away than this are moved along their rays, in Embree's space.
constexpr double far_away = 4.0;
/// Rays end here, in Embree's space: beyond the scene, and beyond what a camera sees, whose far
/// distance is 1 there.
constexpr double longest = 64.0;
/// So far away doubles are as coarse as floats are within the scene.
constexpr double too_far_away = 1e10;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The state of one call of Embree. The context comes first, because Embree passes its address.
struct Cast {
    RTCIntersectContext context;
    RayPacket* packet;
    std::vector<TiedHit>* tied;
    std::vector<MetTriangle>* all;  ///< Not null: every hit is wanted.
};

/// The lanes of a packet that some of Embree's rays are.
struct Lanes {
    const int* valid;
    const unsigned* lane;
    float* far;
    unsigned count;
};

/// Which of the lanes meet a triangle, or may do so.
template <std::size_t count>
RELIEF_INLINE void lanes_that_meet(const RayPacket& packet, std::size_t begin,
                                   const Corners& corners, std::uint64_t* meets) {
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t lane = begin + i;
        const double ox = packet.origin[0][lane];
        const double oy = packet.origin[1][lane];
        const double oz = packet.origin[2][lane];
        const double ax = corners[0].x - ox, ay = corners[0].y - oy, az = corners[0].z - oz;
        const double bx = corners[1].x - ox, by = corners[1].y - oy, bz = corners[1].z - oz;
        const double cx = corners[2].x - ox, cy = corners[2].y - oy, cz = corners[2].z - oz;
        const double fx = packet.first[0][lane];
        const double fy = packet.first[1][lane];
        const double fz = packet.first[2][lane];
        const double sx = packet.second[0][lane];
        const double sy = packet.second[1][lane];
        const double sz = packet.second[2][lane];
        const double au = ax * fx + ay * fy + az * fz, av = ax * sx + ay * sy + az * sz;
        const double bu = bx * fx + by * fy + bz * fz, bv = bx * sx + by * sy + bz * sz;
        const double cu = cx * fx + cy * fy + cz * fz, cv = cx * sx + cy * sy + cz * sz;
        // The sign is right, or it is 0: see exact_cross().
        const double first = bu * cv - bv * cu;
        const double second = cu * av - cv * au;
        const double third = au * bv - av * bu;
        const double least = std::min(first, std::min(second, third));
        const double greatest = std::max(first, std::max(second, third));
        meets[i] = (least >= 0.0 ? 1U : 0U) | (greatest <= 0.0 ? 1U : 0U);
    }
}

RELIEF_INLINE void lanes_that_meet(const RayPacket& packet, std::size_t begin, unsigned count,
                                   const Corners& corners, std::uint64_t* meets) {
    if (count == 16)
        lanes_that_meet<16>(packet, begin, corners, meets);
    else if (count == 8)
        lanes_that_meet<8>(packet, begin, corners, meets);
    else
        lanes_that_meet<4>(packet, begin, corners, meets);
}

using LanesThatMeet = void(const RayPacket&, std::size_t, unsigned, const Corners&, std::uint64_t*);

void lanes_that_meet_128(const RayPacket& packet, std::size_t begin, unsigned count,
                         const Corners& corners, std::uint64_t* meets) {
    lanes_that_meet(packet, begin, count, corners, meets);
}
RELIEF_TARGET_256 void lanes_that_meet_256(const RayPacket& packet, std::size_t begin,
                                           unsigned count, const Corners& corners,
                                           std::uint64_t* meets) {
    lanes_that_meet(packet, begin, count, corners, meets);
}
RELIEF_TARGET_512 void lanes_that_meet_512(const RayPacket& packet, std::size_t begin,
                                           unsigned count, const Corners& corners,
                                           std::uint64_t* meets) {
    lanes_that_meet(packet, begin, count, corners, meets);
}

/// The results are the same from all three: additions and multiplications, one after another.
LanesThatMeet* const best_lanes_that_meet = [] {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            return lanes_that_meet_512;
        case VectorTarget::wide:
            return lanes_that_meet_256;
        case VectorTarget::any:
            break;
    }
    return lanes_that_meet_128;
}();

/// Calls each(i, hit) for those of Embree's rays that meet a triangle between their ends.
template <typename Each>
void for_hits(const RayPacket& packet, const Lanes& lanes, const Corners& corners,
              const Each& each) {
    std::array<std::uint64_t, RayPacket::size> meets;
    unsigned active = 0;
    for (unsigned i = 0; i < lanes.count; ++i)
        active += lanes.valid[i] != 0 ? 1U : 0U;
    const unsigned begin = lanes.lane[0];
    const bool is_block = active > 2 && lanes.lane[lanes.count - 1] == begin + lanes.count - 1;
    if (is_block) best_lanes_that_meet(packet, begin, lanes.count, corners, meets.data());
    for (unsigned i = 0; i < lanes.count; ++i) {
        if (lanes.valid[i] == 0 || (is_block && meets[i] == 0)) continue;
        const std::size_t lane = lanes.lane[i];
        ExactHit hit;
        if (!intersect(packet.frame(lane), corners, hit)) continue;
        if (hit.distance >= packet.near[lane] && hit.distance <= packet.far[lane]) each(i, hit);
    }
}

/// A hit of a lane; keeps all that may be equally near in the end.
void keep_nearest(Cast& cast, std::size_t lane, double distance, const MetTriangle& met) {
    RayPacket& packet = *cast.packet;
    const double nearest = packet.distance[lane];
    const double tie = tie_share / packet.scale[lane];
    if (packet.hits(lane) && distance > nearest + tie) return;
    if (packet.hits(lane) && distance >= nearest) {
        cast.tied->push_back({lane, distance, met});
        return;
    }
    if (packet.hits(lane) && nearest <= distance + tie)
        cast.tied->push_back({lane, nearest, {packet.mesh[lane], packet.triangle[lane]}});
    packet.distance[lane] = distance;
    packet.mesh[lane] = met.mesh;
    packet.triangle[lane] = met.triangle;
}

void meet_nearest(const RTCIntersectFunctionNArguments* arguments) {
    const auto& mesh = *static_cast<const MeshOfScene*>(arguments->geometryUserPtr);
    Cast& cast = *reinterpret_cast<Cast*>(arguments->context);
    RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, arguments->N);
    const Lanes lanes{arguments->valid, &RTCRayN_id(rays, arguments->N, 0),
                      &RTCRayN_tfar(rays, arguments->N, 0), arguments->N};
    const auto meet = [&](const MetTriangle& met, unsigned i, const ExactHit& hit) {
        const std::size_t lane = lanes.lane[i];
        if (cast.all != nullptr) {
            cast.all->push_back(met);
            return;
        }
        keep_nearest(cast, lane, hit.distance, met);
        RayPacket& packet = *cast.packet;
        if (hit.distance <= packet.until[lane])
            packet.last[lane] = std::max(packet.last[lane], hit.distance);
        // Hits that are farther away are not needed; the margin covers the errors of Embree's
        // floats.
        const double end = std::max(hit.distance, packet.until[lane]);
        const double from_start = (end - packet.start[lane]) * packet.scale[lane];
        lanes.far[i] = std::min(lanes.far[i], static_cast<float>(from_start + 3.0 * margin));
    };
    const std::uint32_t last = mesh.last_of(arguments->primID);
    for (std::uint32_t triangle = mesh.first_of(arguments->primID); triangle <= last; ++triangle) {
        for_hits(*cast.packet, lanes, mesh.corners(triangle), [&](unsigned i, const ExactHit& hit) {
            meet({mesh.name, triangle}, i, hit);
        });
    }
}

void meet_any(const RTCOccludedFunctionNArguments* arguments) {
    const auto& mesh = *static_cast<const MeshOfScene*>(arguments->geometryUserPtr);
    const Cast& cast = *reinterpret_cast<Cast*>(arguments->context);
    const Lanes lanes{arguments->valid, &RTCRayN_id(arguments->ray, arguments->N, 0),
                      &RTCRayN_tfar(arguments->ray, arguments->N, 0), arguments->N};
    const std::uint32_t last = mesh.last_of(arguments->primID);
    for (std::uint32_t triangle = mesh.first_of(arguments->primID); triangle <= last; ++triangle) {
        for_hits(*cast.packet, lanes, mesh.corners(triangle), [&](unsigned i, const ExactHit&) {
            lanes.far[i] = -std::numeric_limits<float>::infinity();
        });
    }
}

/// Rounding to float is less than the margin. Without triangles that can be met the box is empty,
/// which leaves the shape out.
void find_box(const RTCBoundsFunctionArguments* arguments) {
    const auto& mesh = *static_cast<const MeshOfScene*>(arguments->geometryUserPtr);
    glm::dvec3 low(infinity);
    glm::dvec3 high(-infinity);
    const std::uint32_t last = mesh.last_of(arguments->primID);
    for (std::uint32_t triangle = mesh.first_of(arguments->primID); triangle <= last; ++triangle) {
        const auto [a, b, c] = mesh.corners(triangle);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double size = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
        if (!(size > 0.0 && size < infinity)) continue;
        low = glm::min(low, glm::min(a, glm::min(b, c)));
        high = glm::max(high, glm::max(a, glm::max(b, c)));
    }
    constexpr double beyond = 1e9;  // Of what rays reach; Embree leaves out what is too large.
    const auto moved = [&](const glm::dvec3& place, double by) {
        return glm::clamp((place - mesh.space.center) / mesh.space.half_size + by, -beyond, beyond);
    };
    const bool is_empty = !(low.x <= high.x);
    const glm::vec3 lower(is_empty ? glm::dvec3(1.0) : moved(low, -margin));
    const glm::vec3 upper(is_empty ? glm::dvec3(-1.0) : moved(high, margin));
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = lower.x;
    box.lower_y = lower.y;
    box.lower_z = lower.z;
    box.upper_x = upper.x;
    box.upper_y = upper.y;
    box.upper_z = upper.z;
}

/// Two triangles that share an edge have a box hardly larger than one, and half as many boxes take
/// half the time to build the tree of.
std::vector<std::uint32_t> shapes_of(std::span<const glm::uvec3> triangles) {
    std::vector<std::uint32_t> shapes;
    shapes.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        int shared = 0;
        for (int k = 0; k < 3 && i + 1 < triangles.size(); ++k) {
            const std::uint32_t vertex = triangles[i + 1][k];
            const glm::uvec3& here = triangles[i];
            shared += vertex == here.x || vertex == here.y || vertex == here.z ? 1 : 0;
        }
        shapes.push_back(static_cast<std::uint32_t>(2 * i) + (shared >= 2 ? 1U : 0U));
        if (shared >= 2) ++i;
    }
    return shapes;
}

/// The point of a triangle that is nearest to another. Source: [Ericson 2005], 5.1.5.
glm::dvec3 nearest_point(const glm::dvec3& p, const Corners& corners) {
    const auto& [a, b, c] = corners;
    const glm::dvec3 ab = b - a;
    const glm::dvec3 ac = c - a;
    const double d1 = glm::dot(ab, p - a), d2 = glm::dot(ac, p - a);
    if (d1 <= 0.0 && d2 <= 0.0) return a;
    const double d3 = glm::dot(ab, p - b), d4 = glm::dot(ac, p - b);
    if (d3 >= 0.0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
    const double d5 = glm::dot(ab, p - c), d6 = glm::dot(ac, p - c);
    if (d6 >= 0.0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    const double sum = va + vb + vc;
    return a + vb / sum * ab + vc / sum * ac;
}

struct PointQuery {
    std::span<const std::unique_ptr<MeshOfScene>> meshes;
    glm::dvec3 point;
    double enough;  ///< A triangle as near as that ends the query.
    double half_size;
    double distance = infinity;
};

bool come_nearer(RTCPointQueryFunctionArguments* arguments) {
    auto* query = static_cast<PointQuery*>(arguments->userPtr);
    const MeshOfScene& mesh = *query->meshes[arguments->geomID];
    double distance = infinity;
    const std::uint32_t last = mesh.last_of(arguments->primID);
    for (std::uint32_t triangle = mesh.first_of(arguments->primID); triangle <= last; ++triangle) {
        const glm::dvec3 nearest = nearest_point(query->point, mesh.corners(triangle));
        const double here = glm::distance(query->point, nearest);
        if (here < distance) distance = here;
    }
    if (!(distance < query->distance)) return false;
    query->distance = distance;
    // Rounding of the radius is relative, that of boxes is within their margin.
    constexpr double relative_margin = 1.0 + 1e-6;
    arguments->query->radius =
        distance <= query->enough
            ? 0.0F
            : static_cast<float>(distance / query->half_size * relative_margin + margin);
    return true;
}

RTCBuildQuality quality_of(SceneBuild build) {
    return build == SceneBuild::fast ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

int rays_at_once() {
    const char* text = std::getenv("RELIEF_RAY_PACKET");
    const int wanted = text == nullptr ? 16 : std::atoi(text);
    return wanted == 1 || wanted == 4 || wanted == 8 ? wanted : 16;
}

/// Some lanes of a packet as Embree's rays.
template <typename RTCRays>
void copy_rays(const RayPacket& packet, std::size_t begin, std::size_t count, RTCRays& rays) {
    RTCRayN* all = reinterpret_cast<RTCRayN*>(&rays);
    constexpr auto size = static_cast<unsigned>(sizeof(rays.tnear) / sizeof(float));
    for (unsigned i = 0; i < size; ++i) {
        // Where the processor has no packets of this size, Embree ignores which rays are valid. A
        // ray that ends before it begins meets nothing.
        const std::size_t lane = i < count ? begin + i : begin;
        RTCRayN_org_x(all, size, i) = packet.float_origin[0][lane];
        RTCRayN_org_y(all, size, i) = packet.float_origin[1][lane];
        RTCRayN_org_z(all, size, i) = packet.float_origin[2][lane];
        RTCRayN_dir_x(all, size, i) = packet.float_direction[0][lane];
        RTCRayN_dir_y(all, size, i) = packet.float_direction[1][lane];
        RTCRayN_dir_z(all, size, i) = packet.float_direction[2][lane];
        RTCRayN_tnear(all, size, i) = 0.0F;
        RTCRayN_tfar(all, size, i) = i < count ? packet.length[lane] : -1.0F;
        RTCRayN_time(all, size, i) = 0.0F;
        RTCRayN_mask(all, size, i) = 0xffffffff;
        RTCRayN_id(all, size, i) = static_cast<unsigned>(begin) + i;
        RTCRayN_flags(all, size, i) = 0;
    }
}

/// Calls one of Embree's functions for each so many rays of a packet.
template <typename RTCRays, typename Rays, typename Call>
void cast_each(const RayPacket& packet, std::size_t count, const Rays& rays_of, const Call& call) {
    constexpr std::size_t size = sizeof(rays_of(std::declval<RTCRays&>()).tnear) / sizeof(float);
    for (std::size_t begin = 0; begin < count; begin += size) {
        RTCRays all;
        const std::size_t here = std::min(size, count - begin);
        copy_rays(packet, begin, here, rays_of(all));
        alignas(64) std::array<int, size> valid{};
        std::fill_n(valid.begin(), here, -1);
        call(begin, here, valid.data(), all);
    }
}

template <typename RTCRayHits, typename Call>
void cast_nearest(const RayPacket& packet, std::size_t count, const Call& call) {
    cast_each<RTCRayHits>(
        packet, count, [](auto& all) -> auto& { return all.ray; },
        [&](std::size_t, std::size_t, const int* valid, auto& all) {
            std::memset(&all.hit, 0xff, sizeof all.hit);  // No geometry, no instance.
            call(valid, all);
        });
}

template <typename RTCRays, typename Call>
void cast_any(RayPacket& packet, std::size_t count, const Call& call) {
    cast_each<RTCRays>(
        packet, count, [](auto& all) -> auto& { return all; },
        [&](std::size_t begin, std::size_t here, const int* valid, auto& all) {
            call(valid, all);
            for (std::size_t i = 0; i < here; ++i) {
                packet.blocked[begin + i] = RTCRayN_tfar(reinterpret_cast<RTCRayN*>(&all),
                                                         sizeof(all.tnear) / sizeof(float),
                                                         static_cast<unsigned>(i)) < 0.0F;
            }
        });
}

using Place = std::array<std::tuple<double, double, double>, 3>;

/// Returns the key that orders triangles by the positions of their corners.
Place place_of(const Corners& corners) {
    Place place;
    for (std::size_t i = 0; i < 3; ++i)
        place[i] = {corners[i].x, corners[i].y, corners[i].z};
    std::sort(place.begin(), place.end());
    return place;
}

}  // namespace

RayFrame RayPacket::frame(std::size_t lane) const {
    const auto at = [&](const std::array<Numbers, 3>& all) {
        return glm::dvec3(all[0][lane], all[1][lane], all[2][lane]);
    };
    return {at(origin), at(direction), at(first), at(second)};
}

EmbreeScene::EmbreeScene(const EmbreeSpace& space, SceneBuild build, TriangleOrder order)
    : space_(space),
      order_(std::move(order)),
      device_(rtcNewDevice(std::getenv("RELIEF_EMBREE"))),
      scene_(rtcNewScene(device_)),
      build_(build),
      rays_at_once_(rays_at_once()) {
    rtcSetSceneBuildQuality(scene_, quality_of(build_));
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

void EmbreeScene::add(std::uint32_t name, std::span<const glm::vec3> positions,
                      std::span<const glm::uvec3> triangles) {
    add(std::make_unique<MeshOfScene>(
        MeshOfScene{positions.data(), nullptr, triangles, name, space_}));
}

void EmbreeScene::add(std::uint32_t name, std::span<const glm::dvec3> positions,
                      std::span<const glm::uvec3> triangles) {
    add(std::make_unique<MeshOfScene>(
        MeshOfScene{nullptr, positions.data(), triangles, name, space_}));
}

void EmbreeScene::add(std::unique_ptr<MeshOfScene> mesh) {
    mesh->shapes = shapes_of(mesh->triangles);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryBuildQuality(geometry, quality_of(build_));
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh->shapes.size()));
    rtcSetGeometryUserData(geometry, mesh.get());
    rtcSetGeometryBoundsFunction(geometry, find_box, nullptr);
    rtcSetGeometryIntersectFunction(geometry, meet_nearest);
    rtcSetGeometryOccludedFunction(geometry, meet_any);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, mesh->name);
    rtcReleaseGeometry(geometry);
    const std::size_t name = mesh->name;
    if (name >= meshes_.size()) meshes_.resize(name + 1);
    meshes_[name] = std::move(mesh);
}

void EmbreeScene::build() {
    rtcCommitScene(scene_);
}

std::array<glm::dvec3, 3> EmbreeScene::corners(const MetTriangle& met) const {
    return meshes_[met.mesh]->corners(met.triangle);
}

/// Embree gets the ray from where it comes near the scene, which lies within -1 to 1: floats far
/// away are coarse, and Embree ends the program at origins beyond 1.8e18.
void EmbreeScene::set(RayPacket& packet, std::size_t lane, const Ray& ray, double until) const {
    packet.until[lane] = until;
    packet.mesh[lane] = RayPacket::nothing;
    packet.near[lane] = ray.near;
    packet.far[lane] = ray.far;
    const double length = glm::length(ray.direction);
    const glm::dvec3 unit = ray.direction / length;
    const glm::dvec3 origin = (ray.origin - space_.center) / space_.half_size;
    const double away = glm::length(origin);
    const double scale = length / space_.half_size;
    double near = ray.near * scale;
    double far = ray.far * scale;
    bool is_usable = away <= too_far_away && length > 0.0 && std::isfinite(length) && near <= far;
    if (away > far_away) {
        const double middle = -glm::dot(origin, unit);
        is_usable = is_usable && glm::length(origin + middle * unit) <= 2.0;
        near = std::max(near, middle - far_away);
        far = std::min(far, middle + far_away);
    } else {
        far = std::min(far, longest);
    }
    RayFrame frame;
    if (is_usable && near <= far) {
        frame = frame_of(ray.origin, ray.direction);
    } else {
        near = 0.0;
        far = -1.0;
        packet.near[lane] = 0.0;
        packet.far[lane] = -1.0;
    }
    const bool is_nothing = far < near;
    packet.start[lane] = is_nothing ? 0.0 : near / scale;
    packet.scale[lane] = scale;
    const glm::dvec3 start = origin + (near - margin) * unit;
    packet.length[lane] = is_nothing ? 0.0F : static_cast<float>(far - near + 2.0 * margin);
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        packet.origin[a][lane] = frame.origin[axis];
        packet.direction[a][lane] = frame.direction[axis];
        packet.first[a][lane] = frame.first[axis];
        packet.second[a][lane] = frame.second[axis];
        packet.float_origin[a][lane] = is_nothing ? 9.0F : static_cast<float>(start[axis]);
        packet.float_direction[a][lane] = is_nothing ? 1.0F : static_cast<float>(unit[axis]);
    }
}

void EmbreeScene::find_nearest(RayPacket& packet, std::size_t count) const {
    std::vector<TiedHit> tied;
    Cast cast{};
    rtcInitIntersectContext(&cast.context);
    cast.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    cast.packet = &packet;
    cast.tied = &tied;
    packet.mesh.fill(RayPacket::nothing);
    packet.last.fill(-infinity);
    switch (rays_at_once_) {
        case 1:
            cast_nearest<RTCRayHit>(packet, count, [&](const int*, RTCRayHit& rays) {
                rtcIntersect1(scene_, &cast.context, &rays);
            });
            break;
        case 4:
            cast_nearest<RTCRayHit4>(packet, count, [&](const int* valid, RTCRayHit4& rays) {
                rtcIntersect4(valid, scene_, &cast.context, &rays);
            });
            break;
        case 8:
            cast_nearest<RTCRayHit8>(packet, count, [&](const int* valid, RTCRayHit8& rays) {
                rtcIntersect8(valid, scene_, &cast.context, &rays);
            });
            break;
        default:
            cast_nearest<RTCRayHit16>(packet, count, [&](const int* valid, RTCRayHit16& rays) {
                rtcIntersect16(valid, scene_, &cast.context, &rays);
            });
    }
    if (!tied.empty()) settle_ties(packet, tied);
}

/// Gives each lane the first of its nearest hits.
void EmbreeScene::settle_ties(RayPacket& packet, std::vector<TiedHit>& tied) const {
    const auto is_before = [&](const RayFrame& frame, const MetTriangle& a, const MetTriangle& b) {
        const auto rank = [&](const MetTriangle& met) {
            const Corners places = corners(met);
            ExactHit hit;
            intersect(frame, places, hit);
            return std::tuple(!hit.faces_origin, place_of(places));
        };
        const auto first = rank(a);
        const auto second = rank(b);
        if (first != second) return first < second;
        if (order_ && order_(a, b)) return true;
        if (order_ && order_(b, a)) return false;
        return a < b;
    };
    for (const TiedHit& hit : tied) {
        const double tie = tie_share / packet.scale[hit.lane];
        if (hit.distance > packet.distance[hit.lane] + tie) continue;
        const MetTriangle now{packet.mesh[hit.lane], packet.triangle[hit.lane]};
        if (!is_before(packet.frame(hit.lane), hit.met, now)) continue;
        packet.mesh[hit.lane] = hit.met.mesh;
        packet.triangle[hit.lane] = hit.met.triangle;
    }
}

void EmbreeScene::find_any(RayPacket& packet, std::size_t count) const {
    Cast cast{};
    rtcInitIntersectContext(&cast.context);
    cast.packet = &packet;
    switch (rays_at_once_) {
        case 1:
            cast_any<RTCRay>(packet, count, [&](const int*, RTCRay& rays) {
                rtcOccluded1(scene_, &cast.context, &rays);
            });
            break;
        case 4:
            cast_any<RTCRay4>(packet, count, [&](const int* valid, RTCRay4& rays) {
                rtcOccluded4(valid, scene_, &cast.context, &rays);
            });
            break;
        case 8:
            cast_any<RTCRay8>(packet, count, [&](const int* valid, RTCRay8& rays) {
                rtcOccluded8(valid, scene_, &cast.context, &rays);
            });
            break;
        default:
            cast_any<RTCRay16>(packet, count, [&](const int* valid, RTCRay16& rays) {
                rtcOccluded16(valid, scene_, &cast.context, &rays);
            });
    }
}

void EmbreeScene::find_all(const Ray& ray, std::vector<MetTriangle>& found) const {
    RayPacket packet;
    set(packet, 0, ray);
    Cast cast{};
    rtcInitIntersectContext(&cast.context);
    cast.packet = &packet;
    cast.all = &found;
    cast_nearest<RTCRayHit>(
        packet, 1, [&](const int*, RTCRayHit& one) { rtcIntersect1(scene_, &cast.context, &one); });
}

double EmbreeScene::distance_from(const glm::dvec3& point, double enough) const {
    PointQuery ours{meshes_, point, enough, space_.half_size};
    RTCPointQuery query{};
    const glm::vec3 moved((point - space_.center) / space_.half_size);
    query.x = moved.x;
    query.y = moved.y;
    query.z = moved.z;
    query.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, come_nearer, &ours);
    return ours.distance;
}

}  // namespace relief
