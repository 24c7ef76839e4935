#include "detail/key_meanings.hpp"

#include <algorithm>
#include <string>

namespace skyloop {
namespace {

constexpr KeyMeaning run_meanings[] = {
    {"", "run", "when, how long, how fast"},
    {"run", "start", "when the run begins: ISO 8601 in UTC, or \"now\"",
     "now; with navigation data when four satellites first have orbits"},
    {"run", "duration_s", "length of the run", "until stopped"},
    {"run", "seed", "the same scenario, seed and inputs give the same bytes"},
    {"run", "speed", "`skyloop run` only: simulated seconds per second"},
    {"", "sky", "which satellites there are"},
    {"sky", "navigation", "navigation files: RINEX 2, 3 or 4, YUMA or SEM almanac, gzip too", "nominal constellation"},
    {"sky", "rebase_navigation", "move the data by whole days to the start time, keeping its time of day"},
    {"sky", "constellations", "which systems of the data send", "all; gps and qzss for sensor models"},
    {"sky", "elevation_mask_deg", "a satellite exactly at the mask is used", "the board's; 5 for sensor models"},
    {"sky", "ephemeris_rule", "the newest healthy record that is not of the future, or the nearest one",
     "by the model"},
    {"sky", "ephemeris_validity_s", "largest age of any record", "by the system"},
    {"", "campaign", "many runs of the scenario (docs/campaigns.md)", "none"},
    {"campaign", "name", "what reports call it", "the file's"},
    {"campaign", "seeds", "how many seeds each set of parameters is run with",
     "1; of designs that draw, a seed for each sample"},
    {"campaign", "first_seed", "the first of them"},
    {"campaign", "seed_list", "the seeds themselves, instead of their number", "none"},
    {"campaign", "design", "each value with each, or samples that are drawn"},
    {"campaign", "samples", "how many sets of parameters are drawn", "none"},
    {"campaign", "design_seed", "what they are drawn with"},
    {"campaign", "metrics", "which figures of a run are kept", "all"},
    {"campaign", "parameter", "a key that differs from run to run"},
    {"campaign.parameter", "key", "with dots: `model.name`, `fault.NAME.for_s`, `receiver.0.rate_hz`", "none"},
    {"campaign.parameter", "values", "what it takes", "none"},
    {"campaign.parameter", "uniform", "drawn between these", "none"},
    {"campaign.parameter", "log_uniform", "drawn so that its logarithm is uniform between those of these", "none"},
    {"campaign.parameter", "normal", "drawn with this mean and standard deviation", "none"},
    {"campaign.parameter", "whole", "whole numbers from the first to the second", "none"},
    {"campaign", "vehicle", "a program that is tested, in real time"},
    {"campaign.vehicle", "command", "for /bin/sh; `{pty}`, `{seed}` and `{number}` are replaced", "none"},
    {"campaign.vehicle", "files", "what the program loads: its runs are done anew when one of these has changed",
     "none"},
    {"campaign.vehicle", "timeout_s", "how long it may run", "length of the run and 10"},
    {"", "frame", "where the coordinates of a game level lie on the Earth"},
    {"frame", "origin", "of the level: latitude, longitude, height"},
    {"frame", "yaw_deg", "azimuth of the level's X axis, clockwise from north"},
    {"frame", "unit_m", "length of one level unit; 0.01 for centimetres"},
    {"frame", "left_handed", "true: Y points to the right of X"},
    {"frame", "reach_m", "a warning tells of points further from the origin, where a plane leaves the curved Earth"},
    {"", "trajectory", "where the vehicle is", "fixed, in Odessa"},
    {"trajectory", "kind", "the shape of the way"},
    {"trajectory", "heading_deg",
     "where the vehicle looks until it moves, clockwise from north; then it looks where it goes"},
    {"trajectory", "at", "the place: latitude, longitude, height above the ellipsoid", "none"},
    {"trajectory", "at_level", "the place in the coordinates of [frame], instead of `at`: x, y, z", "none"},
    {"trajectory", "waypoint", "the corners of the way, at least two"},
    {"trajectory.waypoint", "at", "the corner: latitude, longitude, height above the ellipsoid", "none"},
    {"trajectory.waypoint", "at_level", "the corner in the coordinates of [frame], instead of `at`: x, y, z", "none"},
    {"trajectory.waypoint", "speed_mps", "from here to the next corner", "the last one given, at first 10"},
    {"trajectory.waypoint", "hold_s", "stop here before leaving"},
    {"trajectory", "centre", "of the path: latitude, longitude, height above the ellipsoid", "none"},
    {"trajectory", "centre_level", "the centre in the coordinates of [frame], instead of `centre`: x, y, z", "none"},
    {"trajectory", "radius_m", "of the circle or of the turns", "100; of a racetrack the smallest at its speed"},
    {"trajectory", "speed_mps",
     "along the way, of a file where that has no times; on a circle a negative one runs anticlockwise",
     "10; of a vehicle its own; of a file without times the plan's or the vehicle's; afloat 0"},
    {"trajectory", "start_azimuth_deg", "from the centre to the place at the start, clockwise from north"},
    {"trajectory", "path", "the recorded track beside the scenario's file: CSV, GPX, KML, NMEA, IGC and others",
     "none"},
    {"trajectory", "source", "who flies the vehicle: udp-json:29990, flightgear:5503, … (docs/feeds.md)", "none"},
    {"trajectory", "vehicle_id", "which one of the source's vehicles", "the first that it speaks of"},
    {"trajectory", "clock", "who leads: the wall clock, or the source's clock, or the source step by step"},
    {"trajectory", "sea_level", "what the source's heights above the sea count from"},
    {"trajectory", "origin",
     "of a track or source in local metres, and the ground of a track above it: latitude, longitude, height", "none"},
    {"trajectory", "origin_level", "the same in the coordinates of [frame]: x, y, z", "none"},
    {"trajectory", "local_map", "how a source's local metres lie on the Earth: as it means them, or by another's map"},
    {"trajectory", "filtered", "places that a receiver measured (nmea, ubx, gpsd) go through a filter"},
    {"trajectory", "source_rate_hz", "asked of sources that can be asked"},
    {"trajectory", "delay_s", "the path is this much late, so that slow sources are interpolated"},
    {"trajectory", "lost_after_s", "silence of the source after which it is lost"},
    {"trajectory", "when_lost", "what then becomes of the run"},
    {"trajectory", "time", "the track begins with the run, or keeps the times it was recorded at"},
    {"trajectory", "gap_s", "stretches without rows that are longer than this are gaps, and told"},
    {"trajectory", "gap",
     "what becomes of a gap: a way across it; a stand and a jump; its time is left out; a way across it without "
     "signals"},
    {"trajectory", "skip_s", "so far into the track it begins"},
    {"trajectory", "time_scale", "seconds of the track in one second of the run; speeds grow with it"},
    {"trajectory", "end", "after the last row: the vehicle stands there, the run ends, or the track begins anew"},
    {"trajectory", "smooth",
     "move the rows onto a smooth path: by the noise that they show, or as positions of a satellite receiver"},
    {"", "scene", "buildings and ground around the antenna"},
    {"scene", "buildings", "city models (.obj .ply .gltf .glb .geojson .json .osm .pbf .gml .xml), or \"demo\"",
     "none"},
    {"scene", "terrain", "height grid (.asc) that becomes ground", "none"},
    {"scene", "origin", "of the files' frame: latitude, longitude, height",
     "1.5 m below the start, where that is known"},
    {"scene", "file_origin",
     "x, y, z of a mesh that lie at the origin, in units and axes of the file; for coordinates of a map"},
    {"scene", "axes", "the file's axes that point east, north and up: \"x,y,z\", \"x,-z,y\", \"y,x,z\"",
     "as the format says"},
    {"scene", "heights", "what the heights of files on the Earth count from",
     "as the file's system says, else the ellipsoid"},
    {"scene", "unit_m", "length of one unit of the file; 0.01 for centimetres"},
    {"scene", "material", "of surfaces of which the file tells none"},
    {"scene", "default_height_m", "of outlines without height or levels"},
    {"scene", "metres_per_level", "m, of outlines with levels"},
    {"scene", "reflections", "most of one path", "16; modern 3"},
    {"scene", "roofs_reflect", "roofs besides walls"},
    {"scene", "ground_reflects", "ground besides walls", "modern alone"},
    {"scene", "diffraction", "modern: rays around edges"},
    {"scene", "foliage", "modern: the trees of the model weaken what passes them"},
    {"scene", "rays", "of a search over the whole hemisphere; 0: by the epoch rate"},
    {"scene", "threads", "of each receiver, that search beside the loop; the bytes do not depend on it",
     "1; led by a program 0"},
    {"scene", "memory_limit_mb",
     "a scene that would take more is refused, and so is a file of it that unpacks to more; 0: no limit"},
    {"scene", "cache", "keep models that take time to read for the next run"},
    {"", "receiver", "the receivers on the vehicle", "one, an ublox-m8 on a pty"},
    {"receiver", "name", "what messages and `base` call it", "receiver0, receiver1, …"},
    {"receiver", "board", "a profile of `skyloop boards`, or the path of a board file (`.toml`)"},
    {"receiver", "port",
     "wires: pty[:LINK], serial:DEVICE[@BAUD], usb:VID:PID, hid:VID:PID, usbip:[HOST:]PORT, tcp:[HOST:]PORT[@BAUD], "
     "tcp-connect:HOST:PORT[@BAUD], rfc2217:[HOST:]PORT, file:PATH, -, client:NAME; NAME= before it says which port",
     "a pty"},
    {"receiver", "power",
     "the actuator that the fault power_cut switches in a live run: relay:, gpio:, hub:, line: or command: "
     "(docs/actuators.md)",
     "none"},
    {"receiver", "rate_hz", "navigation rate at the factory", "the board's"},
    {"receiver", "baud", "bit/s of UART1 at the factory", "the board's"},
    {"receiver", "sentences", "NMEA sentences at the factory, each every epoch", "the board's"},
    {"receiver", "constellations", "systems that it tracks from the factory on", "the board's"},
    {"receiver", "dual_frequency", "it tracks the second signal of each system too; false leaves it to the board"},
    {"receiver", "config",
     "configuration items that its user has saved in it, by their names, such as `CFG-RATE-MEAS = 100`"},
    {"receiver", "start", "what it knows at the start: everything; time, place and almanac; nothing"},
    {"receiver", "dynamic_model",
     "how it expects to move; a u-blox board withholds a fix beyond its limits of height and speed"},
    {"receiver", "export_limits",
     "a fix above 18 288 m and above 515 m/s is withheld: never, beyond both, beyond one of them", "the board's"},
    {"receiver", "static_hold_mps", "slower than this, the position is held; 0: never"},
    {"receiver", "power_up", "it is switched on at the start of the run; false: it has been on for long"},
    {"receiver", "state_file", "keeps what the receiver saves for the next run", "none"},
    {"receiver", "antenna_offset_m", "from the point that follows the trajectory to the antenna: forward, right, down"},
    {"receiver", "trajectory", "where the vehicle is that this receiver rides on", "the scenario's"},
    {"receiver", "base", "name of the receiver that carries the base antenna of a pair", "none"},
    {"", "output", "what is told to other programs beside the receivers' wires (docs/outputs.md)", "none"},
    {"output", "to",
     "gps-input:HOST:PORT, hil-gps:HOST:PORT, msp-tcp:[HOST:]PORT, msp-tcp-to:HOST:PORT, json-udp:HOST:PORT, "
     "json-tcp:[HOST:]PORT, json-file:PATH",
     "none"},
    {"output", "receiver", "name of the receiver that is told", "all to json, the first to others"},
    {"output", "when", "when the receiver's own messages of an epoch begin to leave, or as soon as it is solved",
     "report; of json epoch"},
    {"output", "system", "MAVLink: number of the system that sends"},
    {"output", "component", "MAVLink: number of the component that sends"},
    {"output", "id", "which receiver of the vehicle this is: gps_id of GPS_INPUT, id of HIL_GPS, instance of MSP"},
    {"output", "eph", "what eph and epv of HIL_GPS hold: accuracies in centimetres for PX4, or DOP times 100"},
    {"", "fault", "what goes wrong; lasts (docs/failsafe.md)"},
    {"fault", "kind", "which fault, see docs/faults.md"},
    {"fault", "receiver", "names of the receivers that it is for", "all"},
    {"", "command", "what happens once (docs/failsafe.md)"},
    {"command", "kind", "which command, see docs/faults.md"},
    {"command", "receiver", "name of the receiver that it is for", "all"},
    {"", "expect", "what the run is judged by (docs/failsafe.md)"},
    {"expect", "name", "what verdicts call it", "its sentence or its command"},
    {"expect", "receiver", "name of the receiver that the sentence is about", "each"},
    {"expect", "what", "a sentence: \"fix within 30 s of the end of outage\"", "none"},
    {"expect", "command", "a program and its arguments, or a text for /bin/sh", "none"},
    {"expect", "expect_exit", "exit code that the command should have", "0, or any beside json"},
    {"expect", "json", "one JSON line that the command prints must fulfil this: \"tpv.mode >= 3\"", "none"},
    {"expect", "at_s", "when the command is started, after the start of the run"},
    {"expect", "within_s", "it is started anew until it succeeds, for so long", "once"},
    {"expect", "timeout_s", "of each start of the command; then it is killed"},
};

const KeyMeaning* find_in(std::span<const KeyMeaning> meanings, std::string_view table, std::string_view key) {
    const auto found = std::find_if(meanings.begin(), meanings.end(), [&](const KeyMeaning& meaning) {
        const bool of_any = meaning.table.ends_with(".*");
        const std::string_view above = table.substr(0, table.rfind('.') + 1);
        const bool here = of_any ? above == meaning.table.substr(0, meaning.table.size() - 1) : meaning.table == table;
        return here && meaning.key == key;
    });
    return found == meanings.end() ? nullptr : &*found;
}

}  // namespace

std::span<const KeyMeaning> run_key_meanings() { return run_meanings; }

const KeyMeaning* find_key_meaning(std::string_view table, std::string_view key) {
    // A receiver's own way has the keys of the scenario's.
    if (constexpr std::string_view above = "receiver."; table.starts_with("receiver.trajectory"))
        table.remove_prefix(above.size());
    // So has a step of a sequence.
    std::string of_path;
    if (constexpr std::string_view step = "trajectory.step"; table.starts_with(step)) {
        of_path = "trajectory" + std::string(table.substr(step.size()));
        table = of_path;
    }
    for (const auto meanings : {run_key_meanings(), path_key_meanings(), model_key_meanings(), modern_key_meanings()})
        if (const KeyMeaning* found = find_in(meanings, table, key)) return found;
    return nullptr;
}

}  // namespace skyloop
