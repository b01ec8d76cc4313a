// The bytes of a PLY file, read as words and as values of its scalar types.
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "common/base/numbers.h"
#include "common/base/position.h"

enum class PlyFormat { ascii, little, big };

struct PlyScalar {
    const char *name, *other_name;
    size_t size;
    bool is_float, is_signed;
};
inline constexpr std::array<PlyScalar, 8> ply_scalars = {{{"char", "int8", 1, false, true},
                                                          {"uchar", "uint8", 1, false, false},
                                                          {"short", "int16", 2, false, true},
                                                          {"ushort", "uint16", 2, false, false},
                                                          {"int", "int32", 4, false, true},
                                                          {"uint", "uint32", 4, false, false},
                                                          {"float", "float32", 4, true, true},
                                                          {"double", "float64", 8, true, true}}};

/// The bytes of the file and how far they are read, in words or in binary values.
class PlyBytes {
public:
    PlyBytes(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

    PlyFormat format = PlyFormat::ascii;
    size_t left() const { return bytes_.size() - position_; }
    /// Where the last word read starts.
    Position at() const { return {file_, line_, word_column_}; }

    /// Throws at the last word read, or at the byte that is reached.
    [[noreturn]] void fail_here(const std::string& text) const {
        if (format == PlyFormat::ascii) fail(at(), text);
        fail({file_}, text + " at byte " + std::to_string(position_));
    }

    /// The next word of the line; empty at its end.
    std::string_view word() {
        while (left() > 0 && (peek() == ' ' || peek() == '\t')) step();
        word_column_ = column_;
        size_t start = position_;
        while (left() > 0 && !is_space(peek())) step();
        return bytes_.substr(start, position_ - start);
    }
    /// Reads over the rest of the line and its end: LF, CR LF or CR. Where the first line ends with
    /// CR alone, an LF behind the header is the first byte of what follows.
    void end_line() {
        while (left() > 0 && peek() != '\n' && peek() != '\r') step();
        bool carriage_return = left() > 0 && peek() == '\r';
        if (left() > 0) step();
        bool line_feed = carriage_return && left() > 0 && peek() == '\n';
        if (line_ == 1) cr_alone_ = carriage_return && !line_feed;
        if (line_feed && !cr_alone_) step();
        line_++;
        column_ = 1;
    }

    double value(const PlyScalar& type) {
        return format == PlyFormat::ascii ? ascii_value(type) : binary_value(type);
    }

private:
    static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
    char peek() const { return bytes_[position_]; }
    void step() {
        position_++;
        column_++;
    }

    double ascii_value(const PlyScalar& type) {
        std::string_view text = word();
        while (text.empty() && left() > 0) {
            end_line();
            text = word();
        }
        if (text.empty()) fail_here("the file ends too early");
        auto number = to_number(text);
        if (!number) fail_here("expected a number, not " + quote(text));
        bool is_whole = *number == std::floor(*number) && std::abs(*number) < 0x1p32;
        if (!type.is_float && !is_whole) fail_here("expected a whole number, not " + quote(text));
        return *number;
    }

    double binary_value(const PlyScalar& type) {
        if (left() < type.size) fail_here("the file ends too early");
        uint64_t bits = 0;
        for (size_t i = 0; i < type.size; i++) {
            size_t j = format == PlyFormat::little ? i : type.size - 1 - i;
            bits |= uint64_t{static_cast<unsigned char>(bytes_[position_ + i])} << (8 * j);
        }
        position_ += type.size;
        if (type.is_float) {
            return type.size == 8 ? std::bit_cast<double>(bits)
                                  : double{std::bit_cast<float>(static_cast<uint32_t>(bits))};
        }
        // Spread the sign bit of a signed value over the bits above it.
        int shift = static_cast<int>(64 - 8 * type.size);
        if (type.is_signed)
            return static_cast<double>(static_cast<int64_t>(bits << shift) >> shift);
        return static_cast<double>(bits);
    }

    std::string file_;
    std::string_view bytes_;
    size_t position_ = 0;
    int line_ = 1, column_ = 1, word_column_ = 1;
    bool cr_alone_ = false;  // ends lines
};
