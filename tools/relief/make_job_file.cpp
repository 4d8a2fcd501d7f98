// SPDX-License-Identifier: Apache-2.0
// Tests: tests/make/make_job_file_test.cpp.
#include "make_job_file.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "common/text.h"
#include "files.h"
#include "make_options.h"

namespace relief::tools {
namespace {

/// Iterates over the characters of a text and shares its position.
class CountingIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, const char** reached) : at_(at), reached_(reached) {}

    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        *reached_ = ++at_;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator before = *this;
        ++*this;
        return before;
    }
    friend bool operator==(const CountingIterator& a, const CountingIterator& b) {
        return a.at_ == b.at_;
    }
    friend bool operator!=(const CountingIterator& a, const CountingIterator& b) {
        return !(a == b);
    }

  private:
    const char* at_;
    const char** reached_;
};

/// Collects the lines of all keys by their paths, "assets[2].triangles", and the first repeated
/// key.
class KeyLines : public nlohmann::json_sax<Json> {
  public:
    KeyLines(const std::string& text, const char** reached)
        : counted_(text.data()), reached_(reached) {}

    [[nodiscard]] std::size_t line_of(const std::string& path) const {
        const auto found = lines_.find(path);
        return found == lines_.end() ? 1 : found->second;
    }

    std::string repeated;
    std::string syntax_error;

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(number_integer_t) override { return value(); }
    bool number_unsigned(number_unsigned_t) override { return value(); }
    bool number_float(number_float_t, const string_t&) override { return value(); }
    bool string(string_t&) override { return value(); }
    bool binary(binary_t&) override { return value(); }
    bool start_object(std::size_t) override { return open(false); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(true); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        levels_.back().key = name;
        if (!note() && repeated.empty()) repeated = path();
        return true;
    }
    bool parse_error(std::size_t, const std::string&,
                     const nlohmann::detail::exception& error) override {
        syntax_error = error.what();
        return false;
    }

  private:
    /// An object or a list that is open.
    struct Level {
        bool is_list = false;
        std::size_t index = 0;
        std::string key;
    };

    [[nodiscard]] std::string path() const {
        std::string result;
        for (const Level& level : levels_) {
            if (level.is_list)
                result += fmt::format("[{}]", level.index);
            else
                result += (result.empty() ? "" : ".") + level.key;
        }
        return result;
    }
    bool note() {
        line_ += static_cast<std::size_t>(std::count(counted_, *reached_, '\n'));
        counted_ = *reached_;
        return lines_.try_emplace(path(), line_).second;
    }
    bool value() {
        if (!levels_.empty() && levels_.back().is_list) ++levels_.back().index;
        return true;
    }
    bool open(bool is_list) {
        if (!levels_.empty() && levels_.back().is_list) note();
        levels_.push_back({is_list, 0, ""});
        return true;
    }
    bool close() {
        levels_.pop_back();
        return value();
    }

    std::size_t line_ = 1;
    const char* counted_;  ///< The line ends before it are counted.
    const char** reached_;
    std::vector<Level> levels_;
    std::map<std::string, std::size_t> lines_;
};

/// A job file with the lines of its keys.
class JobFile {
  public:
    explicit JobFile(const std::filesystem::path& file);

    [[nodiscard]] std::vector<MakeTask> tasks() const;

  private:
    /// \param path  "assets[2].triangles"
    [[nodiscard]] FileError fault(const std::string& path, const std::string& problem) const;
    [[nodiscard]] const Json& member(const char* name, bool (Json::*is_kind)() const noexcept,
                                     const char* kind) const;
    [[nodiscard]] MakeTask task(const Json& asset, const std::string& path,
                                const Json& defaults) const;
    [[nodiscard]] std::vector<std::string> arguments(const CLI::App& app, const MakeOption& option,
                                                     const Json& value,
                                                     const std::string& path) const;
    [[nodiscard]] std::string path_of(const Json& asset, const char* name,
                                      const std::string& path) const;
    void check_keys(const Json& object, const std::string& path,
                    const std::vector<std::string>& known) const;

    std::filesystem::path file_;
    std::string text_;
    const char* reached_ = nullptr;
    KeyLines lines_;
    Json json_;
};

JobFile::JobFile(const std::filesystem::path& file)
    : file_(file),
      text_(relief::detail::read_file(file)),
      reached_(text_.data()),
      lines_(text_, &reached_) {
    const char* end = text_.data() + text_.size();
    if (!Json::sax_parse(CountingIterator(text_.data(), &reached_),
                         CountingIterator(end, &reached_), &lines_))
        throw FileError(file_, lines_.syntax_error);
    if (!lines_.repeated.empty()) throw fault(lines_.repeated, "the key is repeated");
    json_ = Json::parse(text_);
    if (!json_.is_object()) throw FileError(file_, "is not a JSON object");
}

FileError JobFile::fault(const std::string& path, const std::string& problem) const {
    return FileError(file_, fmt::format("line {}: {}: {}", lines_.line_of(path), path, problem));
}

void JobFile::check_keys(const Json& object, const std::string& path,
                         const std::vector<std::string>& known) const {
    for (const auto& [key, value] : object.items()) {
        if (std::ranges::find(known, key) == known.end()) {
            throw fault(path.empty() ? key : path + "." + key,
                        fmt::format("unknown key (not one of {})", fmt::join(known, ", ")));
        }
    }
}

const Json& JobFile::member(const char* name, bool (Json::*is_kind)() const noexcept,
                            const char* kind) const {
    const auto found = json_.find(name);
    if (found == json_.end()) throw FileError(file_, fmt::format("has no \"{}\"", name));
    if (!(*found.*is_kind)()) throw fault(name, fmt::format("is not {}", kind));
    return *found;
}

/// Returns the arguments of the command line for a key; none if a switch is off.
std::vector<std::string> JobFile::arguments(const CLI::App& app, const MakeOption& option,
                                            const Json& value, const std::string& path) const {
    const std::string name = fmt::format("--{}", option.name);
    if (app.get_option(name)->get_items_expected_max() == 0) {
        if (!value.is_boolean()) throw fault(path, "is neither true nor false");
        return value.get<bool>() ? std::vector<std::string>{name} : std::vector<std::string>{};
    }
    const bool is_list = value.is_array() && option.values != OptionValues::one;
    const std::vector<Json> values =
        is_list ? value.get<std::vector<Json>>() : std::vector<Json>(1, value);
    std::vector<std::string> result;
    for (const Json& one : values) {
        if (!one.is_string() && !one.is_number()) throw fault(path, "is neither text nor a number");
        std::string text = one.is_string() ? one.get<std::string>() : one.dump();
        if (option.values == OptionValues::files)
            text = (file_.parent_path() / text).lexically_normal().string();
        result.push_back(fmt::format("{}={}", name, text));
    }
    return result;
}

std::string JobFile::path_of(const Json& asset, const char* name, const std::string& path) const {
    const Json& value = asset[name];
    if (!value.is_string() || value.get<std::string>().empty())
        throw fault(path + "." + name, "is not the name of a file");
    return value.get<std::string>();
}

MakeTask JobFile::task(const Json& asset, const std::string& path, const Json& defaults) const {
    MakeTask result;
    CLI::App app;
    add_asset_options(app, result.request);
    const auto parse = [&](const std::string& place, std::vector<std::string> arguments) {
        try {
            app.clear();
            app.parse(std::move(arguments));
        } catch (const UsageError& error) {
            throw fault(place, error.what());
        } catch (const CLI::ParseError& error) {
            throw fault(place, error.what());
        }
    };
    std::vector<std::string> keys;
    for (const MakeOption& option : make_options())
        keys.emplace_back(option.name);
    check_keys(defaults, "defaults", keys);
    std::vector<std::string> known = {"input", "output"};
    known.insert(known.end(), keys.begin(), keys.end());
    check_keys(asset, path, known);
    if (!asset.contains("input")) throw fault(path, "has no \"input\"");
    const std::filesystem::path folder = file_.parent_path();
    result.job.input = (folder / path_of(asset, "input", path)).lexically_normal();
    const std::filesystem::path outputs =
        json_.contains("output") ? folder / member("output", &Json::is_string, "text") : folder;
    result.job.output = outputs / result.job.input.filename().replace_extension(".glb");
    if (asset.contains("output")) result.job.output = outputs / path_of(asset, "output", path);
    result.job.output = result.job.output.lexically_normal();
    std::vector<std::string> all;
    for (const MakeOption& option : make_options()) {
        const std::string key(option.name);
        const bool is_given = asset.contains(key);
        if (!is_given && !defaults.contains(key)) continue;
        const std::string place = (is_given ? path : "defaults") + "." + key;
        const std::vector<std::string> given =
            arguments(app, option, (is_given ? asset : defaults)[key], place);
        for (const std::string& argument : given)
            parse(place, {argument});
        all.insert(all.end(), given.begin(), given.end());
    }
    // All together, for options that contradict each other.
    result.request = {};
    std::ranges::reverse(all);  // CLI11 takes the last one first.
    parse(path, all);
    try {
        check_asset_options(app, result.request);
    } catch (const UsageError& error) {
        throw fault(path, error.what());
    }
    return result;
}

std::vector<MakeTask> JobFile::tasks() const {
    check_keys(json_, "", {"output", "defaults", "assets"});
    const Json& assets = member("assets", &Json::is_array, "a list");
    if (assets.empty()) throw fault("assets", "is empty");
    const Json defaults = json_.contains("defaults")
                              ? member("defaults", &Json::is_object, "an object")
                              : Json::object();
    std::vector<MakeTask> result;
    for (std::size_t i = 0; i < assets.size(); ++i) {
        const std::string path = fmt::format("assets[{}]", i);
        if (!assets[i].is_object()) throw fault(path, "is not an object");
        result.push_back(task(assets[i], path, defaults));
    }
    return result;
}

}  // namespace

std::vector<MakeTask> read_job_file(const std::filesystem::path& file) {
    return JobFile(file).tasks();
}

}  // namespace relief::tools
