#include "skyloop/tracks/read_track.hpp"

#include "track_formats.hpp"

#include <array>

#include "skyloop/trajectory/track_csv.hpp"

namespace skyloop {
namespace {

// One format. Formats are tried in the order of the table.
struct TrackFormat {
    std::array<std::string_view, 3> endings;  // with their dots; empty ones count for nothing
    bool (*fits)(const TrackFile&);           // by the content
    Result<Track> (*read)(const TrackFile&);
};

Result<Track> read_csv(const TrackFile& file) { return read_track_csv(file.text, file.name, file.reading.geoid); }

constexpr TrackFormat formats[] = {
    {{".csv", ".txt", ""}, [](const TrackFile&) { return true; }, read_csv},
};

}  // namespace

Result<Track> read_track(ByteSpan bytes, const std::string& name, const TrackReading& reading) {
    const TrackFile file{bytes, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name, reading};
    for (const TrackFormat& format : formats)
        if (format.fits(file)) return format.read(file);
    return read_csv(file);
}

std::vector<std::string_view> track_endings() {
    std::vector<std::string_view> endings;
    for (const TrackFormat& format : formats)
        for (const std::string_view ending : format.endings)
            if (!ending.empty()) endings.push_back(ending);
    return endings;
}

}  // namespace skyloop
