// [caster].
#include <fmt/format.h>

#include <algorithm>

#include "detail/scenario_keys.hpp"

namespace skyloop::inline run {
namespace {

bool is_mount_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.';
}

void read_users(TableReader& table, CasterSettings& caster) {
    table.named_values("users", {"passwords by the names of who is served, such as `rover = \"secret\"`", "everybody"},
                       [&](TableReader& users) {
                           for (const std::string& name : users.keys()) {
                               std::string password;
                               users.text(name, password);
                               if (name.empty() || name.find(':') != std::string::npos)
                                   users.mistake(name, "is no name of a user; expected one without ':'");
                               caster.users[name] = password;
                           }
                       });
}

// @param key that has it
void check_mount_name(TableReader& table, std::string_view key, const std::string& name, const CasterSettings& caster) {
    if (name.empty() || !std::all_of(name.begin(), name.end(), is_mount_letter))
        table.mistake(key, fmt::format("is '{}'; expected letters, digits, '-', '_' and '.'", name));
    const auto has_it = [&](const CasterMount& other) { return other.name == name; };
    if (std::any_of(caster.mounts.begin(), caster.mounts.end(), has_it) ||
        (caster.virtual_mount && has_it(*caster.virtual_mount)))
        table.mistake(key, fmt::format("'{}' is the second mount point of that name", name));
}

void read_virtual_mount(TableReader& table, CasterSettings& caster) {
    CasterMount mount;
    table.text("virtual", mount.name,
               {"name of one more mount point, as one of `mount` with virtual = true is", "none"});
    if (table.recording() || !table.has("virtual")) return;
    mount.virtual_station = true;
    mount.told_at = table.told_at("virtual");
    check_mount_name(table, "virtual", mount.name, caster);
    caster.virtual_mount = std::move(mount);
}

// Keys of the other kind.
void check_kind_of_mount(TableReader& table, bool is_virtual) {
    for (const char* key : {"receiver", "port"})
        if (is_virtual && table.has(key)) table.mistake(key, "is of a receiver; expected none with virtual = true");
    if (!is_virtual && table.has("msm"))
        table.mistake("msm", "is of virtual stations; expected virtual = true beside it, since a port has its own");
}

void read_mount(TableReader& table, const Scenario& scenario, CasterSettings& caster) {
    CasterMount mount;
    std::string receiver;
    table.needs_one_of({"name"}, "has no name; expected name = \"BASE\"");
    table.text("name", mount.name, {"by which clients ask for it: letters, digits, '-', '_' and '.'", "none"});
    table.boolean("virtual", mount.virtual_station,
                  "each client has a virtual reference station of its own, beside the place of its GGA sentences");
    table.text("receiver", receiver, {"name of the receiver whose RTCM it is", "the first"});
    table.text("port", mount.port, {"of that receiver, by which its RTCM leaves", "that of a `port` without a name"});
    table.integer("msm", mount.msm, {4, 7}, "virtual: kind of the observations' messages, 7 is MSM7");
    if (table.recording()) return;
    mount.told_at = table.told_at("name");
    if (table.has("name")) check_mount_name(table, "name", mount.name, caster);
    check_kind_of_mount(table, mount.virtual_station);
    const std::vector<std::string> names = receiver_names(scenario);
    if (!receiver.empty() && names_receiver(table, "receiver", receiver, names))
        mount.receiver = static_cast<std::size_t>(std::find(names.begin(), names.end(), receiver) - names.begin());
    caster.mounts.push_back(std::move(mount));
}

}  // namespace

void read_caster(TableReader& top, Scenario& scenario) {
    top.table(
        "caster",
        {"who else hears RTCM, of receivers or virtual stations, by NTRIP, in a live run (docs/ntrip.md)", "nobody"},
        [&](TableReader& table) {
            CasterSettings& caster = scenario.caster;
            table.needs_one_of({"listen"}, "listens nowhere; expected listen = \"2101\"");
            table.text("listen", caster.listen,
                       {"NTRIP caster: `[HOST:]PORT`, on 127.0.0.1 unless a host is given", "none"});
            if (!table.recording()) caster.told_at = table.told_at("listen");
            read_users(table, caster);
            read_virtual_mount(table, caster);
            table.tables("mount", {"its mount points", "one for each receiver that can send RTCM, by its name"},
                         [&](TableReader& mount) { read_mount(mount, scenario, caster); });
        });
}

}  // namespace skyloop::inline run
