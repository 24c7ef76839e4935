// FlightGear's generic protocol as examples/flightgear/skyloop.xml defines it, and JSBSim's SOCKET output: lines
// of numbers (FEEDS.md 3.4 and 3.12).
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/core/table_text.hpp"
#include "detail/dialect_parts.hpp"
#include "detail/motion_filter.hpp"

namespace skyloop::inline run {
namespace {

// The numbers of a line by what they mean, whatever order they came in.
struct LineColumn {
    enum : std::size_t { time_s, latitude, longitude, height_ft, north_fps, east_fps, down_fps, roll, pitch, yaw };
};
constexpr std::size_t line_columns = 10;
using LineNumbers = std::array<double, line_columns>;

SourcePose pose_of_line(const LineNumbers& numbers, const std::optional<Attitude>& attitude) {
    SourcePose pose;
    pose.latitude_deg = numbers[LineColumn::latitude];
    pose.longitude_deg = numbers[LineColumn::longitude];
    pose.height_m = numbers[LineColumn::height_ft] * metres_per_foot;
    pose.velocity_ned =
        Eigen::Vector3d(numbers[LineColumn::north_fps], numbers[LineColumn::east_fps], numbers[LineColumn::down_fps]) *
        metres_per_foot;
    pose.attitude = attitude;
    return pose;
}

// A simulator whose time stands still for a while is paused; making up for a stall, FlightGear repeats a line or two.
class PauseWatch {
public:
    // @return whether the line says something new
    bool look(Nanoseconds time, std::int64_t received_ns, FeedNews& news) {
        constexpr std::int64_t while_ns = 200'000'000;
        const bool repeats = last_ && *last_ == time;
        if (repeats) ++news.others;
        if (!repeats) since_ns_ = received_ns;
        last_ = time;
        const bool stands = received_ns - since_ns_ >= while_ns;
        if (stands != paused_) news.add_aside(FeedPause{stands});
        paused_ = stands;
        return !repeats;
    }
    void forget() { last_.reset(), paused_ = false; }

private:
    std::optional<Nanoseconds> last_;
    std::int64_t since_ns_ = 0;  // when it was told first
    bool paused_ = false;
};

// Both, but for how a line becomes numbers.
class LineDialect : public LineSource {
public:
    using LineSource::LineSource;

    void reconnected() override {
        LineSource::reconnected();
        watch_.forget();
        filter_.forget();
    }

protected:
    // @param coarse the places have a grid of metres, the velocities are better
    void report(const LineNumbers& numbers, const std::optional<Attitude>& attitude, bool coarse,
                std::int64_t received_ns, FeedNews& news) {
        const auto time = source_nanoseconds(numbers[LineColumn::time_s]);
        if (!time) return report_refusal(news, fmt::format("a time of {} s", numbers[LineColumn::time_s]));
        if (!watch_.look(*time, received_ns, news)) return;
        SampleOr sample = sample_of(pose_of_line(numbers, attitude), context());
        if (sample && coarse) filter_.smooth(*sample, time->count());
        report_sample(news, std::move(sample), time, received_ns);
    }

private:
    PauseWatch watch_;
    MotionFilter filter_{{0.5, 0.05}};
};

class FlightgearGenericDialect : public LineDialect {
public:
    using LineDialect::LineDialect;

private:
    void take(const std::string& line, std::int64_t received_ns, FeedNews& news) override {
        const auto cells = source_cells(line);
        if (cells.size() != line_columns)
            return report_refusal(
                news, fmt::format("a line of {} cells; expected the {} of skyloop.xml", cells.size(), line_columns));
        LineNumbers numbers{};
        for (std::size_t i = 0; i < line_columns; ++i) {
            const auto number = source_number(cells[i]);
            if (!number) return report_refusal(news, fmt::format("cell {} of a line is no number", i + 1));
            numbers[i] = *number;
        }
        report(numbers,
               attitude_of_degrees(numbers[LineColumn::roll], numbers[LineColumn::pitch], numbers[LineColumn::yaw]),
               false, received_ns, news);
    }
};

// Of JSBSim's properties, those that are read, by LineColumn.
constexpr std::array<std::string_view, line_columns> jsbsim_properties{
    "simulation/sim-time-sec", "position/lat-geod-deg", "position/long-gc-deg",  "position/h-sl-ft",
    "velocities/v-north-fps",  "velocities/v-east-fps", "velocities/v-down-fps", "attitude/phi-rad",
    "attitude/theta-rad",      "attitude/psi-rad"};

// The first line names the columns; of those that are there twice (Time and simulation/sim-time-sec) the last counts.
class JsbsimDialect : public LineDialect {
public:
    using LineDialect::LineDialect;
    void reconnected() override {
        LineDialect::reconnected();
        known_ = false;
    }

private:
    void take(const std::string& line, std::int64_t received_ns, FeedNews& news) override {
        auto cells = source_cells(line);
        if (line.find("<LABELS>") != std::string::npos) return take_labels(cells, news);
        if (!known_) return report_refusal(news, problem_);
        LineNumbers numbers{};
        for (std::size_t i = 0; i < line_columns; ++i) {
            const auto number = columns_[i] < cells.size() ? source_number(cells[columns_[i]]) : std::nullopt;
            if (!number)
                return report_refusal(news, fmt::format("a line without a number for {}", jsbsim_properties[i]));
            numbers[i] = *number;
        }
        report(numbers,
               attitude_of_radians(numbers[LineColumn::roll], numbers[LineColumn::pitch], numbers[LineColumn::yaw]),
               is_coarse(cells[columns_[LineColumn::latitude]]), received_ns, news);
    }

    // The line begins with "<LABELS>,", which lines of numbers do not have.
    void take_labels(std::vector<std::string_view> cells, FeedNews& news) {
        known_ = false;
        cells.erase(cells.begin());
        for (std::size_t i = 0; i < line_columns; ++i) {
            auto found =
                std::find_if(cells.begin(), cells.end(), [&](std::string_view label) { return fits(i, label); });
            if (found == cells.end()) {
                problem_ =
                    fmt::format("JSBSim's output has no column {}; expected it as a <property>", jsbsim_properties[i]);
                if (i == LineColumn::latitude)
                    problem_ += " (its \"Latitude (deg)\" is geocentric, up to 21 km beside)";
                return report_refusal(news, problem_);
            }
            columns_[i] = static_cast<std::size_t>(found - cells.begin());
        }
        known_ = true;
    }

    // Labels are properties, with "/fdm/jsbsim/" before them or, of JSBSim 2020.3, the last part of them alone.
    static bool fits(std::size_t column, std::string_view label) {
        label = trimmed_cell(label);
        if (column == LineColumn::time_s && label == "Time") return true;
        const std::string_view wanted = jsbsim_properties[column];
        const auto is_end_of = [](std::string_view end, std::string_view whole) {
            return !end.empty() && whole.size() > end.size() && whole.ends_with(end) &&
                   whole[whole.size() - end.size() - 1] == '/';
        };
        return label == wanted || is_end_of(wanted, label) || is_end_of(label, wanted);
    }

    // JSBSim 2020.3 writes seven digits whatever it is asked for: a grid of a metre.
    bool is_coarse(std::string_view latitude_cell) {
        constexpr std::size_t fine_decimals = 7;
        const std::string_view cell = trimmed_cell(latitude_cell);
        const std::size_t point = cell.find('.');
        if (point != std::string_view::npos) decimals_ = std::max(decimals_, cell.size() - point - 1);
        return decimals_ < fine_decimals;
    }

    bool known_ = false;
    std::string problem_ = "lines of numbers before the <LABELS> that name them";
    std::array<std::size_t, line_columns> columns_{};
    std::size_t decimals_ = 0;  // the most of a latitude
};

}  // namespace

std::unique_ptr<FeedDialect> make_flightgear_generic_dialect(const FeedContext& context) {
    return std::make_unique<FlightgearGenericDialect>(context);
}

std::unique_ptr<FeedDialect> make_jsbsim_dialect(const FeedContext& context) {
    return std::make_unique<JsbsimDialect>(context);
}

}  // namespace skyloop::inline run
