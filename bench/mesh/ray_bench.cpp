// SPDX-License-Identifier: Apache-2.0
// Rays of a bake through relief's scene and through Embree's own functions: the same triangles,
// rays and order, interleaved, with one thread. Argument: millions of triangles.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>

#include "bake/ray_scene.h"
#include "bench_support.h"

namespace relief::bench {
using namespace relief::detail;

namespace {

constexpr int side = 1024;

/// The rays of a map of the sphere by longitude and latitude, in blocks of 4 x 4 texels like those
/// of the baker.
std::vector<Ray> rays_of_a_bake() {
    std::vector<Ray> rays;
    for (int block = 0; block < side * side / 16; ++block) {
        for (int i = 0; i < 16; ++i) {
            const int x = block % (side / 4) * 4 + i % 4;
            const int y = block / (side / 4) * 4 + i / 4;
            const double longitude = 2.0 * std::numbers::pi * (x + 0.5) / side;
            const double polar = std::numbers::pi * (y + 0.5) / side;
            const glm::dvec3 outward(std::sin(longitude) * std::sin(polar), std::cos(polar),
                                     std::cos(longitude) * std::sin(polar));
            rays.push_back({1.1 * outward, -outward, 0.0, 0.2});
        }
    }
    return rays;
}

/// An Embree scene of the same triangles in local coordinates.
struct Bare {
    explicit Bare(const Mesh& mesh) : device(rtcNewDevice(nullptr)), scene(rtcNewScene(device)) {
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                 RTC_FORMAT_FLOAT3, 12, mesh.positions.size());
        std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<glm::vec3*>(vertices));
        void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                RTC_FORMAT_UINT3, 12, mesh.triangles.size());
        std::copy(mesh.triangles.begin(), mesh.triangles.end(), static_cast<glm::uvec3*>(corners));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }
    RTCDevice device;
    RTCScene scene;
    RTCIntersectContext context{};
};

template <typename Packet, int size>
std::vector<Packet> packets_of(const std::vector<Ray>& rays) {
    std::vector<Packet> packets(rays.size() / size);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Packet& packet = packets[i / size];
        const std::size_t lane = i % size;
        packet.ray.org_x[lane] = static_cast<float>(rays[i].origin.x);
        packet.ray.org_y[lane] = static_cast<float>(rays[i].origin.y);
        packet.ray.org_z[lane] = static_cast<float>(rays[i].origin.z);
        packet.ray.dir_x[lane] = static_cast<float>(rays[i].direction.x);
        packet.ray.dir_y[lane] = static_cast<float>(rays[i].direction.y);
        packet.ray.dir_z[lane] = static_cast<float>(rays[i].direction.z);
        packet.ray.tfar[lane] = static_cast<float>(rays[i].far);
        packet.ray.mask[lane] = 0xffffffff;
        packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    return packets;
}

std::vector<RTCRayHit> singles_of(const std::vector<Ray>& rays) {
    std::vector<RTCRayHit> singles(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        RTCRay& ray = singles[i].ray;
        ray.org_x = static_cast<float>(rays[i].origin.x);
        ray.org_y = static_cast<float>(rays[i].origin.y);
        ray.org_z = static_cast<float>(rays[i].origin.z);
        ray.dir_x = static_cast<float>(rays[i].direction.x);
        ray.dir_y = static_cast<float>(rays[i].direction.y);
        ray.dir_z = static_cast<float>(rays[i].direction.z);
        ray.tfar = static_cast<float>(rays[i].far);
        ray.mask = 0xffffffff;
        singles[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
    return singles;
}

alignas(64) constexpr std::array<int, 16> all_lanes = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                       -1, -1, -1, -1, -1, -1, -1, -1};

void run(std::size_t triangles) {
    const Mesh mesh = bumpy_sphere(triangles);
    const std::vector<Ray> rays = rays_of_a_bake();
    Bare bare(mesh);
    const RayScene scene({{mesh.positions, mesh.triangles}});
    // Each round begins with rays that have not been cast yet, in memory that has been used before.
    const auto singles = singles_of(rays);
    const auto eights = packets_of<RTCRayHit8, 8>(rays);
    const auto sixteens = packets_of<RTCRayHit16, 16>(rays);
    auto single_copy = singles;
    auto eight_copy = eights;
    auto sixteen_copy = sixteens;
    std::vector<RayPacket> ours(rays.size() / 16);
    const auto fill_ours = [&] {
        for (std::size_t i = 0; i < rays.size(); ++i)
            scene.set(ours[i / 16], i % 16, rays[i]);
    };
    std::size_t hits = 0;
    std::vector<Contender> all;
    all.push_back({"bare, copying and intersect1", [&] {
                       single_copy = singles;
                       for (RTCRayHit& ray : single_copy)
                           rtcIntersect1(bare.scene, &bare.context, &ray);
                   }});
    all.push_back({"bare, copying and stream 1M", [&] {
                       single_copy = singles;
                       rtcIntersect1M(bare.scene, &bare.context, single_copy.data(),
                                      static_cast<unsigned>(single_copy.size()), sizeof(RTCRayHit));
                   }});
    all.push_back({"bare, copying and packets of 8", [&] {
                       eight_copy = eights;
                       for (RTCRayHit8& packet : eight_copy)
                           rtcIntersect8(all_lanes.data(), bare.scene, &bare.context, &packet);
                   }});
    all.push_back({"bare, copying and packets of 16", [&] {
                       sixteen_copy = sixteens;
                       for (RTCRayHit16& packet : sixteen_copy)
                           rtcIntersect16(all_lanes.data(), bare.scene, &bare.context, &packet);
                   }});
    all.push_back({"relief, setting and finding", [&] {
                       fill_ours();
                       for (RayPacket& packet : ours)
                           scene.find(packet, 16);
                   }});
    all.push_back({"relief, setting, finding, exact hits", [&] {
                       fill_ours();
                       hits = 0;
                       for (std::size_t i = 0; i < ours.size(); ++i) {
                           scene.find(ours[i], 16);
                           for (std::size_t lane = 0; lane < 16; ++lane)
                               hits += scene.hit(ours[i], lane).is_hit() ? 1 : 0;
                       }
                   }});
    measure(all, 7);
    fmt::print("{} triangles, {} rays, {} hits, one thread\n", mesh.triangles.size(), rays.size(),
               hits);
    for (const Contender& one : all) {
        std::vector<double> sorted = one.nanoseconds;
        std::sort(sorted.begin(), sorted.end());
        const auto rate = [&](double taken) {
            return static_cast<double>(rays.size()) * 1e3 / taken;
        };
        fmt::print("{:40} {:6.1f} Mray/s ({:.1f} to {:.1f})\n", one.name,
                   rate(sorted[sorted.size() / 2]), rate(sorted.back()), rate(sorted.front()));
    }
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    const double millions = argc > 1 ? std::atof(argv[1]) : 1.0;
    relief::bench::run(static_cast<std::size_t>(millions * 1e6));
}
