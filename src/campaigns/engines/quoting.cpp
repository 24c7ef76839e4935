#include "campaigns/engines/quoting.hpp"

#include <fmt/format.h>

namespace skyloop {
namespace {

std::string with_backslashes(std::string_view text, std::string_view before) {
    std::string out;
    for (const char c : text) {
        if (before.find(c) != std::string_view::npos) out += '\\';
        out += c;
    }
    return out;
}

}  // namespace

std::string sbatch_quoted(std::string_view word) { return '"' + with_backslashes(word, "\"\\") + '"'; }

std::string sbatch_pattern(std::string_view path) {
    std::string out;
    for (const char c : path)
        out += c == '%' ? "%%" : std::string(1, c);
    return out;
}

std::string yaml_quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f)
            out += fmt::format("\\x{:02x}", byte);
        else
            out += with_backslashes(std::string_view(&c, 1), "\"\\");
    }
    return out + '"';
}

std::string kubernetes_literal(std::string_view text) {
    std::string out;
    for (const char c : text)
        out += c == '$' ? "$$" : std::string(1, c);
    return out;
}

}  // namespace skyloop
