#include "run/emulator/assembly.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "detail/receiver_assembly.hpp"
#include "run/emulator/live_feeds.hpp"
#include "run/emulator/load_scene.hpp"
#include "run/emulator/load_track.hpp"
#include "run/scenario/timeline_check.hpp"
#include "world/gnss/navigation_data.hpp"

namespace skyloop::inline run {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

class Mistakes {
public:
    explicit Mistakes(const Scenario& scenario) : place_(scenario.name + ":") {}

    /// @param place of the key that names what was tried: "FILE:LINE:COLUMN: KEY: " or "--nav: "; empty: it is in no
    /// file
    void add(const Error& error, const std::string& place = {}) {
        for (std::string& line : lines_of(error.message)) {
            const bool placed = line.starts_with(place_) || place.empty();
            // Of what cannot be read and is named in the scenario, the name is wrong.
            const bool by_key = !place.empty() && (!place.starts_with("--") || place.starts_with("--set "));
            if (error.code != ErrorCode::outside || by_key) code_ = ErrorCode::input;
            add_line(placed ? std::move(line) : place + line);
        }
    }
    template <class T>
    void add(const Result<T>& tried, const std::string& place = {}) {
        if (!tried) add(tried.error(), place);
    }
    [[nodiscard]] Error joined() const {
        std::string text;
        for (const std::string& line : lines_)
            text += (text.empty() ? "" : "\n") + line;
        return {code_, text};
    }

private:
    // One that was found without the place of its key is the same one with it.
    void add_line(std::string line) {
        for (std::string& known : lines_)
            if (line.ends_with(known) || known.ends_with(line)) {
                if (known.size() < line.size()) known = std::move(line);
                return;
            }
        lines_.push_back(std::move(line));
    }
    std::string place_;
    std::vector<std::string> lines_;
    ErrorCode code_ = ErrorCode::outside;
};

// Without the keys that are not in the file.
std::string place_of(const Scenario& scenario, std::string_view key) {
    const auto place = scenario.told_at.find(key);
    return place != scenario.told_at.end() ? place->second : std::string();
}

// What stands around, seen from a place where the path is not known.
void try_scene(const Scenario& scenario, const DataFolders& data, const Geoid* geoid, GpsTime start, Mistakes& found) {
    const std::string place =
        place_of(scenario, scenario.scene.buildings.empty() ? "scene.terrain" : "scene.buildings");
    found.add(load_scene(scenario, scene_start(scenario, start), CityCache{data.cache}, geoid), place);
}

}  // namespace

Error with_other_mistakes(const Error& first, const Scenario& asked, const DataFolders& data, GpsTime now) {
    Mistakes found(asked);
    found.add(first);
    Scenario scenario = asked;
    std::vector<std::string> unsaid;
    const auto geoid = find_geoid(data, unsaid);
    auto navigation = load_navigation(scenario, now, data);
    found.add(navigation, place_of(scenario, "sky.navigation"));
    if (navigation) found.add(load_precise_truth(scenario, *navigation));
    const GpsTime start = navigation ? navigation->start : scenario.run.start.value_or(now);
    const auto* file = std::get_if<FileSettings>(&scenario.trajectory);
    const std::string path_told_at = file != nullptr ? file->path_told_at : std::string();
    const auto track = load_track(scenario, geoid.get(), start);
    found.add(track, path_told_at);
    if (!track) scenario.trajectory = FixedSettings{};
    found.add(check_timeline(scenario, start));
    found.add(LiveFeeds::check(scenario));
    try_scene(scenario, data, geoid.get(), start, found);
    RunMode mode;
    mode.virtual_time = mode.only_checked = true;
    mode.now = now;
    std::shared_ptr<const NavigationSource> source = std::make_unique<NominalConstellation>();
    if (navigation) source = std::move(navigation->source);
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        found.add(plan_station({scenario, data, mode, source, geoid.get(), start, nullptr}, i, unsaid));
    return found.joined();
}

}  // namespace skyloop::inline run
