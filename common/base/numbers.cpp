#include "common/base/numbers.h"

#include <charconv>
#include <cstdlib>
#include <string>
#include <version>

namespace {

std::string_view without_plus(std::string_view text) {
    return text.starts_with('+') && !text.starts_with("+-") ? text.substr(1) : text;
}

}  // namespace

std::optional<double> to_number(std::string_view text) {
    text = without_plus(text);
    bool negative = text.starts_with('-');
    std::string_view digits = text.substr(negative ? 1 : 0);
    if (digits.empty() || !(digits[0] == '.' || (digits[0] >= '0' && digits[0] <= '9'))) return {};
#ifdef __cpp_lib_to_chars  // several times as fast, but not every library has it for doubles
    double value = 0;
    auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (stop != text.data() + text.size() || error == std::errc::invalid_argument) return {};
    if (error == std::errc()) return value;
#endif
    if (digits.find_first_not_of("0123456789.eE+-") != std::string_view::npos) return {};
    std::string copy(text);
    char* end = nullptr;
    double rounded = std::strtod(copy.c_str(), &end);
    if (end != copy.c_str() + copy.size()) return {};
    return rounded;
}

std::optional<int> to_integer(std::string_view text) {
    text = without_plus(text);
    int value = 0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error != std::errc()) return {};
    return value;
}
