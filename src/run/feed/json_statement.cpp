#include "detail/json_statement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/core/number_text.hpp"
#include "base/geo/local_frame.hpp"
#include "run/fault/command.hpp"
#include "run/fault/fault_kind.hpp"

namespace skyloop::inline run {
namespace {

constexpr double longest_source_s = 4e9;

tl::unexpected<Error> statement_mistake(std::string sentence) { return fail(ErrorCode::input, std::move(sentence)); }

// A value as it stands there, short and on one line.
std::string shown_json(const JsonData& value) {
    constexpr std::size_t longest = 40;
    std::string text = value.dump(-1, ' ', true, JsonData::error_handler_t::replace);
    if (text.size() > longest) text = text.substr(0, longest) + "…";
    return text;
}

// A list of numbers; nothing when it is absent.
template <int Count>
Result<std::optional<Eigen::Matrix<double, Count, 1>>> numbers_of(const JsonData& statement, const char* key) {
    const JsonData* value = statement_member(statement, key);
    if (value == nullptr) return std::nullopt;
    Eigen::Matrix<double, Count, 1> numbers;
    bool good = value->is_array() && value->size() == Count;
    for (std::size_t i = 0; good && i < Count; ++i) {
        good = (*value)[i].is_number();
        if (good) numbers(static_cast<Eigen::Index>(i)) = (*value)[i].get<double>();
    }
    if (!good || !numbers.allFinite())
        return statement_mistake(fmt::format("'{}' is {}; expected {} numbers", key, shown_json(*value), Count));
    return numbers;
}

// Which one of several keys stands there; null: none.
Result<const char*> only_one_of(const JsonData& statement, std::initializer_list<const char*> keys) {
    const char* found = nullptr;
    for (const char* key : keys) {
        if (statement_member(statement, key) == nullptr) continue;
        if (found != nullptr) return statement_mistake(fmt::format("has both '{}' and '{}'; expected one", found, key));
        found = key;
    }
    return found;
}

Eigen::Vector3d enu_of_ned(const Eigen::Vector3d& ned) { return {ned.y(), ned.x(), -ned.z()}; }

// Turns north, east, down of one frame to those of another.
Eigen::Quaterniond ned_to_ned(const LocalFrame& from, const LocalFrame& to) {
    Eigen::Matrix3d turn;
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d axis = enu_of_ned(Eigen::Vector3d::Unit(i));
        turn.col(i) = enu_of_ned(to.to_enu(from.to_ecef(Displacement<Enu>(axis))).vector());
    }
    return Eigen::Quaterniond(turn);
}

Result<std::optional<Eigen::Quaterniond>> unit_quaternion(const JsonData& statement, const char* key) {
    constexpr double most_off = 0.05;  // FEEDS.md 3.1
    const auto q = numbers_of<4>(statement, key);
    if (!q) return fail(q.error());
    if (!*q) return std::nullopt;
    if (std::abs((*q)->norm() - 1) > most_off)
        return statement_mistake(fmt::format("'{}' has the length {:.3f}; expected 1", key, (*q)->norm()));
    return Eigen::Quaterniond((**q)(0), (**q)(1), (**q)(2), (**q)(3)).normalized();
}

// Body (forward, right, down) to north, east, down of the frame that the source counts in.
Result<std::optional<Eigen::Quaterniond>> attitude_of(const JsonData& statement) {
    const auto key = only_one_of(statement, {"q", "q_flu_enu", "rpy_deg"});
    if (!key) return fail(key.error());
    if (*key == nullptr) return std::nullopt;
    if (std::string_view(*key) == "q") return unit_quaternion(statement, "q");
    if (std::string_view(*key) == "q_flu_enu") {
        const auto q = unit_quaternion(statement, "q_flu_enu");
        if (!q) return fail(q.error());
        // FEEDS.md 3.8: east, north, up to north, east, down, and forward, right, down to forward, left, up.
        const Eigen::Quaterniond enu_to_ned(0, std::sqrt(0.5), std::sqrt(0.5), 0), frd_to_flu(0, 1, 0, 0);
        return enu_to_ned * **q * frd_to_flu;
    }
    const auto rpy = numbers_of<3>(statement, "rpy_deg");
    if (!rpy) return fail(rpy.error());
    const auto angle = [&](int i) { return Angle::degrees((**rpy)(i)); };
    return Attitude::roll_pitch_yaw(angle(0), angle(1), angle(2)).body_to_ned();
}

// Where the vehicle is, and the frame in which its velocity and attitude are meant: that of the origin where it counts
// from one, else its own place's.
struct StatementPlace {
    Position<Ecef> position;
    LocalFrame frame;
};

Result<StatementPlace> position_of(const JsonData& statement, const std::optional<Geodetic>& origin,
                                   const FeedContext& context) {
    const auto key = only_one_of(statement, {"lla", "ecef", "ned", "enu"});
    if (!key) return fail(key.error());
    if (*key == nullptr) return statement_mistake("has no position; expected 'lla', 'ecef', 'ned' or 'enu'");
    if (std::string_view(*key) == "lla") {
        const auto place = statement_place(statement, context);
        if (!place) return fail(place.error());
        return StatementPlace{to_ecef(*place), LocalFrame(*place)};
    }
    const auto metres = numbers_of<3>(statement, *key);
    if (!metres) return fail(metres.error());
    constexpr double farthest_m = 1e8;
    if ((*metres)->norm() > farthest_m)
        return statement_mistake(fmt::format("'{}' is farther than {:.0f} km", *key, farthest_m / 1000));
    if (std::string_view(*key) == "ecef") {
        const Position<Ecef> position(**metres);
        if ((*metres)->norm() < 1) return statement_mistake("'ecef' is the centre of the Earth");
        return StatementPlace{position, LocalFrame(to_geodetic(position))};
    }
    if (!origin)
        return statement_mistake(fmt::format(
            "'{}' counts from an origin that has not been told; expected a line of type 'origin' before", *key));
    const LocalFrame frame(*origin);
    const bool ned = std::string_view(*key) == "ned";
    return StatementPlace{frame.to_ecef(Position<Enu>(ned ? enu_of_ned(**metres) : Eigen::Vector3d(**metres))), frame};
}

Result<std::optional<Velocity<Ecef>>> velocity_of(const JsonData& statement, const LocalFrame& frame,
                                                  const std::optional<Eigen::Quaterniond>& attitude) {
    const auto key = only_one_of(statement, {"vel_ned", "vel_enu", "vel_ecef", "vel_frd"});
    if (!key) return fail(key.error());
    if (*key == nullptr) return std::nullopt;
    const auto value = numbers_of<3>(statement, *key);
    if (!value) return fail(value.error());
    const Eigen::Vector3d velocity = **value;
    const std::string_view name(*key);
    if (name == "vel_ecef") return Velocity<Ecef>(velocity);
    if (name == "vel_enu") return frame.to_ecef(Velocity<Enu>(velocity));
    if (name == "vel_ned") return frame.to_ecef(Velocity<Enu>(enu_of_ned(velocity)));
    if (!attitude) return statement_mistake("'vel_frd' is in the body's axes; expected 'q' or another attitude");
    return frame.to_ecef(Velocity<Enu>(enu_of_ned(*attitude * velocity)));
}

std::optional<ParameterValue> parameter_of(const JsonData& value) {
    if (value.is_number()) return value.get<double>();
    if (value.is_boolean()) return value.get<bool>();
    if (value.is_string()) return value.get<std::string>();
    if (!value.is_array()) return std::nullopt;
    if (std::all_of(value.begin(), value.end(), [](const JsonData& v) { return v.is_number(); }))
        return value.get<std::vector<double>>();
    if (std::all_of(value.begin(), value.end(), [](const JsonData& v) { return v.is_string(); }))
        return value.get<std::vector<std::string>>();
    return std::nullopt;
}

bool is_one_line(const std::string& text) {
    constexpr std::size_t longest = 1000;
    return text.size() <= longest &&
           std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7F; });
}

}  // namespace

Result<JsonData> read_statement(std::string_view line) {
    constexpr int deepest = 16;
    bool deep = false;
    const auto look = [&](int depth, JsonData::parse_event_t, JsonData&) {
        deep = deep || depth > deepest;
        return !deep;
    };
    JsonData statement = JsonData::parse(line.begin(), line.end(), look, false);
    if (deep) return statement_mistake(fmt::format("is nested deeper than {}", deepest));
    if (statement.is_discarded()) return statement_mistake("is no JSON; expected one object on one line");
    if (!statement.is_object()) return statement_mistake("is no JSON object");
    return statement;
}

const JsonData* statement_member(const JsonData& statement, const char* key) {
    const auto found = statement.find(key);
    return found == statement.end() || found->is_null() ? nullptr : &*found;
}

Result<std::optional<std::string>> statement_text(const JsonData& statement, const char* key) {
    const JsonData* value = statement_member(statement, key);
    if (value == nullptr) return std::nullopt;
    if (!value->is_string() || !is_one_line(value->get_ref<const std::string&>()))
        return statement_mistake(fmt::format("'{}' is {}; expected a text", key, shown_json(*value)));
    return value->get<std::string>();
}

Result<std::optional<std::int64_t>> statement_whole(const JsonData& statement, const char* key) {
    const JsonData* value = statement_member(statement, key);
    if (value == nullptr) return std::nullopt;
    if (value->is_number_unsigned() && value->get<std::uint64_t>() <= static_cast<std::uint64_t>(INT64_MAX))
        return static_cast<std::int64_t>(value->get<std::uint64_t>());
    if (value->is_number_integer() && !value->is_number_unsigned()) return value->get<std::int64_t>();
    if (value->is_string()) {
        const std::string& text = value->get_ref<const std::string&>();
        if (const auto number = number_in<std::int64_t>(text)) return *number;
    }
    return statement_mistake(fmt::format("'{}' is {}; expected a whole number", key, shown_json(*value)));
}

Result<std::optional<Nanoseconds>> statement_time(const JsonData& statement) {
    const auto key = only_one_of(statement, {"t", "t_ns"});
    if (!key) return fail(key.error());
    if (*key == nullptr) return std::nullopt;
    constexpr auto longest_ns = static_cast<std::int64_t>(longest_source_s * 1e9);
    if (std::string_view(*key) == "t_ns") {
        const auto whole = statement_whole(statement, "t_ns");
        if (!whole) return fail(whole.error());
        if (**whole > longest_ns || **whole < -longest_ns)
            return statement_mistake(fmt::format("'t_ns' is {}; expected at most ±4e18", **whole));
        return Nanoseconds(**whole);
    }
    const JsonData& value = *statement_member(statement, "t");
    double seconds = std::nan("");
    if (value.is_number()) seconds = value.get<double>();
    if (value.is_string()) {
        const std::string& text = value.get_ref<const std::string&>();
        if (const auto number = number_in<double>(text)) seconds = *number;
    }
    if (!(std::abs(seconds) <= longest_source_s))
        return statement_mistake(fmt::format("'t' is {}; expected seconds, at most ±4e9", shown_json(value)));
    return to_nanoseconds(Seconds(seconds));
}

Result<Geodetic> statement_place(const JsonData& statement, const FeedContext& context) {
    const auto lla = numbers_of<3>(statement, "lla");
    if (!lla) return fail(lla.error());
    if (!*lla) return statement_mistake("has no 'lla'; expected [latitude, longitude, height]");
    const auto reference = statement_text(statement, "h_ref");
    if (!reference) return fail(reference.error());
    if (*reference != "ell" && *reference != "msl")
        return statement_mistake(
            fmt::format("'h_ref' is {}; expected \"ell\" (height above the ellipsoid) or \"msl\" "
                        "(above the sea)",
                        *reference ? "'" + (*reference)->substr(0, 40) + "'" : "missing"));
    auto place = place_from_degrees((**lla)(0), (**lla)(1), (**lla)(2));
    if (!place) return statement_mistake("'lla': " + place.error());
    if (*reference == "msl" && context.geoid != nullptr && context.sea_level == SeaLevel::geoid)
        place->height.above_ellipsoid += context.geoid->undulation(place->latitude, place->longitude);
    return *place;
}

Result<TruthSample> statement_sample(const JsonData& statement, const std::optional<Geodetic>& origin,
                                     const FeedContext& context) {
    const auto place = position_of(statement, origin, context);
    if (!place) return fail(place.error());
    const auto attitude = attitude_of(statement);
    if (!attitude) return fail(attitude.error());
    const auto velocity = velocity_of(statement, place->frame, *attitude);
    if (!velocity) return fail(velocity.error());
    const auto acceleration = numbers_of<3>(statement, "acc_ned");
    if (!acceleration) return fail(acceleration.error());
    const auto rate = numbers_of<3>(statement, "rate_frd");
    if (!rate) return fail(rate.error());
    TruthSample sample;
    sample.position = place->position;
    sample.velocity = *velocity;
    if (*acceleration)
        sample.acceleration = place->frame.to_ecef(Displacement<Enu>(enu_of_ned(**acceleration))).vector();
    if (*attitude)
        sample.attitude = Attitude(ned_to_ned(place->frame, LocalFrame(to_geodetic(place->position))) * **attitude);
    if (*rate) sample.turn_rate = Eigen::Vector3d(**rate);
    return sample;
}

Result<Command> statement_event(const JsonData& statement) {
    const auto name = statement_text(statement, "name");
    if (!name) return fail(name.error());
    if (!*name) return statement_mistake("the event has no 'name'; expected a command or a kind of fault");
    ParameterMap members;
    const JsonData* arguments = statement_member(statement, "args");
    if (arguments != nullptr && !arguments->is_object())
        return statement_mistake(fmt::format("'args' is {}; expected an object", shown_json(*arguments)));
    if (arguments != nullptr)
        for (const auto& [key, value] : arguments->items()) {
            auto parameter = parameter_of(value);
            const auto* text = parameter ? std::get_if<std::string>(&*parameter) : nullptr;
            if (!parameter || !is_one_line(key) || (text != nullptr && !is_one_line(*text)))
                return statement_mistake(
                    fmt::format("'args' has {}: {}, which no parameter takes", shown_json(key), shown_json(value)));
            members[key] = std::move(*parameter);
        }
    if (find_command_kind(**name) == nullptr && find_fault_kind(**name) != nullptr) {
        members["kind"] = **name;
        return checked_live_fault(std::move(members), "feed");
    }
    members["command"] = **name;
    return checked_command(std::move(members), "feed");
}

}  // namespace skyloop::inline run
