#include "run/fault/timeline_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "run/fault/known_names.hpp"

namespace skyloop::inline run {
namespace {

constexpr double longest_s = 100 * 366.0 * 86400;  // a run's span stays far inside 64-bit nanoseconds
constexpr double most_occurrences = 1e6;
constexpr double largest_custom_mode = 4294967295.0;

// What each of those texts names.
constexpr std::pair<std::string_view, std::string_view> texts_that_name[] = {{"at_utc", "a time"},
                                                                             {"after", "the name of an entry"},
                                                                             {"after_end_of", "the name of a fault"},
                                                                             {"when_client_sends", "a message"},
                                                                             {"when_mavlink_mode", "a mode"}};

// Without a standard, so that an empty text can be told from none.
constexpr ParameterSpec given_text(std::string_view name, std::string_view meaning) {
    return text_parameter(name, "", meaning).without_standard();
}

// The last ones are of faults alone.
constexpr ParameterSpec keys_of_faults[] = {
    text_parameter("name", "", "what messages and other entries call it; else its kind, with a number"),
    number_parameter("at_s", no_standard, 0, longest_s, "when it begins, seconds after the start of the run"),
    given_text("at_utc", "when it begins, ISO 8601, in UTC where no zone stands behind"),
    numbers_parameter("between_s", 2, 0, longest_s, "it begins at a random time within these, by the seed"),
    given_text("after", "the name of an entry from whose beginning its times count"),
    given_text("after_end_of", "the name of a fault from whose end its times count"),
    number_parameter("every_s", no_standard, 1e-3, longest_s, "it begins again after this"),
    whole_number_parameter("times", no_standard, 1, most_occurrences, "how often by itself, in all; else without end"),
    number_parameter("when_above_m", no_standard, -1e4, 1e8,
                     "it begins when the antenna is higher than this above the ellipsoid"),
    number_parameter("when_below_m", no_standard, -1e4, 1e8, "… lower than this"),
    number_parameter("when_faster_mps", no_standard, 0, 1e5, "… faster than this over the ground"),
    polygon_parameter("when_inside", "… inside this polygon, [[latitude, longitude], …]"),
    number_parameter("when_fix_for_s", no_standard, 0, longest_s, "… when there has been a fix for so long"),
    given_text("when_client_sends", "… when the client sends this message: \"CFG-VALSET\", \"CFG-*\" or \"anything\""),
    given_text("when_mavlink_mode", "… when the vehicle's mode is this, by its name: \"AUTO\", \"RTL\""),
    whole_number_parameter("when_custom_mode", no_standard, 0, largest_custom_mode,
                           "… when it is this, by the number custom_mode of HEARTBEAT"),
    flag_parameter("when_armed", true, "… when the vehicle is armed (true), or is not (false)").without_standard(),
    flag_parameter("again", false, "it begins each time that its condition comes true, not the first time alone"),
    number_parameter("for_s", no_standard, 0, longest_s, "how long it lasts; else to the end"),
    numbers_parameter("for_between_s", 2, 0, longest_s, "it lasts a random time within these, by the seed"),
    number_parameter("ramp_in_s", 0, 0, longest_s, "it grows to its strength within this"),
    number_parameter("ramp_out_s", 0, 0, longest_s, "it fades within this after its end"),
    flag_parameter(
        "allow_idle", false,
        "a run with expectations goes on though nothing can come of it, with a warning; else it is refused")};
constexpr std::size_t count_of_faults_alone = 5;

template <class Quantity>
std::optional<Quantity> quantity(const Parameters& keys, std::string_view name) {
    const auto number = keys.optional_number(name);
    return number ? std::optional(Quantity(*number)) : std::nullopt;
}

std::optional<std::array<double, 2>> bounds(const Parameters& keys, const std::string& name,
                                            std::vector<ParameterMistake>& mistakes) {
    const std::vector<double> numbers = keys.numbers(name);
    if (numbers.size() != 2) return std::nullopt;
    if (numbers[0] > numbers[1])
        mistakes.push_back(
            {name, fmt::format("runs from {:g} to {:g}; expected the smaller one first", numbers[0], numbers[1])});
    return std::array{numbers[0], numbers[1]};
}

std::vector<std::array<double, 2>> polygon(const Parameters& keys, std::vector<ParameterMistake>& mistakes) {
    const std::vector<double> numbers = keys.numbers("when_inside");
    std::vector<std::array<double, 2>> corners;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
        corners.push_back({numbers[i], numbers[i + 1]});
    if (numbers.empty()) return corners;
    if (const auto places = corners_from_degrees(numbers); !places) mistakes.push_back({"when_inside", places.error()});
    return corners;
}

void read_vehicle_conditions(const Parameters& keys, Trigger& when, std::vector<ParameterMistake>& mistakes) {
    when.vehicle_mode = keys.text("when_mavlink_mode");
    const std::vector<std::string>& known = mavlink_mode_names();
    const bool is_known = std::any_of(
        known.begin(), known.end(), [&](const std::string& name) { return is_mavlink_mode(name, when.vehicle_mode); });
    if (!when.vehicle_mode.empty() && !is_known)
        mistakes.push_back(
            {"when_mavlink_mode",
             fmt::format("is '{}'; expected a mode of ArduCopter, ArduPlane, Rover or PX4, or "
                         "when_custom_mode{}",
                         when.vehicle_mode,
                         did_you_mean(when.vehicle_mode, std::vector<std::string_view>(known.begin(), known.end())))});
    if (const auto number = keys.optional_number("when_custom_mode"))
        when.custom_mode = static_cast<std::uint32_t>(*number);
    if (keys.has("when_armed")) when.armed = keys.flag("when_armed");
}

std::optional<Trigger> trigger(const Parameters& keys, std::vector<ParameterMistake>& mistakes) {
    Trigger when;
    when.height_above = quantity<Metres>(keys, "when_above_m");
    when.height_below = quantity<Metres>(keys, "when_below_m");
    when.speed_above = quantity<MetresPerSecond>(keys, "when_faster_mps");
    when.inside = polygon(keys, mistakes);
    when.fix_for = quantity<Seconds>(keys, "when_fix_for_s");
    when.client_sends = keys.text("when_client_sends");
    if (const auto mistake = message_name_mistake(when.client_sends); mistake && !when.client_sends.empty())
        mistakes.push_back({"when_client_sends", *mistake});
    read_vehicle_conditions(keys, when, mistakes);
    const bool any = when.height_above || when.height_below || when.speed_above || !when.inside.empty() ||
                     when.fix_for || !when.client_sends.empty() || when.needs_vehicle();
    return any ? std::optional(when) : std::nullopt;
}

std::optional<GpsTime> utc(const Parameters& keys, std::vector<ParameterMistake>& mistakes) {
    const std::string text = keys.text("at_utc");
    if (text.empty()) return std::nullopt;
    const auto time = parse_instant(text);
    if (time) return to_gps_time(*time, LeapSeconds::announced());
    mistakes.push_back({"at_utc", time.error().message});
    return std::nullopt;
}

void refuse_empty_texts(const Parameters& keys, std::vector<ParameterMistake>& mistakes) {
    for (const auto& [name, what] : texts_that_name)
        if (keys.has(name) && keys.text(name).empty())
            mistakes.push_back({std::string(name), fmt::format("is empty; expected {}, or no such key", what)});
}

// Of several ways to say one thing only one may be used.
void refuse_both(const Parameters& keys, std::initializer_list<std::string_view> names,
                 std::vector<ParameterMistake>& mistakes) {
    std::string_view first;
    for (const std::string_view name : names) {
        if (!keys.has(name)) continue;
        if (!first.empty())
            mistakes.push_back({std::string(name), fmt::format("stands beside '{}'; expected one of them", first)});
        else
            first = name;
    }
}

void refuse_contradictions(const Parameters& keys, const TimelineEntry& entry,
                           std::vector<ParameterMistake>& mistakes) {
    refuse_both(keys, {"at_s", "at_utc", "between_s"}, mistakes);
    refuse_both(keys, {"after", "after_end_of"}, mistakes);
    refuse_both(keys, {"for_s", "for_between_s"}, mistakes);
    const auto refuse = [&](const std::string& key, const std::string& sentence) {
        mistakes.push_back({key, sentence});
    };
    if (const auto mistake = entry_name_mistake(entry.name)) mistakes.push_back(*mistake);
    if (entry.when && !entry.after.empty()) refuse("after", "stands beside a condition 'when_…'; expected one of them");
    if (entry.at_time && (entry.when || !entry.after.empty()))
        refuse("at_utc", "is a time of its own; expected none beside 'after' or 'when_…'");
    if (entry.times && !entry.every) refuse("times", "says how often; expected 'every_s' beside it");
    if (entry.again && !entry.when) refuse("again", "expected a condition 'when_…' beside it");
    if (entry.again && entry.every) refuse("again", "stands beside 'every_s'; expected one of them");
}

}  // namespace

std::span<const ParameterSpec> timeline_keys() { return keys_of_faults; }

std::span<const ParameterSpec> timeline_keys_of_commands() {
    return timeline_keys().first(std::size(keys_of_faults) - count_of_faults_alone);
}

TimelineReading read_timeline_entry(const Parameters& keys) {
    TimelineReading reading;
    TimelineEntry& entry = reading.entry;
    entry.name = keys.text("name");
    refuse_empty_texts(keys, reading.mistakes);
    entry.at = quantity<Seconds>(keys, "at_s");
    entry.at_time = utc(keys, reading.mistakes);
    entry.between = bounds(keys, "between_s", reading.mistakes);
    entry.after = keys.text("after");
    entry.after_end = entry.after.empty() && !keys.text("after_end_of").empty();
    if (entry.after_end) entry.after = keys.text("after_end_of");
    entry.when = trigger(keys, reading.mistakes);
    entry.again = keys.flag("again");
    entry.every = quantity<Seconds>(keys, "every_s");
    if (const auto times = keys.optional_number("times")) entry.times = static_cast<int>(*times);
    entry.length = quantity<Seconds>(keys, "for_s");
    entry.length_between = bounds(keys, "for_between_s", reading.mistakes);
    entry.ramp_in = Seconds(keys.number("ramp_in_s"));
    entry.ramp_out = Seconds(keys.number("ramp_out_s"));
    refuse_contradictions(keys, entry, reading.mistakes);
    return reading;
}

std::optional<ParameterMistake> entry_name_mistake(const std::string& name) {
    if (name == "run") return ParameterMistake{"name", "is 'run', which means the run itself; expected another name"};
    if (name.find('#') != std::string::npos)
        return ParameterMistake{"name", "has a '#', which stands before the number of an occurrence; expected none"};
    return std::nullopt;
}

std::vector<std::pair<std::size_t, ParameterMistake>> timeline_mistakes(const std::vector<TimelineEntry>& entries) {
    std::vector<std::pair<std::size_t, ParameterMistake>> mistakes;
    std::vector<std::string_view> names;
    for (const TimelineEntry& entry : entries)
        names.push_back(entry.name);
    const auto place_of = [&](const std::string& name) {
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const TimelineEntry& entry = entries[i];
        if (place_of(entry.name) != i) mistakes.push_back({i, {"name", "is that of another entry"}});
        if (entry.after.empty()) continue;
        const std::string key = entry.after_end ? "after_end_of" : "after";
        const std::size_t other = place_of(entry.after);
        if (other == entries.size()) {
            mistakes.push_back({i,
                                {key, fmt::format("is '{}'; no entry has this name{}", entry.after,
                                                  did_you_mean(entry.after, names))}});
            continue;
        }
        if (entry.after_end && entries[other].once)
            mistakes.push_back({i, {key, "names a command, which has no end; expected 'after'"}});
        std::size_t at = i, steps = 0;
        while (at < entries.size() && !entries[at].after.empty() && steps++ <= entries.size())
            at = place_of(entries[at].after);
        if (steps > entries.size()) mistakes.push_back({i, {key, "leads back to this entry in a circle"}});
    }
    return mistakes;
}

}  // namespace skyloop::inline run
