// SPDX-License-Identifier: Apache-2.0
// Tests: tests/check/relief_check_test.cpp.
#include "check_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "check_files.h"
#include "common/file_jobs.h"
#include "common/summary.h"
#include "parallel.h"
#include "relief/mesh/limits.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// Returns a text of the limits that change the findings of a file.
std::string limits_key() {
    const InputLimits limits = input_limits();
    return fmt::format("{} {} {}", limits.outside_files, limits.memory, limits.pixels);
}

std::string key_of(const Json& json) {
    return limits_key() + " " + json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// An image with its uses.
struct ImageTask {
    fs::path file;
    std::vector<ImageRole> roles;
    std::vector<std::size_t> items;  ///< Several for links to one file.
};

/// Returns the images of folders and models, each once. Images of other folders get an item.
std::vector<ImageTask> image_tasks(const std::vector<CheckInput>& inputs,
                                   std::vector<CheckedItem>& items) {
    std::map<fs::path, ImageTask> tasks;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (inputs[i].kind != CheckedKind::image) continue;
        ImageTask& task = tasks[identity_of(inputs[i].file)];
        if (task.file.empty()) task.file = inputs[i].file;
        task.items.push_back(i);
    }
    for (const CheckedItem& item : items) {
        for (const UsedImage& image : item.images) {
            ImageTask& task = tasks[identity_of(image.file)];
            if (task.file.empty()) task.file = image.file;
            task.roles.push_back(image.role);
        }
    }
    std::vector<ImageTask> list;
    for (auto& [identity, task] : tasks) {
        std::ranges::sort(task.roles);
        task.roles.erase(std::unique(task.roles.begin(), task.roles.end()), task.roles.end());
        if (task.items.empty()) {
            task.items.push_back(items.size());
            items.emplace_back().file = task.file;
        }
        list.push_back(std::move(task));
    }
    return list;
}

template <typename Work>
CheckedItem cached(std::optional<CheckCache>& cache, const fs::path& file, const std::string& key,
                   const Work& work) {
    if (!cache) return work();
    auto found = cache->find(file, key);
    CheckedItem item = found ? *std::move(found) : work();
    cache->add(item, key);
    return item;
}

}  // namespace

void run_stage(Stages& stages, const std::string& name, std::size_t count,
               const std::function<void(std::size_t)>& work) {
    stages.run(name, [&] {
        relief::detail::parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                work(i);
        });
    });
}

std::vector<CheckedItem> check_all(const std::vector<CheckInput>& inputs, const CheckSource& source,
                                   Stages& stages) {
    std::vector<CheckedItem> items(inputs.size());
    std::vector<std::size_t> models;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (inputs[i].kind == CheckedKind::model) models.push_back(i);
    }
    run_stage(stages, "models", models.size(),
              [&](std::size_t i) { items[models[i]] = source.model(inputs[models[i]]); });
    const std::vector<ImageTask> images = image_tasks(inputs, items);
    run_stage(stages, "images", images.size(), [&](std::size_t i) {
        const CheckedItem item = source.image(images[i].file, images[i].roles);
        for (const std::size_t each : images[i].items) {
            items[each] = item;
            if (each < inputs.size()) items[each].file = inputs[each].file;
        }
    });
    return items;
}

CheckSource reading_source(std::optional<CheckCache>& cache) {
    CheckSource source;
    source.model = [&cache](const CheckInput& input) {
        const Json paired = json_list(
            input.paired, [](const UsedImage& image) { return Json(image.file.string()); });
        return cached(cache, input.file, key_of(paired), [&] { return check_model_file(input); });
    };
    source.image = [&cache](const fs::path& file, const std::vector<ImageRole>& roles) {
        const Json uses = json_list(roles, [](const ImageRole& role) -> Json {
            return {static_cast<int>(role.slot), role.is_gltf, role.material, role.materials};
        });
        return cached(cache, file, key_of(uses), [&] { return check_image_file(file, roles); });
    };
    return source;
}

}  // namespace relief::tools
