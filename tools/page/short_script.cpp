// SPDX-License-Identifier: Apache-2.0
// A script is a list of tokens. Its pieces are top-level statements and members of classes; names
// that a piece declares are local to it.
#include "short_script.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <vector>

namespace relief::tools {

namespace {

// Tokens

enum class TokenKind { word, number, mark, text };

/// A word, a number, a character, or the text of a string, regular expression or template. A
/// template is split around its values: "`...${", "}...${" and "}...`".
struct Token {
    TokenKind kind = TokenKind::mark;
    std::string text;
    bool after_space = false;

    [[nodiscard]] bool is(std::string_view t) const { return kind != TokenKind::text && text == t; }
    /// Begins a bracket, or the value of a template.
    [[nodiscard]] bool opens() const {
        return kind == TokenKind::text ? text.ends_with("${")
                                       : text == "(" || text == "[" || text == "{";
    }
    [[nodiscard]] bool closes() const {
        return kind == TokenKind::text ? text.front() == '}'
                                       : text == ")" || text == "]" || text == "}";
    }
};

using Tokens = std::vector<Token>;

bool is_name_character(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

class Reader {
  public:
    explicit Reader(std::string_view script) : script_(script) {}

    Tokens tokens() {
        while (at_ < script_.size()) {
            const char c = script_[at_];
            if (c == ' ' || c == '\t' || c == '\n') {
                after_space_ = true;
                ++at_;
            } else if (script_.substr(at_).starts_with("//")) {
                at_ = std::min(script_.find('\n', at_), script_.size());
            } else if (script_.substr(at_).starts_with("/*")) {
                at_ = std::min(script_.find("*/", at_), script_.size() - 2) + 2;
            } else if (c == '"' || c == '\'' || c == '`') {
                add_text(c);
            } else if (c == '}' && !braces_.empty() && braces_.back() == 0) {
                braces_.pop_back();
                add_text('`');
            } else if (c == '/' && begins_pattern()) {
                add_text('/');
            } else if (is_name_character(c)) {
                add_word();
            } else {
                if (!braces_.empty()) braces_.back() += (c == '{') - (c == '}');
                add(TokenKind::mark, at_ + 1);
            }
        }
        return std::move(tokens_);
    }

  private:
    void add(TokenKind kind, std::size_t end) {
        tokens_.push_back({kind, std::string(script_.substr(at_, end - at_)), after_space_});
        after_space_ = false;
        at_ = end;
    }

    /// A slash after an operator, an opening bracket or `return` begins a regular expression.
    [[nodiscard]] bool begins_pattern() const {
        if (tokens_.empty()) return true;
        const Token& last = tokens_.back();
        return last.is("return") || (last.kind == TokenKind::mark && !last.closes());
    }

    /// Adds the text up to the end of a string, of a regular expression, or of a part of a
    /// template.
    void add_text(char quote) {
        bool is_class = false;  // In a regular expression.
        std::size_t end = at_ + 1;
        for (; end < script_.size(); ++end) {
            const char c = script_[end];
            if (c == '\\') {
                ++end;
            } else if (quote == '`' && c == '$' && script_.substr(end).starts_with("${")) {
                braces_.push_back(0);
                ++end;
                break;
            } else if (quote == '/' && (c == '[' || c == ']')) {
                is_class = c == '[';
            } else if (c == quote && !is_class) {
                break;
            }
        }
        ++end;
        while (quote == '/' && end < script_.size() && is_name_character(script_[end]))
            ++end;
        add(TokenKind::text, std::min(end, script_.size()));
    }

    void add_word() {
        const bool is_number = std::isdigit(static_cast<unsigned char>(script_[at_])) != 0;
        std::size_t end = at_;
        while (end < script_.size() &&
               (is_name_character(script_[end]) || (is_number && script_[end] == '.')))
            ++end;
        add(is_number ? TokenKind::number : TokenKind::word, end);
    }

    std::string_view script_;
    std::size_t at_ = 0;
    bool after_space_ = false;
    std::vector<int> braces_;  ///< Open braces in each value of a template.
    Tokens tokens_;
};

/// Returns the place of the bracket that closes the one at a place, or the end.
std::size_t closing(std::span<const Token> tokens, std::size_t open) {
    int depth = 0;
    for (std::size_t i = open; i < tokens.size(); ++i) {
        depth += static_cast<int>(tokens[i].opens()) - static_cast<int>(tokens[i].closes());
        if (depth == 0) return i;
    }
    return tokens.size();
}

// Pieces

/// Returns the ends of the top-level statements and of the members of classes.
std::vector<std::size_t> piece_ends(std::span<const Token> tokens) {
    std::vector<std::size_t> ends;
    const auto begins_function = [&] {
        const Token& first = tokens[ends.empty() ? 0 : ends.back()];
        return first.is("function") || first.is("async") || first.is("for") || first.is("if");
    };
    int depth = 0;
    int base = 0;  // 1 between the braces of a class.
    bool is_class = false;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const Token& token = tokens[i];
        is_class |= depth == 0 && token.is("class");
        depth += static_cast<int>(token.opens()) - static_cast<int>(token.closes());
        if (is_class && token.is("{")) {
            is_class = false;
            base = 1;
            ends.push_back(i + 1);
        } else if (base == 1 && depth == 0) {
            base = 0;
            ends.push_back(i + 1);
        } else if (depth == base &&
                   (token.is(";") || (token.is("}") && (base == 1 || begins_function())))) {
            ends.push_back(i + 1);
        }
    }
    if (ends.empty() || ends.back() != tokens.size()) ends.push_back(tokens.size());
    return ends;
}

// Names

constexpr std::array keywords = {
    "arguments", "async",   "await",     "break",      "case",   "catch", "class", "const",
    "continue",  "default", "delete",    "do",         "else",   "false", "for",   "function",
    "get",       "if",      "in",        "instanceof", "let",    "new",   "null",  "of",
    "return",    "set",     "static",    "super",      "switch", "this",  "throw", "true",
    "try",       "typeof",  "undefined", "while",      "yield"};

bool is_keyword(std::string_view word) {
    return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

/// The names in a piece.
class Piece {
  public:
    explicit Piece(std::span<Token> tokens) : tokens_(tokens) {
        for (std::size_t i = 0; i < tokens.size(); ++i) {
            const Token& token = tokens_[i];
            if (token.closes() && !open_.empty()) {
                open_.pop_back();
                choices_.pop_back();
            }
            if (token.opens()) {
                add_pattern(i);
                open_.push_back(i);
                choices_.push_back(0);
            }
            if (token.is("?") && !is(i - 1, "?") && !is(i + 1, "?") && !is(i + 1, "."))
                ++choices_.back();
            if (token.is(":") && choices_.back() > 0) --choices_.back();
            if (token.kind == TokenKind::word) add_word(i);
        }
    }

    [[nodiscard]] const std::set<std::string>& declared() const { return declared_; }
    /// Names that must stay in this piece.
    [[nodiscard]] const std::set<std::string>& kept() const { return kept_; }

    /// Returns how often each name is used, properties left out.
    [[nodiscard]] std::map<std::string, int> uses() const {
        std::map<std::string, int> uses;
        for (std::size_t i = 0; i < tokens_.size(); ++i)
            if (tokens_[i].kind == TokenKind::word && !is_property(i)) ++uses[tokens_[i].text];
        return uses;
    }

    void rename(const std::map<std::string, std::string>& names) {
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            if (tokens_[i].kind != TokenKind::word || is_property(i)) continue;
            if (const auto name = names.find(tokens_[i].text); name != names.end())
                tokens_[i].text = name->second;
        }
    }

  private:
    [[nodiscard]] bool is(std::size_t i, std::string_view text) const {
        return i < tokens_.size() && tokens_[i].is(text);
    }

    /// A property follows a dot, but not three of them, or is a key before a colon.
    [[nodiscard]] bool is_property(std::size_t i) const {
        return (is(i - 1, ".") && !is(i - 2, ".")) || keys_.contains(i);
    }

    /// Declares the parameters in parentheses, or the variables of an array.
    void add_pattern(std::size_t begin) {
        const std::size_t end = closing(tokens_, begin);
        const bool is_parameters =
            is(begin, "(") && ((is(end + 1, "=") && is(end + 2, ">")) || is_method(begin, end));
        const bool is_array = is(begin, "[") && (is(begin - 1, "const") || is(begin - 1, "let")) &&
                              (is(end + 1, "=") || is(end + 1, "of"));
        if (!is_parameters && !is_array) return;
        int others = 0;  // Brackets other than those of arrays.
        for (std::size_t i = begin + 1; i < end; ++i) {
            const bool is_list = is(i, "[") || is(i, "]");
            if (!is_list)
                others +=
                    static_cast<int>(tokens_[i].opens()) - static_cast<int>(tokens_[i].closes());
            const bool begins =
                i == begin + 1 || is(i - 1, ",") || is(i - 1, "[") || is(i - 1, ".");
            const bool ends = i + 1 == end || is(i + 1, ",") || is(i + 1, "]") || is(i + 1, "=");
            if (others == 0 && tokens_[i].kind == TokenKind::word && begins && ends)
                declared_.insert(tokens_[i].text);
        }
    }

    /// Tells whether parentheses are those of a function or method with a body.
    [[nodiscard]] bool is_method(std::size_t begin, std::size_t end) const {
        return is(end + 1, "{") && begin > 0 && tokens_[begin - 1].kind == TokenKind::word &&
               !is_keyword(tokens_[begin - 1].text);
    }

    void add_word(std::size_t i) {
        const std::string& word = tokens_[i].text;
        if (is_keyword(word)) kept_.insert(word);
        if (is(i - 1, "const") || is(i - 1, "let") || is(i - 1, "function") || is(i - 1, "class"))
            declared_.insert(word);
        const bool is_assigned = is(i + 1, "=") && !is(i + 2, "=") && !is(i + 2, ">");
        if (is_assigned && is(i - 1, ",") && is_further_variable(i)) {
            declared_.insert(word);
            return;
        }
        const bool is_method_name = is(i + 1, "(") && !is(i - 1, "function") && !is(i - 1, "*") &&
                                    is_method(i + 1, closing(tokens_, i + 1));
        const bool is_in_braces = !open_.empty() && is(open_.back(), "{");
        if (is(i + 1, ":") && choices_.back() == 0) keys_.insert(i);
        const bool is_short_key = is_in_braces && (is(i - 1, "{") || is(i - 1, ",")) &&
                                  (is(i + 1, ",") || is(i + 1, "}") || is_assigned);
        if (!is_property(i) && (is_short_key || is_method_name)) kept_.insert(word);
    }

    /// Tells whether a word after a comma is declared as in `const a = 1, b = 2`.
    [[nodiscard]] bool is_further_variable(std::size_t i) const {
        int depth = 0;
        while (i-- > 0) {
            depth += static_cast<int>(tokens_[i].closes()) - static_cast<int>(tokens_[i].opens());
            if (depth < 0 || (depth == 0 && is(i, ";"))) return false;
            if (depth == 0 && (is(i, "const") || is(i, "let"))) return true;
        }
        return false;
    }

    std::span<Token> tokens_;
    std::vector<std::size_t> open_;
    std::vector<int> choices_{0};  ///< Question marks without a colon, in each open bracket.
    std::set<std::size_t> keys_;   ///< The places of keys.
    std::set<std::string> declared_;
    std::set<std::string> kept_;
};

constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

/// Gives names in the order of their use, except for those that are taken.
class NewNames {
  public:
    /// \param first  the characters that names begin with
    NewNames(std::string_view first, std::size_t length, const std::set<std::string>& taken) {
        for (const char a : first) {
            if (length == 1) add(std::string(1, a), taken);
            for (std::size_t i = 0; length == 2 && i < letters.size(); ++i)
                add({a, letters[i]}, taken);
        }
    }

    /// Returns new names, for the most used first.
    std::map<std::string, std::string> of(const std::map<std::string, int>& uses) const {
        std::vector<std::pair<int, std::string>> order;
        for (const auto& [name, count] : uses)
            order.emplace_back(-count, name);
        std::sort(order.begin(), order.end());
        std::map<std::string, std::string> names;
        for (std::size_t i = 0; i < std::min(order.size(), free_.size()); ++i)
            names[order[i].second] = free_[i];
        return names;
    }

  private:
    void add(std::string name, const std::set<std::string>& taken) {
        if (!taken.contains(name)) free_.push_back(std::move(name));
    }

    std::vector<std::string> free_;
};

/// The names that a top-level statement declares for all pieces: its function, class or variables.
std::set<std::string> top_names(std::span<const Token> piece) {
    std::set<std::string> names;
    const auto is = [&](std::size_t i, std::string_view text) {
        return i < piece.size() && piece[i].is(text);
    };
    const std::size_t first = is(0, "async") ? 1 : 0;
    if (is(first, "function") || is(first, "class"))
        names.insert(piece[first + (is(first + 1, "*") ? 2 : 1)].text);
    int depth = 0;
    bool is_pattern = true;
    for (std::size_t i = 1; i < piece.size() && (is(0, "const") || is(0, "let")); ++i) {
        depth += static_cast<int>(piece[i].opens()) - static_cast<int>(piece[i].closes());
        if (depth == 0 && (is(i, "=") || is(i, ","))) is_pattern = is(i, ",");
        if (is_pattern && piece[i].kind == TokenKind::word) names.insert(piece[i].text);
    }
    return names;
}

void shorten_names(Tokens& tokens) {
    std::vector<std::span<Token>> spans;
    std::size_t begin = 0;
    for (const std::size_t end : piece_ends(tokens)) {
        spans.push_back(std::span(tokens).subspan(begin, end - begin));
        begin = end;
    }
    std::vector<Piece> pieces(spans.begin(), spans.end());
    std::set<std::string> tops;
    std::set<std::string> kept;
    std::map<std::string, int> uses;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        tops.merge(top_names(spans[i]));
        kept.insert(pieces[i].kept().begin(), pieces[i].kept().end());
        for (const auto& [name, count] : pieces[i].uses())
            uses[name] += count;
    }
    std::set<std::string> words;
    std::map<std::string, int> tops_used;
    for (const auto& [name, count] : uses) {
        words.insert(name);
        if (tops.contains(name) && !kept.contains(name) && name.size() > 2) tops_used[name] = count;
    }
    const std::map<std::string, std::string> short_tops =
        NewNames("ABCDEFGHIJKLMNOPQRSTUVWXYZ", 2, words).of(tops_used);
    for (Piece& piece : pieces) {
        std::map<std::string, int> local;
        std::set<std::string> others;
        for (const auto& [name, count] : piece.uses()) {
            if (piece.declared().contains(name) && !piece.kept().contains(name) &&
                !tops.contains(name)) {
                local[name] = count;
            } else {
                others.insert(name);
            }
        }
        std::map<std::string, std::string> names = NewNames(letters, 1, others).of(local);
        names.insert(short_tops.begin(), short_tops.end());
        piece.rename(names);
    }
}

void replace_constants(Tokens& tokens, std::span<const ScriptConstant> constants) {
    Tokens result;
    for (Token& token : tokens) {
        const std::size_t count = result.size();
        const bool is_constant = count >= 2 && result[count - 1].is(".") &&
                                 result[count - 2].is("gl") &&
                                 !(count >= 3 && result[count - 3].is("."));
        const auto known = std::find_if(constants.begin(), constants.end(),
                                        [&](const auto& each) { return token.is(each.name); });
        if (!is_constant || known == constants.end()) {
            result.push_back(std::move(token));
            continue;
        }
        result.pop_back();
        result.back() = {TokenKind::number, std::to_string(known->value),
                         result.back().after_space};
    }
    tokens = std::move(result);
}

}  // namespace

std::string short_script(std::string_view script, std::span<const ScriptConstant> constants) {
    Tokens tokens = Reader(script).tokens();
    replace_constants(tokens, constants);
    shorten_names(tokens);
    std::string result;
    for (const Token& token : tokens) {
        const char last = result.empty() ? ' ' : result.back();
        const char first = token.text.front();
        const bool joins = is_name_character(last) && is_name_character(first);
        const bool is_sign = last == first && (first == '+' || first == '-') && token.after_space;
        if (joins || is_sign) result += ' ';
        result += token.text;
    }
    return result;
}

std::string short_style(std::string_view style) {
    static constexpr std::string_view separators = "{};,:>";
    std::string result;
    bool after_space = false;
    for (std::size_t i = 0; i < style.size(); ++i) {
        if (style.substr(i).starts_with("/*")) {
            i = std::min(style.find("*/", i), style.size() - 2) + 1;
            continue;
        }
        const char c = style[i];
        if (c == ' ' || c == '\n') {
            after_space = true;
            continue;
        }
        const bool is_separator = separators.find(c) != std::string_view::npos;
        // A space before a colon begins a selector.
        if (after_space && !result.empty() && (!is_separator || c == ':') &&
            separators.find(result.back()) == std::string_view::npos)
            result += ' ';
        after_space = false;
        if (c == '}' && result.ends_with(';')) result.pop_back();
        result += c;
    }
    return result;
}

}  // namespace relief::tools
