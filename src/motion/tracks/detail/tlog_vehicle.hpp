// One sender of a telemetry log: where its messages say that the vehicle is.
#pragma once

#include <string>
#include <vector>

#include "flight_log.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"

namespace skyloop::inline motion {

// A frame and when the ground station had it.
struct TlogFrame {
    std::int64_t stamp_us = 0;  // since 1970
    MavlinkFrameView frame;
};

// What came between two starts of the autopilot.
struct TlogStart {
    struct LocalPlace {
        std::int64_t ns = 0;
        Eigen::Vector3d ned;
        std::optional<Eigen::Vector3d> velocity;
        std::optional<GlobalSample> origin;
    };
    // A row whose time is GPS time instead of the autopilot's.
    struct Dated {
        FlightRow row;
        bool by_gps = false;
    };
    std::vector<FlightRow> global;
    std::vector<LocalPlace> local;
    std::vector<Dated> hil, simulated, receiver;
    AttitudeSeries angles, quaternions;
    std::vector<std::int64_t> clock_offsets;  // GPS time less the autopilot's clock, by SYSTEM_TIME
    std::vector<std::int64_t> stamp_offsets;  // the same by the stamps, delays in it
};

// Takes the messages of one system and component.
class TlogVehicle {
public:
    void take(const TlogFrame& frame);
    [[nodiscard]] bool is_autopilot() const { return is_autopilot_; }
    [[nodiscard]] bool has_places() const { return places_ > 0; }
    // The sources of places in the order of preference.
    [[nodiscard]] std::vector<FlightOffer> offers() const;
    // The clocks of the starts with their attitudes. @param note gets what gives UTC, when something does
    [[nodiscard]] std::vector<FlightClock> clocks(std::string& note) const;

private:
    void dispatch(const TlogFrame& frame);
    TlogStart* start_at(std::uint32_t boot_ms, std::int64_t stamp_us);
    TlogStart* start_at(std::int64_t ns, std::int64_t stamp_us);
    TlogStart& latest_start();
    void take_attitude(const TlogFrame& frame);
    void take_global(const TlogFrame& frame);
    void take_local(const TlogFrame& frame);
    void take_receiver(const TlogFrame& frame);
    void take_truth(const TlogFrame& frame);
    void take_hil(const TlogFrame& frame);
    void take_clock(const TlogFrame& frame);
    [[nodiscard]] std::vector<FlightRow> local_rows(const TlogStart& start) const;

    AutopilotStarts boots_;
    std::vector<TlogStart> starts_;
    std::optional<GlobalSample> origin_;
    std::optional<std::uint32_t> last_ms_;
    std::int64_t wraps_ = 0, now_ns_ = 0;
    std::optional<TlogFrame> refused_;  // the last one whose time does not fit
    std::size_t now_start_ = 0, places_ = 0, refusals_ = 0;
    bool is_autopilot_ = false, is_ardupilot_ = false;
};

}  // namespace skyloop::inline motion
