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

void read_mount(TableReader& table, const Scenario& scenario, CasterSettings& caster) {
    CasterMount mount;
    std::string receiver;
    table.needs_one_of({"name"}, "has no name; expected name = \"BASE\"");
    table.text("name", mount.name, {"by which clients ask for it: letters, digits, '-', '_' and '.'", "none"});
    table.text("receiver", receiver, {"name of the receiver whose RTCM it is", "the first"});
    table.text("port", mount.port, {"of that receiver, by which its RTCM leaves", "that of a `port` without a name"});
    if (table.recording()) return;
    mount.told_at = table.told_at("name");
    if (table.has("name") &&
        (mount.name.empty() || !std::all_of(mount.name.begin(), mount.name.end(), is_mount_letter)))
        table.mistake("name", fmt::format("is '{}'; expected letters, digits, '-', '_' and '.'", mount.name));
    for (const CasterMount& other : caster.mounts)
        if (other.name == mount.name)
            table.mistake("name", fmt::format("'{}' is the second mount point of that name", mount.name));
    const std::vector<std::string> names = receiver_names(scenario);
    if (!receiver.empty() && names_receiver(table, "receiver", receiver, names))
        mount.receiver = static_cast<std::size_t>(std::find(names.begin(), names.end(), receiver) - names.begin());
    caster.mounts.push_back(std::move(mount));
}

}  // namespace

void read_caster(TableReader& top, Scenario& scenario) {
    top.table("caster", {"who else hears the RTCM of receivers, by NTRIP, in a live run (docs/ntrip.md)", "nobody"},
              [&](TableReader& table) {
                  CasterSettings& caster = scenario.caster;
                  table.needs_one_of({"listen"}, "listens nowhere; expected listen = \"2101\"");
                  table.text("listen", caster.listen,
                             {"NTRIP caster: `[HOST:]PORT`, on 127.0.0.1 unless a host is given", "none"});
                  if (!table.recording()) caster.told_at = table.told_at("listen");
                  read_users(table, caster);
                  table.tables("mount", {"its mount points", "one for each receiver that can send RTCM, by its name"},
                               [&](TableReader& mount) { read_mount(mount, scenario, caster); });
              });
}

}  // namespace skyloop::inline run
