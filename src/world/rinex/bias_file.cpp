#include "world/rinex/bias_file.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "base/core/files.hpp"
#include "detail/fields.hpp"

namespace skyloop::inline world {
namespace rinex {
namespace {

// "2020:177:00000": year, day of the year, second of the day, in GPST.
std::optional<GpsTime> sinex_epoch(std::string_view text) {
    const auto year = whole_field(columns(text, 0, 4)), day = whole_field(columns(text, 5, 3)),
               second = whole_field(columns(text, 9, 5));
    if (columns(text, 4, 1) != ":" || columns(text, 8, 1) != ":" || !year || !day || !second) return std::nullopt;
    if (*day < 1 || *day > 366 || *second < 0 || *second > 86400) return std::nullopt;
    const auto first = calendar_epoch({*year, 1, 1, 0, 0, 0.0}, {});
    if (!first) return std::nullopt;
    return *first + std::chrono::days(*day - 1) + std::chrono::seconds(*second);
}

class BiasFileReading {
public:
    BiasFileReading(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<CodeBiases> read() {
        const std::optional<Line> first = lines_.next();
        if (!first || !first->text.starts_with("%=BIA"))
            return refused(name_, lines_.number(), first ? in_quotes(first->text) : "an empty file",
                           "a SINEX file of biases, its first line beginning with '%=BIA'");
        bool in_solution = false;
        while (const std::optional<Line> line = lines_.next()) {
            if (line->text.starts_with("+BIAS/SOLUTION")) in_solution = true;
            if (line->text.starts_with("-BIAS/SOLUTION")) in_solution = false;
            if (!in_solution || !line->text.starts_with(' ') || is_blank(line->text)) continue;
            if (const Result<void> taken = take(*line); !taken) return fail(taken.error());
        }
        if (biases_.size() == 0)
            return refused(name_, lines_.number(), "no code bias of a satellite", "lines OSB or DSB in BIAS/SOLUTION");
        return std::move(biases_);
    }

private:
    //  OSB  G063 G01           C1C       2020:177:00000 2020:178:00000 ns                  -1.2345      0.0100
    Result<void> take(const Line& line) {
        const std::string_view kind = trimmed(columns(line.text, 1, 4));
        const std::string_view code = trimmed(columns(line.text, 25, 4)), other = trimmed(columns(line.text, 30, 4));
        if (kind != "OSB" && kind != "DSB") return {};  // ISB: of receivers
        const auto satellite = parse_satellite(trimmed(columns(line.text, 11, 3)));
        if (!satellite || !is_blank(columns(line.text, 15, 9)) || !code.starts_with('C')) return {};
        if ((kind == "DSB") != other.starts_with('C'))
            return refused(name_, line.number, in_quotes(line.text), "one code of an OSB, two of a DSB");
        const auto from = sinex_epoch(columns(line.text, 35, 14)), until = sinex_epoch(columns(line.text, 50, 14));
        const bool open = columns(line.text, 50, 14) == "0000:000:00000";
        if (!from || (!until && !open))
            return refused(name_, line.number, in_quotes(columns(line.text, 35, 29)), "two epochs, YEAR:DAY:SECOND");
        const std::string_view field = columns(line.text, 70, 21);
        const auto nanoseconds = is_blank(field) ? std::nullopt : real_field(field);
        constexpr double largest_ns = 1e6;
        if (trimmed(columns(line.text, 65, 4)) != "ns" || !nanoseconds || std::abs(*nanoseconds) > largest_ns)
            return refused(name_, line.number, in_quotes(columns(line.text, 65, 26)), "nanoseconds, up to 1e6");
        biases_.add(*satellite, {std::string(code), std::string(other), *from, until, *nanoseconds * 1e-9});
        return {};
    }

    LineReader lines_;
    std::string_view name_;
    CodeBiases biases_;
};

}  // namespace
}  // namespace rinex

Result<CodeBiases> read_biases(std::string_view text, std::string_view name) {
    return rinex::BiasFileReading(text, name).read();
}

Result<CodeBiases> read_bias_file(const std::filesystem::path& path) { return read_text_with(path, read_biases); }

}  // namespace skyloop::inline world
