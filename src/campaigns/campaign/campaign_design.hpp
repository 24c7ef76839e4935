/// Where the samples of a design lie, and which values stand there.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "run/scenario/campaign_settings.hpp"

namespace skyloop::inline campaigns {

/// `count` numbers of (0, 1) for one parameter, each by itself.
/// @param key of the parameter: the numbers of one do not depend on which others there are
std::vector<double> random_samples(std::uint64_t count, std::uint64_t design_seed, std::string_view key);

/// `count` numbers of (0, 1) for one parameter, exactly one in each [k/count, (k + 1)/count), in an order that is drawn
/// (McKay, Beckman and Conover, Technometrics 21, 1979).
std::vector<double> latin_hypercube_samples(std::uint64_t count, std::uint64_t design_seed, std::string_view key);

/// The value of a parameter below which the share `u` of it lies, `u` in (0, 1). Numbers have 12 significant digits, so
/// that the last bits of a C library's functions do not show.
CampaignValue value_at(const CampaignSpread& spread, double u);

/// How many values a grid has of a parameter: of a list, or of whole numbers.
/// @return 0 for what has no end of values
std::uint64_t grid_size(const CampaignSpread& spread);
/// One of them, `index` below grid_size().
CampaignValue grid_value(const CampaignSpread& spread, std::uint64_t index);

}  // namespace skyloop::inline campaigns
