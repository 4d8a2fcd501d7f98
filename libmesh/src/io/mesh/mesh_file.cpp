// SPDX-License-Identifier: Apache-2.0
// Choosing the reader or writer of a mesh file by its extension.
//
// What a reader runs out of memory on is a FileError like all else that cannot be read.
// Tests: tests/mesh/io/mesh/mesh_file_test.cpp.
#include "relief/mesh/mesh_file.h"

#include <fmt/format.h>

#include <new>

#include "file_bytes.h"
#include "io/mesh/far_positions.h"
#include "io/mesh/obj_reader.h"
#include "io/mesh/obj_writer.h"
#include "io/mesh/ply_reader.h"
#include "io/mesh/ply_writer.h"
#include "io/mesh/polygon_off.h"
#include "io/mesh/polygon_stl.h"
#include "relief/mesh/error.h"

namespace relief {

MeshFile read_mesh(const std::filesystem::path& file, Report& report) {
    const std::string extension = lower_extension(file);
    try {
        if (extension == ".obj") return read_near(file, read_obj, report);
        if (extension == ".ply") return read_near(file, read_ply, report);
        if (extension == ".stl") return read_near(file, read_stl, report);
        if (extension == ".off") return read_near(file, read_off, report);
    } catch (const std::bad_alloc&) {
        throw FileError(file, "needs more memory than there is");
    }
    throw FileError(file, fmt::format("'{}' is no mesh format that is read here; .obj, .ply, .stl "
                                      "and .off are",
                                      extension));
}

void write_mesh(const std::filesystem::path& file, const MeshFile& contents) {
    validate(contents.mesh);
    for (const MaterialRange& range : contents.mesh.material_ranges) {
        if (range.material && *range.material >= contents.materials.size()) {
            throw InvalidInput(
                fmt::format("a material range names material {}, but there are "
                            "only {}",
                            *range.material, contents.materials.size()));
        }
    }
    const std::string extension = lower_extension(file);
    if (extension == ".obj") {
        write_obj(file, contents);
    } else if (extension == ".ply") {
        write_ply(file, contents);
    } else {
        throw InvalidInput(
            fmt::format("{}: '{}' is no mesh format that is written here; .obj and "
                        ".ply are",
                        file.string(), extension));
    }
}

}  // namespace relief
