// A checksum of bytes.
#pragma once
#include <cstdint>
#include <string_view>

/// A number of 64 bits for any bytes, given piece by piece; where the pieces end does not matter.
/// A change within eight bytes that are hashed together, such as one flipped bit, always changes
/// it: each step is a bijection. No protection against those who want to deceive.
///
///   h = mix(h ^ word)      for each 8 bytes, the last ones filled up with 0
///
/// tested by  "teeth: a film with any bit flipped, or cut anywhere, is refused"
class Checksum {
public:
    void add(std::string_view bytes) {
        for (char byte : bytes) {
            word_ |= uint64_t{static_cast<unsigned char>(byte)} << 8 * (length_ % 8);
            if (++length_ % 8 == 0) step(word_), word_ = 0;
        }
    }
    uint64_t value() const {
        Checksum end = *this;
        end.step(word_);
        end.step(length_);
        return end.sum_;
    }

private:
    void step(uint64_t word) {
        sum_ = (sum_ ^ word) * 0x9e3779b97f4a7c15u;
        sum_ = (sum_ ^ sum_ >> 32) * 0xd6e8feb86659fd93u;
        sum_ ^= sum_ >> 29;
    }
    uint64_t sum_ = 0x243f6a8885a308d3u, word_ = 0, length_ = 0;
};
