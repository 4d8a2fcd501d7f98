// SPDX-License-Identifier: Apache-2.0
// Reads exercises, and compares pictures with those of their solutions.
#include "exercise.h"

#include <fmt/format.h>

#include <algorithm>

#include "files.h"
#include "json_cursor.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/renderer.h"

namespace relief::tools {
using namespace relief::detail;
using namespace relief::shade;

namespace {

constexpr int format_version = 1;

/// The parts that are built in.
const ShaderTexts built_in{{}, false};

/// Returns the file that a string names, relative to the exercise.
std::filesystem::path file_in(const JsonCursor& cursor, const std::filesystem::path& exercise) {
    std::filesystem::path file = exercise.parent_path() / cursor.text();
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none))
        cursor.fail(fmt::format("names {}, which is no file", file.string()));
    return file;
}

/// Returns the part of the exercise in a file of its own.
std::string part_in(const JsonCursor& cursor, const Exercise& exercise) {
    const std::filesystem::path file = file_in(cursor, exercise.file);
    try {
        const std::string name = shader_part_text(exercise.part, built_in).file;
        const ShaderPartText part =
            shader_part_text(exercise.part, {{{name, read_file(file)}}, false});
        if (!part.is_built_in) return part.text;
    } catch (const GpuError& error) {
        cursor.fail(fmt::format("{}: {}", file.string(), error.what()));
    }
    cursor.fail(fmt::format("{} has no part '{}'", file.string(), exercise.part));
}

std::vector<std::string> texts_in(const JsonCursor& array) {
    std::vector<std::string> texts;
    for (const JsonCursor& element : array.elements())
        texts.push_back(element.text());
    return texts;
}

Exercise exercise_in(const JsonCursor& root, const std::filesystem::path& file) {
    root.allow({"relief_exercise", "title", "task", "hints", "scene", "part", "start", "solution",
                "reference", "max_flip"});
    if (root.at("relief_exercise").whole_number(0, 1000000) != format_version) {
        root.at("relief_exercise")
            .fail(fmt::format("must be {}, the only version", format_version));
    }
    Exercise exercise;
    exercise.file = file;
    exercise.title = root.at("title").text();
    exercise.task = root.at("task").text();
    if (const auto hints = root.find("hints")) exercise.hints = texts_in(*hints);
    exercise.scene = file_in(root.at("scene"), file);
    exercise.part = root.at("part").text();
    try {
        (void)shader_part_text(exercise.part, built_in);
    } catch (const GpuError& error) {
        root.at("part").fail(error.what());
    }
    exercise.start = part_in(root.at("start"), exercise);
    if (exercise.start.find("TODO") == std::string::npos)
        root.at("start").fail("the part has no TODO, which marks what is to be completed");
    if (const auto solution = root.find("solution"))
        exercise.solution = part_in(*solution, exercise);
    if (const auto reference = root.find("reference"))
        exercise.reference = file_in(*reference, file);
    if (exercise.solution && exercise.reference)
        root.at("reference").fail("contradicts 'solution': give one of them");
    if (const auto limit = root.find("max_flip"))
        exercise.max_flip = static_cast<double>(limit->number(0.0F, 1.0F));
    return exercise;
}

std::string file_of_part(const Exercise& exercise) {
    return shader_part_text(exercise.part, built_in).file;
}

/// Returns the texts in which a part of the exercise has this text.
ShaderTexts texts_with(const Exercise& exercise, const std::string& part, bool uses_folder) {
    return {{{file_of_part(exercise), with_shader_part("", exercise.part, part)}}, uses_folder};
}

/// An edit of a part that no program has would change nothing.
void require_part(const Exercise& exercise, const FramePlan& plan, const ShaderTexts& texts) {
    for (const ShaderListing& listing : shader_listings(plan, texts)) {
        if (std::find(listing.files.begin(), listing.files.end(), exercise.part) !=
            listing.files.end())
            return;
    }
    throw failure(exercise.file,
                  fmt::format("/part: no program of the scene has '{}'", exercise.part),
                  "--print-shaders lists the parts of each program");
}

Image read_solution(const Exercise& exercise, const Image& picture) {
    Image reference = read_image(*exercise.reference, ImageUse::color);
    if (reference.width == picture.width && reference.height == picture.height) return reference;
    throw failure(*exercise.reference,
                  fmt::format("has {} x {} pixels, but the picture has {} x {}", reference.width,
                              reference.height, picture.width, picture.height),
                  fmt::format("add --size {}x{}", reference.width, reference.height));
}

}  // namespace

Exercise read_exercise(const std::filesystem::path& file) {
    const std::string text = read_file(file);
    return about(file, [&] { return exercise_in(JsonCursor::parse(text), file); });
}

Attempt attempt_at(const Exercise& exercise) {
    if (!shader_part_text(exercise.part).is_built_in) return {};
    return {std::make_shared<const ShaderTexts>(texts_with(exercise, exercise.start, true))};
}

ShaderTexts solution_of(const Exercise& exercise) {
    return exercise.solution ? texts_with(exercise, *exercise.solution, false) : built_in;
}

void add_exercise_options(CLI::App& app, ViewOptions& options) {
    add_path(
        app, "--exercise", options.exercise_file,
        "Show the scene of an exercise (.json, docs/exercises.md) with its part of a shader as "
        "it is in $RELIEF_SHADER_DIR, else with a hole to fill, and measure the FLIP to the "
        "solution. With --strict, exit with 3 if the exercise is not solved. In the window, "
        "the part can be edited.")
        .group("Shaders");
}

void settle_exercise(ViewOptions& options) {
    if (!options.exercise_file) return;
    if (options.exercise) {  // The window settles its options again.
        if (options.model == options.exercise->scene) return;
        options.exercise.reset();
        options.exercise_file.reset();
        return;
    }
    refuse(!options.model.empty(), "--exercise",
           "has a scene of its own, not " + options.model.string(), "leave the model out");
    auto exercise = std::make_shared<const Exercise>(read_exercise(*options.exercise_file));
    options.model = exercise->scene;
    options.exercise = std::move(exercise);
}

ExerciseResult compare_with_solution(const Exercise& exercise, const FrameSettings& settings,
                                     const FramePlan& plan, const Scene& scene,
                                     const Camera& camera, const Context& context,
                                     const Image& picture) {
    FrameSettings solved = settings;
    solved.shaders = std::make_shared<const ShaderTexts>(solution_of(exercise));
    require_part(exercise, plan, *solved.shaders);
    Image solution;
    if (exercise.reference) {
        solution = read_solution(exercise, picture);
    } else {
        Report same;
        solution = Renderer(context, scene, plan, solved, same).draw(camera).image;
        if (scene.background.a == 1.0F) drop_alpha(solution);
    }
    ExerciseResult result;
    result.allowed = exercise.max_flip;
    static_cast<PictureComparison&>(result) = compare_pictures(solution, picture);
    return result;
}

void report_result(const ExerciseResult& result, Report& report) {
    if (result.is_solved()) return;
    report.add("exercise that is not solved", "exercise", 0,
               fmt::format("its FLIP is {:.3g}, and a solution has at most {:.3g}",
                           result.flip.mean, result.allowed));
}

std::string result_text(const ExerciseResult& result) {
    const std::string flip =
        fmt::format("FLIP {:.3g} (largest {:.3g})", result.flip.mean, result.flip.max);
    return result.is_solved()
               ? flip + ": solved"
               : flip + fmt::format(": not solved, a solution has at most {:.3g}", result.allowed);
}

void add_exercise(Summary& summary, const Exercise& exercise, const ExerciseResult& result) {
    const bool is_start = attempt_at(exercise).is_start();
    Json json = {{"file", exercise.file.string()}, {"title", exercise.title},
                 {"part", exercise.part},          {"from", is_start ? "start" : "folder"},
                 {"solved", result.is_solved()},   {"allowed", result.allowed}};
    json.update(numbers_json(result));
    summary.add("exercise",
                fmt::format("{}: {} {}", exercise.title, exercise.part,
                            is_start ? "with its hole" : "from $RELIEF_SHADER_DIR"),
                {{"exercise", std::move(json)}});
    summary.add("task", exercise.task);
    summary.add("result", result_text(result));
}

}  // namespace relief::tools
