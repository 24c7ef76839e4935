#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "skyloop/campaign/campaign_plan.hpp"
#include "skyloop/campaign/sha256.hpp"
#include "vehicle_files.hpp"

namespace skyloop {
namespace {

// Adds the content of one file.
Result<void> add_file_content(Sha256& digest, const std::filesystem::path& file) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(std::fopen(file.c_str(), "rb"), &std::fclose);
    std::array<char, 65536> piece{};
    while (opened) {
        const std::size_t count = std::fread(piece.data(), 1, piece.size(), opened.get());
        digest.add({piece.data(), count});
        if (count == piece.size()) continue;
        if (std::ferror(opened.get()) != 0) break;
        return {};
    }
    return fail(ErrorCode::outside, fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
}

Result<void> add_named_content(Sha256& digest, const std::string& name, const std::filesystem::path& path) {
    const auto content = content_digest(path);
    if (!content) return fail(content.error());
    digest.add(fmt::format("file {} {}\n", name, *content));
    return {};
}

Result<void> add_vehicle(Sha256& digest, const CampaignVehicle& vehicle, const std::filesystem::path& folder) {
    digest.add(fmt::format("vehicle {}\ntimeout_s {}\n", vehicle.command, vehicle.timeout.value()));
    for (const std::string& name : files_of_command(vehicle.command))
        if (const auto added = add_named_content(digest, name, name); !added) return added;
    for (const std::string& name : vehicle.files)
        if (const auto added = add_named_content(digest, name, folder / name); !added) return added;
    return {};
}

}  // namespace

Result<std::string> content_digest(const std::filesystem::path& path) {
    Sha256 digest;
    std::error_code none;
    if (!std::filesystem::is_directory(path, none)) {
        if (const auto added = add_file_content(digest, path); !added) return fail(added.error());
        return digest.hex();
    }
    std::vector<std::filesystem::path> files;
    for (auto at = std::filesystem::recursive_directory_iterator(path, none);
         !none && at != std::filesystem::recursive_directory_iterator(); at.increment(none))
        if (at->is_regular_file(none)) files.push_back(at->path());
    if (none) return fail(ErrorCode::outside, fmt::format("{}: cannot be read: {}", path.string(), none.message()));
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        digest.add(fmt::format("{}\n", file.lexically_relative(path).string()));
        if (const auto added = add_file_content(digest, file); !added) return fail(added.error());
    }
    return digest.hex();
}

Result<std::string> campaign_base_digest(const CampaignBase& base, const CampaignSettings& campaign) {
    Sha256 digest;
    digest.add(fmt::format("skyloop campaign, form 1\nversion {}\n{}", base.version, base.content.keys));
    for (const std::string& name : base.content.files)
        if (const auto added = add_named_content(digest, name, base.folder / name); !added) return fail(added.error());
    for (const auto& [name, other] : base.more)
        digest.add(fmt::format("{} {}\n", name, other));
    for (const std::string& metric : campaign.metrics)
        digest.add(fmt::format("metric {}\n", metric));
    if (campaign.vehicle)
        if (const auto added = add_vehicle(digest, *campaign.vehicle, base.folder); !added) return fail(added.error());
    return digest.hex();
}

}  // namespace skyloop
