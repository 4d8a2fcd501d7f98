// SPDX-License-Identifier: Apache-2.0
// Ray casting with Embree. Clusters of triangles are user geometry: Embree calls back for the boxes
// of clusters, and for the hits in each cluster whose box a ray hits. Tests:
// tests/mesh/rays/embree_scene_test.cpp.
#include "bake/embree_scene.h"

#if RELIEF_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// A hit that may tie with another one of the same ray.
struct TiedHit {
    std::size_t lane = 0;
    double distance = 0.0;
    MetTriangle met;
};

struct EmbreeScene::MeshOfScene {
    virtual ~MeshOfScene() = default;
    [[nodiscard]] virtual std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const = 0;
    /// Returns the distance of the nearest triangle of a cluster from a point.
    [[nodiscard]] virtual double distance_from(const glm::dvec3& point,
                                               std::uint32_t cluster) const = 0;
};

namespace {

using Corners = std::array<glm::dvec3, 3>;

/// Returns the point of a triangle nearest to `p`. Source: [Ericson 2005], 5.1.5.
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

/// Returns the triangle rotated to begin with its first corner by position, so that rounding does
/// not depend on the given first corner.
Corners from_first_position(Corners corners) {
    const auto first = std::min_element(
        corners.begin(), corners.end(), [](const glm::dvec3& p, const glm::dvec3& q) {
            return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
        });
    std::rotate(corners.begin(), first, corners.end());
    return corners;
}

template <typename Number>
struct ClusteredMesh : EmbreeScene::MeshOfScene {
    std::uint32_t name = 0;
    std::span<const glm::vec<3, Number>> positions;
    std::span<const glm::uvec3> triangles;
    TriangleClusters<Number> shapes{};  ///< Each cluster is one primitive of Embree.

    [[nodiscard]] Corners corners(std::uint32_t triangle) const override {
        const glm::uvec3& all = triangles[triangle];
        return {glm::dvec3(positions[all.x]), glm::dvec3(positions[all.y]),
                glm::dvec3(positions[all.z])};
    }
    [[nodiscard]] double distance_from(const glm::dvec3& point,
                                       std::uint32_t cluster) const override {
        const TriangleCluster<Number>& all = shapes.clusters[cluster];
        double distance = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < all.size && all.triangles[i] != all.none; ++i) {
            const glm::dvec3 nearest = nearest_point(point, from_first_position(all.corners_of(i)));
            distance = std::min(distance, glm::distance(point, nearest));
        }
        return distance;
    }
};

/// Distances that differ by less than this are ties, in Embree's space: the rounding error of
/// double, with a factor of 1000 for triangles at a grazing angle.
constexpr double tie_share = 1e-12;
/// Origins farther away than this are moved along their rays, in Embree's space.
constexpr double far_away = 4.0;
/// The maximum length of rays, in Embree's space: beyond the scene, and beyond a camera's far
/// plane, which is at 1.
constexpr double max_length = 64.0;
/// At this distance, doubles are as coarse as floats within the scene.
constexpr double max_origin = 1e10;

constexpr double infinity = std::numeric_limits<double>::infinity();

#if RELIEF_EMBREE_MAJOR == 3
using RayContext = RTCIntersectContext;
#else
using RayContext = RTCRayQueryContext;
#endif

/// The state of one call of Embree. The context comes first, because Embree passes its address.
struct Cast {
    RayContext context;
    bool is_coherent;
    RayPacket* packet;
    bool have_one_axis;  ///< All rays have the same RayLines::along.
    std::vector<TiedHit>* tied;
    std::vector<MetTriangle>* all;  ///< If not null, gets every hit.
};

/// Records a hit of a lane, if it may be the nearest one or a tie.
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

/// Calls each(triangle, hit) for the hits of a ray in a cluster, until that returns false.
/// \param places  the candidates, a bit for each triangle
template <typename Number, typename Each>
void for_hits(const RayPacket& packet, std::size_t lane, const TriangleCluster<Number>& cluster,
              std::uint64_t places, const Each& each) {
    for (; places != 0; places &= places - 1) {
        const auto place = static_cast<std::size_t>(std::countr_zero(places));
        ExactHit hit;
        if (!intersect(packet.frame[lane], cluster.corners_of(place), hit)) continue;
        if (hit.distance < packet.near[lane] || hit.distance > packet.far[lane]) continue;
        if (!each(cluster.triangles[place], hit)) return;
    }
}

/// Calls each(i, lane, candidates) for Embree's valid rays.
template <typename Number, typename Each>
void for_rays(const Cast& cast, const int* valid, const unsigned* lane, unsigned count,
              const TriangleCluster<Number>& cluster, const Each& each) {
    constexpr unsigned min_block = 4;  // Fewer rays are tested one by one.
    const RayLines<16>& lines = cast.packet->lines;
    unsigned active = 0;
    for (unsigned i = 0; i < count; ++i)
        active += valid[i] != 0 ? 1U : 0U;
    const bool is_block = active >= min_block && cast.have_one_axis;
    alignas(64) std::array<std::uint64_t, RayPacket::size> bits;
    if (is_block) candidates<Number>(cluster, lines, lane[0], count, bits);
    for (unsigned i = 0; i < count; ++i) {
        if (valid[i] == 0) continue;
        const std::uint64_t places =
            is_block ? bits[i] : candidates<Number>(cluster, lines, lane[i]);
        if (places != 0) each(i, static_cast<std::size_t>(lane[i]), places);
    }
}

template <typename Number>
void intersect_nearest(const RTCIntersectFunctionNArguments* arguments) {
    const auto& mesh = *static_cast<const ClusteredMesh<Number>*>(arguments->geometryUserPtr);
    const TriangleCluster<Number>& cluster = mesh.shapes.clusters[arguments->primID];
    Cast& cast = *reinterpret_cast<Cast*>(arguments->context);
    RayPacket& packet = *cast.packet;
    const unsigned count = arguments->N;
    RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, count);
    float* const far = &RTCRayN_tfar(rays, count, 0);
    const auto visit = [&](unsigned i, std::size_t lane, std::uint64_t places) {
        for_hits(packet, lane, cluster, places, [&](std::uint32_t triangle, const ExactHit& hit) {
            if (cast.all != nullptr) {
                cast.all->push_back({mesh.name, triangle});
                return true;
            }
            keep_nearest(cast, lane, hit.distance, {mesh.name, triangle});
            if (hit.distance <= packet.until[lane])
                packet.last[lane] = std::max(packet.last[lane], hit.distance);
            // Farther hits are not needed. The margin covers the rounding errors of Embree's
            // floats.
            const double end = std::max(hit.distance, packet.until[lane]);
            const double from_start = (end - packet.start[lane]) * packet.scale[lane];
            far[i] = std::min(far[i], static_cast<float>(from_start + 3.0 * embree_margin));
            return true;
        });
    };
    for_rays(cast, arguments->valid, &RTCRayN_id(rays, count, 0), count, cluster, visit);
}

template <typename Number>
void intersect_any(const RTCOccludedFunctionNArguments* arguments) {
    const auto& mesh = *static_cast<const ClusteredMesh<Number>*>(arguments->geometryUserPtr);
    const TriangleCluster<Number>& cluster = mesh.shapes.clusters[arguments->primID];
    const Cast& cast = *reinterpret_cast<Cast*>(arguments->context);
    const unsigned count = arguments->N;
    float* const far = &RTCRayN_tfar(arguments->ray, count, 0);
    const auto visit = [&](unsigned i, std::size_t lane, std::uint64_t places) {
        for_hits(*cast.packet, lane, cluster, places, [&](std::uint32_t, const ExactHit&) {
            far[i] = -std::numeric_limits<float>::infinity();
            return false;
        });
    };
    for_rays(cast, arguments->valid, &RTCRayN_id(arguments->ray, count, 0), count, cluster, visit);
}

template <typename Number>
void find_box(const RTCBoundsFunctionArguments* arguments) {
    const auto& mesh = *static_cast<const ClusteredMesh<Number>*>(arguments->geometryUserPtr);
    const EmbreeBox& box = mesh.shapes.boxes[arguments->primID];
    *arguments->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0.0F,
                            box.upper.x, box.upper.y, box.upper.z, 0.0F};
}

struct PointQuery {
    std::span<const std::unique_ptr<EmbreeScene::MeshOfScene>> meshes;
    glm::dvec3 point;
    double enough;  ///< A triangle within this distance ends the query.
    double half_size;
    double distance = infinity;
};

bool visit_cluster(RTCPointQueryFunctionArguments* arguments) {
    auto* query = static_cast<PointQuery*>(arguments->userPtr);
    const double distance =
        query->meshes[arguments->geomID]->distance_from(query->point, arguments->primID);
    if (!(distance < query->distance)) return false;
    query->distance = distance;
    // The radius has a relative rounding error; embree_margin covers that of the boxes.
    constexpr double relative_margin = 1.0 + 1e-6;
    arguments->query->radius =
        distance <= query->enough
            ? 0.0F
            : static_cast<float>(distance / query->half_size * relative_margin + embree_margin);
    return true;
}

RTCBuildQuality quality_of(SceneBuild build) {
    return build == SceneBuild::fast ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

std::optional<int> rays_at_once() {
    const char* text = std::getenv("RELIEF_RAY_PACKET");
    if (text == nullptr) return std::nullopt;
    const int wanted = std::atoi(text);
    return wanted == 1 || wanted == 4 || wanted == 8 ? wanted : 16;
}

/// Copies lanes of a packet to Embree's rays.
template <typename RTCRays>
void copy_rays(const RayPacket& packet, std::size_t begin, std::size_t count, RTCRays& rays) {
    RTCRayN* all = reinterpret_cast<RTCRayN*>(&rays);
    constexpr auto size = static_cast<unsigned>(sizeof(rays.tnear) / sizeof(float));
    for (unsigned i = 0; i < size; ++i) {
        // If the processor has no packets of this size, Embree ignores the valid flags. A ray with
        // a negative length hits nothing.
        const std::size_t lane = i < count ? begin + i : begin;
        RTCRayN_org_x(all, size, i) = packet.float_origin[lane].x;
        RTCRayN_org_y(all, size, i) = packet.float_origin[lane].y;
        RTCRayN_org_z(all, size, i) = packet.float_origin[lane].z;
        RTCRayN_dir_x(all, size, i) = packet.float_direction[lane].x;
        RTCRayN_dir_y(all, size, i) = packet.float_direction[lane].y;
        RTCRayN_dir_z(all, size, i) = packet.float_direction[lane].z;
        RTCRayN_tnear(all, size, i) = 0.0F;
        RTCRayN_tfar(all, size, i) = i < count ? packet.length[lane] : -1.0F;
        RTCRayN_time(all, size, i) = 0.0F;
        RTCRayN_mask(all, size, i) = 0xffffffff;
        RTCRayN_id(all, size, i) = static_cast<unsigned>(begin) + i;
        RTCRayN_flags(all, size, i) = 0;
    }
}

/// Splits a packet into packets of Embree and calls call(begin, count, valid, rays) for each.
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

/// Calls one of rtcIntersect1() to rtcIntersect16() or rtcOccluded1() to rtcOccluded16().
/// \param valid  the flags of the rays; none for a single ray
template <typename Function, typename Rays, typename... Valid>
void cast_rays(Function* function, RTCScene scene, Cast& cast, Rays& rays, Valid... valid) {
#if RELIEF_EMBREE_MAJOR == 3
    rtcInitIntersectContext(&cast.context);
    if (cast.is_coherent) cast.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    function(valid..., scene, &cast.context, &rays);
#else
    rtcInitRayQueryContext(&cast.context);
    constexpr bool has_hits = requires {
        rays.hit;
    };
    std::conditional_t<has_hits, RTCIntersectArguments, RTCOccludedArguments> arguments;
    if constexpr (has_hits)
        rtcInitIntersectArguments(&arguments);
    else
        rtcInitOccludedArguments(&arguments);
    if (cast.is_coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    arguments.context = &cast.context;
    function(valid..., scene, &rays, &arguments);
#endif
}

bool have_one_axis(const RayPacket& packet, std::size_t count) {
    const auto& along = packet.lines.along;
    return std::all_of(along.begin(), along.begin() + static_cast<std::ptrdiff_t>(count),
                       [&](std::uint8_t axis) { return axis == along[0]; });
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

/// Throws if Embree reported an error. \param device  null for an error of rtcNewDevice()
void check_error(RTCDevice device, const std::string& action) {
    switch (const RTCError error = rtcGetDeviceError(device)) {
        case RTC_ERROR_NONE:
            return;
        case RTC_ERROR_OUT_OF_MEMORY:
            throw std::bad_alloc();
        case RTC_ERROR_UNSUPPORTED_CPU:
            throw Error(fmt::format("Embree {}: this processor lacks the instruction set", action));
        default:
            throw Error(fmt::format("Embree {}: error {}", action, static_cast<int>(error)));
    }
}

/// \throws Error if the processor, or the configuration in RELIEF_EMBREE, is not supported
RTCDevice new_device() {
    const char* const configuration = std::getenv("RELIEF_EMBREE");
    RTCDevice device = rtcNewDevice(configuration);
    if (device != nullptr) return device;
    const std::string action =
        configuration == nullptr ? "cannot start"
                                 : fmt::format("cannot start with RELIEF_EMBREE={}", configuration);
    check_error(nullptr, action);
    throw Error("Embree " + action);
}

using SortedCorners = std::array<std::tuple<double, double, double>, 3>;

/// Returns the key that orders triangles by the positions of their corners.
SortedCorners sorted_corners(const Corners& corners) {
    SortedCorners sorted;
    for (std::size_t i = 0; i < 3; ++i)
        sorted[i] = {corners[i].x, corners[i].y, corners[i].z};
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

}  // namespace

EmbreeScene::EmbreeScene(const EmbreeSpace& space, SceneBuild build, TriangleOrder order)
    : space_(space),
      order_(std::move(order)),
      device_(new_device()),
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
    add<float>(name, positions, triangles);
}

void EmbreeScene::add(std::uint32_t name, std::span<const glm::dvec3> positions,
                      std::span<const glm::uvec3> triangles) {
    add<double>(name, positions, triangles);
}

template <typename Number>
void EmbreeScene::add(std::uint32_t name, std::span<const glm::vec<3, Number>> positions,
                      std::span<const glm::uvec3> triangles) {
    auto mesh = std::make_unique<ClusteredMesh<Number>>();
    mesh->name = name;
    mesh->positions = positions;
    mesh->triangles = triangles;
    mesh->shapes = make_clusters(positions, triangles, space_);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryBuildQuality(geometry, quality_of(build_));
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh->shapes.boxes.size()));
    rtcSetGeometryUserData(geometry, mesh.get());
    rtcSetGeometryBoundsFunction(geometry, find_box<Number>, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_nearest<Number>);
    rtcSetGeometryOccludedFunction(geometry, intersect_any<Number>);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, name);
    rtcReleaseGeometry(geometry);
    if (name >= meshes_.size()) meshes_.resize(name + 1);
    meshes_[name] = std::move(mesh);
}

void EmbreeScene::build() {
    if (current_progress != nullptr) {
        const auto goes_on = [](void* progress, double) {
            return !static_cast<const Progress*>(progress)->is_cancelled();
        };
        rtcSetSceneProgressMonitorFunction(scene_, goes_on, current_progress);
    }
    rtcCommitScene(scene_);
    rtcSetSceneProgressMonitorFunction(scene_, nullptr, nullptr);
    check_cancelled();
    check_error(device_, "cannot build the scene");
}

std::array<glm::dvec3, 3> EmbreeScene::corners(const MetTriangle& met) const {
    return meshes_[met.mesh]->corners(met.triangle);
}

/// Embree's ray starts near the scene, which lies within -1 to 1, because floats far away are
/// coarse and Embree aborts at origins beyond 1.8e18.
void EmbreeScene::set(RayPacket& packet, std::size_t lane, const Ray& ray, double until) const {
    packet.until[lane] = until;
    packet.near[lane] = ray.near;
    packet.far[lane] = ray.far;
    const double length = glm::length(ray.direction);
    const glm::dvec3 unit = ray.direction / length;
    const glm::dvec3 origin = (ray.origin - space_.center) * (1.0 / space_.half_size);
    const double away_squared = glm::dot(origin, origin);
    const double scale = length / space_.half_size;
    double near = ray.near * scale;
    double far = ray.far * scale;
    double start = ray.near;
    bool is_usable = away_squared <= max_origin * max_origin && length > 0.0 &&
                     std::isfinite(length) && near <= far;
    if (away_squared > far_away * far_away) {
        const double middle = -glm::dot(origin, unit);
        is_usable = is_usable && glm::length(origin + middle * unit) <= 2.0;
        near = std::max(near, middle - far_away);
        far = std::min(far, middle + far_away);
        start = near / scale;
    } else {
        far = std::min(far, max_length);
    }
    packet.scale[lane] = scale;
    if (!(is_usable && near <= far)) {
        packet.near[lane] = 0.0;
        packet.far[lane] = -1.0;
        packet.start[lane] = 0.0;
        packet.frame[lane] = {};
        packet.lines.set(lane, {});
        packet.float_origin[lane] = glm::vec3(9.0F);
        packet.float_direction[lane] = glm::vec3(1.0F);
        packet.length[lane] = 0.0F;
        return;
    }
    packet.frame[lane] = frame_of(ray.origin, ray.direction);
    packet.lines.set(lane, packet.frame[lane]);
    packet.start[lane] = start;
    packet.float_origin[lane] = glm::vec3(origin + (near - embree_margin) * unit);
    packet.float_direction[lane] = glm::vec3(unit);
    packet.length[lane] = static_cast<float>(far - near + 2.0 * embree_margin);
}

void EmbreeScene::find_nearest(RayPacket& packet, std::size_t count) const {
    std::vector<TiedHit> tied;
    Cast cast{};
    cast.is_coherent = true;
    cast.packet = &packet;
    cast.have_one_axis = have_one_axis(packet, count);
    cast.tied = &tied;
    packet.mesh.fill(RayPacket::nothing);
    packet.last.fill(-infinity);
    switch (rays_at_once_.value_or(16)) {
        case 1:
            cast_nearest<RTCRayHit>(packet, count, [&](const int*, RTCRayHit& rays) {
                cast_rays(rtcIntersect1, scene_, cast, rays);
            });
            break;
        case 4:
            cast_nearest<RTCRayHit4>(packet, count, [&](const int* valid, RTCRayHit4& rays) {
                cast_rays(rtcIntersect4, scene_, cast, rays, valid);
            });
            break;
        case 8:
            cast_nearest<RTCRayHit8>(packet, count, [&](const int* valid, RTCRayHit8& rays) {
                cast_rays(rtcIntersect8, scene_, cast, rays, valid);
            });
            break;
        default:
            cast_nearest<RTCRayHit16>(packet, count, [&](const int* valid, RTCRayHit16& rays) {
                cast_rays(rtcIntersect16, scene_, cast, rays, valid);
            });
    }
    if (!tied.empty()) settle_ties(packet, tied);
}

/// Selects the first of the tied hits of each lane.
void EmbreeScene::settle_ties(RayPacket& packet, std::vector<TiedHit>& tied) const {
    const auto is_before = [&](const RayFrame& frame, const MetTriangle& a, const MetTriangle& b) {
        const auto rank = [&](const MetTriangle& met) {
            const Corners positions = corners(met);
            ExactHit hit;
            intersect(frame, positions, hit);
            return std::tuple(!hit.faces_origin, sorted_corners(positions));
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
        if (!is_before(packet.frame[hit.lane], hit.met, now)) continue;
        packet.mesh[hit.lane] = hit.met.mesh;
        packet.triangle[hit.lane] = hit.met.triangle;
    }
}

void EmbreeScene::find_any(RayPacket& packet, std::size_t count) const {
    Cast cast{};
    cast.packet = &packet;
    // These rays are incoherent, so packets are slower.
    switch (rays_at_once_.value_or(1)) {
        case 1:
            cast_any<RTCRay>(packet, count, [&](const int*, RTCRay& rays) {
                cast_rays(rtcOccluded1, scene_, cast, rays);
            });
            break;
        case 4:
            cast_any<RTCRay4>(packet, count, [&](const int* valid, RTCRay4& rays) {
                cast_rays(rtcOccluded4, scene_, cast, rays, valid);
            });
            break;
        case 8:
            cast_any<RTCRay8>(packet, count, [&](const int* valid, RTCRay8& rays) {
                cast_rays(rtcOccluded8, scene_, cast, rays, valid);
            });
            break;
        default:
            cast_any<RTCRay16>(packet, count, [&](const int* valid, RTCRay16& rays) {
                cast_rays(rtcOccluded16, scene_, cast, rays, valid);
            });
    }
}

void EmbreeScene::find_all(const Ray& ray, std::vector<MetTriangle>& triangles) const {
    RayPacket packet;
    set(packet, 0, ray);
    Cast cast{};
    cast.packet = &packet;
    cast.all = &triangles;
    cast_nearest<RTCRayHit>(packet, 1, [&](const int*, RTCRayHit& one) {
        cast_rays(rtcIntersect1, scene_, cast, one);
    });
}

double EmbreeScene::distance_from(const glm::dvec3& point, double enough) const {
    PointQuery state{meshes_, point, enough, space_.half_size};
    RTCPointQuery query{};
    const glm::vec3 moved((point - space_.center) / space_.half_size);
    query.x = moved.x;
    query.y = moved.y;
    query.z = moved.z;
    query.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, visit_cluster, &state);
    return state.distance;
}

}  // namespace relief::detail
