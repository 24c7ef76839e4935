#include "detail/epoch_writer.hpp"

#include <optional>

#include "firmware/messages/other_protocols.hpp"
#include "run/output/epoch_record.hpp"
#include "run/output/hil_gps.hpp"

namespace skyloop {
namespace {

constexpr Nanoseconds heartbeat_every = std::chrono::seconds(1);

class JsonWriter : public EpochWriter {
public:
    Job note(const EpochSeen& seen, const std::string& receiver, std::uint64_t number) override {
        return [record = record_epoch(seen, receiver, number)] {
            return std::vector<Bytes>{to_bytes(epoch_line(record))};
        };
    }
};

class MspWriter : public EpochWriter {
public:
    explicit MspWriter(std::uint8_t instance) : instance_(instance) {}

    Job note(const EpochSeen& seen, const std::string&, std::uint64_t) override {
        if (!seen.leaves) return [] { return std::vector<Bytes>{}; };
        MspSensorGps message = firmware::msp_sensor_gps(seen.reported);
        message.instance = instance_;
        return [message] { return std::vector<Bytes>{encode_msp(message)}; };
    }

private:
    std::uint8_t instance_;
};

// A component of MAVLink: its messages are numbered in the order of sending, and each second begins with a heartbeat.
class MavlinkWriter : public EpochWriter {
public:
    explicit MavlinkWriter(const OutputSettings& settings) : settings_(settings) {
        source_.system = settings.system;
        source_.component = settings.component;
    }

    Job note(const EpochSeen& seen, const std::string&, std::uint64_t) override {
        if (!seen.leaves) return [this, now = seen.now] { return beat(now); };
        if (settings_.format == OutputFormat::gps_input) {
            MavlinkGpsInput message = firmware::mavlink_gps_input(seen.reported);
            message.gps_id = settings_.id;
            return [this, now = seen.now, message] { return told(now, message); };
        }
        MavlinkHilGps message = mavlink_hil_gps(seen.reported, settings_.eph);
        message.id = settings_.id;
        return [this, now = seen.now, message] { return told(now, message); };
    }

private:
    std::vector<Bytes> beat(GpsTime now) {
        if (beat_at_ && now < *beat_at_ + heartbeat_every) return {};
        beat_at_ = now;
        return {numbered(MavlinkHeartbeat{})};
    }
    template <class Message>
    std::vector<Bytes> told(GpsTime now, const Message& message) {
        std::vector<Bytes> frames = beat(now);
        frames.push_back(numbered(message));
        return frames;
    }
    template <class Message>
    Bytes numbered(const Message& message) {
        Bytes frame = encode_mavlink(source_, message);
        ++source_.sequence;
        return frame;
    }

    OutputSettings settings_;
    MavlinkSource source_;
    std::optional<GpsTime> beat_at_;
};

}  // namespace

std::unique_ptr<EpochWriter> make_epoch_writer(const OutputSettings& settings) {
    switch (settings.format) {
        case OutputFormat::json:
            return std::make_unique<JsonWriter>();
        case OutputFormat::msp:
            return std::make_unique<MspWriter>(settings.id);
        default:
            return std::make_unique<MavlinkWriter>(settings);
    }
}

}  // namespace skyloop
