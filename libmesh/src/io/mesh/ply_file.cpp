// SPDX-License-Identifier: Apache-2.0
// Reads PLY files: ASCII and binary ones of both byte orders, and all scalar types. Binary files
// are read in pieces, and triangles go straight to the mesh. Malformed files throw FileError.
//
// relief does not use OpenMesh 9's reader: it hangs on some broken headers, allocates gigabytes for
// a negative list length, refuses integer positions and unsigned index types other than its own,
// and leaves out texture coordinates named texture_u or stored per face.
// Source: [Turk 1994].
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/ply_header.h"
#include "io/mesh/ply_values.h"
#include "io/mesh/polygon_mesh.h"
#include "large_memory.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// Meaning of a vertex property; the number is its index in a row of floats.
enum Slot : std::uint8_t { x, y, z, nx, ny, nz, red, green, blue, alpha, u, v, slot_count, unread };

Slot slot_named(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, Slot>, 28> names = {{
        {"x", x},
        {"y", y},
        {"z", z},
        {"nx", nx},
        {"ny", ny},
        {"nz", nz},
        {"red", red},
        {"green", green},
        {"blue", blue},
        {"alpha", alpha},
        {"r", red},
        {"g", green},
        {"b", blue},
        {"a", alpha},
        {"diffuse_red", red},
        {"diffuse_green", green},
        {"diffuse_blue", blue},
        {"diffuse_alpha", alpha},
        {"s", u},
        {"t", v},
        {"u", u},
        {"v", v},
        {"texture_u", u},
        {"texture_v", v},
        {"texture_s", u},
        {"texture_t", v},
        {"s0", u},
        {"t0", v},
    }};
    for (const auto& [known, slot] : names) {
        if (known == name) return slot;
    }
    return unread;
}

bool is_corner_list(const PlyProperty& property) {
    return property.count_type &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
}

struct PlyData {
    Mesh mesh;          ///< Its triangles are set if all faces are triangles of one element.
    Polygons polygons;  ///< Otherwise all faces.
    /// One per corner if texture coordinates are stored per face; otherwise empty.
    std::vector<glm::vec2> corner_texcoords;
};

/// Reads the elements of one file.
template <typename Values>
class PlyElements {
  public:
    PlyElements(Values values, const RandomAccessFile& file, const glm::dvec3& origin,
                Report& report)
        : values_(std::move(values)),
          file_(file.path()),
          file_size_(file.size()),
          origin_(origin),
          report_(report) {}

    PlyData read(const PlyHeader& header) {
        for (const PlyElement& element : header.elements) {
            if (element.properties.empty()) continue;
            check_count(element);
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "face") {
                read_faces(element);
            } else if (element.name == "tristrips") {
                read_strips(element);
            } else {
                skip(element);
            }
        }
        const std::uint64_t end = file_size_ - values_.remaining();
        if (!values_.is_at_end())
            report_.add("data behind the last element", "byte", end, "left out");
        return std::move(data_);
    }

  private:
    /// An element has at least one value, so the remaining values limit the count.
    void check_count(const PlyElement& element) const {
        const PlyProperty& first = element.properties.front();
        if (element.count <= values_.max_remaining(first.count_type.value_or(first.type))) return;
        throw FileError(file_, fmt::format("claims {} of element '{}', but ends before that",
                                           element.count, element.name));
    }

    std::uint64_t list_length(const PlyProperty& property) {
        const double length = values_.next(*property.count_type);
        if (!(length >= 0.0) || length != std::floor(length) ||
            length > static_cast<double>(values_.max_remaining(property.type))) {
            throw FileError(file_, fmt::format("a list '{}' has the length {}, which the file "
                                               "cannot hold",
                                               property.name, length));
        }
        return static_cast<std::uint64_t>(length);
    }

    void skip_property(const PlyProperty& property) {
        const std::uint64_t length = property.count_type ? list_length(property) : 1;
        for (std::uint64_t i = 0; i < length; ++i)
            values_.next(property.type);
    }

    void skip(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            check_cancelled(i);
            for (const PlyProperty& property : element.properties)
                skip_property(property);
        }
        if (element.count > 0) {
            report_.add(fmt::format("PLY element '{}'", element.name), "file", 0, "left out");
        }
    }

    void count_unread(const PlyElement& element, const PlyProperty& property) {
        report_.add(fmt::format("PLY property '{}' of '{}'", property.name, element.name), "file",
                    0, "left out");
    }

    void end_element(const PlyElement& element, std::uint64_t index) {
        if (values_.end_element()) return;
        report_.add("line with more values than the header names", element.name, index,
                    "the surplus is ignored");
    }

    /// Adds a corner to the face that is read.
    void add_corner(double index) {
        if (!(index >= 0.0 && index <= 4294967295.0 && index == std::floor(index))) {
            throw FileError(file_, fmt::format("face {} names vertex {}",
                                               data_.polygons.corner_counts.size(), index));
        }
        data_.polygons.corners.push_back(static_cast<std::uint32_t>(index));
    }

    /// Reserves memory for as many elements as the file can hold.
    template <typename Value>
    void reserve(std::vector<Value>& values, const PlyElement& element) const {
        std::uint64_t most = element.count;
        for (const PlyProperty& property : element.properties)
            most =
                std::min(most, values_.max_remaining(property.count_type.value_or(property.type)));
        reserve_to_fill(values, most);
    }

    void read_vertices(const PlyElement& element);
    std::uint64_t read_triangles(const PlyElement& element);
    void read_faces(const PlyElement& element);
    void use_polygons();
    void read_strips(const PlyElement& element);
    void read_corners(const PlyProperty& property);
    void read_corner_texcoords(const PlyProperty& property);

    Values values_;
    const std::filesystem::path& file_;
    std::uint64_t file_size_;
    glm::dvec3 origin_;
    Report& report_;
    PlyData data_;
};

template <typename Values>
void PlyElements<Values>::read_vertices(const PlyElement& element) {
    std::vector<Slot> slots;
    std::array<bool, slot_count> has{};
    for (const PlyProperty& property : element.properties) {
        const Slot slot = property.count_type ? unread : slot_named(property.name);
        slots.push_back(slot);
        if (slot == unread) {
            count_unread(element, property);
        } else {
            has[slot] = true;
        }
    }
    if (!has[x] || !has[y] || !has[z]) throw FileError(file_, "its vertices have no x, y and z");
    Mesh& mesh = data_.mesh;
    const bool has_normals = has[nx] && has[ny] && has[nz];
    const bool has_colors = has[red] && has[green] && has[blue];
    const bool has_texcoords = has[u] && has[v];
    reserve(mesh.positions, element);
    if (has_normals) reserve(mesh.normals, element);
    if (has_colors) reserve(mesh.colors, element);
    if (has_texcoords) reserve(mesh.texcoords, element);
    std::array<double, slot_count + 2> row{};
    row[alpha] = 1.0;
    ProgressStage stage("vertices", element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
        stage.at(i);
        for (std::size_t k = 0; k < slots.size(); ++k) {
            const PlyProperty& property = element.properties[k];
            if (slots[k] == unread) {
                skip_property(property);
            } else {
                const double value = values_.next(property.type);
                row[slots[k]] = slots[k] <= z ? value : value / largest_value(property.type);
            }
        }
        end_element(element, i);
        mesh.positions.emplace_back(glm::dvec3(row[x], row[y], row[z]) - origin_);
        if (has_normals) mesh.normals.emplace_back(row[nx], row[ny], row[nz]);
        if (has_colors) mesh.colors.emplace_back(row[red], row[green], row[blue], row[alpha]);
        if (has_texcoords) mesh.texcoords.emplace_back(row[u], 1.0 - row[v]);
    }
}

template <typename Values>
void PlyElements<Values>::read_corners(const PlyProperty& property) {
    const std::uint64_t length = list_length(property);
    for (std::uint64_t i = 0; i < length; ++i)
        add_corner(values_.next(property.type));
    data_.polygons.corner_counts.push_back(static_cast<std::uint32_t>(length));
}

/// Reads u v pairs, one per corner of the last face. Writers leave the list empty if a face has no
/// texture; only if all lists are empty, the mesh has no texture coordinates.
template <typename Values>
void PlyElements<Values>::read_corner_texcoords(const PlyProperty& property) {
    std::vector<glm::vec2>& texcoords = data_.corner_texcoords;
    const std::uint64_t length = list_length(property);
    if (length == 0 && texcoords.empty()) return;
    texcoords.resize(data_.polygons.corners.size() - data_.polygons.corner_counts.back());
    for (std::uint64_t i = 0; i + 1 < length; i += 2) {
        const double u_value = values_.next(property.type);
        const double v_value = values_.next(property.type);
        texcoords.emplace_back(u_value, 1.0 - v_value);
    }
    if (length % 2 != 0) values_.next(property.type);
    if (texcoords.size() == data_.polygons.corners.size()) return;
    report_.add("face with too few or too many texture coordinates", "face",
                data_.polygons.corner_counts.size() - 1, "missing ones become (0, 0)");
    texcoords.resize(data_.polygons.corners.size());
}

/// Reads faces up to the first that is not a triangle, if they have nothing but corners.
/// \return their number
template <typename Values>
std::uint64_t PlyElements<Values>::read_triangles(const PlyElement& element) {
    const PlyProperty& corners = element.properties.front();
    std::vector<glm::uvec3>& triangles = data_.mesh.triangles;
    if (element.properties.size() != 1 || !triangles.empty() || !data_.polygons.corners.empty())
        return 0;
    reserve(triangles, element);
    glm::uvec3 triangle;
    ProgressStage stage("faces", element.count);
    while (triangles.size() < element.count &&
           values_.next_triangle(*corners.count_type, corners.type, triangle)) {
        stage.at(triangles.size());
        triangles.push_back(triangle);
    }
    return triangles.size();
}

template <typename Values>
void PlyElements<Values>::read_faces(const PlyElement& element) {
    const auto corners =
        std::find_if(element.properties.begin(), element.properties.end(), is_corner_list);
    if (corners == element.properties.end()) {
        throw FileError(file_, "its faces have no list of vertex indices");
    }
    const auto is_texcoords = [&](const PlyProperty& property) {
        return property.count_type && property.name == "texcoord" && &property > &*corners;
    };
    for (const PlyProperty& property : element.properties) {
        if (&property != &*corners && !is_texcoords(property)) count_unread(element, property);
    }
    const std::uint64_t read = read_triangles(element);
    if (read == element.count) return;
    use_polygons();
    ProgressStage stage("faces", element.count);
    for (std::uint64_t i = read; i < element.count; ++i) {
        stage.at(i);
        for (const PlyProperty& property : element.properties) {
            if (&property == &*corners) {
                read_corners(property);
            } else if (is_texcoords(property)) {
                read_corner_texcoords(property);
            } else {
                skip_property(property);
            }
        }
        end_element(element, i);
    }
}

/// Moves the triangles to the polygons, which hold faces of any kind.
template <typename Values>
void PlyElements<Values>::use_polygons() {
    std::vector<glm::uvec3>& triangles = data_.mesh.triangles;
    Polygons& polygons = data_.polygons;
    polygons.corner_counts.resize(polygons.corner_counts.size() + triangles.size(), 3);
    for (const glm::uvec3& triangle : triangles)
        polygons.corners.insert(polygons.corners.end(), {triangle.x, triangle.y, triangle.z});
    triangles = {};
}

/// Reads strips of triangles. Every second triangle of a strip is reversed; -1 begins another
/// strip.
template <typename Values>
void PlyElements<Values>::read_strips(const PlyElement& element) {
    use_polygons();
    ProgressStage stage("strips", element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
        stage.at(i);
        for (const PlyProperty& property : element.properties) {
            if (!is_corner_list(property)) {
                skip_property(property);
                continue;
            }
            std::array<double, 2> last{};
            std::size_t place = 0;
            const std::uint64_t length = list_length(property);
            for (std::uint64_t k = 0; k < length; ++k) {
                const double index = values_.next(property.type);
                if (index == -1.0) {
                    place = 0;
                    continue;
                }
                if (place >= 2) {
                    const bool is_reversed = place % 2 != 0;
                    add_corner(last[is_reversed ? 1 : 0]);
                    add_corner(last[is_reversed ? 0 : 1]);
                    add_corner(index);
                    data_.polygons.corner_counts.push_back(3);
                }
                last = {last[1], index};
                ++place;
            }
        }
        end_element(element, i);
    }
}

/// Merges corners with their own texture coordinates into vertices, as for OBJ.
void unify_corners(PlyData& data, const std::filesystem::path& file) {
    ObjStatements statements;
    statements.positions = std::move(data.mesh.positions);
    statements.colors = std::move(data.mesh.colors);
    statements.normals = std::move(data.mesh.normals);
    statements.texcoords = std::move(data.corner_texcoords);
    data.mesh = Mesh();
    for (std::size_t i = 0; i < data.polygons.corners.size(); ++i) {
        check_cancelled(i);
        const std::uint32_t vertex = data.polygons.corners[i];
        if (vertex >= statements.positions.size()) {
            throw FileError(file, fmt::format("a face names vertex {}, but there are only {}",
                                              vertex, statements.positions.size()));
        }
        const auto index = static_cast<std::int32_t>(vertex);
        statements.corners.push_back(
            {index, static_cast<std::int32_t>(i), statements.normals.empty() ? -1 : index});
    }
    data.polygons.corners = unify_vertices(statements, data.mesh);
}

/// Reads the beginning of a file, at least up to the end of its header.
std::string read_head(const RandomAccessFile& file) {
    const ProgressStage stage("reading");
    std::string head;
    const auto has_end = [&] {
        const std::size_t end = head.find("\nend_header");
        return end != std::string::npos && head.find('\n', end + 1) != std::string::npos;
    };
    while (head.size() < file.size() && !has_end()) {
        const std::size_t size = head.size();
        head.resize(static_cast<std::size_t>(
            std::min<std::uint64_t>(std::max<std::size_t>(2 * size, 1 << 16), file.size())));
        file.read(size, std::as_writable_bytes(std::span(head).subspan(size)));
    }
    return head;
}

PlyData read_data(const PlyHeader& header, const RandomAccessFile& file, const glm::dvec3& origin,
                  Report& report) {
    switch (header.format) {
        case PlyFormat::ascii: {
            const FileContents contents(file.path());
            const std::string_view data = contents.text().substr(header.data_begin);
            return PlyElements(PlyTextValues(data, file.path()), file, origin, report).read(header);
        }
        case PlyFormat::little_endian:
            return PlyElements(PlyBinaryValues<false>(file, header.data_begin), file, origin,
                               report)
                .read(header);
        default:
            return PlyElements(PlyBinaryValues<true>(file, header.data_begin), file, origin, report)
                .read(header);
    }
}

}  // namespace

MeshFile read_ply(const std::filesystem::path& file, const glm::dvec3& origin, Report& report) {
    static_assert(std::endian::native == std::endian::little);
    const RandomAccessFile opened(file);
    require_memory_for(file, opened.size());
    const PlyHeader header = parse_ply_header(read_head(opened), file);
    PlyData data = read_data(header, opened, origin, report);
    if (!data.corner_texcoords.empty()) {
        data.corner_texcoords.resize(data.polygons.corners.size());
        unify_corners(data, file);
    }
    data.mesh.name = file.stem().string();
    if (data.mesh.triangles.empty() && data.polygons.corners.empty() &&
        !data.mesh.positions.empty()) {
        throw FileError(file,
                        fmt::format("has no triangle, only {} points", data.mesh.positions.size()));
    }
    if (data.mesh.triangles.empty())
        add_triangles(data.mesh, data.polygons, file, report);
    else
        check_faces(data.mesh, file);
    MeshFile result;
    result.mesh = std::move(data.mesh);
    return result;
}

}  // namespace relief::detail
