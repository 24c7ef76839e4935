#include "run/emulator/run_caster.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "firmware/core/board_profile.hpp"
#include "receiver/protocol/rtcm3_signals.hpp"
#include "run/emulator/wires.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::size_t most_kept_bytes = std::size_t{256} << 10U;

// The tens of the numbers of multiple signal messages (RTCM 10403.3, table 3.5-1).
struct MsmSystem {
    int first;
    std::string_view name;  // as source tables have it
};
constexpr std::array<MsmSystem, 6> msm_systems{
    {{1070, "GPS"}, {1080, "GLO"}, {1090, "GAL"}, {1100, "SBAS"}, {1110, "QZS"}, {1120, "BDS"}}};

const MsmSystem* system_of(int number) {
    const auto found = std::find_if(msm_systems.begin(), msm_systems.end(),
                                    [&](const MsmSystem& s) { return number > s.first && number <= s.first + 7; });
    return found == msm_systems.end() ? nullptr : &*found;
}

// Signals 2 to 6 are of the upper band of each system, 30 to 32 L1C of GPS and QZSS (RTCM 10403.3, tables 3.5-91 ff).
int bands_of(std::uint32_t signals) {
    constexpr int first = 2, last = 6, first_l1c = 30;
    int bands = 0;
    for (int id = 1; id <= 32; ++id)
        if ((signals >> (32 - id) & 1U) != 0)
            bands = std::max(bands, (id >= first && id <= last) || id >= first_l1c ? 1 : 2);
    return bands;
}

std::string interval_text(std::uint64_t count, Nanoseconds span) {
    if (count < 2 || span.count() <= 0) return "1";
    const double each_s = static_cast<double>(span.count()) * 1e-9 / static_cast<double>(count - 1);
    return fmt::format("{:g}", each_s < 1 ? std::round(each_s * 100) / 100 : std::round(each_s));
}

}  // namespace

// What a client has not had yet.
class PortCorrections::Stream : public CorrectionsStream {
public:
    Stream(std::shared_ptr<const PortCorrections> port, std::uint64_t next) : port_(std::move(port)), next_(next) {}
    Bytes take() override { return port_->frames_since(next_); }
    void hear_position(std::string_view) override {}  // a base is where it is

private:
    std::shared_ptr<const PortCorrections> port_;
    std::uint64_t next_;
};

PortCorrections::PortCorrections(SourceRecord about, const Geodetic& place, bool sbf) : about_(std::move(about)) {
    StreamProtocols protocols;
    protocols.sbf = sbf;
    splitter_ = StreamSplitter(protocols);
    about_.latitude_deg = place.latitude.deg();
    about_.longitude_deg = place.longitude.deg();
}

bool PortCorrections::hear(ByteSpan bytes, GpsTime now) {
    bool any = false;
    for (StreamPiece& piece : splitter_.feed(bytes)) {
        if (piece.kind != StreamKind::rtcm3) continue;
        any = true;
        const std::lock_guard lock(mutex_);
        if (const auto message = parse_rtcm3(piece.bytes)) note(*message, now);
        bytes_ += piece.bytes.size();
        frame_bytes_ += piece.bytes.size();
        frames_.push_back(std::move(piece.bytes));
        for (; frame_bytes_ > most_kept_bytes; ++first_frame_) {
            frame_bytes_ -= frames_.front().size();
            frames_.pop_front();
        }
    }
    return any;
}

void PortCorrections::note(const Rtcm3Message& message, GpsTime now) {
    Heard& heard = heard_.try_emplace(message.number, Heard{0, now, now}).first->second;
    ++heard.count;
    heard.last = now;
    if (const auto station = decode_station(message)) {
        constexpr double tenth_of_mm = 1e-4;
        const auto at = [&](std::size_t axis) { return tenth_of_mm * static_cast<double>(station->position[axis]); };
        const Geodetic place = to_geodetic(Position<Ecef>(at(0), at(1), at(2)));
        about_.latitude_deg = place.latitude.deg();
        about_.longitude_deg = place.longitude.deg();
    }
    const MsmSystem* const system = system_of(message.number);
    const auto header = system != nullptr ? decode_msm_header(message) : std::nullopt;
    if (!header) return;
    systems_.insert(std::string(system->name));
    about_.carrier = std::max(about_.carrier, bands_of(header->signals));
}

std::string PortCorrections::table_line(bool needs_password) const {
    const std::lock_guard lock(mutex_);
    SourceRecord record = about_;
    record.needs_password = needs_password;
    std::vector<std::string> details, systems;
    GpsTime first = GpsTime::max(), last{};
    for (const auto& [number, heard] : heard_) {
        details.push_back(fmt::format("{}({})", number, interval_text(heard.count, heard.last - heard.first)));
        first = std::min(first, heard.first);
        last = std::max(last, heard.last);
    }
    for (const MsmSystem& system : msm_systems)
        if (systems_.contains(std::string(system.name))) systems.emplace_back(system.name);
    record.details = fmt::format("{}", fmt::join(details, ","));
    record.systems = fmt::format("{}", fmt::join(systems, "+"));
    const double span_s = heard_.empty() ? 0 : static_cast<double>((last - first).count()) * 1e-9;
    if (span_s > 0) record.bit_rate = static_cast<int>(8 * static_cast<double>(bytes_) / span_s);
    return source_line(record);
}

std::unique_ptr<CorrectionsStream> PortCorrections::open() {
    const std::lock_guard lock(mutex_);
    return std::make_unique<Stream>(shared_from_this(), first_frame_ + frames_.size());
}

Bytes PortCorrections::frames_since(std::uint64_t& next) const {
    const std::lock_guard lock(mutex_);
    Bytes bytes;
    next = std::max(next, first_frame_);
    for (; next < first_frame_ + frames_.size(); ++next) {
        const Bytes& frame = frames_[static_cast<std::size_t>(next - first_frame_)];
        bytes.insert(bytes.end(), frame.begin(), frame.end());
    }
    return bytes;
}

namespace {

// A name of a receiver as a mount point may have it.
std::string mount_name(std::string name) {
    std::replace_if(
        name.begin(), name.end(),
        [](char c) {
            const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
            return !letter && c != '-' && c != '_' && c != '.';
        },
        '_');
    return name;
}

Result<std::vector<CasterMount>> mounts_of(const Scenario& scenario, const std::vector<Station>& stations) {
    const CasterSettings& caster = scenario.caster;
    std::vector<CasterMount> mounts = caster.mounts;
    for (const CasterMount& mount : mounts)
        if (const auto& board = stations.at(mount.receiver).receiver().board();
            !mount.virtual_station && !sends_rtcm(board))
            return fail(ErrorCode::usage,
                        fmt::format("{}{} sends no RTCM; expected a board that does, such as ublox-f9p", mount.told_at,
                                    board.name));
    for (std::size_t i = 0; i < stations.size() && caster.mounts.empty(); ++i)
        if (sends_rtcm(stations[i].receiver().board())) mounts.push_back({mount_name(stations[i].name()), i, "", ""});
    if (caster.virtual_mount) {
        const CasterMount& more = *caster.virtual_mount;
        if (std::any_of(mounts.begin(), mounts.end(), [&](const CasterMount& m) { return m.name == more.name; }))
            return fail(ErrorCode::usage, fmt::format("{}'{}' is the mount point of a receiver; expected another name",
                                                      more.told_at, more.name));
        mounts.push_back(more);
    }
    if (mounts.empty())
        return fail(
            ErrorCode::usage,
            fmt::format("{}no receiver of this run can send RTCM; expected a board that does, such as ublox-f9p",
                        caster.told_at));
    return mounts;
}

struct PluggedMount {
    std::size_t receiver = 0;
    firmware::PortId port;
    std::shared_ptr<PortCorrections> source;
};

Result<firmware::PortId> port_of(const CasterMount& mount, const firmware::BoardProfile& board) {
    if (mount.port.empty()) return default_port(board);
    return port_of_board(mount.port, board);
}

Result<PluggedMount> plug_of(const CasterMount& mount, const Station& station, const Geodetic& place) {
    const firmware::BoardProfile& board = station.receiver().board();
    const auto port = port_of(mount, board);
    if (!port) return fail(ErrorCode::usage, mount.told_at + port.error().message);
    SourceRecord about;
    about.mount = mount.name;
    about.identifier = fmt::format("{} ({})", station.name(), board.name);
    return PluggedMount{mount.receiver, *port,
                        std::make_shared<PortCorrections>(about, place, board.maker == firmware::MakerKind::sbf)};
}

}  // namespace

std::string RunCaster::warning() const {
    return open_to_all_ ? fmt::format("caster {}: serves whoever reaches it; [caster.users] asks for passwords",
                                      shown_address(caster_->address()))
                        : std::string();
}

namespace {

Result<VirtualSky> virtual_sky(const Scenario& scenario, const Assembly& assembly, const CasterHost& host) {
    return VirtualSky::of(scenario, {assembly.emulator->simulation().navigation(), assembly.geoid.get(), assembly.start,
                                     host.data, assembly.emulator->simulation().precise()});
}

// The first of the mount points with virtual stations; null: there is none.
const CasterMount* first_virtual(const std::vector<CasterMount>& mounts) {
    const auto found =
        std::find_if(mounts.begin(), mounts.end(), [](const CasterMount& mount) { return mount.virtual_station; });
    return found == mounts.end() ? nullptr : &*found;
}

Error at_mount(const CasterMount& mount, Error error) {
    error.message = mount.told_at + error.message;
    return error;
}

SourceRecord virtual_record(const CasterMount& mount, const std::set<SystemSignal>& signals, const Geodetic& place) {
    SourceRecord about;
    about.mount = mount.name;
    about.identifier = fmt::format("{} (virtual reference stations)", mount.name);
    about.latitude_deg = place.latitude.deg();
    about.longitude_deg = place.longitude.deg();
    about.carrier = 2;
    std::vector<std::string> details, systems;
    for (const int number : {1006, 1008, 1033})
        details.push_back(fmt::format("{}({})", number, VirtualStations::station_every_s));
    for (const MsmSystem& system : msm_systems) {
        const auto constellation = msm_constellation(system.first + mount.msm);
        if (std::none_of(signals.begin(), signals.end(),
                         [&](const SystemSignal& signal) { return signal.constellation == constellation; }))
            continue;
        details.push_back(fmt::format("{}(1)", system.first + mount.msm));
        systems.emplace_back(system.name);
    }
    if (signals.contains({Constellation::glonass, first_signal(Constellation::glonass)}))
        details.push_back(fmt::format("1230({})", VirtualStations::station_every_s));
    about.details = fmt::format("{}", fmt::join(details, ","));
    about.systems = fmt::format("{}", fmt::join(systems, "+"));
    return about;
}

// The virtual ones among the mount points; null where there are none.
Result<std::shared_ptr<VirtualStations>> plug_in_virtual(const std::vector<CasterMount>& mounts,
                                                         NtripCasterSettings& settings, const Scenario& scenario,
                                                         const Assembly& assembly, const CasterHost& host) {
    const CasterMount* const first = first_virtual(mounts);
    if (first == nullptr) return nullptr;
    auto sky = virtual_sky(scenario, assembly, host);
    if (!sky) return fail(at_mount(*first, sky.error()));
    const std::set<SystemSignal> signals = sky->signals();
    auto stations = std::make_shared<VirtualStations>(std::move(*sky), scenario.run.seed_of_receivers(), host.version);
    for (const CasterMount& mount : mounts)
        if (mount.virtual_station)
            settings.mounts[mount.name] = stations->mount(virtual_record(mount, signals, assembly.place), mount.msm);
    return stations;
}

}  // namespace

Result<void> RunCaster::check(const Scenario& scenario, const Assembly& assembly, const CasterHost& host) {
    if (scenario.caster.listen.empty()) return {};
    const auto address = parse_tcp_address(scenario.caster.listen);
    if (!address) return fail(ErrorCode::usage, scenario.caster.told_at + address.error().message);
    const std::vector<Station>& stations = std::as_const(*assembly.emulator).stations();
    const auto mounts = mounts_of(scenario, stations);
    if (!mounts) return fail(mounts.error());
    for (const CasterMount& mount : *mounts)
        if (const auto port = port_of(mount, stations.at(mount.receiver).receiver().board());
            !mount.virtual_station && !port)
            return fail(ErrorCode::usage, mount.told_at + port.error().message);
    if (const CasterMount* const mount = first_virtual(*mounts))
        if (const auto sky = virtual_sky(scenario, assembly, host); !sky) return fail(at_mount(*mount, sky.error()));
    return {};
}

namespace {

// The receivers' mount points, and who feeds them.
Result<std::vector<PluggedMount>> plug_in_receivers(const std::vector<CasterMount>& mounts,
                                                    NtripCasterSettings& settings, const std::vector<Station>& stations,
                                                    const Geodetic& place) {
    std::vector<PluggedMount> plugged;
    for (const CasterMount& mount : mounts) {
        if (mount.virtual_station) continue;
        auto plug = plug_of(mount, stations.at(mount.receiver), place);
        if (!plug) return fail(plug.error());
        settings.mounts[mount.name] = plug->source;
        plugged.push_back(std::move(*plug));
    }
    return plugged;
}

}  // namespace

Result<RunCaster> RunCaster::start(const Scenario& scenario, Assembly& assembly, const CasterHost& host) {
    const CasterSettings& asked = scenario.caster;
    auto address = parse_tcp_address(asked.listen);
    if (!address) return fail(ErrorCode::usage, asked.told_at + address.error().message);
    Emulator& emulator = *assembly.emulator;
    const auto mounts = mounts_of(scenario, emulator.stations());
    if (!mounts) return fail(mounts.error());
    NtripCasterSettings settings{std::move(*address), asked.users, {}};
    const auto plugged = plug_in_receivers(*mounts, settings, emulator.stations(), assembly.place);
    if (!plugged) return fail(plugged.error());
    const auto virtual_stations = plug_in_virtual(*mounts, settings, scenario, assembly, host);
    if (!virtual_stations) return fail(virtual_stations.error());
    auto started = NtripCaster::start(std::move(settings));
    if (!started) return fail(started.error());
    const std::shared_ptr<NtripCaster> caster = std::move(*started);
    for (const PluggedMount& plug : *plugged)
        emulator.stations()
            .at(plug.receiver)
            .add_tap(plug.port, [caster, source = plug.source](ByteSpan bytes, GpsTime now) {
                if (source->hear(bytes, now)) caster->wake();
            });
    if (*virtual_stations)
        emulator.on_look([caster, stations = *virtual_stations](GpsTime now) {
            if (stations->look(now)) caster->wake();
        });
    std::vector<std::string> names;
    for (const CasterMount& mount : *mounts)
        names.push_back(mount.name);
    const bool open_to_all = asked.users.empty() && !caster->loopback();
    return RunCaster(caster, fmt::format("{} ({})", shown_address(caster->address()), fmt::join(names, ", ")),
                     open_to_all);
}

}  // namespace skyloop::inline run
