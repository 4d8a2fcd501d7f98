// SPDX-License-Identifier: Apache-2.0
// `relief-mesh lods` adds levels of detail to a model, or writes them as separate files.
// Tests: tests/tools/reshaping_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/file_jobs.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "file_replacement.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/model.h"
#include "relief/mesh/topology.h"
#include "reshape.h"

namespace relief::tools {
namespace {

constexpr int max_lod_levels = 16;

/// The measurement that determines the size at which a level takes over.
enum class SwitchRule { flip, distance };

struct LodsCommand {
    FileWords words;
    std::optional<ModelFormat> format;  ///< Of files in an output folder.
    std::optional<int> levels;  ///< Below the input; each has half the triangles of the one before.
    std::vector<int> triangles;  ///< By level.
    std::optional<double> pixel_error;
    SwitchRule rule = SwitchRule::flip;
    bool names = false;
    bool separate = false;
    std::optional<std::filesystem::path> preview;
    ReportOptions report;
    GeneralOptions general;

    /// Returns whether levels are added until one cannot get smaller.
    [[nodiscard]] bool is_open_ended() const { return pixel_error && !levels && triangles.empty(); }
    [[nodiscard]] double error() const { return pixel_error.value_or(0.5); }
};

/// A level of detail of one mesh.
struct MeshLevel {
    std::size_t mesh = 0;  ///< Of IN.
    std::size_t triangles = 0;
    double pixels = 0.0;
    double coverage = 1.0;
};

/// A level of detail of a model.
struct LevelResult {
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    SurfaceDistance distance;  ///< Of the input (a) and the level (b).
    bool is_sampled = false;   ///< Whether some of the distances are those of random samples.
    /// The largest distance in pixels, at the size at which the mesh switches.
    double distance_pixels = 0.0;
    double pixels = 0.0;         ///< The smallest size on the screen at which a mesh switches.
    double coverage = 1.0;       ///< The same as a part of the screen.
    std::optional<double> flip;  ///< The largest difference of a mesh at its size.
    double moved_flip = 0.0;     ///< That of the moved input.
    std::vector<MeshLevel> meshes;
    std::filesystem::path file;  ///< The file that has the level.
    std::vector<PartReport> reports;
};

/// A mesh of a document with its levels of detail.
struct LodMesh {
    std::size_t mesh = 0;
    Mesh surface;  ///< Of the input, without attributes.
    double diameter = 0.0;
    std::size_t last = 0;  ///< The mesh of the last level.
    double last_pixels = std::numeric_limits<double>::infinity();
    std::vector<GltfLevel> levels;
};

/// Returns the diameter of the sphere around the bounds.
double diameter_of(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    if (bounds.empty()) return 0.0;
    return glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
}

std::vector<LodMesh> lod_meshes_of(const GltfDocument& document) {
    std::vector<LodMesh> meshes;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        if (meshes.empty() || meshes.back().mesh != id.mesh) {
            meshes.emplace_back();
            meshes.back().mesh = id.mesh;
            meshes.back().last = id.mesh;
        }
        Mesh& surface = meshes.back().surface;
        const Mesh part = document.mesh(id);
        const auto first = static_cast<std::uint32_t>(surface.positions.size());
        surface.positions.insert(surface.positions.end(), part.positions.begin(),
                                 part.positions.end());
        for (const glm::uvec3& triangle : part.triangles)
            surface.triangles.push_back(triangle + first);
    }
    for (LodMesh& mesh : meshes)
        mesh.diameter = diameter_of(mesh.surface);
    return meshes;
}

/// Returns the size at which the sphere around a mesh covers the screen.
double pixels_of_screen() {
    return std::sqrt(lod_screen_width * lod_screen_height * 4.0 / std::numbers::pi);
}

/// Returns the part of the screen that the sphere around a mesh covers.
double coverage_of(double pixels) {
    const double area = std::numbers::pi / 4.0 * pixels * pixels;
    return area / (lod_screen_width * lod_screen_height);
}

struct LodsResult {
    LevelResult input;
    std::vector<LevelResult> levels;
    std::vector<std::filesystem::path> files;
    Findings findings;
    std::string backend;       ///< What draws the pictures; empty if nothing does.
    std::string not_measured;  ///< The reason why FLIP was not measured for some meshes.
};

/// Makes levels, one from the other.
class LevelMaker {
  public:
    /// \param pictures  null, or those of another model, whose context is used again
    LevelMaker(const LodsCommand& command, const Job& job, GltfDocument& document, Stages& stages,
               std::unique_ptr<LevelPictures>& pictures, LodsResult& done);

    void make_all();

  private:
    void load_pictures();
    [[nodiscard]] std::vector<double> wanted_triangles() const;
    LevelResult make(double wanted);
    void decimate(LodMesh& mesh, double ratio, LevelResult& level);
    void choose_sizes(LevelResult& level);
    [[nodiscard]] bool has_pictures(std::size_t mesh) const {
        return pictures_ && std::find(drawn_.begin(), drawn_.end(), mesh) != drawn_.end();
    }
    [[nodiscard]] SurfaceDistance measured_distance(std::size_t mesh) const;
    [[nodiscard]] std::optional<LevelSwitch> measured_switch(std::size_t mesh, double start,
                                                             double most);
    void write(std::size_t level);
    void forget_last();

    const LodsCommand& command_;
    const Job& job_;
    GltfDocument& document_;
    Stages& stages_;
    LodsResult& done_;
    std::vector<LodMesh> meshes_;
    std::vector<Mesh> surfaces_;  ///< Of the new level, by mesh.
    std::unique_ptr<LevelPictures>& pictures_;
    /// The meshes whose pictures are measured: the largest ones.
    std::vector<std::size_t> drawn_;
};

LevelMaker::LevelMaker(const LodsCommand& command, const Job& job, GltfDocument& document,
                       Stages& stages, std::unique_ptr<LevelPictures>& pictures, LodsResult& done)
    : command_(command),
      job_(job),
      document_(document),
      stages_(stages),
      done_(done),
      pictures_(pictures) {
    meshes_ = lod_meshes_of(document);
    if (meshes_.empty()) throw InvalidInput("has no triangles");
    for (const LodMesh& mesh : meshes_) {
        done.input.triangles += mesh.surface.triangles.size();
        done.input.vertices += mesh.surface.positions.size();
    }
}

void LevelMaker::load_pictures() {
    // Drawing each of many small meshes at many sizes would take long.
    constexpr std::size_t max_drawn = 24;
    if (command_.rule == SwitchRule::distance) return;
    for (std::size_t i = 0; i < meshes_.size(); ++i)
        drawn_.push_back(i);
    std::stable_sort(drawn_.begin(), drawn_.end(), [&](std::size_t a, std::size_t b) {
        return meshes_[a].surface.triangles.size() > meshes_[b].surface.triangles.size();
    });
    if (drawn_.size() > max_drawn) {
        done_.not_measured =
            fmt::format("only the largest {} of {} meshes are drawn", max_drawn, drawn_.size());
        drawn_.resize(max_drawn);
    }
    std::vector<std::size_t> meshes;
    for (const std::size_t i : drawn_)
        meshes.push_back(meshes_[i].mesh);
    try {
        if (!pictures_) pictures_ = std::make_unique<LevelPictures>(command_.error());
        pictures_->set_input(document_, meshes, job_.input);
        done_.backend = pictures_->backend_name();
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        pictures_.reset();
        done_.not_measured = error.what();
    }
}

/// Returns the number of triangles of each level.
std::vector<double> LevelMaker::wanted_triangles() const {
    std::vector<double> wanted(command_.triangles.begin(), command_.triangles.end());
    if (!wanted.empty()) return wanted;
    auto count = static_cast<double>(done_.input.triangles);
    constexpr int default_levels = 3;
    const int levels =
        command_.is_open_ended() ? max_lod_levels : command_.levels.value_or(default_levels);
    for (int i = 0; i < levels; ++i) {
        count /= 2.0;
        wanted.push_back(std::round(count));
    }
    return wanted;
}

/// Decimates the last level of a mesh, in a copy or, for separate files, in its place.
void LevelMaker::decimate(LodMesh& mesh, double ratio, LevelResult& level) {
    const std::size_t target = command_.separate ? mesh.mesh : document_.copy_mesh(mesh.last);
    const double wanted = ratio * static_cast<double>(mesh.surface.triangles.size());
    Mesh& surface = surfaces_.emplace_back();
    ChangedModel changed = change_triangles(
        document_, std::array{target}, NormalMode::keep,
        [&](const TriangleInput& before, Report& report) {
            DecimateOptions options;
            options.triangles = static_cast<std::size_t>(std::max(1.0, std::round(wanted)));
            options.fit_positions = true;
            FramedMesh after = decimated(before.mesh, options, report, before.deformation);
            surface = without_attributes(after.mesh);
            return after;
        });
    for (PartReport& part : changed.reports)
        level.reports.push_back(std::move(part));
    level.meshes.push_back({mesh.mesh, changed.triangles_written});
    level.triangles += changed.triangles_written;
    level.vertices += changed.vertices_written;
    mesh.last = target;
}

std::optional<LevelSwitch> LevelMaker::measured_switch(std::size_t mesh, double start,
                                                       double most) {
    const auto place = std::find(drawn_.begin(), drawn_.end(), mesh);
    if (!pictures_ || place == drawn_.end()) return std::nullopt;
    try {
        return pictures_->find_switch(static_cast<std::size_t>(place - drawn_.begin()), start,
                                      most);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        pictures_.reset();
        done_.not_measured = error.what();
        return std::nullopt;
    }
}

/// Measures the distance of a mesh from its level: at random samples if pictures choose its size,
/// otherwise in full.
SurfaceDistance LevelMaker::measured_distance(std::size_t mesh) const {
    const Mesh& before = meshes_[mesh].surface;
    if (!has_pictures(mesh)) return surface_distance(before, surfaces_[mesh]);
    const std::size_t samples = std::clamp<std::size_t>(before.triangles.size() / 32, 500, 5'000);
    return sampled_distance(before, surfaces_[mesh], samples, samples,
                            static_cast<std::uint32_t>(mesh));
}

/// Measures the level, and chooses the size at which it takes over for each mesh.
void LevelMaker::choose_sizes(LevelResult& level) {
    std::vector<bool> are_sampled;
    std::vector<SurfaceDistance> distances = stages_.run("measure", [&] {
        std::vector<SurfaceDistance> measured;
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            are_sampled.push_back(has_pictures(i));
            measured.push_back(measured_distance(i));
        }
        return measured;
    });
    level.pixels = std::numeric_limits<double>::infinity();
    stages_.run("draw", [&] {
        if (pictures_) {
            std::vector<std::size_t> shown;
            for (const std::size_t i : drawn_)
                shown.push_back(meshes_[i].last);
            pictures_->set_level(document_, shown, job_.input);
        }
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            LodMesh& mesh = meshes_[i];
            // The size at which the largest distance has the error on the screen.
            const auto pixels_by_distance = [&] {
                const double largest = std::max(distances[i].from_a.max, distances[i].from_b.max);
                return largest > 0.0 ? command_.error() * mesh.diameter / largest
                                     : lod_screen_height * 4.0;
            };
            double pixels = pixels_by_distance();
            const auto found = measured_switch(i, pixels, mesh.last_pixels);
            // Sizes beyond the screen's height are not drawn.
            const bool is_beyond = found && found->flip <= found->moved_flip &&
                                   pixels > found->pixels &&
                                   2.0 * found->pixels > lod_screen_height;
            // A distance that decides is that of all vertices.
            if (!found && are_sampled[i]) {
                are_sampled[i] = false;
                distances[i] = surface_distance(mesh.surface, surfaces_[i]);
                pixels = pixels_by_distance();
            } else if (is_beyond) {
                // A little beyond the size of the screen, the level is used at every size.
                const double of_pixel = command_.error() * mesh.diameter;
                const double least = std::max({of_pixel / (1.01 * pixels_of_screen()),
                                               distances[i].from_a.max, distances[i].from_b.max});
                pixels = of_pixel / largest_vertex_distance(mesh.surface, surfaces_[i], least);
            }
            if (found) {
                if (!is_beyond || pixels < found->pixels) pixels = found->pixels;
                if (!level.flip || found->flip > *level.flip) {
                    level.flip = found->flip;
                    level.moved_flip = found->moved_flip;
                }
            }
            pixels = std::min(pixels, mesh.last_pixels);
            mesh.last_pixels = pixels;
            const double coverage = std::min(1.0, coverage_of(pixels));
            mesh.levels.push_back({mesh.last, coverage});
            level.pixels = std::min(level.pixels, pixels);
            level.coverage = std::min(level.coverage, coverage);
            level.meshes[i].pixels = pixels;
            level.meshes[i].coverage = coverage;
            level.is_sampled = level.is_sampled || are_sampled[i];
            const double largest = std::max(distances[i].from_a.max, distances[i].from_b.max);
            if (mesh.diameter > 0.0)
                level.distance_pixels =
                    std::max(level.distance_pixels, largest * pixels / mesh.diameter);
        }
        return 0;
    });
    level.distance = joined_distance(distances);
}

/// Returns the file of a level: OUT_LOD1.glb for OUT.glb.
std::filesystem::path level_file(const std::filesystem::path& output, std::size_t level) {
    std::filesystem::path file = output;
    file.replace_filename(
        fmt::format("{}_LOD{}{}", output.stem().string(), level, output.extension().string()));
    return file;
}

void LevelMaker::write(std::size_t level) {
    if (!command_.separate) return;
    done_.files.push_back(level_file(job_.output, level));
    stages_.run("write", [&] {
        Report report;
        document_.write(done_.files.back(), report);
        // Repairs of the input are the same in all files.
        if (level == 0) done_.findings.add("", report);
        return 0;
    });
}

void LevelMaker::forget_last() {
    for (std::size_t i = 0; i < meshes_.size() && !command_.separate; ++i)
        document_.remove_last_mesh();
}

LevelResult LevelMaker::make(double wanted) {
    LevelResult level;
    surfaces_.clear();
    const double ratio = std::min(1.0, wanted / static_cast<double>(done_.input.triangles));
    stages_.run("decimate", [&] {
        for (LodMesh& mesh : meshes_)
            decimate(mesh, ratio, level);
        return 0;
    });
    return level;
}

void LevelMaker::make_all() {
    // Without a given number, a level must have at most this part of the triangles of the one
    // before, and must take over at a size of at least one pixel.
    constexpr double max_part = 0.75;
    stages_.run("draw", [&] {
        load_pictures();
        return 0;
    });
    write(0);
    std::size_t before = done_.input.triangles;
    for (const double wanted : wanted_triangles()) {
        LevelResult level = make(wanted);
        const bool is_smaller =
            static_cast<double>(level.triangles) <= max_part * static_cast<double>(before);
        if (command_.is_open_ended() && !is_smaller) {
            forget_last();
            break;
        }
        choose_sizes(level);
        if (command_.is_open_ended() && level.pixels < 1.0) {
            for (LodMesh& mesh : meshes_)
                mesh.levels.pop_back();
            forget_last();
            break;
        }
        before = level.triangles;
        for (const PartReport& part : level.reports)
            done_.findings.add(fmt::format("LOD{} of {}", done_.levels.size() + 1, part.part),
                               part.report);
        done_.levels.push_back(std::move(level));
        write(done_.levels.size());
        done_.levels.back().file = command_.separate ? done_.files.back() : job_.output;
    }
    if (command_.separate) return;
    for (const LodMesh& mesh : meshes_) {
        if (!mesh.levels.empty())
            document_.set_levels_of_detail(mesh.mesh, mesh.levels, command_.names);
    }
    done_.files.push_back(job_.output);
    stages_.run("write", [&] {
        Report report;
        document_.write(job_.output, report);
        done_.findings.add("", report);
        return 0;
    });
}

LodsResult make_levels(const LodsCommand& command, const Job& job, Stages& stages,
                       std::unique_ptr<LevelPictures>& pictures) {
    LodsResult done;
    Report report;
    Model model = stages.run("read", [&] { return read_model(job.input, report); });
    if (const auto* contents = std::get_if<MeshFile>(&model))
        model = about(job.input, [&] { return GltfDocument::from_mesh(*contents, report); });
    done.findings.add("", report);
    if (std::get<GltfDocument>(model).has_levels_of_detail()) {
        throw failure(job.input, "already has levels of detail (MSFT_lod)",
                      "give the model that they were made from");
    }
    relief::detail::FileSet files;
    about(job.input, [&] {
        LevelMaker(command, job, std::get<GltfDocument>(model), stages, pictures, done).make_all();
        return 0;
    });
    files.commit();
    return done;
}

std::string level_text(const LevelResult& level, std::size_t number) {
    const double largest = std::max(level.distance.from_a.max, level.distance.from_b.max);
    std::string text = fmt::format("LOD{}: {}, largest distance {}{:.3g}, used ", number,
                                   counted(level.triangles, "triangle"),
                                   level.is_sampled ? "of samples " : "", largest);
    if (level.coverage < 1.0) {
        text += fmt::format("below {:.4g} pixels, {:.3g} % of the screen", level.pixels,
                            100.0 * level.coverage);
    } else {
        text += "at any size";
    }
    if (level.flip) text += fmt::format(", FLIP {:.3g}", *level.flip);
    return text;
}

Json meshes_json(const LevelResult& level) {
    Json meshes = Json::array();
    for (const MeshLevel& mesh : level.meshes)
        meshes.push_back({{"mesh", mesh.mesh},
                          {"triangles", mesh.triangles},
                          {"pixels", mesh.pixels},
                          {"coverage", mesh.coverage}});
    return meshes;
}

Summary lods_summary(const LodsCommand& command, const Job& job, const LodsResult& done,
                     const Stages& stages) {
    Summary summary;
    summary.add(
        "read",
        fmt::format("{}: {}, {}, {}", job.input.string(), format_name(readable_format(job.input)),
                    counted(done.input.triangles, "triangle"),
                    counted(done.input.vertices, "vertex", "vertices")),
        {{"triangles_read", done.input.triangles}, {"vertices_read", done.input.vertices}});
    std::vector<std::string> lines;
    Json levels = Json::array();
    for (const LevelResult& level : done.levels) {
        lines.push_back(level_text(level, lines.size() + 1));
        Json json = {{"file", level.file.string()},
                     {"triangles", level.triangles},
                     {"vertices", level.vertices},
                     {"distance",
                      {{"of_input", distance_json(level.distance.from_a)},
                       {"of_output", distance_json(level.distance.from_b)},
                       {"sampled", level.is_sampled}}},
                     {"distance_pixels", level.distance_pixels},
                     {"pixels", level.pixels},
                     {"coverage", level.coverage},
                     {"flip", or_null(level.flip)}};
        json["flip_of_moved_input"] = level.flip ? Json(level.moved_flip) : Json(nullptr);
        json["meshes"] = meshes_json(level);
        levels.push_back(std::move(json));
    }
    if (lines.empty()) lines.emplace_back("none: IN cannot get smaller");
    summary.add("levels", lines, {{"levels", std::move(levels)}});
    Json reason = nullptr;
    if (!done.not_measured.empty()) {
        reason = done.not_measured;
        summary.add("FLIP",
                    fmt::format("not measured{}: {}; the largest distance decides there",
                                done.backend.empty() ? "" : " for all meshes", done.not_measured));
    } else if (!done.backend.empty()) {
        summary.add("FLIP",
                    fmt::format("drawn by {}; a level takes over where it differs from IN no more "
                                "than IN moved by {} pixels",
                                done.backend, command.error()));
    }
    summary.add_json({{"flip_not_measured", reason}});
    summary.add_findings(done.findings);
    summary.add_times(stages);
    std::vector<std::string> written;
    for (const std::filesystem::path& file : done.files)
        written.push_back(file_and_size(file));
    summary.add("wrote", written);
    return summary;
}

std::string line_of(const Job& job, const LodsResult& done, const Stages& stages) {
    std::vector<std::string> levels;
    for (const LevelResult& level : done.levels)
        levels.push_back(fmt::format("{} below {:.4g} px", level.triangles, level.pixels));
    return fmt::format("{}: {} -> {}{}, {}, {}", job.output.string(), done.input.triangles,
                       levels.empty() ? "no level" : fmt::format("{}", fmt::join(levels, ", ")),
                       done.not_measured.empty() ? "" : ", FLIP not measured for all",
                       done.findings.count_text(), duration(stages.milliseconds()));
}

/// Returns the name of an output in the output folder: that of IN, as glTF.
std::filesystem::path name_in_folder(const std::filesystem::path& input,
                                     std::optional<ModelFormat> format) {
    const ModelFormat input_format = readable_format(input);
    const ModelFormat kept = is_document(input_format) ? input_format : ModelFormat::glb;
    return input.filename().replace_extension(extension_for(format.value_or(kept)));
}

JobList jobs_of(const LodsCommand& command) {
    JobList list = jobs_of(command.words, "model", [&](const std::filesystem::path& input) {
        return name_in_folder(input, command.format);
    });
    if (command.format && !list.folder)
        throw UsageError(fmt::format("--format: the name {} already has a format",
                                     list.jobs.front().output.string()),
                         "omit --format, or give a folder: -o out/");
    for (const Job& job : list.jobs) {
        readable_format(job.input);
        if (!is_document(writable_format(job.output))) {
            throw UsageError(fmt::format("{}: cannot store levels of detail", job.output.string()),
                             "write a .glb or .gltf");
        }
    }
    return list;
}

void check_command(const LodsCommand& command) {
    if (command.levels && !command.triangles.empty())
        throw UsageError("--levels and --triangles contradict each other", "give one of them");
    if (command.names && command.separate)
        throw UsageError("--names: has no effect with --separate, whose files have no levels",
                         "leave one of them out");
    if (command.preview && !command.separate)
        throw UsageError("--preview: shows separate files", "add --separate, or leave it out");
    if (command.preview && extension_of(*command.preview) != ".html")
        throw UsageError(
            fmt::format("--preview {}: the format is not supported", command.preview->string()),
            "use .html");
    for (std::size_t i = 1; i < command.triangles.size(); ++i) {
        if (command.triangles[i] >= command.triangles[i - 1]) {
            throw UsageError(fmt::format("--triangles: {} is not less than {}",
                                         command.triangles[i], command.triangles[i - 1]),
                             "give the finest level first");
        }
    }
}

Json options_json(const LodsCommand& command) {
    Json options = {{"error", command.error()},
                    {"switch", command.rule == SwitchRule::flip ? "flip" : "distance"},
                    {"names", command.names},
                    {"separate", command.separate}};
    if (command.levels) options["levels"] = *command.levels;
    if (!command.triangles.empty()) options["triangles"] = command.triangles;
    return options;
}

/// No level may replace an input or a level of another model, and the report none of the files.
void check_files(const LodsCommand& command, const JobList& list) {
    std::vector<std::filesystem::path> files;
    std::set<std::filesystem::path> used;
    for (const Job& job : list.jobs) {
        files.insert(files.end(), {job.input, job.output});
        used.insert(identity_of(job.input));
    }
    for (const Job& job : list.jobs) {
        for (std::size_t level = 0; level <= max_lod_levels && command.separate; ++level) {
            const std::filesystem::path file = level_file(job.output, level);
            const bool is_input = level == 0 && identity_of(file) == identity_of(job.input);
            if (!used.insert(identity_of(file)).second && !is_input) {
                throw UsageError(fmt::format(
                    "--separate {}: is also {}", file.string(),
                    list.is_single() ? "the input or the output" : "another file of the command"));
            }
            files.push_back(file);
        }
    }
    if (list.folder) make_folder(*list.folder);
    if (command.preview) {
        if (!list.is_single())
            throw UsageError("--preview: shows one model", "leave it out, or give one model");
        check_distinct("--preview", *command.preview, files);
        require_folder_of(*command.preview);
        files.push_back(*command.preview);
    }
    check(command.report, files);
    require_folder_of(list.jobs.front().output);
}

/// Writes one model with its levels, and prints its summary.
ExitCode lods_of_one(const CLI::App& app, const LodsCommand& command, const Job& job, Json head) {
    Stages stages(command.general.quiet);
    std::unique_ptr<LevelPictures> pictures;
    const LodsResult done = make_levels(command, job, stages, pictures);
    pictures.reset();
    if (command.preview && done.files.size() > 1)
        stages.run("preview", [&] { write_level_page(*command.preview, done.files); });
    const Summary summary = lods_summary(command, job, done, stages);
    if (!command.general.quiet) summary.print();
    head["input"] = job.input.string();
    head["output"] = job.output.string();
    head.update(summary.json());
    return finish(app, command.report, job.input, done.findings, head);
}

/// Writes several models, and prints a line for each.
ExitCode lods_of_all(const CLI::App& app, const LodsCommand& command, const JobList& list,
                     Json head) {
    // All models are drawn in one context, on this thread.
    std::unique_ptr<LevelPictures> pictures;
    Batch batch;
    batch.jobs = list.jobs;
    batch.one_by_one = true;
    batch.head = std::move(head);
    batch.work = [&](std::size_t index) -> FileOutcome {
        const Job& job = list.jobs[index];
        Stages stages(true);
        const LodsResult done = make_levels(command, job, stages, pictures);
        return {line_of(job, done, stages), done.findings,
                lods_summary(command, job, done, stages)};
    };
    return run_batch(app, batch, command.report, command.general);
}

ExitCode lods(const CLI::App& app, const LodsCommand& command) {
    check_command(command);
    const JobList list = jobs_of(command);
    check_files(command, list);
    set_thread_limit(command.general.threads);
    const Json head = {{"tool", "relief-mesh " + command_name(app)},
                       {"version", version()},
                       {"options", options_json(command)}};
    return list.is_single() ? lods_of_one(app, command, list.jobs.front(), head)
                            : lods_of_all(app, command, list, head);
}

void add_lods_options(CLI::App& app, LodsCommand& command) {
    add_files(app, "FILE...", command.words.files,
              "IN OUT: the model to read (.glb .gltf .obj .ply .stl .off) and the file to write "
              "(.glb .gltf), which may be IN itself. With -o: any number of models to read.");
    const std::string levels = "Levels";
    add_value(app, "--levels", "N",
              "The number of levels below IN, 1 to 16. Each has half the triangles of the one "
              "before. Default: 3, or with --error alone as many as get smaller.",
              [&command](const std::string& subject, const std::string& text) {
                  command.levels = parse_integer(subject, text, 1, max_lod_levels);
              })
        .group(levels);
    add_value(app, "--triangles", "A,B,...",
              "The number of triangles of each level below IN, in descending order.",
              [&command](const std::string& subject, const std::string& text) {
                  for (const std::string& part : split(text, ','))
                      command.triangles.push_back(
                          parse_integer(subject, part, 1, std::numeric_limits<int>::max()));
              })
        .group(levels);
    const std::string sizes = "Sizes";
    add_value(app, "--error", "PIXELS",
              "The error at which a level takes over, in pixels of a screen of 1920 x 1080: 0.5 or "
              "0.5px. Default: 0.5.",
              [&command](const std::string& subject, const std::string& text) {
                  const bool has_unit = text.ends_with("px");
                  command.pixel_error =
                      parse_number(subject, text.substr(0, text.size() - (has_unit ? 2 : 0)),
                                   {0.001, 1000.0, "pixels"});
              })
        .group(sizes);
    add_choice(app, "--switch", command.rule,
               Choices<SwitchRule>{{"flip", SwitchRule::flip}, {"distance", SwitchRule::distance}},
               "A level takes over at the largest size at which its picture differs from that of "
               "IN no more than IN moved by the error (flip), or at which no point of its surface "
               "is farther than the error from that of IN (distance, which needs no OpenGL). "
               "Default: flip.")
        .group(sizes);
    const std::string output = "Output";
    add_value(
        app, "-o,--output", "PATH",
        "The output: a folder (with / at the end, or existing), or a file for one model. In "
        "a folder, each model keeps its name. If a model fails, the others are still "
        "processed.",
        [&command](const std::string&, const std::string& text) { command.words.output = text; })
        .group(output);
    add_choice(app, "--format", command.format,
               Choices<ModelFormat>{{"glb", ModelFormat::glb}, {"gltf", ModelFormat::gltf}},
               "The format of the files in an output folder. Default: the format of the input, or "
               "glb for inputs that are not glTF.")
        .group(output);
    add_switch(app, "--names", command.names,
               "Append _LOD0, _LOD1, ... to the names of the nodes. Default: they keep their name.")
        .group(output);
    add_switch(app, "--separate", command.separate,
               "Write separate files without MSFT_lod, OUT_LOD0.glb (IN), OUT_LOD1.glb, ..., "
               "instead of OUT.glb.")
        .group(output);
    add_path(app, "--preview", command.preview,
             "Also write a page (.html) that shows IN beside each level and can be orbited. Needs "
             "--separate and one model. docs/page.md describes pages.")
        .group("Report");
    add_report_options(app, command.report);
    add_general_options(app, command.general);
    set_examples(app, {"relief-mesh lods data/vase.obj out/vase-lods.glb",
                       "relief-mesh lods data/vase.obj out/vase-lods.glb --triangles 3000,1000,300 "
                       "--error 1px --names",
                       "relief-mesh lods data/vase.obj out/vase.glb --error 0.5px --separate "
                       "--preview out/vase-lods.html",
                       "relief-mesh lods data/*.obj -o out/lods/ --report out/lods.json"});
}

}  // namespace

Command add_lods_command(CLI::App& tool) {
    return add_command<LodsCommand>(
        tool, "lods", "Adds levels of detail to a model, with the sizes at which they take over.",
        add_lods_options, lods);
}

}  // namespace relief::tools
