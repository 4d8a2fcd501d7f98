// SPDX-License-Identifier: Apache-2.0
// The fuzz targets on files of the repository, on inputs like earlier faults (fuzz/inputs), and
// on mutations of both. The mutations are the same in every run. Real files are added if present.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "relief/mesh/limits.h"
#include "support/shared_data.h"
#include "targets.h"

namespace relief {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Numbers that do not depend on the library.
class Random {
  public:
    std::size_t below(std::size_t end) {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<std::size_t>(state_ >> 33) % end;
    }

  private:
    std::uint64_t state_ = 1;
};

Bytes bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Adds the files of a folder with one of the extensions, smallest first.
void add_files(const std::filesystem::path& folder, const std::string& extension,
               std::vector<Bytes>& inputs) {
    constexpr std::size_t max_bytes = 20'000;
    constexpr std::size_t max_files = 12;
    if (!std::filesystem::is_directory(folder)) return;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const bool fits = extension.empty() || entry.path().extension() == extension;
        if (entry.is_regular_file() && fits && entry.file_size() <= max_bytes)
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
        const auto sizes = std::pair(file_size(a), file_size(b));
        return sizes.first != sizes.second ? sizes.first < sizes.second : a < b;
    });
    for (std::size_t i = 0; i < std::min(files.size(), max_files); ++i)
        inputs.push_back(bytes_of(files[i]));
}

/// The known inputs of a target.
std::vector<Bytes> inputs_of(const FuzzTarget& target) {
    const std::filesystem::path source = RELIEF_SOURCE_DIRECTORY;
    const std::string name(target.name);
    std::vector<Bytes> inputs;
    add_files(source / "fuzz/inputs" / name, "", inputs);
    const std::map<std::string, std::string> extensions = {
        {"obj", ".obj"},   {"mtl", ".mtl"}, {"ply", ".ply"},  {"glb", ".glb"},
        {"gltf", ".gltf"}, {"png", ".png"}, {"rows", ".png"}, {"jpeg", ".jpg"}};
    if (const auto extension = extensions.find(name); extension != extensions.end()) {
        for (const char* const folder : {"data", "conformance/kit", "docs/images"})
            add_files(source / folder, extension->second, inputs);
        add_files(test::shared_directory() / "data/hostile", extension->second, inputs);
    }
    if (name == "stl") add_files(test::shared_directory() / "data/hostile", ".stl", inputs);
    if (name == "scene") add_files(source / "data/scenes", ".json", inputs);
    // Bytes for the algorithms, and inputs for readers without a file.
    Random random;
    for (int i = 0; i < 8; ++i) {
        Bytes bytes(400);
        for (std::uint8_t& byte : bytes)
            byte = static_cast<std::uint8_t>(random.below(256));
        inputs.push_back(bytes);
    }
    return inputs;
}

Bytes mutated(const std::vector<Bytes>& inputs, Random& random) {
    Bytes bytes = inputs[random.below(inputs.size())];
    const std::size_t changes = 1 + random.below(4);
    for (std::size_t i = 0; i < changes && !bytes.empty(); ++i) {
        const std::size_t place = random.below(bytes.size());
        const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(place);
        const std::size_t rest = std::min<std::size_t>(bytes.size() - place, 64);
        const auto end = at + static_cast<std::ptrdiff_t>(1 + random.below(rest));
        switch (random.below(6)) {
            case 0:
                *at = static_cast<std::uint8_t>(random.below(256));
                break;
            case 1:  // A digit or a sign, for text.
                *at = static_cast<std::uint8_t>("0123456789-+.e"[random.below(14)]);
                break;
            case 2:  // A number at the limit of its type.
                std::fill(at, at + static_cast<std::ptrdiff_t>(std::min<std::size_t>(rest, 4)),
                          static_cast<std::uint8_t>(random.below(2) == 0 ? 0xFF : 0x7F));
                break;
            case 3:
                bytes.erase(at, end);
                break;
            case 4: {
                const Bytes copy(at, end);
                bytes.insert(at, copy.begin(), copy.end());
                break;
            }
            default:
                if (random.below(4) == 0) bytes.resize(place);
        }
    }
    return bytes;
}

class Fuzzing : public testing::TestWithParam<FuzzTarget> {
  protected:
    // Images that only OpenImageIO can decode are refused: its readers are not relief's.
    Fuzzing() { setenv("RELIEF_MODULE_DIR", "/nonexistent", 1); }
    ~Fuzzing() override {
        unsetenv("RELIEF_MODULE_DIR");
        set_input_limits({});
    }
};

TEST_P(Fuzzing, KnownAndMutatedInputsGiveResultsOrErrors) {
    const std::vector<Bytes> inputs = inputs_of(GetParam());
    for (const Bytes& bytes : inputs)
        EXPECT_NO_THROW(run_target(GetParam(), bytes));
    Random random;
    for (int i = 0; i < 40; ++i)
        ASSERT_NO_THROW(run_target(GetParam(), mutated(inputs, random))) << "mutation " << i;
}

std::string name_of_case(const testing::TestParamInfo<FuzzTarget>& target) {
    return std::string(target.param.name);
}

INSTANTIATE_TEST_SUITE_P(Targets, Fuzzing,
                         testing::ValuesIn(fuzz_targets().begin(), fuzz_targets().end()),
                         name_of_case);

}  // namespace
}  // namespace relief
