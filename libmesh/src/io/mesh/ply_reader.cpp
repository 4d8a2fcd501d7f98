// SPDX-License-Identifier: Apache-2.0
// PLY to a mesh: header, then element by element, then polygons to triangles.
//
// Object space as written; v is turned to grow downwards here. Source: [Turk 1994]. Counts are
// never believed beyond what the file can hold; what is cut short, negative or out of range throws
// FileError; what is not understood is left out and counted. Tests:
// tests/mesh/io/mesh/ply_test.cpp.
#include "io/mesh/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "file_bytes.h"
#include "io/mesh/obj_vertices.h"
#include "io/mesh/ply_header.h"
#include "io/mesh/ply_values.h"
#include "io/mesh/polygon_mesh.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// What a value of a vertex means; the number is its place in a row of floats.
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

/// Integers that stand for fractions are divided by the largest value of their type.
double largest_value(PlyType type) {
    switch (type) {
        case PlyType::int8:
            return 127.0;
        case PlyType::uint8:
            return 255.0;
        case PlyType::int16:
            return 32767.0;
        case PlyType::uint16:
            return 65535.0;
        case PlyType::int32:
            return 2147483647.0;
        case PlyType::uint32:
            return 4294967295.0;
        default:
            return 1.0;
    }
}

struct PlyData {
    Mesh mesh;
    Polygons polygons;
    /// One per corner where texture coordinates are stored by face; else empty.
    std::vector<glm::vec2> corner_texcoords;
};

/// Reads the elements of one file.
template <typename Values>
class PlyElements {
  public:
    PlyElements(Values values, const std::filesystem::path& file, const glm::dvec3& origin,
                Report& report)
        : values_(values), file_(file), origin_(origin), report_(report) {}

    PlyData read(const PlyHeader& header) {
        for (const PlyElement& element : header.elements) {
            if (element.properties.empty()) continue;
            check_count(element);
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "face") {
                read_faces(element);
            } else {
                skip(element);
            }
        }
        return std::move(data_);
    }

  private:
    /// An element takes at least one value, so there cannot be more elements than values left.
    void check_count(const PlyElement& element) const {
        const PlyProperty& first = element.properties.front();
        if (element.count <= values_.at_most(first.count_type.value_or(first.type))) return;
        throw FileError(file_, fmt::format("claims {} of element '{}', but ends before that",
                                           element.count, element.name));
    }

    std::uint64_t list_length(const PlyProperty& property) {
        const double length = values_.next(*property.count_type);
        if (!(length >= 0.0) || length != std::floor(length) ||
            length > static_cast<double>(values_.at_most(property.type))) {
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
                    "the surplus left out");
    }

    void read_vertices(const PlyElement& element);
    void read_faces(const PlyElement& element);
    void read_corners(const PlyProperty& property);
    void read_corner_texcoords(const PlyProperty& property);

    Values values_;
    const std::filesystem::path& file_;
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
        if (has[nx] && has[ny] && has[nz]) mesh.normals.emplace_back(row[nx], row[ny], row[nz]);
        if (has[red] && has[green] && has[blue]) {
            mesh.colors.emplace_back(row[red], row[green], row[blue], row[alpha]);
        }
        if (has[u] && has[v]) mesh.texcoords.emplace_back(row[u], 1.0 - row[v]);
    }
}

template <typename Values>
void PlyElements<Values>::read_corners(const PlyProperty& property) {
    const std::uint64_t length = list_length(property);
    for (std::uint64_t i = 0; i < length; ++i) {
        const double index = values_.next(property.type);
        if (!(index >= 0.0 && index <= 4294967295.0 && index == std::floor(index))) {
            throw FileError(file_, fmt::format("face {} names vertex {}",
                                               data_.polygons.corner_counts.size(), index));
        }
        data_.polygons.corners.push_back(static_cast<std::uint32_t>(index));
    }
    data_.polygons.corner_counts.push_back(static_cast<std::uint32_t>(length));
}

/// A list of u v pairs, one per corner of the face that was just read. Writers leave it empty where
/// a face has no texture; only if every face does so, the mesh has no texture coordinates.
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
                data_.polygons.corner_counts.size() - 1, "has (0, 0) where they lack");
    texcoords.resize(data_.polygons.corners.size());
}

template <typename Values>
void PlyElements<Values>::read_faces(const PlyElement& element) {
    const auto is_corners = [](const PlyProperty& property) {
        return property.count_type &&
               (property.name == "vertex_indices" || property.name == "vertex_index");
    };
    const auto corners =
        std::find_if(element.properties.begin(), element.properties.end(), is_corners);
    if (corners == element.properties.end()) {
        throw FileError(file_, "its faces have no list of vertex indices");
    }
    const auto is_texcoords = [&](const PlyProperty& property) {
        return property.count_type && property.name == "texcoord" && &property > &*corners;
    };
    for (const PlyProperty& property : element.properties) {
        if (&property != &*corners && !is_texcoords(property)) count_unread(element, property);
    }
    ProgressStage stage("faces", element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
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

/// Corners that carry their own texture coordinates become vertices as OBJ's do.
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

PlyData read_data(const PlyHeader& header, std::string_view bytes,
                  const std::filesystem::path& file, const glm::dvec3& origin, Report& report) {
    switch (header.format) {
        case PlyFormat::ascii:
            return PlyElements(PlyTextValues(bytes, file), file, origin, report).read(header);
        case PlyFormat::little_endian:
            return PlyElements(PlyBinaryValues<false>(bytes, file), file, origin, report)
                .read(header);
        default:
            return PlyElements(PlyBinaryValues<true>(bytes, file), file, origin, report)
                .read(header);
    }
}

}  // namespace

MeshFile read_ply(const std::filesystem::path& file, const glm::dvec3& origin, Report& report) {
    static_assert(std::endian::native == std::endian::little);
    const FileContents contents(file);
    const std::string_view bytes = contents.text();
    const PlyHeader header = parse_ply_header(bytes, file);
    PlyData data = read_data(header, bytes.substr(header.data_begin), file, origin, report);
    if (!data.corner_texcoords.empty()) {
        data.corner_texcoords.resize(data.polygons.corners.size());
        unify_corners(data, file);
    }
    data.mesh.name = file.stem().string();
    add_triangles(data.mesh, data.polygons, file, report);
    MeshFile result;
    result.mesh = std::move(data.mesh);
    return result;
}

}  // namespace relief
