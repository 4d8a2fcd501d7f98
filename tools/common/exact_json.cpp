// SPDX-License-Identifier: Apache-2.0
#include "common/exact_json.h"

#include <cmath>
#include <limits>

#include "files.h"

namespace relief::tools {

using relief::detail::JsonCursor;

Json number_json(double number) {
    if (std::isfinite(number)) return number;
    return std::isnan(number) ? "nan" : number > 0.0 ? "inf" : "-inf";
}

namespace {

double number_named(const std::string& name) {
    if (name == "inf") return std::numeric_limits<double>::infinity();
    if (name == "-inf") return -std::numeric_limits<double>::infinity();
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double number_in(const JsonCursor& json) {
    return json.is_text() ? number_named(json.text()) : json.double_number();
}

double number_in(const Json& json) {
    return json.is_string() ? number_named(json.get<std::string>()) : json.get<double>();
}

Json text_json(const std::string& text) {
    if (relief::detail::is_utf8(text)) return text;
    Json bytes = Json::array();
    for (const char byte : text)
        bytes.push_back(static_cast<unsigned char>(byte));
    return bytes;
}

std::string text_in(const JsonCursor& json) {
    if (json.is_text()) return json.text();
    std::string text;
    for (const JsonCursor& byte : json.elements())
        text.push_back(static_cast<char>(byte.whole_number(0, 255)));
    return text;
}

std::string text_in(const Json& json) {
    if (json.is_string()) return json.get<std::string>();
    std::string text;
    for (const Json& byte : json)
        text.push_back(static_cast<char>(byte.get<int>()));
    return text;
}

Json texts_json(const std::vector<std::string>& texts) {
    Json json = Json::array();
    for (const std::string& text : texts)
        json.push_back(text_json(text));
    return json;
}

std::vector<std::string> texts_in(const JsonCursor& json) {
    std::vector<std::string> texts;
    for (const JsonCursor& text : json.elements())
        texts.push_back(text_in(text));
    return texts;
}

}  // namespace relief::tools
