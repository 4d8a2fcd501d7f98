// SPDX-License-Identifier: Apache-2.0
#include "tools/schema_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "support/shared_data.h"

namespace relief::test {
namespace {

using nlohmann::json;

bool is_of_kind(const json& value, const std::string& kind) {
    const auto allows = [&](const char* word) { return kind.find(word) != std::string::npos; };
    if (value.is_null()) return allows("null");
    if (value.is_string()) return allows("string");
    if (value.is_boolean()) return allows("boolean");
    const bool is_whole = value.is_number_integer() && value >= 0;
    return value.is_number() && allows("number") && (is_whole || !allows("whole number"));
}

/// Walks a document and records its values.
class Walk {
  public:
    explicit Walk(const std::vector<SchemaRow>& rows) : rows_(rows) {}

    void visit(const json& value, const std::string& place) {
        if (value.is_array()) {
            for (const json& element : value)
                visit(element, place + "[]");
        } else if (value.is_object()) {
            require_members(value, place);
            for (const auto& [key, member] : value.items())
                visit(member, place.empty() ? key : place + "." + key);
        } else {
            visit_leaf(value, place);
        }
    }

    [[nodiscard]] std::vector<std::string> faults(bool is_complete) const {
        std::vector<std::string> all(faults_.begin(), faults_.end());
        for (const SchemaRow& row : rows_) {
            if (is_complete && !seen_.contains(row.place))
                all.push_back(row.place + ": never occurs");
        }
        return all;
    }

  private:
    void visit_leaf(const json& value, const std::string& place) {
        const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const SchemaRow& one) {
            const std::size_t any = one.place.find(".*");
            return one.place == place ||
                   (any != std::string::npos && place.starts_with(one.place.substr(0, any + 1)));
        });
        if (row != rows_.end()) {
            seen_.insert(row->place);
            if (!is_of_kind(value, row->kind))
                faults_.insert(
                    fmt::format("{}: is a {}, not {}", place, value.type_name(), row->kind));
            return;
        }
        const bool is_absent_object =
            value.is_null() && std::any_of(rows_.begin(), rows_.end(), [&](const SchemaRow& one) {
                return one.place.starts_with(place + ".");
            });
        if (!is_absent_object) faults_.insert(place + ": is not documented");
    }

    /// Returns the required rows below `place`.
    void require_members(const json& object, const std::string& place) {
        const std::string begin = place.empty() ? "" : place + ".";
        for (const SchemaRow& row : rows_) {
            if (!row.place.starts_with(begin) || row.kind.find("optional") != std::string::npos)
                continue;
            std::string key = row.place.substr(begin.size());
            key = key.substr(0, key.find_first_of(".["));
            if (key != "*" && !object.contains(key)) faults_.insert(begin + key + ": is missing");
        }
    }

    const std::vector<SchemaRow>& rows_;
    std::set<std::string> seen_;
    std::set<std::string> faults_;
};

}  // namespace

std::vector<SchemaRow> schema_rows(const std::string& heading) {
    std::ifstream page(source_directory() / "docs/accuracy-schema.md");
    std::vector<SchemaRow> rows;
    bool is_there = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("## ")) is_there = line == heading;
        if (!is_there || !line.starts_with("| `")) continue;
        const std::size_t end = line.find('`', 3);
        const std::size_t kind = line.find("| ", end) + 2;
        rows.push_back({line.substr(3, end - 3), line.substr(kind, line.find(" |", kind) - kind)});
    }
    return rows;
}

std::vector<std::string> schema_faults(const json& document, const std::vector<SchemaRow>& rows,
                                       bool is_complete) {
    Walk walk(rows);
    walk.visit(document, "");
    return walk.faults(is_complete);
}

}  // namespace relief::test
