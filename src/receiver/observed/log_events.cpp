#include "receiver/observed/log_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/core/std_additions.hpp"

namespace skyloop::inline receiver {
namespace {

// A satellite's C/N0 over the epochs of the log.
struct Strength {
    std::vector<double> cn0;  // 0: not tracked
    std::vector<int> elevation;
    std::vector<double> level;  // its own, by the median around; 0: unknown
};

class EventFinder {
public:
    EventFinder(const ObservedLog& log, const EventLimits& limits) : epochs_(log.epochs), limits_(limits) {}
    LogEvents find();

private:
    void find_period();
    void find_silences();
    void find_losses();
    void add_loss(std::size_t begin, std::size_t end);
    void find_types();
    void collect_strengths();
    void set_level(Strength& strength) const;
    void find_drops();
    void find_satellite_events();
    void find_weak(SatelliteId id, const Strength& strength);
    void find_away(SatelliteId id, const Strength& strength);

    // A receiver that solves the time alone, at a place that it was told, has its signals.
    [[nodiscard]] bool lost(std::size_t i) const {
        return (epochs_[i].is_lost() && epochs_[i].type != FixType::time_only) ||
               (epochs_[i].lists_satellites && epochs_[i].signals.empty());
    }
    [[nodiscard]] Nanoseconds at(std::size_t i) const { return epochs_[i].time - epochs_.front().time; }
    // Of the epochs before `end`: the next epoch begins, or would.
    [[nodiscard]] Nanoseconds after(std::size_t end) const {
        const Nanoseconds due = at(end - 1) + found_.period;
        return end < epochs_.size() ? std::min(due + found_.period / 2, at(end)) : due;
    }
    // Calls body(begin, end) for each run of epochs for which `same` of neighbours holds and `wanted` of the first.
    template <class Wanted, class Same, class Body>
    void runs(Wanted wanted, Same same, Body body) const;
    void add(LogEvent event) { found_.events.push_back(std::move(event)); }

    const std::vector<ObservedEpoch>& epochs_;
    const EventLimits& limits_;
    LogEvents found_;
    std::map<SatelliteId, Strength> strengths_;
    std::vector<double> overall_;  // how far all satellites together are below their level, dB
    std::vector<LogEvent> of_satellites_;
};

template <class Wanted, class Same, class Body>
void EventFinder::runs(Wanted wanted, Same same, Body body) const {
    for (std::size_t begin = 0; begin < epochs_.size();) {
        std::size_t end = begin + 1;
        if (wanted(begin)) {
            while (end < epochs_.size() && wanted(end) && same(begin, end))
                ++end;
            body(begin, end);
        }
        begin = end;
    }
}

void EventFinder::find_period() {
    std::vector<double> steps;
    for (std::size_t i = 1; i < epochs_.size(); ++i)
        steps.push_back(static_cast<double>((epochs_[i].time - epochs_[i - 1].time).count()));
    found_.period =
        steps.empty() ? Nanoseconds(std::chrono::seconds(1)) : Nanoseconds(static_cast<std::int64_t>(middle_of(steps)));
}

void EventFinder::find_silences() {
    for (std::size_t i = 1; i < epochs_.size(); ++i) {
        const Nanoseconds step = at(i) - at(i - 1);
        if (step * 2 <= found_.period * 3) continue;
        const Nanoseconds first = at(i - 1) + found_.period;
        add({LogEventKind::silent,
             first,
             at(i) - first,
             {},
             0,
             {},
             fmt::format("{} epochs are missing", (step - found_.period / 2).count() / found_.period.count())});
    }
}

void EventFinder::find_losses() {
    runs([&](std::size_t i) { return lost(i); }, [](std::size_t, std::size_t) { return true; },
         [&](std::size_t begin, std::size_t end) { add_loss(begin, end); });
}

// The signals are back before the receiver shows it, by the time that it takes to find them: where satellites are
// listed the lists tell that, else the fix. From there on the emulated receiver takes its own time.
void EventFinder::add_loss(std::size_t begin, std::size_t end) {
    std::size_t first = end, last = begin;
    bool listed = true;
    for (std::size_t i = begin; i < end; ++i) {
        listed &= epochs_[i].lists_satellites;
        if (!epochs_[i].lists_satellites || !epochs_[i].signals.empty()) continue;
        first = std::min(first, i);
        last = i;
    }
    const bool tracked = listed && first == end;
    if (!listed || tracked) first = begin, last = end - 1;
    LogEvent event;
    event.kind = LogEventKind::signals_lost;
    event.at = at(first);
    event.lasts = after(last + 1) - event.at;
    if (!tracked && last + 1 < epochs_.size())
        event.lasts = std::max(found_.period, event.lasts - to_nanoseconds(limits_.reacquisition));
    event.seen = fmt::format("{} epochs without a fix, ", end - begin);
    event.seen += tracked  ? "though satellites are tracked"
                  : listed ? fmt::format("{} of them without any satellite", last + 1 - first)
                           : "and no list of satellites";
    add(std::move(event));
}

// 3D is what the emulated receiver says by itself.
void EventFinder::find_types() {
    std::size_t left_out = 0, kept = 0;
    runs([&](std::size_t i) { return !lost(i) && epochs_[i].type != FixType::fix_3d; },
         [&](std::size_t a, std::size_t b) { return epochs_[a].type == epochs_[b].type; },
         [&](std::size_t begin, std::size_t end) {
             if (kept >= limits_.most_of_types) return static_cast<void>(++left_out);
             ++kept;
             add({LogEventKind::fix_type,
                  at(begin),
                  after(end) - at(begin),
                  epochs_[begin].type,
                  0,
                  {},
                  fmt::format("{} epochs say {}", end - begin, fix_type_name(epochs_[begin].type))});
         });
    if (left_out > 0) found_.notes.push_back(fmt::format("{} more changes of the type of fix were left out", left_out));
}

void EventFinder::collect_strengths() {
    for (std::size_t i = 0; i < epochs_.size(); ++i)
        for (const ObservedSignal& satellite : epochs_[i].signals) {
            Strength& strength = strengths_[satellite.id];
            if (strength.cn0.empty()) {
                strength.cn0.resize(epochs_.size());
                strength.elevation.resize(epochs_.size(), 90);
            }
            strength.cn0[i] = satellite.cn0_dbhz;
            strength.elevation[i] = satellite.elevation_deg.value_or(90);
        }
    for (auto& [id, strength] : strengths_)
        set_level(strength);
    overall_.assign(epochs_.size(), 0);
    constexpr std::size_t fewest = 4;
    for (std::size_t i = 0; i < epochs_.size(); ++i) {
        std::vector<double> below;
        for (const ObservedSignal& satellite : epochs_[i].signals) {
            const Strength& strength = strengths_.at(satellite.id);
            if (strength.level[i] > 0) below.push_back(strength.level[i] - strength.cn0[i]);
        }
        if (below.size() >= fewest) overall_[i] = middle_of(below);
    }
}

// The median of at most 121 values from a window around; one level serves for a tenth of the window.
void EventFinder::set_level(Strength& strength) const {
    constexpr std::size_t most = 121, fewest = 5;
    strength.level.assign(epochs_.size(), 0);
    const double period_s = std::max(1e-3, to_seconds(found_.period).value());
    const auto half = static_cast<std::size_t>(std::max(1.0, limits_.window.value() / period_s));
    const std::size_t stride = std::max<std::size_t>(1, 2 * half / most), hold = std::max<std::size_t>(1, half / 10);
    for (std::size_t begin = 0; begin < epochs_.size(); begin += hold) {
        std::vector<double> values;
        for (std::size_t i = begin < half ? 0 : begin - half; i < std::min(begin + half, epochs_.size()); i += stride)
            if (strength.cn0[i] > 0) values.push_back(strength.cn0[i]);
        const double level = values.size() < fewest ? 0 : middle_of(values);
        for (std::size_t i = begin; i < std::min(begin + hold, epochs_.size()); ++i)
            strength.level[i] = level;
    }
}

void EventFinder::find_drops() {
    runs([&](std::size_t i) { return overall_[i] >= limits_.drop_db; }, [](std::size_t, std::size_t) { return true; },
         [&](std::size_t begin, std::size_t end) {
             const Nanoseconds lasts = after(end) - at(begin);
             if (lasts < to_nanoseconds(limits_.least)) return;
             std::vector<double> depths(overall_.begin() + static_cast<std::ptrdiff_t>(begin),
                                        overall_.begin() + static_cast<std::ptrdiff_t>(end));
             const double depth = middle_of(depths);
             add({LogEventKind::drop,
                  at(begin),
                  lasts,
                  {},
                  depth,
                  {},
                  fmt::format("the C/N0 of all satellites is {:.0f} dB below their level", depth)});
         });
}

void EventFinder::find_weak(SatelliteId id, const Strength& s) {
    const auto below = [&](std::size_t i) { return s.level[i] - s.cn0[i] - std::max(0.0, overall_[i]); };
    runs(
        [&](std::size_t i) {
            return s.cn0[i] > 0 && s.level[i] > 0 && s.elevation[i] >= limits_.elevation_deg &&
                   below(i) >= limits_.satellite_drop_db;
        },
        [](std::size_t, std::size_t) { return true; },
        [&](std::size_t begin, std::size_t end) {
            const Nanoseconds lasts = after(end) - at(begin);
            if (lasts < to_nanoseconds(limits_.satellite_least)) return;
            std::vector<double> depths;
            for (std::size_t i = begin; i < end; ++i)
                depths.push_back(below(i));
            const double depth = middle_of(depths);
            of_satellites_.push_back(
                {LogEventKind::satellite_drop,
                 at(begin),
                 lasts,
                 {},
                 depth,
                 id,
                 fmt::format("the C/N0 of {} is {:.0f} dB below its level, beyond that of all", to_string(id), depth)});
        });
}

// Gone while others are there, and back later: neither risen nor set.
void EventFinder::find_away(SatelliteId id, const Strength& s) {
    const auto away = [&](std::size_t i) { return s.cn0[i] <= 0 && epochs_[i].lists_satellites && !lost(i); };
    runs(
        away, [](std::size_t, std::size_t) { return true; },
        [&](std::size_t begin, std::size_t end) {
            const bool between = begin > 0 && end < epochs_.size() && s.cn0[begin - 1] > 0 && s.cn0[end] > 0;
            if (!between || s.elevation[begin - 1] < limits_.elevation_deg || s.elevation[end] < limits_.elevation_deg)
                return;
            const Nanoseconds lasts = after(end) - at(begin);
            if (lasts < to_nanoseconds(limits_.satellite_least)) return;
            of_satellites_.push_back({LogEventKind::satellite_lost,
                                      at(begin),
                                      lasts,
                                      {},
                                      0,
                                      id,
                                      fmt::format("{} is not tracked, and before and after it is", to_string(id))});
        });
}

void EventFinder::find_satellite_events() {
    for (const auto& [id, strength] : strengths_) {
        find_weak(id, strength);
        find_away(id, strength);
    }
    std::stable_sort(of_satellites_.begin(), of_satellites_.end(),
                     [](const LogEvent& a, const LogEvent& b) { return a.lasts > b.lasts; });
    if (of_satellites_.size() > limits_.most_of_satellites) {
        found_.notes.push_back(fmt::format("{} shorter events of single satellites were left out",
                                           of_satellites_.size() - limits_.most_of_satellites));
        of_satellites_.resize(limits_.most_of_satellites);
    }
    for (LogEvent& event : of_satellites_)
        add(std::move(event));
}

LogEvents EventFinder::find() {
    find_period();
    find_silences();
    find_losses();
    find_types();
    collect_strengths();
    find_drops();
    find_satellite_events();
    std::stable_sort(found_.events.begin(), found_.events.end(),
                     [](const LogEvent& a, const LogEvent& b) { return a.at < b.at; });
    return std::move(found_);
}

}  // namespace

LogEvents find_events(const ObservedLog& log, const EventLimits& limits) { return EventFinder(log, limits).find(); }

}  // namespace skyloop::inline receiver
