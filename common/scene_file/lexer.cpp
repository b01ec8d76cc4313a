#include "common/scene_file/lexer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/text.h"
#include "common/scene_file/input.h"

Lexer::Lexer(std::string file, std::string bytes, const Report& report)
    : file_(std::move(file)), bytes_(std::move(bytes)), report_(report) {
    for (size_t i = 0; i < bytes_.size();) {
        size_t length = utf8_length(bytes_, i);
        if (length == 0) {
            advance_to(i);
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

// Steps to this byte, or to the end, and counts lines and characters. Of CR LF only the LF ends the
// line.
void Lexer::advance_to(size_t end) {
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

Token Lexer::read() {
    auto stands_at = [&](std::string_view any) {
        return position_ < bytes_.size() && any.find(bytes_[position_]) != any.npos;
    };
    while (stands_at(" \t\r\n#")) {
        advance_to(stands_at("#") ? bytes_.find_first_of("\r\n", position_) : position_ + 1);
    }
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
        // Look for what ends it, but behind the pairs \\ and \".
        size_t end = bytes_.find_first_of("\\\"\r\n", start + 1);
        while (end < bytes_.size() && bytes_[end] == '\\') {
            bool is_pair = bytes_[end + 1] == '\\' || bytes_[end + 1] == '"';
            end = bytes_.find_first_of("\\\"\r\n", end + (is_pair ? 2 : 1));
        }
        if (end >= bytes_.size() || bytes_[end] != '"') {
            stop_reading(at(token), "the string does not end on its line");
        }
        token.type = Token::string;
        token.text = std::string_view(bytes_).substr(start + 1, end - start - 1);
        advance_to(end + 1);
        return token;
    }
    token.type = stands_at("[") ? Token::open : stands_at("]") ? Token::close : Token::word;
    bool is_word = token.type == Token::word;
    advance_to(is_word ? bytes_.find_first_of(" \t\r\n[]\"", start) : start + 1);
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
