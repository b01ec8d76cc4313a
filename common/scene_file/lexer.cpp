#include "common/scene_file/lexer.h"

#include <cmath>
#include <limits>

#include "common/base/numbers.h"
#include "common/base/text.h"
#include "common/scene_file/messages.h"

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool ends_word(char c) { return is_blank(c) || c == '[' || c == ']' || c == '"'; }

}  // namespace

Lexer::Lexer(std::string file, std::string bytes, const Report& report)
    : file_(std::move(file)), bytes_(std::move(bytes)), report_(report) {
    check_encoding();
    if (bytes_.starts_with("\xef\xbb\xbf")) position_ = 3;  // a byte order mark
    ahead_ = read();
}

void Lexer::check_encoding() const {
    if (bytes_.starts_with("\xff\xfe") || bytes_.starts_with("\xfe\xff")) {
        fail({file_}, "UTF-16 text: save it as UTF-8");
    }
    int line = 1, column = 1;
    for (size_t i = 0; i < bytes_.size(); column++) {
        size_t length = utf8_length(bytes_, i);
        if (length == 0) fail({file_, line, column}, "not UTF-8 text");
        if (line_ends_at(i)) {
            line++;
            column = 0;
        }
        i += length;
    }
}

Token Lexer::next() {
    Token token = ahead_;
    if (token.type != Token::end) ahead_ = read();
    return token;
}

// Of the two bytes CR LF only the second one ends the line.
bool Lexer::line_ends_at(size_t byte) const {
    if (bytes_[byte] == '\r') return byte + 1 == bytes_.size() || bytes_[byte + 1] != '\n';
    return bytes_[byte] == '\n';
}

// Steps over one byte and counts lines and characters.
void Lexer::advance() {
    if (line_ends_at(position_++)) {
        line_++;
        column_ = 1;
    } else if (position_ == bytes_.size() || (bytes_[position_] & 0xc0) != 0x80) {
        column_++;
    }
}

void Lexer::skip_blanks_and_comments() {
    while (position_ < bytes_.size()) {
        if (is_blank(bytes_[position_])) {
            advance();
        } else if (bytes_[position_] == '#') {
            while (position_ < bytes_.size() && bytes_[position_] != '\n' &&
                   bytes_[position_] != '\r') {
                advance();
            }
        } else {
            return;
        }
    }
}

void Lexer::read_string() {
    Position start = {file_, line_, column_};
    advance();
    while (position_ < bytes_.size() && bytes_[position_] != '"') {
        if (line_ends_at(position_)) stop_reading(start, "the string does not end on its line");
        bool escape = bytes_[position_] == '\\';
        advance();
        if (escape && position_ < bytes_.size() && !line_ends_at(position_)) advance();
    }
    if (position_ == bytes_.size()) stop_reading(start, "the file ends inside a string");
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
    Token token;
    token.line = line_;
    token.column = column_;
    size_t start = position_;
    if (start == bytes_.size()) return token;
    switch (bytes_[start]) {
        case '[':
            token.type = Token::open;
            advance();
            break;
        case ']':
            token.type = Token::close;
            advance();
            break;
        case '"':
            token.type = Token::string;
            read_string();
            token.text = std::string_view(bytes_).substr(start + 1, position_ - start - 2);
            return token;
        default:
            token.type = Token::word;
            while (position_ < bytes_.size() && !ends_word(bytes_[position_])) advance();
    }
    token.text = std::string_view(bytes_).substr(start, position_ - start);
    return token;
}

double Lexer::number(const Token& token, const std::string& what) const {
    std::optional<double> value;
    if (token.type == Token::word) value = to_number(token.text);
    if (!value) fail(at(token), what + " needs a number, not " + describe(token));
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
        if (letter == std::string_view::npos) {
            fail(at(token), "unknown escape " + quote(token.text.substr(i - 1, 2)) +
                                ": write / between folders, and \\\\ for a \\ in a string");
        }
        text += meanings[letter];
    }
    return text;
}

std::string Lexer::describe(const Token& token) {
    switch (token.type) {
        case Token::end: return "the end of the file";
        case Token::string: return "the string " + quote(token.text);
        default: return quote(token.text);
    }
}
