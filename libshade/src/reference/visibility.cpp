// SPDX-License-Identifier: Apache-2.0
// Rays from the eye by Embree, made exact. See visibility.h. Embree sees the scene divided by the
// camera's far distance, so that no scale is too large or too small for its floats.
// Tests: tests/shade/reference/visibility_test.cpp.
#include "reference/visibility.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <tuple>

namespace relief::reference {

namespace {

/// What Embree's filter gets: a place to put every hit. The context comes first, as Embree casts.
struct Collector {
    RTCIntersectContext context;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;  ///< Instance and triangle.
};

/// Keeps the hit in mind and sends the ray on.
void collect(const RTCFilterFunctionNArguments* arguments) {
    auto* collector = reinterpret_cast<Collector*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        collector->found.emplace_back(RTCHitN_geomID(arguments->hit, arguments->N, i),
                                      RTCHitN_primID(arguments->hit, arguments->N, i));
        arguments->valid[i] = 0;
    }
}

/// Positions in Embree's scale; what is too far away for it, or not finite, it leaves out.
void fill_vertices(RTCGeometry geometry, std::span<const glm::dvec3> positions, double scale) {
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), positions.size()));
    if (vertices == nullptr) throw std::bad_alloc();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            vertices[3 * i + static_cast<std::size_t>(axis)] =
                static_cast<float>(positions[i][axis] * scale);
        }
    }
}

void fill_triangles(RTCGeometry geometry, std::span<const glm::uvec3> triangles) {
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), triangles.size()));
    if (indices == nullptr) throw std::bad_alloc();
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        indices[3 * i] = triangles[i].x;
        indices[3 * i + 1] = triangles[i].y;
        indices[3 * i + 2] = triangles[i].z;
    }
}

/// Where the ray meets the plane of a triangle: weights of the corners, and the depth. For a ray d
/// from the origin the weights are as d.(b x c) : d.(c x a) : d.(a x b), and neighbours see exactly
/// opposite values for the edge that they share.
bool intersect(const glm::dvec3& ray, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
               Hit& hit) {
    const glm::dvec3 weights(glm::dot(ray, glm::cross(b, c)), glm::dot(ray, glm::cross(c, a)),
                             glm::dot(ray, glm::cross(a, b)));
    const double sum = weights.x + weights.y + weights.z;
    if (!(std::abs(sum) > 0.0) || !std::isfinite(sum)) return false;
    hit.barycentric = weights / sum;
    hit.depth = -(hit.barycentric.x * a.z + hit.barycentric.y * b.z + hit.barycentric.z * c.z);
    // The triple product a.(b x c) is negative where the eye sees a, b, c counter-clockwise; with
    // depth positive, so is the sum.
    hit.counter_clockwise = sum < 0.0;
    return std::isfinite(hit.depth);
}

}  // namespace

struct Visibility::EmbreeScene {
    EmbreeScene() : device(rtcNewDevice(nullptr)), scene(rtcNewScene(device)) {}
    ~EmbreeScene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCDevice device;
    RTCScene scene;
};

Visibility::Visibility(std::vector<ViewMesh> meshes, double near, double far)
    : meshes_(std::move(meshes)), near_(near), far_(far), embree_(std::make_unique<EmbreeScene>()) {
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        if (meshes_[i].triangles.empty()) continue;
        RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        fill_vertices(geometry, meshes_[i].positions_view, 1.0 / far);
        fill_triangles(geometry, meshes_[i].triangles);
        rtcSetGeometryIntersectFilterFunction(geometry, collect);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(embree_->scene, geometry, static_cast<unsigned>(i));
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(embree_->scene);
}

Visibility::~Visibility() = default;

/// Whether b has the edge of a that lies opposite to one of its corners.
bool Visibility::shares_edge(const Hit& a, int opposite_corner, const Hit& b) const {
    if (a.instance != b.instance) return false;
    const ViewMesh& mesh = meshes_[a.instance];
    const auto has = [&](const glm::dvec3& position) {
        const glm::uvec3& corners = mesh.triangles[b.triangle];
        for (int i = 0; i < 3; ++i) {
            if (mesh.positions_view[corners[i]] == position) return true;
        }
        return false;
    };
    const glm::uvec3& corners = mesh.triangles[a.triangle];
    return has(mesh.positions_view[corners[(opposite_corner + 1) % 3]]) &&
           has(mesh.positions_view[corners[(opposite_corner + 2) % 3]]);
}

/// Whether a triangle found by Embree is missed by the exact ray, which meets its neighbour; on the
/// edge itself the first of both counts.
bool Visibility::is_outside(const std::vector<Hit>& all, std::size_t index) const {
    const Hit& hit = all[index];
    for (int corner = 0; corner < 3; ++corner) {
        if (hit.barycentric[corner] > 0.0) continue;
        for (std::size_t other = 0; other < all.size(); ++other) {
            if (other == index || !shares_edge(hit, corner, all[other])) continue;
            if (hit.barycentric[corner] < 0.0 || other < index) return true;
        }
    }
    return false;
}

std::vector<Hit> Visibility::hits(double x, double y) const {
    Collector collector{};
    rtcInitIntersectContext(&collector.context);
    RTCRayHit query{};
    query.ray.dir_x = static_cast<float>(x);
    query.ray.dir_y = static_cast<float>(y);
    query.ray.dir_z = -1.0F;
    // A little beyond both ends, for the exact test to decide.
    query.ray.tnear = static_cast<float>(near_ / far_ * 0.999);
    query.ray.tfar = 1.001F;
    query.ray.mask = std::numeric_limits<unsigned>::max();
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &collector.context, &query);

    const glm::dvec3 ray(x, y, -1.0);
    std::vector<Hit> all;
    for (const auto& [instance, triangle] : collector.found) {
        const ViewMesh& mesh = meshes_[instance];
        const glm::uvec3& corners = mesh.triangles[triangle];
        Hit hit{instance, triangle};
        if (!intersect(ray, mesh.positions_view[corners.x], mesh.positions_view[corners.y],
                       mesh.positions_view[corners.z], hit)) {
            continue;
        }
        if (hit.depth >= near_ && hit.depth <= far_) all.push_back(hit);
    }
    const auto rank = [](const Hit& hit) {
        return std::tuple(hit.depth, hit.instance, hit.triangle);
    };
    std::sort(all.begin(), all.end(),
              [&](const Hit& a, const Hit& b) { return rank(a) < rank(b); });
    all.erase(std::unique(all.begin(), all.end(),
                          [&](const Hit& a, const Hit& b) { return rank(a) == rank(b); }),
              all.end());
    std::vector<Hit> inside;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!is_outside(all, i)) inside.push_back(all[i]);
    }
    return inside;
}

}  // namespace relief::reference
