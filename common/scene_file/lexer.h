// Splits a pbrt-v4 scene file into tokens that know where they stand.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/base/progress.h"

struct Token {
    enum Type : uint8_t { word, string, open, close, end };
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
    Lexer(std::string file, std::string bytes, const Report& report = {});
    Lexer(const Lexer&) = delete;  // tokens point into bytes_
    Lexer& operator=(const Lexer&) = delete;

    const Token& peek() const { return ahead_; }
    Token next();
    /// Whether the next token looks like none that begins a directive.
    bool has_argument() const;
    Position at(const Token& token) const { return {file_, token.line, token.column}; }

    /// The next token, which must be of this type; throws `NEEDS, not ...` where it is another.
    Token expect(Token::Type type, const std::string& needs);
    /// The next number; throws `WHAT needs a number, not ...` where there is none.
    double number(const std::string& what);
    /// What the quoted string means: its escapes \b \f \n \r \t \\ \' \" resolved.
    std::string unescape(const Token& token) const;
    /// Throws `TEXT, not TOKEN`.
    [[noreturn]] void fail_at(const Token& token, const std::string& text) const;

private:
    void advance_to(size_t end);
    Token read();

    std::string file_, bytes_;
    Report report_;
    size_t position_ = 0, next_report_ = 0;
    int line_ = 1, column_ = 1;
    Token ahead_;
};
