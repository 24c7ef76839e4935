#include "world/rinex/antenna_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "base/core/files.hpp"
#include "detail/fields.hpp"

namespace skyloop::inline world {
namespace rinex {
namespace {

constexpr double millimetre = 1e-3;

class AntennaFileReading {
public:
    AntennaFileReading(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<AntennaCatalogue> read() {
        if (const Result<void> done = header(); !done) return fail(done.error());
        while (advance())
            if (label() == "START OF ANTENNA")
                if (const Result<void> done = antenna(); !done) return fail(done.error());
        if (catalogue_.satellites.size() == 0 && catalogue_.receivers.empty())
            return wrong("no antenna", "at least one, from START OF ANTENNA to END OF ANTENNA");
        return std::move(catalogue_);
    }

private:
    // Of one antenna, what stands above its frequencies.
    struct Head {
        std::string receiver;  // its name; empty: a satellite
        std::optional<SatelliteId> satellite;
        bool single_piece = false;
        GpsTime from = GpsTime::min();
        std::optional<GpsTime> until;
        Angle first, step;
        std::size_t points = 0;  // by zenith
        std::size_t rows = 0;    // by azimuth
    };

    [[nodiscard]] tl::unexpected<Error> wrong(std::string_view found, std::string_view expected) const {
        return refused(name_, lines_.number(), found, expected);
    }
    bool advance() {
        const std::optional<Line> line = lines_.next();
        line_ = line ? line->text : std::string_view();
        return line.has_value();
    }
    [[nodiscard]] std::string_view label() const { return header_label(line_); }
    [[nodiscard]] std::optional<double> number(std::size_t column, std::size_t width) const {
        return is_blank(columns(line_, column, width)) ? std::nullopt : real_field(columns(line_, column, width));
    }

    Result<void> header() {
        if (!advance() || label() != "ANTEX VERSION / SYST")
            return wrong(in_quotes(line_), "an ANTEX file, its first line labelled 'ANTEX VERSION / SYST'");
        const double version = number(0, 8).value_or(0);
        if (!(version >= 1.3 && version < 1.5)) return wrong(in_quotes(columns(line_, 0, 8)), "version 1.3 or 1.4");
        while (advance()) {
            if (label() == "END OF HEADER") return {};
            if (label() == "PCV TYPE / REFANT" && columns(line_, 0, 1) != "A")
                return wrong(in_quotes(columns(line_, 0, 40)), "absolute calibrations, type A");
        }
        return wrong("the end of the file", "END OF HEADER");
    }

    Result<void> antenna() {
        Head head;
        AntennaCalibration calibration;
        while (advance()) {
            if (label() == "END OF ANTENNA") {
                keep(head, std::move(calibration));
                return {};
            }
            Result<void> done;
            if (label() == "START OF FREQUENCY")
                done = frequency(head, calibration);
            else if (label() == "START OF FREQ RMS")
                done = pass_over("END OF FREQ RMS");
            else
                done = head_line(head);
            if (!done) return done;
        }
        return wrong("the end of the file", "END OF ANTENNA");
    }

    Result<void> pass_over(std::string_view end) {
        while (advance())
            if (label() == end) return {};
        return wrong("the end of the file", end);
    }

    Result<void> head_line(Head& head) {
        if (label() == "TYPE / SERIAL NO") {
            const std::string_view serial = columns(line_, 20, 20);
            head.satellite = parse_satellite(trimmed(serial));
            // SVN and COSPAR identifier: satellites of other systems have them, too.
            const bool in_space = head.satellite || !is_blank(columns(line_, 40, 20));
            if (!in_space) head.receiver = receiver_antenna_name(columns(line_, 0, 20));
            head.single_piece = !in_space && !is_blank(serial);
        } else if (label() == "DAZI") {
            const double step = number(2, 6).value_or(-1);
            if (step < 0 || (step > 0 && step < 1) || step > 360)
                return wrong(in_quotes(line_), "a step of azimuth, 0 or from 1 to 360");
            head.rows = step > 0 ? static_cast<std::size_t>(std::lround(360 / step)) + 1 : 0;
        } else if (label() == "ZEN1 / ZEN2 / DZEN") {
            return zenith_grid(head);
        } else if (label() == "VALID FROM" || label() == "VALID UNTIL") {
            return validity(head);
        }
        return {};
    }

    Result<void> zenith_grid(Head& head) {
        const auto first = number(2, 6), last = number(8, 6), step = number(14, 6);
        const bool good = first && last && step && *first >= 0 && *last >= *first && *last <= 180 && *step >= 0.1;
        if (!good) return wrong(in_quotes(line_), "zenith angles: first, last, step");
        head.first = Angle::degrees(*first);
        head.step = Angle::degrees(*step);
        head.points = static_cast<std::size_t>(std::lround((*last - *first) / *step)) + 1;
        return {};
    }

    // "  2016    12    31    23    59   59.9999999": GPS time.
    Result<void> validity(Head& head) {
        const auto part = [&](std::size_t i) { return whole_field(columns(line_, 6 * i, 6)); };
        const auto time =
            calendar_epoch({part(0), part(1), part(2), part(3), part(4), real_field(columns(line_, 30, 13))}, {});
        if (!time) return wrong(in_quotes(columns(line_, 0, 43)), "an epoch from 1980 to 2269");
        (label() == "VALID FROM" ? head.from : head.until.emplace()) = *time;
        return {};
    }

    Result<void> frequency(const Head& head, AntennaCalibration& calibration) {
        // "   G01": a system and a band.
        const std::string_view letter = columns(line_, 3, 1);
        const std::optional<int> band = whole_field(columns(line_, 4, 2));
        const auto system = parse_satellite(std::string(letter) + "01");
        if (head.points == 0) return wrong("no ZEN1 / ZEN2 / DZEN", "zenith angles above the first frequency");
        if (!band || *band < 1) return wrong(in_quotes(columns(line_, 3, 3)), "a frequency, such as G01");
        PhaseCentre centre;
        centre.first_zenith = head.first;
        centre.zenith_step = head.step;
        while (advance()) {
            if (label() == "END OF FREQUENCY") {
                if (system) calibration.add(system->constellation, *band, std::move(centre));
                return {};
            }
            const Result<void> done = label() == "NORTH / EAST / UP" ? offset(centre) : variations(head, centre);
            if (!done) return done;
        }
        return wrong("the end of the file", "END OF FREQUENCY");
    }

    Result<void> offset(PhaseCentre& centre) {
        for (Eigen::Index i = 0; i < 3; ++i) {
            const auto value = number(static_cast<std::size_t>(10 * i), 10);
            constexpr double largest_mm = 1e5;
            if (!value || std::abs(*value) > largest_mm)
                return wrong(in_quotes(columns(line_, 0, 30)), "three offsets in millimetres, up to 1e5");
            centre.offset[i] = *value * millimetre;
        }
        return {};
    }

    Result<void> variations(const Head& head, PhaseCentre& centre) {
        std::vector<double> row;
        for (std::size_t i = 0; i < head.points; ++i) {
            const auto value = number(8 + 8 * i, 8);
            if (!value) return wrong(in_quotes(line_), fmt::format("{} variations in millimetres", head.points));
            row.push_back(*value * millimetre);
        }
        if (trimmed(columns(line_, 0, 8)) == "NOAZI")
            centre.by_zenith = std::move(row);
        else if (!head.satellite && centre.by_azimuth.size() < head.rows)
            centre.by_azimuth.push_back(std::move(row));
        return {};
    }

    void keep(const Head& head, AntennaCalibration calibration) {
        if (head.satellite)
            catalogue_.satellites.add(*head.satellite, {head.from, head.until, std::move(calibration)});
        else if (!head.receiver.empty() && !head.single_piece)
            catalogue_.receivers[head.receiver] = std::move(calibration);
    }

    LineReader lines_;
    std::string_view name_;
    std::string_view line_;
    AntennaCatalogue catalogue_;
};

}  // namespace
}  // namespace rinex

Result<AntennaCatalogue> read_antennas(std::string_view text, std::string_view name) {
    return rinex::AntennaFileReading(text, name).read();
}

Result<AntennaCatalogue> read_antenna_file(const std::filesystem::path& path) {
    return read_text_with(path, read_antennas);
}

}  // namespace skyloop::inline world
