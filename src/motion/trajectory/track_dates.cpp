#include "detail/track_dates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/core/middle.hpp"

namespace skyloop {

void TrackDates::add(Nanoseconds counted, Nanoseconds dated) {
    offsets_.push_back(dated - counted);
    whole_seconds_ &= dated % std::chrono::seconds(1) == Nanoseconds(0);
}

std::optional<Nanoseconds> TrackDates::of_count_zero() const {
    constexpr Nanoseconds together = std::chrono::seconds(2), cut = std::chrono::seconds(1);
    constexpr std::size_t of_ten = 10, fewest = 9;
    if (empty()) return std::nullopt;
    std::vector<Nanoseconds> sorted = offsets_;
    const Nanoseconds middle = middle_of(sorted);
    std::size_t agreeing = 0;
    Nanoseconds latest = middle;
    for (const Nanoseconds offset : offsets_) {
        if (std::chrono::abs(offset - middle) <= together) ++agreeing;
        if (std::chrono::abs(offset - middle) <= cut) latest = std::max(latest, offset);
    }
    if (agreeing * of_ten < offsets_.size() * fewest) return std::nullopt;
    return whole_seconds_ ? latest : middle;
}

void TrackDates::date(Track& track, const std::string& count, const std::string& date) const {
    const auto zero = of_count_zero();
    if (!zero)
        return track.notes.push_back(fmt::format("times are those of {} alone: {} {}", count, date,
                                                 empty() ? "tells none" : "does not run with it"));
    track.notes.push_back(fmt::format("times count by {}; what GPS time that is follows from {}", count, date));
    track.origin = GpsTime{};
    for (TrackRow& row : track.points)
        row.time += *zero;
}

}  // namespace skyloop
