// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of the stability experiments: sweeps over a growing quantity, hard inputs (degenerate
/// triangles, needles), and textbook code without guards, which is measured for contrast with the
/// library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"

namespace relief {

/// The errors of several methods while one quantity grows, and the value at which each method
/// fails.
class Sweeps {
  public:
    /// \param bound  limit of the RMS error in degrees; a method fails where it exceeds this
    Sweeps(std::vector<std::string> methods, double bound);

    /// The angular errors of a method at a value, in degrees; NaN where a direction is undefined.
    using Errors = std::function<std::vector<float>(std::size_t method, double value)>;

    /// Adds a chart over the values 10^0, 10^step, ... 10^decades. Nothing is computed yet.
    void add(const std::string& id, const std::string& title, const std::string& x_label,
             int decades, int step, Errors errors);

    /// Computes the curves of a method in all charts.
    /// \return the errors of all curves together
    ErrorStats measure(std::size_t method);

    /// The charts, with the curves of the measured methods.
    [[nodiscard]] const std::vector<Chart>& charts() const { return charts_; }

    /// "Larger (...): plain area fails from 1e+18 on, all others are within the limit." for each
    /// chart.
    [[nodiscard]] std::string breaks() const;

  private:
    struct Values {
        int decades = 0;
        int step = 1;
        Errors errors;
    };

    std::vector<std::string> methods_;
    double bound_;
    std::vector<Chart> charts_;
    std::vector<Values> values_;  ///< By chart.
};

/// Kinds of triangles that a mesh can have without a change of its surface.
enum class HardTriangle {
    collapsed,   ///< Refers to one vertex twice.
    coinciding,  ///< Has two corners at the same position.
    needle,      ///< Has its third corner at the middle of an edge, up to rounding.
    nowhere,     ///< Has a corner that is not a number.
    back,        ///< Lies on another triangle with the opposite orientation.
};

struct HardTriangleName {
    HardTriangle kind;
    const char* id;
    const char* title;
};
inline constexpr std::array hard_triangle_names = {
    HardTriangleName{HardTriangle::collapsed, "collapsed",
                     "Triangles that refer to a vertex twice"},
    HardTriangleName{HardTriangle::coinciding, "coinciding",
                     "Triangles with two corners at the same position"},
    HardTriangleName{HardTriangle::needle, "needle", "Needles along an edge"},
    HardTriangleName{HardTriangle::nowhere, "nowhere", "Triangles with a corner that is NaN"},
    HardTriangleName{HardTriangle::back, "back", "Triangles with another one on their back side"},
};

/// Adds `count` hard triangles, spread evenly over the mesh; with HardTriangle::back at most one
/// per triangle. The vertices and triangles of the mesh keep their indices. The result has only
/// positions and triangles.
Mesh with_hard_triangles(const Mesh& mesh, HardTriangle kind, std::size_t count);

/// Separate needle-shaped triangles with their exact normals.
struct Needles {
    Mesh mesh;                        ///< Positions and triangles; no two share a vertex.
    std::vector<glm::dvec3> normals;  ///< Per vertex; unit.
};

/// Makes needles without cancellation in their exact normals: two corners lie within twice the
/// width of the origin, where floats are fine enough, and the third corner lies at a distance of 1.
///
/// \param width  length of the short side, which is perpendicular to the long ones. The first
/// corner
///               alternates between the three.
Needles make_needles(std::size_t count, double width, std::uint32_t seed);

/// Textbook code: normalizes the sum of cross products around each vertex; 0 / 0 gives NaN.
std::vector<glm::vec3> textbook_area_normals(const Mesh& mesh);

/// Textbook code: normalizes the sum of unit normals weighted by the arc cosines of corner angles.
std::vector<glm::vec3> textbook_angle_normals(const Mesh& mesh);

/// Textbook code, [Lengyel 2001] as printed: averages tangents over all triangles of a vertex.
/// \return three tangents per triangle
std::vector<glm::vec4> textbook_tangents(const Mesh& mesh);

/// Textbook code: Sobel differences of 3 x 3 heights, then (-dh/dx, -dh/dy, 1) normalized, y up;
/// the border is (0, 0, 1).
/// \param height  one float channel
Image textbook_sobel_normals(const Image& height, float strength);

}  // namespace relief
