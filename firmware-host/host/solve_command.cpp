#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "base/core/files.hpp"
#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "receiver/pvt/navigation_engine.hpp"
#include "run/emulator/navigation_files.hpp"
#include "run/emulator/run_files.hpp"
#include "run_session.hpp"
#include "world/broadcast/daily_navigation.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/rinex/observation_reader.hpp"
#include "world/rinex/precise_orbit_file.hpp"

namespace skyloop::host {
namespace {

struct SolveOptions {
    std::string observations;
    std::vector<std::string> nav;
    std::string sp3;
    std::string base;
    std::vector<double> base_position;
    std::string out;
    std::vector<std::string> systems;
    double mask_deg = 10;
    std::string ionosphere = "klobuchar";
    std::string troposphere = "saastamoinen";
    std::string filter = "none";
    double humidity = 0.7;
    Verbosity verbosity;
};

constexpr std::string_view solved_header =
    "time_utc,gps_week,tow_s,lat_deg,lon_deg,height_m,vel_north_mps,vel_east_mps,vel_down_mps,speed_mps,course_deg,"
    "fix_type,satellites_used,gdop,pdop,hdop,vdop,tdop,h_acc_m,v_acc_m,clock_bias_m\n";

// @param velocity_known a file may hold no Dopplers
std::string solved_row(const Fix& fix, bool velocity_known) {
    const WeekAndTow gps = week_and_tow(fix.time);
    std::string row = fmt::format("{},{},{:.3f},", utc_text(fix.time, 3), gps.week, gps.tow_seconds());
    if (!fix.has_position()) return row + fmt::format(",,,,,,,,{},0,,,,,,,,\n", fix_type_name(fix.type));
    row += fmt::format("{:.9f},{:.9f},{:.4f},", fix.position.latitude.deg(), fix.position.longitude.deg(),
                       fix.position.height.above_ellipsoid.value());
    row += velocity_known ? fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},", fix.velocity.north, fix.velocity.east,
                                        fix.velocity.down, fix.speed.value(), fix.course.deg())
                          : ",,,,,";
    row += fmt::format("{},{},", fix_type_name(fix.type), fix.satellites_used());
    for (const double dop : {fix.dop.gdop, fix.dop.pdop, fix.dop.hdop, fix.dop.vdop, fix.dop.tdop})
        row += std::isfinite(dop) ? fmt::format("{:.3f},", dop) : ",";
    return row + fmt::format("{:.3f},{:.3f},{:.4f}\n", fix.horizontal_accuracy.value(), fix.vertical_accuracy.value(),
                             fix.clock_bias.value());
}

// That of an observation whose file does not tell it.
constexpr DbHz untold_cn0{0};

NavigationParameters parameters_of(const SolveOptions& options) {
    NavigationParameters p;
    p.corrections.ionosphere = options.ionosphere == "none"        ? IonosphereCorrection::none
                               : options.ionosphere == "klobuchar" ? IonosphereCorrection::klobuchar
                                                                   : IonosphereCorrection::broadcast;
    p.corrections.troposphere = options.troposphere == "none"           ? TroposphereCorrection::none
                                : options.troposphere == "saastamoinen" ? TroposphereCorrection::saastamoinen
                                                                        : TroposphereCorrection::niell;
    p.corrections.relative_humidity = options.humidity;
    p.corrections.default_ionosphere = true;
    p.filter.kind = options.filter == "none" ? FilterKind::none : FilterKind::smoothed;
    // Files of orbits hold every record: none has to be heard from its satellite first.
    p.data.decoding_cn0 = untold_cn0;
    p.ephemeris_collection = Seconds(0);
    return p;
}

ReceiverSettings settings_of(const SolveOptions& options) {
    ReceiverSettings settings;
    settings.elevation_mask = Angle::degrees(options.mask_deg);
    settings.minimum_cn0 = untold_cn0;
    settings.dynamic_model = DynamicModel::airborne_4g;
    return settings;
}

// Those of --systems; none: all that are observed.
std::set<Constellation> wanted_systems(const SolveOptions& options) {
    std::set<Constellation> wanted;
    for (const std::string& name : options.systems)
        if (const auto system = constellation_from_name(name)) wanted.insert(*system);
    return wanted;
}

// Orbits that do not reach the observations serve nobody.
void warn_of_span(const ObservationFile& file, const std::optional<TimeSpan>& span, std::string_view orbits,
                  const Messages& messages) {
    const GpsTime first = file.epochs.front().receive_time, last = file.epochs.back().receive_time;
    if (!span || (first >= span->first && last <= span->last)) return;
    messages.warning(fmt::format("the observations of {} to {} are not all in the time of the {}, {} to {}",
                                 utc_text(first), utc_text(last), orbits, utc_text(span->first), utc_text(span->last)));
}

// From the first row of any satellite to the last.
std::optional<TimeSpan> span_of(const PreciseOrbits& orbits) {
    std::optional<TimeSpan> span;
    for (const auto& [satellite, rows] : orbits.samples()) {
        if (rows.empty()) continue;
        if (!span) span = TimeSpan{rows.front().time, rows.back().time};
        *span = {std::min(span->first, rows.front().time), std::max(span->last, rows.back().time)};
    }
    return span;
}

// The files of --nav; in the place of "auto" those of the cache, of each day of the observations.
Result<std::vector<std::filesystem::path>> navigation_of(const SolveOptions& options, const ObservationFile& file) {
    std::vector<std::filesystem::path> files(options.nav.begin(), options.nav.end());
    if (std::find(options.nav.begin(), options.nav.end(), automatic_navigation_word) == options.nav.end()) return files;
    if (files.size() > 1) return fail(ErrorCode::usage, "--nav auto: has files beside it; expected either");
    files.clear();
    const GpsTime last = file.epochs.back().receive_time;
    for (GpsTime day = day_of(file.epochs.front().receive_time); day <= last; day += std::chrono::days(1)) {
        const auto cached = cached_navigation(data_folders(), day);
        if (!cached) return fail(cached.error());
        files.push_back(*cached);
    }
    return files;
}

// The broadcast records for the span of the observations; none without a file.
Result<std::unique_ptr<NavigationSource>> broadcast_of(const SolveOptions& options, const ObservationFile& file,
                                                       const Messages& messages) {
    if (options.nav.empty()) return std::make_unique<NavigationData>(std::vector<Ephemeris>{}, std::nullopt, "nothing");
    Scenario scenario;
    auto files = navigation_of(options, file);
    if (!files) return fail(files.error());
    scenario.sky.navigation = std::move(*files);
    std::vector<std::string> warnings;
    auto data = read_navigation_files(scenario, file.epochs.front().receive_time, warnings);
    if (!data) return fail(data.error());
    messages.warnings(warnings);
    warn_of_span(file, data->span(), "navigation data", messages);
    return std::make_unique<NavigationData>(std::move(*data));
}

// The precise ones; nothing without a file.
Result<std::optional<PreciseOrbits>> precise_of(const SolveOptions& options, const ObservationFile& file,
                                                const Messages& messages) {
    if (options.sp3.empty()) return std::nullopt;
    auto read = read_precise_orbit_file(options.sp3);
    if (!read) return fail(read.error());
    warn_of_span(file, span_of(read->orbits), "precise orbits", messages);
    return std::move(read->orbits);
}

// Where the satellites were, as far as the files tell.
struct KnownOrbits {
    std::unique_ptr<NavigationSource> broadcast;
    std::optional<PreciseOrbits> precise;  // in place of the others

    [[nodiscard]] bool tell(SatelliteId satellite, GpsTime time) const {
        return precise ? precise->state(satellite, time).has_value()
                       : broadcast->ephemeris(satellite, time).has_value();
    }
};

// Why no fix is to be expected of a system: it is not observed, or there are no orbits of it.
void warn_of_systems(const SolveOptions& options, const ObservationFile& file, const KnownOrbits& orbits,
                     const Messages& messages) {
    std::set<Constellation> observed, in_orbit;
    for (const Observations& epoch : file.epochs)
        for (const Observation& o : epoch.signals) {
            const Constellation system = o.satellite.constellation;
            observed.insert(system);
            if (!in_orbit.contains(system) && orbits.tell(o.satellite, epoch.receive_time)) in_orbit.insert(system);
        }
    for (const Constellation system : options.systems.empty() ? observed : wanted_systems(options)) {
        if (!observed.contains(system))
            messages.warning(
                fmt::format("{}: no observations of {}", options.observations, constellation_name(system)));
        else if (!in_orbit.contains(system))
            messages.warning(
                fmt::format("no orbits of {} at the time of the observations", constellation_name(system)));
    }
}

// Observation files may leave out the channels of GLONASS, which the broadcast records know.
void set_glonass_carriers(Observations& epoch, const NavigationSource& broadcast) {
    for (Observation& o : epoch.signals) {
        if (o.satellite.constellation != Constellation::glonass) continue;
        const auto record = broadcast.ephemeris(o.satellite, epoch.receive_time);
        const auto* glonass = record ? std::get_if<GlonassEphemeris>(&*record) : nullptr;
        if (glonass) o.carrier = carrier_frequency(o.signal, glonass->frequency_channel);
    }
}

struct SolvedCounts {
    std::size_t epochs = 0, fixes = 0;
};

// The station of --base, epoch after epoch, as its corrections would come in time for the same epoch.
class BaseFile {
public:
    BaseFile(ObservationFile file, Position<Ecef> position, const NavigationSource& broadcast)
        : file_(std::move(file)), position_(position), broadcast_(broadcast) {}

    // Its last epoch that is not later.
    Corrections at(GpsTime time) {
        // A clock that is ahead of the other's by half a millisecond shows the same epoch.
        const GpsTime latest = time + std::chrono::milliseconds(1);
        for (; next_ < file_.epochs.size() && file_.epochs[next_].receive_time <= latest; ++next_) {
            set_glonass_carriers(file_.epochs[next_], broadcast_);
            auto station = std::make_shared<ReferenceStation>();
            station->position = position_;
            station->glonass_biases_known = true;
            station->epoch = {file_.epochs[next_].receive_time, file_.epochs[next_].signals};
            corrections_.reference = std::move(station);
            corrections_.at_most = CorrectionState::rtk_fixed;
        }
        return corrections_;
    }

private:
    ObservationFile file_;
    Position<Ecef> position_;
    const NavigationSource& broadcast_;
    std::size_t next_ = 0;
    Corrections corrections_;
};

// Nothing without --base.
Result<std::optional<BaseFile>> base_of(const SolveOptions& options, const NavigationSource& broadcast,
                                        const Messages& messages) {
    if (options.base.empty()) return std::nullopt;
    auto file = read_observation_file(options.base);
    if (!file) return fail(file.error());
    messages.warnings(file->warnings);
    const std::vector<double>& told = options.base_position;
    if (!told.empty())
        return BaseFile(std::move(*file), to_ecef(Geodetic::degrees(told[0], told[1], told[2])), broadcast);
    if (!file->approximate_position)
        return fail({ErrorCode::usage,
                     fmt::format("{} does not say where its antenna stands; give --base-position", options.base)});
    const LocalFrame marker(to_geodetic(*file->approximate_position));
    const AntennaDelta& d = file->antenna_delta;
    const auto antenna = marker.to_ecef(Position<Enu>(d.east.value(), d.north.value(), d.height.value()));
    return BaseFile(std::move(*file), antenna, broadcast);
}

SolvedCounts solve_epochs(ObservationFile& file, NavigationEngine& engine, std::optional<BaseFile>& base,
                          const SolveOptions& options, OutputFile& out) {
    ReceiverSettings settings = settings_of(options);
    const std::set<Constellation> wanted = wanted_systems(options);
    SolvedCounts counts;
    out.write(solved_header);
    for (Observations& epoch : file.epochs) {
        if (!wanted.empty())
            std::erase_if(epoch.signals,
                          [&](const Observation& o) { return !wanted.contains(o.satellite.constellation); });
        if (base) settings.corrections = base->at(epoch.receive_time);
        const Fix fix = engine.solve(epoch, settings);
        out.write(solved_row(fix, engine.velocity_known()));
        ++counts.epochs;
        if (fix.has_position()) ++counts.fixes;
    }
    return counts;
}

int solve_file(const SolveOptions& options) {
    const Messages messages(options.verbosity);
    if (options.nav.empty() && options.sp3.empty())
        return messages.error({ErrorCode::usage,
                               "solve needs orbits; give navigation data with --nav or an SP3 file "
                               "with --sp3"});
    std::vector<std::filesystem::path> inputs(options.nav.begin(), options.nav.end());
    inputs.insert(inputs.end(), {options.observations, options.sp3, options.base});
    if (const auto spared = check_spares("--out", options.out, inputs); !spared) return messages.error(spared.error());
    auto file = read_observation_file(options.observations);
    if (!file) return messages.error(file.error());
    messages.warnings(file->warnings);
    auto broadcast = broadcast_of(options, *file, messages);
    if (!broadcast) return messages.error(broadcast.error());
    auto precise = precise_of(options, *file, messages);
    if (!precise) return messages.error(precise.error());
    const KnownOrbits orbits{std::move(*broadcast), std::move(*precise)};
    for (Observations& epoch : file->epochs)
        set_glonass_carriers(epoch, *orbits.broadcast);
    auto base = base_of(options, *orbits.broadcast, messages);
    if (!base) return messages.error(base.error());
    warn_of_systems(options, *file, orbits, messages);
    std::optional<PreciseTransmitters> transmitters;
    if (orbits.precise) transmitters.emplace(*orbits.precise, options.nav.empty() ? nullptr : orbits.broadcast.get());
    // Heights above the ellipsoid are taken for those above the sea, as other solvers do.
    NavigationEngine engine(parameters_of(options), {orbits.broadcast.get(), nullptr, LeapSeconds::announced(),
                                                     transmitters ? &*transmitters : nullptr});
    auto out =
        options.out.empty() || options.out == "-" ? OutputFile::standard_output() : OutputFile::create(options.out);
    if (!out) return messages.error(out.error());
    const SolvedCounts counts = solve_epochs(*file, engine, *base, options, *out);
    out->flush();
    if (out->failure()) return messages.error(*out->failure());
    messages.info(fmt::format("{} epochs, {} with a fix", counts.epochs, counts.fixes));
    return 0;
}

}  // namespace

Action add_solve_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("solve", "Positions from a RINEX observation file, by the receiver's engine");
    auto options = std::make_shared<SolveOptions>();
    command
        ->add_option("OBSERVATIONS", options->observations,
                     "RINEX 2, 3 or 4 observation file, compact (.crx) and packed (.gz, .Z, .zip, …) or not")
        ->required();
    command->add_option("--nav", options->nav, "RINEX navigation file, repeatable; or auto: of the cache of fetch-nav")
        ->allow_extra_args(false);
    command->add_option("--sp3", options->sp3, "Precise orbits and clocks in place of the broadcast ones");
    auto* base = command->add_option("--base", options->base,
                                     "RINEX observation file of a reference station: differential and RTK solutions");
    command
        ->add_option(
            "--base-position", options->base_position,
            "Where its antenna stands: latitude, longitude (degrees), height above the ellipsoid (m); default: "
            "what its file says")
        ->expected(3)
        ->needs(base);
    command->add_option("--out", options->out, "Where the fixes go, as CSV; default and -: standard output");
    command->add_option("--systems", options->systems, "Only these: gps galileo beidou glonass qzss sbas navic")
        ->delimiter(',')
        ->check(CLI::IsMember(std::vector<std::string>(constellation_names.begin(), constellation_names.end())));
    command->add_option("--mask", options->mask_deg, "Elevation mask, degrees; default 10")
        ->check(CLI::Range(0.0, 90.0));
    command->add_option("--ionosphere", options->ionosphere, "Correction: none, broadcast or klobuchar (default)")
        ->check(CLI::IsMember({"none", "broadcast", "klobuchar"}));
    command->add_option("--troposphere", options->troposphere, "Correction: none, saastamoinen (default) or niell")
        ->check(CLI::IsMember({"none", "saastamoinen", "niell"}));
    command->add_option("--humidity", options->humidity, "Relative humidity that is assumed, 0 to 1; default 0.7")
        ->check(CLI::Range(0.0, 1.0));
    command->add_option("--filter", options->filter, "none (default): every epoch by itself; smoothed: as receivers do")
        ->check(CLI::IsMember({"none", "smoothed"}));
    add_verbosity_options(*command, options->verbosity);
    return [options] { return solve_file(*options); };
}

}  // namespace skyloop::host
