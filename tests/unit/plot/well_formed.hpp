/// A small reader of XML that knows enough to say whether a picture is well formed.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace skyloop::test {

/// True when every '&' starts one of the entities that need no declaration.
inline bool entities_known(std::string_view text) {
    for (std::size_t at = text.find('&'); at != std::string_view::npos; at = text.find('&', at + 1)) {
        bool known = false;
        for (const std::string_view name : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"})
            known = known || text.substr(at).starts_with(name);
        if (!known) return false;
    }
    return true;
}

/// What is wrong with the attributes of a tag; empty: nothing.
inline std::string attributes_fault(std::string_view rest) {
    std::set<std::string, std::less<>> seen;
    while (rest.find_first_not_of(' ') != std::string_view::npos) {
        rest.remove_prefix(rest.find_first_not_of(' '));
        const std::size_t equals = rest.find("=\"");
        if (equals == std::string_view::npos) return "bad attribute: " + std::string(rest);
        const std::string name(rest.substr(0, equals));
        rest.remove_prefix(equals + 2);
        const std::size_t quote = rest.find('"');
        if (quote == std::string_view::npos) return "a value without an end: " + name;
        const std::string_view value = rest.substr(0, quote);
        if (!entities_known(value) || value.find('<') != std::string_view::npos) return "bad value of " + name;
        if (!seen.insert(name).second) return "attribute twice: " + name;
        rest.remove_prefix(quote + 1);
    }
    return {};
}

/// The content of the tag at the start of `xml` without its brackets; empty when it has no end. A '>' in quotes is
/// none.
inline std::string_view tag_at_start(std::string_view xml) {
    bool quoted = false;
    for (std::size_t end = 1; end < xml.size(); ++end) {
        if (xml[end] == '"') quoted = !quoted;
        if (xml[end] == '>' && !quoted) return xml.substr(1, end - 1);
    }
    return {};
}

/// What is wrong with the document; empty: it is well formed (elements, attributes, entities; no DTD, no CDATA).
inline std::string xml_fault(std::string_view xml) {
    std::vector<std::string> open;
    bool had_root = false;
    if (xml.starts_with("<?xml")) xml.remove_prefix(xml.find("?>") + 2);
    while (!xml.empty()) {
        const std::string_view text = xml.substr(0, xml.find('<'));
        if (!entities_known(text) || text.find('>') != std::string_view::npos) return "bad text: " + std::string(text);
        if (open.empty() && text.find_first_not_of(" \n") != std::string_view::npos) return "text outside the root";
        xml.remove_prefix(text.size());
        if (xml.empty()) break;
        std::string_view tag = tag_at_start(xml);
        if (tag.empty()) return "a tag without an end";
        xml.remove_prefix(tag.size() + 2);
        if (tag.starts_with('/')) {
            if (open.empty() || open.back() != tag.substr(1)) return "unexpected <" + std::string(tag) + ">";
            open.pop_back();
            continue;
        }
        if (open.empty() && had_root) return "a second root";
        had_root = true;
        const bool closed = tag.ends_with('/');
        if (closed) tag.remove_suffix(1);
        const std::string name(tag.substr(0, tag.find(' ')));
        if (const std::string fault = attributes_fault(tag.substr(name.size())); !fault.empty()) return fault;
        if (!closed) open.push_back(name);
    }
    if (!open.empty()) return "<" + open.back() + "> is not closed";
    return had_root ? "" : "no root";
}

/// How often `part` occurs in `text`.
inline std::size_t occurrences(std::string_view text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size()))
        ++count;
    return count;
}

}  // namespace skyloop::test
