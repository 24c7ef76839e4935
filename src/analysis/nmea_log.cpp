#include "nmea_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "fix_table.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop {
namespace {

constexpr double half_day = 43200;
constexpr double day = 86400;

bool sentence_starts_at(std::string_view text, std::size_t at) {
    if (at + 7 > text.size() || text[at + 6] != ',') return false;
    return std::all_of(text.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                       text.begin() + static_cast<std::ptrdiff_t>(at) + 6,
                       [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
}

std::optional<double> field_number(std::string_view field) {
    if (field.starts_with('+')) field.remove_prefix(1);
    double value = 0;
    const auto [end, status] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (status != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

// hhmmss.ss as seconds since midnight.
std::optional<double> time_of_day(std::string_view field) {
    const std::optional<double> value = field_number(field);
    if (!value || field.size() < 6 || *value < 0) return std::nullopt;
    const double hours = std::floor(*value / 10000);
    const double minutes = std::floor((*value - hours * 10000) / 100);
    const double seconds = *value - hours * 10000 - minutes * 100;
    if (hours > 23 || minutes > 59 || seconds >= 61) return std::nullopt;
    return hours * 3600 + minutes * 60 + seconds;
}

// ddmm.mmmm and its hemisphere as degrees.
std::optional<double> coordinate(std::string_view field, std::string_view hemisphere, std::string_view letters) {
    const std::optional<double> value = field_number(field);
    if (!value || *value < 0 || hemisphere.size() != 1 || letters.find(hemisphere[0]) == std::string_view::npos)
        return std::nullopt;
    const double degrees = std::floor(*value / 100);
    const double minutes = *value - degrees * 100;
    if (minutes >= 60) return std::nullopt;
    const double angle = degrees + minutes / 60;
    return hemisphere[0] == letters[1] ? -angle : angle;
}

// ddmmyy as midnight UTC of that day; two-digit years from 80 on are of the last century.
std::optional<UtcTime> date(std::string_view field) {
    unsigned value = 0;
    const auto [end, status] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (field.size() != 6 || status != std::errc() || end != field.data() + field.size()) return std::nullopt;
    const unsigned year = value % 100;
    const auto utc = parse_utc(
        fmt::format("{:04}-{:02}-{:02}T00:00:00Z", year + (year < 80 ? 2000 : 1900), value / 100 % 100, value / 10000));
    if (!utc) return std::nullopt;
    return *utc;
}

enum class Checksum { good, bad, absent };

// The payload between '$' and '*' of the sentence at the start of `text`, and whether its checksum holds.
Checksum verify(std::string_view text, std::string_view& payload) {
    const std::size_t end = text.find_first_of("*$\r\n", 1);
    if (end == std::string_view::npos || text[end] != '*') return Checksum::absent;
    payload = text.substr(1, end - 1);
    unsigned char sum = 0;
    for (const char c : payload)
        sum = static_cast<unsigned char>(sum ^ static_cast<unsigned char>(c));
    const std::string_view digits = text.substr(end + 1, 2);
    unsigned expected = 0;
    const auto [stop, status] = std::from_chars(digits.data(), digits.data() + digits.size(), expected, 16);
    const bool read = digits.size() == 2 && status == std::errc() && stop == digits.data() + 2;
    return read && expected == sum ? Checksum::good : Checksum::bad;
}

std::vector<std::string_view> split_fields(std::string_view payload) {
    std::vector<std::string_view> fields;
    for (;;) {
        const std::size_t end = payload.find(',');
        fields.push_back(payload.substr(0, end));
        if (end == std::string_view::npos) return fields;
        payload.remove_prefix(end + 1);
    }
}

// A date and the time of day at which it was said.
struct DateMark {
    UtcTime midnight;
    double seconds = 0;
};

// Takes sentences one by one and keeps what the next one needs.
class NmeaLogReader {
public:
    explicit NmeaLogReader(const std::string& name) { series_.name = name; }
    Result<FixSeries> read(std::string_view text);

private:
    std::optional<Error> take_sentence(std::string_view sentence);
    std::optional<Error> take_gga(const std::vector<std::string_view>& fields);
    std::optional<Error> take_position(const std::vector<std::string_view>& fields, FixSample& sample);
    void take_rmc(const std::vector<std::string_view>& fields);
    void date_samples();
    void add_warnings();
    [[nodiscard]] Error error(const std::string& what) const {
        return {ErrorCode::input, fmt::format("{}:{}: {}", series_.name, line_, what)};
    }

    FixSeries series_;
    std::size_t line_ = 1;
    std::size_t bad_checksums_ = 0, without_checksum_ = 0, without_separation_ = 0;
    // For each sample its time of day and the number of dates said before it.
    struct Clock {
        std::optional<double> seconds;
        std::size_t dates_before = 0;
    };
    std::vector<Clock> clocks_;
    std::vector<DateMark> dates_;
};

Result<FixSeries> NmeaLogReader::read(std::string_view text) {
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == '\n') ++line_;
        if (text[at] != '$' || !sentence_starts_at(text, at)) continue;
        if (auto wrong = take_sentence(text.substr(at))) return fail(std::move(*wrong));
    }
    date_samples();
    add_warnings();
    return std::move(series_);
}

std::optional<Error> NmeaLogReader::take_sentence(std::string_view sentence) {
    const std::string_view kind = sentence.substr(3, 3);
    if (sentence[1] == 'P' || (kind != "GGA" && kind != "RMC")) return std::nullopt;
    std::string_view payload;
    const Checksum checksum = verify(sentence, payload);
    if (checksum != Checksum::good) {
        ++(checksum == Checksum::bad ? bad_checksums_ : without_checksum_);
        return std::nullopt;
    }
    const std::vector<std::string_view> fields = split_fields(payload);
    if (kind == "GGA") return take_gga(fields);
    take_rmc(fields);
    return std::nullopt;
}

std::optional<Error> NmeaLogReader::take_gga(const std::vector<std::string_view>& fields) {
    if (fields.size() < 12) return error(fmt::format("GGA has {} fields, expected at least 12", fields.size()));
    FixSample sample;
    const std::optional<double> seconds = time_of_day(fields[1]);
    if (!fields[1].empty() && !seconds)
        return error(fmt::format("GGA time is '{}'; expected hhmmss", fields[1].substr(0, 20)));
    sample.has_fix = !fields[6].empty() && fields[6] != "0" && !fields[2].empty() && !fields[4].empty();
    if (sample.has_fix)
        if (auto wrong = take_position(fields, sample)) return wrong;
    series_.samples.push_back(sample);
    clocks_.push_back({seconds, dates_.size()});
    return std::nullopt;
}

std::optional<Error> NmeaLogReader::take_position(const std::vector<std::string_view>& fields, FixSample& sample) {
    const std::optional<double> latitude = coordinate(fields[2], fields[3], "NS");
    const std::optional<double> longitude = coordinate(fields[4], fields[5], "EW");
    const std::optional<double> altitude = field_number(fields[9]);
    if (!latitude || !longitude || !altitude)
        return error(fmt::format("GGA position is '{},{},{},{},{}'; expected ddmm.mm,N|S,dddmm.mm,E|W,metres",
                                 fields[2], fields[3], fields[4], fields[5], fields[9]));
    const std::optional<double> separation = field_number(fields[11]);
    if (!separation) ++without_separation_;
    const auto position = checked_position(*latitude, *longitude, *altitude + separation.value_or(0));
    if (!position) return error("GGA " + position.error());
    sample.position = *position;
    return std::nullopt;
}

void NmeaLogReader::take_rmc(const std::vector<std::string_view>& fields) {
    if (fields.size() < 10 || fields[2] != "A") return;
    const std::optional<double> seconds = time_of_day(fields[1]);
    const std::optional<UtcTime> midnight = date(fields[9]);
    if (seconds && midnight) dates_.push_back({*midnight, *seconds});
}

// A sample belongs to the day that puts it within half a day of the last date said, or of the first one that follows.
// Without any date, days are counted from the start of the log.
void NmeaLogReader::date_samples() {
    series_.dated = !dates_.empty();
    double days = 0;
    double before = std::numeric_limits<double>::lowest();
    for (std::size_t i = 0; i < clocks_.size(); ++i) {
        if (!clocks_[i].seconds) continue;
        const double seconds = *clocks_[i].seconds;
        if (!series_.dated) {
            if (seconds < before - half_day) ++days;
            before = seconds;
            series_.samples[i].time = GpsTime(to_nanoseconds(Seconds(days * day + seconds)));
            continue;
        }
        const DateMark& mark = dates_[clocks_[i].dates_before == 0 ? 0 : clocks_[i].dates_before - 1];
        const double shift = seconds - mark.seconds > half_day ? -day : (mark.seconds - seconds > half_day ? day : 0);
        series_.samples[i].time =
            advanced(to_gps_time(mark.midnight, LeapSeconds::announced()), Seconds(shift + seconds));
    }
}

void NmeaLogReader::add_warnings() {
    if (bad_checksums_ > 0)
        series_.warnings.push_back(fmt::format("{}: {} GGA or RMC sentences with a wrong checksum were skipped",
                                               series_.name, bad_checksums_));
    if (without_checksum_ > 0)
        series_.warnings.push_back(fmt::format("{}: {} GGA or RMC sentences without a checksum were skipped",
                                               series_.name, without_checksum_));
    if (without_separation_ > 0)
        series_.warnings.push_back(
            fmt::format("{}: {} fixes without geoid separation; their heights are above sea level, "
                        "not above the ellipsoid",
                        series_.name, without_separation_));
}

}  // namespace

bool has_nmea_sentence(std::string_view text) {
    constexpr std::size_t far_enough = std::size_t{1} << 16;
    const std::string_view start = text.substr(0, far_enough);
    for (std::size_t at = start.find('$'); at != std::string_view::npos; at = start.find('$', at + 1))
        if (sentence_starts_at(start, at)) return true;
    return false;
}

Result<FixSeries> parse_nmea_log(std::string_view text, const std::string& name) {
    return NmeaLogReader(name).read(text);
}

}  // namespace skyloop
