#include "receiver/protocol/mavlink.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <span>

#include "base/core/words.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::uint8_t mavlink_signed_flag = 0x01;

void append_mavlink_crc(Bytes& frame, std::uint8_t extra) {
    const std::uint16_t crc = crc16_x25({&extra, 1}, crc16_x25(ByteSpan(frame).subspan(1)));
    frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    frame.push_back(static_cast<std::uint8_t>(crc >> 8));
}

MavlinkFrameView mavlink_view(ByteSpan bytes) {
    if (bytes[0] == mavlink_v1_start)
        return {1, {bytes[3], bytes[4], bytes[2]}, bytes[5], false, bytes.subspan(mavlink_v1_head_size, bytes[1])};
    const bool is_signed = (bytes[2] & mavlink_signed_flag) != 0;
    return {2,
            {bytes[5], bytes[6], bytes[4]},
            *mavlink_message_id(bytes),
            is_signed,
            bytes.subspan(mavlink_v2_head_size, bytes[1])};
}

}  // namespace

std::uint16_t crc16_x25(ByteSpan bytes, std::uint16_t crc) {
    unsigned sum = crc;
    for (const std::uint8_t byte : bytes) {
        sum ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            sum = (sum & 1u) != 0 ? sum >> 1 ^ 0x8408u : sum >> 1;
    }
    return static_cast<std::uint16_t>(sum);
}

std::optional<std::uint8_t> mavlink_crc_extra(std::uint32_t message) {
    std::optional<std::uint8_t> extra;
    KnownMavlinkMessages::any([&]<class Message>() {
        if (Message::message_id == message) extra = Message::crc_extra;
        return extra.has_value();
    });
    return extra;
}

Bytes encode_mavlink_v2(MavlinkSource source, std::uint32_t message, ByteSpan payload) {
    const auto extra = mavlink_crc_extra(message);
    if (!extra || payload.size() > 0xFF) return {};
    while (payload.size() > 1 && payload.back() == 0)
        payload = payload.first(payload.size() - 1);
    const auto byte = [message](int shift) { return static_cast<std::uint8_t>(message >> shift & 0xFF); };
    Bytes frame{mavlink_v2_start,
                static_cast<std::uint8_t>(payload.size()),
                0,
                0,
                source.sequence,
                source.system,
                source.component,
                byte(0),
                byte(8),
                byte(16)};
    frame.insert(frame.end(), payload.begin(), payload.end());
    append_mavlink_crc(frame, *extra);
    return frame;
}

Bytes encode_mavlink_v1(MavlinkSource source, std::uint32_t message, ByteSpan payload) {
    const auto extra = mavlink_crc_extra(message);
    if (!extra || payload.size() > 0xFF || message > 0xFF) return {};
    Bytes frame{mavlink_v1_start, static_cast<std::uint8_t>(payload.size()), source.sequence, source.system,
                source.component, static_cast<std::uint8_t>(message)};
    frame.insert(frame.end(), payload.begin(), payload.end());
    append_mavlink_crc(frame, *extra);
    return frame;
}

std::optional<std::size_t> mavlink_frame_size(ByteSpan bytes) {
    if (bytes.size() >= mavlink_v1_head_size && bytes[0] == mavlink_v1_start)
        return mavlink_v1_head_size + bytes[1] + mavlink_crc_size;
    if (bytes.size() < mavlink_v2_head_size || bytes[0] != mavlink_v2_start) return std::nullopt;
    const bool is_signed = (bytes[2] & mavlink_signed_flag) != 0;
    return mavlink_v2_head_size + bytes[1] + mavlink_crc_size + (is_signed ? mavlink_signature_size : 0);
}

std::optional<std::uint32_t> mavlink_message_id(ByteSpan bytes) {
    if (bytes.size() >= mavlink_v1_head_size && bytes[0] == mavlink_v1_start) return bytes[5];
    if (bytes.size() < mavlink_v2_head_size || bytes[0] != mavlink_v2_start) return std::nullopt;
    return bytes[7] | std::uint32_t{bytes[8]} << 8 | std::uint32_t{bytes[9]} << 16;
}

std::optional<MavlinkFrameView> parse_mavlink(ByteSpan bytes) {
    const auto size = mavlink_frame_size(bytes);
    if (!size || *size != bytes.size()) return std::nullopt;
    if (bytes[0] == mavlink_v2_start && (bytes[2] & ~mavlink_signed_flag) != 0) return std::nullopt;
    const MavlinkFrameView frame = mavlink_view(bytes);
    const auto extra = mavlink_crc_extra(frame.message);
    if (!extra) return std::nullopt;
    const auto covered = static_cast<std::size_t>(frame.payload.data() - bytes.data()) + frame.payload.size();
    const std::uint16_t crc = crc16_x25({&*extra, 1}, crc16_x25(bytes.subspan(1, covered - 1)));
    if (bytes[covered] != (crc & 0xFF) || bytes[covered + 1] != crc >> 8) return std::nullopt;
    return frame;
}

std::vector<MavlinkFrameView> mavlink_frames(ByteSpan datagram) {
    std::vector<MavlinkFrameView> frames;
    while (!datagram.empty()) {
        const auto size = mavlink_frame_size(datagram);
        if (!size) {
            datagram = datagram.subspan(1);
            continue;
        }
        if (*size > datagram.size()) break;
        if (const auto frame = parse_mavlink(datagram.first(*size))) frames.push_back(*frame);
        datagram = datagram.subspan(*size);
    }
    return frames;
}

namespace {

struct NumberedMode {
    std::uint32_t number;
    std::string_view name;
};

constexpr NumberedMode copter_modes[] = {
    {0, "STABILIZE"},  {1, "ACRO"},      {2, "ALT_HOLD"}, {3, "AUTO"},    {4, "GUIDED"},      {5, "LOITER"},
    {6, "RTL"},        {7, "CIRCLE"},    {9, "LAND"},     {11, "DRIFT"},  {13, "SPORT"},      {14, "FLIP"},
    {15, "AUTOTUNE"},  {16, "POSHOLD"},  {17, "BRAKE"},   {18, "THROW"},  {19, "AVOID_ADSB"}, {20, "GUIDED_NOGPS"},
    {21, "SMART_RTL"}, {22, "FLOWHOLD"}, {23, "FOLLOW"},  {24, "ZIGZAG"}, {25, "SYSTEMID"},   {26, "AUTOROTATE"},
    {27, "AUTO_RTL"},  {28, "TURTLE"}};

constexpr NumberedMode plane_modes[] = {
    {0, "MANUAL"},        {1, "CIRCLE"},      {2, "STABILIZE"}, {3, "TRAINING"},    {4, "ACRO"},
    {5, "FBWA"},          {6, "FBWB"},        {7, "CRUISE"},    {8, "AUTOTUNE"},    {10, "AUTO"},
    {11, "RTL"},          {12, "LOITER"},     {13, "TAKEOFF"},  {14, "AVOID_ADSB"}, {15, "GUIDED"},
    {16, "INITIALISING"}, {17, "QSTABILIZE"}, {18, "QHOVER"},   {19, "QLOITER"},    {20, "QLAND"},
    {21, "QRTL"},         {22, "QAUTOTUNE"},  {23, "QACRO"},    {24, "THERMAL"},    {25, "LOITER2QLAND"},
    {26, "AUTOLAND"}};

constexpr NumberedMode rover_modes[] = {{0, "MANUAL"},  {1, "ACRO"},         {3, "STEERING"}, {4, "HOLD"},
                                        {5, "LOITER"},  {6, "FOLLOW"},       {7, "SIMPLE"},   {8, "DOCK"},
                                        {9, "CIRCLE"},  {10, "AUTO"},        {11, "RTL"},     {12, "SMART_RTL"},
                                        {15, "GUIDED"}, {16, "INITIALISING"}};

constexpr NumberedMode px4_main_modes[] = {
    {1, "MANUAL"},   {2, "ALTCTL"},     {3, "POSCTL"},    {4, "AUTO"},         {5, "ACRO"},
    {6, "OFFBOARD"}, {7, "STABILIZED"}, {8, "RATTITUDE"}, {10, "TERMINATION"}, {11, "ALTITUDE_CRUISE"}};

constexpr std::uint32_t px4_auto = 4;
constexpr NumberedMode px4_auto_modes[] = {
    {1, "AUTO.READY"}, {2, "AUTO.TAKEOFF"}, {3, "AUTO.LOITER"},        {4, "AUTO.MISSION"},  {5, "AUTO.RTL"},
    {6, "AUTO.LAND"},  {7, "AUTO.RTGS"},    {8, "AUTO.FOLLOW_TARGET"}, {9, "AUTO.PRECLAND"}, {10, "AUTO.VTOL_TAKEOFF"}};

std::string_view name_in(std::span<const NumberedMode> modes, std::uint32_t number) {
    const auto found =
        std::find_if(modes.begin(), modes.end(), [&](const NumberedMode& mode) { return mode.number == number; });
    return found == modes.end() ? std::string_view() : found->name;
}

// By MAV_TYPE: ArduPilot's number of a mode depends on its vehicle.
std::span<const NumberedMode> ardupilot_modes(std::uint8_t vehicle) {
    constexpr std::uint8_t multirotors[] = {2, 3, 4, 13, 14, 15, 29, 35, 43};
    if (std::find(std::begin(multirotors), std::end(multirotors), vehicle) != std::end(multirotors))
        return copter_modes;
    constexpr std::uint8_t fixed_wing = 1, first_vtol = 19, last_vtol = 25;
    if (vehicle == fixed_wing || (vehicle >= first_vtol && vehicle <= last_vtol)) return plane_modes;
    constexpr std::uint8_t ground_rover = 10, surface_boat = 11;
    if (vehicle == ground_rover || vehicle == surface_boat) return rover_modes;
    return {};
}

// The main mode stands in bits 16 to 23, its submode above.
std::string_view px4_mode(std::uint32_t custom_mode) {
    const std::uint32_t main_mode = custom_mode >> 16 & 0xFF, submode = custom_mode >> 24;
    if (main_mode == px4_auto)
        if (const std::string_view name = name_in(px4_auto_modes, submode); !name.empty()) return name;
    return name_in(px4_main_modes, main_mode);
}

bool same_letters(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return upper_case(x) == upper_case(y); });
}

std::vector<std::string> all_mode_names() {
    std::vector<std::string> names;
    for (const std::span<const NumberedMode> modes :
         {std::span<const NumberedMode>(copter_modes), std::span<const NumberedMode>(plane_modes),
          std::span<const NumberedMode>(rover_modes), std::span<const NumberedMode>(px4_main_modes),
          std::span<const NumberedMode>(px4_auto_modes)})
        for (const NumberedMode& mode : modes)
            names.emplace_back(mode.name);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

}  // namespace

std::string mavlink_mode_name(const MavlinkHeartbeat& heartbeat) {
    if ((heartbeat.base_mode & mavlink_custom_mode_enabled) == 0) return {};
    if (heartbeat.autopilot == mavlink_autopilot_px4) return std::string(px4_mode(heartbeat.custom_mode));
    if (heartbeat.autopilot != mavlink_autopilot_ardupilot) return {};
    return std::string(name_in(ardupilot_modes(heartbeat.type), heartbeat.custom_mode));
}

bool is_mavlink_mode(std::string_view mode, std::string_view name) {
    if (name.empty()) return false;
    if (same_letters(mode, name)) return true;
    return mode.size() > name.size() && mode[name.size()] == '.' && same_letters(mode.substr(0, name.size()), name);
}

const std::vector<std::string>& mavlink_mode_names() {
    static const std::vector<std::string> names = all_mode_names();
    return names;
}

}  // namespace skyloop::inline receiver
