#include <fmt/format.h>

#include <array>

#include "base/core/letter_case.hpp"
#include "detail/table_cells.hpp"

namespace skyloop {
namespace {

// The log of Android's GnssLogger (gps-measurement-tools): lines of several kinds, of which Fix has the places. A
// comment names its columns, which changed over the versions; heights are above the ellipsoid
// (android.location.Location).
class GnssLoggerReader {
public:
    explicit GnssLoggerReader(const TrackFile& file) : track_(file, "GnssLogger", "fixes"), table_(file, ',', "") {}
    Result<Track> read();

private:
    // As many as a phone has: its receiver, its fusion with other sensors, its networks.
    static constexpr std::array<std::string_view, 3> providers{"gps", "flp", "nlp"};
    void take_names();
    Result<void> take_fix();
    [[nodiscard]] std::optional<std::size_t> column(std::string_view meaning) const;

    TextTrack track_;
    TableCells table_;
    std::vector<std::string> names_{"fix",   "provider", "latitude", "longitude", "altitude",
                                    "speed", "accuracy", "bearing",  "unixtime"};
    std::array<std::vector<TextRow>, providers.size()> rows_;
};

Result<Track> GnssLoggerReader::read() {
    while (table_.next()) {
        const std::string kind = lower_case(table_.cell(0));
        if (kind == "# fix" || kind == "#fix") take_names();
        if (kind != "fix") continue;
        if (const auto taken = take_fix(); !taken) return fail(taken.error());
    }
    bool taken = false;
    for (std::size_t i = 0; i < providers.size(); ++i) {
        if (rows_[i].empty()) continue;
        if (taken) {
            track_.note(
                fmt::format("{} fixes of the provider {} are not part of the path", rows_[i].size(), providers[i]));
            continue;
        }
        taken = true;
        if (i > 0) track_.note(fmt::format("no fixes of the receiver itself; those of {} are taken", providers[i]));
        for (const TextRow& row : rows_[i])
            if (const auto added = track_.add(row); !added) return fail(added.error());
    }
    return track_.finish("lines 'Fix,gps,…' with a time and a place");
}

void GnssLoggerReader::take_names() {
    names_.clear();
    for (const std::string_view cell : table_.cells())
        names_.push_back(lower_case(cell));
}

// The first column whose name begins so: "latitude" and "latitudedegrees" alike.
std::optional<std::size_t> GnssLoggerReader::column(std::string_view meaning) const {
    for (std::size_t i = 0; i < names_.size(); ++i)
        if (names_[i].starts_with(meaning)) return i;
    return std::nullopt;
}

Result<void> GnssLoggerReader::take_fix() {
    TextRow row;
    row.line = table_.line();
    const auto latitude = table_.coordinate(column("latitude"), Coordinate::latitude),
               longitude = table_.coordinate(column("longitude"), Coordinate::longitude);
    const auto altitude = table_.number(column("altitude")), speed = table_.number(column("speed"));
    const auto bearing = table_.number(column("bearing"));
    Result<std::optional<double>> millis = table_.number(column("unixtime"));
    if (millis && !*millis) millis = table_.number(column("(utc)time"));
    for (const auto& value : {latitude, longitude, altitude, speed, bearing, millis})
        if (!value) return fail(value.error());
    if (!*latitude || !*longitude) return track_.leave_out("have no place", row.line), Result<void>();
    const auto time = *millis ? posix_since_1980(fmt::format("{:.3f}", **millis / 1000)) : std::nullopt;
    if (!time) return track_.leave_out("have no time from 1980-01-06 to 2199", row.line), Result<void>();
    row.time = *time;
    row.latitude_deg = **latitude, row.longitude_deg = **longitude;
    row.ellipsoidal_m = *altitude;
    row.speed_mps = *speed;
    row.course_deg = *bearing;
    const std::string provider = lower_case(table_.cell(column("provider")));
    const std::size_t which = provider == "gps" ? 0 : provider == "nlp" || provider == "network" ? 2 : 1;
    rows_[which].push_back(row);
    return {};
}

}  // namespace

Result<Track> read_gnss_logger(const TrackFile& file) { return GnssLoggerReader(file).read(); }

}  // namespace skyloop
