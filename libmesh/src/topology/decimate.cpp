// SPDX-License-Identifier: Apache-2.0
// Edge-collapse decimation with OpenMesh's decimater and an own module.
//
// The error is a quadric of distance and, if the mesh has texture coordinates, of the texture's
// movement ([Garland and Heckbert 1997], [Hoppe 1999]). Both are in squared units of length,
// weighted by area. A collapse moves a vertex onto a neighbor, so the result uses a subset of the
// vertices with all their attributes. Seams, material borders and boundaries are lines: a vertex on
// a line moves only along it, and a vertex where lines meet or end does not move. Both sides of a
// seam therefore stay together and keep their texture coordinates. Collapses that flip a triangle,
// in space or in the texture, or make its area zero are refused. Ties: the lower index wins.
//
// The vertices of the mesh are the wedges of a manifold surface (topology.h). Positions are scaled
// into [-1, 1] by a power of two, so the result does not depend on the unit of length.
#include "relief/mesh/decimate.h"

#include <fmt/format.h>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "geometry/direction.h"
#include "geometry/weld.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"
#include "topology/openmesh.h"
#include "topology/topology.h"

// QuadricT.hh does not include what it needs.
#include <OpenMesh/Core/Geometry/QuadricT.hh>

namespace relief {
namespace {

/// The input of a decimation, and when to stop. All spans outlive the call.
struct Decimation {
    const Topology& topology;
    std::span<const glm::dvec3> points;  ///< By vertex of the topology; within [-1, 1].
    /// For each triangle of the topology, the mesh vertices at its corners. If those of two
    /// neighbors differ along their edge, there is a seam.
    std::span<const glm::uvec3> wedges;
    /// For each triangle, the index of its material range. Ranges are not mixed.
    std::span<const std::uint32_t> parts;
    std::span<const glm::vec2> texcoords;  ///< By mesh vertex, or empty.
    std::optional<std::size_t> triangles;  ///< The number of triangles to stop at.
    std::optional<double> max_error;       ///< The maximum error in the unit of the points.
};

using Quadric = OpenMesh::Geometry::QuadricT<double>;
using CollapseInfo = OpenMesh::Decimater::CollapseInfoT<SurfaceMesh>;

/// The maximum rotation of a triangle in one move: about 78 degrees.
constexpr double min_turn_cosine = 0.2;

/// The weight of the squared length, which prefers short edges if costs are otherwise equal.
constexpr double length_preference = 1e-7;

/// The cost of moving along a line, relative to that of leaving the surface.
constexpr double line_weight = 1.0;

glm::dvec3 to_glm(const OpenMesh::Vec3d& v) {
    return {v[0], v[1], v[2]};
}

/// The part of the quadric of [Hoppe 1999] for texture coordinates, for both at once: the integral
/// of |gradient * p + offset - t|^2 over the added triangles.
struct TextureQuadric {
    double area = 0.0;
    glm::dmat3 squares{0.0};               ///< Sum of gradient^T gradient.
    glm::dvec3 mixed{0.0};                 ///< Sum of gradient^T offset.
    double offsets = 0.0;                  ///< Sum of |offset|^2.
    std::array<glm::dvec3, 2> gradient{};  ///< Sums, for u and v.
    glm::dvec2 offset{0.0};

    TextureQuadric& operator+=(const TextureQuadric& other) {
        area += other.area;
        squares += other.squares;
        mixed += other.mixed;
        offsets += other.offsets;
        gradient[0] += other.gradient[0];
        gradient[1] += other.gradient[1];
        offset += other.offset;
        return *this;
    }

    [[nodiscard]] double operator()(const glm::dvec3& p, const glm::dvec2& t) const {
        const glm::dvec2 slope(glm::dot(gradient[0], p), glm::dot(gradient[1], p));
        return std::max(0.0, glm::dot(p, squares * p) + 2.0 * glm::dot(mixed, p) + offsets -
                                 2.0 * glm::dot(t, slope + offset) + area * glm::dot(t, t));
    }
};

/// Returns the squared distance from a point to a triangle.
double squared_distance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                        const glm::dvec3& c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const std::array<glm::dvec3, 3> corners = {a, b, c};
    bool is_above = glm::dot(normal, normal) > 0.0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
        const glm::dvec3 offset = p - corners[i];
        if (glm::dot(glm::cross(normal, edge), offset) < 0.0) is_above = false;
        const double length = glm::dot(edge, edge);
        const double along =
            length > 0.0 ? std::clamp(glm::dot(edge, offset) / length, 0.0, 1.0) : 0.0;
        const glm::dvec3 away = offset - along * edge;
        nearest = std::min(nearest, glm::dot(away, away));
    }
    if (!is_above) return nearest;
    const double height = glm::dot(normal, p - a);
    return std::min(nearest, height * height / glm::dot(normal, normal));
}

/// A triangle that remains when a vertex moves, and its corner at that vertex.
struct MovedFace {
    int face = 0;
    int corner = 0;  ///< The corner of the face that moves.
    std::uint32_t wedge_before = 0;
    std::uint32_t wedge_after = 0;
};

/// The triangles around a vertex, counter-clockwise from the edge along which it may move.
class Ring {
  public:
    struct Spoke {
        int face;      ///< The face on the left; -1 at a boundary.
        bool is_line;  ///< True for a seam, a border or a boundary.
    };
    std::vector<Spoke> spokes;
    std::vector<MovedFace> moved;
};

/// The decimater module that computes the cost of moves and updates wedges.
class SeamQuadrics : public OpenMesh::Decimater::ModBaseT<SurfaceMesh> {
  public:
    using Handle = OpenMesh::Decimater::ModHandleT<SeamQuadrics>;
    using Base = OpenMesh::Decimater::ModBaseT<SurfaceMesh>;

    explicit SeamQuadrics(SurfaceMesh& mesh) : Base(mesh, false) {}
    DECIMATER_MODNAME(SeamQuadrics)

    void use(const Decimation& decimation) { input_ = &decimation; }
    void initialize() override;
    float collapse_priority(const CollapseInfo& move) override;
    void preprocess_collapse(const CollapseInfo& move) override;
    void postprocess_collapse(const CollapseInfo& move) override;

    [[nodiscard]] const std::vector<glm::uvec3>& wedges() const { return wedges_; }

  private:
    void add_triangle_quadrics(std::size_t face);
    void add_line_quadric(SurfaceMesh::EdgeHandle edge);
    void set_texture_scale();
    [[nodiscard]] bool is_line(int left, int right, int vertex) const;
    [[nodiscard]] int corner_of(int face, int vertex) const;
    [[nodiscard]] std::uint32_t wedge_at(int face, int vertex) const;
    [[nodiscard]] glm::dvec3 point(int vertex) const { return input_->points[index(vertex)]; }
    [[nodiscard]] glm::dvec2 texcoord(std::uint32_t wedge) const {
        return glm::dvec2(input_->texcoords[wedge]);
    }
    static std::size_t index(int number) { return static_cast<std::size_t>(number); }

    bool look_around(const CollapseInfo& move);
    void gather_moved(const CollapseInfo& move);
    [[nodiscard]] bool joins_lines(const CollapseInfo& move);
    [[nodiscard]] bool turns_over(const MovedFace& moved, const CollapseInfo& move) const;
    [[nodiscard]] bool turns_texture_over(const MovedFace& moved) const;
    [[nodiscard]] double texture_cost(const CollapseInfo& move) const;
    [[nodiscard]] std::pair<double, int> nearest_face(std::uint32_t point_number,
                                                      const glm::dvec3& moved_to) const;
    [[nodiscard]] bool keeps_points_near(const CollapseInfo& move);
    void gather_points(const CollapseInfo& move);

    const Decimation* input_ = nullptr;
    std::vector<glm::uvec3> triangles_;  ///< The current triangles, with vertices of the topology.
    std::vector<glm::uvec3> wedges_;
    std::vector<Quadric> quadrics_;        ///< By vertex.
    std::vector<TextureQuadric> texture_;  ///< By wedge.
    std::vector<std::vector<std::uint32_t>>
        gone_;                    ///< By face: removed vertices that are nearest to it.
    double texture_scale_ = 0.0;  ///< The squared length of a squared texture coordinate.
    Ring ring_;
    std::vector<std::uint32_t> points_;  ///< The points whose distance the move must preserve.
};

int SeamQuadrics::corner_of(int face, int vertex) const {
    const glm::uvec3& triangle = triangles_[index(face)];
    const auto wanted = static_cast<std::uint32_t>(vertex);
    if (triangle[0] == wanted) return 0;
    return triangle[1] == wanted ? 1 : 2;
}

std::uint32_t SeamQuadrics::wedge_at(int face, int vertex) const {
    return wedges_[index(face)][corner_of(face, vertex)];
}

/// Returns whether the edge between two triangles is a line as far as its end at `vertex` is
/// concerned. What differs only at the other end, as at the pole of a sphere, does not bind this
/// one.
bool SeamQuadrics::is_line(int left, int right, int vertex) const {
    return left < 0 || right < 0 || input_->parts[index(left)] != input_->parts[index(right)] ||
           wedge_at(left, vertex) != wedge_at(right, vertex);
}

void SeamQuadrics::add_triangle_quadrics(std::size_t face) {
    const glm::uvec3& triangle = triangles_[face];
    const glm::dvec3 a = input_->points[triangle[0]];
    const glm::dvec3 ab = input_->points[triangle[1]] - a;
    const glm::dvec3 ac = input_->points[triangle[2]] - a;
    const glm::dvec3 cross = glm::cross(ab, ac);
    const double doubled_area = glm::length(cross);
    if (!(doubled_area > 0.0)) return;
    const glm::dvec3 normal = cross / doubled_area;
    Quadric quadric(normal.x, normal.y, normal.z, -glm::dot(normal, a));
    quadric *= doubled_area / 2.0;
    for (int i = 0; i < 3; ++i)
        quadrics_[triangle[i]] += quadric;
    if (texture_.empty()) return;

    const glm::uvec3& wedge = wedges_[face];
    const glm::dvec2 t = texcoord(wedge[0]);
    const glm::dvec2 tb = texcoord(wedge[1]) - t;
    const glm::dvec2 tc = texcoord(wedge[2]) - t;
    // The gradient in the plane of the triangle results from the dual basis of its edges.
    const glm::dvec3 dual_b = glm::cross(ac, normal) / doubled_area;
    const glm::dvec3 dual_c = glm::cross(normal, ab) / doubled_area;
    TextureQuadric texture;
    texture.area = doubled_area / 2.0;
    for (int k = 0; k < 2; ++k) {
        const glm::dvec3 gradient = tb[k] * dual_b + tc[k] * dual_c;
        const double offset = t[k] - glm::dot(gradient, a);
        texture.squares += texture.area * glm::outerProduct(gradient, gradient);
        texture.mixed += texture.area * offset * gradient;
        texture.offsets += texture.area * offset * offset;
        texture.gradient[static_cast<std::size_t>(k)] = texture.area * gradient;
        texture.offset[k] = texture.area * offset;
    }
    for (int i = 0; i < 3; ++i)
        texture_[wedge[i]] += texture;
}

/// Adds planes through a line, perpendicular to the triangles, which keep the line in place.
void SeamQuadrics::add_line_quadric(SurfaceMesh::EdgeHandle edge) {
    const auto halfedge = mesh().halfedge_handle(edge, 0);
    const int left = mesh().face_handle(halfedge).idx();
    const int right = mesh().face_handle(mesh().opposite_halfedge_handle(halfedge)).idx();
    const int from = mesh().from_vertex_handle(halfedge).idx();
    const int to = mesh().to_vertex_handle(halfedge).idx();
    if (!is_line(left, right, from) && !is_line(left, right, to)) return;
    const glm::dvec3 along = point(to) - point(from);
    for (const int face : {left, right}) {
        if (face < 0) continue;
        const glm::uvec3& triangle = triangles_[index(face)];
        const glm::dvec3 a = input_->points[triangle[0]];
        const glm::dvec3 upright = glm::cross(
            along, glm::cross(input_->points[triangle[1]] - a, input_->points[triangle[2]] - a));
        const double length = glm::length(upright);
        if (!(length > 0.0)) continue;
        const glm::dvec3 normal = upright / length;
        Quadric quadric(normal.x, normal.y, normal.z, -glm::dot(normal, point(from)));
        quadric *= line_weight * glm::dot(along, along);
        quadrics_[index(from)] += quadric;
        quadrics_[index(to)] += quadric;
    }
}

/// Computes the mean squared length of a texture unit on the surface.
void SeamQuadrics::set_texture_scale() {
    double area = 0.0;
    double texture_area = 0.0;
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
        const auto at = [&](int i) { return input_->points[triangles_[f][i]]; };
        area += glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
        const glm::dvec2 t = texcoord(wedges_[f][0]);
        const glm::dvec2 tb = texcoord(wedges_[f][1]) - t;
        const glm::dvec2 tc = texcoord(wedges_[f][2]) - t;
        const double here = std::abs(tb.x * tc.y - tb.y * tc.x);
        if (std::isfinite(here)) texture_area += here;
    }
    texture_scale_ = texture_area > 0.0 ? area / texture_area : 0.0;
}

void SeamQuadrics::initialize() {
    triangles_ = input_->topology.triangles;
    wedges_.assign(input_->wedges.begin(), input_->wedges.end());
    quadrics_.assign(input_->points.size(), Quadric());
    texture_.clear();
    if (!input_->texcoords.empty()) {
        set_texture_scale();
        if (texture_scale_ > 0.0) texture_.resize(input_->texcoords.size());
    }
    for (std::size_t face = 0; face < triangles_.size(); ++face)
        add_triangle_quadrics(face);
    for (const auto edge : mesh().edges())
        add_line_quadric(edge);
    gone_.assign(input_->max_error ? triangles_.size() : 0, {});
}

/// Fills ring_.spokes. \return whether the lines at the vertex allow the move
bool SeamQuadrics::look_around(const CollapseInfo& move) {
    ring_.spokes.clear();
    const int vertex = move.v0.idx();
    int right = move.fr.idx();
    std::size_t lines = 0;
    auto halfedge = move.v0v1;
    do {
        const int left = mesh().face_handle(halfedge).idx();
        const bool line = is_line(left, right, vertex);
        ring_.spokes.push_back({left, line});
        lines += line ? 1 : 0;
        right = left;
        halfedge = mesh().ccw_rotated_halfedge_handle(halfedge);
    } while (halfedge != move.v0v1);
    if (lines != 0) return lines == 2 && ring_.spokes[0].is_line;
    // If the neighbor has two wedges, it is undefined which one the vertex becomes.
    return wedge_at(move.fl.idx(), move.v1.idx()) == wedge_at(move.fr.idx(), move.v1.idx());
}

/// Gathers the triangles that remain. Those to the left of the line get the left wedge of the
/// neighbor.
void SeamQuadrics::gather_moved(const CollapseInfo& move) {
    ring_.moved.clear();
    const int vertex = move.v0.idx();
    const int target = move.v1.idx();
    const int left = ring_.spokes.front().face;
    const int right = ring_.spokes.back().face;
    bool is_left = true;
    for (std::size_t i = 0; i < ring_.spokes.size(); ++i) {
        if (i > 0 && ring_.spokes[i].is_line) is_left = false;
        const int face = ring_.spokes[i].face;
        if (face < 0 || face == left || face == right) continue;
        const int beside = (is_left && left >= 0) || right < 0 ? left : right;
        const int corner = corner_of(face, vertex);
        ring_.moved.push_back(
            {face, corner, wedges_[index(face)][corner], wedge_at(beside, target)});
    }
}

/// Returns whether a removed triangle has lines on both its other sides. The move would join them,
/// and the last triangle between them, of a texture island or a material, would vanish.
bool SeamQuadrics::joins_lines(const CollapseInfo& move) {
    const auto face_beyond = [&](SurfaceMesh::HalfedgeHandle halfedge) {
        return mesh().face_handle(mesh().opposite_halfedge_handle(halfedge)).idx();
    };
    const int target = move.v1.idx();
    if (move.fl.is_valid() && ring_.spokes[1].is_line &&
        is_line(move.fl.idx(), face_beyond(mesh().next_halfedge_handle(move.v0v1)), target)) {
        return true;
    }
    return move.fr.is_valid() && ring_.spokes.back().is_line &&
           is_line(move.fr.idx(), face_beyond(mesh().prev_halfedge_handle(move.v1v0)), target);
}

bool SeamQuadrics::turns_over(const MovedFace& moved, const CollapseInfo& move) const {
    const glm::uvec3& triangle = triangles_[index(moved.face)];
    const glm::dvec3 b = input_->points[triangle[(moved.corner + 1) % 3]];
    const glm::dvec3 c = input_->points[triangle[(moved.corner + 2) % 3]];
    const glm::dvec3 before = glm::cross(b - to_glm(move.p0), c - to_glm(move.p0));
    const glm::dvec3 after = glm::cross(b - to_glm(move.p1), c - to_glm(move.p1));
    const double length_before = glm::length(before);
    if (!(length_before > 0.0)) return false;  // A triangle without area has no orientation.
    return !(glm::dot(before, after) > min_turn_cosine * length_before * glm::length(after));
}

bool SeamQuadrics::turns_texture_over(const MovedFace& moved) const {
    const glm::uvec3& wedge = wedges_[index(moved.face)];
    const glm::dvec2 b = texcoord(wedge[(moved.corner + 1) % 3]);
    const glm::dvec2 c = texcoord(wedge[(moved.corner + 2) % 3]);
    const auto area_from = [&](const glm::dvec2& a) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    const double before = area_from(texcoord(moved.wedge_before));
    return before != 0.0 && !(before * area_from(texcoord(moved.wedge_after)) > 0.0);
}

/// Returns the cost of the texture's movement, for each removed wedge and the wedge that replaces
/// it.
double SeamQuadrics::texture_cost(const CollapseInfo& move) const {
    if (texture_.empty()) return 0.0;
    const glm::dvec3 p = to_glm(move.p1);
    double cost = 0.0;
    const auto add = [&](int face) {
        if (face < 0) return;
        const std::uint32_t before = wedge_at(face, move.v0.idx());
        const std::uint32_t after = wedge_at(face, move.v1.idx());
        cost += texture_[before](p, texcoord(after)) + texture_[after](p, texcoord(after));
    };
    add(move.fl.idx());
    const bool both = move.fl.is_valid() && move.fr.is_valid();
    if (!both || wedge_at(move.fl.idx(), move.v0.idx()) != wedge_at(move.fr.idx(), move.v0.idx()))
        add(move.fr.idx());
    return cost * texture_scale_;
}

/// Returns the squared distance of the triangle around the moved vertex that is nearest to a point,
/// and that triangle.
std::pair<double, int> SeamQuadrics::nearest_face(std::uint32_t point_number,
                                                  const glm::dvec3& moved_to) const {
    std::pair<double, int> nearest = {std::numeric_limits<double>::infinity(), -1};
    for (const MovedFace& moved : ring_.moved) {
        const glm::uvec3& triangle = triangles_[index(moved.face)];
        const double distance = squared_distance(input_->points[point_number], moved_to,
                                                 input_->points[triangle[(moved.corner + 1) % 3]],
                                                 input_->points[triangle[(moved.corner + 2) % 3]]);
        nearest = std::min(nearest, {distance, moved.face});
    }
    return nearest;
}

void SeamQuadrics::gather_points(const CollapseInfo& move) {
    points_.assign(1, static_cast<std::uint32_t>(move.v0.idx()));
    for (const Ring::Spoke& spoke : ring_.spokes) {
        if (spoke.face < 0) continue;
        const std::vector<std::uint32_t>& gone = gone_[index(spoke.face)];
        points_.insert(points_.end(), gone.begin(), gone.end());
    }
}

bool SeamQuadrics::keeps_points_near(const CollapseInfo& move) {
    if (!input_->max_error) return true;
    gather_points(move);
    const double most = *input_->max_error * *input_->max_error;
    return std::all_of(points_.begin(), points_.end(), [&](std::uint32_t number) {
        return nearest_face(number, to_glm(move.p1)).first <= most;
    });
}

float SeamQuadrics::collapse_priority(const CollapseInfo& move) {
    constexpr auto refused = static_cast<float>(ILLEGAL_COLLAPSE);
    if (!look_around(move) || joins_lines(move)) return refused;
    gather_moved(move);
    for (const MovedFace& moved : ring_.moved) {
        if (turns_over(moved, move)) return refused;
        if (!texture_.empty() && turns_texture_over(moved)) return refused;
    }
    if (!keeps_points_near(move)) return refused;
    Quadric quadric = quadrics_[index(move.v0.idx())];
    quadric += quadrics_[index(move.v1.idx())];
    const double squared_length = (move.p1 - move.p0).sqrnorm();
    const double cost = std::max(0.0, quadric(move.p1)) + texture_cost(move) +
                        length_preference * squared_length * squared_length;
    return static_cast<float>(std::min(cost, 1e30));
}

void SeamQuadrics::preprocess_collapse(const CollapseInfo& move) {
    look_around(move);
    gather_moved(move);
    if (input_->max_error) {
        gather_points(move);
        for (const Ring::Spoke& spoke : ring_.spokes) {
            if (spoke.face >= 0) gone_[index(spoke.face)].clear();
        }
        for (const std::uint32_t number : points_)
            gone_[index(nearest_face(number, to_glm(move.p1)).second)].push_back(number);
    }
    std::array<std::uint32_t, 2> added = {no_corner, no_corner};
    for (const MovedFace& moved : ring_.moved) {
        triangles_[index(moved.face)][moved.corner] = static_cast<std::uint32_t>(move.v1.idx());
        wedges_[index(moved.face)][moved.corner] = moved.wedge_after;
        if (texture_.empty() || moved.wedge_before == added[0] || moved.wedge_before == added[1])
            continue;
        added[added[0] == no_corner ? 0 : 1] = moved.wedge_before;
        texture_[moved.wedge_after] += texture_[moved.wedge_before];
    }
}

void SeamQuadrics::postprocess_collapse(const CollapseInfo& move) {
    quadrics_[index(move.v1.idx())] += quadrics_[index(move.v0.idx())];
}

/// Returns for each triangle of the topology the mesh vertices at its corners after decimation;
/// none if the triangle is removed.
std::vector<std::optional<glm::uvec3>> decimated_wedges(const Decimation& decimation) {
    SurfaceMesh mesh;
    build(mesh, decimation.topology, decimation.points);
    OpenMesh::Decimater::DecimaterT<SurfaceMesh> decimater(mesh);
    for (std::size_t v = 0; v < decimation.points.size(); ++v) {
        const SurfaceMesh::VertexHandle vertex(static_cast<int>(v));
        mesh.status(vertex).set_locked(decimation.topology.is_cut[v]);
    }
    SeamQuadrics::Handle handle;
    decimater.add(handle);
    decimater.module(handle).use(decimation);
    decimater.initialize();
    decimater.decimate_to_faces(0, decimation.triangles.value_or(0));

    std::vector<std::optional<glm::uvec3>> result(decimation.wedges.size());
    for (const auto face : mesh.faces()) {
        const auto f = static_cast<std::size_t>(face.idx());
        if (!mesh.status(face).deleted()) result[f] = decimater.module(handle).wedges()[f];
    }
    return result;
}

void check(const Mesh& mesh, const DecimateOptions& options) {
    validate(mesh);
    if (!options.triangles && !options.max_error)
        throw InvalidInput("decimation needs a number of triangles or an error to stop at");
    if (options.triangles && *options.triangles == 0)
        throw InvalidInput("0 triangles are no surface; at least 1 must be left");
    if (options.max_error && !(*options.max_error >= 0.0 && std::isfinite(*options.max_error)))
        throw InvalidInput(fmt::format("an error of {} is no distance", *options.max_error));
}

/// Maps object space to [-1, 1]; `scale` is the factor of lengths.
struct UnitSpace {
    glm::dvec3 center{0.0};
    double scale = 1.0;

    [[nodiscard]] glm::dvec3 operator()(const glm::vec3& position) const {
        return (glm::dvec3(position) - center) * scale;
    }
};

UnitSpace unit_space(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    UnitSpace space;
    if (bounds.empty()) return space;
    const glm::dvec3 low(bounds.min);
    const glm::dvec3 high(bounds.max);
    space.center = (low + high) / 2.0;
    const glm::dvec3 half = (high - low) / 2.0;
    const double longest = std::max({half.x, half.y, half.z});
    if (longest > 0.0) space.scale = std::ldexp(1.0, -(std::ilogb(longest) + 1));
    return space;
}

/// Returns the index of the material range of each triangle.
std::vector<std::uint32_t> parts_of(const Mesh& mesh) {
    std::vector<std::uint32_t> parts(mesh.triangles.size(), 0);
    for (std::uint32_t r = 0; r < mesh.material_ranges.size(); ++r) {
        const MaterialRange& range = mesh.material_ranges[r];
        std::fill_n(parts.begin() + range.first_triangle, range.triangle_count, r);
    }
    return parts;
}

/// Returns for each vertex the first one with the same position, part and seam attributes. Vertices
/// of different parts stay separate even if they are equal.
std::vector<std::uint32_t> wedges_of(const Mesh& mesh, std::span<const std::uint32_t> classes,
                                     std::span<const std::uint32_t> parts, bool with_normals) {
    std::vector<std::uint32_t> part_of(classes.size(), 0);
    for (std::size_t t = 0; t < parts.size(); ++t) {
        for (int i = 0; i < 3; ++i)
            part_of[mesh.triangles[t][i]] = parts[t];
    }
    const auto is_equal = [&](std::uint32_t a, std::uint32_t b) {
        return part_of[a] == part_of[b] &&
               (mesh.texcoords.empty() || mesh.texcoords[a] == mesh.texcoords[b]) &&
               (mesh.colors.empty() || mesh.colors[a] == mesh.colors[b]) &&
               (!with_normals || mesh.normals.empty() || mesh.normals[a] == mesh.normals[b]);
    };
    // The wedges of each position form a list that starts at its first vertex.
    constexpr std::uint32_t none = no_corner;
    std::vector<std::uint32_t> wedges(classes.size());
    std::vector<std::uint32_t> next(classes.size(), none);
    for (std::uint32_t v = 0; v < classes.size(); ++v) {
        std::uint32_t candidate = classes[v];
        while (candidate != v && !is_equal(candidate, v)) {
            if (next[candidate] == none) next[candidate] = v;
            candidate = next[candidate];
        }
        wedges[v] = candidate;
    }
    return wedges;
}

/// The remaining triangles, at the indices of the input.
struct Remains {
    std::vector<std::optional<glm::uvec3>> triangles;  ///< By triangle of the input.
    std::size_t count = 0;
};

Remains remains_of(const Mesh& mesh, const DecimateOptions& options, Report& report) {
    const std::vector<std::uint32_t> classes = weld_positions(mesh.positions);
    const Topology topology = topology_of(mesh, classes, report);
    const std::vector<std::uint32_t> all_parts = parts_of(mesh);
    const std::vector<std::uint32_t> wedges =
        wedges_of(mesh, classes, all_parts, options.frames.normals == NormalMode::keep);
    const UnitSpace space = unit_space(mesh);

    std::vector<glm::dvec3> points;
    for (const std::uint32_t vertex : topology.position_vertex)
        points.push_back(space(mesh.positions[vertex]));
    std::vector<glm::uvec3> corners;
    std::vector<std::uint32_t> parts;
    for (const std::uint32_t source : topology.source_triangle) {
        const glm::uvec3& triangle = mesh.triangles[source];
        corners.emplace_back(wedges[triangle.x], wedges[triangle.y], wedges[triangle.z]);
        parts.push_back(all_parts[source]);
    }

    Decimation decimation{topology, points, corners, parts, mesh.texcoords, {}, {}};
    const std::size_t aside = topology.set_aside.size();
    if (options.triangles)
        decimation.triangles = *options.triangles - std::min(*options.triangles, aside);
    if (options.max_error) decimation.max_error = *options.max_error * space.scale;

    Remains remains{std::vector<std::optional<glm::uvec3>>(mesh.triangles.size()), aside};
    const std::vector<std::optional<glm::uvec3>> left = decimated_wedges(decimation);
    for (std::size_t t = 0; t < left.size(); ++t) {
        remains.triangles[topology.source_triangle[t]] = left[t];
        if (left[t]) ++remains.count;
    }
    for (const std::uint32_t t : topology.set_aside)
        remains.triangles[t] = mesh.triangles[t];
    return remains;
}

/// Returns the vertices that the remaining triangles use, in their order. Isolated vertices are
/// counted.
std::vector<std::uint32_t> used_vertices(const Mesh& mesh, const Remains& remains, Report& report) {
    std::vector<bool> was_used(mesh.positions.size(), false);
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            was_used[triangle[i]] = true;
    }
    std::vector<bool> is_used(mesh.positions.size(), false);
    for (const auto& triangle : remains.triangles) {
        if (!triangle) continue;
        for (int i = 0; i < 3; ++i)
            is_used[(*triangle)[i]] = true;
    }
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (!was_used[v]) report.add("isolated vertex", "vertex", v, "is left out");
        if (is_used[v]) vertices.push_back(v);
    }
    return vertices;
}

FramedMesh gathered(const Mesh& mesh, const Remains& remains, Report& report) {
    VertexSplit left{used_vertices(mesh, remains, report), {}};
    std::vector<std::uint32_t> place(mesh.positions.size(), 0);
    for (std::uint32_t i = 0; i < left.source_vertex.size(); ++i)
        place[left.source_vertex[i]] = i;
    std::vector<MaterialRange> ranges = mesh.material_ranges;
    std::vector<std::uint32_t> groups;
    const std::vector<std::uint32_t> parts = parts_of(mesh);
    for (MaterialRange& range : ranges)
        range.triangle_count = 0;
    for (std::size_t t = 0; t < remains.triangles.size(); ++t) {
        const auto& triangle = remains.triangles[t];
        if (!triangle) continue;
        left.triangles.emplace_back(place[triangle->x], place[triangle->y], place[triangle->z]);
        if (!mesh.smoothing_groups.empty()) groups.push_back(mesh.smoothing_groups[t]);
        if (!ranges.empty()) ++ranges[parts[t]].triangle_count;
    }
    std::uint32_t first = 0;
    for (MaterialRange& range : ranges) {
        range.first_triangle = first;
        first += range.triangle_count;
    }
    FramedMesh result;
    result.mesh = carried(mesh, left);
    result.mesh.tangents.clear();  // The tangents are those of removed triangles.
    result.mesh.material_ranges = std::move(ranges);
    result.mesh.smoothing_groups = std::move(groups);
    result.source_vertex = std::move(left.source_vertex);
    return result;
}

/// Computes normals and tangents as requested. Attributes that are neither requested nor present
/// stay absent.
FramedMesh framed(const Mesh& input, FramedMesh small, FrameOptions frames, Report& report) {
    const bool had_tangents = !input.tangents.empty() && !input.texcoords.empty();
    if (frames.tangents == TangentMethod::keep) {
        frames.tangents = had_tangents ? TangentMethod::mikktspace : TangentMethod::none;
        if (!input.tangents.empty()) {
            report.add(
                "tangents of other triangles", "mesh", 0,
                had_tangents ? "are recomputed" : "are removed: there are no texture coordinates");
        }
    }
    if (frames.normals == NormalMode::keep && frames.tangents == TangentMethod::none) return small;
    FramedMesh result = with_frames(std::move(small.mesh), frames, report);
    for (std::uint32_t& source : result.source_vertex)
        source = small.source_vertex[source];
    return result;
}

}  // namespace

FramedMesh decimated(const Mesh& mesh, const DecimateOptions& options, Report& report) {
    check(mesh, options);
    const Remains remains = remains_of(mesh, options, report);
    // One interior move removes two triangles, so the result may be one less than requested.
    if (options.triangles && !options.max_error && remains.count > *options.triangles) {
        report.add("number of triangles out of reach", "mesh", 0,
                   fmt::format("{} are left: seams, hard edges, borders and shape allow no fewer",
                               remains.count));
    }
    return framed(mesh, gathered(mesh, remains, report), options.frames, report);
}

}  // namespace relief
