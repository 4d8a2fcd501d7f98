// SPDX-License-Identifier: Apache-2.0
// Writes the index of a batch. Tests: tests/make/make_index_test.cpp.
#include "make_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
#include <tuple>
#include <utility>

#include "common/html.h"
#include "common/text.h"
#include "file_replacement.h"
#include "make_pictures.h"
#include "page_text.h"

namespace relief::tools {
namespace {

// The facts may be those of a file that was changed.

std::optional<double> fact_of(const IndexEntry& entry, const char* name) {
    if (!entry.facts.is_object()) return {};
    const auto fact = entry.facts.find(name);
    if (fact == entry.facts.end() || !fact->is_number()) return {};
    return fact->get<double>();
}

std::vector<std::string> findings_of(const IndexEntry& entry) {
    std::vector<std::string> findings;
    if (!entry.facts.is_object() || !entry.facts.contains("findings")) return findings;
    for (const Json& finding : entry.facts["findings"]) {
        if (finding.is_string()) findings.push_back(finding.get<std::string>());
    }
    return findings;
}

/// Draws assets, as long as that is possible.
class Thumbnails {
  public:
    /// Returns a picture, or a paragraph that says why there is none.
    std::string of(const std::filesystem::path& asset, const std::filesystem::path& folder) {
        const glm::ivec2 size(320, 240);
        try {
            if (!drawer_) drawer_ = std::make_unique<AssetDrawer>();
            return html_image(drawer_->draw(asset, size), "", "", folder);
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            return fmt::format("<p>It could not be drawn: {}</p>", html_escaped(error.what()));
        }
    }

  private:
    std::unique_ptr<AssetDrawer> drawer_;
};

std::string figures_html(const IndexEntry& entry) {
    std::vector<std::string> figures;
    const auto source = fact_of(entry, "source_triangles");
    const auto triangles = fact_of(entry, "triangles");
    if (source && triangles)
        figures.push_back(fmt::format("{:.0f} triangles of {:.0f}", *triangles, *source));
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(entry.job.output, error);
    if (!error) figures.push_back(byte_size(bytes));
    const auto flip = fact_of(entry, "flip");
    const auto degrees = fact_of(entry, "degrees");
    if (flip && degrees)
        figures.push_back(fmt::format("FLIP {:.4f}, {:.2f} degrees", *flip, *degrees));
    std::string html;
    for (const std::string& figure : figures)
        html += fmt::format("<p class=\"figures\">{}</p>\n", figure);
    return html;
}

std::string findings_html(const IndexEntry& entry) {
    const std::vector<std::string> findings = findings_of(entry);
    if (findings.empty()) return "";
    std::string list;
    for (const std::string& finding : findings)
        list += fmt::format("<li>{}</li>\n", html_escaped(finding));
    return fmt::format("<details><summary>{}</summary><ul>\n{}</ul></details>\n",
                       counted(findings.size(), "finding"), list);
}

std::string article(const IndexEntry& entry, Thumbnails& thumbnails,
                    const std::filesystem::path& folder) {
    if (!entry.error.empty()) {
        return fmt::format("<article class=\"failed\"><h2>{}</h2>\n<p>Failed: {}</p></article>\n",
                           html_escaped(entry.job.input.filename().string()),
                           html_escaped(entry.error));
    }
    return fmt::format("<article>{}\n<h2>{}</h2>\n{}{}</article>\n",
                       thumbnails.of(entry.job.output, folder),
                       html_escaped(entry.job.output.filename().string()), figures_html(entry),
                       findings_html(entry));
}

}  // namespace

Json index_facts(const MadeAsset& made) {
    Json facts = {{"source_triangles", made.source.triangles},
                  {"triangles", made.asset.mesh.triangles.size()},
                  {"flip", nullptr},
                  {"degrees", nullptr},
                  {"findings", json_list(made.findings.all(), [](const PlacedFinding& finding) {
                       return Json(to_string(finding));
                   })}};
    if (made.loss) {
        facts["flip"] = made.loss->fidelity.max_picture_mean();
        facts["degrees"] = made.loss->fidelity.normals.mean;
    }
    return facts;
}

void sort_worst_first(std::vector<IndexEntry>& entries) {
    std::ranges::stable_sort(entries, std::ranges::greater{}, [](const IndexEntry& entry) {
        return std::tuple(!entry.error.empty(), fact_of(entry, "flip").value_or(-1.0),
                          findings_of(entry).size());
    });
}

void write_make_index(const std::filesystem::path& file, const std::string& name,
                      std::vector<IndexEntry> entries) {
    sort_worst_first(entries);
    const auto failed = static_cast<std::size_t>(std::ranges::count_if(
        entries, [](const IndexEntry& entry) { return !entry.error.empty(); }));
    Thumbnails thumbnails;
    std::string assets;
    for (const IndexEntry& entry : entries)
        assets += article(entry, thumbnails, file.parent_path());
    const std::string page = filled_page(
        "index.html",
        {{"name", html_escaped(name)},
         {"style", std::string(page_part("make.css"))},
         {"figures", counted(entries.size(), "model") +
                         (failed == 0 ? "." : fmt::format(", of which {} failed.", failed))},
         {"assets", assets},
         {"version", html_escaped("relief " + version() + ".")}});
    relief::detail::replace_file(file, std::as_bytes(std::span(page)));
}

}  // namespace relief::tools
