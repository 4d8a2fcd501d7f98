// SPDX-License-Identifier: Apache-2.0
#include "gltf_damage.h"

#include <cstdint>
#include <cstring>
#include <fstream>

#include "file_bytes.h"
#include "relief/mesh/error.h"
#include "relief/mesh/gltf_document.h"

namespace relief::test {

void write_damaged_copy(const std::filesystem::path& file, const std::filesystem::path& copy,
                        std::mt19937& random) {
    std::string bytes = read_file(file);
    std::uint32_t json_size = 0;
    std::memcpy(&json_size, bytes.data() + 12, sizeof(json_size));
    const std::size_t first = 28 + std::size_t{json_size};
    for (unsigned k = 0; k <= random() % 4; ++k)
        bytes[first + random() % (bytes.size() - first)] = static_cast<char>(random());
    std::filesystem::remove(copy);  // ext4 waits for the disk when a file is truncated.
    std::ofstream(copy, std::ios::binary) << bytes;
}

bool is_refused(const std::filesystem::path& file) {
    try {
        Report report;
        const GltfDocument document = GltfDocument::read(file, report);
        for (const GltfPrimitiveId id : document.triangle_primitives()) {
            try {
                validate(document.mesh(id));
            } catch (const InvalidInput&) {
                continue;  // An index out of range, say: named, not used.
            }
        }
        std::filesystem::path written = file;
        document.write(written.replace_filename("written.glb"));
        return false;
    } catch (const FileError&) {
        return true;
    }
}

}  // namespace relief::test
