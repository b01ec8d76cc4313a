// UTF-8, the encoding of text files.
#pragma once
#include <string_view>

/// The bytes of the UTF-8 character that starts at bytes[i]; 0 when it is not well formed.
inline size_t utf8_length(std::string_view bytes, size_t i) {
    unsigned char first = static_cast<unsigned char>(bytes[i]);
    if (first < 0x80) return 1;
    size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || i + length > bytes.size()) return 0;
    for (size_t j = 1; j < length; j++) {
        if ((bytes[i + j] & 0xc0) != 0x80) return 0;
    }
    // Refuse overlong forms, surrogates, and what lies beyond U+10FFFF.
    unsigned char second = static_cast<unsigned char>(bytes[i + 1]);
    bool refused = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                   (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
    return refused ? 0 : length;
}

/// Whether this well-formed character is a control character (U+0000 to U+001F, U+007F to U+009F),
/// which a terminal may obey instead of printing it.
inline bool utf8_is_control(std::string_view character) {
    return character < " " || (character >= "\x7f" && character < "\xc2\xa0");
}
