/// What distinguishes one receiver model from another, as data.
/// What a board sends and answers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/units.hpp"
#include "firmware/core/port_id.hpp"
#include "receiver/protocol/nmea_satellites.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::firmware {

struct FirmwareList;

/// Sentences that a receiver can send periodically, in the order in which they leave within one epoch unless the board
/// gives another (`BoardProfile::messages`).
enum class NmeaSentence { rmc, vtg, gga, gns, gsa, gsv, gll, gst, zda, gbs, dtm, grs, vlw, ths, hdt, hdg, rot };
inline constexpr std::string_view nmea_sentence_names[] = {"RMC", "VTG", "GGA", "GNS", "GSA", "GSV",
                                                           "GLL", "GST", "ZDA", "GBS", "DTM", "GRS",
                                                           "VLW", "THS", "HDT", "HDG", "ROT"};
/// Their ids in class F0, as u-blox's CFG-MSG numbers them; those of HDT, HDG and ROT, which no u-blox has, are our
/// own.
inline constexpr std::uint8_t nmea_sentence_ids[] = {0x04, 0x05, 0x00, 0x0D, 0x02, 0x03, 0x01, 0x07, 0x08,
                                                     0x09, 0x0A, 0x06, 0x0F, 0x0E, 0x30, 0x31, 0x32};

/// A sentence and every how many epochs it is sent.
struct SentenceRate {
    NmeaSentence sentence;
    int every_epochs = 1;
};

/// Whose commands a receiver understands, or which protocol other than NMEA and UBX it speaks, without taking commands.
enum class MakerKind {
    mute,      ///< nobody's
    ublox,     ///< UBX and PUBX
    mtk,       ///< MediaTek PMTK
    airoha,    ///< Airoha PAIR
    msp,       ///< MSP2_SENSOR_GPS of the MultiWii Serial Protocol
    msp_v1,    ///< its older MSP_SET_RAW_GPS
    mavlink,   ///< MAVLink GPS_INPUT
    sbf,       ///< Septentrio's blocks
    unicore,   ///< Unicore's text commands, its logs in ASCII and binary
    dronecan,  ///< a node of DroneCAN
    casic,     ///< CASIC's PCAS and binary frames
    quectel,   ///< Quectel's PQTM, and PAIR of those with Airoha's chips
    ufirebird  ///< Unicore's UFirebird chips: CFGSYS, CFGMSG, PDTINFO
};

/// At which speed the answer leaves to a message that changes the speed of the port it came by.
enum class SpeedChangeAnswer { at_new_speed, at_old_speed, lost };

/// What a receiver does with a legacy configuration message.
enum class LegacyAnswer {
    apply,   ///< takes it
    ignore,  ///< acknowledges it, and that is all
    refuse,  ///< ACK-NAK
    silence
};

/// What a receiver says to CFG-VALSET, VALGET and VALDEL.
enum class ValueConfigSupport { full, refuse, silence };

/// Who it says it is (MON-VER, SEC-UNIQID, MON-GNSS, boot banner).
struct Identity {
    int generation = 8;                   ///< of u-blox: 6, 7, 8, 9, 10
    std::string software;                 ///< swVersion
    std::string hardware;                 ///< hwVersion
    std::vector<std::string> extensions;  ///< of MON-VER, at most 30 characters each
    Bytes unique_id;                      ///< five bytes, or six on M10
    /// Texts of the TXT notices at start; whole sentences without checksum where they begin with $.
    std::vector<std::string> banner;
    std::vector<std::string> version_answers;  ///< to PMTK605, PAIR020: sentences from $, without checksum
};

/// What its USB port says it is (USB 2.0, table 9-8); on u-blox also what CFG-USB answers.
struct UsbDescription {
    std::uint16_t vendor_id = 0, product_id = 0;
    std::uint16_t release = 0x0100;  ///< bcdDevice: 0x0301 is 3.01
    std::string manufacturer;        ///< at most 31 characters, as of the other texts
    std::string product;
    std::string serial;  ///< empty: it has none
};

/// Times of starting and answering.
struct Timing {
    Seconds boot{0.5};                                       ///< from power to the first byte
    Seconds first_epoch{1.0};                                ///< from the end of the banner
    Seconds answer{0.003};                                   ///< from a message's last byte to the first of its answer
    Seconds flash_write{0.1};                                ///< more for what is saved
    Seconds signal_restart{0.5};                             ///< without output after a change of the tracked signals
    Seconds latency_deviation{0};                            ///< 1 σ of the solution latency
    Seconds command_sleep{0};                                ///< after a start, in which PAIR382,1 alone is heard
    Seconds coasting{0};                                     ///< for which a lost solution goes on by its velocity
    Seconds cold_start{26}, warm_start{24}, hot_start{1.5};  ///< to the first fix (RECEIVER.md 4.8)
};

/// How a receiver saves power, as it is built (every value in boards/README.md).
struct PowerAbility {
    bool save_modes = false;          ///< CFG-PM: on and off, and cyclic tracking
    bool backup = false;              ///< RXM-PMREQ, and CFG-PWR where the board takes it
    bool backup_needs_force = false;  ///< RXM-PMREQ without the flag `force` does nothing
    bool keeps_ram = false;           ///< what is configured in RAM outlives being off
    bool banner = true;               ///< the texts of a start come after being off, too
    std::vector<std::string> texts;   ///< in place of these; empty: they themselves
    Seconds wake{0.4};                ///< from an edge, or from its time, until it hears
    Seconds acquisition{120};         ///< without a fix, where the user leaves that to the receiver
    Seconds blind_acquisition{15};    ///< the same while it hears no satellite; 0: as long as otherwise
    Seconds search_margin{1};         ///< so much ahead of the search grid it wakes
    Seconds download{30};             ///< of ephemerides, every half hour
};

/// What becomes of the corrections of a base station. How soon carrier phases are solved is up to the data; of sensor
/// models, which measure none, the two times tell it.
struct CorrectionAbility {
    bool rtk = false;         ///< resolves carrier phases; without, corrections make a differential solution
    Seconds float_after{5};   ///< of a sensor model, from the first complete set
    Seconds fixed_after{15};  ///< the same
    Seconds fixed_held{15};   ///< age of the corrections until the solution is float again
    Seconds float_held{30};   ///< and until it is differential
};

/// Where units of one model differ, or no document says what it does: each a key of the board file.
struct Quirks {
    ValueConfigSupport value_config = ValueConfigSupport::full;
    bool single_key_valget = false;       ///< a VALGET for several keys is refused (M10 SPG 5.10)
    bool empty_valget_page = false;       ///< a VALGET page past the last item is answered (X20P; ZED-F9P: ACK-NAK)
    bool l5_health_by_version_1 = false;  ///< CFG-SIGNAL-HEALTH_L5 is set by version 1 of CFG-VALSET alone (DAN-F10N)
    bool hardware_reset_clears_battery = true;
    SpeedChangeAnswer speed_change = SpeedChangeAnswer::at_new_speed;
    bool answers_unknown_nmea = false;  ///< "… inv format" (M8)
    bool overflow_notice = false;       ///< a TXT says that messages did not fit into the transmit buffer
    bool default_interference_monitor = false;
    bool voltage_control = false;     ///< watches its antenna's supply from the factory on
    std::optional<int> leap_seconds;  ///< that it believes until it has decoded them; nothing: the right ones
};

/// What a node of a CAN bus has (DroneCAN).
struct CanNode {
    int node_id = 0;  ///< 1 … 125, counted up by the further receivers of a run; 0: it asks for one
    std::string name = "org.skyloop.gnss";
    bool two_antennas = false;  ///< the vector of a pair is a heading of its own: Heading in place of RelPosHeading
};

/// The blocks of CFG-GNSS as the board answers them.
struct GnssBlock {
    std::uint8_t gnss_id = 0, reserved_channels = 0, max_channels = 0;
    std::uint32_t flags = 0;  ///< as on the wire; bit 0 is replaced by what is configured
};

/// What HDT, THS, HDG and ROT tell where no pair of antennas measures a heading.
enum class HeadingSource {
    antennas,  ///< nothing
    course,    ///< the course over ground
    attitude   ///< what a compass beside the receiver says of the vehicle
};
/// What sentences call a valid fix.
enum class ToldQuality {
    solved,    ///< as it was solved
    precise,   ///< one by satellites alone PPS: GGA 3, mode P
    manual,    ///< entered by hand: 7, M
    simulator  ///< simulated: 8, S
};
/// How satellites in use are told.
enum class GsaStyle {
    by_system,  ///< a sentence for each system, by the main talker
    by_talker,  ///< the same by each system's own
    one         ///< one sentence for all
};
/// What GGA and GNS say of the geoid.
enum class ToldGeoid {
    separation,  ///< its separation; the altitude is above the sea
    zero,        ///< 0; the altitude is above the ellipsoid
    nothing      ///< an empty field, the same
};

/// A sentence of the maker's own that comes with every so many epochs (firmware/sentences/own_lines.hpp).
struct OwnLine {
    std::string text;  ///< from "$" on, without checksum; {names} stand for values
    int every_epochs = 1;
    std::optional<NmeaSentence> after{};  ///< it follows the last of these of the epoch; nothing: at its end
};

/// How fields of sentences look, where makers differ; the defaults are u-blox's (RECEIVER.md 5.3, 5.8 to 5.10).
struct NmeaStyle {
    int speed_decimals = 3;                                 ///< of RMC (knots) and VTG (knots, km/h)
    int course_decimals = 2;                                ///< of RMC and VTG
    bool course_always = false;                             ///< the course is printed even at rest and frozen
    bool satellites_padded = true;                          ///< numSV of GGA and GNS in two digits: "07", not "7"
    int vtg_speed_decimals = -1, vtg_course_decimals = -1;  ///< of VTG alone; -1: as in RMC
    int altitude_decimals = 1;                              ///< of GGA and GNS
    int dop_decimals = 2;
    double unknown_dop = 99.99;         ///< of what was not computed
    bool magnetic_fields = false;       ///< RMC has the magnetic variation, and VTG the magnetic course
    double magnetic_variation_deg = 0;  ///< that it believes, east positive; of HDG too
    int heading_decimals = 2;           ///< of HDT, THS and HDG
    HeadingSource heading = HeadingSource::antennas;
    std::string heading_talker;  ///< of HDT, THS, HDG and ROT; empty: the main one
    ToldQuality quality = ToldQuality::solved;
    bool simulated_is_valid = false;  ///< RMC and GLL say A with the modes M and S
    GsaStyle gsa = GsaStyle::by_system;
    ToldGeoid geoid = ToldGeoid::separation;
    std::map<UbxMessageId, int> late;  ///< sentences that tell the epoch so many before
    std::vector<OwnLine> lines;
    std::string rmc_status = "V";  ///< the last letter of a valid RMC since 4.10, its navigational status
    bool gsa_manual = false;       ///< GSA says M whatever chooses between 2D and 3D
    /// Lists have what is tracked alone: GSV no satellites without a signal, GSA no systems without one in use. Without
    /// any there is one sentence of GP, that of GSA without a mode and that of GSV with the fields of one satellite.
    bool tracked_only = false;
    bool one_gsv_list = false;         ///< GSV has one list of each system, of signal 0 from 4.10 on (CASIC)
    std::string station_field;         ///< of GGA without corrections: empty, or "0000"
    std::string beidou_talker = "GB";  ///< or "BD"
    std::string qzss_talker = "GQ";    ///< or "QZ"; of versions in which QZSS has its own
    bool gst_ellipse = true;           ///< GST tells the axes of the error ellipse (F9P: not)
    bool gst_padded = false;           ///< its fields look like "004.0", the last like "00014" (MTK)
    /// Without a fix DOPs are empty, units of heights stay, speed and course are 0.00 (MTK; u-blox: 99.99, and
    /// nothing).
    bool zeros_without_fix = false;
    bool unknown_date_is_1980 = false;  ///< before the date is known RMC says 050180 and a time since power-on (MTK)
};

/// When a fix is withheld for export: height over 18 288 m (60 000 ft), speed over 515 m/s (1000 knots), limits that
/// some makers read as one rule and others as two (FEEDS.md 2.5).
enum class ExportLimits { off, both_exceeded, either_exceeded };

/// Speeds of a UART that a board may have, bit/s.
inline constexpr std::uint32_t slowest_baud = 1200, fastest_baud = 8'000'000;

/// One receiver model (boards/receivers/*.toml; every key in boards/README.md).
struct BoardProfile {
    std::string name;
    std::string description;
    std::vector<std::string> aliases;  ///< names of modules that mean this board, too
    std::vector<std::string> sources;  ///< of what its file says, for people
    std::vector<std::string> files;    ///< its own, and those of the boards that it extends, the nearest first
    MakerKind maker = MakerKind::mute;
    Identity identity;
    Timing timing;
    Quirks quirks;
    CorrectionAbility corrections;
    PowerAbility power;
    CanNode can;

    std::uint32_t baud = 9600;  ///< of UART1 at the factory
    std::uint32_t transmit_buffer_bytes = 4096;
    /// In the buffer, up to which the next message of an epoch is generated. Invented: the acknowledgement of an M10 at
    /// 9600 baud can take "over a second" (PX4-GPSDrivers, src/ubx.cpp).
    std::uint32_t generated_ahead_bytes = 1024;
    std::vector<PortId> ports{PortId::uart1};
    std::optional<UsbDescription> usb;  ///< nothing: it has no USB of its own
    std::vector<std::uint32_t>
        bauds;  ///< that it can be set to, ascending; empty: all from slowest_baud to fastest_baud

    std::vector<Constellation> constellations;    ///< enabled at the factory
    bool dual_frequency = false;                  ///< tracks the second signal of each system from the factory on
    SecondBand second_band = SecondBand::l2;      ///< where that signal is
    bool bands_together = false;                  ///< refuses one of a system's two bands without the other
    std::vector<Constellation> first_band_alone;  ///< systems that then go with the first of them all the same
    int most_systems = 4;                         ///< of GPS, GLONASS, BeiDou and Galileo that it tracks at once
    /// Sets of items of CFG-SIGNAL that may not all be 1 at once: what its front end cannot receive together.
    std::vector<std::set<std::uint32_t>> signal_conflicts;
    double default_rate_hz = 1;
    double max_rate_hz = 10;
    double all_satellites_rate_hz = 0;  ///< beyond which it solves with `fast_satellites` of them; 0: with all at any
    int fast_satellites = 16;
    int least_measurement_period_ms = 25;  ///< shorter ones are stored as this (CFG-RATE), or refused (VALSET)
    Angle elevation_mask = Angle::degrees(5);
    bool dynamic_limits = true;                      ///< no fix beyond those of the dynamic model, as u-blox has them
    ExportLimits export_limits = ExportLimits::off;  ///< on top of 500 m/s, beyond which no fix is told

    NmeaVersion nmea_version = NmeaVersion::v4_0;
    NmeaNumbering satellite_numbering = NmeaNumbering::strict;
    std::string main_talker;      ///< "GP", "GN", …; empty: by the enabled constellations
    int coordinate_decimals = 5;  ///< digits of the minutes of latitude and longitude
    int time_decimals = 2;
    int max_listed_satellites = 12;         ///< numSV of GGA stops here (12 in strict NMEA)
    MetresPerSecond course_min_speed{0.1};  ///< slower than this, the course is left empty
    NmeaStyle style;
    std::vector<SentenceRate> sentences;  ///< factory output
    /// And of a Septentrio, blocks and groups of them; none: it is silent until it is configured.
    std::vector<std::string> sbf_blocks;
    /// How it measures and solves, as TOML for the modern model: the tables clock, tracking, acquisition and solution.
    std::string modern;
    double geoid_step_deg = 0;  ///< of the grid of its geoid (EGM96), between which it is linear; 0: the whole grid
    Seconds solution_latency{0.05};  ///< from the epoch instant to the first byte of its output

    /// What it can send, in the order in which it leaves within an epoch; sentences among it.
    std::vector<UbxMessageId> messages;
    std::set<UbxMessageId> polled;                ///< what it answers but does not send by itself
    std::map<UbxMessageId, LegacyAnswer> legacy;  ///< legacy configuration messages that it knows
    std::vector<GnssBlock> gnss_blocks;           ///< of CFG-GNSS
    std::uint8_t gnss_channels_hardware = 0, gnss_channels_used = 0;
    std::uint8_t gnss_supported = 0,
                 gnss_simultaneous = 0;             ///< of MON-GNSS: bits 0 GPS, 1 GLONASS, 2 BeiDou, 3 Galileo
    double phase_deviation_scale = 1;               ///< of what RXM-RAWX says of phases, to that of the loop
    double doppler_deviation_hz = 0;                ///< of what RXM-RAWX says of Dopplers, beside the loop
    bool comms_output_port = false;                 ///< MON-COMMS tells by which port it leaves
    std::size_t galileo_words = 8;                  ///< of a pair of pages in RXM-SFRBX; a ninth tells nothing
    std::map<std::uint32_t, std::uint64_t> config;  ///< factory values that differ from ConfigKey::default_value
    const FirmwareList* items_of = nullptr;         ///< whose items it has; null: all that there are
    std::set<std::uint32_t> absent_keys;            ///< of them, those that it does not have
};

/// Whether a UART of the board can be set to a speed.
inline bool takes_baud(const BoardProfile& board, std::uint64_t baud) {
    return board.bauds.empty() ? baud >= slowest_baud && baud <= fastest_baud
                               : std::find(board.bauds.begin(), board.bauds.end(), baud) != board.bauds.end();
}

/// Whether a message can go out periodically.
inline bool sends(const BoardProfile& board, UbxMessageId message) {
    return std::find(board.messages.begin(), board.messages.end(), message) != board.messages.end();
}

/// Whether the board has a message at all: it sends or answers it.
inline bool knows(const BoardProfile& board, UbxMessageId message) {
    return board.polled.contains(message) || sends(board, message);
}

}  // namespace skyloop::firmware
