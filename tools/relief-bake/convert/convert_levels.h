// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writes a converted map, and with --mips the levels below it and their roughness.
/// Tests: tests/tools/convert_test.cpp.
#pragma once

#include "convert/convert_job.h"
#include "convert/convert_steps.h"

namespace relief::tools {

class LevelWriter {
  public:
    /// Refers to all of these; `done` gets the levels as they are written.
    LevelWriter(const Job& job, const ConvertRequest& request,
                const std::map<std::string, std::string>& input_metadata, Converted& done);

    /// The map alone, whose codes are final.
    void write_codes(const Image& codes, Report& report);

    /// Codes normals and writes them, with what --mips asks for. Takes the field apart.
    void write_levels(NormalField& field, Stages& stages, Report& report);

  private:
    void write_all_levels(NormalField& field, Stages& stages, Report& report);
    [[nodiscard]] Image coded_level(const Image& normals, const std::optional<Image>& alpha,
                                    Report& report) const;
    void write_level(std::size_t level, const Image& codes, const Image& lengths, Stages& stages,
                     Report& report);
    void write_roughness(WrittenLevel& written, std::size_t level, const Image& lengths,
                         Stages& stages, Report& report);
    void write(const std::filesystem::path& file, const Image& image,
               const std::map<std::string, std::string>& metadata, Report& report) const;
    [[nodiscard]] std::map<std::string, std::string> metadata() const;

    const Job& job_;
    const ConvertRequest& request_;
    std::map<std::string, std::string> kept_;  ///< Of the input's metadata.
    Converted& done_;
};

}  // namespace relief::tools
