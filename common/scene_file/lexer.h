// Splits a pbrt-v4 scene file into tokens that know where they stand.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/base/text.h"

/// An error behind which nothing more is read: a limit that is passed, a string without an end.
struct ReadingEnds : std::runtime_error {
    using std::runtime_error::runtime_error;
};
[[noreturn]] inline void stop_reading(const Position& at, const std::string& text) {
    throw ReadingEnds(message_at(at, "error", text));
}

struct Token {
    enum Type : uint8_t { word, string, opens, closes, end };  // opens, closes: brackets
    Type type = end;
    std::string_view text;  // as written; of a string, what stands between the quotes
    int line = 1, column = 1;
};

/// The tokens of one file, with one token to look ahead. A token of type `end` closes the file.
///
/// Blanks separate tokens; brackets and quotes also end one; # starts a comment where a token could
/// start. Lines end with LF, CR LF or CR. Throws InputError for a file that is not UTF-8 text, and
/// ReadingEnds for a string without its end.
class Lexer {
public:
    Lexer(std::string file, std::string bytes) : file_(std::move(file)), bytes_(std::move(bytes)) {
        for (size_t i = 0, length = 0; i < bytes_.size(); i += length) {
            length = utf8_length(bytes_, i);
            if (length > 0) continue;
            advance_to(i);
            fail({file_, line_, column_}, "not UTF-8 text");
        }
        if (bytes_.starts_with("\xef\xbb\xbf")) position_ = 3;  // a byte order mark
        ahead_ = read();
    }
    Lexer(const Lexer&) = delete;  // tokens point into bytes_

    const Token& peek() const { return ahead_; }
    Token next() {
        Token token = ahead_;
        if (token.type != Token::end) ahead_ = read();
        return token;
    }
    /// Whether the next token looks like none that begins a directive.
    bool has_argument() const {
        if (ahead_.type != Token::word) return ahead_.type != Token::end;
        return ahead_.text[0] < 'A' || ahead_.text[0] > 'Z';
    }
    /// Reads over what is left of a directive.
    void skip_arguments() {
        while (has_argument()) next();
    }
    Position at(const Token& token) const { return {file_, token.line, token.column}; }

    /// The next token, which must be of this type; throws `NEEDS, not ...` where it is another.
    Token expect(Token::Type type, const std::string& needs) {
        Token token = next();
        if (token.type != type) fail_at(token, needs);
        return token;
    }
    /// The next number, which a float can hold; throws `WHAT needs a number, not ...`.
    double number(const std::string& what) {
        Token token = next();
        std::optional<double> value;
        if (token.type == Token::word) value = to_number(token.text);
        bool is_float = value && std::abs(*value) <= std::numeric_limits<float>::max();
        if (!is_float) fail_at(token, what + " needs a number");
        return *value;
    }
    /// What the quoted string means: its escapes \b \f \n \r \t \\ \' \" resolved.
    std::string unescape(const Token& token) const {
        constexpr std::string_view letters = "bfnrt\\'\"", meanings = "\b\f\n\r\t\\'\"";
        std::string text;
        for (size_t i = 0; i < token.text.size(); i++) {
            if (token.text[i] != '\\') {
                text += token.text[i];
                continue;
            }
            size_t letter = letters.find(token.text[++i]);
            if (letter == letters.npos) {
                fail(at(token), "unknown escape " + quote(token.text.substr(i - 1, 2)) +
                                    ": write / between folders, and \\\\ for a \\ in a string");
            }
            text += meanings[letter];
        }
        return text;
    }
    /// Throws `TEXT, not TOKEN`.
    [[noreturn]] void fail_at(const Token& token, const std::string& text) const {
        std::string what = token.type == Token::end      ? "the end of the file"
                           : token.type == Token::string ? "the string " + quote(token.text)
                                                         : quote(token.text);
        fail(at(token), text + ", not " + what);
    }

private:
    // Steps to this byte, or to the end, and counts lines and characters. Of CR LF only the LF ends
    // the line.
    void advance_to(size_t end) {
        for (; position_ < std::min(end, bytes_.size()); position_++) {
            char c = bytes_[position_];
            if (c == '\n' || (c == '\r' && bytes_[position_ + 1] != '\n')) {
                line_++;
                column_ = 1;
            } else if ((c & 0xc0) != 0x80) {
                column_++;
            }
        }
    }
    Token read() {
        auto stands_at = [&](std::string_view any) {
            return position_ < bytes_.size() && any.find(bytes_[position_]) != any.npos;
        };
        while (stands_at(" \t\r\n#")) {
            advance_to(stands_at("#") ? bytes_.find_first_of("\r\n", position_) : position_ + 1);
        }
        Token token = {Token::end, {}, line_, column_};
        size_t start = position_;
        if (start == bytes_.size()) return token;
        if (stands_at("\"")) {
            // Look for what ends it, but behind pairs such as \\ and \".
            size_t end = bytes_.find_first_of("\\\"\r\n", start + 1);
            while (end < bytes_.size() && bytes_[end] == '\\') {
                end = bytes_.find_first_of("\\\"\r\n", end + 2);
            }
            if (end >= bytes_.size() || bytes_[end] != '"') {
                stop_reading(at(token), "the string does not end on its line");
            }
            token.type = Token::string;
            token.text = std::string_view(bytes_).substr(start + 1, end - start - 1);
            advance_to(end + 1);
            return token;
        }
        token.type = stands_at("[") ? Token::opens : stands_at("]") ? Token::closes : Token::word;
        bool is_word = token.type == Token::word;
        advance_to(is_word ? bytes_.find_first_of(" \t\r\n[]\"", start) : start + 1);
        token.text = std::string_view(bytes_).substr(start, position_ - start);
        return token;
    }

    std::string file_, bytes_;
    size_t position_ = 0;
    int line_ = 1, column_ = 1;
    Token ahead_;
};
