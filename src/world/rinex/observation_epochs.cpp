#include "detail/observation_epochs.hpp"

#include <chrono>
#include <cmath>

#include "base/time/utc_time.hpp"

namespace skyloop::inline world::rinex {
namespace {

// Columns of the parts of an epoch's first line.
struct EpochColumns {
    std::size_t year, year_width, month, second, flag, count;
};
constexpr EpochColumns epoch_columns_2{1, 2, 4, 15, 28, 29};
constexpr EpochColumns epoch_columns_3{2, 4, 7, 18, 31, 32};

std::optional<GpsTime> epoch_time(std::string_view line, const EpochColumns& at) {
    const auto part = [&](std::size_t i) { return whole_field(columns(line, at.month + 3 * i, 2)); };
    const std::string_view year_text = columns(line, at.year, at.year_width);
    if (is_blank(year_text)) return std::nullopt;
    std::optional<int> year = whole_field(year_text);
    if (year && at.year_width == 2) year = full_year(*year);
    return calendar_epoch({year, part(0), part(1), part(2), part(3), real_field(columns(line, at.second, 11))}, {});
}

// A field of an observation: F14.3 and two digits.
struct ObservedValue {
    std::optional<double> value;
    int lock = 0;      // loss-of-lock indicator
    int strength = 0;  // digit 1 … 9
};

int digit_or_zero(std::string_view field, std::size_t at) {
    return at < field.size() && field[at] >= '0' && field[at] <= '9' ? field[at] - '0' : 0;
}

// What receivers measure, with room for clocks far off.
struct ObservedRange {
    double least, most;
    std::string_view expected;
};
constexpr ObservedRange pseudorange_range{-1e10, 1e10, "a pseudorange in metres"};
constexpr ObservedRange phase_range{-1e11, 1e11, "a carrier phase in cycles"};
constexpr ObservedRange doppler_range{-1e6, 1e6, "a Doppler shift in hertz"};
constexpr ObservedRange strength_range{-1000, 1000, "a signal strength in dB-Hz"};

class FieldReading {
public:
    FieldReading(const SatelliteRecord& record, const SystemLayout& layout, std::vector<BadField>& bad)
        : record_(record), layout_(layout), bad_(bad) {}

    ObservedValue take(int column, const ObservedRange& range) {
        if (column < 0) return {};
        const std::string_view field = record_.field(column);
        ObservedValue result{std::nullopt, digit_or_zero(field, 14), digit_or_zero(field, 15)};
        const std::optional<double> number = real_field(columns(field, 0, 14));
        if (!number || *number < range.least || *number > range.most)
            bad_.push_back({in_quotes(columns(field, 0, 14)), std::string(range.expected)});
        else if (*number != 0)
            result.value = *number / layout_.scale[static_cast<std::size_t>(column)];
        return result;
    }

private:
    const SatelliteRecord& record_;
    const SystemLayout& layout_;
    std::vector<BadField>& bad_;
};

DbHz strength_of(const ObservedValue& measured, int digit) {
    constexpr double step = 6;
    if (measured.value) return DbHz(*measured.value);
    return DbHz(digit > 0 ? step * digit + step / 2 : 0);
}

// The observation of one code, or nothing when it measured neither range nor phase nor Doppler.
std::optional<Observation> observed_code(const CodeColumns& code, FieldReading& fields) {
    Observation o;
    const ObservedValue range = fields.take(code.pseudorange, pseudorange_range);
    const ObservedValue phase = fields.take(code.phase, phase_range);
    const ObservedValue doppler = fields.take(code.doppler, doppler_range);
    if (!range.value && !phase.value && !doppler.value) return std::nullopt;
    if (range.value) o.pseudorange = Metres(*range.value);
    if (doppler.value) o.doppler = Hertz(*doppler.value);
    o.carrier_phase = phase.value;
    if (phase.value) {
        o.slipped = (phase.lock & 1) != 0;
        o.half_cycle_resolved = (phase.lock & 2) == 0;
    }
    o.cn0 =
        strength_of(fields.take(code.strength, strength_range), phase.strength > 0 ? phase.strength : range.strength);
    return o;
}

}  // namespace

std::optional<EpochHead> epoch_head(std::string_view line, int major) {
    const EpochColumns& at = major == 2 ? epoch_columns_2 : epoch_columns_3;
    if (major >= 3 && !line.starts_with('>')) return std::nullopt;
    const std::optional<int> flag = whole_field(columns(line, at.flag, 1));
    const std::optional<int> count = whole_field(columns(line, at.count, 3));
    if (!flag || *flag < 0 || *flag > 6 || !count || *count < 0 || is_blank(columns(line, at.count, 3)))
        return std::nullopt;
    EpochHead head{epoch_time(line, at), *flag, *count};
    if (!head.time && !head.event()) return std::nullopt;
    return head;
}

std::string_view SatelliteRecord::field(int index) const {
    constexpr std::size_t width = 16, per_line = 5;
    const auto i = static_cast<std::size_t>(index);
    if (major_ >= 3) return columns(lines_.front().text, 3 + width * i, width);
    return i / per_line < lines_.size() ? columns(lines_[i / per_line].text, width * (i % per_line), width)
                                        : std::string_view{};
}

void SignalReading::break_all() {
    for (auto& [signal, history] : phases_)
        history.broken = true;
}

void SignalReading::break_phases(SatelliteId satellite) {
    for (auto& [signal, history] : phases_)
        if (signal.first == satellite) history.broken = true;
}

void SignalReading::append(const SatelliteRecord& record, const SystemLayout& layout, int channel, Observations& epoch,
                           std::vector<BadField>& bad) {
    FieldReading fields(record, layout, bad);
    for (const SignalColumns& signal : layout.signals) {
        std::optional<Observation> best;
        std::size_t best_code = 0;
        for (std::size_t i = 0; i < signal.codes.size() && !(best && best->pseudorange); ++i) {
            std::optional<Observation> o = observed_code(signal.codes[i], fields);
            if (!o || (best && !o->pseudorange)) continue;
            best = std::move(o);
            best_code = i;
        }
        if (!best) continue;
        best->satellite = record.satellite();
        best->signal = signal.signal;
        best->carrier = carrier_frequency(signal.signal, channel);
        follow_phase(*best, epoch.receive_time, best_code);
        epoch.signals.push_back(std::move(*best));
    }
}

void SignalReading::follow_phase(Observation& observation, GpsTime time, std::size_t code) {
    if (!observation.carrier_phase) return;
    const auto entry = phases_.try_emplace({observation.satellite, observation.signal}, PhaseHistory{time, code}).first;
    PhaseHistory& history = entry->second;
    if (history.broken || history.code != code) observation.slipped = true;
    history.broken = false;
    if (observation.slipped) history.since = time;
    history.code = code;
    observation.lock_time = difference(time, history.since);
}

}  // namespace skyloop::inline world::rinex
