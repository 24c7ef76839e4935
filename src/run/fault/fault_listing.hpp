/// The catalogue of faults for people.
#pragma once

#include <string>

#include "run/fault/fault_kind.hpp"

namespace skyloop {

/// A line a kind, by layer.
std::string fault_list_text();
/// One kind with its parameters.
std::string fault_text(const FaultKind& kind);
/// Every kind, command and key of the timeline, as a page of Markdown.
std::string fault_catalogue_markdown();

}  // namespace skyloop
