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
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/polygon_mesh.h"
#include "large_memory.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// One value of an element, or a list of values.
struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type;  ///< The type of a list's length; absent for a single value.
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::size_t data_begin = 0;  ///< Offset of the first byte after the header.
};

PlyType type_named(std::string_view name, const TextScanner& text) {
    static constexpr std::array<std::pair<std::string_view, PlyType>, 16> types = {{
        {"char", PlyType::int8},
        {"int8", PlyType::int8},
        {"uchar", PlyType::uint8},
        {"uint8", PlyType::uint8},
        {"short", PlyType::int16},
        {"int16", PlyType::int16},
        {"ushort", PlyType::uint16},
        {"uint16", PlyType::uint16},
        {"int", PlyType::int32},
        {"int32", PlyType::int32},
        {"uint", PlyType::uint32},
        {"uint32", PlyType::uint32},
        {"float", PlyType::float32},
        {"float32", PlyType::float32},
        {"double", PlyType::float64},
        {"float64", PlyType::float64},
    }};
    for (const auto& [known, type] : types) {
        if (known == name) return type;
    }
    text.fail(fmt::format("{} is not a PLY type", quoted(name)));
}

PlyProperty parse_property(TextScanner& text) {
    PlyProperty property;
    std::string_view word = text.word_on_line();
    if (word == "list") {
        property.count_type = type_named(text.word_on_line(), text);
        if (*property.count_type == PlyType::float32 || *property.count_type == PlyType::float64) {
            text.fail("a list is counted in a floating-point type");
        }
        word = text.word_on_line();
    }
    property.type = type_named(word, text);
    property.name = text.word_on_line();
    if (property.name.empty()) text.fail("a property has no name");
    if (const auto more = text.word_on_line(); !more.empty()) {
        text.fail(fmt::format("a property line continues with {}", quoted(more)));
    }
    return property;
}

PlyElement parse_element(TextScanner& text) {
    PlyElement element;
    element.name = text.word_on_line();
    const std::string_view count = text.word_on_line();
    const auto number = number_in<std::uint64_t>(count);
    if (element.name.empty() || !number) {
        text.fail(fmt::format("an element has the count {}", quoted(count)));
    }
    element.count = *number;
    return element;
}

PlyFormat parse_format(TextScanner& text) {
    const std::string_view format = text.word_on_line();
    if (format == "ascii") return PlyFormat::ascii;
    if (format == "binary_little_endian") return PlyFormat::little_endian;
    if (format == "binary_big_endian") return PlyFormat::big_endian;
    text.fail(fmt::format("{} is not a PLY format", quoted(format)));
}

/// Bytes of one value in a binary file.
std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::float64:
            return 8;
        default:
            return 4;
    }
}

/// \throws FileError with the line of a malformed statement
PlyHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& file) {
    TextScanner text(bytes, file);
    if (text.word() != "ply") throw FileError(file, "does not begin with 'ply'");
    text.skip_line();
    PlyHeader header;
    bool has_format = false;
    for (std::string_view word = text.word(); word != "end_header"; word = text.word()) {
        if (word.empty()) throw FileError(file, "the header has no end_header line");
        if (word == "format") {
            if (!header.elements.empty()) text.fail("the format must precede the elements");
            header.format = parse_format(text);
            has_format = true;
        } else if (word == "element") {
            header.elements.push_back(parse_element(text));
        } else if (word == "property") {
            if (header.elements.empty()) text.fail("a property must follow an element");
            header.elements.back().properties.push_back(parse_property(text));
        } else if (word != "comment" && word != "obj_info") {
            text.fail(fmt::format("{} is not a keyword of PLY headers", quoted(word)));
        }
        text.skip_line();
    }
    if (!has_format) throw FileError(file, "the header has no format");
    text.skip_line();
    header.data_begin = bytes.size() - text.rest().size();
    return header;
}

/// Bytes that may follow the last element.
constexpr std::string_view ply_padding("\0 \t\r\n", 5);

/// Values as text.
class PlyTextValues {
  public:
    PlyTextValues(std::string_view data, const std::filesystem::path& file) : text_(data, file) {}

    double next(PlyType type) {
        const auto value = text_.number<double>();
        return type == PlyType::float32 ? static_cast<double>(static_cast<float>(value)) : value;
    }
    /// Moves to the next line, which has the next element; false if the line has surplus values.
    bool end_element() {
        const bool is_whole = text_.word_on_line().empty();
        text_.skip_line();
        return is_whole;
    }
    /// Number of bytes that have not been read.
    [[nodiscard]] std::uint64_t remaining() const { return text_.rest().size(); }
    /// Returns whether nothing but white space and zeros follows.
    bool is_at_end() {
        return text_.rest().find_first_not_of(ply_padding) == std::string_view::npos;
    }
    /// Upper bound of the number of remaining values, to validate counts.
    [[nodiscard]] std::uint64_t max_remaining(PlyType) const { return text_.rest().size() / 2 + 1; }
    /// Text has no triangles that can be copied.
    static bool next_triangle(PlyType, PlyType, glm::uvec3&) { return false; }

  private:
    TextScanner text_;
};

/// A file that is read from front to back, in pieces that stay in the cache.
class SequentialBytes {
  public:
    SequentialBytes(const RandomAccessFile& file, std::uint64_t begin)
        : file_(file), unread_(begin), piece_(piece_size) {}

    /// Returns whether `count` bytes follow; then they are at data(). At most a few values.
    bool has(std::size_t count) { return rest_.size() >= count || read_more(count); }
    [[nodiscard]] const char* data() const { return rest_.data(); }
    void skip(std::size_t count) { rest_.remove_prefix(count); }
    [[nodiscard]] std::uint64_t remaining() const { return rest_.size() + file_.size() - unread_; }

  private:
    static constexpr std::size_t piece_size = std::size_t{1} << 20;

    bool read_more(std::size_t count) {
        std::copy(rest_.begin(), rest_.end(), piece_.begin());
        const auto size = static_cast<std::size_t>(
            std::min<std::uint64_t>(piece_size - rest_.size(), file_.size() - unread_));
        file_.read(unread_, std::as_writable_bytes(std::span(piece_).subspan(rest_.size(), size)));
        unread_ += size;
        rest_ = {piece_.data(), rest_.size() + size};
        return rest_.size() >= count;
    }

    const RandomAccessFile& file_;
    std::uint64_t unread_;  ///< Offset of the first byte that is not in a piece yet.
    std::vector<char> piece_;
    std::string_view rest_;  ///< The part of the piece that has not been taken.
};

/// Values as bytes, in either order.
template <bool is_swapped>
class PlyBinaryValues {
  public:
    PlyBinaryValues(const RandomAccessFile& file, std::uint64_t begin)
        : bytes_(file, begin), file_(file.path()) {}

    double next(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return take<std::int8_t, std::uint8_t>();
            case PlyType::uint8:
                return take<std::uint8_t, std::uint8_t>();
            case PlyType::int16:
                return take<std::int16_t, std::uint16_t>();
            case PlyType::uint16:
                return take<std::uint16_t, std::uint16_t>();
            case PlyType::int32:
                return take<std::int32_t, std::uint32_t>();
            case PlyType::uint32:
                return take<std::uint32_t, std::uint32_t>();
            case PlyType::float32:
                return static_cast<double>(take<float, std::uint32_t>());
            case PlyType::float64:
                return take<double, std::uint64_t>();
        }
        return 0.0;
    }
    bool end_element() { return true; }
    [[nodiscard]] std::uint64_t remaining() const { return bytes_.remaining(); }
    bool is_at_end() {
        while (bytes_.has(1) && ply_padding.find(*bytes_.data()) != std::string_view::npos)
            bytes_.skip(1);
        return bytes_.remaining() == 0;
    }
    [[nodiscard]] std::uint64_t max_remaining(PlyType type) const {
        return bytes_.remaining() / size_of(type);
    }
    /// Takes a list of three indices, which is most of the data of large files. If the next list is
    /// none, or of rare types, it stays.
    bool next_triangle(PlyType count_type, PlyType index_type, glm::uvec3& triangle) {
        constexpr std::size_t size = 1 + sizeof(triangle);
        if (size_of(count_type) != 1 || size_of(index_type) != 4 ||
            index_type == PlyType::float32 || !bytes_.has(size) || *bytes_.data() != 3)
            return false;
        std::array<std::uint32_t, 3> corners{};
        std::memcpy(corners.data(), bytes_.data() + 1, sizeof(corners));
        for (std::uint32_t& corner : corners) {
            if constexpr (is_swapped) corner = swapped(corner);
            // Negative indices are reported as such.
            if (index_type == PlyType::int32 && corner > 0x7FFFFFFFU) return false;
        }
        bytes_.skip(size);
        triangle = glm::uvec3(corners[0], corners[1], corners[2]);
        return true;
    }

  private:
    template <typename Bits>
    static Bits swapped(Bits bits) {
        Bits result = 0;
        for (std::size_t i = 0; i < sizeof(Bits); ++i) {
            result = static_cast<Bits>(result << 8U) | static_cast<Bits>(bits & 0xFFU);
            bits = static_cast<Bits>(bits >> 8U);
        }
        return result;
    }

    template <typename Value, typename Bits>
    Value take() {
        if (!bytes_.has(sizeof(Bits))) throw FileError(file_, "ends in the middle of its data");
        Bits bits = 0;
        std::memcpy(&bits, bytes_.data(), sizeof(Bits));
        bytes_.skip(sizeof(Bits));
        if constexpr (is_swapped && sizeof(Bits) > 1) bits = swapped(bits);
        return std::bit_cast<Value>(bits);
    }

    SequentialBytes bytes_;
    const std::filesystem::path& file_;
};

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

/// The divisor for integers that stand for fractions: the largest value of their type.
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
