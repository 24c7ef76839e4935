// XML files as trees, read by the names of elements whatever their prefixes.
#pragma once

#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "track_formats.hpp"

namespace skyloop::inline motion {

// The name of the root element without its prefix, told without reading the whole; empty when the text is no XML.
std::string_view xml_root_name(std::string_view text);

// The name of an element without its prefix: writers get prefixes wrong. Empty for what is no element.
std::string_view xml_name(const pugi::xml_node& node);
// All text directly in an element; comments in between do not end it.
std::string xml_content(const pugi::xml_node& node);
// The first child of that name, or none.
pugi::xml_node xml_child(const pugi::xml_node& node, std::string_view name);
// The element that follows in the order of the file, below `root`; none after the last one. Any depth is walked
// without recursion.
pugi::xml_node xml_following(const pugi::xml_node& node, const pugi::xml_node& root);

// A whole file.
class XmlTree {
public:
    // Fails with `input` where the text is no XML, naming the line, and for files above 64 MiB: a tree of them would
    // take more than a gigabyte.
    static Result<XmlTree> of(const TrackFile& file);
    [[nodiscard]] pugi::xml_node root() const { return document_->document_element(); }
    // Quick for nodes in the order of the file. 0 where the file is not UTF-8, whose lines are not known.
    [[nodiscard]] std::size_t line_of(const pugi::xml_node& node);

private:
    std::unique_ptr<pugi::xml_document> document_;
    std::string_view text_;  // empty unless UTF-8
    std::size_t counted_to_ = 0, line_ = 1;
};

}  // namespace skyloop::inline motion
