// Damages pictures, their notes and their statistics at random, and asks that all are read or
// refused.
#pragma once
#include "common/picture/png.h"
#include "common/picture/stats_file.h"
#include "common/picture/verdict.h"
#include "tests/damage/scenes.h"

/// Any of the .png kinds, any size up to 9x9, with a comment, and rows that are not packed.
inline std::string any_png(Dice& dice) {
    constexpr int kinds[][2] = {{0, 1}, {0, 2}, {0, 4}, {0, 8}, {0, 16}, {2, 8}, {2, 16}, {3, 1},
                                {3, 2}, {3, 4}, {3, 8}, {4, 8}, {4, 16}, {6, 8}, {6, 16}};
    auto [kind, depth] = kinds[dice.below(std::size(kinds))];
    auto small = [&] { return static_cast<char>(dice.below(256)); };
    std::string header = {0,
                          0,
                          0,
                          static_cast<char>(1 + dice.below(9)),
                          0,
                          0,
                          0,
                          static_cast<char>(1 + dice.below(9)),
                          static_cast<char>(depth),
                          static_cast<char>(kind),
                          0,
                          0,
                          static_cast<char>(dice.below(4) == 0)};  // the last: interlaced
    std::string png = "\x89PNG\r\n\x1a\n" + png_chunk("IHDR" + header);
    if (kind == 3) {
        std::string palette(3 * (dice.below(255) + 1), '\0');
        for (char& c : palette) c = small();
        png += png_chunk("PLTE" + palette);
    }
    if (dice.below(4) == 0) png += png_chunk(std::string("tRNS\0\1\0\2\0\3", 10));
    if (dice.below(2) == 0) {
        png += png_chunk(std::string("tEXtComment\0", 12) +
                         comment_of({{"scene", "a.pbrt"}, {"checksum", "1"}, {"spp", "4"}}));
    }
    if (dice.below(8) == 0) png += png_chunk("IDAT");
    size_t channels = kind == 2 ? 3 : kind == 4 ? 2 : kind == 6 ? 4 : 1;
    size_t row =
        1 + (static_cast<size_t>(header[3]) * channels * static_cast<size_t>(depth) + 7) / 8;
    std::string rows(row * static_cast<size_t>(header[7]) + dice.below(3) * 40, '\0');
    for (size_t i = 0; i < rows.size(); i++)
        rows[i] = i % row == 0 ? static_cast<char>(dice.below(5)) : small();
    char low = static_cast<char>(rows.size()), high = static_cast<char>(rows.size() >> 8);
    std::string packed = {
        '\x78', 1, 1, low, high, static_cast<char>(~low), static_cast<char>(~high)};
    return png + png_chunk("IDAT" + packed + rows + "sums") + png_chunk("IEND");
}

/// A .ppm or .pfm, with any of the blanks and numbers that a header may have.
inline std::string any_map(Dice& dice) {
    auto any = [&](std::initializer_list<const char*> words) {
        return std::string(words.begin()[dice.below(words.size())]);
    };
    auto blank = [&] { return any({"\n", " ", "\r\n", "\r", "\t", "\n# a\n", "\n#\r"}); };
    std::string kind = any({"P6", "PF", "Pf", "P6", "PF", "Pf", "P3", "P5", "PF4"});
    size_t w = 1 + dice.below(9), h = 1 + dice.below(9),
           each = kind == "PF"   ? 12
                  : kind == "Pf" ? 4
                                 : 3;
    std::string last = each == 3 ? any({"255", "255", "65535", "0255", "254"})
                                 : any({"-1", "1", "-2.5", "1e-3", "0", "-1e40", "1.000", "nan"});
    std::string notes = kind == "P6" && dice.below(2) == 0
                            ? "\n# picture of path-by-path\n# checksum 1\n# spp 4"
                            : "";
    std::string header = kind + notes + blank() + std::to_string(w) + blank() + std::to_string(h) +
                         blank() + last + any({"\n", "\r\n", " ", "\r", "\n\n"});
    std::string pixels(w * h * each, '\0');
    for (char& c : pixels) c = static_cast<char>(dice.below(256));
    return header + pixels;
}

/// The .png with right checksums wherever its chunks have a right length.
inline std::string with_checksums(std::string png) {
    for (size_t at = 8; at + 12 <= png.size();) {
        size_t length = 0;
        for (size_t i = 0; i < 4; i++) length = length << 8 | static_cast<uint8_t>(png[at + i]);
        if (length > png.size() - at - 12) break;
        png.replace(at, 12 + length, png_chunk(png.substr(at + 4, 4 + length)));
        at += 12 + length;
    }
    return png;
}

/// Reads one file as a picture, as notes and as statistics, and says whether it was a picture.
inline bool read_anything(const std::string& bytes) {
    auto require = [](bool holds, const char* what) {
        if (!holds) throw std::logic_error(what);
    };
    PictureFacts facts{"a.png"};
    auto tell = [&](const Notes& notes) {
        facts.notes = notes;
        for (const std::string& line : doubts(facts, {"b.png"})) {
            require(line.size() < 9000, "a long line");
            for (char c : line)
                require(c >= ' ' && c != 0x7f, "a letter that is not to be printed");
        }
    };
    StatsFile stats(bytes);
    stats.number("spp");
    tell(notes_in(stats.texts("notes")));
    tell(notes_in(bytes));
    try {
        tell(notes_in(decode_comment("a", bytes)));
        Image image = decode_image("a", bytes);
        size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
        require(image.width > 0 && image.height > 0 && image.pixels.size() == pixels, "its size");
        return true;
    } catch (const InputError& error) {
        check_message(error.what());
        return false;
    }
}

/// Reads `count` damaged pictures, from number `first` on; see fuzz().
inline FuzzResult fuzz_pictures(uint32_t first, uint32_t count,
                                const std::function<void(uint32_t)>& begin = {}) {
    const std::vector<std::string> words = split(
        "IHDR|IDAT|IEND|tEXtComment|PLTE|tRNS|CgBI|P6|PF|Pf|\n|\r\n|#|255|"
        "-1.0|65536|4294967295|picture of path-by-path|\"notes\": [\"|\\|"
        "1e400|\x1b[2J|\xff\xff\xff\xff",
        '|');
    FuzzResult result;
    for (uint32_t i = first; i < first + count; i++) {
        Dice dice(i);
        auto any = [&] {
            std::string one = dice.below(2) == 0 ? any_png(dice) : any_map(dice);
            return dice.below(8) > 0 ? one
                                     : "{\"spp\": 4, \"notes\": [\"checksum 1\", \"" + one + "\"]}";
        };
        std::string bytes = any(), other = any();
        for (size_t changes = dice.below(4) * dice.below(3); changes > 0; changes--)
            bytes = mutate(bytes, other, words, dice);
        if (dice.below(4) > 0) bytes = with_checksums(bytes);
        if (begin) begin(i);
        double start = processor_seconds();
        try {
            (read_anything(bytes) ? result.read : result.refused)++;
        } catch (const std::exception& error) {
            throw std::logic_error("picture " + std::to_string(i) + ": " + error.what());
        }
        double seconds = processor_seconds() - start;
        if (seconds > most_seconds)
            throw std::logic_error("picture " + std::to_string(i) + " takes too long");
        result.slowest = std::max(result.slowest, seconds);
    }
    return result;
}
