// SPDX-License-Identifier: Apache-2.0
// relief-make-manuals SHARE FILE.json...: writes the manual pages and completions of the tools
// whose
// --help-json is in the files, below the folder SHARE.
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/help.h"

int main(int argc, char** argv) {
    try {
        if (argc < 3) throw std::runtime_error("usage: relief-make-manuals SHARE FILE.json...");
        for (int i = 2; i < argc; ++i) {
            std::ifstream file(argv[i]);
            const auto tool = nlohmann::ordered_json::parse(file);
            for (const relief::tools::ManualFile& manual : relief::tools::manual_files(tool)) {
                const std::filesystem::path path = argv[1] / manual.path;
                std::filesystem::create_directories(path.parent_path());
                std::ofstream output(path, std::ios::binary);
                output << manual.text << std::flush;
                if (!output) throw std::runtime_error(path.string() + ": cannot be written");
            }
        }
    } catch (const std::exception& error) {
        std::cerr << "relief-make-manuals: error: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
