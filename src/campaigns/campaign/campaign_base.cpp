#include <fmt/format.h>

#include "campaigns/campaign/campaign_plan.hpp"
#include "campaigns/campaign/sha256.hpp"
#include "detail/vehicle_files.hpp"

namespace skyloop {
namespace {

Result<void> add_named_content(Sha256& digest, const std::string& name, const Result<std::string>& content) {
    if (!content) return fail(content.error());
    digest.add(fmt::format("file {} {}\n", name, *content));
    return {};
}

Result<void> add_vehicle(Sha256& digest, const CampaignVehicle& vehicle, const std::filesystem::path& folder,
                         KeyedFiles& files) {
    digest.add(fmt::format("vehicle {}\ntimeout_s {}\n", vehicle.command, vehicle.timeout.value()));
    for (const std::string& name : programs_of_command(vehicle.command))
        if (const auto added = add_named_content(digest, name, files.digest(name)); !added) return added;
    for (const std::string& name : vehicle.files)
        if (const auto added = add_named_content(digest, name, files.digest(folder / name)); !added) return added;
    return {};
}

}  // namespace

Result<std::string> campaign_base_digest(const CampaignBase& base, const CampaignSettings& campaign,
                                         KeyedFiles& files) {
    Sha256 digest;
    digest.add(fmt::format("skyloop campaign, form 1\nversion {}\n{}", base.version, base.content.keys));
    for (const std::string& name : base.content.files)
        if (const auto added = add_named_content(digest, name, files.digest(base.folder / name)); !added)
            return fail(added.error());
    for (const auto& [name, other] : base.more)
        digest.add(fmt::format("{} {}\n", name, other));
    for (const std::string& metric : campaign.metrics)
        digest.add(fmt::format("metric {}\n", metric));
    if (campaign.vehicle)
        if (const auto added = add_vehicle(digest, *campaign.vehicle, base.folder, files); !added)
            return fail(added.error());
    return digest.hex();
}

}  // namespace skyloop
