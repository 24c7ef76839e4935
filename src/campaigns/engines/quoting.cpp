#include "campaigns/engines/quoting.hpp"

#include <fmt/format.h>

namespace skyloop {
namespace {

// The text with `with` before each of some characters.
std::string escaped(std::string_view text, std::string_view some, char with) {
    std::string out;
    for (const char c : text) {
        if (some.find(c) != std::string_view::npos) out += with;
        out += c;
    }
    return out;
}

}  // namespace

std::string sbatch_quoted(std::string_view word) { return '"' + escaped(word, "\"\\", '\\') + '"'; }

std::string sbatch_pattern(std::string_view path) { return escaped(path, "%", '%'); }

std::string kubernetes_literal(std::string_view text) { return escaped(text, "$", '$'); }

std::string yaml_quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : escaped(text, "\"\\", '\\')) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f)
            out += fmt::format("\\x{:02x}", byte);
        else
            out += c;
    }
    return out + '"';
}

}  // namespace skyloop
