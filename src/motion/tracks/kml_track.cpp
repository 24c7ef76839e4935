#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "base/core/archive.hpp"
#include "base/core/words.hpp"
#include "base/core/written_place.hpp"
#include "detail/text_track.hpp"
#include "detail/xml_tree.hpp"

namespace skyloop::inline motion {
namespace {

// KML 2.2 (OGC 07-147r2) with Google's gx:Track: the n-th <when> belongs to the n-th <gx:coord>. Without such a track,
// placemarks of one point with a TimeStamp, or the begin of a TimeSpan, each (FEEDS.md 1.4).
class KmlReader {
public:
    explicit KmlReader(const TrackFile& file) : file_(file), track_(file, "KML", "points") {}
    Result<Track> read();

private:
    enum class Altitudes { sea_level, ground, none };
    struct Coordinates {
        double longitude_deg = 0, latitude_deg = 0;
        std::optional<double> altitude_m;
    };
    Result<void> take_tracks();
    Result<void> take_track(const pugi::xml_node& track, bool joined);
    Result<void> take_pair(const pugi::xml_node& when, const pugi::xml_node& coord, TextRow& row);
    Result<void> take_placemarks();
    Result<void> take_line();
    Result<void> take_points();
    Result<std::optional<Nanoseconds>> time_of(const pugi::xml_node& when, std::size_t line);
    Result<bool> take_coordinates(const std::string& text, std::string_view separators, TextRow& row);
    Altitudes altitudes_of(const pugi::xml_node& holder);
    Result<Track> refused();
    Result<Track> finish();

    const TrackFile& file_;
    XmlTree tree_;
    TextTrack track_;
    Altitudes altitudes_ = Altitudes::sea_level;
    std::size_t clamped_ = 0, above_ground_ = 0, angles_ = 0, without_zone_ = 0, without_clock_ = 0;
};

Result<Track> KmlReader::read() {
    auto tree = XmlTree::of(file_);
    if (!tree) return fail(tree.error());
    tree_ = std::move(*tree);
    if (const auto taken = take_tracks(); !taken) return fail(taken.error());
    if (track_.rows() == 0)
        if (const auto taken = take_placemarks(); !taken) return fail(taken.error());
    if (track_.rows() == 0)
        if (const auto taken = take_line(); !taken) return fail(taken.error());
    if (track_.rows() == 0)
        if (const auto taken = take_points(); !taken) return fail(taken.error());
    return track_.rows() == 0 ? refused() : finish();
}

Result<void> KmlReader::take_tracks() {
    const pugi::xml_node root = tree_.root();
    for (pugi::xml_node at = root; at; at = xml_following(at, root)) {
        if (xml_name(at) != "Track") continue;
        const pugi::xml_node group = at.parent();
        const bool grouped = xml_name(group) == "MultiTrack";
        const bool first = !grouped || xml_child(group, "Track") == at;
        const bool joined = !first && trimmed_cell(xml_content(xml_child(group, "interpolate"))) == "1";
        if (first) track_.begin_part(xml_content(xml_child(grouped ? group.parent() : group, "name")));
        if (const auto taken = take_track(at, joined); !taken) return taken;
    }
    return {};
}

Result<void> KmlReader::take_track(const pugi::xml_node& track, bool joined) {
    std::vector<pugi::xml_node> whens, coords;
    for (const pugi::xml_node& child : track.children()) {
        if (xml_name(child) == "when") whens.push_back(child);
        if (xml_name(child) == "coord") coords.push_back(child);
        if (xml_name(child) == "angles") ++angles_;
    }
    if (whens.size() != coords.size())
        return track_.refusal(tree_.line_of(track), fmt::format("a gx:Track with {} <when> and {} <gx:coord>; expected "
                                                                "as many of the one as of the other",
                                                                whens.size(), coords.size()));
    altitudes_ = altitudes_of(track);
    bool begins = !joined;
    for (std::size_t i = 0; i < whens.size(); ++i) {
        TextRow row;
        row.jump = begins;
        const std::size_t before = track_.taken();
        if (const auto taken = take_pair(whens[i], coords[i], row); !taken) return taken;
        if (track_.taken() > before) begins = false;
    }
    return {};
}

Result<void> KmlReader::take_pair(const pugi::xml_node& when, const pugi::xml_node& coord, TextRow& row) {
    row.line = tree_.line_of(coord);
    const auto time = time_of(when, row.line);
    if (!time) return fail(time.error());
    const auto placed = take_coordinates(xml_content(coord), " \t\r\n", row);
    if (!placed) return fail(placed.error());
    if (!*placed) return track_.leave_out("have no place", row.line), Result<void>();
    if (!*time) return {};
    row.time = **time;
    return track_.add(row);
}

Result<void> KmlReader::take_placemarks() {
    const pugi::xml_node root = tree_.root();
    for (pugi::xml_node at = root; at; at = xml_following(at, root)) {
        if (xml_name(at) != "Placemark") continue;
        const pugi::xml_node stamp = xml_child(xml_child(at, "TimeStamp"), "when"), point = xml_child(at, "Point");
        const pugi::xml_node when = stamp ? stamp : xml_child(xml_child(at, "TimeSpan"), "begin");
        if (!when || !point) continue;
        TextRow row;
        row.line = tree_.line_of(point);
        altitudes_ = altitudes_of(point);
        const auto time = time_of(when, row.line);
        if (!time) return fail(time.error());
        const auto placed = take_coordinates(xml_content(xml_child(point, "coordinates")), ", \t\r\n", row);
        if (!placed) return fail(placed.error());
        if (!*placed) track_.leave_out("have no place", row.line);
        if (!*time || !*placed) continue;
        row.time = **time;
        if (const auto added = track_.add(row); !added) return added;
    }
    return {};
}

// The places of the longest LineString are a route: it has no times.
Result<void> KmlReader::take_line() {
    const pugi::xml_node root = tree_.root();
    pugi::xml_node longest;
    std::size_t lines = 0, most = 0;
    for (pugi::xml_node at = root; at; at = xml_following(at, root)) {
        if (xml_name(at) != "LineString") continue;
        ++lines;
        const std::size_t size = xml_content(xml_child(at, "coordinates")).size();
        if (size > most) most = size, longest = at;
    }
    if (most == 0) return {};
    if (lines > 1) track_.note(fmt::format("of its {} LineStrings the longest is taken", lines));
    altitudes_ = altitudes_of(longest);
    const std::string text = xml_content(xml_child(longest, "coordinates"));
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t line = tree_.line_of(longest);
    for (std::size_t at = text.find_first_not_of(blanks); at != std::string::npos;) {
        const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
        TextRow row;
        row.line = line;
        const auto placed = take_coordinates(text.substr(at, end - at), ",", row);
        if (!placed) return fail(placed.error());
        if (*placed)
            if (const auto added = track_.add_untimed(row, "have no time"); !added) return added;
        at = text.find_first_not_of(blanks, end);
    }
    return {};
}

// Placemarks without times, in the order of the file.
Result<void> KmlReader::take_points() {
    const pugi::xml_node root = tree_.root();
    for (pugi::xml_node at = root; at; at = xml_following(at, root)) {
        if (xml_name(at) != "Point") continue;
        TextRow row;
        row.line = tree_.line_of(at);
        altitudes_ = altitudes_of(at);
        const auto placed = take_coordinates(xml_content(xml_child(at, "coordinates")), ", \t\r\n", row);
        if (!placed) return fail(placed.error());
        if (!*placed) continue;
        if (const auto added = track_.add_untimed(row, "have no time"); !added) return added;
    }
    if (track_.rows() > 0) track_.note("its points are taken as a route, in the order of the file");
    return {};
}

// Nothing: the point has none and is left out.
Result<std::optional<Nanoseconds>> KmlReader::time_of(const pugi::xml_node& when, std::size_t line) {
    const std::string text = xml_content(when);
    if (trimmed_cell(text).empty()) return track_.leave_out("have no time", line), std::nullopt;
    constexpr std::size_t date_alone = 10;  // characters
    auto time = parse_iso_time(text);
    if (const std::string_view plain = trimmed_cell(text); !time && plain.size() == date_alone) {
        time = parse_iso_time(fmt::format("{}T00:00Z", plain));
        without_clock_ += time.has_value();
    }
    if (!time)
        return track_.refusal(line, fmt::format("<when> is '{}'; expected a time as 2024-03-05T12:00:00.25Z",
                                                trimmed_cell(text).substr(0, 40)));
    if (!time->in_range) return track_.leave_out("have a time before 1980-01-06 or after 2199", line), std::nullopt;
    if (!time->zoned) ++without_zone_;
    return time->time.time_since_epoch();
}

// Longitude first. False: an empty one, which is a missing sample.
Result<bool> KmlReader::take_coordinates(const std::string& text, std::string_view separators, TextRow& row) {
    std::vector<double> numbers;
    for (std::size_t at = text.find_first_not_of(separators); at != std::string::npos;) {
        const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
        const std::string_view piece = std::string_view(text).substr(at, end - at);
        auto number = text_number(piece);
        if (!number && numbers.size() < 2)
            number = written_degrees(piece, numbers.empty() ? Coordinate::longitude : Coordinate::latitude);
        if (!number || numbers.size() == 3)
            return track_.refusal(row.line, fmt::format("the place is '{}'; expected longitude, latitude and altitude, "
                                                        "numbers with a decimal point",
                                                        trimmed_cell(text).substr(0, 60)));
        numbers.push_back(*number);
        at = text.find_first_not_of(separators, end);
    }
    if (numbers.empty()) return false;
    if (numbers.size() < 2)
        return track_.refusal(row.line, fmt::format("the place is '{}'; expected longitude and latitude",
                                                    trimmed_cell(text).substr(0, 60)));
    row.longitude_deg = numbers[0], row.latitude_deg = numbers[1];
    if (numbers.size() < 3) return true;
    clamped_ += altitudes_ == Altitudes::none;
    above_ground_ += altitudes_ == Altitudes::ground;
    row.sea_level_m = numbers[2];
    if (altitudes_ == Altitudes::ground && file_.reading.origin)
        row.ellipsoidal_m = file_.reading.origin->height.above_ellipsoid.value() + numbers[2];
    return true;
}

// KML's default is clampToGround; a MultiTrack says it for its tracks.
KmlReader::Altitudes KmlReader::altitudes_of(const pugi::xml_node& holder) {
    pugi::xml_node mode = xml_child(holder, "altitudeMode");
    if (!mode) mode = xml_child(holder.parent(), "altitudeMode");
    const std::string text = xml_content(mode);
    const std::string_view plain = trimmed_cell(text);
    if (plain == "absolute") return Altitudes::sea_level;
    return plain.starts_with("relativeTo") ? Altitudes::ground : Altitudes::none;
}

Result<Track> KmlReader::refused() {
    const pugi::xml_node root = tree_.root();
    std::size_t placemarks = 0;
    for (pugi::xml_node at = root; at; at = xml_following(at, root))
        placemarks += xml_name(at) == "Placemark";
    return track_.refusal(
        fmt::format("{} placemarks and no place in them; expected a gx:Track, a LineString or Points", placemarks));
}

Result<Track> KmlReader::finish() {
    if (without_clock_ > 0)
        track_.note(fmt::format("{} times are dates alone and are taken as their midnight, UTC", without_clock_));
    if (without_zone_ > 0) track_.note(fmt::format("{} times say no zone and are taken as UTC", without_zone_));
    if (clamped_ > 0)
        track_.note(
            fmt::format("altitudeMode is clampToGround, so the altitudes of {} points may mean nothing; they are "
                        "taken above sea level",
                        clamped_));
    if (above_ground_ > 0 && !file_.reading.origin)
        return track_.refusal(
            fmt::format("the altitudes of {} points are above the ground (altitudeMode "
                        "relativeToGround), whose height is not known; expected altitudeMode "
                        "absolute, or an origin with the ground's height",
                        above_ground_));
    if (above_ground_ > 0) track_.note("altitudes above the ground are taken above the height of the origin");
    if (angles_ > 0) track_.note("gx:angles are not read: their signs differ between writers");
    return track_.finish("gx:coord with a place and <when> with a time from 1980-01-06 to 2199");
}

}  // namespace

Result<Track> read_kml(const TrackFile& file) { return KmlReader(file).read(); }

Result<Track> read_kmz(const TrackFile& file) {
    constexpr std::size_t largest = std::size_t{64} << 20;
    // doc.kml, or the first that ends in .kml (OGC 07-147r2, annex C).
    std::string chosen;
    const auto is_kml = [&](std::string_view name) {
        const std::string lower = lower_case(name);
        if (lower == "doc.kml" || (chosen.empty() && lower.ends_with(".kml"))) chosen = name;
        return lower.ends_with(".kml");
    };
    const auto files = archive_files(file.text, file.name, largest, is_kml);
    if (!files) return fail(files.error());
    if (files->empty())
        return fail(ErrorCode::input, fmt::format("{}: a zip archive without a .kml in it; expected a KMZ", file.name));
    const std::string& text = files->at(chosen);
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    auto track = read_kml({bytes, text, fmt::format("{}/{:.80}", file.name, chosen), file.reading});
    if (!track) return track;
    track->name = file.name;
    track->format = "KMZ";
    return track;
}

}  // namespace skyloop::inline motion
