#include "common/scene_file/lexer.h"

#include <cmath>
#include <limits>

#include "common/base/numbers.h"
#include "common/base/text.h"
#include "common/scene_file/messages.h"

Lexer::Lexer(std::string file, std::string bytes, const Report& report)
    : file_(std::move(file)), bytes_(std::move(bytes)), report_(report) {
    for (size_t i = 0; i < bytes_.size();) {
        size_t length = utf8_length(bytes_, i);
        if (length == 0) {
            while (position_ < i) advance();
            fail({file_, line_, column_}, "not UTF-8 text");
        }
        i += length;
    }
    if (bytes_.starts_with("\xef\xbb\xbf")) position_ = 3;  // a byte order mark
    ahead_ = read();
}

Token Lexer::next() {
    Token token = ahead_;
    if (token.type != Token::end) ahead_ = read();
    return token;
}

bool Lexer::has_argument() const {
    if (ahead_.type != Token::word) return ahead_.type != Token::end;
    return ahead_.text[0] < 'A' || ahead_.text[0] > 'Z';
}

// Steps over one byte and counts lines and characters. Of CR LF only the LF ends the line.
void Lexer::advance() {
    char c = bytes_[position_++];
    if (c == '\n' || (c == '\r' && !stands_at("\n"))) {
        line_++;
        column_ = 1;
    } else if ((c & 0xc0) != 0x80) {
        column_++;
    }
}

bool Lexer::stands_at(std::string_view any) const {
    return position_ < bytes_.size() && any.find(bytes_[position_]) != any.npos;
}

void Lexer::skip_blanks_and_comments() {
    while (stands_at(" \t\r\n#")) {
        bool is_comment = stands_at("#");
        do {
            advance();
        } while (is_comment && position_ < bytes_.size() && !stands_at("\r\n"));
    }
}

void Lexer::read_string() {
    Position start = {file_, line_, column_};
    advance();
    while (position_ < bytes_.size() && !stands_at("\"\r\n")) {
        bool escape = stands_at("\\");
        advance();
        if (escape && stands_at("\\\"")) advance();
    }
    if (!stands_at("\"")) stop_reading(start, "the string does not end on its line");
    advance();
}

Token Lexer::read() {
    skip_blanks_and_comments();
    if (position_ >= next_report_) {
        constexpr size_t step = size_t{1} << 20;
        next_report_ = position_ + step;
        double share = static_cast<double>(position_) / static_cast<double>(bytes_.size() + 1);
        if (report_) report_("reading " + file_, share);
    }
    Token token = {Token::end, {}, line_, column_};
    size_t start = position_;
    if (start == bytes_.size()) return token;
    if (stands_at("\"")) {
        read_string();
        token.type = Token::string;
        token.text = std::string_view(bytes_).substr(start + 1, position_ - start - 2);
        return token;
    }
    token.type = stands_at("[") ? Token::open : stands_at("]") ? Token::close : Token::word;
    do {
        advance();
    } while (token.type == Token::word && position_ < bytes_.size() && !stands_at(" \t\r\n[]\""));
    token.text = std::string_view(bytes_).substr(start, position_ - start);
    return token;
}

void Lexer::fail_at(const Token& token, const std::string& text) const {
    std::string what = token.type == Token::end      ? "the end of the file"
                       : token.type == Token::string ? "the string " + quote(token.text)
                                                     : quote(token.text);
    fail(at(token), text + ", not " + what);
}

Token Lexer::expect(Token::Type type, const std::string& needs) {
    Token token = next();
    if (token.type != type) fail_at(token, needs);
    return token;
}

double Lexer::number(const std::string& what) {
    Token token = next();
    std::optional<double> value;
    if (token.type == Token::word) value = to_number(token.text);
    if (!value) fail_at(token, what + " needs a number");
    if (std::abs(*value) > std::numeric_limits<float>::max()) {
        fail(at(token), "number too large: " + quote(token.text));
    }
    return *value;
}

std::string Lexer::unescape(const Token& token) const {
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
